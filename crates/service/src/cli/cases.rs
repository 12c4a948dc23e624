//! `reentry simulate` and its kin: from a file with one case or many to the answers.

use std::fs;
use std::io::{self, IsTerminal, Read};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use reentry::Interrupt;
use serde_json::Value;
use serde_json::value::RawValue;

use crate::answer;
use crate::cli::{Failure, Output, failure, tell};
use crate::compute;
use crate::error::{ApiError, FieldError};
use crate::format::Format;
use crate::wire::json;
use crate::wire::reader::Fault;

/// A file with cases, and what is to become of them.
#[derive(Args, Debug)]
pub struct Cases {
    #[command(flatten)]
    states: States,

    /// Rows that a trajectory may have, so that a slip of the pen does not fill the memory
    #[arg(long, default_value_t = 1_000_000)]
    row_limit: usize,
}

/// A file with JSON, and where the answer goes.
#[derive(Args, Debug)]
pub struct States {
    /// The file with the JSON, one object or an array of them; - is standard input
    file: PathBuf,

    /// The file to write, in place of standard output
    #[arg(long, short)]
    output: Option<PathBuf>,
}

impl Cases {
    /// Answers every case in a format.
    ///
    /// # Errors
    /// When a case fails, or a file cannot be read or written.
    pub fn run(&self, format: Format, answer: impl Answer) -> Result<(), Failure> {
        Run { place: self.states.place(), format, row_limit: self.row_limit, answer }.all(&self.states)
    }
}

impl States {
    /// Answers every state.
    ///
    /// # Errors
    /// When a state is not valid, or a file cannot be read or written.
    pub fn run(&self, answer: impl Answer) -> Result<(), Failure> {
        Run { place: self.place(), format: Format::Json, row_limit: 0, answer }.all(self)
    }

    fn is_standard(&self) -> bool {
        self.file == Path::new("-")
    }

    /// The name of the file, for people.
    fn place(&self) -> String {
        if self.is_standard() { "standard input".to_owned() } else { self.file.display().to_string() }
    }

    fn read(&self) -> Result<Vec<u8>, Failure> {
        let mut text = Vec::new();
        let read = if self.is_standard() {
            io::stdin().lock().read_to_end(&mut text).map(|_| text)
        } else {
            fs::read(&self.file)
        };
        read.map_err(|error| failure("read", Path::new(&self.place()), error))
    }
}

/// A function of [`crate::answer`].
pub trait Answer: Fn(Value, Format, usize, &dyn Interrupt) -> Result<answer::Answer, ApiError> + Sync {}

impl<F: Fn(Value, Format, usize, &dyn Interrupt) -> Result<answer::Answer, ApiError> + Sync> Answer for F {}

struct Run<A> {
    place: String,
    format: Format,
    row_limit: usize,
    answer: A,
}

impl<A: Answer> Run<A> {
    fn all(&self, states: &States) -> Result<(), Failure> {
        let text = states.read()?;
        let mut output = Output::new(states.output.as_deref());
        match json::elements(&text) {
            Ok(Some(cases)) if cases.is_empty() => {
                Err(self.failed(&ApiError::Invalid(vec![Fault::new("", "must have at least 1 case, got none")])))
            }
            Ok(Some(_)) if self.format == Format::Kml => {
                let detail =
                    "must be one case where KML is asked for, not a list: a document of XML is no line of a file";
                Err(self.failed(&ApiError::Invalid(vec![Fault::new("", detail)])))
            }
            Ok(Some(cases)) => self.many(&cases, &mut output),
            Ok(None) => self.one(&text, &mut output),
            Err(error) => Err(self.failed(&error.into())),
        }
    }

    fn one(&self, text: &[u8], output: &mut Output) -> Result<(), Failure> {
        let tree = json::parse(text).map_err(|error| self.failed(&error.into()))?;
        let answer = self.answer(tree, &AtomicBool::new(false)).map_err(|error| self.failed(&error))?;
        output.write(&with_line_end(answer)).map(drop)
    }

    fn many(&self, cases: &[&RawValue], output: &mut Output) -> Result<(), Failure> {
        let bar = progress(cases.len(), output);
        let mut ending = Ok(());
        let mut header = None;
        let work = |case: &&RawValue, interrupt: &AtomicBool| {
            let tree = json::parse(case.get().as_bytes()).map_err(ApiError::CaseNotJson)?;
            self.answer(tree, interrupt)
        };
        compute::in_order(cases, work, |index, answer| {
            bar.inc(1);
            let answer = match self.format {
                Format::Csv => answer.and_then(|csv| table(index, &csv, &mut header)),
                _ => answer,
            };
            if let Err(error) = &answer {
                let place = format!("{}: case {index}{}", self.place, name(cases[index]));
                bar.suspend(|| tell(&told(&place, error)));
                ending = Err(Failure::Case);
            }
            let lines = match (answer, self.format) {
                (Ok(table), Format::Csv) => table,
                (Err(_), Format::Csv) => return ControlFlow::Continue(()),
                (Ok(line), _) => with_line_end(line),
                (Err(error), _) => with_line_end(error.problem().to_json()),
            };
            match output.write(&lines) {
                Ok(true) => ControlFlow::Continue(()),
                Ok(false) => ControlFlow::Break(()),
                Err(failure) => {
                    ending = Err(failure);
                    ControlFlow::Break(())
                }
            }
        });
        bar.finish_and_clear();
        ending
    }

    fn answer(&self, tree: Value, interrupt: &dyn Interrupt) -> Result<Vec<u8>, ApiError> {
        (self.answer)(tree, self.format, self.row_limit, interrupt).map(|answer| answer.body)
    }

    fn failed(&self, error: &ApiError) -> Failure {
        tell(&told(&self.place, error));
        Failure::Case
    }
}

/// A bar on standard error, where that is a terminal and the results go elsewhere.
fn progress(count: usize, output: &Output) -> ProgressBar {
    if matches!(output, Output::Standard) && io::stdout().is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos} of {len} cases, {eta} to go");
    ProgressBar::new(count as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// A problem document for people: its title and detail, and a line a fault.
fn told(place: &str, error: &ApiError) -> String {
    let problem = error.problem();
    let fault = |FieldError { pointer, detail }: &FieldError| {
        if pointer.is_empty() { format!("  {detail}\n") } else { format!("  {pointer}: {detail}\n") }
    };
    let faults: String = problem.errors.iter().map(fault).collect();
    format!("reentry: {place}: {}: {}\n{faults}", problem.title, problem.detail)
}

/// The name of a case, if it has one, quoted.
fn name(case: &RawValue) -> String {
    let tree = json::parse(case.get().as_bytes()).unwrap_or_default();
    tree["name"].as_str().map_or_else(String::new, |name| format!(" {name:?}"))
}

pub(super) fn with_line_end(mut text: Vec<u8>) -> Vec<u8> {
    if !text.ends_with(b"\n") {
        text.push(b'\n');
    }
    text
}

/// The lines of a case with its index before them, the header, once it is written, on the first of all tables alone.
///
/// # Errors
/// When the case has other columns than those before it.
fn table(index: usize, csv: &[u8], header: &mut Option<Vec<u8>>) -> Result<Vec<u8>, ApiError> {
    let mut table = Vec::with_capacity(csv.len() + csv.len() / 16);
    let mut lines = csv.split_inclusive(|byte| *byte == b'\n');
    let names = lines.next().unwrap_or_default();
    match header {
        Some(written) if *written != names => {
            let detail =
                "must be the same in every case of a table: the models of this case have other columns than the first";
            return Err(ApiError::Invalid(vec![Fault::new("/output/columns", detail)]));
        }
        Some(_) => {}
        None => {
            table.extend_from_slice(b"case,");
            table.extend_from_slice(names);
            *header = Some(names.to_owned());
        }
    }
    let start = format!("{index},");
    for line in lines {
        table.extend_from_slice(start.as_bytes());
        table.extend_from_slice(line);
    }
    Ok(table)
}

#[cfg(test)]
mod tests {
    use super::{table, told};
    use crate::error::ApiError;
    use crate::wire::reader::Fault;

    #[test]
    fn tables_become_one_table() {
        let mut header = None;
        let mut line = |index, csv: &[u8]| table(index, csv, &mut header).ok();
        let first = line(0, b"time,speed\n0.0,7.0\n1.0,6.0\n");
        assert_eq!(first.as_deref(), Some(&b"case,time,speed\n0,0.0,7.0\n0,1.0,6.0\n"[..]));
        assert_eq!(line(12, b"time,speed\n0.0,7.0\n").as_deref(), Some(&b"12,0.0,7.0\n"[..]));
        assert_eq!(line(13, b"time,mach\n0.0,7.0\n"), None);
    }

    #[test]
    fn a_problem_is_told_with_a_line_a_fault() {
        let faults = vec![Fault::new("/vehicle/mass", "is required"), Fault::new("", "must be an object, got null")];
        let expected = "reentry: case.json: Not a valid case: the request has 2 faults\n  \
                        /vehicle/mass: is required\n  must be an object, got null\n";
        assert_eq!(told("case.json", &ApiError::Invalid(faults)), expected);
    }
}
