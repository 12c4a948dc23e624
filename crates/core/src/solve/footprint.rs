//! The ground that flights reach when numbers of a case vary: its outline, its area, and the landings that are farthest.
//!
//! Landings are compared on a plane that keeps areas. One number makes a curve. Of two, triangles of the range are mapped to the ground, whose
//! union is the footprint. Of more, from a place within it is found how far flights reach in every direction: what lies behind a bay of such a
//! footprint, seen from there, is not in it.

mod curve;
mod maximise;
mod mesh;
mod patch;
mod plane;
mod rays;
mod region;
mod survey;

pub use plane::{Plane, Point};
pub use region::{MapPolygon, Polygon, on_map};
pub use survey::{Fly, Landing, Outcome};

use crate::coordinates::Site;
use crate::elementary::{hypot, sin_cos};
use crate::planet::Shape;
use crate::solve::target::Number;
use crate::trajectory::Termination;
use curve::Curve;
use maximise::{Objective, maximise};
use mesh::Mesh;
use rays::StarDomain;
use region::{area, enclosed, hull};
use sobol_burley::sample;
use survey::{FlightIndex, Halt, Survey, distance};

/// How long a survey may go on, and how exact its outline is to be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Options {
    /// By how much the outline may be off, m; none for a thousandth of the extent of the first landings.
    pub resolution: Option<f64>,
    /// Flights at most.
    pub flights: usize,
}

/// A flight of the survey.
#[derive(Clone, Debug, PartialEq)]
pub struct SurveyFlight {
    /// The numbers.
    pub values: Vec<f64>,
    /// What the flight gave.
    pub outcome: Outcome,
}

/// The ground that flights reach.
#[derive(Clone, Debug)]
pub struct Footprint {
    /// The plane of its points; none where no flight lands.
    pub plane: Option<Plane>,
    /// What flights reach that keep all limits.
    pub outline: Vec<Polygon>,
    /// Of one number, where flights land that keep all limits, ascending: a line, or several where some do not.
    pub curve: Vec<Vec<Point>>,
    /// The convex hull of the landings that keep all limits.
    pub hull: Option<Vec<Point>>,
    /// Of the outline, m².
    pub area: f64,
    /// The flights with the least and the greatest downrange, and the least and the greatest crossrange, of those that keep all limits.
    pub extremes: [[Option<usize>; 2]; 2],
    /// All flights; the first is that of the case's own numbers.
    pub flights: Vec<SurveyFlight>,
    /// The part of the range with which flights land.
    pub landed: f64,
    /// The part of the range with which flights land and keep all limits.
    pub within_limits: f64,
    /// How flights ended.
    pub ends: Vec<Termination>,
    /// The resolution that was asked for, m.
    pub resolution: f64,
    /// By how much the outline may be off between the landings that locate it, m; none where that is not known.
    pub error: Option<f64>,
    /// Whether the flights or the time were used up.
    pub is_out_of_budget: bool,
}

/// Chords that are longer, m, are halved, whatever their middle: they may go around the planet.
const LONGEST: f64 = 8e5;
/// Rounds of halving at most.
const MOST_ROUNDS: usize = 7;
/// Flights of the first look at the range: of one number, and of three and more.
const SCAN: [u32; 2] = [33, 512];
/// The resolution where none is asked for, as a part of the extent of the first landings.
const RESOLUTION: f64 = 1e-3;
/// The least resolution, m: landings are hardly known better.
const FINEST: f64 = 1e-2;
/// The place in the family of scrambled sequences: any is as good.
const SEED: u32 = 1;

/// Surveys where flights land. `fly` flies numbers, and fewer once the time is over.
///
/// # Errors
/// Those of `fly`.
pub fn footprint<E>(numbers: &[Number], shape: &Shape, options: Options, fly: &mut Fly<E>) -> Result<Footprint, E> {
    let mut state = State {
        survey: Survey::new(numbers, options.flights, fly),
        shape,
        options,
        outline: Outline::None,
        scan: 0..0,
        resolution: options.resolution.unwrap_or_default(),
    };
    match state.run() {
        Ok(()) => Ok(state.told(false)),
        Err(Halt::Budget) => Ok(state.told(true)),
        Err(Halt::Failed(error)) => Err(error),
    }
}

/// How the outline is found.
enum Outline {
    None,
    Curve(Curve),
    Mesh(Box<Mesh>),
    StarDomain(StarDomain),
}

struct State<'a, 'b, E> {
    survey: Survey<'b, E>,
    shape: &'a Shape,
    options: Options,
    outline: Outline,
    /// The flights of the first look at the range.
    scan: std::ops::Range<FlightIndex>,
    resolution: f64,
}

impl<E> State<'_, '_, E> {
    fn run(&mut self) -> Result<(), Halt<E>> {
        let survey = &mut self.survey;
        let start = survey.start();
        survey.fly(start)?;
        let mut curve = Vec::new();
        match survey.numbers.len() {
            1 => {
                let places = (0..SCAN[0]).map(|index| vec![f64::from(index) / f64::from(SCAN[0] - 1)]);
                curve.extend(survey.fly_all(places.collect())?);
            }
            2 => self.outline = Outline::Mesh(Box::new(Mesh::scan(survey)?)),
            count => {
                #[expect(clippy::cast_possible_truncation, reason = "eight numbers at most")]
                let place = |index| (0..count as u32).map(move |axis| f64::from(sample(index, axis, SEED)));
                survey.fly_all((0..SCAN[1]).map(|index| place(index).collect()).collect())?;
            }
        }
        self.scan = 1..survey.flights.len();
        if self.find_plane().is_none() {
            return Ok(());
        }
        let survey = &mut self.survey;
        let extent = extent(survey);
        self.resolution = self.options.resolution.unwrap_or(RESOLUTION * extent).max(FINEST);
        let resolution = self.resolution;
        match &mut self.outline {
            Outline::Mesh(mesh) => mesh.refine(survey, resolution)?,
            _ if survey.numbers.len() == 1 => {
                self.outline = Outline::Curve(Curve::new(curve, resolution));
                if let Outline::Curve(curve) = &mut self.outline {
                    curve.refine(survey)?;
                }
            }
            _ => {
                if let Some(star) = StarDomain::new(survey, resolution) {
                    self.outline = Outline::StarDomain(star);
                }
                if let Outline::StarDomain(star) = &mut self.outline {
                    star.reach(survey)?;
                }
            }
        }
        for direction in RangeObjective::all(extent) {
            let Some(start) = self.farthest(&direction) else { continue };
            maximise(&mut self.survey, start, &direction, 0.1 * resolution / extent.max(resolution))?;
        }
        Ok(())
    }

    /// Where landings are compared; none where no flight lands.
    fn find_plane(&mut self) -> Option<Plane> {
        if self.survey.plane.is_none() {
            self.survey.plane = self.centre().map(|centre| Plane::about(&centre, self.shape));
        }
        self.survey.plane
    }

    /// Where the plane touches the planet: where the case itself lands or, where it does not, amid the landings.
    fn centre(&self) -> Option<Site> {
        let landing = |flight: &survey::Flight| flight.outcome.landing.map(|landing| landing.site);
        if let Some(site) = self.survey.flights.first().and_then(landing) {
            return Some(site);
        }
        let sites: Vec<_> = self.survey.flights.iter().filter_map(landing).collect();
        // That which is nearest to all, by the sum of the squares of the chords.
        let direction = |site: &Site| {
            let (sine, cosine) = sin_cos(site.geodetic_latitude);
            let (east, ahead) = sin_cos(site.longitude);
            [cosine * ahead, cosine * east, sine]
        };
        let sum = sites.iter().map(direction).fold([0.0; 3], |sum, it| [0, 1, 2].map(|axis| sum[axis] + it[axis]));
        let towards = |site: &&Site| direction(site).iter().zip(sum).map(|(it, sum)| it * sum).sum::<f64>();
        sites.iter().max_by(|one, other| towards(one).total_cmp(&towards(other))).copied()
    }

    /// The flight that is farthest, of those that keep all limits.
    fn farthest(&self, direction: &RangeObjective) -> Option<FlightIndex> {
        let value = |flight: &FlightIndex| direction.value(&self.survey, *flight);
        let kept =
            (0..self.survey.flights.len()).filter(|flight| self.survey.keeps(*flight) && value(flight).is_some());
        kept.max_by(|one, other| value(one).unwrap_or(f64::NAN).total_cmp(&value(other).unwrap_or(f64::NAN)))
    }

    fn told(mut self, is_out_of_budget: bool) -> Footprint {
        self.find_plane();
        if self.scan.is_empty() {
            self.scan = 1..self.survey.flights.len();
        }
        // Those at which a maximum was found are among the flights.
        let [nearest, farthest, left, right] = RangeObjective::all(1.0).map(|direction| self.farthest(&direction));
        let extremes = [[nearest, farthest], [left, right]];
        let points = (0..self.survey.flights.len()).filter_map(|flight| self.survey.kept_point(flight));
        let hull = hull(points);
        let Self { survey, outline, scan, resolution, .. } = self;
        let least = resolution * resolution;
        let mut curve = Vec::new();
        let (outline, error) = match &outline {
            Outline::None => (Vec::new(), if is_out_of_budget { f64::INFINITY } else { 0.0 }),
            Outline::Curve(found) => {
                curve = found.lines(&survey);
                let closed = match &curve[..] {
                    [line] => closed(line, resolution),
                    _ => None,
                };
                (closed.map(|ring| enclosed(&ring, least)).unwrap_or_default(), found.error())
            }
            Outline::Mesh(mesh) => mesh.outline(&survey),
            Outline::StarDomain(star) => (enclosed(&star.ring(&survey), least), star.error()),
        };
        #[expect(clippy::cast_precision_loss, reason = "hundreds of flights")]
        let share = |counted: fn(&Outcome) -> bool| {
            let counted = survey.flights[scan.clone()].iter().filter(|flight| counted(&flight.outcome)).count();
            counted as f64 / scan.len().max(1) as f64
        };
        Footprint {
            plane: survey.plane,
            hull,
            area: area(&outline),
            outline,
            curve,
            extremes,
            landed: share(|outcome| outcome.landing.is_some()),
            within_limits: share(Outcome::keeps),
            resolution,
            error: (survey.is_located && error.is_finite()).then_some(error),
            is_out_of_budget,
            flights: survey
                .flights
                .iter()
                .map(|flight| SurveyFlight { values: survey.values(&flight.place), outcome: flight.outcome })
                .collect(),
            ends: survey.ends,
        }
    }
}

/// The diagonal of the box around the landings that keep all limits, or around all where none does, m.
fn extent<E>(survey: &Survey<E>) -> f64 {
    let flights = 0..survey.flights.len();
    let mut points: Vec<_> = flights.clone().filter_map(|flight| survey.kept_point(flight)).collect();
    if points.is_empty() {
        points = flights.filter_map(|flight| survey.point(flight)).collect();
    }
    let side = |axis: usize| {
        let along = points.iter().map(|point| point[axis]);
        along.clone().fold(f64::NEG_INFINITY, f64::max) - along.fold(f64::INFINITY, f64::min)
    };
    hypot(side(0), side(1)).max(1.0)
}

/// The ring of a line whose ends are one place.
fn closed(line: &[Point], resolution: f64) -> Option<Vec<Point>> {
    let [first, .., last] = line else { return None };
    (distance(*first, *last) <= resolution).then(|| line[..line.len() - 1].to_vec())
}

/// The downrange or the crossrange, either way, in parts of a size.
struct RangeObjective {
    is_across: bool,
    sign: f64,
    size: f64,
}

impl RangeObjective {
    /// The least and the greatest downrange, the least and the greatest crossrange.
    fn all(size: f64) -> [Self; 4] {
        let range = |is_across: bool, sign: f64| Self { is_across, sign, size };
        [range(false, -1.0), range(false, 1.0), range(true, -1.0), range(true, 1.0)]
    }
}

impl<E> Objective<E> for RangeObjective {
    fn value(&self, survey: &Survey<E>, flight: FlightIndex) -> Option<f64> {
        let landing = survey.flights[flight].outcome.landing?;
        let value = if self.is_across { landing.crossrange? } else { landing.downrange? };
        Some(self.sign * value / self.size)
    }

    fn offset(&self, _: &Survey<E>, _: FlightIndex) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::{Footprint, Landing, Options, Outcome, Plane, Point, footprint};
    use crate::coordinates::Site;
    use crate::planet::Planet;
    use crate::solve::target::Number;
    use crate::trajectory::Termination;

    fn number(least: f64, greatest: f64) -> Number {
        Number { between: [least, greatest], scale: 1.0, start: 0.5 * (least + greatest), is_cyclic: false }
    }

    /// The footprint of numbers that lead to points of a plane about a place, in km, with a margin; none where nothing lands.
    fn of(
        centre: Site,
        numbers: &[Number],
        resolution: f64,
        map: impl Fn(&[f64]) -> Option<(Point, f64)>,
    ) -> Footprint {
        let shape = Planet::EARTH_WGS84.shape;
        let plane = Plane::about(&centre, &shape);
        let outcome = |values: &Vec<f64>| {
            let landed = map(values);
            let landing = landed.map(|([x, y], _)| Landing {
                site: plane.site([1e3 * x, 1e3 * y]),
                downrange: Some(1e3 * x),
                crossrange: Some(1e3 * y),
            });
            let end = Some(if landed.is_some() { Termination::SurfaceImpact } else { Termination::AtmosphereExit });
            Outcome { end, landing, margin: landed.map_or(f64::INFINITY, |landed| landed.1) }
        };
        let mut fly = |all: &[Vec<f64>]| Ok::<_, ()>(all.iter().map(outcome).collect());
        let options = Options { resolution: Some(resolution), flights: 20_000 };
        footprint(numbers, &shape, options, &mut fly).unwrap_or_else(|()| unreachable!("no flight fails"))
    }

    /// A quarter of a ring: r and φ.
    fn ring(it: &[f64]) -> Point {
        [it[0] * it[1].cos(), it[0] * it[1].sin()]
    }

    const RING: [[f64; 2]; 2] = [[100.0, 200.0], [0.0, 0.5 * PI]];

    const PLACES: [Site; 3] = [
        Site { longitude: 0.2, geodetic_latitude: 0.5 },
        Site { longitude: PI - 1e-3, geodetic_latitude: -0.2 },
        Site { longitude: 0.0, geodetic_latitude: 1.57 },
    ];

    fn is_near(found: f64, expected: f64, part: f64) {
        assert!((found / expected - 1.0).abs() < part, "{found} is not {expected}");
    }

    #[test]
    fn a_bent_sheet_has_its_area_at_any_place() {
        for place in PLACES {
            let found = of(place, &RING.map(|[least, greatest]| number(least, greatest)), 100.0, |it| {
                Some((ring(it), f64::INFINITY))
            });
            is_near(found.area, 0.25 * PI * (4e10 - 1e10), 1e-3);
            assert!(
                found.error.is_some_and(|error| error <= 100.0)
                    && found.outline.len() == 1
                    && found.flights.len() < 3000,
                "{}",
                found.flights.len()
            );
            let [[least, _], [_, right]] = found.extremes;
            let value = |index: Option<usize>| found.flights[index.unwrap_or_default()].outcome.landing;
            assert!(value(least).and_then(|it| it.downrange).is_some_and(|it| it.abs() < 1e-6));
            assert!(value(right).and_then(|it| it.crossrange).is_some_and(|it| (it - 2e5).abs() < 1e-6));
        }
    }

    #[test]
    fn an_outline_is_as_exact_as_is_asked() {
        let found = of(PLACES[0], &RING.map(|[least, greatest]| number(least, greatest)), 5.0, |it| {
            Some((ring(it), f64::INFINITY))
        });
        is_near(found.area, 0.25 * PI * (4e10 - 1e10), 1e-4);
        assert!(found.error.is_some_and(|error| error <= 5.0), "{:?}", found.error);
    }

    /// Limits that are kept between the first flights alone.
    #[test]
    fn a_strip_narrower_than_the_first_triangles_is_found() {
        let numbers = [number(0.0, 1.0), number(0.0, 1.0)];
        let found =
            of(PLACES[0], &numbers, 50.0, |it| Some(([100.0 * it[0], 100.0 * it[1]], 0.02 - (it[0] - 0.53).abs())));
        is_near(found.area, 0.04 * 1e10, 1e-2);
    }

    #[test]
    fn where_flights_run_out_the_outline_is_that_of_what_was_examined() {
        let shape = Planet::EARTH_WGS84.shape;
        let plane = Plane::about(&PLACES[0], &shape);
        let numbers = [number(-1.0, 1.0), number(-1.0, 1.0)];
        let outcome = |values: &Vec<f64>| {
            let site = plane.site([0, 1].map(|axis| 1e5 * values[axis]));
            let landing = Some(Landing { site, downrange: None, crossrange: None });
            let margin = 0.49 - values[0] * values[0] - values[1] * values[1];
            Outcome { end: Some(Termination::SurfaceImpact), landing, margin }
        };
        let mut fly = |all: &[Vec<f64>]| Ok::<_, ()>(all.iter().map(outcome).collect());
        let mut of = |flights: usize| {
            let options = Options { resolution: Some(1.0), flights };
            let found =
                footprint(&numbers, &shape, options, &mut fly).unwrap_or_else(|()| unreachable!("no flight fails"));
            assert!(found.is_out_of_budget && found.flights.len() == flights, "{flights}");
            found
        };
        // Amid the first look at the range, and amid the first triangles: nothing is known of the error.
        for flights in [1, 100, 1100, 1200] {
            assert!(of(flights).error.is_none(), "{flights}");
        }
        // Amid later ones: those before them are whole.
        for flights in (1800..3000).step_by(100) {
            let found = of(flights);
            is_near(found.area, PI * 0.49e10, 1e-3);
            assert!(found.error.is_some_and(|error| error > 1.0 && error < 200.0), "{flights}: {:?}", found.error);
        }
    }

    /// The fold of y = v² - u v, beyond which nothing lands, is the parabola y = -u²/4.
    #[test]
    fn a_fold_is_an_edge() {
        let found = of(PLACES[0], &[number(0.0, 1.0), number(0.0, 1.0)], 50.0, |it| {
            Some(([100.0 * it[0], 100.0 * (it[1] * it[1] - it[0] * it[1])], f64::INFINITY))
        });
        // Above it the greater of the ends, which is 1 - u or 0.
        is_near(found.area, 1e10 * (0.5 + 1.0 / 12.0), 2e-3);
    }

    #[test]
    fn limits_and_flights_that_do_not_land_cut_the_sheet() {
        let numbers = [number(-1.0, 1.0), number(-1.0, 1.0)];
        let disc = |it: &[f64]| 0.49 - it[0] * it[0] - it[1] * it[1];
        let point = |it: &[f64]| [100.0 * it[0], 100.0 * it[1]];
        let limited = of(PLACES[0], &numbers, 100.0, |it| Some((point(it), disc(it))));
        is_near(limited.area, PI * 0.49e10, 1e-3);
        assert!(limited.flights.len() < 4000, "{} flights", limited.flights.len());
        let [_, [left, right]] = limited.extremes;
        for (flight, expected) in [(left, -7e4), (right, 7e4)] {
            let value = limited.flights[flight.unwrap_or_default()].outcome.landing.and_then(|it| it.crossrange);
            assert!(value.is_some_and(|value| (value - expected).abs() < 10.0), "{value:?} is not {expected}");
        }
        let again = of(PLACES[0], &numbers, 100.0, |it| Some((point(it), disc(it))));
        assert!(again.flights == limited.flights, "other flights the second time");
        let landing = of(PLACES[0], &numbers, 100.0, |it| (disc(it) > 0.0).then(|| (point(it), f64::INFINITY)));
        is_near(landing.area, PI * 0.49e10, 1e-3);
        is_near(landing.landed, PI * 0.49 / 4.0, 0.05);
        assert!(landing.ends.len() == 2);
        // What is outside of the disc is a hole then.
        let hole = of(PLACES[0], &numbers, 100.0, |it| Some((point(it), -disc(it))));
        is_near(hole.area, 4e10 - PI * 0.49e10, 1e-3);
        assert!(hole.outline.len() == 1 && hole.outline[0].len() == 2);
    }

    /// Beside the flights that leave, landings go on without bound: how far, is not known.
    #[test]
    fn an_outline_that_is_not_located_has_no_error() {
        let numbers = [number(0.0, 1.0), number(0.0, 1.0)];
        let found = of(PLACES[0], &numbers, 1000.0, |it| {
            (it[0] < 0.503).then(|| ([-20.0 * (0.503 - it[0]).ln(), 100.0 * it[1]], f64::INFINITY))
        });
        assert!(found.error.is_none() && found.area > 1e9, "{:?}", found.error);
        let line = of(PLACES[0], &numbers[..1], 1000.0, |it| {
            (it[0] < 0.503).then(|| ([-20.0 * (0.503 - it[0]).ln(), 0.0], f64::INFINITY))
        });
        assert!(line.error.is_none() && line.curve.len() == 1);
        // A jump between landings on either side of a line is never straight.
        let jump = of(PLACES[0], &numbers, 1000.0, |it| {
            Some(([100.0 * it[0] + if it[0] > 0.503 { 1000.0 } else { 0.0 }, 100.0 * it[1]], f64::INFINITY))
        });
        assert!(jump.error.is_none_or(|error| error > 1000.0), "{:?}", jump.error);
    }

    #[test]
    fn one_number_makes_a_curve_and_what_it_encloses() {
        let circle = |it: &[f64]| Some(([100.0 * it[0].cos(), 100.0 * it[0].sin()], f64::INFINITY));
        let found = of(PLACES[0], &[number(0.0, 2.0 * PI)], 100.0, circle);
        is_near(found.area, PI * 1e10, 2e-3);
        assert!(found.curve.len() == 1 && found.flights.len() < 200);
        let half = of(PLACES[0], &[number(0.0, PI)], 100.0, circle);
        assert!(half.area == 0.0 && half.outline.is_empty() && half.hull.is_some());
        let parts =
            of(PLACES[0], &[number(0.0, 2.0 * PI)], 100.0, |it| circle(it).map(|(point, _)| (point, point[1] - 50.0)));
        let length: f64 =
            parts.curve.iter().flat_map(|line| line.windows(2).map(|pair| super::distance(pair[0], pair[1]))).sum();
        assert_eq!(parts.curve.len(), 1);
        is_near(length, 1e5 * PI * 2.0 / 3.0, 1e-3);
    }

    /// The sum of three sides is a hexagon.
    #[test]
    fn of_three_numbers_the_reach_in_every_direction_is_found() {
        let numbers = [number(-1.0, 1.0), number(-1.0, 1.0), number(-1.0, 1.0)];
        let hexagon = |it: &[f64]| [100.0 * (it[0] + 0.5 * it[2]), 100.0 * (it[1] + 0.5 * it[2])];
        let found = of(PLACES[0], &numbers, 500.0, |it| Some((hexagon(it), f64::INFINITY)));
        // |a × b| summed over the pairs of the sides.
        is_near(found.area, 4.0 * 1e10 * (1.0 + 0.5 + 0.5), 1e-2);
        let limited = of(PLACES[0], &numbers, 500.0, |it| {
            let [x, y] = hexagon(it);
            Some(([x, y], 1.0 - x.hypot(y) / 80.0))
        });
        is_near(limited.area, PI * 0.64e10, 2e-3);
        let [_, [_, right]] = limited.extremes;
        let right = limited.flights[right.unwrap_or_default()].outcome.landing.and_then(|it| it.crossrange);
        assert!(right.is_some_and(|right| (right - 8e4).abs() < 50.0), "{right:?}");
    }

    #[test]
    fn where_nothing_lands_there_is_nothing() {
        let found = of(PLACES[0], &[number(0.0, 1.0), number(0.0, 1.0)], 100.0, |_| None);
        assert!(found.outline.is_empty() && found.landed == 0.0 && found.plane.is_none() && !found.is_out_of_budget);
    }
}
