//! The request of `/simulate`: its parts, stop, output and solver.

use reentry::control::Control;
use reentry::scenario::{self, Bound, Case, Equations, Scenario, Solver, Stop};
use reentry::trajectory::Sampling;
use reentry::vehicle::Vehicle;
use serde_json::{Value, json};

use super::atmosphere::{Atmosphere, atmosphere};
use super::columns::{AskedColumn, AvailableQuantities, COLUMNS, PROPELLANT};
use super::control::control;
use super::description::{self, NameOr, Object, Words, word};
use super::dispersions::{Dispersion, dispersion};
use super::epoch::{self, Epoch};
use super::events::{Condition, Event, EventReferences, MOST_EVENTS, condition, event};
use super::heating::{Heating, heating};
use super::numbers::{MOST_VARIED, Numbers};
use super::planet::{Planet, PlanetModel, planet};
use super::reader::Fault;
use super::schema::is;
use super::sensitivities::{RequestedSensitivities, asked};
use super::shown::shown;
use super::state::{State, inertial_conditions, state};
use super::vehicle::vehicle;
use super::wind::{Wind, wind};
use super::{ANGLE_UNITS, AngleUnit};

/// A case to simulate.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the fields are those of the request, where they are described")]
pub struct SimulateRequest {
    pub name: Option<String>,
    pub angle_unit: AngleUnit,
    pub echo: bool,
    pub sensitivities: RequestedSensitivities,
    pub dispersions: Vec<Dispersion>,
    pub verify: bool,
    pub epoch: Option<Epoch>,
    pub planet: Planet,
    pub atmosphere: Atmosphere,
    pub density_factor: f64,
    pub wind: Wind,
    pub vehicle: Vehicle,
    pub control: Control,
    pub heating: Option<Heating>,
    pub events: Vec<Event>,
    pub initial_state: State,
    /// The stop, without its further conditions.
    pub stop: Stop,
    /// The further conditions of the stop.
    pub stop_when: Vec<Condition>,
    pub output: Output,
    pub solver: Solver,
    /// What was left out and matters.
    pub assumed: AssumedDefaults,
}

/// What a request leaves out, so that the answer warns of what was taken in its place.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct AssumedDefaults {
    /// The unit of angles, though some angle is not 0.
    pub angle_unit: bool,
    /// The atmosphere, for which that of the thesis was taken.
    pub thesis_atmosphere: bool,
}

/// The rows of the trajectory.
#[derive(Clone, Debug, Default)]
pub struct Output {
    /// The instants that are asked for, if any, with the pointer to the field that asks for them.
    pub sampling: Option<(Sampling, &'static str)>,
    /// The columns that are asked for; none where all that the case has are.
    pub columns: Option<Vec<AskedColumn>>,
    /// What is asked of the bodies that leave the vehicle.
    pub bodies: OutputOfBodies,
}

/// What the answer has of the bodies that leave the vehicle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum OutputOfBodies {
    /// What it has of the vehicle.
    #[default]
    Full,
    /// The same without rows.
    Ends,
    /// Nothing: they are not flown.
    None,
}

/// The words for what the answer has of bodies.
const OUTPUTS_OF_BODIES: Words<OutputOfBodies> = Words {
    name: "OutputOfBodies",
    doc: "Output for the bodies that leave the vehicle.",
    words: &[
        word("full", OutputOfBodies::Full, "With trajectories")
            .doc("Their flights, with the rows of their trajectories."),
        word("ends", OutputOfBodies::Ends, "Without trajectories")
            .doc("Their flights without trajectories. CSV omits them, maps have their points without a track."),
        word("none", OutputOfBodies::None, "None").doc("They are not flown."),
    ],
};

/// The words for the equations to integrate.
pub const FORMULATIONS: Words<Equations> = Words {
    name: "Formulation",
    doc: "Formulation of the equations of motion; both describe the same physics.",
    words: &[
        word("cartesian", Equations::Cartesian, "Cartesian")
            .doc("Planet-fixed position and velocity; no singularities."),
        word("spherical", Equations::Spherical, "Spherical (thesis)").doc(
            "The thesis's equations in spherical coordinates; singular at the poles, in vertical flight and at rest.",
        ),
    ],
};

/// What the answer is to hold.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum RequestedOutput {
    /// Everything.
    Answer,
    /// The trajectory alone.
    Rows,
    /// The trajectory on a map.
    Map,
}

/// A sound request, ready to fly.
#[derive(Debug)]
pub struct FlightRequest {
    /// What to fly.
    pub scenario: Scenario,
    /// As requested.
    pub request: SimulateRequest,
    /// The request with every default filled in, if it asks for it.
    pub echo: Option<Value>,
    /// The numbers of the request, where some are to vary.
    pub numbers: Option<Numbers>,
}

impl FlightRequest {
    /// Parses and checks a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value, output: RequestedOutput) -> Result<Self, Vec<Fault>> {
        let mut request = description::read(&mut tree, simulate_request)?;
        let mut misplaced = request.beyond_rows(output);
        if output != RequestedOutput::Map {
            // A map has no columns, and takes no notice of those that the same case has elsewhere.
            misplaced.extend(request.impossible_columns());
        }
        if output != RequestedOutput::Answer && request.output.sampling.is_none() {
            let detail = "must not be false: CSV and map formats contain only the trajectory";
            misplaced.push(Fault::new("/output/trajectory", detail));
        }
        let numbers = request.numbers_that_vary(&tree, &mut misplaced)?;
        let scenario = match request.try_into_scenario() {
            Ok(scenario) if misplaced.is_empty() => scenario,
            scenario => return Err(scenario.err().into_iter().flatten().chain(misplaced).collect()),
        };
        if output == RequestedOutput::Map {
            // Maps know no other unit, and so do the warnings on them.
            request.angle_unit = AngleUnit::Deg;
        }
        let echo = request.echo.then_some(tree);
        Ok(Self { scenario, request, echo, numbers })
    }
}

/// A request of `/simulate`.
pub fn simulate_request(object: &mut Object) -> Option<SimulateRequest> {
    let request = case(object);
    object.named(
        "SimulateRequest",
        "Case to simulate. `vehicle` and `initial_state` are required; every other field is optional or has a \
         default. SI units; angles are in `angle_unit`.",
    );
    object.condition(
        || json!({"dependentSchemas": {"heating": {"properties": {"vehicle": {"required": ["nose_radius"]}}}}}),
    );
    request
}

/// Reads a request: its case, and what is known of its flight; none where it is not sound.
fn known_and_case(mut tree: Value) -> Option<(AvailableQuantities, Case)> {
    let request = description::read(&mut tree, simulate_request).ok()?;
    let scenario = request.try_into_scenario().ok()?;
    Some((request.known(), scenario.case().clone()))
}

/// The fields of a case.
pub(super) fn case(object: &mut Object) -> Option<SimulateRequest> {
    let given = ["angle_unit", "atmosphere"].map(|name| object.has(name));
    let name = object.field("name", "Name").doc("Name of the case; returned in the response.").optional().text();
    let angle_unit = angle_unit(object);
    let echo = object
        .field("echo", "Echo the case")
        .doc(
            "Whether the response contains the request with all defaults filled in, as `case`. CSV and map formats \
             omit it.",
        )
        .default(false)
        .boolean();
    let (sensitivities, dispersions, verify) = analyses(object);
    let epoch = epoch(
        object,
        "Time of t = 0 in RFC 3339 format. It defines the angle between the inertial and the planet-fixed frame, \
         unless the state gives that angle. On a custom planet it only dates the flight.",
    );
    let (planet, atmosphere, density_factor, wind) = environment(object, epoch);
    let vehicle = object
        .field("vehicle", "Vehicle")
        .doc("Vehicle: mass, reference area, aerodynamics and nose radius.")
        .object(vehicle);
    let control = object
        .field("control", "Control")
        .doc("Bank angle and angle of attack during the flight.")
        .default(json!({}))
        .object(control);
    let model = planet.map(|planet| planet.model);
    let heating = object
        .field("heating", "Heating")
        .doc("Heating of the stagnation point. Without it, no heat flux is computed.")
        .optional()
        .object(|object| heating(object, model));
    let events = object
        .field("events", "Events")
        .doc("Events during the flight, such as parachutes, burns and separations.")
        .optional()
        .objects([0, MOST_EVENTS], event);
    let has_epoch = object.has("epoch");
    let initial_state = object
        .field("initial_state", "Initial state")
        .doc("Position and velocity at t = 0, in one of six coordinate systems.")
        .object(|object| state(object, has_epoch));
    inertial_conditions(object, "initial_state");
    let stop = object.field("stop", "Stop").doc("Conditions that end the flight.").default(json!({})).object(stop);
    let parts: Vec<String> = Vec::new();
    let separates = false;
    let output = object
        .field("output", "Output rows")
        .doc("Rows and columns of the trajectory.")
        .default(json!({"samples_per_step": 4}))
        .object(|object| output(object, &parts, separates));
    let solver = object
        .field("solver", "Solver")
        .doc("Formulation and tolerance of the numerical integration.")
        .default(json!({}))
        .object(solver);
    let is_body = matches!(model, Some(PlanetModel::Body(_)));
    let assumed = AssumedDefaults { angle_unit: !given[0] && object.turns(), thesis_atmosphere: !given[1] && !is_body };
    let (stop, stop_when) = stop?;
    Some(SimulateRequest {
        name,
        angle_unit: angle_unit?,
        echo: echo?,
        sensitivities: sensitivities?,
        dispersions: dispersions.unwrap_or_default(),
        verify: verify?,
        epoch,
        planet: planet?,
        atmosphere: atmosphere?,
        density_factor: density_factor?,
        wind: wind.unwrap_or(Wind::STILL),
        vehicle: vehicle?,
        control: control?,
        heating,
        events: events.unwrap_or_default(),
        initial_state: initial_state?,
        stop,
        stop_when,
        output: output?,
        solver: solver?,
        assumed,
    })
}

/// What is asked beyond the flight: sensitivities, dispersions, and its accuracy.
fn analyses(object: &mut Object) -> (Option<RequestedSensitivities>, Option<Vec<Dispersion>>, Option<bool>) {
    let sensitivities = asked(object);
    let dispersions = object
        .field("dispersions", "Dispersions")
        .doc(
            "Uncertain numbers of the case. The response then contains the linear `covariance` of the end of the \
             flight. Not supported for CSV and map formats.",
        )
        .optional()
        .objects([0, MOST_VARIED], dispersion);
    let verify = object
        .field("verify", "Accuracy check")
        .doc(
            "Whether the response reports the numerical accuracy of the flight, as `verification`. It takes the \
             computing time of about two flights. Not supported for CSV and map formats.",
        )
        .default(false)
        .boolean();
    (sensitivities, dispersions, verify)
}

/// Where it flies.
fn environment(
    object: &mut Object,
    epoch: Option<Epoch>,
) -> (Option<Planet>, Option<Atmosphere>, Option<f64>, Option<Wind>) {
    let planet =
        object.field("planet", "Planet").doc("Planet: shape, gravity and rotation.").default(json!({})).object(planet);
    let model = planet.map(|planet| planet.model);
    let default = if let Some(PlanetModel::Body(_)) = model { "standard" } else { "exponential" };
    object.fill("atmosphere", json!({"type": default}));
    let atmosphere = object
        .field("atmosphere", "Atmosphere")
        .doc(
            "Atmosphere model. The default is `standard` on the named planets, and on the Earth and on a custom \
             planet the exponential atmosphere of the thesis, with the warning `thesis_atmosphere`; use `standard` \
             for new cases on the Earth.",
        )
        .optional()
        .object(|object| atmosphere(object, model, epoch));
    // Of an epoch that is at fault, that fault alone is told.
    if object.has_word("atmosphere/type", "nrlmsise00") && !object.has("epoch") {
        object.fault_of("epoch", "is required: atmosphere nrlmsise00 depends on the time");
    }
    object.condition(|| json!({"if": is("atmosphere/type", "nrlmsise00"), "then": {"required": ["epoch"]}}));
    let density_factor = object
        .field("density_factor", "Density factor")
        .doc("Factor on the density of the atmosphere model; 1.2 means 20 % denser air.")
        .default(1.0)
        .number(Bound::NON_NEGATIVE);
    let wind = object
        .field("wind", "Wind")
        .doc("Velocity of the air relative to the rotating planet. Without it, the air rotates with the planet.")
        .optional()
        .object(wind);
    (planet, atmosphere, density_factor, wind)
}

/// The unit of the angles that are read after it.
pub(super) fn angle_unit(object: &mut Object) -> Option<AngleUnit> {
    let unit = object
        .field("angle_unit", "Angle unit in JSON")
        .doc(
            "Unit of every angle in the request and in the response. If it is absent and an angle is not 0, the \
             response contains the warning `angle_unit_assumed`.",
        )
        .default("rad")
        .word(&ANGLE_UNITS);
    object.set_angle_unit(unit);
    unit
}

/// The instant t = 0, which may be left out.
pub(super) fn epoch(object: &mut Object, doc: &'static str) -> Option<Epoch> {
    object.field("epoch", "Epoch (UTC at t = 0)").doc(doc).optional().value(epoch::epoch_schema, Epoch::read)
}

/// The end of the flight, and its further conditions.
fn stop(object: &mut Object) -> Option<(Stop, Vec<Condition>)> {
    object.named("Stop", "Conditions that end the flight; the first one met ends it.");
    let default = Stop::default();
    let altitude = object
        .field("altitude", "Altitude")
        .doc(
            "Altitude along the radius vector whose downward crossing ends the flight, m. It must be above the \
             planet's centre.",
        )
        .unit("m")
        .default(default.altitude)
        .number(Bound::DISTANCE);
    let time = object
        .field("time", "Time limit")
        .doc("Time since the start at which the flight ends, s.")
        .unit("s")
        .default(default.time)
        .number(Bound::STOP_TIME);
    let ceiling = object
        .field("ceiling", "Ceiling")
        .doc("Altitude along the radius vector whose upward crossing ends the flight, m. It must be above `altitude`.")
        .unit("m")
        .optional()
        .number(Bound::DISTANCE);
    let when = object
        .field("when", "Conditions")
        .doc(
            "Further conditions; each of them ends the flight. If several are met at the same instant, the response \
             names the first in the list.",
        )
        .optional()
        .objects([0, MOST_EVENTS], condition);
    Some((Stop { altitude: altitude?, time: time?, ceiling, when: Vec::new() }, when.unwrap_or_default()))
}

/// The fields of which one says which rows there are.
const WAYS: [&str; 5] = ["samples_per_step", "interval", "count", "times", "trajectory"];

/// Rows and columns, in a case whose vehicle has parts of these names, and of which bodies may leave.
fn output(object: &mut Object, parts: &[String], separates: bool) -> Option<Output> {
    object.named(
        "Output",
        "Rows and columns of the trajectory. Exactly one of `samples_per_step`, `interval`, `count`, `times` and \
         `trajectory` must be given; if only `columns` or `bodies` is given, `samples_per_step` is 4. The rows at the \
         start and at the end are always included. Of every body that leaves the vehicle there are the same rows and \
         columns, as far as it has them.",
    );
    let has_columns = object.has("columns");
    if (has_columns || object.has("bodies")) && !WAYS.iter().any(|way| object.has(way)) {
        object.fill("samples_per_step", json!(4));
    }
    let per_step = object
        .field("samples_per_step", "Rows per step")
        .doc("Rows per integration step, the last at its end. Steps are short where the motion changes fast.")
        .optional()
        .whole_number([1, usize::MAX]);
    let interval = object
        .field("interval", "Row interval")
        .doc("Time between rows, s.")
        .unit("s")
        .optional()
        .number(Bound::POSITIVE);
    let count = object
        .field("count", "Number of rows")
        .doc("Number of rows, evenly spaced in time, both ends included.")
        .optional()
        .whole_number([2, usize::MAX]);
    let times = object
        .field("times", "Row times")
        .doc("Times of the rows since the start, ascending, s. Times after the end of the flight are dropped.")
        .unit("s")
        .optional()
        .ascending()
        .numbers(Bound::NON_NEGATIVE, [0, usize::MAX]);
    object
        .field("trajectory", "No trajectory")
        .doc("`false` omits the trajectory from the response.")
        .optional()
        .value(
            || json!({"type": "boolean", "const": false}),
            |value| match value {
                Value::Bool(false) => Ok(()),
                other => Err(format!("must be false or absent, got {}", shown(other))),
            },
        );
    let columns = object
        .field("columns", "Columns")
        .doc(
            "Columns of the trajectory, in this order. Without it, the trajectory has all columns of the case except \
             those of the osculating orbit, `energy` and, unless the vehicle has parts, `thrust`. `propellant.NAME` is \
             the propellant that is left in the part of the name. Not supported with `\"trajectory\": false` and for \
             `/analytic`, whose columns are fixed; map formats ignore it.",
        )
        .optional()
        .names_or(&COLUMNS.each_ref().map(|column| column.name), PROPELLANT, parts);
    if separates {
        object.fill("bodies", json!("full"));
    }
    let bodies = object
        .field("bodies", "Bodies that leave")
        .doc("Output for the bodies that leave the vehicle, and those that leave them; by default `full`.")
        .optional()
        .word(&OUTPUTS_OF_BODIES);
    let no_trajectory = object.has("trajectory");
    if has_columns && no_trajectory {
        object.fault_of("columns", "must not be given together with \"trajectory\": false");
    }
    object.condition(|| {
        // Without a way there are four rows a step.
        let required = |name| json!({"required": [name]});
        let (ways, others) = (WAYS.map(required), ["columns", "bodies"].map(required));
        json!({"if": {"anyOf": ways}, "then": {"oneOf": ways}, "else": {"anyOf": others}})
    });
    object.condition(|| json!({"dependentSchemas": {"trajectory": {"not": {"required": ["columns"]}}}}));
    object.one_given(&WAYS)?;
    let asked = |column| match column {
        NameOr::Name(index) => AskedColumn::Listed(&COLUMNS[index]),
        NameOr::Other(part) => AskedColumn::Propellant(part),
    };
    let per_step = per_step.map(|rows| (Sampling::PerStep(rows), "/output/samples_per_step"));
    let interval = interval.map(|interval| (Sampling::Interval(interval), "/output/interval"));
    let count = count.map(|count| (Sampling::Count(count), "/output/count"));
    let times = times.map(|times| (Sampling::Times(times), "/output/times"));
    Some(Output {
        sampling: per_step.or(interval).or(count).or(times),
        columns: columns.map(|columns| columns.into_iter().map(asked).collect()),
        bodies: bodies.unwrap_or_default(),
    })
}

fn solver(object: &mut Object) -> Option<Solver> {
    object.named("Solver", "Formulation and tolerance of the numerical integration.");
    let default = Solver::default();
    let equations = object
        .field("formulation", "Formulation")
        .doc("Formulation of the equations of motion.")
        .default("cartesian")
        .word(&FORMULATIONS);
    let relative_tolerance = object
        .field("relative_tolerance", "Relative tolerance")
        .doc(
            "Permitted error per integration step, relative to the planet's radius and circular speed. The default \
             keeps the end of flights of up to 2 hours within 1 m. Errors grow with the duration: a decay from orbit \
             is off by 10 m after 3 days, 80 m after 6 days and 700 m after 20 days; with 1e-13, it is off by 0.3 m \
             after 20 days. Longer flights get the warning `long_flight`; `verify` reports the error.",
        )
        .default(default.relative_tolerance)
        .number(Bound::RELATIVE_TOLERANCE);
    Some(Solver { equations: equations?, relative_tolerance: relative_tolerance?, ..default })
}

impl SimulateRequest {
    /// The numbers of this request, of which `tree` has every default, where some are to vary; what is wrong with those goes to `faults`.
    pub(super) fn numbers_that_vary(
        &self,
        tree: &Value,
        faults: &mut Vec<Fault>,
    ) -> Result<Option<Numbers>, Vec<Fault>> {
        if !matches!(self.sensitivities, RequestedSensitivities::Matrix { .. }) && self.dispersions.is_empty() {
            return Ok(None);
        }
        let mut tree = tree.clone();
        if let Some(tree) = tree.as_object_mut() {
            // Of /analytic, and no part of the case.
            tree.shift_remove("solution");
        }
        let (_, fields) = description::read_with_numbers(&mut tree, simulate_request)?;
        // A case that is not sound has faults of its own, and is not flown.
        let case = self.try_into_scenario().ok().map(|scenario| scenario.case().clone());
        let pointers: Vec<_> =
            self.sensitivities.pointers().chain(self.dispersions.iter().flat_map(Dispersion::pointers)).collect();
        let numbers = Numbers::new(tree, fields, &pointers, case, known_and_case);
        faults.extend(self.sensitivities.faults(self.known(), &self.events, &numbers));
        faults.extend(Dispersion::faults(&self.dispersions, &numbers));
        Ok(Some(numbers))
    }

    /// What is asked for and has no place where the answer has rows alone.
    pub(super) fn beyond_rows(&self, output: RequestedOutput) -> Vec<Fault> {
        let asked = [
            ("/sensitivities", self.sensitivities.is_something(), "true"),
            ("/verify", self.verify, "true"),
            ("/dispersions", !self.dispersions.is_empty(), "given"),
        ];
        let misplaced = asked.into_iter().filter(|(_, asked, _)| *asked && output != RequestedOutput::Answer);
        let detail = |how| format!("must not be {how}: CSV and map formats do not support it");
        misplaced.map(|(pointer, _, how)| Fault::new(pointer, detail(how))).collect()
    }

    /// Columns that are asked for and need what the models do not know.
    fn impossible_columns(&self) -> Vec<Fault> {
        let known = self.known();
        let columns = self.output.columns.iter().flatten().enumerate();
        let missing = columns.filter_map(|(index, column)| {
            let AskedColumn::Listed(column) = column else { return None };
            let missing = column.missing(known)?;
            Some(Fault::new(format!("/output/columns/{index}"), format!("{} requires {missing}", column.name)))
        });
        missing.collect()
    }

    /// What there is to know at an instant of the flight.
    pub fn known(&self) -> AvailableQuantities {
        let air = &self.atmosphere.core;
        let has_parts = false;
        AvailableQuantities {
            temperature: air.has_temperature(),
            speed_of_sound: air.has_speed_of_sound(),
            pressure: air.has_pressure(),
            epoch: self.epoch,
            heating: self.heating.is_some(),
            changing_mass: has_parts || self.events.iter().any(Event::changes_mass),
            thrust: has_parts || self.events.iter().any(Event::changes_thrust),
            parts: has_parts,
            planet: self.planet.core,
            is_on_earth: self.planet.is_earth(),
            sidereal_angle: self.initial_state.sidereal_angle(self.epoch, self.angle_unit, &self.planet),
        }
    }

    pub(super) fn try_into_scenario(&self) -> Result<Scenario, Vec<Fault>> {
        let planet = self.planet.core;
        let when = self.stop_when.iter().map(|when| when.to_core(&self.events)).collect();
        let stop = Stop { when, ..self.stop.clone() };
        let initial_state = self.initial_state.at(self.epoch, "/initial_state", self.angle_unit, &self.planet);
        let mut across = Event::area_faults(&self.events, &self.vehicle);
        across.extend(Event::parachute_faults(&self.events));
        let is_angle_known = self.initial_state.gives_sidereal()
            || self.epoch.is_none_or(|epoch| self.planet.rotation_angle(epoch).is_some());
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
        let references = EventReferences::new(&self.events, orientation.to_planet);
        let case = Case {
            planet,
            atmosphere: self.atmosphere.core.clone(),
            density_factor: self.density_factor,
            wind: self.wind.core.clone(),
            vehicle: self.vehicle.clone(),
            parts: Vec::new(),
            control: self.control.clone(),
            steering: reentry::steering::Steering::default(),
            heating: self.heating.as_ref().map(|heating| heating.core),
            events: self.events.iter().map(|event| event.to_core(&self.events, &references)).collect(),
            start_time: 0.0,
            initial_state,
            hold_down: false,
            origin: None,
            stop,
            solver: self.solver,
            bodies: Vec::new(),
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
        let stops = self.stop_when.iter().enumerate().map(|(index, when)| (format!("/stop/when/{index}"), when));
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
        | scenario::Fault::NoSuchEngine { field }
        | scenario::Fault::NoSuchPart { field }
        | scenario::Fault::SeparatedTwice { field, .. }
        | scenario::Fault::LitTwice { field, .. }
        | scenario::Fault::PropellantWithoutEngine { field }
        | scenario::Fault::PartWithoutMass { field }
        | scenario::Fault::NothingRemains { field }
        | scenario::Fault::ThrustTimes { field }
        | scenario::Fault::NoPressure { field }
        | scenario::Fault::SaidByParts { field }
        | scenario::Fault::TooManyBodies { field }
        | scenario::Fault::NoParachute { field, .. } => format!("/{}", field.replace('.', "/")),
        scenario::Fault::OfBody { field, fault: of_body } => {
            format!("/{}{}", field.replace('.', "/"), self::fault(of_body).pointer)
        }
        scenario::Fault::SphericalParts => "/solver/formulation".to_owned(),
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
