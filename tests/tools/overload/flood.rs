//! Requests that come by a clock of their own, whether or not those before them are answered.

#![allow(clippy::disallowed_methods, reason = "no digit of a flight depends on it")]

use std::net::SocketAddr;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;
use std::{fs, io};

use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;
use reentry_tests::loopback::{Connection, Reply};
use tokio::sync::mpsc;
use tokio::time::{Instant, sleep_until, timeout, timeout_at};

use crate::mix::{Kind, Tally, draw};

/// Connections that are open at most, where the system allows twice as many.
const MOST_CONNECTIONS: usize = 2000;
/// How long an answer may take before it counts as none: twice what the service allows a job.
const PATIENCE: Duration = Duration::from_secs(20);

/// The connections to a program: those that wait for no answer are taken up again.
#[derive(Debug)]
pub(crate) struct Connections {
    address: SocketAddr,
    most: usize,
    state: Mutex<ConnectionState>,
}

/// What there is of connections.
#[derive(Debug, Default)]
struct ConnectionState {
    free: Vec<Connection>,
    open: usize,
}

/// A connection that is one of those allowed, or the right to open it.
struct Taken(Option<Connection>);

impl Connections {
    /// None yet.
    pub(crate) fn new(address: SocketAddr) -> Self {
        Self { address, most: MOST_CONNECTIONS.min(open_files() / 2), state: Mutex::default() }
    }

    /// How many are open.
    fn open(&self) -> usize {
        self.held(|held| held.open)
    }

    fn held<T>(&self, look: impl FnOnce(&mut ConnectionState) -> T) -> T {
        look(&mut self.state.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// A free one, or else a new one, if one more is allowed.
    fn take(&self) -> Option<Taken> {
        self.held(|held| {
            while let Some(connection) = held.free.pop() {
                if !connection.is_stale() {
                    return Some(Taken(Some(connection)));
                }
                held.open -= 1;
            }
            let room = held.open < self.most;
            held.open += usize::from(room);
            room.then_some(Taken(None))
        })
    }

    /// Asks at once.
    pub(crate) async fn request(&self, request: &[u8]) -> io::Result<Reply> {
        let taken = self.take().ok_or_else(|| io::Error::other("too many connections"))?;
        self.ask(taken, request).await
    }

    /// Asks on a connection that was taken, and gives it back.
    async fn ask(&self, taken: Taken, request: &[u8]) -> io::Result<Reply> {
        let asked = async {
            let mut connection = match taken.0 {
                Some(connection) => connection,
                None => Connection::open(self.address).await?,
            };
            let reply = connection.ask(request).await?;
            Ok((connection, reply))
        };
        let result = timeout(PATIENCE, asked).await.unwrap_or_else(|_| Err(io::ErrorKind::TimedOut.into()));
        match result {
            Ok((connection, reply)) if !reply.closes => {
                self.held(|held| held.free.push(connection));
                Ok(reply)
            }
            other => {
                self.held(|held| held.open -= 1);
                other.map(|(_, reply)| reply)
            }
        }
    }
}

/// How many files this program may have open; the service, which it starts, may have as many.
fn open_files() -> usize {
    let limits = fs::read_to_string("/proc/self/limits").unwrap_or_default();
    let soft =
        limits.lines().find_map(|line| line.strip_prefix("Max open files")?.split_whitespace().next()?.parse().ok());
    // "unlimited", or not told.
    soft.unwrap_or(2 * MOST_CONNECTIONS)
}

/// What became of a flood.
#[derive(Debug)]
pub(crate) struct Flood {
    /// For each kind.
    pub(crate) tallies: Vec<Tally>,
    /// Requests that the clock had and for which there was no connection.
    pub(crate) not_sent: usize,
    /// Requests whose answers nobody waits for any more.
    pub(crate) unanswered: usize,
    /// Requests a second that were sent in fact.
    pub(crate) rate: f64,
    /// How much later than by the clock requests were sent, ms, in order.
    pub(crate) late: Vec<f64>,
    /// Connections in the end.
    pub(crate) connections: usize,
    /// When the last request was sent.
    pub(crate) end: Instant,
}

/// The answers that are still to come to a flood.
pub(crate) struct Rest {
    flood: Flood,
    kinds: Arc<Vec<Kind>>,
    answers: mpsc::UnboundedReceiver<(usize, io::Result<Reply>, Duration)>,
}

/// Sends requests of all kinds for a time, so many a second on average, at instants that do not depend on each other.
#[expect(clippy::cast_precision_loss, reason = "requests are counted far below 2^52")]
pub(crate) async fn flood(
    connections: &Arc<Connections>,
    kinds: &Arc<Vec<Kind>>,
    rate: f64,
    time: Duration,
    chance: &mut Xoshiro256PlusPlus,
) -> Rest {
    let (answered, answers) = mpsc::unbounded_channel();
    let (mut not_sent, mut late) = (0, Vec::new());
    let start = Instant::now();
    let mut due = start;
    loop {
        due += pause(rate, chance);
        if due > start + time {
            break;
        }
        // What is due already goes at once; while nothing is, those have a turn who have an answer to read.
        if due > Instant::now() {
            sleep_until(due).await;
        }
        let position = draw(kinds, chance);
        let Some(taken) = connections.take() else {
            not_sent += 1;
            continue;
        };
        late.push(due.elapsed().as_secs_f64() * 1e3);
        let (connections, kinds, answered) = (Arc::clone(connections), Arc::clone(kinds), answered.clone());
        tokio::spawn(async move {
            let reply = connections.ask(taken, &kinds[position].request).await;
            // An error: nobody counts any more.
            let _ = answered.send((position, reply, due.elapsed()));
        });
    }
    let end = Instant::now();
    let rate = late.len() as f64 / (end - start).as_secs_f64();
    late.sort_by(f64::total_cmp);
    let tallies = kinds.iter().map(|_| Tally::default()).collect();
    let connections = connections.open();
    Rest {
        flood: Flood { tallies, not_sent, unanswered: late.len(), rate, late, connections, end },
        kinds: Arc::clone(kinds),
        answers,
    }
}

/// The time from one request to the next, where they are independent of each other: exponentially distributed.
fn pause(rate: f64, chance: &mut Xoshiro256PlusPlus) -> Duration {
    Duration::from_secs_f64(-(1.0 - chance.random::<f64>()).ln() / rate)
}

impl Rest {
    /// When the last request was sent.
    pub(crate) fn end(&self) -> Instant {
        self.flood.end
    }

    /// Waits for the answers that are left, and counts them all.
    pub(crate) async fn collect(mut self) -> Flood {
        let end = Instant::now() + PATIENCE;
        while let Ok(Some((position, reply, latency))) = timeout_at(end, self.answers.recv()).await {
            self.flood.unanswered -= 1;
            self.flood.tallies[position].count(&self.kinds[position], &reply, latency);
        }
        for tally in &mut self.flood.tallies {
            tally.served.sort_by(f64::total_cmp);
        }
        self.flood
    }
}
