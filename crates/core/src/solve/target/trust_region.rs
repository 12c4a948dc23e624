//! Gauss-Newton steps within a region in which they are trusted, and within the range of the numbers.
//!
//! # Reference
//! J. Nocedal and S. J. Wright, Numerical Optimization, 2nd edition, 2006, chapters 4 and 10.

use nalgebra::{DMatrix, DVector, Dyn, SVD};

use super::search::{Accuracy, Halt, Point, Search};

/// Why a descent came to rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Rest {
    /// All goals are nearly met.
    Near,
    /// It goes where another descent went.
    Known,
    /// No small change comes nearer.
    Stationary,
    /// Beyond, flights end in another way, or fail.
    Edge,
}

/// The slopes at a point.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Slopes {
    /// Of the residuals by parts of the ranges.
    pub(super) residuals: DMatrix<f64>,
    /// Of the shown numbers by the numbers, in their units; none where there is none.
    pub(super) shown: Vec<Vec<Option<f64>>>,
}

/// The step of the differences, in parts of the ranges.
const STEP: f64 = 1e-4;
/// The radius with which a descent begins, and the greatest, in parts of the ranges.
const RADII: [f64; 2] = [0.3, 0.6];
/// A descent with a smaller radius rests.
const SMALLEST: f64 = 1e-8;
/// Residuals with which a goal is nearly met.
const NEAR: f64 = 3.0;
/// Slopes by which a step brings at least this share of what they predict are good enough to be updated for the next one.
const GOOD: f64 = 0.8;
/// The steps at most.
const MOST_STEPS: usize = 60;
/// The part by which the residuals must fall, at least once in so many steps.
const PROGRESS: (f64, usize) = (1e-3, 8);
/// Where no number has residuals that fall by more than this part over its range, there is nowhere to go.
const FLAT: f64 = 1e-6;
/// Singular values that are smaller parts of the greatest are none.
const SINGULAR: f64 = 1e-10;
/// Nearer to a known solution than this, in parts of the ranges, a descent leads there.
const SAME: f64 = 1e-3;

/// Goes down from a point, whose flight counts, until it rests.
pub(super) fn descend<E>(
    search: &mut Search<E>,
    start: usize,
    mut point: Point,
    known: &[Vec<f64>],
) -> Result<(Point, Rest), Halt<E>> {
    let mut radius = RADII[0];
    let mut slow = 0;
    let mut updated: Option<DMatrix<f64>> = None;
    for _ in 0..MOST_STEPS {
        if point.worst() <= NEAR {
            return Ok((point, Rest::Near));
        }
        if known.iter().any(|known| search.distance(known, &point.place) < SAME) {
            return Ok((point, Rest::Known));
        }
        // What a good step has told of the slopes will do for the next one.
        let mut is_exact = updated.is_none();
        let mut of_point = match updated.take() {
            Some(updated) => updated,
            None => slopes(search, &point, Accuracy::OfCase)?.residuals,
        };
        let before = point.merit();
        let mut at_edge = false;
        loop {
            let step = step(search, &point, &of_point, radius);
            let length = step.norm();
            let expected = before - predicted(&point, &of_point, &step);
            let is_at_rest = length < SMALLEST || expected <= FLAT * FLAT * before;
            if is_at_rest && is_exact {
                return Ok((point, if at_edge { Rest::Edge } else { Rest::Stationary }));
            }
            let next = if is_at_rest {
                None
            } else {
                let place: Vec<_> = point.place.iter().zip(step.iter()).map(|(place, step)| place + step).collect();
                Some(search.flown(&place, Accuracy::OfCase)?)
            };
            let share = next.as_ref().map_or(0.0, |next| (before - next.merit()) / expected);
            if !is_exact && share < GOOD {
                (of_point, is_exact) = (slopes(search, &point, Accuracy::OfCase)?.residuals, true);
                continue;
            }
            let Some(next) = next else { continue };
            let accepted = share > 1e-4;
            search.record(start, &next, radius, accepted);
            at_edge = !next.counts();
            radius = match share {
                _ if at_edge => 0.25 * length,
                share if share < 0.25 => 0.3 * length,
                share if share > 0.75 && length > 0.8 * radius => (2.0 * radius).min(RADII[1]),
                _ => radius,
            };
            if accepted {
                updated = (share > GOOD).then(|| update(search, &of_point, &point, &next)).flatten();
                point = next;
                break;
            }
        }
        slow = if point.merit() > (1.0 - PROGRESS.0).powi(2) * before { slow + 1 } else { 0 };
        if slow >= PROGRESS.1 {
            break;
        }
    }
    Ok((point, Rest::Stationary))
}

/// The slopes after a step, of those before it: changed the least with which they have the difference of the residuals along the step.
///
/// # Reference
/// C. G. Broyden, A class of methods for solving nonlinear simultaneous equations, Mathematics of Computation 19 (1965), 577-593.
fn update<E>(search: &Search<E>, slopes: &DMatrix<f64>, from: &Point, to: &Point) -> Option<DMatrix<f64>> {
    let way = DVector::from_vec(search.way(&from.place, &to.place));
    let square = way.norm_squared();
    let turn = |goal: usize| search.goals[goal].searched.turn.map(|turn| turn / search.goals[goal].searched.tolerance);
    let pairs = to.residuals.as_ref()?.iter().zip(from.residuals.as_ref()?).enumerate();
    let differences: Vec<_> = pairs.map(|(goal, (after, before))| on_circle(after - before, turn(goal))).collect();
    let error = DVector::from_vec(differences) - slopes * &way;
    (square > 0.0).then(|| slopes + error * way.transpose() / square)
}

/// The slopes at a point: along the steps of its flight or, by numbers for which a goal has none there, by central differences, or to one side
/// where flights on the other do not count.
pub(super) fn slopes<E>(search: &mut Search<E>, point: &Point, accuracy: Accuracy) -> Result<Slopes, Halt<E>> {
    let (goals, numbers) = (search.goals.len(), search.numbers.len());
    let mut residuals = DMatrix::zeros(goals, numbers);
    let mut shown = vec![vec![None; numbers]; goals];
    let exact = search.derivatives(point, accuracy)?.zip(point.residuals.as_ref());
    for number in 0..numbers {
        if let Some((exact, of_point)) = &exact
            && (0..goals).all(|goal| exact.searched[goal][number].is_finite() && exact.shown[goal][number].is_finite())
        {
            let width = search.numbers[number].width();
            for goal in 0..goals {
                let requirement = &search.goals[goal].searched;
                // Within a range, nothing is missed.
                let is_missed = requirement.is_equality() || of_point[goal] != 0.0;
                let slope = exact.searched[goal][number] * width / requirement.tolerance;
                residuals[(goal, number)] = if is_missed { slope } else { 0.0 };
                shown[goal][number] = Some(exact.shown[goal][number]);
            }
            continue;
        }
        let mut beside = |step: f64| -> Result<Option<Point>, Halt<E>> {
            let mut place = point.place.clone();
            place[number] += step;
            let is_beyond = !search.numbers[number].is_cyclic && !(0.0..=1.0).contains(&place[number]);
            if is_beyond { Ok(None) } else { search.flown(&place, accuracy).map(|it| Some(it).filter(Point::counts)) }
        };
        let [below, above] = [beside(-STEP)?, beside(STEP)?];
        let (below, above) = (below.as_ref().unwrap_or(point), above.as_ref().unwrap_or(point));
        let way = search.way(&below.place, &above.place)[number];
        let (Some(low), Some(high)) = (&below.residuals, &above.residuals) else { continue };
        if way <= 0.0 {
            continue;
        }
        let width = search.numbers[number].width();
        for goal in 0..goals {
            let of_goal = &search.goals[goal];
            let turn = of_goal.searched.turn.map(|turn| turn / of_goal.searched.tolerance);
            residuals[(goal, number)] = on_circle(high[goal] - low[goal], turn) / way;
            shown[goal][number] = below.shown[goal]
                .zip(above.shown[goal])
                .map(|(low, high)| on_circle(high - low, of_goal.shown.turn) / (way * width));
        }
    }
    Ok(Slopes { residuals, shown })
}

fn on_circle(difference: f64, turn: Option<f64>) -> f64 {
    turn.map_or(difference, |turn| difference - turn * (difference / turn).round())
}

/// The merit that the slopes predict after a step.
fn predicted(point: &Point, slopes: &DMatrix<f64>, step: &DVector<f64>) -> f64 {
    (residuals_of(point) + slopes * step).norm_squared()
}

fn residuals_of(point: &Point) -> DVector<f64> {
    DVector::from_vec(point.residuals.clone().unwrap_or_default())
}

/// The step of least residuals within a radius and the range; numbers at an end of their range stay there if they would leave it.
pub(super) fn step<E>(search: &Search<E>, point: &Point, slopes: &DMatrix<f64>, radius: f64) -> DVector<f64> {
    let numbers = search.numbers.len();
    let residuals = residuals_of(point);
    let mut held = vec![false; numbers];
    loop {
        let free: Vec<_> = (0..numbers).filter(|number| !held[*number]).collect();
        let mut step = DVector::zeros(numbers);
        if free.is_empty() {
            return step;
        }
        let of_free = slopes.select_columns(&free);
        let short = shortest(&of_free, &residuals, radius);
        for (number, part) in free.iter().zip(short.iter()) {
            step[*number] = *part;
        }
        let leaves = |number: &usize| {
            let place = point.place[*number];
            let is_cyclic = search.numbers[*number].is_cyclic;
            !is_cyclic && (place <= 0.0 && step[*number] < 0.0 || place >= 1.0 && step[*number] > 0.0)
        };
        let leaving: Vec<_> = free.iter().copied().filter(leaves).collect();
        if leaving.is_empty() {
            for number in 0..numbers {
                if !search.numbers[number].is_cyclic {
                    let place = point.place[number];
                    step[number] = (place + step[number]).clamp(0.0, 1.0) - place;
                }
            }
            return step;
        }
        for number in leaving {
            held[number] = true;
        }
    }
}

/// The step of least residuals, and of those the shortest, no longer than a radius.
///
/// ```text
/// p = -V diag(σ / (σ² + λ)) Uᵀ r
/// ```
fn shortest(slopes: &DMatrix<f64>, residuals: &DVector<f64>, radius: f64) -> DVector<f64> {
    let none = DVector::zeros(slopes.ncols());
    let Some(decomposed) = decomposition(slopes) else { return none };
    let (Some(u), Some(v_t)) = (&decomposed.u, &decomposed.v_t) else { return none };
    let values = &decomposed.singular_values;
    let greatest = values.max();
    if greatest <= 0.0 || !greatest.is_finite() {
        return none;
    }
    let along = u.transpose() * residuals;
    let step = |damping: f64| {
        let parts = values.iter().zip(along.iter()).map(|(value, along)| {
            if *value > SINGULAR * greatest { -value * along / (value * value + damping) } else { 0.0 }
        });
        DVector::from_iterator(values.len(), parts)
    };
    let mut parts = step(0.0);
    if parts.norm() > radius {
        // The damping with which the step has the radius: between none and that of a step that is too short.
        let (mut low, mut high) =
            ((SINGULAR * greatest).powi(2), (greatest * greatest).max(greatest * along.norm() / radius));
        for _ in 0..HALVINGS {
            let middle = (low * high).sqrt();
            if step(middle).norm() > radius { low = middle } else { high = middle }
        }
        parts = step(high);
    }
    v_t.transpose() * parts
}

/// The singular values and vectors of slopes; none where there are no slopes, or some that are no numbers.
pub(super) fn decomposition(slopes: &DMatrix<f64>) -> Option<SVD<f64, Dyn, Dyn>> {
    let is_sound = !slopes.is_empty() && slopes.iter().all(|slope| slope.is_finite());
    is_sound.then(|| SVD::try_new(slopes.clone(), true, true, f64::EPSILON, MOST_ROTATIONS)).flatten()
}

/// Of the iteration for singular values, which takes a few for each.
const MOST_ROTATIONS: usize = 1000;

/// Halvings of the logarithm of the damping.
const HALVINGS: usize = 40;
