//! Every field of the requests: where it stands, what it holds, and what it may be (the table of the API's contract).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use serde_json::{Value, json};

use super::requests::{
    ALTERNATIVES, KINDS, condition, conversion, corridor, flight, footprint, goals, limits, limits_alone, model,
    models, target, with, without,
};

/// A field of a request.
pub(crate) struct Field {
    /// The endpoint.
    pub(crate) path: &'static str,
    /// A good request that has the field.
    pub(crate) request: Value,
    /// The field.
    pub(crate) pointer: String,
    /// Whether it may be left out.
    pub(crate) need: Need,
    /// What it holds.
    pub(crate) kind: Kind,
}

/// Whether a field may be left out.
#[derive(Clone, Copy, PartialEq)]
pub(crate) enum Need {
    Required,
    Optional,
    /// Exactly one of several is given.
    Alternative,
}

/// What a field holds.
#[derive(Clone, Copy)]
pub(crate) enum Kind {
    Number(Range),
    /// A number in the request's unit of angles; the range is in radians.
    Angle(Range),
    /// The same, or an object with a schedule.
    Command(Range),
    /// An object with a thrust, or `"off"`.
    Thrust,
    /// Text, or an object.
    TextOrObject,
    /// One of some names, or an object.
    NameOrObject,
    /// A number, or one for each entry of a table.
    NumberOrNumbers(Range),
    /// A number, or null.
    NumberOrNull(Range),
    /// A whole number.
    Whole,
    /// One of some names.
    Name,
    Text,
    Boolean,
    /// True, false, or an object.
    BooleanOrObject,
    /// `false` and nothing else.
    False,
    Object,
    /// Three numbers.
    Vector,
    Numbers,
    /// Rows of numbers.
    Matrix,
    /// Some of several names.
    Names,
    /// Texts.
    Texts,
    /// A text, or texts.
    TextOrTexts,
    Objects,
    /// An RFC 3339 time.
    Instant,
    /// Seconds or `"HH:MM:SS.s"`.
    SiderealTime,
}

/// The values that a number may have.
#[derive(Clone, Copy)]
pub(crate) struct Range {
    pub(crate) low: Limit,
    pub(crate) high: Limit,
}

/// An end of a range.
#[derive(Clone, Copy)]
pub(crate) enum Limit {
    /// Belongs to the range.
    Closed(f64),
    /// Does not belong to it.
    Open(f64),
    Unlimited,
}

use Kind::{
    Angle, Boolean, BooleanOrObject, Command, False, Instant, Matrix, Name, NameOrObject, Names, Number, NumberOrNull,
    NumberOrNumbers, Numbers, Object, Objects, SiderealTime, Text, TextOrObject, TextOrTexts, Texts, Thrust, Vector,
    Whole,
};
use Limit::{Closed, Open, Unlimited};
use Need::{Alternative, Optional, Required};

const FINITE: Range = Range { low: Unlimited, high: Unlimited };
const POSITIVE: Range = Range { low: Open(0.0), high: Unlimited };
const NOT_NEGATIVE: Range = Range { low: Closed(0.0), high: Unlimited };
const SPEED: Range = between(0.0, 1e6);
const DISTANCE: Range = between(-1e12, 1e12);
const LENGTH: Range = between(0.0, 1e12);
const RADIUS: Range = Range { low: Open(0.0), high: Closed(1e12) };
const PLANET_RADIUS: Range = between(1.0, 1e12);
const QUARTER: Range = between(-FRAC_PI_2, FRAC_PI_2);
const HALF: Range = between(0.0, PI);
const TURN: Range = between(-TAU, TAU);

const TIME: Range = between(0.0, 1e9);
const VELOCITY: Range = between(-1e6, 1e6);
const FORCE: Range = between(-1e12, 1e12);
const SPECIFIC_IMPULSE: Range = between(1e-3, 1e9);
const DRAG_AREA: Range = between(0.0, 1e9);
const EMISSIVITY: Range = Range { low: Open(0.0), high: Closed(1.0) };
const WIND: Range = between(-1e4, 1e4);
const WIND_SPEED: Range = between(0.0, 1e4);
const HEAT_CAPACITY_RATIO: Range = between(1.0, 2.0);
const MOLAR_MASS: Range = between(1e-6, 1.0);
const COEFFICIENT: Range = between(-0.1, 0.1);
const THRUST_OF_ENGINE: Range = between(0.0, 1e12);
const LOAD_LIMIT: Range = Range { low: Open(0.0), high: Closed(1e6) };
const STOP_TIME: Range = Range { low: Open(0.0), high: Closed(1e9) };

const fn between(low: f64, high: f64) -> Range {
    Range { low: Closed(low), high: Closed(high) }
}

type Row = (&'static str, Need, Kind);

const SHARED: [Row; 13] = [
    ("/angle_unit", Optional, Name),
    ("/echo", Optional, Boolean),
    ("/epoch", Optional, Instant),
    ("/planet", Optional, Object),
    ("/planet/shape", Optional, Name),
    ("/planet/gravity", Optional, Object),
    ("/planet/gravity/type", Required, Name),
    ("/planet/gravity/degree", Optional, Whole),
    ("/planet/gravity/j2", Required, Number(COEFFICIENT)),
    ("/planet/gravitational_parameter", Required, Number(between(1e-6, 1e25))),
    ("/planet/equatorial_radius", Required, Number(PLANET_RADIUS)),
    ("/planet/polar_radius", Required, Number(PLANET_RADIUS)),
    ("/planet/rotation_rate", Required, Number(between(-1.0, 1.0))),
];

const CASE: [Row; 29] = [
    ("/name", Optional, Text),
    ("/atmosphere", Optional, Object),
    ("/atmosphere/type", Required, Name),
    ("/atmosphere/surface_density", Optional, Number(NOT_NEGATIVE)),
    ("/atmosphere/scale_height", Optional, Number(POSITIVE)),
    ("/density_factor", Optional, Number(NOT_NEGATIVE)),
    ("/wind", Optional, Object),
    ("/wind/type", Required, Name),
    ("/wind/east", Required, Number(WIND)),
    ("/wind/north", Required, Number(WIND)),
    ("/vehicle", Required, Object),
    ("/vehicle/mass", Alternative, Number(POSITIVE)),
    ("/vehicle/reference_area", Required, Number(NOT_NEGATIVE)),
    ("/vehicle/aerodynamics", Required, Object),
    ("/vehicle/aerodynamics/type", Required, Name),
    ("/vehicle/aerodynamics/lift_coefficient", Optional, Number(FINITE)),
    ("/vehicle/aerodynamics/drag_coefficient", Required, Number(NOT_NEGATIVE)),
    ("/vehicle/nose_radius", Optional, Number(POSITIVE)),
    ("/control", Optional, Object),
    ("/control/bank_angle", Optional, Command(TURN)),
    ("/control/angle_of_attack", Optional, Command(TURN)),
    ("/stop", Optional, Object),
    ("/stop/altitude", Optional, Number(DISTANCE)),
    ("/stop/time", Optional, Number(STOP_TIME)),
    ("/stop/ceiling", Optional, Number(DISTANCE)),
    ("/stop/when", Optional, Objects),
    ("/stop/when/0/quantity", Alternative, Name),
    ("/output", Optional, Object),
    ("/solver", Optional, Object),
];

/// The fields of the other models.
#[expect(clippy::too_many_lines, reason = "a list")]
fn of_model(name: &str) -> (&'static str, &'static [Row]) {
    match name {
        "us76" | "vacuum" => ("/atmosphere", &[("/type", Required, Name)]),
        "layers" => (
            "/atmosphere/layers",
            &[
                ("", Alternative, Objects),
                ("/0/base_altitude", Required, Number(DISTANCE)),
                ("/0/density", Required, Number(NOT_NEGATIVE)),
                ("/0/scale_height", Required, Number(POSITIVE)),
            ],
        ),
        "preset" => ("/atmosphere", &[("/preset", Alternative, Name)]),
        "table of air" => (
            "/atmosphere",
            &[
                ("/altitude", Required, Numbers),
                ("/density", Required, Numbers),
                ("/temperature", Optional, Numbers),
                ("/pressure", Optional, Numbers),
            ],
        ),
        "table of a gas" => (
            "/atmosphere",
            &[
                ("/temperature", Required, Numbers),
                ("/molar_mass", Required, NumberOrNumbers(MOLAR_MASS)),
                ("/heat_capacity_ratio", Required, NumberOrNumbers(HEAT_CAPACITY_RATIO)),
            ],
        ),
        "table of sound" => ("/atmosphere", &[("/speed_of_sound", Optional, Numbers)]),
        "table of wind" => {
            ("/wind", &[("/altitude", Required, Numbers), ("/east", Required, Numbers), ("/north", Required, Numbers)])
        }
        "wind from" => ("/wind", &[("/speed", Required, Number(WIND_SPEED)), ("/from", Required, Angle(TURN))]),
        "table of wind from" => ("/wind", &[("/speed", Required, Numbers), ("/from", Required, Numbers)]),
        "heating of a gas" => (
            "/heating/convective",
            &[("", Optional, NameOrObject), ("/type", Required, Name), ("/constant", Required, Number(POSITIVE))],
        ),
        "zonal" => {
            ("/planet/gravity", &[("/j3", Required, Number(COEFFICIENT)), ("/j4", Required, Number(COEFFICIENT))])
        }
        "ballistic" => (
            "/vehicle/aerodynamics",
            &[("/ballistic_coefficient", Required, Number(POSITIVE)), ("/lift_to_drag", Optional, Number(FINITE))],
        ),
        "mach_table" => (
            "/vehicle/aerodynamics",
            &[
                ("/mach", Required, Numbers),
                ("/lift_coefficient", Required, Numbers),
                ("/drag_coefficient", Required, Numbers),
            ],
        ),
        "alpha_mach_table" => (
            "/vehicle/aerodynamics",
            &[
                ("/angle_of_attack", Required, Numbers),
                ("/mach", Required, Numbers),
                ("/lift_coefficient", Required, Matrix),
                ("/drag_coefficient", Required, Matrix),
            ],
        ),
        "schedules" => (
            "/control/bank_angle",
            &[
                ("/type", Required, Name),
                ("/against", Required, NameOrObject),
                ("/at", Required, Numbers),
                ("/value", Required, Numbers),
                ("/interpolation", Optional, Name),
            ],
        ),
        "schedule against energy" => {
            ("/control/bank_angle", &[("/against", Required, NameOrObject), ("/at", Required, Numbers)])
        }
        "schedule since an event" => (
            "/control/bank_angle",
            &[("/against", Required, NameOrObject), ("/against/since", Required, Text), ("/at", Required, Numbers)],
        ),
        "columns" => ("/output", &[("/columns", Optional, Names)]),
        "no bodies" => ("/output", &[("/bodies", Optional, Name)]),
        "nearest site" => ("/output", &[("/sites", Optional, Boolean)]),
        "heating" => (
            "/heating",
            &[
                ("", Optional, Object),
                ("/convective", Optional, NameOrObject),
                ("/radiative", Optional, Name),
                ("/emissivity", Optional, Number(EMISSIVITY)),
            ],
        ),
        "events" => ("/events", &EVENT),
        "waiting event" => ("/events/1/when", &[("/event", Alternative, Text), ("/delay", Optional, Number(TIME))]),
        "launch from a site" => ("/initial_state", &LAUNCH),
        "launch from a place" => ("/initial_state", &LAUNCH_PLACE),
        "parts" => ("/vehicle/parts", &PARTS),
        "engine at sea level" => {
            ("/vehicle/parts/2/engine/thrust", &[("/sea_level", Optional, Number(THRUST_OF_ENGINE))])
        }
        "vertical" => ("/control/steering", &[("", Optional, Object), ("/type", Required, Name)]),
        "linear tangent" => {
            ("/control/steering", &[("/a", Required, Number(FINITE)), ("/b", Required, Number(FINITE))])
        }
        "program by the launch" => (
            "/control/steering",
            &[("/frame", Required, Name), ("/pitch", Required, Command(TURN)), ("/yaw", Optional, Command(TURN))],
        ),
        "program by the horizon" => {
            ("/control/steering", &[("/pitch", Required, Command(TURN)), ("/azimuth", Required, Command(TURN))])
        }
        "program by the stars" => (
            "/control/steering",
            &[("/right_ascension", Required, Command(TURN)), ("/declination", Required, Command(TURN))],
        ),
        "engines" => ("/events/1/then", &ENGINES),
        "burnout" => ("/events/1/when", &[("/burnout", Alternative, Text), ("/delay", Optional, Number(TIME))]),
        "separation" => ("/events/1/then/separate", &SEPARATION),
        "thrust off" => ("/events/0/then", &[("/thrust", Optional, Thrust)]),
        "thrust without mass flow" => ("/events/0/then/thrust", &THRUST),
        "parachute" => ("/events/0/then/deploy", &PARACHUTE),
        "release" => ("/events/1/then", &[("/release", Optional, Texts)]),
        _ => panic!("no such model: {name}"),
    }
}

/// An event with every effect there is.
const EVENT: [Row; 19] = [
    ("", Optional, Objects),
    ("/0/name", Optional, Text),
    ("/0/when", Required, Object),
    ("/0/when/quantity", Alternative, Name),
    ("/0/then", Optional, Object),
    ("/0/then/mass", Optional, Number(POSITIVE)),
    ("/0/then/reference_area", Optional, Number(NOT_NEGATIVE)),
    ("/0/then/aerodynamics", Optional, Object),
    ("/0/then/aerodynamics/type", Required, Name),
    ("/0/then/aerodynamics/lift_coefficient", Optional, Number(FINITE)),
    ("/0/then/aerodynamics/drag_coefficient", Required, Number(NOT_NEGATIVE)),
    ("/0/then/delta_v", Optional, Object),
    ("/0/then/delta_v/along", Required, NameOrObject),
    ("/0/then/delta_v/value", Required, Number(VELOCITY)),
    ("/0/then/thrust", Optional, Thrust),
    ("/0/then/thrust/along", Required, NameOrObject),
    ("/0/then/thrust/value", Required, Number(FORCE)),
    // Propellant needs it.
    ("/0/then/thrust/specific_impulse", Alternative, Number(SPECIFIC_IMPULSE)),
    ("/0/then/thrust/propellant", Optional, Number(POSITIVE)),
];

/// A thrust in inertial space that burns no mass.
const THRUST: [Row; 4] = [
    ("/along", Required, NameOrObject),
    ("/along/frame", Required, Name),
    ("/along/direction", Required, Vector),
    ("/specific_impulse", Optional, Number(SPECIFIC_IMPULSE)),
];

const PARACHUTE: [Row; 5] = [
    ("", Optional, Object),
    ("/name", Required, Text),
    ("/drag_area", Required, Number(DRAG_AREA)),
    ("/inflation_time", Required, Number(TIME)),
    ("/delay", Optional, Number(TIME)),
];

const LAUNCH: [Row; 6] = [
    ("", Required, Object),
    ("/type", Required, Name),
    ("/site", Alternative, Text),
    ("/azimuth", Optional, Angle(TURN)),
    ("/hold_down", Optional, Boolean),
    ("/sidereal_time", Optional, SiderealTime),
];

const LAUNCH_PLACE: [Row; 3] = [
    ("/geodetic_latitude", Alternative, Angle(QUARTER)),
    ("/longitude", Required, Angle(TURN)),
    ("/geodetic_altitude", Optional, Number(DISTANCE)),
];

/// Of a part with a constant thrust, of one with a table, and of one that is carried.
const PARTS: [Row; 19] = [
    ("", Alternative, Objects),
    ("/0/name", Required, Text),
    ("/0/count", Optional, Whole),
    ("/0/dry_mass", Required, Number(NOT_NEGATIVE)),
    ("/0/propellant", Optional, Number(NOT_NEGATIVE)),
    // Propellant needs it.
    ("/0/engine", Alternative, Object),
    ("/0/engine/thrust", Required, Object),
    ("/0/engine/thrust/vacuum", Required, NumberOrNumbers(THRUST_OF_ENGINE)),
    ("/0/engine/specific_impulse", Required, Number(SPECIFIC_IMPULSE)),
    ("/0/engine/exit_area", Optional, Number(NOT_NEGATIVE)),
    ("/1/engine/thrust/type", Alternative, Name),
    ("/1/engine/thrust/time", Required, Numbers),
    ("/1/reference_area", Optional, Number(NOT_NEGATIVE)),
    ("/1/aerodynamics", Optional, Object),
    ("/1/aerodynamics/type", Required, Name),
    ("/1/aerodynamics/drag_coefficient", Required, Number(NOT_NEGATIVE)),
    ("/1/nose_radius", Optional, Number(POSITIVE)),
    // Without propellant it has a mass.
    ("/3/name", Required, Text),
    ("/3/dry_mass", Required, Number(POSITIVE)),
];

/// What an event does to engines.
const ENGINES: [Row; 9] = [
    ("/ignite", Optional, Texts),
    ("/shut_down", Optional, Texts),
    ("/throttle", Optional, Object),
    ("/load_limit", Optional, NumberOrNull(LOAD_LIMIT)),
    ("/steer", Optional, Object),
    ("/steer/type", Required, Name),
    ("/tilt", Optional, Object),
    ("/tilt/angle", Required, Angle(TURN)),
    ("/tilt/azimuth", Optional, Angle(TURN)),
];

/// A body with everything that may be said of it.
const SEPARATION: [Row; 19] = [
    ("", Optional, Objects),
    ("/0/name", Required, Text),
    ("/0/parts", Required, Texts),
    ("/0/push", Optional, Object),
    ("/0/push/along", Required, NameOrObject),
    ("/0/push/value", Required, Number(VELOCITY)),
    ("/0/reference_area", Optional, Number(NOT_NEGATIVE)),
    ("/0/aerodynamics", Optional, Object),
    ("/0/aerodynamics/drag_coefficient", Required, Number(NOT_NEGATIVE)),
    ("/0/events", Optional, Objects),
    ("/0/events/0/then/reference_area", Optional, Number(NOT_NEGATIVE)),
    ("/0/control", Optional, Object),
    ("/0/control/bank_angle", Optional, Command(TURN)),
    ("/0/stop", Optional, Object),
    ("/0/stop/altitude", Optional, Number(DISTANCE)),
    ("/0/stop/time", Optional, Number(STOP_TIME)),
    ("/0/stop/ceiling", Optional, Number(DISTANCE)),
    ("/0/stop/when", Optional, Objects),
    ("/0/stop/when/0/quantity", Alternative, Name),
];

const ASKED: [Row; 5] = [
    ("/sensitivities", Optional, BooleanOrObject),
    ("/sensitivities/of", Required, Objects),
    ("/sensitivities/of/0/quantity", Alternative, Name),
    ("/sensitivities/of/0/at", Optional, NameOrObject),
    ("/sensitivities/to", Required, Texts),
];

const AT_TIME: [Row; 1] = [("/sensitivities/of/0/at/time", Alternative, Number(TIME))];

const AT_EVENT: [Row; 2] =
    [("/sensitivities/of/0/at/event", Alternative, Text), ("/sensitivities/of/0/at/side", Optional, Name)];

const OF_SITE: [Row; 3] = [
    ("/sensitivities/of/0/site", Alternative, TextOrObject),
    ("/sensitivities/of/0/site/longitude", Required, Angle(TURN)),
    ("/sensitivities/of/0/site/geodetic_latitude", Required, Angle(QUARTER)),
];

const OFFSET: [Row; 6] = [
    ("/dispersions", Optional, Objects),
    ("/dispersions/0/pointer", Required, TextOrTexts),
    ("/dispersions/0/offset", Alternative, Object),
    ("/dispersions/0/offset/type", Required, Name),
    ("/dispersions/0/offset/mean", Optional, Number(between(-1e25, 1e25))),
    ("/dispersions/0/offset/standard_deviation", Required, Number(between(0.0, 1e25))),
];

const FACTOR: [Row; 3] = [
    ("/dispersions/0/factor", Alternative, Object),
    ("/dispersions/0/factor/mean", Optional, Numbers),
    ("/dispersions/0/factor/covariance", Required, Matrix),
];

/// A number that varies.
const VARY: [Row; 6] = [
    ("/pointer", Required, Text),
    ("/between", Required, Numbers),
    ("/scale", Optional, Number(POSITIVE)),
    ("/also", Optional, Objects),
    ("/also/0/pointer", Required, Text),
    ("/also/0/factor", Optional, Number(FINITE)),
];

/// What limits and goals have in common: on quantities at moments, near a site, and of ends.
const REQUIREMENTS: [Row; 14] = [
    ("/0/quantity", Alternative, Name),
    ("/0/at", Optional, NameOrObject),
    ("/0/at_most", Alternative, Number(FINITE)),
    ("/1/quantity", Alternative, Name),
    ("/1/at/event", Alternative, Text),
    ("/1/at/side", Optional, Name),
    ("/1/at_least", Alternative, Number(FINITE)),
    ("/2/at/time", Alternative, Number(TIME)),
    ("/2/between", Alternative, Numbers),
    ("/3/site", Alternative, TextOrObject),
    ("/3/site/longitude", Required, Angle(TURN)),
    ("/3/site/geodetic_latitude", Required, Angle(QUARTER)),
    ("/4/termination", Alternative, Names),
    ("/1/at", Optional, NameOrObject),
];

/// What only limits have.
const LIMITS: [Row; 1] = [("/3/within", Required, Number(POSITIVE))];

/// What only those of a corridor have.
const LIMITS_OF_CORRIDORS: [Row; 1] = [("/0/with", Optional, Object)];

/// What only goals have.
const GOALS: [Row; 4] = [
    ("/3/within", Optional, Number(POSITIVE)),
    ("/3/tolerance", Optional, Number(POSITIVE)),
    ("/5/equals", Alternative, Number(FINITE)),
    ("/5/tolerance", Optional, Number(POSITIVE)),
];

const SEARCH: [Row; 5] = [
    ("", Optional, Object),
    ("/starts", Optional, Whole),
    ("/solutions", Optional, Whole),
    ("/flights", Optional, Whole),
    ("/record", Optional, Boolean),
];

/// The fields of a search, by the place.
type Places = [(&'static str, &'static [Row]); 5];

/// What a corridor has beside its case.
const OF_CORRIDORS: Places = [
    ("", &[("/vary", Required, Object), ("/limits", Required, Objects), ("/resolution", Optional, Number(POSITIVE))]),
    ("/vary", &VARY),
    ("/limits", &REQUIREMENTS),
    ("/limits", &LIMITS),
    ("/limits", &LIMITS_OF_CORRIDORS),
];

/// The same of a footprint.
const OF_FOOTPRINTS: Places = [
    ("", &[("/vary", Required, Objects), ("/limits", Optional, Objects), ("/resolution", Optional, Number(POSITIVE))]),
    ("/vary/0", &VARY),
    ("/limits", &REQUIREMENTS),
    ("/limits", &LIMITS),
    ("/search", &[("", Optional, Object), ("/flights", Optional, Whole)]),
];

/// The same of a target.
const OF_TARGETS: Places = [
    ("", &[("/vary", Required, Objects), ("/achieve", Required, Objects)]),
    ("/vary/0", &VARY),
    ("/achieve", &REQUIREMENTS),
    ("/achieve", &GOALS),
    ("/search", &SEARCH),
];

/// What a condition may wait for, and the values that it may pass.
pub(crate) const QUANTITIES: [(&str, Kind); 22] = [
    ("time", Number(TIME)),
    ("altitude", Number(DISTANCE)),
    ("speed", Number(SPEED)),
    ("mach", Number(NOT_NEGATIVE)),
    ("dynamic_pressure", Number(NOT_NEGATIVE)),
    ("load_factor", Number(NOT_NEGATIVE)),
    ("flight_path_angle", Angle(QUARTER)),
    ("mass", Number(NOT_NEGATIVE)),
    ("air_speed", Number(SPEED)),
    ("inertial_speed", Number(SPEED)),
    ("specific_energy", Number(FINITE)),
    ("apoapsis_altitude", Number(DISTANCE)),
    ("periapsis_altitude", Number(DISTANCE)),
    ("eccentricity", Number(NOT_NEGATIVE)),
    ("inclination", Angle(HALF)),
    ("heat_flux", Number(NOT_NEGATIVE)),
    ("heat_load", Number(NOT_NEGATIVE)),
    ("wall_temperature", Number(NOT_NEGATIVE)),
    ("downrange", Number(DISTANCE)),
    ("ground_range", Number(LENGTH)),
    ("deceleration", Number(FINITE)),
    ("density", Number(NOT_NEGATIVE)),
];

const SOLVER: [Row; 2] =
    [("/solver/formulation", Optional, Name), ("/solver/relative_tolerance", Optional, Number(between(1e-14, 1e-3)))];

const PLANET_RELATIVE: [Row; 6] = [
    ("/altitude", Alternative, Number(DISTANCE)),
    ("/longitude", Required, Angle(TURN)),
    ("/geocentric_latitude", Required, Angle(QUARTER)),
    ("/speed", Required, Number(SPEED)),
    ("/flight_path_angle", Required, Angle(QUARTER)),
    ("/heading", Alternative, Angle(TURN)),
];

const GEODETIC: [Row; 6] = [
    ("/geodetic_altitude", Required, Number(DISTANCE)),
    ("/longitude", Required, Angle(TURN)),
    ("/geodetic_latitude", Required, Angle(QUARTER)),
    ("/speed", Required, Number(SPEED)),
    ("/flight_path_angle", Required, Angle(QUARTER)),
    ("/azimuth", Required, Angle(TURN)),
];

const VECTORS: [Row; 2] = [("/position", Required, Vector), ("/velocity", Required, Vector)];

const ORBITAL_ELEMENTS: [Row; 6] = [
    ("/semi_major_axis", Alternative, Number(FINITE)),
    ("/eccentricity", Required, Number(NOT_NEGATIVE)),
    ("/inclination", Required, Angle(HALF)),
    ("/raan", Required, Angle(TURN)),
    ("/argument_of_periapsis", Required, Angle(TURN)),
    ("/true_anomaly", Alternative, Angle(TURN)),
];

const INERTIAL_FLIGHT_PATH: [Row; 6] = [
    ("/altitude", Alternative, Number(DISTANCE)),
    ("/longitude", Required, Angle(TURN)),
    ("/geocentric_latitude", Required, Angle(QUARTER)),
    ("/inertial_speed", Required, Number(NOT_NEGATIVE)),
    ("/inertial_flight_path_angle", Required, Angle(QUARTER)),
    ("/inertial_heading", Alternative, Angle(TURN)),
];

/// What the second of two alternatives holds.
fn other_kind(name: &str) -> Kind {
    match name {
        "radius" => Number(RADIUS),
        "semi_latus_rectum" => Number(POSITIVE),
        _ => Angle(TURN),
    }
}

/// A good request of every search, and what it has beside its case.
fn searches() -> [(&'static str, Value, Places); 3] {
    [
        ("/corridor", corridor(limits()), OF_CORRIDORS),
        ("/footprint", footprint(limits_alone()), OF_FOOTPRINTS),
        ("/target", target(goals()), OF_TARGETS),
    ]
}

/// Every field of the requests, with every kind of state. Of searches those that are not of their case.
pub(crate) fn fields() -> Vec<Field> {
    let mut fields = Vec::new();
    let mut add = |path, request: &Value, place: &str, rows: &[Row]| {
        fields.extend(rows.iter().map(|(name, need, kind)| {
            let pointer = format!("{place}{name}");
            assert!(request.pointer(&pointer).is_some(), "the good request has no {pointer}");
            Field { path, request: request.clone(), pointer, need: *need, kind: *kind }
        }));
    };
    add("/simulate", &flight("ecef"), "", &SHARED);
    add("/simulate", &flight("ecef"), "", &CASE);
    add("/simulate", &flight("ecef"), "", &SOLVER);
    add("/convert", &conversion("ecef"), "", &SHARED);
    add("/analytic", &with(&flight("ecef"), "/solution", "loh"), "", &[("/solution", Required, Name)]);
    let named = |request| with(&request, "/planet", json!({"model": "earth_jameson_text"}));
    add("/simulate", &named(flight("eci")), "", &[("/planet/model", Optional, Name)]);
    add("/convert", &named(conversion("eci")), "", &[("/planet/model", Optional, Name)]);

    for (name, request) in models() {
        let (place, rows) = of_model(name);
        add("/simulate", &request, place, rows);
    }

    let normal = json!({"type": "normal", "mean": 1, "standard_deviation": 0.1});
    let covariance = json!([[0.1, 0], [0, 0.2]]);
    let several = json!({"type": "multivariate_normal", "mean": [1, 1], "covariance": covariance});
    let pointers = ["/vehicle/mass", "/density_factor"];
    for (asked, rows) in [
        (json!({"/sensitivities": {"of": [{"quantity": "speed", "at": "peak"}], "to": ["/vehicle/mass"]}}), &ASKED[..]),
        (json!({"/sensitivities": {"of": [{"quantity": "speed", "at": {"time": 0.5}}], "to": []}}), &AT_TIME),
        (
            json!({"/sensitivities": {"of": [{"quantity": "speed", "at": {"event": "first", "side": "after"}}], "to": []},
                "/events": [super::requests::named("first")]}),
            &AT_EVENT,
        ),
        (
            json!({"/sensitivities": {"of": [{"site": {"longitude": 0.7, "geodetic_latitude": -0.4}}], "to": []}}),
            &OF_SITE,
        ),
        (json!({"/dispersions": [{"pointer": "/vehicle/mass", "offset": normal}]}), &OFFSET),
        (json!({"/dispersions": [{"pointer": pointers, "factor": several}]}), &FACTOR),
    ] {
        let given = asked.as_object().unwrap();
        let request =
            given.iter().fold(flight("geodetic"), |request, (place, value)| with(&request, place, value.clone()));
        add("/simulate", &request, "", rows);
    }

    for (path, request, places) in searches() {
        for (place, rows) in places {
            add(path, &request, place, rows);
        }
    }

    for (quantity, kind) in QUANTITIES {
        // Time never falls.
        let ways: &[&str] = if quantity == "time" { &["rises_through"] } else { &["falls_through", "rises_through"] };
        for way in ways {
            for place in ["/events/0/when", "/stop/when/0"] {
                let heated = with(&model("events"), "/heating", json!({}));
                let request = with(&heated, place, condition(quantity, way, 1.0));
                add("/simulate", &request, &format!("{place}/"), &[(way, Alternative, kind)]);
            }
        }
    }

    for kind in KINDS {
        for (path, request, state) in
            [("/simulate", flight(kind), "/initial_state"), ("/convert", conversion(kind), "/state")]
        {
            add(path, &request, state, &[("", Required, Object), ("/type", Required, Name)]);
            // On a custom planet an epoch asks inertial states for the time.
            let inertial = ["eci", "orbital_elements"].contains(&kind);
            let timed = if inertial { named(request.clone()) } else { request.clone() };
            add(path, &timed, state, &[("/sidereal_time", Optional, SiderealTime)]);
            let turned =
                with(&without(&timed, &format!("{state}/sidereal_time")), &format!("{state}/sidereal_angle"), 0.3);
            add(path, &turned, state, &[("/sidereal_angle", Optional, Angle(TURN))]);
            if inertial {
                add(path, &request, state, &[("/frame", Optional, Name)]);
            }
            let rows: &[Row] = match kind {
                "planet_relative" => &PLANET_RELATIVE,
                "geodetic" => &GEODETIC,
                "orbital_elements" => &ORBITAL_ELEMENTS,
                "inertial_flight_path" => &INERTIAL_FLIGHT_PATH,
                _ => &VECTORS,
            };
            add(path, &request, state, rows);
            for (_, given, other, value) in ALTERNATIVES.into_iter().filter(|(of, ..)| *of == kind) {
                let request = without(&request, &format!("{state}/{given}"));
                let request = with(&request, &format!("{state}/{other}"), value);
                add(path, &request, &format!("{state}/"), &[(other, Alternative, other_kind(other))]);
            }
        }
    }
    for (name, value, kind) in [
        ("/samples_per_step", json!(2), Whole),
        ("/interval", json!(0.5), Number(POSITIVE)),
        ("/count", json!(3), Whole),
        ("/times", json!([0.2, 0.4]), Numbers),
        ("/trajectory", json!(false), False),
    ] {
        let request = with(&with(&flight("geodetic"), "/output", json!({})), &format!("/output{name}"), value);
        add("/simulate", &request, "/output", &[(name, Alternative, kind)]);
    }
    fields
}

impl Kind {
    /// Values of types that the field does not hold.
    pub(crate) fn mistyped(self) -> Vec<Value> {
        let mut wrong = if matches!(self, NumberOrNull(_)) { vec![] } else { vec![json!(null)] };
        let number = matches!(
            self,
            Number(_) | NumberOrNull(_) | NumberOrNumbers(_) | Angle(_) | Command(_) | Whole | SiderealTime
        );
        if !number {
            wrong.push(json!(13));
        }
        if !matches!(self, Text | TextOrTexts) {
            wrong.extend([json!("13"), json!("")]);
        }
        if !matches!(self, Boolean | BooleanOrObject) {
            wrong.push(json!(true));
        }
        if !matches!(self, Boolean | BooleanOrObject | False) {
            wrong.push(json!(false));
        }
        if !matches!(self, Vector | Numbers | NumberOrNumbers(_) | Matrix | Names | Texts | TextOrTexts | Objects) {
            wrong.push(json!([1, 2, 3]));
        }
        if !matches!(self, Object | Command(_) | Thrust | NameOrObject | TextOrObject | BooleanOrObject) {
            wrong.push(json!({"value": 1}));
        }
        wrong
    }
}

impl Range {
    /// The values just outside the range.
    pub(crate) fn beyond(self) -> Vec<f64> {
        let below = match self.low {
            Closed(limit) => Some(limit.next_down()),
            Open(limit) => Some(limit),
            Unlimited => None,
        };
        let above = match self.high {
            Closed(limit) => Some(limit.next_up()),
            Open(limit) => Some(limit),
            Unlimited => None,
        };
        below.into_iter().chain(above).collect()
    }

    /// The first and the last value in the range.
    pub(crate) fn ends(self) -> [f64; 2] {
        let least = match self.low {
            Closed(limit) => limit,
            Open(limit) => limit.next_up(),
            Unlimited => f64::MIN,
        };
        let greatest = match self.high {
            Closed(limit) => limit,
            Open(limit) => limit.next_down(),
            Unlimited => f64::MAX,
        };
        [least, greatest]
    }

    /// The same range of an angle in degrees.
    pub(crate) fn in_degrees(self) -> Self {
        let degrees = |limit| match limit {
            // The limits are quarter turns.
            Closed(limit) => Closed((limit / FRAC_PI_2).round() * 90.0),
            other => other,
        };
        Self { low: degrees(self.low), high: degrees(self.high) }
    }
}
