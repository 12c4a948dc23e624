//! A validation for people: every check as a text, or a line a case for the guide.

use std::fmt::{self, Display, Formatter, Write};

use super::number::{self, NONE};
use super::{Check, Group, Kind, Validation, nearest};

/// The texts of a line: whether it missed, the case, the quantity, four numbers, and the number of its note.
type Line = [String; 8];

impl Validation {
    /// Every check, and below each group its sources and the reasons of what is allowed.
    pub fn to_text(&self) -> String {
        let mut text = String::new();
        for group in self.checks.chunk_by(|a, b| a.group == b.group) {
            let mut notes = Notes::default();
            let lines = group.iter().map(|check| line(check, &mut notes));
            let table = aligned(&[header(group[0].group)].into_iter().chain(lines).collect::<Vec<_>>());
            // A text takes any line.
            let _ = writeln!(text, "{}\n\n{table}\n{notes}", group[0].group.title());
        }
        text + &self.verdict() + "\n"
    }

    /// A line for each case that is a reference, with its check nearest to the limit, and one for each plausibility; then the sources.
    pub fn to_markdown(&self) -> String {
        let mut notes = Notes::default();
        let mut text = self.verdict() + "\n\n";
        let (reference, plausible): (Vec<_>, Vec<_>) =
            self.checks.iter().partition(|check| check.kind == Kind::Reference);
        text += "| case | checks | nearest to its limit | expected | got | difference | allowed | source |\n";
        text += "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
        for case in reference.chunk_by(|a, b| a.group == b.group && a.case == b.case) {
            let Some(nearest) = nearest(case.iter().copied()) else { continue };
            let [_, name, quantity, rest @ ..] = line(nearest, &mut notes);
            let _ = writeln!(text, "| {name} | {} | {quantity} | {} |", case.len(), rest.join(" | "));
        }
        text += "\n| real flight or approximation | quantity | published | got | difference | uncertainty | source |\n";
        text += "| --- | --- | --- | --- | --- | --- | --- |\n";
        for check in plausible {
            let [_, cells @ ..] = line(check, &mut notes);
            let _ = writeln!(text, "| {} |", cells.join(" | "));
        }
        text + "\n" + &notes.to_string()
    }

    /// What became of all of them, in a sentence.
    fn verdict(&self) -> String {
        let [missed, checks] =
            [self.misses().count(), self.checks.iter().filter(|check| check.passed.is_some()).count()];
        let rest = self.checks.len() - checks;
        let missed = if missed == 0 { "all passed".to_owned() } else { format!("{missed} failed") };
        format!(
            "{checks} checks against references: {missed}. {rest} comparisons with real flights and \
             approximations, for information only."
        )
    }
}

impl Group {
    fn title(self) -> &'static str {
        match self {
            Self::Thesis => "The thesis's cases",
            Self::Conversions => "The thesis's initial conditions",
            Self::Theories => "The thesis's theories compared with its flights",
            Self::CheckCases => "NASA's check cases",
            Self::StandardAir => "The U.S. Standard Atmosphere, 1976",
            Self::Frames => "Coordinates and orbital elements",
            Self::Ascents => "Launches and separations compared with closed forms",
            Self::Bodies => "Entries compared with AMAT",
            Self::Flights => "Real flights, for information only",
            Self::Corridors => "Entry corridors compared with AMAT and with Chapman's theory",
        }
    }
}

impl Check {
    /// The check as a sentence.
    pub fn told(&self) -> String {
        let [_, case, quantity, expected, got, difference, allowed, _] = line(self, &mut Notes::default());
        format!("{case}, {quantity}: expected {expected}, got {got}, difference {difference}, allowed {allowed}")
    }
}

/// What stands above the columns.
fn header(group: Group) -> Line {
    let [expected, allowed] = match group {
        Group::Flights => ["published", "uncertainty"],
        _ => ["expected", "allowed"],
    };
    ["", "case", "quantity", expected, "got", "difference", allowed, "source"].map(str::to_owned)
}

fn line<'a>(check: &'a Check, notes: &mut Notes<'a>) -> Line {
    let unit = check.unit.as_str();
    let difference = number::difference(check.difference, check.rounding, unit);
    // The first digit of what is allowed and, where nothing is, one more than the difference has.
    let step = check.allowed.filter(|_| check.kind == Kind::Reference);
    let step = step.or(check.difference.map(|difference| difference.abs() / 10.0)).unwrap_or(1.0);
    let got = match check.got {
        // A distance from what is expected.
        Some(_) if check.expected == 0.0 => difference.clone(),
        Some(got) => number::down_to(got, step, unit),
        None => NONE.to_owned(),
    };
    let expected = match check.kind {
        Kind::Reference if check.expected != 0.0 => number::down_to(check.expected, step, unit),
        _ => number::exact(check.expected, unit),
    };
    let allowed = check.allowed.map_or(NONE.to_owned(), |allowed| number::short(allowed, 3, unit));
    let mark = if check.is_miss() { "FAILED" } else { "" };
    let note = notes.number_of(check).to_string();
    [mark.to_owned(), check.case.clone(), check.quantity.clone(), expected, got, difference, allowed, note]
}

/// The sources and notes of the checks, each once, numbered from 1.
#[derive(Default)]
struct Notes<'a>(Vec<(&'a str, &'a str)>);

impl<'a> Notes<'a> {
    fn number_of(&mut self, check: &'a Check) -> usize {
        let note = (check.source.as_str(), check.note.as_str());
        let known = self.0.iter().position(|other| *other == note);
        known.unwrap_or_else(|| {
            self.0.push(note);
            self.0.len() - 1
        }) + 1
    }
}

impl Display for Notes<'_> {
    fn fmt(&self, f: &mut Formatter) -> fmt::Result {
        (1..).zip(&self.0).try_for_each(|(number, (source, note))| writeln!(f, "{number}. {source}. {note}"))
    }
}

/// Lines whose columns stand below each other, the numbers to the right.
fn aligned(lines: &[Line]) -> String {
    let width = |column: usize| lines.iter().map(|line| line[column].chars().count()).max().unwrap_or(0);
    let widths: [usize; 8] = std::array::from_fn(width);
    let mut text = String::new();
    for line in lines {
        for (column, (cell, width)) in line.iter().zip(widths).enumerate().filter(|(_, (_, width))| *width > 0) {
            // A text takes any cell.
            let _ = if column < 3 { write!(text, "{cell:<width$}  ") } else { write!(text, "{cell:>width$}  ") };
        }
        text.truncate(text.trim_end().len());
        text.push('\n');
    }
    text
}
