//! The answer of `/simulate`: its columns, peaks and warnings, as JSON and as CSV.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::Write;

use reentry::coordinates::{FlightPath, UndefinedElements};
use reentry::simulate::SimulationError;
use reentry::trajectory::{self, FlightPoint, Lookup, Peaks as CorePeaks, Termination as CoreTermination, Trajectory};
use serde::{Serialize, Serializer};
use serde_json::Value;
use utoipa::openapi::schema::{ArrayBuilder, KnownFormat, ObjectBuilder, SchemaFormat, SchemaType, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::AngleUnit;
use super::epoch::{Instant, Utc};
use super::planet::{PlanetModel, Shape};
use super::scenario::{Formulation, Job, SimulateRequest};
use super::sensitivities::Sensitivities;
use super::vehicle::Aerodynamics;
use super::verification::Verification;
use super::wind::Wind;

/// One quantity of the flight: a key of the states, a column of the trajectory.
#[derive(Debug)]
pub struct Column {
    /// Its name in JSON and CSV.
    pub name: &'static str,
    /// Its meaning and unit.
    pub description: &'static str,
    needs: Needs,
    quantity: Quantity,
}

/// What a case must have for a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Needs {
    Nothing,
    Temperature,
    Pressure,
    Epoch,
}

/// How a column is made from a point of the flight.
#[derive(Debug)]
enum Quantity {
    Number(fn(&FlightPoint) -> f64),
    Angle(fn(&FlightPoint) -> f64),
    /// In [0, 2π).
    Turn(fn(&FlightPoint) -> f64),
    /// Null where there is none.
    Maybe(fn(&FlightPoint) -> Option<f64>),
    /// The time in UTC.
    Utc,
}

/// What there is to know at every instant of a flight beside its motion.
#[derive(Clone, Copy, Debug)]
pub struct Known {
    /// Whether the atmosphere has a temperature.
    pub temperature: bool,
    /// Whether the atmosphere has a pressure.
    pub pressure: bool,
    /// The instant t = 0.
    pub epoch: Option<Instant>,
}

const fn column(name: &'static str, description: &'static str, value: fn(&FlightPoint) -> f64) -> Column {
    Column { name, description, needs: Needs::Nothing, quantity: Quantity::Number(value) }
}

const fn angle(name: &'static str, description: &'static str, value: fn(&FlightPoint) -> f64) -> Column {
    Column { name, description, needs: Needs::Nothing, quantity: Quantity::Angle(value) }
}

const fn maybe(
    name: &'static str,
    description: &'static str,
    needs: Needs,
    value: fn(&FlightPoint) -> Option<f64>,
) -> Column {
    Column { name, description, needs, quantity: Quantity::Maybe(value) }
}

/// Every quantity, in the order of the answer.
pub static COLUMNS: [Column; 28] = [
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
    column("dynamic_pressure", "½ρV² of the speed relative to the air, Pa.", |point| point.loads.dynamic_pressure),
    column(
        "deceleration",
        "-dV/dt of the relative speed, m/s²; at rest minus the magnitude of the acceleration.",
        |point| point.loads.deceleration,
    ),
    column("load_factor", "Aerodynamic force over mass and 9.80665 m/s².", |point| point.loads.load_factor),
    Column {
        name: "azimuth",
        description: "The compass direction of the heading: from north (0) towards east (π/2), in [0, 2π).",
        needs: Needs::Nothing,
        quantity: Quantity::Turn(azimuth),
    },
    column("air_speed", "Relative to the air, m/s.", |point| point.loads.air_speed),
    maybe("temperature", "Of the air, K; where the atmosphere has a temperature.", Needs::Temperature, |point| {
        point.temperature
    }),
    maybe("pressure", "Of the air, Pa; where the atmosphere has a pressure.", Needs::Pressure, |point| point.pressure),
    maybe("speed_of_sound", "In the air, m/s; where the atmosphere has a temperature.", Needs::Temperature, |point| {
        point.speed_of_sound
    }),
    maybe(
        "mach",
        "The speed relative to the air over that of sound; where the atmosphere has a temperature.",
        Needs::Temperature,
        |point| point.loads.mach,
    ),
    angle("bank_angle", "As commanded.", |point| point.bank_angle),
    angle("angle_of_attack", "As commanded.", |point| point.angle_of_attack),
    maybe(
        "downrange",
        "From the initial ground point along the great circle of its heading, m, on the sphere of the equatorial radius; \
         null where the flight starts vertically or at rest.",
        Needs::Nothing,
        |point| point.downrange,
    ),
    maybe(
        "crossrange",
        "To the right of that great circle, m; null where the flight starts vertically or at rest.",
        Needs::Nothing,
        |point| point.crossrange,
    ),
    column("inertial_speed", "Relative to inertial space, m/s.", |point| point.inertial_speed),
    angle("inertial_flight_path_angle", "Of the inertial velocity above the plane normal to the radius.", |point| {
        point.inertial_flight_path_angle
    }),
    column(
        "specific_energy",
        "Half the squared inertial speed and the potential of the planet's gravity, J/kg.",
        |point| point.specific_energy,
    ),
    Column {
        name: "utc",
        description: "The instant in UTC, RFC 3339 to the microsecond; with an epoch. A leap second during the flight is not \
                      counted; null after the year 9999.",
        needs: Needs::Epoch,
        quantity: Quantity::Utc,
    },
];

/// The compass direction of the heading, in [0, 2π); 0 where there is none, at rest and in vertical flight.
fn azimuth(point: &FlightPoint) -> f64 {
    let FlightPath { speed, flight_path_angle, .. } = point.flight_path;
    if speed <= 0.0 || flight_path_angle.abs() >= FRAC_PI_2 {
        return 0.0;
    }
    let azimuth = FRAC_PI_2 - point.flight_path.heading;
    // The heading is at most π, and just less than 0 may round to the full turn.
    let turn = if azimuth < 0.0 { azimuth + TAU } else { azimuth };
    if turn < TAU { turn } else { 0.0 }
}

/// A value of a column.
enum Cell {
    Number(f64),
    Instant(Utc),
    Nothing,
}

impl Serialize for Cell {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Number(number) => number.serialize(serializer),
            Self::Instant(instant) => instant.serialize(serializer),
            Self::Nothing => serializer.serialize_none(),
        }
    }
}

impl Column {
    /// What the case lacks for the column, if anything.
    pub fn missing(&self, known: Known) -> Option<&'static str> {
        match self.needs {
            Needs::Temperature if !known.temperature => {
                Some("an atmosphere that has a temperature: us76, or a table with one")
            }
            Needs::Pressure if !known.pressure => Some("an atmosphere that has a pressure: us76, or a table with one"),
            Needs::Epoch if known.epoch.is_none() => Some("an epoch"),
            _ => None,
        }
    }

    /// Every column that the case has.
    fn all(known: Known) -> impl Iterator<Item = &'static Self> {
        COLUMNS.iter().filter(move |column| column.missing(known).is_none())
    }

    fn of(&self, point: &FlightPoint, unit: AngleUnit, epoch: Option<Instant>) -> Cell {
        match self.quantity {
            Quantity::Number(value) => Cell::Number(value(point)),
            Quantity::Angle(value) => Cell::Number(unit.from_radians(value(point))),
            Quantity::Turn(value) => Cell::Number(unit.turn_from_radians(value(point))),
            Quantity::Maybe(value) => value(point).map_or(Cell::Nothing, Cell::Number),
            Quantity::Utc => epoch.and_then(|epoch| epoch.utc(point.time)).map_or(Cell::Nothing, Cell::Instant),
        }
    }

    /// The schema of a value.
    fn schema(&self) -> ObjectBuilder {
        let types = |kind| SchemaType::from_iter([kind, Type::Null]);
        match (&self.quantity, self.needs) {
            (Quantity::Utc, _) => ObjectBuilder::new()
                .schema_type(types(Type::String))
                .format(Some(SchemaFormat::KnownFormat(KnownFormat::DateTime))),
            (Quantity::Maybe(_), Needs::Nothing) => ObjectBuilder::new().schema_type(types(Type::Number)),
            _ => ObjectBuilder::new().schema_type(Type::Number),
        }
    }
}

/// The state and the loads at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    point: FlightPoint,
    unit: AngleUnit,
    known: Known,
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Column::all(self.known).map(|column| {
            let cell = column.of(&self.point, self.unit, self.known.epoch);
            (column.name, cell)
        }))
    }
}

impl PartialSchema for Row {
    fn schema() -> RefOr<Schema> {
        let object = ObjectBuilder::new().description(Some("The state and the loads at an instant."));
        let with = |object: ObjectBuilder, column: &Column| {
            let object = object.property(column.name, column.schema().description(Some(column.description)));
            if column.needs == Needs::Nothing { object.required(column.name) } else { object }
        };
        COLUMNS.iter().fold(object, with).into()
    }
}

impl ToSchema for Row {}

/// The trajectory: one array a quantity, all of one length, time strictly increasing.
#[derive(Clone, Debug)]
pub struct Columns {
    points: Vec<FlightPoint>,
    chosen: Vec<&'static Column>,
    unit: AngleUnit,
    epoch: Option<Instant>,
}

impl Serialize for Columns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.chosen.iter().map(|column| (column.name, Values { column, columns: self })))
    }
}

impl PartialSchema for Columns {
    fn schema() -> RefOr<Schema> {
        let description = "The trajectory: one array a quantity, all of one length, time strictly increasing. \
                           With `output.columns` those alone.";
        let object = ObjectBuilder::new().description(Some(description));
        let with = |object: ObjectBuilder, column: &Column| {
            let array = ArrayBuilder::new().items(column.schema()).description(Some(column.description));
            object.property(column.name, array)
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
        let Columns { points, unit, epoch, .. } = self.columns;
        // The kind of the quantity is looked at once, not at every value.
        match self.column.quantity {
            Quantity::Number(value) => serializer.collect_seq(points.iter().map(value)),
            Quantity::Angle(value) => {
                serializer.collect_seq(points.iter().map(|point| unit.from_radians(value(point))))
            }
            Quantity::Turn(value) => {
                serializer.collect_seq(points.iter().map(|point| unit.turn_from_radians(value(point))))
            }
            Quantity::Maybe(value) => serializer.collect_seq(points.iter().map(value)),
            Quantity::Utc => serializer.collect_seq(points.iter().map(|point| self.column.of(point, *unit, *epoch))),
        }
    }
}

impl Columns {
    /// The instants.
    pub fn points(&self) -> &[FlightPoint] {
        &self.points
    }

    /// The instant t = 0.
    pub fn epoch(&self) -> Option<Instant> {
        self.epoch
    }

    /// A header of the names and a line an instant, by RFC 4180 but for the line ends.
    ///
    /// # Errors
    /// Never: memory can always be written.
    pub fn to_csv(&self) -> Result<Vec<u8>, serde_json::Error> {
        let mut csv = Vec::with_capacity(20 * self.chosen.len() * (self.points.len() + 1));
        let names: Vec<_> = self.chosen.iter().map(|column| column.name).collect();
        csv.extend_from_slice(names.join(",").as_bytes());
        csv.push(b'\n');
        for point in &self.points {
            for (index, column) in self.chosen.iter().enumerate() {
                if index > 0 {
                    csv.push(b',');
                }
                match column.of(point, self.unit, self.epoch) {
                    Cell::Number(number) => serde_json::to_writer(&mut csv, &number)?,
                    Cell::Instant(instant) => write!(csv, "{instant}").map_err(serde_json::Error::io)?,
                    Cell::Nothing => {}
                }
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
    /// The speed relative to the air over that of sound; where the atmosphere has a temperature.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub mach: Option<Peak>,
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
    /// The type of the gravity.
    pub gravity: &'static str,
    /// The type of the aerodynamics.
    pub aerodynamics: &'static str,
    /// The type of the wind; `still` where the air turns with the planet.
    pub wind: &'static str,
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
        let known = request.known();
        let row = |point| Row { point, unit, known };
        let statistics = flight.statistics();
        let warnings = Warning::of(&request, flight, &extras);
        Self {
            trajectory: points.map(|points| Columns {
                points,
                chosen: request.output.columns.unwrap_or_else(|| Column::all(known).collect()),
                unit,
                epoch: known.epoch,
            }),
            name: request.name,
            angle_unit: unit,
            version: env!("CARGO_PKG_VERSION"),
            models: Models {
                planet: request.planet.model,
                shape: request.planet.shape,
                atmosphere: request.atmosphere.kind(),
                gravity: request.planet.gravity.kind(),
                aerodynamics: request.vehicle.aerodynamics.kind(),
                wind: request.wind.as_ref().map_or("still", Wind::kind),
            },
            termination: match flight.termination() {
                CoreTermination::SurfaceImpact => Termination::SurfaceImpact,
                CoreTermination::TimeLimit => Termination::TimeLimit,
            },
            initial_state: row(flight.initial()),
            final_state: row(flight.last()),
            peaks: Peaks::from(flight.peaks()),
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
            mach: peaks.mach.map(peak),
        }
    }
}

impl Warning {
    fn new(code: &'static str, detail: &str) -> Self {
        Self { code, detail: detail.to_owned(), time: None }
    }

    /// What there is to know of a flight and of the request for it.
    pub fn of(request: &SimulateRequest, flight: &Trajectory, extras: &Extras) -> Vec<Self> {
        let of_flight = |warning: &_| Self::of_flight(*warning, request.angle_unit);
        let mut warnings: Vec<_> = flight.warnings().iter().map(of_flight).collect();
        let by_angle_of_attack = matches!(request.vehicle.aerodynamics, Aerodynamics::AlphaMachTable(_));
        if request.control.angle_of_attack.is_given() && !by_angle_of_attack {
            let detail =
                "control.angle_of_attack changes nothing: only the coefficients of an alpha_mach_table depend on it";
            warnings.push(Self::new("angle_of_attack_unused", detail));
        }
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

    /// The inertial frame is not J2000.
    pub fn frame_of_date() -> Self {
        let detail = "with an epoch, the inertial frame is the equator and origin of date; vectors in J2000 or GCRF are \
                      tilted against it by 0.145 degrees in 2026, up to 16 km on the ground";
        Self::new("inertial_frame_of_date", detail)
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
