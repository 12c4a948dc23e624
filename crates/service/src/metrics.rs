//! What the service counts, for Prometheus: `GET /metrics`.

use std::fmt;
use std::fs;
use std::hash::Hash;
use std::time::Duration;

use prometheus_client::encoding::EncodeLabelSet;
use prometheus_client::encoding::text::encode;
use prometheus_client::metrics::counter::Counter;
use prometheus_client::metrics::family::Family;
use prometheus_client::metrics::gauge::Gauge;
use prometheus_client::metrics::histogram::Histogram;
use prometheus_client::metrics::info::Info;
use prometheus_client::registry::{Registry, Unit};
use reentry::integrate::lane_instructions;

/// The media type of the text.
pub const MEDIA_TYPE: &str = "application/openmetrics-text; version=1.0.0; charset=utf-8";

/// Upper ends of the buckets, s: from a flight without rows on an idle machine to the time that a batch is allowed by itself.
const SECONDS: [f64; 15] = [5e-4, 1e-3, 2e-3, 5e-3, 1e-2, 2e-2, 5e-2, 0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 60.0];

/// A route, as the OpenAPI document has it; `other` for what is at none.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Route {
    route: String,
}

/// How a request ended: `ok`, the last part of the problem's `type`, or `abandoned` where its client went away. How a search ended: the word of
/// its answer, or `band` and `no_band`.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Ending {
    route: String,
    outcome: &'static str,
}

/// How a case of a batch ended.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct CaseEnding {
    outcome: &'static str,
}

/// Why a job was cancelled.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Cancelled {
    route: &'static str,
    cause: &'static str,
}

/// What is held in memory.
#[derive(Clone, Debug, PartialEq, Eq, Hash, EncodeLabelSet)]
struct Kind {
    kind: &'static str,
}

/// What an answer cost, and how its search ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Work {
    /// How the search ended, where there was one: a word of ours.
    pub search: Option<&'static str>,
    /// Flights that were completed.
    pub flights: u64,
    /// Accepted steps of the integrator.
    pub steps: u64,
    /// Steps that were tried and missed the tolerance.
    pub rejected_steps: u64,
    /// Evaluations of the right-hand side.
    pub evaluations: u64,
    /// Rows of the answer.
    pub rows: u64,
}

/// What is measured when it is asked for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Now {
    /// Bytes that are held, of each kind.
    pub held: [(&'static str, usize); 3],
    /// Lines of the log that nobody took in time.
    pub lost_lines: usize,
    /// Clients that the rate limit remembers.
    pub clients: usize,
}

/// All that is counted; every method may be called by any thread.
#[derive(Debug)]
pub struct Metrics {
    registry: Registry,
    requests: Family<Ending, Counter>,
    durations: Times<Ending>,
    in_flight: Family<Route, Gauge>,
    received: Family<Route, Counter>,
    sent: Family<Route, Counter>,
    queued: Gauge,
    running: Gauge,
    suspended: Gauge,
    waits: Times<Route>,
    compute: Times<Route>,
    cancelled: Family<Cancelled, Counter>,
    cases: Family<CaseEnding, Counter>,
    searches: Family<Ending, Counter>,
    flights: Family<Route, Counter>,
    steps: Family<Route, Counter>,
    rejected_steps: Family<Route, Counter>,
    evaluations: Family<Route, Counter>,
    rows: Family<Route, Counter>,
    connections: Gauge,
    stalled: Counter,
    held: Family<Kind, Gauge>,
    clients: Gauge,
    lost_lines: Counter,
    resident: Gauge,
}

impl Default for Metrics {
    fn default() -> Self {
        Self::new(1)
    }
}

/// Histograms of times.
type Times<L> = Family<L, Histogram, fn() -> Histogram>;

fn times<L: Clone + Eq + Hash>() -> Times<L> {
    Times::new_with_constructor(|| Histogram::new(SECONDS))
}

impl Metrics {
    /// All zero, of a service with so many threads that compute.
    pub fn new(workers: usize) -> Self {
        let mut registry = Registry::with_prefix("reentry");
        let lanes = lane_instructions().unwrap_or("none");
        let build = Info::new([("version", env!("CARGO_PKG_VERSION")), ("lanes", lanes)]);
        registry.register("build", "Version of the program, and instructions of the lanes of searches", build);
        let all: Gauge = Gauge::default();
        all.set(signed(workers));
        registry.register("workers", "Worker threads", all);
        let mut metrics = Self {
            registry,
            requests: Family::default(),
            durations: times(),
            in_flight: Family::default(),
            received: Family::default(),
            sent: Family::default(),
            queued: Gauge::default(),
            running: Gauge::default(),
            suspended: Gauge::default(),
            waits: times(),
            compute: times(),
            cancelled: Family::default(),
            cases: Family::default(),
            searches: Family::default(),
            flights: Family::default(),
            steps: Family::default(),
            rejected_steps: Family::default(),
            evaluations: Family::default(),
            rows: Family::default(),
            connections: Gauge::default(),
            stalled: Counter::default(),
            held: Family::default(),
            clients: Gauge::default(),
            lost_lines: Counter::default(),
            resident: Gauge::default(),
        };
        metrics.register();
        metrics
    }

    fn register(&mut self) {
        let r = &mut self.registry;
        r.register("requests", "Completed requests", self.requests.clone());
        let help = "Time from the head of a request to the last byte of its response, including the time that the \
                    client takes to read it";
        r.register_with_unit("request_duration", help, Unit::Seconds, self.durations.clone());
        r.register("requests_in_flight", "Requests in progress", self.in_flight.clone());
        r.register_with_unit("request", "Size of received request bodies", Unit::Bytes, self.received.clone());
        r.register_with_unit("response", "Size of sent response bodies", Unit::Bytes, self.sent.clone());
        r.register("jobs_queued", "Jobs waiting for a worker", self.queued.clone());
        r.register("jobs_running", "Jobs running on a worker", self.running.clone());
        let help = "Jobs suspended in favour of others or waiting for memory";
        r.register("jobs_suspended", help, self.suspended.clone());
        r.register_with_unit("queue_wait", "Time that jobs waited for a worker", Unit::Seconds, self.waits.clone());
        r.register_with_unit("compute", "Computing time of jobs", Unit::Seconds, self.compute.clone());
        r.register(
            "cancellations",
            "Jobs cancelled because the client disconnected or the time limit was exceeded",
            self.cancelled.clone(),
        );
        r.register("batch_cases", "Cases of batches", self.cases.clone());
        r.register("searches", "Completed searches, by their outcome", self.searches.clone());
        r.register("flights", "Completed flights, those of searches included", self.flights.clone());
        r.register("integration_steps", "Accepted integration steps of completed flights", self.steps.clone());
        r.register(
            "integration_steps_rejected",
            "Rejected integration steps of completed flights",
            self.rejected_steps.clone(),
        );
        r.register(
            "evaluations",
            "Evaluations of the equations of motion of completed flights",
            self.evaluations.clone(),
        );
        r.register("rows", "Rows of trajectories", self.rows.clone());
        r.register("connections", "Open connections", self.connections.clone());
        r.register(
            "connections_stalled",
            "Connections closed because the client did not read its response",
            self.stalled.clone(),
        );
        r.register_with_unit("held", "Memory used by request bodies and responses", Unit::Bytes, self.held.clone());
        r.register("rate_limit_clients", "Clients tracked by the rate limit", self.clients.clone());
        r.register(
            "log_lines_lost",
            "Log lines lost because standard error was not read in time",
            self.lost_lines.clone(),
        );
        r.register_with_unit("resident_memory", "Resident memory of the program", Unit::Bytes, self.resident.clone());
    }

    /// The text.
    ///
    /// # Errors
    /// Never: a text can always be written.
    pub fn text(&self, now: Now) -> Result<String, fmt::Error> {
        for (kind, held) in now.held {
            self.held.get_or_create(&Kind { kind }).set(signed(held));
        }
        self.clients.set(signed(now.clients));
        self.lost_lines.inc_by((now.lost_lines as u64).saturating_sub(self.lost_lines.get()));
        self.resident.set(resident().unwrap_or_default());
        let mut text = String::new();
        encode(&mut text, &self.registry)?;
        Ok(text)
    }

    /// A request has come.
    pub fn request_begun(&self, route: &str) {
        self.in_flight.get_or_create(&Route { route: route.to_owned() }).inc();
    }

    /// A request is over, and so many bytes of its answer have been sent.
    pub fn request_over(&self, route: &str, outcome: &'static str, duration: Duration, sent: u64) {
        let ending = Ending { route: route.to_owned(), outcome };
        self.requests.get_or_create(&ending).inc();
        self.durations.get_or_create(&ending).observe(duration.as_secs_f64());
        let route = Route { route: ending.route };
        self.in_flight.get_or_create(&route).dec();
        self.sent.get_or_create(&route).inc_by(sent);
    }

    /// So many bytes of a body have come.
    pub fn received(&self, route: &str, bytes: usize) {
        self.received.get_or_create(&Route { route: route.to_owned() }).inc_by(bytes as u64);
    }

    /// A job waits for a worker.
    pub fn job_queued(&self) {
        self.queued.inc();
    }

    /// A worker has taken a job that waited.
    pub fn job_begun(&self, route: &'static str, waited: Duration) {
        // In this order: a job is never in neither.
        self.running.inc();
        self.queued.dec();
        self.waits.get_or_create(&Route { route: route.to_owned() }).observe(waited.as_secs_f64());
    }

    /// A job has given way to others.
    pub fn job_suspended(&self) {
        self.running.dec();
        self.suspended.inc();
    }

    /// A job goes on that gave way.
    pub fn job_resumed(&self) {
        self.suspended.dec();
        self.running.inc();
    }

    /// A worker has ended a job that computed for so long.
    pub fn job_over(&self, route: &'static str, computed: Duration) {
        self.running.dec();
        self.compute.get_or_create(&Route { route: route.to_owned() }).observe(computed.as_secs_f64());
    }

    /// A job was cancelled, waiting or running.
    pub fn job_cancelled(&self, route: &'static str, cause: &'static str) {
        self.cancelled.get_or_create(&Cancelled { route, cause }).inc();
    }

    /// A case of a batch has its line.
    pub fn case_over(&self, outcome: &'static str) {
        self.cases.get_or_create(&CaseEnding { outcome }).inc();
    }

    /// A flight, or a search with all of its flights, is finished.
    pub fn flown(&self, route: &'static str, work: Work) {
        if let Some(outcome) = work.search {
            self.searches.get_or_create(&Ending { route: route.to_owned(), outcome }).inc();
        }
        let route = Route { route: route.to_owned() };
        for (counter, count) in [
            (&self.flights, work.flights),
            (&self.steps, work.steps),
            (&self.rejected_steps, work.rejected_steps),
            (&self.evaluations, work.evaluations),
            (&self.rows, work.rows),
        ] {
            counter.get_or_create(&route).inc_by(count);
        }
    }

    /// A connection was opened.
    pub fn connected(&self) {
        self.connections.inc();
    }

    /// A connection is closed; whether since its client took nothing of an answer.
    pub fn disconnected(&self, stalled: bool) {
        self.connections.dec();
        self.stalled.inc_by(u64::from(stalled));
    }
}

fn signed(count: usize) -> i64 {
    i64::try_from(count).unwrap_or(i64::MAX)
}

/// Bytes of memory that this program has, as Linux counts them.
fn resident() -> Option<i64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmRSS:"))?;
    line.trim().strip_suffix(" kB")?.trim().parse::<i64>().ok().map(|kilobytes| 1024 * kilobytes)
}
