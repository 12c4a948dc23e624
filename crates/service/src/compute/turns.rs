//! Whose turn it is to compute: short jobs come first, and long ones have half of the time at least.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::sync::oneshot::{Receiver, Sender, channel};

/// From here on a job is long, by the processor time that it has taken. Nearly all flights take less.
pub(super) const LONG: Duration = Duration::from_millis(100);

/// What short jobs may compute beyond the half that is theirs, while long ones wait.
const LEAD: Duration = Duration::from_millis(5);

/// The turns of some workers.
#[derive(Debug)]
pub(super) struct Turns {
    state: Mutex<State>,
    /// Whether a short job waits.
    short_waits: AtomicBool,
    /// How much longer short jobs have computed, while long ones waited, than long ones have since, ns.
    lead: AtomicU64,
}

#[derive(Debug)]
struct State {
    /// Turns that nobody has.
    free: usize,
    /// Those who wait, the next one first.
    short: VecDeque<Sender<Turn>>,
    /// The same of long jobs: they are finished one after another, since they would all come late if they took turns.
    long: VecDeque<Sender<Turn>>,
}

/// Which place in the queue a job asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Behind the other short jobs.
    Short,
    /// Behind the other long jobs.
    Long,
    /// Before the other long jobs, as it has given its turn to short ones.
    LongAgain,
}

/// A worker's turn, which goes to the next when it is dropped.
#[derive(Debug)]
pub(super) struct Turn {
    /// None once it has gone on.
    turns: Option<Arc<Turns>>,
    is_long: bool,
    since: Instant,
}

impl Turns {
    pub(super) fn new(workers: usize) -> Arc<Self> {
        let state = State { free: workers, short: VecDeque::new(), long: VecDeque::new() };
        Arc::new(Self { state: Mutex::new(state), short_waits: AtomicBool::new(false), lead: AtomicU64::new(0) })
    }

    /// Asks for a turn.
    pub(super) fn ask(self: &Arc<Self>, place: Place) -> Receiver<Turn> {
        let (sender, receiver) = channel();
        let mut state = self.lock();
        match place {
            Place::Short => state.short.push_back(sender),
            Place::Long => state.long.push_back(sender),
            Place::LongAgain => state.long.push_front(sender),
        }
        self.hand_out(&mut state);
        receiver
    }

    /// Whether a short job waits.
    pub(super) fn are_wanted(&self) -> bool {
        self.short_waits.load(Ordering::Relaxed)
    }

    /// Whether a long job that has had its turn for so long is to give it to a short one.
    pub(super) fn are_due(&self, had: Duration) -> bool {
        self.are_wanted() && self.lead() <= had
    }

    fn lead(&self) -> Duration {
        Duration::from_nanos(self.lead.load(Ordering::Relaxed))
    }

    /// A job has had its turn for so long.
    fn count(&self, state: &State, is_long: bool, had: Duration) {
        let lead = match is_long {
            true => self.lead().saturating_sub(had),
            false if state.long.is_empty() => return,
            false => self.lead() + had,
        };
        self.lead.store(u64::try_from(lead.as_nanos()).unwrap_or(u64::MAX), Ordering::Relaxed);
    }

    /// Gives what turns there are to those who wait.
    fn hand_out(self: &Arc<Self>, state: &mut State) {
        while state.free > 0
            && let Some((is_long, next)) = state.next(self.lead() > LEAD)
        {
            // One who has gone wants none.
            match next.send(Turn { turns: Some(Arc::clone(self)), is_long, since: Instant::now() }) {
                Ok(()) => state.free -= 1,
                Err(mut refused) => refused.turns = None,
            }
        }
        self.short_waits.store(!state.short.is_empty(), Ordering::Relaxed);
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// The next, and whether it is a long one.
    fn next(&mut self, long_first: bool) -> Option<(bool, Sender<Turn>)> {
        let of = |queue: &mut VecDeque<_>, is_long| queue.pop_front().map(|next| (is_long, next));
        if long_first && !self.long.is_empty() {
            return of(&mut self.long, true);
        }
        of(&mut self.short, false).or_else(|| of(&mut self.long, true))
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        if let Some(turns) = self.turns.take() {
            let mut state = turns.lock();
            turns.count(&state, self.is_long, self.since.elapsed());
            state.free += 1;
            turns.hand_out(&mut state);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Place, Turns};

    #[test]
    fn short_jobs_are_next_and_a_long_one_that_gave_way_is_the_first_of_the_long() {
        let turns = Turns::new(1);
        let mut running = turns.ask(Place::Short).try_recv().unwrap();
        assert!(!turns.are_wanted());
        let waiting = [Place::Long, Place::LongAgain, Place::Short, Place::Short];
        let mut waiting = waiting.map(|place| turns.ask(place));
        for next in [2, 3, 1, 0] {
            assert!(waiting.iter_mut().all(|receiver| receiver.try_recv().is_err()));
            drop(running);
            running = waiting[next].try_recv().unwrap();
        }
        assert!(!turns.are_wanted());
    }

    #[test]
    fn long_jobs_have_half_of_the_time() {
        let turns = Turns::new(1);
        let running = turns.ask(Place::Short).try_recv().unwrap();
        let (mut short, mut long) = (turns.ask(Place::Short), turns.ask(Place::Long));
        let are_due = |had| turns.are_due(Duration::from_millis(had));
        assert!(are_due(0));
        turns.count(&turns.lock(), false, Duration::from_millis(10));
        // The lead of the short ones is to be made up for.
        assert!(!are_due(9));
        drop(running);
        assert!(short.try_recv().is_err());
        let running = long.try_recv().unwrap();
        assert!(!are_due(9));
        turns.count(&turns.lock(), true, Duration::from_secs(1));
        assert!(are_due(0));
        drop(running);
        assert!(short.try_recv().is_ok());
    }

    #[test]
    fn a_turn_passes_those_by_who_have_gone() {
        let turns = Turns::new(1);
        let running = turns.ask(Place::Short).try_recv().unwrap();
        drop(turns.ask(Place::Short));
        let given = turns.ask(Place::Short);
        let mut last = turns.ask(Place::Long);
        drop(running);
        // It was given, and not taken.
        drop(given);
        assert!(last.try_recv().is_ok());
        assert!(turns.ask(Place::Short).try_recv().is_ok());
    }
}
