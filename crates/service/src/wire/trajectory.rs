//! The answer of `/simulate`.

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
use super::warning::Warning;

/// How the flight ended.
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

/// The greatest value of a quantity over the flight, or over a phase of it, the earliest where it is reached more than once.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Peak {
    /// In the unit of the quantity.
    pub value: f64,
    /// s.
    pub time: f64,
    /// Height above the planet's shape along the radius vector, m.
    pub altitude: f64,
}

/// The peaks of the flight, or of a phase of it, both ends included.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Peaks {
    /// -dV/dt, m/s².
    pub deceleration: Peak,
    /// Lift, drag and thrust over mass and 9.80665 m/s².
    pub load_factor: Peak,
    /// Pa.
    pub dynamic_pressure: Peak,
    /// m.
    pub altitude: Peak,
    /// Relative to the rotating planet, m/s.
    pub speed: Peak,
    /// The speed relative to the air over that of sound; where the atmosphere has a temperature.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub mach: Option<Peak>,
    /// Into the stagnation point by convection, W/m²; with heating.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub convective_heat_flux: Option<Peak>,
    /// Into the stagnation point by radiation, W/m²; with heating.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub radiative_heat_flux: Option<Peak>,
    /// Into the stagnation point, both fluxes together, W/m²; with heating.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub heat_flux: Option<Peak>,
    /// Since the start of the flight, J/m²; with heating.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub heat_load: Option<Peak>,
    /// At which the wall radiates as much as it gets, K; with heating.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub wall_temperature: Option<Peak>,
}

/// An event that happened.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct EventReport {
    /// Its place in the list of the request.
    pub index: usize,
    /// As in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// When it happened, s.
    pub time: f64,
    /// The state then, before its effect.
    pub state: Row,
    /// The state then, after its effect.
    pub after: Row,
}

/// With what a phase begins.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PhaseOrigin {
    /// The place of the event in the list of the request; of several events at one instant, the last that changes the vehicle.
    pub index: usize,
    /// Of the event, as in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// True where the phase begins when the propellant is spent; the event had switched that thrust on.
    #[serde(skip_serializing_if = "std::ops::Not::not")]
    #[schema(required = false)]
    pub burnout: bool,
}

/// A part of the flight in which the vehicle stays the same. The first has no length where an event changes the vehicle at the start,
/// the last where one does at the end.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct PhaseReport {
    /// With what it begins; null at the start of the flight.
    pub from: Option<PhaseOrigin>,
    /// When it begins, s.
    pub since: f64,
    /// When it ends, s.
    pub until: f64,
    /// The greatest values in it: at its start those after the change, at its end those before the next one.
    pub peaks: Peaks,
}

/// The models that flew.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Models {
    /// The planet.
    #[schema(value_type = names::PlanetModel)]
    pub planet: &'static str,
    /// Its surface.
    #[schema(value_type = names::Shape)]
    pub shape: &'static str,
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
    #[schema(value_type = names::Formulation)]
    pub formulation: &'static str,
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

/// A finished flight.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct SimulateResponse {
    /// As in the request.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub name: Option<String>,
    /// The unit of every angle.
    #[schema(value_type = names::AngleUnit)]
    pub angle_unit: AngleUnit,
    /// Of the service.
    pub version: &'static str,
    /// The models that flew.
    pub models: Models,
    /// How the flight ended.
    pub termination: Termination,
    /// Of `stop.when`, the index of the condition that ended the flight.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub condition: Option<usize>,
    /// At t = 0, as given: before what happens then.
    pub initial_state: Row,
    /// At the end, after what happens then.
    pub final_state: Row,
    /// The events that happened, in order; where the request has any.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub events: Option<Vec<EventReport>>,
    /// The greatest values.
    pub peaks: Peaks,
    /// The parts of the flight between the events that change the vehicle: its mass, area, coefficients or thrust; where there are any.
    /// The greatest of their peaks are `peaks`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub phases: Option<Vec<PhaseReport>>,
    /// The rows that were asked for; absent with `"output": {"trajectory": false}`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub trajectory: Option<Columns>,
    /// The derivatives of the flight's end, with `sensitivities`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub sensitivities: Option<SensitivitiesAnswer>,
    /// How far the flight's end scatters, to first order, with `dispersions`.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub covariance: Option<Covariance>,
    /// How exact the flight is, with `verify`; absent with the warning `not_verified` where the finer flight cannot be finished.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, nullable = false)]
    pub verification: Option<Verification>,
    /// How the equations were integrated.
    pub solver: SolverReport,
    /// What the user should know.
    pub warnings: Vec<Warning>,
    /// The request with every default filled in, with `echo`: it can be sent again.
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
        let warnings = Warning::of(&request, flight, analyses.unverified);
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
