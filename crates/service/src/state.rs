//! What all requests share.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::compute::Compute;
use crate::config::Config;

/// The settings, the pool of workers, and whether the service is going down; cheap to clone.
#[derive(Clone, Debug)]
pub struct AppState {
    /// The settings.
    pub config: Arc<Config>,
    /// The pool of workers.
    pub compute: Arc<Compute>,
    draining: Arc<AtomicBool>,
}

impl AppState {
    /// The state of a service with these settings.
    ///
    /// # Errors
    /// When the system gives no thread for the workers.
    pub fn new(config: Config) -> std::io::Result<Self> {
        let compute = Compute::new(config.workers(), config.queue, config.batches, config.deadline)?;
        Ok(Self { config: Arc::new(config), compute: Arc::new(compute), draining: Arc::default() })
    }

    /// From now on the service is not ready for new requests.
    pub fn drain(&self) {
        self.draining.store(true, Ordering::Relaxed);
    }

    /// Whether the service is going down.
    pub fn is_draining(&self) -> bool {
        self.draining.load(Ordering::Relaxed)
    }
}
