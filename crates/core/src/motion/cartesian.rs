//! The Cartesian formulation: planet-fixed position and velocity. It has no singularity but the planet's centre.

use super::{Forces, Formulation, Singularity};
use crate::coordinates::PlanetFixed;
use crate::integrate::System;
use crate::scalar::Scalar;

/// The state (x, y, z, vx, vy, vz), in m and m/s.
#[derive(Clone, Copy, Debug)]
pub struct Cartesian(pub Forces);

impl System<6> for Cartesian {
    #[inline(always)]
    fn derivative<S: Scalar>(&self, coordinates: &[S; 6]) -> [S; 6] {
        let state = PlanetFixed::from(*coordinates);
        let acceleration = self.0.acceleration(&state);
        PlanetFixed { position: state.velocity, velocity: acceleration }.into()
    }

    fn magnitudes(&self) -> [f64; 6] {
        let [length, speed] = self.0.units();
        [length, length, length, speed, speed, speed]
    }

    fn longest_step(&self, coordinates: &[f64; 6], _: &[f64; 6]) -> f64 {
        self.0.longest_step(&PlanetFixed::from(*coordinates))
    }
}

impl Formulation for Cartesian {
    fn coordinates(state: &PlanetFixed<f64>) -> [f64; 6] {
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
}
