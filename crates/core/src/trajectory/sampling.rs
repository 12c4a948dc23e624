//! At which instants a flight is looked at.

use super::Trajectory;

/// The instants at which a trajectory is wanted; its start and its end always belong to them.
#[derive(Clone, Debug, PartialEq)]
pub enum Sampling {
    /// So many a step, the last at its end: many where the motion is fast, few where it is slow.
    PerStep(usize),
    /// Every so many seconds of the clock, whenever the flight starts.
    Interval(f64),
    /// So many, evenly in time, both ends included.
    Count(usize),
    /// These, ascending, in s; those after the end are dropped.
    Times(Vec<f64>),
}

/// The flight asks for more instants than allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the flight gives more than the {limit} rows allowed")]
pub struct TooManyInstants {
    /// The limit.
    pub limit: usize,
}

impl Trajectory {
    /// The instants of a sampling, strictly increasing, s.
    ///
    /// # Errors
    /// When there are more than `limit`.
    pub fn instants(&self, sampling: &Sampling, limit: usize) -> Result<Vec<f64>, TooManyInstants> {
        let (start, end) = (self.flown.start.time, self.end_time());
        let wanted = match sampling {
            Sampling::PerStep(samples) => samples.saturating_mul(self.flown.steps.len()),
            Sampling::Count(count) => *count,
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "not negative, and more than fits is more than allowed"
            )]
            Sampling::Interval(interval) => ((end - start) / interval) as usize,
            Sampling::Times(_) => 0,
        };
        if wanted > limit {
            return Err(TooManyInstants { limit });
        }
        let mut instants = Instants { times: vec![start], start, end, limit };
        match sampling {
            Sampling::PerStep(samples) => {
                for step in &self.flown.steps {
                    for sample in 1..=*samples {
                        instants.push(step.time(ratio(sample, *samples)))?;
                    }
                }
            }
            Sampling::Interval(interval) => {
                let before = (start / interval).floor();
                for sample in 1..=wanted + 1 {
                    instants.push((before + ratio(sample, 1)) * interval)?;
                }
            }
            Sampling::Count(count) => {
                for sample in 1..count - 1 {
                    instants.push(start + (end - start) * ratio(sample, count - 1))?;
                }
            }
            Sampling::Times(times) => {
                for time in times {
                    instants.push(*time)?;
                }
            }
        }
        instants.finish()
    }
}

/// Instants between the start and the end, as they are gathered.
struct Instants {
    times: Vec<f64>,
    start: f64,
    end: f64,
    limit: usize,
}

impl Instants {
    /// Adds an instant that follows the last and comes before the end; false once the end is reached.
    fn push(&mut self, time: f64) -> Result<bool, TooManyInstants> {
        let inside = time < self.end;
        let last = self.times.last().copied().unwrap_or(self.start);
        if inside && time > last {
            // The final instant still has to find a place.
            if self.times.len() + 1 >= self.limit {
                return Err(TooManyInstants { limit: self.limit });
            }
            self.times.push(time);
        }
        Ok(inside)
    }

    fn finish(mut self) -> Result<Vec<f64>, TooManyInstants> {
        if self.end > self.start {
            self.times.push(self.end);
        }
        if self.times.len() > self.limit { Err(TooManyInstants { limit: self.limit }) } else { Ok(self.times) }
    }
}

#[expect(clippy::cast_precision_loss, reason = "rows are counted far below 2^52")]
fn ratio(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}
