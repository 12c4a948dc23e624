//! The OpenAPI document: paths and answers as utoipa derives them, and requests as they are described.

use serde_json::{Map, Value, json};
use utoipa::OpenApi;

use crate::error::{ApiError, Problem};
use crate::wire::batch::MOST_CASES;
use crate::wire::request_schemas;

/// The frame of the document; the router adds the paths.
#[derive(OpenApi)]
#[openapi(
    info(
        title = "reentry",
        description = DESCRIPTION,
        license(name = "MIT OR Apache-2.0", identifier = "MIT OR Apache-2.0"),
    ),
    tags(
        (name = "reentry", description = "Flights and conversions."),
        (name = "health", description = "Health and metrics."),
    ),
    components(schemas(Problem)),
)]
pub struct Document;

/// What a reader of the document needs first.
const DESCRIPTION: &str = "\
Simulates atmospheric entry: trajectories, landing points, loads and heating. [Open the page](../) or [read the guide](../guide/).

**Conventions.** SI units. Angles are in `angle_unit`, radians by default. `heading` counts from east towards north, `azimuth` from north
towards east. `flight_path_angle` is negative on the way down. `altitude` is along the radius, `geodetic_altitude` along the normal of the
ellipsoid. `speed` is relative to the rotating planet. Times are seconds from the start of the flight. An unknown field is an error. In the
schemas `x-unit` is the unit of a field, `angle` for the one of `angle_unit`.

**The smallest case** has a vehicle, an initial state and an atmosphere; everything else has a default, which `\"echo\": true` shows:

```json
{
  \"angle_unit\": \"deg\",
  \"atmosphere\": {\"type\": \"us76\"},
  \"vehicle\": {\"mass\": 5500, \"reference_area\": 12, \"aerodynamics\": {\"type\": \"constant\", \"drag_coefficient\": 1.3}},
  \"initial_state\": {\"type\": \"geodetic\", \"geodetic_altitude\": 120000, \"longitude\": -40, \"geodetic_latitude\": 10,
    \"speed\": 7500, \"flight_path_angle\": -2, \"azimuth\": 60}
}
```

**Errors** are problem documents (RFC 9457). All faults of a request come at once, each with the JSON pointer of its field. The path in
`type` answers a page that says what to do, as does `/warnings/CODE` for the warnings of an answer.";

/// The paths in the order in which a reader needs them.
const ORDER: [&str; 14] = [
    "/simulate",
    "/simulate/batch",
    "/convert",
    "/analytic",
    "/target",
    "/corridor",
    "/footprint",
    "/planets",
    "/sites",
    "/validation",
    "/licences",
    "/health/live",
    "/health/ready",
    "/metrics",
];

/// How a body may be sent.
const BODY: &str =
    "May be compressed: `Content-Encoding: gzip` or `zstd`. The limit on its length applies to the decompressed text.";

/// Every failure that every endpoint may answer with.
const FAILURES: [(&str, &str); 14] = [
    ("400", "The body is not JSON, has a key twice, or the query string or the request itself is malformed."),
    ("404", "No resource at this path."),
    ("405", "The path does not support this method."),
    ("406", "No format that the client accepts."),
    ("408", "The body did not arrive in time."),
    ("413", "The body is too long."),
    ("414", "The path is too long."),
    ("415", "The body is not declared as JSON, or has another `Content-Encoding` than gzip or zstd."),
    (
        "422",
        "The case is not valid, or the flight cannot be completed. `errors` has every fault with its JSON pointer.",
    ),
    (
        "429",
        "The client exceeds its rate limit or its share of memory or batches. Try again after `Retry-After` seconds.",
    ),
    ("431", "The request head is too large."),
    ("500", "Error of the service."),
    ("503", "The service is busy. Try again after `Retry-After` seconds."),
    ("504", "The time limit was exceeded."),
];

/// The document of an API, as strict as the service is about its requests.
pub fn strict(api: &utoipa::openapi::OpenApi) -> Value {
    let mut document = serde_json::to_value(api).unwrap_or_default();
    if let Some(schemas) = document.pointer_mut("/components/schemas").and_then(Value::as_object_mut) {
        // In place of what stands for them in the types of answers.
        schemas.extend(request_schemas());
        schemas.sort_keys();
    }
    if let Some(paths) = document.get_mut("paths").and_then(Value::as_object_mut) {
        for (path, method, formats) in [
            ("/simulate", "post", json!(["json", "csv", "geojson", "kml", "czml", "oem"])),
            ("/analytic", "post", json!(["json", "csv"])),
            ("/simulate/batch", "post", json!(["ndjson"])),
            ("/convert", "post", json!(["json"])),
            ("/target", "post", json!(["json"])),
            ("/corridor", "post", json!(["json"])),
            ("/footprint", "post", json!(["json", "geojson"])),
            ("/sites", "get", json!(["json", "csv", "geojson"])),
            ("/validation", "get", json!(["json"])),
            ("/licences", "get", json!(["text", "json"])),
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
        for path in ["/planets", "/health/live", "/health/ready", "/metrics"] {
            add_failures(&mut paths[path]["get"], |status| ["405", "414", "431"].contains(&status));
        }
        add_examples(paths);
        add_headers(paths);
        add_links(paths);
        let cases = &mut paths["/simulate/batch"]["post"]["requestBody"]["content"]["application/json"]["schema"];
        cases["minItems"] = json!(1);
        cases["maxItems"] = json!(MOST_CASES);
    }
    sort_paths(&mut document);
    document["components"]["headers"] = headers();
    document["components"]["responses"] = problems();
    name_constants(&mut document);
    document
}

fn add_failures(operation: &mut Value, may_fail: impl Fn(&str) -> bool) {
    for (status, description) in FAILURES.into_iter().filter(|(status, _)| may_fail(status)) {
        let shared = match status {
            "405" => "MethodNotAllowed",
            "422" => "InvalidCase",
            "429" | "503" => "TryAgain",
            _ => "Problem",
        };
        operation["responses"][status] =
            json!({"$ref": format!("#/components/responses/{shared}"), "description": description});
    }
}

/// The responses that all endpoints share: problem documents.
fn problems() -> Value {
    let problem = |description, header: Option<(&str, &str)>, example: Value| {
        let mut headers = json!({"x-request-id": {"$ref": "#/components/headers/RequestId"}});
        if let Some((name, header)) = header {
            headers[name] = json!({"$ref": format!("#/components/headers/{header}")});
        }
        let content = json!({"schema": {"$ref": "#/components/schemas/Problem"}, "example": example});
        json!({"description": description, "headers": headers, "content": {"application/problem+json": content}})
    };
    let short = |error: &ApiError| json!(error.problem());
    json!({
        "Problem": problem("A problem document (RFC 9457).", None, short(&ApiError::DeadlineExceeded { seconds: 10.0 })),
        "MethodNotAllowed":
            problem("Method not allowed.", Some(("allow", "Allow")), short(&ApiError::MethodNotAllowed("/simulate".to_owned()))),
        "TryAgain": problem("Try again later.", Some(("retry-after", "RetryAfter")), short(&ApiError::Busy)),
        "InvalidCase": problem("The case is not valid.", None, parsed(include_str!("../../../openapi/answers/invalid.json"))),
    })
}

/// Puts the paths into their order.
fn sort_paths(document: &mut Value) {
    let Some(paths) = document["paths"].as_object_mut() else { return };
    let mut unsorted = std::mem::take(paths);
    for path in ORDER {
        if let Some(item) = unsorted.remove(path) {
            paths.insert(path.to_owned(), item);
        }
    }
    paths.extend(unsorted);
}

fn parsed(text: &str) -> Value {
    serde_json::from_str(text).unwrap_or_default()
}

/// The headers that answers have.
fn headers() -> Value {
    let header = |description, schema| json!({"description": description, "required": true, "schema": schema});
    json!({
        "RequestId": header(
            "Identifies the request in the log: the request's own `x-request-id` if it is valid, else a new one.",
            json!({"type": "string", "pattern": "^[!-~]{1,128}$"}),
        ),
        "RetryAfter": header("Seconds to wait before the next attempt.", json!({"type": "integer", "minimum": 1})),
        "Allow": header("Methods that the path supports.", json!({"type": "string"})),
    })
}

fn add_headers(paths: &mut Map<String, Value>) {
    let operations = paths.values_mut().filter_map(Value::as_object_mut).flat_map(Map::values_mut);
    for responses in operations.filter_map(|operation| operation["responses"].as_object_mut()) {
        for response in responses.values_mut() {
            // Shared responses have theirs.
            if response.get("$ref").is_none() {
                response["headers"]["x-request-id"] = json!({"$ref": "#/components/headers/RequestId"});
            }
        }
    }
}

/// What is echoed can be sent again.
fn add_links(paths: &mut Map<String, Value>) {
    for path in ["/simulate", "/analytic", "/convert", "/target", "/corridor", "/footprint"] {
        let operation = &mut paths[path]["post"];
        let again = json!({
            "operationId": operation["operationId"],
            "requestBody": "$response.body#/case",
            "description": "With `echo`: the returned case can be sent again and gives the same answer, without the warnings about defaults.",
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
    let simulate = json!({
        "deorbit": {"summary": "Capsule from orbit: deorbit burn, heating, parachutes",
            "value": parsed(include_str!("../../../openapi/examples/deorbit.json"))},
        "lifting_capsule": {"summary": "Lifting capsule: bank schedule, standard atmosphere, wind, zonal gravity",
            "value": parsed(include_str!("../../../openapi/examples/lifting_capsule.json"))},
        "sample_return": {"summary": "Sample return capsule: inertial entry state, heating, parachutes",
            "value": parsed(include_str!("../../../openapi/examples/sample_return.json"))},
        "mars": {"summary": "Mars: lifting entry of a rover from an inertial state",
            "value": parsed(include_str!("../../../openapi/examples/mars.json"))},
        "titan": {"summary": "Titan: ballistic entry of a probe, steep and slow",
            "value": parsed(include_str!("../../../openapi/examples/titan.json"))},
        "launcher": {"summary": "Launcher: two stages to orbit, the spent stage and the fairing to their drop zones",
            "value": parsed(include_str!("../../../openapi/examples/launcher.json"))},
        "sounding_rocket": {"summary": "Sounding rocket: solid motor, separation, payload under a parachute",
            "value": parsed(include_str!("../../../openapi/examples/sounding_rocket.json"))},
        "abort": {"summary": "Abort during ascent: escape tower, capsule under parachutes",
            "value": parsed(include_str!("../../../openapi/examples/abort.json"))},
        "target_1": {"summary": "TARGET reference case 1 of the thesis: steep and fast, from orbital elements",
            "value": parsed(include_str!("../../../openapi/examples/target_1.json"))},
        "target_2": {"summary": "TARGET reference case 2 of the thesis: banked, lifting vehicle",
            "value": parsed(include_str!("../../../openapi/examples/target_2.json"))},
        "impulse": {"summary": "IMPULSE reference case of the thesis: from inertial vectors",
            "value": parsed(include_str!("../../../openapi/examples/impulse.json"))},
    });
    let convert = json!({
        "impulse": {"summary": "Initial state of the IMPULSE reference case",
            "value": parsed(include_str!("../../../openapi/examples/impulse_state.json"))},
    });
    let analytic = json!({
        "steep_ballistic": {"summary": "Steep ballistic entry from 400 km beside the ballistic theory",
            "value": parsed(include_str!("../../../openapi/examples/steep_ballistic.json"))},
    });
    let target = json!({
        "landing_site": {"summary": "Landing site: time of the deorbit burn and bank angle",
            "value": parsed(include_str!("../../../openapi/examples/target.json"))},
        "boundary_values": {"summary": "TARGET's boundary value problem: ascending and descending solution",
            "value": parsed(include_str!("../../../openapi/examples/boundary_values.json"))},
    });
    let corridor = json!({
        "lunar_return": {"summary": "Lunar return: load limit with the lift up, capture with the lift down",
            "value": parsed(include_str!("../../../openapi/examples/corridor.json"))},
    });
    let footprint = json!({
        "two_banks": {"summary": "Capsule from orbit: two bank angles, load limit",
            "value": parsed(include_str!("../../../openapi/examples/footprint.json"))},
    });
    let batch = json!({
        "list": {"summary": "Two cases", "value": [simulate["deorbit"]["value"], simulate["sample_return"]["value"]]},
    });
    for (path, examples) in [
        ("/simulate", simulate),
        ("/simulate/batch", batch),
        ("/convert", convert),
        ("/analytic", analytic),
        ("/target", target),
        ("/corridor", corridor),
        ("/footprint", footprint),
    ] {
        paths[path]["post"]["requestBody"]["content"]["application/json"]["examples"] = examples;
    }
    for (path, media_type, answer) in [
        ("/simulate", "application/json", include_str!("../../../openapi/answers/simulate.json")),
        ("/convert", "application/json", include_str!("../../../openapi/answers/convert.json")),
        ("/analytic", "application/json", include_str!("../../../openapi/answers/analytic.json")),
    ] {
        paths[path]["post"]["responses"]["200"]["content"][media_type]["example"] = parsed(answer);
    }
    let batch = &mut paths["/simulate/batch"]["post"]["responses"]["200"]["content"]["application/x-ndjson"];
    batch["example"] = json!(include_str!("../../../openapi/answers/batch.ndjson"));
}
