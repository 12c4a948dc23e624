//! The Cartesian formulation: planet-fixed position and velocity. It has no singularity but the planet's centre.

use num_dual::DualSVec64;

use super::state::coordinates;
use super::{Forces, Formulation, Singularity, State, StateRate};
use crate::coordinates::PlanetFixed;
use crate::integrate::{LaneBounds, StepBounds, System, jacobian};
use crate::scalar::{Lanes, Over, Scalar};

/// The state (x, y, z, vx, vy, vz), in m and m/s, and maybe heat load and mass.
#[derive(Clone, Debug)]
pub struct Cartesian<P = f64>(pub Forces<P>);

impl<P: Scalar, S: Over<P>> System<S, 6> for Cartesian<P> {
    #[inline(always)]
    fn derivative(&self, time: S, numbers: &[S; 6]) -> [S; 6] {
        let state = PlanetFixed::from(*numbers);
        let acceleration = self.0.acceleration(time, &state.into());
        PlanetFixed { position: state.velocity, velocity: acceleration }.into()
    }
}

/// With the heat load, J/m², and the mass, kg.
impl<P: Scalar, S: Over<P>> System<S, 8> for Cartesian<P> {
    #[inline(always)]
    fn derivative(&self, time: S, numbers: &[S; 8]) -> [S; 8] {
        self.rates(time, numbers)
    }
}

impl<P: Scalar> Cartesian<P> {
    /// The rates of states that hold more than place and motion.
    #[inline(always)]
    fn rates<S: Over<P>, const N: usize>(&self, time: S, numbers: &[S; N]) -> [S; N] {
        let state = State::of(PlanetFixed::from(coordinates(numbers)), numbers);
        let (acceleration, mass_rate, heat_flux) = self.0.acceleration_and_rates(time, &state);
        let rates = PlanetFixed { position: state.velocity, velocity: acceleration };
        let more = State { mass: Some(mass_rate), heat_load: Some(heat_flux), ..state };
        more.numbers(rates.into())
    }
}

impl<const N: usize> StepBounds<N> for Cartesian
where
    Self: System<f64, N> + System<DualSVec64<6>, N>,
{
    fn magnitudes(&self) -> [f64; N] {
        let [length, speed] = self.0.units();
        self.0.magnitudes([length, length, length, speed, speed, speed])
    }

    fn longest_step(&self, time: f64, numbers: &[f64; N]) -> f64 {
        self.0.longest_step(time, &Self::state(numbers))
    }

    fn longest_implicit_step(&self, time: f64, numbers: &[f64; N]) -> f64 {
        self.0.longest_implicit_step(time, &Self::state(numbers))
    }

    fn time_to_corner(&self, time: f64, numbers: &[f64; N], derivative: &[f64; N], least: f64) -> f64 {
        self.0.time_to_corner(&StateRate::of::<Self, N>(time, numbers, derivative), least)
    }

    fn jacobian(&self, time: f64, numbers: &[f64; N]) -> [[f64; N]; N] {
        // Nothing changes fast by heat load and mass.
        jacobian::<_, N, 6>(self, time, numbers)
    }
}

impl<const N: usize, const L: usize> LaneBounds<N, L> for Cartesian<Lanes<L>>
where
    Self: System<Lanes<L>, N>,
{
    #[inline(always)]
    fn longest_step(&self, time: Lanes<L>, numbers: &[Lanes<L>; N]) -> Option<Lanes<L>> {
        // Thrusts may brake one vehicle to rest and another not.
        if self.0.burn.is_some() {
            return None;
        }
        let state = State::of(PlanetFixed::from(coordinates(numbers)), numbers);
        Some(self.0.longest_unbraked_step(time, &state))
    }
}

impl<const N: usize> Formulation<N> for Cartesian
where
    Self: System<f64, N> + System<DualSVec64<6>, N>,
{
    fn numbers<S: Scalar>(state: &State<S>) -> [S; N] {
        state.numbers(state.planet_fixed().into())
    }

    fn state<S: Scalar>(numbers: &[S; N]) -> State<S> {
        State::of(PlanetFixed::from(coordinates(numbers)), numbers)
    }

    fn singularity(&self, _: &[f64; N], _: f64) -> Option<Singularity> {
        None
    }

    fn forces(&self) -> &Forces {
        &self.0
    }

    fn forces_mut(&mut self) -> &mut Forces {
        &mut self.0
    }
}
