//! `POST /simulate`.

use axum::http::StatusCode;
use reentry_tests::service::Service;
use serde_json::Value;

#[tokio::test]
async fn answers_the_target_case() {
    let case: Value = serde_json::from_str(include_str!("../../openapi/examples/target_2.json")).unwrap();
    let answer = Service::new().post("/simulate", &case).await;
    assert_eq!(answer.status, StatusCode::OK);
    assert_eq!(answer.json()["termination"], "surface_impact");
}
