//! Parts, engines, launch and separations against closed forms.

use std::sync::atomic::AtomicBool;

use nalgebra::Vector3;
use reentry::event::{Condition, Direction, Effect, Event, Quantity, Separation, Trigger};
use reentry::part::{Engine, Part, ThrustProfile};
use reentry::planet::{Gravity, Planet, Shape};
use reentry::scenario::{BodyCase, Case, Scenario, Stop};
use reentry::simulate::{Flights, simulate_with_bodies};
use reentry::steering::Steering;
use reentry::vehicle::{Aerodynamics, Vehicle};
use reentry::{Atmosphere, PlanetFixed};

/// A planet whose gravity is the same everywhere: 9.80665 m/s² to the millionth.
fn plain() -> Planet {
    let radius = 1e11;
    let gravitational_parameter = 9.806_65 * radius * radius;
    Planet {
        shape: Shape::Sphere { radius },
        gravity: Gravity::InverseSquare,
        gravitational_parameter,
        orbital_gravitational_parameter: gravitational_parameter,
        rotation_rate: 0.0,
    }
}

/// The stage of the rocket equation: 200 kg, 800 kg of propellant, 30 kN, 300 s.
fn stage() -> Part {
    let engine = Engine { thrust: ThrustProfile::Constant(30e3), specific_impulse: 300.0, exit_area: 0.0 };
    Part { count: 1, dry_mass: 200.0, propellant: 800.0, engine: Some(engine) }
}

fn at(time: f64, then: Effect) -> Event {
    Event { when: Condition { quantity: Quantity::Time, value: time, direction: Direction::Rising }.into(), then }
}

fn case(planet: Planet, parts: Vec<Part>) -> Case {
    let mass = parts.iter().map(Part::mass).sum();
    let aerodynamics = Aerodynamics::Constant { lift_coefficient: 0.0, drag_coefficient: 0.0 };
    let vehicle = Vehicle { mass, reference_area: 1.0, aerodynamics, nose_radius: None };
    let start =
        PlanetFixed { position: Vector3::new(planet.equatorial_radius(), 0.0, 0.0), velocity: Vector3::zeros() };
    Case {
        planet,
        atmosphere: Atmosphere::Vacuum,
        parts,
        steering: Steering::Vertical,
        hold_down: true,
        ..Case::new(vehicle, start)
    }
}

fn lift_off() -> Event {
    let when = Condition { quantity: Quantity::UpwardAcceleration, value: 0.0, direction: Direction::Rising };
    Event { when: when.into(), then: Effect { lift_off: true, ..Effect::default() } }
}

fn fly(case: Case) -> Flights {
    simulate_with_bodies(&Scenario::new(case).unwrap(), &AtomicBool::new(false)).unwrap()
}

#[test]
fn a_vertical_ascent_loses_what_gravity_takes() {
    let events = vec![at(0.0, Effect { ignite: vec![0], ..Effect::default() }), lift_off()];
    let stop = Stop { when: vec![Trigger::AfterBurnout { part: 0, delay: 0.0 }], ..Stop::default() };
    let flights = fly(Case { events, stop, ..case(plain(), vec![stage()]) });
    let end = flights.vehicle.last();
    // c ln(m₀/m₁) - g t_b
    assert!((end.time - 78.4532).abs() < 1e-9, "{}", end.time);
    assert!((end.loads.speed - 3_965.595_217).abs() < 1e-3, "{}", end.loads.speed);
    assert!((end.mass - 200.0).abs() < 1e-9);
}

#[test]
fn a_body_that_leaves_flies_as_one_that_starts_there() {
    let parts = vec![stage(), Part { count: 1, dry_mass: 50.0, propellant: 0.0, engine: None }];
    let separation = Separation { parts: vec![0], push: None, body: 0 };
    let drop = Effect { separate: vec![separation], ..Effect::default() };
    let events = vec![
        at(0.0, Effect { ignite: vec![0], ..Effect::default() }),
        lift_off(),
        Event { when: Trigger::AfterBurnout { part: 0, delay: 3.0 }, then: drop },
    ];
    let of_body = Case { hold_down: false, ..case(plain(), vec![stage()]) };
    let bodies = vec![BodyCase { case: of_body, stop_time: None }];
    let flights = fly(Case { events, bodies, ..case(plain(), parts) });
    assert_eq!(flights.bodies.len(), 1);
    let [body, vehicle] = [flights.bodies[0].trajectory.last(), flights.vehicle.last()];
    assert!((body.mass - 200.0).abs() < 1e-9 && (vehicle.mass - 50.0).abs() < 1e-9);
    assert!((body.time - vehicle.time).abs() < 1e-6, "{} {}", body.time, vehicle.time);
}
