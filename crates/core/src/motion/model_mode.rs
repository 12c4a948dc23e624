//! The mode of the piecewise models: of each the segment whose formula is in use.
//!
//! A step of the integration must not see such a change: an integrator that does grinds its steps down. While a step is taken, the
//! mode therefore stays what it is, and every formula goes on beyond its own segment; the flight looks for the instant at which it
//! leaves the segment, ends the step there, and [enters the next mode](super::Forces::enter_mode_of).

use num_dual::Dual64;

use super::{Flow, Forces, State, StateRate};
use crate::atmosphere::Atmosphere;
use crate::control::Against;
use crate::heating::Radiative;
use crate::scalar::{Over, Scalar};
use crate::vehicle::Aerodynamics;
use crate::wind::Wind;

/// What may change its formula during a flight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Switch {
    /// The atmosphere, from layer to layer.
    Atmosphere,
    /// The wind, at the ends of its table.
    Wind,
    /// The aerodynamics, at the ends of their Mach numbers.
    Mach,
    /// The aerodynamics, at the ends of their angles of attack.
    TableAngleOfAttack,
    /// The bank angle, at the corners of its schedule.
    BankAngle,
    /// The angle of attack, at the corners of its schedule.
    AngleOfAttack,
    /// The radiation of the air, at the entries of its table.
    Radiation,
}

/// A table or a model of a given range, and the quantity by which something is looked up in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TableId {
    /// The atmosphere by altitude; outside, the logarithm of its density goes on in a straight line.
    Atmosphere,
    /// The U.S. Standard Atmosphere, 1976, by altitude; below -5 km its lowest layer goes on, above 1000 km its scale height stays.
    Us76,
    /// NRLMSISE-00, by altitude; below -5 km the temperature stays, above 1000 km its formulas go on.
    Nrlmsise00,
    /// The wind by altitude.
    Wind,
    /// The aerodynamics by Mach number.
    Mach,
    /// The aerodynamics by angle of attack.
    AngleOfAttack,
    /// The radiation of the air by speed; below its table there is none.
    Radiation,
}

/// The quantity on which the segments of a model depend.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum SwitchQuantity {
    /// What a schedule runs along.
    Along(Against),
    /// α, rad.
    AngleOfAttack,
    /// Relative to the air, m/s.
    AirSpeed,
}

/// Of every switch the segment of its formula that holds: 0 before the first boundary, 1 after it, and so on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ModelMode([usize; Switch::ALL.len()]);

/// On either side of a boundary the motion leads back across it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chatter(pub(crate) Switch);

impl Switch {
    /// All of them.
    pub(crate) const ALL: [Self; 7] = [
        Self::Atmosphere,
        Self::Wind,
        Self::Mach,
        Self::TableAngleOfAttack,
        Self::BankAngle,
        Self::AngleOfAttack,
        Self::Radiation,
    ];

    /// Whether it is the first and the last entry of a table.
    fn is_of_table(self) -> bool {
        matches!(self, Self::Wind | Self::Mach | Self::TableAngleOfAttack)
    }
}

impl ModelMode {
    /// The segment of a switch.
    #[inline(always)]
    pub(crate) fn of(&self, switch: Switch) -> usize {
        self.0[switch as usize]
    }
}

impl SwitchQuantity {
    /// A flight that is nearer to a boundary than this counts as on it, and belongs to the side to which it moves: far more than a rounding
    /// error, and far less than matters; s, m, m/s, a Mach number or rad.
    pub(crate) fn resolution(self) -> f64 {
        match self {
            Self::Along(Against::Time | Against::Mach) | Self::AngleOfAttack => 1e-9,
            Self::Along(Against::Altitude | Against::Speed) | Self::AirSpeed => 1e-6,
        }
    }
}

impl<P: Scalar> Forces<P> {
    /// The mode that holds.
    pub fn mode(&self) -> ModelMode {
        self.mode
    }

    /// Changes to another mode.
    pub fn enter(&mut self, mode: ModelMode) {
        self.mode = mode;
    }

    /// Whether any of the models changes its formula anywhere.
    pub fn has_switches(&self) -> bool {
        self.has_switches
    }

    /// By what a switch turns, and at which values, ascending; none where it never does.
    pub(crate) fn boundaries(&self, switch: Switch) -> Option<(SwitchQuantity, &[f64])> {
        const ALTITUDE: SwitchQuantity = SwitchQuantity::Along(Against::Altitude);
        const MACH: SwitchQuantity = SwitchQuantity::Along(Against::Mach);
        fn along((against, corners): (Against, &[f64])) -> (SwitchQuantity, &[f64]) {
            (SwitchQuantity::Along(against), corners)
        }
        let boundaries = match switch {
            Switch::Atmosphere => Some((ALTITUDE, self.models.atmosphere.boundaries())),
            Switch::Wind => match &self.models.wind {
                Wind::Still | Wind::Constant { .. } => None,
                Wind::Table(table) => Some((ALTITUDE, &table.range()[..])),
            },
            Switch::Mach => match &self.models.aerodynamics {
                Aerodynamics::Constant { .. } | Aerodynamics::Ballistic { .. } => None,
                Aerodynamics::MachTable(table) => Some((MACH, &table.range()[..])),
                Aerodynamics::AlphaMachTable(table) => Some((MACH, &table.mach_range()[..])),
            },
            Switch::TableAngleOfAttack => match &self.models.aerodynamics {
                Aerodynamics::AlphaMachTable(table) => {
                    Some((SwitchQuantity::AngleOfAttack, &table.angle_of_attack_range()[..]))
                }
                _ => None,
            },
            Switch::BankAngle => self.models.control.bank_angle.corners().map(along),
            Switch::AngleOfAttack => self.models.control.angle_of_attack.corners().map(along),
            Switch::Radiation => {
                self.models.heating.as_ref().map(|heating| (SwitchQuantity::AirSpeed, heating.boundaries()))
            }
        };
        boundaries.filter(|(_, boundaries)| !boundaries.is_empty())
    }

    /// At which values of the quantity of a switch, ascending, its formula has a corner within a segment: a second derivative that jumps, at
    /// the entries of a table.
    fn corners(&self, switch: Switch) -> &[f64] {
        match (switch, &self.models.atmosphere, &self.models.wind, &self.models.aerodynamics) {
            (Switch::Atmosphere, Atmosphere::Table(table), ..) => table.inner(),
            (Switch::Wind, _, Wind::Table(table), _) => table.inner(),
            (Switch::Mach, .., Aerodynamics::MachTable(table)) => table.inner(),
            (Switch::Mach, .., Aerodynamics::AlphaMachTable(table)) => table.inner()[1],
            (Switch::TableAngleOfAttack, .., Aerodynamics::AlphaMachTable(table)) => table.inner()[0],
            _ => &[],
        }
    }

    /// Of every switch the quantity in a state; zero where there is none.
    pub(crate) fn readings<S: Over<P>>(&self, time: S, state: &State<S>) -> [S; Switch::ALL.len()] {
        if !self.has_switches {
            return [S::zero(); Switch::ALL.len()];
        }
        let flow = self.flow_where_mach_matters(time, state);
        Switch::ALL.map(|switch| match self.boundaries(switch) {
            Some((quantity, _)) => self.quantity_of(quantity, time, &flow),
            None => S::zero(),
        })
    }

    /// The air that meets the vehicle, as far as angles and coefficients depend on it: without its density, where that takes a look-up of its own.
    pub(super) fn flow_where_mach_matters<S: Over<P>>(&self, time: S, state: &State<S>) -> Flow<S> {
        if self.by_mach { self.flow::<false, _>(time, state) } else { self.flow_in::<false, _>(None, state) }
    }

    fn quantity_of<S: Over<P>>(&self, quantity: SwitchQuantity, time: S, flow: &Flow<S>) -> S {
        match quantity {
            SwitchQuantity::Along(against) => flow.quantity(against, time),
            SwitchQuantity::AngleOfAttack => self.angle_of_attack(time, flow),
            SwitchQuantity::AirSpeed => flow.directions.speed,
        }
    }
}

impl Forces {
    /// Whether a load may turn more than once in a step: something is looked up between entries that steps do not meet, or a canopy fills.
    pub(crate) fn has_tables(&self) -> bool {
        matches!(self.models.atmosphere, Atmosphere::Table(_))
            || matches!(self.models.wind, Wind::Table(_))
            || self.models.aerodynamics.is_by_mach()
            || self.canopies.as_ref().is_some_and(|canopies| !canopies.filling.is_empty())
    }

    /// The tables, and the model of a given range, outside which the present mode lies: the edge beyond which it does, and whether that is above it.
    pub(crate) fn outside_tables(&self) -> impl Iterator<Item = (TableId, f64, bool)> {
        let atmosphere = match self.models.atmosphere {
            Atmosphere::Table(_) => Some(TableId::Atmosphere),
            Atmosphere::Us76 => Some(TableId::Us76),
            Atmosphere::Nrlmsise00(_) => Some(TableId::Nrlmsise00),
            // The others hold everywhere.
            _ => None,
        };
        let radiation = match self.models.heating.as_ref().map(|stagnation| stagnation.heating.radiative) {
            Some(Radiative::TauberSutton | Radiative::TauberSuttonMars) => Some(TableId::Radiation),
            // The others are formulae.
            _ => None,
        };
        let tables = [
            (Switch::Atmosphere, atmosphere),
            (Switch::Wind, Some(TableId::Wind)),
            (Switch::Mach, Some(TableId::Mach)),
            (Switch::TableAngleOfAttack, Some(TableId::AngleOfAttack)),
            (Switch::Radiation, radiation),
        ];
        tables.into_iter().filter_map(|(switch, table)| {
            let table = table?;
            let (_, range) = self.boundaries(switch)?;
            let segment = self.mode.of(switch);
            let (first, last) = (*range.first()?, *range.last()?);
            match segment {
                // One entry holds everywhere.
                _ if first >= last => None,
                0 => (switch != Switch::Radiation).then_some((table, first, false)),
                _ if segment == range.len() => Some((table, last, true)),
                _ => None,
            }
        })
    }

    /// Which switch leads from the present mode to the next one, in a state at their boundary: that which is nearest to its own.
    pub(crate) fn first_to_turn(&self, next: ModelMode, time: f64, state: &State<f64>) -> Option<Switch> {
        let readings = self.readings(time, state);
        let distance = |switch: &Switch| {
            let (quantity, _) = self.boundaries(*switch)?;
            let boundary = self.boundary_towards(*switch, next)?;
            Some((readings[*switch as usize] - boundary).abs() / quantity.resolution())
        };
        let turning = Switch::ALL.into_iter().filter_map(|switch| Some((switch, distance(&switch)?)));
        turning.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(switch, _)| switch)
    }

    /// The boundary that a switch crosses first on the way from the present mode to another; none where it does not turn.
    pub(crate) fn boundary_towards(&self, switch: Switch, next: ModelMode) -> Option<f64> {
        let (_, boundaries) = self.boundaries(switch)?;
        let (now, then) = (self.mode.of(switch), next.of(switch));
        let boundary = boundaries.get(if then > now { now } else { now.checked_sub(1)? })?;
        (now != then).then_some(*boundary)
    }

    /// In how long, in `least` or later, a flight comes to a corner of a formula that is none of its boundaries, s, as far as its present motion
    /// foretells.
    pub(crate) fn time_to_corner(&self, now: &StateRate, least: f64) -> f64 {
        if !self.has_switches {
            return f64::INFINITY;
        }
        let readings = self.readings(now.time, &now.state);
        let ahead = Switch::ALL.into_iter().flat_map(|switch| {
            let now = readings[switch as usize];
            self.corners(switch).iter().map(move |corner| (switch, *corner, (corner - now.re) / now.eps))
        });
        let later = ahead.filter(|(.., time)| *time >= least && time.is_finite());
        let Some((switch, corner, time)) = later.min_by(|a, b| a.2.total_cmp(&b.2)) else { return f64::INFINITY };
        // Once more from there, since the rates change on the way.
        let there = self.readings(now.time + time, &now.state.later(time))[switch as usize];
        let better = time + (corner - there.re) / there.eps;
        if (better - time).abs() < 0.5 * time { better } else { time }
    }

    /// Enters the mode of a state and of where it moves next.
    ///
    /// # Errors
    /// When there is none: on either side of a boundary the motion leads back across it.
    pub(crate) fn enter_mode_of(&mut self, time: f64, state: &State<f64>) -> Result<(), Chatter> {
        if !self.has_switches {
            return Ok(());
        }
        let mut turned = Switch::Atmosphere;
        // A switch may turn another one: the angle of attack that of its table.
        for _ in 0..=Switch::ALL.len() {
            let mode = self.mode_ahead(time, state);
            // The schedules come last, and first in what is said to switch.
            let turns = |switch: &Switch| mode.of(*switch) != self.mode.of(*switch);
            let Some(switch) = Switch::ALL.into_iter().rfind(turns) else { return Ok(()) };
            (turned, self.mode) = (switch, mode);
        }
        Err(Chatter(turned))
    }

    /// The mode to which the forces of the present one lead.
    fn mode_ahead(&self, time: f64, state: &State<f64>) -> ModelMode {
        let acceleration = self.acceleration(time, state);
        let moving = State {
            position: state.position.zip_map(&state.velocity, Dual64::new),
            velocity: state.velocity.zip_map(&acceleration, Dual64::new),
            mass: state.mass.map(|mass| Dual64::new(mass, self.mass_rate())),
            heat_load: None,
        };
        let readings = self.readings(Dual64::new(time, 1.0), &moving);
        ModelMode(Switch::ALL.map(|switch| {
            let Some((quantity, boundaries)) = self.boundaries(switch) else { return 0 };
            let now = readings[switch as usize];
            let resolution = quantity.resolution();
            // What stays at the end of a table is still in it.
            let leaves = now.eps > 0.0 || !switch.is_of_table();
            let ahead =
                now.re + if now.eps < 0.0 || !leaves && now.re > boundaries[0] { -resolution } else { resolution };
            boundaries.partition_point(|boundary| *boundary <= ahead)
        }))
    }
}
