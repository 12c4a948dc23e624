//! The digits of the answers to all examples: they are the same on every processor, and change with the program alone.

use axum::http::StatusCode;
use reentry_tests::service::Service;
use serde_json::Value;

/// The answers' digits, by the names of the examples. Where they are meant to change, the failing test prints them anew.
const DIGITS: &[(&str, u64)] = &[
    ("/simulate deorbit", 0x4d85_fde2_bf65_44ca),
    ("/simulate lifting_capsule", 0xa18e_f728_cf7e_99f7),
    ("/simulate sample_return", 0x35c2_bdca_755b_94a9),
    ("/simulate mars", 0xc0a8_a779_2bda_627e),
    ("/simulate titan", 0x46b0_96fc_357f_dce5),
    ("/simulate launcher", 0xd605_8acd_7064_e3f2),
    ("/simulate sounding_rocket", 0x7ea4_7dd4_9a0b_0552),
    ("/simulate abort", 0x8aa3_69a2_04d6_9c7a),
    ("/simulate target_1", 0x9b3b_dd8b_3138_4a2f),
    ("/simulate target_2", 0xd16f_d32b_a2dc_7b2e),
    ("/simulate impulse", 0xd9cb_2064_acba_f1fd),
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
