//! The planet: its shape, gravity and rotation.

mod gravity;

pub use gravity::{Gravity, Zonal};

pub(crate) use gravity::Pull;

use crate::scalar::{Scalar, length, reciprocal_or_one};
use nalgebra::Vector3;

/// The surface from which altitudes are measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shape {
    /// A sphere; geodetic latitude and altitude are the geocentric ones.
    Sphere {
        /// Radius, m.
        radius: f64,
    },
    /// An ellipsoid of revolution about the pole.
    Ellipsoid {
        /// Semi-axis in the equatorial plane, m.
        equatorial_radius: f64,
        /// Semi-axis along the pole, m.
        polar_radius: f64,
    },
}

impl Shape {
    /// The altitude that drives the dynamics: the height above the surface along the radius vector, in m.
    ///
    /// ```text
    /// h = r - r_E(φ),   r_E = b / √(sin²φ + (b/a)² cos²φ)
    /// ```
    ///
    /// `position` is planet-fixed, in m.
    ///
    /// # Reference
    /// Jameson 2006, equations 43 to 45, in Cartesian coordinates.
    #[inline(always)]
    pub fn altitude<S: Scalar>(&self, position: &Vector3<S>) -> S {
        let radius = length(position);
        match *self {
            Self::Sphere { radius: surface } => radius - surface,
            Self::Ellipsoid { equatorial_radius, polar_radius } => {
                let [x, y, z] = [position.x, position.y, position.z];
                let ratio = polar_radius / equatorial_radius;
                let stretched = ((x * x + y * y) * (ratio * ratio) + z * z).sqrt();
                // r_E = b r / √(z² + (b/a)² (x² + y²))
                radius - radius * stretched.recip() * polar_radius
            }
        }
    }

    /// The outward normal of the surface where the radius vector of a planet-fixed position, m, meets it, of length 1.
    #[inline(always)]
    pub fn normal<S: Scalar>(&self, position: &Vector3<S>) -> Vector3<S> {
        let (equatorial_radius, polar_radius) = self.semi_axes();
        let ratio = equatorial_radius / polar_radius;
        let gradient = Vector3::new(position.x, position.y, position.z * (ratio * ratio));
        gradient * reciprocal_or_one(length(&gradient))
    }

    /// The distance from the centre to the surface at a geocentric latitude, in m.
    ///
    /// # Reference
    /// Jameson 2006, equations 44 and 45.
    #[inline(always)]
    pub fn surface_radius<S: Scalar>(&self, sin_latitude: S, cos_latitude: S) -> S {
        match *self {
            Self::Sphere { radius } => S::from(radius),
            Self::Ellipsoid { equatorial_radius, polar_radius } => {
                let ratio = polar_radius / equatorial_radius;
                let root = (sin_latitude * sin_latitude + cos_latitude * cos_latitude * (ratio * ratio)).sqrt();
                root.recip() * polar_radius
            }
        }
    }

    /// The semi-axes in the equatorial plane and along the pole, in m.
    pub fn semi_axes(&self) -> (f64, f64) {
        match *self {
            Self::Sphere { radius } => (radius, radius),
            Self::Ellipsoid { equatorial_radius, polar_radius } => (equatorial_radius, polar_radius),
        }
    }
}

/// A rotating planet.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Planet {
    /// The surface.
    pub shape: Shape,
    /// How gravity falls off.
    pub gravity: Gravity,
    /// Acceleration of gravity times the radius squared, m³/s².
    pub gravitational_parameter: f64,
    /// The parameter by which orbital elements are converted, m³/s²; the thesis uses a slightly different one than for its gravity.
    pub orbital_gravitational_parameter: f64,
    /// Rotation about the pole relative to inertial space, positive to the east, rad/s.
    pub rotation_rate: f64,
}

/// Equatorial radius of the Earth, m: WGS 84, NIMA TR8350.2 (2000), table 3.1; Jameson 2006, equation 35.
const EARTH_RADIUS: f64 = 6_378_137.0;
/// Polar radius that the thesis uses, m: Jameson 2006, equation 42.
const JAMESON_POLAR_RADIUS: f64 = 6_356_752.314_2;
/// Gravitational parameter of the thesis's orbital elements, m³/s²: Jameson 2006, equation 65.
const JAMESON_ORBITAL_PARAMETER: f64 = 3.986_01e14;

impl Planet {
    /// The Earth of WGS 84, as an ellipsoid.
    ///
    /// # Reference
    /// NIMA TR8350.2, 3rd edition, amendment 1 (2000), tables 3.1 and 3.3.
    pub const EARTH_WGS84: Self = Self {
        shape: Shape::Ellipsoid {
            equatorial_radius: EARTH_RADIUS,
            polar_radius: EARTH_RADIUS * (1.0 - 1.0 / 298.257_223_563),
        },
        gravity: Gravity::InverseSquare,
        gravitational_parameter: 3.986_004_418e14,
        orbital_gravitational_parameter: 3.986_004_418e14,
        rotation_rate: 7.292_115e-5,
    };

    /// The Earth of the thesis's program listing, with which its results were made: g₀ = 9.798 m/s².
    pub const EARTH_JAMESON_LISTING: Self = Self {
        shape: Shape::Ellipsoid { equatorial_radius: EARTH_RADIUS, polar_radius: JAMESON_POLAR_RADIUS },
        gravity: Gravity::InverseSquare,
        gravitational_parameter: 9.798 * EARTH_RADIUS * EARTH_RADIUS,
        orbital_gravitational_parameter: JAMESON_ORBITAL_PARAMETER,
        rotation_rate: 7.292_115_146_7e-5,
    };

    /// The Earth of the thesis's text (equations 32 and 34), whose g₀ = 9.7803253359 m/s² contains the centrifugal relief a second time.
    pub const EARTH_JAMESON_TEXT: Self = Self {
        gravitational_parameter: 9.780_325_335_9 * EARTH_RADIUS * EARTH_RADIUS,
        rotation_rate: 7.292_115_855_228_083e-5,
        ..Self::EARTH_JAMESON_LISTING
    };

    /// The same planet with a spherical surface of its equatorial radius.
    #[must_use]
    pub fn spherical(self) -> Self {
        Self { shape: Shape::Sphere { radius: self.equatorial_radius() }, ..self }
    }

    /// Semi-axis in the equatorial plane, m: the r₀ of the equations.
    pub fn equatorial_radius(&self) -> f64 {
        self.shape.semi_axes().0
    }

    /// Acceleration of the gravity of a point, m/s², towards the centre; `over_radius`: one over the distance from it, 1/m.
    ///
    /// # Reference
    /// Jameson 2006, equation 33: g = g₀ (r₀/r)².
    #[inline(always)]
    pub fn point_gravity<S: Scalar>(&self, over_radius: S) -> S {
        over_radius * over_radius * self.gravitational_parameter
    }

    /// [`gravity`](Self::gravity) without its harmonics.
    #[inline(always)]
    pub(crate) fn gravity_of_point<S: Scalar>(&self, over_radius: S, up: &Vector3<S>) -> Vector3<S> {
        let inward = self.point_gravity(over_radius);
        up.map(|component| component * -inward)
    }

    /// Acceleration of gravity, m/s², in the planet-fixed direction `up`, of length 1; `over_radius`: one over the distance from the centre, 1/m.
    #[inline(always)]
    pub fn gravity<S: Scalar>(&self, over_radius: S, up: &Vector3<S>) -> Vector3<S> {
        match self.gravity {
            Gravity::InverseSquare => self.gravity_of_point(over_radius, up),
            Gravity::Zonal(_) => {
                let Pull { inward, axial } = self.pull(over_radius, up.z);
                let mut gravity = up.map(|component| component * -inward);
                gravity.z -= axial;
                gravity
            }
        }
    }

    /// Acceleration of gravity, m/s², by its parts along the radius and along the axis, at the sine of a geocentric latitude; `over_radius`: one over
    /// the distance from the centre, 1/m.
    #[inline(always)]
    pub(crate) fn pull<S: Scalar>(&self, over_radius: S, sin_latitude: S) -> Pull<S> {
        let inward = self.point_gravity(over_radius);
        match &self.gravity {
            Gravity::InverseSquare => Pull { inward, axial: S::zero() },
            Gravity::Zonal(zonal) => {
                let over_point = zonal.pull(sin_latitude, over_radius * self.equatorial_radius());
                Pull { inward: over_point.inward * inward, axial: over_point.axial * inward }
            }
        }
    }

    /// The potential of gravity, m²/s², negative and zero at infinity, at a planet-fixed position, m.
    pub fn potential<S: Scalar>(&self, position: &Vector3<S>) -> S {
        let over_radius = length(position).recip();
        let of_point = over_radius * -self.gravitational_parameter;
        match &self.gravity {
            Gravity::InverseSquare => of_point,
            Gravity::Zonal(zonal) => {
                of_point * zonal.potential(position.z * over_radius, over_radius * self.equatorial_radius())
            }
        }
    }

    /// The potential of gravity and of the centrifugal force at a planet-fixed position, m, in J/kg.
    pub(crate) fn potential_at_rest<S: Scalar>(&self, position: &Vector3<S>) -> S {
        let from_axis_squared = position.x * position.x + position.y * position.y;
        self.potential(position) - from_axis_squared * (0.5 * self.rotation_rate * self.rotation_rate)
    }

    /// The energy of a mass relative to the rotating planet, at a planet-fixed position, m, at a speed relative to it, m/s, in J/kg.
    ///
    /// ```text
    /// E = V²/2 - ω² (x² + y²)/2 + U,   dE/dt = (D + L + T)·V/m
    /// ```
    ///
    /// with the potential U of gravity, negative and zero at infinity. Without wind, lift and the Coriolis force are across the velocity: then E
    /// never grows but by thrust.
    ///
    /// # Reference
    /// Jameson 2006, equation 29, integrated once.
    pub fn energy<S: Scalar>(&self, position: &Vector3<S>, speed: S) -> S {
        speed * speed * 0.5 + self.potential_at_rest(position)
    }
}
