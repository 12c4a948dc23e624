//! Where flights land when two numbers vary: the union of the images of triangles of the range.
//!
//! Triangles are divided where the middle of an edge lands off the middle of its image: to the resolution near the edge of the union, to some
//! times that within, so that no triangle covers a bay or a hole. Triangles in which flights cease to keep the limits are cut there.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::plane::Point;
use super::region::{Edge, Polygon, union};
use super::survey::{FlightIndex, Halt, Survey, distance, from_line, off_middle};
use super::{LONGEST, MOST_ROUNDS};

/// Intervals into which each range is divided at first; with the middles of the edges, the flights are twice as dense.
pub(super) const INTERVALS: u32 = 16;
/// A place of the range is a whole number of parts of it, of which there are so many: halving is exact.
const PARTS: f64 = 16_777_216.0;
/// Within the union, an edge may be off by so many resolutions.
const WITHIN: f64 = 5.0;
/// The middle of half a smooth edge is off by this part of what that of the whole is.
const OF_HALVES: f64 = 0.25;
/// What is foreseen to be off by less than this part of what is allowed is not flown.
const ENOUGH: f64 = 0.9;
/// From the edge of the union, so many resolutions are near.
const NEAR: f64 = 20.0;

/// The triangles of a range, whose corners are flights.
pub(super) struct Mesh {
    resolution: f64,
    triangles: Vec<[FlightIndex; 3]>,
    /// The last triangles of which all edges and cuts are known; empty where there are none.
    examined: Vec<[FlightIndex; 3]>,
    by_place: HashMap<[u32; 2], FlightIndex>,
    /// How far the middle of the image of an edge is off, m.
    chord_errors: HashMap<[FlightIndex; 2], f64>,
    /// How far it should be, by the edge of twice its length that it is half of, or beside.
    foreseen: HashMap<[FlightIndex; 2], f64>,
    /// The last flight that keeps all limits on an edge.
    last_kept: HashMap<[FlightIndex; 2], FlightIndex>,
    /// The cuts of triangles.
    cuts: HashMap<[FlightIndex; 3], Cut>,
}

/// Where flights cease to keep the limits within a triangle.
#[derive(Clone, Copy, Debug)]
struct Cut {
    /// On its edges, and between them.
    flights: [FlightIndex; 3],
    /// How far the one between is off the line of the others, m.
    chord_error: f64,
}

/// An edge, either way.
fn edge(one: FlightIndex, other: FlightIndex) -> [FlightIndex; 2] {
    [one.min(other), one.max(other)]
}

/// The edges of a triangle, each opposite of the corner of its place.
fn edges([a, b, c]: [FlightIndex; 3]) -> [[FlightIndex; 2]; 3] {
    [edge(b, c), edge(c, a), edge(a, b)]
}

#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a whole number of parts of the range")]
fn parts(place: &[f64]) -> [u32; 2] {
    [0, 1].map(|axis| (place[axis] * PARTS) as u32)
}

impl Mesh {
    /// The first triangles, and their flights.
    pub(super) fn scan<E>(survey: &mut Survey<E>) -> Result<Self, Halt<E>> {
        let mut mesh = Self {
            resolution: f64::INFINITY,
            triangles: Vec::new(),
            examined: Vec::new(),
            by_place: HashMap::new(),
            chord_errors: HashMap::new(),
            foreseen: HashMap::new(),
            last_kept: HashMap::new(),
            cuts: HashMap::new(),
        };
        let part = |index: u32| f64::from(index) / f64::from(INTERVALS);
        let mut rows: Vec<Vec<FlightIndex>> = Vec::new();
        for up in 0..=INTERVALS {
            let mut row = Vec::new();
            for right in 0..=INTERVALS {
                row.push(mesh.flown(survey, vec![part(right), part(up)])?);
            }
            rows.push(row);
        }
        for pair in rows.windows(2) {
            for (below, above) in pair[0].windows(2).zip(pair[1].windows(2)) {
                mesh.triangles.extend([[below[0], below[1], above[1]], [below[0], above[1], above[0]]]);
            }
        }
        // The flights in the middle of the edges show what is narrower than the triangles.
        for triangle in mesh.triangles.clone() {
            for edge in edges(triangle) {
                mesh.middle(survey, edge)?;
            }
        }
        Ok(mesh)
    }

    /// The flight at a place, which is flown once.
    fn flown<E>(&mut self, survey: &mut Survey<E>, place: Vec<f64>) -> Result<FlightIndex, Halt<E>> {
        let parts = parts(&place);
        if let Some(flight) = self.by_place.get(&parts) {
            return Ok(*flight);
        }
        let flight = survey.fly(place)?;
        self.by_place.insert(parts, flight);
        Ok(flight)
    }

    fn middle<E>(&mut self, survey: &mut Survey<E>, [one, other]: [FlightIndex; 2]) -> Result<FlightIndex, Halt<E>> {
        let place = survey.between(one, other, 0.5);
        self.flown(survey, place)
    }

    /// Divides triangles until the union is as exact as the resolution.
    pub(super) fn refine<E>(&mut self, survey: &mut Survey<E>, resolution: f64) -> Result<(), Halt<E>> {
        self.resolution = resolution;
        for round in 0..=MOST_ROUNDS {
            let near = Edge::of(&self.covered(survey, &self.triangles), NEAR * resolution);
            // In their order, so that the same request flies the same flights.
            let mut halved: BTreeSet<[FlightIndex; 2]> = BTreeSet::new();
            for triangle in self.triangles.clone() {
                halved.extend(self.edges_to_halve(survey, triangle, &near, round == 0)?);
            }
            self.examined.clone_from(&self.triangles);
            if halved.is_empty() || round == MOST_ROUNDS {
                break;
            }
            self.divide(survey, &halved)?;
        }
        Ok(())
    }

    /// The edges of a triangle that are to be halved.
    fn edges_to_halve<E>(
        &mut self,
        survey: &mut Survey<E>,
        triangle: [FlightIndex; 3],
        near: &Edge,
        is_first: bool,
    ) -> Result<Vec<[FlightIndex; 2]>, Halt<E>> {
        let mut halved = Vec::new();
        for edge in edges(triangle) {
            let is_to_halve = match edge.map(|flight| survey.keeps(flight)) {
                [true, true] => self.is_curved(survey, edge, near)?,
                // What lies between flights of which none keeps the limits was looked for by the scan.
                [false, false] if is_first => {
                    let middle = self.middle(survey, edge)?;
                    survey.keeps(middle)
                }
                _ => false,
            };
            if is_to_halve {
                halved.push(edge);
            }
        }
        if let Some(cut) = self.cut(survey, triangle)?
            && OF_HALVES * cut.chord_error > ENOUGH * self.resolution
        {
            halved.extend(edges(triangle));
        }
        Ok(halved)
    }

    /// Whether an edge, both ends of which keep the limits, is to be halved: where its middle was flown and is off by more than what its halves
    /// may be off.
    fn is_curved<E>(&mut self, survey: &mut Survey<E>, edge: [FlightIndex; 2], near: &Edge) -> Result<bool, Halt<E>> {
        let [Some(one), Some(other)] = edge.map(|flight| survey.kept_point(flight)) else { return Ok(false) };
        let is_near = near.is_near([0, 1].map(|axis| 0.5 * (one[axis] + other[axis])));
        let limit = if is_near { self.resolution } else { WITHIN * self.resolution };
        if let Some(error) = self.chord_errors.get(&edge) {
            return Ok(*error > OF_HALVES * limit);
        }
        if self.foreseen.get(&edge).is_some_and(|error| *error <= ENOUGH * limit) {
            return Ok(false);
        }
        let middle = self.middle(survey, edge)?;
        let error = match survey.kept_point(middle) {
            Some(middle) if distance(one, other) <= LONGEST => off_middle(middle, one, other),
            _ => f64::INFINITY,
        };
        self.chord_errors.insert(edge, error);
        Ok(error > OF_HALVES * limit)
    }

    /// The cut of a triangle; none where all corners keep the limits, or none does.
    fn cut<E>(&mut self, survey: &mut Survey<E>, triangle: [FlightIndex; 3]) -> Result<Option<Cut>, Halt<E>> {
        if let Some(cut) = self.cuts.get(&triangle) {
            return Ok(Some(*cut));
        }
        let Some((alone, [one, other])) = alone(survey, triangle) else { return Ok(None) };
        let first = self.last_kept_on(survey, alone, one)?;
        let second = self.last_kept_on(survey, alone, other)?;
        // From the corner that is alone, across the middle of the line, to the opposite edge.
        let line = survey.between(first, second, 0.5);
        let middle = survey.fly(line)?;
        let is_alone_kept = survey.keeps(alone);
        let between = if survey.keeps(middle) == is_alone_kept {
            let beyond = self.middle(survey, edge(one, other))?;
            match (survey.keeps(middle), survey.keeps(beyond)) {
                (true, false) => survey.last_kept(middle, beyond, self.accuracy())?,
                (false, true) => survey.last_kept(beyond, middle, self.accuracy())?,
                // The limit is met once more beyond: the triangle is divided.
                _ => return Ok(Some(self.noted(triangle, [first, middle, second], f64::INFINITY))),
            }
        } else if is_alone_kept {
            survey.last_kept(alone, middle, self.accuracy())?
        } else {
            survey.last_kept(middle, alone, self.accuracy())?
        };
        let points = [first, between, second].map(|flight| survey.point(flight));
        let error = match points {
            [Some(first), Some(between), Some(second)] => from_line(between, first, second),
            _ => f64::INFINITY,
        };
        Ok(Some(self.noted(triangle, [first, between, second], error)))
    }

    fn noted(&mut self, triangle: [FlightIndex; 3], flights: [FlightIndex; 3], chord_error: f64) -> Cut {
        let cut = Cut { flights, chord_error };
        self.cuts.insert(triangle, cut);
        cut
    }

    /// To which the last flight that keeps the limits is located, m.
    fn accuracy(&self) -> f64 {
        0.25 * self.resolution
    }

    fn last_kept_on<E>(
        &mut self,
        survey: &mut Survey<E>,
        one: FlightIndex,
        other: FlightIndex,
    ) -> Result<FlightIndex, Halt<E>> {
        if let Some(flight) = self.last_kept.get(&edge(one, other)) {
            return Ok(*flight);
        }
        let (kept, broken) = if survey.keeps(one) { (one, other) } else { (other, one) };
        let flight = survey.last_kept(kept, broken, self.accuracy())?;
        self.last_kept.insert(edge(one, other), flight);
        Ok(flight)
    }

    /// Divides the triangles that have edges that are to be halved: neighbours have the same corners.
    fn divide<E>(&mut self, survey: &mut Survey<E>, halved: &BTreeSet<[FlightIndex; 2]>) -> Result<(), Halt<E>> {
        let mut finer = Vec::with_capacity(self.triangles.len() + 3 * halved.len());
        let mut middles = BTreeMap::new();
        for edge in halved {
            middles.insert(*edge, self.middle(survey, *edge)?);
        }
        for ([one, other], middle) in &middles {
            if let Some(error) = self.chord_errors.get(&edge(*one, *other)) {
                for half in [edge(*one, *middle), edge(*middle, *other)] {
                    self.foreseen.insert(half, OF_HALVES * error);
                }
            }
        }
        for triangle in &self.triangles {
            let [a, b, c] = *triangle;
            let middle = edges(*triangle).map(|edge| middles.get(&edge).copied());
            match middle {
                [None, None, None] => finer.push([a, b, c]),
                [Some(d), None, None] => finer.extend([[a, b, d], [a, d, c]]),
                [None, Some(e), None] => finer.extend([[b, c, e], [b, e, a]]),
                [None, None, Some(f)] => finer.extend([[c, a, f], [c, f, b]]),
                [Some(d), Some(e), None] => finer.extend([[c, e, d], [e, a, d], [a, b, d]]),
                [None, Some(e), Some(f)] => finer.extend([[a, f, e], [f, b, e], [b, c, e]]),
                [Some(d), None, Some(f)] => finer.extend([[b, d, f], [d, c, f], [c, a, f]]),
                [Some(d), Some(e), Some(f)] => {
                    finer.extend([[a, f, e], [f, b, d], [e, d, c], [f, d, e]]);
                    for (parallel, of_two) in
                        [(edge(e, f), edge(b, c)), (edge(f, d), edge(c, a)), (edge(d, e), edge(a, b))]
                    {
                        if let Some(error) = self.chord_errors.get(&of_two) {
                            self.foreseen.insert(parallel, OF_HALVES * error);
                        }
                    }
                }
            }
        }
        self.triangles = finer;
        Ok(())
    }

    /// The union of the images, and by how much its edge may be off, m: without bound where that is not known.
    pub(super) fn outline<E>(&self, survey: &Survey<E>) -> (Vec<Polygon>, f64) {
        // Where flights ran out amid the first triangles, those are told as far as they are known.
        let triangles = if self.examined.is_empty() { &self.triangles } else { &self.examined };
        let covered = self.covered(survey, triangles);
        let error = self.error(survey, triangles, &covered);
        (covered, error)
    }

    /// What the images of triangles cover, as far as their flights keep the limits, and their cuts are known.
    fn covered<E>(&self, survey: &Survey<E>, triangles: &[[FlightIndex; 3]]) -> Vec<Polygon> {
        let image = |triangle: &[FlightIndex; 3]| {
            let kept = triangle.map(|flight| survey.kept_point(flight));
            if let [Some(a), Some(b), Some(c)] = kept {
                return Some(vec![a, b, c]);
            }
            let (_, [one, other]) = alone(survey, *triangle)?;
            let cut = self.cuts.get(triangle)?;
            let [first, between, second] = cut.flights.map(|flight| survey.kept_point(flight));
            // From the corner that is alone, or along the opposite edge.
            let corners = kept.into_iter().flatten().count();
            let rest = if corners == 1 {
                vec![kept.into_iter().flatten().next()]
            } else {
                vec![survey.kept_point(other), survey.kept_point(one)]
            };
            Some([first, between, second].into_iter().chain(rest).flatten().collect::<Vec<Point>>())
        };
        let images: Vec<_> = triangles.iter().filter_map(image).filter(|image| image.len() > 2).collect();
        let least = if self.resolution.is_finite() { self.resolution.powi(2) } else { 0.0 };
        union(&images, least)
    }

    fn error<E>(&self, survey: &Survey<E>, triangles: &[[FlightIndex; 3]], covered: &[Polygon]) -> f64 {
        let near = Edge::of(covered, NEAR * self.resolution);
        let of_edge = |edge: [FlightIndex; 2]| {
            let [one, other] = [survey.kept_point(edge[0])?, survey.kept_point(edge[1])?];
            let is_near = near.is_near([0, 1].map(|axis| 0.5 * (one[axis] + other[axis])));
            let error = self.chord_errors.get(&edge).or(self.foreseen.get(&edge));
            let error = error.map_or(f64::INFINITY, |error| *error);
            (is_near || error.is_infinite()).then_some(error)
        };
        let of_triangle = |triangle: &[FlightIndex; 3]| {
            let of_cut = alone(survey, *triangle)
                .map(|_| self.cuts.get(triangle).map_or(f64::INFINITY, |cut| OF_HALVES * cut.chord_error));
            let of_edges = edges(*triangle).into_iter().filter_map(of_edge);
            of_edges.chain(of_cut).fold(0.0, f64::max)
        };
        triangles.iter().map(of_triangle).fold(0.0, f64::max)
    }
}

/// The corner of a triangle that alone keeps the limits, or alone does not, and the others in their order.
fn alone<E>(survey: &Survey<E>, [a, b, c]: [FlightIndex; 3]) -> Option<(FlightIndex, [FlightIndex; 2])> {
    match [a, b, c].map(|flight| survey.keeps(flight)) {
        [true, false, false] | [false, true, true] => Some((a, [b, c])),
        [false, true, false] | [true, false, true] => Some((b, [c, a])),
        [false, false, true] | [true, true, false] => Some((c, [a, b])),
        _ => None,
    }
}
