//! A phase of a flight: what flies between two events.

use super::Case;
use crate::event::{Effect, Engine};
use crate::motion::{Burn, Forces};
use crate::parachute::{Canopies, Canopy};
use crate::propulsion::Thrust;
use crate::vehicle::Vehicle;

/// A part of the flight between two changes of the vehicle: its mass, thrust and parachutes from an instant on.
#[derive(Clone, Debug, PartialEq)]
pub struct Phase {
    /// The instant, s.
    pub since: f64,
    /// The vehicle, with its mass then.
    pub vehicle: Vehicle,
    /// The thrust that is on, with the propellant that is left then.
    pub thrust: Option<Thrust>,
    /// The parachutes that are deployed, whether they are open yet or not.
    pub canopies: Vec<Canopy>,
}

impl Phase {
    /// That in which a flight begins.
    pub fn first(case: &Case) -> Self {
        Self { since: 0.0, vehicle: case.vehicle.clone(), thrust: None, canopies: Vec::new() }
    }

    /// The mass at a time of the phase, kg.
    pub fn mass(&self, time: f64) -> f64 {
        self.vehicle.mass - self.burnt(time)
    }

    /// The propellant burnt up to a time of the phase, kg.
    fn burnt(&self, time: f64) -> f64 {
        self.thrust.map_or(0.0, |thrust| thrust.mass_flow() * (time - self.since))
    }

    /// The thrust that is on, with the propellant that is left at a time of the phase.
    fn thrust_left(&self, time: f64) -> Option<Thrust> {
        let left = |whole: f64| whole - self.burnt(time);
        self.thrust.map(|thrust| Thrust { propellant: thrust.propellant.map(left), ..thrust })
    }

    /// When the propellant is spent, s.
    pub fn burnout(&self) -> Option<f64> {
        let thrust = self.thrust?;
        Some(self.since + thrust.propellant? / thrust.mass_flow())
    }

    /// When nothing at all would be left, s.
    pub fn last_instant(&self) -> Option<f64> {
        let flow = self.thrust?.mass_flow();
        (flow > 0.0).then(|| self.since + self.vehicle.mass / flow)
    }

    /// When a canopy begins to fill, or is full, s, whichever comes next.
    pub fn next_inflation(&self) -> Option<f64> {
        self.canopies.iter().filter_map(Canopy::next_corner).reduce(f64::min)
    }

    /// The phase that begins with the effect of an event of this number at a time.
    #[must_use]
    pub fn after(&self, event: usize, effect: &Effect, time: f64) -> Self {
        let mass = effect.mass.unwrap_or_else(|| self.mass(time));
        let Vehicle { reference_area, aerodynamics, .. } = self.vehicle.with_mass(mass);
        let vehicle = Vehicle {
            reference_area: effect.reference_area.unwrap_or(reference_area),
            aerodynamics: effect.aerodynamics.clone().unwrap_or(aerodynamics),
            mass,
            ..self.vehicle
        };
        let thrust = match effect.engine {
            None => self.thrust_left(time),
            Some(Engine::On(thrust)) => Some(thrust).filter(|thrust| thrust.force != 0.0),
            Some(Engine::Off) => None,
        };
        let stays = |canopy: &&Canopy| !effect.release.contains(&canopy.event);
        let deployed = effect.deploy.map(|parachute| Canopy::new(event, parachute, time));
        let canopies = self.canopies.iter().filter(stays).copied().chain(deployed).collect();
        Self { since: time, vehicle, thrust, canopies }
    }

    /// The phase that begins where a canopy begins to fill, or is full.
    #[must_use]
    pub fn inflated(&self, time: f64) -> Self {
        let vehicle = self.vehicle.with_mass(self.mass(time));
        let canopies = self.canopies.iter().map(|canopy| canopy.at(time)).collect();
        Self { since: time, vehicle, thrust: self.thrust_left(time), canopies }
    }

    /// The phase that begins where the propellant is spent.
    #[must_use]
    pub fn burnt_out(&self, time: f64) -> Self {
        let spent = self.thrust.and_then(|thrust| thrust.propellant).unwrap_or(0.0);
        Self { since: time, vehicle: self.vehicle.with_mass(self.vehicle.mass - spent), thrust: None, ..self.clone() }
    }

    /// The forces on the vehicle.
    pub fn forces(&self, case: &Case) -> Forces {
        let burn = self.thrust.map(|thrust| Burn {
            along: thrust.along,
            since: self.since,
            acceleration: thrust.force / self.vehicle.mass,
            flow: thrust.mass_flow() / self.vehicle.mass,
        });
        let over_mass = self.vehicle.mass.recip();
        let canopies = Canopies::of(self.canopies.iter().map(|canopy| (*canopy, canopy.deployed)), over_mass);
        Forces::new(case.models_of(&self.vehicle), case.parameters_of(&self.vehicle))
            .of_mass(self.vehicle.mass)
            .burning(burn)
            .under(canopies)
    }
}
