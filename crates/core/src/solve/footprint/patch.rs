//! The image of a triangle of the range on the plane, of which corners and middles of edges are known.

use super::plane::Point;
use crate::elementary::hypot;

/// The image of an edge: the parabola through its ends and its middle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Parabola {
    pub(super) ends: [Point; 2],
    /// How far its middle is off that of its chord, m.
    pub(super) sagitta: Point,
}

/// A side of a patch, along a parabola or against it: patches on either side of an edge have the same points there, to the last digit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    pub(super) parabola: Parabola,
    pub(super) is_against: bool,
}

/// Chords into which a parabola is divided at most.
const MOST_CHORDS: u32 = 32;
/// Parts into which the sides of a folded patch are divided at least.
const LEAST_OF_FOLD: u32 = 8;

impl Parabola {
    /// A straight one.
    pub(super) fn straight(ends: [Point; 2]) -> Self {
        Self { ends, sagitta: [0.0; 2] }
    }

    /// That through a point in its middle.
    pub(super) fn through(ends: [Point; 2], middle: Point) -> Self {
        let sagitta = [0, 1].map(|axis| middle[axis] - 0.5 * (ends[0][axis] + ends[1][axis]));
        Self { ends, sagitta }
    }

    /// The point at a part of the way; at its ends these themselves.
    pub(super) fn at(&self, part: f64) -> Point {
        let [one, other] = self.ends;
        if part >= 1.0 {
            return other;
        }
        let bend = 4.0 * part * (1.0 - part);
        [0, 1].map(|axis| one[axis] + part * (other[axis] - one[axis]) + bend * self.sagitta[axis])
    }

    /// Chords, of which none is off by more than a tolerance, m, as far as [`MOST_CHORDS`] allow: a power of two.
    fn chords(&self, tolerance: f64) -> u32 {
        let sagitta = hypot(self.sagitta[0], self.sagitta[1]);
        let mut chords = 1;
        while chords < MOST_CHORDS && sagitta > tolerance * f64::from(chords * chords) {
            chords *= 2;
        }
        chords
    }
}

impl Side {
    /// The ends of its chords, but for the last.
    pub(super) fn points(&self, tolerance: f64) -> impl Iterator<Item = Point> {
        let chords = self.parabola.chords(tolerance);
        let side = *self;
        (0..chords).map(move |chord| side.at(f64::from(chord) / f64::from(chords)))
    }

    /// A point of the parabola.
    fn at(&self, part: f64) -> Point {
        self.parabola.at(if self.is_against { 1.0 - part } else { part })
    }

    /// A point of its chords.
    fn on_chords(&self, part: f64, tolerance: f64) -> Point {
        let chords = f64::from(self.parabola.chords(tolerance));
        let first = (part * chords).floor();
        let rest = part * chords - first;
        let start = self.at(first / chords);
        if rest == 0.0 {
            return start;
        }
        let end = self.at((first + 1.0) / chords);
        [0, 1].map(|axis| start[axis] + rest * (end[axis] - start[axis]))
    }

    /// From its start to its end.
    fn chord(&self) -> Point {
        let [start, end] = [self.at(0.0), self.at(1.0)];
        [0, 1].map(|axis| end[axis] - start[axis])
    }

    /// The rates at its start and at its end.
    fn rates(&self) -> [Point; 2] {
        let (chord, sagitta) = (self.chord(), self.parabola.sagitta);
        [4.0, -4.0].map(|factor| [0, 1].map(|axis| chord[axis] + factor * sagitta[axis]))
    }
}

/// What the image of a triangle covers, in polygons; `sides` go around it. What is quadratic in the two numbers is told exactly, but for chords
/// that are off by a tolerance, m.
pub(super) fn polygons(sides: &[Side; 3], tolerance: f64) -> Vec<Vec<Point>> {
    let rates = rates(sides);
    if !is_folded(&rates) {
        return vec![sides.iter().flat_map(|side| side.points(tolerance)).collect()];
    }
    let count = sides.iter().map(|side| side.parabola.chords(tolerance)).fold(LEAST_OF_FOLD, u32::max);
    let mut pieces = Vec::new();
    Lattice { sides, rates, count, tolerance }.cover([0, 0], i64::from(count), &mut pieces);
    pieces
}

/// The rates of the image at each corner, towards the second corner and towards the third. They are linear in the two numbers.
type Rates = [[Point; 2]; 3];

fn rates(sides: &[Side; 3]) -> Rates {
    let [[ab_at_a, ab_at_b], [bc_at_b, bc_at_c], [ca_at_c, ca_at_a]] = sides.each_ref().map(Side::rates);
    let sum = |one: Point, other: Point| [0, 1].map(|axis| one[axis] + other[axis]);
    let minus = |one: Point| one.map(|it| -it);
    [[ab_at_a, minus(ca_at_a)], [ab_at_b, sum(ab_at_b, bc_at_b)], [minus(sum(ca_at_c, bc_at_c)), minus(ca_at_c)]]
}

/// Whether the image may lie on itself: whether its Jacobian may change its sign.
///
/// The Jacobian of what is quadratic is quadratic: by its coefficients in the form of Bernstein and Bézier it has one sign if all have.
///
/// # Reference
/// G. Farin, Curves and Surfaces for CAGD, 5th edition (2002), section 17.2.
fn is_folded(rates: &Rates) -> bool {
    let cross = |one: Point, other: Point| one[0] * other[1] - one[1] * other[0];
    let corners = [0, 1, 2].map(|corner| cross(rates[corner][0], rates[corner][1]));
    let between = [(0, 1), (1, 2), (2, 0)]
        .map(|(one, other)| cross(rates[one][0], rates[other][1]) + cross(rates[other][0], rates[one][1]));
    let has = |sign: f64| corners.iter().chain(&between).any(|coefficient| sign * coefficient > 0.0);
    has(1.0) && has(-1.0)
}

/// A folded image, on a lattice of triangles: pieces without a fold are told as wholes.
struct Lattice<'a> {
    sides: &'a [Side; 3],
    rates: Rates,
    /// Into so many parts the sides are divided.
    count: u32,
    tolerance: f64,
}

impl Lattice<'_> {
    /// Adds the pieces of a triangle of the lattice, with a right angle at a place, of a size; of a negative one, it lies the other way around.
    fn cover(&self, [to_b, to_c]: [i64; 2], size: i64, pieces: &mut Vec<Vec<Point>>) {
        let corners = [[to_b, to_c], [to_b + size, to_c], [to_b, to_c + size]];
        if size.abs() == 1 || !is_folded(&corners.map(|corner| self.rates_at(corner))) {
            let step = size.signum();
            let side = |from: [i64; 2], way: [i64; 2]| {
                (0..size.abs()).map(move |along| [0, 1].map(|axis| from[axis] + along * way[axis]))
            };
            let ways = [[step, 0], [-step, step], [0, -step]];
            let around = corners.into_iter().zip(ways).flat_map(|(from, way)| side(from, way));
            pieces.push(around.map(|place| self.point(place)).collect());
            return;
        }
        let half = size / 2;
        for corner in [[to_b, to_c], [to_b + half, to_c], [to_b, to_c + half]] {
            self.cover(corner, half, pieces);
        }
        self.cover([to_b + half, to_c + half], -half, pieces);
    }

    /// The parts that corners have in a place.
    #[expect(clippy::cast_precision_loss, reason = "a lattice is small")]
    fn weights(&self, [to_b, to_c]: [i64; 2]) -> [f64; 3] {
        [i64::from(self.count) - to_b - to_c, to_b, to_c].map(|parts| parts as f64 / f64::from(self.count))
    }

    fn rates_at(&self, place: [i64; 2]) -> [Point; 2] {
        let weights = self.weights(place);
        [0, 1].map(|way| [0, 1].map(|axis| (0..3).map(|corner| weights[corner] * self.rates[corner][way][axis]).sum()))
    }

    /// The image of a place; on a side, as the other side of it has it.
    fn point(&self, place: [i64; 2]) -> Point {
        let [of_a, of_b, of_c] = self.weights(place);
        let [ab, bc, ca] = self.sides;
        if of_c == 0.0 {
            return ab.on_chords(of_b, self.tolerance);
        }
        if of_a == 0.0 {
            return bc.on_chords(of_c, self.tolerance);
        }
        if of_b == 0.0 {
            return ca.on_chords(of_a, self.tolerance);
        }
        let [a, b, c] = self.sides.each_ref().map(|side| side.at(0.0));
        [0, 1].map(|axis| {
            let bend = of_a * of_b * ab.parabola.sagitta[axis]
                + of_b * of_c * bc.parabola.sagitta[axis]
                + of_c * of_a * ca.parabola.sagitta[axis];
            of_a * a[axis] + of_b * b[axis] + of_c * c[axis] + 4.0 * bend
        })
    }
}

#[cfg(test)]
mod tests {
    use super::{Parabola, Side, is_folded, polygons, rates};
    use crate::solve::footprint::plane::Point;
    use crate::solve::footprint::region::{area, union};

    /// The patch of a map over the triangle of (0, 0), (1, 0) and (0, 1), with its sides along their parabolas or against them.
    fn patch(map: impl Fn(f64, f64) -> Point, against: [bool; 3]) -> [Side; 3] {
        let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]];
        [0, 1, 2].map(|side| {
            let [start, end] = [corners[side], corners[(side + 1) % 3]];
            let [start, end] = if against[side] { [end, start] } else { [start, end] };
            let middle = map(0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1]));
            let parabola = Parabola::through([map(start[0], start[1]), map(end[0], end[1])], middle);
            Side { parabola, is_against: against[side] }
        })
    }

    /// The integral of the Jacobian of x = u + u v, y = v + u²/2, which is 1 + v - u², over the triangle, is 7/12.
    #[test]
    fn what_is_quadratic_has_its_area() {
        let map = |u: f64, v: f64| [1e3 * (u + u * v), 1e3 * (v + 0.5 * u * u)];
        for against in [[false; 3], [true, false, true]] {
            let sides = patch(map, against);
            assert!(!is_folded(&rates(&sides)));
            let found = area(&union(&polygons(&sides, 0.1), 0.0));
            assert!((found / (1e6 * 7.0 / 12.0) - 1.0).abs() < 1e-3, "{found}");
        }
    }

    /// x = u, y = (v - 1/4)²: the fold v = 1/4 is the line y = 0, and covers no more than its longer side, from v = 1/4 to 1 - u, or its
    /// shorter one, from 0 to 1/4.
    #[test]
    fn a_fold_covers_what_its_sides_do() {
        let map = |u: f64, v: f64| [1e3 * u, 1e3 * (v - 0.25) * (v - 0.25)];
        let sides = patch(map, [false, true, false]);
        assert!(is_folded(&rates(&sides)));
        let found = area(&union(&polygons(&sides, 0.1), 0.0));
        // To u = 1/2 the greatest y is (3/4 - u)², from there to 3/4 that of v = 0, which is 1/16, and then from (3/4 - u)² to 1/16.
        let steep = (0.75_f64.powi(3) - 0.25_f64.powi(3)) / 3.0;
        let flat = 0.5 / 16.0 - 0.25_f64.powi(3) / 3.0;
        assert!((found / (1e6 * (steep + flat)) - 1.0).abs() < 1e-2, "{found} is not {}", 1e6 * (steep + flat));
    }

    /// Points of both sides of an edge are the same, also where one side is folded and has more of them.
    #[test]
    fn neighbours_leave_nothing_between() {
        let map = |u: f64, v: f64| [1e3 * (u - 0.3) * (u - 0.3), 1e3 * (v + 0.1 * u)];
        let folded = patch(map, [false, false, false]);
        assert!(is_folded(&rates(&folded)));
        let straight =
            |one: Point, other: Point| Side { parabola: Parabola::straight([one, other]), is_against: false };
        let [_, slope, _] = folded;
        let beyond = [2e3, 2e3];
        let other = [
            Side { is_against: true, ..slope },
            straight(slope.parabola.ends[0], beyond),
            straight(beyond, slope.parabola.ends[1]),
        ];
        let mut all = polygons(&folded, 100.0);
        all.extend(polygons(&other, 100.0));
        let covered = union(&all, 0.0);
        assert!(covered.len() == 1 && covered[0].len() == 1, "{covered:?}");
    }
}
