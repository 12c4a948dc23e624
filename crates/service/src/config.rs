//! The settings, from flags and environment, read once at start.

use std::net::{IpAddr, SocketAddr};
use std::num::{IntErrorKind, NonZeroU32, NonZeroUsize};
use std::time::Duration;

use axum::http::{HeaderValue, Uri};
use clap::{Args, ValueEnum};
use ipnet::IpNet;
use tracing_subscriber::EnvFilter;
use tracing_subscriber::filter::LevelFilter;

/// Settings of `reentry serve`.
#[derive(Args, Clone, Debug)]
pub struct Config {
    /// Address and port to listen on; 0.0.0.0:8080 accepts connections from other machines, port 0 selects a free port
    #[arg(long, env = "REENTRY_LISTEN", default_value = "127.0.0.1:8080")]
    pub listen: SocketAddr,

    /// Number of threads that compute; 0 uses one per processor
    #[arg(long, env = "REENTRY_WORKERS", default_value_t = 0, value_parser = up_to(1024))]
    pub workers: usize,

    /// Maximum number of requests that wait for a worker, and as many again that yield to shorter ones; further
    /// requests are refused with 503
    #[arg(long, env = "REENTRY_QUEUE", default_value_t = 64, value_parser = up_to(1 << 20))]
    pub queue: usize,

    /// Time limit of a request in seconds, waiting included (504), and of receiving its body (408)
    #[arg(long, env = "REENTRY_DEADLINE", default_value = "10", value_parser = seconds)]
    pub deadline: Duration,

    /// Maximum size of a request body in bytes; a larger body is refused with 413
    #[arg(long, env = "REENTRY_BODY_LIMIT", default_value_t = 1 << 20)]
    pub body_limit: usize,

    /// Maximum number of batches that compute at once, at most half of them from one client; further batches are refused with
    /// 503 or 429
    #[arg(long, env = "REENTRY_BATCHES", default_value_t = 16, value_parser = up_to(1 << 20))]
    pub batches: usize,

    /// Time limit of a batch in seconds; the remaining cases then fail with 504
    #[arg(long, env = "REENTRY_BATCH_DEADLINE", default_value = "60", value_parser = seconds)]
    pub batch_deadline: Duration,

    /// Maximum size of the body of a batch in bytes; a larger body is refused with 413
    #[arg(long, env = "REENTRY_BATCH_BODY_LIMIT", default_value_t = 8 << 20)]
    pub batch_body_limit: usize,

    /// Maximum number of rows of a trajectory; requests for more are refused with 422
    #[arg(long, env = "REENTRY_ROW_LIMIT", default_value_t = 100_000, value_parser = up_to(MOST_ROWS))]
    pub row_limit: usize,

    /// Size in bytes from which a response is compressed, if the client accepts it
    #[arg(long, env = "REENTRY_COMPRESS_ABOVE", default_value_t = 16_384)]
    pub compress_above: u64,

    /// Memory for bodies and responses in bytes: one eighth for bodies of batches, one sixteenth for other bodies, the
    /// rest for responses; one client may use at most half of each. Requests that need more are refused with 503, or with 429
    /// if other clients still have room
    #[arg(long, env = "REENTRY_MEMORY", default_value_t = 256 << 20)]
    pub memory: usize,

    /// Maximum number of open connections, as far as the system allows that many open files; further connections wait
    #[arg(long, env = "REENTRY_CONNECTIONS", default_value_t = 16_384, value_parser = at_least_one)]
    pub connections: usize,

    /// Seconds that a connection may be idle, take to send a request head, or leave a response unread before it is
    /// closed
    #[arg(long, env = "REENTRY_IDLE", default_value = "30", value_parser = seconds)]
    pub idle: Duration,

    /// Seconds that running requests may continue after SIGTERM, SIGINT or SIGQUIT
    #[arg(long, env = "REENTRY_GRACE", default_value = "20", value_parser = seconds)]
    pub grace: Duration,

    /// Requests per second that one client may send on average; 10 ms of computing count as one request. Further
    /// requests are refused with 429. No limit by default
    #[arg(long, env = "REENTRY_RATE_LIMIT", value_name = "RATE", value_parser = rate)]
    pub rate_limit: Option<f64>,

    /// Requests that an idle client may send at once, under a rate limit
    #[arg(long, env = "REENTRY_RATE_BURST", default_value = "20")]
    pub rate_burst: NonZeroU32,

    /// Proxy networks trusted to report the client's address, for example `10.0.0.0/8,::1/128`
    #[arg(long, env = "REENTRY_TRUSTED_PROXIES", value_name = "NETWORKS", value_delimiter = ',', value_parser = network)]
    pub trusted_proxies: Vec<IpNet>,

    /// Header in which trusted proxies report the client's address
    #[arg(long, env = "REENTRY_FORWARDED_HEADER", value_enum, default_value_t = ForwardedHeader::XForwardedFor)]
    pub forwarded_header: ForwardedHeader,

    /// Origins whose pages may call the API from a browser, for example `https://planner.example`; `*` allows all,
    /// `none` allows none
    #[arg(long, env = "REENTRY_CORS_ORIGINS", value_name = "ORIGINS", default_value = "*", value_parser = origins)]
    pub cors_origins: Origins,

    /// Address and port for `GET /metrics`; the main address then does not serve it
    #[arg(long, env = "REENTRY_METRICS_LISTEN", value_name = "ADDRESS")]
    pub metrics_listen: Option<SocketAddr>,

    /// Log levels: error, warn, info, debug or trace, for all modules or per module, for example
    /// `warn,reentry_service=debug`
    #[arg(long, env = "RUST_LOG", value_name = "LEVELS", default_value = "info", value_parser = levels)]
    pub log: String,

    /// Format of the log lines on standard error
    #[arg(long, env = "REENTRY_LOG_FORMAT", value_enum, default_value_t = LogFormat::Text)]
    pub log_format: LogFormat,
}

/// The greatest limit of rows that the service and the command line take: what some 10 GB hold.
pub const MOST_ROWS: usize = 10_000_000;

/// The bodies of batches may have one part in so many of the memory.
pub const BATCH_BODIES: usize = 8;

/// All other bodies may have one part in so many of the memory.
pub const BODIES: usize = 16;

/// How a log line looks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum LogFormat {
    /// Text, for people
    Text,
    /// JSON, one object per line
    Json,
}

/// Where proxies give the address of the client.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum ForwardedHeader {
    /// X-Forwarded-For, used by most proxies
    XForwardedFor,
    /// Forwarded, of RFC 7239
    Forwarded,
}

/// Whose pages may ask from a browser.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origins {
    /// Everybody's.
    All,
    /// These, each a scheme, a host, and a port that is not the scheme's own.
    These(Vec<HeaderValue>),
}

impl Config {
    /// What is wrong with settings that are each sound by themselves.
    ///
    /// # Errors
    /// With the settings and what they should be.
    pub fn check(&self) -> Result<(), String> {
        let least = self.body_limit.saturating_mul(BODIES).max(self.batch_body_limit.saturating_mul(BATCH_BODIES));
        if self.memory < least {
            let memory = self.memory;
            return Err(format!(
                "--memory must be at least {least} bytes, {BODIES} times --body-limit and {BATCH_BODIES} times \
                 --batch-body-limit, got {memory}"
            ));
        }
        if self.metrics_listen == Some(self.listen) && self.listen.port() != 0 {
            return Err("--metrics-listen must differ from --listen".to_owned());
        }
        Ok(())
    }

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
            memory: 256 << 20,
            connections: 16_384,
            idle: Duration::from_secs(30),
            grace: Duration::from_secs(20),
            rate_limit: None,
            rate_burst: const { NonZeroU32::new(20).unwrap() },
            trusted_proxies: Vec::new(),
            forwarded_header: ForwardedHeader::XForwardedFor,
            cors_origins: Origins::All,
            metrics_listen: None,
            log: "info".to_owned(),
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

/// A whole number with a maximum.
pub fn up_to(most: usize) -> impl Fn(&str) -> Result<usize, String> + Clone + Send + Sync + 'static {
    move |text| match text.parse::<usize>().map_err(|error| *error.kind()) {
        Ok(number) if number <= most => Ok(number),
        Ok(_) | Err(IntErrorKind::PosOverflow) => Err(format!("must be at most {most}")),
        Err(_) => Err("must be a whole number".to_owned()),
    }
}

/// A whole number from 1 on.
fn at_least_one(text: &str) -> Result<usize, String> {
    match text.parse() {
        Ok(0) => Err("must be at least 1".to_owned()),
        Ok(number) => Ok(number),
        Err(_) => Err("must be a whole number".to_owned()),
    }
}

/// Requests a second.
fn rate(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(rate) if (1e-3..=1e6).contains(&rate) => Ok(rate),
        _ => Err("must be a number of requests per second, from 0.001 to 1000000".to_owned()),
    }
}

/// A network, or a single address.
fn network(text: &str) -> Result<IpNet, String> {
    let address = || text.parse().map(|address: IpAddr| IpNet::from(address)).ok();
    text.parse()
        .ok()
        .or_else(address)
        .ok_or_else(|| "must be a network, for example 10.0.0.0/8, or an address".to_owned())
}

/// Levels of the log. A word that is no level would be taken for a module of which everything is logged, and nothing of the others.
fn levels(text: &str) -> Result<String, String> {
    let is_level = |part: &str| part.contains('=') || part.trim().parse::<LevelFilter>().is_ok();
    if !text.split(',').all(is_level) {
        return Err("must be off, error, warn, info, debug or trace, or MODULE=LEVEL, between commas".to_owned());
    }
    EnvFilter::try_new(text).map(|_| text.to_owned()).map_err(|error| error.to_string())
}

/// `*`, `none`, or origins between commas.
fn origins(text: &str) -> Result<Origins, String> {
    match text {
        "*" => Ok(Origins::All),
        "none" => Ok(Origins::These(Vec::new())),
        list => list.split(',').map(|item| origin(item.trim())).collect::<Result<_, _>>().map(Origins::These),
    }
}

fn origin(text: &str) -> Result<HeaderValue, String> {
    let fault = || {
        format!(
            "{text:?} must be a scheme and a host, with the port if it is not the scheme's default, for example \
             https://planner.example"
        )
    };
    let uri: Uri = text.parse().map_err(|_| fault())?;
    let is_web = matches!(uri.scheme_str(), Some("http" | "https"));
    // As browsers write it: nothing after the host, which is in lower case.
    if !is_web || text.ends_with('/') || uri.path() != "/" || uri.query().is_some() || text != text.to_lowercase() {
        return Err(fault());
    }
    HeaderValue::from_str(text).map_err(|_| fault())
}

#[cfg(test)]
mod tests {
    use clap::{Args, Command, FromArgMatches};

    use super::Config;

    #[test]
    fn the_guide_has_every_setting_with_its_variable_and_its_default() {
        let chapter = include_str!("../guide/operations.md");
        let command = Config::augment_args(Command::new("reentry"));
        for setting in command.get_arguments().filter(|setting| setting.get_id() != "help") {
            let name = setting.get_long().unwrap();
            let variable = setting.get_env().unwrap().to_str().unwrap();
            let default = setting.get_default_values().first().map_or("none", |value| value.to_str().unwrap());
            let line = format!("| `--{name}` | `{variable}` | {default} | ");
            assert!(chapter.contains(&line), "guide/operations.md does not have {line}");
        }
    }

    #[test]
    fn the_default_is_what_the_program_has_without_flags() {
        let command = Config::augment_args(Command::new("reentry")).mut_args(|arg| arg.env(None));
        let parsed = command.try_get_matches_from(["reentry", "--listen", "127.0.0.1:0"]);
        let parsed = Config::from_arg_matches(&parsed.unwrap()).unwrap();
        assert_eq!(format!("{parsed:?}"), format!("{:?}", Config::default()));
    }
}
