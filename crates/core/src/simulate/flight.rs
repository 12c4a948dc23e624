//! A flight on its way: what its steps mean.

use std::sync::atomic::AtomicBool;

use super::SimulationError;
use super::descent::Descent;
use super::passage::Passage;
use crate::integrate::{IntegrationError, Integrator, Limits, Step};
use crate::motion::Formulation;
use crate::scenario::Scenario;
use crate::trajectory::{Arrival, Termination};

/// A flight between its start and its end.
pub(super) struct Flight<'a, F> {
    scenario: &'a Scenario,
    motion: &'a F,
    pub(super) integrator: Integrator<'a, F, 6>,
    descent: Descent,
    time: f64,
    state: [f64; 6],
    looks: usize,
}

impl<'a, F: Formulation> Flight<'a, F> {
    pub(super) fn start(
        scenario: &'a Scenario,
        motion: &'a F,
        interrupt: &'a AtomicBool,
    ) -> Result<Self, SimulationError> {
        let case = scenario.case();
        let limits =
            Limits { relative_tolerance: case.solver.relative_tolerance, steps: case.solver.step_limit, interrupt };
        let state = F::coordinates(&case.initial_state);
        regular(motion, 0.0, &state)?;
        let integrator = Integrator::new(motion, state, limits);
        let mut descent = Descent::new(motion, case.stop.altitude, &state, integrator.derivative());
        if scenario.rises_from_stop_altitude() {
            descent.start_upward();
        }
        Ok(Self { scenario, motion, integrator, descent, time: 0.0, state, looks: 0 })
    }

    /// The end of a flight that is over before its first step: it starts on the stop altitude, and not upward.
    pub(super) fn at_start(&self) -> Arrival {
        self.arrival(Termination::SurfaceImpact)
    }

    /// Looks at a step, which it cuts at the stop altitude; returns the end of the flight, if that was it.
    pub(super) fn pass(
        &mut self,
        mut step: Step<6>,
        observe: &mut impl FnMut(&Passage<F>) -> Result<(), SimulationError>,
    ) -> Result<Option<Arrival>, SimulationError> {
        let mut termination = (step.end_time >= self.scenario.case().stop.time).then_some(Termination::TimeLimit);
        let mut passage = Passage::new(self.motion, &step);
        if let Some(crossing) = self.descent.impact(&passage) {
            self.looks += passage.evaluations();
            step = self.descent.land(&mut self.integrator, &step, crossing);
            passage = Passage::new(self.motion, &step);
            termination = Some(Termination::SurfaceImpact);
        }
        (self.time, self.state) = (passage.step.end_time, passage.step.end);
        regular(self.motion, self.time, &self.state)?;
        observe(&passage)?;
        self.looks += passage.evaluations();
        Ok(termination.map(|termination| self.arrival(termination)))
    }

    /// What an integration error means for the flight: near a singularity, that is the reason.
    pub(super) fn failure(&self, error: IntegrationError) -> SimulationError {
        let (time, otherwise) = match error {
            IntegrationError::StepLimit { time, limit } => (time, SimulationError::StepLimit { time, limit }),
            IntegrationError::StepTooSmall { time } => (time, SimulationError::TooStiff { time }),
            IntegrationError::Interrupted { time } => return SimulationError::Interrupted { time },
        };
        match self.motion.singularity(&self.state, NEARLY_SINGULAR) {
            Some(at) => SimulationError::Singularity { time, at },
            None => otherwise,
        }
    }

    fn arrival(&self, termination: Termination) -> Arrival {
        let mut statistics = self.integrator.statistics();
        statistics.evaluations += self.looks;
        Arrival { termination, time: self.time, state: F::planet_fixed(&self.state), statistics }
    }
}

/// Refuses a state in which the equations break down.
pub(super) fn regular<F: Formulation>(motion: &F, time: f64, state: &[f64; 6]) -> Result<(), SimulationError> {
    match motion.singularity(state, SINGULAR) {
        Some(at) => Err(SimulationError::Singularity { time, at }),
        None => Ok(()),
    }
}

/// Closer to a singularity than this (rad, or parts of the circular speed) rounding costs more digits than the tolerances allow.
const SINGULAR: f64 = 1e-8;
/// An integration that fails this close to a singularity fails because of it.
const NEARLY_SINGULAR: f64 = 1e-2;
