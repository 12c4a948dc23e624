//! The question: what flies where, from which state, until when, and how exactly.

mod phase;

pub use phase::Phase;

use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt;

use num_dual::Dual2_64;

use crate::atmosphere::Atmosphere;
use crate::control::{Command, Control};
use crate::coordinates::PlanetFixed;
use crate::event::{Condition, Direction, Effect, Engine, Event, Quantity};
use crate::heating::{Heating, Stagnation};
use crate::motion::{Forces, Models, Parameters};
use crate::planet::{Gravity, Planet, Zonal};
use crate::propulsion::Axis;
use crate::vehicle::{Aerodynamics, Vehicle};
use crate::wind::Wind;

/// The values that a number may have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bound {
    /// The least value.
    pub minimum: f64,
    /// Whether the least value itself is left out.
    pub exclusive: bool,
    /// The greatest value.
    pub maximum: f64,
}

impl Bound {
    /// Every finite number.
    pub const FINITE: Self = Self::between(f64::MIN, f64::MAX);
    /// mass, scale height, ballistic coefficient.
    pub const POSITIVE: Self = Self::above(0.0, f64::MAX);
    /// reference area, density and its factor, drag coefficient, eccentricity.
    pub const NON_NEGATIVE: Self = Self::between(0.0, f64::MAX);
    /// Speeds, m/s.
    pub const SPEED: Self = Self::between(0.0, 1e6);
    /// Components of a velocity relative to the rotating planet, m/s.
    pub const VELOCITY: Self = Self::between(-1e6, 1e6);
    /// Coordinates and altitudes, m.
    pub const DISTANCE: Self = Self::between(-1e12, 1e12);
    /// Radii of planets, m.
    pub const PLANET_RADIUS: Self = Self::between(1.0, 1e12);
    /// Distances from the planet's centre, m.
    pub const RADIUS: Self = Self::above(0.0, 1e12);
    /// Latitudes and flight-path angles, rad.
    pub const QUARTER_TURN: Self = Self::between(-FRAC_PI_2, FRAC_PI_2);
    /// The inclination, rad.
    pub const HALF_TURN: Self = Self::between(0.0, PI);
    /// Every other angle, rad.
    pub const TURN: Self = Self::between(-TAU, TAU);
    /// Gravitational parameters, m³/s², from that of a boulder on; the Sun's is 1.3e20.
    pub const GRAVITATIONAL_PARAMETER: Self = Self::between(1e-6, 1e25);
    /// Rotation rates, rad/s.
    pub const ROTATION_RATE: Self = Self::between(-1.0, 1.0);
    /// Coefficients of zonal harmonics.
    pub const ZONAL_COEFFICIENT: Self = Self::between(-0.1, 0.1);
    /// Components of the wind, m/s.
    pub const WIND: Self = Self::between(-1e4, 1e4);
    /// The time at which a flight ends, s.
    pub const STOP_TIME: Self = Self::above(0.0, 1e9);
    /// Times since the start, s.
    pub const TIME: Self = Self::between(0.0, 1e9);
    /// Thrusts, N.
    pub const FORCE: Self = Self::between(-1e12, 1e12);
    /// Specific impulses, s; that of light is 3.1e7.
    pub const SPECIFIC_IMPULSE: Self = Self::between(1e-3, 1e9);
    /// Emissivities.
    pub const EMISSIVITY: Self = Self::above(0.0, 1.0);
    /// The relative tolerance of the integration.
    pub const RELATIVE_TOLERANCE: Self = Self::between(1e-14, 1e-3);

    const fn between(minimum: f64, maximum: f64) -> Self {
        Self { minimum, exclusive: false, maximum }
    }

    const fn above(minimum: f64, maximum: f64) -> Self {
        Self { minimum, exclusive: true, maximum }
    }

    /// Whether the value is one of them; no bound admits what is not finite.
    pub fn admits(&self, value: f64) -> bool {
        let above = if self.exclusive { value > self.minimum } else { value >= self.minimum };
        above && value <= self.maximum
    }

    /// The same bound for numbers in another unit, `scale` times as large.
    #[must_use]
    pub fn scaled(self, scale: f64) -> Self {
        Self { minimum: self.minimum * scale, maximum: self.maximum * scale, ..self }
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let unbounded = |limit: f64| limit.abs() >= f64::MAX;
        match (self.exclusive, unbounded(self.minimum), unbounded(self.maximum)) {
            (_, true, true) => write!(f, "finite"),
            (true, _, true) => write!(f, "greater than {}", self.minimum),
            (true, _, false) => write!(f, "greater than {} and at most {}", self.minimum, Plain(self.maximum)),
            (false, true, false) => write!(f, "at most {}", Plain(self.maximum)),
            (false, false, true) => write!(f, "at least {}", self.minimum),
            (false, false, false) => write!(f, "between {} and {}", Plain(self.minimum), Plain(self.maximum)),
        }
    }
}

/// A number as people write it: with an exponent where the digits would not fit.
pub(crate) struct Plain(pub(crate) f64);

impl fmt::Display for Plain {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let magnitude = self.0.abs();
        if !magnitude.is_finite() {
            write!(f, "more than any number")
        } else if magnitude != 0.0 && !(1e-4..1e7).contains(&magnitude) {
            write!(f, "{:e}", self.0)
        } else {
            write!(f, "{}", self.0)
        }
    }
}

/// When a flight ends: with the first of these.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// The altitude, m, along the radius vector, whose downward crossing ends the flight.
    pub altitude: f64,
    /// The time, s.
    pub time: f64,
    /// The altitude, m, along the radius vector, whose upward crossing ends the flight.
    pub ceiling: Option<f64>,
    /// Conditions, each of which ends the flight.
    pub when: Vec<Condition>,
}

impl Default for Stop {
    fn default() -> Self {
        Self { altitude: 0.0, time: 10_000.0, ceiling: None, when: Vec::new() }
    }
}

impl Stop {
    /// The ceiling, as a condition.
    pub fn ceiling(&self) -> Option<Condition> {
        let direction = Direction::Rising;
        self.ceiling.map(|value| Condition { quantity: Quantity::Altitude, value, direction })
    }
}

/// The equations to integrate.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Equations {
    /// Planet-fixed position and velocity: no singularities.
    #[default]
    Cartesian,
    /// The thesis's: singular at the poles, in vertical flight and at rest.
    Spherical,
}

/// How to integrate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Solver {
    /// The equations.
    pub equations: Equations,
    /// The error allowed in one step, relative to r₀ and √(g₀r₀) or to the state where that is larger.
    pub relative_tolerance: f64,
    /// The limit on accepted and rejected steps together.
    pub step_limit: usize,
}

impl Default for Solver {
    fn default() -> Self {
        Self { equations: Equations::default(), relative_tolerance: 1e-10, step_limit: 100_000 }
    }
}

/// The parts of a scenario, not yet checked.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// Where it flies.
    pub planet: Planet,
    /// The air.
    pub atmosphere: Atmosphere,
    /// By how much the air is denser than its model.
    pub density_factor: f64,
    /// How the air moves.
    pub wind: Wind,
    /// What flies.
    pub vehicle: Vehicle,
    /// How it is flown.
    pub control: Control,
    /// How it is heated, if that is wanted.
    pub heating: Option<Heating>,
    /// What happens on the way.
    pub events: Vec<Event>,
    /// The state at t = 0.
    pub initial_state: PlanetFixed<f64>,
    /// When it ends.
    pub stop: Stop,
    /// How to integrate.
    pub solver: Solver,
}

/// A sound case: one that exists can be flown.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    case: Case,
    on_stop_altitude: Option<Departure>,
}

/// Where a state on the stop altitude goes next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Departure {
    Rising,
    Sinking,
}

/// Something in a case that cannot be flown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A number out of its bounds.
    #[error("{field} must be {bound}, got {value}")]
    OutOfBounds {
        /// Its place in the [`Case`].
        field: Cow<'static, str>,
        /// The number.
        value: f64,
        /// What it may be.
        bound: Bound,
    },
    /// The planet is too flat or too long.
    #[error("must be between 0.1 and 10 times the equatorial radius of {equatorial_radius} m, got {polar_radius}")]
    OddShape {
        /// m.
        equatorial_radius: f64,
        /// m.
        polar_radius: f64,
    },
    /// The altitude that ends the flight lies at the planet's centre or beyond.
    #[error("must be greater than {minimum} m, the altitude of the planet's centre, got {altitude}")]
    StopBelowCentre {
        /// The stop altitude, m.
        altitude: f64,
        /// The altitude of the centre, m.
        minimum: f64,
    },
    /// The position is the planet's centre, or nearer than a millimetre.
    #[error("the position is the planet's centre, where gravity has no direction")]
    AtCentre,
    /// The position is too far away.
    #[error("the distance from the planet's centre must be at most {} m, got {}", Plain(Bound::RADIUS.maximum), Plain(*.distance))]
    TooFar {
        /// From the planet's centre, m.
        distance: f64,
    },
    /// The motion is too fast.
    #[error("the speed relative to the rotating planet must be at most {} m/s, got {}", Plain(Bound::SPEED.maximum), Plain(*.speed))]
    TooFast {
        /// Relative to the rotating planet, m/s.
        speed: f64,
    },
    /// The initial position lies below the altitude at which the flight would end.
    #[error("the initial altitude of {altitude} m lies below the stop altitude of {stop} m")]
    BelowStopAltitude {
        /// The initial altitude, m.
        altitude: f64,
        /// The stop altitude, m.
        stop: f64,
    },
    /// Something needs a Mach number under an atmosphere that has none.
    #[error("needs a Mach number, and with it an atmosphere that has a temperature: us76, or a table with one")]
    NoTemperature {
        /// What needs it: its place in the [`Case`].
        field: Cow<'static, str>,
    },
    /// Time never falls.
    #[error("is not for time, which never falls; use rises_through")]
    TimeFalls {
        /// The place of the condition in the [`Case`].
        field: String,
    },
    /// The ceiling lies on the stop altitude or below.
    #[error("must be greater than the stop altitude of {altitude} m, got {ceiling}")]
    LowCeiling {
        /// m.
        ceiling: f64,
        /// The stop altitude, m.
        altitude: f64,
    },
    /// Heating without a nose.
    #[error("is required: the heat flux at the stagnation point depends on it")]
    NoNoseRadius,
    /// The initial acceleration overflows.
    #[error("the initial acceleration is not a finite number")]
    InfiniteAcceleration,
}

/// Everything that is wrong with a case.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the case cannot be flown: {}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
pub struct ScenarioError(pub Vec<Fault>);

/// An altitude this near the stop altitude, m, counts as on it.
const ON_STOP_ALTITUDE: f64 = 1e-3;

impl Scenario {
    /// Checks a case.
    ///
    /// # Errors
    /// With every fault that was found.
    pub fn new(case: Case) -> Result<Self, ScenarioError> {
        let mut faults = out_of_bounds(&case);
        if !faults.is_empty() {
            return Err(ScenarioError(faults));
        }
        let state = &case.initial_state;
        let altitude = case.planet.shape.altitude(&state.position);
        faults.extend(planet_faults(&case.planet, &case.stop));
        faults.extend(state_faults(state));
        faults.extend(case.mach_faults());
        faults.extend(case.condition_faults());
        faults.extend((case.heating.is_some() && case.vehicle.nose_radius.is_none()).then_some(Fault::NoNoseRadius));
        if faults.is_empty() {
            if altitude < case.stop.altitude - ON_STOP_ALTITUDE {
                faults.push(Fault::BelowStopAltitude { altitude, stop: case.stop.altitude });
            }
            let loads = case.forces().loads(0.0, state);
            if !(loads.deceleration.is_finite() && loads.load_factor.is_finite()) {
                faults.push(Fault::InfiniteAcceleration);
            }
        }
        if !faults.is_empty() {
            return Err(ScenarioError(faults));
        }
        let on_stop_altitude = (altitude <= case.stop.altitude + ON_STOP_ALTITUDE).then(|| case.departure());
        Ok(Self { case, on_stop_altitude })
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The same flight at a finer tolerance within its bound: to a hundredth, a method of order 8 takes 1.8 times the steps.
    pub(crate) fn finer(&self, relative_tolerance: f64) -> Self {
        let step_limit = self.case.solver.step_limit.saturating_mul(2);
        let solver = Solver { relative_tolerance, step_limit, ..self.case.solver };
        Self { case: Case { solver, ..self.case.clone() }, ..*self }
    }

    /// Whether the flight starts on the stop altitude and leaves it upward.
    pub fn rises_from_stop_altitude(&self) -> bool {
        self.on_stop_altitude == Some(Departure::Rising)
    }

    /// Whether the flight ends where it starts: on the stop altitude, and not rising.
    pub fn ends_at_start(&self) -> bool {
        self.on_stop_altitude == Some(Departure::Sinking)
    }
}

impl Case {
    /// What acts on the vehicle at the start.
    pub fn forces(&self) -> Forces {
        let mut forces = Phase::first(self).forces(self);
        // Where no regime holds at the start, the flight says so.
        let _ = forces.settle(0.0, &self.initial_state);
        forces
    }

    /// The models at the start, as far as they hold no number of [`parameters`](Self::parameters).
    pub fn models(&self) -> Models {
        self.models_of(&self.vehicle)
    }

    /// The numbers that may vary, beside the state, at the start.
    pub fn parameters(&self) -> Parameters<f64> {
        self.parameters_of(&self.vehicle)
    }

    /// Whether anything may lift the vehicle, or push it across its way, so that near the vertical something fades out.
    pub(crate) fn may_lift(&self) -> bool {
        let effects = self.events.iter().map(|event| &event.then);
        self.vehicle.has_lift()
            || effects.clone().any(|effect| effect.aerodynamics.as_ref().is_some_and(Aerodynamics::has_lift))
            || effects.clone().any(|effect| effect.reference_area.is_some()) && self.vehicle.aerodynamics.has_lift()
            || effects
                .filter_map(|effect| effect.engine)
                .any(|engine| matches!(engine, Engine::On(thrust) if thrust.along == Axis::Normal))
    }

    /// Whether anything is watched on the way, beside the stop altitude and the formulas of the models.
    pub(crate) fn is_watched(&self) -> bool {
        !self.events.is_empty() || !self.stop.when.is_empty() || self.stop.ceiling.is_some()
    }

    /// The conditions that end the flight or let something happen, with their places in the case.
    fn conditions(&self) -> impl Iterator<Item = (String, &Condition)> {
        let events = self.events.iter().enumerate().map(|(index, event)| (format!("events.{index}.when"), &event.when));
        events.chain(self.stop.when.iter().enumerate().map(|(index, when)| (format!("stop.when.{index}"), when)))
    }

    /// The models, with a vehicle in place of that of the start.
    pub(crate) fn models_of(&self, vehicle: &Vehicle) -> Models {
        const NONE: Aerodynamics = Aerodynamics::Constant { lift_coefficient: 0.0, drag_coefficient: 0.0 };
        const NO_ANGLE: Command = Command::Constant(0.0);
        let atmosphere = match &self.atmosphere {
            Atmosphere::Exponential { scale_height, .. } => {
                Atmosphere::Exponential { surface_density: 1.0, scale_height: *scale_height }
            }
            other => other.clone(),
        };
        let aerodynamics = match &vehicle.aerodynamics {
            Aerodynamics::Constant { .. } | Aerodynamics::Ballistic { .. } => NONE,
            other => other.clone(),
        };
        let Control { bank_angle, angle_of_attack } = self.control.clone();
        let bank_angle = if matches!(bank_angle, Command::Constant(_)) { NO_ANGLE } else { bank_angle };
        Models {
            planet: self.planet,
            atmosphere,
            wind: self.wind.clone(),
            aerodynamics,
            control: Control { bank_angle, angle_of_attack },
            heating: self
                .heating
                .zip(vehicle.nose_radius)
                .map(|(heating, nose_radius)| Stagnation::new(heating, nose_radius)),
        }
    }

    /// The numbers that may vary, beside the state, with a vehicle in place of that of the start.
    pub(crate) fn parameters_of(&self, vehicle: &Vehicle) -> Parameters<f64> {
        let Vehicle { mass, reference_area, aerodynamics, .. } = vehicle;
        let [mass, reference_area, lift_coefficient, drag_coefficient] = match *aerodynamics {
            Aerodynamics::Constant { lift_coefficient, drag_coefficient } => {
                [*mass, *reference_area, lift_coefficient, drag_coefficient]
            }
            // The ratios are those of a vehicle of this mass with unit area and drag.
            Aerodynamics::Ballistic { ballistic_coefficient, lift_to_drag } => {
                [ballistic_coefficient, 1.0, lift_to_drag, 1.0]
            }
            Aerodynamics::MachTable(_) | Aerodynamics::AlphaMachTable(_) => [*mass, *reference_area, 0.0, 0.0],
        };
        let density = match self.atmosphere {
            Atmosphere::Exponential { surface_density, .. } => surface_density * self.density_factor,
            Atmosphere::Vacuum | Atmosphere::Us76 | Atmosphere::Layers(_) | Atmosphere::Table(_) => self.density_factor,
        };
        let bank_angle = match self.control.bank_angle {
            Command::Constant(angle) => angle,
            Command::Schedule(_) => 0.0,
        };
        Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle }
    }

    /// What needs a Mach number where there is none.
    fn mach_faults(&self) -> Vec<Fault> {
        if self.atmosphere.has_temperature() {
            return Vec::new();
        }
        let Control { bank_angle, angle_of_attack } = &self.control;
        let needs: [(Cow<'static, str>, bool); 3] = [
            ("vehicle.aerodynamics.type".into(), self.vehicle.aerodynamics.is_by_mach()),
            ("control.bank_angle.against".into(), bank_angle.is_by_mach()),
            ("control.angle_of_attack.against".into(), angle_of_attack.is_by_mach()),
        ];
        let conditions = self
            .conditions()
            .map(|(place, condition)| (format!("{place}.quantity").into(), condition.quantity == Quantity::Mach));
        let effects = self.events.iter().enumerate().map(|(index, event)| {
            let by_mach = event.then.aerodynamics.as_ref().is_some_and(Aerodynamics::is_by_mach);
            (format!("events.{index}.then.aerodynamics.type").into(), by_mach)
        });
        let needs = needs.into_iter().chain(conditions).chain(effects);
        needs.filter(|(_, needs)| *needs).map(|(field, _)| Fault::NoTemperature { field }).collect()
    }

    /// What is wrong with conditions, beyond their numbers.
    fn condition_faults(&self) -> Vec<Fault> {
        let falls =
            |condition: &Condition| condition.quantity == Quantity::Time && condition.direction == Direction::Falling;
        let falling = self.conditions().filter(|(_, condition)| falls(condition));
        let falling = falling.map(|(place, _)| Fault::TimeFalls { field: format!("{place}.falls_through") });
        let altitude = self.stop.altitude;
        let low = self.stop.ceiling.filter(|ceiling| *ceiling <= altitude);
        falling.chain(low.map(|ceiling| Fault::LowCeiling { ceiling, altitude })).collect()
    }

    /// Whether the altitude rises at first: its rate decides and, where the flight is level to rounding, its second derivative.
    fn departure(&self) -> Departure {
        let PlanetFixed { position, velocity } = &self.initial_state;
        let acceleration = self.forces().acceleration(0.0, &self.initial_state);
        let moving = nalgebra::Vector3::from_fn(|i, _| Dual2_64::new(position[i], velocity[i], acceleration[i]));
        let altitude = self.planet.shape.altitude(&moving);
        let level = 16.0 * f64::EPSILON * velocity.norm();
        let rate = if altitude.v1.abs() > level { altitude.v1 } else { altitude.v2 };
        if velocity.norm() > 0.0 && rate > 0.0 { Departure::Rising } else { Departure::Sinking }
    }
}

/// What is wrong with a planet, and with a stop altitude on it.
pub fn planet_faults(planet: &Planet, stop: &Stop) -> Vec<Fault> {
    let (equatorial_radius, polar_radius) = planet.shape.semi_axes();
    let ratio = polar_radius / equatorial_radius;
    let mut faults = Vec::new();
    if !(0.1..=10.0).contains(&ratio) {
        faults.push(Fault::OddShape { equatorial_radius, polar_radius });
    }
    let minimum = -equatorial_radius.min(polar_radius);
    if stop.altitude <= minimum {
        faults.push(Fault::StopBelowCentre { altitude: stop.altitude, minimum });
    }
    faults
}

/// What is wrong with a state by itself: it must be away from the centre, within the bounds of radius and speed.
pub fn state_faults(state: &PlanetFixed<f64>) -> Vec<Fault> {
    let (distance, speed) = (state.position.norm(), state.velocity.norm());
    // A norm may exceed the number from which its vector was made by a rounding.
    let within = |bound: Bound, norm: f64| norm <= bound.maximum * (1.0 + 1e-12);
    let mut faults = Vec::new();
    if distance < 1e-3 {
        faults.push(Fault::AtCentre);
    }
    if !within(Bound::RADIUS, distance) {
        faults.push(Fault::TooFar { distance });
    }
    if !within(Bound::SPEED, speed) {
        faults.push(Fault::TooFast { speed });
    }
    faults
}

fn out_of_bounds(case: &Case) -> Vec<Fault> {
    let Case { planet, atmosphere, density_factor, wind, vehicle, control, stop, solver, heating, .. } = case;
    let (equatorial_radius, polar_radius) = planet.shape.semi_axes();
    let mut checks: Vec<(&'static str, f64, Bound)> = vec![
        ("planet.gravitational_parameter", planet.gravitational_parameter, Bound::GRAVITATIONAL_PARAMETER),
        ("planet.equatorial_radius", equatorial_radius, Bound::PLANET_RADIUS),
        ("planet.polar_radius", polar_radius, Bound::PLANET_RADIUS),
        ("planet.rotation_rate", planet.rotation_rate, Bound::ROTATION_RATE),
        ("density_factor", *density_factor, Bound::NON_NEGATIVE),
        ("stop.altitude", stop.altitude, Bound::DISTANCE),
        ("stop.time", stop.time, Bound::STOP_TIME),
        ("solver.relative_tolerance", solver.relative_tolerance, Bound::RELATIVE_TOLERANCE),
    ];
    if let Gravity::Zonal(Zonal { coefficients: [j2, j3, j4] }) = planet.gravity {
        checks.extend([
            ("planet.gravity.j2", j2, Bound::ZONAL_COEFFICIENT),
            ("planet.gravity.j3", j3, Bound::ZONAL_COEFFICIENT),
            ("planet.gravity.j4", j4, Bound::ZONAL_COEFFICIENT),
        ]);
    }
    if let Atmosphere::Exponential { surface_density, scale_height } = *atmosphere {
        checks.extend([
            ("atmosphere.surface_density", surface_density, Bound::NON_NEGATIVE),
            ("atmosphere.scale_height", scale_height, Bound::POSITIVE),
        ]);
    }
    if let Wind::Constant { east, north } = *wind {
        checks.extend([("wind.east", east, Bound::WIND), ("wind.north", north, Bound::WIND)]);
    }
    checks.push(("vehicle.mass", vehicle.mass, Bound::POSITIVE));
    if !matches!(vehicle.aerodynamics, Aerodynamics::Ballistic { .. }) {
        checks.push(("vehicle.reference_area", vehicle.reference_area, Bound::NON_NEGATIVE));
    }
    checks.extend(vehicle.nose_radius.map(|radius| ("vehicle.nose_radius", radius, Bound::POSITIVE)));
    checks.extend(heating.map(|heating| ("heating.emissivity", heating.emissivity, Bound::EMISSIVITY)));
    checks.extend(stop.ceiling.map(|ceiling| ("stop.ceiling", ceiling, Bound::DISTANCE)));
    let commands = [("control.bank_angle", &control.bank_angle), ("control.angle_of_attack", &control.angle_of_attack)];
    checks.extend(commands.into_iter().filter_map(|(field, command)| match command {
        Command::Constant(angle) => Some((field, *angle, Bound::TURN)),
        Command::Schedule(_) => None,
    }));
    let fixed = checks.into_iter().map(|(field, value, bound)| (Cow::Borrowed(field), value, bound));
    let fixed = fixed.chain(coefficients("vehicle", &vehicle.aerodynamics));
    let conditions = case.conditions().map(|(place, Condition { quantity, value, .. })| {
        (Cow::Owned(format!("{place}.value")), *value, quantity.bound())
    });
    let effects = case.events.iter().enumerate().flat_map(|(index, event)| numbers(index, &event.then));
    let fault =
        |(field, value, bound): Check| (!bound.admits(value)).then_some(Fault::OutOfBounds { field, value, bound });
    fixed.chain(conditions).chain(effects).filter_map(fault).collect()
}

/// A number, with its place in the case and its bound.
type Check = (Cow<'static, str>, f64, Bound);

/// The coefficients that are numbers of their own.
fn coefficients(place: &str, aerodynamics: &Aerodynamics) -> Vec<Check> {
    let of = |name: &str, value: f64, bound: Bound| (Cow::Owned(format!("{place}.aerodynamics.{name}")), value, bound);
    match *aerodynamics {
        Aerodynamics::Constant { lift_coefficient, drag_coefficient } => vec![
            of("lift_coefficient", lift_coefficient, Bound::FINITE),
            of("drag_coefficient", drag_coefficient, Bound::NON_NEGATIVE),
        ],
        Aerodynamics::Ballistic { ballistic_coefficient, lift_to_drag } => vec![
            of("ballistic_coefficient", ballistic_coefficient, Bound::POSITIVE),
            of("lift_to_drag", lift_to_drag, Bound::FINITE),
        ],
        Aerodynamics::MachTable(_) | Aerodynamics::AlphaMachTable(_) => Vec::new(),
    }
}

/// The numbers of what an event changes.
fn numbers(index: usize, effect: &Effect) -> Vec<Check> {
    let of = |name: &str, value: f64, bound: Bound| (Cow::Owned(format!("events.{index}.then.{name}")), value, bound);
    let mut checks = Vec::new();
    checks.extend(effect.mass.map(|mass| of("mass", mass, Bound::POSITIVE)));
    checks.extend(effect.reference_area.map(|area| of("reference_area", area, Bound::NON_NEGATIVE)));
    checks.extend(effect.impulse.map(|impulse| of("impulse.speed_change", impulse.speed_change, Bound::VELOCITY)));
    if let Some(Engine::On(thrust)) = effect.engine {
        checks.push(of("engine.force", thrust.force, Bound::FORCE));
        checks.push(of("engine.specific_impulse", thrust.specific_impulse, Bound::SPECIFIC_IMPULSE));
        checks.extend(thrust.propellant.map(|mass| of("engine.propellant", mass, Bound::POSITIVE)));
    }
    let aerodynamics = effect.aerodynamics.iter();
    checks.extend(aerodynamics.flat_map(|aerodynamics| coefficients(&format!("events.{index}.then"), aerodynamics)));
    checks
}

impl Quantity {
    /// The values that it may pass.
    pub fn bound(self) -> Bound {
        match self {
            Self::Time => Bound::TIME,
            Self::Altitude => Bound::DISTANCE,
            Self::Speed => Bound::SPEED,
            Self::Mach | Self::DynamicPressure | Self::LoadFactor => Bound::NON_NEGATIVE,
            Self::FlightPathAngle => Bound::QUARTER_TURN,
        }
    }
}
