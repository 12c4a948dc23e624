//! Runs the service until it is told to stop.

use std::future::Future;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;

use axum::Router;
use axum::body::Body;
use axum::http::Request;
use futures_util::FutureExt;
use hyper::body::Incoming;
use hyper::server::conn::http1;
use hyper::service::service_fn;
use hyper_util::rt::{TokioIo, TokioTimer};
use reentry::atmosphere::us76;
use tokio::net::{TcpListener, TcpStream};
use tokio::sync::{OwnedSemaphorePermit, Semaphore, watch};
use tokio::time::{interval, sleep, timeout};
use tower::ServiceExt;

use crate::client::Peer;
use crate::connection::WriteTimeoutStream;
use crate::middleware::refuse_head;
use crate::rate::FORGETTING;
use crate::router::{app, metrics_app};
use crate::state::AppState;

/// Bytes of the head of a request, and of what is read of a body or written of an answer at once.
const BUFFER: usize = 16 << 10;

/// How long connections without a request go on after the signal to stop: a request that is on its way is still answered.
const LINGER: Duration = Duration::from_millis(500);

/// Between two attempts to accept a connection for which the system has no room.
const PAUSE: Duration = Duration::from_millis(100);

/// Answers requests until `shutdown`; then refuses new connections, finishes what runs, within the grace of the settings, and returns.
/// `metrics` is the listener of `GET /metrics`, where it has its own.
pub async fn serve(
    listener: TcpListener,
    metrics: Option<TcpListener>,
    state: AppState,
    shutdown: impl Future<Output = ()>,
) {
    // Its table is made with the first density, which no request is to wait for.
    us76::density(0.0);
    let forgetting = tokio::spawn(forget(state.clone()));
    // The metrics are told to the end, and keep nobody from it.
    let telling = metrics.map(|listener| {
        let acceptor = Acceptor::new(metrics_app(state.clone()), state.clone(), METRICS_CONNECTIONS);
        tokio::spawn(async move { acceptor.accept(&listener, std::future::pending()).await })
    });
    let grace = state.config.grace;
    let acceptor = Acceptor::new(app(state.clone()), state.clone(), connections(state.config.connections));
    acceptor.accept(&listener, shutdown).await;
    tracing::info!("shutting down: finishing requests in progress");
    state.drain();
    acceptor.accept_those_who_wait(&listener);
    drop(listener);
    if timeout(grace, acceptor.close()).await.is_err() {
        tracing::warn!("requests were still running at the end of the grace period");
    }
    forgetting.abort();
    if let Some(telling) = telling {
        telling.abort();
    }
}

/// Connections that may ask for the metrics at once, where they have an address of their own.
const METRICS_CONNECTIONS: usize = 64;

/// How many connections may be open: as many as the settings say, if the system allows so many files.
fn connections(wanted: usize) -> usize {
    // Linux gives programs few files at first, and more where they ask.
    let files = rlimit::increase_nofile_limit(u64::MAX)
        .map_or(usize::MAX, |files| usize::try_from(files).unwrap_or(usize::MAX));
    let possible = files.saturating_sub(OTHER_FILES).max(1);
    if possible < wanted {
        tracing::warn!("the system allows {files} open files: the limit is {possible} connections, not {wanted}");
    }
    wanted.min(possible)
}

/// Files that are open beside the connections.
const OTHER_FILES: usize = 64;

/// Forgets clients that the rate limit has no need to remember, again and again.
async fn forget(state: AppState) {
    let Some(limit) = &state.rate_limit else { return };
    let mut tick = interval(FORGETTING);
    loop {
        tick.tick().await;
        limit.forget();
    }
}

/// Accepts connections, and serves each in a task of its own.
struct Acceptor {
    router: Router,
    state: AppState,
    room: Arc<Semaphore>,
    /// Whether connections without a request are to end; closed when all have.
    closing: watch::Sender<bool>,
}

impl Acceptor {
    fn new(router: Router, state: AppState, connections: usize) -> Self {
        let room = Arc::new(Semaphore::new(connections.min(Semaphore::MAX_PERMITS)));
        Self { router, state, room, closing: watch::Sender::new(false) }
    }

    /// Accepts connections until told otherwise.
    async fn accept(&self, listener: &TcpListener, shutdown: impl Future<Output = ()>) {
        let accept_all = async {
            loop {
                // The semaphore is never closed.
                let Ok(room) = Arc::clone(&self.room).acquire_owned().await else { return };
                match listener.accept().await {
                    Ok((stream, peer)) => self.spawn(room, stream, peer),
                    Err(error) if is_of_the_client(&error) => {}
                    Err(error) => {
                        tracing::error!(%error, "cannot accept a connection");
                        sleep(PAUSE).await;
                    }
                }
            }
        };
        tokio::select! {
            () = shutdown => {}
            () = accept_all => {}
        }
    }

    /// Accepts the connections that the system has already established.
    fn accept_those_who_wait(&self, listener: &TcpListener) {
        while let Ok(room) = Arc::clone(&self.room).try_acquire_owned()
            && let Some(Ok((stream, peer))) = listener.accept().now_or_never()
        {
            self.spawn(room, stream, peer);
        }
    }

    fn spawn(&self, room: OwnedSemaphorePermit, stream: TcpStream, peer: SocketAddr) {
        let (router, state, closing) = (self.router.clone(), self.state.clone(), self.closing.subscribe());
        tokio::spawn(async move {
            serve_connection(stream, peer, router, &state, closing).await;
            drop(room);
        });
    }

    /// Ends: those who have no request are let go after a moment, the others when they are answered.
    async fn close(self) {
        let Self { closing, .. } = self;
        tokio::select! {
            () = closing.closed() => return,
            () = sleep(LINGER) => {}
        }
        closing.send_replace(true);
        closing.closed().await;
    }
}

/// Whether a connection was lost before it was accepted.
fn is_of_the_client(error: &io::Error) -> bool {
    use io::ErrorKind::{ConnectionAborted, ConnectionRefused, ConnectionReset};
    matches!(error.kind(), ConnectionAborted | ConnectionRefused | ConnectionReset)
}

/// Answers the requests of a connection until its end.
async fn serve_connection(
    stream: TcpStream,
    peer: SocketAddr,
    router: Router,
    state: &AppState,
    mut closing: watch::Receiver<bool>,
) {
    // An error: the connection has ended already.
    let _ = stream.set_nodelay(true);
    let refuse = {
        let state = state.clone();
        Box::new(move |status| refuse_head(&state, peer, status))
    };
    let stream = WriteTimeoutStream::new(stream, state.config.idle, Arc::clone(&state.memory.answers), refuse);
    let client = stream.state();
    let answer = service_fn(move |mut request: Request<Incoming>| {
        request.extensions_mut().insert(Peer(peer));
        router.clone().oneshot(request.map(Body::new))
    });
    let connection = http1::Builder::new()
        .timer(TokioTimer::new())
        .header_read_timeout(state.config.idle)
        .max_buf_size(BUFFER)
        .serve_connection(TokioIo::new(stream), answer);
    let mut connection = std::pin::pin!(connection);
    state.metrics.connected();
    // How it ends is the client's affair: its requests have their lines in the log.
    tokio::select! {
        biased;
        _ = connection.as_mut() => {}
        () = closed(&mut closing) => {
            // A client that has said nothing yet has nothing to lose.
            if client.has_spoken() {
                connection.as_mut().graceful_shutdown();
                let _ = connection.await;
            }
        }
    }
    state.metrics.disconnected(client.has_stalled());
}

/// Waits until connections without a request are to end.
async fn closed(closing: &mut watch::Receiver<bool>) {
    // An error: whoever would tell is gone, and so is the service.
    let _ = closing.wait_for(|closing| *closing).await;
}

/// Waits for SIGTERM, SIGINT or SIGQUIT. SIGHUP, which a terminal sends when it closes, ends nothing: settings are read once.
///
/// # Errors
/// When the system lets no handler be set.
pub fn stop_signal() -> io::Result<impl Future<Output = ()> + Send + 'static> {
    use tokio::signal::unix::{SignalKind, signal};
    let mut terminate = signal(SignalKind::terminate())?;
    let mut interrupt = signal(SignalKind::interrupt())?;
    let mut quit = signal(SignalKind::quit())?;
    let mut hangup = signal(SignalKind::hangup())?;
    Ok(async move {
        loop {
            tokio::select! {
                _ = terminate.recv() => return,
                _ = interrupt.recv() => return,
                _ = quit.recv() => return,
                _ = hangup.recv() => tracing::info!("SIGHUP has no effect: settings are read only at the start"),
            }
        }
    })
}
