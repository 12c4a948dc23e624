//! The states of the API: the six ways to write where a vehicle is and how it moves.

pub mod answer;
mod fields;

pub use fields::{FRAMES, inertial_conditions, initial_state, state};

use reentry::coordinates::{
    self, FlightPath, Geodetic, Inertial, InertialFlightPath, OrbitShape, OrbitalElements, PlanetFixed, Rotation,
    TESTED_YEARS, about_pole, gcrf_to_planet_fixed, teme_to_planet_fixed,
};
use reentry::elementary::{cos, sin_cos};
use reentry::planet::Planet as CorePlanet;
use reentry::scenario::state_faults;

use super::AngleUnit;
use super::epoch::{Epoch, SiderealTime};
use super::planet::Planet;
use super::reader::Fault;

/// A state as a request gives it, its angles in radians.
#[derive(Clone, Debug)]
pub struct State {
    /// Place and motion.
    pub coordinates: Coordinates,
    /// The inertial frame by whose directions the state is given; planet-fixed places have none, whatever their velocity is relative to.
    pub frame: Option<Frame>,
    /// What the state says of the angle between its frames.
    sidereal: Sidereal,
}

/// Place and motion of a state, before the planet and the angle between the frames are known.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the fields are those of the request, where they are described")]
pub enum Coordinates {
    /// Speed and angles against the geocentric horizontal.
    PlanetRelative {
        height: Height,
        longitude: f64,
        geocentric_latitude: f64,
        speed: f64,
        flight_path_angle: f64,
        heading: f64,
    },
    /// Speed and angles against the geodetic horizontal.
    Geodetic(Geodetic),
    /// Planet-fixed vectors.
    Ecef(PlanetFixed<f64>),
    /// At rest on the ground, at a place whose azimuth is that of the launch.
    Launch { place: Geodetic, hold_down: bool },
    /// Inertial vectors.
    Eci(Inertial),
    /// An orbit.
    OrbitalElements {
        shape: OrbitShape,
        eccentricity: f64,
        inclination: f64,
        raan: f64,
        argument_of_periapsis: f64,
        anomaly: Anomaly,
    },
    /// Speed and angles of the inertial velocity against the geocentric horizontal.
    InertialFlightPath {
        height: Height,
        longitude: f64,
        geocentric_latitude: f64,
        inertial_speed: f64,
        inertial_flight_path_angle: f64,
        inertial_heading: f64,
    },
}

/// How far a place is from the planet's centre, m.
#[derive(Clone, Copy, Debug)]
pub enum Height {
    /// From the centre.
    Radius(f64),
    /// Above the planet's shape, along the radius vector.
    Altitude(f64),
}

/// Where a vehicle is on its orbit, rad.
#[derive(Clone, Copy, Debug)]
pub enum Anomaly {
    /// The angle from the periapsis.
    True(f64),
    /// The angle that grows evenly in time.
    Mean(f64),
}

impl Height {
    /// The distance from the centre, m, at a geocentric latitude, rad.
    fn radius(self, geocentric_latitude: f64, planet: &CorePlanet) -> f64 {
        match self {
            Self::Radius(radius) => radius,
            Self::Altitude(altitude) => {
                let (sin_latitude, cos_latitude) = sin_cos(geocentric_latitude);
                planet.shape.surface_radius(sin_latitude, cos_latitude) + altitude
            }
        }
    }

    /// What is wrong with an altitude that puts a state at the pointer on the centre or beyond it.
    fn faults(self, pointer: &str, geocentric_latitude: f64, planet: &CorePlanet) -> Vec<Fault> {
        let radius = self.radius(geocentric_latitude, planet);
        let surface = Self::Altitude(0.0).radius(geocentric_latitude, planet);
        let detail = || format!("must be above the planet's centre, which is {surface:.0} m below the surface here");
        let fault = (radius <= 0.0).then(|| Fault::new(format!("{pointer}/altitude"), detail()));
        fault.into_iter().collect()
    }
}

impl Coordinates {
    /// What is wrong with the place on this planet, of a state at the pointer.
    fn faults(&self, pointer: &str, planet: &CorePlanet) -> Vec<Fault> {
        match self {
            Self::PlanetRelative { height, geocentric_latitude, .. }
            | Self::InertialFlightPath { height, geocentric_latitude, .. } => {
                height.faults(pointer, *geocentric_latitude, planet)
            }
            Self::Geodetic(state) | Self::Launch { place: state, .. } => {
                // The altitude must not reach down beyond the centre, to the other side.
                let foot = Geodetic { geodetic_altitude: 0.0, ..*state };
                let [here, foot] = [*state, foot].map(|state| state.to_planet_fixed(&planet.shape).position);
                let beyond = here.dot(&foot) < 0.0;
                let detail =
                    format!("must be above the planet's centre, which is {:.0} m below the surface here", foot.norm());
                beyond.then(|| Fault::new(format!("{pointer}/geodetic_altitude"), detail)).into_iter().collect()
            }
            Self::OrbitalElements { shape, eccentricity, anomaly, .. } => {
                orbit_faults(pointer, *shape, *eccentricity, *anomaly)
            }
            Self::Ecef(_) | Self::Eci(_) => Vec::new(),
        }
    }

    fn to_planet_fixed(&self, planet: &CorePlanet, to_planet: &Rotation) -> PlanetFixed<f64> {
        match *self {
            Self::PlanetRelative { height, longitude, geocentric_latitude, speed, flight_path_angle, heading } => {
                let radius = height.radius(geocentric_latitude, planet);
                FlightPath { radius, longitude, geocentric_latitude, speed, flight_path_angle, heading }
                    .to_planet_fixed()
            }
            Self::InertialFlightPath {
                height,
                longitude,
                geocentric_latitude,
                inertial_speed,
                inertial_flight_path_angle,
                inertial_heading,
            } => {
                let state = InertialFlightPath {
                    radius: height.radius(geocentric_latitude, planet),
                    longitude,
                    geocentric_latitude,
                    inertial_speed,
                    inertial_flight_path_angle,
                    inertial_heading,
                };
                state.to_planet_fixed(planet)
            }
            Self::Geodetic(state) | Self::Launch { place: state, .. } => state.to_planet_fixed(&planet.shape),
            Self::Ecef(state) => state,
            Self::Eci(state) => state.to_planet_fixed_by(planet, to_planet),
            Self::OrbitalElements { shape, eccentricity, inclination, raan, argument_of_periapsis, anomaly } => {
                let true_anomaly = match anomaly {
                    Anomaly::True(anomaly) => anomaly,
                    Anomaly::Mean(anomaly) => coordinates::true_anomaly(anomaly, eccentricity),
                };
                let elements =
                    OrbitalElements { shape, eccentricity, inclination, raan, argument_of_periapsis, true_anomaly };
                elements.to_inertial(planet.orbital_gravitational_parameter).to_planet_fixed_by(planet, to_planet)
            }
        }
    }
}

/// The orbit's size must go with its eccentricity, and the vehicle must be on it.
fn orbit_faults(pointer: &str, shape: OrbitShape, e: f64, anomaly: Anomaly) -> Vec<Fault> {
    let mut faults = Vec::new();
    match shape {
        OrbitShape::SemiMajorAxis(_) if e.total_cmp(&1.0).is_eq() => {
            let detail = "must be omitted: a parabola (eccentricity 1) has no semi-major axis; give semi_latus_rectum \
                          instead";
            faults.push(Fault::new(format!("{pointer}/semi_major_axis"), detail));
        }
        OrbitShape::SemiMajorAxis(a) if a * (1.0 - e) <= 0.0 => {
            let sign = if e < 1.0 { "positive" } else { "negative" };
            let detail = format!("must be {sign} for an eccentricity of {e}, got {a}");
            faults.push(Fault::new(format!("{pointer}/semi_major_axis"), detail));
        }
        _ => {}
    }
    match anomaly {
        Anomaly::True(anomaly) => {
            let reach = 1.0 + e * cos(anomaly);
            if reach <= 0.0 {
                let detail =
                    format!("is beyond the asymptote of the orbit: 1 + e cos ν must be greater than 0, got {reach}");
                faults.push(Fault::new(format!("{pointer}/true_anomaly"), detail));
            }
        }
        Anomaly::Mean(_) if e >= 1.0 => {
            let detail = format!("requires an eccentricity below 1, got {e}; give true_anomaly instead");
            faults.push(Fault::new(format!("{pointer}/mean_anomaly"), detail));
        }
        Anomaly::Mean(_) => {}
    }
    faults
}

impl State {
    /// Whether a launch holds the vehicle on the ground until it lifts off.
    pub fn is_held(&self) -> bool {
        matches!(self.coordinates, Coordinates::Launch { hold_down: true, .. })
    }

    /// The azimuth of a launch, clockwise from north, rad; none of another state.
    pub fn launch_azimuth(&self) -> Option<f64> {
        match self.coordinates {
            Coordinates::Launch { place, .. } => Some(place.azimuth),
            _ => None,
        }
    }

    /// The place of a launch, as planet-fixed position, and its azimuth as a velocity; none of another state.
    pub fn launch(&self, planet: &CorePlanet) -> Option<PlanetFixed<f64>> {
        match self.coordinates {
            Coordinates::Launch { place, .. } => Some(Geodetic { speed: 1.0, ..place }.to_planet_fixed(&planet.shape)),
            _ => None,
        }
    }

    /// Whether the state itself gives the angle between its frames.
    pub fn gives_sidereal(&self) -> bool {
        self.sidereal != Sidereal::default()
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
        let mut faults = self.coordinates.faults(pointer, &planet.core);
        let orientation = match self.orientation(epoch, pointer, unit, planet) {
            Ok(orientation) if faults.is_empty() => orientation,
            other => {
                faults.extend(other.err());
                return Err(faults);
            }
        };
        let state = self.coordinates.to_planet_fixed(&planet.core, &orientation.to_planet);
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
        let given = self.sidereal;
        let frame = self.frame.unwrap_or(Frame::Date);
        if frame != Frame::Date {
            let fault =
                |detail: &str| Fault::new(format!("{pointer}/frame"), format!("{:?} {detail}", FRAMES.of(frame)));
            let epoch = epoch.ok_or_else(|| fault("requires an epoch"))?;
            if !planet.is_earth() {
                return Err(fault(&format!("is a frame of the Earth and is not available on {}", planet.title())));
            }
            if !TESTED_YEARS.contains(&epoch.year()) {
                let [first, last] = [TESTED_YEARS.start(), TESTED_YEARS.end()];
                return Err(fault(&format!("requires an epoch from {first} to {last}, got the year {}", epoch.year())));
            }
            let to_planet = match frame {
                Frame::Gcrf => gcrf_to_planet_fixed(epoch.days()),
                Frame::Teme | Frame::Date => teme_to_planet_fixed(epoch.days()),
            };
            return Ok(Orientation {
                frame,
                sidereal: Sidereal::of_epoch(epoch, planet).unwrap_or_default(),
                to_planet,
            });
        }
        let sidereal = match epoch {
            _ if self.gives_sidereal() => given,
            Some(epoch) => match Sidereal::of_epoch(epoch, planet) {
                Some(sidereal) => sidereal,
                None if self.frame.is_some() => {
                    let detail = "is required: an epoch does not define the angle of a custom planet; give \
                                  sidereal_time or sidereal_angle";
                    return Err(Fault::new(format!("{pointer}/sidereal_time"), detail));
                }
                None => Sidereal::ALIGNED,
            },
            None => Sidereal::ALIGNED,
        };
        Ok(Orientation { frame, sidereal, to_planet: about_pole(sidereal.to_angle(unit, &planet.core)) })
    }
}
/// An inertial frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The planet's equator, from which the planet is turned by the sidereal time; with an epoch on the Earth, the equator and the
    /// celestial intermediate origin of date.
    Date,
    /// True equator and mean equinox of date: that of SGP4 and its two-line elements.
    Teme,
    /// The geocentric celestial reference frame, from which J2000 differs by less than 0.1 arc seconds.
    Gcrf,
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
    /// The frames are one.
    const ALIGNED: Self = Self { time: Some(SiderealTime(0.0)), angle: None };

    /// By the rotation angle of the planet at the instant, which lies within a turn; none of a planet whose rotation angle is not known.
    fn of_epoch(epoch: Epoch, planet: &Planet) -> Option<Self> {
        let angle = planet.rotation_angle(epoch)?;
        let rate = planet.core.rotation_rate;
        // Of a planet that turns westward, the angle falls to 0 in the time.
        let angle = if rate < 0.0 { angle - std::f64::consts::TAU } else { angle };
        Some(Self { time: Some(SiderealTime(angle / rate)), angle: None })
    }

    fn to_angle(self, unit: AngleUnit, planet: &CorePlanet) -> f64 {
        let SiderealTime(seconds) = self.time.unwrap_or(SiderealTime(0.0));
        self.angle.map_or(planet.rotation_rate * seconds, |angle| unit.to_radians(angle))
    }
}
