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

use reentry::coordinates::{
    Inertial, PlanetFixed, Rotation, TESTED_YEARS, about_pole, gcrf_to_planet_fixed, teme_to_planet_fixed,
};
use reentry::planet::Planet as CorePlanet;
use reentry::scenario::{Bound, state_faults};
use serde::Serialize;
use serde_json::json;
use utoipa::ToSchema;

use super::AngleUnit;
use super::epoch::{Epoch, SiderealTime};
use super::planet::Planet;
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
    ///
    /// Without an epoch, the time since its frames were aligned is 0 where it does not say otherwise.
    pub fn read(object: &mut Object, has_epoch: bool) -> Option<Self> {
        let read = object.choice::<fn(&mut Object, bool) -> Option<Self>>(
            "type",
            &[
                ("planet_relative", |object, has_epoch| {
                    PlanetRelative::read(object, has_epoch).map(Self::PlanetRelative)
                }),
                ("geodetic", |object, has_epoch| Geodetic::read(object, has_epoch).map(Self::Geodetic)),
                ("ecef", |object, has_epoch| Ecef::read(object, has_epoch).map(Self::Ecef)),
                ("eci", |object, has_epoch| Eci::read(object, has_epoch).map(Self::Eci)),
                ("orbital_elements", |object, has_epoch| {
                    OrbitalElements::read(object, has_epoch).map(Self::OrbitalElements)
                }),
                ("inertial_flight_path", |object, has_epoch| {
                    InertialFlightPath::read(object, has_epoch).map(Self::InertialFlightPath)
                }),
            ],
        )?;
        read(object, has_epoch)
    }

    /// What the state says of the angle between its frames.
    fn sidereal(&self) -> Sidereal {
        let (time, angle) = match self {
            Self::PlanetRelative(state) => (state.sidereal_time, state.sidereal_angle),
            Self::Geodetic(state) => (state.sidereal_time, state.sidereal_angle),
            Self::Ecef(state) => (state.sidereal_time, state.sidereal_angle),
            Self::Eci(state) => (state.sidereal_time, state.sidereal_angle),
            Self::OrbitalElements(state) => (state.sidereal_time, state.sidereal_angle),
            Self::InertialFlightPath(state) => (state.sidereal_time, state.sidereal_angle),
        };
        Sidereal { time, angle }
    }

    /// Whether the state itself gives the angle between its frames.
    pub fn gives_sidereal(&self) -> bool {
        self.sidereal() != Sidereal::default()
    }

    /// The inertial frame by whose directions the state is given; planet-fixed places have none, whatever their velocity is relative to.
    pub fn frame(&self) -> Option<Frame> {
        match self {
            Self::Eci(state) => Some(state.frame),
            Self::OrbitalElements(state) => Some(state.frame),
            Self::PlanetRelative(_) | Self::Geodetic(_) | Self::Ecef(_) | Self::InertialFlightPath(_) => None,
        }
    }

    /// The angle in radians by which the planet is turned from the inertial frame of date; 0 where the request has a fault about it.
    pub fn sidereal_angle(&self, epoch: Option<Epoch>, unit: AngleUnit, planet: &Planet) -> f64 {
        let orientation = self.orientation(epoch, "", unit, planet);
        orientation.map_or(0.0, |orientation| orientation.sidereal.to_angle(unit, &planet.core))
    }

    /// The planet-fixed position and velocity of a state at the pointer, and how its inertial frame lies.
    ///
    /// # Errors
    /// With everything that is wrong across its fields.
    pub fn at(
        &self,
        epoch: Option<Epoch>,
        pointer: &str,
        unit: AngleUnit,
        planet: &Planet,
    ) -> Result<(PlanetFixed<f64>, Orientation), Vec<Fault>> {
        let mut faults = match self {
            Self::PlanetRelative(state) => state.faults(pointer, unit, &planet.core),
            Self::OrbitalElements(state) => state.faults(pointer, unit),
            Self::Geodetic(state) => state.faults(pointer, unit, &planet.core),
            Self::InertialFlightPath(state) => state.faults(pointer, unit, &planet.core),
            Self::Ecef(_) | Self::Eci(_) => Vec::new(),
        };
        let orientation = match self.orientation(epoch, pointer, unit, planet) {
            Ok(orientation) if faults.is_empty() => orientation,
            other => {
                faults.extend(other.err());
                return Err(faults);
            }
        };
        let state = self.to_planet_fixed(unit, &planet.core, &orientation.to_planet);
        let faults: Vec<_> = state_faults(&state).iter().map(|fault| Fault::new(pointer, fault.to_string())).collect();
        if faults.is_empty() { Ok((state, orientation)) } else { Err(faults) }
    }

    /// How the inertial frame lies: by the sidereal time or angle that the state gives, or else by the epoch.
    fn orientation(
        &self,
        epoch: Option<Epoch>,
        pointer: &str,
        unit: AngleUnit,
        planet: &Planet,
    ) -> Result<Orientation, Fault> {
        let given = self.sidereal();
        let frame = self.frame().unwrap_or(Frame::Date);
        if frame != Frame::Date {
            let fault = |detail: &str| Fault::new(format!("{pointer}/frame"), format!("{:?} {detail}", frame.name()));
            let epoch = epoch.ok_or_else(|| fault("needs an epoch"))?;
            if !planet.is_earth() {
                return Err(fault("is a frame of the Earth, and not of a custom planet"));
            }
            if !TESTED_YEARS.contains(&epoch.year()) {
                let [first, last] = [TESTED_YEARS.start(), TESTED_YEARS.end()];
                return Err(fault(&format!("needs an epoch from {first} to {last}, got one of {}", epoch.year())));
            }
            let to_planet = match frame {
                Frame::Gcrf => gcrf_to_planet_fixed(epoch.days()),
                Frame::Teme | Frame::Date => teme_to_planet_fixed(epoch.days()),
            };
            return Ok(Orientation { frame, sidereal: Sidereal::of_earth(epoch, planet), to_planet });
        }
        let sidereal = match epoch {
            _ if self.gives_sidereal() => given,
            Some(epoch) if planet.is_earth() => Sidereal::of_earth(epoch, planet),
            Some(_) if self.frame().is_some() => {
                let detail = "is required: an epoch says nothing about the angle of a custom planet; give sidereal_time or \
                              sidereal_angle";
                return Err(Fault::new(format!("{pointer}/sidereal_time"), detail));
            }
            _ => Sidereal { time: Some(SiderealTime(0.0)), angle: None },
        };
        Ok(Orientation { frame, sidereal, to_planet: about_pole(sidereal.to_angle(unit, &planet.core)) })
    }

    fn to_planet_fixed(&self, unit: AngleUnit, planet: &CorePlanet, to_planet: &Rotation) -> PlanetFixed<f64> {
        match self {
            Self::PlanetRelative(state) => state.to_core(unit, planet).to_planet_fixed(),
            Self::Geodetic(state) => state.to_core(unit).to_planet_fixed(&planet.shape),
            Self::InertialFlightPath(state) => state.to_core(unit, planet).to_planet_fixed(planet),
            Self::Ecef(state) => PlanetFixed { position: state.position.into(), velocity: state.velocity.into() },
            Self::Eci(state) => {
                let inertial = Inertial { position: state.position.into(), velocity: state.velocity.into() };
                inertial.to_planet_fixed_by(planet, to_planet)
            }
            Self::OrbitalElements(state) => {
                let inertial = state.to_core(unit).to_inertial(planet.orbital_gravitational_parameter);
                inertial.to_planet_fixed_by(planet, to_planet)
            }
        }
    }
}

/// An inertial frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Frame {
    /// The planet's equator, from which the planet is turned by the sidereal time; with an epoch on the Earth, the equator and the
    /// celestial intermediate origin of date.
    Date,
    /// True equator and mean equinox of date: that of SGP4 and its two-line elements.
    Teme,
    /// The geocentric celestial reference frame, from which J2000 differs by less than 0.1 arc seconds.
    Gcrf,
}

impl Frame {
    const NAMES: [(&'static str, Self); 3] = [("date", Self::Date), ("teme", Self::Teme), ("gcrf", Self::Gcrf)];

    /// Its name in requests.
    pub fn name(self) -> &'static str {
        match self {
            Self::Date => "date",
            Self::Teme => "teme",
            Self::Gcrf => "gcrf",
        }
    }

    /// Reads the frame, and the sidereal time or angle, which is for the frame of date alone.
    fn read(object: &mut Object, has_epoch: bool) -> (Option<Self>, Option<Sidereal>) {
        let frame = object.choice_or("frame", &Self::NAMES, "date");
        let Some(of_epoch) = frame.filter(|frame| *frame != Self::Date) else {
            return (frame, Sidereal::read(object, has_epoch));
        };
        for name in Sidereal::FIELDS {
            if object.has(name) {
                let detail =
                    format!("must be left out with the frame {:?}, whose angle the epoch gives", of_epoch.name());
                object.fault_of(name, detail);
            }
        }
        (frame, Some(Sidereal::default()))
    }
}

/// How an inertial frame lies beside the planet-fixed one.
#[derive(Clone, Copy, Debug)]
pub struct Orientation {
    /// The inertial frame.
    pub frame: Frame,
    /// How far the planet is turned from the frame of date.
    pub sidereal: Sidereal,
    /// Takes inertial components to planet-fixed ones.
    pub to_planet: Rotation,
}

impl Orientation {
    /// What inertial states of the answer give with their frame: that of date alone has a sidereal time or angle.
    pub fn given(&self) -> Sidereal {
        if self.frame == Frame::Date { self.sidereal } else { Sidereal::default() }
    }
}

/// How far the planet-fixed frame is turned from that of date: at most one of the two.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Sidereal {
    /// Since the frames were aligned, s.
    pub time: Option<SiderealTime>,
    /// In the unit of the request.
    pub angle: Option<f64>,
}

impl Sidereal {
    const FIELDS: [&'static str; 2] = ["sidereal_time", "sidereal_angle"];

    fn read(object: &mut Object, has_epoch: bool) -> Option<Self> {
        let has_angle = object.has("sidereal_angle");
        let angle = if has_angle { object.angle("sidereal_angle", Bound::TURN).map(Some) } else { Some(None) };
        if !has_epoch && !has_angle {
            object.fill("sidereal_time", json!(0));
        }
        let has_time = object.has("sidereal_time");
        let time = if has_time { object.value("sidereal_time", SiderealTime::read).map(Some) } else { Some(None) };
        if has_time && has_angle {
            object.fault::<()>("must have at most one of sidereal_time, sidereal_angle, got both");
        }
        Some(Self { time: time?, angle: angle? })
    }

    /// By the Earth rotation angle of the instant.
    fn of_earth(epoch: Epoch, planet: &Planet) -> Self {
        let seconds = epoch.earth_rotation_angle() / planet.core.rotation_rate;
        Self { time: Some(SiderealTime(seconds)), angle: None }
    }

    fn to_angle(self, unit: AngleUnit, planet: &CorePlanet) -> f64 {
        let SiderealTime(seconds) = self.time.unwrap_or(SiderealTime(0.0));
        self.angle.map_or(planet.rotation_rate * seconds, |angle| unit.to_radians(angle))
    }
}

/// The distance from the centre, m, of a place that is given by exactly one of radius and altitude, at a geocentric latitude, rad.
fn radius_of(radius: Option<f64>, altitude: Option<f64>, geocentric_latitude: f64, planet: &CorePlanet) -> f64 {
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
