//! A case (vehicle, initial state, environment, events, stop conditions, solver), and the check that it can be flown.

mod bounds;
mod dispatch;
mod numbers;
mod parts;
mod phase;

pub use bounds::Bound;

pub(crate) use dispatch::{ForFormulation, FormulationIn, StateLayout, dispatch};
pub(crate) use numbers::Numbers;
pub(crate) use phase::{Change, Phase};

use bounds::out_of_bounds;

use std::borrow::Cow;
use std::sync::Arc;

use nalgebra::Vector3;

use crate::atmosphere::Atmosphere;
use crate::control::{Against, Command, Control};
use crate::coordinates::{GreatCircle, PlanetFixed};
use crate::event::{Condition, Direction, Event, Quantity, ThrustCommand, Trigger};
use crate::heating::{Heating, Stagnation};
use crate::motion::{Forces, Models, Parameters, State};
use crate::number_text::apart;
use crate::part::Part;
use crate::planet::Planet;
use crate::scalar::Scalar;
use crate::steering::Steering;
use crate::vehicle::{Aerodynamics, Vehicle};
use crate::wind::Wind;

/// The conditions that end a flight, whichever is met first.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// The altitude, m, along the radius vector, whose downward crossing ends the flight.
    pub altitude: f64,
    /// The time, s.
    pub time: f64,
    /// The altitude, m, along the radius vector, whose upward crossing ends the flight.
    pub ceiling: Option<f64>,
    /// Further conditions, each of which ends the flight.
    pub when: Vec<Trigger>,
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

/// The settings of the integration.
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

/// A case to simulate, not yet checked: see [`Scenario::new`].
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The planet: gravity, shape and rotation.
    pub planet: Planet,
    /// The model of the atmosphere.
    pub atmosphere: Atmosphere,
    /// The density of the air over that of its model.
    pub density_factor: f64,
    /// The velocity of the air relative to the planet.
    pub wind: Wind,
    /// Mass, reference area, aerodynamics and nose radius.
    pub vehicle: Vehicle,
    /// The parts, if the vehicle is made of any: its mass is theirs then.
    pub parts: Vec<Part>,
    /// Bank angle and angle of attack.
    pub control: Control,
    /// Where the axis of a vehicle with parts points.
    pub steering: Steering,
    /// The correlations of the heating; none where no heat flux is wanted.
    pub heating: Option<Heating>,
    /// The events, in the order of the request; each happens at most once.
    pub events: Vec<Event>,
    /// The time at which the flight starts, s: 0, or that at which a body is set free by another, whose clock it shares. At t = 0 lie the origin of
    /// schedules by time, and the directions that stay in inertial space.
    pub start_time: f64,
    /// The state at the start.
    pub initial_state: PlanetFixed<f64>,
    /// Whether the vehicle is held where it starts, at rest, until an event lets it lift off.
    pub hold_down: bool,
    /// The place from which ranges are measured, and the direction in which they grow as a velocity of any size; none where both are those of
    /// the initial state.
    pub origin: Option<PlanetFixed<f64>>,
    /// The conditions that end the flight.
    pub stop: Stop,
    /// The settings of the integration.
    pub solver: Solver,
    /// Those that separations set free. Of each the parts, the initial state and the start are those of the separation.
    pub bodies: Vec<BodyCase>,
}

/// The case of what leaves a vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct BodyCase {
    /// The case, as if it began with that of the vehicle.
    pub case: Case,
    /// When the flight ends at the latest, s, on the clock of the vehicle; none for [`BodyCase::TIME`] after the separation.
    pub stop_time: Option<f64>,
}

impl BodyCase {
    /// How long a body flies at the most, where nothing else is said, s.
    pub const TIME: f64 = 10_000.0;
}

/// The most bodies that a flight may set free, those that they set free themselves included.
pub const MOST_BODIES: usize = 64;

/// A case that was checked, and can be flown.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenario {
    /// Shared with the flights of the scenario.
    case: Arc<Case>,
    starts_on_stop_altitude: bool,
}

/// A reason for which a case cannot be flown.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Fault {
    /// A number out of its bounds.
    #[error("{field} {}", .bound.refusal(*.value))]
    OutOfBounds {
        /// Its place in the [`Case`].
        field: Cow<'static, str>,
        /// The number.
        value: f64,
        /// The values that it may have.
        bound: Bound,
    },
    /// The planet is too flat or too long.
    #[error("{}", odd_shape(*.equatorial_radius, *.polar_radius))]
    OddShape {
        /// m.
        equatorial_radius: f64,
        /// m.
        polar_radius: f64,
    },
    /// The altitude that ends the flight lies at the planet's centre or beyond.
    #[error("must be greater than {}", apart([*.minimum, *.altitude]).join(" m, the altitude of the planet's centre, got "))]
    StopBelowCentre {
        /// The stop altitude, m.
        altitude: f64,
        /// The altitude of the centre, m.
        minimum: f64,
    },
    /// The position is the planet's centre, or nearer than a millimetre.
    #[error("position must not be the planet's centre, where gravity has no direction")]
    AtCentre,
    /// The position is too far away.
    #[error("distance from the planet's centre must be at most {}", apart([Bound::RADIUS.maximum, *.distance]).join(" m, got "))]
    TooFar {
        /// From the planet's centre, m.
        distance: f64,
    },
    /// The motion is too fast.
    #[error("speed relative to the rotating planet must be at most {}", apart([Bound::SPEED.maximum, *.speed]).join(" m/s, got "))]
    TooFast {
        /// Relative to the rotating planet, m/s.
        speed: f64,
    },
    /// The initial position lies below the altitude at which the flight would end.
    #[error("initial altitude is below the stop altitude: {}", apart([*.altitude, *.stop]).join(" m is less than ") + " m")]
    BelowStopAltitude {
        /// The initial altitude, m.
        altitude: f64,
        /// The stop altitude, m.
        stop: f64,
    },
    /// Something needs a Mach number under an atmosphere that has none.
    #[error(
        "requires a Mach number: the atmosphere must be standard, us76 or nrlmsise00, or a table with temperature or speed_of_sound"
    )]
    NoTemperature {
        /// What needs it: its place in the [`Case`].
        field: Cow<'static, str>,
    },
    /// Time never falls.
    #[error("must not be given for time, which never falls; use rises_through")]
    TimeFalls {
        /// The place of the condition in the [`Case`].
        field: String,
    },
    /// Propellant for a thrust that burns none.
    #[error("must be omitted: without a specific impulse the thrust consumes no propellant")]
    PropellantUnused {
        /// Its place in the [`Case`].
        field: String,
    },
    /// A parachute that is never deployed.
    #[error("must be the index of an event that deploys a parachute, got {event}")]
    NoParachute {
        /// Its place in the [`Case`].
        field: String,
        /// The number given.
        event: usize,
    },
    /// The ceiling lies on the stop altitude or below.
    #[error("must be greater than the stop altitude, {}", apart([*.altitude, *.ceiling]).join(" m, got "))]
    LowCeiling {
        /// m.
        ceiling: f64,
        /// The stop altitude, m.
        altitude: f64,
    },
    /// A condition on the heating where none is asked for.
    #[error("requires heating, which the case does not have")]
    NoHeating {
        /// The place of the condition in the [`Case`].
        field: String,
    },
    /// A condition on the downrange of a flight that starts vertically or at rest.
    #[error(
        "requires an initial heading, which a flight that starts vertically or at rest does not have; use \
         ground_range"
    )]
    NoHeading {
        /// The place of the condition in the [`Case`].
        field: String,
    },
    /// Something waits for an event that is not there.
    #[error("must be the name of an event of the case")]
    NoSuchEvent {
        /// Its place in the [`Case`].
        field: String,
    },
    /// Something waits for an event that never happens.
    #[error("must not be an event that waits for itself, directly or through others: it would never happen")]
    NeverHappens {
        /// Its place in the [`Case`].
        field: String,
    },
    /// Something names a part without an engine, or one that is not there.
    #[error("must be the name of a part with an engine")]
    NoSuchEngine {
        /// Its place in the [`Case`].
        field: String,
    },
    /// Something names a part that is not there.
    #[error("must be the name of a part")]
    NoSuchPart {
        /// Its place in the [`Case`].
        field: String,
    },
    /// A part that is separated twice.
    #[error("must be a part that is separated once: event {event} separates it")]
    SeparatedTwice {
        /// Its place in the [`Case`].
        field: String,
        /// The place of the other event in the list.
        event: usize,
    },
    /// An engine that is lit more often than it is shut down.
    #[error("must be a part that is not lit: event {event} lights it, and no event shuts it down")]
    LitTwice {
        /// Its place in the [`Case`].
        field: String,
        /// The place of the other event in the list.
        event: usize,
    },
    /// Propellant without an engine.
    #[error("must be 0: the part has no engine to burn it")]
    PropellantWithoutEngine {
        /// Its place in the [`Case`].
        field: String,
    },
    /// A part that weighs nothing.
    #[error("must be greater than 0: the part has no propellant, and would have no mass")]
    PartWithoutMass {
        /// Its place in the [`Case`].
        field: String,
    },
    /// Events separate every part.
    #[error("must leave a part to the vehicle: with these, events separate all of them")]
    NothingRemains {
        /// Its place in the [`Case`].
        field: String,
    },
    /// Thrust entries that do not ascend from 0, or less than two.
    #[error("must be two numbers or more, ascending from 0 s")]
    ThrustTimes {
        /// Its place in the [`Case`].
        field: String,
    },
    /// An engine whose thrust depends on the pressure of the air, under an atmosphere that has none.
    #[error(
        "requires the pressure of the air: the atmosphere must be standard, us76 or nrlmsise00, or a table with pressure"
    )]
    NoPressure {
        /// Its place in the [`Case`].
        field: String,
    },
    /// Parts under the thesis's equations.
    #[error(
        "must be cartesian for a vehicle with parts: the spherical equations are singular in vertical flight and at rest"
    )]
    SphericalParts,
    /// A mass or a thrust that the parts already say.
    #[error("must be omitted: the parts of the vehicle define its mass and its engines")]
    SaidByParts {
        /// Its place in the [`Case`].
        field: String,
    },
    /// More bodies than a flight may set free.
    #[error("must separate at most {MOST_BODIES} bodies in all, with those that separate from bodies")]
    TooManyBodies {
        /// Its place in the [`Case`].
        field: String,
    },
    /// Something is wrong with the case of a body.
    #[error("{fault}")]
    OfBody {
        /// The place of the separation in the [`Case`].
        field: String,
        /// What is wrong with it.
        fault: Box<Fault>,
    },
    /// Heating without a nose.
    #[error("is required for heating: the heat flux at the stagnation point depends on it")]
    NoNoseRadius,
    /// The initial acceleration overflows.
    #[error("initial acceleration is not a finite number")]
    InfiniteAcceleration,
}

fn odd_shape(equatorial_radius: f64, polar_radius: f64) -> String {
    let [least, greatest, got] = apart([0.1 * equatorial_radius, 10.0 * equatorial_radius, polar_radius]);
    format!("must be between {least} and {greatest} m, 0.1 and 10 times the equatorial radius, got {got}")
}

/// Everything that is wrong with a case.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("the case is not valid: {}", .0.iter().map(ToString::to_string).collect::<Vec<_>>().join("; "))]
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
        faults.extend(case.effect_faults());
        faults.extend(case.part_faults());
        faults.extend((case.heating.is_some() && case.vehicle.nose_radius.is_none()).then_some(Fault::NoNoseRadius));
        if case.hold_down && state.velocity != Vector3::zeros() {
            let bound = Bound { minimum: 0.0, exclusive: false, maximum: 0.0 };
            faults.push(Fault::OutOfBounds {
                field: "initial_state.speed".into(),
                value: state.velocity.norm(),
                bound,
            });
        }
        if faults.is_empty() {
            if altitude < case.stop.altitude - ON_STOP_ALTITUDE {
                faults.push(Fault::BelowStopAltitude { altitude, stop: case.stop.altitude });
            }
            let loads = case.forces().loads(case.start_time, &State::from(*state));
            if !(loads.deceleration.is_finite() && loads.load_factor.is_finite()) {
                faults.push(Fault::InfiniteAcceleration);
            }
        }
        if case.count_of_bodies() > MOST_BODIES {
            let last = case.events.iter().rposition(|event| !event.then.separate.is_empty()).unwrap_or_default();
            faults.push(Fault::TooManyBodies { field: format!("events.{last}.then.separate") });
        }
        if !faults.is_empty() {
            return Err(ScenarioError(faults));
        }
        Ok(Self::unchecked(case))
    }

    /// The case of a body that is set free, which was checked as far as it was known.
    pub(crate) fn unchecked(case: Case) -> Self {
        let altitude = case.planet.shape.altitude(&case.initial_state.position);
        let starts_on_stop_altitude = altitude <= case.stop.altitude + ON_STOP_ALTITUDE;
        Self { case: Arc::new(case), starts_on_stop_altitude }
    }

    /// The case.
    pub fn case(&self) -> &Case {
        &self.case
    }

    /// The same, to be kept.
    pub(crate) fn shared_case(&self) -> Arc<Case> {
        Arc::clone(&self.case)
    }

    /// The same flight at a finer tolerance within its bound: to a hundredth, a method of order 8 takes 1.8 times the steps, and one whose error is
    /// estimated to order 3 takes 3.2 times as many.
    pub(crate) fn finer(&self, relative_tolerance: f64) -> Self {
        let step_limit = self.case.solver.step_limit.saturating_mul(4);
        let solver = Solver { relative_tolerance, step_limit, ..self.case.solver };
        Self { case: Arc::new(Case { solver, ..Case::clone(&self.case) }), ..*self }
    }

    /// The same flight at this tolerance, if its own is finer: it takes fewer steps.
    #[must_use]
    pub fn no_finer_than(self, relative_tolerance: f64) -> Self {
        let relative_tolerance = relative_tolerance.max(self.case.solver.relative_tolerance);
        let solver = Solver { relative_tolerance, ..self.case.solver };
        Self { case: Arc::new(Case { solver, ..Arc::unwrap_or_clone(self.case) }), ..self }
    }

    /// Whether the flight starts on the stop altitude, where it ends unless it leaves it upward.
    pub fn starts_on_stop_altitude(&self) -> bool {
        self.starts_on_stop_altitude
    }
}

impl Case {
    /// A case of a vehicle and its planet-fixed state at t = 0, where it starts, with the defaults of all else: the Earth of WGS 84 with gravity of its mass
    /// alone, the exponential atmosphere of the thesis, still air, no bank angle, no heating and no events.
    pub fn new(vehicle: Vehicle, initial_state: PlanetFixed<f64>) -> Self {
        Self {
            planet: Planet::EARTH_WGS84,
            atmosphere: Atmosphere::EARTH_JAMESON,
            density_factor: 1.0,
            wind: Wind::Still,
            vehicle,
            parts: Vec::new(),
            control: Control::banked(0.0),
            steering: Steering::default(),
            heating: None,
            events: Vec::new(),
            start_time: 0.0,
            initial_state,
            hold_down: false,
            origin: None,
            stop: Stop::default(),
            solver: Solver::default(),
            bodies: Vec::new(),
        }
    }

    /// The forces on the vehicle at the start.
    pub fn forces(&self) -> Forces {
        let mut forces = Phase::first(self).forces(self);
        // The flight refuses a start at which no mode holds.
        let _ = forces.enter_mode_of(self.start_time, &State::from(self.initial_state));
        forces
    }

    /// The models at the start, as far as they hold no number of [`parameters`](Self::parameters).
    pub fn models(&self) -> Models {
        self.models_of(&self.vehicle)
    }

    /// The numbers that may vary, beside the state, at the start.
    pub fn parameters(&self) -> Parameters<f64> {
        Self::parameters_of(self, &self.vehicle, [0.0; 3])
    }

    /// Whether anything may lift the vehicle, or push it across its way, so that near the vertical something fades out.
    pub(crate) fn may_lift(&self) -> bool {
        let effects = self.events.iter().map(|event| &event.then);
        self.vehicle.has_lift()
            || effects.clone().any(|effect| effect.aerodynamics.as_ref().is_some_and(Aerodynamics::has_lift))
            || effects.clone().any(|effect| effect.reference_area.is_some()) && self.vehicle.aerodynamics.has_lift()
            || effects
                .filter_map(|effect| effect.thrust)
                .any(|thrust| matches!(thrust, ThrustCommand::On(thrust) if thrust.along.is_level()))
    }

    /// The same case, which shares with another what is equal in both and may be large: tables, layers and schedules.
    #[must_use]
    pub fn sharing(mut self, other: &Self) -> Self {
        fn share<T: Clone + PartialEq>(own: &mut T, other: &T) {
            if *own == *other {
                own.clone_from(other);
            }
        }
        share(&mut self.atmosphere, &other.atmosphere);
        share(&mut self.wind, &other.wind);
        share(&mut self.vehicle, &other.vehicle);
        share(&mut self.control, &other.control);
        share(&mut self.steering, &other.steering);
        share(&mut self.bodies, &other.bodies);
        for (own, other) in self.events.iter_mut().zip(&other.events) {
            share(own, other);
        }
        self
    }

    /// What its states hold.
    pub(crate) fn state_layout(&self) -> StateLayout {
        self.state_layout_with(self.heating.is_some())
    }

    /// What its states hold, with the heat load or without.
    pub(crate) fn state_layout_with(&self, heat_load: bool) -> StateLayout {
        if heat_load || self.burns_propellant() { StateLayout::HeatLoadAndMass } else { StateLayout::Motion }
    }

    /// From where ranges are measured.
    pub fn track_start(&self) -> &PlanetFixed<f64> {
        self.origin.as_ref().unwrap_or(&self.initial_state)
    }

    /// Whether a thrust burns propellant.
    fn burns_propellant(&self) -> bool {
        let has_engine = self.parts.iter().any(|part| part.engine.is_some());
        has_engine
            || self
                .events
                .iter()
                .filter_map(|event| event.then.thrust())
                .any(|thrust| thrust.specific_impulse.is_some())
    }

    /// Whether a phase of the flight begins with an event: it changes something, or an angle runs since then.
    pub(crate) fn begins_phase(&self, event: usize) -> bool {
        !self.events[event].then.is_none() || self.has_schedules_since(event)
    }

    /// Whether an angle runs since an event, at any time of the flight.
    pub(crate) fn has_schedules_since(&self, event: usize) -> bool {
        let steers = self.events.iter().filter_map(|event| event.then.steer.as_ref());
        let steering = steers.chain([&self.steering]).filter_map(Steering::commands).flatten();
        self.control.commands().into_iter().chain(steering).any(|command| command.event() == Some(event))
    }

    /// What ends the flight or lets something happen, with its place in the case.
    fn triggers(&self) -> impl Iterator<Item = (String, &Trigger)> {
        let events = self.events.iter().enumerate().map(|(index, event)| (format!("events.{index}.when"), &event.when));
        events.chain(self.stop.when.iter().enumerate().map(|(index, when)| (format!("stop.when.{index}"), when)))
    }

    /// Those of them that are conditions.
    fn conditions(&self) -> impl Iterator<Item = (String, &Condition)> {
        self.triggers().filter_map(|(place, trigger)| Some((place, trigger.condition()?)))
    }

    /// The models, with a vehicle in place of that of the start.
    pub(crate) fn models_of<P>(&self, vehicle: &Vehicle<P>) -> Models {
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
            Aerodynamics::MachTable(table) => Aerodynamics::MachTable(Arc::clone(table)),
            Aerodynamics::AlphaMachTable(table) => Aerodynamics::AlphaMachTable(Arc::clone(table)),
        };
        let Control { bank_angle, angle_of_attack } = self.control.clone();
        let bank_angle = if matches!(bank_angle, Command::Constant(_)) { NO_ANGLE } else { bank_angle };
        Models {
            planet: self.planet,
            atmosphere,
            wind: self.wind.clone(),
            aerodynamics,
            control: Control { bank_angle, angle_of_attack },
            steering: Steering::default(),
            heating: self
                .heating
                .zip(vehicle.nose_radius)
                .map(|(heating, nose_radius)| Stagnation::new(heating, nose_radius)),
        }
    }

    /// The numbers that may vary, beside the state, with a vehicle in place of that of the start; `offsets` are those of [`Numbers::offsets`].
    pub(crate) fn parameters_of<P: Scalar>(
        numbers: &impl Numbers<P>,
        vehicle: &Vehicle<P>,
        offsets: [P; 3],
    ) -> Parameters<P> {
        let Vehicle { mass, reference_area, aerodynamics, .. } = vehicle;
        let [lift, drag, bank] = offsets;
        let [mass, reference_area, lift_coefficient, drag_coefficient] = match *aerodynamics {
            Aerodynamics::Constant { lift_coefficient, drag_coefficient } => {
                [*mass, *reference_area, lift_coefficient, drag_coefficient]
            }
            // The ratios are those of a vehicle of this mass with unit area and drag.
            Aerodynamics::Ballistic { ballistic_coefficient, lift_to_drag } => {
                [ballistic_coefficient, P::one(), lift_to_drag, P::one()]
            }
            Aerodynamics::MachTable(_) | Aerodynamics::AlphaMachTable(_) => [*mass, *reference_area, lift, drag],
        };
        let density = numbers.number(|case| case.atmosphere.surface_density().unwrap_or(1.0) * case.density_factor);
        let bank_angle = numbers.number(|case| match case.control.bank_angle {
            Command::Constant(angle) => angle,
            Command::Schedule(_) => 0.0,
        }) + bank;
        Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle }
    }

    /// What is wrong across the effects of events.
    fn effect_faults(&self) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (index, Event { then, .. }) in self.events.iter().enumerate() {
            if let Some(ThrustCommand::On(thrust)) = then.thrust
                && thrust.propellant.is_some()
                && thrust.specific_impulse.is_none()
            {
                faults.push(Fault::PropellantUnused { field: format!("events.{index}.then.thrust.propellant") });
            }
            let deploys = |event: usize| self.events.get(event).is_some_and(|event| event.then.deploy.is_some());
            let unknown = then.release.iter().enumerate().filter(|(_, event)| !deploys(**event));
            faults.extend(unknown.map(|(place, event)| Fault::NoParachute {
                field: format!("events.{index}.then.release.{place}"),
                event: *event,
            }));
        }
        faults
    }

    /// What needs a Mach number where there is none.
    fn mach_faults(&self) -> Vec<Fault> {
        if self.atmosphere.has_speed_of_sound() {
            return Vec::new();
        }
        let [bank_angle, angle_of_attack] =
            self.control.commands().map(|command| command.against() == Some(Against::Mach));
        let needs: [(Cow<'static, str>, bool); 3] = [
            ("vehicle.aerodynamics.type".into(), self.vehicle.aerodynamics.is_by_mach()),
            ("control.bank_angle.against".into(), bank_angle),
            ("control.angle_of_attack.against".into(), angle_of_attack),
        ];
        let conditions = self
            .conditions()
            .map(|(place, condition)| (format!("{place}.quantity").into(), condition.quantity == Quantity::Mach));
        let effects = self.events.iter().enumerate().map(|(index, event)| {
            let by_mach = event.then.aerodynamics.as_ref().is_some_and(Aerodynamics::is_by_mach);
            (format!("events.{index}.then.aerodynamics.type").into(), by_mach)
        });
        let steered = self.events.iter().enumerate();
        let steered = steered
            .filter_map(|(index, event)| Some((format!("events.{index}.then.steer"), event.then.steer.as_ref()?)));
        let steers = steered.chain([("control.steering".to_owned(), &self.steering)]).flat_map(|(place, steering)| {
            let commands = ["pitch", "yaw"].into_iter().zip(steering.commands().into_iter().flatten());
            let of = |(name, command): (&str, &Command)| {
                (format!("{place}.{name}.against").into(), command.against() == Some(Against::Mach))
            };
            commands.map(of).collect::<Vec<_>>()
        });
        let needs = needs.into_iter().chain(conditions).chain(effects).chain(steers);
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
        let missing = self.conditions().filter_map(|(place, condition)| {
            let field = format!("{place}.quantity");
            match condition.quantity {
                quantity if quantity.is_of_heating() && self.heating.is_none() => Some(Fault::NoHeating { field }),
                Quantity::Downrange if !GreatCircle::of(self.track_start()).has_heading() => {
                    Some(Fault::NoHeading { field })
                }
                _ => None,
            }
        });
        let orphans = self.triggers().filter_map(|(place, trigger)| match *trigger {
            Trigger::After { event, .. } if self.events.get(event).is_none() => {
                Some(Fault::NoSuchEvent { field: format!("{place}.event") })
            }
            Trigger::After { event, .. } if self.waits_in_a_circle(event) => {
                Some(Fault::NeverHappens { field: format!("{place}.event") })
            }
            Trigger::AfterBurnout { part, .. } if self.parts.get(part).is_none_or(|part| part.engine.is_none()) => {
                Some(Fault::NoSuchEngine { field: format!("{place}.burnout") })
            }
            _ => None,
        });
        let schedules = [("bank_angle", &self.control.bank_angle), ("angle_of_attack", &self.control.angle_of_attack)];
        let clockless = schedules.into_iter().filter_map(|(name, command)| {
            let is_missing = self.events.get(command.event()?).is_none();
            is_missing.then(|| Fault::NoSuchEvent { field: format!("control.{name}.against.since") })
        });
        let low = low.map(|ceiling| Fault::LowCeiling { ceiling, altitude });
        falling.chain(low).chain(missing).chain(orphans).chain(clockless).collect()
    }

    /// Whether an event waits for others that wait for each other, so that none of them ever happens.
    fn waits_in_a_circle(&self, mut event: usize) -> bool {
        // A chain that is longer than there are events comes back to where it was.
        for _ in 0..=self.events.len() {
            match self.events.get(event).map(|event| event.when) {
                Some(Trigger::After { event: other, .. }) => event = other,
                _ => return false,
            }
        }
        true
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
