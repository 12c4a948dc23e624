//! Changes of formula on the way: layers of the air, corners and steps of schedules, wind.

use std::sync::Arc;

use nalgebra::Vector3;
use proptest::prelude::*;
use reentry::atmosphere::{Layer, Layers, Table};
use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::coordinates::Inertial;
use reentry::motion::Switch;
use reentry::planet::{Gravity, Zonal};
use reentry::simulate::SimulationError;
use reentry::trajectory::{Sampling, TableId, Termination, Warning};
use reentry::vehicle::{AlphaMachTable, MachTable};
use reentry::wind::WindTable;
use reentry::{Aerodynamics, Atmosphere, Case, Control, FlightPath, Planet, Stop, Trajectory, Vehicle, Wind};

use crate::check::near;
use crate::core::flights::{
    config, fly, glide, miss, random_entry, spherical, target_2, try_to_fly, vehicle, with_tolerance,
};

fn schedule(against: Against, at: &[f64], value: &[f64], interpolation: Interpolation) -> Command {
    Command::Schedule(Arc::new(Schedule::new(against, at, value, interpolation).unwrap()))
}

fn banked_by(bank_angle: Command, case: Case) -> Case {
    Case { control: Control { bank_angle, ..Control::banked(0.0) }, ..case }
}

fn end(flight: &Trajectory) -> Case {
    Case { initial_state: flight.arrival().state, ..glide() }
}

/// A step of a schedule is the end of one flight and the start of another.
#[test]
fn a_step_in_time_is_two_flights() {
    let steps =
        banked_by(schedule(Against::Time, &[0.0, 150.0, 400.0], &[0.9, -0.6, 0.2], Interpolation::Step), glide());
    let whole = fly(&with_tolerance(steps, 1e-12));
    let leg = |case: Case, bank: f64, time: f64| {
        let stop = Stop { time, ..Stop::default() };
        fly(&with_tolerance(Case { control: Control::banked(bank), stop, ..case }, 1e-12))
    };
    let first = leg(glide(), 0.9, 150.0);
    let second = leg(end(&first), -0.6, 250.0);
    let third = leg(end(&second), 0.2, 1e4);
    near("time", whole.end_time(), 400.0 + third.end_time(), 1e-6);
    // A thousand steps' worth of 1e-12 of the Earth's radius, magnified by the flight.
    assert!(miss(&whole, &third) < 1e-4, "{} m", miss(&whole, &third));
}

#[test]
fn a_step_in_altitude_is_two_flights() {
    let steps = banked_by(schedule(Against::Altitude, &[0.0, 50e3], &[0.2, 0.9], Interpolation::Step), glide());
    let whole = fly(&with_tolerance(steps, 1e-12));
    let stop = Stop { altitude: 50e3, ..Stop::default() };
    let first = fly(&with_tolerance(Case { control: Control::banked(0.9), stop, ..glide() }, 1e-12));
    assert_eq!(first.termination(), Termination::StopAltitude);
    let second = fly(&with_tolerance(Case { control: Control::banked(0.2), ..end(&first) }, 1e-12));
    near("time", whole.end_time(), first.end_time() + second.end_time(), 1e-6);
    assert!(miss(&whole, &second) < 1e-4, "{} m", miss(&whole, &second));
}

/// Between its entries a line, outside them their values.
#[test]
fn angles_follow_their_schedule() {
    let (at, value) = ([1000.0, 3000.0, 6000.0], [0.1, 0.9, -0.5]);
    let angle = |speed: f64, interpolation| match interpolation {
        Interpolation::Linear if speed <= at[0] => value[0],
        Interpolation::Linear if speed >= at[2] => value[2],
        Interpolation::Linear if speed < at[1] => value[0] + (speed - at[0]) / 2000.0 * 0.8,
        Interpolation::Linear => value[1] + (speed - at[1]) / 3000.0 * -1.4,
        Interpolation::Step => value[at.iter().filter(|at| **at <= speed).count().max(1) - 1],
    };
    for interpolation in [Interpolation::Linear, Interpolation::Step] {
        let flight = fly(&banked_by(schedule(Against::Speed, &at, &value, interpolation), glide()));
        let mut seen = Vec::new();
        for second in 0..900 {
            let point = flight.at(f64::from(second));
            let speed = point.flight_path.speed;
            if at.iter().all(|at| (speed - at).abs() > 1e-3) {
                near(
                    &format!("{interpolation:?} at {speed} m/s"),
                    point.bank_angle,
                    angle(speed, interpolation),
                    1e-12,
                );
            }
            seen.push(at.iter().filter(|at| **at < speed).count());
        }
        seen.dedup();
        assert_eq!(seen, [3, 2, 1, 0], "the flight passes every entry once");
    }
}

/// However many changes there are, no more steps are rejected than on a flight with none, but one a jump to find its new stride;
/// and the end is as exact.
#[test]
fn changes_are_met_and_not_ground_down() {
    let smooth = fly(&glide()).statistics();
    for against in [Against::Time, Against::Altitude, Against::Speed, Against::Energy] {
        let (first, last) = match against {
            Against::Time => (50.0, 800.0),
            Against::Altitude => (5e3, 100e3),
            Against::Energy => (-6.2e7, -3.4e7),
            _ => (300.0, 7400.0),
        };
        let at: Vec<f64> = (0..20).map(|i| first + (last - first) * f64::from(i) / 19.0).collect();
        let value: Vec<f64> = (0..20).map(|i| 0.6 + 0.3 * f64::from(i % 2)).collect();
        for interpolation in [Interpolation::Step, Interpolation::Linear] {
            let case = banked_by(schedule(against, &at, &value, interpolation), glide());
            let flight = fly(&case);
            let exact = fly(&with_tolerance(case, 1e-13));
            let what = format!("{against:?} {interpolation:?}");
            let rejected = flight.statistics().rejected_steps;
            assert!(rejected <= smooth.rejected_steps + 20, "{what}: {rejected} after {}", smooth.rejected_steps);
            assert!(miss(&flight, &exact) < 0.05, "{what}: {} m", miss(&flight, &exact));
        }
    }
}

/// Where the air grows denser at once, the loads jump, and the peak is on the dense side.
#[test]
fn a_jump_of_the_density_is_met_exactly() {
    let layer = |base_altitude: f64, density: f64| Layer { base_altitude, density, scale_height: 7000.0 };
    let layers = Layers::new(vec![layer(0.0, 1.2), layer(60e3, 1e-5)]).unwrap();
    let case = Case { atmosphere: Atmosphere::Layers(Arc::new(layers)), ..glide() };
    let flight = fly(&case);
    let exact = fly(&with_tolerance(case.clone(), 1e-13));
    assert!(miss(&flight, &exact) < 0.01, "{} m", miss(&flight, &exact));
    let jump = 1.2 * (-60.0_f64 / 7.0).exp() / 1e-5;
    let crossing = flight.points(&flight.instants(&Sampling::PerStep(1), 1000).unwrap());
    // A step ends within two micrometres of it.
    let after =
        crossing.iter().position(|point| (point.loads.altitude - 60e3).abs() < 3e-6).expect("a step ends there");
    let density = |point: usize| crossing[point].loads.density;
    // The instant of the change belongs to what follows.
    near("below", density(after), 1.2 * (-60.0_f64 / 7.0).exp(), 1e-12);
    assert!(jump > 2.0 && density(after - 1) < 1e-5);
}

/// Air that turns faster than the planet is a planet that turns faster: a flight over the equator, seen from space.
#[test]
fn a_wind_that_turns_with_the_air_is_a_faster_planet() {
    let excess = 2e-5;
    let planet = Planet::EARTH_WGS84.spherical();
    let radius = 6_498_137.0;
    let state = |speed: f64| FlightPath {
        radius,
        longitude: 0.0,
        geocentric_latitude: 0.0,
        speed,
        flight_path_angle: -0.05,
        heading: 0.0,
    };
    let level = 7000.0_f64;
    let slow = state(level);
    // The same inertial velocity, relative to the faster planet.
    let (up, east) = (level * slow.flight_path_angle.sin(), level * slow.flight_path_angle.cos() - excess * radius);
    let fast = FlightPath { speed: up.hypot(east), flight_path_angle: up.atan2(east), ..slow };
    let altitude = [-1e3, 30e3, 90e3, 150e3];
    let table = WindTable::new(&altitude, &altitude.map(|h| excess * (h + 6_378_137.0)), &[0.0; 4]).unwrap();
    let stop = Stop { time: 400.0, ..Stop::default() };
    let base =
        Case { planet, vehicle: vehicle(2000.0, 5.0, 0.3, 1.0), control: Control::banked(0.0), stop, ..target_2() };
    let windy = Case { wind: Wind::Table(Arc::new(table)), initial_state: slow.to_planet_fixed(), ..base.clone() };
    let turning = Planet { rotation_rate: planet.rotation_rate + excess, ..planet };
    let still = Case { planet: turning, initial_state: fast.to_planet_fixed(), ..base };
    for formulation in [|case: Case| case, spherical] {
        let windy = fly(&with_tolerance(formulation(windy.clone()), 1e-12));
        let still = fly(&with_tolerance(formulation(still.clone()), 1e-12));
        for time in [50.0, 150.0, 250.0, 350.0] {
            let (a, b) = (windy.at(time), still.at(time));
            assert!(a.loads.load_factor > 1e-4);
            // 7 digits of the loads, whose density falls by e in 7 km.
            near("altitude", a.loads.altitude, b.loads.altitude, 1e-3);
            near("inertial speed", a.inertial_speed, b.inertial_speed, 1e-6);
            near("air speed", a.loads.air_speed, b.flight_path.speed, 1e-6);
            near("load factor", a.loads.load_factor, b.loads.load_factor, 1e-6 * b.loads.load_factor);
            near("longitude", a.flight_path.longitude, b.flight_path.longitude + excess * time, 1e-9);
        }
    }
}

/// On a vehicle at rest the wind acts by itself: at 30° N, to the east and to the north.
#[test]
fn wind_carries_a_body_at_rest_along() {
    let (latitude, longitude): (f64, f64) = (0.5, 1.0);
    let state = FlightPath {
        radius: 6_388_137.0,
        longitude,
        geocentric_latitude: latitude,
        speed: 0.0,
        flight_path_angle: 0.0,
        heading: 0.0,
    };
    let planet = Planet { rotation_rate: 0.0, ..Planet::EARTH_WGS84.spherical() };
    let (mass, area, drag) = (10.0, 0.5, 1.0);
    let case =
        Case { planet, vehicle: vehicle(mass, area, 0.0, drag), initial_state: state.to_planet_fixed(), ..target_2() };
    let (east, north) = (30.0, -20.0);
    let windy = Case { wind: Wind::Constant { east, north }, ..case.clone() };
    let [still, windy] = [case, windy].map(|case| case.forces().acceleration(0.0, &case.initial_state.into()));
    let speed = 1300.0_f64.sqrt();
    let density = 1.547_93 * (-10_000.0_f64 / 6935.0).exp();
    let push = 0.5 * density * speed * area * drag / mass;
    let to_east = Vector3::new(-longitude.sin(), longitude.cos(), 0.0);
    let to_north = Vector3::new(-latitude.sin() * longitude.cos(), -latitude.sin() * longitude.sin(), latitude.cos());
    let expected = (to_east * east + to_north * north) * push;
    assert!(((windy - still) - expected).norm() < 1e-12 * expected.norm() + 1e-14, "{windy} {still} {expected}");
}

/// Air, wind, gravity and angles of every kind.
fn random_models() -> impl Strategy<Value = Case> {
    let wind = (-80.0..80.0, -80.0..80.0).prop_map(|(east, north)| Wind::Constant { east, north });
    let against = prop::sample::select(vec![
        (Against::Time, [20.0, 60.0, 150.0]),
        (Against::Altitude, [10e3, 35e3, 60e3]),
        (Against::Speed, [500.0, 2000.0, 5000.0]),
        (Against::Mach, [2.0, 6.0, 15.0]),
        (Against::Energy, [-6.2e7, -6e7, -4e7]),
    ]);
    let interpolation = prop::sample::select(vec![Interpolation::Linear, Interpolation::Step]);
    let bank = (against, interpolation, prop::array::uniform3(-1.5..1.5))
        .prop_map(|((against, at), interpolation, value)| schedule(against, &at, &value, interpolation));
    (random_entry(), wind, bank, 2..5_usize).prop_map(|(case, wind, bank_angle, degree)| {
        let gravity = Gravity::Zonal(Zonal::EARTH.up_to(degree));
        let planet = Planet { gravity, ..case.planet };
        banked_by(bank_angle, Case { planet, wind, atmosphere: Atmosphere::Us76, ..case })
    })
}

proptest! {
    #![proptest_config(config(40))]

    /// The equations of the thesis, with forces of any direction, against those in planet-fixed coordinates; none of these flights comes near
    /// a singularity of the former.
    #[test]
    fn twin_formulations_agree_under_every_model(case in random_models()) {
        let cartesian = fly(&with_tolerance(case.clone(), 1e-12));
        let spherical = fly(&spherical(with_tolerance(case, 1e-12)));
        prop_assert_eq!(cartesian.termination(), spherical.termination());
        prop_assert!(miss(&cartesian, &spherical) < 0.01, "{} m", miss(&cartesian, &spherical));
    }

    #[test]
    fn energy_is_balanced_under_every_model(case in random_models()) {
        let scenario = reentry::Scenario::new(case.clone()).unwrap();
        let flight = fly(&case);
        let verification =
            reentry::verification::verify(&scenario, &flight, &std::sync::atomic::AtomicBool::new(false)).unwrap();
        // 1e-10 of the energies of 6e7 J/kg, a hundred steps.
        prop_assert!(verification.energy_drift < 0.6, "{verification:?}");
        prop_assert!(verification.distance < 0.1, "{verification:?}");
    }
}

fn by_mach(rows: [(f64, f64, f64); 4]) -> Aerodynamics {
    let column = |pick: fn(&(f64, f64, f64)) -> f64| rows.each_ref().map(pick);
    let table = MachTable::new(&column(|row| row.0), &column(|row| row.1), &column(|row| row.2)).unwrap();
    Aerodynamics::MachTable(Arc::new(table))
}

/// Coefficients by Mach number from 0.5 to 20, and from 20° on, where they end, by angle of attack.
fn by_alpha_and_mach() -> Aerodynamics {
    let (alpha, mach) = ([-0.35, 0.0, 0.35, 0.7], [0.5, 0.9, 1.1, 2.0, 5.0, 20.0]);
    let lift = |alpha: f64, mach: f64| alpha.sin() * alpha.cos() * (1.5 + 0.5 / mach);
    let drag = |alpha: f64, mach: f64| 0.6 + alpha.sin().powi(2) + 0.4 * (-(mach - 1.1_f64).powi(2)).exp();
    let matrix = |of: &dyn Fn(f64, f64) -> f64| alpha.map(|alpha| mach.map(|mach| of(alpha, mach)).to_vec()).to_vec();
    let table = AlphaMachTable::new(&alpha, &mach, &matrix(&lift), &matrix(&drag)).unwrap();
    Aerodynamics::AlphaMachTable(Arc::new(table))
}

/// The glide under the standard atmosphere with all that there is: wind, tables and schedules.
fn everything() -> Case {
    let wind = WindTable::new(&[0.0, 12e3, 30e3], &[5.0, 40.0, -10.0], &[0.0, -15.0, 8.0]).unwrap();
    let control = Control {
        bank_angle: schedule(Against::Mach, &[2.0, 8.0, 20.0], &[0.0, 1.0, -0.8], Interpolation::Linear),
        angle_of_attack: schedule(Against::Altitude, &[20e3, 60e3], &[0.1, 0.3], Interpolation::Linear),
    };
    let vehicle = Vehicle { aerodynamics: by_alpha_and_mach(), ..vehicle(5000.0, 12.0, 0.0, 0.0) };
    Case { atmosphere: Atmosphere::Us76, wind: Wind::Table(Arc::new(wind)), vehicle, control, ..glide() }
}

#[test]
fn flights_with_every_model_are_exact_at_every_tolerance() {
    let exact = fly(&with_tolerance(everything(), 1e-13));
    for (digits, bound) in [(8, 2.0), (10, 0.05), (12, 2e-3)] {
        let flight = fly(&with_tolerance(everything(), 10_f64.powi(-digits)));
        assert!(miss(&flight, &exact) < bound, "1e-{digits}: {} m", miss(&flight, &exact));
    }
    let other = fly(&spherical(with_tolerance(everything(), 1e-12)));
    assert!(miss(&other, &exact) < 2e-3, "{} m", miss(&other, &exact));
}

/// A straight table is a constant, a ratio is a vehicle, a layer is an exponential, a factor is a density.
#[test]
fn models_that_say_the_same_fly_the_same() {
    let plain = Case { vehicle: vehicle(5000.0, 12.0, 0.3, 1.2), ..glide() };
    let end = fly(&with_tolerance(plain.clone(), 1e-12));
    let same = |what: &str, case: Case| {
        let flight = fly(&with_tolerance(case, 1e-12));
        assert!(miss(&flight, &end) < 1e-4, "{what}: {} m", miss(&flight, &end));
    };
    let ratios = Aerodynamics::Ballistic { ballistic_coefficient: 5000.0 / (12.0 * 1.2), lift_to_drag: 0.25 };
    same("ratios", Case { vehicle: Vehicle { aerodynamics: ratios, ..vehicle(1.0, 0.0, 0.0, 0.0) }, ..plain.clone() });
    let Atmosphere::Exponential { surface_density, scale_height } = Atmosphere::EARTH_JAMESON else { panic!() };
    let factor = Atmosphere::Exponential { surface_density: surface_density / 2.5, scale_height };
    same("factor", Case { atmosphere: factor, density_factor: 2.5, ..plain.clone() });
    let layer = Layer { base_altitude: 3e3, density: surface_density * (-3e3 / scale_height).exp(), scale_height };
    let layers = Arc::new(Layers::new(vec![layer]).unwrap());
    same("layer", Case { atmosphere: Atmosphere::Layers(layers), ..plain.clone() });
    let altitude = [-1e3, 10e3, 20e3, 60e3, 130e3];
    let density = altitude.map(|altitude: f64| surface_density * (-altitude / scale_height).exp());
    // With a temperature, so that there is a Mach number.
    let table = Arc::new(Table::new(&altitude, &density, Some(&[250.0; 5]), None).unwrap());
    let tabled = Case { atmosphere: Atmosphere::Table(table), ..plain.clone() };
    same("table", tabled.clone());
    let flat = by_mach([(0.1, 0.3, 1.2), (1.0, 0.3, 1.2), (3.0, 0.3, 1.2), (5.0, 0.3, 1.2)]);
    same("flat coefficients", Case { vehicle: Vehicle { aerodynamics: flat, ..plain.vehicle.clone() }, ..tabled });
    same("no wind", Case { wind: Wind::Constant { east: 0.0, north: 0.0 }, ..plain.clone() });
    let held = schedule(Against::Speed, &[1e3, 5e3], &[0.8, 0.8], Interpolation::Linear);
    same("a level schedule", banked_by(held, plain.clone()));
}

/// In vacuum nothing but gravity acts, whatever flies.
#[test]
fn a_vacuum_is_air_without_density() {
    let stop = Stop { time: 500.0, ..Stop::default() };
    let vacuum = fly(&Case { atmosphere: Atmosphere::Vacuum, stop: stop.clone(), ..glide() });
    let thin = fly(&Case { density_factor: 0.0, stop, ..glide() });
    assert!(miss(&vacuum, &thin) < 1e-3, "{} m", miss(&vacuum, &thin));
    let [start, end] = [vacuum.initial(), vacuum.last()].map(|point| point.specific_energy);
    near("energy", start, end, 1e-10 * start.abs());
    near("load factor", vacuum.last().loads.load_factor, 0.0, 0.0);
}

/// The first time at each edge, and where.
#[test]
fn leaving_a_table_is_a_warning_that_says_where() {
    let case = everything();
    let flight = fly(&case);
    let seen: Vec<_> = flight
        .warnings()
        .iter()
        .map(|warning| match warning {
            Warning::OutsideTable { table, edge, above, time, altitude } => (*table, *edge, *above, *time, *altitude),
            other => panic!("{other:?}"),
        })
        .collect();
    let find = |table: TableId, above: bool| {
        let found: Vec<_> = seen.iter().filter(|seen| (seen.0, seen.2) == (table, above)).collect();
        assert_eq!(found.len(), 1, "{table:?} {above}: {seen:?}");
        *found[0]
    };
    // It starts above the wind, soon is faster than the table of coefficients, where the air is colder, and lands slower.
    let (_, edge, _, time, altitude) = find(TableId::Wind, true);
    assert_eq!((edge, time), (30e3, 0.0));
    near("altitude", altitude, flight.initial().loads.altitude, 1e-6);
    for (above, mach) in [(true, 20.0), (false, 0.5)] {
        let (_, edge, _, time, altitude) = find(TableId::Mach, above);
        let there = flight.at(time);
        assert!(time > 1.0);
        near("edge", edge, mach, 0.0);
        near("Mach", there.loads.mach.unwrap(), mach, 3e-9);
        near("altitude", altitude, there.loads.altitude, 1e-6);
    }
    assert_eq!(seen.len(), 3, "{seen:?}");
    // At its last entry it is not left.
    let last = Control { angle_of_attack: Command::Constant(0.7), ..Control::banked(0.0) };
    let known = fly(&Case { control: last, ..case.clone() });
    assert!(known.warnings().iter().all(|warning| !format!("{warning:?}").contains("AngleOfAttack")));
    let steep = Control { angle_of_attack: Command::Constant(0.8), ..Control::banked(0.0) };
    let warned = fly(&Case { control: steep, ..case });
    assert!(warned.warnings().iter().any(|warning| matches!(
        warning,
        Warning::OutsideTable { table: TableId::AngleOfAttack, edge: 0.7, above: true, time: 0.0, .. }
    )));
}

/// The peak of the Mach number is where its rate vanishes, or at an end.
#[test]
fn the_peak_of_mach_is_no_less_than_any_row() {
    let flight = fly(&everything());
    let peak = flight.peaks().mach.unwrap();
    let rows = flight.points(&flight.instants(&Sampling::PerStep(16), 10_000).unwrap());
    let greatest = rows.iter().map(|row| row.loads.mach.unwrap()).fold(0.0, f64::max);
    assert!(peak.value >= greatest && peak.value < greatest * (1.0 + 1e-4), "{peak:?} {greatest}");
    near("there", flight.at(peak.time).loads.mach.unwrap(), peak.value, 1e-9 * peak.value);
    assert_eq!(fly(&glide()).peaks().mach, None);
}

/// Brakes out above 80 m/s and in below: with them out a body falls more slowly, with them in faster.
#[test]
fn a_schedule_that_undoes_itself_is_refused_by_name() {
    let (alpha, mach) = ([0.0, 0.5], [0.0, 1.0]);
    let drag = [vec![0.5, 0.5], vec![2.0, 2.0]];
    let table = AlphaMachTable::new(&alpha, &mach, &[vec![0.0; 2], vec![0.0; 2]], &drag).unwrap();
    let aerodynamics = Aerodynamics::AlphaMachTable(Arc::new(table));
    let state = FlightPath {
        radius: 6_380_137.0,
        longitude: 0.0,
        geocentric_latitude: 0.0,
        speed: 200.0,
        flight_path_angle: -1.5,
        heading: 0.0,
    };
    let brake = |interpolation, at: &[f64], value: &[f64]| Case {
        planet: Planet::EARTH_WGS84.spherical(),
        atmosphere: Atmosphere::Us76,
        // Terminal speeds of 115 and 57 m/s.
        vehicle: Vehicle { aerodynamics: aerodynamics.clone(), ..vehicle(400.0, 1.0, 0.0, 0.0) },
        control: Control {
            angle_of_attack: schedule(Against::Speed, at, value, interpolation),
            ..Control::banked(0.0)
        },
        initial_state: state.to_planet_fixed(),
        ..target_2()
    };
    let error = try_to_fly(&brake(Interpolation::Step, &[0.0, 80.0], &[0.0, 0.5])).unwrap_err();
    assert!(
        matches!(error, SimulationError::Chatter { switch: Switch::AngleOfAttack, time } if time > 1.0),
        "{error:?}: {error}"
    );
    assert!(error.to_string().contains("angle of attack"), "{error}");
    // A line between them settles on the speed at which drag and weight are equal.
    let flight = fly(&brake(Interpolation::Linear, &[79.0, 81.0], &[0.0, 0.5]));
    assert!((79.0..81.0).contains(&flight.last().flight_path.speed), "{}", flight.last().flight_path.speed);
}

/// Downrange and crossrange by spherical trigonometry: Napier's rules of the right-angled triangle.
#[test]
fn downrange_and_crossrange_are_legs_of_a_right_angled_triangle() {
    let flight = fly(&everything());
    let start = flight.initial().flight_path;
    // To a rounding of the angle.
    near("at the start", flight.initial().downrange.unwrap(), 0.0, 1e-8);
    for part in [0.2, 0.6, 1.0] {
        let point = flight.at(part * flight.end_time());
        let here = point.flight_path;
        let difference = here.longitude - start.longitude;
        let ((sin_0, cos_0), (sin_1, cos_1)) =
            (start.geocentric_latitude.sin_cos(), here.geocentric_latitude.sin_cos());
        let distance = (sin_0 * sin_1 + cos_0 * cos_1 * difference.cos()).acos();
        let course = (cos_0 * sin_1 - sin_0 * cos_1 * difference.cos()).atan2(difference.sin() * cos_1);
        let off = start.heading - course;
        let (along, across) = ((distance.tan() * off.cos()).atan(), (distance.sin() * off.sin()).asin());
        near("downrange", point.downrange.unwrap(), along * 6_378_137.0, 1e-2);
        near("crossrange", point.crossrange.unwrap(), across * 6_378_137.0, 1e-2);
    }
    let down = FlightPath { flight_path_angle: -std::f64::consts::FRAC_PI_2, ..start };
    let rest = FlightPath { speed: 0.0, ..start };
    for state in [down, rest] {
        let flight = fly(&Case { initial_state: state.to_planet_fixed(), ..glide() });
        assert_eq!((flight.last().downrange, flight.last().crossrange), (None, None));
    }
}

/// The inertial quantities of a row are those of its state in the inertial frame.
#[test]
fn inertial_quantities_are_those_of_the_inertial_state() {
    let flight = fly(&everything());
    for part in [0.0, 0.3, 0.9] {
        let point = flight.at(part * flight.end_time());
        let planet = everything().planet;
        let state = point.flight_path.to_planet_fixed();
        let inertial = Inertial::from_planet_fixed(&state, &planet, 4321.0);
        near("speed", point.inertial_speed, inertial.velocity.norm(), 1e-9);
        let sine = inertial.velocity.normalize().dot(&inertial.position.normalize());
        near("angle", point.inertial_flight_path_angle.sin(), sine, 1e-12);
        let energy = inertial.velocity.norm_squared() / 2.0 + planet.potential(&state.position);
        near("energy", point.specific_energy, energy, 1e-3);
    }
}

/// Where a flight starts on a boundary and level, rounding must not decide forever on which side it goes on.
#[test]
fn a_level_start_on_a_boundary_flies() {
    let layers = Layers::new(vec![
        Layer { base_altitude: 0.0, density: 1.2, scale_height: 7000.0 },
        Layer { base_altitude: 120e3, density: 1e-7, scale_height: 9000.0 },
    ]);
    let layered = Atmosphere::Layers(Arc::new(layers.unwrap()));
    let top = Arc::new(Table::new(&[0.0, 60e3, 120e3], &[1.2, 3e-4, 2e-8], Some(&[280.0; 3]), None).unwrap());
    let switched = schedule(Against::Altitude, &[0.0, 120e3], &[0.2, 0.9], Interpolation::Step);
    let never = std::sync::atomic::AtomicBool::new(false);
    for planet in [Planet::EARTH_WGS84.spherical(), Planet::EARTH_WGS84] {
        for (atmosphere, bank_angle) in [
            (Atmosphere::Us76, Command::Constant(0.0)),
            (layered.clone(), Command::Constant(0.0)),
            (Atmosphere::Table(top.clone()), Command::Constant(0.0)),
            (Atmosphere::EARTH_JAMESON, switched.clone()),
        ] {
            for turn in 0..40_usize {
                let angle = f64::from(u8::try_from(turn).unwrap()) * 0.157;
                let (latitude, heading): (f64, f64) = (0.4 * angle.sin(), angle * 1.7 - 3.1);
                let surface = planet.shape.surface_radius(latitude.sin(), latitude.cos());
                let state = FlightPath {
                    radius: surface + 120e3,
                    longitude: angle - 3.0,
                    geocentric_latitude: latitude,
                    speed: [3000.0, 7500.0, 9000.0][turn % 3],
                    flight_path_angle: 0.0,
                    heading,
                };
                let case = Case {
                    planet,
                    atmosphere: atmosphere.clone(),
                    vehicle: vehicle(100.0, 1.0, 0.1, 1.0),
                    initial_state: state.to_planet_fixed(),
                    stop: Stop { time: 60.0, ..Stop::default() },
                    ..banked_by(bank_angle.clone(), target_2())
                };
                let scenario = reentry::Scenario::new(case).unwrap();
                let flight = reentry::simulate(&scenario, &never).unwrap();
                assert!(flight.statistics().steps < 100, "{:?} at {state:?}", flight.statistics());
            }
        }
    }
}

/// Whatever the air is like between the entries of its table, no row exceeds its peak.
#[test]
fn no_row_of_a_flight_through_a_table_exceeds_its_peak() {
    let altitude = [0.0, 11e3, 20e3, 32e3, 47e3, 51e3, 71e3, 80e3, 86e3, 100e3, 120e3];
    let density = [1.225, 0.3648, 0.0889, 0.0136, 1.43e-3, 8.6e-4, 6.4e-5, 1.8e-5, 6.9e-6, 5.6e-7, 2.2e-8];
    let temperature = [288.15, 216.8, 216.65, 228.5, 270.65, 270.65, 214.6, 198.6, 186.87, 195.0, 360.0];
    let table = Arc::new(Table::new(&altitude, &density, Some(&temperature), None).unwrap());
    for (drag, angle) in [(0.0, -0.3), (0.0, -1.2), (0.0, -0.8), (1.0, -0.3), (1.0, -0.05)] {
        let state = FlightPath {
            radius: 6_378_137.0 + 115e3,
            longitude: 0.0,
            geocentric_latitude: 0.5,
            speed: 3000.0,
            flight_path_angle: angle,
            heading: 0.5,
        };
        let flight = fly(&Case {
            atmosphere: Atmosphere::Table(table.clone()),
            vehicle: vehicle(500.0, 1.0, 0.0, drag),
            initial_state: state.to_planet_fixed(),
            ..target_2()
        });
        let rows = flight.points(&flight.instants(&Sampling::Count(4000), 4000).unwrap());
        let peaks = flight.peaks();
        let greatest = |quantity: fn(&reentry::trajectory::FlightPoint) -> f64| {
            rows.iter().map(quantity).fold(f64::NEG_INFINITY, f64::max)
        };
        // To the resolution of a turning point.
        let within = |what: &str, peak: f64, row: f64| assert!(row <= peak * (1.0 + 1e-9), "{what}: {row} over {peak}");
        within("mach", peaks.mach.unwrap().value, greatest(|row| row.loads.mach.unwrap()));
        within("dynamic pressure", peaks.dynamic_pressure.value, greatest(|row| row.loads.dynamic_pressure));
        within("load factor", peaks.load_factor.value, greatest(|row| row.loads.load_factor));
    }
}

/// The last row and the first after it agree on what holds at a corner.
#[test]
fn what_holds_from_a_corner_holds_at_the_end_on_it() {
    let steps = schedule(Against::Time, &[0.0, 100.0], &[0.0, 1.0], Interpolation::Step);
    let at = |time: f64| fly(&Case { stop: Stop { time, ..Stop::default() }, ..banked_by(steps.clone(), glide()) });
    near("at the end", at(100.0).last().bank_angle, 1.0, 0.0);
    near("on the way", at(100.5).at(100.0).bank_angle, 1.0, 0.0);
    near("before", at(99.5).last().bank_angle, 0.0, 0.0);
}
