//! What the tests share: the reference cases, a service to call without a socket, programs to ask on loopback, and what must hold of
//! any request.

#![allow(clippy::disallowed_methods, reason = "what is compared may be by the system's library")]

pub mod cases;
pub mod fuzzed;
pub mod loopback;
pub mod mutation;
pub mod nesc;
pub mod service;
pub mod standard_air;
pub mod theory;
pub mod timing;
