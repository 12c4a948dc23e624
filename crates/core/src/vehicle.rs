//! The vehicle: its mass and its aerodynamics.

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

/// The coefficients of an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients {
    /// `C_L`.
    pub lift: f64,
    /// `C_D`.
    pub drag: f64,
}

impl Aerodynamics {
    /// Lift and drag coefficient.
    #[inline(always)]
    pub fn coefficients(&self) -> Coefficients {
        let Self::Constant { lift_coefficient, drag_coefficient } = *self;
        Coefficients { lift: lift_coefficient, drag: drag_coefficient }
    }
}

impl Vehicle {
    /// Whether the vehicle has any lift.
    pub fn has_lift(&self) -> bool {
        self.aerodynamics.coefficients().lift != 0.0 && self.reference_area > 0.0
    }
}
