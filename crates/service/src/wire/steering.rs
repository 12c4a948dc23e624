//! Where the axis of the vehicle of a request points, and with it the thrust of its engines.

use reentry::control::Command;
use reentry::coordinates::Rotation;
use reentry::scenario::Bound;
use reentry::steering::{Program, ProgramAxes, Steering as CoreSteering};

use super::commands::{CommandRequest, command, required_command};
use super::description::{Object, Words, variant, word};
use super::names::EventNames;
use super::reader::Fault;

/// The steering of a request.
#[derive(Clone, Debug, Default)]
pub enum Steering {
    /// Along the normal of the planet's shape.
    Vertical,
    /// Along the velocity.
    #[default]
    Velocity,
    /// By two angles: pitch and yaw.
    Program(Frame, Box<[CommandRequest; 2]>),
    /// tan(pitch) = a - b t.
    LinearTangent(f64, f64),
}

/// The frame of a program.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Frame {
    /// The horizon of the launch site at t = 0.
    Launch,
    /// The horizon below the vehicle.
    Local,
    /// The planet's equator.
    Inertial,
}

const FRAMES: Words<Frame> = Words {
    name: "SteeringFrame",
    doc: "Frame of a steering program.",
    words: &[
        word("launch", Frame::Launch, "Launch").doc(
            "Horizon of the initial place at t = 0 and the azimuth of the launch, fixed in inertial space; without a \
             launch, the heading of the initial state.",
        ),
        word("local", Frame::Local, "Local").doc("Plane normal to the radius vector below the vehicle, and north."),
        word("inertial", Frame::Inertial, "Inertial").doc("Inertial frame of the initial state."),
    ],
};

/// The frames that a flight has, as axes with planet-fixed components at t = 0.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axes {
    /// Downrange, left of it, and up.
    pub(super) launch: Rotation,
    /// Takes components in the inertial frame to planet-fixed ones at t = 0.
    pub(super) to_planet: Rotation,
}

/// A steering.
pub(super) fn steering(object: &mut Object) -> Option<Steering> {
    object.named("Steering", "Direction of the vehicle's axis, along which its engines push.");
    object.variants(
        "Kind of steering.",
        &[
            variant("vertical", "Vertical", "Along the outward normal of the planet's shape.", &vertical),
            variant(
                "velocity",
                "Along the velocity",
                "Along the velocity relative to the rotating planet: a gravity turn.",
                &velocity,
            ),
            variant("program", "Program", "Two angles, each a constant or a schedule.", &program),
            variant("linear_tangent", "Linear tangent", "Linear tangent law.", &linear_tangent),
        ],
    )
}

#[expect(clippy::unnecessary_wraps, reason = "the descriptions of objects have one type")]
fn vertical(object: &mut Object) -> Option<Steering> {
    object.named("VerticalSteering", "Axis along the outward normal of the planet's shape below the vehicle.");
    Some(Steering::Vertical)
}

#[expect(clippy::unnecessary_wraps, reason = "the descriptions of objects have one type")]
fn velocity(object: &mut Object) -> Option<Steering> {
    object.named(
        "VelocitySteering",
        "Axis along the velocity relative to the rotating planet, at rest along the outward normal of the planet's \
         shape. `control.angle_of_attack` and `control.bank_angle` tilt it away from the velocity.",
    );
    Some(Steering::Velocity)
}

fn program(object: &mut Object) -> Option<Steering> {
    object.named("ProgramSteering", "Axis by two angles in a frame; each is a constant or a schedule.");
    let frame = object.field("frame", "Frame").doc("Frame of the angles.").word(&FRAMES);
    if frame.is_none() {
        // Which of the angles belong here is not known.
        for name in ["pitch", "yaw", "azimuth", "right_ascension", "declination"] {
            object.has(name);
        }
    }
    let pitch = object.only_unless("frame", "inertial", |object| {
        required_command(
            object.field("pitch", "Pitch").doc("Angle of the axis above the horizontal plane of the frame."),
        )
    });
    let yaw = object.only_where("frame", "launch", |object| {
        command(object.field("yaw", "Yaw").doc("Angle of the axis to the left of the azimuth of the launch."))
    });
    let azimuth = object.only_where("frame", "local", |object| {
        required_command(object.field("azimuth", "Azimuth").doc("Azimuth of the axis, clockwise from north."))
    });
    let right_ascension = object.only_where("frame", "inertial", |object| {
        required_command(object.field("right_ascension", "Right ascension").doc("Right ascension of the axis."))
    });
    let declination = object.only_where("frame", "inertial", |object| {
        required_command(object.field("declination", "Declination").doc("Declination of the axis."))
    });
    let frame = frame?;
    let [pitch, yaw] = match frame {
        Frame::Launch => [pitch?, yaw?],
        Frame::Local => [pitch?, azimuth?],
        Frame::Inertial => [declination?, right_ascension?],
    };
    Some(Steering::Program(frame, Box::new([pitch, yaw])))
}

fn linear_tangent(object: &mut Object) -> Option<Steering> {
    object.named(
        "LinearTangentSteering",
        "Linear tangent law in the vertical plane of the launch azimuth: tan(pitch) = a - b t, with the time since \
         t = 0 and the pitch above the horizon of the launch.",
    );
    let a = object.field("a", "a").doc("Tangent of the pitch at t = 0.").number(Bound::FINITE);
    let b = object.field("b", "b").doc("Decrease of the tangent, 1/s.").unit("1/s").number(Bound::FINITE);
    Some(Steering::LinearTangent(a?, b?))
}

impl Steering {
    /// Whether the axis points somewhere by itself, and not by angles from the velocity.
    pub(super) fn is_attitude(&self) -> bool {
        !matches!(self, Self::Velocity)
    }

    /// Whether it needs the angle between the inertial frame and the planet.
    pub(super) fn is_inertial(&self) -> bool {
        matches!(self, Self::Program(Frame::Inertial, _))
    }

    /// The same for the core.
    pub(super) fn to_core(&self, events: &EventNames, axes: &Axes) -> CoreSteering {
        match self {
            Self::Vertical => CoreSteering::Vertical,
            Self::Velocity => CoreSteering::Velocity,
            Self::LinearTangent(a, b) => CoreSteering::LinearTangent { axes: axes.launch, a: *a, b: *b },
            Self::Program(frame, commands) => {
                let [pitch, yaw]: [Command; 2] = commands.each_ref().map(|command| command.to_core(events));
                let axes = match frame {
                    Frame::Launch => ProgramAxes::Inertial(axes.launch),
                    Frame::Inertial => ProgramAxes::Inertial(axes.to_planet),
                    Frame::Local => ProgramAxes::Local,
                };
                CoreSteering::Program(Program { axes, pitch, yaw })
            }
        }
    }

    /// The names of the angle above a plane and of that in the plane.
    pub(super) fn angles(&self) -> [&'static str; 2] {
        match self {
            Self::Program(Frame::Local, _) => ["pitch", "azimuth"],
            Self::Program(Frame::Inertial, _) => ["declination", "right_ascension"],
            _ => ["pitch", "yaw"],
        }
    }

    /// Names of events that are not those of one event alone; `pointer` is that of the steering.
    pub(super) fn name_faults(&self, pointer: &str, events: &EventNames) -> Vec<Fault> {
        let Self::Program(_, commands) = self else { return Vec::new() };
        let faults = self.angles().into_iter().zip(commands.iter());
        faults.filter_map(|(field, command)| command.name_fault(&format!("{pointer}/{field}"), events)).collect()
    }
}
