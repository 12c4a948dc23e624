//! The bytes that clients make the service hold: bodies on their way in, answers on their way out; together they are bounded.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use bytes::Bytes;

/// What may be held, and what is.
#[derive(Debug)]
pub struct Memory {
    limit: usize,
    held: AtomicUsize,
}

impl Memory {
    /// So many bytes.
    pub fn new(limit: usize) -> Self {
        Self { limit, held: AtomicUsize::new(0) }
    }

    /// The bytes that are held now.
    pub fn held(&self) -> usize {
        self.held.load(Ordering::Relaxed)
    }

    /// Whether nothing more is to be begun.
    pub fn is_full(&self) -> bool {
        self.held() >= self.limit
    }

    /// Whether those who do not take their answers should be waited for no longer: half of it is held.
    pub fn is_tight(&self) -> bool {
        self.held() >= self.limit / 2
    }

    /// A share of no bytes yet.
    pub fn share(self: &Arc<Self>) -> Share {
        Share { memory: Arc::clone(self), bytes: 0 }
    }

    /// The bytes, which count as held until the last that refers to them is gone: until the system has taken them to be sent.
    pub fn hold(self: &Arc<Self>, mut bytes: Vec<u8>) -> Bytes {
        bytes.shrink_to_fit();
        let mut share = self.share();
        share.grow(bytes.len());
        share.keep(bytes)
    }
}

/// Bytes that are held, until dropped.
#[derive(Debug)]
pub struct Share {
    memory: Arc<Memory>,
    bytes: usize,
}

impl Share {
    /// Holds so many more.
    pub fn grow(&mut self, bytes: usize) {
        self.bytes += bytes;
        self.memory.held.fetch_add(bytes, Ordering::Relaxed);
    }

    /// The bytes of which this is the share.
    pub fn keep(self, bytes: Vec<u8>) -> Bytes {
        Bytes::from_owner(Held { bytes, _share: self })
    }
}

impl Drop for Share {
    fn drop(&mut self) {
        self.memory.held.fetch_sub(self.bytes, Ordering::Relaxed);
    }
}

struct Held {
    bytes: Vec<u8>,
    _share: Share,
}

impl AsRef<[u8]> for Held {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}
