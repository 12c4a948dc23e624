//! The table of the guide that sets the theories beside the simulation, over HTTP.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::cases::{ThesisCase, thesis_cases};
use crate::service::Service;

/// The case of the thesis for each solution.
const COMPARISONS: [(&str, &str); 5] = [
    ("shallow_glide", "shallow_glide"),
    ("shallow_glide", "loh"),
    ("steep_glide", "steep_glide"),
    ("steep_ballistic", "steep_ballistic"),
    ("medium_glide_supercircular", "medium_glide"),
];

/// Rows enough that the greatest deviation has the digits that the table shows.
const ROWS: usize = 20_000;

/// How far each theory is off at most, on Tables 4 to 7 of the thesis with the constants of its listing.
pub async fn table() -> String {
    let service = Service::new();
    let mut table =
        "| case | solution | holds | ends because | speed off by | angle off by | drag off by |\n".to_owned();
    table += "| --- | --- | --- | --- | --- | --- | --- |\n";
    for (name, solution) in COMPARISONS {
        let listed = |case: &ThesisCase| case.name == name && case.model == "earth_jameson_listing";
        let Some(ThesisCase { title, mut request, .. }) = thesis_cases().into_iter().find(listed) else { continue };
        request["solution"] = json!(solution);
        request["output"] = json!({"count": ROWS});
        let answer = service.post("/analytic", &request).await.json();
        let title = title.trim_start_matches("Jameson 2006, ");
        // A text takes any row.
        let _ = writeln!(table, "| {title} | `{solution}` | {}", deviations(&answer));
    }
    table
}

fn deviations(answer: &Value) -> String {
    let column = |place: &str, name: &str| {
        let column = answer[place][name].as_array().cloned().unwrap_or_default();
        column.iter().map(Value::as_f64).collect::<Vec<_>>()
    };
    let greatest = |numbers: &mut dyn Iterator<Item = f64>| numbers.map(f64::abs).reduce(f64::max);
    let speeds = column("simulated", "speed");
    let mut relative = column("differences", "speed").into_iter().zip(speeds).filter_map(|(off, of)| Some(off? / of?));
    let angle = greatest(&mut column("differences", "flight_path_angle").into_iter().flatten());
    let drag = greatest(&mut column("differences", "drag_deceleration").into_iter().flatten());
    let peak = greatest(&mut column("simulated", "drag_deceleration").into_iter().flatten());
    let valid = &answer["valid"];
    let kilometres = |name: &str| valid[name].as_f64().map_or(f64::NAN, |altitude| altitude / 1000.0);
    let percent = |part: Option<f64>| part.map_or("-".to_owned(), |part| format!("{:.2} %", 100.0 * part));
    format!(
        "{:.2} to {:.2} km | {} | {} | {} | {} of the peak |",
        kilometres("from_altitude"),
        kilometres("to_altitude").max(0.0),
        valid["ends_because"].as_str().unwrap_or_default().replace('|', "\\|"),
        percent(greatest(&mut relative)),
        angle.map_or("-".to_owned(), |angle| format!("{:.2}°", angle.to_degrees())),
        percent(drag.zip(peak).map(|(drag, peak)| drag / peak)),
    )
    .replace("- of the peak", "-")
}
