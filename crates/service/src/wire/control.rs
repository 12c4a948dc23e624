//! How the vehicle of a request is flown.

use std::sync::Arc;

use reentry::control::{Against, Command, Control, Interpolation, Schedule};
use reentry::scenario::Bound;
use serde_json::json;

use super::description::{AngleOrObject, Field, Object, Words, word};
use super::reader::MOST_ENTRIES;
use super::schema::{bounds, is};

/// What a schedule runs along.
const AGAINST: Words<Against> = Words {
    name: "Against",
    doc: "What a schedule runs along.",
    words: &[
        word("time", Against::Time, "Time, s").unit("s").doc("Since the start, s."),
        word("altitude", Against::Altitude, "Altitude, m").unit("m").doc("Along the radius vector, m."),
        word("speed", Against::Speed, "Speed, m/s").unit("m/s").doc("Relative to the rotating planet, m/s."),
        word("mach", Against::Mach, "Mach number")
            .doc("The speed relative to the air over that of sound; needs an atmosphere that has a speed of sound."),
    ],
};

/// What a schedule does between its entries.
const INTERPOLATION: Words<Interpolation> = Words {
    name: "Interpolation",
    doc: "What a schedule does between its entries.",
    words: &[
        word("linear", Interpolation::Linear, "Linear").doc("Straight lines."),
        word("step", Interpolation::Step, "Step").doc("An entry's value holds from it up to the next greater one."),
    ],
};

/// An angle, or a schedule of it.
const COMMAND: AngleOrObject = AngleOrObject {
    name: "Command",
    doc: "An angle during the flight: a number, or a schedule.",
    angle: "The same all the time, within ±2π (±360°).",
    object: "an object with a schedule",
};

/// How the vehicle is flown.
pub(super) fn control(object: &mut Object) -> Option<Control> {
    object.named("Control", "How the vehicle is flown: each angle a number, or by a schedule.");
    let bank_angle = command(object.field("bank_angle", "Bank angle").doc(
        "0: lift upward in the plane of radius and velocity; positive tilts it to the left of the flight direction.",
    ));
    let angle_of_attack = command(
        object
            .field("angle_of_attack", "Angle of attack")
            .doc("On which the coefficients of an `alpha_mach_table` depend, and no other."),
    );
    Some(Control { bank_angle: bank_angle?, angle_of_attack: angle_of_attack? })
}

fn command(field: Field) -> Option<Command> {
    let schedule = |object: &mut Object| schedule(object).map(Arc::new).map(Command::Schedule);
    field.default(0.0).angle_or(&COMMAND, Bound::TURN, Command::Constant, schedule)
}

/// Whether a command is anything but 0 all the time.
pub(super) fn is_given(command: &Command) -> bool {
    !matches!(command, Command::Constant(angle) if *angle == 0.0)
}

fn schedule(object: &mut Object) -> Option<Schedule> {
    object.named(
        "Schedule",
        "An angle along a quantity of the flight; before the first entry and after the last their values hold. Both lists have as many.",
    );
    object.of_type("schedule", "`schedule`, which tells it from a number.", entries)
}

fn entries(object: &mut Object) -> Option<Schedule> {
    let against = object.field("against", "Independent variable").doc("What it runs along.").word(&AGAINST);
    let bound = match against {
        Some(Against::Altitude) => Bound::DISTANCE,
        Some(Against::Time | Against::Speed | Against::Mach) => Bound::NON_NEGATIVE,
        None => Bound::FINITE,
    };
    let at = object
        .field("at", "Breakpoint")
        .doc("Ascending, in the unit of the quantity; time, speed and Mach number at least 0.")
        .unit(against.map_or("", |against| AGAINST.unit_of(against)))
        .ascending()
        .numbers(bound, [1, MOST_ENTRIES]);
    object.condition(|| {
        let at = |bound| json!({"properties": {"at": {"items": bounds(bound)}}});
        json!({"if": is("against", "altitude"), "then": at(Bound::DISTANCE), "else": at(Bound::NON_NEGATIVE)})
    });
    let value =
        object.field("value", "Angle").doc("The angles there, within ±2π (±360°).").angles(Bound::TURN, MOST_ENTRIES);
    let sound = object.equally_long("at", &["value"]);
    let interpolation = object
        .field("interpolation", "Interpolation")
        .doc("What it does between its entries.")
        .default("linear")
        .word(&INTERPOLATION);
    let (against, at, value, interpolation) = (against?, at?, value?, interpolation?);
    let schedule = sound.then(|| Schedule::new(against, &at, &value, interpolation))?;
    object.sound(schedule)
}
