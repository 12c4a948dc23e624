//! The rate limit: how many requests a client may send.

use std::net::{IpAddr, Ipv6Addr};
use std::time::Duration;

use axum::http::{HeaderMap, HeaderName, HeaderValue};
use governor::clock::{Clock, DefaultClock};
use governor::middleware::StateInformationMiddleware;
use governor::{DefaultKeyedRateLimiter, Quota};

use crate::config::Config;
use crate::error::ApiError;

/// How many requests a client may send at once, and in how many seconds that many come back.
pub const POLICY: HeaderName = HeaderName::from_static("ratelimit-policy");

/// How many are left of them, and in how many seconds all are back.
pub const LEFT: HeaderName = HeaderName::from_static("ratelimit");

/// How often clients are forgotten that could send all at once again.
pub const FORGETTING: Duration = Duration::from_secs(10);

/// What each client has left.
#[derive(Debug)]
pub struct RateLimit {
    clients: DefaultKeyedRateLimiter<IpAddr, StateInformationMiddleware>,
    clock: DefaultClock,
    burst: u32,
    /// Between two requests on average, s.
    period: f64,
}

impl RateLimit {
    /// The limit of the settings, if they have one.
    pub fn of(config: &Config) -> Option<Self> {
        let period = config.rate_limit?.recip();
        let quota = Quota::with_period(Duration::from_secs_f64(period))?.allow_burst(config.rate_burst);
        let clients = DefaultKeyedRateLimiter::keyed(quota).with_middleware();
        Some(Self { clients, clock: DefaultClock::default(), burst: config.rate_burst.get(), period })
    }

    /// Takes one from what the client has left.
    ///
    /// # Errors
    /// [`ApiError::TooManyRequests`] where nothing is left.
    pub fn take(&self, client: IpAddr) -> Result<Left, ApiError> {
        match self.clients.check_key(&who(client)) {
            Ok(state) => Ok(Left { requests: state.remaining_burst_capacity() }),
            Err(refusal) => {
                let seconds = refusal.wait_time_from(self.clock.now()).as_secs_f64();
                Err(ApiError::TooManyRequests { seconds: whole_seconds(seconds).max(1) })
            }
        }
    }

    /// Says what is left, as the draft `draft-ietf-httpapi-ratelimit-headers` (10) has it.
    pub fn tell(&self, left: Left, headers: &mut HeaderMap) {
        let Self { burst, period, .. } = self;
        let window = whole_seconds(f64::from(*burst) * period).max(1);
        let reset = whole_seconds(f64::from(burst - left.requests) * period);
        for (name, text) in [
            (POLICY, format!("\"client\";q={burst};w={window}")),
            (LEFT, format!("\"client\";r={};t={reset}", left.requests)),
        ] {
            if let Ok(value) = HeaderValue::from_str(&text) {
                headers.insert(name, value);
            }
        }
    }

    /// Forgets the clients that could send all at once again.
    pub fn forget(&self) {
        self.clients.retain_recent();
        self.clients.shrink_to_fit();
    }

    /// The clients that are remembered.
    pub fn clients(&self) -> usize {
        self.clients.len()
    }
}

/// Requests that a client may still send at once.
#[derive(Clone, Copy, Debug, Default)]
pub struct Left {
    requests: u32,
}

/// The network of an address of IPv6, of which a client has as many as it likes; an address of IPv4 is one client.
fn who(client: IpAddr) -> IpAddr {
    match client {
        IpAddr::V4(_) => client,
        IpAddr::V6(address) => Ipv6Addr::from_bits(address.to_bits() & (u128::MAX << 64)).into(),
    }
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive number of seconds, far below 2^64"
)]
fn whole_seconds(seconds: f64) -> u64 {
    seconds.ceil() as u64
}
