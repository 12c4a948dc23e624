//! The mixed traffic: what is asked, in which shares, and when an answer is as it should be.

use std::io;
use std::time::Duration;

use rand::RngExt;
use rand::rngs::Xoshiro256PlusPlus;
use reentry_tests::loopback::{Reply, percentile, post, target_2};
use serde_json::{Value, json};

/// Cases of a batch: enough for the turns of one batch to pass between those of others.
pub(crate) const CASES: usize = 20;
/// Rows of the largest answers, some 4 MB.
const ROWS: usize = 10_000;
/// Seconds that the long flight takes through its orbit: some 20 000 steps, 20 to 50 ms on most machines.
const ORBIT_TIME: f64 = 1e6;

/// A kind of request.
#[derive(Debug)]
pub(crate) struct Kind {
    /// In a word.
    pub(crate) name: &'static str,
    /// Of a hundred requests.
    share: usize,
    /// As it is sent.
    pub(crate) request: Vec<u8>,
    /// The status of an answer, unless it is refused.
    status: u16,
    /// Lines of the answer, where it is a batch.
    lines: Option<usize>,
}

/// Where the short flight is among the kinds.
pub(crate) const SHORT: usize = 0;

/// All kinds. Most requests are short, as they are in use; the long ones and the rows together take nine tenths of the
/// computing, so that what can be served is hundreds a second, not ten thousands, and twenty times of it can be sent
/// from one thread. Of the rarest there are still a hundred in five seconds.
pub(crate) fn kinds() -> Vec<Kind> {
    let flight = |output: Value| {
        let mut case = target_2();
        case["output"] = output;
        case
    };
    let short = flight(json!({"trajectory": false}));
    let mut invalid = short.clone();
    invalid["vehicle"]["mass"] = json!(-1);
    let state = json!({"angle_unit": "rad", "planet": short["planet"], "state": short["initial_state"]});
    let batch = json!(vec![&short; CASES]);
    let kind =
        |name, share, path, body: &Value| Kind { name, share, request: post(path, body), status: 200, lines: None };
    vec![
        kind("short", 50, "/simulate", &short),
        kind("long", 10, "/simulate", &orbit()),
        kind("rows", 10, "/simulate", &flight(json!({"count": ROWS}))),
        Kind { lines: Some(CASES), ..kind("batch", 5, "/simulate/batch", &batch) },
        Kind { status: 422, ..kind("invalid", 10, "/simulate", &invalid) },
        kind("convert", 15, "/convert", &state),
    ]
}

/// A flight that computes for long and says little: an orbit, integrated as finely as the service allows.
fn orbit() -> Value {
    json!({
        "angle_unit": "deg",
        "vehicle": {"mass": 1000, "reference_area": 1, "aerodynamics": {"type": "constant", "drag_coefficient": 0}},
        "initial_state": {"type": "planet_relative", "altitude": 4e5, "longitude": 0, "geocentric_latitude": 10,
            "speed": 7600, "flight_path_angle": 0, "heading": 60},
        "stop": {"time": ORBIT_TIME},
        "solver": {"formulation": "spherical", "relative_tolerance": 1e-14},
        "output": {"trajectory": false},
    })
}

/// The position of a kind, drawn by the shares.
pub(crate) fn draw(kinds: &[Kind], chance: &mut Xoshiro256PlusPlus) -> usize {
    let mut left = chance.random_range(0..kinds.iter().map(|kind| kind.share).sum());
    let taken = kinds.iter().position(|kind| {
        let here = left < kind.share;
        left = left.saturating_sub(kind.share);
        here
    });
    taken.unwrap_or(SHORT)
}

/// How a request ended.
enum End {
    /// With the answer to it.
    Served,
    /// With 503 or 429.
    Refused,
    /// With anything else.
    Wrong(String),
}

impl Kind {
    /// What to make of an answer, or of none.
    fn judge(&self, reply: &io::Result<Reply>) -> End {
        let reply = match reply {
            Ok(reply) => reply,
            Err(error) => return End::Wrong(format!("broken off: {error}")),
        };
        match reply.status {
            503 | 429 => End::Refused,
            status if status != self.status => End::Wrong(format!("status {status}")),
            _ => self.lines.map_or(End::Served, |lines| judge_lines(&reply.text, lines)),
        }
    }
}

/// What to make of the answer to a batch: every line is to be there, and none a problem.
fn judge_lines(text: &[u8], lines: usize) -> End {
    let mut there = text.split_inclusive(|byte| *byte == b'\n').filter(|line| line.ends_with(b"\n"));
    let found = there.clone().count();
    match there.find(|line| line.starts_with(b"{\"type\":\"/problems/")) {
        Some(line) => End::Wrong(format!("a line is {}", String::from_utf8_lossy(line))),
        None if found != lines => End::Wrong(format!("{found} of {lines} lines")),
        None => End::Served,
    }
}

/// How many requests of a kind ended in which way.
#[derive(Debug, Default)]
pub(crate) struct Tally {
    /// The latencies of those that were served, ms, from the instant that the clock had for them; in order.
    pub(crate) served: Vec<f64>,
    /// Answers of 503 and 429.
    pub(crate) refused: usize,
    /// What else came, in words.
    pub(crate) wrong: Vec<String>,
    /// The length of the longest body.
    pub(crate) largest: usize,
}

impl Tally {
    /// Counts an answer, or none.
    pub(crate) fn count(&mut self, kind: &Kind, reply: &io::Result<Reply>, latency: Duration) {
        match kind.judge(reply) {
            End::Served => self.served.push(latency.as_secs_f64() * 1e3),
            End::Refused => self.refused += 1,
            End::Wrong(what) => self.wrong.push(format!("{}: {what}", kind.name)),
        }
        self.largest = self.largest.max(reply.as_ref().map_or(0, |reply| reply.bytes));
    }

    /// The latency, ms, that so many of a hundred served requests do not exceed.
    pub(crate) fn percentile(&self, percent: usize) -> f64 {
        percentile(&self.served, percent)
    }
}
