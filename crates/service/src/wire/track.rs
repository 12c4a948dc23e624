//! Flights on a map: the places of their rows, and what is marked beside them, as `GeoJSON`, KML and CZML.
//!
//! Longitudes and latitudes are in degrees, whatever the unit of the request; latitudes and altitudes are geodetic, as the formats ask
//! for. They are those of the case's planet: on a map of the Earth they lie where the map has these numbers.

mod czml;
pub(in crate::wire) mod geojson;
mod kml;

use std::iter;

use reentry::simulate::Flights;
use reentry::trajectory::{EventPoint, FlightPoint, Trajectory};
use serde::Serialize;
use serde_json::json;

use super::epoch::{Epoch, Utc};
use super::planet::{Planet, PlanetModel};
use super::reader::Fault;
use super::trajectory::{FlightOfAnswer, Peak, SimulateResponse};

/// The flights of an answer, ready to be drawn.
#[derive(Clone, Debug)]
pub struct Track<'a> {
    answer: &'a SimulateResponse,
    epoch: Option<Epoch>,
    /// That of the vehicle first.
    tracks: Vec<BodyTrack<'a>>,
}

/// The flight of the vehicle or of a body.
#[derive(Clone, Debug)]
struct BodyTrack<'a> {
    /// The name of the body or, of the vehicle, that of the case.
    name: &'a str,
    told: FlightOfAnswer<'a>,
    /// One a row; none where the answer has no rows of the body.
    vertices: Option<Vec<Vertex>>,
    points: Vec<NamedPoint>,
}

/// A place at an instant.
#[derive(Clone, Copy, Debug)]
struct Vertex {
    /// Since the start, s.
    time: f64,
    /// Degrees, in [-180, 180].
    longitude: f64,
    /// Degrees, geodetic.
    latitude: f64,
    /// Geodetic, m.
    altitude: f64,
}

/// What is marked beside the track, and what a user sees of it.
#[derive(Clone, Debug, Serialize)]
struct NamedPoint {
    /// None of the vehicle.
    #[serde(skip_serializing_if = "Option::is_none")]
    body: Option<String>,
    name: String,
    kind: &'static str,
    quantity: &'static str,
    value: f64,
    unit: &'static str,
    time: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    utc: Option<Utc>,
    /// As the answer has it: along the radius vector, m.
    altitude: f64,
    #[serde(skip)]
    place: Vertex,
}

impl<'a> Track<'a> {
    /// The tracks of all flights, with a vertex a row.
    ///
    /// # Errors
    /// When a flight goes on after the last year that can be written.
    pub fn new(answer: &'a SimulateResponse, flights: &Flights, epoch: Option<Epoch>) -> Result<Self, Fault> {
        let is_beyond = |epoch: Epoch| flights.all().any(|flight| epoch.utc(flight.end_time()).is_none());
        if epoch.is_some_and(is_beyond) {
            return Err(Fault::new("/epoch", "must let the flight end before the year 10000 for map formats"));
        }
        let track = |(told, flight): (FlightOfAnswer<'a>, &Trajectory)| {
            let rows = told.report.trajectory.as_ref();
            BodyTrack {
                name: told.body.unwrap_or_else(|| name(answer)),
                told,
                vertices: rows.map(|rows| rows.points().iter().map(Vertex::of).collect()),
                points: marked(&told, flight, epoch),
            }
        };
        Ok(Self { answer, epoch, tracks: answer.flights().zip(flights.all()).map(track).collect() })
    }

    /// Why viewers of KML would place flights on the planet on another globe; none where they do not.
    ///
    /// `GeoJSON` names the planet beside the track, and a custom planet has no globe of its own: its places are those of the Earth's.
    pub fn kml_fault(planet: &Planet) -> Option<Fault> {
        let PlanetModel::Body(body) = planet.model else { return None };
        let globes = kml::GLOBES.join(" or ");
        let title = body.title;
        let detail = format!(
            "must be the Earth, {globes} for KML, whose viewers have no globe of {title}; GeoJSON names the planet"
        );
        (!kml::GLOBES.contains(&body.name)).then(|| Fault::new("/planet/model", detail))
    }

    /// Why viewers of CZML would place flights on the planet on another globe; none where they do not.
    pub fn czml_fault(planet: &Planet) -> Option<Fault> {
        let PlanetModel::Body(body) = planet.model else { return None };
        let title = body.title;
        let detail = format!(
            "must be the Earth for CZML, whose viewers would place {title} on its globe; GeoJSON names the planet"
        );
        Some(Fault::new("/planet/model", detail))
    }

    /// The instant of a time, with an epoch.
    fn utc(&self, time: f64) -> Option<Utc> {
        self.epoch.and_then(|epoch| epoch.utc(time))
    }
}

/// The name of the flight of the vehicle.
fn name(answer: &SimulateResponse) -> &str {
    answer.name.as_deref().unwrap_or("flight")
}

impl BodyTrack<'_> {
    /// How the flight ended and what it warns of, for people.
    fn notes(&self) -> String {
        let end = self.points.first().map(|end| format!("{}: {}", end.name, end.description()));
        let warnings = self.told.warnings.iter().map(|warning| warning.detail.clone());
        end.into_iter().chain(warnings).collect::<Vec<_>>().join("; ")
    }
}

/// Everything that is marked: the end, the peaks, and the events.
fn marked(told: &FlightOfAnswer, flight: &Trajectory, epoch: Option<Epoch>) -> Vec<NamedPoint> {
    let FlightOfAnswer { body, report, .. } = told;
    let point = |kind, name, (quantity, value, unit), point: &FlightPoint| NamedPoint {
        body: body.map(str::to_owned),
        name,
        kind,
        quantity,
        value,
        unit,
        time: point.time,
        utc: epoch.and_then(|epoch| epoch.utc(point.time)),
        altitude: point.loads.altitude,
        place: Vertex::of(point),
    };
    let speed = |point: &FlightPoint| ("speed", point.flight_path.speed, "m/s");
    let last = flight.last();
    let termination = json!(report.termination);
    let end = point("end", words(termination.as_str().unwrap_or_default()), speed(&last), &last);
    let peaks = &report.peaks;
    let peaks = [
        ("deceleration", "m/s²", Some(peaks.deceleration)),
        ("load_factor", "g", Some(peaks.load_factor)),
        ("dynamic_pressure", "Pa", Some(peaks.dynamic_pressure)),
        ("altitude", "m", Some(peaks.altitude)),
        ("speed", "m/s", Some(peaks.speed)),
        ("mach", "", peaks.mach),
        ("convective_heat_flux", "W/m²", peaks.convective_heat_flux),
        ("radiative_heat_flux", "W/m²", peaks.radiative_heat_flux.filter(|peak| peak.value > 0.0)),
        ("heat_flux", "W/m²", peaks.heat_flux),
        ("heat_load", "J/m²", peaks.heat_load),
        ("wall_temperature", "K", peaks.wall_temperature),
    ];
    let peaks = peaks.into_iter().filter_map(|(quantity, unit, peak)| {
        let Peak { value, time, .. } = peak?;
        Some(point("peak", format!("peak {}", words(quantity)), (quantity, value, unit), &flight.at(time)))
    });
    let names = report.events.iter().flatten();
    let events = names.zip(flight.events()).map(|(report, EventPoint { before, .. })| {
        let name = report.name.clone().unwrap_or_else(|| format!("event {}", report.index));
        point("event", name, speed(&before), &before)
    });
    iter::once(end).chain(peaks).chain(events).collect()
}

impl Vertex {
    fn of(point: &FlightPoint) -> Self {
        Self {
            time: point.time,
            longitude: point.flight_path.longitude.to_degrees(),
            latitude: point.geodetic_latitude.to_degrees(),
            altitude: point.geodetic_altitude,
        }
    }

    /// In the order of every format here.
    fn position(&self) -> [f64; 3] {
        [self.longitude, self.latitude, self.altitude]
    }
}

impl NamedPoint {
    /// What there is to know of it, for people.
    fn description(&self) -> String {
        let reading = format!("{} {} {}", words(self.quantity), five_digits(self.value), self.unit);
        // Without the sign of a zero.
        let altitude = self.altitude.round() + 0.0;
        format!("{}, {:.1} s after the start, at an altitude of {altitude} m", reading.trim_end(), self.time)
    }
}

/// A name of the API, for people.
fn words(name: &str) -> String {
    name.replace('_', " ")
}

/// A number for people.
fn five_digits(value: f64) -> f64 {
    format!("{value:.4e}").parse().unwrap_or(value)
}
