//! The tests of the project, in one program.

#![allow(clippy::unwrap_used, clippy::expect_used, reason = "a test that cannot go on has failed")]

mod analytic;
mod atmosphere;
mod check;
mod conversions;
mod departures;
mod events;
mod expensive;
mod flights;
mod fuzzing;
mod gas;
mod gravity;
mod ground_track;
mod heating;
mod http;
mod integrator;
mod number_types;
mod openapi;
mod parachutes;
mod phases;
mod pitfalls;
mod properties;
mod propulsion;
mod reference;
mod regimes;
mod tables;
mod tidy;
mod times;
mod validation;
mod verification;
