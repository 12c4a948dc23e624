//! The values that the numbers of a case may have.

use std::borrow::Cow;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fmt;

use super::{Case, Fault};
use crate::atmosphere::Atmosphere;
use crate::control::Command;
use crate::event::{Condition, Effect, Quantity, Throttle, ThrustCommand, Tilt, Trigger};
use crate::heating::{Convective, Heating};
use crate::number_text::{NumberText, apart};
use crate::parachute::Parachute;
use crate::part::{Engine, Part, ThrustEntry, ThrustProfile};
use crate::planet::{Gravity, Zonal};
use crate::steering::{Program, Steering};
use crate::vehicle::Aerodynamics;
use crate::wind::Wind;

/// The range of a number: the least and the greatest value that it may have.
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
    /// Lengths, m.
    pub const NON_NEGATIVE_DISTANCE: Self = Self::between(0.0, 1e12);
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
    /// Speeds of the wind, m/s.
    pub const WIND_SPEED: Self = Self::between(0.0, 1e4);
    /// Molar masses, kg/mol; in g/mol, that of hydrogen atoms is greater.
    pub const MOLAR_MASS: Self = Self::between(1e-6, 1.0);
    /// Ratios of heat capacities; 5/3 for atoms alone.
    pub const HEAT_CAPACITY_RATIO: Self = Self::between(1.0, 2.0);
    /// The time at which a flight ends, s.
    pub const STOP_TIME: Self = Self::above(0.0, 1e9);
    /// Drag areas of parachutes, m².
    pub const DRAG_AREA: Self = Self::between(0.0, 1e9);
    /// Times since the start, and spans of time, s.
    pub const TIME: Self = Self::between(0.0, 1e9);
    /// Seconds since the inertial and the planet-fixed frame were aligned.
    pub const SIDEREAL_TIME: Self = Self::between(-1e9, 1e9);
    /// Thrusts, N.
    pub const FORCE: Self = Self::between(-1e12, 1e12);
    /// Thrusts of engines, N.
    pub const THRUST: Self = Self::between(0.0, 1e12);
    /// Shares of a whole.
    pub const SHARE: Self = Self::between(0.0, 1.0);
    /// Load factors that throttle engines.
    pub const LOAD_LIMIT: Self = Self::above(0.0, 1e6);
    /// How many there are of a part.
    pub const COUNT: Self = Self::between(1.0, 1e6);
    /// Specific impulses, s; that of light is 3.1e7.
    pub const SPECIFIC_IMPULSE: Self = Self::between(1e-3, 1e9);
    /// Solar fluxes F10.7, solar flux units: observed ones are from 63 to 380, and the model has no sense far from them.
    pub const SOLAR_FLUX: Self = Self::between(50.0, 500.0);
    /// Indices ap of the geomagnetic activity, whose scale ends at 400.
    pub const GEOMAGNETIC_AP: Self = Self::between(0.0, 400.0);
    /// Emissivities.
    pub const EMISSIVITY: Self = Self::above(0.0, 1.0);
    /// The relative tolerance of the integration.
    pub const RELATIVE_TOLERANCE: Self = Self::between(1e-14, 1e-3);
    /// Of how far a number scatters, in its unit: up to that of the greatest numbers, of which the squares are numbers still.
    pub const STANDARD_DEVIATION: Self = Self::between(0.0, 1e25);
    /// Of what is added to a number, or multiplies it, in the mean.
    pub const MEAN: Self = Self::between(-1e25, 1e25);
    /// Of two numbers that scatter.
    pub const COVARIANCE: Self = Self::between(-1e50, 1e50);

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

    /// The refusal of a value out of bounds, with as many digits as show that it is.
    pub fn refusal(&self, value: f64) -> String {
        let [minimum, maximum, value] = apart([self.minimum, self.maximum, value]);
        format!("must be {}, got {value}", self.between_texts(&minimum, &maximum))
    }

    fn between_texts(&self, minimum: &str, maximum: &str) -> String {
        let unbounded = |limit: f64| limit.abs() >= f64::MAX;
        match (self.exclusive, unbounded(self.minimum), unbounded(self.maximum)) {
            (_, true, true) => "finite".to_owned(),
            (true, _, true) => format!("greater than {minimum}"),
            (true, _, false) => format!("greater than {minimum} and at most {maximum}"),
            (false, true, false) => format!("at most {maximum}"),
            (false, false, true) => format!("at least {minimum}"),
            (false, false, false) => format!("between {minimum} and {maximum}"),
        }
    }
}

impl fmt::Display for Bound {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.between_texts(&NumberText(self.minimum).to_string(), &NumberText(self.maximum).to_string()))
    }
}

/// The numbers of a case that are out of their bounds.
pub(super) fn out_of_bounds(case: &Case) -> Vec<Fault> {
    let Case { planet, atmosphere, density_factor, wind, vehicle, control, stop, solver, heating, .. } = case;
    let (equatorial_radius, polar_radius) = planet.shape.semi_axes();
    let mut checks: Vec<(&'static str, f64, Bound)> = vec![
        ("planet.gravitational_parameter", planet.gravitational_parameter, Bound::GRAVITATIONAL_PARAMETER),
        ("planet.equatorial_radius", equatorial_radius, Bound::PLANET_RADIUS),
        ("planet.polar_radius", polar_radius, Bound::PLANET_RADIUS),
        ("planet.rotation_rate", planet.rotation_rate, Bound::ROTATION_RATE),
        ("density_factor", *density_factor, Bound::NON_NEGATIVE),
        ("start_time", case.start_time, Bound::TIME),
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
    if let Some(Heating { convective: Convective::SuttonGraves { constant }, .. }) = *heating {
        checks.push(("heating.convective.constant", constant, Bound::POSITIVE));
    }
    checks.extend(stop.ceiling.map(|ceiling| ("stop.ceiling", ceiling, Bound::DISTANCE)));
    let commands = [("control.bank_angle", &control.bank_angle), ("control.angle_of_attack", &control.angle_of_attack)];
    checks.extend(commands.into_iter().filter_map(|(field, command)| match command {
        Command::Constant(angle) => Some((field, *angle, Bound::TURN)),
        Command::Schedule(_) => None,
    }));
    let fixed = checks.into_iter().map(|(field, value, bound)| (Cow::Borrowed(field), value, bound));
    let fixed = fixed.chain(coefficients("vehicle", &vehicle.aerodynamics));
    let parts = case.parts.iter().enumerate().flat_map(|(index, part)| part_numbers(index, part));
    let fixed = fixed.chain(parts).chain(steering("control.steering", &case.steering));
    let triggers = case.triggers().map(|(place, trigger)| match *trigger {
        Trigger::Condition(Condition { quantity, value, .. }) => {
            (Cow::Owned(format!("{place}.value")), value, quantity.bound())
        }
        Trigger::After { delay, .. } | Trigger::AfterBurnout { delay, .. } => {
            (Cow::Owned(format!("{place}.delay")), delay, Bound::TIME)
        }
    });
    let effects = case.events.iter().enumerate().flat_map(|(index, event)| numbers(index, &event.then));
    let fault =
        |(field, value, bound): Check| (!bound.admits(value)).then_some(Fault::OutOfBounds { field, value, bound });
    fixed.chain(triggers).chain(effects).filter_map(fault).collect()
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
    if let Some(ThrustCommand::On(thrust)) = effect.thrust {
        checks.push(of("thrust.force", thrust.force, Bound::FORCE));
        let specific_impulse = thrust.specific_impulse.into_iter();
        checks.extend(specific_impulse.map(|it| of("thrust.specific_impulse", it, Bound::SPECIFIC_IMPULSE)));
        checks.extend(thrust.propellant.map(|mass| of("thrust.propellant", mass, Bound::POSITIVE)));
    }
    if let Some(Parachute { drag_area, inflation_time, delay }) = effect.deploy {
        checks.push(of("deploy.drag_area", drag_area, Bound::DRAG_AREA));
        checks.push(of("deploy.inflation_time", inflation_time, Bound::TIME));
        checks.push(of("deploy.delay", delay, Bound::TIME));
    }
    for (place, Throttle { value, .. }) in effect.throttle.iter().enumerate() {
        checks.push(of(&format!("throttle.{place}"), *value, Bound::SHARE));
    }
    checks.extend(effect.load_limit.flatten().map(|limit| of("load_limit", limit, Bound::LOAD_LIMIT)));
    if let Some(Tilt { angle, azimuth }) = effect.tilt {
        checks.push(of("tilt.angle", angle, Bound::TURN));
        checks.push(of("tilt.azimuth", azimuth, Bound::TURN));
    }
    for (place, separation) in effect.separate.iter().enumerate() {
        let push = separation.push.map(|push| push.speed_change);
        checks.extend(push.map(|push| of(&format!("separate.{place}.push.speed_change"), push, Bound::VELOCITY)));
    }
    checks.extend(effect.steer.iter().flat_map(|steer| steering(&format!("events.{index}.then.steer"), steer)));
    let aerodynamics = effect.aerodynamics.iter();
    checks.extend(aerodynamics.flat_map(|aerodynamics| coefficients(&format!("events.{index}.then"), aerodynamics)));
    checks
}

/// The numbers of a part.
fn part_numbers(index: usize, part: &Part) -> Vec<Check> {
    let of = |name: &str, value: f64, bound: Bound| (Cow::Owned(format!("vehicle.parts.{index}.{name}")), value, bound);
    let Part { count, dry_mass, propellant, engine } = part;
    let mut checks = vec![
        of("count", f64::from(*count), Bound::COUNT),
        of("dry_mass", *dry_mass, Bound::NON_NEGATIVE),
        of("propellant", *propellant, Bound::NON_NEGATIVE),
    ];
    if let Some(Engine { thrust, specific_impulse, exit_area }) = engine {
        checks.push(of("engine.specific_impulse", *specific_impulse, Bound::SPECIFIC_IMPULSE));
        checks.push(of("engine.exit_area", *exit_area, Bound::NON_NEGATIVE));
        match thrust {
            ThrustProfile::Constant(thrust) => checks.push(of("engine.thrust.vacuum", *thrust, Bound::THRUST)),
            ThrustProfile::Table(entries) => {
                for (place, ThrustEntry { time, thrust }) in entries.iter().enumerate() {
                    checks.push(of(&format!("engine.thrust.time.{place}"), *time, Bound::TIME));
                    checks.push(of(&format!("engine.thrust.vacuum.{place}"), *thrust, Bound::THRUST));
                }
            }
        }
    }
    checks
}

/// The numbers of a steering that are no tables.
fn steering(place: &str, steering: &Steering) -> Vec<Check> {
    let of = |name: &str, value: f64, bound: Bound| (Cow::Owned(format!("{place}.{name}")), value, bound);
    match steering {
        Steering::Vertical | Steering::Velocity => Vec::new(),
        Steering::Program(Program { pitch, yaw, .. }) => {
            let commands = [("pitch", pitch), ("yaw", yaw)].into_iter();
            let numbers = commands.filter_map(|(name, command)| match command {
                Command::Constant(angle) => Some(of(name, *angle, Bound::TURN)),
                Command::Schedule(_) => None,
            });
            numbers.collect()
        }
        Steering::LinearTangent { a, b, .. } => vec![of("a", *a, Bound::FINITE), of("b", *b, Bound::FINITE)],
    }
}

impl Quantity {
    /// The values that it may pass.
    pub fn bound(self) -> Bound {
        match self {
            Self::Time => Bound::TIME,
            Self::Altitude | Self::ApoapsisAltitude | Self::PeriapsisAltitude | Self::Downrange => Bound::DISTANCE,
            Self::Speed | Self::AirSpeed | Self::InertialSpeed => Bound::SPEED,
            Self::Mach
            | Self::DynamicPressure
            | Self::LoadFactor
            | Self::Mass
            | Self::Eccentricity
            | Self::HeatFlux
            | Self::HeatLoad
            | Self::WallTemperature
            | Self::Density => Bound::NON_NEGATIVE,
            Self::FlightPathAngle => Bound::QUARTER_TURN,
            Self::Inclination => Bound::HALF_TURN,
            Self::GroundRange => Bound::NON_NEGATIVE_DISTANCE,
            Self::SpecificEnergy | Self::Deceleration | Self::UpwardAcceleration => Bound::FINITE,
        }
    }
}
