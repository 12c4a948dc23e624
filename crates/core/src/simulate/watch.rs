//! Looks at every step for what happens inside it: the impact, the peaks, and flight along the vertical.

use num_dual::Dual64;

use super::SimulationError;
use crate::coordinates::PlanetFixed;
use crate::integrate::{Step, event};
use crate::motion::{Formulation, LIFT_FADE_ANGLE, Loads, cos_squared_flight_path_angle, moving};
use crate::trajectory::{Peak, Peaks, Warning};

/// What was seen so far, and the quantities with their rates at the end of the last step.
pub(super) struct Watch<'a, F> {
    motion: &'a F,
    stop_altitude: f64,
    loads: Loads<Dual64>,
    above_stop: Dual64,
    cone: Dual64,
    pub(super) peaks: Peaks,
    pub(super) warnings: Vec<Warning>,
}

impl<'a, F: Formulation> Watch<'a, F> {
    pub(super) fn new(
        motion: &'a F,
        stop_altitude: f64,
        state: &[f64; 6],
        derivative: &[f64; 6],
    ) -> Result<Self, SimulationError> {
        let state = F::planet_fixed(&moving(state, derivative));
        let loads = finite_loads(motion, 0.0, &state)?;
        let peak = |quantity: Dual64| Peak { value: quantity.re, time: 0.0, altitude: loads.altitude.re };
        let peaks = Peaks {
            deceleration: peak(loads.deceleration),
            load_factor: peak(loads.load_factor),
            dynamic_pressure: peak(loads.dynamic_pressure),
            altitude: peak(loads.altitude),
        };
        let cone = outside_cone(&state);
        let mut warnings = Vec::new();
        if motion.forces().vehicle.has_lift() && cone.re < 0.0 {
            warnings.push(Warning::LiftFadedNearVertical { time: 0.0 });
        }
        let above_stop = loads.altitude - stop_altitude;
        Ok(Self { motion, stop_altitude, loads, above_stop, cone, peaks, warnings })
    }

    /// The flight leaves the stop altitude upward, even where rounding gives it no rate, or a falling one.
    pub(super) fn start_upward(&mut self) {
        self.above_stop.eps = self.above_stop.eps.max(f64::MIN_POSITIVE);
    }

    /// The part of the step at which the stop altitude is first crossed downwards, a dip inside the step included.
    pub(super) fn impact(&self, step: &Step<f64, 6>) -> Option<f64> {
        let above = |state: &PlanetFixed<Dual64>| self.above_stop(state);
        let end = above(&end::<F>(step));
        event::first_fall(self.above_stop, end, step.length(), |part| above(&self.inside(step, part)))
    }

    /// How long before the end of the step, s, its tangent there passes the stop altitude.
    pub(super) fn lateness(&self, step: &Step<f64, 6>) -> f64 {
        let above = self.above_stop(&end::<F>(step));
        above.re / above.eps
    }

    /// Notes the peaks and warnings of a step.
    pub(super) fn observe(&mut self, step: &Step<f64, 6>) -> Result<(), SimulationError> {
        let end = end::<F>(step);
        let start = self.loads;
        self.loads = finite_loads(self.motion, step.end_time, &end)?;
        self.above_stop = self.loads.altitude - self.stop_altitude;
        self.find_peak(step, &start, |peaks| &mut peaks.deceleration, |loads| loads.deceleration);
        self.find_peak(step, &start, |peaks| &mut peaks.load_factor, |loads| loads.load_factor);
        self.find_peak(step, &start, |peaks| &mut peaks.dynamic_pressure, |loads| loads.dynamic_pressure);
        self.find_peak(step, &start, |peaks| &mut peaks.altitude, |loads| loads.altitude);
        if self.motion.forces().vehicle.has_lift() && self.warnings.is_empty() {
            let before = std::mem::replace(&mut self.cone, outside_cone(&end));
            let inside = |part| outside_cone(&self.inside(step, part));
            if let Some(part) = event::first_fall(before, self.cone, step.length(), inside) {
                self.warnings.push(Warning::LiftFadedNearVertical { time: step.time(part) });
            }
        }
        Ok(())
    }

    fn find_peak(
        &mut self,
        step: &Step<f64, 6>,
        start: &Loads<Dual64>,
        peak: impl Fn(&mut Peaks) -> &mut Peak,
        quantity: impl Fn(&Loads<Dual64>) -> Dual64,
    ) {
        let loads = |part| self.motion.forces().loads(&self.inside(step, part));
        let (before, after) = (quantity(start), quantity(&self.loads));
        let top = event::maximum(before, after, |part| quantity(&loads(part)))
            .map(|part| (step.time(part), loads(part)))
            .filter(|(_, top)| quantity(top).re > after.re);
        let (time, at) = top.unwrap_or((step.end_time, self.loads));
        let highest = Peak { value: quantity(&at).re, time, altitude: at.altitude.re };
        let peak = peak(&mut self.peaks);
        if highest.value > peak.value {
            *peak = highest;
        }
    }

    fn above_stop(&self, state: &PlanetFixed<Dual64>) -> Dual64 {
        self.motion.forces().planet.shape.altitude(&state.position) - self.stop_altitude
    }

    /// The state inside a step, moving along the flow.
    fn inside(&self, step: &Step<f64, 6>, part: f64) -> PlanetFixed<Dual64> {
        let state = step.state(part);
        F::planet_fixed(&moving(&state, &self.motion.derivative(&state)))
    }
}

/// The state at the end of a step, moving along the flow.
fn end<F: Formulation>(step: &Step<f64, 6>) -> PlanetFixed<Dual64> {
    F::planet_fixed(&moving(&step.end, &step.end_derivative))
}

/// The loads, of which every one must be a finite number.
fn finite_loads<F: Formulation>(
    motion: &F,
    time: f64,
    state: &PlanetFixed<Dual64>,
) -> Result<Loads<Dual64>, SimulationError> {
    let loads = motion.forces().loads(state);
    let Loads { altitude, density, dynamic_pressure, deceleration, load_factor } = loads;
    let finite = [altitude, density, dynamic_pressure, deceleration, load_factor].iter().all(|x| x.re.is_finite());
    if finite { Ok(loads) } else { Err(SimulationError::Overflow { time }) }
}

/// Positive outside the cone about the vertical in which lift fades: cos²γ - ε².
fn outside_cone(state: &PlanetFixed<Dual64>) -> Dual64 {
    cos_squared_flight_path_angle(state) - LIFT_FADE_ANGLE * LIFT_FADE_ANGLE
}
