//! The Cartesian formulation: planet-fixed position and velocity. It has no singularity but the planet's centre.

use super::state::coordinates;
use super::{Forces, Formulation, Singularity, State};
use crate::coordinates::PlanetFixed;
use crate::integrate::{StepBounds, System};
use crate::scalar::{Over, Scalar};

/// The state (x, y, z, vx, vy, vz), in m and m/s, and maybe mass and heat load.
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

/// With the mass, kg, and the heat load, J/m².
impl<P: Scalar, S: Over<P>> System<S, 8> for Cartesian<P> {
    #[inline(always)]
    fn derivative(&self, time: S, numbers: &[S; 8]) -> [S; 8] {
        let state = State::of(PlanetFixed::from(coordinates(numbers)), numbers);
        let (acceleration, heat_flux) = self.0.acceleration_and_heat_flux(time, &state);
        let (velocity, mass_rate) = (state.velocity, self.0.mass_rate());
        let [vx, vy, vz] = velocity.into();
        [vx, vy, vz, acceleration.x, acceleration.y, acceleration.z, mass_rate, heat_flux]
    }
}

impl<const N: usize> StepBounds<N> for Cartesian
where
    Self: System<f64, N>,
{
    fn magnitudes(&self) -> [f64; N] {
        let [length, speed] = self.0.units();
        self.0.magnitudes([length, length, length, speed, speed, speed])
    }

    fn longest_step(&self, time: f64, numbers: &[f64; N]) -> f64 {
        self.0.longest_step(time, &Self::state(numbers))
    }
}

impl<const N: usize> Formulation<N> for Cartesian
where
    Self: System<f64, N>,
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
