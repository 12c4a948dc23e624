//! What happens inside a step: the first fall of a quantity through zero, and its maximum.
//!
//! A quantity comes with its rate of change per second, as a dual number, at the two ends of the step and,
//! where the ends ask for a closer look, at any part (0 to 1) of the step.

use num_dual::Dual64;

use crate::root;

/// A quantity inside a step, at parts of it from 0 to 1.
pub trait Inside {
    /// The quantity with its rate of change per second.
    fn at(&self, part: f64) -> Dual64;

    /// The quantity alone: the value of that with its rate, to the last digit.
    fn value_at(&self, part: f64) -> f64;
}

impl<F: Fn(f64) -> Dual64> Inside for F {
    fn at(&self, part: f64) -> Dual64 {
        self(part)
    }

    fn value_at(&self, part: f64) -> f64 {
        self(part).re
    }
}

/// The part of the step at which the quantity first falls to zero, if it does.
///
/// A quantity that dips below zero and is back at the end of the step is found as well.
/// One that starts at or below zero must rise first; while it sinks or comes down without having been positive,
/// the fall is where it turns down.
pub fn first_fall(start: Dual64, end: Dual64, length: f64, inside: &impl Inside) -> Option<f64> {
    if stays_above(start, end, length) {
        return None;
    }
    if falls_evenly(start, end, length) {
        return crossing_after((0.0, start), (1.0, end), inside);
    }
    let mut from = (0.0, start);
    for part in [0.25, 0.5, 0.75, 1.0] {
        let to = (part, if part < 1.0 { inside.at(part) } else { end });
        let fall = fall_between(from, to, length, inside);
        if fall.is_some() {
            return fall;
        }
        from = to;
    }
    None
}

/// Whether a quantity is above zero at both ends of a step and stays so between them: at the rates there it falls all the way, or is too far from zero to
/// come down and go up again in the time of the step.
pub fn stays_above(start: Dual64, end: Dual64, length: f64) -> bool {
    let is_far = || start.re + end.re > REACH * length * start.eps.abs().max(end.eps.abs());
    start.re > 0.0 && end.re > 0.0 && (falls_evenly(start, end, length) || is_far())
}

/// Whether the ends of a step tell of a fall: the quantity is at or below zero at the end, or falls and rises again, with tangents that
/// meet below zero. What [`first_fall`] finds beyond that falls and rises more than once in a step.
pub fn seems_to_fall(start: Dual64, end: Dual64, length: f64) -> bool {
    let dips = || start.eps < 0.0 && end.eps > 0.0 && tangents_meet((0.0, start), (1.0, end), length) < 0.0;
    end.re <= 0.0 || dips()
}

/// Whether a quantity starts above zero and falls all the way through a step: its rates at both ends are near the mean one. Then it crosses zero once
/// at most, and need not be looked at in quarters of the step.
fn falls_evenly(start: Dual64, end: Dual64, length: f64) -> bool {
    let mean = (end.re - start.re) / length;
    let is_near_mean = |rate: f64| rate > UNEVEN * mean && UNEVEN * rate < mean;
    start.re > 0.0 && is_near_mean(start.eps) && is_near_mean(end.eps)
}

/// The part of the step at which the quantity first comes from above zero to zero.
///
/// The inside of the step is looked at where the ends ask for it: the quantity is above zero at one end alone, or its rate changes sign
/// between them, so that it turns inside. Where `closely`, as between the entries of tables, it may turn more than once: then also where
/// four times the greater rate of the two ends would carry it to zero. An extremum that [`maximum`] finds is found here as well.
pub fn first_crossing(start: Dual64, end: Dual64, length: f64, closely: bool, inside: &impl Inside) -> Option<f64> {
    if !may_cross(start, end, length, closely) {
        return None;
    }
    if !closely && falls_evenly(start, end, length) {
        return crossing_after((0.0, start), (1.0, end), inside);
    }
    let mut from = (0.0, start);
    for part in [0.25, 0.5, 0.75, 1.0] {
        let to = (part, if part < 1.0 { inside.at(part) } else { end });
        let crossing = crossing_between(from, to, inside);
        if crossing.is_some() {
            return crossing;
        }
        from = to;
    }
    if dips(start, end) || rises(start, end) {
        // Between the quarters the rates may tell of no turn, or of another.
        return crossing_between((0.0, start), (1.0, end), inside);
    }
    None
}

/// Whether [`first_crossing`] looks inside the step.
pub fn may_cross(start: Dual64, end: Dual64, length: f64, closely: bool) -> bool {
    let reach = || 4.0 * length * start.eps.abs().max(end.eps.abs());
    match (start.re > 0.0, end.re > 0.0) {
        (true, false) => true,
        (true, true) => dips(start, end) || closely && start.re.min(end.re) <= reach(),
        (false, false) => rises(start, end) || closely && start.re.max(end.re) >= -reach(),
        (false, true) => false,
    }
}

/// Whether the rates at the ends of a step tell of a minimum inside.
fn dips(start: Dual64, end: Dual64) -> bool {
    start.eps < 0.0 && end.eps > 0.0
}

/// Whether they tell of a maximum inside.
pub fn rises(start: Dual64, end: Dual64) -> bool {
    start.eps > 0.0 && end.eps < 0.0
}

/// The part of the step at which the quantity is greatest, if it rises at the start and falls at the end.
pub fn maximum(start: Dual64, end: Dual64, inside: &impl Inside) -> Option<f64> {
    rises(start, end).then(|| turning_point((0.0, start), (1.0, end), inside))
}

/// When a step is expected to reach a place that will cut it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictedCrossing {
    /// From now, s.
    pub time: f64,
    /// By how much that may be off, s.
    pub uncertainty: f64,
}

impl PredictedCrossing {
    /// The first of several.
    pub fn first(all: impl IntoIterator<Item = Self>) -> Option<Self> {
        all.into_iter().min_by(|a, b| a.time.total_cmp(&b.time))
    }
}

/// Whether a falling quantity may reach zero within a time, s, at its rate.
fn may_fall_within(now: Dual64, within: f64) -> bool {
    now.re > 0.0 && now.eps < 0.0 && now.re < -2.0 * within * now.eps
}

/// When a falling quantity will reach zero, if that may be within a time, s: extrapolated by the cubic through its values and rates at both ends of
/// the last step. `before`: the length of that step, s, and the quantity at its start; where there is none, the present rate is extrapolated.
pub fn predicted_fall(now: Dual64, before: Option<(f64, Dual64)>, within: f64) -> Option<PredictedCrossing> {
    if !may_fall_within(now, within) {
        return None;
    }
    let straight = -now.re / now.eps;
    let Some((length, before)) = before else {
        return Some(PredictedCrossing { time: straight, uncertainty: straight });
    };
    let twist = (2.0 * (before.re - now.re) / length + now.eps + before.eps) / (length * length);
    let half_bend = 0.5 * (now.eps - before.eps) / length;
    let zero = |bend: f64, twist: f64| {
        let value = |time: f64| now.re + time * (now.eps + time * (bend + time * twist));
        let rate = |time: f64| now.eps + time * (2.0 * bend + 3.0 * time * twist);
        let found = (0..5).fold(straight, |time, _| time - value(time) / rate(time));
        (found > 0.0 && found.is_finite()).then_some(found)
    };
    let time = zero(half_bend + 1.5 * twist * length, twist)?;
    // The parabola tells how far the cubic may be trusted.
    let uncertainty = zero(half_bend, 0.0).map_or(time, |other| (time - other).abs());
    Some(PredictedCrossing { time, uncertainty })
}

/// A part of the step, and the quantity there.
type Sample = (f64, Dual64);

/// A fall; of a quantity that never is above zero, where it turns down.
fn fall_between(a: Sample, b: Sample, length: f64, inside: &impl Inside) -> Option<f64> {
    if a.1.eps > 0.0 && b.1.eps < 0.0 {
        let part = turning_point(a, b, inside);
        let top = (part, inside.at(part));
        return if top.1.re <= 0.0 { Some(part) } else { crossing_after(top, b, inside) };
    }
    if a.1.re <= 0.0 {
        return (a.1.eps < 0.0).then_some(a.0);
    }
    if a.1.eps < 0.0 && b.1.eps > 0.0 && b.1.re > 0.0 && tangents_meet(a, b, length) >= 0.0 {
        return None;
    }
    crossing_between(a, b, inside)
}

/// A fall from above zero.
fn crossing_between(a: Sample, b: Sample, inside: &impl Inside) -> Option<f64> {
    let turning = || {
        let part = turning_point(a, b, inside);
        (part, inside.at(part))
    };
    if a.1.eps > 0.0 && b.1.eps < 0.0 {
        return if b.1.re <= 0.0 { crossing_after(turning(), b, inside) } else { None };
    }
    if a.1.re <= 0.0 {
        return None;
    }
    if a.1.eps < 0.0 && b.1.eps > 0.0 && b.1.re > 0.0 {
        return crossing_after(a, turning(), inside);
    }
    crossing_after(a, b, inside)
}

/// The zero between a place above it and one that is not.
fn crossing_after(above: Sample, end: Sample, inside: &impl Inside) -> Option<f64> {
    let bracketed = || root::bracketed(|part| inside.value_at(part), (above.0, above.1.re), (end.0, end.1.re), 0.0);
    (above.1.re > 0.0 && end.1.re <= 0.0).then(bracketed)
}

/// Where the rate changes sign.
fn turning_point(a: Sample, b: Sample, inside: &impl Inside) -> f64 {
    root::bracketed(|part| inside.at(part).eps, (a.0, a.1.eps), (b.0, b.1.eps), TURNING_POINT_RESOLUTION)
}

/// A quantity falls evenly through a step if its rates at the ends differ from the mean one by less than this factor.
const UNEVEN: f64 = 2.0;

/// In a step a quantity changes at no more than so many times the greater of its rates at the ends.
const REACH: f64 = 1.5;

/// Parts of a step to which a turning point is located; the value there is off by the square of it.
const TURNING_POINT_RESOLUTION: f64 = 1e-9;

/// The value at which the tangents of the two ends meet: a quantity that falls, then rises, stays above it.
fn tangents_meet(a: Sample, b: Sample, length: f64) -> f64 {
    let length = (b.0 - a.0) * length;
    let time = (b.1.re - a.1.re - b.1.eps * length) / (a.1.eps - b.1.eps);
    a.1.re + a.1.eps * time
}
