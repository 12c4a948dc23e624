//! The boundaries at which the formulas of the models change.

use num_dual::Dual64;

use super::detector::Detector;
use super::step_view::StepView;
use crate::control::Against;
use crate::integrate::event::{self, Inside, PredictedCrossing};
use crate::motion::{Forces, Formulation, StateRate, Switch, SwitchQuantity};
use crate::scalar::Scalar;

/// Detects where a flight leaves the segments on which the present formulas hold.
///
/// Boundaries on the time are not among them, since no step goes beyond one: see [`next_boundary_in_time`].
#[derive(Clone, Copy)]
pub(super) struct ModelBoundaryDetector {
    /// The quantities on which formulas depend, with their rates, at the end of the last step; zero where there is none.
    readings: Readings,
    /// The same at its start, with its length, s.
    before: Option<(f64, Readings)>,
}

/// The quantity of every switch, with its rate.
type Readings = [Dual64; Switch::ALL.len()];

/// Where a flight leaves a segment.
#[derive(Clone, Copy)]
pub(super) struct BoundaryCrossing {
    /// Whose formula changes there.
    pub(super) switch: Switch,
    boundary: Boundary,
}

/// An end of a segment.
#[derive(Clone, Copy)]
struct Boundary {
    value: f64,
    /// 1 where the flight comes from above, -1 from below.
    side: f64,
    /// So far beyond the value the segment ends: where a flight moves along a boundary, rounding must not carry it to and fro.
    margin: f64,
}

impl Boundary {
    /// How far a quantity is inside the segment.
    fn inside<S: Scalar>(self, quantity: S) -> S {
        (quantity - self.value) * self.side + self.margin
    }
}

impl BoundaryCrossing {
    /// Whether the flight is led back into the segment that it leaves, by forces that change its speed at once.
    pub(super) fn is_undone(
        &self,
        before: &ModelBoundaryDetector,
        after: &ModelBoundaryDetector,
        forces: &Forces,
    ) -> bool {
        let by_speed = matches!(
            forces.boundaries(self.switch),
            Some((SwitchQuantity::Along(Against::Speed | Against::Mach | Against::Energy), _))
        );
        let rate = |of: &ModelBoundaryDetector| self.boundary.inside(of.readings[self.switch as usize]).eps;
        by_speed && rate(before) < 0.0 && rate(after) > 0.0
    }
}

impl ModelBoundaryDetector {
    pub(super) fn new(forces: &Forces, start: &StateRate) -> Self {
        Self { readings: read(forces, start), before: None }
    }

    /// Whether nothing happens in a step of a length, s, with such readings at its end.
    pub(super) fn is_quiet(&self, forces: &Forces, ends: &Readings, length: f64) -> bool {
        forces.switches().iter().all(|switch| {
            boundaries_around(forces, switch).into_iter().flatten().all(|boundary| {
                let [start, end] = [&self.readings, ends].map(|readings| boundary.inside(readings[switch as usize]));
                !event::seems_to_fall(start, end, length)
            })
        })
    }

    /// Goes on to the end of a step of a length, s, by the readings there.
    pub(super) fn go_on(&mut self, ends: &Readings, length: f64) {
        self.before = Some((length, self.readings));
        self.readings = *ends;
    }

    /// Those after a change that leaves their rates as they were before.
    pub(super) fn going_on(self, before: &Self) -> Self {
        Self { before: before.before, ..self }
    }
}

impl Detector for ModelBoundaryDetector {
    type Located = BoundaryCrossing;

    fn locate<F: Formulation<N>, const N: usize>(&self, step: &StepView<F, N>) -> Option<(f64, BoundaryCrossing)> {
        let forces = step.motion.forces();
        if !forces.has_switches() {
            return None;
        }
        let ends = step.readings_at_end();
        let mut first: Option<(f64, BoundaryCrossing)> = None;
        for switch in forces.switches().iter() {
            let [start, end] = [&self.readings, ends].map(|readings| readings[switch as usize]);
            for boundary in boundaries_around(forces, switch).into_iter().flatten() {
                let inside = ReadingInside { switch, boundary, step };
                let [start, end] = [start, end].map(|quantity| boundary.inside(quantity));
                let length = step.length();
                if event::seems_to_fall(start, end, length)
                    && let Some(part) = event::first_fall(start, end, length, &inside)
                    && first.is_none_or(|(least, _)| part < least)
                {
                    first = Some((part, BoundaryCrossing { switch, boundary }));
                }
            }
        }
        first
    }

    fn ahead(&self, crossing: BoundaryCrossing, forces: &Forces, now: &StateRate) -> Dual64 {
        crossing.boundary.inside(read_one(forces, crossing.switch, now))
    }

    fn predict(&self, forces: &Forces, within: f64) -> Option<PredictedCrossing> {
        let around = forces.switches().iter().flat_map(|switch| {
            boundaries_around(forces, switch).into_iter().flatten().filter_map(move |boundary| {
                let of = |readings: &Readings| boundary.inside(readings[switch as usize]);
                let before = self.before.as_ref().map(|(length, readings)| (*length, of(readings)));
                event::predicted_fall(of(&self.readings), before, within)
            })
        });
        PredictedCrossing::first(around)
    }

    fn follow<F: Formulation<N>, const N: usize>(&mut self, step: &StepView<F, N>) {
        if step.motion.forces().has_switches() {
            self.go_on(step.readings_at_end(), step.length());
        }
    }
}

/// When the next formula changes by time alone, s.
pub(super) fn next_boundary_in_time(forces: &Forces) -> f64 {
    let corner = |switch| match forces.boundaries(switch) {
        Some((SwitchQuantity::Along(Against::Time), corners)) => corners.get(forces.mode().of(switch)).copied(),
        _ => None,
    };
    forces.switches().iter().filter_map(corner).fold(f64::INFINITY, f64::min)
}

/// The ends of the segment on which a formula holds.
fn boundaries_around(forces: &Forces, switch: Switch) -> [Option<Boundary>; 2] {
    let segment = forces.mode().of(switch);
    match forces.boundaries(switch) {
        None | Some((SwitchQuantity::Along(Against::Time), _)) => [None, None],
        Some((quantity, boundaries)) => {
            let margin = 2.0 * quantity.resolution();
            let at = |index: usize, side| boundaries.get(index).map(|value| Boundary { value: *value, side, margin });
            [segment.checked_sub(1).and_then(|below| at(below, 1.0)), at(segment, -1.0)]
        }
    }
}

/// The quantity of every switch.
fn read(forces: &Forces, now: &StateRate) -> Readings {
    forces.readings(now.time, &now.state)
}

/// How far the quantity of a switch is inside its segment, in a step.
struct ReadingInside<'a, 'b, F, const N: usize> {
    switch: Switch,
    boundary: Boundary,
    step: &'a StepView<'b, F, N>,
}

impl<F: Formulation<N>, const N: usize> ReadingInside<'_, '_, F, N> {
    /// Whether it takes the position alone.
    fn is_altitude(&self) -> bool {
        let boundaries = self.step.motion.forces().boundaries(self.switch);
        matches!(boundaries, Some((SwitchQuantity::Along(Against::Altitude), _)))
    }
}

impl<F: Formulation<N>, const N: usize> Inside for ReadingInside<'_, '_, F, N> {
    fn at(&self, part: f64) -> Dual64 {
        let Self { switch, boundary, step } = self;
        let forces = step.motion.forces();
        boundary.inside(if self.is_altitude() {
            forces.planet().shape.altitude(&step.position_inside(part))
        } else {
            read_one(forces, *switch, &step.inside(part))
        })
    }

    fn value_at(&self, part: f64) -> f64 {
        let Self { switch, boundary, step } = self;
        let forces = step.motion.forces();
        let StateRate { time, state } = step.state_inside(part);
        boundary.inside(if self.is_altitude() {
            forces.planet().shape.altitude(&state.position)
        } else {
            forces.reading(*switch, time, &state)
        })
    }
}

/// The quantity of one.
fn read_one(forces: &Forces, switch: Switch, now: &StateRate) -> Dual64 {
    forces.reading(switch, now.time, &now.state)
}
