//! A step where the motion is stiff: the implicit method Radau IIA with three stages, of order 5.
//!
//! ```text
//! Zᵢ = h Σⱼ aᵢⱼ f(t₀ + cⱼ h, y₀ + Zⱼ),   y₁ = y₀ + Z₃
//! ```
//!
//! However long the step, what decays faster than it does not disturb it. The stages are found by simplified Newton iterations, whose
//! equations a change of variables splits into a real and a complex one of the size of the state. A step depends on its start and its length
//! alone: it can be repeated, and followed in numbers with derivatives.
//!
//! # Reference
//! E. Hairer, G. Wanner, Solving Ordinary Differential Equations II, 2nd ed., Springer 1996, section IV.5 (table 5.6: the method) and
//! section IV.8 (its implementation); the digits are those of the authors' program RADAU5.

#![expect(clippy::unreadable_literal, clippy::excessive_precision, reason = "the digits are as published")]

use std::array::from_fn;

use nalgebra::Complex;

use super::elimination::Factors;
use super::{Step, StepBounds, System};
use crate::scalar::Scalar;

/// A trial step.
pub(super) struct Trial<const N: usize> {
    /// The way from the start to the first two stages; the third is the end.
    pub(super) inside: [[f64; N]; 2],
    /// The state at the end, to order 5.
    pub(super) end: [f64; N],
    /// The error by an embedded method of order 3.
    pub(super) error: [f64; N],
    /// By which its iterations converged fast, if they did: it will do for the next step.
    jacobian: Option<[[f64; N]; N]>,
}

/// The step before.
#[derive(Debug)]
pub(super) struct PreviousStep<const N: usize> {
    /// s.
    length: f64,
    /// The way from its start to its stages, the last of which is its end.
    stages: [[f64; N]; STAGES],
    jacobian: Option<[[f64; N]; N]>,
}

impl<const N: usize> PreviousStep<N> {
    pub(super) fn of(trial: &Trial<N>, step: &Step<N>) -> Self {
        let [first, second] = trial.inside;
        Self {
            length: step.length(),
            stages: [first, second, from_fn(|i| step.end[i] - step.start[i])],
            jacobian: trial.jacobian,
        }
    }

    /// Whether its polynomial may be extrapolated over a step of a length, s: farther, it leads astray.
    fn reaches(&self, length: f64) -> bool {
        length <= LONGEST_EXTRAPOLATION * self.length
    }

    /// The way from its end to a time after it, s, on the cubic through its start and its stages.
    fn extrapolated(&self, time: f64) -> [f64; N] {
        let part = 1.0 + time / self.length;
        let [c1, c2, c3] = NODES;
        let weight = |own: f64, a: f64, b: f64| part * (part - a) * (part - b) / (own * (own - a) * (own - b));
        let weights = [weight(c1, c2, c3), weight(c2, c1, c3), weight(c3, c1, c2) - 1.0];
        from_fn(|i| (0..STAGES).map(|stage| self.stages[stage][i] * weights[stage]).sum())
    }
}

/// From where to where a trial step goes.
pub(super) struct Start<'a, const N: usize> {
    /// s.
    pub(super) time: f64,
    pub(super) state: &'a [f64; N],
    /// The rate of change there.
    pub(super) derivative: &'a [f64; N],
}

/// Tries a step of the given length, s; none where the iterations do not converge. They begin on the polynomial of the step before, if there is
/// one to go on from, or else on the tangent. Their equations are by the Jacobian of the step before, if that served well, or else by that
/// half-way. `error` is the size of a change of the state as a multiple of the tolerance. Adds to the evaluations.
pub(super) fn attempt<F: StepBounds<N>, const N: usize>(
    system: &F,
    start: &Start<N>,
    length: f64,
    previous: Option<&PreviousStep<N>>,
    error: impl Fn(&[f64; N]) -> f64,
    evaluations: &mut usize,
) -> Option<Trial<N>> {
    let &Start { time, state, derivative } = start;
    let previous = previous.filter(|previous| previous.reaches(length));
    let ahead =
        |time: f64| previous.map_or_else(|| derivative.map(|rate| rate * time), |previous| previous.extrapolated(time));
    let guess = NODES.map(|node| ahead(node * length));
    let mut iterated = |jacobian| iterate(system, start, length, jacobian, guess, &error, evaluations);
    if let Some(trial) = previous.and_then(|previous| previous.jacobian).and_then(&mut iterated) {
        return Some(trial);
    }
    let middle = MEAN_NODE * length;
    let way = ahead(middle);
    let jacobian = system.jacobian(time + middle, &from_fn(|i| state[i] + way[i]));
    let trial = iterated(jacobian);
    *evaluations += 1 + (0..N).filter(|column| jacobian.iter().any(|row| row[*column] != 0.0)).count();
    trial
}

/// Improves the stages of a trial step by equations with a Jacobian until what is left is far below the tolerance; none if they do not converge.
fn iterate<F: StepBounds<N>, const N: usize>(
    system: &F,
    &Start { time, state, derivative }: &Start<N>,
    length: f64,
    jacobian: [[f64; N]; N],
    mut stages: [[f64; N]; STAGES],
    error: impl Fn(&[f64; N]) -> f64,
    evaluations: &mut usize,
) -> Option<Trial<N>> {
    let newton = Newton::new(&jacobian, length)?;
    let mut last: Option<f64> = None;
    for _ in 0..ITERATIONS {
        let change = newton.improve(system, time, state, &mut stages);
        *evaluations += STAGES;
        let size: f64 = change.iter().map(&error).sum();
        // The iterations converge like a geometric series: by its ratio, how far the last one is from the limit.
        if let Some(last) = last {
            let ratio = size / last;
            if !(ratio < GREATEST_RATIO || size < CONVERGED) {
                return None;
            }
            if size * ratio < CONVERGED || size < CONVERGED * GREATEST_RATIO {
                let jacobian = (ratio < FAST_RATIO).then_some(jacobian);
                return Some(Trial { jacobian, ..newton.trial(state, derivative, stages) });
            }
        }
        last = Some(size);
    }
    None
}

/// The state at the end of a step that was taken before, from a time over a length, s, from another start: see [`follow`](super::follow).
///
/// The derivatives, too, converge like the iterations of the flight, which gained a digit each at least. `jacobian` is that of the
/// system without derivatives at a time, s, and in a state; where the iterations have no equations by it, as those of the flight had, the end is no
/// number.
pub fn follow_implicitly<F: System<S, N>, S: Scalar<Value = f64>, const N: usize>(
    system: &F,
    jacobian: impl FnOnce(f64, &[f64; N]) -> [[f64; N]; N],
    start: &[S; N],
    time: f64,
    length: f64,
) -> [S; N] {
    let derivative = system.derivative(time.into(), start);
    let middle = MEAN_NODE * length;
    let jacobian = jacobian(time + middle, &from_fn(|i| (start[i] + derivative[i] * middle).value()));
    let Some(newton) = Newton::new(&jacobian, length) else { return start.map(|_| S::from(f64::NAN)) };
    let mut stages = NODES.map(|node| derivative.map(|rate| rate * (node * length)));
    for _ in 0..ITERATIONS {
        newton.improve(system, time, start, &mut stages);
    }
    from_fn(|i| start[i] + stages[2][i])
}

/// The equations of the Newton iterations of a step.
struct Newton<const N: usize> {
    /// s.
    length: f64,
    /// γ/h - J.
    real: Factors<N>,
    /// (α + iβ)/h - J.
    complex: Factors<N>,
}

impl<const N: usize> Newton<N> {
    /// None where they have no solution.
    fn new(jacobian: &[[f64; N]; N], length: f64) -> Option<Self> {
        let factors = |shift: Complex<f64>| {
            let matrix = from_fn(|i| {
                from_fn(|j| {
                    let of_unit = if i == j { shift / length } else { Complex::default() };
                    of_unit - jacobian[i][j]
                })
            });
            Factors::of(matrix)
        };
        Some(Self { length, real: factors(GAMMA.into())?, complex: factors(Complex::new(ALPHA, BETA))? })
    }

    /// Improves the stages by an iteration; returns the change.
    ///
    /// ```text
    /// W = T⁻¹ Z:   (Λ/h - J) ΔW = T⁻¹ F(Z) - Λ/h W,   Λ = T⁻¹ A⁻¹ T
    /// ```
    ///
    /// # Reference
    /// Hairer and Wanner, equations IV.8.5 and 8.6, divided by h.
    #[inline(always)]
    fn improve<F: System<S, N>, S: Scalar<Value = f64>>(
        &self,
        system: &F,
        time: f64,
        start: &[S; N],
        stages: &mut [[S; N]; STAGES],
    ) -> [[S; N]; STAGES] {
        let mut rates = [[S::zero(); N]; STAGES];
        for ((rate, stage), node) in rates.iter_mut().zip(&*stages).zip(NODES) {
            let state = from_fn(|i| start[i] + stage[i]);
            *rate = system.derivative((time + self.length * node).into(), &state);
        }
        let [w1, w2, w3] = transformed(&INVERSE, stages);
        let [f1, f2, f3] = transformed(&INVERSE, &rates);
        let [alpha, beta, gamma] = [ALPHA, BETA, GAMMA].map(|number| number / self.length);
        let real = from_fn(|i| f1[i] - w1[i] * gamma);
        let complex =
            [from_fn(|i| f2[i] - w2[i] * alpha + w3[i] * beta), from_fn(|i| f3[i] - w3[i] * alpha - w2[i] * beta)];
        let [d1, _] = self.real.solve([real, [S::zero(); N]]);
        let [d2, d3] = self.complex.solve(complex);
        let change = transformed(&TRANSFORMATION, &[d1, d2, d3]);
        for (stage, change) in stages.iter_mut().zip(&change) {
            *stage = from_fn(|i| stage[i] + change[i]);
        }
        change
    }

    /// The trial with its error.
    ///
    /// ```text
    /// err = (γ/h - J)⁻¹ (f(y₀) + (e₁Z₁ + e₂Z₂ + e₃Z₃)/h)
    /// ```
    ///
    /// # Reference
    /// Hairer and Wanner, equation IV.8.19.
    fn trial(&self, start: &[f64; N], derivative: &[f64; N], stages: [[f64; N]; STAGES]) -> Trial<N> {
        let [first, second, last] = stages;
        let [e1, e2, e3] = ERROR.map(|weight| weight / self.length);
        let defect = from_fn(|i| derivative[i] + first[i] * e1 + second[i] * e2 + last[i] * e3);
        let [error, _] = self.real.solve([defect, [0.0; N]]);
        Trial { inside: [first, second], end: from_fn(|i| start[i] + last[i]), error, jacobian: None }
    }
}

/// Weighted sums of three states.
#[inline(always)]
fn transformed<S: Scalar, const N: usize>(
    matrix: &[[f64; STAGES]; STAGES],
    states: &[[S; N]; STAGES],
) -> [[S; N]; STAGES] {
    matrix.map(|[a, b, c]| from_fn(|i| states[0][i] * a + states[1][i] * b + states[2][i] * c))
}

const STAGES: usize = 3;

/// c, when the stages are, in parts of the step: (4 - √6)/10, (4 + √6)/10 and 1.
pub(super) const NODES: [f64; STAGES] = [0.155051025721682190, 0.644948974278317810, 1.0];

/// Iterations whose changes fall by this factor converge fast: with the same equations the next step takes no more of them.
const FAST_RATIO: f64 = 0.03;

/// How many times as long as the step before a step may be, if it is to begin on the polynomial of that.
const LONGEST_EXTRAPOLATION: f64 = 4.0;

/// Where the Jacobian is taken, in parts of the step: of the stages it then is the nearest to all.
const MEAN_NODE: f64 = 0.6;

/// The eigenvalues of A⁻¹: γ and α ± iβ.
const GAMMA: f64 = 3.6378342527444957;
const ALPHA: f64 = 2.6810828736277521;
const BETA: f64 = 3.0504301992474105;

/// T.
const TRANSFORMATION: [[f64; STAGES]; STAGES] = [
    [9.1232394870892942792e-2, -0.14125529502095420843, -3.0029194105147424492e-2],
    [0.24171793270710701896, 0.20412935229379993199, 0.38294211275726193779],
    [0.96604818261509293619, 1.0, 0.0],
];

/// T⁻¹.
const INVERSE: [[f64; STAGES]; STAGES] = [
    [4.3255798900631553510, 0.33919925181580986954, 0.54177053993587487119],
    [-4.1787185915519047273, -0.32768282076106238708, 0.47662355450055045196],
    [-0.50287263494578687595, 2.5719269498556054292, -0.59603920482822492497],
];

/// e: -(13 + 7√6)/3, (-13 + 7√6)/3 and -1/3.
const ERROR: [f64; STAGES] = [-10.048809399827416, 1.3821427331607485, -0.33333333333333333];

/// Newton iterations, of which each gains a digit at least.
const ITERATIONS: usize = 10;
/// To what part of the tolerance they are iterated.
const CONVERGED: f64 = 0.02;
/// Of the changes in two iterations that follow each other.
const GREATEST_RATIO: f64 = 0.1;
