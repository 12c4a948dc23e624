//! The bytes that clients make the service hold, in budgets that do not take from each other: bodies of batches, other bodies, and answers
//! from the first step of their flight to the last byte that the system has taken to be sent.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use bytes::Bytes;

use crate::client::Client;
use crate::config::{BATCH_BODIES, BODIES};

/// How long those who are slow are waited for where a budget is tight.
pub const HURRY: Duration = Duration::from_secs(1);

/// The slowest that a client may send a body or take an answer, where it is not waited for, bytes a second.
pub const SLOWEST: usize = 16_384;

/// All budgets.
#[derive(Clone, Debug)]
pub struct Memory {
    /// Of the bodies of batches, as they arrive: an eighth.
    pub batch_bodies: Arc<Budget>,
    /// Of all other bodies, as they arrive: a sixteenth.
    pub bodies: Arc<Budget>,
    /// Of answers, as they are computed and sent: the rest.
    pub answers: Arc<Budget>,
}

impl Memory {
    /// Budgets that have so many bytes in all.
    pub fn new(bytes: usize) -> Self {
        let [batch_bodies, bodies] = [bytes / BATCH_BODIES, bytes / BODIES];
        let budget = |limit| Arc::new(Budget::new(limit));
        Self {
            batch_bodies: budget(batch_bodies),
            bodies: budget(bodies),
            answers: budget(bytes - batch_bodies - bodies),
        }
    }
}

/// What may be held of a kind, and what is.
#[derive(Debug)]
pub struct Budget {
    limit: usize,
    held: Mutex<Held>,
}

#[derive(Debug, Default)]
struct Held {
    all: usize,
    clients: HashMap<Client, usize>,
    /// When somebody found no room.
    lacked: Option<Instant>,
}

/// Why no more may be held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refusal {
    /// The budget is used up.
    Full,
    /// The client holds its share of it, which is a half.
    Share,
}

impl Budget {
    fn new(limit: usize) -> Self {
        Self { limit, held: Mutex::default() }
    }

    /// The bytes that are held now.
    pub fn held(&self) -> usize {
        self.lock().all
    }

    /// Whether nothing more is to be begun.
    pub fn is_full(&self) -> bool {
        self.held() >= self.limit
    }

    /// Whether those who are slow should be waited for no longer: half of it is held, or somebody has just found no room.
    pub fn is_tight(&self) -> bool {
        let held = self.lock();
        held.all >= self.limit / 2 || held.lacked.is_some_and(|instant| instant.elapsed() < HURRY)
    }

    /// A permit of no bytes yet.
    pub fn permit(self: &Arc<Self>, client: Client) -> Permit {
        Permit { budget: Arc::clone(self), client: client.site(), bytes: 0 }
    }

    /// Whether a client may begin to hold something.
    ///
    /// # Errors
    /// When the budget is used up, or the client's share is.
    pub fn admit(&self, client: Client) -> Result<(), Refusal> {
        let held = self.lock();
        if held.all >= self.limit {
            Err(Refusal::Full)
        } else if held.of(client.site()) >= self.limit / 2 {
            Err(Refusal::Share)
        } else {
            Ok(())
        }
    }

    fn lock(&self) -> MutexGuard<'_, Held> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Held {
    fn of(&self, client: Client) -> usize {
        self.clients.get(&client).copied().unwrap_or(0)
    }

    fn change(&mut self, client: Client, from: usize, to: usize) {
        self.all = self.all - from + to;
        match self.clients.entry(client) {
            Entry::Occupied(mut of_client) => {
                *of_client.get_mut() = *of_client.get() - from + to;
                if *of_client.get() == 0 {
                    of_client.remove();
                }
            }
            Entry::Vacant(of_client) if to > 0 => {
                of_client.insert(to);
            }
            Entry::Vacant(_) => {}
        }
    }
}

/// Bytes that are held, until dropped.
#[derive(Debug)]
pub struct Permit {
    budget: Arc<Budget>,
    client: Client,
    bytes: usize,
}

impl Permit {
    /// Holds so many in all, if there is room for that.
    ///
    /// # Errors
    /// When there is none: up to the limit, and up to the client's share of it, beyond which it may hold one thing alone. What was held
    /// before is held on.
    pub fn try_hold(&mut self, bytes: usize) -> Result<(), Refusal> {
        self.hold_within(self.budget.limit, bytes)
    }

    /// Holds so many in all beside something else of which it is made, if there is room up to the limit.
    ///
    /// # Errors
    /// When there is none.
    pub fn try_hold_beside(&mut self, bytes: usize) -> Result<(), Refusal> {
        let mut held = self.budget.lock();
        if held.all - self.bytes + bytes > self.budget.limit {
            held.lacked = Some(Instant::now());
            return Err(Refusal::Full);
        }
        held.change(self.client, self.bytes, bytes);
        self.bytes = bytes;
        Ok(())
    }

    /// Holds so many in all, if they are few, or leave the part of the budget that is for the many that are.
    ///
    /// # Errors
    /// As [`Permit::try_hold`].
    pub fn try_reserve(&mut self, bytes: usize) -> Result<(), Refusal> {
        let few = self.budget.limit / 64;
        self.hold_within(if bytes <= few { self.budget.limit } else { self.largest() }, bytes)
    }

    /// The most that [`Permit::try_reserve`] may ever hold.
    pub fn largest(&self) -> usize {
        self.budget.limit / 16 * 15
    }

    fn hold_within(&mut self, limit: usize, bytes: usize) -> Result<(), Refusal> {
        let mut held = self.budget.lock();
        if bytes > self.bytes {
            let of_client = held.of(self.client) - self.bytes;
            if held.all - self.bytes + bytes > limit {
                held.lacked = Some(Instant::now());
                return Err(Refusal::Full);
            }
            if of_client > 0 && of_client + bytes > self.budget.limit / 2 {
                return Err(Refusal::Share);
            }
        }
        held.change(self.client, self.bytes, bytes);
        self.bytes = bytes;
        Ok(())
    }

    /// The bytes, which count as held until the last that refers to them is gone.
    pub fn keep(mut self, bytes: Vec<u8>) -> Bytes {
        self.budget.lock().change(self.client, self.bytes, bytes.capacity());
        self.bytes = bytes.capacity();
        Bytes::from_owner(Kept { bytes, _permit: self })
    }
}

impl Drop for Permit {
    fn drop(&mut self) {
        self.budget.lock().change(self.client, self.bytes, 0);
    }
}

struct Kept {
    bytes: Vec<u8>,
    _permit: Permit,
}

impl AsRef<[u8]> for Kept {
    fn as_ref(&self) -> &[u8] {
        &self.bytes
    }
}
