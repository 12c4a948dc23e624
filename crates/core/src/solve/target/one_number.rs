//! One number and one goal: every change of sign is bracketed, and every dip of the miss followed, so that no solution is left out.

use super::search::{Accuracy, Halt, Point, Search};
use crate::root::bracketed;

/// Edges between flights that end in different ways are located to this part of the range.
const EDGE: f64 = 1e-6;
/// A residual with which the goal is met.
const MET: f64 = 0.01;
/// The distance from a solution that lies on a sample to the samples in its place, in parts of the range.
const ASIDE: f64 = 1e-5;
/// A dip is located to this part of the range.
const DIP: f64 = 1e-8;
/// Trials for it at most.
const MOST_TRIALS: usize = 60;
/// To this one first: a miss that then has hardly fallen has no zero.
const COARSE: f64 = 1e-3;
/// The smaller part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Where the miss of a goal is zero, and where it comes nearest without being so.
pub(super) struct Found {
    /// Flights that meet the goal.
    pub(super) roots: Vec<Point>,
    /// The least misses of dips that have no zero.
    pub(super) dips: Vec<Point>,
}

/// The flights about one goal.
struct Line<'s, 'a, E> {
    search: &'s mut Search<'a, E>,
    goal: usize,
    roots: Vec<Point>,
    dips: Vec<Point>,
}

/// Finds all from the samples of a scan.
pub(super) fn follow<E>(search: &mut Search<E>, mut points: Vec<Point>, goal: usize) -> Result<Found, Halt<E>> {
    points.sort_by(|one, other| one.place[0].total_cmp(&other.place[0]));
    points.dedup_by(|one, other| one.place[0].to_bits() == other.place[0].to_bits());
    let mut line = Line { search, goal, roots: Vec::new(), dips: Vec::new() };
    line.locate_edges(&mut points)?;
    line.step_over_roots(&mut points)?;
    for pair in points.windows(2) {
        line.bracket(&pair[0], &pair[1])?;
    }
    line.follow_dips(&points)?;
    Ok(Found { roots: line.roots, dips: line.dips })
}

impl<E> Line<'_, '_, E> {
    fn at(&mut self, place: f64) -> Result<Point, Halt<E>> {
        self.search.flown(&[place], Accuracy::OfCase)
    }

    /// The signed residual; none where the flight does not count.
    fn residual(&self, point: &Point) -> Option<f64> {
        point.residuals.as_ref().map(|residuals| residuals[self.goal])
    }

    /// Halves between unlike neighbours.
    fn locate_edges(&mut self, points: &mut Vec<Point>) -> Result<(), Halt<E>> {
        let mut index = 0;
        while index + 1 < points.len() {
            let [low, high] = [&points[index], &points[index + 1]];
            if low.class() == high.class() || high.place[0] - low.place[0] <= EDGE {
                index += 1;
                continue;
            }
            let middle = 0.5 * (low.place[0] + high.place[0]);
            let middle = self.at(middle)?;
            // What is like both its neighbours shows nothing new.
            points.insert(index + 1, middle);
        }
        Ok(())
    }

    /// Puts samples beside those that are solutions, so that another solution beside them is seen.
    fn step_over_roots(&mut self, points: &mut Vec<Point>) -> Result<(), Halt<E>> {
        let mut index = 0;
        while index < points.len() {
            if self.residual(&points[index]).is_none_or(|residual| residual.abs() > MET) {
                index += 1;
                continue;
            }
            let root = points.remove(index);
            for place in [root.place[0] - ASIDE, root.place[0] + ASIDE] {
                if (0.0..=1.0).contains(&place) {
                    points.insert(index, self.at(place)?);
                    index += 1;
                }
            }
            self.roots.push(root);
        }
        Ok(())
    }

    /// Follows a change of sign between two samples, if there is one.
    fn bracket(&mut self, low: &Point, high: &Point) -> Result<(), Halt<E>> {
        let (Some(at_low), Some(at_high)) = (self.residual(low), self.residual(high)) else { return Ok(()) };
        if at_low * at_high >= 0.0 {
            return Ok(());
        }
        let mut halt = None;
        let mut best: Option<Point> = None;
        let goal = self.goal;
        let search = &mut *self.search;
        let residual = |place: f64| match search.flown(&[place], Accuracy::OfCase) {
            Err(reason) => {
                halt = Some(reason);
                // Nothing further is flown.
                0.0
            }
            Ok(point) => {
                let Some(residual) = point.residuals.as_ref().map(|residuals| residuals[goal]) else { return at_low };
                let is_better = best.as_ref().is_none_or(|best| point.worst_of(goal) < best.worst_of(goal));
                if is_better {
                    best = Some(point);
                }
                if residual.abs() <= MET { 0.0 } else { residual }
            }
        };
        bracketed(residual, (low.place[0], at_low), (high.place[0], at_high), f64::EPSILON);
        if let Some(halt) = halt {
            return Err(halt);
        }
        // A bracket that closes on a jump has no zero.
        match best {
            Some(best) if best.worst_of(goal) <= 1.0 => self.roots.push(best),
            Some(best) => self.dips.push(best),
            None => {}
        }
        Ok(())
    }

    /// Follows the dips between samples whose misses have one sign.
    fn follow_dips(&mut self, points: &[Point]) -> Result<(), Halt<E>> {
        for (index, middle) in points.iter().enumerate() {
            let Some(at_middle) = self.residual(middle) else { continue };
            let beside = |offset: Option<usize>| offset.and_then(|index| points.get(index));
            let neighbours = [beside(index.checked_sub(1)), beside(Some(index + 1))];
            let mut ends = [middle.clone(), middle.clone()];
            let mut is_lowest = true;
            for (end, neighbour) in ends.iter_mut().zip(neighbours) {
                let Some(neighbour) = neighbour else { continue };
                // Beyond an edge it is not known.
                let Some(residual) = self.residual(neighbour) else { continue };
                *end = neighbour.clone();
                is_lowest &= residual * at_middle > 0.0 && residual.abs() >= at_middle.abs();
            }
            if is_lowest {
                self.follow_dip(ends, middle.clone())?;
            }
        }
        Ok(())
    }

    /// Follows a dip about a sample between two others until the miss changes its sign or has its least value.
    fn follow_dip(&mut self, [mut low, mut high]: [Point; 2], mut best: Point) -> Result<(), Halt<E>> {
        let sign = self.residual(&best).unwrap_or_default().signum();
        let depth = |line: &Self, point: &Point| line.residual(point).map_or(f64::INFINITY, |it| it * sign);
        let first = [depth(self, &low), depth(self, &high)].into_iter().filter(|it| it.is_finite()).fold(0.0, f64::max);
        for _ in 0..MOST_TRIALS {
            let width = high.place[0] - low.place[0];
            if width <= DIP {
                break;
            }
            let left = depth(self, &best);
            if width < COARSE && left > 1.0 && (first - left).abs() < COARSE * left {
                break;
            }
            let trial = self.trial(&low, &best, &high, &depth);
            let next = self.at(trial)?;
            let value = depth(self, &next);
            if value <= 0.0 {
                self.bracket(&low, &next)?;
                self.bracket(&next, &high)?;
                // The samples beside may be the same point, at an end of the range.
                if low.place == best.place || high.place == best.place {
                    self.bracket(&best, &next)?;
                }
                return Ok(());
            }
            let is_above = next.place[0] > best.place[0];
            if value < left {
                let before = std::mem::replace(&mut best, next);
                if is_above { low = before } else { high = before }
            } else if is_above {
                high = next;
            } else {
                low = next;
            }
            let has_settled = (left - value).abs() <= f64::EPSILON.sqrt() * 1e-2 * left && width < COARSE;
            if has_settled {
                break;
            }
        }
        self.dips.push(best);
        Ok(())
    }

    /// Where to look next for the lowest point: at that of a parabola, or in the wider part.
    fn trial(&self, low: &Point, best: &Point, high: &Point, depth: &impl Fn(&Self, &Point) -> f64) -> f64 {
        let [a, x, b] = [low, best, high].map(|point| point.place[0]);
        let [at_a, at_x, at_b] = [low, best, high].map(|point| depth(self, point));
        let golden = if b - x > x - a { x + GOLDEN * (b - x) } else { x - GOLDEN * (x - a) };
        let (p, q) = ((x - a) * (at_x - at_b), (x - b) * (at_x - at_a));
        let vertex = x - 0.5 * ((x - a) * p - (x - b) * q) / (p - q);
        let least = 1e-3 * (b - a);
        let is_inside = vertex > a + least && vertex < b - least;
        // Beside the best, so that the range shrinks.
        let apart = if (vertex - x).abs() < least { x + if b - x > x - a { least } else { -least } } else { vertex };
        if is_inside && p.is_finite() && q.is_finite() { apart } else { golden }
    }
}

impl Point {
    /// The size of the residual of a goal.
    fn worst_of(&self, goal: usize) -> f64 {
        self.residuals.as_ref().map_or(f64::INFINITY, |residuals| residuals[goal].abs())
    }
}
