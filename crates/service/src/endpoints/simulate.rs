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

/// Simulate one case.
///
/// Integrates the motion of a point mass from its initial state until a stop condition is met, and returns the initial
/// and final states, the peaks and the trajectory. `text/csv` contains only the trajectory: a header with the column
/// names, and one line per row.
///
/// The bodies that leave the vehicle are flown too, on its clock, and given in `bodies`. In a table their rows follow
/// those of the vehicle, and each row begins with the name of the body, empty for the vehicle, in a column `body`; maps
/// have a track and points for each body, with its name as `body`, and an ephemeris message segments for each.
///
/// `text/vnd.ccsds.oem` is an Orbit Ephemeris Message of CCSDS 502.0-B: states in GCRF at the Earth, in MCI at Mars. It
/// requires an epoch.
///
/// The other formats are maps, in degrees regardless of `angle_unit`. They contain the track, with one vertex and its
/// time per row, and the end, the peaks and the events as points with their value, unit, time and altitude. Altitudes
/// are above the planet's ellipsoid. `application/geo+json` is a feature collection: the track is cut at the
/// antimeridian and has `times` and, with an epoch, `times_utc` in the shape of its coordinates, and the warnings of
/// the flight. `application/vnd.google-earth.kml+xml` is a `gx:Track` with an epoch, and a line without times
/// otherwise. `application/czml+json` is a list of packets; without an epoch it starts at 2000-01-01T12:00:00Z.
/// Positions are those on the planet of the case; maps show them on the Earth.
#[utoipa::path(
    post,
    path = "/simulate",
    tag = "reentry",
    params(("format" = Option<String>, Query, description = "`json`, `csv`, `geojson`, `kml`, `czml` or \
                                                             `oem`; takes precedence over `Accept`.")),
    request_body = SimulateRequest,
    responses(
        (status = 200, description = "Simulated flight.", content(
            (SimulateResponse = "application/json"),
            (String = "text/csv"),
            (Object = "application/geo+json"),
            (String = "application/vnd.google-earth.kml+xml"),
            (Vec<Object> = "application/czml+json"),
            (String = "text/vnd.ccsds.oem"),
        )),
    ),
)]
pub async fn simulate(State(app): State<AppState>, parts: Parts, body: Payload) -> Result<Response, ApiError> {
    let format = Format::negotiate(&parts, &Format::OF_FLIGHTS)?;
    let row_limit = app.config.row_limit;
    let run = move |task: &Task| answer::simulate(body.json(task)?, format, row_limit, task);
    reply(&app, "/simulate", &parts, format.media_type(), run).await
}
