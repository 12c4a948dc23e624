//! Numbers of a case that vary within ranges, and the case with them moved.

use std::cell::RefCell;

use reentry::scenario::{Bound, Scenario};
use reentry::sensitivity::Variation;
use reentry::solve::target::Number;
use serde_json::{Value, json};

use super::AngleUnit;
use super::columns::AvailableQuantities;
use super::description::{self, Object};
use super::numbers::{Numbers, Varied};
use super::reader::{Fault, NumberField};
use super::scenario::{SimulateRequest, simulate_request};
use super::schema::ANGLE;

/// The greatest count of numbers that a search varies.
pub const MOST_IN_SEARCH: usize = 8;

/// A number of the case, or the numbers of a list, as a request has them vary.
#[derive(Clone, Debug)]
pub struct Vary {
    pointer: String,
    between: [f64; 2],
    scale: Option<f64>,
    also: Vec<Along>,
}

/// A number that goes along with one that varies.
#[derive(Clone, Debug)]
struct Along {
    pointer: String,
    factor: f64,
}

/// A number of the case that varies, in the unit of the request.
#[derive(Clone, Debug, PartialEq)]
pub struct VariedNumber {
    /// Its pointer.
    pub pointer: String,
    /// The least and the greatest value.
    pub between: [f64; 2],
    /// The change that matters.
    pub scale: f64,
    /// The case's own value.
    pub start: f64,
    /// Whether it is an angle over a full turn, whose ends are the same.
    pub is_cyclic: bool,
    /// The numbers that go along, each with its factor.
    also: Vec<(String, f64)>,
}

/// A number that varies, of a request.
pub(super) fn vary(object: &mut Object) -> Option<Vary> {
    object.named("VariedNumber", "Number of the case that varies within a range.");
    let pointer = object
        .field("pointer", "Parameter")
        .doc(
            "JSON pointer of a number of the case as `echo` shows it, defaults included, or of a list of numbers, each \
             of which then varies.",
        )
        .text();
    let between = object
        .field("between", "Range")
        .doc(
            "Least and greatest value, in the unit of the number; both belong to the range. It must contain the case's \
             own value. An angle over exactly a full turn wraps.",
        )
        .ascending()
        .numbers(Bound::FINITE, [2, 2]);
    let scale = object
        .field("scale", "Scale")
        .doc("Change of the number that matters; the default is the width of the range.")
        .optional()
        .number(Bound::POSITIVE);
    let also = object
        .field("also", "Coupled numbers")
        .doc("Other numbers of the case that are set to this one times a factor.")
        .optional()
        .objects([0, MOST_ALONG], along);
    let between = between.and_then(|between| <[f64; 2]>::try_from(between).ok());
    Some(Vary { pointer: pointer?, between: between?, scale, also: also.unwrap_or_default() })
}

fn along(object: &mut Object) -> Option<Along> {
    object.named("CoupledNumber", "Number of the case that is set to another one times a factor.");
    let pointer = object.field("pointer", "Parameter").doc("JSON pointer of a number of the case.").text();
    let factor = object.field("factor", "Factor").doc("Factor.").default(1.0).number(Bound::FINITE);
    Some(Along { pointer: pointer?, factor: factor? })
}

/// The greatest count of numbers that go along with one.
const MOST_ALONG: usize = 64;

impl VariedNumber {
    /// As searches take it.
    pub fn number(&self) -> Number {
        let Self { between, scale, start, is_cyclic, .. } = *self;
        Number { between, scale, start, is_cyclic }
    }

    /// Whether the number of a pointer moves with it.
    pub fn moves(&self, pointer: &str) -> bool {
        self.pointer == pointer || self.also.iter().any(|(along, _)| along == pointer)
    }
}

impl Vary {
    /// The pointers of its numbers.
    pub(super) fn pointers(&self) -> impl Iterator<Item = &str> {
        std::iter::once(self.pointer.as_str()).chain(self.also.iter().map(|along| along.pointer.as_str()))
    }

    /// The numbers that vary, each given with where it stands in the request.
    ///
    /// # Errors
    /// With what is wrong with the pointers and the ranges.
    pub(super) fn resolve(
        all: &[(String, &Self)],
        numbers: &Numbers,
        unit: AngleUnit,
    ) -> Result<Vec<VariedNumber>, Vec<Fault>> {
        let of_pointers = all.iter().flat_map(|(place, vary)| {
            let along = vary.also.iter().enumerate();
            let along = along.map(move |(index, along)| (format!("{place}/also/{index}/pointer"), &along.pointer));
            std::iter::once((format!("{place}/pointer"), &vary.pointer)).chain(along)
        });
        let (_, mut faults) = numbers.faults(of_pointers);
        let mut resolved = Vec::new();
        for (place, vary) in all {
            for field in numbers.at(&vary.pointer).unwrap_or_default() {
                match vary.range_fault(place, field, numbers.value(field), unit) {
                    Some(fault) => faults.push(fault),
                    None => resolved.push(vary.number(field, numbers, unit)),
                }
            }
            for (index, along) in vary.also.iter().enumerate() {
                let fields = numbers.at(&along.pointer).unwrap_or_default();
                faults.extend(fields.iter().find_map(|field| {
                    let bound = bound(field, unit);
                    let reached = vary.between.map(|end| along.factor * end);
                    let beyond = reached.into_iter().find(|value| !bound.admits(*value))?;
                    let detail = format!("takes {} out of its range: {}", field.pointer, bound.refusal(beyond));
                    Some(Fault::new(format!("{place}/also/{index}/factor"), detail))
                }));
            }
        }
        if faults.is_empty() { Ok(resolved) } else { Err(faults) }
    }

    /// What is wrong with the range of a number of this value.
    fn range_fault(&self, place: &str, field: &NumberField, value: f64, unit: AngleUnit) -> Option<Fault> {
        let bound = bound(field, unit);
        let beyond = self.between.iter().enumerate().find(|(_, end)| !bound.admits(**end));
        if let Some((index, end)) = beyond {
            return Some(Fault::new(format!("{place}/between/{index}"), bound.refusal(*end)));
        }
        let [least, greatest] = self.between;
        if !(greatest - least).is_finite() {
            return Some(Fault::new(
                format!("{place}/between"),
                "must have a width that a floating-point number holds",
            ));
        }
        let detail =
            format!("must contain the value of {} in the case, {value}, got {least} to {greatest}", field.pointer);
        let is_outside = value < least || value > greatest;
        is_outside.then(|| Fault::new(format!("{place}/between"), detail))
    }

    fn number(&self, field: &NumberField, numbers: &Numbers, unit: AngleUnit) -> VariedNumber {
        let [least, greatest] = self.between;
        let turn = unit.from_radians(std::f64::consts::TAU);
        let may_turn = field.unit == ANGLE && field.bound.minimum <= -Bound::TURN.maximum;
        let along = |along: &Along| {
            let fields = numbers.at(&along.pointer).unwrap_or_default();
            fields.into_iter().map(|field| (field.pointer.clone(), along.factor)).collect::<Vec<_>>()
        };
        VariedNumber {
            pointer: field.pointer.clone(),
            between: self.between,
            scale: self.scale.unwrap_or(greatest - least),
            start: numbers.value(field),
            is_cyclic: may_turn && (greatest - least - turn).abs() <= ROUNDING * turn,
            also: self.also.iter().flat_map(along).collect(),
        }
    }
}

/// A full turn may be off by this part, by rounding.
const ROUNDING: f64 = 1e-12;

/// The step of a variation, in parts of the range: differences of fourth order then are exact to some ten digits.
const STEP: f64 = 1e-3;

/// The values that a number may have in the unit of the request.
pub(super) fn bound(field: &NumberField, unit: AngleUnit) -> Bound {
    if field.unit == ANGLE { field.bound.scaled(unit.from_radians(1.0)) } else { field.bound }
}

/// A case whose numbers are set, time and again.
#[derive(Clone, Debug)]
pub struct MovingCase {
    /// A request of /simulate with every default.
    tree: Value,
    varied: Vec<VariedNumber>,
}

impl MovingCase {
    /// A sound request of `/simulate` in which every default is filled in, and the numbers that vary.
    pub fn new(tree: Value, varied: Vec<VariedNumber>) -> Self {
        Self { tree, varied }
    }

    /// The same case with other numbers set for good.
    #[must_use]
    pub fn with(&self, numbers: &[(String, f64)]) -> Self {
        let mut moving = self.clone();
        for (pointer, value) in numbers {
            set(&mut moving.tree, pointer, *value);
        }
        moving
    }

    /// The numbers that vary.
    pub fn varied(&self) -> &[VariedNumber] {
        &self.varied
    }

    /// The request with the numbers set.
    pub fn request(&mut self, values: &[f64]) -> &Value {
        for (number, value) in self.varied.iter().zip(values) {
            set(&mut self.tree, &number.pointer, *value);
            for (pointer, factor) in &number.also {
                set(&mut self.tree, pointer, factor * value);
            }
        }
        &self.tree
    }

    /// The case with the numbers set, as a request.
    ///
    /// # Errors
    /// With what is wrong with it: across fields, since each number is within its range.
    pub fn read(&mut self, values: &[f64]) -> Result<(SimulateRequest, Scenario), Vec<Fault>> {
        self.request(values);
        // It has every default: nothing is filled in.
        let request = description::read(&mut self.tree, simulate_request)?;
        let scenario = request.try_into_scenario()?;
        Ok((request, scenario))
    }

    /// How the flight with the numbers set depends on each of them: none of one with which the case cannot be moved.
    pub fn variations(&mut self, values: &[f64]) -> Vec<Option<Varied>> {
        let as_flown = self.read(values).ok().map(|(_, scenario)| scenario.case().clone());
        let widths: Vec<_> = self.varied.iter().map(|number| number.between[1] - number.between[0]).collect();
        let moving = RefCell::new(self);
        let variation = |(number, width): (usize, f64)| {
            let known = RefCell::new(Vec::new());
            let variation = Variation::new(STEP * width, |by| {
                let mut moved = values.to_vec();
                moved[number] += by;
                let (request, scenario) = moving.borrow_mut().read(&moved).ok()?;
                known.borrow_mut().push((by, request.known()));
                let case = scenario.case().clone();
                Some(match &as_flown {
                    Some(as_flown) => case.sharing(as_flown),
                    None => case,
                })
            });
            Some(Varied { variation: variation?, known: known.into_inner() })
        };
        widths.into_iter().enumerate().map(variation).collect()
    }

    /// What flies with the numbers set, and what is known of it; none where that is no sound case.
    pub fn scenario(&mut self, values: &[f64]) -> Option<(AvailableQuantities, Scenario)> {
        self.read(values).ok().map(|(request, scenario)| (request.known(), scenario))
    }
}

fn set(tree: &mut Value, pointer: &str, value: f64) {
    if let Some(number) = tree.pointer_mut(pointer) {
        *number = json!(value);
    }
}
