//! Distances over the ground: downrange and crossrange, relative to the great circle on which a flight sets out, the angle to its start,
//! and how fast the ground point moves.

use nalgebra::Vector3;

use super::PlanetFixed;
use crate::elementary::atan2;
use crate::scalar::{Scalar, length, reciprocal_or_one};

/// The great circle through the initial ground point along the initial heading; its angles are those at the planet's centre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreatCircle<S: nalgebra::Scalar = f64> {
    /// To the initial ground point.
    start: Vector3<S>,
    /// The direction of the initial heading; none if the flight starts vertically or at rest.
    ahead: Option<Vector3<S>>,
}

/// With a smaller part of its speed along the ground than this, a flight starts vertically and has no heading.
const VERTICAL: f64 = 1e-9;

impl<S: Scalar<Mask = bool>> GreatCircle<S> {
    /// The great circle of a flight that starts in this state.
    pub fn of(state: &PlanetFixed<S>) -> Self {
        let PlanetFixed { position, velocity } = state;
        let over_radius = reciprocal_or_one(length(position));
        let start = position.map(|component| component * over_radius);
        let climb = start.dot(velocity);
        let level = velocity - start.map(|component| component * climb);
        let along = (length(&level), length(velocity));
        let has_heading = !(along.0 - along.1 * VERTICAL).less_than(f64::MIN_POSITIVE);
        let over_speed = reciprocal_or_one(along.0);
        Self { start, ahead: has_heading.then(|| level.map(|component| component * over_speed)) }
    }

    /// The same in other numbers.
    pub fn map<T: nalgebra::Scalar>(&self, number: impl Fn(S) -> T + Copy) -> GreatCircle<T> {
        GreatCircle { start: self.start.map(number), ahead: self.ahead.map(|ahead| ahead.map(number)) }
    }

    /// Whether the flight has a heading when it starts.
    pub fn has_heading(&self) -> bool {
        self.ahead.is_some()
    }

    /// How far along the circle the foot of a place is, in (-π, π], and how far the place lies to the right of it, rad; none without a
    /// heading.
    pub fn along_and_across(&self, position: &Vector3<S>) -> Option<[S; 2]> {
        let ahead = self.ahead?;
        let right = ahead.cross(&self.start);
        let [start, ahead, right] = [&self.start, &ahead, &right].map(|axis| axis.dot(position));
        Some([ahead.atan2(start), right.atan2((start * start + ahead * ahead).sqrt())])
    }

    /// The angle at the planet's centre between the initial ground point and a place, in [0, π], rad.
    pub fn angle_to(&self, position: &Vector3<S>) -> S {
        length(&self.start.cross(position)).atan2(self.start.dot(position))
    }
}

impl GreatCircle<f64> {
    /// How far along the circle the foot of a place is, in (-π, π], rad; none without a heading.
    pub fn along(&self, position: &Vector3<f64>) -> Option<f64> {
        Some(atan2(self.ahead?.dot(position), self.start.dot(position)))
    }

    /// The sine of the angle between a place and the nearer pole of the circle, where the angle along the circle is undefined; none
    /// without a heading.
    pub fn sine_to_pole(&self, position: &Vector3<f64>) -> Option<f64> {
        let [start, ahead] = [self.start, self.ahead?].map(|axis| axis.dot(position));
        Some(((start * start + ahead * ahead) / position.norm_squared()).sqrt())
    }
}

/// The rate at which the ground point of a state moves, seen from the planet's centre, rad/s.
///
/// ```text
/// |d(r/|r|)/dt| = |r × v| / r²
/// ```
pub fn ground_rate(state: &PlanetFixed<f64>) -> f64 {
    state.position.cross(&state.velocity).norm() / state.position.norm_squared()
}
