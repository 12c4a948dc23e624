//! Where a vehicle points, and how what has no direction there fades: lift near the vertical, wind near the poles.

use nalgebra::Vector3;

use super::{LIFT_FADE_ANGLE, WIND_FADE_ANGLE};
use crate::scalar::{Scalar, length, reciprocals_or_one};

/// Where a state points.
pub(super) struct Directions<S: nalgebra::Scalar> {
    /// 1/r, 1/m.
    pub(super) over_radius: S,
    pub(super) speed: S,
    /// r̂.
    pub(super) up: Vector3<S>,
    /// v̂; zero at rest.
    pub(super) ahead: Vector3<S>,
    /// r̂ × v̂, of length cos γ.
    pub(super) left: Vector3<S>,
    pub(super) cos_gamma: S,
}

impl<S: Scalar> Directions<S> {
    #[inline(always)]
    pub(super) fn of(position: &Vector3<S>, velocity: &Vector3<S>) -> Self {
        // The three roots do not wait for each other.
        let across = position.cross(velocity);
        let (radius, speed, moment) = (length(position), length(velocity), length(&across));
        let ([over_radius, over_speed], over_both) = reciprocals_or_one([radius, speed]);
        Self {
            over_radius,
            speed,
            up: position.map(|component| component * over_radius),
            ahead: velocity.map(|component| component * over_speed),
            left: across.map(|component| component * over_both),
            cos_gamma: moment * over_both,
        }
    }
}

/// The share of the lift that is left near the vertical, over cos γ: with x = min(cos γ/ε, 1), x³(10 - 15x + 6x²)/cos γ.
///
/// In vertical flight the plane of radius and velocity, from which the bank angle is measured, is undefined; lift that turns
/// the flight down past the vertical would jump to the opposite side. The fade makes the equations smooth there,
/// and is 1 outside the cone.
#[inline(always)]
pub(super) fn lift_fade_over_cosine<S: Scalar>(cos_gamma: S) -> S {
    let x = cos_gamma * LIFT_FADE_ANGLE.recip();
    let faded = x * x * (x * (x * 6.0 - 15.0) + 10.0) * LIFT_FADE_ANGLE.recip();
    let in_cone = cos_gamma.less_than(LIFT_FADE_ANGLE);
    let full = S::select(in_cone, S::one(), cos_gamma).recip();
    S::select(in_cone, faded, full)
}

/// How fast the share of the lift that is left grows with cos γ in the cone, per rad: with x = cos γ/ε, 30 x² (1 - x)²/ε. Outside it is 0.
#[inline(always)]
pub(super) fn lift_fade_slope<S: Scalar>(cos_gamma: S) -> S {
    let x = cos_gamma * LIFT_FADE_ANGLE.recip();
    let root = x * (-x + 1.0);
    S::select(x.less_than(1.0), root * root * (30.0 / LIFT_FADE_ANGLE), S::zero())
}

/// A velocity less that of a wind to the east and to the north, m/s, at a planet-fixed position, m.
#[inline(always)]
pub(super) fn relative_to_air<S: Scalar>(
    velocity: &Vector3<S>,
    [east, north]: [S; 2],
    position: &Vector3<S>,
) -> Vector3<S> {
    let [x, y, z] = [position.x, position.y, position.z];
    // ẑ × r, of the length of the distance from the axis.
    let equatorial = (x * x + y * y).sqrt();
    let ([over_equatorial, over_radius], over_both) = reciprocals_or_one([equatorial, length(position)]);
    let fade = wind_fade(equatorial * over_radius);
    let [east, north] = [east * fade, north * fade];
    let east = Vector3::new(-y, x, S::zero()) * (over_equatorial * east);
    let to_north = Vector3::new(-x * z, -y * z, x * x + y * y);
    let north = to_north * (over_both * north);
    velocity - east - north
}

/// The share of the wind that is left near a pole: with x = min(cos φ/ε, 1), x³(10 - 15x + 6x²).
///
/// Wind to the north blows towards the pole from all sides, and wind to the east around it: without the fade the air would jump to the
/// opposite direction there, and what drifts with it could not go on.
#[inline(always)]
pub(super) fn wind_fade<S: Scalar>(cos_latitude: S) -> S {
    let x = cos_latitude * WIND_FADE_ANGLE.recip();
    let faded = x * x * x * (x * (x * 6.0 - 15.0) + 10.0);
    S::select(cos_latitude.less_than(WIND_FADE_ANGLE), faded, S::one())
}

/// A vector on axes that have turned away from it by an angle, rad, about z.
#[inline(always)]
pub(super) fn turned<S: Scalar>(vector: &Vector3<f64>, angle: S) -> Vector3<S> {
    let (sin, cos) = angle.sin_cos();
    Vector3::new(cos * vector.x + sin * vector.y, cos * vector.y - sin * vector.x, S::from(vector.z))
}
