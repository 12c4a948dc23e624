//! A flight on its way: what its steps mean.

use std::sync::atomic::AtomicBool;

use super::SimulationError;
use super::descent::{Descent, land};
use super::passage::{Moment, Passage};
use super::watch::{Exit, Watch, next_corner};
use crate::integrate::{IntegrationError, Integrator, Limits, Step};
use crate::motion::{Chatter, Formulation};
use crate::scenario::Scenario;
use crate::trajectory::{Arrival, Termination};

/// A flight between its start and its end.
pub(super) struct Flight<'a, F> {
    pub(super) scenario: &'a Scenario,
    pub(super) motion: F,
    pub(super) integrator: Integrator<'a, 6>,
    descent: Descent,
    watch: Watch,
    time: f64,
    state: [f64; 6],
    looks: usize,
}

impl<'a, F: Formulation> Flight<'a, F> {
    pub(super) fn start(
        scenario: &'a Scenario,
        mut motion: F,
        interrupt: &'a AtomicBool,
    ) -> Result<Self, SimulationError> {
        let case = scenario.case();
        let limits =
            Limits { relative_tolerance: case.solver.relative_tolerance, steps: case.solver.step_limit, interrupt };
        let state = F::coordinates(&case.initial_state);
        regular(&motion, 0.0, &state)?;
        settle(&mut motion, 0.0, &state)?;
        let integrator = Integrator::new(&motion, state, limits);
        let start = Moment::of::<F>(0.0, &state, integrator.derivative());
        let mut descent = Descent::new(case.planet.shape, case.stop.altitude, &start);
        if scenario.rises_from_stop_altitude() {
            descent.start_upward();
        }
        let watch = Watch::new(motion.forces(), &start);
        Ok(Self { scenario, motion, integrator, descent, watch, time: 0.0, state, looks: 0 })
    }

    /// The end of a flight that is over before its first step: it starts on the stop altitude, and not upward.
    pub(super) fn at_start(&self) -> Arrival {
        self.arrival(Termination::SurfaceImpact)
    }

    /// When the next step must end at the latest, s: with the time of the flight, or with a stretch of a schedule.
    pub(super) fn horizon(&self) -> f64 {
        let end = self.scenario.case().stop.time;
        if self.motion.forces().has_switches() { end.min(next_corner(self.motion.forces())) } else { end }
    }

    /// Takes a step.
    pub(super) fn advance(&mut self) -> Result<Step<6>, SimulationError> {
        let horizon = self.horizon();
        self.integrator.advance(&self.motion, horizon).map_err(|error| self.failure(error))
    }

    /// Looks at a step, which it cuts at the stop altitude and where the formulas of the models change; returns the end of the flight,
    /// if that was it.
    pub(super) fn pass(
        &mut self,
        mut step: Step<6>,
        observe: &mut impl FnMut(&Passage<F>) -> Result<(), SimulationError>,
    ) -> Result<Option<Arrival>, SimulationError> {
        let Self { motion, integrator, descent, watch, .. } = self;
        let mut termination = (step.end_time >= self.scenario.case().stop.time).then_some(Termination::TimeLimit);
        let mut turns = step.end_time >= next_corner(motion.forces());
        let mut passage = Passage::new(motion, &step);
        let impact = descent.impact(&passage);
        let exit = watch.exit(&passage).filter(|exit| impact.is_none_or(|impact| exit.part < impact));
        if let Some(part) = exit.map(|exit| exit.part).or(impact) {
            self.looks += passage.evaluations();
            let time = step.time(part);
            step = land(integrator, motion, &step, time, |moment| match &exit {
                Some(exit) => exit.inside(motion.forces(), moment),
                None => descent.height(moment),
            });
            passage = Passage::new(motion, &step);
            termination = exit.is_none().then_some(Termination::SurfaceImpact);
            turns = exit.is_some();
        }
        descent.follow(&passage);
        watch.follow(&passage);
        (self.time, self.state) = (passage.step.end_time, passage.step.end);
        regular(motion, self.time, &self.state)?;
        observe(&passage)?;
        self.looks += passage.evaluations();
        match termination {
            // The last instant belongs to what would follow; where nothing could, it belongs to what was.
            Some(_) => settle(&mut self.motion, self.time, &self.state).unwrap_or(()),
            None if turns => self.turn(&step, exit)?,
            None => {}
        }
        Ok(termination.map(|termination| self.arrival(termination)))
    }

    /// Goes on from the end of a step in the regime that begins there.
    fn turn(&mut self, step: &Step<6>, exit: Option<Exit>) -> Result<(), SimulationError> {
        settle(&mut self.motion, step.end_time, &step.end)?;
        self.integrator.restart(&self.motion, step);
        let start = Moment::of::<F>(step.end_time, &step.end, self.integrator.derivative());
        let watch = Watch::new(self.motion.forces(), &start);
        let before = std::mem::replace(&mut self.watch, watch);
        match exit.filter(|exit| exit.is_undone(&before, &watch, self.motion.forces())) {
            Some(Exit { switch, .. }) => Err(SimulationError::Chatter { time: step.end_time, switch }),
            None => Ok(()),
        }
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

/// Enters the regime of a state.
fn settle<F: Formulation>(motion: &mut F, time: f64, state: &[f64; 6]) -> Result<(), SimulationError> {
    let state = F::planet_fixed(state);
    motion.forces_mut().settle(time, &state).map_err(|Chatter(switch)| SimulationError::Chatter { time, switch })
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
