//! The assertions: relative, and on the circle.

use std::f64::consts::TAU;

/// Fails unless `actual` lies within `tolerance` of `expected`; `what` says where the expectation comes from.
#[track_caller]
pub(crate) fn near(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let error = (actual - expected).abs();
    assert!(error <= tolerance, "{what}: {actual} is {error:e} from {expected}, more than {tolerance:e}");
}

/// Fails unless `actual` lies within `tolerance` of `expected`, in parts of it.
#[track_caller]
pub(crate) fn relative(what: &str, actual: f64, expected: f64, tolerance: f64) {
    near(what, actual, expected, tolerance * expected.abs());
}

/// Fails unless two angles in radians lie within `tolerance` of each other on the circle.
#[track_caller]
pub(crate) fn angle(what: &str, actual: f64, expected: f64, tolerance: f64) {
    let turn = (actual - expected).rem_euclid(TAU);
    let error = turn.min(TAU - turn);
    assert!(error <= tolerance, "{what}: {actual} is {error:e} from {expected}, more than {tolerance:e}");
}
