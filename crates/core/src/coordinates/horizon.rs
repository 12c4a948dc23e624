//! The horizon where a flight starts, as axes.

use nalgebra::{Matrix3, Rotation3, Vector3};

use super::{FlightPath, PlanetFixed, Rotation};
use crate::planet::Shape;

/// The axes of the horizon where a flight starts, as the columns of planet-fixed components: ahead along its heading on the plane normal to the
/// radius vector, to the left of that, and up.
pub fn horizon(state: &PlanetFixed<f64>) -> Rotation {
    let level = FlightPath { speed: 1.0, flight_path_angle: 0.0, ..FlightPath::from_planet_fixed(state) };
    axes(level.to_planet_fixed().velocity, &state.position.normalize())
}

/// The same of a launch, whose velocity points along its azimuth, on the horizon of the planet's shape.
pub fn launch_horizon(launch: &PlanetFixed<f64>, shape: &Shape) -> Rotation {
    axes(launch.velocity, &shape.normal(&launch.position))
}

/// The axes from a direction that is level, or nearly so, and the upward one.
fn axes(ahead: Vector3<f64>, up: &Vector3<f64>) -> Rotation {
    let left = up.cross(&ahead).normalize();
    let ahead = left.cross(up);
    Rotation3::from_matrix_unchecked(Matrix3::from_columns(&[ahead, left, *up]))
}
