//! The coding of an answer: which one the client likes best (RFC 9110, section 12.5.3), and the bytes in it; and the text of a body that
//! came in a coding.

use std::fmt;
use std::io::{self, Read, Write};
use std::mem;

use axum::http::{HeaderMap, header};
use flate2::Compression;
use flate2::read::MultiGzDecoder;
use flate2::write::GzEncoder;
use reentry::Interrupt;
use zstd::stream::read::Decoder as ZstdDecoder;
use zstd::stream::write::Encoder as ZstdEncoder;

/// How the bytes of an answer are written.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Coding {
    /// As they are.
    #[default]
    Identity,
    /// Brotli, for files that are compressed beforehand.
    Brotli,
    /// gzip.
    Gzip,
    /// Zstandard.
    Zstd,
}

impl Coding {
    /// The name in `Content-Encoding`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Identity => "identity",
            Self::Brotli => "br",
            Self::Gzip => "gzip",
            Self::Zstd => "zstd",
        }
    }

    /// The offered coding of the greatest quality in `Accept-Encoding`, the first of those that are alike; as they are, for a client
    /// that accepts none.
    pub fn negotiate(request: &HeaderMap, offered: &[Self]) -> Self {
        let accepted: Vec<_> =
            request.get_all(header::ACCEPT_ENCODING).iter().filter_map(|line| line.to_str().ok()).collect();
        let accepted = accepted.join(",");
        let mut best = (0.0, Self::Identity);
        for coding in offered {
            let quality = quality(&accepted, coding.name());
            if quality > best.0 {
                best = (quality, *coding);
            }
        }
        best.1
    }
}

/// The quality that `Accept-Encoding` gives to a coding: what is said of it, or else of all that are not named.
fn quality(accepted: &str, coding: &str) -> f64 {
    let of = |wanted: &str| {
        accepted.split(',').find_map(|item| {
            let mut parameters = item.split(';').map(str::trim);
            if !parameters.next().is_some_and(|name| name.eq_ignore_ascii_case(wanted)) {
                return None;
            }
            let weight = parameters.find_map(|text| text.strip_prefix("q=").or(text.strip_prefix("Q=")));
            Some(weight.map_or(1.0, |weight| weight.parse().unwrap_or(0.0)))
        })
    };
    of(coding).or_else(|| of("*")).unwrap_or(0.0)
}

/// Writes in a coding, fast rather than small: compressing costs more than flying.
pub enum Encoder {
    /// As it is.
    Identity(Vec<u8>),
    /// By gzip.
    Gzip(GzEncoder<Vec<u8>>),
    /// By Zstandard.
    Zstd(ZstdEncoder<'static, Vec<u8>>),
}

impl fmt::Debug for Encoder {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        f.write_str(match self {
            Self::Identity(_) => "Identity",
            Self::Gzip(_) => "Gzip",
            Self::Zstd(_) => "Zstd",
        })
    }
}

/// Bytes that are coded between two looks at the flag: a few milliseconds.
const CHUNK: usize = 1 << 18;

impl Encoder {
    /// An encoder; [`Coding::Brotli`] is too slow to be made while a client waits, and is written as it is.
    ///
    /// # Errors
    /// When there is no memory for it.
    pub fn new(coding: Coding) -> io::Result<Self> {
        Ok(match coding {
            Coding::Identity | Coding::Brotli => Self::Identity(Vec::new()),
            Coding::Gzip => Self::Gzip(GzEncoder::new(Vec::new(), Compression::fast())),
            Coding::Zstd => Self::Zstd(ZstdEncoder::new(Vec::new(), ZSTD_LEVEL)?),
        })
    }

    /// Writes, until the flag is raised.
    ///
    /// # Errors
    /// When it is.
    pub fn write(&mut self, bytes: &[u8], interrupt: &dyn Interrupt) -> io::Result<()> {
        for chunk in bytes.chunks(CHUNK) {
            if interrupt.is_raised() {
                return Err(io::ErrorKind::Other.into());
            }
            match self {
                Self::Identity(plain) => plain.extend_from_slice(chunk),
                Self::Gzip(encoder) => encoder.write_all(chunk)?,
                Self::Zstd(encoder) => encoder.write_all(chunk)?,
            }
        }
        Ok(())
    }

    /// What has been written since the last time, readable by itself.
    ///
    /// # Errors
    /// Never: memory can always be written.
    pub fn take(&mut self) -> io::Result<Vec<u8>> {
        Ok(match self {
            Self::Identity(plain) => mem::take(plain),
            Self::Gzip(encoder) => {
                encoder.flush()?;
                mem::take(encoder.get_mut())
            }
            Self::Zstd(encoder) => {
                encoder.flush()?;
                mem::take(encoder.get_mut())
            }
        })
    }

    /// The end of what has been written.
    ///
    /// # Errors
    /// Never: memory can always be written.
    pub fn finish(self) -> io::Result<Vec<u8>> {
        match self {
            Self::Identity(plain) => Ok(plain),
            Self::Gzip(encoder) => encoder.finish(),
            Self::Zstd(encoder) => encoder.finish(),
        }
    }
}

/// The fastest.
const ZSTD_LEVEL: i32 = 1;

/// Why a body has no text.
#[derive(Debug)]
pub enum InflateError<E> {
    /// It is not what its coding says.
    Unreadable(io::Error),
    /// The text is not wanted any more.
    Refused(E),
}

/// The text of a body in a coding; `interrupt` ends it early. `grow` is asked every 256 KiB whether the text may become so long.
///
/// # Errors
/// When the body is not what its coding says, or `interrupt` is raised, and those of `grow`.
pub fn inflate<E>(
    coding: Coding,
    body: &[u8],
    interrupt: &dyn Interrupt,
    mut grow: impl FnMut(usize) -> Result<(), E>,
) -> Result<Vec<u8>, InflateError<E>> {
    let mut reader = decoder(coding, Watched { body, interrupt }).map_err(InflateError::Unreadable)?;
    let (mut text, mut chunk) = (Vec::new(), vec![0; CHUNK]);
    loop {
        let length = reader.read(&mut chunk).map_err(InflateError::Unreadable)?;
        if length == 0 {
            return Ok(text);
        }
        grow(text.len() + length).map_err(InflateError::Refused)?;
        text.extend_from_slice(&chunk[..length]);
    }
}

fn decoder<'a>(coding: Coding, body: Watched<'a>) -> io::Result<Box<dyn Read + 'a>> {
    Ok(match coding {
        Coding::Identity | Coding::Brotli => Box::new(body),
        Coding::Gzip => Box::new(MultiGzDecoder::new(body)),
        Coding::Zstd => {
            let mut decoder = ZstdDecoder::new(body)?;
            decoder.window_log_max(ZSTD_WINDOW)?;
            Box::new(decoder)
        }
    })
}

/// A body that is read in pieces, with a look at the flag before each: a decoder may read much and give nothing.
struct Watched<'a> {
    body: &'a [u8],
    interrupt: &'a dyn Interrupt,
}

/// Bytes that are read between two looks at the flag: at most a millisecond, where all of them are empty members of gzip.
const PIECE: usize = 1 << 13;

impl Read for Watched<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        if self.interrupt.is_raised() {
            return Err(io::ErrorKind::Other.into());
        }
        let length = buffer.len().min(PIECE);
        self.body.read(&mut buffer[..length])
    }
}

/// The window that a frame may ask for, as a power of two: 8 MiB, which is what RFC 8878 has decoders support.
const ZSTD_WINDOW: u32 = 23;
