//! The tests of the project, in one program.

mod check;
mod conversions;
mod flights;
mod http;
mod integrator;
mod pitfalls;
mod properties;
mod reference;
mod tidy;
