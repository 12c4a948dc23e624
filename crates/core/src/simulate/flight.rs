//! A flight: it takes steps, cuts them where a detector locates a place, and does what happens there.

use std::array::from_fn;

use nalgebra::Vector3;

use super::conditions::{Cause, ConditionDetector, moments_up_to};
use super::detector::{Detector, cut_at_first};
use super::model_boundaries::{BoundaryCrossing, ModelBoundaryDetector, next_boundary_in_time};
use super::step_view::StepView;
use super::stop_altitude::StopAltitudeDetector;
use super::{Observe, QuietStep, Recorder, SimulationError};
use crate::event::{Effect, Separation, ThrustCommand, Tilt};
use crate::integrate::event::PredictedCrossing;
use crate::integrate::{IntegrationError, Integrator, Limits, Step};
use crate::interrupt::Interrupt;
use crate::motion::{self, Chatter, EndReadings, Formulation, MASS, ModelMode, Singularity, State, StateRate};
use crate::propulsion::{Impulse, ThrustAxis};
use crate::scenario::{Change, Phase, Scenario};
use crate::trajectory::{Arrival, EventRecord, Instant, SeparationRecord, Termination, Warning};

/// A flight between its start and its end.
pub(super) struct Flight<'a, F, const N: usize> {
    pub(super) scenario: &'a Scenario,
    pub(super) motion: F,
    pub(super) integrator: Integrator<'a, N>,
    stop_altitude: StopAltitudeDetector,
    model_boundaries: ModelBoundaryDetector,
    conditions: ConditionDetector,
    phase: Phase,
    time: f64,
    state: [f64; N],
    /// When the next step must end at the latest, s.
    horizon: f64,
    /// The rates of change of the state, where they were computed after the last step: a restart needs them once more.
    rates: Option<[f64; N]>,
    /// Of the motion, to look inside steps and ahead of them.
    evaluations: usize,
    pub(super) log: FlightLog,
}

/// The record of a flight: its phases, events and warnings.
#[derive(Default)]
pub(super) struct FlightLog {
    /// The phases after the first.
    pub(super) phases: Vec<Phase>,
    pub(super) event_records: Vec<EventRecord>,
    /// What left the vehicle.
    pub(super) separations: Vec<SeparationRecord>,
    pub(super) warnings: Vec<Warning>,
}

impl<'a, F: Formulation<N>, const N: usize> Flight<'a, F, N> {
    pub(super) fn start(
        scenario: &'a Scenario,
        mut motion: F,
        interrupt: &'a dyn Interrupt,
    ) -> Result<Self, SimulationError> {
        let case = scenario.case();
        let limits =
            Limits { relative_tolerance: case.solver.relative_tolerance, steps: case.solver.step_limit, interrupt };
        let time = case.start_time;
        let start = State::from(case.initial_state);
        let phase = Phase::first(case);
        weighs(&phase, time)?;
        let state = F::numbers(&State { mass: Some(phase.vehicle.mass), heat_load: Some(0.0), ..start });
        regular(&motion, time, &state)?;
        enter_mode_of(&mut motion, time, &state)?;
        let integrator = Integrator::new(&motion, time, state, limits);
        let start = StateRate::of::<F, N>(time, &state, integrator.derivative());
        let stop_altitude = StopAltitudeDetector::new(case.planet.shape, case.stop.altitude, &start);
        let model_boundaries = ModelBoundaryDetector::new(motion.forces(), &start);
        let conditions = ConditionDetector::new(case, motion.forces(), &start);
        let log = FlightLog::default();
        Ok(Self {
            scenario,
            motion,
            integrator,
            stop_altitude,
            model_boundaries,
            conditions,
            phase,
            time,
            state,
            horizon: f64::INFINITY,
            rates: None,
            evaluations: 0,
            log,
        })
    }

    /// What happens at the start; returns the end of the flight, if that was it.
    pub(super) fn begin(&mut self) -> Result<Option<Arrival>, SimulationError> {
        let end = self.change_at_start()?;
        self.horizon = self.next_instant();
        Ok(end)
    }

    fn change_at_start(&mut self) -> Result<Option<Arrival>, SimulationError> {
        let is_on_ground = self.scenario.starts_on_stop_altitude() && !self.phase.held;
        // The time of a body may be over before it is set free.
        let ending = self.time_limit();
        if !self.conditions.is_empty() {
            return self.apply_changes(None, ending, is_on_ground);
        }
        let ending = ending.or_else(|| (is_on_ground && !self.lifts_off()).then(|| self.ground()));
        Ok(ending.map(|ending| self.arrival(ending)))
    }

    /// Whether a flight that starts on the stop altitude, and on which all has happened that happens at t = 0, leaves it upward.
    fn lifts_off(&mut self) -> bool {
        let altitude = |length| self.stop_altitude.height_at(&later(&self.motion, self.time, &self.state, length)).re;
        let start = altitude(0.0);
        let mut changes = moments_up_to(self.foresight()).map(|(length, _)| altitude(length) - start);
        let lifts_off = changes.find(|change| change.abs() > MOVES).is_some_and(|change| change > 0.0);
        if lifts_off {
            self.stop_altitude.start_upward();
        }
        lifts_off
    }

    /// The end of the flight by its time, if that is over.
    fn time_limit(&self) -> Option<Termination> {
        (self.time >= self.scenario.case().stop.time).then_some(Termination::TimeLimit)
    }

    /// How a flight ends on the stop altitude.
    fn ground(&self) -> Termination {
        if self.scenario.case().stop.altitude == 0.0 { Termination::SurfaceImpact } else { Termination::StopAltitude }
    }

    /// When the next step must end at the latest, s.
    pub(super) fn horizon(&self) -> f64 {
        self.horizon
    }

    /// The next instant that is known ahead, s: with the time of the flight, with a segment of a schedule, where a condition on the time is met,
    /// where the propellant is spent, or where a canopy begins to fill or is full.
    fn next_instant(&self) -> f64 {
        let mut end = self.scenario.case().stop.time;
        end = end.min(next_boundary_in_time(self.motion.forces()));
        if !self.conditions.is_empty() {
            end = end.min(self.conditions.next_time());
        }
        if self.phase.is_still() {
            return end;
        }
        let next = self.phase.next_change().map(|(time, _)| time);
        [next, self.phase.last_instant()].into_iter().flatten().fold(end, f64::min)
    }

    /// Takes a step.
    pub(super) fn advance(&mut self) -> Result<Step<N>, SimulationError> {
        self.integrator.advance(&self.motion, self.horizon).map_err(|error| self.failure(error))
    }

    /// Cuts a step at the first place that a detector locates in it, shows what is left to `observe`, and applies the changes at its end;
    /// returns the end of the flight, if that was it. `read`: what was read at its end already.
    pub(super) fn pass(
        &mut self,
        step: &Step<N>,
        read: Option<&EndReadings>,
        observe: &mut Observe<F, N>,
    ) -> Result<Option<Arrival>, SimulationError> {
        let Self { motion, integrator, stop_altitude, model_boundaries, conditions, evaluations, log, .. } = self;
        let mut view = StepView::new(motion, step, log.phases.len());
        if let Some(read) = read {
            view.note(read);
        }
        // Each detector sees what the ones before have left of the step, so that the last that cuts has the first place. The stop altitude
        // comes first: the boundary of a table that ends there lies beyond it by a rounding error.
        let at_stop_altitude = cut_at_first(&mut view, stop_altitude, integrator, evaluations);
        let at_boundary = cut_at_first(&mut view, model_boundaries, integrator, evaluations);
        let at_condition = cut_at_first(&mut view, conditions, integrator, evaluations);
        stop_altitude.follow(&view);
        model_boundaries.follow(&view);
        conditions.follow(&view);
        (self.time, self.state) = (view.step.end_time, view.step.end);
        if self.state.get(MASS).is_some_and(|mass| *mass <= NOTHING * self.phase.vehicle.mass) {
            return Err(SimulationError::NothingLeft { time: self.time });
        }
        let halted = halts(motion, self.time, &self.state);
        if !halted {
            regular(motion, self.time, &self.state)?;
        }
        observe(&view)?;
        *evaluations += view.evaluations();
        let is_cut = view.is_cut();
        if halted {
            self.halt();
        }

        let mut ending = self.time_limit();
        let mut crossing = None;
        match (at_condition, at_boundary, at_stop_altitude) {
            (Some(condition), ..) => self.conditions.meet(condition),
            (None, Some(boundary), _) => crossing = Some(boundary),
            (None, None, Some(())) => ending = Some(self.ground()),
            (None, None, None) => {}
        }
        let may_change = is_cut || halted || self.conditions.is_due() || self.time >= self.horizon;
        let mut end = None;
        if may_change {
            end = self.apply_changes(crossing, ending, false)?;
            self.horizon = self.next_instant();
        }
        if end.is_none() {
            self.look_ahead();
        }
        Ok(end)
    }

    /// Passes over a step in which nothing happens that a detector or the recorder would have to look for inside it, as its ends tell: what
    /// [`pass`](Self::pass) does then, without the step. Returns whether it is one; otherwise nothing is done. The integrator is at its end, where so
    /// much was `read`.
    pub(super) fn pass_quietly(&mut self, read: &EndReadings, recorder: &mut Recorder) -> bool {
        let Self { motion, integrator, stop_altitude, model_boundaries, conditions, log, .. } = self;
        let (forces, time, state) = (motion.forces(), integrator.time(), integrator.state());
        let length = time - self.time;
        let is_regular = motion.singularity(state, SINGULAR).is_none() && !forces.thrusts_by_velocity();
        let is_left = state.get(MASS).is_none_or(|mass| *mass > NOTHING * self.phase.vehicle.mass);
        if time >= self.horizon
            || !is_regular
            || !is_left
            || !stop_altitude.is_quiet(read.altitude, length)
            || !read.switches.is_none_or(|ends| model_boundaries.is_quiet(forces, &ends, length))
        {
            return false;
        }
        let conditions_read = (!conditions.is_empty()).then(|| {
            let now = StateRate::of::<F, N>(time, state, integrator.derivative());
            let loads = || read.loads.map_or_else(|| forces.loads(now.time, &now.state), |(loads, _)| loads);
            conditions.read_with(forces, &now, loads)
        });
        if conditions_read.as_ref().is_some_and(|ends| !conditions.is_quiet(forces, ends, length)) {
            return false;
        }
        let step = QuietStep { forces, phase: log.phases.len(), start_time: self.time, end_time: time, read };
        if !recorder.observe_quietly(&step) {
            return false;
        }
        stop_altitude.go_on(read.altitude, length);
        if let Some(ends) = &read.switches {
            model_boundaries.go_on(ends, length);
        }
        if let Some(ends) = &conditions_read {
            conditions.go_on(ends, length, false);
        }
        (self.time, self.state) = (time, *state);
        self.look_ahead();
        true
    }

    /// Applies the changes at the end of a step: events, burnout, inflations and the mode of the models; the integration restarts there.
    /// Returns the end of the flight, if that was it. `is_on_ground`: the flight starts on the stop altitude, which it may leave upward.
    fn apply_changes(
        &mut self,
        crossing: Option<BoundaryCrossing>,
        mut ending: Option<Termination>,
        is_on_ground: bool,
    ) -> Result<Option<Arrival>, SimulationError> {
        let entered = enter_mode_of(&mut self.motion, self.time, &self.state);
        // The last instant belongs to what would follow; where nothing could, it belongs to what was.
        if ending.is_none() {
            entered?;
        }
        self.change_by_time()?;
        let happened = self.log.event_records.len();
        let stays_on_ground = !self.conditions.is_empty() && !self.let_events_happen(is_on_ground)?;
        if stays_on_ground {
            ending = Some(self.ground());
        }
        let eventless = self.log.event_records.len() == happened;
        if let Some(ending) = ending.or_else(|| self.conditions.end()) {
            return Ok(Some(self.arrival(ending)));
        }
        if halts(&self.motion, self.time, &self.state) {
            return Err(self.no_direction(self.time));
        }
        match self.rates.take().filter(|_| eventless) {
            Some(rates) => self.integrator.restart_with(&self.motion, self.time, self.state, rates),
            None => self.integrator.restart(&self.motion, self.time, self.state),
        }
        let start = StateRate::of::<F, N>(self.time, &self.state, self.integrator.derivative());
        let boundaries = ModelBoundaryDetector::new(self.motion.forces(), &start);
        let before = self.model_boundaries;
        self.model_boundaries = if eventless { boundaries.going_on(&before) } else { boundaries };
        if !eventless {
            self.conditions.forget();
            self.stop_altitude.forget();
        }
        match crossing.filter(|crossing| eventless && crossing.is_undone(&before, &boundaries, self.motion.forces())) {
            Some(BoundaryCrossing { switch, .. }) => Err(SimulationError::Chatter { time: self.time, switch }),
            None => Ok(None),
        }
    }

    /// Ends the next step a little beyond the first place at which a detector expects to cut it: the rest of the step would be flown for nothing,
    /// formulas are not followed far beyond their segments, and so near the end of a step the dense output is as exact as the step.
    fn look_ahead(&mut self) {
        let Self { motion, integrator, stop_altitude, model_boundaries, conditions, .. } = self;
        let (forces, length) = (motion.forces(), integrator.proposed_length());
        let predicted = [
            stop_altitude.predict(forces, length),
            model_boundaries.predict(forces, length),
            conditions.predict(forces, length),
        ];
        if let Some(PredictedCrossing { time, uncertainty }) = PredictedCrossing::first(predicted.into_iter().flatten())
        {
            let way = time + AIM_BEYOND * time + 0.5 * uncertainty.min(GREATEST_UNCERTAINTY * time);
            integrator.aim_at(integrator.time() + way.max(LEAST_WAY * length));
        }
    }

    /// Lets all happen that is met at the present instant; returns whether the flight leaves the stop altitude, if it `is_on_ground`.
    fn let_events_happen(&mut self, is_on_ground: bool) -> Result<bool, SimulationError> {
        let was_held = self.phase.held;
        self.detect_jumps();
        loop {
            while let Some(cause) = self.conditions.next_event(self.time) {
                match cause {
                    Cause::Event(event) => self.happen(event)?,
                    Cause::Burnout(part) => self.change(Change::Burnout(part))?,
                }
                self.change_by_time()?;
                self.detect_jumps();
            }
            // What is set free without a thrust that lifts it is on the ground as well.
            let is_free = was_held && !self.phase.held && self.scenario.starts_on_stop_altitude();
            if (is_on_ground || is_free) && !self.lifts_off() {
                return Ok(false);
            }
            // What else moves on from its value is known when all that changes the motion has happened.
            if !self.detect_departures() {
                return Ok(true);
            }
        }
    }

    /// Goes the rest of the way to rest, so that a condition on the speed 0 is met.
    fn halt(&mut self) {
        self.state = F::numbers(&State { velocity: Vector3::zeros(), ..F::state(&self.state) });
    }

    /// The thrust that is on has no direction.
    fn no_direction(&self, time: f64) -> SimulationError {
        let switches_on =
            |event: &usize| matches!(self.scenario.case().events[*event].then.thrust, Some(ThrustCommand::On(_)));
        let event = self.log.event_records.iter().rev().map(|record| record.event).find(switches_on).unwrap_or(0);
        let altitude = self.scenario.case().planet.shape.altitude(&F::state(&self.state).position);
        SimulationError::NoDirection { event, time, altitude }
    }

    /// Ends the thrust if its propellant is spent, and lets canopies begin to fill, or be full.
    fn change_by_time(&mut self) -> Result<(), SimulationError> {
        while let Some((_, change)) = self.phase.next_change().filter(|(time, _)| self.time >= *time) {
            if change == Change::ThrustEnds {
                self.log.warnings.push(Warning::PropellantSpent { time: self.time });
            }
            self.change(change)?;
        }
        Ok(())
    }

    /// Goes on after a change that no event makes.
    fn change(&mut self, change: Change) -> Result<(), SimulationError> {
        let next = self.phase.after_change(change, self.scenario.case(), self.time, self.mass());
        if let Change::Burnout(part) = next.cause {
            self.conditions.happened(Cause::Burnout(part), self.time);
        }
        self.enter(next)
    }

    /// Finds the conditions that are met at the present instant.
    fn detect_jumps(&mut self) {
        let derivative = self.motion.derivative(self.time, &self.state);
        self.evaluations += 1;
        let now = StateRate::of::<F, N>(self.time, &self.state, &derivative);
        self.conditions.detect_jumps(self.motion.forces(), &now);
        self.rates = Some(derivative);
    }

    /// Finds the conditions that are met at the present instant by a quantity that is on the value and moves on.
    fn detect_departures(&mut self) -> bool {
        let foresight = self.foresight();
        let Self { conditions, motion, time, state, .. } = self;
        conditions.detect_departures(motion.forces(), |length| later(motion, *time, state, length), foresight)
    }

    /// The time over which the motion is followed ahead, s, where the rates at an instant do not decide whether a quantity rises or falls.
    fn foresight(&self) -> f64 {
        let planet = &self.scenario.case().planet;
        let radius = F::state(&self.state).position.norm();
        let dynamical = (radius.powi(3) / planet.gravitational_parameter).sqrt();
        (FORESIGHT * dynamical).min(self.motion.longest_step(self.time, &self.state))
    }

    /// Lets an event happen.
    fn happen(&mut self, event: usize) -> Result<(), SimulationError> {
        let effect = &self.scenario.case().events[event].then;
        let before = self.instant();
        self.warn_of(event, effect);
        for (place, separation) in effect.separate.iter().enumerate() {
            self.separate(event, place, separation);
        }
        if let Some(Tilt { angle, azimuth }) = effect.tilt {
            let state = F::state(&self.state).planet_fixed();
            self.set_velocity(motion::tilted(&state, angle, azimuth));
        }
        if let Some(impulse) = effect.impulse {
            if self.phase.held && !effect.lift_off {
                self.log.warnings.push(Warning::NoDirection { event, time: self.time });
            } else {
                self.apply_impulse(event, impulse);
            }
        }
        if effect.lift_off && self.phase.held {
            self.stop_altitude.start_upward();
        }
        if self.scenario.case().begins_phase(event) {
            self.enter(self.phase.after(event, self.scenario.case(), self.time, self.mass()))?;
        }
        self.log.event_records.push(EventRecord { event, before, after: self.instant() });
        Ok(())
    }

    /// Warns of a thrust that has no direction where it is switched on, and of parachutes that are not there to be cut off.
    fn warn_of(&mut self, event: usize, effect: &Effect) {
        let time = self.time;
        if let Some(ThrustCommand::On(thrust)) = effect.thrust
            && thrust.force != 0.0
            && self.direction(thrust.along).is_none()
        {
            self.log.warnings.push(Warning::ThrustWithoutDirection { event, time });
        }
        let is_there = |parachute: &usize| self.phase.canopies.iter().any(|canopy| canopy.event == *parachute);
        // What is separated or shut down by the same event is so before.
        let leaves = |part: &usize| effect.separate.iter().any(|separation| separation.parts.contains(part));
        let stays = |part: &usize| self.phase.parts[*part].is_there && !leaves(part);
        let burns = |part: &usize| self.phase.parts[*part].burn.is_some() && !effect.shut_down.contains(part);
        let unlit = effect.ignite.iter().filter(|part| !stays(part) || burns(part));
        let unlit = unlit.map(|part| Warning::NotLit { event, part: *part, is_there: stays(part), time });
        self.log.warnings.extend(unlit);
        let missing = effect.release.iter().filter(|parachute| !is_there(parachute));
        self.log.warnings.extend(missing.map(|parachute| Warning::NotDeployed { event, parachute: *parachute, time }));
    }

    /// A direction at the present instant, if there is one.
    fn direction(&self, along: ThrustAxis) -> Option<Vector3<f64>> {
        motion::direction(along, &self.scenario.case().planet, self.time, &F::state(&self.state).planet_fixed())
    }

    /// Changes the velocity at once.
    fn apply_impulse(&mut self, event: usize, impulse: Impulse) {
        match self.direction(impulse.along) {
            Some(direction) => {
                let velocity = F::state(&self.state).velocity + direction * impulse.speed_change;
                self.set_velocity(velocity);
            }
            None => self.log.warnings.push(Warning::NoDirection { event, time: self.time }),
        }
    }

    /// Goes on with another velocity, m/s.
    fn set_velocity(&mut self, velocity: Vector3<f64>) {
        self.state = F::numbers(&State { velocity, ..F::state(&self.state) });
        let derivative = self.motion.derivative(self.time, &self.state);
        self.stop_altitude.go_to(&StateRate::of::<F, N>(self.time, &self.state, &derivative));
    }

    /// Lets parts leave the vehicle, whose state they share but for the push.
    fn separate(&mut self, event: usize, place: usize, separation: &Separation) {
        let mut state = F::state(&self.state).planet_fixed();
        if let Some(push) = separation.push {
            match self.direction(push.along) {
                Some(direction) => state.velocity += direction * push.speed_change,
                None => self.log.warnings.push(Warning::NoDirection { event, time: self.time }),
            }
        }
        let mass = self.mass();
        let propellant = separation.parts.iter().map(|part| self.phase.propellant(*part, self.time, mass)).collect();
        let body = separation.body;
        self.log.separations.push(SeparationRecord { event, place, body, time: self.time, state, propellant });
    }

    /// The present mass, kg.
    fn mass(&self) -> f64 {
        self.state.get(MASS).copied().unwrap_or(self.phase.vehicle.mass)
    }

    /// Enters a phase, in the mode of the present state.
    fn enter(&mut self, phase: Phase) -> Result<(), SimulationError> {
        if let Some(mass) = self.state.get_mut(MASS) {
            *mass = phase.vehicle.mass;
        }
        weighs(&phase, self.time)?;
        if phase.has_unknown_shares() {
            return Err(SimulationError::UnknownShares { time: self.time });
        }
        *self.motion.forces_mut() = phase.forces(self.scenario.case());
        self.conditions.expect_burnout(phase.burnout_mass());
        self.phase = phase.clone();
        self.log.phases.push(phase);
        regular(&self.motion, self.time, &self.state)?;
        enter_mode_of(&mut self.motion, self.time, &self.state)
    }

    /// The number of the present phase and its mode, on which the forces depend.
    pub(super) fn phase_and_mode(&self) -> (usize, ModelMode) {
        (self.log.phases.len(), self.motion.forces().mode())
    }

    /// Whether a condition waits for one of the loads.
    pub(super) fn watches_loads(&self) -> bool {
        self.conditions.watches_loads()
    }

    /// Whether the vehicle is held on the ground.
    pub(super) fn is_held(&self) -> bool {
        self.phase.held
    }

    /// The present instant.
    pub(super) fn instant(&self) -> Instant {
        Instant {
            time: self.time,
            state: F::state(&self.state),
            phase: self.log.phases.len(),
            mode: self.motion.forces().mode(),
        }
    }

    /// What an integration error means for the flight: near a singularity, or where hardly anything is left to fly, that is the reason.
    pub(super) fn failure(&self, error: IntegrationError) -> SimulationError {
        let (time, otherwise) = match error {
            IntegrationError::StepLimit { time, limit } => (time, SimulationError::StepLimit { time, limit }),
            IntegrationError::StepTooSmall { time } => (time, SimulationError::TooStiff { time }),
            IntegrationError::Interrupted { time } => return SimulationError::Interrupted { time },
        };
        if self.mass() < NEARLY_NOTHING * self.phase.vehicle.mass {
            return SimulationError::NothingLeft { time };
        }
        let forces = self.motion.forces();
        let [_, circular_speed] = forces.units();
        let speed = F::state(&self.state).velocity.norm();
        match self.motion.singularity(&self.state, NEARLY_SINGULAR) {
            _ if forces.thrusts_by_velocity() && speed <= NEARLY_AT_REST * circular_speed => self.no_direction(time),
            Some(at) => SimulationError::Singularity { time, at },
            None => otherwise,
        }
    }

    fn arrival(&self, termination: Termination) -> Arrival {
        let mut statistics = self.integrator.statistics();
        statistics.evaluations += self.evaluations;
        let state = F::state(&self.state);
        let heat_load = state.heat_load.filter(|_| self.scenario.case().heating.is_some());
        Arrival { termination, time: self.time, state: state.planet_fixed(), heat_load, statistics }
    }
}

/// The moment some time after another, s, by one step of the classical method of Runge and Kutta: good for short times.
fn later<F: Formulation<N>, const N: usize>(motion: &F, time: f64, state: &[f64; N], length: f64) -> StateRate {
    let ahead = |rates: &[f64; N], part: f64| -> [f64; N] { from_fn(|i| state[i] + rates[i] * (part * length)) };
    let rates = |part: f64, state: &[f64; N]| motion.derivative(time + part * length, state);
    let first = rates(0.0, state);
    let second = rates(0.5, &ahead(&first, 0.5));
    let third = rates(0.5, &ahead(&second, 0.5));
    let fourth = rates(1.0, &ahead(&third, 1.0));
    let mean = from_fn(|i| (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]) / 6.0);
    let (time, state) = (time + length, ahead(&mean, 1.0));
    StateRate::of::<F, N>(time, &state, &motion.derivative(time, &state))
}

/// Enters the mode of a state.
fn enter_mode_of<F: Formulation<N>, const N: usize>(
    motion: &mut F,
    time: f64,
    state: &[f64; N],
) -> Result<(), SimulationError> {
    let state = F::state(state);
    motion.forces_mut().enter_mode_of(time, &state).map_err(|Chatter(switch)| SimulationError::Chatter { time, switch })
}

/// Whether a braking thrust has brought the vehicle to rest, as near as the steps or the equations come to it.
fn halts<F: Formulation<N>, const N: usize>(motion: &F, time: f64, state: &[f64; N]) -> bool {
    let forces = motion.forces();
    if !forces.thrusts_by_velocity() {
        return false;
    }
    let named = F::state(state);
    let at_rest = forces.is_at_rest(&named) || motion.singularity(state, SINGULAR) == Some(Singularity::Rest);
    at_rest && forces.brakes_to_rest(time, &named)
}

/// Refuses a vehicle of which nothing is left.
fn weighs(phase: &Phase, time: f64) -> Result<(), SimulationError> {
    if phase.vehicle.mass > 0.0 { Ok(()) } else { Err(SimulationError::NothingLeft { time }) }
}

/// Refuses a state in which the equations break down.
pub(super) fn regular<F: Formulation<N>, const N: usize>(
    motion: &F,
    time: f64,
    state: &[f64; N],
) -> Result<(), SimulationError> {
    match motion.singularity(state, SINGULAR) {
        Some(at) => Err(SimulationError::Singularity { time, at }),
        None => Ok(()),
    }
}

/// Closer to a singularity than this (rad, or parts of the circular speed) rounding costs more digits than the tolerances allow.
const SINGULAR: f64 = 1e-8;
/// An integration that fails this close to a singularity fails because of it.
const NEARLY_SINGULAR: f64 = 1e-2;
/// The motion is followed ahead for this part of the time in which an orbit here turns by a radian.
const FORESIGHT: f64 = 3e-3;
/// The change of the altitude from which on its direction is known, m: more than a rounding error of the radius.
const MOVES: f64 = 1e-6;
/// An integration under a thrust by the velocity that fails at less than this part of the circular speed fails because of it.
const NEARLY_AT_REST: f64 = 1e-4;
/// Of a mass of which no more than this part is left, nothing is: a rounding of what was there.
const NOTHING: f64 = 1e-12;
/// An integration that fails where no more than this part of the mass is left fails because of it.
const NEARLY_NOTHING: f64 = 1e-2;
/// By this part of the way to the place a step ends beyond it,
const AIM_BEYOND: f64 = 1e-3;
/// and by half of the uncertainty, which counts up to this part of the way.
const GREATEST_UNCERTAINTY: f64 = 0.1;
/// The least part of its length to which a step is cut for the sake of such a place.
const LEAST_WAY: f64 = 0.1;
