//! The reference cases in `cases/`, with their sources.

use std::fs;
use std::path::Path;

use serde_json::{Value, json};

/// A case of the thesis under one set of planet constants, with the solution of an independent program.
#[derive(Clone, Debug)]
pub struct ThesisCase {
    /// The name of its file, for example `target_2`.
    pub name: String,
    /// What it is, with the table of the thesis.
    pub title: String,
    /// `planet.model`.
    pub model: String,
    /// The request of `/simulate`, planet included, at default tolerance.
    pub request: Value,
    /// Its answer: `termination`, `initial_state`, `final_state`, `peaks`, and `samples` in between.
    pub expected: Value,
}

/// The seven cases of the thesis under three sets of constants.
///
/// # Panics
/// When a file is not what it should be.
#[expect(clippy::expect_used, reason = "the files are part of the tests")]
pub fn thesis_cases() -> Vec<ThesisCase> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases/thesis");
    let mut files: Vec<_> = fs::read_dir(folder).expect("the folder").flatten().map(|entry| entry.path()).collect();
    files.sort();
    let mut cases: Vec<_> = files.iter().flat_map(|file| cases_of(&read_json(file))).collect();
    // By the tables of the thesis.
    cases.sort_by(|a, b| a.title.cmp(&b.title));
    cases
}

fn cases_of(file: &Value) -> Vec<ThesisCase> {
    let text = |value: &Value| value.as_str().unwrap_or_default().to_owned();
    let expected = file["expected"].as_object().into_iter().flatten();
    expected
        .map(|(model, expected)| {
            let mut request = file["request"].clone();
            request["planet"] = json!({"model": model, "shape": file["shape"]});
            ThesisCase {
                name: text(&file["request"]["name"]),
                title: text(&file["title"]),
                model: model.clone(),
                request,
                expected: expected.clone(),
            }
        })
        .collect()
}

/// Reads a JSON file.
///
/// # Panics
/// When it is not there or not JSON.
pub fn read_json(file: &Path) -> Value {
    let text = fs::read_to_string(file).unwrap_or_else(|error| panic!("{}: {error}", file.display()));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// The rows of a table of comma-separated values: fields by the order of the header; lines that begin with # are its source.
///
/// # Panics
/// When the file is not there.
pub fn read_csv(file: &str) -> Vec<Vec<String>> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases").join(file);
    let text = fs::read_to_string(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let lines = text.lines().filter(|line| !line.starts_with('#')).skip(1);
    lines.map(|line| line.split(',').map(str::to_owned).collect()).collect()
}

/// The distance, m, between the places of two states of the API in radians.
///
/// # Panics
/// When a field is missing.
pub fn distance(a: &Value, b: &Value) -> f64 {
    let place = |state: &Value| {
        let field = |name: &str| state[name].as_f64().unwrap_or_else(|| panic!("{name} in {state}"));
        let (sin_lon, cos_lon) = field("longitude").sin_cos();
        let (sin_lat, cos_lat) = field("geocentric_latitude").sin_cos();
        let radius = field("radius");
        [radius * cos_lat * cos_lon, radius * cos_lat * sin_lon, radius * sin_lat]
    };
    let (a, b) = (place(a), place(b));
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}
