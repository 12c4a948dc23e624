//! One step of a method, and the state inside it.

use super::tableau::{self, Row};
use super::{System, radau};
use crate::scalar::{Lanes, Scalar};

/// Evaluations of the derivative for a trial step.
pub(super) const TRIAL_EVALUATIONS: usize = tableau::STAGES.len();
/// Stages of a trial step, the derivative at its start included.
const STAGES: usize = 1 + TRIAL_EVALUATIONS;
/// The slopes from which the dense output is made: those of a trial step, that at its end, and its own.
const ALL_STAGES: usize = STAGES + 1 + tableau::DENSE_STAGES.len();
/// The first of the stages, after that at the start, on which the dense output rests.
const FIRST_KEPT: usize = 5;
const KEPT: usize = STAGES - FIRST_KEPT;

/// An accepted step.
#[derive(Clone, Debug)]
pub struct Step<const N: usize> {
    /// The instant at which the step starts, s.
    pub start_time: f64,
    /// The instant at which the step ends, s.
    pub end_time: f64,
    /// The state at the start.
    pub start: [f64; N],
    /// The state at the end.
    pub end: [f64; N],
    /// The rate of change at the start.
    pub start_derivative: [f64; N],
    /// The rate of change at the end.
    pub end_derivative: [f64; N],
    pub(super) inside: Inside<N>,
}

/// What a step keeps for the state inside it.
#[derive(Clone, Debug)]
pub(super) enum Inside<const N: usize> {
    /// Slopes of stages of DOP853.
    Explicit([[f64; N]; KEPT]),
    /// The way to the first two stages of Radau IIA.
    Implicit([[f64; N]; 2]),
    /// Of the beginning of a longer step: what the interpolant of that rests on.
    Beginning {
        /// Whether that was an implicit one.
        is_implicit: bool,
        /// Of the longer step, s.
        length: f64,
        coefficients: [[f64; N]; 7],
    },
}

/// The state at every instant inside a step: to order 7, and to order 3 where the step is implicit.
#[derive(Clone, Debug)]
pub struct Interpolant<const N: usize> {
    start_time: f64,
    /// s.
    length: f64,
    /// Of the step whose polynomials these are, and of which it may be the beginning alone, s.
    whole_length: f64,
    start: [f64; N],
    coefficients: [[f64; N]; 7],
}

/// A trial step: the slopes of its stages and where they lead.
#[derive(Debug)]
pub(super) struct Trial<S, const N: usize> {
    slopes: [[S; N]; STAGES],
    pub(super) outcome: Outcome<S, N>,
}

/// Where a trial step leads.
#[derive(Debug)]
pub(super) struct Outcome<S, const N: usize> {
    /// The state at the end, to order 8.
    pub(super) end: [S; N],
    /// The error of the mean slope by the embedded method of order 5.
    pub(super) error_fifth: [S; N],
    /// The error of the mean slope by the embedded method of order 3.
    pub(super) error_third: [S; N],
}

/// The slopes of stages on which the dense output rests.
pub(super) type KeptSlopes<const N: usize> = [[f64; N]; KEPT];

/// Tries a step of the given length; twelve stages less the first, which is the derivative at the start.
#[inline(always)]
pub(super) fn attempt<F: System<S, N>, S: Scalar, const N: usize>(
    system: &F,
    time: S,
    start: &[S; N],
    derivative: &[S; N],
    length: S::Value,
) -> Trial<S, N> {
    let mut slopes = [[S::zero(); N]; STAGES];
    slopes[0] = *derivative;
    // Not a loop: with its rows known, the compiler saves a tenth of the time.
    macro_rules! stages {
        ($($stage:literal)*) => {$(
            let slope = sum(&slopes, const { tableau::STAGES[$stage - 1] });
            slopes[$stage] = system.derivative(later(time, length, tableau::NODES[$stage - 1]), &advanced(start, &slope, length));
        )*};
    }
    stages!(1 2 3 4 5 6 7 8 9 10 11);
    let mean = sum(&slopes, tableau::WEIGHTS);
    let outcome = outcome(&slopes, &mean, advanced(start, &mean, length));
    Trial { slopes, outcome }
}

/// Tries the steps of several integrators, which end at some times; returns the rates of change there. `trial`: where they are tried.
#[inline(always)]
pub(super) fn attempt_in_lanes<F: System<Lanes<L>, N>, const N: usize, const L: usize>(
    system: &F,
    [time, end_time]: [Lanes<L>; 2],
    start: &[Lanes<L>; N],
    derivative: &[Lanes<L>; N],
    length: Lanes<L>,
    trial: &mut Trial<Lanes<L>, N>,
) -> [Lanes<L>; N] {
    let Trial { slopes, outcome: of_trial } = trial;
    slopes[0] = *derivative;
    let mut stage = 1;
    // The system, which is long, stands here once, and not once for every stage and the end.
    let (mean, end, end_derivative) = loop {
        let is_end = stage == STAGES;
        let mean = sum(&slopes[..], if is_end { tableau::WEIGHTS } else { tableau::STAGES[stage - 1] });
        let then = if is_end { end_time } else { later(time, length, tableau::NODES[stage - 1]) };
        let there = advanced(start, &mean, length);
        let slope = system.derivative(then, &there);
        if is_end {
            break (mean, there, slope);
        }
        slopes[stage] = slope;
        stage += 1;
    };
    *of_trial = outcome(slopes, &mean, end);
    end_derivative
}

/// Where the slopes of stages lead, with their mean, to an end.
#[inline(always)]
fn outcome<S: Scalar, const N: usize>(slopes: &[[S; N]; STAGES], mean: &[S; N], end: [S; N]) -> Outcome<S, N> {
    let third = sum(slopes, tableau::THIRD);
    let mut error_third = *mean;
    for (error, third) in error_third.iter_mut().zip(third) {
        *error -= third;
    }
    Outcome { end, error_fifth: sum(slopes, tableau::ERROR_FIFTH), error_third }
}

impl<const N: usize> Trial<f64, N> {
    pub(super) fn kept_slopes(&self) -> KeptSlopes<N> {
        let mut kept = [[0.0; N]; KEPT];
        kept.copy_from_slice(&self.slopes[FIRST_KEPT..]);
        kept
    }
}

impl<const N: usize, const L: usize> Trial<Lanes<L>, N> {
    /// Room for one.
    pub(super) fn none() -> Self {
        let none = [Lanes([0.0; L]); N];
        Self { slopes: [none; STAGES], outcome: Outcome { end: none, error_fifth: none, error_third: none } }
    }

    /// The slopes of one lane.
    pub(super) fn kept_slopes_of(&self, lane: usize) -> KeptSlopes<N> {
        let mut kept = [[0.0; N]; KEPT];
        for (slope, lanes) in kept.iter_mut().zip(&self.slopes[FIRST_KEPT..]) {
            *slope = of_lane(lanes, lane);
        }
        kept
    }
}

/// The numbers of one lane.
#[inline(always)]
pub(super) fn of_lane<const N: usize, const L: usize>(numbers: &[Lanes<L>; N], lane: usize) -> [f64; N] {
    let mut of_lane = [0.0; N];
    for (one, lanes) in of_lane.iter_mut().zip(numbers) {
        *one = lanes.0[lane];
    }
    of_lane
}

impl<const N: usize> Step<N> {
    /// The length, s.
    pub fn length(&self) -> f64 {
        self.end_time - self.start_time
    }

    /// The instant at the given part of the step, 0 at its start and 1 at its end.
    pub fn time(&self, part: f64) -> f64 {
        if part < 1.0 { self.start_time + part * self.length() } else { self.end_time }
    }

    /// Moves the end by a time that is tiny beside the step, along the rate of change there.
    pub fn move_end(&mut self, time: f64) {
        self.end_time += time;
        self.end = std::array::from_fn(|i| self.end[i] + self.end_derivative[i] * time);
    }

    /// Whether it is a step of an implicit method, as they are taken where the system is stiff.
    pub fn is_implicit(&self) -> bool {
        matches!(self.inside, Inside::Implicit(_) | Inside::Beginning { is_implicit: true, .. })
    }

    /// The state inside, which takes [`Interpolant::EVALUATIONS`] of the derivative, and none where the step is implicit,
    /// or the beginning of a longer one.
    pub fn interpolant<F: System<f64, N>>(&self, system: &F) -> Interpolant<N> {
        let Self { start_time, start, .. } = *self;
        let length = self.length();
        let whole_length = match self.inside {
            Inside::Beginning { length, .. } => length,
            Inside::Explicit(_) | Inside::Implicit(_) => length,
        };
        Interpolant { start_time, length, whole_length, start, coefficients: self.coefficients(system) }
    }

    /// What the state inside rests on.
    fn coefficients<F: System<f64, N>>(&self, system: &F) -> [[f64; N]; 7] {
        let Self { start, end, start_derivative, end_derivative, .. } = *self;
        let length = self.length();
        let increment: [f64; N] = std::array::from_fn(|i| end[i] - start[i]);
        let bend: [f64; N] = std::array::from_fn(|i| start_derivative[i] * length - increment[i]);
        let twist: [f64; N] =
            std::array::from_fn(|i| increment[i] * 2.0 - (start_derivative[i] + end_derivative[i]) * length);
        let [f4, f5, f6, f7] = match &self.inside {
            Inside::Explicit(slopes) => self.explicit_rest(system, slopes),
            Inside::Beginning { coefficients, .. } => return *coefficients,
            Inside::Implicit(stages) => {
                // What the cubic of the ends leaves of the two stages is θ² (1-θ)² (F₄ + θ F₅) there.
                let left = |stage: usize, i: usize| {
                    let (part, rest) = (radau::NODES[stage], 1.0 - radau::NODES[stage]);
                    let cubic = part * (increment[i] + rest * (bend[i] + part * twist[i]));
                    (stages[stage][i] - cubic) / (part * rest).powi(2)
                };
                let [c1, c2, _] = radau::NODES;
                let f5: [f64; N] = std::array::from_fn(|i| (left(1, i) - left(0, i)) / (c2 - c1));
                let f4 = std::array::from_fn(|i| left(0, i) - f5[i] * c1);
                [f4, f5, [0.0; N], [0.0; N]]
            }
        };
        [increment, bend, twist, f4, f5, f6, f7]
    }

    /// The beginning of the step up to a part of it, where `interpolant` is that of the step.
    pub(super) fn beginning<F: System<f64, N>>(&self, system: &F, interpolant: &Interpolant<N>, part: f64) -> Self {
        let end_time = self.time(part);
        let end = interpolant.state(part);
        Self {
            end_time,
            end,
            end_derivative: system.derivative(end_time, &end),
            inside: Inside::Beginning {
                is_implicit: self.is_implicit(),
                length: interpolant.whole_length,
                coefficients: interpolant.coefficients,
            },
            ..*self
        }
    }

    /// The last four of the coefficients, from the slopes that an explicit step keeps and three more.
    fn explicit_rest<F: System<f64, N>>(&self, system: &F, kept: &[[f64; N]; KEPT]) -> [[f64; N]; 4] {
        let length = self.length();
        let mut slopes = [[0.0; N]; ALL_STAGES];
        slopes[0] = self.start_derivative;
        slopes[FIRST_KEPT..STAGES].copy_from_slice(kept);
        slopes[STAGES] = self.end_derivative;
        for (stage, (row, node)) in (STAGES + 1..).zip(tableau::DENSE_STAGES.into_iter().zip(tableau::DENSE_NODES)) {
            let time = later(self.start_time, length, node);
            slopes[stage] = system.derivative(time, &advanced(&self.start, &sum(&slopes, row), length));
        }
        tableau::DENSE.map(|row| sum(&slopes, row).map(|component| component * length))
    }

    /// What the state inside costs: evaluations of the derivative.
    pub fn interpolant_evaluations(&self) -> usize {
        if matches!(self.inside, Inside::Explicit(_)) { Interpolant::<N>::EVALUATIONS } else { 0 }
    }
}

impl<const N: usize> Interpolant<N> {
    /// What it costs to make one of an explicit step: evaluations of the derivative.
    pub const EVALUATIONS: usize = tableau::DENSE_STAGES.len();

    /// The state at the given part of the step, 0 at its start and 1 at its end.
    pub fn state(&self, part: f64) -> [f64; N] {
        let part = part * (self.length / self.whole_length);
        // y = y₀ + θ (F₁ + (1-θ) (F₂ + θ (F₃ + (1-θ) (F₄ + θ (F₅ + (1-θ) (F₆ + θ F₇))))))
        let rest = 1.0 - part;
        let [f1, f2, f3, f4, f5, f6, f7] = &self.coefficients;
        std::array::from_fn(|i| {
            let inner = (f7[i] * part + f6[i]) * rest + f5[i];
            let middle = (inner * part + f4[i]) * rest + f3[i];
            ((middle * part + f2[i]) * rest + f1[i]) * part + self.start[i]
        })
    }

    /// Its rate of change per second there, that of the polynomial: a maximum that is found by it is one of the states.
    pub fn rate(&self, part: f64) -> [f64; N] {
        let part = part * (self.length / self.whole_length);
        let rest = 1.0 - part;
        let [f1, f2, f3, f4, f5, f6, f7] = &self.coefficients;
        std::array::from_fn(|i| {
            // Each factor in turn, with its derivative by θ.
            let (value, slope) = (f7[i] * part + f6[i], f7[i]);
            let (value, slope) = (value * rest + f5[i], slope * rest - value);
            let (value, slope) = (value * part + f4[i], slope * part + value);
            let (value, slope) = (value * rest + f3[i], slope * rest - value);
            let (value, slope) = (value * part + f2[i], slope * part + value);
            let (value, slope) = (value * rest + f1[i], slope * rest - value);
            (slope * part + value) / self.whole_length
        })
    }

    /// The state at an instant of the step.
    pub fn state_at(&self, time: f64) -> [f64; N] {
        self.state((time - self.start_time) / self.length)
    }
}

/// The state at the end of an explicit step that was taken before, from a time over a length, s, from another start: the numbers may carry
/// derivatives, which then are those of the end by what varies at the start and in the system. The step is not chosen anew, so that
/// its choice adds nothing.
pub fn follow<F: System<S, N>, S: Scalar<Value = f64>, const N: usize>(
    system: &F,
    start: &[S; N],
    time: f64,
    length: f64,
) -> [S; N] {
    let time = S::from(time);
    let system = &Once(system);
    attempt(system, time, start, &system.derivative(time, start), length).outcome.end
}

/// A system whose derivative stands in the program once, not in every stage: in wide numbers it is long.
pub(super) struct Once<'a, F>(pub(super) &'a F);

impl<F: System<S, N>, S: Scalar, const N: usize> System<S, N> for Once<'_, F> {
    #[inline(never)]
    fn derivative(&self, time: S, state: &[S; N]) -> [S; N] {
        self.0.derivative(time, state)
    }
}

/// The time at a part of a step.
#[inline(always)]
fn later<S: Scalar>(time: S, length: S::Value, part: f64) -> S {
    time + S::one().scaled(length * part)
}

/// The state after moving with a slope for a time.
#[inline(always)]
fn advanced<S: Scalar, const N: usize>(start: &[S; N], slope: &[S; N], time: S::Value) -> [S; N] {
    let mut end = *start;
    for (component, slope) in end.iter_mut().zip(slope) {
        *component += slope.scaled(time);
    }
    end
}

/// The weighted sum of slopes.
#[inline(always)]
fn sum<S: Scalar, const N: usize>(slopes: &[[S; N]], row: Row) -> [S; N] {
    let mut sum = [S::zero(); N];
    for (slope, weight) in row {
        for (component, slope) in sum.iter_mut().zip(&slopes[*slope]) {
            *component += *slope * *weight;
        }
    }
    sum
}
