//! Steering: where the axis of a vehicle points, and with it the thrust of its engines.

use nalgebra::Rotation3;

use crate::control::{Against, Command};

/// The direction of the axis of the vehicle, along which its engines push it.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Steering {
    /// The outward normal of the planet's shape below the vehicle.
    Vertical,
    /// The velocity relative to the planet, from which the angle of attack leans the axis as the bank angle says: a gravity turn where
    /// there is none. Vertical at rest.
    #[default]
    Velocity,
    /// Two angles.
    Program(Program),
    /// tan p = a - b t, in the plane of the first axis and the third.
    ///
    /// # Reference
    /// A. E. Bryson and Y.-C. Ho, Applied Optimal Control, 1975, section 2.4.
    LinearTangent {
        /// As those of a program, in inertial space.
        axes: Rotation3<f64>,
        /// At t = 0.
        a: f64,
        /// 1/s.
        b: f64,
    },
}

/// Two angles that give a direction: cos p (cos y ê₁ + sin y ê₂) + sin p ê₃.
#[derive(Clone, Debug, PartialEq)]
pub struct Program {
    /// The axes.
    pub axes: ProgramAxes,
    /// p, above the plane of the first two axes, rad.
    pub pitch: Command,
    /// y, from the first axis to the second, rad; of local axes the azimuth, from north to east.
    pub yaw: Command,
}

/// The axes of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum ProgramAxes {
    /// Three that stay in inertial space, while the planet turns; as the columns of their planet-fixed components at t = 0.
    Inertial(Rotation3<f64>),
    /// North, east and away from the planet's centre.
    Local,
}

impl Steering {
    /// Whether the axis points somewhere by itself, and not by angles from the velocity.
    pub fn is_attitude(&self) -> bool {
        !matches!(self, Self::Velocity)
    }

    /// The commands of pitch and yaw, if there are any.
    pub(crate) fn commands(&self) -> Option<[&Command; 2]> {
        match self {
            Self::Program(Program { pitch, yaw, .. }) => Some([pitch, yaw]),
            Self::Vertical | Self::Velocity | Self::LinearTangent { .. } => None,
        }
    }

    /// Whether a command runs along a quantity.
    pub(crate) fn is_by(&self, against: Against) -> bool {
        self.commands().into_iter().flatten().any(|command| command.against() == Some(against))
    }

    /// The same after events since which commands run have happened, each at a time, s; none of one that has not.
    pub(crate) fn since(&self, time_of: impl Fn(usize) -> Option<f64>) -> Self {
        match self {
            Self::Program(Program { axes, pitch, yaw }) => {
                let [pitch, yaw] = [pitch, yaw].map(|command| command.since(&time_of));
                Self::Program(Program { axes: *axes, pitch, yaw })
            }
            other => other.clone(),
        }
    }
}
