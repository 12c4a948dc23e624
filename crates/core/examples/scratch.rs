//! x
#![allow(missing_docs)]
use std::sync::atomic::AtomicBool;
use std::sync::Arc;
use std::hint::black_box;
use std::time::Instant;
use reentry::*;
use reentry::control::*;
use reentry::planet::*;
use reentry::integrate::System;
use reentry::motion::Cartesian;
fn target_2() -> Case {
    let entry = FlightPath { radius: 6_500_140.0, longitude: -1.347_32, geocentric_latitude: 0.651_76, speed: 3_007.2, flight_path_angle: -0.523_599, heading: 1.195_427 };
    Case { planet: Planet::EARTH_WGS84.spherical(), atmosphere: Atmosphere::EARTH_JAMESON, density_factor: 1.0, wind: Wind::Still,
        vehicle: Vehicle { mass: 700.0, reference_area: 0.216_419, aerodynamics: Aerodynamics::Constant { lift_coefficient: 0.2, drag_coefficient: 0.2 } },
        control: Control::banked(0.8), initial_state: entry.to_planet_fixed(), stop: Stop::default(), solver: Solver::default() }
}
fn shuttle() -> Case {
    let entry = FlightPath { radius: 6_378_137.0+120e3, longitude: -1.347_32, geocentric_latitude: 0.4, speed: 7500.0, flight_path_angle: -0.02, heading: 0.7 };
    Case { planet: Planet { gravity: Gravity::Zonal(Zonal::EARTH), ..Planet::EARTH_WGS84 }, atmosphere: Atmosphere::Us76, 
        initial_state: entry.to_planet_fixed(), vehicle: Vehicle { mass: 5000.0, reference_area: 12.0, aerodynamics: Aerodynamics::Constant { lift_coefficient: 0.35, drag_coefficient: 1.2 } }, ..target_2() }
}
fn show(name: &str, case: Case) {
    let never = AtomicBool::new(false);
    let scenario = Scenario::new(case).unwrap();
    match simulate(&scenario, &never) {
        Ok(flight) => {
            let mut v: Vec<f64> = (0..2000).map(|_| { let t = Instant::now(); black_box(simulate::arrival(black_box(&scenario), &never)).ok(); t.elapsed().as_secs_f64()*1e6 }).collect(); v.sort_by(f64::total_cmp); let us = v[1000]; let n=300;
            let t = Instant::now();
            for _ in 0..n { black_box(simulate::simulate(black_box(&scenario), &never)).ok(); }
            let us2 = t.elapsed().as_secs_f64()*1e6/n as f64;
            println!("{name}: t={} {:?} {us:.1} us {us2:.1} us\n   peaks {:?}\n  warnings {:?}", flight.end_time(), flight.statistics(), flight.peaks().mach, flight.warnings());
            let tight = Case { solver: Solver { relative_tolerance: 1e-13, ..scenario.case().solver }, ..scenario.case().clone() };
            let fine = simulate(&Scenario::new(tight).unwrap(), &never).unwrap();
            println!("   off {:.2e} m   fine {:?}", (fine.arrival().state.position - flight.arrival().state.position).norm(), fine.statistics());
            let v = reentry::verification::verify(&scenario, &flight, &never).unwrap();
            println!("   drift {:e} work {:e}", v.energy_drift, v.drag_work);
        }
        Err(e) => println!("{name}: {e}"),
    }
}
fn main() {
    let _ = reentry::atmosphere::us76::density(0.0);
    show("target 2", target_2());
    show("exp", Case { atmosphere: Atmosphere::EARTH_JAMESON, ..shuttle() });
    show("exp noJ", Case { atmosphere: Atmosphere::EARTH_JAMESON, planet: Planet::EARTH_WGS84, ..shuttle() });
    show("us76", shuttle());
    let step = |against, at: &[f64], value: &[f64], i| Command::Schedule(Arc::new(Schedule::new(against, at, value, i).unwrap()));
    // one derivative
    for (name, case) in [("bare", target_2()), ("us76", shuttle()), ("us76+bank mach", Case { control: Control { bank_angle: step(Against::Mach, &[1.0, 5.0, 10.0, 20.0], &[0.0, 1.0, -1.0, 0.5], Interpolation::Linear), ..Control::banked(0.0) }, ..shuttle() })] {
        let mut fp = FlightPath::from_planet_fixed(&case.initial_state); fp.radius = 6_378_137.0 + 50e3;
        let case = Case { initial_state: fp.to_planet_fixed(), ..case };
        let motion = Cartesian(case.forces());
        let state: [f64; 6] = case.initial_state.into();
        let t = Instant::now(); let n = 3_000_000; let mut acc = state;
        for _ in 0..n { let d = motion.derivative(0.0, &acc); acc[0] = state[0] + d[3] * 1e-30; }
        println!("{name}: {:.1} ns {}", t.elapsed().as_secs_f64()*1e9/n as f64, acc[0]);
    }
}
