//! A flight followed once more in dual numbers, step by step as it was flown.
//!
//! The steps are not chosen anew, so that their choice adds nothing. At the ground one step of Newton's method gives the derivatives of the
//! time of the impact, and with it those of the state there. So it does where something changes on the way: as long as the change comes
//! later, the flight moves on by the rates from before it.

use std::array::from_fn;
use std::f64::consts::TAU;

use num_dual::Dual64;

use super::variation::{Dual, VariedCase};
use super::varied_forces::{VariedForces, VariedMotion};
use crate::coordinates::GreatCircle;
use crate::event::{Condition, Quantity, Tilt, Trigger};
use crate::integrate::{AnyStep, Step, System, follow, follow_implicitly};
use crate::interrupt::Interrupt;
use crate::motion::{self, Forces, MASS, ModelMode, State, StateRate, moving};
use crate::scalar::{Scalar, length};
use crate::scenario::{Case, Change, ForFormulation, FormulationIn, Numbers, Phase};
use crate::simulate::SimulationError;
use crate::trajectory::{EventRecord, StoredStep, Termination, Trajectory};

/// A quantity this near the value of a condition, relative to it or to 1, has met it by moving there and not by a jump.
const ON_VALUE: f64 = 1e-6;

/// A place of a flight at which its state is wanted with derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Place {
    /// The initial state, before what happens there.
    Start,
    /// At a time inside a step, s, whatever varies.
    Inside { step: usize, time: f64 },
    /// Where a step begins, after what changes there; with the change, where that comes sooner or later.
    StepStart(usize),
    /// Where a step ends, before what changes there; with the change, where that comes sooner or later.
    StepEnd(usize),
    /// At the event of this place in the records, before its effect.
    Before(usize),
    /// At the event of this place in the records, after its effect.
    After(usize),
    /// Where the flight ends, after what happens there.
    End,
}

/// The state at a place, with derivatives.
#[derive(Clone)]
pub(super) struct Sample<const W: usize> {
    pub(super) time: Dual<W>,
    pub(super) state: State<Dual<W>>,
    /// The length of the ground track, m; 0 where it was not followed.
    pub(super) ground_distance: Dual<W>,
    pub(super) phase: Phase<Dual<W>>,
    pub(super) mode: ModelMode,
}

/// What is to be followed.
pub(super) struct Follow<'a, const W: usize> {
    pub(super) flight: &'a Trajectory,
    pub(super) varied: VariedCase<'a, W>,
    /// Which of the variations are of numbers in the models.
    pub(super) changes_models: &'a [bool],
    pub(super) places: &'a [Place],
    /// Whether the ground distance is wanted.
    pub(super) with_ground_distance: bool,
    pub(super) interrupt: &'a dyn Interrupt,
}

impl<const W: usize> ForFormulation for Follow<'_, W> {
    type Number = Dual<W>;
    /// The samples of the places, in their order; none of one that the flight does not have.
    type Output = Result<Vec<Option<Sample<W>>>, SimulationError>;

    fn with<F: FormulationIn<Dual<W>, N>, const N: usize>(self) -> Self::Output
    where
        AnyStep: From<Step<N>>,
    {
        let steps = &self.flight.flown.steps;
        let mut follower = Follower::<F, N, W>::start(&self);
        for (index, step) in steps.iter().enumerate() {
            if self.interrupt.is_raised() {
                return Err(SimulationError::Interrupted { time: step.start_time() });
            }
            follower.change(index, step);
            follower.take(index, step);
        }
        follower.end();
        Ok(follower.samples)
    }
}

/// The state of a flight that is followed, between two steps.
struct Follower<'a, F: FormulationIn<Dual<W>, N>, const N: usize, const W: usize> {
    of: &'a Follow<'a, W>,
    phase: Phase<Dual<W>>,
    /// The place of the phase among those that were flown.
    phase_index: usize,
    forces: VariedForces<W>,
    motion: VariedMotion<F, N, W>,
    state: [Dual<W>; N],
    ground_distance: Dual<W>,
    /// The great circle from which ranges are measured.
    track: GreatCircle<Dual<W>>,
    /// How much later each event happens as the numbers vary; none of one that has not happened yet.
    delays: Vec<Option<Dual<W>>>,
    /// How much later each part burns out, for the first time; none of one that has not burnt out yet.
    burnout_delays: Vec<Option<Dual<W>>>,
    /// How many of the records have happened.
    happened: usize,
    samples: Vec<Option<Sample<W>>>,
}

impl<'a, F: FormulationIn<Dual<W>, N>, const N: usize, const W: usize> Follower<'a, F, N, W> {
    fn start(of: &'a Follow<'a, W>) -> Self {
        let Follow { flight, varied, changes_models, .. } = of;
        let start = varied.start();
        let phase = Phase::first(varied);
        let mode = flight.flown.start.mode;
        let forces = VariedForces::new(varied, changes_models, &phase, &flight.flown.phases[0], mode);
        let mut follower = Self {
            of,
            phase_index: 0,
            motion: forces.motion(),
            forces,
            state: F::numbers(&State {
                mass: Some(phase.vehicle.mass),
                heat_load: Some(Dual::from(0.0)),
                ..State::from(start)
            }),
            phase,
            ground_distance: Dual::from(0.0),
            track: GreatCircle::of(&varied.track_start()),
            delays: vec![None; flight.case.events.len()],
            burnout_delays: vec![None; flight.case.parts.len()],
            happened: 0,
            samples: vec![None; of.places.len()],
        };
        follower.keep(Place::Start, Dual::from(flight.flown.start.time));
        follower
    }

    /// Keeps the present state for all that want that of a place.
    fn keep(&mut self, place: Place, time: Dual<W>) {
        let wanted = self.of.places.iter().enumerate().filter(|(_, wanted)| **wanted == place);
        for (index, _) in wanted {
            self.samples[index] = Some(Sample {
                time,
                state: F::state(&self.state),
                ground_distance: self.ground_distance,
                phase: self.phase.clone(),
                mode: self.forces.mode(),
            });
        }
    }

    /// Follows a step, and keeps what is wanted inside.
    fn take(&mut self, index: usize, step: &StoredStep) {
        let (time, length) = (step.start_time(), step.end_time() - step.start_time());
        let start = (self.state, self.ground_distance);
        for place in self.of.places {
            if let Place::Inside { step: wanted, time: inside } = *place
                && wanted == index
            {
                self.advance(&step.step, inside - time);
                self.keep(*place, Dual::from(inside));
                (self.state, self.ground_distance) = start;
            }
        }
        self.advance(&step.step, length);
    }

    /// Follows the beginning of a step over a length, s.
    fn advance(&mut self, step: &AnyStep, length: f64) {
        let end = self.followed(step, length);
        if self.of.with_ground_distance {
            let inside = INSIDE.map(|node| self.followed(step, length * node));
            let ends = self.ground_speed(&self.state) + self.ground_speed(&end);
            let middle = self.ground_speed(&inside[0]) + self.ground_speed(&inside[1]);
            self.ground_distance += (ends + middle * 5.0) * (length / 12.0);
        }
        self.state = end;
    }

    /// The state a length, s, after the start of a step, which is the present one.
    fn followed(&self, step: &AnyStep, length: f64) -> [Dual<W>; N] {
        let time = step.start_time();
        if step.is_implicit() {
            let jacobian = |time, state: &_| self.motion.jacobian(time, state);
            follow_implicitly(&self.motion, jacobian, &self.state, time, length)
        } else {
            follow(&self.motion, &self.state, time, length)
        }
    }

    /// The rate of the ground distance, m/s.
    fn ground_speed(&self, state: &[Dual<W>; N]) -> Dual<W> {
        let State { position, velocity, .. } = F::state(state);
        let over_radius = length(&position).recip();
        let radius = |forces: &Forces| forces.planet().equatorial_radius();
        let radius = self.forces.with_models(Dual::from(radius(&self.forces.plain)), radius);
        length(&position.cross(&velocity)) * over_radius * over_radius * radius
    }

    /// Lets happen what happened where a step begins, sooner or later as the numbers vary.
    fn change(&mut self, index: usize, step: &StoredStep) {
        let time = step.start_time();
        let records = &self.of.flight.flown.event_records[self.happened..];
        let now = records.iter().take_while(|record| record.before.time <= time).count();
        if (step.phase, step.mode) == (self.phase_index, self.forces.mode()) && now == 0 {
            if index > 0 {
                self.keep(Place::StepEnd(index - 1), Dual::from(time));
            }
            self.keep(Place::StepStart(index), Dual::from(time));
            return;
        }
        let records = &records[..now];
        let mut end_of_step = index.checked_sub(1).map(Place::StepEnd);
        let last = records.first().map_or(step.phase.saturating_sub(1), |record| record.before.phase);
        while self.phase_index < last {
            self.change_alone(time, end_of_step.take());
        }
        let rates = self.motion.derivative(time.into(), &self.state);
        let delay = self.turning_delay(records, step.mode, time, &rates);
        // During the delay the rates before the change hold in place of those after it.
        self.move_by(&rates, delay);
        let instant = delay + time;
        if let Some(place) = end_of_step {
            self.keep(place, instant);
        }
        self.let_happen(records, delay);
        self.enter(step.phase, delay, step.mode);
        self.keep(Place::StepStart(index), instant);
        let next = self.motion.derivative(time.into(), &self.state);
        self.move_by(&next, -delay);
    }

    /// Enters the next phase, to which time alone leads, as much later as that comes by itself: what comes at the same time may do so sooner
    /// or later. Keeps the present state for a place before that, if there is one.
    fn change_alone(&mut self, time: f64, before: Option<Place>) {
        let number = self.phase_index + 1;
        let rates = self.motion.derivative(time.into(), &self.state);
        let delay = self.turning_delay(&[], self.forces.mode(), time, &rates);
        self.move_by(&rates, delay);
        if let Some(place) = before {
            self.keep(place, delay + time);
        }
        let Follow { flight, varied, .. } = self.of;
        let mut plain = flight.flown.phases[number].forces(varied.case);
        plain.enter(self.forces.mode());
        // The flight would have ended where none holds.
        let _ = plain.enter_mode_of(time, &F::state(&self.state.map(|number| number.re)));
        self.enter(number, delay, plain.mode());
        let next = self.motion.derivative(time.into(), &self.state);
        self.move_by(&next, -delay);
    }

    fn move_by(&mut self, rates: &[Dual<W>; N], delay: Dual<W>) {
        if self.of.with_ground_distance {
            self.ground_distance += self.ground_speed(&self.state) * delay;
        }
        self.state = from_fn(|i| self.state[i] + rates[i] * delay);
    }

    /// Lets events happen in the present state, as much later.
    fn let_happen(&mut self, records: &[EventRecord], delay: Dual<W>) {
        for record in records {
            let place = self.happened;
            let instant = delay + record.before.time;
            self.delays[record.event] = Some(delay);
            self.change_by_time(record.before.phase, delay);
            self.keep(Place::Before(place), instant);
            self.apply_tilt(record);
            self.apply_impulse(record, delay);
            if self.of.flight.case.begins_phase(record.event) {
                self.set_phase(self.phase.after(record.event, &self.of.varied, instant, self.mass()));
                self.phase_index = record.after.phase;
            }
            self.happened += 1;
            if self.of.places.contains(&Place::After(place)) {
                self.enter(record.after.phase, delay, record.after.mode);
                self.keep(Place::After(place), instant);
            }
        }
    }

    /// Enters a phase, to which time alone leads from the present one, and a mode.
    fn enter(&mut self, number: usize, delay: Dual<W>, mode: ModelMode) {
        self.change_by_time(number, delay);
        let Follow { flight, varied, changes_models, .. } = self.of;
        self.forces = VariedForces::new(varied, changes_models, &self.phase, &flight.flown.phases[number], mode);
        self.motion = self.forces.motion();
    }

    /// Goes on to the phase of a number to which time alone leads: propellant is spent, canopies begin to fill or are full.
    fn change_by_time(&mut self, number: usize, delay: Dual<W>) {
        while self.phase_index < number {
            self.phase_index += 1;
            let Phase { since, cause, .. } = &self.of.flight.flown.phases[self.phase_index];
            let change = self.phase.change_to(*cause, *since);
            if let Change::Burnout(part) = *cause {
                self.burnout_delays[part].get_or_insert(delay);
            }
            self.set_phase(self.phase.after_change(change, &self.of.varied, delay + *since, self.mass()));
        }
    }

    /// The present mass, kg.
    fn mass(&self) -> Dual<W> {
        self.state.get(MASS).copied().unwrap_or(self.phase.vehicle.mass)
    }

    fn set_phase(&mut self, phase: Phase<Dual<W>>) {
        if let Some(mass) = self.state.get_mut(MASS) {
            *mass = phase.vehicle.mass;
        }
        self.phase = phase;
    }

    /// Turns the velocity by the tilt of an event, if it has one.
    fn apply_tilt(&mut self, record: &EventRecord) {
        let Follow { flight, varied, .. } = self.of;
        if flight.case.events[record.event].then.tilt.is_none() {
            return;
        }
        let number = |of: fn(Tilt) -> f64| varied.number(|case| case.events[record.event].then.tilt.map_or(0.0, of));
        let (angle, azimuth) = (number(|tilt| tilt.angle), number(|tilt| tilt.azimuth));
        let state = F::state(&self.state);
        let velocity = motion::tilted(&state.planet_fixed(), angle, azimuth);
        self.state = F::numbers(&State { velocity, ..state });
    }

    /// Changes the velocity by the impulse of an event, if it has one.
    fn apply_impulse(&mut self, record: &EventRecord, delay: Dual<W>) {
        let Follow { flight, varied, .. } = self.of;
        let effect = &flight.case.events[record.event].then;
        let is_held = self.phase.held && !effect.lift_off;
        let Some(impulse) = effect.impulse.filter(|_| !is_held) else { return };
        let time = record.before.time;
        let state = F::state(&self.state);
        let of_event = |case: &Case| case.events[record.event].then.impulse;
        let speed_change = varied.number(|case| of_event(case).map_or(0.0, |impulse| impulse.speed_change));
        let direction = motion::along(impulse.along, &flight.case.planet, delay + time, &state.planet_fixed());
        // The axis itself may vary, and the rotation that turns it.
        let plain = state.map(|number| number.re).planet_fixed();
        let component = |index: usize| {
            varied.number(|case| {
                let along = of_event(case).map_or(impulse.along, |impulse| impulse.along);
                motion::along(along, &case.planet, time, &plain)[index]
            })
        };
        let turned = nalgebra::Vector3::from_fn(|index, _| {
            let component = component(index);
            component - component.re
        });
        let velocity = state.velocity + (direction + turned) * speed_change;
        self.state = F::numbers(&State { velocity, ..state });
    }

    /// The end of the flight, with what happens there.
    fn end(&mut self) {
        let flown = &self.of.flight.flown;
        let time = flown.end.time;
        let rates = self.motion.derivative(time.into(), &self.state);
        let records = &flown.event_records[self.happened..];
        let delay = self.final_delay(records, &rates);
        self.move_by(&rates, delay);
        if let Some(last) = flown.steps.len().checked_sub(1) {
            self.keep(Place::StepEnd(last), delay + time);
        }
        self.let_happen(records, delay);
        self.enter(flown.end.phase, delay, flown.end.mode);
        self.keep(Place::End, delay + time);
    }

    /// How much later the flight ends as the numbers vary, s.
    fn final_delay(&self, records: &[EventRecord], rates: &[Dual<W>; N]) -> Dual<W> {
        let Follow { flight, varied, .. } = self.of;
        let (case, time) = (&flight.case, flight.flown.end.time);
        // What is met together with its cause comes as much later.
        let or_cause = |delay: Option<Dual<W>>, after: &dyn Fn(&Case) -> f64| match delay {
            Some(delay) => delay + self.later(after),
            None => self.turning_delay(records, flight.flown.end.mode, time, rates) + self.later(after),
        };
        match flight.flown.arrival.termination {
            Termination::TimeLimit => {
                let limit = varied.number(|case| case.stop.time);
                limit - limit.re
            }
            Termination::SurfaceImpact | Termination::StopAltitude => {
                let value = varied.number(|case| case.stop.altitude);
                self.condition_delay(Quantity::Altitude, value, time, rates)
            }
            Termination::AtmosphereExit => {
                let value = varied.number(|case| case.stop.ceiling.unwrap_or_default());
                self.condition_delay(Quantity::Altitude, value, time, rates)
            }
            Termination::Condition(index) => match case.stop.when[index] {
                Trigger::Condition(Condition { quantity, .. }) => {
                    let value = varied.number(|case| value_of(&case.stop.when[index]));
                    self.condition_delay(quantity, value, time, rates)
                }
                Trigger::After { event, .. } => or_cause(self.delays[event], &|case| value_of(&case.stop.when[index])),
                Trigger::AfterBurnout { part, .. } => {
                    or_cause(self.burnout_delays[part], &|case| value_of(&case.stop.when[index]))
                }
            },
        }
    }

    /// By how much a time of the case moves as the numbers vary, s.
    fn later(&self, of: impl Fn(&Case) -> f64) -> Dual<W> {
        let time = self.of.varied.number(of);
        time - time.re
    }

    /// The delay of a change of the motion as the numbers vary, s.
    fn turning_delay(&self, now: &[EventRecord], next: ModelMode, time: f64, rates: &[Dual<W>; N]) -> Dual<W> {
        let Follow { flight, varied, .. } = self.of;
        let delay_of = |record: &EventRecord| {
            let value = |case: &Case| value_of(&case.events[record.event].when);
            match flight.case.events[record.event].when {
                Trigger::Condition(condition) => {
                    let delay = || self.condition_delay(condition.quantity, varied.number(value), time, rates);
                    self.meets(&condition, time).then(delay)
                }
                // One that waits no time for what happens now comes with it.
                Trigger::After { event, .. } => self.delays[event].map(|delay| delay + self.later(value)),
                Trigger::AfterBurnout { part, .. } => self.burnout_delays[part].map(|delay| delay + self.later(value)),
            }
        };
        if let Some(delay) = now.iter().find_map(delay_of) {
            return delay;
        }
        let next_phase = flight.flown.phases.get(self.phase_index + 1).filter(|next| next.since <= time);
        if let Some(change) = next_phase.map(|phase| self.phase.change_to(phase.cause, phase.since)) {
            // Not all of them come by time alone: events do not, nor a burnout under a load limit.
            if let Some(changes) = self.phase.time_of(change) {
                return changes - changes.re;
            }
            if let (Some((mass, _)), Change::Burnout(_)) = (self.phase.burnout_mass(), change) {
                return self.condition_delay(Quantity::Mass, mass, time, rates);
            }
        }
        let plain = &self.forces.plain;
        let values = F::state(&self.state.map(|number| number.re));
        let Some(switch) = plain.first_to_turn(next, time, &values) else { return Dual::from(0.0) };
        let moving = self.moving(time, rates);
        let rate = plain.reading(switch, Dual64::new(time, 1.0), &moving.state).eps;
        let reading = self.forces.dual.reading(switch, Dual::from(time), &F::state(&self.state));
        let reading = self.forces.with_models(reading, |forces| forces.reading(switch, time, &values));
        delay(reading - self.forces.boundary(switch, next), rate)
    }

    /// Whether a condition is met at a time, s, by moving; one that was met by a jump was so because of another.
    fn meets(&self, Condition { quantity, value, .. }: &Condition, time: f64) -> bool {
        let mut off = self.quantity(*quantity, time).re - *value;
        if *quantity == Quantity::Downrange {
            let around = TAU * self.of.flight.case.planet.equatorial_radius();
            off -= around * (off / around).round();
        }
        off.abs() <= ON_VALUE * value.abs().max(1.0)
    }

    /// How much later a quantity passes a value, which may vary as well.
    fn condition_delay(&self, quantity: Quantity, value: Dual<W>, time: f64, rates: &[Dual<W>; N]) -> Dual<W> {
        if quantity == Quantity::Time {
            return value - value.re;
        }
        let track = self.track.map(|number| Dual64::from(number.re));
        let rate = self.forces.plain.quantity(quantity, &self.moving(time, rates), &track).eps;
        delay(self.quantity(quantity, time) - value, rate)
    }

    /// A quantity at a time, s, of the present state.
    fn quantity(&self, quantity: Quantity, time: f64) -> Dual<W> {
        let at = StateRate::at::<F, N>(Dual::from(time), &self.state);
        let plain_at = StateRate::at::<F, N>(time, &self.state.map(|number| number.re));
        let track = self.track.map(|number| number.re);
        let number = self.forces.dual.quantity(quantity, &at, &self.track);
        self.forces.with_models(number, |forces| forces.quantity(quantity, &plain_at, &track))
    }

    /// The present state without derivatives, moving along the flow.
    fn moving(&self, time: f64, rates: &[Dual<W>; N]) -> StateRate {
        let values = moving(&self.state.map(|number| number.re), &rates.map(|rate| rate.re));
        StateRate::at::<F, N>(Dual64::new(time, 1.0), &values)
    }
}

/// The inner nodes of the quadrature of Lobatto with four points, over [0, 1], whose weights are 1/12, 5/12, 5/12 and 1/12.
///
/// # Reference
/// M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 1964, table 25.6.
const INSIDE: [f64; 2] = [0.276_393_202_250_021, 0.723_606_797_749_979];

/// The number of a trigger: the value of its condition, or its delay.
fn value_of(trigger: &Trigger) -> f64 {
    match *trigger {
        Trigger::Condition(Condition { value, .. }) => value,
        Trigger::After { delay, .. } | Trigger::AfterBurnout { delay, .. } => delay,
    }
}

/// How much later a quantity passes the value that it has: a step of Newton's method, -q/q̇, of value zero. Where the quantity stands still, as that
/// of a vehicle at rest, the slopes are no numbers.
fn delay<const W: usize>(quantity: Dual<W>, rate: f64) -> Dual<W> {
    let mut delay = -(quantity - quantity.re) * rate.recip();
    delay.re = 0.0;
    delay
}
