//! How the vehicle is flown: its bank angle and its angle of attack, constant or by a schedule.

use std::sync::Arc;

use crate::interpolation::{self, TableError};
use crate::scalar::Scalar;

/// The commands of the vehicle's angles.
#[derive(Clone, Debug, PartialEq)]
pub struct Control {
    /// σ, rad: 0 lift in the plane of radius and velocity, upward;
    /// positive tilts it to the left of the flight direction, towards growing heading (Jameson 2006, equation 22).
    pub bank_angle: Command,
    /// α, rad, on which coefficients may depend.
    pub angle_of_attack: Command,
}

/// An angle during the flight.
#[derive(Clone, Debug, PartialEq)]
pub enum Command {
    /// The same all the time, rad.
    Constant(f64),
    /// By a schedule.
    Schedule(Arc<Schedule>),
}

/// The independent variable of a schedule.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Against {
    /// Since the start, s.
    Time,
    /// Along the radius vector, m.
    Altitude,
    /// Relative to the rotating planet, m/s.
    Speed,
    /// The speed relative to the air over that of sound.
    Mach,
    /// Relative to the planet, of the velocity and the potentials of gravity and of the centrifugal force, J/kg: in still air it never grows
    /// but by thrust.
    Energy,
    /// Since the event of this place in the list happened, s; until then the value of the first entry holds.
    Since(usize),
}

/// What a schedule does between its entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Interpolation {
    /// Straight lines.
    Linear,
    /// An entry's value holds from it up to the next greater one.
    Step,
}

/// An angle along a quantity of the flight; before the first entry and after the last their values hold.
#[derive(Clone, Debug, PartialEq)]
pub struct Schedule {
    against: Against,
    /// Where the formula changes, ascending.
    corners: Vec<f64>,
    /// Of each segment between corners the value where it begins, rad, and the slope; the first has no beginning but the first corner.
    segments: Vec<Stretch>,
}

/// A straight piece: base + slope (x - origin).
#[derive(Clone, Copy, Debug, PartialEq)]
struct Stretch {
    origin: f64,
    base: f64,
    slope: f64,
}

impl Command {
    /// What it runs along and where its formula changes, ascending; nothing where it is constant.
    pub(crate) fn corners(&self) -> Option<(Against, &[f64])> {
        match self {
            Self::Constant(_) => None,
            // What has not happened turns nothing.
            Self::Schedule(schedule) if matches!(schedule.against, Against::Since(_)) => None,
            Self::Schedule(schedule) => Some((schedule.against, &schedule.corners)),
        }
    }

    /// What it runs along; nothing where it is constant.
    pub fn against(&self) -> Option<Against> {
        match self {
            Self::Constant(_) => None,
            Self::Schedule(schedule) => Some(schedule.against),
        }
    }

    /// The event since which it runs, if it does.
    pub(crate) fn event(&self) -> Option<usize> {
        match self.against() {
            Some(Against::Since(event)) => Some(event),
            _ => None,
        }
    }

    /// The same after the event since which it runs, if there is one, has happened at a time, s; none where it has not.
    pub(crate) fn since(&self, time_of: impl Fn(usize) -> Option<f64>) -> Self {
        match (self, self.event().and_then(time_of)) {
            (Self::Schedule(schedule), Some(time)) => Self::Schedule(Arc::new(schedule.in_time_from(time))),
            (other, _) => other.clone(),
        }
    }
}

impl Control {
    /// Constant angles: the bank angle, rad, and no angle of attack.
    pub fn banked(bank_angle: f64) -> Self {
        Self { bank_angle: Command::Constant(bank_angle), angle_of_attack: Command::Constant(0.0) }
    }

    /// Both commands: the bank angle, and the angle of attack.
    pub(crate) fn commands(&self) -> [&Command; 2] {
        [&self.bank_angle, &self.angle_of_attack]
    }

    /// Whether a command runs along a quantity.
    pub(crate) fn is_by(&self, against: Against) -> bool {
        self.commands().into_iter().any(|command| command.against() == Some(against))
    }

    /// The same after events since which commands run have happened, each at a time, s; none of one that has not.
    pub(crate) fn since(&self, time_of: impl Fn(usize) -> Option<f64>) -> Self {
        let [bank_angle, angle_of_attack] = self.commands().map(|command| command.since(&time_of));
        Self { bank_angle, angle_of_attack }
    }
}

impl Schedule {
    /// The schedule through the given entries: ascending numbers of the quantity, and angles in rad.
    ///
    /// # Errors
    /// When there are none, not as many of the one as of the other, or they do not ascend.
    pub fn new(against: Against, at: &[f64], value: &[f64], interpolation: Interpolation) -> Result<Self, TableError> {
        interpolation::check(at, &[value])?;
        let level = |base: f64| Stretch { origin: 0.0, base, slope: 0.0 };
        let (corners, segments) = match interpolation {
            Interpolation::Step => (at[1..].to_vec(), value.iter().copied().map(level).collect()),
            Interpolation::Linear => {
                let between = at.windows(2).zip(value.windows(2)).map(|(at, value)| Stretch {
                    origin: at[0],
                    base: value[0],
                    slope: (value[1] - value[0]) / (at[1] - at[0]),
                });
                let (first, last) = (level(value[0]), level(value[value.len() - 1]));
                (at.to_vec(), std::iter::once(first).chain(between).chain([last]).collect())
            }
        };
        Ok(Self { against, corners, segments })
    }

    /// Its independent variable.
    pub fn against(&self) -> Against {
        self.against
    }

    /// The same schedule with an angle, rad, added everywhere.
    #[must_use]
    pub fn turned_by(&self, angle: f64) -> Self {
        let turned = |segment: &Stretch| Stretch { base: segment.base + angle, ..*segment };
        Self { segments: self.segments.iter().map(turned).collect(), ..self.clone() }
    }

    /// The same schedule against another quantity.
    #[must_use]
    pub fn along(&self, against: Against) -> Self {
        Self { against, ..self.clone() }
    }

    /// The same schedule against the time since the start, where its own time begins at one, s.
    fn in_time_from(&self, start: f64) -> Self {
        Self {
            against: Against::Time,
            corners: self.corners.iter().map(|corner| corner + start).collect(),
            segments: self
                .segments
                .iter()
                .map(|segment| Stretch { origin: segment.origin + start, ..*segment })
                .collect(),
        }
    }

    /// The angle, rad, where the quantity has a value, by the formula of a segment: 0 before the first corner, 1 after it, and so on.
    #[inline(always)]
    pub fn angle<S: Scalar>(&self, segment: usize, quantity: S) -> S {
        let Stretch { origin, base, slope } = self.segments[segment];
        (quantity - origin) * slope + base
    }
}
