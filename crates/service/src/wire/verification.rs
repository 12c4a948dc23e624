//! How exact a flight is.

use reentry::verification::Verification as CoreVerification;
use serde::Serialize;
use utoipa::ToSchema;

/// How exact the flight is: beside one at a hundredth of its tolerance, and by its balance of energy.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Verification {
    /// The tolerance of the finer flight: a hundredth of the flight's, but at least 1e-14. Where it is the flight's own, both are
    /// the same flight, and the differences of 0 say nothing.
    pub relative_tolerance: f64,
    /// The final time less that of the finer flight, s.
    pub time_difference: f64,
    /// Between the final positions of both in the planet-fixed frame, m.
    pub distance: f64,
    /// The greatest amount on the way by which V²/2 - ω²(x² + y²)/2 + U, with the potential U of gravity (-GM/r and its harmonics),
    /// and the work of drag and thrust did not add up, J/kg.
    /// The work is summed on the dense output, which is less exact than the steps.
    pub energy_drift: f64,
    /// The energy that the drag has taken, and in wind the lift, J/kg, to compare the drift with.
    pub drag_work: f64,
    /// The energy that thrust has given, J/kg, impulses not included; where an event switches thrust.
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
