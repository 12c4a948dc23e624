//! The names of the events of a vehicle or a body, by which others refer to them.

use serde_json::json;

use super::reader::Fault;
use super::shown::shown;

/// The name of each event, where it has one, in the order of the list.
#[derive(Clone, Debug)]
pub struct EventNames<'a>(Vec<Option<&'a str>>);

impl<'a> EventNames<'a> {
    /// These names.
    pub(super) fn new(names: impl Iterator<Item = Option<&'a str>>) -> Self {
        Self(names.collect())
    }

    /// The place of the first event of a name; that beyond the end of the list where there is none.
    pub(super) fn place_of(&self, name: &str) -> usize {
        self.0.iter().position(|other| *other == Some(name)).unwrap_or(self.0.len())
    }

    /// What is wrong with the name of an event, which must be that of one event alone; `pointer` is that of the name.
    pub(super) fn fault(&self, name: &str, pointer: String) -> Option<Fault> {
        let named = self.0.iter().filter(|other| **other == Some(name)).count();
        let got = shown(&json!(name));
        let detail = match named {
            0 => format!("must be the name of an event of the case, got {got}"),
            1 => return None,
            _ => format!("must be the name of exactly one event, got {got}, the name of {named} events"),
        };
        Some(Fault::new(pointer, detail))
    }
}
