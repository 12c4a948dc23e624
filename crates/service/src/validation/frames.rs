//! Coordinates, orbital elements and the rotation of the Earth beside those of other programs: of every table the greatest deviation.

use reentry::elementary::{sin, sin_cos};
use serde_json::{Value, json};

use super::cases::{self, apart, number, parsed};
use super::{Check, Expected, Group, Origin};
use crate::wire::AngleUnit;

pub(super) fn checks() -> Vec<Check> {
    [places(), orbits(), epochs()].concat()
}

fn places() -> Vec<Check> {
    let origin = Origin {
        group: Group::Frames,
        case: "25 geodetic places".to_owned(),
        source: "pymap3d 3.2.0 and pyerfa 2.0.1.5, which agree to 1e-8 m".to_owned(),
        note: "The largest deviation. Allowed: 1 µm, a few rounding errors of the distance from the centre, and the \
               same on the ground."
            .to_owned(),
    };
    let metres = Expected::within(0.0, 1e-6).rounding(1e-7);
    let degrees = Expected::within(0.0, 1e-11).rounding(1e-12);
    let quantities = [
        ("planet-fixed position", "m", metres),
        ("geodetic altitude", "m", metres),
        ("geodetic latitude", "°", degrees),
    ];
    against(&origin, &quantities, greatest(cases::GEODETIC, place))
}

/// From geodetic coordinates to the planet-fixed position, and back: how far each is off.
fn place(row: &[f64]) -> [f64; 3] {
    let [latitude, longitude, altitude, x, y, z] = *row else { return [f64::NAN; 3] };
    let there = convert(&json!({"type": "geodetic", "geodetic_altitude": altitude, "longitude": longitude,
        "geodetic_latitude": latitude, "speed": 0, "flight_path_angle": 0, "azimuth": 0}));
    let back = convert(&json!({"type": "ecef", "position": [x, y, z], "velocity": [0, 0, 0]}));
    [
        apart(vector(&there["ecef"]["position"]), [x, y, z]),
        number(&back, "/geodetic/geodetic_altitude") - altitude,
        number(&back, "/geodetic/geodetic_latitude") - latitude,
    ]
}

fn orbits() -> Vec<Check> {
    let origin = Origin {
        group: Group::Frames,
        case: "25 orbits".to_owned(),
        source: "hapsira 0.18.0".to_owned(),
        note: "The largest deviation; angles in the orbit are weighted by how well inclination and eccentricity \
               define the node and the periapsis from which they are measured. Allowed: 1e-12, some hundred rounding \
               errors."
            .to_owned(),
    };
    let part = Expected::within(0.0, 1e-12).rounding(1e-13);
    let degrees = Expected::within(0.0, 1e-10).rounding(1e-11);
    let quantities = [
        ("inertial position, relative", "", part),
        ("inertial velocity, relative", "", part),
        ("semi-latus rectum, relative", "", part),
        ("eccentricity", "", part),
        ("inclination", "°", degrees),
        ("node, argument and anomaly", "°", degrees),
    ];
    against(&origin, &quantities, greatest(cases::ELEMENTS, orbit))
}

/// From orbital elements to the inertial state, and back: how far each is off.
fn orbit(row: &[f64]) -> [f64; 6] {
    let [_, p, e, inclination, raan, argument, anomaly, x, y, z, u, v, w, _] = *row else { return [f64::NAN; 6] };
    let [p, x, y, z, u, v, w] = [p, x, y, z, u, v, w].map(|kilometres| kilometres * 1e3);
    let there = convert(&json!({"type": "orbital_elements", "semi_latus_rectum": p, "eccentricity": e,
        "inclination": inclination, "raan": raan, "argument_of_periapsis": argument, "true_anomaly": anomaly}));
    let back = convert(&json!({"type": "eci", "position": [x, y, z], "velocity": [u, v, w]}));
    let relative = |name: &str, known| apart(vector(&there["eci"][name]), known) / apart(known, [0.0; 3]);
    let off = |name: &str, known: f64| number(&back["orbital_elements"], name) - known;
    let turned = |angle: f64| angle - 360.0 * (angle / 360.0).round();
    // The node is as good as the inclination defines it, the periapsis as good as the eccentricity and the node.
    let node = sin(AngleUnit::Deg.to_radians(inclination));
    let periapsis = 1.0 / (1.0 / node + 1.0 / e);
    let angles =
        [("/raan", raan, node), ("/argument_of_periapsis", argument, periapsis), ("/true_anomaly", anomaly, periapsis)];
    [
        relative("position", [x, y, z]),
        relative("velocity", [u, v, w]),
        number(&back, "/derived/semi_latus_rectum") / p - 1.0,
        off("/eccentricity", e),
        off("/inclination", inclination),
        angles.map(|(name, known, defined)| turned(off(name, known)).abs() * defined).into_iter().fold(0.0, greater),
    ]
}

fn epochs() -> Vec<Check> {
    let origin = Origin {
        group: Group::Frames,
        case: "106 epochs from 1900 to 2100".to_owned(),
        source: "pyerfa 2.0.1.5: c2t06a and gmst82, without polar motion and with UT1 = UTC".to_owned(),
        note: "The largest deviation, of places on the equator and at the pole. Allowed: 10 m, for the omitted terms \
               of the nutation."
            .to_owned(),
    };
    let metres = Expected::within(0.0, 10.0).rounding(1e-3);
    let quantities = [("place in GCRF, on the surface", "m", metres), ("place in TEME, on the surface", "m", metres)];
    let rows = cases::rows(cases::EARTH_ROTATION).map(|row| epoch(&row));
    let got = rows.fold([0.0; 2], |greatest, row| std::array::from_fn(|i| greater(greatest[i], row[i])));
    against(&origin, &quantities, got)
}

/// From a celestial frame to the planet-fixed one: how far the ends of the axes are off at most, in GCRF and in TEME.
fn epoch(row: &[&str]) -> [f64; 2] {
    let [utc, _, sidereal_time, of_gcrf @ ..] = row else { return [f64::NAN; 2] };
    let of_gcrf: Vec<_> = of_gcrf.iter().map(|field| parsed(field)).collect();
    let (sine, cosine) = sin_cos(parsed(sidereal_time));
    let of_teme = [cosine, sine, 0.0, -sine, cosine, 0.0, 0.0, 0.0, 1.0];
    [("gcrf", &of_gcrf[..]), ("teme", &of_teme[..])].map(|(frame, rotation)| {
        let off = (0..3).map(|axis| {
            let mut position = [0.0; 3];
            position[axis] = SURFACE;
            let state = json!({"type": "eci", "frame": frame, "position": position, "velocity": [0, 0, 0]});
            let answer = super::convert(json!({"epoch": utc, "state": state}));
            let known = [0, 1, 2].map(|i| rotation.get(3 * i + axis).map_or(f64::NAN, |part| part * SURFACE));
            apart(vector(&answer["ecef"]["position"]), known)
        });
        off.fold(0.0, greater)
    })
}

/// The equatorial radius of the Earth, m.
const SURFACE: f64 = 6_378_137.0;

fn convert(state: &Value) -> Value {
    super::convert(json!({"angle_unit": "deg", "state": state}))
}

/// Of the deviations of all rows of a table the greatest of each.
fn greatest<const N: usize>(table: &str, deviations: impl Fn(&[f64]) -> [f64; N]) -> [f64; N] {
    // The name of an orbit is no number, and nothing is made of it.
    let rows = cases::rows(table).map(|row| deviations(&row.into_iter().map(parsed).collect::<Vec<_>>()));
    rows.fold([0.0; N], |greatest, row| std::array::from_fn(|i| greater(greatest[i], row[i].abs())))
}

/// The greater of two numbers, and no number if one is none.
fn greater(a: f64, b: f64) -> f64 {
    if a.is_nan() || a > b { a } else { b }
}

fn against<const N: usize>(origin: &Origin, quantities: &[(&str, &str, Expected); N], got: [f64; N]) -> Vec<Check> {
    let checks = quantities.iter().zip(got);
    checks.map(|((quantity, unit, expected), got)| origin.check(*quantity, unit, *expected, got)).collect()
}

fn vector(value: &Value) -> [f64; 3] {
    [0, 1, 2].map(|i| value[i].as_f64().unwrap_or(f64::NAN))
}
