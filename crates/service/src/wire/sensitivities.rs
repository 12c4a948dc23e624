//! The derivatives of a flight, in the units of the request.

use reentry::Interrupt;
use reentry::coordinates::FlightPath;
use reentry::sensitivity::{Gradient as CoreGradient, Sensitivities as CoreSensitivities, Slopes};
use serde::Serialize;
use utoipa::ToSchema;

use super::AngleUnit;
use super::columns::AvailableQuantities;
use super::description::{BooleanOrObject, Object};
use super::events::Event;
use super::numbers::{Change, MOST_VARIED, Numbers, Varied, immovable};
use super::outputs::{FlightOutput, OutputNumber, output};
use super::reader::Fault;

/// Whether a request asks for derivatives, and for which.
#[derive(Clone, Debug)]
pub enum RequestedSensitivities {
    /// For none.
    Nothing,
    /// For those of the flight's end by a fixed list of numbers.
    FinalState,
    /// For those of outputs by numbers.
    Matrix {
        /// The outputs.
        of: Vec<FlightOutput>,
        /// The pointers of the numbers.
        to: Vec<String>,
    },
}

const SENSITIVITIES: BooleanOrObject = BooleanOrObject {
    name: "RequestedSensitivities",
    doc: "Which derivatives of the flight the answer has.",
    boolean: "`true`: those of the flight's end by a fixed list of numbers, for the computing of about six flights.",
    object: "an object with outputs and numbers",
};

/// The greatest count of outputs.
const MOST_OUTPUTS: usize = 64;

/// The field `sensitivities` of a request.
pub(super) fn asked(object: &mut Object) -> Option<RequestedSensitivities> {
    object
        .field("sensitivities", "Sensitivity of the landing point")
        .doc(
            "Whether the answer has derivatives of the flight, and which: `true`, or of outputs (`of`) by numbers of the case (`to`). Not with CSV \
             or on a map.",
        )
        .default(false)
        .boolean_or(&SENSITIVITIES, |asked| if asked { RequestedSensitivities::FinalState } else { RequestedSensitivities::Nothing }, matrix)
}

fn matrix(object: &mut Object) -> Option<RequestedSensitivities> {
    object.named("SensitivityMatrix", "The derivatives of outputs by numbers of the case.");
    let of = object.field("of", "Outputs").doc("The outputs.").objects([1, MOST_OUTPUTS], output);
    let to = object
        .field("to", "Inputs")
        .doc(
            "JSON pointers of numbers in this request, as `echo` shows it; of a list of numbers each is meant. Together at most 64 \
             numbers.",
        )
        .texts(MOST_VARIED);
    Some(RequestedSensitivities::Matrix { of: of?, to: to? })
}

impl RequestedSensitivities {
    /// Whether there is anything asked for.
    pub fn is_something(&self) -> bool {
        !matches!(self, Self::Nothing)
    }

    /// The pointers of the numbers.
    pub(super) fn pointers(&self) -> impl Iterator<Item = &str> {
        let to: &[String] = if let Self::Matrix { to, .. } = self { to } else { &[] };
        to.iter().map(String::as_str)
    }

    /// What is wrong with the outputs and the pointers, in a request of which so much is known, and with these events.
    pub(super) fn faults(&self, known: AvailableQuantities, events: &[Event], numbers: &Numbers) -> Vec<Fault> {
        let Self::Matrix { of, to } = self else { return Vec::new() };
        let place = |(index, output): (usize, &FlightOutput)| {
            output.fault(&format!("/sensitivities/of/{index}"), known, events)
        };
        let mut faults: Vec<_> = of.iter().enumerate().filter_map(place).collect();
        let places = to.iter().enumerate().map(|(index, pointer)| (format!("/sensitivities/to/{index}"), pointer));
        let (count, of_pointers) = numbers.faults(places);
        faults.extend(of_pointers);
        if count > MOST_VARIED {
            let detail = format!("must be pointers of at most {MOST_VARIED} numbers together, got {count}");
            faults.push(Fault::new("/sensitivities/to", detail));
        }
        faults
    }

    /// The numbers by which there are derivatives, each with its variation and what is known where it is moved; not all of them once
    /// `interrupt` is raised.
    ///
    /// # Errors
    /// With the numbers that cannot be moved.
    pub fn variations(&self, numbers: &Numbers, interrupt: &dyn Interrupt) -> Result<Vec<VariedNumber>, Vec<Fault>> {
        let Self::Matrix { to, .. } = self else { return Ok(Vec::new()) };
        let mut faults = Vec::new();
        let mut variations = Vec::new();
        for (index, pointer) in to.iter().enumerate() {
            for field in numbers.at(pointer).unwrap_or_default() {
                if interrupt.is_raised() {
                    break;
                }
                match numbers.variation(&[field], Change::Offset) {
                    Some(varied) => variations.push(VariedNumber {
                        pointer: field.pointer.clone(),
                        value: numbers.value(field),
                        varied,
                    }),
                    None => {
                        faults.push(Fault::new(format!("/sensitivities/to/{index}"), immovable(&field.pointer)));
                    }
                }
            }
        }
        if faults.is_empty() { Ok(variations) } else { Err(faults) }
    }
}

/// A number of a case that varies.
#[derive(Clone, Debug)]
pub struct VariedNumber {
    /// Its pointer.
    pub pointer: String,
    /// Its value, in the unit of the request.
    pub value: f64,
    /// How it varies.
    pub varied: Varied,
}

/// The derivatives for which a request asks.
#[derive(Clone, Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub enum SensitivitiesAnswer {
    /// With `"sensitivities": true`.
    FinalState(Box<Sensitivities>),
    /// With `of` and `to`.
    Matrix(Matrix),
}

/// The derivatives of outputs by numbers of the case, each by itself, in the units of the request; the steps of the integration are kept, and
/// what happens on the way moves along.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Matrix {
    /// The outputs: one for each row. A site has two, `east` and `north` of it, m.
    pub of: Vec<MatrixRow>,
    /// The numbers: one for each column.
    pub to: Vec<MatrixColumn>,
    /// The derivatives, row by row; null where there is none.
    pub matrix: Vec<Vec<Option<f64>>>,
}

/// An output.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct MatrixRow {
    /// The quantity; of a site `east` or `north`.
    pub quantity: &'static str,
    /// When it is taken, s; null where the flight has no such moment: an event that does not happen, or a time after the end.
    #[schema(required = true)]
    pub time: Option<f64>,
    /// Its value; null where there is none.
    #[schema(required = true)]
    pub value: Option<f64>,
}

/// A number of the case.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct MatrixColumn {
    /// Its pointer.
    pub pointer: String,
    /// Its value.
    pub value: f64,
    /// How its column was made.
    pub method: Method,
}

/// How derivatives were made.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Method {
    /// The number passes through the flight with its derivatives: good to about ten digits.
    Exact,
    /// The number is part of a model, whose forces are differenced with it at every state along the same steps; these differences are of
    /// fourth order: good to about eight digits.
    Differences,
}

impl Matrix {
    /// The matrix of a flight.
    pub fn new(outputs: &[OutputNumber], numbers: Vec<VariedNumber>, slopes: Vec<Slopes>, methods: &[Method]) -> Self {
        let rows = outputs.iter().zip(&slopes);
        Self {
            of: rows
                .map(|(output, slopes)| MatrixRow { quantity: output.name, time: slopes.time, value: slopes.value })
                .collect(),
            to: numbers
                .into_iter()
                .zip(methods)
                .map(|(VariedNumber { pointer, value, .. }, method)| MatrixColumn { pointer, value, method: *method })
                .collect(),
            matrix: slopes.into_iter().map(|row| row.slopes.into_iter().map(finite).collect()).collect(),
        }
    }
}

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

/// A number of an answer: null where it is none.
pub(super) fn finite(number: f64) -> Option<f64> {
    Some(number).filter(|number| number.is_finite())
}
