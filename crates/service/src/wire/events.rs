//! The events of a request, and the conditions that let them happen or end the flight.

use reentry::event::{
    Condition as CoreCondition, Direction, Effect as CoreEffect, Engine, Event as CoreEvent, Quantity as CoreQuantity,
    Trigger,
};
use reentry::propulsion::{Axis as CoreAxis, Impulse, Thrust as CoreThrust};
use reentry::scenario::Bound;
use serde::Serialize;
use serde_json::json;
use utoipa::openapi::schema::{ObjectBuilder, OneOfBuilder, RefBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::AngleUnit;
use super::json::shown;
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

/// A quantity passes a value, downwards or upwards, or so much time has passed since another event.
///
/// A condition on a quantity is met at the first instant at which the quantity, having been on the near side, is on the value or beyond,
/// whether it moved there or jumped, as the load factor does where a parachute opens. A quantity that begins on the value meets it at
/// once if it moves on to the far side, however slowly; one that begins beyond must come back first.
#[derive(Clone, Debug, ToSchema)]
pub struct Condition {
    /// Which quantity passes the value.
    #[schema(required = false, value_type = Quantity)]
    pub quantity: Option<CoreQuantity>,
    /// The value, from above, in the unit of the quantity; an angle in `angle_unit`. Not for time.
    #[schema(required = false, value_type = f64)]
    pub falls_through: Option<f64>,
    /// The value, from below, in the unit of the quantity; an angle in `angle_unit`.
    #[schema(required = false, value_type = f64)]
    pub rises_through: Option<f64>,
    /// The name of another event, which happens before.
    #[schema(required = false, value_type = String)]
    pub event: Option<String>,
    /// Seconds after that event.
    #[schema(required = false, value_type = f64, minimum = 0, maximum = 1e9, default = 0)]
    pub delay: Option<f64>,
}

/// What may pass a value, with its name and its meaning.
pub static QUANTITIES: [(&str, CoreQuantity, &str); 21] = [
    ("time", CoreQuantity::Time, "since the start, s"),
    ("altitude", CoreQuantity::Altitude, "along the radius vector, m"),
    ("speed", CoreQuantity::Speed, "relative to the rotating planet, m/s"),
    (
        "mach",
        CoreQuantity::Mach,
        "the speed relative to the air over that of sound; needs an atmosphere that has a speed of sound",
    ),
    ("dynamic_pressure", CoreQuantity::DynamicPressure, "½ρV² of the speed relative to the air, Pa"),
    ("load_factor", CoreQuantity::LoadFactor, "lift, drag and thrust over mass and 9.80665 m/s²"),
    ("flight_path_angle", CoreQuantity::FlightPathAngle, "of the velocity relative to the planet"),
    ("mass", CoreQuantity::Mass, "of the vehicle, kg"),
    ("air_speed", CoreQuantity::AirSpeed, "relative to the air, m/s"),
    ("inertial_speed", CoreQuantity::InertialSpeed, "relative to inertial space, m/s"),
    (
        "specific_energy",
        CoreQuantity::SpecificEnergy,
        "half the squared inertial speed and the potential of gravity, J/kg",
    ),
    (
        "apoapsis_altitude",
        CoreQuantity::ApoapsisAltitude,
        "of the osculating orbit, above the equatorial radius, m; 1e13 m where it is not bound",
    ),
    ("periapsis_altitude", CoreQuantity::PeriapsisAltitude, "of the osculating orbit, above the equatorial radius, m"),
    ("inclination", CoreQuantity::Inclination, "of the osculating orbit to the equator"),
    ("heat_flux", CoreQuantity::HeatFlux, "into the stagnation point, W/m²; needs heating"),
    ("heat_load", CoreQuantity::HeatLoad, "into the stagnation point since the start, J/m²; needs heating"),
    (
        "wall_temperature",
        CoreQuantity::WallTemperature,
        "at which the wall radiates as much as it gets, K; needs heating",
    ),
    (
        "downrange",
        CoreQuantity::Downrange,
        "along the great circle of the initial heading, m; needs an initial heading",
    ),
    ("ground_range", CoreQuantity::GroundRange, "great-circle distance from the initial ground point, m"),
    ("deceleration", CoreQuantity::Deceleration, "-dV/dt of the speed relative to the planet, m/s²"),
    ("density", CoreQuantity::Density, "of the air, kg/m³"),
];

/// The schema of a name in [`QUANTITIES`].
pub struct Quantity;

impl PartialSchema for Quantity {
    fn schema() -> RefOr<Schema> {
        let meanings: Vec<_> = QUANTITIES.iter().map(|(name, _, meaning)| format!("`{name}`: {meaning}")).collect();
        ObjectBuilder::new()
            .schema_type(Type::String)
            .enum_values(Some(QUANTITIES.map(|(name, ..)| name)))
            .description(Some(format!("What may pass a value. {}.", meanings.join(". "))))
            .into()
    }
}

impl ToSchema for Quantity {}

/// What an event changes, from its instant on; what is left out stays as it is.
#[derive(Clone, Debug, Default, ToSchema)]
pub struct Effect {
    /// kg. A ballistic coefficient changes with it: the drag area stays.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0)]
    pub mass: Option<f64>,
    /// m². Not beside ballistic aerodynamics, nor where the vehicle has them and no event gives others.
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

    pub(super) fn to_core(&self, unit: AngleUnit, events: &[Self]) -> CoreEvent {
        CoreEvent { when: self.when.to_core(unit, events), then: self.then.to_core() }
    }

    /// Whether it may change the mass.
    pub fn changes_mass(&self) -> bool {
        self.then.mass.is_some() || self.then.thrust.is_some()
    }

    /// Of a vehicle without an area: coefficients that would refer to one, and areas to which no coefficient ever refers.
    pub(super) fn area_faults(events: &[Self], vehicle: &Vehicle) -> Vec<Fault> {
        if vehicle.reference_area.is_some() {
            return Vec::new();
        }
        let by_area = |Self { then, .. }: &Self| {
            then.aerodynamics.as_ref().is_some_and(|aerodynamics| !matches!(aerodynamics, Aerodynamics::Ballistic(_)))
        };
        let ever = events.iter().any(by_area);
        let fault = |(index, event): (usize, &Self)| {
            let detail = match event.then.reference_area {
                None if by_area(event) => {
                    "is required: the ballistic vehicle has no area to which these coefficients could refer"
                }
                Some(_) if !ever => {
                    "must be left out: the vehicle is ballistic, and no event gives it coefficients of an area"
                }
                _ => return None,
            };
            Some(Fault::new(format!("/events/{index}/then/reference_area"), detail))
        };
        events.iter().enumerate().filter_map(fault).collect()
    }
}

impl Condition {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let Some(way) = object.exactly_one(&["quantity", "event"]) else {
            // Which of the others belong here is not known.
            for name in ["falls_through", "rises_through", "delay"] {
                object.has(name);
            }
            return None;
        };
        if way == "event" {
            let event = object.optional_string("event");
            let delay = object.number_or("delay", Bound::TIME, 0.0);
            return Some(Self {
                quantity: None,
                falls_through: None,
                rises_through: None,
                event: Some(event?),
                delay: Some(delay?),
            });
        }
        let quantity = object.choice("quantity", &QUANTITIES.map(|(name, quantity, _)| (name, quantity)));
        let way = object.exactly_one(&["falls_through", "rises_through"])?;
        let quantity = quantity?;
        let value = if quantity.is_angle() {
            object.angle(way, quantity.bound())
        } else {
            object.number(way, quantity.bound())
        };
        let (falls_through, rises_through) =
            if way == "falls_through" { (Some(value?), None) } else { (None, Some(value?)) };
        Some(Self { quantity: Some(quantity), falls_through, rises_through, event: None, delay: None })
    }

    /// The core's trigger; one that waits for an event of no name in the list waits for one beyond its end.
    pub(super) fn to_core(&self, unit: AngleUnit, events: &[Event]) -> Trigger {
        let Some(quantity) = self.quantity else {
            let named = |event: &Event| event.name.is_some() && event.name == self.event;
            let event = events.iter().position(named).unwrap_or(events.len());
            return Trigger::After { event, delay: self.delay.unwrap_or_default() };
        };
        let (value, direction) = match (self.falls_through, self.rises_through) {
            (Some(value), _) => (value, Direction::Falling),
            (None, value) => (value.unwrap_or_default(), Direction::Rising),
        };
        let value = if quantity.is_angle() { unit.to_radians(value) } else { value };
        CoreCondition { quantity, value, direction }.into()
    }

    /// The name of an event that is waited for, which must be that of one event alone; `place` is that of the condition.
    pub(super) fn name_fault(&self, place: &str, events: &[Event]) -> Option<Fault> {
        let name = self.event.as_deref()?;
        let named = events.iter().filter(|event| event.name.as_deref() == Some(name)).count();
        let detail = match named {
            0 => format!("must be the name of an event of the case, got {}", shown(&json!(name))),
            1 => return None,
            _ => format!("must be the name of one event, got {}, the name of {named}", shown(&json!(name))),
        };
        Some(Fault::new(format!("{place}/event"), detail))
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
