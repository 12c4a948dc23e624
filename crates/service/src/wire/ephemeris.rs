//! A flight as an Orbit Ephemeris Message (OEM, CCSDS 502.0-B-3) in the notation of keywords and values: states in an inertial frame, from
//! which orbit software interpolates others.
//!
//! The keywords and frames are those that versions 2.0 and 3.0 of the standard have in common. It is written as 2.0, which more readers know.

use std::io::{self, Write};

use reentry::body::Body;
use reentry::coordinates::{Inertial, TESTED_YEARS, about_pole, gcrf_to_planet_fixed};
use reentry::planet::Planet as CorePlanet;
use reentry::simulate::Flights;
use reentry::trajectory::{EventPoint, FlightPoint, PhaseStart, Trajectory};
use serde_json::json;

use super::columns::Columns;
use super::epoch::{Epoch, Utc};
use super::planet::{Planet, PlanetModel};
use super::reader::Fault;
use super::trajectory::{FlightOfAnswer, Models, SimulateResponse};

/// The body whose equator the frame MCI has; of other planets the standard names no frame.
const MARS: &str = "mars";

/// The inertial frame of a message, and how the planet is turned in it.
#[derive(Clone, Copy, Debug)]
pub struct MessageFrame {
    epoch: Epoch,
    planet: CorePlanet,
    center: Center,
}

/// What the frame moves with.
#[derive(Clone, Copy, Debug)]
enum Center {
    /// In GCRF.
    Earth,
    /// In MCI: the planet's pole, and the ascending node of its equator on that of the ICRF.
    Mars(&'static Body),
}

/// One body that flies: its states, cut where its motion or what moves it jumps.
#[derive(Clone, Debug)]
pub struct Ephemeris<'a> {
    models: &'a Models,
    /// That of the body or, of the vehicle, of the case.
    name: Option<&'a str>,
    told: FlightOfAnswer<'a>,
    frame: MessageFrame,
    segments: Vec<Segment<'a>>,
}

/// States between which a reader may interpolate.
#[derive(Clone, Debug)]
struct Segment<'a> {
    first: FlightPoint,
    /// After the first and before the last.
    between: &'a [FlightPoint],
    last: FlightPoint,
}

/// An instant at which the velocity or a force jumps.
struct Jump {
    before: FlightPoint,
    after: FlightPoint,
}

impl MessageFrame {
    /// The frame for flights on a planet.
    ///
    /// # Errors
    /// Without an epoch, outside the years for which the Earth's rotation is tested, and on planets for which the standard has no frame.
    pub fn of(planet: &Planet, epoch: Option<Epoch>) -> Result<Self, Vec<Fault>> {
        let center = match planet.model {
            _ if planet.is_earth() => Some(Center::Earth),
            PlanetModel::Body(body) if body.name == MARS => Some(Center::Mars(body)),
            _ => None,
        };
        let unnamed = || {
            let title = planet.title();
            let detail = format!("must be the Earth or Mars for OEM, which names no inertial frame of {title}");
            Fault::new("/planet/model", detail)
        };
        let undated = || Fault::new("/epoch", "is required for OEM, whose states have dates");
        match (center, epoch) {
            (Some(center), Some(epoch)) => {
                let frame = Self { epoch, planet: planet.core, center };
                if frame.is_known_in(epoch.year()) { Ok(frame) } else { Err(vec![unknown_rotation("start")]) }
            }
            (center, epoch) => {
                let unnamed = center.is_none().then(unnamed);
                Err(unnamed.into_iter().chain(epoch.is_none().then(undated)).collect())
            }
        }
    }

    /// Whether it is known how the planet is turned in a year.
    fn is_known_in(&self, year: i64) -> bool {
        match self.center {
            Center::Earth => TESTED_YEARS.contains(&year),
            Center::Mars(_) => true,
        }
    }

    /// The values of `CENTER_NAME` and `REF_FRAME`.
    fn names(&self) -> [&'static str; 2] {
        match self.center {
            Center::Earth => ["EARTH", "GCRF"],
            Center::Mars(_) => ["MARS", "MCI"],
        }
    }

    /// The state of a point by the frame, moved on to its date as it is written: half a microsecond is 4 mm in orbit, by which
    /// polynomials between rows that lie close together would sway.
    ///
    /// The planet turns on through a leap second that falls into the flight.
    fn state(&self, point: &FlightPoint) -> Inertial {
        let rounding = self.epoch.rounding(point.time);
        let mut state = point.flight_path.to_planet_fixed();
        state.position += state.velocity * rounding;
        let days = (point.time + rounding) / 86_400.0;
        let to_planet = match self.center {
            Center::Earth => gcrf_to_planet_fixed(self.epoch.days() + days),
            Center::Mars(body) => about_pole(body.rotation_angle(self.epoch.barycentric_days() + days)),
        };
        Inertial::from_planet_fixed_by(&state, &self.planet, &to_planet)
    }

    /// The date of a point.
    fn utc(&self, point: &FlightPoint) -> Option<Utc> {
        self.epoch.utc(point.time)
    }
}

fn unknown_rotation(what: &str) -> Fault {
    let [first, last] = [TESTED_YEARS.start(), TESTED_YEARS.end()];
    Fault::new("/epoch", format!("must let the flight {what} in the years {first} to {last} for OEM on the Earth"))
}

impl<'a> Ephemeris<'a> {
    /// The states of every flight of an answer that has rows: these, and those on both sides of every jump.
    ///
    /// # Errors
    /// When a flight goes on after the last year for which its frame is known, or that can be written.
    pub fn all(answer: &'a SimulateResponse, flights: &Flights, frame: MessageFrame) -> Result<Vec<Self>, Fault> {
        let of_flight = |(told, flight): (FlightOfAnswer<'a>, &Trajectory)| {
            let rows = told.report.trajectory.as_ref()?;
            let name = told.body.or(answer.name.as_deref());
            let segments = Self::segments(rows, flight, &frame);
            Some(segments.map(|segments| Self { models: &answer.models, name, told, frame, segments }))
        };
        answer.flights().zip(flights.all()).filter_map(of_flight).collect()
    }

    fn segments(rows: &'a Columns, flight: &Trajectory, frame: &MessageFrame) -> Result<Vec<Segment<'a>>, Fault> {
        let Some(end) = frame.epoch.utc(flight.end_time()) else {
            return Err(Fault::new("/epoch", "must let the flight end before the year 10000 for OEM"));
        };
        if !frame.is_known_in(end.year()) {
            return Err(unknown_rotation("end"));
        }
        let mut segments = Vec::new();
        let mut first = flight.initial();
        for Jump { before, after } in jumps(flight) {
            segments.push(Segment::new(&first, rows.points(), &before));
            first = after;
        }
        segments.push(Segment::new(&first, rows.points(), &flight.last()));
        // A jump at the start or at the end, or a flight of no duration, leaves a segment of one instant.
        let lasts = |segment: &Segment| frame.utc(&segment.first) < frame.utc(&segment.last);
        if segments.iter().any(lasts) {
            segments.retain(lasts);
        } else {
            segments.truncate(1);
        }
        Ok(segments)
    }

    fn write(&self, out: &mut impl Write) -> io::Result<()> {
        for (index, segment) in self.segments.iter().enumerate() {
            writeln!(out, "\nMETA_START")?;
            if index == 0 {
                self.comments().iter().try_for_each(|comment| writeln!(out, "COMMENT {comment}"))?;
            }
            segment.write(self.name().as_str(), &self.frame, out)?;
        }
        Ok(())
    }

    /// The name in what the message can hold: printable ASCII, and lines of 254 characters.
    fn name(&self) -> String {
        let printable = |character: char| match character {
            ' '..='~' => character,
            _ if character.is_whitespace() => ' ',
            _ => '?',
        };
        let given = self.name.unwrap_or_default();
        let name: String = given.chars().map(printable).take(LONGEST_NAME).collect();
        let name = name.trim();
        if name.is_empty() { UNKNOWN.to_owned() } else { name.to_owned() }
    }

    /// How it was flown, how it ended, and the codes of the warnings.
    fn comments(&self) -> Vec<String> {
        let (models, FlightOfAnswer { report, warnings, .. }) = (self.models, self.told);
        let mut comments = vec![
            format!("planet {}, atmosphere {}, gravity {}", models.planet, models.atmosphere, models.gravity),
            format!("end {}", json!(report.termination).as_str().unwrap_or_default()),
        ];
        if matches!(self.frame.center, Center::Earth) {
            comments.push("GCRF without polar motion, and with UT1 taken as UTC".to_owned());
        }
        for warning in warnings {
            let comment = format!("warning {}", warning.code);
            if !comments.contains(&comment) {
                comments.push(comment);
            }
        }
        comments
    }
}

/// Where a flight jumps, in order, with all that happens at one instant taken together.
fn jumps(flight: &Trajectory) -> Vec<Jump> {
    let of_event = |EventPoint { before, after, .. }| (before != after).then_some(Jump { before, after });
    let mut jumps: Vec<_> = flight.events().filter_map(of_event).collect();
    // Thrust ends without an event.
    for phase in flight.phases() {
        if let PhaseStart::Burnout(_) = phase.from {
            let here = flight.at(phase.since);
            jumps.push(Jump { before: here, after: here });
        }
    }
    jumps.sort_by(|one, other| one.before.time.total_cmp(&other.before.time));
    jumps.dedup_by(|later, first| {
        let is_same = later.before.time.total_cmp(&first.before.time).is_eq();
        if is_same {
            first.after = later.after;
        }
        is_same
    });
    jumps
}

impl<'a> Segment<'a> {
    fn new(first: &FlightPoint, rows: &'a [FlightPoint], last: &FlightPoint) -> Self {
        let begin = rows.partition_point(|row| row.time <= first.time);
        let end = rows.partition_point(|row| row.time < last.time);
        Self { first: *first, between: rows.get(begin..end).unwrap_or_default(), last: *last }
    }

    /// The points whose dates, to the microsecond, grow.
    fn points(&self, frame: &MessageFrame) -> impl Iterator<Item = (Utc, &FlightPoint)> {
        let dated = |point| Some((frame.utc(point)?, point));
        let first = dated(&self.first);
        let end = frame.utc(&self.last);
        let mut latest = frame.utc(&self.first);
        let between = self.between.iter().filter_map(dated).filter(move |(utc, _)| {
            let grows = Some(*utc) > latest && Some(*utc) < end;
            if grows {
                latest = Some(*utc);
            }
            grows
        });
        let last = dated(&self.last).filter(|_| end > frame.utc(&self.first));
        first.into_iter().chain(between).chain(last)
    }

    /// What stands after the comments: the rest of the metadata, and the states.
    fn write(&self, name: &str, frame: &MessageFrame, out: &mut impl Write) -> io::Result<()> {
        let [center, reference] = frame.names();
        writeln!(out, "OBJECT_NAME = {name}\nOBJECT_ID = {UNKNOWN}")?;
        writeln!(out, "CENTER_NAME = {center}\nREF_FRAME = {reference}\nTIME_SYSTEM = UTC")?;
        for (keyword, point) in [("START_TIME", &self.first), ("STOP_TIME", &self.last)] {
            if let Some(utc) = frame.utc(point) {
                writeln!(out, "{keyword} = {}", utc.without_zone())?;
            }
        }
        // One state alone has nothing between.
        if self.points(frame).nth(1).is_some() {
            writeln!(out, "INTERPOLATION = HERMITE\nINTERPOLATION_DEGREE = {CUBIC}")?;
        }
        writeln!(out, "META_STOP")?;
        for (utc, point) in self.points(frame) {
            let Inertial { position, velocity } = frame.state(point);
            write!(out, "{}", utc.without_zone())?;
            position.iter().try_for_each(|part| number(part / 1e3, 9, out))?;
            velocity.iter().try_for_each(|part| number(part / 1e3, 12, out))?;
            writeln!(out)?;
        }
        Ok(())
    }
}

/// The message of bodies, each with segments of its own.
///
/// # Errors
/// When it cannot be written.
pub fn write_oem(bodies: &[Ephemeris], created: Utc, out: &mut impl Write) -> Result<(), serde_json::Error> {
    let (version, created) = (env!("CARGO_PKG_VERSION"), created.without_zone());
    let source = format!("COMMENT simulated by reentry {version}");
    let header = writeln!(out, "CCSDS_OEM_VERS = 2.0\n{source}\nCREATION_DATE = {created}\nORIGINATOR = REENTRY");
    header.and_then(|()| bodies.iter().try_for_each(|body| body.write(out))).map_err(serde_json::Error::io)
}

/// A number after a blank, to so many decimals; of at most 16 digits, as the standard has it (7.5.6 and 7.5.7).
fn number(value: f64, decimals: usize, out: &mut impl Write) -> io::Result<()> {
    let digits = format!("{value:.decimals$}");
    if digits.trim_start_matches('-').len() <= MOST_DIGITS + 1 {
        write!(out, " {digits}")
    } else {
        write!(out, " {value:.*e}", MOST_DIGITS - 1)
    }
}

/// What the standard asks for where there is no value.
const UNKNOWN: &str = "UNKNOWN";
/// Characters of a name.
const LONGEST_NAME: usize = 200;
/// Digits of a number.
const MOST_DIGITS: usize = 16;
/// The degree of the polynomial between two states and their velocities. Higher ones are laid by more states, which stand close together
/// in short steps and far apart in long ones: there, and past a corner of a force, they sway by kilometres.
const CUBIC: usize = 3;
