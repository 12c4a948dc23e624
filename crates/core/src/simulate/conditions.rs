//! The conditions of the events and of the stops of a case.

use std::cell::OnceCell;
use std::f64::consts::TAU;

use num_dual::Dual64;

use super::detector::{AT_END, Detector};
use super::step_view::StepView;
use crate::coordinates::GreatCircle;
use crate::event::{Condition, Direction, Effect, Quantity, Trigger};
use crate::integrate::event::{self, Inside, PredictedCrossing};
use crate::motion::{Forces, Formulation, Loads, StateRate};
use crate::scalar::Scalar;
use crate::scenario::Case;
use crate::trajectory::Termination;

/// Detects where conditions are met that have not been met yet.
pub(super) struct ConditionDetector {
    all: Vec<PendingCondition>,
    /// The quantities for which a condition waits.
    watched: Vec<Quantity>,
    /// Of these, with their rates, at the end of the last step; the others are zero.
    last: Readings,
    /// The same at its start.
    before: Readings,
    /// The length of that step, s; none where it tells nothing of what comes.
    length_before: Option<f64>,
    /// The initial great circle, from which downrange and ground range are measured.
    track: GreatCircle<Dual64>,
    /// The circumference of the sphere on which they are, m.
    around: f64,
}

/// Every quantity, with its rate.
pub(super) type Readings = [Dual64; Quantity::ALL.len()];

/// A condition, and the action that follows when it is met.
struct PendingCondition {
    /// That of an event which waits for another is on the time, which is set when the other happens.
    condition: Condition,
    /// So far beyond the value the condition is met, in its unit: 0, but for a quantity that began on the value and has not moved on to
    /// the far side.
    margin: f64,
    /// What it waits for, and the delay after it, s.
    waits_for: Option<(Cause, f64)>,
    action: Action,
    /// Whether the flight goes on otherwise, or ends: not so at an event that is only noted.
    changes_flight: bool,
    status: Status,
}

/// What follows when a condition is met.
#[derive(Clone, Copy)]
enum Action {
    /// The event of this place in the list.
    Event(usize),
    /// The end of the flight.
    End(Termination),
    /// The end of the burn of a part, whose place in the list is given when the burn begins.
    Burnout(usize),
}

/// What others may wait for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Cause {
    /// The event of this place in the list.
    Event(usize),
    /// The burnout of the part of this place in the list.
    Burnout(usize),
}

#[derive(Clone, Copy, PartialEq)]
enum Status {
    /// It waits for another event to happen.
    Dormant,
    /// It may be met.
    Armed,
    /// It is met at the present instant.
    Due,
    /// It was met.
    Done,
}

impl PendingCondition {
    fn new(trigger: Trigger, action: Action, changes_flight: bool) -> Self {
        let at = |value| Condition { quantity: Quantity::Time, value, direction: Direction::Rising };
        let (condition, waits_for, status) = match trigger {
            Trigger::Condition(condition) => (condition, None, Status::Armed),
            Trigger::After { event, delay } => (at(f64::INFINITY), Some((Cause::Event(event), delay)), Status::Dormant),
            Trigger::AfterBurnout { part, delay } => {
                (at(f64::INFINITY), Some((Cause::Burnout(part), delay)), Status::Dormant)
            }
        };
        Self { condition, margin: 0.0, waits_for, action, changes_flight, status }
    }

    /// How far the quantity is before the value.
    fn before<S: Scalar>(&self, quantity: S) -> S {
        self.condition.before(quantity) + self.margin
    }

    /// The same of all quantities.
    fn before_among(&self, quantities: &Readings) -> Dual64 {
        self.before(quantities[self.condition.quantity as usize])
    }
}

impl ConditionDetector {
    /// Those of a case, all waiting, for a flight that starts at a moment.
    pub(super) fn new(case: &Case, forces: &Forces, start: &StateRate) -> Self {
        let events = case.events.iter().enumerate().map(|(index, event)| (event.when, Action::Event(index)));
        let stops = case.stop.when.iter().enumerate();
        let stops = stops.map(|(index, when)| (*when, Action::End(Termination::Condition(index))));
        let ceiling = case.stop.ceiling().map(|condition| (condition.into(), Action::End(Termination::AtmosphereExit)));
        // Under a load limit the mass tells when a part is burnt out; the first waits until a phase says at which.
        let limits = case.events.iter().any(|event| event.then.load_limit.flatten().is_some());
        let spent = Condition { quantity: Quantity::Mass, value: f64::NEG_INFINITY, direction: Direction::Falling };
        let burnout = limits.then_some((spent.into(), Action::Burnout(0)));
        let all: Vec<_> = events
            .chain(stops)
            .chain(ceiling)
            .chain(burnout)
            .map(|(trigger, action)| {
                let is_noted = matches!(action, Action::Event(event) if case.events[event].then == Effect::default());
                PendingCondition::new(trigger, action, !is_noted)
            })
            .collect();
        let waits = |quantity: &Quantity| all.iter().any(|pending| pending.condition.quantity == *quantity);
        let watched = Quantity::ALL.into_iter().filter(waits).collect();
        let track = GreatCircle::of(case.track_start()).map(Dual64::from);
        let around = TAU * case.planet.equatorial_radius();
        let none = [Dual64::from(0.0); Quantity::ALL.len()];
        let mut conditions = Self { all, watched, last: none, before: none, length_before: None, track, around };
        conditions.last = conditions.read(forces, start);
        conditions
    }

    /// A quantity at a moment near the last: the downrange goes on beyond half the globe.
    fn quantity(&self, quantity: Quantity, forces: &Forces, moment: &StateRate) -> Dual64 {
        self.continued(quantity, forces.quantity(quantity, moment, &self.track))
    }

    /// The reading of a quantity next to its last one.
    fn continued<S: Scalar<Value = f64>>(&self, quantity: Quantity, reading: S) -> S {
        match quantity {
            Quantity::Downrange => {
                let turns = ((self.last[quantity as usize].re - reading.value()) / self.around).round();
                reading + turns * self.around
            }
            _ => reading,
        }
    }

    /// Every quantity for which a condition waits.
    fn read(&self, forces: &Forces, moment: &StateRate) -> Readings {
        let loads = OnceCell::new();
        self.read_with(forces, moment, || *loads.get_or_init(|| forces.loads(moment.time, &moment.state)))
    }

    /// The same with the loads at the moment, for which it asks where it needs them.
    pub(super) fn read_with(
        &self,
        forces: &Forces,
        moment: &StateRate,
        loads: impl Fn() -> Loads<Dual64> + Copy,
    ) -> Readings {
        let mut quantities = self.last;
        for watched in &self.watched {
            let reading = forces.quantity_with(*watched, moment, &self.track, loads);
            quantities[*watched as usize] = self.continued(*watched, reading);
        }
        quantities
    }

    fn at_end<F: Formulation<N>, const N: usize>(&self, quantity: Quantity, step: &StepView<F, N>) -> Dual64 {
        self.continued(quantity, step.quantity_at_end(quantity, &self.track))
    }

    /// When the next condition on the time is met, s.
    pub(super) fn next_time(&self) -> f64 {
        let timed = self.armed().filter(|(_, pending)| pending.condition.quantity == Quantity::Time);
        timed.map(|(_, pending)| pending.condition.value).fold(f64::INFINITY, f64::min)
    }

    /// Of every quantity and direction, the condition to which it has the shortest way; the first of several.
    fn nearest(&self) -> [[usize; 2]; Quantity::ALL.len()] {
        let mut nearest = [[(f64::INFINITY, usize::MAX); 2]; Quantity::ALL.len()];
        for (index, pending) in self.armed() {
            let way = pending.before_among(&self.last).re;
            let least = &mut nearest[pending.condition.quantity as usize][pending.condition.direction as usize];
            if way > 0.0 && way < least.0 {
                *least = (way, index);
            }
        }
        nearest.map(|ways| ways.map(|(_, index)| index))
    }

    /// The condition that was found to be met at the present instant is.
    pub(super) fn meet(&mut self, index: usize) {
        self.all[index].status = Status::Due;
    }

    /// Finds all that are met at the present instant by the time, or by a jump from the near side or from the value.
    pub(super) fn detect_jumps(&mut self, forces: &Forces, now: &StateRate) {
        let next = self.read(forces, now);
        let last = std::mem::replace(&mut self.last, next);
        for pending in self.all.iter_mut().filter(|pending| pending.status == Status::Armed) {
            let resolution = pending.condition.resolution();
            let [last, next] = [last, next].map(|quantities| pending.before_among(&quantities).re);
            let jumped = last > resolution && next <= resolution || last >= -resolution && next < -resolution;
            let is_time = pending.condition.quantity == Quantity::Time && next <= resolution;
            if jumped || is_time {
                pending.status = Status::Due;
            }
        }
    }

    /// Finds all whose quantity is on the value at the present instant and moves on to the far side; returns whether there are any.
    ///
    /// However slowly it starts: the motion a moment later decides, not the rate at the instant, which may be zero or a rounding.
    /// `later` gives the moment after some time, s, and moments up to `horizon` are looked at, s.
    pub(super) fn detect_departures(
        &mut self,
        forces: &Forces,
        later: impl Fn(f64) -> StateRate,
        horizon: f64,
    ) -> bool {
        let is_on_value = |pending: &PendingCondition| {
            let off = pending.before_among(&self.last).re - pending.margin;
            pending.condition.quantity != Quantity::Time && off.abs() <= pending.condition.resolution()
        };
        let mut undecided: Vec<_> =
            self.armed().filter(|(_, pending)| is_on_value(pending)).map(|(index, _)| index).collect();
        let mut found = false;
        for (length, is_last) in moments_up_to(horizon) {
            if undecided.is_empty() {
                break;
            }
            let next = self.read(forces, &later(length));
            let Self { all, last, .. } = self;
            undecided.retain(|index| {
                let pending = &mut all[*index];
                let change = (pending.before_among(&next) - pending.before_among(last)).re;
                // To the last, what is far more than a rounding decides.
                let resolution = pending.condition.resolution() * if is_last { 1e-3 } else { 1.0 };
                if change < -resolution {
                    pending.status = Status::Due;
                    found = true;
                } else {
                    pending.margin = 2.0 * pending.condition.resolution();
                }
                change.abs() <= resolution
            });
        }
        found
    }

    /// The first of the events and burnouts that are due, which it then is no more: it happens at a time, s, from which others count.
    pub(super) fn next_event(&mut self, time: f64) -> Option<Cause> {
        let event = |pending: &mut PendingCondition| {
            let cause = match (pending.status, pending.action) {
                (Status::Due, Action::Event(event)) => Cause::Event(event),
                (Status::Due, Action::Burnout(part)) => Cause::Burnout(part),
                _ => return None,
            };
            pending.status = Status::Done;
            Some(cause)
        };
        let cause = self.all.iter_mut().find_map(event)?;
        self.happened(cause, time);
        Some(cause)
    }

    /// Something has happened at a time, s, from which others count; not for the first time, if a part burns out that was lit again.
    pub(super) fn happened(&mut self, cause: Cause, time: f64) {
        for pending in self.all.iter_mut().filter(|pending| pending.status == Status::Dormant) {
            if let Some((_, delay)) = pending.waits_for.filter(|(other, _)| *other == cause) {
                pending.condition.value = time + delay;
                pending.status = Status::Armed;
            }
        }
    }

    /// Expects a part to burn out at a mass, kg, or none to do so.
    pub(super) fn expect_burnout(&mut self, at: Option<(f64, usize)>) {
        for pending in self.all.iter_mut().filter(|pending| matches!(pending.action, Action::Burnout(_))) {
            pending.status = if at.is_some() { Status::Armed } else { Status::Dormant };
            if let Some((mass, part)) = at {
                (pending.condition.value, pending.action) = (mass, Action::Burnout(part));
            }
        }
    }

    /// How the flight ends, if a condition for that is due.
    pub(super) fn end(&self) -> Option<Termination> {
        self.all.iter().find_map(|pending| match (pending.status, pending.action) {
            (Status::Due, Action::End(termination)) => Some(termination),
            _ => None,
        })
    }

    /// What was read before the present instant tells nothing of what comes.
    pub(super) fn forget(&mut self) {
        self.length_before = None;
    }

    /// Whether any condition is met at the present instant.
    pub(super) fn is_due(&self) -> bool {
        self.all.iter().any(|pending| pending.status == Status::Due)
    }

    /// Whether nothing happens in a step of a length, s, with such readings at its end. Conditions on the time, beyond which no step goes, are not
    /// asked.
    pub(super) fn is_quiet(&self, forces: &Forces, ends: &Readings, length: f64) -> bool {
        let mut waiting = self.armed().filter(|(_, pending)| pending.condition.quantity != Quantity::Time);
        waiting.all(|(_, pending)| {
            let [start, end] = [&self.last, ends].map(|readings| pending.before_among(readings));
            !event::may_cross(start, end, length, forces.has_tables())
        })
    }

    /// Goes on to the end of a step of a length, s, by the readings there. Conditions that are met there are due; where the step is cut, those that are
    /// on their values to rounding are too.
    pub(super) fn go_on(&mut self, ends: &Readings, length: f64, is_cut: bool) {
        self.before = std::mem::replace(&mut self.last, *ends);
        self.length_before = Some(length);
        let Self { all, before, last, .. } = self;
        for pending in all.iter_mut().filter(|pending| pending.status == Status::Armed) {
            let [last, next] = [&*before, &*last].map(|quantities| pending.before_among(quantities).re);
            // Where conditions are met together, one of them cuts the step, and the others are on their values to rounding.
            let reached = if is_cut { pending.condition.resolution() } else { 0.0 };
            if last > reached && next <= reached {
                pending.status = Status::Due;
            }
            // Once well on the near side, it is met on the value itself.
            if next > 2.0 * pending.margin {
                pending.margin = 0.0;
            }
        }
    }

    /// Whether one of the loads is watched.
    pub(super) fn watches_loads(&self) -> bool {
        self.watched.iter().any(|quantity| quantity.is_load())
    }

    /// Whether nothing is watched.
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    fn armed(&self) -> impl Iterator<Item = (usize, &PendingCondition)> {
        self.all.iter().enumerate().filter(|(_, pending)| pending.status == Status::Armed)
    }
}

/// How far the quantity of a condition is before its value, in a step.
struct ConditionInside<'a, 'b, F, const N: usize> {
    detector: &'a ConditionDetector,
    /// The place of the condition in the list.
    index: usize,
    step: &'a StepView<'b, F, N>,
}

impl<F: Formulation<N>, const N: usize> Inside for ConditionInside<'_, '_, F, N> {
    fn at(&self, part: f64) -> Dual64 {
        self.detector.ahead(self.index, self.step.motion.forces(), &self.step.on_dense_output(part))
    }

    fn value_at(&self, part: f64) -> f64 {
        let Self { detector, index, step } = self;
        let pending = &detector.all[*index];
        let quantity = pending.condition.quantity;
        let track = detector.track.map(|number| number.re);
        let reading = step.motion.forces().quantity(quantity, &step.state_inside(part), &track);
        pending.before(detector.continued(quantity, reading))
    }
}

impl Detector for ConditionDetector {
    /// The place of the condition in the list.
    type Located = usize;

    /// The first condition that is met; those on the time are not met before the end of a step, and what is met at the end does not cut it.
    fn locate<F: Formulation<N>, const N: usize>(&self, step: &StepView<F, N>) -> Option<(f64, usize)> {
        let mut first: Option<(f64, usize)> = None;
        let length = step.length();
        let forces = step.motion.forces();
        let nearest = OnceCell::new();
        for (index, pending) in self.armed() {
            let quantity = pending.condition.quantity;
            if quantity == Quantity::Time {
                continue;
            }
            let start = pending.before_among(&self.last);
            let end = pending.before(self.at_end(quantity, step));
            if !event::may_cross(start, end, length, forces.has_tables()) {
                continue;
            }
            // A quantity comes to the nearest value before it comes to those beyond.
            let nearest = nearest.get_or_init(|| self.nearest());
            let is_behind = nearest[quantity as usize][pending.condition.direction as usize] != index;
            if start.re > 0.0 && is_behind {
                continue;
            }
            let inside = ConditionInside { detector: self, index, step };
            if let Some(part) = event::first_crossing(start, end, length, forces.has_tables(), &inside)
                && first.is_none_or(|(least, _)| part < least)
            {
                first = Some((part, index));
            }
        }
        first.filter(|(part, _)| *part < AT_END)
    }

    fn ahead(&self, index: usize, forces: &Forces, now: &StateRate) -> Dual64 {
        let pending = &self.all[index];
        pending.before(self.quantity(pending.condition.quantity, forces, now))
    }

    fn predict(&self, _: &Forces, within: f64) -> Option<PredictedCrossing> {
        // What is only noted leaves the steps as they are.
        let decides =
            |pending: &PendingCondition| pending.changes_flight && pending.condition.quantity != Quantity::Time;
        let waiting = self.armed().filter(|(_, pending)| decides(pending));
        let predicted = waiting.filter_map(|(_, pending)| {
            let before = self.length_before.map(|length| (length, pending.before_among(&self.before)));
            event::predicted_fall(pending.before_among(&self.last), before, within)
        });
        PredictedCrossing::first(predicted)
    }

    fn follow<F: Formulation<N>, const N: usize>(&mut self, step: &StepView<F, N>) {
        if self.is_empty() {
            return;
        }
        let mut ends = self.last;
        for watched in &self.watched {
            ends[*watched as usize] = self.at_end(*watched, step);
        }
        self.go_on(&ends, step.length(), step.is_cut());
    }
}

/// Times, s, after which it is seen whether a quantity rises or falls: each four times the one before, up to a horizon; with whether it is the last.
pub(super) fn moments_up_to(horizon: f64) -> impl Iterator<Item = (f64, bool)> {
    const LOOKS: i32 = 10;
    (0..LOOKS).map(move |look| (horizon * 0.25_f64.powi(LOOKS - 1 - look), look == LOOKS - 1))
}
