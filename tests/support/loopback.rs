//! What the programs have in common that measure the service on loopback: they start it, ask it, and read what it says,
//! with as little work as will do, since they share its processors.

use std::fs;
use std::io::{self, Error, ErrorKind};
use std::net::{SocketAddr, TcpListener};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::str;
use std::time::Duration;

use serde_json::Value;
use tokio::net::TcpStream;
use tokio::time::{Instant, sleep};

use crate::cases::thesis_cases;

/// How long a program may take to listen.
const PATIENCE: Duration = Duration::from_secs(10);
/// Bytes that are read at once; the head of an answer is shorter.
const BUFFER: usize = 1 << 16;
/// What an answer in chunks ends with; lines of JSON have no carriage return.
const LAST_CHUNK: &[u8] = b"\r\n0\r\n\r\n";

/// A program that listens until dropped.
#[derive(Debug)]
pub struct Program {
    process: Child,
    /// Where it listens.
    pub address: SocketAddr,
}

impl Program {
    /// Starts `reentry serve`, the one that the variable `REENTRY` names.
    ///
    /// # Errors
    /// As [`Program::start`].
    pub async fn serve() -> io::Result<Self> {
        let program =
            std::env::var_os("REENTRY").map_or_else(|| PathBuf::from("target/release/reentry"), PathBuf::from);
        Self::start(|address| {
            let mut command = Command::new(program);
            command.args(["serve", "--listen", &address.to_string()]);
            command
        })
        .await
    }

    /// Starts a program on a free port, with the settings that it has by itself; its log is thrown away.
    ///
    /// # Errors
    /// When it does not start or does not listen.
    pub async fn start(command: impl FnOnce(SocketAddr) -> Command) -> io::Result<Self> {
        let address = TcpListener::bind("127.0.0.1:0")?.local_addr()?;
        let mut command = command(address);
        for (name, _) in std::env::vars_os() {
            if name == "RUST_LOG" || name.as_encoded_bytes().starts_with(b"REENTRY") {
                command.env_remove(name);
            }
        }
        let process = command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
        let name = command.get_program().display();
        let program = Self { process: process.map_err(|error| Error::other(format!("{name}: {error}")))?, address };
        let end = Instant::now() + PATIENCE;
        while let Err(error) = TcpStream::connect(address).await {
            if Instant::now() > end {
                return Err(Error::other(format!("{name} does not listen: {error}")));
            }
            sleep(Duration::from_millis(10)).await;
        }
        Ok(program)
    }

    /// A number of bytes in the program's `/proc/PID/status`, where it stands in kB.
    ///
    /// # Errors
    /// When it has ended, or there is no such number.
    pub fn memory(&self, field: &str) -> io::Result<u64> {
        let status = fs::read_to_string(format!("/proc/{}/status", self.process.id()))?;
        let number = status.lines().find_map(|line| line.strip_prefix(field)?.strip_prefix(':')?.strip_suffix(" kB"));
        let number = number.and_then(|number| number.trim().parse::<u64>().ok());
        number.map(|kilobytes| kilobytes * 1024).ok_or_else(|| Error::other(format!("the status has no {field}")))
    }

    /// The processor time of all its threads.
    ///
    /// # Errors
    /// When it has ended.
    pub fn processor_time(&self) -> io::Result<Duration> {
        let path = format!("/proc/{}/stat", self.process.id());
        let fields = fs::read_to_string(&path)?;
        // Its name, in parentheses, may have blanks; behind it, the twelfth and the thirteenth are those of itself and
        // of the system.
        let fields = fields.rsplit_once(") ").map_or("", |(_, fields)| fields);
        ticks(fields.split(' ').skip(11).take(2)).ok_or_else(|| Error::other(format!("{path} has no times")))
    }

    /// Has `VmHWM` of [`Program::memory`] be the greatest from now on.
    ///
    /// # Errors
    /// When it has ended.
    pub fn forget_greatest_memory(&self) -> io::Result<()> {
        fs::write(format!("/proc/{}/clear_refs", self.process.id()), "5")
    }
}

impl Drop for Program {
    fn drop(&mut self) {
        // An error: it has ended already.
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}

/// A connection that is kept for one request after another.
#[derive(Debug)]
pub struct Connection {
    stream: TcpStream,
    buffer: Vec<u8>,
}

/// An answer that has come to its end.
#[derive(Debug)]
pub struct Reply {
    /// The status.
    pub status: u16,
    /// The length of the body.
    pub bytes: usize,
    /// The body, where it came in chunks; another is thrown away.
    pub text: Vec<u8>,
    /// Whether the connection is of no more use.
    pub closes: bool,
}

impl Connection {
    /// Connects.
    ///
    /// # Errors
    /// Those of the system.
    pub async fn open(address: SocketAddr) -> io::Result<Self> {
        let stream = TcpStream::connect(address).await?;
        stream.set_nodelay(true)?;
        Ok(Self { stream, buffer: vec![0; BUFFER] })
    }

    /// Whether the other side has closed it, or said something unasked.
    pub fn is_stale(&self) -> bool {
        let unread = self.stream.try_read(&mut [0]);
        !unread.is_err_and(|error| error.kind() == ErrorKind::WouldBlock)
    }

    /// Sends a request and reads its answer to the end.
    ///
    /// # Errors
    /// When the connection breaks off, or the answer has no end that can be told.
    pub async fn ask(&mut self, request: &[u8]) -> io::Result<Reply> {
        self.write(request).await?;
        let mut filled = 0;
        let body = loop {
            filled += read(&self.stream, &mut self.buffer[filled..]).await?;
            if let Some(end) = self.buffer[..filled].windows(4).position(|bytes| bytes == b"\r\n\r\n") {
                break end + 4;
            }
        };
        let head = str::from_utf8(&self.buffer[..body]).map_err(Error::other)?;
        let status = head.strip_prefix("HTTP/1.1 ").and_then(|rest| rest.get(..3)?.parse().ok());
        let status = status.ok_or_else(|| Error::other("an answer without a status"))?;
        let header = |name: &str| head.lines().find_map(|line| line.strip_prefix(name)?.strip_prefix(": "));
        let closes = header("connection") == Some("close");
        let length = header("content-length").and_then(|length| length.parse().ok());
        let chunked = header("transfer-encoding") == Some("chunked");
        let (bytes, text) = match length {
            Some(length) => (self.skip(filled - body, length).await?, Vec::new()),
            None if chunked => {
                let text = self.read_chunks(body..filled).await?;
                (text.len(), text)
            }
            None => return Err(Error::other("an answer without a length")),
        };
        Ok(Reply { status, bytes, text, closes })
    }

    /// Reads a body of a length, of which something is there.
    async fn skip(&mut self, mut taken: usize, length: usize) -> io::Result<usize> {
        while taken < length {
            taken += read(&self.stream, &mut self.buffer).await?;
        }
        if taken == length { Ok(length) } else { Err(Error::other("an answer longer than its length")) }
    }

    /// Reads a body in chunks, of which something is in the buffer.
    async fn read_chunks(&mut self, there: std::ops::Range<usize>) -> io::Result<Vec<u8>> {
        // So that an empty body, too, ends with what goes before its last chunk.
        let mut raw = b"\r\n".to_vec();
        raw.extend_from_slice(&self.buffer[there]);
        while !raw.ends_with(LAST_CHUNK) {
            let count = read(&self.stream, &mut self.buffer).await?;
            raw.extend_from_slice(&self.buffer[..count]);
        }
        join_chunks(&raw[2..]).ok_or_else(|| Error::other("an answer whose chunks do not fit"))
    }

    /// Writes all of it.
    ///
    /// # Errors
    /// When the connection breaks off.
    pub async fn write(&self, mut bytes: &[u8]) -> io::Result<()> {
        while !bytes.is_empty() {
            match self.stream.try_write(bytes) {
                Ok(written) => bytes = &bytes[written..],
                Err(error) if error.kind() == ErrorKind::WouldBlock => self.stream.writable().await?,
                Err(error) => return Err(error),
            }
        }
        Ok(())
    }
}

/// Reads what there is, at least a byte.
async fn read(stream: &TcpStream, buffer: &mut [u8]) -> io::Result<usize> {
    loop {
        match stream.try_read(buffer) {
            Ok(0) => return Err(ErrorKind::UnexpectedEof.into()),
            Err(error) if error.kind() == ErrorKind::WouldBlock => stream.readable().await?,
            result => return result,
        }
    }
}

/// What is in the chunks, the last of which is empty.
fn join_chunks(mut raw: &[u8]) -> Option<Vec<u8>> {
    let mut text = Vec::with_capacity(raw.len());
    loop {
        let end = raw.windows(2).position(|bytes| bytes == b"\r\n")?;
        let size = usize::from_str_radix(str::from_utf8(&raw[..end]).ok()?, 16).ok()?;
        let (chunk, rest) = raw[end + 2..].split_at_checked(size)?;
        raw = rest.strip_prefix(b"\r\n")?;
        text.extend_from_slice(chunk);
        if size == 0 {
            return raw.is_empty().then_some(text);
        }
    }
}

/// A request that posts a text.
pub fn post(path: &str, body: &Value) -> Vec<u8> {
    let body = body.to_string();
    let length = body.len();
    let kind = "content-type: application/json";
    format!("POST {path} HTTP/1.1\r\nhost: load\r\n{kind}\r\ncontent-length: {length}\r\n\r\n{body}").into_bytes()
}

/// A request that gets something.
pub fn get(path: &str) -> Vec<u8> {
    format!("GET {path} HTTP/1.1\r\nhost: load\r\n\r\n").into_bytes()
}

/// TARGET case 2, a flight as most are: some tens of microseconds.
pub fn target_2() -> Value {
    let case = thesis_cases().into_iter().find(|case| case.name == "target_2" && case.model == "earth_wgs84");
    case.map(|case| case.request).unwrap_or_default()
}

/// The one of the figures, in order, that so many of a hundred do not exceed.
pub fn percentile(sorted: &[f64], percent: usize) -> f64 {
    let rank = (sorted.len() * percent).div_ceil(100).max(1);
    sorted.get(rank - 1).copied().unwrap_or(f64::NAN)
}

/// The processor time of this program, which has one thread.
///
/// # Errors
/// When the system does not tell.
pub fn processor_time() -> io::Result<Duration> {
    let statistics = fs::read_to_string("/proc/self/schedstat")?;
    let nanoseconds = statistics.split(' ').next().and_then(|first| first.parse().ok());
    nanoseconds.map(Duration::from_nanos).ok_or_else(|| Error::other("/proc/self/schedstat has no number"))
}

/// The processor time of all that runs on the machine, and of what runs beside it on the same processors.
///
/// # Errors
/// When the system does not tell.
pub fn machine_time() -> io::Result<Duration> {
    let statistics = fs::read_to_string("/proc/stat")?;
    let fields = statistics.lines().next().unwrap_or_default().split_whitespace();
    // The name, then: user, nice, system, idle, iowait, irq, softirq, steal.
    let busy = fields.skip(1).enumerate().filter(|(index, _)| [0, 1, 2, 7].contains(index)).map(|(_, field)| field);
    ticks(busy).ok_or_else(|| Error::other("/proc/stat has no times"))
}

/// A sum of times that the system tells in hundredths of a second.
fn ticks<'a>(fields: impl Iterator<Item = &'a str>) -> Option<Duration> {
    let ticks = fields.map(|field| field.parse::<u64>().ok()).sum::<Option<u64>>()?;
    Some(Duration::from_millis(10 * ticks))
}
