//! The request and the answer of `/convert`.

use reentry::coordinates::{FlightPath, Geodetic, Inertial, InertialFlightPath, OrbitalElements as CoreElements};
use reentry::planet::Planet as CorePlanet;
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::description::{self, Object};
use super::epoch::Epoch;
use super::planet::{Planet, planet};
use super::reader::Fault;
use super::scenario::{angle_unit, epoch};
use super::schema::names;
use super::state::{State, answer, inertial_conditions, state};
use super::warning::Warning;

/// A state to convert.
#[derive(Clone, Debug)]
#[expect(missing_docs, reason = "the fields are those of the request, where they are described")]
pub struct ConvertRequest {
    pub angle_unit: AngleUnit,
    pub echo: bool,
    pub planet: Planet,
    pub epoch: Option<Epoch>,
    pub state: State,
    /// Whether the unit of angles is left out, though some angle is not 0.
    pub assumes_angle_unit: bool,
}

/// A request of `/convert`.
pub fn convert_request(object: &mut Object) -> Option<ConvertRequest> {
    object.named("ConvertRequest", "A state to convert. SI units; angles in `angle_unit`.");
    let has_unit = object.has("angle_unit");
    let angle_unit = angle_unit(object);
    let echo = object
        .field("echo", "Echo the case")
        .doc("Whether the answer repeats the request, with every default filled in, as `case`.")
        .default(false)
        .boolean();
    let planet = object.field("planet", "Planet").doc("The planet.").default(json!({})).object(planet);
    let epoch = epoch(
        object,
        "The instant of the state: an RFC 3339 time. On the Earth it gives the angle to the inertial frame, where the state gives none; on a \
         custom planet it gives none.",
    );
    let has_epoch = object.has("epoch");
    let state = object.field("state", "State").doc("The state.").object(|object| state(object, has_epoch));
    inertial_conditions(object, "state");
    let assumes_angle_unit = !has_unit && object.turns();
    Some(ConvertRequest {
        angle_unit: angle_unit?,
        echo: echo?,
        planet: planet?,
        epoch,
        state: state?,
        assumes_angle_unit,
    })
}

/// The state in every coordinate system; each can be sent back as it is.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct ConvertResponse {
    /// The unit of every angle.
    #[schema(value_type = names::AngleUnit)]
    pub angle_unit: AngleUnit,
    /// Against the geocentric horizontal.
    #[schema(value_type = names::PlanetRelative)]
    pub planet_relative: Value,
    /// Against the geodetic horizontal.
    #[schema(value_type = names::Geodetic)]
    pub geodetic: Value,
    /// Planet-fixed vectors.
    #[schema(value_type = names::Ecef)]
    pub ecef: Value,
    /// Inertial vectors.
    #[schema(value_type = names::Eci)]
    pub eci: Value,
    /// The orbit; null for motion towards or away from the planet's centre, which has no elements.
    #[schema(value_type = Option<names::OrbitalElements>)]
    pub orbital_elements: Option<Value>,
    /// Speed and angles of the inertial velocity, against the geocentric horizontal.
    #[schema(value_type = names::InertialFlightPath)]
    pub inertial_flight_path: Value,
    /// What follows from the state.
    pub derived: Derived,
    /// What the user should know.
    pub warnings: Vec<Warning>,
    /// The request with every default filled in, with `echo`: it can be sent again.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = names::ConvertRequest)]
    pub case: Option<Value>,
}

/// What follows from a state; its angles are in the unit of the answer.
#[derive(Clone, Copy, Debug, Serialize, ToSchema)]
pub struct Derived {
    /// Height above the planet's shape along the radius vector, m.
    pub altitude: f64,
    /// m; null where the state has no orbital elements.
    pub semi_latus_rectum: Option<f64>,
    /// Distance of the periapsis from the centre, m; null where the state has no orbital elements.
    pub periapsis_radius: Option<f64>,
    /// Distance of the apoapsis from the centre, m; null for an unbound orbit, or where the state has no orbital elements.
    pub apoapsis_radius: Option<f64>,
    /// The mean anomaly, in [0, 2π); null for an unbound orbit, or where the state has no orbital elements.
    pub mean_anomaly: Option<f64>,
    /// Half the squared inertial speed less the gravitational parameter over the radius, J/kg.
    pub specific_energy: f64,
    /// The time of one revolution, s; null for an unbound orbit, or where the state has no orbital elements.
    pub period: Option<f64>,
}

impl ConvertResponse {
    /// Parses, checks and answers a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value) -> Result<Self, Vec<Fault>> {
        let request = description::read(&mut tree, convert_request)?;
        let (unit, planet) = (request.angle_unit, request.planet.core);
        let shape_faults = reentry::scenario::planet_faults(&planet, &reentry::scenario::Stop::default());
        if !shape_faults.is_empty() {
            return Err(shape_faults.iter().map(super::scenario::fault).collect());
        }
        let (state, orientation) = request.state.at(request.epoch, "/state", unit, &request.planet)?;
        let (frame, sidereal) = (orientation.frame, orientation.sidereal);

        let inertial = Inertial::from_planet_fixed_by(&state, &planet, &orientation.to_planet);
        let elements = CoreElements::from_inertial(&inertial, planet.orbital_gravitational_parameter);
        let elements_only = elements.ok().map(|(elements, _)| elements);
        let mut warnings = Vec::new();
        warnings.extend(request.assumes_angle_unit.then(Warning::angle_unit_assumed));
        match elements {
            Ok((_, undefined)) => warnings.extend(Warning::of_undefined_elements(undefined)),
            Err(_) => warnings.push(Warning::rectilinear()),
        }
        warnings.extend(Warning::of_frame(&request.state, request.epoch, &request.planet));
        let geodetic = Geodetic::from_planet_fixed(&state, &planet.shape);
        Ok(Self {
            angle_unit: unit,
            planet_relative: answer::planet_relative(&FlightPath::from_planet_fixed(&state).wrapped(), unit, sidereal),
            geodetic: answer::geodetic(&geodetic, unit, sidereal),
            ecef: answer::ecef(&state, sidereal),
            eci: answer::eci(&inertial, frame, orientation.given()),
            orbital_elements: elements_only
                .map(|elements| answer::orbital_elements(&elements, unit, frame, orientation.given())),
            inertial_flight_path: answer::inertial_flight_path(
                &InertialFlightPath::from_planet_fixed(&state, &planet),
                unit,
                sidereal,
            ),
            derived: Derived::of(planet.shape.altitude(&state.position), &inertial, elements_only, &planet, unit),
            warnings,
            case: request.echo.then_some(tree),
        })
    }
}

impl Derived {
    fn of(
        altitude: f64,
        state: &Inertial,
        elements: Option<CoreElements>,
        planet: &CorePlanet,
        unit: AngleUnit,
    ) -> Self {
        let mean_anomaly = elements.and_then(|elements| elements.mean_anomaly());
        let gravitational_parameter = planet.orbital_gravitational_parameter;
        Self {
            altitude,
            semi_latus_rectum: elements.map(|elements| elements.semi_latus_rectum()),
            periapsis_radius: elements.map(|elements| elements.periapsis_radius()),
            apoapsis_radius: elements.and_then(|elements| elements.apoapsis_radius()),
            mean_anomaly: mean_anomaly.map(|anomaly| unit.turn_from_radians(anomaly)),
            specific_energy: state.velocity.norm_squared() / 2.0 - gravitational_parameter / state.position.norm(),
            period: elements.and_then(|elements| elements.period(gravitational_parameter)),
        }
    }
}
