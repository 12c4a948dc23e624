//! The pool of blocking threads on which every job runs: bounded, with a deadline, and cancelled when nobody waits any more.
//!
//! Single jobs and batches have workers of their own, so that neither waits for the other: what both compute at once, the system divides
//! between them. Jobs that have computed for long give way to short ones, where they look at their flag: see [`Task`].

mod slots;
mod task;
mod turns;

use std::sync::atomic::AtomicU32;
use std::sync::{Arc, Mutex};
use std::time::Duration;

use tokio::runtime::{Builder, Runtime};
use tokio::sync::mpsc::error::TrySendError;
use tokio::sync::{OwnedSemaphorePermit, Semaphore, mpsc, oneshot};
use tokio::time::{Instant, timeout};
use tracing::{Instrument, Span};

use crate::client::Client;
use crate::config::Config;
use crate::error::ApiError;
use crate::memory::{HURRY, Memory};
use crate::metrics::Metrics;
use crate::rate::RateLimit;
use slots::{Slot, Slots};
use task::{Progress, Waiter};
use turns::Turns;

pub use task::Task;

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

    /// Runs a job of a route for a client, and runs it again where it found no room in memory. It is to stop soon after its flag is raised:
    /// at the deadline, or when whoever waits for it goes away.
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
                                tracing::info!("the batch ended early: its client read nothing");
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
        let (waiter, state) = Waiter::new();
        let (done, mut result) = oneshot::channel();
        let task = Task {
            state,
            route,
            client,
            turns: Arc::clone(&pool.turns),
            suspended: Arc::clone(&pool.suspended),
            most_suspended: pool.most_suspended,
            asked: Instant::now(),
            polls: AtomicU32::new(0),
            progress: Mutex::new(Progress::new(place, self.memory.answers.permit(client))),
            metrics: Arc::clone(&self.metrics),
            rate_limit: self.rate_limit.clone(),
        };
        let answers = Arc::clone(&self.memory.answers);
        self.metrics.job_queued();
        pool.turns.submit(Box::new(move |turn| {
            task.begin(turn);
            if let Err(refusal) = answers.admit(client) {
                task.refuse(refusal.into());
            }
            let result = task.run(&mut job);
            let turn = task.take_turn();
            // It is counted, and what it held given back, before it is known to be over.
            drop(task);
            drop(job);
            // An error: nobody waits.
            let _ = done.send(result);
            turn
        }));
        let late = |allowed: Duration| {
            waiter.is_late();
            ApiError::DeadlineExceeded { seconds: allowed.as_secs_f64() }
        };
        let allowed = left.min(self.deadline);
        if left > self.deadline {
            // A case of a batch, whose time begins when it does.
            tokio::select! {
                biased;
                over = &mut result => return over.map_err(|_| ApiError::Internal)?,
                begun = timeout(left, waiter.begun()) => begun.map_err(|_| late(left))?,
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

#[cfg(test)]
mod tests {
    use super::*;

    #[tokio::test(flavor = "multi_thread")]
    async fn a_long_job_gives_way_and_is_known_once_it_is_given_up() {
        let config = Config { workers: 1, queue: 4, deadline: Duration::from_secs(2), ..Config::default() };
        let metrics = Arc::new(Metrics::new(1));
        let compute = Arc::new(Compute::new(&config, Memory::new(1 << 20), metrics, None).unwrap());
        let given_up = || compute.singles.turns.given_up(Instant::now().into_std());
        let client = Client::default();
        let (begin, begun) = std::sync::mpsc::channel();
        let of_endless = Arc::clone(&compute);
        let endless = tokio::spawn(async move {
            let job = move |task: &Task| {
                let _ = begin.send(());
                while !reentry::Interrupt::is_raised(task) {}
                Err::<(), _>(ApiError::Interrupted)
            };
            of_endless.run("/simulate", client, job).await
        });
        begun.recv().unwrap();
        // There is one worker, which the endless one has until it is long.
        compute.run("/simulate", client, |_| Ok(())).await.unwrap();
        assert_eq!(given_up(), 0);
        assert!(matches!(endless.await.unwrap(), Err(ApiError::DeadlineExceeded { .. })));
        // It looks at its flag once more before it is over.
        let is_known = async {
            while given_up() == 0 {
                tokio::task::yield_now().await;
            }
        };
        timeout(Duration::from_mins(1), is_known).await.unwrap();
        // One that was never long says nothing of those to come.
        let short = compute.run("/simulate", client, |_| Err::<(), _>(ApiError::Interrupted)).await;
        assert!(short.is_err());
        assert_eq!(given_up(), 1);
    }
}
