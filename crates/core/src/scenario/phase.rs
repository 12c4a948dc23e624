//! A phase of a flight: what flies between two changes of the vehicle.

use std::sync::Arc;

use super::{Case, Numbers};
use crate::event::{Effect, Engine};
use crate::motion::{Burn, Forces, Models};
use crate::parachute::{Canopies, Canopy, Parachute};
use crate::propulsion::Thrust;
use crate::scalar::Scalar;
use crate::vehicle::{Aerodynamics, Vehicle};

/// A part of the flight between two changes of the vehicle: its mass, thrust and parachutes from an instant on.
///
/// Its numbers are those of [`Numbers`]: plain where it is flown, with derivatives where its sensitivities are followed.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Phase<P = f64> {
    /// The instant, s.
    pub(crate) since: P,
    /// The vehicle, with its mass then.
    pub(crate) vehicle: Vehicle<P>,
    /// The event that gave the vehicle its aerodynamics; none where it has those of the start.
    pub(crate) aerodynamics_of: Option<usize>,
    /// The thrust that is on, with the propellant that is left then.
    pub(crate) thrust: Option<Thrust<P>>,
    /// The event that switched the thrust on.
    pub(crate) thrust_of: Option<usize>,
    /// The parachutes that are deployed, whether they are open yet or not.
    pub(crate) canopies: Vec<Canopy<P>>,
    /// When the events happened since which the bank angle and the angle of attack run, s; none where they have not, or where there are none.
    pub(crate) origins: [Option<P>; 2],
}

/// The vehicle of the start.
fn vehicle<P: Scalar>(numbers: &impl Numbers<P>) -> Vehicle<P> {
    Vehicle {
        mass: numbers.number(|case| case.vehicle.mass),
        reference_area: numbers.number(|case| case.vehicle.reference_area),
        aerodynamics: varied_aerodynamics(numbers, |case| &case.vehicle.aerodynamics),
        nose_radius: numbers.case().vehicle.nose_radius,
    }
}

/// The aerodynamics at a place of the case.
fn varied_aerodynamics<P: Scalar>(numbers: &impl Numbers<P>, of: impl Fn(&Case) -> &Aerodynamics) -> Aerodynamics<P> {
    let [first, second] = [0, 1].map(|index| numbers.number(|case| of(case).numbers()[index]));
    match of(numbers.case()) {
        Aerodynamics::Constant { .. } => Aerodynamics::Constant { lift_coefficient: first, drag_coefficient: second },
        Aerodynamics::Ballistic { .. } => {
            Aerodynamics::Ballistic { ballistic_coefficient: first, lift_to_drag: second }
        }
        Aerodynamics::MachTable(table) => Aerodynamics::MachTable(Arc::clone(table)),
        Aerodynamics::AlphaMachTable(table) => Aerodynamics::AlphaMachTable(Arc::clone(table)),
    }
}

impl<P: Scalar<Value = f64, Mask = bool>> Phase<P> {
    /// That in which a flight begins.
    pub(crate) fn first(numbers: &impl Numbers<P>) -> Self {
        Self {
            since: P::from(numbers.case().start_time),
            vehicle: vehicle(numbers),
            aerodynamics_of: None,
            thrust: None,
            thrust_of: None,
            canopies: Vec::new(),
            origins: [None; 2],
        }
    }

    /// The same in other numbers.
    pub(crate) fn map<Q>(&self, number: impl Fn(P) -> Q + Copy) -> Phase<Q> {
        Phase {
            since: number(self.since),
            vehicle: self.vehicle.map(number),
            aerodynamics_of: self.aerodynamics_of,
            thrust: self.thrust.map(|thrust| thrust.map(number)),
            thrust_of: self.thrust_of,
            canopies: self.canopies.iter().map(|canopy| canopy.map(number)).collect(),
            origins: self.origins.map(|origin| origin.map(number)),
        }
    }

    /// The thrust that is on, with the propellant that is left when the vehicle has a mass, kg.
    fn thrust_left(&self, mass: P) -> Option<Thrust<P>> {
        let left = |whole: P| whole - (self.vehicle.mass - mass);
        self.thrust.map(|thrust| Thrust { propellant: thrust.propellant.map(left), ..thrust })
    }

    /// Whether nothing changes in it by time alone.
    pub(crate) fn is_still(&self) -> bool {
        self.thrust.is_none() && self.canopies.is_empty()
    }

    /// When the propellant is spent, s.
    pub(crate) fn burnout(&self) -> Option<P> {
        let thrust = self.thrust?;
        Some(self.since + thrust.propellant? * thrust.mass_flow().recip())
    }

    /// When nothing at all would be left, s.
    pub(crate) fn last_instant(&self) -> Option<P> {
        let flow = self.thrust?.mass_flow();
        (flow.value() > 0.0).then(|| self.since + self.vehicle.mass * flow.recip())
    }

    /// When a canopy begins to fill, or is full, s, whichever comes next.
    pub(crate) fn next_inflation(&self) -> Option<P> {
        let corners = self.canopies.iter().filter_map(Canopy::next_corner);
        corners.min_by(|a, b| a.value().total_cmp(&b.value()))
    }

    /// The phase that begins with the effect of an event at a time, before which the vehicle has a mass, kg.
    #[must_use]
    pub(crate) fn after(&self, event: usize, numbers: &impl Numbers<P>, time: P, mass: P) -> Self {
        let effect = &numbers.case().events[event].then;
        let number = |of: fn(&Effect) -> Option<f64>| {
            of(effect)?;
            Some(numbers.number(|case| of(&case.events[event].then).unwrap_or_default()))
        };
        let thrust_left = self.thrust_left(mass);
        let mass = number(|effect| effect.mass).unwrap_or(mass);
        let Vehicle { reference_area, aerodynamics, .. } = self.vehicle.with_mass(mass);
        let vehicle = Vehicle {
            reference_area: number(|effect| effect.reference_area).unwrap_or(reference_area),
            aerodynamics: match effect.aerodynamics {
                Some(_) => varied_aerodynamics(numbers, |case| {
                    case.events[event].then.aerodynamics.as_ref().unwrap_or(&case.vehicle.aerodynamics)
                }),
                None => aerodynamics,
            },
            mass,
            ..self.vehicle
        };
        let (thrust, thrust_of) = match effect.engine {
            None => (thrust_left, self.thrust_of),
            Some(Engine::On(Thrust { force: 0.0, .. }) | Engine::Off) => (None, None),
            Some(Engine::On(Thrust { along, .. })) => {
                let force = number(|effect| effect.thrust().map(|thrust| thrust.force)).unwrap_or_else(P::zero);
                let specific_impulse = number(|effect| effect.thrust()?.specific_impulse);
                let propellant = number(|effect| effect.thrust()?.propellant);
                (Some(Thrust { along, force, specific_impulse, propellant }), Some(event))
            }
        };
        let stays = |canopy: &&Canopy<P>| !effect.release.contains(&canopy.event);
        let deployed = effect.deploy.map(|_| {
            let of = |number_of: fn(&Parachute) -> f64| {
                numbers.number(|case| case.events[event].then.deploy.as_ref().map_or(0.0, number_of))
            };
            let parachute = Parachute {
                drag_area: of(|parachute| parachute.drag_area),
                inflation_time: of(|parachute| parachute.inflation_time),
                delay: of(|parachute| parachute.delay),
            };
            Canopy::new(event, parachute, time)
        });
        let canopies = self.canopies.iter().filter(stays).copied().chain(deployed).collect();
        let aerodynamics_of = effect.aerodynamics.as_ref().map(|_| event).or(self.aerodynamics_of);
        let [bank_angle, angle_of_attack] =
            numbers.case().control.commands().map(|command| command.event() == Some(event));
        let origin = |begins: bool, before: Option<P>| if begins { Some(time) } else { before };
        let origins = [origin(bank_angle, self.origins[0]), origin(angle_of_attack, self.origins[1])];
        Self { since: time, vehicle, aerodynamics_of, thrust, thrust_of, canopies, origins }
    }

    /// When time alone changes something next, s: the propellant is spent, or a canopy begins to fill or is full.
    pub(crate) fn next_change(&self) -> Option<P> {
        let instants = [self.burnout(), self.next_inflation()].into_iter().flatten();
        instants.min_by(|a, b| a.value().total_cmp(&b.value()))
    }

    /// The phase that begins with the [next change](Self::next_change) by time alone, when the vehicle has a mass, kg.
    #[must_use]
    pub(crate) fn after_next_change(&self, time: P, mass: P) -> Self {
        match (self.burnout(), self.next_inflation()) {
            (Some(burnout), Some(inflation)) if inflation.value() < burnout.value() => self.inflated(time, mass),
            (Some(_), _) => self.burnt_out(time),
            (None, _) => self.inflated(time, mass),
        }
    }

    /// The phase that begins where a canopy begins to fill, or is full.
    fn inflated(&self, time: P, mass: P) -> Self {
        let vehicle = self.vehicle.with_mass(mass);
        let canopies = self.canopies.iter().map(|canopy| canopy.at(time)).collect();
        Self { since: time, vehicle, thrust: self.thrust_left(mass), canopies, ..self.clone() }
    }

    /// The phase that begins where the propellant is spent.
    fn burnt_out(&self, time: P) -> Self {
        let spent = self.thrust.and_then(|thrust| thrust.propellant).unwrap_or_else(P::zero);
        let vehicle = self.vehicle.with_mass(self.vehicle.mass - spent);
        Self { since: time, vehicle, thrust: None, thrust_of: None, ..self.clone() }
    }

    /// The same, with the models that another case has in the place of those from which this phase has its own: tables and axes. The
    /// numbers stay.
    pub(crate) fn with_models_of(&self, case: &Case) -> Self {
        let mut phase = self.clone();
        let aerodynamics = match self.aerodynamics_of {
            None => Some(&case.vehicle.aerodynamics),
            Some(event) => case.events[event].then.aerodynamics.as_ref(),
        };
        match aerodynamics {
            Some(Aerodynamics::MachTable(table)) => {
                phase.vehicle.aerodynamics = Aerodynamics::MachTable(Arc::clone(table));
            }
            Some(Aerodynamics::AlphaMachTable(table)) => {
                phase.vehicle.aerodynamics = Aerodynamics::AlphaMachTable(Arc::clone(table));
            }
            Some(Aerodynamics::Constant { .. } | Aerodynamics::Ballistic { .. }) | None => {}
        }
        phase.vehicle.nose_radius = case.vehicle.nose_radius;
        let axis = self.thrust_of.and_then(|event| Some(case.events[event].then.thrust()?.along));
        if let (Some(thrust), Some(along)) = (&mut phase.thrust, axis) {
            thrust.along = along;
        }
        phase
    }

    /// The forces on the vehicle.
    pub(crate) fn forces(&self, numbers: &impl Numbers<P>) -> Forces<P> {
        self.forces_by(numbers.case(), numbers)
    }

    /// The forces on the vehicle by the models of a case, which may be another than that of the numbers.
    pub(crate) fn forces_by(&self, models_of: &Case, numbers: &impl Numbers<P>) -> Forces<P> {
        let over_mass = self.vehicle.mass.recip();
        let burn = self.thrust.map(|thrust| Burn {
            along: thrust.along,
            acceleration: thrust.force * over_mass,
            mass_flow: thrust.mass_flow(),
        });
        let [lift, drag, bank] = numbers.offsets();
        // Those of the coefficients belong to the vehicle of the start.
        let offsets = if self.aerodynamics_of.is_none() { [lift, drag, bank] } else { [P::zero(), P::zero(), bank] };
        let models = models_of.models_of(&self.vehicle);
        let control = models.control.since(self.origins.map(|origin| origin.map(P::value)));
        Forces::new(Models { control, ..models }, Case::parameters_of(numbers, &self.vehicle, offsets))
            .lagging(self.origins.map(|origin| origin.map_or_else(P::zero, |time| time - time.value())))
            .of_mass(self.vehicle.mass)
            .burning(burn)
            .under(Canopies::of(&self.canopies, over_mass))
    }
}
