//! The parts of a vehicle: stages, boosters, fairings and payloads.

use std::collections::HashSet;

use reentry::part::{Engine, Part, ThrustEntry, ThrustProfile};
use reentry::scenario::Bound;
use reentry::vehicle::Aerodynamics;
use serde_json::json;

use super::aerodynamics::aerodynamics;
use super::description::Object;
use super::reader::{Fault, MOST_ENTRIES, NumberOrList};
use super::schema::is;
use super::shown::quoted;

/// The greatest number of parts of a vehicle.
pub const MOST_PARTS: usize = 100;

/// Names that a fault lists.
const MOST_NAMED: usize = 10;

/// The greatest count of one part.
const MOST_OF_A_KIND: usize = 1000;

/// A part of the vehicle of a request.
#[derive(Clone, Debug)]
pub struct NamedPart {
    /// By which events name it.
    pub name: String,
    /// The same for the core.
    pub core: Part,
    /// When it flies alone, of one, m².
    pub reference_area: Option<f64>,
    /// When it flies alone.
    pub aerodynamics: Option<Aerodynamics>,
    /// When it flies alone, m.
    pub nose_radius: Option<f64>,
    /// Whether the thrust at sea level gives its exit area.
    gives_sea_level: bool,
}

/// A part.
pub(super) fn part(object: &mut Object) -> Option<NamedPart> {
    object.named(
        "VehiclePart",
        "Part of a vehicle: stage, booster, fairing or payload. `reference_area`, `aerodynamics` and `nose_radius` are \
         those of the part when it flies alone.",
    );
    let name = object.field("name", "Name").doc("Name by which events refer to the part. It must be unique.").text();
    let count = object
        .field("count", "Count")
        .doc(
            "Number of identical parts that act together. All other numbers of the part are those of one; a separated \
             part flies on as one body with the masses, thrusts and areas of all.",
        )
        .default(1)
        .whole_number([1, MOST_OF_A_KIND]);
    let dry_mass =
        object.field("dry_mass", "Dry mass").doc("Mass without propellant, kg.").unit("kg").number(Bound::NON_NEGATIVE);
    let propellant = object
        .field("propellant", "Propellant")
        .doc("Mass of the propellant at the start, kg. It requires `engine`.")
        .unit("kg")
        .default(0.0)
        .number(Bound::NON_NEGATIVE);
    let engine = object
        .field("engine", "Engine")
        .doc("Rocket engine that burns the propellant; events ignite it.")
        .optional()
        .object(engine);
    let has_engine = object.has("engine");
    if !has_engine && propellant.is_some_and(|propellant| propellant > 0.0) {
        object.fault_of("propellant", "must be 0: the part has no engine to burn it");
    }
    let weighs_nothing = dry_mass == Some(0.0) && propellant == Some(0.0);
    if weighs_nothing {
        object.fault_of("dry_mass", "must be greater than 0: the part has no propellant, and would have no mass");
    }
    object.condition(|| {
        let some = json!({"properties": {"propellant": {"exclusiveMinimum": 0}}, "required": ["propellant"]});
        json!({"if": some, "then": {"required": ["engine"]},
               "else": {"properties": {"dry_mass": {"exclusiveMinimum": 0}}}})
    });
    let reference_area = object
        .field("reference_area", "Reference area")
        .doc("Reference area of one, m².")
        .unit("m²")
        .optional()
        .number(Bound::NON_NEGATIVE);
    let aerodynamics =
        object.field("aerodynamics", "Aerodynamics").doc("Lift and drag coefficients.").optional().object(aerodynamics);
    let nose_radius = object
        .field("nose_radius", "Nose radius")
        .doc("Nose radius at the stagnation point, m. Without it, no heat flux is computed for the separated part.")
        .unit("m")
        .optional()
        .number(Bound::POSITIVE);
    if let (Some(count), Some(area)) = (count, reference_area)
        && !(area * count_of(count)).is_finite()
    {
        object.fault_of("reference_area", "is too large: times count, it exceeds the greatest number");
    }
    let (engine, gives_sea_level) = engine.unzip();
    let count = u32::try_from(count?).ok()?;
    let core = Part { count, dry_mass: dry_mass?, propellant: propellant?, engine };
    let gives_sea_level = gives_sea_level.unwrap_or(false);
    Some(NamedPart { name: name?, core, reference_area, aerodynamics, nose_radius, gives_sea_level })
}

fn count_of(count: usize) -> f64 {
    u32::try_from(count).map_or(f64::INFINITY, f64::from)
}

/// An engine, and whether the thrust at sea level gives its exit area.
fn engine(object: &mut Object) -> Option<(Engine, bool)> {
    object.named(
        "Engine",
        "Rocket engine. Its thrust is `throttle` times the thrust in vacuum, minus the exit area times the pressure of \
         the air; its mass flow is `throttle` times the thrust in vacuum over (9.80665 m/s² `specific_impulse`).",
    );
    let thrust = object.field("thrust", "Thrust").doc("Thrust of one engine.").object(thrust);
    let specific_impulse = object
        .field("specific_impulse", "Specific impulse")
        .doc("Specific impulse in vacuum, s.")
        .unit("s")
        .number(Bound::SPECIFIC_IMPULSE);
    let exit_area = object
        .field("exit_area", "Exit area")
        .doc(
            "Exit area of the nozzle, m², on which the pressure of the air acts. Default: from `sea_level`, or 0, \
             without an effect of pressure. An exit area above 0 requires an atmosphere with a pressure.",
        )
        .unit("m²")
        .optional()
        .number(Bound::NON_NEGATIVE);
    let (profile, sea_level) = thrust?;
    let gives_sea_level = sea_level.is_some();
    if gives_sea_level && exit_area.is_some() {
        object.fault_of("exit_area", "must not be given together with thrust/sea_level, which defines it");
    }
    object.condition(|| {
        let by_sea_level = json!({"properties": {"thrust": {"required": ["sea_level"]}}, "required": ["thrust"]});
        json!({"if": by_sea_level, "then": {"properties": {"exit_area": false}}})
    });
    let of_thrusts = match (&profile, sea_level) {
        (ThrustProfile::Constant(vacuum), Some(sea_level)) => Some(Engine::exit_area(*vacuum, sea_level)),
        _ => None,
    };
    let exit_area = exit_area.or(of_thrusts).unwrap_or(0.0);
    Some((Engine { thrust: profile, specific_impulse: specific_impulse?, exit_area }, gives_sea_level))
}

/// A thrust in vacuum, and a constant one at sea level where it is given, N.
fn thrust(object: &mut Object) -> Option<(ThrustProfile, Option<f64>)> {
    object.named(
        "EngineThrust",
        "Thrust of an engine, N: a number, with or without the thrust at sea level, or a table of the time since \
         ignition, interpolated linearly, whose end is the burnout.",
    );
    let is_table = object.has("type");
    object
        .field("type", "Type")
        .doc("`table` for a thrust by time; absent for a constant one.")
        .optional()
        .constant("table");
    let vacuum = object
        .field("vacuum", "Thrust in vacuum")
        .doc("Thrust in vacuum, N: a number, or one number per time of a table.")
        .unit("N")
        .number_or_numbers(Bound::THRUST, [2, MOST_ENTRIES]);
    let sea_level = object
        .field("sea_level", "Thrust at sea level")
        .doc("Thrust at a pressure of 101 325 Pa, N; at most `vacuum`. Not supported for a table: give `exit_area`.")
        .unit("N")
        .optional()
        .number(Bound::THRUST);
    let time = object
        .field("time", "Time since ignition")
        .doc("Times since ignition of a table, ascending from 0, s.")
        .unit("s")
        .optional()
        .ascending()
        .numbers(Bound::TIME, [2, MOST_ENTRIES]);
    let has_time = object.has("time");
    object.condition(|| {
        json!({
            "if": is("type", "table"),
            "then": {"required": ["time"],
                     "properties": {"sea_level": false, "vacuum": {"type": "array"}}},
            "else": {"properties": {"time": false, "vacuum": {"type": "number"}}},
        })
    });
    if is_table {
        if !has_time {
            object.fault_of("time", "is required for a table");
        }
        if object.has("sea_level") {
            object.fault_of("sea_level", "must be omitted for a table; give exit_area");
        }
        if let Some(NumberOrList::Number(_)) = vacuum {
            object.fault_of("vacuum", "must be an array of numbers for a table, got a number");
        }
    } else {
        if has_time {
            object.fault_of("time", "must be omitted without \"type\": \"table\"");
        }
        if let Some(NumberOrList::List(_)) = vacuum {
            object.fault_of("vacuum", "must be a number without \"type\": \"table\", got an array");
        }
    }
    match (vacuum?, time) {
        (NumberOrList::Number(vacuum), _) => {
            if let Some(sea_level) = sea_level.filter(|sea_level| *sea_level > vacuum) {
                let detail = format!("must be at most the thrust in vacuum, {vacuum} N, got {sea_level}");
                object.fault_of("sea_level", detail);
            }
            Some((ThrustProfile::Constant(vacuum), sea_level))
        }
        (NumberOrList::List(vacuum), Some(time)) => {
            let sound = object.equally_long("time", &["vacuum"]);
            if let Some(first) = time.first().filter(|first| **first != 0.0) {
                object.fault_of("time/0", format!("must be 0, the ignition, got {first}"));
            }
            let entries = time.into_iter().zip(vacuum).map(|(time, thrust)| ThrustEntry { time, thrust });
            sound.then(|| (ThrustProfile::Table(entries.collect::<Vec<_>>().into()), None))
        }
        (NumberOrList::List(_), None) => None,
    }
}

impl NamedPart {
    /// The place of a name in a list.
    pub(super) fn place_of(name: &str, parts: &[Self]) -> Option<usize> {
        parts.iter().position(|part| part.name == name)
    }

    /// Names that several parts have; `pointer` is that of the list.
    pub(super) fn faults(parts: &[Self], pointer: &str) -> Vec<Fault> {
        let mut names = HashSet::new();
        let mut faults = Vec::new();
        for (index, part) in parts.iter().enumerate() {
            if !names.insert(part.name.as_str()) {
                let detail = format!("must be unique, got {} again", quoted(&part.name));
                faults.push(Fault::new(format!("{pointer}/{index}/name"), detail));
            }
        }
        faults
    }

    /// What is wrong with a name that must be that of a part, with an engine where it says so; `pointer` is that of the name.
    pub(super) fn name_fault(name: &str, parts: &[Self], with_engine: bool, pointer: String) -> Option<Fault> {
        let fits = |part: &&Self| !with_engine || part.core.engine.is_some();
        if parts.iter().filter(fits).any(|part| part.name == name) {
            return None;
        }
        let what = if with_engine { "a part with an engine" } else { "a part" };
        let mut names: Vec<_> = parts.iter().filter(fits).map(|part| quoted(&part.name)).collect();
        names.dedup();
        let more = names.len().saturating_sub(MOST_NAMED);
        names.truncate(MOST_NAMED);
        let names = match more {
            0 if names.is_empty() => "there is none".to_owned(),
            0 => names.join(", "),
            more => format!("{} and {more} more", names.join(", ")),
        };
        let got = quoted(name);
        Some(Fault::new(pointer, format!("must be the name of {what} ({names}), got {got}")))
    }

    /// The pointer to the number that gives the exit area, relative to the part.
    pub(super) fn exit_area_pointer(&self) -> &'static str {
        if self.gives_sea_level { "engine/thrust/sea_level" } else { "engine/exit_area" }
    }
}
