//! The quantities that an event may wait for.

use nalgebra::Vector3;
use num_dual::Dual64;

use super::{Forces, Formulation, Loads, State, moving};
use crate::coordinates::GreatCircle;
use crate::event::Quantity;
use crate::planet::Planet;
use crate::scalar::{Over, Scalar, length, reciprocal_or_one};

/// A time and the state then. In dual numbers both move along the flow: what is computed from them comes with its rate of change.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StateRate<S: nalgebra::Scalar = Dual64> {
    /// s.
    pub(crate) time: S,
    pub(crate) state: State<S>,
}

impl<S: Scalar> StateRate<S> {
    /// Of a formulation's numbers.
    pub(crate) fn at<F: Formulation<N>, const N: usize>(time: S, state: &[S; N]) -> Self {
        Self { time, state: F::state(state) }
    }
}

impl StateRate {
    /// Of a formulation's numbers and their rates.
    pub(crate) fn of<F: Formulation<N>, const N: usize>(time: f64, state: &[f64; N], derivative: &[f64; N]) -> Self {
        Self::at::<F, N>(Dual64::new(time, 1.0), &moving(state, derivative))
    }
}

/// The apoapsis altitude, m, from which on an orbit counts as not bound: its apoapsis is then taken to be here, so that conditions on it
/// have a finite number to compare.
const UNBOUND: f64 = 1e13;

impl<P: Scalar> Forces<P> {
    /// A quantity at a moment of a flight that starts at the beginning of `track`; 0 where the models do not have it.
    pub(crate) fn quantity<S: Over<P> + Scalar<Mask = bool>>(
        &self,
        quantity: Quantity,
        at: &StateRate<S>,
        track: &GreatCircle<S>,
    ) -> S {
        self.quantity_with(quantity, at, track, || self.loads(at.time, &at.state))
    }

    /// The same with the loads at the moment, for which it asks where it needs them.
    pub(crate) fn quantity_with<S: Over<P> + Scalar<Mask = bool>>(
        &self,
        quantity: Quantity,
        at: &StateRate<S>,
        track: &GreatCircle<S>,
        loads: impl FnOnce() -> Loads<S>,
    ) -> S {
        let StateRate { time, state } = at;
        let State { position, velocity, mass, heat_load } = state;
        let planet = &self.models.planet;
        match quantity {
            Quantity::Time => *time,
            Quantity::Altitude => planet.shape.altitude(position),
            Quantity::Speed => length(velocity),
            Quantity::FlightPathAngle => position.dot(velocity).atan2(length(&position.cross(velocity))),
            Quantity::Mass => mass.unwrap_or_else(|| S::zero() + self.mass),
            Quantity::InertialSpeed => length(&inertial_velocity(planet, state)),
            Quantity::SpecificEnergy => {
                let velocity = inertial_velocity(planet, state);
                velocity.dot(&velocity) * 0.5 + planet.potential(position)
            }
            Quantity::ApoapsisAltitude => apsides(planet, state)[0],
            Quantity::PeriapsisAltitude => apsides(planet, state)[1],
            Quantity::Eccentricity => eccentricity(planet, &state.position, &inertial_velocity(planet, state)),
            Quantity::Inclination => {
                let momentum = position.cross(&inertial_velocity(planet, state));
                let level = (momentum.x * momentum.x + momentum.y * momentum.y).sqrt();
                level.atan2(momentum.z)
            }
            Quantity::UpwardAcceleration => self.upward_acceleration(*time, state),
            Quantity::HeatLoad => heat_load.unwrap_or_else(S::zero),
            Quantity::Downrange => {
                track.along_and_across(position).map_or(S::zero(), |[along, _]| along * planet.equatorial_radius())
            }
            Quantity::GroundRange => track.angle_to(position) * planet.equatorial_radius(),
            Quantity::Mach
            | Quantity::DynamicPressure
            | Quantity::LoadFactor
            | Quantity::AirSpeed
            | Quantity::HeatFlux
            | Quantity::WallTemperature
            | Quantity::Deceleration
            | Quantity::Density => loads().quantity(quantity, self.models.heating.as_ref()).unwrap_or_else(S::zero),
        }
    }
}

/// Relative to inertial space, in components of the planet-fixed frame, m/s.
#[inline(always)]
pub(super) fn inertial_velocity<S: Scalar>(planet: &Planet, state: &State<S>) -> Vector3<S> {
    let State { position, velocity, .. } = state;
    let rate = planet.rotation_rate;
    Vector3::new(velocity.x - position.y * rate, velocity.y + position.x * rate, velocity.z)
}

/// The eccentricity of the osculating orbit, of inertial position, m, and velocity, m/s.
///
/// ```text
/// e = |v × h / μ - r̂|
/// ```
///
/// # Reference
/// D. A. Vallado, Fundamentals of Astrodynamics and Applications, 4th ed., 2013, section 2.4.
fn eccentricity<S: Scalar>(planet: &Planet, position: &Vector3<S>, velocity: &Vector3<S>) -> S {
    let over_parameter = planet.orbital_gravitational_parameter.recip();
    let over_radius = reciprocal_or_one(length(position));
    let pull = velocity.cross(&position.cross(velocity));
    length(&Vector3::from_fn(|i, _| pull[i] * over_parameter - position[i] * over_radius))
}

/// The altitudes of apoapsis and periapsis of the osculating orbit above the equatorial radius, m.
///
/// ```text
/// r_a = μ (1 + e) / (-2E),   r_p = h² / (μ (1 + e))
/// ```
///
/// # Reference
/// D. A. Vallado, Fundamentals of Astrodynamics and Applications, 4th ed., 2013, section 2.4.
fn apsides<S: Scalar<Mask = bool>>(planet: &Planet, state: &State<S>) -> [S; 2] {
    let position = &state.position;
    let velocity = inertial_velocity(planet, state);
    let over_parameter = planet.orbital_gravitational_parameter.recip();
    let over_radius = reciprocal_or_one(length(position));
    let momentum = position.cross(&velocity);
    let one_and_eccentricity = eccentricity(planet, position, &velocity) + 1.0;
    // -2E/μ, one over the semi-major axis; not positive where the orbit is not bound.
    let over_semi_major_axis = over_radius * 2.0 - velocity.dot(&velocity) * over_parameter;
    let over_apoapsis = over_semi_major_axis * one_and_eccentricity.recip();
    let unbound = over_apoapsis.less_than(UNBOUND.recip());
    let apoapsis = S::select(unbound, S::from(UNBOUND), S::select(unbound, S::one(), over_apoapsis).recip());
    let periapsis = momentum.dot(&momentum) * over_parameter * one_and_eccentricity.recip();
    [apoapsis, periapsis].map(|distance| distance - planet.equatorial_radius())
}
