//! Flights of which no steps are kept, with and without their peaks, beside the same flights with their steps: every digit of the ends, the events
//! and the peaks.

use std::fs;
use std::path::Path;
use std::sync::atomic::AtomicBool;

use proptest::prelude::*;
use reentry::Scenario;
use reentry::sensitivity::Moment;
use reentry::simulate::{ends, extremes, simulate};
use reentry::solve::flight::{Extent, SearchFlight};
use reentry::trajectory::{Arrival, EventPoint, FlightPoint};
use reentry_service::wire::scenario::{FlightRequest, RequestedOutput};
use reentry_tests::cases::read_json;

use crate::core::flights::{config, random_entry, spherical};

static NEVER: AtomicBool = AtomicBool::new(false);

/// The point without what is measured along the ground track.
fn off_track(point: &FlightPoint) -> FlightPoint {
    let mut point = *point;
    (point.downrange, point.ground_distance) = (None, f64::NAN);
    point
}

/// Fails unless both say the same, or fail with the same; returns how many events happened.
#[track_caller]
fn same(scenario: &Scenario) -> usize {
    let (alone, whole) = match (extremes(scenario, &NEVER), simulate(scenario, &NEVER)) {
        (Ok(alone), Ok(whole)) => (alone, whole),
        (alone, whole) => {
            assert_eq!(alone.err(), whole.err());
            return 0;
        }
    };
    // Debug output has all digits.
    let text = |value: &dyn std::fmt::Debug| format!("{value:?}");
    let without_peaks = ends(scenario, &NEVER).unwrap();
    for ends in [alone.ends(), &without_peaks] {
        assert_eq!(text(&ends.initial()), text(&off_track(&whole.initial())));
        assert_eq!(text(&ends.last()), text(&off_track(&whole.last())));
        // What it cost to find the peaks is not among it.
        let arrival = Arrival { statistics: whole.statistics(), ..*ends.arrival() };
        assert_eq!(text(&arrival), text(whole.arrival()));
    }
    assert_eq!(alone.termination(), whole.termination());
    assert_eq!(alone.ends().statistics(), whole.statistics());
    assert_eq!(text(&alone.peaks()), text(&whole.peaks()));
    let event_off_track = |EventPoint { event, before, after }: EventPoint| EventPoint {
        event,
        before: off_track(&before),
        after: off_track(&after),
    };
    let events: Vec<_> = whole.events().map(event_off_track).collect();
    for ends in [alone.ends(), &without_peaks] {
        assert_eq!(text(&ends.events().collect::<Vec<_>>()), text(&events));
    }
    events.len()
}

#[test]
fn examples_of_every_kind_end_the_same_without_their_steps() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../openapi/examples");
    let (mut flights, mut events) = (0, 0);
    for entry in fs::read_dir(folder).unwrap() {
        let request = read_json(&entry.unwrap().path());
        // Some are no cases of /simulate.
        let Ok(flight) = FlightRequest::try_from_tree(request, RequestedOutput::Answer) else { continue };
        events += same(&flight.scenario);
        flights += 1;
    }
    assert!(flights > 10 && events > 20, "{flights} flights with {events} events");
}

proptest! {
    #![proptest_config(config(100))]

    #[test]
    fn random_entries_end_the_same_without_their_steps(case in random_entry(), turned in any::<bool>()) {
        same(&Scenario::new(if turned { spherical(case) } else { case }).unwrap());
    }

    /// The points of a whole flight at its moments are those that it gives elsewhere.
    #[test]
    fn moments_are_those_of_the_flight(case in random_entry(), part in 0.1..0.9) {
        let scenario = Scenario::new(case).unwrap();
        let whole = simulate(&scenario, &NEVER).unwrap();
        let altitude = |point: &FlightPoint| Some(point.loads.altitude);
        let fly = |extent| SearchFlight::fly_all(std::slice::from_ref(&scenario), extent, &NEVER).remove(0).unwrap();
        let [kept, all] = [Extent::Extremes, Extent::Whole].map(fly);
        let point = |flown: &SearchFlight, at| flown.vehicle().point(at, &altitude, &NEVER).unwrap();
        prop_assert_eq!(point(&all, Moment::End).unwrap(), whole.last());
        prop_assert_eq!(point(&all, Moment::Start).unwrap(), whole.initial());
        let time = part * whole.end_time();
        prop_assert_eq!(point(&all, Moment::Time(time)).unwrap(), whole.at(time));
        let peak = whole.peaks().altitude;
        let highest = point(&all, Moment::Peak).unwrap();
        // Both locate it on the dense output, where it is flat.
        prop_assert!((highest.loads.altitude - peak.value).abs() < 1e-3);
        prop_assert!(point(&kept, Moment::Peak).is_none() && point(&kept, Moment::Time(time)).is_none());
        let event = Moment::Event { event: 0, after: true };
        prop_assert!(point(&kept, event).is_none());
    }
}
