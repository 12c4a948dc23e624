//! The program `reentry`.

use std::io;
use std::net::SocketAddr;
use std::process::ExitCode;

use reentry_service::allocator::tune;
use reentry_service::cli::{Cli, Failure};
use reentry_service::config::Config;
use reentry_service::serve::{serve, stop_signal};
use reentry_service::state::AppState;
use reentry_service::telemetry::Log;
use tokio::net::{TcpListener, TcpSocket};

fn main() -> ExitCode {
    let result = Cli::read().run(run);
    result.as_ref().err().map_or(ExitCode::SUCCESS, Failure::end)
}

fn run(config: Config) -> Result<(), Failure> {
    config.check().map_err(Failure::Setting)?;
    tune();
    let log = Log::start(&config);
    Ok(listen(config, &log)?)
}

#[tokio::main]
async fn listen(config: Config, log: &Log) -> io::Result<()> {
    let listener = bind(config.listen)?;
    let metrics = config.metrics_listen.map(bind).transpose()?;
    let state = AppState::new(config, log.lost_lines())?;
    let stop = stop_signal()?;
    tracing::info!("listening on http://{}", listener.local_addr()?);
    if let Some(metrics) = &metrics {
        tracing::info!("metrics on http://{}/metrics", metrics.local_addr()?);
    }
    serve(listener, metrics, state, stop).await;
    Ok(())
}

/// Connections that the system may establish before they are accepted; Linux may allow fewer. With the usual 128, clients that come all at
/// once are left to try again after a second.
const BACKLOG: u32 = 4096;

fn bind(address: SocketAddr) -> io::Result<TcpListener> {
    let socket = if address.is_ipv4() { TcpSocket::new_v4() } else { TcpSocket::new_v6() };
    let listener = socket.and_then(|socket| {
        // A service that starts again has its address at once.
        socket.set_reuseaddr(true)?;
        socket.bind(address)?;
        socket.listen(BACKLOG)
    });
    listener.map_err(|error| io::Error::new(error.kind(), format!("cannot listen on {address}: {error}")))
}
