//! The reference cases in `cases/`, with their sources; those of the thesis are read as the program reads them.

use std::fs;
use std::path::Path;

pub use reentry_service::validation::cases::{ThesisCase, distance, thesis_cases};
use serde_json::Value;

/// Reads a JSON file.
///
/// # Panics
/// When it is not there or not JSON.
pub fn read_json(file: &Path) -> Value {
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}
