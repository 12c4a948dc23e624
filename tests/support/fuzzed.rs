//! What must hold of any input: asked by the fuzz targets, of their corpus, and of random requests.

use std::fmt::Debug;
use std::sync::LazyLock;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use jsonschema::Validator;
use reentry::Interrupt;
use reentry::scenario::{Bound, Case, Scenario, Solver};
use reentry::simulate::{SimulationError, arrival};
use reentry_service::error::ApiError;
use reentry_service::format::Format;
use reentry_service::wire::analytic::TheoryRequest;
use reentry_service::wire::json::{elements, parse};
use reentry_service::wire::scenario::{FlightRequest, RequestedOutput};
use reentry_service::{answer, document};
use serde_json::{Value, json};

/// Rows that an answer may have here: few, since every one is looked at.
const ROW_LIMIT: usize = 64;
/// Steps of the flights that are looked at here; the long ones are left to the tests of the deadline.
const STEP_LIMIT: usize = 300;

/// Flights of a target and of a footprint here.
const MOST_FLIGHTS: f64 = 40.0;
/// Steps of all flights of a search that is looked at here.
const MOST_STEPS_OF_SEARCH: usize = 10_000;

/// Nobody raises it.
static NEVER: AtomicBool = AtomicBool::new(false);

/// Any text: the parser of requests gives the tree that `serde_json` gives, and refuses more only where a key is there twice.
///
/// # Panics
/// When that does not hold.
pub fn parser(text: &[u8]) {
    let shown = String::from_utf8_lossy(text);
    let theirs = serde_json::from_slice::<Value>(text);
    match (parse(text), &theirs) {
        // As text, which keeps the order, and the sign of a zero.
        (Ok(ours), Ok(theirs)) => assert_eq!(ours.to_string(), theirs.to_string(), "{shown:?}"),
        (Err(error), Ok(_)) => assert!(error.to_string().starts_with("duplicate key"), "{error} in {shown:?}"),
        (Ok(_), Err(error)) => panic!("serde_json has {error} in {shown:?}"),
        (Err(_), Err(_)) => {}
    }
    if let Ok(tree) = &theirs {
        // Written anew, no key is there twice any more.
        assert_eq!(good(parse(tree.to_string().as_bytes()), &shown), *tree, "{shown:?}");
    }
    match (elements(text), theirs) {
        (Ok(Some(texts)), Ok(Value::Array(trees))) => {
            let read: Vec<Value> = texts.iter().map(|text| good(serde_json::from_str(text.get()), &shown)).collect();
            assert_eq!(read, trees, "{shown:?}");
        }
        // Texts of elements are not looked into; an array around them is one more level of nesting.
        (Ok(Some(texts)), Err(error)) => assert!(
            error.to_string().starts_with("recursion limit")
                || texts.iter().any(|text| parse(text.get().as_bytes()).is_err()),
            "{error} in {shown:?}"
        ),
        (Ok(Some(_)), Ok(_)) | (Ok(None), Ok(Value::Array(_))) => panic!("{shown:?} is an array, or is it not?"),
        (Err(error), Ok(_)) => panic!("{error} in {shown:?}"),
        (Ok(None) | Err(_), _) => {}
    }
}

/// A request for a flight: the answer is good, or names what is wrong with the request. True where it is answered.
///
/// A letter before it asks for another format: `c`, `g`, `k`, `z` and `o` for CSV, `GeoJSON`, KML, CZML and OEM; `a` asks `/analytic`, and `b`
/// for CSV there.
///
/// # Panics
/// When the answer is neither.
pub fn simulate(input: &[u8]) -> bool {
    let (endpoint, format, text) = match input {
        [b'c', text @ ..] => (Endpoint::Simulate, Format::Csv, text),
        [b'g', text @ ..] => (Endpoint::Simulate, Format::Geojson, text),
        [b'k', text @ ..] => (Endpoint::Simulate, Format::Kml, text),
        [b'z', text @ ..] => (Endpoint::Simulate, Format::Czml, text),
        [b'o', text @ ..] => (Endpoint::Simulate, Format::Oem, text),
        [b'a', text @ ..] => (Endpoint::Analytic, Format::Json, text),
        [b'b', text @ ..] => (Endpoint::Analytic, Format::Csv, text),
        text => (Endpoint::Simulate, Format::Json, text),
    };
    let Ok(tree) = parse(text) else { return false };
    if endpoint.is_long(&tree) {
        return false;
    }
    let bytes = match endpoint.answer(tree.clone(), format) {
        Ok(bytes) => bytes,
        Err(error) => {
            refused(&error, &tree);
            return false;
        }
    };
    match format {
        Format::Json => {
            let answer = strict(&bytes, &tree);
            valid(endpoint.schema(), &answer, &tree);
            equally_long(&endpoint.rows(&answer), &tree);
            if let Some(case) = answer.get("case") {
                let again = strict(&good(endpoint.answer(case.clone(), format), &tree), &tree);
                let [again, answer] = [again, answer].map(without_computing_time).map(without_warnings_of_defaults);
                assert_eq!(again, answer, "{tree}");
            }
        }
        Format::Csv => is_table(&bytes, &tree),
        Format::Geojson | Format::Czml => drop(strict(&bytes, &tree)),
        Format::Kml | Format::Oem | Format::Ndjson | Format::Text => drop(good(String::from_utf8(bytes), &tree)),
    }
    true
}

/// Whether a warning is of what the request leaves out: the echo has the default in its place, and no such warning.
pub fn is_of_default(warning: &Value) -> bool {
    const GAS: &str = "Default density and scale height";
    ["angle_unit_assumed", "thesis_atmosphere"].iter().any(|code| warning["code"] == *code)
        || warning["detail"].as_str().is_some_and(|detail| detail.starts_with(GAS))
}

/// An answer without the warnings of what its request leaves out.
#[must_use]
pub fn without_warnings_of_defaults(mut answer: Value) -> Value {
    if let Some(warnings) = answer.get_mut("warnings").and_then(Value::as_array_mut) {
        warnings.retain(|warning| !is_of_default(warning));
    }
    answer
}

/// A request for a conversion: what it answers can be sent back, whichever of its states, and is then the same state. True where it is
/// answered.
///
/// # Panics
/// When that does not hold, or nothing of the request is named by a refusal.
pub fn convert(text: &[u8]) -> bool {
    let Ok(tree) = parse(text) else { return false };
    let bytes = match converted(tree.clone()) {
        Ok(bytes) => bytes,
        Err(error) => {
            refused(&error, &tree);
            return false;
        }
    };
    let answer = strict(&bytes, &tree);
    valid(&CONVERT, &answer, &tree);
    if let Some(case) = answer.get("case") {
        let again = strict(&good(converted(case.clone()), &tree), &tree);
        assert_eq!(again, without_warnings_of_defaults(answer.clone()), "{tree}");
    }
    for (kind, tolerance) in KINDS {
        let [place, motion] =
            ["position", "velocity"].map(|vector| (vector, tolerance * scale(kind, vector, &answer, &tree)));
        // Nearer to the centre, farther away and faster no state is accepted, and rounding may lead there.
        let (distance, speed) = (length(&answer["ecef"]["position"]), length(&answer["ecef"]["velocity"]));
        let near = distance < 1e-3 + place.1;
        let far = distance > Bound::RADIUS.maximum - place.1 || speed > Bound::SPEED.maximum - motion.1;
        if answer[kind].is_null() || near || far {
            continue;
        }
        let mut request = json!({"angle_unit": answer["angle_unit"], "state": answer[kind]});
        // The epoch turns some of the frames.
        for name in ["planet", "epoch"] {
            if let Some(value) = tree.get(name) {
                request[name] = value.clone();
            }
        }
        let back = strict(&good(converted(request.clone()), &request), &tree);
        for (vector, allowed) in [place, motion] {
            let [before, after] = [&answer, &back].map(|answer| numbers(&answer["ecef"][vector]));
            let off: Value = before.iter().zip(&after).map(|(before, after)| before - after).collect();
            assert!(length(&off) <= allowed, "{kind}: {vector} is off by {off}, {allowed} is allowed, in {tree}");
        }
    }
    true
}

/// A request for a target, of few flights: the answer is good, and its solutions are cases that can be sent to `/simulate`; or the request is
/// refused, and its faults are named. True where it is answered.
///
/// # Panics
/// When that does not hold.
pub fn target(text: &[u8]) -> bool {
    let Ok(tree) = parse(text) else { return false };
    let tree = of_few_flights(tree);
    let Some(answer) = searched(&TARGET, &tree, |tree, interrupt| answer::target(tree, None, interrupt)) else {
        return false;
    };
    let solutions = answer["solutions"].as_array().map_or(&[][..], Vec::as_slice);
    assert_eq!(answer["outcome"] == "reached", !solutions.is_empty(), "{tree}");
    for solution in solutions.iter().chain(Some(&answer["nearest"]).filter(|nearest| !nearest.is_null())) {
        let case = FlightRequest::try_from_tree(solution["case"].clone(), RequestedOutput::Answer);
        assert!(case.is_ok(), "{} is no case, of {tree}", solution["case"]);
    }
    true
}

/// A request for a corridor: the answer is good, and its bands and gaps cover the range in turn; or the request is refused, and its faults are
/// named. True where it is answered.
///
/// # Panics
/// When that does not hold.
pub fn corridor(text: &[u8]) -> bool {
    let Ok(tree) = parse(text) else { return false };
    let Some(answer) = searched(&CORRIDOR, &tree, answer::corridor) else { return false };
    let parts = ["bands", "gaps"].map(|parts| answer[parts].as_array().map_or(&[][..], Vec::as_slice));
    let mut parts = parts.concat();
    let end = |part: &Value, end: &str| part[end].as_f64().unwrap_or(f64::NAN);
    parts.sort_by(|one, other| end(one, "from").total_cmp(&end(other, "from")));
    let [least, greatest] = [0, 1].map(|index| tree["vary"]["between"][index].as_f64().unwrap_or(f64::NAN));
    // Beyond the end of a band lies the first value that was flown there.
    let ends: Vec<f64> = parts.iter().flat_map(|part| [end(part, "from"), end(part, "to")]).collect();
    assert!(ends.is_sorted() && ends.first() == Some(&least) && ends.last() == Some(&greatest), "{ends:?} of {tree}");
    assert_eq!(answer["bands"].as_array().is_some_and(Vec::is_empty), !answer["nearest"].is_null(), "{tree}");
    true
}

/// A request for a footprint, of few flights: the answer is good, its rings are closed and lie on the map, and its points lie within its extent; or
/// the request is refused, and its faults are named. True where it is answered.
///
/// # Panics
/// When that does not hold.
pub fn footprint(text: &[u8]) -> bool {
    let Ok(tree) = parse(text) else { return false };
    let tree = of_few_flights(tree);
    let Some(answer) = searched(&FOOTPRINT, &tree, drawn(Format::Json)) else { return false };
    let of = |list: &Value| list.as_array().cloned().unwrap_or_default();
    let polygons = of(&answer["boundary"]["coordinates"]);
    for ring in polygons.iter().flat_map(of) {
        let places: Vec<_> = of(&ring).iter().map(numbers).collect();
        assert!(places.len() > 3 && places.first() == places.last(), "{places:?} is no ring, of {tree}");
        let on_the_map = |place: &Vec<f64>| place[0].abs() <= 180.0 && place[1].abs() <= 90.0;
        assert!(places.iter().all(on_the_map), "{places:?} leave the map, of {tree}");
    }
    // A piece that the antimeridian cuts is more than one polygon.
    let [pieces, area, landed, kept] =
        ["pieces", "area", "landed", "within_limits"].map(|name| answer[name].as_f64().unwrap_or(f64::NAN));
    assert!(
        pieces <= count(polygons.len()) && (area > 0.0) == (pieces > 0.0),
        "{pieces} pieces of {area} m², of {tree}"
    );
    assert!(0.0 <= kept && kept <= landed && landed <= 1.0, "{kept} of {landed}, of {tree}");
    let points = &answer["points"];
    let columns = ["longitude", "geodetic_latitude", "downrange", "crossrange", "within_limits"];
    let lengths: Vec<_> =
        columns.iter().map(|name| &points[name]).chain(&of(&points["values"])).map(|column| of(column).len()).collect();
    assert!(lengths.windows(2).all(|pair| pair[0] == pair[1]), "{lengths:?} of {tree}");
    for name in ["downrange", "crossrange"] {
        let [least, greatest] = [0, 1].map(|end| answer["extent"][name][end]["value"].as_f64());
        let (least, greatest) = (least.unwrap_or(f64::NEG_INFINITY), greatest.unwrap_or(f64::INFINITY));
        for (place, within) in of(&points[name]).iter().zip(of(&points["within_limits"])) {
            let beyond = place.as_f64().is_some_and(|place| place < least || greatest < place);
            assert!(within != json!(true) || !beyond, "{name} {place} is beyond {least} and {greatest}, of {tree}");
        }
    }
    if let Ok(map) = drawn(Format::Geojson)(tree.clone(), &Steps::default()) {
        assert_eq!(strict(&map.body, &tree)["type"], "FeatureCollection", "{tree}");
    }
    true
}

fn drawn(format: Format) -> impl Fn(Value, &dyn Interrupt) -> Result<answer::Answer, ApiError> {
    move |tree, interrupt| answer::footprint(tree, format, None, interrupt)
}

/// A request for a search, of as few flights as are looked at here.
fn of_few_flights(mut tree: Value) -> Value {
    if let Some(members) = tree.as_object_mut()
        && let Some(search) = members.entry("search").or_insert_with(|| json!({})).as_object_mut()
        && search.get("flights").is_none_or(|flights| flights.as_f64().is_some_and(|count| count > MOST_FLIGHTS))
    {
        search.insert("flights".to_owned(), json!(MOST_FLIGHTS));
    }
    tree
}

fn count(length: usize) -> f64 {
    f64::from(u32::try_from(length).unwrap_or(u32::MAX))
}

/// The answer to a search, if it has one and that is good: the same again, of the request with its defaults.
fn searched(
    schema: &Validator,
    tree: &Value,
    answer: impl Fn(Value, &dyn Interrupt) -> Result<answer::Answer, ApiError>,
) -> Option<Value> {
    let answered = |tree: Value| answer(tree, &Steps::default());
    let shown = match answered(tree.clone()) {
        Ok(answer) => strict(&answer.body, tree),
        Err(error) => {
            // What takes many steps is left to the tests of the deadline.
            if !matches!(error, ApiError::Interrupted | ApiError::Flight(_)) {
                refused(&error, tree);
            }
            return None;
        }
    };
    valid(schema, &shown, tree);
    if let Some(case) = shown.get("case") {
        let again = strict(&good(answered(case.clone()), tree).body, tree);
        let [again, shown] = [again, shown.clone()].map(|mut answer| {
            answer["search"]["elapsed"] = Value::Null;
            without_warnings_of_defaults(answer)
        });
        assert_eq!(again, shown, "{tree}");
    }
    Some(shown)
}

/// Counts steps, and ends a search that takes many.
#[derive(Debug, Default)]
struct Steps(AtomicUsize);

impl Interrupt for Steps {
    fn is_raised(&self) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed) >= MOST_STEPS_OF_SEARCH
    }
}

fn converted(tree: Value) -> Result<Vec<u8>, ApiError> {
    answer::convert(tree, &NEVER).map(|answer| answer.body)
}

/// The kinds of state, and to which part of its size each gives it back.
const KINDS: [(&str, f64); 6] = [
    ("ecef", 1e-14),
    ("eci", 1e-9),
    ("planet_relative", 1e-9),
    ("geodetic", 1e-9),
    ("inertial_flight_path", 1e-9),
    ("orbital_elements", 1e-4),
];

/// The size of a vector, with which its rounding grows: of a place that of its altitude too, which is great at the planet's centre, and of
/// the velocity that of the rotating frame, there or where rounding may bring the place.
fn scale(kind: &str, vector: &str, answer: &Value, request: &Value) -> f64 {
    let size = length(&answer["ecef"][vector]);
    let rotation_rate = request["planet"]["rotation_rate"].as_f64().unwrap_or(7.3e-5);
    match vector {
        "position" => size.max(answer[kind]["geodetic_altitude"].as_f64().unwrap_or_default().abs()),
        _ => size + (rotation_rate * length(&answer["ecef"]["position"])).abs(),
    }
}

fn length(vector: &Value) -> f64 {
    numbers(vector).iter().map(|x| x * x).sum::<f64>().sqrt()
}

fn numbers(list: &Value) -> Vec<f64> {
    let numbers = list.as_array().and_then(|list| list.iter().map(Value::as_f64).collect());
    numbers.unwrap_or_else(|| panic!("{list} is no list of numbers"))
}

/// What flies.
#[derive(Clone, Copy)]
enum Endpoint {
    Simulate,
    Analytic,
}

impl Endpoint {
    fn answer(self, tree: Value, format: Format) -> Result<Vec<u8>, ApiError> {
        let answer = match self {
            Self::Simulate => answer::simulate(tree, format, ROW_LIMIT, &NEVER),
            Self::Analytic => answer::analytic(tree, format, ROW_LIMIT, &NEVER),
        };
        answer.map(|answer| answer.body)
    }

    /// Whether a request is sound, and its flight takes many steps.
    fn is_long(self, tree: &Value) -> bool {
        let job = match self {
            Self::Simulate => FlightRequest::try_from_tree(tree.clone(), RequestedOutput::Answer),
            Self::Analytic => {
                TheoryRequest::try_from_tree(tree.clone(), RequestedOutput::Answer).map(|theory| theory.flight)
            }
        };
        let Ok(job) = job else { return false };
        let case = job.scenario.case().clone();
        let solver = Solver { step_limit: STEP_LIMIT, ..case.solver };
        let short = Scenario::new(Case { solver, ..case }).map(|short| arrival(&short, &NEVER));
        matches!(short, Ok(Err(SimulationError::StepLimit { .. })))
    }

    /// The tables of an answer. That of a flight is there where it was asked for, those of a theory always.
    fn rows(self, answer: &Value) -> Vec<&Value> {
        match self {
            Self::Simulate => answer.get("trajectory").into_iter().collect(),
            Self::Analytic => ["simulated", "predicted", "differences"].map(|rows| &answer[rows]).into(),
        }
    }

    fn schema(self) -> &'static Validator {
        match self {
            Self::Simulate => &SIMULATE,
            Self::Analytic => &ANALYTIC,
        }
    }
}

static SIMULATE: LazyLock<Validator> = LazyLock::new(|| schema("SimulateResponse"));
static ANALYTIC: LazyLock<Validator> = LazyLock::new(|| schema("AnalyticResponse"));
static CONVERT: LazyLock<Validator> = LazyLock::new(|| schema("ConvertResponse"));
static TARGET: LazyLock<Validator> = LazyLock::new(|| schema("TargetResponse"));
static CORRIDOR: LazyLock<Validator> = LazyLock::new(|| schema("CorridorResponse"));
static FOOTPRINT: LazyLock<Validator> = LazyLock::new(|| schema("FootprintResponse"));
static PROBLEM: LazyLock<Validator> = LazyLock::new(|| schema("Problem"));

fn schema(name: &str) -> Validator {
    let root = json!({"$ref": format!("#/components/schemas/{name}"), "components": document()["components"]});
    good(jsonschema::draft202012::new(&root), name)
}

fn good<T, E: Debug>(result: Result<T, E>, what: impl std::fmt::Display) -> T {
    result.unwrap_or_else(|error| panic!("{error:?} of {what}"))
}

/// The tree of an answer, in which no key is there twice.
fn strict(answer: &[u8], request: &Value) -> Value {
    good(parse(answer), request)
}

fn valid(schema: &Validator, answer: &Value, request: &Value) {
    if let Err(fault) = schema.validate(answer) {
        panic!("{}: {fault} in the answer to {request}", fault.instance_path());
    }
}

/// All columns of all tables have as many entries, and times increase.
fn equally_long(tables: &[&Value], request: &Value) {
    let mut lengths = Vec::new();
    for table in tables {
        for (name, column) in table.as_object().unwrap_or_else(|| panic!("{table} is no table, for {request}")) {
            lengths.push(column.as_array().map(Vec::len));
            if name == "time" {
                let times = numbers(column);
                assert!(times.windows(2).all(|pair| pair[0] < pair[1]), "{times:?} for {request}");
            }
        }
    }
    assert!(lengths.windows(2).all(|pair| pair[0] == pair[1]), "{lengths:?} for {request}");
}

fn without_computing_time(mut answer: Value) -> Value {
    answer["solver"]["elapsed"] = Value::Null;
    answer
}

/// Every line has a cell for every name, a finite number or an instant; or nothing.
fn is_table(csv: &[u8], request: &Value) {
    let csv = good(std::str::from_utf8(csv), request);
    let mut lines = csv.lines().map(|line| line.split(','));
    let names: Vec<_> = lines.next().into_iter().flatten().collect();
    for line in lines {
        let cells: Vec<_> = line.collect();
        assert_eq!(cells.len(), names.len(), "{request}");
        for (name, cell) in names.iter().zip(cells) {
            let finite = cell.parse::<f64>().is_ok_and(f64::is_finite);
            assert!(finite || cell.is_empty() || *name == "utc", "{name} {cell} for {request}");
        }
    }
}

/// A refusal blames the request, and names places of it.
fn refused(error: &ApiError, request: &Value) {
    let problem = error.problem();
    assert!((400..500).contains(&problem.status), "{problem:?} for {request}");
    valid(&PROBLEM, &strict(&problem.to_json(), request), request);
    for field in &problem.errors {
        assert!(is_place(&field.pointer, request), "{:?} is no place of {request}", field.pointer);
    }
}

/// Whether a JSON pointer is one, and names a value, a member that is missing, or one of such a member, which has a default.
fn is_place(pointer: &str, tree: &Value) -> bool {
    if !pointer.is_empty() && !pointer.starts_with('/') {
        return false;
    }
    let mut place = Some(tree);
    let mut missing = 0;
    for token in pointer.split('/').skip(1) {
        let plain = token.replace("~0", "").replace("~1", "");
        if plain.contains('~') {
            return false;
        }
        let token = token.replace("~1", "/").replace("~0", "~");
        place = match place {
            None => None,
            Some(Value::Object(members)) => members.get(&token),
            Some(Value::Array(elements)) => match token.parse::<usize>().ok().and_then(|index| elements.get(index)) {
                None => return false,
                element => element,
            },
            Some(_) => return false,
        };
        missing += usize::from(place.is_none());
    }
    missing <= 2
}
