//! A step of a flight, kept, and the motion inside it.

use crate::integrate::{AnyStep, Interpolant};
use crate::motion::{Cartesian, Forces, Formulation, ModelMode, Spherical, State};

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
    Six(Interpolant<6>),
    Eight(Interpolant<8>),
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
    /// The state at an instant.
    pub(crate) fn at(&self, motion: &Motion, time: f64) -> State<f64> {
        match self {
            Self::Six(interpolant) => motion.state(&interpolant.state_at(time)),
            Self::Eight(interpolant) => motion.state(&interpolant.state_at(time)),
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
            (Self::Cartesian(motion), AnyStep::Six(step)) => AnyInterpolant::Six(step.interpolant(motion)),
            (Self::Cartesian(motion), AnyStep::Eight(step)) => AnyInterpolant::Eight(step.interpolant(motion)),
            (Self::Spherical(motion), AnyStep::Six(step)) => AnyInterpolant::Six(step.interpolant(motion)),
            (Self::Spherical(motion), AnyStep::Eight(step)) => AnyInterpolant::Eight(step.interpolant(motion)),
        }
    }

    /// The state at the end of a step.
    pub(crate) fn end(&self, step: &AnyStep) -> State<f64> {
        match step {
            AnyStep::Six(step) => self.state(&step.end),
            AnyStep::Eight(step) => self.state(&step.end),
        }
    }

    /// The state of numbers of the formulation.
    fn state<const N: usize>(&self, numbers: &[f64; N]) -> State<f64>
    where
        Cartesian: Formulation<N>,
        Spherical: Formulation<N>,
    {
        match self {
            Self::Cartesian(_) => Cartesian::state(numbers),
            Self::Spherical(_) => Spherical::state(numbers),
        }
    }
}
