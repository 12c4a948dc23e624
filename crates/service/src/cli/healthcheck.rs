//! `reentry healthcheck`: asks a service whether it runs.

use std::io::{self, ErrorKind, Read, Write};
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use clap::Args;

/// Which service to ask, and what.
#[derive(Args, Debug)]
pub struct Healthcheck {
    /// Address and port of the service; for 0.0.0.0 (all addresses), 127.0.0.1 is checked
    #[arg(long, env = "REENTRY_LISTEN", default_value = "127.0.0.1:8080")]
    listen: SocketAddr,

    /// Check whether the service accepts new requests, not only whether it is running
    #[arg(long)]
    ready: bool,
}

/// How long the service may take to be reached, and again to answer.
const PATIENCE: Duration = Duration::from_secs(2);

impl Healthcheck {
    /// Asks, and returns if the answer is good.
    ///
    /// # Errors
    /// When there is no answer, or one that is not good.
    pub fn run(&self) -> io::Result<()> {
        let address = reachable(self.listen);
        let path = if self.ready { "/health/ready" } else { "/health/live" };
        let url = format!("http://{address}{path}");
        match status(address, path) {
            Ok(line) if line.split(' ').nth(1) == Some("200") => Ok(()),
            Ok(line) => Err(io::Error::other(format!("{url} returned {line:?}"))),
            Err(error) => Err(io::Error::new(error.kind(), format!("{url} does not answer: {error}"))),
        }
    }
}

/// The address under which this machine reaches a service that listens on the given one.
fn reachable(mut listen: SocketAddr) -> SocketAddr {
    match listen.ip() {
        IpAddr::V4(ip) if ip.is_unspecified() => listen.set_ip(Ipv4Addr::LOCALHOST.into()),
        IpAddr::V6(ip) if ip.is_unspecified() => listen.set_ip(Ipv6Addr::LOCALHOST.into()),
        _ => {}
    }
    listen
}

/// The status line of the answer to a GET request.
fn status(address: SocketAddr, path: &str) -> io::Result<String> {
    let mut stream = TcpStream::connect_timeout(&address, PATIENCE)?;
    let end = Instant::now() + PATIENCE;
    stream.set_write_timeout(Some(PATIENCE))?;
    stream.write_all(format!("GET {path} HTTP/1.1\r\nhost: {address}\r\nconnection: close\r\n\r\n").as_bytes())?;
    let (mut start, mut part) = (Vec::new(), [0; 256]);
    // A status line is far shorter than 1024 bytes; what talks for ever is not the service.
    while !start.contains(&b'\n') && start.len() < 1024 {
        let left = end.saturating_duration_since(Instant::now());
        let late = || io::Error::new(ErrorKind::TimedOut, format!("no answer within {} s", PATIENCE.as_secs()));
        if left.is_zero() {
            return Err(late());
        }
        stream.set_read_timeout(Some(left))?;
        match stream.read(&mut part) {
            Ok(0) => break,
            Ok(count) => start.extend_from_slice(&part[..count]),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Err(late()),
            Err(error) => return Err(error),
        }
    }
    Ok(String::from_utf8_lossy(&start).lines().next().unwrap_or_default().to_owned())
}

#[cfg(test)]
mod tests {
    use super::reachable;

    #[test]
    fn every_address_is_asked_on_this_machine() {
        for (listen, asked) in [
            ("0.0.0.0:8080", "127.0.0.1:8080"),
            ("[::]:80", "[::1]:80"),
            ("192.0.2.1:8080", "192.0.2.1:8080"),
            ("127.0.0.1:1", "127.0.0.1:1"),
        ] {
            assert_eq!(reachable(listen.parse().unwrap()), asked.parse().unwrap());
        }
    }
}
