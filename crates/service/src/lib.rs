//! The `reentry` service: a translator between HTTP and the core.
//!
//! Read [`router`] first, then [`endpoints`]; [`wire`] holds the JSON, [`compute`] the threads.

pub mod answer;
pub mod compute;
pub mod config;
pub mod endpoints;
pub mod error;
pub mod extract;
pub mod format;
pub mod middleware;
pub mod openapi;
pub mod router;
pub mod serve;
pub mod state;
pub mod telemetry;
pub mod wire;

pub use router::{app, document};
