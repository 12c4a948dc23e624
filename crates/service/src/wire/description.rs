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

mod field;
mod words;

pub use field::{Field, NameOr};
pub use words::{AngleOrObject, BooleanOrObject, Word, WordOrObject, Words, word};

use reentry::interpolation::TableError;
use serde_json::{Value, json};

use super::AngleUnit;
use super::reader::{self, Fault, NumberField, ObjectReader};
use super::schema::{self, Components, ObjectSchema};

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
        Field::new(self, name, title)
    }

    /// The kind of the object by its field `type`, which `doc` describes, and by it what the object is.
    pub fn variants<T>(&mut self, doc: &'static str, variants: &[Variant<T>]) -> Option<T> {
        self.variants_of(doc, variants, &[])
    }

    /// The same of variants in two lists.
    pub fn variants_of<T>(&mut self, doc: &'static str, variants: &[Variant<T>], more: &[Variant<T>]) -> Option<T> {
        let variants: Vec<_> = variants.iter().chain(more).collect();
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
                    for (_, describe) in alternatives {
                        for name in fields_of(*describe) {
                            reader.has(name);
                        }
                    }
                    return None;
                };
                alternatives.iter().find(|(name, _)| *name == chosen).and_then(|(_, read)| read(self))
            }
            Mode::Describe(schema) => {
                let fields = alternatives.iter().map(|(_, describe)| fields_of(*describe)).collect::<Vec<_>>();
                let having = |field: &str| {
                    let having = names.iter().zip(&fields).filter(|(_, fields)| fields.contains(&field));
                    having.map(|(name, _)| *name).collect::<Vec<_>>()
                };
                let mut shared: Vec<_> = fields.concat();
                shared.retain(|field| having(field).len() > 1);
                shared.sort_unstable();
                shared.dedup();
                for (name, describe) in alternatives {
                    schema.alternative(name, &shared, |schema| _ = describe(&mut Object(Mode::Describe(schema))));
                }
                for field in shared {
                    let given = having(field).into_iter().map(|name| json!({"required": [name]})).collect::<Vec<_>>();
                    let absent = json!({"properties": {field: false}});
                    schema.require(json!({"if": {"not": {"anyOf": given}}, "then": absent}));
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

    /// Whether a field, given by its path, has the word.
    pub fn has_word(&mut self, path: &str, word: &str) -> bool {
        self.reader().is_some_and(|reader| reader.has_word(path, word))
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

/// The names of the fields that a description adds.
fn fields_of<T>(describe: &dyn Fn(&mut Object) -> Option<T>) -> Vec<&'static str> {
    let mut components = Components::new();
    let mut schema = ObjectSchema::new(&mut components);
    describe(&mut Object(Mode::Describe(&mut schema)));
    schema.field_names().to_vec()
}
