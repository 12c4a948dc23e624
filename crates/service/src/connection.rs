//! A connection: HTTP/1.1 over TCP, with a client that may be slow, silent, or speak something else.
//!
//! What hyper itself answers to a head that is no request has no body; the stream writes a problem document in its place.

use std::io::{self, IoSlice};
use std::pin::Pin;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::task::{Context, Poll, ready};
use std::time::Duration;

use axum::http::StatusCode;
use bytes::{Buf, Bytes};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::TcpStream;
use tokio::time::{Instant, Sleep, sleep};

use crate::memory::{Budget, HURRY, SLOWEST};

/// The answer to a head that is no request, by the status that hyper gives it.
type Refuse = Box<dyn Fn(StatusCode) -> Vec<u8> + Send>;

/// A stream of bytes that gives a client up that does not take what is sent to it.
pub struct WriteTimeoutStream {
    stream: TcpStream,
    answers: Arc<Budget>,
    /// How long nothing may be taken.
    write_timeout: Duration,
    stall: Option<StalledWrite>,
    state: Arc<ConnectionState>,
    refuse: Refuse,
    /// Of the answer that is written in place of hyper's, what is still to be.
    refusal: Option<Bytes>,
}

/// What a connection has shown of its client.
#[derive(Debug, Default)]
pub struct ConnectionState {
    has_spoken: AtomicBool,
    has_stalled: AtomicBool,
}

impl ConnectionState {
    /// Whether anything has come from it.
    pub fn has_spoken(&self) -> bool {
        self.has_spoken.load(Ordering::Relaxed)
    }

    /// Whether it was given up, as it took nothing.
    pub fn has_stalled(&self) -> bool {
        self.has_stalled.load(Ordering::Relaxed)
    }
}

/// An answer of which the system takes no more, as its client takes nothing.
#[derive(Debug)]
struct StalledWrite {
    since: Instant,
    /// Bytes that were taken since.
    taken: usize,
    tick: Pin<Box<Sleep>>,
}

impl WriteTimeoutStream {
    /// The stream of a client that may take nothing for so long.
    pub fn new(stream: TcpStream, write_timeout: Duration, answers: Arc<Budget>, refuse: Refuse) -> Self {
        Self { stream, answers, write_timeout, stall: None, state: Arc::default(), refuse, refusal: None }
    }

    /// Writes the answer to a head that is no request in place of `own`, which is hyper's.
    fn write_refusal(&mut self, context: &mut Context, status: StatusCode, own: usize) -> Poll<io::Result<usize>> {
        let mut rest = self.refusal.take().unwrap_or_else(|| (self.refuse)(status).into());
        while !rest.is_empty() {
            let attempt = Pin::new(&mut self.stream).poll_write(context, &rest);
            match self.judge(context, rest.len(), attempt) {
                Poll::Ready(Ok(taken)) => rest.advance(taken),
                other => {
                    self.refusal = Some(rest);
                    return other;
                }
            }
        }
        Poll::Ready(Ok(own))
    }

    /// What will be known of the client.
    pub fn state(&self) -> Arc<ConnectionState> {
        Arc::clone(&self.state)
    }

    /// What comes of an attempt to write so many bytes.
    fn judge(
        &mut self,
        context: &mut Context,
        wanted: usize,
        attempt: Poll<io::Result<usize>>,
    ) -> Poll<io::Result<usize>> {
        match attempt {
            Poll::Ready(Ok(taken)) if taken < wanted => {
                if let Some(stall) = &mut self.stall {
                    stall.taken += taken;
                }
                attempt
            }
            Poll::Ready(_) => {
                self.stall = None;
                attempt
            }
            Poll::Pending => self.wait(context).map(Err),
        }
    }

    /// Waits for the client; ready when it is given up.
    #[expect(clippy::cast_precision_loss, reason = "an answer has far less than 2^52 bytes")]
    fn wait(&mut self, context: &mut Context) -> Poll<io::Error> {
        let stall = self.stall.get_or_insert_with(|| StalledWrite {
            since: Instant::now(),
            taken: 0,
            tick: Box::pin(sleep(HURRY)),
        });
        loop {
            ready!(stall.tick.as_mut().poll(context));
            let write_timeout =
                if self.answers.is_tight() { HURRY.min(self.write_timeout) } else { self.write_timeout };
            let allowed = write_timeout + Duration::from_secs_f64(stall.taken as f64 / SLOWEST as f64);
            if stall.since.elapsed() >= allowed {
                self.state.has_stalled.store(true, Ordering::Relaxed);
                // What the system still holds for this client goes with the connection. An error: there is no connection any more.
                let _ = self.stream.set_zero_linger();
                return Poll::Ready(io::Error::new(io::ErrorKind::TimedOut, "the client takes nothing"));
            }
            let rest = allowed.saturating_sub(stall.since.elapsed());
            stall.tick.as_mut().reset(Instant::now() + rest.min(HURRY));
        }
    }
}

/// Where hyper's own answer begins to a head that is no request, if that is what the bytes end with, and its status. Answers of the service
/// have an identifier.
fn own_answer(bytes: &[u8]) -> Option<(usize, StatusCode)> {
    if !bytes.ends_with(b"\r\n\r\n") {
        return None;
    }
    let tail = &bytes[bytes.len().saturating_sub(LONGEST_OWN_ANSWER)..];
    let start = tail.windows(VERSION.len()).rposition(|window| window == VERSION)?;
    let own = str::from_utf8(&tail[start..]).ok()?;
    let status = own.get(VERSION.len()..)?.get(..3)?.parse().ok()?;
    let is_own = matches!(
        status,
        StatusCode::BAD_REQUEST | StatusCode::URI_TOO_LONG | StatusCode::REQUEST_HEADER_FIELDS_TOO_LARGE
    ) && own.contains("\r\ncontent-length: 0\r\n")
        && !own.contains("x-request-id");
    is_own.then_some((bytes.len() - own.len(), status))
}

/// With which an answer begins.
const VERSION: &[u8] = b"HTTP/1.1 ";

/// Bytes of hyper's own answers at most: a status, a length, a date, and that the connection closes.
const LONGEST_OWN_ANSWER: usize = 256;

impl AsyncRead for WriteTimeoutStream {
    fn poll_read(mut self: Pin<&mut Self>, context: &mut Context, buffer: &mut ReadBuf) -> Poll<io::Result<()>> {
        let before = buffer.filled().len();
        let result = Pin::new(&mut self.stream).poll_read(context, buffer);
        if buffer.filled().len() > before {
            self.state.has_spoken.store(true, Ordering::Relaxed);
        }
        result
    }
}

impl AsyncWrite for WriteTimeoutStream {
    fn poll_write(mut self: Pin<&mut Self>, context: &mut Context, bytes: &[u8]) -> Poll<io::Result<usize>> {
        let bytes = match own_answer(bytes) {
            Some((0, status)) => return self.write_refusal(context, status, bytes.len()),
            Some((start, _)) => &bytes[..start],
            None => bytes,
        };
        let attempt = Pin::new(&mut self.stream).poll_write(context, bytes);
        self.judge(context, bytes.len(), attempt)
    }

    fn poll_write_vectored(
        mut self: Pin<&mut Self>,
        context: &mut Context,
        slices: &[IoSlice],
    ) -> Poll<io::Result<usize>> {
        // Hyper's own answer has no body, hence it is in the last slice, alone or after the end of another answer.
        if let Some((start, _)) = slices.last().and_then(|last| own_answer(last)) {
            match slices {
                [own] => return self.poll_write(context, own),
                [others @ .., _] if start == 0 => return self.poll_write_vectored(context, others),
                [first, ..] => return self.poll_write(context, first),
                [] => {}
            }
        }
        let attempt = Pin::new(&mut self.stream).poll_write_vectored(context, slices);
        self.judge(context, slices.iter().map(|slice| slice.len()).sum(), attempt)
    }

    fn is_write_vectored(&self) -> bool {
        self.stream.is_write_vectored()
    }

    fn poll_flush(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(context)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, context: &mut Context) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(context)
    }
}
