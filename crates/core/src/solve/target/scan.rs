//! The first look at a range: points of low discrepancy, the edges between flights that end in different ways, and where to go down from.

use sobol_burley::sample;

use super::search::{Accuracy, Halt, Point, Search};

/// Points of a scan where the request does not say, by how many numbers vary.
const STARTS: [usize; 4] = [48, 96, 160, 256];
/// The place in the family of scrambled sequences: any is as good.
const SEED: u32 = 0;
/// Where less than this part of the points counts, the edges of what does are looked for.
const FEW: usize = 6;
/// Pairs of points between which an edge is looked for.
const PAIRS: usize = 12;
/// Halvings of each.
const HALVINGS: usize = 12;
/// Points from which the search goes down at most.
const MOST_SEEDS: usize = 24;

/// Flies the start, if it is sound, and points of the range.
pub(super) fn scan<E>(search: &mut Search<E>, starts: usize) -> Result<Vec<Point>, Halt<E>> {
    let dimensions = search.numbers.len();
    let count = if starts > 0 { starts } else { STARTS[dimensions.clamp(1, STARTS.len()) - 1] };
    let start = search.start();
    let mut points = vec![search.flown(&start, Accuracy::OfCase)?];
    let place = |index| if dimensions == 1 { vec![even(index, count)] } else { low_discrepancy(index, dimensions) };
    let places: Vec<_> = (0..count).map(place).collect();
    points.extend(search.all_flown(places.iter().map(Vec::as_slice), Accuracy::OfCase)?);
    Ok(points)
}

/// The part of the range of an even point.
#[expect(clippy::cast_precision_loss, reason = "a handful")]
fn even(index: usize, count: usize) -> f64 {
    index as f64 / (count.max(2) - 1) as f64
}

/// A point of the Sobol sequence, scrambled.
#[expect(clippy::cast_possible_truncation, reason = "hundreds of points of eight numbers")]
fn low_discrepancy(index: usize, dimensions: usize) -> Vec<f64> {
    (0..dimensions).map(|dimension| f64::from(sample(index as u32, dimension as u32, SEED))).collect()
}

/// Where few points count, adds those that halving between unlike neighbours finds.
pub(super) fn look_at_edges<E>(search: &mut Search<E>, points: &mut Vec<Point>) -> Result<(), Halt<E>> {
    let counted = points.iter().filter(|point| point.counts()).count();
    if FEW * counted >= points.len() {
        return Ok(());
    }
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (index, point) in points.iter().enumerate() {
        let unlike = points.iter().enumerate().filter(|(_, other)| other.class() != point.class());
        let distance = |other: &Point| search.distance(&point.place, &other.place);
        let nearest = unlike.map(|(other, point)| (distance(point), other)).min_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((distance, other)) = nearest {
            pairs.push((distance, index.min(other), index.max(other)));
        }
    }
    pairs.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)).then(one.2.cmp(&other.2)));
    pairs.dedup_by_key(|pair| (pair.1, pair.2));
    for (_, one, other) in pairs.into_iter().take(PAIRS) {
        let (mut low, mut high) = (points[one].clone(), points[other].clone());
        for _ in 0..HALVINGS {
            let way = search.way(&low.place, &high.place);
            let middle: Vec<_> = low.place.iter().zip(way).map(|(place, way)| place + 0.5 * way).collect();
            let middle = search.flown(&middle, Accuracy::OfCase)?;
            if middle.counts() {
                points.push(middle.clone());
            }
            // Towards what counts, if either does; else towards what is unlike.
            if middle.class() == low.class() { low = middle } else { high = middle }
        }
    }
    Ok(())
}

/// The points from which to go down: better than their neighbours that end as they do, the best first.
pub(super) fn seeds<E>(search: &Search<E>, points: &[Point]) -> Vec<usize> {
    let neighbours = 2 * search.numbers.len() + 2;
    let is_best = |index: &usize| {
        let point = &points[*index];
        let alike = points.iter().enumerate().filter(|(other, it)| other != index && it.class() == point.class());
        let mut near: Vec<_> =
            alike.map(|(_, other)| (search.distance(&point.place, &other.place), other.merit())).collect();
        near.sort_by(|one, other| one.0.total_cmp(&other.0));
        near.iter().take(neighbours).all(|(_, merit)| point.merit() <= *merit)
    };
    let mut seeds: Vec<_> = (0..points.len()).filter(|index| points[*index].counts()).filter(is_best).collect();
    seeds.sort_by(|one, other| points[*one].merit().total_cmp(&points[*other].merit()));
    seeds.truncate(MOST_SEEDS);
    seeds
}
