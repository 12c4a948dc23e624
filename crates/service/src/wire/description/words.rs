//! The words that a field may hold.

use serde_json::{Value, json};

use crate::wire::schema::{self, ObjectSchema};

/// A word of a field, with what it stands for, a label and a description.
#[derive(Clone, Copy, Debug)]
pub struct Word<T> {
    /// As requests write it.
    pub word: &'static str,
    /// The value that it stands for.
    pub meaning: T,
    /// A label for people.
    pub title: &'static str,
    /// A description.
    pub doc: &'static str,
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
        self.word_of(meaning).map_or("", |word| word.word)
    }

    /// The word for a value, with its label and description.
    pub fn word_of(&self, meaning: T) -> Option<&'static Word<T>> {
        self.words.iter().find(|word| word.meaning == meaning)
    }

    /// The unit of a quantity; empty where it has none.
    pub fn unit_of(&self, meaning: T) -> &'static str {
        self.word_of(meaning).map_or("", |word| word.unit)
    }
}

impl<T: Copy> Words<T> {
    pub(super) fn all(&self) -> Vec<&'static str> {
        self.words.iter().map(|word| word.word).collect()
    }

    /// Puts the schema of the words among the components, and refers to it.
    pub(super) fn component(&self, object: &mut ObjectSchema) -> Value {
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
