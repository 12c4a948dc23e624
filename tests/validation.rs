//! Prints the tables of validation results in the README, over HTTP: every case of the thesis against an independent program, check
//! cases against NASA's simulations, and the thesis's cases in standard air.

use reentry_tests::cases::{distance, thesis_cases};
use reentry_tests::service::Service;
use serde_json::json;

#[tokio::main(flavor = "current_thread")]
async fn main() {
    let service = Service::new();
    println!("| case | constants | impact at | place off by | at 1e-12 | spherical, at 1e-12 |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for case in thesis_cases() {
        let mut misses = Vec::new();
        for solver in [
            json!({}),
            json!({"relative_tolerance": 1e-12}),
            json!({"relative_tolerance": 1e-12, "formulation": "spherical"}),
        ] {
            let mut request = case.request.clone();
            request["solver"] = solver;
            request["output"] = json!({"trajectory": false});
            let answer = service.post("/simulate", &request).await.json();
            misses.push(distance(&answer["final_state"], &case.expected["final_state"]));
        }
        let expected = &case.expected["final_state"];
        let degrees = |name: &str| expected[name].as_f64().map(f64::to_degrees).unwrap_or_default();
        let place = format!(
            "{:.3} s, {:.5}° N, {:.5}° E",
            expected["time"].as_f64().unwrap_or_default(),
            degrees("geodetic_latitude"),
            degrees("longitude"),
        );
        let [plain, fine, spherical] = misses[..] else { unreachable!("three flights") };
        let title = case.title.trim_start_matches("Jameson 2006, ");
        println!(
            "| {title} | `{}` | {place} | {} | {} | {} |",
            case.model,
            metres(plain),
            metres(fine),
            metres(spherical)
        );
    }
    println!("\n{}", reentry_tests::nesc::table().await);
    print!("{}", reentry_tests::standard_air::table().await);
}

/// A distance in a unit that suits it.
fn metres(distance: f64) -> String {
    match distance {
        distance if distance >= 1e-3 => format!("{:.1} mm", distance * 1e3),
        distance if distance >= 1e-6 => format!("{:.1} µm", distance * 1e6),
        _ => "< 1 µm".to_owned(),
    }
}
