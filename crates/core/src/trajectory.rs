//! The answer: how the flight ended, its peaks, and its state at any time.

mod extremes;
mod ground_track;
mod phases;
mod sampling;
mod stored_step;

pub use extremes::{Ends, Extremes};
pub use phases::{FlightPhase, PhaseStart};
pub use sampling::{Sampling, TooManyInstants};

pub(crate) use stored_step::{Motion, StoredStep};

use std::f64::consts::TAU;
use std::sync::{Arc, OnceLock};

use ground_track::GroundTrack;
use nalgebra::Vector3;
use stored_step::AnyInterpolant;

use crate::atmosphere::AtmosphereSample;
use crate::coordinates::{
    FlightPath, GreatCircle, Inertial, OrbitalElements, PlanetFixed, UndefinedElements, about_pole,
    latitude_and_altitude,
};
use crate::elementary::{atan2, hypot};
use crate::heating;
use crate::integrate::Statistics;
use crate::interrupt::Interrupt;
use crate::motion::{Cartesian, Forces, Loads, ModelMode, Spherical, State, WIND_FADE_ANGLE};
use crate::planet::Planet;
use crate::scenario::{Case, Equations, Phase};
use crate::wind::Wind;

pub use crate::motion::TableId;

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Termination {
    /// The surface, a stop altitude of 0, was crossed downwards.
    SurfaceImpact,
    /// A stop altitude other than 0 was crossed downwards.
    StopAltitude,
    /// The stop time was reached.
    TimeLimit,
    /// The condition of this place in the list was met.
    Condition(usize),
    /// The ceiling was crossed upwards.
    AtmosphereExit,
}

/// Where, when and why a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Arrival {
    /// Which condition ended the flight.
    pub termination: Termination,
    /// The time of the end, s.
    pub time: f64,
    /// Position and velocity at the end, planet-fixed.
    pub state: PlanetFixed<f64>,
    /// The heat load at the end, J/m²; none without heating.
    pub heat_load: Option<f64>,
    /// Steps and evaluations of the integration.
    pub statistics: Statistics,
}

/// The greatest value of a quantity over the flight, the earliest where it is reached more than once.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Peak {
    /// The value, in the unit of the quantity.
    pub value: f64,
    /// The time at which it is reached, s.
    pub time: f64,
    /// The altitude along the radius vector there, m.
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
    /// Relative to the rotating planet, m/s.
    pub speed: Peak,
    /// The speed relative to the air over that of sound; none where the atmosphere has no temperature.
    pub mach: Option<Peak>,
    /// Of the heating, where it is asked for.
    pub heating: Option<HeatingPeaks>,
}

/// The peaks of the heating at the stagnation point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeatingPeaks {
    /// By convection, W/m².
    pub convective_heat_flux: Peak,
    /// By radiation, W/m².
    pub radiative_heat_flux: Peak,
    /// Both together, W/m².
    pub heat_flux: Peak,
    /// J/m²; at the end.
    pub heat_load: Peak,
    /// K; with the heat flux.
    pub wall_temperature: Peak,
}

/// Something about a flight that its user should know.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Warning {
    /// From this time on the flight came so near the vertical that its lift was faded out; see [`crate::motion::LIFT_FADE_ANGLE`].
    LiftFadedNearVertical {
        /// s.
        time: f64,
    },
    /// From this time on the flight came so near a pole that the wind was faded out; see [`crate::motion::WIND_FADE_ANGLE`].
    WindFadedNearPole {
        /// At the end of a step, s.
        time: f64,
    },
    /// From this time on a table, or a model of a given range, was asked for more than it holds, and gave what it has at its edge.
    OutsideTable {
        /// The table that was asked.
        table: TableId,
        /// s.
        time: f64,
        /// Along the radius vector, m.
        altitude: f64,
        /// The edge of the table: m, rad or a Mach number.
        edge: f64,
        /// Whether the flight lies above the edge.
        above: bool,
    },
    /// At the peak of its flux a correlation was asked for more than it was made for.
    OutsideRange {
        /// The name of the correlation.
        correlation: &'static str,
        /// The quantity that lies outside its range.
        quantity: &'static str,
        /// The unit of the quantity.
        unit: &'static str,
        /// The value of the quantity at the peak.
        value: f64,
        /// The least and the greatest value for which the correlation was made.
        range: [f64; 2],
        /// s.
        time: f64,
    },
    /// The propellant was spent, and the thrust with it.
    PropellantSpent {
        /// s.
        time: f64,
    },
    /// An impulse had no direction: along a velocity of none, or across the vertical; or the vehicle was held on the ground, which took it.
    NoDirection {
        /// The number of its event.
        event: usize,
        /// s.
        time: f64,
    },
    /// A thrust was switched on where it has no direction: along a velocity of none, or level in vertical flight. It acts as soon as it
    /// has one, and meanwhile burns its propellant.
    ThrustWithoutDirection {
        /// The number of its event.
        event: usize,
        /// s.
        time: f64,
    },
    /// An engine was to be lit that burns already, or that has left.
    NotLit {
        /// The number of the event that was to light it.
        event: usize,
        /// The place of its part in the list.
        part: usize,
        /// Whether it has not left.
        is_there: bool,
        /// s.
        time: f64,
    },
    /// The vehicle was held on the ground until its flight ended.
    NeverLifted {
        /// s.
        time: f64,
    },
    /// A parachute was to be cut off that is not deployed.
    NotDeployed {
        /// The number of the event that was to cut it off.
        event: usize,
        /// The number of the event that deploys it.
        parachute: usize,
        /// s.
        time: f64,
    },
}

impl Warning {
    /// When, s.
    pub fn time(&self) -> f64 {
        match *self {
            Self::LiftFadedNearVertical { time }
            | Self::WindFadedNearPole { time }
            | Self::OutsideTable { time, .. }
            | Self::OutsideRange { time, .. }
            | Self::PropellantSpent { time }
            | Self::NoDirection { time, .. }
            | Self::ThrustWithoutDirection { time, .. }
            | Self::NotLit { time, .. }
            | Self::NeverLifted { time }
            | Self::NotDeployed { time, .. } => time,
        }
    }
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
    /// Relative to the rotating planet, by [`Planet::energy`](crate::planet::Planet::energy), J/kg.
    pub energy: f64,
    /// From the initial ground point along its heading, m, on the great circle of the sphere of radius r₀, counted on continuously over
    /// whole turns; none where the flight starts vertically or at rest. At the poles of the great circle, where the crossrange is a
    /// quarter of a turn, it is undefined: a flight that passes near one gains or loses up to half a turn within a short time, by the side on
    /// which it passes, and gains it if it passes through.
    pub downrange: Option<f64>,
    /// To the right of that great circle, m.
    pub crossrange: Option<f64>,
    /// From the initial ground point, m, along the great circle between the two on the sphere of radius r₀; at most π r₀.
    pub ground_range: f64,
    /// The length of the ground track since the start, m, on the sphere of radius r₀.
    pub ground_distance: f64,
    /// kg.
    pub mass: f64,
    /// The magnitude of the thrust, N; 0 where none is on.
    pub thrust: f64,
    /// The share of the thrust of all engines that are lit, in vacuum, that throttles and the load limit leave; 0 where none is lit.
    pub throttle: f64,
    /// Of the axis of a vehicle with parts above the plane normal to the radius vector, rad.
    pub pitch: Option<f64>,
    /// The number of the phase of the flight.
    pub(crate) phase: usize,
    /// Into the stagnation point since the start, J/m², where heating is asked for.
    pub heat_load: Option<f64>,
    /// At which the wall radiates what it gets, K.
    pub wall_temperature: Option<f64>,
}

/// An event that happened.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EventPoint {
    /// Its place in the list of the case.
    pub event: usize,
    /// At its instant, before its effect.
    pub before: FlightPoint,
    /// At its instant, after its effect.
    pub after: FlightPoint,
}

impl FlightPoint {
    /// Whether every quantity is a finite number.
    pub fn is_finite(&self) -> bool {
        let Loads {
            altitude,
            density,
            speed: _,
            air_speed,
            mach,
            dynamic_pressure,
            deceleration,
            load_factor,
            heat_flux,
        } = self.loads;
        let path: [f64; 6] = self.flight_path.into();
        let loads = [altitude, density, air_speed, dynamic_pressure, deceleration, load_factor];
        let angles = [self.bank_angle, self.angle_of_attack, self.inertial_flight_path_angle];
        let rest = [self.geodetic_altitude, self.inertial_speed, self.specific_energy, self.ground_distance];
        let heat = [heat_flux.map(|flux| flux.total()), self.heat_load, self.wall_temperature];
        let known = [mach, self.temperature, self.pressure, self.speed_of_sound].into_iter().chain(heat).flatten();
        let always = path.into_iter().chain(loads).chain(angles).chain(rest);
        always.chain(known).all(f64::is_finite)
    }

    /// The elements of the orbit that the vehicle would follow from here under the planet's
    /// [`orbital_gravitational_parameter`](Planet::orbital_gravitational_parameter) alone, and which of them are conventions; none for motion
    /// towards or away from the centre. The inertial frame is that from which the planet is turned by `sidereal_angle`, rad, at the start.
    pub fn orbital_elements(
        &self,
        planet: &Planet,
        sidereal_angle: f64,
    ) -> Option<(OrbitalElements, UndefinedElements)> {
        let state = self.flight_path.to_planet_fixed();
        let rotation = about_pole(sidereal_angle + planet.rotation_rate * self.time);
        let inertial = Inertial::from_planet_fixed_by(&state, planet, &rotation);
        OrbitalElements::from_inertial(&inertial, planet.orbital_gravitational_parameter).ok()
    }
}

/// An instant of a flight, and what holds then.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant {
    pub(crate) time: f64,
    pub(crate) state: State<f64>,
    /// The number of the phase.
    pub(crate) phase: usize,
    pub(crate) mode: ModelMode,
}

/// An event that happened, on both sides of its effect.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EventRecord {
    pub(crate) event: usize,
    pub(crate) before: Instant,
    pub(crate) after: Instant,
}

/// Parts that left the vehicle.
#[derive(Clone, Debug)]
pub(crate) struct SeparationRecord {
    /// The place of the event in the list.
    pub(crate) event: usize,
    /// The place of the separation in its effect.
    pub(crate) place: usize,
    /// The place of the case of the body.
    pub(crate) body: usize,
    /// s.
    pub(crate) time: f64,
    /// Of the body, after its push.
    pub(crate) state: PlanetFixed<f64>,
    /// What is left in each part, of all of its count together, kg.
    pub(crate) propellant: Vec<f64>,
}

/// A finished flight.
#[derive(Clone, Debug)]
pub struct Trajectory {
    pub(crate) case: Arc<Case>,
    pub(crate) flown: Flown,
    pub(crate) origin: Origin,
    /// Made when it is first needed.
    ground_track: OnceLock<GroundTrack>,
}

/// From where distances over the ground are measured.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Origin {
    /// On which the flight sets out.
    great_circle: GreatCircle,
    /// The initial position.
    position: Vector3<f64>,
}

impl Origin {
    /// That of a flight that starts in this state.
    pub(crate) fn of(start: &PlanetFixed<f64>) -> Self {
        Self { great_circle: GreatCircle::of(start), position: start.position }
    }
}

/// What a flight leaves behind.
#[derive(Clone, Debug)]
pub(crate) struct Flown {
    pub(crate) start: Instant,
    pub(crate) steps: Vec<StoredStep>,
    /// One more than there were events that changed anything.
    pub(crate) phases: Vec<Phase>,
    pub(crate) event_records: Vec<EventRecord>,
    pub(crate) separations: Vec<SeparationRecord>,
    /// Into which it would go on.
    pub(crate) end: Instant,
    pub(crate) arrival: Arrival,
    pub(crate) peaks: Peaks,
    /// Of the phases that last, and of that at the end, with their numbers.
    pub(crate) peaks_of_phases: Vec<(usize, Peaks)>,
    pub(crate) warnings: Vec<Warning>,
}

/// The motion inside a step of a flight.
pub(crate) struct InsideStep<'a> {
    flight: &'a Trajectory,
    step: &'a StoredStep,
    motion: Motion,
    interpolant: AnyInterpolant,
}

impl InsideStep<'_> {
    /// The point at a part of the step.
    pub(crate) fn point(&self, part: f64) -> FlightPoint {
        let Self { flight, step, motion, interpolant } = self;
        let time = step.time(part);
        flight.point(motion.forces(), step.phase, time, &interpolant.at(motion, time))
    }
}

impl Trajectory {
    pub(crate) fn new(case: Arc<Case>, flown: Flown) -> Self {
        let mut flight = Self::unexamined(case, flown);
        let ranges = flight.outside_ranges();
        flight.flown.warnings.extend(ranges);
        let faded = flight.wind_fades().map(|time| Warning::WindFadedNearPole { time });
        flight.flown.warnings.extend(faded);
        flight.flown.warnings.sort_by(|a, b| a.time().total_cmp(&b.time()));
        flight
    }

    /// The same without the warnings that are found on its steps.
    fn unexamined(case: Arc<Case>, flown: Flown) -> Self {
        let origin = Origin::of(case.track_start());
        Self { case, flown, origin, ground_track: OnceLock::new() }
    }

    /// For what the correlations of the heat flux were not made, at the peaks of their fluxes.
    fn outside_ranges(&self) -> Vec<Warning> {
        let (Some(heating), Some(peaks)) = (self.case.heating, self.peaks().heating) else { return Vec::new() };
        let nose_radius = self.case.vehicle.nose_radius.unwrap_or_default();
        let of_peak = |peak: Peak, range: heating::Range| {
            let Instant { time, state, phase, mode, .. } = self.instant_at(peak.time);
            let Loads { density, air_speed, .. } = self.forces(phase, mode).loads(time, &state);
            let quantities = [
                ("speed relative to the air", "m/s", air_speed, range.speed),
                ("density", "kg/m³", density, range.density),
                ("stagnation pressure", "Pa", density * air_speed * air_speed, range.pressure),
                ("nose radius", "m", nose_radius, range.nose_radius),
            ];
            let outside = |value: f64, [least, greatest]: [f64; 2]| value < least || value > greatest;
            let outside =
                quantities.into_iter().filter(move |(.., value, range)| peak.value > 0.0 && outside(*value, *range));
            outside.map(move |(quantity, unit, value, of)| {
                let (correlation, time) = (range.correlation, peak.time);
                Warning::OutsideRange { correlation, quantity, unit, value, range: of, time }
            })
        };
        let convective = of_peak(peaks.convective_heat_flux, heating.convective.range());
        convective.chain(of_peak(peaks.radiative_heat_flux, heating.radiative.range())).collect()
    }

    /// The end of the first step that ends where the wind has faded, s.
    fn wind_fades(&self) -> Option<f64> {
        let motion = match self.case.wind {
            Wind::Still => return None,
            Wind::Constant { .. } | Wind::Table(_) => self.motion(self.flown.steps.first()?),
        };
        let fades = |step: &&StoredStep| {
            let position = motion.end(&step.step).position;
            hypot(position.x, position.y) < WIND_FADE_ANGLE * position.norm()
        };
        self.flown.steps.iter().find(fades).map(StoredStep::end_time)
    }

    /// How the flight ended.
    pub fn termination(&self) -> Termination {
        self.flown.arrival.termination
    }

    /// The greatest values over the flight.
    pub fn peaks(&self) -> &Peaks {
        &self.flown.peaks
    }

    /// What the user should know.
    pub fn warnings(&self) -> &[Warning] {
        &self.flown.warnings
    }

    /// What the integration cost.
    pub fn statistics(&self) -> Statistics {
        self.flown.arrival.statistics
    }

    /// When the flight ended, s.
    pub fn end_time(&self) -> f64 {
        self.flown.arrival.time
    }

    /// How far along the initial great circle the flight ended, within half a turn either way, and how far to the right of it, m on the sphere
    /// with the equatorial radius; none where the flight starts vertically or at rest.
    pub(crate) fn range_of_end(&self) -> Option<[f64; 2]> {
        let range = self.origin.great_circle.along_and_across(&self.arrival().state.position)?;
        let sphere = self.case.forces().planet().equatorial_radius();
        Some(range.map(|angle| angle * sphere))
    }

    /// Where and how it ended.
    pub fn arrival(&self) -> &Arrival {
        &self.flown.arrival
    }

    /// The initial state, as given: before what happens at t = 0.
    pub fn initial(&self) -> FlightPoint {
        self.point_of(&self.flown.start)
    }

    /// The final state, after what happens then.
    pub fn last(&self) -> FlightPoint {
        self.point_of(&self.flown.end)
    }

    /// The events that happened, in order.
    pub fn events(&self) -> impl Iterator<Item = EventPoint> {
        let point = |record: &EventRecord| EventPoint {
            event: record.event,
            before: self.point_of(&record.before),
            after: self.point_of(&record.after),
        };
        self.flown.event_records.iter().map(point)
    }

    /// The propellant of a part at a point of the flight, of all of its count together, kg; none once it has left.
    pub fn propellant(&self, point: &FlightPoint, part: usize) -> Option<f64> {
        let phase = &self.flown.phases[point.phase];
        phase.parts.get(part)?.is_there.then(|| phase.propellant(part, point.time, point.mass))
    }

    /// The bytes that its steps take in memory.
    pub fn held(&self) -> usize {
        size_of_val(self.flown.steps.as_slice())
    }

    /// The state at a time, s; before the start it is the initial one, after the end the final one; at an event that after its effect.
    pub fn at(&self, time: f64) -> FlightPoint {
        self.point_of(&self.instant_at(time))
    }

    fn instant_at(&self, time: f64) -> Instant {
        let following = self.flown.steps.partition_point(|step| step.end_time() <= time);
        match self.flown.steps.get(following) {
            _ if time <= self.flown.start.time => self.flown.start,
            Some(step) => {
                let motion = self.motion(step);
                let state = motion.interpolant(&step.step).at(&motion, time);
                Instant { time, state, phase: step.phase, mode: step.mode }
            }
            None => self.flown.end,
        }
    }

    /// D/m, m/s², at a point of a flight of constant coefficients, of one phase.
    pub fn drag_deceleration(&self, point: &FlightPoint) -> f64 {
        self.forces(0, self.flown.start.mode).drag_under(point.loads.dynamic_pressure)
    }

    /// The states at ascending times, s.
    ///
    /// At loose tolerances the motion of a very light vehicle may overflow between the ends of a step: see [`FlightPoint::is_finite`].
    pub fn points(&self, times: &[f64]) -> Vec<FlightPoint> {
        let steps = &self.flown.steps;
        let mut following = times.first().map_or(0, |first| steps.partition_point(|step| step.end_time() <= *first));
        let mut known: Option<(usize, Motion, AnyInterpolant)> = None;
        let mut point = |time: f64| {
            while steps.get(following).is_some_and(|step| step.end_time() <= time) {
                following += 1;
            }
            match steps.get(following) {
                _ if time <= self.flown.start.time => self.initial(),
                Some(step) => {
                    let (_, motion, interpolant) = match known.take() {
                        Some(of_leg) if of_leg.0 == following => known.insert(of_leg),
                        last => {
                            let motion = last.map_or_else(
                                || self.motion(step),
                                |(index, motion, _)| self.going_on(motion, &steps[index], step),
                            );
                            let interpolant = motion.interpolant(&step.step);
                            known.insert((following, motion, interpolant))
                        }
                    };
                    self.point(motion.forces(), step.phase, time, &interpolant.at(motion, time))
                }
                None => self.last(),
            }
        };
        times.iter().map(|time| point(*time)).collect()
    }

    /// The motion inside a step.
    pub(crate) fn inside<'a>(&'a self, step: &'a StoredStep) -> InsideStep<'a> {
        let motion = self.motion(step);
        InsideStep { flight: self, step, interpolant: motion.interpolant(&step.step), motion }
    }

    /// The equations that were integrated in a step.
    pub(crate) fn motion(&self, step: &StoredStep) -> Motion {
        let forces = self.forces(step.phase, step.mode);
        match self.case.solver.equations {
            Equations::Cartesian => Motion::Cartesian(Cartesian(forces)),
            Equations::Spherical => Motion::Spherical(Spherical(forces)),
        }
    }

    /// The equations of a step that follows another, of which there are the equations.
    pub(crate) fn going_on(&self, mut motion: Motion, from: &StoredStep, to: &StoredStep) -> Motion {
        if from.phase != to.phase {
            return self.motion(to);
        }
        motion.forces_mut().enter(to.mode);
        motion
    }

    /// Measures the ground track, on which points rest; otherwise that is done when the first of them is asked for. Returns whether it was
    /// finished before `interrupt` was raised.
    pub fn measure_ground_track(&self, interrupt: &dyn Interrupt) -> bool {
        if self.ground_track.get().is_some() {
            return true;
        }
        let track = self.ground_track_until(|| interrupt.is_raised());
        track.is_some_and(|track| {
            self.ground_track.get_or_init(|| track);
            true
        })
    }

    /// The ground track, unless it is interrupted.
    fn ground_track_until(&self, is_interrupted: impl Fn() -> bool) -> Option<GroundTrack> {
        let mut track = GroundTrack::default();
        let mut known: Option<(Motion, &StoredStep)> = None;
        let mut state = self.flown.start.state.planet_fixed();
        for step in &self.flown.steps {
            if is_interrupted() {
                return None;
            }
            let motion = known.map_or_else(|| self.motion(step), |(motion, from)| self.going_on(motion, from, step));
            state = track.extend(&motion, step, &state, &self.origin.great_circle);
            known = Some((motion, step));
        }
        Some(track)
    }

    fn forces(&self, phase: usize, mode: ModelMode) -> Forces {
        let mut forces = self.flown.phases[phase].forces(&*self.case);
        forces.enter(mode);
        forces
    }

    fn point_of(&self, instant: &Instant) -> FlightPoint {
        let Instant { time, state, phase, mode } = instant;
        self.point(&self.forces(*phase, *mode), *phase, *time, state)
    }

    fn point(&self, forces: &Forces, phase: usize, time: f64, state: &State<f64>) -> FlightPoint {
        let point = self.point_from(&self.origin, forces, &self.flown.phases[phase], time, state);
        FlightPoint { phase, ..point }
    }

    /// The point of a state near the flight, which may have set out from another origin, and fly under other forces in another phase; its
    /// ground distance is that of the flight at the time.
    pub(crate) fn point_from(
        &self,
        origin: &Origin,
        forces: &Forces,
        phase: &Phase,
        time: f64,
        state: &State<f64>,
    ) -> FlightPoint {
        let planet = forces.planet();
        let planet_fixed = state.planet_fixed();
        let flight_path = FlightPath::from_planet_fixed(&planet_fixed).wrapped();
        let (geodetic_latitude, geodetic_altitude) = latitude_and_altitude(&state.position, &planet.shape);
        let AtmosphereSample { temperature, pressure, speed_of_sound, .. } = forces.air_at(time, state);
        let [bank_angle, angle_of_attack] = forces.angles(time, state);
        let inertial = Inertial::from_planet_fixed(&planet_fixed, planet, 0.0);
        let climb = inertial.position.dot(&inertial.velocity);
        let across = inertial.position.cross(&inertial.velocity).norm();
        let track = self.ground_track.get_or_init(|| self.ground_track_until(|| false).unwrap_or_default());
        let [length, near] = track.length_and_along(time);
        let range = origin.great_circle.along_and_across(&state.position).map(|[along, across]| {
            // A piece of the track is shorter than half a turn about the pole.
            [along + TAU * ((near - along) / TAU).round(), across]
        });
        let sphere = planet.equatorial_radius();
        let from = &origin.position;
        let [downrange, crossrange] = [0, 1].map(|part| range.map(|range| range[part] * sphere));
        let loads = forces.loads(time, state);
        let wall = forces.heating().zip(loads.heat_flux);
        let mass = state.mass.unwrap_or(phase.vehicle.mass);
        let [thrust, throttle] = forces.thrust_and_throttle(time, state, mass);
        let has_parts = !phase.parts.is_empty();
        FlightPoint {
            time,
            flight_path,
            geodetic_latitude,
            geodetic_altitude,
            loads,
            temperature,
            pressure,
            speed_of_sound,
            bank_angle,
            angle_of_attack,
            inertial_speed: inertial.velocity.norm(),
            inertial_flight_path_angle: atan2(climb, across),
            energy: planet.energy(&state.position, state.velocity.norm()),
            specific_energy: 0.5 * inertial.velocity.norm_squared() + planet.potential(&state.position),
            downrange,
            crossrange,
            // By the place itself, from which it is exactly 0 away.
            ground_range: atan2(from.cross(&state.position).norm(), from.dot(&state.position)) * sphere,
            ground_distance: length * sphere,
            mass,
            thrust: phase.thrust.map_or(thrust, |thrust| thrust.force.abs()),
            throttle: if has_parts { throttle * phase.throttle(time) } else { throttle },
            pitch: has_parts.then(|| forces.pitch(time, state)),
            phase: 0,
            heat_load: state.heat_load.filter(|_| forces.heating().is_some()),
            wall_temperature: wall.map(|(nose, flux)| nose.wall_temperature(flux.total())),
        }
    }
}
