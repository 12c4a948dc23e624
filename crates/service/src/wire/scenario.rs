//! The request of `/simulate`: its parts, stop, output and solver.

use std::borrow::Cow;
use std::collections::HashSet;
use std::f64::consts::FRAC_PI_2;

use reentry::coordinates::{FlightPath, PlanetFixed, horizon, launch_horizon};
use reentry::scenario::{self, BodyCase, Bound, Case, Equations, Scenario, Solver, Stop};
use reentry::trajectory::Sampling;
use reentry::vehicle::Vehicle;
use serde_json::{Value, json};

use super::atmosphere::{Atmosphere, atmosphere};
use super::columns::{AskedColumn, AvailableQuantities, COLUMNS, PROPELLANT};
use super::control::{ControlRequest, control};
use super::description::{self, NameOr, Object, Words, word};
use super::dispersions::{Dispersion, dispersion};
use super::epoch::{self, Epoch};
use super::events::{Condition, Event, EventReferences, MOST_EVENTS, Separation, conditions, event};
use super::heating::{Heating, heating};
use super::numbers::{MOST_VARIED, Numbers};
use super::parts::NamedPart;
use super::planet::{Planet, PlanetModel, planet};
use super::reader::Fault;
use super::schema::is;
use super::sensitivities::{RequestedSensitivities, asked};
use super::shown::shown;
use super::state::{State, inertial_conditions, initial_state};
use super::steering::{Axes, Steering};
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
    /// The parts of the vehicle, if it is made of any.
    pub parts: Vec<NamedPart>,
    pub control: ControlRequest,
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
    /// Whether the answer names the site that is nearest to the end.
    pub sites: bool,
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
    /// The trajectory on a map, or as states; without columns.
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
            // A map or a list of states has no columns, and takes no notice of those that the same case has elsewhere.
            misplaced.extend(request.impossible_columns());
        }
        if output != RequestedOutput::Answer && request.output.sampling.is_none() {
            let detail = "must not be false: CSV, OEM and map formats contain only the trajectory";
            misplaced.push(Fault::new("/output/trajectory", detail));
        }
        if request.output.sites && !request.planet.is_earth() {
            let detail = "must be false or absent on a planet other than the Earth, where the sites of GET /sites are";
            misplaced.push(Fault::new("/output/sites", detail));
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
            "Whether the response contains the request with all defaults filled in, as `case`. CSV, OEM and map \
             formats omit it.",
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
        .doc("Position and velocity at t = 0, in one of six coordinate systems, or a launch.")
        .object(|object| initial_state(object, has_epoch));
    inertial_conditions(object, "initial_state");
    let stop = object.field("stop", "Stop").doc("Conditions that end the flight.").default(json!({})).object(stop);
    let of_parts = vehicle.iter().flat_map(|(_, parts)| parts).map(|part| part.name.clone());
    let parts: Vec<_> = of_parts.collect();
    let separates = events.iter().flatten().any(|event| !event.then.separated.is_empty());
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
    let ((vehicle, parts), initial_state) = (vehicle?, initial_state?);
    let mut events = events.unwrap_or_default();
    events.extend(initial_state.is_held().then(Event::lift_off));
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
        vehicle,
        parts,
        control: control?,
        heating,
        events,
        initial_state,
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
             flight. Not supported for CSV, OEM and map formats.",
        )
        .optional()
        .objects([0, MOST_VARIED], dispersion);
    let verify = object
        .field("verify", "Accuracy check")
        .doc(
            "Whether the response reports the numerical accuracy of the flight, as `verification`. It takes the \
             computing time of about two flights. Not supported for CSV, OEM and map formats.",
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
    let when = conditions(object);
    Some((Stop { altitude: altitude?, time: time?, ceiling, when: Vec::new() }, when.unwrap_or_default()))
}

/// The fields of which one says which rows there are.
const WAYS: [&str; 5] = ["samples_per_step", "interval", "count", "times", "trajectory"];

/// Rows and columns, in a case whose vehicle has parts of these names, and of which bodies may leave.
fn output(object: &mut Object, parts: &[String], separates: bool) -> Option<Output> {
    object.named(
        "Output",
        "Rows and columns of the trajectory. Exactly one of `samples_per_step`, `interval`, `count`, `times` and \
         `trajectory` must be given; if only `columns`, `bodies` or \
         `sites` are given, `samples_per_step` is 4. The rows at the \
         start and at the end are always included. Of every body that leaves the vehicle there are the same rows and \
         columns, as far as it has them.",
    );
    let has_columns = object.has("columns");
    if ["columns", "bodies", "sites"].iter().any(|name| object.has(name)) && !WAYS.iter().any(|way| object.has(way)) {
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
             `/analytic`, whose columns are fixed; OEM and map formats ignore it.",
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
    let sites = object
        .field("sites", "Nearest site")
        .doc(
            "Whether the response names the site of `GET /sites` that is nearest to the end of the flight, as \
             `nearest_site`; by default `false`. On the Earth only; CSV, OEM and map formats ignore it.",
        )
        .optional()
        .boolean();
    let no_trajectory = object.has("trajectory");
    if has_columns && no_trajectory {
        object.fault_of("columns", "must not be given together with \"trajectory\": false");
    }
    object.condition(|| {
        // Without a way there are four rows a step.
        let required = |name| json!({"required": [name]});
        let (ways, others) = (WAYS.map(required), ["columns", "bodies", "sites"].map(required));
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
        sites: sites.unwrap_or_default(),
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

    /// What is asked beyond a flight, and has no place where many are flown.
    pub(super) fn analyses_faults(&self) -> Vec<Fault> {
        let asked = [
            ("/sensitivities", self.sensitivities.is_something()),
            ("/verify", self.verify),
            ("/dispersions", !self.dispersions.is_empty()),
        ];
        let misplaced = asked.into_iter().filter(|(_, asked)| *asked);
        misplaced.map(|(pointer, _)| Fault::new(pointer, "must be left out: only /simulate supports it")).collect()
    }

    /// What is asked for and has no place where the answer has rows alone.
    pub(super) fn beyond_rows(&self, output: RequestedOutput) -> Vec<Fault> {
        let asked = [
            ("/sensitivities", self.sensitivities.is_something(), "true"),
            ("/verify", self.verify, "true"),
            ("/dispersions", !self.dispersions.is_empty(), "given"),
        ];
        let misplaced = asked.into_iter().filter(|(_, asked, _)| *asked && output != RequestedOutput::Answer);
        let detail = |how| format!("must not be {how}: CSV, OEM and map formats do not support it");
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
        AvailableQuantities {
            temperature: air.has_temperature(),
            speed_of_sound: air.has_speed_of_sound(),
            pressure: air.has_pressure(),
            epoch: self.epoch,
            heating: self.heating.is_some(),
            changing_mass: !self.parts.is_empty() || self.events.iter().any(Event::changes_mass),
            thrust: !self.parts.is_empty() || self.events.iter().any(Event::changes_thrust),
            parts: !self.parts.is_empty(),
            planet: self.planet.core,
            is_on_earth: self.planet.is_earth(),
            sidereal_angle: self.initial_state.sidereal_angle(self.epoch, self.angle_unit, &self.planet),
        }
    }

    pub(super) fn try_into_scenario(&self) -> Result<Scenario, Vec<Fault>> {
        let planet = self.planet.core;
        let initial_state = self.initial_state.at(self.epoch, "/initial_state", self.angle_unit, &self.planet);
        let is_angle_known = self.initial_state.gives_sidereal()
            || self.epoch.is_none_or(|epoch| self.planet.rotation_angle(epoch).is_some());
        let too_many = Event::body_faults(&self.events);
        if !too_many.is_empty() {
            return Err(too_many);
        }
        let vehicle = self.vehicle_flown();
        let mut across = vehicle.faults();
        across.extend(Event::frame_faults(&self.events, &self.control, is_angle_known));
        across.extend(Separation::name_faults(&self.events, "", &mut HashSet::new()));
        if self.initial_state.is_held() {
            across.extend(Event::lift_off_faults(&self.events));
        }
        let of_planet: Vec<_> = scenario::planet_faults(&planet, &self.stop).iter().map(fault).collect();
        let (initial_state, orientation) = match initial_state {
            Ok(initial_state) if of_planet.is_empty() => initial_state,
            other => {
                let of_state = other.err().unwrap_or_default();
                return Err(of_planet.into_iter().chain(across).chain(of_state).collect());
            }
        };
        let origin = self.initial_state.launch(&planet);
        let launch = origin.map_or_else(|| horizon(&initial_state), |origin| launch_horizon(&origin, &planet.shape));
        let heading = FlightPath::from_planet_fixed(&initial_state).heading;
        let azimuth = self.initial_state.launch_azimuth().unwrap_or(FRAC_PI_2 - heading);
        let axes = Axes { launch, to_planet: orientation.to_planet };
        let frames = Frames { axes, azimuth, initial_state, origin };
        let case = Case { hold_down: self.initial_state.is_held(), ..self.case_of(&vehicle, &frames) };
        match Scenario::new(case) {
            Ok(scenario) if across.is_empty() => Ok(scenario),
            Ok(_) => Err(across),
            Err(error) => {
                // A name of no event or part is among the faults, with the name.
                let of_core = error.0.iter().filter(|fault| !is_of_name(fault));
                let mut faults: Vec<_> = of_core.map(|it| vehicle.located(it, &self.parts)).chain(across).collect();
                // What is wrong with a part is wrong with every body that has it.
                let mut known = HashSet::new();
                faults.retain(|Fault { pointer, detail }| known.insert((pointer.clone(), detail.clone())));
                Err(faults)
            }
        }
    }

    /// The vehicle that flies, with all that happens to it.
    fn vehicle_flown(&self) -> Flown<'_> {
        Flown {
            vehicle: Some(self.vehicle.clone()),
            separation: None,
            place: String::new(),
            parts: Cow::Borrowed(&self.parts),
            control: &self.control,
            events: &self.events,
            stop: self.stop.clone(),
            stop_time: None,
            stop_when: &self.stop_when,
        }
    }

    /// The case of what flies.
    fn case_of(&self, flown: &Flown, frames: &Frames) -> Case {
        let Flown { parts, events, control, .. } = flown;
        let references = EventReferences::new(events, parts, frames.axes, frames.azimuth);
        let names = Event::names(events);
        let (mut core_events, mut bodies) = (Vec::with_capacity(events.len()), Vec::new());
        for event in *events {
            core_events.push(event.to_core(&names, &references, bodies.len()));
            for separation in &event.then.separated {
                let body = flown.body(separation, String::new());
                bodies.push(BodyCase { case: self.case_of(&body, frames), stop_time: body.stop_time });
            }
        }
        let when = flown.stop_when.iter().map(|when| when.to_core(&names, parts)).collect();
        let vehicle = flown.vehicle.clone().unwrap_or_else(|| self.vehicle.clone());
        let heating = self.heating.as_ref().map(|heating| heating.core);
        Case {
            planet: self.planet.core,
            atmosphere: self.atmosphere.core.clone(),
            density_factor: self.density_factor,
            wind: self.wind.core.clone(),
            parts: parts.iter().map(|part| part.core.clone()).collect(),
            control: control.to_core(&names),
            steering: control.steering.as_ref().map_or_else(Default::default, |it| it.to_core(&names, &frames.axes)),
            // What leaves has no heat flux without a nose.
            heating: heating.filter(|_| flown.is_whole() || vehicle.nose_radius.is_some()),
            vehicle,
            events: core_events,
            start_time: 0.0,
            initial_state: frames.initial_state,
            hold_down: false,
            origin: frames.origin,
            stop: Stop { when, ..flown.stop.clone() },
            solver: self.solver,
            bodies,
        }
    }
}

/// Whether a fault is that of a name, of which the request has one with the name itself.
fn is_of_name(fault: &scenario::Fault) -> bool {
    match fault {
        scenario::Fault::NoSuchEvent { .. }
        | scenario::Fault::NoSuchEngine { .. }
        | scenario::Fault::NoSuchPart { .. } => true,
        // A body has as many parts as there are names of parts.
        scenario::Fault::OutOfBounds { field, .. } if field.ends_with(".parts") => true,
        // What is wrong with its parts is said of those of the vehicle.
        scenario::Fault::OfBody { fault, .. } => {
            is_of_name(fault) || matches!(**fault, scenario::Fault::NoPressure { .. } | scenario::Fault::SphericalParts)
        }
        _ => false,
    }
}

/// What flies: the vehicle, or a body that leaves it, with all that happens to it.
struct Flown<'a> {
    /// None of a body whose aerodynamics are not known.
    vehicle: Option<Vehicle>,
    /// That of a body.
    separation: Option<&'a Separation>,
    /// The pointer to it, if it is a body.
    place: String,
    parts: Cow<'a, [NamedPart]>,
    control: &'a ControlRequest,
    events: &'a [Event],
    /// Without its further conditions.
    stop: Stop,
    /// Of a body, where it is given, s.
    stop_time: Option<f64>,
    stop_when: &'a [Condition],
}

impl<'a> Flown<'a> {
    /// Whether it is the vehicle itself.
    fn is_whole(&self) -> bool {
        self.separation.is_none()
    }

    /// The body of a separation; `pointer` is that of the separation.
    fn body(&self, separation: &'a Separation, pointer: String) -> Self {
        let parts = separation.parts_of(&self.parts);
        Flown {
            // Of names of no parts alone, nothing is known.
            vehicle: separation.vehicle(&parts, &pointer).ok().filter(|_| !parts.is_empty()),
            separation: Some(separation),
            place: pointer,
            parts: Cow::Owned(parts),
            control: &separation.control,
            events: &separation.events,
            stop: separation.stop(&self.stop),
            stop_time: separation.stop.time,
            stop_when: &separation.stop.when,
        }
    }

    /// A fault that the core found, at the field of the request that it concerns; `parts` are those of the request.
    fn located(&self, of_core: &scenario::Fault, parts: &[NamedPart]) -> Fault {
        let Fault { pointer, detail } = fault(of_core);
        let names: Vec<_> = pointer.split('/').skip(1).collect();
        let index = |at: usize| names.get(at).and_then(|index| index.parse::<usize>().ok());
        let place = match (of_core, &names[..]) {
            (scenario::Fault::OfBody { fault, .. }, _) => {
                let separation = index(1).zip(index(4)).and_then(|(event, place)| {
                    self.events.get(event).and_then(|event| event.then.separated.get(place))
                });
                let of_body = separation.map(|separation| {
                    let place = format!("{}/{}", self.place, names[..5].join("/"));
                    self.body(separation, place).located(fault, parts)
                });
                return of_body.unwrap_or(Fault { pointer, detail });
            }
            (scenario::Fault::NoPressure { .. }, _) => {
                let exit_area = index(2).and_then(|index| parts.get(index)).map(NamedPart::exit_area_pointer);
                exit_area.map(|exit_area| format!("/{}/{exit_area}", names[..3].join("/")))
            }
            (_, ["vehicle", rest @ ..]) => self.separation.map(|separation| self.of_body(separation, rest, parts)),
            (_, ["control", "steering", angle, rest @ ..]) => {
                let angle = self.control.steering.as_ref().map(|steering| angle_of(steering, angle));
                angle.map(|angle| format!("/control/steering/{angle}/{}", rest.join("/")))
            }
            (_, ["events", event, "then", "steer", angle, rest @ ..]) => {
                let steering = index(1).and_then(|event| self.events.get(event)?.then.steering.as_ref());
                let angle = steering.map(|steering| angle_of(steering, angle));
                angle.map(|angle| format!("/events/{event}/then/steer/{angle}/{}", rest.join("/")))
            }
            _ => None,
        };
        let is_of_part = place.as_ref().is_some_and(|place| place.starts_with("/vehicle/parts/"));
        let of_flown = place.unwrap_or(pointer);
        Fault::new(if is_of_part { of_flown } else { format!("{}{of_flown}", self.place) }, detail)
    }

    /// The pointer to a field of the vehicle that a body is: that of the separation, or that of its single part.
    fn of_body(&self, separation: &Separation, field: &[&str], parts: &[NamedPart]) -> String {
        let field = field.join("/");
        let only = if let [only] = &self.parts[..] { NamedPart::place_of(&only.name, parts) } else { None };
        match only.filter(|_| !separation.gives_aerodynamics()) {
            Some(part) => format!("/vehicle/parts/{part}/{field}"),
            None => format!("/{field}"),
        }
    }

    /// What is wrong across its fields, and across those of the bodies that leave it.
    fn faults(&self) -> Vec<Fault> {
        let Self { events, control, parts, .. } = self;
        let mut faults = match &self.vehicle {
            Some(vehicle) => Event::area_faults(events, vehicle),
            None => Vec::new(),
        };
        faults.extend(Event::parachute_faults(events));
        faults.extend(Event::part_faults(events, parts));
        if self.is_whole() {
            faults.extend(NamedPart::faults(parts, "/vehicle/parts"));
        }
        faults.extend(self.name_faults());
        if let Some(steering) = &control.steering {
            if parts.is_empty() {
                let detail = "requires vehicle.parts: it points the engines of parts";
                faults.push(Fault::new("/control/steering", detail));
            }
            let by_axis = steering.is_attitude() && control.angle_of_attack.is_given();
            let detail = "must be omitted: the steering defines the angle of attack; only \"velocity\" takes it";
            faults.extend(by_axis.then(|| Fault::new("/control/angle_of_attack", detail)));
        }
        for (index, event) in events.iter().enumerate() {
            for (place, separation) in event.then.separated.iter().enumerate() {
                let pointer = format!("/events/{index}/then/separate/{place}");
                // Whether names of no parts are all that is missing is not known.
                let missing =
                    separation.is_of(parts).then(|| separation.vehicle(&separation.parts_of(parts), &pointer));
                faults.extend(missing.and_then(Result::err).into_iter().flatten());
                let of_body = self.body(separation, pointer.clone()).faults();
                faults.extend(
                    of_body
                        .into_iter()
                        .map(|Fault { pointer: of, detail }| Fault::new(format!("{pointer}{of}"), detail)),
                );
            }
        }
        faults
    }

    /// Events that are waited for by a name that none of them has, or several, and parts without a name.
    fn name_faults(&self) -> Vec<Fault> {
        let names = Event::names(self.events);
        let events = self.events.iter().enumerate();
        let events = events.map(|(index, event)| (format!("/events/{index}/when"), &event.when));
        let stops = self.stop_when.iter().enumerate().map(|(index, when)| (format!("/stop/when/{index}"), when));
        let conditions = events.chain(stops).filter_map(|(place, when)| when.name_fault(&place, &names, &self.parts));
        let steers = self.events.iter().enumerate().filter_map(|(index, event)| {
            Some(event.then.steering.as_ref()?.name_faults(&format!("/events/{index}/then/steer"), &names))
        });
        conditions.chain(self.control.name_faults(&names)).chain(steers.flatten()).collect()
    }
}

/// The name of an angle of a steering, which the core calls `pitch` or `yaw`.
fn angle_of(steering: &Steering, of_core: &str) -> &'static str {
    let [pitch, yaw] = steering.angles();
    if of_core == "pitch" { pitch } else { yaw }
}

/// From where and how a flight starts, for all that fly.
struct Frames {
    axes: Axes,
    /// Of the launch frame, clockwise from north, rad.
    azimuth: f64,
    initial_state: PlanetFixed<f64>,
    /// From where ranges are measured, of a launch.
    origin: Option<PlanetFixed<f64>>,
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
