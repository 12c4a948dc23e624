//! The program `reentry`.

use std::process::ExitCode;

use clap::Parser;
use reentry_service::cli::{Cli, Failure};
use reentry_service::config::Config;
use reentry_service::serve::{serve, stop_signal};
use reentry_service::state::AppState;
use reentry_service::telemetry;
use tokio::net::TcpListener;

fn main() -> ExitCode {
    let result = Cli::parse().command.run(run);
    result.as_ref().err().map_or(ExitCode::SUCCESS, Failure::end)
}

#[tokio::main]
async fn run(config: Config) -> std::io::Result<()> {
    telemetry::start(config.log_format);
    let address = config.listen;
    let listener = TcpListener::bind(address)
        .await
        .map_err(|error| std::io::Error::new(error.kind(), format!("cannot listen on {address}: {error}")))?;
    let state = AppState::new(config)?;
    let stop = stop_signal()?;
    tracing::info!("listening on http://{}", listener.local_addr()?);
    serve(listener, state, stop).await
}
