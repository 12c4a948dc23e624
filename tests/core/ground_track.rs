//! Distances over the ground: downrange over whole turns, ground range, and the length of the ground track.

use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::atomic::AtomicBool;

use reentry::atmosphere::Atmosphere;
use reentry::coordinates::{GreatCircle, OrbitShape, OrbitalElements};
use reentry::event::{Condition, Direction, Effect, Event, Quantity};
use reentry::integrate::{Integrator, Limits, StepBounds, System};
use reentry::motion::Cartesian;
use reentry::propulsion::{Impulse, ThrustAxis};
use reentry::trajectory::Sampling;
use reentry::{Case, FlightPath, Planet, Stop, Trajectory, Wind};

use crate::check::{near, relative};
use crate::core::flights::{fly, in_vacuum, spherical, target_2, vehicle, with_tolerance};

const EQUATORIAL_RADIUS: f64 = 6_378_137.0;

/// Without air, on the Earth or on one that does not turn, for so long, s.
fn orbit(state: FlightPath<f64>, planet: Planet, time: f64) -> Case {
    let stop = Stop { altitude: -1e6, time, ..Stop::default() };
    in_vacuum(Case { planet, initial_state: state.to_planet_fixed(), stop, ..target_2() })
}

fn still(planet: Planet) -> Planet {
    Planet { rotation_rate: 0.0, ..planet }
}

fn level(radius: f64, speed: f64, heading: f64) -> FlightPath<f64> {
    FlightPath { radius, longitude: 0.0, geocentric_latitude: 0.0, speed, flight_path_angle: 0.0, heading }
}

fn at(time: f64, then: Effect) -> Event {
    let when = Condition { quantity: Quantity::Time, value: time, direction: Direction::Rising };
    Event { when: when.into(), then }
}

fn push(along: ThrustAxis, speed_change: f64) -> Effect {
    Effect { impulse: Some(Impulse { along, speed_change }), ..Effect::default() }
}

/// A circle in the equator keeps its rate against the ground: n - ω, or n + ω where it leads to the west.
#[test]
fn on_an_equatorial_circle_all_distances_grow_with_the_time() {
    let planet = Planet::EARTH_WGS84;
    let radius = EQUATORIAL_RADIUS + 400e3;
    let mean_motion = (planet.gravitational_parameter / radius.powi(3)).sqrt();
    for (heading, rate) in [(0.0, mean_motion - planet.rotation_rate), (PI, mean_motion + planet.rotation_rate)] {
        let flight = fly(&orbit(level(radius, rate * radius, heading), planet, 30_000.0));
        for time in [100.0, 5000.0, 7000.3, 30_000.0] {
            let point = flight.at(time);
            let angle = rate * time;
            relative("downrange", point.downrange.unwrap(), EQUATORIAL_RADIUS * angle, 1e-9);
            relative("length", point.ground_distance, EQUATORIAL_RADIUS * angle, 1e-9);
            let back = angle.cos().acos();
            near("range", point.ground_range, EQUATORIAL_RADIUS * back, 1e-9 * EQUATORIAL_RADIUS * angle);
        }
        assert!(flight.last().downrange.unwrap() > 5.0 * TAU * EQUATORIAL_RADIUS, "more than five turns");
    }
}

/// Where the planet does not turn, an orbit stays on its great circle, on which its place is the true anomaly, by Kepler's equation.
#[test]
fn on_a_planet_that_does_not_turn_the_ground_track_is_a_great_circle() {
    let planet = still(Planet::EARTH_WGS84);
    let (axis, eccentricity): (f64, f64) = (9.6e6, 0.3);
    let elements = OrbitalElements {
        shape: OrbitShape::SemiMajorAxis(axis),
        eccentricity,
        inclination: 0.9,
        raan: 1.0,
        argument_of_periapsis: 0.4,
        true_anomaly: 0.0,
    };
    let state = elements.to_inertial(planet.gravitational_parameter).to_planet_fixed(&planet, 0.0);
    let case = orbit(FlightPath::from_planet_fixed(&state), planet, 30_000.0);
    let mean_motion = (planet.gravitational_parameter / axis.powi(3)).sqrt();
    for case in [with_tolerance(case.clone(), 1e-12), spherical(with_tolerance(case, 1e-12))] {
        let flight = fly(&case);
        for time in [1.0, 2000.0, 9000.0, 20_000.0, 30_000.0] {
            let mean = mean_motion * time;
            let eccentric = (0..100).fold(mean, |eccentric: f64, _| mean + eccentricity * eccentric.sin());
            let half = 0.5 * eccentric;
            let turns = (half / PI).round();
            let stretched = ((1.0 + eccentricity) / (1.0 - eccentricity)).sqrt() * (half - turns * PI).tan();
            let anomaly = 2.0 * (stretched.atan() + turns * PI);
            let point = flight.at(time);
            near(
                "length",
                point.ground_distance,
                EQUATORIAL_RADIUS * anomaly,
                1e-9 * EQUATORIAL_RADIUS * anomaly.max(1.0),
            );
            near("downrange", point.downrange.unwrap(), point.ground_distance, 1e-2);
            near("crossrange", point.crossrange.unwrap(), 0.0, 1e-2);
            near("range", point.ground_range, EQUATORIAL_RADIUS * anomaly.cos().acos(), 0.1);
        }
    }
}

/// The motion with the length of the ground track as a seventh number: its rate is V cos γ / r.
struct Measured<'a>(&'a Cartesian);

impl System<f64, 7> for Measured<'_> {
    fn derivative(&self, time: f64, state: &[f64; 7]) -> [f64; 7] {
        let [x, y, z, vx, vy, vz, _] = *state;
        let numbers = [x, y, z, vx, vy, vz];
        let FlightPath { radius, speed, flight_path_angle, .. } = FlightPath::from_planet_fixed(&numbers.into());
        let [dx, dy, dz, dvx, dvy, dvz] = System::<f64, 6>::derivative(self.0, time, &numbers);
        [dx, dy, dz, dvx, dvy, dvz, EQUATORIAL_RADIUS * speed * flight_path_angle.cos() / radius]
    }
}

impl StepBounds<7> for Measured<'_> {
    fn magnitudes(&self) -> [f64; 7] {
        [EQUATORIAL_RADIUS, EQUATORIAL_RADIUS, EQUATORIAL_RADIUS, 7900.0, 7900.0, 7900.0, EQUATORIAL_RADIUS]
    }
}

/// A capsule that comes home from space over a third of the Earth, in the air of the thesis.
fn capsule() -> Case {
    let start = FlightPath {
        radius: 6_698_137.0,
        longitude: 0.3,
        geocentric_latitude: 0.4,
        speed: 7300.0,
        flight_path_angle: -0.03,
        heading: 0.4,
    };
    let stop = Stop { time: 5000.0, ..Stop::default() };
    Case { vehicle: vehicle(3000.0, 4.0, 0.3, 1.3), initial_state: start.to_planet_fixed(), stop, ..target_2() }
}

#[test]
fn the_length_of_the_ground_track_is_that_of_an_independent_integration() {
    for case in [target_2(), capsule()] {
        let case = with_tolerance(case, 1e-12);
        let flight = fly(&case);
        let motion = Cartesian(case.forces());
        let system = Measured(&motion);
        let [x, y, z, vx, vy, vz]: [f64; 6] = case.initial_state.into();
        let never = AtomicBool::new(false);
        let limits = Limits { relative_tolerance: 1e-13, steps: 100_000, interrupt: &never };
        let mut integrator = Integrator::new(&system, 0.0, [x, y, z, vx, vy, vz, 0.0], limits);
        for part in [0.1, 0.5, 0.8, 0.9, 1.0] {
            let time = part * flight.end_time();
            while integrator.time() < time {
                integrator.advance(&system, time).unwrap();
            }
            relative("length", flight.at(time).ground_distance, integrator.state()[6], 1e-9);
        }
        // At the default tolerance nothing is lost that anybody sees.
        let usual = fly(&with_tolerance(case, 1e-10));
        near("at the default tolerance", usual.last().ground_distance, flight.last().ground_distance, 0.1);
    }
}

/// A light body that moves to the west is stopped by wind and blown back: it comes to rest over the ground in between, where its speed has a
/// corner. Its track is the way there and back.
#[test]
fn a_track_that_turns_back_is_as_long_as_both_ways() {
    let case = Case {
        planet: still(Planet::EARTH_WGS84.spherical()),
        atmosphere: Atmosphere::Us76,
        wind: Wind::Constant { east: 20.0, north: 0.0 },
        vehicle: vehicle(1.5, 1.0, 0.0, 0.9),
        initial_state: FlightPath { flight_path_angle: -0.1, ..level(EQUATORIAL_RADIUS + 20e3, 50.0, PI) }
            .to_planet_fixed(),
        ..target_2()
    };
    for planet in [case.planet, Planet::EARTH_WGS84.spherical()] {
        let flight = fly(&Case { planet, ..case.clone() });
        // It turns back after a second or two.
        let dense = (0..10_000).map(|row| f64::from(row) * 1e-3).chain((10..2000).map(f64::from)).collect();
        let rows = flight.points(&flight.instants(&Sampling::Times(dense), 20_000).unwrap());
        let farthest = rows.iter().map(|row| row.downrange.unwrap()).fold(0.0, f64::max);
        let last = flight.last();
        assert!(farthest > 10.0 && last.downrange.unwrap() < -1000.0, "{farthest} m and {:?}", last.downrange);
        relative("length", last.ground_distance, 2.0 * farthest - last.downrange.unwrap(), 1e-9);
        near("range", last.ground_range, -last.downrange.unwrap(), 1e-6);
        assert!(rows.windows(2).all(|pair| pair[1].ground_distance >= pair[0].ground_distance), "it never shrinks");
    }
}

/// Of a flight, the downrange by rows that are so dense that none of them is half a turn from the one before.
fn unwrapped(flight: &Trajectory, rows: usize) -> Vec<(f64, f64)> {
    let circle = GreatCircle::of(&flight.initial().flight_path.to_planet_fixed());
    let mut last = 0.0;
    let points = flight.points(&flight.instants(&Sampling::Count(rows), rows).unwrap());
    let follow = |point: &reentry::trajectory::FlightPoint| {
        let [along, _] = circle.along_and_across(&point.flight_path.to_planet_fixed().position).unwrap();
        let turned = along - last;
        last += turned - TAU * (turned / TAU).round();
        (point.time, last * EQUATORIAL_RADIUS)
    };
    points.iter().map(follow).collect()
}

/// Three days in low orbits, in which the ground tracks move away from the great circle on which they set out, and come back: whatever the
/// tolerance, and so the length of the steps, and whichever instant is asked for, the downrange is that of a dense look at the flight.
#[test]
fn downrange_is_counted_on_over_many_revolutions_whatever_the_sampling() {
    for inclination in [0.5, 0.9, 1.7, 2.6] {
        let speed = (Planet::EARTH_WGS84.gravitational_parameter / 6.9e6).sqrt();
        let inertial = reentry::coordinates::InertialFlightPath {
            radius: 6.9e6,
            longitude: 0.2,
            geocentric_latitude: 0.0,
            inertial_speed: speed,
            inertial_flight_path_angle: 0.0,
            inertial_heading: inclination,
        };
        let state = FlightPath::from_planet_fixed(&inertial.to_planet_fixed(&Planet::EARTH_WGS84));
        let case = orbit(state, Planet::EARTH_WGS84, 2.6e5);
        for tolerance in [1e-10, 1e-5] {
            let marks: Vec<_> = [1e3, 5e4, 1.3e5, 2.5e5].map(|time| at(time, Effect::default())).to_vec();
            let flight = fly(&Case { events: marks, ..with_tolerance(case.clone(), tolerance) });
            let dense = unwrapped(&flight, 100_001);
            let mut farthest: f64 = 0.0;
            for (time, expected) in dense.iter().step_by(97) {
                near("downrange", flight.at(*time).downrange.unwrap(), *expected, 1.0);
                farthest = farthest.max(*expected);
            }
            assert!(farthest > 2.0 * TAU * EQUATORIAL_RADIUS, "{inclination}: {farthest} m");
            near("at the end", flight.last().downrange.unwrap(), dense.last().unwrap().1, 1.0);
            assert_eq!(flight.events().count(), 4);
            for event in flight.events() {
                let (before, after) = (event.before.downrange.unwrap(), event.after.downrange.unwrap());
                assert_eq!(before.to_bits(), after.to_bits());
                near("at an event", before, flight.at(event.before.time).downrange.unwrap(), 1e-6);
            }
        }
    }
}

/// Near a pole of the great circle the downrange gains or loses half a turn, by the side on which the flight passes; through the pole it gains it.
#[test]
fn past_the_pole_of_the_great_circle_the_side_decides() {
    let planet = still(Planet::EARTH_WGS84);
    let radius: f64 = 6_878_137.0;
    let speed = (planet.gravitational_parameter / radius).sqrt();
    let period = TAU * radius / speed;
    for (eastwards, turns) in [(10.0, 1.0), (1e-4, 1.0), (-10.0, -1.0), (-1e-4, -1.0), (1e-12, 1.0), (-1e-12, 1.0)] {
        // It sets out to the east, slowly, is turned round where it is to go west, and is pushed to the north with the speed of a circle.
        let start = level(radius, f64::abs(eastwards), 0.0);
        let north = (speed * speed - eastwards * eastwards).sqrt();
        let events = if eastwards > 0.0 {
            vec![at(0.0, push(ThrustAxis::Normal, north))]
        } else {
            vec![at(0.0, push(ThrustAxis::Velocity, 2.0 * eastwards)), at(0.0, push(ThrustAxis::Normal, -north))]
        };
        let case = Case { events, ..orbit(start, planet, 1.1 * period) };
        for case in [case.clone(), with_tolerance(case, 1e-4)] {
            let flight = fly(&case);
            let downrange = |part: f64| flight.at(part * period).downrange.unwrap() / (PI * EQUATORIAL_RADIUS);
            near("before the pole", downrange(0.2), 0.0, 0.01);
            near("past one", downrange(0.3), turns, 0.01);
            near("and the other", downrange(0.8), 2.0 * turns, 0.01);
            near("and back", downrange(1.0), 2.0 * turns, 0.01);
            relative("length", flight.at(0.8 * period).ground_distance, 0.8 * TAU * EQUATORIAL_RADIUS, 1e-3);
        }
    }
}

#[test]
fn a_flight_that_turns_round_goes_back() {
    let planet = Planet::EARTH_WGS84;
    let radius = EQUATORIAL_RADIUS + 500e3;
    let rate = (planet.gravitational_parameter / radius.powi(3)).sqrt();
    let [ahead, back] = [rate - planet.rotation_rate, rate + planet.rotation_rate];
    let turn_round = at(7000.0, push(ThrustAxis::Velocity, -(ahead + back) * radius));
    let flight = fly(&Case { events: vec![turn_round], ..orbit(level(radius, ahead * radius, 0.0), planet, 20_000.0) });
    let [there, returned] = [ahead * 7000.0, back * 13_000.0].map(|angle| angle * EQUATORIAL_RADIUS);
    near("downrange", flight.last().downrange.unwrap(), there - returned, 1e-9 * (there + returned));
    relative("length", flight.last().ground_distance, there + returned, 1e-9);
    assert!(flight.last().downrange.unwrap() < -PI * EQUATORIAL_RADIUS, "more than half a turn behind");
}

/// What starts at rest has no heading, and so no downrange, but moves over the ground: a balloon's load under its parachute, from 30 km
/// in a wind of 10 m/s, some 26.5 km in 44 minutes.
#[test]
fn what_starts_at_rest_has_a_ground_range() {
    let start = FlightPath { geocentric_latitude: 0.904, ..level(EQUATORIAL_RADIUS + 15e3, 0.0, 0.0) };
    let case = Case {
        planet: Planet::EARTH_WGS84,
        atmosphere: Atmosphere::Us76,
        wind: Wind::Constant { east: 10.0, north: 0.0 },
        vehicle: vehicle(1.5, 1.0, 0.0, 0.9),
        initial_state: start.to_planet_fixed(),
        ..target_2()
    };
    let flight = fly(&case);
    for part in [0.0, 0.001, 0.5, 1.0] {
        let point = flight.at(part * flight.end_time());
        let [from, to] = [start, point.flight_path];
        // The law of haversines.
        let half = |difference: f64| (0.5 * difference).sin().powi(2);
        let haversine = half(to.geocentric_latitude - from.geocentric_latitude)
            + from.geocentric_latitude.cos() * to.geocentric_latitude.cos() * half(to.longitude);
        near("range", point.ground_range, 2.0 * EQUATORIAL_RADIUS * haversine.sqrt().asin(), 1e-6);
        // At the start both are zero but for a rounding of the radius.
        assert!((-1e-8..1.0).contains(&(point.ground_distance - point.ground_range)), "{}", point.ground_distance);
        assert_eq!(point.downrange, None);
    }
    relative("drift", flight.last().ground_range, 10.0 * flight.end_time(), 0.02);
    // Straight up and down over a planet that does not turn, it stays where it is.
    let up = FlightPath { flight_path_angle: FRAC_PI_2, ..level(EQUATORIAL_RADIUS, 100.0, 0.0) };
    let thrown = fly(&Case { planet: still(Planet::EARTH_WGS84), initial_state: up.to_planet_fixed(), ..target_2() });
    near("length", thrown.last().ground_distance, 0.0, 1e-9);
    assert!(thrown.end_time() > 10.0);
}

/// The ground track is measured once, and only where points are asked for; a flag ends that early.
#[test]
fn the_measuring_of_the_ground_track_can_be_interrupted() {
    let flight = fly(&capsule());
    assert!(!flight.measure_ground_track(&AtomicBool::new(true)));
    assert!(flight.measure_ground_track(&AtomicBool::new(false)));
    assert!(flight.measure_ground_track(&AtomicBool::new(true)), "there is nothing left to do");
    assert_eq!(flight.last(), fly(&capsule()).last());
}
