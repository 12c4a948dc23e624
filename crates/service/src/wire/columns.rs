//! The quantities of a flight: its states and its trajectory, as JSON and as CSV.

use std::f64::consts::{FRAC_PI_2, TAU};
use std::io::Write;

use reentry::coordinates::{FlightPath, OrbitShape, OrbitalElements, UndefinedElements};
use reentry::planet::Planet;
use reentry::trajectory::FlightPoint;
use serde::{Serialize, Serializer};
use utoipa::openapi::schema::{ArrayBuilder, KnownFormat, ObjectBuilder, SchemaFormat, SchemaType, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::AngleUnit;
use super::epoch::{Epoch, Utc};
use super::shown::printable;

/// One quantity of the flight: a key of the states, a column of the trajectory.
#[derive(Debug)]
pub struct Column {
    /// Its name in JSON and CSV.
    pub name: &'static str,
    /// Its meaning and unit.
    pub description: &'static str,
    given: Given,
    requirement: Requirement,
    quantity: ColumnSource,
}

/// Where a column is given that the case has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Given {
    /// Unless `output.columns` names others.
    Unasked,
    /// Where `output.columns` names it, and of vehicles with parts unasked.
    WithParts,
    /// Where `output.columns` names it.
    OnRequest,
}

/// What a case must have for a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Requirement {
    Nothing,
    Temperature,
    SpeedOfSound,
    Pressure,
    Epoch,
    Heating,
    ChangingMass,
    Thrust,
    Parts,
}

/// How a column is made from a point of the flight.
#[derive(Debug)]
enum ColumnSource {
    Number(fn(&FlightPoint) -> f64),
    Angle(fn(&FlightPoint) -> f64),
    /// In [0, 2π).
    Turn(fn(&FlightPoint) -> f64),
    /// Null where there is none.
    Maybe(fn(&FlightPoint) -> Option<f64>),
    /// An angle; null where there is none.
    MaybeAngle(fn(&FlightPoint) -> Option<f64>),
    /// Of the osculating orbit; null where it has none.
    Orbit(fn(&Orbit) -> Option<f64>),
    /// An angle of the osculating orbit, in [0, 2π); null where it has none.
    OrbitTurn(fn(&Orbit) -> Option<f64>),
    /// The time in UTC.
    Utc,
}

/// What there is to know at every instant of a flight beside its motion.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is asked for by its name")]
pub struct AvailableQuantities {
    /// Whether the atmosphere has a temperature.
    pub temperature: bool,
    /// Whether the atmosphere has a speed of sound.
    pub speed_of_sound: bool,
    /// Whether the atmosphere has a pressure.
    pub pressure: bool,
    /// The instant t = 0.
    pub epoch: Option<Epoch>,
    /// Whether there is a heat flux.
    pub heating: bool,
    /// Whether the mass may change.
    pub changing_mass: bool,
    /// Whether a thrust may be on.
    pub thrust: bool,
    /// Whether the vehicle has parts.
    pub parts: bool,
    /// Where it flies.
    pub planet: Planet,
    /// Whether that is an Earth.
    pub is_on_earth: bool,
    /// By which the planet is turned from the inertial frame of date at t = 0, rad.
    pub sidereal_angle: f64,
}

/// The orbit on which a vehicle would go on under the planet's gravity alone.
struct Orbit {
    elements: OrbitalElements,
    undefined: UndefinedElements,
    equatorial_radius: f64,
}

impl Orbit {
    fn of(point: &FlightPoint, available: &AvailableQuantities) -> Option<Self> {
        let (elements, undefined) = point.orbital_elements(&available.planet, available.sidereal_angle)?;
        Some(Self { elements, undefined, equatorial_radius: available.planet.equatorial_radius() })
    }
}

const fn of(name: &'static str, description: &'static str, quantity: ColumnSource) -> Column {
    Column { name, description, given: Given::Unasked, requirement: Requirement::Nothing, quantity }
}

const fn column(name: &'static str, description: &'static str, value: fn(&FlightPoint) -> f64) -> Column {
    of(name, description, ColumnSource::Number(value))
}

const fn angle(name: &'static str, description: &'static str, value: fn(&FlightPoint) -> f64) -> Column {
    of(name, description, ColumnSource::Angle(value))
}

const fn maybe(
    name: &'static str,
    description: &'static str,
    requirement: Requirement,
    value: fn(&FlightPoint) -> Option<f64>,
) -> Column {
    Column { requirement, ..of(name, description, ColumnSource::Maybe(value)) }
}

const fn orbit(name: &'static str, description: &'static str, value: fn(&Orbit) -> Option<f64>) -> Column {
    Column { given: Given::OnRequest, ..of(name, description, ColumnSource::Orbit(value)) }
}

const fn orbit_turn(name: &'static str, description: &'static str, value: fn(&Orbit) -> Option<f64>) -> Column {
    Column { given: Given::OnRequest, ..of(name, description, ColumnSource::OrbitTurn(value)) }
}

/// Every quantity, in the order of the answer.
pub static COLUMNS: [Column; 47] = [
    column("time", "Time since the start, s.", |point| point.time),
    column("altitude", "Altitude above the planet's surface along the radius vector, m.", |point| point.loads.altitude),
    column("radius", "Distance from the planet's centre, m.", |point| point.flight_path.radius),
    angle("longitude", "Longitude, east positive, in (-π, π].", |point| point.flight_path.longitude),
    angle("geocentric_latitude", "Angle of the radius vector above the equatorial plane, north positive.", |point| {
        point.flight_path.geocentric_latitude
    }),
    angle("geodetic_latitude", "Angle of the surface normal above the equatorial plane, north positive.", |point| {
        point.geodetic_latitude
    }),
    column("geodetic_altitude", "Altitude above the planet's surface along the surface normal, m.", |point| {
        point.geodetic_altitude
    }),
    column("speed", "Speed relative to the rotating planet, m/s.", |point| point.flight_path.speed),
    angle(
        "flight_path_angle",
        "Angle of the velocity relative to the rotating planet above the plane normal to the radius; negative in \
         descent.",
        |point| point.flight_path.flight_path_angle,
    ),
    angle(
        "heading",
        "Heading of the velocity relative to the rotating planet, from east (0) towards north (π/2), in (-π, π].",
        |point| point.flight_path.heading,
    ),
    column("density", "Density of the air, kg/m³.", |point| point.loads.density),
    column("dynamic_pressure", "Dynamic pressure ½ρV² with the air speed V, Pa.", |point| {
        point.loads.dynamic_pressure
    }),
    column(
        "deceleration",
        "Deceleration -dV/dt of the speed relative to the rotating planet, m/s²; at rest, minus the magnitude of the \
         acceleration.",
        |point| point.loads.deceleration,
    ),
    column(
        "load_factor",
        "Load factor, in g of the Earth on every planet: resultant of lift, drag and thrust over mass and 9.80665 m/s².",
        |point| point.loads.load_factor,
    ),
    of(
        "azimuth",
        "Azimuth of the velocity relative to the rotating planet, from north (0) towards east (π/2), in [0, 2π).",
        ColumnSource::Turn(azimuth),
    ),
    column("air_speed", "Speed relative to the air, m/s.", |point| point.loads.air_speed),
    maybe(
        "temperature",
        "Temperature of the air, K; present if the atmosphere has a temperature.",
        Requirement::Temperature,
        |point| point.temperature,
    ),
    maybe(
        "pressure",
        "Pressure of the air, Pa; present if the atmosphere has a pressure.",
        Requirement::Pressure,
        |point| point.pressure,
    ),
    maybe(
        "speed_of_sound",
        "Speed of sound in the air, m/s; present if the atmosphere has one.",
        Requirement::SpeedOfSound,
        |point| point.speed_of_sound,
    ),
    maybe(
        "mach",
        "Mach number: air speed over speed of sound; present if the atmosphere has a speed of sound.",
        Requirement::SpeedOfSound,
        |point| point.loads.mach,
    ),
    angle(
        "bank_angle",
        "Commanded bank angle; at 0, lift points upward, a positive angle tilts it to the left of the flight direction.",
        |point| point.bank_angle,
    ),
    angle("angle_of_attack", "Commanded angle of attack.", |point| point.angle_of_attack),
    maybe(
        "downrange",
        "Distance from the initial ground point along the great circle of the initial heading, m, on the sphere with \
         the equatorial radius; null if the flight starts vertically or at rest.",
        Requirement::Nothing,
        |point| point.downrange,
    ),
    maybe(
        "crossrange",
        "Distance to the right of the great circle of the initial heading, m, on the sphere with the equatorial \
         radius; null if the flight starts vertically or at rest.",
        Requirement::Nothing,
        |point| point.crossrange,
    ),
    column("inertial_speed", "Speed relative to inertial space, m/s.", |point| point.inertial_speed),
    angle(
        "inertial_flight_path_angle",
        "Angle of the inertial velocity above the plane normal to the radius; negative in descent.",
        |point| point.inertial_flight_path_angle,
    ),
    column("specific_energy", "Half the squared inertial speed plus the gravitational potential, J/kg.", |point| {
        point.specific_energy
    }),
    Column {
        requirement: Requirement::Epoch,
        ..of(
            "utc",
            "UTC in RFC 3339 format, to the microsecond, leap seconds included; present with an `epoch`. Null after \
             the year 9999.",
            ColumnSource::Utc,
        )
    },
    maybe(
        "convective_heat_flux",
        "Convective heat flux into the stagnation point, W/m²; present with `heating`.",
        Requirement::Heating,
        |point| point.loads.heat_flux.map(|flux| flux.convective),
    ),
    maybe(
        "radiative_heat_flux",
        "Radiative heat flux into the stagnation point, W/m²; present with `heating`.",
        Requirement::Heating,
        |point| point.loads.heat_flux.map(|flux| flux.radiative),
    ),
    maybe(
        "heat_load",
        "Integral of both heat fluxes since the start or, of a body, since its separation, J/m²; present with \
         `heating`.",
        Requirement::Heating,
        |point| point.heat_load,
    ),
    maybe(
        "wall_temperature",
        "Radiative equilibrium temperature of the wall, K; present with `heating`.",
        Requirement::Heating,
        |point| point.wall_temperature,
    ),
    Column {
        requirement: Requirement::ChangingMass,
        ..column(
            "mass",
            "Mass of the vehicle, kg; present if an event may change it, or the vehicle has parts.",
            |point| point.mass,
        )
    },
    column(
        "ground_range",
        "Great-circle distance from the initial ground point to that of the vehicle, m, on the sphere with the \
         equatorial radius r₀; at most π r₀.",
        |point| point.ground_range,
    ),
    column(
        "ground_distance",
        "Length of the ground track since the start or, of a body, since its separation, m, on the sphere with the \
         equatorial radius.",
        |point| point.ground_distance,
    ),
    orbit("semi_major_axis", SEMI_MAJOR_AXIS, |orbit| match orbit.elements.shape {
        OrbitShape::SemiMajorAxis(axis) => Some(axis),
        OrbitShape::SemiLatusRectum(_) => None,
    }),
    orbit("eccentricity", "Eccentricity of the osculating orbit; null for motion along the radius vector.", |orbit| {
        Some(orbit.elements.eccentricity)
    }),
    orbit_turn(
        "inclination",
        "Inclination of the osculating orbit to the equator, in [0, π]; null for motion along the radius vector.",
        |orbit| Some(orbit.elements.inclination),
    ),
    orbit_turn(
        "raan",
        "Right ascension of the ascending node of the osculating orbit, in [0, 2π), in the inertial frame of date as \
         in /convert, from which the planet is rotated by the sidereal time; null for an equatorial orbit, and for \
         motion along the radius vector.",
        |orbit| Some(orbit.elements.raan).filter(|_| !orbit.undefined.equatorial),
    ),
    orbit_turn(
        "argument_of_periapsis",
        "Argument of periapsis of the osculating orbit, from the ascending node, in [0, 2π); for an equatorial orbit, \
         from the inertial x axis in the direction of motion; null for a circular orbit, and for motion along the \
         radius vector.",
        |orbit| Some(orbit.elements.argument_of_periapsis).filter(|_| !orbit.undefined.circular),
    ),
    orbit_turn(
        "true_anomaly",
        "True anomaly on the osculating orbit, from the periapsis, in [0, 2π); for a circular orbit, from the \
         ascending node or, if that is undefined, from the inertial x axis; null for motion along the radius vector.",
        |orbit| Some(orbit.elements.true_anomaly),
    ),
    orbit(
        "apoapsis_altitude",
        "Apoapsis altitude of the osculating orbit above the equatorial radius, m; null for an unbound orbit, and for \
         motion along the radius vector.",
        |orbit| orbit.elements.apoapsis_radius().map(|radius| radius - orbit.equatorial_radius),
    ),
    orbit(
        "periapsis_altitude",
        "Periapsis altitude of the osculating orbit above the equatorial radius, m; negative if the orbit intersects \
         the planet; null for motion along the radius vector.",
        |orbit| Some(orbit.elements.periapsis_radius() - orbit.equatorial_radius),
    ),
    Column {
        given: Given::WithParts,
        requirement: Requirement::Thrust,
        ..column(
            "thrust",
            "Magnitude of the thrust, N; 0 while it is off; present if an event switches it on, or the vehicle has \
             parts.",
            |point| point.thrust,
        )
    },
    Column {
        requirement: Requirement::Parts,
        ..column(
            "throttle",
            "Thrust of all engines that are lit over their full thrust, both in vacuum: what throttles and the load \
             limit leave of it; 0 while none is lit; present if the vehicle has parts.",
            |point| point.throttle,
        )
    },
    Column {
        requirement: Requirement::Parts,
        ..of(
            "pitch",
            "Angle of the vehicle's axis above the plane normal to the radius; present if the vehicle has parts.",
            ColumnSource::MaybeAngle(|point| point.pitch),
        )
    },
    Column {
        given: Given::OnRequest,
        ..column(
            "energy",
            "Energy relative to the rotating planet, J/kg: half the squared relative speed plus the gravitational \
             potential (0 at infinity) minus half the squared speed of the planet's rotation at that place. In still \
             air, only thrust increases it. Schedules against `energy` use it.",
            |point| point.energy,
        )
    },
];

/// Says once what an osculating orbit is.
const SEMI_MAJOR_AXIS: &str = "Semi-major axis of the osculating orbit, m: the orbit that the vehicle would follow \
                               from here under the gravity of a point mass alone, with the gravitational parameter of \
                               /convert. Negative for a hyperbola; null for a parabola, and for motion along the \
                               radius vector.";

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
    pub fn missing(&self, available: AvailableQuantities) -> Option<&'static str> {
        match self.requirement {
            Requirement::Temperature if !available.temperature => {
                Some("an atmosphere with a temperature: standard, us76 or nrlmsise00, or a table with temperature")
            }
            Requirement::SpeedOfSound if !available.speed_of_sound => Some(
                "an atmosphere with a speed of sound: standard, us76 or nrlmsise00, or a table with temperature or speed_of_sound",
            ),
            Requirement::Pressure if !available.pressure => {
                Some("an atmosphere with a pressure: standard, us76 or nrlmsise00, or a table with pressure")
            }
            Requirement::Epoch if available.epoch.is_none() => Some("an epoch"),
            Requirement::Heating if !available.heating => Some("heating"),
            Requirement::ChangingMass if !available.changing_mass => Some("an event that changes it"),
            Requirement::Thrust if !available.thrust => Some("an event that switches a thrust on"),
            Requirement::Parts if !available.parts => Some("a vehicle with parts"),
            _ => None,
        }
    }

    /// Every column that the case has unasked.
    pub fn all(available: AvailableQuantities) -> impl Iterator<Item = &'static Self> {
        let is_given = move |column: &Self| match column.given {
            Given::Unasked => true,
            Given::WithParts => available.parts,
            Given::OnRequest => false,
        };
        COLUMNS.iter().filter(move |column| is_given(column) && column.missing(available).is_none())
    }

    fn of(&self, point: &FlightPoint, unit: AngleUnit, available: &AvailableQuantities) -> Cell {
        let or_nothing = |value: Option<f64>| value.map_or(Cell::Nothing, Cell::Number);
        match self.quantity {
            ColumnSource::Number(value) => Cell::Number(value(point)),
            ColumnSource::Angle(value) => Cell::Number(unit.from_radians(value(point))),
            ColumnSource::Turn(value) => Cell::Number(unit.turn_from_radians(value(point))),
            ColumnSource::Maybe(value) => or_nothing(value(point)),
            ColumnSource::MaybeAngle(value) => or_nothing(value(point).map(|angle| unit.from_radians(angle))),
            ColumnSource::Orbit(value) => or_nothing(Orbit::of(point, available).as_ref().and_then(value)),
            ColumnSource::OrbitTurn(value) => {
                let angle = Orbit::of(point, available).as_ref().and_then(value);
                or_nothing(angle.map(|angle| unit.turn_from_radians(angle)))
            }
            ColumnSource::Utc => {
                available.epoch.and_then(|epoch| epoch.utc(point.time)).map_or(Cell::Nothing, Cell::Instant)
            }
        }
    }

    /// Whether it is a number, and not an instant.
    pub fn is_number(&self) -> bool {
        !matches!(self.quantity, ColumnSource::Utc)
    }

    /// Whether it is an angle, which may go around.
    pub fn turns(&self) -> bool {
        use ColumnSource::{Angle, MaybeAngle, OrbitTurn, Turn};
        matches!(self.quantity, Angle(_) | Turn(_) | MaybeAngle(_) | OrbitTurn(_))
    }

    /// Its number at a point of the flight, in the unit of the request; none where there is none.
    pub fn number(&self, point: &FlightPoint, unit: AngleUnit, known: &AvailableQuantities) -> Option<f64> {
        match self.of(point, unit, known) {
            Cell::Number(number) => Some(number),
            Cell::Instant(_) | Cell::Nothing => None,
        }
    }

    /// The schema of a value.
    fn schema(&self) -> ObjectBuilder {
        let types = |kind| SchemaType::from_iter([kind, Type::Null]);
        match (&self.quantity, self.requirement) {
            (ColumnSource::Utc, _) => ObjectBuilder::new()
                .schema_type(types(Type::String))
                .format(Some(SchemaFormat::KnownFormat(KnownFormat::DateTime))),
            (ColumnSource::Maybe(_), Requirement::Nothing)
            | (ColumnSource::Orbit(_) | ColumnSource::OrbitTurn(_), _) => {
                ObjectBuilder::new().schema_type(types(Type::Number))
            }
            _ => ObjectBuilder::new().schema_type(Type::Number),
        }
    }
}

/// The state and the loads at an instant.
#[derive(Clone, Copy, Debug)]
pub struct Row {
    point: FlightPoint,
    unit: AngleUnit,
    available: AvailableQuantities,
}

impl Row {
    /// A point of a flight of which so much is available.
    pub fn new(point: FlightPoint, unit: AngleUnit, available: AvailableQuantities) -> Self {
        Self { point, unit, available }
    }
}

impl Serialize for Row {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(Column::all(self.available).map(|column| {
            let cell = column.of(&self.point, self.unit, &self.available);
            (column.name, cell)
        }))
    }
}

impl PartialSchema for Row {
    fn schema() -> RefOr<Schema> {
        let object = ObjectBuilder::new().description(Some("State and loads at one instant."));
        let with = |object: ObjectBuilder, column: &Column| {
            let object = object.property(column.name, column.schema().description(Some(column.description)));
            if column.requirement == Requirement::Nothing { object.required(column.name) } else { object }
        };
        COLUMNS.iter().filter(|column| column.given != Given::OnRequest).fold(object, with).into()
    }
}

impl ToSchema for Row {}

/// A column that a request names.
#[derive(Clone, Debug)]
pub enum AskedColumn {
    /// One of [`COLUMNS`].
    Listed(&'static Column),
    /// What is left of the propellant of the part of this name.
    Propellant(String),
}

/// What the name of a column begins with that has the propellant of a part.
pub const PROPELLANT: &str = "propellant.";

/// The trajectory: one array a quantity, all of one length, time strictly increasing.
#[derive(Clone, Debug)]
pub struct Columns {
    points: Vec<FlightPoint>,
    chosen: Vec<ChosenColumn>,
    unit: AngleUnit,
    available: AvailableQuantities,
}

/// A column of a trajectory.
#[derive(Clone, Debug)]
enum ChosenColumn {
    Listed(&'static Column),
    Propellant {
        /// Of the column.
        name: String,
        /// One a row, kg; none where the flight has no part of the name.
        values: Option<Vec<Option<f64>>>,
    },
}

impl Serialize for Columns {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let columns = self.chosen.iter().filter(|column| column.is_had(self.available));
        serializer.collect_map(columns.map(|column| (column.name(), Values { column, columns: self })))
    }
}

impl PartialSchema for Columns {
    fn schema() -> RefOr<Schema> {
        let description = "Trajectory: one array per quantity, all of the same length; time is strictly increasing. \
                           With `output.columns`, it has only the named columns; some columns are given only if \
                           named. A column `propellant.NAME` has the propellant that is left in the part of the name, \
                           kg, of all of its count together; null once the part has left.";
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
    column: &'a ChosenColumn,
    columns: &'a Columns,
}

impl Serialize for Values<'_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Columns { points, unit, available, .. } = self.columns;
        let column = match self.column {
            ChosenColumn::Listed(column) => column,
            ChosenColumn::Propellant { values, .. } => return serializer.collect_seq(values.iter().flatten()),
        };
        // The kind of the quantity is looked at once, not at every value.
        match column.quantity {
            ColumnSource::Number(value) => serializer.collect_seq(points.iter().map(value)),
            ColumnSource::Angle(value) => {
                serializer.collect_seq(points.iter().map(|point| unit.from_radians(value(point))))
            }
            ColumnSource::Turn(value) => {
                serializer.collect_seq(points.iter().map(|point| unit.turn_from_radians(value(point))))
            }
            ColumnSource::Maybe(value) => serializer.collect_seq(points.iter().map(value)),
            ColumnSource::MaybeAngle(_) | ColumnSource::Utc | ColumnSource::Orbit(_) | ColumnSource::OrbitTurn(_) => {
                serializer.collect_seq(points.iter().map(|point| column.of(point, *unit, available)))
            }
        }
    }
}

impl ChosenColumn {
    fn name(&self) -> &str {
        match self {
            Self::Listed(column) => column.name,
            Self::Propellant { name, .. } => name,
        }
    }

    /// Whether a flight of which so much is available has it.
    fn is_had(&self, available: AvailableQuantities) -> bool {
        match self {
            Self::Listed(column) => column.missing(available).is_none(),
            Self::Propellant { values, .. } => values.is_some(),
        }
    }
}

impl Columns {
    /// The chosen columns at the points of a flight, of which so much is available and whose vehicle has parts of these names; without a choice
    /// all that are given unasked.
    pub fn new(
        points: Vec<FlightPoint>,
        chosen: Option<&[AskedColumn]>,
        unit: AngleUnit,
        available: AvailableQuantities,
        propellant: impl Fn(&FlightPoint, &str) -> Option<Option<f64>>,
    ) -> Self {
        let of_part = |part: &str| ChosenColumn::Propellant {
            name: format!("{PROPELLANT}{part}"),
            values: points.iter().map(|point| propellant(point, part)).collect(),
        };
        let chosen = match chosen {
            None => Column::all(available).map(ChosenColumn::Listed).collect(),
            Some(chosen) => {
                let column = |asked: &AskedColumn| match asked {
                    AskedColumn::Listed(column) => ChosenColumn::Listed(column),
                    AskedColumn::Propellant(part) => of_part(part),
                };
                chosen.iter().map(column).collect()
            }
        };
        Self { points, chosen, unit, available }
    }

    /// The instants.
    pub fn points(&self) -> &[FlightPoint] {
        &self.points
    }

    /// The instant t = 0.
    pub fn epoch(&self) -> Option<Epoch> {
        self.available.epoch
    }

    fn cell(&self, column: &ChosenColumn, row: usize) -> Cell {
        match column {
            ChosenColumn::Listed(column) => column.of(&self.points[row], self.unit, &self.available),
            ChosenColumn::Propellant { values, .. } => {
                let value = values.as_ref().and_then(|values| values[row]);
                value.map_or(Cell::Nothing, Cell::Number)
            }
        }
    }

    /// A header of the names after a beginning, by RFC 4180 but for the line ends.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn write_csv_header(&self, csv: &mut impl Write, beginning: &str) -> Result<(), serde_json::Error> {
        text(csv, beginning)?;
        let names = self.chosen.iter().map(|column| csv_text(column.name()));
        text(csv, &names.collect::<Vec<_>>().join(","))?;
        text(csv, "\n")
    }

    /// A line an instant, each with the same beginning.
    ///
    /// # Errors
    /// When they cannot be written.
    pub fn write_csv_lines(&self, csv: &mut impl Write, beginning: &str) -> Result<(), serde_json::Error> {
        for row in 0..self.points.len() {
            text(csv, beginning)?;
            for (index, column) in self.chosen.iter().enumerate() {
                if index > 0 {
                    text(csv, ",")?;
                }
                match self.cell(column, row) {
                    Cell::Number(number) => serde_json::to_writer(&mut *csv, &number)?,
                    Cell::Instant(instant) => write!(csv, "{instant}").map_err(serde_json::Error::io)?,
                    Cell::Nothing => {}
                }
            }
            text(csv, "\n")?;
        }
        Ok(())
    }
}

fn text(csv: &mut impl Write, text: &str) -> Result<(), serde_json::Error> {
    csv.write_all(text.as_bytes()).map_err(serde_json::Error::io)
}

/// A text as a cell on one line: in quotation marks where it needs them, and escaped where it would leave the line.
pub fn csv_text(text: &str) -> String {
    let line = printable(text);
    if line.contains([',', '"']) { format!("\"{}\"", line.replace('"', "\"\"")) } else { line }
}
