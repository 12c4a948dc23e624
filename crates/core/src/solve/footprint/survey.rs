//! The flights of a footprint, and where they landed.

use std::ops::Range;

use super::plane::{Plane, Point};
use crate::coordinates::Site;
use crate::elementary::hypot;
use crate::root::bracketed;
use crate::solve::target::Number;
use crate::trajectory::Termination;

/// Where a flight came down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Landing {
    /// The place.
    pub site: Site,
    /// Along the initial great circle, m; none where the flight starts without a heading.
    pub downrange: Option<f64>,
    /// To the right of it, m.
    pub crossrange: Option<f64>,
}

/// What a flight gives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outcome {
    /// How it ended; none where it could not be finished.
    pub end: Option<Termination>,
    /// Where it came down; none where it did not.
    pub landing: Option<Landing>,
    /// By how much it keeps the limit that it keeps worst, in parts of its size; negative where it breaks one.
    pub margin: f64,
}

/// Flies all of several numbers; fewer of them once the time is over.
pub type Fly<'a, E> = dyn FnMut(&[Vec<f64>]) -> Result<Vec<Outcome>, E> + 'a;

/// Why a survey ends early.
pub(super) enum Halt<E> {
    /// The flights, or the time, are used up.
    Budget,
    /// A flight failed for a reason that is not its own.
    Failed(E),
}

/// A flight of the survey, by its place in the list.
pub(super) type FlightIndex = usize;

/// A flight of the survey.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Flight {
    /// The numbers as parts of their ranges.
    pub(super) place: Vec<f64>,
    pub(super) outcome: Outcome,
}

/// The flights so far.
pub(super) struct Survey<'a, E> {
    pub(super) numbers: &'a [Number],
    fly: &'a mut Fly<'a, E>,
    /// Flights that may still be flown.
    left: usize,
    pub(super) flights: Vec<Flight>,
    /// On which landings are compared: about the first that was found.
    pub(super) plane: Option<Plane>,
    pub(super) ends: Vec<Termination>,
    /// Whether every last flight that keeps the limits was located to the accuracy that was asked for.
    pub(super) is_located: bool,
}

impl<'a, E> Survey<'a, E> {
    pub(super) fn new(numbers: &'a [Number], flights: usize, fly: &'a mut Fly<'a, E>) -> Self {
        Self { numbers, fly, left: flights, flights: Vec::new(), plane: None, ends: Vec::new(), is_located: true }
    }

    /// Flies a place of the range.
    pub(super) fn fly(&mut self, place: Vec<f64>) -> Result<FlightIndex, Halt<E>> {
        self.fly_all(vec![place]).map(|flights| flights.start)
    }

    /// Flies several places of the range at once; gives the range of their flights.
    pub(super) fn fly_all(&mut self, mut places: Vec<Vec<f64>>) -> Result<Range<FlightIndex>, Halt<E>> {
        let (first, count) = (self.flights.len(), places.len());
        places.truncate(self.left);
        self.left -= places.len();
        let values: Vec<_> = places.iter().map(|place| self.values(place)).collect();
        let outcomes = (self.fly)(&values).map_err(Halt::Failed)?;
        for (place, outcome) in places.into_iter().zip(outcomes) {
            if let Some(end) = outcome.end
                && !self.ends.contains(&end)
            {
                self.ends.push(end);
            }
            self.flights.push(Flight { place, outcome });
        }
        if self.flights.len() < first + count { Err(Halt::Budget) } else { Ok(first..first + count) }
    }

    /// The numbers at a place.
    pub(super) fn values(&self, place: &[f64]) -> Vec<f64> {
        let value = |(number, part): (&Number, &f64)| {
            let [least, greatest] = number.between;
            (least + part * (greatest - least)).clamp(least, greatest)
        };
        self.numbers.iter().zip(place).map(value).collect()
    }

    /// The place of the case's own numbers.
    pub(super) fn start(&self) -> Vec<f64> {
        let part = |number: &Number| (number.start - number.between[0]) / (number.between[1] - number.between[0]);
        self.numbers.iter().map(part).collect()
    }

    /// The place between two flights that is so large a part of the way on.
    pub(super) fn between(&self, from: FlightIndex, to: FlightIndex, part: f64) -> Vec<f64> {
        let [from, to] = [from, to].map(|flight| &self.flights[flight].place);
        from.iter().zip(to).map(|(from, to)| from + part * (to - from)).collect()
    }

    /// Where a flight landed on the plane.
    pub(super) fn point(&self, flight: FlightIndex) -> Option<Point> {
        let landing = self.flights[flight].outcome.landing?;
        Some(self.plane?.point(&landing.site))
    }

    /// Where a flight landed that keeps all limits.
    pub(super) fn kept_point(&self, flight: FlightIndex) -> Option<Point> {
        if self.keeps(flight) { self.point(flight) } else { None }
    }

    /// Whether a flight lands and keeps all limits.
    pub(super) fn keeps(&self, flight: FlightIndex) -> bool {
        self.flights[flight].outcome.keeps()
    }

    /// The last flight that keeps all limits on the way from one that does to one that does not, to an accuracy in metres where both landed.
    ///
    /// Where both land, its limit is a zero of the margin; where flights jump to another end, it is looked for by halving.
    pub(super) fn last_kept(
        &mut self,
        kept: FlightIndex,
        broken: FlightIndex,
        accuracy: f64,
    ) -> Result<FlightIndex, Halt<E>> {
        let margins = [kept, broken].map(|flight| self.flights[flight].outcome.margin);
        match [self.point(kept), self.point(broken)] {
            [Some(one), Some(other)] if margins.iter().all(|margin| margin.is_finite()) => {
                self.zero_of_margin([kept, broken], accuracy / distance(one, other).max(accuracy))
            }
            _ => self.last_landing(kept, broken, accuracy),
        }
    }

    /// The last flight that keeps all limits, to a part of the way.
    fn zero_of_margin(&mut self, [kept, broken]: [FlightIndex; 2], accuracy: f64) -> Result<FlightIndex, Halt<E>> {
        let [from, to] = [kept, broken].map(|flight| self.flights[flight].outcome.margin);
        let mut last = (0.0, kept);
        let mut halt = None;
        let margin = |part: f64| match self.fly(self.between(kept, broken, part)) {
            Ok(flight) => {
                if self.keeps(flight) && part > last.0 {
                    last = (part, flight);
                }
                let margin = self.flights[flight].outcome.margin;
                // A flight beyond that does not land, or has no such number, is beyond the limit.
                if self.keeps(flight) || margin < 0.0 { margin.clamp(-1e9, 1e9) } else { -1e9 }
            }
            Err(stop) => {
                halt = Some(stop);
                // Nothing further is flown.
                0.0
            }
        };
        bracketed(margin, (0.0, from), (1.0, to), accuracy);
        halt.map_or(Ok(last.1), Err)
    }

    /// The last flight that keeps all limits before one that does not land, or ends otherwise, by halving.
    fn last_landing(&mut self, kept: FlightIndex, broken: FlightIndex, accuracy: f64) -> Result<FlightIndex, Halt<E>> {
        let [mut inside, mut outside] = [(kept, 0.0), (broken, 1.0)];
        // Of the last step of the landing: its round, and whether it was within the accuracy.
        let mut last = (0, true);
        for round in 1..=MOST_HALVINGS {
            let part = 0.5 * (inside.1 + outside.1);
            let flight = self.fly(self.between(kept, broken, part))?;
            if !self.keeps(flight) {
                outside = (flight, part);
                continue;
            }
            let moved = self.point(inside.0).zip(self.point(flight)).map(|(last, next)| distance(last, next));
            last = (round, moved.is_some_and(|moved| moved <= accuracy));
            inside = (flight, part);
            if round > FEWEST_HALVINGS && last.1 {
                break;
            }
        }
        // A landing that still goes on in the last halvings may do so without bound.
        self.is_located &= last.1 || last.0 + FEWEST_HALVINGS < MOST_HALVINGS;
        Ok(inside.0)
    }
}

/// Halvings of the way to a limit at most: a landing that moves without bound where flights leave is followed to a millionth of the way.
const MOST_HALVINGS: usize = 20;
/// Halvings at least where flights beyond do not land.
const FEWEST_HALVINGS: usize = 5;

impl Outcome {
    /// Whether the flight lands and keeps all limits.
    pub fn keeps(&self) -> bool {
        self.landing.is_some() && self.margin >= 0.0
    }
}

/// The distance of two points, m.
pub(super) fn distance(one: Point, other: Point) -> f64 {
    hypot(one[0] - other[0], one[1] - other[1])
}

/// How far a point is off the middle of two others, m.
pub(super) fn off_middle(middle: Point, one: Point, other: Point) -> f64 {
    distance(middle, [0.5 * (one[0] + other[0]), 0.5 * (one[1] + other[1])])
}

/// How far a point is from the line of two others, m.
pub(super) fn from_line(point: Point, one: Point, other: Point) -> f64 {
    let length = distance(one, other);
    if length == 0.0 {
        return distance(point, one);
    }
    let cross = (other[0] - one[0]) * (point[1] - one[1]) - (other[1] - one[1]) * (point[0] - one[0]);
    cross.abs() / length
}
