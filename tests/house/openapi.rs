//! The OpenAPI document: committed as the service gives it, and exactly as strict as the service is.
#![allow(clippy::unwrap_used, reason = "a test stops where it meets what it does not expect, its helpers included")]

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use axum::http::StatusCode;
use jsonschema::Validator;
use reentry_service::document;
use reentry_tests::cases::thesis_cases;
use reentry_tests::fuzzed::without_warnings_of_defaults;
use reentry_tests::service::Service;
use serde_json::{Value, json};

use crate::http::fields::{Kind, Need, fields};
use crate::http::requests::{
    ALTERNATIVES, KINDS, condition, conversion, corridor, event, flight, goals, limits, model, models, target, with,
    with_all, without,
};

/// A validator of one of the document's schemas; OpenAPI 3.1 speaks JSON Schema 2020-12.
fn schema(name: &str) -> Validator {
    let root = json!({"$ref": format!("#/components/schemas/{name}"), "components": document()["components"]});
    jsonschema::draft202012::options().should_validate_formats(true).build(&root).unwrap()
}

/// Fails unless the value is valid.
fn is_valid(schema: &Validator, value: &Value, what: &str) {
    let faults: Vec<_> = schema.iter_errors(value).map(|fault| format!("{}: {fault}", fault.instance_path())).collect();
    assert!(faults.is_empty(), "{what} is not valid: {}", faults.join("; "));
}

/// The requests of an endpoint that the project shows: the document's examples and the cases of the thesis.
fn shown(path: &str) -> Vec<(String, Value)> {
    let document = document();
    let examples = document["paths"][path]["post"]["requestBody"]["content"]["application/json"]["examples"].clone();
    let examples = examples.as_object().unwrap().iter().map(|(name, example)| (name.clone(), example["value"].clone()));
    let thesis = thesis_cases().into_iter().map(|case| (format!("{} of {}", case.name, case.model), case.request));
    if path == "/simulate" { examples.chain(thesis).collect() } else { examples.collect() }
}

/// The same, and requests with every field.
fn good_requests(path: &str) -> Vec<(String, Value)> {
    let every_field = |kind: &str| match path {
        "/simulate" => flight(kind),
        "/analytic" => with(&flight(kind), "/solution", "loh"),
        _ => conversion(kind),
    };
    let complete = KINDS.map(|kind| (format!("a complete {kind}"), every_field(kind)));
    let models = models().into_iter().map(|(name, request)| (name.to_owned(), request));
    let models = models.filter(|_| path == "/simulate");
    shown(path).into_iter().chain(complete).chain(models).collect()
}

const ENDPOINTS: [(&str, &str, &str); 3] = [
    ("/simulate", "SimulateRequest", "SimulateResponse"),
    ("/analytic", "AnalyticRequest", "AnalyticResponse"),
    ("/convert", "ConvertRequest", "ConvertResponse"),
];

/// Those that fly a case many times, and take the time for it.
const SEARCHES: [(&str, &str, &str); 3] = [
    ("/target", "TargetRequest", "TargetResponse"),
    ("/corridor", "CorridorRequest", "CorridorResponse"),
    ("/footprint", "FootprintRequest", "FootprintResponse"),
];

#[test]
fn the_committed_document_is_that_of_the_service() {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../openapi/openapi.json");
    let committed = fs::read_to_string(file).unwrap();
    assert!(committed == format!("{:#}\n", document()), "openapi/openapi.json is out of date: run `make openapi`");
}

/// Forms are made of the document: a field has a label, and a number its unit.
#[test]
fn every_field_of_a_request_has_a_label_and_every_angle_says_so() {
    let document = document();
    let schemas = document["components"]["schemas"].as_object().unwrap();
    let mut open: Vec<_> = ENDPOINTS.iter().chain(&SEARCHES).map(|(_, request, _)| (*request).to_owned()).collect();
    let mut seen = BTreeSet::new();
    let mut angles = BTreeSet::new();
    let mut count = 0;
    while let Some(name) = open.pop() {
        if !seen.insert(name.clone()) {
            continue;
        }
        let schema = &schemas[&name];
        // Generators of clients would name the type by it.
        assert!(schema["title"].is_null(), "{name} has a title");
        for (field, property) in schema["properties"].as_object().into_iter().flatten() {
            for text in ["title", "description"] {
                assert!(property[text].as_str().is_some_and(|text| !text.is_empty()), "{name}.{field} has no {text}");
            }
            if property["x-unit"] == "angle" {
                angles.insert(field.clone());
            }
            count += 1;
        }
        let text = schema.to_string();
        let named = text.split("\"#/components/schemas/").skip(1);
        open.extend(named.filter_map(|rest| rest.split('"').next()).map(str::to_owned));
    }
    assert!(count > 130, "only {count} fields");
    for field in fields() {
        let name = field.pointer.rsplit('/').next().unwrap();
        match field.kind {
            // Their unit is that of the quantity.
            _ if ["falls_through", "rises_through", "value"].contains(&name) => {}
            Kind::Angle(_) | Kind::Command(_) => assert!(angles.contains(name), "{} is no angle", field.pointer),
            Kind::Number(_) => assert!(!angles.contains(name), "{} is an angle", field.pointer),
            _ => {}
        }
    }
}

#[test]
fn good_requests_and_every_example_file_are_valid() {
    for (path, request, _) in ENDPOINTS {
        let schema = schema(request);
        for (name, request) in good_requests(path) {
            is_valid(&schema, &request, &name);
        }
    }
    for (path, request, _) in SEARCHES {
        for (name, request_of) in shown(path) {
            is_valid(&schema(request), &request_of, &name);
        }
    }
    let count = fs::read_dir(Path::new(env!("CARGO_MANIFEST_DIR")).join("../openapi/examples")).unwrap().count();
    let shown: usize = ENDPOINTS.iter().chain(&SEARCHES).map(|(path, ..)| shown(path).len()).sum();
    assert_eq!(shown, count + 21, "an example is not in the document");
}

#[test]
fn every_way_of_output_and_every_optional_field_left_out_is_valid() {
    for (path, request, _) in ENDPOINTS.iter().chain(&SEARCHES) {
        let schema = schema(request);
        for field in fields().iter().filter(|field| field.path == *path) {
            is_valid(&schema, &field.request, &field.pointer);
            if field.need == Need::Optional {
                is_valid(&schema, &without(&field.request, &field.pointer), &format!("without {}", field.pointer));
            }
        }
    }
}

/// Sorts what the schema accepts and the service refuses, or the other way round.
struct Agreement {
    service: Service,
    schemas: Vec<(&'static str, Validator)>,
    count: usize,
    differences: BTreeSet<String>,
}

impl Agreement {
    fn new() -> Self {
        let schemas = ENDPOINTS.iter().chain(&SEARCHES).map(|(path, request, _)| (*path, schema(request)));
        Self { service: Service::new(), schemas: schemas.collect(), count: 0, differences: BTreeSet::new() }
    }

    /// Both refuse the request.
    async fn refused(&mut self, path: &str, request: &Value, what: &str) {
        let status = self.service.post(path, request).await.status;
        if status != StatusCode::UNPROCESSABLE_ENTITY {
            self.differences.insert(format!("the service answers {path} {what} with {status}"));
        }
        if self.accepts(path, request) {
            self.differences.insert(format!("the schema accepts {path} {what}"));
        }
        self.count += 1;
    }

    /// Both refuse the request, or both accept it.
    async fn agree(&mut self, path: &str, request: &Value, what: &str) {
        let accepted = self.service.post(path, request).await.status == StatusCode::OK;
        if accepted != self.accepts(path, request) {
            self.differences.insert(format!("{path} {what}: accepted by the service: {accepted}"));
        }
        self.count += 1;
    }

    /// Both refuse the request, or both accept it, but for what the service refuses because of names that refer to each other, and what only
    /// the one that has a name has: a schema does not see that.
    async fn agree_but_for_names(&mut self, path: &str, request: &Value, what: &str) {
        const OF_NAMES: [&str; 9] = [
            "must be the name of",
            "must be unique",
            "is required: part",
            "is required for a body of several parts",
            "requires vehicle.parts",
            "must leave a part",
            "must be omitted: the parts of the vehicle",
            "requires the pressure of the air",
            // No number of the case.
            "must point to",
        ];
        let answer = self.service.post(path, request).await;
        let errors = answer.json()["errors"].as_array().cloned().unwrap_or_default();
        let of_names = |error: &Value| OF_NAMES.iter().any(|start| error["detail"].as_str().unwrap().contains(start));
        if !errors.is_empty() && errors.iter().all(of_names) {
            self.count += 1;
            return;
        }
        self.agree(path, request, what).await;
    }

    fn accepts(&self, path: &str, request: &Value) -> bool {
        self.schemas.iter().any(|(of, schema)| *of == path && schema.is_valid(request))
    }

    /// Fails if they differ, or have seen fewer requests than this.
    fn holds(self, least: usize) {
        let differences: Vec<_> = self.differences.into_iter().collect();
        assert!(differences.is_empty(), "{} differences:\n{}", differences.len(), differences.join("\n"));
        assert!(self.count >= least, "only {} requests", self.count);
    }
}

#[tokio::test]
async fn schema_and_service_refuse_the_same_fields() {
    let mut agreement = Agreement::new();
    for field in fields() {
        let (path, pointer) = (field.path, field.pointer.as_str());
        if field.need != Need::Optional {
            agreement.refused(path, &without(&field.request, pointer), &format!("without {pointer}")).await;
        }
        for value in field.kind.mistyped() {
            let what = format!("with {value} at {pointer}");
            agreement.refused(path, &with(&field.request, pointer, value), &what).await;
        }
        let misspelt = format!("{pointer}s");
        agreement.refused(path, &with(&field.request, &misspelt, 1), &format!("with {misspelt}")).await;
    }
    agreement.holds(900);
}

#[tokio::test]
#[expect(clippy::too_many_lines, reason = "a list")]
async fn schema_and_service_refuse_the_same_numbers() {
    let mut agreement = Agreement::new();
    let gas = |of: Value| {
        let mut table = json!({"type": "table", "altitude": [0, 1], "density": [1, 1], "temperature": [200, 200]});
        table.as_object_mut().unwrap().extend(of.as_object().unwrap().clone());
        table
    };
    for mut field in fields() {
        let range = match field.kind {
            Kind::Number(range) | Kind::NumberOrNumbers(range) => range,
            Kind::Angle(range) | Kind::Command(range) => {
                // A schema has one bound for both units, the wider.
                field.request = with(&field.request, "/angle_unit", "deg");
                range.in_degrees()
            }
            _ => continue,
        };
        for value in range.beyond() {
            let what = format!("with {value:e} at {}", field.pointer);
            agreement.refused(field.path, &with(&field.request, &field.pointer, value), &what).await;
        }
    }
    for (output, what) in [
        (json!({"samples_per_step": 0}), "no sample"),
        (json!({"samples_per_step": 1.5}), "samples and a half"),
        (json!({"count": 1}), "one row"),
        (json!({"count": 2.5}), "rows and a half"),
        (json!({"times": [-1]}), "a negative time"),
        (json!({"times": [1, "2"]}), "a time that is no number"),
        (json!({"trajectory": true}), "a trajectory that is true"),
        (json!({"trajectory": false, "columns": ["time"]}), "columns of no trajectory"),
        (json!({"count": 2, "columns": []}), "no columns"),
        (json!({"count": 2, "bodies": "some"}), "an unknown output of bodies"),
        (json!({"count": 2, "interval": 1, "bodies": "none"}), "bodies and two ways of output"),
        (json!({"count": 2, "columns": ["time", "time"]}), "a column twice"),
        (json!({"count": 2, "columns": ["times"]}), "an unknown column"),
        (json!({"count": 2, "interval": 1, "columns": ["time"]}), "columns and two ways of output"),
        (json!({}), "no way of output"),
        (json!({"count": 2, "interval": 1}), "two ways of output"),
    ] {
        agreement.refused("/simulate", &with(&flight("ecef"), "/output", output), what).await;
    }
    for (pointer, value) in [
        ("/planet/gravity/degree", json!(1)),
        ("/planet/gravity/degree", json!(3)),
        ("/planet/gravity/degree", json!(5)),
        ("/planet/gravity/degree", json!(2.5)),
        ("/planet/gravity/j3", json!(0)),
        ("/planet/gravity/j4", json!(0)),
        ("/planet/gravity/type", json!("inverse_square")),
        ("/atmosphere", json!({"type": "us76", "surface_density": 1})),
        ("/atmosphere", json!({"type": "vacuum", "surface_density": 0})),
        ("/atmosphere", json!({"type": "layered_exponential"})),
        ("/atmosphere", json!({"type": "layered_exponential", "layers": []})),
        ("/atmosphere", json!({"type": "table", "altitude": [0], "density": [1]})),
        ("/atmosphere", json!({"type": "table", "altitude": [0, 1e13], "density": [1, 1]})),
        ("/atmosphere", json!({"type": "table", "altitude": [0, 1], "density": [1, 0]})),
        ("/atmosphere", json!({"type": "table", "altitude": [0, 1], "density": [1, 1], "temperature": [0, 1]})),
        ("/atmosphere", json!({"type": "table", "altitude": [0, 1], "density": [1, 1], "pressure": [1, -1]})),
        ("/atmosphere", json!({"type": "table", "altitude": [0, 1], "density": [1, 1], "speed_of_sound": [0, 1]})),
        ("/atmosphere", gas(json!({"molar_mass": 0.04}))),
        ("/atmosphere", gas(json!({"heat_capacity_ratio": 1.3}))),
        ("/atmosphere", gas(json!({"molar_mass": 0.04, "heat_capacity_ratio": [1.3]}))),
        ("/atmosphere", gas(json!({"molar_mass": [0.04, 44], "heat_capacity_ratio": 1.3}))),
        ("/atmosphere", gas(json!({"molar_mass": 0.04, "heat_capacity_ratio": [1.3, 0.9]}))),
        ("/atmosphere", gas(json!({"molar_mass": 0.04, "heat_capacity_ratio": 1.3, "speed_of_sound": [300, 300]}))),
        (
            "/atmosphere",
            json!({"type": "table", "altitude": [0, 1], "density": [1, 1], "molar_mass": 0.04, "heat_capacity_ratio": 1.3}),
        ),
        ("/wind", json!({"type": "constant", "east": 1, "from": 1})),
        ("/wind", json!({"type": "constant", "speed": 1, "from": 361})),
        ("/wind", json!({"type": "constant", "speed": -1, "from": 1})),
        ("/wind", json!({"type": "constant", "east": 1, "north": 1, "speed": 1, "from": 1})),
        ("/wind", json!({"type": "constant", "east": 1, "north": 1, "from": 1})),
        ("/wind", json!({"type": "constant"})),
        ("/wind", json!({"type": "table", "altitude": [0], "speed": [1e5], "from": [0]})),
        ("/wind", json!({"type": "table", "altitude": [0], "speed": [1], "from": [361]})),
        ("/wind", json!({"type": "table", "altitude": [0], "speed": [1], "north": [0]})),
        ("/wind", json!({"type": "table", "altitude": [], "east": [], "north": []})),
        ("/wind", json!({"type": "table", "altitude": [0], "east": [1e5], "north": [0]})),
        ("/vehicle/aerodynamics", json!({"type": "ballistic", "ballistic_coefficient": 100})),
        ("/control/bank_angle", json!({"type": "schedule", "against": "time", "at": [], "value": []})),
        ("/control/bank_angle", json!({"type": "schedule", "against": "time", "at": [-1], "value": [0]})),
        ("/control/bank_angle", json!({"type": "schedule", "against": "altitude", "at": [1e13], "value": [0]})),
        ("/control/bank_angle", json!({"type": "schedule", "against": "time", "at": [0], "value": [361]})),
        ("/control/bank_angle", json!({"type": "schedule", "against": "height", "at": [0], "value": [0]})),
    ] {
        let request = with(&flight("ecef"), pointer, value.clone());
        agreement.refused("/simulate", &request, &format!("{value} at {pointer}")).await;
    }
    for (name, value) in [
        ("mach", json!([-1, 1, 5])),
        ("drag_coefficient", json!([[0.3, 0.8, 0.6], [0.5, -1, 0.9]])),
        ("lift_coefficient", json!([[0.3, 0.8, 0.6], []])),
        ("lift_coefficient", json!([[0.3, 0.8, 0.6], 1])),
        ("lift_coefficient", json!([])),
        ("angle_of_attack", json!([0, 361])),
    ] {
        let request = with(&model("alpha_mach_table"), &format!("/vehicle/aerodynamics/{name}"), value.clone());
        agreement.refused("/simulate", &request, &format!("{value} as {name}")).await;
    }
    for (name, value) in [
        ("position", json!([1e13, 0, 0])),
        ("position", json!([7e6, 0])),
        ("velocity", json!([1, 2, 3, 4])),
        ("velocity", json!([1, 2, null])),
    ] {
        for kind in ["ecef", "eci"] {
            let request = with(&conversion(kind), &format!("/state/{name}"), value.clone());
            agreement.refused("/convert", &request, &format!("{kind} with {value} as {name}")).await;
        }
    }
    // The bound on the speed is relative to the planet: a schema sees it of planet-fixed vectors alone.
    let fast = with(&conversion("ecef"), "/state/velocity", json!([1e6_f64.next_up(), 0, 0]));
    agreement.refused("/convert", &fast, "a component of the velocity out of its range").await;
    agreement.holds(100);
}

#[tokio::test]
async fn schema_and_service_refuse_the_same_events_and_heating() {
    let mut agreement = Agreement::new();
    let event = |then: Value| json!([event("time", "rises_through", 1.0, &then)]);
    let ballistic = json!({"type": "ballistic", "ballistic_coefficient": 100});
    let condition = condition("time", "rises_through", 1.0);
    for (pointer, value) in [
        ("/events", json!(vec![event(json!({}))[0].clone(); 1001])),
        ("/events", event(json!({"reference_area": 1, "aerodynamics": ballistic}))),
        ("/events", event(json!({"thrust": "on"}))),
        ("/events", json!([condition])),
        ("/stop/when", json!(vec![condition; 1001])),
        ("/stop/when", json!([{"quantity": "time", "falls_through": 1}])),
        ("/stop/when", json!([{"quantity": "speed", "rises_through": 1, "falls_through": 1}])),
        ("/stop/when", json!([{"quantity": "speed"}])),
        ("/stop/when", json!([1])),
    ] {
        let request = with(&flight("ecef"), pointer, value.clone());
        agreement.refused("/simulate", &request, &format!("{value} at {pointer}")).await;
    }
    let without_a_nose = without(&model("heating"), "/vehicle/nose_radius");
    agreement.refused("/simulate", &without_a_nose, "heating without a nose").await;
    let theory = with(&flight("ecef"), "/solution", "loh");
    let eventful = [("/heating", json!({})), ("/events", event(json!({})))];
    for (pointer, value) in eventful {
        agreement.refused("/analytic", &with(&theory, pointer, value), &format!("a theory with {pointer}")).await;
    }
    agreement.agree("/analytic", &with(&theory, "/events", json!([])), "a theory without events").await;
    agreement.holds(13);
}

#[tokio::test]
async fn schema_and_service_ask_the_same_of_the_case_of_a_theory() {
    let mut agreement = Agreement::new();
    let (_, theory) = shown("/analytic").remove(0);
    for solution in ["shallow_glide", "loh", "steep_glide", "steep_ballistic", "medium_glide"] {
        let theory = with(&theory, "/solution", solution);
        for lift in [0.0, 0.2, -0.2] {
            for aerodynamics in [
                json!({"type": "constant", "lift_coefficient": lift, "drag_coefficient": 0.2}),
                json!({"type": "constant", "drag_coefficient": 0.2}),
                json!({"type": "ballistic", "lift_to_drag": lift, "ballistic_coefficient": 100}),
                json!({"type": "ballistic", "ballistic_coefficient": 100}),
            ] {
                let request = with(&theory, "/vehicle/aerodynamics", aerodynamics.clone());
                let request = if aerodynamics["type"] == "ballistic" {
                    without(&request, "/vehicle/reference_area")
                } else {
                    request
                };
                agreement.agree("/analytic", &request, &format!("{solution} with {aerodynamics}")).await;
            }
        }
        for (pointer, value) in [
            ("/vehicle/aerodynamics/drag_coefficient", json!(0)),
            ("/vehicle/aerodynamics", json!({"type": "mach_table", "mach": [1], "drag_coefficient": [1]})),
            ("/vehicle/reference_area", json!(0)),
            ("/atmosphere", json!({"type": "us76"})),
            ("/atmosphere", json!({"type": "vacuum"})),
            ("/atmosphere", json!({"type": "exponential", "surface_density": 0, "scale_height": 7000})),
            ("/density_factor", json!(0)),
            ("/output", json!({"trajectory": false})),
            ("/output", json!({"count": 2, "columns": ["time"]})),
            ("/output", json!({"count": 2, "sites": true})),
        ] {
            let request = with(&theory, pointer, value.clone());
            agreement.refused("/analytic", &request, &format!("{solution} with {value} at {pointer}")).await;
        }
    }
    agreement.holds(100);
}

#[tokio::test]
async fn what_is_echoed_has_the_same_answer() {
    let service = Service::new();
    for (path, request, _) in ENDPOINTS {
        let schema = schema(request);
        for (name, request) in good_requests(path) {
            let mut first = service.post(path, &with(&request, "/echo", true)).await.json();
            is_valid(&schema, &first["case"], &name);
            let mut second = service.post(path, &first["case"]).await.json();
            for answer in [&mut first, &mut second] {
                if let Some(time) = answer.pointer_mut("/solver/elapsed") {
                    *time = json!(0);
                }
            }
            let [first, second] = [first, second].map(without_warnings_of_defaults);
            assert_eq!(first, second, "{name}");
        }
    }
}

#[tokio::test]
async fn every_answer_has_the_headers_of_the_document() {
    let service = Service::new();
    let document = document();
    for (path, answer) in [
        ("/simulate", service.post("/simulate", &flight("ecef")).await),
        ("/simulate", service.post("/simulate", &json!({})).await),
        ("/simulate", service.get("/simulate").await),
        ("/health/live", service.post_text("/health/live", "").await),
    ] {
        let method = if path == "/simulate" { "post" } else { "get" };
        let response = &document["paths"][path][method]["responses"][answer.status.as_str()];
        let shared = response["$ref"].as_str().map(|target| document.pointer(&target[1..]).unwrap());
        let headers = shared.unwrap_or(response)["headers"].as_object().unwrap();
        assert!(headers.contains_key("x-request-id"), "{path} {}", answer.status);
        for name in headers.keys() {
            assert!(answer.headers.contains_key(name), "{path} {}: {name}", answer.status);
        }
    }
}

#[tokio::test]
async fn schema_and_service_ask_for_exactly_one_alternative() {
    let mut agreement = Agreement::new();
    for (path, request, place) in
        [("/simulate", flight as fn(&str) -> Value, "/initial_state"), ("/convert", conversion, "/state")]
    {
        for (kind, one, other, value) in ALTERNATIVES {
            let request = request(kind);
            let none = without(&request, &format!("{place}/{one}"));
            agreement.refused(path, &none, &format!("{kind} without {one}")).await;
            let both = with(&request, &format!("{place}/{other}"), value);
            agreement.refused(path, &both, &format!("{kind} with {one} and {other}")).await;
        }
        let numbers = with_all(&request("ecef"), [("/planet/model", json!("earth_wgs84"))]);
        agreement.refused(path, &numbers, "a named planet with numbers").await;
        let unnamed = without(&request("ecef"), "/planet/model");
        agreement.refused(path, &unnamed, "numbers of a planet without custom").await;
    }
    agreement.holds(20);
}

#[tokio::test]
async fn schema_and_service_read_the_same_sidereal_times() {
    let mut agreement = Agreement::new();
    for value in [
        json!(0),
        json!(-1e9),
        json!("00:03:20.6"),
        json!("100:59:59"),
        json!("00:03"),
        json!("0:03:20"),
        json!("00:60:00"),
        json!("00:00:60"),
        json!("00:03:20."),
        json!("noon"),
        json!(""),
        json!("-00:03:20"),
    ] {
        for kind in KINDS {
            let request = with(&conversion(kind), "/state/sidereal_time", value.clone());
            agreement.agree("/convert", &request, &format!("a sidereal time of {value}")).await;
        }
    }
    agreement.holds(60);
}

#[tokio::test]
async fn schema_and_service_ask_the_same_of_inertial_frames() {
    let mut agreement = Agreement::new();
    let of = |path: &str, kind: &str| match path {
        "/convert" => (conversion(kind), "/state"),
        "/analytic" => (with(&flight(kind), "/solution", "loh"), "/initial_state"),
        _ => (flight(kind), "/initial_state"),
    };
    for (path, ..) in ENDPOINTS {
        for kind in KINDS {
            let (request, place) = of(path, kind);
            let bare = without(&request, &format!("{place}/sidereal_time"));
            let undated = without(&bare, "/epoch");
            for (dated, base) in [(true, bare), (false, undated)] {
                for (earth, base) in [(true, with(&base, "/planet", json!({}))), (false, base)] {
                    for (time, angle) in [(None, None), (Some(100), None), (None, Some(0.3)), (Some(100), Some(0.3))] {
                        for frame in ["date", "teme", "gcrf"] {
                            let mut request = base.clone();
                            let state = request.pointer_mut(place).unwrap();
                            if kind == "eci" || kind == "orbital_elements" {
                                state["frame"] = json!(frame);
                            }
                            for (name, value) in [("sidereal_time", json!(time)), ("sidereal_angle", json!(angle))] {
                                if !value.is_null() {
                                    state[name] = value;
                                }
                            }
                            let what = format!(
                                "{kind} in {frame}, an epoch {dated}, an Earth {earth}, time {time:?}, angle {angle:?}"
                            );
                            agreement.agree(path, &request, &what).await;
                        }
                    }
                }
            }
        }
        let (request, place) = of(path, "orbital_elements");
        let by_mean = without(&request, &format!("{place}/true_anomaly"));
        let by_mean = with(&by_mean, &format!("{place}/mean_anomaly"), 3.5);
        agreement.agree(path, &by_mean, "the mean anomaly of an ellipse").await;
        for eccentricity in [1.0, 1.1] {
            let unbound = with_all(
                &by_mean,
                [
                    (&format!("{place}/eccentricity"), json!(eccentricity)),
                    (&format!("{place}/semi_major_axis"), json!(-6.5e7)),
                ],
            );
            agreement.refused(path, &unbound, "the mean anomaly of an unbound orbit").await;
        }
    }
    agreement.holds(800);
}

/// The pointers of every value inside this one.
fn pointers(value: &Value, place: &str) -> Vec<String> {
    let at = |name: &str| format!("{place}/{}", name.replace('~', "~0").replace('/', "~1"));
    let inner: Vec<(String, &Value)> = match value {
        Value::Object(map) => map.iter().map(|(name, value)| (at(name), value)).collect(),
        Value::Array(array) => array.iter().enumerate().map(|(i, value)| (format!("{place}/{i}"), value)).collect(),
        _ => Vec::new(),
    };
    inner.into_iter().flat_map(|(place, value)| [vec![place.clone()], pointers(value, &place)].concat()).collect()
}

#[tokio::test]
async fn schema_and_service_agree_on_every_mutant_of_what_is_shown() {
    let mut agreement = Agreement::new();
    for (path, ..) in ENDPOINTS {
        for (name, request) in shown(path).into_iter().filter(|(name, _)| !name.ends_with("earth_jameson_text")) {
            let is_launch = ["launcher", "sounding_rocket", "abort"].contains(&name.as_str());
            for pointer in pointers(&request, "") {
                // A parachute is released by its name, which the event that deploys it has: a schema does not see that.
                let by_name = ["/then", "/deploy", "/deploy/name", "/release/0"];
                if name == "lifting_capsule" && by_name.iter().any(|end| pointer.ends_with(end)) {
                    continue;
                }
                for value in [json!(null), json!([]), json!("13")] {
                    let what = format!("{name} with {value} at {pointer}");
                    let request = with(&request, &pointer, value);
                    // Any text is a name, and nothing need happen or end the flight.
                    if is_launch {
                        agreement.agree_but_for_names(path, &request, &what).await;
                    } else if ["/name", "/events", "/release", "/stop/when"].iter().any(|end| pointer.ends_with(end)) {
                        agreement.agree(path, &request, &what).await;
                    } else {
                        agreement.refused(path, &request, &what).await;
                    }
                }
                // The place is on its planet: a schema does not see that it is inside of another.
                if ["mars", "titan"].contains(&name.as_str())
                    && ["/planet", "/planet/model"].contains(&pointer.as_str())
                {
                    continue;
                }
                // Where all fields have defaults, an empty object is complete.
                let emptied = with(&request, &pointer, json!({}));
                if is_launch {
                    agreement.agree_but_for_names(path, &emptied, &format!("{name} with {{}} at {pointer}")).await;
                } else {
                    agreement.agree(path, &emptied, &format!("{name} with {{}} at {pointer}")).await;
                }
                let in_an_array = pointer.ends_with(|last: char| last.is_ascii_digit());
                if !in_an_array {
                    let value = request.pointer(&pointer).unwrap().clone();
                    let removed = without(&request, &pointer);
                    // What other parts need of these, a schema does not see.
                    if is_launch {
                        if !["/angle_unit", "/atmosphere", "/epoch"].contains(&pointer.as_str()) {
                            let what = format!("{name} without {pointer}");
                            agreement.agree_but_for_names(path, &removed, &what).await;
                        }
                    } else if !(["lifting_capsule", "deorbit", "sample_return", "mars", "titan"]
                        .contains(&name.as_str())
                        && ["/angle_unit", "/atmosphere", "/epoch"].contains(&pointer.as_str()))
                    {
                        agreement.agree(path, &removed, &format!("{name} without {pointer}")).await;
                    }
                    let renamed = with(&removed, &format!("{pointer}_"), value);
                    agreement.refused(path, &renamed, &format!("{name} with {pointer}_")).await;
                }
            }
        }
    }
    agreement.holds(2000);
}

/// Of what searches have beside their cases.
#[tokio::test]
async fn schema_and_service_agree_on_every_mutant_of_a_search() {
    let mut agreement = Agreement::new();
    for (path, request) in [("/target", target(goals())), ("/corridor", corridor(limits()))] {
        is_valid(&schema(if path == "/target" { "TargetRequest" } else { "CorridorRequest" }), &request, path);
        let own = ["/vary", "/achieve", "/limits", "/search", "/resolution"];
        let is_own = |pointer: &String| own.iter().any(|start| pointer.starts_with(start));
        for pointer in pointers(&request, "").into_iter().filter(is_own) {
            for value in [json!(null), json!([]), json!({}), json!("13"), json!(true)] {
                let what = format!("with {value} at {pointer}");
                agreement.agree_but_for_names(path, &with(&request, &pointer, value), &what).await;
            }
            if !pointer.ends_with(|last: char| last.is_ascii_digit()) {
                let what = format!("without {pointer}");
                agreement.agree_but_for_names(path, &without(&request, &pointer), &what).await;
            }
        }
    }
    agreement.holds(400);
}

#[tokio::test]
async fn answers_are_valid() {
    let service = Service::new();
    for (path, _, response) in ENDPOINTS {
        let schema = schema(response);
        for (name, request) in good_requests(path) {
            for request in [request.clone(), with(&request, "/echo", true)] {
                let answer = service.post(path, &request).await;
                assert_eq!(answer.status, StatusCode::OK, "{name}");
                is_valid(&schema, &answer.json(), &name);
            }
        }
    }
    for (path, _, response) in SEARCHES {
        for (name, request) in shown(path) {
            let answer = service.post(path, &with(&request, "/echo", true)).await;
            assert_eq!(answer.status, StatusCode::OK, "{name}");
            is_valid(&schema(response), &answer.json(), &name);
            let again = service.post(path, &answer.json()["case"]).await.json();
            let found = |answer: &Value| json!([answer["solutions"], answer["bands"]]);
            assert_eq!(found(&again), found(&answer.json()), "{name} once more");
        }
    }
    for state in [
        json!({"type": "eci", "position": [7e6, 0, 0], "velocity": [1, 0, 0]}),
        json!({"type": "orbital_elements", "semi_latus_rectum": 7e6, "eccentricity": 1, "inclination": 0, "raan": 0,
            "argument_of_periapsis": 0, "true_anomaly": 0}),
    ] {
        let answer = service.post("/convert", &json!({"state": state})).await;
        is_valid(&schema("ConvertResponse"), &answer.json(), "an answer with nulls");
    }
    let request = with(&flight("geodetic"), "/output", json!({"trajectory": false}));
    let answer = service.post("/simulate", &request).await;
    is_valid(&schema("SimulateResponse"), &answer.json(), "an answer without trajectory");
}

#[tokio::test]
async fn the_validation_is_valid() {
    is_valid(&schema("Validation"), &Service::patient().get("/validation").await.json(), "the validation");
}

/// And it says all of them: a field that the schema does not know would be valid too.
#[tokio::test]
async fn the_planets_are_valid() {
    let planets = Service::new().get("/planets").await.json();
    is_valid(&schema("Planets"), &planets, "the planets");
    let known = |name: &str| document()["components"]["schemas"][name]["properties"].clone();
    for planet in planets["planets"].as_array().unwrap() {
        for (value, of) in [(planet, "NamedPlanet"), (&planet["atmosphere"], "PlanetAtmosphere")] {
            let names = value.as_object().into_iter().flatten().map(|(name, _)| name);
            assert!(names.into_iter().all(|name| known(of).get(name).is_some()), "{of} lacks a field of {value}");
        }
    }
}

#[tokio::test]
async fn the_licences_are_valid() {
    is_valid(&schema("Licences"), &Service::new().get("/licences?format=json").await.json(), "the licences");
}

#[tokio::test]
async fn problem_documents_are_valid() {
    let service = Service::new();
    let schema = schema("Problem");
    let spherical = json!({"formulation": "spherical"});
    let at_rest = with_all(&flight("geodetic"), [("/initial_state/speed", json!(0)), ("/solver", spherical)]);
    let rows = with(&flight("geodetic"), "/output", json!({"count": 1_000_000_000}));
    for answer in [
        service.get("/nothing").await,
        service.get("/simulate").await,
        service.post_text("/simulate", "{").await,
        service.post("/simulate?format=xml", &flight("ecef")).await,
        service.post("/simulate?x=1", &flight("ecef")).await,
        service.post("/simulate", &json!({})).await,
        service.post("/simulate", &at_rest).await,
        service.post("/simulate", &rows).await,
        service.post_text("/convert", " ".repeat(2 << 20)).await,
    ] {
        assert!(answer.status.is_client_error());
        is_valid(&schema, &answer.json(), "a problem");
    }
}

/// Readers of the document see what they would get: the answers in it are those of the service.
#[tokio::test]
async fn the_answers_that_the_document_shows_are_those_of_the_service() {
    let service = Service::new();
    let document = document();
    let example = |path: &str, name: &str| {
        document["paths"][path]["post"]["requestBody"]["content"]["application/json"]["examples"][name]["value"].clone()
    };
    let shown = |pointer: &str| document.pointer(pointer).unwrap_or_else(|| panic!("{pointer}")).clone();
    let target = example("/simulate", "target_1");
    let wrong = with(&target, "/vehicle/mass", -5);
    let misspelt = with(&without(&wrong, "/vehicle/reference_area"), "/vehicle/refrence_area", 1);
    let answer = |path: &str| shown(&format!("/paths/~1{path}/post/responses/200/content/application~1json/example"));
    for (path, request, expected) in [
        ("simulate", with(&target, "/output", json!({"count": 3})), answer("simulate")),
        ("convert", example("/convert", "impulse"), answer("convert")),
        (
            "analytic",
            with(&example("/analytic", "steep_ballistic"), "/output", json!({"count": 3})),
            answer("analytic"),
        ),
        ("simulate", misspelt, shown("/components/responses/InvalidCase/content/application~1problem+json/example")),
    ] {
        let got = service.post(&format!("/{path}"), &request).await.json();
        assert_eq!(differences(&expected, &got, ""), [""; 0], "openapi/answers is out of date: {got:#}");
    }
    let batch = json!([with(&target, "/output", json!({"trajectory": false})), wrong]);
    let got = service.post("/simulate/batch", &batch).await;
    let lines = shown("/paths/~1simulate~1batch/post/responses/200/content/application~1x-ndjson/example");
    let got: Vec<_> = std::str::from_utf8(&got.body).unwrap().lines().collect();
    let expected: Vec<_> = lines.as_str().unwrap().lines().collect();
    assert_eq!(got.len(), expected.len());
    for (got, expected) in got.iter().zip(expected) {
        let [tree, expected] = [got, expected].map(|line| serde_json::from_str::<Value>(line).unwrap());
        assert_eq!(differences(&expected, &tree, ""), [""; 0], "openapi/answers/batch.ndjson is out of date: {got}");
    }
}

/// Where an answer is not the expected one: numbers to a millionth, as machines round in different ways, and not how long it took.
fn differences(expected: &Value, got: &Value, at: &str) -> Vec<String> {
    match (expected, got) {
        (Value::Object(expected), Value::Object(got)) => {
            let names: BTreeSet<_> = expected.keys().chain(got.keys()).filter(|name| *name != "elapsed").collect();
            names
                .into_iter()
                .flat_map(|name| differences(&expected[name], &got[name], &format!("{at}/{name}")))
                .collect()
        }
        (Value::Array(expected), Value::Array(got)) if expected.len() == got.len() => {
            let elements = expected.iter().zip(got).enumerate();
            elements.flat_map(|(index, (expected, got))| differences(expected, got, &format!("{at}/{index}"))).collect()
        }
        (Value::Number(expected), Value::Number(got)) => {
            let [expected, got] = [expected, got].map(|number| number.as_f64().unwrap());
            let is_near = (expected - got).abs() <= 1e-6 * expected.abs().max(1.0);
            if is_near { Vec::new() } else { vec![format!("{at}: {got} for {expected}")] }
        }
        (expected, got) if expected == got => Vec::new(),
        (expected, got) => vec![format!("{at}: {got} for {expected}")],
    }
}

#[test]
fn every_operation_and_response_has_a_description() {
    let document = document();
    let operations = document["paths"].as_object().unwrap().iter();
    for (path, operation) in
        operations.flat_map(|(path, item)| item.as_object().unwrap().values().map(move |o| (path, o)))
    {
        assert!(operation["summary"].as_str().is_some_and(|text| !text.is_empty()), "{path}");
        let responses = operation["responses"].as_object().unwrap();
        assert!(!responses.is_empty(), "{path}");
        for (status, response) in responses {
            assert!(response["description"].as_str().is_some_and(|text| !text.is_empty()), "{path} {status}");
        }
    }
    let given: Vec<_> = document["paths"].as_object().unwrap().keys().map(String::as_str).collect();
    for path in ["/simulate", "/analytic", "/convert", "/validation", "/licences", "/health/live", "/health/ready"] {
        assert!(given.contains(&path), "{path}");
    }
}

/// The names of the schemas that this value refers to, directly or through others.
fn reached(document: &Value, value: &Value, names: &mut BTreeSet<String>) {
    for pointer in pointers(value, "").iter().filter(|pointer| pointer.ends_with("/$ref")) {
        let target = value.pointer(pointer).and_then(Value::as_str).unwrap();
        let name = target.strip_prefix("#/components/schemas/").unwrap();
        let schema = &document["components"]["schemas"][name];
        assert!(schema.is_object(), "{target} leads nowhere");
        if names.insert(name.to_owned()) {
            reached(document, schema, names);
        }
    }
}

#[test]
fn every_object_of_a_request_is_closed_and_every_field_described() {
    let document = document();
    let mut names = BTreeSet::new();
    for (path, ..) in ENDPOINTS.iter().chain(&SEARCHES) {
        reached(document, &document["paths"][path]["post"]["requestBody"], &mut names);
    }
    assert!(names.len() > 15, "{names:?}");
    for name in names {
        let schema = &document["components"]["schemas"][&name];
        if schema["type"] == "object" || schema.get("properties").is_some() {
            assert_eq!(schema["additionalProperties"], json!(false), "{name}");
            for (field, property) in schema["properties"].as_object().unwrap() {
                let described = property["description"].is_string() || property["oneOf"][0]["description"].is_string();
                assert!(described, "{name}.{field}");
            }
        }
    }
}
