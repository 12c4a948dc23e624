//! Events: what happens once in a flight, when a quantity passes a value.

use crate::propulsion::{Impulse, Thrust};
use crate::scalar::Scalar;
use crate::vehicle::Aerodynamics;

/// Something that happens once in a flight.
///
/// It happens at the first instant at which its condition is met, and never again.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// When.
    pub when: Condition,
    /// What; nothing at all makes it a mark.
    pub then: Effect,
}

/// A quantity passes a value.
///
/// The condition is met at the first instant at which the quantity, having been on the near side of the value, is on it or beyond,
/// whether it moved there or jumped, as the load factor does where a parachute opens. A quantity that begins on the value meets it
/// where it moves on to the far side; one that begins beyond must come back first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// Which.
    pub quantity: Quantity,
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// To which side.
    pub direction: Direction,
}

/// What may pass a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Since the start, s.
    Time,
    /// Along the radius vector, m.
    Altitude,
    /// Relative to the rotating planet, m/s.
    Speed,
    /// The speed relative to the air over that of sound.
    Mach,
    /// ½ρV² of the speed relative to the air, Pa.
    DynamicPressure,
    /// The force that is not gravity over the weight at standard gravity.
    LoadFactor,
    /// Of the velocity relative to the planet, rad.
    FlightPathAngle,
}

/// A side of a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From above to the value.
    Falling,
    /// From below to the value.
    Rising,
}

/// What an event changes, from its instant on; what it does not name stays as it is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Effect {
    /// kg.
    pub mass: Option<f64>,
    /// m².
    pub reference_area: Option<f64>,
    /// The coefficients.
    pub aerodynamics: Option<Aerodynamics>,
    /// A change of velocity.
    pub impulse: Option<Impulse>,
    /// The engine.
    pub engine: Option<Engine>,
}

/// What becomes of the thrust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Engine {
    /// It is switched on, in place of one that burns.
    On(Thrust),
    /// It is switched off.
    Off,
}

impl Quantity {
    /// All of them.
    pub(crate) const ALL: [Self; 7] = [
        Self::Time,
        Self::Altitude,
        Self::Speed,
        Self::Mach,
        Self::DynamicPressure,
        Self::LoadFactor,
        Self::FlightPathAngle,
    ];
}

impl Condition {
    /// How far a quantity is on the near side of the value; negative beyond.
    pub fn before<S: Scalar>(&self, quantity: S) -> S {
        match self.direction {
            Direction::Falling => quantity - self.value,
            Direction::Rising => -quantity + self.value,
        }
    }

    /// So near the value, a quantity counts as on it: far more than a rounding, far less than anybody sees.
    pub fn resolution(&self) -> f64 {
        match self.quantity {
            Quantity::Time => 1e-9,
            _ => 1e-9 * self.value.abs().max(1.0),
        }
    }
}

impl Effect {
    /// Whether it changes nothing.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }
}
