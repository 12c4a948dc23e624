//! The rows of `/simulate`: the ways of asking for them, and the two ways of writing them.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use super::refusal::good_answer;
use super::requests::{capsule, with, with_all};
use super::simulate::{COLUMNS, fly};

/// Flies the capsule with an output.
async fn with_output(output: Value) -> Value {
    fly(&with(&capsule(), "/output", output)).await
}

/// The times of the rows, of which the first must be 0 and the last the end, and between which they must increase strictly.
fn times(answer: &Value) -> Vec<f64> {
    let trajectory = answer["trajectory"].as_object().unwrap();
    let times: Vec<_> = trajectory["time"].as_array().unwrap().iter().map(|time| time.as_f64().unwrap()).collect();
    for (name, column) in trajectory {
        assert_eq!(column.as_array().unwrap().len(), times.len(), "{name}");
    }
    assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?}");
    for (place, row) in [("initial_state", 0), ("final_state", times.len() - 1)] {
        for name in COLUMNS {
            assert_eq!(answer[place][name], trajectory[name][row], "{name} of {place}");
        }
    }
    assert_eq!(times[0].to_bits(), 0.0_f64.to_bits());
    times
}

#[tokio::test]
async fn samples_per_step_gives_so_many_rows_a_step() {
    for samples in [1, 2, 4, 7] {
        let answer = with_output(json!({"samples_per_step": samples})).await;
        let steps = answer["solver"]["steps"].as_u64().unwrap();
        assert_eq!(times(&answer).len() as u64, steps * samples + 1, "{samples}");
    }
    let (one, four) = (with_output(json!({"samples_per_step": 1})).await, fly(&capsule()).await);
    let (ends, rows) = (times(&one), times(&four));
    let every_fourth: Vec<_> = rows.iter().copied().step_by(4).collect();
    assert_eq!(every_fourth, ends);
}

#[tokio::test]
async fn interval_gives_its_multiples_and_the_end() {
    for interval in [0.5, 1.0, 30.0, 1e6] {
        let answer = with_output(json!({"interval": interval})).await;
        let times = times(&answer);
        let end = answer["final_state"]["time"].as_f64().unwrap();
        let (last, multiples) = times.split_last().unwrap();
        assert_eq!(last.to_bits(), end.to_bits());
        let mut next = 0.0;
        for (index, time) in (0..).zip(multiples) {
            assert_eq!(time.to_bits(), (f64::from(index) * interval).to_bits());
            next = f64::from(index + 1) * interval;
        }
        assert!(next >= end, "{interval}: a row is missing before {end}");
    }
}

#[tokio::test]
async fn an_interval_that_divides_the_flight_gives_the_end_once() {
    let case = with_all(&capsule(), [("/stop", json!({"time": 10})), ("/output", json!({"interval": 2.5}))]);
    assert_eq!(times(&fly(&case).await), [0.0, 2.5, 5.0, 7.5, 10.0]);
}

#[tokio::test]
async fn count_gives_so_many_rows_evenly() {
    for count in [2, 3, 10, 1001] {
        let answer = with_output(json!({"count": count})).await;
        let times = times(&answer);
        assert_eq!(u32::try_from(times.len()), Ok(count));
        let interval = answer["final_state"]["time"].as_f64().unwrap() / f64::from(count - 1);
        for (index, time) in (0..).zip(times) {
            // A rounding of the product and of the quotient.
            assert!((time - f64::from(index) * interval).abs() <= 4.0 * f64::EPSILON * time, "{time} of {count}");
        }
    }
}

#[tokio::test]
async fn times_gives_those_of_the_flight() {
    let end = fly(&capsule()).await["final_state"]["time"].as_f64().unwrap();
    for (asked, expected) in [
        (json!([]), vec![0.0, end]),
        (json!([0]), vec![0.0, end]),
        (json!([1.5, 20, 33.25]), vec![0.0, 1.5, 20.0, 33.25, end]),
        (json!([0, 1, end]), vec![0.0, 1.0, end]),
        (json!([1, end + 1.0, 1e9, 1e300]), vec![0.0, 1.0, end]),
        (json!([end.next_down(), end.next_up()]), vec![0.0, end.next_down(), end]),
        (json!([5e-324]), vec![0.0, 5e-324, end]),
    ] {
        assert_eq!(times(&with_output(json!({"times": asked})).await), expected, "{asked}");
    }
}

#[tokio::test]
async fn without_trajectory_everything_else_is_there() {
    let service = Service::new();
    let without = with(&capsule(), "/output", json!({"trajectory": false}));
    let mut answer = good_answer(&service, "/simulate", &without).await;
    let mut full = good_answer(&service, "/simulate", &capsule()).await;
    assert_eq!(answer.get("trajectory"), None);
    full.as_object_mut().unwrap().remove("trajectory");
    for answer in [&mut answer, &mut full] {
        answer["solver"]["elapsed"] = json!(0);
    }
    assert_eq!(answer, full);
}

#[tokio::test]
async fn rows_do_not_change_the_flight() {
    let ways =
        [json!({"samples_per_step": 1}), json!({"interval": 0.1}), json!({"count": 3}), json!({"times": [7, 77.7]})];
    let mut flights = Vec::new();
    for way in ways {
        let mut answer = with_output(way).await;
        answer["solver"]["elapsed"] = json!(0);
        flights.push(with(&answer, "/trajectory", json!(null)));
    }
    assert!(flights.windows(2).all(|pair| pair[0] == pair[1]));
}

#[tokio::test]
async fn a_row_is_the_same_whichever_way_asks_for_it() {
    let asked = with_output(json!({"times": [100, 200, 300]})).await;
    let every = with_output(json!({"interval": 100})).await;
    for name in COLUMNS {
        for row in 0..=3 {
            assert_eq!(asked["trajectory"][name][row], every["trajectory"][name][row], "{name}");
        }
    }
}

#[tokio::test]
async fn csv_has_the_digits_of_the_columns() {
    let service = Service::new();
    for output in [json!({"samples_per_step": 4}), json!({"count": 2}), json!({"times": [1, 2]})] {
        let case = with(&capsule(), "/output", output);
        let json = good_answer(&service, "/simulate", &case).await;
        let answer = service.post("/simulate?format=csv", &case).await;
        let media_type = answer.headers["content-type"].to_str().unwrap();
        assert!(media_type.starts_with("text/csv"), "{media_type}");
        let csv = String::from_utf8(answer.body.to_vec()).unwrap();
        assert!(csv.ends_with('\n'));
        let mut lines = csv.lines();
        assert_eq!(lines.next().unwrap(), COLUMNS.join(","));
        let rows: Vec<Vec<_>> = lines.map(|line| line.split(',').collect()).collect();
        assert_eq!(rows.len(), times(&json).len());
        for (index, row) in rows.iter().enumerate() {
            // The columns keep the digits in which the service wrote them.
            let written = |name| match &json["trajectory"][name][index] {
                Value::Null => String::new(),
                value => value.to_string(),
            };
            assert_eq!(*row, COLUMNS.map(written), "row {index}");
        }
    }
}

#[tokio::test]
async fn csv_of_a_flight_that_ends_at_its_start_has_one_row() {
    let case = with_all(&capsule(), [("/initial_state/altitude", json!(0)), ("/initial_state/speed", json!(0))]);
    let answer = Service::new().post("/simulate?format=csv", &case).await;
    assert_eq!(String::from_utf8(answer.body.to_vec()).unwrap().lines().count(), 2);
}
