//! What a request wants of a flight: of a quantity, of the place where it ends, or of how it ends.

use std::rc::Rc;

use reentry::coordinates::{OrbitShape, Site};
use reentry::planet::Planet;
use reentry::scenario::Bound;
use reentry::sensitivity::Moment;
use reentry::solve::flight::{Extent, KeptFlight, SearchFlight};
use reentry::solve::requirement::{Requirement, Wanted};
use reentry::trajectory::{FlightPoint, Peak, Peaks, Termination as CoreTermination, Trajectory};
use reentry::{Interrupt, simulate::SimulationError};

use super::AngleUnit;
use super::columns::{AvailableQuantities, Column};
use super::description::{Object, Words, word};
use super::events::Event;
use super::outputs::{At, AvailableWhereMoved, FlightOutput, OutputNumber, at_site, ground_point, place_of, quantity};
use super::reader::Fault;
use super::shown::quoted;
use super::trajectory::Termination;

/// What is wanted of a flight.
#[derive(Clone, Debug)]
pub struct RequestedRequirement {
    /// The name of the body of whose flight it is wanted; none of the vehicle.
    body: Option<String>,
    aspect: Aspect,
}

/// What of a flight a requirement is on.
#[derive(Clone, Debug)]
enum Aspect {
    /// A quantity at a moment, or the distance from a site.
    Number {
        /// What is taken from the flight.
        output: FlightOutput,
        /// What it is to be, in the unit of the request.
        wanted: Wanted,
        /// How near is reached.
        tolerance: Option<f64>,
    },
    /// That the flight ends in one of these ways.
    Ends(Vec<Termination>),
}

/// A body of a request: the places of event and separation of it, after those of the bodies from which it comes.
type BodyPath = Vec<(usize, usize)>;

/// The words for how a flight ends.
pub const TERMINATIONS: Words<Termination> = Words {
    name: "Termination",
    doc: "How the flight ended.",
    words: &[
        word("surface_impact", Termination::SurfaceImpact, "Surface impact")
            .doc("Downward crossing of a `stop.altitude` of 0."),
        word("stop_altitude", Termination::StopAltitude, "Stop altitude")
            .doc("Downward crossing of any other `stop.altitude`."),
        word("time_limit", Termination::TimeLimit, "Time limit").doc("`stop.time` was reached."),
        word("condition", Termination::Condition, "Condition")
            .doc("A condition of `stop.when` was met; `condition` is its index."),
        word("atmosphere_exit", Termination::AtmosphereExit, "Atmosphere exit")
            .doc("Upward crossing of `stop.ceiling`."),
    ],
};

/// The greatest count of limits.
pub(super) const MOST_LIMITS: usize = 16;

/// A limit: a range, and no single value.
pub(super) fn limit(object: &mut Object) -> Option<RequestedRequirement> {
    object.alternatives(&[("quantity", &limited_quantity), ("site", &near_site), ("termination", &ends)])
}

fn limited_quantity(object: &mut Object) -> Option<RequestedRequirement> {
    let output = quantity(object);
    let wanted = range(object);
    let body = body(object);
    object.exactly_one(&["at_least", "at_most", "between"])?;
    Some(RequestedRequirement { body, aspect: Aspect::Number { output: output?, wanted: wanted?, tolerance: None } })
}

/// Of whose flight a requirement is.
fn body(object: &mut Object) -> Option<String> {
    object
        .field("body", "Body")
        .doc("Name of a separated body of whose flight this is; by default that of the vehicle.")
        .optional()
        .text()
}

/// One of the ways to give a range.
fn range(object: &mut Object) -> Option<Wanted> {
    let at_least = object
        .field("at_least", "At least")
        .doc("Least value, in the unit of the quantity.")
        .optional()
        .number(Bound::FINITE);
    let at_most = object
        .field("at_most", "At most")
        .doc("Greatest value, in the unit of the quantity.")
        .optional()
        .number(Bound::FINITE);
    let between = object
        .field("between", "Between")
        .doc("Least and greatest value, in the unit of the quantity.")
        .optional()
        .ascending()
        .numbers(Bound::FINITE, [2, 2]);
    let between = between.and_then(|between| <[f64; 2]>::try_from(between).ok());
    at_least.map(Wanted::AtLeast).or(at_most.map(Wanted::AtMost)).or(between.map(Wanted::Between))
}

fn near_site(object: &mut Object) -> Option<RequestedRequirement> {
    let output = at_site(object);
    let within = object
        .field("within", "Within")
        .doc("Greatest distance of the end point from the site, m, along the great circle.")
        .unit("m")
        .number(Bound::POSITIVE);
    let body = body(object);
    Some(RequestedRequirement {
        body,
        aspect: Aspect::Number { output: output?, wanted: Wanted::AtMost(within?), tolerance: None },
    })
}

/// A goal: a value or a range.
pub(super) fn goal(object: &mut Object) -> Option<RequestedRequirement> {
    object.named(
        "Goal",
        "What a flight must achieve: a value or a range of a `quantity` at a moment, the end point at a `site` (two \
         equations, metres east and north of it) or `within` a distance of it, or one of several ways to end \
         (`termination`; by default every one but `time_limit`).",
    );
    object.alternatives(&[("quantity", &wanted_quantity), ("site", &at_or_near_site), ("termination", &ends)])
}

fn wanted_quantity(object: &mut Object) -> Option<RequestedRequirement> {
    let output = quantity(object);
    let equals =
        object.field("equals", "Equals").doc("Value, in the unit of the quantity.").optional().number(Bound::FINITE);
    let range = range(object);
    let tolerance = tolerance(object);
    let body = body(object);
    object.exactly_one(&["equals", "at_least", "at_most", "between"])?;
    let wanted = equals.map(Wanted::Equals).or(range)?;
    Some(RequestedRequirement { body, aspect: Aspect::Number { output: output?, wanted, tolerance } })
}

fn at_or_near_site(object: &mut Object) -> Option<RequestedRequirement> {
    let output = at_site(object);
    let within = object
        .field("within", "Within")
        .doc("Greatest distance of the end point from the site, m; without it, the end point must be at the site.")
        .unit("m")
        .optional()
        .number(Bound::POSITIVE);
    let tolerance = tolerance(object);
    let body = body(object);
    let wanted = within.map_or(Wanted::Equals(0.0), Wanted::AtMost);
    Some(RequestedRequirement { body, aspect: Aspect::Number { output: output?, wanted, tolerance } })
}

fn tolerance(object: &mut Object) -> Option<f64> {
    object
        .field("tolerance", "Tolerance")
        .doc(
            "How near is reached, in the unit of the quantity, and the weight of a miss. The default is 1e-6 of the \
             planet's radius r₀, of √(g₀r₀), of √(r₀/g₀), of 1 rad, or of the value.",
        )
        .optional()
        .number(Bound::POSITIVE)
}

fn ends(object: &mut Object) -> Option<RequestedRequirement> {
    let ends = object.field("termination", "Termination").doc("How the flight must end.").several(&TERMINATIONS);
    let body = body(object);
    Some(RequestedRequirement { body, aspect: Aspect::Ends(ends?) })
}

impl RequestedRequirement {
    /// What is wrong with it, given at a pointer, in a request of which so much is known.
    pub(super) fn fault(&self, pointer: &str, known: AvailableQuantities, events: &[Event]) -> Option<Fault> {
        let Some((_, events)) = self.events(events) else {
            let got = quoted(self.body.as_deref().unwrap_or_default());
            let detail = format!("must be the name of a body that an event of the case separates, got {got}");
            return Some(Fault::new(format!("{pointer}/body"), detail));
        };
        match &self.aspect {
            Aspect::Number { output, .. } => output.fault(pointer, known, events),
            Aspect::Ends(_) => None,
        }
    }

    /// The body, and the events of its flight, in a request with these events; none where no body has the name.
    fn events<'a>(&self, events: &'a [Event]) -> Option<(Option<BodyPath>, &'a [Event])> {
        let Some(name) = &self.body else { return Some((None, events)) };
        body_of_name(name, events, &[]).map(|(path, events)| (Some(path), events))
    }

    /// Whether it is on how a flight ends.
    pub fn is_on_end(&self) -> bool {
        matches!(self.aspect, Aspect::Ends(_))
    }

    /// The numbers of a flight on which it is, with what each is to be.
    pub fn numbers(&self, unit: AngleUnit, events: &[Event], planet: &Planet) -> Vec<WantedNumber> {
        let (Aspect::Number { output, wanted, tolerance }, Some((body, events))) = (&self.aspect, self.events(events))
        else {
            return Vec::new();
        };
        let number = |source: Source, at: Moment, wanted: Wanted, natural: Option<f64>, turn: Option<f64>| {
            let magnitude = magnitude(wanted);
            let size = if magnitude > 0.0 { magnitude } else { natural.unwrap_or(1.0) };
            let tolerance = tolerance.unwrap_or(SMALL * natural.unwrap_or(size));
            let requirement = Requirement { wanted, turn, tolerance, size };
            WantedNumber { shown: requirement, body: body.clone(), source, at, unit }
        };
        let radius = planet.equatorial_radius();
        match output {
            FlightOutput::Site { site, .. } => match wanted {
                Wanted::Equals(_) => vec![
                    number(Source::East(*site), Moment::End, *wanted, Some(radius), None),
                    number(Source::North(*site), Moment::End, *wanted, Some(radius), None),
                ],
                within => vec![number(Source::Distance(*site), Moment::End, *within, Some(radius), None)],
            },
            FlightOutput::Quantity { column, at } => {
                let at = match at {
                    At::Moment(moment) => *moment,
                    At::Event { event, after } => {
                        Moment::Event { event: place_of(event, events).unwrap_or_default(), after: *after }
                    }
                };
                let source = match peak_of(column).filter(|_| at == Moment::Peak) {
                    Some(peak) => Source::Peak(column, peak),
                    None if column.name == APOAPSIS => Source::Apoapsis(column, radius),
                    None => Source::Column(column),
                };
                let turn = column.turns().then(|| unit.from_radians(std::f64::consts::TAU));
                vec![number(source, at, *wanted, natural_size(column, unit, planet), turn)]
            }
        }
    }

    /// On how a flight ends, in a request with these events; none where it is on numbers.
    pub fn end(&self, events: &[Event]) -> Option<WantedEnd> {
        match (&self.aspect, self.events(events)) {
            (Aspect::Ends(ends), Some((body, _))) => Some(WantedEnd { body, ends: ends.clone() }),
            _ => None,
        }
    }
}

/// How the flight of the vehicle or of a body is to end.
#[derive(Clone, Debug)]
pub struct WantedEnd {
    body: Option<BodyPath>,
    ends: Vec<Termination>,
}

impl WantedEnd {
    /// What a flight must keep for it.
    pub fn extent(&self) -> Extent {
        if self.body.is_some() { Extent::WithBodies } else { Extent::Ends }
    }

    /// Whether a flight ends so; a body that did not leave has no end.
    pub fn is_met(&self, flown: &SearchFlight) -> bool {
        flight_of(flown, self.body.as_ref()).is_some_and(|flight| self.admits(flight.termination()))
    }

    /// Whether it is on the vehicle, and not on a body.
    pub fn is_of_vehicle(&self) -> bool {
        self.body.is_none()
    }

    /// Whether an end is one of those.
    fn admits(&self, termination: CoreTermination) -> bool {
        self.ends.contains(&Termination::from(termination))
    }
}

/// The flight of the vehicle, or of a body.
fn flight_of<'a>(flown: &'a SearchFlight, body: Option<&BodyPath>) -> Option<KeptFlight<'a>> {
    match body {
        Some(path) => flown.body(path),
        None => Some(flown.vehicle()),
    }
}

/// The body of a name that leaves the vehicle, or a body of a path, by events, or that leaves what leaves it; and its own events.
fn body_of_name<'a>(name: &str, events: &'a [Event], path: &[(usize, usize)]) -> Option<(BodyPath, &'a [Event])> {
    let separations = events.iter().enumerate().flat_map(|(event, Event { then, .. })| {
        then.separated.iter().enumerate().map(move |(place, separated)| ((event, place), separated))
    });
    for (place, separated) in separations {
        let path = [path, &[place]].concat();
        if separated.name == name {
            return Some((path, &separated.events));
        }
        if let Some(found) = body_of_name(name, &separated.events, &path) {
            return Some(found);
        }
    }
    None
}

/// The size of what is wanted.
fn magnitude(wanted: Wanted) -> f64 {
    match wanted {
        Wanted::Equals(value) | Wanted::AtLeast(value) | Wanted::AtMost(value) => value.abs(),
        Wanted::Between([least, greatest]) => 0.5 * (greatest - least),
    }
}

/// A tolerance, in parts of the natural size of a quantity.
const SMALL: f64 = 1e-6;

const APOAPSIS: &str = "apoapsis_altitude";

/// The size of a quantity on a planet, in the unit of the request: r₀ of a length, √(g₀r₀) of a speed, √(r₀/g₀) of a time, and a radian of an
/// angle; none of others.
fn natural_size(column: &Column, unit: AngleUnit, planet: &Planet) -> Option<f64> {
    let radius = planet.equatorial_radius();
    let speed = (planet.gravitational_parameter / radius).sqrt();
    if column.turns() {
        return Some(unit.from_radians(1.0));
    }
    match column.name {
        "time" => Some(radius / speed),
        "speed" | "air_speed" | "inertial_speed" | "speed_of_sound" => Some(speed),
        "altitude" | "radius" | "geodetic_altitude" | "downrange" | "crossrange" | "ground_range"
        | "ground_distance" | "semi_major_axis" | "periapsis_altitude" | APOAPSIS => Some(radius),
        _ => None,
    }
}

/// The peak that every flight has of a column.
fn peak_of(column: &Column) -> Option<fn(&Peaks) -> Option<Peak>> {
    match column.name {
        "deceleration" => Some(|peaks| Some(peaks.deceleration)),
        "load_factor" => Some(|peaks| Some(peaks.load_factor)),
        "dynamic_pressure" => Some(|peaks| Some(peaks.dynamic_pressure)),
        "altitude" => Some(|peaks| Some(peaks.altitude)),
        "speed" => Some(|peaks| Some(peaks.speed)),
        "mach" => Some(|peaks| peaks.mach),
        "convective_heat_flux" => Some(|peaks| peaks.heating.map(|heating| heating.convective_heat_flux)),
        "radiative_heat_flux" => Some(|peaks| peaks.heating.map(|heating| heating.radiative_heat_flux)),
        "heat_load" => Some(|peaks| peaks.heating.map(|heating| heating.heat_load)),
        "wall_temperature" => Some(|peaks| peaks.heating.map(|heating| heating.wall_temperature)),
        _ => None,
    }
}

/// A number of a flight on which there is a requirement.
#[derive(Clone, Debug)]
pub struct WantedNumber {
    /// The requirement, on the number as the request has it.
    shown: Requirement,
    /// Of whose flight it is; none of the vehicle's.
    body: Option<BodyPath>,
    source: Source,
    at: Moment,
    unit: AngleUnit,
}

/// From where a number is taken.
#[derive(Clone, Debug)]
enum Source {
    Column(&'static Column),
    /// The column of the apoapsis, above this radius.
    Apoapsis(&'static Column, f64),
    /// The column of which it is the peak.
    Peak(&'static Column, fn(&Peaks) -> Option<Peak>),
    East(Site),
    North(Site),
    Distance(Site),
}

/// A number of a flight, as it is shown and as searches take it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// In the unit of the request; none where the flight has none.
    pub shown: Option<f64>,
    /// The same, but for the apoapsis: of it -1/r, which goes on beyond that of a parabola.
    pub searched: Option<f64>,
}

impl WantedNumber {
    /// What a flight must keep for it.
    pub fn extent(&self) -> Extent {
        if self.body.is_some() {
            return Extent::WithBodies;
        }
        let is_at_instant = matches!(self.at, Moment::Start | Moment::End | Moment::Event { .. });
        // What is measured along the way is only known of all of it.
        let is_kept = match &self.source {
            Source::Peak(..) => return Extent::Extremes,
            Source::Column(column) => is_at_instant && !["downrange", "ground_distance"].contains(&column.name),
            Source::Apoapsis(..) | Source::East(_) | Source::North(_) | Source::Distance(_) => is_at_instant,
        };
        if is_kept { Extent::Ends } else { Extent::Whole }
    }

    /// The requirement on the number as it is shown.
    pub fn shown(&self) -> &Requirement {
        &self.shown
    }

    /// The requirement on the number as searches take it.
    pub fn searched(&self) -> Requirement {
        let Source::Apoapsis(_, radius) = self.source else { return self.shown };
        // An orbit has an apoapsis above the centre.
        let reciprocal = |altitude: f64| -1.0 / (radius + altitude).max(1.0);
        let wanted = match self.shown.wanted {
            Wanted::Equals(value) => Wanted::Equals(reciprocal(value)),
            Wanted::AtLeast(value) => Wanted::AtLeast(reciprocal(value)),
            Wanted::AtMost(value) => Wanted::AtMost(reciprocal(value)),
            Wanted::Between(range) => Wanted::Between(range.map(reciprocal)),
        };
        let middle = match self.shown.wanted {
            Wanted::Equals(value) | Wanted::AtLeast(value) | Wanted::AtMost(value) => value,
            Wanted::Between([least, greatest]) => 0.5 * (least + greatest),
        };
        let slope = reciprocal(middle).powi(2);
        Requirement { wanted, turn: None, tolerance: self.shown.tolerance * slope, size: magnitude(wanted) }
    }

    /// The number of a flight of which so much is known.
    ///
    /// # Errors
    /// When the flag is raised.
    pub fn reading(
        &self,
        flown: &SearchFlight,
        known: &AvailableQuantities,
        interrupt: &dyn Interrupt,
    ) -> Result<Reading, SimulationError> {
        let none = Reading { shown: None, searched: None };
        // A body that did not leave has no numbers.
        let Some(flown) = flight_of(flown, self.body.as_ref()) else { return Ok(none) };
        if let Source::Peak(_, peak) = &self.source {
            let value = flown.peaks().and_then(peak).map(|peak| peak.value);
            return Ok(Reading { shown: value, searched: value });
        }
        let value = |point: &FlightPoint| self.at_point(point, known).searched;
        Ok(flown.point(self.at, &value, interrupt)?.map_or(none, |point| self.at_point(&point, known)))
    }

    /// The number at a point of a flight of which so much is known.
    fn at_point(&self, point: &FlightPoint, known: &AvailableQuantities) -> Reading {
        let both = |number: Option<f64>| Reading { shown: number, searched: number };
        let planet = &known.planet;
        let of_column = |column: &Column| column.number(point, self.unit, known);
        match &self.source {
            Source::Peak(column, _) | Source::Column(column) => both(of_column(column)),
            Source::Apoapsis(column, radius) => {
                let reciprocal = || {
                    let (elements, _) = point.orbital_elements(planet, known.sidereal_angle)?;
                    let apoapsis = match elements.shape {
                        OrbitShape::SemiMajorAxis(axis) => axis * (1.0 + elements.eccentricity),
                        // Of a parabola.
                        OrbitShape::SemiLatusRectum(_) => return Some(0.0),
                    };
                    Some(-1.0 / (apoapsis - planet.equatorial_radius() + radius))
                };
                Reading { shown: of_column(column), searched: reciprocal() }
            }
            Source::East(site) => both(Some(site.offset_to(&ground_point(point), &planet.shape)[0])),
            Source::North(site) => both(Some(site.offset_to(&ground_point(point), &planet.shape)[1])),
            Source::Distance(site) => both(Some(site.distance_and_azimuth_to(&ground_point(point), &planet.shape)[0])),
        }
    }

    /// The number as it is shown and as searches take it, by which a whole flight has its derivatives; none of a body, and where the flight has no
    /// such moment. The derivative of a peak is that of its column at its time.
    pub fn outputs(&self, flight: &Trajectory, known: &Rc<AvailableWhereMoved>) -> Option<[OutputNumber; 2]> {
        if self.body.is_some() {
            return None;
        }
        let at = match &self.source {
            Source::Peak(_, peak) => Moment::Time(peak(flight.peaks())?.time),
            _ => self.at,
        };
        let name = match &self.source {
            Source::Peak(column, _) | Source::Column(column) | Source::Apoapsis(column, _) => column.name,
            Source::East(_) | Source::North(_) | Source::Distance(_) => "site",
        };
        let output = |turn: Option<f64>, of: fn(Reading) -> Option<f64>| {
            let (number, known) = (self.clone(), Rc::clone(known));
            let value = move |point: &FlightPoint, moved| of(number.at_point(point, known.of(moved)));
            OutputNumber { name, at, turn, value: Box::new(value) }
        };
        Some([
            output(self.shown.turn, |reading| reading.shown),
            output(self.searched().turn, |reading| reading.searched),
        ])
    }
}

#[cfg(test)]
mod tests {
    use reentry::planet::Planet;

    use super::{AngleUnit, natural_size};
    use crate::wire::columns::COLUMNS;

    /// The descriptions of columns name their units.
    #[test]
    fn columns_have_the_size_of_their_unit() {
        let planet = Planet::EARTH_WGS84;
        for column in COLUMNS.iter().filter(|column| column.is_number()) {
            let text = column.description.split([':', ';']).next().unwrap_or_default().trim_end_matches('.');
            let size = natural_size(column, AngleUnit::Rad, &planet);
            let expected = text.split(", ").find_map(|part| match part {
                "m" => Some(6_378_137.0),
                "m/s" => Some(7905.0),
                "s" => Some(806.8),
                _ => None,
            });
            let is_like = |size: f64| expected.is_none_or(|expected| (size / expected - 1.0).abs() < 1e-3);
            assert_eq!(expected.is_some() || column.turns(), size.is_some(), "{}: {text}", column.name);
            assert!(column.turns() || size.is_none_or(is_like), "{}", column.name);
        }
    }
}
