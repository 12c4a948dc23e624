//! Rockets for the tests of parts and ascents, and an integration of their own: the classical method of Runge and Kutta with fixed steps, in an
//! inertial frame, with forces that share nothing with the core but the standard atmosphere.

use std::sync::atomic::AtomicBool;

use nalgebra::{Matrix3, Vector3};
use reentry::event::{Condition, Direction, Effect, Event, Quantity, Trigger};
use reentry::interpolation::Hint;
use reentry::part::{Engine, Part, ThrustEntry, ThrustProfile};
use reentry::planet::{Gravity, Shape, Zonal};
use reentry::scenario::{Case, Scenario, Stop};
use reentry::simulate::{Flights, simulate_with_bodies};
use reentry::steering::Steering;
use reentry::trajectory::FlightPoint;
use reentry::vehicle::{Aerodynamics, Vehicle};
use reentry::{Atmosphere, Planet, PlanetFixed};

/// m/s², by its definition.
pub(crate) const G0: f64 = 9.806_65;

/// A round planet that stands still.
pub(crate) fn still(radius: f64, gravitational_parameter: f64) -> Planet {
    Planet {
        shape: Shape::Sphere { radius },
        gravity: Gravity::InverseSquare,
        gravitational_parameter,
        orbital_gravitational_parameter: gravitational_parameter,
        rotation_rate: 0.0,
    }
}

/// The stage of the rocket equation: 200 kg and 800 kg of propellant, 30 kN, 300 s.
pub(crate) fn sounding_rocket() -> Part {
    stage(200.0, 800.0, 30e3, 300.0, 0.0)
}

/// The Earth with the flattening of its gravity.
pub(crate) fn earth() -> Planet {
    Planet { gravity: Gravity::Zonal(Zonal::EARTH.up_to(2)), ..Planet::EARTH_WGS84 }
}

/// A part that is carried.
pub(crate) fn load(dry_mass: f64) -> Part {
    Part { count: 1, dry_mass, propellant: 0.0, engine: None }
}

/// A part with a constant thrust.
pub(crate) fn stage(dry_mass: f64, propellant: f64, thrust: f64, specific_impulse: f64, exit_area: f64) -> Part {
    let engine = Engine { thrust: ThrustProfile::Constant(thrust), specific_impulse, exit_area };
    Part { count: 1, dry_mass, propellant, engine: Some(engine) }
}

/// A part whose thrust is given by time.
pub(crate) fn motor(dry_mass: f64, propellant: f64, thrust: &[(f64, f64)], specific_impulse: f64, area: f64) -> Part {
    let entries = thrust.iter().map(|(time, thrust)| ThrustEntry { time: *time, thrust: *thrust }).collect();
    let engine = Engine { thrust: ThrustProfile::Table(entries), specific_impulse, exit_area: area };
    Part { count: 1, dry_mass, propellant, engine: Some(engine) }
}

pub(crate) fn engine(part: &mut Part) -> &mut Engine {
    part.engine.as_mut().unwrap()
}

pub(crate) fn when(quantity: Quantity, value: f64, direction: Direction) -> Trigger {
    Condition { quantity, value, direction }.into()
}

pub(crate) fn rises(quantity: Quantity, value: f64) -> Trigger {
    when(quantity, value, Direction::Rising)
}

pub(crate) fn on(when: Trigger, then: Effect) -> Event {
    Event { when, then }
}

pub(crate) fn at(time: f64, then: Effect) -> Event {
    on(rises(Quantity::Time, time), then)
}

pub(crate) fn ignite(parts: &[usize]) -> Effect {
    Effect { ignite: parts.to_vec(), ..Effect::default() }
}

pub(crate) fn shut_down(parts: &[usize]) -> Effect {
    Effect { shut_down: parts.to_vec(), ..Effect::default() }
}

pub(crate) fn steer(steering: Steering) -> Effect {
    Effect { steer: Some(steering), ..Effect::default() }
}

/// Sets free what is held, as soon as it would rise.
pub(crate) fn lift_off() -> Event {
    on(rises(Quantity::UpwardAcceleration, 0.0), Effect { lift_off: true, ..Effect::default() })
}

/// The place of a planet's surface at a longitude and a geocentric latitude, rad.
pub(crate) fn pad(planet: &Planet, longitude: f64, latitude: f64) -> PlanetFixed<f64> {
    let up = Vector3::new(latitude.cos() * longitude.cos(), latitude.cos() * longitude.sin(), latitude.sin());
    let radius = planet.shape.surface_radius(latitude.sin(), latitude.cos());
    PlanetFixed { position: up * radius, velocity: Vector3::zeros() }
}

/// A vehicle of parts at rest on the surface of a planet, with nothing that happens; with drag in standard air.
pub(crate) fn vehicle_of(planet: Planet, parts: Vec<Part>) -> Case {
    let mass = parts.iter().map(Part::mass).sum();
    let aerodynamics = Aerodynamics::Constant { lift_coefficient: 0.0, drag_coefficient: 0.4 };
    let vehicle = Vehicle { mass, reference_area: 1.2, aerodynamics, nose_radius: None };
    let start = pad(&planet, -1.4, 0.5);
    Case {
        planet,
        atmosphere: Atmosphere::Us76,
        parts,
        steering: Steering::Vertical,
        hold_down: true,
        stop: Stop { time: 2000.0, ..Stop::default() },
        ..Case::new(vehicle, start)
    }
}

/// The case with the mass of its parts, which may have changed.
pub(crate) fn weighed(case: Case) -> Case {
    let mass = case.parts.iter().map(Part::mass).sum();
    Case { vehicle: Vehicle { mass, ..case.vehicle }, ..case }
}

#[track_caller]
pub(crate) fn fly_all(case: &Case) -> Flights {
    let scenario = Scenario::new(case.clone()).unwrap_or_else(|error| panic!("{error} in {case:?}"));
    simulate_with_bodies(&scenario, &AtomicBool::new(false)).unwrap_or_else(|error| panic!("{error} in {case:?}"))
}

/// North, east and up at a place, by the geocentric latitude.
pub(crate) fn local_axes(position: &Vector3<f64>) -> [Vector3<f64>; 3] {
    let up = position.normalize();
    let east = Vector3::z().cross(&up).normalize();
    [up.cross(&east), east, up]
}

/// The axes of a launch: ahead by an azimuth, to the left, and up along the normal of the ellipsoid.
pub(crate) fn launch_axes(planet: &Planet, place: &Vector3<f64>, azimuth: f64) -> Matrix3<f64> {
    let (a, b) = planet.shape.semi_axes();
    let up = Vector3::new(place.x / (a * a), place.y / (a * a), place.z / (b * b)).normalize();
    let east = Vector3::z().cross(&up).normalize();
    let north = up.cross(&east);
    let ahead = north * azimuth.cos() + east * azimuth.sin();
    Matrix3::from_columns(&[ahead, up.cross(&ahead), up])
}

/// Of an engine that is lit: thrust in vacuum by the time, N, throttled; the mass flow of a unit of it; its exit area.
pub(crate) struct Flame<'a> {
    pub(crate) thrust: &'a dyn Fn(f64) -> f64,
    pub(crate) specific_impulse: f64,
    pub(crate) exit_area: f64,
}

/// A time, and position, velocity and mass in inertial space, whose axes are those of the planet at t = 0.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Inertial {
    pub(crate) time: f64,
    pub(crate) position: Vector3<f64>,
    pub(crate) velocity: Vector3<f64>,
    pub(crate) mass: f64,
}

/// The velocity; the acceleration, and the mass flow.
type Rates = (Vector3<f64>, (Vector3<f64>, f64));

/// What a vehicle is subject to between two discontinuities.
pub(crate) struct Rocket<'a> {
    pub(crate) planet: Planet,
    pub(crate) flames: Vec<Flame<'a>>,
    /// In inertial space.
    pub(crate) axis: &'a dyn Fn(&Inertial) -> Vector3<f64>,
    /// m².
    pub(crate) area: f64,
    /// Lift and drag by angle of attack and Mach number.
    pub(crate) coefficients: &'a dyn Fn(f64, f64) -> [f64; 2],
    /// To the east and to the north, m/s.
    pub(crate) wind: [f64; 2],
    /// In units of standard gravity.
    pub(crate) load_limit: Option<f64>,
}

impl Inertial {
    pub(crate) fn of(start: &PlanetFixed<f64>, planet: &Planet, time: f64, mass: f64) -> Self {
        let still = Self { time, position: start.position, velocity: start.velocity, mass };
        let spin = Vector3::z() * planet.rotation_rate;
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), planet.rotation_rate * time);
        let velocity = turn * (start.velocity + spin.cross(&start.position));
        Self { position: turn * start.position, velocity, ..still }
    }

    pub(crate) fn planet_fixed(&self, planet: &Planet) -> PlanetFixed<f64> {
        let spin = Vector3::z() * planet.rotation_rate;
        let turn = nalgebra::Rotation3::from_axis_angle(&Vector3::z_axis(), -planet.rotation_rate * self.time);
        PlanetFixed { position: turn * self.position, velocity: turn * self.relative(&spin) }
    }

    fn relative(&self, spin: &Vector3<f64>) -> Vector3<f64> {
        self.velocity - spin.cross(&self.position)
    }

    /// Relative to the planet.
    pub(crate) fn over_ground(&self, planet: &Planet) -> Vector3<f64> {
        self.relative(&(Vector3::z() * planet.rotation_rate))
    }

    pub(crate) fn altitude(&self, planet: &Planet) -> f64 {
        altitude(planet, &self.position)
    }
}

/// Above the surface along the radius vector.
fn altitude(planet: &Planet, position: &Vector3<f64>) -> f64 {
    let (a, b) = planet.shape.semi_axes();
    let up = position.normalize();
    position.norm() - ((up.x * up.x + up.y * up.y) / (a * a) + up.z * up.z / (b * b)).powf(-0.5)
}

/// The outward normal of an ellipsoid below a place.
pub(crate) fn normal(planet: &Planet, position: &Vector3<f64>) -> Vector3<f64> {
    let (a, b) = planet.shape.semi_axes();
    Vector3::new(position.x / (a * a), position.y / (a * a), position.z / (b * b)).normalize()
}

/// By its potential, of which J₂ alone is in it.
pub(crate) fn gravity(planet: &Planet, position: &Vector3<f64>) -> Vector3<f64> {
    let j2 = match planet.gravity {
        Gravity::InverseSquare => 0.0,
        Gravity::Zonal(Zonal { coefficients: [j2, ..] }) => j2,
    };
    let [radius, mu] = [position.norm(), planet.gravitational_parameter];
    let part = 1.5 * j2 * (planet.equatorial_radius() / radius).powi(2);
    let polar = 5.0 * (position.z / radius).powi(2);
    let [level, along] = [1.0 + part * (1.0 - polar), 1.0 + part * (3.0 - polar)];
    -Vector3::new(position.x * level, position.y * level, position.z * along) * (mu / radius.powi(3))
}

/// Density, pressure and speed of sound.
pub(crate) fn standard_air(altitude: f64) -> [f64; 3] {
    let air = Atmosphere::Us76;
    let segment = air.boundaries().iter().filter(|boundary| **boundary <= altitude).count();
    let sample = air.sample(segment, altitude, &Hint::default());
    [sample.density, sample.pressure.unwrap(), sample.speed_of_sound.unwrap()]
}

impl Rocket<'_> {
    /// The acceleration and the mass flow.
    fn rates(&self, now: &Inertial) -> (Vector3<f64>, f64) {
        let planet = &self.planet;
        let [north, east, _] = local_axes(&now.position);
        let air_velocity = now.over_ground(planet) - east * self.wind[0] - north * self.wind[1];
        let [density, pressure, sound] = standard_air(altitude(planet, &now.position));
        let (speed, axis) = (air_velocity.norm(), (self.axis)(now));
        let mut aerodynamic = Vector3::zeros();
        if speed > 0.0 {
            let ahead = air_velocity / speed;
            let across = axis - ahead * axis.dot(&ahead);
            let angle = across.norm().atan2(axis.dot(&ahead));
            let [lift, drag] = (self.coefficients)(angle, speed / sound);
            let per_coefficient = 0.5 * density * speed * speed * self.area;
            aerodynamic = (across.try_normalize(1e-12).unwrap_or_default() * lift - ahead * drag) * per_coefficient;
        }
        let full: f64 = self.flames.iter().map(|flame| (flame.thrust)(now.time)).sum();
        let lost: f64 = pressure * self.flames.iter().map(|flame| flame.exit_area).sum::<f64>();
        let felt = |throttle: f64| (aerodynamic + axis * (throttle * full - lost)).norm() / (now.mass * G0);
        let throttle = match self.load_limit {
            Some(limit) if felt(1.0) > limit => {
                // By halving, between none and all.
                let (mut least, mut most) = (0.0, 1.0);
                for _ in 0..60 {
                    let middle = 0.5 * (least + most);
                    *(if felt(middle) > limit { &mut most } else { &mut least }) = middle;
                }
                least
            }
            _ => 1.0,
        };
        let flow = |flame: &Flame| (flame.thrust)(now.time) * throttle / (flame.specific_impulse * G0);
        let force = aerodynamic + axis * (throttle * full - lost);
        (force / now.mass + gravity(planet, &now.position), self.flames.iter().map(flow).sum())
    }

    /// The state a time later, by one step.
    fn step(&self, now: &Inertial, length: f64) -> Inertial {
        let ahead = |(velocity, (acceleration, flow)): &Rates, part: f64| Inertial {
            time: now.time + part * length,
            position: now.position + velocity * (part * length),
            velocity: now.velocity + acceleration * (part * length),
            mass: now.mass - flow * (part * length),
        };
        let rates = |state: &Inertial| (state.velocity, self.rates(state));
        // A step sees the thrust as it is inside of it.
        let inside = |state: Inertial, part: f64| Inertial { time: now.time + part * length, ..state };
        let first = rates(&inside(*now, 1e-9));
        let second = rates(&ahead(&first, 0.5));
        let third = rates(&ahead(&second, 0.5));
        let fourth = rates(&inside(ahead(&third, 1.0), 1.0 - 1e-9));
        let all = [(&first, 1.0), (&second, 2.0), (&third, 2.0), (&fourth, 1.0)];
        let sum = |of: &dyn Fn(&Rates) -> Vector3<f64>| {
            all.iter().fold(Vector3::zeros(), |sum, (rates, weight)| sum + of(rates) * (weight / 6.0))
        };
        let flow: f64 = all.iter().map(|(rates, weight)| rates.1.1 * weight / 6.0).sum();
        Inertial {
            time: now.time + length,
            position: now.position + sum(&|rates| rates.0) * length,
            velocity: now.velocity + sum(&|rates| rates.1.0) * length,
            mass: now.mass - flow * length,
        }
    }

    /// The state at a time, by steps of no more than a length, s.
    pub(crate) fn until(&self, now: &Inertial, time: f64, length: f64) -> Inertial {
        let steps = ((time - now.time) / length).ceil().max(1.0);
        let (mut state, start, step) = (*now, now.time, (time - now.time) / steps);
        let mut count = 0.0;
        while count < steps {
            state = self.step(&state, step);
            count += 1.0;
            state.time = start + step * count;
        }
        state
    }

    /// The first state at which a function rises to zero, by steps of a length, s, of which the last is halved into.
    pub(crate) fn until_zero(&self, now: &Inertial, of: &dyn Fn(&Inertial) -> f64, length: f64) -> Inertial {
        let mut state = *now;
        loop {
            let next = self.step(&state, length);
            if of(&next) >= 0.0 {
                let (mut least, mut most) = (0.0, length);
                for _ in 0..50 {
                    let middle = 0.5 * (least + most);
                    *(if of(&self.step(&state, middle)) < 0.0 { &mut least } else { &mut most }) = middle;
                }
                return self.step(&state, most);
            }
            state = next;
            assert!(state.time < 2000.0, "it never comes to zero");
        }
    }
}

/// By how much the place of a point of a flight differs from a state, m.
pub(crate) fn miss(point: &FlightPoint, state: &Inertial, planet: &Planet) -> f64 {
    (point.flight_path.to_planet_fixed().position - state.planet_fixed(planet).position).norm()
}
