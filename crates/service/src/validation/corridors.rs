//! Entry corridors beside published ones: their limits as AMAT finds them, and their depths as Chapman's theory has them.

use reentry::elementary::cos;
use reentry::event::{Condition, Direction, Quantity, Trigger};
use reentry::simulate::{SimulationError, ends};
use reentry::solve::corridor::{Asked, Sample, corridor};
use reentry::trajectory::Termination;
use reentry::{Case, FlightPath, Interrupt, Scenario};
use serde_json::Value;

use super::cases::{self, number, text, tree};
use super::flights::{elements, merge, of_file};
use super::{Check, Expected, Group, Origin, Program};
use crate::error::ApiError;
use crate::wire::scenario::{FlightRequest, RequestedOutput};

pub(super) fn checks(program: Program) -> Result<Vec<Check>, ApiError> {
    let mut checks = Vec::new();
    let amat = tree(cases::AMAT_PUBLISHED);
    for published in elements(&amat["corridors"]) {
        checks.extend(limits_of_amat(program, &amat, published)?);
    }
    let chapman = tree(cases::CHAPMAN);
    for published in elements(&chapman["corridors"]) {
        checks.push(depth(program, &chapman["defaults"], published)?);
    }
    checks.extend(of_file(program, Group::Corridors, &chapman)?);
    Ok(checks)
}

fn origin(published: &Value) -> Origin {
    let [case, source, note] = ["name", "source", "note"].map(|name| text(&published[name]));
    Origin { group: Group::Corridors, case, source, note }
}

/// The flight-path angles of both limits, in the standard air or in one of the file.
fn limits_of_amat(program: Program, file: &Value, published: &Value) -> Result<Vec<Check>, ApiError> {
    let ends = elements(&published["ends"]);
    let pass = |end: &Value| {
        let mut request = file["defaults"].clone();
        if let Some(air) = published["air"].as_str() {
            request["atmosphere"] = file["airs"][air].clone();
        }
        merge(&mut request, &published["request"]);
        merge(&mut request, &end["request"]);
        Pass::new(request)
    };
    let passes = ends.iter().map(pass).collect::<Option<Vec<_>>>().unwrap_or_default();
    let theirs: Vec<f64> = ends.iter().map(|end| number(end, "/flight_path_angle")).collect();
    let got = match (&passes[..], &theirs[..]) {
        ([over, under], [shallow, steep]) => {
            let apoapsis = over.case.planet.equatorial_radius() + number(published, "/apoapsis_altitude");
            Pass::limits(over, under, apoapsis, [steep - MARGIN, shallow + MARGIN], program.interrupt)?
        }
        _ => [f64::NAN; 2],
    };
    let origin = origin(published);
    let checks = ends.iter().zip(theirs).zip(got).map(|((end, theirs), got)| {
        let allowed = number(end, "/allowed");
        let expected = Expected::within(theirs, allowed).rounding(2.0 * RESOLUTION);
        origin.check(format!("{} limit", text(&end["end"])), "°", expected, got)
    });
    Ok(checks.collect())
}

/// To how much a limit is located, °.
const RESOLUTION: f64 = 1e-6;

/// A margin that is kept by far.
const KEPT: f64 = 1.0;

/// By how much further than the published limits is looked, °.
const MARGIN: f64 = 1.0;

/// A pass through the air, whose flight-path angle at the entry varies.
struct Pass {
    case: Case,
}

impl Pass {
    fn new(request: Value) -> Option<Self> {
        let request = FlightRequest::try_from_tree(request, RequestedOutput::Answer).ok()?;
        let mut case = request.scenario.case().clone();
        // At half the circular speed it is certain to land: the fall takes most of the steps, and nobody waits for it.
        let circular_speed = (case.planet.gravitational_parameter / case.planet.equatorial_radius()).sqrt();
        let value = 0.5 * circular_speed;
        let slow = Condition { quantity: Quantity::Speed, value, direction: Direction::Falling };
        case.stop.when.push(Trigger::Condition(slow));
        Some(Self { case })
    }

    /// The angles, °, with which flights leave for this apoapsis: the shallowest, of `over`, and the steepest, of `under`.
    fn limits(
        over: &Self,
        under: &Self,
        apoapsis: f64,
        between: [f64; 2],
        interrupt: &dyn Interrupt,
    ) -> Result<[f64; 2], ApiError> {
        let middle = 0.5 * (between[0] + between[1]);
        let judge = |value: f64| {
            // What lands is deep within the limit of the one, and far beyond that of the other.
            let relative = |pass: &Self| {
                let reciprocal = pass.reciprocal_apoapsis(value.to_radians(), interrupt)?;
                Ok::<_, ApiError>(reciprocal.map_or(-3.0, |reciprocal| apoapsis * reciprocal))
            };
            let [of_over, of_under] = [|relative: f64| -1.0 - relative, |relative: f64| relative + 1.0];
            // `under` leaves higher than `over`: where one misses its limit the other keeps its own, and is not flown.
            let margins = if value < middle {
                let steep = of_under(relative(under)?);
                [if steep < 0.0 { KEPT } else { of_over(relative(over)?) }, steep]
            } else {
                let shallow = of_over(relative(over)?);
                [shallow, if shallow < 0.0 { KEPT } else { of_under(relative(under)?) }]
            };
            let margins = margins.map(Some).to_vec();
            Ok::<_, ApiError>(Sample { value, numbers: vec![None; 2], margins, ends: Vec::new() })
        };
        let judge_all = |values: &[f64], _: Asked| values.iter().map(|value| judge(*value)).collect::<Result<_, _>>();
        let found = corridor(between, RESOLUTION, judge_all)?;
        Ok(match found.bands[..] {
            [band] if (band.from.limit, band.to.limit) == (Some(1), Some(0)) => [band.to.value, band.from.value],
            _ => [f64::NAN; 2],
        })
    }

    /// -1/r of the apoapsis for which the flight leaves, by the speed relative to the planet, which AMAT takes for the inertial one; none where it
    /// does not leave.
    fn reciprocal_apoapsis(&self, flight_path_angle: f64, interrupt: &dyn Interrupt) -> Result<Option<f64>, ApiError> {
        let path = FlightPath { flight_path_angle, ..FlightPath::from_planet_fixed(&self.case.initial_state) };
        let case = Case { initial_state: path.to_planet_fixed(), ..self.case.clone() };
        let Ok(scenario) = Scenario::new(case) else { return Ok(None) };
        let flight = match ends(&scenario, interrupt) {
            Ok(flight) if flight.termination() == Termination::Condition(0) => flight,
            Err(error @ SimulationError::Interrupted { .. }) => return Err(error.into()),
            _ => return Ok(None),
        };
        let parameter = self.case.planet.gravitational_parameter;
        let FlightPath { radius, speed, flight_path_angle, .. } = flight.last().flight_path;
        // ε = V²/2 - μ/r, h = r V cos γ, e = √(1 + 2 ε h²/μ²), r_a = a (1 + e) with a = -μ/2ε.
        let energy = 0.5 * speed * speed - parameter / radius;
        let momentum = radius * speed * cos(flight_path_angle);
        let eccentricity = (1.0 + 2.0 * energy * (momentum / parameter).powi(2)).sqrt();
        Ok(Some(2.0 * energy / (parameter * (1.0 + eccentricity))))
    }
}

/// The depth of a corridor: by how much the periapsides of its ends differ, which on a parabola is half of what their semi-latera recta do.
fn depth(program: Program, defaults: &Value, published: &Value) -> Result<Check, ApiError> {
    let mut request = defaults.clone();
    merge(&mut request, &published["request"]);
    let answer = program.corridor(request)?;
    let [from, to] = ["/bands/0/from", "/bands/0/to"].map(|end| number(&answer, end));
    let value = number(published, "/depth");
    let expected = Expected { value, allowed: None, rounding: 0.0 };
    Ok(origin(published).beside(text(&published["quantity"]), "m", expected, 0.5 * (to - from)))
}
