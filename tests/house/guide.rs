//! The guide and the README: no dead link, and a section for every field, problem and warning.
#![allow(clippy::unwrap_used, reason = "a test stops where it meets what it does not expect, its helpers included")]

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};

use axum::body::Body;
use axum::http::{Request, StatusCode, header};
use reentry_service::document;
use reentry_tests::service::{Answer, Service};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

/// The values of an attribute in HTML; code that shows such has no tag around it.
fn attributes<'a>(html: &'a str, name: &str) -> Vec<&'a str> {
    let tags = html.split('<').skip(1).filter_map(|rest| rest.split('>').next());
    let value = |tag: &'a str| tag.split_once(&format!(" {name}=\"")).and_then(|(_, rest)| rest.split('"').next());
    tags.filter_map(value).collect()
}

/// A link of a page, as the browser resolves it.
fn resolved(page: &str, link: &str) -> (String, String) {
    let (path, fragment) = link.split_once('#').unwrap_or((link, ""));
    let mut parts: Vec<&str> = page.split('/').collect();
    if path.is_empty() {
        return (page.to_owned(), fragment.to_owned());
    }
    parts.pop();
    for part in path.split('/') {
        match part {
            ".." => drop(parts.pop()),
            "." => {}
            part => parts.push(part),
        }
    }
    (parts.join("/"), fragment.to_owned())
}

async fn page(service: &Service, path: &str) -> Answer {
    let request = Request::builder().uri(path).header(header::ACCEPT, "text/html,*/*;q=0.8").body(Body::empty());
    service.send(request.unwrap()).await
}

/// The names of all kinds of problems, as the source has them.
fn problems() -> BTreeSet<String> {
    let source = fs::read_to_string(root().join("crates/service/src/error.rs")).unwrap();
    source.split("\"/problems/").skip(1).filter_map(|rest| rest.split('"').next()).map(str::to_owned).collect()
}

#[tokio::test]
async fn no_link_of_the_guide_is_dead() {
    let service = Service::patient();
    let mut ids: BTreeMap<String, BTreeSet<String>> = BTreeMap::new();
    let mut links: Vec<(String, String, String)> = Vec::new();
    let mut open = vec!["/guide/".to_owned()];
    open.extend(problems().into_iter().map(|name| format!("/problems/{name}")));
    while let Some(path) = open.pop() {
        if ids.contains_key(&path) {
            continue;
        }
        let answer = page(&service, &path).await;
        assert_eq!(answer.status, StatusCode::OK, "{path}");
        let is_page = ["/guide/", "/problems/", "/warnings/"].iter().any(|folder| path.starts_with(folder))
            && !path.contains('.');
        let html = if is_page { String::from_utf8(answer.body.to_vec()).unwrap() } else { String::new() };
        let found = attributes(&html, "id");
        let own: BTreeSet<_> = found.iter().map(|id| (*id).to_owned()).collect();
        assert_eq!(own.len(), found.len(), "{path} has an id twice");
        ids.insert(path.clone(), own);
        for link in attributes(&html, "href").into_iter().chain(attributes(&html, "src")) {
            if link.starts_with("https://") {
                assert!(path.ends_with("/sources"), "{path} leads elsewhere: {link}");
                continue;
            }
            let (to, fragment) = resolved(&path, link);
            assert!(to.starts_with('/'), "{path}: {link}");
            open.push(to.clone());
            links.push((path.clone(), to, fragment));
        }
    }
    assert!(ids.len() > 45 && links.len() > 1000, "{} pages, {} links", ids.len(), links.len());
    for (from, to, fragment) in links {
        assert!(
            fragment.is_empty() || ids[&to].contains(&fragment),
            "{from} leads to {to}#{fragment}, which is not there"
        );
    }
}

/// The Markdown is read as files, too.
#[test]
fn no_link_of_a_document_is_dead() {
    let mut documents: Vec<_> =
        ["README.md", "CONTRIBUTING.md", "CHANGELOG.md", "BENCHMARKS.md"].map(|name| root().join(name)).into();
    let chapters = fs::read_dir(root().join("crates/service/guide")).unwrap().map(|entry| entry.unwrap().path());
    documents.extend(chapters.filter(|path| path.extension().is_some_and(|end| end == "md")));
    let mut count = 0;
    for document in documents {
        let text = fs::read_to_string(&document).unwrap();
        for link in text.split("](").skip(1).filter_map(|rest| rest.split(')').next()) {
            let (path, _) = link.split_once('#').unwrap_or((link, ""));
            if path.is_empty() || path.starts_with(['/', '<']) || path.starts_with("http") || path.contains(' ') {
                continue;
            }
            assert!(document.parent().unwrap().join(path).exists(), "{}: {link}", document.display());
            count += 1;
        }
    }
    assert!(count > 100, "{count}");
}

#[test]
fn the_readme_answers_the_first_question_in_200_lines() {
    let readme = fs::read_to_string(root().join("README.md")).unwrap();
    assert!(readme.lines().count() <= 200);
}

#[tokio::test]
async fn every_problem_and_every_warning_has_a_page_in_html_and_json() {
    let service = Service::new();
    let problems = problems();
    let source = fs::read_to_string(root().join("crates/service/src/wire/warning.rs")).unwrap();
    let source = source.split("#[cfg(test)]").next().unwrap();
    // All texts of one word, of which one is that of a correlation.
    let is_code = |text: &str| text.contains('_') && text.chars().all(|char| char.is_ascii_lowercase() || char == '_');
    let warnings: BTreeSet<_> =
        source.split('"').skip(1).step_by(2).filter(|text| is_code(text) && *text != "tauber_sutton").collect();
    assert!(problems.len() >= 25, "{problems:?}");
    for code in ["angle_unit_assumed", "outside_table", "long_flight", "propellant_spent", "circular_orbit"] {
        assert!(warnings.contains(code), "{code} is not among {warnings:?}");
    }
    let paths =
        problems.iter().map(|name| ("problems", name.as_str())).chain(warnings.iter().map(|code| ("warnings", *code)));
    for (folder, name) in paths {
        let path = format!("/{folder}/{name}");
        let html = page(&service, &path).await;
        assert_eq!(html.status, StatusCode::OK, "{path} has no section in guide/{folder}.md");
        assert_eq!(html.headers[header::CONTENT_TYPE], "text/html; charset=utf-8");
        let json = service.get(&path).await;
        assert_eq!(json.headers[header::CONTENT_TYPE], "application/json");
        let document = json.json();
        let named = if folder == "problems" { ("type", path.as_str()) } else { ("code", name) };
        assert_eq!(document[named.0], named.1);
        assert!(document["description"].as_str().unwrap().contains("What to do:"), "{path} does not say what to do");
        let title = document["title"].as_str().unwrap();
        assert!(String::from_utf8_lossy(&html.body).contains(title), "{path}");
    }
    assert_eq!(service.get("/problems/nothing").await.status, StatusCode::NOT_FOUND);
    assert_eq!(service.get("/guide/nothing").await.status, StatusCode::NOT_FOUND);
}

/// The page's folds and faults lead to the section of a field.
#[test]
fn every_part_of_a_case_has_a_section() {
    let chapter = fs::read_to_string(root().join("crates/service/guide/case.md")).unwrap();
    let document = document();
    let request = document["components"]["schemas"]["SimulateRequest"]["properties"].as_object().unwrap();
    for field in request.keys() {
        assert!(chapter.contains(&format!("{{#{field}}}")), "guide/case.md has no section {field}");
    }
}

#[tokio::test]
async fn the_search_finds_every_section() {
    let service = Service::new();
    let index = service.get("/guide/search.json").await.json();
    let sections = index.as_array().unwrap();
    assert!(sections.len() > 100, "{}", sections.len());
    for section in sections {
        for member in ["chapter", "path", "heading", "text"] {
            assert!(section[member].is_string(), "{section}");
        }
    }
    let about = |word: &str| sections.iter().filter(|section| section["text"].as_str().unwrap().contains(word)).count();
    assert!(about("Sutton") > 0 && about("geodetic_altitude") > 0);
}
