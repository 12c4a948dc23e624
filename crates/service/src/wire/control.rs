//! How the vehicle of a request is flown.

use std::sync::Arc;

use reentry::control::{
    Against as CoreAgainst, Command as CoreCommand, Control as CoreControl, Interpolation as CoreInterpolation,
    Schedule as CoreSchedule,
};
use reentry::scenario::Bound;
use serde::Serialize;
use utoipa::openapi::schema::{ObjectBuilder, OneOfBuilder, RefBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::AngleUnit;
use super::reader::{MOST_ENTRIES, Object};

/// How the vehicle is flown: each angle a number, or by a schedule.
#[derive(Clone, Debug, ToSchema)]
pub struct Control {
    /// 0: lift upward in the plane of radius and velocity; positive tilts it to the left of the flight direction.
    #[schema(required = false, default = 0)]
    pub bank_angle: Command,
    /// On which the coefficients of an `alpha_mach_table` depend, and no other.
    #[schema(required = false, default = 0)]
    pub angle_of_attack: Command,
}

/// An angle during the flight.
#[derive(Clone, Debug)]
pub enum Command {
    /// The same all the time.
    Constant(f64),
    /// By a schedule.
    Schedule(Schedule),
}

impl PartialSchema for Command {
    fn schema() -> RefOr<Schema> {
        let angle = ObjectBuilder::new()
            .schema_type(Type::Number)
            .minimum(Some(-360.0))
            .maximum(Some(360.0))
            .description(Some("The same all the time, within ±2π (±360°)."));
        let schedule = RefBuilder::new().ref_location_from_schema_name(Schedule::name());
        OneOfBuilder::new()
            .item(angle)
            .item(schedule)
            .description(Some("An angle during the flight: a number, or a schedule."))
            .into()
    }
}

impl ToSchema for Command {
    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        schemas.push((Schedule::name().into(), Schedule::schema()));
        Schedule::schemas(schemas);
    }
}

/// An angle along a quantity of the flight; before the first entry and after the last their values hold. Both lists have as many.
// The numbers stand here for the schema; what flies is `core`.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Schedule {
    /// `schedule`, which tells it from a number.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// What it runs along.
    pub against: Against,
    /// Ascending, in the unit of the quantity; time, speed and Mach number at least 0.
    #[schema(min_items = 1, max_items = 10_000)]
    pub at: Vec<f64>,
    /// The angles there, within ±2π (±360°).
    #[schema(min_items = 1, max_items = 10_000)]
    pub value: Vec<f64>,
    /// What it does between its entries.
    #[schema(required = false, default = "linear")]
    pub interpolation: Interpolation,
    /// The same, for the core.
    #[serde(skip)]
    #[schema(ignore)]
    pub core: Arc<CoreSchedule>,
}

/// What a schedule runs along.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Against {
    /// Since the start, s.
    Time,
    /// Along the radius vector, m.
    Altitude,
    /// Relative to the rotating planet, m/s.
    Speed,
    /// The speed relative to the air over that of sound; needs an atmosphere that has a speed of sound.
    Mach,
}

/// What a schedule does between its entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// An entry's value holds from it up to the next greater one.
    Step,
}

impl Control {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let bank_angle = Command::read(object, "bank_angle");
        let angle_of_attack = Command::read(object, "angle_of_attack");
        Some(Self { bank_angle: bank_angle?, angle_of_attack: angle_of_attack? })
    }

    pub(super) fn to_core(&self, unit: AngleUnit) -> CoreControl {
        CoreControl { bank_angle: self.bank_angle.to_core(unit), angle_of_attack: self.angle_of_attack.to_core(unit) }
    }
}

impl Command {
    fn read(object: &mut Object, name: &'static str) -> Option<Self> {
        object.fill(name, 0.0.into());
        object.number_or_object(
            name,
            "an object with a schedule",
            |object| object.angle(name, Bound::TURN).map(Self::Constant),
            |object| Schedule::read(object).map(Self::Schedule),
        )
    }

    fn to_core(&self, unit: AngleUnit) -> CoreCommand {
        match self {
            Self::Constant(angle) => CoreCommand::Constant(unit.to_radians(*angle)),
            Self::Schedule(schedule) => CoreCommand::Schedule(Arc::clone(&schedule.core)),
        }
    }

    /// Whether it is anything but 0 all the time.
    pub fn is_given(&self) -> bool {
        !matches!(self, Self::Constant(angle) if *angle == 0.0)
    }
}

impl Schedule {
    fn read(object: &mut Object) -> Option<Self> {
        object.choice("type", &[("schedule", ())])?;
        let quantities = [
            ("time", Against::Time),
            ("altitude", Against::Altitude),
            ("speed", Against::Speed),
            ("mach", Against::Mach),
        ];
        let against = object.choice("against", &quantities);
        let bound = match against {
            Some(Against::Altitude) => Bound::DISTANCE,
            Some(Against::Time | Against::Speed | Against::Mach) => Bound::NON_NEGATIVE,
            None => Bound::FINITE,
        };
        let at = object.entries("at", bound, [1, MOST_ENTRIES]).filter(|at| object.ascending("at", "", at));
        let value = object.angles("value", Bound::TURN, MOST_ENTRIES);
        let sound = object.equally_long("at", &["value"]);
        let ways = [("linear", Interpolation::Linear), ("step", Interpolation::Step)];
        let interpolation = object.choice_or("interpolation", &ways, "linear");
        let (against, at, value, interpolation, unit) = (against?, at?, value?, interpolation?, object.unit()?);
        if !sound {
            return None;
        }
        let radians: Vec<_> = value.iter().map(|angle| unit.to_radians(*angle)).collect();
        let core = CoreSchedule::new(against.to_core(), &at, &radians, interpolation.to_core());
        let core = Arc::new(object.sound(core)?);
        Some(Self { kind: "schedule", against, at, value, interpolation, core })
    }
}

impl Against {
    fn to_core(self) -> CoreAgainst {
        match self {
            Self::Time => CoreAgainst::Time,
            Self::Altitude => CoreAgainst::Altitude,
            Self::Speed => CoreAgainst::Speed,
            Self::Mach => CoreAgainst::Mach,
        }
    }
}

impl Interpolation {
    fn to_core(self) -> CoreInterpolation {
        match self {
            Self::Linear => CoreInterpolation::Linear,
            Self::Step => CoreInterpolation::Step,
        }
    }
}
