//! A step of a flight, kept, and the motion inside it.

use crate::coordinates::PlanetFixed;
use crate::integrate::{AnyStep, Interpolant};
use crate::motion::{Cartesian, Forces, Formulation, ModelMode, Spherical, heat_load};

/// A step of a flight, and the phase and the mode of its models during it.
#[derive(Clone, Debug)]
pub(crate) struct StoredStep {
    pub(crate) step: AnyStep,
    pub(crate) phase: usize,
    pub(crate) mode: ModelMode,
}

/// The equations of either formulation.
pub(crate) enum Motion {
    Cartesian(Cartesian),
    Spherical(Spherical),
}

/// The motion inside a step.
pub(crate) enum AnyInterpolant {
    Unheated(Interpolant<6>),
    Heated(Interpolant<7>),
}

impl StoredStep {
    /// s.
    pub(crate) fn start_time(&self) -> f64 {
        self.step.start_time()
    }

    /// s.
    pub(crate) fn end_time(&self) -> f64 {
        self.step.end_time()
    }

    /// The instant at a part of the step, s.
    pub(crate) fn time(&self, part: f64) -> f64 {
        self.step.time(part)
    }
}

impl AnyInterpolant {
    /// The state and the heat load, J/m², at an instant.
    pub(crate) fn at(&self, motion: &Motion, time: f64) -> (PlanetFixed<f64>, Option<f64>) {
        match self {
            Self::Unheated(interpolant) => motion.state(&interpolant.state_at(time)),
            Self::Heated(interpolant) => motion.state(&interpolant.state_at(time)),
        }
    }
}

impl Motion {
    pub(crate) fn forces(&self) -> &Forces {
        match self {
            Self::Cartesian(Cartesian(forces)) | Self::Spherical(Spherical(forces)) => forces,
        }
    }

    pub(crate) fn forces_mut(&mut self) -> &mut Forces {
        match self {
            Self::Cartesian(Cartesian(forces)) | Self::Spherical(Spherical(forces)) => forces,
        }
    }

    pub(crate) fn interpolant(&self, step: &AnyStep) -> AnyInterpolant {
        match (self, step) {
            (Self::Cartesian(motion), AnyStep::Unheated(step)) => AnyInterpolant::Unheated(step.interpolant(motion)),
            (Self::Cartesian(motion), AnyStep::Heated(step)) => AnyInterpolant::Heated(step.interpolant(motion)),
            (Self::Spherical(motion), AnyStep::Unheated(step)) => AnyInterpolant::Unheated(step.interpolant(motion)),
            (Self::Spherical(motion), AnyStep::Heated(step)) => AnyInterpolant::Heated(step.interpolant(motion)),
        }
    }

    /// The state at the end of a step.
    pub(crate) fn end(&self, step: &AnyStep) -> PlanetFixed<f64> {
        match step {
            AnyStep::Unheated(step) => self.state(&step.end).0,
            AnyStep::Heated(step) => self.state(&step.end).0,
        }
    }

    /// The state and the heat load, J/m², of numbers of the formulation.
    fn state<const N: usize>(&self, coordinates: &[f64; N]) -> (PlanetFixed<f64>, Option<f64>)
    where
        Cartesian: Formulation<N>,
        Spherical: Formulation<N>,
    {
        let state = match self {
            Self::Cartesian(_) => Cartesian::planet_fixed(coordinates),
            Self::Spherical(_) => Spherical::planet_fixed(coordinates),
        };
        (state, heat_load(coordinates))
    }
}
