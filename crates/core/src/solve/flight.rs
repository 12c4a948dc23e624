//! A flight of a search, of which no more is kept than the search asks for.

use crate::integrate::Statistics;
use crate::interrupt::Interrupt;
use crate::scenario::Scenario;
use crate::sensitivity::{Moment, point_at};
use crate::simulate::{
    BodyError, Flights, SimulationError, ends_of_all, extremes_of_all, simulate, simulate_with_bodies,
};
use crate::trajectory::{Ends, Extremes, FlightPoint, Peaks, Termination, Trajectory};

/// What a search asks of its flights.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Extent {
    /// Their starts, ends and events.
    Ends,
    /// The same and their peaks.
    Extremes,
    /// Their states at any time, and what is measured along the ground track.
    Whole,
    /// The same, also of the bodies that leave the vehicle.
    WithBodies,
}

/// A finished flight.
#[derive(Clone, Debug)]
pub enum SearchFlight {
    /// Its ends.
    Ends(Ends),
    /// Its extremes.
    Extremes(Extremes),
    /// All of it.
    Whole(Trajectory),
    /// All of it, and the flights of the bodies that left the vehicle.
    WithBodies(Flights),
}

/// The flight of the vehicle or of a body, as far as the search has kept it.
#[derive(Clone, Copy, Debug)]
pub enum KeptFlight<'a> {
    /// Its ends.
    Ends(&'a Ends),
    /// Its extremes.
    Extremes(&'a Extremes),
    /// All of it.
    Whole(&'a Trajectory),
}

impl SearchFlight {
    /// Flies scenarios, in lanes where of their steps nothing is kept: each is as it would be alone.
    ///
    /// # Errors
    /// Those of [`simulate_with_bodies`].
    pub fn fly_all(scenarios: &[Scenario], extent: Extent, interrupt: &dyn Interrupt) -> Vec<Result<Self, BodyError>> {
        fn each<T>(
            flown: Vec<Result<T, SimulationError>>,
            of: fn(T) -> SearchFlight,
        ) -> Vec<Result<SearchFlight, BodyError>> {
            flown.into_iter().map(|flown| Ok(of(flown?))).collect()
        }
        match extent {
            Extent::Ends => each(ends_of_all(scenarios, interrupt), Self::Ends),
            Extent::Extremes => each(extremes_of_all(scenarios, interrupt), Self::Extremes),
            Extent::Whole => scenarios.iter().map(|scenario| Ok(Self::Whole(simulate(scenario, interrupt)?))).collect(),
            Extent::WithBodies => {
                let fly = |scenario| Ok(Self::WithBodies(simulate_with_bodies(scenario, interrupt)?));
                scenarios.iter().map(fly).collect()
            }
        }
    }

    /// The flight of the vehicle.
    pub fn vehicle(&self) -> KeptFlight<'_> {
        match self {
            Self::Ends(flight) => KeptFlight::Ends(flight),
            Self::Extremes(flight) => KeptFlight::Extremes(flight),
            Self::Whole(flight) => KeptFlight::Whole(flight),
            Self::WithBodies(flights) => KeptFlight::Whole(&flights.vehicle),
        }
    }

    /// The flight of a body, by the places of event and separation of it, after those of the bodies from which it comes; none where it did not leave,
    /// or bodies were not flown.
    pub fn body(&self, path: &[(usize, usize)]) -> Option<KeptFlight<'_>> {
        let Self::WithBodies(flights) = self else { return None };
        let place = (0..flights.bodies.len()).find(|place| flights.path(*place) == path)?;
        Some(KeptFlight::Whole(&flights.bodies[place].trajectory))
    }

    /// What the integration cost, that of all bodies included.
    pub fn statistics(&self) -> Statistics {
        match self {
            Self::Ends(flight) => flight.statistics(),
            Self::Extremes(flight) => flight.ends().statistics(),
            Self::Whole(flight) => flight.statistics(),
            Self::WithBodies(flights) => {
                flights.all().map(Trajectory::statistics).fold(Statistics::default(), |sum, one| Statistics {
                    steps: sum.steps + one.steps,
                    rejected_steps: sum.rejected_steps + one.rejected_steps,
                    evaluations: sum.evaluations + one.evaluations,
                })
            }
        }
    }
}

impl KeptFlight<'_> {
    /// How the flight ended.
    pub fn termination(self) -> Termination {
        match self {
            Self::Ends(flight) => flight.termination(),
            Self::Extremes(flight) => flight.termination(),
            Self::Whole(flight) => flight.termination(),
        }
    }

    /// The greatest values over the flight; none where they are not kept.
    pub fn peaks(&self) -> Option<&Peaks> {
        match self {
            Self::Ends(_) => None,
            Self::Extremes(flight) => Some(flight.peaks()),
            Self::Whole(flight) => Some(flight.peaks()),
        }
    }

    /// How far along the initial great circle the flight ended, within half a turn either way, and how far to the right of it, m on the sphere
    /// with the equatorial radius; none where the flight starts vertically or at rest.
    pub fn range_of_end(self) -> Option<[f64; 2]> {
        match self {
            Self::Ends(flight) => flight.range_of_end(),
            Self::Extremes(flight) => flight.ends().range_of_end(),
            Self::Whole(flight) => flight.range_of_end(),
        }
    }

    /// The point at a moment: at that of a peak, or of what is lowest, where `value` is; none where the flight has no such moment, and of
    /// ends and extremes none at a time, at a peak and at what is lowest.
    ///
    /// # Errors
    /// When the flag is raised.
    pub fn point(
        self,
        at: Moment,
        value: &dyn Fn(&FlightPoint) -> Option<f64>,
        interrupt: &dyn Interrupt,
    ) -> Result<Option<FlightPoint>, SimulationError> {
        let flight = match self {
            Self::Ends(flight) => flight,
            Self::Extremes(flight) => flight.ends(),
            Self::Whole(flight) => return point_at(flight, at, value, interrupt),
        };
        Ok(match at {
            Moment::Start => Some(flight.initial()),
            Moment::End => Some(flight.last()),
            Moment::Event { event, after } => {
                let happened = flight.events().find(|point| point.event == event);
                happened.map(|point| if after { point.after } else { point.before })
            }
            Moment::Time(_) | Moment::Peak | Moment::Lowest => None,
        })
    }
}
