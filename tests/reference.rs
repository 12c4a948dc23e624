//! The reference cases in `cases/`.
