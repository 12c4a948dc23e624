//! Targets of flights: random problems with known answers, and such as have none.

use std::sync::atomic::AtomicBool;

use rand::rngs::Xoshiro256PlusPlus;
use rand::{RngExt, SeedableRng};
use reentry::coordinates::Site;
use reentry::event::{Condition, Direction, Effect, Event, Quantity, Trigger};
use reentry::planet::Shape;
use reentry::propulsion::{Impulse, ThrustAxis};
use reentry::simulate::extremes;
use reentry::solve::requirement::{Requirement, Wanted};
use reentry::solve::target::{Accuracy, Goal, Number, Options, Outcome, Target, target};
use reentry::trajectory::{Extremes, FlightPoint, Termination};
use reentry::{Case, Control, FlightPath, Planet, Scenario};

use crate::core::flights::{capsule, glide, target_2, with_tolerance};

/// How near a landing is reached, m.
const TOLERANCE: f64 = 10.0;

const OPTIONS: Options = Options { starts: 0, solutions: 1, flights: 5000, is_recorded: false };

/// A kind of flight: the numbers that vary with their ranges, and the case with them.
#[derive(Clone, Copy)]
struct Kind {
    name: &'static str,
    between: [[f64; 2]; 2],
    case: fn([f64; 2]) -> Case,
    goal: fn(&Extremes) -> Option<Known>,
}

/// What a flight has achieved, which another is to achieve again.
#[derive(Clone, Copy, Debug)]
enum Known {
    /// It has landed there.
    Landing(Site),
    /// It has left for an apoapsis, as -1/r, 1/m, with a heading, rad.
    Orbit { reciprocal: f64, heading: f64 },
}

fn path(case: &Case) -> FlightPath<f64> {
    FlightPath::from_planet_fixed(&case.initial_state)
}

fn from(path: FlightPath<f64>, case: Case) -> Case {
    Case { initial_state: path.to_planet_fixed(), ..case }
}

/// A capsule whose angle and heading vary.
fn by_angle([flight_path_angle, heading]: [f64; 2]) -> Case {
    from(FlightPath { flight_path_angle, heading, ..path(&capsule()) }, capsule())
}

/// The same, which crosses the date line.
fn across_the_date_line([flight_path_angle, heading]: [f64; 2]) -> Case {
    from(FlightPath { longitude: 3.0, flight_path_angle, heading, ..path(&capsule()) }, capsule())
}

/// The same, which flies over the south pole or beside it.
fn over_the_pole([flight_path_angle, heading]: [f64; 2]) -> Case {
    from(FlightPath { geocentric_latitude: -1.35, flight_path_angle, heading, ..path(&capsule()) }, capsule())
}

/// A glider whose bank and speed vary.
fn by_bank([bank_angle, speed]: [f64; 2]) -> Case {
    let case = Case { control: Control::banked(bank_angle), ..glide() };
    from(FlightPath { speed, flight_path_angle: -0.1, ..path(&glide()) }, case)
}

/// A hyperbolic entry beside the pole with the lift to either side.
fn hyperbolic([flight_path_angle, bank_angle]: [f64; 2]) -> Case {
    let case = Case { control: Control::banked(bank_angle), ..glide() };
    let near_the_pole = FlightPath { geocentric_latitude: 1.45, heading: 1.4, ..path(&glide()) };
    from(FlightPath { speed: 13_000.0, flight_path_angle, ..near_the_pole }, case)
}

/// A hyperbolic entry with the lift down.
fn lift_down([flight_path_angle, bank_angle]: [f64; 2]) -> Case {
    let case = Case { control: Control::banked(bank_angle), ..glide() };
    from(FlightPath { speed: 13_000.0, flight_path_angle, ..path(&glide()) }, case)
}

/// A vehicle that dips to the ground or nearly so: some flights end in the dip, some far beyond it (Jameson 2006, Table 2).
fn grazing_dip([flight_path_angle, bank_angle]: [f64; 2]) -> Case {
    let case = Case { control: Control::banked(bank_angle), ..target_2() };
    from(FlightPath { flight_path_angle, ..path(&target_2()) }, case)
}

/// A burn that takes a capsule out of its orbit: when, and how strong.
fn deorbit([time, speed_change]: [f64; 2]) -> Case {
    let when = Condition { quantity: Quantity::Time, value: time, direction: Direction::Rising };
    let impulse = Impulse { along: ThrustAxis::Velocity, speed_change };
    let then = Effect { impulse: Some(impulse), ..Effect::default() };
    let orbit =
        FlightPath { radius: 6_678_137.0, speed: 7430.0, flight_path_angle: 0.0, heading: 0.9, ..path(&capsule()) };
    from(orbit, Case { events: vec![Event { when: Trigger::Condition(when), then }], ..capsule() })
}

/// A pass through the air, after which a hyperbola has become an ellipse.
fn aerocapture([flight_path_angle, bank_angle]: [f64; 2]) -> Case {
    let mut case = Case { control: Control::banked(bank_angle), ..glide() };
    case.stop.ceiling = Some(130e3);
    from(FlightPath { speed: 11_500.0, flight_path_angle, ..path(&glide()) }, case)
}

const KINDS: [Kind; 9] = [
    Kind { name: "angle and heading", between: [[-0.2, -0.02], [-1.0, 1.5]], case: by_angle, goal: landing },
    Kind { name: "bank and speed", between: [[-1.5, 1.5], [6000.0, 7600.0]], case: by_bank, goal: landing },
    Kind { name: "hyperbolic", between: [[-1.2, -0.25], [-1.5, 1.5]], case: hyperbolic, goal: landing },
    Kind { name: "lift down", between: [[-0.5, -0.08], [2.0, 4.2]], case: lift_down, goal: landing },
    Kind { name: "grazing dip", between: [[-0.6, -0.45], [0.3, 1.3]], case: grazing_dip, goal: landing },
    Kind { name: "date line", between: [[-0.2, -0.02], [-1.0, 1.0]], case: across_the_date_line, goal: landing },
    Kind { name: "pole", between: [[-0.2, -0.02], [-2.4, -0.8]], case: over_the_pole, goal: landing },
    Kind { name: "deorbit burn", between: [[0.0, 3000.0], [-260.0, -120.0]], case: deorbit, goal: landing },
    Kind { name: "aerocapture", between: [[-0.16, -0.06], [0.0, 3.0]], case: aerocapture, goal: orbit },
];

fn ground_point(point: &FlightPoint) -> Site {
    Site { longitude: point.flight_path.longitude, geodetic_latitude: point.geodetic_latitude }
}

/// Where a flight ends, if it lands.
fn landing(flight: &Extremes) -> Option<Known> {
    let lands = flight.termination() == Termination::SurfaceImpact;
    lands.then(|| Known::Landing(ground_point(&flight.last())))
}

/// The ellipse on which a flight leaves, if it does.
fn orbit(flight: &Extremes) -> Option<Known> {
    let end = flight.last();
    let (reciprocal, heading) = (reciprocal_apoapsis(&end), end.flight_path.heading);
    let is_captured = flight.termination() == Termination::AtmosphereExit && reciprocal < -1e-8;
    is_captured.then_some(Known::Orbit { reciprocal, heading })
}

/// -1/r of the apoapsis, 1/m: 2 ε/(μ (1 + e)).
fn reciprocal_apoapsis(end: &FlightPoint) -> f64 {
    let parameter = Planet::EARTH_WGS84.gravitational_parameter;
    let momentum = end.flight_path.radius * end.inertial_speed * end.inertial_flight_path_angle.cos();
    let energy = 0.5 * end.inertial_speed.powi(2) - parameter / end.flight_path.radius;
    let eccentricity = (1.0 + 2.0 * energy * (momentum / parameter).powi(2)).sqrt();
    2.0 * energy / (parameter * (1.0 + eccentricity))
}

impl Known {
    /// By how much a flight misses it; none where it ends otherwise.
    fn misses(&self, flight: &Extremes, shape: &Shape) -> Option<[f64; 2]> {
        match (*self, flight.termination()) {
            (Self::Landing(site), Termination::SurfaceImpact) => {
                Some(site.offset_to(&ground_point(&flight.last()), shape))
            }
            (Self::Orbit { reciprocal, heading }, Termination::AtmosphereExit) => {
                let end = flight.last();
                Some([reciprocal_apoapsis(&end) - reciprocal, end.flight_path.heading - heading])
            }
            _ => None,
        }
    }

    /// How near is reached: of an apoapsis at twice the radius of the Earth 2 km, of the heading two seconds of arc.
    fn tolerances(&self) -> [f64; 2] {
        match self {
            Self::Landing(_) => [TOLERANCE; 2],
            Self::Orbit { .. } => [1e-11, 1e-5],
        }
    }
}

fn fly(case: Case) -> Extremes {
    extremes(&Scenario::new(case).unwrap(), &AtomicBool::new(false)).unwrap()
}

/// Searches for the numbers with which a flight achieves what is known.
fn search(kind: &Kind, start: [f64; 2], known: &Known) -> (Target, usize) {
    let number = |index: usize| {
        let between = kind.between[index];
        Number { between, scale: between[1] - between[0], start: start[index], is_cyclic: false }
    };
    let goals = known.tolerances().map(|tolerance| {
        let requirement = Requirement { wanted: Wanted::Equals(0.0), turn: None, tolerance, size: 1.0 };
        Goal { searched: requirement, shown: requirement }
    });
    let mut flights = 0;
    let mut outcome = |values: &[f64], accuracy: Accuracy| {
        flights += 1;
        let case = (kind.case)([values[0], values[1]]);
        let case = if accuracy == Accuracy::Fine { with_tolerance(case, 1e-12) } else { case };
        let shape = case.planet.shape;
        let flight = fly(case);
        let misses = known.misses(&flight, &shape);
        let numbers = misses.map_or(vec![None; 2], |misses| misses.map(Some).to_vec());
        let end = Some(flight.termination());
        Outcome { end, counts: misses.is_some(), searched: numbers.clone(), shown: numbers }
    };
    let mut flown = |values: &[Vec<f64>], accuracy: Accuracy| {
        Ok::<_, ()>(values.iter().map(|values| outcome(values, accuracy)).collect())
    };
    let found = target(&[number(0), number(1)], &goals, OPTIONS, &mut flown).unwrap();
    (found, flights)
}

fn random_in(random: &mut Xoshiro256PlusPlus, kind: &Kind) -> [f64; 2] {
    kind.between.map(|[least, greatest]| least + random.random::<f64>() * (greatest - least))
}

/// How many of so many random problems of a kind are solved, from starts that are not their solutions, and with how many flights each.
fn solved(kind: &Kind, seed: u64, asked: usize) -> (usize, Vec<usize>) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let (mut reached, mut flights) = (0, Vec::new());
    while flights.len() < asked {
        let [start, values] = [random_in(&mut random, kind), random_in(&mut random, kind)];
        let Some(known) = (kind.goal)(&fly((kind.case)(values))) else { continue };
        let (found, count) = search(kind, start, &known);
        flights.push(count);
        reached += usize::from(!found.solutions.is_empty());
        for solution in &found.solutions {
            let case = with_tolerance((kind.case)([solution.values[0], solution.values[1]]), 1e-12);
            let shape = case.planet.shape;
            let misses = known.misses(&fly(case), &shape).expect("ends as it should");
            let is_met = misses.iter().zip(known.tolerances()).all(|(miss, tolerance)| miss.abs() <= tolerance);
            assert!(is_met, "{}: {solution:?}: {misses:?}", kind.name);
        }
        assert!(found.solutions.is_empty() == found.nearest.is_some());
    }
    (reached, flights)
}

/// At least 95 of 100.
#[test]
fn random_problems_of_every_kind_are_solved_from_other_starts() {
    const ASKED: usize = 12;
    let of_kinds: Vec<_> = std::thread::scope(|scope| {
        let threads = (1..).zip(&KINDS).map(|(seed, kind)| scope.spawn(move || solved(kind, seed, ASKED)));
        let threads: Vec<_> = threads.collect();
        threads.into_iter().map(|thread| thread.join().unwrap()).collect()
    });
    let reached: Vec<_> = KINDS.iter().zip(&of_kinds).map(|(kind, (reached, _))| (kind.name, *reached)).collect();
    let mut flights: Vec<_> = of_kinds.iter().flat_map(|(_, flights)| flights.iter().copied()).collect();
    flights.sort_unstable();
    let (all, median) = (flights.len(), flights[flights.len() / 2]);
    let sum: usize = reached.iter().map(|(_, reached)| reached).sum();
    eprintln!("{reached:?} of {ASKED} each, median {median}, sum {}", flights.iter().sum::<usize>());
    assert!(100 * sum >= 95 * all, "{reached:?} of {ASKED} each");
    assert!(median <= 250, "{median} flights in the median");
}

#[test]
fn what_cannot_be_reached_is_never_reached() {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(2);
    let place = |kind: &Kind, values: [f64; 2]| match landing(&fly((kind.case)(values))) {
        Some(Known::Landing(site)) => Some(site),
        _ => None,
    };
    for kind in KINDS[..3].iter().cycle().take(9) {
        // On the other side of the globe.
        let middle = kind.between.map(|[least, greatest]| 0.5 * (least + greatest));
        let Some(near) = place(kind, middle) else { panic!("the middle lands") };
        let far = Site { longitude: near.longitude + 2.5, geodetic_latitude: -near.geodetic_latitude };
        let (found, _) = search(kind, random_in(&mut random, kind), &Known::Landing(far));
        let nearest = found.nearest.expect("what comes nearest");
        assert!(found.solutions.is_empty() && !found.is_out_of_budget && !found.is_complete);
        let miss = nearest.solution.misses.iter().flatten().fold(0.0_f64, |sum, miss| sum.hypot(*miss));
        assert!(miss > 1e5, "{miss} m");
        // No flight of an even scan of the tests' own comes nearer.
        let shape = capsule().planet.shape;
        for [row, column] in (0..64).map(|cell| [cell / 8, cell % 8].map(|part: i32| (f64::from(part) + 0.5) / 8.0)) {
            let [one, other] = kind.between.map(|[least, greatest]| (least, greatest - least));
            let Some(there) = place(kind, [one.0 + row * one.1, other.0 + column * other.1]) else { continue };
            let [east, north] = far.offset_to(&there, &shape);
            assert!(east.hypot(north) > 0.99 * miss, "{} m of {miss} m", east.hypot(north));
        }
    }
}
