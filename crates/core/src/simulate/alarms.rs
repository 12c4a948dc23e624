//! Conditions that a flight watches on its way: of its events, and of its end.

use num_dual::Dual64;

use super::passage::{Moment, Passage};
use crate::event::{Condition, Quantity};
use crate::integrate::event;
use crate::motion::{Forces, Formulation};
use crate::scenario::Case;
use crate::trajectory::Termination;

/// The conditions that have not been met yet.
pub(super) struct Alarms {
    all: Vec<Alarm>,
    /// The quantities for which a condition waits.
    watched: Vec<Quantity>,
    /// Of these, with their rates, at the end of the last step; the others are zero.
    last: [Dual64; Quantity::ALL.len()],
}

/// A condition, and what it sets off.
struct Alarm {
    condition: Condition,
    sets_off: SetsOff,
    state: State,
}

/// What a condition sets off.
#[derive(Clone, Copy)]
enum SetsOff {
    /// The event of this place in the list.
    Event(usize),
    /// The end of the flight.
    End(Termination),
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    /// It waits.
    Armed,
    /// It is met at the present instant.
    Due,
    /// It was met, and is not looked at any more.
    Done,
}

impl Alarms {
    /// Those of a case, all waiting, for a flight that starts at a moment.
    pub(super) fn new(case: &Case, forces: &Forces, start: &Moment) -> Self {
        let events = case.events.iter().enumerate().map(|(index, event)| (event.when, SetsOff::Event(index)));
        let stops = case.stop.when.iter().enumerate();
        let stops = stops.map(|(index, condition)| (*condition, SetsOff::End(Termination::Condition(index))));
        let ceiling = case.stop.ceiling().map(|condition| (condition, SetsOff::End(Termination::AtmosphereExit)));
        let all = events.chain(stops).chain(ceiling);
        let armed = |(condition, sets_off)| Alarm { condition, sets_off, state: State::Armed };
        let all: Vec<_> = all.map(armed).collect();
        let waits = |quantity: &Quantity| all.iter().any(|alarm| alarm.condition.quantity == *quantity);
        let watched = Quantity::ALL.into_iter().filter(waits).collect();
        let mut alarms = Self { all, watched, last: [Dual64::from(0.0); Quantity::ALL.len()] };
        alarms.last = alarms.read(|quantity| forces.quantity(quantity, start.time, &start.state));
        alarms
    }

    /// Every quantity for which a condition waits.
    fn read(&self, quantity: impl Fn(Quantity) -> Dual64) -> [Dual64; Quantity::ALL.len()] {
        let mut quantities = self.last;
        for watched in &self.watched {
            quantities[*watched as usize] = quantity(*watched);
        }
        quantities
    }

    /// When the next condition on the time is met, s.
    pub(super) fn next_time(&self) -> f64 {
        let timed = self.armed().filter(|(_, alarm)| alarm.condition.quantity == Quantity::Time);
        timed.map(|(_, alarm)| alarm.condition.value).fold(f64::INFINITY, f64::min)
    }

    /// The part of a step at which the first of the conditions is met, and which it is; those on the time are not met before a step's end.
    pub(super) fn first<F: Formulation<N>, const N: usize>(&self, passage: &Passage<F, N>) -> Option<(f64, usize)> {
        let mut first: Option<(f64, usize)> = None;
        let length = passage.step.length();
        let nearest = self.nearest();
        for (index, Alarm { condition, .. }) in self.armed() {
            let quantity = condition.quantity;
            if quantity == Quantity::Time {
                continue;
            }
            let [start, end] = [self.last[quantity as usize], passage.quantity_at_end(quantity)]
                .map(|quantity| condition.before(quantity));
            // A quantity comes to the nearest value before it comes to those beyond.
            let is_behind = nearest[quantity as usize][condition.direction as usize] != index;
            if start.re > 0.0 && is_behind {
                continue;
            }
            let inside = |part| before(condition, passage.motion.forces(), &passage.inside(part));
            if let Some(part) = event::first_crossing(start, end, length, inside)
                && first.is_none_or(|(least, _)| part < least)
            {
                first = Some((part, index));
            }
        }
        first
    }

    /// Of every quantity and direction, the condition to which it has the shortest way; the first of several.
    fn nearest(&self) -> [[usize; 2]; Quantity::ALL.len()] {
        let mut nearest = [[(f64::INFINITY, usize::MAX); 2]; Quantity::ALL.len()];
        for (index, Alarm { condition, .. }) in self.armed() {
            let quantity = condition.quantity as usize;
            let way = condition.before(self.last[quantity]).re;
            let least = &mut nearest[quantity][condition.direction as usize];
            if way > 0.0 && way < least.0 {
                *least = (way, index);
            }
        }
        nearest.map(|ways| ways.map(|(_, index)| index))
    }

    /// How far a quantity is before the value of a condition.
    pub(super) fn before(&self, index: usize, forces: &Forces, moment: &Moment) -> Dual64 {
        before(&self.all[index].condition, forces, moment)
    }

    /// Goes to the end of a step.
    pub(super) fn follow<F: Formulation<N>, const N: usize>(&mut self, passage: &Passage<F, N>) {
        if self.is_empty() {
            return;
        }
        let next = self.read(|quantity| passage.quantity_at_end(quantity));
        let last = std::mem::replace(&mut self.last, next);
        for alarm in self.all.iter_mut().filter(|alarm| alarm.state == State::Armed) {
            let [last, next] = [last, next].map(|of| alarm.condition.before(of[alarm.condition.quantity as usize]).re);
            // Where conditions are met together, one of them cuts the step.
            if last > 0.0 && next <= 0.0 {
                alarm.state = State::Due;
            }
        }
    }

    /// The condition that was found to be met at the present instant is.
    pub(super) fn meet(&mut self, index: usize) {
        self.all[index].state = State::Due;
    }

    /// Finds all that are met at the present instant: on their value and moving on, or beyond it by a jump.
    pub(super) fn look(&mut self, forces: &Forces, now: &Moment) {
        let next = self.read(|quantity| forces.quantity(quantity, now.time, &now.state));
        let last = std::mem::replace(&mut self.last, next);
        for alarm in self.all.iter_mut().filter(|alarm| alarm.state == State::Armed) {
            let of = |quantities: [Dual64; _]| alarm.condition.before(quantities[alarm.condition.quantity as usize]);
            let [last, next] = [of(last), of(next)];
            let passes = next.re.abs() <= alarm.condition.resolution() && next.eps < 0.0;
            let jumped = last.re > 0.0 && next.re <= 0.0;
            if passes || jumped {
                alarm.state = State::Due;
            }
        }
    }

    /// The first of the events that are due, which it then is no more.
    pub(super) fn next_event(&mut self) -> Option<usize> {
        let event = |alarm: &mut Alarm| match (alarm.state, alarm.sets_off) {
            (State::Due, SetsOff::Event(event)) => {
                alarm.state = State::Done;
                Some(event)
            }
            _ => None,
        };
        self.all.iter_mut().find_map(event)
    }

    /// How the flight ends, if a condition for that is due.
    pub(super) fn end(&self) -> Option<Termination> {
        self.all.iter().find_map(|alarm| match (alarm.state, alarm.sets_off) {
            (State::Due, SetsOff::End(termination)) => Some(termination),
            _ => None,
        })
    }

    /// Whether any condition is met at the present instant.
    pub(super) fn is_due(&self) -> bool {
        self.all.iter().any(|alarm| alarm.state == State::Due)
    }

    /// Whether nothing is watched.
    pub(super) fn is_empty(&self) -> bool {
        self.all.is_empty()
    }

    fn armed(&self) -> impl Iterator<Item = (usize, &Alarm)> {
        self.all.iter().enumerate().filter(|(_, alarm)| alarm.state == State::Armed)
    }
}

/// How far a quantity is before the value of a condition.
fn before(condition: &Condition, forces: &Forces, moment: &Moment) -> Dual64 {
    condition.before(forces.quantity(condition.quantity, moment.time, &moment.state))
}
