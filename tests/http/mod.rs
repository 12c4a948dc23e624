//! The service over HTTP: what it refuses, then what it answers.
#![allow(clippy::unwrap_used, reason = "a test stops where it meets what it does not expect, its helpers included")]

pub(crate) mod fields;
mod refusal;
pub(crate) mod requests;

mod broken_json;
mod cross_field;
mod event_faults;
mod expensive;
mod extras;
mod faults;
mod problems;
mod protocol;
mod ranges;

mod analytic;
mod assumed;
mod batch;
mod bodies;
mod columns;
mod convert;
mod digits;
mod events;
mod frames;
mod heating;
mod launch;
mod licences;
mod limits;
mod metrics;
mod models;
mod nesc;
mod numbers;
mod oem;
mod output;
mod page;
mod planets;
mod reference;
mod searches;
mod sensitivities;
mod sidereal_time;
mod simulate;
mod sites;
mod space_weather;
mod surface;
mod times;
mod tracks;
