//! Gravity: the gradient of its potential, which has no sources outside the planet.

use nalgebra::Vector3;
use num_dual::{Dual2_64, Dual64};
use proptest::prelude::*;
use reentry::Planet;
use reentry::planet::{Gravity, Zonal};

use crate::check::near;
use crate::core::flights::config;

fn zonal(degree: usize) -> Planet {
    Planet { gravity: Gravity::Zonal(Zonal::EARTH.up_to(degree)), ..Planet::EARTH_WGS84 }
}

/// Gravity at a planet-fixed position.
fn gravity(planet: &Planet, position: &Vector3<f64>) -> Vector3<f64> {
    planet.gravity(position.norm().recip(), &position.normalize())
}

/// From the surface to a few radii, at every latitude.
fn place() -> impl Strategy<Value = Vector3<f64>> {
    (1.0..4.0, -1.0..1.0, 0.0..std::f64::consts::TAU).prop_map(|(radii, sine, longitude): (f64, f64, f64)| {
        let cosine = (1.0 - sine * sine).sqrt();
        Vector3::new(cosine * longitude.cos(), cosine * longitude.sin(), sine) * (radii * 6_378_137.0)
    })
}

proptest! {
    #![proptest_config(config(200))]

    #[test]
    fn gravity_is_the_gradient_of_its_potential(position in place()) {
        for planet in [Planet::EARTH_WGS84, zonal(2), zonal(3), zonal(4)] {
            let pull = gravity(&planet, &position);
            for axis in 0..3 {
                let moving = Vector3::from_fn(|i, _| Dual64::new(position[i], if i == axis { 1.0 } else { 0.0 }));
                let slope = -planet.potential(&moving).eps;
                // Both are sums of some ten terms of the size of g.
                prop_assert!((pull[axis] - slope).abs() < 4e-15 * pull.norm(), "axis {}: {} {}", axis, pull[axis], slope);
            }
        }
    }

    /// Laplace's equation ties the polynomials of every degree to their powers of the radius.
    #[test]
    fn the_potential_has_no_sources(position in place()) {
        for planet in [Planet::EARTH_WGS84, zonal(2), zonal(3), zonal(4)] {
            let curvatures = [0, 1, 2].map(|axis| {
                let moving = Vector3::from_fn(|i, _| Dual2_64::new(position[i], if i == axis { 1.0 } else { 0.0 }, 0.0));
                planet.potential(&moving).v2
            });
            let size = curvatures.iter().map(|curvature| curvature.abs()).sum::<f64>();
            // J₄, the smallest coefficient, is 1.6e-6.
            prop_assert!(curvatures.iter().sum::<f64>().abs() < 1e-13 * size, "{curvatures:?}");
        }
    }
}

/// Normal gravity of WGS 84 at the equator and at the poles is gravity less the centrifugal acceleration: NIMA TR8350.2, table 3.4.
#[test]
fn gravity_on_the_ellipsoid_is_that_of_wgs_84() {
    let planet = zonal(2);
    let (a, b) = planet.shape.semi_axes();
    let equator = gravity(&planet, &Vector3::new(a, 0.0, 0.0)).norm() - planet.rotation_rate.powi(2) * a;
    let pole = gravity(&planet, &Vector3::new(0.0, 0.0, b)).norm();
    // The normal field also has a J₄ of -2.37e-6, which adds 15/8 of it at the equator and 5 times it at the poles.
    near("equator", equator, 9.780_325_335_9 - 15.0 / 8.0 * 2.37e-6 * 9.8, 1e-6);
    near("pole", pole, 9.832_184_937_8 - 5.0 * 2.37e-6 * 9.87, 2e-6);
}

/// Degrees differ, and each holds those below it.
#[test]
fn a_degree_leaves_out_what_lies_above_it() {
    let [j2, j3, j4] = Zonal::EARTH.coefficients;
    let up_to = |degree: usize| Zonal::EARTH.up_to(degree).coefficients.map(f64::to_bits);
    assert_eq!(up_to(2), [j2, 0.0, 0.0].map(f64::to_bits));
    assert_eq!(up_to(3), [j2, j3, 0.0].map(f64::to_bits));
    assert_eq!(up_to(4), [j2, j3, j4].map(f64::to_bits));
    // J₂ as published beside the other constants of the check cases of NASA/TM-2015-218675.
    near("J2", j2, 0.001_082_629_82, 5e-12);
}
