//! Where a flight leaves the stretches on which the formulas of its models hold.

use num_dual::Dual64;

use super::passage::Passage;
use crate::control::Against;
use crate::integrate::event;
use crate::motion::{Forces, Formulation, Moment, Quantity, Switch};

/// The quantities on which formulas depend, with their rates, at the end of the last step; zero where there is none.
#[derive(Clone, Copy)]
pub(super) struct Watch {
    readings: [Dual64; Switch::ALL.len()],
}

/// How a flight leaves a stretch.
#[derive(Clone, Copy)]
pub(super) struct Exit {
    /// The part of the step.
    pub(super) part: f64,
    /// What turns there.
    pub(super) switch: Switch,
    boundary: Boundary,
}

/// An end of a stretch.
#[derive(Clone, Copy)]
struct Boundary {
    value: f64,
    /// 1 where the flight comes from above, -1 from below.
    side: f64,
    /// So far beyond the value the stretch ends: where a flight moves along a boundary, rounding must not carry it to and fro.
    margin: f64,
}

impl Boundary {
    /// How far a quantity is inside.
    fn inside(self, quantity: Dual64) -> Dual64 {
        (quantity - self.value) * self.side + self.margin
    }
}

impl Exit {
    /// Falls to zero where the flight leaves.
    pub(super) fn inside(&self, forces: &Forces, moment: &Moment) -> Dual64 {
        self.boundary.inside(read(forces, moment)[self.switch as usize])
    }

    /// Whether the flight is led back into the stretch that it leaves, by forces that change its speed at once.
    pub(super) fn is_undone(&self, before: &Watch, after: &Watch, forces: &Forces) -> bool {
        let by_speed =
            matches!(forces.boundaries(self.switch), Some((Quantity::Along(Against::Speed | Against::Mach), _)));
        let rate = |watch: &Watch| self.boundary.inside(watch.readings[self.switch as usize]).eps;
        by_speed && rate(before) < 0.0 && rate(after) > 0.0
    }
}

impl Watch {
    pub(super) fn new(forces: &Forces, start: &Moment) -> Self {
        Self { readings: read(forces, start) }
    }

    /// Where a step first leaves its stretches, if it does; those of time it does not leave, since no step goes beyond.
    pub(super) fn exit<F: Formulation<N>, const N: usize>(&self, passage: &Passage<F, N>) -> Option<Exit> {
        let forces = passage.motion.forces();
        if !forces.has_switches() {
            return None;
        }
        let ends = *passage.readings_at_end();
        let mut first: Option<Exit> = None;
        for switch in Switch::ALL {
            let [start, end] = [self.readings, ends].map(|readings| readings[switch as usize]);
            for boundary in boundaries_around(forces, switch).into_iter().flatten() {
                let inside = |part| boundary.inside(read(forces, &passage.inside(part))[switch as usize]);
                let [start, end] = [start, end].map(|quantity| boundary.inside(quantity));
                let length = passage.step.length();
                if event::seems_to_fall(start, end, length)
                    && let Some(part) = event::first_fall(start, end, length, inside)
                    && first.is_none_or(|first| part < first.part)
                {
                    first = Some(Exit { part, switch, boundary });
                }
            }
        }
        first
    }

    /// Goes to the end of a step.
    pub(super) fn follow<F: Formulation<N>, const N: usize>(&mut self, passage: &Passage<F, N>) {
        if passage.motion.forces().has_switches() {
            self.readings = *passage.readings_at_end();
        }
    }
}

/// When the next formula changes by time alone, s.
pub(super) fn next_corner(forces: &Forces) -> f64 {
    let corner = |switch| match forces.boundaries(switch) {
        Some((Quantity::Along(Against::Time), corners)) => corners.get(forces.regime().of(switch)).copied(),
        _ => None,
    };
    Switch::ALL.into_iter().filter_map(corner).fold(f64::INFINITY, f64::min)
}

/// The ends of the stretch on which a formula holds.
fn boundaries_around(forces: &Forces, switch: Switch) -> [Option<Boundary>; 2] {
    let stretch = forces.regime().of(switch);
    match forces.boundaries(switch) {
        None | Some((Quantity::Along(Against::Time), _)) => [None, None],
        Some((quantity, boundaries)) => {
            let margin = 2.0 * quantity.resolution();
            let at = |index: usize, side| boundaries.get(index).map(|value| Boundary { value: *value, side, margin });
            [stretch.checked_sub(1).and_then(|below| at(below, 1.0)), at(stretch, -1.0)]
        }
    }
}

/// The quantity of every switch.
fn read(forces: &Forces, moment: &Moment) -> [Dual64; Switch::ALL.len()] {
    forces.readings(moment.time, &moment.state)
}
