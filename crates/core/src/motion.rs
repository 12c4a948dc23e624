//! The equations of motion: the forces, gathered once, and the two formulations that integrate them.

mod cartesian;
mod spherical;

pub use cartesian::Cartesian;
pub use spherical::Spherical;

use nalgebra::Vector3;
use num_dual::Dual64;

use crate::atmosphere::Atmosphere;
use crate::coordinates::PlanetFixed;
use crate::integrate::System;
use crate::planet::Planet;
use crate::scalar::{Scalar, direction, length};
use crate::vehicle::Vehicle;

/// The unit of the load factor, m/s²: the standard acceleration of gravity (3rd CGPM, 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Within this angle of the vertical the lift fades out, rad: in vertical flight the bank angle has no meaning.
pub const LIFT_FADE_ANGLE: f64 = 1e-3;

/// Scale heights that a step may fall; see [`Forces::longest_step`].
const SCALE_HEIGHTS_A_STEP: f64 = 10.0;
/// Times of drag that a step may last; see [`Forces::longest_step`].
const DRAG_TIMES_A_STEP: f64 = 1.5;

/// What acts on the vehicle.
#[derive(Clone, Copy, Debug)]
pub struct Forces {
    /// Where it flies.
    pub planet: Planet,
    /// The air, which turns with the planet.
    pub atmosphere: Atmosphere,
    /// What flies.
    pub vehicle: Vehicle,
    /// Sine and cosine of the bank angle σ: 0 lift in the plane of radius and velocity, upward;
    /// positive tilts it to the left of the flight direction, towards growing heading (Jameson 2006, equation 22).
    pub sin_cos_bank: (f64, f64),
}

/// What the air does to the vehicle at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads<S> {
    /// Along the radius vector, above the surface, m.
    pub altitude: S,
    /// kg/m³.
    pub density: S,
    /// ½ρV², Pa.
    pub dynamic_pressure: S,
    /// -dV/dt of the relative speed, m/s²; at rest minus the magnitude of the acceleration.
    pub deceleration: S,
    /// The aerodynamic force over the weight at standard gravity.
    pub load_factor: S,
}

/// A formulation: six numbers that hold the state, and how they change.
pub trait Formulation: System<6> {
    /// The six numbers of a state.
    fn coordinates(state: &PlanetFixed<f64>) -> [f64; 6];

    /// The state of six numbers.
    fn planet_fixed<S: Scalar>(coordinates: &[S; 6]) -> PlanetFixed<S>;

    /// The singularity of the equations that lies `within` this distance of a state: rad, or parts of the circular speed.
    fn singularity(&self, coordinates: &[f64; 6], within: f64) -> Option<Singularity>;

    /// The forces in its equations.
    fn forces(&self) -> &Forces;
}

/// Where the spherical equations divide by zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// cos φ = 0.
    Pole,
    /// cos γ = 0.
    VerticalFlight,
    /// V = 0.
    Rest,
}

impl Forces {
    /// The acceleration relative to the rotating planet, m/s².
    ///
    /// ```text
    /// dv/dt = g(r) + (D + L)/m - 2 ω×v - ω×(ω×r)
    /// L = L (cos σ n̂ + sin σ b̂),   n̂ = unit(r̂ - (r̂·v̂) v̂),   b̂ = n̂ × v̂
    /// ```
    ///
    /// # Reference
    /// Jameson 2006, equations 17 and 21 to 23, without the step to the vehicle-pointing axes.
    #[inline(always)]
    pub fn acceleration<S: Scalar>(&self, state: &PlanetFixed<S>) -> Vector3<S> {
        let PlanetFixed { position, velocity } = state;
        let radius = length(position);
        let speed = length(velocity);
        let up = direction(position, radius);
        let ahead = direction(velocity, speed);

        let density = self.atmosphere.density(self.planet.shape.altitude(position));
        let air = self.vehicle.aerodynamic_acceleration(dynamic_pressure(density, speed));
        let left = up.cross(&ahead);
        let lift = air.lift * lift_fade_over_cosine(left.dot(&left));
        let (sin_bank, cos_bank) = self.sin_cos_bank;
        let lift_up = lift * cos_bank;
        let lift_left = lift * sin_bank;
        let ahead_share = -(air.drag + lift_up * up.dot(&ahead));
        let gravity = self.planet.gravity(radius);

        let rotation = self.planet.rotation_rate;
        let coriolis = [velocity.y * (2.0 * rotation), velocity.x * (-2.0 * rotation)];
        let centrifugal = rotation * rotation;
        let mut acceleration = ahead.map(|component| component * ahead_share)
            + up.map(|component| component * (lift_up - gravity))
            + left.map(|component| component * lift_left);
        acceleration.x += coriolis[0] + position.x * centrifugal;
        acceleration.y += coriolis[1] + position.y * centrifugal;
        acceleration
    }

    /// The units of length, m, and speed, m/s, in which the equations are of order one: r₀ and √(g₀r₀).
    fn units(&self) -> [f64; 2] {
        let length = self.planet.equatorial_radius();
        [length, (self.planet.gravitational_parameter / length).sqrt()]
    }

    /// The longest step that may start in a state, s.
    ///
    /// From space an integrator sees no air, and a long step would jump over the whole atmosphere.
    /// A step ends at the latest when the vehicle, at its present vertical speed and acceleration, has fallen half the way
    /// to the sensible atmosphere and some scale heights more.
    /// In the air it ends within a few times of drag, V/(D/m): where the motion is stiff, an explicit method is stable no longer,
    /// and at loose tolerances its dense output leaves all bounds before the ends of its steps do.
    fn longest_step(&self, state: &PlanetFixed<f64>) -> f64 {
        let PlanetFixed { position, velocity } = state;
        let radius = length(position);
        let altitude = self.planet.shape.altitude(position);
        let to_air = (altitude - self.atmosphere.sensible_altitude()).max(0.0);
        let depth = 0.5 * to_air + SCALE_HEIGHTS_A_STEP * self.atmosphere.scale_height();
        let rise = position.dot(velocity) / radius;
        let inertial = velocity + Vector3::z().cross(position) * self.planet.rotation_rate;
        let level_squared = inertial.norm_squared() - rise * rise;
        let fall = (self.planet.gravity(radius) - level_squared / radius).max(0.0);
        // The positive root of rise t - fall t²/2 = -depth.
        let root = (rise * rise + 2.0 * fall * depth).sqrt();
        let through_air = if rise > 0.0 { (rise + root) / fall } else { 2.0 * depth / (root - rise) };

        let speed = length(velocity);
        let pressure = dynamic_pressure(self.atmosphere.density(altitude), speed);
        let air = self.vehicle.aerodynamic_acceleration(pressure);
        let drag_time = speed / air.drag.hypot(air.lift);
        if drag_time.is_nan() { through_air } else { through_air.min(DRAG_TIMES_A_STEP * drag_time) }
    }

    /// The loads in a state.
    pub fn loads<S: Scalar>(&self, state: &PlanetFixed<S>) -> Loads<S> {
        let PlanetFixed { position, velocity } = state;
        let speed = length(velocity);
        let altitude = self.planet.shape.altitude(position);
        let density = self.atmosphere.density(altitude);
        let dynamic_pressure = dynamic_pressure(density, speed);
        // Per unit of dynamic pressure, so that the squares of tiny forces do not vanish.
        let air = self.vehicle.aerodynamic_acceleration(S::one());
        let cos_squared = cos_squared_flight_path_angle(state);
        let lift = air.lift * lift_fade_over_cosine(cos_squared) * cos_squared.sqrt();
        let acceleration = self.acceleration(state);
        let at_rest = speed.less_than(f64::MIN_POSITIVE);
        let along = acceleration.dot(&direction(velocity, speed));
        Loads {
            altitude,
            density,
            dynamic_pressure,
            deceleration: -S::select(at_rest, length(&acceleration), along),
            load_factor: dynamic_pressure * (air.drag * air.drag + lift * lift).sqrt() / STANDARD_GRAVITY,
        }
    }
}

/// ½ρV², Pa.
#[inline(always)]
fn dynamic_pressure<S: Scalar>(density: S, speed: S) -> S {
    density * speed * speed * 0.5
}

/// cos²γ, the squared sine of the angle between radius and velocity; 0 at rest.
pub fn cos_squared_flight_path_angle<S: Scalar>(state: &PlanetFixed<S>) -> S {
    let up = direction(&state.position, length(&state.position));
    let ahead = direction(&state.velocity, length(&state.velocity));
    let left = up.cross(&ahead);
    left.dot(&left)
}

/// The share of the lift that is left near the vertical, over cos γ: with x = min(cos γ/ε, 1), x³(10 - 15x + 6x²)/cos γ.
///
/// In vertical flight the plane of radius and velocity, from which the bank angle is measured, is undefined; lift that turns
/// the flight down past the vertical would jump to the opposite side. The fade makes the equations smooth there,
/// and is 1 outside the cone.
#[inline(always)]
fn lift_fade_over_cosine<S: Scalar>(cos_squared: S) -> S {
    let cosine = cos_squared.sqrt();
    let x = cosine / LIFT_FADE_ANGLE;
    let faded = x * x * (x * (x * 6.0 - 15.0) + 10.0) / LIFT_FADE_ANGLE;
    let in_cone = cosine.less_than(LIFT_FADE_ANGLE);
    let full = S::select(in_cone, S::one(), cosine).recip();
    S::select(in_cone, faded, full)
}

/// A state that moves along its rate of change: the derivative part of what is computed from it is a rate per second.
pub fn moving(state: &[f64; 6], derivative: &[f64; 6]) -> [Dual64; 6] {
    std::array::from_fn(|i| Dual64::new(state[i], derivative[i]))
}
