//! How exact a flight is: beside a finer one, and by its balance of energy.

use crate::coordinates::PlanetFixed;
use crate::interrupt::Interrupt;
use crate::motion::Power;
use crate::scenario::{Bound, Scenario};
use crate::simulate::{SimulationError, arrival};
use crate::trajectory::Trajectory;

/// By how much a flight is off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Verification {
    /// The tolerance of the finer flight: a hundredth of the flight's, but no finer than there is. Where it is the flight's own,
    /// both are the same flight, and their difference says nothing.
    pub relative_tolerance: f64,
    /// The final time less that of the finer flight, s.
    pub time_difference: f64,
    /// Between the final positions of both, m.
    pub distance: f64,
    /// The greatest amount by which the balance of energy was off on the way, J/kg: the energy lost, which the air should have taken.
    pub energy_drift: f64,
    /// The energy that drag, and in wind lift, has taken, J/kg.
    pub drag_work: f64,
    /// The energy that thrust has given, J/kg; impulses not included.
    pub thrust_work: f64,
}

/// Flies the scenario once more at a hundredth of its tolerance, and adds up the energy along the flight.
///
/// # Errors
/// When the finer flight cannot be finished, or is interrupted.
pub fn verify(
    scenario: &Scenario,
    flight: &Trajectory,
    interrupt: &dyn Interrupt,
) -> Result<Verification, SimulationError> {
    let relative_tolerance = (scenario.case().solver.relative_tolerance / 100.0).max(Bound::RELATIVE_TOLERANCE.minimum);
    let finer = arrival(&scenario.finer(relative_tolerance), interrupt)?;
    let (energy_drift, Power { drag: drag_work, thrust: thrust_work }) = energy_balance(flight, interrupt)?;
    Ok(Verification {
        relative_tolerance,
        time_difference: flight.end_time() - finer.time,
        distance: (flight.arrival().state.position - finer.state.position).norm(),
        energy_drift,
        drag_work,
        thrust_work,
    })
}

/// The greatest error of the balance, and the work of drag and thrust, J/kg.
///
/// The energy is that of [`Planet::energy`](crate::planet::Planet::energy); an impulse adds what it adds to V²/2.
fn energy_balance(flight: &Trajectory, interrupt: &dyn Interrupt) -> Result<(f64, Power), SimulationError> {
    let energy = |state: &PlanetFixed<f64>| flight.case.planet.energy(&state.position, state.velocity.norm());
    let mut given = energy(&flight.case.initial_state);
    let (mut drift, mut work) = (0.0_f64, Power { drag: 0.0, thrust: 0.0 });
    let mut event_records = flight.flown.event_records.iter().peekable();
    for step in &flight.flown.steps {
        let (start, end) = (step.start_time(), step.end_time());
        if interrupt.is_raised() {
            return Err(SimulationError::Interrupted { time: start });
        }
        while let Some(record) = event_records.next_if(|record| record.before.time <= start) {
            given += energy(&record.after.state.planet_fixed()) - energy(&record.before.state.planet_fixed());
        }
        // A step that ends where it begins has nothing inside.
        if start >= end {
            continue;
        }
        let motion = flight.motion(step);
        let interpolant = motion.interpolant(&step.step);
        let half = (end - start) / 2.0;
        for (abscissa, weight) in GAUSS {
            for time in [start + half * (1.0 - abscissa), start + half * (1.0 + abscissa)] {
                let Power { drag, thrust } = motion.forces().power(time, &interpolant.at(&motion, time));
                work.drag += half * weight * drag;
                work.thrust += half * weight * thrust;
            }
        }
        drift = drift.max((energy(&motion.end(&step.step).planet_fixed()) + work.drag - work.thrust - given).abs());
    }
    Ok((drift, work))
}

/// Abscissae, each for both signs, and weights of Gauss's quadrature with 12 points on [-1, 1]: exact to degree 23.
/// Abramowitz and Stegun, Handbook of Mathematical Functions, 1964, table 25.4.
const GAUSS: [(f64, f64); 6] = [
    (0.125_233_408_511_468_9, 0.249_147_045_813_402_8),
    (0.367_831_498_998_180_2, 0.233_492_536_538_354_8),
    (0.587_317_954_286_617_5, 0.203_167_426_723_065_9),
    (0.769_902_674_194_304_7, 0.160_078_328_543_346_2),
    (0.904_117_256_370_474_9, 0.106_939_325_995_318_4),
    (0.981_560_634_246_719_2, 0.047_175_336_386_511_8),
];

#[cfg(test)]
mod tests {
    use super::GAUSS;

    #[test]
    fn the_quadrature_is_exact_for_even_powers_to_22() {
        for power in (0..=22).step_by(2) {
            let sum: f64 = GAUSS.iter().map(|(abscissa, weight)| 2.0 * weight * abscissa.powi(power)).sum();
            assert!((sum - 2.0 / f64::from(power + 1)).abs() < 1e-15, "x^{power}: {sum}");
        }
        let beyond: f64 = GAUSS.iter().map(|(abscissa, weight)| 2.0 * weight * abscissa.powi(24)).sum();
        assert!((beyond - 2.0 / 25.0).abs() > 1e-15, "the test cannot tell");
    }
}
