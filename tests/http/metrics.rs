//! What the service counts, beside what its answers say.

#![expect(clippy::float_cmp, reason = "what is counted is a whole number")]

use std::collections::BTreeMap;
use std::sync::Arc;
use std::time::Duration;

use axum::body::Body;
use axum::http::{Request, header};
use http_body_util::BodyExt;
use reentry_service::client::{Client, Peer};
use reentry_service::compute::Task;
use reentry_service::config::Config;
use reentry_service::state::AppState;
use reentry_service::telemetry::LostLines;
use reentry_tests::service::Service;
use serde_json::{Value, json};
use tower::ServiceExt;

use super::problems::{endless, free_again};
use super::requests::{capsule, with, with_all};

/// Every line of the metrics: name with labels, and value.
async fn metrics(service: &Service) -> BTreeMap<String, f64> {
    let answer = service.get("/metrics").await;
    assert_eq!(answer.status, 200);
    assert_eq!(answer.headers["content-type"], "application/openmetrics-text; version=1.0.0; charset=utf-8");
    read(std::str::from_utf8(&answer.body).unwrap())
}

fn read(text: &str) -> BTreeMap<String, f64> {
    assert!(text.ends_with("# EOF\n"), "{text}");
    let samples = text.lines().filter(|line| !line.starts_with('#'));
    let sample = |line: &str| {
        let (name, value) = line.rsplit_once(' ').unwrap();
        (name.to_owned(), value.parse().unwrap())
    };
    samples.map(sample).collect()
}

fn count(metrics: &BTreeMap<String, f64>, name: &str) -> f64 {
    metrics.get(name).copied().unwrap_or_else(|| panic!("no {name} in {metrics:#?}"))
}

#[tokio::test]
async fn requests_are_counted_by_route_and_outcome() {
    let service = Service::new();
    service.post("/simulate", &capsule()).await;
    service.post("/simulate", &capsule()).await;
    service.post("/simulate", &json!({})).await;
    service.post_text("/convert", "{").await;
    service.get("/simulate").await;
    service.get("/no/such/path/whatever").await;
    service.get("/docs/index.html").await;
    let metrics = metrics(&service).await;
    for (route, outcome, requests) in [
        ("/simulate", "ok", 2.0),
        ("/simulate", "invalid-case", 1.0),
        ("/simulate", "method-not-allowed", 1.0),
        ("/convert", "invalid-json", 1.0),
        ("other", "not-found", 1.0),
        ("/docs/{*name}", "ok", 1.0),
    ] {
        let labels = format!("{{route=\"{route}\",outcome=\"{outcome}\"}}");
        assert_eq!(count(&metrics, &format!("reentry_requests_total{labels}")), requests, "{labels}");
        assert_eq!(count(&metrics, &format!("reentry_request_duration_seconds_count{labels}")), requests, "{labels}");
    }
    assert_eq!(count(&metrics, "reentry_requests_in_flight{route=\"/simulate\"}"), 0.0);
    // This one.
    assert_eq!(count(&metrics, "reentry_requests_in_flight{route=\"/metrics\"}"), 1.0);
    // A client cannot make series: nothing that it has written is a label.
    assert!(!metrics.keys().any(|name| name.contains("whatever")), "{metrics:#?}");
}

#[tokio::test]
async fn what_a_flight_costs_is_what_its_answer_says() {
    let service = Service::new();
    let request = with(&capsule(), "/output", json!({"count": 123}));
    let bytes = |count| u32::try_from(count).map(f64::from).unwrap();
    let sent = request.to_string().len();
    let answer = service.post("/simulate", &request).await;
    let solver = answer.json()["solver"].clone();
    let metrics = metrics(&service).await;
    let of = |name: &str| count(&metrics, &format!("reentry_{name}{{route=\"/simulate\"}}"));
    let said = |name: &str| solver[name].as_f64().unwrap();
    assert!(said("steps") > 10.0);
    assert_eq!(of("flights_total"), 1.0);
    assert_eq!(of("integration_steps_total"), said("steps"));
    assert_eq!(of("integration_steps_rejected_total"), said("rejected_steps"));
    assert_eq!(of("evaluations_total"), said("evaluations"));
    assert_eq!(of("rows_total"), 123.0);
    assert_eq!(of("request_bytes_total"), bytes(sent));
    assert_eq!(of("response_bytes_total"), bytes(answer.body.len()));
    assert_eq!(of("compute_seconds_count"), 1.0);
    assert_eq!(of("queue_wait_seconds_count"), 1.0);
    // The job has all of the flight in it, and the request all of the job.
    assert!(of("compute_seconds_sum") >= said("elapsed"));
    let request = count(&metrics, "reentry_request_duration_seconds_sum{route=\"/simulate\",outcome=\"ok\"}");
    assert!(request >= of("compute_seconds_sum") + of("queue_wait_seconds_sum"));
}

#[tokio::test]
async fn the_cases_of_a_batch_are_counted_by_outcome() {
    let service = Service::new();
    let answer = service.post("/simulate/batch", &json!([capsule(), 1, capsule()])).await;
    let lines: Vec<Value> =
        answer.body.split(|byte| *byte == b'\n').filter_map(|line| serde_json::from_slice(line).ok()).collect();
    let metrics = metrics(&service).await;
    assert_eq!(count(&metrics, "reentry_batch_cases_total{outcome=\"ok\"}"), 2.0);
    assert_eq!(count(&metrics, "reentry_batch_cases_total{outcome=\"invalid-case\"}"), 1.0);
    let steps = lines[0]["solver"]["steps"].as_f64().unwrap();
    assert_eq!(count(&metrics, "reentry_integration_steps_total{route=\"/simulate/batch\"}"), 2.0 * steps);
}

#[tokio::test]
async fn searches_are_counted_by_route_and_outcome_with_their_flights() {
    let service = Service::new();
    let falling = with(&capsule(), "/angle_unit", "deg");
    let varied = |least: f64| json!({"pointer": "/initial_state/flight_path_angle", "between": [least, -0.04]});
    let target = |load: f64, flights: u32| {
        with_all(
            &falling,
            [
                ("/vary", json!([varied(-3.0)])),
                ("/achieve", json!([{"quantity": "load_factor", "at": "peak", "equals": load, "tolerance": 0.01}])),
                ("/search", json!({"starts": 4, "flights": flights})),
            ],
        )
    };
    let corridor = |most: f64| {
        let limits = json!([{"quantity": "load_factor", "at": "peak", "at_most": most}]);
        with_all(&falling, [("/vary", varied(-3.0)), ("/limits", limits), ("/resolution", json!(0.1))])
    };
    let mut flights = [0.0, 0.0];
    for (path, request, outcome, index) in [
        ("/target", target(9.0, 500), "reached", 0),
        ("/target", target(9e3, 500), "not_reached", 0),
        ("/target", target(9.0, 2), "out_of_budget", 0),
        ("/corridor", corridor(9.0), "band", 1),
        ("/corridor", corridor(0.0), "no_band", 1),
    ] {
        let answer = service.post(path, &request).await.json();
        assert!(index == 1 || answer["outcome"] == outcome, "{answer}");
        flights[index] += answer["search"]["flights"].as_f64().unwrap();
        let name = format!("reentry_searches_total{{route=\"{path}\",outcome=\"{outcome}\"}}");
        assert_eq!(count(&metrics(&service).await, &name), 1.0);
    }
    // A search that is refused is none.
    service.post("/target", &json!({})).await;
    let metrics = metrics(&service).await;
    assert_eq!(metrics.keys().filter(|name| name.starts_with("reentry_searches_total")).count(), 5);
    for (path, flights) in ["/target", "/corridor"].into_iter().zip(flights) {
        assert_eq!(count(&metrics, &format!("reentry_flights_total{{route=\"{path}\"}}")), flights);
    }
}

/// A service with one worker, and what it counts.
fn with_one_worker(deadline: Duration) -> (AppState, impl Fn(&str) -> f64) {
    let config = Config { workers: 1, queue: 3, deadline, ..Config::default() };
    let app = AppState::new(config, LostLines::default()).unwrap();
    let of = app.clone();
    (app, move |name: &str| count(&read(&of.metrics.text(of.now()).unwrap()), name))
}

#[tokio::test]
async fn jobs_of_clients_that_have_gone_are_counted() {
    let (app, count) = with_one_worker(Duration::from_mins(5));
    let (free, freed) = std::sync::mpsc::channel::<()>();
    // It gives way to nobody, as it looks at no flag.
    let running = {
        let compute = Arc::clone(&app.compute);
        let stubborn = move |_: &Task| Ok(freed.recv().is_err());
        tokio::spawn(async move { compute.run("/simulate", Client::default(), stubborn).await })
    };
    free_again(|| async { count("reentry_jobs_running") == 1.0 }).await;
    let waiting = {
        let compute = Arc::clone(&app.compute);
        tokio::spawn(async move { compute.run("/convert", Client::default(), |_| Ok(())).await })
    };
    free_again(|| async { count("reentry_jobs_queued") == 1.0 }).await;
    waiting.abort();
    running.abort();
    assert!(waiting.await.is_err() && running.await.is_err());
    drop(free);
    free_again(|| async { count("reentry_jobs_queued") == 0.0 && count("reentry_jobs_running") == 0.0 }).await;
    assert_eq!(count("reentry_cancellations_total{route=\"/simulate\",cause=\"disconnect\"}"), 1.0);
    assert_eq!(count("reentry_cancellations_total{route=\"/convert\",cause=\"disconnect\"}"), 1.0);
}

#[tokio::test]
async fn a_job_that_computes_for_long_is_suspended_while_others_wait() {
    let (app, count) = with_one_worker(Duration::from_mins(5));
    let long = {
        let compute = Arc::clone(&app.compute);
        tokio::spawn(async move { compute.run("/simulate", Client::default(), endless).await })
    };
    free_again(|| async { count("reentry_jobs_running") == 1.0 }).await;
    let (free, freed) = std::sync::mpsc::channel::<()>();
    let short = {
        let compute = Arc::clone(&app.compute);
        tokio::spawn(async move { compute.run("/convert", Client::default(), move |_| Ok(freed.recv())).await })
    };
    free_again(|| async { count("reentry_jobs_suspended") == 1.0 }).await;
    free_again(|| async { count("reentry_jobs_running") == 1.0 && count("reentry_jobs_queued") == 0.0 }).await;
    drop(free);
    assert!(short.await.unwrap().is_ok());
    free_again(|| async { count("reentry_jobs_suspended") == 0.0 }).await;
    assert!(!long.is_finished());
    // It hears that nobody waits while it is suspended, too.
    let (free, freed) = std::sync::mpsc::channel::<()>();
    let short = {
        let compute = Arc::clone(&app.compute);
        tokio::spawn(async move { compute.run("/convert", Client::default(), move |_| Ok(freed.recv())).await })
    };
    free_again(|| async { count("reentry_jobs_suspended") == 1.0 }).await;
    long.abort();
    free_again(|| async { count("reentry_jobs_suspended") == 0.0 }).await;
    assert_eq!(count("reentry_cancellations_total{route=\"/simulate\",cause=\"disconnect\"}"), 1.0);
    drop(free);
    assert!(short.await.unwrap().is_ok());
}

#[tokio::test]
async fn jobs_beyond_their_deadline_are_counted() {
    let (app, count) = with_one_worker(Duration::from_millis(20));
    assert!(app.compute.run("/simulate", Client::default(), endless).await.is_err());
    free_again(|| async { count("reentry_jobs_running") == 0.0 }).await;
    assert_eq!(count("reentry_cancellations_total{route=\"/simulate\",cause=\"deadline\"}"), 1.0);
}

#[tokio::test]
async fn answers_are_held_until_they_are_taken_and_a_client_holds_its_share_at_most() {
    // Room for two answers, and none for a third.
    let config = Config { memory: 6400, body_limit: 400, batch_body_limit: 800, ..Config::default() };
    let app = AppState::new(config, LostLines::default()).unwrap();
    let router = reentry_service::app(app.clone());
    let ask = async |client: u8| {
        let body = with(&capsule(), "/output", json!({"trajectory": false})).to_string();
        let request = Request::post("/simulate").header(header::HOST, "reentry.example");
        let request = request.header(header::CONTENT_TYPE, "application/json");
        let mut request = request.body(Body::from(body)).unwrap();
        request.extensions_mut().insert(Peer(([203, 0, 113, client], 1234).into()));
        let Ok(answer) = router.clone().oneshot(request).await;
        answer
    };
    let ready = async || {
        let Ok(answer) = router.clone().oneshot(Request::get("/health/ready").body(Body::empty()).unwrap()).await;
        answer.status()
    };
    let first = ask(1).await;
    assert_eq!(first.status(), 200);
    let held = app.memory.answers.held();
    assert!((2500..5000).contains(&held), "{held}");
    let again = ask(1).await;
    assert_eq!(again.status(), 429);
    assert_eq!(again.headers()["retry-after"], "1");
    assert_eq!(ready().await, 200);
    let second = ask(2).await;
    assert_eq!(second.status(), 200);
    assert_eq!(ask(3).await.status(), 503);
    assert_eq!(ready().await, 503);
    let body = first.into_body().collect().await.unwrap().to_bytes();
    assert!((body.len()..5 * body.len() / 4).contains(&held), "{held}");
    drop(body);
    assert_eq!(ready().await, 200);
    drop(second);
    assert_eq!(app.memory.answers.held(), 0);
    assert_eq!(ask(1).await.status(), 200);
}

#[tokio::test]
async fn an_answer_that_is_not_taken_to_its_end_is_abandoned() {
    let app = AppState::new(Config::default(), LostLines::default()).unwrap();
    let router = reentry_service::app(app.clone());
    let request = Request::get("/openapi.json").body(Body::empty()).unwrap();
    let Ok(answer) = router.oneshot(request).await;
    drop(answer);
    let metrics = read(&app.metrics.text(app.now()).unwrap());
    assert_eq!(count(&metrics, "reentry_requests_total{route=\"/openapi.json\",outcome=\"abandoned\"}"), 1.0);
    assert_eq!(count(&metrics, "reentry_requests_in_flight{route=\"/openapi.json\"}"), 0.0);
    assert_eq!(count(&metrics, "reentry_held_bytes{kind=\"answers\"}"), 0.0);
}

#[tokio::test]
async fn metrics_with_an_address_of_their_own_are_nowhere_else() {
    let config = Config { metrics_listen: Some(([127, 0, 0, 1], 9100).into()), ..Config::default() };
    assert_eq!(Service::with(config).get("/metrics").await.status, 404);
}
