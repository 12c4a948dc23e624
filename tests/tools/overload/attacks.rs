//! Floods of clients that want nothing but to be in the way, each of which once silenced the service; and what short requests of others take
//! beside them.

use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use reentry_tests::loopback::{Connection, Program, get, post, target_2};
use serde_json::{Value, json};
use tokio::task::JoinSet;
use tokio::time::{sleep, timeout};

use crate::Plan;
use crate::bars::Usual;
use crate::flood::Connections;
use crate::health::ask_for;
use crate::mix::{Kind, SHORT, Tally};

/// How many times its idle value the p99 of short requests may be beside an attack.
const GREATEST_SLOWDOWN: f64 = 10.0;
/// After which a client tries again that was refused or given up: what `Retry-After` asks for.
const PAUSE: Duration = Duration::from_secs(1);
/// How long a client that does not read keeps its connection.
const PATIENCE: Duration = Duration::from_secs(2);
/// The length of a batch's body at most.
const BATCH_BODY: usize = 8 << 20;

/// Who is in the way.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Attack {
    /// They send all but the last byte of the body of a batch.
    Uploads,
    /// They read nothing of the answer to a batch.
    Readers,
    /// They ask for flights that cost a thousand times as much as a short one.
    Costly,
}

/// All of them, each with its name and how many there are.
pub(crate) const ATTACKS: [(Attack, &str, usize); 3] = [
    (Attack::Uploads, "33 unfinished uploads", 33),
    (Attack::Readers, "16 batches unread", 16),
    (Attack::Costly, "66 costly flights", 66),
];

/// What was seen beside an attack.
#[derive(Debug)]
pub(crate) struct Beside {
    name: &'static str,
    short: Tally,
    is_ready: bool,
    /// The greatest resident, bytes.
    memory: u64,
    /// What the p99 may be, ms.
    bar: f64,
}

impl Attack {
    /// Attacks for a time, and asks short requests meanwhile.
    pub(crate) async fn run(
        self,
        (name, clients): (&'static str, usize),
        program: &Program,
        short: &Kind,
        usual: &Usual,
        time: Duration,
    ) -> io::Result<Beside> {
        program.forget_greatest_memory()?;
        let request = Arc::new(self.request());
        let mut attackers = JoinSet::new();
        for _ in 0..clients {
            let (address, request) = (program.address, Arc::clone(&request));
            attackers.spawn(async move {
                loop {
                    // However it ends, it begins again.
                    let _ = self.once(address, &request).await;
                    sleep(PAUSE).await;
                }
            });
        }
        // Until they are all there, and those that cost much are known as such: 66 times 50 ms, on two workers.
        sleep(time / 2).await;
        let connections = Connections::new(program.address);
        let short = ask_for(&connections, short, time).await;
        let is_ready = connections.request(&get("/health/ready")).await?.status == 200;
        let memory = program.memory("VmHWM")?;
        attackers.shutdown().await;
        Ok(Beside { name, short, is_ready, memory, bar: GREATEST_SLOWDOWN * usual.percentile(SHORT, 99) })
    }

    fn request(self) -> Vec<u8> {
        match self {
            Self::Uploads => {
                let head = "content-type: application/json\r\nhost: load";
                let mut text =
                    format!("POST /simulate/batch HTTP/1.1\r\n{head}\r\ncontent-length: {BATCH_BODY}\r\n\r\n");
                text.extend(std::iter::repeat_n(' ', BATCH_BODY - 1));
                text.into_bytes()
            }
            Self::Readers => {
                let mut case = target_2();
                case["output"] = json!({"count": 10_000});
                post("/simulate/batch", &json!(vec![case; 20]))
            }
            Self::Costly => post("/simulate", &costly()),
        }
    }

    async fn once(self, address: SocketAddr, request: &[u8]) -> io::Result<()> {
        match self {
            Self::Uploads => {
                // It ends with the answer to what was never finished.
                Connection::open(address).await?.ask(request).await.map(drop)
            }
            Self::Readers => {
                let connection = Connection::open(address).await?;
                connection.write(request).await?;
                sleep(PATIENCE).await;
                Ok(())
            }
            Self::Costly => {
                let mut connection = Connection::open(address).await?;
                timeout(10 * PATIENCE, connection.ask(request)).await?.map(drop)
            }
        }
    }
}

/// A light and large vehicle, whose motion in the air is as stiff as it may be, and all that may be asked for beyond the flight.
fn costly() -> Value {
    json!({
        "angle_unit": "deg",
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 1e-6, "reference_area": 1e6, "aerodynamics": {"type": "constant", "drag_coefficient": 1}},
        "initial_state": {"type": "planet_relative", "altitude": 4e5, "longitude": 0, "geocentric_latitude": 10,
            "speed": 7500, "flight_path_angle": -3, "heading": 60},
        "solver": {"formulation": "cartesian"},
        "output": {"trajectory": false},
        "sensitivities": true,
        "verify": true,
    })
}

impl Beside {
    /// The head of the table.
    pub(crate) fn print_head() {
        println!("\n| beside | short served | refused | p50 | p99 | longest | memory |\n|{}", " --- |".repeat(7));
    }

    /// Its line of the table.
    #[expect(clippy::cast_precision_loss, reason = "memory is far below 2^52 bytes")]
    pub(crate) fn print(&self) {
        let [p50, p99, longest] = [50, 99, 100].map(|percent| self.short.percentile(percent));
        println!(
            "| {} | {} | {} | {p50:.2} ms | {p99:.2} of {:.2} ms | {longest:.1} ms | {:.0} MB |",
            self.name,
            self.short.served.len(),
            self.short.refused,
            self.bar,
            self.memory as f64 / 1e6,
        );
    }

    /// The bars that are missed, in words; that of time where it is held.
    pub(crate) fn missed(&self, plan: &Plan) -> Vec<String> {
        let mut missed = self.short.wrong.clone();
        if self.short.refused > 0 || self.short.served.is_empty() {
            missed.push(format!("{} short requests were refused", self.short.refused));
        }
        if !self.is_ready {
            missed.push("not ready".to_owned());
        }
        let p99 = self.short.percentile(99);
        if plan.timed && p99 > self.bar {
            missed.push(format!("p99 of short, ms: {p99:.2}, above {:.2}", self.bar));
        }
        missed.iter().map(|miss| format!("beside {}: {miss}", self.name)).collect()
    }
}
