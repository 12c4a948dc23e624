//! The type `geodetic`.

use reentry::coordinates;
use reentry::planet::Planet;
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::ToSchema;

use super::{Sidereal, within};
use crate::wire::AngleUnit;
use crate::wire::epoch::SiderealTime;
use crate::wire::reader::{Fault, Object};

/// Place and motion relative to the rotating planet, against the geodetic horizontal.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Geodetic {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Height above the planet's shape along its normal, m.
    #[schema(minimum = -1e12, maximum = 1e12)]
    pub geodetic_altitude: f64,
    /// East positive, within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    pub longitude: f64,
    /// Within ±π/2 (±90°).
    #[schema(minimum = -90, maximum = 90)]
    pub geodetic_latitude: f64,
    /// Relative to the rotating planet, m/s.
    #[schema(minimum = 0, maximum = 1e6)]
    pub speed: f64,
    /// Of the relative velocity above the geodetic horizontal, within ±π/2 (±90°).
    #[schema(minimum = -90, maximum = 90)]
    pub flight_path_angle: f64,
    /// Clockwise from north, within ±2π (±360°); answers give [0, 2π).
    #[schema(minimum = -360, maximum = 360)]
    pub azimuth: f64,
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned, within ±1e9. Default 0, or from the
    /// `epoch`. At most one of `sidereal_time` and `sidereal_angle`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
    /// The same as an angle: from the inertial frame to the planet-fixed one, eastwards, within ±2π (±360°).
    #[schema(minimum = -360, maximum = 360)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_angle: Option<f64>,
}

impl Geodetic {
    pub(super) fn read(object: &mut Object, has_epoch: bool) -> Option<Self> {
        let geodetic_altitude = object.number("geodetic_altitude", Bound::DISTANCE);
        let longitude = object.angle("longitude", Bound::TURN);
        let geodetic_latitude = object.angle("geodetic_latitude", Bound::QUARTER_TURN);
        let speed = object.number("speed", Bound::SPEED);
        let flight_path_angle = object.angle("flight_path_angle", Bound::QUARTER_TURN);
        let azimuth = object.angle("azimuth", Bound::TURN);
        let sidereal = Sidereal::read(object, has_epoch);
        Some(Self {
            kind: "geodetic",
            geodetic_altitude: geodetic_altitude?,
            longitude: longitude?,
            geodetic_latitude: geodetic_latitude?,
            speed: speed?,
            flight_path_angle: flight_path_angle?,
            azimuth: azimuth?,
            sidereal_time: sidereal?.time,
            sidereal_angle: sidereal?.angle,
        })
    }

    /// The altitude must not reach down beyond the centre, to the other side.
    pub(super) fn faults(&self, pointer: &str, unit: AngleUnit, planet: &Planet) -> Vec<Fault> {
        let state = self.to_core(unit);
        let foot = coordinates::Geodetic { geodetic_altitude: 0.0, ..state };
        let [here, foot] = [state, foot].map(|state| state.to_planet_fixed(&planet.shape).position);
        let beyond = here.dot(&foot) < 0.0;
        let detail = format!("must lie above the planet's centre, {:.0} m below the surface here", foot.norm());
        beyond.then(|| Fault::new(format!("{pointer}/geodetic_altitude"), detail)).into_iter().collect()
    }

    pub(super) fn to_core(&self, unit: AngleUnit) -> coordinates::Geodetic {
        coordinates::Geodetic {
            geodetic_altitude: self.geodetic_altitude,
            longitude: unit.to_radians(self.longitude),
            geodetic_latitude: unit.to_radians(self.geodetic_latitude),
            speed: self.speed,
            flight_path_angle: unit.to_radians(self.flight_path_angle),
            azimuth: unit.to_radians(self.azimuth),
        }
    }

    /// The state in the given unit of angles.
    pub fn from_core(state: &coordinates::Geodetic, unit: AngleUnit, sidereal: Sidereal) -> Self {
        Self {
            kind: "geodetic",
            geodetic_altitude: state.geodetic_altitude,
            longitude: unit.from_radians(state.longitude),
            geodetic_latitude: unit.from_radians(state.geodetic_latitude),
            speed: within(Bound::SPEED, state.speed),
            flight_path_angle: unit.from_radians(state.flight_path_angle),
            azimuth: unit.turn_from_radians(state.azimuth),
            sidereal_time: sidereal.time,
            sidereal_angle: sidereal.angle,
        }
    }
}
