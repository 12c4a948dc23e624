//! `GET /licences`: everything in the program is there, with its licence, and none of them asks for more than a notice.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use reentry::body::BODIES;
use reentry_service::licences::{Component, Licences, Part};
use reentry_tests::service::{Answer, Service};
use serde_json::Value;

/// Licences that ask for no more than a notice. `deny.toml` allows those of crates; the rest are of data, and of what the pages load.
const PERMISSIVE: [&str; 11] = [
    "MIT",
    "MIT-0",
    "Apache-2.0",
    "BSD-2-Clause",
    "BSD-3-Clause",
    "ISC",
    "Unicode-3.0",
    "Unlicense",
    "Zlib",
    "CC-BY-4.0",
    "LicenseRef-public-domain",
];

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn all() -> Licences {
    Licences::of_program().unwrap()
}

/// The names and versions of the components of a part.
fn named(part: Part) -> BTreeSet<(String, String)> {
    let components = all().components.into_iter().filter(|component| component.part == part);
    components.map(|component| (component.name, component.version.unwrap_or_default())).collect()
}

/// The component of a name.
fn component(name: &str) -> (Component, String) {
    let all = all();
    let component = all.components.into_iter().find(|component| component.name.starts_with(name)).unwrap();
    let texts = component.texts.iter().map(|index| all.texts[*index].clone()).collect::<Vec<_>>().join("\n");
    (component, texts)
}

async fn get(path: &str, accept: &str) -> Answer {
    let request = Request::builder().uri(path).header(header::ACCEPT, accept).body(Body::empty());
    Service::new().send(request.unwrap()).await
}

/// Cargo is asked once more: the build may not have noticed a change.
#[test]
fn every_crate_that_is_linked_is_there() {
    let listing = Command::new(env!("CARGO"))
        .args(["tree", "--quiet", "--locked", "--offline", "--package=reentry-service", "--prefix=none"])
        .args(["--edges=normal,no-proc-macro", "--no-dedupe", "--format={p}"])
        .current_dir(root())
        .output()
        .unwrap();
    assert!(listing.status.success(), "{}", String::from_utf8_lossy(&listing.stderr));
    let listing = String::from_utf8(listing.stdout).unwrap();
    let crates = listing.lines().filter_map(|line| line.split_once(" v"));
    let (own, others): (Vec<_>, Vec<_>) = crates.partition(|(name, _)| name.starts_with("reentry-"));
    assert!(own.len() > 1, "{own:?}");
    let mut expected: BTreeSet<_> =
        others.into_iter().map(|(name, version)| (name.to_owned(), version.to_owned())).collect();
    assert!(expected.len() > 100, "only {} crates", expected.len());
    let (library, _) = component("Rust standard library");
    expected.insert((library.name, library.version.unwrap()));
    assert_eq!(named(Part::Crate), expected);
}

/// The lock file and the manifest, in which the list of cargo has its source.
#[test]
fn the_crates_are_those_of_the_lock_file() {
    let lock = fs::read_to_string(root().join("Cargo.lock")).unwrap();
    let crates = named(Part::Crate);
    for (name, version) in &crates {
        let entry = format!("name = \"{name}\"\nversion = \"{version}\"\n");
        assert!(name == "Rust standard library" || lock.contains(&entry), "{name} {version} is not in Cargo.lock");
    }
    let manifest = fs::read_to_string(root().join("crates/service/Cargo.toml")).unwrap();
    let dependencies = manifest.split("[dependencies]\n").nth(1).unwrap().split("\n\n").next().unwrap();
    let names = dependencies.lines().filter_map(|line| line.split_once(".workspace")).map(|(name, _)| name);
    for name in names.filter(|name| *name != "reentry-core") {
        assert!(crates.iter().any(|(known, _)| known == name), "{name}");
    }
}

#[test]
fn every_package_of_the_page_is_there() {
    let packages = named(Part::Page);
    // Without Node, there is a page that loads nothing.
    if !root().join("crates/service/ui/dist/index.html").exists() {
        assert_eq!(packages.len(), 1, "{packages:?}");
        return;
    }
    let manifest = fs::read_to_string(root().join("crates/service/ui/package.json")).unwrap();
    let manifest: Value = serde_json::from_str(&manifest).unwrap();
    for (name, version) in manifest["dependencies"].as_object().unwrap() {
        assert!(packages.contains(&(name.clone(), version.as_str().unwrap().to_owned())), "{name} {version}");
    }
    assert!(component("Natural Earth").1.contains("public domain"));
}

/// The files of the bodies say which of their numbers have a licence.
#[test]
fn the_notice_of_the_atmospheres_is_there() {
    let words = |text: &str| text.replace(',', "").split_whitespace().collect::<Vec<_>>().join(" ");
    let (basilisk, text) = component("Basilisk");
    let mut count = 0;
    for body in BODIES {
        let source: Value = serde_json::from_str(body.source).unwrap();
        let Some(licence) = source["atmosphere"]["licence"].as_str() else { continue };
        let (expression, notice) = licence.split_once(", ").unwrap();
        assert_eq!((expression, basilisk.part), (basilisk.licence.as_str(), Part::Data));
        assert!(words(&text).contains(&words(notice)), "{}: {notice}", body.name);
        assert!(basilisk.name.contains(body.title), "{} is not named", body.title);
        count += 1;
    }
    assert_eq!(count, 5);
    assert!(words(&text).contains("permission notice appear in all copies"), "{text}");
}

#[tokio::test]
async fn the_documentation_is_of_the_version_that_is_named() {
    let (component, text) = component("swagger-ui");
    assert!(text.contains("SmartBear Software Inc."), "{text}");
    let bundle = get("/docs/swagger-ui-bundle.js", "*/*").await;
    let version = format!("PACKAGE_VERSION:\"{}\"", component.version.unwrap());
    assert!(String::from_utf8_lossy(&bundle.body).contains(&version), "the documentation is not of {version}");
}

/// Whether an SPDX expression can be met with permissive licences alone.
fn is_permissive(expression: &str) -> bool {
    let spaced = expression.replace('(', " ( ").replace(')', " ) ").replace(" WITH ", "-WITH-");
    let words: Vec<_> = spaced.split_whitespace().collect();
    let mut words = words.as_slice();
    let permissive = is_choice_permissive(&mut words);
    assert!(words.is_empty(), "{expression} goes on with {words:?}");
    permissive
}

fn is_choice_permissive(words: &mut &[&str]) -> bool {
    let mut permissive = is_sum_permissive(words);
    while let ["OR", rest @ ..] = words {
        *words = rest;
        permissive |= is_sum_permissive(words);
    }
    permissive
}

fn is_sum_permissive(words: &mut &[&str]) -> bool {
    let mut permissive = is_one_permissive(words);
    while let ["AND", rest @ ..] = words {
        *words = rest;
        permissive &= is_one_permissive(words);
    }
    permissive
}

fn is_one_permissive(words: &mut &[&str]) -> bool {
    let (first, rest) = words.split_first().unwrap();
    *words = rest;
    if *first != "(" {
        return PERMISSIVE.contains(first);
    }
    let permissive = is_choice_permissive(words);
    let [")", rest @ ..] = words else { panic!("a bracket is open before {words:?}") };
    *words = rest;
    permissive
}

#[test]
fn every_licence_is_permissive_and_every_component_has_its_text() {
    let all = all();
    for component in &all.components {
        assert!(is_permissive(&component.licence), "{} is under {}", component.name, component.licence);
        assert!(!component.texts.is_empty(), "{} has no text", component.name);
    }
    for (index, text) in all.texts.iter().enumerate() {
        assert!(all.components.iter().any(|component| component.texts.contains(&index)), "nobody has text {index}");
        assert!(!text.contains("GNU GENERAL PUBLIC LICENSE"), "text {index} is of a licence that was not chosen");
    }
    let [distinct, texts] = [all.texts.iter().collect::<BTreeSet<_>>().len(), all.texts.len()];
    assert_eq!(distinct, texts, "a text is there twice");
}

#[test]
fn expressions_are_understood() {
    for (expression, permissive) in [
        ("MIT", true),
        ("GPL-3.0-only", false),
        ("MIT OR GPL-2.0-only", true),
        ("MIT AND MPL-2.0", false),
        ("MIT AND MPL-2.0 OR ISC", true),
        ("MIT AND (MPL-2.0 OR ISC)", true),
        ("(MIT OR Apache-2.0) AND LGPL-3.0-or-later", false),
        ("Apache-2.0 WITH LLVM-exception", false),
        ("Apache-2.0 WITH LLVM-exception OR MIT", true),
    ] {
        assert_eq!(is_permissive(expression), permissive, "{expression}");
    }
}

#[tokio::test]
async fn the_text_has_what_the_json_has() {
    let text = get("/licences", "*/*").await;
    assert_eq!(text.headers[header::CONTENT_TYPE], "text/plain; charset=utf-8");
    let text = String::from_utf8(text.body.to_vec()).unwrap();
    let json = get("/licences", "application/json").await;
    assert_eq!(json.headers[header::CONTENT_TYPE], "application/json");
    let all: Licences = serde_json::from_slice(&json.body).unwrap();
    assert_eq!(all.version, env!("CARGO_PKG_VERSION"));
    let rule = format!("\n{}\n", "-".repeat(80));
    let parts: Vec<_> = text.split(&rule).collect();
    let mut from = 0;
    for component in &all.components {
        let title = [Some(component.name.as_str()), component.version.as_deref()].into_iter().flatten();
        let title = title.collect::<Vec<_>>().join(" ");
        let numbers: Vec<_> = component.texts.iter().map(|index| format!("[{}]", index + 1)).collect();
        let line = format!("\n  {title}: {} {}\n", component.licence, numbers.join(" "));
        from += parts[0][from..].find(&line).unwrap_or_else(|| panic!("{line} is not where it should be"));
        for index in &component.texts {
            // Its name may be cut by the end of a line.
            let [head, _] = parts[index + 1].split_once("\n\n").map(|(head, text)| [head, text]).unwrap();
            let owners = head.split_whitespace().collect::<Vec<_>>().join(" ");
            assert!(owners.contains(&title), "text {} is not of {title}: {owners}", index + 1);
        }
    }
    assert_eq!(parts.len(), all.texts.len() + 1);
    for (index, (part, expected)) in parts.iter().skip(1).zip(&all.texts).enumerate() {
        assert!(part.starts_with(&format!("[{}] ", index + 1)), "{part}");
        assert_eq!(part.split_once("\n\n").unwrap().1.trim_end_matches('\n'), expected, "text {}", index + 1);
    }
    let odd = text.chars().find(|char| char.is_control() && !['\n', '\t'].contains(char));
    assert_eq!(odd, None, "a terminal would be told {odd:?}");
}

#[tokio::test]
async fn a_browser_gets_the_text() {
    let browser = "text/html,application/xhtml+xml,application/xml;q=0.9,*/*;q=0.8";
    for (path, accept, expected) in [
        ("/licences", browser, "text/plain; charset=utf-8"),
        ("/licences", "text/plain", "text/plain; charset=utf-8"),
        ("/licences", "application/json, */*;q=0.1", "application/json"),
        ("/licences?format=json", browser, "application/json"),
        ("/licences?format=text", "application/json", "text/plain; charset=utf-8"),
    ] {
        assert_eq!(get(path, accept).await.headers[header::CONTENT_TYPE], expected, "{path} for {accept}");
    }
    assert_eq!(get("/licences", "text/csv").await.status, StatusCode::NOT_ACCEPTABLE);
    assert_eq!(get("/licences?format=html", "*/*").await.status, StatusCode::NOT_ACCEPTABLE);
    assert_eq!(get("/licences?of=axum", "*/*").await.status, StatusCode::BAD_REQUEST);
}
