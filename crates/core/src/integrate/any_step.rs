//! Steps of states of either size.

use super::Step;

/// A step, with or without the heat load.
#[derive(Clone, Debug)]
pub(crate) enum AnyStep {
    /// States of place and motion.
    Unheated(Step<6>),
    /// States with the heat load.
    Heated(Step<7>),
}

impl From<Step<6>> for AnyStep {
    fn from(step: Step<6>) -> Self {
        Self::Unheated(step)
    }
}

impl From<Step<7>> for AnyStep {
    fn from(step: Step<7>) -> Self {
        Self::Heated(step)
    }
}

impl AnyStep {
    /// s.
    pub(crate) fn start_time(&self) -> f64 {
        match self {
            Self::Unheated(step) => step.start_time,
            Self::Heated(step) => step.start_time,
        }
    }

    /// s.
    pub(crate) fn end_time(&self) -> f64 {
        match self {
            Self::Unheated(step) => step.end_time,
            Self::Heated(step) => step.end_time,
        }
    }

    /// The instant at a part of the step, s.
    pub(crate) fn time(&self, part: f64) -> f64 {
        match self {
            Self::Unheated(step) => step.time(part),
            Self::Heated(step) => step.time(part),
        }
    }
}
