//! Theory beside simulation: the thesis's figures, and each solution against the equations that it solves.

use std::cell::Cell;
use std::sync::atomic::AtomicBool;

use proptest::prelude::*;
use reentry::analytic::{AnalyticError, Comparison, End, Fault, Prediction, Solution, Theory};
use reentry::trajectory::{FlightPoint, Sampling, Termination};
use reentry::{Aerodynamics, Atmosphere, Case, Control, FlightPath, Planet, Scenario, Stop, Vehicle};

use crate::check::{near, relative};
use crate::core::flights::{config, fly, in_vacuum, random_entry, target_2, vehicle};

const ALL: [Solution; 5] =
    [Solution::ShallowGlide, Solution::Loh, Solution::SteepGlide, Solution::SteepBallistic, Solution::MediumGlide];

/// The constants with which the thesis made its figures.
const LISTING: Planet = Planet::EARTH_JAMESON_LISTING;
/// β of the thesis's atmosphere, 1/m.
const BETA: f64 = 1.0 / 6935.0;

/// Jameson 2006, Tables 4 to 7, on a sphere.
#[expect(clippy::approx_constant, reason = "the angles are as printed")]
fn table(number: u8, planet: Planet) -> Case {
    let steep = (-85.0_f64).to_radians();
    let (body, radius, latitude, speed, flight_path_angle, heading) = match number {
        4 => (vehicle(99_000.0, 20.0, 0.5, 1.0), 6_438_140.0, 0.5236, 7571.7, -0.013_04, 0.646_49),
        5 => (vehicle(50.0, 0.01, 0.03, 0.01), 6_478_140.0, 0.600_588, 5372.0, steep, 1.916),
        6 => (vehicle(13.0, 0.036_609_615, 0.0, 0.085_75), 6_778_140.0, 0.580_59, 10_193.0, steep, 1.7),
        _ => (vehicle(2000.0, 20.0, 0.075, 0.3), 6_478_140.0, 0.5236, 9847.0, (-35.0_f64).to_radians(), 1.146),
    };
    // The longitude does not matter.
    let entry = FlightPath { radius, longitude: 0.0, geocentric_latitude: latitude, speed, flight_path_angle, heading };
    let initial_state = entry.to_planet_fixed();
    Case { planet: planet.spherical(), vehicle: body, control: Control::banked(0.0), initial_state, ..target_2() }
}

fn at_rest(planet: Planet) -> Planet {
    Planet { rotation_rate: 0.0, ..planet }
}

fn theory(solution: Solution, case: Case) -> Theory {
    Theory::new(solution, &Scenario::new(case).unwrap()).unwrap()
}

fn compare(solution: Solution, case: Case, rows: usize) -> (Vec<FlightPoint>, Comparison) {
    let flight = fly(&case);
    let points = flight.points(&flight.instants(&Sampling::Count(rows), rows).unwrap());
    let comparison = theory(solution, case).compare(&flight, &points, &AtomicBool::new(false)).unwrap();
    (points, comparison)
}

/// The greatest relative error of the speed, and of the angle in degrees, at rows above an altitude.
fn worst(solution: Solution, case: Case, above: f64) -> (f64, f64) {
    let (points, comparison) = compare(solution, case, 40_000);
    let rows = points.iter().zip(&comparison.predictions).filter(|(point, _)| point.loads.altitude >= above);
    rows.fold((0.0_f64, 0.0_f64), |(speed, angle), (point, prediction)| {
        let FlightPath { speed: flown, flight_path_angle, .. } = point.flight_path;
        let speed_error = prediction.speed.map_or(0.0, |predicted| (predicted / flown - 1.0).abs());
        let angle_error = prediction.flight_path_angle.map_or(0.0, |predicted| (predicted - flight_path_angle).abs());
        (speed.max(speed_error), angle.max(angle_error.to_degrees()))
    })
}

/// The thesis says 21.3 km, which is what the equation gives as printed, with ln(η/η): 21.301 km, by hand.
#[test]
fn the_bracket_of_equation_88_reaches_zero_at_21_47_km() {
    for (planet, altitude) in [(LISTING, 21_465.94), (at_rest(LISTING), 21_465.94), (Planet::EARTH_WGS84, 21_465.93)] {
        for rows in [3, 10, 1000] {
            let (points, Comparison { predictions, validity }) = compare(Solution::MediumGlide, table(7, planet), rows);
            assert_eq!(validity.end, End::Bracket);
            // The digits that are written here.
            near("end", validity.to_altitude.unwrap(), altitude, 0.006);
            near("begin", validity.from_altitude.unwrap(), 100_003.0, 1e-6);
            for (point, prediction) in points.iter().zip(predictions) {
                assert_eq!(prediction.speed.is_some(), point.loads.altitude > altitude, "{point:?}");
            }
        }
    }
    // By hand, from equation 88: γ_e² = 2k(η - η_e) + (2/(βr₀))(1 - g₀r₀/V_e²) ln(η/η_e) at that altitude.
    let eta = |altitude: f64| 1.547_93 * (-altitude * BETA).exp() * 20.0 * 0.3 / (2.0 * 2000.0 * BETA);
    let (eta, eta_e) = (eta(21_465.937), eta(100_003.0));
    let excess = (1.0 - 9.798 * 6_378_137.0 / 9847.0_f64.powi(2)) / (BETA * 6_378_137.0);
    let spent = 2.0 * 0.25 * (eta - eta_e) + 2.0 * excess * (eta / eta_e).ln();
    // A millimetre of altitude, in which η is written here, is 1e-7 of η.
    relative("γ_e²", spent, (-35.0_f64).to_radians().powi(2), 2e-7);
}

/// How near the theories come to the simulation, with the constants of the thesis's listing and, last, without rotation,
/// which is what the theories assume. Each figure holds to the digits in which it is written.
#[test]
fn theory_and_simulation_differ_as_much_as_they_should() {
    for (number, solution, above, planet, speed, angle) in [
        (4, Solution::ShallowGlide, 40_000.0, LISTING, 0.093, 0.62),
        (4, Solution::ShallowGlide, 40_000.0, at_rest(LISTING), 0.049, 0.48),
        (4, Solution::Loh, 0.0, LISTING, 0.0, 3.73),
        (4, Solution::Loh, 0.0, at_rest(LISTING), 0.0, 3.40),
        (5, Solution::SteepGlide, 0.0, LISTING, 0.032, 0.13),
        (5, Solution::SteepGlide, 0.0, Planet::EARTH_WGS84, 0.032, 0.13),
        (5, Solution::SteepGlide, 0.0, at_rest(LISTING), 0.032, 0.09),
        (6, Solution::SteepBallistic, 0.0, LISTING, 0.002, 0.10),
        (6, Solution::SteepBallistic, 0.0, at_rest(LISTING), 0.002, 0.13),
        (7, Solution::MediumGlide, 21_600.0, LISTING, 0.037, 1.27),
        (7, Solution::MediumGlide, 21_600.0, at_rest(LISTING), 0.030, 1.51),
    ] {
        let (speed_error, angle_error) = worst(solution, table(number, planet), above);
        near(&format!("speed of table {number} by {solution:?}"), speed_error, speed, 5e-4);
        near(&format!("angle of table {number} by {solution:?}"), angle_error, angle, 5e-3);
    }
    // The ballistic theory stays within 0.25 % from 400 km to the ground, with any of the constants.
    for planet in [LISTING, Planet::EARTH_JAMESON_TEXT, Planet::EARTH_WGS84, at_rest(Planet::EARTH_WGS84)] {
        let (speed, _) = worst(Solution::SteepBallistic, table(6, planet), 0.0);
        assert!(speed < 0.002_5, "{speed}");
    }
}

/// A state whose density has the given η, for a vehicle of this case; all else is of no account to the theories but for Loh's.
fn at(case: &Case, eta: f64, speed: f64) -> FlightPoint {
    let mut point =
        fly(&Case { stop: Stop { altitude: 0.0, time: 1e-3, ..Stop::default() }, ..case.clone() }).initial();
    let Aerodynamics::Constant { drag_coefficient, .. } = case.vehicle.aerodynamics else { panic!("{case:?}") };
    let beta = 1.0 / case.atmosphere.scale_height();
    // (76) η = ρSC_D / (2mβ)
    point.loads.density = eta * 2.0 * case.vehicle.mass * beta / (case.vehicle.reference_area * drag_coefficient);
    point.flight_path.speed = speed;
    point
}

/// A prediction as V², γ and deceleration over βηV².
fn values(prediction: Prediction, eta: f64) -> [f64; 3] {
    let speed_squared = prediction.speed.unwrap().powi(2);
    let drag = prediction.drag_deceleration.unwrap();
    [speed_squared, prediction.flight_path_angle.unwrap(), drag / (BETA * eta * speed_squared)]
}

/// V² and γ, and their slopes by η.
fn slopes(solution: Solution, case: &Case, eta: f64) -> [f64; 4] {
    let theory = theory(solution, case.clone());
    let at = |eta: f64| values(theory.prediction(&at(case, eta, 0.0)).unwrap(), eta);
    let [speed_squared, gamma, drag] = at(eta);
    relative("equations 79, 83 and 90", drag, 1.0, 1e-14);
    // A step at which the error of the difference, h²/6 times the third derivative, and rounding are both near 1e-10.
    let step = 1e-5 * eta;
    let [above, below] = [at(eta + step), at(eta - step)];
    [speed_squared, gamma, (above[0] - below[0]) / (2.0 * step), (above[1] - below[1]) / (2.0 * step)]
}

/// With η as the variable, dη/dt = -βηV sin γ, the thesis's equations for lift and drag alone are
/// d(cos γ)/dη = k and dV²/dη = 2V²/sin γ.
#[test]
fn steep_glide_solves_the_equations_of_lift_and_drag() {
    let case = table(5, LISTING);
    for eta in [1e-4, 1e-3, 5e-3, 1e-2] {
        let [speed_squared, gamma, speed_slope, gamma_slope] = slopes(Solution::SteepGlide, &case, eta);
        relative("d(cos γ)/dη", -gamma.sin() * gamma_slope, 3.0, 1e-7);
        relative("dV²/dη", speed_slope, 2.0 * speed_squared / gamma.sin(), 1e-5);
    }
}

/// Where lift is next to nothing, the steep glide is a straight line without gravity: `V² = V_e² exp[2(η - η_e)/sin γ_e]`.
#[test]
fn a_steep_glide_keeps_its_digits_as_lift_vanishes() {
    for lift in [1e-6, 1e-12, 1e-18, 1e-100, -1e-100] {
        let case = Case { vehicle: vehicle(50.0, 0.01, lift, 0.01), ..table(5, LISTING) };
        let prediction = theory(Solution::SteepGlide, case.clone()).prediction(&at(&case, 0.05, 0.0)).unwrap();
        let eta_e = 1.547_93 * (-100_003.0 * BETA).exp() * 0.01 * 0.01 / (2.0 * 50.0 * BETA);
        let expected = 5372.0 * ((0.05 - eta_e) / (-85.0_f64).to_radians().sin()).exp();
        // The lift turns the flight by k(η - η_e): 1e-4 · 0.05 at most.
        relative("speed", prediction.speed.unwrap(), expected, 1e-5 * f64::max(lift / 1e-6, 1e-6));
    }
}

/// `dV²/dη = 2V²/sin γ_e + 2g₀/(βη)`: drag and gravity along a straight line, by Runge and Kutta's method in ln η.
#[test]
fn steep_ballistic_solves_the_equation_of_drag_and_gravity() {
    // As the thesis has it, and a body so light that e^α overflows.
    for mass in [13.0, 13e-3] {
        let case = Case { vehicle: vehicle(mass, 0.036_609_615, 0.0, 0.085_75), ..table(6, LISTING) };
        let eta = |altitude: f64| 1.547_93 * (-altitude * BETA).exp() * 0.036_609_615 * 0.085_75 / (2.0 * mass * BETA);
        let (sine, gravity) = ((-85.0_f64).to_radians().sin(), 9.798);
        let slope = |log: f64, speed_squared: f64| 2.0 * log.exp() * speed_squared / sine + 2.0 * gravity / BETA;
        let (mut log, mut speed_squared) = (eta(400_003.0).ln(), 10_193.0_f64.powi(2));
        // So small that the method follows the light body: α times the step stays below 0.4.
        let steps = 400_000;
        let step = (eta(0.0).ln() - log) / f64::from(steps);
        let theory = theory(Solution::SteepBallistic, case.clone());
        for i in 1..=steps {
            let k1 = slope(log, speed_squared);
            let k2 = slope(log + 0.5 * step, speed_squared + 0.5 * step * k1);
            let k3 = slope(log + 0.5 * step, speed_squared + 0.5 * step * k2);
            let k4 = slope(log + step, speed_squared + step * k3);
            speed_squared += step / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4);
            log += step;
            if i % 50_000 == 0 {
                let [predicted, gamma, drag] =
                    values(theory.prediction(&at(&case, log.exp(), 0.0)).unwrap(), log.exp());
                relative("V²", predicted, speed_squared, 1e-9);
                relative("γ", gamma, (-85.0_f64).to_radians(), 1e-15);
                relative("D/m", drag, 1.0, 1e-14);
            }
        }
        if mass < 1.0 {
            // Deep in the air it falls as fast as drag lets it, V² = 2g₀/(βα), but for parts of 1/α, here 1/2600.
            let alpha = -2.0 * eta(0.0) / sine;
            relative("terminal speed", speed_squared, 2.0 * gravity / (BETA * alpha), 1.0 / 2000.0);
        }
    }
}

/// Lift and centrifugal relief carry the weight, βηkV² = g₀ - V²/r₀, and drag alone brakes: γ dV²/dη = 2V².
#[test]
fn shallow_glide_keeps_its_balance() {
    for eta in [1e-3, 5e-3, 1e-2, 3e-2] {
        let [speed_squared, gamma, speed_slope, _] = slopes(Solution::ShallowGlide, &table(4, LISTING), eta);
        near("weight", BETA * eta * 0.5 * speed_squared, 9.798 - speed_squared / 6_378_137.0, 1e-13 * 9.798);
        relative("γ dV²/dη", gamma * speed_slope, 2.0 * speed_squared, 1e-7);
    }
}

/// `½ dγ²/dη = -K` with `K = k + (1/(βr₀η))(1 - g₀r₀/V_e²)`, and `V² = V_e² exp[2(γ_e - γ)/K]`.
#[test]
fn medium_glide_is_consistent_with_itself_and_its_equation() {
    let case = table(7, LISTING);
    let excess = (1.0 - 9.798 * 6_378_137.0 / 9847.0_f64.powi(2)) / (BETA * 6_378_137.0);
    for eta in [1e-3, 1e-2, 0.1, 0.5] {
        let [speed_squared, gamma, _, gamma_slope] = slopes(Solution::MediumGlide, &case, eta);
        let turning = -gamma * gamma_slope;
        relative("K", turning, 0.25 + excess / eta, 1e-6);
        let fall = 2.0 * ((-35.0_f64).to_radians() - gamma) / turning;
        relative("V²", speed_squared, 9847.0_f64.powi(2) * fall.exp(), 1e-6);
    }
    // At circular speed nothing but lift turns the flight, and drag for small angles is dV²/dη = 2V²/γ.
    let circular = (9.798 * 6_378_137.0_f64).sqrt();
    let entry = FlightPath { speed: circular, ..FlightPath::from_planet_fixed(&case.initial_state) };
    let case = Case { initial_state: entry.to_planet_fixed(), ..case };
    for eta in [1e-2, 0.1, 0.5] {
        let [speed_squared, gamma, speed_slope, gamma_slope] = slopes(Solution::MediumGlide, &case, eta);
        relative("d(γ²)/dη", 2.0 * gamma * gamma_slope, -0.5, 1e-6);
        relative("dV²/dη", speed_slope, 2.0 * speed_squared / gamma, 1e-6);
    }
}

/// d(cos γ)/dη = k - (1/(βr₀))(g₀r₀/V² - 1) cos γ/η, of which Loh holds the second term constant: exact at entry.
#[test]
fn loh_starts_along_the_equation_of_the_angle() {
    let case = table(4, LISTING);
    let eta_e = 1.547_93 * (-60_003.0 * BETA).exp() * 20.0 / (2.0 * 99_000.0 * BETA);
    let theory = theory(Solution::Loh, case.clone());
    let cosine = |eta: f64| theory.prediction(&at(&case, eta, 7571.7)).unwrap().flight_path_angle.unwrap().cos();
    let step = 1e-3 * eta_e;
    let slope = (cosine(eta_e + step) - cosine(eta_e - step)) / (2.0 * step);
    let relief = (9.798 * 6_378_137.0 / 7571.7_f64.powi(2) - 1.0) / (BETA * 6_378_137.0);
    // The step squared, 1e-6, counts against the second term, which is 31 times the sum.
    relative("d(cos γ)/dη", slope, 0.5 - relief * 0.013_04_f64.cos() / eta_e, 5e-5);
}

/// On an ever greater planet, at the same parts of circular speed, equation 80 becomes equation 81: the difference falls as 1/(βr₀).
#[test]
fn loh_becomes_first_order_as_the_planet_grows() {
    let difference = |size: f64| {
        let radius = 6_378_137.0 * size;
        let planet = Planet {
            shape: reentry::planet::Shape::Sphere { radius },
            gravitational_parameter: 9.798 * radius * radius,
            ..at_rest(LISTING)
        };
        let speed = 7000.0 * size.sqrt();
        let entry = FlightPath {
            radius: radius + 60_000.0,
            speed,
            flight_path_angle: -1.0,
            longitude: 0.0,
            geocentric_latitude: 0.0,
            heading: 0.0,
        };
        let case = Case { planet, initial_state: entry.to_planet_fixed(), ..table(4, LISTING) };
        let angle = |solution| {
            theory(solution, case.clone()).prediction(&at(&case, 0.2, speed)).unwrap().flight_path_angle.unwrap()
        };
        angle(Solution::Loh) - angle(Solution::SteepGlide)
    };
    let [small, large] = [1.0, 1000.0].map(difference);
    assert!(small.abs() > 1e-5, "{small}");
    relative("a thousandth", large * 1000.0, small, 1e-3);
}

/// The altitude at which cos γ of equation 81 is 1 is that of `k(η - η_e) = 1 - cos γ_e`.
#[test]
fn a_steep_glide_ends_where_it_levels_out() {
    let heavy_lift = Case { vehicle: vehicle(50.0, 0.1, 0.3, 0.1), ..table(5, LISTING) };
    let (points, comparison) = compare(Solution::SteepGlide, heavy_lift, 400);
    assert_eq!(comparison.validity.end, End::Level(81));
    let by_density = 0.1 * 0.1 / (2.0 * 50.0 * BETA);
    let eta_e = by_density * 1.547_93 * (-100_003.0 * BETA).exp();
    let eta = (1.0 - (-85.0_f64).to_radians().cos()) / 3.0 + eta_e;
    let altitude = (by_density * 1.547_93 / eta).ln() / BETA;
    near("end", comparison.validity.to_altitude.unwrap(), altitude, 1e-5);
    // The simulated flight comes back up into the air where the theory had numbers; that of a descent is over.
    let lowest = points.iter().position(|point| point.flight_path.flight_path_angle > 0.0).unwrap();
    assert!(points[lowest..].iter().any(|point| point.loads.altitude > altitude));
    assert!(comparison.predictions[lowest..].iter().all(|prediction| *prediction == Prediction::default()));
    assert!(comparison.predictions[..lowest / 2].iter().all(|prediction| prediction.speed.is_some()));
}

/// Lift that turns the flight down ends at the vertical, in the theory as in the simulation.
#[test]
fn a_steep_glide_with_negative_lift_ends_at_the_vertical() {
    let case = Case { vehicle: vehicle(50.0, 0.1, -0.3, 0.1), ..table(5, LISTING) };
    let (_, comparison) = compare(Solution::SteepGlide, case, 400);
    assert_eq!(comparison.validity.end, End::Vertical(81));
    let last = comparison.predictions.iter().filter_map(|prediction| prediction.flight_path_angle).next_back();
    assert!((-std::f64::consts::FRAC_PI_2..-1.48).contains(&last.unwrap()));
}

#[test]
fn a_shallow_glide_ends_at_five_degrees() {
    let (points, comparison) = compare(Solution::ShallowGlide, table(4, LISTING), 500);
    assert_eq!(comparison.validity.end, End::LargeAngle);
    // |γ| = 2g₀/(kβV²) = 5°, V² by (77): βr₀ηk + 1 = (π/36) kβr₀/2.
    let eta = (std::f64::consts::PI / 72.0 * 0.5 * BETA * 6_378_137.0 - 1.0) / (BETA * 6_378_137.0 * 0.5);
    let altitude = (1.547_93 * 20.0 / (2.0 * 99_000.0 * BETA) / eta).ln() / BETA;
    near("end", comparison.validity.to_altitude.unwrap(), altitude, 1e-5);
    // The flight skips: it comes twice through the same altitude, with the same prediction.
    assert!(points.windows(2).any(|pair| pair[1].loads.altitude > pair[0].loads.altitude));
    let high = comparison.predictions.iter().zip(&points).filter(|(_, point)| point.loads.altitude > 23_000.0);
    assert!(high.into_iter().all(|(prediction, _)| prediction.speed.is_some()));
}

/// Without rotation Table 4's flight skips so far that cos γ of equation 80 exceeds 1 by 1e-5 for a while.
#[test]
fn loh_goes_on_after_a_gap() {
    let (points, comparison) = compare(Solution::Loh, table(4, at_rest(LISTING)), 5000);
    assert_eq!(comparison.validity.end, End::Flight(Termination::SurfaceImpact));
    near("end", comparison.validity.to_altitude.unwrap(), 0.0, 1e-6);
    let gap = comparison.predictions.iter().position(|prediction| prediction.flight_path_angle.is_none()).unwrap();
    assert!((40_000.0..45_000.0).contains(&points[gap].loads.altitude), "{}", points[gap].loads.altitude);
    assert!(comparison.predictions[points.len() - 1].flight_path_angle.is_some());
    assert!(comparison.predictions.iter().all(|prediction| prediction.speed.is_none()));
}

#[test]
fn a_theory_that_never_holds_says_why() {
    // 2g₀/(kβV²) exceeds 5° at any speed: so little lift carries no shallow glide.
    let case = Case { vehicle: vehicle(99_000.0, 20.0, 0.01, 1.0), ..table(4, LISTING) };
    let (_, Comparison { predictions, validity }) = compare(Solution::ShallowGlide, case, 20);
    assert!(predictions.iter().all(|prediction| *prediction == Prediction::default()));
    assert_eq!((validity.from_altitude, validity.to_altitude, validity.end), (None, None, End::LargeAngle));
}

#[test]
fn what_no_number_holds_is_no_prediction() {
    // C_L/C_D beyond all numbers: no speed, and no angle to divide by it.
    let lift = Case { vehicle: vehicle(50.0, 0.01, 1e9, 1e-300), ..table(5, LISTING) };
    let prediction = theory(Solution::ShallowGlide, lift.clone()).prediction(&at(&lift, 0.01, 5000.0));
    assert_eq!(prediction, Err(End::Overflow));
    // Loh's g₀r₀/V² at rest, at entry 1/0 times 0.
    let loh = table(4, LISTING);
    let mut entry = fly(&loh).initial();
    entry.flight_path.speed = 0.0;
    assert_eq!(theory(Solution::Loh, loh).prediction(&entry), Err(End::Overflow));
}

#[test]
fn a_medium_glide_from_less_than_circular_speed_ends_at_the_pole_of_its_speed() {
    let case = table(7, LISTING);
    let entry = FlightPath { speed: 7500.0, ..FlightPath::from_planet_fixed(&case.initial_state) };
    let case = Case { initial_state: entry.to_planet_fixed(), ..case };
    let (_, comparison) = compare(Solution::MediumGlide, case, 500);
    assert_eq!(comparison.validity.end, End::Pole(89));
    // k + (1/(βr₀η))(1 - g₀r₀/V_e²) = 0
    let eta = (9.798 * 6_378_137.0 / 7500.0_f64.powi(2) - 1.0) / (BETA * 6_378_137.0) / 0.25;
    let altitude = (1.547_93 * 20.0 * 0.3 / (2.0 * 2000.0 * BETA) / eta).ln() / BETA;
    near("end", comparison.validity.to_altitude.unwrap(), altitude, 1e-5);
}

#[test]
fn theories_that_do_not_apply_are_refused_with_every_fault() {
    let refused = |solution, case: Case, expected: &[Fault]| {
        let error = Theory::new(solution, &Scenario::new(case).unwrap()).unwrap_err();
        assert_eq!(error.0, expected, "{solution:?}: {error}");
    };
    let rising = |case: Case| {
        let entry = FlightPath { flight_path_angle: 0.1, ..FlightPath::from_planet_fixed(&case.initial_state) };
        Case { initial_state: entry.to_planet_fixed(), ..case }
    };
    let with = |case: Case, vehicle: Vehicle| Case { vehicle, ..case };
    for solution in ALL {
        let ballistic = solution == Solution::SteepBallistic;
        let case = if ballistic { table(6, LISTING) } else { table(5, LISTING) };
        refused(solution, in_vacuum(case.clone()), &[Fault::NoAir]);
        let lift = if ballistic { 0.0 } else { 0.2 };
        refused(solution, with(case.clone(), vehicle(50.0, 0.0, lift, 0.1)), &[Fault::NoArea]);
        refused(solution, with(case.clone(), vehicle(50.0, 0.1, lift, 0.0)), &[Fault::NoDrag]);
        // e^(-h/H) is zero from 745 scale heights on.
        let high = Atmosphere::Exponential { surface_density: 1.0, scale_height: 100.0 };
        refused(solution, Case { atmosphere: high, ..case.clone() }, &[Fault::NoAirAtEntry]);
        if ballistic {
            let lifting = with(case.clone(), vehicle(50.0, 0.1, 0.2, 0.1));
            refused(solution, lifting.clone(), &[Fault::Lift { lift_coefficient: 0.2 }]);
            let error = Theory::new(solution, &Scenario::new(rising(lifting)).unwrap()).unwrap_err();
            assert!(matches!(error.0[..], [Fault::Lift { .. }, Fault::NoDescent { .. }]), "{error}");
        } else {
            refused(solution, with(case.clone(), vehicle(50.0, 0.1, 0.0, 0.1)), &[Fault::NoLift]);
            refused(
                solution,
                with(case.clone(), vehicle(50.0, 0.0, 0.0, 0.0)),
                &[Fault::NoLift, Fault::NoDrag, Fault::NoArea],
            );
        }
        let descends = !matches!(solution, Solution::ShallowGlide | Solution::Loh);
        let climbs = Theory::new(solution, &Scenario::new(rising(case)).unwrap());
        let faults = climbs.err().map_or(Vec::new(), |error| error.0);
        assert_eq!(matches!(faults[..], [Fault::NoDescent { .. }]), descends, "{solution:?}: {faults:?}");
        assert_eq!(faults.is_empty(), !descends, "{solution:?}: {faults:?}");
    }
}

#[test]
fn a_theory_gives_numbers_within_its_segment_and_none_outside() {
    let ends = Cell::new(0);
    proptest!(config(100), |(case in random_entry(), light in -6.0..0.0)| {
        let Vehicle { mass, reference_area, ref aerodynamics, .. } = case.vehicle;
        for solution in ALL {
            let Aerodynamics::Constant { mut lift_coefficient, drag_coefficient } = *aerodynamics else {
                panic!("{aerodynamics:?}")
            };
            if solution == Solution::SteepBallistic {
                lift_coefficient = 0.0;
            }
            let mass = mass * 10_f64.powf(light);
            let case = Case { vehicle: vehicle(mass, reference_area, lift_coefficient, drag_coefficient), ..case.clone() };
            let theory = match Theory::new(solution, &Scenario::new(case.clone()).unwrap()) {
                Ok(theory) => theory,
                Err(AnalyticError(faults)) => {
                    let climbs = FlightPath::from_planet_fixed(&case.initial_state).flight_path_angle >= 0.0;
                    prop_assert!(climbs && matches!(faults[..], [Fault::NoDescent { .. }]), "{solution:?}: {faults:?}");
                    continue;
                }
            };
            let flight = fly(&case);
            let points = flight.points(&flight.instants(&Sampling::PerStep(2), usize::MAX).unwrap());
            let Comparison { predictions, validity } = theory.compare(&flight, &points, &AtomicBool::new(false)).unwrap();
            let holds: Vec<_> = predictions.iter().map(|prediction| prediction.flight_path_angle.is_some()).collect();
            prop_assert_eq!(holds.contains(&true), validity.from_altitude.is_some() && validity.to_altitude.is_some());
            prop_assert_eq!(holds.last() == Some(&true), matches!(validity.end, End::Flight(_)));
            for Prediction { speed, flight_path_angle, drag_deceleration } in predictions {
                for number in [speed, flight_path_angle, drag_deceleration].into_iter().flatten() {
                    prop_assert!(number.is_finite(), "{number}");
                }
                prop_assert!(speed.unwrap_or(0.0) >= 0.0 && drag_deceleration.unwrap_or(0.0) >= 0.0);
            }
            // The last instant with numbers and the first without lie on either side of the end.
            let last = holds.iter().rposition(|holds| *holds);
            if let Some((last, next)) = last.and_then(|last| Some((last, points.get(last + 1)?))) {
                let [low, high] = [points[last].loads.altitude, next.loads.altitude];
                let end = validity.to_altitude.unwrap();
                let turns = points[last].flight_path.flight_path_angle * next.flight_path.flight_path_angle <= 0.0;
                // A vehicle that turns between the rows may end beyond both.
                prop_assert!(turns || (low.min(high) - 1e-6..=low.max(high) + 1e-6).contains(&end), "{low} {end} {high}");
                ends.set(ends.get() + 1);
            }
        }
    });
    assert!(ends.get() > 100, "{} of 500 segments end on the way", ends.get());
}

/// Where a theory holds is a matter of the flight, not of the rows that are wanted.
#[test]
fn the_segment_does_not_depend_on_the_rows() {
    let pull_up = |lift, drag, flight_path_angle| {
        let entry = FlightPath {
            radius: 6_478_137.0,
            longitude: -0.7,
            geocentric_latitude: 0.2,
            speed: 9000.0,
            flight_path_angle,
            heading: 0.5,
        };
        let vehicle = vehicle(5500.0, 12.0, lift, drag);
        Case {
            planet: Planet::EARTH_JAMESON_LISTING.spherical(),
            vehicle,
            initial_state: entry.to_planet_fixed(),
            ..target_2()
        }
    };
    for (solution, case) in [
        (Solution::ShallowGlide, table(4, Planet::EARTH_JAMESON_LISTING)),
        (Solution::Loh, table(4, Planet::EARTH_JAMESON_LISTING)),
        (Solution::SteepGlide, table(5, Planet::EARTH_JAMESON_LISTING)),
        (Solution::MediumGlide, table(7, Planet::EARTH_JAMESON_LISTING)),
        // These skip: the theory ends where the flight first climbs, not where it climbs once more.
        (Solution::SteepGlide, pull_up(0.03, 0.05, -0.1)),
        (Solution::MediumGlide, pull_up(0.03, 0.05, -0.1)),
    ] {
        let flight = fly(&case);
        let validity = |sampling: Sampling| {
            let instants = flight.instants(&sampling, usize::MAX).unwrap();
            theory(solution, case.clone())
                .compare(&flight, &flight.points(&instants), &AtomicBool::new(false))
                .unwrap()
                .validity
        };
        let dense = validity(Sampling::PerStep(64));
        assert_eq!(validity(Sampling::Count(2)), dense, "{solution:?}");
        assert_eq!(validity(Sampling::Interval(1.7)), dense, "{solution:?}");
    }
    let flight = fly(&pull_up(0.03, 0.05, -0.1));
    let ends = flight.points(&[0.0, flight.end_time()]);
    let ending = theory(Solution::MediumGlide, pull_up(0.03, 0.05, -0.1))
        .compare(&flight, &ends, &AtomicBool::new(false))
        .unwrap()
        .validity;
    assert_eq!(ending.end, End::Climb);
}

#[test]
fn the_flag_ends_the_search_for_the_segment() {
    let case = table(4, LISTING);
    let interrupted = theory(Solution::Loh, case.clone()).compare(&fly(&case), &[], &AtomicBool::new(true));
    assert!(matches!(interrupted, Err(reentry::simulate::SimulationError::Interrupted { .. })));
}
