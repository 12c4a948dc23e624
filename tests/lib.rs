//! What the tests share: the reference cases, and a service to call without a socket.

pub mod cases;
pub mod nesc;
pub mod service;
pub mod standard_air;
pub mod theory;
pub mod timing;
