//! A finished flight of which nothing is kept between its start, its events, its end and, where they are asked for, its peaks.

use std::sync::Arc;

use super::{Arrival, EventPoint, FlightPoint, Flown, Peaks, Termination, Trajectory};
use crate::integrate::Statistics;
use crate::scenario::Case;

/// A finished flight of which the start, the end and the events are known, to the same digits as those of a [`Trajectory`].
///
/// What is measured along the ground track is not known: of its points the downrange is none, and the ground distance not a number.
#[derive(Clone, Debug)]
pub struct Ends(Trajectory);

impl Ends {
    pub(crate) fn new(case: Arc<Case>, flown: Flown) -> Self {
        Self(Trajectory::unexamined(case, flown))
    }

    /// How the flight ended.
    pub fn termination(&self) -> Termination {
        self.0.termination()
    }

    /// Where and how it ended.
    pub fn arrival(&self) -> &Arrival {
        self.0.arrival()
    }

    /// What the integration cost.
    pub fn statistics(&self) -> Statistics {
        self.0.statistics()
    }

    /// The initial state, as given: before what happens at t = 0.
    pub fn initial(&self) -> FlightPoint {
        without_track(&self.0.initial())
    }

    /// The final state, after what happens then.
    pub fn last(&self) -> FlightPoint {
        without_track(&self.0.last())
    }

    pub(crate) fn range_of_end(&self) -> Option<[f64; 2]> {
        self.0.range_of_end()
    }

    /// The events that happened, in order.
    pub fn events(&self) -> impl Iterator<Item = EventPoint> {
        self.0.events().map(|EventPoint { event, before, after }| EventPoint {
            event,
            before: without_track(&before),
            after: without_track(&after),
        })
    }
}

/// The same with the peaks.
#[derive(Clone, Debug)]
pub struct Extremes(Ends);

impl Extremes {
    pub(crate) fn new(case: Arc<Case>, flown: Flown) -> Self {
        Self(Ends::new(case, flown))
    }

    /// What is known of it without the peaks.
    pub fn ends(&self) -> &Ends {
        &self.0
    }

    /// The greatest values over the flight.
    pub fn peaks(&self) -> &Peaks {
        self.0.0.peaks()
    }

    /// How the flight ended.
    pub fn termination(&self) -> Termination {
        self.0.termination()
    }

    /// Where and how it ended.
    pub fn arrival(&self) -> &Arrival {
        self.0.arrival()
    }

    /// The final state, after what happens then.
    pub fn last(&self) -> FlightPoint {
        self.0.last()
    }
}

/// The point without what the ground track tells of it.
fn without_track(point: &FlightPoint) -> FlightPoint {
    FlightPoint { downrange: None, ground_distance: f64::NAN, ..*point }
}
