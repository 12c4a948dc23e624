//! The events of a request, and the conditions that let them happen or end the flight.

mod separation;

pub use separation::Separation;

use separation::separation;

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use reentry::coordinates::Rotation;
use reentry::event::{
    Condition as Crossing, Direction, Effect as CoreEffect, Event as CoreEvent, Quantity, Separation as CoreSeparation,
    Throttle, ThrustCommand, Tilt, Trigger,
};
use reentry::parachute::Parachute;
use reentry::propulsion::{Impulse, Thrust, ThrustAxis};
use reentry::scenario::{Bound, MOST_BODIES};
use reentry::vehicle::{Aerodynamics, Vehicle};
use serde_json::json;

use super::aerodynamics::aerodynamics;
use super::control::ControlRequest;
use super::description::{Field, Object, WordOrObject, Words, word};
use super::names::EventNames;
use super::parts::{MOST_PARTS, NamedPart};
use super::reader::{Fault, MOST_FAULTS};
use super::schema::{ANGLE, bounds, is, widened};
use super::shown::quoted;
use super::steering::{Axes, Steering, steering};

/// The name of the event of a launch.
pub const LIFT_OFF: &str = "liftoff";

/// The greatest number of events, and of conditions that end a flight.
pub const MOST_EVENTS: usize = 1000;

/// An event of a request.
#[derive(Clone, Debug)]
pub struct Event {
    /// Given back in the answer.
    pub name: Option<String>,
    /// What it waits for.
    pub when: Condition,
    /// What it changes.
    pub then: Effect,
}

/// What an event or the end of a flight waits for.
#[derive(Clone, Debug)]
pub enum Condition {
    /// A quantity passes a value.
    Crossing(Crossing),
    /// So much time, s, has passed since the event of this name.
    After(String, f64),
    /// So much time, s, has passed since the part of this name burnt out.
    AfterBurnout(String, f64),
}

/// What an event changes.
#[derive(Clone, Debug, Default)]
pub struct Effect {
    /// The same for the core, but for the parachutes that are cut off, and with inertial directions by the axes of their frame.
    pub core: CoreEffect,
    /// The name of the parachute that is deployed.
    pub deployed: Option<String>,
    /// The names of the parachutes that are cut off.
    pub released: Vec<String>,
    /// The names of the parts whose engines are lit.
    pub ignited: Vec<String>,
    /// The names of the parts whose engines are shut down.
    pub shut_down: Vec<String>,
    /// The names of the parts whose engines are throttled, and how far.
    pub throttled: Vec<(String, f64)>,
    /// Where the axis of the vehicle points.
    pub steering: Option<Steering>,
    /// The angle of a turn of the velocity, and its azimuth, rad; that of the launch where it is not given.
    pub tilt: Option<(f64, Option<f64>)>,
    /// What leaves the vehicle.
    pub separated: Vec<Separation>,
}

/// The quantities of conditions.
pub static QUANTITIES: Words<Quantity> = Words {
    name: "Quantity",
    doc: "Quantity that crosses a value.",
    words: &[
        word("time", Quantity::Time, "Time, s").unit("s").doc("Time since the start, s."),
        word("altitude", Quantity::Altitude, "Altitude, m").unit("m").doc("Altitude along the radius vector, m."),
        word("speed", Quantity::Speed, "Speed, m/s").unit("m/s").doc("Speed relative to the rotating planet, m/s."),
        word("mach", Quantity::Mach, "Mach number")
            .doc("Mach number: air speed over speed of sound. The atmosphere must have a speed of sound."),
        word("dynamic_pressure", Quantity::DynamicPressure, "Dynamic pressure, Pa")
            .unit("Pa")
            .doc("Dynamic pressure ½ρV² with the air speed V, Pa."),
        word("load_factor", Quantity::LoadFactor, "Load factor, g").doc(
            "Load factor, in g of the Earth on every planet: resultant of lift, drag and thrust over mass and \
                 9.80665 m/s².",
        ),
        word("flight_path_angle", Quantity::FlightPathAngle, "Flight-path angle")
            .unit(ANGLE)
            .doc("Angle of the velocity relative to the rotating planet above the plane normal to the radius."),
        word("mass", Quantity::Mass, "Mass, kg").unit("kg").doc("Mass of the vehicle, kg."),
        word("air_speed", Quantity::AirSpeed, "Airspeed, m/s").unit("m/s").doc("Speed relative to the air, m/s."),
        word("inertial_speed", Quantity::InertialSpeed, "Inertial speed, m/s")
            .unit("m/s")
            .doc("Speed relative to inertial space, m/s."),
        word("specific_energy", Quantity::SpecificEnergy, "Specific energy, J/kg")
            .unit("J/kg")
            .doc("Half the squared inertial speed plus the gravitational potential, J/kg."),
        word("apoapsis_altitude", Quantity::ApoapsisAltitude, "Apoapsis altitude, m").unit("m").doc(
            "Apoapsis altitude of the osculating orbit above the equatorial radius, m; 1e13 m for an unbound orbit.",
        ),
        word("periapsis_altitude", Quantity::PeriapsisAltitude, "Periapsis altitude, m")
            .unit("m")
            .doc("Periapsis altitude of the osculating orbit above the equatorial radius, m."),
        word("eccentricity", Quantity::Eccentricity, "Eccentricity")
            .doc("Eccentricity of the osculating orbit; 1 for motion along the radius vector."),
        word("inclination", Quantity::Inclination, "Inclination")
            .unit(ANGLE)
            .doc("Inclination of the osculating orbit to the equator."),
        word("heat_flux", Quantity::HeatFlux, "Heat flux, W/m²")
            .unit("W/m²")
            .doc("Heat flux into the stagnation point, W/m². It requires `heating`."),
        word("heat_load", Quantity::HeatLoad, "Heat load, J/m²")
            .unit("J/m²")
            .doc("Heat load of the stagnation point since the start, J/m². It requires `heating`."),
        word("wall_temperature", Quantity::WallTemperature, "Wall temperature, K")
            .unit("K")
            .doc("Radiative equilibrium temperature of the wall, K. It requires `heating`."),
        word("downrange", Quantity::Downrange, "Downrange, m")
            .unit("m")
            .doc("Distance along the great circle of the initial heading, m. The initial state must have a heading."),
        word("ground_range", Quantity::GroundRange, "Ground range, m")
            .unit("m")
            .doc("Great-circle distance from the initial ground point, m."),
        word("deceleration", Quantity::Deceleration, "Deceleration, m/s²")
            .unit("m/s²")
            .doc("Deceleration -dV/dt of the speed relative to the rotating planet, m/s²."),
        word("density", Quantity::Density, "Air density, kg/m³").unit("kg/m³").doc("Density of the air, kg/m³."),
    ],
};

/// An event.
pub(super) fn event(object: &mut Object) -> Option<Event> {
    object.named(
        "Event",
        "Event that happens once, at the first instant at which its condition is met. Events at the same instant \
         happen in the order of the list; each acts on the result of the previous ones.",
    );
    let name = object
        .field("name", "Name")
        .doc("Name of the event; returned in the response. Conditions refer to the event by it.")
        .optional()
        .text();
    let when = object.field("when", "Trigger").doc("Condition that triggers the event.").object(condition);
    let then = object
        .field("then", "Effect")
        .doc(
            "Changes that the event makes. An event without changes only marks an instant; the response gives the \
             state there.",
        )
        .default(json!({}))
        .object(effect);
    Some(Event { name, when: when?, then: then? })
}

/// A condition.
pub(super) fn condition(object: &mut Object) -> Option<Condition> {
    object.named(
        "Condition",
        "Crossing of a value by a quantity, downwards or upwards, or a delay after another event or after a burnout.\n\nA condition on a \
         quantity is met the first time the quantity crosses the value in the given direction, whether continuously \
         or in a jump (the load factor jumps when a parachute opens). If the quantity starts at the value, the \
         condition is met as soon as it moves in that direction, however slowly. If it starts past the value, it must \
         first return.",
    );
    object.alternatives(&[("quantity", &crossing), ("event", &after), ("burnout", &after_burnout)])
}

/// Further conditions that end a flight.
pub(super) fn conditions(object: &mut Object) -> Option<Vec<Condition>> {
    object
        .field("when", "Conditions")
        .doc(
            "Further conditions; each of them ends the flight. If several are met at the same instant, the response \
             names the first in the list.",
        )
        .optional()
        .objects([0, MOST_EVENTS], condition)
}

fn crossing(object: &mut Object) -> Option<Condition> {
    let quantity =
        object.field("quantity", "Quantity").doc("Quantity that crosses the value.").optional().word(&QUANTITIES);
    let mut value = |name, title, doc| {
        let field = object.field(name, title).doc(doc).optional();
        match quantity {
            Some(quantity) if quantity.is_angle() => field.angle(quantity.bound()),
            Some(quantity) => field.unit(QUANTITIES.unit_of(quantity)).number(quantity.bound()),
            // Which bound the value has is not known.
            None => field.number(Bound::FINITE),
        }
    };
    let falling = value(
        "falls_through",
        "Falls below",
        "Value that the quantity crosses downwards, in its unit; an angle is in `angle_unit`. Not supported for \
         `time`.",
    );
    let rising = value(
        "rises_through",
        "Rises above",
        "Value that the quantity crosses upwards, in its unit; an angle is in `angle_unit`.",
    );
    object.exactly_one(&["falls_through", "rises_through"]);
    object.condition(|| json!({"if": is("quantity", "time"), "then": {"properties": {"falls_through": false}}}));
    for word in QUANTITIES.words {
        object.condition(|| {
            let bound = word.meaning.bound();
            let bounds = bounds(if word.meaning.is_angle() { widened(bound) } else { bound });
            let both = json!({"properties": {"falls_through": bounds, "rises_through": bounds}});
            json!({"if": is("quantity", word.word), "then": both})
        });
    }
    let falling = falling.map(|value| (value, Direction::Falling));
    let (value, direction) = falling.or(rising.map(|value| (value, Direction::Rising)))?;
    Some(Condition::Crossing(Crossing { quantity: quantity?, value, direction }))
}

fn after(object: &mut Object) -> Option<Condition> {
    let event = object
        .field("event", "Or after event")
        .doc("Name of another event; the condition is met `delay` seconds after it.")
        .optional()
        .text();
    let delay = delay(object);
    Some(Condition::After(event?, delay?))
}

fn after_burnout(object: &mut Object) -> Option<Condition> {
    let part = object
        .field("burnout", "Or after burnout of part")
        .doc(
            "Name of a part; the condition is met `delay` seconds after its burnout: its propellant is spent, or its \
             thrust table is over. A shut-down is no burnout.",
        )
        .optional()
        .text();
    let delay = delay(object);
    Some(Condition::AfterBurnout(part?, delay?))
}

fn delay(object: &mut Object) -> Option<f64> {
    object
        .field("delay", "Delay")
        .doc("Time after that event or burnout, s.")
        .unit("s")
        .default(0.0)
        .number(Bound::TIME)
}

/// What an event changes.
#[expect(clippy::unnecessary_wraps, reason = "the descriptions of objects have one type")]
fn effect(object: &mut Object) -> Option<Effect> {
    object.named("Effect", "Changes that an event makes, from its instant on. Omitted fields stay unchanged.");
    let mass = object
        .field("mass", "New mass")
        .doc("Mass after the event, kg. A ballistic coefficient changes in proportion: the drag area stays unchanged.")
        .unit("kg")
        .optional()
        .number(Bound::POSITIVE);
    let reference_area = object.only_unless("aerodynamics/type", "ballistic", |object| {
        object
            .field("reference_area", "New reference area")
            .doc(
                "Reference area after the event, m². Not supported with ballistic aerodynamics, nor if the vehicle \
                 has them and no event replaces them.",
            )
            .unit("m²")
            .optional()
            .number(Bound::NON_NEGATIVE)
    });
    let aerodynamics = object
        .field("aerodynamics", "New aerodynamics")
        .doc("Lift and drag after the event.")
        .optional()
        .object(aerodynamics);
    let impulse = object
        .field("delta_v", "Impulsive Δv")
        .doc("Impulsive change of velocity. It consumes no propellant: set `mass` to the mass after it.")
        .optional()
        .object(impulse);
    let thrust = object
        .field("thrust", "Thrust")
        .doc("Constant thrust that the event switches on, or `\"off\"`.")
        .optional()
        .word_or(&THRUST_COMMAND, &OFF, |object| thrust(object).map(ThrustCommand::On));
    let parachute = object
        .field("deploy", "Deploy parachute")
        .doc("Parachute that the event deploys.")
        .optional()
        .object(parachute);
    let released = object
        .field("release", "Release parachutes")
        .doc(
            "Names of parachutes that the event cuts off, before it deploys another. For a parachute that is not \
             deployed, the release has no effect and the response contains the warning `not_deployed`.",
        )
        .optional()
        .texts(MOST_EVENTS);
    let ignited = part_names(object.field("ignite", "Ignite").doc("Names of parts whose engines the event ignites."));
    let shut_down = part_names(object.field("shut_down", "Shut down").doc(
        "Names of parts whose engines the event shuts down. A shut-down engine can be ignited again; a thrust table then \
         starts anew.",
    ));
    let throttled = object
        .field("throttle", "Throttle")
        .doc(
            "Throttle of engines, from 0 to 1, by the names of their parts: the share of the thrust in vacuum and of \
             the mass flow. Before, it is 1.",
        )
        .optional()
        .numbers_by_name(Bound::SHARE);
    let load_limit = object
        .field("load_limit", "Load limit")
        .doc(
            "Load factor, in g of the Earth, at which all engines are throttled alike so that it does not rise further; \
             `null` removes the limit.",
        )
        .optional()
        .number_or_null(Bound::LOAD_LIMIT);
    let steering = object.field("steer", "Steer").doc("Steering from the event on.").optional().object(steering);
    let tilt = object
        .field("tilt", "Tilt")
        .doc("Turn of the velocity at constant speed: the pitch-over of a launch.")
        .optional()
        .object(tilt);
    let separated = object
        .field("separate", "Separate")
        .doc("Bodies that leave the vehicle, before all other effects of the event.")
        .optional()
        .objects([0, MOST_BODIES], separation);
    let (deployed, deploy) = parachute.unzip();
    let core =
        CoreEffect { mass, reference_area, aerodynamics, impulse, thrust, deploy, load_limit, ..CoreEffect::default() };
    Some(Effect {
        core,
        deployed,
        released: released.unwrap_or_default(),
        ignited,
        shut_down,
        throttled: throttled.unwrap_or_default(),
        steering,
        tilt,
        separated: separated.unwrap_or_default(),
    })
}

/// Names of parts; none where there are none.
fn part_names(field: Field) -> Vec<String> {
    field.optional().texts(MOST_PARTS).unwrap_or_default()
}

fn tilt(object: &mut Object) -> Option<(f64, Option<f64>)> {
    object.named("Tilt", "Turn of the velocity at constant speed.");
    let angle = object
        .field("angle", "Angle")
        .doc("Angle by which the velocity turns away from the radial direction.")
        .angle(Bound::TURN);
    let azimuth = object
        .field("azimuth", "Azimuth")
        .doc("Azimuth towards which it turns, clockwise from north. Default: that of the launch frame.")
        .optional()
        .angle(Bound::TURN);
    Some((angle?, azimuth))
}

pub(super) fn impulse(object: &mut Object) -> Option<Impulse> {
    object.named("DeltaV", "Instantaneous change of velocity.");
    let along = along(object, "Direction of the change.");
    let speed_change = object
        .field("value", "Δv")
        .doc(
            "Change of velocity along the direction, m/s. A negative value acts against the direction: a deorbit burn \
             along the velocity is negative.",
        )
        .unit("m/s")
        .number(Bound::VELOCITY);
    Some(Impulse { along: along?, speed_change: speed_change? })
}

/// What becomes of the thrust.
const THRUST_COMMAND: WordOrObject = WordOrObject { name: "ThrustCommand", doc: "New thrust, or `\"off\"`." };

const OFF: Words<ThrustCommand> =
    Words { name: "", doc: "Switches the thrust off.", words: &[word("off", ThrustCommand::Off, "")] };

fn thrust(object: &mut Object) -> Option<Thrust> {
    object.named(
        "Thrust",
        "Constant thrust; it replaces a thrust that is on. It ends when an event switches it off, or when its \
         propellant is spent.\n\nA thrust against the velocity that exceeds the other forces brings the vehicle to \
         rest, where the thrust has no direction and the flight fails. Switch the thrust off before, or end the \
         flight, for example where the speed falls through 0.",
    );
    let along = along(object, "Direction of the thrust.");
    let force = object
        .field("value", "Thrust")
        .doc(
            "Thrust along the direction, N. A negative value acts against the direction: a retro burn along the \
             velocity is negative.",
        )
        .unit("N")
        .number(Bound::FORCE);
    let burns = object.has("specific_impulse");
    let specific_impulse = object
        .field("specific_impulse", "Specific impulse")
        .doc(
            "Specific impulse, s. The mass falls by |`value`|/(9.80665 m/s² `specific_impulse`) per second. Without \
             it, the mass stays constant.",
        )
        .unit("s")
        .optional()
        .number(Bound::SPECIFIC_IMPULSE);
    let propellant = object
        .field("propellant", "Propellant")
        .doc(
            "Mass of the propellant, kg; the thrust ends when it is spent. Without it, the thrust burns until it is \
             switched off. It requires `specific_impulse`.",
        )
        .unit("kg")
        .optional()
        .number(Bound::POSITIVE);
    object.condition(|| json!({"dependentRequired": {"propellant": ["specific_impulse"]}}));
    if propellant.is_some() && !burns {
        object.fault_of("propellant", "must be omitted: without specific_impulse the thrust consumes no propellant");
    }
    Some(Thrust { along: along?, force: force?, specific_impulse, propellant })
}

/// A direction that moves with the vehicle, or one that stays in inertial space.
const ALONG: WordOrObject = WordOrObject {
    name: "Along",
    doc: "Direction: a word for one that moves with the vehicle, or a vector fixed in inertial space.",
};

const AXES: Words<ThrustAxis> = Words {
    name: "Axis",
    doc: "Direction that moves with the vehicle.",
    words: &[
        word("velocity", ThrustAxis::Velocity, "Velocity").doc("Along the velocity relative to the rotating planet."),
        word("radial", ThrustAxis::Radial, "Radial, outward").doc("Away from the planet's centre."),
        word("normal", ThrustAxis::Normal, "Normal, left")
            .doc("Horizontal and perpendicular to the velocity, to the left of the flight direction."),
        word("horizontal", ThrustAxis::Horizontal, "Horizontal velocity")
            .doc("Along the horizontal component of the velocity relative to the rotating planet."),
    ],
};

fn along(object: &mut Object, doc: &'static str) -> Option<ThrustAxis> {
    object.field("along", "Direction").doc(doc).word_or(&ALONG, &AXES, inertial_direction)
}

fn inertial_direction(object: &mut Object) -> Option<ThrustAxis> {
    object.named(
        "InertialDirection",
        "Direction fixed in inertial space.\n\nIts components are in the inertial frame of the initial state: the \
         `frame` of `eci` vectors and of orbital elements; for other states, the frame of date, whose angle to the \
         planet follows from `sidereal_time`, `sidereal_angle` or `epoch`.",
    );
    object.field("frame", "Frame").doc("Always `inertial`.").constant("inertial");
    let direction =
        object.field("direction", "Direction").doc("Components [x, y, z]; any length except 0.").vector(Bound::FINITE);
    object.refine("direction", || json!({"contains": {"not": {"const": 0}}}));
    let axis = ThrustAxis::inertial(direction?);
    if axis.is_none() {
        object.fault_of("direction", "must not be [0, 0, 0], which has no direction");
    }
    axis
}

/// A parachute and its name.
fn parachute(object: &mut Object) -> Option<(String, Parachute)> {
    object.named(
        "Parachute",
        "Parachute. Its drag acts along the velocity relative to the air and adds to the drag of the vehicle and of \
         other parachutes.\n\nDuring inflation, the drag area grows as `drag_area` (t/`inflation_time`)²: T. W. \
         Knacke, Parachute Recovery Systems Design Manual, NWC TP 6575, 1991, chapter 5, for solid-cloth canopies.",
    );
    let name = object
        .field("name", "Name")
        .doc("Name by which `release` refers to the parachute. It must be unique: each parachute is deployed once.")
        .text();
    let drag_area = object
        .field("drag_area", "Drag area")
        .doc("Drag coefficient times area of the full canopy, m².")
        .unit("m²")
        .number(Bound::DRAG_AREA);
    let inflation_time = object
        .field("inflation_time", "Inflation time")
        .doc("Duration of the inflation, s; 0 opens the parachute at once.")
        .unit("s")
        .number(Bound::TIME);
    let delay = object
        .field("delay", "Delay")
        .doc("Time from the event to the start of the inflation, s.")
        .unit("s")
        .default(0.0)
        .number(Bound::TIME);
    Some((name?, Parachute { drag_area: drag_area?, inflation_time: inflation_time?, delay: delay? }))
}

impl Event {
    /// The lift-off of a vehicle that is held on the ground.
    pub fn lift_off() -> Self {
        let condition = Crossing { quantity: Quantity::UpwardAcceleration, value: 0.0, direction: Direction::Rising };
        let core = CoreEffect { lift_off: true, ..CoreEffect::default() };
        Self {
            name: Some(LIFT_OFF.to_owned()),
            when: Condition::Crossing(condition),
            then: Effect { core, ..Effect::default() },
        }
    }

    /// The core's event; the separations have the places of their bodies from `first_body` on.
    pub(super) fn to_core(&self, events: &EventNames, references: &EventReferences, first_body: usize) -> CoreEvent {
        let parachute = |name: &String| references.parachutes.get(name.as_str()).copied();
        let place = |name: &String| NamedPart::place_of(name, references.parts).unwrap_or(references.parts.len());
        let places = |names: &[String]| names.iter().map(place).collect();
        let turned = |axis: ThrustAxis| axis.rotated_by(&references.to_planet);
        let mut then = self.then.core.clone();
        then.release = self.then.released.iter().filter_map(parachute).collect();
        if let Some(impulse) = &mut then.impulse {
            impulse.along = turned(impulse.along);
        }
        if let Some(ThrustCommand::On(thrust)) = &mut then.thrust {
            thrust.along = turned(thrust.along);
        }
        let Effect { ignited, shut_down, throttled, steering, tilt, separated, .. } = &self.then;
        (then.ignite, then.shut_down) = (places(ignited), places(shut_down));
        then.throttle = throttled.iter().map(|(name, value)| Throttle { part: place(name), value: *value }).collect();
        then.steer = steering.as_ref().map(|steering| steering.to_core(events, &references.axes));
        then.tilt = tilt.map(|(angle, azimuth)| Tilt { angle, azimuth: azimuth.unwrap_or(references.azimuth) });
        let separation = |(index, separation): (usize, &Separation)| CoreSeparation {
            parts: places(&separation.parts),
            push: separation.push.map(|push| Impulse { along: turned(push.along), ..push }),
            body: first_body + index,
        };
        then.separate = separated.iter().enumerate().map(separation).collect();
        CoreEvent { when: self.when.to_core(events, references.parts), then }
    }

    /// Names of parts that the case does not have, or that have no engine.
    pub(super) fn part_faults(events: &[Self], parts: &[NamedPart]) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (index, Self { then, .. }) in events.iter().enumerate() {
            let place = format!("/events/{index}/then");
            let mut check = |name: &str, with_engine: bool, pointer: String| {
                faults.extend(NamedPart::name_fault(name, parts, with_engine, pointer));
            };
            for (at, name) in then.ignited.iter().enumerate() {
                check(name, true, format!("{place}/ignite/{at}"));
            }
            for (at, name) in then.shut_down.iter().enumerate() {
                check(name, true, format!("{place}/shut_down/{at}"));
            }
            for (name, _) in &then.throttled {
                check(name, true, format!("{place}/throttle/{}", name.replace('~', "~0").replace('/', "~1")));
            }
            for (at, separation) in then.separated.iter().enumerate() {
                for (of_body, name) in separation.parts.iter().enumerate() {
                    check(name, false, format!("{place}/separate/{at}/parts/{of_body}"));
                }
            }
            let needs_parts = [("load_limit", then.core.load_limit.is_some()), ("steer", then.steering.is_some())];
            let needless = needs_parts.into_iter().filter(|(_, is_given)| *is_given && parts.is_empty());
            faults.extend(needless.map(|(field, _)| {
                Fault::new(format!("{place}/{field}"), "requires vehicle.parts: it acts on the engines of parts")
            }));
        }
        faults
    }

    /// Events of the name that is that of a launch.
    pub(super) fn lift_off_faults(events: &[Self]) -> Vec<Fault> {
        let named = events
            .iter()
            .enumerate()
            .filter(|(_, event)| event.name.as_deref() == Some(LIFT_OFF) && !event.then.core.lift_off);
        let detail = format!("must not be {LIFT_OFF:?}, which is the event of the launch");
        named.map(|(index, _)| Fault::new(format!("/events/{index}/name"), detail.clone())).collect()
    }

    /// Whether it may change the mass.
    pub fn changes_mass(&self) -> bool {
        let CoreEffect { mass, thrust, .. } = &self.then.core;
        mass.is_some() || matches!(thrust, Some(ThrustCommand::On(thrust)) if thrust.specific_impulse.is_some())
    }

    /// Whether it switches a thrust on or off.
    pub fn changes_thrust(&self) -> bool {
        self.then.core.thrust.is_some()
    }

    /// Whether it pushes or steers the vehicle, or what leaves it, along a direction that stays in inertial space.
    pub(super) fn is_inertial(&self) -> bool {
        let is_inertial = |axis: ThrustAxis| matches!(axis, ThrustAxis::Inertial(_));
        let CoreEffect { impulse, thrust, .. } = &self.then.core;
        self.then.steering.as_ref().is_some_and(Steering::is_inertial)
            || self.then.separated.iter().any(Separation::is_inertial)
            || impulse.is_some_and(|impulse| is_inertial(impulse.along))
            || matches!(thrust, Some(ThrustCommand::On(thrust)) if is_inertial(thrust.along))
    }

    /// How many bodies events separate, with those that separate from bodies.
    pub(super) fn count_of_bodies(events: &[Self]) -> usize {
        events.iter().flat_map(|event| &event.then.separated).map(Separation::count).sum()
    }

    /// More bodies than a case may have: none of them needs to be looked at.
    pub(super) fn body_faults(events: &[Self]) -> Vec<Fault> {
        let last = events.iter().rposition(|event| !event.then.separated.is_empty());
        let last = last.filter(|_| Self::count_of_bodies(events) > MOST_BODIES);
        let fault = |index: usize| {
            let detail = format!(
                "must separate at most {MOST_BODIES} bodies in all, with those that separate from bodies, got {}",
                Self::count_of_bodies(events)
            );
            Fault::new(format!("/events/{index}/then/separate"), detail)
        };
        last.map(fault).into_iter().collect()
    }

    /// Inertial directions on a planet whose angle nobody knows: an epoch says nothing about it, and the state does not give it.
    pub(super) fn frame_faults(events: &[Self], control: &ControlRequest, is_angle_known: bool) -> Vec<Fault> {
        let detail = "is required for an inertial direction of an event or of the steering: an epoch does not define \
                      the angle of a custom planet; give sidereal_time or sidereal_angle";
        let unknown = !is_angle_known && (control.is_inertial() || events.iter().any(Self::is_inertial));
        unknown.then(|| Fault::new("/initial_state/sidereal_time", detail)).into_iter().collect()
    }

    /// The names of events.
    pub(super) fn names(events: &[Self]) -> EventNames<'_> {
        EventNames::new(events.iter().map(|event| event.name.as_deref()))
    }

    /// Parachutes that share a name, and names of those that are cut off and never deployed.
    pub(super) fn parachute_faults(events: &[Self]) -> Vec<Fault> {
        let mut faults = Vec::new();
        let mut deployed: HashMap<&str, usize> = HashMap::new();
        for (index, Self { then, .. }) in events.iter().enumerate() {
            let Some(name) = &then.deployed else { continue };
            match deployed.entry(name) {
                Entry::Vacant(entry) => _ = entry.insert(index),
                Entry::Occupied(first) => {
                    let detail = format!("must be unique: event {} deploys a parachute of this name", first.get());
                    faults.push(Fault::new(format!("/events/{index}/then/deploy/name"), detail));
                }
            }
        }
        for (index, Self { then, .. }) in events.iter().enumerate() {
            for (place, name) in
                then.released.iter().enumerate().filter(|(_, name)| !deployed.contains_key(name.as_str()))
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
            let aerodynamics = then.core.aerodynamics.as_ref();
            aerodynamics.is_some_and(|aerodynamics| !matches!(aerodynamics, Aerodynamics::Ballistic { .. }))
        };
        let ever = events.iter().any(by_area);
        let fault = |(index, event): (usize, &Self)| {
            let detail = match event.then.core.reference_area {
                None if by_area(event) => {
                    "is required: the vehicle is ballistic and has no reference area for these coefficients"
                }
                Some(_) if !ever => {
                    "must be omitted: the vehicle is ballistic, and no event gives it coefficients that refer to an \
                     area"
                }
                _ => return None,
            };
            Some(Fault::new(format!("/events/{index}/then/reference_area"), detail))
        };
        events.iter().enumerate().filter_map(fault).collect()
    }
}

impl Condition {
    /// The core's trigger; one that waits for an event of no name in the list waits for one beyond its end.
    pub(super) fn to_core(&self, events: &EventNames, parts: &[NamedPart]) -> Trigger {
        match self {
            Self::Crossing(crossing) => (*crossing).into(),
            Self::After(name, delay) => Trigger::After { event: events.place_of(name), delay: *delay },
            Self::AfterBurnout(name, delay) => {
                Trigger::AfterBurnout { part: NamedPart::place_of(name, parts).unwrap_or(parts.len()), delay: *delay }
            }
        }
    }

    /// What is wrong with the name of an event or a part that is waited for: it must be that of one event, or of a part with an engine;
    /// `place` is that of the condition.
    pub(super) fn name_fault(&self, place: &str, events: &EventNames, parts: &[NamedPart]) -> Option<Fault> {
        match self {
            Self::Crossing(_) => None,
            Self::After(name, _) => events.fault(name, format!("{place}/event")),
            Self::AfterBurnout(name, _) => NamedPart::name_fault(name, parts, true, format!("{place}/burnout")),
        }
    }
}

/// What events refer to outside themselves.
pub(super) struct EventReferences<'a> {
    /// The numbers of the events that deploy parachutes, by the names of these.
    parachutes: HashMap<&'a str, usize>,
    /// Takes components in the inertial frame to planet-fixed ones at t = 0.
    to_planet: Rotation,
    /// The frames of steering.
    axes: Axes,
    /// That of the launch frame, clockwise from north, rad.
    azimuth: f64,
    parts: &'a [NamedPart],
}

impl<'a> EventReferences<'a> {
    /// These events and parts, with the frames of steering, and the azimuth of the launch, rad.
    pub(super) fn new(events: &'a [Event], parts: &'a [NamedPart], axes: Axes, azimuth: f64) -> Self {
        let deploys = |(index, event): (usize, &'a Event)| Some((event.then.deployed.as_deref()?, index));
        let parachutes = events.iter().enumerate().filter_map(deploys).collect();
        Self { parachutes, to_planet: axes.to_planet, axes, azimuth, parts }
    }
}
