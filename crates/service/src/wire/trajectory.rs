//! The answer of `/simulate`.

use reentry::atmosphere::nrlmsise00::{Ap, SpaceWeather};
use reentry::simulate::SimulationError;
use reentry::trajectory::{
    self, EventPoint, FlightPhase, FlightPoint, HeatingPeaks, Peaks as CorePeaks, PhaseStart,
    Termination as CoreTermination, Trajectory,
};
use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

use super::AngleUnit;
use super::columns::{Columns, Row};
use super::dispersions::Covariance;
use super::planet::MODELS;
use super::scenario::{FORMULATIONS, FlightRequest};
use super::schema::names;
use super::sensitivities::SensitivitiesAnswer;
use super::vehicle;
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
    /// Number of accepted steps.
    pub steps: usize,
    /// Number of rejected steps, which missed the tolerance.
    pub rejected_steps: usize,
    /// Number of evaluations of the equations of motion.
    pub evaluations: usize,
    /// Computing time of integration, events and peaks, s.
    pub elapsed: f64,
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
    /// How the flight ended.
    pub termination: Termination,
    /// Index in `stop.when` of the condition that ended the flight, from 0; present if a condition ended it.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub condition: Option<usize>,
    /// State at t = 0 as given, before the events at that instant.
    pub initial_state: Row,
    /// State at the end, after the events at that instant.
    pub final_state: Row,
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
    /// Rows of the trajectory; absent with `"output": {"trajectory": false}`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub trajectory: Option<Columns>,
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

impl SimulateResponse {
    /// The answer to a request whose flight was flown in `elapsed` seconds; `points` are the rows that it asks for.
    pub fn new(
        requested: FlightRequest,
        flight: &Trajectory,
        points: Option<Vec<FlightPoint>>,
        analyses: RequestedAnalyses,
        elapsed: f64,
    ) -> Self {
        let FlightRequest { request, echo, .. } = requested;
        let unit = request.angle_unit;
        let known = request.known();
        let row = |point| Row::new(point, unit, known);
        let statistics = flight.statistics();
        let warnings = Warning::of(&request, flight, analyses.unverified, Purpose::Flight);
        let report = |EventPoint { event, before, after }| EventReport {
            index: event,
            name: request.events[event].name.clone(),
            time: before.time,
            state: row(before),
            after: row(after),
        };
        let events = (!request.events.is_empty()).then(|| flight.events().map(report).collect());
        let origin = |event: usize, burnout| {
            Some(PhaseOrigin { index: event, name: request.events[event].name.clone(), burnout })
        };
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
        let phases = flight.phases();
        let phases = (phases.len() > 1).then(|| phases.into_iter().map(phase).collect());
        let (termination, condition) = match flight.termination() {
            CoreTermination::SurfaceImpact => (Termination::SurfaceImpact, None),
            CoreTermination::StopAltitude => (Termination::StopAltitude, None),
            CoreTermination::TimeLimit => (Termination::TimeLimit, None),
            CoreTermination::Condition(index) => (Termination::Condition, Some(index)),
            CoreTermination::AtmosphereExit => (Termination::AtmosphereExit, None),
        };
        Self {
            trajectory: points.map(|points| Columns::new(points, request.output.columns, unit, known)),
            name: request.name,
            angle_unit: unit,
            version: env!("CARGO_PKG_VERSION"),
            models: Models {
                planet: MODELS.of(request.planet.model),
                shape: request.planet.shape(),
                atmosphere: request.atmosphere.kind(),
                space_weather: request.atmosphere.space_weather.map(SpaceWeatherReport::from),
                gravity: request.planet.gravity(),
                aerodynamics: vehicle::kind(&request.vehicle.aerodynamics),
                wind: request.wind.kind(),
            },
            termination,
            condition,
            initial_state: row(flight.initial()),
            final_state: row(flight.last()),
            events,
            peaks: Peaks::from(flight.peaks()),
            phases,
            sensitivities: analyses.sensitivities,
            covariance: analyses.covariance,
            verification: analyses.verification,
            solver: SolverReport {
                formulation: FORMULATIONS.of(request.solver.equations),
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
