//! A job while it runs: it looks at its flag, gives way to short jobs, and holds memory.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use bytes::Bytes;
use reentry::Interrupt;
use rustix::time::{ClockId, clock_gettime};
use tokio::runtime::Handle;
use tokio::sync::{Notify, OwnedSemaphorePermit, Semaphore};
use tokio::time::Instant;

use super::turns::{Position, Turn, Turns, long};
use crate::client::Client;
use crate::error::ApiError;
use crate::memory::Permit;
use crate::metrics::Metrics;
use crate::rate::RateLimit;

/// What a job and the one who waits for it have in common.
#[derive(Debug, Default)]
pub(super) struct JobState {
    /// Tells that the job has begun.
    begun: Notify,
    /// Raised when nobody waits any more.
    interrupt: AtomicBool,
    /// Tells a suspended job so.
    given_up: Notify,
    /// Whether nobody waits since the time ran out.
    is_late: AtomicBool,
}

/// Somebody who waits for a job; the flag is raised when they stop waiting.
pub(super) struct Waiter(Arc<JobState>);

impl Waiter {
    /// Somebody who waits, and what they have in common with the job.
    pub(super) fn new() -> (Self, Arc<JobState>) {
        let state = Arc::default();
        (Self(Arc::clone(&state)), state)
    }

    /// The time of the job has run out.
    pub(super) fn is_late(&self) {
        self.0.is_late.store(true, Ordering::Relaxed);
    }

    /// Waits until the job begins.
    pub(super) async fn begun(&self) {
        self.0.begun.notified().await;
    }
}

impl Drop for Waiter {
    fn drop(&mut self) {
        self.0.interrupt.store(true, Ordering::Relaxed);
        self.0.given_up.notify_one();
    }
}

/// A job that runs, and looks at its flag: there it gives way to short ones once it is long, and goes on when its turn comes again.
///
/// It holds memory for its answer, and where there is none, it gives back what it holds, and begins anew when there is.
#[derive(Debug)]
pub struct Task {
    pub(super) state: Arc<JobState>,
    pub(super) route: &'static str,
    pub(super) client: Client,
    pub(super) turns: Arc<Turns>,
    pub(super) suspended: Arc<Semaphore>,
    pub(super) most_suspended: usize,
    /// When it was asked for.
    pub(super) asked: Instant,
    /// How often it has looked at its flag.
    pub(super) polls: AtomicU32,
    pub(super) progress: Mutex<Progress>,
    pub(super) metrics: Arc<Metrics>,
    pub(super) rate_limit: Option<Arc<RateLimit>>,
}

/// What of a job changes while it runs.
#[derive(Debug)]
pub(super) struct Progress {
    turn: Option<Turn>,
    /// The instant at which it looks next whether it is long.
    look: Instant,
    /// The processor time of its thread when it began, once it has.
    begin: Option<Duration>,
    is_long: bool,
    /// Its place in the queue or, once it has given way, among the suspended.
    place: Option<OwnedSemaphorePermit>,
    was_suspended: bool,
    /// None once its answer is there.
    permit: Option<Permit>,
    /// The bytes that it may hold.
    reserved: usize,
    /// The bytes for which there was no room.
    wanted: Option<usize>,
    /// Whether it was ended for another reason than that nobody waits.
    was_refused: bool,
    /// That reason, until it is told.
    refusal: Option<ApiError>,
}

impl Progress {
    pub(super) fn new(place: Option<OwnedSemaphorePermit>, permit: Permit) -> Self {
        let now = Instant::now();
        Self {
            turn: None,
            look: now,
            begin: None,
            is_long: false,
            place,
            was_suspended: false,
            permit: Some(permit),
            reserved: 0,
            wanted: None,
            was_refused: false,
            refusal: None,
        }
    }

    /// Holds so many bytes, or as many as one may, if there is room for them.
    fn reserve(&mut self, bytes: usize) {
        if let Some(permit) = &mut self.permit {
            let bytes = bytes.min(permit.largest());
            if permit.try_reserve(bytes).is_ok() {
                self.reserved = bytes;
            }
        }
    }

    /// What the job has computed, asked on its own thread.
    fn computed(&self) -> Duration {
        self.begin.map_or(Duration::ZERO, |begin| processor_time().saturating_sub(begin))
    }
}

impl Task {
    /// The bytes of its answer, which count as held until the last that refers to them is gone.
    pub fn keep(&self, mut bytes: Vec<u8>) -> Bytes {
        bytes.shrink_to_fit();
        match self.lock().permit.take() {
            Some(permit) => permit.keep(bytes),
            None => bytes.into(),
        }
    }

    /// Begins, on the thread of a turn.
    pub(super) fn begin(&self, turn: Turn) {
        self.metrics.job_begun(self.route, self.asked.elapsed());
        self.state.begun.notify_one();
        let mut progress = self.lock();
        progress.turn = Some(turn);
        progress.begin = Some(processor_time());
    }

    /// Runs the job, and again as often as it finds no room in memory.
    pub(super) fn run<T>(&self, mut job: impl FnMut(&Self) -> Result<T, ApiError>) -> Result<T, ApiError> {
        let mut run = || if self.is_over() { Err(ApiError::Interrupted) } else { job(self) };
        loop {
            let result = catch_unwind(AssertUnwindSafe(&mut run));
            if !self.waited_for_room() {
                return self.outcome(result);
            }
        }
    }

    /// Its turn, if it still has one.
    pub(super) fn take_turn(&self) -> Option<Turn> {
        self.lock().turn.take()
    }

    /// What came of the job: a job that was ended does not know why.
    fn outcome<T>(&self, result: thread::Result<Result<T, ApiError>>) -> Result<T, ApiError> {
        let refusal = self.lock().refusal.take();
        let result = result.unwrap_or_else(|_| {
            // The panic itself has its line.
            tracing::error!("a job panicked");
            Err(ApiError::Internal)
        });
        refusal.map_or(result, Err)
    }

    /// Where the job found no room in memory, waits until there is room for that and a quarter more; whether the job is then to begin
    /// anew.
    ///
    /// Meanwhile it holds nothing: jobs that held something while they waited for more would wait for each other.
    fn waited_for_room(&self) -> bool {
        let mut progress = self.lock();
        let Some(wanted) = progress.wanted.take() else { return false };
        progress.reserve(0);
        // What it has computed was in vain, and others had to wait for it.
        progress.is_long = true;
        while !self.is_over() && progress.reserved == 0 {
            self.suspend(&mut progress, Position::Last, PAUSE);
            progress.reserve(wanted + wanted / 4);
        }
        !self.is_over()
    }

    fn is_over(&self) -> bool {
        self.state.interrupt.load(Ordering::Relaxed)
    }

    /// Ends the job.
    pub(super) fn refuse(&self, refusal: ApiError) {
        self.end(&mut self.lock(), refusal);
    }

    fn end(&self, progress: &mut Progress, refusal: ApiError) {
        progress.refusal = Some(refusal);
        progress.was_refused = true;
        self.state.interrupt.store(true, Ordering::Relaxed);
    }

    /// Gives way to short jobs, if it is long.
    fn give_way(&self) {
        let mut progress = self.lock();
        let now = Instant::now();
        if !progress.is_long && now >= progress.look {
            progress.look = now + LOOK;
            let places = self.suspended.available_permits().saturating_sub(self.turns.given_up(now.into_std()));
            progress.is_long = progress.computed() >= long(places, self.most_suspended);
        }
        // What is long only now gives the turn of a short one back, to whoever is next.
        if progress.is_long && (!progress.was_suspended || self.turns.are_due()) {
            let position = if progress.was_suspended { Position::First } else { Position::Last };
            self.suspend(&mut progress, position, Duration::ZERO);
        }
    }

    /// Suspends the job for a pause at least, and until its turn comes again.
    fn suspend(&self, progress: &mut Progress, position: Position, pause: Duration) {
        if !progress.was_suspended {
            let Ok(place) = Arc::clone(&self.suspended).try_acquire_owned() else {
                return self.end(progress, ApiError::Busy);
            };
            progress.place = Some(place);
            progress.was_suspended = true;
        }
        progress.turn = None;
        self.metrics.job_suspended();
        thread::sleep(pause);
        let turn = self.turns.ask(position);
        progress.turn = Handle::current().block_on(async {
            tokio::select! {
                biased;
                () = self.state.given_up.notified() => None,
                turn = turn => turn.ok(),
            }
        });
        self.metrics.job_resumed();
    }

    fn lock(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Between two looks of a job at whether it is long, while others wait.
const LOOK: Duration = Duration::from_micros(250);

/// How often a long job looks at its flag, some us each, until it offers its processor to other threads.
const POLLS: u32 = 64;

/// Between two looks of a job that waits for memory.
const PAUSE: Duration = Duration::from_millis(10);

/// The processor time that this thread has taken, which the system does not count while others have the processor.
fn processor_time() -> Duration {
    let time = clock_gettime(ClockId::ThreadCPUTime);
    Duration::try_from(time).unwrap_or_default()
}

impl Interrupt for Task {
    fn is_raised(&self) -> bool {
        if !self.is_over() && self.turns.are_wanted() {
            self.give_way();
        }
        if self.polls.fetch_add(1, Ordering::Relaxed).is_multiple_of(POLLS) && self.lock().was_suspended {
            // The threads that talk to clients, and a short job that begins, would wait for the end of its time slice of some ms.
            thread::yield_now();
        }
        self.is_over()
    }

    fn may_hold(&self, bytes: usize) -> bool {
        let mut progress = self.lock();
        if bytes <= progress.reserved {
            return true;
        }
        let Some(permit) = &mut progress.permit else { return true };
        let limit = permit.largest();
        if bytes > limit {
            self.end(&mut progress, ApiError::TooLarge { limit });
            return false;
        }
        let has_room = permit.try_reserve(bytes).is_ok();
        if has_room {
            progress.reserved = bytes;
        } else {
            progress.wanted = Some(bytes);
        }
        has_room
    }
}

impl Drop for Task {
    fn drop(&mut self) {
        let progress = self.progress.get_mut().unwrap_or_else(PoisonError::into_inner);
        if progress.begin.is_none() {
            // The service ends, and with it its threads.
            return;
        }
        if self.state.interrupt.load(Ordering::Relaxed) && !progress.was_refused {
            let is_late = self.state.is_late.load(Ordering::Relaxed);
            self.metrics.job_cancelled(self.route, if is_late { "deadline" } else { "disconnect" });
            if progress.is_long {
                self.turns.note_given_up(Instant::now().into_std());
            }
        }
        // It is dropped by the thread on which it ran.
        let computed = progress.computed();
        self.metrics.job_over(self.route, computed);
        if let Some(limit) = &self.rate_limit {
            limit.charge(self.client, computed);
        }
    }
}
