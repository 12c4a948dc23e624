//! The program `reentry`.

use std::io::Write;
use std::process::ExitCode;

use clap::{Parser, Subcommand};
use reentry_service::config::Config;
use reentry_service::serve::{serve, stop_signal};
use reentry_service::state::AppState;
use reentry_service::{document, telemetry};
use tokio::net::TcpListener;

/// Flies vehicles back through the atmosphere.
#[derive(Parser)]
#[command(version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Run the web service until SIGTERM or SIGINT; every flag can be set by its environment variable as well
    Serve(Config),
    /// Print the OpenAPI document
    Openapi,
}

fn main() -> ExitCode {
    let result = match Cli::parse().command {
        Command::Serve(config) => run(config),
        Command::Openapi => writeln!(std::io::stdout(), "{:#}", document()),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("reentry: {error}");
            ExitCode::FAILURE
        }
    }
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
