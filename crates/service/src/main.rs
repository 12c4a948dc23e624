//! The program `reentry`.

use std::io;
use std::net::SocketAddr;
use std::process::ExitCode;

use clap::Parser;
use reentry_service::cli::{Cli, Failure};
use reentry_service::config::Config;
use reentry_service::serve::{serve, stop_signal};
use reentry_service::state::AppState;
use reentry_service::telemetry::Log;
use tokio::net::TcpListener;

fn main() -> ExitCode {
    let result = Cli::parse().command.run(run);
    result.as_ref().err().map_or(ExitCode::SUCCESS, Failure::end)
}

fn run(config: Config) -> Result<(), Failure> {
    config.check().map_err(Failure::Setting)?;
    let log = Log::start(&config);
    Ok(listen(config, &log)?)
}

#[tokio::main]
async fn listen(config: Config, log: &Log) -> io::Result<()> {
    let listener = bind(config.listen).await?;
    let metrics = match config.metrics_listen {
        Some(address) => Some(bind(address).await?),
        None => None,
    };
    let state = AppState::new(config, log.lost_lines())?;
    let stop = stop_signal()?;
    tracing::info!("listening on http://{}", listener.local_addr()?);
    if let Some(metrics) = &metrics {
        tracing::info!("metrics on http://{}/metrics", metrics.local_addr()?);
    }
    serve(listener, metrics, state, stop).await;
    Ok(())
}

async fn bind(address: SocketAddr) -> io::Result<TcpListener> {
    let told = |error: io::Error| io::Error::new(error.kind(), format!("cannot listen on {address}: {error}"));
    TcpListener::bind(address).await.map_err(told)
}
