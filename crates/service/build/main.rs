//! Writes the tables of the page's files and of the guide's, by which they are compiled into the program, and its licences.

#[path = "guide.rs"]
mod guide;
#[path = "licences.rs"]
mod licences;

use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::{env, fs, io};

/// The page as `make ui` builds it.
const BUILT: &str = "ui/dist";
/// What is served in its place where it was not built.
const FALLBACK: &str = "src/endpoints/page";

fn main() -> io::Result<()> {
    let out = PathBuf::from(env::var("OUT_DIR").map_err(io::Error::other)?);
    // To cargo, a folder that is not there has changed every time.
    fs::create_dir_all(BUILT)?;
    println!("cargo:rerun-if-changed={BUILT}");
    println!("cargo:rerun-if-changed={FALLBACK}");
    let built = Path::new(BUILT).join("index.html").exists();
    let root = fs::canonicalize(if built { BUILT } else { FALLBACK })?;
    write_table(&root, &page_files(&root)?, &out.join("page.rs"))?;

    for source in guide::SOURCES.iter().chain(&licences::SOURCES) {
        println!("cargo:rerun-if-changed={source}");
    }
    licences::write(&root, &out.join("licences.json.gz"))?;
    let root = out.join("guide");
    write_table(&root, &guide::write(&root)?, &out.join("guide.rs"))
}

/// The page and what it loads; what was compressed lies beside what it was made from.
fn page_files(root: &Path) -> io::Result<Vec<PathBuf>> {
    let mut files = vec![root.join("index.html")];
    for asset in fs::read_dir(root.join("assets"))? {
        let asset = asset?.path();
        if !asset.extension().is_some_and(|end| end == "br" || end == "gz") {
            files.push(asset);
        }
    }
    files.sort();
    Ok(files)
}

/// Writes the table of files below a folder.
fn write_table(root: &Path, files: &[PathBuf], table: &Path) -> io::Result<()> {
    let entries = files.iter().map(|file| entry(root, file)).collect::<io::Result<String>>()?;
    fs::write(table, format!("&[\n{entries}]"))
}

/// The entry of a file.
fn entry(root: &Path, file: &Path) -> io::Result<String> {
    let path = file.strip_prefix(root).map_err(io::Error::other)?.display();
    let mut hasher = DefaultHasher::new();
    fs::read(file)?.hash(&mut hasher);
    let hash = hasher.finish();
    let file = file.display().to_string();
    let compressed = |end: &str| {
        let file = format!("{file}.{end}");
        if Path::new(&file).exists() { format!("Some(include_bytes!({file:?}))") } else { "None".to_owned() }
    };
    let (brotli, gzip) = (compressed("br"), compressed("gz"));
    Ok(format!(
        "File {{ path: \"/{path}\", hash: \"{hash:016x}\", plain: include_bytes!({file:?}), brotli: {brotli}, gzip: {gzip} }},\n"
    ))
}
