//! The digits of the answers to all examples: they are the same on every processor, and change with the program alone.

use axum::http::StatusCode;
use reentry_tests::service::Service;
use serde_json::Value;

/// The answers' digits, by the names of the examples. Where they are meant to change, the failing test prints them anew.
const DIGITS: &[(&str, u64)] = &[
    ("/simulate deorbit", 0xc571_de3d_282e_60d4),
    ("/simulate lifting_capsule", 0x2a43_ef33_9076_0cb2),
    ("/simulate sample_return", 0xb392_a237_3fb7_6dfd),
    ("/simulate mars", 0xee9e_dac5_6502_60bc),
    ("/simulate titan", 0x4f2c_b35f_62a7_3cc7),
    ("/simulate launcher", 0x8df1_c258_68f7_9a3a),
    ("/simulate sounding_rocket", 0xe689_4f9b_852a_3c0c),
    ("/simulate abort", 0x3cad_5f61_7067_5e19),
    ("/simulate target_1", 0x9ccf_8ca1_3533_2eb7),
    ("/simulate target_2", 0xf77c_3e97_8093_d58a),
    ("/simulate impulse", 0xe935_64ef_1a66_1410),
    ("/analytic steep_ballistic", 0x4589_94bf_aaf1_ed5c),
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
