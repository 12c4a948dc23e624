//! The gas of an atmosphere by a table: its speed of sound, and the Mach numbers of flights through it.

use std::sync::Arc;

use num_dual::Dual64;
use reentry::atmosphere::{Gas, MOLAR_GAS_CONSTANT, Table};
use reentry::event::{Condition, Direction, Effect, Event, Quantity};
use reentry::interpolation::{Hint, TableError};
use reentry::planet::{Gravity, Shape};
use reentry::trajectory::{TableId, Warning};
use reentry::{Atmosphere, Case, Control, FlightPath, Planet, Stop, Trajectory};

use crate::check::{near, relative};
use crate::core::flights::{fly, target_2, vehicle};

/// Carbon dioxide with some nitrogen and argon, as at Mars: kg/mol, and the ratio of its heat capacities.
const MARS: (f64, f64) = (0.044_01, 1.29);

/// Temperature, K, and pressure, Pa, at an altitude, m: two straight lines and an exponential, never colder than 120 K.
///
/// NASA Glenn Research Center, Mars Atmosphere Model, Metric Units, 2021.
fn mars(altitude: f64) -> [f64; 2] {
    let celsius = if altitude > 7000.0 { -23.4 - 0.002_22 * altitude } else { -31.0 - 0.000_998 * altitude };
    [(celsius + 273.1).max(120.0), 699.0 * (-0.000_09 * altitude).exp()]
}

fn altitudes() -> Vec<f64> {
    (-4..=65).map(|step| 2e3 * f64::from(step)).collect()
}

fn air_of_mars() -> Table {
    let altitude = altitudes();
    let [temperature, pressure] = [0, 1].map(|of| altitude.iter().map(|h| mars(*h)[of]).collect::<Vec<_>>());
    // p/ρT of the same page, J/(kg K).
    let density: Vec<_> = temperature.iter().zip(&pressure).map(|(t, p)| p / (192.1 * t)).collect();
    Table::new(&altitude, &density, Some(&temperature), Some(&pressure)).unwrap()
}

fn gas_of_mars() -> Table {
    let (molar_mass, heat_capacity_ratio) = MARS;
    air_of_mars().with_gas(&altitudes(), Gas::Uniform { molar_mass, heat_capacity_ratio }).unwrap()
}

/// A lander with a parachute that opens at Mach 1.7, from 125 km.
fn entry_at_mars(table: Table) -> Trajectory {
    let start = FlightPath {
        radius: 3_396_190.0 + 125e3 - oblateness(23_f64.to_radians()),
        longitude: 338_f64.to_radians(),
        geocentric_latitude: 23_f64.to_radians(),
        speed: 7480.0,
        flight_path_angle: (-13.65_f64).to_radians(),
        heading: (-166_f64).to_radians(),
    };
    let when = Condition { quantity: Quantity::Mach, value: 1.7, direction: Direction::Falling };
    fly(&Case {
        planet: Planet {
            shape: Shape::Ellipsoid { equatorial_radius: 3_396_190.0, polar_radius: 3_376_200.0 },
            gravity: Gravity::InverseSquare,
            gravitational_parameter: 4.282_837e13,
            orbital_gravitational_parameter: 4.282_837e13,
            rotation_rate: 7.088_218e-5,
        },
        atmosphere: Atmosphere::Table(Arc::new(table)),
        vehicle: vehicle(584.0, 5.52, 0.0, 1.68),
        control: Control::banked(0.0),
        events: vec![Event { when: when.into(), then: Effect::default() }],
        initial_state: start.to_planet_fixed(),
        ..target_2()
    })
}

/// By how much the surface is nearer to the centre than at the equator, m: of an ellipse, by its polar equation.
fn oblateness(latitude: f64) -> f64 {
    let [a, b] = [3_396_190.0_f64, 3_376_200.0];
    a - a * b / (b * latitude.cos()).hypot(a * latitude.sin())
}

/// An integration in other coordinates by another method (`SciPy`'s DOP853) has the parachute open at 9.90 km, and at 12.34 km with
/// the speed of sound of air.
#[test]
fn a_parachute_at_mars_opens_at_the_mach_number_of_its_gas() {
    for (table, opens) in [(gas_of_mars(), 9.90e3), (air_of_mars(), 12.34e3)] {
        let flight = entry_at_mars(table);
        let event = flight.events().next().unwrap().before;
        near("the altitude, of four digits", event.loads.altitude, opens, 5.0);
        near("the Mach number", event.loads.mach.unwrap(), 1.7, 1e-9);
    }
    let flight = entry_at_mars(gas_of_mars());
    let event = flight.events().next().unwrap().before;
    let (molar_mass, heat_capacity_ratio) = MARS;
    // By hand, of the line on which the temperature lies; the end of the line is an entry away.
    let [temperature, _] = mars(event.loads.altitude);
    let sound = (heat_capacity_ratio * 8.314_462_618 * temperature / molar_mass).sqrt();
    relative("the speed over that of sound", event.loads.air_speed / sound, 1.7, 1e-4);
    relative("the speed of sound", event.speed_of_sound.unwrap(), sound, 1e-4);
}

/// At every entry √(γRT/M); between entries of straight lines too.
#[test]
fn the_speed_of_sound_is_that_of_the_gas() {
    let hint = Hint::default();
    let altitude = [0.0, 10e3, 30e3, 40e3];
    let temperature = [240.0, 220.0, 180.0, 160.0];
    let density = [0.02, 8e-3, 1e-3, 4e-4];
    let (mass, ratio) = ([0.044, 0.0435, 0.042, 0.04], [1.28, 1.29, 1.33, 1.37]);
    let table = || Table::new(&altitude, &density, Some(&temperature), None).unwrap();
    let by_altitude = Gas::ByAltitude { molar_mass: &mass, heat_capacity_ratio: &ratio };
    let varying = table().with_gas(&altitude, by_altitude).unwrap();
    let uniform = Gas::Uniform { molar_mass: 0.044, heat_capacity_ratio: 1.28 };
    let uniform = table().with_gas(&altitude, uniform).unwrap();
    let sound = |gamma: f64, kelvin: f64, mass: f64| (gamma * MOLAR_GAS_CONSTANT * kelvin / mass).sqrt();
    for index in 0..4 {
        let [of_one, of_all] =
            [&uniform, &varying].map(|table| table.sample(1, altitude[index], &hint).speed_of_sound.unwrap());
        relative("uniform", of_one, sound(1.28, temperature[index], 0.044), 1e-14);
        relative("by altitude", of_all, sound(ratio[index], temperature[index], mass[index]), 1e-14);
    }
    relative("between", uniform.speed_of_sound(1, 17e3, &hint).unwrap(), sound(1.28, 206.0, 0.044), 1e-13);
    // Above the table the air stays as it is at its end.
    relative("above", varying.speed_of_sound(2, 60e3, &hint).unwrap(), sound(1.37, 160.0, 0.04), 1e-14);
    // Of air, as it was before tables had a gas: us76's numbers.
    let air: f64 = table().speed_of_sound(1, 10e3, &hint).unwrap();
    assert_eq!(air.to_bits(), (220.0_f64 * (1.4 * 8314.32 / 28.9644)).sqrt().to_bits());
}

/// Without a temperature there is a Mach number all the same.
#[test]
fn a_tabulated_speed_of_sound_makes_a_mach_number() {
    let altitude = altitudes();
    let hint = Hint::default();
    let known = gas_of_mars();
    let sound: Vec<_> = altitude.iter().map(|h| known.speed_of_sound(1, *h, &hint).unwrap()).collect();
    let density: Vec<_> = altitude.iter().map(|h| known.density(1, *h, &hint)).collect();
    let table = Table::new(&altitude, &density, None, None).unwrap();
    assert!(!table.has_speed_of_sound());
    let table = table.with_speed_of_sound(&altitude, &sound).unwrap();
    assert!(table.has_speed_of_sound() && !table.has_temperature());
    let flight = entry_at_mars(table);
    let event = flight.events().next().unwrap().before;
    assert_eq!((event.temperature, event.loads.mach.is_some()), (None, true));
    // Between entries 2 km apart the root of a line and the cubic differ by a few parts in 10⁷.
    let same = entry_at_mars(gas_of_mars()).events().next().unwrap().before;
    near("as by the temperature", event.loads.altitude, same.loads.altitude, 1.0);
    // The peak over the flight is no less than any row.
    let greatest = flight.peaks().mach.unwrap().value;
    assert!((0..=200).all(|row| flight.at(f64::from(row)).loads.mach.unwrap() <= greatest * (1.0 + 1e-12)));
}

/// Smooth: the slope of the speed of sound has no jump at an entry, and dual numbers carry it.
#[test]
fn the_slope_of_the_speed_of_sound_is_continuous() {
    let hint = Hint::default();
    let altitude = [0.0, 10e3, 25e3, 40e3];
    let (mass, ratio) = ([0.044, 0.0435, 0.043, 0.038], [1.28, 1.29, 1.33, 1.37]);
    let table = Table::new(&altitude, &[0.02, 8e-3, 2e-3, 4e-4], Some(&[240.0, 220.0, 170.0, 165.0]), None).unwrap();
    let gas = Gas::ByAltitude { molar_mass: &mass, heat_capacity_ratio: &ratio };
    let sound = [400.0, 380.0, 200.0, 210.0];
    for table in
        [table.clone().with_gas(&altitude, gas).unwrap(), table.with_speed_of_sound(&altitude, &sound).unwrap()]
    {
        let at = |h: f64| table.speed_of_sound(1, Dual64::new(h, 1.0), &hint).unwrap();
        for entry in [10e3, 25e3] {
            near("slope at an entry", at(entry + 1e-6).eps, at(entry - 1e-6).eps, 1e-10);
        }
        for h in [3e3, 10e3, 18e3, 33e3] {
            // The square of a step over the width of a cell.
            near("slope", at(h).eps, (at(h + 1.0).re - at(h - 1.0).re) / 2.0, 1e-6);
        }
    }
}

#[test]
fn a_gas_that_is_none_is_refused() {
    let altitude = altitudes();
    let long = vec![0.044; altitude.len()];
    let mut wrong = long.clone();
    wrong[3] = -1.0;
    let gas = |molar_mass: f64, heat_capacity_ratio: f64| {
        air_of_mars().with_gas(&altitude, Gas::Uniform { molar_mass, heat_capacity_ratio })
    };
    for (molar_mass, ratio) in [(0.0, 1.3), (0.044, 0.0), (f64::NAN, 1.3), (-0.044, 1.3)] {
        assert_eq!(gas(molar_mass, ratio), Err(TableError::OutOfBounds { index: 0 }));
    }
    let by_altitude = |molar_mass: &[f64]| {
        air_of_mars().with_gas(&altitude, Gas::ByAltitude { molar_mass, heat_capacity_ratio: &long })
    };
    assert_eq!(by_altitude(&wrong), Err(TableError::OutOfBounds { index: 3 }));
    let expected = altitude.len();
    assert_eq!(by_altitude(&long[..2]), Err(TableError::LengthsDiffer { entries: 2, expected }));
    assert_eq!(air_of_mars().with_speed_of_sound(&altitude, &wrong), Err(TableError::OutOfBounds { index: 3 }));
}

/// The place and the instant at which a flight leaves the standard atmosphere, upward and downward.
#[test]
fn leaving_the_standard_atmosphere_is_a_warning_that_says_where() {
    let start = FlightPath::from_planet_fixed(&target_2().initial_state);
    let flight = |altitude: f64, speed: f64, flight_path_angle: f64, stop: Stop| {
        let start = FlightPath { radius: 6_378_137.0 + altitude, speed, flight_path_angle, ..start };
        fly(&Case { atmosphere: Atmosphere::Us76, initial_state: start.to_planet_fixed(), stop, ..target_2() })
    };
    let seen = |flight: &Trajectory| -> Vec<_> {
        let of = |warning: &Warning| match *warning {
            Warning::OutsideTable { table: TableId::Us76, time, altitude, edge, above } => {
                Some((edge, above, time, altitude))
            }
            _ => None,
        };
        flight.warnings().iter().filter_map(of).collect()
    };
    let through = flight(900e3, 3000.0, 1.0, Stop { altitude: -8e3, ..Stop::default() });
    let warnings = seen(&through);
    let [(top, true, left, above), (bottom, false, sank, below)] = warnings[..] else { panic!("{warnings:?}") };
    assert_eq!((top, bottom), (1000e3, -5e3));
    for (time, altitude, edge) in [(left, above, top), (sank, below, bottom)] {
        near("the altitude", altitude, edge, 1e-3);
        near("the altitude at that time", through.at(time).loads.altitude, edge, 1e-3);
    }
    // It starts outside.
    let down = flight(1100e3, 3000.0, -1.0, Stop::default());
    let [(1e6, true, 0.0, altitude)] = seen(&down)[..] else { panic!("{:?}", seen(&down)) };
    near("where it starts", altitude, 1100e3, 1e-6);
    // Inside, there is nothing to say.
    assert_eq!(seen(&flight(990e3, 3000.0, -1.0, Stop { altitude: -4.9e3, ..Stop::default() })), []);
}
