//! The states of the API: the five ways to write where a vehicle is and how it moves.

use reentry::coordinates::{
    FlightPath, Geodetic as CoreGeodetic, Inertial, OrbitShape, OrbitalElements as CoreElements, PlanetFixed,
};
use reentry::planet::Planet;
use reentry::scenario::{Bound, state_faults};
use serde::Serialize;
use utoipa::ToSchema;

use super::AngleUnit;
use super::epoch::{Instant, SiderealTime};
use super::reader::{Fault, Object};

/// A state, in one of five coordinate systems. Angles are in the request's `angle_unit`.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(
    ("planet_relative" = "#/components/schemas/PlanetRelative"),
    ("geodetic" = "#/components/schemas/Geodetic"),
    ("ecef" = "#/components/schemas/Ecef"),
    ("eci" = "#/components/schemas/Eci"),
    ("orbital_elements" = "#/components/schemas/OrbitalElements"),
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
}

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
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned. Default 0, or from the `epoch`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
}

/// Planet-fixed vectors, relative to the rotating planet: x through longitude 0 on the equator, z along the pole.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Ecef {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Position [x, y, z], m, each within ±1e12.
    pub position: [f64; 3],
    /// Velocity [x, y, z] relative to the rotating planet, m/s.
    pub velocity: [f64; 3],
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned. Default 0, or from the `epoch`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
}

/// Inertial vectors: the planet-fixed frame at `sidereal_time` 0; with an `epoch`, the equator and origin of date, not J2000.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Eci {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Position [x, y, z], m, each within ±1e12.
    pub position: [f64; 3],
    /// Inertial velocity [x, y, z], m/s.
    pub velocity: [f64; 3],
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned. Default 0, or from the `epoch`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
}

/// Classical orbital elements in the inertial frame.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct OrbitalElements {
    /// The kind of state.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// m; positive below eccentricity 1, negative above. Exactly one of `semi_major_axis` and `semi_latus_rectum`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub semi_major_axis: Option<f64>,
    /// m; the only size that a parabola has. Exactly one of `semi_major_axis` and `semi_latus_rectum`.
    #[schema(exclusive_minimum = 0)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub semi_latus_rectum: Option<f64>,
    /// 0 a circle, below 1 an ellipse, 1 a parabola, above a hyperbola.
    #[schema(minimum = 0)]
    pub eccentricity: f64,
    /// Of the orbit's angular momentum to the pole, in [0, π] (180°).
    #[schema(minimum = 0, maximum = 180)]
    pub inclination: f64,
    /// Right ascension of the ascending node, within ±2π (±360°); answers give [0, 2π).
    #[schema(minimum = -360, maximum = 360)]
    pub raan: f64,
    /// From the ascending node to the periapsis, within ±2π (±360°); answers give [0, 2π).
    #[schema(minimum = -360, maximum = 360)]
    pub argument_of_periapsis: f64,
    /// From the periapsis to the vehicle, within ±2π (±360°); answers give [0, 2π).
    #[schema(minimum = -360, maximum = 360)]
    pub true_anomaly: f64,
    /// When the inertial frame is meant: seconds since it and the planet-fixed frame were aligned. Default 0, or from the `epoch`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sidereal_time: Option<SiderealTime>,
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
        }
    }

    /// Whether the state is given in the inertial frame.
    pub fn is_inertial(&self) -> bool {
        matches!(self, Self::Eci(_) | Self::OrbitalElements(_))
    }

    /// The planet-fixed position and velocity of a state at the pointer, and its sidereal time in seconds, which follows
    /// from the epoch where the state does not give it.
    ///
    /// # Errors
    /// With what is wrong across its fields.
    pub fn at(
        &self,
        epoch: Option<Instant>,
        pointer: &str,
        unit: AngleUnit,
        planet: &Planet,
    ) -> Result<(PlanetFixed<f64>, f64), Vec<Fault>> {
        let sidereal_time = match (self.sidereal_time(), epoch) {
            (Some(given), _) => given.seconds(),
            (None, None) => 0.0,
            (None, Some(epoch)) => epoch.sidereal_time(planet).ok_or_else(|| {
                let detail = "gives no sidereal time on a planet that does not rotate; give sidereal_time in the state";
                vec![Fault::new("/epoch", detail)]
            })?,
        };
        Ok((self.try_into_planet_fixed(pointer, unit, planet, sidereal_time)?, sidereal_time))
    }

    /// The planet-fixed position and velocity, `sidereal_time` seconds after the frames were aligned.
    ///
    /// # Errors
    /// With what is wrong across its fields.
    fn try_into_planet_fixed(
        &self,
        pointer: &str,
        unit: AngleUnit,
        planet: &Planet,
        sidereal_time: f64,
    ) -> Result<PlanetFixed<f64>, Vec<Fault>> {
        let own = match self {
            Self::PlanetRelative(state) => state.fault(pointer, unit, planet),
            Self::OrbitalElements(state) => state.fault(pointer, unit),
            Self::Geodetic(_) | Self::Ecef(_) | Self::Eci(_) => None,
        };
        if let Some(fault) = own {
            return Err(vec![fault]);
        }
        let state = self.to_planet_fixed(unit, planet, sidereal_time);
        let faults = state_faults(&state);
        let faults: Vec<_> = faults.iter().map(|fault| Fault::new(pointer, fault.to_string())).collect();
        if faults.is_empty() { Ok(state) } else { Err(faults) }
    }

    fn to_planet_fixed(&self, unit: AngleUnit, planet: &Planet, sidereal_time: f64) -> PlanetFixed<f64> {
        match self {
            Self::PlanetRelative(state) => state.to_core(unit, planet).to_planet_fixed(),
            Self::Geodetic(state) => state.to_core(unit).to_planet_fixed(&planet.shape),
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

impl PlanetRelative {
    fn read(object: &mut Object) -> Option<Self> {
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

    fn fault(&self, pointer: &str, unit: AngleUnit, planet: &Planet) -> Option<Fault> {
        let radius = self.to_core(unit, planet).radius;
        let surface = radius - self.altitude.unwrap_or(0.0);
        (radius <= 0.0).then(|| {
            let detail = format!("must lie above the planet's centre, {surface:.0} m below the surface here");
            Fault::new(format!("{pointer}/altitude"), detail)
        })
    }

    fn to_core(&self, unit: AngleUnit, planet: &Planet) -> FlightPath<f64> {
        let geocentric_latitude = unit.to_radians(self.geocentric_latitude);
        let (sin_latitude, cos_latitude) = geocentric_latitude.sin_cos();
        let surface = planet.shape.surface_radius(sin_latitude, cos_latitude);
        let above_surface = self.altitude.map(|altitude| surface + altitude);
        FlightPath {
            radius: self.radius.or(above_surface).unwrap_or(surface),
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
            radius: Some(state.radius),
            altitude: None,
            longitude: unit.from_radians(state.longitude),
            geocentric_latitude: unit.from_radians(state.geocentric_latitude),
            speed: state.speed,
            flight_path_angle: unit.from_radians(state.flight_path_angle),
            heading: unit.from_radians(state.heading),
            sidereal_time: Some(SiderealTime::Seconds(sidereal_time)),
        }
    }
}

impl Geodetic {
    fn read(object: &mut Object) -> Option<Self> {
        let geodetic_altitude = object.number("geodetic_altitude", Bound::DISTANCE);
        let longitude = object.angle("longitude", Bound::TURN);
        let geodetic_latitude = object.angle("geodetic_latitude", Bound::QUARTER_TURN);
        let speed = object.number("speed", Bound::SPEED);
        let flight_path_angle = object.angle("flight_path_angle", Bound::QUARTER_TURN);
        let azimuth = object.angle("azimuth", Bound::TURN);
        let sidereal_time = sidereal_time(object);
        Some(Self {
            kind: "geodetic",
            geodetic_altitude: geodetic_altitude?,
            longitude: longitude?,
            geodetic_latitude: geodetic_latitude?,
            speed: speed?,
            flight_path_angle: flight_path_angle?,
            azimuth: azimuth?,
            sidereal_time,
        })
    }

    fn to_core(&self, unit: AngleUnit) -> CoreGeodetic {
        CoreGeodetic {
            geodetic_altitude: self.geodetic_altitude,
            longitude: unit.to_radians(self.longitude),
            geodetic_latitude: unit.to_radians(self.geodetic_latitude),
            speed: self.speed,
            flight_path_angle: unit.to_radians(self.flight_path_angle),
            azimuth: unit.to_radians(self.azimuth),
        }
    }

    /// The state in the given unit of angles.
    pub fn from_core(state: &CoreGeodetic, unit: AngleUnit, sidereal_time: f64) -> Self {
        Self {
            kind: "geodetic",
            geodetic_altitude: state.geodetic_altitude,
            longitude: unit.from_radians(state.longitude),
            geodetic_latitude: unit.from_radians(state.geodetic_latitude),
            speed: state.speed,
            flight_path_angle: unit.from_radians(state.flight_path_angle),
            azimuth: unit.turn_from_radians(state.azimuth),
            sidereal_time: Some(SiderealTime::Seconds(sidereal_time)),
        }
    }
}

impl Ecef {
    fn read(object: &mut Object) -> Option<Self> {
        let (position, velocity, sidereal_time) = vectors(object);
        Some(Self { kind: "ecef", position: position?, velocity: velocity?, sidereal_time })
    }

    /// The planet-fixed vectors.
    pub fn from_core(state: &PlanetFixed<f64>, sidereal_time: f64) -> Self {
        Self {
            kind: "ecef",
            position: state.position.into(),
            velocity: state.velocity.into(),
            sidereal_time: Some(SiderealTime::Seconds(sidereal_time)),
        }
    }
}

impl Eci {
    fn read(object: &mut Object) -> Option<Self> {
        let (position, velocity, sidereal_time) = vectors(object);
        Some(Self { kind: "eci", position: position?, velocity: velocity?, sidereal_time })
    }

    /// The inertial vectors.
    pub fn from_core(state: &Inertial, sidereal_time: f64) -> Self {
        Self {
            kind: "eci",
            position: state.position.into(),
            velocity: state.velocity.into(),
            sidereal_time: Some(SiderealTime::Seconds(sidereal_time)),
        }
    }
}

/// Position, velocity and sidereal time.
fn vectors(object: &mut Object) -> (Option<[f64; 3]>, Option<[f64; 3]>, Option<SiderealTime>) {
    let position = object.vector("position", Bound::DISTANCE);
    let velocity = object.vector("velocity", Bound::FINITE);
    (position, velocity, sidereal_time(object))
}

impl OrbitalElements {
    fn read(object: &mut Object) -> Option<Self> {
        let semi_major_axis = object.optional_number("semi_major_axis", Bound::FINITE);
        let semi_latus_rectum = object.optional_number("semi_latus_rectum", Bound::POSITIVE);
        let size = object.exactly_one(&["semi_major_axis", "semi_latus_rectum"]);
        let eccentricity = object.number("eccentricity", Bound::NON_NEGATIVE);
        let inclination = object.angle("inclination", Bound::HALF_TURN);
        let raan = object.angle("raan", Bound::TURN);
        let argument_of_periapsis = object.angle("argument_of_periapsis", Bound::TURN);
        let true_anomaly = object.angle("true_anomaly", Bound::TURN);
        let sidereal_time = sidereal_time(object);
        size?;
        Some(Self {
            kind: "orbital_elements",
            semi_major_axis,
            semi_latus_rectum,
            eccentricity: eccentricity?,
            inclination: inclination?,
            raan: raan?,
            argument_of_periapsis: argument_of_periapsis?,
            true_anomaly: true_anomaly?,
            sidereal_time,
        })
    }

    /// The orbit's size must go with its eccentricity, and the vehicle must be on it.
    fn fault(&self, pointer: &str, unit: AngleUnit) -> Option<Fault> {
        let e = self.eccentricity;
        if let Some(a) = self.semi_major_axis {
            let detail = if e.total_cmp(&1.0).is_eq() {
                "a parabola (eccentricity 1) has no semi-major axis; give semi_latus_rectum in its place".to_owned()
            } else if a * (1.0 - e) <= 0.0 {
                let sign = if e < 1.0 { "positive" } else { "negative" };
                format!("must be {sign} where the eccentricity is {e:?}, got {a:?}")
            } else {
                String::new()
            };
            if !detail.is_empty() {
                return Some(Fault::new(format!("{pointer}/semi_major_axis"), detail));
            }
        }
        let reach = 1.0 + e * unit.to_radians(self.true_anomaly).cos();
        (reach <= 0.0).then(|| {
            let detail =
                format!("lies beyond the asymptote of the orbit: 1 + e cos ν must be greater than 0, got {reach:?}");
            Fault::new(format!("{pointer}/true_anomaly"), detail)
        })
    }

    fn to_core(&self, unit: AngleUnit) -> CoreElements {
        let shape = match (self.semi_latus_rectum, self.semi_major_axis) {
            (Some(p), _) => OrbitShape::SemiLatusRectum(p),
            (None, a) => OrbitShape::SemiMajorAxis(a.unwrap_or(f64::NAN)),
        };
        CoreElements {
            shape,
            eccentricity: self.eccentricity,
            inclination: unit.to_radians(self.inclination),
            raan: unit.to_radians(self.raan),
            argument_of_periapsis: unit.to_radians(self.argument_of_periapsis),
            true_anomaly: unit.to_radians(self.true_anomaly),
        }
    }

    /// The elements in the given unit of angles.
    pub fn from_core(elements: &CoreElements, unit: AngleUnit, sidereal_time: f64) -> Self {
        let (semi_major_axis, semi_latus_rectum) = match elements.shape {
            OrbitShape::SemiMajorAxis(a) => (Some(a), None),
            OrbitShape::SemiLatusRectum(p) => (None, Some(p)),
        };
        Self {
            kind: "orbital_elements",
            semi_major_axis,
            semi_latus_rectum,
            eccentricity: elements.eccentricity,
            inclination: unit.from_radians(elements.inclination),
            raan: unit.turn_from_radians(elements.raan),
            argument_of_periapsis: unit.turn_from_radians(elements.argument_of_periapsis),
            true_anomaly: unit.turn_from_radians(elements.true_anomaly),
            sidereal_time: Some(SiderealTime::Seconds(sidereal_time)),
        }
    }
}
