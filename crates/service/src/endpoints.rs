//! The endpoints, in the order of the documentation.

pub mod convert;
pub mod health;
pub mod home;
pub mod simulate;
