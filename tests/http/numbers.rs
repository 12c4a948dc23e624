//! The numbers of a request, by their pointers.

use std::collections::BTreeSet;

use reentry_service::wire::convert::convert_request;
use reentry_service::wire::description::read_with_numbers;
use reentry_service::wire::reader::NumberField;
use reentry_service::wire::scenario::simulate_request;
use serde_json::{Value, json};

use super::requests::{KINDS, capsule, conversion, flight, models, with};

/// The numbers of a case, and the tree with its defaults.
fn numbers_of(mut request: Value) -> (Vec<NumberField>, Value) {
    let (_, numbers) = read_with_numbers(&mut request, simulate_request).unwrap();
    (numbers, request)
}

/// The pointers to all numbers of a tree.
fn pointers(value: &Value, at: &str) -> Vec<String> {
    match value {
        Value::Number(_) => vec![at.to_owned()],
        Value::Array(array) => {
            array.iter().enumerate().flat_map(|(index, element)| pointers(element, &format!("{at}/{index}"))).collect()
        }
        Value::Object(object) => {
            object.iter().flat_map(|(name, value)| pointers(value, &format!("{at}/{name}"))).collect()
        }
        _ => Vec::new(),
    }
}

#[test]
fn every_number_is_listed_once_but_whole_ones() {
    let whole = ["/planet/gravity/degree", "/output/count", "/output/samples_per_step"];
    let requests = KINDS.map(flight).into_iter().chain(models().into_iter().map(|(_, request)| request));
    for request in requests.chain([capsule()]) {
        let (numbers, tree) = numbers_of(request);
        let listed: BTreeSet<_> = numbers.iter().map(|number| number.pointer.clone()).collect();
        assert_eq!(listed.len(), numbers.len(), "{numbers:?}");
        let there = pointers(&tree, "")
            .into_iter()
            .filter(|pointer| !whole.contains(&pointer.as_str()) && !pointer.ends_with("/count"));
        assert_eq!(listed, there.collect(), "{tree}");
        for NumberField { pointer, bound, unit } in &numbers {
            let value = tree.pointer(pointer).and_then(Value::as_f64).unwrap();
            assert!(bound.admits(value), "{pointer}: {value} {unit}");
        }
    }
}

#[test]
fn numbers_of_conversions_are_listed_too() {
    for kind in KINDS {
        let mut request = conversion(kind);
        let (_, numbers) = read_with_numbers(&mut request, convert_request).unwrap();
        let of_state: Vec<_> = numbers.iter().filter(|number| number.pointer.starts_with("/state/")).collect();
        assert_eq!(of_state.len(), pointers(&request["state"], "").len(), "{kind}: {of_state:?}");
    }
}

#[test]
fn a_number_has_its_unit_and_its_bound() {
    let table = json!({"type": "table", "altitude": [0, 1e4], "speed": [5, 30], "from": [0, 0.2]});
    let request = with(&flight("geodetic"), "/wind", table);
    let stop = json!([{"quantity": "inclination", "falls_through": 1}, {"quantity": "density", "rises_through": 1}]);
    let (numbers, _) = numbers_of(with(&request, "/stop/when", stop));
    for (pointer, unit, maximum) in [
        ("/vehicle/mass", "kg", f64::MAX),
        ("/vehicle/aerodynamics/drag_coefficient", "", f64::MAX),
        ("/wind/speed/1", "m/s", 1e4),
        ("/wind/from/1", "angle", std::f64::consts::TAU),
        ("/initial_state/flight_path_angle", "angle", std::f64::consts::FRAC_PI_2),
        ("/stop/when/0/falls_through", "angle", std::f64::consts::PI),
        ("/stop/when/1/rises_through", "kg/m³", f64::MAX),
        ("/stop/time", "s", 1e9),
    ] {
        let number = numbers.iter().find(|number| number.pointer == pointer).unwrap();
        assert_eq!((number.unit, number.bound.maximum), (unit, maximum), "{pointer}");
    }
    let place = |pointer| numbers.iter().position(|number| number.pointer == pointer).unwrap();
    assert!(place("/vehicle/mass") < place("/initial_state/speed"), "not in the order of the request");
}
