//! Collects the licences of all that the program is made of: its own, those of `licences/components.json`, of the page's packages as Vite
//! lists them, and of the crates that are linked into it.

use std::collections::{BTreeSet, HashMap};
use std::io::{self, Write as _};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

use flate2::Compression;
use flate2::write::GzEncoder;
use serde_json::{Value, json};

/// What decides which licences there are, beside the page.
pub(crate) const SOURCES: [&str; 7] = [
    "licences",
    "Cargo.toml",
    "../core/Cargo.toml",
    "../../Cargo.toml",
    "../../Cargo.lock",
    "../../LICENSE-MIT",
    "../../LICENSE-APACHE",
];
/// What is no crate, and no package of the page that Vite knows.
const COMPONENTS: &str = "licences/components.json";
/// The texts of crates whose sources come without one: a list of files by the name of the crate.
const TEXTS_OF_CRATES: &str = "licences/crates.json";
/// The parts of the program, in the order in which they are read.
const PARTS: [&str; 4] = ["program", "data", "page", "crate"];
/// The packages of the page with their licences, beside its files.
const PACKAGES: &str = "licences.json";
/// How the names of files begin that hold a licence, in lower case.
const NAMES: [&str; 6] = ["licence", "license", "unlicense", "copying", "copyright", "notice"];
/// The text of the licence that is not chosen, where there is a choice of two and its file does not say so: zstd's is BSD or GPL.
const NOT_CHOSEN: &str = "zstd/COPYING";

/// The components, and their texts: identical ones once.
#[derive(Default)]
struct Collection {
    components: Vec<Value>,
    texts: Vec<String>,
    /// The numbers of the texts, by their words: line ends and indents make no other licence.
    numbers: HashMap<String, usize>,
}

/// A crate as cargo lists it.
#[derive(PartialEq, Eq, PartialOrd, Ord)]
struct Crate {
    name: String,
    version: String,
    licence: String,
    repository: String,
}

/// Writes all licences to a file, by gzip; `page` is the folder of the page, which has packages where it was built.
pub(crate) fn write(page: &Path, file: &Path) -> io::Result<()> {
    let packages = page.join(PACKAGES);
    let packages: Vec<Value> =
        if packages.exists() { serde_json::from_slice(&fs::read(packages)?)? } else { Vec::new() };
    let mut all = Collection::default();
    let components: Vec<Value> = serde_json::from_slice(&fs::read(COMPONENTS)?)?;
    for component in components {
        let of = &component["with"];
        if of.is_null() || packages.iter().any(|package| package["name"] == *of) {
            all.add_component(&component)?;
        }
    }
    for package in &packages {
        all.add_package(package)?;
    }
    let without_text: Value = serde_json::from_slice(&fs::read(TEXTS_OF_CRATES)?)?;
    for linked in crates()? {
        all.add_crate(&linked, &without_text)?;
    }
    let Collection { mut components, texts, .. } = all;
    let part = |component: &Value| PARTS.iter().position(|part| component["part"] == *part);
    components.sort_by_key(|component| (part(component), component["name"].as_str().map(str::to_owned)));
    let version = env::var("CARGO_PKG_VERSION").map_err(io::Error::other)?;
    let document = json!({"version": version, "components": components, "texts": texts});
    let mut gzip = GzEncoder::new(fs::File::create(file)?, Compression::best());
    gzip.write_all(document.to_string().as_bytes())?;
    gzip.finish()?;
    Ok(())
}

impl Collection {
    /// Adds one of the file of components.
    fn add_component(&mut self, component: &Value) -> io::Result<()> {
        let version = match component["version"].as_str() {
            Some("{program}") => json!(env::var("CARGO_PKG_VERSION").map_err(io::Error::other)?),
            Some("{rust}") => json!(rust()?),
            _ => component["version"].clone(),
        };
        let files = component["texts"].as_array().into_iter().flatten().filter_map(Value::as_str);
        let texts = files.map(|file| self.number(&read(Path::new(file))?)).collect::<io::Result<Vec<_>>>()?;
        let component = json!({"name": component["name"], "version": version, "part": component["part"],
            "licence": component["licence"], "source": component["source"], "texts": texts});
        self.components.push(component);
        Ok(())
    }

    /// Adds a package of the page.
    fn add_package(&mut self, package: &Value) -> io::Result<()> {
        let name = package["name"].as_str().ok_or_else(|| io::Error::other("a package of the page has no name"))?;
        let text = package["text"].as_str().map(|text| self.number(text)).transpose()?;
        let texts: Vec<_> = text.into_iter().collect();
        let component = json!({"name": name, "version": package["version"], "part": "page",
            "licence": package["identifier"], "source": format!("https://www.npmjs.com/package/{name}"),
            "texts": texts});
        self.components.push(component);
        Ok(())
    }

    /// Adds a crate, with the texts that come with its source, or those that are here in their place.
    fn add_crate(&mut self, linked: &Crate, without_text: &Value) -> io::Result<()> {
        let Crate { name, version, licence, repository } = linked;
        let mut texts = BTreeSet::new();
        for file in files(&linked.folder()?)? {
            texts.insert(self.number(&read(&file)?)?);
        }
        let here = without_text[name].as_array().filter(|_| texts.is_empty());
        for file in here.into_iter().flatten().filter_map(Value::as_str) {
            texts.insert(self.number(&read(Path::new(file))?)?);
        }
        let source =
            if repository.is_empty() { format!("https://crates.io/crates/{name}") } else { repository.clone() };
        let component = json!({"name": name, "version": version, "part": "crate", "licence": licence,
            "source": source, "texts": texts});
        self.components.push(component);
        Ok(())
    }

    /// The number of a text, which it gets where it is new.
    fn number(&mut self, text: &str) -> io::Result<usize> {
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        if words.is_empty() {
            return Err(io::Error::other("a licence is empty"));
        }
        let next = self.texts.len();
        let number = *self.numbers.entry(words).or_insert(next);
        if number == next {
            self.texts.push(printable(text));
        }
        Ok(number)
    }
}

impl Crate {
    /// The folder of its source: in cargo's home, where a build puts it, or in the one of `cargo vendor`.
    fn folder(&self) -> io::Result<PathBuf> {
        let Self { name, version, .. } = self;
        let home = env::var_os("CARGO_HOME").map(PathBuf::from).or_else(|| Some(env::home_dir()?.join(".cargo")));
        let sources = home.ok_or_else(|| io::Error::other("cargo has no home"))?.join("registry/src");
        let registries = fs::read_dir(sources).into_iter().flatten().flatten().map(|registry| registry.path());
        let mut folders = registries.map(|registry| registry.join(format!("{name}-{version}")));
        let vendored = [format!("{name}-{version}"), name.clone()].map(|name| Path::new("../../vendor").join(name));
        let folder = folders.find(|folder| folder.exists()).or_else(|| vendored.into_iter().find(|path| path.exists()));
        folder.ok_or_else(|| io::Error::other(format!("the source of {name} {version} is not where cargo has others")))
    }
}

/// The crates from elsewhere that are linked into the program for the target: not those that only compile, nor those of tests. Cargo asks
/// the network for none, as the build has fetched them all; unlike `cargo metadata`, this does not want those of other targets.
fn crates() -> io::Result<BTreeSet<Crate>> {
    let variable = |name: &str| env::var(name).map_err(io::Error::other);
    let listing = Command::new(variable("CARGO")?)
        .args(["tree", "--quiet", "--locked", "--prefix=none", "--edges=normal,no-proc-macro", "--format={p}|{l}|{r}"])
        .args(["--package", &variable("CARGO_PKG_NAME")?, "--target", &variable("TARGET")?])
        .output()?;
    if !listing.status.success() {
        let told = String::from_utf8_lossy(&listing.stderr).into_owned();
        return Err(io::Error::other(format!("cargo does not list the crates: {told}")));
    }
    let listing = String::from_utf8(listing.stdout).map_err(io::Error::other)?;
    // A crate that was listed before is marked, and one with its path is the program's own.
    let lines = listing.lines().map(|line| line.trim_end_matches(" (*)")).filter(|line| !line.contains(" (/"));
    lines.map(|line| listed(line).ok_or_else(|| io::Error::other(format!("cargo lists {line}")))).collect()
}

/// A line of cargo's list.
fn listed(line: &str) -> Option<Crate> {
    let mut fields = line.split('|');
    let (name, rest) = fields.next()?.split_once(" v")?;
    let version = rest.split(' ').next()?.to_owned();
    // Older crates have a slash for `OR`.
    let licence = fields.next().filter(|licence| !licence.is_empty())?.replace('/', " OR ");
    Some(Crate { name: name.to_owned(), version, licence, repository: fields.next()?.to_owned() })
}

/// The files of licences below a folder, in order: by their own name, or by that of their folder.
fn files(folder: &Path) -> io::Result<Vec<PathBuf>> {
    let names_licence = |name: &str| NAMES.iter().any(|begin| name.starts_with(begin));
    let mut found = Vec::new();
    let mut open = vec![(folder.to_owned(), false)];
    while let Some((folder, is_of_licences)) = open.pop() {
        for entry in fs::read_dir(folder)? {
            let path = entry?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy().to_lowercase();
            if path.is_dir() {
                // What only tests need is not in the program.
                if !["benches", "examples", "tests"].contains(&name.as_str()) {
                    open.push((path, names_licence(&name)));
                }
            } else if (is_of_licences || names_licence(&name))
                && path.extension().is_none_or(|end| end != "rs")
                && !path.ends_with(NOT_CHOSEN)
            {
                found.push(path);
            }
        }
    }
    found.sort();
    Ok(found)
}

fn read(file: &Path) -> io::Result<String> {
    fs::read_to_string(file).map_err(|error| io::Error::other(format!("{}: {error}", file.display())))
}

/// A text as a terminal may have it: with line ends of one kind, and no character that does not print.
fn printable(text: &str) -> String {
    let lines = text.lines().map(|line| {
        let line: String =
            line.chars().filter(|char| *char == '\t' || !(char.is_control() || *char == '\u{feff}')).collect();
        line.trim_end().to_owned()
    });
    lines.collect::<Vec<_>>().join("\n").trim_matches('\n').to_owned()
}

/// The version of the compiler, which is that of its library.
fn rust() -> io::Result<String> {
    let version = Command::new(env::var("RUSTC").map_err(io::Error::other)?).arg("--version").output()?;
    let version = String::from_utf8(version.stdout).map_err(io::Error::other)?;
    version.split(' ').nth(1).map(str::to_owned).ok_or_else(|| io::Error::other("the compiler has no version"))
}
