//! The values of numbers of a case with which a flight gives what is wanted.
//!
//! The range is scanned; from the best points of the scan Gauss-Newton steps go down to where nothing is missed. One number with one goal is
//! apart: there every change of sign and every dip of the miss is followed. What was found is flown once more, at a fine tolerance.

mod one_number;
mod polish;
mod scan;
mod search;
mod trust_region;

pub use search::{Accuracy, Derivatives, Flights, Goal, Iteration, Number, Outcome};

use crate::trajectory::Termination;
use polish::Polished;
use search::{Halt, Point, Search};
use trust_region::Rest;

/// How long a search may go on, and what it tells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Options {
    /// Points of the scan; 0 for as many as fit the count of numbers.
    pub starts: usize,
    /// Solutions at most.
    pub solutions: usize,
    /// Flights at most.
    pub flights: usize,
    /// Whether its steps are told.
    pub is_recorded: bool,
}

/// What a search has found.
#[derive(Clone, Debug, PartialEq)]
pub struct Target {
    /// Those that are distinct, the nearest to the start first.
    pub solutions: Vec<Solution>,
    /// Where there is none, what comes nearest; none where no flight counts.
    pub nearest: Option<Nearest>,
    /// The least and the greatest number of each goal, as shown, of all flights that count.
    pub reach: Vec<Option<[f64; 2]>>,
    /// Whether there is no other solution within the range.
    pub is_complete: bool,
    /// Whether the flights or the time were used up.
    pub is_out_of_budget: bool,
    /// Points of the scan.
    pub starts: usize,
    /// How flights ended.
    pub ends: Vec<Termination>,
    /// The steps of the search, where they are asked for.
    pub iterations: Option<Vec<Iteration>>,
}

/// Numbers with which all goals are met, or nearly so.
#[derive(Clone, Debug, PartialEq)]
pub struct Solution {
    /// The numbers.
    pub values: Vec<f64>,
    /// By how much each goal is missed, as shown.
    pub misses: Vec<Option<f64>>,
    /// Of each goal, as shown, by each number; none where there is none.
    pub derivatives: Vec<Vec<Option<f64>>>,
    /// The greatest singular value of the slopes over the least, with goals in tolerances and numbers in scales; none where some have none.
    pub condition: Option<f64>,
    /// Whether every small change of the numbers misses a goal.
    pub is_isolated: bool,
    /// The change of the numbers that does not, a scale long, where there is one alone or several.
    pub free_direction: Option<Vec<f64>>,
    /// Numbers that are at an end of their range, each with whether that is the greater.
    pub at_bounds: Vec<(usize, bool)>,
    /// From the start, in scales.
    pub distance: f64,
}

/// The numbers that come nearest where nothing reaches, and why.
#[derive(Clone, Debug, PartialEq)]
pub struct Nearest {
    /// The numbers.
    pub solution: Solution,
    /// Whether no small change comes nearer.
    pub is_stationary: bool,
    /// Whether flights beyond do not count.
    pub is_at_edge: bool,
    /// How those end; none where they fail.
    pub beyond: Option<Termination>,
    /// The goals whose numbers hardly change with anything that varies.
    pub insensitive: Vec<usize>,
}

/// Solutions that are nearer to each other, in parts of the ranges, are one.
const DISTINCT: f64 = 1e-4;
/// Where all flights together change a number by less than this part of its miss, nothing that varies changes it.
const INSENSITIVE: f64 = 1e-2;

/// Searches for numbers with which all goals are met. `fly` flies numbers, and fewer once the time is over.
///
/// # Errors
/// Those of `fly`.
pub fn target<E>(numbers: &[Number], goals: &[Goal], options: Options, fly: &mut dyn Flights<E>) -> Result<Target, E> {
    let mut state = State {
        search: Search::new(numbers, goals, options.flights, options.is_recorded, fly),
        options,
        starts: 0,
        solutions: Vec::new(),
        nearest: None,
        is_complete: false,
    };
    let is_out_of_budget = match state.run() {
        Ok(()) => false,
        Err(Halt::Budget) => true,
        Err(Halt::Failed(error)) => return Err(error),
    };
    state.end(is_out_of_budget)
}

/// A search and what it has found so far.
struct State<'a, E> {
    search: Search<'a, E>,
    options: Options,
    starts: usize,
    solutions: Vec<Polished>,
    nearest: Option<(Point, Rest)>,
    is_complete: bool,
}

impl<E> State<'_, E> {
    fn run(&mut self) -> Result<(), Halt<E>> {
        let mut points = scan::scan(&mut self.search, self.options.starts)?;
        self.starts = points.len();
        let mut equalities = self.search.goals.iter().enumerate().filter(|(_, goal)| goal.searched.is_equality());
        let single = equalities.next().filter(|_| equalities.next().is_none()).map(|(goal, _)| goal);
        if let (Some(goal), [_]) = (single, self.search.numbers) {
            return self.follow(points, goal);
        }
        scan::look_at_edges(&mut self.search, &mut points)?;
        self.descend(&points)
    }

    /// Follows one number and one goal; others only say which of the solutions count.
    fn follow(&mut self, points: Vec<Point>, goal: usize) -> Result<(), Halt<E>> {
        let found = one_number::follow(&mut self.search, points, goal)?;
        for root in found.roots {
            self.polish(&root)?;
        }
        self.is_complete = true;
        for dip in found.dips {
            self.offer(dip, Rest::Stationary);
        }
        Ok(())
    }

    /// Goes down from the best points.
    fn descend(&mut self, points: &[Point]) -> Result<(), Halt<E>> {
        let mut seeds = scan::seeds(&self.search, points);
        // The case's own start always, and first.
        seeds.retain(|seed| *seed != 0);
        if points.first().is_some_and(Point::counts) {
            seeds.insert(0, 0);
        }
        if self.is_hopeless() {
            seeds.truncate(2);
        }
        for seed in seeds {
            let known: Vec<_> = self.solutions.iter().map(|solution| solution.point.place.clone()).collect();
            let (point, rest) = trust_region::descend(&mut self.search, seed, points[seed].clone(), &known)?;
            match rest {
                Rest::Near => self.polish(&point)?,
                Rest::Known => {}
                Rest::Stationary | Rest::Edge => self.offer(point, rest),
            }
            let is_one_of_many = self.solutions.iter().any(|solution| !solution.solution.is_isolated);
            if is_one_of_many || self.solutions.len() >= self.options.solutions {
                break;
            }
        }
        Ok(())
    }

    /// Whether a goal is missed by far more than all flights of the scan differ in it.
    fn is_hopeless(&self) -> bool {
        (0..self.search.goals.len()).any(|goal| self.is_insensitive(goal))
    }

    fn is_insensitive(&self, goal: usize) -> bool {
        let Some([least, greatest]) = self.search.reach[goal] else { return false };
        let shown = &self.search.goals[goal].shown;
        let miss = shown.miss(least).abs().min(shown.miss(greatest).abs());
        let is_between = shown.miss(least) * shown.miss(greatest) <= 0.0;
        !is_between && greatest - least <= INSENSITIVE * miss
    }

    /// Flies a solution finely, and keeps it if it is one, and new.
    fn polish(&mut self, point: &Point) -> Result<(), Halt<E>> {
        let polished = polish::polish(&mut self.search, point)?;
        if polished.is_reached {
            let place = &polished.point.place;
            let is_known = |known: &Polished| self.search.distance(&known.point.place, place) < DISTINCT;
            if !self.solutions.iter().any(is_known) {
                self.solutions.push(polished);
            }
        } else {
            self.offer(polished.point, Rest::Stationary);
        }
        Ok(())
    }

    /// Notes what comes near.
    fn offer(&mut self, point: Point, rest: Rest) {
        if self.nearest.as_ref().is_none_or(|(nearest, _)| point.merit() < nearest.merit()) {
            self.nearest = Some((point, rest));
        }
    }

    fn end(mut self, is_out_of_budget: bool) -> Result<Target, E> {
        let nearest = if self.solutions.is_empty() { self.nearest()? } else { None };
        let Self { search, starts, solutions, is_complete, options, .. } = self;
        let mut solutions: Vec<_> = solutions.into_iter().map(|polished| polished.solution).collect();
        solutions.sort_by(|one, other| one.distance.total_cmp(&other.distance));
        solutions.truncate(options.solutions);
        Ok(Target {
            solutions,
            nearest,
            reach: search.reach,
            is_complete,
            is_out_of_budget,
            starts,
            ends: search.ends,
            iterations: search.iterations,
        })
    }

    /// What comes nearest, flown finely.
    fn nearest(&mut self) -> Result<Option<Nearest>, E> {
        let at_rest = self.nearest.take();
        let best = self.search.best.clone();
        let is_better = |point: &Point| at_rest.as_ref().is_none_or(|(rest, _)| point.merit() < 0.999 * rest.merit());
        // The best of all flights may lie beside where a descent came to rest.
        let Some((point, rest)) = best.filter(is_better).map(|best| (best, Rest::Known)).or(at_rest) else {
            return Ok(None);
        };
        self.search.allow(2 * self.search.numbers.len() + 2);
        let is_at_edge = rest == Rest::Edge;
        let polished = match polish::tell(&mut self.search, point.clone()) {
            Ok(polished) => polished,
            Err(Halt::Failed(error)) => return Err(error),
            Err(Halt::Budget) => polish::hasten(&self.search, point),
        };
        let insensitive = (0..self.search.goals.len()).filter(|goal| self.is_insensitive(*goal)).collect();
        let beyond = if is_at_edge { polish::beyond(&mut self.search, &polished) } else { None };
        Ok(Some(Nearest {
            is_stationary: rest == Rest::Stationary && polished.solution.at_bounds.is_empty(),
            is_at_edge,
            beyond,
            insensitive,
            solution: polished.solution,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::{Accuracy, Goal, Number, Options, Outcome, Target, target};
    use crate::solve::requirement::{Requirement, Wanted};
    use crate::trajectory::Termination;

    const OPTIONS: Options = Options { starts: 0, solutions: 8, flights: 20_000, is_recorded: false };

    fn number(between: [f64; 2], start: f64) -> Number {
        Number { between, scale: between[1] - between[0], start, is_cyclic: false }
    }

    fn goal(wanted: Wanted) -> Goal {
        let requirement = Requirement { wanted, turn: None, tolerance: 1e-6, size: 1.0 };
        Goal { searched: requirement, shown: requirement }
    }

    /// Searches with a function in place of flights; where it gives an end alone, they do not count.
    fn of(
        numbers: &[Number],
        goals: &[Goal],
        options: Options,
        function: impl Fn(&[f64]) -> Result<Vec<f64>, Termination>,
    ) -> (Target, usize) {
        let mut flights = 0;
        let mut outcome = |values: &Vec<f64>| {
            flights += 1;
            let given = function(values);
            let end = given.as_ref().err().copied().unwrap_or(Termination::StopAltitude);
            let counts = given.is_ok();
            let numbers: Vec<_> =
                given.map_or_else(|_| vec![None; goals.len()], |given| given.into_iter().map(Some).collect());
            Outcome { end: Some(end), counts, searched: numbers.clone(), shown: numbers }
        };
        let mut fly = |all: &[Vec<f64>], _: Accuracy| Ok::<_, ()>(all.iter().map(&mut outcome).collect());
        let found = target(numbers, goals, options, &mut fly).unwrap_or_else(|()| unreachable!("no flight fails"));
        (found, flights)
    }

    fn sorted(found: &Target, number: usize) -> Vec<f64> {
        let mut values: Vec<_> = found.solutions.iter().map(|solution| solution.values[number]).collect();
        values.sort_by(f64::total_cmp);
        values
    }

    #[test]
    fn every_root_of_one_number_is_found() {
        let (found, flights) =
            of(&[number([0.0, 10.0], 4.0)], &[goal(Wanted::Equals(0.5))], OPTIONS, |x| Ok(vec![x[0].sin()]));
        let roots = sorted(&found, 0);
        let expected = [std::f64::consts::FRAC_PI_6, 2.617_993_878, 6.806_784_082_8, 8.901_179_185_2];
        assert!(roots.len() == 4 && roots.iter().zip(expected).all(|(a, b)| (a - b).abs() < 2e-6), "{roots:?}");
        assert!(found.is_complete && found.nearest.is_none() && flights < 200, "{flights} flights");
        // The nearest to the start first.
        assert!((found.solutions[0].values[0] - expected[1]).abs() < 2e-6);
    }

    #[test]
    fn two_roots_beside_a_fold_are_found_and_one_beyond_it_is_the_nearest_approach() {
        let fold = |x: &[f64]| Ok(vec![1.0 - (x[0] - 0.333).powi(2)]);
        let (found, _) = of(&[number([0.0, 1.0], 0.9)], &[goal(Wanted::Equals(1.0 - 1e-5))], OPTIONS, fold);
        assert_eq!(sorted(&found, 0).len(), 2);
        let (found, flights) = of(&[number([0.0, 1.0], 0.9)], &[goal(Wanted::Equals(1.0 + 1e-5))], OPTIONS, fold);
        let nearest = found.nearest.expect("the fold");
        assert!(
            found.solutions.is_empty() && nearest.is_stationary && (nearest.solution.values[0] - 0.333).abs() < 1e-5
        );
        assert!(flights < 150, "{flights} flights");
    }

    #[test]
    fn a_root_at_the_end_of_the_range_does_not_hide_one_beside_it() {
        let (found, _) =
            of(&[number([0.0, 1.0], 0.9)], &[goal(Wanted::Equals(0.0))], OPTIONS, |x| Ok(vec![x[0] * (x[0] - 3e-3)]));
        assert_eq!(sorted(&found, 0).len(), 2);
    }

    #[test]
    fn a_jump_is_no_root() {
        let (found, _) = of(&[number([0.0, 1.0], 0.9)], &[goal(Wanted::Equals(0.0))], OPTIONS, |x| {
            Ok(vec![if x[0] < 0.3 { x[0] - 1.0 } else { x[0] + 1.0 }])
        });
        assert!(found.solutions.is_empty() && found.nearest.is_some());
    }

    #[test]
    fn both_crossings_of_a_circle_and_a_line_are_found() {
        let numbers = [number([-2.0, 2.0], 1.5), number([-2.0, 2.0], -1.5)];
        let goals = [goal(Wanted::Equals(1.0)), goal(Wanted::Equals(0.2))];
        let (found, flights) = of(&numbers, &goals, OPTIONS, |x| Ok(vec![x[0].hypot(x[1]), x[1] - 0.5 * x[0]]));
        let values = sorted(&found, 0);
        assert!(values.len() == 2 && flights < 400, "{values:?} of {flights} flights");
        for solution in &found.solutions {
            let [x, y] = solution.values[..] else { unreachable!() };
            assert!((x.hypot(y) - 1.0).abs() < 1e-6 && (y - 0.5 * x - 0.2).abs() < 1e-6);
            assert!(solution.is_isolated && solution.condition.is_some_and(|it| it < 10.0));
            let slope = solution.derivatives[1][0].unwrap_or_default();
            assert!((slope + 0.5).abs() < 1e-6);
        }
        let (found, _) = of(&numbers, &[goals[0], goal(Wanted::Equals(3.0))], OPTIONS, |x| {
            Ok(vec![x[0].hypot(x[1]), x[1] - 0.5 * x[0]])
        });
        assert!(found.solutions.is_empty() && found.nearest.is_some());
    }

    #[test]
    fn of_many_solutions_that_nearest_to_the_start_is_told() {
        let numbers = [number([-2.0, 2.0], 1.0), number([-2.0, 2.0], 1.5)];
        let (found, _) = of(&numbers, &[goal(Wanted::Equals(1.0))], OPTIONS, |x| Ok(vec![x[0].hypot(x[1])]));
        let [solution] = &found.solutions[..] else { panic!("{:?}", found.solutions) };
        let length = 1.0_f64.hypot(1.5);
        assert!((solution.values[0] - 1.0 / length).abs() < 1e-3, "{:?}", solution.values);
        assert!(!solution.is_isolated);
        let free = solution.free_direction.clone().unwrap_or_default();
        assert!((free[0] * solution.values[0] + free[1] * solution.values[1]).abs() < 1e-6);
    }

    #[test]
    fn what_lies_beyond_the_range_is_told_by_its_bound() {
        let numbers = [number([0.0, 1.0], 0.5), number([0.0, 1.0], 0.5)];
        let goals = [goal(Wanted::Equals(2.0)), goal(Wanted::Equals(0.25))];
        let (found, _) = of(&numbers, &goals, OPTIONS, |x| Ok(vec![x[0], x[1] * x[1]]));
        let nearest = found.nearest.expect("the end of the range");
        assert_eq!(nearest.solution.at_bounds, [(0, true)]);
        assert!((nearest.solution.values[1] - 0.5).abs() < 1e-6);
    }

    #[test]
    fn a_thin_band_of_flights_that_count_is_found_between_others() {
        let numbers = [number([0.0, 1.0], 0.1), number([0.0, 1.0], 0.1)];
        let goals = [goal(Wanted::Equals(0.5031)), goal(Wanted::Equals(0.2))];
        let (found, flights) = of(&numbers, &goals, OPTIONS, |x| match x[0] {
            below if below < 0.503 => Err(Termination::SurfaceImpact),
            above if above > 0.5035 => Err(Termination::TimeLimit),
            _ => Ok(vec![x[0], x[1]]),
        });
        assert!(found.solutions.len() == 1 && flights < 400, "{flights} flights");
    }

    #[test]
    fn what_nothing_changes_is_told() {
        let numbers = [number([0.0, 1.0], 0.5), number([0.0, 1.0], 0.5)];
        let goals = [goal(Wanted::Equals(0.3)), goal(Wanted::Equals(10.0))];
        let (found, flights) = of(&numbers, &goals, OPTIONS, |x| Ok(vec![x[0] * x[1], 28.3 + 1e-6 * x[0]]));
        let nearest = found.nearest.expect("no way to the other");
        assert!(nearest.insensitive == [1] && flights < 250, "{flights} flights");
        let [least, greatest] = found.reach[1].unwrap_or_default();
        assert!(least >= 28.3 && greatest < 28.3 + 2e-6);
    }

    #[test]
    fn a_search_ends_with_its_flights() {
        let options = Options { flights: 20, ..OPTIONS };
        let (found, flights) =
            of(&[number([0.0, 10.0], 4.0)], &[goal(Wanted::Equals(0.5))], options, |x| Ok(vec![x[0].sin()]));
        assert!(found.is_out_of_budget && !found.is_complete && found.nearest.is_some() && flights < 30);
    }

    #[test]
    fn angles_over_a_full_turn_wrap() {
        let angle = Number { between: [0.0, 360.0], scale: 360.0, start: 350.0, is_cyclic: true };
        let numbers = [angle, number([0.0, 1.0], 0.5)];
        let goals = [goal(Wanted::Equals(0.0)), goal(Wanted::Equals(1.0))];
        // Its place is 5 and 1 over the seam.
        let (found, _) = of(&numbers, &goals, OPTIONS, |x| {
            let turn = (x[0] - 5.0) / 180.0 * std::f64::consts::PI;
            Ok(vec![turn.sin(), turn.cos() * (0.5 + 0.5 * x[1])])
        });
        let [solution] = &found.solutions[..] else { panic!("{:?}", found.solutions) };
        assert!(
            (solution.values[0] - 5.0).abs() < 1e-3 && (solution.distance - 15.0_f64.hypot(180.0) / 360.0).abs() < 1e-3
        );
    }
}
