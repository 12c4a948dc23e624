//! The equations of motion: the forces, gathered once, and the two formulations that integrate them.

mod cartesian;
mod regime;
mod spherical;

pub use cartesian::Cartesian;
pub use regime::{Lookup, Regime, Switch};
pub use spherical::Spherical;

pub(crate) use regime::{Chatter, Quantity};

use nalgebra::Vector3;
use num_dual::Dual64;

use crate::atmosphere::{Atmosphere, AtmosphereSample};
use crate::control::{Against, Command, Control};
use crate::coordinates::PlanetFixed;
use crate::integrate::Pace;
use crate::interpolation::Hint;
use crate::planet::{Gravity, Planet, Pull};
use crate::scalar::{Over, Scalar, length, reciprocal_or_one};
use crate::vehicle::{Aerodynamics, Coefficients};
use crate::wind::Wind;

/// The unit of the load factor, m/s²: the standard acceleration of gravity (3rd CGPM, 1901).
pub const STANDARD_GRAVITY: f64 = 9.806_65;

/// Within this angle of the vertical the lift fades out, rad: in vertical flight the bank angle has no meaning.
pub const LIFT_FADE_ANGLE: f64 = 1e-3;

/// Scale heights that a step may fall; see [`Forces::longest_step`].
const SCALE_HEIGHTS_A_STEP: f64 = 10.0;
/// Times of drag that a step may last; see [`Forces::longest_step`].
const DRAG_TIMES_A_STEP: f64 = 1.5;

/// What acts on the vehicle; the parameters may carry derivatives, or belong to several vehicles side by side.
#[derive(Clone, Debug)]
pub struct Forces<P = f64> {
    models: Models,
    parameters: Parameters<P>,
    area_over_mass: P,
    sin_cos_bank: (P, P),
    regime: Regime,
    has_switches: bool,
    /// Whether all models are those of the thesis. Functions with a constant `THESIS` know it when they are compiled, so that what
    /// a case does not use does not cost it a tenth of its time.
    of_thesis: bool,
    /// Whether coefficients or angles depend on the Mach number.
    by_mach: bool,
    cells: Cells,
}

/// Where the tables were last looked at.
#[derive(Clone, Debug, Default)]
struct Cells {
    atmosphere: Hint,
    wind: Hint,
    angle_of_attack_and_mach: [Hint; 2],
}

/// What all vehicles side by side have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Models {
    /// Where they fly.
    pub planet: Planet,
    /// The air, which turns with the planet.
    pub atmosphere: Atmosphere,
    /// How the air moves against the planet.
    pub wind: Wind,
    /// The coefficients.
    pub aerodynamics: Aerodynamics,
    /// The angles at which the vehicle flies.
    pub control: Control,
}

/// The numbers that may vary, beside the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<P> {
    /// kg.
    pub mass: P,
    /// m².
    pub reference_area: P,
    /// `C_L` less that of the model.
    pub lift_coefficient: P,
    /// `C_D` less that of the model.
    pub drag_coefficient: P,
    /// The density over that of the model.
    pub density: P,
    /// σ less that of the model, rad.
    pub bank_angle: P,
}

/// What the air does to the vehicle at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads<S> {
    /// Along the radius vector, above the surface, m.
    pub altitude: S,
    /// kg/m³.
    pub density: S,
    /// Relative to the air, m/s.
    pub air_speed: S,
    /// The speed relative to the air over that of sound; none where the atmosphere has no temperature.
    pub mach: Option<S>,
    /// ½ρV² of the speed relative to the air, Pa.
    pub dynamic_pressure: S,
    /// -dV/dt of the relative speed, m/s²; at rest minus the magnitude of the acceleration.
    pub deceleration: S,
    /// The aerodynamic force over the weight at standard gravity.
    pub load_factor: S,
}

/// A formulation: six numbers that hold the state, and how they change.
pub trait Formulation: Pace<6> {
    /// The six numbers of a state.
    fn coordinates<S: Scalar>(state: &PlanetFixed<S>) -> [S; 6];

    /// The state of six numbers.
    fn planet_fixed<S: Scalar>(coordinates: &[S; 6]) -> PlanetFixed<S>;

    /// The singularity of the equations that lies `within` this distance of a state: rad, or parts of the circular speed.
    fn singularity(&self, coordinates: &[f64; 6], within: f64) -> Option<Singularity>;

    /// The forces in its equations.
    fn forces(&self) -> &Forces;

    /// The forces in its equations.
    fn forces_mut(&mut self) -> &mut Forces;
}

/// Where the spherical equations divide by zero.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Singularity {
    /// cos φ = 0.
    Pole,
    /// cos γ = 0.
    VerticalFlight,
    /// V = 0.
    Rest,
}

/// The air as it meets the vehicle.
struct Flow<S: nalgebra::Scalar> {
    /// Along the radius vector, m.
    altitude: S,
    /// Of the position, and of the velocity relative to the air.
    directions: Directions<S>,
    /// Relative to the planet, m/s.
    ground_speed: S,
    /// The density over that of the parameters, kg/m³, and the Mach number, where something depends on it.
    density_and_mach: Option<(S, S)>,
}

/// What a unit of density does to the vehicle, at full lift: accelerations over the density, m⁴/(kg s²).
struct Air<S> {
    /// D/(m ρ), against the velocity.
    drag: S,
    /// L/(m ρ), across the velocity.
    lift: S,
}

impl<P: Scalar> Forces<P> {
    /// The forces by these models, with these parameters.
    pub fn new(models: Models, parameters: Parameters<P>) -> Self {
        let area_over_mass = parameters.reference_area * parameters.mass.recip();
        let sin_cos_bank = parameters.bank_angle.sin_cos();
        let by_mach = models.depend_on_mach();
        let of_thesis = models.are_of_thesis();
        let (regime, has_switches, cells) = (Regime::default(), false, Cells::default());
        let mut forces =
            Self { models, parameters, area_over_mass, sin_cos_bank, regime, has_switches, of_thesis, by_mach, cells };
        forces.has_switches = Switch::ALL.into_iter().any(|switch| forces.boundaries(switch).is_some());
        forces
    }

    /// The acceleration relative to the rotating planet, m/s².
    ///
    /// ```text
    /// dv/dt = g(r) + (D + L)/m - 2 ω×v - ω×(ω×r)
    /// ```
    ///
    /// # Reference
    /// Jameson 2006, equations 17 and 21 to 23, without the step to the vehicle-pointing axes.
    #[inline(always)]
    pub fn acceleration<S: Over<P>>(&self, time: S, state: &PlanetFixed<S>) -> Vector3<S> {
        if self.of_thesis {
            self.acceleration_by::<true, S>(time, state)
        } else {
            self.acceleration_by_any(time, state)
        }
    }

    /// Not inlined: the models that the thesis does not have would be in the way of those that it has.
    #[inline(never)]
    fn acceleration_by_any<S: Over<P>>(&self, time: S, state: &PlanetFixed<S>) -> Vector3<S> {
        self.acceleration_by::<false, S>(time, state)
    }

    #[inline(always)]
    fn acceleration_by<const THESIS: bool, S: Over<P>>(&self, time: S, state: &PlanetFixed<S>) -> Vector3<S> {
        let PlanetFixed { position, velocity } = state;
        let flow = self.flow::<THESIS, _>(state);
        let rotation = self.models.planet.rotation_rate;
        let centrifugal = rotation * rotation;
        let Directions { radius, up, .. } = &flow.directions;
        let planet = &self.models.planet;
        let mut fall = if THESIS { planet.gravity_of_point(*radius, up) } else { planet.gravity(*radius, up) };
        fall.x += velocity.y * (2.0 * rotation) + position.x * centrifugal;
        fall.y += velocity.x * (-2.0 * rotation) + position.y * centrifugal;
        self.aerodynamic::<THESIS, _>(time, &flow) + fall
    }

    /// Lift and drag over the mass, m/s².
    ///
    /// ```text
    /// D = -½ ρ V² S C_D v̂,   L = ½ ρ V² S C_L (cos σ n̂ + sin σ b̂),   n̂ = unit(r̂ - (r̂·v̂) v̂),   b̂ = n̂ × v̂
    /// ```
    ///
    /// with the velocity relative to the air.
    ///
    /// # Reference
    /// Jameson 2006, equations 22, 36 and 37.
    #[inline(always)]
    fn aerodynamic<const THESIS: bool, S: Over<P>>(&self, time: S, flow: &Flow<S>) -> Vector3<S> {
        let Directions { up, ahead, left, cos_gamma, .. } = &flow.directions;
        let air = self.air::<THESIS, _>(time, flow);
        let lift = air.lift * lift_fade_over_cosine(*cos_gamma);
        let (sin_bank, cos_bank) = self.sin_cos_bank::<THESIS, _>(time, flow);
        let (lift_left, lift_up) = (lift * sin_bank, lift * cos_bank);
        let against = air.drag + lift_up * up.dot(ahead);
        // The density, an exponential, is what all else would wait for.
        let density = self.density::<THESIS, _>(flow);
        Vector3::from_fn(|i, _| (up[i] * lift_up + left[i] * lift_left - ahead[i] * against) * density)
    }

    /// The air that meets a vehicle in a state.
    #[inline(always)]
    fn flow<const THESIS: bool, S: Over<P>>(&self, state: &PlanetFixed<S>) -> Flow<S> {
        let PlanetFixed { position, velocity } = state;
        let altitude = self.models.planet.shape.altitude(position);
        match self.wind::<THESIS, _>(altitude) {
            None => {
                let directions = Directions::of(position, velocity);
                let ground_speed = directions.speed;
                self.flow_of::<THESIS, _>(altitude, directions, ground_speed)
            }
            Some([east, north]) => {
                let [x, y, z] = [position.x, position.y, position.z];
                // ẑ × r, of the length of the distance from the axis; at the poles, where there is no east, there is no wind.
                let over_equatorial = reciprocal_or_one((x * x + y * y).sqrt());
                let over_radius = reciprocal_or_one(length(position));
                let east = Vector3::new(-y, x, S::zero()) * (over_equatorial * east);
                let to_north = Vector3::new(-x * z, -y * z, x * x + y * y);
                let north = to_north * (over_equatorial * over_radius * north);
                let directions = Directions::of(position, &(velocity - east - north));
                self.flow_of::<THESIS, _>(altitude, directions, length(velocity))
            }
        }
    }

    /// The air at an altitude, m, that meets a vehicle in the directions of its velocity relative to the air, at a speed relative to
    /// the planet, m/s.
    #[inline(always)]
    fn flow_of<const THESIS: bool, S: Over<P>>(
        &self,
        altitude: S,
        directions: Directions<S>,
        ground_speed: S,
    ) -> Flow<S> {
        let density_and_mach = (!THESIS && self.by_mach).then(|| {
            let (density, sound) = self.models.atmosphere.density_and_sound(
                self.regime.of(Switch::Atmosphere),
                altitude,
                &self.cells.atmosphere,
            );
            (density, directions.speed * sound.recip())
        });
        Flow { altitude, directions, ground_speed, density_and_mach }
    }

    /// The wind at an altitude, m, to the east and to the north, m/s.
    #[inline(always)]
    fn wind<const THESIS: bool, S: Over<P>>(&self, altitude: S) -> Option<[S; 2]> {
        match &self.models.wind {
            _ if THESIS => None,
            Wind::Still => None,
            Wind::Constant { east, north } => Some([S::from(*east), S::from(*north)]),
            Wind::Table(table) => Some(table.velocity(self.regime.of(Switch::Wind), altitude, &self.cells.wind)),
        }
    }

    /// ρ, kg/m³.
    #[inline(always)]
    fn density<const THESIS: bool, S: Over<P>>(&self, flow: &Flow<S>) -> S {
        let of_model = match flow.density_and_mach {
            Some((density, _)) => density,
            None => self.models.atmosphere.density(
                self.regime.of(Switch::Atmosphere),
                flow.altitude,
                &self.cells.atmosphere,
            ),
        };
        of_model * self.parameters.density
    }

    /// What the air does to the vehicle.
    #[inline(always)]
    fn air<const THESIS: bool, S: Over<P>>(&self, time: S, flow: &Flow<S>) -> Air<S> {
        let speed = flow.directions.speed;
        let acceleration = speed * speed * 0.5 * self.area_over_mass;
        let Parameters { lift_coefficient, drag_coefficient, .. } = self.parameters;
        match self.coefficients::<THESIS, _>(time, flow) {
            None => Air { drag: acceleration * drag_coefficient, lift: acceleration * lift_coefficient },
            Some(Coefficients { lift, drag }) => {
                Air { drag: acceleration * (drag + drag_coefficient), lift: acceleration * (lift + lift_coefficient) }
            }
        }
    }

    /// The coefficients of the model, if they are not all in the parameters.
    #[inline(always)]
    fn coefficients<const THESIS: bool, S: Over<P>>(&self, time: S, flow: &Flow<S>) -> Option<Coefficients<S>> {
        let cells = &self.cells.angle_of_attack_and_mach;
        let [alpha, mach] = [Switch::TableAngleOfAttack, Switch::Mach].map(|switch| self.regime.of(switch));
        match &self.models.aerodynamics {
            _ if THESIS => None,
            Aerodynamics::Constant { .. } | Aerodynamics::Ballistic { .. } => None,
            Aerodynamics::MachTable(table) => Some(table.coefficients(mach, flow.mach(), &cells[1])),
            Aerodynamics::AlphaMachTable(table) => {
                Some(table.coefficients([alpha, mach], self.angle_of_attack(time, flow), flow.mach(), cells))
            }
        }
    }

    /// Sine and cosine of σ.
    #[inline(always)]
    fn sin_cos_bank<const THESIS: bool, S: Over<P>>(&self, time: S, flow: &Flow<S>) -> (S, S) {
        match &self.models.control.bank_angle {
            Command::Schedule(_) if !THESIS => self.bank_angle(time, flow).sin_cos(),
            _ => {
                let (sin_bank, cos_bank) = self.sin_cos_bank;
                (S::zero() + sin_bank, S::zero() + cos_bank)
            }
        }
    }

    /// σ, rad.
    #[inline(always)]
    fn bank_angle<S: Over<P>>(&self, time: S, flow: &Flow<S>) -> S {
        flow.angle(&self.models.control.bank_angle, self.regime.of(Switch::BankAngle), time)
            + self.parameters.bank_angle
    }

    /// α, rad.
    #[inline(always)]
    fn angle_of_attack<S: Over<P>>(&self, time: S, flow: &Flow<S>) -> S {
        flow.angle(&self.models.control.angle_of_attack, self.regime.of(Switch::AngleOfAttack), time)
    }
}

impl Models {
    /// Whether the thesis knows them all.
    fn are_of_thesis(&self) -> bool {
        matches!(
            self,
            Self {
                planet: Planet { gravity: Gravity::InverseSquare, .. },
                atmosphere: Atmosphere::Exponential { .. },
                wind: Wind::Still,
                aerodynamics: Aerodynamics::Constant { .. },
                control: Control { bank_angle: Command::Constant(_), angle_of_attack: Command::Constant(_) },
            }
        )
    }

    /// Whether coefficients or angles depend on the Mach number.
    fn depend_on_mach(&self) -> bool {
        let Control { bank_angle, angle_of_attack } = &self.control;
        self.aerodynamics.is_by_mach() || bank_angle.is_by_mach() || angle_of_attack.is_by_mach()
    }
}

impl<S: Scalar> Flow<S> {
    /// The Mach number, where something depends on it.
    #[inline(always)]
    fn mach(&self) -> S {
        self.density_and_mach.map_or(S::zero(), |(_, mach)| mach)
    }

    /// An angle, rad, by the formula of a stretch of its schedule.
    #[inline(always)]
    fn angle(&self, command: &Command, stretch: usize, time: S) -> S {
        match command {
            Command::Constant(angle) => S::from(*angle),
            Command::Schedule(schedule) => schedule.angle(stretch, self.quantity(schedule.against(), time)),
        }
    }

    /// What a schedule may run along.
    #[inline(always)]
    fn quantity(&self, against: Against, time: S) -> S {
        match against {
            Against::Time => time,
            Against::Altitude => self.altitude,
            Against::Speed => self.ground_speed,
            Against::Mach => self.mach(),
        }
    }
}

impl Forces {
    /// Where it flies.
    pub fn planet(&self) -> &Planet {
        &self.models.planet
    }

    /// The units of length, m, and speed, m/s, in which the equations are of order one: r₀ and √(g₀r₀).
    fn units(&self) -> [f64; 2] {
        let length = self.models.planet.equatorial_radius();
        [length, (self.models.planet.gravitational_parameter / length).sqrt()]
    }

    /// The longest step that may start in a state, s.
    ///
    /// From space an integrator sees no air, and a long step would jump over the whole atmosphere.
    /// A step ends at the latest when the vehicle, at its present vertical speed and acceleration, has fallen half the way
    /// to the sensible atmosphere and some scale heights more.
    /// In the air it ends within a few times of drag, V/(D/m): where the motion is stiff, an explicit method is stable no longer,
    /// and at loose tolerances its dense output leaves all bounds before the ends of its steps do.
    fn longest_step(&self, time: f64, state: &PlanetFixed<f64>) -> f64 {
        let PlanetFixed { position, velocity } = state;
        let flow = self.flow::<false, _>(state);
        let radius = length(position);
        let to_air = (flow.altitude - self.models.atmosphere.sensible_altitude()).max(0.0);
        let depth = 0.5 * to_air + SCALE_HEIGHTS_A_STEP * self.models.atmosphere.scale_height();
        let rise = position.dot(velocity) / radius;
        let inertial = velocity + Vector3::z().cross(position) * self.models.planet.rotation_rate;
        let level_squared = inertial.norm_squared() - rise * rise;
        let fall = (self.models.planet.point_gravity(radius) - level_squared / radius).max(0.0);
        // The positive root of rise t - fall t²/2 = -depth.
        let root = (rise * rise + 2.0 * fall * depth).sqrt();
        let through_air = if rise > 0.0 { (rise + root) / fall } else { 2.0 * depth / (root - rise) };

        let air = self.air::<false, _>(time, &flow);
        let drag_time = flow.directions.speed / (air.drag.max(air.lift.abs()) * self.density::<false, _>(&flow));
        if drag_time.is_nan() { through_air } else { through_air.min(DRAG_TIMES_A_STEP * drag_time) }
    }

    /// The power that lift and drag take from the vehicle, over its mass, W/kg.
    pub(crate) fn power_lost(&self, time: f64, state: &PlanetFixed<f64>) -> f64 {
        -self.aerodynamic::<false, _>(time, &self.flow::<false, _>(state)).dot(&state.velocity)
    }

    /// D/m, m/s², of constant coefficients under a dynamic pressure, Pa.
    pub(crate) fn drag_under(&self, dynamic_pressure: f64) -> f64 {
        dynamic_pressure * self.area_over_mass * self.parameters.drag_coefficient
    }

    /// The loads in a state.
    pub fn loads<S: Over<f64> + Scalar<Mask = bool>>(&self, time: S, state: &PlanetFixed<S>) -> Loads<S> {
        let PlanetFixed { position, velocity } = state;
        let mut flow = self.flow::<false, _>(state);
        if flow.density_and_mach.is_none() && self.models.atmosphere.has_temperature() {
            let (density, sound) = self.models.atmosphere.density_and_sound(
                self.regime.of(Switch::Atmosphere),
                flow.altitude,
                &self.cells.atmosphere,
            );
            flow.density_and_mach = Some((density, flow.directions.speed * sound.recip()));
        }
        let Directions { radius, speed, up, ahead, cos_gamma, .. } = &flow.directions;
        let density = self.density::<false, _>(&flow);
        let dynamic_pressure = density * *speed * *speed * 0.5;
        let air = self.air::<false, _>(time, &flow);
        let deceleration = if flow.ground_speed.less_than(f64::MIN_POSITIVE) {
            -length(&self.acceleration(time, state))
        } else if matches!(self.models.wind, Wind::Still) {
            // -V̇ = D/m + g sin γ - ω² (x v̂_x + y v̂_y): lift and the Coriolis force are across the velocity   (29)
            let outward = position.x * ahead.x + position.y * ahead.y;
            let Pull { inward, axial } = self.models.planet.pull(*radius, up.z);
            air.drag * density + (inward * up.dot(ahead) + axial * ahead.z)
                - outward * self.models.planet.rotation_rate.powi(2)
        } else {
            -self.acceleration(time, state).dot(velocity) * flow.ground_speed.recip()
        };
        // Accelerations by a unit of dynamic pressure: the squares of those of tiny forces would vanish.
        let (lift_coefficient, drag_coefficient) = self.lift_and_drag_coefficient(time, &flow);
        let lift_coefficient = lift_coefficient * (lift_fade_over_cosine(*cos_gamma) * *cos_gamma);
        let coefficient = (lift_coefficient * lift_coefficient + drag_coefficient * drag_coefficient).sqrt();
        let load_factor = dynamic_pressure * coefficient * (self.area_over_mass / STANDARD_GRAVITY);
        let mach = flow.density_and_mach.map(|(_, mach)| mach);
        Loads { altitude: flow.altitude, density, air_speed: *speed, mach, dynamic_pressure, deceleration, load_factor }
    }

    fn lift_and_drag_coefficient<S: Over<f64>>(&self, time: S, flow: &Flow<S>) -> (S, S) {
        let Parameters { lift_coefficient, drag_coefficient, .. } = self.parameters;
        let Coefficients { lift, drag } =
            self.coefficients::<false, _>(time, flow).unwrap_or(Coefficients { lift: S::zero(), drag: S::zero() });
        (lift + lift_coefficient, drag + drag_coefficient)
    }

    /// cos²γ of the velocity relative to the air, the squared sine of its angle to the radius; 0 at rest.
    pub fn cos_squared_angle_to_air<S: Over<f64>>(&self, state: &PlanetFixed<S>) -> S {
        let left = self.flow::<false, _>(state).directions.left;
        left.dot(&left)
    }

    /// The angles at which the vehicle flies in a state: σ and α, rad.
    pub fn angles(&self, time: f64, state: &PlanetFixed<f64>) -> [f64; 2] {
        let flow = self.flow::<false, _>(state);
        [self.bank_angle(time, &flow), self.angle_of_attack(time, &flow)]
    }

    /// The air in a state, as far as the atmosphere knows it.
    pub fn air_at(&self, state: &PlanetFixed<f64>) -> AtmosphereSample<f64> {
        let altitude = self.models.planet.shape.altitude(&state.position);
        let sample =
            self.models.atmosphere.sample(self.regime.of(Switch::Atmosphere), altitude, &self.cells.atmosphere);
        // By the law of gases, denser air of the same temperature presses harder.
        let factor = self.parameters.density;
        AtmosphereSample {
            density: sample.density * factor,
            pressure: sample.pressure.map(|pressure| pressure * factor),
            ..sample
        }
    }
}

/// Where a state points.
struct Directions<S: nalgebra::Scalar> {
    radius: S,
    speed: S,
    /// r̂.
    up: Vector3<S>,
    /// v̂; zero at rest.
    ahead: Vector3<S>,
    /// r̂ × v̂, of length cos γ.
    left: Vector3<S>,
    cos_gamma: S,
}

impl<S: Scalar> Directions<S> {
    #[inline(always)]
    fn of(position: &Vector3<S>, velocity: &Vector3<S>) -> Self {
        // The three roots do not wait for each other.
        let across = position.cross(velocity);
        let (radius, speed, moment) = (length(position), length(velocity), length(&across));
        let (over_radius, over_speed) = (reciprocal_or_one(radius), reciprocal_or_one(speed));
        let over_both = over_radius * over_speed;
        Self {
            radius,
            speed,
            up: position.map(|component| component * over_radius),
            ahead: velocity.map(|component| component * over_speed),
            left: across.map(|component| component * over_both),
            cos_gamma: moment * over_both,
        }
    }
}

/// The share of the lift that is left near the vertical, over cos γ: with x = min(cos γ/ε, 1), x³(10 - 15x + 6x²)/cos γ.
///
/// In vertical flight the plane of radius and velocity, from which the bank angle is measured, is undefined; lift that turns
/// the flight down past the vertical would jump to the opposite side. The fade makes the equations smooth there,
/// and is 1 outside the cone.
#[inline(always)]
fn lift_fade_over_cosine<S: Scalar>(cos_gamma: S) -> S {
    let x = cos_gamma / LIFT_FADE_ANGLE;
    let faded = x * x * (x * (x * 6.0 - 15.0) + 10.0) / LIFT_FADE_ANGLE;
    let in_cone = cos_gamma.less_than(LIFT_FADE_ANGLE);
    let full = S::select(in_cone, S::one(), cos_gamma).recip();
    S::select(in_cone, faded, full)
}

/// A state that moves along its rate of change: the derivative part of what is computed from it is a rate per second.
pub fn moving(state: &[f64; 6], derivative: &[f64; 6]) -> [Dual64; 6] {
    std::array::from_fn(|i| Dual64::new(state[i], derivative[i]))
}
