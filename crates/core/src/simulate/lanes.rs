//! Many flights at once, in the lanes of one computation.

use std::array::from_fn;

use super::flight::Flight;
use super::{SimulationError, arrival};
use crate::integrate::{System, try_in_lanes};
use crate::interrupt::Interrupt;
use crate::motion::{Cartesian, Forces, Formulation, Parameters, Spherical};
use crate::scalar::Lanes;
use crate::scenario::{Case, Equations, Scenario};
use crate::trajectory::Arrival;

/// The end of a flight.
type End = Result<Arrival, SimulationError>;

/// Flies scenarios, `L` of them at once, to their ends: what [`arrival`](super::arrival) gives for each, to the last digit.
///
/// Every flight has steps of its own, and its lane takes the next one when it has ended. Neighbours share the lanes
/// if their models and their formulations are the same. Where the formulas of models change on the way, a flight is flown alone,
/// since every lane would need its own; so are heated flights, and those on which something is watched. Where a flight is stiff, it leaves
/// its lane for as long.
pub fn arrivals<const L: usize>(scenarios: &[Scenario], interrupt: &dyn Interrupt) -> Vec<End> {
    let shared = |scenario: &Scenario| {
        let case = scenario.case();
        (case.models(), case.solver.equations, flies_alone(case))
    };
    let mut ends = Vec::with_capacity(scenarios.len());
    for group in scenarios.chunk_by(|a, b| shared(a) == shared(b)) {
        let Some(case) = group.first().map(Scenario::case) else { continue };
        if case.forces().has_switches() || flies_alone(case) {
            ends.extend(group.iter().map(|scenario| arrival(scenario, interrupt)));
            continue;
        }
        ends.extend(match case.solver.equations {
            Equations::Cartesian => fly_in_lanes::<_, _, L>(group, interrupt, Cartesian, Cartesian),
            Equations::Spherical => fly_in_lanes::<_, _, L>(group, interrupt, Spherical, Spherical),
        });
    }
    ends
}

/// Whether more may happen in a flight than lanes know: something is watched, heated or held, or made of parts.
fn flies_alone(case: &Case) -> bool {
    case.is_watched() || case.heating.is_some() || case.hold_down || !case.parts.is_empty()
}

/// A flight, and its place among the scenarios.
struct Lane<'a, F> {
    index: usize,
    flight: Flight<'a, F, 6>,
}

/// Flies scenarios of the same models in a formulation, of which each has one `alone` and all lanes have one `in_lanes`.
fn fly_in_lanes<'a, F: Formulation<6>, M: System<Lanes<L>, 6>, const L: usize>(
    scenarios: &'a [Scenario],
    interrupt: &'a dyn Interrupt,
    alone: impl Fn(Forces) -> F,
    in_lanes: impl Fn(Forces<Lanes<L>>) -> M,
) -> Vec<End> {
    let mut ends: Vec<End> = scenarios.iter().map(|_| Err(SimulationError::Interrupted { time: 0.0 })).collect();
    let mut waiting = scenarios.iter().enumerate();
    let mut next = |ends: &mut [End]| {
        let start = |scenario: &'a Scenario| Flight::start(scenario, alone(scenario.case().forces()), interrupt);
        waiting.find_map(|(index, scenario)| {
            let begun = start(scenario).and_then(|mut flight| Ok((flight.begin()?, flight)));
            match begun {
                Ok((None, flight)) => return Some(Lane { index, flight }),
                Ok((Some(arrival), _)) => ends[index] = Ok(arrival),
                Err(error) => ends[index] = Err(error),
            }
            None
        })
    };
    let mut lanes: [Option<Lane<F>>; L] = from_fn(|_| next(&mut ends));
    let mut system = None;
    while lanes.iter().any(Option::is_some) {
        let cases = lanes.each_ref().map(|lane| scenarios[lane.as_ref().map_or(0, |lane| lane.index)].case());
        let motion = system.get_or_insert_with(|| in_lanes(forces(cases)));
        let flights = lanes.each_mut().map(|lane| {
            let Flight { integrator, motion, scenario, .. } = &mut lane.as_mut()?.flight;
            Some((integrator, &*motion, scenario.case().stop.time))
        });
        let steps = try_in_lanes(motion, flights);
        for (lane, step) in lanes.iter_mut().zip(steps) {
            let (Some(Lane { index, flight }), Some(step)) = (lane.as_mut(), step) else { continue };
            let end = match step {
                Ok(step) => flight.pass(&step, &mut |_| Ok(())).transpose(),
                Err(error) => Some(Err(flight.failure(error))),
            };
            let end = end.or_else(|| fly_while_stiff(flight));
            if let Some(end) = end {
                ends[*index] = end;
                *lane = next(&mut ends);
                system = None;
            }
        }
    }
    ends
}

/// Flies alone, out of the lanes, as long as steps are implicit; returns the end of the flight, if it came to that.
fn fly_while_stiff<F: Formulation<6>>(flight: &mut Flight<F, 6>) -> Option<End> {
    while flight.integrator.is_stiff() {
        let end = flight.advance().and_then(|step| flight.pass(&step, &mut |_| Ok(()))).transpose();
        if end.is_some() {
            return end;
        }
    }
    None
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
