//! The type `planet_relative`.

use reentry::coordinates::FlightPath;
use reentry::planet::Planet;
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::{centre_faults, radius_of, sidereal_time, within};
use crate::wire::AngleUnit;
use crate::wire::epoch::SiderealTime;
use crate::wire::reader::{Fault, Object};

/// Place and motion relative to the rotating planet, against the geocentric horizontal: the thesis's vehicle-pointing system.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct PlanetRelative {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Distance from the planet's centre, m. Exactly one of `radius` and `altitude`.
    #[schema(exclusive_minimum = 0, maximum = 1e12)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub radius: Option<f64>,
    /// Height above the planet's shape along the radius vector, m. Exactly one of `radius` and `altitude`.
    #[schema(minimum = -1e12, maximum = 1e12)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub altitude: Option<f64>,
    /// East positive, within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    pub longitude: f64,
    /// Within ±π/2 (±90°).
    #[schema(minimum = -90, maximum = 90)]
    pub geocentric_latitude: f64,
    /// Relative to the rotating planet, m/s.
    #[schema(minimum = 0, maximum = 1e6)]
    pub speed: f64,
    /// Of the relative velocity above the local horizontal (the plane normal to the radius), within ±π/2 (±90°).
    #[schema(minimum = -90, maximum = 90)]
    pub flight_path_angle: f64,
    /// From east (0) towards north (π/2), within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    pub heading: f64,
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned. Default 0, or from the `epoch`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
}

impl PlanetRelative {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let radius = object.optional_number("radius", Bound::RADIUS);
        let altitude = object.optional_number("altitude", Bound::DISTANCE);
        let place = object.exactly_one(&["radius", "altitude"]);
        let longitude = object.angle("longitude", Bound::TURN);
        let geocentric_latitude = object.angle("geocentric_latitude", Bound::QUARTER_TURN);
        let speed = object.number("speed", Bound::SPEED);
        let flight_path_angle = object.angle("flight_path_angle", Bound::QUARTER_TURN);
        let heading = object.angle("heading", Bound::TURN);
        let sidereal_time = sidereal_time(object);
        place?;
        Some(Self {
            kind: "planet_relative",
            radius,
            altitude,
            longitude: longitude?,
            geocentric_latitude: geocentric_latitude?,
            speed: speed?,
            flight_path_angle: flight_path_angle?,
            heading: heading?,
            sidereal_time,
        })
    }

    /// The altitude must not reach down to the centre.
    pub(super) fn faults(&self, pointer: &str, unit: AngleUnit, planet: &Planet) -> Vec<Fault> {
        centre_faults(pointer, self.to_core(unit, planet).radius, self.altitude)
    }

    pub(super) fn to_core(&self, unit: AngleUnit, planet: &Planet) -> FlightPath<f64> {
        let geocentric_latitude = unit.to_radians(self.geocentric_latitude);
        FlightPath {
            radius: radius_of(self.radius, self.altitude, geocentric_latitude, planet),
            longitude: unit.to_radians(self.longitude),
            geocentric_latitude,
            speed: self.speed,
            flight_path_angle: unit.to_radians(self.flight_path_angle),
            heading: unit.to_radians(self.heading),
        }
    }

    /// The state in the given unit of angles.
    pub fn from_core(state: &FlightPath<f64>, unit: AngleUnit, sidereal_time: f64) -> Self {
        Self {
            kind: "planet_relative",
            radius: Some(within(Bound::RADIUS, state.radius)),
            altitude: None,
            longitude: unit.from_radians(state.longitude),
            geocentric_latitude: unit.from_radians(state.geocentric_latitude),
            speed: within(Bound::SPEED, state.speed),
            flight_path_angle: unit.from_radians(state.flight_path_angle),
            heading: unit.from_radians(state.heading),
            sidereal_time: Some(SiderealTime(sidereal_time)),
        }
    }
}
