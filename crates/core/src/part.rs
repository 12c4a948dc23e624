//! The parts of a vehicle: stages, boosters, fairings and payloads, with their propellant and their engines.

use std::sync::Arc;

use crate::propulsion::STANDARD_GRAVITY;
use crate::scalar::Scalar;

/// The pressure at sea level to which a thrust there refers, Pa: that of the U.S. Standard Atmosphere.
pub const SEA_LEVEL_PRESSURE: f64 = 101_325.0;

/// A part of a vehicle, of which there may be several that do the same at the same time.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// How many of them there are; all other numbers are of one.
    pub count: u32,
    /// Without propellant, kg.
    pub dry_mass: f64,
    /// At the start, kg.
    pub propellant: f64,
    /// That which burns the propellant; none of a part that is carried.
    pub engine: Option<Engine>,
}

/// A rocket engine.
///
/// ```text
/// T = k T_v - A_e p,   ṁ = -k T_v / (g₀ I_sp)
/// ```
///
/// with its throttle k.
///
/// # Reference
/// G. P. Sutton and O. Biblarz, Rocket Propulsion Elements, 9th ed., 2017, equations 2-5 and 2-13.
#[derive(Clone, Debug, PartialEq)]
pub struct Engine {
    /// `T_v`, in vacuum, N.
    pub thrust: ThrustProfile,
    /// `I_sp`, in vacuum, s.
    pub specific_impulse: f64,
    /// `A_e`, on which the pressure of the air acts, m².
    pub exit_area: f64,
}

/// The thrust of an engine in vacuum since it was lit.
#[derive(Clone, Debug, PartialEq)]
pub enum ThrustProfile {
    /// The same until the propellant is spent, N.
    Constant(f64),
    /// By the time since ignition, along straight lines; it ends with its last entry.
    Table(Arc<[ThrustEntry]>),
}

/// An entry of a thrust profile.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ThrustEntry {
    /// Since ignition, s.
    pub time: f64,
    /// In vacuum, N.
    pub thrust: f64,
}

impl Part {
    /// Of all of them with their propellant, kg.
    pub fn mass(&self) -> f64 {
        f64::from(self.count) * (self.dry_mass + self.propellant)
    }
}

impl Engine {
    /// The exit area of an engine by its thrusts in vacuum and at sea level, N, m².
    pub fn exit_area(vacuum: f64, sea_level: f64) -> f64 {
        (vacuum - sea_level) / SEA_LEVEL_PRESSURE
    }

    /// The mass flow, kg/s, of a unit of its thrust in vacuum.
    pub(crate) fn mass_flow_of_unit(specific_impulse: f64) -> f64 {
        (specific_impulse * STANDARD_GRAVITY).recip()
    }
}

impl ThrustProfile {
    /// The entry of a number, counted from 0; a constant thrust has a single one.
    pub(crate) fn entry(&self, number: usize) -> Option<ThrustEntry> {
        match self {
            Self::Constant(thrust) => (number == 0).then_some(ThrustEntry { time: 0.0, thrust: *thrust }),
            Self::Table(entries) => entries.get(number).copied(),
        }
    }
}

/// A straight piece of the thrust of an engine that is lit: all engines of a part together, at full throttle in vacuum.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ThrustPiece<P> {
    /// When it was lit, s.
    pub(crate) ignition: P,
    /// The number of the piece.
    pub(crate) number: usize,
    /// Where it begins or the present phase does, N.
    pub(crate) thrust: P,
    /// N/s.
    pub(crate) rate: P,
    /// When it ends, s; none where the propellant alone ends it.
    pub(crate) until: Option<P>,
    /// The mass flow of a unit of thrust, kg/s/N.
    pub(crate) mass_flow_of_unit: P,
    /// m².
    pub(crate) exit_area: P,
}

impl<P: Scalar<Value = f64, Mask = bool>> ThrustPiece<P> {
    /// The same in other numbers.
    pub(crate) fn map<Q>(&self, number: impl Fn(P) -> Q + Copy) -> ThrustPiece<Q> {
        ThrustPiece {
            ignition: number(self.ignition),
            number: self.number,
            thrust: number(self.thrust),
            rate: number(self.rate),
            until: self.until.map(number),
            mass_flow_of_unit: number(self.mass_flow_of_unit),
            exit_area: number(self.exit_area),
        }
    }

    /// The propellant that is burnt at a throttle over a time, s, from where the piece begins, kg.
    pub(crate) fn burnt(&self, throttle: P, elapsed: P) -> P {
        (self.thrust + self.rate * elapsed * 0.5) * elapsed * self.mass_flow_of_unit * throttle
    }

    /// The time after which a propellant, kg, is spent at a throttle, s; none where the piece never burns so much.
    pub(crate) fn time_to_burn(&self, propellant: P, throttle: P) -> Option<P> {
        // With the impulse I = T t + Ṫ t²/2 that the propellant gives: t = 2I/(T + √(T² + 2ṪI)).
        let flow = self.mass_flow_of_unit * throttle;
        if flow.value() <= 0.0 {
            return None;
        }
        let impulse = propellant * flow.recip();
        if impulse.value() <= 0.0 {
            return Some(P::zero());
        }
        let square = self.thrust * self.thrust + self.rate * impulse * 2.0;
        if square.value() < 0.0 {
            return None;
        }
        let sum = self.thrust + square.sqrt();
        (sum.value() > 0.0).then(|| impulse * 2.0 * sum.recip())
    }
}
