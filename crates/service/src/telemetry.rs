//! The log: lines on standard error, written by a thread of their own, so that whoever reads them slowly, or not at all, stops nobody.

use std::io::stderr;

use tracing_appender::non_blocking::{ErrorCounter, NonBlockingBuilder, WorkerGuard};
use tracing_subscriber::EnvFilter;

use crate::config::{Config, LogFormat};

/// Lines that may wait to be written; more are lost, and counted.
const LINES_WAITING: usize = 16_384;

/// The log that has been started; what still waits is written when it is dropped.
#[derive(Debug)]
pub struct Log {
    _writer: WorkerGuard,
    lost: LostLines,
}

/// How many lines were lost.
#[derive(Clone, Debug, Default)]
pub struct LostLines(Option<ErrorCounter>);

impl LostLines {
    /// Since the start.
    pub fn count(&self) -> usize {
        self.0.as_ref().map_or(0, ErrorCounter::dropped_lines)
    }
}

impl Log {
    /// Starts the log, of what the settings ask for.
    pub fn start(config: &Config) -> Self {
        let (writer, guard) =
            NonBlockingBuilder::default().buffered_lines_limit(LINES_WAITING).lossy(true).finish(stderr());
        let lost = LostLines(Some(writer.error_counter()));
        // A line that cannot be written, on a full disk for example, is told nobody: that could not be written either.
        let log = tracing_subscriber::fmt()
            .with_env_filter(EnvFilter::new(&config.log))
            .with_writer(writer)
            .with_target(false)
            .log_internal_errors(false);
        match config.log_format {
            LogFormat::Text => log.with_ansi(false).init(),
            LogFormat::Json => log.json().flatten_event(true).with_span_list(false).init(),
        }
        Self { _writer: guard, lost }
    }

    /// How many lines were lost.
    pub fn lost_lines(&self) -> LostLines {
        self.lost.clone()
    }
}
