//! Whose turn it is to compute: those who have computed least come first.

use std::collections::VecDeque;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use tokio::sync::oneshot::{Receiver, Sender, channel};

/// What a job may compute before it gives way to all that have computed less, level by level. Most flights take less than the first; on
/// the last level, beyond all of these, jobs are finished one after another, since they would all come late if they took turns.
const LEVELS: [Duration; 2] = [Duration::from_millis(5), Duration::from_millis(50)];

/// No level.
const NONE: usize = LEVELS.len() + 1;

/// The level of a job that has computed for so long.
pub(super) fn level(computed: Duration) -> usize {
    LEVELS.partition_point(|bound| *bound <= computed)
}

/// The turns of some workers.
#[derive(Debug)]
pub(super) struct Turns {
    state: Mutex<State>,
    /// The first level on which somebody waits.
    first: AtomicUsize,
}

#[derive(Debug)]
struct State {
    /// Turns that nobody has.
    free: usize,
    /// Those who wait, on each level, the next one first.
    waiting: [VecDeque<Sender<Turn>>; NONE],
}

/// A worker's turn, which goes to the next when it is dropped.
#[derive(Debug)]
pub(super) struct Turn {
    /// None once it has gone on.
    turns: Option<Arc<Turns>>,
}

impl Turns {
    pub(super) fn new(workers: usize) -> Arc<Self> {
        let state = State { free: workers, waiting: std::array::from_fn(|_| VecDeque::new()) };
        Arc::new(Self { state: Mutex::new(state), first: AtomicUsize::new(NONE) })
    }

    /// Asks for a turn; `again` where one on this level had to give way, and goes on before the others of its level.
    pub(super) fn ask(self: &Arc<Self>, level: usize, again: bool) -> Receiver<Turn> {
        let (sender, receiver) = channel();
        let mut state = self.lock();
        if again {
            state.waiting[level].push_front(sender);
        } else {
            state.waiting[level].push_back(sender);
        }
        self.hand_out(&mut state);
        receiver
    }

    /// The first level on which somebody waits, if anybody does.
    pub(super) fn first_waiting(&self) -> Option<usize> {
        Some(self.first.load(Ordering::Relaxed)).filter(|first| *first < NONE)
    }

    /// Gives what turns there are to those who wait.
    fn hand_out(self: &Arc<Self>, state: &mut State) {
        while state.free > 0
            && let Some(next) = state.waiting.iter_mut().find_map(VecDeque::pop_front)
        {
            // One who has gone wants none.
            match next.send(Turn { turns: Some(Arc::clone(self)) }) {
                Ok(()) => state.free -= 1,
                Err(mut refused) => refused.turns = None,
            }
        }
        let first = state.waiting.iter().position(|waiting| !waiting.is_empty());
        self.first.store(first.unwrap_or(NONE), Ordering::Relaxed);
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        if let Some(turns) = self.turns.take() {
            let mut state = turns.lock();
            state.free += 1;
            turns.hand_out(&mut state);
        }
    }
}

#[cfg(test)]
mod tests {
    use std::time::Duration;

    use super::{Turns, level};

    #[test]
    fn a_job_comes_to_the_next_level_when_it_has_computed_for_so_long() {
        let milliseconds = [0, 4, 5, 49, 50, 10_000];
        assert_eq!(milliseconds.map(|time| level(Duration::from_millis(time))), [0, 0, 1, 1, 2, 2]);
    }

    #[test]
    fn who_has_computed_least_is_next_and_who_gave_way_is_first_of_its_level() {
        let turns = Turns::new(1);
        let mut running = turns.ask(0, false).try_recv().unwrap();
        assert_eq!(turns.first_waiting(), None);
        let waiting = [(2, false), (1, false), (2, true), (0, false), (0, false)];
        let mut waiting = waiting.map(|(level, again)| turns.ask(level, again));
        for next in [3, 4, 1, 2, 0] {
            assert!(waiting.iter_mut().all(|receiver| receiver.try_recv().is_err()));
            drop(running);
            running = waiting[next].try_recv().unwrap();
        }
        assert_eq!(turns.first_waiting(), None);
    }

    #[test]
    fn a_turn_passes_those_by_who_have_gone() {
        let turns = Turns::new(1);
        let running = turns.ask(0, false).try_recv().unwrap();
        drop(turns.ask(0, false));
        let given = turns.ask(1, false);
        let mut last = turns.ask(2, false);
        drop(running);
        // It was given, and not taken.
        drop(given);
        assert!(last.try_recv().is_ok());
        assert!(turns.ask(0, false).try_recv().is_ok());
    }
}
