//! Where a thrust along the velocity has no direction: at rest.

use super::Forces;
use crate::coordinates::PlanetFixed;
use crate::propulsion::Axis;
use crate::scalar::length;

/// So small a part of the circular speed is rest: less than the steps resolve.
const AT_REST: f64 = 1e-10;
/// The part of the way to rest that a step may go.
const WAY_TO_REST: f64 = 0.9;
/// Where the part of the acceleration at rest that a level thrust cannot withstand is greater than this part of the thrust, rest does not
/// last.
const UPRIGHT: f64 = 1e-9;

impl Forces {
    /// Whether the vehicle is at rest, as far as steps resolve it.
    pub(crate) fn is_at_rest(&self, state: &PlanetFixed<f64>) -> bool {
        let [_, circular_speed] = self.units();
        length(&state.velocity) <= AT_REST * circular_speed
    }

    /// Whether the thrust has no direction at rest.
    pub(crate) fn thrusts_by_velocity(&self) -> bool {
        self.burn.as_ref().is_some_and(|burn| match burn.along {
            Axis::Velocity | Axis::Horizontal | Axis::Normal => true,
            Axis::Radial | Axis::Inertial(_) => false,
        })
    }

    /// Whether a braking thrust would stop every motion that could begin if the vehicle were at rest here: it acts against the velocity,
    /// and is greater than what all other forces together are at rest. Then a vehicle that comes to rest stays there, and its thrust has
    /// no direction.
    pub(crate) fn brakes_to_rest(&self, time: f64, state: &PlanetFixed<f64>) -> bool {
        let Some(burn) = self.burn.as_ref().filter(|burn| burn.acceleration < 0.0) else { return false };
        let still = PlanetFixed { velocity: nalgebra::Vector3::zeros(), ..*state };
        let thrust = -burn.acceleration * burn.lightness(time);
        match burn.along {
            Axis::Velocity => self.acceleration(time, &still).norm() <= thrust,
            Axis::Horizontal => {
                let others = self.acceleration(time, &still);
                let upright = others.dot(&state.position) / length(&state.position);
                others.norm() <= thrust && upright.abs() <= UPRIGHT * thrust
            }
            Axis::Radial | Axis::Normal | Axis::Inertial(_) => false,
        }
    }

    /// The longest step before a braking thrust brings the vehicle to rest, s: beyond, the thrust would push it the other way, and the
    /// integrator would grind its steps down.
    pub(super) fn longest_braking(&self, time: f64, state: &PlanetFixed<f64>) -> f64 {
        if !self.brakes_to_rest(time, state) {
            return f64::INFINITY;
        }
        let speed_squared = state.velocity.norm_squared();
        let braking = -self.acceleration(time, state).dot(&state.velocity);
        if braking > 0.0 { WAY_TO_REST * speed_squared / braking } else { f64::INFINITY }
    }
}
