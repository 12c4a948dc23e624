//! The end of the flight where the altitude falls to the stop altitude.

use nalgebra::Vector3;
use num_dual::Dual64;

use super::detector::Detector;
use super::step_view::StepView;
use crate::integrate::event::{self, Inside, PredictedCrossing};
use crate::motion::{Forces, Formulation, StateRate};
use crate::planet::Shape;
use crate::scalar::Scalar;

/// Detects the fall to the stop altitude.
#[derive(Clone, Copy)]
pub(super) struct StopAltitudeDetector {
    shape: Shape,
    /// m, along the radius vector.
    stop_altitude: f64,
    /// The height above the stop altitude, with its rate, at the end of the last step.
    height: Dual64,
    /// The same at its start, with its length, s.
    before: Option<(f64, Dual64)>,
}

impl StopAltitudeDetector {
    pub(super) fn new(shape: Shape, stop_altitude: f64, start: &StateRate) -> Self {
        let mut detector = Self { shape, stop_altitude, height: Dual64::from(0.0), before: None };
        detector.go_to(start);
        detector
    }

    /// The flight leaves the stop altitude upward, even where rounding gives it no rate, or a falling one.
    pub(super) fn start_upward(&mut self) {
        self.height.eps = self.height.eps.max(f64::MIN_POSITIVE);
    }

    /// Keeps the height at an instant.
    pub(super) fn go_to(&mut self, now: &StateRate) {
        self.height = self.height_at(now);
        self.before = None;
    }

    /// What was read before the present instant tells nothing of what comes.
    pub(super) fn forget(&mut self) {
        self.before = None;
    }

    /// Whether nothing happens in a step of a length, s, with an altitude at its end, m.
    pub(super) fn is_quiet(&self, altitude: Dual64, length: f64) -> bool {
        event::stays_above(self.height, altitude - self.stop_altitude, length)
    }

    /// Goes on to the end of a step of a length, s, by the altitude there, m.
    pub(super) fn go_on(&mut self, altitude: Dual64, length: f64) {
        self.before = Some((length, self.height));
        self.height = altitude - self.stop_altitude;
    }

    /// The height above the stop altitude, m, with its rate.
    pub(super) fn height_at(&self, now: &StateRate) -> Dual64 {
        self.height_of(&now.state.position)
    }

    fn height_of<S: Scalar>(&self, position: &Vector3<S>) -> S {
        self.shape.altitude(position) - self.stop_altitude
    }
}

/// The height above the stop altitude in a step, m.
struct HeightInside<'a, 'b, F, const N: usize> {
    detector: &'a StopAltitudeDetector,
    step: &'a StepView<'b, F, N>,
}

impl<F: Formulation<N>, const N: usize> Inside for HeightInside<'_, '_, F, N> {
    fn at(&self, part: f64) -> Dual64 {
        self.detector.height_of(&self.step.position_inside(part))
    }

    fn value_at(&self, part: f64) -> f64 {
        self.detector.height_of(&self.step.state_inside(part).state.position)
    }
}

impl Detector for StopAltitudeDetector {
    type Located = ();

    /// The first crossing downwards, a dip inside the step included.
    fn locate<F: Formulation<N>, const N: usize>(&self, step: &StepView<F, N>) -> Option<(f64, ())> {
        let end = step.altitude_at_end() - self.stop_altitude;
        let part = event::first_fall(self.height, end, step.length(), &HeightInside { detector: self, step })?;
        Some((part, ()))
    }

    fn ahead(&self, (): (), _: &Forces, now: &StateRate) -> Dual64 {
        self.height_at(now)
    }

    fn predict(&self, _: &Forces, within: f64) -> Option<PredictedCrossing> {
        event::predicted_fall(self.height, self.before, within)
    }

    fn follow<F: Formulation<N>, const N: usize>(&mut self, step: &StepView<F, N>) {
        self.go_on(step.altitude_at_end(), step.length());
    }
}
