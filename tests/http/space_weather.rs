//! Files of space-weather indices, and cases that take numbers or those of a file.

use std::fmt::Write as _;

use reentry::atmosphere::nrlmsise00::{Ap, SpaceWeather};
use reentry_service::wire::epoch::{Epoch, day_of};
use reentry_service::wire::space_weather::Records;
use serde_json::json;

use super::refusal::Steady;
use super::requests::{capsule, with, with_all, without};
use super::simulate::fly;

fn epoch(text: &str) -> Epoch {
    Epoch::read(&json!(text)).unwrap()
}

/// Numbers of a day that no other has: F10.7, and ap of every three hours.
fn numbers(day: i64) -> (f64, [u32; 8]) {
    let day = u32::try_from(day).unwrap();
    (f64::from(900 + day % 700) / 10.0, [0, 1, 2, 3, 4, 5, 6, 7].map(|interval| day % 37 * 8 + interval))
}

/// 100 days from 2026 January 1, in the three forms.
fn files() -> [String; 3] {
    let first = day_of("2026", "1", "1").unwrap();
    let mut files = [
        "DATE,BSRN,ND,KP1,KP2,KP3,KP4,KP5,KP6,KP7,KP8,KP_SUM,AP1,AP2,AP3,AP4,AP5,AP6,AP7,AP8,AP_AVG,CP,C9,ISN,F10.7_OBS,F10.7_ADJ,F10.7_DATA_TYPE,F10.7_OBS_CENTER81,F10.7_OBS_LAST81,F10.7_ADJ_CENTER81,F10.7_ADJ_LAST81\n".to_owned(),
        "DATATYPE CssiSpaceWeather\nVERSION 1.2\n# FORMAT(I4,I3,I3,I5,I3,8I3,I4,8I4,I4,F4.1,I2,I4,F6.1,I2,5F6.1)\nNUM_OBSERVED_POINTS 100\nBEGIN OBSERVED\n".to_owned(),
        "# PURPOSE: test\n#YYY MM DD  days  days_m  Bsr dB    Kp1    Kp2    Kp3    Kp4    Kp5    Kp6    Kp7    Kp8  ap1  ap2  ap3  ap4  ap5  ap6  ap7  ap8    Ap  SN F10.7obs F10.7adj D\n".to_owned(),
    ];
    for day in first..first + 100 {
        let date = Epoch::of_day(day).unwrap();
        let [year, month, date] = date.split('-').collect::<Vec<_>>().try_into().unwrap();
        let (flux, ap) = numbers(day);
        let mean = ap.iter().sum::<u32>() / 8;
        let adjusted = flux + 33.0;
        let list = |write: &dyn Fn(u32) -> String| ap.map(write).concat();
        writeln!(
            files[0],
            "{year}-{month}-{date},2626,4,20,27,13,13,20,17,20,23,153,{}{mean},0.4,2,58,{flux:.1},{adjusted:.1},OBS,141.7,144.2,139.2,139.9",
            list(&|ap| format!("{ap},"))
        )
        .unwrap();
        writeln!(
            files[1],
            "{year} {month} {date} 2626  4 20 27 13 13 20 17 20 23 153{}{mean:4} 0.4 2  58{adjusted:6.1} 0 139.2 139.9{flux:6.1} 141.7 144.2",
            list(&|ap| format!("{ap:4}"))
        )
        .unwrap();
        writeln!(
            files[2],
            "{year} {month} {date} 34333 34333.5 2626  4  2.000  2.667  1.333  1.333  2.000  1.667  2.000  2.333{} {mean:5}  58 {flux:8.1} {adjusted:8.1} 1",
            list(&|ap| format!(" {ap:4}"))
        )
        .unwrap();
    }
    files[1] += "END OBSERVED\n\nBEGIN MONTHLY_PREDICTED\n2030 01 01 2700  1  0  0  0  0  0  0  0  0   0   0   0   0   0   0   0   0   0   0 0.0 0  50 100.0 0 100.0 100.0 100.0 100.0 100.0\nEND MONTHLY_PREDICTED\n";
    files
}

#[test]
fn the_three_forms_give_the_indices_of_an_instant() {
    let day = day_of("2026", "02", "20").unwrap();
    let mean = (day - 40..=day + 40).map(|day| numbers(day).0).sum::<f64>() / 81.0;
    // 13:30 is in the fifth of the intervals.
    let interval = |before: i64| {
        let count = day * 8 + 4 - before;
        f64::from(numbers(count.div_euclid(8)).1[usize::try_from(count.rem_euclid(8)).unwrap()])
    };
    let mean_of = |from: i64| (from..from + 8).map(interval).sum::<f64>() / 8.0;
    let daily = f64::from(numbers(day).1.iter().sum::<u32>() / 8);
    let history = [daily, interval(0), interval(1), interval(2), interval(3), mean_of(4), mean_of(12)];
    for file in files() {
        let records = Records::parse(&file).unwrap();
        let SpaceWeather { f107, f107_average, ap } = records.at(epoch("2026-02-20T13:30:00Z")).unwrap();
        assert!((f107 - numbers(day - 1).0).abs() < 1e-9);
        assert!((f107_average - mean).abs() < 1e-9);
        assert_eq!(ap, Ap::History(history));
        // The mean flux takes 40 days on either side.
        assert!(records.at(epoch("2026-02-09T00:00:00Z")).is_none());
        assert!(records.at(epoch("2026-03-05T00:00:00Z")).is_none());
    }
}

/// Of predicted days the files have the mean of ap alone: 2026-08-05 as CelesTrak had it in August 2026.
#[test]
fn a_day_without_three_hours_has_its_mean() {
    let row = "2026-08-05,2632,24,13,,,,,,,,13,5,,,,,,,,5,,,95,111.7,113.1,PRD,133.5,130.0,,";
    let rows: Vec<_> = (0..90)
        .map(|day| {
            let date = Epoch::of_day(day_of("2026", "6", "20").unwrap() + day).unwrap();
            row.replace("2026-08-05", &date)
        })
        .collect();
    let records = Records::parse(&format!("DATE,BSRN\n{}\n", rows.join("\n"))).unwrap();
    let found = records.at(epoch("2026-08-05T12:00:00Z")).unwrap();
    assert_eq!(found.ap, Ap::Daily(5.0));
    assert!((found.f107 - 111.7).abs() < 1e-12);
}

#[test]
fn what_is_no_such_file_is_refused() {
    for (file, fault) in [
        ("", "there is no record"),
        ("DATE,BSRN\n2026-13-01,1,2\n", "line 2 is not a record"),
        ("2026 01 01 nonsense\n", "line 1 is not a record"),
        ("{\"a\": 1}", "line 1 is not a record"),
        ("BEGIN OBSERVED\n2026\nEND OBSERVED", "line 2 is not a record"),
    ] {
        let error = Records::parse(file).unwrap_err();
        assert!(error.contains(fault), "{file}: {error}");
    }
}

fn in_model(atmosphere: serde_json::Value) -> serde_json::Value {
    with_all(&capsule(), [("/epoch", json!("2026-11-29T12:00:00Z")), ("/atmosphere", atmosphere)])
}

#[tokio::test]
async fn the_answer_says_which_indices_were_taken() {
    let case = in_model(json!({"type": "nrlmsise00"}));
    let answer = fly(&with_all(
        &case,
        [("/echo", json!(true)), ("/output", json!({"columns": ["temperature", "pressure", "mach"]}))],
    ))
    .await;
    assert_eq!(answer["models"]["atmosphere"], "nrlmsise00");
    assert_eq!(answer["models"]["space_weather"], json!({"f107": 150.0, "f107_average": 150.0, "ap": 4.0}));
    assert_eq!(
        answer["case"]["atmosphere"],
        json!({"type": "nrlmsise00", "f107": 150.0, "f107_average": 150.0, "ap": 4.0})
    );
    // What is not said has the very default.
    let said = json!({"type": "nrlmsise00", "f107": 150, "f107_average": 150, "ap": 4});
    let other = fly(&with(&case, "/atmosphere", said)).await;
    assert_eq!(answer["final_state"], other["final_state"]);

    let history = json!([20, 30, 40, 50, 60, 15, 10]);
    let stormy = fly(&with(&case, "/atmosphere", json!({"type": "nrlmsise00", "ap": history}))).await;
    assert_eq!(stormy["models"]["space_weather"]["ap_history"], json!([20.0, 30.0, 40.0, 50.0, 60.0, 15.0, 10.0]));
    // A storm heats the upper air.
    let density = |answer: &serde_json::Value| answer["initial_state"]["density"].as_f64().unwrap();
    assert!((density(&stormy) / density(&answer) - 1.0).abs() > 1e-3);
}

/// Derivatives by an index come from differences of flights, and those by the state go through the model: both are the slopes of answers.
#[tokio::test]
async fn sensitivities_go_through_the_model() {
    let case = with(&in_model(json!({"type": "nrlmsise00"})), "/solver", json!({"relative_tolerance": 1e-13}));
    let pointers = [("/atmosphere/f107", 1.0), ("/initial_state/speed", 0.05), ("/vehicle/mass", 1.0)];
    let to: Vec<_> = pointers.iter().map(|(pointer, _)| *pointer).collect();
    let of = json!([{"quantity": "time"}, {"quantity": "longitude"}]);
    let answer = fly(&with(&case, "/sensitivities", json!({"of": of, "to": to}))).await;
    for (column, (pointer, step)) in pointers.into_iter().enumerate() {
        let nominal = fly(&with(&case, "/echo", true)).await["case"].pointer(pointer).unwrap().as_f64().unwrap();
        let mut ends = Vec::new();
        for moved in [nominal - step, nominal + step] {
            let end = fly(&with(&case, pointer, moved)).await["final_state"].clone();
            ends.push(["time", "longitude"].map(|quantity| end[quantity].as_f64().unwrap()));
        }
        for row in 0..2 {
            let slope = (ends[1][row] - ends[0][row]) / (2.0 * step);
            let found = answer["sensitivities"]["matrix"][row][column].as_f64().unwrap();
            assert!((found - slope).abs() < 2e-4 * slope.abs(), "{pointer}: {found} for {slope}");
        }
    }
}

#[tokio::test]
async fn indices_are_numbers_of_the_model_or_of_a_file() {
    let steady = Steady::new().await;
    for (atmosphere, faults) in [
        (
            json!({"type": "nrlmsise00", "f107": 49, "f107_average": 501, "ap": -1}),
            vec![
                ("/atmosphere/f107", "between 50 and 500"),
                ("/atmosphere/f107_average", "between 50 and 500"),
                ("/atmosphere/ap", "between 0 and 400"),
            ],
        ),
        (json!({"type": "nrlmsise00", "ap": [1, 2, 3, 4, 5, 6]}), vec![("/atmosphere/ap", "7")]),
        (json!({"type": "nrlmsise00", "ap": [1, 2, 3, 4, 5, 6, 401]}), vec![("/atmosphere/ap/6", "between 0 and 400")]),
        (
            json!({"type": "nrlmsise00", "indices": "file", "ap": 4}),
            vec![
                ("/atmosphere/ap", "must not be given together with indices"),
                ("/atmosphere/indices", "without --space-weather"),
            ],
        ),
        (json!({"type": "nrlmsise00", "indices": "web"}), vec![("/atmosphere/indices", "file")]),
    ] {
        steady.refused_at("/simulate", &in_model(atmosphere), &faults).await;
    }
    let timeless = without(&in_model(json!({"type": "nrlmsise00"})), "/epoch");
    steady.refused_at("/simulate", &timeless, &[("/epoch", "required: atmosphere nrlmsise00")]).await;
}
