//! Flights that share the lanes of a computation are, to the last digit, what they are alone.

use std::sync::atomic::AtomicBool;

use reentry::integrate::{LaneInstructions, lane_instructions, use_lanes};
use reentry::simulate::{arrival, ends, ends_of_all, extremes, extremes_of_all};
use reentry::trajectory::Ends;
use reentry::{Case, Scenario, Solver};
use reentry_service::wire::json;
use reentry_service::wire::scenario::{FlightRequest, RequestedOutput};
use reentry_tests::mutation::Mutator;
use serde_json::Value;

static NEVER: AtomicBool = AtomicBool::new(false);

/// The case of a request for a flight, if it is valid.
fn case_of(request: &Value) -> Option<Case> {
    let tree = json::parse(request.to_string().as_bytes()).ok()?;
    let request = FlightRequest::try_from_tree(tree, RequestedOutput::Answer).ok()?;
    Some(request.scenario.case().clone())
}

/// A case with its numbers moved a little, each member of a family by other parts.
fn moved(case: &Case, member: u32) -> Case {
    let part = |number: u32| f64::from((member * (2 * number + 7) * 37) % 101) / 101.0 - 0.5;
    let mut moved = case.clone();
    moved.initial_state.velocity *= 1.0 + 2e-3 * part(1);
    moved.vehicle.mass *= 1.0 + 0.1 * part(2);
    moved.density_factor *= 1.0 + 0.2 * part(3);
    moved
}

/// Flies cases both ways. Debug output, in which numbers have all their digits, also compares events, peaks, errors and counts.
fn agree(cases: Vec<Case>) {
    let bounded =
        |case: Case| Case { solver: Solver { step_limit: case.solver.step_limit.min(3000), ..case.solver }, ..case };
    let scenarios: Vec<_> = cases.into_iter().filter_map(|case| Scenario::new(bounded(case)).ok()).collect();
    let ended = ends_of_all(&scenarios, &NEVER);
    let flights = extremes_of_all(&scenarios, &NEVER);
    for (index, scenario) in scenarios.iter().enumerate() {
        let told = || format!("of {} flights, that of {:?}", scenarios.len(), scenario.case());
        let arrived = ended[index].as_ref().map(Ends::arrival);
        assert_eq!(format!("{arrived:?}"), format!("{:?}", arrival(scenario, &NEVER).as_ref()), "{}", told());
        assert_eq!(format!("{:?}", ended[index]), format!("{:?}", ends(scenario, &NEVER)), "{}", told());
        assert_eq!(format!("{:?}", flights[index]), format!("{:?}", extremes(scenario, &NEVER)), "{}", told());
    }
}

/// Families of the examples, mixed: thrust, parts, parachutes, tables, schedules, heating, events and planets.
#[test]
fn families_of_the_examples_fly_in_lanes_as_they_do_alone() {
    let examples: Vec<_> = Mutator::new("/simulate", "simulate").requests.iter().filter_map(case_of).collect();
    assert!(examples.len() > 12, "{} examples", examples.len());
    agree((0..9).flat_map(|member| examples.iter().map(move |case| moved(case, member))).collect());
}

/// By each instruction set that the processor has, not by the widest alone; without any, flights fly alone.
#[test]
fn flights_have_the_same_digits_by_all_instructions() {
    let examples: Vec<_> = Mutator::new("/simulate", "simulate").requests.iter().filter_map(case_of).collect();
    let scenarios: Vec<_> = (0..9)
        .flat_map(|member| examples.iter().filter_map(move |case| Scenario::new(moved(case, member)).ok()))
        .collect();
    let mut names = Vec::new();
    let mut flown = Vec::new();
    for instructions in [LaneInstructions::Widest, LaneInstructions::Avx2, LaneInstructions::None] {
        use_lanes(instructions);
        names.push(lane_instructions());
        flown.push(format!("{:?}", extremes_of_all(&scenarios, &NEVER)));
    }
    use_lanes(LaneInstructions::Widest);
    assert_eq!(names[1..], [names[0].map(|_| "avx2"), None]);
    assert!(flown[0] == flown[1] && flown[1] == flown[2], "{names:?}");
}

#[test]
fn random_requests_fly_in_lanes_as_they_do_alone() {
    let mutator = Mutator::new("/simulate", "simulate");
    let cases: Vec<_> = (0..400).filter_map(|seed| case_of(&mutator.request(seed))).collect();
    assert!(cases.len() > 50, "{} of them are valid", cases.len());
    agree(cases.iter().flat_map(|case| (0..2).map(|member| moved(case, member))).collect());
}
