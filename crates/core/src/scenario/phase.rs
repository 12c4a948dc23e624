//! A phase of a flight: what flies between two changes of the vehicle.

use std::sync::Arc;

use super::{Case, Numbers};
use crate::control::Command;
use crate::event::{Effect, ThrustCommand};
use crate::motion::{Burn, Forces, Models, ThrustDirection};
use crate::parachute::{Canopies, Canopy, Parachute};
use crate::part::{Engine, Part, ThrustEntry, ThrustPiece};
use crate::propulsion::{STANDARD_GRAVITY, Thrust};
use crate::scalar::Scalar;
use crate::steering::Steering;
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
    /// With what it begins.
    pub(crate) cause: Change,
    /// Whether the vehicle is held on the ground.
    pub(crate) held: bool,
    /// Those of the case, in its order.
    pub(crate) parts: Vec<PartState<P>>,
    /// The load factor that throttles the engines, m/s²: times standard gravity.
    pub(crate) load_limit: Option<P>,
    /// Where the axis of the vehicle points.
    pub(crate) steering: Steering,
    /// The event that steers so; none where it is the case.
    pub(crate) steering_of: Option<usize>,
    /// The events since which angles run, by their places in the list, that have happened, and when, s.
    pub(crate) origins: Vec<(usize, P)>,
}

/// With what a phase begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// With the flight.
    Start,
    /// With the effect of an event, by its place in the list of the case.
    Event(usize),
    /// The propellant of a thrust is spent.
    ThrustEnds,
    /// A canopy begins to fill, or is full.
    Inflation,
    /// The thrust of a part, by its place in the list, goes on along the next straight piece of its profile.
    NextPiece(usize),
    /// A part, by its place in the list, has burnt out.
    Burnout(usize),
}

/// A part of the vehicle in a phase; all of its count together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PartState<P = f64> {
    /// Whether it has not been separated.
    pub(crate) is_there: bool,
    /// kg.
    pub(crate) dry_mass: P,
    /// When the phase begins, kg.
    pub(crate) propellant: P,
    /// From 0 to 1.
    pub(crate) throttle: P,
    /// The thrust of its engine, while it is lit.
    pub(crate) burn: Option<ThrustPiece<P>>,
}

impl<P: Scalar<Value = f64, Mask = bool>> PartState<P> {
    /// That of a case when the flight starts.
    fn first(numbers: &impl Numbers<P>, part: usize) -> Self {
        let of_all =
            |of: fn(&Part) -> f64| numbers.number(|case| f64::from(case.parts[part].count) * of(&case.parts[part]));
        Self {
            is_there: true,
            dry_mass: of_all(|part| part.dry_mass),
            propellant: of_all(|part| part.propellant),
            throttle: P::one(),
            burn: None,
        }
    }

    /// The same in other numbers.
    fn map<Q>(&self, number: impl Fn(P) -> Q + Copy) -> PartState<Q> {
        PartState {
            is_there: self.is_there,
            dry_mass: number(self.dry_mass),
            propellant: number(self.propellant),
            throttle: number(self.throttle),
            burn: self.burn.map(|burn| burn.map(number)),
        }
    }

    /// The thrust in vacuum where the phase begins, N.
    fn thrust(&self) -> P {
        self.burn.map_or(P::zero(), |burn| burn.thrust * self.throttle)
    }

    /// Its mass flow where the phase begins, kg/s.
    fn mass_flow(&self) -> P {
        self.burn.map_or(P::zero(), |burn| burn.thrust * self.throttle * burn.mass_flow_of_unit)
    }

    /// The time after which its propellant is spent, s, where no load limit throttles it.
    fn time_to_burnout(&self) -> Option<P> {
        self.burn?.time_to_burn(self.propellant, self.throttle)
    }

    /// The piece of its profile of a number, lit at a time, s.
    fn piece(numbers: &impl Numbers<P>, part: usize, ignition: P, number: usize) -> Option<ThrustPiece<P>> {
        let engine = numbers.case().parts[part].engine.as_ref()?;
        let entry = |number: usize, of: fn(ThrustEntry) -> f64| {
            numbers.number(|case| {
                let engine = case.parts[part].engine.as_ref();
                engine.and_then(|engine| engine.thrust.entry(number)).map_or(0.0, of)
            })
        };
        let of_engine =
            |of: fn(&Engine) -> f64| numbers.number(|case| case.parts[part].engine.as_ref().map_or(0.0, of));
        let count = f64::from(numbers.case().parts[part].count);
        engine.thrust.entry(number)?;
        let [thrust, time] = [entry(number, |entry| entry.thrust) * count, entry(number, |entry| entry.time)];
        let next = number + 1;
        let (rate, until) = if engine.thrust.entry(next).is_some() {
            let [then, end] = [entry(next, |entry| entry.thrust) * count, entry(next, |entry| entry.time)];
            ((then - thrust) * (end - time).recip(), Some(ignition + end))
        } else {
            (P::zero(), None)
        };
        let mass_flow_of_unit = of_engine(|engine| Engine::mass_flow_of_unit(engine.specific_impulse));
        let exit_area = of_engine(|engine| engine.exit_area) * count;
        Some(ThrustPiece { ignition, number, thrust, rate, until, mass_flow_of_unit, exit_area })
    }
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
            cause: Change::Start,
            held: numbers.case().hold_down,
            parts: (0..numbers.case().parts.len()).map(|part| PartState::first(numbers, part)).collect(),
            load_limit: None,
            steering: numbers.case().steering.clone(),
            steering_of: None,
            origins: Vec::new(),
        }
        .weighed()
    }

    /// The same with the mass of its parts, if it has any.
    fn weighed(self) -> Self {
        if self.parts.is_empty() {
            return self;
        }
        let there = self.parts.iter().filter(|part| part.is_there);
        let mass = there.fold(P::zero(), |mass, part| mass + part.dry_mass + part.propellant);
        Self { vehicle: self.vehicle.with_mass(mass), ..self }
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
            cause: self.cause,
            held: self.held,
            parts: self.parts.iter().map(|part| part.map(number)).collect(),
            load_limit: self.load_limit.map(number),
            steering: self.steering.clone(),
            steering_of: self.steering_of,
            origins: self.origins.iter().map(|(event, time)| (*event, number(*time))).collect(),
        }
    }

    /// The share of the thrust in vacuum of all parts that burn that their throttles leave, at a time, s.
    pub(crate) fn throttle(&self, time: P) -> P {
        let share = |weight: &dyn Fn(&ThrustPiece<P>) -> P| {
            let weights = self.lit().filter_map(|(_, part)| Some((part.throttle, weight(part.burn.as_ref()?))));
            let sums = |(full, left): (P, P), (throttle, weight): (P, P)| (full + weight, left + throttle * weight);
            let (full, left) = weights.fold((P::zero(), P::zero()), sums);
            (full.value() > 0.0).then(|| left * full.recip())
        };
        let elapsed = time - self.since;
        // Thrusts that begin with nothing rise in proportion of their rates.
        let of_thrusts = share(&|burn| burn.thrust + burn.rate * elapsed);
        of_thrusts.or_else(|| share(&|burn| burn.rate)).unwrap_or_else(P::one)
    }

    /// The parts that burn, with their places.
    fn lit(&self) -> impl Iterator<Item = (usize, &PartState<P>)> {
        self.parts.iter().enumerate().filter(|(_, part)| part.burn.is_some())
    }

    /// The propellant of a part at a time, s, when the vehicle has a mass, kg.
    pub(crate) fn propellant(&self, part: usize, time: P, mass: P) -> P {
        let state = &self.parts[part];
        let Some(burn) = state.burn else { return state.propellant };
        let burnt = match self.load_limit {
            None => burn.burnt(state.throttle, time - self.since),
            // The limit throttles all engines alike.
            Some(_) => (self.vehicle.mass - mass) * self.share(state),
        };
        let left = state.propellant - burnt;
        P::select(left.less_than(0.0), left - left.value(), left)
    }

    /// The share of a part in the mass flow of all.
    fn share(&self, part: &PartState<P>) -> P {
        // Also where its thrust begins with nothing.
        if self.lit().count() == 1 {
            return P::one();
        }
        let all = self.lit().fold(P::zero(), |flow, (_, part)| flow + part.mass_flow());
        if all.value() > 0.0 { part.mass_flow() * all.recip() } else { P::zero() }
    }

    /// The parts at a time, s, when the vehicle has a mass, kg: those of a phase that begins then.
    fn parts_at(&self, time: P, mass: P) -> Vec<PartState<P>> {
        let at = |(place, part): (usize, &PartState<P>)| {
            let burn =
                part.burn.map(|burn| ThrustPiece { thrust: burn.thrust + burn.rate * (time - self.since), ..burn });
            PartState { propellant: self.propellant(place, time, mass), burn, ..*part }
        };
        self.parts.iter().enumerate().map(at).collect()
    }

    /// The mass at which a part that a load limit throttles is burnt out, kg, and which part that is; none where time alone tells.
    pub(crate) fn burnout_mass(&self) -> Option<(P, usize)> {
        self.load_limit?;
        let of_part = |(place, part): (usize, &PartState<P>)| {
            let share = self.share(part);
            (share.value() > 0.0).then(|| (self.vehicle.mass - part.propellant * share.recip(), place))
        };
        self.lit().filter_map(of_part).max_by(|a, b| a.0.value().total_cmp(&b.0.value()))
    }

    /// Whether a load limit throttles several engines of which one has a profile by time, so that the share of each in the mass flow changes.
    pub(crate) fn has_unknown_shares(&self) -> bool {
        let changes = |(_, part): (usize, &PartState<P>)| part.burn.is_some_and(|burn| burn.rate.value() != 0.0);
        self.load_limit.is_some() && self.lit().count() > 1 && self.lit().any(changes)
    }

    /// The thrust that is on, with the propellant that is left when the vehicle has a mass, kg.
    fn thrust_left(&self, mass: P) -> Option<Thrust<P>> {
        let left = |whole: P| whole - (self.vehicle.mass - mass);
        self.thrust.map(|thrust| Thrust { propellant: thrust.propellant.map(left), ..thrust })
    }

    /// Whether nothing changes in it by time alone.
    pub(crate) fn is_still(&self) -> bool {
        self.thrust.is_none() && self.canopies.is_empty() && self.lit().next().is_none()
    }

    /// When the propellant of the thrust is spent, s.
    fn thrust_end(&self) -> Option<P> {
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
        let parts = self.parts_after(event, effect, numbers, time, mass);
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
        let (thrust, thrust_of) = match effect.thrust {
            None => (thrust_left, self.thrust_of),
            Some(ThrustCommand::On(Thrust { force: 0.0, .. }) | ThrustCommand::Off) => (None, None),
            Some(ThrustCommand::On(Thrust { along, .. })) => {
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
        let load_limit = match effect.load_limit {
            None => self.load_limit,
            Some(None) => None,
            Some(Some(_)) => number(|effect| effect.load_limit.flatten()).map(|limit| limit * STANDARD_GRAVITY),
        };
        let (steering, steering_of) = match &effect.steer {
            None => (self.steering.clone(), self.steering_of),
            Some(steering) => (steering.clone(), Some(event)),
        };
        let mut origins = self.origins.clone();
        origins.extend(numbers.case().has_schedules_since(event).then_some((event, time)));
        let after = Self {
            since: time,
            vehicle,
            aerodynamics_of,
            thrust,
            thrust_of,
            canopies,
            cause: Change::Event(event),
            held: self.held && !effect.lift_off,
            parts,
            load_limit,
            steering,
            steering_of,
            origins,
        };
        after.weighed()
    }

    /// The parts after the effect of an event at a time, s, before which the vehicle has a mass, kg.
    fn parts_after(
        &self,
        event: usize,
        effect: &Effect,
        numbers: &impl Numbers<P>,
        time: P,
        mass: P,
    ) -> Vec<PartState<P>> {
        let mut parts = self.parts_at(time, mass);
        for part in effect.separate.iter().flat_map(|separation| &separation.parts) {
            parts[*part] = PartState { is_there: false, burn: None, ..parts[*part] };
        }
        for part in &effect.shut_down {
            parts[*part].burn = None;
        }
        for (place, throttle) in effect.throttle.iter().enumerate() {
            parts[throttle.part].throttle = numbers.number(|case| case.events[event].then.throttle[place].value);
        }
        for part in &effect.ignite {
            if parts[*part].is_there && parts[*part].burn.is_none() {
                parts[*part].burn = PartState::piece(numbers, *part, time, 0);
            }
        }
        parts
    }

    /// When time alone changes something next, s, and what.
    pub(crate) fn next_change(&self) -> Option<(P, Change)> {
        self.changes().min_by(|a, b| a.0.value().total_cmp(&b.0.value()))
    }

    /// When time alone makes a change, s.
    pub(crate) fn time_of(&self, change: Change) -> Option<P> {
        self.changes().find(|(_, other)| *other == change).map(|(time, _)| time)
    }

    /// What time alone changes, and when, s.
    fn changes(&self) -> impl Iterator<Item = (P, Change)> {
        let of_thrust = self.thrust_end().map(|end| (end, Change::ThrustEnds));
        let of_canopies = self.next_inflation().map(|inflation| (inflation, Change::Inflation));
        let burnout = |part: &PartState<P>| part.time_to_burnout().filter(|_| self.load_limit.is_none());
        let burnouts =
            self.lit().filter_map(move |(place, part)| Some((self.since + burnout(part)?, Change::Burnout(place))));
        let pieces = self.lit().filter_map(|(place, part)| Some((part.burn?.until?, Change::NextPiece(place))));
        of_thrust.into_iter().chain(of_canopies).chain(burnouts).chain(pieces)
    }

    /// The change after which a phase begins at a time, s, with a cause: the last piece of a thrust profile ends with a burnout.
    pub(crate) fn change_to(&self, cause: Change, time: f64) -> Change {
        match cause {
            Change::Burnout(part) => {
                let ends = |(end, next): &(P, Change)| *next == Change::NextPiece(part) && end.value() <= time;
                self.next_change().filter(ends).map_or(cause, |(_, next)| next)
            }
            other => other,
        }
    }

    /// The phase that begins with a change that no event makes, at a time, s, when the vehicle has a mass, kg.
    #[must_use]
    pub(crate) fn after_change(&self, change: Change, numbers: &impl Numbers<P>, time: P, mass: P) -> Self {
        match change {
            Change::Start | Change::Event(_) => self.clone(),
            Change::ThrustEnds => self.without_thrust(time),
            Change::Inflation => self.inflated(time, mass),
            Change::NextPiece(part) => self.on_next_piece(part, numbers, time, mass),
            Change::Burnout(part) => self.burnt_out(part, time, mass),
        }
    }

    /// The phase that begins where a canopy begins to fill, or is full.
    fn inflated(&self, time: P, mass: P) -> Self {
        let vehicle = self.vehicle.with_mass(mass);
        let canopies = self.canopies.iter().map(|canopy| canopy.at(time)).collect();
        let (thrust, parts) = (self.thrust_left(mass), self.parts_at(time, mass));
        Self { since: time, vehicle, thrust, canopies, parts, cause: Change::Inflation, ..self.clone() }.weighed()
    }

    /// The phase that begins where the propellant of the thrust is spent.
    fn without_thrust(&self, time: P) -> Self {
        let spent = self.thrust.and_then(|thrust| thrust.propellant).unwrap_or_else(P::zero);
        let vehicle = self.vehicle.with_mass(self.vehicle.mass - spent);
        Self { since: time, vehicle, thrust: None, thrust_of: None, cause: Change::ThrustEnds, ..self.clone() }
    }

    /// The phase that begins with the next piece of the thrust of a part, or with its end, where its profile is over.
    fn on_next_piece(&self, part: usize, numbers: &impl Numbers<P>, time: P, mass: P) -> Self {
        let mut parts = self.parts_at(time, mass);
        let next = parts[part].burn.and_then(|burn| PartState::piece(numbers, part, burn.ignition, burn.number + 1));
        // The last entry of a profile has no piece behind it. Where another change comes at the same time, the piece may be met a little later
        // or sooner than it begins, as numbers vary.
        let met = |burn: ThrustPiece<P>| {
            let begins = self.parts[part].burn.and_then(|burn| burn.until).unwrap_or(time);
            ThrustPiece { thrust: burn.thrust + burn.rate * (time - begins), ..burn }
        };
        parts[part].burn = next.filter(|piece| piece.until.is_some()).map(met);
        let cause = if parts[part].burn.is_some() { Change::NextPiece(part) } else { Change::Burnout(part) };
        Self { since: time, parts, cause, ..self.clone() }.weighed()
    }

    /// The phase that begins where the propellant of a part is spent.
    fn burnt_out(&self, part: usize, time: P, mass: P) -> Self {
        let mut parts = self.parts_at(time, mass);
        parts[part] = PartState { propellant: P::zero(), burn: None, ..parts[part] };
        Self { since: time, parts, cause: Change::Burnout(part), ..self.clone() }.weighed()
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
        phase.steering = match self.steering_of {
            None => case.steering.clone(),
            Some(event) => case.events[event].then.steer.clone().unwrap_or_default(),
        };
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
        let burn = self.burn();
        let [lift, drag, bank] = numbers.offsets();
        // Those of the coefficients belong to the vehicle of the start.
        let offsets = if self.aerodynamics_of.is_none() { [lift, drag, bank] } else { [P::zero(), P::zero(), bank] };
        let models = models_of.models_of(&self.vehicle);
        let since = |event: usize| Some(self.origin(event)?.value());
        let (control, steering) = (models.control.since(since), self.steering.since(since));
        // The time of an event has its derivatives beside the models, which have none.
        let lag = |command: &Command| {
            command.event().and_then(|event| self.origin(event)).map_or_else(P::zero, |time| time - time.value())
        };
        let [bank_angle, angle_of_attack] = models_of.control.commands().map(lag);
        let [pitch, yaw] = self.steering.commands().map_or([P::zero(); 2], |commands| commands.map(lag));
        let models = Models { control, steering, ..models };
        Forces::new(models, Case::parameters_of(numbers, &self.vehicle, offsets))
            .lagging([bank_angle, angle_of_attack, pitch, yaw])
            .of_mass(self.vehicle.mass)
            .burning(burn)
            .under(Canopies::of(&self.canopies, over_mass))
            .held(self.held)
    }

    /// When an event happened since which an angle runs, s.
    fn origin(&self, event: usize) -> Option<P> {
        self.origins.iter().find(|(origin, _)| *origin == event).map(|(_, time)| *time)
    }

    /// The thrust that acts in it, if there is any: that of an event, or of the engines together.
    fn burn(&self) -> Option<Burn<P>> {
        let over_mass = self.vehicle.mass.recip();
        if let Some(thrust) = self.thrust {
            let direction = ThrustDirection::Axis(thrust.along);
            return Some(Burn::constant(direction, thrust.force * over_mass, thrust.mass_flow()));
        }
        self.lit().next()?;
        let sum = |of: &dyn Fn(&PartState<P>, &ThrustPiece<P>) -> P| {
            let lit = self.lit().filter_map(|(_, part)| Some((part, part.burn.as_ref()?)));
            lit.fold(P::zero(), |sum, (part, burn)| sum + of(part, burn))
        };
        Some(Burn {
            direction: ThrustDirection::Steered,
            since: self.since,
            acceleration: sum(&|part, _| part.thrust()) * over_mass,
            acceleration_rate: sum(&|part, burn| burn.rate * part.throttle) * over_mass,
            mass_flow: sum(&|part, _| part.mass_flow()),
            mass_flow_rate: sum(&|part, burn| burn.rate * part.throttle * burn.mass_flow_of_unit),
            exit_area_over_mass: Some(sum(&|_, burn| burn.exit_area) * over_mass)
                .filter(|_| self.lit().any(|(_, part)| part.burn.is_some_and(|burn| burn.exit_area.value() != 0.0))),
            load_limit: self.load_limit,
        })
    }
}
