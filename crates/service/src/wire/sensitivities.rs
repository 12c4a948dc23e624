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
    doc: "Derivatives of the flight in the response.",
    boolean: "`true` gives the derivatives of the end of the flight by a fixed list of numbers. They take the \
              computing time of about six flights.",
    object: "an object with outputs and numbers",
};

/// The greatest count of outputs.
const MOST_OUTPUTS: usize = 64;

/// The field `sensitivities` of a request.
pub(super) fn asked(object: &mut Object) -> Option<RequestedSensitivities> {
    object
        .field("sensitivities", "Sensitivity of the landing point")
        .doc(
            "Derivatives of the flight in the response: `true`, or outputs (`of`) by numbers of the case (`to`). Not \
             supported for CSV, OEM and map formats.",
        )
        .default(false)
        .boolean_or(
            &SENSITIVITIES,
            |asked| if asked { RequestedSensitivities::FinalState } else { RequestedSensitivities::Nothing },
            matrix,
        )
}

fn matrix(object: &mut Object) -> Option<RequestedSensitivities> {
    object.named("SensitivityMatrix", "Derivatives of outputs by numbers of the case.");
    let of = object.field("of", "Outputs").doc("Outputs to differentiate.").objects([1, MOST_OUTPUTS], output);
    let to = object
        .field("to", "Inputs")
        .doc(
            "JSON pointers of numbers in this request, defaults included (see `echo`). A pointer to a list selects \
             each of its numbers. At most 64 numbers in total.",
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
            let detail = format!("must point to at most {MOST_VARIED} numbers in total, got {count}");
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

/// Derivatives requested by `sensitivities`.
#[derive(Clone, Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub enum SensitivitiesAnswer {
    /// Response to `"sensitivities": true`.
    FinalState(Box<Sensitivities>),
    /// Response to `of` and `to`.
    Matrix(Matrix),
}

/// Derivatives of outputs by numbers of the case, in the units of the request. Each number varies alone. The steps of
/// the integration are kept; the times of events and of the end vary with the number.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Matrix {
    /// Outputs, one per row. A site has two rows, `east` and `north` of it, m.
    pub of: Vec<MatrixRow>,
    /// Numbers, one per column.
    pub to: Vec<MatrixColumn>,
    /// Derivatives, row by row; null where undefined.
    pub matrix: Vec<Vec<Option<f64>>>,
}

/// Output of the flight.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct MatrixRow {
    /// Column of the trajectory, or `east` or `north` for a site.
    pub quantity: &'static str,
    /// Time at which the output is evaluated, s; null if the flight has no such moment (an event that does not happen,
    /// or a time after the end).
    #[schema(required = true)]
    pub time: Option<f64>,
    /// Value of the output; null where undefined.
    #[schema(required = true)]
    pub value: Option<f64>,
}

/// Number of the case.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct MatrixColumn {
    /// JSON pointer of the number.
    pub pointer: String,
    /// Value of the number.
    pub value: f64,
    /// Method of differentiation.
    pub method: Method,
}

/// Method of differentiation. `exact`: the number is carried through the flight with its derivatives, accurate to about
/// 10 digits. `differences`: the number is part of a model whose forces are differenced at every state along the same
/// steps, to fourth order, accurate to about 8 digits.
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

/// Derivatives of the end of the flight by numbers of the case, in the units of the request. Each number varies alone.
/// The steps of the integration are kept and the time of impact varies with the number, so these are the exact
/// derivatives of the computed flight.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Sensitivities {
    /// Derivatives of the final time; 0 where the flight ends at `stop.time`.
    pub time: Gradient,
    /// Derivatives of the final longitude.
    pub longitude: Gradient,
    /// Derivatives of the final geocentric latitude.
    pub geocentric_latitude: Gradient,
    /// Derivatives of the final speed.
    pub speed: Gradient,
    /// Derivatives of the final flight-path angle.
    pub flight_path_angle: Gradient,
}

/// Derivatives of one quantity. A derivative is null if the case does not have the number, at a grazing impact and, for
/// quantities that are undefined there, at rest, in vertical flight or at a pole. The last six are by the initial state
/// in its `planet_relative` form with `radius`.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Gradient {
    /// Derivative by mass, per kg.
    #[schema(required = true)]
    pub mass: Option<f64>,
    /// Derivative by reference area, per m².
    #[schema(required = true)]
    pub reference_area: Option<f64>,
    /// Derivative by lift coefficient, per unit of the coefficient.
    #[schema(required = true)]
    pub lift_coefficient: Option<f64>,
    /// Derivative by drag coefficient, per unit of the coefficient.
    #[schema(required = true)]
    pub drag_coefficient: Option<f64>,
    /// Derivative by bank angle, per radian or degree.
    #[schema(required = true)]
    pub bank_angle: Option<f64>,
    /// Derivative by density at altitude 0, per kg/m³; null unless the atmosphere is exponential.
    #[schema(required = true)]
    pub surface_density: Option<f64>,
    /// Derivative by density factor, per unit of the factor.
    #[schema(required = true)]
    pub density_factor: Option<f64>,
    /// Derivative by initial radius, per m.
    #[schema(required = true)]
    pub radius: Option<f64>,
    /// Derivative by initial longitude, per radian or degree.
    #[schema(required = true)]
    pub longitude: Option<f64>,
    /// Derivative by initial geocentric latitude at the same radius, per radian or degree.
    #[schema(required = true)]
    pub geocentric_latitude: Option<f64>,
    /// Derivative by initial speed, per m/s.
    #[schema(required = true)]
    pub speed: Option<f64>,
    /// Derivative by initial flight-path angle, per radian or degree.
    #[schema(required = true)]
    pub flight_path_angle: Option<f64>,
    /// Derivative by initial heading, per radian or degree.
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
