//! What goes wrong in entry simulations, each with the flight that shows it: all of these fail without their mend.

use std::f64::consts::FRAC_PI_2;
use std::sync::atomic::{AtomicBool, Ordering};

use reentry::interpolation::Hint;
use reentry::motion::Singularity;
use reentry::scenario::Fault;
use reentry::simulate::SimulationError;
use reentry::trajectory::{Sampling, Termination, Warning};
use reentry::{Atmosphere, Case, Control, FlightPath, Planet, Scenario, Solver, Stop, Wind, simulate};

use crate::check::{near, relative};
use crate::core::flights::{fly, in_vacuum, miss, spherical, target_2, try_to_fly, vehicle, with_tolerance};

fn starting(case: Case, state: FlightPath<f64>) -> Case {
    Case { initial_state: state.to_planet_fixed(), ..case }
}

/// TARGET case 2 dips to 214 m at 79 s, climbs to 4 km and lands at 157 s: a sign test at the ends of steps misses the dip.
#[test]
fn a_grazing_impact_is_an_impact() {
    let through = fly(&target_2());
    near("without ground in the dip", through.end_time(), 157.436, 1e-3);
    for tolerance in [1e-3, 1e-6, 1e-8, 1e-10, 1e-12] {
        for altitude in [250.0, 300.0, 500.0, 1000.0, 3000.0] {
            let case = with_tolerance(target_2(), tolerance);
            let case = Case { stop: Stop { altitude, ..case.stop }, ..case };
            let flight = fly(&case);
            let what = format!("ground at {altitude} m, tolerance {tolerance:e}");
            assert_eq!(flight.termination(), Termination::StopAltitude, "{what}");
            assert!(flight.end_time() < 80.0, "{what}: {} s", flight.end_time());
            near(&what, flight.last().loads.altitude, altitude, 1e-8);
        }
    }
    let above_the_dip = Case { stop: Stop { altitude: 200.0, time: 1e4, ..Stop::default() }, ..target_2() };
    assert!(fly(&above_the_dip).end_time() > 150.0);
}

#[test]
fn the_impact_lies_on_the_ground_at_every_tolerance() {
    for tolerance in [1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-13] {
        for case in [target_2(), spherical(target_2())] {
            let flight = fly(&with_tolerance(case, tolerance));
            near(&format!("{tolerance:e}"), flight.last().loads.altitude, 0.0, 1e-8);
        }
    }
}

/// The dense output is less accurate than the steps; the state at the impact is that of a step that ends there.
#[test]
fn the_state_at_the_impact_is_more_accurate_than_the_dense_output() {
    // The same flight into a pit passes the ground inside a step.
    let pit = Case { stop: Stop { altitude: -3000.0, time: 1e4, ..Stop::default() }, ..target_2() };
    let exact = fly(&with_tolerance(pit.clone(), 1e-14));
    let place = |point: reentry::trajectory::FlightPoint| point.flight_path.to_planet_fixed().position;
    let [mut on_dense, mut on_step] = [0.0; 2];
    for tolerance in [1e-6, 3e-7, 1e-7, 3e-8, 1e-8, 3e-9, 1e-9] {
        let impact = fly(&with_tolerance(target_2(), tolerance));
        let passing = fly(&with_tolerance(pit.clone(), tolerance));
        let time = impact.end_time();
        on_step += ((place(impact.last()) - place(exact.at(time))).norm() / tolerance).ln();
        on_dense += ((place(passing.at(time)) - place(exact.at(time))).norm() / tolerance).ln();
    }
    let gain = ((on_dense - on_step) / 7.0).exp();
    assert!(gain > 1.1, "the error of the dense output is {gain} times that of the step");
}

/// e^-h/H overflows in trial stages far below the ground.
#[test]
fn the_density_is_finite_at_every_altitude() {
    for altitude in [0.0, -1e5, -5e6, -1e9, -1e300, 1e300] {
        let density: f64 = Atmosphere::EARTH_JAMESON.density(0, altitude, &Hint::default());
        assert!(density.is_finite(), "{density} at {altitude}");
        // Of the least scale height there is, whose reciprocal no number holds.
        let thin: f64 = Atmosphere::Exponential { surface_density: 1.0, scale_height: 5e-324 }.density(
            0,
            altitude,
            &Hint::default(),
        );
        assert!(thin.is_finite(), "{thin} at {altitude}");
    }
    // A heavy body at great speed straight down: its first trial steps end far below the ground.
    let dart = starting(
        Case { vehicle: vehicle(1e6, 0.01, 0.0, 0.1), ..target_2() },
        FlightPath { speed: 1e6, flight_path_angle: -1.5, ..FlightPath::from_planet_fixed(&target_2().initial_state) },
    );
    let exact = fly(&with_tolerance(dart.clone(), 1e-13));
    let flight = fly(&with_tolerance(dart, 1e-3));
    assert_eq!(flight.termination(), Termination::SurfaceImpact);
    // A thousandth of the circular speed over the 0.12 s of this flight.
    assert!(miss(&flight, &exact) < 1.0, "{} m", miss(&flight, &exact));
}

/// From space no stage sees the air: a long step jumps over the whole atmosphere.
#[test]
fn the_atmosphere_is_not_jumped_over() {
    // Falls from 300 000 km, through the air at perigee altitudes where it must be slowed, and out again or down.
    for (perigee, speed_lost) in [(40e3, 1000.0), (60e3, 50.0), (80e3, 2.0)] {
        let radius = 3e8;
        let perigee_radius = 6_378_137.0 + perigee;
        let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
        // 12 km/s at perigee, inbound on the hyperbola: energy and angular momentum give the speed and angle far out.
        let energy = 12e3_f64.powi(2) / 2.0 - planet.gravitational_parameter / perigee_radius;
        let speed = (2.0 * (energy + planet.gravitational_parameter / radius)).sqrt();
        let flight_path_angle = -(12e3 * perigee_radius / (radius * speed)).acos();
        let state =
            FlightPath { radius, longitude: 0.0, geocentric_latitude: 0.0, speed, flight_path_angle, heading: 0.3 };
        let case = starting(Case { planet, vehicle: vehicle(5000.0, 10.0, 0.0, 1.0), ..target_2() }, state);
        let case = Case { stop: Stop { altitude: 0.0, time: 60_000.0, ..Stop::default() }, ..case };
        let exact = fly(&with_tolerance(case.clone(), 1e-13));
        let coasting = fly(&with_tolerance(in_vacuum(case.clone()), 1e-13));
        let lost = coasting.last().flight_path.speed - exact.last().flight_path.speed;
        assert!(lost > speed_lost, "{perigee}: the air takes {lost} m/s");
        for tolerance in [1e-3, 1e-4, 1e-6, 1e-8] {
            let flight = fly(&with_tolerance(case.clone(), tolerance));
            let error = (flight.peaks().deceleration.value / exact.peaks().deceleration.value - 1.0).abs();
            assert!(error < 0.1, "{perigee}, {tolerance:e}: peak deceleration off by {error}");
        }
    }
}

/// Lift has no direction in vertical flight, and jumps to the opposite side beyond it: negative lift turns a flight down to the
/// vertical, where it chatters with ever smaller steps.
#[test]
fn negative_lift_ends_in_the_vertical_and_not_in_chatter() {
    let state = FlightPath { flight_path_angle: -1.2, ..FlightPath::from_planet_fixed(&target_2().initial_state) };
    let diving = starting(
        Case { vehicle: vehicle(700.0, 0.216_419, -0.5, 0.2), control: Control::banked(0.0), ..target_2() },
        state,
    );
    let flight = fly(&diving);
    assert_eq!(flight.termination(), Termination::SurfaceImpact);
    assert!(flight.statistics().steps < 500, "{:?}", flight.statistics());
    let [Warning::LiftFadedNearVertical { time }] = flight.warnings() else {
        panic!("{:?}", flight.warnings());
    };
    // The warning comes when the flight enters the cone: just before, it is outside.
    let angle = |time: f64| FRAC_PI_2 - flight.at(time).flight_path.flight_path_angle.abs();
    near("at the warning", angle(*time), 1e-3, 1e-9);
    assert!(angle(time - 0.01) > 1e-3 && angle(time + 1e-4) < 1e-3);
    // The same lift without its fade would not be the same: the fade is felt only in the cone.
    assert!(fly(&target_2()).warnings().is_empty());
}

#[test]
fn the_cartesian_formulation_flies_over_poles_from_rest_and_straight_down() {
    let level = FlightPath::from_planet_fixed(&target_2().initial_state);
    let over_the_pole = FlightPath { geocentric_latitude: 1.55, heading: FRAC_PI_2, flight_path_angle: -0.1, ..level };
    let at_the_pole = FlightPath { geocentric_latitude: FRAC_PI_2, ..level };
    let at_rest = FlightPath { speed: 0.0, ..level };
    let straight_down = FlightPath { flight_path_angle: -FRAC_PI_2, ..level };
    let straight_up = FlightPath { flight_path_angle: FRAC_PI_2, speed: 500.0, ..level };
    for state in [over_the_pole, at_the_pole, at_rest, straight_down, straight_up] {
        let flight = fly(&starting(target_2(), state));
        assert_eq!(flight.termination(), Termination::SurfaceImpact, "{state:?}");
        assert!(flight.statistics().steps < 1000, "{state:?}: {:?}", flight.statistics());
    }
}

/// Wind to the north blows towards the pole from all sides. What drifts with it is carried there, and slows down as the wind fades: by an
/// integration of the distance alone, since a light body has the speed of the air.
#[test]
fn wind_towards_the_pole_fades_there() {
    let radius = 6_378_137.0;
    let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
    let fade = |distance: f64| {
        let x = (distance / (1e-3 * radius)).min(1.0);
        x.powi(3) * (10.0 - 15.0 * x + 6.0 * x * x)
    };
    let start = |distance: f64| FlightPath {
        radius: radius + 9e3,
        longitude: 0.3,
        geocentric_latitude: FRAC_PI_2 - distance / radius,
        speed: 8.0,
        flight_path_angle: -1.5,
        heading: 0.2,
    };
    for (distance, east, north) in [(15e3, 0.0, 20.0), (3e3, 0.0, 20.0), (500.0, 5.0, 20.0), (8e3, 30.0, 20.0)] {
        let case = Case {
            planet,
            atmosphere: Atmosphere::EARTH_JAMESON,
            wind: Wind::Constant { east, north },
            vehicle: vehicle(0.1, 0.05, 0.0, 1.0),
            control: Control::banked(0.0),
            solver: Solver { step_limit: 5000, ..Solver::default() },
            ..starting(target_2(), start(distance))
        };
        let flight = fly(&case);
        assert_eq!(flight.termination(), Termination::SurfaceImpact);
        let warned = flight.warnings().iter().any(|warning| matches!(warning, Warning::WindFadedNearPole { .. }));
        assert!(warned, "{distance}: {:?}", flight.warnings());
        let mut expected = distance;
        let steps = 100_000;
        for _ in 0..steps {
            expected -= north * fade(expected) * flight.end_time() / f64::from(steps);
        }
        let last = flight.last().flight_path.to_planet_fixed().position;
        // At first the body has not yet the speed of the air, and later keeps a little of it: some seconds of the wind.
        near(&format!("from {distance} m"), last.x.hypot(last.y), expected, 20.0 + 0.01 * expected);
        assert!(expected < 0.9 * distance, "the test cannot tell: {expected} m");
        assert!(miss(&flight, &fly(&spherical(case))) < 1e-2);
    }
    // Away from the pole the wind is whole, and nobody is warned.
    let away = Case { wind: Wind::Constant { east: 0.0, north: -20.0 }, ..starting(target_2(), start(7e3)) };
    assert!(!fly(&away).warnings().iter().any(|warning| matches!(warning, Warning::WindFadedNearPole { .. })));
}

#[test]
fn the_spherical_formulation_refuses_its_singularities_by_name() {
    let level = FlightPath::from_planet_fixed(&target_2().initial_state);
    let cases = [
        (FlightPath { geocentric_latitude: FRAC_PI_2, ..level }, Singularity::Pole),
        (FlightPath { geocentric_latitude: -FRAC_PI_2, ..level }, Singularity::Pole),
        (FlightPath { flight_path_angle: -FRAC_PI_2, ..level }, Singularity::VerticalFlight),
        (FlightPath { flight_path_angle: FRAC_PI_2, ..level }, Singularity::VerticalFlight),
        (FlightPath { speed: 0.0, ..level }, Singularity::Rest),
    ];
    for (state, singularity) in cases {
        let error = try_to_fly(&spherical(starting(target_2(), state))).unwrap_err();
        assert_eq!(error, SimulationError::Singularity { time: 0.0, at: singularity }, "{state:?}");
    }
}

/// A flight that meets a singularity on its way either ends with its name or passes it by as the other formulation does.
#[test]
fn the_spherical_formulation_never_hangs_or_errs_near_its_singularities() {
    let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
    let level = FlightPath::from_planet_fixed(&target_2().initial_state);
    for miss_by in [0.0, 1e-12, 1e-9, 1e-7, 1e-5, 1e-3] {
        let over_the_pole =
            FlightPath { geocentric_latitude: 1.5, heading: FRAC_PI_2 - miss_by, flight_path_angle: 0.1, ..level };
        let through_the_top = FlightPath { flight_path_angle: FRAC_PI_2 - miss_by, speed: 1000.0, ..level };
        for state in [over_the_pole, through_the_top] {
            let ballistic = Case { planet, vehicle: vehicle(700.0, 0.216_419, 0.0, 0.2), ..target_2() };
            let case = starting(ballistic, state);
            match try_to_fly(&spherical(case.clone())) {
                Ok(flight) => {
                    let error = miss(&flight, &fly(&case));
                    assert!(error < 1.0, "{miss_by:e}, {state:?}: {error} m");
                }
                Err(SimulationError::Singularity { .. }) => {
                    assert!(miss_by < 1e-4, "{miss_by:e} is far enough away: {state:?}");
                }
                Err(error) => panic!("{error} for {state:?}"),
            }
        }
    }
}

#[test]
fn a_flight_that_never_lands_ends_with_its_time() {
    let orbit = FlightPath {
        radius: 7e6,
        speed: 7500.0,
        flight_path_angle: 0.0,
        ..FlightPath::from_planet_fixed(&target_2().initial_state)
    };
    let case = starting(in_vacuum(target_2()), orbit);
    let flight = fly(&Case { stop: Stop { altitude: 0.0, time: 20_000.0, ..Stop::default() }, ..case.clone() });
    assert_eq!(flight.termination(), Termination::TimeLimit);
    near("the end", flight.end_time(), 20_000.0, 0.0);

    let long = Case { stop: Stop { altitude: 0.0, time: 1e9, ..Stop::default() }, ..case };
    let error = try_to_fly(&long).unwrap_err();
    // 100 000 steps of some 200 s.
    assert!(matches!(error, SimulationError::StepLimit { limit: 100_000, time } if time < 1e8), "{error}");
}

#[test]
fn a_flight_ends_soon_after_its_flag_is_raised() {
    let orbit = FlightPath {
        radius: 7e6,
        speed: 7500.0,
        flight_path_angle: 0.0,
        ..FlightPath::from_planet_fixed(&target_2().initial_state)
    };
    let solver = Solver { step_limit: usize::MAX, ..Solver::default() };
    let case = Case {
        solver,
        stop: Stop { altitude: 0.0, time: 1e9, ..Stop::default() },
        ..starting(in_vacuum(target_2()), orbit)
    };
    let scenario = Scenario::new(case).unwrap();
    let interrupt = AtomicBool::new(false);
    // Without the look at the flag this flight takes 4 million steps and 2 GB.
    let ended = std::thread::scope(|scope| {
        let flight = scope.spawn(|| simulate(&scenario, &interrupt));
        std::thread::sleep(std::time::Duration::from_millis(20));
        interrupt.store(true, Ordering::Relaxed);
        flight.join().unwrap()
    });
    assert!(matches!(ended, Err(SimulationError::Interrupted { time }) if time < 1e8));
}

#[test]
fn loads_beyond_all_numbers_are_an_error_and_not_infinity() {
    let dense = Case {
        atmosphere: Atmosphere::Exponential { surface_density: 1e300, scale_height: 1e9 },
        vehicle: vehicle(1e-10, 1e10, 0.0, 1.0),
        ..target_2()
    };
    assert_eq!(Scenario::new(dense).unwrap_err().0, [Fault::InfiniteAcceleration]);
}

/// What starts on the ground flies when it rises, and has landed when it does not.
#[test]
fn a_start_on_the_ground_flies_only_upward() {
    let on_ground = FlightPath {
        radius: 6_378_137.0,
        speed: 300.0,
        flight_path_angle: 0.5,
        ..FlightPath::from_planet_fixed(&target_2().initial_state)
    };
    let ballistic = Case { vehicle: vehicle(700.0, 0.216_419, 0.0, 0.2), ..target_2() };
    for above in [0.0, 0.9e-3, -0.9e-3] {
        let at = |flight_path_angle: f64, speed: f64| FlightPath {
            radius: 6_378_137.0 + above,
            speed,
            flight_path_angle,
            ..on_ground
        };
        let hop = fly(&starting(ballistic.clone(), at(0.5, 300.0)));
        assert!(hop.end_time() > 10.0, "{above}: {}", hop.end_time());
        near("back on the ground", hop.last().loads.altitude, 0.0, 1e-8);
        for landed in [at(-0.5, 300.0), at(0.0, 300.0), at(0.0, 0.0)] {
            let flight = fly(&starting(ballistic.clone(), landed));
            assert_eq!(flight.termination(), Termination::SurfaceImpact);
            near("at once", flight.end_time(), 0.0, 0.0);
        }
        // Level, but faster than a satellite: the ground falls away.
        let off = fly(&Case {
            stop: Stop { altitude: 0.0, time: 5.0, ..Stop::default() },
            ..in_vacuum(starting(ballistic.clone(), at(0.0, 9000.0)))
        });
        assert_eq!(off.termination(), Termination::TimeLimit, "{above}");
    }
    let below = FlightPath { radius: 6_378_136.99, ..on_ground };
    let faults = Scenario::new(starting(ballistic, below)).unwrap_err().0;
    assert!(matches!(faults[..], [Fault::BelowStopAltitude { .. }]), "{faults:?}");
}

/// At 1e-3 a step spans minutes, and its dense output is all that is left to find a peak by.
#[test]
fn peaks_are_found_between_rows_and_steps() {
    for tolerance in [1e-4, 1e-6, 1e-10] {
        let flight = fly(&with_tolerance(target_2(), tolerance));
        let end = flight.end_time();
        let times: Vec<_> = (0..=20_000).map(|i| end * f64::from(i) / 20_000.0).collect();
        let points = flight.points(&times);
        let peaks = flight.peaks();
        let greatest = |quantity: fn(&reentry::trajectory::FlightPoint) -> f64| {
            points.iter().map(quantity).fold(f64::NEG_INFINITY, f64::max)
        };
        for (peak, greatest) in [
            (peaks.deceleration, greatest(|point| point.loads.deceleration)),
            (peaks.load_factor, greatest(|point| point.loads.load_factor)),
            (peaks.dynamic_pressure, greatest(|point| point.loads.dynamic_pressure)),
            (peaks.altitude, greatest(|point| point.loads.altitude)),
        ] {
            assert!(peak.value >= greatest * (1.0 - 1e-12), "{tolerance:e}: {peak:?} is not {greatest}");
            // The rows are 8 ms apart; between them a load of some seconds' width rises by 1e-5 at most.
            relative(&format!("{tolerance:e}"), peak.value, greatest, 1e-5);
        }
        near(
            "the peak is where the rows say",
            flight.at(peaks.load_factor.time).loads.load_factor,
            peaks.load_factor.value,
            1e-9,
        );
    }
}

/// Where drag stops a light body within a fraction of a step, an explicit method is unstable: at loose tolerances the ends of its
/// steps still look acceptable while its dense output goes through the ground and out to infinity.
#[test]
fn light_bodies_stay_in_the_air_at_loose_tolerances() {
    let entry = FlightPath::from_planet_fixed(&target_2().initial_state);
    for (mass, area, altitude) in [(0.01, 1.0, 15e3), (0.001, 10.0, 30e3), (0.01, 10.0, 60e3), (1.0, 10.0, 100e3)] {
        for tolerance in [1e-3, 1e-4, 1e-5] {
            let state = FlightPath { radius: 6_378_137.0 + altitude, speed: 5000.0, flight_path_angle: -1.5, ..entry };
            let case = starting(Case { vehicle: vehicle(mass, area, 0.0, 1.0), ..target_2() }, state);
            let case = Case { stop: Stop { altitude: 0.0, time: 300.0, ..Stop::default() }, ..case };
            let flight = fly(&with_tolerance(case, tolerance));
            let times = flight.instants(&Sampling::PerStep(16), usize::MAX).unwrap();
            for point in flight.points(&times) {
                let what = format!("{mass} kg, {area} m², {tolerance:e} at {} s", point.time);
                assert!(point.is_finite(), "{what}");
                let high = point.loads.altitude;
                assert!((-1e-3..=altitude + 1.0).contains(&high), "{what}: {high} m");
            }
        }
    }
}

/// Level and faster than a satellite on the ground: whether rounding gives the altitude a tiny rate up or down must not matter.
#[test]
fn a_supercircular_level_start_flies_whatever_its_rounding() {
    for degrees in 0..100 {
        let state = FlightPath {
            radius: 6_378_137.0,
            longitude: f64::from(degrees) * 0.06,
            geocentric_latitude: f64::from(degrees) * 0.015 - 0.7,
            speed: 9000.0 + f64::from(degrees),
            flight_path_angle: 0.0,
            heading: f64::from(degrees) * 0.03,
        };
        let case = Case {
            stop: Stop { altitude: 0.0, time: 10.0, ..Stop::default() },
            ..in_vacuum(starting(target_2(), state))
        };
        assert_eq!(fly(&case).termination(), Termination::TimeLimit, "{state:?}");
    }
}
