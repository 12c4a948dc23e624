//! What is computed from flights and their derivatives.

pub mod dispersions;
