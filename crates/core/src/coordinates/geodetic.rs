//! Geodetic coordinates: against the normal of the ellipsoid.

use std::f64::consts::FRAC_PI_2;

use nalgebra::Vector3;

use super::{LocalHorizon, PlanetFixed, longitude_and_latitude, wrap_to_half_turns, wrap_to_turn};
use crate::elementary::{atan2, hypot, sin_cos};
use crate::planet::Shape;

/// Place and motion relative to the rotating planet, against the geodetic local horizontal (the plane normal to the ellipsoid's normal).
///
/// On a sphere these are the geocentric quantities.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Geodetic {
    /// Height above the surface along its normal, m.
    pub geodetic_altitude: f64,
    /// East positive, in (-π, π].
    pub longitude: f64,
    /// The angle of the surface's normal above the equatorial plane, in [-π/2, π/2].
    pub geodetic_latitude: f64,
    /// Relative to the rotating planet, m/s.
    pub speed: f64,
    /// Of the relative velocity above the geodetic horizontal, in [-π/2, π/2].
    pub flight_path_angle: f64,
    /// Clockwise from north, in [0, 2π).
    pub azimuth: f64,
}

impl Geodetic {
    /// The same state in the planet-fixed frame.
    pub fn to_planet_fixed(&self, shape: &Shape) -> PlanetFixed<f64> {
        let (a, b) = shape.semi_axes();
        let (sin_lat, cos_lat) = sin_cos(self.geodetic_latitude);
        let horizon = LocalHorizon::new(self.longitude, self.geodetic_latitude);
        // The foot of the normal on the surface: (a² cos φ, b² sin φ) / √(a² cos²φ + b² sin²φ).
        let norm = hypot(a * cos_lat, b * sin_lat);
        let foot_axial = b * b * sin_lat / norm;
        let foot_equatorial = a * a * cos_lat / norm;
        let (sin_lon, cos_lon) = sin_cos(self.longitude);
        let foot = Vector3::new(foot_equatorial * cos_lon, foot_equatorial * sin_lon, foot_axial);
        PlanetFixed {
            position: foot + horizon.up * self.geodetic_altitude,
            velocity: horizon.velocity(self.speed, self.flight_path_angle, FRAC_PI_2 - self.azimuth),
        }
    }

    /// The state of a planet-fixed position and velocity.
    pub fn from_planet_fixed(state: &PlanetFixed<f64>, shape: &Shape) -> Self {
        let (geodetic_latitude, geodetic_altitude) = latitude_and_altitude(&state.position, shape);
        let longitude = atan2(state.position.y, state.position.x);
        let horizon = LocalHorizon::new(longitude, geodetic_latitude);
        let (speed, flight_path_angle, heading) = horizon.speed_and_angles(&state.velocity);
        let moving_level = speed > 0.0 && flight_path_angle.abs() < FRAC_PI_2;
        let azimuth = if moving_level { wrap_to_turn(FRAC_PI_2 - heading) } else { 0.0 };
        let longitude = wrap_to_half_turns(longitude);
        Self { geodetic_altitude, longitude, geodetic_latitude, speed, flight_path_angle, azimuth }
    }
}

/// Geodetic latitude, rad, and altitude, m, of a planet-fixed position, exact everywhere but at the centre.
///
/// The nearest point of the surface is found as the root of a convex function of the distance along the normal.
///
/// # Reference
/// D. Eberly, Distance from a Point to an Ellipse, an Ellipsoid, or a Hyperellipsoid, Geometric Tools 2013, section 2.
pub fn latitude_and_altitude(position: &Vector3<f64>, shape: &Shape) -> (f64, f64) {
    let equatorial = hypot(position.x, position.y);
    let axial = position.z.abs();
    let (latitude, altitude) = match *shape {
        Shape::Sphere { .. } => return (longitude_and_latitude(position).1, shape.altitude(position)),
        Shape::Ellipsoid { equatorial_radius: a, polar_radius: b } if a >= b => {
            let (normal_equatorial, normal_axial, altitude) = nearest_point((a, b), (equatorial, axial));
            (atan2(normal_axial, normal_equatorial), altitude)
        }
        Shape::Ellipsoid { equatorial_radius: a, polar_radius: b } => {
            let (normal_axial, normal_equatorial, altitude) = nearest_point((b, a), (axial, equatorial));
            (atan2(normal_axial, normal_equatorial), altitude)
        }
    };
    (latitude.copysign(position.z), altitude)
}

/// The direction of the normal at the point of the ellipse (semi-axes `a` ≥ `b`) nearest to the point (`x`, `y`), both ≥ 0,
/// as its two components (of any length), and the height above it.
fn nearest_point((a, b): (f64, f64), (x, y): (f64, f64)) -> (f64, f64, f64) {
    let ratio = (a / b) * (a / b);
    let [u, v] = [x / a, y / b];
    if v < 1e-20 && u * ratio <= ratio - 1.0 {
        // On the long axis to rounding, inside the evolute: the two nearest points lie off the axis; take the one on the
        // side of y ≥ 0.
        let foot_u = u * ratio / (ratio - 1.0);
        let foot_v = (1.0 - foot_u * foot_u).sqrt();
        return (foot_u / a, foot_v / b, -hypot(foot_u * a - x, foot_v * b));
    }
    // The foot, in parts of the semi-axes, is (p, q) = (ratio u / (t + ratio - 1), v / t) with the root t of p² + q² = 1.
    let foot = |t: f64| [ratio * u / (t + (ratio - 1.0)), v / t];
    let excess = |t: f64| {
        let [p, q] = foot(t);
        ((p - 1.0) * (p + 1.0) + q * q, -2.0 * (p * p / (t + (ratio - 1.0)) + q * q / t))
    };
    let [mut least, greatest] = [v, hypot(ratio * u, v)];
    let mut t = hypot(u, v).max(least).min(greatest);
    // A convex, falling function: Newton's method from the left never passes the root, and from the right jumps to its left once.
    for _ in 0..100 {
        let (value, slope) = excess(t);
        if value > 0.0 {
            least = least.max(t);
        }
        let newton = t - value / slope;
        // The root may lie many powers of ten below.
        let between = if least > 0.0 { (least * t).sqrt() } else { 0.5 * t };
        let next = if newton > least { newton.min(greatest) } else { between };
        let change = (next - t).abs();
        t = next;
        if change <= f64::EPSILON * t {
            break;
        }
    }
    let [foot_u, foot_v] = foot(t);
    let normal = (foot_u / a, foot_v / b);
    // Measured along the normal, the difference from the foot does not feel the rounding of t.
    let height = ((x - foot_u * a) * normal.0 + (y - foot_v * b) * normal.1) / hypot(normal.0, normal.1);
    (normal.0, normal.1, height)
}
