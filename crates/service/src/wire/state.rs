//! The states of the API: the six ways to write where a vehicle is and how it moves.

mod geodetic;
mod inertial_flight_path;
mod orbital_elements;
mod planet_relative;
mod vectors;

pub use geodetic::Geodetic;
pub use inertial_flight_path::InertialFlightPath;
pub use orbital_elements::OrbitalElements;
pub use planet_relative::PlanetRelative;
pub use vectors::{Ecef, Eci};

use reentry::coordinates::{Inertial, PlanetFixed};
use reentry::planet::Planet;
use reentry::scenario::{Bound, state_faults};
use serde::Serialize;
use utoipa::ToSchema;

use super::AngleUnit;
use super::epoch::{Instant, SiderealTime};
use super::reader::{Fault, Object};

/// A state, in one of six coordinate systems. Angles are in the request's `angle_unit`.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(
    ("planet_relative" = "#/components/schemas/PlanetRelative"),
    ("geodetic" = "#/components/schemas/Geodetic"),
    ("ecef" = "#/components/schemas/Ecef"),
    ("eci" = "#/components/schemas/Eci"),
    ("orbital_elements" = "#/components/schemas/OrbitalElements"),
    ("inertial_flight_path" = "#/components/schemas/InertialFlightPath"),
)))]
pub enum State {
    /// Speed and angles against the geocentric horizontal.
    PlanetRelative(PlanetRelative),
    /// Speed and angles against the geodetic horizontal.
    Geodetic(Geodetic),
    /// Planet-fixed vectors.
    Ecef(Ecef),
    /// Inertial vectors.
    Eci(Eci),
    /// An orbit.
    OrbitalElements(OrbitalElements),
    /// Speed and angles of the inertial velocity against the geocentric horizontal.
    InertialFlightPath(InertialFlightPath),
}

impl State {
    /// Reads a state of any kind.
    pub fn read(object: &mut Object) -> Option<Self> {
        let read = object.choice::<fn(&mut Object) -> Option<Self>>(
            "type",
            &[
                ("planet_relative", |object| PlanetRelative::read(object).map(Self::PlanetRelative)),
                ("geodetic", |object| Geodetic::read(object).map(Self::Geodetic)),
                ("ecef", |object| Ecef::read(object).map(Self::Ecef)),
                ("eci", |object| Eci::read(object).map(Self::Eci)),
                ("orbital_elements", |object| OrbitalElements::read(object).map(Self::OrbitalElements)),
                ("inertial_flight_path", |object| InertialFlightPath::read(object).map(Self::InertialFlightPath)),
            ],
        )?;
        read(object)
    }

    /// The sidereal time that the state gives.
    pub fn sidereal_time(&self) -> Option<SiderealTime> {
        match self {
            Self::PlanetRelative(state) => state.sidereal_time,
            Self::Geodetic(state) => state.sidereal_time,
            Self::Ecef(state) => state.sidereal_time,
            Self::Eci(state) => state.sidereal_time,
            Self::OrbitalElements(state) => state.sidereal_time,
            Self::InertialFlightPath(state) => state.sidereal_time,
        }
    }

    /// Whether the state is given by directions of the inertial frame, which its epoch names; planet-fixed places are not, whatever
    /// their velocity is relative to.
    pub fn is_inertial(&self) -> bool {
        matches!(self, Self::Eci(_) | Self::OrbitalElements(_))
    }

    /// The planet-fixed position and velocity of a state at the pointer, and its sidereal time in seconds, which follows
    /// from the epoch where the state does not give it.
    ///
    /// # Errors
    /// With everything that is wrong across its fields.
    pub fn at(
        &self,
        epoch: Option<Instant>,
        pointer: &str,
        unit: AngleUnit,
        planet: &Planet,
    ) -> Result<(PlanetFixed<f64>, f64), Vec<Fault>> {
        let mut faults = match self {
            Self::PlanetRelative(state) => state.faults(pointer, unit, planet),
            Self::OrbitalElements(state) => state.faults(pointer, unit),
            Self::Geodetic(state) => state.faults(pointer, unit, planet),
            Self::InertialFlightPath(state) => state.faults(pointer, unit, planet),
            Self::Ecef(_) | Self::Eci(_) => Vec::new(),
        };
        let sidereal_time = match (self.sidereal_time(), epoch) {
            (Some(SiderealTime(seconds)), _) => Some(seconds),
            (None, None) => Some(0.0),
            (None, Some(epoch)) => epoch.sidereal_time(planet),
        };
        let Some(sidereal_time) = sidereal_time else {
            let detail = "gives no sidereal time on a planet that does not rotate; give sidereal_time in the state";
            faults.push(Fault::new("/epoch", detail));
            return Err(faults);
        };
        if !faults.is_empty() {
            return Err(faults);
        }
        let state = self.to_planet_fixed(unit, planet, sidereal_time);
        let faults: Vec<_> = state_faults(&state).iter().map(|fault| Fault::new(pointer, fault.to_string())).collect();
        if faults.is_empty() { Ok((state, sidereal_time)) } else { Err(faults) }
    }

    fn to_planet_fixed(&self, unit: AngleUnit, planet: &Planet, sidereal_time: f64) -> PlanetFixed<f64> {
        match self {
            Self::PlanetRelative(state) => state.to_core(unit, planet).to_planet_fixed(),
            Self::Geodetic(state) => state.to_core(unit).to_planet_fixed(&planet.shape),
            Self::InertialFlightPath(state) => state.to_core(unit, planet).to_planet_fixed(planet),
            Self::Ecef(state) => PlanetFixed { position: state.position.into(), velocity: state.velocity.into() },
            Self::Eci(state) => {
                let inertial = Inertial { position: state.position.into(), velocity: state.velocity.into() };
                inertial.to_planet_fixed(planet, sidereal_time)
            }
            Self::OrbitalElements(state) => {
                let inertial = state.to_core(unit).to_inertial(planet.orbital_gravitational_parameter);
                inertial.to_planet_fixed(planet, sidereal_time)
            }
        }
    }
}

/// Reads the field that every state may have.
fn sidereal_time(object: &mut Object) -> Option<SiderealTime> {
    if object.has("sidereal_time") { object.value("sidereal_time", SiderealTime::read) } else { None }
}

/// The distance from the centre, m, of a place that is given by exactly one of radius and altitude, at a geocentric latitude, rad.
fn radius_of(radius: Option<f64>, altitude: Option<f64>, geocentric_latitude: f64, planet: &Planet) -> f64 {
    let (sin_latitude, cos_latitude) = geocentric_latitude.sin_cos();
    let surface = planet.shape.surface_radius(sin_latitude, cos_latitude);
    let above_surface = altitude.map(|altitude| surface + altitude);
    radius.or(above_surface).unwrap_or(surface)
}

/// What is wrong with an altitude that puts a state at the pointer on the centre or beyond it.
fn centre_faults(pointer: &str, radius: f64, altitude: Option<f64>) -> Vec<Fault> {
    let surface = radius - altitude.unwrap_or(0.0);
    let detail = || format!("must lie above the planet's centre, {surface:.0} m below the surface here");
    let fault = (radius <= 0.0).then(|| Fault::new(format!("{pointer}/altitude"), detail()));
    fault.into_iter().collect()
}

/// The length of a vector that was checked against the bound, and may exceed it by a rounding: the answer can be sent back.
fn within(bound: Bound, length: f64) -> f64 {
    length.min(bound.maximum)
}
