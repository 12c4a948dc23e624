//! `make load`, its second half: the service under more than it can serve.
//!
//! Traffic of all kinds comes at 1, 2, 5 and 20 times what the machine serves, by a clock that waits for no answer; a
//! latency begins with the instant that the clock had for its request, so that none is left out that came late for
//! others. The bars are: no error but 503 and 429; whoever is served waits for the queue and no longer; `/health/live`
//! answers all the while; the memory is that of the workers, not of the flood; and a second after it all is as before.
//! A miss ends with status 1.
//!
//! Then come clients that want nothing but to be in the way, and beside them short requests of others, none of which is to be refused.
//!
//! The generator shares the processors of the service, so it is one thread that parses next to nothing, and says what
//! part of a processor it took and how late it was. `overload brief` has short floods and holds no bar of time: for
//! tests.

use std::io::{self, Error};
use std::net::SocketAddr;
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use rand::SeedableRng;
use rand::rngs::Xoshiro256PlusPlus;
use reentry_tests::loopback::Program;
use tokio::task::JoinSet;
use tokio::time::Instant;

use attacks::{ATTACKS, Beside};
use bars::{Row, Times, Usual};
use flood::{Connections, flood};
use health::{Health, recover};
use mix::{Kind, SHORT, Tally, draw, kinds};

mod attacks;
mod bars;
mod flood;
mod health;
mod mix;

/// Connections that ask in turn while the capacity is measured: they keep the workers busy, and were all batches, none
/// would be refused.
const CLOSED_LOOP: usize = 16;
/// What others may take of a processor with no word about it.
const MOST_OTHERS: f64 = 0.1;
/// Any will do; the same gives the same traffic.
const SEED: u64 = 2006;

/// How long things are measured, and what is held.
struct Plan {
    /// What the floods are, in capacities.
    factors: &'static [f64],
    /// How long a flood is.
    flood: Duration,
    /// How long the capacity is measured, and before that the service warmed up.
    capacity: Duration,
    /// How long each kind is asked alone.
    unloaded: Duration,
    /// What a connection may hold, bytes: the buffers of its two directions and what is known of its request.
    connection: usize,
    /// How often the largest answer may be held for each worker: as rows, as a text that grows, which is twice where it is moved, and as
    /// those that were computed before, while their clients read them.
    answer_copies: usize,
    /// Whether the bars of time are held.
    timed: bool,
}

/// About a minute.
const FULL: Plan = Plan {
    factors: &[1.0, 2.0, 5.0, 20.0],
    flood: Duration::from_secs(5),
    capacity: Duration::from_secs(4),
    unloaded: Duration::from_secs(1),
    connection: 64 << 10,
    answer_copies: 8,
    timed: true,
};

/// Some ten seconds. On a busy machine connections are many and read late, and a test is to know growth without bound alone.
const BRIEF: Plan = Plan {
    factors: &[1.0, 5.0],
    flood: Duration::from_secs(1),
    capacity: Duration::from_secs(1),
    unloaded: Duration::from_millis(200),
    connection: 64 << 10,
    answer_copies: 16,
    timed: false,
};

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let result = match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => run(&FULL),
        ["brief"] => run(&BRIEF),
        _ => Err(Error::other("takes no arguments, or brief")),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("overload: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Measures and prints; whether no bar is missed.
#[tokio::main(flavor = "current_thread")]
async fn run(plan: &Plan) -> io::Result<bool> {
    let kinds = Arc::new(kinds());
    let program = Program::serve().await?;
    let mut chance = Xoshiro256PlusPlus::seed_from_u64(SEED);
    closed_loop(program.address, &kinds, plan.capacity / 2, &mut chance).await?;
    let capacity = closed_loop(program.address, &kinds, plan.capacity, &mut chance).await?;
    let usual = Usual::measure(&program, &kinds, capacity, plan.unloaded, &mut chance).await?;
    usual.print(&kinds);
    let connections = Arc::new(Connections::new(program.address));
    let (mut missed, mut others) = (Vec::new(), 0.0_f64);
    Row::print_head(&kinds);
    for factor in plan.factors {
        let row = overload(&program, &connections, &kinds, (*factor, plan.flood), &usual, &mut chance).await?;
        row.print(&usual, plan);
        missed.extend(row.missed(&usual, &kinds, plan));
        others = others.max(row.times.others());
    }
    drop(connections);
    Beside::print_head();
    for (attack, name, clients) in ATTACKS {
        let beside = attack.run((name, clients), &program, &kinds[SHORT], &usual, plan.flood).await?;
        beside.print();
        missed.extend(beside.missed(plan));
    }
    for miss in &missed {
        eprintln!("missed {miss}");
    }
    if others > MOST_OTHERS {
        let percent = 100.0 * others;
        eprintln!(
            "the bars of time are for a machine that does nothing else; others took {percent:.0} % of a processor"
        );
    }
    Ok(missed.is_empty())
}

/// A flood of so many capacities for a time, with what is seen beside it and after it.
async fn overload(
    program: &Program,
    connections: &Arc<Connections>,
    kinds: &Arc<Vec<Kind>>,
    (factor, time): (f64, Duration),
    usual: &Usual,
    chance: &mut Xoshiro256PlusPlus,
) -> io::Result<Row> {
    program.forget_greatest_memory()?;
    let watch = Health::watch(program.address);
    let (clock, start) = (Times::now(program)?, Instant::now());
    let rest = flood(connections, kinds, factor * usual.capacity, time, chance).await;
    let times = Times::now(program)?.since(&clock, start.elapsed());
    let health = watch.stop().await?;
    let recovery = recover(program.address, &kinds[SHORT], usual.calm(), rest.end()).await?;
    let flood = rest.collect().await;
    let (memory, kept) = (program.memory("VmHWM")?, program.memory("VmRSS")?);
    Ok(Row { factor, flood, health, recovery, memory, kept, times })
}

/// Asks all kinds in their shares on some connections, each again as soon as it is answered; how many are served a
/// second.
#[expect(clippy::cast_precision_loss, reason = "requests are counted far below 2^52")]
async fn closed_loop(
    address: SocketAddr,
    kinds: &Arc<Vec<Kind>>,
    time: Duration,
    chance: &mut Xoshiro256PlusPlus,
) -> io::Result<f64> {
    let start = Instant::now();
    let connections = Arc::new(Connections::new(address));
    let mut clients = JoinSet::new();
    for _ in 0..CLOSED_LOOP {
        let (kinds, connections) = (Arc::clone(kinds), Arc::clone(&connections));
        let mut chance = Xoshiro256PlusPlus::from_rng(chance);
        clients.spawn(async move {
            let mut tallies: Vec<_> = kinds.iter().map(|_| Tally::default()).collect();
            while start.elapsed() < time {
                let position = draw(&kinds, &mut chance);
                let reply = connections.request(&kinds[position].request).await;
                tallies[position].count(&kinds[position], &reply, start.elapsed());
            }
            tallies
        });
    }
    let tallies: Vec<_> = clients.join_all().await.into_iter().flatten().collect();
    if let Some(wrong) = tallies.iter().flat_map(|tally| &tally.wrong).next() {
        return Err(Error::other(format!("without a flood, {wrong}")));
    }
    Ok(tallies.iter().map(|tally| tally.served.len()).sum::<usize>() as f64 / start.elapsed().as_secs_f64())
}
