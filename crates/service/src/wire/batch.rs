//! The request of `/simulate/batch`: a list of cases.

use serde_json::value::RawValue;

use super::reader::Fault;

/// The greatest number of cases of a batch.
pub const MOST_CASES: usize = 1000;

/// The cases of a batch, from the elements of the request; each is still to be parsed.
///
/// # Errors
/// When the request is no list, or one of no cases or too many.
pub fn cases(elements: Option<Vec<&RawValue>>) -> Result<Vec<&RawValue>, Vec<Fault>> {
    let fault = |detail| Err(vec![Fault::new("", detail)]);
    match elements {
        None => fault("must be an array of cases, each a request of /simulate".to_owned()),
        Some(cases) if cases.is_empty() => fault("must have at least 1 case, got none".to_owned()),
        Some(cases) if cases.len() > MOST_CASES => Err(vec![too_many(cases.len())]),
        Some(cases) => Ok(cases),
    }
}

/// The fault of a list of so many cases.
pub fn too_many(count: usize) -> Fault {
    Fault::new("", format!("must have at most {MOST_CASES} cases, got {count}"))
}
