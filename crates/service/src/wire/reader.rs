//! Reads a JSON tree field by field, notes every fault with its pointer, and fills in defaults.

mod values;

pub use values::{boolean, kind_of, text};

use reentry::number_text::apart;
use reentry::scenario::Bound;
use serde_json::{Map, Value};

use super::AngleUnit;
use super::schema::ANGLE;
use super::shown::shown;
use values::{bounded, bounded_angle, chosen, whole, wrong_count};

/// A number for all entries of a table, or one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum NumberOrList {
    /// For all.
    Number(f64),
    /// For each.
    List(Vec<f64>),
}

impl NumberOrList {
    /// One for each of so many entries.
    pub fn spread(&self, count: usize) -> Vec<f64> {
        match self {
            Self::Number(number) => vec![*number; count],
            Self::List(list) => list.clone(),
        }
    }
}

/// Something wrong with one field.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault {
    /// The field, as a JSON pointer (RFC 6901).
    pub pointer: String,
    /// What is wrong, and what would be right.
    pub detail: String,
}

impl Fault {
    /// A fault of the field at the pointer.
    pub fn new(pointer: impl Into<String>, detail: impl Into<String>) -> Self {
        Self { pointer: pointer.into(), detail: detail.into() }
    }
}

/// Reads a whole request, an object, with the given function; the tree then holds every default as well.
///
/// # Errors
/// With every fault that was found.
pub fn read<T>(tree: &mut Value, read: impl FnOnce(&mut ObjectReader) -> Option<T>) -> Result<T, Vec<Fault>> {
    read_in(Context::default(), tree, read).map(|(request, _)| request)
}

/// Reads a whole request as [`read`] does, and lists its numbers, defaults included, in the order in which they are read.
///
/// # Errors
/// With every fault that was found.
pub fn read_with_numbers<T>(
    tree: &mut Value,
    read: impl FnOnce(&mut ObjectReader) -> Option<T>,
) -> Result<(T, Vec<NumberField>), Vec<Fault>> {
    read_in(Context { numbers: Some(Vec::new()), ..Context::default() }, tree, read)
}

fn read_in<T>(
    mut context: Context,
    tree: &mut Value,
    read: impl FnOnce(&mut ObjectReader) -> Option<T>,
) -> Result<(T, Vec<NumberField>), Vec<Fault>> {
    let result = object(tree, String::new(), &mut context, read);
    match result {
        Some(request) if context.faults.is_empty() => Ok((request, context.numbers.unwrap_or_default())),
        _ => Err(context.faults),
    }
}

/// A number of a request.
#[derive(Clone, Debug, PartialEq)]
pub struct NumberField {
    /// The number's place, as a JSON pointer (RFC 6901); that of an entry of a list has its index.
    pub pointer: String,
    /// The values that it may have; those of an angle are in radians.
    pub bound: Bound,
    /// The unit; of an angle [`ANGLE`], of a pure number empty.
    pub unit: &'static str,
}

/// Faults of a request that are told; a list of numbers can have half a million of them. One more is noted, which says that there are more.
pub const MOST_FAULTS: usize = 100;

/// The greatest number of entries of a list in a model: a table, a schedule, layers.
pub const MOST_ENTRIES: usize = 10_000;

/// The greatest number of rows of a matrix.
pub const MOST_ROWS: usize = 100;

/// The greatest number of columns of a matrix.
pub const MOST_COLUMNS: usize = 1000;

/// What all objects of a request share.
#[derive(Default)]
struct Context {
    faults: Vec<Fault>,
    /// The numbers that were read; none where nobody asks for them.
    numbers: Option<Vec<NumberField>>,
    /// None where the request's own unit is faulty: the range of an angle is then unknown.
    unit: Option<AngleUnit>,
    /// Whether an angle other than 0 was read.
    turns: bool,
}

impl Context {
    fn note(&mut self, pointer: String, detail: String) {
        if !self.has_enough() {
            self.faults.push(Fault { pointer, detail });
        }
    }

    /// Whether further faults need not be looked for.
    fn has_enough(&self) -> bool {
        self.faults.len() > MOST_FAULTS
    }
}

/// An object of the request, being read. Every method that finds a fault notes it and returns `None`.
pub struct ObjectReader<'a> {
    map: &'a mut Map<String, Value>,
    pointer: String,
    known: Vec<&'static str>,
    kind_unknown: bool,
    context: &'a mut Context,
}

fn object<T>(
    value: &mut Value,
    pointer: String,
    context: &mut Context,
    read: impl FnOnce(&mut ObjectReader) -> Option<T>,
) -> Option<T> {
    let kind = kind_of(value);
    let Value::Object(map) = value else {
        context.note(pointer, format!("must be an object, got {kind}"));
        return None;
    };
    let mut object = ObjectReader { map, pointer, known: Vec::new(), kind_unknown: false, context };
    let result = read(&mut object);
    object.refuse_unknown_fields();
    result
}

impl ObjectReader<'_> {
    /// Notes a fault of this object as a whole.
    pub fn fault<T>(&mut self, detail: impl Into<String>) -> Option<T> {
        self.context.note(self.pointer.clone(), detail.into());
        None
    }

    /// Notes a fault of the field, or the element of a field, of the given relative pointer.
    pub fn fault_of(&mut self, name: &str, detail: String) {
        self.context.note(format!("{}/{name}", self.pointer), detail);
    }

    /// What a field holds, or its fault, noted.
    fn check<T>(&mut self, name: &str, value: Result<T, String>) -> Option<T> {
        value.map_err(|detail| self.fault_of(name, detail)).ok()
    }

    /// Whether the request gives the field.
    pub fn has(&mut self, name: &'static str) -> bool {
        self.known.push(name);
        self.map.contains_key(name)
    }

    /// Whether the field is given and an object.
    pub fn has_object(&self, name: &str) -> bool {
        self.map.get(name).is_some_and(Value::is_object)
    }

    /// Whether a field, given by its path through objects, is given and this word.
    pub fn has_word(&self, path: &str, word: &str) -> bool {
        let (name, rest) = path.split_once('/').map_or((path, None), |(name, rest)| (name, Some(rest)));
        let value = self.map.get(name).and_then(|value| rest.map_or(Some(value), |rest| value.get(rest)));
        value.is_some_and(|value| value == word)
    }

    /// Gives a field its default.
    pub fn fill(&mut self, name: &'static str, default: Value) {
        if !self.map.contains_key(name) {
            self.map.insert(name.to_owned(), default);
        }
    }

    /// A field that must be given.
    pub fn required(&mut self, name: &'static str) -> Option<&Value> {
        if !self.has(name) {
            self.fault_of(name, "is required".to_owned());
        }
        self.map.get(name)
    }

    /// Notes a fault unless exactly one of the fields is given, which it returns.
    pub fn exactly_one(&mut self, names: &[&'static str]) -> Option<&'static str> {
        let given: Vec<_> = names.iter().copied().filter(|name| self.has(name)).collect();
        if let [name] = given[..] {
            return Some(name);
        }
        let got = if given.is_empty() { "none of them".to_owned() } else { given.join(" and ") };
        self.fault(format!("must have exactly one of {}, got {got}", names.join(", ")))
    }

    /// The unit of the request's angles, of which all are that are read after it; none where it is faulty.
    pub fn set_angle_unit(&mut self, unit: Option<AngleUnit>) {
        self.context.unit = unit;
    }

    /// The unit of the request's angles, where it is sound.
    pub fn angle_unit(&self) -> Option<AngleUnit> {
        self.context.unit
    }

    /// Whether an angle other than 0 was read so far.
    pub fn turns(&self) -> bool {
        self.context.turns
    }

    /// Something that has its own reader.
    pub fn value<T>(&mut self, name: &'static str, read: impl FnOnce(&Value) -> Result<T, String>) -> Option<T> {
        let value = read(self.required(name)?);
        self.check(name, value)
    }

    /// A number.
    pub fn number(&mut self, name: &'static str, bound: Bound, unit: &'static str) -> Option<f64> {
        let number = self.value(name, |value| bounded(value, bound))?;
        self.list_number(name, bound, unit);
        Some(number)
    }

    /// An angle in the request's unit; the bound is in radians.
    pub fn angle(&mut self, name: &'static str, bound: Bound) -> Option<f64> {
        let unit = self.context.unit;
        let angle = self.value(name, |value| bounded_angle(value, bound, unit))?;
        self.context.turns |= angle != 0.0;
        self.list_number(name, bound, ANGLE);
        Some(angle)
    }

    /// An angle in radians; so is the bound.
    pub fn radians(&mut self, name: &'static str, bound: Bound) -> Option<f64> {
        let angle = self.angle(name, bound)?;
        self.context.unit.map(|unit| unit.to_radians(angle))
    }

    /// A whole number between two.
    pub fn whole_number(&mut self, name: &'static str, [least, most]: [usize; 2]) -> Option<usize> {
        self.value(name, |value| {
            let number = value.as_number().ok_or_else(|| format!("must be a whole number, got {}", kind_of(value)))?;
            whole(number).filter(|number| (least..=most).contains(number)).ok_or_else(|| {
                let which = match most {
                    usize::MAX => format!("of at least {least}"),
                    _ => format!("between {least} and {most}"),
                };
                format!("must be a whole number {which}, got {}", shown(value))
            })
        })
    }

    /// One of several words, by its index.
    pub fn word(&mut self, name: &'static str, words: &[&str]) -> Option<usize> {
        let expected = || format!("must be one of {}", words.join(", "));
        let chosen = match self.map.get(name) {
            None => Err(format!("is required; it {}", expected())),
            Some(value) => chosen(value, words).map_err(|got| format!("{}, got {got}", expected())),
        };
        self.known.push(name);
        self.kind_unknown |= chosen.is_err() && (name == "type" || name == "model");
        self.check(name, chosen)
    }

    /// The only word that may stand in place of an object; its index is 0.
    pub fn only_word(&mut self, name: &'static str, word: &str) -> Option<usize> {
        self.value(name, |value| {
            chosen(value, &[word]).map_err(|got| format!("must be {word:?} or an object, got {got}"))
        })
    }

    /// Words out of several, one or more, none of them twice, by their indices.
    pub fn words(&mut self, name: &'static str, words: &[&str]) -> Option<Vec<usize>> {
        let expected = words.join(", ");
        let read =
            |element: &Value| chosen(element, words).map_err(|got| format!("must be one of {expected}, got {got}"));
        let chosen = self.list(name, [1, words.len()], "names", read)?;
        let mut sound = true;
        for (index, choice) in chosen.iter().enumerate() {
            if chosen[..index].contains(choice) {
                self.fault_of(&format!("{name}/{index}"), format!("{} is given twice", words[*choice]));
                sound = false;
            }
        }
        sound.then_some(chosen)
    }

    /// Strings, so many at most.
    pub fn strings(&mut self, name: &'static str, most: usize) -> Option<Vec<String>> {
        self.list(name, [0, most], "strings", text)
    }

    /// Numbers, so many at least and at most.
    pub fn numbers(
        &mut self,
        name: &'static str,
        bound: Bound,
        counts: [usize; 2],
        unit: &'static str,
    ) -> Option<Vec<f64>> {
        let numbers = self.list(name, counts, "numbers", |element| bounded(element, bound))?;
        self.list_numbers(name, numbers.len(), bound, unit);
        Some(numbers)
    }

    /// Numbers by names.
    pub fn numbers_by_name(&mut self, name: &'static str, bound: Bound) -> Option<Vec<(String, f64)>> {
        let value = self.required(name)?;
        let kind = kind_of(value);
        let Value::Object(map) = value else {
            return self.check(name, Err(format!("must be an object of numbers, got {kind}")));
        };
        let read = map.iter().map(|(key, value)| (key.clone(), bounded(value, bound))).collect::<Vec<_>>();
        let count = read.len();
        let mut numbers = Vec::new();
        for (key, number) in read {
            let place = format!("{name}/{}", key.replace('~', "~0").replace('/', "~1"));
            match number {
                Ok(number) => {
                    self.list_number(&place, bound, "");
                    numbers.push((key, number));
                }
                Err(detail) => self.fault_of(&place, detail),
            }
        }
        (numbers.len() == count).then_some(numbers)
    }

    /// Angles in the request's unit, so many at least and at most; the bound is in radians.
    pub fn angles(&mut self, name: &'static str, bound: Bound, counts: [usize; 2]) -> Option<Vec<f64>> {
        let unit = self.context.unit;
        let angles = self.list(name, counts, "numbers", |element| bounded_angle(element, bound, unit))?;
        self.context.turns |= angles.iter().any(|angle| *angle != 0.0);
        self.list_numbers(name, angles.len(), bound, ANGLE);
        Some(angles)
    }

    /// A vector of three numbers.
    pub fn vector(&mut self, name: &'static str, bound: Bound, unit: &'static str) -> Option<[f64; 3]> {
        if let Some(count) = self.count(name).filter(|count| *count != 3) {
            self.fault_of(name, format!("must have 3 numbers, got {count}"));
        }
        self.numbers(name, bound, [0, usize::MAX], unit)?.try_into().ok()
    }

    /// Rows of numbers, one or more, in each as many as there are in the list `along`, where there is one.
    pub fn matrix(
        &mut self,
        name: &'static str,
        bound: Bound,
        along: &str,
        unit: &'static str,
    ) -> Option<Vec<Vec<f64>>> {
        let columns = self.count(along);
        let value = self.required(name)?;
        let kind = kind_of(value);
        let Value::Array(rows) = value else {
            return self.check(name, Err(format!("must be an array of arrays of numbers, got {kind}")));
        };
        if let Some(detail) = wrong_count(rows.len(), [1, MOST_ROWS]) {
            return self.check(name, Err(detail));
        }
        let mut faults = Vec::new();
        let mut matrix = Vec::with_capacity(rows.len());
        for (index, row) in rows.iter().enumerate() {
            let Value::Array(elements) = row else {
                faults.push((format!("{name}/{index}"), format!("must be an array of numbers, got {}", kind_of(row))));
                continue;
            };
            let got = elements.len();
            let differs = columns.filter(|columns| *columns != got);
            let differs = differs.map(|columns| format!("must have as many numbers as {along}, {columns}, got {got}"));
            if let Some(detail) = wrong_count(got, [1, MOST_COLUMNS]).or(differs) {
                faults.push((format!("{name}/{index}"), detail));
                continue;
            }
            let mut numbers = Vec::with_capacity(got);
            for (column, element) in elements.iter().enumerate() {
                match bounded(element, bound) {
                    Ok(number) => numbers.push(number),
                    Err(detail) => faults.push((format!("{name}/{index}/{column}"), detail)),
                }
                if faults.len() > MOST_FAULTS {
                    break;
                }
            }
            matrix.push(numbers);
        }
        let sound = faults.is_empty();
        for (place, detail) in faults {
            self.fault_of(&place, detail);
        }
        for (index, row) in matrix.iter().enumerate() {
            self.list_numbers(&format!("{name}/{index}"), row.len(), bound, unit);
        }
        sound.then_some(matrix)
    }

    /// An object.
    pub fn object<T>(&mut self, name: &'static str, read: impl FnOnce(&mut ObjectReader) -> Option<T>) -> Option<T> {
        let pointer = format!("{}/{name}", self.pointer);
        self.required(name)?;
        let value = self.map.get_mut(name)?;
        object(value, pointer, self.context, read)
    }

    /// Objects, so many at least and at most.
    pub fn objects<T>(
        &mut self,
        name: &'static str,
        counts: [usize; 2],
        mut read: impl FnMut(&mut ObjectReader) -> Option<T>,
    ) -> Option<Vec<T>> {
        let value = self.required(name)?;
        let kind = kind_of(value);
        let Value::Array(elements) = value else {
            return self.check(name, Err(format!("must be an array of objects, got {kind}")));
        };
        let count = elements.len();
        if let Some(detail) = wrong_count(count, counts) {
            return self.check(name, Err(detail));
        }
        let place = format!("{}/{name}", self.pointer);
        let elements = self.map.get_mut(name).and_then(Value::as_array_mut).into_iter().flatten();
        let mut objects = Vec::new();
        for (index, element) in elements.enumerate() {
            objects.extend(object(element, format!("{place}/{index}"), self.context, &mut read));
            if self.context.has_enough() {
                break;
            }
        }
        (objects.len() == count).then_some(objects)
    }

    /// A list of so many elements at least and at most, each with its own reader.
    fn list<T>(
        &mut self,
        name: &'static str,
        counts: [usize; 2],
        what: &str,
        read: impl Fn(&Value) -> Result<T, String>,
    ) -> Option<Vec<T>> {
        let value = self.required(name)?;
        let kind = kind_of(value);
        let Value::Array(elements) = value else {
            return self.check(name, Err(format!("must be an array of {what}, got {kind}")));
        };
        let count = elements.len();
        if let Some(detail) = wrong_count(count, counts) {
            return self.check(name, Err(detail));
        }
        let mut faults = Vec::new();
        let mut list = Vec::with_capacity(count);
        for (index, element) in elements.iter().enumerate() {
            match read(element) {
                Ok(element) => list.push(element),
                Err(detail) => faults.push((index, detail)),
            }
            if faults.len() > MOST_FAULTS {
                break;
            }
        }
        for (index, detail) in faults {
            self.fault_of(&format!("{name}/{index}"), detail);
        }
        (list.len() == count).then_some(list)
    }

    /// Whether a fault of the field as a whole is noted.
    fn is_at_fault(&self, name: &str) -> bool {
        let pointer = format!("{}/{name}", self.pointer);
        self.context.faults.iter().any(|fault| fault.pointer == pointer)
    }

    /// The number of entries of a list, if the field is one.
    fn count(&self, name: &str) -> Option<usize> {
        self.map.get(name).and_then(Value::as_array).map(Vec::len)
    }

    /// Notes a fault at every list of the table whose length is not that of the first, where neither is at fault already.
    pub fn equally_long(&mut self, first: &str, others: &[&str]) -> bool {
        let mut sound = true;
        for name in others {
            let lists = [first, *name].map(|list| self.count(list).filter(|_| !self.is_at_fault(list)));
            if let [Some(expected), Some(got)] = lists
                && expected != got
            {
                self.fault_of(name, format!("must have as many entries as {first}, {expected}, got {got}"));
                sound = false;
            }
        }
        sound
    }

    /// Notes a fault at every number that is not greater than the one before it.
    ///
    /// `field` is the pointer to the number within its entry.
    pub fn ascending(&mut self, name: &'static str, field: &str, numbers: &[f64]) -> bool {
        let mut sound = true;
        for (index, pair) in numbers.windows(2).enumerate() {
            if pair[1] <= pair[0] {
                let [before, got] = apart([pair[0], pair[1]]);
                let detail = format!("must be greater than the previous entry, {before}, got {got}");
                self.fault_of(&format!("{name}/{}{field}", index + 1), detail);
                sound = false;
            }
            if self.context.has_enough() {
                break;
            }
        }
        sound
    }

    /// Lists a number that was read.
    pub fn list_number(&mut self, name: &str, bound: Bound, unit: &'static str) {
        if let Some(numbers) = &mut self.context.numbers {
            numbers.push(NumberField { pointer: format!("{}/{name}", self.pointer), bound, unit });
        }
    }

    /// Lists the numbers of a list that was read.
    fn list_numbers(&mut self, name: &str, count: usize, bound: Bound, unit: &'static str) {
        if let Some(numbers) = &mut self.context.numbers {
            let field = |index| NumberField { pointer: format!("{}/{name}/{index}", self.pointer), bound, unit };
            numbers.extend((0..count).map(field));
        }
    }

    fn refuse_unknown_fields(&mut self) {
        if self.kind_unknown {
            return;
        }
        let known = &self.known;
        let mut unknown = self.map.keys().filter(|name| !known.contains(&name.as_str())).peekable();
        if unknown.peek().is_none() {
            return;
        }
        let mut fields: Vec<_> = Vec::new();
        for name in known {
            if !fields.contains(name) {
                fields.push(*name);
            }
        }
        // The first is told the fields that there are, for all.
        let mut fields = format!("; the fields are {}", fields.join(", "));
        for name in unknown {
            let escaped = name.replace('~', "~0").replace('/', "~1");
            let detail = format!("is not a field here{}", std::mem::take(&mut fields));
            self.context.note(format!("{}/{escaped}", self.pointer), detail);
            if self.context.has_enough() {
                break;
            }
        }
    }
}
