//! The settings, from flags and environment, read once at start.

use std::net::SocketAddr;
use std::num::NonZeroUsize;
use std::time::Duration;

use clap::{Args, ValueEnum};

/// Settings of `reentry serve`.
#[derive(Args, Clone, Debug)]
pub struct Config {
    /// Address and port to listen on; 0.0.0.0:8080 answers other machines, port 0 takes a free one
    #[arg(long, env = "REENTRY_LISTEN", default_value = "127.0.0.1:8080")]
    pub listen: SocketAddr,

    /// Threads that compute; 0 takes as many as there are processors
    #[arg(long, env = "REENTRY_WORKERS", default_value_t = 0)]
    pub workers: usize,

    /// Requests that may wait for a worker; one more is refused with 503
    #[arg(long, env = "REENTRY_QUEUE", default_value_t = 64)]
    pub queue: usize,

    /// Seconds that a job may take, waiting included, before 504 is answered, and that its body may take before 408
    #[arg(long, env = "REENTRY_DEADLINE", default_value = "10", value_parser = seconds)]
    pub deadline: Duration,

    /// Bytes that the body of a request may have; a longer one is refused with 413
    #[arg(long, env = "REENTRY_BODY_LIMIT", default_value_t = 1 << 20)]
    pub body_limit: usize,

    /// Batches that may be under way at once; one more is refused with 503
    #[arg(long, env = "REENTRY_BATCHES", default_value_t = 16)]
    pub batches: usize,

    /// Seconds that a batch may take in all; 504 is then the answer of the cases that are left
    #[arg(long, env = "REENTRY_BATCH_DEADLINE", default_value = "60", value_parser = seconds)]
    pub batch_deadline: Duration,

    /// Bytes that the body of a batch may have; a longer one is refused with 413
    #[arg(long, env = "REENTRY_BATCH_BODY_LIMIT", default_value_t = 8 << 20)]
    pub batch_body_limit: usize,

    /// Rows that a trajectory may have; more are refused with 422
    #[arg(long, env = "REENTRY_ROW_LIMIT", default_value_t = 100_000)]
    pub row_limit: usize,

    /// Bytes from which an answer is compressed, if the client accepts that
    #[arg(long, env = "REENTRY_COMPRESS_ABOVE", default_value_t = 16_384)]
    pub compress_above: u64,

    /// Seconds that requests may go on after SIGTERM or SIGINT
    #[arg(long, env = "REENTRY_GRACE", default_value = "20", value_parser = seconds)]
    pub grace: Duration,

    /// Form of the log lines on standard error; `RUST_LOG` sets their level
    #[arg(long, env = "REENTRY_LOG_FORMAT", value_enum, default_value_t = LogFormat::Text)]
    pub log_format: LogFormat,
}

/// How a log line looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LogFormat {
    /// For people
    Text,
    /// For programs, one object a line
    Json,
}

impl Config {
    /// The number of threads that compute.
    pub fn workers(&self) -> usize {
        match self.workers {
            0 => processors(),
            workers => workers,
        }
    }
}

impl Default for Config {
    /// What `reentry serve` has without flags and environment, listening on a free port.
    fn default() -> Self {
        Self {
            listen: SocketAddr::from(([127, 0, 0, 1], 0)),
            workers: 0,
            queue: 64,
            deadline: Duration::from_secs(10),
            body_limit: 1 << 20,
            batches: 16,
            batch_deadline: Duration::from_mins(1),
            batch_body_limit: 8 << 20,
            row_limit: 100_000,
            compress_above: 16_384,
            grace: Duration::from_secs(20),
            log_format: LogFormat::Text,
        }
    }
}

/// The number of processors.
pub fn processors() -> usize {
    std::thread::available_parallelism().map_or(1, NonZeroUsize::get)
}

/// A positive number of seconds.
fn seconds(text: &str) -> Result<Duration, String> {
    let seconds = text.parse().map_err(|_| "must be a number of seconds".to_owned())?;
    let duration = Duration::try_from_secs_f64(seconds).map_err(|error| error.to_string())?;
    if duration.is_zero() { Err("must be greater than 0".to_owned()) } else { Ok(duration) }
}

#[cfg(test)]
mod tests {
    use clap::{Args, Command, FromArgMatches};

    use super::Config;

    #[test]
    fn the_default_is_what_the_program_has_without_flags() {
        let command = Config::augment_args(Command::new("reentry")).mut_args(|arg| arg.env(None));
        let parsed = command.try_get_matches_from(["reentry", "--listen", "127.0.0.1:0"]);
        let parsed = Config::from_arg_matches(&parsed.unwrap()).unwrap();
        assert_eq!(format!("{parsed:?}"), format!("{:?}", Config::default()));
    }
}
