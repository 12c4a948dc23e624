//! The OpenAPI document: what utoipa derives from the types, made as strict as the service is.

use std::collections::BTreeSet;

use reentry::scenario::Bound;
use serde_json::{Map, Value, json};
use utoipa::OpenApi;

use crate::error::Problem;
use crate::wire::batch::MOST_CASES;
use crate::wire::columns::COLUMNS;
use crate::wire::epoch::RFC3339_PATTERN;
use crate::wire::events::QUANTITIES;
use crate::wire::reader::MOST_ENTRIES;
use crate::wire::request_schemas;
use crate::wire::scenario::Output;

/// The frame of the document; the router adds the paths.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "reentry",
        description = "Flies vehicles back through the atmosphere. SI units; angles in `angle_unit`; an unknown field is an error.",
        license(name = "MIT OR Apache-2.0", identifier = "MIT OR Apache-2.0"),
    ),
    tags(
        (name = "reentry", description = "Flights and conversions."),
        (name = "health", description = "For those who watch the service."),
    ),
    components(schemas(Problem)),
)]
pub struct Document;

/// Fields of which exactly one is given, by the name of their object.
const ALTERNATIVES: [(&str, &[&str]); 10] = [
    ("PlanetRelative", &["radius", "altitude"]),
    ("PlanetRelative", &["heading", "azimuth"]),
    ("OrbitalElements", &["semi_major_axis", "semi_latus_rectum"]),
    ("OrbitalElements", &["true_anomaly", "mean_anomaly"]),
    ("InertialFlightPath", &["radius", "altitude"]),
    ("InertialFlightPath", &["inertial_heading", "inertial_azimuth"]),
    ("LayeredAtmosphere", &["layers", "preset"]),
    ("Condition", &["quantity", "event"]),
    ("ConstantWind", &["east", "speed"]),
    ("TableWind", &["east", "speed"]),
];

/// How a body may be sent.
const BODY: &str = "With `Content-Encoding: gzip` or `zstd` it may come compressed; the greatest length of a body then is that of its text.";

/// Every failure that every endpoint may answer with.
const FAILURES: [(&str, &str); 14] = [
    ("400", "Not JSON, duplicate keys, an unknown query parameter, or a head that is no request."),
    ("404", "There is nothing at this path."),
    ("405", "The path does not know this method."),
    ("406", "None of the representations that the client accepts."),
    ("408", "The body did not come in the time allowed, or too slowly where memory is short."),
    ("413", "The body is too long; of one in gzip or Zstandard, its text."),
    ("414", "The path is too long."),
    ("415", "The body is not declared as JSON, or comes in another `Content-Encoding` than gzip or zstd."),
    ("422", "Not a valid case, or a flight that cannot be finished; every fault with its pointer."),
    (
        "429",
        "More than this client may ask for: requests and computing where there is a rate limit, half of the memory or of the batches; \
         `Retry-After` says when to come back.",
    ),
    ("431", "The head of the request is too large."),
    ("500", "A fault of the service."),
    ("503", "Busy; `Retry-After` says when to come back."),
    ("504", "The time allowed ran out."),
];

/// The document of an API, as strict as the service is about its requests.
pub fn strict(api: &utoipa::openapi::OpenApi) -> Value {
    let mut document = serde_json::to_value(api).unwrap_or_default();
    let requests = schemas_of_requests(&document);
    if let Some(schemas) = document.pointer_mut("/components/schemas").and_then(Value::as_object_mut) {
        tag_variants(schemas);
        let described = request_schemas();
        for name in requests.iter().filter(|name| !described.contains_key(*name)) {
            if let Some(schema) = schemas.get_mut(name).and_then(Value::as_object_mut) {
                close(name, schema);
            }
        }
        schemas.extend(described);
        schemas.sort_keys();
    }
    if let Some(paths) = document.get_mut("paths").and_then(Value::as_object_mut) {
        for (path, method, formats) in [
            ("/simulate", "post", json!(["json", "csv", "geojson", "kml", "czml"])),
            ("/analytic", "post", json!(["json", "csv"])),
            ("/simulate/batch", "post", json!(["ndjson"])),
            ("/convert", "post", json!(["json"])),
            ("/validation", "get", json!(["json"])),
        ] {
            if let Some(operation) = paths.get_mut(path).and_then(|path| path.get_mut(method)) {
                // A request without a body has no fault of one.
                add_failures(operation, |status| method == "post" || !["408", "413", "415", "422"].contains(&status));
                operation["parameters"][0]["schema"] = json!({"type": "string", "enum": formats});
                if let Some(body) = operation.get_mut("requestBody") {
                    body["description"] = json!(BODY);
                }
            }
        }
        for path in ["/health/live", "/health/ready", "/metrics"] {
            add_failures(&mut paths[path]["get"], |status| ["405", "414", "431"].contains(&status));
        }
        add_examples(paths);
        add_headers(paths);
        add_links(paths);
        let cases = &mut paths["/simulate/batch"]["post"]["requestBody"]["content"]["application/json"]["schema"];
        cases["minItems"] = json!(1);
        cases["maxItems"] = json!(MOST_CASES);
    }
    document["components"]["headers"] = headers();
    name_constants(&mut document);
    document
}

/// The names of all schemas that a request body reaches.
fn schemas_of_requests(document: &Value) -> BTreeSet<String> {
    let mut found = BTreeSet::new();
    let mut open: Vec<&Value> = Vec::new();
    for path in document["paths"].as_object().into_iter().flat_map(Map::values) {
        open.push(&path["post"]["requestBody"]);
    }
    while let Some(value) = open.pop() {
        match value {
            Value::Object(map) => {
                if let Some(name) = map.get("$ref").and_then(Value::as_str).and_then(|path| path.rsplit('/').next())
                    && found.insert(name.to_owned())
                {
                    open.push(&document["components"]["schemas"][name]);
                }
                open.extend(map.values());
            }
            Value::Array(array) => open.extend(array),
            _ => {}
        }
    }
    found
}

/// Fixes the `type` of every variant to the name under which the union lists it.
fn tag_variants(schemas: &mut Map<String, Value>) {
    let mappings: Vec<_> =
        schemas.values().filter_map(|schema| schema["discriminator"]["mapping"].as_object()).collect();
    let tags: Vec<(String, String)> = mappings
        .into_iter()
        .flatten()
        .filter_map(|(tag, path)| Some((path.as_str()?.rsplit('/').next()?.to_owned(), tag.clone())))
        .collect();
    for (variant, tag) in tags {
        if let Some(kind) = schemas.get_mut(&variant).and_then(|variant| variant.pointer_mut("/properties/type")) {
            kind["enum"] = json!([tag]);
        }
    }
}

/// Makes an object of a request refuse unknown fields and null, and ask for exactly one of its alternatives.
fn close(name: &str, schema: &mut Map<String, Value>) {
    let Some(properties) = schema.get_mut("properties").and_then(Value::as_object_mut) else { return };
    for property in properties.values_mut() {
        if let Some(types) = property.get("type").and_then(Value::as_array) {
            let kind = types.iter().find(|kind| *kind != "null").cloned();
            property["type"] = kind.unwrap_or_default();
        }
        if let Some(variants) = property.get_mut("oneOf").and_then(Value::as_array_mut) {
            variants.retain(|variant| variant["type"] != "null");
        }
    }
    schema.insert("additionalProperties".to_owned(), json!(false));
    let one = |field: &&str| json!({"required": [field]});
    let of_name = ALTERNATIVES.iter().filter(|(of, _)| *of == name);
    let choice = |(_, fields): &(_, &[_])| json!({"oneOf": fields.iter().map(one).collect::<Vec<_>>()});
    // Within `allOf`: an object with a `oneOf` of its own is a union to those who make clients, and they lose its fields.
    let mut all: Vec<Value> = of_name.map(choice).collect();
    all.extend(parallel_conditions(name));
    if !all.is_empty() {
        schema.insert("allOf".to_owned(), json!(all));
    }
    refine(name, schema);
    for (keyword, condition) in conditions(name) {
        schema.insert(keyword.to_owned(), condition);
    }
}

/// What a field asks of its neighbours, which the types do not tell.
fn conditions(name: &str) -> Vec<(&'static str, Value)> {
    let is = |field: &str, value: &str| json!({"properties": {(field): {"const": value}}, "required": [field]});
    match name {
        "Planet" => {
            let numbers = ["gravitational_parameter", "equatorial_radius", "polar_radius", "rotation_rate"];
            let absent: Map<_, _> = numbers.iter().map(|name| ((*name).to_owned(), json!(false))).collect();
            let up_to = |degree: usize, name: &str| {
                let least = json!({"properties": {"degree": {"minimum": degree}}, "required": ["degree"]});
                json!({"if": least, "then": {"required": [name]}})
            };
            let coefficients = json!({"required": ["j2"], "allOf": [up_to(3, "j3"), up_to(4, "j4")]});
            let gravity = json!({"if": is("type", "zonal"), "then": coefficients});
            vec![
                ("if", is("model", "custom")),
                ("then", json!({"required": numbers, "properties": {"gravity": gravity}})),
                ("else", json!({"properties": absent})),
            ]
        }
        "SimulateRequest" => {
            vec![("dependentSchemas", json!({"heating": {"properties": {"vehicle": {"required": ["nose_radius"]}}}}))]
        }
        "AnalyticRequest" => vec![("dependentSchemas", json!({"solution": theory()}))],
        "ConstantWind" | "TableWind" => vec![(
            "dependentRequired",
            json!({"east": ["north"], "north": ["east"], "speed": ["from"], "from": ["speed"]}),
        )],
        "TableAtmosphere" => {
            let alone =
                json!({"not": {"anyOf": [{"required": ["molar_mass"]}, {"required": ["heat_capacity_ratio"]}]}});
            vec![
                (
                    "dependentRequired",
                    json!({"molar_mass": ["heat_capacity_ratio", "temperature"], "heat_capacity_ratio": ["molar_mass"]}),
                ),
                ("dependentSchemas", json!({"speed_of_sound": alone})),
            ]
        }
        "Effect" => vec![(
            "dependentSchemas",
            json!({"reference_area": {"properties": {"aerodynamics": {"not": is("type", "ballistic")}}}}),
        )],
        "Thrust" => vec![("dependentRequired", json!({"propellant": ["specific_impulse"]}))],
        "Output" => {
            // Columns alone are of four rows a step; without a trajectory there are none.
            let columns = json!({"required": ["columns"]});
            let without = json!({"not": {"required": ["columns"]}});
            let way = json!({"anyOf": Output::WAYS.map(|way| json!({"required": [way]}))});
            vec![
                ("if", way),
                ("then", json!({"oneOf": Output::WAYS.map(|way| json!({"required": [way]}))})),
                ("else", columns),
                ("dependentSchemas", json!({"trajectory": without})),
            ]
        }
        _ => Vec::new(),
    }
}

/// What every theory asks of its case: constant coefficients, exponential air, the rows of a flight; and lift, or none.
fn theory() -> Value {
    let positive = json!({"exclusiveMinimum": 0});
    let constant = json!({"type": {"enum": ["constant", "ballistic"]}, "drag_coefficient": positive});
    let aerodynamics = |schema: Value| json!({"vehicle": {"properties": {"aerodynamics": schema}}});
    let lift = |bound: Value| json!({"lift_coefficient": bound, "lift_to_drag": bound});
    let some = json!({
        "properties": lift(json!({"not": {"const": 0}})),
        "anyOf": [{"required": ["lift_coefficient"]}, {"required": ["lift_to_drag"]}],
    });
    json!({
        "properties": {
            "atmosphere": {"properties": {"type": {"const": "exponential"}, "surface_density": positive}},
            "density_factor": positive,
            "vehicle": {"properties": {"reference_area": positive, "aerodynamics": {"properties": constant}}},
            "output": {"properties": {"trajectory": false, "columns": false}},
        },
        "if": {"properties": {"solution": {"const": "steep_ballistic"}}},
        "then": {"properties": aerodynamics(json!({"properties": lift(json!({"const": 0}))}))},
        "else": {"properties": aerodynamics(some)},
    })
}

/// Of the time and the angle between the frames at most one is given.
fn one_sidereal() -> Value {
    json!({"not": {"required": ["sidereal_time", "sidereal_angle"]}})
}

/// The frames that the epoch turns.
fn frames_of_epoch() -> Value {
    json!({"properties": {"frame": {"enum": ["teme", "gcrf"]}}, "required": ["frame"]})
}

/// These have neither time nor angle.
fn no_sidereal() -> Value {
    json!({"if": frames_of_epoch(), "then": {"properties": {"sidereal_time": false, "sidereal_angle": false}}})
}

/// What an inertial state asks of epoch and planet.
fn inertial_states(state: &str) -> Vec<Value> {
    let of = |schema: Value| json!({"properties": {(state): schema}, "required": [state]});
    let custom = json!({"properties": {"model": {"const": "custom"}}, "required": ["model"]});
    let on_custom = json!({"properties": {"planet": custom}, "required": ["planet"]});
    let inertial = json!({"properties": {"type": {"enum": ["eci", "orbital_elements"]}}, "required": ["type"]});
    let turned = json!({"anyOf": [{"required": ["sidereal_time"]}, {"required": ["sidereal_angle"]}]});
    vec![
        json!({"if": of(frames_of_epoch()), "then": {"required": ["epoch"], "not": on_custom}}),
        json!({"if": {"required": ["epoch"], "allOf": [on_custom, of(inertial)]}, "then": of(turned)}),
    ]
}

/// Those that stand side by side, as a schema has one `if`.
fn parallel_conditions(name: &str) -> Vec<Value> {
    let is = |field: &str, value: &str| json!({"properties": {(field): {"const": value}}, "required": [field]});
    match name {
        "ZonalGravity" => {
            let below = |degree: usize, name: &str| {
                json!({"if": {"properties": {"degree": {"exclusiveMaximum": degree}}},
                    "then": {"properties": {(name): false}}})
            };
            // Without a degree it is 2, and the condition holds.
            vec![below(3, "j3"), below(4, "j4")]
        }
        "PlanetRelative" | "Geodetic" | "Ecef" | "InertialFlightPath" => vec![one_sidereal()],
        "Eci" => vec![one_sidereal(), no_sidereal()],
        "OrbitalElements" => {
            let bound = json!({"properties": {"eccentricity": {"exclusiveMaximum": 1}}});
            vec![one_sidereal(), no_sidereal(), json!({"if": {"required": ["mean_anomaly"]}, "then": bound})]
        }
        "SimulateRequest" | "AnalyticRequest" => inertial_states("initial_state"),
        "ConvertRequest" => inertial_states("state"),
        "Condition" => {
            let of = |(name, quantity, _): &(&str, reentry::event::Quantity, &str)| {
                let bound = quantity.bound();
                let bounds = bounds_of(if quantity.is_angle() { bound.scaled(1.0_f64.to_degrees()) } else { bound });
                let both = json!({"properties": {"falls_through": bounds, "rises_through": bounds}});
                json!({"if": is("quantity", name), "then": both})
            };
            let way = json!({"oneOf": [{"required": ["falls_through"]}, {"required": ["rises_through"]}],
                "properties": {"delay": false}});
            let no_way = json!({"properties": {"falls_through": false, "rises_through": false}});
            let by_quantity = json!({"if": {"required": ["quantity"]}, "then": way, "else": no_way});
            let time = json!({"if": is("quantity", "time"), "then": {"properties": {"falls_through": false}}});
            [by_quantity, time].into_iter().chain(QUANTITIES.iter().map(of)).collect()
        }
        _ => Vec::new(),
    }
}

/// The keywords of a bound, which leaves out what every finite number is within.
fn bounds_of(bound: Bound) -> Value {
    let mut keywords = Map::new();
    if bound.minimum > f64::MIN {
        keywords.insert(if bound.exclusive { "exclusiveMinimum" } else { "minimum" }.to_owned(), json!(bound.minimum));
    }
    if bound.maximum < f64::MAX {
        keywords.insert("maximum".to_owned(), json!(bound.maximum));
    }
    Value::Object(keywords)
}

/// Bounds of elements and of words, which the types do not tell.
fn refine(name: &str, schema: &mut Map<String, Value>) {
    let bounded = |least: f64, greatest: f64| json!({"minimum": least, "maximum": greatest});
    let [distance, wind, turn] = [bounded(-1e12, 1e12), bounded(-1e4, 1e4), bounded(-360.0, 360.0)];
    let [positive, not_negative] = [json!({"exclusiveMinimum": 0}), json!({"minimum": 0})];
    // Beside a reference to the schema of a number or a list; each keyword is of one of these alone.
    let number_or_list = |mut bounds: Value| {
        bounds["items"] = bounds.clone();
        bounds["minItems"] = json!(2);
        bounds["maxItems"] = json!(MOST_ENTRIES);
        bounds
    };
    let refinements = match name {
        "Ecef" | "Eci" => vec![
            ("position", json!({"minItems": 3, "maxItems": 3})),
            ("position/items", distance),
            ("velocity", json!({"minItems": 3, "maxItems": 3})),
            ("velocity/items", if name == "Ecef" { bounded(-1e6, 1e6) } else { json!({}) }),
        ],
        "InertialDirection" => vec![
            ("frame", json!({"enum": ["inertial"]})),
            ("direction", json!({"minItems": 3, "maxItems": 3, "contains": {"not": {"const": 0}}})),
        ],
        "Output" => vec![
            ("times/items", not_negative),
            ("trajectory", json!({"enum": [false]})),
            ("columns", json!({"minItems": 1, "maxItems": COLUMNS.len(), "uniqueItems": true})),
            ("columns/items", json!({"enum": COLUMNS.iter().map(|column| column.name).collect::<Vec<_>>()})),
        ],
        "TableAtmosphere" => vec![
            ("altitude/items", distance),
            ("density/items", positive.clone()),
            ("temperature/items", positive.clone()),
            ("pressure/items", positive.clone()),
            ("speed_of_sound/items", positive),
            ("molar_mass", number_or_list(bounded(1e-6, 1.0))),
            ("heat_capacity_ratio", number_or_list(bounded(1.0, 2.0))),
        ],
        "ConstantWind" => vec![("from", turn)],
        "TableWind" => vec![
            ("altitude/items", distance),
            ("east/items", wind.clone()),
            ("north/items", wind),
            ("speed/items", bounded(0.0, 1e4)),
            ("from/items", turn),
        ],
        "SuttonGraves" => vec![("type", json!({"enum": ["sutton_graves"]}))],
        // The theories know no events, but an empty list is none.
        "AnalyticRequest" => vec![("epoch", json!({"pattern": RFC3339_PATTERN})), ("events", json!({"maxItems": 0}))],
        "SimulateRequest" | "ConvertRequest" => vec![("epoch", json!({"pattern": RFC3339_PATTERN}))],
        _ => Vec::new(),
    };
    for (path, refinement) in refinements {
        let property = schema.get_mut("properties").and_then(|properties| properties.pointer_mut(&format!("/{path}")));
        if let (Some(property), Some(refinement)) = (property.and_then(Value::as_object_mut), refinement.as_object()) {
            property.extend(refinement.clone());
        }
    }
}

fn add_failures(operation: &mut Value, may_fail: impl Fn(&str) -> bool) {
    for (status, description) in FAILURES.into_iter().filter(|(status, _)| may_fail(status)) {
        operation["responses"][status] = json!({
            "description": description,
            "content": {"application/problem+json": {"schema": {"$ref": "#/components/schemas/Problem"}}},
        });
    }
}

/// The headers that answers have.
fn headers() -> Value {
    let header = |description, schema| json!({"description": description, "required": true, "schema": schema});
    json!({
        "RequestId": header(
            "Names the request, as in the log: what the request's own `x-request-id` says or, without one that is sound, a new name.",
            json!({"type": "string", "pattern": "^[!-~]{1,128}$"}),
        ),
        "RetryAfter": header("In how many seconds to come back.", json!({"type": "integer", "minimum": 1})),
        "Allow": header("The methods that the path knows.", json!({"type": "string"})),
    })
}

fn add_headers(paths: &mut Map<String, Value>) {
    let operations = paths.values_mut().filter_map(Value::as_object_mut).flat_map(Map::values_mut);
    for responses in operations.filter_map(|operation| operation["responses"].as_object_mut()) {
        for (status, response) in responses {
            let mut headers = vec![("x-request-id", "RequestId")];
            let is_problem = response["content"].get("application/problem+json").is_some();
            match status.as_str() {
                "405" => headers.push(("allow", "Allow")),
                // Not that of `/health/ready`: who watches comes back anyway.
                "429" | "503" if is_problem => headers.push(("retry-after", "RetryAfter")),
                _ => {}
            }
            for (name, header) in headers {
                response["headers"][name] = json!({"$ref": format!("#/components/headers/{header}")});
            }
        }
    }
}

/// What is echoed can be sent again.
fn add_links(paths: &mut Map<String, Value>) {
    for path in ["/simulate", "/analytic", "/convert"] {
        let operation = &mut paths[path]["post"];
        let again = json!({
            "operationId": operation["operationId"],
            "requestBody": "$response.body#/case",
            "description": "With `echo`: the request with every default filled in has the same answer, without warnings of what was left out.",
        });
        operation["responses"]["200"]["links"] = json!({"again": again});
    }
}

/// Makes a constant of every choice of one, for which generators of clients would invent a type of its own.
fn name_constants(value: &mut Value) {
    match value {
        Value::Object(map) => {
            if let Some([only]) = map.get("enum").and_then(Value::as_array).map(Vec::as_slice) {
                let only = only.clone();
                map.remove("enum");
                map.insert("const".to_owned(), only);
            }
            map.values_mut().for_each(name_constants);
        }
        Value::Array(array) => array.iter_mut().for_each(name_constants),
        _ => {}
    }
}

fn add_examples(paths: &mut Map<String, Value>) {
    let example = |text: &str| serde_json::from_str::<Value>(text).unwrap_or_default();
    let simulate = json!({
        "deorbit": {"summary": "A capsule comes down from orbit: a burn, the heat of entry, parachutes",
            "value": example(include_str!("../../../openapi/examples/deorbit.json"))},
        "lifting_capsule": {"summary": "A lifting capsule comes home: banked by a schedule, in standard air and wind, under the Earth's flattening",
            "value": example(include_str!("../../../openapi/examples/lifting_capsule.json"))},
        "sample_return": {"summary": "A sample capsule returns from a comet: from the inertial state at entry, with heating and parachutes",
            "value": example(include_str!("../../../openapi/examples/sample_return.json"))},
        "target_1": {"summary": "TARGET reference case 1, of the thesis: steep and fast, from orbital elements",
            "value": example(include_str!("../../../openapi/examples/target_1.json"))},
        "target_2": {"summary": "TARGET reference case 2, of the thesis: a banked, lifting vehicle",
            "value": example(include_str!("../../../openapi/examples/target_2.json"))},
        "impulse": {"summary": "IMPULSE reference case, of the thesis: from inertial vectors",
            "value": example(include_str!("../../../openapi/examples/impulse.json"))},
    });
    let convert = json!({
        "impulse": {"summary": "The initial state of the IMPULSE reference case",
            "value": example(include_str!("../../../openapi/examples/impulse_state.json"))},
    });
    let analytic = json!({
        "steep_ballistic": {"summary": "A small vehicle falls steeply from 400 km: the straight line of the ballistic theory",
            "value": example(include_str!("../../../openapi/examples/steep_ballistic.json"))},
    });
    let batch = json!({
        "list": {"summary": "Two cases", "value": [simulate["deorbit"]["value"], simulate["sample_return"]["value"]]},
    });
    for (path, examples) in
        [("/simulate", simulate), ("/simulate/batch", batch), ("/convert", convert), ("/analytic", analytic)]
    {
        paths[path]["post"]["requestBody"]["content"]["application/json"]["examples"] = examples;
    }
}
