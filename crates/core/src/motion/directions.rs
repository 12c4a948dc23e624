//! Where a vehicle points, and how lift fades near the vertical.

use nalgebra::Vector3;

use super::LIFT_FADE_ANGLE;
use crate::scalar::{Scalar, length, reciprocal_or_one};

/// Where a state points.
pub(super) struct Directions<S: nalgebra::Scalar> {
    pub(super) radius: S,
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
        let (over_radius, over_speed) = (reciprocal_or_one(radius), reciprocal_or_one(speed));
        let over_both = over_radius * over_speed;
        Self {
            radius,
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
    let x = cos_gamma / LIFT_FADE_ANGLE;
    let faded = x * x * (x * (x * 6.0 - 15.0) + 10.0) / LIFT_FADE_ANGLE;
    let in_cone = cos_gamma.less_than(LIFT_FADE_ANGLE);
    let full = S::select(in_cone, S::one(), cos_gamma).recip();
    S::select(in_cone, faded, full)
}
