//! The mode of the piecewise models: of each the segment whose formula is in use.
//!
//! A step of the integration must not see such a change: an integrator that does grinds its steps down. While a step is taken, the
//! mode therefore stays what it is, and every formula goes on beyond its own segment; the flight looks for the instant at which it
//! leaves the segment, ends the step there, and [enters the next mode](super::Forces::enter_mode_of).

use std::cell::OnceCell;

use nalgebra::Vector3;
use num_dual::Dual64;

use super::{Flow, Forces, Local, State, StateRate};
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
    /// The pitch of a steering program, at the corners of its schedule.
    Pitch,
    /// The yaw or azimuth of a steering program, at the corners of its schedule.
    Yaw,
    /// The thrust, where the load factor comes to its limit.
    LoadLimit,
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
    /// Of the thrust over what the load limit leaves, over the mass, m/s².
    LoadExcess,
}

/// A set of switches.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct SwitchSet(u16);

/// Of every switch the segment of its formula that holds: 0 before the first boundary, 1 after it, and so on.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ModelMode([usize; Switch::ALL.len()]);

/// On either side of a boundary the motion leads back across it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Chatter(pub(crate) Switch);

impl Switch {
    /// All of them.
    pub(crate) const ALL: [Self; 10] = [
        Self::Atmosphere,
        Self::Wind,
        Self::Mach,
        Self::TableAngleOfAttack,
        Self::BankAngle,
        Self::AngleOfAttack,
        Self::Radiation,
        Self::Pitch,
        Self::Yaw,
        Self::LoadLimit,
    ];

    /// Whether it is the first and the last entry of a table.
    fn is_of_table(self) -> bool {
        matches!(self, Self::Wind | Self::Mach | Self::TableAngleOfAttack)
    }
}

impl SwitchSet {
    /// Those of which a condition holds.
    pub(super) fn of(holds: impl Fn(Switch) -> bool) -> Self {
        Switch::ALL.into_iter().filter(|switch| holds(*switch)).fold(Self::default(), Self::with)
    }

    /// The same with one more.
    #[must_use]
    pub(super) fn with(self, switch: Switch) -> Self {
        Self(self.0 | 1 << switch as u16)
    }

    /// Whether there are none.
    pub(crate) fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// One by one, in the order of [`Switch::ALL`].
    pub(crate) fn iter(self) -> impl DoubleEndedIterator<Item = Switch> {
        Switch::ALL.into_iter().filter(move |switch| self.0 & 1 << *switch as u16 != 0)
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
    /// error, and far less than matters; s, m, m/s, a Mach number, J/kg or rad.
    pub(crate) fn resolution(self) -> f64 {
        match self {
            Self::Along(Against::Time | Against::Since(_) | Against::Mach) | Self::AngleOfAttack | Self::LoadExcess => {
                1e-9
            }
            Self::Along(Against::Altitude | Against::Speed) | Self::AirSpeed => 1e-6,
            // Those of a speed of 1000 m/s and an altitude.
            Self::Along(Against::Energy) => 1e-3,
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
        !self.switches.is_empty()
    }

    /// The switches that the models have.
    pub(crate) fn switches(&self) -> SwitchSet {
        self.switches
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
            Switch::Pitch => self.models.steering.commands().and_then(|[pitch, _]| pitch.corners()).map(along),
            Switch::Yaw => self.models.steering.commands().and_then(|[_, yaw]| yaw.corners()).map(along),
            Switch::LoadLimit => {
                let is_limited = self.burn.as_ref().is_some_and(|burn| burn.load_limit.is_some());
                is_limited.then_some((SwitchQuantity::LoadExcess, &[0.0][..]))
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
        self.readings_with(time, state, &OnceCell::new())
    }

    /// The same with the air that meets the vehicle, and its Mach number, which is made where something asks for it.
    pub(crate) fn readings_with<S: Over<P>>(
        &self,
        time: S,
        state: &State<S>,
        flow: &OnceCell<Flow<S>>,
    ) -> [S; Switch::ALL.len()] {
        let mut readings = [S::zero(); Switch::ALL.len()];
        let without_mach = OnceCell::new();
        for switch in self.switches.iter() {
            if let Some((quantity, _)) = self.boundaries(switch) {
                let clock = self.clock(switch, time);
                readings[switch as usize] = self.quantity_of(quantity, clock, time, state, [flow, &without_mach]);
            }
        }
        readings
    }

    /// The quantity of one switch in a state; zero where there is none.
    pub(crate) fn reading<S: Over<P>>(&self, switch: Switch, time: S, state: &State<S>) -> S {
        let flows = [&OnceCell::new(), &OnceCell::new()];
        let of = |(quantity, _)| self.quantity_of(quantity, self.clock(switch, time), time, state, flows);
        self.boundaries(switch).map_or(S::zero(), of)
    }

    /// The air that meets the vehicle, as far as angles and coefficients depend on it: without its density, where that takes a look-up of its own.
    pub(super) fn flow_where_mach_matters<S: Over<P>>(&self, time: S, state: &State<S>) -> Flow<S> {
        if self.by_mach {
            return self.flow::<false, _>(time, state);
        }
        let altitude = self.models.planet.shape.altitude(&state.position);
        let potential = self.potential_where_asked(|| state.position);
        self.flow_in::<false, _>(time, altitude, Local { air: None, potential }, state)
    }

    /// A quantity in a state, at a time, s, and by a clock that may lag behind it. The air that meets the vehicle is made for what asks for more
    /// than time and place: with its Mach number, and without where that does not matter.
    fn quantity_of<S: Over<P>>(
        &self,
        quantity: SwitchQuantity,
        clock: S,
        time: S,
        state: &State<S>,
        [with_mach, without]: [&OnceCell<Flow<S>>; 2],
    ) -> S {
        let with_mach = || with_mach.get_or_init(|| self.flow_with_mach(time, state));
        let flow = || {
            if self.by_mach {
                return with_mach();
            }
            without.get_or_init(|| self.flow_where_mach_matters(time, state))
        };
        match quantity {
            SwitchQuantity::Along(Against::Time) => clock,
            SwitchQuantity::Along(Against::Altitude) => self.models.planet.shape.altitude(&state.position),
            SwitchQuantity::Along(against) => flow().arguments.quantity(against, clock),
            SwitchQuantity::AngleOfAttack => self.angle_of_attack(time, flow()),
            SwitchQuantity::AirSpeed => flow().directions.speed,
            // It needs the density of the air.
            SwitchQuantity::LoadExcess => self.load_excess(time, state, with_mach()),
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

    /// Whether the air may make a load turn more than once in a step, as [`has_tables`](Self::has_tables) says, where the vehicle now is.
    pub(crate) fn has_uneven_air(&self) -> bool {
        [Switch::Atmosphere, Switch::Wind].into_iter().any(|switch| self.is_between_corners(switch))
    }

    /// The same of the coefficients.
    pub(crate) fn has_uneven_coefficients(&self) -> bool {
        [Switch::Mach, Switch::TableAngleOfAttack].into_iter().any(|switch| self.is_between_corners(switch))
            || self.canopies.as_ref().is_some_and(|canopies| !canopies.filling.is_empty())
    }

    /// Whether the present segment of a table has entries inside.
    fn is_between_corners(&self, switch: Switch) -> bool {
        // The segments of a table are below, within and above its range.
        self.mode.of(switch) == 1 && !self.corners(switch).is_empty()
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
        let turning = self.switches.iter().filter_map(|switch| Some((switch, distance(&switch)?)));
        turning.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(switch, _)| switch)
    }

    /// The boundary that a switch crosses first on the way from the present mode to another; none where it does not turn.
    pub(crate) fn boundary_towards(&self, switch: Switch, next: ModelMode) -> Option<f64> {
        let (_, boundaries) = self.boundaries(switch)?;
        let (now, then) = (self.mode.of(switch), next.of(switch));
        let boundary = boundaries.get(if then > now { now } else { now.checked_sub(1)? })?;
        (now != then).then_some(*boundary)
    }

    /// The time to the next corner of a formula that is not one of its boundaries, and not nearer than `least`, s, as the present motion has it.
    pub(crate) fn time_to_corner(&self, now: &StateRate, least: f64) -> f64 {
        if self.switches.iter().all(|switch| self.corners(switch).is_empty()) {
            return f64::INFINITY;
        }
        let readings = self.readings(now.time, &now.state);
        let ahead = self.switches.iter().flat_map(|switch| {
            let now = readings[switch as usize];
            self.corners(switch).iter().map(move |corner| (switch, *corner, (corner - now.re) / now.eps))
        });
        let later = ahead.filter(|(.., time)| *time >= least && time.is_finite());
        let Some((switch, corner, time)) = later.min_by(|a, b| a.2.total_cmp(&b.2)) else { return f64::INFINITY };
        // Once more from there, since the rates change on the way.
        let there = self.reading(switch, now.time + time, &now.state.later(time));
        let better = time + (corner - there.re) / there.eps;
        if (better - time).abs() < 0.5 * time { better } else { time }
    }

    /// Enters the mode of a state and of where it moves next.
    ///
    /// # Errors
    /// When there is none: on either side of a boundary the motion leads back across it.
    pub(crate) fn enter_mode_of(&mut self, time: f64, state: &State<f64>) -> Result<(), Chatter> {
        if self.switches.is_empty() {
            return Ok(());
        }
        let mut turned = Switch::Atmosphere;
        // A switch may turn another one: the angle of attack that of its table.
        for _ in 0..=Switch::ALL.len() {
            let mode = self.mode_ahead(time, state);
            // The schedules come last, and first in what is said to switch.
            let turns = |switch: &Switch| mode.of(*switch) != self.mode.of(*switch);
            let Some(switch) = self.switches.iter().rfind(turns) else { return Ok(()) };
            (turned, self.mode) = (switch, mode);
        }
        Err(Chatter(turned))
    }

    /// The mode to which the forces of the present one lead.
    fn mode_ahead(&self, time: f64, state: &State<f64>) -> ModelMode {
        let by_place = |switch| {
            matches!(
                self.boundaries(switch),
                None | Some((SwitchQuantity::Along(Against::Time | Against::Altitude), _))
            )
        };
        // Altitudes move with the velocity, whatever the forces are.
        let (acceleration, mass_rate) = if self.switches.iter().all(by_place) {
            (Vector3::zeros(), 0.0)
        } else {
            let (acceleration, mass_rate, _) = self.acceleration_and_rates(time, state);
            (acceleration, mass_rate)
        };
        let moving = State {
            position: state.position.zip_map(&state.velocity, Dual64::new),
            velocity: state.velocity.zip_map(&acceleration, Dual64::new),
            mass: state.mass.map(|mass| Dual64::new(mass, mass_rate)),
            heat_load: None,
        };
        let readings = self.readings(Dual64::new(time, 1.0), &moving);
        let mut mode = ModelMode::default();
        for switch in self.switches.iter() {
            let Some((quantity, boundaries)) = self.boundaries(switch) else { continue };
            let now = readings[switch as usize];
            let resolution = quantity.resolution();
            // What stays at the end of a table is still in it.
            let leaves = now.eps > 0.0 || !switch.is_of_table();
            let ahead =
                now.re + if now.eps < 0.0 || !leaves && now.re > boundaries[0] { -resolution } else { resolution };
            mode.0[switch as usize] = boundaries.partition_point(|boundary| *boundary <= ahead);
        }
        mode
    }
}
