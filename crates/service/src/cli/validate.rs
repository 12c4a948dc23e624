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
    /// What is written
    #[arg(long, short, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// Every check in a table, with its sources
    Text,
    /// Every check with all its digits, as GET /validation answers
    Json,
    /// A table with a line for each case
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
        let misses: Vec<_> = validation.misses().map(|miss| format!("reentry: missed: {}", miss.told())).collect();
        tell(&misses);
        if validation.passed { Ok(()) } else { Err(Failure::Case) }
    }
}

fn failed(error: &ApiError) -> Failure {
    tell(&[format!("reentry: {error}")]);
    Failure::Case
}
