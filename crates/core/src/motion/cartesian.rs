//! The Cartesian formulation: planet-fixed position and velocity. It has no singularity but the planet's centre.

use super::{Forces, Formulation, Singularity};
use crate::coordinates::PlanetFixed;
use crate::integrate::{Pace, System};
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

impl Pace<6> for Cartesian {
    fn magnitudes(&self) -> [f64; 6] {
        let [length, speed] = self.0.units();
        [length, length, length, speed, speed, speed]
    }

    fn longest_step(&self, time: f64, coordinates: &[f64; 6]) -> f64 {
        self.0.longest_step(time, &PlanetFixed::from(*coordinates))
    }
}

impl Formulation for Cartesian {
    fn coordinates<S: Scalar>(state: &PlanetFixed<S>) -> [S; 6] {
        (*state).into()
    }

    fn planet_fixed<S: Scalar>(coordinates: &[S; 6]) -> PlanetFixed<S> {
        (*coordinates).into()
    }

    fn singularity(&self, _: &[f64; 6], _: f64) -> Option<Singularity> {
        None
    }

    fn forces(&self) -> &Forces {
        &self.0
    }

    fn forces_mut(&mut self) -> &mut Forces {
        &mut self.0
    }
}
