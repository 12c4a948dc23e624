//! The thrust: how large it is, where it points, and what it burns.

use nalgebra::{Rotation3, Vector3};

use super::directions::{Directions, lift_fade_over_cosine, turned};
use super::{Arguments, Flow, Forces, State, Switch};
use crate::control::Command;
use crate::coordinates::PlanetFixed;
use crate::elementary::atan2;
use crate::planet::Planet;
use crate::propulsion::ThrustAxis;
use crate::scalar::{Over, Scalar, apart, length, reciprocal_or_one};
use crate::steering::{Program, ProgramAxes, Steering};

/// A thrust that acts, over the mass of the vehicle at the start of the phase, and the mass that it burns. Both run along straight lines of
/// the time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Burn<P> {
    /// The direction of the thrust.
    pub direction: ThrustDirection,
    /// When thrust and mass flow have the values that are given, s.
    pub since: P,
    /// The thrust in vacuum over the mass at the start of the phase, m/s².
    pub acceleration: P,
    /// Its rate, m/s³.
    pub acceleration_rate: P,
    /// The mass flow, kg/s.
    pub mass_flow: P,
    /// Its rate, kg/s².
    pub mass_flow_rate: P,
    /// The exit area on which the pressure of the air acts, over the mass at the start of the phase, m²/kg; none where it has no effect.
    pub exit_area_over_mass: Option<P>,
    /// The acceleration by all but gravity that throttles the thrust, once it is reached, m/s².
    pub load_limit: Option<P>,
}

/// Where a thrust points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThrustDirection {
    /// Along an axis of its own.
    Axis(ThrustAxis),
    /// Along the axis of the vehicle, as the models steer it.
    Steered,
}

/// What a thrust does at an instant.
pub(super) struct Push<S: nalgebra::Scalar> {
    /// Over the mass, m/s².
    pub(super) acceleration: Vector3<S>,
    /// The share of the thrust in vacuum, and of the mass flow, that the load limit leaves.
    pub(super) throttle: S,
}

/// The thrust at an instant as it would be without a load limit, and what that would leave of it.
struct Demand<S: nalgebra::Scalar> {
    direction: Vector3<S>,
    /// In vacuum, over the mass, m/s².
    in_vacuum: S,
    /// What the pressure of the air takes from it, m/s².
    back_pressure: S,
    /// The greatest thrust over the mass under the load limit, m/s², where there is one.
    most: Option<S>,
}

impl<P: Scalar> Burn<P> {
    /// One that stays as it is.
    pub fn constant(direction: ThrustDirection, acceleration: P, mass_flow: P) -> Self {
        let zero = P::zero();
        Self {
            direction,
            since: zero,
            acceleration,
            acceleration_rate: zero,
            mass_flow,
            mass_flow_rate: zero,
            exit_area_over_mass: None,
            load_limit: None,
        }
    }
}

impl<P: Scalar> Forces<P> {
    /// The mass at the start of the phase over the mass, where a thrust acts and the mass is integrated.
    #[inline(always)]
    pub(super) fn mass_ratio<S: Over<P>>(&self, mass: Option<S>) -> Option<S> {
        let mass = mass.filter(|_| self.burn.is_some())?;
        Some(mass.recip() * self.mass)
    }

    /// Whether engines depend on the pressure of the air.
    #[inline(always)]
    pub(super) fn takes_pressure(&self) -> bool {
        self.burn.as_ref().is_some_and(|burn| burn.exit_area_over_mass.is_some())
    }

    /// The thrust over the mass, where there is one, of a vehicle on which the air acts with an acceleration, m/s².
    ///
    /// # Reference
    /// K. D. Hicks, Introduction to Astrodynamic Reentry, 2006, page 58, to which Jameson 2006 points in its last chapter: the thrust
    /// stands beside lift and drag.
    #[inline(always)]
    pub(super) fn push<S: Over<P>>(
        &self,
        time: S,
        state: &State<S>,
        flow: &Flow<S>,
        aerodynamic: &Vector3<S>,
    ) -> Option<Push<S>> {
        let burn = self.burn.as_ref()?;
        match burn.direction {
            ThrustDirection::Axis(axis) => {
                let acceleration = self.mass_ratio(state.mass).unwrap_or_else(S::one) * burn.acceleration;
                let direction = along(axis, &self.models.planet, time, &state.planet_fixed());
                Some(Push { acceleration: direction * acceleration, throttle: S::one() })
            }
            ThrustDirection::Steered => Some(apart(|| self.push_of_engines(burn, time, state, flow, aerodynamic))),
        }
    }

    /// The thrust of engines: as the demand has it, but for what the load limit takes.
    #[inline(always)]
    fn push_of_engines<S: Over<P>>(
        &self,
        burn: &Burn<P>,
        time: S,
        state: &State<S>,
        flow: &Flow<S>,
        aerodynamic: &Vector3<S>,
    ) -> Push<S> {
        let Demand { direction, in_vacuum, back_pressure, most } = self.demand(burn, time, state, flow, aerodynamic);
        match most {
            Some(most) if self.mode.of(Switch::LoadLimit) == 1 => {
                // k = (T_most + p ΣA_e)/Σ(throttle T_v)
                let throttle = (most + back_pressure) * reciprocal_or_one(in_vacuum);
                let throttle = S::select(throttle.less_than(0.0), S::zero(), throttle);
                Push { acceleration: direction * (in_vacuum * throttle - back_pressure), throttle }
            }
            _ => Push { acceleration: direction * (in_vacuum - back_pressure), throttle: S::one() },
        }
    }

    /// What engines would do without a load limit, and what that would leave.
    ///
    /// ```text
    /// |A + T û| = n   at   T = -A·û + √(n² - A² + (A·û)²)
    /// ```
    ///
    /// Where the air alone exceeds the limit, the thrust is that which comes nearest to it.
    fn demand<S: Over<P>>(
        &self,
        burn: &Burn<P>,
        time: S,
        state: &State<S>,
        flow: &Flow<S>,
        aerodynamic: &Vector3<S>,
    ) -> Demand<S> {
        let ratio = self.mass_ratio(state.mass).unwrap_or_else(S::one);
        let elapsed = time + -burn.since;
        let in_vacuum = (elapsed * burn.acceleration_rate + burn.acceleration) * ratio;
        let back_pressure = match burn.exit_area_over_mass {
            // Zero where the atmosphere has no pressure.
            Some(area) => ratio * area * flow.arguments.pressure.unwrap_or_else(S::zero),
            None => S::zero(),
        };
        let direction = self.axis(time, state, &flow.arguments);
        let most = burn.load_limit.map(|limit| {
            let limit = S::zero() + limit;
            let along = aerodynamic.dot(&direction);
            let square = limit * limit - aerodynamic.dot(aerodynamic) + along * along;
            S::select(square.less_than(0.0), S::zero(), square).sqrt() - along
        });
        Demand { direction, in_vacuum, back_pressure, most }
    }

    /// By how much the thrust would exceed what the load limit leaves, over the mass, m/s²; zero where there is no limit.
    pub(super) fn load_excess<S: Over<P>>(&self, time: S, state: &State<S>, flow: &Flow<S>) -> S {
        let Some(burn) = &self.burn else { return S::zero() };
        let aerodynamic = self.aerodynamic::<false, _>(time, flow);
        let Demand { in_vacuum, back_pressure, most, .. } = self.demand(burn, time, state, flow, &aerodynamic);
        most.map_or(S::zero(), |most| in_vacuum - back_pressure - most)
    }

    /// The rate of change of the mass, kg/s, by a thrust that the load limit leaves a share of.
    #[inline(always)]
    pub(super) fn mass_rate<S: Over<P>>(&self, time: S, throttle: S) -> S {
        let Some(burn) = &self.burn else { return S::zero() };
        match burn.direction {
            ThrustDirection::Axis(_) => S::zero() + -burn.mass_flow,
            ThrustDirection::Steered => {
                let elapsed = time + -burn.since;
                -((elapsed * burn.mass_flow_rate + burn.mass_flow) * throttle)
            }
        }
    }

    /// Where the axis of the vehicle points, of length 1; shorter within [`LIFT_FADE_ANGLE`](super::LIFT_FADE_ANGLE) of the vertical, where
    /// an angle of attack fades out as lift does.
    pub(super) fn axis<S: Over<P>>(&self, time: S, state: &State<S>, arguments: &Arguments<S>) -> Vector3<S> {
        let planet = &self.models.planet;
        match &self.models.steering {
            Steering::Vertical => planet.shape.normal(&state.position),
            Steering::Velocity => self.axis_by_velocity(time, state, arguments),
            Steering::Program(Program { axes, pitch, yaw }) => {
                let pitch = arguments.angle(pitch, self.mode.of(Switch::Pitch), self.clock(Switch::Pitch, time));
                let yaw = arguments.angle(yaw, self.mode.of(Switch::Yaw), self.clock(Switch::Yaw, time));
                let ((sin_pitch, cos_pitch), (sin_yaw, cos_yaw)) = (pitch.sin_cos(), yaw.sin_cos());
                let components = Vector3::new(cos_pitch * cos_yaw, cos_pitch * sin_yaw, sin_pitch);
                match axes {
                    ProgramAxes::Inertial(axes) => turned_by(planet, time, axes, &components),
                    ProgramAxes::Local => {
                        let [north, east, up] = local_axes(&state.position);
                        north * components.x + east * components.y + up * components.z
                    }
                }
            }
            Steering::LinearTangent { axes, a, b } => {
                let tangent = time * -*b + *a;
                let cos = (tangent * tangent + 1.0).sqrt().recip();
                turned_by(planet, time, axes, &Vector3::new(cos, S::zero(), tangent * cos))
            }
        }
    }

    /// The axis that the angle of attack leans from the velocity relative to the planet; vertical at rest.
    fn axis_by_velocity<S: Over<P>>(&self, time: S, state: &State<S>, arguments: &Arguments<S>) -> Vector3<S> {
        let Directions { speed, up, ahead, left, cos_gamma, .. } = Directions::of(&state.position, &state.velocity);
        let at_rest = speed.less_than(f64::MIN_POSITIVE);
        let normal = self.models.planet.shape.normal(&state.position);
        let leant = if matches!(self.models.control.angle_of_attack, Command::Constant(0.0)) {
            ahead
        } else {
            let (sin, cos) = self.commanded_angle_of_attack(time, arguments).sin_cos();
            let (sin_bank, cos_bank) = self.sin_cos_bank::<false, _>(time, arguments);
            let side = sin * lift_fade_over_cosine(cos_gamma);
            let (side_up, side_left) = (side * cos_bank, side * sin_bank);
            up * side_up + left * side_left + ahead * (cos - side_up * up.dot(&ahead))
        };
        leant.zip_map(&normal, |leant, normal| S::select(at_rest, normal, leant))
    }
}

impl Forces {
    /// The magnitude of the thrust, N, and the share of the thrust of all engines in vacuum that the load limit leaves, of a vehicle of a
    /// mass, kg.
    pub(crate) fn thrust_and_throttle(&self, time: f64, state: &State<f64>, mass: f64) -> [f64; 2] {
        if self.burn.is_none() {
            return [0.0; 2];
        }
        let flow = self.flow::<false, _>(time, state);
        let aerodynamic = self.aerodynamic::<false, _>(time, &flow);
        let push = self.push(time, state, &flow, &aerodynamic);
        push.map_or([0.0; 2], |push| [push.acceleration.norm() * mass, push.throttle])
    }

    /// The angle of the axis of the vehicle above the plane normal to the radius vector, rad.
    pub(crate) fn pitch(&self, time: f64, state: &State<f64>) -> f64 {
        let flow = self.flow_where_mach_matters(time, state);
        let axis = self.axis(time, state, &flow.arguments);
        atan2(axis.dot(&state.position), axis.cross(&state.position).norm())
    }
}

/// A vector by its components on axes that stay in inertial space; `axes` has those at t = 0 in its columns.
fn turned_by<S: Scalar>(planet: &Planet, time: S, axes: &Rotation3<f64>, components: &Vector3<S>) -> Vector3<S> {
    let at_start = Vector3::from_fn(|row, _| {
        components.x * axes[(row, 0)] + components.y * axes[(row, 1)] + components.z * axes[(row, 2)]
    });
    let (sin, cos) = (time * planet.rotation_rate).sin_cos();
    Vector3::new(cos * at_start.x + sin * at_start.y, cos * at_start.y - sin * at_start.x, at_start.z)
}

/// North, east and away from the planet's centre at a planet-fixed position; on the axis, north is along the zero meridian.
#[inline(always)]
fn local_axes<S: Scalar>(position: &Vector3<S>) -> [Vector3<S>; 3] {
    let [x, y, z] = [position.x, position.y, position.z];
    let equatorial = (x * x + y * y).sqrt();
    let on_axis = equatorial.less_than(f64::MIN_POSITIVE);
    let over_equatorial = reciprocal_or_one(equatorial);
    let over_radius = reciprocal_or_one(length(position));
    let (cos, sin) = (S::select(on_axis, S::one(), x * over_equatorial), y * over_equatorial);
    let (sin_latitude, cos_latitude) = (z * over_radius, equatorial * over_radius);
    let north = Vector3::new(-(sin_latitude * cos), -(sin_latitude * sin), cos_latitude);
    [north, Vector3::new(-sin, cos, S::zero()), position * over_radius]
}

/// The velocity of a state, turned by an angle, rad, from the direction away from the planet's centre towards an azimuth, rad, clockwise from
/// north; of the same length.
pub(crate) fn tilted<S: Scalar>(state: &PlanetFixed<S>, angle: S, azimuth: S) -> Vector3<S> {
    let [north, east, up] = local_axes(&state.position);
    let ((sin, cos), (sin_azimuth, cos_azimuth)) = (angle.sin_cos(), azimuth.sin_cos());
    let ahead = north * cos_azimuth + east * sin_azimuth;
    let (along, upward) = (state.velocity.dot(&ahead), state.velocity.dot(&up));
    // In the plane of `up` and `ahead` it turns, across it stays.
    let change = |new: S, old: S| new - old;
    state.velocity + ahead * change(along * cos + upward * sin, along) + up * change(upward * cos - along * sin, upward)
}

/// A direction in a state at a time, s, of length 1; of length 0 where there is none, and shorter than 1 near the vertical where there is
/// none in vertical flight.
#[inline(always)]
pub(crate) fn along<S: Scalar>(axis: ThrustAxis, planet: &Planet, time: S, state: &PlanetFixed<S>) -> Vector3<S> {
    let Directions { up, ahead, left, cos_gamma, .. } = Directions::of(&state.position, &state.velocity);
    match axis {
        ThrustAxis::Velocity => ahead,
        ThrustAxis::Radial => up,
        ThrustAxis::Normal => left * lift_fade_over_cosine(cos_gamma),
        ThrustAxis::Horizontal => left.cross(&up) * lift_fade_over_cosine(cos_gamma),
        ThrustAxis::Inertial(direction) => turned(&direction, time * planet.rotation_rate),
    }
}

/// A direction in a state at a time, s, of length 1, if there is one.
pub(crate) fn direction(
    axis: ThrustAxis,
    planet: &Planet,
    time: f64,
    state: &PlanetFixed<f64>,
) -> Option<Vector3<f64>> {
    let Directions { up, ahead, left, .. } = Directions::of(&state.position, &state.velocity);
    match axis {
        ThrustAxis::Velocity => ahead,
        ThrustAxis::Radial => up,
        ThrustAxis::Normal => left,
        ThrustAxis::Horizontal => left.cross(&up),
        ThrustAxis::Inertial(direction) => turned(&direction, time * planet.rotation_rate),
    }
    .try_normalize(NO_DIRECTION)
}

/// A part of a unit vector that is a rounding.
const NO_DIRECTION: f64 = 1e-9;
