//! The request of `/simulate`: planet, atmosphere, vehicle, control, state, stop, output and solver.

use reentry::atmosphere::Atmosphere as CoreAtmosphere;
use reentry::planet::{Planet as CorePlanet, Shape as CoreShape};
use reentry::scenario::{self, Bound, Case, Equations, Scenario};
use reentry::trajectory::Sampling;
use reentry::vehicle::{Aerodynamics as CoreAerodynamics, Vehicle as CoreVehicle};
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::epoch::Instant;
use super::reader::{self, Fault, Object};
use super::state::State;

/// A case to simulate. `vehicle` and `initial_state` are required; all else has defaults. SI units; angles in `angle_unit`.
#[derive(Clone, Debug, ToSchema)]
pub struct SimulateRequest {
    /// Given back in the answer.
    #[schema(required = false)]
    pub name: Option<String>,
    /// The unit of every angle in the request and in the answer.
    #[schema(required = false, default = "rad")]
    pub angle_unit: AngleUnit,
    /// Whether the answer repeats the request, with every default filled in, as `case`.
    #[schema(required = false, default = false)]
    pub echo: bool,
    /// The instant t = 0: an RFC 3339 time. Where `sidereal_time` is absent, it follows from the Earth rotation angle.
    #[schema(required = false, value_type = String, format = DateTime)]
    pub epoch: Option<Instant>,
    /// Where it flies.
    #[schema(required = false)]
    pub planet: Planet,
    /// The air.
    #[schema(required = false)]
    pub atmosphere: Atmosphere,
    /// What flies.
    pub vehicle: Vehicle,
    /// How it is flown.
    #[schema(required = false)]
    pub control: Control,
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
}

/// The planets whose numbers are known.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum PlanetModel {
    /// WGS 84.
    EarthWgs84,
    /// The numbers of the thesis's program, which made its results: g₀ = 9.798 m/s².
    EarthJamesonListing,
    /// The numbers of the thesis's text: g₀ = 9.7803253359 m/s².
    EarthJamesonText,
    /// The four numbers given beside it.
    Custom,
}

/// The surface from which altitudes are measured.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, ToSchema)]
#[serde(rename_all = "snake_case")]
pub enum Shape {
    /// A sphere of the equatorial radius.
    Sphere,
    /// An ellipsoid of revolution.
    Ellipsoid,
}

/// The planet. The four numbers are given with the model `custom`, and only there.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Planet {
    /// Which planet.
    #[schema(required = false, default = "earth_wgs84")]
    pub model: PlanetModel,
    /// Its surface.
    #[schema(required = false, default = "ellipsoid")]
    pub shape: Shape,
    /// Acceleration of gravity times the squared radius, m³/s²; of a custom planet.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0, maximum = 1e25)]
    pub gravitational_parameter: Option<f64>,
    /// m; of a custom planet.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0, maximum = 1e12)]
    pub equatorial_radius: Option<f64>,
    /// m; of a custom planet.
    #[schema(required = false, value_type = f64, exclusive_minimum = 0, maximum = 1e12)]
    pub polar_radius: Option<f64>,
    /// Relative to inertial space, positive to the east, rad/s whatever the `angle_unit`; of a custom planet; 0 is allowed.
    #[schema(required = false, value_type = f64, minimum = -1, maximum = 1)]
    pub rotation_rate: Option<f64>,
    /// The same, for the core.
    #[schema(ignore)]
    pub core: CorePlanet,
}

/// The atmosphere, which turns with the planet.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(("exponential" = "#/components/schemas/ExponentialAtmosphere"))))]
pub enum Atmosphere {
    /// One scale height.
    Exponential(ExponentialAtmosphere),
}

/// Density ρ₀ e^(-h/H) at the altitude h along the radius vector.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct ExponentialAtmosphere {
    /// The kind of atmosphere.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// ρ₀, at altitude 0, kg/m³.
    #[schema(required = false, minimum = 0, default = 1.54793)]
    pub surface_density: f64,
    /// H, m.
    #[schema(required = false, exclusive_minimum = 0, default = 6935)]
    pub scale_height: f64,
}

/// A point mass with lift and drag.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Vehicle {
    /// kg.
    #[schema(exclusive_minimum = 0)]
    pub mass: f64,
    /// The area to which the coefficients refer, m².
    #[schema(minimum = 0)]
    pub reference_area: f64,
    /// Lift and drag.
    pub aerodynamics: Aerodynamics,
}

/// Lift and drag coefficients.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(discriminator(property_name = "type", mapping(("constant" = "#/components/schemas/ConstantAerodynamics"))))]
pub enum Aerodynamics {
    /// The same at every speed.
    Constant(ConstantAerodynamics),
}

/// Coefficients that are the same at every speed.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct ConstantAerodynamics {
    /// The kind of aerodynamics.
    #[serde(rename = "type")]
    pub kind: &'static str,
    /// Negative lift points down at zero bank. Lift fades out within 0.001 rad of the vertical, where the bank angle is undefined.
    #[schema(required = false, default = 0)]
    pub lift_coefficient: f64,
    /// Drag acts against the velocity relative to the rotating planet.
    #[schema(minimum = 0)]
    pub drag_coefficient: f64,
}

/// How the vehicle is flown.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Control {
    /// 0: lift upward in the plane of radius and velocity; positive tilts it to the left of the flight direction. Within ±2π (±360°).
    #[schema(required = false, minimum = -360, maximum = 360, default = 0)]
    pub bank_angle: f64,
}

/// When the flight ends, whichever comes first.
#[derive(Clone, Copy, Debug, ToSchema)]
pub struct Stop {
    /// The altitude along the radius vector whose downward crossing ends the flight, m; above the planet's centre.
    #[schema(required = false, minimum = -1e12, maximum = 1e12, default = 0)]
    pub altitude: f64,
    /// s.
    #[schema(required = false, exclusive_minimum = 0, maximum = 1e9, default = 10000)]
    pub time: f64,
}

/// The rows of the trajectory: exactly one of these. Rows at the start and at the end are always there.
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
    /// The error allowed in a step, relative to the planet's radius and circular speed. The default keeps the impact within 1 m.
    #[schema(required = false, minimum = 1e-14, maximum = 1e-3, default = 1e-10)]
    pub relative_tolerance: f64,
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
    pub fn try_from_tree(mut tree: Value) -> Result<Self, Vec<Fault>> {
        let request = reader::read(&mut tree, SimulateRequest::read)?;
        let scenario = request.try_into_scenario()?;
        let sampling = request.output.sampling();
        let echo = request.echo.then_some(tree);
        Ok(Self { scenario, sampling, request, echo })
    }
}

impl SimulateRequest {
    fn read(object: &mut Object) -> Option<Self> {
        let name = object.optional_string("name");
        let angle_unit = object.angle_unit();
        let echo = object.boolean_or("echo", false);
        let epoch = read_epoch(object);
        let planet = object.object_or("planet", json!({}), Planet::read);
        let atmosphere = object.object_or("atmosphere", json!({"type": "exponential"}), Atmosphere::read);
        let vehicle = object.object("vehicle", Vehicle::read);
        let control = object.object_or("control", json!({}), Control::read);
        let has_epoch = object.has("epoch");
        let initial_state = object.object("initial_state", |object| {
            if !has_epoch {
                object.fill("sidereal_time", json!(0));
            }
            State::read(object)
        });
        let stop = object.object_or("stop", json!({}), Stop::read);
        let output = object.object_or("output", json!({"samples_per_step": 4}), Output::read);
        let solver = object.object_or("solver", json!({}), Solver::read);
        Some(Self {
            name,
            angle_unit: angle_unit?,
            echo: echo?,
            epoch,
            planet: planet?,
            atmosphere: atmosphere?,
            vehicle: vehicle?,
            control: control?,
            initial_state: initial_state?,
            stop: stop?,
            output: output?,
            solver: solver?,
        })
    }

    fn try_into_scenario(&self) -> Result<Scenario, Vec<Fault>> {
        let planet = self.planet.core;
        let stop = scenario::Stop { altitude: self.stop.altitude, time: self.stop.time };
        let initial_state = self.initial_state.at(self.epoch, "/initial_state", self.angle_unit, &planet);
        let mut faults: Vec<_> = scenario::planet_faults(&planet, &stop).iter().map(fault).collect();
        let initial_state = match initial_state {
            Ok((state, _)) if faults.is_empty() => state,
            Ok(_) => return Err(faults),
            Err(own) => {
                faults.extend(own);
                return Err(faults);
            }
        };
        let case = Case {
            planet,
            atmosphere: self.atmosphere.to_core(),
            vehicle: self.vehicle.to_core(),
            bank_angle: self.angle_unit.to_radians(self.control.bank_angle),
            initial_state,
            stop,
            solver: self.solver.to_core(),
        };
        Scenario::new(case).map_err(|error| error.0.iter().map(fault).collect())
    }
}

/// A fault that the core found, at the field of the request that it concerns.
pub fn fault(fault: &scenario::Fault) -> Fault {
    let pointer = match fault {
        scenario::Fault::OutOfBounds { field, .. } => format!("/{}", field.replace('.', "/")),
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
pub fn read_epoch(object: &mut Object) -> Option<Instant> {
    if object.has("epoch") { object.value("epoch", Instant::read) } else { None }
}

impl Planet {
    /// Reads a planet; a named one must not have numbers of its own.
    pub fn read(object: &mut Object) -> Option<Self> {
        const MODELS: [(&str, PlanetModel); 4] = [
            ("earth_wgs84", PlanetModel::EarthWgs84),
            ("earth_jameson_listing", PlanetModel::EarthJamesonListing),
            ("earth_jameson_text", PlanetModel::EarthJamesonText),
            ("custom", PlanetModel::Custom),
        ];
        let model = object.choice_or("model", &MODELS, "earth_wgs84");
        let shape =
            object.choice_or("shape", &[("sphere", Shape::Sphere), ("ellipsoid", Shape::Ellipsoid)], "ellipsoid");
        let core = match model? {
            PlanetModel::EarthWgs84 => CorePlanet::EARTH_WGS84,
            PlanetModel::EarthJamesonListing => CorePlanet::EARTH_JAMESON_LISTING,
            PlanetModel::EarthJamesonText => CorePlanet::EARTH_JAMESON_TEXT,
            PlanetModel::Custom => Self::read_custom(object)?,
        };
        let core = if shape? == Shape::Sphere { core.spherical() } else { core };
        let custom = model? == PlanetModel::Custom;
        let (equatorial_radius, polar_radius) = core.shape.semi_axes();
        Some(Self {
            model: model?,
            shape: shape?,
            gravitational_parameter: custom.then_some(core.gravitational_parameter),
            equatorial_radius: custom.then_some(equatorial_radius),
            polar_radius: custom.then_some(polar_radius),
            rotation_rate: custom.then_some(core.rotation_rate),
            core,
        })
    }

    fn read_custom(object: &mut Object) -> Option<CorePlanet> {
        let gravitational_parameter = object.number("gravitational_parameter", Bound::GRAVITATIONAL_PARAMETER);
        let equatorial_radius = object.number("equatorial_radius", Bound::RADIUS);
        let polar_radius = object.number("polar_radius", Bound::RADIUS);
        let rotation_rate = object.number("rotation_rate", Bound::ROTATION_RATE);
        Some(CorePlanet {
            shape: CoreShape::Ellipsoid { equatorial_radius: equatorial_radius?, polar_radius: polar_radius? },
            gravitational_parameter: gravitational_parameter?,
            orbital_gravitational_parameter: gravitational_parameter?,
            rotation_rate: rotation_rate?,
        })
    }
}

impl Atmosphere {
    fn read(object: &mut Object) -> Option<Self> {
        object.choice("type", &[("exponential", ())])?;
        let surface_density = object.number_or("surface_density", Bound::NON_NEGATIVE, 1.547_93);
        let scale_height = object.number_or("scale_height", Bound::POSITIVE, 6935.0);
        Some(Self::Exponential(ExponentialAtmosphere {
            kind: "exponential",
            surface_density: surface_density?,
            scale_height: scale_height?,
        }))
    }

    fn to_core(self) -> CoreAtmosphere {
        let Self::Exponential(ExponentialAtmosphere { surface_density, scale_height, .. }) = self;
        CoreAtmosphere::Exponential { surface_density, scale_height }
    }

    /// Its `type`.
    pub fn kind(self) -> &'static str {
        let Self::Exponential(exponential) = self;
        exponential.kind
    }
}

impl Vehicle {
    fn read(object: &mut Object) -> Option<Self> {
        let mass = object.number("mass", Bound::POSITIVE);
        let reference_area = object.number("reference_area", Bound::NON_NEGATIVE);
        let aerodynamics = object.object("aerodynamics", Aerodynamics::read);
        Some(Self { mass: mass?, reference_area: reference_area?, aerodynamics: aerodynamics? })
    }

    fn to_core(self) -> CoreVehicle {
        let Aerodynamics::Constant(ConstantAerodynamics { lift_coefficient, drag_coefficient, .. }) = self.aerodynamics;
        CoreVehicle {
            mass: self.mass,
            reference_area: self.reference_area,
            aerodynamics: CoreAerodynamics::Constant { lift_coefficient, drag_coefficient },
        }
    }
}

impl Aerodynamics {
    fn read(object: &mut Object) -> Option<Self> {
        object.choice("type", &[("constant", ())])?;
        let lift_coefficient = object.number_or("lift_coefficient", Bound::FINITE, 0.0);
        let drag_coefficient = object.number("drag_coefficient", Bound::NON_NEGATIVE);
        Some(Self::Constant(ConstantAerodynamics {
            kind: "constant",
            lift_coefficient: lift_coefficient?,
            drag_coefficient: drag_coefficient?,
        }))
    }
}

impl Control {
    fn read(object: &mut Object) -> Option<Self> {
        Some(Self { bank_angle: object.angle_or("bank_angle", Bound::TURN, 0.0)? })
    }
}

impl Stop {
    fn read(object: &mut Object) -> Option<Self> {
        let default = scenario::Stop::default();
        let altitude = object.number_or("altitude", Bound::DISTANCE, default.altitude);
        let time = object.number_or("time", Bound::STOP_TIME, default.time);
        Some(Self { altitude: altitude?, time: time? })
    }
}

impl Output {
    const WAYS: [&'static str; 5] = ["samples_per_step", "interval", "count", "times", "trajectory"];

    fn read(object: &mut Object) -> Option<Self> {
        let samples_per_step = object.has("samples_per_step").then(|| object.whole_number("samples_per_step", 1));
        let interval = object.optional_number("interval", Bound::POSITIVE);
        let count = object.has("count").then(|| object.whole_number("count", 2));
        let times = object.has("times").then(|| object.numbers("times", Bound::NON_NEGATIVE));
        let trajectory = object.has("trajectory").then(|| {
            object.value("trajectory", |value| match value {
                Value::Bool(false) => Ok(false),
                other => Err(format!("must be false, or be left out for one of the other ways, got {other}")),
            })
        });
        let times = times.map(|times| times.filter(|times| object.ascending("times", times)));
        object.exactly_one(&Self::WAYS)?;
        Some(Self {
            samples_per_step: samples_per_step.flatten(),
            interval,
            count: count.flatten(),
            times: times.flatten(),
            trajectory: trajectory.flatten(),
        })
    }

    /// The instants that are wanted, with the pointer to the field that asks for them.
    fn sampling(&self) -> Option<(Sampling, &'static str)> {
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
