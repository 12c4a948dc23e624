//! Polygons of the plane: their union, area, convex hull, and what lies near their edge.

use std::collections::{BTreeMap, HashSet};
use std::f64::consts::{FRAC_PI_2, PI, TAU};

use i_overlay::core::fill_rule::FillRule;
use i_overlay::core::overlay_rule::OverlayRule;
use i_overlay::core::solver::Solver;
use i_overlay::float::overlay::OverlayOptions;
use i_overlay::float::simplify::SimplifyShape;
use i_overlay::float::single::SingleFloatOverlay;

use super::plane::{Plane, Point};
use crate::elementary::hypot;

/// A polygon: its outer ring, counterclockwise, and its holes, clockwise; no ring repeats its first point.
pub type Polygon = Vec<Vec<Point>>;

/// A polygon on a map of longitude and latitude, rad: its outer ring, counterclockwise, and its holes, clockwise; no ring repeats its first point.
pub type MapPolygon = Vec<Vec<[f64; 2]>>;

/// Polygons of the plane on a map of longitude and geodetic latitude, both in rad, whose edges are straight there: cut at the antimeridian, and led
/// along the edge of the map where there is a pole within.
pub fn on_map(polygons: &[Polygon], plane: &Plane) -> Vec<MapPolygon> {
    let mut rings = Vec::new();
    for ring in polygons.iter().flatten() {
        let ring = unrolled(ring, plane);
        for turn in [-TAU, 0.0, TAU] {
            rings.push(ring.iter().map(|[longitude, latitude]| [longitude + turn, *latitude]).collect::<Vec<_>>());
        }
    }
    let map = [[-PI, -FRAC_PI_2], [PI, -FRAC_PI_2], [PI, FRAC_PI_2], [-PI, FRAC_PI_2]].to_vec();
    let mut cut = rings.overlay_as::<i64>(&map, OverlayRule::Intersect, FillRule::NonZero);
    // The cut rounds to a grid of its own, and may lie beyond the edge by that.
    for [longitude, latitude] in cut.iter_mut().flatten().flatten() {
        *longitude = longitude.clamp(-PI, PI);
        *latitude = latitude.clamp(-FRAC_PI_2, FRAC_PI_2);
    }
    cut
}

/// Longer edges, m, are divided: what is straight on the plane is bent on the map.
const LONGEST_EDGE: f64 = 5e4;

/// The longitudes and latitudes of a ring, without jumps of the longitude: of a ring about a pole, closed by way of the pole.
fn unrolled(ring: &[Point], plane: &Plane) -> Vec<[f64; 2]> {
    let mut places: Vec<[f64; 2]> = Vec::new();
    for (one, next) in ring.iter().zip(ring.iter().cycle().skip(1)) {
        let parts = (hypot(next[0] - one[0], next[1] - one[1]) / LONGEST_EDGE).ceil().max(1.0);
        let mut part = 0.0;
        while part < parts {
            let between = |axis: usize| one[axis] + part / parts * (next[axis] - one[axis]);
            let site = plane.site([between(0), between(1)]);
            let before = places.last().map_or(site.longitude, |place| place[0]);
            let turns = ((before - site.longitude) / TAU).round();
            places.push([site.longitude + turns * TAU, site.geodetic_latitude]);
            part += 1.0;
        }
    }
    if let [first, .., last] = places[..] {
        let turn = last[0] + (first[0] - last[0] - TAU * ((first[0] - last[0]) / TAU).round()) - first[0];
        if turn.abs() > PI {
            // Eastward, an outer ring has the north pole to the left, and a hole that it leaves out goes westward.
            let is_hole = ring_area(ring) < 0.0;
            let pole = if (turn > 0.0) == is_hole { -FRAC_PI_2 } else { FRAC_PI_2 };
            places.extend([[first[0] + turn, first[1]], [first[0] + turn, pole], [first[0], pole]]);
        }
    }
    places
}

/// What any of the polygons covers, whichever way around each goes, without pieces and holes that are smaller than `least` m².
///
/// Where polygons lie side by side, the segments between them are left out first, which changes the winding number of no point: of a sheet of
/// thousands of polygons its rim is left.
pub(super) fn union(polygons: &[Vec<Point>], least: f64) -> Vec<Polygon> {
    let mut segments = Segments::default();
    for polygon in polygons {
        let is_clockwise = ring_area(polygon) < 0.0;
        for (one, next) in polygon.iter().zip(polygon.iter().cycle().skip(1)) {
            if is_clockwise {
                segments.add(*next, *one);
            } else {
                segments.add(*one, *next);
            }
        }
    }
    simplified(&segments.into_rings(), least)
}

/// Directed segments, of which as many end at every point as begin there. Those that are the opposite of one another are left out.
#[derive(Default)]
struct Segments {
    /// The ends of those that begin at a point.
    from: BTreeMap<PointKey, Vec<Point>>,
}

/// The digits of a point.
type PointKey = [u64; 2];

fn key(point: Point) -> PointKey {
    // Of the two zeros there is one.
    point.map(|coordinate| (coordinate + 0.0).to_bits())
}

impl Segments {
    fn add(&mut self, one: Point, other: Point) {
        if key(one) == key(other) {
            return;
        }
        if let Some(ends) = self.from.get_mut(&key(other))
            && let Some(opposite) = ends.iter().position(|end| key(*end) == key(one))
        {
            ends.swap_remove(opposite);
            return;
        }
        self.from.entry(key(one)).or_default().push(other);
    }

    /// The closed lines that they make.
    fn into_rings(mut self) -> Vec<Vec<Point>> {
        let mut rings = Vec::new();
        while let Some((start, mut ends)) = self.from.pop_first() {
            while let Some(mut last) = ends.pop() {
                let mut ring = Vec::new();
                loop {
                    ring.push(last);
                    let next = if key(last) == start { None } else { self.from.get_mut(&key(last)).and_then(Vec::pop) };
                    match next {
                        Some(next) => last = next,
                        None => break,
                    }
                }
                rings.push(ring);
            }
        }
        rings
    }
}

/// What a closed line goes around, once or more often.
pub(super) fn enclosed(ring: &[Point], least: f64) -> Vec<Polygon> {
    simplified(&[ring.to_vec()], least)
}

fn simplified(polygons: &[Vec<Point>], least: f64) -> Vec<Polygon> {
    let mut options = OverlayOptions::default();
    options.min_output_area = least;
    polygons.to_vec().simplify_shape_custom_as::<i64>(FillRule::NonZero, options, Solver::default())
}

/// The area, m²: positive counterclockwise.
fn ring_area(ring: &[Point]) -> f64 {
    let Some(origin) = ring.first() else { return 0.0 };
    let about = |point: &Point| [point[0] - origin[0], point[1] - origin[1]];
    let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
    let twice = |(one, next): (&Point, &Point)| {
        let [one, next] = [about(one), about(next)];
        one[0] * next[1] - next[0] * one[1]
    };
    0.5 * pairs.map(twice).sum::<f64>()
}

/// The area of polygons, m².
pub(super) fn area(polygons: &[Polygon]) -> f64 {
    // The sum of none would be -0.
    polygons.iter().flatten().map(|ring| ring_area(ring)).fold(0.0, |sum, area| sum + area)
}

/// The convex hull of points, counterclockwise; none of fewer than three that are not in a line.
///
/// # Reference
/// A. M. Andrew, Another efficient algorithm for convex hulls in two dimensions, Information Processing Letters 9 (1979) 216-219.
pub(super) fn hull(points: impl Iterator<Item = Point>) -> Option<Vec<Point>> {
    let mut points: Vec<_> = points.collect();
    points.sort_by(|one, other| one[0].total_cmp(&other[0]).then(one[1].total_cmp(&other[1])));
    points.dedup();
    let mut ring: Vec<Point> = Vec::new();
    let chain = |ring: &mut Vec<Point>, points: &mut dyn Iterator<Item = &Point>| {
        let from = ring.len();
        for point in points {
            while let [.., before, last] = ring[from..]
                && (last[0] - before[0]) * (point[1] - before[1]) <= (last[1] - before[1]) * (point[0] - before[0])
            {
                ring.pop();
            }
            ring.push(*point);
        }
        ring.pop();
    };
    chain(&mut ring, &mut points.iter());
    chain(&mut ring, &mut points.iter().rev());
    (ring.len() > 2).then_some(ring)
}

/// The squares of a grid through which the edge of polygons goes.
#[derive(Debug)]
pub(super) struct Edge {
    width: f64,
    squares: HashSet<[i64; 2]>,
}

impl Edge {
    /// That of polygons, as far as `width` from which points are near it.
    pub(super) fn of(polygons: &[Polygon], width: f64) -> Self {
        let mut edge = Self { width, squares: HashSet::new() };
        for ring in polygons.iter().flatten() {
            for (one, next) in ring.iter().zip(ring.iter().cycle().skip(1)) {
                let length = hypot(next[0] - one[0], next[1] - one[1]);
                let mut along = 0.0;
                while along <= length {
                    let part = if length > 0.0 { along / length } else { 0.0 };
                    let square = edge.square([one[0] + part * (next[0] - one[0]), one[1] + part * (next[1] - one[1])]);
                    edge.squares.insert(square);
                    along += width;
                }
            }
        }
        edge
    }

    #[expect(clippy::cast_possible_truncation, reason = "a planet has fewer squares")]
    fn square(&self, point: Point) -> [i64; 2] {
        point.map(|coordinate| (coordinate / self.width).floor() as i64)
    }

    /// Whether the edge goes through the square of a point, or one beside it.
    pub(super) fn is_near(&self, point: Point) -> bool {
        let [x, y] = self.square(point);
        let mut beside = (-1..=1).flat_map(|right| (-1..=1).map(move |up| [x + right, y + up]));
        beside.any(|square| self.squares.contains(&square))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_2, PI};

    use super::{Edge, Segments, area, enclosed, hull, on_map, ring_area, union};
    use crate::coordinates::Site;
    use crate::planet::Shape;
    use crate::solve::footprint::Plane;

    fn square(x: f64, y: f64, width: f64) -> Vec<[f64; 2]> {
        vec![[x, y], [x + width, y], [x + width, y + width], [x, y + width]]
    }

    #[test]
    fn overlapping_squares_count_once_whichever_way_around_they_go() {
        let mut other = square(1e5, 0.0, 2e5);
        other.reverse();
        let found = union(&[square(0.0, 0.0, 2e5), other, square(9e5, 0.0, 1e5)], 1.0);
        assert_eq!(found.len(), 2);
        assert!((area(&found) - 7e10).abs() < 1e4, "{}", area(&found));
    }

    #[test]
    fn of_polygons_side_by_side_the_rim_is_left() {
        let mut segments = Segments::default();
        for x in 0..4_u8 {
            for y in 0..4_u8 {
                let corners = square(1e3 * f64::from(x) - 2e3, 1e3 * f64::from(y) - 2e3, 1e3);
                for (one, next) in corners.iter().zip(corners.iter().cycle().skip(1)) {
                    segments.add(*one, next.map(|coordinate| if coordinate == 0.0 { -0.0 } else { coordinate }));
                }
            }
        }
        let rings = segments.into_rings();
        assert!(rings.len() == 1 && rings[0].len() == 16, "{rings:?}");
        assert!((ring_area(&rings[0]) - 16e6).abs() < 1.0);
    }

    #[test]
    fn holes_stay_where_they_are_large() {
        let ring = [[0.0, 0.0, 3.0, 1.0], [0.0, 2.0, 3.0, 1.0], [0.0, 1.0, 1.0, 1.0], [2.0, 1.0, 1.0, 1.0]];
        let part = |[x, y, w, h]: [f64; 4]| {
            vec![[x, y], [x + w, y], [x + w, y + h], [x, y + h]]
                .into_iter()
                .map(|point| point.map(|it| 1e3 * it))
                .collect()
        };
        let parts = ring.map(part);
        let found = union(&parts, 1e3);
        assert!(found.len() == 1 && found[0].len() == 2 && (area(&found) - 8e6).abs() < 1.0);
        assert!((area(&union(&parts, 2e6)) - 9e6).abs() < 1.0);
    }

    #[test]
    fn a_line_that_crosses_itself_encloses_both_parts() {
        let eight = [[0.0, 0.0], [2e3, 2e3], [2e3, 0.0], [0.0, 2e3]];
        let found = enclosed(&eight, 1.0);
        assert!((area(&found) - 2e6).abs() < 1e2, "{}", area(&found));
    }

    #[test]
    fn a_hull_is_convex() {
        let points = [[0.0, 0.0], [1.0, 1.0], [4.0, 0.0], [2.0, 0.0], [4.0, 4.0], [0.0, 4.0], [1.0, 2.0]];
        assert_eq!(hull(points.into_iter()), Some(vec![[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]]));
        assert_eq!(hull([[0.0, 0.0], [1.0, 1.0], [2.0, 2.0]].into_iter()), None);
    }

    #[test]
    fn points_near_an_edge_are_told_from_those_within() {
        let edge = Edge::of(&[vec![square(0.0, 0.0, 100.0)]], 5.0);
        assert!(edge.is_near([3.0, 50.0]) && edge.is_near([100.0, 98.0]) && edge.is_near([104.0, 50.0]));
        assert!(!edge.is_near([50.0, 50.0]) && !edge.is_near([11.0, 50.0]));
    }

    /// The area of a map polygon on the sphere, by Green's theorem: the sum of the sines of the latitudes along the longitude.
    fn area_on_sphere(ring: &[[f64; 2]]) -> f64 {
        let pairs = ring.iter().zip(ring.iter().cycle().skip(1));
        -pairs.map(|(one, next)| (next[0] - one[0]) * 0.5 * (one[1].sin() + next[1].sin())).sum::<f64>()
    }

    #[test]
    fn maps_are_cut_at_the_antimeridian_and_led_over_poles() {
        let sphere = Shape::Sphere { radius: 6.4e6 };
        let radius = sphere.semi_axes().0;
        let octagon = |size: f64| -> Vec<[f64; 2]> {
            (0..64).map(|index| (f64::from(index) * PI / 32.0).sin_cos()).map(|(y, x)| [size * x, size * y]).collect()
        };
        let mut hole = octagon(2e5);
        hole.reverse();
        let polygon = vec![octagon(1e6), hole];
        let expected = area(std::slice::from_ref(&polygon)) / (radius * radius);
        let at = |longitude: f64, geodetic_latitude: f64| {
            let plane = Plane::about(&Site { longitude, geodetic_latitude }, &sphere);
            let found = on_map(std::slice::from_ref(&polygon), &plane);
            for ring in found.iter().flatten() {
                for [longitude, latitude] in ring {
                    assert!(longitude.abs() <= PI + 1e-9 && latitude.abs() <= FRAC_PI_2 + 1e-9);
                }
                assert!(ring_area(ring) != 0.0);
            }
            let whole: f64 = found.iter().flatten().map(|ring| area_on_sphere(ring)).sum();
            assert!(
                (whole / expected - 1.0).abs() < 3e-3,
                "{longitude} {geodetic_latitude}: {whole} is not {expected}"
            );
            found.len()
        };
        assert_eq!(at(0.5, 0.3), 1);
        assert_eq!(at(PI, 0.0), 2);
        assert_eq!(at(-3.1, -1.0), 2);
        // About the poles: the hole is about the pole too, or beside it.
        for latitude in [FRAC_PI_2, -FRAC_PI_2, 1.5, -1.5, 1.45] {
            at(0.4, latitude);
        }
    }
}
