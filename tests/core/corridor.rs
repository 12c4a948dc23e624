//! Corridors of flights, beside an even scan of the tests' own.

use std::sync::atomic::AtomicBool;

use reentry::coordinates::FlightPath;
use reentry::simulate::extremes;
use reentry::solve::corridor::{Corridor, Sample, corridor};
use reentry::trajectory::{Extremes, Termination};
use reentry::{Case, Control, Scenario};

use crate::core::flights::{glide, with_tolerance};

/// The entry of a lifting capsule at a flight-path angle, °, with a bank angle.
fn entry(flight_path_angle: f64, bank_angle: f64) -> Case {
    let path = FlightPath::from_planet_fixed(&glide().initial_state);
    let path = FlightPath { speed: 10_600.0, flight_path_angle: flight_path_angle.to_radians(), ..path };
    let mut case = Case { initial_state: path.to_planet_fixed(), control: Control::banked(bank_angle), ..glide() };
    case.stop.ceiling = Some(130e3);
    with_tolerance(case, 1e-10)
}

fn fly(case: Case) -> Extremes {
    extremes(&Scenario::new(case).unwrap(), &AtomicBool::new(false)).unwrap()
}

/// No more than 12 g with the lift up, and no skip with the lift down: of both, whatever is asked for.
fn judged(value: f64) -> Sample {
    let [up, down] = [0.0, std::f64::consts::PI].map(|bank_angle| fly(entry(value, bank_angle)));
    let load = up.peaks().load_factor.value;
    let lands = down.termination() == Termination::SurfaceImpact;
    Sample {
        value,
        numbers: vec![Some(load), None],
        margins: vec![Some((12.0 - load) / 12.0), Some(if lands { 1.0 } else { -1.0 })],
        ends: vec![Some(up.termination()), Some(down.termination())],
    }
}

#[test]
fn a_corridor_is_that_of_an_even_scan() {
    let between = [-12.0, -3.0];
    let mut flights = 0;
    let found: Corridor = corridor(between, 1e-8, |values, asked| {
        flights += values.len() * [0, 1].into_iter().filter(|limit| asked.has(*limit)).count();
        Ok::<_, ()>(values.iter().map(|value| judged(*value)).collect())
    })
    .unwrap();
    let [band] = found.bands[..] else { panic!("{:?}", found.bands) };
    assert_eq!((band.from.limit, band.to.limit), (Some(0), Some(1)));
    assert!(found.gaps.len() == 2 && found.gaps[0].broken == [0] && found.gaps[1].broken == [1]);
    assert!(flights <= 300, "{flights} flights");
    // On either side of each end the limits hold or do not.
    for (edge, outward) in [(band.from.value, -1.0), (band.to.value, 1.0)] {
        let keeps = |value: f64| judged(value).margins.iter().all(|margin| margin.unwrap() >= 0.0);
        assert!(keeps(edge) && !keeps(edge + outward * 1e-7), "{edge}");
    }
    for index in 0..=120 {
        let value = between[0] + f64::from(index) * (between[1] - between[0]) / 120.0;
        let keeps = judged(value).margins.iter().all(|margin| margin.unwrap() >= 0.0);
        assert_eq!(keeps, (band.from.value..=band.to.value).contains(&value), "{value}");
    }
}
