//! The tests of the project, in one program.

#![allow(clippy::disallowed_methods, reason = "what is compared may be by the system's library")]
#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on has failed")]

mod check;

mod core;
mod house;
mod http;
