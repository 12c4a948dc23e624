//! What leaves the vehicle of a request, and how it flies on.

use std::collections::HashSet;

use reentry::propulsion::{Impulse, ThrustAxis};
use reentry::scenario::{Bound, Stop};
use reentry::vehicle::{Aerodynamics, Vehicle};
use serde_json::json;

use super::{Condition, Event, MOST_EVENTS, conditions, event, impulse};
use crate::wire::aerodynamics::aerodynamics;
use crate::wire::control::{ControlRequest, control};
use crate::wire::description::Object;
use crate::wire::parts::{MOST_PARTS, NamedPart};
use crate::wire::reader::Fault;
use crate::wire::shown::quoted;

/// A body that leaves a vehicle.
#[derive(Clone, Debug)]
pub struct Separation {
    /// Of the body.
    pub name: String,
    /// The names of the parts that leave.
    pub parts: Vec<String>,
    /// What adds to their velocity.
    pub push: Option<Impulse>,
    /// Of the body, m².
    reference_area: Option<f64>,
    /// Of the body.
    aerodynamics: Option<Aerodynamics>,
    /// What happens to the body.
    pub events: Vec<Event>,
    /// How it is flown.
    pub control: ControlRequest,
    /// The end of its flight.
    pub stop: BodyStop,
}

/// The end of the flight of a body.
#[derive(Clone, Debug, Default)]
pub struct BodyStop {
    /// m; that of the vehicle where it is not given.
    altitude: Option<f64>,
    /// s.
    pub time: Option<f64>,
    /// m.
    ceiling: Option<f64>,
    /// Further conditions.
    pub when: Vec<Condition>,
}

/// A separation.
pub(in crate::wire) fn separation(object: &mut Object) -> Option<Separation> {
    object.named(
        "Separation",
        "Body that leaves the vehicle: parts with the propellant that is left, their engines off. It flies on in the \
         planet, air and wind of the case, on the same clock; the vehicle keeps its velocity.",
    );
    let name = object
        .field("name", "Name")
        .doc("Name of the body in the response. It must be unique among all bodies of the case.")
        .text();
    let parts = object.field("parts", "Parts").doc("Names of the parts that leave; at least one.").texts(MOST_PARTS);
    object.refine("parts", || json!({"minItems": 1}));
    if parts.as_ref().is_some_and(Vec::is_empty) {
        object.fault_of("parts", "must have at least one name, got none");
    }
    let push = object
        .field("push", "Push")
        .doc("Change of the velocity of the body at the separation.")
        .optional()
        .object(impulse);
    let reference_area = object.only_unless("aerodynamics/type", "ballistic", |object| {
        object
            .field("reference_area", "Reference area")
            .doc("Reference area of the body, m². Default: that of its part, if it has only one, times its count.")
            .unit("m²")
            .optional()
            .number(Bound::NON_NEGATIVE)
    });
    let aerodynamics = object
        .field("aerodynamics", "Aerodynamics")
        .doc("Lift and drag coefficients of the body. Default: those of its part, if it has only one.")
        .optional()
        .object(aerodynamics);
    let events = object
        .field("events", "Events")
        .doc("Events of the body; its name space of events and parts is its own.")
        .optional()
        .objects_again([0, MOST_EVENTS], "Event", event);
    let control = object
        .field("control", "Control")
        .doc("Bank angle, angle of attack and steering of the body.")
        .default(json!({}))
        .object(control);
    let stop =
        object.field("stop", "Stop").doc("Conditions that end the flight of the body.").default(json!({})).object(stop);
    let (events, parts) = (events.unwrap_or_default(), parts.filter(|parts| !parts.is_empty())?);
    let (name, control, stop) = (name?, control?, stop?);
    Some(Separation { name, parts, push, reference_area, aerodynamics, events, control, stop })
}

#[expect(clippy::unnecessary_wraps, reason = "the descriptions of objects have one type")]
fn stop(object: &mut Object) -> Option<BodyStop> {
    object.named("BodyStop", "Conditions that end the flight of a body; the first one met ends it.");
    let altitude = object
        .field("altitude", "Altitude")
        .doc("Altitude whose downward crossing ends the flight, m. Default: `stop.altitude` of the case.")
        .unit("m")
        .optional()
        .number(Bound::DISTANCE);
    let time = object
        .field("time", "Time limit")
        .doc("Time since t = 0 at which the flight ends, s. Default: 10 000 s after the separation.")
        .unit("s")
        .optional()
        .number(Bound::STOP_TIME);
    let ceiling = object
        .field("ceiling", "Ceiling")
        .doc("Altitude whose upward crossing ends the flight, m.")
        .unit("m")
        .optional()
        .number(Bound::DISTANCE);
    let when = conditions(object);
    Some(BodyStop { altitude, time, ceiling, when: when.unwrap_or_default() })
}

impl Separation {
    /// Names that several bodies have, of those that leave in events or leave others; `pointer` is that of what they leave.
    pub(in crate::wire) fn name_faults<'a>(
        events: &'a [Event],
        pointer: &str,
        names: &mut HashSet<&'a str>,
    ) -> Vec<Fault> {
        let mut faults = Vec::new();
        for (index, event) in events.iter().enumerate() {
            for (place, Self { name, events, .. }) in event.then.separated.iter().enumerate() {
                let pointer = format!("{pointer}/events/{index}/then/separate/{place}");
                if !names.insert(name) {
                    let detail = format!("must be unique among the bodies of the case, got {} again", quoted(name));
                    faults.push(Fault::new(format!("{pointer}/name"), detail));
                }
                faults.extend(Self::name_faults(events, &pointer, names));
            }
        }
        faults
    }

    /// Its parts among those of the vehicle.
    pub(in crate::wire) fn parts_of(&self, parts: &[NamedPart]) -> Vec<NamedPart> {
        let part = |name: &String| NamedPart::place_of(name, parts).map(|place| parts[place].clone());
        self.parts.iter().filter_map(part).collect()
    }

    /// Whether each of its names is that of one part, and of another than the others.
    pub(in crate::wire) fn is_of(&self, parts: &[NamedPart]) -> bool {
        let is_known = |name: &String| NamedPart::place_of(name, parts).is_some();
        let is_new = |(index, name): (usize, &String)| !self.parts[..index].contains(name);
        self.parts.iter().all(is_known) && self.parts.iter().enumerate().all(is_new)
    }

    /// Whether it gives aerodynamics.
    pub(in crate::wire) fn gives_aerodynamics(&self) -> bool {
        self.aerodynamics.is_some()
    }

    /// Whether a push on it, an event of it or its steering has a direction that stays in inertial space.
    pub(in crate::wire) fn is_inertial(&self) -> bool {
        let is_pushed = self.push.is_some_and(|push| matches!(push.along, ThrustAxis::Inertial(_)));
        is_pushed || self.control.is_inertial() || self.events.iter().any(Event::is_inertial)
    }

    /// How many bodies it makes, with those that separate from it.
    pub(in crate::wire) fn count(&self) -> usize {
        1 + Event::count_of_bodies(&self.events)
    }

    /// The body, of these parts; `pointer` is that of the separation.
    ///
    /// # Errors
    /// With what is missing.
    pub(in crate::wire) fn vehicle(&self, parts: &[NamedPart], pointer: &str) -> Result<Vehicle, Vec<Fault>> {
        let only = if let [only] = parts { Some(only) } else { None };
        let own = only.and_then(|part| part.aerodynamics.clone());
        let aerodynamics = self.aerodynamics.clone().or(own);
        let is_ballistic = matches!(aerodynamics, Some(Aerodynamics::Ballistic { .. }));
        let of_part = only.and_then(|part| Some(f64::from(part.core.count) * part.reference_area?));
        let reference_area = self.reference_area.or(of_part).or(is_ballistic.then_some(1.0));
        let missing = |field: &str| {
            let detail = match only {
                Some(part) => format!("is required: part {} has none", quoted(&part.name)),
                None => "is required for a body of several parts".to_owned(),
            };
            Fault::new(format!("{pointer}/{field}"), detail)
        };
        let mass = parts.iter().map(|part| part.core.mass()).sum();
        let nose_radius = only.and_then(|part| part.nose_radius);
        match (reference_area, aerodynamics) {
            (Some(reference_area), Some(aerodynamics)) => {
                Ok(Vehicle { mass, reference_area, aerodynamics, nose_radius })
            }
            (area, aerodynamics) => {
                let area = area.is_none().then(|| missing("reference_area"));
                let aerodynamics = aerodynamics.is_none().then(|| missing("aerodynamics"));
                Err(area.into_iter().chain(aerodynamics).collect())
            }
        }
    }

    /// The end of its flight, without the further conditions; with what is not given as the vehicle has it.
    pub(in crate::wire) fn stop(&self, vehicle: &Stop) -> Stop {
        let BodyStop { altitude, ceiling, .. } = self.stop;
        Stop { altitude: altitude.unwrap_or(vehicle.altitude), ceiling, ..Stop::default() }
    }
}
