//! The conditions of the events and of the stops of a case.

use std::f64::consts::TAU;

use num_dual::Dual64;

use super::detector::{AT_END, Detector};
use super::step_view::StepView;
use crate::coordinates::GreatCircle;
use crate::event::{Condition, Direction, Quantity, Trigger};
use crate::integrate::event::{self, Foreseen};
use crate::motion::{Forces, Formulation, StateRate};
use crate::scenario::Case;
use crate::trajectory::Termination;

/// Detects where conditions are met that have not been met yet.
pub(super) struct ConditionDetector {
    all: Vec<PendingCondition>,
    /// The quantities for which a condition waits.
    watched: Vec<Quantity>,
    /// Of these, with their rates, at the end of the last step; the others are zero.
    last: Readings,
    /// The same at its start, with its length, s.
    before: Option<(f64, Readings)>,
    /// The initial great circle, from which downrange and ground range are measured.
    track: GreatCircle<Dual64>,
    /// The circumference of the sphere on which they are, m.
    around: f64,
}

/// Every quantity, with its rate.
type Readings = [Dual64; Quantity::ALL.len()];

/// A condition, and the action that follows when it is met.
struct PendingCondition {
    /// That of an event which waits for another is on the time, which is set when the other happens.
    condition: Condition,
    /// So far beyond the value the condition is met, in its unit: 0, but for a quantity that began on the value and has not moved on to
    /// the far side.
    margin: f64,
    /// The event for which it waits, and the delay after it, s.
    waits_for: Option<(usize, f64)>,
    action: Action,
    status: Status,
}

/// What follows when a condition is met.
#[derive(Clone, Copy)]
enum Action {
    /// The event of this place in the list.
    Event(usize),
    /// The end of the flight.
    End(Termination),
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
    fn new(trigger: Trigger, action: Action) -> Self {
        let at = |value| Condition { quantity: Quantity::Time, value, direction: Direction::Rising };
        let (condition, waits_for, status) = match trigger {
            Trigger::Condition(condition) => (condition, None, Status::Armed),
            Trigger::After { event, delay } => (at(f64::INFINITY), Some((event, delay)), Status::Dormant),
        };
        Self { condition, margin: 0.0, waits_for, action, status }
    }

    /// How far the quantity is before the value.
    fn before(&self, quantity: Dual64) -> Dual64 {
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
        let all: Vec<_> = events
            .chain(stops)
            .chain(ceiling)
            .map(|(trigger, action)| PendingCondition::new(trigger, action))
            .collect();
        let waits = |quantity: &Quantity| all.iter().any(|pending| pending.condition.quantity == *quantity);
        let watched = Quantity::ALL.into_iter().filter(waits).collect();
        let track = GreatCircle::of(&case.initial_state).map(Dual64::from);
        let around = TAU * case.planet.equatorial_radius();
        let mut conditions =
            Self { all, watched, last: [Dual64::from(0.0); Quantity::ALL.len()], before: None, track, around };
        conditions.last = conditions.read(forces, start);
        conditions
    }

    /// A quantity at a moment near the last: the downrange goes on beyond half the globe.
    fn quantity(&self, quantity: Quantity, forces: &Forces, moment: &StateRate) -> Dual64 {
        self.continued(quantity, forces.quantity(quantity, moment, &self.track))
    }

    /// The reading of a quantity next to its last one.
    fn continued(&self, quantity: Quantity, reading: Dual64) -> Dual64 {
        match quantity {
            Quantity::Downrange => {
                let turns = ((self.last[quantity as usize].re - reading.re) / self.around).round();
                reading + turns * self.around
            }
            _ => reading,
        }
    }

    /// Every quantity for which a condition waits.
    fn read(&self, forces: &Forces, moment: &StateRate) -> Readings {
        self.gather(|quantity| self.quantity(quantity, forces, moment))
    }

    /// The same at the end of a step.
    fn read_end<F: Formulation<N>, const N: usize>(&self, step: &StepView<F, N>) -> Readings {
        self.gather(|quantity| self.at_end(quantity, step))
    }

    fn gather(&self, reading: impl Fn(Quantity) -> Dual64) -> Readings {
        let mut quantities = self.last;
        for watched in &self.watched {
            quantities[*watched as usize] = reading(*watched);
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

    /// The first of the events that are due, which it then is no more: it happens at a time, s, from which others count.
    pub(super) fn next_event(&mut self, time: f64) -> Option<usize> {
        let event = |pending: &mut PendingCondition| match (pending.status, pending.action) {
            (Status::Due, Action::Event(event)) => {
                pending.status = Status::Done;
                Some(event)
            }
            _ => None,
        };
        let event = self.all.iter_mut().find_map(event)?;
        for pending in &mut self.all {
            if let Some((_, delay)) = pending.waits_for.filter(|(other, _)| *other == event) {
                pending.condition.value = time + delay;
                pending.status = Status::Armed;
            }
        }
        Some(event)
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
        self.before = None;
    }

    /// Whether any condition is met at the present instant.
    pub(super) fn is_due(&self) -> bool {
        self.all.iter().any(|pending| pending.status == Status::Due)
    }

    /// Whether nothing is watched.
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    fn armed(&self) -> impl Iterator<Item = (usize, &PendingCondition)> {
        self.all.iter().enumerate().filter(|(_, pending)| pending.status == Status::Armed)
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
        let nearest = self.nearest();
        for (index, pending) in self.armed() {
            let quantity = pending.condition.quantity;
            if quantity == Quantity::Time {
                continue;
            }
            let start = pending.before_among(&self.last);
            let end = pending.before(self.at_end(quantity, step));
            // A quantity comes to the nearest value before it comes to those beyond.
            let is_behind = nearest[quantity as usize][pending.condition.direction as usize] != index;
            if start.re > 0.0 && is_behind {
                continue;
            }
            let inside = |part| self.ahead(index, forces, &step.inside(part));
            if let Some(part) = event::first_crossing(start, end, length, forces.has_tables(), inside)
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

    fn foresee(&self, _: &Forces, within: f64) -> Option<Foreseen> {
        let waiting = self.armed().filter(|(_, pending)| pending.condition.quantity != Quantity::Time);
        let foreseen = waiting.filter_map(|(_, pending)| {
            let before = self.before.as_ref().map(|(length, readings)| (*length, pending.before_among(readings)));
            event::foreseen_fall(pending.before_among(&self.last), before, within)
        });
        Foreseen::first(foreseen)
    }

    fn follow<F: Formulation<N>, const N: usize>(&mut self, step: &StepView<F, N>) {
        if self.is_empty() {
            return;
        }
        let next = self.read_end(step);
        let last = std::mem::replace(&mut self.last, next);
        self.before = Some((step.length(), last));
        for pending in self.all.iter_mut().filter(|pending| pending.status == Status::Armed) {
            let [last, next] = [last, next].map(|quantities| pending.before_among(&quantities).re);
            // Where conditions are met together, one of them cuts the step.
            if last > 0.0 && next <= 0.0 {
                pending.status = Status::Due;
            }
            // Once well on the near side, it is met on the value itself.
            if next > 2.0 * pending.margin {
                pending.margin = 0.0;
            }
        }
    }
}

/// Times, s, after which it is seen whether a quantity rises or falls: each four times the one before, up to a horizon; with whether it is the last.
pub(super) fn moments_up_to(horizon: f64) -> impl Iterator<Item = (f64, bool)> {
    const LOOKS: i32 = 10;
    (0..LOOKS).map(move |look| (horizon * 0.25_f64.powi(LOOKS - 1 - look), look == LOOKS - 1))
}
