//! Implicit steps: their order, where they are taken, and flights with them beside flights without.

use std::sync::atomic::AtomicBool;

use num_dual::{Dual64, DualSVec64};
use reentry::body::BODIES;
use reentry::integrate::{Integrator, Limits, Statistics, Step, StepBounds, System, follow_implicitly, jacobian};
use reentry::motion::Cartesian;
use reentry::scalar::Scalar;
use reentry::sensitivity::sensitivities;
use reentry::simulate::{arrival, ends_of_all};
use reentry::trajectory::{Arrival, Ends};
use reentry::{Aerodynamics, Atmosphere, Case, Control, FlightPath, PlanetFixed, Scenario, Stop, Vehicle};

use crate::check::{near, relative};
use crate::core::flights::{fly, spherical, target_2, vehicle, with_tolerance};
use crate::core::integrator::Kepler;

static NEVER: AtomicBool = AtomicBool::new(false);

fn limits(relative_tolerance: f64) -> Limits<'static> {
    Limits { relative_tolerance, steps: 1_000_000, interrupt: &NEVER }
}

/// A system whose stiffness is known, and which implicit steps may or may not follow.
trait Known<const N: usize>: System<f64, N> + System<DualSVec64<N>, N> {
    /// The rate of what decays fastest, 1/s.
    fn decay(&self, state: &[f64; N]) -> f64;
}

struct With<F>(F);
struct Without<F>(F);

impl<F: Known<N>, const N: usize> System<f64, N> for With<F> {
    fn derivative(&self, time: f64, state: &[f64; N]) -> [f64; N] {
        self.0.derivative(time, state)
    }
}

impl<F: Known<N>, const N: usize> System<f64, N> for Without<F> {
    fn derivative(&self, time: f64, state: &[f64; N]) -> [f64; N] {
        self.0.derivative(time, state)
    }
}

impl<F: Known<N>, const N: usize> StepBounds<N> for With<F> {
    fn magnitudes(&self) -> [f64; N] {
        [1.0; N]
    }

    fn longest_step(&self, _: f64, state: &[f64; N]) -> f64 {
        3.0 / self.0.decay(state)
    }

    fn longest_implicit_step(&self, _: f64, _: &[f64; N]) -> f64 {
        f64::INFINITY
    }

    fn jacobian(&self, time: f64, state: &[f64; N]) -> [[f64; N]; N] {
        jacobian::<_, N, N>(&self.0, time, state)
    }
}

impl<F: Known<N>, const N: usize> StepBounds<N> for Without<F> {
    fn magnitudes(&self) -> [f64; N] {
        [1.0; N]
    }

    fn longest_step(&self, _: f64, state: &[f64; N]) -> f64 {
        3.0 / self.0.decay(state)
    }
}

/// All steps to an end.
fn steps<F: StepBounds<N>, const N: usize>(
    system: &F,
    start: [f64; N],
    end: f64,
    tolerance: f64,
) -> (Vec<Step<N>>, Statistics) {
    let mut integrator = Integrator::new(system, 0.0, start, limits(tolerance));
    let mut steps = Vec::new();
    while integrator.time() < end {
        steps.push(integrator.advance(system, end).unwrap());
    }
    (steps, integrator.statistics())
}

/// Something that decays to a swing: y' = -k (y - cos t) - sin t. With y = cos t at the start, it stays there.
///
/// # Reference
/// A. Prothero and A. Robinson, Mathematics of Computation 28 (1974), 145.
struct Swing(f64);

impl<S: Scalar> System<S, 1> for Swing {
    fn derivative(&self, time: S, state: &[S; 1]) -> [S; 1] {
        let (sine, cosine) = time.sin_cos();
        [(state[0] - cosine) * -self.0 - sine]
    }
}

impl Known<1> for Swing {
    fn decay(&self, _: &[f64; 1]) -> f64 {
        self.0
    }
}

/// A fall against a linear drag, v' = 10 - k v, by place and speed.
struct Fall(f64);

impl<S: Scalar> System<S, 2> for Fall {
    fn derivative(&self, _: S, state: &[S; 2]) -> [S; 2] {
        [state[1], state[1] * -self.0 + 10.0]
    }
}

impl Known<2> for Fall {
    fn decay(&self, _: &[f64; 2]) -> f64 {
        self.0
    }
}

impl Fall {
    /// From rest at 1: v = (10/k) (1 - e^(-kt)), and its integral.
    fn exact(&self, time: f64) -> [f64; 2] {
        let speed = 10.0 / self.0;
        [1.0 + speed * (time + (-self.0 * time).exp_m1() / self.0), -speed * (-self.0 * time).exp_m1()]
    }
}

/// Van der Pol's oscillator: y'' = ((1 - y²) y' - y)/ε, which creeps and jumps.
struct VanDerPol(f64);

impl<S: Scalar> System<S, 2> for VanDerPol {
    fn derivative(&self, _: S, state: &[S; 2]) -> [S; 2] {
        let [y, rate] = *state;
        [rate, ((-y * y + 1.0) * rate - y) * (1.0 / self.0)]
    }
}

impl Known<2> for VanDerPol {
    fn decay(&self, [y, rate]: &[f64; 2]) -> f64 {
        ((y * y - 1.0).abs() + (2.0 * y * rate + 1.0).abs().sqrt() * self.0.sqrt()) / self.0
    }
}

/// Said to be stiff where it is not.
impl Known<4> for Kepler {
    fn decay(&self, _: &[f64; 4]) -> f64 {
        1e4
    }
}

/// Where the body of [`Kepler`] is, by Kepler's equation.
fn kepler_position(time: f64) -> [f64; 2] {
    let mut anomaly = time;
    for _ in 0..50 {
        anomaly -= (anomaly - 0.5 * anomaly.sin() - time) / (1.0 - 0.5 * anomaly.cos());
    }
    [anomaly.cos() - 0.5, 0.75_f64.sqrt() * anomaly.sin()]
}

/// An implicit step of a given length, whatever its error.
fn implicit_step(length: f64) -> Step<4> {
    let system = With(Kepler);
    let mut integrator = Integrator::new(&system, 0.0, [0.5, 0.0, 0.0, 1.732_050_807_568_877_2], limits(1e-12));
    let step = loop {
        let step = integrator.advance(&system, 100.0).unwrap();
        if step.is_implicit() {
            break step;
        }
    };
    let step = integrator.shorten(&system, &step, step.start_time + length);
    assert!(step.is_implicit());
    step
}

fn off(state: &[f64; 4], time: f64) -> f64 {
    let [x, y] = kepler_position(time);
    (state[0] - x).hypot(state[1] - y)
}

#[test]
fn the_error_of_an_implicit_step_falls_with_the_sixth_power_of_its_length() {
    let error = |length: f64| {
        let step = implicit_step(length);
        off(&step.end, step.end_time)
    };
    let order = (error(0.1) / error(0.05)).log2();
    assert!((5.5..6.5).contains(&order), "order {order}");
}

#[test]
fn the_error_inside_an_implicit_step_falls_with_the_fourth_power_of_its_length_at_least() {
    let worst = |length: f64| {
        let step = implicit_step(length);
        let inside = step.interpolant(&Kepler);
        let parts = (1..20).map(|part| f64::from(part) / 20.0);
        parts.map(|part| off(&inside.state(part), step.time(part))).fold(0.0, f64::max)
    };
    let order = (worst(0.1) / worst(0.05)).log2();
    assert!((3.7..6.5).contains(&order), "order {order}");
}

#[test]
fn the_state_inside_an_implicit_step_meets_both_ends_and_their_slopes() {
    let step = implicit_step(0.1);
    let inside = step.interpolant(&Kepler);
    assert_eq!(step.interpolant_evaluations(), 0);
    for i in 0..4 {
        near("start", inside.state(0.0)[i], step.start[i], 0.0);
        near("end", inside.state(1.0)[i], step.end[i], 1e-15);
        let slope = |part: f64| (inside.state(part + 1e-6)[i] - inside.state(part - 1e-6)[i]) / (2e-6 * 0.1);
        near("slope at the start", slope(0.0), step.start_derivative[i], 1e-7);
        near("slope at the end", slope(1.0), step.end_derivative[i], 1e-7);
    }
}

/// What decays a thousand or a million times as fast as the swing does not disturb steps along it, and costs nothing.
#[test]
fn the_swing_is_followed_however_fast_the_decay() {
    for decay in [1e3, 1e6] {
        let system = With(Swing(decay));
        let mut before = f64::INFINITY;
        for tolerance in [1e-6, 1e-8, 1e-10] {
            let (steps, statistics) = steps(&system, [1.0], 10.0, tolerance);
            let worst = steps.iter().map(|step| (step.end[0] - step.end_time.cos()).abs()).fold(0.0, f64::max);
            assert!(worst < 100.0 * tolerance && worst < before, "{worst:e} at {tolerance:e} of {decay:e}");
            assert!(statistics.evaluations < 20_000, "{statistics:?} at {tolerance:e} of {decay:e}");
            before = worst.max(1e-12);
        }
    }
}

#[test]
fn a_fall_against_linear_drag_ends_where_it_must_at_a_tenth_of_the_cost() {
    let fall = Fall(50.0);
    for tolerance in [1e-6, 1e-9, 1e-12] {
        let (with, costs) = steps(&With(Fall(50.0)), [1.0, 0.0], 100.0, tolerance);
        let (without, explicit_costs) = steps(&Without(Fall(50.0)), [1.0, 0.0], 100.0, tolerance);
        for (steps, is_any_implicit) in [(&with, true), (&without, false)] {
            assert_eq!(steps.iter().any(Step::is_implicit), is_any_implicit);
            let end = steps.last().unwrap().end;
            for (found, exact) in end.iter().zip(fall.exact(100.0)) {
                near("the end", *found, exact, 100.0 * tolerance);
            }
        }
        assert!(costs.evaluations * 10 < explicit_costs.evaluations, "{costs:?} of {explicit_costs:?}");
    }
}

/// ε = 1e-6 from (2, 0) to t = 2: once around, with two jumps, at which explicit steps take over.
///
/// # Reference
/// The end is that of Hairer and Wanner's problem VDPOL, in Mazzia and Magherini, Test Set for Initial Value Problem Solvers, 2008.
#[test]
fn van_der_pols_oscillator_creeps_implicitly_and_jumps() {
    let start = [2.0, 0.0];
    let (steps, statistics) = steps(&With(VanDerPol(1e-6)), start, 2.0, 1e-9);
    let end = steps.last().unwrap().end;
    relative("y", end[0], 1.706_167_732_170_483, 1e-6);
    relative("y'", end[1], -0.892_809_701_024_797_5, 1e-6);
    let changes = steps.windows(2).filter(|pair| pair[0].is_implicit() != pair[1].is_implicit()).count();
    assert!(changes >= 3, "{changes}");
    assert!(statistics.steps < 20_000, "{statistics:?}");
}

#[test]
fn evaluations_of_implicit_steps_are_counted() {
    use std::cell::Cell;
    struct Counting(Swing, Cell<usize>);
    impl System<f64, 1> for Counting {
        fn derivative(&self, time: f64, state: &[f64; 1]) -> [f64; 1] {
            self.1.set(self.1.get() + 1);
            self.0.derivative(time, state)
        }
    }
    impl StepBounds<1> for Counting {
        fn magnitudes(&self) -> [f64; 1] {
            [1.0]
        }

        fn longest_step(&self, _: f64, _: &[f64; 1]) -> f64 {
            3.0 / self.0.0
        }

        fn longest_implicit_step(&self, _: f64, _: &[f64; 1]) -> f64 {
            f64::INFINITY
        }

        fn jacobian(&self, _: f64, _: &[f64; 1]) -> [[f64; 1]; 1] {
            // One, and one for its column.
            self.1.set(self.1.get() + 2);
            [[-self.0.0]]
        }
    }
    let system = Counting(Swing(1e3), Cell::new(0));
    let mut integrator = Integrator::new(&system, 0.0, [1.0], limits(1e-8));
    let mut implicit = 0;
    while integrator.time() < 10.0 {
        let step = integrator.advance(&system, 10.0).unwrap();
        if step.is_implicit() {
            implicit += 1;
            integrator.shorten(&system, &step, step.time(0.5));
        }
    }
    assert!(implicit > 3, "{implicit}");
    assert_eq!(integrator.statistics().evaluations, system.1.get());
}

#[test]
fn implicit_steps_are_followed_with_the_right_slopes() {
    let along = steps(&With(Swing(1e3)), [1.1], 5.0, 1e-6).0;
    assert!(along.iter().any(Step::is_implicit));
    let system = With(Swing(1e3));
    for step in along.iter().filter(|step| step.is_implicit()) {
        let follow = |state: Dual64| {
            let jacobian = |time, state: &[f64; 1]| system.jacobian(time, state);
            follow_implicitly(&Swing(1e3), jacobian, &[state], step.start_time, step.length())[0]
        };
        let followed = follow(Dual64::new(step.start[0], 1.0));
        near("the end", followed.re, step.end[0], 1e-12);
        // The method is of a linear equation a rational function: R(z) = (1 + 2z/5 + z²/20)/(1 - 3z/5 + 3z²/20 - z³/60) of Hairer and Wanner,
        // table IV.5.7.
        let z = -1e3 * step.length();
        let slope = (1.0 + z * (0.4 + z / 20.0)) / (1.0 - z * (0.6 - z * (0.15 - z / 60.0)));
        near("the slope", followed.eps, slope, 1e-12);
    }
}

/// A capsule under its parachute, from 6 km in standard air.
fn parachute() -> Case {
    let start = FlightPath {
        radius: 6_384_137.0,
        longitude: 0.3,
        geocentric_latitude: 0.4,
        speed: 40.0,
        flight_path_angle: -1.2,
        heading: 0.4,
    };
    Case {
        atmosphere: Atmosphere::Us76,
        vehicle: vehicle(2700.0, 1000.0, 0.0, 0.8),
        control: Control::banked(0.0),
        initial_state: start.to_planet_fixed(),
        ..target_2()
    }
}

/// A capsule that falls from orbital speed to the ground of Venus, with some lift.
fn venus() -> Case {
    let body = BODIES.iter().find(|body| body.name == "venus").unwrap();
    let start = FlightPath {
        radius: 6_251_800.0,
        longitude: 0.0,
        geocentric_latitude: 0.2,
        speed: 11_540.0,
        flight_path_angle: -0.565,
        heading: 0.0,
    };
    let aerodynamics = Aerodynamics::Ballistic { ballistic_coefficient: 188.0, lift_to_drag: 0.18 };
    Case {
        planet: body.planet(),
        atmosphere: body.atmosphere(),
        control: Control::banked(0.0),
        vehicle: Vehicle { aerodynamics, ..vehicle(316.0, 1.0, 0.0, 0.0) },
        initial_state: start.to_planet_fixed(),
        ..target_2()
    }
}

/// A capsule back from the Moon whose lift turns it down to the vertical, where it fades: the flight is held there, against the rotation of the
/// planet, the more firmly the narrower the cone is.
fn dive() -> Case {
    let start = FlightPath {
        radius: 6_500_137.0,
        longitude: 0.0,
        geocentric_latitude: 0.1,
        speed: 10_600.0,
        flight_path_angle: -0.13,
        heading: 0.5,
    };
    Case {
        atmosphere: Atmosphere::Us76,
        vehicle: vehicle(5500.0, 12.0, 0.39, 1.3),
        control: Control::banked(std::f64::consts::PI),
        initial_state: start.to_planet_fixed(),
        ..target_2()
    }
}

fn end(case: &Case) -> Arrival {
    arrival(&Scenario::new(case.clone()).unwrap(), &NEVER).unwrap()
}

/// The motion of a case, of which no step is implicit.
struct Explicit(Cartesian);

impl System<f64, 6> for Explicit {
    fn derivative(&self, time: f64, state: &[f64; 6]) -> [f64; 6] {
        self.0.derivative(time, state)
    }
}

impl StepBounds<6> for Explicit {
    fn magnitudes(&self) -> [f64; 6] {
        self.0.magnitudes()
    }

    fn longest_step(&self, time: f64, state: &[f64; 6]) -> f64 {
        self.0.longest_step(time, state)
    }
}

/// The fall of a capsule under its parachute, with and without implicit steps, at a tolerance at which neither shows an error.
#[test]
fn slow_falls_end_where_explicit_steps_end() {
    let case = Case { stop: Stop { time: 600.0, ..Stop::default() }, ..parachute() };
    let (steps, costs) = steps(&Explicit(Cartesian(case.forces())), case.initial_state.into(), 600.0, 1e-13);
    let explicit = PlanetFixed::from(steps.last().unwrap().end);
    for case in [case.clone(), spherical(case)] {
        for (tolerance, within) in [(1e-13, 1e-6), (1e-10, 1e-3), (1e-8, 0.1)] {
            let end = end(&with_tolerance(case.clone(), tolerance));
            let miss = (end.state.position - explicit.position).norm();
            assert!(miss < within, "{miss:e} m at {tolerance:e}");
            let is_cheap = end.statistics.evaluations * 5 < costs.evaluations;
            assert!(is_cheap || tolerance < 1e-12, "{:?} of {costs:?}", end.statistics);
        }
    }
}

/// Near the vertical, steps are as long as lift that fades lets explicit ones be, and implicit where the tolerance lets those be longer. Rejected
/// ones, in place of that, doubled the evaluations.
#[test]
fn lift_that_fades_near_the_vertical_makes_few_steps_fail() {
    let exact = end(&with_tolerance(dive(), 1e-13));
    for (tolerance, within, most) in [(1e-10, 1e-2, 2000), (1e-6, 20.0, 900)] {
        let case = with_tolerance(dive(), tolerance);
        let flown = end(&case);
        let miss = (flown.state.position - exact.state.position).norm();
        assert!(miss < within, "{miss:e} m at {tolerance:e}");
        let Statistics { steps, rejected_steps, evaluations } = flown.statistics;
        assert!(evaluations < most && rejected_steps * 3 < steps, "{:?} at {tolerance:e}", flown.statistics);
        assert!(fly(&case).last().flight_path.flight_path_angle < -1.57, "the flight has not come to the vertical");
    }
}

/// In the air of a table, the slope of whose slope jumps at every entry.
#[test]
fn a_fall_to_the_ground_of_venus_is_as_exact_and_takes_few_evaluations() {
    let reference = end(&with_tolerance(venus(), 1e-13));
    let flown = end(&venus());
    near("the time", flown.time, reference.time, 1e-4);
    let miss = (flown.state.position - reference.state.position).norm();
    assert!(miss < 1e-3, "{miss:e} m");
    // Explicit steps took 24 000.
    assert!(flown.statistics.evaluations < 4800, "{:?}", flown.statistics);
}

/// Points inside the steps, beside the same points of a flight whose steps are short.
#[test]
fn rows_of_slow_falls_are_as_exact_as_their_ends() {
    for case in [parachute(), venus()] {
        let exact = fly(&with_tolerance(case.clone(), 1e-13));
        let flight = fly(&case);
        let mut time = 0.0;
        while time < flight.end_time().min(exact.end_time()) {
            let [here, there] = [&flight, &exact].map(|flight| flight.points(&[time])[0].flight_path.to_planet_fixed());
            let miss = (here.position - there.position).norm();
            assert!(miss < 0.05, "{miss:e} m at {time} s");
            time += 0.91;
        }
    }
}

/// A flight that turns stiff leaves its lane, and comes to the same digits.
#[test]
fn stiff_flights_in_lanes_end_at_the_digits_of_flights_alone() {
    let light = |mass: f64| Case { vehicle: vehicle(mass, 20.0, 0.0, 1.2), ..target_2() };
    let cases = [1.0, 2.0, 5.0, 700.0, 20.0, 3.0, 800.0].map(light);
    let scenarios = cases.map(|case| Scenario::new(case).unwrap());
    for (scenario, in_lanes) in scenarios.iter().zip(ends_of_all(&scenarios, &NEVER)) {
        let alone = arrival(scenario, &NEVER);
        assert_eq!(format!("{:?}", in_lanes.as_ref().map(Ends::arrival)), format!("{:?}", alone.as_ref()));
    }
    assert!(fly(scenarios[0].case()).end_time() > 600.0);
}

/// The slopes of the arrival under a parachute by the mass and by the initial speed and latitude, beside differences of flights.
#[test]
fn sensitivities_go_through_implicit_steps() {
    for case in [parachute(), spherical(parachute())] {
        let slopes = sensitivities(&fly(&case), &NEVER).unwrap();
        let moved = |change: &dyn Fn(&mut Case, f64), step: f64| {
            let at = |offset: f64| {
                let mut case = with_tolerance(case.clone(), 1e-13);
                change(&mut case, offset);
                let end = end(&case);
                let path = FlightPath::from_planet_fixed(&end.state);
                [end.time, path.longitude, path.geocentric_latitude, path.speed]
            };
            let (above, below) = (at(step), at(-step));
            [0, 1, 2, 3].map(|i| (above[i] - below[i]) / (2.0 * step))
        };
        let by_mass = moved(&|case, offset| case.vehicle.mass += offset, 1.0);
        relative("time by mass", slopes.time.mass, by_mass[0], 1e-5);
        relative("speed by mass", slopes.speed.mass, by_mass[3], 1e-5);
        let by_radius = moved(
            &|case, offset| {
                let mut path = FlightPath::from_planet_fixed(&case.initial_state);
                path.radius += offset;
                case.initial_state = path.to_planet_fixed();
            },
            1.0,
        );
        relative("time by radius", slopes.time.initial_state.radius, by_radius[0], 1e-5);
        let by_longitude = moved(
            &|case, offset| {
                let mut path = FlightPath::from_planet_fixed(&case.initial_state);
                path.longitude += offset;
                case.initial_state = path.to_planet_fixed();
            },
            1e-4,
        );
        relative("longitude by longitude", slopes.longitude.initial_state.longitude, by_longitude[1], 1e-5);
    }
}
