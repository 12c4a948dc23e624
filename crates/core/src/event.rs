//! Events: what happens once in a flight, when a quantity passes a value.

use crate::parachute::Parachute;
use crate::propulsion::{Impulse, Thrust};
use crate::scalar::Scalar;
use crate::steering::Steering;
use crate::vehicle::Aerodynamics;

/// Something that happens once in a flight.
///
/// It happens at the first instant at which its trigger is met, and never again.
#[derive(Clone, Debug, PartialEq)]
pub struct Event {
    /// What the event waits for.
    pub when: Trigger,
    /// What the event changes. An event that changes nothing marks an instant of the flight.
    pub then: Effect,
}

/// What an event, or the end of a flight, waits for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trigger {
    /// A quantity passes a value.
    Condition(Condition),
    /// So much time has passed since another event happened.
    After {
        /// The place of the other event in the list.
        event: usize,
        /// The time after that event, s; not negative.
        delay: f64,
    },
    /// So much time has passed since an engine burnt out: its propellant was spent or its thrust profile over. One that is shut down does not
    /// burn out.
    AfterBurnout {
        /// The place of its part in the list.
        part: usize,
        /// The time after the burnout, s; not negative.
        delay: f64,
    },
}

impl From<Condition> for Trigger {
    fn from(condition: Condition) -> Self {
        Self::Condition(condition)
    }
}

impl Trigger {
    /// The condition, if it is one.
    pub fn condition(&self) -> Option<&Condition> {
        match self {
            Self::Condition(condition) => Some(condition),
            Self::After { .. } | Self::AfterBurnout { .. } => None,
        }
    }
}

/// A quantity passes a value.
///
/// The condition is met at the first instant at which the quantity, having been on the near side of the value, is on it or beyond,
/// whether it moved there or jumped, as the load factor does where a parachute opens. A quantity that begins on the value meets it
/// at once if it moves on to the far side, however slowly; one that begins beyond must come back first.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Condition {
    /// The quantity that passes the value.
    pub quantity: Quantity,
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// Whether the quantity must rise or fall through the value.
    pub direction: Direction,
}

/// A quantity of the flight that a condition may name, in SI units.
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
    /// Of the vehicle, kg.
    Mass,
    /// Relative to the air, m/s.
    AirSpeed,
    /// Relative to inertial space, m/s.
    InertialSpeed,
    /// Half the squared inertial speed and the potential of the planet's gravity, J/kg.
    SpecificEnergy,
    /// Of the osculating orbit, above the equatorial radius, m; 1e13 m where the orbit is not bound.
    ApoapsisAltitude,
    /// Of the osculating orbit, above the equatorial radius, m.
    PeriapsisAltitude,
    /// Of the osculating orbit; 1 for motion along the radius vector.
    Eccentricity,
    /// Of the osculating orbit to the equator, rad.
    Inclination,
    /// Into the stagnation point, W/m².
    HeatFlux,
    /// Into the stagnation point since the start, J/m².
    HeatLoad,
    /// At which the wall radiates what it gets, K.
    WallTemperature,
    /// Along the great circle of the initial heading, m; it goes on beyond half the globe.
    Downrange,
    /// The great circle from the initial ground point, m.
    GroundRange,
    /// -dV/dt of the speed relative to the planet, m/s².
    Deceleration,
    /// Of the air, kg/m³.
    Density,
    /// Of a vehicle that nothing holds and that is at rest, along the outward normal of the planet's shape, m/s²: what thrust, gravity and the
    /// turning of the planet give it.
    UpwardAcceleration,
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
    /// The thrust.
    pub thrust: Option<ThrustCommand>,
    /// The parachutes that are cut off, each by the number of the event that deploys it; one that is not there stays away.
    pub release: Vec<usize>,
    /// A parachute that is deployed, after those that are cut off.
    pub deploy: Option<Parachute>,
    /// Whether a vehicle that was held on the ground is set free.
    pub lift_off: bool,
    /// What leaves the vehicle, before all else.
    pub separate: Vec<Separation>,
    /// The parts whose engines are shut down, each by its place in the list.
    pub shut_down: Vec<usize>,
    /// The parts whose engines are lit, each by its place in the list.
    pub ignite: Vec<usize>,
    /// How far engines are throttled, whether they are lit yet or not.
    pub throttle: Vec<Throttle>,
    /// The load factor that throttles all engines alike, once it is reached; none within the outer option where it no longer does.
    pub load_limit: Option<Option<f64>>,
    /// Where the axis of the vehicle points.
    pub steer: Option<Steering>,
    /// A turn of the velocity.
    pub tilt: Option<Tilt>,
}

/// Parts that leave the vehicle together.
#[derive(Clone, Debug, PartialEq)]
pub struct Separation {
    /// Each by its place in the list.
    pub parts: Vec<usize>,
    /// What it adds to their velocity; the vehicle that remains keeps its own.
    pub push: Option<Impulse>,
    /// The place of their case in the list of bodies.
    pub body: usize,
}

/// How far the engines of a part are throttled.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Throttle {
    /// Its place in the list of parts.
    pub part: usize,
    /// The share of thrust in vacuum and of mass flow, from 0 to 1.
    pub value: f64,
}

/// A turn of the velocity at an instant, that keeps the speed: the pitch-over of a launch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tilt {
    /// From the direction away from the planet's centre, rad.
    pub angle: f64,
    /// Towards which it turns, clockwise from north, rad.
    pub azimuth: f64,
}

/// How an event changes the thrust.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ThrustCommand {
    /// A thrust starts; one that acts ends.
    On(Thrust),
    /// The thrust ends.
    Off,
}

impl Quantity {
    /// All of them.
    pub(crate) const ALL: [Self; 23] = [
        Self::Time,
        Self::Altitude,
        Self::Speed,
        Self::Mach,
        Self::DynamicPressure,
        Self::LoadFactor,
        Self::FlightPathAngle,
        Self::Mass,
        Self::AirSpeed,
        Self::InertialSpeed,
        Self::SpecificEnergy,
        Self::ApoapsisAltitude,
        Self::PeriapsisAltitude,
        Self::Eccentricity,
        Self::Inclination,
        Self::HeatFlux,
        Self::HeatLoad,
        Self::WallTemperature,
        Self::Downrange,
        Self::GroundRange,
        Self::Deceleration,
        Self::Density,
        Self::UpwardAcceleration,
    ];

    /// Whether it is known with the loads on the vehicle alone.
    pub(crate) fn is_load(self) -> bool {
        matches!(
            self,
            Self::Mach
                | Self::DynamicPressure
                | Self::LoadFactor
                | Self::AirSpeed
                | Self::HeatFlux
                | Self::WallTemperature
                | Self::Deceleration
                | Self::Density
        )
    }

    /// Whether it is an angle.
    pub fn is_angle(self) -> bool {
        matches!(self, Self::FlightPathAngle | Self::Inclination)
    }

    /// Whether it exists only where heating is asked for.
    pub fn is_of_heating(self) -> bool {
        matches!(self, Self::HeatFlux | Self::HeatLoad | Self::WallTemperature)
    }

    /// The least size of a value from which its resolution follows, in the unit of the quantity: smaller values are as exact as this one.
    fn scale(self) -> f64 {
        match self {
            Self::Altitude | Self::ApoapsisAltitude | Self::PeriapsisAltitude | Self::Downrange | Self::GroundRange => {
                1e3
            }
            Self::Density => 1e-9,
            _ => 1.0,
        }
    }
}

impl Condition {
    /// How far a quantity is on the near side of the value; negative beyond.
    pub fn before<S: Scalar>(&self, quantity: S) -> S {
        match self.direction {
            Direction::Falling => quantity - self.value,
            Direction::Rising => -quantity + self.value,
        }
    }

    /// A quantity that is nearer to the value than this counts as on it: far more than a rounding error, and far less than matters.
    pub fn resolution(&self) -> f64 {
        match self.quantity {
            Quantity::Time => 1e-9,
            quantity => 1e-9 * self.value.abs().max(quantity.scale()),
        }
    }
}

impl Effect {
    /// The thrust that is switched on, if one is.
    pub(crate) fn thrust(&self) -> Option<&Thrust> {
        match &self.thrust {
            Some(ThrustCommand::On(thrust)) => Some(thrust),
            Some(ThrustCommand::Off) | None => None,
        }
    }

    /// Whether it changes nothing.
    pub fn is_none(&self) -> bool {
        *self == Self::default()
    }

    /// Whether it changes the vehicle or its thrust; an impulse changes the velocity alone.
    pub fn changes_vehicle(&self) -> bool {
        *self != Self { impulse: self.impulse, tilt: self.tilt, ..Self::default() }
    }
}
