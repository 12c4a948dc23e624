//! `reentry licences`: the licences of all that the program is made of.

use std::io;

use clap::{Args, ValueEnum};

use crate::cli::cases::with_line_end;
use crate::cli::{Failure, print};
use crate::licences::Licences as All;

/// How the licences are printed.
#[derive(Args, Debug)]
pub struct Licences {
    /// Output format
    #[arg(long, short, value_enum, default_value_t = Format::Text)]
    format: Format,
}

#[derive(Clone, Copy, Debug, ValueEnum)]
enum Format {
    /// A list, and every text once
    Text,
    /// The same, as GET /licences returns it
    Json,
}

impl Licences {
    /// Prints them.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn run(&self) -> Result<(), Failure> {
        let all = All::of_program()?;
        print(&match self.format {
            Format::Text => all.to_text().into_bytes(),
            Format::Json => with_line_end(all.to_json().map_err(io::Error::from)?),
        })
    }
}
