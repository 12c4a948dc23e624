//! The ground track of a flight: how far it leads over the sphere of the equatorial radius, and how far along the great circle on
//! which the flight sets out.

use super::stored_step::{Motion, StoredStep};
use crate::coordinates::{GreatCircle, PlanetFixed, ground_rate, wrap_to_half_turns};
use crate::elementary::atan2;

/// The ground track, piece by piece. Its lengths are angles at the planet's centre, rad.
#[derive(Clone, Debug, Default)]
pub(crate) struct GroundTrack {
    /// In the order of time; each ends where the next begins.
    pieces: Vec<Piece>,
    /// Up to the end of the last piece.
    length: f64,
    /// At the end of the last piece, counted on over whole turns.
    along: f64,
}

/// A piece that stays on its side of the pole of the great circle, and on which the rate is a polynomial to rounding.
#[derive(Clone, Debug)]
struct Piece {
    /// When it begins, s.
    start: f64,
    /// How long it lasts, s.
    duration: f64,
    /// The length of the track up to its beginning.
    length: f64,
    /// The angle along the great circle at its beginning, counted on over whole turns.
    along: f64,
    /// The rate of the length, rad/s, as a series of Legendre polynomials of the time, which runs from -1 to 1.
    rate: [f64; POINTS],
}

/// The abscissas and weights of the Gauss-Legendre quadrature of eight points, exact for polynomials of degree 15: those above zero.
///
/// # Reference
/// M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 1964, table 25.4.
const GAUSS: [(f64, f64); POINTS / 2] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_47),
    (0.960_289_856_497_536_2, 0.101_228_536_290_376_26),
];
const POINTS: usize = 8;

/// The last two terms of a series may be this part of the first. The error inside a piece is that of the terms that would follow, over
/// their order, and less than a hundredth of it; over a whole piece the quadrature is exact to twice the order.
const RELATIVE_ERROR: f64 = 1e-8;
/// An error in the length of a piece that is accepted in any case, rad: a micrometre on the Earth. It ends the halving where a flight
/// comes to rest and turns back, at which its speed has a corner.
const NEGLIGIBLE: f64 = 1e-13;
/// Shorter pieces are not halved to find on which side they pass the pole of the great circle, rad: a millimetre on the Earth.
const NEAREST_TO_POLE: f64 = 1e-10;
/// How often a step is halved at most.
const MOST_HALVINGS: u32 = 40;

impl GroundTrack {
    /// Adds a step of the flight, of which the state at its start is known; returns that at its end.
    pub(super) fn extend(
        &mut self,
        motion: &Motion,
        step: &StoredStep,
        first: &PlanetFixed<f64>,
        circle: &GreatCircle,
    ) -> PlanetFixed<f64> {
        let interpolant = motion.interpolant(&step.step);
        let state = |time| interpolant.at(motion, time).planet_fixed();
        let (times, last) = ([step.start_time(), step.end_time()], motion.end(&step.step).planet_fixed());
        if times[0] < times[1] {
            self.add(&state, times, [first, &last], circle, MOST_HALVINGS);
        }
        last
    }

    /// Adds the piece between two times, s, at which the states are `first` and `last`, or both its halves.
    fn add(
        &mut self,
        state: &impl Fn(f64) -> PlanetFixed<f64>,
        [start, end]: [f64; 2],
        [first, last]: [&PlanetFixed<f64>; 2],
        circle: &GreatCircle,
        halvings: u32,
    ) {
        let duration = end - start;
        let mut rate = legendre_series(|place| ground_rate(&state(start + 0.5 * (place + 1.0) * duration)));
        if !rate.iter().all(|term| term.is_finite()) {
            // The dense output of a step may overflow where its ends do not: the straight way is what is known.
            rate = [0.0; POINTS];
            rate[0] = atan2(first.position.cross(&last.position).norm(), first.position.dot(&last.position)) / duration;
        }
        let length = rate[0] * duration;
        let rest = (rate[POINTS - 1].abs() + rate[POINTS - 2].abs()) * duration;
        let is_smooth = rest <= RELATIVE_ERROR * length || rest <= NEGLIGIBLE;
        // A piece that is shorter than the way to the pole cannot lead round it.
        let is_clear = circle.sine_to_pole(&first.position).is_none_or(|sine| length < sine);
        let middle = start + 0.5 * duration;
        let may_halve = halvings > 0 && start < middle && middle < end;
        if may_halve && !(is_smooth && (is_clear || length < NEAREST_TO_POLE)) {
            let between = state(middle);
            self.add(state, [start, middle], [first, &between], circle, halvings - 1);
            self.add(state, [middle, end], [&between, last], circle, halvings - 1);
            return;
        }
        self.pieces.push(Piece { start, duration, length: self.length, along: self.along, rate });
        self.length += length;
        if let Some(along) = circle.along(&last.position) {
            let turned = wrap_to_half_turns(along - self.along);
            // Through the pole, on neither side of it, the angle goes on by half a turn.
            self.along += if is_clear { turned } else { turned.abs() };
        }
    }

    /// The length of the track up to a time of the flight, s, and the angle along the great circle at the beginning of the piece then.
    pub(super) fn length_and_along(&self, time: f64) -> [f64; 2] {
        let following = self.pieces.partition_point(|piece| piece.start <= time);
        let piece = self.pieces.get(following.saturating_sub(1));
        piece.map_or([0.0; 2], |piece| [piece.length_at(time), piece.along])
    }
}

impl Piece {
    fn length_at(&self, time: f64) -> f64 {
        let part = ((time - self.start) / self.duration).clamp(0.0, 1.0);
        // A polynomial may fall below zero by a rounding; the track does not lead back.
        let inside = 0.5 * self.duration * integral(&self.rate, 2.0 * part - 1.0);
        self.length + inside.max(0.0)
    }
}

/// The first terms of the series of Legendre polynomials of a function on [-1, 1]: those of the polynomial that meets it at the points of
/// the quadrature.
fn legendre_series(function: impl Fn(f64) -> f64) -> [f64; POINTS] {
    let mut series = [0.0; POINTS];
    for ((point, _), shares) in GAUSS.iter().zip(SHARES) {
        let [below, above] = [function(-point), function(*point)];
        // P_k(-x) = (-1)^k P_k(x)
        for (pair, share) in series.chunks_exact_mut(2).zip(shares.chunks_exact(2)) {
            pair[0] += share[0] * (above + below);
            pair[1] += share[1] * (above - below);
        }
    }
    series
}

/// The share of the value at a point of the quadrature in each term of the series: `(k + ½) w P_k(x)`.
const SHARES: [[f64; POINTS]; POINTS / 2] = {
    let mut shares = [[0.0; POINTS]; POINTS / 2];
    let mut of_point = 0;
    while of_point < POINTS / 2 {
        let (point, weight) = GAUSS[of_point];
        let (mut last, mut this, mut order) = (0.0, 1.0, 0.0);
        let mut term = 0;
        while term < POINTS {
            shares[of_point][term] = (order + 0.5) * weight * this;
            (last, this) = (this, next_legendre(order, point, last, this));
            order += 1.0;
            term += 1;
        }
        of_point += 1;
    }
    shares
};

/// The integral of a series of Legendre polynomials from -1 to a place.
///
/// ```text
/// ∫ P_0 = x + 1,   ∫ P_k = (P_{k+1} - P_{k-1}) / (2k + 1)
/// ```
fn integral(series: &[f64; POINTS], place: f64) -> f64 {
    let mut sum = series[0] * (place + 1.0);
    let (mut last, mut this) = (1.0, place);
    for (term, order) in series.iter().zip(0_u8..).skip(1) {
        let order = f64::from(order);
        let next = next_legendre(order, place, last, this);
        sum += term * (next - last) / (2.0 * order + 1.0);
        (last, this) = (this, next);
    }
    sum
}

/// The Legendre polynomial that follows that of an order and the one before it, at a place.
///
/// ```text
/// (k + 1) P_{k+1} = (2k + 1) x P_k - k P_{k-1}
/// ```
///
/// # Reference
/// M. Abramowitz and I. A. Stegun, Handbook of Mathematical Functions, 1964, equation 22.7.10.
const fn next_legendre(order: f64, place: f64, last: f64, this: f64) -> f64 {
    ((2.0 * order + 1.0) * place * this - order * last) / (order + 1.0)
}
