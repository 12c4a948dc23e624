//! Where flights land when two numbers vary: the union of the images of triangles of the range.
//!
//! The image of an edge is taken for the parabola through its ends and its middle, which is flown. Triangles are divided where the middle of an edge
//! lands off the parabola of the edge of which it is half, or beside: to the resolution near the edge of the union, to some times that within, so
//! that no triangle covers a bay or a hole. Triangles in which flights cease to keep the limits are cut there.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use super::patch::{self, Parabola, Side};
use super::plane::Point;
use super::region::{Edge, Polygon, union};
use super::survey::{FlightIndex, Halt, Survey, distance, from_line};
use super::{LONGEST, MOST_ROUNDS};

/// Intervals into which each range is divided at first; with the middles of the edges, the flights are twice as dense.
pub(super) const INTERVALS: u32 = 16;
/// A place of the range is a whole number of parts of it, of which there are so many: halving is exact.
const PARTS: f64 = 16_777_216.0;
/// Within the union, an edge may be off by so many resolutions.
const WITHIN: f64 = 5.0;
/// The middle of half a smooth edge is off the parabola of the whole by this part of what that of the whole is off.
const OF_HALVES: f64 = 0.125;
/// A parabola is off by this part of what its middle is off that of the whole: twice as much as where the third derivative does not change.
const OF_PARABOLA: f64 = 0.25;
/// The same of the line along which a triangle is cut, by how far it is bent.
const OF_CUT: f64 = 0.125;
/// What is foreseen to be off by less than this part of what is allowed is not flown.
const ENOUGH: f64 = 0.9;
/// Chords in place of parabolas are off by this part of the resolution.
const OF_CHORDS: f64 = 0.25;
/// From the edge of the union, so many resolutions are near.
const NEAR: f64 = 20.0;

/// The triangles of a range, whose corners are flights.
pub(super) struct Mesh {
    resolution: f64,
    triangles: Vec<[FlightIndex; 3]>,
    /// The last triangles of which all edges and cuts are known; empty where there are none.
    examined: Vec<[FlightIndex; 3]>,
    by_place: HashMap<[u32; 2], FlightIndex>,
    /// How edges are bent whose middles were flown.
    bends: HashMap<[FlightIndex; 2], Bend>,
    /// How they should be, by the edge of twice its length that each is half of, or beside.
    foreseen: HashMap<[FlightIndex; 2], Bend>,
    /// The last flight that keeps all limits on an edge.
    last_kept: HashMap<[FlightIndex; 2], FlightIndex>,
    /// The flight amid what is kept of an edge that is on the rim of the range.
    amid_kept: HashMap<[FlightIndex; 2], FlightIndex>,
    /// The cuts of triangles.
    cuts: HashMap<[FlightIndex; 3], Cut>,
}

/// How the image of an edge is bent.
#[derive(Clone, Copy, Debug)]
struct Bend {
    /// How far its middle is off that of its chord, m.
    sagitta: Point,
    /// How far that is off what was foreseen, m, the hierarchical surplus; without bound where the middle does not keep the limits.
    surplus: f64,
}

impl Bend {
    /// That of a half of the edge, or of an edge of half its length beside it.
    fn of_half(self) -> Self {
        Self { sagitta: self.sagitta.map(|it| 0.25 * it), surplus: OF_HALVES * self.surplus }
    }

    /// That of the line from a corner of a triangle to the middle of the edge `across`, where the triangle is quadratic.
    fn of_median(across: Self, one: Self, other: Self) -> Self {
        let sagitta = [0, 1].map(|axis| 0.5 * (one.sagitta[axis] + other.sagitta[axis]) - 0.25 * across.sagitta[axis]);
        let surplus = OF_PARABOLA * across.surplus.max(one.surplus).max(other.surplus);
        Self { sagitta, surplus }
    }
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

/// Which of the edges of a triangle is the longest in the range.
fn longest<E>(survey: &Survey<E>, edges: [[FlightIndex; 2]; 3]) -> usize {
    let square = |index: usize| {
        let [one, other] = edges[index].map(|flight| parts(&survey.flights[flight].place));
        [0, 1].map(|axis| u64::from(one[axis].abs_diff(other[axis])).pow(2)).iter().sum::<u64>()
    };
    (0..3).max_by_key(|index| (square(*index), edges[*index])).unwrap_or(0)
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
            bends: HashMap::new(),
            foreseen: HashMap::new(),
            last_kept: HashMap::new(),
            amid_kept: HashMap::new(),
            cuts: HashMap::new(),
        };
        let part = |index: u32| f64::from(index) / f64::from(INTERVALS);
        let row = |up: u32| (0..=INTERVALS).map(move |right| vec![part(right), part(up)]);
        let flights = mesh.all_flown(survey, (0..=INTERVALS).flat_map(row).collect())?;
        let rows: Vec<_> = flights.chunks(INTERVALS as usize + 1).collect();
        for pair in rows.windows(2) {
            for (below, above) in pair[0].windows(2).zip(pair[1].windows(2)) {
                mesh.triangles.extend([[below[0], below[1], above[1]], [below[0], above[1], above[0]]]);
            }
        }
        // The flights in the middle of the edges show what is narrower than the triangles.
        let edges: BTreeSet<_> = mesh.triangles.iter().flat_map(|triangle| edges(*triangle)).collect();
        let middles = edges.into_iter().map(|[one, other]| survey.between(one, other, 0.5)).collect();
        mesh.all_flown(survey, middles)?;
        Ok(mesh)
    }

    /// The flights at several places, none of which was flown before.
    fn all_flown<E>(&mut self, survey: &mut Survey<E>, places: Vec<Vec<f64>>) -> Result<Vec<FlightIndex>, Halt<E>> {
        let parts: Vec<_> = places.iter().map(|place| parts(place)).collect();
        let flights = survey.fly_all(places)?;
        self.by_place.extend(parts.into_iter().zip(flights.clone()));
        Ok(flights.collect())
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
        self.foresee_first(survey);
        let mut round = 0;
        loop {
            let near = Edge::of(&self.covered(survey, &self.triangles), NEAR * resolution);
            let flown = survey.flights.len();
            // In their order, so that the same request flies the same flights.
            let mut halved: BTreeSet<[FlightIndex; 2]> = BTreeSet::new();
            for triangle in self.triangles.clone() {
                halved.extend(self.edges_to_halve(survey, triangle, &near, round == 0)?);
            }
            self.examined.clone_from(&self.triangles);
            if !halved.is_empty() {
                if round == MOST_ROUNDS {
                    return Ok(());
                }
                self.divide(survey, halved)?;
                round += 1;
            } else if survey.flights.len() == flown {
                return Ok(());
            }
            // Otherwise what was flown may have moved the edge of the union.
        }
    }

    /// Foresees the bends of the first edges, whose middles were flown, by the edges of twice their length between the same flights.
    fn foresee_first<E>(&mut self, survey: &Survey<E>) {
        let unit = parts(&[1.0, 1.0])[0] / INTERVALS;
        for edge in self.triangles.iter().flat_map(|triangle| edges(*triangle)) {
            let [one, other] = edge.map(|flight| parts(&survey.flights[flight].place));
            let least = [0, 1].map(|axis| one[axis].min(other[axis]) / unit / 2 * 2 * unit);
            let way = [0, 1].map(|axis| one[axis].abs_diff(other[axis]));
            let flights = [0, 1, 2].map(|step| self.by_place.get(&[0, 1].map(|axis| least[axis] + step * way[axis])));
            if let [Some(start), Some(middle), Some(end)] =
                flights.map(|flight| flight.and_then(|flight| survey.kept_point(*flight)))
            {
                let Parabola { sagitta, .. } = Parabola::through([start, end], middle);
                self.foreseen.insert(edge, Bend { sagitta, surplus: f64::INFINITY }.of_half());
            }
        }
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
            && OF_CUT * cut.chord_error > ENOUGH * self.resolution
        {
            halved.extend(edges(triangle));
        }
        Ok(halved)
    }

    /// Whether an edge, both ends of which keep the limits, is to be halved: where its parabola may be off by more than is allowed.
    fn is_curved<E>(&mut self, survey: &mut Survey<E>, edge: [FlightIndex; 2], near: &Edge) -> Result<bool, Halt<E>> {
        let Some(image) = self.image(survey, edge) else { return Ok(false) };
        let is_near = is_near(&image, near);
        let limit = if is_near { self.resolution } else { WITHIN * self.resolution };
        let foreseen = self.foreseen.get(&edge).copied();
        if let Some(bend) = self.bends.get(&edge) {
            return Ok(OF_PARABOLA * bend.surplus > limit);
        }
        if foreseen.is_some_and(|bend| bend.surplus <= ENOUGH * limit) {
            return Ok(false);
        }
        let middle = self.middle(survey, edge)?;
        let [one, other] = image.ends;
        let bend = match survey.kept_point(middle) {
            Some(middle) if distance(one, other) <= LONGEST => {
                let Parabola { sagitta, .. } = Parabola::through(image.ends, middle);
                let foreseen = foreseen.map_or([0.0; 2], |bend| bend.sagitta);
                Bend { sagitta, surplus: distance(sagitta, foreseen) }
            }
            _ => Bend { sagitta: [0.0; 2], surplus: f64::INFINITY },
        };
        self.bends.insert(edge, bend);
        Ok(OF_PARABOLA * bend.surplus > limit)
    }

    /// The image of an edge, as far as it is known; none where its ends do not keep the limits.
    fn image<E>(&self, survey: &Survey<E>, edge: [FlightIndex; 2]) -> Option<Parabola> {
        let ends = [survey.kept_point(edge[0])?, survey.kept_point(edge[1])?];
        let bend = self.bends.get(&edge).or(self.foreseen.get(&edge));
        Some(Parabola { ends, sagitta: bend.map_or([0.0; 2], |bend| bend.sagitta) })
    }

    /// The cut of a triangle; none where all corners keep the limits, or none does.
    fn cut<E>(&mut self, survey: &mut Survey<E>, triangle: [FlightIndex; 3]) -> Result<Option<Cut>, Halt<E>> {
        if let Some(cut) = self.cuts.get(&triangle) {
            return Ok(Some(*cut));
        }
        let Some((alone, [one, other])) = alone(survey, triangle) else { return Ok(None) };
        let first = self.last_kept_on(survey, alone, one)?;
        let second = self.last_kept_on(survey, alone, other)?;
        for (end, cut) in [(one, first), (other, second)] {
            self.fly_amid(survey, edge(alone, end), cut)?;
        }
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

    /// Flies amid what is kept of an edge that is cut, if it is on the rim of the range: elsewhere what lies on its other side goes on there.
    fn fly_amid<E>(&mut self, survey: &mut Survey<E>, edge: [FlightIndex; 2], cut: FlightIndex) -> Result<(), Halt<E>> {
        let [one, other] = edge.map(|flight| parts(&survey.flights[flight].place));
        let whole = parts(&[1.0, 1.0])[0];
        let is_on_rim = (0..2).any(|axis| one[axis] == other[axis] && [0, whole].contains(&one[axis]));
        let kept = edge.into_iter().find(|flight| survey.keeps(*flight));
        if let Some(kept) = kept.filter(|kept| is_on_rim && *kept != cut)
            && !self.amid_kept.contains_key(&edge)
        {
            let amid = survey.fly(survey.between(kept, cut, 0.5))?;
            self.amid_kept.insert(edge, amid);
        }
        Ok(())
    }

    /// Divides the triangles that have edges that are to be halved: neighbours have the same corners. The longest edge of such a triangle is halved
    /// as well, so that none becomes narrow.
    ///
    /// # Reference
    /// M. C. Rivara, Algorithms for refining triangular grids suitable for adaptive and multigrid techniques, International Journal for
    /// Numerical Methods in Engineering 20 (1984), 745-756.
    fn divide<E>(&mut self, survey: &mut Survey<E>, mut halved: BTreeSet<[FlightIndex; 2]>) -> Result<(), Halt<E>> {
        let mut count = 0;
        while count < halved.len() {
            count = halved.len();
            for triangle in &self.triangles {
                let edges = edges(*triangle);
                if edges.iter().any(|edge| halved.contains(edge)) {
                    halved.insert(edges[longest(survey, edges)]);
                }
            }
        }
        let mut middles = BTreeMap::new();
        for edge in halved {
            middles.insert(edge, self.middle(survey, edge)?);
        }
        for ([one, other], middle) in &middles {
            let bend = self.bend(edge(*one, *other));
            self.foresee([edge(*one, *middle), edge(*middle, *other)], bend.map(Bend::of_half));
        }
        let mut finer = Vec::with_capacity(self.triangles.len() + 3 * middles.len());
        for triangle in std::mem::take(&mut self.triangles) {
            let edges = edges(triangle);
            let middle = edges.map(|edge| middles.get(&edge).copied());
            finer.extend(self.pieces(triangle, middle, longest(survey, edges)));
        }
        self.triangles = finer;
        Ok(())
    }

    /// The pieces of a triangle, by the middles of its edges, and how the new edges between them should be bent.
    fn pieces(
        &mut self,
        triangle: [FlightIndex; 3],
        middles: [Option<FlightIndex>; 3],
        longest: usize,
    ) -> Vec<[FlightIndex; 3]> {
        let bends = edges(triangle).map(|edge| self.bend(edge));
        // From that opposite of the longest edge, around.
        let [first, second, third] = [0, 1, 2].map(|step| (longest + step) % 3);
        let [a, b, c] = [first, second, third].map(|corner| triangle[corner]);
        for (one, other, of_two) in [(first, second, third), (second, third, first), (third, first, second)] {
            if let [Some(one), Some(other)] = [middles[one], middles[other]] {
                self.foresee([edge(one, other)], bends[of_two].map(Bend::of_half));
            }
        }
        let [on_longest, on_second, on_third] = [first, second, third].map(|edge| middles[edge]);
        let Some(d) = on_longest else { return vec![triangle] };
        if on_second.is_none() || on_third.is_none() {
            let median = match [first, second, third].map(|edge| bends[edge]) {
                [Some(across), Some(one), Some(other)] => Some(Bend::of_median(across, one, other)),
                _ => None,
            };
            self.foresee([edge(a, d)], median);
        }
        match [on_second, on_third] {
            [None, None] => vec![[a, b, d], [a, d, c]],
            [Some(e), None] => vec![[a, b, d], [a, d, e], [e, d, c]],
            [None, Some(f)] => vec![[a, f, d], [f, b, d], [a, d, c]],
            [Some(e), Some(f)] => vec![[a, f, e], [f, b, d], [e, d, c], [f, d, e]],
        }
    }

    /// Notes how edges should be bent, as far as that is known.
    fn foresee<const K: usize>(&mut self, edges: [[FlightIndex; 2]; K], bend: Option<Bend>) {
        if let Some(bend) = bend {
            self.foreseen.extend(edges.map(|edge| (edge, bend)));
        }
    }

    /// How an edge is bent, as far as that is known.
    fn bend(&self, edge: [FlightIndex; 2]) -> Option<Bend> {
        let bend = self.bends.get(&edge).or(self.foreseen.get(&edge))?;
        bend.surplus.is_finite().then_some(*bend)
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
        let tolerance = OF_CHORDS * self.resolution;
        let images: Vec<_> = triangles
            .iter()
            .flat_map(|triangle| match self.sides(survey, *triangle) {
                Some(sides) => patch::polygons(&sides, tolerance),
                None => self.kept_part(survey, *triangle, tolerance).into_iter().collect(),
            })
            .filter(|image| image.len() > 2)
            .collect();
        let least = if self.resolution.is_finite() { self.resolution.powi(2) } else { 0.0 };
        union(&images, least)
    }

    /// The images of the edges of a triangle, around it; none where a corner does not keep the limits.
    fn sides<E>(&self, survey: &Survey<E>, [a, b, c]: [FlightIndex; 3]) -> Option<[Side; 3]> {
        let side = |from, to| self.side(survey, from, to);
        Some([side(a, b)?, side(b, c)?, side(c, a)?])
    }

    fn side<E>(&self, survey: &Survey<E>, from: FlightIndex, to: FlightIndex) -> Option<Side> {
        let parabola = self.image(survey, edge(from, to))?;
        Some(Side { parabola, is_against: from > to })
    }

    /// What is kept of a triangle that is cut; none where its cut is not known.
    fn kept_part<E>(&self, survey: &Survey<E>, triangle: [FlightIndex; 3], tolerance: f64) -> Option<Vec<Point>> {
        let (alone, [one, other]) = alone(survey, triangle)?;
        let [first, between, second] = self.cuts.get(&triangle)?.flights;
        let [start, middle, end] = [first, between, second].map(|flight| survey.kept_point(flight));
        let line = Side { parabola: Parabola::through([start?, end?], middle?), is_against: false };
        let sides = if survey.keeps(alone) {
            // From the cut to the corner that is alone, and back to the cut.
            vec![self.kept_side(survey, alone, other, second, true)?, self.kept_side(survey, alone, one, first, false)?]
        } else {
            vec![
                self.kept_side(survey, other, alone, second, true)?,
                self.side(survey, other, one)?,
                self.kept_side(survey, one, alone, first, false)?,
            ]
        };
        Some([line].iter().chain(&sides).flat_map(|side| side.points(tolerance)).collect())
    }

    /// The image of what is kept of an edge, from its end that is kept to the cut, or against that.
    fn kept_side<E>(
        &self,
        survey: &Survey<E>,
        kept: FlightIndex,
        broken: FlightIndex,
        cut: FlightIndex,
        is_against: bool,
    ) -> Option<Side> {
        let ends = [survey.kept_point(kept)?, survey.kept_point(cut)?];
        let middle = self.amid_kept.get(&edge(kept, broken)).and_then(|amid| survey.kept_point(*amid));
        let parabola = middle.map_or(Parabola::straight(ends), |middle| Parabola::through(ends, middle));
        Some(Side { parabola, is_against })
    }

    fn error<E>(&self, survey: &Survey<E>, triangles: &[[FlightIndex; 3]], covered: &[Polygon]) -> f64 {
        let near = Edge::of(covered, NEAR * self.resolution);
        let of_edge = |edge: [FlightIndex; 2]| {
            let image = self.image(survey, edge)?;
            let flown = self.bends.get(&edge).map(|bend| OF_PARABOLA * bend.surplus);
            let error = flown.or(self.foreseen.get(&edge).map(|bend| bend.surplus)).unwrap_or(f64::INFINITY);
            (error.is_infinite() || is_near(&image, &near)).then_some(error)
        };
        let of_triangle = |triangle: &[FlightIndex; 3]| {
            let of_cut = alone(survey, *triangle)
                .map(|_| self.cuts.get(triangle).map_or(f64::INFINITY, |cut| OF_CUT * cut.chord_error));
            let of_edges = edges(*triangle).into_iter().filter_map(of_edge);
            of_edges.chain(of_cut).fold(0.0, f64::max)
        };
        triangles.iter().map(of_triangle).fold(0.0, f64::max)
    }
}

/// Whether any part of the inside of an edge is near the edge of the union.
fn is_near(image: &Parabola, near: &Edge) -> bool {
    [0.25, 0.5, 0.75].into_iter().any(|part| near.is_near(image.at(part)))
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
