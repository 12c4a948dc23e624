//! The physics of the core: each test against something independent.

pub(crate) mod flights;
mod footprint;
pub(crate) mod rockets;

mod analytic;
mod ascent;
mod atmosphere;
mod bodies;
mod conversions;
mod corridor;
mod departures;
mod dispersions;
mod elsewhere;
mod events;
mod extremes;
mod gas;
mod gravity;
mod ground_track;
mod heating;
mod integrator;
mod model_modes;
mod nrlmsise00;
mod number_types;
mod parachutes;
mod part_slopes;
mod parts;
mod phases;
mod pitfalls;
mod properties;
mod propulsion;
mod schedules;
mod sensitivities;
mod starts;
mod stiffness;
mod tables;
mod target;
mod verification;
