//! Where flights land when one number varies: a line, in parts where limits are broken between.

use super::plane::Point;
use super::survey::{FlightIndex, Halt, Survey, distance, off_middle};
use super::{LONGEST, MOST_ROUNDS};

/// The flights along the range, ascending.
pub(super) struct Curve {
    flights: Vec<FlightIndex>,
    /// By how much the chord from each flight to the next may be off, m: without bound before that is known.
    chord_errors: Vec<f64>,
    resolution: f64,
}

/// The chords of the halves of a smooth curve are off by this part of what that of the whole is.
const OF_HALVES: f64 = 0.25;

impl Curve {
    /// The curve of flights at even places of the range.
    pub(super) fn new(flights: Vec<FlightIndex>, resolution: f64) -> Self {
        let chord_errors = vec![f64::INFINITY; flights.len().saturating_sub(1)];
        Self { flights, chord_errors, resolution }
    }

    /// By how much a chord may be off, m.
    pub(super) fn error(&self) -> f64 {
        self.chord_errors.iter().copied().fold(0.0, f64::max)
    }

    /// Halves intervals until no chord is off its curve by more than the resolution.
    pub(super) fn refine<E>(&mut self, survey: &mut Survey<E>) -> Result<(), Halt<E>> {
        for _ in 0..MOST_ROUNDS {
            if self.error() <= self.resolution {
                break;
            }
            let mut finer = vec![self.flights[0]];
            let mut finer_errors = Vec::new();
            for (pair, error) in self.flights.windows(2).zip(&self.chord_errors) {
                let [before, after] = [pair[0], pair[1]];
                let middle = if *error > self.resolution { halved(survey, before, after)? } else { None };
                match middle {
                    Some((middle, error)) => {
                        finer.push(middle);
                        finer_errors.extend([OF_HALVES * error; 2]);
                    }
                    // Of a chord whose ends do not keep the limits, or does not need to be halved.
                    None => finer_errors.push(if *error > self.resolution { 0.0 } else { *error }),
                }
                finer.push(after);
            }
            (self.flights, self.chord_errors) = (finer, finer_errors);
        }
        self.cut(survey)
    }

    /// Ends every part at the last flight that keeps all limits.
    fn cut<E>(&mut self, survey: &mut Survey<E>) -> Result<(), Halt<E>> {
        let mut whole = Vec::with_capacity(self.flights.len());
        for pair in self.flights.windows(2) {
            let [before, after] = [pair[0], pair[1]];
            whole.push(before);
            match [survey.keeps(before), survey.keeps(after)] {
                [true, false] => whole.push(survey.last_kept(before, after, self.resolution)?),
                [false, true] => whole.push(survey.last_kept(after, before, self.resolution)?),
                _ => {}
            }
        }
        whole.extend(self.flights.last());
        self.flights = whole;
        Ok(())
    }

    /// The lines of flights that keep all limits.
    pub(super) fn lines<E>(&self, survey: &Survey<E>) -> Vec<Vec<Point>> {
        let kept = self.flights.split(|flight| !survey.keeps(*flight));
        let line = |flights: &[FlightIndex]| flights.iter().filter_map(|flight| survey.point(*flight)).collect();
        kept.map(line).filter(|line: &Vec<Point>| line.len() > 1).collect()
    }
}

/// The flight in the middle of an interval, and how far it is off the chord; none where the interval is not to be halved.
fn halved<E>(
    survey: &mut Survey<E>,
    before: FlightIndex,
    after: FlightIndex,
) -> Result<Option<(FlightIndex, f64)>, Halt<E>> {
    let ends = [before, after].map(|flight| survey.kept_point(flight));
    let [Some(one), Some(other)] = ends else { return Ok(None) };
    let middle = survey.fly(survey.between(before, after, 0.5))?;
    let error = survey.kept_point(middle).map_or(f64::INFINITY, |point| off_middle(point, one, other));
    let error = if distance(one, other) > LONGEST { f64::INFINITY } else { error };
    Ok(Some((middle, error)))
}
