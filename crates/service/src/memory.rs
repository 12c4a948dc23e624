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
    held: Mutex<HeldBytes>,
}

#[derive(Debug, Default)]
struct HeldBytes {
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
        self.permit_beside(client, 0)
    }

    /// A permit of no bytes yet, for what is made of something of so many bytes that the client holds: the two are one thing.
    pub fn permit_beside(self: &Arc<Self>, client: Client, source: usize) -> Permit {
        Permit { budget: Arc::clone(self), client: client.site(), source, bytes: 0 }
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

    fn lock(&self) -> MutexGuard<'_, HeldBytes> {
        self.held.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl HeldBytes {
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
    /// Bytes that are held for the same thing by another permit.
    source: usize,
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
            let others = held.of(self.client) - self.bytes - self.source;
            if held.all - self.bytes + bytes > limit {
                held.lacked = Some(Instant::now());
                return Err(Refusal::Full);
            }
            if others > 0 && others + bytes > self.budget.limit / 2 {
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

#[cfg(test)]
mod tests {
    use std::net::IpAddr;
    use std::sync::Arc;

    use super::{Budget, Permit, Refusal};
    use crate::client::Client;

    fn client(number: u8) -> Client {
        Client::from(IpAddr::from([203, 0, 113, number]))
    }

    fn holding(budget: &Arc<Budget>, number: u8, bytes: usize) -> Permit {
        let mut permit = budget.permit(client(number));
        permit.try_hold(bytes).unwrap();
        permit
    }

    #[test]
    fn a_client_holds_one_thing_or_half_of_a_budget() {
        let budget = Arc::new(Budget::new(1000));
        let one = holding(&budget, 1, 700);
        assert_eq!(budget.permit(client(1)).try_hold(1), Err(Refusal::Share));
        assert_eq!(budget.admit(client(1)), Err(Refusal::Share));
        assert_eq!(budget.admit(client(2)), Ok(()));
        assert_eq!(budget.permit(client(2)).try_hold(301), Err(Refusal::Full));
        let others = [holding(&budget, 2, 100), holding(&budget, 2, 200)];
        assert_eq!(budget.admit(client(3)), Err(Refusal::Full));
        drop(one);
        assert_eq!(budget.permit(client(2)).try_hold(201), Err(Refusal::Share));
        assert_eq!(budget.permit(client(2)).try_hold(200), Ok(()));
        drop(others);
        assert_eq!(budget.held(), 0);
    }

    #[test]
    fn what_was_held_is_held_on_where_more_is_refused() {
        let budget = Arc::new(Budget::new(1000));
        let mut permit = holding(&budget, 1, 600);
        assert_eq!(permit.try_hold(1001), Err(Refusal::Full));
        assert_eq!(budget.held(), 600);
        assert_eq!(permit.try_hold(200), Ok(()));
        assert_eq!(budget.held(), 200);
        let kept = permit.keep(Vec::with_capacity(50));
        assert_eq!(budget.held(), 50);
        drop(kept.clone());
        assert_eq!(budget.held(), 50);
        drop(kept);
        assert_eq!(budget.held(), 0);
    }

    #[test]
    fn a_text_and_the_body_of_which_it_is_made_are_one_thing() {
        let budget = Arc::new(Budget::new(1000));
        let _body = holding(&budget, 1, 100);
        assert_eq!(budget.permit(client(1)).try_hold(600), Err(Refusal::Share));
        let mut text = budget.permit_beside(client(1), 100);
        assert_eq!(text.try_hold(600), Ok(()));
        // Beside another body it is not.
        drop(text);
        let _other = holding(&budget, 1, 100);
        assert_eq!(budget.permit_beside(client(1), 100).try_hold(600), Err(Refusal::Share));
    }

    #[test]
    fn much_leaves_room_for_little() {
        let budget = Arc::new(Budget::new(1600));
        let mut much = budget.permit(client(1));
        assert_eq!(much.largest(), 1500);
        assert_eq!(much.try_reserve(1501), Err(Refusal::Full));
        assert_eq!(much.try_reserve(1500), Ok(()));
        assert_eq!(budget.permit(client(2)).try_reserve(26), Err(Refusal::Full));
        assert_eq!(budget.permit(client(2)).try_reserve(25), Ok(()));
    }

    #[test]
    fn the_slow_are_hurried_where_half_is_held_or_somebody_found_no_room() {
        let budget = Arc::new(Budget::new(1000));
        let little = holding(&budget, 1, 499);
        assert!(!budget.is_tight());
        let _more = holding(&budget, 2, 1);
        assert!(budget.is_tight());
        drop(little);
        assert!(!budget.is_tight());
        assert_eq!(budget.permit(client(3)).try_hold(1000), Err(Refusal::Full));
        assert!(budget.is_tight());
    }
}
