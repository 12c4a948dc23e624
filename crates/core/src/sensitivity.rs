//! How the end of a flight depends on its numbers: derivatives of the arrival, the change of its time included.
//!
//! The steps of the flight are followed once more in dual numbers, which carry all derivatives along ([`follow`]); at the ground
//! one step of Newton's method gives the derivatives of the time of the impact, and with it those of the state there. So it does where
//! the formulas of the models change: as long as the change comes later, the flight moves on by the rates from before it.

use std::sync::atomic::{AtomicBool, Ordering};

use nalgebra::SVector;
use num_dual::{Dual64, DualSVec64, jacobian};

use crate::atmosphere::Atmosphere;
use crate::coordinates::FlightPath;
use crate::integrate::{System, follow};
use crate::motion::{Cartesian, Forces, Formulation, Parameters, Regime, Spherical, moving};
use crate::scalar::Scalar;
use crate::scenario::{Case, Equations};
use crate::simulate::SimulationError;
use crate::trajectory::{Leg, Termination, Trajectory};
use crate::vehicle::Aerodynamics;

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

/// The derivatives of the arrival of a flight.
///
/// # Errors
/// When the flag is raised, at which it looks before every step.
pub fn sensitivities(flight: &Trajectory, interrupt: &AtomicBool) -> Result<Sensitivities, SimulationError> {
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
            mass: if has.mass { mass } else { 0.0 },
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
    surface_density: Option<f64>,
}

impl Numbers {
    fn of(case: &Case) -> Self {
        Self {
            mass: !matches!(case.vehicle.aerodynamics, Aerodynamics::Ballistic { .. }),
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

fn arrival(flight: &Trajectory, numbers: &[Dual; INPUTS], interrupt: &AtomicBool) -> Result<Outputs, SimulationError> {
    let [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, start @ ..] = *numbers;
    let parameters = Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle };
    let forces = Forces::new(flight.case.models(), parameters);
    let start = FlightPath::from(start);
    match flight.case.solver.equations {
        Equations::Cartesian => arrival_of::<Cartesian, _>(flight, forces, Cartesian, &start, interrupt),
        Equations::Spherical => arrival_of::<Spherical, _>(flight, forces, Spherical, &start, interrupt),
    }
}

fn arrival_of<F: Formulation, M: System<Dual, 6>>(
    flight: &Trajectory,
    mut forces: Forces<Dual>,
    formulation: impl Fn(Forces<Dual>) -> M,
    start: &FlightPath<Dual>,
    interrupt: &AtomicBool,
) -> Result<Outputs, SimulationError> {
    let mut state = F::coordinates(&start.to_planet_fixed());
    forces.enter(flight.regime);
    let mut motion = formulation(forces.clone());
    for Leg { step, regime } in &flight.legs {
        if interrupt.load(Ordering::Relaxed) {
            return Err(SimulationError::Interrupted { time: step.start_time });
        }
        if *regime != forces.regime() {
            let rates = motion.derivative(step.start_time.into(), &state);
            let delay = turning_delay::<F>(flight, &forces, *regime, step.start_time, &state, &rates);
            forces.enter(*regime);
            motion = formulation(forces.clone());
            // So long the rates before the turn hold, and not yet those after it.
            let next = motion.derivative(step.start_time.into(), &state);
            state = std::array::from_fn(|i| state[i] + (rates[i] - next[i]) * delay);
        }
        state = follow(&motion, &state, step);
    }
    let mut time = Dual::from(flight.end_time());
    if flight.termination() == Termination::SurfaceImpact {
        let rates = motion.derivative(time, &state);
        let shape = flight.case.planet.shape;
        let moving = moving(&state.map(Scalar::value), &rates.map(Scalar::value));
        let climb = shape.altitude(&F::planet_fixed(&moving).position).eps;
        let delay = delay(shape.altitude(&F::planet_fixed(&state).position), climb);
        time += delay;
        state = std::array::from_fn(|i| state[i] + rates[i] * delay);
    }
    let FlightPath { longitude, geocentric_latitude, speed, flight_path_angle, .. } =
        FlightPath::from_planet_fixed(&F::planet_fixed(&state));
    Ok([time, longitude, geocentric_latitude, speed, flight_path_angle].into())
}

/// How much later the models turn to another regime as the numbers vary; not at all where they turn by the time.
fn turning_delay<F: Formulation>(
    flight: &Trajectory,
    forces: &Forces<Dual>,
    next: Regime,
    time: f64,
    state: &[Dual; 6],
    rates: &[Dual; 6],
) -> Dual {
    let values = state.map(Scalar::value);
    let motion = flight.motion(forces.regime());
    let Some(switch) = motion.forces().first_to_turn(next, time, &F::planet_fixed(&values)) else {
        return Dual::from(0.0);
    };
    let moving = F::planet_fixed(&moving(&values, &rates.map(Scalar::value)));
    let rate = motion.forces().readings(Dual64::new(time, 1.0), &moving)[switch as usize].eps;
    delay(forces.readings(Dual::from(time), &F::planet_fixed(state))[switch as usize], rate)
}

/// How much later a quantity passes the value that it has: a step of Newton's method, -q/q̇, of value zero.
fn delay(quantity: Dual, rate: f64) -> Dual {
    -(quantity - quantity.value()) * rate.recip()
}
