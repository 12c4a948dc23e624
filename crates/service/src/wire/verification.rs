//! How exact a flight is.

use reentry::verification::Verification as CoreVerification;
use serde::Serialize;
use utoipa::ToSchema;

/// Numerical accuracy of a flight: comparison with a flight at a hundredth of its tolerance, and energy balance.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Verification {
    /// Tolerance of the finer flight: a hundredth of the flight's tolerance, but at least 1e-14. If it equals the
    /// flight's tolerance, both flights are the same and the differences of 0 carry no information.
    pub relative_tolerance: f64,
    /// Final time minus that of the finer flight, s.
    pub time_difference: f64,
    /// Distance between the final positions of both flights in the planet-fixed frame, m.
    pub distance: f64,
    /// Largest imbalance during the flight between the specific energy V²/2 - ω²(x² + y²)/2 + U, with the gravitational
    /// potential U (-GM/r and its harmonics), and the work of drag and thrust, J/kg. The work is integrated along the
    /// dense output, which is less accurate than the steps.
    pub energy_drift: f64,
    /// Energy removed by drag (in wind, by drag and lift), J/kg; the scale for `energy_drift`.
    pub drag_work: f64,
    /// Energy added by thrust, J/kg, without impulses; present if an event switches thrust.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub thrust_work: Option<f64>,
}

impl Verification {
    /// That of a flight, with or without thrust.
    pub fn from_core(core: CoreVerification, has_thrust: bool) -> Self {
        let CoreVerification { relative_tolerance, time_difference, distance, energy_drift, drag_work, thrust_work } =
            core;
        Self {
            relative_tolerance,
            time_difference,
            distance,
            energy_drift,
            drag_work,
            thrust_work: has_thrust.then_some(thrust_work),
        }
    }
}
