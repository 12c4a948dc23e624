//! The rules of the house that a compiler does not see: who may know whom, and who may do what.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

/// The levels of the core, from the lowest: a module may name modules of the levels above its own in this list, and its children.
const CORE: [&[&str]; 14] = [
    &["elementary", "root", "number_text", "interrupt"],
    &["scalar"],
    &["integrate", "interpolation"],
    &["planet", "atmosphere", "vehicle", "control", "propulsion", "parachute", "heating"],
    &["part", "steering"],
    &["event", "body"],
    &["coordinates"],
    &["wind"],
    &["motion"],
    &["scenario"],
    &["trajectory"],
    &["simulate"],
    &["analytic", "sensitivity", "verification"],
    &["solve"],
];

/// The levels of the service.
const SERVICE: [&[&str]; 13] = [
    &["wire", "config", "metrics", "coding", "allocator"],
    &["client"],
    &["memory"],
    &["error", "telemetry"],
    &["embedded", "format", "licences", "openapi", "rate"],
    &["compute"],
    &["state"],
    &["middleware", "answer"],
    &["extract", "connection", "validation", "reply"],
    &["endpoints"],
    &["router"],
    &["serve"],
    &["cli"],
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// All files of the repository below a folder, with their texts.
fn sources(folder: &str, extension: &str) -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    let mut open = vec![root().join(folder)];
    while let Some(path) = open.pop() {
        if path.ends_with("node_modules") {
            // Not the repository's.
        } else if path.is_dir() {
            open.extend(fs::read_dir(&path).unwrap().flatten().map(|entry| entry.path()));
        } else if path.extension().is_some_and(|found| found == extension) {
            let text = fs::read_to_string(&path).unwrap();
            files.push((path, text));
        }
    }
    assert!(!files.is_empty(), "{folder} has no {extension} files");
    files
}

/// The top-level module to which a file belongs.
fn module_of(file: &Path, src: &Path) -> String {
    let relative = file.strip_prefix(src).unwrap();
    let first = relative.components().next().unwrap().as_os_str().to_string_lossy();
    first.trim_end_matches(".rs").to_owned()
}

/// The top-level modules that a text names by `crate::module`.
fn named_modules(text: &str) -> Vec<String> {
    let after = text.split("crate::").skip(1);
    after.map(|rest| rest.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()).collect()
}

fn check_layers(src: &str, levels: &[&[&str]]) {
    let level = |module: &str| levels.iter().position(|level| level.contains(&module));
    for (file, text) in sources(src, "rs") {
        let module = module_of(&file, &root().join(src));
        if module == "lib" || module == "main" {
            continue;
        }
        let own = level(&module).unwrap_or_else(|| panic!("{module} has no level in tidy.rs"));
        for named in named_modules(&text) {
            let allowed = named == module || level(&named).is_some_and(|other| other < own);
            assert!(allowed, "{} names crate::{named}, which is not below {module}", file.display());
        }
    }
}

#[test]
fn modules_know_only_what_lies_below_them() {
    check_layers("crates/core/src", &CORE);
    check_layers("crates/service/src", &SERVICE);
}

/// The names that follow `super::` in a text, those in braces included: `a` and `b` of `super::{a::X, b}`.
fn named_siblings(text: &str) -> BTreeSet<String> {
    let first_word = |path: &str| path.trim().chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect();
    let named = text.split("super::").skip(1).flat_map(|rest| match rest.strip_prefix('{') {
        None => vec![first_word(rest)],
        Some(group) => {
            let mut depth = 0;
            // What is in inner braces is named by way of what stands before them.
            let outer: String = group
                .chars()
                .take_while(|character| {
                    depth += i32::from(*character == '{') - i32::from(*character == '}');
                    depth >= 0
                })
                .collect();
            let mut depth = 0;
            let is_comma = |character: char| {
                depth += i32::from(character == '{') - i32::from(character == '}');
                character == ',' && depth == 0
            };
            outer.split(is_comma).map(first_word).collect()
        }
    });
    named.collect()
}

/// A circle among modules, each of which names those in its set.
fn circle(names: &BTreeMap<String, BTreeSet<String>>) -> Option<Vec<String>> {
    let mut left = names.clone();
    loop {
        // What names nothing that is left is in no circle.
        let known: BTreeSet<_> = left.keys().cloned().collect();
        let before = left.len();
        left.retain(|_, named| named.iter().any(|name| known.contains(name)));
        if left.len() == before {
            return (!left.is_empty()).then(|| left.into_keys().collect());
        }
    }
}

#[test]
fn neighbours_do_not_name_each_other_in_a_circle() {
    for src in ["crates/core/src", "crates/service/src"] {
        let mut folders: BTreeMap<PathBuf, BTreeMap<String, BTreeSet<String>>> = BTreeMap::new();
        for (file, text) in sources(src, "rs") {
            let name = file.file_stem().unwrap().to_string_lossy().into_owned();
            let code = text.split("#[cfg(test)]").next().unwrap();
            let mut named = named_siblings(code);
            named.remove(&name);
            folders.entry(file.parent().unwrap().to_owned()).or_default().insert(name, named);
        }
        // At the top the levels say more.
        folders.remove(&root().join(src));
        for (folder, names) in folders {
            assert_eq!(circle(&names), None, "a circle in {}", folder.display());
        }
    }
}

#[test]
fn circles_among_neighbours_are_seen() {
    let named = |text| named_siblings(text).into_iter().collect::<Vec<_>>();
    assert_eq!(named("use super::warning::Warning; super::Other"), ["Other", "warning"]);
    assert_eq!(named("use super::{a, b::{self, c}, d::e};\nuse super::f;"), ["a", "b", "d", "f"]);
    let graph = |edges: &[(&str, &[&str])]| {
        let set = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect();
        circle(&edges.iter().map(|(from, to)| ((*from).to_owned(), set(to))).collect())
    };
    assert_eq!(graph(&[("a", &["b", "c"]), ("b", &["c"]), ("c", &["elsewhere"])]), None);
    assert_eq!(graph(&[("a", &["b"]), ("b", &["c"]), ("c", &["b"])]).unwrap().len(), 3);
}

#[test]
fn the_core_knows_no_json_clock_thread_file_or_chance() {
    for (file, text) in sources("crates/core/src", "rs") {
        for word in ["serde", "tokio", "std::time", "SystemTime", "Instant::now", "std::thread", "std::fs", "rand::"] {
            assert!(!text.contains(word), "{} names {word}", file.display());
        }
    }
    let manifest = fs::read_to_string(root().join("crates/core/Cargo.toml")).unwrap();
    // What compiles the files of the bodies into it is no part of it.
    let at_run_time = manifest.split("[build-dependencies]").next().unwrap();
    for name in ["serde", "tokio", "axum", "tracing"] {
        assert!(!at_run_time.contains(name), "the core depends on {name}");
    }
}

#[test]
fn integration_has_not_heard_of_flight() {
    let own = sources("crates/core/src", "rs").into_iter().filter(|(file, _)| file.ends_with("integrate.rs"));
    for (file, text) in own.chain(sources("crates/core/src/integrate", "rs")) {
        for word in ["altitude", "planet", "vehicle", "velocity", "atmosphere"] {
            assert!(!text.contains(word), "{} names {word}", file.display());
        }
    }
}

/// Angles are converted in `wire` alone, jobs are begun in `compute` alone, and `error` alone knows which failure has which status.
#[test]
fn each_duty_has_one_place() {
    for (file, text) in sources("crates", "rs") {
        let name = file.display().to_string();
        let only = |word: &str, places: &[&str]| {
            let here = places.iter().any(|place| name.contains(place));
            assert!(here || !text.contains(word), "{name} has {word}, which belongs to {places:?}");
        };
        only("to_degrees()", &["src/wire", "tests"]);
        only("to_radians()", &["src/wire", "tests"]);
        only("spawn_blocking", &["src/compute/turns.rs"]);
        only("UNPROCESSABLE_ENTITY", &["src/error.rs"]);
        only("std::env", &["src/config.rs", "src/allocator.rs", "build.rs"]);
    }
}

#[test]
fn nothing_is_left_to_do_and_nothing_panics_on_purpose() {
    for (file, text) in sources("crates", "rs") {
        for word in ["TODO", "FIXME", "XXX", "todo!(", "unimplemented!(", "#[ignore", "dbg!("] {
            assert!(!text.contains(word), "{} has {word}", file.display());
        }
        // Wider instructions are chosen while the program runs.
        assert!(!text.contains("unsafe ") || file.ends_with("core/src/integrate/lanes.rs"), "{}", file.display());
    }
}

/// Whether `.dockerignore` keeps a path from the builder: the last of its lines that matches the path or a parent decides.
fn is_ignored(lines: &str, path: &str) -> bool {
    let matches = |pattern: &str| pattern == "*" || Path::new(path).starts_with(pattern);
    let of_line = |line: &str| match line.strip_prefix('!') {
        Some(pattern) => matches(pattern).then_some(false),
        None => matches(line).then_some(true),
    };
    lines.lines().filter(|line| !line.starts_with('#')).filter_map(of_line).next_back().unwrap_or(false)
}

/// A file of tests that no program takes in would pass whatever it says.
#[test]
fn every_file_of_tests_is_in_a_program() {
    let read = |path: &Path| fs::read_to_string(path).unwrap();
    let manifests = ["tests/Cargo.toml", "tests/fuzz/Cargo.toml"].map(|file| read(&root().join(file))).concat();
    for (path, _) in sources("tests", "rs") {
        let [name, stem] = [path.file_name(), path.file_stem()].map(|name| name.unwrap().to_str().unwrap());
        let folder = path.parent().unwrap();
        // A file is a program of a manifest, or a module of the file that stands for its folder, which `mod.rs` itself is to the one above.
        let (name, above) = match name {
            "mod.rs" => (folder.file_name().unwrap().to_str().unwrap(), folder.parent().unwrap()),
            _ => (stem, folder),
        };
        let parents = ["mod.rs", "main.rs", "lib.rs"].map(|parent| above.join(parent));
        let is_module = |parent: &PathBuf| parent.exists() && read(parent).contains(&format!("mod {name};"));
        let file = format!("/{stem}.rs\"");
        let is_program = [file.clone(), file.replacen('/', "\"", 1)].iter().any(|file| manifests.contains(file));
        assert!(parents.iter().any(is_module) || is_program, "{} is in no program", path.display());
    }
}

/// A newcomer is led by the files that these name.
#[test]
fn every_path_that_the_documents_name_exists() {
    let mut named = 0;
    for document in ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "BENCHMARKS.md"] {
        let text = fs::read_to_string(root().join(document)).unwrap();
        for code in text.split('`').skip(1).step_by(2) {
            let path = code.trim_end_matches('/');
            if [".rs", ".json", ".yaml"].iter().any(|end| path.ends_with(end)) && !path.contains([' ', '*', '{']) {
                // A file may be named by its end, as its neighbour was before it.
                let found =
                    ["", "crates/core/src", "crates/service/src", "tests"].map(|folder| root().join(folder).join(path));
                assert!(found.iter().any(|path| path.exists()), "{document}: {path} does not exist");
                named += 1;
            }
        }
    }
    assert!(named > 20, "only {named} files are named");
}

#[test]
fn every_path_that_the_dockerfile_copies_is_there() {
    let dockerfile = fs::read_to_string(root().join("Dockerfile")).unwrap();
    let ignored = fs::read_to_string(root().join(".dockerignore")).unwrap();
    assert!(
        ["target", "tests/live", "crates/service/ui/node_modules"].iter().all(|path| is_ignored(&ignored, path)),
        "too much is sent to the builder"
    );
    let mut copied = 0;
    for line in dockerfile.lines().filter(|line| line.starts_with("COPY ") && !line.contains("--from=")) {
        let paths: Vec<_> = line.split_whitespace().skip(1).filter(|word| !word.starts_with("--")).collect();
        for path in &paths[..paths.len() - 1] {
            assert!(root().join(path).exists(), "{line}: {path} does not exist");
            assert!(!is_ignored(&ignored, path), "{line}: .dockerignore excludes {path}");
            copied += 1;
        }
    }
    assert!(copied > 0, "the Dockerfile copies nothing");
}
