//! Times of contenders on a noisy machine.

use std::hint::black_box;
use std::time::Instant;

/// A contender whose result counts as used.
pub fn timed<T>(mut job: impl FnMut() -> T) -> impl FnMut() {
    move || {
        black_box(job());
    }
}

/// The median seconds of each contender; they take turns, for so many rounds.
pub fn medians<const K: usize>(rounds: usize, mut contenders: [&mut dyn FnMut(); K]) -> [f64; K] {
    let mut times = [(); K].map(|()| Vec::with_capacity(rounds));
    for _ in 0..rounds {
        for (contender, times) in contenders.iter_mut().zip(&mut times) {
            let start = Instant::now();
            contender();
            times.push(start.elapsed().as_secs_f64());
        }
    }
    times.map(|mut times| {
        times.sort_by(f64::total_cmp);
        times[rounds / 2]
    })
}
