//! What the user of a flight should know.

use reentry::coordinates::UndefinedElements;
use reentry::trajectory::{self, Lookup, Trajectory};
use serde::Serialize;
use utoipa::ToSchema;

use super::AngleUnit;
use super::epoch::Instant;
use super::planet::Planet;
use super::scenario::SimulateRequest;
use super::state::{Frame, State};
use super::trajectory::Extras;
use super::vehicle::Aerodynamics;

/// Something that the user should know.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Warning {
    /// For programs.
    pub code: &'static str,
    /// For people.
    pub detail: String,
    /// When in the flight, s, where that has a meaning.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub time: Option<f64>,
}

impl Warning {
    fn new(code: &'static str, detail: &str) -> Self {
        Self { code, detail: detail.to_owned(), time: None }
    }

    /// What there is to know of a flight and of the request for it.
    pub fn of(request: &SimulateRequest, flight: &Trajectory, extras: &Extras) -> Vec<Self> {
        let of_flight = |warning: &_| Self::of_flight(*warning, request.angle_unit);
        let mut warnings: Vec<_> = flight.warnings().iter().map(of_flight).collect();
        let later = request.events.iter().filter_map(|event| event.then.aerodynamics.as_ref());
        let mut flown = std::iter::once(&request.vehicle.aerodynamics).chain(later);
        let by_angle_of_attack = flown.any(|aerodynamics| matches!(aerodynamics, Aerodynamics::AlphaMachTable(_)));
        if request.control.angle_of_attack.is_given() && !by_angle_of_attack {
            let detail =
                "control.angle_of_attack changes nothing: only the coefficients of an alpha_mach_table depend on it";
            warnings.push(Self::new("angle_of_attack_unused", detail));
        }
        warnings.extend(Self::of_frame(&request.initial_state, request.epoch, &request.planet));
        if let Some(error) = extras.unverified {
            let detail = format!("at a hundredth of its tolerance the flight cannot be finished: {error}");
            warnings.push(Self::new("not_verified", &detail));
        }
        warnings
    }

    /// The theories know no bank.
    pub fn bank_left_out() -> Self {
        let detail = "the theory knows no bank: it takes the whole lift as upward, while the simulated flight banks";
        Self::new("bank_angle_left_out", detail)
    }

    /// The theories know no wind.
    pub fn wind_left_out() -> Self {
        let detail =
            "the theory knows no wind: its speed and angle are as in still air, while the simulated flight has wind";
        Self::new("wind_left_out", detail)
    }

    fn of_flight(warning: trajectory::Warning, unit: AngleUnit) -> Self {
        match warning {
            trajectory::Warning::LiftFadedNearVertical { time } => {
                let detail = "the flight came within 0.001 rad of the vertical, where the bank angle is undefined; \
                              lift fades out there";
                Self { time: Some(time), ..Self::new("lift_faded_near_vertical", detail) }
            }
            trajectory::Warning::WindFadedNearPole { time } => {
                let detail = "the wind fades out within 0.001 rad of a pole, where there is neither east nor north";
                Self { time: Some(time), ..Self::new("wind_faded_near_pole", detail) }
            }
            trajectory::Warning::OutsideTable { table, time, altitude, edge, above } => {
                let (table, edge, holds) = match table {
                    Lookup::Atmosphere => (
                        "the atmosphere",
                        format!("an altitude of {edge} m"),
                        "the logarithm of the density goes on in a straight line",
                    ),
                    Lookup::Wind => ("the wind", format!("an altitude of {edge} m"), "the wind of the edge holds"),
                    Lookup::Mach => {
                        ("the aerodynamics", format!("a Mach number of {edge}"), "the coefficients of the edge hold")
                    }
                    Lookup::Radiation => {
                        ("the radiation", format!("a speed of {edge} m/s"), "the value of f(V) at the edge holds")
                    }
                    Lookup::AngleOfAttack => (
                        "the aerodynamics",
                        format!("an angle of attack of {}", unit.from_radians(edge)),
                        "the coefficients of the edge hold",
                    ),
                };
                let end = if above { "ends" } else { "begins" };
                let detail = format!(
                    "the table of {table} {end} at {edge}; the flight leaves it at {time} s, at an altitude of {altitude} m, \
                     and beyond {holds}"
                );
                Self { time: Some(time), ..Self::new("outside_table", &detail) }
            }
            trajectory::Warning::OutsideRange {
                correlation,
                quantity,
                unit,
                value,
                range: [least, greatest],
                time,
            } => {
                let bounds = if greatest.is_finite() {
                    format!("from {least} to {greatest} {unit}")
                } else {
                    format!("from {least} {unit} on")
                };
                let detail = format!(
                    "at the peak of its heat flux, at {time} s, the {quantity} is {value} {unit}; {correlation} was made for values {bounds}"
                );
                Self { time: Some(time), ..Self::new("outside_range", &detail) }
            }
            trajectory::Warning::PropellantSpent { time } => {
                let detail = "the propellant was spent, and the thrust ended";
                Self { time: Some(time), ..Self::new("propellant_spent", detail) }
            }
            trajectory::Warning::ThrustWithoutDirection { event, time } => {
                let detail = format!(
                    "the thrust of event {event} has no direction where it is switched on: at rest there is no velocity, and in vertical \
                     flight nothing level, along which it could act; it acts as soon as there is"
                );
                Self { time: Some(time), ..Self::new("no_direction", &detail) }
            }
            trajectory::Warning::NotDeployed { event, parachute, time } => {
                let detail = format!(
                    "event {event} releases the parachute of event {parachute}, which is not deployed at that time"
                );
                Self { time: Some(time), ..Self::new("not_deployed", &detail) }
            }
            trajectory::Warning::NoDirection { event, time } => {
                let detail = format!(
                    "the delta_v of event {event} changed nothing: at rest there is no velocity, and in vertical flight nothing normal, \
                     along which it could act"
                );
                Self { time: Some(time), ..Self::new("no_direction", &detail) }
            }
        }
    }

    /// Which orbital elements are conventions.
    pub fn of_undefined_elements(undefined: UndefinedElements) -> Vec<Self> {
        let circular = "the orbit is circular: argument_of_periapsis is 0 and true_anomaly counts from the node";
        let equatorial = "the orbit is equatorial: raan is 0 and argument_of_periapsis counts from the inertial x axis \
                          in the direction of motion";
        let warnings = [
            undefined.circular.then(|| Self::new("circular_orbit", circular)),
            undefined.equatorial.then(|| Self::new("equatorial_orbit", equatorial)),
        ];
        warnings.into_iter().flatten().collect()
    }

    /// There are no orbital elements.
    pub fn rectilinear() -> Self {
        let detail = "the inertial motion is towards or away from the planet's centre, or so nearly that orbital elements \
                      would not hold it: there are none";
        Self::new("rectilinear_motion", detail)
    }

    /// In which frame an inertial state was taken, on the Earth at an epoch.
    pub fn of_frame(state: &State, epoch: Option<Instant>, planet: &Planet) -> Option<Self> {
        let frame = state.frame().filter(|_| epoch.is_some() && planet.is_earth())?;
        Some(match frame {
            Frame::Date => {
                let turned = if state.gives_sidereal() {
                    "the Earth's equator of date, turned by the sidereal time or angle of the state"
                } else {
                    "the Earth's equator and celestial intermediate origin of date"
                };
                let detail = format!(
                    "frame date was taken: {turned}; frame selects teme for vectors of SGP4 and gcrf for J2000, which in 2026 lie up to \
                     38 km and 16 km from that origin on the ground"
                );
                Self::new("inertial_frame_of_date", &detail)
            }
            Frame::Teme | Frame::Gcrf => {
                let detail = format!(
                    "frame {} was taken with polar motion and UT1-UTC left out: at most 18 m and 0.9 s, which is 420 m on the equator",
                    frame.name()
                );
                Self::new("earth_orientation_neglected", &detail)
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use reentry::trajectory::{Lookup, Warning as CoreWarning};

    use super::{AngleUnit, Warning};

    #[test]
    fn a_table_that_is_left_is_told_with_what_holds_beyond() {
        for (table, edge, above, expected) in [
            (
                Lookup::Atmosphere,
                1e5,
                true,
                "the table of the atmosphere ends at an altitude of 100000 m; the flight leaves it at 1.5 s, at an altitude of \
                 2000 m, and beyond the logarithm of the density goes on in a straight line",
            ),
            (
                Lookup::Wind,
                -10.0,
                false,
                "the table of the wind begins at an altitude of -10 m; the flight leaves it at 1.5 s, at an altitude of 2000 m, \
                 and beyond the wind of the edge holds",
            ),
            (
                Lookup::Mach,
                0.5,
                false,
                "the table of the aerodynamics begins at a Mach number of 0.5; the flight leaves it at 1.5 s, at an altitude of \
                 2000 m, and beyond the coefficients of the edge hold",
            ),
            (
                Lookup::AngleOfAttack,
                std::f64::consts::FRAC_PI_2,
                true,
                "the table of the aerodynamics ends at an angle of attack of 90; the flight leaves it at 1.5 s, at an altitude of \
                 2000 m, and beyond the coefficients of the edge hold",
            ),
        ] {
            let warning = CoreWarning::OutsideTable { table, time: 1.5, altitude: 2000.0, edge, above };
            let warning = Warning::of_flight(warning, AngleUnit::Deg);
            assert_eq!((warning.code, warning.time, warning.detail.as_str()), ("outside_table", Some(1.5), expected));
        }
    }
}
