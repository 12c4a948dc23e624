//! Propulsion: impulses, and a constant thrust that burns propellant.

/// The unit of the load factor and of the specific impulse, m/s²: the standard acceleration of gravity (3rd CGPM, 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// A direction that moves with the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Axis {
    /// v̂, along the velocity relative to the rotating planet; none at rest.
    Velocity,
    /// r̂, away from the planet's centre.
    Radial,
    /// r̂ × v̂ over its length, level and to the left of the flight direction; none at rest and in vertical flight. Within
    /// 0.001 rad of the vertical a thrust along it fades out as lift does.
    Normal,
}

/// A change of velocity at an instant: a burn so short that nothing else happens meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    /// Where to; the direction is that of the velocity before.
    pub along: Axis,
    /// By how much, m/s; negative against the direction.
    pub speed_change: f64,
}

/// A constant force that is switched on and burns propellant at a constant rate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thrust {
    /// Where to, at every instant.
    pub along: Axis,
    /// N; negative against the direction.
    pub force: f64,
    /// The impulse that a unit of propellant's weight at standard gravity gives, s.
    pub specific_impulse: f64,
    /// How much there is to burn, kg; without a number, until the thrust is switched off.
    pub propellant: Option<f64>,
}

impl Thrust {
    /// The propellant that is burnt, kg/s.
    ///
    /// ```text
    /// ṁ = -|T| / (g₀ I_sp)
    /// ```
    ///
    /// # Reference
    /// G. P. Sutton and O. Biblarz, Rocket Propulsion Elements, 9th ed., 2017, equation 2-5.
    ///
    /// # Examples
    /// ```
    /// use reentry::propulsion::{Axis, Thrust};
    ///
    /// // An exhaust of 3 km/s: a kilogram a second gives 3 kN.
    /// let thrust = Thrust { along: Axis::Velocity, force: -3000.0, specific_impulse: 3000.0 / 9.806_65, propellant: None };
    /// assert!((thrust.mass_flow() - 1.0).abs() < 1e-15);
    /// ```
    pub fn mass_flow(&self) -> f64 {
        self.force.abs() / (STANDARD_GRAVITY * self.specific_impulse)
    }
}
