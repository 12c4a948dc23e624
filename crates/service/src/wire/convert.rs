//! The request and the answer of `/convert`.

use reentry::coordinates::{
    FlightPath, Geodetic as CoreGeodetic, Inertial, InertialFlightPath as CoreInertialFlightPath,
    OrbitalElements as CoreElements,
};
use reentry::planet::Planet as CorePlanet;
use serde::Serialize;
use serde_json::{Value, json};
use utoipa::ToSchema;

use super::AngleUnit;
use super::epoch::Epoch;
use super::planet::Planet;
use super::reader::{self, Fault, Object};
use super::scenario::read_epoch;
use super::state::{Ecef, Eci, Geodetic, InertialFlightPath, OrbitalElements, PlanetRelative, State};
use super::warning::Warning;

/// A state to convert. SI units; angles in `angle_unit`.
#[derive(Clone, Debug, ToSchema)]
pub struct ConvertRequest {
    /// The unit of every angle in the request and in the answer. Without it, an angle other than 0 comes with the warning
    /// `angle_unit_assumed`.
    #[schema(required = false, default = "rad")]
    pub angle_unit: AngleUnit,
    /// Whether the answer repeats the request, with every default filled in, as `case`.
    #[schema(required = false, default = false)]
    pub echo: bool,
    /// The planet.
    #[schema(required = false)]
    pub planet: Planet,
    /// The instant of the state: an RFC 3339 time. On the Earth it gives the angle to the inertial frame,
    /// where the state gives none; on a custom planet it gives none.
    #[schema(required = false, value_type = String, format = DateTime)]
    pub epoch: Option<Epoch>,
    /// The state.
    pub state: State,
    /// Whether the unit of angles is left out, though some angle is not 0.
    #[schema(ignore)]
    pub assumes_angle_unit: bool,
}

/// The state in every coordinate system; each can be sent back as it is.
#[derive(Clone, Debug, Serialize, ToSchema)]
pub struct ConvertResponse {
    /// The unit of every angle.
    pub angle_unit: AngleUnit,
    /// Against the geocentric horizontal.
    pub planet_relative: PlanetRelative,
    /// Against the geodetic horizontal.
    pub geodetic: Geodetic,
    /// Planet-fixed vectors.
    pub ecef: Ecef,
    /// Inertial vectors.
    pub eci: Eci,
    /// The orbit; null for motion towards or away from the planet's centre, which has no elements.
    pub orbital_elements: Option<OrbitalElements>,
    /// Speed and angles of the inertial velocity, against the geocentric horizontal.
    pub inertial_flight_path: InertialFlightPath,
    /// What follows from the state.
    pub derived: Derived,
    /// What the user should know.
    pub warnings: Vec<Warning>,
    /// The request with every default filled in, with `echo`: it can be sent again.
    #[serde(skip_serializing_if = "Option::is_none")]
    #[schema(required = false, value_type = ConvertRequest)]
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

impl ConvertRequest {
    fn read(object: &mut Object) -> Option<Self> {
        let has_unit = object.has("angle_unit");
        let angle_unit = object.angle_unit();
        let echo = object.boolean_or("echo", false);
        let planet = object.object_or("planet", json!({}), Planet::read);
        let epoch = read_epoch(object);
        let has_epoch = object.has("epoch");
        let state = object.object("state", |object| State::read(object, has_epoch));
        let assumes_angle_unit = !has_unit && object.turns();
        Some(Self { angle_unit: angle_unit?, echo: echo?, planet: planet?, epoch, state: state?, assumes_angle_unit })
    }
}

impl ConvertResponse {
    /// Parses, checks and answers a request.
    ///
    /// # Errors
    /// With every fault of its structure or, where that is sound, every fault across its fields.
    pub fn try_from_tree(mut tree: Value) -> Result<Self, Vec<Fault>> {
        let request = reader::read(&mut tree, ConvertRequest::read)?;
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
        let geodetic = CoreGeodetic::from_planet_fixed(&state, &planet.shape);
        Ok(Self {
            angle_unit: unit,
            planet_relative: PlanetRelative::from_core(
                &FlightPath::from_planet_fixed(&state).wrapped(),
                unit,
                sidereal,
            ),
            geodetic: Geodetic::from_core(&geodetic, unit, sidereal),
            ecef: Ecef::from_core(&state, sidereal),
            eci: Eci::from_core(&inertial, frame, orientation.given()),
            orbital_elements: elements_only
                .map(|elements| OrbitalElements::from_core(&elements, unit, frame, orientation.given())),
            inertial_flight_path: InertialFlightPath::from_core(
                &CoreInertialFlightPath::from_planet_fixed(&state, &planet),
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
