//! How what a flight gives depends on the numbers of its case: derivatives of its end, its events and its peaks, their times included.
//!
//! The steps of the flight are followed once more in dual numbers, with six derivatives at a time. A number is
//! a [`Variation`]: the case with the number moved a little, so that any number of any case can vary, whatever it stands for.

mod follow;
mod outputs;
mod variation;
mod varied_forces;

pub use outputs::{Moment, Moved, Output, Slopes, point_at, slopes};
pub use variation::Variation;

use crate::atmosphere::Atmosphere;
use crate::coordinates::{FlightPath, PlanetFixed};
use crate::elementary::cos;
use crate::event::{Quantity, Trigger};
use crate::interrupt::Interrupt;
use crate::scenario::{Case, dispatch};
use crate::simulate::SimulationError;
use crate::trajectory::Trajectory;
use crate::vehicle::Aerodynamics;
use follow::{Follow, Place};
use variation::{Dual, VariedCase};

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

/// The numbers of a [`Gradient`] that vary: six of the initial state, and six others, of the two of the density the product.
const INPUTS: usize = 12;

/// Derivatives that are followed at once: where more are asked for, the flight is followed several times. Each width is a program of its own, and
/// long to compile.
const WIDTH: usize = 6;

/// A flight that ends this near (in parts of a right angle's sine, or of the circular speed) to where an angle or the speed has no
/// slope has none: what is computed there is rounding.
const UNDEFINED: f64 = 1e-6;

/// The derivatives of the arrival of a flight by the numbers of a [`Gradient`].
///
/// # Errors
/// When the flag is raised, at which it looks before every step.
pub fn sensitivities(flight: &Trajectory, interrupt: &dyn Interrupt) -> Result<Sensitivities, SimulationError> {
    let case = &flight.case;
    let variations = of_gradient(case);
    let held = case.state_layout_with(waits_for_heat_load(case));
    // Of the time, the longitude, the latitude, the speed and the flight-path angle.
    let mut slopes = [[f64::NAN; INPUTS]; 5];
    for (pass, variations) in variations.chunks(WIDTH).enumerate() {
        let first = pass * WIDTH;
        let follow = Follow {
            flight,
            varied: VariedCase { case, variations, start: Some(start_of_gradient(case, first)) },
            changes_models: &[false; WIDTH],
            places: &[Place::End],
            with_ground_distance: false,
            interrupt,
        };
        let samples = dispatch(case.solver.equations, held, follow)?;
        let Some(Some(end)) = samples.first() else { continue };
        let FlightPath { longitude, geocentric_latitude, speed, flight_path_angle, .. } =
            FlightPath::from_planet_fixed(&end.state.planet_fixed());
        let outputs = [end.time, longitude, geocentric_latitude, speed, flight_path_angle];
        for (row, output) in slopes.iter_mut().zip(outputs) {
            for (index, slope) in row[first..].iter_mut().take(WIDTH).enumerate() {
                *slope = variation::slope(&output, index);
            }
        }
    }
    let is_ballistic = case.vehicle.is_ballistic();
    let gradient = |output: usize| {
        let [mass, reference_area, lift_coefficient, drag_coefficient, bank_angle, density, state @ ..] =
            slopes[output];
        let unless_ballistic = |slope: f64| if is_ballistic { f64::NAN } else { slope };
        let [surface_density, density_factor] = of_density(case, density);
        Gradient {
            mass,
            reference_area: unless_ballistic(reference_area),
            lift_coefficient: unless_ballistic(lift_coefficient),
            drag_coefficient: unless_ballistic(drag_coefficient),
            bank_angle,
            surface_density,
            density_factor,
            initial_state: state.into(),
        }
    };
    let defined = |output, size: f64| if size > UNDEFINED { gradient(output) } else { Gradient::NONE };
    let last = flight.last().flight_path;
    let planet = &case.planet;
    let moving = last.speed / (planet.gravitational_parameter / planet.equatorial_radius()).sqrt();
    let off_axis = cos(last.geocentric_latitude);
    Ok(Sensitivities {
        time: gradient(0),
        longitude: defined(1, off_axis),
        geocentric_latitude: defined(2, off_axis),
        speed: defined(3, moving),
        flight_path_angle: defined(4, moving.min(cos(last.flight_path_angle))),
    })
}

/// The variations of the numbers of a gradient.
fn of_gradient(case: &Case) -> Vec<Variation> {
    let vary = |size: f64, moved: &dyn Fn(&mut Case, f64)| {
        let moved = |offset: f64| {
            let mut case = case.clone();
            moved(&mut case, offset);
            Some(case)
        };
        // Any offset gives a case.
        Variation::new(STEP * size, moved).unwrap_or_else(|| Variation::of_offset(0))
    };
    let mut variations = vec![
        vary(case.vehicle.mass, &|case, offset| case.vehicle.mass += offset),
        vary(1.0, &|case, offset| case.vehicle.reference_area += offset),
    ];
    for coefficient in [0, 1] {
        variations.push(match case.vehicle.aerodynamics {
            Aerodynamics::Constant { .. } => vary(1.0, &|case, offset| {
                if let Aerodynamics::Constant { lift_coefficient, drag_coefficient } = &mut case.vehicle.aerodynamics {
                    *[lift_coefficient, drag_coefficient][coefficient] += offset;
                }
            }),
            // To a table it is added; of ratios there is none.
            _ => Variation::of_offset(coefficient),
        });
    }
    variations.push(Variation::of_offset(2));
    variations.push(vary(1.0, &|case, offset| match &mut case.atmosphere {
        Atmosphere::Exponential { surface_density, .. } if case.density_factor != 0.0 => *surface_density += offset,
        _ => case.density_factor += offset,
    }));
    // Those of the initial state stand beside it.
    variations.extend(std::iter::repeat_with(Variation::of_nothing).take(6));
    variations
}

/// The initial state, with its derivatives by those of the numbers of a gradient that follow the `first`; the last six are of it.
fn start_of_gradient(case: &Case, first: usize) -> PlanetFixed<Dual<WIDTH>> {
    let path: [f64; 6] = FlightPath::from_planet_fixed(&case.initial_state).into();
    let number = |index: usize| {
        let slope = |input: usize| if first + input == INPUTS - 6 + index { 1.0 } else { 0.0 };
        VariedCase::<WIDTH>::dual(path[index], std::array::from_fn(slope))
    };
    FlightPath::from(std::array::from_fn(number)).to_planet_fixed()
}

/// The step of a variation, in parts of the size of the number: the differences of fourth order then are as exact as rounding allows.
const STEP: f64 = 1e-3;

/// The slopes by the density at altitude 0 and by the density factor, from that by whichever of them varied.
fn of_density(case: &Case, slope: f64) -> [f64; 2] {
    match case.atmosphere.surface_density() {
        Some(surface_density) if case.density_factor != 0.0 => [slope, slope * surface_density / case.density_factor],
        Some(_) => [0.0, slope],
        None => [f64::NAN, slope],
    }
}

/// Whether anything in the flight depends on the heat load, so that it has to be followed along.
fn waits_for_heat_load(case: &Case) -> bool {
    let triggers = case.events.iter().map(|event| &event.when).chain(&case.stop.when);
    triggers.filter_map(Trigger::condition).any(|condition| condition.quantity == Quantity::HeatLoad)
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
