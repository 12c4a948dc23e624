//! Flights that start at another time than 0, as those of bodies that are set free on the way.

use std::sync::Arc;

use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::event::{Condition, Direction, Effect, Event, Quantity, ThrustCommand};
use reentry::propulsion::{Thrust, ThrustAxis};
use reentry::trajectory::Sampling;
use reentry::{Case, Control, Stop};

use super::flights::{fly, in_vacuum, miss, spherical, target_2, with_tolerance};

/// TARGET case 2 with everything that goes by the time: a schedule, an event, a thrust along an axis in inertial space.
fn by_the_clock() -> Case {
    let schedule = Schedule::new(Against::Time, &[0.0, 30.0, 50.0], &[0.3, 1.1, -0.4], Interpolation::Linear).unwrap();
    let at_60 = Condition { quantity: Quantity::Time, value: 60.0, direction: Direction::Rising };
    let along = ThrustAxis::inertial([1.0, -2.0, 0.7]).unwrap();
    let thrust = Thrust { along, force: 3000.0, specific_impulse: Some(250.0), propellant: Some(20.0) };
    let then = Effect { thrust: Some(ThrustCommand::On(thrust)), ..Effect::default() };
    Case {
        control: Control { bank_angle: Command::Schedule(Arc::new(schedule)), ..Control::banked(0.0) },
        events: vec![Event { when: at_60.into(), then }],
        ..with_tolerance(target_2(), 1e-12)
    }
}

/// A flight that takes up another on its way ends as that one: nothing is measured from its own start but what is said to be.
#[test]
fn a_flight_may_be_taken_up_on_its_way() {
    for case in [by_the_clock(), spherical(by_the_clock())] {
        let whole = fly(&case);
        for start_time in [0.0, 12.5, 40.0] {
            let initial_state = whole.at(start_time).flight_path.to_planet_fixed();
            let rest = fly(&Case { start_time, initial_state, ..case.clone() });
            assert_eq!(rest.initial().time.to_bits(), start_time.to_bits());
            // Both are good to a millimetre at 1e-12.
            assert!(miss(&whole, &rest) < 1e-3, "from {start_time} s: {} m", miss(&whole, &rest));
            assert!((whole.end_time() - rest.end_time()).abs() < 1e-6);
            let [one, other] = [&whole, &rest].map(|flight| flight.peaks().dynamic_pressure);
            assert!((one.time - other.time).abs() < 1e-3 && (one.value / other.value - 1.0).abs() < 1e-9);
            let [one, other] = [&whole, &rest].map(|flight| flight.last().ground_distance);
            let flown = whole.at(start_time).ground_distance;
            assert!((one - flown - other).abs() < 1e-2, "{one} m, {flown} m and {other} m over the ground");
        }
    }
}

#[test]
fn rows_lie_between_the_start_and_the_end() {
    let case = Case { start_time: 12.5, stop: Stop { time: 32.5, ..Stop::default() }, ..in_vacuum(target_2()) };
    let flight = fly(&case);
    let rows = |sampling: Sampling| flight.instants(&sampling, 100).unwrap();
    assert_eq!(rows(Sampling::Count(5)), [12.5, 17.5, 22.5, 27.5, 32.5]);
    // On the clock of the vehicle, whose rows they stand beside.
    assert_eq!(rows(Sampling::Interval(8.0)), [12.5, 16.0, 24.0, 32.0, 32.5]);
    assert_eq!(rows(Sampling::Times(vec![5.0, 20.0, 40.0])), [12.5, 20.0, 32.5]);
    let per_step = rows(Sampling::PerStep(1));
    assert_eq!((per_step[0], *per_step.last().unwrap()), (12.5, 32.5));
    assert_eq!(flight.at(3.0), flight.initial(), "before its start there is its start");
}
