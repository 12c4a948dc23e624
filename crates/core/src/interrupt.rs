//! Who may end a computation before its time.

use std::fmt::Debug;
use std::sync::atomic::{AtomicBool, Ordering};

/// Whoever asked for a computation: it may end it, suspend it, or bound what it holds in memory.
pub trait Interrupt: Debug + Sync {
    /// Whether the computation is to end. It is asked before every step, and every millisecond or so of what has no steps; as long as it
    /// does not answer, the computation is suspended.
    fn is_raised(&self) -> bool;

    /// Whether the computation may hold so many bytes in all, the steps of a flight or what is made of them; else it is to end.
    fn may_hold(&self, _bytes: usize) -> bool {
        true
    }

    /// A search calls it before each flight, with the number of the flight, from 1: for a display of the progress.
    fn begins_flight(&self, _number: u64) {}
}

/// A flag: once it is true, the computation is to end.
impl Interrupt for AtomicBool {
    fn is_raised(&self) -> bool {
        self.load(Ordering::Relaxed)
    }
}
