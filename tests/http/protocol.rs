//! What HTTP asks for beside the two endpoints' own matter: media types, methods, negotiation, identifiers, CORS, compression.

use axum::body::Body;
use axum::http::{HeaderValue, Method, Request, StatusCode, header};
use reentry_service::config::Config;
use reentry_tests::service::{Answer, Service};
use serde_json::json;

use super::refusal::{Steady, problem};
use super::requests::{capsule, with};

fn request(method: Method, path: &str, headers: &[(&str, &[u8])], body: impl Into<Body>) -> Request<Body> {
    let mut request = Request::builder().method(method).uri(path);
    for (name, value) in headers {
        request = request.header(*name, HeaderValue::from_bytes(value).unwrap());
    }
    request.body(body.into()).unwrap()
}

async fn post(service: &Service, path: &str, headers: &[(&str, &[u8])]) -> Answer {
    let mut all = vec![("content-type", &b"application/json"[..])];
    all.extend(headers);
    service.send(request(Method::POST, path, &all, capsule().to_string())).await
}

#[tokio::test]
async fn a_body_is_declared_as_json() {
    let steady = Steady::new().await;
    let body = || capsule().to_string();
    for wrong in [
        &b"text/plain"[..],
        b"application/x-www-form-urlencoded",
        b"application/jsonp",
        b"text/json",
        b"json",
        b"",
        b"\xff",
        b"application/xml",
        b"multipart/form-data; boundary=application/json",
    ] {
        let request = request(Method::POST, "/simulate", &[("content-type", wrong)], body());
        assert_eq!(steady.refused(request).await["type"], "/problems/unsupported-media-type", "{wrong:?}");
    }
    let undeclared = request(Method::POST, "/convert", &[], body());
    let problem = steady.refused(undeclared).await;
    assert!(problem["detail"].as_str().unwrap().contains("got nothing"), "{problem}");

    for right in [
        &b"application/json"[..],
        b"application/json; charset=utf-8",
        b"Application/JSON;charset=\"UTF-8\"",
        b"application/problem+json",
        b" application/json ;x=y",
    ] {
        let request = request(Method::POST, "/simulate", &[("content-type", right)], body());
        assert_eq!(steady.service.send(request).await.status, StatusCode::OK, "{right:?}");
    }
}

#[tokio::test]
async fn a_body_may_be_as_long_as_the_limit() {
    let body = capsule().to_string();
    let limit = 4096;
    let service = Service::with(Config { body_limit: limit, ..Config::default() });
    let padded = |length: usize| format!("{body}{}", " ".repeat(length - body.len()));
    assert_eq!(service.post_text("/simulate", padded(limit)).await.status, StatusCode::OK);
    for length in [limit + 1, 100 * limit] {
        let answer = service.post_text("/simulate", padded(length)).await;
        assert_eq!(problem(&answer)["type"], "/problems/payload-too-large");
    }
    assert_eq!(service.post_text("/simulate", body).await.status, StatusCode::OK);
}

#[tokio::test]
async fn a_wrong_method_is_told_the_right_ones() {
    let service = Service::new();
    for (path, right) in [
        ("/simulate", "POST"),
        ("/convert", "POST"),
        ("/analytic", "POST"),
        ("/health/live", "GET,HEAD"),
        ("/health/ready", "GET,HEAD"),
        ("/openapi.json", "GET,HEAD"),
        ("/", "GET,HEAD"),
        ("/assets/nothing.js", "GET,HEAD"),
    ] {
        let wrong = if right == "POST" {
            [Method::GET, Method::PUT, Method::DELETE]
        } else {
            [Method::POST, Method::PATCH, Method::DELETE]
        };
        for method in wrong {
            let answer = service.send(request(method, path, &[], "{}")).await;
            assert_eq!(problem(&answer)["type"], "/problems/method-not-allowed", "{path}");
            assert_eq!(answer.headers[header::ALLOW], right, "{path}");
        }
    }
}

#[tokio::test]
async fn every_unknown_path_is_a_problem() {
    let service = Service::new();
    let mut others = Vec::new();
    for path in [
        "/nothing",
        "/simulate/",
        "/simulate/1",
        "/Simulate",
        "/openapi.yaml",
        "/health",
        "/docs/nothing.js",
        "/docs/../simulate",
        "/%ff",
        "/simulate%00",
    ] {
        let answer = service.get(path).await;
        let media_type = answer.headers.get(header::CONTENT_TYPE).map(|value| value.to_str().unwrap());
        if media_type == Some("application/problem+json") {
            assert_eq!(problem(&answer)["type"], "/problems/not-found", "{path}");
        } else {
            others.push(format!("{path}: {} of {media_type:?}", answer.status));
        }
    }
    assert!(others.is_empty(), "no problem document: {}", others.join(", "));
}

#[tokio::test]
async fn the_representation_follows_the_request() {
    let service = Service::new();
    let (json, csv) = ("application/json", "text/csv");
    for (path, accept, expected) in [
        ("/simulate", None, json),
        ("/simulate", Some("*/*"), json),
        ("/simulate", Some("application/*"), json),
        ("/simulate", Some("text/csv"), csv),
        ("/simulate", Some("TEXT/CSV"), csv),
        ("/simulate", Some("text/*"), csv),
        ("/simulate", Some("text/html, text/csv;q=0.1"), csv),
        ("/simulate", Some("text/csv;q=0.5, application/json;q=0.4"), csv),
        ("/simulate", Some("text/csv;q=0.4, application/json;q=0.5"), json),
        ("/simulate", Some("text/csv, application/json;q=0.9"), csv),
        ("/simulate", Some("*/*;q=0.1, text/csv"), csv),
        ("/simulate", Some("application/json;q=0, */*"), csv),
        ("/simulate", Some("text/csv;q=0, */*"), json),
        ("/simulate", Some("text/csv;Q=0.4, application/json;Q=0.5"), json),
        ("/simulate", Some("text/csv ; q=0.4 , application/json ; q=0.5"), json),
        ("/simulate?format=csv", None, csv),
        ("/simulate?format=csv", Some("application/json"), csv),
        ("/simulate?format=json", Some("text/csv"), json),
        ("/simulate?format=json", Some("text/html"), json),
    ] {
        let headers: Vec<_> = accept.iter().map(|accept| ("accept", accept.as_bytes())).collect();
        let answer = post(&service, path, &headers).await;
        assert_eq!(answer.status, StatusCode::OK, "{path} {accept:?}");
        let media_type = answer.headers[header::CONTENT_TYPE].to_str().unwrap();
        assert_eq!(media_type.split(';').next().unwrap(), expected, "{path} {accept:?}");
        assert_eq!(answer.body[0] == b'{', expected == json, "{path} {accept:?}");
    }
}

#[tokio::test]
async fn a_representation_that_there_is_not_is_refused() {
    let service = Service::new();
    for (path, accept) in [
        ("/simulate", "text/html"),
        ("/simulate", "text/csv;q=0"),
        ("/simulate", "*/*;q=0"),
        ("/simulate", "application/xml, image/*"),
        ("/convert", "text/csv"),
        ("/simulate?format=xml", "*/*"),
        ("/simulate?format=", "*/*"),
        ("/simulate?format=CSV", "*/*"),
        ("/convert?format=csv", "*/*"),
    ] {
        let answer = post(&service, path, &[("accept", accept.as_bytes())]).await;
        assert_eq!(problem(&answer)["type"], "/problems/not-acceptable", "{path} {accept}");
    }
}

#[tokio::test]
async fn an_unknown_query_parameter_is_refused() {
    let service = Service::new();
    for query in ["formt=csv", "format=csv&x=1", "x", "format=csv&format=csv", "=", "Format=csv"] {
        for path in ["/simulate", "/convert"] {
            let answer = post(&service, &format!("{path}?{query}"), &[]).await;
            assert_eq!(problem(&answer)["type"], "/problems/invalid-query", "{query}");
        }
    }
}

#[tokio::test]
async fn a_sound_request_identifier_comes_back() {
    let service = Service::new();
    let longest = "x".repeat(128);
    for id in ["1", "a-b_c.d:e/f", "!\"#$%&'()*+,~", &longest] {
        for path in ["/simulate", "/simulate?x=1", "/nothing"] {
            let answer = post(&service, path, &[("x-request-id", id.as_bytes())]).await;
            assert_eq!(answer.headers["x-request-id"], id);
        }
    }
}

#[tokio::test]
async fn any_other_request_identifier_is_replaced() {
    let service = Service::new();
    let too_long = "x".repeat(129);
    for id in [&b""[..], too_long.as_bytes(), b"a b", b"a\tb", "é".as_bytes(), b"\xff"] {
        let answer = post(&service, "/simulate", &[("x-request-id", id)]).await;
        is_generated(&answer);
    }
    let answers = [service.get("/health/live").await, service.get("/health/live").await];
    answers.iter().for_each(is_generated);
    assert_ne!(answers[0].headers["x-request-id"], answers[1].headers["x-request-id"]);
}

fn is_generated(answer: &Answer) {
    let id = answer.headers["x-request-id"].to_str().unwrap();
    assert_eq!(id.len(), 36, "{id}");
    assert_eq!(id.matches('-').count(), 4, "{id}");
}

#[tokio::test]
async fn pages_of_other_origins_may_call_and_see_the_headers() {
    let service = Service::new();
    let asked = [
        ("origin", &b"https://example.org"[..]),
        ("access-control-request-method", b"POST"),
        ("access-control-request-headers", b"content-type,x-request-id"),
    ];
    let preflight = service.send(request(Method::OPTIONS, "/simulate", &asked, "")).await;
    assert_eq!(preflight.status, StatusCode::OK);
    let list = |answer: &Answer, name: &str| {
        let text = answer.headers[name].to_str().unwrap().to_ascii_lowercase();
        text.split(',').map(|item| item.trim().to_owned()).collect::<Vec<_>>()
    };
    assert_eq!(list(&preflight, "access-control-allow-origin"), ["*"]);
    assert_eq!(list(&preflight, "access-control-allow-methods"), ["get", "post"]);
    for name in ["content-type", "accept", "x-request-id"] {
        assert!(list(&preflight, "access-control-allow-headers").contains(&name.to_owned()), "{name}");
    }
    // A refusal must be readable as well.
    for path in ["/simulate", "/simulate?x=1"] {
        let answer = post(&service, path, &[("origin", b"https://example.org")]).await;
        assert_eq!(list(&answer, "access-control-allow-origin"), ["*"]);
        assert_eq!(
            list(&answer, "access-control-expose-headers"),
            ["x-request-id", "retry-after", "ratelimit-policy", "ratelimit"]
        );
    }
}

#[tokio::test]
async fn answers_are_compressed_above_the_threshold_only() {
    let service = Service::with(Config { compress_above: 8192, ..Config::default() });
    for (count, large) in [(2, false), (1000, true)] {
        let body = with(&capsule(), "/output", json!({"count": count})).to_string();
        for encoding in ["gzip", "zstd"] {
            let headers = [("content-type", &b"application/json"[..]), ("accept-encoding", encoding.as_bytes())];
            let answer = service.send(request(Method::POST, "/simulate", &headers, body.clone())).await;
            assert_eq!(answer.status, StatusCode::OK);
            let found = answer.headers.get(header::CONTENT_ENCODING).map(|value| value.to_str().unwrap());
            assert_eq!(found, large.then_some(encoding), "{count} rows");
            let magic: &[u8] = if encoding == "gzip" { &[0x1f, 0x8b] } else { &[0x28, 0xb5, 0x2f, 0xfd] };
            assert_eq!(answer.body.starts_with(magic), large, "{count} rows, {encoding}");
        }
        let answer = service.post_text("/simulate", body).await;
        assert!(!answer.headers.contains_key(header::CONTENT_ENCODING));
    }
}

#[tokio::test]
async fn the_pages_around_the_endpoints_are_served() {
    let service = Service::new();
    assert_eq!(service.get("/health/live").await.json(), json!({"status": "ok"}));
    assert_eq!(service.get("/health/ready").await.json(), json!({"status": "ok"}));

    let document = service.get("/openapi.json").await;
    assert_eq!(document.headers[header::CONTENT_TYPE], "application/json");
    assert_eq!(document.json(), *reentry_service::document());
}

#[tokio::test]
async fn the_documentation_is_browsable_without_the_internet() {
    let service = Service::new();
    let docs = service.get("/docs").await;
    if docs.status.is_redirection() {
        assert_eq!(docs.headers[header::LOCATION], "/docs/");
    } else {
        assert_eq!(docs.status, StatusCode::OK);
    }
    let page = service.get("/docs/").await;
    assert_eq!(page.status, StatusCode::OK);
    let page = String::from_utf8(page.body.to_vec()).unwrap();
    let mut loaded = 0;
    for attribute in ["src=\"", "href=\""] {
        for rest in page.split(attribute).skip(1) {
            let target = rest.split('"').next().unwrap();
            assert!(!target.contains("//"), "{target} is loaded from elsewhere");
            let path = format!("/docs/{}", target.trim_start_matches("./"));
            let part = service.get(&path).await;
            assert_eq!(part.status, StatusCode::OK, "{path}");
            loaded += 1;
        }
    }
    assert!(loaded >= 3, "{page}");
    let initializer = service.get("/docs/swagger-initializer.js").await;
    assert!(String::from_utf8_lossy(&initializer.body).contains("/openapi.json"));
}

#[tokio::test]
async fn a_head_request_has_the_headers_alone() {
    let answer = Service::new().send(request(Method::HEAD, "/health/live", &[], "")).await;
    assert_eq!(answer.status, StatusCode::OK);
    assert_eq!(answer.body.len(), 0);
}
