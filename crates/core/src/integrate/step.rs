//! One step of the method, and the state inside it.

use super::System;
use super::tableau::{self, Row};
use crate::scalar::Scalar;

/// Evaluations of the derivative for a trial step.
pub(super) const TRIAL_EVALUATIONS: usize = tableau::STAGES.len();
/// Evaluations that complete an accepted step: the derivative at its end and the stages of the dense output.
pub(super) const COMPLETION_EVALUATIONS: usize = 1 + tableau::DENSE_STAGES.len();
const ALL_STAGES: usize = 1 + TRIAL_EVALUATIONS + COMPLETION_EVALUATIONS;

/// An accepted step, with the state at every instant inside it.
#[derive(Clone, Debug)]
pub struct Step<S, const N: usize> {
    /// The instant at which the step starts, s.
    pub start_time: f64,
    /// The instant at which the step ends, s.
    pub end_time: f64,
    /// The state at the start.
    pub start: [S; N],
    /// The state at the end.
    pub end: [S; N],
    /// The rate of change at the start.
    pub start_derivative: [S; N],
    /// The rate of change at the end.
    pub end_derivative: [S; N],
    dense: [[S; N]; 7],
}

impl<S: Scalar, const N: usize> Step<S, N> {
    /// The length, s.
    pub fn length(&self) -> f64 {
        self.end_time - self.start_time
    }

    /// The instant at the given part of the step, 0 at its start and 1 at its end.
    pub fn time(&self, part: f64) -> f64 {
        if part < 1.0 { self.start_time + part * self.length() } else { self.end_time }
    }

    /// The state at the given part of the step, to order 7.
    pub fn state(&self, part: f64) -> [S; N] {
        // y = y₀ + θ (F₁ + (1-θ) (F₂ + θ (F₃ + (1-θ) (F₄ + θ (F₅ + (1-θ) (F₆ + θ F₇))))))
        let rest = 1.0 - part;
        let [f1, f2, f3, f4, f5, f6, f7] = &self.dense;
        std::array::from_fn(|i| {
            let inner = (f7[i] * part + f6[i]) * rest + f5[i];
            let middle = (inner * part + f4[i]) * rest + f3[i];
            ((middle * part + f2[i]) * rest + f1[i]) * part + self.start[i]
        })
    }

    /// Moves the end by a time that is tiny beside the step, along the rate of change there.
    pub fn move_end(&mut self, time: f64) {
        self.end_time += time;
        self.end = std::array::from_fn(|i| self.end[i] + self.end_derivative[i] * time);
    }

    /// The state at an instant of the step.
    pub fn state_at(&self, time: f64) -> [S; N] {
        self.state((time - self.start_time) / self.length())
    }
}

/// A trial step: the slopes of its stages and the state to which they lead.
pub(super) struct Trial<S, const N: usize> {
    slopes: [[S; N]; ALL_STAGES],
    /// The state at the end, to order 8.
    pub(super) end: [S; N],
    /// The error of the mean slope by the embedded method of order 5.
    pub(super) error_fifth: [S; N],
    /// The error of the mean slope by the embedded method of order 3.
    pub(super) error_third: [S; N],
}

/// Tries a step of the given length; twelve stages less the first, which is the derivative at the start.
pub(super) fn attempt<F: System<N>, S: Scalar, const N: usize>(
    system: &F,
    start: &[S; N],
    derivative: &[S; N],
    length: f64,
) -> Trial<S, N> {
    let mut slopes = [[S::zero(); N]; ALL_STAGES];
    slopes[0] = *derivative;
    for (stage, row) in (1..).zip(tableau::STAGES) {
        slopes[stage] = system.derivative(&advanced(start, &sum(&slopes, row), length));
    }
    let mean = sum(&slopes, tableau::WEIGHTS);
    let third = sum(&slopes, tableau::THIRD);
    Trial {
        end: advanced(start, &mean, length),
        error_fifth: sum(&slopes, tableau::ERROR_FIFTH),
        error_third: std::array::from_fn(|i| mean[i] - third[i]),
        slopes,
    }
}

/// Completes an accepted step with its dense output.
pub(super) fn complete<F: System<N>, S: Scalar, const N: usize>(
    system: &F,
    start_time: f64,
    end_time: f64,
    start: &[S; N],
    trial: &Trial<S, N>,
) -> Step<S, N> {
    let Trial { mut slopes, end, .. } = *trial;
    let length = end_time - start_time;
    slopes[12] = system.derivative(&end);
    for (stage, row) in (13..).zip(tableau::DENSE_STAGES) {
        slopes[stage] = system.derivative(&advanced(start, &sum(&slopes, row), length));
    }
    let [first, last] = [slopes[0], slopes[12]];
    let increment: [S; N] = std::array::from_fn(|i| end[i] - start[i]);
    let bend = std::array::from_fn(|i| first[i] * length - increment[i]);
    let twist = std::array::from_fn(|i| increment[i] * 2.0 - (first[i] + last[i]) * length);
    let [f4, f5, f6, f7] = tableau::DENSE.map(|row| sum(&slopes, row).map(|component| component * length));
    Step {
        start_time,
        end_time,
        start: *start,
        end,
        start_derivative: first,
        end_derivative: last,
        dense: [increment, bend, twist, f4, f5, f6, f7],
    }
}

/// The state after moving with a slope for a time.
#[inline(always)]
fn advanced<S: Scalar, const N: usize>(start: &[S; N], slope: &[S; N], time: f64) -> [S; N] {
    std::array::from_fn(|i| start[i] + slope[i] * time)
}

/// The weighted sum of slopes.
#[inline(always)]
fn sum<S: Scalar, const N: usize>(slopes: &[[S; N]; ALL_STAGES], row: Row) -> [S; N] {
    let mut sum = [S::zero(); N];
    for (slope, weight) in row {
        for (component, slope) in sum.iter_mut().zip(&slopes[*slope]) {
            *component += *slope * *weight;
        }
    }
    sum
}
