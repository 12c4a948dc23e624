//! What flies in a case: the vehicle, and the bodies that leave it, with what the request says of each.

use std::iter;

use reentry::simulate::{Flights, SeparatedBody};
use reentry::trajectory::{FlightPoint, Trajectory};

use super::columns::AvailableQuantities;
use super::events::{Event, Separation};
use super::scenario::SimulateRequest;
use super::shown::quoted;

/// All that flew in a case.
#[derive(Clone, Debug)]
pub struct FlownBodies<'a> {
    /// The vehicle.
    pub vehicle: FlownBody<'a>,
    /// What left it, or left what did, in the order of the separations.
    pub separated: Vec<FlownSeparation<'a>>,
}

/// The vehicle or a body, with its flight.
#[derive(Clone, Debug)]
pub struct FlownBody<'a> {
    /// What the request says of it.
    pub described: DescribedBody<'a>,
    /// The places of event and separation of a body, after those of the bodies from which it comes; empty for the vehicle.
    pub path: Vec<(usize, usize)>,
    /// Its flight.
    pub flight: &'a Trajectory,
    /// What there is to know at an instant of it.
    pub known: AvailableQuantities,
}

/// What a request says of the vehicle or of a body.
#[derive(Clone, Debug, Default)]
pub struct DescribedBody<'a> {
    /// The name of a body; none of the vehicle.
    pub name: Option<&'a str>,
    /// Its events.
    pub events: &'a [Event],
    /// The names of its parts.
    parts: Vec<&'a str>,
}

/// A separation that happened.
#[derive(Clone, Debug)]
pub struct FlownSeparation<'a> {
    /// What left.
    pub body: FlownBody<'a>,
    /// The name of the body that it left; none where it left the vehicle.
    pub parent: Option<&'a str>,
    /// The place of the event in the list of its parent.
    pub event: usize,
    /// The name of that event.
    pub event_name: Option<&'a str>,
    /// When, s.
    pub time: f64,
}

impl<'a> FlownBodies<'a> {
    /// All that flew by a request.
    pub fn new(request: &'a SimulateRequest, flights: &'a Flights) -> Self {
        let mut flown = Self { vehicle: FlownBody::vehicle(request, &flights.vehicle), separated: Vec::new() };
        for (place, body) in flights.bodies.iter().enumerate() {
            // Whoever leaves a body comes after it.
            let parent = body.parent.map_or(&flown.vehicle, |parent| &flown.separated[parent].body);
            let separation = parent.separated(body, flights.path(place));
            flown.separated.push(separation);
        }
        flown
    }

    /// All of them, the vehicle first.
    pub fn all(&self) -> impl Iterator<Item = &FlownBody<'a>> {
        iter::once(&self.vehicle).chain(self.separated.iter().map(|separation| &separation.body))
    }
}

impl<'a> FlownBody<'a> {
    /// The vehicle of a request.
    pub fn vehicle(request: &'a SimulateRequest, flight: &'a Trajectory) -> Self {
        let described = DescribedBody::vehicle(request);
        Self { described, path: Vec::new(), flight, known: request.known() }
    }

    /// What left this one.
    fn separated(&self, body: &'a SeparatedBody, path: Vec<(usize, usize)>) -> FlownSeparation<'a> {
        let SeparatedBody { event, separation, time, trajectory: flight, .. } = body;
        let described = self.described.separated(*event, *separation);
        // Without a nose there is no heat flux.
        let known = AvailableQuantities { heating: flight.peaks().heating.is_some(), ..self.known };
        FlownSeparation {
            body: Self { described, path, flight, known },
            parent: self.described.name,
            event: *event,
            event_name: self.described.events.get(*event).and_then(|event| event.name.as_deref()),
            time: *time,
        }
    }

    /// What is left of the propellant of the part of a name at a point of the flight, of all of its count together, kg: nothing is known of it
    /// once the part has left; none at all where there never was one of the name.
    pub fn propellant(&self, point: &FlightPoint, part: &str) -> Option<Option<f64>> {
        let place = self.described.parts.iter().position(|name| *name == part)?;
        Some(self.flight.propellant(point, place))
    }
}

impl<'a> DescribedBody<'a> {
    fn vehicle(request: &'a SimulateRequest) -> Self {
        let parts = request.parts.iter().map(|part| part.name.as_str()).collect();
        Self { name: None, events: &request.events, parts }
    }

    /// What leaves it by a separation of an event.
    fn separated(&self, event: usize, separation: usize) -> Self {
        let Separation { name, parts, events, .. } = &self.events[event].then.separated[separation];
        Self { name: Some(name), events, parts: parts.iter().map(String::as_str).collect() }
    }

    /// The event of a place, for people: of a body with its name.
    pub fn event(&self, place: usize) -> String {
        match self.events.get(place).and_then(|event| event.name.as_deref()) {
            Some(name) if self.name.is_some() => format!("event {place}, {},", quoted(name)),
            _ => format!("event {place}"),
        }
    }

    /// The part of a place, for people.
    pub fn part(&self, place: usize) -> String {
        self.parts.get(place).map_or_else(|| place.to_string(), |name| quoted(name))
    }
}
