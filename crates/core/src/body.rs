//! The bodies beside the Earth whose numbers are known: one file each in `bodies`, with the sources of its numbers.

use std::sync::{Arc, LazyLock};

use crate::atmosphere::{Atmosphere, Gas, Table};
use crate::elementary::sin;
use crate::heating::Radiative;
use crate::planet::{Gravity, Planet, Shape, Zonal};

/// A body.
#[derive(Debug)]
pub struct Body {
    /// Its name, as requests write it.
    pub name: &'static str,
    /// Its name, for people.
    pub title: &'static str,
    /// What of it is special, for people: one sentence, or several.
    pub doc: &'static str,
    /// m³/s².
    gravitational_parameter: f64,
    /// m.
    equatorial_radius: f64,
    /// m.
    polar_radius: f64,
    /// About its north pole, positive to the east, rad/s.
    rotation_rate: f64,
    /// W, the angle from the ascending node of its equator on that of the ICRF to its prime meridian, to the east, at J2000, degrees.
    prime_meridian: f64,
    /// The periodic terms of W: the amplitude, °, and the angle whose sine it goes with, at J2000, °, and in a Julian century, °.
    prime_meridian_terms: &'static [[f64; 3]],
    /// J₂, J₃ and J₄, for the equatorial radius.
    zonal: [f64; 3],
    /// k of Sutton and Graves in its gas, √kg/m, where it is known.
    pub sutton_graves_constant: Option<f64>,
    /// The correlation of the radiative flux in its gas; none where there is none.
    pub radiation: Radiative,
    atmosphere: Option<BodyAtmosphere>,
    /// Its file: every number with its unit and source, in JSON.
    pub source: &'static str,
}

/// The air of a body, by altitude.
#[derive(Debug)]
struct BodyAtmosphere {
    altitude: &'static [f64],
    density: &'static [f64],
    temperature: &'static [f64],
    pressure: &'static [f64],
    molar_mass: &'static [f64],
    heat_capacity_ratio: &'static [f64],
    source: &'static str,
    has_low_confidence: bool,
}

impl PartialEq for Body {
    fn eq(&self, other: &Self) -> bool {
        self.name == other.name
    }
}

impl Eq for Body {}

/// All bodies, in the order of their names.
#[expect(clippy::unreadable_literal, reason = "the build writes the numbers as the files have them")]
pub static BODIES: &[Body] = include!(concat!(env!("OUT_DIR"), "/bodies.rs"));

/// The atmospheres of the bodies, in the same order.
static ATMOSPHERES: LazyLock<Vec<Atmosphere>> =
    LazyLock::new(|| BODIES.iter().map(Body::tabulated_atmosphere).collect());

impl Body {
    /// The body as an ellipsoid, with the gravity of a point.
    pub fn planet(&self) -> Planet {
        let Self { equatorial_radius, polar_radius, gravitational_parameter, rotation_rate, .. } = *self;
        Planet {
            shape: Shape::Ellipsoid { equatorial_radius, polar_radius },
            gravity: Gravity::InverseSquare,
            gravitational_parameter,
            orbital_gravitational_parameter: gravitational_parameter,
            rotation_rate,
        }
    }

    /// Its zonal harmonics.
    pub fn zonal(&self) -> Zonal {
        Zonal { coefficients: self.zonal }
    }

    /// The angle from the inertial to the planet-fixed frame, rad, so many days after J2000 (TDB).
    ///
    /// ```text
    /// W = W₀ + Ẇ d + Σ a sin(b + c T),   T = d/36525
    /// ```
    ///
    /// The inertial x axis is the ascending node of the body's equator on that of the ICRF.
    ///
    /// # Reference
    /// Archinal et al., Celest. Mech. Dyn. Astron. 130:22 (2018).
    pub fn rotation_angle(&self, days: f64) -> f64 {
        let turned = self.rotation_rate * 86_400.0 * days;
        let term = |[amplitude, at_epoch, by_century]: &[f64; 3]| {
            amplitude * sin((at_epoch + by_century * (days / 36_525.0)).to_radians())
        };
        let meridian = self.prime_meridian + self.prime_meridian_terms.iter().map(term).sum::<f64>();
        (meridian.to_radians() + turned).rem_euclid(std::f64::consts::TAU)
    }

    /// Its standard atmosphere; a vacuum where it has none.
    pub fn atmosphere(&self) -> Atmosphere {
        let made = BODIES.iter().zip(ATMOSPHERES.iter()).find(|(body, _)| *body == self);
        made.map_or_else(|| self.tabulated_atmosphere(), |(_, atmosphere)| atmosphere.clone())
    }

    /// Where its atmosphere comes from; none where it has none.
    pub fn source_of_atmosphere(&self) -> Option<&'static str> {
        self.atmosphere.as_ref().map(|atmosphere| atmosphere.source)
    }

    /// Whether its atmosphere is hardly more than a guess.
    pub fn has_atmosphere_of_low_confidence(&self) -> bool {
        self.atmosphere.as_ref().is_some_and(|atmosphere| atmosphere.has_low_confidence)
    }

    fn tabulated_atmosphere(&self) -> Atmosphere {
        let table = self.atmosphere.as_ref().and_then(|air| {
            let gas = Gas::ByAltitude { molar_mass: air.molar_mass, heat_capacity_ratio: air.heat_capacity_ratio };
            let table = Table::new(air.altitude, air.density, Some(air.temperature), Some(air.pressure)).ok()?;
            table.with_gas(air.altitude, gas).ok()
        });
        table.map_or(Atmosphere::Vacuum, |table| Atmosphere::Table(Arc::new(table)))
    }
}
