//! The derivatives of a flight's end, in the units of the request.

use reentry::coordinates::FlightPath;
use reentry::sensitivity::{Gradient as CoreGradient, Sensitivities as CoreSensitivities};
use serde::Serialize;
use utoipa::ToSchema;

use super::AngleUnit;

/// How the end of the flight changes with the numbers of the case, each by itself, in the units of the request.
/// The steps of the integration are kept, and the impact moves along: these are the exact derivatives of what was computed.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Sensitivities {
    /// Of the final time; 0 where the flight ends at `stop.time`.
    pub time: Gradient,
    /// Of the final longitude.
    pub longitude: Gradient,
    /// Of the final geocentric latitude.
    pub geocentric_latitude: Gradient,
    /// Of the final speed.
    pub speed: Gradient,
    /// Of the final flight-path angle.
    pub flight_path_angle: Gradient,
}

/// The derivatives of one quantity; null where there is none: by a number that the case does not have; at a grazing impact and, of
/// what is undefined there, at the end of a flight at rest, in vertical flight, or at a pole.
/// The last six are by the initial state in its `planet_relative` form, with its `radius`.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Gradient {
    /// Per kg.
    #[schema(required = true)]
    pub mass: Option<f64>,
    /// Per m².
    #[schema(required = true)]
    pub reference_area: Option<f64>,
    /// Per unit of the coefficient.
    #[schema(required = true)]
    pub lift_coefficient: Option<f64>,
    /// Per unit of the coefficient.
    #[schema(required = true)]
    pub drag_coefficient: Option<f64>,
    /// Per radian or degree.
    #[schema(required = true)]
    pub bank_angle: Option<f64>,
    /// Per kg/m³ at altitude 0; null but with an exponential atmosphere.
    #[schema(required = true)]
    pub surface_density: Option<f64>,
    /// Per unit of the factor.
    #[schema(required = true)]
    pub density_factor: Option<f64>,
    /// Per m.
    #[schema(required = true)]
    pub radius: Option<f64>,
    /// Per radian or degree.
    #[schema(required = true)]
    pub longitude: Option<f64>,
    /// Per radian or degree, at the same radius.
    #[schema(required = true)]
    pub geocentric_latitude: Option<f64>,
    /// Per m/s.
    #[schema(required = true)]
    pub speed: Option<f64>,
    /// Per radian or degree.
    #[schema(required = true)]
    pub flight_path_angle: Option<f64>,
    /// Per radian or degree.
    #[schema(required = true)]
    pub heading: Option<f64>,
}

impl Sensitivities {
    /// The derivatives in the given unit of angles.
    pub fn from_core(core: &CoreSensitivities, unit: AngleUnit) -> Self {
        let plain = |gradient| Gradient::from_core(gradient, 1.0, unit);
        let angle = |gradient| Gradient::from_core(gradient, unit.from_radians(1.0), unit);
        Self {
            time: plain(&core.time),
            longitude: angle(&core.longitude),
            geocentric_latitude: angle(&core.geocentric_latitude),
            speed: plain(&core.speed),
            flight_path_angle: angle(&core.flight_path_angle),
        }
    }
}

impl Gradient {
    /// The derivatives of a quantity whose unit is `scale` times smaller than the core's.
    fn from_core(gradient: &CoreGradient, scale: f64, unit: AngleUnit) -> Self {
        let finite = |slope: f64| Some(slope).filter(|slope| slope.is_finite());
        let by = |slope: f64| finite(slope * scale);
        let by_angle = |slope: f64| finite(unit.to_radians(slope * scale));
        let FlightPath { radius, longitude, geocentric_latitude, speed, flight_path_angle, heading } =
            gradient.initial_state;
        Self {
            mass: by(gradient.mass),
            reference_area: by(gradient.reference_area),
            lift_coefficient: by(gradient.lift_coefficient),
            drag_coefficient: by(gradient.drag_coefficient),
            bank_angle: by_angle(gradient.bank_angle),
            surface_density: by(gradient.surface_density),
            density_factor: by(gradient.density_factor),
            radius: by(radius),
            longitude: by_angle(longitude),
            geocentric_latitude: by_angle(geocentric_latitude),
            speed: by(speed),
            flight_path_angle: by_angle(flight_path_angle),
            heading: by_angle(heading),
        }
    }
}
