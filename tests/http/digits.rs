//! The digits of the answers to all examples: they are the same on every processor, and change with the program alone.

use axum::http::StatusCode;
use reentry_tests::service::Service;
use serde_json::Value;

/// The answers' digits, by the names of the examples. Where they are meant to change, the failing test prints them anew.
const DIGITS: &[(&str, u64)] = &[
    ("/simulate deorbit", 0xc0d1_1df5_7eff_fb80),
    ("/simulate lifting_capsule", 0x7628_029c_0dea_e755),
    ("/simulate sample_return", 0x44de_482b_17e0_e74f),
    ("/simulate mars", 0x1e2c_2d5c_9c72_1bef),
    ("/simulate titan", 0x6258_b4c9_f657_89a4),
    ("/simulate launcher", 0xe87b_7b1f_2daa_e089),
    ("/simulate sounding_rocket", 0x247e_50a1_6ad2_222f),
    ("/simulate abort", 0x1c6d_b382_e653_cfe7),
    ("/simulate target_1", 0x80b7_3fda_c4ab_f263),
    ("/simulate target_2", 0xa718_9ee9_d5b7_2e29),
    ("/simulate impulse", 0x1103_75e2_1728_87a6),
    ("/analytic steep_ballistic", 0x12b5_49f1_7621_8cbb),
    ("/convert impulse", 0xbd84_5766_3ce2_60f9),
];

/// A number by all characters of a text (FNV-1a).
fn hash(text: &str) -> u64 {
    text.bytes().fold(0xcbf2_9ce4_8422_2325, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

#[tokio::test]
async fn the_digits_of_the_examples_are_what_they_were() {
    let service = Service::patient();
    let document = service.get("/openapi.json").await.json();
    let mut found = Vec::new();
    for path in ["/simulate", "/analytic", "/convert"] {
        let examples = &document["paths"][path]["post"]["requestBody"]["content"]["application/json"]["examples"];
        for (name, example) in examples.as_object().unwrap() {
            let answer = service.post(path, &example["value"]).await;
            assert_eq!(answer.status, StatusCode::OK, "{name}");
            let mut answer = answer.json();
            for clock in ["/solver/elapsed", "/version"] {
                answer.pointer_mut(clock).map(Value::take);
            }
            found.push((format!("{path} {name}"), hash(&answer.to_string())));
        }
    }
    let known: Vec<_> = DIGITS.iter().map(|(name, hash)| ((*name).to_owned(), *hash)).collect();
    let lines: Vec<_> = found.iter().map(|(name, hash)| format!("    ({name:?}, {hash:#018x}),")).collect();
    assert_eq!(known, found, "the digits are now\n{}", lines.join("\n"));
}
