//! The request and the answer of `/analytic`: a theory beside a flight, row by row.

use std::io::Write;

use reentry::analytic::{Comparison, Fault as TheoryFault, Prediction, Solution, Theory};
use reentry::trajectory::{FlightPoint, Trajectory};
use reentry::vehicle::Aerodynamics;
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::bodies::FlownBody;
use super::description::{self, Object, Words, word};
use super::dispersions::Covariance;
use super::reader::Fault;
use super::scenario::{FlightRequest, RequestedOutput, SimulateRequest, case};
use super::schema::names;
use super::sensitivities::SensitivitiesAnswer;
use super::state::Coordinates;
use super::trajectory::RequestedAnalyses;
use super::verification::Verification;
use super::warning::{Purpose, Warning};
use super::{Angle, AngleUnit};

/// The words for theories.
pub const SOLUTIONS: Words<Solution> = Words {
    name: "Solution",
    doc: "Closed-form theory, with the equation numbers of Jameson 2006: η = `ρSC_D/(2mβ)`, β = 1/scale height, k = \
          `C_L/C_D`; e denotes the initial state.",
    words: &[
        word("shallow_glide", Solution::ShallowGlide, "Shallow glide")
            .doc("Equations 77 to 79: V² = g₀r₀/(βr₀ηk + 1), γ = -2g₀/(kβV²); valid up to |γ| = 5°. Requires lift."),
        word("loh", Solution::Loh, "Loh, second order")
            .doc("Equation 80: γ of a descent to second order, with the simulated speed. Requires lift."),
        word("steep_glide", Solution::SteepGlide, "Steep glide").doc(
            "Equations 81 to 83: `cos γ = cos γ_e + k(η - η_e)`, `V² = V_e² exp(2(γ_e - γ)/k)`. Requires lift and a \
             descent.",
        ),
        word("steep_ballistic", Solution::SteepBallistic, "Steep ballistic")
            .doc("Equations 84 to 87: γ = `γ_e`, and V along a straight line. Requires a descent without lift."),
        word("medium_glide", Solution::MediumGlide, "Medium glide")
            .doc("Equations 88 to 90: theory of Wang and Ting for supercircular entry. Requires lift and a descent."),
    ],
};

/// A case to simulate, and the theory to set beside it.
pub fn analytic_request(object: &mut Object) -> Option<(Solution, SimulateRequest)> {
    object.named(
        "AnalyticRequest",
        "Case to simulate, as for `/simulate`, and the theory to compare with it. `output` must not be \
         `{\"trajectory\": false}`: the theory is evaluated at the rows.",
    );
    let case = case(object);
    let solution =
        object.field("solution", "Theory").doc("Theory to compare with the simulated flight.").word(&SOLUTIONS);
    // Theories know neither heating nor events, but an empty list is none.
    object.conceal("heating");
    object.refine("events", || json!({"maxItems": 0}));
    object.condition(|| json!({"dependentSchemas": {"solution": conditions_of_theories()}}));
    Some((solution?, case?))
}

/// What every theory asks of its case: constant coefficients, exponential air, the rows of a flight; and lift, or none.
fn conditions_of_theories() -> Value {
    let positive = json!({"exclusiveMinimum": 0});
    let constant = json!({"type": {"enum": ["constant", "ballistic"]}, "drag_coefficient": positive});
    let aerodynamics = |schema: Value| json!({"vehicle": {"properties": {"aerodynamics": schema}}});
    let lift = |bound: Value| json!({"lift_coefficient": bound, "lift_to_drag": bound});
    let some = json!({
        "properties": lift(json!({"not": {"const": 0}})),
        "anyOf": [{"required": ["lift_coefficient"]}, {"required": ["lift_to_drag"]}],
    });
    json!({
        "properties": {
            "atmosphere": {"properties": {"type": {"const": "exponential"}, "surface_density": positive}},
            "density_factor": positive,
            "vehicle": {"properties": {"reference_area": positive, "aerodynamics": {"properties": constant}}},
            "output": {"properties": {"trajectory": false, "columns": false, "sites": {"const": false}}},
        },
        "if": {"properties": {"solution": {"const": "steep_ballistic"}}},
        "then": {"properties": aerodynamics(json!({"properties": lift(json!({"const": 0}))}))},
        "else": {"properties": aerodynamics(some)},
    })
}

/// A sound request: a case that can be flown, and a theory that applies to it.
#[derive(Debug)]
pub struct TheoryRequest {
    /// What to fly.
    pub flight: FlightRequest,
    /// The theory that was asked for.
    pub solution: Solution,
    /// The theory for the case.
    pub theory: Theory,
}

impl TheoryRequest {
    /// Parses and checks a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value, output: RequestedOutput) -> Result<Self, Vec<Fault>> {
        let (solution, request) = description::read(&mut tree, analytic_request)?;
        let mut misplaced = request.beyond_rows(output);
        let numbers = request.numbers_that_vary(&tree, &mut misplaced)?;
        if request.output.columns.is_some() {
            let detail = "must not be given: the columns of this response are fixed";
            misplaced.push(Fault::new("/output/columns", detail));
        }
        if request.output.sites {
            let detail = "must be false or absent: this response has no nearest site";
            misplaced.push(Fault::new("/output/sites", detail));
        }
        if request.heating.is_some() {
            misplaced.push(Fault::new("/heating", "must not be given: the theories do not include heating"));
        }
        if request.output.sampling.is_none() {
            let detail = "must not be false: the theory is evaluated at the rows of the flight";
            misplaced.push(Fault::new("/output/trajectory", detail));
        }
        let (scenario, theory) = match request.try_into_scenario() {
            Ok(scenario) => match Theory::new(solution, &scenario) {
                Ok(theory) => (Ok(scenario), Ok(theory)),
                Err(error) => (Ok(scenario), Err(error.0)),
            },
            Err(faults) => {
                let SimulateRequest { vehicle, atmosphere, density_factor, .. } = &request;
                let theory = solution.vehicle_faults(vehicle, &atmosphere.core, *density_factor);
                let events = (!request.events.is_empty()).then_some(TheoryFault::Events);
                (Err(faults), Err(theory.into_iter().chain(events).collect()))
            }
        };
        match (scenario, theory) {
            (Ok(scenario), Ok(theory)) if misplaced.is_empty() => {
                let echo = request.echo.then_some(tree);
                Ok(Self { flight: FlightRequest { scenario, request, echo, numbers }, solution, theory })
            }
            (scenario, theory) => {
                let theory = theory.err().into_iter().flatten().map(|fault| fault_of(&fault, &request));
                Err(scenario.err().into_iter().flatten().chain(theory).chain(misplaced).collect())
            }
        }
    }
}

/// What keeps a theory from applying, at the field of the request that it concerns.
fn fault_of(fault: &TheoryFault, request: &SimulateRequest) -> Fault {
    let has_angle =
        matches!(request.initial_state.coordinates, Coordinates::PlanetRelative { .. } | Coordinates::Geodetic(_));
    let by_ratios = matches!(request.vehicle.aerodynamics, Aerodynamics::Ballistic { .. });
    let pointer = match fault {
        TheoryFault::NoLift | TheoryFault::Lift { .. } if by_ratios => "/vehicle/aerodynamics/lift_to_drag",
        TheoryFault::NoLift | TheoryFault::Lift { .. } => "/vehicle/aerodynamics/lift_coefficient",
        TheoryFault::NoDrag => "/vehicle/aerodynamics/drag_coefficient",
        TheoryFault::NoArea => "/vehicle/reference_area",
        TheoryFault::NotConstant => "/vehicle/aerodynamics/type",
        TheoryFault::NoAir => "/atmosphere/surface_density",
        TheoryFault::NotExponential => "/atmosphere/type",
        TheoryFault::NoDensity => "/density_factor",
        TheoryFault::Events => "/events",
        TheoryFault::NoDescent { .. } if has_angle => "/initial_state/flight_path_angle",
        TheoryFault::NoDescent { .. } | TheoryFault::NoAirAtEntry => "/initial_state",
    };
    let detail = match fault {
        TheoryFault::NoDescent { flight_path_angle } => {
            format!("{fault}, got {}", Angle(*flight_path_angle, request.angle_unit))
        }
        _ => fault.to_string(),
    };
    Fault::new(pointer, detail)
}

/// Simulated flight: one array per quantity, all of the same length; time is strictly increasing.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Simulated {
    /// Time since the start, s.
    pub time: Vec<f64>,
    /// Altitude above the planet's surface along the radius vector, m.
    pub altitude: Vec<f64>,
    /// Speed relative to the rotating planet, m/s.
    pub speed: Vec<f64>,
    /// Angle of the relative velocity above the plane normal to the radius; negative in descent.
    pub flight_path_angle: Vec<f64>,
    /// Drag over mass D/m, m/s²; the part of the deceleration caused by drag.
    pub drag_deceleration: Vec<f64>,
}

/// Prediction of the theory at the same times and altitudes; null where the theory gives no value.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Predicted {
    /// Time of the simulated flight, s.
    pub time: Vec<f64>,
    /// Altitude of the simulated flight, m.
    pub altitude: Vec<f64>,
    /// Speed, m/s; null for `loh`, which uses the simulated speed.
    pub speed: Vec<Option<f64>>,
    /// Flight-path angle above the plane normal to the radius; negative in descent.
    pub flight_path_angle: Vec<Option<f64>>,
    /// Drag over mass D/m, m/s², which the theories take as the total deceleration; null for `loh`.
    pub drag_deceleration: Vec<Option<f64>>,
}

/// Predicted minus simulated value at the same rows; null where the theory gives no value.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Differences {
    /// Difference of speed, m/s.
    pub speed: Vec<Option<f64>>,
    /// Difference of flight-path angle, in the unit of angles.
    pub flight_path_angle: Vec<Option<f64>>,
    /// Difference of drag deceleration, m/s².
    pub drag_deceleration: Vec<Option<f64>>,
}

/// Part of the flight, in time order, in which the theory gives values.
///
/// The steep and medium solutions end at their first missing value; `shallow_glide` and `loh` end after their last
/// value and may have gaps before it.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct Valid {
    /// Altitude at which this part begins, m, along the radius vector; null if the theory gives no value at all.
    #[schema(required = true)]
    pub from_altitude: Option<f64>,
    /// Altitude at which this part ends, m, along the radius vector, located between the rows; null if the theory gives
    /// no value at all.
    #[schema(required = true)]
    pub to_altitude: Option<f64>,
    /// Reason why this part ends, or why it is empty.
    pub ends_because: String,
}

/// Comparison of a theory with a simulated flight.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct AnalyticResponse {
    /// Name of the case in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// Theory named in the request.
    #[schema(value_type = names::Solution)]
    pub solution: &'static str,
    /// Unit of every angle in the response.
    #[schema(value_type = names::AngleUnit)]
    pub angle_unit: AngleUnit,
    /// Version of the service.
    pub version: &'static str,
    /// Simulated flight at the rows of `output`.
    pub simulated: Simulated,
    /// Prediction of the theory.
    pub predicted: Predicted,
    /// Predicted minus simulated values.
    pub differences: Differences,
    /// Part of the flight in which the theory gives values.
    pub valid: Valid,
    /// Derivatives of the simulated flight; present with `sensitivities`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub sensitivities: Option<SensitivitiesAnswer>,
    /// Scatter of the end of the simulated flight, to first order; present with `dispersions`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub covariance: Option<Covariance>,
    /// Numerical accuracy of the simulated flight; present with `verify`. Absent, with the warning `not_verified`, if
    /// the finer flight fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub verification: Option<Verification>,
    /// Warnings about the request and the flight.
    pub warnings: Vec<Warning>,
    /// Request with all defaults filled in, which can be sent again; present with `echo`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = names::AnalyticRequest)]
    pub case: Option<Value>,
}

impl AnalyticResponse {
    /// The answer to a request whose flight was flown; `points` are the rows that it asks for.
    pub fn new(
        theory: TheoryRequest,
        flight: &Trajectory,
        points: &[FlightPoint],
        comparison: Comparison,
        analyses: RequestedAnalyses,
    ) -> Self {
        let TheoryRequest { flight: FlightRequest { request, echo, .. }, solution, .. } = theory;
        let unit = request.angle_unit;
        let Comparison { predictions, validity } = comparison;
        let simulated = Simulated {
            time: points.iter().map(|point| point.time).collect(),
            altitude: points.iter().map(|point| point.loads.altitude).collect(),
            speed: points.iter().map(|point| point.flight_path.speed).collect(),
            flight_path_angle: points
                .iter()
                .map(|point| unit.from_radians(point.flight_path.flight_path_angle))
                .collect(),
            drag_deceleration: points.iter().map(|point| flight.drag_deceleration(point)).collect(),
        };
        let column = |value: fn(&Prediction) -> Option<f64>| predictions.iter().map(value).collect();
        let angles: Vec<_> = column(|prediction| prediction.flight_path_angle);
        let predicted = Predicted {
            time: simulated.time.clone(),
            altitude: simulated.altitude.clone(),
            speed: column(|prediction| prediction.speed),
            flight_path_angle: angles.into_iter().map(|angle| angle.map(|angle| unit.from_radians(angle))).collect(),
            drag_deceleration: column(|prediction| prediction.drag_deceleration),
        };
        let mut warnings =
            Warning::of(&request, &FlownBody::vehicle(&request, flight), analyses.unverified, Purpose::Theory);
        if request.control.bank_angle.is_given() {
            warnings.push(Warning::bank_left_out());
        }
        if request.wind.blows {
            warnings.push(Warning::wind_left_out());
        }
        Self {
            name: request.name,
            solution: SOLUTIONS.of(solution),
            angle_unit: unit,
            version: env!("CARGO_PKG_VERSION"),
            differences: Differences {
                speed: differences(&predicted.speed, &simulated.speed),
                flight_path_angle: differences(&predicted.flight_path_angle, &simulated.flight_path_angle),
                drag_deceleration: differences(&predicted.drag_deceleration, &simulated.drag_deceleration),
            },
            simulated,
            predicted,
            valid: Valid {
                from_altitude: validity.from_altitude,
                to_altitude: validity.to_altitude,
                ends_because: validity.end.to_string(),
            },
            sensitivities: analyses.sensitivities,
            covariance: analyses.covariance,
            verification: analyses.verification,
            warnings,
            case: echo,
        }
    }

    /// A header and a line a row: time, altitude, then what is simulated and what is predicted; no number is an empty cell.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_csv(&self, csv: &mut impl Write) -> Result<(), serde_json::Error> {
        let text = |csv: &mut _, text: &[u8]| Write::write_all(csv, text).map_err(serde_json::Error::io);
        let Self { simulated, predicted, .. } = self;
        let given = [
            ("time", &simulated.time),
            ("altitude", &simulated.altitude),
            ("simulated_speed", &simulated.speed),
            ("simulated_flight_path_angle", &simulated.flight_path_angle),
            ("simulated_drag_deceleration", &simulated.drag_deceleration),
        ];
        let maybe = [
            ("predicted_speed", &predicted.speed),
            ("predicted_flight_path_angle", &predicted.flight_path_angle),
            ("predicted_drag_deceleration", &predicted.drag_deceleration),
        ];
        let names: Vec<_> = given.iter().map(|(name, _)| *name).chain(maybe.iter().map(|(name, _)| *name)).collect();
        text(csv, names.join(",").as_bytes())?;
        for row in 0..simulated.time.len() {
            let cells = given.iter().map(|(_, column)| column.get(row).copied());
            let cells = cells.chain(maybe.iter().map(|(_, column)| column.get(row).copied().flatten()));
            for (index, cell) in cells.enumerate() {
                text(csv, if index == 0 { b"\n" } else { b"," })?;
                if let Some(number) = cell {
                    serde_json::to_writer(&mut *csv, &number)?;
                }
            }
        }
        text(csv, b"\n")
    }
}

/// Predicted minus simulated.
fn differences(predicted: &[Option<f64>], simulated: &[f64]) -> Vec<Option<f64>> {
    let difference = |(predicted, simulated): (&Option<f64>, &f64)| predicted.map(|predicted| predicted - simulated);
    predicted.iter().zip(simulated).map(difference).collect()
}
