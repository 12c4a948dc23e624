//! The events of a request, and the conditions that let them happen or end the flight.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use reentry::coordinates::Rotation;
use reentry::event::{
    Condition as CoreCondition, Direction, Effect as CoreEffect, Engine, Event as CoreEvent, Quantity as CoreQuantity,
    Trigger,
};
use reentry::parachute::Parachute as CoreParachute;
use reentry::propulsion::{Impulse, Thrust as CoreThrust, ThrustAxis as CoreAxis};
use reentry::scenario::Bound;
use reentry::vehicle::{Aerodynamics, Vehicle};
use serde::Serialize;
use serde_json::json;
use utoipa::openapi::schema::{ObjectBuilder, OneOfBuilder, RefBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::AngleUnit;
use super::description::reading;
use super::reader::{Fault, MOST_FAULTS, Object};
use super::schema::names;
use super::shown::{quoted, shown};
use super::vehicle::aerodynamics;

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
    #[schema(required = false, value_type = names::Aerodynamics)]
    pub aerodynamics: Option<Aerodynamics>,
    /// An impulsive change of velocity. It takes no propellant: give the mass after it as `mass`.
    #[schema(required = false, value_type = DeltaV)]
    pub delta_v: Option<DeltaV>,
    /// A constant thrust, which is switched on, or `"off"`.
    #[schema(required = false, value_type = ThrustCommand)]
    pub thrust: Option<ThrustCommand>,
    /// A parachute that is deployed.
    #[schema(required = false, value_type = Parachute)]
    pub deploy: Option<Parachute>,
    /// The names of parachutes that are cut off, before another is deployed. One that is not deployed then stays as it is, with a warning.
    #[schema(required = false, max_items = 1000)]
    pub release: Vec<String>,
}

/// A parachute, whose drag adds to that of the vehicle, along the velocity relative to the air: of several, all add up.
///
/// Its drag area grows as `drag_area` (t/`inflation_time`)² while it fills: T. W. Knacke, Parachute Recovery Systems Design Manual,
/// NWC TP 6575, 1991, chapter 5, for canopies of solid cloth.
#[derive(Clone, Debug, ToSchema)]
pub struct Parachute {
    /// By which `release` calls it; no two parachutes have the same, since each is deployed once.
    pub name: String,
    /// The drag coefficient times the area of the full canopy, m².
    #[schema(minimum = 0, maximum = 1e9)]
    pub drag_area: f64,
    /// How long it fills, s; 0: it opens at once.
    #[schema(minimum = 0, maximum = 1e9)]
    pub inflation_time: f64,
    /// From the event until it begins to fill, s.
    #[schema(required = false, minimum = 0, maximum = 1e9, default = 0)]
    pub delay: f64,
}

/// A change of velocity at an instant.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct DeltaV {
    /// Where to.
    pub along: Along,
    /// m/s; negative against the direction, as a deorbit burn along the velocity is.
    #[schema(minimum = -1e6, maximum = 1e6)]
    pub value: f64,
}

/// A constant thrust, switched on in place of one that burns. It ends where it is switched off, or where its propellant is spent.
///
/// A thrust against the velocity that is greater than what else moves the vehicle brings it to rest, where it has no direction: switch it
/// off before, or end the flight, for example where the speed falls through 0.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Thrust {
    /// Where to, at every instant.
    pub along: Along,
    /// N; negative against the direction, as a retro burn along the velocity is.
    #[schema(minimum = -1e12, maximum = 1e12)]
    pub value: f64,
    /// s: the mass falls by |value|/(9.80665 m/s² `specific_impulse`) a second; without it, the mass stays.
    #[schema(required = false, value_type = f64, minimum = 1e-3, maximum = 1e9)]
    pub specific_impulse: Option<f64>,
    /// How much there is to burn, kg; without it, the thrust burns until it is switched off. Only with a `specific_impulse`.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0)]
    pub propellant: Option<f64>,
}

/// A direction: one that moves with the vehicle, or one that stays in inertial space.
#[derive(Clone, Copy, Debug)]
pub enum Along {
    /// It moves with the vehicle.
    Axis(Axis),
    /// It stays in inertial space.
    Inertial(InertialDirection),
}

/// A direction that stays in inertial space while the planet turns.
///
/// Its components are those of the inertial frame of the initial state: the `frame` of `eci` vectors and of orbital elements, and for other
/// states that of date, from which the planet is turned by the `sidereal_time`, the `sidereal_angle` or the `epoch`.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct InertialDirection {
    /// The frame.
    pub frame: &'static str,
    /// [x, y, z], of any length but 0.
    pub direction: [f64; 3],
    /// The same, for the core, on the axes of its frame.
    #[schema(ignore)]
    pub core: CoreAxis,
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
    /// Along the level part of the velocity relative to the rotating planet.
    Horizontal,
}

impl PartialSchema for Along {
    fn schema() -> RefOr<Schema> {
        let reference = |name| RefBuilder::new().ref_location_from_schema_name(name);
        let description = "Where to: by a word, or a direction that stays in inertial space.";
        let along = OneOfBuilder::new().item(reference(Axis::name())).item(reference(InertialDirection::name()));
        along.description(Some(description)).into()
    }
}

impl ToSchema for Along {
    fn schemas(schemas: &mut Vec<(String, RefOr<Schema>)>) {
        schemas.push((Axis::name().into(), Axis::schema()));
        schemas.push((InertialDirection::name().into(), InertialDirection::schema()));
    }
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

    pub(super) fn to_core(&self, unit: AngleUnit, events: &[Self], among: &Among) -> CoreEvent {
        CoreEvent { when: self.when.to_core(unit, events), then: self.then.to_core(among) }
    }

    /// Whether it may change the mass.
    pub fn changes_mass(&self) -> bool {
        let burns =
            |thrust: &ThrustCommand| matches!(thrust, ThrustCommand::On(thrust) if thrust.specific_impulse.is_some());
        self.then.mass.is_some() || self.then.thrust.as_ref().is_some_and(burns)
    }

    /// Whether it pushes the vehicle along a direction that stays in inertial space.
    fn is_inertial(&self) -> bool {
        let along = [
            self.then.delta_v.map(|delta_v| delta_v.along),
            self.then.thrust.and_then(|thrust| match thrust {
                ThrustCommand::On(thrust) => Some(thrust.along),
                ThrustCommand::Off => None,
            }),
        ];
        along.into_iter().flatten().any(|along| matches!(along, Along::Inertial(_)))
    }

    /// Inertial directions on a planet whose angle nobody knows: an epoch says nothing about it, and the state does not give it.
    pub(super) fn frame_faults(events: &[Self], is_angle_known: bool) -> Vec<Fault> {
        let detail = "is required by the inertial direction of an event: an epoch says nothing about the angle of a custom planet; give \
                      sidereal_time or sidereal_angle";
        let unknown = !is_angle_known && events.iter().any(Self::is_inertial);
        unknown.then(|| Fault::new("/initial_state/sidereal_time", detail)).into_iter().collect()
    }

    /// Parachutes that share a name, and names of those that are cut off and never deployed.
    pub(super) fn parachute_faults(events: &[Self]) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut deployed: HashMap<&str, usize> = HashMap::new();
        for (index, Self { then, .. }) in events.iter().enumerate() {
            let Some(Parachute { name, .. }) = &then.deploy else { continue };
            match deployed.entry(name) {
                Entry::Vacant(entry) => _ = entry.insert(index),
                Entry::Occupied(first) => {
                    let detail = format!(
                        "must be a name of its own: a parachute is deployed once, this one by event {}",
                        first.get()
                    );
                    faults.push(Fault::new(format!("/events/{index}/then/deploy/name"), detail));
                }
            }
        }
        for (index, Self { then, .. }) in events.iter().enumerate() {
            for (place, name) in
                then.release.iter().enumerate().filter(|(_, name)| !deployed.contains_key(name.as_str()))
            {
                let got = quoted(name);
                let detail = format!("must be the name of a parachute that an event deploys, got {got}");
                faults.push(Fault::new(format!("/events/{index}/then/release/{place}"), detail));
                if faults.len() > MOST_FAULTS {
                    return faults;
                }
            }
        }
        faults
    }

    /// Of a vehicle without an area: coefficients that would refer to one, and areas to which no coefficient ever refers.
    pub(super) fn area_faults(events: &[Self], vehicle: &Vehicle) -> Vec<Fault> {
        if !matches!(vehicle.aerodynamics, Aerodynamics::Ballistic { .. }) {
            return Vec::new();
        }
        let by_area = |Self { then, .. }: &Self| {
            then.aerodynamics
                .as_ref()
                .is_some_and(|aerodynamics| !matches!(aerodynamics, Aerodynamics::Ballistic { .. }))
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
        let aerodynamics = object.optional_object("aerodynamics", |object| reading(object, aerodynamics));
        let delta_v = object.optional_object("delta_v", DeltaV::read);
        let off = ("off", ThrustCommand::Off);
        let on = |object: &mut Object| Thrust::read(object).map(ThrustCommand::On);
        let thrust = if object.has("thrust") { object.word_or_object("thrust", off, on).map(Some) } else { Some(None) };
        let deploy = object.optional_object("deploy", Parachute::read);
        let release = object.optional_strings("release", MOST_EVENTS);
        Some(Self {
            mass,
            reference_area,
            aerodynamics: aerodynamics?,
            delta_v: delta_v?,
            thrust: thrust?,
            deploy: deploy?,
            release: release?,
        })
    }

    fn to_core(&self, among: &Among) -> CoreEffect {
        let parachute = |name: &String| among.parachutes.get(name.as_str()).copied();
        CoreEffect {
            mass: self.mass,
            reference_area: self.reference_area,
            aerodynamics: self.aerodynamics.clone(),
            impulse: self
                .delta_v
                .map(|DeltaV { along, value }| Impulse { along: along.to_core(among), speed_change: value }),
            engine: self.thrust.map(|thrust| thrust.to_core(among)),
            release: self.release.iter().filter_map(parachute).collect(),
            deploy: self.deploy.as_ref().map(Parachute::to_core),
        }
    }
}

impl DeltaV {
    fn read(object: &mut Object) -> Option<Self> {
        let along = Along::read(object);
        let value = object.number("value", Bound::VELOCITY);
        Some(Self { along: along?, value: value? })
    }
}

impl Thrust {
    fn read(object: &mut Object) -> Option<Self> {
        let along = Along::read(object);
        let value = object.number("value", Bound::FORCE);
        let burns = object.has("specific_impulse");
        let specific_impulse = object.optional_number("specific_impulse", Bound::SPECIFIC_IMPULSE);
        let propellant = object.optional_number("propellant", Bound::POSITIVE);
        if propellant.is_some() && !burns {
            object
                .fault_of("propellant", "must be left out: without specific_impulse the thrust burns none".to_owned());
        }
        Some(Self { along: along?, value: value?, specific_impulse, propellant })
    }
}

impl ThrustCommand {
    fn to_core(self, among: &Among) -> Engine {
        match self {
            Self::On(Thrust { along, value, specific_impulse, propellant }) => {
                Engine::On(CoreThrust { along: along.to_core(among), force: value, specific_impulse, propellant })
            }
            Self::Off => Engine::Off,
        }
    }
}

/// What an event of a request refers to outside itself.
pub(super) struct Among<'a> {
    /// The numbers of the events that deploy parachutes, by the names of these.
    parachutes: HashMap<&'a str, usize>,
    /// Takes components in the inertial frame to planet-fixed ones at t = 0.
    to_planet: Rotation,
}

impl<'a> Among<'a> {
    /// These events, with the rotation that takes components in the inertial frame to planet-fixed ones at t = 0.
    pub(super) fn new(events: &'a [Event], to_planet: Rotation) -> Self {
        let deploys = |(index, event): (usize, &'a Event)| Some((event.then.deploy.as_ref()?.name.as_str(), index));
        Self { parachutes: events.iter().enumerate().filter_map(deploys).collect(), to_planet }
    }
}

impl Parachute {
    fn read(object: &mut Object) -> Option<Self> {
        let name = object.string("name");
        let drag_area = object.number("drag_area", Bound::DRAG_AREA);
        let inflation_time = object.number("inflation_time", Bound::TIME);
        let delay = object.number_or("delay", Bound::TIME, 0.0);
        Some(Self { name: name?, drag_area: drag_area?, inflation_time: inflation_time?, delay: delay? })
    }

    fn to_core(&self) -> CoreParachute {
        let Self { drag_area, inflation_time, delay, .. } = *self;
        CoreParachute { drag_area, inflation_time, delay }
    }
}

impl Along {
    fn read(object: &mut Object) -> Option<Self> {
        let words = [
            ("velocity", Axis::Velocity),
            ("radial", Axis::Radial),
            ("normal", Axis::Normal),
            ("horizontal", Axis::Horizontal),
        ];
        if object.has_object("along") {
            object.object("along", InertialDirection::read).map(Self::Inertial)
        } else {
            object.choice("along", &words).map(Self::Axis)
        }
    }

    fn to_core(self, among: &Among) -> CoreAxis {
        match self {
            Self::Axis(axis) => axis.to_core(),
            Self::Inertial(direction) => direction.core.rotated_by(&among.to_planet),
        }
    }
}

impl InertialDirection {
    fn read(object: &mut Object) -> Option<Self> {
        let frame = object.choice("frame", &[("inertial", "inertial")]);
        let direction = object.vector("direction", Bound::FINITE);
        let core = CoreAxis::inertial(direction?);
        if core.is_none() {
            object.fault_of("direction", "must not be [0, 0, 0], which has no direction".to_owned());
        }
        Some(Self { frame: frame?, direction: direction?, core: core? })
    }
}

impl Axis {
    fn to_core(self) -> CoreAxis {
        match self {
            Self::Velocity => CoreAxis::Velocity,
            Self::Radial => CoreAxis::Radial,
            Self::Normal => CoreAxis::Normal,
            Self::Horizontal => CoreAxis::Horizontal,
        }
    }
}
