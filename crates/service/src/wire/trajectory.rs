//! The answer of `/simulate`: its columns, peaks and warnings, as JSON and as CSV.

use reentry::coordinates::UndefinedElements;
use reentry::simulate::SimulationError;
use reentry::trajectory::{self, FlightPoint, Peaks as CorePeaks, Termination as CoreTermination, Trajectory};
use serde::ser::{SerializeMap, SerializeSeq};
use serde::{Serialize, Serializer};
use serde_json::Value;
use utoipa::openapi::schema::{ArrayBuilder, ObjectBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::AngleUnit;
use super::planet::{PlanetModel, Shape};
use super::scenario::{Formulation, Job, SimulateRequest};
use super::sensitivities::Sensitivities;
use super::verification::Verification;

/// One quantity of the flight: a key of the states, a column of the trajectory.
pub struct Column {
    /// Its name in JSON and CSV.
    pub name: &'static str,
    /// Its meaning and unit.
    pub description: &'static str,
    is_angle: bool,
    value: fn(&FlightPoint) -> f64,
}

const fn column(name: &'static str, description: &'static str, value: fn(&FlightPoint) -> f64) -> Column {
    Column { name, description, is_angle: false, value }
}

const fn angle(name: &'static str, description: &'static str, value: fn(&FlightPoint) -> f64) -> Column {
    Column { name, description, is_angle: true, value }
}

/// Every quantity, in the order of the answer.
pub const COLUMNS: [Column; 14] = [
    column("time", "Since the start, s.", |point| point.time),
    column("altitude", "Height above the planet's shape along the radius vector, m.", |point| point.loads.altitude),
    column("radius", "Distance from the planet's centre, m.", |point| point.flight_path.radius),
    angle("longitude", "East positive, in (-π, π].", |point| point.flight_path.longitude),
    angle("geocentric_latitude", "Angle of the radius vector above the equatorial plane.", |point| {
        point.flight_path.geocentric_latitude
    }),
    angle("geodetic_latitude", "Angle of the normal of the planet's shape above the equatorial plane.", |point| {
        point.geodetic_latitude
    }),
    column("geodetic_altitude", "Height above the planet's shape along its normal, m.", |point| {
        point.geodetic_altitude
    }),
    column("speed", "Relative to the rotating planet, m/s.", |point| point.flight_path.speed),
    angle("flight_path_angle", "Of the relative velocity above the plane normal to the radius.", |point| {
        point.flight_path.flight_path_angle
    }),
    angle("heading", "From east (0) towards north (π/2), in (-π, π].", |point| point.flight_path.heading),
    column("density", "Of the air, kg/m³.", |point| point.loads.density),
    column("dynamic_pressure", "½ρV², Pa.", |point| point.loads.dynamic_pressure),
    column(
        "deceleration",
        "-dV/dt of the relative speed, m/s²; at rest minus the magnitude of the acceleration.",
        |point| point.loads.deceleration,
    ),
    column("load_factor", "Aerodynamic force over mass and 9.80665 m/s².", |point| point.loads.load_factor),
];

impl Column {
    fn of(&self, point: &FlightPoint, unit: AngleUnit) -> f64 {
        let value = (self.value)(point);
        if self.is_angle { unit.from_radians(value) } else { value }
    }
}

/// The state and the loads at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    point: FlightPoint,
    unit: AngleUnit,
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(COLUMNS.len()))?;
        for column in &COLUMNS {
            map.serialize_entry(column.name, &column.of(&self.point, self.unit))?;
        }
        map.end()
    }
}

impl PartialSchema for Row {
    fn schema() -> RefOr<Schema> {
        let number = |description| ObjectBuilder::new().schema_type(Type::Number).description(Some(description));
        let object = ObjectBuilder::new().description(Some("The state and the loads at an instant."));
        let with = |object: ObjectBuilder, column: &Column| {
            object.property(column.name, number(column.description)).required(column.name)
        };
        COLUMNS.iter().fold(object, with).into()
    }
}

impl ToSchema for Row {}

/// The trajectory: one array a quantity, all of one length, time strictly increasing.
#[derive(Clone, Debug)]
pub struct Columns {
    points: Vec<FlightPoint>,
    unit: AngleUnit,
}

impl Serialize for Columns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(COLUMNS.len()))?;
        for column in &COLUMNS {
            map.serialize_entry(column.name, &Values { column, columns: self })?;
        }
        map.end()
    }
}

impl PartialSchema for Columns {
    fn schema() -> RefOr<Schema> {
        let array = |description| {
            let number = ObjectBuilder::new().schema_type(Type::Number);
            ArrayBuilder::new().items(number).description(Some(description))
        };
        let object = ObjectBuilder::new()
            .description(Some("The trajectory: one array a quantity, all of one length, time strictly increasing."));
        let with = |object: ObjectBuilder, column: &Column| {
            object.property(column.name, array(column.description)).required(column.name)
        };
        COLUMNS.iter().fold(object, with).into()
    }
}

impl ToSchema for Columns {}

struct Values<'a> {
    column: &'a Column,
    columns: &'a Columns,
}

impl Serialize for Values<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut sequence = serializer.serialize_seq(Some(self.columns.points.len()))?;
        for point in &self.columns.points {
            sequence.serialize_element(&self.column.of(point, self.columns.unit))?;
        }
        sequence.end()
    }
}

impl Columns {
    /// A header of the names and a line an instant, by RFC 4180 but for the line ends.
    ///
    /// # Errors
    /// Never: memory can always be written.
    pub fn to_csv(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut csv = Vec::with_capacity(280 * (self.points.len() + 1));
        let names: Vec<_> = COLUMNS.iter().map(|column| column.name).collect();
        csv.extend_from_slice(names.join(",").as_bytes());
        csv.push(b'\n');
        for point in &self.points {
            for (index, column) in COLUMNS.iter().enumerate() {
                if index > 0 {
                    csv.push(b',');
                }
                serde_json::to_writer(&mut csv, &column.of(point, self.unit))?;
            }
            csv.push(b'\n');
        }
        Ok(csv)
    }
}

/// How the flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Termination {
    /// The stop altitude was crossed downwards.
    SurfaceImpact,
    /// The stop time was reached.
    TimeLimit,
}

/// The greatest value of a quantity over the flight, the earliest where it is reached more than once.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Peak {
    /// In the unit of the quantity.
    pub value: f64,
    /// s.
    pub time: f64,
    /// Height above the planet's shape along the radius vector, m.
    pub altitude: f64,
}

/// The peaks of the flight, both ends included.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Peaks {
    /// -dV/dt, m/s².
    pub deceleration: Peak,
    /// Aerodynamic force over mass and 9.80665 m/s².
    pub load_factor: Peak,
    /// Pa.
    pub dynamic_pressure: Peak,
    /// m.
    pub altitude: Peak,
}

/// The models that flew.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Models {
    /// The planet.
    pub planet: PlanetModel,
    /// Its surface.
    pub shape: Shape,
    /// The type of the atmosphere.
    pub atmosphere: &'static str,
}

/// How the equations were integrated.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct SolverReport {
    /// Which equations.
    pub formulation: Formulation,
    /// The error allowed in a step.
    pub relative_tolerance: f64,
    /// Accepted steps.
    pub steps: usize,
    /// Steps that were tried and missed the tolerance.
    pub rejected_steps: usize,
    /// Evaluations of the right-hand side.
    pub evaluations: usize,
    /// Seconds of computing for integration, events and peaks.
    pub elapsed: f64,
}

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

/// What a request may ask for beyond the flight.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extras {
    /// With `sensitivities`.
    pub sensitivities: Option<Sensitivities>,
    /// With `verify`.
    pub verification: Option<Verification>,
    /// Why the finer flight of the verification could not be finished.
    pub unverified: Option<SimulationError>,
}

/// A finished flight.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct SimulateResponse {
    /// As in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// The unit of every angle.
    pub angle_unit: AngleUnit,
    /// Of the service.
    pub version: &'static str,
    /// The models that flew.
    pub models: Models,
    /// How the flight ended.
    pub termination: Termination,
    /// At t = 0.
    pub initial_state: Row,
    /// At the end.
    pub final_state: Row,
    /// The greatest values.
    pub peaks: Peaks,
    /// The rows that were asked for; absent with `"output": {"trajectory": false}`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub trajectory: Option<Columns>,
    /// The derivatives of the flight's end, with `sensitivities`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub sensitivities: Option<Sensitivities>,
    /// How exact the flight is, with `verify`; absent with the warning `not_verified` where the finer flight cannot be finished.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub verification: Option<Verification>,
    /// How the equations were integrated.
    pub solver: SolverReport,
    /// What the user should know.
    pub warnings: Vec<Warning>,
    /// The request with every default filled in, with `echo`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = Object)]
    pub case: Option<Value>,
}

impl SimulateResponse {
    /// The answer to a job that was flown in `elapsed` seconds; `points` are the rows that it asks for.
    pub fn new(job: Job, flight: &Trajectory, points: Option<Vec<FlightPoint>>, extras: Extras, elapsed: f64) -> Self {
        let Job { request, echo, .. } = job;
        let unit = request.angle_unit;
        let row = |point| Row { point, unit };
        let statistics = flight.statistics();
        let warnings = Warning::of(&request, flight, &extras);
        Self {
            name: request.name,
            angle_unit: unit,
            version: env!("CARGO_PKG_VERSION"),
            models: Models {
                planet: request.planet.model,
                shape: request.planet.shape,
                atmosphere: request.atmosphere.kind(),
            },
            termination: match flight.termination() {
                CoreTermination::SurfaceImpact => Termination::SurfaceImpact,
                CoreTermination::TimeLimit => Termination::TimeLimit,
            },
            initial_state: row(flight.initial()),
            final_state: row(flight.last()),
            peaks: Peaks::from(flight.peaks()),
            trajectory: points.map(|points| Columns { points, unit }),
            sensitivities: extras.sensitivities,
            verification: extras.verification,
            solver: SolverReport {
                formulation: request.solver.formulation,
                relative_tolerance: request.solver.relative_tolerance,
                steps: statistics.steps,
                rejected_steps: statistics.rejected_steps,
                evaluations: statistics.evaluations,
                elapsed,
            },
            warnings,
            case: echo,
        }
    }
}

impl From<&CorePeaks> for Peaks {
    fn from(peaks: &CorePeaks) -> Self {
        let peak = |trajectory::Peak { value, time, altitude }| Peak { value, time, altitude };
        Self {
            deceleration: peak(peaks.deceleration),
            load_factor: peak(peaks.load_factor),
            dynamic_pressure: peak(peaks.dynamic_pressure),
            altitude: peak(peaks.altitude),
        }
    }
}

impl Warning {
    fn new(code: &'static str, detail: &str) -> Self {
        Self { code, detail: detail.to_owned(), time: None }
    }

    /// What there is to know of a flight and of the request for it.
    pub fn of(request: &SimulateRequest, flight: &Trajectory, extras: &Extras) -> Vec<Self> {
        let mut warnings: Vec<_> = flight.warnings().iter().copied().map(Self::of_flight).collect();
        if request.epoch.is_some() && request.initial_state.is_inertial() {
            warnings.push(Self::frame_of_date());
        }
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

    fn of_flight(warning: trajectory::Warning) -> Self {
        let trajectory::Warning::LiftFadedNearVertical { time } = warning;
        let detail = "the flight came within 0.001 rad of the vertical, where the bank angle is undefined; \
                      lift fades out there";
        Self { time: Some(time), ..Self::new("lift_faded_near_vertical", detail) }
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

    /// The inertial frame is not J2000.
    pub fn frame_of_date() -> Self {
        let detail = "with an epoch, the inertial frame is the equator and origin of date; vectors in J2000 or GCRF are \
                      tilted against it by 0.145 degrees in 2026, up to 16 km on the ground";
        Self::new("inertial_frame_of_date", detail)
    }
}
