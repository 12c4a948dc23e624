//! How the end of a flight depends on its numbers: derivatives of the arrival, the change of its time included.
//!
//! The steps of the flight are followed once more in dual numbers, which carry all derivatives along ([`follow`]); at the ground
//! one step of Newton's method gives the derivatives of the time of the impact, and with it those of the state there.

use nalgebra::SVector;
use num_dual::{DualSVec64, jacobian};

use crate::coordinates::FlightPath;
use crate::integrate::{System, follow};
use crate::motion::{Cartesian, Forces, Formulation, Parameters, Spherical};
use crate::scalar::Scalar;
use crate::scenario::{Case, Equations};
use crate::trajectory::{Termination, Trajectory};

/// How a quantity changes with the numbers of a case, each by itself: SI units and radians over SI units and radians.
///
/// Not a finite number where there is no derivative: at a grazing impact, at rest, or in vertical flight.
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

/// The derivatives of the arrival of a flight.
pub fn sensitivities(flight: &Trajectory) -> Sensitivities {
    let Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle } =
        flight.case.parameters();
    let [r, theta, phi, v, gamma, psi]: [f64; 6] = FlightPath::from_planet_fixed(&flight.case.initial_state).into();
    let numbers =
        [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, r, theta, phi, v, gamma, psi];
    let (_, slopes) = jacobian(|numbers| arrival(flight, &numbers.into()), &SVector::from(numbers));
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
            initial_state,
        }
    };
    Sensitivities {
        time: gradient(0),
        longitude: gradient(1),
        geocentric_latitude: gradient(2),
        speed: gradient(3),
        flight_path_angle: gradient(4),
    }
}

/// Time, longitude, geocentric latitude, speed and flight-path angle at the end of the flight.
fn arrival(flight: &Trajectory, numbers: &[Dual; INPUTS]) -> SVector<Dual, 5> {
    let [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, start @ ..] = *numbers;
    let parameters = Parameters { mass, reference_area, lift_coefficient, drag_coefficient, density, bank_angle };
    let forces = Forces::new(flight.case.models(), parameters);
    let start = FlightPath::from(start);
    match flight.case.solver.equations {
        Equations::Cartesian => arrival_of::<Cartesian, _>(flight, &Cartesian(forces), &start),
        Equations::Spherical => arrival_of::<Spherical, _>(flight, &Spherical(forces), &start),
    }
}

fn arrival_of<F: Formulation, M: System<Dual, 6>>(
    flight: &Trajectory,
    motion: &M,
    start: &FlightPath<Dual>,
) -> SVector<Dual, 5> {
    let mut end = follow(motion, F::coordinates(&start.to_planet_fixed()), &flight.steps);
    let mut time = Dual::from(flight.end_time());
    let crosses = flight.termination() == Termination::SurfaceImpact && !flight.steps.is_empty();
    if crosses {
        let rates = motion.derivative(&end);
        let delay = crossing_delay::<F>(&flight.case, &end, &rates);
        time += delay;
        end = std::array::from_fn(|i| end[i] + rates[i] * delay);
    }
    let FlightPath { longitude, geocentric_latitude, speed, flight_path_angle, .. } =
        FlightPath::from_planet_fixed(&F::planet_fixed(&end));
    [time, longitude, geocentric_latitude, speed, flight_path_angle].into()
}

/// How much later the stop altitude is crossed as the numbers vary: a step of Newton's method, -h/ḣ, of value zero.
fn crossing_delay<F: Formulation>(case: &Case, end: &[Dual; 6], rates: &[Dual; 6]) -> Dual {
    let altitude = case.planet.shape.altitude(&F::planet_fixed(end).position);
    let moving = crate::motion::moving(&end.map(Scalar::value), &rates.map(Scalar::value));
    let climb = case.planet.shape.altitude(&F::planet_fixed(&moving).position).eps;
    -(altitude - altitude.value()) * climb.recip()
}
