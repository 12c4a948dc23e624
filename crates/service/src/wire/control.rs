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
    doc: "Independent variable of a schedule.",
    words: &[
        word("time", Against::Time, "Time, s").unit("s").doc("Time since the start, s."),
        word("altitude", Against::Altitude, "Altitude, m").unit("m").doc("Altitude along the radius vector, m."),
        word("speed", Against::Speed, "Speed, m/s").unit("m/s").doc("Speed relative to the rotating planet, m/s."),
        word("mach", Against::Mach, "Mach number")
            .doc("Mach number: air speed over speed of sound. The atmosphere must have a speed of sound."),
    ],
};

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

/// How the vehicle is flown.
pub(super) fn control(object: &mut Object) -> Option<Control> {
    object.named("Control", "Bank angle and angle of attack during the flight; each is a constant or a schedule.");
    let bank_angle = command(object.field("bank_angle", "Bank angle").doc(
        "Bank angle. At 0, lift points upward in the plane of radius and velocity; a positive angle tilts it to the \
         left of the flight direction.",
    ));
    let angle_of_attack = command(
        object
            .field("angle_of_attack", "Angle of attack")
            .doc("Angle of attack. Only the coefficients of an `alpha_mach_table` depend on it."),
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
        "Angle as a function of a quantity of the flight. Before the first entry and after the last, their values \
         hold. Both lists must have the same length.",
    );
    object.of_type("schedule", "Always `schedule`.", entries)
}

fn entries(object: &mut Object) -> Option<Schedule> {
    let against =
        object.field("against", "Independent variable").doc("Independent variable of the schedule.").word(&AGAINST);
    let bound = match against {
        Some(Against::Altitude) => Bound::DISTANCE,
        Some(Against::Time | Against::Speed | Against::Mach) => Bound::NON_NEGATIVE,
        None => Bound::FINITE,
    };
    let at = object
        .field("at", "Breakpoint")
        .doc(
            "Values of the independent variable, ascending, in its unit. Time, speed and Mach number must be at least \
             0.",
        )
        .unit(against.map_or("", |against| AGAINST.unit_of(against)))
        .ascending()
        .numbers(bound, [1, MOST_ENTRIES]);
    object.condition(|| {
        let at = |bound| json!({"properties": {"at": {"items": bounds(bound)}}});
        json!({"if": is("against", "altitude"), "then": at(Bound::DISTANCE), "else": at(Bound::NON_NEGATIVE)})
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
    object.sound(schedule)
}
