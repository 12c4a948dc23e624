//! Many flights at once, in the lanes of one computation.

use std::sync::Arc;

use super::flight::Flight;
use super::{Kept, Recorder, SimulationError, record};
use crate::integrate::{AnyStep, LaneBounds, LaneJob, LaneSteps, Step};
use crate::interrupt::Interrupt;
use crate::motion::{Cartesian, EndReadings, Forces, Formulation, State};
use crate::scalar::{DualLanes, Lanes};
use crate::scenario::{Case, Equations, Scenario, StateLayout};
use crate::trajectory::{Arrival, Ends, Extremes, Flown};

/// So many flights share a computation.
const LANES: usize = 8;
/// So many are under way at once, so that those of one mode are enough to fill the lanes.
const UNDER_WAY: usize = 96;
/// So few are not faster together: what the lanes compute for none costs as much.
const FEW: usize = 2;
/// So many kinds of forces are told apart among flights that begin.
const MOST_KINDS: usize = 16;

/// Flies scenarios to their ends, and keeps of each what [`ends`](super::ends) does, to the last digit.
///
/// Flights by Cartesian equations share the lanes of a computation while their models and modes are the same; each has steps of its own. The others,
/// and those that are stiff for as long, are flown one by one.
pub fn ends_of_all(scenarios: &[Scenario], interrupt: &dyn Interrupt) -> Vec<Result<Ends, SimulationError>> {
    flown_of_all(scenarios, Kept::Ends, interrupt, Ends::new)
}

/// Flies scenarios as [`ends_of_all`] does, and keeps of each what [`extremes`](super::extremes) does.
pub fn extremes_of_all(scenarios: &[Scenario], interrupt: &dyn Interrupt) -> Vec<Result<Extremes, SimulationError>> {
    flown_of_all(scenarios, Kept::Extremes, interrupt, Extremes::new)
}

/// Flies scenarios, and makes what is wanted of what is kept of them.
fn flown_of_all<T>(
    scenarios: &[Scenario],
    kept: Kept,
    interrupt: &dyn Interrupt,
    of: fn(Arc<Case>, Flown) -> T,
) -> Vec<Result<T, SimulationError>> {
    let mut outcomes = Outcomes { scenarios, kept, interrupt, known: scenarios.iter().map(|_| None).collect() };
    outcomes.fill_in_lanes::<6>(StateLayout::Motion);
    outcomes.fill_in_lanes::<8>(StateLayout::HeatLoadAndMass);
    let flown = outcomes.complete();
    let of = |(scenario, flown): (&Scenario, Result<_, _>)| flown.map(|flown| of(scenario.shared_case(), flown));
    scenarios.iter().zip(flown).map(of).collect()
}

/// What is known of each scenario.
struct Outcomes<'a> {
    scenarios: &'a [Scenario],
    /// Of the flight of each.
    kept: Kept,
    interrupt: &'a dyn Interrupt,
    known: Vec<Option<Result<Flown, SimulationError>>>,
}

impl Outcomes<'_> {
    /// Flies those that fly in lanes, and whose states are of a layout.
    fn fill_in_lanes<const N: usize>(&mut self, layout: StateLayout)
    where
        Cartesian: Formulation<N>,
        Cartesian<Lanes<LANES>>: LaneBounds<N, LANES>,
        AnyStep: From<Step<N>>,
    {
        let of_layout = |scenario: &Scenario| {
            let case = scenario.case();
            case.solver.equations == Equations::Cartesian && case.state_layout() == layout
        };
        let of_layout: Vec<usize> =
            (0..self.scenarios.len()).filter(|index| of_layout(&self.scenarios[*index])).collect();
        let Some(steps) = LaneSteps::new() else { return };
        let coming = with_like(self.scenarios, of_layout);
        let mut scheduler =
            Scheduler { outcomes: self, steps, coming: coming.into_iter(), under_way: Vec::new(), groups: Vec::new() };
        scheduler.fly();
    }

    /// All outcomes, of which those that are not known yet are flown alone.
    fn complete(self) -> Vec<Result<Flown, SimulationError>> {
        let Self { scenarios, kept, interrupt, known } = self;
        let alone = |scenario| record(scenario, kept, interrupt);
        scenarios.iter().zip(known).map(|(scenario, outcome)| outcome.unwrap_or_else(|| alone(scenario))).collect()
    }
}

/// Those of some scenarios that begin with the same forces as enough others, one kind after the other: of the rest, as where each has a schedule
/// of its own, hardly any would ever share lanes.
fn with_like(scenarios: &[Scenario], indices: Vec<usize>) -> Vec<usize> {
    let mut kinds: Vec<(Forces, Vec<usize>)> = Vec::new();
    for index in indices {
        let forces = scenarios[index].case().forces();
        match kinds.iter().position(|(of_kind, _)| of_kind.are_alike(&forces)) {
            Some(kind) => kinds[kind].1.push(index),
            None if kinds.len() < MOST_KINDS => kinds.push((forces, vec![index])),
            None => {}
        }
    }
    let many = kinds.into_iter().map(|(_, members)| members).filter(|members| members.len() > FEW);
    many.flatten().collect()
}

/// Which flights fly in which lanes: those that are under way, and scenarios that are to come.
struct Scheduler<'a, 'b, const N: usize> {
    outcomes: &'b mut Outcomes<'a>,
    steps: LaneSteps<N, LANES>,
    coming: std::vec::IntoIter<usize>,
    /// By their places; those that have ended leave room for others.
    under_way: Vec<Option<Box<Flying<'a, N>>>>,
    /// The places of flights that wait for lanes; the forces of a group are alike.
    groups: Vec<Vec<usize>>,
}

/// A flight under way.
struct Flying<'a, const N: usize> {
    /// Of its scenario.
    index: usize,
    flight: Flight<'a, Cartesian, N>,
    recorder: Recorder<'a>,
}

impl<const N: usize> Flying<'_, N>
where
    Cartesian: Formulation<N>,
{
    /// Whether somebody takes the loads at the ends of its steps.
    fn takes_loads(&self) -> bool {
        self.recorder.takes_loads() || self.flight.watches_loads()
    }
}

/// What is read at the ends of steps: times, s, and states then.
struct ReadingsOf<'a> {
    forces: &'a Forces<Lanes<LANES>>,
    time: DualLanes<LANES>,
    state: State<DualLanes<LANES>>,
    with_loads: bool,
}

impl LaneJob for ReadingsOf<'_> {
    type Output = EndReadings<DualLanes<LANES>>;

    #[inline(always)]
    fn run(self) -> Self::Output {
        self.forces.end_readings(self.time, &self.state, self.with_loads)
    }
}

impl<const N: usize> Scheduler<'_, '_, N>
where
    Cartesian: Formulation<N>,
    Cartesian<Lanes<LANES>>: LaneBounds<N, LANES>,
    AnyStep: From<Step<N>>,
{
    /// Flies all, the largest group of those whose forces are alike first, as the lanes are full the longest then.
    fn fly(&mut self) {
        loop {
            self.start_more();
            let largest = (0..self.groups.len()).max_by_key(|group| self.groups[*group].len());
            let Some(largest) = largest else { return };
            let group = self.groups.swap_remove(largest);
            if group.len() > FEW {
                self.fly_group(group);
            } else {
                for place in group {
                    self.fly_alone(place);
                }
            }
        }
    }

    /// Starts flights until enough are under way.
    fn start_more(&mut self) {
        let mut count = self.under_way.iter().flatten().count();
        while count < UNDER_WAY {
            let Some(index) = self.coming.next() else { return };
            let Outcomes { scenarios, kept, interrupt, .. } = *self.outcomes;
            let scenario = &scenarios[index];
            let begun =
                Flight::start(scenario, Cartesian(scenario.case().forces()), interrupt).and_then(|mut flight| {
                    let recorder = Recorder::new(&flight, kept, interrupt)?;
                    Ok((flight.begin()?, Box::new(Flying { index, flight, recorder })))
                });
            match begun {
                Ok((None, flying)) => {
                    let free = self.under_way.iter().position(Option::is_none).unwrap_or_else(|| {
                        self.under_way.push(None);
                        self.under_way.len() - 1
                    });
                    self.under_way[free] = Some(flying);
                    self.wait(free);
                    count += 1;
                }
                Ok((Some(arrival), mut flying)) => self.end(&mut flying, arrival),
                Err(error) => self.outcomes.known[index] = Some(Err(error)),
            }
        }
    }

    /// Keeps what is wanted of a flight that has ended.
    fn end(&mut self, flying: &mut Flying<'_, N>, arrival: Arrival) {
        let Flying { index, flight, recorder } = flying;
        self.outcomes.known[*index] = Some(recorder.finish(flight, arrival));
    }

    /// Whether the flight at a place goes on after a step; what is wanted of one that has ended, or failed, is kept.
    fn goes_on(&mut self, place: usize, passed: Result<Option<Arrival>, SimulationError>) -> bool {
        match passed {
            Ok(None) => return true,
            Ok(Some(arrival)) => {
                if let Some(mut flying) = self.under_way[place].take() {
                    self.end(&mut flying, arrival);
                }
            }
            Err(error) => {
                if let Some(flying) = self.under_way[place].take() {
                    self.outcomes.known[flying.index] = Some(Err(error));
                }
            }
        }
        false
    }

    /// Flies the flight at a place alone until its forces change, and then lets it wait among its like.
    fn fly_alone(&mut self, place: usize) {
        let before = self.under_way[place].as_ref().map(|flying| flying.flight.phase_and_mode());
        while let Some(flying) = &mut self.under_way[place] {
            let Flying { flight, recorder, .. } = &mut **flying;
            if Some(flight.phase_and_mode()) != before {
                break;
            }
            let passed = flight.advance().and_then(|step| flight.pass(&step, None, &mut |view| recorder.observe(view)));
            self.goes_on(place, passed);
        }
        self.wait(place);
    }

    /// Lets a flight wait among its like; while it is stiff, it is flown alone.
    fn wait(&mut self, place: usize) {
        while let Some(flying) = &mut self.under_way[place] {
            let Flying { flight, recorder, .. } = &mut **flying;
            if !flight.integrator.is_stiff() {
                break;
            }
            let passed = flight.advance().and_then(|step| flight.pass(&step, None, &mut |view| recorder.observe(view)));
            self.goes_on(place, passed);
        }
        let Some(flying) = &self.under_way[place] else { return };
        match self.group_like(flying.flight.motion.forces()) {
            Some(group) => self.groups[group].push(place),
            None => self.groups.push(vec![place]),
        }
    }

    /// The group of the flights whose forces are like these.
    fn group_like(&self, forces: &Forces) -> Option<usize> {
        let first = |group: &Vec<usize>| group.first().and_then(|place| self.under_way[*place].as_deref());
        let is_alike = |first: &Flying<N>| first.flight.motion.forces().are_alike(forces);
        self.groups.iter().position(|group| first(group).is_some_and(is_alike))
    }

    /// Those that wait to fly with others of such forces, flights that begin so included.
    fn more_like(&mut self, forces: &Forces) -> Vec<usize> {
        self.start_more();
        self.group_like(forces).map(|group| self.groups.swap_remove(group)).unwrap_or_default()
    }

    /// Flies those of a group, and others that come to it, until no more are left.
    fn fly_group(&mut self, mut waiting: Vec<usize>) {
        let first = waiting.first().and_then(|place| self.under_way[*place].as_ref());
        let Some(like) = first.map(|first| first.flight.motion.forces().clone()) else { return };
        let mut system = Cartesian(like.in_lanes::<LANES>());
        let mut lanes = [None; LANES];
        loop {
            for (lane, place) in lanes.iter_mut().enumerate() {
                while place.is_none() {
                    if waiting.is_empty() && self.coming.len() > 0 {
                        waiting = self.more_like(&like);
                    }
                    let Some(next) = waiting.pop() else { break };
                    let Some(flying) = &self.under_way[next] else { continue };
                    system.0.put(lane, flying.flight.motion.forces());
                    *place = Some(next);
                }
            }
            let flying = lanes.iter().flatten().count();
            if flying <= FEW && waiting.is_empty() {
                // The last ones are faster alone.
                for place in lanes.into_iter().flatten() {
                    self.fly_alone(place);
                }
                return;
            }
            for (lane, place) in lanes.iter_mut().enumerate() {
                if let Some(at) = *place
                    && let Some(flying) = &mut self.under_way[at]
                {
                    let flight = &mut flying.flight;
                    let end = flight.horizon();
                    if let Err(error) = self.steps.load(lane, &mut flight.integrator, &flight.motion, end) {
                        let error = flight.failure(error);
                        self.goes_on(at, Err(error));
                        *place = None;
                    }
                }
            }
            if lanes.iter().all(Option::is_none) {
                continue;
            }
            self.steps.attempt(&system);
            let mut flying = lanes.iter().flatten().filter_map(|place| self.under_way[*place].as_ref());
            let with_loads = flying.any(|flying| flying.takes_loads());
            let (time, numbers) = self.steps.ends();
            let state = <Cartesian as Formulation<N>>::state(&numbers);
            let readings = self.steps.run(ReadingsOf { forces: &system.0, time, state, with_loads });
            for (lane, place) in lanes.iter_mut().enumerate() {
                let Some(at) = *place else { continue };
                let Some(Flying { flight, recorder, .. }) = self.under_way[at].as_deref_mut() else { continue };
                if !self.steps.judge(lane, &mut flight.integrator, &flight.motion) {
                    continue;
                }
                let read = readings.of_lane(lane);
                if flight.pass_quietly(&read, recorder) {
                    if flight.integrator.is_stiff() {
                        *place = None;
                        self.wait(at);
                    }
                    continue;
                }
                let (step, before) = (self.steps.step(lane), flight.phase_and_mode());
                let passed = flight.pass(&step, Some(&read), &mut |view| recorder.observe(view));
                let goes_on = self.goes_on(at, passed);
                let Some(Flying { flight, .. }) = self.under_way[at].as_deref().filter(|_| goes_on) else {
                    *place = None;
                    continue;
                };
                let is_changed = flight.phase_and_mode() != before;
                if flight.integrator.is_stiff() || is_changed && !flight.motion.forces().are_alike(&like) {
                    *place = None;
                    self.wait(at);
                } else if is_changed {
                    system.0.put(lane, flight.motion.forces());
                }
            }
        }
    }
}
