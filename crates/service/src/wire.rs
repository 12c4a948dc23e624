//! The JSON of the API and its translation to and from the core; angles and calendars are converted here and nowhere else.
//!
//! A request is parsed to a tree ([`json::parse`]) and read by the descriptions of its objects, with every fault noted
//! ([`description::read`]). The descriptions yield the core's types, whose own checks see what concerns several fields, and they write
//! the schemas of the requests ([`request_schemas`]).

pub mod description;
pub mod json;
pub mod reader;
pub mod schema;
pub mod shown;
pub mod sites;
pub mod space_weather;

pub mod aerodynamics;
pub mod atmosphere;
pub mod commands;
pub mod control;
pub mod epoch;
pub mod events;
pub mod heating;
pub mod names;
pub mod parts;
pub mod planet;
pub mod state;
pub mod steering;
pub mod vehicle;
pub mod wind;

pub mod analytic;
pub mod batch;
pub mod bodies;
pub mod columns;
pub mod convert;
pub mod corridor;
pub mod dispersions;
pub mod ephemeris;
pub mod footprint;
pub mod numbers;
pub mod outputs;
pub mod requirements;
pub mod scenario;
pub mod search;
pub mod sensitivities;
pub mod target;
pub mod track;
pub mod trajectory;
pub mod vary;
pub mod verification;
pub mod warning;

use std::fmt;

use description::{Words, schemas, word};
use schema::Components;

use reentry::number_text::NumberText;
use serde::Serialize;

/// The schemas of requests and of all that is in them, by their names.
pub fn request_schemas() -> Components {
    let mut components = Components::new();
    schemas(&mut components, scenario::simulate_request);
    schemas(&mut components, analytic::analytic_request);
    schemas(&mut components, convert::convert_request);
    schemas(&mut components, corridor::corridor_request);
    schemas(&mut components, footprint::footprint_request);
    schemas(&mut components, target::target_request);
    components
}

/// The unit of every angle of a request and of its answer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum AngleUnit {
    /// Radians.
    #[default]
    Rad,
    /// Degrees.
    Deg,
}

/// The words for units of angles.
const ANGLE_UNITS: Words<AngleUnit> = Words {
    name: "AngleUnit",
    doc: "Unit of every angle in a request and in its response.",
    words: &[
        word("rad", AngleUnit::Rad, "Radians").doc("Radians."),
        word("deg", AngleUnit::Deg, "Degrees").doc("Degrees."),
    ],
};

impl AngleUnit {
    /// An angle of the request, in radians.
    pub fn to_radians(self, angle: f64) -> f64 {
        match self {
            Self::Rad => angle,
            Self::Deg => angle.to_radians(),
        }
    }

    /// An angle in radians, as the answer gives it.
    pub fn from_radians(self, angle: f64) -> f64 {
        match self {
            Self::Rad => angle,
            Self::Deg => angle.to_degrees(),
        }
    }

    /// An angle in [0, 2π) radians, as the answer gives it: rounding must not carry it to a full turn.
    pub fn turn_from_radians(self, angle: f64) -> f64 {
        match self {
            Self::Deg if angle.to_degrees() >= 360.0 => 0.0,
            _ => self.from_radians(angle),
        }
    }
}

/// An angle in radians, for people: in the unit of the request, which it names.
#[derive(Clone, Copy, Debug)]
pub struct Angle(pub f64, pub AngleUnit);

impl fmt::Display for Angle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self(angle, unit) = *self;
        let angle = NumberText(unit.from_radians(angle));
        match unit {
            AngleUnit::Rad => write!(f, "{angle} rad"),
            AngleUnit::Deg => write!(f, "{angle}°"),
        }
    }
}
