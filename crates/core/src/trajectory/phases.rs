//! The phases of a flight: between the instants at which events change the vehicle.

use super::{EventRecord, HeatingPeaks, Peak, Peaks, Trajectory};
use crate::event::ThrustCommand;
use crate::scenario::Change;

/// A part of a flight in which the vehicle and its thrust stay the same.
///
/// The first and the last may have no length: where an event changes the vehicle at the start, or at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightPhase {
    /// With what it begins.
    pub from: PhaseStart,
    /// When it begins, s.
    pub since: f64,
    /// When it ends, s.
    pub until: f64,
    /// The greatest values in it, both ends included: at its start those after the change, at its end those before the next one.
    pub peaks: Peaks,
}

/// With what a phase begins.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PhaseStart {
    /// With the flight.
    Start,
    /// With the event of this place in the list of the case; of several events at one instant, the last that changes the vehicle.
    Event(usize),
    /// With the end of the propellant; the event of this place in the list had switched the thrust on.
    Burnout(usize),
}

impl Trajectory {
    /// The phases, in order; one alone where no event changed the vehicle. An impulse changes the velocity, not the vehicle.
    ///
    /// The greatest of the peaks of the phases are those of the flight.
    pub fn phases(&self) -> Vec<FlightPhase> {
        let mut phases: Vec<FlightPhase> = Vec::new();
        let mut next = 0;
        for (phase, peaks) in &self.flown.peaks_of_phases {
            let from = (next..=*phase).rev().find_map(|phase| self.start_of(phase));
            next = phase + 1;
            match (from, phases.last_mut()) {
                (None, Some(last)) => last.peaks.include(peaks),
                (from, _) => {
                    let since = self.flown.phases[*phase].since;
                    if let Some(last) = phases.last_mut() {
                        last.until = since;
                    }
                    let from = from.unwrap_or(PhaseStart::Start);
                    phases.push(FlightPhase { from, since, until: self.end_time(), peaks: *peaks });
                }
            }
        }
        phases
    }

    /// With what the phase of a number begins, if the vehicle changes there.
    fn start_of(&self, phase: usize) -> Option<PhaseStart> {
        let before = phase.checked_sub(1)?;
        let event_records = &self.flown.event_records;
        let effect = |event: usize| &self.case.events[event].then;
        let begins_it = |record: &&EventRecord| record.after.phase == phase && record.before.phase == before;
        if let Some(record) = event_records.iter().find(begins_it) {
            return effect(record.event).changes_vehicle().then_some(PhaseStart::Event(record.event));
        }
        if let Change::Burnout(part) = self.flown.phases[phase].cause {
            let lights =
                |record: &&EventRecord| record.after.phase <= before && effect(record.event).ignite.contains(&part);
            return event_records.iter().rfind(lights).map(|record| PhaseStart::Burnout(record.event));
        }
        let [was_on, is_on] = [before, phase].map(|phase| self.flown.phases[phase].thrust.is_some());
        let ignites = |record: &&EventRecord| {
            let thrust = effect(record.event).thrust;
            record.after.phase <= before && matches!(thrust, Some(ThrustCommand::On(thrust)) if thrust.force != 0.0)
        };
        let ignition = event_records.iter().rfind(ignites).filter(|_| was_on && !is_on);
        ignition.map(|record| PhaseStart::Burnout(record.event))
    }
}

impl Peaks {
    /// Takes in the peaks of what follows.
    pub(crate) fn include(&mut self, later: &Self) {
        let raise = |peak: &mut Peak, later: &Peak| {
            if later.value > peak.value {
                *peak = *later;
            }
        };
        raise(&mut self.deceleration, &later.deceleration);
        raise(&mut self.load_factor, &later.load_factor);
        raise(&mut self.dynamic_pressure, &later.dynamic_pressure);
        raise(&mut self.altitude, &later.altitude);
        raise(&mut self.speed, &later.speed);
        if let (Some(mach), Some(later)) = (&mut self.mach, &later.mach) {
            raise(mach, later);
        }
        if let (Some(heating), Some(later)) = (&mut self.heating, &later.heating) {
            let HeatingPeaks { convective_heat_flux, radiative_heat_flux, heat_flux, heat_load, wall_temperature } =
                heating;
            raise(convective_heat_flux, &later.convective_heat_flux);
            raise(radiative_heat_flux, &later.radiative_heat_flux);
            raise(heat_flux, &later.heat_flux);
            raise(wall_temperature, &later.wall_temperature);
            // It only grows.
            *heat_load = later.heat_load;
        }
    }
}
