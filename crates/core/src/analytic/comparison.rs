//! A theory along a whole flight: its predictions, and the stretch over which it holds.

use super::{End, Prediction, Theory};
use crate::root;
use crate::trajectory::{FlightPoint, Sampling, Trajectory};

/// Where a step is looked at for what a theory has to say: at so many parts of it.
const LOOKS_A_STEP: usize = 8;

/// A theory beside a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// One a point.
    pub predictions: Vec<Prediction>,
    /// Where the theory holds.
    pub validity: Validity,
}

/// The stretch of a flight, in time order, outside which a theory gives no numbers.
///
/// A theory of a descent ends where it first gives none. The others hang on the altitude alone, or on altitude and speed:
/// they end where they last give numbers, and may have gaps before.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Validity {
    /// Where it begins, m, along the radius vector; `None` where it never gives a number.
    pub from_altitude: Option<f64>,
    /// Where it ends, m, between two points of the flight; `None` where it never gives a number.
    pub to_altitude: Option<f64>,
    /// Why it ends, or never begins.
    pub end: End,
}

impl Theory {
    /// What the theory predicts at points of the flight, in ascending order of time.
    pub fn compare(&self, flight: &Trajectory, points: &[FlightPoint]) -> Comparison {
        let (validity, until) = self.validity(flight);
        let predictions = points.iter().map(|point| match self.prediction(point) {
            Ok(prediction) if point.time <= until => prediction,
            _ => Prediction::default(),
        });
        Comparison { predictions: predictions.collect(), validity }
    }

    /// Where the theory holds, and until when, s; it is looked at within the steps of the flight, whatever rows are wanted.
    fn validity(&self, flight: &Trajectory) -> (Validity, f64) {
        let instants = flight.instants(&Sampling::PerStep(LOOKS_A_STEP), usize::MAX).unwrap_or_default();
        let points = flight.points(&instants);
        let results: Vec<_> = points.iter().map(|point| self.prediction(point)).collect();
        let over = End::Flight(flight.termination());
        let Some(first) = results.iter().position(Result::is_ok) else {
            let end = results.first().and_then(|result| result.err()).unwrap_or(over);
            return (Validity { from_altitude: None, to_altitude: None, end }, f64::NEG_INFINITY);
        };
        let next = if self.solution.descends() {
            results.iter().skip(first).position(Result::is_err).map_or(results.len(), |run| first + run)
        } else {
            results.iter().rposition(Result::is_ok).map_or(first, |last| last + 1)
        };
        let (from, _) = self.edge(flight, &points, first);
        let (to, end) = self.edge(flight, &points, next);
        let altitude = |time: f64| Some(flight.at(time).loads.altitude).filter(|altitude| altitude.is_finite());
        let validity = Validity { from_altitude: altitude(from), to_altitude: altitude(to), end: end.unwrap_or(over) };
        (validity, to)
    }

    /// The time, s, between the point before `index` and that at `index` at which the theory begins or ends to give numbers,
    /// and why it gives none beyond; at the ends of the flight there is no such reason.
    fn edge(&self, flight: &Trajectory, points: &[FlightPoint], index: usize) -> (f64, Option<End>) {
        let (Some(before), Some(after)) = (index.checked_sub(1).and_then(|i| points.get(i)), points.get(index)) else {
            let end = if index == 0 { points.first() } else { points.last() };
            return (end.map_or(0.0, |point| point.time), None);
        };
        let mut reason = None;
        // A function of two values: the root is found by bisection, to the resolution of the time, whatever the reason.
        let mut holds = |point: &FlightPoint| match self.prediction(point) {
            Ok(_) => 1.0,
            Err(end) => {
                reason = Some(end);
                -1.0
            }
        };
        let ends = [before, after].map(|point| (point.time, holds(point)));
        let time = root::bracketed(|time| holds(&flight.at(time)), ends[0], ends[1], 0.0);
        (time, reason)
    }
}
