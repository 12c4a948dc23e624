//! A theory along a whole flight: its predictions, and the part over which it holds.

use super::{End, Prediction, Theory};
use crate::interrupt::Interrupt;
use crate::root;
use crate::simulate::SimulationError;
use crate::trajectory::{FlightPoint, Sampling, Trajectory};

/// Where a step is looked at for what a theory has to say: at so many parts of it.
const LOOKS_A_STEP: usize = 8;
/// So many points are looked at before the flag is.
const LOOKS_AT_ONCE: usize = 1024;

/// A theory beside a flight.
#[derive(Clone, Debug, PartialEq)]
pub struct Comparison {
    /// One a point.
    pub predictions: Vec<Prediction>,
    /// Where the theory holds.
    pub validity: Validity,
}

/// The part of a flight, in time order, outside which a theory gives no numbers.
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
    ///
    /// # Errors
    /// When the flag is raised, at which it looks every few points.
    pub fn compare(
        &self,
        flight: &Trajectory,
        points: &[FlightPoint],
        interrupt: &dyn Interrupt,
    ) -> Result<Comparison, SimulationError> {
        let (validity, until) = self.validity(flight, interrupt)?;
        let predictions = points.iter().map(|point| match self.prediction(point) {
            Ok(prediction) if point.time <= until => prediction,
            _ => Prediction::default(),
        });
        Ok(Comparison { predictions: predictions.collect(), validity })
    }

    /// Where the theory holds, and until when, s; it is looked at within the steps of the flight, whatever rows are wanted.
    fn validity(&self, flight: &Trajectory, interrupt: &dyn Interrupt) -> Result<(Validity, f64), SimulationError> {
        let over = End::Flight(flight.termination());
        let (mut from, mut to, mut first_reason) = (None, None, None);
        let (mut before, mut holds) = (0.0, false);
        let instants = flight.instants(&Sampling::PerStep(LOOKS_A_STEP), usize::MAX).unwrap_or_default();
        // A flight may have so many steps that its points together would fill the memory.
        'flight: for instants in instants.chunks(LOOKS_AT_ONCE) {
            if interrupt.is_raised() {
                return Err(SimulationError::Interrupted { time: before });
            }
            for point in flight.points(instants) {
                match self.prediction(&point) {
                    Ok(_) => {
                        from = from.or_else(|| Some(self.edge(flight, before, point.time).0));
                        (holds, to) = (true, None);
                    }
                    Err(reason) if !holds => first_reason = first_reason.or(Some(reason)),
                    Err(_) => {
                        (holds, to) = (false, Some(self.edge(flight, before, point.time)));
                        if self.solution.descends() {
                            break 'flight;
                        }
                    }
                }
                before = point.time;
            }
        }
        let Some(from) = from else {
            let end = first_reason.unwrap_or(over);
            return Ok((Validity { from_altitude: None, to_altitude: None, end }, f64::NEG_INFINITY));
        };
        let (to, end) = to.map_or((flight.end_time(), over), |(time, reason)| (time, reason.unwrap_or(over)));
        let altitude = |time: f64| Some(flight.at(time).loads.altitude).filter(|altitude| altitude.is_finite());
        Ok((Validity { from_altitude: altitude(from), to_altitude: altitude(to), end }, to))
    }

    /// The time, s, between two at which the theory begins or ends to give numbers, and why it gives none on the one side; where it
    /// gives numbers at both, the earlier.
    fn edge(&self, flight: &Trajectory, before: f64, after: f64) -> (f64, Option<End>) {
        let mut reason = None;
        // A function of two values: the root is found by bisection, to the resolution of the time, whatever the reason.
        let mut holds = |time: f64| match self.prediction(&flight.at(time)) {
            Ok(_) => 1.0,
            Err(end) => {
                reason = Some(end);
                -1.0
            }
        };
        let [start, end] = [before, after].map(|time| (time, holds(time)));
        let time = if start.1 * end.1 < 0.0 { root::bracketed(holds, start, end, 0.0) } else { before };
        (time, reason)
    }
}
