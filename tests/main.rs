//! The tests of the project, in one program.

mod http;
mod reference;
