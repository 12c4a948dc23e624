//! Classical orbital elements.

use std::f64::consts::{PI, TAU};

use nalgebra::Vector3;

use super::{Inertial, rotation_about, wrap_to_half_turns, wrap_to_turn};
use crate::elementary::{atan2, cbrt, hypot, sin, sin_cos};

/// The size of an orbit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum OrbitShape {
    /// a, m: positive for ellipses, negative for hyperbolas; parabolas have none.
    SemiMajorAxis(f64),
    /// p, m: positive for every orbit.
    SemiLatusRectum(f64),
}

/// The orbit that a state would follow if nothing but a point's gravity acted on it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OrbitalElements {
    /// Its size.
    pub shape: OrbitShape,
    /// e: 0 a circle, below 1 an ellipse, 1 a parabola, above a hyperbola.
    pub eccentricity: f64,
    /// i, between the orbit's angular momentum and the pole, in [0, π].
    pub inclination: f64,
    /// Ω, right ascension of the ascending node, from the inertial x axis, in [0, 2π).
    pub raan: f64,
    /// ω, from the ascending node to the periapsis in the direction of motion, in [0, 2π).
    pub argument_of_periapsis: f64,
    /// ν, from the periapsis to the vehicle, in [0, 2π).
    pub true_anomaly: f64,
}

/// Elements that a state leaves undefined; they take the values of Vallado's conventions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct UndefinedElements {
    /// A circle has no periapsis: `argument_of_periapsis` is 0 and `true_anomaly` counts from the node.
    pub circular: bool,
    /// An orbit in the equator has no node: `raan` is 0 and the argument of periapsis counts from the x axis in the direction of motion.
    pub equatorial: bool,
}

/// Rectilinear motion, towards or away from the centre, has no orbital elements.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("rectilinear motion has no orbital elements")]
pub struct NoElements;

/// Eccentricities and sines of the inclination below this are noise: f64 keeps them to about 1e-15.
const UNDEFINED: f64 = 1e-12;
/// Below this ratio of semi-latus rectum to radius the elements keep fewer than ten digits of the state.
const RECTILINEAR: f64 = 1e-6;

impl OrbitalElements {
    /// p, m.
    ///
    /// # Reference
    /// Jameson 2006, equation 63.
    pub fn semi_latus_rectum(&self) -> f64 {
        match self.shape {
            OrbitShape::SemiMajorAxis(a) => a * (1.0 - self.eccentricity) * (1.0 + self.eccentricity),
            OrbitShape::SemiLatusRectum(p) => p,
        }
    }

    /// The inertial position and velocity, under the gravitational parameter in m³/s².
    ///
    /// # Reference
    /// Jameson 2006, equations 61 to 67.
    pub fn to_inertial(&self, gravitational_parameter: f64) -> Inertial {
        let p = self.semi_latus_rectum();
        let (sin_nu, cos_nu) = sin_cos(self.true_anomaly);
        let radius = p / (1.0 + self.eccentricity * cos_nu);
        let position = Vector3::new(cos_nu, sin_nu, 0.0) * radius;
        let velocity = Vector3::new(-sin_nu, self.eccentricity + cos_nu, 0.0) * (gravitational_parameter / p).sqrt();
        let from_perifocal = rotation_about(2, self.raan)
            * rotation_about(0, self.inclination)
            * rotation_about(2, self.argument_of_periapsis);
        Inertial { position: from_perifocal * position, velocity: from_perifocal * velocity }
    }

    /// The elements of an inertial state under the gravitational parameter in m³/s², and which of them are conventions.
    ///
    /// The shape is the semi-major axis but for a parabola (|1 - e| < 1e-12), which has a semi-latus rectum.
    ///
    /// # Errors
    /// [`NoElements`] for motion towards or away from the centre.
    ///
    /// # Reference
    /// D. A. Vallado, Fundamentals of Astrodynamics and Applications, 4th ed. 2013, algorithm 9, with arc tangents for its arc cosines.
    pub fn from_inertial(
        state: &Inertial,
        gravitational_parameter: f64,
    ) -> Result<(Self, UndefinedElements), NoElements> {
        let (r, v) = (&state.position, &state.velocity);
        let radius = r.norm();
        let momentum = r.cross(v);
        let p = momentum.norm_squared() / gravitational_parameter;
        if p.is_nan() || p < RECTILINEAR * radius {
            return Err(NoElements);
        }
        let normal = momentum / momentum.norm();
        let eccentricity_vector = v.cross(&momentum) / gravitational_parameter - r / radius;
        let eccentricity = eccentricity_vector.norm();
        let equatorial = hypot(normal.x, normal.y) < UNDEFINED;
        let circular = eccentricity < UNDEFINED;

        let node = if equatorial { Vector3::x() } else { Vector3::new(-normal.y, normal.x, 0.0).normalize() };
        let across = normal.cross(&node);
        let argument = |vector: &Vector3<f64>| atan2(vector.dot(&across), vector.dot(&node));
        let argument_of_periapsis = if circular { 0.0 } else { wrap_to_turn(argument(&eccentricity_vector)) };
        let parabolic = (1.0 - eccentricity).abs() < UNDEFINED;
        let elements = Self {
            shape: if parabolic {
                OrbitShape::SemiLatusRectum(p)
            } else {
                OrbitShape::SemiMajorAxis(p / ((1.0 - eccentricity) * (1.0 + eccentricity)))
            },
            eccentricity,
            inclination: atan2(hypot(normal.x, normal.y), normal.z),
            raan: wrap_to_turn(atan2(node.y, node.x)),
            argument_of_periapsis,
            true_anomaly: wrap_to_turn(argument(r) - argument_of_periapsis),
        };
        Ok((elements, UndefinedElements { circular, equatorial }))
    }

    /// Distance of the periapsis from the centre, m.
    pub fn periapsis_radius(&self) -> f64 {
        self.semi_latus_rectum() / (1.0 + self.eccentricity)
    }

    /// Distance of the apoapsis from the centre, m; none for an unbound orbit.
    pub fn apoapsis_radius(&self) -> Option<f64> {
        self.is_bound().then(|| self.semi_latus_rectum() / (1.0 - self.eccentricity))
    }

    /// The time of one revolution, s; none for an unbound orbit.
    pub fn period(&self, gravitational_parameter: f64) -> Option<f64> {
        let a = self.semi_latus_rectum() / ((1.0 - self.eccentricity) * (1.0 + self.eccentricity));
        self.is_bound().then(|| TAU * a * (a / gravitational_parameter).sqrt())
    }

    /// M, from the periapsis in parts of the time of a revolution, in [0, 2π); none for an unbound orbit.
    ///
    /// ```text
    /// tan E/2 = √((1-e)/(1+e)) tan ν/2,   M = E - e sin E
    /// ```
    ///
    /// # Reference
    /// D. A. Vallado, Fundamentals of Astrodynamics and Applications, 4th ed. 2013, equations 2-4 and 2-14.
    pub fn mean_anomaly(&self) -> Option<f64> {
        let e = self.eccentricity;
        let (sin_half, cos_half) = sin_cos(self.true_anomaly / 2.0);
        let eccentric = 2.0 * atan2((1.0 - e).sqrt() * sin_half, (1.0 + e).sqrt() * cos_half);
        self.is_bound().then(|| wrap_to_turn(mean_of_eccentric(eccentric, e)))
    }

    fn is_bound(&self) -> bool {
        1.0 - self.eccentricity >= UNDEFINED
    }
}

/// ν of an orbit with e < 1 at the mean anomaly, in (-π, π].
pub fn true_anomaly(mean_anomaly: f64, eccentricity: f64) -> f64 {
    let e = eccentricity;
    let mean = wrap_to_half_turns(mean_anomaly);
    let (sin_half, cos_half) = sin_cos(eccentric_anomaly(mean.abs(), e) / 2.0);
    let anomaly = 2.0 * atan2((1.0 + e).sqrt() * sin_half, (1.0 - e).sqrt() * cos_half);
    anomaly.copysign(mean)
}

/// E of a mean anomaly in [0, π]: the root of Kepler's equation.
///
/// On these the mean anomaly is a convex function of E, so that Newton's method falls to the root from every point above it. It starts at
/// the lowest of the bounds M + e, M/(1-e) and (π² M/e)^⅓, the last of E - sin E >= E³/π², and needs some five steps.
fn eccentric_anomaly(mean: f64, e: f64) -> f64 {
    let cubic = cbrt(PI * PI * mean / e);
    let mut eccentric = (mean + e).min(mean / (1.0 - e)).min(if e > 0.0 { cubic } else { PI }).min(PI);
    for _ in 0..MOST_STEPS {
        // 1 - e cos E, without the difference of two numbers near 1.
        let slope = (1.0 - e) + 2.0 * e * sin(eccentric / 2.0).powi(2);
        let next = eccentric - (mean_of_eccentric(eccentric, e) - mean) / slope;
        // Rounding alone lets it rise, or stay; at M = 0 the slope may be 0.
        if next >= eccentric {
            break;
        }
        eccentric = next.max(0.0);
    }
    eccentric
}

/// Steps of Newton's method: more than it was ever seen to take, as each doubles the digits.
const MOST_STEPS: usize = 50;

/// E - e sin E as (1-e) E + e (E - sin E), which keeps its digits where e is near 1 and E near 0.
fn mean_of_eccentric(eccentric: f64, e: f64) -> f64 {
    (1.0 - e) * eccentric + e * less_sine(eccentric)
}

/// x - sin x: by its series where the difference would lose digits.
fn less_sine(x: f64) -> f64 {
    if x.abs() > 1.0 {
        return x - sin(x);
    }
    // x³/3! (1 - x²/(4·5) (1 - x²/(6·7) (1 - ...))); eight factors are exact below 1.
    let square = x * x;
    let series = (2..10).rev().fold(1.0, |inner, n| {
        let n = f64::from(2 * n);
        1.0 - square / (n * (n + 1.0)) * inner
    });
    x * square / 6.0 * series
}
