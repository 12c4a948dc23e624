//! The values of one number of a case with which flights keep limits: bands, and the gaps between them.
//!
//! The number is sampled evenly. Intervals are halved in which a margin changes much, and some in which flights end in other ways; between samples of which one
//! keeps all limits and the other does not, the end of the band is bracketed.

use crate::root::bracketed;
use crate::trajectory::Termination;

/// What flights with a value of the number say of the limits.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// The value of the number.
    pub value: f64,
    /// The number on which each limit is; none where the flight has none.
    pub numbers: Vec<Option<f64>>,
    /// By how much each limit is kept, in parts of its size; negative where it is broken. None where the flight could not be finished or has
    /// no such number: it is broken then, too.
    pub margins: Vec<Option<f64>>,
    /// How each of the flights ended; none where it could not be finished.
    pub ends: Vec<Option<Termination>>,
}

/// The limits of which a sample is to tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Asked<'a> {
    /// All of them, roughly: what is looked at between the ends of bands, and drawn.
    Roughly,
    /// All of them.
    All,
    /// These, by their places. Of the others a sample may have the margin [`Sample::NOT_ASKED`].
    Only(&'a [usize]),
}

impl Asked<'_> {
    /// Whether a limit is among them.
    pub fn has(&self, limit: usize) -> bool {
        match self {
            Self::Roughly | Self::All => true,
            Self::Only(limits) => limits.contains(&limit),
        }
    }
}

/// An end of a band.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Edge {
    /// The last value with which all limits are kept.
    pub value: f64,
    /// The limit that is broken beyond; none where the band ends with the range of the number.
    pub limit: Option<usize>,
}

/// A range of values with which all limits are kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Band {
    /// The lower end.
    pub from: Edge,
    /// The upper end.
    pub to: Edge,
}

/// A range of values with which a limit is broken.
#[derive(Clone, Debug, PartialEq)]
pub struct Gap {
    /// Where it begins.
    pub from: f64,
    /// Where it ends.
    pub to: f64,
    /// The limits that are broken somewhere in it.
    pub broken: Vec<usize>,
}

/// The bands of a range of values.
#[derive(Clone, Debug, PartialEq)]
pub struct Corridor {
    /// In ascending order.
    pub bands: Vec<Band>,
    /// In ascending order.
    pub gaps: Vec<Gap>,
    /// All values that were flown but for those that bracket the ends of bands, ascending.
    pub samples: Vec<Sample>,
    /// Where there is no band, the value with which the worst margin is best, and that margin.
    pub nearest: Option<(f64, f64)>,
    /// The greatest distance of neighbouring samples of a gap: a narrower band may have been missed.
    pub narrowest: f64,
}

/// Intervals into which the range is divided at first.
const INTERVALS: usize = 32;
/// How often an interval is halved at most,
const HALVINGS: usize = 8;
/// and where flights end otherwise, and no margin changes much.
const HALVINGS_FOR_ENDS: usize = 4;
/// The change of a margin above which an interval is halved.
const MUCH: f64 = 0.3;
/// Margins count up to here, either way.
const CUT: f64 = 1.5;
/// The samples at most: where margins jump everywhere, the search ends with what it has.
const MOST_SAMPLES: usize = 1000;
/// The part of the range to which the best value is located where there is no band.
const NEAREST: f64 = 1e-6;

/// The bands within a range, whose ends are located to `resolution`. `judge` flies all of several values for the limits that are asked for.
///
/// # Errors
/// Those of `judge`.
pub fn corridor<E>(
    [least, greatest]: [f64; 2],
    resolution: f64,
    mut judge: impl FnMut(&[f64], Asked) -> Result<Vec<Sample>, E>,
) -> Result<Corridor, E> {
    let value = |index: usize| {
        #[expect(clippy::cast_precision_loss, reason = "a handful")]
        let part = index as f64 / INTERVALS as f64;
        // The end itself, and no rounding beyond it.
        if index == INTERVALS { greatest } else { least + part * (greatest - least) }
    };
    let values: Vec<_> = (0..=INTERVALS).map(value).collect();
    let mut samples = judge(&values, Asked::Roughly)?;
    for round in 0..HALVINGS {
        let middles = middles(&samples, round);
        if middles.is_empty() {
            break;
        }
        samples.extend(judge(&middles, Asked::Roughly)?);
        samples.sort_by(|one, other| one.value.total_cmp(&other.value));
    }
    let is_kept = |samples: &[Sample]| samples.iter().any(Sample::keeps_all);
    if !is_kept(&samples) {
        climb(&mut samples, NEAREST * (greatest - least), &mut |value| judged(&mut judge, value, Asked::All))?;
    }
    let nearest =
        (!is_kept(&samples)).then(|| best(&samples)).map(|best| (samples[best].value, samples[best].worst().1));
    let mut corridor = Corridor { bands: Vec::new(), gaps: Vec::new(), samples, nearest, narrowest: 0.0 };
    corridor.divide(resolution, &mut |value, asked| judged(&mut judge, value, asked))?;
    Ok(corridor)
}

/// The sample of one value.
fn judged<E>(
    judge: &mut impl FnMut(&[f64], Asked) -> Result<Vec<Sample>, E>,
    value: f64,
    asked: Asked,
) -> Result<Sample, E> {
    // What is not known counts as broken.
    let unknown = || Sample { value, numbers: vec![None], margins: vec![None], ends: Vec::new() };
    Ok(judge(&[value], asked)?.pop().unwrap_or_else(unknown))
}

/// The middles of the intervals that are to be halved.
fn middles(samples: &[Sample], round: usize) -> Vec<f64> {
    let is_to_halve = |before: &Sample, after: &Sample| {
        before.differs_much(after) || round < HALVINGS_FOR_ENDS && before.ends != after.ends
    };
    let pairs = samples.windows(2).filter(|pair| is_to_halve(&pair[0], &pair[1]));
    let middles = pairs.map(|pair| 0.5 * (pair[0].value + pair[1].value));
    middles.take(MOST_SAMPLES.saturating_sub(samples.len())).collect()
}

/// The place of the sample whose worst margin is best.
fn best(samples: &[Sample]) -> usize {
    let worst = |sample: &Sample| sample.worst().1;
    let places = samples.iter().enumerate();
    places.max_by(|one, other| worst(one.1).total_cmp(&worst(other.1))).map_or(0, |(place, _)| place)
}

/// Adds samples about the best, by golden section, until its place is known to `resolution` or all limits are kept.
fn climb<E>(
    samples: &mut Vec<Sample>,
    resolution: f64,
    judge: &mut impl FnMut(f64) -> Result<Sample, E>,
) -> Result<(), E> {
    loop {
        let best = best(samples);
        let value = samples[best].value;
        let [below, above] = [best.checked_sub(1), Some(best + 1)].map(|place| {
            let neighbour = place.and_then(|place| samples.get(place));
            neighbour.map_or(0.0, |neighbour| neighbour.value - value)
        });
        let wider = if above > -below { above } else { below };
        if wider.abs() <= resolution || samples[best].keeps_all() {
            return Ok(());
        }
        let sample = judge(value + GOLDEN * wider)?;
        samples.insert(if wider > 0.0 { best + 1 } else { best }, sample);
    }
}

/// The smaller part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

impl Corridor {
    /// Finds the bands and the gaps between the samples.
    fn divide<E>(&mut self, resolution: f64, judge: &mut impl FnMut(f64, Asked) -> Result<Sample, E>) -> Result<(), E> {
        let Self { bands, gaps, samples, narrowest, .. } = self;
        let [Some(first), Some(last)] = [samples.first(), samples.last()] else { return Ok(()) };
        let mut start = Edge { value: first.value, limit: None };
        let mut broken: Vec<usize> = Vec::new();
        let gap = |from: f64, to: f64, broken: &mut Vec<usize>| {
            broken.sort_unstable();
            broken.dedup();
            Gap { from, to, broken: std::mem::take(broken) }
        };
        for pair in samples.windows(2) {
            let [before, after] = [&pair[0], &pair[1]];
            broken.extend(before.broken());
            match (before.keeps_all(), after.keeps_all()) {
                (true, true) => {}
                (false, false) => *narrowest = narrowest.max(after.value - before.value),
                (true, false) => {
                    let (kept, beyond) = edge(before, after, resolution, judge)?;
                    bands.push(Band { from: start, to: kept });
                    start = Edge { value: beyond, limit: None };
                }
                (false, true) => {
                    let (kept, beyond) = edge(after, before, resolution, judge)?;
                    gaps.push(gap(start.value, beyond, &mut broken));
                    start = kept;
                }
            }
        }
        broken.extend(last.broken());
        let end = Edge { value: last.value, limit: None };
        if last.keeps_all() {
            bands.push(Band { from: start, to: end });
        } else {
            gaps.push(gap(start.value, end.value, &mut broken));
        }
        Ok(())
    }
}

/// The end of a band between a sample in it and one outside, and the first value beyond it that was flown.
///
/// It is located by the limits that are broken outside; the others are flown at the end itself. Where one of them is broken there, it ends the
/// band before, and the end is located once more, by all.
fn edge<E>(
    inside: &Sample,
    outside: &Sample,
    resolution: f64,
    judge: &mut impl FnMut(f64, Asked) -> Result<Sample, E>,
) -> Result<(Edge, f64), E> {
    let broken: Vec<_> = outside.broken().collect();
    let others: Vec<_> = (0..outside.margins.len()).filter(|limit| !broken.contains(limit)).collect();
    let (end, beyond) = edge_of(inside, outside, resolution, &mut |value| judge(value, Asked::Only(&broken)))?;
    if others.is_empty() {
        return Ok((end, beyond));
    }
    let at_end = judge(end.value, Asked::Only(&others))?;
    if at_end.keeps_all() {
        return Ok((end, beyond));
    }
    edge_of(inside, &at_end, resolution, &mut |value| judge(value, Asked::All))
}

/// The end of a band by the limits that `judge` flies.
fn edge_of<E>(
    inside: &Sample,
    outside: &Sample,
    resolution: f64,
    judge: &mut impl FnMut(f64) -> Result<Sample, E>,
) -> Result<(Edge, f64), E> {
    let (mut kept, mut beyond) = (inside.value, (outside.value, outside.worst().0));
    let mut failure = None;
    let margin = |value: f64| match judge(value) {
        Ok(sample) => {
            let (limit, worst) = sample.worst();
            if sample.keeps_all() {
                kept = value;
            } else {
                beyond = (value, limit);
            }
            worst
        }
        Err(error) => {
            failure = Some(error);
            // Nothing further is flown.
            0.0
        }
    };
    bracketed(margin, (inside.value, inside.worst().1), (outside.value, outside.worst().1), resolution);
    failure.map_or(Ok((Edge { value: kept, limit: Some(beyond.1) }, beyond.0)), Err)
}

impl Sample {
    /// The margin of a limit for which nobody asked: it counts as kept.
    pub const NOT_ASKED: Option<f64> = Some(f64::INFINITY);

    /// The limit with the worst margin, and that margin, cut.
    fn worst(&self) -> (usize, f64) {
        let margins = self.margins.iter().map(|margin| cut(*margin)).enumerate();
        margins.min_by(|one, other| one.1.total_cmp(&other.1)).unwrap_or((0, CUT))
    }

    fn keeps_all(&self) -> bool {
        self.worst().1 >= 0.0
    }

    /// The limits that are broken.
    fn broken(&self) -> impl Iterator<Item = usize> {
        let margins = self.margins.iter().enumerate();
        margins.filter(|(_, margin)| cut(**margin) < 0.0).map(|(limit, _)| limit)
    }

    /// Whether there may be more between two samples than they show.
    fn differs_much(&self, other: &Self) -> bool {
        self.margins.iter().zip(&other.margins).any(|(one, other)| (cut(*one) - cut(*other)).abs() > MUCH)
    }
}

/// A margin as far as it counts.
fn cut(margin: Option<f64>) -> f64 {
    margin.filter(|margin| !margin.is_nan()).unwrap_or(-CUT).clamp(-CUT, CUT)
}

#[cfg(test)]
mod tests {
    use super::{Asked, Corridor, Sample, corridor};

    fn of(margins: impl Fn(f64) -> Vec<f64>, between: [f64; 2]) -> (Corridor, usize) {
        let mut flights = 0;
        let judge = |values: &[f64], _: Asked| {
            flights += values.len();
            let sample = |value: &f64| {
                let margins: Vec<_> = margins(*value).into_iter().map(Some).collect();
                Sample { value: *value, numbers: margins.clone(), margins, ends: Vec::new() }
            };
            Ok::<_, ()>(values.iter().map(sample).collect())
        };
        let found = corridor(between, 1e-9 * (between[1] - between[0]), judge);
        (found.unwrap_or_else(|()| unreachable!("no flight fails")), flights)
    }

    #[test]
    fn a_band_lies_between_its_limits() {
        let (found, flights) = of(|x| vec![x * x - 2.0, 9.0 - x * x], [0.0, 10.0]);
        let [band] = found.bands[..] else { panic!("{:?}", found.bands) };
        assert!((band.from.value - 2.0_f64.sqrt()).abs() < 2e-8 && (band.to.value - 3.0).abs() < 2e-8);
        assert_eq!((band.from.limit, band.to.limit), (Some(0), Some(1)));
        assert!(found.gaps[0].broken == [0] && found.gaps[1].broken == [1]);
        assert!(flights < 100, "{flights} flights");
    }

    #[test]
    fn the_ends_of_the_range_are_flown_as_they_are() {
        for between in [[-0.7, 0.1], [0.1, 1.1], [-361.3, 359.9], [1e-300, 0.3]] {
            let (found, _) = of(|_| vec![1.0], between);
            let [band] = found.bands[..] else { panic!("{:?}", found.bands) };
            assert_eq!([band.from.value, band.to.value].map(f64::to_bits), between.map(f64::to_bits));
        }
    }

    #[test]
    fn several_bands_end_with_the_range() {
        let (found, _) = of(|x| vec![x.cos()], [0.0, 7.0]);
        let ends: Vec<_> = found.bands.iter().map(|band| (band.from.limit, band.to.limit)).collect();
        assert_eq!(ends, [(None, Some(0)), (Some(0), None)]);
        assert!((found.bands[0].to.value - std::f64::consts::FRAC_PI_2).abs() < 1e-8);
    }

    #[test]
    fn at_the_ends_of_bands_limits_are_flown_that_may_end_them() {
        let check = |second: fn(f64) -> f64, ends: [f64; 2], limits: [usize; 2], most: usize| {
            let mut flights = [0, 0];
            let judge = |values: &[f64], asked: Asked| {
                let sample = |value: &f64| {
                    let margins = [value - 0.2003, second(*value)];
                    let margin = |limit: usize| {
                        flights[limit] += usize::from(asked.has(limit));
                        if asked.has(limit) { Some(margins[limit]) } else { Sample::NOT_ASKED }
                    };
                    let margins: Vec<_> = [0, 1].map(margin).to_vec();
                    Sample { value: *value, numbers: margins.clone(), margins, ends: Vec::new() }
                };
                Ok::<_, ()>(values.iter().map(sample).collect())
            };
            let found = corridor([0.0, 1.0], 1e-9, judge).unwrap_or_else(|()| unreachable!("no flight fails"));
            let [band] = found.bands[..] else { panic!("{:?}", found.bands) };
            let [from, to] = [band.from, band.to];
            assert!((from.value - ends[0]).abs() < 2e-9 && (to.value - ends[1]).abs() < 2e-9, "{band:?}");
            assert_eq!([from.limit, to.limit], limits.map(Some));
            let at_ends = flights.map(|flights| flights - found.samples.len());
            assert!(at_ends.into_iter().sum::<usize>() <= most, "{at_ends:?}");
        };
        check(|x| 0.6 - x, [0.2003, 0.6], [0, 1], 20);
        // Beside the end by the first limit, which is broken alone at the sample outside, the second is broken as well.
        check(|x| (0.6 - x).min(1e3 * (x - 0.2003).abs() - 0.1), [0.2004, 0.6], [1, 1], 100);
    }

    #[test]
    fn a_band_of_a_thousandth_is_found_by_its_margins() {
        let (found, _) = of(|x| vec![1e-3 - (x - 0.3333).abs()], [0.0, 1.0]);
        let [band] = found.bands[..] else { panic!("{:?}", found.bands) };
        assert!((band.from.value - 0.3323).abs() < 1e-8 && (band.to.value - 0.3343).abs() < 1e-8);
    }

    #[test]
    fn where_there_is_no_band_the_nearest_value_is_told() {
        let (found, _) = of(|x| vec![0.4 - x, x - 0.6], [0.0, 1.0]);
        assert!(found.bands.is_empty() && found.gaps.len() == 1 && found.gaps[0].broken == [0, 1]);
        let (value, margin) = found.nearest.unwrap_or_default();
        assert!((value - 0.5).abs() < 1e-5 && (margin + 0.1).abs() < 1e-5, "{value} {margin}");
    }
}
