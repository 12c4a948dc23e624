//! The tests of the project, in one program.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on has failed")]

mod check;

mod core;
mod house;
mod http;
