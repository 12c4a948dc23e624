//! The description of a request, field by field: it reads a request, and it writes the schema of one.
//!
//! An object of a request has one function, which names the object and its fields, each in a statement:
//!
//! ```text
//! fn vehicle(object: &mut Object) -> Option<Vehicle> {
//!     object.named("Vehicle", "A point mass with lift and drag.");
//!     let mass = object.field("mass", "Mass").doc("…").unit("kg").number(Bound::POSITIVE);
//!     let nose_radius = object.field("nose_radius", "Nose radius").doc("…").unit("m").optional().number(Bound::POSITIVE);
//!     Some(Vehicle { mass: mass?, nose_radius })
//! }
//! ```
//!
//! With [`read`] the function reads a tree: it notes every fault with its pointer, and fills in the defaults. With [`schemas`] the same
//! function writes the schema, and no field has a value. Hence a function reads all fields before it returns early by `?`, and leaves a choice
//! between several kinds of fields to [`Object::variants`], [`Object::only_where`] and [`Object::only_unless`].

use reentry::interpolation::TableError;
use reentry::scenario::Bound;
use serde_json::{Value, json};

use super::AngleUnit;
use super::reader::{self, Fault, MOST_COLUMNS, MOST_ROWS, NumberField, NumberOrList, ObjectReader};
use super::schema::{self, ANGLE, Components, ObjectSchema, Property};

/// An object of a request: one that is read, or one whose schema is written.
pub struct Object<'a, 'b>(Mode<'a, 'b>);

enum Mode<'a, 'b> {
    Read(&'a mut ObjectReader<'b>),
    Describe(&'a mut ObjectSchema<'b>),
}

/// The description of an object.
pub type Describe<T> = fn(&mut Object) -> Option<T>;

/// Reads a whole request, an object; the tree then holds every default as well.
///
/// # Errors
/// With every fault that was found.
pub fn read<T>(tree: &mut Value, request: Describe<T>) -> Result<T, Vec<Fault>> {
    reader::read(tree, |object| reading(object, request))
}

/// Reads a whole request as [`read`] does, and lists the numbers that it has, defaults included, in the order in which they were read.
///
/// # Errors
/// With every fault that was found.
pub fn read_with_numbers<T>(tree: &mut Value, request: Describe<T>) -> Result<(T, Vec<NumberField>), Vec<Fault>> {
    reader::read_with_numbers(tree, |object| reading(object, request))
}

/// Reads an object by its description.
pub fn reading<T>(object: &mut ObjectReader, read: impl FnOnce(&mut Object) -> Option<T>) -> Option<T> {
    read(&mut Object(Mode::Read(object)))
}

/// Writes the schema of a request, and the schemas of what it has, into the components.
pub fn schemas<T>(components: &mut Components, request: Describe<T>) {
    let mut object = ObjectSchema::new(components);
    request(&mut Object(Mode::Describe(&mut object)));
    object.finish();
}

/// A word of a field, with what it stands for, a label and a description.
#[derive(Clone, Copy, Debug)]
pub struct Word<T> {
    /// As requests write it.
    pub word: &'static str,
    /// The value that it stands for.
    pub meaning: T,
    title: &'static str,
    doc: &'static str,
    unit: &'static str,
}

/// A word, what it stands for, and a label.
pub const fn word<T: Copy>(word: &'static str, meaning: T, title: &'static str) -> Word<T> {
    Word { word, meaning, title, doc: "", unit: "" }
}

impl<T: Copy> Word<T> {
    /// Describes it, for the reader of the document.
    #[must_use]
    pub const fn doc(self, doc: &'static str) -> Self {
        Self { doc, ..self }
    }

    /// The unit of the quantity that it names.
    #[must_use]
    pub const fn unit(self, unit: &'static str) -> Self {
        Self { unit, ..self }
    }
}

/// The words of a field, with the name and the description of their schema.
#[derive(Clone, Copy, Debug)]
pub struct Words<T: 'static> {
    /// The name of their schema; empty where it needs none.
    pub name: &'static str,
    /// The description of their schema.
    pub doc: &'static str,
    /// All of them.
    pub words: &'static [Word<T>],
}

impl<T: Copy + PartialEq> Words<T> {
    /// The word for a value; empty where there is none.
    pub fn of(&self, meaning: T) -> &'static str {
        self.words.iter().find(|word| word.meaning == meaning).map_or("", |word| word.word)
    }

    /// The unit of a quantity; empty where it has none.
    pub fn unit_of(&self, meaning: T) -> &'static str {
        self.words.iter().find(|word| word.meaning == meaning).map_or("", |word| word.unit)
    }
}

impl<T: Copy> Words<T> {
    fn all(&self) -> Vec<&'static str> {
        self.words.iter().map(|word| word.word).collect()
    }

    /// Puts the schema of the words among the components, and refers to it.
    fn component(&self, object: &mut ObjectSchema) -> Value {
        let mut schema = schema::words(&self.all());
        let mut doc = vec![self.doc.to_owned()];
        for word in self.words.iter().filter(|word| !word.title.is_empty()) {
            doc.push(format!("`{}`: {}", word.word, word.doc));
            schema["x-titles"][word.word] = json!(word.title);
            if !word.unit.is_empty() {
                schema["x-units"][word.word] = json!(word.unit);
            }
        }
        schema["description"] = json!(doc.join(" "));
        if self.name.is_empty() { schema } else { object.component(self.name, schema) }
    }
}

/// A kind of an object that has several, told by its `type`.
pub struct Variant<'a, T> {
    word: &'static str,
    title: &'static str,
    doc: &'static str,
    read: &'a dyn Fn(&mut Object) -> Option<T>,
}

/// A kind of an object: its `type`, a label, a description, and the description of its fields.
pub fn variant<'a, T>(
    word: &'static str,
    title: &'static str,
    doc: &'static str,
    read: &'a dyn Fn(&mut Object) -> Option<T>,
) -> Variant<'a, T> {
    Variant { word, title, doc, read }
}

/// The field by which an alternative is called, and the description of its fields.
pub type Alternative<'a, T> = (&'static str, &'a dyn Fn(&mut Object) -> Option<T>);

/// A value that is a word or an object.
pub struct WordOrObject {
    /// The name of its schema.
    pub name: &'static str,
    /// The description of its schema.
    pub doc: &'static str,
}

/// A value that is true or false or an object.
pub struct BooleanOrObject {
    /// The name of its schema.
    pub name: &'static str,
    /// The description of its schema.
    pub doc: &'static str,
    /// The description of true and false.
    pub boolean: &'static str,
    /// How faults call the object.
    pub object: &'static str,
}

/// A value that is an angle or an object.
pub struct AngleOrObject {
    /// The name of its schema.
    pub name: &'static str,
    /// The description of its schema.
    pub doc: &'static str,
    /// The description of the angle.
    pub angle: &'static str,
    /// How faults call the object.
    pub object: &'static str,
}

impl<'a, 'b> Object<'a, 'b> {
    fn reader(&mut self) -> Option<&mut ObjectReader<'b>> {
        match &mut self.0 {
            Mode::Read(reader) => Some(reader),
            Mode::Describe(_) => None,
        }
    }

    fn schema(&mut self) -> Option<&mut ObjectSchema<'b>> {
        match &mut self.0 {
            Mode::Read(_) => None,
            Mode::Describe(schema) => Some(schema),
        }
    }

    /// Names the object's schema, and describes it.
    pub fn named(&mut self, name: &'static str, doc: &'static str) {
        if let Some(schema) = self.schema() {
            schema.set_name(name, doc);
        }
    }

    /// A field: its name, and a label for forms. What it means and what it holds is said by the methods of [`Field`].
    pub fn field<'f>(&'f mut self, name: &'static str, title: &'static str) -> Field<'f, 'a, 'b> {
        Field { object: self, name, title, doc: "", unit: "", need: Need::Required, is_ascending: false }
    }

    /// The kind of the object by its field `type`, which `doc` describes, and by it what the object is.
    pub fn variants<T>(&mut self, doc: &'static str, variants: &[Variant<T>]) -> Option<T> {
        match &mut self.0 {
            Mode::Read(reader) => {
                let words: Vec<_> = variants.iter().map(|variant| variant.word).collect();
                let chosen = reader.word("type", &words)?;
                (variants[chosen].read)(self)
            }
            Mode::Describe(schema) => {
                let described = variants.iter().map(|variant| {
                    let reference = schema.object(|schema| {
                        let mut object = Object(Mode::Describe(schema));
                        object.field("type", "Type").doc(doc).constant(variant.word);
                        (variant.read)(&mut object);
                    });
                    (variant.word, variant.title, variant.doc, reference)
                });
                let described = described.collect();
                schema.be_one_of(described);
                None
            }
        }
    }

    /// An object of one kind, which its field `type`, described by `doc`, must name; the other fields are read where it does.
    pub fn of_type<T>(
        &mut self,
        word: &'static str,
        doc: &'static str,
        read: impl FnOnce(&mut Object) -> Option<T>,
    ) -> Option<T> {
        let kind = self.field("type", "Type").doc(doc).constant(word);
        if matches!(self.0, Mode::Describe(_)) || kind.is_some() { read(self) } else { None }
    }

    /// Fields that the object has where another field, given by its path, has the word, and nowhere else.
    pub fn only_where<T>(
        &mut self,
        field: &'static str,
        word: &'static str,
        read: impl FnOnce(&mut Object) -> Option<T>,
    ) -> Option<T> {
        self.only(field, word, true, read)
    }

    /// Fields that the object has unless another field, given by its path, has the word.
    pub fn only_unless<T>(
        &mut self,
        field: &'static str,
        word: &'static str,
        read: impl FnOnce(&mut Object) -> Option<T>,
    ) -> Option<T> {
        self.only(field, word, false, read)
    }

    fn only<T>(
        &mut self,
        field: &'static str,
        word: &'static str,
        holds: bool,
        read: impl FnOnce(&mut Object) -> Option<T>,
    ) -> Option<T> {
        match &mut self.0 {
            Mode::Read(reader) => (reader.has_word(field, word) == holds).then(|| read(self)).flatten(),
            Mode::Describe(schema) => {
                schema.only(&schema::is(field, word), holds, |schema| _ = read(&mut Object(Mode::Describe(schema))));
                None
            }
        }
    }

    /// One of two sets of fields, each of which is given whole or not at all: the second where the request gives some of it, or else the first.
    pub fn one_set<T>(
        &mut self,
        sets: [[&'static str; 2]; 2],
        first: impl FnOnce(&mut Object) -> Option<T>,
        second: impl FnOnce(&mut Object) -> Option<T>,
    ) -> Option<T> {
        match &mut self.0 {
            Mode::Read(reader) => match sets.map(|names| names.map(|name| reader.has(name)).contains(&true)) {
                [true, true] => {
                    let [[a, b], [c, d]] = sets;
                    reader.fault(format!("must have {a} and {b}, or {c} and {d}, got some of both"))
                }
                [false, true] => second(self),
                [_, false] => first(self),
            },
            Mode::Describe(schema) => {
                schema.one_set(sets, |schema| {
                    first(&mut Object(Mode::Describe(schema)));
                    second(&mut Object(Mode::Describe(schema)));
                });
                None
            }
        }
    }

    /// One of several fields, each with those that belong beside it: the field by which an alternative is called, and its description, which
    /// reads that field too. Notes a fault unless the request gives exactly one of them.
    pub fn alternatives<T>(&mut self, alternatives: &[Alternative<T>]) -> Option<T> {
        let names: Vec<_> = alternatives.iter().map(|(name, _)| *name).collect();
        match &mut self.0 {
            Mode::Read(reader) => {
                let Some(chosen) = reader.exactly_one(&names) else {
                    // Which of the other fields belong here is not known.
                    let mut components = Components::new();
                    let mut schema = ObjectSchema::new(&mut components);
                    for (_, describe) in alternatives {
                        describe(&mut Object(Mode::Describe(&mut schema)));
                    }
                    schema.field_names().iter().for_each(|name| _ = reader.has(name));
                    return None;
                };
                alternatives.iter().find(|(name, _)| *name == chosen).and_then(|(_, read)| read(self))
            }
            Mode::Describe(schema) => {
                for (name, describe) in alternatives {
                    schema.alternative(name, |schema| _ = describe(&mut Object(Mode::Describe(schema))));
                }
                _ = self.exactly_one(&names);
                None
            }
        }
    }

    /// Notes a fault unless exactly one of the fields is given, which a condition asks for in the schema.
    pub fn one_given(&mut self, names: &[&'static str]) -> Option<&'static str> {
        self.reader().and_then(|reader| reader.exactly_one(names))
    }

    /// Notes a fault unless exactly one of the fields, which may each be left out, is given; returns its name.
    pub fn exactly_one(&mut self, names: &[&'static str]) -> Option<&'static str> {
        match &mut self.0 {
            Mode::Read(reader) => reader.exactly_one(names),
            Mode::Describe(schema) => {
                let one = names.iter().map(|name| json!({"required": [name]}));
                schema.require(json!({"oneOf": one.collect::<Vec<_>>()}));
                None
            }
        }
    }

    /// What the schema asks across fields; the reader checks it in its own way.
    pub fn condition(&mut self, condition: impl FnOnce() -> Value) {
        if let Some(schema) = self.schema() {
            schema.require(condition());
        }
    }

    /// Further keywords for the schema of a field.
    pub fn refine(&mut self, name: &str, keywords: impl FnOnce() -> Value) {
        if let Some(schema) = self.schema() {
            schema.refine(name, keywords());
        }
    }

    /// Leaves a field out of the schema: one that is read, so that its fault says why it is refused.
    pub fn conceal(&mut self, name: &str) {
        if let Some(schema) = self.schema() {
            schema.remove(name);
        }
    }

    /// Whether the request gives the field.
    pub fn has(&mut self, name: &'static str) -> bool {
        self.reader().is_some_and(|reader| reader.has(name))
    }

    /// Notes a fault of this object as a whole.
    pub fn fault<T>(&mut self, detail: impl Into<String>) -> Option<T> {
        self.reader().and_then(|reader| reader.fault(detail))
    }

    /// Notes a fault of the field, or the element of a field, of the given relative pointer.
    pub fn fault_of(&mut self, name: &str, detail: impl Into<String>) {
        if let Some(reader) = self.reader() {
            reader.fault_of(name, detail.into());
        }
    }

    /// What the core made of numbers that were read, or its own fault with them, noted of this object as a whole.
    pub fn sound<T>(&mut self, made: Result<T, TableError>) -> Option<T> {
        made.map_err(|error| self.fault::<T>(error.to_string())).ok()
    }

    /// Notes a fault at every list of the table whose length is not that of the first, where neither is at fault already.
    pub fn equally_long(&mut self, first: &str, others: &[&str]) -> bool {
        self.reader().is_some_and(|reader| reader.equally_long(first, others))
    }

    /// Notes a fault at every number that is not greater than the one before it; `field` is the pointer to the number within its entry.
    pub fn ascending(&mut self, name: &'static str, field: &str, numbers: &[f64]) -> bool {
        self.reader().is_some_and(|reader| reader.ascending(name, field, numbers))
    }

    /// Gives a field its default, where the default depends on other fields.
    pub fn fill(&mut self, name: &'static str, default: Value) {
        if let Some(reader) = self.reader() {
            reader.fill(name, default);
        }
    }

    /// The unit of the request's angles, of which all angles are that are read after it.
    pub fn set_angle_unit(&mut self, unit: Option<AngleUnit>) {
        if let Some(reader) = self.reader() {
            reader.set_angle_unit(unit);
        }
    }

    /// Whether an angle other than 0 was read so far.
    pub fn turns(&mut self) -> bool {
        self.reader().is_some_and(|reader| reader.turns())
    }
}

/// Whether a field must be given.
enum Need {
    Required,
    Optional,
    Default(Value),
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

impl Field<'_, '_, '_> {
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
        let mut schema = json!({"type": "integer", "minimum": least});
        if most < usize::MAX {
            schema["maximum"] = json!(most);
        }
        self.take(|_| schema, |reader, name| reader.whole_number(name, [least, most]))
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
                (number["description"], list["description"]) = (json!("For all."), json!("For each."));
                let doc = "A number for all entries of a table, or one for each.";
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
                _ => reader.strings(name, most),
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

    /// One of several names; its index.
    pub fn name(self, names: &[&'static str]) -> Option<usize> {
        self.take(|_| schema::words(names), |reader, name| reader.word(name, names))
    }

    /// Names out of several, one or more, none of them twice; their indices.
    pub fn names(self, names: &[&'static str]) -> Option<Vec<usize>> {
        let schema = || {
            let mut list = schema::list(&schema::words(names), [1, names.len()]);
            list["uniqueItems"] = json!(true);
            list
        };
        self.take(|_| schema(), |reader, name| reader.words(name, names))
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
                schema.component(union.name, json!({"oneOf": [word, object], "description": union.doc}))
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
