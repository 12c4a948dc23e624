//! Steps of states of either size.

use super::Step;

/// A step of states of place and motion alone, or with heat load and mass.
#[derive(Clone, Debug)]
pub(crate) enum AnyStep {
    /// Of place and motion.
    Six(Step<6>),
    /// With heat load and mass.
    Eight(Step<8>),
}

impl From<Step<6>> for AnyStep {
    fn from(step: Step<6>) -> Self {
        Self::Six(step)
    }
}

impl From<Step<8>> for AnyStep {
    fn from(step: Step<8>) -> Self {
        Self::Eight(step)
    }
}

impl AnyStep {
    /// s.
    pub(crate) fn start_time(&self) -> f64 {
        match self {
            Self::Six(step) => step.start_time,
            Self::Eight(step) => step.start_time,
        }
    }

    /// s.
    pub(crate) fn end_time(&self) -> f64 {
        match self {
            Self::Six(step) => step.end_time,
            Self::Eight(step) => step.end_time,
        }
    }

    /// Whether it is an implicit step.
    pub(crate) fn is_implicit(&self) -> bool {
        match self {
            Self::Six(step) => step.is_implicit(),
            Self::Eight(step) => step.is_implicit(),
        }
    }

    /// The instant at a part of the step, s.
    pub(crate) fn time(&self, part: f64) -> f64 {
        match self {
            Self::Six(step) => step.time(part),
            Self::Eight(step) => step.time(part),
        }
    }
}
