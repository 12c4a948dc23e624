//! What is computed from many flights of a case, or from its derivatives: how far the end scatters, and which numbers give what is wanted.
//!
//! The searches know no flights: what is flown, and how a number of a case is moved, is a function of whoever asks.

pub mod corridor;
pub mod dispersions;
pub mod flight;
pub mod footprint;
pub mod requirement;
pub mod target;
