//! The peaks of the flight, and what its user should be warned of.

use num_dual::Dual64;

use super::step_view::StepView;
use super::{QuietStep, SimulationError};
use crate::heating::HeatFlux;
use crate::integrate::{Integrator, event};
use crate::motion::{Forces, Formulation, LIFT_FADE_ANGLE, Loads, ModelMode, StateRate};
use crate::trajectory::{HeatingPeaks, Instant, Peak, Peaks, Warning};

/// What was seen so far, and the loads with their rates at the end of the last step.
pub(super) struct PeakTracker {
    loads: Loads<Dual64>,
    /// The number of the phase, and the mode, of the last step.
    phase_and_mode: (usize, ModelMode),
    /// Cosine squared of the angle of the flight against the air less that of the cone in which lift fades; none where there is no lift.
    cone: Option<Dual64>,
    faded: bool,
    /// Of the present phase.
    peaks: Peaks,
    /// Of the phases before.
    pub(super) peaks_of_phases: Vec<(usize, Peaks)>,
    /// Of all phases before.
    pub(super) peaks_of_flight: Peaks,
    pub(super) warnings: Vec<Warning>,
}

impl PeakTracker {
    pub(super) fn new<F: Formulation<N>, const N: usize>(
        motion: &F,
        integrator: &Integrator<N>,
        may_lift: bool,
    ) -> Result<Self, SimulationError> {
        let forces = motion.forces();
        let time = integrator.time();
        let start = StateRate::of::<F, N>(time, integrator.state(), integrator.derivative());
        let loads = finite(loads_at(forces, &start), time)?;
        let peaks = peaks_at(&loads, time);
        let cone = may_lift.then(|| outside_cone(forces, &start));
        let faded = cone.is_some_and(|cone| cone.re < 0.0);
        let warnings = if faded { vec![Warning::LiftFadedNearVertical { time }] } else { Vec::new() };
        let phase_and_mode = (0, forces.mode());
        let (peaks_of_phases, peaks_of_flight) = (Vec::new(), peaks);
        let mut peak_tracker =
            Self { loads, phase_and_mode, cone, faded, peaks, peaks_of_phases, peaks_of_flight, warnings };
        peak_tracker.warn_outside_tables(forces, time);
        Ok(peak_tracker)
    }

    /// Notes the peaks and warnings of a step.
    pub(super) fn observe<F: Formulation<N>, const N: usize>(
        &mut self,
        view: &StepView<F, N>,
    ) -> Result<(), SimulationError> {
        let forces = view.motion.forces();
        let phase_and_mode = (view.phase, forces.mode());
        if phase_and_mode != self.phase_and_mode {
            // The loads may jump where a formula changes, and where something happens.
            let before = std::mem::replace(&mut self.phase_and_mode, phase_and_mode);
            if before.0 == phase_and_mode.0 {
                self.jump(forces, &view.start())?;
            } else {
                self.end_phase(before.0, forces, view.step.start_time, F::state(&view.step.start).heat_load);
                self.begin_phase(forces, &view.start())?;
            }
            self.warn_outside_tables(forces, view.step.start_time);
        }
        let end = view.end();
        let loads = finite(*view.loads_at_end(), end.time.re)?;
        let start = std::mem::replace(&mut self.loads, loads);
        let inside = |part| loads_at(forces, &view.on_dense_output(part));
        let time = |part| view.step.time(part);
        let ends = [(0.0, start), (1.0, loads)];
        // Between the entries of tables a quantity may turn more than once in a step.
        let quarters = self.may_turn_and_rise(forces, &start, &loads, view.step.length()).then(|| {
            let [one, two, three] = [0.25, 0.5, 0.75].map(|part| (part, inside(part)));
            [ends[0], one, two, three, ends[1]]
        });
        let looks = quarters.as_ref().map_or(&ends[..], |quarters| &quarters[..]);
        raise_all(&mut self.peaks, looks, inside, time);
        if let Some(before) = self.cone
            && !self.faded
        {
            let after = outside(view.cos_squared_gamma_at_end());
            self.cone = Some(after);
            let inside = |part| outside_cone(forces, &view.inside(part));
            if let Some(part) = event::first_fall(before, after, view.step.length(), &inside) {
                self.faded = true;
                self.warnings.push(Warning::LiftFadedNearVertical { time: time(part) });
            }
        }
        Ok(())
    }

    /// Notes the peaks of a step, if its ends tell all of them and there is nothing to warn of.
    pub(super) fn observe_quietly(&mut self, step: &QuietStep) -> bool {
        let QuietStep { forces, phase, start_time, end_time, read } = *step;
        let length = end_time - start_time;
        let Some((loads, cos_squared_gamma)) = read.loads else { return false };
        if (phase, forces.mode()) != self.phase_and_mode
            || finite(loads, end_time).is_err()
            || turns(&self.loads, &loads)
            || self.may_turn_and_rise(forces, &self.loads, &loads, length)
        {
            return false;
        }
        if let Some(before) = self.cone
            && !self.faded
        {
            let after = outside(cos_squared_gamma);
            if !event::stays_above(before, after, length) {
                return false;
            }
            self.cone = Some(after);
        }
        let start = std::mem::replace(&mut self.loads, loads);
        let time = |part| if part < 1.0 { start_time } else { end_time };
        raise_all(&mut self.peaks, &[(0.0, start), (1.0, loads)], |_| loads, time);
        true
    }

    /// Goes to the loads at a moment at which they may have jumped.
    fn jump(&mut self, forces: &Forces, now: &StateRate) -> Result<(), SimulationError> {
        self.loads = finite(loads_at(forces, now), now.time.re)?;
        raise_all(&mut self.peaks, &[(0.0, self.loads)], |_| self.loads, |_| now.time.re);
        Ok(())
    }

    /// Begins the peaks anew with the loads of a phase at its start.
    fn begin_phase(&mut self, forces: &Forces, start: &StateRate) -> Result<(), SimulationError> {
        self.loads = finite(loads_at(forces, start), start.time.re)?;
        self.peaks = peaks_at(&self.loads, start.time.re);
        Ok(())
    }

    /// Ends with the flight, whose last instant may have brought a jump.
    pub(super) fn end(&mut self, forces: &Forces, last: &Instant) -> Result<(), SimulationError> {
        let Instant { time, state, phase, .. } = last;
        if *phase != self.phase_and_mode.0 {
            self.end_phase(self.phase_and_mode.0, forces, *time, state.heat_load);
            self.begin_phase(forces, &StateRate { time: Dual64::from(*time), state: state.map(Dual64::from) })?;
        }
        self.end_phase(*phase, forces, *time, state.heat_load);
        Ok(())
    }

    /// Notes the peaks of a phase that ends, and the heat load then.
    fn end_phase(&mut self, phase: usize, forces: &Forces, time: f64, heat_load: Option<f64>) {
        let mut peaks = self.peaks;
        if let (Some(heating), Some(heat_load), Some(nose)) = (&mut peaks.heating, heat_load, forces.heating()) {
            heating.heat_load = Peak { value: heat_load, time, altitude: self.loads.altitude.re };
            let value = nose.wall_temperature(heating.heat_flux.value);
            heating.wall_temperature = Peak { value, ..heating.heat_flux };
        }
        self.peaks_of_flight.include(&peaks);
        self.peaks_of_phases.push((phase, peaks));
    }

    /// Whether a quantity may turn more than once in a step and rise above its peak inside, as far as the rates at the ends tell. Altitude and
    /// speed, whose rates the tables change, turn once.
    fn may_turn_and_rise(&self, forces: &Forces, start: &Loads<Dual64>, end: &Loads<Dual64>, length: f64) -> bool {
        let Peaks { deceleration, load_factor, dynamic_pressure, mach, heating, .. } = &self.peaks;
        let above = |peak: &Peak, quantity: fn(&Loads<Dual64>) -> Dual64| {
            let (start, end) = (quantity(start), quantity(end));
            start.re.max(end.re) + length * start.eps.abs().max(end.eps.abs()) > peak.value
        };
        let has_uneven_air = forces.has_uneven_air();
        (has_uneven_air || forces.has_uneven_coefficients())
            && (above(deceleration, |loads| loads.deceleration) || above(load_factor, |loads| loads.load_factor))
            || has_uneven_air
                && (above(dynamic_pressure, |loads| loads.dynamic_pressure)
                    || mach.as_ref().is_some_and(|mach| above(mach, mach_of))
                    || heating.as_ref().is_some_and(|heating| {
                        above(&heating.convective_heat_flux, |loads| heat_flux_of(loads).convective)
                            || above(&heating.radiative_heat_flux, |loads| heat_flux_of(loads).radiative)
                            || above(&heating.heat_flux, |loads| heat_flux_of(loads).total())
                    }))
    }

    /// Warns of every table outside which the present mode lies, once an edge.
    fn warn_outside_tables(&mut self, forces: &Forces, time: f64) {
        for (table, edge, above) in forces.outside_tables() {
            let known = |warning: &Warning| matches!(warning, Warning::OutsideTable { table: of, above: side, .. } if (*of, *side) == (table, above));
            if !self.warnings.iter().any(known) {
                let altitude = self.loads.altitude.re;
                self.warnings.push(Warning::OutsideTable { table, time, altitude, edge, above });
            }
        }
    }
}

/// The peaks of an instant.
fn peaks_at(loads: &Loads<Dual64>, time: f64) -> Peaks {
    let peak = |quantity: Dual64| Peak { value: quantity.re, time, altitude: loads.altitude.re };
    Peaks {
        deceleration: peak(loads.deceleration),
        load_factor: peak(loads.load_factor),
        dynamic_pressure: peak(loads.dynamic_pressure),
        altitude: peak(loads.altitude),
        speed: peak(loads.speed),
        mach: loads.mach.map(peak),
        heating: loads.heat_flux.map(|flux| {
            let [none, total] = [peak(Dual64::from(0.0)), peak(flux.total())];
            let [convective_heat_flux, radiative_heat_flux] = [flux.convective, flux.radiative].map(peak);
            HeatingPeaks {
                convective_heat_flux,
                radiative_heat_flux,
                heat_flux: total,
                heat_load: none,
                wall_temperature: none,
            }
        }),
    }
}

/// Raises every peak to the greatest value that its quantity has in a step, between the looks at it.
fn raise_all(
    peaks: &mut Peaks,
    looks: &[(f64, Loads<Dual64>)],
    inside: impl Fn(f64) -> Loads<Dual64> + Copy,
    time: impl Fn(f64) -> f64 + Copy,
) {
    let Peaks { deceleration, load_factor, dynamic_pressure, altitude, speed, mach, heating } = peaks;
    raise(deceleration, looks, inside, time, |loads| loads.deceleration);
    raise(load_factor, looks, inside, time, |loads| loads.load_factor);
    raise(dynamic_pressure, looks, inside, time, |loads| loads.dynamic_pressure);
    raise(altitude, looks, inside, time, |loads| loads.altitude);
    raise(speed, looks, inside, time, |loads| loads.speed);
    if let Some(mach) = mach {
        raise(mach, looks, inside, time, mach_of);
    }
    if let Some(HeatingPeaks { convective_heat_flux, radiative_heat_flux, heat_flux, .. }) = heating {
        raise(heat_flux, looks, inside, time, |loads| heat_flux_of(loads).total());
        // Without radiation so far, the convection is all there is.
        if radiative_heat_flux.value <= 0.0 && looks.iter().all(|(_, loads)| heat_flux_of(loads).radiative.re <= 0.0) {
            *convective_heat_flux = *heat_flux;
        } else {
            raise(convective_heat_flux, looks, inside, time, |loads| heat_flux_of(loads).convective);
            raise(radiative_heat_flux, looks, inside, time, |loads| heat_flux_of(loads).radiative);
        }
    }
}

/// Whether the rates at the ends of a step tell of a maximum of one of the quantities inside.
fn turns(start: &Loads<Dual64>, end: &Loads<Dual64>) -> bool {
    let of_flow: [fn(&Loads<Dual64>) -> Dual64; 9] = [
        |loads| loads.deceleration,
        |loads| loads.load_factor,
        |loads| loads.dynamic_pressure,
        |loads| loads.altitude,
        |loads| loads.speed,
        mach_of,
        |loads| heat_flux_of(loads).convective,
        |loads| heat_flux_of(loads).radiative,
        |loads| heat_flux_of(loads).total(),
    ];
    of_flow.into_iter().any(|quantity| event::rises(quantity(start), quantity(end)))
}

fn mach_of(loads: &Loads<Dual64>) -> Dual64 {
    loads.mach.unwrap_or(Dual64::from(0.0))
}

fn heat_flux_of(loads: &Loads<Dual64>) -> HeatFlux<Dual64> {
    let none = Dual64::from(0.0);
    loads.heat_flux.unwrap_or(HeatFlux { convective: none, radiative: none })
}

/// Raises a peak to the greatest value that a quantity has in a step, between the looks at it.
fn raise(
    peak: &mut Peak,
    looks: &[(f64, Loads<Dual64>)],
    inside: impl Fn(f64) -> Loads<Dual64>,
    time: impl Fn(f64) -> f64,
    quantity: impl Fn(&Loads<Dual64>) -> Dual64,
) {
    let mut rise = |part: f64, at: &Loads<Dual64>| {
        let value = quantity(at).re;
        if value > peak.value {
            *peak = Peak { value, time: time(part), altitude: at.altitude.re };
        }
    };
    // The start counts where the quantity has jumped.
    looks.iter().take(1).for_each(|(part, start)| rise(*part, start));
    for pair in looks.windows(2) {
        let [(from, start), (to, end)] = [&pair[0], &pair[1]];
        let between = |part: f64| from + part * (to - from);
        let between_looks = |part: f64| quantity(&inside(between(part)));
        if let Some(part) = event::maximum(quantity(start), quantity(end), &between_looks) {
            let part = between(part);
            rise(part, &inside(part));
        }
        rise(*to, end);
    }
}

/// The loads, of which every one must be a finite number.
fn finite(loads: Loads<Dual64>, time: f64) -> Result<Loads<Dual64>, SimulationError> {
    let Loads { altitude, density, speed, air_speed, mach, dynamic_pressure, deceleration, load_factor, heat_flux } =
        loads;
    let always = [altitude, density, speed, air_speed, dynamic_pressure, deceleration, load_factor];
    let finite = always.into_iter().chain(mach).chain(heat_flux.map(|flux| flux.total())).all(|x| x.re.is_finite());
    if finite { Ok(loads) } else { Err(SimulationError::Overflow { time }) }
}

fn loads_at(forces: &Forces, moment: &StateRate) -> Loads<Dual64> {
    forces.loads(moment.time, &moment.state)
}

/// Positive outside the cone about the vertical in which lift fades: cos²γ - ε².
fn outside_cone(forces: &Forces, moment: &StateRate) -> Dual64 {
    outside(forces.cos_squared_angle_to_air(&moment.state))
}

fn outside(cos_squared_gamma: Dual64) -> Dual64 {
    cos_squared_gamma - LIFT_FADE_ANGLE * LIFT_FADE_ANGLE
}
