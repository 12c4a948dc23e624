//! `reentry validate`: what the program makes of the reference cases that are built into it.

use std::io;
use std::sync::atomic::AtomicBool;

use clap::{Args, ValueEnum};

use crate::cli::cases::with_line_end;
use crate::cli::{Failure, print, tell};
use crate::error::ApiError;
use crate::validation::Validation;

/// How a validation is printed.
#[derive(Args, Debug)]
pub struct Validate {
    /// Output format
    #[arg(long, short, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// All checks in a table, with their sources
    Text,
    /// All checks with all digits, as GET /validation returns them
    Json,
    /// A table with one line per case
    Markdown,
}

impl Validate {
    /// Flies every case.
    ///
    /// # Errors
    /// When a case came out otherwise than expected, which is told on standard error.
    pub fn run(&self) -> Result<(), Failure> {
        let interrupt = AtomicBool::new(false);
        let validation = Validation::run(&interrupt).map_err(|error| failed(&error))?;
        let text = match self.format {
            Format::Text => validation.to_text().into_bytes(),
            Format::Json => with_line_end(validation.to_json().map_err(io::Error::from)?),
            Format::Markdown => validation.to_markdown().into_bytes(),
        };
        print(&text)?;
        let misses: Vec<_> =
            validation.misses().map(|miss| format!("reentry: check failed: {}", miss.told())).collect();
        tell(&misses);
        if validation.passed { Ok(()) } else { Err(Failure::Case) }
    }
}

fn failed(error: &ApiError) -> Failure {
    tell(&[format!("reentry: {error}")]);
    Failure::Case
}
