//! The greatest value of a quantity of a landing, by linear programs within a region in which slopes are trusted.
//!
//! # Reference
//! R. Fletcher, Practical Methods of Optimization, 2nd edition (1987), section 14.4: sequential linear programming with an exact penalty.

use microlp::{ComparisonOp, OptimizationDirection, Problem};

use super::survey::{FlightIndex, Halt, Survey};

/// What is to be greatest: a value of a flight and, where it must stay on a line, how far it is off that, both in the same size.
pub(super) trait Objective<E> {
    /// None where the flight has none.
    fn value(&self, survey: &Survey<E>, flight: FlightIndex) -> Option<f64>;

    /// How far the flight is off the line; 0 where there is none.
    fn offset(&self, survey: &Survey<E>, flight: FlightIndex) -> f64;
}

/// By how much more than the value what is off the line, or breaks a limit, counts.
const PENALTY: f64 = 10.0;
/// The first radius of the region of trust, in parts of the ranges, the greatest, and that at which the search ends.
const RADII: [f64; 3] = [0.1, 0.3, 3e-4];
/// The step of the differences, in parts of the ranges.
const DIFFERENCE: f64 = 1e-5;
/// The margin that a step is to leave, since limits are not as straight as their slopes.
const SPARE: f64 = 1e-6;
/// Attempts to keep a limit again that is broken by little.
const MOST_RESTORATIONS: usize = 4;
/// Rounds at most.
const MOST_ROUNDS: usize = 60;

/// Maximises from a flight that lands, until no linear program gains more than `least`; gives the [best] flight.
pub(super) fn maximise<E>(
    survey: &mut Survey<E>,
    from: FlightIndex,
    objective: &dyn Objective<E>,
    least: f64,
) -> Result<FlightIndex, Halt<E>> {
    let [mut radius, widest, narrowest] = RADII;
    let mut best = from;
    let mut best_kept = survey.keeps(from).then_some(from);
    let mut slopes = None;
    for _ in 0..MOST_ROUNDS {
        let known = match slopes.take() {
            Some(known) => known,
            None => match Slopes::at(survey, best, objective)? {
                Some(known) => known,
                None => break,
            },
        };
        let Some((step, gain)) = known.step(survey, best, radius, SPARE) else { break };
        if gain < least {
            break;
        }
        let next = moved(survey, best, &step)?;
        let before = merit(survey, best, objective);
        let gained = merit(survey, next, objective) - before;
        if gained > 0.75 * gain {
            radius = (2.0 * radius).min(widest);
        } else if gained < 0.25 * gain {
            radius *= 0.3;
        }
        let is_best_kept = |kept| merit(survey, next, objective) > merit(survey, kept, objective);
        if survey.keeps(next) && best_kept.is_none_or(is_best_kept) {
            best_kept = Some(next);
        }
        if gained > 0.0 {
            best = next;
        } else {
            slopes = Some(known);
        }
        if radius < narrowest {
            break;
        }
    }
    let back = if survey.keeps(best) { Some(best) } else { restored(survey, best, objective)? };
    Ok(self::best(survey, [back, best_kept].into_iter().flatten(), objective).unwrap_or(best))
}

/// The flight with the greatest merit of those that keep all limits or, where none does, of all; none where there is none.
pub(super) fn best<E>(
    survey: &Survey<E>,
    flights: impl Iterator<Item = FlightIndex>,
    objective: &dyn Objective<E>,
) -> Option<FlightIndex> {
    let rank = |flight: &FlightIndex| (survey.keeps(*flight), merit(survey, *flight, objective));
    flights.max_by(|one, other| {
        let [one, other] = [rank(one), rank(other)];
        one.0.cmp(&other.0).then(one.1.total_cmp(&other.1))
    })
}

/// A flight near one that breaks a limit by little, which keeps it.
fn restored<E>(
    survey: &mut Survey<E>,
    from: FlightIndex,
    objective: &dyn Objective<E>,
) -> Result<Option<FlightIndex>, Halt<E>> {
    let mut flight = from;
    for _ in 0..MOST_RESTORATIONS {
        let Some(slopes) = Slopes::at(survey, flight, objective)? else { break };
        let spare = SPARE + 2.0 * (-slopes.own_margin).max(0.0);
        let Some((step, _)) = slopes.step(survey, flight, RADII[0], spare) else { break };
        flight = moved(survey, flight, &step)?;
        if survey.keeps(flight) {
            return Ok(Some(flight));
        }
    }
    Ok(None)
}

/// The flight a step away.
fn moved<E>(survey: &mut Survey<E>, from: FlightIndex, step: &[f64]) -> Result<FlightIndex, Halt<E>> {
    let place = survey.flights[from].place.iter().zip(step).map(|(part, step)| (part + step).clamp(0.0, 1.0));
    survey.fly(place.collect())
}

/// The value less what is off the line and what breaks limits; the least of all where the flight has none.
fn merit<E>(survey: &Survey<E>, flight: FlightIndex, objective: &dyn Objective<E>) -> f64 {
    let Some(value) = objective.value(survey, flight) else { return f64::NEG_INFINITY };
    let broken = (-survey.flights[flight].outcome.margin).max(0.0);
    value - PENALTY * (objective.offset(survey, flight).abs() + broken)
}

/// The slopes by every number, as parts of its range.
struct Slopes {
    value: Vec<f64>,
    offset: Vec<f64>,
    margin: Vec<f64>,
    /// At the flight itself.
    own_offset: f64,
    own_margin: f64,
}

impl Slopes {
    /// By differences; none where the flight has no value.
    fn at<E>(
        survey: &mut Survey<E>,
        flight: FlightIndex,
        objective: &dyn Objective<E>,
    ) -> Result<Option<Self>, Halt<E>> {
        let Some(own) = objective.value(survey, flight) else { return Ok(None) };
        let own_offset = objective.offset(survey, flight);
        let own_margin = survey.flights[flight].outcome.margin;
        let count = survey.numbers.len();
        let mut slopes = Self {
            value: vec![0.0; count],
            offset: vec![0.0; count],
            margin: vec![0.0; count],
            own_offset,
            own_margin,
        };
        for axis in 0..count {
            let part = survey.flights[flight].place[axis];
            let first = if part > 0.5 { -DIFFERENCE } else { DIFFERENCE };
            // Where flights on one side do not land, the other may.
            for step in [first, -first] {
                if !(0.0..=1.0).contains(&(part + step)) {
                    continue;
                }
                let mut place = survey.flights[flight].place.clone();
                place[axis] = part + step;
                let moved = survey.fly(place)?;
                let Some(value) = objective.value(survey, moved) else { continue };
                slopes.value[axis] = (value - own) / step;
                slopes.offset[axis] = (objective.offset(survey, moved) - own_offset) / step;
                let margin = (survey.flights[moved].outcome.margin - own_margin) / step;
                slopes.margin[axis] = if margin.is_finite() { margin } else { 0.0 };
                break;
            }
        }
        Ok(Some(slopes))
    }

    /// The step within a radius that gains most by the slopes, and what it gains; none where no program can be solved.
    fn step<E>(&self, survey: &Survey<E>, flight: FlightIndex, radius: f64, spare: f64) -> Option<(Vec<f64>, f64)> {
        let mut program = Problem::new(OptimizationDirection::Maximize);
        let place = &survey.flights[flight].place;
        let steps: Vec<_> = self
            .value
            .iter()
            .zip(place)
            .map(|(slope, part)| {
                program.add_var(*slope * radius, ((-part / radius).max(-1.0), ((1.0 - part) / radius).min(1.0)))
            })
            .collect();
        let slack = [(); 3].map(|()| program.add_var(-PENALTY, (0.0, f64::INFINITY)));
        let row =
            |slopes: &[f64]| steps.iter().zip(slopes).map(|(step, slope)| (*step, slope * radius)).collect::<Vec<_>>();
        let mut on_line = row(&self.offset);
        on_line.extend([(slack[0], 1.0), (slack[1], -1.0)]);
        program.add_constraint(on_line, ComparisonOp::Eq, -self.own_offset);
        let mut broken = -self.own_margin;
        if self.own_margin.is_finite() {
            let mut kept = row(&self.margin);
            kept.push((slack[2], 1.0));
            program.add_constraint(kept, ComparisonOp::Ge, spare - self.own_margin);
        } else {
            broken = 0.0;
        }
        let solution = program.solve().ok()?.into_solution().ok()?;
        let step: Vec<_> = steps.iter().map(|step| solution.var_value(*step) * radius).collect();
        let now = -PENALTY * (self.own_offset.abs() + broken.max(0.0));
        Some((step, solution.objective() - now))
    }
}
