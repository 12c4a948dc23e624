//! `POST /simulate`: flies a case.

use axum::extract::State;
use axum::http::request::Parts;
use axum::response::Response;

use crate::answer;
use crate::compute::Task;
use crate::error::ApiError;
use crate::extract::Payload;
use crate::format::Format;
use crate::reply::reply;
use crate::state::AppState;
use crate::wire::schema::names::SimulateRequest;
use crate::wire::trajectory::SimulateResponse;

/// Flies a case.
///
/// Integrates the motion of a point mass from its initial state until it crosses the stop altitude downwards or the stop time
/// is reached, and answers with the initial and final state, the peaks and the trajectory.
/// `text/csv` has the trajectory alone: a header of the names, and a line an instant.
///
/// The rest are maps, in degrees whatever the unit of the case: the track with a vertex a row and its time, the end, the peaks and the
/// events as points with their value, unit, time and altitude. Altitudes are above the planet's ellipsoid. `application/geo+json` is a feature
/// collection: the track, cut at the antimeridian, with `times` and, with an epoch, `times_utc` in the shape of its coordinates, and with
/// the warnings of the flight. `application/vnd.google-earth.kml+xml` is a `gx:Track` with an epoch, and a line without instants
/// without one. `application/czml+json` is a list of packets, which starts at 2000-01-01T12:00:00Z without an epoch. The places are
/// those of the case's planet, which a map takes for the Earth's.
#[utoipa::path(
    post,
    path = "/simulate",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json`, `csv`, `geojson`, `kml` or `czml`; wins over `Accept`.")),
    request_body = SimulateRequest,
    responses(
        (status = 200, description = "The flight.", content(
            (SimulateResponse = "application/json"),
            (String = "text/csv"),
            (Object = "application/geo+json"),
            (String = "application/vnd.google-earth.kml+xml"),
            (Vec<Object> = "application/czml+json"),
        )),
    ),
)]
pub async fn simulate(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &Format::OF_FLIGHTS)?;
    let row_limit = app.config.row_limit;
    let run = move |task: &Task| answer::simulate(body.json(task)?, format, row_limit, task);
    reply(&app, "/simulate", &parts, format.media_type(), run).await
}
