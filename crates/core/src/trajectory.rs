//! The answer: how the flight ended, its extremes, and its state at any time.

use crate::atmosphere::AtmosphereSample;
use crate::coordinates::{FlightPath, GreatCircle, Inertial, PlanetFixed, latitude_and_altitude};
use crate::integrate::{Interpolant, Statistics, Step};
use crate::motion::{Cartesian, Forces, Formulation, Loads, Regime, Spherical};
use crate::scenario::{Case, Equations};

pub use crate::motion::Lookup;

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Termination {
    /// The stop altitude was crossed downwards.
    SurfaceImpact,
    /// The stop time was reached.
    TimeLimit,
}

/// Where, when and why a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Why.
    pub termination: Termination,
    /// When, s.
    pub time: f64,
    /// Place and motion then.
    pub state: PlanetFixed<f64>,
    /// What the integration cost.
    pub statistics: Statistics,
}

/// The greatest value of a quantity over the flight, the earliest where it is reached more than once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// When, s.
    pub time: f64,
    /// At which altitude along the radius vector, m.
    pub altitude: f64,
}

/// The peaks of a flight, located on the dense output, both ends included.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peaks {
    /// -dV/dt, m/s².
    pub deceleration: Peak,
    /// The aerodynamic force over the weight at standard gravity.
    pub load_factor: Peak,
    /// Pa.
    pub dynamic_pressure: Peak,
    /// m.
    pub altitude: Peak,
    /// The speed relative to the air over that of sound; none where the atmosphere has no temperature.
    pub mach: Option<Peak>,
}

/// Something about a flight that its user should know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warning {
    /// From this time on the flight came so near the vertical that its lift was faded out; see [`crate::motion::LIFT_FADE_ANGLE`].
    LiftFadedNearVertical {
        /// s.
        time: f64,
    },
    /// From this time on a table was asked for more than it holds, and gave what it has at its edge.
    OutsideTable {
        /// Which.
        table: Lookup,
        /// s.
        time: f64,
        /// Along the radius vector, m.
        altitude: f64,
        /// The edge of the table: m, rad or a Mach number.
        edge: f64,
        /// Whether the flight lies above the edge.
        above: bool,
    },
}

/// The instants at which a trajectory is wanted; its start and its end always belong to them.
#[derive(Clone, Debug, PartialEq)]
pub enum Sampling {
    /// So many a step, the last at its end: many where the motion is fast, few where it is slow.
    PerStep(usize),
    /// Every so many seconds.
    Interval(f64),
    /// So many, evenly in time, both ends included.
    Count(usize),
    /// These, ascending, in s; those after the end are dropped.
    Times(Vec<f64>),
}

/// The flight asks for more instants than allowed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the flight gives more than the {limit} rows allowed")]
pub struct TooManyInstants {
    /// The limit.
    pub limit: usize,
}

/// The state and the loads at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightPoint {
    /// Since the start, s.
    pub time: f64,
    /// Place and motion; longitude and heading in (-π, π].
    pub flight_path: FlightPath<f64>,
    /// In [-π/2, π/2].
    pub geodetic_latitude: f64,
    /// m.
    pub geodetic_altitude: f64,
    /// What the air does.
    pub loads: Loads<f64>,
    /// Of the air, K, Pa and m/s, as far as the atmosphere knows them.
    pub temperature: Option<f64>,
    /// Pa.
    pub pressure: Option<f64>,
    /// m/s.
    pub speed_of_sound: Option<f64>,
    /// σ, rad.
    pub bank_angle: f64,
    /// α, rad.
    pub angle_of_attack: f64,
    /// The magnitude of the inertial velocity, m/s.
    pub inertial_speed: f64,
    /// Of the inertial velocity above the plane normal to the radius, rad.
    pub inertial_flight_path_angle: f64,
    /// Half the squared inertial speed and the potential of the planet's gravity, J/kg.
    pub specific_energy: f64,
    /// From the initial ground point along its heading, m, on the great circle of the sphere of radius r₀, in half a turn either way;
    /// none where the flight starts vertically or at rest.
    pub downrange: Option<f64>,
    /// To the right of that great circle, m.
    pub crossrange: Option<f64>,
}

impl FlightPoint {
    /// Whether every quantity is a finite number.
    pub fn is_finite(&self) -> bool {
        let Loads { altitude, density, air_speed, mach, dynamic_pressure, deceleration, load_factor } = self.loads;
        let path: [f64; 6] = self.flight_path.into();
        let loads = [altitude, density, air_speed, dynamic_pressure, deceleration, load_factor];
        let angles = [self.bank_angle, self.angle_of_attack, self.inertial_flight_path_angle];
        let rest = [self.geodetic_altitude, self.inertial_speed, self.specific_energy];
        let known = [mach, self.temperature, self.pressure, self.speed_of_sound].into_iter().flatten();
        let always = path.into_iter().chain(loads).chain(angles).chain(rest);
        always.chain(known).all(f64::is_finite)
    }
}

/// A step of a flight, and the regime of its models during it.
#[derive(Clone, Debug)]
pub(crate) struct Leg {
    pub(crate) step: Step<6>,
    pub(crate) regime: Regime,
}

/// A finished flight.
#[derive(Clone, Debug)]
pub struct Trajectory {
    pub(crate) case: Case,
    start: PlanetFixed<f64>,
    /// That in which the flight starts.
    pub(crate) regime: Regime,
    pub(crate) legs: Vec<Leg>,
    /// That into which it would go on.
    last_regime: Regime,
    arrival: Arrival,
    peaks: Peaks,
    warnings: Vec<Warning>,
    great_circle: Option<GreatCircle>,
}

impl Trajectory {
    pub(crate) fn new(
        case: Case,
        start: PlanetFixed<f64>,
        [regime, last_regime]: [Regime; 2],
        legs: Vec<Leg>,
        arrival: Arrival,
        peaks: Peaks,
        warnings: Vec<Warning>,
    ) -> Self {
        let great_circle = GreatCircle::of(&case.initial_state);
        Self { case, start, regime, legs, last_regime, arrival, peaks, warnings, great_circle }
    }

    /// How the flight ended.
    pub fn termination(&self) -> Termination {
        self.arrival.termination
    }

    /// The greatest values over the flight.
    pub fn peaks(&self) -> &Peaks {
        &self.peaks
    }

    /// What the user should know.
    pub fn warnings(&self) -> &[Warning] {
        &self.warnings
    }

    /// What the integration cost.
    pub fn statistics(&self) -> Statistics {
        self.arrival.statistics
    }

    /// When the flight ended, s.
    pub fn end_time(&self) -> f64 {
        self.arrival.time
    }

    /// Where and how it ended.
    pub fn arrival(&self) -> &Arrival {
        &self.arrival
    }

    /// The initial state.
    pub fn initial(&self) -> FlightPoint {
        self.point(&self.forces(self.regime), 0.0, &self.start)
    }

    /// The final state.
    pub fn last(&self) -> FlightPoint {
        self.point(&self.forces(self.last_regime), self.arrival.time, &self.arrival.state)
    }

    /// The state at a time, s; before the start it is the initial one, after the end the final one.
    pub fn at(&self, time: f64) -> FlightPoint {
        let following = self.legs.partition_point(|leg| leg.step.end_time <= time);
        match self.legs.get(following) {
            _ if time <= 0.0 => self.initial(),
            Some(leg) => {
                let motion = self.motion(leg.regime);
                let state = motion.planet_fixed(&motion.interpolant(&leg.step).state_at(time));
                self.point(motion.forces(), time, &state)
            }
            None => self.last(),
        }
    }

    /// D/m, m/s², at a point of a flight of constant coefficients.
    pub fn drag_deceleration(&self, point: &FlightPoint) -> f64 {
        self.forces(self.regime).drag_under(point.loads.dynamic_pressure)
    }

    /// The instants of a sampling, strictly increasing, s.
    ///
    /// # Errors
    /// When there are more than `limit`.
    pub fn instants(&self, sampling: &Sampling, limit: usize) -> Result<Vec<f64>, TooManyInstants> {
        let end = self.end_time();
        let wanted = match sampling {
            Sampling::PerStep(samples) => samples.saturating_mul(self.legs.len()),
            Sampling::Count(count) => *count,
            Sampling::Interval(_) | Sampling::Times(_) => 0,
        };
        if wanted > limit {
            return Err(TooManyInstants { limit });
        }
        let mut instants = Instants { times: vec![0.0], end, limit };
        match sampling {
            Sampling::PerStep(samples) => {
                for leg in &self.legs {
                    for sample in 1..=*samples {
                        instants.push(leg.step.time(ratio(sample, *samples)))?;
                    }
                }
            }
            Sampling::Interval(interval) => {
                let mut sample = 1;
                while instants.push(ratio(sample, 1) * interval)? {
                    sample += 1;
                }
            }
            Sampling::Count(count) => {
                for sample in 1..count - 1 {
                    instants.push(end * ratio(sample, count - 1))?;
                }
            }
            Sampling::Times(times) => {
                for time in times {
                    instants.push(*time)?;
                }
            }
        }
        instants.finish()
    }

    /// The states at ascending times, s.
    ///
    /// At loose tolerances the motion of a very light vehicle may overflow between the ends of a step: see [`FlightPoint::is_finite`].
    pub fn points(&self, times: &[f64]) -> Vec<FlightPoint> {
        let mut following = 0;
        let mut motion = self.motion(self.regime);
        let mut inside: Option<(usize, Interpolant<6>)> = None;
        let mut point = |time: f64| {
            while self.legs.get(following).is_some_and(|leg| leg.step.end_time <= time) {
                following += 1;
            }
            match self.legs.get(following) {
                _ if time <= 0.0 => self.initial(),
                Some(leg) => {
                    motion.forces_mut().enter(leg.regime);
                    let known = inside.take().filter(|(index, _)| *index == following);
                    let (_, interpolant) =
                        inside.insert(known.unwrap_or_else(|| (following, motion.interpolant(&leg.step))));
                    self.point(motion.forces(), time, &motion.planet_fixed(&interpolant.state_at(time)))
                }
                None => self.last(),
            }
        };
        times.iter().map(|time| point(*time)).collect()
    }

    /// The equations that were integrated, in a regime.
    pub(crate) fn motion(&self, regime: Regime) -> Motion {
        let forces = self.forces(regime);
        match self.case.solver.equations {
            Equations::Cartesian => Motion::Cartesian(Cartesian(forces)),
            Equations::Spherical => Motion::Spherical(Spherical(forces)),
        }
    }

    fn forces(&self, regime: Regime) -> Forces {
        let mut forces = Forces::new(self.case.models(), self.case.parameters());
        forces.enter(regime);
        forces
    }

    fn point(&self, forces: &Forces, time: f64, state: &PlanetFixed<f64>) -> FlightPoint {
        let planet = &self.case.planet;
        let flight_path = FlightPath::from_planet_fixed(state).wrapped();
        let (geodetic_latitude, geodetic_altitude) = latitude_and_altitude(&state.position, &planet.shape);
        let AtmosphereSample { temperature, pressure, speed_of_sound, .. } = forces.air_at(state);
        let [bank_angle, angle_of_attack] = forces.angles(time, state);
        let inertial = Inertial::from_planet_fixed(state, planet, 0.0);
        let climb = inertial.position.dot(&inertial.velocity);
        let across = inertial.position.cross(&inertial.velocity).norm();
        let range = self.great_circle.map(|circle| circle.along_and_across(&state.position));
        let [downrange, crossrange] = [0, 1].map(|part| range.map(|range| range[part] * planet.equatorial_radius()));
        FlightPoint {
            time,
            flight_path,
            geodetic_latitude,
            geodetic_altitude,
            loads: forces.loads(time, state),
            temperature,
            pressure,
            speed_of_sound,
            bank_angle,
            angle_of_attack,
            inertial_speed: inertial.velocity.norm(),
            inertial_flight_path_angle: climb.atan2(across),
            specific_energy: 0.5 * inertial.velocity.norm_squared() + planet.potential(&state.position),
            downrange,
            crossrange,
        }
    }
}

/// The equations of either formulation.
pub(crate) enum Motion {
    Cartesian(Cartesian),
    Spherical(Spherical),
}

impl Motion {
    pub(crate) fn forces(&self) -> &Forces {
        match self {
            Self::Cartesian(motion) => motion.forces(),
            Self::Spherical(motion) => motion.forces(),
        }
    }

    pub(crate) fn forces_mut(&mut self) -> &mut Forces {
        match self {
            Self::Cartesian(motion) => motion.forces_mut(),
            Self::Spherical(motion) => motion.forces_mut(),
        }
    }

    pub(crate) fn interpolant(&self, step: &Step<6>) -> Interpolant<6> {
        match self {
            Self::Cartesian(motion) => step.interpolant(motion),
            Self::Spherical(motion) => step.interpolant(motion),
        }
    }

    /// The state of six numbers of the formulation.
    pub(crate) fn planet_fixed(&self, coordinates: &[f64; 6]) -> PlanetFixed<f64> {
        match self {
            Self::Cartesian(_) => Cartesian::planet_fixed(coordinates),
            Self::Spherical(_) => Spherical::planet_fixed(coordinates),
        }
    }
}

/// Instants between the start and the end, as they are gathered.
struct Instants {
    times: Vec<f64>,
    end: f64,
    limit: usize,
}

impl Instants {
    /// Adds an instant that follows the last and comes before the end; false once the end is reached.
    fn push(&mut self, time: f64) -> Result<bool, TooManyInstants> {
        let inside = time < self.end;
        let last = self.times.last().copied().unwrap_or(0.0);
        if inside && time > last {
            // The final instant still has to find a place.
            if self.times.len() + 1 >= self.limit {
                return Err(TooManyInstants { limit: self.limit });
            }
            self.times.push(time);
        }
        Ok(inside)
    }

    fn finish(mut self) -> Result<Vec<f64>, TooManyInstants> {
        if self.end > 0.0 {
            self.times.push(self.end);
        }
        if self.times.len() > self.limit { Err(TooManyInstants { limit: self.limit }) } else { Ok(self.times) }
    }
}

#[expect(clippy::cast_precision_loss, reason = "rows are counted far below 2^52")]
fn ratio(part: usize, whole: usize) -> f64 {
    part as f64 / whole as f64
}
