//! The numbers of a request by their pointers, and the request with some of them moved.

use std::cell::RefCell;

use reentry::scenario::Case;
use reentry::sensitivity::Variation;
use serde_json::{Value, json};

use super::columns::AvailableQuantities;
use super::reader::{Fault, NumberField};
use super::schema::ANGLE;
use super::shown::shown;

/// The greatest count of numbers that one request may vary: as many as [`Variation`]s.
pub const MOST_VARIED: usize = 64;

/// Parts of a request that are no part of its case: what they hold does not vary.
const OUTSIDE_THE_CASE: [&str; 11] = [
    "/solver",
    "/output",
    "/angle_unit",
    "/sensitivities",
    "/dispersions",
    "/verify",
    "/vary",
    "/limits",
    "/achieve",
    "/search",
    "/resolution",
];

/// A request whose numbers may vary.
#[derive(Clone, Debug)]
pub struct Numbers {
    /// The request, with every default filled in.
    tree: Value,
    /// Those that may vary, in the order in which they were read.
    fields: Vec<NumberField>,
    /// How many numbers the request has.
    count: usize,
    /// The case as it flies, if it does.
    case: Option<Case>,
    /// Reads a request: its case, and what is known of its flight.
    read: fn(Value) -> Option<(AvailableQuantities, Case)>,
}

/// Numbers that vary.
#[derive(Clone, Debug)]
pub struct Varied {
    /// How they are moved.
    pub variation: Variation,
    /// What is known of the flights in which they are moved, by the variable.
    pub known: Vec<(f64, AvailableQuantities)>,
}

/// How a number moves with a variable that is 0 where the number has its own value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// The variable is added.
    Offset,
    /// The number is multiplied by 1 and the variable.
    Factor,
}

impl Numbers {
    /// The numbers of a sound request, in which every default is filled in, to which some pointers lead; its case, and a function that reads
    /// such requests.
    pub fn new(
        tree: Value,
        mut fields: Vec<NumberField>,
        pointers: &[&str],
        case: Option<Case>,
        read: fn(Value) -> Option<(AvailableQuantities, Case)>,
    ) -> Self {
        let count = fields.len();
        fields.retain(|field| pointers.iter().any(|pointer| leads_to(pointer, field)));
        Self { tree, fields, count, case, read }
    }

    /// The bytes that the variations take in memory, at most.
    pub fn bytes(&self) -> usize {
        let numbers = self.fields.len().min(MOST_VARIED);
        let of_tables = self.fields.iter().filter(|field| is_of_table(&field.pointer)).count().min(numbers);
        let of_case = size_of::<Case>()
            + self.case.as_ref().map_or(0, |case| case.events.len()) * size_of::<reentry::event::Event>();
        CASES * (numbers * of_case + of_tables * self.count * OF_NUMBER)
    }

    /// The numbers to which a pointer points: one, or all of a list.
    ///
    /// # Errors
    /// With what is wrong with the pointer.
    pub fn at(&self, pointer: &str) -> Result<Vec<&NumberField>, String> {
        let is_below =
            |part: &&&str| pointer.strip_prefix(**part).is_some_and(|rest| rest.is_empty() || rest.starts_with('/'));
        if let Some(part) = OUTSIDE_THE_CASE.iter().find(is_below) {
            return Err(format!("must not point into {part}, which is not part of the simulated case"));
        }
        let found: Vec<_> = self.fields.iter().filter(|field| leads_to(pointer, field)).collect();
        if !found.is_empty() {
            return Ok(found);
        }
        let got = match self.tree.pointer(pointer) {
            Some(Value::Object(_)) => "an object".to_owned(),
            Some(other) => shown(other),
            None => "nothing".to_owned(),
        };
        Err(format!("must point to a number of the case, or to a list of numbers, got {got}"))
    }

    /// How many numbers these pointers lead to, and what is wrong with the pointers, each given with where it stands in the request: it leads to
    /// no number, or to one to which a pointer before it leads.
    pub(super) fn faults<'p>(&self, places: impl Iterator<Item = (String, &'p String)>) -> (usize, Vec<Fault>) {
        let mut faults = Vec::new();
        let mut seen: Vec<&str> = Vec::new();
        for (at, pointer) in places {
            match self.at(pointer) {
                Err(detail) => faults.push(Fault::new(at, detail)),
                Ok(fields) => {
                    if let Some(twice) = fields.iter().find(|field| seen.contains(&field.pointer.as_str())) {
                        faults.push(Fault::new(at, format!("{} is given twice", twice.pointer)));
                    }
                    seen.extend(fields.iter().map(|field| field.pointer.as_str()));
                }
            }
        }
        (seen.len(), faults)
    }

    /// The value of a number, in the unit of the request.
    pub fn value(&self, field: &NumberField) -> f64 {
        self.tree.pointer(&field.pointer).and_then(Value::as_f64).unwrap_or_default()
    }

    /// The case with numbers moved by the same variable, and what is known of its flight; none where that is no sound request.
    fn moved(&self, fields: &[&NumberField], change: Change, by: f64) -> Option<(AvailableQuantities, Case)> {
        let mut tree = self.tree.clone();
        for field in fields {
            let number = tree.pointer_mut(&field.pointer)?;
            let value = number.as_f64()?;
            *number = json!(match change {
                Change::Offset => value + by,
                Change::Factor => value * (1.0 + by),
            });
        }
        (self.read)(tree)
    }

    /// The variation that moves numbers together; none where they cannot be moved at all.
    pub fn variation(&self, fields: &[&NumberField], change: Change) -> Option<Varied> {
        let size = match change {
            Change::Factor => 1.0,
            Change::Offset => fields.iter().map(|field| self.size(field)).fold(0.0, f64::max),
        };
        let known = RefCell::new(Vec::new());
        let variation = Variation::new(SMALL * size, |by| {
            let (of_moved, case) = self.moved(fields, change, by)?;
            known.borrow_mut().push((by, of_moved));
            Some(match &self.case {
                Some(as_flown) => case.sharing(as_flown),
                None => case,
            })
        });
        Some(Varied { variation: variation?, known: known.into_inner() })
    }

    /// The size of a number, to which its steps are small: its own, but that of places and motions within limits, so that differences of what
    /// an altitude is added to, a radius, are not lost in rounding. Entries of tables move by less: where one moves, the curve bends elsewhere,
    /// and its slopes are limited in other places.
    fn size(&self, field: &NumberField) -> f64 {
        let value = self.value(field).abs();
        let or_one = if value > 0.0 { value } else { 1.0 };
        let may_be_negative = field.bound.minimum < 0.0;
        match field.unit {
            "m" if is_of_table(&field.pointer) => 100.0,
            _ if is_of_table(&field.pointer) => 0.01 * or_one,
            ANGLE => 1.0,
            "m" if may_be_negative || value > 1e4 => value.clamp(1e3, 1e4),
            "m/s" if may_be_negative => value.max(10.0),
            "rad/s" if value <= 0.0 => 1e-4,
            _ => or_one,
        }
    }
}

/// The cases that a variation has.
const CASES: usize = 4;
/// What an entry takes in a table of the core, bytes: a cubic and its knot, and what is derived of it.
const OF_NUMBER: usize = 128;

/// Whether a pointer leads to a number: it is that of the number, or of a list that has it.
fn leads_to(pointer: &str, field: &NumberField) -> bool {
    match field.pointer.strip_prefix(pointer) {
        Some("") => true,
        Some(rest) => rest.starts_with('/') && rest.chars().all(|char| char == '/' || char.is_ascii_digit()),
        None => false,
    }
}

/// Whether the number of a pointer is an entry of a table, and not of a vector.
fn is_of_table(pointer: &str) -> bool {
    let of_vector = ["/position/", "/velocity/", "/direction/"].iter().any(|vector| pointer.contains(vector));
    let is_entry = pointer.rsplit('/').next().is_some_and(|last| last.chars().all(|char| char.is_ascii_digit()));
    is_entry && !of_vector
}

/// Why a number has no variation.
pub fn immovable(pointer: &str) -> String {
    format!("the number at {pointer} cannot be varied: with a slightly different value the case is not valid")
}

/// A step that is small to a number, in parts of its size: differences of fourth order are then exact to some twelve digits.
const SMALL: f64 = 1e-3;
