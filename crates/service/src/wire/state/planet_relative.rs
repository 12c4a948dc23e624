//! The type `planet_relative`.

use std::f64::consts::FRAC_PI_2;

use reentry::coordinates::FlightPath;
use reentry::planet::Planet;
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::{Sidereal, centre_faults, radius_of, within};
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
    /// From east (0) towards north (π/2), within ±2π (±360°). Exactly one of `heading` and `azimuth`.
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub heading: Option<f64>,
    /// Clockwise from north, within ±2π (±360°). Exactly one of `heading` and `azimuth`.
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub azimuth: Option<f64>,
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned, within ±1e9. Default 0, or from the
    /// `epoch`. At most one of `sidereal_time` and `sidereal_angle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
    /// The same as an angle: from the inertial frame to the planet-fixed one, eastwards, within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_angle: Option<f64>,
}

impl PlanetRelative {
    pub(super) fn read(object: &mut Object, has_epoch: bool) -> Option<Self> {
        let radius = object.optional_number("radius", Bound::RADIUS);
        let altitude = object.optional_number("altitude", Bound::DISTANCE);
        let place = object.exactly_one(&["radius", "altitude"]);
        let longitude = object.angle("longitude", Bound::TURN);
        let geocentric_latitude = object.angle("geocentric_latitude", Bound::QUARTER_TURN);
        let speed = object.number("speed", Bound::SPEED);
        let flight_path_angle = object.angle("flight_path_angle", Bound::QUARTER_TURN);
        let heading = object.optional_angle("heading", Bound::TURN);
        let azimuth = object.optional_angle("azimuth", Bound::TURN);
        let direction = object.exactly_one(&["heading", "azimuth"]);
        let sidereal = Sidereal::read(object, has_epoch);
        place?;
        direction?;
        Some(Self {
            kind: "planet_relative",
            radius,
            altitude,
            longitude: longitude?,
            geocentric_latitude: geocentric_latitude?,
            speed: speed?,
            flight_path_angle: flight_path_angle?,
            heading,
            azimuth,
            sidereal_time: sidereal?.time,
            sidereal_angle: sidereal?.angle,
        })
    }

    /// The altitude must not reach down to the centre.
    pub(super) fn faults(&self, pointer: &str, unit: AngleUnit, planet: &Planet) -> Vec<Fault> {
        centre_faults(pointer, self.to_core(unit, planet).radius, self.altitude)
    }

    pub(super) fn to_core(&self, unit: AngleUnit, planet: &Planet) -> FlightPath<f64> {
        let geocentric_latitude = unit.to_radians(self.geocentric_latitude);
        let heading = self.heading.map(|heading| unit.to_radians(heading));
        let from_azimuth = self.azimuth.map(|azimuth| FRAC_PI_2 - unit.to_radians(azimuth));
        FlightPath {
            radius: radius_of(self.radius, self.altitude, geocentric_latitude, planet),
            longitude: unit.to_radians(self.longitude),
            geocentric_latitude,
            speed: self.speed,
            flight_path_angle: unit.to_radians(self.flight_path_angle),
            heading: heading.or(from_azimuth).unwrap_or(f64::NAN),
        }
    }

    /// The state in the given unit of angles.
    pub fn from_core(state: &FlightPath<f64>, unit: AngleUnit, sidereal: Sidereal) -> Self {
        Self {
            kind: "planet_relative",
            radius: Some(within(Bound::RADIUS, state.radius)),
            altitude: None,
            longitude: unit.from_radians(state.longitude),
            geocentric_latitude: unit.from_radians(state.geocentric_latitude),
            speed: within(Bound::SPEED, state.speed),
            flight_path_angle: unit.from_radians(state.flight_path_angle),
            heading: Some(unit.from_radians(state.heading)),
            azimuth: None,
            sidereal_time: sidereal.time,
            sidereal_angle: sidereal.angle,
        }
    }
}
