//! Linear dispersions beside flights with random numbers.

use std::sync::atomic::AtomicBool;

use nalgebra::{DMatrix, SymmetricEigen};
use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use reentry::coordinates::{Geodetic, Site};
use reentry::sensitivity::{Moment, Moved, Output, Variation, slopes};
use reentry::simulate::arrival;
use reentry::solve::dispersions::{Ellipse, Group, least_eigenvalue};
use reentry::trajectory::FlightPoint;
use reentry::{Aerodynamics, Case, FlightPath, PlanetFixed, Scenario};

use super::flights::{capsule, fly};

/// Eight numbers of the capsule, and how far each scatters.
const SPREADS: [f64; 8] = [100.0, 2e-4, 2e-4, 5.0, 3e-4, 2e-4, 30.0, 0.03];

fn moved(by: &[f64; 8]) -> Case {
    let mut case = capsule();
    let mut path: [f64; 6] = FlightPath::from_planet_fixed(&case.initial_state).into();
    path.iter_mut().zip(by).for_each(|(number, by)| *number += by);
    case.initial_state = FlightPath::from(path).to_planet_fixed();
    case.vehicle.mass += by[6];
    if let Aerodynamics::Constant { drag_coefficient, .. } = &mut case.vehicle.aerodynamics {
        *drag_coefficient *= 1.0 + by[7];
    }
    case
}

fn ground_point(state: &PlanetFixed<f64>) -> Site {
    let Geodetic { longitude, geodetic_latitude, .. } = Geodetic::from_planet_fixed(state, &capsule().planet.shape);
    Site { longitude, geodetic_latitude }
}

/// Eight normal numbers, by the method of Box and Muller.
fn normals(random: &mut Xoshiro256PlusPlus) -> [f64; 8] {
    std::array::from_fn(|_| {
        let [radius, angle]: [f64; 2] = [random.random(), random.random()];
        (-2.0 * (1.0 - radius).ln()).sqrt() * (std::f64::consts::TAU * angle).cos()
    })
}

#[test]
fn the_ellipse_is_that_of_random_flights() {
    let shape = capsule().planet.shape;
    let flight = fly(&capsule());
    let aim = ground_point(&flight.arrival().state);
    let offset = |axis: usize| {
        move |point: &FlightPoint, _: Option<Moved>| {
            let at = ground_point(&point.flight_path.to_planet_fixed());
            Some(aim.offset_to(&at, &shape)[axis])
        }
    };
    let (east, north) = (offset(0), offset(1));
    let outputs = [
        Output { at: Moment::End, value: &east, turn: None, takes_ground_distance: true },
        Output { at: Moment::End, value: &north, turn: None, takes_ground_distance: true },
    ];
    let variation = |index: usize| {
        let moved = |offset: f64| Some(moved(&std::array::from_fn(|i| if i == index { offset } else { 0.0 })));
        Variation::new(0.1 * SPREADS[index], moved).unwrap()
    };
    let variations: Vec<_> = (0..8).map(variation).collect();
    let slopes = slopes(&flight, &variations, &outputs, &AtomicBool::new(false)).unwrap();
    let slopes: Vec<_> = slopes.into_iter().map(|row| row.slopes).collect();
    let parts: Vec<_> = (0..8).map(|index| Group::of_one(index, SPREADS[index]).contribution(&slopes)).collect();
    let linear = Ellipse::of([0, 1].map(|row| [0, 1].map(|column| parts.iter().map(|part| part[row][column]).sum())));

    let mut random = Xoshiro256PlusPlus::seed_from_u64(1);
    let mut flights: Vec<[f64; 2]> = Vec::new();
    for _ in 0..2000 {
        let drawn = normals(&mut random);
        let case = moved(&std::array::from_fn(|i| drawn[i] * SPREADS[i]));
        let end = arrival(&Scenario::new(case).unwrap(), &AtomicBool::new(false)).unwrap();
        flights.push(aim.offset_to(&ground_point(&end.state), &shape));
    }
    let count = 2000.0;
    let mean = [0, 1].map(|axis| flights.iter().map(|end| end[axis]).sum::<f64>() / count);
    let covariance = [0, 1].map(|i| {
        [0, 1].map(|j| flights.iter().map(|end| (end[i] - mean[i]) * (end[j] - mean[j])).sum::<f64>() / (count - 1.0))
    });
    let sampled = Ellipse::of(covariance);
    // A standard deviation of 2000 samples is off by 1/√4000, 1.6 %, and in one of 700 cases by three times as much; what is not linear in the
    // motion adds a per cent.
    let near = |what: &str, linear: f64, sampled: f64| {
        assert!((linear / sampled - 1.0).abs() < 0.06, "{what}: {linear} m, of random flights {sampled} m");
    };
    near("the major axis", linear.semi_major_axis, sampled.semi_major_axis);
    near("the minor axis", linear.semi_minor_axis, sampled.semi_minor_axis);
    assert!((linear.azimuth - sampled.azimuth).abs() < 0.02, "{} and {} rad", linear.azimuth, sampled.azimuth);
    assert!(linear.semi_major_axis > 10.0 * linear.semi_minor_axis, "a long ellipse: {linear:?}");
}

#[test]
fn variables_of_a_group_scatter_together() {
    let slopes = [vec![1.0, 2.0, -3.0], vec![0.5, 0.0, 1.0]];
    let group = Group { variables: vec![0, 2], covariance: vec![vec![4.0, -1.0], vec![-1.0, 9.0]] };
    let jacobian = DMatrix::from_row_slice(2, 2, &[1.0, -3.0, 0.5, 1.0]);
    let covariance = DMatrix::from_row_slice(2, 2, &[4.0, -1.0, -1.0, 9.0]);
    let expected = &jacobian * &covariance * jacobian.transpose();
    let got = group.contribution(&slopes);
    for (i, row) in got.iter().enumerate() {
        for (j, element) in row.iter().enumerate() {
            assert!((element - expected[(i, j)]).abs() < 1e-12, "{got:?}, not {expected}");
        }
    }
    let correlations = DMatrix::from_row_slice(2, 2, &[1.0, -1.0 / 6.0, -1.0 / 6.0, 1.0]);
    let least: f64 = SymmetricEigen::new(correlations).eigenvalues.min();
    assert!((least_eigenvalue(&group.covariance) - least).abs() < 1e-15);
    // Correlations above 1 are none.
    assert!(least_eigenvalue(&[vec![1.0, 2e3], vec![2e3, 1e6]]) < -0.9);
}

/// The axes turn with the covariance, and a line has no width.
#[test]
fn an_ellipse_has_the_axes_of_its_covariance() {
    for degrees in [0.0_f64, 10.0, 89.0, 90.0, 135.0, 179.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        for [major, minor] in [[9.0, 4.0], [1e10, 1.0], [1.0, 0.0]] {
            // East is the sine of the azimuth.
            let covariance = [
                [major * sin * sin + minor * cos * cos, (major - minor) * sin * cos],
                [(major - minor) * sin * cos, major * cos * cos + minor * sin * sin],
            ];
            let Ellipse { semi_major_axis, semi_minor_axis, azimuth } = Ellipse::of(covariance);
            assert!((semi_major_axis - major.sqrt()).abs() < 1e-9 * major.sqrt());
            assert!((semi_minor_axis - minor.sqrt()).abs() < 1e-2 * minor.sqrt() + 1e-7, "{semi_minor_axis}");
            let off = (azimuth.to_degrees() - degrees).abs();
            assert!(off.min(180.0 - off) < 1e-6, "{} at {degrees}", azimuth.to_degrees());
            assert!((0.0..std::f64::consts::PI).contains(&azimuth));
        }
    }
}
