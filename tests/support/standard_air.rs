//! The table of the guide that flies the thesis's cases through the U.S. Standard Atmosphere, 1976, over HTTP.

use std::fmt::Write;

use serde_json::{Value, json};

use crate::cases::{distance, thesis_cases};
use crate::service::Service;

/// What the one layer of the thesis's atmosphere gets wrong, with the constants of its listing: the impact, and the greatest
/// deceleration.
pub async fn table() -> String {
    let service = Service::new();
    let mut table = "| case | impact at | moved by | speed there | greatest deceleration | at altitude |\n".to_owned();
    table += "| --- | --- | --- | --- | --- | --- |\n";
    for case in thesis_cases().into_iter().filter(|case| case.model == "earth_jameson_listing") {
        let mut request = case.request;
        request["output"] = json!({"trajectory": false});
        let thesis = service.post("/simulate", &request).await.json();
        request["atmosphere"] = json!({"type": "us76"});
        let standard = service.post("/simulate", &request).await.json();
        let both = |pointer: &str, unit: f64, decimals: usize| {
            let of = |answer: &Value| answer.pointer(pointer).and_then(Value::as_f64).unwrap_or(f64::NAN) / unit;
            format!("{:.decimals$} → {:.decimals$}", of(&thesis), of(&standard))
        };
        let moved = distance(&thesis["final_state"], &standard["final_state"]);
        let moved = if moved < 1e3 { format!("{moved:.0} m") } else { format!("{:.1} km", moved / 1e3) };
        // A text takes any row.
        let _ = writeln!(
            table,
            "| {} | {} s | {moved} | {} m/s | {} m/s² | {} km |",
            case.title.trim_start_matches("Jameson 2006, "),
            both("/final_state/time", 1.0, 1),
            both("/final_state/speed", 1.0, 0),
            both("/peaks/deceleration/value", 1.0, 0),
            both("/peaks/deceleration/altitude", 1e3, 1),
        );
    }
    table
}
