//! How many batches compute at once, and how many of them may be a client's.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

use tokio::sync::{OwnedSemaphorePermit, Semaphore};

use crate::client::Client;
use crate::memory::Refusal;

/// The slots of batches; a client has at most half of them.
#[derive(Debug)]
pub(super) struct Slots {
    all: Arc<Semaphore>,
    share: usize,
    /// The slots that each client may still have; those who have all of theirs are forgotten.
    clients: Mutex<HashMap<Client, Weak<Semaphore>>>,
}

/// A slot, until dropped.
#[derive(Debug)]
pub(super) struct Slot {
    _of_all: OwnedSemaphorePermit,
    _of_client: OwnedSemaphorePermit,
}

impl Slots {
    pub(super) fn new(all: usize) -> Self {
        Self { all: Arc::new(Semaphore::new(all)), share: all.div_ceil(2).max(1), clients: Mutex::default() }
    }

    /// A slot at once.
    pub(super) fn try_take(&self, client: Client) -> Result<Slot, Refusal> {
        let of_all = Arc::clone(&self.all).try_acquire_owned().map_err(|_| Refusal::Full)?;
        let of_client = self.of(client).try_acquire_owned().map_err(|_| Refusal::Share)?;
        Ok(Slot { _of_all: of_all, _of_client: of_client })
    }

    /// A slot when there is one; none never, as no semaphore is ever closed.
    pub(super) async fn take(&self, client: Client) -> Option<Slot> {
        let of_client = self.of(client).acquire_owned().await.ok()?;
        let of_all = Arc::clone(&self.all).acquire_owned().await.ok()?;
        Some(Slot { _of_all: of_all, _of_client: of_client })
    }

    fn of(&self, client: Client) -> Arc<Semaphore> {
        let client = client.site();
        let mut clients = self.clients.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(known) = clients.get(&client).and_then(Weak::upgrade) {
            return known;
        }
        clients.retain(|_, semaphore| semaphore.strong_count() > 0);
        let new = Arc::new(Semaphore::new(self.share));
        clients.insert(client, Arc::downgrade(&new));
        new
    }
}
