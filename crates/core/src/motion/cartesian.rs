//! The Cartesian formulation: planet-fixed position and velocity. It has no singularity but the planet's centre.

use super::{Forces, Formulation, HEAT_LOAD, Singularity, with_heat_load, without_heat_load};
use crate::coordinates::PlanetFixed;
use crate::integrate::{StepBounds, System};
use crate::scalar::{Over, Scalar};

/// The state (x, y, z, vx, vy, vz), in m and m/s.
#[derive(Clone, Debug)]
pub struct Cartesian<P = f64>(pub Forces<P>);

impl<P: Scalar, S: Over<P>> System<S, 6> for Cartesian<P> {
    #[inline(always)]
    fn derivative(&self, time: S, coordinates: &[S; 6]) -> [S; 6] {
        let state = PlanetFixed::from(*coordinates);
        let acceleration = self.0.acceleration(time, &state);
        PlanetFixed { position: state.velocity, velocity: acceleration }.into()
    }
}

/// With the heat load, J/m², as the seventh number.
impl<P: Scalar, S: Over<P>> System<S, 7> for Cartesian<P> {
    #[inline(always)]
    fn derivative(&self, time: S, [x, y, z, vx, vy, vz, _]: &[S; 7]) -> [S; 7] {
        let state = PlanetFixed::from([*x, *y, *z, *vx, *vy, *vz]);
        let (acceleration, heat_flux) = self.0.acceleration_and_heat_flux(time, &state);
        [*vx, *vy, *vz, acceleration.x, acceleration.y, acceleration.z, heat_flux]
    }
}

impl<const N: usize> StepBounds<N> for Cartesian
where
    Self: System<f64, N>,
{
    fn magnitudes(&self) -> [f64; N] {
        let [length, speed] = self.0.units();
        with_heat_load([length, length, length, speed, speed, speed], HEAT_LOAD)
    }

    fn longest_step(&self, time: f64, coordinates: &[f64; N]) -> f64 {
        self.0.longest_step(time, &without_heat_load(coordinates).into())
    }
}

impl<const N: usize> Formulation<N> for Cartesian
where
    Self: System<f64, N>,
{
    fn coordinates<S: Scalar>(state: &PlanetFixed<S>, heat_load: S) -> [S; N] {
        with_heat_load((*state).into(), heat_load)
    }

    fn planet_fixed<S: Scalar>(coordinates: &[S; N]) -> PlanetFixed<S> {
        without_heat_load(coordinates).into()
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
