//! The rules of the house: what the source, the committed document, the built-in reference cases and the fuzz corpus must hold to.

mod fuzzing;
mod guide;
mod openapi;
mod tidy;
mod validation;
