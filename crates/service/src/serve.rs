//! Runs the service until it is told to stop.

use std::future::Future;

use reentry::atmosphere::us76;
use tokio::net::TcpListener;
use tokio::sync::oneshot;

use crate::router::app;
use crate::state::AppState;

/// Answers requests until `shutdown`; then refuses new ones, finishes those that run, within the grace of the settings, and returns.
///
/// # Errors
/// When the listener fails.
pub async fn serve(
    listener: TcpListener,
    state: AppState,
    shutdown: impl Future<Output = ()> + Send + 'static,
) -> std::io::Result<()> {
    // Its table is made with the first density, which no request is to wait for.
    us76::density(0.0);
    let grace = state.config.grace;
    let (draining, drained) = oneshot::channel();
    let drain = {
        let state = state.clone();
        async move {
            shutdown.await;
            tracing::info!("going down: finishing what runs");
            state.drain();
            // Nobody listens any more if the service has failed meanwhile.
            let _ = draining.send(());
        }
    };
    let service = axum::serve(listener, app(state)).with_graceful_shutdown(drain);
    tokio::select! {
        result = service => result,
        () = async {
            // A sender that is dropped unsent ends the service by the other branch.
            if drained.await.is_ok() { tokio::time::sleep(grace).await } else { std::future::pending().await }
        } => {
            tracing::warn!("requests were still running at the end of the grace");
            Ok(())
        }
    }
}

/// Waits for SIGTERM or SIGINT.
///
/// # Errors
/// When the system lets no handler be set.
pub fn stop_signal() -> std::io::Result<impl Future<Output = ()> + Send + 'static> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    Ok(async move {
        tokio::select! {
            _ = terminate.recv() => {}
            _ = interrupt.recv() => {}
        }
    })
}
