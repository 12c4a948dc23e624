//! Propulsion: impulses, and a constant thrust that burns propellant.

use nalgebra::{Rotation3, UnitVector3, Vector3};

use crate::scalar::Scalar;

/// The unit of the load factor and of the specific impulse, m/s²: the standard acceleration of gravity (3rd CGPM, 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// A direction in which a vehicle is pushed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThrustAxis {
    /// v̂, along the velocity relative to the rotating planet; none at rest.
    Velocity,
    /// r̂, away from the planet's centre.
    Radial,
    /// r̂ × v̂ over its length, level and to the left of the flight direction; none at rest and in vertical flight. Within
    /// 0.001 rad of the vertical a thrust along it fades out as lift does.
    Normal,
    /// (r̂ × v̂) × r̂ over its length, the level part of the velocity relative to the rotating planet; none at rest and in vertical
    /// flight. Within 0.001 rad of the vertical a thrust along it fades out as lift does.
    Horizontal,
    /// A direction that stays where it is in inertial space, while the planet turns; in planet-fixed components at t = 0.
    Inertial(UnitVector3<f64>),
}

impl ThrustAxis {
    /// The inertial direction of a vector of any length, in planet-fixed components at t = 0; none of the zero vector.
    ///
    /// # Examples
    /// ```
    /// use reentry::propulsion::ThrustAxis;
    ///
    /// let Some(ThrustAxis::Inertial(direction)) = ThrustAxis::inertial([3e200, 0.0, 4e200]) else { panic!("it has a direction") };
    /// assert!((direction.x - 0.6).abs() < 1e-15 && (direction.z - 0.8).abs() < 1e-15);
    /// assert_eq!(ThrustAxis::inertial([0.0; 3]), None);
    /// ```
    pub fn inertial(components: [f64; 3]) -> Option<Self> {
        let components = Vector3::from(components);
        // The squares of huge and of tiny components would be none.
        let greatest = components.amax();
        (greatest > 0.0).then(|| Self::Inertial(UnitVector3::new_normalize(components / greatest)))
    }

    /// The same in other components, by the rotation that takes the ones to the others; what moves with the vehicle stays as it is.
    #[must_use]
    pub fn rotated_by(self, rotation: &Rotation3<f64>) -> Self {
        match self {
            Self::Inertial(direction) => Self::Inertial(rotation * direction),
            other => other,
        }
    }

    /// Whether there is none in vertical flight, near which a thrust along it fades out.
    pub(crate) fn is_level(self) -> bool {
        matches!(self, Self::Normal | Self::Horizontal)
    }
}

/// A change of velocity at an instant: a burn so short that nothing else happens meanwhile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Impulse {
    /// Where to; the direction is that of the velocity before.
    pub along: ThrustAxis,
    /// By how much, m/s; negative against the direction.
    pub speed_change: f64,
}

/// A constant force that is switched on, and that may burn propellant at a constant rate. Its numbers may carry derivatives.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Thrust<P = f64> {
    /// Where to, at every instant.
    pub along: ThrustAxis,
    /// N; negative against the direction.
    pub force: P,
    /// The impulse that a unit of propellant's weight at standard gravity gives, s; without a number, the mass stays.
    pub specific_impulse: Option<P>,
    /// How much there is to burn, kg; without a number, until the thrust is switched off. Only with a specific impulse.
    pub propellant: Option<P>,
}

impl<P: Scalar> Thrust<P> {
    /// The propellant that is burnt, kg/s; none without a specific impulse.
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
    /// use reentry::propulsion::{ThrustAxis, Thrust};
    ///
    /// // An exhaust of 3 km/s: a kilogram a second gives 3 kN.
    /// let specific_impulse = Some(3000.0 / 9.806_65);
    /// let thrust: Thrust = Thrust { along: ThrustAxis::Velocity, force: -3000.0, specific_impulse, propellant: None };
    /// assert!((thrust.mass_flow() - 1.0).abs() < 1e-15);
    /// ```
    pub fn mass_flow(&self) -> P {
        let of = |specific_impulse: P| self.magnitude() * (specific_impulse * STANDARD_GRAVITY).recip();
        self.specific_impulse.map_or(P::zero(), of)
    }

    /// The same in other numbers.
    pub(crate) fn map<Q>(&self, number: impl Fn(P) -> Q + Copy) -> Thrust<Q> {
        let Self { along, force, specific_impulse, propellant } = *self;
        let [specific_impulse, propellant] = [specific_impulse, propellant].map(|of| of.map(number));
        Thrust { along, force: number(force), specific_impulse, propellant }
    }

    /// The size of the force, N.
    pub(crate) fn magnitude(&self) -> P {
        P::select(self.force.less_than(0.0), -self.force, self.force)
    }
}
