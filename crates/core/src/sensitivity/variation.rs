//! A number of a case that varies, and the numbers of a flight with their derivatives by it.

use nalgebra::SVector;
use num_dual::{Derivative, DualSVec64};

use crate::coordinates::PlanetFixed;
use crate::elementary::{exp2, log2};
use crate::event::Event;
use crate::motion::{Models, Parameters};
use crate::part::Part;
use crate::propulsion::ThrustAxis;
use crate::scenario::{Case, Numbers};
use crate::steering::Steering;
use crate::vehicle::{Aerodynamics, Vehicle};

/// A number with `W` derivatives.
pub(super) type Dual<const W: usize> = DualSVec64<W>;

/// A number of a case that varies: the case with the number moved a little, several times.
///
/// What a flight takes from its case has its derivative by this number from these cases, by differences of fourth order: exact to
/// rounding where it is a polynomial of the number up to degree four, as masses, coefficients, thrusts, times and altitudes are, and good to twelve
/// digits in the steps that are meant here, a thousandth of the size of the number.
#[derive(Clone, Debug)]
pub struct Variation {
    nodes: Vec<Node>,
    offsets: [f64; 3],
}

/// A case whose number is moved.
#[derive(Clone, Debug)]
pub(super) struct Node {
    /// By how much the number is moved, in its own unit.
    pub(super) offset: f64,
    /// The weight of what is different in the derivative.
    pub(super) weight: f64,
    pub(super) case: Case,
}

/// Of differences about the number, in steps.
pub(super) const CENTRAL: [(f64, f64); 4] =
    [(-2.0, 1.0 / 12.0), (-1.0, -2.0 / 3.0), (1.0, 2.0 / 3.0), (2.0, -1.0 / 12.0)];
/// Of differences on one side of it; what is left out belongs to the number itself.
const ONE_SIDED: [(f64, f64); 4] = [(1.0, 4.0), (2.0, -3.0), (3.0, 4.0 / 3.0), (4.0, -0.25)];

impl Variation {
    /// A number that is moved in steps of about `step`, in its own unit; `moved` gives the case with the number moved by an offset, or none
    /// where there is no such case: beyond a bound, or where an order would change. The steps then are smaller, or on one side.
    /// None where the number cannot be moved at all.
    pub fn new(step: f64, moved: impl Fn(f64) -> Option<Case>) -> Option<Self> {
        if !(step.is_finite() && step > 0.0) {
            return None;
        }
        // Powers of two, so that most numbers are moved without rounding, and what is a multiple of one has its slope to the last digit.
        let steps = [1.0, 0.1, 1e-2].map(|part| exp2(log2(step * part).round()));
        let ways = steps.iter().flat_map(|step| [(&CENTRAL, *step), (&ONE_SIDED, *step), (&ONE_SIDED, -*step)]);
        let node = |(times, weight): (f64, f64), step: f64| {
            let offset = times * step;
            Some(Node { offset, weight: weight / step, case: moved(offset)? })
        };
        let nodes = |(stencil, step): (&[(f64, f64); 4], f64)| {
            stencil.iter().map(|of_node| node(*of_node, step)).collect::<Option<Vec<_>>>()
        };
        let nodes = ways.map(nodes).find_map(|nodes| nodes)?;
        Some(Self { nodes, offsets: [0.0; 3] })
    }

    /// A number that moves nothing but what is said beside it.
    pub(super) fn of_nothing() -> Self {
        Self { nodes: Vec::new(), offsets: [0.0; 3] }
    }

    /// What a flight adds to the lift and drag coefficients of its table and to its bank angle varies, of which none has a number in the case.
    pub(super) fn of_offset(index: usize) -> Self {
        let mut variation = Self::of_nothing();
        variation.offsets[index] = 1.0;
        variation
    }

    pub(super) fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The derivative of a number of the case.
    fn slope(&self, case: &Case, of: impl Fn(&Case) -> f64) -> f64 {
        // Less the number itself, so that what does not vary has a slope of exactly zero.
        let number = of(case);
        self.nodes.iter().map(|node| node.weight * (of(&node.case) - number)).sum()
    }

    /// Whether the flight has other phases as soon as the number is moved, so that there is no derivative: a thrust or a parachute that
    /// is none, or a canopy that opens at once.
    pub(super) fn changes_phases(&self, case: &Case) -> bool {
        let kinds = |case: &Case| {
            let of_event = |event: &Event| {
                let thrusts = event.then.thrust().is_some_and(|thrust| thrust.force != 0.0);
                let opens = event.then.deploy.map(|it| (it.drag_area > 0.0, it.inflation_time > 0.0));
                let at_once = event.then.deploy.is_some_and(|it| it.inflation_time == 0.0 && it.delay == 0.0);
                (thrusts, opens, at_once)
            };
            let of_part = |part: &Part| {
                let exit_area = part.engine.as_ref().is_some_and(|engine| engine.exit_area > 0.0);
                (part.count, part.propellant > 0.0, exit_area)
            };
            let of_events: Vec<_> = case.events.iter().map(of_event).collect();
            (of_events, case.parts.iter().map(of_part).collect::<Vec<_>>())
        };
        let of_flight = kinds(case);
        self.nodes.iter().any(|node| kinds(&node.case) != of_flight)
    }

    /// Whether the forces on one and the same vehicle change with the number: by the models, by the density of the air, or by a constant
    /// bank angle.
    pub(super) fn changes_forces_beside_vehicle(&self, case: &Case) -> bool {
        let of_case = |case: &Case| {
            let Parameters { density, bank_angle, .. } = case.parameters();
            [density, bank_angle].map(f64::to_bits)
        };
        let of_flight = of_case(case);
        self.changes_models(case) || self.nodes.iter().any(|node| of_case(&node.case) != of_flight)
    }

    /// Whether more varies than numbers that a phase of the flight takes from its case: what is in the models has its derivatives by
    /// differences.
    pub fn changes_models(&self, case: &Case) -> bool {
        let models = ModelsOfFlight::of(case);
        self.nodes.iter().any(|node| ModelsOfFlight::of(&node.case) != models)
    }
}

/// What an event puts in their place.
#[derive(PartialEq)]
struct ModelsOfEvent {
    /// Those with its aerodynamics, if it has any.
    aerodynamics: Option<Models>,
    /// Of its thrust and its impulse.
    axes: [Option<ThrustAxis>; 2],
    steering: Option<Steering>,
}

/// What a flight takes from its case that is not a number: the models, and what events put in their place.
#[derive(PartialEq)]
struct ModelsOfFlight {
    of_start: Models,
    /// Where the axis of the vehicle points.
    steering: Steering,
    of_events: Vec<ModelsOfEvent>,
}

impl ModelsOfFlight {
    fn of(case: &Case) -> Self {
        let of_events = case.events.iter().map(|event| {
            let with = |aerodynamics: &Aerodynamics| {
                case.models_of(&Vehicle { aerodynamics: aerodynamics.clone(), ..case.vehicle.clone() })
            };
            let axes =
                [event.then.thrust().map(|thrust| thrust.along), event.then.impulse.map(|impulse| impulse.along)];
            let aerodynamics = event.then.aerodynamics.as_ref().map(with);
            ModelsOfEvent { aerodynamics, axes, steering: event.then.steer.clone() }
        });
        Self { of_start: case.models(), steering: case.steering.clone(), of_events: of_events.collect() }
    }
}

/// A case of which up to `W` numbers vary.
#[derive(Clone, Copy)]
pub(super) struct VariedCase<'a, const W: usize> {
    pub(super) case: &'a Case,
    pub(super) variations: &'a [Variation],
    /// The initial state, where its derivatives are known without the variations.
    pub(super) start: Option<PlanetFixed<Dual<W>>>,
}

impl<const W: usize> VariedCase<'_, W> {
    /// A number with these derivatives.
    pub(super) fn dual(value: f64, slopes: [f64; W]) -> Dual<W> {
        if slopes.iter().all(|slope| *slope == 0.0) {
            return Dual::from(value);
        }
        Dual::new(value, Derivative::some(SVector::from(slopes)))
    }

    /// The initial state.
    pub(super) fn start(&self) -> PlanetFixed<Dual<W>> {
        if let Some(start) = self.start {
            return start;
        }
        let component = |index: usize| self.number(move |case| <[f64; 6]>::from(case.initial_state)[index]);
        PlanetFixed::from(std::array::from_fn(component))
    }

    /// From where ranges are measured.
    pub(super) fn track_start(&self) -> PlanetFixed<Dual<W>> {
        if self.case.origin.is_none() {
            return self.start();
        }
        let component = |index: usize| self.number(move |case| <[f64; 6]>::from(*case.track_start())[index]);
        PlanetFixed::from(std::array::from_fn(component))
    }

    /// A number of each variation; 0 where there are fewer.
    pub(super) fn each(&self, of: impl Fn(&Variation) -> f64) -> [f64; W] {
        std::array::from_fn(|i| self.variations.get(i).map_or(0.0, &of))
    }
}

impl<const W: usize> Numbers<Dual<W>> for VariedCase<'_, W> {
    fn case(&self) -> &Case {
        self.case
    }

    fn number(&self, of: impl Fn(&Case) -> f64) -> Dual<W> {
        Self::dual(of(self.case), self.each(|variation| variation.slope(self.case, &of)))
    }

    fn offsets(&self) -> [Dual<W>; 3] {
        [0, 1, 2].map(|index| Self::dual(0.0, self.each(|variation| variation.offsets[index])))
    }
}

/// A derivative of a number.
pub(super) fn slope<const W: usize>(number: &Dual<W>, variation: usize) -> f64 {
    number.eps.0.map_or(0.0, |slopes| slopes[variation])
}
