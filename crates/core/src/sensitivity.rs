//! How the end of a flight depends on its numbers: derivatives of the arrival, the change of its time included.
//!
//! The steps of the flight are followed once more in dual numbers, which carry all derivatives along ([`follow`]); at the ground
//! one step of Newton's method gives the derivatives of the time of the impact, and with it those of the state there.

use std::sync::atomic::AtomicBool;

use nalgebra::SVector;
use num_dual::{DualSVec64, jacobian};

use crate::coordinates::FlightPath;
use crate::integrate::{IntegrationError, System, follow};
use crate::motion::{Cartesian, Forces, Formulation, Parameters, Spherical};
use crate::scalar::Scalar;
use crate::scenario::{Case, Equations};
use crate::simulate::SimulationError;
use crate::trajectory::{Termination, Trajectory};

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
    let (_, slopes) = jacobian(arrival, &SVector::from(numbers))
        .map_err(|_| SimulationError::Interrupted { time: flight.end_time() })?;
    let gradient = |row: usize| {
        let [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, surface_density, state @ ..]: [f64;
            INPUTS] = std::array::from_fn(|input| slopes[(row, input)]);
        let initial_state = state.into();
        Gradient {
            mass,
            reference_area,
            lift_coefficient,
            drag_coefficient,
            bank_angle,
            surface_density,
            density_factor: f64::NAN,
            initial_state,
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

fn arrival(flight: &Trajectory, numbers: &[Dual; INPUTS], interrupt: &AtomicBool) -> Result<Outputs, IntegrationError> {
    let [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, start @ ..] = *numbers;
    let parameters = Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle };
    let forces = Forces::new(flight.case.models(), parameters);
    let start = FlightPath::from(start);
    match flight.case.solver.equations {
        Equations::Cartesian => arrival_of::<Cartesian, _>(flight, &Cartesian(forces), &start, interrupt),
        Equations::Spherical => arrival_of::<Spherical, _>(flight, &Spherical(forces), &start, interrupt),
    }
}

fn arrival_of<F: Formulation, M: System<Dual, 6>>(
    flight: &Trajectory,
    motion: &M,
    start: &FlightPath<Dual>,
    interrupt: &AtomicBool,
) -> Result<Outputs, IntegrationError> {
    let mut end = follow(motion, F::coordinates(&start.to_planet_fixed()), &flight.steps, interrupt)?;
    let mut time = Dual::from(flight.end_time());
    if flight.termination() == Termination::SurfaceImpact {
        let rates = motion.derivative(&end);
        let delay = crossing_delay::<F>(&flight.case, &end, &rates);
        time += delay;
        end = std::array::from_fn(|i| end[i] + rates[i] * delay);
    }
    let FlightPath { longitude, geocentric_latitude, speed, flight_path_angle, .. } =
        FlightPath::from_planet_fixed(&F::planet_fixed(&end));
    Ok([time, longitude, geocentric_latitude, speed, flight_path_angle].into())
}

/// How much later the stop altitude is crossed as the numbers vary: a step of Newton's method, -h/ḣ, of value zero.
fn crossing_delay<F: Formulation>(case: &Case, end: &[Dual; 6], rates: &[Dual; 6]) -> Dual {
    let altitude = case.planet.shape.altitude(&F::planet_fixed(end).position);
    let moving = crate::motion::moving(&end.map(Scalar::value), &rates.map(Scalar::value));
    let climb = case.planet.shape.altitude(&F::planet_fixed(&moving).position).eps;
    -(altitude - altitude.value()) * climb.recip()
}
