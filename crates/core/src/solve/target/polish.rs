//! The end of a search: solutions are flown finely, and what there is to tell of them is found.

use nalgebra::{DMatrix, DVector};

use super::Solution;
use super::search::{Accuracy, Halt, Point, Search};
use super::trust_region::{Slopes, decomposition, slopes, step};
use crate::trajectory::Termination;

/// A point that was flown finely.
pub(super) struct Polished {
    pub(super) point: Point,
    pub(super) solution: Solution,
    pub(super) is_reached: bool,
    slopes: DMatrix<f64>,
}

/// Residuals with which a solution is good.
const GOOD: f64 = 0.01;
/// Steps towards it at most.
const MOST_STEPS: usize = 6;
/// The length of a step at most, in parts of the ranges.
const RADIUS: f64 = 0.05;
/// Singular values that are smaller parts of the greatest are none.
const SINGULAR: f64 = 1e-8;
/// Steps by which a solution of several is drawn to the start, at most.
const MOST_DRAWS: usize = 8;
/// What is drawn by less, in scales, stays.
const DRAWN: f64 = 1e-3;

/// Takes a point that is nearly a solution to one; where there are many, to the one that is nearest to the start.
pub(super) fn polish<E>(search: &mut Search<E>, point: &Point) -> Result<Polished, Halt<E>> {
    let mut point = search.flown(&point.place, Accuracy::Fine)?;
    let mut of_point = slopes(search, &point, Accuracy::Fine)?;
    approach(search, &mut point, &mut of_point)?;
    let mut polished = told(search, point, &of_point);
    if polished.is_reached && !polished.solution.is_isolated {
        for _ in 0..MOST_DRAWS {
            let Some(nearer) = drawn(search, &polished)? else { break };
            polished = nearer;
        }
    }
    Ok(polished)
}

/// Flies a point finely, and tells of it.
pub(super) fn tell<E>(search: &mut Search<E>, point: Point) -> Result<Polished, Halt<E>> {
    let fine = search.flown(&point.place, Accuracy::Fine)?;
    // At an edge the fine flight may end otherwise.
    let point = if fine.counts() { fine } else { point };
    let of_point = slopes(search, &point, Accuracy::Fine)?;
    Ok(told(search, point, &of_point))
}

/// Tells of a point for whose slopes no time is left.
pub(super) fn hasten<E>(search: &Search<E>, point: Point) -> Polished {
    let (goals, numbers) = (search.goals.len(), search.numbers.len());
    let unknown = Slopes { residuals: DMatrix::zeros(goals, numbers), shown: vec![vec![None; numbers]; goals] };
    let mut polished = told(search, point, &unknown);
    polished.solution.free_direction = None;
    polished
}

/// How flights end beyond a point at an edge; none where they fail, or none does.
pub(super) fn beyond<E>(search: &mut Search<E>, polished: &Polished) -> Option<Termination> {
    let onward = step(search, &polished.point, &polished.slopes, RADIUS);
    for part in [1e-6, 1e-4, 1e-2, 1.0] {
        let place: Vec<_> =
            polished.point.place.iter().zip(onward.iter()).map(|(place, step)| place + part * step).collect();
        search.allow(1);
        match search.flown(&place, Accuracy::OfCase) {
            Ok(point) if !point.counts() => return point.end,
            Ok(_) => {}
            Err(_) => return None,
        }
    }
    None
}

/// Goes on to where all goals are met, and has the slopes there.
fn approach<E>(search: &mut Search<E>, point: &mut Point, of_point: &mut Slopes) -> Result<(), Halt<E>> {
    let mut is_stale = false;
    for _ in 0..MOST_STEPS {
        if point.worst() <= GOOD || !point.counts() {
            break;
        }
        let step = step(search, point, &of_point.residuals, RADIUS);
        let place: Vec<_> = point.place.iter().zip(step.iter()).map(|(place, step)| place + step).collect();
        let next = search.flown(&place, Accuracy::Fine)?;
        if next.merit() >= point.merit() {
            break;
        }
        is_stale = next.worst() <= 0.1 * point.worst();
        *point = next;
        if !is_stale {
            *of_point = slopes(search, point, Accuracy::Fine)?;
        }
    }
    if is_stale {
        *of_point = slopes(search, point, Accuracy::Fine)?;
    }
    Ok(())
}

/// A solution that is nearer to the start, if there is one: along what is free, and back to where all goals are met.
fn drawn<E>(search: &mut Search<E>, from: &Polished) -> Result<Option<Polished>, Halt<E>> {
    let start = search.start();
    let way = search.way(&from.point.place, &start);
    let scales: Vec<_> = search.numbers.iter().map(|number| number.scale / number.width()).collect();
    let scaled = DVector::from_iterator(way.len(), way.iter().zip(&scales).map(|(way, scale)| way / scale));
    let free = free_part(&in_scales(&from.slopes, &scales), scaled);
    if free.norm() < DRAWN {
        return Ok(None);
    }
    for part in [1.0, 0.25] {
        let place: Vec<_> = from
            .point
            .place
            .iter()
            .zip(free.iter())
            .zip(&scales)
            .map(|((at, free), scale)| at + part * free * scale)
            .collect();
        let mut point = search.flown(&place, Accuracy::Fine)?;
        if !point.counts() {
            continue;
        }
        let mut of_point = slopes(search, &point, Accuracy::Fine)?;
        approach(search, &mut point, &mut of_point)?;
        let polished = told(search, point, &of_point);
        if polished.is_reached && polished.solution.distance < from.solution.distance {
            return Ok(Some(polished));
        }
    }
    Ok(None)
}

/// The slopes of residuals by numbers in scales.
fn in_scales(slopes: &DMatrix<f64>, scales: &[f64]) -> DMatrix<f64> {
    let mut scaled = slopes.clone();
    for (mut column, scale) in scaled.column_iter_mut().zip(scales) {
        column *= *scale;
    }
    scaled
}

/// The part of a step that changes no residual.
fn free_part(slopes: &DMatrix<f64>, step: DVector<f64>) -> DVector<f64> {
    let Some(decomposed) = decomposition(slopes) else { return step };
    let Some(v_t) = decomposed.v_t else { return step };
    let greatest = decomposed.singular_values.max();
    let mut free = step;
    for (row, value) in v_t.row_iter().zip(decomposed.singular_values.iter()) {
        if *value > SINGULAR * greatest {
            let along = row.transpose();
            let part = along.dot(&free);
            free -= along * part;
        }
    }
    free
}

/// What there is to tell of a point.
fn told<E>(search: &Search<E>, point: Point, of_point: &Slopes) -> Polished {
    let numbers = search.numbers.len();
    let scales: Vec<_> = search.numbers.iter().map(|number| number.scale / number.width()).collect();
    let scaled = in_scales(&of_point.residuals, &scales);
    let values = decomposition(&scaled).map_or_else(Vec::new, |it| it.singular_values.iter().copied().collect());
    let [least, greatest] = [f64::min, f64::max].map(|of| values.iter().copied().reduce(of).unwrap_or_default());
    let rank = values.iter().filter(|value| **value > SINGULAR * greatest).count();
    let bound = |(number, place): (usize, &f64)| {
        let is_bound = !search.numbers[number].is_cyclic && (*place <= 0.0 || *place >= 1.0);
        is_bound.then_some((number, *place >= 1.0))
    };
    let is_isolated = rank == numbers;
    let solution = Solution {
        values: search.values(&point.place),
        misses: search.misses(&point),
        derivatives: of_point.shown.clone(),
        condition: (least > 0.0).then(|| greatest / least).filter(|condition| condition.is_finite()),
        is_isolated,
        free_direction: (!is_isolated).then(|| free_direction(search, &scaled)).flatten(),
        at_bounds: point.place.iter().enumerate().filter_map(bound).collect(),
        distance: search.scaled_distance(&search.start(), &point.place),
    };
    Polished { is_reached: point.worst() <= 1.0, point, solution, slopes: of_point.residuals.clone() }
}

/// A direction in which no residual changes, a scale long, in the units of the numbers: of several, that which is nearest to an axis.
fn free_direction<E>(search: &Search<E>, scaled: &DMatrix<f64>) -> Option<Vec<f64>> {
    let count = search.numbers.len();
    let axis =
        |number: usize| free_part(scaled, DVector::from_fn(count, |row, _| if row == number { 1.0 } else { 0.0 }));
    let longest = (0..count).map(axis).max_by(|one, other| one.norm().total_cmp(&other.norm()))?;
    let length = longest.norm();
    (length > 0.0).then(|| {
        let part = |(number, part): (&super::Number, &f64)| part / length * number.scale;
        search.numbers.iter().zip(longest.iter()).map(part).collect()
    })
}
