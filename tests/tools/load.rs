//! `make load`: the service under load, beside the same handler that computes inline, on the threads that talk to clients.
//!
//! Both run as programs of their own. The generator shares their processors, so it is one thread that parses next to nothing, and says
//! what part of a processor it took. The machines are noisy: the two take turns in short rounds, and every figure is the median of its
//! rounds. The bars are held against medians, ratios within a round; a miss ends with status 1.
//!
//! `load inline ADDRESS` is the program that computes inline.

use std::io::{self, Error};
use std::net::SocketAddr;
use std::process::{Command, ExitCode};
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use axum::Router;
use axum::extract::State;
use axum::http::header;
use axum::http::request::Parts;
use axum::response::{IntoResponse, Response};
use axum::routing;
use reentry_service::answer;
use reentry_service::config::Config;
use reentry_service::endpoints::health;
use reentry_service::error::ApiError;
use reentry_service::extract::Payload;
use reentry_service::format::Format;
use reentry_service::router::surrounded;
use reentry_service::state::AppState;
use reentry_service::telemetry::Log;
use reentry_tests::loopback::{Connection, Program, get, percentile, post, processor_time, target_2};
use serde_json::{Value, json};
use tokio::task::JoinSet;
use tokio::time::{Instant, sleep};

/// Connections that ask for flights, each again as soon as it is answered.
const CONNECTIONS: usize = 16;
/// How long one of the two is asked, before the other has its turn.
const TURN: Duration = Duration::from_secs(2);
/// Turns of each.
const ROUNDS: usize = 7;
/// How long both are asked before anything counts.
const WARM_UP: Duration = Duration::from_millis(500);
/// Between an answer of `/health/live` and the next question.
const HEALTH_PAUSE: Duration = Duration::from_millis(2);

/// What the pool keeps of the inline rate.
const LEAST_RATIO: f64 = 0.75;
/// What `/health/live` takes at p99 while the pool computes, ms.
const GREATEST_HEALTH_P99: f64 = 5.0;

fn main() -> ExitCode {
    let arguments: Vec<_> = std::env::args().skip(1).collect();
    let result = match &arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        [] => compare(),
        ["inline", address] => serve_inline(address).map(|()| true),
        _ => Err(Error::other("takes no arguments, or inline ADDRESS")),
    };
    match result {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            eprintln!("load: {error}");
            ExitCode::FAILURE
        }
    }
}

/// Prints the table; whether no bar is missed.
#[tokio::main(flavor = "current_thread")]
async fn compare() -> io::Result<bool> {
    let pool = Program::serve();
    let this = std::env::current_exe()?;
    let inline = Program::start(|address| {
        let mut command = Command::new(this);
        command.args(["inline", &address.to_string()]);
        command
    });
    let [pool, inline] = [pool.await?, inline.await?];

    println!(
        "| answer | computed | requests/s | of inline | p50 | p99 | longest | `/health/live` p99 | not 200 | generator |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    let mut held = true;
    for output in [json!({"trajectory": false}), json!({"count": 1000})] {
        let request = simulate_request(&output);
        for program in [&pool, &inline] {
            turn(program.address, &request, WARM_UP).await?;
        }
        let mut pooled = Vec::new();
        let mut inlined = Vec::new();
        for _ in 0..ROUNDS {
            pooled.push(turn(pool.address, &request, TURN).await?);
            inlined.push(turn(inline.address, &request, TURN).await?);
        }
        let ratio = median(pooled.iter().zip(&inlined).map(|(pooled, inlined)| pooled.rate() / inlined.rate()));
        let bytes = pooled[0].answers.bytes;
        let answer = format!("`{output}`, {bytes} bytes");
        println!("{}", line(&answer, "in the pool", ratio, &pooled));
        println!("{}", line(&answer, "inline", 1.0, &inlined));
        let health = median(pooled.iter().map(|turn| turn.health.percentile(99)));
        let refused = pooled.iter().chain(&inlined).any(|turn| turn.answers.not_ok + turn.health.not_ok > 0);
        held &= ratio >= LEAST_RATIO && health < GREATEST_HEALTH_P99 && !refused;
    }
    if !held {
        let bar = GREATEST_HEALTH_P99;
        eprintln!("missed: a ratio of {LEAST_RATIO}, /health/live under {bar} ms at p99, every answer 200");
    }
    Ok(held)
}

/// A line of the table.
fn line(answer: &str, computed: &str, ratio: f64, turns: &[Turn]) -> String {
    let of = |figure: &dyn Fn(&Turn) -> f64| median(turns.iter().map(figure));
    let not_ok: usize = turns.iter().map(|turn| turn.answers.not_ok).sum();
    format!(
        "| {answer} | {computed} | {:.0} | {ratio:.2} | {:.1} ms | {:.1} ms | {:.1} ms | {:.2} ms | {not_ok} | {:.0} % |",
        of(&Turn::rate),
        of(&|turn| turn.answers.percentile(50)),
        of(&|turn| turn.answers.percentile(99)),
        of(&|turn| turn.answers.percentile(100)),
        of(&|turn| turn.health.percentile(99)),
        of(&|turn| 100.0 * turn.busy.as_secs_f64() / turn.seconds),
    )
}

fn median(figures: impl Iterator<Item = f64>) -> f64 {
    let mut figures: Vec<_> = figures.collect();
    figures.sort_by(f64::total_cmp);
    figures[figures.len() / 2]
}

/// What came back from a program that was asked for a while.
struct Turn {
    seconds: f64,
    answers: Answers,
    health: Answers,
    /// Processor time that the generator took.
    busy: Duration,
}

impl Turn {
    /// Answers a second.
    #[expect(clippy::cast_precision_loss, reason = "answers are counted far below 2^52")]
    fn rate(&self) -> f64 {
        self.answers.latencies.len() as f64 / self.seconds
    }
}

/// Asks a program for a while on all connections, and for its health on one more.
async fn turn(address: SocketAddr, request: &[u8], duration: Duration) -> io::Result<Turn> {
    let busy = processor_time()?;
    let start = Instant::now();
    let end = start + duration;
    let mut clients = JoinSet::new();
    for _ in 0..CONNECTIONS {
        clients.spawn(client(address, request.to_vec(), Duration::ZERO, end));
    }
    let health = tokio::spawn(client(address, get("/health/live"), HEALTH_PAUSE, end));
    let answers =
        clients.join_all().await.into_iter().try_fold(Answers::default(), |all, one| one.map(|one| all.and(one)));
    let seconds = start.elapsed().as_secs_f64();
    let health = health.await??.sorted();
    Ok(Turn { seconds, answers: answers?.sorted(), health, busy: processor_time()?.saturating_sub(busy) })
}

/// Answers to one kind of request.
#[derive(Default)]
struct Answers {
    /// ms.
    latencies: Vec<f64>,
    /// Statuses other than 200.
    not_ok: usize,
    /// Of the body, the last time.
    bytes: usize,
}

impl Answers {
    fn and(mut self, other: Self) -> Self {
        self.latencies.extend(other.latencies);
        Self { latencies: self.latencies, not_ok: self.not_ok + other.not_ok, bytes: other.bytes }
    }

    fn sorted(mut self) -> Self {
        self.latencies.sort_by(f64::total_cmp);
        self
    }

    /// The latency, ms, that so many of a hundred answers do not exceed.
    fn percentile(&self, percent: usize) -> f64 {
        percentile(&self.latencies, percent)
    }
}

/// Sends a request again and again on one connection.
async fn client(address: SocketAddr, request: Vec<u8>, pause: Duration, end: Instant) -> io::Result<Answers> {
    let mut connection = Connection::open(address).await?;
    let mut answers = Answers::default();
    while Instant::now() < end {
        let start = Instant::now();
        let reply = connection.ask(&request).await?;
        answers.latencies.push(start.elapsed().as_secs_f64() * 1e3);
        answers.not_ok += usize::from(reply.status != 200);
        answers.bytes = reply.bytes;
        if !pause.is_zero() {
            sleep(pause).await;
        }
    }
    Ok(answers)
}

/// `POST /simulate` of TARGET case 2.
fn simulate_request(output: &Value) -> Vec<u8> {
    let mut case = target_2();
    case["output"] = output.clone();
    post("/simulate", &case)
}

/// `/simulate` and `/health/live` of the service, with all that surrounds them, but for the pool.
#[tokio::main]
async fn serve_inline(address: &str) -> io::Result<()> {
    let config = Config::default();
    let log = Log::start(&config);
    let routes = Router::new()
        .route("/simulate", routing::post(simulate_inline))
        .route("/health/live", routing::get(health::live));
    let listener = tokio::net::TcpListener::bind(address).await?;
    axum::serve(listener, surrounded(routes, AppState::new(config, log.lost_lines())?)).await
}

/// The handler of `/simulate`, but for the pool.
async fn simulate_inline(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &[Format::Json, Format::Csv])?;
    let interrupt = AtomicBool::new(false);
    let body = answer::simulate(body.json(&interrupt)?, format, app.config.row_limit, &interrupt)?.body;
    Ok(([(header::CONTENT_TYPE, format.media_type())], body).into_response())
}
