//! What the tests share: the reference cases, a service to call without a socket, and programs to ask on loopback.

pub mod cases;
pub mod loopback;
pub mod nesc;
pub mod service;
pub mod standard_air;
pub mod theory;
pub mod timing;
