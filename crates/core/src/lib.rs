//! Flight of a point mass through the atmosphere of a rotating planet.
//!
//! A [`Scenario`] is the question, [`simulate`](simulate::simulate) flies it, a [`Trajectory`] is the answer. The core is a pure
//! function of its arguments: it knows no JSON, no clock, no threads and no files.
//!
//! # Conventions
//!
//! - SI units and radians, everywhere.
//! - Frames: inertial, planet-fixed, and the local horizon; [`coordinates`] draws them once.
//! - Longitude is positive to the east; latitudes are named geocentric or geodetic; the heading counts from east towards north,
//!   the azimuth clockwise from north; the bank angle is positive to the left of the flight direction.
//! - `altitude` is the height along the radius vector, which drives the dynamics; `geodetic_altitude` is that along the normal.
//! - `speed` and `velocity` are relative to the rotating planet unless they are called inertial.
//! - Time counts in seconds from the initial state.
//!
//! # Example
//!
//! ```
//! use std::sync::atomic::AtomicBool;
//!
//! use reentry::{Aerodynamics, Case, Control, FlightPath, Planet, Scenario, Vehicle, simulate};
//!
//! let entry = FlightPath {
//!     radius: 6_500_140.0,
//!     longitude: -1.347_32,
//!     geocentric_latitude: 0.651_76,
//!     speed: 3_007.2,
//!     flight_path_angle: -0.523_599,
//!     heading: 1.195_427,
//! };
//! let vehicle = Vehicle {
//!     mass: 700.0,
//!     reference_area: 0.216_419,
//!     aerodynamics: Aerodynamics::Constant { lift_coefficient: 0.2, drag_coefficient: 0.2 },
//!     nose_radius: None,
//! };
//! let case = Case {
//!     planet: Planet::EARTH_WGS84.spherical(),
//!     control: Control::banked(0.8),
//!     ..Case::new(vehicle, entry.to_planet_fixed())
//! };
//! let flight = simulate(&Scenario::new(case)?, &AtomicBool::new(false))?;
//! assert!((flight.end_time() - 157.436_433).abs() < 1e-6);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! # Glossary
//!
//! | word | meaning |
//! | --- | --- |
//! | case, scenario | a question, and a question that was checked |
//! | phase | a part of the flight during which vehicle, thrust and parachutes stay the same |
//! | mode | of each piecewise model (a table, layers, a schedule) the segment whose formula is in use |
//! | switch | one of the piecewise models, which changes its formula at a boundary between segments |
//! | step | a step of the integrator that was accepted; a stored step is kept with its phase and mode |
//! | detector | what locates the place in a step at which it must end: the stop altitude, a model boundary, a condition |
//! | condition | a quantity that rises or falls through a value |
//! | trigger | a condition, or a time after an event: what an event or a stop waits for |
//! | event | what happens once, at its trigger; its effect changes the vehicle, the engine, a parachute or the velocity |
//! | event record | an event that happened, with the state before and after it |
//! | arrival | the end of a flight: its time, state and termination |
//! | variation | a number of a case that varies, as the case with the number moved a little, several times |
//! | output | a number that a flight gives at a moment; its slopes are its derivatives by variations |
//! | body | a planet or moon whose numbers are known: its gravity, shape, rotation and air |
//! | dispersion | how far a number of a case, or an output, scatters about its own value |
//! | peak | the greatest value of a load or a heat flux, located between the steps |
//!
//! # Reference
//!
//! R. E. Jameson Jr, Development and Validation of Reentry Simulation Using MATLAB, thesis AFIT/GSS/ENY/06-M08, Air Force
//! Institute of Technology, March 2006: "Jameson 2006" in these pages, and its errata in the guide of the service.

#![cfg_attr(test, allow(clippy::disallowed_methods, reason = "tests compare with the system's library"))]

pub mod scenario;
pub mod sensitivity;
pub mod simulate;
pub mod solve;
pub mod trajectory;
pub mod verification;

pub mod analytic;

pub mod motion;

pub mod atmosphere;
pub mod body;
pub mod control;
pub mod event;
pub mod heating;
pub mod parachute;
pub mod part;
pub mod planet;
pub mod propulsion;
pub mod steering;
pub mod vehicle;
pub mod wind;

pub mod coordinates;

pub mod elementary;
pub mod integrate;
pub mod interpolation;
pub mod interrupt;
pub mod number_text;
pub mod root;
pub mod scalar;

pub use atmosphere::Atmosphere;
pub use control::Control;
pub use coordinates::{FlightPath, PlanetFixed};
pub use interrupt::Interrupt;
pub use planet::Planet;
pub use scenario::{Case, Scenario, Solver, Stop};
pub use simulate::simulate;
pub use trajectory::Trajectory;
pub use vehicle::{Aerodynamics, Vehicle};
pub use wind::Wind;
