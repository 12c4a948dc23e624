//! The service over HTTP, one file an endpoint.

mod simulate;
