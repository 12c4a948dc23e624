//! The vehicle: its mass and its aerodynamics.

use crate::scalar::Scalar;

/// Lift and drag coefficients.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Aerodynamics {
    /// The same at every speed.
    Constant {
        /// `C_L`; negative lift points down at zero bank.
        lift_coefficient: f64,
        /// `C_D`.
        drag_coefficient: f64,
    },
}

/// A point mass with lift and drag.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vehicle {
    /// Mass, kg.
    pub mass: f64,
    /// Area to which the coefficients refer, m².
    pub reference_area: f64,
    /// The coefficients.
    pub aerodynamics: Aerodynamics,
}

/// The aerodynamic accelerations at full lift, m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AerodynamicAcceleration<S> {
    /// D/m, against the velocity.
    pub drag: S,
    /// L/m, across the velocity.
    pub lift: S,
}

impl Vehicle {
    /// Lift and drag per mass under a dynamic pressure, Pa.
    ///
    /// ```text
    /// D = ½ ρ V² S C_D,   L = ½ ρ V² S C_L
    /// ```
    ///
    /// # Reference
    /// Jameson 2006, equations 36 and 37.
    #[inline(always)]
    pub fn aerodynamic_acceleration<S: Scalar>(&self, dynamic_pressure: S) -> AerodynamicAcceleration<S> {
        let Aerodynamics::Constant { lift_coefficient, drag_coefficient } = self.aerodynamics;
        let acceleration = dynamic_pressure * (self.reference_area / self.mass);
        AerodynamicAcceleration { drag: acceleration * drag_coefficient, lift: acceleration * lift_coefficient }
    }

    /// Whether the vehicle has any lift.
    pub fn has_lift(&self) -> bool {
        let Aerodynamics::Constant { lift_coefficient, .. } = self.aerodynamics;
        lift_coefficient != 0.0 && self.reference_area > 0.0
    }
}
