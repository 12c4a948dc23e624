//! Columns that are given only where they are asked for, distances over the ground, and the peaks of phases.

use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::check;

use super::refusal::good_answer;
use super::requests::{capsule, event, with, with_all};
use super::simulate::{fly, names};

const ORBIT: [&str; 8] = [
    "semi_major_axis",
    "eccentricity",
    "inclination",
    "raan",
    "argument_of_periapsis",
    "true_anomaly",
    "apoapsis_altitude",
    "periapsis_altitude",
];

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

/// An orbit in vacuum, with the columns of the orbit and those of the state.
fn in_orbit(state: &Value) -> Value {
    let state_columns = ["time", "radius", "longitude", "geocentric_latitude", "speed", "flight_path_angle", "heading"];
    let columns: Vec<_> = state_columns.into_iter().chain(ORBIT).collect();
    with_all(
        &capsule(),
        [
            ("/angle_unit", json!("deg")),
            ("/atmosphere", json!({"type": "vacuum"})),
            ("/initial_state", state.clone()),
            ("/stop", json!({"altitude": -1e6, "time": 4000})),
            ("/output", json!({"times": [500, 2500], "columns": columns})),
        ],
    )
}

fn elements(semi_major_axis: f64, eccentricity: f64, inclination: f64) -> Value {
    json!({"type": "orbital_elements", "semi_major_axis": semi_major_axis, "eccentricity": eccentricity, "inclination": inclination,
        "raan": 40, "argument_of_periapsis": 70, "true_anomaly": 10, "sidereal_time": 20_000})
}

/// `/convert` is told each row's state, and the sidereal time then; the thesis's planet has a gravitational parameter for its elements alone.
#[tokio::test]
async fn the_columns_of_the_orbit_are_those_of_convert() {
    let service = Service::new();
    for planet in [json!({}), json!({"model": "earth_jameson_listing"})] {
        let case = with(&in_orbit(&elements(8e6, 0.15, 51.6)), "/planet", planet.clone());
        let rows = good_answer(&service, "/simulate", &case).await["trajectory"].clone();
        for row in 0..4 {
            let of = |name: &str| &rows[name][row];
            let state = json!({"type": "planet_relative", "radius": of("radius"), "longitude": of("longitude"),
                "geocentric_latitude": of("geocentric_latitude"), "speed": of("speed"), "heading": of("heading"),
                "flight_path_angle": of("flight_path_angle"), "sidereal_time": 20_000.0 + number(of("time"))});
            let asked = json!({"angle_unit": "deg", "planet": planet, "state": state});
            let converted = good_answer(&service, "/convert", &asked).await;
            for name in &ORBIT[..6] {
                check::relative(name, number(of(name)), number(&converted["orbital_elements"][name]), 1e-11);
            }
            for (name, radius) in [("apoapsis_altitude", "apoapsis_radius"), ("periapsis_altitude", "periapsis_radius")]
            {
                check::near(name, number(of(name)), number(&converted["derived"][radius]) - 6_378_137.0, 1e-4);
            }
        }
        for (name, given) in [("semi_major_axis", 8e6), ("eccentricity", 0.15), ("inclination", 51.6), ("raan", 40.0)] {
            check::relative(name, number(&rows[name][0]), given, 1e-11);
        }
        check::near("argument_of_periapsis", number(&rows["argument_of_periapsis"][0]), 70.0, 1e-9);
        check::near("true_anomaly", number(&rows["true_anomaly"][0]), 10.0, 1e-9);
        // With the gravity of a point an orbit keeps its elements, as far as it is that of the elements.
        if planet == json!({}) {
            check::relative("a", number(&rows["semi_major_axis"][3]), 8e6, 1e-8);
            check::near("raan", number(&rows["raan"][3]), 40.0, 1e-7);
        }
    }
    // An epoch turns the planet; the elements stay those of the inertial frame.
    let mut state = elements(8e6, 0.15, 51.6);
    state.as_object_mut().unwrap().remove("sidereal_time");
    let case = with(&in_orbit(&state), "/epoch", json!("2026-11-22T12:00:00Z"));
    let answer = fly(&case).await;
    check::near("raan with an epoch", number(&answer["trajectory"]["raan"][0]), 40.0, 1e-9);
    check::near("and later", number(&answer["trajectory"]["raan"][3]), 40.0, 1e-7);
}

/// Whatever frame the state comes in, the columns are in that of date: that of `/convert` for a place on the planet at the epoch.
#[tokio::test]
async fn the_columns_of_the_orbit_are_in_the_frame_of_date() {
    let service = Service::new();
    let epoch = json!("2026-11-22T12:00:00Z");
    let mut inclinations = Vec::new();
    for frame in ["date", "teme", "gcrf"] {
        let mut state = with(&elements(8e6, 0.15, 51.6), "/frame", json!(frame));
        state.as_object_mut().unwrap().remove("sidereal_time");
        let rows = fly(&with(&in_orbit(&state), "/epoch", epoch.clone())).await["trajectory"].clone();
        let of = |name: &str| &rows[name][0];
        let state = json!({"type": "planet_relative", "radius": of("radius"), "longitude": of("longitude"),
            "geocentric_latitude": of("geocentric_latitude"), "speed": of("speed"), "heading": of("heading"),
            "flight_path_angle": of("flight_path_angle")});
        let converted =
            good_answer(&service, "/convert", &json!({"angle_unit": "deg", "epoch": epoch, "state": state})).await;
        for name in &ORBIT[..6] {
            check::relative(name, number(of(name)), number(&converted["orbital_elements"][name]), 1e-9);
        }
        inclinations.push(number(of("inclination")));
    }
    check::near("of the frame of date", inclinations[0], 51.6, 1e-9);
    assert!((inclinations[2] - 51.6).abs() > 0.01, "precession tilts the equator: {inclinations:?}");
    // A planet that does not turn may be turned by an angle all the same.
    let mut state = with(&elements(8e6, 0.15, 51.6), "/sidereal_angle", json!(77));
    state.as_object_mut().unwrap().remove("sidereal_time");
    let planet = json!({"model": "custom", "shape": "sphere", "equatorial_radius": 6e6, "polar_radius": 6e6, "rotation_rate": 0,
        "gravitational_parameter": 4e14});
    let answer = fly(&with(&in_orbit(&state), "/planet", planet)).await;
    check::near("raan", number(&answer["trajectory"]["raan"][0]), 40.0, 1e-9);
    check::near("later", number(&answer["trajectory"]["raan"][3]), 40.0, 1e-7);
}

#[tokio::test]
async fn what_an_orbit_does_not_have_is_null() {
    let first_row = |state: Value| async move {
        let rows = fly(&in_orbit(&state)).await["trajectory"].clone();
        ORBIT.map(|name| rows[name][0].clone())
    };
    let null = Value::Null;
    let [a, e, i, raan, argument, anomaly, apoapsis, periapsis] = first_row(elements(7e6, 0.0, 0.0)).await;
    check::relative("a", number(&a), 7e6, 1e-11);
    check::near("e", number(&e), 0.0, 1e-12);
    check::near("i", number(&i), 0.0, 1e-9);
    assert_eq!((&raan, &argument), (&null, &null));
    check::near("from the inertial x axis", number(&anomaly), 120.0, 1e-9);
    check::near("apoapsis", number(&apoapsis), 7e6 - 6_378_137.0, 1e-4);
    check::near("periapsis", number(&periapsis), 7e6 - 6_378_137.0, 1e-4);
    let [a, e, _, raan, .., apoapsis, periapsis] = first_row(elements(-9e6, 1.8, 30.0)).await;
    check::relative("a", number(&a), -9e6, 1e-11);
    check::relative("e", number(&e), 1.8, 1e-11);
    check::near("raan", number(&raan), 40.0, 1e-9);
    assert_eq!(apoapsis, null, "a hyperbola has no apoapsis");
    check::near("periapsis", number(&periapsis), 9e6 * 0.8 - 6_378_137.0, 1e-3);
    // At rest in inertial space.
    let at_rest = json!({"type": "eci", "position": [7e6, 0, 1e6], "velocity": [0, 0, 0]});
    assert_eq!(first_row(at_rest.clone()).await, [(); 8].map(|()| null.clone()));
    let columns =
        with(&in_orbit(&at_rest), "/output", json!({"count": 2, "columns": ["raan", "time", "apoapsis_altitude"]}));
    let csv = Service::new().post("/simulate?format=csv", &columns).await;
    let csv = String::from_utf8(csv.body.to_vec()).unwrap();
    assert_eq!(csv.lines().take(2).collect::<Vec<_>>(), ["raan,time,apoapsis_altitude", ",0.0,"]);
}

/// Radians stay radians, and degrees become degrees.
#[tokio::test]
async fn the_angles_of_the_orbit_are_in_the_unit_of_the_case() {
    let degrees = in_orbit(&elements(8e6, 0.15, 51.6));
    let mut radians = with(&degrees, "/angle_unit", json!("rad"));
    for name in ["inclination", "raan", "argument_of_periapsis", "true_anomaly"] {
        let pointer = format!("/initial_state/{name}");
        let angle = number(degrees.pointer(&pointer).unwrap());
        radians = with(&radians, &pointer, json!(angle.to_radians()));
    }
    let [degrees, radians] = [fly(&degrees).await, fly(&radians).await];
    for name in ["inclination", "raan", "argument_of_periapsis", "true_anomaly"] {
        let [degrees, radians] = [&degrees, &radians].map(|answer| number(&answer["trajectory"][name][2]));
        check::near(name, degrees.to_radians(), radians, 1e-9);
    }
}

#[tokio::test]
async fn what_is_given_only_on_request_is_nowhere_else() {
    let burn = json!({"thrust": {"along": "velocity", "value": -3e4, "specific_impulse": 300, "propellant": 100}});
    let case = with(&capsule(), "/events", json!([event("time", "rises_through", 10.0, &burn)]));
    let answer = fly(&case).await;
    for place in ["initial_state", "final_state", "trajectory"] {
        let found = names(&answer[place]);
        assert!(ORBIT.iter().chain(&["thrust"]).all(|name| !found.contains(name)), "{place}: {found:?}");
        assert!(found.ends_with(&["mass", "ground_range", "ground_distance"]), "{place}: {found:?}");
    }
    let asked = with(&case, "/output", json!({"times": [9, 10, 12, 40], "columns": ["thrust", "eccentricity"]}));
    let answer = fly(&asked).await;
    assert_eq!(names(&answer["trajectory"]), ["thrust", "eccentricity"]);
    assert!(!names(&answer["final_state"]).contains(&"thrust"));
    // 100 kg at 30 kN and 300 s last 9.8 s; the magnitude has no sign.
    assert_eq!(answer["trajectory"]["thrust"], json!([0.0, 0.0, 3e4, 3e4, 0.0, 0.0]));
}

/// A capsule after its deorbit burn lands more than half round the Earth from where it began to brake: 38 446.7 km, by an integration with
/// The energy by its formula, from columns that the case has unasked: over a sphere with gravity of a point.
#[tokio::test]
async fn the_energy_is_that_of_the_rotating_planet() {
    let planet = json!({"model": "custom", "gravitational_parameter": 3.986e14, "equatorial_radius": 6.378e6,
        "polar_radius": 6.378e6, "rotation_rate": 7.3e-5});
    let columns = ["speed", "radius", "geocentric_latitude", "energy"];
    let output = json!({"interval": 10, "columns": columns});
    let case = with_all(&capsule(), [("/planet", planet), ("/output", output)]);
    let trajectory = fly(&case).await["trajectory"].clone();
    let [speeds, radii, latitudes, energies] =
        columns.map(|name| trajectory[name].as_array().unwrap().iter().map(number).collect::<Vec<_>>());
    for row in 0..speeds.len() {
        let rotation = 7.3e-5 * radii[row] * latitudes[row].cos();
        let expected = speeds[row].powi(2) / 2.0 - 3.986e14 / radii[row] - rotation.powi(2) / 2.0;
        check::near("energy", energies[row], expected, 1e-6);
    }
    assert!(energies.is_sorted_by(|before, after| before > &(after - 1e-3)), "{energies:?}");
    assert!(!names(&fly(&capsule()).await["final_state"]).contains(&"energy"), "it is given on request");
}

/// DOP853 of `SciPy`.
#[tokio::test]
async fn downrange_goes_on_beyond_half_the_globe() {
    let chute = |area: f64| json!({"reference_area": area});
    let burn = json!({"thrust": {"along": "velocity", "value": -2950, "specific_impulse": 302, "propellant": 150}});
    let drogue = json!({"reference_area": 24, "aerodynamics": {"type": "constant", "drag_coefficient": 0.8}});
    let case = json!({
        "angle_unit": "deg",
        "planet": {"gravity": {"type": "zonal", "degree": 2}},
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 7000, "reference_area": 3.8, "aerodynamics": {"type": "constant", "lift_coefficient": 0.35,
            "drag_coefficient": 1.3}},
        "control": {"bank_angle": 60},
        "initial_state": {"type": "orbital_elements", "semi_major_axis": 6_678_137, "eccentricity": 0, "inclination": 51.6,
            "raan": 22, "argument_of_periapsis": 0, "true_anomaly": 304},
        "events": [
            event("time", "rises_through", 0.0, &burn),
            event("altitude", "falls_through", 140e3, &json!({"mass": 2900})),
            event("mach", "falls_through", 0.9, &drogue),
            event("altitude", "falls_through", 7500.0, &chute(160.0)),
            event("altitude", "falls_through", 6500.0, &chute(1000.0)),
            event("altitude", "falls_through", 5500.0, &json!({"mass": 2700})),
        ],
        "output": {"interval": 300, "columns": ["time", "downrange", "ground_distance"]},
    });
    let answer = fly(&case).await;
    check::near("downrange", number(&answer["final_state"]["downrange"]), 38_446.7e3, 100.0);
    let column = |name: &str| answer["trajectory"][name].as_array().unwrap().iter().map(number).collect::<Vec<_>>();
    let downrange = column("downrange");
    assert!(downrange.is_sorted() && column("ground_distance").is_sorted(), "{downrange:?}");
    assert!(downrange.windows(2).all(|pair| pair[1] - pair[0] < 2.4e6), "300 s at 8 km/s are 2400 km");
    for event in answer["events"].as_array().unwrap() {
        let (time, reached) = (number(&event["time"]), number(&event["state"]["downrange"]));
        let times = column("time");
        let row = times.partition_point(|row| *row <= time) - 1;
        assert!((downrange[row]..=downrange[row + 1]).contains(&reached), "{reached} m at {time} s");
    }
    // Nearly once round, it comes down not far from below its start.
    assert!(number(&answer["final_state"]["ground_range"]) < 2e6);
}

/// The load of a parachute that opens at once is the peak of the flight, and not that of the entry.
#[tokio::test]
async fn phases_have_the_peaks_between_the_changes_of_the_vehicle() {
    let burn = json!({"thrust": {"along": "velocity", "value": -3e4, "specific_impulse": 300, "propellant": 100}});
    let parachute = json!({"reference_area": 200, "aerodynamics": {"type": "constant", "drag_coefficient": 0.8}});
    let events = json!([
        with(&event("mach", "falls_through", 0.9, &parachute), "/name", "parachute"),
        event("altitude", "falls_through", 1e5, &json!({"delta_v": {"along": "radial", "value": 1}})),
        with(&event("time", "rises_through", 10.0, &burn), "/name", "brake"),
        event("speed", "falls_through", 1000.0, &json!({})),
    ]);
    let air = with_all(&capsule(), [("/atmosphere", json!({"type": "us76"})), ("/output", json!({"count": 2}))]);
    let answer = fly(&with(&air, "/events", events)).await;
    let phases = answer["phases"].as_array().unwrap();
    let origins: Vec<_> = phases.iter().map(|phase| phase["from"].clone()).collect();
    let expected = [
        json!(null),
        json!({"index": 2, "name": "brake"}),
        json!({"index": 2, "name": "brake", "burnout": true}),
        json!({"index": 0, "name": "parachute"}),
    ];
    assert_eq!(origins, expected);
    for phase in phases {
        assert_eq!(names(phase), ["from", "since", "until", "peaks"]);
        assert_eq!(names(&phase["peaks"]), names(&answer["peaks"]));
        for peak in phase["peaks"].as_object().unwrap().values() {
            assert!((number(&phase["since"])..=number(&phase["until"])).contains(&number(&peak["time"])), "{phase}");
        }
    }
    assert_eq!([&phases[0]["since"], &phases[1]["since"]], [&json!(0.0), &json!(10.0)]);
    assert_eq!(phases[3]["until"], answer["final_state"]["time"]);
    let peak = |index: usize| phases[index]["peaks"]["load_factor"].clone();
    assert_eq!(peak(3), answer["peaks"]["load_factor"]);
    assert_eq!(peak(3)["value"], answer["events"].as_array().unwrap().last().unwrap()["after"]["load_factor"]);
    let entry = fly(&with(&air, "/events", json!([event("time", "rises_through", 10.0, &burn)]))).await;
    check::relative("entry", number(&peak(2)["value"]), number(&entry["peaks"]["load_factor"]["value"]), 1e-2);
    assert!(number(&peak(2)["value"]) < number(&peak(3)["value"]));
    assert_eq!(names(&answer["peaks"])[4], "speed");
    // Where nothing changes the vehicle there is nothing to tell apart.
    let mark = event("speed", "falls_through", 1000.0, &json!({}));
    let push = event("altitude", "falls_through", 1e5, &json!({"delta_v": {"along": "radial", "value": 1}}));
    for case in [air.clone(), with(&air, "/events", json!([mark, push]))] {
        assert_eq!(fly(&case).await.get("phases"), None);
    }
}
