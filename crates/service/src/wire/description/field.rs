//! A field of an object: what it holds.

use reentry::scenario::Bound;
use serde_json::{Value, json};

use super::words::{AngleOrObject, BooleanOrObject, WordOrObject, Words};
use super::{Mode, Object, reading};
use crate::wire::reader::{self, MOST_COLUMNS, MOST_ROWS, NumberOrList, ObjectReader};
use crate::wire::schema::{self, ANGLE, ObjectSchema, Property};

/// Whether a field must be given.
enum Need {
    Required,
    Optional,
    Default(Value),
}

/// One of a list of names, by its index, or one of others.
#[derive(Clone, Debug)]
pub enum NameOr {
    /// Its index.
    Name(usize),
    /// Without the prefix.
    Other(String),
}

/// A field of an object, to be read, or to be described. Every way to read it notes its faults, and returns `None` then, and where the field
/// is left out.
pub struct Field<'f, 'a, 'b> {
    object: &'f mut Object<'a, 'b>,
    name: &'static str,
    title: &'static str,
    doc: &'static str,
    unit: &'static str,
    need: Need,
    is_ascending: bool,
}

impl<'f, 'a, 'b> Field<'f, 'a, 'b> {
    /// A field that must be given.
    pub(super) fn new(object: &'f mut Object<'a, 'b>, name: &'static str, title: &'static str) -> Self {
        Self { object, name, title, doc: "", unit: "", need: Need::Required, is_ascending: false }
    }
    /// Describes it, for the reader of the document.
    #[must_use]
    pub fn doc(mut self, doc: &'static str) -> Self {
        self.doc = doc;
        self
    }

    /// The unit of its numbers.
    #[must_use]
    pub fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// The field may be left out.
    #[must_use]
    pub fn optional(mut self) -> Self {
        self.need = Need::Optional;
        self
    }

    /// The field may be left out, and has this value then.
    #[must_use]
    pub fn default(mut self, default: impl Into<Value>) -> Self {
        self.need = Need::Default(default.into());
        self
    }

    /// Each number of the list is greater than the one before it.
    #[must_use]
    pub fn ascending(mut self) -> Self {
        self.is_ascending = true;
        self
    }

    /// Reads the field, or writes its schema.
    fn take<T>(
        self,
        schema: impl FnOnce(&mut ObjectSchema) -> Value,
        read: impl FnOnce(&mut ObjectReader, &'static str) -> Option<T>,
    ) -> Option<T> {
        let Self { object, name, title, doc, unit, need, .. } = self;
        match &mut object.0 {
            Mode::Read(reader) => {
                match need {
                    Need::Optional if !reader.has(name) => return None,
                    Need::Default(default) => reader.fill(name, default),
                    Need::Optional | Need::Required => {}
                }
                read(reader, name)
            }
            Mode::Describe(object) => {
                let value = schema(object);
                let is_required = matches!(need, Need::Required);
                let default = if let Need::Default(default) = need { Some(default) } else { None };
                object.add(Property { name, title, doc, unit, is_required, default }, value);
                None
            }
        }
    }

    /// A number.
    pub fn number(self, bound: Bound) -> Option<f64> {
        let unit = self.unit;
        self.take(|_| schema::number(bound), |reader, name| reader.number(name, bound, unit))
    }

    /// An angle, in radians; so is the bound.
    pub fn angle(self, bound: Bound) -> Option<f64> {
        self.unit(ANGLE).take(|_| schema::number(schema::widened(bound)), |reader, name| reader.radians(name, bound))
    }

    /// An angle as the request gives it, in the request's unit, for answers that give it back; the bound is in radians.
    pub fn angle_as_given(self, bound: Bound) -> Option<f64> {
        self.unit(ANGLE).take(|_| schema::number(schema::widened(bound)), |reader, name| reader.angle(name, bound))
    }

    /// A whole number between two.
    pub fn whole_number(self, [least, most]: [usize; 2]) -> Option<usize> {
        self.take(
            |_| {
                let mut schema = json!({"type": "integer", "minimum": least});
                if most < usize::MAX {
                    schema["maximum"] = json!(most);
                }
                schema
            },
            |reader, name| reader.whole_number(name, [least, most]),
        )
    }

    /// Three numbers.
    pub fn vector(self, bound: Bound) -> Option<[f64; 3]> {
        let unit = self.unit;
        self.take(|_| schema::list(&schema::number(bound), [3, 3]), |reader, name| reader.vector(name, bound, unit))
    }

    /// Numbers, so many at least and at most.
    pub fn numbers(self, bound: Bound, counts: [usize; 2]) -> Option<Vec<f64>> {
        let (unit, is_ascending) = (self.unit, self.is_ascending);
        self.take(
            |_| schema::list(&schema::number(bound), counts),
            |reader, name| {
                reader.numbers(name, bound, counts, unit).filter(|it| !is_ascending || reader.ascending(name, "", it))
            },
        )
    }

    /// Angles, in radians, one at least and so many at most; the bound is in radians.
    pub fn angles(self, bound: Bound, most: usize) -> Option<Vec<f64>> {
        let is_ascending = self.is_ascending;
        self.unit(ANGLE).take(
            |_| schema::list(&schema::number(schema::widened(bound)), [1, most]),
            |reader, name| {
                let angles = reader.angles(name, bound, [1, most])?;
                let sound = !is_ascending || reader.ascending(name, "", &angles);
                let unit = reader.angle_unit().filter(|_| sound)?;
                Some(angles.into_iter().map(|angle| unit.to_radians(angle)).collect())
            },
        )
    }

    /// A number for all entries of a table, or a number for each.
    pub fn number_or_numbers(self, bound: Bound, counts: [usize; 2]) -> Option<NumberOrList> {
        let unit = self.unit;
        self.take(
            |schema| {
                let mut number = schema::number(Bound::FINITE);
                let mut list = schema::list(&number, [0, usize::MAX]);
                (number["description"], list["description"]) =
                    (json!("One value for all entries."), json!("One value per entry."));
                let doc = "A number for all entries of a table, or a list with one number per entry.";
                let either = json!({"oneOf": [number, list], "description": doc});
                // The keywords beside the reference are each of one of the two alone.
                let mut schema = schema.component("NumberOrList", either);
                schema::extend(&mut schema, schema::bounds(bound));
                schema::extend(&mut schema, schema::list(&schema::bounds(bound), counts));
                if let Some(schema) = schema.as_object_mut() {
                    schema.shift_remove("type");
                }
                schema
            },
            |reader, name| match reader.required(name)? {
                Value::Number(_) => reader.number(name, bound, unit).map(NumberOrList::Number),
                Value::Array(_) => reader.numbers(name, bound, counts, unit).map(NumberOrList::List),
                other => {
                    let detail = format!("must be a number or an array of numbers, got {}", reader::kind_of(other));
                    reader.fault_of(name, detail);
                    None
                }
            },
        )
    }

    /// Rows of numbers, one or more, in each as many as there are in the list `along`.
    pub fn matrix(self, bound: Bound, along: &'static str) -> Option<Vec<Vec<f64>>> {
        let unit = self.unit;
        self.take(
            |_| schema::list(&schema::list(&schema::number(bound), [1, MOST_COLUMNS]), [1, MOST_ROWS]),
            |reader, name| reader.matrix(name, bound, along, unit),
        )
    }

    /// Text.
    pub fn text(self) -> Option<String> {
        self.value(|| json!({"type": "string"}), reader::text)
    }

    /// Texts, so many at most.
    pub fn texts(self, most: usize) -> Option<Vec<String>> {
        self.take(|_| schema::list(&json!({"type": "string"}), [0, most]), |reader, name| reader.strings(name, most))
    }

    /// Text, or texts, one or more and so many at most.
    pub fn text_or_texts(self, most: usize) -> Option<Vec<String>> {
        let texts = || schema::list(&json!({"type": "string"}), [1, most]);
        self.take(
            |_| json!({"oneOf": [{"type": "string"}, texts()]}),
            |reader, name| match reader.required(name)? {
                Value::String(text) => Some(vec![text.clone()]),
                Value::Array(_) => reader.strings(name, most),
                other => {
                    let detail = format!("must be a string or an array of strings, got {}", reader::kind_of(other));
                    reader.fault_of(name, detail);
                    None
                }
            },
        )
    }

    /// True or false.
    pub fn boolean(self) -> Option<bool> {
        self.value(|| json!({"type": "boolean"}), reader::boolean)
    }

    /// This word, and no other.
    pub fn constant(self, word: &'static str) -> Option<()> {
        self.take(|_| schema::words(&[word]), |reader, name| reader.word(name, &[word]).map(|_| ()))
    }

    /// One of several words.
    pub fn word<T: Copy>(self, words: &Words<T>) -> Option<T> {
        self.take(
            |schema| words.component(schema),
            |reader, name| reader.word(name, &words.all()).map(|chosen| words.words[chosen].meaning),
        )
    }

    /// Words out of several, one or more, none of them twice.
    pub fn several<T: Copy>(self, words: &Words<T>) -> Option<Vec<T>> {
        self.take(
            |schema| {
                let mut list = schema::list(&words.component(schema), [1, words.words.len()]);
                list["uniqueItems"] = json!(true);
                list
            },
            |reader, name| {
                let chosen = reader.words(name, &words.all())?;
                Some(chosen.into_iter().map(|index| words.words[index].meaning).collect())
            },
        )
    }

    /// One of several names; its index.
    pub fn name(self, names: &[&'static str]) -> Option<usize> {
        self.take(|_| schema::words(names), |reader, name| reader.word(name, names))
    }

    /// Names out of several, or others after a prefix; one or more, none of them twice.
    pub fn names_or(self, names: &[&'static str], prefix: &str, others: &[String]) -> Option<Vec<NameOr>> {
        let schema = || {
            let other = json!({"type": "string", "pattern": format!("^{}", prefix.replace('.', "\\."))});
            // Generated clients call it so.
            let mut listed = schema::words(names);
            listed["title"] = json!("Column");
            let mut list = schema::list(&json!({"anyOf": [listed, other]}), [1, usize::MAX]);
            list["uniqueItems"] = json!(true);
            list
        };
        let with_prefix = others.iter().map(|other| format!("{prefix}{other}"));
        let all: Vec<_> = names.iter().map(|name| (*name).to_owned()).chain(with_prefix).collect();
        let all: Vec<_> = all.iter().map(String::as_str).collect();
        let chosen = self.take(|_| schema(), |reader, name| reader.words(name, &all))?;
        let named = |index: usize| match index.checked_sub(names.len()) {
            None => NameOr::Name(index),
            Some(other) => NameOr::Other(others[other].clone()),
        };
        Some(chosen.into_iter().map(named).collect())
    }

    /// Something with a reader and a schema of its own.
    pub fn value<T>(self, schema: impl FnOnce() -> Value, read: impl FnOnce(&Value) -> Result<T, String>) -> Option<T> {
        self.take(|_| schema(), |reader, name| reader.value(name, read))
    }

    /// A number within the bound, or text that says one: something with a reader of its own, and a schema with a name.
    pub fn number_or_text<T>(
        self,
        component: &'static str,
        bound: Bound,
        schema: impl FnOnce() -> Value,
        read: impl FnOnce(&Value) -> Result<T, String>,
    ) -> Option<T> {
        let unit = self.unit;
        self.take(
            |object| object.component(component, schema()),
            |reader, name| {
                let value = reader.value(name, read)?;
                if reader.required(name)?.is_number() {
                    reader.list_number(name, bound, unit);
                }
                Some(value)
            },
        )
    }

    /// An object.
    pub fn object<T>(self, read: impl Fn(&mut Object) -> Option<T>) -> Option<T> {
        self.take(
            |schema| described(schema, &read),
            |reader, name| reader.object(name, |object| reading(object, &read)),
        )
    }

    /// Objects, so many at least and at most.
    pub fn objects<T>(self, counts: [usize; 2], read: impl Fn(&mut Object) -> Option<T>) -> Option<Vec<T>> {
        self.take(
            |schema| schema::list(&described(schema, &read), counts),
            |reader, name| reader.objects(name, counts, |object| reading(object, &read)),
        )
    }

    /// Objects, so many at least and at most, whose schema another field writes under this name: such as stand within themselves.
    pub fn objects_again<T>(
        self,
        counts: [usize; 2],
        component: &'static str,
        read: impl Fn(&mut Object) -> Option<T>,
    ) -> Option<Vec<T>> {
        self.take(
            |_| schema::list(&schema::reference(component), counts),
            |reader, name| reader.objects(name, counts, |object| reading(object, &read)),
        )
    }

    /// A number, or null.
    pub fn number_or_null(self, bound: Bound) -> Option<Option<f64>> {
        let unit = self.unit;
        self.take(
            |_| {
                let mut schema = schema::number(bound);
                schema["type"] = json!(["number", "null"]);
                schema
            },
            |reader, name| match reader.required(name)? {
                Value::Null => Some(None),
                _ => reader.number(name, bound, unit).map(Some),
            },
        )
    }

    /// Numbers by names, which the request chooses.
    pub fn numbers_by_name(self, bound: Bound) -> Option<Vec<(String, f64)>> {
        self.take(
            |_| json!({"type": "object", "additionalProperties": schema::number(bound)}),
            |reader, name| reader.numbers_by_name(name, bound),
        )
    }

    /// An angle, in radians as its bound, or an object.
    pub fn angle_or<T>(
        self,
        union: &AngleOrObject,
        bound: Bound,
        from_angle: impl Fn(f64) -> T,
        read: impl Fn(&mut Object) -> Option<T>,
    ) -> Option<T> {
        self.unit(ANGLE).take(
            |schema| {
                let mut angle = schema::number(schema::widened(bound));
                angle["description"] = json!(union.angle);
                let object = described(schema, &read);
                schema.component(union.name, json!({"oneOf": [angle, object], "description": union.doc}))
            },
            |reader, name| match reader.required(name)? {
                Value::Number(_) => reader.radians(name, bound).map(from_angle),
                Value::Object(_) => reader.object(name, |object| reading(object, &read)),
                other => {
                    let detail = format!("must be a number or {}, got {}", union.object, reader::kind_of(other));
                    reader.fault_of(name, detail);
                    None
                }
            },
        )
    }

    /// One of several words, or an object.
    pub fn word_or<W: Copy + Into<T>, T>(
        self,
        union: &WordOrObject,
        words: &Words<W>,
        read: impl Fn(&mut Object) -> Option<T>,
    ) -> Option<T> {
        self.take(
            |schema| {
                let word = words.component(schema);
                let object = described(schema, &read);
                // The object first: a generated client stops at the first constant that does not fit.
                schema.component(union.name, json!({"oneOf": [object, word], "description": union.doc}))
            },
            |reader, name| {
                if reader.has_object(name) {
                    return reader.object(name, |object| reading(object, &read));
                }
                let chosen = match words.all()[..] {
                    [only] => reader.only_word(name, only),
                    ref several => reader.word(name, several),
                };
                chosen.map(|chosen| words.words[chosen].meaning.into())
            },
        )
    }

    /// Text with a reader and a schema of its own, or an object.
    pub fn text_or<T>(
        self,
        union: &WordOrObject,
        (name_of_text, schema): (&'static str, impl FnOnce() -> Value),
        from_text: impl Fn(&str) -> Result<T, String>,
        read: impl Fn(&mut Object) -> Option<T>,
    ) -> Option<T> {
        self.take(
            |object| {
                let text = object.component(name_of_text, schema());
                let described = described(object, &read);
                object.component(union.name, json!({"oneOf": [described, text], "description": union.doc}))
            },
            |reader, name| match reader.required(name)? {
                Value::Object(_) => reader.object(name, |object| reading(object, &read)),
                Value::String(_) => reader.value(name, |value| from_text(value.as_str().unwrap_or_default())),
                other => {
                    let detail = format!("must be a string or an object, got {}", reader::kind_of(other));
                    reader.fault_of(name, detail);
                    None
                }
            },
        )
    }

    /// True or false, or an object.
    pub fn boolean_or<T>(
        self,
        union: &BooleanOrObject,
        from_boolean: impl Fn(bool) -> T,
        read: impl Fn(&mut Object) -> Option<T>,
    ) -> Option<T> {
        self.take(
            |schema| {
                let boolean = json!({"type": "boolean", "description": union.boolean});
                let object = described(schema, &read);
                schema.component(union.name, json!({"oneOf": [boolean, object], "description": union.doc}))
            },
            |reader, name| match reader.required(name)? {
                Value::Object(_) => reader.object(name, |object| reading(object, &read)),
                Value::Bool(boolean) => Some(from_boolean(*boolean)),
                other => {
                    let detail = format!("must be true, false or {}, got {}", union.object, reader::kind_of(other));
                    reader.fault_of(name, detail);
                    None
                }
            },
        )
    }
}

/// Writes the schema of an object within another, and refers to it.
fn described<T>(schema: &mut ObjectSchema, read: impl FnOnce(&mut Object) -> Option<T>) -> Value {
    schema.object(|schema| _ = read(&mut Object(Mode::Describe(schema))))
}
