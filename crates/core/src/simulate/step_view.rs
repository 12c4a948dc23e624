//! An accepted step of the flight, and the motion inside it, which is computed where it is asked for.

use std::borrow::Cow;
use std::cell::OnceCell;

use nalgebra::Vector3;
use num_dual::Dual64;

use crate::coordinates::GreatCircle;
use crate::event::Quantity;
use crate::integrate::{Interpolant, Step};
use crate::motion::{EndReadings, Flow, Formulation, Loads, State, StateRate, Switch};

/// An accepted step.
pub(super) struct StepView<'a, F, const N: usize> {
    /// Owned where it was cut.
    pub(super) step: Cow<'a, Step<N>>,
    pub(super) motion: &'a F,
    /// The number of the phase to which it belongs.
    pub(super) phase: usize,
    interpolant: OnceCell<Interpolant<N>>,
    altitude_at_end: OnceCell<Dual64>,
    flow_at_end: OnceCell<Flow<Dual64>>,
    cos_squared_gamma_at_end: OnceCell<Dual64>,
    loads_at_end: OnceCell<Loads<Dual64>>,
    quantities_at_end: [OnceCell<Dual64>; Quantity::ALL.len()],
    readings_at_end: OnceCell<[Dual64; Switch::ALL.len()]>,
}

impl<'a, F: Formulation<N>, const N: usize> StepView<'a, F, N> {
    pub(super) fn new(motion: &'a F, step: &'a Step<N>, phase: usize) -> Self {
        Self::of(motion, Cow::Borrowed(step), phase)
    }

    fn of(motion: &'a F, step: Cow<'a, Step<N>>, phase: usize) -> Self {
        Self {
            step,
            motion,
            phase,
            interpolant: OnceCell::new(),
            altitude_at_end: OnceCell::new(),
            flow_at_end: OnceCell::new(),
            cos_squared_gamma_at_end: OnceCell::new(),
            loads_at_end: OnceCell::new(),
            quantities_at_end: Default::default(),
            readings_at_end: OnceCell::new(),
        }
    }

    /// Notes what was read at the end already.
    pub(super) fn note(&mut self, read: &EndReadings) {
        self.altitude_at_end = OnceCell::from(read.altitude);
        if let Some(switches) = read.switches {
            self.readings_at_end = OnceCell::from(switches);
        }
        if let Some((loads, cos_squared_gamma)) = read.loads {
            self.loads_at_end = OnceCell::from(loads);
            self.cos_squared_gamma_at_end = OnceCell::from(cos_squared_gamma);
        }
    }

    /// Views the beginning of the step, as far as it counts.
    pub(super) fn replace(&mut self, beginning: Step<N>) {
        *self = Self::of(self.motion, Cow::Owned(beginning), self.phase);
    }

    /// Whether it is the beginning of a step.
    pub(super) fn is_cut(&self) -> bool {
        matches!(self.step, Cow::Owned(_))
    }

    /// s.
    pub(super) fn length(&self) -> f64 {
        self.step.length()
    }

    /// The state at the start, moving along the flow.
    pub(super) fn start(&self) -> StateRate {
        StateRate::of::<F, N>(self.step.start_time, &self.step.start, &self.step.start_derivative)
    }

    /// The state inside.
    pub(super) fn interpolant(&self) -> &Interpolant<N> {
        self.interpolant.get_or_init(|| self.step.interpolant(self.motion))
    }

    /// The state at the given part of the step, moving along the flow: with its own velocity, which is right from rest as well, where the
    /// rate of the dense output is a rounding.
    pub(super) fn inside(&self, part: f64) -> StateRate {
        let mut now = self.on_dense_output(part);
        now.state.position.zip_apply(&now.state.velocity, |place, velocity| place.eps = velocity.re);
        now
    }

    /// The position of [`inside`](Self::inside) alone, m.
    pub(super) fn position_inside(&self, part: f64) -> Vector3<Dual64> {
        let State { position, velocity, .. } = F::state(&self.interpolant().state(part));
        position.zip_map(&velocity, Dual64::new)
    }

    /// The state at the given part of the step, without its rates.
    pub(super) fn state_inside(&self, part: f64) -> StateRate<f64> {
        StateRate::at::<F, N>(self.step.time(part), &self.interpolant().state(part))
    }

    /// The state at the given part of the step, moving along the dense output: what rises and falls by these rates does so along the
    /// states that the dense output has, whatever its error.
    pub(super) fn on_dense_output(&self, part: f64) -> StateRate {
        let interpolant = self.interpolant();
        StateRate::of::<F, N>(self.step.time(part), &interpolant.state(part), &interpolant.rate(part))
    }

    /// The state at the end, moving along the flow.
    pub(super) fn end(&self) -> StateRate {
        StateRate::of::<F, N>(self.step.end_time, &self.step.end, &self.step.end_derivative)
    }

    /// The altitude at the end, m.
    pub(super) fn altitude_at_end(&self) -> Dual64 {
        let read = || self.motion.forces().planet().shape.altitude(&self.end().state.position);
        *self.altitude_at_end.get_or_init(read)
    }

    /// The air that meets the vehicle at the end, with its Mach number.
    fn flow_at_end(&self) -> &Flow<Dual64> {
        self.flow_at_end.get_or_init(|| {
            let StateRate { time, state, .. } = self.end();
            self.motion.forces().flow_with_mach(time, &state)
        })
    }

    /// The loads at the end.
    pub(super) fn loads_at_end(&self) -> &Loads<Dual64> {
        self.loads_at_end.get_or_init(|| {
            let StateRate { time, state, .. } = self.end();
            self.motion.forces().loads_in(time, &state, self.flow_at_end())
        })
    }

    /// cos²γ of the velocity relative to the air at the end.
    pub(super) fn cos_squared_gamma_at_end(&self) -> Dual64 {
        *self.cos_squared_gamma_at_end.get_or_init(|| self.flow_at_end().cos_squared_gamma())
    }

    /// What an event may wait for, at the end; ranges from the beginning of `track`.
    pub(super) fn quantity_at_end(&self, quantity: Quantity, track: &GreatCircle<Dual64>) -> Dual64 {
        let read = || self.motion.forces().quantity_with(quantity, &self.end(), track, || *self.loads_at_end());
        *self.quantities_at_end[quantity as usize].get_or_init(read)
    }

    /// The quantities of the switches, at the end.
    pub(super) fn readings_at_end(&self) -> &[Dual64; Switch::ALL.len()] {
        self.readings_at_end.get_or_init(|| {
            let StateRate { time, state, .. } = self.end();
            self.motion.forces().readings_with(time, &state, &self.flow_at_end)
        })
    }

    /// What looking inside has cost: evaluations of the derivative for the interpolation.
    pub(super) fn evaluations(&self) -> usize {
        if self.interpolant.get().is_some() { self.step.interpolant_evaluations() } else { 0 }
    }
}
