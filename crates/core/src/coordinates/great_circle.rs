//! Downrange and crossrange: a place relative to the great circle on which a flight sets out.

use nalgebra::Vector3;

use super::PlanetFixed;

/// The great circle through the initial ground point along the initial heading; its angles are those at the planet's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreatCircle {
    /// To the initial ground point.
    start: Vector3<f64>,
    /// The direction of the initial heading.
    ahead: Vector3<f64>,
    /// To the right of it.
    right: Vector3<f64>,
}

/// With a smaller part of its speed along the ground than this, a flight starts vertically and has no heading.
const VERTICAL: f64 = 1e-9;

impl GreatCircle {
    /// The great circle of a flight that starts in this state; none if it starts vertically or at rest.
    pub fn of(state: &PlanetFixed<f64>) -> Option<Self> {
        let start = state.position.normalize();
        let level = state.velocity - start * start.dot(&state.velocity);
        let ahead = level.try_normalize(VERTICAL * state.velocity.norm())?;
        Some(Self { start, ahead, right: ahead.cross(&start) })
    }

    /// How far along the circle the foot of a place is, in (-π, π], and how far the place lies to the right of it, rad.
    pub fn along_and_across(&self, position: &Vector3<f64>) -> [f64; 2] {
        let [start, ahead, right] = [&self.start, &self.ahead, &self.right].map(|axis| axis.dot(position));
        [ahead.atan2(start), right.atan2(start.hypot(ahead))]
    }
}
