//! NRLMSISE-00 in flight: the numbers of its C translation, the laws of gases, and flights that are as exact as in other air.

use nalgebra::Vector3;
use num_dual::Dual64;
use proptest::prelude::*;
use reentry::atmosphere::nrlmsise00::{Ap, Nrlmsise00, SpaceWeather, geodetic};
use reentry::atmosphere::us76;
use reentry::coordinates::{Geodetic, latitude_and_altitude};
use reentry::planet::Shape;
use reentry::scalar::{Lanes, Scalar};
use reentry::{Atmosphere, Case, Planet};
use std::sync::Arc;

use crate::check::{near, relative};
use crate::core::flights::{capsule, config, fly, miss, random_entry, spherical, target_2, with_tolerance};

const POINTS: &str = include_str!("nrlmsise00.csv");
const EARTH: Shape = Planet::EARTH_WGS84.shape;

/// The planet-fixed position of a geodetic place, m and degrees.
fn position(altitude: f64, latitude: f64, longitude: f64) -> Vector3<f64> {
    let place = Geodetic {
        geodetic_altitude: altitude,
        longitude: longitude.to_radians(),
        geodetic_latitude: latitude.to_radians(),
        speed: 0.0,
        flight_path_angle: 0.0,
        azimuth: 0.0,
    };
    place.to_planet_fixed(&EARTH).position
}

fn winter() -> Nrlmsise00 {
    let space_weather = SpaceWeather { f107: 120.0, f107_average: 130.0, ap: Ap::Daily(12.0) };
    Nrlmsise00::new(355, 70_000.0, space_weather)
}

/// Density, temperature, pressure and speed of sound.
fn air<S: Scalar>(model: &Nrlmsise00, time: S, position: &Vector3<S>) -> [S; 4] {
    let sample = model.sample(EARTH.semi_axes(), time, position);
    [sample.density, sample.temperature.unwrap(), sample.pressure.unwrap(), sample.speed_of_sound.unwrap()]
}

/// To 1e-9, with densities of 13 digits. At a pole, where the rows have longitudes and a position has none, the model's rounded constants leave
/// it 1e-7 of a longitude.
#[test]
fn density_and_temperature_are_those_of_the_c_translation() {
    let rows = POINTS.lines().filter(|line| line.starts_with(char::is_numeric));
    let mut count = 0;
    for row in rows {
        let numbers: Vec<f64> = row.split(',').map(|number| number.parse().unwrap()).collect();
        let [_, second, altitude, latitude, longitude, f107, f107_average, ap, density, temperature] = numbers[..]
        else {
            panic!("{row}")
        };
        let space_weather = SpaceWeather { f107, f107_average, ap: Ap::Daily(ap) };
        let day_of_year = row.split(',').next().unwrap().parse().unwrap();
        let model = Nrlmsise00::new(day_of_year, second, space_weather);
        let found = air(&model, 0.0, &position(altitude * 1e3, latitude, longitude));
        let tolerance = if latitude.abs() < 90.0 { 1e-9 } else { 1e-7 };
        relative(row, found[0], density, tolerance);
        relative(row, found[1], temperature, tolerance);
        count += 1;
    }
    assert_eq!(count, 120);
}

/// Within a mean of the last digits that matter to the density: 1e-6 m of 3500 m are 3e-10.
#[test]
fn the_place_in_closed_form_is_the_exact_one() {
    for latitude in [-90.0, -89.999, -45.0, -1e-6, 0.0, 23.4, 60.0, 90.0] {
        for altitude in [-5e3, 0.0, 80e3, 400e3, 1000e3] {
            for longitude in [-179.9, 0.0, 77.0] {
                let place = position(altitude, latitude, longitude);
                let (exact_latitude, exact_altitude) = latitude_and_altitude(&place, &EARTH);
                let [found_latitude, found_altitude] = geodetic(&place, EARTH.semi_axes());
                near("latitude", found_latitude, exact_latitude, 1e-9);
                near("altitude", found_altitude, exact_altitude, 1e-6);
            }
        }
    }
}

/// dp/dh = -ρ g at rest, within 2 %, as the fitted profiles have it, up to where the gases part from each other; the speed of sound is near that
/// of the standard atmosphere.
#[test]
fn pressure_and_speed_of_sound_are_those_of_a_gas_at_rest() {
    let model = winter();
    for kilometre in (0..90).step_by(5) {
        let altitude = f64::from(kilometre) * 1e3;
        let at = |altitude: f64| air(&model, 0.0, &position(altitude, 40.0, 20.0));
        let [density, temperature, pressure, sound] = at(altitude);
        let gravity = 9.80 * (6.371e6 / (6.371e6 + altitude)).powi(2);
        relative("weight", (at(altitude - 50.0)[2] - at(altitude + 50.0)[2]) / 100.0, density * gravity, 0.02);
        relative("gas law", pressure, density * 8.314_46 / 0.028_96 * temperature, 0.002);
        let standard = us76::sample(altitude);
        let warmer = (temperature / standard.temperature.unwrap()).sqrt();
        relative("sound", sound, standard.speed_of_sound.unwrap() * warmer, 0.002);
    }
    // High up, atoms carry the sound faster than molecules of their mass would: γ = 5/3.
    let [density, _, pressure, sound] = air(&model, 0.0, &position(800e3, 40.0, 20.0));
    relative("sound of atoms", sound * sound * density / pressure, 5.0 / 3.0, 0.02);
}

/// Exact derivatives, of the place and of the time: central differences, whose error is the third derivative's; 1e-5 of a scale height.
#[test]
fn dual_numbers_carry_the_derivatives() {
    let model = winter();
    for (altitude, latitude, longitude) in
        [(20e3, 10.0, 100.0), (71e3, -80.0, 0.0), (110e3, 50.0, -120.0), (400e3, 89.9, 10.0), (-7e3, 0.0, 0.0)]
    {
        let place = position(altitude, latitude, longitude);
        let direction = Vector3::new(0.6, -0.48, 0.64);
        for (along, time_rate) in [(direction, 0.0), (Vector3::zeros(), 1.0)] {
            let at = |by: f64| air(&model, 1000.0 + by * time_rate, &(place + along * by));
            let moving = Vector3::from_fn(|i, _| Dual64::new(place[i], along[i]));
            let exact = air(&model, Dual64::new(1000.0, time_rate), &moving);
            let [before, after] = [at(-10.0), at(10.0)];
            for k in 0..4 {
                let slope = (after[k] - before[k]) / 20.0;
                let scale = at(0.0)[k] / 3500.0;
                near("slope", exact[k].eps, slope, 2e-5 * scale);
                // The crate divides, which dual numbers round in another way.
                relative("value", exact[k].re, at(0.0)[k], 1e-13);
            }
        }
    }
    // On the axis, where longitudes end, derivatives are finite.
    let pole = Vector3::new(0.0, 0.0, 6.5e6).map(|part| Dual64::new(part, 1.0));
    assert!(air(&model, Dual64::from(0.0), &pole).iter().all(|number| number.re.is_finite() && number.eps.is_finite()));
}

#[test]
fn lanes_have_the_digits_of_numbers_alone() {
    let model = winter();
    let places = [
        position(30e3, 10.0, 20.0),
        position(90e3, -50.0, -60.0),
        position(-6e3, 0.0, 0.0),
        position(500e3, 80.0, 170.0),
    ];
    let lanes = Vector3::from_fn(|i, _| Lanes(places.map(|place| place[i])));
    let together = air(&model, Lanes([0.0, 1e4, 1e5, 3e5]), &lanes);
    for (lane, time) in [0.0, 1e4, 1e5, 3e5].into_iter().enumerate() {
        let alone = air(&model, time, &places[lane]);
        for k in 0..4 {
            assert_eq!(together[k].0[lane].to_bits(), alone[k].to_bits());
        }
    }
}

/// The calendar goes on without a step: the days of a long flight are those of flights that begin later, but for the turn of a day, which the
/// model has with six digits.
#[test]
fn a_long_flight_meets_the_days_of_the_calendar() {
    const DAY: f64 = 86_400.0;
    let place = position(300e3, 30.0, 40.0);
    let space_weather = SpaceWeather::MEDIUM;
    let first = Nrlmsise00::new(100, 30_000.0, space_weather);
    for days in [2, 5, 20] {
        let later = Nrlmsise00::new(100 + days, 30_000.0, space_weather);
        let [found, expected] =
            [air(&first, f64::from(days) * DAY, &place), air(&later, 0.0, &place)].map(|air| air[0]);
        relative("density", found, expected, 1e-5 * f64::from(days));
    }
    for time in [DAY, 1.5 * DAY, 2.0 * DAY, 3.0 * DAY] {
        let [before, after] = [time - 1e-3, time + 1e-3].map(|time| air(&first, time, &place)[0]);
        relative("no step", after, before, 1e-7);
    }
}

/// Below the model the air is that of one temperature, without a step in density; far below, and far above, it has numbers.
#[test]
fn beyond_the_model_the_air_goes_on() {
    let model = winter();
    let at = |altitude: f64| air(&model, 0.0, &position(altitude, 0.0, 0.0));
    let [bottom, below] = [at(-5e3), at(-8e3)];
    relative("temperature", below[1], bottom[1], 1e-12);
    let scale_height = bottom[2] / (bottom[0] * 9.806_65);
    relative("density", below[0], bottom[0] * (3e3 / scale_height).exp(), 1e-6);
    relative("no step", at(-5e3 - 1e-3)[0], at(-5e3 + 1e-3)[0], 1e-6);
    for altitude in [-6.3e6, -1e5, 1.5e6, 1e8, 1e12] {
        assert!(
            at(altitude).iter().all(|number| number.is_finite() && *number >= 0.0),
            "{altitude}: {:?}",
            at(altitude)
        );
    }
}

fn in_model(case: Case) -> Case {
    Case { atmosphere: Atmosphere::Nrlmsise00(Arc::new(winter())), ..case }
}

proptest! {
    #![proptest_config(config(16))]

    /// The promise of the default tolerance, 1 m, holds although the density of the model jumps; the two formulations meet.
    #[test]
    fn flights_are_exact_to_a_metre(case in random_entry()) {
        let case = in_model(case);
        let fine = fly(&with_tolerance(case.clone(), 1e-13));
        for flight in [fly(&case), fly(&spherical(case.clone()))] {
            prop_assert!(miss(&flight, &fine) < 1.0, "{}", miss(&flight, &fine));
        }
    }
}

/// Of a capsule some 1 or 2 km from where it comes down in standard air, and a flight as long.
#[test]
fn a_capsule_comes_down_near_its_place_in_standard_air() {
    for case in [capsule(), target_2()] {
        let standard = fly(&Case { atmosphere: Atmosphere::Us76, ..case.clone() });
        let flight = fly(&in_model(case));
        let apart = miss(&flight, &standard);
        assert!(apart > 100.0 && apart < 60e3, "{apart}");
    }
}
