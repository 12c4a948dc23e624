//! The rate limit: how many requests a client may send, and how much it may have computed.
//!
//! Each client has an allowance that comes back with time (the generic cell rate algorithm, which keeps of a client the instant at which
//! all of it is back). What a request costs to compute is known when it is over, and may be more than the client has left: it is then in
//! debt, which no crate for rate limits knows.

use std::collections::HashMap;
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use axum::http::{HeaderMap, HeaderName, HeaderValue};

use crate::client::Client;
use crate::config::Config;
use crate::error::ApiError;

/// How many requests a client may send at once, and in how many seconds that many come back.
pub const POLICY: HeaderName = HeaderName::from_static("ratelimit-policy");

/// How many are left of them, and in how many seconds all are back.
pub const LEFT: HeaderName = HeaderName::from_static("ratelimit");

/// How often clients are forgotten that could send all at once again.
pub const FORGETTING: Duration = Duration::from_secs(10);

/// The computing that costs as much as a request, s.
const COMPUTING: f64 = 0.01;

/// How many times the allowance of a client its site has, which has many where its addresses are of IPv6.
const SITE: f64 = 8.0;

/// What each client has left.
#[derive(Debug)]
pub struct RateLimit {
    start: Instant,
    burst: u32,
    /// In which one request comes back, s.
    period: f64,
    networks: Allowances,
    sites: Allowances,
}

/// When each client has all back, s since the start.
type Allowances = Mutex<HashMap<Client, f64>>;

/// What a client may still ask for.
#[derive(Clone, Copy, Debug, Default)]
pub struct Remainder {
    requests: u32,
    /// Until it has all back, s.
    reset: f64,
}

impl RateLimit {
    /// The limit of the settings, if they have one.
    pub fn of(config: &Config) -> Option<Self> {
        let period = config.rate_limit?.recip();
        let burst = config.rate_burst.get();
        Some(Self { start: Instant::now(), burst, period, networks: Mutex::default(), sites: Mutex::default() })
    }

    /// Takes one from what the client has left.
    ///
    /// # Errors
    /// What is left where that is not enough, with the seconds until it is.
    pub fn take(&self, client: Client) -> Result<Remainder, (Remainder, ApiError)> {
        let now = self.now();
        let (mut networks, mut sites) = (lock(&self.networks), lock(&self.sites));
        let network = networks.entry(client.network()).or_insert(now);
        let site = sites.entry(client.site()).or_insert(now);
        let most = f64::from(self.burst) * self.period;
        let after = network.max(now) + self.period;
        let site_after = site.max(now) + self.period / SITE;
        let wait = (after - now - most).max(site_after - now - most);
        // A rounding is no wait.
        if wait > 1e-9 * most {
            let error = ApiError::TooManyRequests { seconds: whole(wait).max(1) };
            return Err((self.left(*network - now), error));
        }
        (*network, *site) = (after, site_after);
        Ok(self.left(after - now))
    }

    /// Takes what so much computing costs, into debt where that is not left.
    pub fn charge(&self, client: Client, computed: Duration) {
        let now = self.now();
        let price = computed.as_secs_f64() / COMPUTING * self.period;
        for (allowances, client, price) in
            [(&self.networks, client.network(), price), (&self.sites, client.site(), price / SITE)]
        {
            let mut allowances = lock(allowances);
            let all_back = allowances.entry(client).or_insert(now);
            *all_back = all_back.max(now) + price;
        }
    }

    /// What is left where all is back after so many seconds.
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to the burst, by the maximum")]
    fn left(&self, reset: f64) -> Remainder {
        // What is missing of a whole request is a rounding where it is this small.
        let requests = f64::from(self.burst) - reset / self.period + 1e-6;
        Remainder { requests: requests.max(0.0) as u32, reset: reset.max(0.0) }
    }

    /// Writes what is left into the headers, as the draft `draft-ietf-httpapi-ratelimit-headers` (10) has it.
    pub fn write_headers(&self, left: Remainder, headers: &mut HeaderMap) {
        let Self { burst, period, .. } = self;
        let window = whole(f64::from(*burst) * period).max(1);
        let Remainder { requests, reset } = left;
        for (name, text) in [
            (POLICY, format!("\"client\";q={burst};w={window}")),
            (LEFT, format!("\"client\";r={requests};t={}", whole(reset))),
        ] {
            if let Ok(value) = HeaderValue::from_str(&text) {
                headers.insert(name, value);
            }
        }
    }

    /// Forgets the clients that could send all at once again.
    pub fn forget(&self) {
        let now = self.now();
        for allowances in [&self.networks, &self.sites] {
            let mut allowances = lock(allowances);
            allowances.retain(|_, all_back| *all_back > now);
            allowances.shrink_to_fit();
        }
    }

    /// The clients that are remembered.
    pub fn clients(&self) -> usize {
        lock(&self.networks).len()
    }

    fn now(&self) -> f64 {
        self.start.elapsed().as_secs_f64()
    }
}

fn lock(allowances: &Allowances) -> MutexGuard<'_, HashMap<Client, f64>> {
    allowances.lock().unwrap_or_else(PoisonError::into_inner)
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a positive number of seconds, far below 2^64"
)]
fn whole(seconds: f64) -> u64 {
    seconds.ceil() as u64
}
