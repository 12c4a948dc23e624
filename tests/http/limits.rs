//! What the service lets clients and browsers do: the rate limit, CORS, the headers that protect.

use std::net::SocketAddr;
use std::num::NonZeroU32;
use std::time::Instant;

use axum::body::Body;
use axum::http::{HeaderMap, Request, StatusCode};
use reentry_service::client::Peer;
use reentry_service::config::{Config, Origins};
use reentry_tests::service::{Answer, Service};
use serde_json::{Value, json};

use super::problems::orbiting;
use super::requests::{capsule, with};

/// A service that lets a client send `burst` requests at once, and one in 1000 s after that.
fn limited(burst: u32) -> Service {
    Service::with(Config {
        rate_limit: Some(1e-3),
        rate_burst: NonZeroU32::new(burst).unwrap(),
        trusted_proxies: vec!["192.0.2.0/24".parse().unwrap()],
        ..Config::default()
    })
}

async fn get(service: &Service, path: &str, peer: &str, headers: &[(&str, &str)]) -> Answer {
    let mut request = Request::builder().uri(path).header("host", "reentry.example");
    for (name, value) in headers {
        request = request.header(*name, *value);
    }
    let mut request = request.body(Body::empty()).unwrap();
    request.extensions_mut().insert(Peer(SocketAddr::new(peer.parse().unwrap(), 1234)));
    service.send(request).await
}

fn told(headers: &HeaderMap, name: &str) -> String {
    headers.get(name).map_or(String::new(), |value| value.to_str().unwrap().to_owned())
}

#[tokio::test]
async fn a_client_that_sends_too_much_is_told_when_to_come_back() {
    let service = limited(3);
    for left in [2, 1, 0] {
        let answer = get(&service, "/docs", "203.0.113.1", &[]).await;
        assert_eq!(answer.status, 308);
        assert_eq!(told(&answer.headers, "ratelimit-policy"), "\"client\";q=3;w=3000");
        // What has been taken comes back in so many seconds.
        let reset = 1000 * (3 - left);
        assert_eq!(told(&answer.headers, "ratelimit"), format!("\"client\";r={left};t={reset}"));
    }
    let refused = get(&service, "/docs", "203.0.113.1", &[]).await;
    assert_eq!(refused.status, StatusCode::TOO_MANY_REQUESTS);
    assert_eq!(refused.json()["type"], "/problems/too-many-requests");
    let seconds: u64 = told(&refused.headers, "retry-after").parse().unwrap();
    // The first of the three was taken a moment ago.
    assert!((990..=1000).contains(&seconds), "{seconds}");
    assert_eq!(
        refused.json()["detail"],
        format!("this client has reached its request limit; try again in {seconds} s")
    );
    assert_eq!(told(&refused.headers, "ratelimit"), "\"client\";r=0;t=3000");
    assert!(!told(&refused.headers, "x-request-id").is_empty());
    // Another client is not its fault, and whoever watches the service is no client.
    assert_eq!(get(&service, "/docs", "203.0.113.2", &[]).await.status, 308);
    for path in ["/health/live", "/health/ready", "/metrics"] {
        let answer = get(&service, path, "203.0.113.1", &[]).await;
        assert_eq!(answer.status, 200, "{path}");
        assert_eq!(told(&answer.headers, "ratelimit"), "");
    }
}

#[tokio::test]
async fn what_a_client_may_send_comes_back_with_time() {
    let service =
        Service::with(Config { rate_limit: Some(20.0), rate_burst: NonZeroU32::new(1).unwrap(), ..Config::default() });
    let ask = || get(&service, "/docs", "203.0.113.1", &[]);
    assert_eq!(ask().await.status, 308);
    let mut refusals = 0;
    while ask().await.status == 429 {
        refusals += 1;
    }
    assert!(refusals > 0);
}

#[tokio::test]
async fn every_path_counts_even_one_where_nothing_is() {
    let service = limited(1);
    assert_eq!(get(&service, "/nowhere", "203.0.113.1", &[]).await.status, 404);
    assert_eq!(get(&service, "/", "203.0.113.1", &[]).await.status, 429);
}

#[tokio::test]
async fn clients_behind_a_trusted_proxy_are_told_apart_and_others_are_not_believed() {
    let service = limited(1);
    let ask = async |peer, header| get(&service, "/docs", peer, &[("x-forwarded-for", header)]).await.status.as_u16();
    assert_eq!(ask("192.0.2.7", "203.0.113.1").await, 308);
    assert_eq!(ask("192.0.2.8", "203.0.113.1").await, 429);
    assert_eq!(ask("192.0.2.7", "203.0.113.2").await, 308);
    assert_eq!(ask("198.51.100.1", "203.0.113.3").await, 308);
    assert_eq!(ask("198.51.100.1", "203.0.113.4").await, 429);
}

#[tokio::test]
async fn a_client_has_a_whole_network_of_ipv6() {
    let service = limited(1);
    let ask = async |peer| get(&service, "/docs", peer, &[]).await.status.as_u16();
    assert_eq!(ask("2001:db8:1:2:3::4").await, 308);
    assert_eq!(ask("2001:db8:1:2:ffff:ffff:ffff:ffff").await, 429);
    assert_eq!(ask("2001:db8:1:3::4").await, 308);
    // An address of IPv4 is one, however it is written.
    assert_eq!(ask("::ffff:203.0.113.1").await, 308);
    assert_eq!(ask("203.0.113.1").await, 429);
    assert_eq!(ask("203.0.113.2").await, 308);
}

#[tokio::test]
async fn a_site_of_ipv6_has_eight_times_as_much_as_a_client() {
    let service = limited(1);
    let ask = async |peer: String| get(&service, "/docs", &peer, &[]).await.status.as_u16();
    for network in 0..8 {
        assert_eq!(ask(format!("2001:db8:1:{network}::1")).await, 308, "{network}");
    }
    assert_eq!(ask("2001:db8:1:8::1".to_owned()).await, 429);
    assert_eq!(ask("2001:db8:2:8::1".to_owned()).await, 308);
}

#[tokio::test]
async fn computing_counts_and_may_bring_a_client_into_debt() {
    // A request comes back in 1000 s, and costs as much as 10 ms of computing.
    let service = limited(20);
    let ask = async |path: &str, body: &Value, peer: &str| {
        let request = Request::post(path).header("host", "reentry.example").header("content-type", "application/json");
        let mut request = request.body(Body::from(body.to_string())).unwrap();
        request.extensions_mut().insert(Peer(SocketAddr::new(peer.parse().unwrap(), 1234)));
        service.send(request).await
    };
    let left = async |peer| told(&get(&service, "/docs", peer, &[]).await.headers, "ratelimit");
    let short = with(&capsule(), "/output", json!({"trajectory": false}));
    let answer = ask("/simulate/batch", &json!(vec![&short; 1000]), "203.0.113.1").await;
    assert_eq!(answer.status, 200);
    let batch = left("203.0.113.1").await;
    let reset: f64 = batch.split("t=").nth(1).unwrap().parse().unwrap();
    // A thousand flights take far more than ten times 10 ms.
    assert!(reset > 10_000.0, "{batch}");
    // What was not left is a debt.
    let start = Instant::now();
    // 100 000 steps.
    assert_eq!(ask("/simulate", &orbiting(), "203.0.113.2").await.status, 422);
    let elapsed = start.elapsed().as_secs_f64();
    let refused = get(&service, "/docs", "203.0.113.2", &[]).await;
    assert_eq!(refused.status, 429, "{elapsed} s, {:?}", refused.headers);
    let wait: f64 = told(&refused.headers, "retry-after").parse().unwrap();
    assert!(wait < 1000.0 * (2.0 + elapsed / 0.01 - 20.0), "{wait}, {elapsed}");
    assert_eq!(left("203.0.113.3").await, "\"client\";r=19;t=1000");
}

#[tokio::test]
async fn without_a_limit_nothing_is_said_of_one() {
    let service = Service::new();
    for _ in 0..100 {
        let answer = get(&service, "/health/live", "203.0.113.1", &[]).await;
        assert_eq!((answer.status.as_u16(), told(&answer.headers, "ratelimit-policy")), (200, String::new()));
    }
}

#[tokio::test]
async fn a_browser_lets_the_pages_of_the_origins_in_the_settings_ask_and_no_others() {
    let origins = ["https://planner.example", "http://localhost:5173"].map(|origin| origin.parse().unwrap());
    let service = Service::with(Config { cors_origins: Origins::These(origins.to_vec()), ..Config::default() });
    let allowed = async |origin| {
        let answer = get(&service, "/health/live", "203.0.113.1", &[("origin", origin)]).await;
        assert!(told(&answer.headers, "vary").contains("origin"));
        told(&answer.headers, "access-control-allow-origin")
    };
    assert_eq!(allowed("https://planner.example").await, "https://planner.example");
    assert_eq!(allowed("http://localhost:5173").await, "http://localhost:5173");
    for other in ["https://elsewhere.example", "http://planner.example", "http://localhost", "null"] {
        assert_eq!(allowed(other).await, "", "{other}");
    }
    let closed = Service::with(Config { cors_origins: Origins::These(Vec::new()), ..Config::default() });
    let answer = get(&closed, "/health/live", "203.0.113.1", &[("origin", "https://planner.example")]).await;
    assert_eq!(told(&answer.headers, "access-control-allow-origin"), "");
}

#[tokio::test]
async fn every_answer_protects_the_browser_that_gets_it() {
    let service = limited(1_000);
    let refused = service.post_text("/simulate", "{").await;
    let flown = service.post("/simulate", &capsule()).await;
    let mut answers = vec![(refused, "default-src 'none'; frame"), (flown, "default-src 'none'; frame")];
    for (path, policy) in [
        ("/health/live", "default-src 'none'; frame"),
        ("/metrics", "default-src 'none'; frame"),
        ("/nowhere", "default-src 'none'; frame"),
        ("/openapi.json", "default-src 'none'; frame"),
        ("/", "default-src 'none'; script-src 'self'; style-src 'self'; img"),
        ("/docs/", "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img"),
        ("/docs/swagger-ui.css", "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img"),
    ] {
        answers.push((get(&service, path, "203.0.113.1", &[]).await, policy));
    }
    let hasty = limited(1);
    assert_eq!(get(&hasty, "/docs", "203.0.113.1", &[]).await.status, 308);
    answers.push((get(&hasty, "/docs", "203.0.113.1", &[]).await, "default-src 'none'; frame"));
    assert_eq!(answers.last().unwrap().0.status, 429);
    for (answer, policy) in answers {
        assert!(told(&answer.headers, "content-security-policy").starts_with(policy), "{answer:?}");
        assert!(told(&answer.headers, "content-security-policy").contains("frame-ancestors 'none'"));
        assert_eq!(told(&answer.headers, "x-content-type-options"), "nosniff");
        assert_eq!(told(&answer.headers, "referrer-policy"), "no-referrer");
        assert!(["no-store", "no-cache"].contains(&told(&answer.headers, "cache-control").as_str()));
    }
}
