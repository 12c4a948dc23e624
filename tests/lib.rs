//! What the tests share: the reference cases, and a service to call without a socket.

pub mod cases;
pub mod service;
pub mod theory;
pub mod timing;
