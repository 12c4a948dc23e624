//! Whose turn it is to compute: short jobs come first, and long ones have half of the time at least.

use std::collections::VecDeque;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use tokio::runtime::Handle;
use tokio::sync::oneshot::{Receiver, Sender, channel};

/// From here on a job is long, by the processor time that it has taken, where no other is suspended. Nearly all flights take less.
const LONG: Duration = Duration::from_millis(50);

/// From here on, where as many are suspended as may be.
const LEAST_LONG: Duration = Duration::from_millis(1);

/// From where on a job is long, where so many more may be suspended of all: the more there are, the sooner the next is known to be one.
pub(super) fn long(places: usize, of_all: usize) -> Duration {
    let places = u32::try_from(places).unwrap_or(u32::MAX);
    let of_all = u32::try_from(of_all).unwrap_or(u32::MAX);
    (LONG / of_all.max(1)).saturating_mul(places).max(LEAST_LONG)
}

/// For so long it is known that a long job did not come to its end. Who sent it may send it again, and many of them come at once when
/// their time has run out at once.
const KNOWN: Duration = Duration::from_secs(10);

/// Of how many that is known: as many as may be suspended.
const MOST_KNOWN: usize = super::MOST_SUSPENDED;

/// What short jobs may compute beyond the half that is theirs, while long ones wait.
const LEAD: Duration = Duration::from_millis(5);

/// A job that has not begun; it gives its turn back, unless it has given it to another.
pub(super) type Job = Box<dyn FnOnce(Turn) -> Option<Turn> + Send>;

/// The turns of some workers: threads that go from one job to the next, since to wake another for each would cost as much as a short flight.
#[derive(Debug)]
pub(super) struct Turns {
    queue: Mutex<Queue>,
    /// Whether a short job waits.
    short_waits: AtomicBool,
    /// When long jobs were given up, the earliest first.
    given_up: Mutex<VecDeque<Instant>>,
    threads: Handle,
}

struct Queue {
    /// Turns that nobody has.
    free: usize,
    /// Jobs that have not begun, the next one first.
    short: VecDeque<Job>,
    /// Turns of jobs that have not been suspended.
    short_running: u32,
    /// Turns of jobs that have.
    long_running: u32,
    /// How much longer short jobs have computed, while long ones waited, than long ones have.
    lead: Duration,
    /// The instant until when that is counted.
    counted: Instant,
    /// Jobs that are suspended, the next one first: they are finished one after another, since they would all come late if they took turns.
    long: VecDeque<Sender<Turn>>,
}

impl fmt::Debug for Queue {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let Self { free, short, long, lead, .. } = self;
        let mut fields = f.debug_struct("Queue");
        fields.field("free", free).field("short", &short.len()).field("long", &long.len()).field("lead", lead);
        fields.finish_non_exhaustive()
    }
}

/// Which position among the suspended a job asks for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Position {
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
        let queue = Queue {
            free: workers,
            short: VecDeque::new(),
            short_running: 0,
            long_running: 0,
            lead: Duration::ZERO,
            counted: Instant::now(),
            long: VecDeque::new(),
        };
        let (queue, short_waits, given_up) = (Mutex::new(queue), AtomicBool::new(false), Mutex::default());
        Arc::new(Self { queue, short_waits, given_up, threads })
    }

    /// Has a job run when its turn comes.
    pub(super) fn submit(self: &Arc<Self>, job: Job) {
        let mut queue = self.lock();
        queue.short.push_back(job);
        self.hand_out(queue);
    }

    /// Asks for a turn again.
    pub(super) fn ask(self: &Arc<Self>, position: Position) -> Receiver<Turn> {
        let (sender, receiver) = channel();
        let mut queue = self.lock();
        match position {
            Position::Last => queue.long.push_back(sender),
            Position::First => queue.long.push_front(sender),
        }
        self.hand_out(queue);
        receiver
    }

    /// Whether a short job waits.
    pub(super) fn are_wanted(&self) -> bool {
        self.short_waits.load(Ordering::Relaxed)
    }

    /// Whether a long job is to give its turn to a short one: where one waits, and they have no lead.
    pub(super) fn are_due(&self) -> bool {
        self.are_wanted() && {
            let mut queue = self.lock();
            queue.count(Instant::now());
            queue.lead.is_zero()
        }
    }

    /// A long job was given up at an instant.
    pub(super) fn note_given_up(&self, at: Instant) {
        let mut given_up = self.given_up.lock().unwrap_or_else(PoisonError::into_inner);
        if given_up.len() == MOST_KNOWN {
            given_up.pop_front();
        }
        given_up.push_back(at);
    }

    /// How many long jobs were given up shortly before an instant.
    pub(super) fn given_up(&self, at: Instant) -> usize {
        let mut given_up = self.given_up.lock().unwrap_or_else(PoisonError::into_inner);
        while given_up.front().is_some_and(|&then| at.duration_since(then) > KNOWN) {
            given_up.pop_front();
        }
        given_up.len()
    }

    /// Gives what turns there are to those who wait.
    fn hand_out(self: &Arc<Self>, mut queue: MutexGuard<Queue>) {
        let mut begun = Vec::new();
        while queue.free > 0
            && let Some(granted) = self.grant(&mut queue)
        {
            if let Granted::Begun(job, turn) = granted {
                begun.push((job, turn));
            }
        }
        self.note(&queue);
        drop(queue);
        for (job, turn) in begun {
            self.threads.spawn_blocking(move || work(job, turn));
        }
    }

    /// Gives one of the free turns to the next who waits, if anybody does.
    fn grant(self: &Arc<Self>, queue: &mut Queue) -> Option<Granted> {
        let turn = |is_long| Turn { turns: Some(Arc::clone(self)), is_long };
        queue.count(Instant::now());
        let granted = loop {
            match queue.next() {
                Some(Next::Short(job)) => break Some(Granted::Begun(job, turn(false))),
                Some(Next::Long(suspended)) => match suspended.send(turn(true)) {
                    Ok(()) => break Some(Granted::Resumed),
                    // One who has gone wants none.
                    Err(mut refused) => refused.turns = None,
                },
                None => break None,
            }
        };
        queue.free -= usize::from(granted.is_some());
        match granted {
            Some(Granted::Begun(..)) => queue.short_running += 1,
            Some(Granted::Resumed) => queue.long_running += 1,
            None => {}
        }
        self.note(queue);
        granted
    }

    /// Notes whether a short job waits, for those who ask without the lock.
    fn note(&self, queue: &Queue) {
        self.short_waits.store(!queue.short.is_empty(), Ordering::Relaxed);
    }

    fn lock(&self) -> MutexGuard<'_, Queue> {
        self.queue.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Queue {
    /// Counts what has been computed until now: what the long ones have is taken off what the short ones are ahead.
    fn count(&mut self, now: Instant) {
        let time = now.saturating_duration_since(self.counted);
        let short = if self.long.is_empty() { Duration::ZERO } else { time * self.short_running };
        self.lead = (self.lead + short).saturating_sub(time * self.long_running);
        self.counted = self.counted.max(now);
    }

    /// Takes a turn back.
    fn release(&mut self, is_long: bool) {
        self.count(Instant::now());
        let running = if is_long { &mut self.long_running } else { &mut self.short_running };
        *running -= 1;
        self.free += 1;
    }

    /// Who is next of those who wait.
    fn next(&mut self) -> Option<Next> {
        if self.lead > LEAD
            && let Some(suspended) = self.long.pop_front()
        {
            return Some(Next::Long(suspended));
        }
        self.short.pop_front().map(Next::Short).or_else(|| self.long.pop_front().map(Next::Long))
    }
}

impl Turn {
    /// The next job that is to begin, if it is the turn of one; else the turn has gone on.
    fn next_job(mut self) -> Option<(Job, Self)> {
        let turns = self.turns.take()?;
        let mut queue = turns.lock();
        queue.release(self.is_long);
        match turns.grant(&mut queue) {
            Some(Granted::Begun(job, turn)) => Some((job, turn)),
            Some(Granted::Resumed) | None => None,
        }
    }
}

impl Drop for Turn {
    fn drop(&mut self) {
        if let Some(turns) = self.turns.take() {
            let mut queue = turns.lock();
            queue.release(self.is_long);
            turns.hand_out(queue);
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
    use std::thread;
    use std::time::{Duration, Instant};

    use tokio::runtime::{Builder, Runtime};
    use tokio::sync::oneshot::channel;

    use super::{KNOWN, LEAD, LEAST_LONG, LONG, MOST_KNOWN, Position, Queue, Turns, long};

    #[test]
    fn a_job_is_long_the_sooner_the_more_are_suspended() {
        assert_eq!(long(64, 64), LONG);
        assert_eq!(long(32, 64), LONG / 2);
        assert_eq!([long(1, 64), long(0, 64), long(0, 0)], [LEAST_LONG; 3]);
    }

    #[test]
    fn long_jobs_that_were_given_up_are_forgotten() {
        let threads = Builder::new_current_thread().build().unwrap();
        let turns = Turns::new(1, threads.handle().clone());
        let start = Instant::now();
        turns.note_given_up(start);
        turns.note_given_up(start + KNOWN / 2);
        assert_eq!(turns.given_up(start + KNOWN), 2);
        assert_eq!(turns.given_up(start + KNOWN + Duration::from_nanos(1)), 1);
        for _ in 0..=MOST_KNOWN {
            turns.note_given_up(start + KNOWN);
        }
        assert_eq!(turns.given_up(start + KNOWN), MOST_KNOWN);
        assert_eq!(turns.given_up(start + 3 * KNOWN), 0);
    }

    /// The turns of one worker, and what its jobs say.
    struct Worker {
        turns: Arc<Turns>,
        _threads: Runtime,
        saying: mpsc::Sender<&'static str>,
        said: mpsc::Receiver<&'static str>,
    }

    impl Worker {
        /// A worker that is busy with a job, until the other end of that is dropped.
        fn busy() -> (Self, mpsc::Sender<()>) {
            let threads = Builder::new_current_thread().max_blocking_threads(4).build().unwrap();
            let (saying, said) = mpsc::channel();
            let worker = Self { turns: Turns::new(1, threads.handle().clone()), _threads: threads, saying, said };
            let first = worker.submit("first");
            assert_eq!(worker.said.recv().unwrap(), "first");
            (worker, first)
        }

        /// Submits a job that says its name, and keeps its turn until the other end is dropped.
        fn submit(&self, name: &'static str) -> mpsc::Sender<()> {
            let (keeping, kept) = mpsc::channel();
            let saying = self.saying.clone();
            self.turns.submit(Box::new(move |turn| {
                saying.send(name).unwrap();
                let _ = kept.recv();
                Some(turn)
            }));
            keeping
        }
    }

    #[test]
    fn short_jobs_are_next_and_a_long_one_that_gave_way_is_the_first_of_the_long() {
        let (worker, first) = Worker::busy();
        let turns = &worker.turns;
        // However long this thread is away, the short ones get no lead by it.
        turns.lock().counted += Duration::from_hours(1);
        assert!(!turns.are_wanted());
        let [mut last, mut before] = [Position::Last, Position::First].map(|place| turns.ask(place));
        let [second, third] = ["second", "third"].map(|name| worker.submit(name));
        assert!(turns.are_wanted());
        drop(first);
        assert_eq!(worker.said.recv().unwrap(), "second");
        drop(second);
        assert_eq!(worker.said.recv().unwrap(), "third");
        assert!(!turns.are_wanted());
        drop(third);
        let turn = loop {
            assert!(last.try_recv().is_err(), "the last of the long is first");
            if let Ok(turn) = before.try_recv() {
                break turn;
            }
            std::thread::yield_now();
        };
        drop(turn);
        assert!(last.try_recv().is_ok());
    }

    #[test]
    fn long_jobs_have_half_of_the_time() {
        let (worker, first) = Worker::busy();
        let turns = &worker.turns;
        let (_second, long) = (worker.submit("second"), turns.ask(Position::Last));
        let lead = |change: &dyn Fn(&mut Queue)| {
            let mut queue = turns.lock();
            queue.count(Instant::now());
            change(&mut queue);
            queue.lead
        };
        // The first one computes, while a long one waits.
        assert!(!turns.are_due());
        let early = lead(&|_| {});
        thread::sleep(2 * LEAD);
        assert!(lead(&|_| {}) >= early + 2 * LEAD);
        drop(first);
        let turn = long.blocking_recv().unwrap();
        assert!(worker.said.try_recv().is_err());
        // The lead of the short ones is to be made up for.
        lead(&|queue| queue.lead = Duration::from_secs(1000));
        assert!(!turns.are_due());
        thread::sleep(LEAD);
        assert!(lead(&|_| {}) + LEAD <= Duration::from_secs(1000));
        lead(&|queue| queue.lead = Duration::ZERO);
        assert!(turns.are_due());
        drop(turn);
        assert_eq!(worker.said.recv().unwrap(), "second");
    }

    #[test]
    fn short_jobs_beside_a_long_one_have_no_lead() {
        let threads = Builder::new_current_thread().build().unwrap();
        let turns = Turns::new(2, threads.handle().clone());
        let _long = turns.ask(Position::Last).blocking_recv().unwrap();
        let mut queue = turns.lock();
        queue.long.push_back(channel().0);
        queue.short_running = 1;
        let now = queue.counted;
        queue.count(now + Duration::from_secs(1));
        assert_eq!(queue.lead, Duration::ZERO);
        queue.short_running = 3;
        queue.count(now + Duration::from_secs(3));
        assert_eq!(queue.lead, Duration::from_secs(4));
    }

    #[test]
    fn a_turn_passes_those_by_who_have_gone() {
        let (worker, first) = Worker::busy();
        let turns = &worker.turns;
        drop(turns.ask(Position::Last));
        let given = turns.ask(Position::Last);
        let last = turns.ask(Position::Last);
        drop(first);
        // It was given, and not taken.
        drop(given);
        drop(last.blocking_recv().unwrap());
        let _second = worker.submit("second");
        assert_eq!(worker.said.recv().unwrap(), "second");
    }
}
