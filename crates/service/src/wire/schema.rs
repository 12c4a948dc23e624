//! Writes the JSON Schema of a request: what an object's fields are called, what they mean, and what they may hold.

use reentry::scenario::Bound;
use serde_json::{Map, Value, json};

/// Types that stand, in answers and at endpoints, for schemas that descriptions write.
pub mod names {
    use utoipa::openapi::{RefOr, Schema, schema::Object};
    use utoipa::{PartialSchema, ToSchema};

    macro_rules! names {
        ($($name:ident)*) => { $(
            #[doc = concat!("The schema `", stringify!($name), "`.")]
            pub struct $name;

            impl PartialSchema for $name {
                fn schema() -> RefOr<Schema> {
                    Object::new().into()
                }
            }

            impl ToSchema for $name {}
        )* }
    }

    names! {
        AnalyticRequest AngleUnit ConvertRequest CorridorRequest Ecef Eci FootprintRequest Formulation Geodetic InertialFlightPath OrbitalElements PlanetModel PlanetRelative Shape
        SimulateRequest Solution TargetRequest
    }
}

/// The unit of an angle, in the schema and in lists of numbers: that which the request names in `angle_unit`.
pub const ANGLE: &str = "angle";

/// The schemas that have a name, by their names.
pub type Components = Map<String, Value>;

/// What a field is, beside the schema of its value.
pub struct Property {
    /// The key in the object.
    pub name: &'static str,
    /// A label for forms.
    pub title: &'static str,
    /// A description of the value.
    pub doc: &'static str,
    /// The unit of its numbers; empty where they have none.
    pub unit: &'static str,
    /// Whether a request must have the field.
    pub is_required: bool,
    /// The value where the field is left out.
    pub default: Option<Value>,
}

/// The schema of one object, being written.
pub struct ObjectSchema<'a> {
    name: &'static str,
    doc: &'static str,
    /// The names of the fields.
    names: Vec<&'static str>,
    required: Vec<Value>,
    properties: Map<String, Value>,
    /// The variants, of an object that is a union of several.
    union: Option<Value>,
    /// The keywords of conditions: `if` and the `dependent` ones, each once.
    conditions: Map<String, Value>,
    all_of: Vec<Value>,
    components: &'a mut Components,
}

impl<'a> ObjectSchema<'a> {
    /// An empty schema, whose parts with names go to the components.
    pub fn new(components: &'a mut Components) -> Self {
        Self {
            name: "",
            doc: "",
            names: Vec::new(),
            required: Vec::new(),
            properties: Map::new(),
            union: None,
            conditions: Map::new(),
            all_of: Vec::new(),
            components,
        }
    }

    /// Gives the schema its name and its description.
    pub fn set_name(&mut self, name: &'static str, doc: &'static str) {
        (self.name, self.doc) = (name, doc);
    }

    /// Adds a field.
    pub fn add(&mut self, property: Property, value: Value) {
        let Property { name, title, doc, unit, is_required, default } = property;
        if is_required {
            self.required.push(json!(name));
        }
        let mut schema = json!({"title": title, "description": doc});
        extend(&mut schema, value);
        if !unit.is_empty() {
            schema["x-unit"] = json!(unit);
        }
        // The fields of an object have their own defaults.
        if let Some(default) = default.filter(|default| !default.is_object()) {
            schema["default"] = default.as_f64().map_or(default, plain);
        }
        self.names.push(name);
        self.properties.insert(name.to_owned(), schema);
    }

    /// Adds keywords to a field that was added before.
    pub fn refine(&mut self, name: &str, keywords: Value) {
        if let Some(property) = self.properties.get_mut(name) {
            extend(property, keywords);
        }
    }

    /// Takes a field away, which the reader knows and always refuses.
    pub fn remove(&mut self, name: &str) {
        self.properties.shift_remove(name);
    }

    /// Asks for a condition across fields. A condition whose keywords are taken, or that would make the object a union to generators of
    /// clients, which then lose its fields, stands within `allOf`.
    pub fn require(&mut self, condition: Value) {
        let Value::Object(condition) = condition else { return };
        let may_stand_beside = |key: &String| {
            ["if", "then", "else", "dependentRequired", "dependentSchemas"].contains(&key.as_str())
                && !self.conditions.contains_key(key)
        };
        if condition.keys().all(may_stand_beside) {
            self.conditions.extend(condition);
        } else {
            self.all_of.push(Value::Object(condition));
        }
    }

    /// The fields that `describe` adds belong to the object where the condition holds, or where it does not hold, and nowhere else.
    pub fn only(&mut self, condition: &Value, holds: bool, describe: impl FnOnce(&mut Self)) {
        let (known, required) = (self.properties.len(), self.required.len());
        describe(self);
        let absent: Map<_, _> = self.properties.keys().skip(known).map(|name| (name.clone(), json!(false))).collect();
        let required = self.required.split_off(required);
        let present = if required.is_empty() { None } else { Some(json!({"required": required})) };
        // `false` must stand where generators of clients do not look: below `then` and `else`.
        let absent = Some(json!({"properties": absent}));
        let (then, otherwise) = if holds { (present, absent) } else { (absent, present) };
        let mut keywords = json!({"if": condition});
        for (keyword, schema) in [("then", then), ("else", otherwise)] {
            if let Some(schema) = schema {
                keywords[keyword] = schema;
            }
        }
        self.require(keywords);
    }

    /// The fields that `describe` adds are two sets, of which one is given, and whole.
    pub fn one_set(&mut self, sets: [[&'static str; 2]; 2], describe: impl FnOnce(&mut Self)) {
        let required = self.required.len();
        describe(self);
        self.required.truncate(required);
        let mut together = json!({});
        for [one, other] in sets {
            together[one] = json!([other]);
            together[other] = json!([one]);
        }
        self.require(json!({"dependentRequired": together}));
        self.require(json!({"oneOf": sets.map(|[one, _]| json!({"required": [one]}))}));
    }

    /// The fields and the conditions that `describe` adds belong to the object where one of the fields, `name`, is given; those that are `shared`
    /// belong to others of its kind as well.
    pub fn alternative(&mut self, name: &str, shared: &[&str], describe: impl FnOnce(&mut Self)) {
        let (known, required, conditions) = (self.properties.len(), self.required.len(), self.all_of.len());
        let outer = std::mem::take(&mut self.conditions);
        describe(self);
        let mut required = self.required.split_off(required);
        required.retain(|field| field != name && !shared.iter().any(|shared| field == shared));
        let mut conditions = self.all_of.split_off(conditions);
        let own = std::mem::replace(&mut self.conditions, outer);
        if !own.is_empty() {
            conditions.push(Value::Object(own));
        }
        let others =
            self.properties.keys().skip(known).filter(|other| *other != name && !shared.contains(&other.as_str()));
        let absent: Map<_, _> = others.map(|other| (other.clone(), json!(false))).collect();
        let mut keywords = json!({"if": {"required": [name]}, "else": {"properties": absent}});
        let mut then = json!({});
        if !required.is_empty() {
            then["required"] = json!(required);
        }
        if !conditions.is_empty() {
            then["allOf"] = json!(conditions);
        }
        if then != json!({}) {
            keywords["then"] = then;
        }
        self.all_of.push(keywords);
    }

    /// The names of the fields that were added.
    pub fn field_names(&self) -> &[&'static str] {
        &self.names
    }

    /// Makes the object a union of variants, told apart by `type`: each has its word, a label, a description, and its own schema.
    pub fn be_one_of(&mut self, variants: Vec<(&'static str, &'static str, &'static str, Value)>) {
        let mapping: Map<_, _> =
            variants.iter().map(|(word, _, _, reference)| ((*word).to_owned(), reference["$ref"].clone())).collect();
        let one_of = variants.into_iter().map(|(_, title, doc, mut reference)| {
            reference["title"] = json!(title);
            reference["description"] = json!(doc);
            reference
        });
        let one_of: Vec<_> = one_of.collect();
        self.union = Some(json!({"oneOf": one_of, "discriminator": {"propertyName": "type", "mapping": mapping}}));
    }

    /// Names a schema that is not an object's, and refers to it.
    pub fn component(&mut self, name: &str, schema: Value) -> Value {
        self.components.insert(name.to_owned(), schema);
        reference(name)
    }

    /// Writes the schema of another object, and refers to it.
    pub fn object(&mut self, describe: impl FnOnce(&mut ObjectSchema)) -> Value {
        let mut object = ObjectSchema::new(self.components);
        describe(&mut object);
        object.finish()
    }

    /// Puts the schema among the components, and refers to it.
    pub fn finish(self) -> Value {
        let Self { name, doc, names: _, required, properties, union, conditions, all_of, components } = self;
        let mut schema = union.unwrap_or_else(|| json!({"type": "object"}));
        schema["description"] = json!(doc);
        if schema.get("type").is_some() {
            if !required.is_empty() {
                schema["required"] = json!(required);
            }
            schema["properties"] = json!(properties);
            schema["additionalProperties"] = json!(false);
        }
        extend(&mut schema, Value::Object(conditions));
        if !all_of.is_empty() {
            schema["allOf"] = json!(all_of);
        }
        components.insert(name.to_owned(), schema);
        reference(name)
    }
}

/// Adds keywords to a schema.
pub fn extend(schema: &mut Value, keywords: Value) {
    if let (Some(schema), Value::Object(keywords)) = (schema.as_object_mut(), keywords) {
        schema.extend(keywords);
    }
}

/// A reference to a component.
pub fn reference(name: &str) -> Value {
    json!({"$ref": format!("#/components/schemas/{name}")})
}

/// The condition that a field is given and has the word. `field` is a path of names: of `aerodynamics/type`, the object in the field
/// `aerodynamics` has the word as its `type`.
pub fn is(field: &str, word: &str) -> Value {
    let at = |schema: Value, name: &str| json!({"properties": {(name): schema}, "required": [name]});
    field.rsplit('/').fold(json!({"const": word}), at)
}

/// The keywords of a bound, which leaves out what every finite number is within.
pub fn bounds(bound: Bound) -> Value {
    let mut keywords = json!({});
    if bound.minimum > f64::MIN {
        keywords[if bound.exclusive { "exclusiveMinimum" } else { "minimum" }] = plain(bound.minimum);
    }
    if bound.maximum < f64::MAX {
        keywords["maximum"] = plain(bound.maximum);
    }
    keywords
}

/// A number within a bound.
pub fn number(bound: Bound) -> Value {
    let mut schema = json!({"type": "number", "format": "double"});
    extend(&mut schema, bounds(bound));
    schema
}

/// The bound of an angle in whichever unit: a schema knows no unit, and has the bound of degrees, which is the wider.
pub fn widened(bound: Bound) -> Bound {
    bound.scaled(1_f64.to_degrees())
}

/// A list of so many entries at least and at most.
pub fn list(items: &Value, [least, most]: [usize; 2]) -> Value {
    let mut schema = json!({"type": "array", "items": items});
    if least > 0 {
        schema["minItems"] = json!(least);
    }
    if most < usize::MAX {
        schema["maxItems"] = json!(most);
    }
    schema
}

/// One of several words.
pub fn words(words: &[&str]) -> Value {
    match words {
        // Of a choice of one, generators of clients would make a type of its own.
        [only] => json!({"type": "string", "const": only}),
        _ => json!({"type": "string", "enum": words}),
    }
}

/// A number as people write it: a whole one without a point.
fn plain(number: f64) -> Value {
    #[expect(clippy::cast_possible_truncation, reason = "whole, and less than 2^53")]
    let whole = (number.fract() == 0.0 && number.abs() < 9e15).then_some(number as i64);
    whole.map_or(json!(number), |whole| json!(whole))
}
