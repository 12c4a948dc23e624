//! The endpoints, in the order of the documentation.

#![expect(
    clippy::missing_errors_doc,
    reason = "the handlers' comments are the API's texts; openapi.rs lists the failures"
)]

pub mod analytic;
pub mod batch;
pub mod convert;
pub mod corridor;
pub mod docs;
pub mod footprint;
pub mod guide;
pub mod health;
pub mod licences;
pub mod metrics;
pub mod page;
pub mod planets;
pub mod simulate;
pub mod sites;
pub mod target;
pub mod validation;
