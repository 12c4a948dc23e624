//! The commands of angles: constant, or by a schedule.

use std::sync::Arc;

use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::scenario::Bound;
use serde_json::json;

use super::description::{AngleOrObject, Field, Object, WordOrObject, Words, word};
use super::names::EventNames;
use super::reader::{Fault, MOST_ENTRIES};
use super::schema::{bounds, is};

/// What a schedule runs along.
const AGAINST: Words<Against> = Words {
    name: "Against",
    doc: "Independent variable of a schedule.",
    words: &[
        word("time", Against::Time, "Time, s").unit("s").doc("Time since the start, s."),
        word("altitude", Against::Altitude, "Altitude, m").unit("m").doc("Altitude along the radius vector, m."),
        word("speed", Against::Speed, "Speed, m/s").unit("m/s").doc("Speed relative to the rotating planet, m/s."),
        word("mach", Against::Mach, "Mach number")
            .doc("Mach number: air speed over speed of sound. The atmosphere must have a speed of sound."),
        word("energy", Against::Energy, "Energy, J/kg").unit("J/kg").doc(
            "Energy relative to the rotating planet, J/kg, as in the column `energy`: half the squared relative speed \
             plus the gravitational potential (0 at infinity) minus half the squared speed of the planet's rotation at \
             that place. In still air, only thrust increases it.",
        ),
    ],
};

/// A quantity of the flight, or the time since an event.
const VARIABLE: WordOrObject = WordOrObject {
    name: "ScheduleVariable",
    doc: "Independent variable of a schedule: a word for a quantity of the flight, or the time since an event.",
};

/// A command of an angle, with the name of the event since which it runs.
#[derive(Clone, Debug)]
pub struct CommandRequest {
    /// The same for the core, but for the event.
    pub core: Command,
    /// The name of the event since which it runs, if it does.
    since: Option<String>,
}

/// What a schedule of a request runs along.
enum Variable {
    Quantity(Against),
    Since(String),
}

impl From<Against> for Variable {
    fn from(against: Against) -> Self {
        Self::Quantity(against)
    }
}

impl CommandRequest {
    /// The core's command; a schedule since an event of no name in the list runs since one beyond its end.
    pub(super) fn to_core(&self, events: &EventNames) -> Command {
        match (&self.core, &self.since) {
            (Command::Schedule(schedule), Some(name)) => {
                let event = events.place_of(name);
                Command::Schedule(Arc::new(schedule.along(Against::Since(event))))
            }
            (other, _) => other.clone(),
        }
    }

    /// What is wrong with the name of the event since which it runs; `pointer` is that of the command.
    pub(super) fn name_fault(&self, pointer: &str, events: &EventNames) -> Option<Fault> {
        events.fault(self.since.as_ref()?, format!("{pointer}/against/since"))
    }

    /// Whether it is anything but 0 all the time.
    pub(super) fn is_given(&self) -> bool {
        !matches!(self.core, Command::Constant(angle) if angle == 0.0)
    }
}

/// What a schedule does between its entries.
const INTERPOLATION: Words<Interpolation> = Words {
    name: "Interpolation",
    doc: "Interpolation between the entries of a schedule.",
    words: &[
        word("linear", Interpolation::Linear, "Linear").doc("Linear interpolation."),
        word("step", Interpolation::Step, "Step").doc("Each value holds from its entry up to the next greater one."),
    ],
};

/// An angle, or a schedule of it.
const COMMAND: AngleOrObject = AngleOrObject {
    name: "Command",
    doc: "Angle during the flight: a constant or a schedule.",
    angle: "Constant angle, within ±2π (±360°).",
    object: "an object with a schedule",
};

/// A command that is 0 where it is left out.
pub(super) fn command(field: Field) -> Option<CommandRequest> {
    required_command(field.default(0.0))
}

/// A command.
pub(super) fn required_command(field: Field) -> Option<CommandRequest> {
    let constant = |angle| CommandRequest { core: Command::Constant(angle), since: None };
    let schedule = |object: &mut Object| {
        let (schedule, since) = schedule(object)?;
        Some(CommandRequest { core: Command::Schedule(Arc::new(schedule)), since })
    };
    field.angle_or(&COMMAND, Bound::TURN, constant, schedule)
}

fn schedule(object: &mut Object) -> Option<(Schedule, Option<String>)> {
    object.named(
        "Schedule",
        "Angle as a function of a quantity of the flight. Before the first entry and after the last, their values \
         hold. Both lists must have the same length.",
    );
    object.of_type("schedule", "Always `schedule`.", entries)
}

fn since(object: &mut Object) -> Option<Variable> {
    object.named(
        "SinceEvent",
        "Time since an event, s. Until the event happens, the first value of the schedule holds, and if it never \
         happens, for the whole flight.",
    );
    object.field("since", "Since event").doc("Name of the event.").text().map(Variable::Since)
}

fn entries(object: &mut Object) -> Option<(Schedule, Option<String>)> {
    let variable = object.field("against", "Independent variable").doc("Independent variable of the schedule.");
    // The event is found by its name where all events are known.
    let (against, since) = match variable.word_or(&VARIABLE, &AGAINST, since) {
        Some(Variable::Quantity(against)) => (Some(against), None),
        Some(Variable::Since(name)) => (Some(Against::Since(0)), Some(name)),
        None => (None, None),
    };
    let bound = match against {
        Some(Against::Altitude) => Bound::DISTANCE,
        Some(Against::Energy) | None => Bound::FINITE,
        Some(Against::Time | Against::Since(_) | Against::Speed | Against::Mach) => Bound::NON_NEGATIVE,
    };
    let unit = match against {
        Some(Against::Since(_)) => "s",
        other => other.map_or("", |against| AGAINST.unit_of(against)),
    };
    let at = object
        .field("at", "Breakpoint")
        .doc(
            "Values of the independent variable, ascending, in its unit. Times, speed and Mach number must be at least \
             0. The energy is negative near the planet; a descent passes its values from the last to the first.",
        )
        .unit(unit)
        .ascending()
        .numbers(bound, [1, MOST_ENTRIES]);
    object.condition(|| {
        let at = |bound| json!({"properties": {"at": {"items": bounds(bound)}}});
        json!({"if": is("against", "altitude"), "then": at(Bound::DISTANCE)})
    });
    object.condition(|| {
        let signed = ["altitude", "energy"].map(|word| is("against", word));
        let at = json!({"properties": {"at": {"items": bounds(Bound::NON_NEGATIVE)}}});
        json!({"if": {"not": {"anyOf": signed}}, "then": at})
    });
    let value = object
        .field("value", "Angle")
        .doc("Angles at these values, within ±2π (±360°).")
        .angles(Bound::TURN, MOST_ENTRIES);
    let sound = object.equally_long("at", &["value"]);
    let interpolation = object
        .field("interpolation", "Interpolation")
        .doc("Interpolation between the entries.")
        .default("linear")
        .word(&INTERPOLATION);
    let (against, at, value, interpolation) = (against?, at?, value?, interpolation?);
    let schedule = sound.then(|| Schedule::new(against, &at, &value, interpolation))?;
    Some((object.sound(schedule)?, since))
}
