//! The answer of `/simulate`.

use std::io::Write;
use std::iter;

use reentry::atmosphere::nrlmsise00::{Ap, SpaceWeather};
use reentry::integrate::Statistics;
use reentry::simulate::SimulationError;
use reentry::trajectory::{
    self, EventPoint, FlightPhase, FlightPoint, HeatingPeaks, Peaks as CorePeaks, PhaseStart,
    Termination as CoreTermination,
};
use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

use super::AngleUnit;
use super::aerodynamics;
use super::bodies::{DescribedBody, FlownBodies, FlownBody, FlownSeparation};
use super::columns::{Columns, Row, csv_text};
use super::dispersions::Covariance;
use super::outputs::ground_point;
use super::planet::MODELS;
use super::scenario::{FORMULATIONS, SimulateRequest};
use super::schema::names;
use super::sensitivities::SensitivitiesAnswer;
use super::sites::NearestSite;
use super::verification::Verification;
use super::warning::{Purpose, Warning};

/// How the flight ended. `surface_impact`: downward crossing of a `stop.altitude` of 0. `stop_altitude`: downward
/// crossing of any other `stop.altitude`. `time_limit`: `stop.time` was reached. `condition`: a condition of
/// `stop.when` was met; `condition` is its index. `atmosphere_exit`: upward crossing of `stop.ceiling`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Termination {
    /// The surface was crossed downwards: `stop.altitude` is 0.
    SurfaceImpact,
    /// `stop.altitude`, which is not 0, was crossed downwards.
    StopAltitude,
    /// The stop time was reached.
    TimeLimit,
    /// A condition of `stop.when` was met: that of the index in `condition`.
    Condition,
    /// The ceiling was crossed upwards.
    AtmosphereExit,
}

/// Greatest value of a quantity over the flight or over a phase; the earliest if it is reached more than once.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Peak {
    /// Greatest value, in the unit of the quantity.
    pub value: f64,
    /// Time since the start, s.
    pub time: f64,
    /// Altitude above the planet's surface along the radius vector, m.
    pub altitude: f64,
}

/// Greatest values over the flight or over a phase, both ends included.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Peaks {
    /// Deceleration -dV/dt of the speed relative to the rotating planet, m/s².
    pub deceleration: Peak,
    /// Load factor, in g of the Earth on every planet: resultant of lift, drag and thrust over mass and 9.80665 m/s².
    pub load_factor: Peak,
    /// Dynamic pressure, Pa.
    pub dynamic_pressure: Peak,
    /// Altitude above the planet's surface along the radius vector, m.
    pub altitude: Peak,
    /// Speed relative to the rotating planet, m/s.
    pub speed: Peak,
    /// Mach number: air speed over speed of sound; present if the atmosphere has a speed of sound.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub mach: Option<Peak>,
    /// Convective heat flux into the stagnation point, W/m²; present with `heating`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub convective_heat_flux: Option<Peak>,
    /// Radiative heat flux into the stagnation point, W/m²; present with `heating`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub radiative_heat_flux: Option<Peak>,
    /// Heat flux into the stagnation point, convective plus radiative, W/m²; present with `heating`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub heat_flux: Option<Peak>,
    /// Heat load of the stagnation point since the start, J/m²; present with `heating`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub heat_load: Option<Peak>,
    /// Radiative equilibrium temperature of the wall, K; present with `heating`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub wall_temperature: Option<Peak>,
}

/// Event that happened.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct EventReport {
    /// Index of the event in the request, from 0.
    pub index: usize,
    /// Name of the event in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// Time of the event since the start, s.
    pub time: f64,
    /// State at that time, before the effect of the event.
    pub state: Row,
    /// State at that time, after the effect of the event.
    pub after: Row,
}

/// Event that starts a phase.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PhaseOrigin {
    /// Index of the event in the request, from 0. If several events change the vehicle at that instant, the last of
    /// them.
    pub index: usize,
    /// Name of the event in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// True if the phase starts when the propellant is spent; the event is then the one that switched the thrust on.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    #[schema(required = false)]
    pub burnout: bool,
}

/// Part of the flight in which the vehicle does not change. The first phase has no duration if an event changes the
/// vehicle at the start; the last phase has none if an event does so at the end.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PhaseReport {
    /// Event that starts the phase; null at the start of the flight.
    pub from: Option<PhaseOrigin>,
    /// Start of the phase, s.
    pub since: f64,
    /// End of the phase, s.
    pub until: f64,
    /// Greatest values in the phase, after the change at its start and before the change at its end.
    pub peaks: Peaks,
}

/// Models used for the flight.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Models {
    /// Planet model.
    #[schema(value_type = names::PlanetModel)]
    pub planet: &'static str,
    /// Surface from which altitudes are measured.
    #[schema(value_type = names::Shape)]
    pub shape: &'static str,
    /// Type of the atmosphere.
    pub atmosphere: &'static str,
    /// Indices that `nrlmsise00` took.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub space_weather: Option<SpaceWeatherReport>,
    /// Type of the gravity.
    pub gravity: &'static str,
    /// Type of the aerodynamics at the start.
    pub aerodynamics: &'static str,
    /// Type of the wind; `still` if the air rotates with the planet.
    pub wind: &'static str,
}

/// Indices of the space weather.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct SpaceWeatherReport {
    /// Solar flux F10.7 of the day before, solar flux units.
    pub f107: f64,
    /// Mean of F10.7 over 81 days, solar flux units.
    pub f107_average: f64,
    /// Mean Ap of the day.
    pub ap: f64,
    /// History of ap, if it was taken: the seven numbers that a case may give as `ap`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub ap_history: Option<[f64; 7]>,
}

impl From<SpaceWeather> for SpaceWeatherReport {
    fn from(SpaceWeather { f107, f107_average, ap }: SpaceWeather) -> Self {
        let (ap, ap_history) = match ap {
            Ap::Daily(ap) => (ap, None),
            Ap::History(history) => (history[0], Some(history)),
        };
        Self { f107, f107_average, ap, ap_history }
    }
}

/// Settings and statistics of the numerical integration.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct SolverReport {
    /// Formulation of the equations of motion.
    #[schema(value_type = names::Formulation)]
    pub formulation: &'static str,
    /// Permitted error per step, relative to the planet's radius and circular speed.
    pub relative_tolerance: f64,
    /// Of the flight of the vehicle.
    #[serde(flatten)]
    pub counts: IntegrationCounts,
    /// Computing time of integration, events and peaks, of all bodies together, s.
    pub elapsed: f64,
}

/// Statistics of the numerical integration of a flight.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct IntegrationCounts {
    /// Number of accepted steps.
    pub steps: usize,
    /// Number of rejected steps, which missed the tolerance.
    pub rejected_steps: usize,
    /// Number of evaluations of the equations of motion.
    pub evaluations: usize,
}

/// What a request may ask for beyond the flight.
#[derive(Clone, Debug, Default)]
pub struct RequestedAnalyses {
    /// With `sensitivities`.
    pub sensitivities: Option<SensitivitiesAnswer>,
    /// With `dispersions`.
    pub covariance: Option<Covariance>,
    /// With `verify`.
    pub verification: Option<Verification>,
    /// Why the finer flight of the verification could not be finished.
    pub unverified: Option<SimulationError>,
    /// With `echo`.
    pub echo: Option<Value>,
}

/// Flight of the vehicle, or of a body that left it.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct FlightReport {
    /// How the flight ended.
    pub termination: Termination,
    /// Index in `stop.when` of the condition that ended the flight, from 0; present if a condition ended it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub condition: Option<usize>,
    /// State at the start as given, before the events at that instant: at t = 0 or, of a body, at its separation.
    pub initial_state: Row,
    /// State at the end, after the events at that instant.
    pub final_state: Row,
    /// Site of `GET /sites` that is nearest to the ground point of the end; present with `output.sites`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub nearest_site: Option<NearestSite>,
    /// Events that happened, in order; present if the request has events.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub events: Option<Vec<EventReport>>,
    /// Greatest values over the flight.
    pub peaks: Peaks,
    /// Parts of the flight between events that change the vehicle (mass, area, coefficients or thrust); present if
    /// there is more than one. The greatest of their peaks are `peaks`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub phases: Option<Vec<PhaseReport>>,
    /// Rows of the trajectory; absent with `"output": {"trajectory": false}` and, of a body, with `"bodies": "ends"`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub trajectory: Option<Columns>,
}

/// Flight of a body that left the vehicle or another body. Its times are on the clock of the case: since t = 0.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct BodyReport {
    /// Name of the body in the request.
    pub name: String,
    /// Name of the body that it left; null if it left the vehicle.
    #[schema(required = true)]
    pub parent: Option<String>,
    /// Event of its parent that separated it: its name or, if it has none, its index in the list of events, from 0.
    pub separated_by: EventNameOrIndex,
    /// Time of the separation since the start, s.
    pub separated_at: f64,
    /// Its flight.
    #[serde(flatten)]
    pub flight: FlightReport,
    /// Statistics of the numerical integration.
    pub solver: IntegrationCounts,
    /// Warnings about the flight.
    pub warnings: Vec<Warning>,
}

/// Name of an event, or its index in the list of events if it has no name.
#[derive(Clone, Debug, Serialize, ToSchema)]
#[serde(untagged)]
pub enum EventNameOrIndex {
    /// Name of the event.
    Name(String),
    /// Index of the event, from 0.
    Index(usize),
}

/// Simulated flight.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct SimulateResponse {
    /// Name of the case in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// Unit of every angle in the response.
    #[schema(value_type = names::AngleUnit)]
    pub angle_unit: AngleUnit,
    /// Version of the service.
    pub version: &'static str,
    /// Models used for the flight.
    pub models: Models,
    /// Flight of the vehicle.
    #[serde(flatten)]
    pub flight: FlightReport,
    /// Flights of the bodies that left the vehicle, and that left them, in the order of their separations; present if
    /// any did, unless `output.bodies` is `none`.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    #[schema(required = false)]
    pub bodies: Vec<BodyReport>,
    /// Derivatives of the flight; present with `sensitivities`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub sensitivities: Option<SensitivitiesAnswer>,
    /// Scatter of the end of the flight, to first order; present with `dispersions`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub covariance: Option<Covariance>,
    /// Numerical accuracy of the flight; present with `verify`. Absent, with the warning `not_verified`, if the finer
    /// flight fails.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub verification: Option<Verification>,
    /// Settings and statistics of the numerical integration.
    pub solver: SolverReport,
    /// Warnings about the request and the flight.
    pub warnings: Vec<Warning>,
    /// Request with all defaults filled in, which can be sent again; present with `echo`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = names::SimulateRequest)]
    pub case: Option<Value>,
}

/// A flight of an answer, as the formats have it that are not JSON.
#[derive(Clone, Copy, Debug)]
pub struct FlightOfAnswer<'a> {
    /// The name of the body; none of the vehicle.
    pub body: Option<&'a str>,
    /// What is told of its flight.
    pub report: &'a FlightReport,
    /// What there is to know of it.
    pub warnings: &'a [Warning],
}

impl FlightReport {
    /// What is told of the flight of a body by a request, with the rows that it asks for.
    pub(super) fn new(request: &SimulateRequest, body: &FlownBody, points: Option<Vec<FlightPoint>>) -> Self {
        let (unit, FlownBody { described: DescribedBody { events, .. }, flight, known, .. }) =
            (request.angle_unit, body);
        let row = |point| Row::new(point, unit, *known);
        let name = |event: usize| events[event].name.clone();
        let report = |EventPoint { event, before, after }| EventReport {
            index: event,
            name: name(event),
            time: before.time,
            state: row(before),
            after: row(after),
        };
        let origin = |event, burnout| Some(PhaseOrigin { index: event, name: name(event), burnout });
        let phase = |FlightPhase { from, since, until, peaks }| PhaseReport {
            from: match from {
                PhaseStart::Start => None,
                PhaseStart::Event(event) => origin(event, false),
                PhaseStart::Burnout(event) => origin(event, true),
            },
            since,
            until,
            peaks: Peaks::from(&peaks),
        };
        let last = flight.last();
        let shape = &request.planet.core.shape;
        let nearest_site = request.output.sites.then(|| NearestSite::to(&ground_point(&last), shape, unit)).flatten();
        let phases = flight.phases();
        let condition = match flight.termination() {
            CoreTermination::Condition(index) => Some(index),
            _ => None,
        };
        let propellant = |point: &FlightPoint, part: &str| body.propellant(point, part);
        let chosen = request.output.columns.as_deref();
        Self {
            termination: flight.termination().into(),
            condition,
            initial_state: row(flight.initial()),
            final_state: row(last),
            nearest_site,
            events: (!events.is_empty()).then(|| flight.events().map(report).collect()),
            peaks: Peaks::from(flight.peaks()),
            phases: (phases.len() > 1).then(|| phases.into_iter().map(phase).collect()),
            trajectory: points.map(|points| Columns::new(points, chosen, unit, *known, propellant)),
        }
    }
}

impl BodyReport {
    fn new(request: &SimulateRequest, separation: &FlownSeparation, points: Option<Vec<FlightPoint>>) -> Self {
        let FlownSeparation { body, parent, event, event_name, time } = separation;
        let by_index = EventNameOrIndex::Index(*event);
        Self {
            name: body.described.name.unwrap_or_default().to_owned(),
            parent: parent.map(str::to_owned),
            separated_by: event_name.map_or(by_index, |name| EventNameOrIndex::Name(name.to_owned())),
            separated_at: *time,
            flight: FlightReport::new(request, body, points),
            solver: body.flight.statistics().into(),
            warnings: Warning::of_body(request, body),
        }
    }
}

impl SimulateResponse {
    /// The answer to a request by which so much was flown in `elapsed` seconds; `rows` are those that it asks for, of each flight in order.
    pub fn new(
        request: &SimulateRequest,
        flown: &FlownBodies,
        rows: Vec<Option<Vec<FlightPoint>>>,
        analyses: RequestedAnalyses,
        elapsed: f64,
    ) -> Self {
        let FlownBodies { vehicle, separated } = flown;
        let mut rows = rows.into_iter();
        let flight = FlightReport::new(request, vehicle, rows.next().flatten());
        let bodies = separated.iter().zip(rows).map(|(body, points)| BodyReport::new(request, body, points));
        Self {
            name: request.name.clone(),
            angle_unit: request.angle_unit,
            version: env!("CARGO_PKG_VERSION"),
            models: Models {
                planet: MODELS.of(request.planet.model),
                shape: request.planet.shape(),
                atmosphere: request.atmosphere.kind(),
                space_weather: request.atmosphere.space_weather.map(SpaceWeatherReport::from),
                gravity: request.planet.gravity(),
                aerodynamics: aerodynamics::kind(&request.vehicle.aerodynamics),
                wind: request.wind.kind(),
            },
            flight,
            bodies: bodies.collect(),
            sensitivities: analyses.sensitivities,
            covariance: analyses.covariance,
            verification: analyses.verification,
            solver: SolverReport {
                formulation: FORMULATIONS.of(request.solver.equations),
                relative_tolerance: request.solver.relative_tolerance,
                counts: vehicle.flight.statistics().into(),
                elapsed,
            },
            warnings: Warning::of(request, vehicle, analyses.unverified, Purpose::Flight),
            case: analyses.echo,
        }
    }

    /// All flights, that of the vehicle first.
    pub fn flights(&self) -> impl Iterator<Item = FlightOfAnswer<'_>> {
        let vehicle = FlightOfAnswer { body: None, report: &self.flight, warnings: &self.warnings };
        let bodies = self.bodies.iter().map(|BodyReport { name, flight: report, warnings, .. }| FlightOfAnswer {
            body: Some(name),
            report,
            warnings,
        });
        iter::once(vehicle).chain(bodies)
    }

    /// The rows of all flights that have them as a table: with more than one of these, each row begins with the name of the body, which is
    /// empty for the vehicle.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_csv(&self, csv: &mut impl Write) -> Result<(), serde_json::Error> {
        let tables = self.flights().filter_map(|flight| Some((flight.body, flight.report.trajectory.as_ref()?)));
        let tables: Vec<_> = tables.collect();
        let has_names = tables.len() > 1;
        let Some((_, first)) = tables.first() else { return Ok(()) };
        // The vehicle has every column that one of its bodies has.
        first.write_csv_header(csv, if has_names { "body," } else { "" })?;
        for (body, table) in tables {
            let beginning = has_names.then(|| format!("{},", csv_text(body.unwrap_or_default())));
            table.write_csv_lines(csv, &beginning.unwrap_or_default())?;
        }
        Ok(())
    }
}

impl From<CoreTermination> for Termination {
    fn from(termination: CoreTermination) -> Self {
        match termination {
            CoreTermination::SurfaceImpact => Self::SurfaceImpact,
            CoreTermination::StopAltitude => Self::StopAltitude,
            CoreTermination::TimeLimit => Self::TimeLimit,
            CoreTermination::Condition(_) => Self::Condition,
            CoreTermination::AtmosphereExit => Self::AtmosphereExit,
        }
    }
}

impl From<Statistics> for IntegrationCounts {
    fn from(Statistics { steps, rejected_steps, evaluations }: Statistics) -> Self {
        Self { steps, rejected_steps, evaluations }
    }
}

impl From<&CorePeaks> for Peaks {
    fn from(peaks: &CorePeaks) -> Self {
        let peak = |trajectory::Peak { value, time, altitude }| Peak { value, time, altitude };
        let of_heating = |of: fn(&HeatingPeaks) -> trajectory::Peak| peaks.heating.as_ref().map(of).map(peak);
        Self {
            deceleration: peak(peaks.deceleration),
            load_factor: peak(peaks.load_factor),
            dynamic_pressure: peak(peaks.dynamic_pressure),
            altitude: peak(peaks.altitude),
            speed: peak(peaks.speed),
            mach: peaks.mach.map(peak),
            convective_heat_flux: of_heating(|heating| heating.convective_heat_flux),
            radiative_heat_flux: of_heating(|heating| heating.radiative_heat_flux),
            heat_flux: of_heating(|heating| heating.heat_flux),
            heat_load: of_heating(|heating| heating.heat_load),
            wall_temperature: of_heating(|heating| heating.wall_temperature),
        }
    }
}
