//! Makes requests out of requests, as trees: what a fuzzer of bytes seldom comes to.

use std::fs;
use std::path::Path;

use rand::rngs::SmallRng;
use rand::seq::IndexedRandom;
use rand::{RngExt, SeedableRng};
use reentry_service::document;
use reentry_service::wire::json::parse;
use serde_json::{Map, Number, Value, json};

use crate::cases::thesis_cases;

/// Numbers at which arithmetic may break, beside the bounds that the document of the API names.
const EXTREME: [f64; 26] = [
    0.0,
    -0.0,
    1.0,
    -1.0,
    0.5,
    2.0,
    3.0,
    -90.0,
    90.0,
    180.0,
    360.0,
    5e-324,
    -5e-324,
    2.3e-308,
    1e-300,
    1e-16,
    1e-8,
    1e-3,
    1e9,
    1e15,
    9_007_199_254_740_993.0,
    1e154,
    1e300,
    -1e300,
    f64::MAX,
    f64::MIN,
];

/// Texts that are no word of the API.
const TEXTS: [&str; 8] =
    ["", "NaN", "Infinity", "\u{0}", "a/b~c", "00:00:59.9", "9999-12-31T23:59:60Z", "2016-12-31T23:59:60.5+23:59"];

/// A tree with more values than this is not made larger.
const LARGE: usize = 2000;

/// Changes requests, by what it knows of the API.
#[derive(Debug)]
pub struct Mutator {
    /// Whole requests.
    pub requests: Vec<Value>,
    words: Vec<String>,
    numbers: Vec<f64>,
}

impl Mutator {
    /// Knows the examples of an endpoint, those of the thesis where they fit, and the corpus of a fuzz target.
    ///
    /// # Panics
    /// When the corpus cannot be read.
    pub fn new(endpoint: &str, target: &str) -> Self {
        let document = document();
        let examples = &document["paths"][endpoint]["post"]["requestBody"]["content"]["application/json"]["examples"];
        let mut requests: Vec<Value> =
            examples.as_object().into_iter().flatten().map(|(_, example)| example["value"].clone()).collect();
        if endpoint == "/simulate" {
            requests.extend(thesis_cases().into_iter().map(|case| case.request));
        }
        requests.extend(corpus(target).iter().filter_map(|input| parse(split(input).1).ok()));
        let (mut words, mut numbers) = (Vec::new(), EXTREME.to_vec());
        learn(&document["components"]["schemas"], &mut words, &mut numbers);
        words.sort();
        words.dedup();
        Self { requests, words, numbers }
    }

    /// Another input of a fuzz target, which keeps its letter mostly; none of what is no JSON.
    pub fn another(&self, input: &[u8], seed: u64) -> Option<Vec<u8>> {
        let chance = &mut SmallRng::seed_from_u64(seed);
        let (letter, text) = split(input);
        let mut tree = parse(text).ok()?;
        for _ in 0..chance.random_range(1..=4) {
            self.change(&mut tree, chance);
        }
        let letter = if chance.random_ratio(1, 16) { LETTERS.choose(chance).copied() } else { letter };
        let text = tree.to_string().into_bytes();
        Some(letter.into_iter().chain(text).collect())
    }

    /// One of the requests, changed so many times.
    pub fn request(&self, seed: u64) -> Value {
        let chance = &mut SmallRng::seed_from_u64(seed);
        let mut tree = self.requests.choose(chance).cloned().unwrap_or_default();
        for _ in 0..chance.random_range(1..=6) {
            self.change(&mut tree, chance);
        }
        tree
    }

    /// Changes a tree in one place.
    fn change(&self, tree: &mut Value, chance: &mut SmallRng) {
        if chance.random_ratio(1, 4) {
            return self.transplant(tree, chance);
        }
        let count = count(tree);
        let Some(place) = nth(tree, &mut chance.random_range(0..count)) else { return };
        if chance.random_ratio(1, 24) {
            *place = self.anything(chance);
            return;
        }
        match place {
            Value::Number(number) => *number = self.number(number, chance),
            Value::String(text) => *text = self.text(chance),
            Value::Bool(truth) => *truth = !*truth,
            Value::Array(list) => Self::change_list(list, count < LARGE, chance),
            Value::Object(members) => self.change_object(members, chance),
            Value::Null => *place = self.anything(chance),
        }
    }

    /// Puts a part of another request at the same place.
    fn transplant(&self, tree: &mut Value, chance: &mut SmallRng) {
        let (Some(mut from), mut to) = (self.requests.choose(chance), tree) else { return };
        while let (Value::Object(members), true) = (from, to.is_object()) {
            let names: Vec<_> = members.keys().collect();
            let Some(name) = names.choose(chance).copied() else { break };
            from = &members[name];
            let goes_on = from.is_object() && to.get(name).is_some() && chance.random_ratio(2, 3);
            to = &mut to[name];
            if !goes_on {
                break;
            }
        }
        *to = from.clone();
    }

    fn number(&self, old: &Number, chance: &mut SmallRng) -> Number {
        let old = old.as_f64().unwrap_or_default();
        let new = match chance.random_range(0..10) {
            0..=3 => self.numbers.choose(chance).copied().unwrap_or_default(),
            4 => self.numbers.choose(chance).copied().unwrap_or_default().next_up(),
            5 => self.numbers.choose(chance).copied().unwrap_or_default().next_down(),
            6 => old * 10_f64.powi(chance.random_range(-12..=12)),
            7 => old * chance.random_range(0.5..2.0),
            8 => -old,
            _ => return chance.random::<i64>().into(),
        };
        Number::from_f64(new).unwrap_or_else(|| 0.into())
    }

    fn text(&self, chance: &mut SmallRng) -> String {
        let odd = chance.random_ratio(1, 6);
        if odd { TEXTS.choose(chance).copied().map(str::to_owned) } else { self.words.choose(chance).cloned() }
            .unwrap_or_default()
    }

    fn change_list(list: &mut Vec<Value>, may_grow: bool, chance: &mut SmallRng) {
        let Some(index) = (!list.is_empty()).then(|| chance.random_range(0..list.len())) else {
            return list.push(json!(0));
        };
        match chance.random_range(0..5) {
            0 => drop(list.remove(index)),
            1 => list.swap(0, index),
            2 => list.truncate(index),
            3 => list.reverse(),
            _ if may_grow => {
                // A list that ascended mostly still does.
                for step in 1..=chance.random_range(1..=8) {
                    let next = match list.last() {
                        Some(Value::Number(last)) => json!(last.as_f64().unwrap_or_default() + f64::from(step)),
                        last => last.cloned().unwrap_or_default(),
                    };
                    list.push(next);
                }
            }
            _ => {}
        }
    }

    fn change_object(&self, members: &mut Map<String, Value>, chance: &mut SmallRng) {
        let name = members.keys().cloned().collect::<Vec<_>>().choose(chance).cloned();
        match (chance.random_range(0..5), name) {
            (0 | 1, Some(name)) => drop(members.shift_remove(&name)),
            (2, Some(name)) => {
                let value = members.shift_remove(&name).unwrap_or_default();
                members.insert(self.text(chance), value);
            }
            (3, Some(name)) => drop(members.insert(name, self.anything(chance))),
            _ => drop(members.insert(self.text(chance), self.anything(chance))),
        }
    }

    /// A value of any kind, or a part of a request.
    fn anything(&self, chance: &mut SmallRng) -> Value {
        match chance.random_range(0..8) {
            0 => Value::Null,
            1 => json!(chance.random::<bool>()),
            2 => Value::Number(self.number(&1.into(), chance)),
            3 => json!(self.text(chance)),
            4 => json!([]),
            5 => json!({}),
            _ => {
                let mut request = self.requests.choose(chance).cloned().unwrap_or_default();
                let count = count(&request);
                nth(&mut request, &mut chance.random_range(0..count)).map(Value::take).unwrap_or_default()
            }
        }
    }
}

/// The inputs in the corpus of a fuzz target, in the order of their names.
///
/// # Panics
/// When it cannot be read.
pub fn corpus(target: &str) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("fuzz/corpus").join(target);
    let listed = fs::read_dir(&folder).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    let mut files: Vec<_> = listed.flatten().map(|file| file.path()).collect();
    files.sort();
    assert!(!files.is_empty(), "{} is empty", folder.display());
    let read = |file| fs::read(file).unwrap_or_else(|error| panic!("{}: {error}", folder.display()));
    files.iter().map(read).collect()
}

/// The letters that may stand before a request for a flight.
pub const LETTERS: &[u8] = b"cgkzoab";

/// The letter before a request, if there is one, and the request.
fn split(input: &[u8]) -> (Option<u8>, &[u8]) {
    match input {
        [letter, text @ ..] if LETTERS.contains(letter) => (Some(*letter), text),
        text => (None, text),
    }
}

/// The names and the numbers of a schema.
fn learn(schema: &Value, words: &mut Vec<String>, numbers: &mut Vec<f64>) {
    match schema {
        Value::Object(members) => {
            for (name, member) in members {
                match member {
                    Value::Number(number) => numbers.extend(number.as_f64()),
                    Value::Object(properties) if name == "properties" => words.extend(properties.keys().cloned()),
                    Value::Array(choices) if name == "enum" => {
                        words.extend(choices.iter().filter_map(Value::as_str).map(str::to_owned));
                    }
                    _ => {}
                }
                learn(member, words, numbers);
            }
        }
        Value::Array(parts) => parts.iter().for_each(|part| learn(part, words, numbers)),
        _ => {}
    }
}

/// How many values there are in a tree.
fn count(tree: &Value) -> usize {
    1 + match tree {
        Value::Array(list) => list.iter().map(count).sum(),
        Value::Object(members) => members.values().map(count).sum(),
        _ => 0,
    }
}

/// The value of this number among them.
fn nth<'a>(tree: &'a mut Value, number: &mut usize) -> Option<&'a mut Value> {
    if *number == 0 {
        return Some(tree);
    }
    *number -= 1;
    match tree {
        Value::Array(list) => list.iter_mut().find_map(|value| nth(value, number)),
        Value::Object(members) => members.values_mut().find_map(|value| nth(value, number)),
        _ => None,
    }
}
