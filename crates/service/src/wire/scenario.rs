//! The request of `/simulate`: its parts, stop, output and solver.

use reentry::control::Control;
use reentry::scenario::{self, Bound, Case, Equations, Scenario};
use reentry::trajectory::Sampling;
use reentry::vehicle::Vehicle;
use reentry::wind::Wind as CoreWind;
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::atmosphere::Atmosphere;
use super::columns::{COLUMNS, Column, Known};
use super::control::control;
use super::description::reading;
use super::epoch::Epoch;
use super::events::{Among, Condition, Event, MOST_EVENTS};
use super::heating::Heating;
use super::planet::Planet;
use super::reader::{self, Fault, Object};
use super::schema::names;
use super::shown::shown;
use super::state::State;
use super::vehicle::vehicle;
use super::wind::Wind;

/// A case to simulate. `vehicle` and `initial_state` are required; all else has defaults. SI units; angles in `angle_unit`.
#[derive(Clone, Debug, ToSchema)]
pub struct SimulateRequest {
    /// Given back in the answer.
    #[schema(required = false)]
    pub name: Option<String>,
    /// The unit of every angle in the request and in the answer. Without it, an angle other than 0 comes with the warning
    /// `angle_unit_assumed`.
    #[schema(required = false, default = "rad")]
    pub angle_unit: AngleUnit,
    /// Whether the answer repeats the request, with every default filled in, as `case`; CSV and maps have no place for it.
    #[schema(required = false, default = false)]
    pub echo: bool,
    /// Whether the answer has the derivatives of the flight's end by the numbers of the case, for the computing of about six flights.
    /// Not with CSV or on a map.
    #[schema(required = false, default = false)]
    pub sensitivities: bool,
    /// Whether the answer says how exact the flight is, for the computing of about two flights. Not with CSV or on a map.
    #[schema(required = false, default = false)]
    pub verify: bool,
    /// The instant t = 0: an RFC 3339 time. On the Earth it gives the angle to the inertial frame, where
    /// the state gives none; on a custom planet it dates the flight, and no more.
    #[schema(required = false, value_type = String, format = DateTime)]
    pub epoch: Option<Epoch>,
    /// Where it flies.
    #[schema(required = false)]
    pub planet: Planet,
    /// The air; without it the exponential atmosphere of the thesis, with the warning `thesis_atmosphere`: new cases of the Earth want `us76`.
    #[schema(required = false)]
    pub atmosphere: Atmosphere,
    /// By how much the air is denser than its model.
    #[schema(required = false, minimum = 0, default = 1)]
    pub density_factor: f64,
    /// How the air moves; without it, the air turns with the planet.
    #[schema(required = false, value_type = Wind)]
    pub wind: Option<Wind>,
    /// What flies.
    #[schema(value_type = names::Vehicle)]
    pub vehicle: Vehicle,
    /// How it is flown.
    #[schema(required = false, value_type = names::Control)]
    pub control: Control,
    /// How it is heated; without it, no heat flux is computed.
    #[schema(required = false, value_type = Heating)]
    pub heating: Option<Heating>,
    /// What happens on the way.
    #[schema(required = false, max_items = 1000)]
    pub events: Vec<Event>,
    /// Where it starts, and how it moves.
    pub initial_state: State,
    /// When the flight ends.
    #[schema(required = false)]
    pub stop: Stop,
    /// Which rows the trajectory has.
    #[schema(required = false)]
    pub output: Output,
    /// How the equations are integrated.
    #[schema(required = false)]
    pub solver: Solver,
    /// What was left out and matters.
    #[schema(ignore)]
    pub assumed: Assumed,
}

/// What a request leaves out, so that the answer warns of what was taken in its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Assumed {
    /// The unit of angles, though some angle is not 0.
    pub angle_unit: bool,
    /// The atmosphere.
    pub atmosphere: bool,
}

/// When the flight ends, whichever comes first.
#[derive(Clone, Debug, ToSchema)]
pub struct Stop {
    /// The altitude along the radius vector whose downward crossing ends the flight, m; above the planet's centre.
    #[schema(required = false, minimum = -1e12, maximum = 1e12, default = 0)]
    pub altitude: f64,
    /// s.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1e9, default = 10000)]
    pub time: f64,
    /// The altitude along the radius vector whose upward crossing ends the flight, m; above `altitude`.
    #[schema(required = false, value_type = f64, minimum = -1e12, maximum = 1e12)]
    pub ceiling: Option<f64>,
    /// Conditions, each of which ends the flight; of those of one instant the first.
    #[schema(required = false, max_items = 1000)]
    pub when: Vec<Condition>,
}

/// The rows of the trajectory: exactly one of the first five, which with `columns` alone is `"samples_per_step": 4`.
/// Rows at the start and at the end are always there.
#[derive(Clone, Debug, Default, ToSchema)]
pub struct Output {
    /// Rows a step of the integration, the last at its end: many where the motion is fast.
    #[schema(required = false, value_type = usize, minimum = 1)]
    pub samples_per_step: Option<usize>,
    /// Seconds between rows.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0)]
    pub interval: Option<f64>,
    /// Rows evenly in time, both ends included.
    #[schema(required = false, value_type = usize, minimum = 2)]
    pub count: Option<usize>,
    /// Instants, ascending, s; those after the end are dropped.
    #[schema(required = false, value_type = Vec<f64>)]
    pub times: Option<Vec<f64>>,
    /// `false`: no trajectory in the answer.
    #[schema(required = false, value_type = bool)]
    pub trajectory: Option<bool>,
    /// The columns of the trajectory, in this order; without it, all that the case has but those of the osculating orbit and `thrust`.
    /// Not with `"trajectory": false`, and not for `/analytic`, which has columns of its own; maps ignore it.
    #[schema(required = false, value_type = Vec<String>)]
    pub columns: Option<Vec<&'static Column>>,
}

/// The equations to integrate: the same physics twice.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Formulation {
    /// Planet-fixed position and velocity: no singularities.
    Cartesian,
    /// The thesis's: singular at the poles, in vertical flight and at rest.
    Spherical,
}

/// How the equations are integrated.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Solver {
    /// Which equations.
    #[schema(required = false, default = "cartesian")]
    pub formulation: Formulation,
    /// The error allowed in a step, relative to the planet's radius and circular speed. The default keeps the end of flights of up to
    /// two hours within 1 m. Errors grow with the flight: a decay from orbit is off by 10 m after 3 days, 80 m after 6 and 700 m after 20;
    /// with 1e-13 by 0.3 m after 20. Longer flights come with the warning `long_flight`; `verify` gives the error.
    #[schema(required = false, minimum = 1e-14, maximum = 1e-3, default = 1e-10)]
    pub relative_tolerance: f64,
}

/// What the answer is to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Wanted {
    /// Everything.
    Answer,
    /// The trajectory alone.
    Rows,
    /// The trajectory on a map.
    Map,
}

/// A sound request, ready to fly.
#[derive(Debug)]
pub struct Job {
    /// What to fly.
    pub scenario: Scenario,
    /// Which rows are wanted, if any; with the pointer to the field that asks for them.
    pub sampling: Option<(Sampling, &'static str)>,
    /// As requested.
    pub request: SimulateRequest,
    /// The request with every default filled in, if it asks for it.
    pub echo: Option<Value>,
}

impl Job {
    /// Parses and checks a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value, wanted: Wanted) -> Result<Self, Vec<Fault>> {
        let mut request = reader::read(&mut tree, SimulateRequest::read)?;
        let sampling = request.output.sampling();
        let mut misplaced = request.beyond_rows(wanted);
        if wanted != Wanted::Map {
            // A map has no columns, and takes no notice of those that the same case has elsewhere.
            misplaced.extend(request.impossible_columns());
        }
        if wanted != Wanted::Answer && sampling.is_none() {
            let detail = "must not be false: CSV and maps consist of the trajectory";
            misplaced.push(Fault::new("/output/trajectory", detail));
        }
        let scenario = match request.try_into_scenario() {
            Ok(scenario) if misplaced.is_empty() => scenario,
            scenario => return Err(scenario.err().into_iter().flatten().chain(misplaced).collect()),
        };
        if wanted == Wanted::Map {
            // Maps know no other unit, and so do the warnings on them.
            request.angle_unit = AngleUnit::Deg;
        }
        let echo = request.echo.then_some(tree);
        Ok(Self { scenario, sampling, request, echo })
    }
}

impl SimulateRequest {
    pub(super) fn read(object: &mut Object) -> Option<Self> {
        let given = ["angle_unit", "atmosphere"].map(|name| object.has(name));
        let name = object.optional_string("name");
        let angle_unit = object.angle_unit();
        let echo = object.boolean_or("echo", false);
        let sensitivities = object.boolean_or("sensitivities", false);
        let verify = object.boolean_or("verify", false);
        let epoch = read_epoch(object);
        let planet = object.object_or("planet", json!({}), Planet::read);
        let atmosphere = object.object_or("atmosphere", json!({"type": "exponential"}), Atmosphere::read);
        let density_factor = object.number_or("density_factor", Bound::NON_NEGATIVE, 1.0);
        let wind = object.optional_object("wind", Wind::read);
        let vehicle = object.object("vehicle", |object| reading(object, vehicle));
        let control = object.object_or("control", json!({}), |object| reading(object, control));
        let heating = object.optional_object("heating", Heating::read);
        let events = object.optional_objects("events", MOST_EVENTS, Event::read);
        let has_epoch = object.has("epoch");
        let initial_state = object.object("initial_state", |object| State::read(object, has_epoch));
        let stop = object.object_or("stop", json!({}), Stop::read);
        let output = object.object_or("output", json!({"samples_per_step": 4}), Output::read);
        let solver = object.object_or("solver", json!({}), Solver::read);
        let assumed = Assumed { angle_unit: !given[0] && object.turns(), atmosphere: !given[1] };
        Some(Self {
            name,
            angle_unit: angle_unit?,
            echo: echo?,
            sensitivities: sensitivities?,
            verify: verify?,
            epoch,
            planet: planet?,
            atmosphere: atmosphere?,
            density_factor: density_factor?,
            wind: wind?,
            vehicle: vehicle?,
            control: control?,
            heating: heating?,
            events: events?,
            initial_state: initial_state?,
            stop: stop?,
            output: output?,
            solver: solver?,
            assumed,
        })
    }

    /// What is asked for and has no place where the rows alone are wanted.
    pub(super) fn beyond_rows(&self, wanted: Wanted) -> Vec<Fault> {
        let asked = [("/sensitivities", self.sensitivities), ("/verify", self.verify)];
        let misplaced = asked.into_iter().filter(|(_, asked)| *asked && wanted != Wanted::Answer);
        let detail = "must not be true: CSV and maps do not have it";
        misplaced.map(|(pointer, _)| Fault::new(pointer, detail)).collect()
    }

    /// Columns that are asked for and need what the models do not know.
    fn impossible_columns(&self) -> Vec<Fault> {
        let known = self.known();
        let columns = self.output.columns.iter().flatten().enumerate();
        let missing = columns.filter_map(|(index, column)| {
            let missing = column.missing(known)?;
            Some(Fault::new(format!("/output/columns/{index}"), format!("{} needs {missing}", column.name)))
        });
        missing.collect()
    }

    /// What there is to know at an instant of the flight.
    pub fn known(&self) -> Known {
        let air = self.atmosphere.to_core();
        Known {
            temperature: air.has_temperature(),
            speed_of_sound: air.has_speed_of_sound(),
            pressure: air.has_pressure(),
            epoch: self.epoch,
            heating: self.heating.is_some(),
            changing_mass: self.events.iter().any(Event::changes_mass),
            thrust: self.events.iter().any(|event| event.then.thrust.is_some()),
            planet: self.planet.core,
            sidereal_angle: self.initial_state.sidereal_angle(self.epoch, self.angle_unit, &self.planet),
        }
    }

    pub(super) fn try_into_scenario(&self) -> Result<Scenario, Vec<Fault>> {
        let planet = self.planet.core;
        let stop = self.stop.to_core(self.angle_unit, &self.events);
        let initial_state = self.initial_state.at(self.epoch, "/initial_state", self.angle_unit, &self.planet);
        let mut across = Event::area_faults(&self.events, &self.vehicle);
        across.extend(Event::parachute_faults(&self.events));
        let is_angle_known = self.epoch.is_none() || self.planet.is_earth() || self.initial_state.gives_sidereal();
        across.extend(Event::frame_faults(&self.events, is_angle_known));
        across.extend(self.name_faults());
        let of_planet: Vec<_> = scenario::planet_faults(&planet, &stop).iter().map(fault).collect();
        let (initial_state, orientation) = match initial_state {
            Ok(initial_state) if of_planet.is_empty() => initial_state,
            other => {
                let of_state = other.err().unwrap_or_default();
                return Err(of_planet.into_iter().chain(across).chain(of_state).collect());
            }
        };
        let among = Among::new(&self.events, orientation.to_planet);
        let case = Case {
            planet,
            atmosphere: self.atmosphere.to_core(),
            density_factor: self.density_factor,
            wind: self.wind.as_ref().map_or(CoreWind::Still, Wind::to_core),
            vehicle: self.vehicle.clone(),
            control: self.control.clone(),
            heating: self.heating.map(Heating::to_core),
            events: self.events.iter().map(|event| event.to_core(self.angle_unit, &self.events, &among)).collect(),
            initial_state,
            stop,
            solver: self.solver.to_core(),
        };
        match Scenario::new(case) {
            Ok(scenario) if across.is_empty() => Ok(scenario),
            Ok(_) => Err(across),
            Err(error) => {
                // A name of no event is among the faults, with the name.
                let of_core = error.0.iter().filter(|fault| !matches!(fault, scenario::Fault::NoSuchEvent { .. }));
                Err(of_core.map(fault).chain(across).collect())
            }
        }
    }

    /// Events that are waited for by a name that none of them has, or several.
    fn name_faults(&self) -> Vec<Fault> {
        let events = self.events.iter().enumerate();
        let events = events.map(|(index, event)| (format!("/events/{index}/when"), &event.when));
        let stops = self.stop.when.iter().enumerate().map(|(index, when)| (format!("/stop/when/{index}"), when));
        events.chain(stops).filter_map(|(place, when)| when.name_fault(&place, &self.events)).collect()
    }
}

/// A fault that the core found, at the field of the request that it concerns.
pub fn fault(fault: &scenario::Fault) -> Fault {
    let pointer = match fault {
        scenario::Fault::OutOfBounds { field, .. } | scenario::Fault::NoTemperature { field } => {
            format!("/{}", field.replace('.', "/"))
        }
        scenario::Fault::TimeFalls { field }
        | scenario::Fault::NoHeating { field }
        | scenario::Fault::NoHeading { field }
        | scenario::Fault::NoSuchEvent { field }
        | scenario::Fault::NeverHappens { field }
        | scenario::Fault::PropellantUnused { field }
        | scenario::Fault::NoParachute { field, .. } => format!("/{}", field.replace('.', "/")),
        scenario::Fault::LowCeiling { .. } => "/stop/ceiling".to_owned(),
        scenario::Fault::NoNoseRadius => "/vehicle/nose_radius".to_owned(),
        scenario::Fault::OddShape { .. } => "/planet/polar_radius".to_owned(),
        scenario::Fault::StopBelowCentre { .. } => "/stop/altitude".to_owned(),
        scenario::Fault::AtCentre
        | scenario::Fault::TooFar { .. }
        | scenario::Fault::TooFast { .. }
        | scenario::Fault::BelowStopAltitude { .. }
        | scenario::Fault::InfiniteAcceleration => "/initial_state".to_owned(),
    };
    Fault::new(pointer, fault.to_string())
}

/// Reads the epoch, which may be left out.
pub fn read_epoch(object: &mut Object) -> Option<Epoch> {
    if object.has("epoch") { object.value("epoch", Epoch::read) } else { None }
}

impl Stop {
    fn read(object: &mut Object) -> Option<Self> {
        let default = scenario::Stop::default();
        let altitude = object.number_or("altitude", Bound::DISTANCE, default.altitude);
        let time = object.number_or("time", Bound::STOP_TIME, default.time);
        let ceiling = object.optional_number("ceiling", Bound::DISTANCE);
        let when = object.optional_objects("when", MOST_EVENTS, Condition::read);
        Some(Self { altitude: altitude?, time: time?, ceiling, when: when? })
    }

    fn to_core(&self, unit: AngleUnit, events: &[Event]) -> scenario::Stop {
        let Self { altitude, time, ceiling, ref when } = *self;
        scenario::Stop { altitude, time, ceiling, when: when.iter().map(|when| when.to_core(unit, events)).collect() }
    }
}

impl Output {
    /// The fields of which one says which rows there are.
    pub const WAYS: [&'static str; 5] = ["samples_per_step", "interval", "count", "times", "trajectory"];

    fn read(object: &mut Object) -> Option<Self> {
        let columns =
            object.has("columns").then(|| object.choices("columns", &COLUMNS.each_ref().map(|c| (c.name, c))));
        if columns.is_some() && !Self::WAYS.iter().any(|way| object.has(way)) {
            object.fill("samples_per_step", json!(4));
        }
        let samples_per_step = object.has("samples_per_step").then(|| object.whole_number("samples_per_step", 1));
        let interval = object.optional_number("interval", Bound::POSITIVE);
        let count = object.has("count").then(|| object.whole_number("count", 2));
        let times = object.has("times").then(|| object.numbers("times", Bound::NON_NEGATIVE));
        let trajectory = object.has("trajectory").then(|| {
            object.value("trajectory", |value| match value {
                Value::Bool(false) => Ok(false),
                other => Err(format!("must be false or absent, got {}", shown(other))),
            })
        });
        if columns.is_some() && trajectory.is_some() {
            object.fault_of("columns", "must not be given together with \"trajectory\": false".to_owned());
        }
        let times = times.map(|times| times.filter(|times| object.ascending("times", "", times)));
        object.exactly_one(&Self::WAYS)?;
        Some(Self {
            samples_per_step: samples_per_step.flatten(),
            interval,
            count: count.flatten(),
            times: times.flatten(),
            trajectory: trajectory.flatten(),
            columns: columns.flatten(),
        })
    }

    /// The instants that are wanted, with the pointer to the field that asks for them.
    pub(super) fn sampling(&self) -> Option<(Sampling, &'static str)> {
        let per_step = self.samples_per_step.map(|rows| (Sampling::PerStep(rows), "/output/samples_per_step"));
        let interval = || self.interval.map(|interval| (Sampling::Interval(interval), "/output/interval"));
        let count = || self.count.map(|count| (Sampling::Count(count), "/output/count"));
        let times = || self.times.clone().map(|times| (Sampling::Times(times), "/output/times"));
        per_step.or_else(interval).or_else(count).or_else(times)
    }
}

impl Solver {
    fn read(object: &mut Object) -> Option<Self> {
        let formulations = [("cartesian", Formulation::Cartesian), ("spherical", Formulation::Spherical)];
        let formulation = object.choice_or("formulation", &formulations, "cartesian");
        let default = scenario::Solver::default().relative_tolerance;
        let relative_tolerance = object.number_or("relative_tolerance", Bound::RELATIVE_TOLERANCE, default);
        Some(Self { formulation: formulation?, relative_tolerance: relative_tolerance? })
    }

    fn to_core(self) -> scenario::Solver {
        let equations = match self.formulation {
            Formulation::Cartesian => Equations::Cartesian,
            Formulation::Spherical => Equations::Spherical,
        };
        scenario::Solver { equations, relative_tolerance: self.relative_tolerance, ..scenario::Solver::default() }
    }
}
