//! What all requests share.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use crate::compute::Compute;
use crate::config::Config;
use crate::memory::Memory;
use crate::metrics::{Metrics, Now};
use crate::rate::RateLimit;
use crate::telemetry::LostLines;

/// The settings, what is shared, and whether the service is going down; cheap to clone.
#[derive(Clone, Debug)]
pub struct AppState {
    /// The settings.
    pub config: Arc<Config>,
    /// The pool of workers.
    pub compute: Arc<Compute>,
    /// The bytes of bodies and answers.
    pub memory: Memory,
    /// What is counted.
    pub metrics: Arc<Metrics>,
    /// The rate limit, if there is one.
    pub rate_limit: Option<Arc<RateLimit>>,
    lost_lines: LostLines,
    draining: Arc<AtomicBool>,
}

impl AppState {
    /// The state of a service with these settings, whose log may lose lines.
    ///
    /// # Errors
    /// When the system gives no thread for the workers.
    pub fn new(config: Config, lost_lines: LostLines) -> std::io::Result<Self> {
        let memory = Memory::new(config.memory);
        let metrics = Arc::new(Metrics::new(config.workers()));
        let rate_limit = RateLimit::of(&config).map(Arc::new);
        let compute = Compute::new(&config, memory.clone(), Arc::clone(&metrics), rate_limit.clone())?;
        Ok(Self {
            compute: Arc::new(compute),
            memory,
            metrics,
            rate_limit,
            lost_lines,
            draining: Arc::default(),
            config: Arc::new(config),
        })
    }

    /// From now on the service is not ready for new requests.
    pub fn drain(&self) {
        self.draining.store(true, Ordering::Relaxed);
    }

    /// Whether the service is going down.
    pub fn is_draining(&self) -> bool {
        self.draining.load(Ordering::Relaxed)
    }

    /// What is measured when the metrics are asked for.
    pub fn now(&self) -> Now {
        Now {
            held: [
                ("batch_bodies", self.memory.batch_bodies.held()),
                ("bodies", self.memory.bodies.held()),
                ("answers", self.memory.answers.held()),
            ],
            clients: self.rate_limit.as_ref().map_or(0, |limit| limit.clients()),
            lost_lines: self.lost_lines.count(),
        }
    }
}
