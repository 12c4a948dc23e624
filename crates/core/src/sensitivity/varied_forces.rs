//! The forces and the motion of a phase, with derivatives by the numbers that vary.

use nalgebra::SVector;
use num_dual::Derivative;

use super::variation::{Dual, Node, VariedCase};
use crate::integrate::System;
use crate::motion::{Forces, ModelMode, Switch};
use crate::scenario::{FormulationIn, Phase};

/// The forces of a phase: in dual numbers by the models of the case, and plain by the models of the cases in which these vary, for the
/// derivatives by what is in the models.
pub(super) struct VariedForces<const W: usize> {
    pub(super) dual: Forces<Dual<W>>,
    pub(super) plain: Forces,
    nodes: Vec<ModelNode<Forces>>,
}

/// Something made with the models of a case in which the number of a variation is moved.
struct ModelNode<T> {
    /// The place of the variation.
    variation: usize,
    weight: f64,
    of: T,
}

impl<const W: usize> VariedForces<W> {
    /// Those of a phase, with and without derivatives; `changes_models` says which variations do.
    pub(super) fn new(
        varied: &VariedCase<'_, W>,
        changes_models: &[bool],
        phase: &Phase<Dual<W>>,
        plain: &Phase,
        mode: ModelMode,
    ) -> Self {
        let in_models = varied.variations.iter().enumerate().filter(|(variation, _)| changes_models[*variation]);
        let nodes = in_models.flat_map(|(variation, number)| {
            let of_node = move |node: &Node| {
                let mut of = plain.with_models_of(&node.case).forces_by(&node.case, varied.case);
                of.enter(mode);
                ModelNode { variation, weight: node.weight, of }
            };
            number.nodes().iter().map(of_node)
        });
        let mut forces = Self { dual: phase.forces(varied), plain: plain.forces(varied.case), nodes: nodes.collect() };
        forces.dual.enter(mode);
        forces.plain.enter(mode);
        forces
    }

    pub(super) fn mode(&self) -> ModelMode {
        self.plain.mode()
    }

    /// A number of the forces in dual numbers, with its derivatives by what is in the models, of which `of` gives it without derivatives.
    pub(super) fn with_models(&self, number: Dual<W>, of: impl Fn(&Forces) -> f64) -> Dual<W> {
        if self.nodes.is_empty() {
            return number;
        }
        let value = of(&self.plain);
        let mut slopes = SVector::<f64, W>::zeros();
        for node in &self.nodes {
            slopes[node.variation] += node.weight * (of(&node.of) - value);
        }
        number + Dual::new(0.0, Derivative::some(slopes))
    }

    /// The boundary to which a switch is nearest on the way to the next mode, with its derivatives.
    pub(super) fn boundary(&self, switch: Switch, next: ModelMode) -> Dual<W> {
        let boundary = |forces: &Forces| forces.boundary_towards(switch, next).unwrap_or_default();
        self.with_models(Dual::from(boundary(&self.plain)), boundary)
    }

    /// The motion under these forces.
    pub(super) fn motion<F: FormulationIn<Dual<W>, N>, const N: usize>(&self) -> VariedMotion<F, N, W> {
        let nodes = self.nodes.iter().map(|node| {
            let ModelNode { variation, weight, ref of } = *node;
            ModelNode { variation, weight, of: F::of_plain(of.clone()) }
        });
        VariedMotion { dual: F::of(self.dual.clone()), plain: F::of_plain(self.plain.clone()), nodes: nodes.collect() }
    }
}

/// The equations of motion, whose rates carry the derivatives by what is in the models as well.
pub(super) struct VariedMotion<F: FormulationIn<Dual<W>, N>, const N: usize, const W: usize> {
    dual: F::Motion,
    plain: F,
    nodes: Vec<ModelNode<F>>,
}

impl<F: FormulationIn<Dual<W>, N>, const N: usize, const W: usize> VariedMotion<F, N, W> {
    /// How the rates depend on the state.
    pub(super) fn jacobian(&self, time: f64, state: &[f64; N]) -> [[f64; N]; N] {
        self.plain.jacobian(time, state)
    }
}

impl<F: FormulationIn<Dual<W>, N>, const N: usize, const W: usize> System<Dual<W>, N> for VariedMotion<F, N, W> {
    fn derivative(&self, time: Dual<W>, state: &[Dual<W>; N]) -> [Dual<W>; N] {
        let mut rates = self.dual.derivative(time, state);
        if self.nodes.is_empty() {
            return rates;
        }
        let (time, state) = (time.re, state.map(|number| number.re));
        let plain = self.plain.derivative(time, &state);
        let mut slopes = [SVector::<f64, W>::zeros(); N];
        for node in &self.nodes {
            let moved = node.of.derivative(time, &state);
            for i in 0..N {
                slopes[i][node.variation] += node.weight * (moved[i] - plain[i]);
            }
        }
        for (rate, slope) in rates.iter_mut().zip(slopes) {
            *rate += Dual::new(0.0, Derivative::some(slope));
        }
        rates
    }
}
