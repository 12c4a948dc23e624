//! The pool of blocking threads on which every job runs: bounded, with a deadline, and cancelled when nobody waits any more.
//!
//! Single jobs and batches have workers of their own, so that neither waits for the other: what both compute at once, the system divides
//! between them. Jobs that have computed for long give way to short ones, where they look at their flag: see [`Task`].

mod slots;
mod turns;

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

use bytes::Bytes;
use reentry::Interrupt;
use rustix::time::{ClockId, clock_gettime};
use tokio::runtime::{Builder, Handle, Runtime};
use tokio::sync::mpsc::error::TrySendError;
use tokio::sync::{Notify, OwnedSemaphorePermit, Semaphore, mpsc, oneshot};
use tokio::time::{Instant, timeout};
use tracing::{Instrument, Span};

use crate::client::Client;
use crate::config::Config;
use crate::error::ApiError;
use crate::memory::{HURRY, Memory, Permit};
use crate::metrics::Metrics;
use crate::rate::RateLimit;
use slots::{Slot, Slots};
use turns::{Place, Turn, Turns, long};

/// A runtime of its own whose blocking threads compute; the threads that talk to clients never do.
#[derive(Debug)]
pub struct Compute {
    /// Of single jobs.
    singles: Pool,
    /// Of batches.
    shared: Pool,
    /// For single jobs that wait, or have not yet given way.
    places: Arc<Semaphore>,
    /// For batches that compute.
    slots: Slots,
    /// What a job may take, its waiting included.
    deadline: Duration,
    /// Where bodies and answers count.
    memory: Memory,
    metrics: Arc<Metrics>,
    rate_limit: Option<Arc<RateLimit>>,
}

impl Compute {
    /// The pool of the settings.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn new(
        config: &Config,
        memory: Memory,
        metrics: Arc<Metrics>,
        rate_limit: Option<Arc<RateLimit>>,
    ) -> std::io::Result<Self> {
        let workers = config.workers();
        Ok(Self {
            singles: Pool::new("reentry-single", workers, config.queue)?,
            shared: Pool::new("reentry-batch", workers.saturating_sub(1).max(1), config.batches)?,
            places: Arc::new(Semaphore::new(workers + config.queue)),
            slots: Slots::new(config.batches),
            deadline: config.deadline,
            memory,
            metrics,
            rate_limit,
        })
    }

    /// Runs a job of a route for a client, and runs it again where it found no room in memory. It is to stop soon after its flag is raised: at the deadline, or when the caller is dropped.
    ///
    /// # Errors
    /// The job's own; [`ApiError::Busy`] at once when all places are taken, or when the memory is full; [`ApiError::TooManyRequests`] when
    /// the client holds its share of it; [`ApiError::DeadlineExceeded`]; [`ApiError::Internal`] when the job panics.
    pub async fn run<T, F>(&self, route: &'static str, client: Client, job: F) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnMut(&Task) -> Result<T, ApiError> + Send + 'static,
    {
        let place = Arc::clone(&self.places).try_acquire_owned().map_err(|_| ApiError::Busy)?;
        self.work(&self.singles, (route, client), Some(place), job, self.deadline).await
    }

    /// Runs the jobs of a batch one after another and gives their results in order, those that the time does not suffice for
    /// as [`ApiError::DeadlineExceeded`].
    ///
    /// Nothing is computed further ahead than one job before the result that is taken next, and a batch whose results are not taken
    /// is in nobody's way. Where none is taken for as long as a job may run, or the receiver is dropped, the batch ends: the channel
    /// then closes early.
    ///
    /// # Errors
    /// [`ApiError::Busy`] when as many batches compute as may, and [`ApiError::TooManyRequests`] when as many of this client do.
    pub fn run_batch<T, F>(
        self: &Arc<Self>,
        route: &'static str,
        client: Client,
        jobs: Vec<F>,
        time: Duration,
    ) -> Result<mpsc::Receiver<Result<T, ApiError>>, ApiError>
    where
        T: Send + 'static,
        F: FnMut(&Task) -> Result<T, ApiError> + Send + 'static,
    {
        let mut slot = Some(self.slots.try_take(client)?);
        let start = Instant::now();
        let compute = Arc::clone(self);
        let (results, receiver) = mpsc::channel(1);
        let run_all = async move {
            for job in jobs {
                let left = || time.saturating_sub(start.elapsed());
                let result = tokio::select! {
                    () = results.closed() => return,
                    result = compute.share_of_batch((route, client), &mut slot, job, left()) => result,
                };
                let result = match result {
                    Err(ApiError::DeadlineExceeded { .. }) if left().is_zero() => {
                        slot = None;
                        Err(ApiError::DeadlineExceeded { seconds: time.as_secs_f64() })
                    }
                    result => result,
                };
                match results.try_send(result) {
                    Ok(()) => {}
                    Err(TrySendError::Closed(_)) => return,
                    Err(TrySendError::Full(result)) => {
                        // Nothing is computed until the reader has taken something: the slot is for another.
                        slot = None;
                        match timeout(compute.patience(), results.send(result)).await {
                            Ok(Ok(())) => {}
                            Ok(Err(_)) => return,
                            Err(_) => {
                                tracing::info!("the batch ended early, as its reader took nothing");
                                return;
                            }
                        }
                    }
                }
            }
        };
        tokio::spawn(run_all.instrument(Span::current()));
        Ok(receiver)
    }

    /// How long a batch waits for its reader: not at all long where bodies of batches take much memory.
    fn patience(&self) -> Duration {
        if self.memory.batch_bodies.is_tight() { self.deadline.min(HURRY) } else { self.deadline }
    }

    async fn share_of_batch<T, F>(
        &self,
        (route, client): (&'static str, Client),
        slot: &mut Option<Slot>,
        job: F,
        left: Duration,
    ) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnMut(&Task) -> Result<T, ApiError> + Send + 'static,
    {
        let start = Instant::now();
        if slot.is_none() && !left.is_zero() {
            let again = timeout(left, self.slots.take(client)).await;
            *slot = again.map_err(|_| ApiError::DeadlineExceeded { seconds: left.as_secs_f64() })?;
        }
        self.share(route, client, job, left.saturating_sub(start.elapsed())).await
    }

    /// Runs a job of a batch that has so much time left, when its turn comes.
    ///
    /// # Errors
    /// As [`Compute::run`], but that it waits for a place.
    pub async fn share<T, F>(&self, route: &'static str, client: Client, job: F, left: Duration) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnMut(&Task) -> Result<T, ApiError> + Send + 'static,
    {
        if left.is_zero() {
            return Err(ApiError::DeadlineExceeded { seconds: 0.0 });
        }
        self.work(&self.shared, (route, client), None, job, left).await
    }

    /// Runs a job, in the time that is left: all of it until it begins, and from then on no more than a job may take.
    async fn work<T, F>(
        &self,
        pool: &Pool,
        (route, client): (&'static str, Client),
        place: Option<OwnedSemaphorePermit>,
        mut job: F,
        left: Duration,
    ) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnMut(&Task) -> Result<T, ApiError> + Send + 'static,
    {
        let caller = Caller(Arc::default());
        let (done, mut result) = oneshot::channel();
        let task = Task {
            call: Arc::clone(&caller.0),
            route,
            client,
            turns: Arc::clone(&pool.turns),
            suspended: Arc::clone(&pool.suspended),
            most_suspended: pool.most_suspended,
            asked: Instant::now(),
            state: Mutex::new(State::new(place, self.memory.answers.permit(client))),
            metrics: Arc::clone(&self.metrics),
            rate_limit: self.rate_limit.clone(),
        };
        let memory = self.memory.clone();
        self.metrics.job_queued();
        pool.turns.submit(Box::new(move |turn| {
            task.begin(turn);
            if let Err(refusal) = memory.answers.admit(client) {
                task.refuse(&mut task.lock(), refusal.into());
            }
            let mut run = || job(&task);
            let result = loop {
                let result = if task.is_over() {
                    Ok(Err(ApiError::Interrupted))
                } else {
                    catch_unwind(AssertUnwindSafe(&mut run))
                };
                if !task.waited_for_room() {
                    break task.outcome(result);
                }
            };
            let turn = task.lock().turn.take();
            // It is counted before it is known to be over.
            drop(task);
            // An error: nobody waits.
            let _ = done.send(result);
            turn
        }));
        let late = |allowed: Duration| {
            caller.0.is_late.store(true, Ordering::Relaxed);
            ApiError::DeadlineExceeded { seconds: allowed.as_secs_f64() }
        };
        let allowed = left.min(self.deadline);
        if left > self.deadline {
            // A case of a batch, whose time begins when it does.
            tokio::select! {
                biased;
                over = &mut result => return over.map_err(|_| ApiError::Internal)?,
                begun = timeout(left, caller.0.begun.notified()) => begun.map_err(|_| late(left))?,
            }
        }
        match timeout(allowed, result).await {
            Ok(result) => result.map_err(|_| ApiError::Internal)?,
            Err(_) => Err(late(allowed)),
        }
    }

    /// Whether a single job would find a place, and memory for its body and its answer.
    pub fn has_room(&self) -> bool {
        self.places.available_permits() > 0 && !self.memory.bodies.is_full() && !self.memory.answers.is_full()
    }
}

/// Threads that compute, as many at once as have a turn.
#[derive(Debug)]
struct Pool {
    /// Some until dropped.
    threads: Option<Runtime>,
    turns: Arc<Turns>,
    /// For jobs that have given way.
    suspended: Arc<Semaphore>,
    most_suspended: usize,
}

impl Pool {
    /// As many workers, and as many jobs beside them that may be suspended.
    fn new(name: &str, workers: usize, suspended: usize) -> std::io::Result<Self> {
        let suspended = suspended.min(MOST_SUSPENDED);
        let threads =
            Builder::new_current_thread().max_blocking_threads(workers + suspended).thread_name(name).build()?;
        Ok(Self {
            turns: Turns::new(workers, threads.handle().clone()),
            threads: Some(threads),
            suspended: Arc::new(Semaphore::new(suspended)),
            most_suspended: suspended,
        })
    }
}

/// Jobs that may be suspended at once, each of which has a thread.
const MOST_SUSPENDED: usize = 256;

impl Drop for Pool {
    fn drop(&mut self) {
        if let Some(threads) = self.threads.take() {
            threads.shutdown_background();
        }
    }
}

/// What a job and the one who waits for it have in common.
#[derive(Debug, Default)]
struct Call {
    /// Tells that the job has begun.
    begun: Notify,
    /// Raised when nobody waits any more.
    interrupt: AtomicBool,
    /// Tells a suspended job so.
    given_up: Notify,
    /// Whether that is because the time ran out.
    is_late: AtomicBool,
}

/// Somebody who waits for a job; the flag is raised when they stop waiting.
struct Caller(Arc<Call>);

impl Drop for Caller {
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
    call: Arc<Call>,
    route: &'static str,
    client: Client,
    turns: Arc<Turns>,
    suspended: Arc<Semaphore>,
    most_suspended: usize,
    /// When it was asked for.
    asked: Instant,
    state: Mutex<State>,
    metrics: Arc<Metrics>,
    rate_limit: Option<Arc<RateLimit>>,
}

/// What of a job changes while it runs.
#[derive(Debug)]
struct State {
    turn: Option<Turn>,
    /// The instant from which it has its turn.
    since: Instant,
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

impl State {
    fn new(place: Option<OwnedSemaphorePermit>, permit: Permit) -> Self {
        let now = Instant::now();
        Self {
            turn: None,
            since: now,
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
    fn begin(&self, turn: Turn) {
        self.metrics.job_begun(self.route, self.asked.elapsed());
        self.call.begun.notify_one();
        let mut state = self.lock();
        state.turn = Some(turn);
        state.since = Instant::now();
        state.begin = Some(processor_time());
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

    /// Where the job found no room in memory, waits until there is room for that and a quarter more; whether the job is then to begin anew.
    ///
    /// Meanwhile it holds nothing: jobs that held something while they waited for more would wait for each other.
    fn waited_for_room(&self) -> bool {
        let mut state = self.lock();
        let Some(wanted) = state.wanted.take() else { return false };
        state.reserve(0);
        // What it has computed was in vain, and others had to wait for it.
        state.is_long = true;
        while !self.is_over() && state.reserved == 0 {
            self.suspend(&mut state, Place::Last, PAUSE);
            state.reserve(wanted + wanted / 4);
        }
        !self.is_over()
    }

    fn is_over(&self) -> bool {
        self.call.interrupt.load(Ordering::Relaxed)
    }

    /// Ends the job.
    fn refuse(&self, state: &mut State, refusal: ApiError) {
        state.refusal = Some(refusal);
        state.was_refused = true;
        self.call.interrupt.store(true, Ordering::Relaxed);
    }

    /// Gives way to short jobs, if it is long.
    fn give_way(&self) {
        let mut state = self.lock();
        let now = Instant::now();
        let was_long = state.is_long;
        if !was_long && now >= state.look {
            state.look = now + LOOK;
            state.is_long = state.computed() >= long(self.suspended.available_permits(), self.most_suspended);
        }
        if state.is_long && self.turns.are_due(now - state.since) {
            let place = if was_long { Place::First } else { Place::Last };
            self.suspend(&mut state, place, Duration::ZERO);
        }
    }

    /// Suspends the job for a pause at least, and until its turn comes again.
    fn suspend(&self, state: &mut State, place: Place, pause: Duration) {
        if !state.was_suspended {
            let Ok(place) = Arc::clone(&self.suspended).try_acquire_owned() else {
                return self.refuse(state, ApiError::Busy);
            };
            state.place = Some(place);
            state.was_suspended = true;
        }
        state.turn = None;
        self.metrics.job_suspended();
        thread::sleep(pause);
        let turn = self.turns.ask(place);
        state.turn = Handle::current().block_on(async {
            tokio::select! {
                biased;
                () = self.call.given_up.notified() => None,
                turn = turn => turn.ok(),
            }
        });
        self.metrics.job_resumed();
        state.since = Instant::now();
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// Between two looks of a job at whether it is long, while others wait.
const LOOK: Duration = Duration::from_millis(1);

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
        self.is_over()
    }

    fn may_hold(&self, bytes: usize) -> bool {
        let mut state = self.lock();
        if bytes <= state.reserved {
            return true;
        }
        let Some(permit) = &mut state.permit else { return true };
        let limit = permit.largest();
        if bytes > limit {
            self.refuse(&mut state, ApiError::TooLarge { limit });
            return false;
        }
        let has_room = permit.try_reserve(bytes).is_ok();
        if has_room {
            state.reserved = bytes;
        } else {
            state.wanted = Some(bytes);
        }
        has_room
    }
}

impl Drop for Task {
    fn drop(&mut self) {
        let state = self.state.get_mut().unwrap_or_else(PoisonError::into_inner);
        if self.call.interrupt.load(Ordering::Relaxed) && !state.was_refused {
            let is_late = self.call.is_late.load(Ordering::Relaxed);
            self.metrics.job_cancelled(self.route, if is_late { "deadline" } else { "disconnect" });
        }
        // It is dropped by the thread on which it ran.
        let computed = state.computed();
        if state.begin.is_none() {
            // The service ends, and with it its threads.
            return;
        }
        self.metrics.job_over(self.route, computed);
        if let Some(limit) = &self.rate_limit {
            limit.charge(self.client, computed);
        }
    }
}
