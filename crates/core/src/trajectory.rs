//! The answer: how the flight ended, its extremes, and its state at any time.

use crate::coordinates::{FlightPath, PlanetFixed, latitude_and_altitude};
use crate::integrate::{Interpolant, Statistics, Step};
use crate::motion::{Cartesian, Formulation, Loads, Spherical};
use crate::scenario::{Case, Equations};

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

/// A table, and the quantity by which something is looked up in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Lookup {
    /// The atmosphere by altitude; outside, the logarithm of its density goes on in a straight line.
    Atmosphere,
    /// The wind by altitude.
    Wind,
    /// The aerodynamics by Mach number.
    Mach,
    /// The aerodynamics by angle of attack.
    AngleOfAttack,
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
        let Loads { altitude, density, dynamic_pressure, deceleration, load_factor, .. } = self.loads;
        let path: [f64; 6] = self.flight_path.into();
        let rest = [altitude, density, dynamic_pressure, deceleration, load_factor, self.geodetic_altitude];
        path.iter().chain(&rest).all(|quantity| quantity.is_finite())
    }
}

/// A finished flight.
#[derive(Clone, Debug)]
pub struct Trajectory {
    pub(crate) case: Case,
    pub(crate) start: [f64; 6],
    pub(crate) steps: Vec<Step<6>>,
    pub(crate) arrival: Arrival,
    pub(crate) peaks: Peaks,
    pub(crate) warnings: Vec<Warning>,
}

impl Trajectory {
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

    /// The initial state.
    pub fn initial(&self) -> FlightPoint {
        self.point(0.0, &self.start)
    }

    /// The final state.
    pub fn last(&self) -> FlightPoint {
        self.steps.last().map_or_else(|| self.initial(), |step| self.point(step.end_time, &step.end))
    }

    /// The state at a time, s; before the start it is the initial one, after the end the final one.
    pub fn at(&self, time: f64) -> FlightPoint {
        let following = self.steps.partition_point(|step| step.end_time <= time);
        match self.steps.get(following) {
            _ if time <= 0.0 => self.initial(),
            Some(step) => self.point(time, &self.interpolant(step).state_at(time)),
            None => self.last(),
        }
    }

    /// D/m, m/s², at a point of the flight.
    pub fn drag_deceleration(&self, point: &FlightPoint) -> f64 {
        self.case.forces().drag_under(point.loads.dynamic_pressure)
    }

    /// The instants of a sampling, strictly increasing, s.
    ///
    /// # Errors
    /// When there are more than `limit`.
    pub fn instants(&self, sampling: &Sampling, limit: usize) -> Result<Vec<f64>, TooManyInstants> {
        let end = self.end_time();
        let wanted = match sampling {
            Sampling::PerStep(samples) => samples.saturating_mul(self.steps.len()),
            Sampling::Count(count) => *count,
            Sampling::Interval(_) | Sampling::Times(_) => 0,
        };
        if wanted > limit {
            return Err(TooManyInstants { limit });
        }
        let mut instants = Instants { times: vec![0.0], end, limit };
        match sampling {
            Sampling::PerStep(samples) => {
                for step in &self.steps {
                    for sample in 1..=*samples {
                        instants.push(step.time(ratio(sample, *samples)))?;
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
        let mut inside: Option<(usize, Interpolant<6>)> = None;
        let mut point = |time: f64| {
            while self.steps.get(following).is_some_and(|step| step.end_time <= time) {
                following += 1;
            }
            match self.steps.get(following) {
                _ if time <= 0.0 => self.initial(),
                Some(step) => {
                    let known = inside.take().filter(|(index, _)| *index == following);
                    let (_, interpolant) = inside.insert(known.unwrap_or_else(|| (following, self.interpolant(step))));
                    self.point(time, &interpolant.state_at(time))
                }
                None => self.last(),
            }
        };
        times.iter().map(|time| point(*time)).collect()
    }

    pub(crate) fn interpolant(&self, step: &Step<6>) -> Interpolant<6> {
        let forces = self.case.forces();
        match self.case.solver.equations {
            Equations::Cartesian => step.interpolant(&Cartesian(forces)),
            Equations::Spherical => step.interpolant(&Spherical(forces)),
        }
    }

    /// The state of six numbers of the flight's formulation.
    pub(crate) fn planet_fixed(&self, coordinates: &[f64; 6]) -> PlanetFixed<f64> {
        match self.case.solver.equations {
            Equations::Cartesian => Cartesian::planet_fixed(coordinates),
            Equations::Spherical => Spherical::planet_fixed(coordinates),
        }
    }

    fn point(&self, time: f64, coordinates: &[f64; 6]) -> FlightPoint {
        let state = self.planet_fixed(coordinates);
        let flight_path = FlightPath::from_planet_fixed(&state).wrapped();
        let (geodetic_latitude, geodetic_altitude) = latitude_and_altitude(&state.position, &self.case.planet.shape);
        let loads = self.case.forces().loads(&state);
        FlightPoint {
            time,
            flight_path,
            geodetic_latitude,
            geodetic_altitude,
            loads,
            temperature: None,
            pressure: None,
            speed_of_sound: None,
            bank_angle: 0.0,
            angle_of_attack: 0.0,
            inertial_speed: 0.0,
            inertial_flight_path_angle: 0.0,
            specific_energy: 0.0,
            downrange: None,
            crossrange: None,
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
