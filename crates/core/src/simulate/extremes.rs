//! The extremes of the flight: its peaks, and whether it came near the vertical.

use num_dual::Dual64;

use super::SimulationError;
use super::passage::Passage;
use crate::coordinates::PlanetFixed;
use crate::integrate::event;
use crate::motion::{Forces, Formulation, LIFT_FADE_ANGLE, Loads, cos_squared_flight_path_angle, moving};
use crate::trajectory::{Peak, Peaks, Warning};

/// What was seen so far, and the loads with their rates at the end of the last step.
pub(super) struct Extremes {
    loads: Loads<Dual64>,
    /// Cosine squared of the flight-path angle less that of the cone in which lift fades; none where there is no lift.
    cone: Option<Dual64>,
    pub(super) peaks: Peaks,
    pub(super) warnings: Vec<Warning>,
}

impl Extremes {
    pub(super) fn new<F: Formulation>(motion: &F, has_lift: bool, start: &[f64; 6]) -> Result<Self, SimulationError> {
        let state = F::planet_fixed(&moving(start, &motion.derivative(start)));
        let loads = finite_loads(motion.forces(), 0.0, &state)?;
        let peak = |quantity: Dual64| Peak { value: quantity.re, time: 0.0, altitude: loads.altitude.re };
        let peaks = Peaks {
            deceleration: peak(loads.deceleration),
            load_factor: peak(loads.load_factor),
            dynamic_pressure: peak(loads.dynamic_pressure),
            altitude: peak(loads.altitude),
            mach: None,
        };
        let cone = has_lift.then(|| outside_cone(&state));
        let in_cone = cone.is_some_and(|cone| cone.re < 0.0);
        let warnings = if in_cone { vec![Warning::LiftFadedNearVertical { time: 0.0 }] } else { Vec::new() };
        Ok(Self { loads, cone, peaks, warnings })
    }

    /// Notes the peaks and warnings of a step.
    pub(super) fn observe<F: Formulation>(&mut self, motion: &F, passage: &Passage<F>) -> Result<(), SimulationError> {
        let end = passage.end();
        let loads = finite_loads(motion.forces(), passage.step.end_time, &end)?;
        let start = std::mem::replace(&mut self.loads, loads);
        let Peaks { deceleration, load_factor, dynamic_pressure, altitude, .. } = &mut self.peaks;
        let inside = |part| motion.forces().loads(&passage.inside(part));
        let time = |part| passage.step.time(part);
        raise(deceleration, &start, &loads, inside, time, |loads| loads.deceleration);
        raise(load_factor, &start, &loads, inside, time, |loads| loads.load_factor);
        raise(dynamic_pressure, &start, &loads, inside, time, |loads| loads.dynamic_pressure);
        raise(altitude, &start, &loads, inside, time, |loads| loads.altitude);
        if let Some(before) = self.cone
            && self.warnings.is_empty()
        {
            let after = outside_cone(&end);
            self.cone = Some(after);
            let inside = |part| outside_cone(&passage.inside(part));
            if let Some(part) = event::first_fall(before, after, passage.step.length(), inside) {
                self.warnings.push(Warning::LiftFadedNearVertical { time: time(part) });
            }
        }
        Ok(())
    }
}

/// Raises a peak to the greatest value that a quantity has in a step.
fn raise(
    peak: &mut Peak,
    start: &Loads<Dual64>,
    end: &Loads<Dual64>,
    inside: impl Fn(f64) -> Loads<Dual64>,
    time: impl Fn(f64) -> f64,
    quantity: impl Fn(&Loads<Dual64>) -> Dual64,
) {
    let (before, after) = (quantity(start), quantity(end));
    let top = event::maximum(before, after, |part| quantity(&inside(part)))
        .map(|part| (part, inside(part)))
        .filter(|(_, top)| quantity(top).re > after.re);
    let (part, at) = top.unwrap_or((1.0, *end));
    let value = quantity(&at).re;
    if value > peak.value {
        *peak = Peak { value, time: time(part), altitude: at.altitude.re };
    }
}

/// The loads, of which every one must be a finite number.
fn finite_loads(forces: &Forces, time: f64, state: &PlanetFixed<Dual64>) -> Result<Loads<Dual64>, SimulationError> {
    let loads = forces.loads(state);
    let Loads { altitude, density, dynamic_pressure, deceleration, load_factor, .. } = loads;
    let finite = [altitude, density, dynamic_pressure, deceleration, load_factor].iter().all(|x| x.re.is_finite());
    if finite { Ok(loads) } else { Err(SimulationError::Overflow { time }) }
}

/// Positive outside the cone about the vertical in which lift fades: cos²γ - ε².
fn outside_cone(state: &PlanetFixed<Dual64>) -> Dual64 {
    cos_squared_flight_path_angle(state) - LIFT_FADE_ANGLE * LIFT_FADE_ANGLE
}
