//! `cargo bench`: what a flight costs, beside another integrator and beside its parts.
//!
//! The machines are noisy: contenders take turns, and each line gives the median of many rounds, and the ratio of medians within one run.

use std::hint::black_box;
use std::sync::atomic::AtomicBool;
use std::time::Instant;

use ode_solvers::{Dop853, SVector, System as OdeSystem};
use reentry::integrate::System;
use reentry::motion::Cartesian;
use reentry::{Case, Scenario, simulate};
use reentry_service::wire::json;
use reentry_service::wire::scenario::{Job, Wanted};
use reentry_tests::cases::thesis_cases;

fn main() {
    let rounds = 300;
    let names = ["target_1", "target_2", "impulse", "shallow_glide"];
    for name in names {
        let scenario = scenario(name);
        let interrupt = AtomicBool::new(false);
        let flight = simulate(&scenario, &interrupt).unwrap();
        let end = flight.end_time();
        let case = *scenario.case();
        let [ours, theirs] = medians(
            rounds,
            [
                &mut || {
                    black_box(simulate(&scenario, &interrupt).unwrap());
                },
                &mut || {
                    black_box(ode_solvers(&case, end, case.solver.relative_tolerance));
                },
            ],
        );
        let statistics = flight.statistics();
        println!("{name}: {:.1} µs {statistics:?}; ode_solvers {:.1} µs", ours * 1e6, theirs * 1e6);
    }
}

fn scenario(name: &str) -> Scenario {
    let case = thesis_cases().into_iter().find(|case| case.name == name && case.model == "earth_wgs84").unwrap();
    let tree = json::parse(case.request.to_string().as_bytes()).unwrap();
    Job::try_from_tree(tree, Wanted::Answer).unwrap().scenario
}

struct Motion(Cartesian);
impl OdeSystem<f64, SVector<f64, 6>> for Motion {
    fn system(&self, _: f64, state: &SVector<f64, 6>, derivative: &mut SVector<f64, 6>) {
        *derivative = SVector::from(self.0.derivative(&(*state).into()));
    }
}

fn ode_solvers(case: &Case, end: f64, tolerance: f64) -> [f64; 6] {
    let state: [f64; 6] = case.initial_state.into();
    let mut solver =
        Dop853::new(Motion(Cartesian(case.forces())), 0.0, end, end, SVector::from(state), tolerance, 1e-3);
    solver.integrate().unwrap();
    (*solver.y_out().last().unwrap()).into()
}

/// The median seconds of each contender, which take turns.
fn medians<const K: usize>(rounds: usize, mut contenders: [&mut dyn FnMut(); K]) -> [f64; K] {
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
