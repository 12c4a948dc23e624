//! The vehicle: its mass and its aerodynamics.

mod alpha_mach_table;
mod mach_table;

pub use alpha_mach_table::AlphaMachTable;
pub use mach_table::MachTable;

use std::sync::Arc;

use crate::scalar::Scalar;

/// Lift and drag coefficients. Those that are numbers by themselves may carry derivatives.
#[derive(Clone, Debug, PartialEq)]
pub enum Aerodynamics<P = f64> {
    /// The same at every speed.
    Constant {
        /// `C_L`; negative lift points down at zero bank.
        lift_coefficient: P,
        /// `C_D`.
        drag_coefficient: P,
    },
    /// The same at every speed, given by ratios; the mass and the reference area of the vehicle do not matter.
    Ballistic {
        /// `m/(C_D S)`, kg/m².
        ballistic_coefficient: P,
        /// `C_L/C_D`.
        lift_to_drag: P,
    },
    /// By Mach number.
    MachTable(Arc<MachTable>),
    /// By angle of attack and Mach number.
    AlphaMachTable(Arc<AlphaMachTable>),
}

/// A point mass with lift and drag. Its numbers may carry derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Vehicle<P = f64> {
    /// Mass, kg.
    pub mass: P,
    /// Area to which the coefficients refer, m².
    pub reference_area: P,
    /// The coefficients.
    pub aerodynamics: Aerodynamics<P>,
    /// Of the nose at its stagnation point, m; needed for heating alone.
    pub nose_radius: Option<f64>,
}

/// The coefficients of an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coefficients<S> {
    /// `C_L`.
    pub lift: S,
    /// `C_D`.
    pub drag: S,
}

impl Aerodynamics {
    /// Whether the coefficients depend on the Mach number.
    pub fn is_by_mach(&self) -> bool {
        match self {
            Self::Constant { .. } | Self::Ballistic { .. } => false,
            Self::MachTable(_) | Self::AlphaMachTable(_) => true,
        }
    }

    /// Whether there is any lift.
    pub fn has_lift(&self) -> bool {
        match self {
            Self::Constant { lift_coefficient, .. } => *lift_coefficient != 0.0,
            Self::Ballistic { lift_to_drag, .. } => *lift_to_drag != 0.0,
            Self::MachTable(table) => table.has_lift(),
            Self::AlphaMachTable(table) => table.has_lift(),
        }
    }

    /// The two numbers by themselves; zeros of a table.
    pub(crate) fn numbers(&self) -> [f64; 2] {
        match *self {
            Self::Constant { lift_coefficient, drag_coefficient } => [lift_coefficient, drag_coefficient],
            Self::Ballistic { ballistic_coefficient, lift_to_drag } => [ballistic_coefficient, lift_to_drag],
            Self::MachTable(_) | Self::AlphaMachTable(_) => [0.0; 2],
        }
    }
}

impl<P: Scalar> Vehicle<P> {
    /// The same in other numbers.
    pub(crate) fn map<Q>(&self, number: impl Fn(P) -> Q + Copy) -> Vehicle<Q> {
        let aerodynamics = match &self.aerodynamics {
            Aerodynamics::Constant { lift_coefficient, drag_coefficient } => Aerodynamics::Constant {
                lift_coefficient: number(*lift_coefficient),
                drag_coefficient: number(*drag_coefficient),
            },
            Aerodynamics::Ballistic { ballistic_coefficient, lift_to_drag } => Aerodynamics::Ballistic {
                ballistic_coefficient: number(*ballistic_coefficient),
                lift_to_drag: number(*lift_to_drag),
            },
            Aerodynamics::MachTable(table) => Aerodynamics::MachTable(Arc::clone(table)),
            Aerodynamics::AlphaMachTable(table) => Aerodynamics::AlphaMachTable(Arc::clone(table)),
        };
        let [mass, reference_area] = [self.mass, self.reference_area].map(number);
        Vehicle { mass, reference_area, aerodynamics, nose_radius: self.nose_radius }
    }

    /// The same vehicle with another mass, kg; its coefficients and area stay, and with them `C_D S` where that is given by a ratio to
    /// the mass.
    #[must_use]
    pub fn with_mass(&self, mass: P) -> Self {
        let aerodynamics = match self.aerodynamics {
            Aerodynamics::Ballistic { ballistic_coefficient, lift_to_drag } => {
                let ballistic_coefficient = ballistic_coefficient * (mass * self.mass.recip());
                Aerodynamics::Ballistic { ballistic_coefficient, lift_to_drag }
            }
            ref other => other.clone(),
        };
        Self { mass, aerodynamics, ..*self }
    }

    /// Whether it is given by its ballistic coefficient and its lift-to-drag ratio.
    pub(crate) fn is_ballistic(&self) -> bool {
        matches!(self.aerodynamics, Aerodynamics::Ballistic { .. })
    }
}

impl Vehicle {
    /// Whether the vehicle has any lift.
    pub fn has_lift(&self) -> bool {
        self.aerodynamics.has_lift() && (self.is_ballistic() || self.reference_area > 0.0)
    }
}
