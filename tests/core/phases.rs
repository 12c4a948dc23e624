//! The phases of a flight, between the events that change the vehicle, and their peaks.

use reentry::event::{Condition, Direction, Effect, Event, Quantity, ThrustCommand, Trigger};
use reentry::heating::{Heating, Radiative};
use reentry::parachute::Parachute;
use reentry::propulsion::{Impulse, Thrust, ThrustAxis};
use reentry::trajectory::{FlightPhase, FlightPoint, Peak, PhaseStart};
use reentry::{Aerodynamics, Case, Stop, Trajectory, Vehicle};

use crate::check::{near, relative};
use crate::core::flights::{capsule, fly, spherical};

fn falls(quantity: Quantity, value: f64) -> Trigger {
    Condition { quantity, value, direction: Direction::Falling }.into()
}

fn at(time: f64) -> Trigger {
    Condition { quantity: Quantity::Time, value: time, direction: Direction::Rising }.into()
}

fn mass(mass: f64) -> Effect {
    Effect { mass: Some(mass), ..Effect::default() }
}

fn parachute() -> Effect {
    let aerodynamics = Some(Aerodynamics::Constant { lift_coefficient: 0.0, drag_coefficient: 0.7 });
    Effect { mass: Some(2500.0), reference_area: Some(100.0), aerodynamics, ..Effect::default() }
}

fn impulse(speed_change: f64) -> Effect {
    Effect { impulse: Some(Impulse { along: ThrustAxis::Velocity, speed_change }), ..Effect::default() }
}

fn thrust(force: f64, propellant: Option<f64>) -> Effect {
    let thrust = Thrust { along: ThrustAxis::Velocity, force, specific_impulse: Some(300.0), propellant };
    Effect { thrust: Some(ThrustCommand::On(thrust)), ..Effect::default() }
}

/// The capsule with a heat shield.
fn heated() -> Case {
    Case {
        vehicle: Vehicle { nose_radius: Some(1.0), ..capsule().vehicle },
        heating: Some(Heating { radiative: Radiative::TauberSutton, ..Heating::default() }),
        ..capsule()
    }
}

fn with(events: Vec<Event>) -> Case {
    Case { events, ..heated() }
}

fn starts(flight: &Trajectory) -> Vec<PhaseStart> {
    flight.phases().iter().map(|phase| phase.from).collect()
}

type Value = fn(&FlightPoint) -> f64;

/// Every peak, and the value of which it is the greatest.
fn peaks(phase: &FlightPhase) -> [(&'static str, Peak, Value); 11] {
    let peaks = &phase.peaks;
    let heating = peaks.heating.unwrap();
    [
        ("deceleration", peaks.deceleration, |point| point.loads.deceleration),
        ("load factor", peaks.load_factor, |point| point.loads.load_factor),
        ("dynamic pressure", peaks.dynamic_pressure, |point| point.loads.dynamic_pressure),
        ("altitude", peaks.altitude, |point| point.loads.altitude),
        ("speed", peaks.speed, |point| point.flight_path.speed),
        ("mach", peaks.mach.unwrap(), |point| point.loads.mach.unwrap()),
        ("convection", heating.convective_heat_flux, |point| point.loads.heat_flux.unwrap().convective),
        ("radiation", heating.radiative_heat_flux, |point| point.loads.heat_flux.unwrap().radiative),
        ("heat flux", heating.heat_flux, |point| point.loads.heat_flux.unwrap().total()),
        ("heat load", heating.heat_load, |point| point.heat_load.unwrap()),
        ("wall temperature", heating.wall_temperature, |point| point.wall_temperature.unwrap()),
    ]
}

/// The states of a phase: dense rows, and its ends, on its own sides of the changes.
fn states(flight: &Trajectory, phase: &FlightPhase) -> Vec<FlightPoint> {
    let instant = |row: i32| phase.since + (phase.until - phase.since) * f64::from(row) / 20_000.0;
    let mut states = flight.points(&(0..20_000).map(instant).collect::<Vec<_>>());
    let here = |time: f64, of: f64| time.to_bits() == of.to_bits();
    let events: Vec<_> = flight.events().collect();
    states.extend(events.iter().rfind(|event| here(event.after.time, phase.since)).map(|event| event.after));
    states.extend(events.iter().find(|event| here(event.before.time, phase.until)).map(|event| event.before));
    if here(phase.until, flight.end_time()) && phase.since < phase.until {
        states.push(flight.last());
    }
    states
}

/// An engine that brakes and burns out, an impulse, a mark, a part that is dropped, and a parachute: each peak of each phase is the
/// greatest value of dense rows.
#[test]
fn the_peaks_of_a_phase_are_the_greatest_values_in_it() {
    let events = vec![
        Event { when: falls(Quantity::Altitude, 115e3), then: thrust(-5000.0, Some(30.0)) },
        Event { when: falls(Quantity::Altitude, 90e3), then: impulse(-20.0) },
        Event { when: falls(Quantity::Altitude, 80e3), then: Effect::default() },
        Event { when: falls(Quantity::Altitude, 45e3), then: mass(2800.0) },
        Event { when: falls(Quantity::Mach, 0.9), then: parachute() },
    ];
    for case in [with(events.clone()), spherical(with(events))] {
        let flight = fly(&case);
        let phases = flight.phases();
        let expected = [
            PhaseStart::Start,
            PhaseStart::Event(0),
            PhaseStart::Burnout(0),
            PhaseStart::Event(3),
            PhaseStart::Event(4),
        ];
        assert_eq!(starts(&flight), expected);
        assert_eq!(phases[0].since.to_bits(), 0);
        assert_eq!(phases[4].until.to_bits(), flight.end_time().to_bits());
        assert!(phases.windows(2).all(|pair| pair[0].until.to_bits() == pair[1].since.to_bits()));
        relative("burnout", phases[2].since - phases[1].since, 30.0 * 9.806_65 * 300.0 / 5000.0, 1e-9);
        for phase in &phases {
            let states = states(&flight, phase);
            for (what, peak, value) in peaks(phase) {
                let greatest = states.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
                let what = format!("{what} from {:?} on", phase.from);
                let size = greatest.abs().max(1e-6);
                assert!(peak.value >= greatest - 1e-9 * size, "{what}: {} is below {greatest}", peak.value);
                near(&what, peak.value, greatest, 1e-4 * size);
                assert!((phase.since..=phase.until).contains(&peak.time), "{what} at {} s", peak.time);
            }
        }
        // Of the flight they are the greatest of those of the phases, and what opens at once hides no peak of the entry.
        let whole = flight.peaks();
        let greatest = |of: fn(&FlightPhase) -> Peak| {
            phases.iter().map(of).reduce(|a, b| if b.value > a.value { b } else { a }).unwrap()
        };
        assert_eq!(whole.load_factor, greatest(|phase| phase.peaks.load_factor));
        assert_eq!(whole.load_factor, phases[4].peaks.load_factor);
        assert_eq!(whole.load_factor.time.to_bits(), phases[4].since.to_bits());
        assert_eq!(whole.speed, greatest(|phase| phase.peaks.speed));
        assert_eq!(whole.altitude, phases[0].peaks.altitude);
        assert_eq!(whole.heating.unwrap().heat_load, phases[4].peaks.heating.unwrap().heat_load);
        assert!(phases[3].peaks.load_factor.value > 5.0 && phases[3].peaks.load_factor.time < phases[4].since - 10.0);
    }
}

/// A flight of which the vehicle stays the same is one phase, whatever else happens; its peaks are those of the flight.
#[test]
fn marks_and_impulses_begin_no_phase() {
    for events in
        [vec![], vec![Event { when: at(50.0), then: Effect::default() }, Event { when: at(60.0), then: impulse(5.0) }]]
    {
        let flight = fly(&with(events));
        let [phase] = flight.phases()[..] else { panic!("{:?}", starts(&flight)) };
        assert_eq!((phase.from, phase.since.to_bits(), phase.until), (PhaseStart::Start, 0, flight.end_time()));
        assert_eq!(phase.peaks, *flight.peaks());
    }
}

/// Of several events at one instant the last begins the phase, also where an impulse or a mark follows it; between them there is nothing.
#[test]
fn events_of_one_instant_begin_one_phase() {
    let list = [mass(2900.0), parachute(), impulse(1.0), Effect::default()];
    let flight = fly(&with(list.map(|then| Event { when: at(200.0), then }).to_vec()));
    assert_eq!(flight.events().count(), 4);
    assert_eq!(starts(&flight), [PhaseStart::Start, PhaseStart::Event(1)]);
    let after = flight.events().last().unwrap().after;
    assert!(flight.phases()[1].peaks.load_factor.value >= after.loads.load_factor);
    // An engine whose propellant is spent when another event happens: the event has the last word.
    let burn = 30.0 * 9.806_65 * 300.0 / 5000.0;
    let list = vec![
        Event { when: at(10.0), then: thrust(-5000.0, Some(30.0)) },
        Event { when: at(10.0 + burn), then: mass(2000.0) },
    ];
    let flight = fly(&with(list));
    assert_eq!(starts(&flight), [PhaseStart::Start, PhaseStart::Event(0), PhaseStart::Event(1)]);
    // One engine after the other: each burnout names its own.
    let list = vec![
        Event { when: at(10.0), then: thrust(-5000.0, Some(30.0)) },
        Event { when: at(100.0), then: thrust(-5000.0, Some(20.0)) },
        Event { when: at(120.0), then: Effect { thrust: Some(ThrustCommand::Off), ..Effect::default() } },
    ];
    let flight = fly(&with(list));
    let expected = [
        PhaseStart::Start,
        PhaseStart::Event(0),
        PhaseStart::Burnout(0),
        PhaseStart::Event(1),
        PhaseStart::Burnout(1),
        PhaseStart::Event(2),
    ];
    assert_eq!(starts(&flight), expected);
}

/// At the start and at the end a phase may have no length: what holds there, as given or after all that happens, counts in the peaks of the flight.
#[test]
fn what_changes_at_the_start_or_at_the_end_has_a_phase() {
    let flight = fly(&with(vec![Event { when: at(0.0), then: mass(300.0) }]));
    let [given, flown] = flight.phases()[..] else { panic!("{:?}", starts(&flight)) };
    assert_eq!((given.since.to_bits(), given.until.to_bits(), flown.since.to_bits()), (0, 0, 0));
    assert_eq!(flown.from, PhaseStart::Event(0));
    let initial = flight.initial().loads;
    assert_eq!(given.peaks.load_factor.value.to_bits(), initial.load_factor.to_bits());
    assert_eq!(given.peaks.altitude, flown.peaks.altitude);

    let mach = falls(Quantity::Mach, 0.9);
    let stop = Stop { when: vec![mach], ..Stop::default() };
    let flight = fly(&Case { stop, ..with(vec![Event { when: mach, then: parachute() }]) });
    let [flown, opened] = flight.phases()[..] else { panic!("{:?}", starts(&flight)) };
    assert_eq!((opened.from, opened.since, opened.until), (PhaseStart::Event(0), flight.end_time(), flight.end_time()));
    let last = flight.last();
    for (what, peak, value) in peaks(&opened) {
        near(what, peak.value, value(&last), 1e-12 * value(&last).abs());
    }
    assert!(flown.peaks.load_factor.value < opened.peaks.load_factor.value);
    assert_eq!(flight.peaks().load_factor, opened.peaks.load_factor);
}

/// A parachute that fills belongs to the event that deploys it, from there on: neither the delay nor the inflation begins a phase of its own.
#[test]
fn a_parachute_that_fills_begins_one_phase() {
    let parachute = Parachute { drag_area: 70.0, inflation_time: 4.0, delay: 2.0 };
    let deploy = Effect { deploy: Some(parachute), ..Effect::default() };
    let release = Effect { release: vec![0], ..Effect::default() };
    let flight = fly(&with(vec![
        Event { when: falls(Quantity::Mach, 0.9), then: deploy },
        Event { when: falls(Quantity::Altitude, 5e3), then: release },
    ]));
    assert_eq!(starts(&flight), [PhaseStart::Start, PhaseStart::Event(0), PhaseStart::Event(1)]);
    let phase = flight.phases()[1];
    let states = states(&flight, &phase);
    for (what, peak, value) in peaks(&phase) {
        let greatest = states.iter().map(value).fold(f64::NEG_INFINITY, f64::max);
        assert!(peak.value >= greatest - 1e-9 * greatest.abs(), "{what}: {} is below {greatest}", peak.value);
        near(what, peak.value, greatest, 1e-4 * greatest.abs().max(1e-6));
    }
    let filling = phase.since + 2.0..phase.since + 6.0;
    assert!(filling.contains(&phase.peaks.load_factor.time), "{} s", phase.peaks.load_factor.time);
}
