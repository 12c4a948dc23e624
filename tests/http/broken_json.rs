//! Bodies that are not JSON.

use serde_json::json;

use super::refusal::Steady;
use super::requests::capsule;

/// Posts a body that is not JSON, and gives the detail.
async fn detail(steady: &Steady, body: impl AsRef<[u8]>) -> String {
    let mut details = Vec::new();
    for path in ["/simulate", "/convert"] {
        let problem = steady.refused_text(path, body.as_ref().to_vec()).await;
        assert_eq!(problem["type"], "/problems/invalid-json", "{problem}");
        assert_eq!(problem.get("errors"), None);
        details.push(problem["detail"].as_str().unwrap().to_owned());
    }
    assert_eq!(details[0], details[1]);
    details.swap_remove(0)
}

#[tokio::test]
async fn the_place_where_json_ends_is_given() {
    let steady = Steady::new().await;
    for (body, place) in [
        ("", "line 1 column 0"),
        (" \n ", "line 2 column 1"),
        ("{", "line 1 column 1"),
        ("{\"vehicle\": }", "line 1 column 13"),
        ("{\"vehicle\": {},}", "line 1 column 16"),
        ("{\"vehicle\" {}}", "line 1 column 12"),
        ("{'vehicle': 1}", "line 1 column 2"),
        ("{vehicle: 1}", "line 1 column 2"),
        ("{\n  \"vehicle\": {\n    \"mass\": kg\n  }\n}", "line 3 column 13"),
        ("{\"vehicle\": {\"mass\": 13", "line 1 column 23"),
        ("[1, 2", "line 1 column 5"),
        ("[1, 2,]", "line 1 column 7"),
        ("nul", "line 1 column 3"),
        ("True", "line 1 column 1"),
        ("\"never closed", "line 1 column 13"),
        ("\"\\x\"", "line 1 column 3"),
        ("\"\\ud800\"", "line 1 column"),
        ("// a comment\n{}", "line 1 column 1"),
        ("{\"vehicle\": {}} trailing", "line 1 column 17"),
        ("{} {}", "line 1 column 4"),
        ("{}]", "line 1 column 3"),
        ("{\"name\": \"a\tb\"}", "line 1 column 12"),
        ("vehicle=1&mass=13", "line 1 column 1"),
    ] {
        let detail = detail(&steady, body).await;
        assert!(detail.starts_with("the body is not JSON: ") && detail.contains(place), "{detail} for {body:?}");
    }
}

#[tokio::test]
async fn bytes_that_are_not_utf_8_are_not_json() {
    let steady = Steady::new().await;
    for body in
        [&b"\xff"[..], b"\"\xff\"", b"{\"name\": \"\xc3\x28\"}", b"\xef\xbb\xbf{}", b"\x00", b"{\"\xed\xa0\x80\": 1}"]
    {
        let detail = detail(&steady, body).await;
        assert!(detail.contains("line 1 column "), "{detail} for {body:?}");
    }
    let utf_16: Vec<_> = capsule().to_string().encode_utf16().flat_map(u16::to_le_bytes).collect();
    assert!(detail(&steady, utf_16).await.contains("line 1 column "));
}

#[tokio::test]
async fn a_key_that_occurs_twice_is_refused_wherever_it_is() {
    let steady = Steady::new().await;
    for (body, key, place) in [
        ("{\"name\": 1, \"name\": 1}", "name", "line 1 column 18"),
        ("{\"vehicle\": {\"mass\": 1,\n\"mass\": 2}}", "mass", "line 2 column 6"),
        ("{\"a\": {\"b\": [0, {\"c\": 1, \"\\u0063\": 2}]}}", "c", "line 1 column 33"),
        ("[{\"\": 1, \"\": 1}]", "", "line 1 column 11"),
    ] {
        let detail = detail(&steady, body).await;
        assert!(detail.contains(&format!("duplicate key {key:?}")) && detail.contains(place), "{detail} for {body}");
    }
    let case = capsule().to_string().replacen("\"mass\":5500", "\"mass\":5500,\"mass\":5500", 1);
    assert!(detail(&steady, case).await.contains("duplicate key \"mass\""));
}

#[tokio::test]
async fn deep_nesting_is_refused() {
    let steady = Steady::new().await;
    for (open, close) in [("[", "]"), ("{\"a\":", "}"), ("[{\"a\":", "}]")] {
        for closed in ["", close] {
            let body = format!("{}{}", open.repeat(10_000), closed.repeat(10_000));
            let detail = detail(&steady, body).await;
            assert!(detail.contains("recursion limit exceeded at line 1 column "), "{detail}");
        }
    }
}

#[tokio::test]
async fn nesting_below_the_limit_is_json_but_no_case() {
    let steady = Steady::new().await;
    let body = json!({"name": (0..100).fold(json!([]), |inner, _| json!([inner]))});
    steady.refused_at("/convert", &body, &[("/state", "is required"), ("/name", "is not a field here")]).await;
}
