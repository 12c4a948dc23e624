//! Good requests, to send as they are or to spoil in one place.

use serde_json::{Value, json};

/// The six kinds of state.
pub(crate) const KINDS: [&str; 6] =
    ["planet_relative", "geodetic", "ecef", "eci", "orbital_elements", "inertial_flight_path"];

/// The fields of which exactly one is given, each with the kind of its state: the one that [`state`] gives, the other, and a value
/// for that.
pub(crate) const ALTERNATIVES: [(&str, &str, &str, f64); 6] = [
    ("planet_relative", "altitude", "radius", 6.5e6),
    ("planet_relative", "heading", "azimuth", 1.1),
    ("orbital_elements", "semi_major_axis", "semi_latus_rectum", 6.5e6),
    ("orbital_elements", "true_anomaly", "mean_anomaly", 3.5),
    ("inertial_flight_path", "altitude", "radius", 6.5e6),
    ("inertial_flight_path", "inertial_heading", "inertial_azimuth", 1.1),
];

/// A state of the given kind, with every field but the second of its alternatives.
pub(crate) fn state(kind: &str) -> Value {
    match kind {
        "planet_relative" => json!({"type": kind, "altitude": 9e4, "longitude": -0.7, "geocentric_latitude": 0.4,
            "speed": 7000, "flight_path_angle": -0.05, "heading": 0.5, "sidereal_time": 100}),
        "geodetic" => json!({"type": kind, "geodetic_altitude": 9e4, "longitude": 0.7, "geodetic_latitude": -0.4,
            "speed": 7000, "flight_path_angle": -0.05, "azimuth": 1.5, "sidereal_time": 100}),
        "ecef" => {
            json!({"type": kind, "position": [4e6, -3e6, 4.1e6], "velocity": [4e3, 6e3, 200], "sidereal_time": 100})
        }
        "eci" => json!({"type": kind, "frame": "date", "position": [4e6, -3e6, 4.1e6], "velocity": [4e3, 6e3, 200],
            "sidereal_time": 100}),
        "orbital_elements" => {
            json!({"type": kind, "frame": "date", "semi_major_axis": 6.5e6, "eccentricity": 0.01, "inclination": 1.1,
            "raan": 2.1, "argument_of_periapsis": 0.3, "true_anomaly": 3.5, "sidereal_time": 100})
        }
        "inertial_flight_path" => json!({"type": kind, "altitude": 9e4, "longitude": -0.7, "geocentric_latitude": 0.4,
            "inertial_speed": 7400, "inertial_flight_path_angle": -0.05, "inertial_heading": 0.5, "sidereal_time": 100}),
        _ => panic!("no such kind of state: {kind}"),
    }
}

/// A second of flight, with every field given that may be given beside the others; `/analytic` takes it as well.
pub(crate) fn flight(kind: &str) -> Value {
    json!({
        "name": "a second of flight",
        "angle_unit": "rad",
        "echo": false,
        "sensitivities": false,
        "verify": false,
        "epoch": "2026-11-22T12:00:00Z",
        "planet": planet(),
        "atmosphere": {"type": "exponential", "surface_density": 1.2, "scale_height": 7000},
        "density_factor": 1.1,
        "wind": {"type": "constant", "east": 12, "north": -5},
        "vehicle": {
            "mass": 700,
            "reference_area": 0.2,
            "aerodynamics": {"type": "constant", "lift_coefficient": 0.2, "drag_coefficient": 0.2},
            "nose_radius": 0.3,
        },
        "control": {"bank_angle": 0.8, "angle_of_attack": 0},
        "initial_state": state(kind),
        "stop": {"altitude": -1e4, "time": 1, "ceiling": 3e6, "when": [{"quantity": "speed", "falls_through": 10}]},
        "output": {"count": 3},
        "solver": {"formulation": "cartesian", "relative_tolerance": 1e-9},
    })
}

/// A conversion, with every field given that may be given beside the others.
pub(crate) fn conversion(kind: &str) -> Value {
    json!({
        "angle_unit": "rad",
        "echo": false,
        "epoch": "2026-11-22T12:00:00Z",
        "planet": planet(),
        "state": state(kind),
    })
}

/// The flight with each of the other models, and what they are.
#[expect(clippy::too_many_lines, reason = "a list")]
pub(crate) fn models() -> Vec<(&'static str, Value)> {
    let flight = || with(&flight("geodetic"), "/atmosphere", json!({"type": "us76"}));
    let schedule = |against: &str| json!({"type": "schedule", "against": against, "at": [1, 20], "value": [0.1, -0.2], "interpolation": "step"});
    vec![
        ("us76", flight()),
        ("vacuum", with(&flight(), "/atmosphere", json!({"type": "vacuum"}))),
        (
            "layers",
            with(
                &flight(),
                "/atmosphere",
                json!({"type": "layered_exponential", "layers": [
                {"base_altitude": 0, "density": 1.225, "scale_height": 7200}]}),
            ),
        ),
        (
            "preset",
            with(&flight(), "/atmosphere", json!({"type": "layered_exponential", "preset": "earth_seven_layer"})),
        ),
        (
            "table of air",
            with(
                &flight(),
                "/atmosphere",
                json!({"type": "table", "altitude": [0, 5e4, 1e5],
                "density": [1.2, 1e-3, 6e-7], "temperature": [288, 270, 200], "pressure": [1e5, 80, 0.03]}),
            ),
        ),
        (
            "table of a gas",
            with(
                &flight(),
                "/atmosphere",
                json!({"type": "table", "altitude": [0, 5e4, 1e5], "density": [0.02, 3e-4, 3e-7],
                "temperature": [240, 140, 120], "molar_mass": 0.04401, "heat_capacity_ratio": [1.28, 1.35, 1.37]}),
            ),
        ),
        (
            "table of sound",
            with(
                &flight(),
                "/atmosphere",
                json!({"type": "table", "altitude": [0, 5e4, 1e5], "density": [1.2, 1e-3, 6e-7],
                "speed_of_sound": [340, 330, 284]}),
            ),
        ),
        ("wind from", with(&flight(), "/wind", json!({"type": "constant", "speed": 13, "from": 4.3}))),
        (
            "table of wind from",
            with(&flight(), "/wind", json!({"type": "table", "altitude": [0, 1e4], "speed": [5, 30], "from": [0, 5]})),
        ),
        (
            "heating of a gas",
            with(&flight(), "/heating", json!({"convective": {"type": "sutton_graves", "constant": 1.9e-4}})),
        ),
        (
            "table of wind",
            with(&flight(), "/wind", json!({"type": "table", "altitude": [0, 1e4], "east": [5, 30], "north": [0, 5]})),
        ),
        (
            "zonal",
            with(
                &flight(),
                "/planet/gravity",
                json!({"type": "zonal", "degree": 4, "j2": 1e-3, "j3": -2e-6,
                "j4": -1e-6}),
            ),
        ),
        (
            "ballistic",
            without(
                &with(
                    &flight(),
                    "/vehicle/aerodynamics",
                    json!({"type": "ballistic", "ballistic_coefficient": 5000,
                    "lift_to_drag": 0.3}),
                ),
                "/vehicle/reference_area",
            ),
        ),
        (
            "mach_table",
            with(
                &flight(),
                "/vehicle/aerodynamics",
                json!({"type": "mach_table", "mach": [0.5, 1, 5],
                "lift_coefficient": [0.1, 0.2, 0.15], "drag_coefficient": [0.3, 0.8, 0.6]}),
            ),
        ),
        (
            "alpha_mach_table",
            with(
                &flight(),
                "/vehicle/aerodynamics",
                json!({"type": "alpha_mach_table", "angle_of_attack": [0, 0.5],
                "mach": [0.5, 1, 5], "lift_coefficient": [[0, 0, 0], [0.2, 0.4, 0.3]],
                "drag_coefficient": [[0.3, 0.8, 0.6], [0.5, 1, 0.9]]}),
            ),
        ),
        (
            "schedules",
            with_all(
                &flight(),
                [("/control/bank_angle", schedule("altitude")), ("/control/angle_of_attack", schedule("mach"))],
            ),
        ),
        ("schedule against energy", with(&flight(), "/control/bank_angle", schedule("energy"))),
        (
            "schedule since an event",
            with_all(
                &flight(),
                [
                    ("/events", json!([named("first")])),
                    (
                        "/control/bank_angle",
                        json!({"type": "schedule", "against": {"since": "first"}, "at": [0.1, 0.4], "value": [0.1, -0.2]}),
                    ),
                ],
            ),
        ),
        ("columns", with(&flight(), "/output/columns", json!(["time", "altitude"]))),
        ("no bodies", with(&flight(), "/output/bodies", "none")),
        (
            "nearest site",
            with_all(&flight(), [("/planet", json!({"model": "earth_wgs84"})), ("/output/sites", json!(true))]),
        ),
        (
            "heating",
            with(
                &flight(),
                "/heating",
                json!({"convective": "chapman", "radiative": "tauber_sutton", "emissivity": 0.8}),
            ),
        ),
        ("events", with(&flight(), "/events", json!([everything_changes()]))),
        ("waiting event", with(&flight(), "/events", json!([named("first"), waiting("first", 0.1)]))),
        (
            "thrust off",
            with(&flight(), "/events", json!([event("time", "rises_through", 0.5, &json!({"thrust": "off"}))])),
        ),
        (
            "thrust without mass flow",
            with(
                &flight(),
                "/events",
                json!([event("time", "rises_through", 0.5, &json!({"thrust": inertial_thrust()}))]),
            ),
        ),
        (
            "launch from a site",
            launch(&json!({"site": "mahia", "azimuth": 1.7, "hold_down": true, "sidereal_time": 100})),
        ),
        (
            "launch from a place",
            launch(
                &json!({"geodetic_latitude": 0.5, "longitude": -0.7, "geodetic_altitude": 10, "sidereal_time": 100}),
            ),
        ),
        ("parts", staged(&[])),
        ("engine at sea level", staged(&[("/vehicle/parts/2/engine/thrust/vacuum", json!(1e12))])),
        ("vertical", staged(&[("/control/steering", json!({"type": "vertical"}))])),
        ("linear tangent", staged(&[("/control/steering", json!({"type": "linear_tangent", "a": 2, "b": 0.01}))])),
        (
            "program by the launch",
            staged(&[("/control/steering", json!({"type": "program", "frame": "launch", "pitch": 0.9, "yaw": 0.1}))]),
        ),
        (
            "program by the horizon",
            staged(&[(
                "/control/steering",
                json!({"type": "program", "frame": "local", "pitch": 0.9, "azimuth": 1.1}),
            )]),
        ),
        (
            "program by the stars",
            staged(&[(
                "/control/steering",
                json!({"type": "program", "frame": "inertial", "right_ascension": 0.9, "declination": 0.1}),
            )]),
        ),
        ("engines", staged(&[("/events/0/then", json!({"ignite": ["second"]})), ("/events/1/then", engines_change())])),
        ("burnout", staged(&[("/events/1/when", json!({"burnout": "booster", "delay": 0.1}))])),
        ("separation", staged(&[("/events/1/then", json!({"separate": [leaves()]}))])),
        ("parachute", with(&flight(), "/events", json!([deploys()]))),
        (
            "release",
            with(
                &flight(),
                "/events",
                json!([deploys(), event("time", "rises_through", 0.7, &json!({"release": ["drogue"]}))]),
            ),
        ),
    ]
}

/// A mark with a name.
pub(crate) fn named(name: &str) -> Value {
    json!({"name": name, "when": condition("time", "rises_through", 0.2)})
}

/// A mark that waits for an event.
pub(crate) fn waiting(name: &str, delay: f64) -> Value {
    json!({"when": {"event": name, "delay": delay}})
}

fn inertial_thrust() -> Value {
    json!({"along": {"frame": "inertial", "direction": [1, -2, 0.5]}, "value": 3000, "specific_impulse": 280})
}

/// A second of a launch without parts, which stands on its pad: at the site or the place, from which the sidereal time goes.
fn launch(place: &Value) -> Value {
    let state = with(place, "/type", "launch");
    with_all(&flight("geodetic"), [("/atmosphere", json!({"type": "us76"})), ("/initial_state", state)])
}

/// A second of flight of a vehicle with parts, whose boosters are lit, with further changes.
pub(crate) fn staged(changes: &[(&str, Value)]) -> Value {
    let constant = || json!({"type": "constant", "lift_coefficient": 0, "drag_coefficient": 0.9});
    let vehicle = json!({
        "parts": [
            {
                "name": "core", "count": 1, "dry_mass": 100, "propellant": 500,
                "engine": {"thrust": {"vacuum": 9000}, "specific_impulse": 300, "exit_area": 0.01},
            },
            {
                "name": "booster", "count": 2, "dry_mass": 20, "propellant": 50,
                "engine": {"thrust": {"type": "table", "time": [0, 0.3, 0.6], "vacuum": [0, 3000, 0]}, "specific_impulse": 250},
                "reference_area": 0.1, "aerodynamics": constant(), "nose_radius": 0.2,
            },
            {
                "name": "second", "dry_mass": 50, "propellant": 100,
                "engine": {"thrust": {"vacuum": 5000, "sea_level": 4000}, "specific_impulse": 320},
            },
            {"name": "payload", "dry_mass": 30},
        ],
        "reference_area": 0.2,
        "aerodynamics": {"type": "constant", "lift_coefficient": 0.2, "drag_coefficient": 0.2},
        "nose_radius": 0.3,
    });
    let lit = json!({"ignite": ["booster"]});
    let request = with_all(
        &flight("geodetic"),
        [
            ("/atmosphere", json!({"type": "us76"})),
            ("/vehicle", vehicle),
            ("/control", json!({"bank_angle": 0.8})),
            (
                "/events",
                json!([event("time", "rises_through", 0.1, &lit), event("time", "rises_through", 0.2, &json!({}))]),
            ),
        ],
    );
    changes.iter().fold(request, |request, (pointer, value)| with(&request, pointer, value.clone()))
}

/// Everything that an event may do to engines.
fn engines_change() -> Value {
    json!({
        "ignite": ["core"], "shut_down": ["second"], "throttle": {"core": 0.6}, "load_limit": 4,
        "steer": {"type": "velocity"}, "tilt": {"angle": 0.1, "azimuth": 1.2},
    })
}

/// The boosters that leave, with everything that may be said of a body.
fn leaves() -> Value {
    json!({
        "name": "boosters", "parts": ["booster"], "push": {"along": "radial", "value": -1.5}, "reference_area": 0.3,
        "aerodynamics": {"type": "constant", "lift_coefficient": 0, "drag_coefficient": 0.7},
        "events": [{"name": "opens", "when": condition("time", "rises_through", 0.5), "then": {"reference_area": 8}}],
        "control": {"bank_angle": 0.1, "angle_of_attack": 0},
        "stop": {"altitude": -100, "time": 1, "ceiling": 3e6, "when": [condition("speed", "falls_through", 10.0)]},
    })
}

/// An event that deploys a parachute.
fn deploys() -> Value {
    let parachute = json!({"name": "drogue", "drag_area": 20, "inflation_time": 0.2, "delay": 0.1});
    event("time", "rises_through", 0.4, &json!({"deploy": parachute}))
}

/// The flight with one of the other models.
pub(crate) fn model(name: &str) -> Value {
    models().into_iter().find(|(of, _)| *of == name).unwrap().1
}

/// A condition: a quantity, which way it passes the value, and the value.
pub(crate) fn condition(quantity: &str, way: &str, value: f64) -> Value {
    json!({"quantity": quantity, way: value})
}

/// An event with its effect.
pub(crate) fn event(quantity: &str, way: &str, value: f64, then: &Value) -> Value {
    json!({"when": condition(quantity, way, value), "then": then})
}

/// An event on the way of every [`flight`], with every effect there is.
fn everything_changes() -> Value {
    let then = json!({
        "mass": 650,
        "reference_area": 0.3,
        "aerodynamics": {"type": "constant", "lift_coefficient": 0.1, "drag_coefficient": 0.4},
        "delta_v": {"along": "normal", "value": 20},
        "thrust": {"along": "velocity", "value": -3000, "specific_impulse": 280, "propellant": 0.5},
    });
    with(&event("altitude", "falls_through", 89_950.0, &then), "/name", "all at once")
}

/// A search for a target over a second of flight, of few flights, with every field of a search; with the goals given.
pub(crate) fn target(achieve: Value) -> Value {
    let speed = json!({
        "pointer": "/initial_state/speed", "between": [6900, 7100], "scale": 10,
        "also": [{"pointer": "/vehicle/mass", "factor": 0.1}],
    });
    with_all(
        &flight("geodetic"),
        [
            ("/events", json!([named("first")])),
            ("/vary", json!([speed])),
            ("/achieve", achieve),
            ("/search", json!({"starts": 4, "solutions": 2, "flights": 40, "record": false})),
        ],
    )
}

/// A corridor of a second of flight, with every field of it; with the limits given.
pub(crate) fn corridor(limits: Value) -> Value {
    let speed = json!({
        "pointer": "/initial_state/speed", "between": [6900, 7100], "scale": 10,
        "also": [{"pointer": "/wind/east", "factor": 1e-3}],
    });
    with_all(
        &flight("geodetic"),
        [("/events", json!([named("first")])), ("/vary", speed), ("/limits", limits), ("/resolution", json!(1))],
    )
}

/// A footprint of a second of flight, with every field of it; with the limits given.
pub(crate) fn footprint(limits: Value) -> Value {
    let search = json!({"flights": 40});
    let of_target = without(&with(&target(goals()), "/limits", limits), "/achieve");
    with_all(&of_target, [("/resolution", json!(1)), ("/search", search)])
}

/// What flights of [`target`] and [`corridor`] keep: a limit of each kind, at each kind of moment.
pub(crate) fn limits() -> Value {
    json!([
        {"quantity": "load_factor", "at": "peak", "at_most": 0.5, "with": {"/control/bank_angle": 0}},
        {"quantity": "altitude", "at": {"event": "first", "side": "after"}, "at_least": 1e3},
        {"quantity": "altitude", "at": {"time": 0.5}, "between": [1e3, 1e5]},
        {"site": {"longitude": 0.7, "geodetic_latitude": -0.4}, "within": 1e5},
        {"termination": ["time_limit"]},
    ])
}

/// The same, each flown with the case as it is.
pub(crate) fn limits_alone() -> Value {
    let mut limits = limits();
    limits[0].as_object_mut().unwrap().shift_remove("with");
    limits
}

/// The same, as goals, and one to be met.
pub(crate) fn goals() -> Value {
    let mut goals = limits_alone();
    goals[3]["tolerance"] = json!(1);
    goals.as_array_mut().unwrap().push(json!({"quantity": "speed", "equals": 7000, "tolerance": 1e-3}));
    goals
}

/// The least that can be flown: a capsule from 120 km.
pub(crate) fn capsule() -> Value {
    json!({
        "vehicle": {
            "mass": 5500, "reference_area": 12, "aerodynamics": {"type": "constant", "drag_coefficient": 1.3},
        },
        "initial_state": {
            "type": "planet_relative", "altitude": 120_000, "longitude": -0.7, "geocentric_latitude": 0.17,
            "speed": 7500, "flight_path_angle": -0.05, "heading": 0.5,
        },
    })
}

fn planet() -> Value {
    json!({"model": "custom", "shape": "ellipsoid", "gravitational_parameter": 3.986e14, "equatorial_radius": 6.378e6,
        "polar_radius": 6.357e6, "rotation_rate": 7.3e-5, "gravity": {"type": "zonal", "degree": 2, "j2": 1.08e-3}})
}

/// The name of a member that a token of a pointer names.
fn unescaped(token: &str) -> String {
    token.replace("~1", "/").replace("~0", "~")
}

/// The request with the value at the pointer, whose parent must be there.
pub(crate) fn with(request: &Value, pointer: &str, value: impl Into<Value>) -> Value {
    let mut request = request.clone();
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    match request.pointer_mut(parent) {
        Some(Value::Object(map)) => {
            map.insert(unescaped(name), value.into());
        }
        Some(Value::Array(array)) => array[name.parse::<usize>().unwrap()] = value.into(),
        _ => panic!("there is nothing at {parent}"),
    }
    request
}

/// The request with the values of all the pointers, in turn.
pub(crate) fn with_all<const N: usize>(request: &Value, changes: [(&str, Value); N]) -> Value {
    changes.into_iter().fold(request.clone(), |request, (pointer, value)| with(&request, pointer, value))
}

/// The request without the field at the pointer, which must be there.
pub(crate) fn without(request: &Value, pointer: &str) -> Value {
    let mut request = request.clone();
    let (parent, name) = pointer.rsplit_once('/').unwrap();
    let removed =
        request.pointer_mut(parent).and_then(Value::as_object_mut).and_then(|map| map.shift_remove(&unescaped(name)));
    assert!(removed.is_some(), "there is nothing at {pointer}");
    request
}
