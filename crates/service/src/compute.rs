//! The pool of blocking threads on which every job runs: bounded, with a deadline, and cancelled when nobody waits any more.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use tokio::runtime::{Builder, Runtime};
use tokio::sync::Semaphore;

use crate::error::ApiError;

/// A runtime of its own whose blocking threads compute; the threads that talk to clients never do.
#[derive(Debug)]
pub struct Compute {
    /// Some until dropped.
    pool: Option<Runtime>,
    places: Arc<Semaphore>,
    deadline: Duration,
}

impl Compute {
    /// A pool of `workers` threads before which `queue` jobs may wait; each job, its waiting included, may take the deadline.
    ///
    /// # Errors
    /// When the system gives no thread.
    pub fn new(workers: usize, queue: usize, deadline: Duration) -> std::io::Result<Self> {
        let pool = Builder::new_multi_thread()
            .worker_threads(1)
            .max_blocking_threads(workers)
            .thread_name("reentry-compute")
            .build()?;
        Ok(Self { pool: Some(pool), places: Arc::new(Semaphore::new(workers + queue)), deadline })
    }

    /// Runs a job, which is to stop soon after its flag is raised: at the deadline, or when the caller is dropped.
    ///
    /// # Errors
    /// The job's own; [`ApiError::Busy`] at once when all places are taken; [`ApiError::DeadlineExceeded`];
    /// [`ApiError::Internal`] when the job panics.
    pub async fn run<T, F>(&self, job: F) -> Result<T, ApiError>
    where
        T: Send + 'static,
        F: FnOnce(&AtomicBool) -> Result<T, ApiError> + Send + 'static,
    {
        let pool = self.pool.as_ref().ok_or(ApiError::Internal)?;
        let place = Arc::clone(&self.places).try_acquire_owned().map_err(|_| ApiError::Busy)?;
        let caller = Caller(Arc::new(AtomicBool::new(false)));
        let interrupt = Arc::clone(&caller.0);
        let handle = pool.spawn_blocking(move || {
            // The place is free again when the job has ended, not when its caller has gone.
            let _place = place;
            if interrupt.load(Ordering::Relaxed) { None } else { Some(job(&interrupt)) }
        });
        match tokio::time::timeout(self.deadline, handle).await {
            Ok(Ok(Some(result))) => result,
            Ok(Ok(None)) => Err(ApiError::Internal),
            Ok(Err(panic)) => {
                tracing::error!(%panic, "a job panicked");
                Err(ApiError::Internal)
            }
            Err(_) => Err(ApiError::DeadlineExceeded { seconds: self.deadline.as_secs_f64() }),
        }
    }

    /// Whether a job would find a place.
    pub fn has_room(&self) -> bool {
        self.places.available_permits() > 0
    }
}

impl Drop for Compute {
    fn drop(&mut self) {
        if let Some(pool) = self.pool.take() {
            pool.shutdown_background();
        }
    }
}

/// Somebody who waits for a job; the flag is raised when they stop waiting.
struct Caller(Arc<AtomicBool>);

impl Drop for Caller {
    fn drop(&mut self) {
        self.0.store(true, Ordering::Relaxed);
    }
}
