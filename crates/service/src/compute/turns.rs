//! Whose turn it is to compute: short jobs come first, and long ones have half of the time at least.

use std::collections::VecDeque;
use std::fmt;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::runtime::Handle;
use tokio::sync::oneshot::{Receiver, Sender, channel};

/// From here on a job is long, by the processor time that it has taken, where no other is suspended. Nearly all flights take less.
const LONG: Duration = Duration::from_millis(50);

/// From here on, where as many are suspended as may be.
const LEAST_LONG: Duration = Duration::from_millis(2);

/// From where on a job is long, where so many more may be suspended of all: the more there are, the sooner the next is known to be one.
pub(super) fn long(places: usize, of_all: usize) -> Duration {
    let places = u32::try_from(places).unwrap_or(u32::MAX);
    let of_all = u32::try_from(of_all).unwrap_or(u32::MAX);
    (LONG / of_all.max(1)).saturating_mul(places).max(LEAST_LONG)
}

/// What short jobs may compute beyond the half that is theirs, while long ones wait.
const LEAD: Duration = Duration::from_millis(5);

/// A job that has not begun; it gives its turn back, unless it has given it to another.
pub(super) type Job = Box<dyn FnOnce(Turn) -> Option<Turn> + Send>;

/// The turns of some workers: threads that go from one job to the next, since to wake another for each would cost as much as a short flight.
#[derive(Debug)]
pub(super) struct Turns {
    state: Mutex<State>,
    /// Whether a short job waits.
    short_waits: AtomicBool,
    /// How much longer short jobs have computed, while long ones waited, than long ones have since, ns.
    lead: AtomicU64,
    threads: Handle,
}

struct State {
    /// Turns that nobody has.
    free: usize,
    /// Jobs that have not begun, the next one first.
    short: VecDeque<Job>,
    /// Jobs that are suspended, the next one first: they are finished one after another, since they would all come late if they took turns.
    long: VecDeque<Sender<Turn>>,
}

impl fmt::Debug for State {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { free, short, long } = self;
        f.debug_struct("State").field("free", free).field("short", &short.len()).field("long", &long.len()).finish()
    }
}

/// Which place a job asks for that has been suspended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Place {
    /// Behind the others.
    Last,
    /// Before the others, as it has had a turn before and given it to a short job.
    First,
}

/// A worker's turn, which goes to the next when it is dropped.
#[derive(Debug)]
pub(super) struct Turn {
    /// None once it has gone on.
    turns: Option<Arc<Turns>>,
    is_long: bool,
    since: Instant,
}

/// Who is next.
enum Next {
    Short(Job),
    Long(Sender<Turn>),
}

/// Who has been given a turn.
enum Granted {
    /// A job that is to begin.
    Begun(Job, Turn),
    /// A job that was suspended.
    Resumed,
}

impl Turns {
    /// The turns of so many workers, which are threads of a runtime.
    pub(super) fn new(workers: usize, threads: Handle) -> Arc<Self> {
        let state = State { free: workers, short: VecDeque::new(), long: VecDeque::new() };
        let (short_waits, lead) = (AtomicBool::new(false), AtomicU64::new(0));
        Arc::new(Self { state: Mutex::new(state), short_waits, lead, threads })
    }

    /// Has a job run when its turn comes.
    pub(super) fn submit(self: &Arc<Self>, job: Job) {
        let mut state = self.lock();
        state.short.push_back(job);
        self.hand_out(state);
    }

    /// Asks for a turn again.
    pub(super) fn ask(self: &Arc<Self>, place: Place) -> Receiver<Turn> {
        let (sender, receiver) = channel();
        let mut state = self.lock();
        match place {
            Place::Last => state.long.push_back(sender),
            Place::First => state.long.push_front(sender),
        }
        self.hand_out(state);
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
    fn hand_out(self: &Arc<Self>, mut state: MutexGuard<State>) {
        let mut begun = Vec::new();
        while state.free > 0
            && let Some(granted) = self.grant(&mut state)
        {
            if let Granted::Begun(job, turn) = granted {
                begun.push((job, turn));
            }
        }
        self.note(&state);
        drop(state);
        for (job, turn) in begun {
            self.threads.spawn_blocking(move || work(job, turn));
        }
    }

    /// Gives one of the free turns to the next who waits, if anybody does.
    fn grant(self: &Arc<Self>, state: &mut State) -> Option<Granted> {
        let turn = |is_long| Turn { turns: Some(Arc::clone(self)), is_long, since: Instant::now() };
        let granted = loop {
            match state.next(self.lead() > LEAD) {
                Some(Next::Short(job)) => break Some(Granted::Begun(job, turn(false))),
                Some(Next::Long(suspended)) => match suspended.send(turn(true)) {
                    Ok(()) => break Some(Granted::Resumed),
                    // One who has gone wants none.
                    Err(mut refused) => refused.turns = None,
                },
                None => break None,
            }
        };
        state.free -= usize::from(granted.is_some());
        self.note(state);
        granted
    }

    /// Notes whether a short job waits, for those who ask without waiting for the state.
    fn note(&self, state: &State) {
        self.short_waits.store(!state.short.is_empty(), Ordering::Relaxed);
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn next(&mut self, long_first: bool) -> Option<Next> {
        if long_first && let Some(suspended) = self.long.pop_front() {
            return Some(Next::Long(suspended));
        }
        self.short.pop_front().map(Next::Short).or_else(|| self.long.pop_front().map(Next::Long))
    }
}

impl Turn {
    /// The next job that is to begin, if it is the turn of one; else the turn has gone on.
    fn next_job(mut self) -> Option<(Job, Self)> {
        let turns = self.turns.take()?;
        let mut state = turns.lock();
        turns.count(&state, self.is_long, self.since.elapsed());
        state.free += 1;
        match turns.grant(&mut state) {
            Some(Granted::Begun(job, turn)) => Some((job, turn)),
            Some(Granted::Resumed) | None => None,
        }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        if let Some(turns) = self.turns.take() {
            let mut state = turns.lock();
            turns.count(&state, self.is_long, self.since.elapsed());
            state.free += 1;
            turns.hand_out(state);
        }
    }
}

/// What a thread does that has a turn: one job after another, until the turn is not that of a job that is to begin.
fn work(mut job: Job, mut turn: Turn) {
    while let Some(next) = job(turn).and_then(Turn::next_job) {
        (job, turn) = next;
    }
}

#[cfg(test)]
mod tests {
    use std::sync::{Arc, mpsc};
    use std::time::Duration;

    use tokio::runtime::{Builder, Runtime};

    use super::{LEAST_LONG, LONG, Place, Turn, Turns, long};

    #[test]
    fn a_job_is_long_the_sooner_the_more_are_suspended() {
        assert_eq!(long(64, 64), LONG);
        assert_eq!(long(32, 64), LONG / 2);
        assert_eq!([long(1, 64), long(0, 64), long(0, 0)], [LEAST_LONG; 3]);
    }

    /// The turns of one worker, and the threads of which it is one.
    fn one() -> (Arc<Turns>, Runtime) {
        let threads = Builder::new_current_thread().max_blocking_threads(4).build().unwrap();
        (Turns::new(1, threads.handle().clone()), threads)
    }

    /// Submits a job that says its name, and keeps its turn until it is told to go on.
    fn submit(turns: &Arc<Turns>, name: &'static str, said: &mpsc::Sender<&'static str>) -> mpsc::Sender<()> {
        let (go_on, told) = mpsc::channel();
        let said = said.clone();
        turns.submit(Box::new(move |turn| {
            said.send(name).unwrap();
            // An error: it is told so by dropping the other end.
            let _ = told.recv();
            Some(turn)
        }));
        go_on
    }

    #[test]
    fn short_jobs_are_next_and_a_long_one_that_gave_way_is_the_first_of_the_long() {
        let (turns, _threads) = one();
        let (said, heard) = mpsc::channel();
        let first = submit(&turns, "first", &said);
        assert_eq!(heard.recv().unwrap(), "first");
        assert!(!turns.are_wanted());
        let [mut last, before] = [Place::Last, Place::First].map(|place| turns.ask(place));
        let [second, third] = ["second", "third"].map(|name| submit(&turns, name, &said));
        assert!(turns.are_wanted());
        drop(first);
        assert_eq!(heard.recv().unwrap(), "second");
        drop(second);
        assert_eq!(heard.recv().unwrap(), "third");
        assert!(!turns.are_wanted());
        drop(third);
        let turn: Turn = before.blocking_recv().unwrap();
        assert!(last.try_recv().is_err());
        drop(turn);
        assert!(last.try_recv().is_ok());
    }

    #[test]
    fn long_jobs_have_half_of_the_time() {
        let (turns, _threads) = one();
        let (said, heard) = mpsc::channel();
        let first = submit(&turns, "first", &said);
        assert_eq!(heard.recv().unwrap(), "first");
        let (_second, long) = (submit(&turns, "second", &said), turns.ask(Place::Last));
        let are_due = |had| turns.are_due(Duration::from_millis(had));
        assert!(are_due(0));
        turns.count(&turns.lock(), false, Duration::from_millis(10));
        // The lead of the short ones is to be made up for.
        assert!(!are_due(9));
        drop(first);
        let turn = long.blocking_recv().unwrap();
        assert!(heard.try_recv().is_err());
        assert!(!are_due(9));
        turns.count(&turns.lock(), true, Duration::from_secs(1));
        assert!(are_due(0));
        drop(turn);
        assert_eq!(heard.recv().unwrap(), "second");
    }

    #[test]
    fn a_turn_passes_those_by_who_have_gone() {
        let (turns, _threads) = one();
        let (said, heard) = mpsc::channel();
        let first = submit(&turns, "first", &said);
        assert_eq!(heard.recv().unwrap(), "first");
        drop(turns.ask(Place::Last));
        let given = turns.ask(Place::Last);
        let last = turns.ask(Place::Last);
        drop(first);
        // It was given, and not taken.
        drop(given);
        drop(last.blocking_recv().unwrap());
        let _second = submit(&turns, "second", &said);
        assert_eq!(heard.recv().unwrap(), "second");
    }
}
