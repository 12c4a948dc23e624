//! The pool of blocking threads on which every job runs: bounded, with a deadline, and cancelled when nobody waits any more.
//!
//! Single jobs and batches have workers of their own, so that neither waits for the other: what both compute at once, the system divides
//! between them. The jobs of all batches take turns.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tokio::runtime::{Builder, Runtime};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc};
use tokio::time::{Instant, timeout};
use tracing::{Instrument, Span};

use crate::config::Config;
use crate::error::ApiError;
use crate::memory::Memory;
use crate::metrics::Metrics;

/// A runtime of its own whose blocking threads compute; the threads that talk to clients never do.
#[derive(Debug)]
pub struct Compute {
    /// Of single jobs.
    singles: Pool,
    /// Of batches.
    shared: Pool,
    /// For single jobs, waiting or running.
    places: Arc<Semaphore>,
    /// For batches under way.
    batches: Arc<Semaphore>,
    /// The workers that a batch waits for.
    turns: Arc<Semaphore>,
    /// What a job may take, its waiting included.
    deadline: Duration,
    /// Where the answers count that have not been sent.
    memory: Arc<Memory>,
    metrics: Arc<Metrics>,
}

impl Compute {
    /// The pool of the settings.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn new(config: &Config, memory: Arc<Memory>, metrics: Arc<Metrics>) -> std::io::Result<Self> {
        let workers = config.workers();
        let shared = workers.saturating_sub(1).max(1);
        Ok(Self {
            singles: Pool::new("reentry-single", workers)?,
            shared: Pool::new("reentry-batch", shared)?,
            places: Arc::new(Semaphore::new(workers + config.queue)),
            batches: Arc::new(Semaphore::new(config.batches)),
            turns: Arc::new(Semaphore::new(shared)),
            deadline: config.deadline,
            memory,
            metrics,
        })
    }

    /// Runs a job of a route, which is to stop soon after its flag is raised: at the deadline, or when the caller is dropped.
    ///
    /// # Errors
    /// The job's own; [`ApiError::Busy`] at once when all places are taken, or when the memory is full; [`ApiError::DeadlineExceeded`];
    /// [`ApiError::Internal`] when the job panics.
    pub async fn run<T, F>(&self, route: &'static str, job: F) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnOnce(&AtomicBool) -> Result<T, ApiError> + Send + 'static,
    {
        let place = Arc::clone(&self.places).try_acquire_owned().map_err(|_| ApiError::Busy)?;
        self.work(&self.singles, route, place, job, self.deadline).await
    }

    /// Runs the jobs of a batch one after another and gives their results in order, those that the time does not suffice for
    /// as [`ApiError::DeadlineExceeded`].
    ///
    /// Nothing is computed further ahead than one job before the result that is taken next. Where none is taken for as long as a
    /// job may run, or the receiver is dropped, the batch ends: the channel then closes early.
    ///
    /// # Errors
    /// [`ApiError::Busy`] when all places for batches are taken.
    pub fn run_batch<T, F>(
        self: &Arc<Self>,
        route: &'static str,
        jobs: Vec<F>,
        time: Duration,
    ) -> Result<mpsc::Receiver<Result<T, ApiError>>, ApiError>
    where
        T: Send + 'static,
        F: FnOnce(&AtomicBool) -> Result<T, ApiError> + Send + 'static,
    {
        let place = Arc::clone(&self.batches).try_acquire_owned().map_err(|_| ApiError::Busy)?;
        let start = Instant::now();
        let compute = Arc::clone(self);
        let (results, receiver) = mpsc::channel(1);
        let run_all = async move {
            let mut place = Some(place);
            for job in jobs {
                let left = time.saturating_sub(start.elapsed());
                let result = tokio::select! {
                    () = results.closed() => return,
                    result = compute.share(route, job, left) => result,
                };
                let result = match result {
                    Err(ApiError::DeadlineExceeded { .. }) if start.elapsed() >= time => {
                        // Nothing more is computed: the place is for another, however slowly the rest is read.
                        drop(place.take());
                        Err(ApiError::DeadlineExceeded { seconds: time.as_secs_f64() })
                    }
                    result => result,
                };
                if !matches!(timeout(compute.deadline, results.send(result)).await, Ok(Ok(()))) {
                    return;
                }
            }
        };
        tokio::spawn(run_all.instrument(Span::current()));
        Ok(receiver)
    }

    /// Runs a job of a batch that has so much time left, when its turn comes.
    ///
    /// # Errors
    /// As [`Compute::run`], but that it waits for a place.
    pub async fn share<T, F>(&self, route: &'static str, job: F, left: Duration) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnOnce(&AtomicBool) -> Result<T, ApiError> + Send + 'static,
    {
        let start = Instant::now();
        let out_of_time = || ApiError::DeadlineExceeded { seconds: left.as_secs_f64() };
        if left.is_zero() {
            return Err(out_of_time());
        }
        let worker = timeout(left, Arc::clone(&self.turns).acquire_owned()).await.map_err(|_| out_of_time())?;
        let left = left.saturating_sub(start.elapsed());
        self.work(&self.shared, route, worker.map_err(|_| ApiError::Internal)?, job, left.min(self.deadline)).await
    }

    async fn work<T, F>(
        &self,
        pool: &Pool,
        route: &'static str,
        place: OwnedSemaphorePermit,
        job: F,
        allowed: Duration,
    ) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnOnce(&AtomicBool) -> Result<T, ApiError> + Send + 'static,
    {
        let caller = Caller(Arc::default());
        let call = Arc::clone(&caller.0);
        let (memory, metrics) = (Arc::clone(&self.memory), Arc::clone(&self.metrics));
        metrics.job_queued();
        let asked = Instant::now();
        let handle = pool.threads()?.spawn_blocking(move || {
            // The place is free again when the job has ended, not when its caller has gone.
            let _place = place;
            metrics.job_begun(route, asked.elapsed());
            let running = Running { route, call: &call, metrics: &metrics, start: Instant::now() };
            if running.is_wanted() {
                Some(if memory.is_full() { Err(ApiError::Busy) } else { job(&call.interrupt) })
            } else {
                None
            }
        });
        match timeout(allowed, handle).await {
            Ok(Ok(Some(result))) => result,
            Ok(Ok(None)) => Err(ApiError::Internal),
            Ok(Err(panic)) => {
                tracing::error!(%panic, "a job panicked");
                Err(ApiError::Internal)
            }
            Err(_) => {
                caller.0.is_late.store(true, Ordering::Relaxed);
                Err(ApiError::DeadlineExceeded { seconds: self.deadline.as_secs_f64() })
            }
        }
    }

    /// Whether a single job would find a place.
    pub fn has_room(&self) -> bool {
        self.places.available_permits() > 0
    }
}

/// Threads that compute, in the order in which they are asked.
#[derive(Debug)]
struct Pool {
    /// Some until dropped.
    threads: Option<Runtime>,
}

impl Pool {
    fn new(name: &str, threads: usize) -> std::io::Result<Self> {
        let threads = Builder::new_current_thread().max_blocking_threads(threads).thread_name(name).build()?;
        Ok(Self { threads: Some(threads) })
    }

    fn threads(&self) -> Result<&Runtime, ApiError> {
        self.threads.as_ref().ok_or(ApiError::Internal)
    }
}

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
    /// Raised when nobody waits any more.
    interrupt: AtomicBool,
    /// Whether that is because the time ran out.
    is_late: AtomicBool,
}

/// Somebody who waits for a job; the flag is raised when they stop waiting.
struct Caller(Arc<Call>);

impl Drop for Caller {
    fn drop(&mut self) {
        self.0.interrupt.store(true, Ordering::Relaxed);
    }
}

/// A job that a worker has; counted when it is over, by a panic too.
struct Running<'a> {
    route: &'static str,
    call: &'a Call,
    metrics: &'a Metrics,
    start: Instant,
}

impl Running<'_> {
    fn is_wanted(&self) -> bool {
        !self.call.interrupt.load(Ordering::Relaxed)
    }
}

impl Drop for Running<'_> {
    fn drop(&mut self) {
        if !self.is_wanted() {
            let is_late = self.call.is_late.load(Ordering::Relaxed);
            self.metrics.job_cancelled(self.route, if is_late { "deadline" } else { "disconnect" });
        }
        self.metrics.job_over(self.route, self.start.elapsed());
    }
}
