//! The page at `/` and what it loads: caching, codings, protection. They hold for the page and for the short one in its place.

use axum::body::Body;
use axum::http::{HeaderMap, HeaderValue, Method, Request, StatusCode, header};
use reentry_service::coding::Coding;
use reentry_service::config::Config;
use reentry_service::embedded::File;
use reentry_tests::service::{Answer, Service};

use super::refusal::problem;

const FILE: File =
    File { path: "/assets/a.js", hash: "0123", plain: b"as it is", brotli: Some(b"by brotli"), gzip: Some(b"by gzip") };

async fn ask(service: &Service, method: Method, path: &str, headers: &[(&str, &str)]) -> Answer {
    let request = headers
        .iter()
        .fold(Request::builder().method(method).uri(path), |request, (name, value)| request.header(*name, *value));
    service.send(request.body(Body::empty()).unwrap()).await
}

async fn get(path: &str, headers: &[(&str, &str)]) -> Answer {
    ask(&Service::new(), Method::GET, path, headers).await
}

async fn page() -> String {
    String::from_utf8(get("/", &[]).await.body.to_vec()).unwrap()
}

/// The paths that a page names.
fn references(page: &str) -> Vec<String> {
    let values = ["src=\"", "href=\""].into_iter().flat_map(|attribute| page.split(attribute).skip(1));
    values.map(|rest| rest.split('"').next().unwrap().trim_start_matches('.').to_owned()).collect()
}

async fn assets() -> Vec<String> {
    let assets: Vec<_> = references(&page().await).into_iter().filter(|path| path.starts_with("/assets/")).collect();
    assert!(!assets.is_empty(), "the page loads nothing");
    assets
}

fn headers(lines: &[(&'static str, &'static str)]) -> HeaderMap {
    let mut headers = HeaderMap::new();
    for (name, value) in lines {
        headers.append(*name, HeaderValue::from_static(value));
    }
    headers
}

#[tokio::test]
async fn all_that_the_page_names_is_there() {
    let paths = references(&page().await);
    assert!(paths.iter().any(|path| path.starts_with("/docs")), "no link to the documentation: {paths:?}");
    for path in paths {
        assert!(path.starts_with('/'), "{path} is elsewhere");
        assert_eq!(get(&path, &[]).await.status, StatusCode::OK, "{path}");
    }
}

#[tokio::test]
async fn the_page_is_asked_for_anew_and_the_rest_is_kept() {
    let page = get("/", &[]).await;
    assert_eq!(page.headers[header::CACHE_CONTROL], "no-cache");
    assert_eq!(page.headers[header::CONTENT_TYPE], "text/html; charset=utf-8");
    for path in assets().await {
        let asset = get(&path, &[]).await;
        assert_eq!(asset.headers[header::CACHE_CONTROL], "public, max-age=31536000, immutable", "{path}");
        let expected = match path.rsplit('.').next().unwrap() {
            "js" => "text/javascript; charset=utf-8",
            "css" => "text/css; charset=utf-8",
            "svg" => "image/svg+xml",
            other => panic!("{path}: what is {other}?"),
        };
        assert_eq!(asset.headers[header::CONTENT_TYPE], expected, "{path}");
    }
}

#[tokio::test]
async fn nothing_but_the_service_may_be_loaded_or_run() {
    let mut paths = assets().await;
    paths.push("/".to_owned());
    for path in paths {
        let answer = get(&path, &[]).await;
        let policy = answer.headers[header::CONTENT_SECURITY_POLICY].to_str().unwrap();
        assert!(policy.starts_with("default-src 'none'; "), "{policy}");
        assert!(!policy.contains("unsafe") && !policy.contains('*'), "{policy}");
        assert_eq!(answer.headers[header::X_CONTENT_TYPE_OPTIONS], "nosniff", "{path}");
        assert_eq!(answer.headers[header::REFERRER_POLICY], "no-referrer", "{path}");
    }
    // The policy would keep these from working.
    let page = page().await;
    assert!(!page.contains("<style") && !page.contains(" style="), "{page}");
    assert!(page.split("<script").skip(1).all(|rest| rest.split('>').next().unwrap().contains(" src=")), "{page}");
}

#[tokio::test]
async fn a_page_that_the_client_has_is_not_sent_again() {
    let service = Service::new();
    for coding in ["identity", "gzip", "br"] {
        let ask = async |known: &str| {
            let headers = [("accept-encoding", coding), ("if-none-match", known)];
            ask(&service, Method::GET, "/", &headers).await
        };
        let first = ask("\"other\"").await;
        assert_eq!(first.status, StatusCode::OK);
        let tag = first.headers[header::ETAG].to_str().unwrap();
        assert!(tag.starts_with('"') && tag.ends_with('"'), "{tag} is not strong");
        for known in [tag.to_owned(), format!("\"other\", {tag}"), format!("W/{tag}"), "*".to_owned()] {
            let again = ask(&known).await;
            assert_eq!(again.status, StatusCode::NOT_MODIFIED, "{known}");
            assert!(again.body.is_empty());
            for name in [header::ETAG, header::CACHE_CONTROL] {
                assert_eq!(again.headers[&name], first.headers[&name]);
            }
        }
    }
}

#[test]
fn the_coding_is_the_one_that_the_client_likes_best() {
    for (accepted, coding) in [
        ("br", "br"),
        ("gzip", "gzip"),
        ("gzip, deflate, br, zstd", "br"),
        ("BR", "br"),
        ("br;q=0.5, gzip;q=0.8", "gzip"),
        ("br ; q=0.5 , gzip ; Q=0.4", "br"),
        ("br;q=0, gzip", "gzip"),
        ("br;q=0, gzip;q=0", "identity"),
        ("identity, br;q=0.9", "identity"),
        ("identity;q=0.5, gzip;q=0.5", "gzip"),
        ("*", "br"),
        ("br;q=0, *;q=0.1", "gzip"),
        ("*;q=0, gzip", "gzip"),
        ("identity;q=0, br", "br"),
        ("zstd, deflate", "identity"),
        ("br;q=x", "identity"),
        ("brr", "identity"),
        ("identity", "identity"),
        ("identity;q=0", "identity"),
        ("", "identity"),
    ] {
        let request = headers(&[("accept-encoding", accepted)]);
        let bytes = match coding {
            "br" => FILE.brotli.unwrap(),
            "gzip" => FILE.gzip.unwrap(),
            _ => FILE.plain,
        };
        let (chosen, text) = FILE.representation(&request);
        assert_eq!((chosen.name(), text), (coding, bytes), "{accepted}");
    }
    assert_eq!(FILE.representation(&HeaderMap::new()).0, Coding::Identity);
    assert_eq!(
        FILE.representation(&headers(&[("accept-encoding", "gzip"), ("accept-encoding", "br")])).0,
        Coding::Brotli
    );
    let uncompressed = File { brotli: None, gzip: None, ..FILE };
    assert_eq!(
        uncompressed.representation(&headers(&[("accept-encoding", "br, gzip")])),
        (Coding::Identity, FILE.plain)
    );
}

#[test]
fn an_answer_tells_its_coding_and_has_a_tag_of_its_own() {
    let mut tags = Vec::new();
    for (accepted, coding, length) in [("br", Some("br"), 9), ("gzip", Some("gzip"), 7), ("identity", None, 8)] {
        let answer = FILE.answer(&headers(&[("accept-encoding", accepted)]));
        assert_eq!(answer.headers().get(header::CONTENT_ENCODING).map(|coding| coding.to_str().unwrap()), coding);
        assert_eq!(answer.headers()[header::VARY], "accept-encoding");
        assert_eq!(axum::body::HttpBody::size_hint(answer.body()).exact(), Some(length));
        tags.push(answer.headers()[header::ETAG].clone());
        // Of another coding, the client has other bytes.
        let others = tags.iter().take(tags.len() - 1);
        assert!(others.clone().all(|other| other != tags.last().unwrap()), "{tags:?}");
    }
    let known = FILE.answer(&headers(&[("accept-encoding", "br"), ("if-none-match", "\"0123-br\"")]));
    assert_eq!(known.status(), StatusCode::NOT_MODIFIED);
    assert_eq!(known.headers()[header::VARY], "accept-encoding");
    assert!(!known.headers().contains_key(header::CONTENT_ENCODING));
    let other = FILE.answer(&headers(&[("accept-encoding", "gzip"), ("if-none-match", "\"0123-br\"")]));
    assert_eq!(other.status(), StatusCode::OK);
}

/// The layer that compresses answers knows no Brotli, and would refuse a client that knows nothing else.
#[tokio::test]
async fn the_page_is_not_compressed_again() {
    let service = Service::with(Config { compress_above: 0, ..Config::default() });
    let zstd = [("accept-encoding", "zstd")];
    let document = ask(&service, Method::GET, "/openapi.json", &zstd).await;
    assert_eq!(document.headers[header::CONTENT_ENCODING], "zstd");
    let mut paths = assets().await;
    paths.push("/".to_owned());
    for path in paths {
        let plain = ask(&service, Method::GET, &path, &[]).await;
        let answer = ask(&service, Method::GET, &path, &zstd).await;
        assert!(!answer.headers.contains_key(header::CONTENT_ENCODING), "{path}");
        assert_eq!(answer.body, plain.body, "{path}");
        let answer = ask(&service, Method::GET, &path, &[("accept-encoding", "br, identity;q=0")]).await;
        assert_eq!(answer.status, StatusCode::OK, "{path}");
        assert!(answer.headers.get_all(header::VARY).iter().any(|name| name == "accept-encoding"), "{path}");
    }
}

#[tokio::test]
async fn a_head_request_for_the_page_has_its_headers() {
    let service = Service::new();
    let get = ask(&service, Method::GET, "/", &[]).await;
    let head = ask(&service, Method::HEAD, "/", &[]).await;
    assert_eq!(head.status, StatusCode::OK);
    assert!(head.body.is_empty());
    assert_eq!(head.headers[header::CONTENT_LENGTH], get.body.len().to_string());
    assert_eq!(head.headers[header::ETAG], get.headers[header::ETAG]);
}

#[tokio::test]
async fn what_is_not_a_part_of_the_page_is_a_problem() {
    let service = Service::new();
    let asset = assets().await.remove(0);
    let siblings = [format!("{asset}.br"), format!("{asset}.gz"), format!("{asset}/"), format!("/{asset}")];
    let others = ["/assets", "/assets/", "/assets/nothing.js", "/assets/%ff", "/assets/../index.html", "/index.html"];
    for path in siblings.iter().map(String::as_str).chain(others) {
        let answer = service.get(path).await;
        let problem = problem(&answer);
        assert_eq!(problem["type"], "/problems/not-found", "{path}");
        assert!(problem["detail"].as_str().unwrap().contains(path), "{problem}");
        assert_eq!(answer.headers[header::CACHE_CONTROL], "no-store", "{path} is kept");
    }
}
