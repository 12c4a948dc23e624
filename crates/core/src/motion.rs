//! The equations of motion: the forces, gathered once, and the two formulations that integrate them.

mod cartesian;
mod spherical;

pub use cartesian::Cartesian;
pub use spherical::Spherical;

use nalgebra::Vector3;
use num_dual::Dual64;

use crate::atmosphere::Atmosphere;
use crate::control::Control;
use crate::coordinates::PlanetFixed;
use crate::integrate::Pace;
use crate::interpolation::Hint;
use crate::planet::Planet;
use crate::scalar::{Over, Scalar, length, reciprocal_or_one};
use crate::vehicle::{Aerodynamics, Coefficients};
use crate::wind::Wind;

/// The unit of the load factor, m/s²: the standard acceleration of gravity (3rd CGPM, 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Within this angle of the vertical the lift fades out, rad: in vertical flight the bank angle has no meaning.
pub const LIFT_FADE_ANGLE: f64 = 1e-3;

/// Scale heights that a step may fall; see [`Forces::longest_step`].
const SCALE_HEIGHTS_A_STEP: f64 = 10.0;
/// Times of drag that a step may last; see [`Forces::longest_step`].
const DRAG_TIMES_A_STEP: f64 = 1.5;

/// What acts on the vehicle; the parameters may carry derivatives, or belong to several vehicles side by side.
#[derive(Clone, Debug)]
pub struct Forces<P = f64> {
    models: Models,
    parameters: Parameters<P>,
    area_over_mass: P,
    sin_cos_bank: (P, P),
}

/// What all vehicles side by side have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Models {
    /// Where they fly.
    pub planet: Planet,
    /// The air, which turns with the planet.
    pub atmosphere: Atmosphere,
    /// How the air moves against the planet.
    pub wind: Wind,
    /// The coefficients.
    pub aerodynamics: Aerodynamics,
    /// The angles at which the vehicle flies.
    pub control: Control,
}

/// The numbers that may vary, beside the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<P> {
    /// kg.
    pub mass: P,
    /// m².
    pub reference_area: P,
    /// `C_L` less that of the model.
    pub lift_coefficient: P,
    /// `C_D` less that of the model.
    pub drag_coefficient: P,
    /// The density over that of the model.
    pub density: P,
    /// σ, rad: 0 lift in the plane of radius and velocity, upward;
    /// positive tilts it to the left of the flight direction, towards growing heading (Jameson 2006, equation 22).
    pub bank_angle: P,
}

/// What the air does to the vehicle at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads<S> {
    /// Along the radius vector, above the surface, m.
    pub altitude: S,
    /// kg/m³.
    pub density: S,
    /// Relative to the air, m/s.
    pub air_speed: S,
    /// The speed relative to the air over that of sound; none where the atmosphere has no temperature.
    pub mach: Option<S>,
    /// ½ρV² of the speed relative to the air, Pa.
    pub dynamic_pressure: S,
    /// -dV/dt of the relative speed, m/s²; at rest minus the magnitude of the acceleration.
    pub deceleration: S,
    /// The aerodynamic force over the weight at standard gravity.
    pub load_factor: S,
}

/// A formulation: six numbers that hold the state, and how they change.
pub trait Formulation: Pace<6> {
    /// The six numbers of a state.
    fn coordinates<S: Scalar>(state: &PlanetFixed<S>) -> [S; 6];

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

/// What a unit of density does to the vehicle, at full lift: accelerations over the density, m⁴/(kg s²).
struct Air<S> {
    /// D/(m ρ), against the velocity.
    drag: S,
    /// L/(m ρ), across the velocity.
    lift: S,
}

impl<P: Scalar> Forces<P> {
    /// The forces by these models, with these parameters.
    pub fn new(models: Models, parameters: Parameters<P>) -> Self {
        let area_over_mass = parameters.reference_area * parameters.mass.recip();
        let sin_cos_bank = parameters.bank_angle.sin_cos();
        Self { models, parameters, area_over_mass, sin_cos_bank }
    }

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
    pub fn acceleration<S: Over<P>>(&self, state: &PlanetFixed<S>) -> Vector3<S> {
        let PlanetFixed { position, velocity } = state;
        let Directions { radius, speed, up, ahead, left, cos_gamma } = Directions::of(state);
        let air = self.air(speed);
        let lift = air.lift * lift_fade_over_cosine(cos_gamma);
        let (sin_bank, cos_bank) = self.sin_cos_bank;
        let lift_up = lift * cos_bank;
        let lift_left = lift * sin_bank;
        let against = air.drag + lift_up * up.dot(&ahead);
        let gravity = self.models.planet.gravity(radius);

        let rotation = self.models.planet.rotation_rate;
        let centrifugal = rotation * rotation;
        let mut fall = up.map(|component| component * -gravity);
        fall.x += velocity.y * (2.0 * rotation) + position.x * centrifugal;
        fall.y += velocity.x * (-2.0 * rotation) + position.y * centrifugal;

        // The density, an exponential, is what all else would wait for.
        let density = self.density(self.models.planet.shape.altitude(position));
        Vector3::from_fn(|i, _| (up[i] * lift_up + left[i] * lift_left - ahead[i] * against) * density + fall[i])
    }

    /// ρ, kg/m³, at an altitude, m.
    #[inline(always)]
    fn density<S: Over<P>>(&self, altitude: S) -> S {
        self.models.atmosphere.density(0, altitude, &Hint::default()) * self.parameters.density
    }

    /// What the air does to a vehicle of a speed, m/s.
    ///
    /// ```text
    /// D = ½ ρ V² S C_D,   L = ½ ρ V² S C_L
    /// ```
    ///
    /// # Reference
    /// Jameson 2006, equations 36 and 37.
    #[inline(always)]
    fn air<S: Over<P>>(&self, speed: S) -> Air<S> {
        let acceleration = speed * speed * 0.5 * self.area_over_mass;
        let (lift_coefficient, drag_coefficient) = self.coefficients();
        Air { drag: acceleration * drag_coefficient, lift: acceleration * lift_coefficient }
    }

    /// `C_L` and `C_D`.
    #[inline(always)]
    fn coefficients(&self) -> (P, P) {
        let Coefficients { lift, drag } = self.models.aerodynamics.coefficients();
        (self.parameters.lift_coefficient + lift, self.parameters.drag_coefficient + drag)
    }
}

impl Forces {
    /// Where it flies.
    pub fn planet(&self) -> &Planet {
        &self.models.planet
    }

    /// The units of length, m, and speed, m/s, in which the equations are of order one: r₀ and √(g₀r₀).
    fn units(&self) -> [f64; 2] {
        let length = self.models.planet.equatorial_radius();
        [length, (self.models.planet.gravitational_parameter / length).sqrt()]
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
        let altitude = self.models.planet.shape.altitude(position);
        let to_air = (altitude - self.models.atmosphere.sensible_altitude()).max(0.0);
        let depth = 0.5 * to_air + SCALE_HEIGHTS_A_STEP * self.models.atmosphere.scale_height();
        let rise = position.dot(velocity) / radius;
        let inertial = velocity + Vector3::z().cross(position) * self.models.planet.rotation_rate;
        let level_squared = inertial.norm_squared() - rise * rise;
        let fall = (self.models.planet.gravity(radius) - level_squared / radius).max(0.0);
        // The positive root of rise t - fall t²/2 = -depth.
        let root = (rise * rise + 2.0 * fall * depth).sqrt();
        let through_air = if rise > 0.0 { (rise + root) / fall } else { 2.0 * depth / (root - rise) };

        let speed = length(velocity);
        let air = self.air(speed);
        let drag_time = speed / (air.drag.max(air.lift.abs()) * self.density(altitude));
        if drag_time.is_nan() { through_air } else { through_air.min(DRAG_TIMES_A_STEP * drag_time) }
    }

    /// D/m, m/s², in a state.
    pub fn drag(&self, state: &PlanetFixed<f64>) -> f64 {
        let density = self.density(self.models.planet.shape.altitude(&state.position));
        self.drag_under(density * state.velocity.norm_squared() * 0.5)
    }

    /// D/m, m/s², under a dynamic pressure, Pa.
    pub fn drag_under(&self, dynamic_pressure: f64) -> f64 {
        let (_, drag_coefficient) = self.coefficients();
        dynamic_pressure * self.area_over_mass * drag_coefficient
    }

    /// The loads in a state.
    pub fn loads<S: Over<f64> + Scalar<Mask = bool>>(&self, state: &PlanetFixed<S>) -> Loads<S> {
        let position = &state.position;
        let Directions { radius, speed, up, ahead, cos_gamma, .. } = Directions::of(state);
        let altitude = self.models.planet.shape.altitude(position);
        let density = self.density(altitude);
        let dynamic_pressure = density * speed * speed * 0.5;
        let deceleration = if speed.less_than(f64::MIN_POSITIVE) {
            -length(&self.acceleration(state))
        } else {
            // -V̇ = D/m + g sin γ - ω² (x v̂_x + y v̂_y): lift and the Coriolis force are across the velocity   (29)
            let outward = position.x * ahead.x + position.y * ahead.y;
            self.air(speed).drag * density + self.models.planet.gravity(radius) * up.dot(&ahead)
                - outward * self.models.planet.rotation_rate.powi(2)
        };
        let (lift_coefficient, drag_coefficient) = self.coefficients();
        let lift_coefficient = lift_fade_over_cosine(cos_gamma) * cos_gamma * lift_coefficient;
        // The squares of coefficients, since those of tiny forces would vanish.
        let coefficient = (lift_coefficient * lift_coefficient + drag_coefficient * drag_coefficient).sqrt();
        let load_factor = dynamic_pressure * coefficient * (self.area_over_mass / STANDARD_GRAVITY);
        Loads { altitude, density, air_speed: speed, mach: None, dynamic_pressure, deceleration, load_factor }
    }
}

/// Where a state points.
struct Directions<S: nalgebra::Scalar> {
    radius: S,
    speed: S,
    /// r̂.
    up: Vector3<S>,
    /// v̂; zero at rest.
    ahead: Vector3<S>,
    /// r̂ × v̂, of length cos γ.
    left: Vector3<S>,
    cos_gamma: S,
}

impl<S: Scalar> Directions<S> {
    #[inline(always)]
    fn of(state: &PlanetFixed<S>) -> Self {
        let PlanetFixed { position, velocity } = state;
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

/// cos²γ, the squared sine of the angle between radius and velocity; 0 at rest.
pub fn cos_squared_flight_path_angle<S: Scalar>(state: &PlanetFixed<S>) -> S {
    let left = Directions::of(state).left;
    left.dot(&left)
}

/// The share of the lift that is left near the vertical, over cos γ: with x = min(cos γ/ε, 1), x³(10 - 15x + 6x²)/cos γ.
///
/// In vertical flight the plane of radius and velocity, from which the bank angle is measured, is undefined; lift that turns
/// the flight down past the vertical would jump to the opposite side. The fade makes the equations smooth there,
/// and is 1 outside the cone.
#[inline(always)]
fn lift_fade_over_cosine<S: Scalar>(cos_gamma: S) -> S {
    let x = cos_gamma / LIFT_FADE_ANGLE;
    let faded = x * x * (x * (x * 6.0 - 15.0) + 10.0) / LIFT_FADE_ANGLE;
    let in_cone = cos_gamma.less_than(LIFT_FADE_ANGLE);
    let full = S::select(in_cone, S::one(), cos_gamma).recip();
    S::select(in_cone, faded, full)
}

/// A state that moves along its rate of change: the derivative part of what is computed from it is a rate per second.
pub fn moving(state: &[f64; 6], derivative: &[f64; 6]) -> [Dual64; 6] {
    std::array::from_fn(|i| Dual64::new(state[i], derivative[i]))
}
