//! `sensitivities` of outputs by numbers of the case, and `dispersions`.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use super::refusal::good_answer;
use super::requests::{with, with_all};
use super::simulate::fly;

/// A capsule from orbit with every kind of number: elements, tables, a schedule, wind, heating and events; in degrees.
fn capsule() -> Value {
    json!({
        "angle_unit": "deg",
        "epoch": "2026-11-29T00:00:00Z",
        "planet": {"model": "custom", "gravitational_parameter": 3.986e14, "equatorial_radius": 6_378_137.0,
            "polar_radius": 6_356_752.0, "rotation_rate": 7.29e-5, "gravity": {"type": "zonal", "degree": 2, "j2": 1.08e-3}},
        "atmosphere": {"type": "table", "altitude": [0, 1e4, 3e4, 6e4, 1e5, 1.3e5],
            "density": [1.2, 0.41, 0.018, 3e-4, 6e-7, 8e-9], "speed_of_sound": [340, 300, 302, 310, 280, 290]},
        "wind": {"type": "constant", "east": 12, "north": -5},
        "vehicle": {"mass": 3000, "reference_area": 4, "nose_radius": 1.2,
            "aerodynamics": {"type": "mach_table", "mach": [0.5, 1.5, 8], "lift_coefficient": [0, 0.2, 0.4], "drag_coefficient": [0.9, 1.4, 1.2]}},
        "control": {"bank_angle": {"type": "schedule", "against": "time", "at": [0, 300], "value": [50, 20], "interpolation": "step"}},
        "heating": {"convective": "sutton_graves"},
        "events": [
            {"name": "burn", "when": {"quantity": "altitude", "falls_through": 115e3},
             "then": {"thrust": {"along": "velocity", "value": -5000, "specific_impulse": 300, "propellant": 60}}},
            {"name": "push", "when": {"event": "burn", "delay": 12}, "then": {"delta_v": {"along": "normal", "value": 20}}},
            {"name": "drogue", "when": {"quantity": "mach", "falls_through": 1.2},
             "then": {"deploy": {"name": "d", "drag_area": 20, "inflation_time": 3}}},
        ],
        "initial_state": {"type": "orbital_elements", "semi_major_axis": 6.46e6, "eccentricity": 0.022, "inclination": 51,
            "raan": 20, "argument_of_periapsis": 200, "true_anomaly": 240, "sidereal_time": 100},
        "stop": {"altitude": 1000, "time": 5000},
        "output": {"trajectory": false},
    })
}

/// Numbers of the capsule, with steps for differences, in their own units.
const NUMBERS: [(&str, f64); 27] = [
    ("/planet/gravitational_parameter", 1e9),
    ("/planet/gravity/j2", 1e-8),
    ("/planet/rotation_rate", 1e-10),
    ("/atmosphere/density/2", 1e-6),
    ("/atmosphere/altitude/3", 1.0),
    ("/atmosphere/speed_of_sound/1", 1e-2),
    ("/density_factor", 1e-4),
    ("/wind/east", 1e-2),
    ("/vehicle/mass", 0.1),
    ("/vehicle/reference_area", 1e-4),
    ("/vehicle/nose_radius", 1e-4),
    ("/vehicle/aerodynamics/drag_coefficient/2", 1e-5),
    ("/vehicle/aerodynamics/mach/1", 1e-4),
    ("/control/bank_angle/value/1", 1e-3),
    ("/control/bank_angle/at/1", 1e-3),
    ("/events/0/when/falls_through", 1.0),
    ("/events/0/then/thrust/value", 0.1),
    ("/events/0/then/thrust/propellant", 1e-3),
    ("/events/1/when/delay", 1e-3),
    ("/events/1/then/delta_v/value", 1e-3),
    ("/events/2/when/falls_through", 1e-4),
    ("/events/2/then/deploy/inflation_time", 1e-3),
    ("/initial_state/semi_major_axis", 0.1),
    ("/initial_state/eccentricity", 1e-8),
    ("/initial_state/raan", 1e-5),
    ("/initial_state/sidereal_time", 1e-3),
    ("/stop/altitude", 0.1),
];

fn outputs() -> Value {
    json!([
        {"quantity": "time"},
        {"quantity": "longitude", "at": "end"},
        {"quantity": "geodetic_latitude"},
        {"quantity": "speed"},
        {"quantity": "mass"},
        {"quantity": "heat_load"},
        {"quantity": "ground_distance"},
        {"quantity": "raan"},
        {"quantity": "load_factor", "at": "peak"},
        {"quantity": "convective_heat_flux", "at": "peak"},
        {"quantity": "mach", "at": {"time": 300}},
        {"quantity": "altitude", "at": {"event": "push"}},
        {"quantity": "mass", "at": {"event": "drogue", "side": "after"}},
        {"quantity": "inclination", "at": "start"},
        {"quantity": "inertial_speed"},
        {"quantity": "inertial_flight_path_angle", "at": {"time": 200}},
        {"quantity": "specific_energy", "at": {"time": 200}},
        {"quantity": "energy", "at": {"time": 200}},
        {"quantity": "eccentricity", "at": {"event": "push", "side": "after"}},
        {"quantity": "apoapsis_altitude", "at": {"event": "push", "side": "after"}},
        {"quantity": "periapsis_altitude", "at": {"event": "push", "side": "after"}},
        {"site": {"longitude": 170, "geodetic_latitude": 30}},
    ])
}

/// The outputs of a case, without derivatives.
async fn values(case: &Value) -> Vec<f64> {
    values_of(case, outputs()).await
}

async fn values_of(case: &Value, outputs: Value) -> Vec<f64> {
    let asked = with(case, "/sensitivities", json!({"of": outputs, "to": []}));
    let answer = fly(&asked).await;
    answer["sensitivities"]["of"]
        .as_array()
        .unwrap()
        .iter()
        .map(|row| row["value"].as_f64().unwrap_or_else(|| panic!("{row}")))
        .collect()
}

#[tokio::test]
async fn a_matrix_is_the_differences_of_answers() {
    let case = with(&capsule(), "/solver", json!({"relative_tolerance": 1e-13}));
    let pointers: Vec<_> = NUMBERS.iter().map(|(pointer, _)| *pointer).collect();
    let filled = fly(&with(&case, "/echo", true)).await["case"].clone();
    let answer = fly(&with(&case, "/sensitivities", json!({"of": outputs(), "to": pointers}))).await;
    let Value::Object(sensitivities) = &answer["sensitivities"] else { panic!("{answer}") };
    assert_eq!(sensitivities["to"].as_array().unwrap().len(), NUMBERS.len());
    let quantities: Vec<_> =
        sensitivities["of"].as_array().unwrap().iter().map(|row| row["quantity"].as_str().unwrap()).collect();
    assert_eq!(quantities[21..], ["east", "north"], "a site has two numbers");
    for (column, (pointer, step)) in NUMBERS.into_iter().enumerate() {
        let told = &sensitivities["to"][column];
        let number = filled.pointer(pointer).and_then(Value::as_f64).unwrap();
        assert_eq!((told["pointer"].as_str(), told["value"].as_f64()), (Some(pointer), Some(number)));
        let is_of_model = ["/planet", "/atmosphere", "/wind", "/vehicle/nose", "/vehicle/aero", "/control"]
            .iter()
            .any(|model| pointer.starts_with(model));
        assert_eq!(told["method"], if is_of_model { "differences" } else { "exact" }, "{pointer}");
        let mut by_steps = Vec::new();
        for step in [2.0 * step, step] {
            let [above, below] = [
                values(&with(&filled, pointer, number + step)).await,
                values(&with(&filled, pointer, number - step)).await,
            ];
            let slopes = above.iter().zip(&below).zip(&quantities).map(|((above, below), quantity)| {
                let difference = above - below;
                let goes_around = ["longitude", "raan"].contains(quantity) && difference.abs() > 180.0;
                (difference - if goes_around { 360.0_f64.copysign(difference) } else { 0.0 }) / (2.0 * step)
            });
            by_steps.push(slopes.collect::<Vec<_>>());
        }
        for (row, quantity) in quantities.iter().enumerate() {
            let slope = sensitivities["matrix"][row][column].as_f64().unwrap();
            let (coarse, fine) = (by_steps[0][row], by_steps[1][row]);
            let value = sensitivities["of"][row]["value"].as_f64().unwrap();
            // The change that halving the step made, and the noise of flights at 1e-13: some 1e-11 of an output or of its unit. Apsides are
            // differences of radii, and bend with the eccentricity of 0.03 over the thousandth by which the gravity moves.
            let least = match *quantity {
                "altitude" => 1e3,
                "apoapsis_altitude" | "periapsis_altitude" => 6.4e6,
                _ => 1.0,
            };
            let noise = 4e-11 * value.abs().max(least) / step;
            let allowed = (fine - coarse).abs() + 1e-6 * fine.abs() + noise;
            assert!(
                (slope - fine).abs() <= allowed,
                "{quantity} ({row}) by {pointer}: {slope}, by differences {fine} ± {allowed}"
            );
        }
    }
}

/// The numbers of schedules against the energy and since an event, and of the condition with which their time begins.
#[tokio::test]
async fn schedules_by_energy_and_since_events_have_slopes() {
    let base = with(&capsule(), "/solver", json!({"relative_tolerance": 1e-13}));
    let schedule = |against: Value, at: Value| {
        let value = json!([50, 20, 70]);
        json!({"type": "schedule", "against": against, "at": at, "value": value, "interpolation": "step"})
    };
    let outputs = json!([{"quantity": "time"}, {"quantity": "longitude"}, {"quantity": "altitude", "at": {"time": 400}},
        {"quantity": "load_factor", "at": "peak"}]);
    let events = json!([{"name": "interface", "when": {"quantity": "altitude", "falls_through": 80e3}}]);
    let by_energy = with(
        &with(&base, "/events", json!([])),
        "/control/bank_angle",
        schedule(json!("energy"), json!([-1e9, -5e7, -3.4e7])),
    );
    let since = with(
        &with(&base, "/events", events),
        "/control/bank_angle",
        schedule(json!({"since": "interface"}), json!([0, 60, 150])),
    );
    let entries = [("/control/bank_angle/value/1", 1e-3), ("/initial_state/semi_major_axis", 0.1)];
    for (case, own) in [
        (by_energy, &[("/control/bank_angle/at/1", 100.0)][..]),
        (since, &[("/control/bank_angle/at/1", 1e-3), ("/events/0/when/falls_through", 1.0)]),
    ] {
        let numbers: Vec<_> = entries.iter().chain(own).collect();
        let pointers: Vec<_> = numbers.iter().map(|(pointer, _)| *pointer).collect();
        let answer = fly(&with(&case, "/sensitivities", json!({"of": outputs, "to": pointers}))).await;
        for (column, (pointer, step)) in numbers.into_iter().enumerate() {
            let number = case.pointer(pointer).and_then(Value::as_f64).unwrap();
            let mut by_steps = Vec::new();
            for step in [2.0 * step, *step] {
                let [above, below] = [number + step, number - step].map(|number| with(&case, pointer, number));
                let [above, below] =
                    [values_of(&above, outputs.clone()).await, values_of(&below, outputs.clone()).await];
                let slopes = above.iter().zip(&below).map(|(above, below)| (above - below) / (2.0 * step));
                by_steps.push(slopes.collect::<Vec<_>>());
            }
            for row in 0..4 {
                let sensitivities = &answer["sensitivities"];
                let slope = sensitivities["matrix"][row][column].as_f64().unwrap();
                let (coarse, fine) = (by_steps[0][row], by_steps[1][row]);
                let value = sensitivities["of"][row]["value"].as_f64().unwrap();
                // As above.
                let noise = 4e-11 * value.abs().max(if row == 2 { 1e3 } else { 1.0 }) / step;
                let allowed = (fine - coarse).abs() + 1e-6 * fine.abs() + noise;
                assert!(
                    (slope - fine).abs() <= allowed,
                    "{row} by {pointer}: {slope}, by differences {fine} ± {allowed}"
                );
            }
        }
    }
}

#[tokio::test]
async fn a_list_of_numbers_stands_for_each() {
    let asked = |to: Value| with(&capsule(), "/sensitivities", json!({"of": [{"quantity": "speed"}], "to": to}));
    let whole = fly(&asked(json!(["/vehicle/aerodynamics/drag_coefficient"]))).await["sensitivities"].clone();
    let names = [0, 1, 2].map(|index| json!(format!("/vehicle/aerodynamics/drag_coefficient/{index}")));
    let each = fly(&asked(json!(names))).await["sensitivities"].clone();
    assert_eq!(whole, each);
    assert_eq!(whole["to"].as_array().unwrap().len(), 3);
}

#[tokio::test]
async fn an_output_that_the_flight_does_not_have_is_null() {
    let never = json!({"name": "never", "when": {"quantity": "altitude", "rises_through": 9e6}});
    let mut case = capsule();
    case["events"].as_array_mut().unwrap().push(never);
    let of = json!([{"quantity": "speed", "at": {"event": "never"}}, {"quantity": "speed", "at": {"time": 4900}}]);
    case["sensitivities"] = json!({"of": of, "to": ["/vehicle/mass"]});
    let answer = fly(&case).await["sensitivities"].clone();
    for row in [0, 1] {
        assert_eq!(answer["of"][row], json!({"quantity": "speed", "time": null, "value": null}));
        assert_eq!(answer["matrix"][row], json!([null]));
    }
}

/// The faults of what is asked for, each at its place, all at once.
#[tokio::test]
async fn what_cannot_be_varied_or_given_is_refused() {
    let of = json!([
        {"quantity": "speed", "at": {"event": "nothing"}},
        {"quantity": "pressure"},
        {"quantity": "speed"},
    ]);
    let to = json!([
        "/vehicle/weight",
        "/vehicle",
        "/name",
        "/solver/relative_tolerance",
        "/output",
        "/vehicle/mass",
        "/vehicle/mass",
        "/control/bank_angle/value",
        "/control/bank_angle/value/1",
        "",
        "vehicle/mass",
    ]);
    let case = with(&with(&capsule(), "/name", "a capsule"), "/sensitivities", json!({"of": of, "to": to}));
    let answer = Service::new().post("/simulate", &case).await;
    assert_eq!(answer.status.as_u16(), 422);
    let faults: Vec<(String, String)> = answer.json()["errors"]
        .as_array()
        .unwrap()
        .iter()
        .map(|fault| (fault["pointer"].as_str().unwrap().into(), fault["detail"].as_str().unwrap().into()))
        .collect();
    let expected = [
        ("/sensitivities/of/0/at/event", "must be the name of an event of the case, got \"nothing\""),
        (
            "/sensitivities/of/1/quantity",
            "pressure requires an atmosphere with a pressure: standard, us76 or nrlmsise00, or a table with \
                                          pressure",
        ),
        ("/sensitivities/to/0", "must point to a number of the case, or to a list of numbers, got nothing"),
        ("/sensitivities/to/1", "must point to a number of the case, or to a list of numbers, got an object"),
        ("/sensitivities/to/2", "must point to a number of the case, or to a list of numbers, got \"a capsule\""),
        ("/sensitivities/to/3", "must not point into /solver, which is not part of the simulated case"),
        ("/sensitivities/to/4", "must not point into /output, which is not part of the simulated case"),
        ("/sensitivities/to/6", "/vehicle/mass is given twice"),
        ("/sensitivities/to/8", "/control/bank_angle/value/1 is given twice"),
        ("/sensitivities/to/9", "must point to a number of the case, or to a list of numbers, got an object"),
        ("/sensitivities/to/10", "must point to a number of the case, or to a list of numbers, got nothing"),
    ];
    let got: Vec<_> = faults.iter().map(|(pointer, detail)| (pointer.as_str(), detail.as_str())).collect();
    assert_eq!(got, expected);
}

/// At a bound a number moves to the one side that there is; where it has no room at all, or only what lies between two others of a list, it
/// moves by less.
#[tokio::test]
async fn numbers_at_their_bounds_have_slopes() {
    let case = with_all(
        &capsule(),
        [
            ("/vehicle/aerodynamics", json!({"type": "constant", "drag_coefficient": 0})),
            ("/atmosphere/altitude", json!([0, 1e4, 1e4 + 1.0, 6e4, 1e5, 1.3e5])),
            ("/control/bank_angle", json!(360)),
            ("/stop", json!({"time": 600})),
        ],
    );
    let to = json!(["/vehicle/aerodynamics/drag_coefficient", "/atmosphere/altitude/2", "/control/bank_angle"]);
    let answer = fly(&with(&case, "/sensitivities", json!({"of": [{"quantity": "speed"}], "to": to}))).await;
    let row = answer["sensitivities"]["matrix"][0].as_array().unwrap();
    assert!(row[0].as_f64().unwrap() < 0.0, "drag brakes: {row:?}");
    assert!(row.iter().all(Value::is_number), "{row:?}");
}

#[tokio::test]
async fn where_phases_would_change_there_is_no_slope() {
    let case = with(&capsule(), "/events/2/then/deploy/inflation_time", 0);
    let to = json!(["/events/2/then/deploy/inflation_time", "/events/2/then/deploy/drag_area"]);
    let answer = fly(&with(&case, "/sensitivities", json!({"of": [{"quantity": "speed"}], "to": to}))).await;
    let row = &answer["sensitivities"]["matrix"][0];
    assert!(row[0].is_null() && row[1].is_number(), "{row}");
}

/// The dispersions of a flight by hand, from its sensitivities.
#[tokio::test]
async fn a_covariance_is_that_of_the_slopes() {
    let case = capsule();
    let normal = |deviation: f64| json!({"type": "normal", "standard_deviation": deviation});
    let dispersions = json!([
        {"pointer": "/initial_state/eccentricity", "offset": normal(1e-5)},
        {"pointer": "/vehicle/aerodynamics/drag_coefficient", "factor": {"type": "normal", "mean": 1.02, "standard_deviation": 0.03}},
        {"pointer": ["/vehicle/mass", "/density_factor"], "factor": {"type": "multivariate_normal", "covariance": [[1e-4, 2e-4], [2e-4, 1e-2]]}},
    ]);
    let answer = fly(&with(&case, "/dispersions", dispersions)).await;
    let end = &answer["final_state"];
    let site = json!({"longitude": end["longitude"], "geodetic_latitude": end["geodetic_latitude"]});
    let of = json!([{"site": site}, {"quantity": "speed"}]);
    let to = json!([
        "/initial_state/eccentricity",
        "/vehicle/aerodynamics/drag_coefficient",
        "/vehicle/mass",
        "/density_factor"
    ]);
    let matrix = fly(&with(&case, "/sensitivities", json!({"of": of, "to": to}))).await["sensitivities"].clone();
    let slope = |row: usize, column: usize| matrix["matrix"][row][column].as_f64().unwrap();
    // The drag coefficients move together, each by its own part; a factor of the mass moves it by its part.
    let by = |row: usize| {
        let drag = 0.9 * slope(row, 1) + 1.4 * slope(row, 2) + 1.2 * slope(row, 3);
        [slope(row, 0), drag, 3000.0 * slope(row, 4), slope(row, 5)]
    };
    let rows = [by(0), by(1), by(2)];
    let [of_eccentricity, of_drag] = [1e-5_f64.powi(2), 0.03_f64.powi(2)];
    let parts = |a: &[f64; 4], b: &[f64; 4]| {
        let joint = a[2] * b[2] * 1e-4 + (a[2] * b[3] + a[3] * b[2]) * 2e-4 + a[3] * b[3] * 1e-2;
        [a[0] * b[0] * of_eccentricity, a[1] * b[1] * of_drag, joint]
    };
    let covariance = |i: usize, j: usize| parts(&rows[i], &rows[j]).iter().sum::<f64>();
    let landing = &answer["covariance"]["landing"];
    let number = |value: &Value| value.as_f64().unwrap();
    let near = |what: &str, got: f64, expected: f64| {
        assert!((got - expected).abs() <= 1e-6 * expected.abs(), "{what}: {got}, not {expected}");
    };
    for (i, j) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
        near("a covariance", number(&landing["covariance"][i][j]), covariance(i, j));
    }
    let [semi_major, semi_minor] = ["semi_major_axis", "semi_minor_axis"].map(|axis| number(&landing[axis]));
    near("the trace", semi_major.powi(2) + semi_minor.powi(2), covariance(0, 0) + covariance(1, 1));
    let determinant = covariance(0, 0) * covariance(1, 1) - covariance(0, 1).powi(2);
    near("the determinant", (semi_major * semi_minor).powi(2), determinant);
    let (sin, cos) = number(&landing["azimuth"]).to_radians().sin_cos();
    let along = covariance(0, 0) * sin * sin + 2.0 * covariance(0, 1) * sin * cos + covariance(1, 1) * cos * cos;
    near("the variance along the azimuth", along, semi_major.powi(2));
    for (row, shift) in landing["shift"].as_array().unwrap().iter().enumerate() {
        near("the shift by the mean of a factor", number(shift), 0.02 * rows[row][1]);
    }
    near("speed", number(&answer["covariance"]["standard_deviations"]["speed"]), covariance(2, 2).sqrt());
    let told = answer["covariance"]["dispersions"].as_array().unwrap();
    assert_eq!(told[2]["pointers"], json!(["/vehicle/mass", "/density_factor"]));
    for (index, told) in told.iter().enumerate() {
        let share = parts(&rows[0], &rows[0])[index] + parts(&rows[1], &rows[1])[index];
        near("a share", number(&told["share"]), share / (covariance(0, 0) + covariance(1, 1)));
        near(
            "a share of the speed",
            number(&told["shares"]["speed"]),
            parts(&rows[2], &rows[2])[index] / covariance(2, 2),
        );
        assert!(told["shares"].get("altitude").is_none(), "the altitude of the end is given");
    }
}

#[tokio::test]
async fn faulty_dispersions_are_refused() {
    for (dispersion, pointer, detail) in [
        (
            json!({"pointer": "/vehicle", "offset": {"type": "normal", "standard_deviation": 1}}),
            "/pointer",
            "must point to a number of the case, or to a list of numbers, got an object",
        ),
        (json!({"pointer": "/vehicle/mass"}), "", "must have exactly one of offset, factor, got none of them"),
        (
            json!({"pointer": "/vehicle/mass", "offset": {"type": "uniform", "minimum": 0, "maximum": 1}}),
            "/offset/type",
            "must be one of normal, multivariate_normal, got \"uniform\"",
        ),
        (
            json!({"pointer": "/vehicle/mass", "offset": {"type": "normal", "standard_deviation": -1}}),
            "/offset/standard_deviation",
            "must be between 0 and 1e25, got -1",
        ),
        (
            json!({"pointer": "/vehicle/mass", "offset": {"type": "multivariate_normal", "covariance": [[1, 0], [0, 1]]}}),
            "/pointer",
            "must have as many pointers as offset has variables, 2, got 1",
        ),
        (
            json!({"pointer": ["/vehicle/mass", "/density_factor"],
                "factor": {"type": "multivariate_normal", "covariance": [[1, 2], [2, 1]]}}),
            "/factor/covariance",
            "must have no negative eigenvalue: the least eigenvalue of its correlation matrix is -1.000e0",
        ),
        (
            json!({"pointer": ["/vehicle/mass", "/density_factor"],
                "factor": {"type": "multivariate_normal", "covariance": [[1, 0.5], [0.4, 1]]}}),
            "/factor/covariance/1/0",
            "must equal the element in row 0 and column 1, 0.5: a covariance is symmetric; got 0.4",
        ),
        (
            json!({"pointer": ["/vehicle/mass", "/vehicle/mass"],
                "factor": {"type": "multivariate_normal", "covariance": [[1, 0], [0, 1]]}}),
            "/pointer/1",
            "/vehicle/mass is given twice",
        ),
    ] {
        let case = with(&capsule(), "/dispersions", json!([dispersion]));
        let answer = Service::new().post("/simulate", &case).await;
        assert_eq!(answer.status.as_u16(), 422, "{dispersion}");
        let fault = &answer.json()["errors"][0];
        assert_eq!(fault["pointer"], format!("/dispersions/0{pointer}"), "{dispersion}: {fault}");
        assert_eq!(fault["detail"], detail, "{dispersion}");
    }
}

/// A theory's flight has them too, and CSV has no place for them.
#[tokio::test]
async fn they_are_beside_a_theory_and_not_in_csv() {
    let theory: Value = serde_json::from_str(include_str!("../../openapi/examples/steep_ballistic.json")).unwrap();
    let asks = json!({"of": [{"quantity": "speed"}], "to": ["/vehicle/mass"]});
    let scatters = json!([{"pointer": "/vehicle/mass", "factor": {"type": "normal", "standard_deviation": 0.01}}]);
    let theory = with_all(&theory, [("/sensitivities", asks), ("/dispersions", scatters)]);
    let answer = good_answer(&Service::new(), "/analytic", &theory).await;
    assert_eq!(answer["sensitivities"]["to"][0]["pointer"], "/vehicle/mass");
    assert_eq!(answer["covariance"]["dispersions"][0]["share"], 1.0);
    let answer = Service::new().post("/analytic?format=csv", &theory).await;
    assert_eq!(
        (answer.status.as_u16(), answer.pointers()),
        (422, vec!["/sensitivities".into(), "/dispersions".into()])
    );
}

/// A vehicle at rest on the ground ends where it starts, at an altitude that stands still: there is no slope, and no fault.
#[tokio::test]
async fn a_flight_that_ends_at_rest_has_no_slopes_by_its_end() {
    let case = json!({
        "angle_unit": "deg",
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 1, "aerodynamics": {"type": "ballistic", "ballistic_coefficient": 1e5}},
        "initial_state": {"type": "planet_relative", "altitude": 0, "longitude": 0, "geocentric_latitude": 0, "speed": 0,
            "flight_path_angle": 0, "azimuth": 0},
        "output": {"trajectory": false},
        "sensitivities": {"of": [{"quantity": "speed"}, {"quantity": "longitude"}], "to": ["/vehicle/mass", "/initial_state/altitude"]},
    });
    let answer = fly(&case).await;
    let rows = [json!(["speed", 0.0]), json!(["longitude", 0.0])];
    let of = answer["sensitivities"]["of"].as_array().unwrap();
    assert_eq!([0, 1].map(|row| json!([of[row]["quantity"], of[row]["value"]])), rows);
    assert_eq!(answer["sensitivities"]["matrix"][0], json!([null, null]));
    assert_eq!(fly(&with(&case, "/sensitivities", true)).await["sensitivities"]["speed"]["speed"], json!(null));
}
