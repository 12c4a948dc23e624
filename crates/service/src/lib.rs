//! The `reentry` service: a translator between HTTP and the core, and the same without HTTP, on the command line.
//!
//! Read [`router`] first, then [`endpoints`]; [`wire`] holds the JSON, [`compute`] the threads, [`cli`] the commands.

pub mod allocator;
pub mod answer;
pub mod cli;
pub mod client;
pub mod coding;
pub mod compute;
pub mod config;
pub mod connection;
pub mod embedded;
pub mod endpoints;
pub mod error;
pub mod extract;
pub mod format;
pub mod licences;
pub mod memory;
pub mod metrics;
pub mod middleware;
pub mod openapi;
pub mod rate;
pub mod reply;
pub mod router;
pub mod serve;
pub mod state;
pub mod telemetry;
pub mod validation;
pub mod wire;

pub use router::{app, document};
