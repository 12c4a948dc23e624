//! `POST /simulate/batch`: its lines, what is refused as a whole, and how its jobs share the workers with single ones.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use axum::body::Body;
use axum::http::{Method, Request, StatusCode, header};
use reentry_service::client::Client;
use reentry_service::compute::Compute;
use reentry_service::compute::Task;
use reentry_service::config::Config;
use reentry_service::error::ApiError;
use reentry_tests::service::{Answer, Service, pool};
use serde_json::{Value, json};
use tokio::task::yield_now;
use tokio::time::sleep;

use super::problems::{endless, free_again, orbiting};
use super::refusal::{Steady, good_answer, problem};
use super::requests::{capsule, flight, model, with, without};

const PATH: &str = "/simulate/batch";
const LONG: Duration = Duration::from_mins(5);

/// The lines of a batch that must be good as a whole.
fn lines(answer: &Answer) -> Vec<Value> {
    let text = std::str::from_utf8(&answer.body).unwrap();
    assert_eq!(answer.status, StatusCode::OK, "{text}");
    assert_eq!(answer.headers[header::CONTENT_TYPE], "application/x-ndjson");
    assert!(answer.headers.contains_key("x-request-id"));
    assert!(text.ends_with('\n'), "{text}");
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

async fn fly(service: &Service, cases: &Value) -> Vec<Value> {
    let answer = service.post(PATH, cases).await;
    lines(&answer)
}

fn reproducible(mut answer: Value) -> Value {
    if answer["solver"].is_object() {
        answer["solver"]["elapsed"] = json!(null);
    }
    answer
}

#[tokio::test]
async fn every_case_has_the_answer_of_simulate_on_its_line() {
    let service = Service::new();
    let good = [
        capsule(),
        with(&flight("geodetic"), "/echo", true),
        with(&flight("eci"), "/name", "two\nlines"),
        model("events"),
        model("heating"),
    ];
    let spherical = json!({"formulation": "spherical"});
    let singular = with(&with(&capsule(), "/solver", spherical), "/initial_state/speed", 0);
    let bad = [
        with(&capsule(), "/vehicle/mass", -13),
        without(&capsule(), "/vehicle"),
        with(&model("events"), "/events/0/then/thrust", "on"),
        without(&model("heating"), "/vehicle/nose_radius"),
        with(&capsule(), "/output", json!({"count": 1_000_000})),
        singular,
        json!(5),
        json!([capsule()]),
    ];
    let mut cases = Vec::new();
    for case in bad.iter().chain(&good) {
        cases.extend([case.clone(), good[0].clone()]);
    }
    let lines = fly(&service, &json!(cases)).await;
    assert_eq!(lines.len(), cases.len());
    for (line, case) in lines.into_iter().zip(cases) {
        let single = service.post("/simulate", &case).await.json();
        assert_eq!(reproducible(line), reproducible(single), "{case}");
    }
}

#[tokio::test]
async fn a_case_that_json_cannot_hold_fails_alone() {
    let cases = format!("[{{\"name\": 1, \"name\": 2}}, {}, 1e999]", capsule());
    let lines = lines(&Service::new().post_text(PATH, cases).await);
    assert_eq!(lines[0]["type"], "/problems/invalid-json", "{}", lines[0]);
    assert_eq!(lines[1]["termination"], "surface_impact");
    assert_eq!(lines[2]["type"], "/problems/invalid-json", "{}", lines[2]);
}

#[tokio::test]
async fn a_batch_that_is_faulty_as_a_whole_is_refused() {
    let steady = Steady::new().await;
    for (body, detail) in [
        ("{}", "must be an array of cases, each a request of /simulate"),
        ("null", "must be an array of cases, each a request of /simulate"),
        ("[ ]", "must have at least 1 case, got none"),
    ] {
        let expected = json!({"type": "/problems/invalid-case", "title": "Case not valid", "status": 422,
            "detail": "1 problem in the request", "errors": [{"pointer": "", "detail": detail}]});
        assert_eq!(steady.refused_text(PATH, body).await, expected, "{body}");
    }
    for broken in ["", "[", "[1,]", "[1] 2", "[{\"vehicle\": }]", "[1 2]", "[\"\\ud800\\", "{\"a\"}"] {
        assert_eq!(steady.refused_text(PATH, broken).await["type"], "/problems/invalid-json", "{broken}");
    }
    for (query, kind) in [("format=json", "not-acceptable"), ("format=csv", "not-acceptable"), ("x=1", "invalid-query")]
    {
        let problem = steady.refused_text(&format!("{PATH}?{query}"), "[1]").await;
        assert_eq!(problem["type"], format!("/problems/{kind}"));
    }
    let undeclared = Request::builder().method(Method::POST).uri(PATH).body(Body::from("[1]")).unwrap();
    assert_eq!(steady.refused(undeclared).await["type"], "/problems/unsupported-media-type");
}

#[tokio::test]
async fn the_lines_are_of_the_media_type_that_is_asked_for() {
    let service = Service::new();
    for (path, accept, status) in [
        (PATH, "*/*", 200),
        (PATH, "application/x-ndjson", 200),
        (PATH, "application/json, application/x-ndjson;q=0.1", 200),
        ("/simulate/batch?format=ndjson", "text/html", 200),
        (PATH, "application/json", 406),
    ] {
        let request = Request::builder().method(Method::POST).uri(path).header("accept", accept);
        let request = request.header(header::CONTENT_TYPE, "application/json").body(Body::from("[1]")).unwrap();
        assert_eq!(service.send(request).await.status, status, "{path} {accept}");
    }
}

#[tokio::test]
async fn a_batch_has_up_to_a_thousand_cases() {
    let service = Service::new();
    let quick = with(&flight("ecef"), "/output", json!({"trajectory": false}));
    let named = |count: usize| -> Value { (0..count).map(|index| with(&quick, "/name", index.to_string())).collect() };
    let lines = fly(&service, &named(1000)).await;
    let names: Vec<_> = lines.iter().map(|line| line["name"].as_str().unwrap().to_owned()).collect();
    assert_eq!(names, (0..1000).map(|index| index.to_string()).collect::<Vec<_>>());
    let refused = problem(&service.post(PATH, &named(1001)).await);
    assert_eq!(refused["errors"], json!([{"pointer": "", "detail": "must have at most 1000 cases, got 1001"}]));
}

#[tokio::test]
async fn a_batch_may_be_longer_than_a_single_request() {
    let service = Service::with(Config { body_limit: 1000, batch_body_limit: 3000, ..Config::default() });
    let padded = |length: usize| format!("[1{}]", " ".repeat(length - 3));
    assert_eq!(service.post_text(PATH, padded(3000)).await.status, StatusCode::OK);
    let refused = problem(&service.post_text(PATH, padded(3001)).await);
    assert_eq!(refused["detail"], "the body exceeds the limit of 3000 bytes");
    let refused = problem(&service.post_text("/simulate", padded(1001)).await);
    assert_eq!(refused["detail"], "the body exceeds the limit of 1000 bytes");
}

#[tokio::test]
async fn the_default_limit_admits_a_thousand_ordinary_cases() {
    let case = reentry_tests::cases::read_json(
        format!("{}/../openapi/examples/target_1.json", env!("CARGO_MANIFEST_DIR")).as_ref(),
    );
    assert!(1000 * serde_json::to_string_pretty(&case).unwrap().len() < Config::default().batch_body_limit);
}

#[tokio::test]
async fn a_batch_that_runs_out_of_time_before_its_first_line_is_a_504() {
    let service = Service::with(Config { batch_deadline: Duration::from_millis(1), ..Config::default() });
    let expected = json!({"type": "/problems/deadline-exceeded", "title": "Time limit exceeded", "status": 504,
        "detail": "the request exceeded the time limit of 0.001 s"});
    assert_eq!(problem(&service.post(PATH, &json!([orbiting(), capsule()])).await), expected);
}

#[tokio::test]
async fn the_cases_for_which_there_is_no_time_left_have_problems_as_lines() {
    let config = Config { batch_deadline: Duration::from_secs(2), deadline: LONG, ..Config::default() };
    let mut cases = vec![orbiting(); 50];
    cases[0] = flight("ecef");
    let lines = fly(&Service::with(config), &json!(cases)).await;
    assert_eq!(lines.len(), 50);
    assert_eq!(lines[0]["termination"], "time_limit");
    assert_eq!(lines[49]["status"], 504);
    assert_eq!(lines[49]["detail"], "the request exceeded the time limit of 2 s");
}

#[tokio::test]
async fn one_batch_too_many_is_refused_and_singles_are_answered() {
    let service = Service::with(Config { batches: 1, deadline: LONG, batch_deadline: LONG, ..Config::default() });
    let slow = {
        let service = service.clone();
        let cases = json!(vec![orbiting(); 20]);
        // The batches that look for a place below may have taken it.
        tokio::spawn(async move { while service.post(PATH, &cases).await.status == 503 {} })
    };
    while service.post(PATH, &json!([1])).await.status == 200 {
        yield_now().await;
    }
    assert_eq!(problem(&service.post(PATH, &json!([1])).await)["type"], "/problems/busy");
    good_answer(&service, "/simulate", &capsule()).await;
    assert_eq!(service.get("/health/ready").await.status, 200);
    slow.abort();
    free_again(|| async { service.post(PATH, &json!([1])).await.status == 200 }).await;
}

fn compute(workers: usize, batches: usize, deadline: Duration) -> Arc<Compute> {
    pool(Config { workers, queue: 8, batches, deadline, ..Config::default() })
}

type Job = Box<dyn FnMut(&Task) -> Result<usize, ApiError> + Send>;

fn endless_job() -> Job {
    Box::new(|task| endless(task).map(|()| 0))
}

/// A job that counts how many have run.
fn counted(count: &Arc<AtomicUsize>) -> Job {
    let count = Arc::clone(count);
    Box::new(move |_| Ok(count.fetch_add(1, Ordering::SeqCst)))
}

#[tokio::test]
async fn batches_and_single_jobs_do_not_wait_for_each_other() {
    // Nobody waits longer than this for a worker that never comes.
    let deadline = Duration::from_secs(20);
    for workers in [1, 2] {
        let compute = compute(workers, 8, deadline);
        let batch = || {
            compute.run_batch("/simulate/batch", Client::default(), vec![endless_job(), endless_job()], LONG).unwrap()
        };
        let mut batches = [batch(), batch(), batch(), batch()];
        for _ in 0..100 {
            assert!(compute.run("/simulate", Client::default(), |_| Ok(())).await.is_ok());
        }
        assert!(batches.iter_mut().all(|batch| batch.try_recv().is_err()), "a batch was finished");
        drop(batches);
        let single = || {
            let compute = Arc::clone(&compute);
            tokio::spawn(async move { compute.run("/simulate", Client::default(), endless).await })
        };
        let singles = [single(), single(), single()];
        let count = Arc::new(AtomicUsize::new(0));
        let jobs = (0..100).map(|_| counted(&count)).collect();
        // Those that were given up give their slots back.
        free_again(|| async {
            compute.run_batch("/simulate/batch", Client::default(), vec![endless_job()], LONG).is_ok()
        })
        .await;
        let mut batch = compute.run_batch("/simulate/batch", Client::default(), jobs, LONG).unwrap();
        while let Some(result) = batch.recv().await {
            result.unwrap();
        }
        assert_eq!(count.load(Ordering::SeqCst), 100);
        assert!(singles.iter().all(|single| !single.is_finished()), "a single job was finished");
    }
}

#[tokio::test]
async fn batches_take_turns() {
    let compute = compute(2, 8, LONG);
    let order = Arc::new(Mutex::new(Vec::new()));
    let jobs = |name: &'static str| -> Vec<_> {
        let note = |_| {
            let order = Arc::clone(&order);
            move |_: &Task| {
                order.lock().unwrap().push(name);
                Ok(())
            }
        };
        (0..3).map(note).collect()
    };
    // The one worker of batches is taken until both wait for it.
    let (release, released) = std::sync::mpsc::channel();
    let hold = move |_: &Task| released.recv().map_err(|_| ApiError::Interrupted);
    let _held = compute.run_batch("/simulate/batch", Client::default(), vec![hold], LONG).unwrap();
    let mut batches = ["first", "second"]
        .map(|name| compute.run_batch("/simulate/batch", Client::default(), jobs(name), LONG).unwrap());
    for _ in 0..10 {
        yield_now().await;
    }
    release.send(()).unwrap();
    for batch in &mut batches {
        while batch.recv().await.is_some() {}
    }
    let order = order.lock().unwrap();
    // Each is a result ahead of who reads it, and the reader takes the first batch first.
    assert_eq!(order[..2], ["first", "second"]);
    assert_eq!(order.len(), 6);
}

#[tokio::test]
async fn nothing_is_computed_far_ahead_of_who_reads() {
    let compute = compute(1, 1, LONG);
    let count = Arc::new(AtomicUsize::new(0));
    let mut batch = compute
        .run_batch("/simulate/batch", Client::default(), (0..100).map(|_| counted(&count)).collect(), LONG)
        .unwrap();
    for taken in 0..100 {
        // One result waits in the channel, and one before it.
        let ahead = (taken + 2).min(100);
        while count.load(Ordering::SeqCst) < ahead {
            yield_now().await;
        }
        for _ in 0..3 {
            assert!(compute.run("/simulate", Client::default(), |_| Ok(())).await.is_ok(), "the worker is not free");
        }
        assert_eq!(count.load(Ordering::SeqCst), ahead);
        assert_eq!(batch.recv().await.unwrap().unwrap(), taken);
    }
    assert!(batch.recv().await.is_none());
}

#[tokio::test]
async fn a_batch_that_nobody_reads_has_no_slot_and_ends_early() {
    let compute = compute(1, 1, Duration::from_millis(50));
    let count = Arc::new(AtomicUsize::new(0));
    let mut unread = compute
        .run_batch("/simulate/batch", Client::default(), (0..100).map(|_| counted(&count)).collect(), LONG)
        .unwrap();
    let jobs = || (0..3).map(|_| counted(&count)).collect();
    free_again(|| async { compute.run_batch("/simulate/batch", Client::default(), jobs(), LONG).is_ok() }).await;
    // Only now has it waited for its reader as long as it does.
    sleep(Duration::from_secs(1)).await;
    assert!(unread.recv().await.is_some());
    assert!(unread.recv().await.is_none());
}

#[tokio::test]
async fn a_batch_whose_client_goes_away_is_given_up() {
    let compute = compute(1, 1, LONG);
    let count = Arc::new(AtomicUsize::new(0));
    let batch =
        compute.run_batch("/simulate/batch", Client::default(), vec![endless_job(), counted(&count)], LONG).unwrap();
    assert!(matches!(
        compute.run_batch("/simulate/batch", Client::default(), vec![endless_job()], LONG),
        Err(ApiError::Busy)
    ));
    drop(batch);
    free_again(|| async { compute.run_batch("/simulate/batch", Client::default(), vec![endless_job()], LONG).is_ok() })
        .await;
    assert!(compute.run("/simulate", Client::default(), |_| Ok(())).await.is_ok());
    assert_eq!(count.load(Ordering::SeqCst), 0);
}

#[tokio::test]
async fn a_case_beyond_the_time_of_a_single_job_fails_alone() {
    let compute = compute(1, 1, Duration::from_secs(1));
    let count = Arc::new(AtomicUsize::new(7));
    let mut batch =
        compute.run_batch("/simulate/batch", Client::default(), vec![endless_job(), counted(&count)], LONG).unwrap();
    let first = batch.recv().await.unwrap();
    assert!(matches!(first, Err(ApiError::DeadlineExceeded { seconds: 1.0 })), "{first:?}");
    assert_eq!(batch.recv().await.unwrap().unwrap(), 7);
}

#[tokio::test]
async fn after_the_time_of_a_batch_nothing_is_computed_any_more() {
    let compute = compute(1, 1, LONG);
    let count = Arc::new(AtomicUsize::new(0));
    let jobs = vec![counted(&count), endless_job(), counted(&count), counted(&count)];
    let mut batch = compute.run_batch("/simulate/batch", Client::default(), jobs, Duration::from_secs(1)).unwrap();
    assert_eq!(batch.recv().await.unwrap().unwrap(), 0);
    for _ in 0..3 {
        let late = batch.recv().await.unwrap();
        assert!(matches!(late, Err(ApiError::DeadlineExceeded { seconds: 1.0 })), "{late:?}");
        // What is left to say takes no place.
        assert!(compute.run_batch("/simulate/batch", Client::default(), Vec::<Job>::new(), LONG).is_ok());
    }
    assert!(batch.recv().await.is_none());
    assert_eq!(count.load(Ordering::SeqCst), 1);
}

#[test]
fn the_document_bounds_a_batch() {
    let document = reentry_service::document();
    let body = &document["paths"][PATH]["post"]["requestBody"]["content"]["application/json"];
    let expected = json!({"type": "array", "items": {"$ref": "#/components/schemas/SimulateRequest"}, "minItems": 1, "maxItems": 1000});
    assert_eq!(body["schema"], expected);
    assert!(document["paths"][PATH]["post"]["responses"]["200"]["content"]["application/x-ndjson"].is_object());
}
