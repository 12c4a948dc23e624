//! What the user of a flight should know.

use reentry::body::Body;
use reentry::coordinates::UndefinedElements;
use reentry::elementary::pow;
use reentry::motion::{LIFT_FADE_ANGLE, WIND_FADE_ANGLE};
use reentry::number_text::{NumberText, apart, rounded};
use reentry::simulate::SimulationError;
use reentry::trajectory::{self, TableId};
use reentry::vehicle::Aerodynamics;
use serde::Serialize;
use utoipa::ToSchema;

use super::bodies::{DescribedBody, FlownBody};
use super::epoch::Epoch;
use super::heating::Heating;
use super::planet::{Planet, PlanetModel};
use super::scenario::SimulateRequest;
use super::state::{FRAMES, Frame, State};
use super::{Angle, AngleUnit};

/// For what a case is flown.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The flight itself.
    Flight,
    /// A theory beside it, which needs an exponential atmosphere.
    Theory,
}

/// Warning about the request or the flight.
#[derive(Clone, Debug, PartialEq, Serialize, ToSchema)]
pub struct Warning {
    /// Code of the warning, for programs.
    pub code: &'static str,
    /// Explanation of the warning, for people.
    pub detail: String,
    /// Time in the flight, s; present where it applies.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub time: Option<f64>,
}

impl Warning {
    fn new(code: &'static str, detail: &str) -> Self {
        Self { code, detail: detail.to_owned(), time: None }
    }

    /// What there is to know of the flight of a vehicle and of the request for it; with the reason for which it could not be verified, if it was
    /// to be, and with the purpose of the flight.
    pub fn of(
        request: &SimulateRequest,
        vehicle: &FlownBody,
        unverified: Option<SimulationError>,
        purpose: Purpose,
    ) -> Vec<Self> {
        let flight = vehicle.flight;
        let of_flight = |warning: &_| Self::of_flight(*warning, request.angle_unit, &vehicle.described);
        let mut warnings: Vec<_> = flight.warnings().iter().map(of_flight).collect();
        warnings.extend(Self::of_request(request, purpose));
        if let Some(error) = unverified {
            let detail = format!("Verification failed: at a hundredth of its tolerance, {error}");
            warnings.push(Self::new("not_verified", &detail));
        }
        let relative_tolerance = request.solver.relative_tolerance;
        if flight.end_time() > longest_within_a_metre(relative_tolerance) && !request.verify {
            warnings.push(Self::long_flight(flight.end_time(), relative_tolerance));
        }
        warnings
    }

    /// What there is to know of a request, whatever is flown.
    pub fn of_request(request: &SimulateRequest, purpose: Purpose) -> Vec<Self> {
        let mut warnings: Vec<_> = request.assumed.angle_unit.then(Self::angle_unit_assumed).into_iter().collect();
        warnings
            .extend(request.assumed.thesis_atmosphere.then(|| Self::thesis_atmosphere(request.planet.model, purpose)));
        warnings.extend(Self::gas_of_earth(request));
        warnings.extend(request.atmosphere.standard_of.and_then(Self::atmosphere_of_low_confidence));
        let later = request.events.iter().filter_map(|event| event.then.core.aerodynamics.as_ref());
        let mut flown = std::iter::once(&request.vehicle.aerodynamics).chain(later);
        let by_angle_of_attack = flown.any(|aerodynamics| matches!(aerodynamics, Aerodynamics::AlphaMachTable(_)));
        if request.control.angle_of_attack.is_given() && !by_angle_of_attack {
            let detail = "control.angle_of_attack has no effect: only an alpha_mach_table depends on it";
            warnings.push(Self::new("angle_of_attack_unused", detail));
        }
        warnings.extend(Self::of_frame(&request.initial_state, request.epoch, &request.planet));
        warnings
    }

    /// What there is to know of a footprint, of the part of whose ranges so much lands.
    pub fn of_footprint(landed: f64, is_complete: bool) -> Vec<Self> {
        let mut warnings = Vec::new();
        if landed < 1.0 {
            let detail = "With a part of the ranges flights do not land, or fail: the footprint has what the others reach. `landed` tells \
                          how many, `classes` how flights end, `search.failed` which fail";
            warnings.push(Self::new("partly_landed", detail));
        }
        if !is_complete {
            let detail = "The boundary is not as accurate as resolution: flights or time ran out, or it follows an edge where flights jump \
                          to another end. Increase search.flights or resolution, or narrow the ranges";
            warnings.push(Self::new("coarse_boundary", detail));
        }
        warnings
    }

    /// What there is to know of the flight of a body.
    pub fn of_body(request: &SimulateRequest, body: &FlownBody) -> Vec<Self> {
        let warnings = body.flight.warnings().iter();
        warnings.map(|warning| Self::of_flight(*warning, request.angle_unit, &body.described)).collect()
    }

    /// Angles were read in the default unit.
    pub fn angle_unit_assumed() -> Self {
        let detail =
            "Angles were read as radians: angle_unit is absent. Set \"angle_unit\": \"deg\" for degrees, or \"rad\"";
        Self::new("angle_unit_assumed", detail)
    }

    /// The default air is denser than the Earth's.
    fn thesis_atmosphere(planet: PlanetModel, purpose: Purpose) -> Self {
        let remedy = match planet {
            _ if purpose == Purpose::Theory => {
                "Theories need an exponential one: set its \"surface_density\" and \"scale_height\", or {\"type\": \"exponential\"} to keep it"
            }
            PlanetModel::Custom => "Set the \"atmosphere\" of the planet",
            _ => "Set \"atmosphere\": {\"type\": \"standard\"}, or {\"type\": \"exponential\"} to keep it",
        };
        let detail = format!(
            "Air is the thesis's exponential atmosphere of the Earth, the default: 1.548 kg/m³ at the ground, 26 % more than us76 \
             (1.225 kg/m³). {remedy}"
        );
        Self::new("thesis_atmosphere", &detail)
    }

    /// Of another planet, what is the Earth's.
    fn gas_of_earth(request: &SimulateRequest) -> Vec<Self> {
        if request.planet.is_earth() {
            return Vec::new();
        }
        let of_air = request.atmosphere.of_earth.filter(|_| !request.assumed.thesis_atmosphere).map(str::to_owned);
        let correlations = request.heating.iter().flat_map(Heating::of_air).map(|correlation| {
            let remedy = match *correlation {
                "tauber_sutton" => "set \"radiative\": \"none\"",
                _ => "give {\"type\": \"sutton_graves\", \"constant\": k} of the gas",
            };
            format!("Heat flux by {correlation} is that in the Earth's air: {remedy}")
        });
        of_air.into_iter().chain(correlations).map(|detail| Self::new("gas_of_earth", &detail)).collect()
    }

    /// The standard atmosphere of the body is hardly known.
    fn atmosphere_of_low_confidence(body: &Body) -> Option<Self> {
        let detail = format!(
            "Standard atmosphere of {} is of low confidence: GET /planets tells its source and what is known of its errors",
            body.title
        );
        body.has_atmosphere_of_low_confidence().then(|| Self::new("atmosphere_of_low_confidence", &detail))
    }

    /// The errors of the steps may have grown.
    fn long_flight(end: f64, relative_tolerance: f64) -> Self {
        let [hours, days] = [end / 3600.0, end / 86_400.0];
        let length = if days < 2.0 { format!("{hours:.1} hours") } else { format!("{days:.1} days") };
        let detail = format!(
            "Flight lasts {length}: at a relative_tolerance of {} its end may be off by more than 1 m. \
             Set \"verify\": true to get the error",
            NumberText(relative_tolerance)
        );
        Self::new("long_flight", &detail)
    }

    /// The theories know no bank.
    pub fn bank_left_out() -> Self {
        let detail = "Theory has no bank: it takes all lift as upward, while the simulated flight banks";
        Self::new("bank_angle_left_out", detail)
    }

    /// The theories know no wind.
    pub fn wind_left_out() -> Self {
        let detail = "Theory has no wind: its speed and angle are for still air, while the simulated flight has wind";
        Self::new("wind_left_out", detail)
    }

    fn of_flight(warning: trajectory::Warning, unit: AngleUnit, of: &DescribedBody) -> Self {
        let (code, detail) = match warning {
            trajectory::Warning::LiftFadedNearVertical { time } => {
                let (angle, from) = (Angle(LIFT_FADE_ANGLE, unit), seconds(time));
                let detail = format!(
                    "Lift fades out within {angle} of the vertical, where the bank angle is undefined (from {from})"
                );
                ("lift_faded_near_vertical", detail)
            }
            trajectory::Warning::WindFadedNearPole { time } => {
                let (angle, from) = (Angle(WIND_FADE_ANGLE, unit), seconds(time));
                let detail = format!(
                    "Wind fades out within {angle} of a pole, where there is neither east nor north (from {from})"
                );
                ("wind_faded_near_pole", detail)
            }
            trajectory::Warning::OutsideTable { table, time, altitude, edge, above } => {
                let code = if matches!(table, TableId::Us76 | TableId::Nrlmsise00) {
                    "outside_model"
                } else {
                    "outside_table"
                };
                (code, outside(table, edge, above, unit, &format!("from {}, at {}", seconds(time), length(altitude))))
            }
            trajectory::Warning::OutsideRange {
                correlation,
                quantity,
                unit,
                value,
                range: [least, greatest],
                time,
            } => {
                let [value, least, greatest] = apart([value, least, greatest]);
                let bounds = if greatest.starts_with(char::is_numeric) {
                    format!("from {least} to {greatest} {unit}")
                } else {
                    format!("from {least} {unit} on")
                };
                let detail = format!(
                    "{correlation} is valid for a {quantity} {bounds}: at its peak heat flux it is {value} {unit} (at \
                     {})",
                    seconds(time)
                );
                ("outside_range", detail)
            }
            trajectory::Warning::NotLit { event, part, is_there, time } => {
                let why = if is_there { "burns already" } else { "has left the vehicle" };
                let (event, part) = (of.event(event), of.part(part));
                let detail = format!("Ignition of {event} has no effect (at {}): part {part} {why}", seconds(time));
                ("not_lit", detail)
            }
            trajectory::Warning::NeverLifted { time } => {
                let detail = format!(
                    "Vehicle never lifts off: its thrust does not exceed its weight until the flight ends (at {})",
                    seconds(time)
                );
                ("never_lifted", detail)
            }
            trajectory::Warning::PropellantSpent { time } => {
                ("propellant_spent", format!("Propellant is spent: the thrust ends (at {})", seconds(time)))
            }
            trajectory::Warning::ThrustWithoutDirection { event, time } => {
                let event = of.event(event);
                let detail = format!(
                    "Thrust of {event} has no direction (at {}): its direction is undefined at rest or in \
                     vertical flight. It acts once the direction is defined",
                    seconds(time)
                );
                ("no_direction", detail)
            }
            trajectory::Warning::NotDeployed { event, parachute, time } => {
                let [event, parachute] = [event, parachute].map(|place| of.event(place));
                let detail = format!(
                    "Release of {event} has no effect (at {}): the parachute of {parachute} is not deployed",
                    seconds(time)
                );
                ("not_deployed", detail)
            }
            trajectory::Warning::NoDirection { event, time } => {
                let event = of.event(event);
                let detail = format!(
                    "Impulse of {event} has no effect (at {}): its direction is undefined at rest or in \
                     vertical flight",
                    seconds(time)
                );
                ("no_direction", detail)
            }
        };
        Self { time: Some(warning.time()), ..Self::new(code, &detail) }
    }

    /// Which orbital elements are conventions.
    pub fn of_undefined_elements(undefined: UndefinedElements) -> Vec<Self> {
        let circular = "Orbit is circular: argument_of_periapsis is 0 and true_anomaly counts from the node";
        let equatorial = "Orbit is equatorial: raan is 0 and argument_of_periapsis counts from the inertial x axis \
                          in the direction of motion";
        let warnings = [
            undefined.circular.then(|| Self::new("circular_orbit", circular)),
            undefined.equatorial.then(|| Self::new("equatorial_orbit", equatorial)),
        ];
        warnings.into_iter().flatten().collect()
    }

    /// There are no orbital elements.
    pub fn rectilinear() -> Self {
        let detail = "Orbit has no elements: the inertial motion is along the radius vector, or too close to it";
        Self::new("rectilinear_motion", detail)
    }

    /// In which frame an inertial state was taken, at an epoch.
    pub fn of_frame(state: &State, epoch: Option<Epoch>, planet: &Planet) -> Option<Self> {
        let frame = state.frame.filter(|_| epoch.is_some())?;
        if let PlanetModel::Body(body) = planet.model {
            let axis = if state.gives_sidereal() {
                "turned by the sidereal time or angle of the state"
            } else {
                "with the x axis at its ascending node on the equator of the ICRF"
            };
            let detail = format!(
                "Inertial frame is date: the equator of {}, {axis}. Vectors in the ICRF or EME2000 must be turned into it first",
                body.title
            );
            return Some(Self::new("inertial_frame_of_date", &detail));
        }
        if !planet.is_earth() {
            return None;
        }
        Some(match frame {
            Frame::Date => {
                let turned = if state.gives_sidereal() {
                    "the Earth's equator of date, turned by the sidereal time or angle of the state"
                } else {
                    "the Earth's equator and celestial intermediate origin of date"
                };
                let detail = format!(
                    "Inertial frame is date: {turned}. Set \"frame\" to teme for vectors of SGP4 or gcrf for J2000, which in 2026 lie up to \
                     38 km and 16 km from it on the ground"
                );
                Self::new("inertial_frame_of_date", &detail)
            }
            Frame::Teme | Frame::Gcrf => {
                let detail = format!(
                    "Inertial frame is {}, without polar motion and UT1-UTC: at most 18 m and 0.9 s, which is 420 m on the equator",
                    FRAMES.of(frame)
                );
                Self::new("earth_orientation_neglected", &detail)
            }
        })
    }
}

/// What a table or a model does outside its range.
fn outside(table: TableId, edge: f64, above: bool, unit: AngleUnit, since: &str) -> String {
    let [ends, beyond] = if above { ["ends", "above"] } else { ["begins", "below"] };
    match table {
        TableId::Atmosphere => {
            let edge = length(edge);
            format!(
                "Atmosphere table {ends} at {edge}: {beyond} it the logarithm of the density is extrapolated linearly \
                 ({since})"
            )
        }
        TableId::Us76 => {
            let holds = if above {
                "the density falls with the scale height at that altitude"
            } else {
                "its lowest layer is continued"
            };
            format!("Atmosphere us76 {ends} at {}: {beyond} it {holds} ({since})", length(edge))
        }
        TableId::Nrlmsise00 => {
            let holds =
                if above { "its formulas are continued" } else { "the air has the temperature at that altitude" };
            format!("Atmosphere nrlmsise00 {ends} at {}: {beyond} it {holds} ({since})", length(edge))
        }
        TableId::Wind => {
            let edge = length(edge);
            format!("Wind table {ends} at {edge}: its {edge} wind is used {beyond} it ({since})")
        }
        TableId::Mach => {
            let edge = NumberText(edge);
            format!("Aerodynamic table {ends} at Mach {edge}: its Mach {edge} values are used {beyond} it ({since})")
        }
        TableId::Radiation => {
            let edge = NumberText(edge);
            format!("Radiation table {ends} at {edge} m/s: its {edge} m/s value is used {beyond} it ({since})")
        }
        TableId::AngleOfAttack => {
            let edge = Angle(edge, unit);
            format!(
                "Aerodynamic table {ends} at an angle of attack of {edge}: its {edge} values are used {beyond} it ({since})"
            )
        }
    }
}

/// A length or an altitude, m, for people: to four digits, in km from 1 km on.
fn length(metres: f64) -> String {
    if metres.abs() < 1000.0 {
        format!("{} m", NumberText(rounded(metres, 4)))
    } else {
        format!("{} km", NumberText(rounded(metres / 1000.0, 4)))
    }
}

/// A time, s, for people: to a tenth.
fn seconds(time: f64) -> String {
    format!("{} s", (time * 10.0).round() / 10.0)
}

/// The longest flight, s, that a tolerance keeps within 1 m: two hours with the default one, and longer with a finer one.
///
/// Measured on decays from circular orbits in `us76`: 1e-10 gives 1 m after 3 hours, 10 m after 3 days and 700 m after 20; 1e-12 0.04 m
/// after 3 days and 1.3 m after 11; 1e-13 0.3 m after 20. `tests/core/verification.rs` holds flights to it.
pub fn longest_within_a_metre(relative_tolerance: f64) -> f64 {
    const BY_DEFAULT: [f64; 2] = [7200.0, 1e-10];
    let [longest, default] = BY_DEFAULT;
    longest * pow(default / relative_tolerance, 0.8).max(1.0)
}

#[cfg(test)]
mod tests {
    use reentry::trajectory::{TableId, Warning as CoreWarning};

    use super::{AngleUnit, DescribedBody, Warning};

    #[test]
    fn a_table_that_is_left_is_told_with_what_holds_beyond() {
        for (table, edge, above, expected) in [
            (
                TableId::Atmosphere,
                1e5,
                true,
                "Atmosphere table ends at 100 km: above it the logarithm of the density is extrapolated linearly \
                 (from 52.9 s, at 109.1 km)",
            ),
            (
                TableId::Us76,
                1e6,
                true,
                "Atmosphere us76 ends at 1000 km: above it the density falls with the scale height at that altitude \
                 (from 52.9 s, at 109.1 km)",
            ),
            (
                TableId::Us76,
                -5e3,
                false,
                "Atmosphere us76 begins at -5 km: below it its lowest layer is continued (from 52.9 s, at 109.1 km)",
            ),
            (
                TableId::Wind,
                -10.0,
                false,
                "Wind table begins at -10 m: its -10 m wind is used below it (from 52.9 s, at 109.1 km)",
            ),
            (
                TableId::Mach,
                25.0,
                true,
                "Aerodynamic table ends at Mach 25: its Mach 25 values are used above it (from 52.9 s, at 109.1 km)",
            ),
            (
                TableId::Radiation,
                16e3,
                true,
                "Radiation table ends at 16000 m/s: its 16000 m/s value is used above it (from 52.9 s, at 109.1 km)",
            ),
            (
                TableId::AngleOfAttack,
                std::f64::consts::FRAC_PI_2,
                true,
                "Aerodynamic table ends at an angle of attack of 90°: its 90° values are used above it (from 52.9 s, at 109.1 km)",
            ),
        ] {
            let time = 52.916_530_598_660_5;
            let warning = CoreWarning::OutsideTable { table, time, altitude: 109_054.394_121_244_55, edge, above };
            let warning = Warning::of_flight(warning, AngleUnit::Deg, &DescribedBody::default());
            let code = if table == TableId::Us76 { "outside_model" } else { "outside_table" };
            assert_eq!((warning.code, warning.time, warning.detail.as_str()), (code, Some(time), expected));
        }
    }
}
