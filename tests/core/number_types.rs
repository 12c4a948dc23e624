//! One physics for every number: lanes give the digits of `f64`, dual numbers its derivatives.

use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use num_dual::Dual64;
use proptest::prelude::*;
use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::event::{Condition, Direction, Effect, Event, Quantity, ThrustCommand};
use reentry::heating::Heating;
use reentry::integrate::System;
use reentry::motion::{Cartesian, Forces, Parameters, Spherical};
use reentry::parachute::Parachute;
use reentry::propulsion::{Impulse, Thrust, ThrustAxis};
use reentry::scalar::{Lanes, Scalar};
use reentry::sensitivity::{self, Gradient, Sensitivities};
use reentry::simulate::{arrival, ends_of_all};
use reentry::trajectory::{Ends, Termination};
use reentry::{Aerodynamics, Atmosphere, Case, Control, FlightPath, Scenario, Stop, Trajectory, Vehicle, simulate};

use crate::check::near;
use crate::core::flights::{config, fly, in_vacuum, random_entry, spherical, target_2, vehicle, with_tolerance};

/// A vehicle and its state.
type Member = (Parameters<f64>, FlightPath<f64>);

/// Vehicles, each a little different, and their states at 20 to 90 km.
fn spread<const L: usize>(case: &Case) -> [Member; L] {
    let mut lane = 0.0;
    std::array::from_fn(|_| {
        lane += 1.0;
        let part = lane / 8.0;
        let mut state = FlightPath::from_planet_fixed(&case.initial_state);
        state.radius = 6_398_137.0 + 70e3 * part;
        state.heading += part;
        let parameters = case.parameters();
        (Parameters { mass: parameters.mass * (1.0 + part), bank_angle: part, ..parameters }, state)
    })
}

fn derivatives_agree<const L: usize>(case: &Case) {
    let members = spread::<L>(case);
    let lanes = |number: fn(&Member) -> f64| Lanes(members.each_ref().map(number));
    let parameters = Parameters {
        mass: lanes(|member| member.0.mass),
        bank_angle: lanes(|member| member.0.bank_angle),
        reference_area: Lanes::from(case.parameters().reference_area),
        lift_coefficient: Lanes::from(case.parameters().lift_coefficient),
        drag_coefficient: Lanes::from(case.parameters().drag_coefficient),
        density: Lanes::from(case.parameters().density),
    };
    let in_lanes = Forces::new(case.models(), parameters);
    let states = members.map(|(_, state)| -> [f64; 6] { state.into() });
    let places = members.map(|(_, state)| -> [f64; 6] { state.to_planet_fixed().into() });
    let by_lane = |rows: &[[f64; 6]; L]| std::array::from_fn(|i| Lanes(rows.map(|row| row[i])));
    let spherical = Spherical(in_lanes.clone()).derivative(Lanes::from(0.0), &by_lane(&states));
    let cartesian = Cartesian(in_lanes).derivative(Lanes::from(0.0), &by_lane(&places));
    for lane in 0..L {
        let alone = Forces::new(case.models(), members[lane].0);
        let digits = |lanes: [Lanes<L>; 6]| lanes.map(|component| component.0[lane].to_bits());
        assert_eq!(
            digits(spherical),
            Spherical(alone.clone()).derivative(0.0, &states[lane]).map(f64::to_bits),
            "lane {lane} of {L}"
        );
        assert_eq!(
            digits(cartesian),
            Cartesian(alone).derivative(0.0, &places[lane]).map(f64::to_bits),
            "lane {lane} of {L}"
        );
    }
}

#[test]
fn the_derivative_in_lanes_has_the_digits_of_f64() {
    let ellipsoid = Case { planet: reentry::Planet::EARTH_WGS84, ..target_2() };
    for case in [target_2(), ellipsoid, in_vacuum(target_2())] {
        derivatives_agree::<4>(&case);
        derivatives_agree::<8>(&case);
    }
}

#[test]
fn lanes_choose_each_by_itself() {
    let numbers = Lanes([-1.0, 0.0, 2.0, f64::NAN]);
    let chosen = Lanes::select(numbers.less_than(1.0), numbers + 10.0, numbers * 10.0);
    assert_eq!(chosen.0[..3], [9.0, 10.0, 20.0]);
    assert!(chosen.0[3].is_nan());
}

proptest! {
    #![proptest_config(config(12))]

    /// Flights of different lengths, tolerances, planets and formulations: lanes are refilled, and groups change.
    #[test]
    fn flights_in_lanes_end_at_the_digits_of_flights_alone(
        cases in prop::collection::vec((random_entry(), 4..12_i32, any::<bool>()), 1..30)
    ) {
        let scenarios: Vec<_> = cases
            .into_iter()
            .map(|(case, digits, turned)| {
                let case = with_tolerance(case, 10_f64.powi(-digits));
                Scenario::new(if turned { spherical(case) } else { case }).unwrap()
            })
            .collect();
        let interrupt = AtomicBool::new(false);
        for (scenario, in_lanes) in scenarios.iter().zip(ends_of_all(&scenarios, &interrupt)) {
            let alone = arrival(scenario, &interrupt);
            // Debug output, in which numbers have all their digits, also compares errors and counts.
            prop_assert_eq!(format!("{:?}", in_lanes.as_ref().map(Ends::arrival)), format!("{:?}", alone.as_ref()));
        }
    }

    #[test]
    fn an_arrival_is_the_end_of_the_flight(case in random_entry()) {
        let flight = fly(&case);
        let end = arrival(&Scenario::new(case).unwrap(), &AtomicBool::new(false)).unwrap();
        prop_assert_eq!(end.time.to_bits(), flight.end_time().to_bits());
        prop_assert_eq!(FlightPath::from_planet_fixed(&end.state).wrapped(), flight.last().flight_path);
        prop_assert_eq!(end.termination, flight.termination());
    }
}

/// Neither the integration nor the search for the impact takes any memory; recording a flight takes its steps.
#[test]
fn flying_allocates_nothing_and_recording_little() {
    let cases = [target_2(), spherical(target_2()), with_tolerance(target_2(), 1e-6)];
    for scenario in cases.map(|case| Scenario::new(case).unwrap()) {
        let interrupt = AtomicBool::new(false);
        let flown = allocation_counter::measure(|| assert!(arrival(&scenario, &interrupt).is_ok()));
        assert_eq!(flown.count_total, 0);
        let recorded = allocation_counter::measure(|| assert!(simulate(&scenario, &interrupt).is_ok()));
        assert_eq!(
            recorded.count_total, 3,
            "the list of steps, with room for 64, that of the phases and that of their peaks"
        );
    }
}

#[test]
fn flights_in_lanes_end_where_they_start_when_they_must_and_when_the_flag_is_raised() {
    let ground = FlightPath { radius: 6_378_137.0, ..FlightPath::from_planet_fixed(&target_2().initial_state) };
    let grounded = Case { initial_state: ground.to_planet_fixed(), ..target_2() };
    let scenarios: Vec<_> = [grounded.clone(), target_2(), grounded].map(|case| Scenario::new(case).unwrap()).into();
    let ends = ends_of_all(&scenarios, &AtomicBool::new(false));
    let times: Vec<_> = ends.iter().map(|end| end.as_ref().unwrap().arrival().time).collect();
    assert_eq!([times[0], times[2]].map(f64::to_bits), [0; 2]);
    near("TARGET case 2", times[1], 157.436_433, 1e-6);
    let interrupted = ends_of_all(&scenarios[1..2], &AtomicBool::new(true));
    assert!(matches!(interrupted[..], [Err(reentry::simulate::SimulationError::Interrupted { .. })]));
}

fn sensitivities(flight: &Trajectory) -> Sensitivities {
    sensitivity::sensitivities(flight, &AtomicBool::new(false)).unwrap()
}

/// The arrival's time, longitude, geocentric latitude, speed and flight-path angle.
fn outputs(case: Case) -> [f64; 5] {
    let flight = fly(&with_tolerance(case, 1e-13));
    let FlightPath { longitude, geocentric_latitude, speed, flight_path_angle, .. } = flight.last().flight_path;
    [flight.end_time(), longitude, geocentric_latitude, speed, flight_path_angle]
}

/// The case with one of the twelve numbers changed by an amount.
fn varied(case: &Case, input: usize, amount: f64) -> Case {
    let mut vehicle = case.vehicle.clone();
    let Aerodynamics::Constant { mut lift_coefficient, mut drag_coefficient } = vehicle.aerodynamics else {
        panic!("{vehicle:?}")
    };
    let Atmosphere::Exponential { mut surface_density, scale_height } = case.atmosphere else { panic!("{case:?}") };
    let mut bank_angle = 0.0;
    let mut state: [f64; 6] = FlightPath::from_planet_fixed(&case.initial_state).into();
    *match input {
        0 => &mut vehicle.mass,
        1 => &mut vehicle.reference_area,
        2 => &mut lift_coefficient,
        3 => &mut drag_coefficient,
        4 => &mut bank_angle,
        5 => &mut surface_density,
        component => &mut state[component - 6],
    } += amount;
    vehicle.aerodynamics = Aerodynamics::Constant { lift_coefficient, drag_coefficient };
    let atmosphere = Atmosphere::Exponential { surface_density, scale_height };
    let initial_state = FlightPath::from(state).to_planet_fixed();
    let control = match &case.control.bank_angle {
        Command::Constant(angle) => Control::banked(angle + bank_angle),
        // The whole schedule, turned.
        Command::Schedule(schedule) => {
            let turned = Command::Schedule(Arc::new(schedule.turned_by(bank_angle)));
            Control { bank_angle: turned, ..case.control.clone() }
        }
    };
    Case { vehicle, atmosphere, control, initial_state, ..case.clone() }
}

fn rows(sensitivities: &Sensitivities) -> [[f64; 12]; 5] {
    let Sensitivities { time, longitude, geocentric_latitude, speed, flight_path_angle } = sensitivities;
    [time, longitude, geocentric_latitude, speed, flight_path_angle].map(|gradient| {
        let Gradient { mass, reference_area, lift_coefficient, drag_coefficient, .. } = *gradient;
        let [r, theta, phi, v, gamma, psi]: [f64; 6] = gradient.initial_state.into();
        let Gradient { bank_angle, surface_density, .. } = *gradient;
        let others = [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, surface_density];
        let [a, b, c, d, e, f] = others;
        [a, b, c, d, e, f, r, theta, phi, v, gamma, psi]
    })
}

/// Central differences of flights at 1e-13, whose error is that of their second order and some rounding.
fn agrees_with_differences(what: &str, case: &Case) {
    let slopes = rows(&sensitivities(&fly(case)));
    // Steps that move the impact by metres.
    let steps = [
        1e-5 * case.vehicle.mass,
        1e-5 * case.vehicle.reference_area,
        1e-5,
        1e-5,
        1e-5,
        1e-5,
        1.0,
        1e-6,
        1e-6,
        0.1,
        1e-6,
        1e-6,
    ];
    for (input, step) in steps.into_iter().enumerate() {
        let (above, below) = (outputs(varied(case, input, step)), outputs(varied(case, input, -step)));
        for output in 0..5 {
            let difference = (above[output] - below[output]) / (2.0 * step);
            // The noise of an arrival at 1e-13 in s, rad, rad, m/s and rad.
            let noise = [1e-8, 1e-14, 1e-14, 1e-8, 1e-11][output] / step;
            let what = format!("{what}: output {output} by input {input}");
            near(&what, slopes[output][input], difference, 2e-4 * difference.abs() + noise);
        }
    }
}

#[test]
fn sensitivities_are_the_slopes_of_the_impact() {
    let ellipsoid = Case { planet: reentry::Planet::EARTH_WGS84, ..target_2() };
    agrees_with_differences("TARGET case 2", &target_2());
    agrees_with_differences("over the ellipsoid", &ellipsoid);
    agrees_with_differences("spherical", &spherical(ellipsoid.clone()));
    let timed = Case { stop: Stop { time: 70.0, ..Stop::default() }, ..ellipsoid.clone() };
    agrees_with_differences("to a given time", &timed);
    assert!(rows(&sensitivities(&fly(&timed)))[0].iter().all(|slope| *slope == 0.0), "the time is given");
    // Slopes by coefficients and densities of zero are those on the one side that there is: the other quantities are enough.
    let ballistic = Case { vehicle: vehicle(700.0, 0.216_419, 0.0, 0.2), ..ellipsoid.clone() };
    agrees_with_differences("without lift", &ballistic);
}

/// Where a bank angle steps or the air grows denser at once, the flight turns a corner, sooner or later as the numbers vary.
#[test]
fn sensitivities_hold_across_changes_of_formula() {
    let by = |against, at: &[f64], interpolation| {
        let schedule = Schedule::new(against, at, &[0.3, 1.1, -0.4], interpolation).unwrap();
        Control { bank_angle: Command::Schedule(Arc::new(schedule)), ..Control::banked(0.0) }
    };
    // TARGET case 2 falls from 122 km at 3 km/s, and dips at 79 s.
    for (what, control) in [
        ("steps in altitude", by(Against::Altitude, &[0.0, 15e3, 40e3], Interpolation::Step)),
        ("steps in speed", by(Against::Speed, &[0.0, 1200.0, 2500.0], Interpolation::Step)),
        ("steps in time", by(Against::Time, &[0.0, 40.0, 60.0], Interpolation::Step)),
        ("lines in speed", by(Against::Speed, &[500.0, 1200.0, 2500.0], Interpolation::Linear)),
        ("steps in energy", by(Against::Energy, &[-7e7, -6.2e7, -5.9e7], Interpolation::Step)),
        ("lines in energy", by(Against::Energy, &[-6.25e7, -6.1e7, -5.8e7], Interpolation::Linear)),
    ] {
        agrees_with_differences(what, &Case { control, ..target_2() });
    }
}

/// What happens comes sooner or later as the numbers vary, and so do the end of a burn and a condition that ends the flight.
#[test]
fn sensitivities_hold_across_events() {
    let when = |quantity, value| Condition { quantity, value, direction: Direction::Falling };
    let event = |when: Condition, then| vec![Event { when: when.into(), then }];
    let aerodynamics = Some(Aerodynamics::Constant { lift_coefficient: 0.1, drag_coefficient: 0.9 });
    let opens = Effect { mass: Some(500.0), reference_area: Some(0.5), aerodynamics, ..Effect::default() };
    let lighter = Effect { mass: Some(600.0), ..Effect::default() };
    let pushed = |along| Effect { impulse: Some(Impulse { along, speed_change: -150.0 }), ..Effect::default() };
    let burns = |along, propellant| {
        let thrust = Thrust { along, force: -9000.0, specific_impulse: Some(250.0), propellant };
        Effect { thrust: Some(ThrustCommand::On(thrust)), ..Effect::default() }
    };
    let off = Effect { thrust: Some(ThrustCommand::Off), ..Effect::default() };
    let altitude = |value| when(Quantity::Altitude, value);
    let deploys = |drag_area, inflation_time, delay| {
        let parachute = Parachute { drag_area, inflation_time, delay };
        Effect { deploy: Some(parachute), ..Effect::default() }
    };
    let releases = |parachute| Effect { release: vec![parachute], ..Effect::default() };
    let inertial = ThrustAxis::inertial([1.0, -2.0, 0.7]).unwrap();
    for (what, events) in [
        (
            "a vehicle that opens by dynamic pressure",
            event(Condition { direction: Direction::Rising, ..when(Quantity::DynamicPressure, 2e4) }, opens),
        ),
        (
            "a mass by load factor",
            event(Condition { direction: Direction::Rising, ..when(Quantity::LoadFactor, 0.8) }, lighter.clone()),
        ),
        (
            "an impulse by speed",
            event(
                Condition { direction: Direction::Rising, ..when(Quantity::Speed, 3250.0) },
                pushed(ThrustAxis::Velocity),
            ),
        ),
        ("an impulse across", event(altitude(40e3), pushed(ThrustAxis::Normal))),
        ("an impulse by the angle", event(when(Quantity::FlightPathAngle, -0.6), pushed(ThrustAxis::Radial))),
        ("a burn to its end", event(altitude(60e3), burns(ThrustAxis::Velocity, Some(80.0)))),
        ("an inertial impulse", event(altitude(40e3), pushed(inertial))),
        ("a level impulse", event(altitude(40e3), pushed(ThrustAxis::Horizontal))),
        ("a burn in inertial space", event(altitude(60e3), burns(inertial, Some(80.0)))),
        ("a level burn", event(altitude(60e3), burns(ThrustAxis::Horizontal, Some(80.0)))),
        (
            "a parachute that opens at once",
            event(
                Condition { direction: Direction::Rising, ..when(Quantity::LoadFactor, 0.8) },
                deploys(0.4, 0.0, 0.0),
            ),
        ),
        ("a parachute that fills after a delay", event(altitude(60e3), deploys(0.4, 9.0, 2.5))),
        (
            "parachutes that follow each other, and a mass that changes as one fills, and burns",
            vec![
                Event { when: altitude(70e3).into(), then: deploys(0.2, 12.0, 0.0) },
                Event { when: altitude(62e3).into(), then: burns(ThrustAxis::Velocity, Some(40.0)) },
                Event { when: altitude(58e3).into(), then: lighter.clone() },
                Event { when: altitude(30e3).into(), then: Effect { release: vec![0], ..deploys(0.5, 5.0, 1.0) } },
                Event { when: altitude(9e3).into(), then: releases(3) },
            ],
        ),
        (
            "a burn by the time",
            vec![
                Event {
                    when: Condition { direction: Direction::Rising, ..when(Quantity::Time, 20.0) }.into(),
                    then: burns(ThrustAxis::Radial, None),
                },
                Event { when: altitude(30e3).into(), then: lighter },
                Event { when: altitude(20e3).into(), then: off },
            ],
        ),
    ] {
        agrees_with_differences(what, &Case { events, ..target_2() });
    }
    let stopped = |when: Condition| Case { stop: Stop { when: vec![when.into()], ..Stop::default() }, ..target_2() };
    agrees_with_differences("stopped by speed", &stopped(when(Quantity::Speed, 2000.0)));
    agrees_with_differences(
        "stopped by load",
        &stopped(Condition { direction: Direction::Rising, ..when(Quantity::LoadFactor, 2.0) }),
    );
    let heated = Vehicle { nose_radius: Some(0.1), ..target_2().vehicle };
    let heating = Heating { emissivity: 0.9, ..Heating::default() };
    agrees_with_differences("heated", &Case { vehicle: heated, heating: Some(heating), ..target_2() });
}

/// In a vacuum straight up and down: t = 2v/g and the rest by hand, and the slope by a density that is zero.
#[test]
fn sensitivities_of_a_stone_thrown_upward_are_those_of_the_textbook() {
    let planet = reentry::Planet { rotation_rate: 0.0, ..reentry::Planet::EARTH_WGS84.spherical() };
    let (radius, speed) = (6_378_137.0, 100.0);
    let up =
        FlightPath { radius, longitude: 0.3, geocentric_latitude: 0.2, speed, flight_path_angle: 1.2, heading: 0.4 };
    let stone =
        Case { planet, initial_state: up.to_planet_fixed(), control: Control::banked(0.0), ..in_vacuum(target_2()) };
    let stone = Case { vehicle: vehicle(1.0, 0.01, 0.0, 1.0), ..stone };
    let flight = fly(&stone);
    assert_eq!(flight.termination(), Termination::SurfaceImpact);
    let slopes = sensitivities(&flight);
    let gravity = planet.gravitational_parameter / (radius * radius);
    // A flat, uniform field is right to the height over the radius: 7e-5, and as much again for the shape of the Earth below.
    near("dt/dv = 2 sin γ/g", slopes.time.initial_state.speed, 2.0 * 1.2_f64.sin() / gravity, 1e-3);
    near(
        "dt/dγ = 2 v cos γ/g",
        slopes.time.initial_state.flight_path_angle,
        2.0 * speed * 1.2_f64.cos() / gravity,
        1e-2,
    );
    near("dv/dv", slopes.speed.initial_state.speed, 1.0, 1e-6);
    near("by mass", slopes.speed.mass, 0.0, 1e-12);
    // Drag on the way takes speed, even where there is none yet: to first order dv/dt = -(S C_D/m) ρ v²/2.
    assert!(slopes.speed.surface_density < -0.1, "{}", slopes.speed.surface_density);
}

/// A flight that ends where it starts, on the ground and sinking, ends later from higher up: by the height over the rate.
#[test]
fn sensitivities_of_a_flight_that_ends_at_its_start_are_those_of_what_follows() {
    let start = FlightPath::from_planet_fixed(&target_2().initial_state);
    let (speed, flight_path_angle) = (100.0, -0.05);
    let ground = FlightPath { radius: 6_378_137.0, speed, flight_path_angle, ..start };
    let flight = fly(&Case { initial_state: ground.to_planet_fixed(), ..target_2() });
    assert_eq!(flight.end_time().to_bits(), 0);
    let slopes = sensitivities(&flight);
    let sink_rate = speed * f64::sin(0.05);
    near("dt/dr", slopes.time.initial_state.radius, 1.0 / sink_rate, 1e-9 / sink_rate);
    near("dV/dr", slopes.speed.initial_state.radius, -flight.last().loads.deceleration / sink_rate, 1e-6);
}

/// At rest and in vertical flight the flight-path angle has no slope, at a pole the longitude has none: wherever on the planet.
#[test]
fn what_is_undefined_has_no_slope() {
    let planet = reentry::Planet { rotation_rate: 0.0, ..reentry::Planet::EARTH_WGS84.spherical() };
    let slopes = |geocentric_latitude: f64, speed: f64, flight_path_angle: f64| {
        let start = FlightPath {
            radius: 6_379_137.0,
            longitude: 0.3,
            geocentric_latitude,
            speed,
            flight_path_angle,
            heading: 0.0,
        };
        let case = Case { planet, initial_state: start.to_planet_fixed(), control: Control::banked(0.0), ..target_2() };
        sensitivities(&fly(&Case { vehicle: vehicle(10.0, 0.01, 0.0, 1.0), ..case }))
    };
    let finite = |gradient: &Gradient| gradient.mass.is_finite();
    for latitude in [0.0, 0.2, -1.2] {
        let dropped = slopes(latitude, 0.0, 0.0);
        assert!(!finite(&dropped.flight_path_angle), "dropped at {latitude}: {dropped:?}");
        assert!(finite(&dropped.time) && finite(&dropped.speed) && finite(&dropped.longitude), "{dropped:?}");
        let thrown = slopes(latitude, 100.0, -std::f64::consts::FRAC_PI_2);
        assert!(!finite(&thrown.flight_path_angle), "straight down at {latitude}: {thrown:?}");
    }
    let polar = slopes(std::f64::consts::FRAC_PI_2, 0.0, 0.0);
    assert!(!finite(&polar.longitude) && !finite(&polar.geocentric_latitude) && finite(&polar.time), "{polar:?}");
    let inclined = slopes(0.2, 100.0, -1.0);
    assert!(finite(&inclined.flight_path_angle) && finite(&inclined.longitude));
}

#[test]
fn the_flag_ends_the_sensitivities_as_well() {
    let interrupted = sensitivity::sensitivities(&fly(&target_2()), &AtomicBool::new(true));
    assert!(matches!(interrupted, Err(reentry::simulate::SimulationError::Interrupted { .. })));
}

/// d atan2(y, x) = (x dy - y dx)/(x² + y²), also where x is 0, by which dual numbers would divide.
#[test]
fn the_angle_of_a_point_has_a_slope_on_every_axis() {
    for (y, x) in [(2.0_f64, 0.0_f64), (-2.0, 0.0), (0.0, 3.0), (0.0, -3.0), (1.0, 2.0), (-1.0, -2.0)] {
        let [dy, dx] = [0.7, -0.4];
        let angle = Scalar::atan2(Dual64::new(y, dy), Dual64::new(x, dx));
        assert_eq!(angle.re.to_bits(), y.atan2(x).to_bits());
        near("slope", angle.eps, (x * dy - y * dx) / (x * x + y * y), 1e-15);
    }
}
