//! Outputs of a flight that a request names: a quantity at a moment, or the place of the end relative to a site.

use std::f64::consts::TAU;
use std::rc::Rc;

use reentry::coordinates::Site;
use reentry::scenario::Bound;
use reentry::sensitivity::{Moment, Moved};
use reentry::trajectory::FlightPoint;

use super::AngleUnit;
use super::columns::{AvailableQuantities, COLUMNS, Column};
use super::description::{Object, WordOrObject, Words, word};
use super::events::Event;
use super::reader::Fault;
use super::sites::{ListedSite, slug_schema};

/// An output that a request names.
#[derive(Clone, Debug)]
pub enum FlightOutput {
    /// A quantity of the flight.
    Quantity {
        /// Its column.
        column: &'static Column,
        /// When.
        at: At,
    },
    /// Where the flight ends relative to a site: metres east and north of it.
    Site {
        /// Its place.
        site: Site,
        /// Whether the request gives it by the slug of a site of the Earth.
        is_listed: bool,
    },
}

/// When an output is taken.
#[derive(Clone, Debug, PartialEq)]
pub enum At {
    /// At a moment that needs no name.
    Moment(Moment),
    /// At the event of a name.
    Event {
        /// The name.
        event: String,
        /// Whether after its effect.
        after: bool,
    },
}

/// What is known of a flight, and of those in which a number is moved.
#[derive(Debug)]
pub struct AvailableWhereMoved {
    /// Of the flight itself.
    pub flight: AvailableQuantities,
    /// Of each variation by what it moves its number, and what is known there.
    pub moved: Vec<Vec<(f64, AvailableQuantities)>>,
}

impl AvailableWhereMoved {
    /// What is known of one of them.
    pub(super) fn of(&self, moved: Option<Moved>) -> &AvailableQuantities {
        let of_moved = |Moved { variation, offset }: Moved| {
            self.moved.get(variation)?.iter().find(|(by, _)| by.to_bits() == offset.to_bits()).map(|(_, known)| known)
        };
        moved.and_then(of_moved).unwrap_or(&self.flight)
    }
}

/// The ground point of a flight.
pub fn ground_point(point: &FlightPoint) -> Site {
    Site { longitude: point.flight_path.longitude, geodetic_latitude: point.geodetic_latitude }
}

/// The number of an output at a point of a flight, or of one in which a number is moved.
type OutputValue = dyn Fn(&FlightPoint, Option<Moved>) -> Option<f64>;

/// A single number of an output, as the core takes it from a flight.
pub struct OutputNumber {
    /// Its name: that of its column, or `east` or `north` of a site.
    pub name: &'static str,
    /// When it is taken.
    pub at: Moment,
    /// The full turn of an angle that goes around, in the unit of the request.
    pub turn: Option<f64>,
    /// Its value, in the unit of the request.
    pub value: Box<OutputValue>,
}

const MOMENTS: Words<Moment> = Words {
    name: "Moment",
    doc: "Moment of the flight.",
    words: &[
        word("end", Moment::End, "End").doc("End of the flight, after the events at that instant."),
        word("start", Moment::Start, "Start").doc("Start of the flight, before the events at that instant."),
        word("peak", Moment::Peak, "Maximum")
            .doc("Greatest value of the quantity over the flight, located between rows."),
        word("lowest", Moment::Lowest, "Minimum").doc("Least value of the quantity over the flight."),
    ],
};

const AT: WordOrObject = WordOrObject { name: "OutputMoment", doc: "Moment at which the output is evaluated." };

const SIDES: Words<bool> = Words {
    name: "Side",
    doc: "Side of an event.",
    words: &[
        word("before", false, "Before").doc("Before its effect."),
        word("after", true, "After").doc("After its effect."),
    ],
};

/// A site by its slug or by its place.
const SITE: WordOrObject =
    WordOrObject { name: "NamedOrGivenSite", doc: "Site by its slug, or by longitude and latitude." };

/// An output of a request.
pub(super) fn output(object: &mut Object) -> Option<FlightOutput> {
    object.named(
        "FlightOutput",
        "Output of a flight: a `quantity` at a moment or, with `site`, the end point relative to a site as two \
         numbers, metres east and north of it.",
    );
    object.alternatives(&[("quantity", &quantity), ("site", &at_site)])
}

/// A quantity at a moment.
pub(super) fn quantity(object: &mut Object) -> Option<FlightOutput> {
    let columns: Vec<_> = COLUMNS.iter().filter(|column| column.is_number()).collect();
    let names: Vec<_> = columns.iter().map(|column| column.name).collect();
    let column = object.field("quantity", "Quantity").doc("Column of the trajectory.").name(&names);
    let at = object
        .field("at", "Evaluated at")
        .doc("Moment at which the quantity is evaluated.")
        .default("end")
        .word_or(&AT, &MOMENTS, moment);
    Some(FlightOutput::Quantity { column: columns[column?], at: at? })
}

impl From<Moment> for At {
    fn from(moment: Moment) -> Self {
        Self::Moment(moment)
    }
}

fn moment(object: &mut Object) -> Option<At> {
    object.named("EventOrTime", "Event or time.");
    object.alternatives(&[("event", &at_event), ("time", &at_time)])
}

fn at_event(object: &mut Object) -> Option<At> {
    let event = object.field("event", "Event").doc("Name of an event.").text();
    let after = object
        .field("side", "Side")
        .doc("Side of the event: before or after its effect.")
        .default("before")
        .word(&SIDES);
    Some(At::Event { event: event?, after: after? })
}

fn at_time(object: &mut Object) -> Option<At> {
    let time = object.field("time", "Time").doc("Time since the start, s.").unit("s").number(Bound::TIME);
    Some(At::Moment(Moment::Time(time?)))
}

/// The place of the end relative to a site.
pub(super) fn at_site(object: &mut Object) -> Option<FlightOutput> {
    object
        .field("site", "Site")
        .doc("Site on the planet's surface: its slug in `GET /sites`, or its longitude and latitude.")
        .text_or(
            &SITE,
            ("SiteSlug", slug_schema),
            |slug| ListedSite::read(slug).map(|site| (site.place(), true)),
            |object| Some((site(object)?, false)),
        )
        .map(|(site, is_listed)| FlightOutput::Site { site, is_listed })
}

fn site(object: &mut Object) -> Option<Site> {
    object.named("Site", "Site on the planet's surface.");
    let longitude = object.field("longitude", "Longitude").doc("Longitude, east positive.").angle(Bound::TURN);
    let geodetic_latitude = object
        .field("geodetic_latitude", "Geodetic latitude")
        .doc("Angle of the surface normal above the equatorial plane, north positive.")
        .angle(Bound::QUARTER_TURN);
    Some(Site { longitude: longitude?, geodetic_latitude: geodetic_latitude? })
}

impl FlightOutput {
    /// What is wrong with an output of a request, given at a pointer, if anything.
    pub(super) fn fault(&self, pointer: &str, known: AvailableQuantities, events: &[Event]) -> Option<Fault> {
        let (column, at) = match self {
            Self::Quantity { column, at } => (column, at),
            Self::Site { is_listed: true, .. } if !known.is_on_earth => {
                let detail = "must be a longitude and a latitude on a planet other than the Earth, where the sites of GET /sites are";
                return Some(Fault::new(format!("{pointer}/site"), detail));
            }
            Self::Site { .. } => return None,
        };
        if let Some(missing) = column.missing(known) {
            return Some(Fault::new(format!("{pointer}/quantity"), format!("{} requires {missing}", column.name)));
        }
        let At::Event { event, .. } = at else { return None };
        let detail = match place_of(event, events) {
            Ok(_) => return None,
            Err(0) => "must be the name of an event of the case",
            Err(_) => "must be the name of exactly one event of the case, not of several",
        };
        Some(Fault::new(format!("{pointer}/at/event"), format!("{detail}, got {event:?}")))
    }

    /// Its numbers, in the unit of the request, which has these events.
    pub fn numbers(&self, unit: AngleUnit, events: &[Event], known: &Rc<AvailableWhereMoved>) -> Vec<OutputNumber> {
        match self {
            Self::Quantity { column, at } => {
                let at = match at {
                    At::Moment(moment) => *moment,
                    At::Event { event, after } => {
                        let event = place_of(event, events).unwrap_or_default();
                        Moment::Event { event, after: *after }
                    }
                };
                let (column, known) = (*column, Rc::clone(known));
                let turn = column.turns().then(|| unit.from_radians(TAU));
                let value = move |point: &FlightPoint, moved| column.number(point, unit, known.of(moved));
                vec![OutputNumber { name: column.name, at, turn, value: Box::new(value) }]
            }
            Self::Site { site, .. } => {
                let shape = known.flight.planet.shape;
                let number = |name, east_or_north: usize, site: Site| {
                    let value =
                        move |point: &FlightPoint, _| Some(site.offset_to(&ground_point(point), &shape)[east_or_north]);
                    OutputNumber { name, at: Moment::End, turn: None, value: Box::new(value) }
                };
                vec![number("east", 0, *site), number("north", 1, *site)]
            }
        }
    }
}

/// The place of the event of a name; or how many there are of the name.
pub(super) fn place_of(name: &str, events: &[Event]) -> Result<usize, usize> {
    let mut places = events.iter().enumerate().filter(|(_, event)| event.name.as_deref() == Some(name));
    match (places.next(), places.count()) {
        (Some((place, _)), 0) => Ok(place),
        (None, _) => Err(0),
        (Some(_), others) => Err(others + 1),
    }
}
