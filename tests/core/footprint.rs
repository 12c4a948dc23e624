//! Footprints of flights: beside a dense grid of the tests' own on another equal-area map, and by landings that must lie within.

use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::atomic::AtomicBool;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use reentry::coordinates::Site;
use reentry::planet::Shape;
use reentry::simulate::extremes;
use reentry::solve::footprint::{Footprint, Landing, Options, Outcome, Point, footprint};
use reentry::solve::target::Number;
use reentry::trajectory::Termination;
use reentry::{Case, Control, FlightPath, Scenario};

use crate::core::flights::{glide, with_tolerance};

/// A glider whose bank angle and speed vary.
fn glider(values: &[f64]) -> Case {
    let path = FlightPath::from_planet_fixed(&glide().initial_state);
    let state = FlightPath { speed: values[1], flight_path_angle: -0.1, ..path };
    let case = Case { initial_state: state.to_planet_fixed(), control: Control::banked(values[0]), ..glide() };
    with_tolerance(case, 1e-7)
}

const BETWEEN: [[f64; 2]; 2] = [[-1.5, 1.5], [6600.0, 7600.0]];

/// What a flight gives that must keep a load limit, g.
fn outcome(case: Case, limit: f64) -> Outcome {
    let flight = extremes(&Scenario::new(case).unwrap(), &AtomicBool::new(false)).unwrap();
    let end = flight.termination();
    let last = flight.last();
    let landing = (end == Termination::SurfaceImpact).then_some(Landing {
        site: Site { longitude: last.flight_path.longitude, geodetic_latitude: last.geodetic_latitude },
        downrange: Some(last.ground_range),
        crossrange: last.crossrange,
    });
    Outcome { end: Some(end), landing, margin: 1.0 - flight.peaks().load_factor.value / limit }
}

fn survey(between: &[[f64; 2]], resolution: f64, limit: f64, case: impl Fn(&[f64]) -> Case) -> Footprint {
    let number = |between: &[f64; 2]| {
        let [least, greatest] = *between;
        Number { between: *between, scale: greatest - least, start: 0.5 * (least + greatest), is_cyclic: false }
    };
    let numbers: Vec<_> = between.iter().map(number).collect();
    let mut fly = |values: &[Vec<f64>]| Ok::<_, ()>(values.iter().map(|values| outcome(case(values), limit)).collect());
    let options = Options { resolution: Some(resolution), flights: 20_000 };
    footprint(&numbers, &glide().planet.shape, options, &mut fly).unwrap()
}

/// The area of the surface between the equator and a latitude a radian of longitude wide, m², by Simpson's rule over the meridian.
fn zone(shape: &Shape, latitude: f64) -> f64 {
    let (a, b) = shape.semi_axes();
    let squared = 1.0 - (b / a).powi(2);
    let density = |latitude: f64| {
        let (sine, cosine) = latitude.sin_cos();
        b * b * cosine / (1.0 - squared * sine * sine).powi(2)
    };
    let panels = 64;
    let half = latitude / f64::from(2 * panels);
    let at = |index: i32| density(f64::from(index) * half);
    (0..panels).map(|panel| at(2 * panel) + 4.0 * at(2 * panel + 1) + at(2 * panel + 2)).sum::<f64>() * half / 3.0
}

/// The area of what triangles cover, by counting squares whose middle is in one.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "places of squares")]
fn counted(triangles: &[[Point; 3]], squares: u32) -> f64 {
    let of_all = |axis: usize| triangles.iter().flatten().map(move |point| point[axis]);
    let [low, high] =
        [f64::min as fn(f64, f64) -> f64, f64::max].map(|of| [0, 1].map(|axis| of_all(axis).reduce(of).unwrap()));
    let width = [0, 1].map(|axis| (high[axis] - low[axis]) / f64::from(squares));
    let mut covered = vec![false; (squares * squares) as usize];
    for triangle in triangles {
        let square = |axis: usize, of: fn(f64, f64) -> f64| {
            let end = triangle.iter().map(|point| point[axis]).reduce(of).unwrap();
            (((end - low[axis]) / width[axis]) as u32).min(squares - 1)
        };
        for up in square(1, f64::min)..=square(1, f64::max) {
            for right in square(0, f64::min)..=square(0, f64::max) {
                let middle = [low[0] + (f64::from(right) + 0.5) * width[0], low[1] + (f64::from(up) + 0.5) * width[1]];
                let side = |one: Point, next: Point| {
                    (next[0] - one[0]) * (middle[1] - one[1]) - (next[1] - one[1]) * (middle[0] - one[0])
                };
                let [a, b, c] = *triangle;
                let sides = [side(a, b), side(b, c), side(c, a)];
                let is_within = sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0);
                covered[(up * squares + right) as usize] |= is_within;
            }
        }
    }
    covered.iter().map(|it| f64::from(u8::from(*it))).sum::<f64>() * width[0] * width[1]
}

/// 72² flights, whose triangles are flat to a few ten metres, mapped by longitude and the area of the zone below the latitude.
#[test]
fn an_area_is_that_of_a_dense_grid() {
    let found = survey(&BETWEEN, 500.0, f64::INFINITY, glider);
    assert!(found.error.is_some_and(|error| error <= 500.0) && found.landed >= 1.0 && !found.is_out_of_budget);
    let shape = glide().planet.shape;
    let count = 72_u32;
    let part =
        |index: u32, [least, greatest]: [f64; 2]| least + f64::from(index) / f64::from(count - 1) * (greatest - least);
    let row = |up: u32| -> Vec<Point> {
        let landing =
            |right: u32| outcome(glider(&[part(right, BETWEEN[0]), part(up, BETWEEN[1])]), 1.0).landing.unwrap().site;
        (0..count).map(landing).map(|site| [site.longitude, zone(&shape, site.geodetic_latitude)]).collect()
    };
    let rows: Vec<_> = (0..count).map(row).collect();
    let mut triangles = Vec::new();
    for pair in rows.windows(2) {
        for (below, above) in pair[0].windows(2).zip(pair[1].windows(2)) {
            triangles.extend([[below[0], below[1], above[1]], [below[0], above[1], above[0]]]);
        }
    }
    let expected = counted(&triangles, 2000);
    assert!((found.area / expected - 1.0).abs() < 1e-3, "{} is not {expected}", found.area);
    assert!(found.flights.len() < 2500, "{} flights", found.flights.len());
}

/// Whether a point is in an outline, by how often a ray from it crosses the rings.
fn contains(found: &Footprint, [x, y]: Point) -> bool {
    let mut crossings = 0;
    for ring in found.outline.iter().flatten() {
        for (one, next) in ring.iter().zip(ring.iter().cycle().skip(1)) {
            if (one[1] > y) != (next[1] > y) && x < one[0] + (y - one[1]) / (next[1] - one[1]) * (next[0] - one[0]) {
                crossings += 1;
            }
        }
    }
    crossings % 2 == 1
}

/// The distance of a point from an outline, m.
fn off(found: &Footprint, point: Point) -> f64 {
    let rings = found.outline.iter().flatten();
    let edges = rings.flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let distance = |(one, next): (&Point, &Point)| {
        let along = [next[0] - one[0], next[1] - one[1]];
        let way = [point[0] - one[0], point[1] - one[1]];
        let part = (way[0] * along[0] + way[1] * along[1]) / along[0].mul_add(along[0], along[1] * along[1]);
        let part = part.clamp(0.0, 1.0);
        (way[0] - part * along[0]).hypot(way[1] - part * along[1])
    };
    edges.map(distance).fold(f64::INFINITY, f64::min)
}

/// Every landing that keeps the limits is in the footprint, or beyond it by no more than its accuracy; and none is farther than the extremes.
#[test]
fn random_landings_lie_within() {
    let two_banks = |values: &[f64]| glider(&[values[0], 7400.0]);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(11);
    // So that about half of the flights keep it: of a limit of 1 g, the margin is 1 less the load.
    let mut loads: Vec<f64> = (0..31)
        .map(|_| {
            1.0 - outcome(glider(&BETWEEN.map(|[least, greatest]| random.random_range(least..greatest))), 1.0).margin
        })
        .collect();
    loads.sort_by(f64::total_cmp);
    let limit = loads[15];
    let limited = survey(&BETWEEN, 1000.0, limit, glider);
    assert!(limited.within_limits > 0.1 && limited.within_limits < 0.95, "{}", limited.within_limits);
    let plane = limited.plane.unwrap();
    let mut kept = 0;
    for _ in 0..300 {
        let values = BETWEEN.map(|[least, greatest]| random.random_range(least..greatest));
        let flown = outcome(glider(&values), limit);
        if flown.margin < 0.0 {
            continue;
        }
        kept += 1;
        let landing = flown.landing.unwrap();
        let point = plane.point(&landing.site);
        assert!(
            contains(&limited, point) || off(&limited, point) <= 1000.0,
            "{values:?} is {} m off",
            off(&limited, point)
        );
        for ([least, greatest], value) in limited.extremes.into_iter().zip([landing.downrange, landing.crossrange]) {
            let end = |flight: Option<usize>, is_across: bool| {
                let landing = limited.flights[flight.unwrap()].outcome.landing.unwrap();
                if is_across { landing.crossrange.unwrap() } else { landing.downrange.unwrap() }
            };
            let is_across = value == landing.crossrange;
            let value = value.unwrap();
            // Within a tenth of the accuracy, to which extremes are looked for.
            assert!(value >= end(least, is_across) - 100.0 && value <= end(greatest, is_across) + 100.0, "{values:?}");
        }
    }
    assert!(kept > 50, "{kept} flights keep the limit");
    // One number: a line on which landings lie.
    let line = survey(&BETWEEN[..1], 200.0, f64::INFINITY, two_banks);
    let plane = line.plane.unwrap();
    assert!(line.area == 0.0 && line.curve.len() == 1 && line.flights.len() < 400, "{}", line.flights.len());
    for _ in 0..40 {
        let landing = outcome(two_banks(&[random.random_range(BETWEEN[0][0]..BETWEEN[0][1])]), 1.0).landing.unwrap();
        let point = plane.point(&landing.site);
        let near = line.curve[0].windows(2).map(|pair| {
            let length = (pair[1][0] - pair[0][0]).hypot(pair[1][1] - pair[0][1]);
            let along = [(pair[1][0] - pair[0][0]) / length, (pair[1][1] - pair[0][1]) / length];
            let way = [point[0] - pair[0][0], point[1] - pair[0][1]];
            let part = (way[0] * along[0] + way[1] * along[1]).clamp(0.0, length);
            (way[0] - part * along[0]).hypot(way[1] - part * along[1])
        });
        let near = near.fold(f64::INFINITY, f64::min);
        assert!(near <= 200.0, "{near} m off the curve");
    }
}

/// Of three numbers: the reach of two of them is within that of three, and random landings are within.
#[test]
fn of_three_numbers_random_landings_lie_within() {
    let between = [[-0.3, 0.3], [7200.0, 7400.0], [-0.12, -0.08]];
    let case = |values: &[f64]| {
        let path = FlightPath::from_planet_fixed(&glide().initial_state);
        let state = FlightPath { speed: values[1], flight_path_angle: values[2], ..path };
        let control = Control::banked(values[0]);
        with_tolerance(Case { initial_state: state.to_planet_fixed(), control, ..glide() }, 1e-7)
    };
    let found = survey(&between, 2000.0, f64::INFINITY, case);
    let plane = found.plane.unwrap();
    assert!(
        found.outline.len() == 1 && found.error.is_some_and(|error| error <= 2000.0),
        "{} {:?}",
        found.outline.len(),
        found.error
    );
    let mut random = Xoshiro256PlusPlus::seed_from_u64(12);
    for _ in 0..100 {
        let values = between.map(|[least, greatest]| random.random_range(least..greatest));
        let point = plane.point(&outcome(case(&values), 1.0).landing.unwrap().site);
        assert!(contains(&found, point) || off(&found, point) <= 2000.0, "{values:?} is {} m off", off(&found, point));
    }
}

#[test]
fn a_zone_is_that_of_the_sphere() {
    let sphere = Shape::Sphere { radius: 2.0 };
    assert!((zone(&sphere, FRAC_PI_2) - 4.0).abs() < 1e-9 && (zone(&sphere, PI / 6.0) - 2.0).abs() < 1e-9);
}
