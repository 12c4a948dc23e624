//! `cargo bench --bench flights`: what a flight costs, in counts and in time, beside the DOP853 of `ode_solvers` with the same
//! derivative; what the models cost that the thesis does not have, and how many steps their changes of formula reject; what heating and
//! events cost; what sensitivities and verification cost in plain flights; and what lanes and a second thread save.
//!
//! Machines are noisy: in every comparison the contenders take turns, and a time is the median of many rounds. Counts are exact.

#![allow(clippy::disallowed_methods, reason = "what is compared may be by the system's library")]
#![allow(clippy::unwrap_used, reason = "a benchmark that cannot go on has failed")]

use std::hint::black_box;
use std::sync::atomic::AtomicBool;

use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, SVector};
use reentry::atmosphere::us76;
use reentry::integrate::{Integrator, Limits, Statistics, StepBounds, System, lane_instructions};
use reentry::motion::Cartesian;
use reentry::sensitivity::sensitivities;
use reentry::simulate::{arrival, ends_of_all, extremes, extremes_of_all, simulate_with_bodies};
use reentry::trajectory::Sampling;
use reentry::verification::verify;
use reentry::{Case, PlanetFixed, Scenario, Solver, Stop, simulate};
use reentry_service::answer::{self, Answer};
use reentry_service::format::Format;
use reentry_service::wire::json;
use reentry_service::wire::scenario::{FlightRequest, RequestedOutput};
use reentry_tests::cases::thesis_cases;
use reentry_tests::timing::{medians, timed};
use serde_json::{Value, json};

const CASES: [&str; 4] = ["target_1", "target_2", "impulse", "shallow_glide"];
const ROUNDS: usize = 1000;
static NEVER: AtomicBool = AtomicBool::new(false);

fn main() {
    flights();
    beside_ode_solvers();
    right_hand_sides();
    changes_of_formula();
    layers();
    upper_air();
    heating_and_events();
    ascents();
    number_types();
    lanes();
    searches();
}

/// One flight at the default tolerance.
fn flights() {
    println!("| flight | right-hand sides | steps | rejected | integration and events | with peaks |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for name in CASES {
        let scenario = scenario(name);
        let statistics = arrival(&scenario, &NEVER).unwrap().statistics;
        let [plain, peaks] = micros([
            &mut timed(|| arrival(black_box(&scenario), &NEVER)),
            &mut timed(|| simulate(black_box(&scenario), &NEVER)),
        ]);
        let (evaluations, steps, rejected) = (statistics.evaluations, statistics.steps, statistics.rejected_steps);
        println!("| {name} | {evaluations} | {steps} | {rejected} | {plain:.1} µs | {peaks:.1} µs |");
    }
}

/// To the time of the impact, there at equal accuracy: our time over theirs, which is interpolated to our error.
fn beside_ode_solvers() {
    println!(
        "\n| flight | tolerance | error | right-hand sides | time | `ode_solvers` error | right-hand sides | time | at equal accuracy |"
    );
    println!("| --- | --- | --- | --- | --- | --- | --- | --- | --- |");
    for name in CASES {
        let case = scenario(name).case().clone();
        let with_tolerance =
            |relative_tolerance: f64| Case { solver: Solver { relative_tolerance, ..case.solver }, ..case.clone() };
        let exact = arrival(&Scenario::new(with_tolerance(1e-14)).unwrap(), &NEVER).unwrap();
        let miss = |position: [f64; 3]| {
            position.iter().zip(exact.state.position.iter()).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        let tolerances = [1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12];
        // The ground is out of the way, so that both fly to the same time; its crossing is looked for all the same.
        let to_the_time = |tolerance| Case {
            stop: Stop { altitude: -1e5, time: exact.time, ..Stop::default() },
            ..with_tolerance(tolerance)
        };
        let ours = tolerances.map(|tolerance| Scenario::new(to_the_time(tolerance)).unwrap());
        let peer_at = |tolerance: f64| peer(&case, exact.time, tolerance);
        let theirs = tolerances.map(|tolerance| move || peer_at(tolerance));
        let times: Vec<_> = ours
            .iter()
            .zip(&theirs)
            .map(|(ours, theirs)| micros([&mut timed(|| arrival(ours, &NEVER)), &mut timed(theirs)]))
            .collect();
        let peers = theirs.each_ref().map(|theirs| theirs());
        for index in 1..tolerances.len() {
            let arrival = arrival(&ours[index], &NEVER).unwrap();
            let error = miss(arrival.state.position.into());
            let [time, their_time] = times[index];
            let (position, evaluations) = peers[index];
            // Time goes with a small power of the error: a straight line between the logarithms of two of theirs.
            let point = |index: usize| (miss(peers[index].0).ln(), times[index][1].ln());
            let ((x0, y0), (x1, y1)) = (point(index - 1), point(index));
            let at_our_error = (y0 + (y1 - y0) * (error.ln() - x0) / (x1 - x0)).exp();
            println!(
                "| {name} | {:e} | {error:.1e} m | {} | {time:.1} µs | {:.1e} m | {evaluations} | {their_time:.1} µs | {:.2} |",
                tolerances[index],
                arrival.statistics.evaluations,
                miss(position),
                time / at_our_error,
            );
        }
    }
}

/// One right-hand side, on a glide between 52 and 70 km: that of the thesis, and with one model more in every line.
fn right_hand_sides() {
    let models: Vec<(&str, Case)> = models().into_iter().collect();
    let times: Vec<f64> = models
        .iter()
        .map(|(_, case)| {
            let flight = simulate(&Scenario::new(case.clone()).unwrap(), &NEVER).unwrap();
            let points = flight.points(&flight.instants(&Sampling::Interval(0.1), 100_000).unwrap());
            // Where no formula changes: one mode holds for all of them.
            let inside = points.into_iter().filter(|point| (52e3..70e3).contains(&point.loads.altitude));
            let states: Vec<(f64, [f64; 6])> =
                inside.map(|point| (point.time, point.flight_path.to_planet_fixed().into())).collect();
            let (_, state) = states[states.len() / 2];
            let motion = Cartesian(Case { initial_state: state.into(), ..case.clone() }.forces());
            let [alone] = medians(
                ROUNDS,
                [&mut timed(|| {
                    // Each waits for the one before, as the stages of a step do.
                    states.iter().fold(0.0, |before, (time, state)| {
                        let state: [f64; 6] = std::array::from_fn(|i| state[i] + before);
                        motion.derivative(*time, &state)[5] * 1e-30
                    })
                })],
            );
            #[expect(clippy::cast_precision_loss, reason = "some thousand states")]
            let each = alone * 1e9 / states.len() as f64;
            each
        })
        .collect();
    println!("\n| right-hand side | time | over the thesis's |");
    println!("| --- | --- | --- |");
    for ((name, _), time) in models.iter().zip(&times) {
        println!("| {name} | {time:.0} ns | {:.2} |", time / times[0]);
    }
}

/// Steps taken and rejected on the same glide, with every model and at every tolerance.
fn changes_of_formula() {
    println!("\n| flight | tolerance | right-hand sides | steps | rejected | off by | integration and events |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for (name, case) in models() {
        let with = |relative_tolerance: f64| {
            Scenario::new(Case { solver: Solver { relative_tolerance, ..case.solver }, ..case.clone() }).unwrap()
        };
        let exact = arrival(&with(1e-14), &NEVER).unwrap();
        for tolerance in [1e-8, 1e-10, 1e-12] {
            let scenario = with(tolerance);
            let end = arrival(&scenario, &NEVER).unwrap();
            let [time] = micros([&mut timed(|| arrival(&scenario, &NEVER))]);
            let Statistics { steps, rejected_steps, evaluations } = end.statistics;
            let miss = (end.state.position - exact.state.position).norm();
            println!(
                "| {name} | {tolerance:e} | {evaluations} | {steps} | {rejected_steps} | {miss:.1e} m | {time:.1} µs |"
            );
        }
    }
}

/// The same fall through the standard atmosphere with its layers met, and stepped over as if there were none.
fn layers() {
    let request = json!({
        "planet": {"shape": "sphere"},
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 9500, "reference_area": 19.8, "aerodynamics": {"type": "constant", "drag_coefficient": 1.3}},
        "initial_state": {"type": "planet_relative", "altitude": 120_000, "longitude": 0, "geocentric_latitude": 0.5,
            "speed": 7500, "flight_path_angle": -0.026, "heading": 0.7},
    });
    let case = job(&request).scenario.case().clone();
    let exact = Case { solver: Solver { relative_tolerance: 1e-14, ..case.solver }, ..case.clone() };
    println!("\n| layers of us76 | tolerance | right-hand sides | steps | rejected | off by |");
    println!("| --- | --- | --- | --- | --- | --- |");
    for tolerance in [1e-8, 1e-10, 1e-12] {
        let solver = Solver { relative_tolerance: tolerance, ..case.solver };
        let met = arrival(&Scenario::new(Case { solver, ..case.clone() }).unwrap(), &NEVER).unwrap();
        let over = Over(case.clone());
        let limits = Limits { relative_tolerance: tolerance, steps: 100_000, interrupt: &NEVER };
        let mut integrator = Integrator::new(&over, 0.0, case.initial_state.into(), limits);
        while integrator.time() < met.time {
            integrator.advance(&over, met.time).unwrap();
        }
        let exact = arrival(&Scenario::new(exact.clone()).unwrap(), &NEVER).unwrap();
        let delay = integrator.time() - exact.time;
        let over = PlanetFixed::from(*integrator.state());
        for (what, state, Statistics { steps, rejected_steps, evaluations }) in
            [("met", met.state, met.statistics), ("stepped over", over, integrator.statistics())]
        {
            let miss = (state.position - exact.state.position - exact.state.velocity * delay).norm();
            println!("| {what} | {tolerance:e} | {evaluations} | {steps} | {rejected_steps} | {miss:.1e} m |");
        }
    }
}

/// Flights in NRLMSISE-00, beside the same in the standard atmosphere.
fn upper_air() {
    println!("\n| flight | air | right-hand sides | steps | rejected | off by | integration and events |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let from = |altitude: f64, speed: f64, angle: f64, [area, lift, drag]: [f64; 3]| {
        json!({
            "epoch": "2026-11-29T12:00:00Z",
            "vehicle": {"mass": 2000, "reference_area": area,
                "aerodynamics": {"type": "constant", "lift_coefficient": lift, "drag_coefficient": drag}},
            "initial_state": {"type": "planet_relative", "altitude": altitude, "longitude": 0.3, "geocentric_latitude": 0.5,
                "speed": speed, "flight_path_angle": angle, "heading": 0.7},
        })
    };
    for (name, request) in [
        ("a lifting capsule", from(120e3, 7500.0, -0.026, [4.5, 0.35, 1.25])),
        ("a ballistic one", from(120e3, 7500.0, -0.052, [4.5, 0.0, 1.25])),
        ("a sample return", from(125e3, 11_900.0, -0.14, [30.0, 0.0, 1.2])),
        ("debris", from(120e3, 7600.0, -0.009, [10.0, 0.0, 1.0])),
        ("a stage", from(200e3, 7550.0, -0.012, [10.0, 0.0, 1.0])),
    ] {
        let [standard, model] = ["us76", "nrlmsise00"].map(|air| {
            let mut request = request.clone();
            request["atmosphere"] = json!({"type": air});
            job(&request).scenario
        });
        let times = micros([
            &mut timed(|| arrival(black_box(&standard), &NEVER)),
            &mut timed(|| arrival(black_box(&model), &NEVER)),
        ]);
        for ((air, scenario), time) in [("us76", &standard), ("nrlmsise00", &model)].into_iter().zip(times) {
            let arrival = |relative_tolerance: f64| {
                let case = scenario.case().clone();
                let case = Case { solver: Solver { relative_tolerance, ..case.solver }, ..case };
                reentry::simulate::arrival(&Scenario::new(case).unwrap(), &NEVER).unwrap()
            };
            let [flown, fine] = [1e-10, 1e-13].map(arrival);
            let miss = (flown.state.position - fine.state.position).norm();
            let Statistics { steps, rejected_steps, evaluations } = flown.statistics;
            println!("| {name} | {air} | {evaluations} | {steps} | {rejected_steps} | {miss:.1e} m | {time:.0} µs |");
        }
    }
}

/// A fall over a sphere without lift, whose density is looked up anew in every evaluation.
struct Over(Case);

impl System<f64, 6> for Over {
    fn derivative(&self, _: f64, coordinates: &[f64; 6]) -> [f64; 6] {
        let PlanetFixed { position, velocity } = PlanetFixed::from(*coordinates);
        let Case { planet, vehicle, .. } = &self.0;
        let radius = position.norm();
        let density = us76::density(radius - planet.equatorial_radius());
        let drag = 0.5 * density * velocity.norm() * vehicle.reference_area * 1.3 / vehicle.mass;
        let omega = nalgebra::Vector3::z() * planet.rotation_rate;
        let acceleration = position * (-planet.gravitational_parameter / radius.powi(3))
            - velocity * drag
            - omega.cross(&velocity) * 2.0
            - omega.cross(&omega.cross(&position));
        PlanetFixed { position: velocity, velocity: acceleration }.into()
    }
}

impl StepBounds<6> for Over {
    fn magnitudes(&self) -> [f64; 6] {
        Cartesian(self.0.forces()).magnitudes()
    }
}

/// The glide of a lifting capsule from 120 km: with the thesis's models, and then with one more each.
fn models() -> Vec<(&'static str, Case)> {
    let of_thesis = json!({
        "vehicle": {"mass": 9500, "reference_area": 19.8,
            "aerodynamics": {"type": "constant", "lift_coefficient": 0.35, "drag_coefficient": 1.3}},
        "control": {"bank_angle": 0.8},
        "initial_state": {"type": "planet_relative", "altitude": 120_000, "longitude": 0, "geocentric_latitude": 0.5,
            "speed": 7500, "flight_path_angle": -0.026, "heading": 0.7},
    });
    let alpha = [-0.2, 0.0, 0.2, 0.4, 0.6];
    let mach = [0.4, 0.8, 1.2, 2.0, 4.0, 8.0, 16.0, 35.0];
    let matrix = |of: fn(f64, f64) -> f64| alpha.map(|alpha| mach.map(|mach| of(alpha, mach)));
    let tables = json!({"type": "alpha_mach_table", "angle_of_attack": alpha, "mach": mach,
        "lift_coefficient": matrix(|alpha, mach| alpha.sin() * (1.0 + 0.2 / mach)),
        "drag_coefficient": matrix(|alpha, mach| 1.1 + alpha * alpha + 0.4 / (1.0 + (mach - 1.2) * (mach - 1.2)))});
    let bank = json!({"type": "schedule", "against": "mach", "at": [1, 5, 10, 15, 20, 24],
        "value": [0, 0.4, -0.9, 0.9, 1.1, 0.8]});
    let angle_of_attack = json!({"type": "schedule", "against": "altitude", "at": [10e3, 30e3, 50e3, 90e3],
        "value": [0.1, 0.2, 0.35, 0.3]});
    let mut request = of_thesis;
    let mut cases = Vec::new();
    for (name, pointer, value) in [
        ("the thesis's models", "", json!(null)),
        ("and us76", "/atmosphere", json!({"type": "us76"})),
        ("and zonal gravity to J4", "/planet", json!({"gravity": {"type": "zonal", "degree": 4}})),
        ("and an alpha_mach_table", "/vehicle/aerodynamics", tables),
        ("and two schedules", "/control", json!({"bank_angle": bank, "angle_of_attack": angle_of_attack})),
        (
            "and a table of wind",
            "/wind",
            json!({"type": "table", "altitude": [0, 12e3, 20e3, 60e3], "east": [5, 40, 10, 20], "north": [0, -10, 5, 0]}),
        ),
    ] {
        if let Some((parent, field)) = pointer.rsplit_once('/') {
            request.pointer_mut(parent).unwrap()[field] = value;
        }
        cases.push((name, job(&request).scenario.case().clone()));
    }
    cases
}

/// What heating costs, and a dozen events, those that wait all the way and those that happen, in flights without them.
fn heating_and_events() {
    println!("\n| flight | with | right-hand sides | steps | rejected | time | over the flight without |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let lift = json!({"type": "constant", "lift_coefficient": 0.4, "drag_coefficient": 1.25});
    let lunar_return = json!({
        "atmosphere": {"type": "us76"},
        "vehicle": {"mass": 5500, "reference_area": 12, "aerodynamics": lift},
        "initial_state": {"type": "planet_relative", "altitude": 121_920, "longitude": 0, "geocentric_latitude": -0.4,
            "speed": 10_600, "flight_path_angle": -0.117, "heading": 0.35},
        "control": {"bank_angle": 1.05},
    });
    for (name, request) in
        [("TARGET reference case 2", thesis_request("target_2")), ("a capsule from the Moon", lunar_return)]
    {
        let with = |heating: [&str; 2], events: &[Value]| {
            let mut request = request.clone();
            request["vehicle"]["nose_radius"] = json!(1.0);
            if !heating[0].is_empty() {
                request["heating"] = json!({"convective": heating[0], "radiative": heating[1]});
            }
            request["events"] = json!(events);
            job(&request).scenario
        };
        let [waiting, happening] = [waiting_events(), happening_events()];
        let [none, sutton, both] = [["", ""], ["sutton_graves", "none"], ["sutton_graves", "tauber_sutton"]];
        let variants = [
            ("nothing", with(none, &[])),
            ("`sutton_graves`", with(sutton, &[])),
            ("`detra_kemp_riddell`", with(["detra_kemp_riddell", "none"], &[])),
            ("`sutton_graves`, `tauber_sutton`", with(both, &[])),
            ("twelve events that wait", with(none, &waiting)),
            ("`sutton_graves`, twelve events that wait", with(sutton, &waiting)),
            ("`sutton_graves`, `tauber_sutton`, twelve events that wait", with(both, &waiting)),
            ("twelve events that happen", with(none, &happening)),
        ];
        let mut flights = variants.each_ref().map(|(_, scenario)| timed(|| simulate(black_box(scenario), &NEVER)));
        let times = micros(flights.each_mut().map(|flight| flight as &mut dyn FnMut()));
        for ((what, scenario), time) in variants.iter().zip(times) {
            let statistics = simulate(scenario, &NEVER).unwrap().statistics();
            let (evaluations, steps, rejected) = (statistics.evaluations, statistics.steps, statistics.rejected_steps);
            let ratio = time / times[0];
            println!("| {name} | {what} | {evaluations} | {steps} | {rejected} | {time:.1} µs | {ratio:.2} |");
        }
    }
}

/// Launches with all that leaves the vehicle, and the same without the bodies.
fn ascents() {
    println!("\n| flight | bodies | right-hand sides | steps | rejected | time | without the bodies |");
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    let launches = [
        ("launcher", include_str!("../../openapi/examples/launcher.json")),
        ("sounding rocket", include_str!("../../openapi/examples/sounding_rocket.json")),
        ("abort", include_str!("../../openapi/examples/abort.json")),
    ];
    for (name, request) in launches {
        let scenario = job(&json::parse(request.as_bytes()).unwrap()).scenario;
        let flights = simulate_with_bodies(&scenario, &NEVER).unwrap();
        let of_bodies = flights.bodies.iter().map(|body| body.trajectory.statistics());
        let all: Vec<_> = of_bodies.chain([flights.vehicle.statistics()]).collect();
        let sum = |of: fn(&Statistics) -> usize| all.iter().map(of).sum::<usize>();
        let (evaluations, steps) = (sum(|statistics| statistics.evaluations), sum(|statistics| statistics.steps));
        let rejected = sum(|statistics| statistics.rejected_steps);
        let [with, without] = micros([
            &mut timed(|| simulate_with_bodies(black_box(&scenario), &NEVER)),
            &mut timed(|| simulate(black_box(&scenario), &NEVER)),
        ]);
        let bodies = flights.bodies.len();
        println!("| {name} | {bodies} | {evaluations} | {steps} | {rejected} | {with:.1} µs | {without:.1} µs |");
    }
}

/// Twelve events over six quantities, none of which happens on the way from the atmosphere to the ground.
fn waiting_events() -> Vec<Value> {
    [
        ("altitude", 4e5, -1e3),
        ("speed", 2e4, 1.0),
        ("dynamic_pressure", 1e8, 0.0),
        ("load_factor", 1e4, 0.0),
        ("flight_path_angle", 1.5, -1.57),
    ]
    .into_iter()
    .flat_map(|(quantity, above, below)| {
        [event(quantity, "rises_through", above), event(quantity, "falls_through", below)]
    })
    .chain([event("time", "rises_through", 9000.0), event("time", "rises_through", 9999.0)])
    .collect()
}

/// Twelve events on the way down.
fn happening_events() -> Vec<Value> {
    (1..=12).map(|place| event("altitude", "falls_through", 9e3 * f64::from(place))).collect()
}

fn event(quantity: &str, way: &str, value: f64) -> Value {
    json!({"when": {"quantity": quantity, (way): value}})
}

/// TARGET reference case 2: derivatives and verification in plain flights.
fn number_types() {
    let scenario = scenario("target_2");
    let flight = simulate(&scenario, &NEVER).unwrap();
    let [plain, derivatives, verification] = micros([
        &mut timed(|| simulate(&scenario, &NEVER)),
        &mut timed(|| sensitivities(&flight, &NEVER)),
        &mut timed(|| verify(&scenario, &flight, &NEVER)),
    ]);
    println!("\n| TARGET reference case 2 | time | over a plain flight |");
    println!("| --- | --- | --- |");
    let line = |what: &str, time: f64| println!("| {what} | {time:.1} µs | {:.2} |", time / plain);
    line("a flight with its peaks", plain);
    line("its sensitivities, 5 by 12", derivatives);
    line("its verification", verification);
}

/// Flights that differ in speed, mass and density alone: one by one and in lanes, their ends, and their peaks as well; then in two threads.
fn lanes() {
    let with_tolerance = |case: Case, relative_tolerance: f64| {
        let solver = Solver { relative_tolerance, ..case.solver };
        Case { solver, ..case }
    };
    let target_2 = scenario("target_2").case().clone();
    let heated = json!({
        "atmosphere": {"type": "us76"}, "heating": {"convective": "sutton_graves"},
        "vehicle": {"mass": 5500, "reference_area": 12, "nose_radius": 4.7,
            "aerodynamics": {"type": "constant", "lift_coefficient": 0.4, "drag_coefficient": 1.4}},
        "initial_state": {"type": "geodetic", "geodetic_altitude": 120e3, "longitude": 0.9, "geodetic_latitude": 0.66,
            "speed": 7600, "flight_path_angle": -0.028, "azimuth": 1.05},
        "events": [event("altitude", "falls_through", 100e3), event("altitude", "falls_through", 50e3),
            event("speed", "falls_through", 3000.0), event("mach", "falls_through", 2.0),
            event("dynamic_pressure", "rises_through", 2000.0)],
    });
    let mut steered: Value = serde_json::from_str(include_str!("../../openapi/examples/lifting_capsule.json")).unwrap();
    steered.as_object_mut().unwrap().retain(|name, _| !["events", "output", "sensitivities"].contains(&name.as_str()));
    let mut cases = vec![
        ("TARGET reference case 2, at 1e-8".to_owned(), with_tolerance(target_2.clone(), 1e-8)),
        ("TARGET reference case 2, at 1e-10".to_owned(), with_tolerance(target_2.clone(), 1e-10)),
        ("a capsule in us76, heated, five events".to_owned(), job(&heated).scenario.case().clone()),
        ("a capsule with tables and schedules".to_owned(), job(&steered).scenario.case().clone()),
    ];
    cases.extend(models().into_iter().map(|(name, case)| (format!("a glide: {name}"), case)));
    println!("\n| flights in lanes ({}) | ends alone | in lanes | | with peaks | in lanes | |", instructions());
    println!("| --- | --- | --- | --- | --- | --- | --- |");
    for (name, case) in cases {
        let members = dispersed(&case);
        let each = |seconds: f64| seconds * 1e6 / f64::from(MEMBERS);
        let [alone, in_lanes, peaks, peaks_in_lanes] = medians(
            ROUNDS_OF_MANY,
            [
                &mut timed(|| members.iter().map(|member| arrival(member, &NEVER)).collect::<Vec<_>>()),
                &mut timed(|| ends_of_all(&members, &NEVER)),
                &mut timed(|| members.iter().map(|member| extremes(member, &NEVER)).collect::<Vec<_>>()),
                &mut timed(|| extremes_of_all(&members, &NEVER)),
            ],
        )
        .map(each);
        println!(
            "| {name} | {alone:.1} µs | {in_lanes:.1} µs | {:.2} | {peaks:.1} µs | {peaks_in_lanes:.1} µs | {:.2} |",
            alone / in_lanes,
            peaks / peaks_in_lanes
        );
    }
    let members = dispersed(&target_2);
    let (first, second) = members.split_at(members.len() / 2);
    let [one, two] = medians(
        ROUNDS_OF_MANY,
        [
            &mut timed(|| [ends_of_all(first, &NEVER), ends_of_all(second, &NEVER)]),
            &mut timed(|| {
                std::thread::scope(|scope| {
                    let other = scope.spawn(|| ends_of_all(second, &NEVER));
                    [ends_of_all(first, &NEVER), other.join().unwrap()]
                })
            }),
        ],
    );
    println!("\nTwo threads are {:.2} times as fast as one.", one / two);
}

fn instructions() -> &'static str {
    lane_instructions().unwrap_or("none")
}

/// Flights that begin at once.
const MEMBERS: u32 = 256;
const ROUNDS_OF_MANY: usize = 30;

/// A case and others beside it, of other speeds, masses and densities.
fn dispersed(case: &Case) -> Vec<Scenario> {
    let member = |index: u32| {
        let part = |number: u32| f64::from((index * (2 * number + 7) * 37) % 101) / 101.0 - 0.5;
        let mut moved = case.clone();
        moved.initial_state.velocity *= 1.0 + 2e-3 * part(1);
        moved.vehicle.mass *= 1.0 + 0.1 * part(2);
        moved.density_factor *= 1.0 + 0.2 * part(3);
        Scenario::new(moved).unwrap()
    };
    (0..MEMBERS).map(member).collect()
}

/// What the searches of the document's examples take.
fn searches() {
    println!("\n| search | flights | time |\n| --- | --- | --- |");
    let target = |text: &str| answer::target(json::parse(text.as_bytes()).unwrap(), None, &NEVER).unwrap();
    let corridor = |text: &str| answer::corridor(json::parse(text.as_bytes()).unwrap(), &NEVER).unwrap();
    let footprint =
        |text: &str| answer::footprint(json::parse(text.as_bytes()).unwrap(), Format::Json, None, &NEVER).unwrap();
    let two_bank_angles = include_str!("../../openapi/examples/footprint.json");
    let finer = two_bank_angles.replace("\"resolution\": 2000", "\"resolution\": 500");
    for (name, text, search) in [
        ("landing site", include_str!("../../openapi/examples/target.json"), &target as &dyn Fn(&str) -> Answer),
        ("boundary values of TARGET", include_str!("../../openapi/examples/boundary_values.json"), &target),
        ("corridor of a lunar return", include_str!("../../openapi/examples/corridor.json"), &corridor),
        ("footprint by two bank angles, at 2 km", two_bank_angles, &footprint),
        ("the same at 500 m", &finer, &footprint),
    ] {
        let answer: Value = serde_json::from_slice(&search(text).body).unwrap();
        let [seconds] = medians(SEARCHES, [&mut timed(|| search(black_box(text)))]);
        println!("| {name} | {} | {:.1} ms |", answer["search"]["flights"], seconds * 1e3);
    }
}

/// Rounds of a search, of which each has hundreds of flights.
const SEARCHES: usize = 20;

fn scenario(name: &str) -> Scenario {
    job(&thesis_request(name)).scenario
}

/// A case of the thesis with the constants of WGS 84.
fn thesis_request(name: &str) -> Value {
    let case = thesis_cases().into_iter().find(|case| case.name == name && case.model == "earth_wgs84").unwrap();
    case.request
}

fn job(request: &Value) -> FlightRequest {
    FlightRequest::try_from_tree(json::parse(request.to_string().as_bytes()).unwrap(), RequestedOutput::Answer).unwrap()
}

/// The equations in units of the planet's radius and circular speed, as `ode_solvers` has one tolerance for all components.
struct Scaled {
    motion: Cartesian,
    length: f64,
    speed: f64,
}

impl Scaled {
    fn new(case: &Case) -> Self {
        let length = case.planet.equatorial_radius();
        let speed = (case.planet.gravitational_parameter / length).sqrt();
        Self { motion: Cartesian(case.forces()), length, speed }
    }
}

impl ode_solvers::System<f64, SVector<f64, 6>> for Scaled {
    fn system(&self, _: f64, state: &SVector<f64, 6>, derivative: &mut SVector<f64, 6>) {
        let [x, y, z, vx, vy, vz] = (*state).into();
        let (length, speed) = (self.length, self.speed);
        let state = [x * length, y * length, z * length, vx * speed, vy * speed, vz * speed];
        let [vx, vy, vz, ax, ay, az] = self.motion.derivative(0.0, &state);
        let (by_speed, by_acceleration) = (1.0 / speed, length / (speed * speed));
        let rates = [vx * by_speed, vy * by_speed, vz * by_speed];
        *derivative = SVector::from([
            rates[0],
            rates[1],
            rates[2],
            ax * by_acceleration,
            ay * by_acceleration,
            az * by_acceleration,
        ]);
    }
}

/// The position at a time, and the evaluations.
fn peer(case: &Case, time: f64, tolerance: f64) -> ([f64; 3], u32) {
    let scaled = Scaled::new(case);
    let (length, speed) = (scaled.length, scaled.speed);
    let [x, y, z, vx, vy, vz]: [f64; 6] = case.initial_state.into();
    let start = SVector::from([x / length, y / length, z / length, vx / speed, vy / speed, vz / speed]);
    let end = time * speed / length;
    // Its defaults, but for the output, which is the end of each step and nothing between.
    let (safety, beta, least, greatest, first) = (0.9, 0.0, 0.333, 6.0, 0.0);
    let (steps, stiffness) = (100_000, 1000);
    let output = OutputType::Sparse;
    let mut solver = Dop853::from_param(
        scaled, 0.0, end, end, start, tolerance, tolerance, safety, beta, least, greatest, end, first, steps,
        stiffness, output,
    );
    let statistics = solver.integrate().unwrap();
    let state = solver.y_out().last().unwrap();
    ([state[0] * length, state[1] * length, state[2] * length], statistics.num_eval)
}

/// The median time of each contender, in µs.
fn micros<const K: usize>(contenders: [&mut dyn FnMut(); K]) -> [f64; K] {
    medians(ROUNDS, contenders).map(|seconds| seconds * 1e6)
}
