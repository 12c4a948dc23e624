//! Outputs of a flight, and their slopes by numbers of its case.

use std::cell::Cell;

use super::WIDTH;
use super::follow::{Follow, Place, Sample};
use super::variation::{CENTRAL, Dual, Node, Variation, VariedCase, slope};
use crate::interrupt::Interrupt;
use crate::motion::State;
use crate::root::bracketed;
use crate::scenario::dispatch;
use crate::simulate::SimulationError;
use crate::trajectory::{FlightPoint, Origin, Trajectory};

/// When an output is taken from a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Moment {
    /// At the start, before what happens then.
    Start,
    /// At the end, after what happens then.
    End,
    /// At a time, s, whatever varies.
    Time(f64),
    /// At the event of this place in the list of the case.
    Event {
        /// The place of the event.
        event: usize,
        /// Whether after its effect.
        after: bool,
    },
    /// Where the output is greatest over the flight.
    Peak,
    /// Where the output is least over the flight.
    Lowest,
}

/// The case from which an output is computed: that of the flight, or one in which the number of a variation is moved.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moved {
    /// The place of the variation.
    pub variation: usize,
    /// By how much its number is moved, in its own unit.
    pub offset: f64,
}

/// An output of a flight: a number of its state at a moment.
pub struct Output<'a> {
    /// The moment.
    pub at: Moment,
    /// The number; none where the state has none. What it takes from the case itself and not from the state, it takes from the moved one
    /// where there is one.
    pub value: &'a dyn Fn(&FlightPoint, Option<Moved>) -> Option<f64>,
    /// The turn of a number that is an angle, in its unit, by which its differences are taken on the circle.
    pub turn: Option<f64>,
    /// Whether the number takes the ground distance from the state: its derivatives are followed only where they are needed.
    pub takes_ground_distance: bool,
}

/// An output, and how it depends on the numbers that vary.
#[derive(Clone, Debug, PartialEq)]
pub struct Slopes {
    /// The time of its moment, s; none where the flight has none: an event that did not happen, a time after its end.
    pub time: Option<f64>,
    /// The output; none where it has none.
    pub value: Option<f64>,
    /// Its derivative by each of the variations, the change of its moment included; not a finite number where there is none.
    pub slopes: Vec<f64>,
}

/// The derivatives of outputs of a flight by the numbers that vary.
///
/// The derivative of a peak is that of the quantity at its time: where a smooth peak lies does not matter to first order.
///
/// # Errors
/// When the flag is raised, at which it looks before every step.
pub fn slopes(
    flight: &Trajectory,
    variations: &[Variation],
    outputs: &[Output],
    interrupt: &dyn Interrupt,
) -> Result<Vec<Slopes>, SimulationError> {
    let places: Vec<Option<Place>> =
        outputs.iter().map(|output| place(flight, output, interrupt)).collect::<Result<_, _>>()?;
    let mut slopes: Vec<Slopes> = outputs
        .iter()
        .map(|_| Slopes { time: None, value: None, slopes: Vec::with_capacity(variations.len()) })
        .collect();
    // Without variations there still are the outputs themselves.
    let passes = variations.len().div_ceil(WIDTH).max(1);
    for first in (0..passes).map(|pass| pass * WIDTH) {
        let last = variations.len().min(first + WIDTH);
        add_slopes(flight, first, &variations[first..last], outputs, &places, &mut slopes, interrupt)?;
    }
    Ok(slopes)
}

/// The point of a flight at a moment: at that of a peak, or of what is lowest, where `value` is; none where the flight has no such moment.
///
/// # Errors
/// When the flag is raised, at which it looks before every step of a search for a peak.
pub fn point_at(
    flight: &Trajectory,
    at: Moment,
    value: &dyn Fn(&FlightPoint) -> Option<f64>,
    interrupt: &dyn Interrupt,
) -> Result<Option<FlightPoint>, SimulationError> {
    let of_point = |point: &FlightPoint, _: Option<Moved>| value(point);
    let output = Output { at, value: &of_point, turn: None, takes_ground_distance: false };
    let at_end = |step: usize, part: f64| Some(flight.inside(flight.flown.steps.get(step)?).point(part));
    Ok(match place(flight, &output, interrupt)? {
        None => None,
        Some(Place::Start) => Some(flight.initial()),
        Some(Place::End) => Some(flight.last()),
        Some(Place::Inside { time, .. }) => Some(flight.at(time)),
        Some(Place::StepStart(step)) => at_end(step, 0.0),
        Some(Place::StepEnd(step)) => at_end(step, 1.0),
        Some(Place::Before(record)) => flight.events().nth(record).map(|event| event.before),
        Some(Place::After(record)) => flight.events().nth(record).map(|event| event.after),
    })
}

/// Adds the slopes by some variations, of which the first has this place among all.
fn add_slopes(
    flight: &Trajectory,
    first: usize,
    variations: &[Variation],
    outputs: &[Output],
    places: &[Option<Place>],
    slopes: &mut [Slopes],
    interrupt: &dyn Interrupt,
) -> Result<(), SimulationError> {
    let case = &flight.case;
    let changes_models: Vec<bool> = variations.iter().map(|variation| variation.changes_models(case)).collect();
    let mut wanted: Vec<Place> = Vec::new();
    for place in places.iter().flatten() {
        if !wanted.contains(place) {
            wanted.push(*place);
        }
    }
    let varied = VariedCase::<WIDTH> { case, variations, start: None };
    let follow = Follow {
        flight,
        varied,
        changes_models: &changes_models,
        places: &wanted,
        with_ground_distance: outputs.iter().any(|output| output.takes_ground_distance),
        interrupt,
    };
    let samples = dispatch(case.solver.equations, case.state_layout(), follow)?;
    let near: Vec<_> =
        samples.iter().map(|sample| Some(VariedSample::new(flight, &varied, first, sample.as_ref()?))).collect();
    for ((place, output), row) in places.iter().zip(outputs).zip(slopes) {
        let near = place.and_then(|place| near[wanted.iter().position(|wanted| *wanted == place)?].as_ref());
        let Some(near) = near else {
            row.slopes.extend(variations.iter().map(|_| f64::NAN));
            continue;
        };
        row.time = Some(near.point.time);
        row.value = (output.value)(&near.point, None);
        row.slopes.extend((0..variations.len()).map(|variation| near.slope(output, variation)));
    }
    Ok(())
}

/// The points near a sample, by which outputs have their slopes.
struct VariedSample<'a, const W: usize> {
    flight: &'a Trajectory,
    varied: &'a VariedCase<'a, W>,
    /// The place of the first variation among all.
    first: usize,
    sample: &'a Sample<W>,
    /// The point of the sample itself.
    point: FlightPoint,
    /// Of each variation; none where there is no derivative.
    moved_points: Vec<Option<MovedPoints>>,
}

/// The points to which the number of a variation leads.
struct MovedPoints {
    /// Where it moves the state and the vehicle, if it does: the step, and the points of the differences.
    by_state: Option<(f64, [FlightPoint; 4])>,
    /// Where it moves the models, for each of its nodes.
    by_models: Vec<FlightPoint>,
}

/// The part of its own size by which a state is moved to find the slope of an output: differences of fourth order then are exact to ten
/// digits even of a density, whose scale is a thousandth of the radius.
const MOVED: f64 = 1e-5;
/// Numbers of the vehicle that are smaller count as if they had this size, in their units.
const LEAST_SIZE: f64 = 1e-3;

impl<'a, const W: usize> VariedSample<'a, W> {
    fn new(flight: &'a Trajectory, varied: &'a VariedCase<'a, W>, first: usize, sample: &'a Sample<W>) -> Self {
        let Sample { time, state, phase, mode, .. } = sample;
        let phase = phase.map(|number| number.re);
        let mut forces = phase.forces(&*flight.case);
        forces.enter(*mode);
        let point = flight.point_from(&flight.origin, &forces, &phase, time.re, &state.map(|number| number.re));
        let mut near = Self { flight, varied, first, sample, point, moved_points: Vec::new() };
        near.moved_points = (0..varied.variations.len()).map(|variation| near.moved_points(variation)).collect();
        near
    }

    fn moved_points(&self, variation: usize) -> Option<MovedPoints> {
        let number = &self.varied.variations[variation];
        if number.changes_phases(&self.flight.case) {
            return None;
        }
        let by_state = self
            .step(variation)
            .map(|step| (step, CENTRAL.map(|(times, _)| self.with_state_moved(variation, times * step))));
        let changes_forces = number.changes_forces_beside_vehicle(&self.flight.case);
        let of_node = |node: &Node| if changes_forces { self.with_models_moved(node) } else { self.point };
        Some(MovedPoints { by_state, by_models: number.nodes().iter().map(of_node).collect() })
    }

    /// The derivative of the output by a variation: by the way it moves the state and the vehicle, and by the models that it moves.
    fn slope(&self, output: &Output, variation: usize) -> f64 {
        let value = (output.value)(&self.point, None);
        let (Some(value), Some(moved_points)) = (value, &self.moved_points[variation]) else { return f64::NAN };
        let difference = |moved: Option<f64>| {
            let difference = moved.map_or(f64::NAN, |moved| moved - value);
            output.turn.map_or(difference, |turn| difference - turn * (difference / turn).round())
        };
        let by_state = moved_points.by_state.as_ref().map_or(0.0, |(step, points)| {
            let weighted =
                |((_, weight), point): (&(f64, f64), &FlightPoint)| weight * difference((output.value)(point, None));
            CENTRAL.iter().zip(points).map(weighted).sum::<f64>() / step
        });
        let of_node = |(node, point): (&Node, &FlightPoint)| {
            let moved = Moved { variation: self.first + variation, offset: node.offset };
            node.weight * difference((output.value)(point, Some(moved)))
        };
        let nodes = self.varied.variations[variation].nodes();
        by_state + nodes.iter().zip(&moved_points.by_models).map(of_node).sum::<f64>()
    }

    /// The point where the number of a variation has moved the state, the vehicle, and the place from which the flight sets out, by an
    /// offset.
    fn with_state_moved(&self, variation: usize, offset: f64) -> FlightPoint {
        let Sample { time, state, ground_distance, phase, mode } = self.sample;
        let moved = |number: Dual<W>| number.re + offset * slope(&number, variation);
        let origin = Origin::of(&State::from(self.varied.track_start()).map(moved).planet_fixed());
        let phase = phase.map(moved);
        let mut forces = phase.forces(&*self.flight.case);
        forces.enter(*mode);
        let point = self.flight.point_from(&origin, &forces, &phase, moved(*time), &state.map(moved));
        let ground_distance = self.point.ground_distance + offset * slope(ground_distance, variation);
        FlightPoint { ground_distance, ..point }
    }

    /// The point where the number of a variation is moved in the models, while the vehicle and its state stay.
    fn with_models_moved(&self, node: &Node) -> FlightPoint {
        let Sample { time, state, phase, mode, .. } = self.sample;
        let phase = phase.map(|number| number.re);
        let mut forces = phase.with_models_of(&node.case).forces(&node.case);
        forces.enter(*mode);
        self.flight.point_from(&self.flight.origin, &forces, &phase, time.re, &state.map(|number| number.re))
    }

    /// The offset of a variation that moves the state and the vehicle by a small part of their sizes; none where it does not move them.
    fn step(&self, variation: usize) -> Option<f64> {
        let Sample { time, state, ground_distance, phase, .. } = self.sample;
        let State { position, velocity, heat_load, .. } = state.map(|number| number.re);
        let rates = state.map(|number| slope(&number, variation));
        let start = State::from(self.varied.start()).map(|number| slope(&number, variation));
        let radius = position.norm();
        // The least speed that counts, where the vehicle is nearly at rest.
        let least = 1e-3 * (self.flight.case.planet.gravitational_parameter / radius).sqrt();
        let speed = velocity.norm().max(least);
        let start_speed = self.flight.case.initial_state.velocity.norm().max(least);
        let of_phase = Cell::new(0.0_f64);
        let _ = phase.map(|number| {
            let size = if number.re == 0.0 { 1.0 } else { number.re.abs().max(LEAST_SIZE) };
            of_phase.set(of_phase.get().max(slope(&number, variation).abs() / size));
        });
        let sizes = [
            rates.position.norm() / radius,
            rates.velocity.norm() / speed,
            slope(time, variation).abs() * speed / radius,
            rates.heat_load.unwrap_or(0.0).abs() / heat_load.unwrap_or(0.0).abs().max(1.0),
            slope(ground_distance, variation).abs() / radius,
            start.position.norm() / radius,
            start.velocity.norm() / start_speed,
            of_phase.get(),
        ];
        let size = sizes.into_iter().fold(0.0, f64::max);
        (size > 0.0).then(|| MOVED / size)
    }
}

/// Where an output is taken from the flight; none where the flight has no such moment.
fn place(flight: &Trajectory, output: &Output, interrupt: &dyn Interrupt) -> Result<Option<Place>, SimulationError> {
    let steps = &flight.flown.steps;
    Ok(match output.at {
        Moment::Start => Some(Place::Start),
        Moment::End => Some(Place::End),
        Moment::Event { event, after } => {
            let record = flight.flown.event_records.iter().position(|record| record.event == event);
            record.map(if after { Place::After } else { Place::Before })
        }
        Moment::Time(time) => {
            let step = steps.partition_point(|step| step.end_time() <= time);
            let inside = |step: usize| (time < flight.end_time()).then_some(Place::Inside { step, time });
            if time <= flight.flown.start.time { Some(Place::Start) } else { inside(step) }
        }
        Moment::Peak => extremum(flight, &|point| (output.value)(point, None), interrupt)?,
        Moment::Lowest => extremum(flight, &|point| Some(-(output.value)(point, None)?), interrupt)?,
    })
}

/// Points of a step at which a quantity is looked at, its ends included: between two of them it is taken to turn no more than once.
const LOOKS: usize = 9;
/// The part of a step over which a quantity is differenced to find where it turns: the differences of fourth order leave no more than the
/// noise of the motion inside a step, which a comparison of values would meet far from the peak, where it is flat.
const NEIGHBOUR: f64 = 1.0 / 512.0;

/// Where a quantity is greatest; none where it is nowhere a number.
fn extremum(
    flight: &Trajectory,
    value: &dyn Fn(&FlightPoint) -> Option<f64>,
    interrupt: &dyn Interrupt,
) -> Result<Option<Place>, SimulationError> {
    let steps = &flight.flown.steps;
    let mut greatest: Option<(f64, Place)> = None;
    let mut offer = |at: Option<f64>, place: Place| {
        if let Some(at) = at.filter(|at| greatest.is_none_or(|(greatest, _)| *at > greatest)) {
            greatest = Some((at, place));
        }
    };
    for (index, step) in steps.iter().enumerate() {
        if interrupt.is_raised() {
            return Err(SimulationError::Interrupted { time: step.start_time() });
        }
        let inside = flight.inside(step);
        let at = |part: f64| value(&inside.point(part));
        #[expect(clippy::cast_precision_loss, reason = "a handful")]
        let part = |look: usize| look as f64 / (LOOKS - 1) as f64;
        let looks: [Option<f64>; LOOKS] = std::array::from_fn(|look| at(part(look)));
        offer(looks[0], Place::StepStart(index));
        for look in 0..LOOKS {
            let [first, last] = [look.saturating_sub(1), (look + 1).min(LOOKS - 1)];
            let here = looks[look];
            if here.is_none() || here < looks[first] || here < looks[last] {
                continue;
            }
            // What is greatest at an end of the step may turn just beside it.
            let is_end = look == 0 || look == LOOKS - 1;
            let turn = turn(&at, [part(first), part(last)]);
            if let Some(part) = turn.or((!is_end).then_some(part(look))) {
                offer(at(part), Place::Inside { step: index, time: step.time(part) });
            }
        }
        offer(looks[LOOKS - 1], Place::StepEnd(index));
    }
    if steps.is_empty() {
        return Ok(Some(Place::End));
    }
    Ok(greatest.map(|(_, place)| place))
}

/// Where in a range of a step a quantity turns from growing to falling, if it does so smoothly.
fn turn(at: &impl Fn(f64) -> Option<f64>, [low, high]: [f64; 2]) -> Option<f64> {
    let value = |part: f64| at(part).unwrap_or(f64::NAN);
    let slope = |part: f64| {
        let at = |times: f64| value(part + times * NEIGHBOUR);
        // By an end of the step, of second order to the side on which the step is.
        if part < 2.0 * NEIGHBOUR {
            6.0 * (4.0 * at(1.0) - 3.0 * at(0.0) - at(2.0))
        } else if part > 1.0 - 2.0 * NEIGHBOUR {
            6.0 * (3.0 * at(0.0) - 4.0 * at(-1.0) + at(-2.0))
        } else {
            8.0 * (at(1.0) - at(-1.0)) - (at(2.0) - at(-2.0))
        }
    };
    let [first, last] = [low, high].map(|part| (part, slope(part)));
    (first.1 > 0.0 && last.1 < 0.0).then(|| bracketed(slope, first, last, f64::EPSILON))
}
