//! Many flights at once, in the lanes of one computation.

use std::array::from_fn;
use std::sync::atomic::AtomicBool;

use super::SimulationError;
use super::flight::Flight;
use crate::integrate::{System, try_abreast};
use crate::motion::{Cartesian, Forces, Formulation, Parameters, Spherical};
use crate::scalar::Lanes;
use crate::scenario::{Case, Equations, Scenario};
use crate::trajectory::Arrival;

/// The end of a flight.
type End = Result<Arrival, SimulationError>;

/// Flies scenarios, `L` of them at once, to their ends: what [`arrival`](super::arrival) gives for each, to the last digit.
///
/// Every flight has steps of its own, and its lane takes the next one when it has ended. Neighbours share the lanes
/// if their models and their formulations are the same.
pub fn arrivals<const L: usize>(scenarios: &[Scenario], interrupt: &AtomicBool) -> Vec<End> {
    let shared = |scenario: &Scenario| (scenario.case().models(), scenario.case().solver.equations);
    let mut ends = Vec::with_capacity(scenarios.len());
    for group in scenarios.chunk_by(|a, b| shared(a) == shared(b)) {
        ends.extend(match group.first().map(|scenario| scenario.case().solver.equations) {
            Some(Equations::Spherical) => fly_abreast::<_, _, L>(group, interrupt, Spherical, Spherical),
            _ => fly_abreast::<_, _, L>(group, interrupt, Cartesian, Cartesian),
        });
    }
    ends
}

/// A flight, and its place among the scenarios.
struct Lane<'a, F> {
    index: usize,
    flight: Flight<'a, F>,
}

/// Flies scenarios of the same models in a formulation, of which each has one `alone` and all lanes have one `abreast`.
fn fly_abreast<F: Formulation, M: System<Lanes<L>, 6>, const L: usize>(
    scenarios: &[Scenario],
    interrupt: &AtomicBool,
    alone: impl Fn(Forces) -> F,
    abreast: impl Fn(Forces<Lanes<L>>) -> M,
) -> Vec<End> {
    let motions: Vec<F> = scenarios.iter().map(|scenario| alone(scenario.case().forces())).collect();
    let mut ends: Vec<End> = scenarios.iter().map(|_| Err(SimulationError::Interrupted { time: 0.0 })).collect();
    let mut waiting = scenarios.iter().zip(&motions).enumerate();
    let mut next = |ends: &mut [End]| {
        waiting.find_map(|(index, (scenario, motion))| match Flight::start(scenario, motion, interrupt) {
            Ok(flight) if !scenario.ends_at_start() => Some(Lane { index, flight }),
            other => {
                ends[index] = other.map(|flight| flight.at_start());
                None
            }
        })
    };
    let mut lanes: [Option<Lane<F>>; L] = from_fn(|_| next(&mut ends));
    let mut system = None;
    while lanes.iter().any(Option::is_some) {
        let cases = lanes.each_ref().map(|lane| scenarios[lane.as_ref().map_or(0, |lane| lane.index)].case());
        let abreast = system.get_or_insert_with(|| abreast(forces(cases)));
        let integrators = lanes.each_mut().map(|lane| lane.as_mut().map(|lane| &mut lane.flight.integrator));
        let steps = try_abreast(abreast, integrators, cases.map(|case| case.stop.time));
        for (lane, step) in lanes.iter_mut().zip(steps) {
            let (Some(Lane { index, flight }), Some(step)) = (lane.as_mut(), step) else { continue };
            let end = match step {
                Ok(step) => flight.pass(step, &mut |_| Ok(())).transpose(),
                Err(error) => Some(Err(flight.failure(error))),
            };
            if let Some(end) = end {
                ends[*index] = end;
                *lane = next(&mut ends);
                system = None;
            }
        }
    }
    ends
}

/// The forces on the vehicles of these cases, whose models are the same.
fn forces<const L: usize>(cases: [&Case; L]) -> Forces<Lanes<L>> {
    let parameters = cases.map(Case::parameters);
    let of_lanes = |number: fn(&Parameters<f64>) -> f64| Lanes(parameters.each_ref().map(number));
    let parameters = Parameters {
        mass: of_lanes(|parameters| parameters.mass),
        reference_area: of_lanes(|parameters| parameters.reference_area),
        lift_coefficient: of_lanes(|parameters| parameters.lift_coefficient),
        drag_coefficient: of_lanes(|parameters| parameters.drag_coefficient),
        density: of_lanes(|parameters| parameters.density),
        bank_angle: of_lanes(|parameters| parameters.bank_angle),
    };
    Forces::new(cases[0].models(), parameters)
}
