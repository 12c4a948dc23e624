//! The events of a request, and the conditions that let them happen or end the flight.

use reentry::event::{
    Condition as CoreCondition, Direction, Effect as CoreEffect, Engine, Event as CoreEvent, Quantity as CoreQuantity,
};
use reentry::propulsion::{Axis as CoreAxis, Impulse, Thrust as CoreThrust};
use reentry::scenario::Bound;
use serde::Serialize;
use serde_json::json;
use utoipa::openapi::schema::{ObjectBuilder, OneOfBuilder, RefBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::AngleUnit;
use super::reader::{Fault, Object};
use super::vehicle::{Aerodynamics, Vehicle};

/// The greatest number of events, and of conditions that end a flight.
pub const MOST_EVENTS: usize = 1000;

/// Something that happens once: at the first instant at which its condition is met, and never again. Events of one instant happen in the
/// order of their list, each on what the ones before it have made.
#[derive(Clone, Debug, ToSchema)]
pub struct Event {
    /// Given back in the answer.
    #[schema(required = false)]
    pub name: Option<String>,
    /// When.
    pub when: Condition,
    /// What it changes; without anything it is a mark, whose state the answer tells.
    #[schema(required = false)]
    pub then: Effect,
}

/// A quantity passes a value, downwards or upwards: exactly one of these.
///
/// Met at the first instant at which the quantity, having been on the near side, is on the value or beyond, whether it moved there or
/// jumped, as the load factor does where a parachute opens. A quantity that begins on the value meets it where it moves on; one that
/// begins beyond must come back first.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Condition {
    /// Which.
    pub quantity: Quantity,
    /// The value, from above, in the unit of the quantity; an angle in `angle_unit`. Not for time.
    #[schema(required = false, value_type = f64)]
    pub falls_through: Option<f64>,
    /// The value, from below, in the unit of the quantity; an angle in `angle_unit`.
    #[schema(required = false, value_type = f64)]
    pub rises_through: Option<f64>,
}

/// What may pass a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Quantity {
    /// Since the start, s.
    Time,
    /// Along the radius vector, m.
    Altitude,
    /// Relative to the rotating planet, m/s.
    Speed,
    /// The speed relative to the air over that of sound; needs an atmosphere that has a temperature.
    Mach,
    /// ½ρV² of the speed relative to the air, Pa.
    DynamicPressure,
    /// Lift, drag and thrust over mass and 9.80665 m/s².
    LoadFactor,
    /// Of the velocity relative to the planet.
    FlightPathAngle,
}

/// What an event changes, from its instant on; what is left out stays as it is.
#[derive(Clone, Debug, Default, ToSchema)]
pub struct Effect {
    /// kg. A ballistic coefficient changes with it: the drag area stays.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0)]
    pub mass: Option<f64>,
    /// m². Not beside ballistic aerodynamics.
    #[schema(required = false, value_type = f64, minimum = 0)]
    pub reference_area: Option<f64>,
    /// Lift and drag.
    #[schema(required = false, value_type = Aerodynamics)]
    pub aerodynamics: Option<Aerodynamics>,
    /// An impulsive change of velocity. It takes no propellant: give the mass after it as `mass`.
    #[schema(required = false, value_type = DeltaV)]
    pub delta_v: Option<DeltaV>,
    /// A constant thrust, which is switched on, or `"off"`.
    #[schema(required = false, value_type = ThrustCommand)]
    pub thrust: Option<ThrustCommand>,
}

/// A change of velocity at an instant.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct DeltaV {
    /// Where to.
    pub along: Axis,
    /// m/s; negative against the direction, as a deorbit burn along the velocity is.
    #[schema(minimum = -1e6, maximum = 1e6)]
    pub value: f64,
}

/// A constant thrust, switched on in place of one that burns. It ends where it is switched off, or where its propellant is spent.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Thrust {
    /// Where to, at every instant.
    pub along: Axis,
    /// N; negative against the direction, as a retro burn along the velocity is.
    #[schema(minimum = -1e12, maximum = 1e12)]
    pub value: f64,
    /// s: the mass falls by |value|/(9.80665 m/s² `specific_impulse`) a second.
    #[schema(minimum = 1e-3, maximum = 1e9)]
    pub specific_impulse: f64,
    /// How much there is to burn, kg; without it, the thrust burns until it is switched off.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0)]
    pub propellant: Option<f64>,
}

/// A direction that moves with the vehicle.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Axis {
    /// Along the velocity relative to the rotating planet.
    Velocity,
    /// Away from the planet's centre.
    Radial,
    /// Across both, level, to the left of the flight direction.
    Normal,
}

/// What becomes of the thrust.
#[derive(Clone, Copy, Debug)]
pub enum ThrustCommand {
    /// It is switched on.
    On(Thrust),
    /// It is switched off.
    Off,
}

impl PartialSchema for ThrustCommand {
    fn schema() -> RefOr<Schema> {
        let off = ObjectBuilder::new()
            .schema_type(Type::String)
            .enum_values(Some(["off"]))
            .description(Some("The thrust is switched off."));
        let on = RefBuilder::new().ref_location_from_schema_name(Thrust::name());
        let description = "What becomes of the thrust: another one, or `\"off\"`.";
        OneOfBuilder::new().item(on).item(off).description(Some(description)).into()
    }
}

impl ToSchema for ThrustCommand {
    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        schemas.push((Thrust::name().into(), Thrust::schema()));
        Thrust::schemas(schemas);
    }
}

impl Event {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let name = object.optional_string("name");
        let when = object.object("when", Condition::read);
        let then = object.object_or("then", json!({}), Effect::read);
        Some(Self { name, when: when?, then: then? })
    }

    pub(super) fn to_core(&self, unit: AngleUnit) -> CoreEvent {
        CoreEvent { when: self.when.to_core(unit), then: self.then.to_core() }
    }

    /// Whether it may change the mass.
    pub fn changes_mass(&self) -> bool {
        self.then.mass.is_some() || self.then.thrust.is_some()
    }

    /// Coefficients that refer to an area which nothing tells.
    pub(super) fn missing_areas(events: &[Self], vehicle: &Vehicle) -> Vec<Fault> {
        let refers = |aerodynamics: &Aerodynamics| !matches!(aerodynamics, Aerodynamics::Ballistic(_));
        let lacks =
            |event: &Self| event.then.reference_area.is_none() && event.then.aerodynamics.as_ref().is_some_and(refers);
        let lacking = events.iter().enumerate().filter(|(_, event)| vehicle.reference_area.is_none() && lacks(event));
        let detail = "is required: the ballistic vehicle has no area to which these coefficients could refer";
        lacking.map(|(index, _)| Fault::new(format!("/events/{index}/then/reference_area"), detail)).collect()
    }
}

impl Condition {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let quantities = [
            ("time", Quantity::Time),
            ("altitude", Quantity::Altitude),
            ("speed", Quantity::Speed),
            ("mach", Quantity::Mach),
            ("dynamic_pressure", Quantity::DynamicPressure),
            ("load_factor", Quantity::LoadFactor),
            ("flight_path_angle", Quantity::FlightPathAngle),
        ];
        let quantity = object.choice("quantity", &quantities);
        let way = object.exactly_one(&["falls_through", "rises_through"])?;
        let value = match quantity? {
            Quantity::FlightPathAngle => object.angle(way, Bound::QUARTER_TURN),
            quantity => object.number(way, quantity.to_core().bound()),
        };
        let (falls_through, rises_through) =
            if way == "falls_through" { (Some(value?), None) } else { (None, Some(value?)) };
        Some(Self { quantity: quantity?, falls_through, rises_through })
    }

    pub(super) fn to_core(self, unit: AngleUnit) -> CoreCondition {
        let (value, direction) = match (self.falls_through, self.rises_through) {
            (Some(value), _) => (value, Direction::Falling),
            (None, value) => (value.unwrap_or_default(), Direction::Rising),
        };
        let value = if self.quantity == Quantity::FlightPathAngle { unit.to_radians(value) } else { value };
        CoreCondition { quantity: self.quantity.to_core(), value, direction }
    }
}

impl Quantity {
    fn to_core(self) -> CoreQuantity {
        match self {
            Self::Time => CoreQuantity::Time,
            Self::Altitude => CoreQuantity::Altitude,
            Self::Speed => CoreQuantity::Speed,
            Self::Mach => CoreQuantity::Mach,
            Self::DynamicPressure => CoreQuantity::DynamicPressure,
            Self::LoadFactor => CoreQuantity::LoadFactor,
            Self::FlightPathAngle => CoreQuantity::FlightPathAngle,
        }
    }
}

impl Effect {
    fn read(object: &mut Object) -> Option<Self> {
        let mass = object.optional_number("mass", Bound::POSITIVE);
        let by_area = !object.is_of_kind("aerodynamics", "ballistic");
        let reference_area = if by_area { object.optional_number("reference_area", Bound::NON_NEGATIVE) } else { None };
        let aerodynamics = object.optional_object("aerodynamics", Aerodynamics::read);
        let delta_v = object.optional_object("delta_v", DeltaV::read);
        let off = ("off", ThrustCommand::Off);
        let on = |object: &mut Object| Thrust::read(object).map(ThrustCommand::On);
        let thrust = if object.has("thrust") { object.word_or_object("thrust", off, on).map(Some) } else { Some(None) };
        Some(Self { mass, reference_area, aerodynamics: aerodynamics?, delta_v: delta_v?, thrust: thrust? })
    }

    fn to_core(&self) -> CoreEffect {
        CoreEffect {
            mass: self.mass,
            reference_area: self.reference_area,
            aerodynamics: self.aerodynamics.as_ref().map(Aerodynamics::to_core),
            impulse: self
                .delta_v
                .map(|DeltaV { along, value }| Impulse { along: along.to_core(), speed_change: value }),
            engine: self.thrust.map(ThrustCommand::to_core),
        }
    }
}

impl DeltaV {
    fn read(object: &mut Object) -> Option<Self> {
        let along = Axis::read(object);
        let value = object.number("value", Bound::VELOCITY);
        Some(Self { along: along?, value: value? })
    }
}

impl Thrust {
    fn read(object: &mut Object) -> Option<Self> {
        let along = Axis::read(object);
        let value = object.number("value", Bound::FORCE);
        let specific_impulse = object.number("specific_impulse", Bound::SPECIFIC_IMPULSE);
        let propellant = object.optional_number("propellant", Bound::POSITIVE);
        Some(Self { along: along?, value: value?, specific_impulse: specific_impulse?, propellant })
    }
}

impl ThrustCommand {
    fn to_core(self) -> Engine {
        match self {
            Self::On(Thrust { along, value, specific_impulse, propellant }) => {
                Engine::On(CoreThrust { along: along.to_core(), force: value, specific_impulse, propellant })
            }
            Self::Off => Engine::Off,
        }
    }
}

impl Axis {
    fn read(object: &mut Object) -> Option<Self> {
        object.choice("along", &[("velocity", Self::Velocity), ("radial", Self::Radial), ("normal", Self::Normal)])
    }

    fn to_core(self) -> CoreAxis {
        match self {
            Self::Velocity => CoreAxis::Velocity,
            Self::Radial => CoreAxis::Radial,
            Self::Normal => CoreAxis::Normal,
        }
    }
}
