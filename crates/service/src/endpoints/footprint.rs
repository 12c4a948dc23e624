//! `POST /footprint`: the ground that flights reach when numbers of a case vary.

use std::time::Instant;

use axum::extract::State;
use axum::http::request::Parts;
use axum::response::Response;

use crate::answer;
use crate::compute::Task;
use crate::endpoints::target::SHARE_OF_SEARCH;
use crate::error::ApiError;
use crate::extract::Payload;
use crate::format::Format;
use crate::reply::reply;
use crate::state::AppState;
use crate::wire::footprint::FootprintResponse;
use crate::wire::schema::names::FootprintRequest;

/// Find the landing footprint of a case.
///
/// Varies up to eight numbers of the case within ranges and returns the ground that flights reach which keep all limits:
/// its boundary, its area, and the landings with the least and the greatest downrange and crossrange. If one number
/// varies, the footprint is a curve; if three or more vary, the boundary is the farthest that flights reach in each
/// direction from a point within it. If flights or time run out, the response is 200 with `complete` false.
///
/// `application/geo+json` is a feature collection with the boundary, the convex hull, the curve, the landing of the case
/// and the four extreme landings, in degrees regardless of `angle_unit`.
#[utoipa::path(
    post,
    path = "/footprint",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json` or `geojson`; takes precedence over `Accept`.")),
    request_body = FootprintRequest,
    responses((status = 200, description = "Boundary, area and extremes.", content(
        (FootprintResponse = "application/json"),
        (Object = "application/geo+json"),
    ))),
)]
pub async fn footprint(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &Format::OF_FOOTPRINTS)?;
    let until = Instant::now() + app.config.deadline.mul_f64(SHARE_OF_SEARCH);
    let run = move |task: &Task| answer::footprint(body.json(task)?, format, Some(until), task);
    reply(&app, "/footprint", &parts, format.media_type(), run).await
}
