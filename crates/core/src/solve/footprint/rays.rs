//! Where flights land when three and more numbers vary: from a place within, as far in every direction as flights reach.

use std::f64::consts::TAU;

use nalgebra::{Matrix2, SymmetricEigen, Vector2};

use super::maximise::{Objective, best, maximise};
use super::plane::Point;
use super::survey::{FlightIndex, Halt, Survey, from_line};
use crate::elementary::sin_cos;

/// The distance from a centre in a direction, and how far a landing is off that ray, on a map that makes the landings round.
struct Ray {
    centre: Point,
    round: Matrix2<f64>,
    direction: f64,
}

impl<E> Objective<E> for Ray {
    fn value(&self, survey: &Survey<E>, flight: FlightIndex) -> Option<f64> {
        survey.point(flight).map(|point| self.along_and_across(point)[0])
    }

    fn offset(&self, survey: &Survey<E>, flight: FlightIndex) -> f64 {
        survey.point(flight).map_or(0.0, |point| self.along_and_across(point)[1])
    }
}

impl Ray {
    fn along_and_across(&self, [x, y]: Point) -> [f64; 2] {
        let place = self.round * Vector2::new(x - self.centre[0], y - self.centre[1]);
        let (sine, cosine) = sin_cos(self.direction);
        [place.x * cosine + place.y * sine, place.y * cosine - place.x * sine]
    }
}

/// Directions at first.
const FIRST_DIRECTIONS: u32 = 24;
/// Directions at most.
const MOST_DIRECTIONS: usize = 96;

/// A star domain: the landings that are farthest from a centre, by their direction.
pub(super) struct StarDomain {
    centre: Point,
    /// Takes landings to a map on which their spread is 1 in every direction: a long footprint has as many directions along its sides as at its
    /// ends.
    round: Matrix2<f64>,
    /// The length of the round map in the direction in which it is longest, m.
    size: f64,
    resolution: f64,
    /// Ascending.
    rays: Vec<(f64, FlightIndex)>,
    /// By how much the chord from each to the next may be off, m: without bound before that is known.
    chord_errors: Vec<f64>,
}

impl StarDomain {
    /// About the mean of the landings of a scan that keep all limits; none where there is none.
    pub(super) fn new<E>(survey: &Survey<E>, resolution: f64) -> Option<Self> {
        let points = || (0..survey.flights.len()).filter_map(|flight| survey.kept_point(flight)).map(Vector2::from);
        #[expect(clippy::cast_precision_loss, reason = "hundreds of flights")]
        let count = points().count() as f64;
        if count == 0.0 {
            return None;
        }
        let centre = points().sum::<Vector2<f64>>() / count;
        let squares = points().map(|point| (point - centre) * (point - centre).transpose());
        let spread = SymmetricEigen::new(squares.sum::<Matrix2<f64>>() / count);
        // Along a line there is no spread across: that of the resolution is taken.
        let lengths = spread.eigenvalues.map(|square| square.max(resolution * resolution).sqrt());
        let round = Matrix2::from_diagonal(&lengths.map(f64::recip)) * spread.eigenvectors.transpose();
        let size = lengths.max();
        Some(Self { centre: centre.into(), round, size, resolution, rays: Vec::new(), chord_errors: Vec::new() })
    }

    /// Finds how far flights reach in every direction, until chords between directions are as exact as the resolution.
    pub(super) fn reach<E>(&mut self, survey: &mut Survey<E>) -> Result<(), Halt<E>> {
        let scan: Vec<FlightIndex> = (0..survey.flights.len()).collect();
        for index in 0..FIRST_DIRECTIONS {
            let direction = f64::from(index) / f64::from(FIRST_DIRECTIONS) * TAU;
            let ray = self.ray(direction);
            let last = self.rays.last().map(|(_, flight)| *flight);
            let start = best(survey, scan.iter().copied().chain(last), &ray).unwrap_or_default();
            let flight = maximise(survey, start, &ray, self.least())?;
            self.rays.push((direction, flight));
            self.chord_errors.push(f64::INFINITY);
        }
        // Once more around, from what the neighbours have found.
        for index in (0..self.rays.len()).rev() {
            let (direction, own) = self.rays[index];
            let ray = self.ray(direction);
            let next = self.rays[(index + 1) % self.rays.len()].1;
            let from_next = maximise(survey, next, &ray, self.least())?;
            self.rays[index].1 = best(survey, [own, from_next].into_iter(), &ray).unwrap_or(own);
        }
        while self.error() > self.resolution && self.rays.len() < MOST_DIRECTIONS {
            self.halve_worst(survey)?;
        }
        Ok(())
    }

    /// By how much a chord may be off, m: without bound before that is known.
    pub(super) fn error(&self) -> f64 {
        self.chord_errors.iter().copied().reduce(f64::max).unwrap_or(f64::INFINITY)
    }

    /// Finds how far flights reach in the middle of the directions between which the chord is off most.
    fn halve_worst<E>(&mut self, survey: &mut Survey<E>) -> Result<(), Halt<E>> {
        let errors = self.chord_errors.iter().enumerate();
        let Some((worst, _)) = errors.max_by(|one, other| one.1.total_cmp(other.1)) else { return Ok(()) };
        let (direction, flight) = self.rays[worst];
        let (next_direction, next) = self.rays[(worst + 1) % self.rays.len()];
        let middle = direction + 0.5 * (next_direction - direction).rem_euclid(TAU);
        let ray = self.ray(middle);
        let start = best(survey, [flight, next].into_iter(), &ray).unwrap_or(flight);
        let found = maximise(survey, start, &ray, self.least())?;
        let error = match [found, flight, next].map(|flight| survey.kept_point(flight)) {
            [Some(found), Some(one), Some(other)] => from_line(found, one, other),
            _ => f64::INFINITY,
        };
        self.chord_errors[worst] = error;
        self.chord_errors.insert(worst + 1, error);
        self.rays.insert(worst + 1, (middle, found));
        Ok(())
    }

    fn ray(&self, direction: f64) -> Ray {
        Ray { centre: self.centre, round: self.round, direction }
    }

    /// What a step is to gain at least, on the round map.
    fn least(&self) -> f64 {
        0.1 * self.resolution / self.size
    }

    /// The ring of the landings that keep all limits.
    pub(super) fn ring<E>(&self, survey: &Survey<E>) -> Vec<Point> {
        self.rays.iter().filter_map(|(_, flight)| survey.kept_point(*flight)).collect()
    }
}
