//! The method of integration: its order, its dense output, its number types, and its events.

use std::cell::Cell;
use std::sync::atomic::AtomicBool;

use num_dual::Dual64;
use reentry::integrate::{IntegrationError, Integrator, Interpolant, Limits, Step, StepBounds, System, event, follow};
use reentry::motion::{Cartesian, Spherical};
use reentry::scalar::Scalar;

use crate::check::{near, relative};
use crate::core::flights::target_2;

/// The plane Kepler problem with eccentricity 0.5 from periapsis: period 2π, energy -1/2.
pub(crate) struct Kepler;

impl<S: Scalar> System<S, 4> for Kepler {
    fn derivative(&self, _: S, state: &[S; 4]) -> [S; 4] {
        let [x, y, vx, vy] = *state;
        let squared = x * x + y * y;
        let pull = (squared * squared.sqrt()).recip();
        [vx, vy, -x * pull, -y * pull]
    }
}

impl StepBounds<4> for Kepler {
    fn magnitudes(&self) -> [f64; 4] {
        [1.0; 4]
    }
}

const PERIAPSIS: [f64; 4] = [0.5, 0.0, 0.0, 1.732_050_807_568_877_2];

/// Where the body of [`Kepler`] is, by Kepler's equation.
fn kepler_position(time: f64) -> [f64; 2] {
    let mut anomaly = time;
    for _ in 0..50 {
        anomaly -= (anomaly - 0.5 * anomaly.sin() - time) / (1.0 - 0.5 * anomaly.cos());
    }
    [anomaly.cos() - 0.5, 0.75_f64.sqrt() * anomaly.sin()]
}

fn limits(relative_tolerance: f64, interrupt: &AtomicBool) -> Limits<'_> {
    Limits { relative_tolerance, steps: 10_000, interrupt }
}

/// One step of a given length, whatever its error.
fn single_step(length: f64) -> Step<4> {
    let interrupt = AtomicBool::new(false);
    let mut integrator = Integrator::new(&Kepler, 0.0, PERIAPSIS, limits(1e-10, &interrupt));
    let step = integrator.advance(&Kepler, length).unwrap();
    integrator.shorten(&Kepler, &step, length)
}

fn distance(state: &[f64; 4], time: f64) -> f64 {
    let [x, y] = kepler_position(time);
    (state[0] - x).hypot(state[1] - y)
}

#[test]
fn the_error_of_a_step_falls_with_the_ninth_power_of_its_length() {
    let error = |length: f64| distance(&single_step(length).end, length);
    let order = (error(0.2) / error(0.1)).log2();
    assert!((8.5..9.8).contains(&order), "order {order}");
}

#[test]
fn the_error_of_the_dense_output_falls_with_the_eighth_power_of_the_step() {
    let worst = |length: f64| {
        let step = single_step(length);
        let inside = step.interpolant(&Kepler);
        let errors =
            (1..20).map(|part| f64::from(part) / 20.0).map(|part| distance(&inside.state(part), part * length));
        errors.fold(0.0, f64::max)
    };
    let order = (worst(0.2) / worst(0.1)).log2();
    assert!((7.5..8.8).contains(&order), "order {order}");
}

#[test]
fn the_dense_output_meets_both_ends_and_their_slopes() {
    let step = single_step(0.3);
    let inside = step.interpolant(&Kepler);
    for i in 0..4 {
        near("start", inside.state(0.0)[i], step.start[i], 0.0);
        near("end", inside.state(1.0)[i], step.end[i], 1e-15);
        let slope = |part: f64| (inside.state(part + 1e-6)[i] - inside.state(part - 1e-6)[i]) / (2e-6 * 0.3);
        near("slope at the start", slope(0.0), step.start_derivative[i], 1e-8);
        near("slope at the end", slope(1.0), step.end_derivative[i], 1e-8);
    }
}

#[test]
fn the_global_error_follows_the_tolerance() {
    let interrupt = AtomicBool::new(false);
    let mut before = f64::INFINITY;
    for exponent in [-4, -6, -8, -10, -12] {
        let tolerance = 10_f64.powi(exponent);
        let mut integrator = Integrator::new(&Kepler, 0.0, PERIAPSIS, limits(tolerance, &interrupt));
        let mut last = PERIAPSIS;
        let mut time = 0.0;
        while time < 20.0 {
            let step = integrator.advance(&Kepler, 20.0).unwrap();
            (time, last) = (step.end_time, step.end);
        }
        near("the end", time, 20.0, 0.0);
        let error = distance(&last, 20.0);
        // Three revolutions, in which errors along the orbit grow: a thousand tolerances at most, and falling with them.
        assert!(error < 1e3 * tolerance && error < before, "{error:e} at {tolerance:e} after {before:e}");
        before = error;
    }
}

#[test]
fn evaluations_are_counted() {
    use std::cell::Cell;
    struct Counting(Cell<usize>);
    impl<S: Scalar> System<S, 1> for Counting {
        fn derivative(&self, _: S, state: &[S; 1]) -> [S; 1] {
            self.0.set(self.0.get() + 1);
            [-state[0] * state[0]]
        }
    }
    impl StepBounds<1> for Counting {
        fn magnitudes(&self) -> [f64; 1] {
            [1.0]
        }
    }
    let interrupt = AtomicBool::new(false);
    let system = Counting(Cell::new(0));
    let mut integrator = Integrator::new(&system, 0.0, [1.0], limits(1e-12, &interrupt));
    for _ in 0..5 {
        let step = integrator.advance(&system, 100.0).unwrap();
        integrator.shorten(&system, &step, step.time(0.5));
    }
    assert_eq!(integrator.statistics().evaluations, system.0.get());
    let step = integrator.advance(&system, 100.0).unwrap();
    let before = system.0.get();
    step.interpolant(&system);
    assert_eq!(system.0.get(), before + Interpolant::<1>::EVALUATIONS);
}

#[test]
fn a_step_that_is_not_finite_is_rejected() {
    /// Falls to the edge of what it is defined on: y = (1 - t)², not a number beyond y = 0.
    struct Edge;
    impl<S: Scalar> System<S, 1> for Edge {
        fn derivative(&self, _: S, state: &[S; 1]) -> [S; 1] {
            [state[0].sqrt() * -2.0]
        }
    }
    impl StepBounds<1> for Edge {
        fn magnitudes(&self) -> [f64; 1] {
            [1.0]
        }
    }
    let interrupt = AtomicBool::new(false);
    let mut integrator = Integrator::new(&Edge, 0.0, [1.0], limits(1e-6, &interrupt));
    let mut time = 0.0;
    while time < 0.999 {
        let step = integrator.advance(&Edge, 0.999).unwrap();
        time = step.end_time;
        near("y", step.end[0], (1.0 - time) * (1.0 - time), 1e-5);
    }
    // Beyond the edge there is nothing to step to.
    let error = loop {
        match integrator.advance(&Edge, 2.0) {
            Ok(step) => assert!(step.end[0].is_finite() && step.end_time < 1.0 + 1e-3),
            Err(error) => break error,
        }
    };
    assert!(matches!(error, IntegrationError::StepTooSmall { .. } | IntegrationError::StepLimit { .. }), "{error}");
}

#[test]
fn a_system_without_a_finite_slope_is_refused() {
    struct Nowhere;
    impl<S: Scalar> System<S, 1> for Nowhere {
        fn derivative(&self, _: S, _: &[S; 1]) -> [S; 1] {
            [S::from(f64::NAN)]
        }
    }
    impl StepBounds<1> for Nowhere {
        fn magnitudes(&self) -> [f64; 1] {
            [1.0]
        }
    }
    let interrupt = AtomicBool::new(false);
    let error = Integrator::new(&Nowhere, 0.0, [1.0], limits(1e-6, &interrupt)).advance(&Nowhere, 1.0).unwrap_err();
    assert_eq!(error, IntegrationError::StepTooSmall { time: 0.0 });
}

#[test]
fn the_flag_ends_the_integration_before_the_next_step() {
    let interrupt = AtomicBool::new(false);
    let mut integrator = Integrator::new(&Kepler, 0.0, PERIAPSIS, limits(1e-6, &interrupt));
    let step = integrator.advance(&Kepler, 100.0).unwrap();
    interrupt.store(true, std::sync::atomic::Ordering::Relaxed);
    let error = integrator.advance(&Kepler, 100.0).unwrap_err();
    assert_eq!(error, IntegrationError::Interrupted { time: step.end_time });
}

/// The derivative in dual numbers: the same digits as in `f64`, and the slopes of central differences.
fn duals_agree<F: System<f64, 6> + System<Dual64, 6>>(what: &str, motion: &F, state: [f64; 6]) {
    let plain = motion.derivative(0.0, &state);
    for component in 0..6 {
        let step = 1e-6 * state[component].abs().max(1.0);
        let seeded: [Dual64; 6] =
            std::array::from_fn(|i| Dual64::new(state[i], if i == component { 1.0 } else { 0.0 }));
        let dual = motion.derivative(0.0.into(), &seeded);
        let at = |offset: f64| {
            let mut moved = state;
            moved[component] += offset;
            motion.derivative(0.0, &moved)
        };
        let (above, below) = (at(step), at(-step));
        for i in 0..6 {
            assert_eq!(dual[i].re.to_bits(), plain[i].to_bits(), "{what}: value {i}");
            let difference = (above[i] - below[i]) / (2.0 * step);
            // A central difference has a rounding of 1e-16 of the value over the step.
            let rounding = 1e-15 * plain[i].abs() / step + 1e-14;
            near(
                &format!("{what}: slope {i} by {component}"),
                dual[i].eps,
                difference,
                1e-6 * difference.abs() + rounding,
            );
        }
    }
}

#[test]
fn the_derivative_in_dual_numbers_has_the_same_value_and_the_right_slopes() {
    let case = target_2();
    // At 20 km, where every force counts.
    let mut state = reentry::FlightPath::from_planet_fixed(&case.initial_state);
    state.radius = 6_398_137.0;
    duals_agree("cartesian", &Cartesian(case.forces()), state.to_planet_fixed().into());
    duals_agree("spherical", &Spherical(case.forces()), state.into());
}

#[test]
fn steps_followed_in_dual_numbers_end_at_the_same_digits_and_with_the_right_slopes() {
    let interrupt = AtomicBool::new(false);
    let fly = |speed: f64, tolerance: f64| {
        let mut integrator = Integrator::new(&Kepler, 0.0, [0.5, 0.0, 0.0, speed], limits(tolerance, &interrupt));
        let mut steps = Vec::new();
        while steps.last().is_none_or(|step: &Step<4>| step.end_time < 5.0) {
            steps.push(integrator.advance(&Kepler, 5.0).unwrap());
        }
        steps
    };
    let steps = fly(PERIAPSIS[3], 1e-10);
    let [x, y, vx, vy] = PERIAPSIS;
    let start = [x.into(), y.into(), vx.into(), Dual64::new(vy, 1.0)];
    let end = steps.iter().fold(start, |state, step| follow(&Kepler, &state, step.start_time, step.length()));
    let last = |steps: Vec<Step<4>>| steps.last().unwrap().end;
    assert_eq!(end.map(|x| x.re.to_bits()), last(steps).map(f64::to_bits));
    let (above, below) = (last(fly(vy + 1e-5, 1e-13)), last(fly(vy - 1e-5, 1e-13)));
    for i in 0..4 {
        relative("slope by the initial speed", end[i].eps, (above[i] - below[i]) / 2e-5, 1e-6);
    }
}

/// A quantity along a step of one second, by its value and rate.
fn curve(value: fn(Dual64) -> Dual64) -> impl Fn(f64) -> Dual64 {
    move |part| value(Dual64::new(part, 1.0))
}

fn first_fall(value: fn(Dual64) -> Dual64) -> Option<f64> {
    let curve = curve(value);
    event::first_fall(curve(0.0), curve(1.0), 1.0, &curve)
}

#[test]
fn falls_are_found_where_they_first_happen() {
    let check = |what: &str, found: Option<f64>, expected: Option<f64>| match (found, expected) {
        (Some(found), Some(expected)) => near(what, found, expected, 1e-12),
        (found, expected) => assert_eq!(found, expected, "{what}"),
    };
    check("a fall through zero", first_fall(|t| -t + 0.3), Some(0.3));
    check("a rise through zero is none", first_fall(|t| t - 0.3), None);
    check("a dip below zero", first_fall(|t| (t - 0.6) * (t - 0.6) - 0.01), Some(0.5));
    check("a short dip in a quarter of the step", first_fall(|t| (t - 0.62) * (t - 0.62) * 100.0 - 0.01), Some(0.61));
    check("a dip that stays above", first_fall(|t| (t - 0.6) * (t - 0.6) + 0.01), None);
    check("up, then down through zero", first_fall(|t| t * (-t + 0.7)), Some(0.7));
    check(
        "from just below, up and down",
        first_fall(|t| t * (-t + 0.7) - 1e-3),
        Some(f64::midpoint(0.7, 0.486_f64.sqrt())),
    );
    check("from below, never above", first_fall(|t| t * (-t + 0.7) - 1.0), Some(0.35));
    check("far from zero", first_fall(|t| t + 7.0), None);
}

/// Cubics by their values and rates at the ends of a step, 1 s long. Of those that are said to stay above zero, none comes to zero inside that falls
/// evenly, or whose rate inside is at most half as much again as at the ends. Zeros of those that fall evenly are found without a look at quarters.
#[test]
fn what_stays_above_zero_by_its_ends_does_so_inside() {
    let steps = || (-8..=8).map(|step| 0.25 * f64::from(step));
    let ends = steps().chain([-0.05, 0.05]);
    let rates = || steps().chain([-8.0, -6.0, -4.0, -0.1, 0.1, 4.0, 6.0, 8.0]);
    let [mut above, mut below, mut falls] = [0; 3];
    for (end, start_rate, end_rate) in ends.flat_map(|e| rates().flat_map(move |r| rates().map(move |q| (e, r, q)))) {
        let start = 1.0;
        let bend = 3.0 * (end - start) - 2.0 * start_rate - end_rate;
        let twist = 2.0 * (start - end) + start_rate + end_rate;
        let cubic = |part: f64| {
            let value = start + part * (start_rate + part * (bend + part * twist));
            Dual64::new(value, start_rate + part * (2.0 * bend + 3.0 * part * twist))
        };
        let inside: Vec<_> = (0..=200).map(|part| cubic(f64::from(part) / 200.0)).collect();
        let greatest_rate = inside.iter().map(|at| at.eps.abs()).fold(0.0, f64::max);
        let is_tame = greatest_rate <= 1.5 * f64::max(start_rate.abs(), end_rate.abs());
        let is_near_mean = |rate: f64| 2.0 * rate < end - start && rate > 2.0 * (end - start);
        let is_even = is_near_mean(start_rate) && is_near_mean(end_rate);
        let least = inside.iter().map(|at| at.re).fold(f64::INFINITY, f64::min);
        let told = || format!("from 1 at {start_rate} to {end} at {end_rate}");
        if event::stays_above(cubic(0.0), cubic(1.0), 1.0) {
            above += 1;
            assert!(least > 0.0 || !is_tame && !is_even, "{}", told());
        } else {
            below += i32::from(least <= 0.0);
        }
        if end < 0.0 && is_even {
            falls += 1;
            let first = Cell::new(None);
            let observed = |part: f64| {
                first.set(first.get().or(Some(part)));
                cubic(part)
            };
            let fall =
                event::first_fall(cubic(0.0), cubic(1.0), 1.0, &observed).unwrap_or_else(|| panic!("{}", told()));
            assert!(cubic(fall).re.abs() < 1e-12, "{}", told());
            near("where it looks first", first.get().unwrap(), start / (start - end), 1e-12);
        }
    }
    assert!(above > 300 && below > 1000 && falls > 30, "the test hardly tells: {above}, {below}, {falls}");
}

/// (5 - t) (20 + t + t²/10), as it is at t = 0 and was at t = -2.
#[test]
fn a_fall_along_a_cubic_is_predicted_where_it_is() {
    let cubic = |time: f64| {
        let time = Dual64::new(time, 1.0);
        (-time + 5.0) * (time * time * 0.1 + time + 20.0)
    };
    let predicted = event::predicted_fall(cubic(0.0), Some((2.0, cubic(-2.0))), 10.0).unwrap();
    near("the time", predicted.time, 5.0, 1e-12);
    assert!(predicted.uncertainty > 0.01 && predicted.uncertainty < 1.5, "{predicted:?}");
    // By the rate alone: 100 at -15 per second.
    let straight = event::predicted_fall(cubic(0.0), None, 10.0).unwrap();
    near("the time by the rate", straight.time, 100.0 / 15.0, 1e-12);
    // It is too far, it has come, it rises.
    assert_eq!(event::predicted_fall(cubic(0.0), None, 1.0), None);
    assert_eq!(event::predicted_fall(cubic(5.0), None, 1.0), None);
    assert_eq!(event::predicted_fall(-cubic(6.0), None, 1.0), None);
}

/// y' = cos t, and from every whole t on with another second derivative: of which the system tells, or not.
struct Cornered {
    tells: bool,
}

impl System<f64, 1> for Cornered {
    fn derivative(&self, time: f64, _: &[f64; 1]) -> [f64; 1] {
        let (whole, part) = (time.floor(), time.fract());
        [time.cos() + 0.1 * part * (1.0 - part) * (whole * 1.7).sin()]
    }
}

impl StepBounds<1> for Cornered {
    fn magnitudes(&self) -> [f64; 1] {
        [1.0]
    }

    fn time_to_corner(&self, time: f64, _: &[f64; 1], _: &[f64; 1], least: f64) -> f64 {
        if self.tells { (time + least).ceil() - time } else { f64::INFINITY }
    }
}

#[test]
fn steps_that_are_rejected_for_a_corner_end_there() {
    let fly = |tells: bool| {
        let system = Cornered { tells };
        let interrupt = AtomicBool::new(false);
        let mut integrator = Integrator::new(&system, 0.0, [1.0], limits(1e-10, &interrupt));
        while integrator.time() < 20.0 {
            integrator.advance(&system, 20.0).unwrap();
        }
        // Of each parabola the integral is 1/60.
        let exact = 1.0 + 20.0_f64.sin() + (0..20).map(|whole| (f64::from(whole) * 1.7).sin() / 60.0).sum::<f64>();
        near("the end", integrator.state()[0], exact, 1e-8);
        integrator.statistics()
    };
    let [told, not_told] = [true, false].map(fly);
    assert!(told.evaluations * 2 < not_told.evaluations, "{told:?} of {not_told:?}");
    assert!(told.rejected_steps * 2 < not_told.rejected_steps, "{told:?} of {not_told:?}");
    // Less than one a corner: the next ones are not tried across.
    assert!(told.rejected_steps < 20, "{told:?}");
}

#[test]
fn maxima_are_found_inside_and_not_at_the_ends() {
    let maximum = |value: fn(Dual64) -> Dual64| {
        let curve = curve(value);
        event::maximum(curve(0.0), curve(1.0), &curve)
    };
    near("inside", maximum(|t| -(t - 0.3) * (t - 0.3)).unwrap(), 0.3, 1e-12);
    assert_eq!(maximum(|t| t), None);
    assert_eq!(maximum(|t| -t), None);
    assert_eq!(maximum(|t| (t - 0.3) * (t - 0.3)), None);
}
