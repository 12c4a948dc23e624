//! Ascents against closed forms and against an integration of the tests' own in inertial space.

use std::f64::consts::{FRAC_PI_4, PI, TAU};
use std::sync::Arc;

use nalgebra::{Matrix3, Rotation3, Vector3};
use reentry::control::{Against, Command, Interpolation, Schedule};
use reentry::event::{Effect, Event, Quantity, Separation, Throttle, Tilt, Trigger};
use reentry::part::Part;
use reentry::planet::Planet;
use reentry::scenario::{Case, Stop};
use reentry::steering::{Program, ProgramAxes, Steering};
use reentry::trajectory::{Termination, Trajectory};
use reentry::vehicle::{Aerodynamics, AlphaMachTable, Vehicle};
use reentry::{Atmosphere, Control, PlanetFixed, Wind};

use super::flights::{fly, with_tolerance};
use super::rockets::{
    Flame, G0, Inertial, Rocket, at, earth, ignite, launch_axes, lift_off, load, local_axes, miss, motor, normal, on,
    pad, rises, sounding_rocket, stage, standard_air, steer, still, vehicle_of,
};

/// Lit at once on the surface at the zero meridian, until it burns out.
fn burn_in_vacuum(planet: Planet, part: Part, steering: Steering) -> Case {
    let start =
        PlanetFixed { position: Vector3::new(planet.equatorial_radius(), 0.0, 0.0), velocity: Vector3::zeros() };
    Case {
        atmosphere: Atmosphere::Vacuum,
        initial_state: start,
        steering,
        hold_down: false,
        events: vec![at(0.0, ignite(&[0]))],
        stop: Stop { when: vec![Trigger::AfterBurnout { part: 0, delay: 0.0 }], ..Stop::default() },
        ..vehicle_of(planet, vec![part])
    }
}

fn inertial_program(axes: Matrix3<f64>, pitch: Command, yaw: Command) -> Steering {
    Steering::Program(Program { axes: ProgramAxes::Inertial(Rotation3::from_matrix_unchecked(axes)), pitch, yaw })
}

#[test]
fn far_from_all_gravity_holds_the_rocket_equation() {
    let flight = fly(&burn_in_vacuum(still(1e6, 1e-3), sounding_rocket(), Steering::Vertical));
    let [end, exhaust, burn_time] = [flight.last().time, 300.0 * G0, 800.0 * 300.0 * G0 / 30e3];
    let last = flight.last();
    assert!((end - burn_time).abs() < 1e-9 && (burn_time - 78.4532).abs() < 1e-4, "{end}");
    // c ln 5, and c t_b (1 - ln 5/4); the tolerance of a flight is 1e-10 of √(g₀r₀), here tiny, and of the state.
    assert!((last.loads.speed - exhaust * 5_f64.ln()).abs() < 1e-6, "{}", last.loads.speed);
    assert!((last.loads.speed - 4_734.958_291).abs() < 1e-6);
    let height = exhaust * burn_time * (1.0 - 5_f64.ln() / 4.0);
    assert!((last.loads.altitude - height).abs() < 1e-3 && (height - 137_940.764_681).abs() < 1e-6);
}

/// The gravity of 9.80665 m/s² everywhere, but for what a radius of 1e11 m leaves: 140 km/1e11 m of it, twice, over the burn: 5e-4 m/s.
fn flat() -> Planet {
    still(1e11, G0 * 1e22)
}

#[test]
fn a_constant_pitch_in_inertial_space_flies_as_the_closed_form_says() {
    let axes = Matrix3::from_columns(&[Vector3::y(), Vector3::z(), Vector3::x()]);
    let constant = |degrees: f64| Command::Constant(degrees.to_radians());
    let steering = inertial_program(axes, constant(60.0), constant(0.0));
    let last = fly(&burn_in_vacuum(flat(), sounding_rocket(), steering)).last();
    let [exhaust, burn_time] = [300.0 * G0, 800.0 * 300.0 * G0 / 30e3];
    let [gain, way] = [exhaust * 5_f64.ln(), exhaust * burn_time * (1.0 - 5_f64.ln() / 4.0)];
    let (sin, cos) = 60_f64.to_radians().sin_cos();
    let [up, ahead] = [gain * sin - G0 * burn_time, gain * cos];
    assert!((last.loads.speed - up.hypot(ahead)).abs() < 1e-3, "{}", last.loads.speed);
    assert!((up.hypot(ahead) - 4_086.815_153).abs() < 1e-5);
    assert!((last.flight_path.flight_path_angle - up.atan2(ahead)).abs() < 1e-6);
    assert!((last.loads.altitude - (way * sin - 0.5 * G0 * burn_time * burn_time)).abs() < 0.1);
    // Towards ê₁, which is east here.
    assert!((last.flight_path.heading).abs() < 1e-9);
}

#[test]
fn a_linear_tangent_flies_as_bryson_and_ho_say() {
    // 20 m/s² for 100 s, which burn 2e-7 of the mass.
    let part = stage(1000.0, 1.0, 20_000.0 * 1.001, 1e9, 0.0);
    let axes = Matrix3::from_columns(&[Vector3::z(), -Vector3::y(), Vector3::x()]);
    let steering = Steering::LinearTangent { axes: Rotation3::from_matrix_unchecked(axes), a: 1.0, b: 0.02 };
    let case = burn_in_vacuum(still(1e6, 1e-3), part, steering);
    let case = Case { stop: Stop { time: 100.0, ..Stop::default() }, ..case };
    let last = fly(&case).last().flight_path.to_planet_fixed();
    // With p₀ = 45°: v = a T cot p₀ ln(sec p₀ + tan p₀), h = a T²/4 (cosec p₀ - cot² p₀ ln(sec p₀ + tan p₀)), and no vertical speed.
    let log = (FRAC_PI_4.cos().recip() + 1.0).ln();
    let [speed, height] = [2000.0 * log, 50_000.0 * (FRAC_PI_4.sin().recip() - log)];
    assert!((speed - 1_762.747_174).abs() < 1e-6 && (height - 26_641.998_768).abs() < 1e-6);
    assert!((last.velocity.z - speed).abs() < 1e-6 * speed, "{}", last.velocity);
    assert!((last.position.x - 1e6 - height).abs() < 1e-6 * height, "{}", last.position);
    assert!(last.velocity.x.abs() < 1e-3 && last.velocity.y.abs() < 1e-9);
}

#[test]
fn a_body_thrown_up_comes_down_to_the_west() {
    let planet = Planet::EARTH_WGS84.spherical();
    let start = PlanetFixed { velocity: Vector3::x() * 200.0, ..pad(&planet, 0.0, 0.0) };
    let case = Case {
        atmosphere: Atmosphere::Vacuum,
        hold_down: false,
        initial_state: start,
        ..vehicle_of(planet, vec![load(10.0)])
    };
    let last = fly(&case).last();
    let east = last.flight_path.longitude * planet.equatorial_radius();
    assert!((last.time - 40.982_782_436).abs() < 1e-6, "{}", last.time);
    assert!((east + 8.161_323_775).abs() < 1e-3, "{east}");
}

#[test]
fn a_vehicle_is_held_until_its_thrust_exceeds_its_weight() {
    for planet in [Planet::EARTH_WGS84, earth(), Planet::EARTH_WGS84.spherical()] {
        for (area, boosted) in [(0.0, false), (0.1, false), (0.1, true)] {
            // Heavier than it can lift, at a flow of 68 kg/s.
            let mut parts =
                vec![stage(1100.0, if area > 0.0 { 19_300.0 } else { 20_000.0 }, 200e3, 300.0, area), load(100.0)];
            if boosted {
                parts.push(Part {
                    count: 2,
                    ..motor(40.0, 1000.0, &[(0.0, 0.0), (40.0, 8e3), (80.0, 0.0)], 250.0, 0.02)
                });
            }
            let lit: &[usize] = if boosted { &[0, 2] } else { &[0] };
            let case = Case {
                events: vec![at(1.5, ignite(lit)), lift_off()],
                stop: Stop { time: 90.0, ..Stop::default() },
                ..vehicle_of(planet, parts)
            };
            let start = Inertial::of(&case.initial_state, &planet, 0.0, 0.0);
            let up = normal(&planet, &start.position);
            let spin = Vector3::z() * planet.rotation_rate;
            let relief = -spin.cross(&spin.cross(&start.position));
            let weight = -(super::rockets::gravity(&planet, &start.position) + relief).dot(&up);
            let [_, pressure, _] = standard_air(start.altitude(&planet));
            // m(t) g = T(t), with a booster's T = 200 N/s t and ṁ in proportion.
            let exit_area = area + if boosted { 0.04 } else { 0.0 };
            let rate = if boosted { 2.0 * 200.0 } else { 0.0 };
            let excess = |t: f64| {
                let mass = case.vehicle.mass - 200e3 * t / (300.0 * G0) - 0.5 * rate * t * t / (250.0 * G0);
                200e3 + rate * t - pressure * exit_area - mass * weight
            };
            let (mut least, mut most) = (0.0, 40.0);
            for _ in 0..80 {
                let middle = 0.5 * (least + most);
                *(if excess(middle) < 0.0 { &mut least } else { &mut most }) = middle;
            }
            let flight = fly(&case);
            let event = flight.events().find(|event| event.event == 1).unwrap();
            // To the last digits of the excess: the weight of 1 g in 1e-9 s at this flow, over the forces of 200 kN.
            assert!((event.before.time - 1.5 - least).abs() < 1e-9, "{} {least}", event.before.time - 1.5);
            assert!(least > 1.0, "{least}");
            // It stays where it is, and burns.
            let held = flight.at(1.5 + 0.5 * least);
            assert_eq!(held.flight_path.to_planet_fixed().velocity, Vector3::zeros());
            assert!((held.flight_path.to_planet_fixed().position - case.initial_state.position).norm() < 1e-8);
            assert!(flight.last().loads.altitude > 100.0);
        }
    }
}

#[test]
fn a_body_dropped_in_vacuum_follows_an_ellipse_of_kepler() {
    let planet = Planet::EARTH_WGS84.spherical();
    let parts = vec![stage(500.0, 4000.0, 120e3, 300.0, 0.0), load(100.0)];
    let drop = Effect { separate: vec![Separation { parts: vec![0], push: None, body: 0 }], ..Effect::default() };
    let axes = launch_axes(&planet, &pad(&planet, -1.4, 0.5).position, 1.3);
    let pitch = Command::Constant(0.7);
    let base = Case { atmosphere: Atmosphere::Vacuum, ..vehicle_of(planet, parts.clone()) };
    let body = Case { parts: vec![parts[0].clone()], hold_down: false, ..base.clone() };
    let case = Case {
        events: vec![
            at(0.0, Effect { steer: Some(inertial_program(axes, pitch, Command::Constant(0.0))), ..ignite(&[0]) }),
            lift_off(),
            on(Trigger::AfterBurnout { part: 0, delay: 5.0 }, drop),
        ],
        bodies: vec![reentry::scenario::BodyCase { case: body, stop_time: None }],
        ..base
    };
    let flights = super::rockets::fly_all(&with_tolerance(case, 1e-12));
    let flight = &flights.bodies[0].trajectory;
    assert_eq!(flight.termination(), Termination::SurfaceImpact);
    let [start, end] = [flight.initial(), flight.last()];
    let from = Inertial::of(&start.flight_path.to_planet_fixed(), &planet, start.time, 0.0);
    let to = Inertial::of(&end.flight_path.to_planet_fixed(), &planet, end.time, 0.0);
    let mu = planet.gravitational_parameter;
    // Kepler's equation from the one place to the other.
    let momentum = from.position.cross(&from.velocity);
    let eccentric = from.velocity.cross(&momentum) / mu - from.position.normalize();
    let eccentricity = eccentric.norm();
    let axis = (2.0 / from.position.norm() - from.velocity.norm_squared() / mu).recip();
    let [p, q] = [eccentric / eccentricity, momentum.cross(&eccentric).normalize()];
    let radius = planet.equatorial_radius();
    // It falls: the eccentric anomaly lies beyond half a turn.
    let anomaly = |radius: f64, rising: bool| {
        let angle = ((1.0 - radius / axis) / eccentricity).acos();
        if rising { angle } else { TAU - angle }
    };
    let since_periapsis = |angle: f64| (axis.powi(3) / mu).sqrt() * (angle - eccentricity * angle.sin());
    let [first, last] =
        [anomaly(from.position.norm(), from.position.dot(&from.velocity) > 0.0), anomaly(radius, false)];
    let time = since_periapsis(last) - since_periapsis(first);
    assert!((end.time - start.time - time).abs() < 1e-6, "{} {time}", end.time - start.time);
    let place =
        p * (axis * (last.cos() - eccentricity)) + q * (axis * (1.0 - eccentricity * eccentricity).sqrt() * last.sin());
    assert!((to.position - place).norm() < 1e-2, "{}", (to.position - place).norm());
    // And the elements stay.
    let [a, b] = [start, end].map(|point| point.orbital_elements(&planet, 0.0).unwrap().0);
    for elements in [a, b] {
        let apoapsis = elements.apoapsis_radius().unwrap();
        assert!((apoapsis - axis * (1.0 + eccentricity)).abs() < 1e-9 * axis, "{apoapsis}");
        assert!((elements.eccentricity - eccentricity).abs() < 1e-9, "{}", elements.eccentricity);
    }
}

/// Agreement with a flight at the default tolerance and at 1e-12: m and s.
const AGREEMENT: [(f64, f64, f64); 2] = [(1e-10, 1.0, 1e-3), (1e-12, 1e-2, 1e-5)];
/// The step of the oracle, s: its error, of the fourth order, is a hundredth of what is allowed.
const STEP: f64 = 0.05;

/// 4000 kg at 5 km, climbing at 300 m/s, lit for 50 s.
fn climbing() -> Case {
    let planet = earth();
    let parts = vec![stage(800.0, 2700.0, 110e3, 280.0, 0.12), load(500.0)];
    let case = vehicle_of(planet, parts);
    let start = pad(&planet, -1.4, 0.5);
    let [north, east, up] = local_axes(&start.position);
    let velocity = (up * 0.94 + (north * 0.6 + east * 0.8) * 0.34).normalize() * 300.0;
    let initial_state = PlanetFixed { position: start.position + up * 5e3, velocity };
    Case {
        initial_state,
        hold_down: false,
        wind: Wind::Constant { east: 20.0, north: -10.0 },
        events: vec![at(0.0, ignite(&[0]))],
        stop: Stop { time: 50.0, ..Stop::default() },
        ..case
    }
}

type Axis<'a> = &'a dyn Fn(&Inertial) -> Vector3<f64>;
type Coefficients<'a> = &'a dyn Fn(f64, f64) -> [f64; 2];

/// Flies the climb with a steering, and with the axis that it means; `more` is a change of the case, and a load limit of the oracle.
fn agree_on_a_climb(what: &str, case: &Case, axis: Axis, coefficients: Coefficients, load_limit: Option<f64>) {
    let planet = case.planet;
    let thrust = |_: f64| 110e3;
    let rocket = Rocket {
        planet,
        flames: vec![Flame { thrust: &thrust, specific_impulse: 280.0, exit_area: 0.12 }],
        axis,
        area: case.vehicle.reference_area,
        coefficients,
        wind: [20.0, -10.0],
        load_limit,
    };
    let start = Inertial::of(&case.initial_state, &planet, 0.0, case.vehicle.mass);
    let end = rocket.until(&start, 50.0, 0.2 * STEP);
    for (tolerance, metres, _) in AGREEMENT {
        let last = fly(&with_tolerance(case.clone(), tolerance)).last();
        let off = miss(&last, &end, &planet);
        assert!(off < metres, "{what}: {off} m off at {tolerance}");
        assert!((last.mass - end.mass).abs() < 1e-4 * metres, "{what}: {} {}", last.mass, end.mass);
    }
}

const PLAIN: Coefficients = &|_, _| [0.0, 0.4];

fn schedule(against: Against, at: &[f64], degrees: &[f64]) -> Command {
    let value: Vec<_> = degrees.iter().map(|degrees| degrees.to_radians()).collect();
    Command::Schedule(Arc::new(Schedule::new(against, at, &value, Interpolation::Linear).unwrap()))
}

/// Straight lines between entries, in degrees, to rad.
fn straight(at: &[f64], degrees: &[f64], x: f64) -> f64 {
    let cell = at.windows(2).position(|pair| x < pair[1]).unwrap_or(at.len() - 2);
    let part = ((x - at[cell]) / (at[cell + 1] - at[cell])).clamp(0.0, 1.0);
    (degrees[cell] + part * (degrees[cell + 1] - degrees[cell])).to_radians()
}

fn direction(pitch: f64, yaw: f64, axes: [Vector3<f64>; 3]) -> Vector3<f64> {
    axes[0] * (pitch.cos() * yaw.cos()) + axes[1] * (pitch.cos() * yaw.sin()) + axes[2] * pitch.sin()
}

#[test]
fn vertical_steering_points_along_the_normal() {
    let case = climbing();
    let planet = case.planet;
    agree_on_a_climb("vertical", &case, &|now| normal(&planet, &now.position), PLAIN, None);
}

#[test]
fn a_gravity_turn_points_along_the_velocity_over_ground() {
    let case = Case { steering: Steering::Velocity, ..climbing() };
    let planet = case.planet;
    agree_on_a_climb("velocity", &case, &|now| now.over_ground(&planet).normalize(), PLAIN, None);
    let leant = |now: &Inertial| {
        let ahead = now.over_ground(&planet).normalize();
        let up = now.position.normalize();
        let across = (up - ahead * up.dot(&ahead)).normalize();
        let left = across.cross(&ahead);
        ahead * 0.05_f64.cos() + (across * 0.6_f64.cos() + left * 0.6_f64.sin()) * 0.05_f64.sin()
    };
    let angles = Control { angle_of_attack: Command::Constant(0.05), bank_angle: Command::Constant(0.6) };
    agree_on_a_climb("angle of attack", &Case { control: angles, ..case }, &leant, PLAIN, None);
}

#[test]
fn programs_point_as_their_axes_and_schedules_say() {
    let case = climbing();
    let planet = case.planet;
    let axes = launch_axes(&planet, &case.initial_state.position, 0.8);
    let columns = [0, 1, 2].map(|column| axes.column(column).into_owned());
    let steered = |steering: Steering| Case { steering, ..case.clone() };
    let by_time = ([0.0, 10.0, 31.0, 45.0], [80.0, 70.0, 40.0, 45.0]);
    let by_altitude = ([6e3, 9e3, 14e3], [5.0, -10.0, 0.0]);
    let pitch = schedule(Against::Time, &by_time.0, &by_time.1);
    let yaw = schedule(Against::Altitude, &by_altitude.0, &by_altitude.1);
    let angles = |now: &Inertial| {
        let pitch = straight(&by_time.0, &by_time.1, now.time);
        (pitch, straight(&by_altitude.0, &by_altitude.1, now.altitude(&planet)))
    };
    let inertial = |now: &Inertial| {
        let (pitch, yaw) = angles(now);
        direction(pitch, yaw, columns)
    };
    agree_on_a_climb("inertial", &steered(inertial_program(axes, pitch.clone(), yaw.clone())), &inertial, PLAIN, None);
    let local = |now: &Inertial| {
        let (pitch, yaw) = angles(now);
        direction(pitch, yaw, local_axes(&now.position))
    };
    let program = Steering::Program(Program { axes: ProgramAxes::Local, pitch, yaw });
    agree_on_a_climb("local", &steered(program), &local, PLAIN, None);
    let tangent = Steering::LinearTangent { axes: Rotation3::from_matrix_unchecked(axes), a: 2.0, b: 0.05 };
    let by_tangent = |now: &Inertial| direction((2.0 - 0.05 * now.time).atan(), 0.0, columns);
    agree_on_a_climb("linear tangent", &steered(tangent), &by_tangent, PLAIN, None);
    agree_on_a_climb(
        "load limit",
        &Case {
            events: vec![at(0.0, Effect { load_limit: Some(Some(3.1)), ..ignite(&[0]) })],
            ..steered(Steering::LinearTangent { axes: Rotation3::from_matrix_unchecked(axes), a: 2.0, b: 0.05 })
        },
        &by_tangent,
        PLAIN,
        Some(3.1),
    );
    // Coefficients that are polynomials of one degree come back from the table as they are, from 0 to 40°.
    let entries = [0.0, 0.1, 0.3, 0.7];
    let lift: Vec<_> = entries.iter().map(|angle| vec![2.0 * angle; 2]).collect();
    let drag: Vec<_> = entries.iter().map(|angle| vec![0.3 + 0.5 * angle; 2]).collect();
    let table = AlphaMachTable::new(&entries, &[0.0, 10.0], &lift, &drag).unwrap();
    let lifting: Coefficients = &|angle, _| [2.0 * angle, 0.3 + 0.5 * angle];
    let aerodynamics = Aerodynamics::AlphaMachTable(Arc::new(table));
    let vehicle = Vehicle { aerodynamics, ..case.vehicle.clone() };
    let pitch = schedule(Against::Time, &by_time.0, &by_time.1);
    let program = inertial_program(axes, pitch, Command::Constant(0.0));
    let by_program = |now: &Inertial| direction(straight(&by_time.0, &by_time.1, now.time), 0.0, columns);
    agree_on_a_climb("lift", &Case { vehicle, ..steered(program) }, &by_program, lifting, None);
}

/// Two stages, two boosters with thrust by time, a fairing and a payload.
fn launcher() -> Case {
    let planet = earth();
    let boost = [(0.0, 0.0), (0.5, 60e3), (20.0, 75e3), (22.0, 0.0)];
    let parts = vec![
        stage(1100.0, 12_000.0, 250e3, 300.0, (250e3 - 215e3) / 101_325.0),
        Part { count: 2, ..motor(90.0, 700.0, &boost, 270.0, 0.08) },
        stage(250.0, 2200.0, 26e3, 340.0, 0.0),
        load(50.0),
        load(150.0),
    ];
    let case = vehicle_of(planet, parts);
    let axes = launch_axes(&planet, &case.initial_state.position, AZIMUTH);
    let second = schedule(Against::Time, &SECOND.0, &SECOND.1);
    let drop = |parts: &[usize]| {
        let separate = vec![Separation { parts: parts.to_vec(), push: None, body: 0 }];
        Effect { separate, ..Effect::default() }
    };
    let throttled = |value: f64| Effect { throttle: vec![Throttle { part: 0, value }], ..Effect::default() };
    let tilt = Some(Tilt { angle: 0.05, azimuth: AZIMUTH });
    let body = |part: Part| reentry::scenario::BodyCase {
        case: Case { parts: vec![part], hold_down: false, ..case.clone() },
        stop_time: Some(1.0),
    };
    let bodies = vec![body(case.parts[1].clone())];
    let events = vec![
        at(0.0, ignite(&[0, 1])),
        lift_off(),
        on(rises(Quantity::Speed, 60.0), Effect { tilt, steer: Some(Steering::Velocity), ..Effect::default() }),
        on(Trigger::AfterBurnout { part: 1, delay: 1.0 }, drop(&[1])),
        at(30.0, throttled(0.7)),
        at(45.0, throttled(1.0)),
        on(Trigger::AfterBurnout { part: 0, delay: 3.0 }, drop(&[0])),
        on(
            Trigger::After { event: 6, delay: 2.0 },
            Effect {
                load_limit: Some(Some(4.0)),
                reference_area: Some(0.8),
                ..steer_and_ignite(inertial_program(axes, second, Command::Constant(0.02)))
            },
        ),
        on(rises(Quantity::Altitude, FAIRING), drop(&[3])),
        on(Trigger::AfterBurnout { part: 2, delay: 0.0 }, Effect::default()),
    ];
    Case { events, bodies, stop: Stop { time: 520.0, ..Stop::default() }, ..case }
}

const AZIMUTH: f64 = 1.2;
/// m.
const FAIRING: f64 = 125e3;
const SECOND: ([f64; 3], [f64; 3]) = ([70.0, 150.0, 380.0], [45.0, 25.0, -12.0]);

fn steer_and_ignite(steering: Steering) -> Effect {
    Effect { ignite: vec![2], ..steer(steering) }
}

/// The instants and the states that the oracle has of the launcher, in the order of its events; at their end that at 520 s.
fn launch_of_oracle(case: &Case) -> Vec<Inertial> {
    let planet = case.planet;
    let boost = |time: f64| 2.0 * straight_newtons(&[0.0, 0.5, 20.0, 22.0], &[0.0, 60e3, 75e3, 0.0], time);
    let [main, throttled, second] = [250e3, 175e3, 26e3].map(|thrust| move |_: f64| thrust);
    let area = (250e3 - 215e3) / 101_325.0;
    let upright = |now: &Inertial| normal(&planet, &now.position);
    let ahead = |now: &Inertial| now.over_ground(&planet).normalize();
    let axes = launch_axes(&planet, &case.initial_state.position, AZIMUTH);
    let columns = [0, 1, 2].map(|column| axes.column(column).into_owned());
    let program = |now: &Inertial| direction(straight(&SECOND.0, &SECOND.1, now.time), 0.02, columns);
    let rocket = |flames, axis, area, load_limit| Rocket {
        planet,
        flames,
        axis,
        area,
        coefficients: PLAIN,
        wind: [0.0; 2],
        load_limit,
    };
    let core = || Flame { thrust: &main, specific_impulse: 300.0, exit_area: area };
    let booster = || Flame { thrust: &boost, specific_impulse: 270.0, exit_area: 0.16 };
    let upper = || Flame { thrust: &second, specific_impulse: 340.0, exit_area: 0.0 };
    // Light enough to rise at once.
    let start = Inertial::of(&case.initial_state, &planet, 0.0, case.vehicle.mass);
    let mut instants = vec![start, start];
    let both = rocket(vec![core(), booster()], &upright, 1.2, None);
    let state = both.until(&start, 0.5, STEP * 0.1);
    let mut state = both.until_zero(&state, &|now| now.over_ground(&planet).norm() - 60.0, STEP);
    instants.push(state);
    let [north, east, up] = local_axes(&state.position);
    let relative = state.over_ground(&planet);
    let towards = north * AZIMUTH.cos() + east * AZIMUTH.sin();
    // Turned in the plane of `up` and `towards`, about what is across.
    let across = nalgebra::Unit::new_normalize(up.cross(&towards));
    let turned = nalgebra::Rotation3::from_axis_angle(&across, 0.05) * relative;
    state.velocity += turned - relative;
    let both = rocket(vec![core(), booster()], &ahead, 1.2, None);
    let state = both.until(&both.until(&state, 20.0, STEP), 22.0, STEP);
    let alone = rocket(vec![core()], &ahead, 1.2, None);
    let mut state = alone.until(&state, 23.0, STEP);
    instants.push(state);
    state.mass -= 2.0 * (90.0 + 700.0) - burnt_by_booster();
    let state = alone.until(&state, 30.0, STEP);
    instants.push(state);
    let less = Flame { thrust: &throttled, specific_impulse: 300.0, exit_area: area };
    let state = rocket(vec![less], &ahead, 1.2, None).until(&state, 45.0, STEP);
    instants.push(state);
    let burnout = 12_000.0 * 300.0 * G0 / 250e3 + 0.3 * 15.0;
    let state = alone.until(&state, burnout, STEP);
    let coast = rocket(vec![], &ahead, 1.2, None);
    let mut state = coast.until(&state, burnout + 3.0, STEP);
    instants.push(state);
    state.mass -= 1100.0;
    let state = coast.until(&state, burnout + 5.0, STEP);
    instants.push(state);
    let limited = rocket(vec![upper()], &program, 0.8, Some(4.0));
    let mut state = limited.until_zero(&state, &|now| now.altitude(&planet) - FAIRING, STEP);
    instants.push(state);
    state.mass -= 50.0;
    let empty = 250.0 + 150.0;
    // To the corner of the schedule first.
    let state = if state.time < 150.0 { limited.until(&state, 150.0, STEP) } else { state };
    let state = limited.until_zero(&state, &|now| empty - now.mass, 0.2 * STEP);
    instants.push(state);
    instants.push(rocket(vec![], &program, 0.8, None).until(&state, 520.0, STEP));
    instants
}

fn straight_newtons(at: &[f64], value: &[f64], x: f64) -> f64 {
    straight(at, value, x).to_degrees()
}

/// The impulse of a booster's profile over its exhaust velocity, of both.
fn burnt_by_booster() -> f64 {
    2.0 * (0.5 * 0.5 * 60e3 + 19.5 * 0.5 * (60e3 + 75e3) + 2.0 * 0.5 * 75e3) / (270.0 * G0)
}

#[test]
fn a_launcher_flies_as_an_integration_in_inertial_space_has_it() {
    let case = launcher();
    let oracle = launch_of_oracle(&case);
    for (tolerance, metres, seconds) in AGREEMENT {
        let flight = fly(&with_tolerance(case.clone(), tolerance));
        let events: Vec<_> = flight.events().collect();
        assert_eq!(events.iter().map(|event| event.event).collect::<Vec<_>>(), (0..10).collect::<Vec<_>>());
        for (event, state) in events.iter().zip(&oracle) {
            let (what, off) = (event.event, miss(&event.before, state, &case.planet));
            assert!((event.before.time - state.time).abs() < seconds, "{what}: {} {}", event.before.time, state.time);
            // Where the instants differ, the places do.
            assert!(off < metres + seconds * event.before.inertial_speed, "{what}: {off} m off at {tolerance}");
            assert!(
                (event.before.mass - state.mass).abs() < 1e-2 * metres,
                "{what}: {} {}",
                event.before.mass,
                state.mass
            );
        }
        let (last, end) = (flight.last(), oracle.last().unwrap());
        let off = miss(&last, end, &case.planet);
        assert!(off < metres, "{off} m off at {tolerance}");
        assert!((last.mass - 400.0).abs() < 1e-9, "{}", last.mass);
        limit_holds(&flight, 4.0);
    }
}

/// The load factor never exceeds a limit, and is on it where the engines are throttled; returns how often they begin to be.
fn limit_holds(flight: &Trajectory, limit: f64) -> usize {
    let times: Vec<_> = (0..5000).map(|step| flight.end_time() * f64::from(step) / 5000.0).collect();
    let (mut begins, mut was) = (0, false);
    for point in flight.points(&times) {
        // The throttle is not known better than the states between steps.
        let throttled = point.thrust > 0.0 && point.throttle < 1.0 - 1e-9 && point.loads.load_factor > limit * 0.999;
        if point.throttle > 0.0 && throttled {
            assert!(
                (point.loads.load_factor - limit).abs() < 1e-9 * limit,
                "{}: {}",
                point.time,
                point.loads.load_factor
            );
        }
        begins += usize::from(throttled && !was);
        was = throttled;
    }
    begins
}

#[test]
fn a_load_limit_is_reached_and_left_and_reached_again() {
    // A single engine by time: its thrust rises above what the limit leaves, falls below it and rises again.
    let profile = [(0.0, 90e3), (15.0, 160e3), (25.0, 60e3), (40.0, 110e3), (45.0, 110e3)];
    let planet = earth();
    let parts = vec![motor(800.0, 3000.0, &profile, 280.0, 0.1), load(500.0)];
    let events: Vec<Event> = vec![at(0.0, Effect { load_limit: Some(Some(2.5)), ..ignite(&[0]) }), lift_off()];
    let stop = Stop { time: 50.0, ..Stop::default() };
    let case = Case { events, stop, ..vehicle_of(planet, parts) };
    let (at, newtons): (Vec<_>, Vec<_>) = profile.into_iter().unzip();
    let thrust = |time: f64| if time < 45.0 { straight_newtons(&at, &newtons, time) } else { 0.0 };
    let upright = |now: &Inertial| normal(&planet, &now.position);
    let rocket = |flames| Rocket {
        planet,
        flames,
        axis: &upright,
        area: 1.2,
        coefficients: PLAIN,
        wind: [0.0; 2],
        load_limit: Some(2.5),
    };
    let lit = rocket(vec![Flame { thrust: &thrust, specific_impulse: 280.0, exit_area: 0.1 }]);
    let start = Inertial::of(&case.initial_state, &planet, 0.0, case.vehicle.mass);
    let end = [15.0, 25.0, 40.0, 45.0].into_iter().fold(start, |state, time| lit.until(&state, time, 0.1 * STEP));
    let end = rocket(vec![]).until(&end, 50.0, STEP);
    for (tolerance, metres, _) in AGREEMENT {
        let flight = fly(&with_tolerance(case.clone(), tolerance));
        assert_eq!(limit_holds(&flight, 2.5), 2);
        let (last, off) = (flight.last(), miss(&flight.last(), &end, &planet));
        assert!(off < metres, "{off} m off at {tolerance}");
        assert!((last.mass - end.mass).abs() < 1e-2 * metres, "{} {}", last.mass, end.mass);
        // What the limit took is left.
        let left = flight.propellant(&last, 0).unwrap();
        assert!((left - (last.mass - 1300.0)).abs() < 1e-9 && left > 100.0, "{left}");
    }
}

#[test]
fn an_upright_rise_under_a_table_by_angle_of_attack_needs_no_plane_of_lift() {
    // At the angle of attack 0, the end of the table, the plane of lift is undefined, and a lift that is 0 there does not need it.
    let entries = [0.0, 0.1, 0.3];
    let lift: Vec<_> = entries.iter().map(|angle| vec![2.0 * angle; 2]).collect();
    let drag: Vec<_> = entries.iter().map(|angle| vec![0.3 + 0.5 * angle; 2]).collect();
    let table = AlphaMachTable::new(&entries, &[0.0, 10.0], &lift, &drag).unwrap();
    for (planet, latitude) in [(earth(), 0.5), (Planet::EARTH_WGS84.spherical(), 0.0), (still(6.4e6, 4e14), 0.3)] {
        let case = vehicle_of(planet, vec![stage(800.0, 2700.0, 60e3, 280.0, 0.1), load(100.0)]);
        let vehicle =
            Vehicle { aerodynamics: Aerodynamics::AlphaMachTable(Arc::new(table.clone())), ..case.vehicle.clone() };
        let turn = Effect { tilt: Some(Tilt { angle: 0.02, azimuth: PI / 2.0 }), ..steer(Steering::Velocity) };
        let local = Steering::Program(Program {
            axes: ProgramAxes::Local,
            pitch: Command::Constant(1.2),
            yaw: Command::Constant(1.5),
        });
        let events = vec![at(0.0, ignite(&[0])), lift_off(), at(20.0, turn), at(40.0, steer(local))];
        let initial_state = pad(&planet, 0.0, latitude);
        let case = Case { vehicle, events, initial_state, stop: Stop { time: 100.0, ..Stop::default() }, ..case };
        let flight = fly(&case);
        assert_eq!(flight.termination(), Termination::TimeLimit);
        assert!(flight.last().is_finite() && flight.statistics().steps < 1000, "{:?}", flight.statistics());
    }
}
