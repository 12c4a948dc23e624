//! The U.S. Standard Atmosphere, 1976, against its published tables, its own equations and itself in other numbers.

use num_dual::Dual64;
use proptest::prelude::*;
use reentry::atmosphere::AtmosphereSample;
use reentry::atmosphere::us76::{self, BOUNDARIES, density, density_in, segment};
use reentry::scalar::{Lanes, Scalar};
use reentry_service::validation::cases::{US76, US76_GEOPOTENTIAL, rows};

use crate::check::{near, relative};
use crate::core::flights::config;

/// r₀, m, of the standard.
const RADIUS: f64 = 6_356_766.0;

/// The air, of which the standard knows everything.
#[derive(Clone, Copy)]
struct Air<S> {
    density: S,
    temperature: S,
    pressure: S,
    speed_of_sound: S,
}

impl<S> From<AtmosphereSample<S>> for Air<S> {
    fn from(air: AtmosphereSample<S>) -> Self {
        Self {
            density: air.density,
            temperature: air.temperature.unwrap(),
            pressure: air.pressure.unwrap(),
            speed_of_sound: air.speed_of_sound.unwrap(),
        }
    }
}

fn sample<S: Scalar<Mask = bool>>(altitude: S) -> Air<S> {
    us76::sample(altitude).into()
}

fn sample_in<S: Scalar>(segment: usize, altitude: S) -> Air<S> {
    us76::sample_in(segment, altitude).into()
}

/// A number that was rounded, or cut off, when it was printed.
const ROUNDED: f64 = 0.5;
const CUT: f64 = 1.0;

/// Compares with a printed number, which is right to so many units of its last digit and, more, a share of itself; an empty field
/// is not known.
#[track_caller]
fn as_printed(what: &str, actual: f64, printed: &str, units: f64, share: f64) {
    if printed.is_empty() {
        return;
    }
    let (mantissa, exponent) = printed.split_once('e').unwrap_or((printed, "0"));
    let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
    let last: i32 = exponent.parse::<i32>().unwrap() - i32::try_from(decimals).unwrap();
    let expected: f64 = printed.parse().unwrap();
    near(what, actual, expected, units * 10_f64.powi(last) * (1.0 + 1e-9) + share * expected);
}

#[test]
fn the_published_tables_by_geometric_altitude() {
    for row in rows(US76) {
        let altitude = 1000.0 * row[0].parse::<f64>().unwrap();
        let air = sample(altitude);
        // The report's sums are not the integrals to the last digit, and the parts are joined at 86 km; see the file.
        let share = if altitude > 86e3 { 6e-5 } else { 0.0 };
        let weight = air.density / air.pressure * 8314.32 * air.temperature;
        as_printed(&format!("temperature at {altitude} m"), air.temperature, row[1], ROUNDED, 0.0);
        as_printed(&format!("pressure at {altitude} m"), air.pressure, row[2], CUT, share);
        as_printed(&format!("density at {altitude} m"), air.density, row[3], ROUNDED, share);
        as_printed(&format!("speed of sound at {altitude} m"), air.speed_of_sound, row[4], ROUNDED, 0.0);
        as_printed(&format!("molecular weight at {altitude} m"), weight, row[5], ROUNDED, share);
    }
}

#[test]
fn the_published_tables_by_geopotential_altitude() {
    for row in rows(US76_GEOPOTENTIAL) {
        let altitude: f64 = row[0].parse().unwrap();
        let air = sample(RADIUS * altitude / (RADIUS - altitude));
        as_printed(&format!("temperature at {altitude} m"), air.temperature, row[1], ROUNDED, 0.0);
        as_printed(&format!("pressure at {altitude} m"), air.pressure, row[2], CUT, 0.0);
        as_printed(&format!("density at {altitude} m"), air.density, row[3], ROUNDED, 0.0);
    }
}

/// dp/dZ = -ρ g (equations 1 and 17), where the air is mixed.
#[test]
fn mixed_air_is_in_hydrostatic_balance() {
    for step in -50..860 {
        // Off the boundaries, where the slope of the temperature jumps.
        let altitude = 100.0 * f64::from(step) + 33.3;
        let air = sample(Dual64::new(altitude, 1.0));
        let gravity = 9.806_65 * (RADIUS / (RADIUS + altitude)).powi(2);
        relative(&format!("dp/dZ at {altitude} m"), air.pressure.eps, -air.density.re * gravity, 1e-13);
    }
}

/// Each gas above 115 km is in balance by itself but for the terms of helium's and hydrogen's thermal diffusion, of the fluxes, which end
/// near 150 km, and of hydrogen's flux: from 160 km on all these together are less than 5e-3.
#[test]
fn separated_gases_are_nearly_in_hydrostatic_balance() {
    for altitude in (160..1000).map(|kilometres| 1000.0 * f64::from(kilometres) + 500.0) {
        let air = sample(Dual64::new(altitude, 1.0));
        let gravity = 9.806_65 * (RADIUS / (RADIUS + altitude)).powi(2);
        relative(&format!("dp/dZ at {altitude} m"), air.pressure.eps, -air.density.re * gravity, 5e-3);
    }
}

#[test]
fn the_air_is_continuous_at_every_boundary() {
    for (index, boundary) in BOUNDARIES.into_iter().enumerate() {
        let sides = [boundary - 1e-6, boundary, boundary + 1e-6].map(sample::<f64>);
        // Pressure steps by 4e-7 at 86 km, where the two parts of the standard meet, and hydrogen begins at 150 km.
        let [of_density, of_pressure] = match index {
            7 => [1e-9, 5e-7],
            14 => [4e-7, 8e-6],
            // A micrometre is 2e-10 of a scale height.
            _ => [1e-9, 1e-9],
        };
        // T₇ has seven digits, M/M₀ six.
        let of_temperature = if index == 7 { 6e-7 } else { 1e-9 };
        // Half of what the kinetic temperature has less than the molecular-scale one: 1 - M/M₀ = 4.2e-4.
        let of_sound = if index == 7 { 2.2e-4 } else { of_pressure };
        for side in [sides[0], sides[2]] {
            relative(&format!("density at {boundary}"), side.density, sides[1].density, of_density);
            relative(&format!("pressure at {boundary}"), side.pressure, sides[1].pressure, of_pressure);
            relative(&format!("temperature at {boundary}"), side.temperature, sides[1].temperature, of_temperature);
            relative(&format!("speed of sound at {boundary}"), side.speed_of_sound, sides[1].speed_of_sound, of_sound);
        }
    }
}

/// √(γ R* T/M₀), as if the air were still mixed: at the exosphere's 1000 K.
#[test]
fn above_86_km_the_speed_of_sound_is_that_of_the_kinetic_temperature() {
    let expected = (1.4 * 8314.32 / 28.9644 * 1000.0_f64).sqrt();
    relative("speed of sound at 1000 km", sample(1e6_f64).speed_of_sound, expected, 1e-6);
}

/// The slope from one side, of second order.
fn one_sided(altitude: f64, step: f64) -> f64 {
    let log = |altitude: f64| density(altitude).ln();
    (4.0 * log(altitude + step) - 3.0 * log(altitude) - log(altitude + 2.0 * step)) / (2.0 * step)
}

#[test]
fn slopes_at_boundaries_are_those_from_each_side() {
    for boundary in BOUNDARIES {
        for side in [-1.0, 1.0] {
            let altitude = boundary + 1e-3 * side;
            let air = density(Dual64::new(altitude, 1.0));
            // Of a step of 10 m: its square over that of the scale, a kilometre at 110 km, and rounding.
            relative(&format!("at {altitude} m"), air.eps / air.re, one_sided(altitude, 10.0 * side), 1e-4);
        }
    }
}

/// A trial stage that looks ten kilometres over a boundary sees the curve that it is on go on.
#[test]
fn formulas_go_on_over_their_boundaries() {
    for (below, boundary) in BOUNDARIES.into_iter().enumerate() {
        for (segment, side) in [(below, -1.0), (below + 1, 1.0)] {
            let inside = density_in(segment, Dual64::new(boundary + 1e-3 * side, 1.0));
            let outside = density_in(segment, Dual64::new(boundary - 1e-3 * side, 1.0));
            let far = density_in(segment, Dual64::new(boundary - 10e3 * side, 1.0));
            // Where nitrogen leaves the mixed air, at 100 km, its scale height jumps by 3 %, and the formula for all gases with it.
            relative("slope", outside.eps, inside.eps, if below == 11 { 4e-2 } else { 1e-5 });
            // The speed of sound goes on as it is: a kilometre from the boundary it is still the line there, but for a bend.
            let [inside, outside, beyond] = [1e-3 * side, -1e-3 * side, -1e3 * side]
                .map(|over| sample_in(segment, Dual64::new(boundary + over, 1.0)).speed_of_sound);
            near("slope of sound", outside.eps, inside.eps, 1e-7);
            near("sound", beyond.re, inside.re - 1e3 * side * inside.eps, 3.0);
            let scale_height = -far.re / far.eps;
            assert!((4e3..400e3).contains(&scale_height), "{scale_height} m beyond {boundary} m by {segment}");
        }
    }
}

#[test]
fn density_falls_from_below_the_ground_to_beyond_the_top() {
    let densities: Vec<_> = (-300..200_000).map(|step| density(10.0 * f64::from(step))).collect();
    assert!(densities.windows(2).all(|pair| pair[0] > pair[1]));
    let far: Vec<_> = (0..250).map(|tenth| density(10_f64.powf(0.1 * f64::from(tenth)))).collect();
    assert!(far.windows(2).all(|pair| pair[0] >= pair[1]));
    assert!(density(8e7) < 1e-150, "{}", density(8e7));
}

/// Which numbers, in the order of the fields.
fn numbers<S>(air: Air<S>) -> [S; 4] {
    [air.density, air.temperature, air.pressure, air.speed_of_sound]
}

fn digits(air: Air<f64>) -> [u64; 4] {
    numbers(air).map(f64::to_bits)
}

/// Altitudes where a flight is, and where only a trial stage of an integrator goes.
fn altitude() -> impl Strategy<Value = f64> {
    prop_oneof![4 => -5e3..90e3, 4 => 86e3..1100e3, 1 => -1e9..1e9, 1 => -1e9..1e12]
}

proptest! {
    #![proptest_config(config(2000))]

    #[test]
    fn lanes_and_dual_numbers_have_the_digits_of_f64(altitudes in prop::array::uniform8(altitude())) {
        for here in (0..=BOUNDARIES.len()).chain([segment(altitudes[0])]) {
            let lanes = numbers(sample_in(here, Lanes(altitudes)));
            for (lane, altitude) in altitudes.into_iter().enumerate() {
                let alone = digits(sample_in(here, altitude));
                prop_assert_eq!(lanes.map(|number| number.0[lane].to_bits()), alone, "at {} m by {}", altitude, here);
                let dual = numbers(sample_in(here, Dual64::new(altitude, 1.0)));
                prop_assert_eq!(dual.map(|number| number.re.to_bits()), alone, "at {} m by {}", altitude, here);
                prop_assert_eq!(density_in(here, altitude).to_bits(), alone[0]);
            }
        }
        for altitude in altitudes {
            let alone = digits(sample(altitude));
            prop_assert_eq!(alone, digits(sample_in(segment(altitude), altitude)));
            prop_assert_eq!(density(altitude).to_bits(), alone[0]);
        }
    }

    #[test]
    fn the_air_is_finite_and_positive_everywhere(altitude in altitude()) {
        let dual = numbers(sample(Dual64::new(altitude, 1.0)));
        prop_assert!(dual.iter().all(|number| number.re > 0.0 && number.re.is_finite() && number.eps.is_finite()), "{dual:?}");
    }

    #[test]
    fn dual_numbers_give_central_differences(altitude in -5e3..1100e3) {
        let step = 1.0;
        let clear = |knot: f64| f64::abs(altitude - knot) > 2.0 * step;
        // The molecular weight has a corner every 500 m from 80 to 86 km.
        prop_assume!(BOUNDARIES.into_iter().all(clear) && (160..=172).all(|half| clear(500.0 * f64::from(half))));
        let slopes = numbers(sample(Dual64::new(altitude, 1.0)));
        let [above, below] = [step, -step].map(|step| numbers(sample(altitude + step)));
        for (index, slope) in slopes.into_iter().enumerate() {
            let difference = (above[index] - below[index]) / (2.0 * step);
            // Rounding of a difference over two metres, and the square of the step over that of a scale of a kilometre.
            near("slope", slope.eps, difference, 1e-14 * slope.re + 1e-6 * slope.eps.abs());
        }
    }
}

#[test]
fn the_air_is_finite_and_positive_at_the_ends() {
    for altitude in [-1e12, -1e9, -RADIUS, -RADIUS / 2.0, 0.0, -0.0, 1e8, 1e12, f64::MAX, f64::MIN] {
        let air = numbers(sample(Dual64::new(altitude, 1.0)));
        assert!(air.iter().all(|number| number.re > 0.0 && number.re.is_finite() && number.eps.is_finite()), "{air:?}");
    }
}
