//! The request and the answer of `/target`: numbers of a case with which a flight achieves what is wanted.

use reentry::solve::flight::{Extent, SearchFlight};
use reentry::solve::target::{Goal, Iteration, Nearest, Number, Options, Solution, Target};
use reentry::trajectory::Termination as CoreTermination;
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::description::{self, Object};
use super::reader::Fault;
use super::requirements::{RequestedRequirement, WantedEnd, WantedNumber, goal};
use super::scenario::{SimulateRequest, case};
use super::schema::names;
use super::search::{CaseOfSearch, FailedFlights, FlightSummary, FlightsOfSearch, classes, without_analyses};
use super::trajectory::Termination;
use super::vary::{MOST_IN_SEARCH, MovingCase, VariedNumber, Vary, vary};
use super::warning::{Purpose, Warning};

/// The greatest count of goals.
const MOST_GOALS: usize = 16;

/// The tolerance at which solutions are flown.
const FINE: f64 = 1e-12;

/// What a target is asked for, beside the case.
#[derive(Clone, Debug)]
pub(super) struct AskedTarget {
    vary: Vec<Vary>,
    achieve: Vec<RequestedRequirement>,
    options: Options,
}

/// A request of `/target`.
pub(super) fn target_request(object: &mut Object) -> Option<(SimulateRequest, AskedTarget)> {
    object.named(
        "TargetRequest",
        "Case to simulate, as for `/simulate`, the numbers of it that vary, and what a flight must achieve.",
    );
    let case = case(object);
    without_analyses(object);
    let vary =
        object.field("vary", "Varied numbers").doc("Numbers that vary, at most 8.").objects([1, MOST_IN_SEARCH], vary);
    let achieve = object
        .field("achieve", "Goals")
        .doc("What a flight must achieve: all of them. At least one must be on a quantity or a site.")
        .objects([1, MOST_GOALS], goal);
    let options = object.field("search", "Search").doc("Extent of the search.").default(json!({})).object(options);
    Some((case?, AskedTarget { vary: vary?, achieve: achieve?, options: options? }))
}

fn options(object: &mut Object) -> Option<Options> {
    object.named("TargetOptions", "Extent of the search.");
    let starts = object
        .field("starts", "Starts")
        .doc("Points of the first scan of the ranges; 0 takes as many as fit the count of numbers, 48 to 256.")
        .default(0)
        .whole_number([0, MOST_STARTS]);
    let solutions =
        object.field("solutions", "Solutions").doc("Solutions at most.").default(8).whole_number([1, MOST_SOLUTIONS]);
    let flights = object
        .field("flights", "Flights")
        .doc("Flights at most; beyond them the outcome is `out_of_budget`.")
        .default(20_000)
        .whole_number([1, MOST_FLIGHTS]);
    let record = object
        .field("record", "Record")
        .doc("Whether the response has the steps of the search.")
        .default(false)
        .boolean();
    Some(Options { starts: starts?, solutions: solutions?, flights: flights?, is_recorded: record? })
}

/// Every point is set beside every other: a twentieth of a second, in which no flight looks at the flag.
const MOST_STARTS: usize = 1000;
const MOST_SOLUTIONS: usize = 100;
const MOST_FLIGHTS: usize = 1_000_000;

/// A sound request.
#[derive(Debug)]
pub struct TargetRequest {
    /// The case.
    pub request: SimulateRequest,
    /// The case with its numbers, as it is.
    pub case: MovingCase,
    /// The same at a fine tolerance.
    pub fine: MovingCase,
    /// What flights must keep.
    pub extent: Extent,
    /// The equations: what is wanted of one number each, with the place of its goal.
    pub equations: Vec<(usize, WantedNumber)>,
    /// How a flight may end.
    ends: Vec<WantedEnd>,
    /// The extent of the search.
    pub options: Options,
    /// The request with every default filled in, if it asks for it.
    pub echo: Option<Value>,
}

impl TargetRequest {
    /// Parses and checks a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value) -> Result<Self, Vec<Fault>> {
        let ((request, asked), fields) = description::read_with_numbers(&mut tree, target_request)?;
        let CaseOfSearch { tree: case, varied, mut faults, .. } =
            CaseOfSearch::of_list(&request, (&tree, fields), &["vary", "achieve", "search"], &asked.vary);
        let known = request.known();
        let of_goals = asked.achieve.iter().enumerate();
        faults.extend(of_goals.filter_map(|(index, requirement)| {
            requirement.fault(&format!("/achieve/{index}"), known, &request.events)
        }));
        if asked.achieve.iter().all(RequestedRequirement::is_on_end) {
            let detail =
                "must have a goal on a quantity or a site: every flight that ends as wanted achieves the others";
            faults.push(Fault::new("/achieve", detail));
        }
        if !faults.is_empty() {
            return Err(faults);
        }
        let numbers_of = |(index, requirement): (usize, &RequestedRequirement)| {
            let numbers = requirement.numbers(request.angle_unit, &request.events, &request.planet.core);
            numbers.into_iter().map(move |number| (index, number)).collect::<Vec<_>>()
        };
        let equations: Vec<_> = asked.achieve.iter().enumerate().flat_map(numbers_of).collect();
        let ends: Vec<_> = asked.achieve.iter().filter_map(|requirement| requirement.end(&request.events)).collect();
        let of_numbers = equations.iter().map(|(_, number)| number.extent());
        let extent = of_numbers.chain(ends.iter().map(WantedEnd::extent)).max().unwrap_or(Extent::Ends);
        let tolerance = FINE.min(request.solver.relative_tolerance);
        let case = MovingCase::new(case, varied);
        Ok(Self {
            fine: case.with(&[("/solver/relative_tolerance".to_owned(), tolerance)]),
            case,
            extent,
            equations,
            ends,
            options: asked.options,
            echo: request.echo.then_some(tree),
            request,
        })
    }

    /// The numbers that vary.
    pub fn numbers(&self) -> Vec<Number> {
        self.case.varied().iter().map(VariedNumber::number).collect()
    }

    /// The goals, one for each equation.
    pub fn goals(&self) -> Vec<Goal> {
        let goal = |(_, number): &(usize, WantedNumber)| Goal { searched: number.searched(), shown: *number.shown() };
        self.equations.iter().map(goal).collect()
    }

    /// Whether a flight counts, by how it ends: where nothing is said of the vehicle's end, by any but the time limit.
    pub fn counts(&self, flown: &SearchFlight) -> bool {
        let is_left_open = !self.ends.iter().any(WantedEnd::is_of_vehicle);
        let is_over_time = flown.vehicle().termination() == CoreTermination::TimeLimit;
        self.ends.iter().all(|end| end.is_met(flown)) && !(is_left_open && is_over_time)
    }
}

/// Outcome of a search. `reached`: there is a solution. `not_reached`: the search came to rest everywhere without one.
/// `out_of_budget`: `flights` or four fifths of the time limit were used up before.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum TargetOutcome {
    /// There is a solution.
    Reached,
    /// The search came to rest everywhere without one.
    NotReached,
    /// The flights or the time were used up before.
    OutOfBudget,
}

impl TargetOutcome {
    /// Its word.
    pub fn word(self) -> &'static str {
        match self {
            Self::Reached => "reached",
            Self::NotReached => "not_reached",
            Self::OutOfBudget => "out_of_budget",
        }
    }
}

/// End of the range of a varied number.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum RangeEnd {
    /// The least value.
    Least,
    /// The greatest value.
    Greatest,
}

/// Varied number that is at an end of its range.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct AtBound {
    /// Index of the number among the values, from 0.
    pub vary: usize,
    /// Which end.
    pub bound: RangeEnd,
}

/// Numbers with which a flight achieves the goals. The flight is integrated at a relative tolerance of 1e-12.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct TargetSolution {
    /// Values of the varied numbers, in the order of `vary`.
    pub values: Vec<f64>,
    /// Request for `/simulate` with these values.
    #[schema(value_type = names::SimulateRequest)]
    pub case: Value,
    /// By how much each goal is missed, in its unit: value minus what is wanted, 0 within a range; null where the flight
    /// has no such quantity. A site has two, metres east and north of it.
    pub misses: Vec<Option<f64>>,
    /// End, events and peaks of the flight.
    #[serde(flatten)]
    pub flight: FlightSummary,
    /// Derivatives of what is achieved, a row for each miss, by the varied numbers; null where undefined.
    pub derivatives: Vec<Vec<Option<f64>>>,
    /// Condition number of the derivatives, with goals in tolerances and numbers in scales; null where it is infinite.
    #[schema(required = true)]
    pub condition: Option<f64>,
    /// Whether every small change of the numbers misses a goal.
    pub isolated: bool,
    /// Change of the numbers, one scale long, that misses no goal to first order; null if the solution is isolated.
    #[schema(required = true)]
    pub free_direction: Option<Vec<f64>>,
    /// Numbers that are at an end of their range.
    pub at_bounds: Vec<AtBound>,
    /// Distance from the numbers of the case, in scales.
    pub distance: f64,
}

/// Edge between flights that end in different ways.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct TargetEdge {
    /// How flights beyond it end; null if they fail.
    #[schema(required = true)]
    pub beyond: Option<Termination>,
}

/// Numbers that come nearest to the goals, and why nothing comes nearer.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct NearestApproach {
    /// The numbers and their flight.
    #[serde(flatten)]
    pub solution: TargetSolution,
    /// Whether no small change comes nearer: a fold, or the goals are out of reach.
    pub stationary: bool,
    /// Edge at which they lie, where the flight jumps to another end; null if there is none.
    #[schema(required = true)]
    pub edge: Option<TargetEdge>,
    /// Indices of the goals that nothing that varies changes, from 0.
    pub insensitive: Vec<usize>,
}

/// Least and greatest value.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Reach {
    /// Least value.
    pub least: f64,
    /// Greatest value.
    pub greatest: f64,
}

/// Flights of a search for a target.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct TargetSearch {
    /// Points of the first scan, the numbers of the case included.
    pub starts: usize,
    /// How flights ended.
    pub classes: Vec<Termination>,
    /// Number of flights.
    pub flights: u64,
    /// Flights that failed, by the type of the problem.
    pub failed: Vec<FailedFlights>,
    /// Computing time, s.
    pub elapsed: f64,
}

/// Step of a search.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct TargetIteration {
    /// From which point of the scan it goes, from 0.
    pub start: usize,
    /// Values that were tried.
    pub values: Vec<f64>,
    /// Misses with them.
    pub misses: Vec<Option<f64>>,
    /// Radius of the region in which steps are trusted, in parts of the ranges.
    pub radius: f64,
    /// Whether the step was taken.
    pub accepted: bool,
}

/// Numbers of a case with which a flight achieves what is wanted.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct TargetResponse {
    /// Name of the case in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// Unit of every angle in the response.
    #[schema(value_type = names::AngleUnit)]
    pub angle_unit: AngleUnit,
    /// Version of the service.
    pub version: &'static str,
    /// Outcome of the search.
    pub outcome: TargetOutcome,
    /// Distinct solutions, the nearest to the numbers of the case first. With fewer equations than numbers, the one that
    /// is nearest to them.
    pub solutions: Vec<TargetSolution>,
    /// What comes nearest if there is no solution; null if there is one, or if no flight ends as it should.
    #[schema(required = true)]
    pub nearest: Option<NearestApproach>,
    /// Least and greatest value of each goal over all flights that ended as they should, a site with two, as in `misses`;
    /// null where no flight did.
    pub reach: Vec<Option<Reach>>,
    /// Whether there is no other solution within the range: with one number and one equation, every change of sign and
    /// every dip of the miss between samples was followed.
    pub complete: bool,
    /// Flights of the search.
    pub search: TargetSearch,
    /// Steps of the search; present with `record`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub iterations: Option<Vec<TargetIteration>>,
    /// Warnings about the request.
    pub warnings: Vec<Warning>,
    /// Request with all defaults filled in, which can be sent again; present with `echo`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = names::TargetRequest)]
    pub case: Option<Value>,
}

impl TargetSolution {
    fn new(case: &mut MovingCase, solution: Solution, flight: FlightSummary) -> Self {
        let bound = |is_greatest: bool| if is_greatest { RangeEnd::Greatest } else { RangeEnd::Least };
        Self {
            case: case.request(&solution.values).clone(),
            misses: solution.misses,
            flight,
            derivatives: solution.derivatives,
            condition: solution.condition,
            isolated: solution.is_isolated,
            free_direction: solution.free_direction,
            at_bounds: solution.at_bounds.into_iter().map(|(vary, end)| AtBound { vary, bound: bound(end) }).collect(),
            distance: solution.distance,
            values: solution.values,
        }
    }
}

impl TargetResponse {
    /// The answer to a request; `summary` flies numbers and tells of the flight, if it can be finished.
    ///
    /// # Errors
    /// Those of `summary`.
    pub fn new<E>(
        mut asked: TargetRequest,
        target: Target,
        mut summary: impl FnMut(&mut MovingCase, &[f64]) -> Result<Option<FlightSummary>, E>,
        search: impl FnOnce() -> FlightsOfSearch,
    ) -> Result<Self, E> {
        let Target { solutions, nearest, reach, is_complete, is_out_of_budget, starts, ends, iterations } = target;
        let TargetRequest { case, fine, equations, .. } = &mut asked;
        let mut told = |solution: Solution| {
            let flight = summary(fine, &solution.values)?;
            Ok(flight.map(|flight| TargetSolution::new(case, solution, flight)))
        };
        let solutions = solutions.into_iter().filter_map(|it| told(it).transpose()).collect::<Result<Vec<_>, E>>()?;
        let goals = equations.last().map_or(0, |(goal, _)| goal + 1);
        let is_insensitive = |goal: &usize, insensitive: &[usize]| {
            let mut of_goal = equations.iter().enumerate().filter(|(_, (of, _))| of == goal).peekable();
            of_goal.peek().is_some() && of_goal.all(|(equation, _)| insensitive.contains(&equation))
        };
        let nearest = match nearest {
            None => None,
            Some(Nearest { solution, is_stationary, is_at_edge, beyond, insensitive }) => {
                let beyond = beyond.map(Termination::from);
                told(solution)?.map(|solution| NearestApproach {
                    solution,
                    stationary: is_stationary,
                    edge: is_at_edge.then_some(TargetEdge { beyond }),
                    insensitive: (0..goals).filter(|goal| is_insensitive(goal, &insensitive)).collect(),
                })
            }
        };
        let outcome = match (solutions.is_empty(), is_out_of_budget) {
            (false, _) => TargetOutcome::Reached,
            (true, true) => TargetOutcome::OutOfBudget,
            (true, false) => TargetOutcome::NotReached,
        };
        let classes = classes(&ends);
        let FlightsOfSearch { flights, failed, elapsed } = search();
        let step = |Iteration { start, values, misses, radius, accepted }: Iteration| TargetIteration {
            start,
            values,
            misses,
            radius,
            accepted,
        };
        Ok(Self {
            name: asked.request.name.clone(),
            angle_unit: asked.request.angle_unit,
            version: env!("CARGO_PKG_VERSION"),
            outcome,
            solutions,
            nearest,
            reach: reach.into_iter().map(|it| it.map(|[least, greatest]| Reach { least, greatest })).collect(),
            complete: is_complete,
            search: TargetSearch { starts, classes, flights, failed, elapsed },
            iterations: iterations.map(|iterations| iterations.into_iter().map(step).collect()),
            warnings: Warning::of_request(&asked.request, Purpose::Flight),
            case: asked.echo,
        })
    }
}
