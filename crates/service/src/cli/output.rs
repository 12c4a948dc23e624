//! Where results go: standard output, or a file that is there when it is whole.

use std::fs::{self, File, OpenOptions, Permissions};
use std::io::{self, ErrorKind, IsTerminal, Write};
use std::os::fd::AsFd;
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread;

use signal_hook::consts::{SIGINT, SIGTERM};
use signal_hook::iterator::Signals;
use signal_hook::low_level::emulate_default_handler;
use tempfile::NamedTempFile;

use crate::cli::{Failure, failure};

/// Where results go; nothing is opened before there is something to write, so that a failure leaves an older file as it is.
#[derive(Debug)]
pub(super) struct Output {
    /// The name of the file; none is standard output.
    path: Option<PathBuf>,
    sink: Option<Sink>,
}

/// What is written to.
#[derive(Debug)]
enum Sink {
    /// Standard output, a device, a pipe.
    Open(File),
    /// A file beside the one that it becomes when it is whole.
    Beside { part: NamedTempFile, target: PathBuf },
}

impl Output {
    /// To a file or, without one, to standard output.
    pub(super) fn new(path: Option<&Path>) -> Self {
        Self { path: path.map(Path::to_owned), sink: None }
    }

    /// Whether the results come to a terminal as they are written.
    pub(super) fn is_terminal(&self) -> bool {
        self.path.is_none() && io::stdout().is_terminal()
    }

    /// Writes, and says whether anybody reads on: a pipe that its reader has closed is no failure.
    ///
    /// # Errors
    /// When the output cannot be opened or written.
    pub(super) fn write(&mut self, bytes: &[u8]) -> Result<bool, Failure> {
        match self.try_write(bytes) {
            Ok(()) => Ok(true),
            Err(error) if self.path.is_none() && error.kind() == ErrorKind::BrokenPipe => Ok(false),
            Err(error) => Err(self.failure(error)),
        }
    }

    /// Puts a file that is whole in its place; until then there is the older one, or none.
    ///
    /// # Errors
    /// When the system does not let it.
    pub(super) fn finish(mut self) -> Result<(), Failure> {
        self.sink.take().map_or(Ok(()), Sink::finish).map_err(|error| self.failure(error))
    }

    fn try_write(&mut self, bytes: &[u8]) -> io::Result<()> {
        let sink = match self.sink.take() {
            Some(sink) => sink,
            None => self.path.as_deref().map_or_else(standard, Sink::open)?,
        };
        match self.sink.insert(sink) {
            Sink::Open(file) => file.write_all(bytes),
            Sink::Beside { part, .. } => part.as_file_mut().write_all(bytes),
        }
    }

    fn failure(&self, error: io::Error) -> Failure {
        failure("write", self.path.as_deref().unwrap_or(Path::new("standard output")), error)
    }
}

/// Standard output without the buffer of the library, which also keeps silent about a descriptor that cannot be written.
fn standard() -> io::Result<Sink> {
    if WAS_CLOSED.load(Ordering::Relaxed) {
        return Err(io::Error::other("it is closed"));
    }
    Ok(Sink::Open(io::stdout().as_fd().try_clone_to_owned()?.into()))
}

/// Whether the program was started with its standard output closed.
static WAS_CLOSED: AtomicBool = AtomicBool::new(false);

/// Looks, before `main`, at standard output: where it is closed, Rust opens /dev/null in its place, and then it is the same as the
/// /dev/null that Python and others give to a program whose output nobody wants.
///
/// It is safe that early: one system call, and nothing of the library, which is not to be used yet.
#[ctor::ctor(unsafe)]
fn look_at_standard_output() {
    WAS_CLOSED.store(rustix::io::fcntl_getfd(rustix::stdio::stdout()).is_err(), Ordering::Relaxed);
}

impl Sink {
    /// Opens a file: a regular one, or one that is not there yet, is written beside its place.
    fn open(path: &Path) -> io::Result<Self> {
        // What is open already: it goes on at its end, also where it is a file.
        if ["/dev/stdout", "/dev/stderr", "/dev/fd", "/proc"].iter().any(|start| path.starts_with(start)) {
            return OpenOptions::new().append(true).open(path).map(Self::Open);
        }
        match OpenOptions::new().write(true).open(path) {
            Ok(file) if file.metadata()?.is_file() => {
                // The place that links lead to; who may read it stays as it is.
                let permissions = file.metadata()?.permissions();
                let part = beside(&fs::canonicalize(path)?)?;
                if let Self::Beside { part, .. } = &part {
                    part.as_file().set_permissions(permissions)?;
                }
                Ok(part)
            }
            Ok(file) => Ok(Self::Open(file)),
            // A link to where nothing is yet.
            Err(error) if error.kind() == ErrorKind::NotFound && path.is_symlink() => {
                File::create(path).map(Self::Open)
            }
            Err(error) if error.kind() == ErrorKind::NotFound => beside(path),
            Err(error) => Err(error),
        }
    }

    fn finish(self) -> io::Result<()> {
        match self {
            Self::Open(_) => Ok(()),
            Self::Beside { part, target } => {
                // A disk may say only now that it is full.
                part.as_file().sync_all()?;
                part.persist(target).map(drop).map_err(|error| error.error)
            }
        }
    }
}

/// A file in the folder of the target, which goes away again unless it is put there.
fn beside(target: &Path) -> io::Result<Sink> {
    let folder = target.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    // Whoever interrupts the program leaves no half of a file. From here on they are noted, and obeyed below.
    let mut signals = Signals::new([SIGINT, SIGTERM])?;
    // Those of a new file: what the user's mask leaves of them.
    let permissions = Permissions::from_mode(0o666);
    let part =
        tempfile::Builder::new().prefix(".reentry-").suffix(".part").permissions(permissions).tempfile_in(folder)?;
    let path = part.path().to_owned();
    thread::spawn(move || {
        if let Some(signal) = signals.forever().next() {
            let _ = fs::remove_file(path);
            let _ = emulate_default_handler(signal);
        }
    });
    Ok(Sink::Beside { part, target: target.to_owned() })
}
