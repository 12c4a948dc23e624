//! How the end of a flight depends on its numbers: derivatives of the arrival, the change of its time included.
//!
//! The steps of the flight are followed once more in dual numbers, which carry all derivatives along ([`follow`]); at the ground
//! one step of Newton's method gives the derivatives of the time of the impact, and with it those of the state there. So it does where
//! the formulas of the models change: as long as the change comes later, the flight moves on by the rates from before it.

use std::array::from_fn;
use std::collections::BTreeSet;
use std::f64::consts::TAU;

use nalgebra::SVector;
use num_dual::{Dual64, DualSVec64, jacobian};

use crate::atmosphere::Atmosphere;
use crate::coordinates::{FlightPath, GreatCircle, PlanetFixed};
use crate::event::{Condition, Direction, Engine, Quantity, Trigger};
use crate::integrate::{System, follow};
use crate::interrupt::Interrupt;
use crate::motion::{self, Burn, Cartesian, Forces, Formulation, ModelMode, Parameters, Spherical, StateRate, moving};
use crate::parachute::{Canopies, Canopy};
use crate::propulsion::Impulse;
use crate::scalar::Scalar;
use crate::scenario::{Case, Equations, Phase};
use crate::simulate::SimulationError;
use crate::trajectory::{EventRecord, Flown, Termination, Trajectory};

/// How a quantity changes with the numbers of a case, each by itself: SI units and radians over SI units and radians.
///
/// Not a finite number where there is no derivative: at a grazing impact and, of the angles that are undefined there, at rest,
/// in vertical flight and at the poles.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// By the mass, kg.
    pub mass: f64,
    /// By the reference area, m².
    pub reference_area: f64,
    /// By the lift coefficient.
    pub lift_coefficient: f64,
    /// By the drag coefficient.
    pub drag_coefficient: f64,
    /// By the bank angle, rad.
    pub bank_angle: f64,
    /// By the density at altitude 0, kg/m³.
    pub surface_density: f64,
    /// By the density factor.
    pub density_factor: f64,
    /// By the initial state; its radius stays when its latitude changes.
    pub initial_state: FlightPath<f64>,
}

/// How the arrival depends on the numbers of the case.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sensitivities {
    /// Of the final time, s; zero where the flight ends at a given time.
    pub time: Gradient,
    /// Of the final longitude, rad.
    pub longitude: Gradient,
    /// Of the final geocentric latitude, rad.
    pub geocentric_latitude: Gradient,
    /// Of the final speed relative to the planet, m/s.
    pub speed: Gradient,
    /// Of the final flight-path angle, rad.
    pub flight_path_angle: Gradient,
}

/// The numbers by which there are derivatives: six of the initial state, and six others.
const INPUTS: usize = 12;
type Dual = DualSVec64<INPUTS>;

/// A flight that ends this near (in parts of a right angle's sine, or of the circular speed) to where an angle or the speed has no
/// slope has none: what is computed there is rounding.
const UNDEFINED: f64 = 1e-6;

/// A quantity this near the value of a condition, relative to it or to 1, has met it by moving there and not by a jump.
const ON_VALUE: f64 = 1e-6;

/// The derivatives of the arrival of a flight.
///
/// # Errors
/// When the flag is raised, at which it looks before every step.
pub fn sensitivities(flight: &Trajectory, interrupt: &dyn Interrupt) -> Result<Sensitivities, SimulationError> {
    let Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle } =
        flight.case.parameters();
    let [r, theta, phi, v, gamma, psi]: [f64; 6] = FlightPath::from_planet_fixed(&flight.case.initial_state).into();
    let numbers =
        [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, r, theta, phi, v, gamma, psi];
    let arrival = |numbers: SVector<Dual, INPUTS>| arrival(flight, &numbers.into(), interrupt);
    let (_, slopes) = jacobian(arrival, &SVector::from(numbers))?;
    let has = Numbers::of(&flight.case);
    let gradient = |row: usize| {
        let [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, state @ ..]: [f64; INPUTS] =
            std::array::from_fn(|input| slopes[(row, input)]);
        let only = |has: bool, slope: f64| if has { slope } else { f64::NAN };
        Gradient {
            mass: match has.mass {
                true => mass,
                false if has.weight => f64::NAN,
                false => 0.0,
            },
            reference_area: only(has.mass, reference_area),
            lift_coefficient: only(has.mass, lift_coefficient),
            drag_coefficient: only(has.mass, drag_coefficient),
            bank_angle,
            surface_density: has.surface_density.map_or(f64::NAN, |_| density * flight.case.density_factor),
            density_factor: density * has.surface_density.unwrap_or(1.0),
            initial_state: state.into(),
        }
    };
    let defined = |row: usize, size: f64| if size > UNDEFINED { gradient(row) } else { Gradient::NONE };
    let end = flight.last().flight_path;
    let planet = &flight.case.planet;
    let moving = end.speed / (planet.gravitational_parameter / planet.equatorial_radius()).sqrt();
    let off_axis = end.geocentric_latitude.cos();
    Ok(Sensitivities {
        time: gradient(0),
        longitude: defined(1, off_axis),
        geocentric_latitude: defined(2, off_axis),
        speed: defined(3, moving),
        flight_path_angle: defined(4, moving.min(end.flight_path_angle.cos())),
    })
}

/// Which of its numbers a case has.
struct Numbers {
    /// Mass, area and coefficients, and not ratios of them.
    mass: bool,
    /// A thrust or a parachute, by which the mass matters beside the ratios.
    weight: bool,
    surface_density: Option<f64>,
}

impl Numbers {
    fn of(case: &Case) -> Self {
        Self {
            mass: !case.vehicle.is_ballistic(),
            weight: case.events.iter().any(|event| event.then.engine.is_some() || event.then.deploy.is_some()),
            surface_density: match case.atmosphere {
                Atmosphere::Exponential { surface_density, .. } => Some(surface_density),
                Atmosphere::Vacuum | Atmosphere::Us76 | Atmosphere::Layers(_) | Atmosphere::Table(_) => None,
            },
        }
    }
}

impl Gradient {
    /// No derivatives.
    const NONE: Self = Self {
        mass: f64::NAN,
        reference_area: f64::NAN,
        lift_coefficient: f64::NAN,
        drag_coefficient: f64::NAN,
        bank_angle: f64::NAN,
        surface_density: f64::NAN,
        density_factor: f64::NAN,
        initial_state: FlightPath {
            radius: f64::NAN,
            longitude: f64::NAN,
            geocentric_latitude: f64::NAN,
            speed: f64::NAN,
            flight_path_angle: f64::NAN,
            heading: f64::NAN,
        },
    };
}

/// The end of the flight: time, longitude, geocentric latitude, speed and flight-path angle.
type Outputs = SVector<Dual, 5>;

fn arrival(
    flight: &Trajectory,
    numbers: &[Dual; INPUTS],
    interrupt: &dyn Interrupt,
) -> Result<Outputs, SimulationError> {
    let [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, start @ ..] = *numbers;
    let parameters = Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle };
    let start = FlightPath::from(start);
    match (flight.case.solver.equations, waits_for_heat_load(&flight.case)) {
        (Equations::Cartesian, false) => {
            arrival_of::<Cartesian, _, 6>(flight, &parameters, Cartesian, &start, interrupt)
        }
        (Equations::Spherical, false) => {
            arrival_of::<Spherical, _, 6>(flight, &parameters, Spherical, &start, interrupt)
        }
        (Equations::Cartesian, true) => {
            arrival_of::<Cartesian, _, 7>(flight, &parameters, Cartesian, &start, interrupt)
        }
        (Equations::Spherical, true) => {
            arrival_of::<Spherical, _, 7>(flight, &parameters, Spherical, &start, interrupt)
        }
    }
}

/// Whether anything in the flight depends on the heat load, so that it has to be followed along.
fn waits_for_heat_load(case: &Case) -> bool {
    let triggers = case.events.iter().map(|event| &event.when).chain(&case.stop.when);
    triggers.filter_map(Trigger::condition).any(|condition| condition.quantity == Quantity::HeatLoad)
}

fn arrival_of<F: Formulation<N>, M: System<Dual, N>, const N: usize>(
    flight: &Trajectory,
    parameters: &Parameters<Dual>,
    formulation: impl Fn(Forces<Dual>) -> M,
    start: &FlightPath<Dual>,
    interrupt: &dyn Interrupt,
) -> Result<Outputs, SimulationError> {
    let Flown { steps, event_records, end, arrival, .. } = &flight.flown;
    let start = start.to_planet_fixed();
    let track = GreatCircle::of(&start);
    let mut state = F::coordinates(&start, Dual::from(0.0));
    // How much later each event happens as the numbers vary.
    let mut delays = vec![Dual::from(0.0); flight.case.events.len()];
    let triggers = flight.case.events.iter().map(|event| &event.when).chain(&flight.case.stop.when);
    let awaited: BTreeSet<usize> = triggers.filter_map(Trigger::awaited).collect();
    let mut phase = VariedPhase::first(flight, parameters);
    let mut forces = phase.forces(flight.flown.start.mode);
    let mut motion = formulation(forces.clone());
    let mut event_records = event_records.iter().peekable();
    for step in steps {
        let (time, length) = (step.start_time(), step.end_time() - step.start_time());
        if interrupt.is_raised() {
            return Err(SimulationError::Interrupted { time });
        }
        let is_awaited = |record: &&EventRecord| record.before.time <= time && awaited.contains(&record.event);
        if (step.phase, step.mode) != (phase.number, forces.mode()) || event_records.peek().is_some_and(is_awaited) {
            let now: Vec<_> =
                std::iter::from_fn(|| event_records.next_if(|record| record.before.time <= time)).collect();
            let place = Place { time, rates: motion.derivative(time.into(), &state), state, track: &track };
            let delay = turning_delay::<F, N>(&phase, &forces, &now, step.mode, &place, &delays);
            // During the delay the rates before the change hold in place of those after it.
            state = from_fn(|i| state[i] + place.rates[i] * delay);
            for record in now {
                delays[record.event] = delay;
                phase = phase.changed_by_time(record.before.phase, delay).after(record, delay);
                state = apply_impulse::<F, N>(flight, record, delay, &state);
            }
            phase = phase.changed_by_time(step.phase, delay);
            forces = phase.forces(step.mode);
            motion = formulation(forces.clone());
            let next = motion.derivative(time.into(), &state);
            state = from_fn(|i| state[i] - next[i] * delay);
        }
        state = follow(&motion, &state, time, length);
    }
    let place = Place { time: end.time, rates: motion.derivative(end.time.into(), &state), state, track: &track };
    let at_altitude = |value| Condition { quantity: Quantity::Altitude, value, direction: Direction::Falling };
    let trigger = match arrival.termination {
        Termination::TimeLimit => None,
        Termination::SurfaceImpact | Termination::StopAltitude => Some(at_altitude(flight.case.stop.altitude).into()),
        Termination::AtmosphereExit => flight.case.stop.ceiling().map(Trigger::from),
        Termination::Condition(index) => flight.case.stop.when.get(index).copied(),
    };
    let delay = match trigger {
        None => Dual::from(0.0),
        Some(Trigger::Condition(condition)) => condition_delay::<F, N>(&phase, &forces, condition.quantity, &place),
        Some(Trigger::After { event, .. }) => delays[event],
    };
    state = from_fn(|i| state[i] + place.rates[i] * delay);
    for record in event_records {
        state = apply_impulse::<F, N>(flight, record, delay, &state);
    }
    let FlightPath { longitude, geocentric_latitude, speed, flight_path_angle, .. } =
        FlightPath::from_planet_fixed(&F::planet_fixed(&state));
    Ok([delay + end.time, longitude, geocentric_latitude, speed, flight_path_angle].into())
}

/// A state with its rates at a time, s, at which the motion changes.
struct Place<'a, const N: usize> {
    time: f64,
    state: [Dual; N],
    rates: [Dual; N],
    /// From which ranges are measured.
    track: &'a GreatCircle<Dual>,
}

impl<const N: usize> Place<'_, N> {
    /// The values of the state, moving along the flow.
    fn moving<F: Formulation<N>>(&self) -> StateRate {
        let values = moving(&self.state.map(Scalar::value), &self.rates.map(Scalar::value));
        StateRate::at::<F, N>(Dual64::new(self.time, 1.0), &values)
    }

    /// A quantity, as the numbers vary.
    fn quantity<F: Formulation<N>>(&self, quantity: Quantity, forces: &Forces<Dual>) -> Dual {
        forces.quantity(quantity, &StateRate::at::<F, N>(Dual::from(self.time), &self.state), self.track)
    }
}

/// The delay of a change of the motion as the numbers vary, s; zero where it comes at a given time.
fn turning_delay<F: Formulation<N>, const N: usize>(
    phase: &VariedPhase,
    forces: &Forces<Dual>,
    now: &[&EventRecord],
    next: ModelMode,
    place: &Place<N>,
    delays: &[Dual],
) -> Dual {
    // A condition that was met by a jump was so because of another.
    let meets = |Condition { quantity, value, .. }: &Condition| {
        let mut off = place.quantity::<F>(*quantity, forces).value() - *value;
        if *quantity == Quantity::Downrange {
            let around = TAU * phase.flight.case.planet.equatorial_radius();
            off -= around * (off / around).round();
        }
        off.abs() <= ON_VALUE * value.abs().max(1.0)
    };
    let delay_of = |record: &&EventRecord| match phase.flight.case.events[record.event].when {
        Trigger::Condition(condition) => {
            meets(&condition).then(|| condition_delay::<F, N>(phase, forces, condition.quantity, place))
        }
        Trigger::After { event, .. } => Some(delays[event]),
    };
    if let Some(delay) = now.iter().find_map(delay_of) {
        return delay;
    }
    if let Some(change) = phase.next_change_by_time().filter(|change| change.value() <= place.time) {
        return change - change.value();
    }
    let plain = phase.plain_forces(forces.mode());
    let values = F::planet_fixed(&place.state.map(Scalar::value));
    let Some(switch) = plain.first_to_turn(next, place.time, &values) else {
        return Dual::from(0.0);
    };
    let rate = plain.readings(Dual64::new(place.time, 1.0), &place.moving::<F>().state)[switch as usize].eps;
    let readings = forces.readings(Dual::from(place.time), &F::planet_fixed(&place.state));
    delay(readings[switch as usize], rate)
}

/// How much later a quantity passes the value that it has; not at all where it is the time.
fn condition_delay<F: Formulation<N>, const N: usize>(
    phase: &VariedPhase,
    forces: &Forces<Dual>,
    quantity: Quantity,
    place: &Place<N>,
) -> Dual {
    if quantity == Quantity::Time {
        return Dual::from(0.0);
    }
    let plain = phase.plain_forces(forces.mode());
    let track = place.track.map(|number| Dual64::from(number.value()));
    let rate = plain.quantity(quantity, &place.moving::<F>(), &track).eps;
    delay(place.quantity::<F>(quantity, forces), rate)
}

/// How much later a quantity passes the value that it has: a step of Newton's method, -q/q̇, of value zero.
fn delay(quantity: Dual, rate: f64) -> Dual {
    -(quantity - quantity.value()) * rate.recip()
}

/// The state after the impulse of an event, if it has one.
fn apply_impulse<F: Formulation<N>, const N: usize>(
    flight: &Trajectory,
    record: &EventRecord,
    delay: Dual,
    state: &[Dual; N],
) -> [Dual; N] {
    let effect = &flight.case.events[record.event].then;
    let Some(Impulse { along, speed_change }) = effect.impulse else { return *state };
    let heat_load = state.get(6).copied().unwrap_or(Dual::from(0.0));
    let state = F::planet_fixed(state);
    let direction = motion::along(along, &flight.case.planet, delay + record.before.time, &state);
    let velocity = state.velocity + direction * Dual::from(speed_change);
    F::coordinates(&PlanetFixed { velocity, ..state }, heat_load)
}

/// A phase of the flight, whose numbers carry derivatives.
struct VariedPhase<'a> {
    flight: &'a Trajectory,
    /// Its number: 0 for the first.
    number: usize,
    parameters: Parameters<Dual>,
    /// When it began, s.
    since: Dual,
    /// Then, kg.
    mass: Dual,
    /// Left to burn then, kg.
    propellant: Option<Dual>,
    /// When each of the canopies of the phase was deployed, s.
    deployed: Vec<Dual>,
}

impl<'a> VariedPhase<'a> {
    fn first(flight: &'a Trajectory, parameters: &Parameters<Dual>) -> Self {
        let vehicle = &flight.case.vehicle;
        let mass = if vehicle.is_ballistic() { Dual::from(vehicle.mass) } else { parameters.mass };
        Self {
            flight,
            number: 0,
            parameters: *parameters,
            since: Dual::from(0.0),
            mass,
            propellant: None,
            deployed: Vec::new(),
        }
    }

    fn as_flown(&self) -> &'a Phase {
        &self.flight.flown.phases[self.number]
    }

    fn mass_flow(&self) -> f64 {
        self.as_flown().thrust.map_or(0.0, |thrust| thrust.mass_flow())
    }

    /// Burnt up to a time, kg.
    fn burnt(&self, time: Dual) -> Dual {
        (time - self.since) * self.mass_flow()
    }

    /// When the propellant is spent, s.
    fn burnout(&self) -> Option<Dual> {
        Some(self.since + self.propellant? / self.mass_flow())
    }

    /// When the propellant is spent, or a canopy begins to fill or is full, s, whichever comes next.
    fn next_change_by_time(&self) -> Option<Dual> {
        let canopies = self.as_flown().canopies.iter().zip(&self.deployed);
        let inflations = canopies.filter_map(|(canopy, deployed)| canopy.corner(*deployed));
        self.burnout().into_iter().chain(inflations).min_by(|a, b| a.value().total_cmp(&b.value()))
    }

    fn forces(&self, mode: ModelMode) -> Forces<Dual> {
        let over_mass = self.mass.recip();
        let burn = self.as_flown().thrust.map(|thrust| Burn {
            along: thrust.along,
            since: self.since,
            acceleration: over_mass * thrust.force,
            flow: over_mass * thrust.mass_flow(),
        });
        let models = self.flight.case.models_of(&self.as_flown().vehicle);
        let canopies = self.as_flown().canopies.iter().copied().zip(self.deployed.iter().copied());
        let canopies = Canopies::of(canopies, over_mass);
        let mut forces = Forces::new(models, self.parameters).of_mass(self.mass).burning(burn).under(canopies);
        forces.enter(mode);
        forces
    }

    /// The same without derivatives.
    fn plain_forces(&self, mode: ModelMode) -> Forces {
        let mut forces = self.as_flown().forces(&self.flight.case);
        forces.enter(mode);
        forces
    }

    /// The phase of a number to which time alone leads: propellant is spent, canopies begin to fill or are full.
    fn changed_by_time(self, number: usize, delay: Dual) -> Self {
        let mut phase = self;
        while phase.number < number {
            let next = &phase.flight.flown.phases[phase.number + 1];
            let time = delay + next.since;
            let burns_on = next.thrust.is_some();
            let burnt = if burns_on { phase.burnt(time) } else { phase.propellant.unwrap_or(Dual::from(0.0)) };
            let propellant = phase.propellant.filter(|_| burns_on).map(|propellant| propellant - burnt);
            let mass = phase.mass - burnt;
            phase = Self { number: phase.number + 1, since: time, propellant, ..phase.with_mass(mass) };
        }
        phase
    }

    /// The phase after an event.
    fn after(self, record: &EventRecord, delay: Dual) -> Self {
        let effect = &self.flight.case.events[record.event].then;
        if effect.is_none() {
            return self;
        }
        let time = delay + record.before.time;
        let burnt = self.burnt(time);
        let mass = effect.mass.map_or(self.mass - burnt, Dual::from);
        let propellant = match effect.engine {
            None => self.propellant.map(|propellant| propellant - burnt),
            Some(Engine::On(thrust)) => thrust.propellant.map(Dual::from),
            Some(Engine::Off) => None,
        };
        let stays = |(canopy, _): &(&Canopy, &Dual)| !effect.release.contains(&canopy.event);
        let canopies = self.as_flown().canopies.iter().zip(&self.deployed).filter(stays);
        let deployed = canopies.map(|(_, deployed)| *deployed).chain(effect.deploy.map(|_| time)).collect();
        let number = record.after.phase;
        let mut next = Self { number, since: time, propellant, deployed, ..self.with_mass(mass) };
        let vehicle = &next.as_flown().vehicle;
        let as_flown = self.flight.case.parameters_of(vehicle);
        let ballistic = vehicle.is_ballistic();
        if effect.aerodynamics.is_some() {
            next.parameters.lift_coefficient = as_flown.lift_coefficient.into();
            next.parameters.drag_coefficient = as_flown.drag_coefficient.into();
            next.parameters.mass = if ballistic { as_flown.mass.into() } else { mass };
        }
        if effect.reference_area.is_some() || effect.aerodynamics.is_some() && (ballistic || self.was_ballistic()) {
            next.parameters.reference_area = as_flown.reference_area.into();
        }
        next
    }

    fn was_ballistic(&self) -> bool {
        self.as_flown().vehicle.is_ballistic()
    }

    /// The same vehicle of another mass, kg.
    fn with_mass(&self, mass: Dual) -> Self {
        let of_parameters = if self.was_ballistic() { self.parameters.mass * mass * self.mass.recip() } else { mass };
        let parameters = Parameters { mass: of_parameters, ..self.parameters };
        Self { parameters, mass, deployed: self.deployed.clone(), ..*self }
    }
}
