//! The flights of a search, and what was seen on them.

use crate::solve::requirement::Requirement;
use crate::trajectory::Termination;

/// A number that varies, in its own unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Number {
    /// The least and the greatest value.
    pub between: [f64; 2],
    /// The change that matters.
    pub scale: f64,
    /// Where the search begins.
    pub start: f64,
    /// Whether the ends are the same: an angle over a full turn.
    pub is_cyclic: bool,
}

/// A number of a flight that is to be reached.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Goal {
    /// On the number as searches take it.
    pub searched: Requirement,
    /// On the number as it is shown.
    pub shown: Requirement,
}

/// How exactly a flight is flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Accuracy {
    /// As the case says.
    OfCase,
    /// At the tolerance at which solutions are told.
    Fine,
}

/// What a flight gives.
#[derive(Clone, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended; none where it could not be finished.
    pub end: Option<Termination>,
    /// Whether a flight that ends so counts.
    pub counts: bool,
    /// The number of each goal as searches take it; none where the flight has none.
    pub searched: Vec<Option<f64>>,
    /// The same as it is shown.
    pub shown: Vec<Option<f64>>,
}

/// The derivatives of the number of each goal by each number that varies, in their units; not a finite number where there is none.
#[derive(Clone, Debug, PartialEq)]
pub struct Derivatives {
    /// Of the number as searches take it.
    pub searched: Vec<Vec<f64>>,
    /// Of the number as it is shown.
    pub shown: Vec<Vec<f64>>,
}

/// Whoever flies for a search.
pub trait Flights<E> {
    /// Flies all of several numbers; fewer of them once the time is over.
    ///
    /// # Errors
    /// When a flight fails for a reason that is not its own.
    fn fly(&mut self, values: &[Vec<f64>], accuracy: Accuracy) -> Result<Vec<Outcome>, E>;

    /// The derivatives that flights with these numbers have along their steps; none where it is cheaper to fly beside them, and once the time is
    /// over. It counts as a flight.
    ///
    /// # Errors
    /// Those of [`fly`](Self::fly).
    fn derivatives(&mut self, _values: &[f64], _accuracy: Accuracy) -> Result<Option<Derivatives>, E> {
        Ok(None)
    }
}

impl<E, F: FnMut(&[Vec<f64>], Accuracy) -> Result<Vec<Outcome>, E>> Flights<E> for F {
    fn fly(&mut self, values: &[Vec<f64>], accuracy: Accuracy) -> Result<Vec<Outcome>, E> {
        self(values, accuracy)
    }
}

/// Why a search ends early.
pub(super) enum Halt<E> {
    /// The flights, or the time, are used up.
    Budget,
    /// A flight failed for a reason that is not its own.
    Failed(E),
}

/// A flight of the search.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Point {
    /// The numbers as parts of their ranges.
    pub(super) place: Vec<f64>,
    pub(super) end: Option<Termination>,
    /// The misses in parts of the tolerances; none where the flight does not count.
    pub(super) residuals: Option<Vec<f64>>,
    pub(super) shown: Vec<Option<f64>>,
}

impl Point {
    /// The sum of the squares of the residuals.
    pub(super) fn merit(&self) -> f64 {
        let squares = self.residuals.as_ref().map(|residuals| residuals.iter().map(|it| it * it).sum());
        squares.unwrap_or(f64::INFINITY)
    }

    /// The greatest of the residuals.
    pub(super) fn worst(&self) -> f64 {
        let greatest = |residuals: &Vec<f64>| residuals.iter().fold(0.0, |worst: f64, it| worst.max(it.abs()));
        self.residuals.as_ref().map_or(f64::INFINITY, greatest)
    }

    pub(super) fn counts(&self) -> bool {
        self.residuals.is_some()
    }

    /// What tells flights apart that end in different ways.
    pub(super) fn class(&self) -> (Option<Termination>, bool) {
        (self.end, self.counts())
    }
}

/// A step of a search.
#[derive(Clone, Debug, PartialEq)]
pub struct Iteration {
    /// From which start it goes.
    pub start: usize,
    /// The numbers that were tried.
    pub values: Vec<f64>,
    /// The misses with them; none where the flight has no such number.
    pub misses: Vec<Option<f64>>,
    /// The radius of the region in which the step is trusted, in parts of the ranges.
    pub radius: f64,
    /// Whether it was taken.
    pub accepted: bool,
}

/// A search while it goes on.
pub(super) struct Search<'a, E> {
    pub(super) numbers: &'a [Number],
    pub(super) goals: &'a [Goal],
    fly: &'a mut (dyn Flights<E> + 'a),
    /// The flights that may still be flown.
    left: usize,
    pub(super) flights: usize,
    /// The least and the greatest shown number of each goal, of flights that count.
    pub(super) reach: Vec<Option<[f64; 2]>>,
    /// How flights ended, each once.
    pub(super) ends: Vec<Termination>,
    /// The flight that misses least.
    pub(super) best: Option<Point>,
    /// None where nobody asks for them.
    pub(super) iterations: Option<Vec<Iteration>>,
}

impl<'a, E> Search<'a, E> {
    pub(super) fn new(
        numbers: &'a [Number],
        goals: &'a [Goal],
        flights: usize,
        is_recorded: bool,
        fly: &'a mut (dyn Flights<E> + 'a),
    ) -> Self {
        Self {
            numbers,
            goals,
            fly,
            left: flights,
            flights: 0,
            reach: vec![None; goals.len()],
            ends: Vec::new(),
            best: None,
            iterations: is_recorded.then(Vec::new),
        }
    }

    /// Flies a place, which is taken into the range first.
    pub(super) fn flown(&mut self, place: &[f64], accuracy: Accuracy) -> Result<Point, Halt<E>> {
        self.all_flown([place], accuracy)?.pop().ok_or(Halt::Budget)
    }

    /// The same of several places at once.
    pub(super) fn all_flown<'p>(
        &mut self,
        places: impl IntoIterator<Item = &'p [f64]>,
        accuracy: Accuracy,
    ) -> Result<Vec<Point>, Halt<E>> {
        let mut places: Vec<_> = places.into_iter().map(|place| self.within(place)).collect();
        let count = places.len();
        places.truncate(self.left);
        self.left -= places.len();
        let values: Vec<_> = places.iter().map(|place| self.values(place)).collect();
        let outcomes = self.fly.fly(&values, accuracy).map_err(Halt::Failed)?;
        let points: Vec<_> =
            places.into_iter().zip(outcomes).map(|(place, outcome)| self.noted(place, outcome)).collect();
        if points.len() < count { Err(Halt::Budget) } else { Ok(points) }
    }

    /// The derivatives at a point, along the steps of its flight, if there are any.
    pub(super) fn derivatives(&mut self, point: &Point, accuracy: Accuracy) -> Result<Option<Derivatives>, Halt<E>> {
        let values = self.values(&point.place);
        if self.left == 0 {
            return Err(Halt::Budget);
        }
        let derivatives = self.fly.derivatives(&values, accuracy).map_err(Halt::Failed)?;
        if derivatives.is_some() {
            self.left -= 1;
            self.flights += 1;
        }
        Ok(derivatives)
    }

    /// Notes what a flight gave.
    fn noted(&mut self, place: Vec<f64>, outcome: Outcome) -> Point {
        self.flights += 1;
        let Outcome { end, counts, searched, shown } = outcome;
        let residual = |(goal, number): (&Goal, &Option<f64>)| {
            let residual = goal.searched.miss((*number)?) / goal.searched.tolerance;
            residual.is_finite().then_some(residual)
        };
        let residuals: Option<Vec<f64>> =
            if counts { self.goals.iter().zip(&searched).map(residual).collect() } else { None };
        if let Some(end) = end
            && !self.ends.contains(&end)
        {
            self.ends.push(end);
        }
        let point = Point { place, end, residuals, shown };
        if point.counts() {
            for (reach, shown) in self.reach.iter_mut().zip(&point.shown) {
                let Some(shown) = *shown else { continue };
                let [least, greatest] = reach.unwrap_or([shown; 2]);
                *reach = Some([least.min(shown), greatest.max(shown)]);
            }
            if self.best.as_ref().is_none_or(|best| point.merit() < best.merit()) {
                self.best = Some(point.clone());
            }
        }
        point
    }

    /// Flights beyond what the search may take, by which its end is told: as many as that needs.
    pub(super) fn allow(&mut self, flights: usize) {
        self.left = self.left.max(flights);
    }

    /// The place where the search begins.
    pub(super) fn start(&self) -> Vec<f64> {
        let part = |number: &Number| (number.start - number.between[0]) / number.width();
        self.numbers.iter().map(part).collect()
    }

    /// The numbers at a place.
    pub(super) fn values(&self, place: &[f64]) -> Vec<f64> {
        let value = |(number, part): (&Number, &f64)| {
            let [least, greatest] = number.between;
            (least + part * number.width()).clamp(least, greatest)
        };
        self.numbers.iter().zip(place).map(value).collect()
    }

    /// The nearest place within the range; of a cyclic number the same.
    fn within(&self, place: &[f64]) -> Vec<f64> {
        let part = |(number, part): (&Number, &f64)| {
            if number.is_cyclic { part.rem_euclid(1.0) } else { part.clamp(0.0, 1.0) }
        };
        self.numbers.iter().zip(place).map(part).collect()
    }

    /// The way from one place to another, by the shorter arc of cyclic numbers.
    pub(super) fn way(&self, from: &[f64], to: &[f64]) -> Vec<f64> {
        let part = |((number, from), to): ((&Number, &f64), &f64)| {
            let way = to - from;
            if number.is_cyclic { way - way.round() } else { way }
        };
        self.numbers.iter().zip(from).zip(to).map(part).collect()
    }

    /// The length of the way, in parts of the ranges.
    pub(super) fn distance(&self, from: &[f64], to: &[f64]) -> f64 {
        self.way(from, to).iter().map(|part| part * part).sum::<f64>().sqrt()
    }

    /// The length of the way, in scales.
    pub(super) fn scaled_distance(&self, from: &[f64], to: &[f64]) -> f64 {
        let way = self.way(from, to);
        let scaled = self.numbers.iter().zip(way).map(|(number, part)| part * number.width() / number.scale);
        scaled.map(|part| part * part).sum::<f64>().sqrt()
    }

    /// Notes a step of the search.
    pub(super) fn record(&mut self, start: usize, point: &Point, radius: f64, accepted: bool) {
        let Some(mut iterations) = self.iterations.take() else { return };
        let values = self.values(&point.place);
        iterations.push(Iteration { start, values, misses: self.misses(point), radius, accepted });
        self.iterations = Some(iterations);
    }

    /// By how much the goals are missed, as shown.
    pub(super) fn misses(&self, point: &Point) -> Vec<Option<f64>> {
        self.goals.iter().zip(&point.shown).map(|(goal, shown)| shown.map(|shown| goal.shown.miss(shown))).collect()
    }
}

impl Number {
    pub(super) fn width(&self) -> f64 {
        self.between[1] - self.between[0]
    }
}
