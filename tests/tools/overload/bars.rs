//! What is held of the service under a flood, and the table that shows it.

use std::io::{self, Error};
use std::time::Duration;

use rand::rngs::Xoshiro256PlusPlus;
use reentry_service::config::Config;
use reentry_tests::loopback::{Program, machine_time, percentile, processor_time};

use crate::Plan;
use crate::flood::{Connections, Flood};
use crate::health::{Health, Recovery, ask_for};
use crate::mix::{Kind, SHORT, Tally, draw};

/// How many times its unloaded value the p99 may be, beside what the queue is worth.
const GREATEST_SLOWDOWN: f64 = 3.0;
/// What `/health/live` may take at p99, ms.
const GREATEST_HEALTH_P99: f64 = 20.0;
/// What the recovery may take, s.
const LONGEST_RECOVERY: f64 = 1.0;
/// How many times its unloaded value the median of short requests may be when all is as before.
const CALM: f64 = 2.0;
/// Queues that are drawn to see what the worst of a hundred is worth.
const QUEUES: usize = 10_000;
/// Wrong answers that are printed of a flood.
const PRINTED: usize = 5;

/// How the service is without a flood.
#[derive(Debug)]
pub(crate) struct Usual {
    /// Requests that it serves a second.
    pub(crate) capacity: f64,
    /// For each kind, one at a time.
    tallies: Vec<Tally>,
    health: Health,
    /// Resident, bytes.
    memory: u64,
    workers: usize,
    /// What the queue is worth on average, ms: as many requests wait as may, and the workers serve the mix at their share
    /// of the capacity, beside the threads that batches have.
    queue: f64,
    /// What the worst of a hundred queues is worth, ms.
    worst_queue: f64,
}

impl Usual {
    /// Asks each kind for a time.
    #[expect(clippy::cast_precision_loss, reason = "a queue is far below 2^52")]
    pub(crate) async fn measure(
        program: &Program,
        kinds: &[Kind],
        capacity: f64,
        time: Duration,
        chance: &mut Xoshiro256PlusPlus,
    ) -> io::Result<Self> {
        let watch = Health::watch(program.address);
        let connections = Connections::new(program.address);
        let mut tallies = Vec::new();
        for kind in kinds {
            let tally = ask_for(&connections, kind, time).await;
            if let Some(wrong) = tally.wrong.first() {
                return Err(Error::other(format!("without a flood, {wrong}")));
            }
            tallies.push(tally);
        }
        let config = Config::default();
        let workers = config.workers();
        let with_batches = workers + workers.saturating_sub(1).max(1);
        let queue = 1e3 * config.queue as f64 / capacity * with_batches as f64 / workers as f64;
        let worst_queue = queue * spread(&tallies, kinds, config.queue, chance);
        let health = watch.stop().await?;
        let memory = program.memory("VmRSS")?;
        Ok(Self { capacity, tallies, health, memory, workers, queue, worst_queue })
    }

    /// The latency of a kind alone, ms, that so many of a hundred do not exceed.
    pub(crate) fn percentile(&self, position: usize, percent: usize) -> f64 {
        self.tallies[position].percentile(percent)
    }

    /// What the median of short requests may be when all is as before, ms.
    pub(crate) fn calm(&self) -> f64 {
        CALM * self.tallies[SHORT].percentile(50)
    }

    /// What the p99 of a kind may be, ms.
    ///
    /// Who is accepted waits for those in the queue, and the worst of a hundred waits for the worst of a hundred
    /// queues. A batch waits for other batches, and is given no more for that.
    fn latency_bar(&self, position: usize) -> f64 {
        GREATEST_SLOWDOWN * self.tallies[position].percentile(99) + self.worst_queue
    }

    /// What may be resident, bytes.
    fn memory_bar(&self, connections: usize, plan: &Plan) -> u64 {
        let largest = self.tallies.iter().map(|tally| tally.largest).max().unwrap_or(0);
        self.memory + (plan.answer_copies * self.workers * largest + plan.connection * connections) as u64
    }

    /// Prints it.
    pub(crate) fn print(&self, kinds: &[Kind]) {
        let Self { capacity, queue, worst_queue, .. } = self;
        println!(
            "{capacity:.0} requests/s are served; a queue is worth {queue:.0} ms, the worst of 100 {worst_queue:.0} ms."
        );
        println!("One at a time, beside {} resident:\n", megabytes(self.memory));
        println!("| request | asked | p50 | p99 | bytes |\n| --- | --- | --- | --- | --- |");
        for (kind, tally) in kinds.iter().zip(&self.tallies) {
            let (p50, p99) = (tally.percentile(50), tally.percentile(99));
            println!("| {} | {} | {p50:.2} ms | {p99:.2} ms | {} |", kind.name, tally.served.len(), tally.largest);
        }
        let [p50, p99] = [50, 99].map(|percent| self.health.percentile(percent));
        println!("| `/health/live` | every 2 ms | {p50:.2} ms | {p99:.2} ms | |\n");
    }
}

/// How much longer than the average the worst of a hundred queues takes, if each request takes what it takes alone.
#[expect(clippy::cast_precision_loss, reason = "queues are far below 2^52")]
fn spread(tallies: &[Tally], kinds: &[Kind], length: usize, chance: &mut Xoshiro256PlusPlus) -> f64 {
    let mut queue = || -> f64 { (0..length).map(|_| tallies[draw(kinds, chance)].percentile(50)).sum() };
    let mut queues: Vec<_> = (0..QUEUES).map(|_| queue()).collect();
    queues.sort_by(f64::total_cmp);
    percentile(&queues, 99) * QUEUES as f64 / queues.iter().sum::<f64>()
}

/// Processor times, s.
#[derive(Debug)]
pub(crate) struct Times {
    /// Of the generator.
    generator: f64,
    /// Of the service.
    program: f64,
    /// Of all there is, these two included.
    machine: f64,
}

impl Times {
    /// Those until now.
    pub(crate) fn now(program: &Program) -> io::Result<Self> {
        let [generator, program, machine] = [processor_time()?, program.processor_time()?, machine_time()?];
        Ok(Self { generator: generator.as_secs_f64(), program: program.as_secs_f64(), machine: machine.as_secs_f64() })
    }

    /// Those since then, of one processor.
    pub(crate) fn since(&self, then: &Self, elapsed: Duration) -> Self {
        let share = |now: f64, then: f64| (now - then) / elapsed.as_secs_f64();
        Self {
            generator: share(self.generator, then.generator),
            program: share(self.program, then.program),
            machine: share(self.machine, then.machine),
        }
    }

    /// What neither the service nor the generator took.
    pub(crate) fn others(&self) -> f64 {
        (self.machine - self.program - self.generator).max(0.0)
    }
}

/// A flood, and what was seen beside it.
#[derive(Debug)]
pub(crate) struct Row {
    /// In capacities.
    pub(crate) factor: f64,
    pub(crate) flood: Flood,
    pub(crate) health: Health,
    pub(crate) recovery: Recovery,
    /// The greatest resident, bytes.
    pub(crate) memory: u64,
    /// Resident after the recovery, bytes.
    pub(crate) kept: u64,
    /// While it lasted.
    pub(crate) times: Times,
}

impl Row {
    /// The head of the table.
    pub(crate) fn print_head(kinds: &[Kind]) {
        let latencies = kinds.iter().map(|kind| format!("p99 {}", kind.name));
        let first = ["load", "asked for", "sent", "not sent", "served", "refused", "wrong"].map(str::to_owned);
        let last = [
            "`/health/live` p99",
            "longest",
            "memory",
            "kept",
            "recovery",
            "generator",
            "late p99",
            "service",
            "others",
        ];
        let columns: Vec<_> = first.into_iter().chain(latencies).chain(last.map(str::to_owned)).collect();
        println!("| {} |\n|{}", columns.join(" | "), " --- |".repeat(columns.len()));
    }

    /// Its line of the table; where there is a bar, beside it.
    pub(crate) fn print(&self, usual: &Usual, plan: &Plan) {
        let Flood { tallies, not_sent, rate, connections, .. } = &self.flood;
        let of = |count: &dyn Fn(&Tally) -> usize| tallies.iter().map(count).sum::<usize>();
        let served = of(&|tally| tally.served.len());
        let refused = of(&|tally| tally.refused);
        let latencies = tallies
            .iter()
            .enumerate()
            .map(|(position, tally)| format!("{:.0} of {:.0} ms", tally.percentile(99), usual.latency_bar(position)));
        let latencies = latencies.collect::<Vec<_>>().join(" | ");
        let [p99, longest] = [99, 100].map(|percent| self.health.percentile(percent));
        let memory = format!("{} of {}", megabytes(self.memory), megabytes(usual.memory_bar(*connections, plan)));
        println!(
            "| {}× | {:.0}/s | {rate:.0}/s | {not_sent} | {served} | {refused} | {} | {latencies} | {p99:.1} ms | \
             {longest:.1} ms | {memory} | {} | {:.2}, {:.2} s | {:.0} % | {:.1} ms | {:.0} % | {:.0} % |",
            self.factor,
            self.factor * usual.capacity,
            self.wrong(),
            megabytes(self.kept),
            self.recovery.served,
            self.recovery.calm,
            100.0 * self.times.generator,
            percentile(&self.flood.late, 99),
            100.0 * self.times.program,
            100.0 * self.times.others(),
        );
    }

    /// Requests that had neither their answer nor a refusal.
    fn wrong(&self) -> usize {
        self.flood.tallies.iter().map(|tally| tally.wrong.len()).sum::<usize>() + self.flood.unanswered
    }

    /// The bars that are missed, in words; those of time where they are held.
    pub(crate) fn missed(&self, usual: &Usual, kinds: &[Kind], plan: &Plan) -> Vec<String> {
        let mut missed = self.errors();
        let bar = usual.memory_bar(self.flood.connections, plan);
        if self.memory > bar {
            missed.push(format!("{} were resident, above {}", megabytes(self.memory), megabytes(bar)));
        }
        if self.recovery.calm.is_infinite() {
            missed.push("no recovery".to_owned());
        }
        if plan.timed {
            missed.extend(self.late(usual, kinds));
        }
        missed.iter().map(|miss| format!("at {}×: {miss}", self.factor)).collect()
    }

    /// The first of the wrong answers, and how many there were.
    fn errors(&self) -> Vec<String> {
        let wrong = self.flood.tallies.iter().flat_map(|tally| &tally.wrong);
        let mut errors: Vec<_> = wrong.take(PRINTED).cloned().collect();
        if self.wrong() > 0 {
            errors.push(format!("{} wrong answers, {} requests without any", self.wrong(), self.flood.unanswered));
        }
        errors
    }

    /// The bars of time that are missed.
    fn late(&self, usual: &Usual, kinds: &[Kind]) -> Vec<String> {
        let mut held = Vec::new();
        for (position, kind) in kinds.iter().enumerate() {
            let p99 = self.flood.tallies[position].percentile(99);
            held.push((format!("p99 of {}, ms", kind.name), p99, usual.latency_bar(position)));
        }
        held.push(("p99 of /health/live, ms".to_owned(), self.health.percentile(99), GREATEST_HEALTH_P99));
        held.push(("recovery, s".to_owned(), self.recovery.calm, LONGEST_RECOVERY));
        // Also where nothing was served: then the figure is not a number.
        held.retain(|(_, figure, bar)| figure.is_nan() || figure > bar);
        held.iter().map(|(name, figure, bar)| format!("{name}: {figure:.1}, above {bar:.1}")).collect()
    }
}

#[expect(clippy::cast_precision_loss, reason = "memory is far below 2^52 bytes")]
fn megabytes(bytes: u64) -> String {
    format!("{:.0} MB", bytes as f64 / 1e6)
}
