//! The coordinate systems against independent programs, against the thesis, and there and back.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use nalgebra::{Matrix3, Rotation3, Vector3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use reentry::Planet;
use reentry::coordinates::{
    FlightPath, Geodetic, Inertial, InertialFlightPath, NoElements, OrbitShape, OrbitalElements, PlanetFixed,
    earth_rotation_angle, gcrf_to_planet_fixed, greenwich_mean_sidereal_time, latitude_and_altitude,
    teme_to_planet_fixed, true_anomaly,
};
use reentry::planet::Shape;
use reentry_service::validation::cases::{EARTH_ROTATION, ELEMENTS, GEODETIC, rows};
use reentry_service::wire::epoch::Epoch;

use crate::check::{angle, near, relative};

const WGS84: Planet = Planet::EARTH_WGS84;
const MU: f64 = 3.986_004_418e14;

fn numbers(row: &[&str]) -> Vec<f64> {
    row.iter().map(|field| field.parse().unwrap()).collect()
}

#[test]
fn geodetic_coordinates_agree_with_pymap3d_and_erfa() {
    let rows: Vec<_> = rows(GEODETIC).collect();
    assert_eq!(rows.len(), 25);
    for row in rows {
        let row = numbers(&row);
        let [latitude, longitude, altitude] = [row[0].to_radians(), row[1].to_radians(), row[2]];
        let position = Vector3::new(row[3], row[4], row[5]);
        let what = format!("{row:?}");

        let state = Geodetic {
            geodetic_altitude: altitude,
            longitude,
            geodetic_latitude: latitude,
            speed: 0.0,
            flight_path_angle: 0.0,
            azimuth: 0.0,
        };
        // Three roundings of the radius.
        let found = state.to_planet_fixed(&WGS84.shape).position;
        near(&what, (found - position).norm(), 0.0, 4.0 * f64::EPSILON * position.norm());
        let (back_latitude, back_altitude) = latitude_and_altitude(&position, &WGS84.shape);
        angle(&what, back_latitude, latitude, 1e-15 * TAU);
        near(&what, back_altitude, altitude, 4.0 * f64::EPSILON * position.norm());
    }
}

#[test]
fn elements_agree_with_hapsira() {
    let rows: Vec<_> = rows(ELEMENTS).collect();
    assert_eq!(rows.len(), 25);
    for row in rows {
        let what = row[0];
        let row = numbers(&row[1..]);
        let elements = OrbitalElements {
            shape: OrbitShape::SemiLatusRectum(row[0] * 1e3),
            eccentricity: row[1],
            inclination: row[2].to_radians(),
            raan: row[3].to_radians(),
            argument_of_periapsis: row[4].to_radians(),
            true_anomaly: row[5].to_radians(),
        };
        let [position, velocity] = [6, 9].map(|at| Vector3::new(row[at], row[at + 1], row[at + 2]) * 1e3);
        let state = elements.to_inertial(MU);
        near(what, (state.position - position).norm(), 0.0, 1e-14 * position.norm());
        near(what, (state.velocity - velocity).norm(), 0.0, 1e-14 * velocity.norm());

        let (back, undefined) = OrbitalElements::from_inertial(&Inertial { position, velocity }, MU).unwrap();
        relative(what, back.semi_latus_rectum(), row[0] * 1e3, 1e-13);
        near(what, back.eccentricity, row[1], 1e-14);
        near(what, back.inclination, row[2].to_radians(), 1e-14);
        // An angle in the orbit is as good as what defines it: the node by the inclination, the periapsis by the eccentricity.
        let node = if undefined.equatorial { f64::INFINITY } else { 1e-14 / row[2].to_radians().sin() };
        let periapsis = if undefined.circular { f64::INFINITY } else { 1e-14 / row[1] + node };
        angle(what, back.raan, row[3].to_radians(), node.min(TAU));
        angle(what, back.argument_of_periapsis, row[4].to_radians(), periapsis.min(TAU));
        angle(what, back.true_anomaly, row[5].to_radians(), periapsis.min(TAU));
        assert_eq!(undefined.circular, row[1] == 0.0, "{what}");
        assert_eq!(undefined.equatorial, row[2] % 180.0 == 0.0, "{what}");
    }
}

#[test]
fn undefined_elements_take_the_values_of_the_conventions() {
    let elements = |eccentricity, inclination, raan, argument_of_periapsis, true_anomaly| {
        let shape = OrbitShape::SemiLatusRectum(7e6);
        let elements = OrbitalElements { shape, eccentricity, inclination, raan, argument_of_periapsis, true_anomaly };
        OrbitalElements::from_inertial(&elements.to_inertial(MU), MU).unwrap().0
    };
    // Circular: the anomaly counts from the node.
    let circular = elements(0.0, 0.9, 2.0, 0.5, 0.25);
    assert!(circular.argument_of_periapsis.abs() < 1e-15);
    angle("node", circular.raan, 2.0, 1e-14);
    angle("anomaly from the node", circular.true_anomaly, 0.75, 1e-14);
    // Equatorial: the argument counts from the x axis, in the direction of motion.
    let equatorial = elements(0.1, 0.0, 2.0, 0.5, 0.25);
    assert!(equatorial.raan.abs() < 1e-15);
    angle("argument from x", equatorial.argument_of_periapsis, 2.5, 1e-14);
    let retrograde = elements(0.1, PI, 2.0, 0.5, 0.25);
    assert!(retrograde.raan.abs() < 1e-15);
    angle("argument from x against the turn of the planet", retrograde.argument_of_periapsis, 0.5 - 2.0, 1e-13);
    // Both: the true longitude.
    let both = elements(0.0, 0.0, 2.0, 0.5, 0.25);
    assert!(both.argument_of_periapsis.abs() < 1e-15);
    angle("true longitude", both.true_anomaly, 2.75, 1e-14);
}

#[test]
fn rectilinear_motion_has_no_elements() {
    let position = Vector3::new(7e6, 1e6, -2e6);
    for velocity in [Vector3::zeros(), position * -1e-4, position * 3e-3] {
        assert_eq!(OrbitalElements::from_inertial(&Inertial { position, velocity }, MU).unwrap_err(), NoElements);
    }
}

/// Jameson 2006, equations 69 to 73, with (1-e)² in equation 71: an approximation of the geodetic latitude, exact on the surface.
#[test]
fn the_thesis_approximates_the_geodetic_latitude_to_a_nanoradian() {
    let (a, b) = WGS84.shape.semi_axes();
    let e = 1.0 - b / a;
    let mut worst: f64 = 0.0;
    for step in -89..=89 {
        for altitude in [0.0, 1e4, 1e5, 6e5] {
            let phi = f64::from(step).to_radians();
            let (sin_phi, cos_phi) = phi.sin_cos();
            let radius = WGS84.shape.surface_radius(sin_phi, cos_phi) + altitude;
            let surface_latitude = (phi.tan() / (1.0 - e).powi(2)).atan();
            let difference = surface_latitude - phi;
            let curvature =
                a * (1.0 - e).powi(2) / (1.0 - (2.0 * e - e * e) * surface_latitude.sin().powi(2)).powf(1.5);
            let correction = (altitude * difference.sin() / (curvature + altitude)).atan();
            let approximate = surface_latitude - correction;

            let position = Vector3::new(radius * cos_phi, 0.0, radius * sin_phi);
            let (exact, _) = latitude_and_altitude(&position, &WGS84.shape);
            worst = worst.max((approximate - exact).abs());
            if altitude == 0.0 {
                near("on the surface it is exact", approximate, exact, 1e-15 * TAU);
            }
        }
    }
    assert!((1e-10..1e-9).contains(&worst), "{worst:e} rad at up to 600 km");
}

#[test]
fn the_earth_rotation_angle_is_that_of_the_iers_conventions() {
    // IERS Conventions 2010, equation 5.15, at the epoch: 2π 0.7790572732640 = 280.46061837504 degrees.
    near("at J2000", earth_rotation_angle(0.0).to_degrees(), 280.460_618_375_04, 1e-11);
    // A sidereal day later it is the same, and a solar day later 360.98561228... degrees on.
    let sidereal_day = 1.0 / (1.0 + 0.002_737_811_911_354_48);
    angle("a sidereal day later", earth_rotation_angle(sidereal_day), earth_rotation_angle(0.0), 1e-12);
    let day = earth_rotation_angle(1.0) - earth_rotation_angle(0.0);
    near("a day later", day.to_degrees(), 0.985_612_288_087_612_8, 1e-11);
    // Seconds still count after 27 years: 1 s turns it by 7.2921e-5 rad.
    let second = earth_rotation_angle(9_800.5 + 1.0 / 86_400.0) - earth_rotation_angle(9_800.5);
    near("a second", second, 7.292_115_146_7e-5, 1e-10);
}

/// How far two rotations put a place on the equator apart at most, m.
fn apart_on_the_ground(a: &Matrix3<f64>, b: &Matrix3<f64>) -> f64 {
    // A rotation by a small angle differs from none by √2 times the angle, in the norm of all its entries.
    (a - b).norm() / 2_f64.sqrt() * WGS84.equatorial_radius()
}

#[test]
fn the_earth_is_turned_as_erfa_turns_it() {
    let rows: Vec<_> = rows(EARTH_ROTATION).collect();
    assert_eq!(rows.len(), 71 + 33 + 2);
    let mut worst = [0.0_f64; 3];
    for row in rows {
        let (utc, row) = (row[0], numbers(&row[1..]));
        let days = Epoch::read(&serde_json::json!(utc)).unwrap().days();
        near(utc, days, row[0], 1e-11);
        angle(utc, greenwich_mean_sidereal_time(days), row[1], 1e-10);

        let [of_gcrf, teme_to_j2000] = [2, 11].map(|at| Matrix3::from_row_slice(&row[at..at + 9]));
        let teme = Rotation3::from_axis_angle(&Vector3::z_axis(), -row[1]);
        let [our_gcrf, our_teme] = [gcrf_to_planet_fixed(days), teme_to_planet_fixed(days)].map(|turn| *turn.matrix());
        let off = [
            apart_on_the_ground(&our_gcrf, &of_gcrf),
            apart_on_the_ground(&our_teme, teme.matrix()),
            // The way round by the equation of the equinoxes, the nutation of 1980 and the precession of 1976.
            apart_on_the_ground(&(our_gcrf * teme_to_j2000), &our_teme),
        ];
        for (worst, off) in worst.iter_mut().zip(off) {
            *worst = worst.max(off);
        }
    }
    // The terms of the nutation that are left out; roundings of the table and of the days; the theories of 1976 to 1982 beside those of
    // 2000 and 2006.
    let allowed = [1.5, 1e-3, 6.0];
    assert!(worst.iter().zip(allowed).all(|(worst, allowed)| *worst < allowed), "{worst:?} m, {allowed:?} are allowed");
    assert!(allowed.iter().all(|allowed| *allowed < 10.0), "10 m are promised");
}

/// A satellite in four frames, as published: D. A. Vallado et al., Revisiting Spacetrack Report #3, AIAA 2006-6753, appendix C; and, in
/// GCRF, Vallado, Fundamentals of Astrodynamics and Applications, 4th ed. 2013, example 3-14. Its UT1 is 0.4399619 s behind UTC.
#[test]
fn a_published_satellite_is_where_it_was() {
    let utc = Epoch::read(&serde_json::json!("2004-04-06T07:51:28.386009Z")).unwrap();
    let ut1 = utc.days() - 0.439_961_9 / 86_400.0;
    let kilometres = |x: f64, y: f64, z: f64| Vector3::new(x, y, z) * 1e3;
    let teme = Inertial {
        position: kilometres(5_094.180_162_10, 6_127.644_659_50, 6_380.344_532_70),
        velocity: kilometres(-4.746_131_487, 0.785_818_041, 5.531_931_288),
    };
    let gcrf = Inertial {
        position: kilometres(5_102.508_957_80, 6_123.011_400_70, 6_378.136_928_20),
        velocity: kilometres(-4.743_220_157_0, 0.790_536_497_0, 5.533_755_727_0),
    };
    // The pseudo-Earth-fixed frame: without polar motion.
    let position = kilometres(-1_033.475_031_30, 7_901.305_585_60, 6_380.344_532_70);
    let velocity = kilometres(-3.225_632_747_0, -2.872_442_511_0, 5.531_931_288_0);
    for (what, state, turn, tolerance) in [
        ("teme", teme, teme_to_planet_fixed(ut1), 0.01),
        // 0.05" at 10 200 km.
        ("gcrf", gcrf, gcrf_to_planet_fixed(ut1), 2.5),
    ] {
        let found = state.to_planet_fixed_by(&WGS84, &turn);
        near(what, (found.position - position).norm(), 0.0, tolerance);
        near(what, (found.velocity - velocity).norm(), 0.0, 1e-3 * tolerance.max(0.1));
        let back = Inertial::from_planet_fixed_by(&found, &WGS84, &turn);
        near(what, (back.position - state.position).norm(), 0.0, 1e-14 * 1e7);
        near(what, (back.velocity - state.velocity).norm(), 0.0, 1e-14 * 1e4);
    }
}

/// Kepler's equation by bisection: E - e sin E grows with E.
fn eccentric_by_bisection(mean: f64, e: f64) -> f64 {
    let (mut low, mut high) = (0.0, PI);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        // E - sin E without the loss of digits at small E.
        let less = if middle < 0.1 {
            middle.powi(3) / 6.0 - middle.powi(5) / 120.0 + middle.powi(7) / 5040.0 - middle.powi(9) / 362_880.0
        } else {
            middle - middle.sin()
        };
        if (1.0 - e) * middle + e * less < mean { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

#[test]
fn keplers_equation_is_solved_up_to_the_parabola() {
    let eccentricities = [0.0, 1e-300, 1e-9, 0.1, 0.5, 0.9, 0.99, 1.0 - 1e-6, 1.0 - 1e-12, 1.0_f64.next_down()];
    let means = [0.0, 1e-300, 1e-30, 1e-12, 1e-6, 1e-3, 0.1, 1.0, 2.0, 3.0, PI.next_down(), PI];
    for e in eccentricities {
        for mean in means {
            let what = format!("e = {e:e}, M = {mean:e}");
            let found = true_anomaly(mean, e);
            let eccentric = eccentric_by_bisection(mean, e);
            let expected =
                2.0 * ((1.0 + e).sqrt() * (eccentric / 2.0).sin()).atan2((1.0 - e).sqrt() * (eccentric / 2.0).cos());
            // ν as a function of E has a slope of up to √((1+e)/(1-e)) at the periapsis and at the apoapsis its inverse; where 1 - e is a
            // rounding, the half turn is passed within a few roundings of M.
            near(&what, found, expected, 1e-14 * expected.max(1e-300) + 1e-15);
            angle(&what, true_anomaly(-mean, e), -found, 0.0);
            for turns in [-TAU, TAU] {
                angle(&what, true_anomaly(mean + turns, e), found, 1e-15 * TAU + 1e-15 * slope(found, e));
            }
        }
    }
}

/// dν/dM = (1 + e cos ν)² / (1 - e²)^1.5.
fn slope(true_anomaly: f64, e: f64) -> f64 {
    (1.0 + e * true_anomaly.cos()).powi(2) / ((1.0 - e) * (1.0 + e)).powf(1.5)
}

fn place() -> impl Strategy<Value = (f64, f64, f64)> {
    let radius = prop_oneof![6.3e6..6.5e6, 1e3..6e6, 1e7..1e12];
    let latitude = prop_oneof![-FRAC_PI_2..FRAC_PI_2, Just(FRAC_PI_2), Just(-FRAC_PI_2), Just(0.0)];
    (radius, -PI..PI, latitude)
}

fn flight_path() -> impl Strategy<Value = FlightPath<f64>> {
    let gamma = prop_oneof![-FRAC_PI_2..FRAC_PI_2, Just(FRAC_PI_2), Just(-FRAC_PI_2), Just(0.0)];
    let speed = prop_oneof![1.0..2e4, Just(0.0), 1e-6..1.0];
    (place(), speed, gamma, -PI..PI).prop_map(|((radius, longitude, geocentric_latitude), speed, gamma, heading)| {
        FlightPath { radius, longitude, geocentric_latitude, speed, flight_path_angle: gamma, heading }
    })
}

/// The same numbers, of the inertial velocity.
fn inertially(state: FlightPath<f64>) -> InertialFlightPath {
    InertialFlightPath {
        radius: state.radius,
        longitude: state.longitude,
        geocentric_latitude: state.geocentric_latitude,
        inertial_speed: state.speed,
        inertial_flight_path_angle: state.flight_path_angle,
        inertial_heading: state.heading,
    }
}

#[track_caller]
fn same_state(what: &str, actual: &PlanetFixed<f64>, expected: &PlanetFixed<f64>, tolerance: f64) {
    near(what, (actual.position - expected.position).norm(), 0.0, tolerance * expected.position.norm());
    near(what, (actual.velocity - expected.velocity).norm(), 0.0, tolerance * expected.velocity.norm().max(1e-9));
}

fn shapes() -> impl Strategy<Value = Shape> {
    let ellipsoid = |polar_radius| Shape::Ellipsoid { equatorial_radius: 6.378e6, polar_radius };
    prop_oneof![
        Just(WGS84.shape),
        Just(Shape::Sphere { radius: 6.378e6 }),
        (1e6..6.378e6).prop_map(ellipsoid),
        (6.378e6..5e7).prop_map(ellipsoid),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default()
    })]

    #[test]
    fn flight_path_there_and_back(state in flight_path()) {
        let fixed = state.to_planet_fixed();
        let back = FlightPath::from_planet_fixed(&fixed);
        same_state("there and back", &back.to_planet_fixed(), &fixed, 1e-14);
        relative("radius", back.radius, state.radius, 1e-14);
        // Away from the vertical and the poles the angles themselves come back.
        if state.geocentric_latitude.cos() > 0.01 && state.flight_path_angle.cos() > 0.01 && state.speed > 0.0 {
            angle("longitude", back.longitude, state.longitude, 1e-13);
            angle("latitude", back.geocentric_latitude, state.geocentric_latitude, 1e-13);
            angle("flight-path angle", back.flight_path_angle, state.flight_path_angle, 1e-13);
            angle("heading", back.heading, state.heading, 1e-12);
        }
    }

    #[test]
    fn geodetic_there_and_back(state in flight_path(), shape in shapes()) {
        let fixed = state.to_planet_fixed();
        let geodetic = Geodetic::from_planet_fixed(&fixed, &shape);
        let back = geodetic.to_planet_fixed(&shape);
        // Near the centre the altitude is the difference of large numbers: it has the roundings of the semi-axes.
        let rounding = 4.0 * f64::EPSILON * (shape.semi_axes().0 + shape.semi_axes().1);
        near("position", (back.position - fixed.position).norm(), 0.0, 1e-13 * fixed.position.norm() + rounding);
        near("velocity", (back.velocity - fixed.velocity).norm(), 0.0, 1e-13 * fixed.velocity.norm());
        prop_assert!((0.0..TAU).contains(&geodetic.azimuth));
        prop_assert!(geodetic.geodetic_latitude.abs() <= FRAC_PI_2);
    }

    #[test]
    fn geodetic_foot_is_on_the_surface_and_nearest(state in flight_path(), shape in shapes()) {
        let position = state.to_planet_fixed().position;
        let (latitude, altitude) = latitude_and_altitude(&position, &shape);
        // The point of the surface below is the nearest: no other is nearer than |altitude|.
        for offset in [-1.0, -0.1, -0.01, 0.01, 0.1, 1.0] {
            let other = (latitude + offset).clamp(-FRAC_PI_2, FRAC_PI_2);
            let foot = Geodetic { geodetic_altitude: 0.0, longitude: state.longitude, geodetic_latitude: other,
                speed: 0.0, flight_path_angle: 0.0, azimuth: 0.0 };
            let distance = (foot.to_planet_fixed(&shape).position - position).norm();
            prop_assert!(distance >= altitude.abs() * (1.0 - 1e-9) - 1e-6, "{distance} is nearer than {altitude}");
        }
    }

    #[test]
    fn inertial_there_and_back(state in flight_path(), sidereal_time in -1e5..1e6) {
        let fixed = state.to_planet_fixed();
        let inertial = Inertial::from_planet_fixed(&fixed, &WGS84, sidereal_time);
        let back = inertial.to_planet_fixed(&WGS84, sidereal_time);
        near("position", (back.position - fixed.position).norm(), 0.0, 1e-14 * fixed.position.norm());
        // The velocity is a difference of the inertial one and that of the turning frame.
        near("velocity", (back.velocity - fixed.velocity).norm(), 0.0, 1e-14 * inertial.velocity.norm());
    }

    #[test]
    fn inertial_flight_path_there_and_back(state in flight_path()) {
        let fixed = inertially(state).to_planet_fixed(&WGS84);
        let back = InertialFlightPath::from_planet_fixed(&fixed, &WGS84);
        let again = back.to_planet_fixed(&WGS84);
        near("position", (again.position - fixed.position).norm(), 0.0, 1e-14 * fixed.position.norm());
        // Twice a sum of the velocity and that of the turning frame, in whose roundings a small one is lost.
        let rotation = WGS84.rotation_rate * state.radius;
        let rounding = 1e-14 * (state.speed + rotation);
        near("velocity", (again.velocity - fixed.velocity).norm(), 0.0, rounding);
        prop_assert!(-PI < back.longitude && back.longitude <= PI);
        prop_assert!(-PI < back.inertial_heading && back.inertial_heading <= PI);
        near("speed", back.inertial_speed, state.speed, rounding);
        // The angles are as good as the part of the velocity that they turn, and those of the place away from the poles.
        if state.geocentric_latitude.cos() > 0.01 && state.flight_path_angle.cos() > 0.01 && state.speed > 0.0 {
            let turned = 1e-12 + 100.0 * rounding / state.speed;
            angle("longitude", back.longitude, state.longitude, 1e-13);
            angle("latitude", back.geocentric_latitude, state.geocentric_latitude, 1e-13);
            angle("flight-path angle", back.inertial_flight_path_angle, state.flight_path_angle, turned.min(TAU));
            angle("heading", back.inertial_heading, state.heading, turned.min(TAU));
        }
    }

    /// The same components by the horizon of the inertial frame, where the place has the longitude θ + ωΔt.
    #[test]
    fn inertial_flight_path_is_that_of_the_inertial_vectors(state in flight_path(), sidereal_time in -1e5..1e5) {
        let turn = WGS84.rotation_rate * sidereal_time;
        let PlanetFixed { position, velocity } =
            FlightPath { longitude: state.longitude + turn, ..state }.to_planet_fixed();
        let by_vectors = Inertial { position, velocity }.to_planet_fixed(&WGS84, sidereal_time);
        let fixed = inertially(state).to_planet_fixed(&WGS84);
        near("position", (fixed.position - by_vectors.position).norm(), 0.0, 1e-14 * state.radius);
        let rounding = 1e-14 * (state.speed + WGS84.rotation_rate * state.radius);
        near("velocity", (fixed.velocity - by_vectors.velocity).norm(), 0.0, rounding);
        // There and back by way of the vectors: the speed is the length of the inertial velocity.
        let back = InertialFlightPath::from_planet_fixed(&by_vectors, &WGS84);
        near("speed", back.inertial_speed, velocity.norm(), rounding);
    }

    #[test]
    fn inertial_flight_path_is_the_flight_path_where_the_planet_does_not_rotate(state in flight_path()) {
        let at_rest = Planet { rotation_rate: 0.0, ..WGS84 };
        let fixed = inertially(state).to_planet_fixed(&at_rest);
        prop_assert_eq!(fixed, state.to_planet_fixed());
        let expected = FlightPath::from_planet_fixed(&fixed).wrapped();
        let back = InertialFlightPath::from_planet_fixed(&fixed, &at_rest);
        prop_assert_eq!(back, inertially(expected));
    }

    #[test]
    fn mean_anomaly_there_and_back(
        mean in 0.0..TAU,
        e in prop_oneof![0.0..1.0, 0.99..1.0, (0.0..11.0).prop_map(|digits: f64| 1.0 - 10_f64.powf(-digits))],
    ) {
        let elements = OrbitalElements {
            shape: OrbitShape::SemiLatusRectum(7e6),
            eccentricity: e,
            inclination: 1.0,
            raan: 2.0,
            argument_of_periapsis: 3.0,
            true_anomaly: true_anomaly(mean, e),
        };
        // A rounding of ν is one of M, by the inverse of the slope, and so is that of M itself.
        let rounding = 1e-14 + 4.0 * f64::EPSILON / slope(elements.true_anomaly, e);
        angle("mean anomaly", elements.mean_anomaly().unwrap(), mean, rounding);
        // Kepler's law by the state itself: r v sin γ = e √(GM a) sin E, with E from the radius, M = E - e sin E.
        let Inertial { position, velocity } = elements.to_inertial(MU);
        if e > 0.01 && e < 0.999 {
            let a = elements.semi_latus_rectum() / (1.0 - e * e);
            let e_sin = position.dot(&velocity) / (MU * a).sqrt();
            let eccentric = e_sin.atan2(1.0 - position.norm() / a);
            // The radius keeps 1e-15 of itself, which counts as much more where e is small.
            angle("by the radius", eccentric - e_sin, mean, 1e-13 / e / (1.0 - e));
        }
    }

    #[test]
    fn elements_there_and_back(
        size in 6.6e6..1e8,
        eccentricity in prop_oneof![0.0..3.0, Just(0.0), Just(1.0), 0.999..1.001, 0.0..1e-9],
        inclination in prop_oneof![0.0..PI, Just(0.0), Just(PI), Just(FRAC_PI_2), 0.0..1e-9],
        angles in [0.0..TAU, 0.0..TAU, -2.0..2.0],
    ) {
        let [raan, argument_of_periapsis, true_anomaly] = angles;
        let shape = OrbitShape::SemiLatusRectum(size);
        let elements =
            OrbitalElements { shape, eccentricity, inclination, raan, argument_of_periapsis, true_anomaly };
        prop_assume!(1.0 + eccentricity * true_anomaly.cos() > 0.01);
        let state = elements.to_inertial(MU);
        let (back, _) = OrbitalElements::from_inertial(&state, MU).unwrap();
        let again = back.to_inertial(MU);
        // A convention costs up to 1e-12 of the state, and two may meet in a circular equatorial orbit; near the asymptote
        // the radius p / (1 + e cos ν) magnifies a rounding of ν.
        let magnified = 3e-12 / (1.0 + eccentricity * true_anomaly.cos()).min(1.0);
        near("position", (again.position - state.position).norm(), 0.0, magnified * state.position.norm());
        near("velocity", (again.velocity - state.velocity).norm(), 0.0, magnified * state.velocity.norm());
        for wrapped in [back.raan, back.argument_of_periapsis, back.true_anomaly] {
            prop_assert!((0.0..TAU).contains(&wrapped));
        }
    }
}

#[test]
fn the_angles_of_a_zero_velocity_are_zero_whatever_the_signs_of_its_zeros() {
    for zero in [0.0, -0.0] {
        let position = Vector3::new(4e6, -3e6, 3e6);
        let state = PlanetFixed { position, velocity: Vector3::new(zero, -zero, zero) };
        let state = FlightPath::from_planet_fixed(&state);
        assert_eq!([state.speed, state.flight_path_angle, state.heading].map(f64::abs).map(f64::to_bits), [0; 3]);
    }
}

/// By the triangle of velocities, with the motion of the planet ωr cos φ to the east.
#[test]
fn the_planets_motion_is_taken_from_the_inertial_velocity() {
    let eastward = |latitude: f64| WGS84.rotation_rate * 6.5e6 * latitude.cos();
    for (latitude, speed, gamma, heading) in
        [(0.0, 7800.0, 0.0, 0.0), (0.0, 11_000.0, -0.113, 0.7), (-0.5, 7800.0, -0.02, 2.5), (1.2, 300.0, 0.5, -1.5)]
    {
        let state = FlightPath {
            radius: 6.5e6,
            longitude: 3.0,
            geocentric_latitude: latitude,
            speed,
            flight_path_angle: gamma,
            heading,
        };
        let relative = FlightPath::from_planet_fixed(&inertially(state).to_planet_fixed(&WGS84));
        let (up, level) = (speed * gamma.sin(), speed * gamma.cos());
        let [east, north] = [level * heading.cos() - eastward(latitude), level * heading.sin()];
        // Some roundings of velocities of 1e4 m/s.
        near("speed", relative.speed, (up * up + east * east + north * north).sqrt(), 1e-11);
        angle("flight-path angle", relative.flight_path_angle, up.atan2(east.hypot(north)), 1e-13);
        angle("heading", relative.heading, north.atan2(east), 1e-13);
    }
}

#[test]
fn inertial_angles_at_rest_on_the_planet_at_the_poles_and_straight_up() {
    // At rest on the planet it moves due east with it.
    for latitude in [0.0, 0.7, -1.3] {
        let at_rest = FlightPath {
            radius: 6.4e6,
            longitude: -2.0,
            geocentric_latitude: latitude,
            speed: 0.0,
            flight_path_angle: 0.0,
            heading: 0.0,
        };
        let state = InertialFlightPath::from_planet_fixed(&at_rest.to_planet_fixed(), &WGS84);
        // Some roundings of the horizon and of the product.
        relative("speed at rest", state.inertial_speed, WGS84.rotation_rate * 6.4e6 * latitude.cos(), 1e-14);
        near("angle at rest", state.inertial_flight_path_angle, 0.0, 1e-15);
        angle("heading at rest", state.inertial_heading, 0.0, 1e-15);
    }
    // The poles themselves stand still: inertial and relative velocity are one, at rest as well.
    for pole in [6.5e6, -6.5e6] {
        for velocity in [Vector3::new(3e3, -4e3, 100.0), Vector3::new(0.0, 0.0, -100.0), Vector3::zeros()] {
            let fixed = PlanetFixed { position: Vector3::new(0.0, 0.0, pole), velocity };
            let state = InertialFlightPath::from_planet_fixed(&fixed, &WGS84);
            assert_eq!(state, inertially(FlightPath::from_planet_fixed(&fixed).wrapped()));
            // The cosine of π/2 as a number is 6e-17: the place comes back 4e-10 m from the axis, with the motion there.
            let back = state.to_planet_fixed(&WGS84);
            near("position at a pole", (back.position - fixed.position).norm(), 0.0, 1e-9);
            near("velocity at a pole", (back.velocity - fixed.velocity).norm(), 0.0, 1e-12);
        }
    }
    // Inertially straight up or down, or at rest: to the west as the planet sees it.
    for (speed, gamma) in [(1000.0, FRAC_PI_2), (1000.0, -FRAC_PI_2), (0.0, 0.3)] {
        let vertical = InertialFlightPath {
            radius: 7e6,
            longitude: 0.0,
            geocentric_latitude: 0.0,
            inertial_speed: speed,
            inertial_flight_path_angle: gamma,
            inertial_heading: 2.0,
        };
        let fixed = vertical.to_planet_fixed(&WGS84);
        let expected = Vector3::new(speed * gamma.sin(), -WGS84.rotation_rate * 7e6, 0.0);
        near("vertical", (fixed.velocity - expected).norm(), 0.0, 1e-12);
        let back = InertialFlightPath::from_planet_fixed(&fixed, &WGS84);
        near("speed of the vertical", back.inertial_speed, speed, 1e-12);
        near("climb of the vertical", back.inertial_speed * back.inertial_flight_path_angle.sin(), expected.x, 1e-12);
    }
}

#[test]
fn the_nearest_point_is_found_however_near_the_equatorial_plane() {
    let deep = |z: f64| latitude_and_altitude(&Vector3::new(20_000.0, 0.0, z), &WGS84.shape);
    let (latitude, altitude) = deep(0.0);
    for exponent in [-300, -200, -100, -20, -10] {
        let (near_latitude, near_altitude) = deep(10_f64.powi(exponent));
        near("latitude", near_latitude, latitude, 1e-9);
        near("altitude", near_altitude, altitude, 1e-3);
    }
}
