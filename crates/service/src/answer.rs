//! From the tree of a request to the bytes of its answer: what the endpoints and the command line have in common.

mod corridor;
mod footprint;
mod search;
mod target;

pub use corridor::corridor;
pub use footprint::footprint;
pub use target::target;

use std::io::{self, ErrorKind, Write};
use std::iter;
use std::rc::Rc;
use std::time::{Instant, SystemTime};

use reentry::Interrupt;
use reentry::integrate::Statistics;
use reentry::sensitivity::{self, Output, Slopes, Variation, slopes};
use reentry::simulate::{BodyError, Flights, SimulationError, simulate as fly, simulate_with_bodies};
use reentry::trajectory::{FlightPoint, Trajectory};
use reentry::verification::verify;
use serde_json::Value;
use sysinfo::{MemoryRefreshKind, System};

use crate::error::ApiError;
use crate::format::Format;
use crate::metrics::Work;
use crate::wire::analytic::{AnalyticResponse, TheoryRequest};
use crate::wire::bodies::{FlownBodies, FlownBody};
use crate::wire::columns::COLUMNS;
use crate::wire::convert::ConvertResponse;
use crate::wire::dispersions::{Covariance, Dispersion};
use crate::wire::ephemeris::{Ephemeris, MessageFrame, write_oem};
use crate::wire::epoch::{Epoch, Utc};
use crate::wire::events::Event;
use crate::wire::numbers::Varied;
use crate::wire::outputs::{AvailableWhereMoved, OutputNumber};
use crate::wire::planet::Planet;
use crate::wire::reader::Fault;
use crate::wire::scenario::{FlightRequest, OutputOfBodies, RequestedOutput, SimulateRequest};
use crate::wire::sensitivities::{Matrix, Method, RequestedSensitivities, Sensitivities, SensitivitiesAnswer};
use crate::wire::track::Track;
use crate::wire::trajectory::{RequestedAnalyses, SimulateResponse};
use crate::wire::verification::Verification;

/// The bytes of an answer, and what it cost.
#[derive(Clone, Debug)]
pub struct Answer {
    /// In the format that was asked for.
    pub body: Vec<u8>,
    /// Of the flight; nothing where none was flown.
    pub work: Work,
}

/// Flies a case; `interrupt` ends it early, wherever it is.
///
/// # Errors
/// When the case is not sound, asks for more than `row_limit` rows, or cannot be flown to its end.
pub fn simulate(tree: Value, format: Format, row_limit: usize, interrupt: &dyn Interrupt) -> Result<Answer, ApiError> {
    let mut request = FlightRequest::try_from_tree(tree, requested_output(format)).map_err(ApiError::Invalid)?;
    let echo = request.echo.take();
    let (planet, epoch) = (request.request.planet, request.request.epoch);
    let faults = faults_of_format(format, &planet, epoch);
    if !faults.is_empty() {
        return Err(ApiError::Invalid(faults));
    }
    let FlightRequest { scenario, request: asked, .. } = &request;
    let start = Instant::now();
    let flights = if asked.output.bodies == OutputOfBodies::None {
        Flights::of_vehicle(fly(scenario, interrupt)?)
    } else {
        simulate_with_bodies(scenario, interrupt)?
    };
    let elapsed = start.elapsed().as_secs_f64();
    if !flights.all().all(|flight| flight.measure_ground_track(interrupt)) {
        return Err(ApiError::Interrupted);
    }
    let flown = FlownBodies::new(asked, &flights);
    let mut held = HeldMemory::new(flights.all(), interrupt);
    let rows = rows(asked, flown.all(), row_limit, &mut held)?;
    let work = work(flights.all(), &rows);
    let analyses = RequestedAnalyses { echo, ..analyses(&request, &flights.vehicle, &mut held)? };
    let response = SimulateResponse::new(asked, &flown, rows, analyses, elapsed);
    let track = || Track::new(&response, &flights, epoch).map_err(|fault| ApiError::Invalid(vec![fault]));
    let ephemerides = || {
        let frame = MessageFrame::of(&planet, epoch).map_err(ApiError::Invalid)?;
        Ephemeris::all(&response, &flights, frame).map_err(|fault| ApiError::Invalid(vec![fault]))
    };
    let mut out = Written::new(held);
    let written = match format {
        Format::Csv => response.write_csv(&mut out),
        Format::Geojson => track()?.write_geojson(&mut out),
        Format::Kml => track()?.write_kml(&mut out),
        Format::Czml => track()?.write_czml(&mut out),
        Format::Oem => write_oem(&ephemerides()?, Utc::of_clock(SystemTime::now()), &mut out),
        Format::Json | Format::Ndjson | Format::Text => serde_json::to_writer(&mut out, &response),
    };
    Ok(Answer { body: out.whole(written)?, work })
}

/// What flights cost, and their rows.
fn work<'a>(flights: impl Iterator<Item = &'a Trajectory>, rows: &[Option<Vec<FlightPoint>>]) -> Work {
    let mut work = Work { rows: rows.iter().flatten().map(|rows| rows.len() as u64).sum(), ..Work::default() };
    for flight in flights {
        let Statistics { steps, rejected_steps, evaluations } = flight.statistics();
        work.flights += 1;
        work.steps += steps as u64;
        work.rejected_steps += rejected_steps as u64;
        work.evaluations += evaluations as u64;
    }
    work
}

fn requested_output(format: Format) -> RequestedOutput {
    match format {
        Format::Json | Format::Ndjson | Format::Text => RequestedOutput::Answer,
        Format::Csv => RequestedOutput::Rows,
        Format::Geojson | Format::Kml | Format::Czml | Format::Oem => RequestedOutput::Map,
    }
}

/// Why the format cannot hold flights on the planet from the epoch on, or its viewers would place them on another globe.
fn faults_of_format(format: Format, planet: &Planet, epoch: Option<Epoch>) -> Vec<Fault> {
    match format {
        Format::Kml => Track::kml_fault(planet).into_iter().collect(),
        Format::Czml => Track::czml_fault(planet).into_iter().collect(),
        Format::Oem => MessageFrame::of(planet, epoch).err().unwrap_or_default(),
        Format::Json | Format::Ndjson | Format::Csv | Format::Geojson | Format::Text => Vec::new(),
    }
}

/// What a request asks for beyond the flight.
fn analyses(
    requested: &FlightRequest,
    flight: &Trajectory,
    held: &mut HeldMemory,
) -> Result<RequestedAnalyses, ApiError> {
    let interrupt = held.interrupt;
    let request = &requested.request;
    let mut analyses = RequestedAnalyses {
        sensitivities: sensitivities(requested, flight, held)?,
        covariance: covariance(requested, flight, held)?,
        ..RequestedAnalyses::default()
    };
    if request.verify {
        match verify(&requested.scenario, flight, interrupt) {
            Ok(core) => {
                let has_thrust = request.events.iter().any(Event::changes_thrust);
                analyses.verification = Some(Verification::from_core(core, has_thrust));
            }
            Err(error @ SimulationError::Interrupted { .. }) => return Err(error.into()),
            Err(error) => analyses.unverified = Some(error),
        }
    }
    Ok(analyses)
}

/// The derivatives for which a request asks.
fn sensitivities(
    requested: &FlightRequest,
    flight: &Trajectory,
    held: &mut HeldMemory,
) -> Result<Option<SensitivitiesAnswer>, ApiError> {
    let interrupt = held.interrupt;
    let request = &requested.request;
    let of = match &request.sensitivities {
        RequestedSensitivities::Nothing => return Ok(None),
        RequestedSensitivities::FinalState => {
            let core = sensitivity::sensitivities(flight, interrupt)?;
            let of_final_state = Sensitivities::from_core(&core, request.angle_unit);
            return Ok(Some(SensitivitiesAnswer::FinalState(Box::new(of_final_state))));
        }
        RequestedSensitivities::Matrix { of, .. } => of,
    };
    let Some(numbers) = &requested.numbers else { return Ok(None) };
    held.reserve(held.bytes + numbers.bytes())?;
    let numbers = request.sensitivities.variations(numbers, interrupt).map_err(ApiError::Invalid)?;
    if interrupt.is_raised() {
        return Err(ApiError::Interrupted);
    }
    let moved = numbers.iter().map(|number| number.varied.known.clone()).collect();
    let known = Rc::new(AvailableWhereMoved { flight: request.known(), moved });
    let outputs: Vec<_> =
        of.iter().flat_map(|output| output.numbers(request.angle_unit, &request.events, &known)).collect();
    let variations: Vec<_> = numbers.iter().map(|number| number.varied.variation.clone()).collect();
    let slopes = slopes_of(flight, &variations, &outputs, interrupt)?;
    let case = requested.scenario.case();
    let method = |variation: &Variation| {
        if variation.changes_models(case) { Method::Differences } else { Method::Exact }
    };
    let methods: Vec<_> = variations.iter().map(method).collect();
    Ok(Some(SensitivitiesAnswer::Matrix(Matrix::new(&outputs, numbers, slopes, &methods))))
}

/// The covariance for which a request asks.
fn covariance(
    requested: &FlightRequest,
    flight: &Trajectory,
    held: &mut HeldMemory,
) -> Result<Option<Covariance>, ApiError> {
    let interrupt = held.interrupt;
    let request = &requested.request;
    let Some(numbers) = requested.numbers.as_ref().filter(|_| !request.dispersions.is_empty()) else { return Ok(None) };
    held.reserve(held.bytes + numbers.bytes())?;
    let varied = Dispersion::variations(&request.dispersions, numbers, interrupt);
    let varied = varied.map_err(|fault| ApiError::Invalid(vec![fault]))?.into_iter();
    let (variations, moved): (Vec<_>, Vec<_>) = varied.map(|Varied { variation, known }| (variation, known)).unzip();
    if interrupt.is_raised() {
        return Err(ApiError::Interrupted);
    }
    let known = Rc::new(AvailableWhereMoved { flight: request.known(), moved });
    let outputs = Dispersion::outputs(request.known(), flight);
    let outputs: Vec<_> =
        outputs.iter().flat_map(|output| output.numbers(request.angle_unit, &request.events, &known)).collect();
    let slopes = slopes_of(flight, &variations, &outputs, interrupt)?;
    Ok(Some(Covariance::new(&request.dispersions, request.angle_unit, request.known(), &slopes)))
}

/// The slopes of outputs by numbers that vary.
fn slopes_of(
    flight: &Trajectory,
    variations: &[Variation],
    outputs: &[OutputNumber],
    interrupt: &dyn Interrupt,
) -> Result<Vec<Slopes>, SimulationError> {
    let outputs: Vec<_> = outputs
        .iter()
        .map(|OutputNumber { name, at, turn, value }| Output {
            at: *at,
            value: value.as_ref(),
            turn: *turn,
            takes_ground_distance: *name == "ground_distance",
        })
        .collect();
    slopes(flight, variations, &outputs, interrupt)
}

/// The rows for which a request asks, of each flight in order, the vehicle's first; the limit is that of all together.
fn rows<'a>(
    request: &SimulateRequest,
    flown: impl Iterator<Item = &'a FlownBody<'a>>,
    limit: usize,
    held: &mut HeldMemory,
) -> Result<Vec<Option<Vec<FlightPoint>>>, ApiError> {
    let output = &request.output;
    let mut count = 0;
    let mut wanted = Vec::new();
    for body in flown {
        let has_rows = body.path.is_empty() || output.bodies == OutputOfBodies::Full;
        let sampled = output.sampling.as_ref().filter(|_| has_rows).map(|(sampling, pointer)| {
            let instants = body.flight.instants(sampling, limit - count);
            instants.map_err(|_| ApiError::TooManyRows { limit, pointer })
        });
        let instants = sampled.transpose()?;
        count += instants.as_ref().map_or(0, Vec::len);
        wanted.push((body, instants));
    }
    let too_large = || ApiError::NoMemory { rows: count as u64 };
    let columns = output.columns.as_ref().map_or(COLUMNS.len(), Vec::len);
    let bytes = count * (size_of::<FlightPoint>() + columns * NUMBER);
    if count > ROWS_THAT_ALWAYS_FIT && available_memory().is_some_and(|available| available < bytes as u64) {
        return Err(too_large());
    }
    held.reserve_rows(count, bytes)?;
    let points_of = |body: &FlownBody, instants: Vec<f64>| {
        let mut points = Vec::new();
        points.try_reserve_exact(instants.len()).map_err(|_| too_large())?;
        for instants in instants.chunks(ROWS_BETWEEN_LOOKS) {
            if held.interrupt.is_raised() {
                return Err(ApiError::Interrupted);
            }
            points.extend(body.flight.points(instants));
        }
        let overflow = |point: &FlightPoint| {
            let error = SimulationError::Overflow { time: point.time };
            ApiError::from(BodyError { body: body.path.clone(), error })
        };
        points.iter().find(|point| !point.is_finite()).map(overflow).map_or(Ok(points), Err)
    };
    wanted.into_iter().map(|(body, instants)| instants.map(|instants| points_of(body, instants)).transpose()).collect()
}

/// Rows for which nobody asks the system whether it has the memory.
const ROWS_THAT_ALWAYS_FIT: usize = 100_000;

/// Bytes that are free, as far as the system tells: asking for more does not fail there, but has the program killed later on. Several
/// cases at once each see the same, so that this is no promise.
fn available_memory() -> Option<u64> {
    let mut system = System::new().ok()?;
    system.refresh_memory_specifics(MemoryRefreshKind::nothing().with_ram());
    // A container may have less than the machine.
    let allowed = system.cgroup_limits().map(|limits| limits.total_memory.saturating_sub(limits.rss));
    let free = Some(system.available_memory()).filter(|free| *free > 0);
    free.into_iter().chain(allowed).min()
}

/// Rows that are evaluated between two looks at the flag: about a millisecond.
const ROWS_BETWEEN_LOOKS: usize = 2048;

/// Writes a state in every coordinate system.
///
/// # Errors
/// When the state is not sound.
pub fn convert(tree: Value, interrupt: &dyn Interrupt) -> Result<Answer, ApiError> {
    let response = ConvertResponse::try_from_tree(tree).map_err(ApiError::Invalid)?;
    let mut out = Written::new(HeldMemory::nothing(interrupt));
    let written = serde_json::to_writer(&mut out, &response);
    Ok(Answer { body: out.whole(written)?, work: Work::default() })
}

/// Sets a theory beside a flight; `interrupt` ends it early, wherever it is.
///
/// # Errors
/// When the case is not sound, the theory does not apply, and as [`simulate`] otherwise.
pub fn analytic(tree: Value, format: Format, row_limit: usize, interrupt: &dyn Interrupt) -> Result<Answer, ApiError> {
    let analytic = TheoryRequest::try_from_tree(tree, requested_output(format)).map_err(ApiError::Invalid)?;
    let flight = fly(&analytic.flight.scenario, interrupt)?;
    let mut held = HeldMemory::new(iter::once(&flight), interrupt);
    let vehicle = FlownBody::vehicle(&analytic.flight.request, &flight);
    let rows = rows(&analytic.flight.request, iter::once(&vehicle), row_limit, &mut held)?;
    let work = work(iter::once(&flight), &rows);
    let points = rows.into_iter().flatten().next().unwrap_or_default();
    let analyses = analyses(&analytic.flight, &flight, &mut held)?;
    let comparison = analytic.theory.compare(&flight, &points, interrupt)?;
    let response = AnalyticResponse::new(analytic, &flight, &points, comparison, analyses);
    let mut out = Written::new(held);
    let written =
        if format == Format::Csv { response.write_csv(&mut out) } else { serde_json::to_writer(&mut out, &response) };
    Ok(Answer { body: out.whole(written)?, work })
}

/// What an answer holds in memory while it is made, beside its text.
struct HeldMemory<'a> {
    interrupt: &'a dyn Interrupt,
    /// The steps of the flights, and their rows.
    bytes: usize,
    /// What may be held, the text included.
    reserved: usize,
    /// Rows that it tells of.
    rows: usize,
}

/// What a number takes in the text, bytes; for a map as many are reserved, which hold its places and their text.
const NUMBER: usize = 20;

impl<'a> HeldMemory<'a> {
    fn nothing(interrupt: &'a dyn Interrupt) -> Self {
        Self { interrupt, bytes: 0, reserved: 0, rows: 0 }
    }

    fn new<'f>(flights: impl Iterator<Item = &'f Trajectory>, interrupt: &'a dyn Interrupt) -> Self {
        let bytes = flights.map(Trajectory::held).sum();
        Self { interrupt, bytes, reserved: bytes, rows: 0 }
    }

    /// Reserves what rows and their text take, so many bytes together.
    fn reserve_rows(&mut self, rows: usize, bytes: usize) -> Result<(), ApiError> {
        self.reserve(self.bytes + bytes)?;
        self.rows = rows;
        self.bytes += rows * size_of::<FlightPoint>();
        Ok(())
    }

    fn reserve(&mut self, bytes: usize) -> Result<(), ApiError> {
        if bytes > self.reserved {
            if !self.interrupt.may_hold(bytes) {
                return Err(ApiError::Interrupted);
            }
            self.reserved = bytes;
        }
        Ok(())
    }
}

/// Text that is being written until a flag is raised, or there is no memory for it.
struct Written<'a> {
    text: Vec<u8>,
    held: HeldMemory<'a>,
    /// The length at which the flag is looked at next.
    look: usize,
}

/// Bytes that are written between two looks at the flag: less than a millisecond.
const BYTES_BETWEEN_LOOKS: usize = 1 << 18;

impl<'a> Written<'a> {
    fn new(held: HeldMemory<'a>) -> Self {
        Self { text: Vec::new(), held, look: BYTES_BETWEEN_LOOKS }
    }

    /// The text, if it was written to its end: memory can always be written, so that only the flag ends it early, or the lack of more.
    fn whole(self, written: Result<(), serde_json::Error>) -> Result<Vec<u8>, ApiError> {
        written.map(|()| self.text).map_err(|error| match error.io_error_kind() {
            Some(ErrorKind::OutOfMemory) => ApiError::NoMemory { rows: self.held.rows as u64 },
            _ => ApiError::Interrupted,
        })
    }
}

impl Write for Written<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.write_all(bytes).map(|()| bytes.len())
    }

    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.text.try_reserve(bytes.len())?;
        self.text.extend_from_slice(bytes);
        if self.text.len() >= self.look {
            self.look = self.text.len() + BYTES_BETWEEN_LOOKS;
            if self.held.interrupt.is_raised() || self.held.reserve(self.held.bytes + self.look).is_err() {
                // Not `Interrupted`, after which writers try again.
                return Err(ErrorKind::Other.into());
            }
        }
        Ok(())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}
