//! `reentry simulate` and its kin: from a file with one case or many to the answers.

use std::fs;
use std::io::{self, Read};
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;

use clap::Args;
use indicatif::{ProgressBar, ProgressStyle};
use reentry::Interrupt;
use serde_json::Value;
use serde_json::value::RawValue;

use crate::answer;
use crate::cli::in_order::in_order;
use crate::cli::output::Output;
use crate::cli::{Failure, failure, tell};
use crate::config::{MOST_ROWS, processors, up_to};
use crate::error::{ApiError, FieldError};
use crate::format::Format;
use crate::wire::json;
use crate::wire::reader::Fault;
use crate::wire::shown::{quoted, shortened};

/// A file with cases, and what is to become of them.
#[derive(Args, Debug)]
pub struct Cases {
    #[command(flatten)]
    states: States,

    /// Maximum number of rows of a trajectory, at most 10000000; a row takes about 1 kB of memory
    #[arg(long, default_value_t = 1_000_000, value_parser = up_to(MOST_ROWS))]
    row_limit: usize,
}

/// A file with JSON, and where the answer goes.
#[derive(Args, Debug)]
pub struct States {
    /// File with the JSON, one object or an array of objects; - reads standard input
    file: PathBuf,

    /// Output file, in place of standard output; it is replaced only when the output is complete
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
    /// Answers every state in a format.
    ///
    /// # Errors
    /// When a state is not valid, or a file cannot be read or written.
    pub fn run(&self, format: Format, answer: impl Answer) -> Result<(), Failure> {
        Run { place: self.place(), format, row_limit: 0, answer }.all(self)
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
        let output = Output::new(states.output.as_deref());
        match json::elements(&text) {
            Ok(Some(cases)) if cases.is_empty() => {
                Err(self.failed(&ApiError::Invalid(vec![Fault::new("", "must have at least 1 case, got none")])))
            }
            Ok(Some(cases)) => match not_of_lists(self.format) {
                Some(fault) => Err(self.failed(&ApiError::Invalid(vec![fault]))),
                None => self.many(&cases, output),
            },
            Ok(None) => self.one(&text, output),
            Err(error) => Err(self.failed(&error.into())),
        }
    }

    fn one(&self, text: &[u8], mut output: Output) -> Result<(), Failure> {
        let tree = json::parse(text).map_err(|error| self.failed(&error.into()))?;
        let waiting = Waiting::new();
        let answer = self.answer(tree, &waiting);
        waiting.0.finish_and_clear();
        let answer = answer.map_err(|error| self.failed(&error))?;
        output.write(&with_line_end(answer))?;
        output.finish()
    }

    fn many(&self, cases: &[&RawValue], mut output: Output) -> Result<(), Failure> {
        let bar = progress(cases.len(), &output);
        let mut failed = 0;
        let mut header = None;
        let mut written = Ok(true);
        let work = |index: usize, case: &&RawValue, interrupt: &AtomicBool| {
            let tree = json::parse(case.get().as_bytes()).map_err(ApiError::CaseNotJson);
            let answer = tree.and_then(|tree| self.answer(tree, interrupt));
            let result = answer.map(with_line_end).map_err(|error| self.failed_case(index, case, &error));
            let bytes = result.as_ref().map_or_else(FailedCase::bytes, Vec::len);
            (result, bytes)
        };
        in_order(cases, processors(), work, |index, result| {
            bar.inc(1);
            let result = match self.format {
                Format::Csv => result.and_then(|csv| {
                    table(index, &csv, &mut header).map_err(|error| self.failed_case(index, cases[index], &error))
                }),
                _ => result,
            };
            let lines = result.unwrap_or_else(|case| {
                failed += 1;
                if failed <= MOST_CASES_TOLD {
                    bar.suspend(|| tell(&case.told));
                }
                if self.format == Format::Csv { Vec::new() } else { case.line }
            });
            if !lines.is_empty() {
                written = output.write(&lines);
            }
            if matches!(written, Ok(true)) { ControlFlow::Continue(()) } else { ControlFlow::Break(()) }
        });
        bar.finish_and_clear();
        if failed > MOST_CASES_TOLD {
            tell(&[format!("reentry: {}: {} more cases failed", self.place, failed - MOST_CASES_TOLD)]);
        }
        written?;
        output.finish()?;
        if failed == 0 { Ok(()) } else { Err(Failure::Case) }
    }

    fn answer(&self, tree: Value, interrupt: &dyn Interrupt) -> Result<Vec<u8>, ApiError> {
        let mut body = (self.answer)(tree, self.format, self.row_limit, interrupt)?.body;
        body.shrink_to_fit();
        Ok(body)
    }

    fn failed(&self, error: &ApiError) -> Failure {
        tell(&told(&self.place, error, usize::MAX));
        Failure::Case
    }

    fn failed_case(&self, index: usize, case: &RawValue, error: &ApiError) -> FailedCase {
        let place = format!("{}: case {index}{}", self.place, name(case));
        let told = told(&place, error, MOST_FAULTS_OF_A_CASE);
        FailedCase { told, line: with_line_end(error.problem().to_json()) }
    }
}

/// Why a list of cases cannot be answered in a format.
fn not_of_lists(format: Format) -> Option<Fault> {
    let detail = match format {
        Format::Kml => "must be a single case for KML, not a list: an XML document does not fit on one line",
        Format::Oem => "must be a single case for OEM, not a list: a message has the states of one object",
        Format::Json | Format::Csv | Format::Geojson | Format::Czml | Format::Ndjson | Format::Text => return None,
    };
    Some(Fault::new("", detail))
}

/// Cases of a list that are told on standard error, one by one, when they fail.
const MOST_CASES_TOLD: usize = 100;

/// Faults of a case of a list that are told there.
const MOST_FAULTS_OF_A_CASE: usize = 10;

/// Characters of a pointer that are told there: the names in it may be of any length.
const MOST_OF_A_POINTER: usize = 200;

/// What becomes of a case of a list that fails.
struct FailedCase {
    /// For people, on standard error.
    told: Vec<String>,
    /// In the place of the answer.
    line: Vec<u8>,
}

impl FailedCase {
    fn bytes(&self) -> usize {
        self.line.len() + self.told.iter().map(String::len).sum::<usize>()
    }
}

/// A bar on standard error, where that is a terminal and the results go elsewhere.
fn progress(count: usize, output: &Output) -> ProgressBar {
    if output.is_terminal() {
        return ProgressBar::hidden();
    }
    let style = ProgressStyle::with_template("{bar:40} {pos} of {len} cases, {eta} to go");
    ProgressBar::new(count as u64).with_style(style.unwrap_or_else(|_| ProgressStyle::default_bar()))
}

/// The flights of a single search so far, on standard error where that is a terminal; nobody ends it.
#[derive(Debug)]
struct Waiting(ProgressBar);

impl Waiting {
    fn new() -> Self {
        let style = ProgressStyle::with_template("{spinner} {pos} flights, {elapsed}");
        Self(ProgressBar::no_length().with_style(style.unwrap_or_else(|_| ProgressStyle::default_spinner())))
    }
}

impl Interrupt for Waiting {
    fn is_raised(&self) -> bool {
        false
    }

    fn begins_flight(&self, number: u64) {
        self.0.set_position(number);
    }
}

/// A problem document for people: its title and detail, and a line a fault, but not more than so many.
fn told(place: &str, error: &ApiError, most: usize) -> Vec<String> {
    let problem = error.problem();
    let mut lines = vec![format!("reentry: {place}: {}: {}", problem.title, problem.detail)];
    lines.extend(problem.errors.iter().take(most).map(|FieldError { pointer, detail }| {
        let pointer = shortened(pointer, MOST_OF_A_POINTER);
        if pointer.is_empty() { format!("  {detail}") } else { format!("  {pointer}: {detail}") }
    }));
    if problem.errors.len() > most {
        lines.push("  more problems; run the case alone to list them all".to_owned());
    }
    lines
}

/// The name of a case, if it has one, quoted.
fn name(case: &RawValue) -> String {
    let tree = json::parse(case.get().as_bytes()).unwrap_or_default();
    tree["name"].as_str().map_or_else(String::new, |name| format!(" {}", quoted(name)))
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
            let detail = "must be the same in all cases of a table: the models of this case have other columns than \
                          those of the first";
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
        let error = ApiError::Invalid(faults);
        let head = "reentry: case.json: Case not valid: 2 problems in the request";
        let all = [head, "  /vehicle/mass: is required", "  must be an object, got null"];
        assert_eq!(told("case.json", &error, 2), all);
        assert_eq!(told("case.json", &error, 1)[..2], all[..2]);
        assert_eq!(told("case.json", &error, 1).len(), 3);
    }
}
