//! Where a thrust along the velocity has no direction: at rest.

use nalgebra::Vector3;

use super::{Burn, Forces, State, ThrustDirection};
use crate::propulsion::ThrustAxis;
use crate::scalar::length;

/// So small a part of the circular speed is rest: less than the steps resolve.
const AT_REST: f64 = 1e-10;
/// The part of the way to rest that a step may go.
const WAY_TO_REST: f64 = 0.9;

impl Forces {
    /// Whether the vehicle is at rest, as far as steps resolve it.
    pub(crate) fn is_at_rest(&self, state: &State<f64>) -> bool {
        let [_, circular_speed] = self.units();
        length(&state.velocity) <= AT_REST * circular_speed
    }

    /// Whether the thrust has no direction at rest.
    pub(crate) fn thrusts_by_velocity(&self) -> bool {
        self.burn.as_ref().is_some_and(|burn| match burn.direction {
            ThrustDirection::Axis(ThrustAxis::Velocity | ThrustAxis::Horizontal | ThrustAxis::Normal) => true,
            // Steering by the velocity has a direction at rest.
            ThrustDirection::Axis(ThrustAxis::Radial | ThrustAxis::Inertial(_)) | ThrustDirection::Steered => false,
        })
    }

    /// Whether a vehicle that the thrust brings to rest here stays at rest: the thrust acts against the velocity, and is as great as all
    /// other forces together on the vehicle at rest, so that it stops every motion as it begins.
    pub(crate) fn brakes_to_rest(&self, time: f64, state: &State<f64>) -> bool {
        const ALONG_VELOCITY: ThrustDirection = ThrustDirection::Axis(ThrustAxis::Velocity);
        let brakes = |burn: &&Burn<f64>| burn.direction == ALONG_VELOCITY && burn.acceleration < 0.0;
        self.burn.as_ref().filter(brakes).is_some_and(|burn| {
            let still = State { velocity: Vector3::zeros(), ..*state };
            self.acceleration(time, &still).norm() <= -burn.acceleration * self.mass_ratio(state.mass).unwrap_or(1.0)
        })
    }

    /// The longest step before a braking thrust brings the vehicle to rest, s: beyond, the thrust would push it the other way, and there
    /// an integrator grinds its steps down.
    pub(super) fn longest_braking(&self, time: f64, state: &State<f64>) -> f64 {
        if !self.brakes_to_rest(time, state) {
            return f64::INFINITY;
        }
        let speed_squared = state.velocity.norm_squared();
        let braking = -self.acceleration(time, state).dot(&state.velocity);
        if braking > 0.0 { WAY_TO_REST * speed_squared / braking } else { f64::INFINITY }
    }
}
