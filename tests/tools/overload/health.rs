//! How the service is beside a flood, and after it.

use std::io::{self, Error};
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use reentry_tests::loopback::{get, percentile};
use tokio::task::JoinHandle;
use tokio::time::{Instant, sleep, sleep_until};

use crate::flood::Connections;
use crate::mix::{Kind, Tally};

/// Between two questions to `/health/live`.
const PERIOD: Duration = Duration::from_millis(2);
/// For how long short requests are asked to see whether they are as quick as before.
const CALM_WINDOW: Duration = Duration::from_millis(200);
/// When the recovery is given up.
const NO_RECOVERY: Duration = Duration::from_secs(20);

/// What `/health/live` took, ms, in order.
#[derive(Debug)]
pub(crate) struct Health(Vec<f64>);

/// The question to `/health/live`, again and again until stopped.
#[derive(Debug)]
pub(crate) struct Watch {
    stop: Arc<AtomicBool>,
    task: JoinHandle<io::Result<Vec<f64>>>,
}

impl Health {
    /// Begins to ask.
    pub(crate) fn watch(address: SocketAddr) -> Watch {
        let stop = Arc::new(AtomicBool::new(false));
        let task = tokio::spawn(watch(address, Arc::clone(&stop)));
        Watch { stop, task }
    }

    /// The latency, ms, that so many of a hundred answers do not exceed.
    pub(crate) fn percentile(&self, percent: usize) -> f64 {
        percentile(&self.0, percent)
    }
}

impl Watch {
    /// Asks no more.
    pub(crate) async fn stop(self) -> io::Result<Health> {
        self.stop.store(true, Ordering::Relaxed);
        self.task.await?.map(Health)
    }
}

async fn watch(address: SocketAddr, stop: Arc<AtomicBool>) -> io::Result<Vec<f64>> {
    let connections = Connections::new(address);
    let mut latencies = Vec::new();
    while !stop.load(Ordering::Relaxed) {
        let start = Instant::now();
        let reply = connections.request(&get("/health/live")).await?;
        if reply.status != 200 {
            return Err(Error::other(format!("/health/live answers {}", reply.status)));
        }
        push_all(&mut latencies, start.elapsed());
        sleep_until(start + PERIOD).await;
    }
    latencies.sort_by(f64::total_cmp);
    Ok(latencies)
}

/// The latency of an answer, and those of the questions that were due while it was waited for.
fn push_all(latencies: &mut Vec<f64>, mut latency: Duration) {
    latencies.push(latency.as_secs_f64() * 1e3);
    while latency > PERIOD {
        latency -= PERIOD;
        latencies.push(latency.as_secs_f64() * 1e3);
    }
}

/// How long after a flood things are as before, s.
#[derive(Debug)]
pub(crate) struct Recovery {
    /// A short request is served, and the service says that it is ready.
    pub(crate) served: f64,
    /// From then on, short requests are as quick as before.
    pub(crate) calm: f64,
}

/// Waits after the end of a flood until all is as before: the median of short requests is no more than `calm` ms.
pub(crate) async fn recover(address: SocketAddr, short: &Kind, calm: f64, end: Instant) -> io::Result<Recovery> {
    let connections = Connections::new(address);
    let mut recovery = Recovery { served: f64::INFINITY, calm: f64::INFINITY };
    while recovery.served.is_infinite() && end.elapsed() < NO_RECOVERY {
        let served = connections.request(&short.request).await?.status == 200;
        if served && connections.request(&get("/health/ready")).await?.status == 200 {
            recovery.served = end.elapsed().as_secs_f64();
        } else {
            sleep(PERIOD).await;
        }
    }
    while recovery.calm.is_infinite() && end.elapsed() < NO_RECOVERY {
        let start = end.elapsed().as_secs_f64();
        if ask_for(&connections, short, CALM_WINDOW).await.percentile(50) <= calm {
            recovery.calm = start;
        }
    }
    Ok(recovery)
}

/// Asks a kind for a time, one request after another.
pub(crate) async fn ask_for(connections: &Connections, kind: &Kind, time: Duration) -> Tally {
    let mut tally = Tally::default();
    let start = Instant::now();
    while start.elapsed() < time && tally.wrong.is_empty() {
        let sent = Instant::now();
        let reply = connections.request(&kind.request).await;
        tally.count(kind, &reply, sent.elapsed());
    }
    tally.served.sort_by(f64::total_cmp);
    tally
}
