//! One problem document of every type, to the letter.

use std::io;
use std::net::IpAddr;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, mpsc};
use std::time::Duration;

use axum::body::{Body, Bytes};
use axum::http::{Method, Request, header};
use http_body_util::{BodyExt, Full, Limited};
use reentry::Interrupt;
use reentry_service::client::Client;
use reentry_service::compute::Task;
use reentry_service::config::Config;
use reentry_service::error::ApiError;
use reentry_tests::service::{Service, pool};
use serde_json::{Value, json};

use super::refusal::{Steady, good_answer, problem};
use super::requests::{capsule, event, flight, with, with_all};

fn post(path: &str, media_type: &str, body: impl Into<Body>) -> Request<Body> {
    let request = Request::builder().method(Method::POST).uri(path).header(header::CONTENT_TYPE, media_type);
    request.body(body.into()).unwrap()
}

pub(crate) fn post_json(path: &str, body: &Value) -> Request<Body> {
    post(path, "application/json", body.to_string())
}

/// A body whose sender goes away in the middle.
fn broken_off() -> Body {
    let broken = Limited::new(Full::new(Bytes::from_static(b"{\"vehicle\"")), 3);
    Body::new(broken.map_err(|_| io::Error::other("connection reset")))
}

#[tokio::test]
async fn a_request_that_cannot_be_read_gets_its_problem() {
    let steady = Steady::with(Config { body_limit: 4096, ..Config::default() }).await;
    let get = Request::builder().uri("/simulate").body(Body::empty()).unwrap();
    for (request, expected) in [
        (
            post_json("/simulat", &capsule()),
            json!({"type": "/problems/not-found", "title": "Not found", "status": 404,
                "detail": "no resource at /simulat; see /docs/ and /guide/"}),
        ),
        (
            get,
            json!({"type": "/problems/method-not-allowed", "title": "Method not allowed", "status": 405,
                "detail": "/simulate does not support this method; see /docs"}),
        ),
        (
            post_json("/simulate?format=xml", &capsule()),
            json!({"type": "/problems/not-acceptable", "title": "Not acceptable", "status": 406,
                "detail": "the response is available as json or csv or geojson or kml or czml or oem, not as \"xml\""}),
        ),
        (
            post_json("/simulate?formt=csv", &capsule()),
            json!({"type": "/problems/invalid-query", "title": "Invalid query string", "status": 400,
                "detail": "the query string may contain only one parameter, format"}),
        ),
        (
            post("/simulate", "application/json", "{\"vehicle\": {\"mass\": }}"),
            json!({"type": "/problems/invalid-json", "title": "Not JSON", "status": 400,
                "detail": "the body is not JSON: expected value at line 1 column 22"}),
        ),
        (
            post("/simulate", "application/json", broken_off()),
            json!({"type": "/problems/unreadable-body", "title": "Unreadable body", "status": 400,
                "detail": "the body could not be read: connection reset"}),
        ),
        (
            post("/simulate", "application/json", " ".repeat(4097)),
            json!({"type": "/problems/payload-too-large", "title": "Payload too large", "status": 413,
                "detail": "the body exceeds the limit of 4096 bytes"}),
        ),
        (
            post("/simulate", "text/plain", capsule().to_string()),
            json!({"type": "/problems/unsupported-media-type", "title": "Unsupported media type", "status": 415,
                "detail": "content-type must be application/json, got text/plain; with curl: -H 'content-type: \
                           application/json'"}),
        ),
    ] {
        assert_eq!(steady.refused(request).await, expected);
    }
}

#[tokio::test]
async fn an_invalid_case_gets_its_problem() {
    let steady = Steady::new().await;
    let request = with_all(
        &capsule(),
        [("/vehicle/mass", json!(-13)), ("/vehicle/colour", json!("red")), ("/initial_state/heading", json!(30))],
    );
    let expected = json!({
        "type": "/problems/invalid-case", "title": "Case not valid", "status": 422,
        "detail": "3 problems in the request",
        "errors": [
            {"pointer": "/vehicle/mass", "detail": "must be greater than 0, got -13"},
            {"pointer": "/vehicle/colour",
                "detail": "is not a field here; the fields are mass, parts, reference_area, aerodynamics, nose_radius"},
            {"pointer": "/initial_state/heading", "detail": "must be between -6.28319 and 6.28319, got 30 (radians); \
                                                             for degrees, set \"angle_unit\": \"deg\""},
        ],
    });
    assert_eq!(steady.refused(post_json("/simulate", &request)).await, expected);

    let request = with(&capsule(), "/stop", json!({"altitude": 2e5}));
    let problem = steady.refused(post_json("/simulate", &request)).await;
    assert_eq!(problem["detail"], "1 problem in the request");
}

#[tokio::test]
async fn too_many_rows_get_their_problem() {
    let steady = Steady::with(Config { row_limit: 50, ..Config::default() }).await;
    for (way, value) in [
        ("interval", json!(1e-9)),
        ("interval", json!(5e-324)),
        ("count", json!(51)),
        ("count", json!(u64::MAX)),
        ("samples_per_step", json!(50)),
        ("samples_per_step", json!(u64::MAX)),
        ("times", (1..=60).collect()),
    ] {
        let expected = json!({
            "type": "/problems/row-limit", "title": "Too many rows", "status": 422,
            "detail": "the trajectory exceeds the limit of 50 rows",
            "errors": [{"pointer": format!("/output/{way}"),
                "detail": "gives more than 50 rows; request fewer, for example with count"}],
        });
        let request = with(&capsule(), "/output", json!({way: value}));
        assert_eq!(steady.refused(post_json("/simulate", &request)).await, expected);
        assert_eq!(steady.refused(post_json("/simulate?format=csv", &request)).await, expected);
    }
    for (way, value) in [("count", json!(50)), ("times", (1..=48).collect())] {
        let request = with(&capsule(), "/output", json!({way: value}));
        let answer = super::refusal::good_answer(&steady.service, "/simulate", &request).await;
        assert_eq!(answer["trajectory"]["time"].as_array().unwrap().len(), 50, "{way}");
    }
}

#[tokio::test]
async fn the_default_limit_of_rows_is_a_hundred_thousand() {
    let steady = Steady::new().await;
    let problem = steady.refused(post_json("/simulate", &with(&capsule(), "/output", json!({"count": 100_001})))).await;
    assert_eq!(problem["detail"], "the trajectory exceeds the limit of 100000 rows");
}

#[tokio::test]
async fn an_endless_orbit_gets_its_problem() {
    let steady = Steady::with(Config { deadline: Duration::from_mins(5), ..Config::default() }).await;
    let orbit = json!({"type": "orbital_elements", "semi_major_axis": 8e6, "eccentricity": 0.1, "inclination": 1,
        "raan": 0, "argument_of_periapsis": 0, "true_anomaly": 0});
    let request = with_all(&capsule(), [("/initial_state", orbit), ("/stop", json!({"time": 1e9}))]);
    let problem = steady.refused(post_json("/simulate", &request)).await;
    assert_eq!(problem["type"], "/problems/step-limit", "{problem}");
    let detail = problem["detail"].as_str().unwrap();
    let begin = "the flight cannot be completed: the flight needs more than 100000 integration steps; it reached t = ";
    let reached = detail.strip_prefix(begin).and_then(|rest| rest.strip_suffix(" s")).unwrap();
    let reached: f64 = reached.parse().unwrap();
    assert!(reached > 1e7 && reached < 1e9, "{detail}");
}

#[tokio::test]
async fn each_singularity_of_the_spherical_equations_gets_its_problem() {
    let steady = Steady::new().await;
    let quarter = std::f64::consts::FRAC_PI_2;
    for (changes, place) in [
        (vec![("geocentric_latitude", quarter)], "at the poles"),
        (vec![("geocentric_latitude", -quarter)], "at the poles"),
        (vec![("flight_path_angle", -quarter)], "in vertical flight"),
        (vec![("flight_path_angle", quarter)], "in vertical flight"),
        (vec![("speed", 0.0)], "at rest"),
    ] {
        let mut request = with(&capsule(), "/solver", json!({"formulation": "spherical"}));
        for (name, value) in changes {
            request["initial_state"][name] = json!(value);
        }
        let expected = json!({
            "type": "/problems/singularity", "title": "Singular equations", "status": 422,
            "detail": format!(
                "the flight cannot be completed: the spherical equations of motion are singular {place}, reached at t \
                 = 0 s"
            ),
            "errors": [{"pointer": "/solver/formulation",
                "detail": "use \"cartesian\", which has no such singularity"}],
        });
        assert_eq!(steady.refused(post_json("/simulate", &request)).await, expected);
        // What is recommended helps.
        let request = with(&request, "/solver/formulation", "cartesian");
        super::refusal::good_answer(&steady.service, "/simulate", &request).await;
    }
}

#[tokio::test]
async fn a_singularity_on_the_way_gets_its_problem() {
    let steady = Steady::new().await;
    let over_the_pole = with_all(
        &capsule(),
        [
            ("/solver", json!({"formulation": "spherical"})),
            (
                "/planet",
                json!({"model": "custom", "gravitational_parameter": 4e14, "equatorial_radius": 6.4e6,
                "polar_radius": 6.4e6, "rotation_rate": 0}),
            ),
            ("/initial_state/geocentric_latitude", json!(1.5)),
            ("/initial_state/heading", json!(std::f64::consts::FRAC_PI_2)),
        ],
    );
    let problem = steady.refused(post_json("/simulate", &over_the_pole)).await;
    assert_eq!(problem["type"], "/problems/singularity", "{problem}");
    assert!(problem["detail"].as_str().unwrap().contains("at the poles"), "{problem}");
    assert_eq!(problem["errors"][0]["pointer"], "/solver/formulation");
    let request = with(&over_the_pole, "/solver/formulation", "cartesian");
    super::refusal::good_answer(&steady.service, "/simulate", &request).await;
}

#[tokio::test]
async fn motion_too_fast_to_follow_gets_its_problem() {
    let steady = Steady::new().await;
    let request = with(&capsule(), "/vehicle/mass", 1e-100);
    let problem = steady.refused(post_json("/simulate", &request)).await;
    assert_eq!(problem["type"], "/problems/step-size", "{problem}");
    let begin = "the flight cannot be completed: the motion changes too fast to be integrated at t = ";
    assert!(problem["detail"].as_str().unwrap().starts_with(begin), "{problem}");
}

#[tokio::test]
async fn thrust_that_burns_the_whole_vehicle_gets_its_problem() {
    let steady = Steady::new().await;
    let thrust = json!({"along": "velocity", "value": 98_066.5, "specific_impulse": 100});
    for thrust in [thrust.clone(), with(&thrust, "/propellant", 6000)] {
        let request =
            with(&capsule(), "/events", json!([event("time", "rises_through", 2.0, &json!({"thrust": thrust}))]));
        let problem = steady.refused(post_json("/simulate", &request)).await;
        // 100 kg a second of 5500 kg.
        let expected = json!({
            "type": "/problems/no-mass-left", "title": "No mass left", "status": 422, "detail": problem["detail"],
            "errors": [{"pointer": "/events",
                "detail": "switch the thrust off with an event, or set its propellant"}],
        });
        assert_eq!(problem, expected);
        let detail = problem["detail"].as_str().unwrap();
        let begin = "the flight cannot be completed: the thrust has burnt the entire mass by t = ";
        let end = " s";
        let gone: f64 = detail.strip_prefix(begin).and_then(|rest| rest.strip_suffix(end)).unwrap().parse().unwrap();
        assert!(gone > 56.0 && gone <= 57.0, "{detail}");
    }
}

/// A braking burn that brings a lander to rest above the ground, where its thrust has no direction.
fn braking() -> Value {
    let thrust = json!({"thrust": {"along": "velocity", "value": -45_000, "specific_impulse": 311}});
    json!({
        "angle_unit": "deg",
        "planet": {"model": "custom", "gravitational_parameter": 4.9028e12, "equatorial_radius": 1_737_400,
            "polar_radius": 1_737_400, "rotation_rate": 0},
        "atmosphere": {"type": "vacuum"},
        "vehicle": {"mass": 15_000, "reference_area": 0, "aerodynamics": {"type": "constant", "drag_coefficient": 0}},
        "initial_state": {"type": "planet_relative", "altitude": 1000, "longitude": 0, "geocentric_latitude": 0, "speed": 20,
            "flight_path_angle": -90, "heading": 0},
        "events": [event("time", "rises_through", 0.0, &json!({})), event("time", "rises_through", 0.0, &thrust)],
        "stop": {"time": 3000},
        "output": {"trajectory": false},
    })
}

#[tokio::test]
async fn thrust_that_brakes_the_vehicle_to_rest_gets_its_problem() {
    let steady = Steady::new().await;
    let problem = steady.refused(post_json("/simulate", &braking())).await;
    assert_eq!(problem["type"], "/problems/no-direction");
    assert_eq!(problem["errors"][0]["pointer"], "/events/1/then/thrust/along");
    let detail = problem["detail"].as_str().unwrap();
    let begin = "the flight cannot be completed: the thrust of event 1 has no direction from t = 14.298 s on, at an \
                 altitude of 856.29 m";
    assert!(detail.starts_with(begin), "{detail}");
    // A condition on the speed 0 is met there, and the flight ends by it.
    let stops = with(&braking(), "/stop", json!({"when": [{"quantity": "speed", "falls_through": 0}]}));
    let answer = good_answer(&steady.service, "/simulate", &stops).await;
    assert_eq!((&answer["termination"], &answer["final_state"]["speed"]), (&json!("condition"), &json!(0.0)));
}

#[tokio::test]
async fn a_flight_longer_than_allowed_gets_its_problem() {
    let service = Service::with(Config { deadline: Duration::from_millis(1), ..Config::default() });
    let request = with(&orbiting(), "/stop/time", 1e9);
    let expected = json!({"type": "/problems/deadline-exceeded", "title": "Time limit exceeded", "status": 504,
        "detail": "the request exceeded the time limit of 0.001 s"});
    assert_eq!(problem(&service.post("/simulate", &request).await), expected);
}

/// A flight that takes as long as it is let.
pub(crate) fn orbiting() -> Value {
    let state = json!({"type": "ecef", "position": [8e6, 0, 0], "velocity": [0, 0, 7e3]});
    with_all(&flight("ecef"), [("/initial_state", state), ("/stop/time", json!(1e9))])
}

#[tokio::test]
async fn a_full_service_gets_its_problem_and_is_soon_free_again() {
    let config = Config { workers: 1, queue: 0, deadline: Duration::from_mins(5), ..Config::default() };
    let service = Service::with(config);
    let slow = {
        let service = service.clone();
        tokio::spawn(async move { service.post("/simulate", &orbiting()).await })
    };
    while service.get("/health/ready").await.status == 200 {
        tokio::task::yield_now().await;
    }
    let expected = json!({"type": "/problems/busy", "title": "Busy", "status": 503,
        "detail": "the service is busy; try again in 1 s"});
    let answer = service.post("/simulate", &capsule()).await;
    assert_eq!(problem(&answer), expected);
    assert_eq!(answer.headers[header::RETRY_AFTER], "1");
    assert_eq!(service.get("/health/ready").await.json(), json!({"status": "busy"}));
    assert_eq!(service.get("/health/live").await.status, 200);

    assert_eq!(problem(&slow.await.unwrap())["type"], "/problems/step-limit");
    free_again(|| async { service.get("/health/ready").await.status == 200 }).await;
    super::refusal::good_answer(&service, "/simulate", &capsule()).await;
}

/// Waits until a worker has seen that its job is over; for ever, if it never does.
pub(crate) async fn free_again<F: Future<Output = bool>>(has_room: impl Fn() -> F) {
    while !has_room().await {
        tokio::task::yield_now().await;
    }
}

/// A job that goes on until nobody wants it any more.
#[expect(clippy::unnecessary_wraps, reason = "a job may fail")]
pub(crate) fn endless(task: &Task) -> Result<(), ApiError> {
    while !task.is_raised() {
        std::thread::yield_now();
    }
    Ok(())
}

#[tokio::test]
async fn a_job_is_given_up_at_its_deadline() {
    let compute = pool(Config { workers: 1, queue: 0, deadline: Duration::from_millis(20), ..Config::default() });
    let result = compute.run("/simulate", Client::default(), endless).await;
    assert!(matches!(result, Err(ApiError::DeadlineExceeded { .. })), "{result:?}");
    free_again(|| async { compute.has_room() }).await;
    assert!(compute.run("/simulate", Client::default(), |_| Ok(())).await.is_ok());
}

#[tokio::test]
async fn a_job_whose_client_goes_away_is_given_up() {
    let compute = pool(Config { workers: 1, queue: 0, deadline: Duration::from_mins(5), ..Config::default() });
    let client = {
        let compute = Arc::clone(&compute);
        tokio::spawn(async move { compute.run("/simulate", Client::default(), endless).await })
    };
    while compute.has_room() {
        tokio::task::yield_now().await;
    }
    client.abort();
    free_again(|| async { compute.has_room() }).await;
    assert!(compute.run("/simulate", Client::default(), |_| Ok(())).await.is_ok());
}

#[tokio::test]
async fn a_job_without_room_for_its_answer_begins_anew_when_there_is() {
    let compute = pool(Config { workers: 2, deadline: Duration::from_mins(5), ..Config::default() });
    let much = Config::default().memory / 2;
    let (free, freed) = mpsc::channel::<()>();
    let (holds, held) = mpsc::channel();
    let client = |number: u8| Client::from(IpAddr::from([203, 0, 113, number]));
    let first = {
        let compute = Arc::clone(&compute);
        let job = move |task: &Task| {
            let has_room = task.may_hold(much);
            holds.send(()).map_err(|_| ApiError::Internal)?;
            // An error: it is told to go on by dropping the other end.
            let _ = freed.recv();
            Ok(has_room)
        };
        tokio::spawn(async move { compute.run("/simulate", client(1), job).await })
    };
    let begun = Arc::new(AtomicUsize::new(0));
    let second = {
        let (compute, begun) = (Arc::clone(&compute), Arc::clone(&begun));
        let job = move |task: &Task| {
            begun.fetch_add(1, Ordering::SeqCst);
            // Small things have room all the while.
            assert!(task.may_hold(much / 100));
            if task.may_hold(much) { Ok(task.may_hold(2 * much / 3)) } else { Err(ApiError::Interrupted) }
        };
        while held.try_recv().is_err() {
            tokio::task::yield_now().await;
        }
        tokio::spawn(async move { compute.run("/simulate", client(2), job).await })
    };
    while begun.load(Ordering::SeqCst) == 0 {
        tokio::task::yield_now().await;
    }
    tokio::time::sleep(Duration::from_millis(50)).await;
    // It waits, and nobody else does.
    assert!(!second.is_finished());
    assert!(compute.run("/simulate", client(2), move |task| Ok(task.may_hold(much / 100))).await.unwrap());
    drop(free);
    assert!(first.await.unwrap().unwrap());
    assert!(second.await.unwrap().unwrap());
    assert_eq!(begun.load(Ordering::SeqCst), 2);
    // What never has room is refused.
    let refused = compute.run("/simulate", client(3), move |task| Ok(task.may_hold(4 * much))).await;
    assert!(matches!(refused, Err(ApiError::TooLarge { .. })), "{refused:?}");
}
