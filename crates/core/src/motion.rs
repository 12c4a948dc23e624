//! The equations of motion: the forces, gathered once, and the two formulations that integrate them.

mod cartesian;
mod directions;
mod lanes;
mod loads;
mod model_mode;
mod quantity;
mod rest;
mod spherical;
mod state;
mod thrust;

pub use cartesian::Cartesian;
pub use loads::Loads;
pub use model_mode::{ModelMode, Switch, TableId};
pub use spherical::Spherical;
pub use state::State;
pub use thrust::{Burn, ThrustDirection};

pub(crate) use lanes::EndReadings;
pub(crate) use model_mode::{Chatter, SwitchQuantity, SwitchSet};
pub(crate) use quantity::StateRate;
use quantity::inertial_velocity;
pub(crate) use state::MASS;
pub(crate) use thrust::{along, direction, tilted};

use nalgebra::Vector3;
use num_dual::Dual64;

use crate::atmosphere::{Atmosphere, AtmosphereSample};
use crate::control::{Against, Command, Control};
use crate::coordinates::PlanetFixed;
use crate::heating::{HeatFlux, Stagnation};
use crate::integrate::StepBounds;
use crate::interpolation::Hint;
use crate::parachute::Canopies;
use crate::planet::{Gravity, Planet};
use crate::scalar::{Over, Real, Scalar, apart, length, reciprocal_or_one};
use crate::steering::Steering;
use crate::vehicle::{Aerodynamics, Coefficients};
use crate::wind::Wind;
use directions::{Directions, lift_fade_over_cosine, lift_fade_slope, relative_to_air};
use thrust::Push;

/// Within this angle of the vertical the lift fades out, rad: in vertical flight the bank angle has no meaning.
pub const LIFT_FADE_ANGLE: f64 = 1e-3;

/// Within this angle of a pole, seen from the planet's centre, the wind fades out, rad: at the pole there is neither east nor north.
pub const WIND_FADE_ANGLE: f64 = 1e-3;

/// Scale heights that a step may fall; see [`Forces::longest_fall`].
const SCALE_HEIGHTS_A_STEP: f64 = 10.0;
/// Times of drag that a step may last; see [`Forces::longest_step`].
const DRAG_TIMES_A_STEP: f64 = 1.5;
/// Times in which lift turns the flight to the vertical that a step may last; see [`Forces::longest_step`].
const FADE_TIMES_A_STEP: f64 = 5.5;

/// The forces on the vehicle: gravity, lift, drag, thrust and parachutes. The parameters may carry derivatives (dual numbers), or be those
/// of several vehicles in the lanes of one computation.
#[derive(Clone, Debug)]
#[expect(clippy::struct_excessive_bools, reason = "each is asked for by itself")]
pub struct Forces<P = f64> {
    /// The models, in which the numbers of `parameters` are replaced by 0 or 1: both must come from the same case.
    models: Models,
    /// The numbers that are taken out of the models.
    parameters: Parameters<P>,
    /// The reference area over the mass, m²/kg.
    area_over_mass: P,
    /// The mass of the vehicle at the start of the phase, kg. It differs from that of the parameters where a vehicle is given by its
    /// ballistic coefficient.
    mass: P,
    /// Sine and cosine of a constant bank angle.
    sin_cos_bank: (P, P),
    /// The thrust, while one acts.
    burn: Option<Burn<P>>,
    /// The parachutes that are deployed.
    canopies: Option<Canopies<P>>,
    /// Whether the vehicle is held on the ground: it stays where it is, and burns.
    held: bool,
    /// By how much later than in the models the times begin from which bank angle, angle of attack, pitch and yaw run, s: zero, with derivatives where
    /// they begin with an event whose time varies.
    lags: [P; 4],
    /// The segment of each piecewise model that is in use.
    mode: ModelMode,
    /// What switches: the models that are piecewise.
    switches: SwitchSet,
    /// Whether all models are those of the thesis. Functions with a constant `THESIS` know it when they are compiled, so that what
    /// a case does not use does not cost it a tenth of its time.
    of_thesis: bool,
    /// Whether coefficients or angles depend on the Mach number.
    by_mach: bool,
    /// Whether the angle of attack is that of the axis of the vehicle, as it is steered, to the velocity relative to the air.
    by_axis: bool,
    /// Whether angles depend on the energy.
    by_energy: bool,
    cache: LookupCache,
}

/// The cells of the tables at which the last look-ups ended, where the next ones begin.
#[derive(Clone, Debug, Default)]
struct LookupCache {
    atmosphere: Hint,
    wind: Hint,
    angle_of_attack_and_mach: [Hint; 2],
}

/// The models of a case, without the numbers of [`Parameters`]: what all lanes of a computation have in common.
#[derive(Clone, Debug, PartialEq)]
pub struct Models {
    /// The planet: gravity, shape and rotation.
    pub planet: Planet,
    /// The air, which turns with the planet.
    pub atmosphere: Atmosphere,
    /// The velocity of the air relative to the planet.
    pub wind: Wind,
    /// The coefficients of lift and drag.
    pub aerodynamics: Aerodynamics,
    /// Bank angle and angle of attack.
    pub control: Control,
    /// Where the axis of the vehicle points.
    pub steering: Steering,
    /// The heating at the stagnation point; none where it is not asked for.
    pub heating: Option<Stagnation>,
}

/// The numbers that may carry derivatives, beside the state.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parameters<P> {
    /// The mass, kg; for a vehicle given by its ballistic coefficient that coefficient, kg/m².
    pub mass: P,
    /// The reference area, m²; 1 for a vehicle given by its ballistic coefficient.
    pub reference_area: P,
    /// The lift coefficient, less that of the model.
    pub lift_coefficient: P,
    /// The drag coefficient, less that of the model.
    pub drag_coefficient: P,
    /// The density over that of the model.
    pub density: P,
    /// The bank angle, less that of the model, rad.
    pub bank_angle: P,
}

/// Powers over the mass, W/kg, or their work, J/kg.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Power {
    /// That drag, and in wind lift, takes.
    pub(crate) drag: f64,
    /// That thrust gives.
    pub(crate) thrust: f64,
}

/// A formulation: `N` numbers that hold the state, and how they change. Six hold place and motion; a seventh is the
/// heat load, J/m², and an eighth the mass, kg.
pub trait Formulation<const N: usize>: StepBounds<N> {
    /// The numbers of a state.
    fn numbers<S: Scalar>(state: &State<S>) -> [S; N];

    /// The state of the numbers.
    fn state<S: Scalar>(numbers: &[S; N]) -> State<S>;

    /// The singularity of the equations that lies `within` this distance of a state: rad, or parts of the circular speed.
    fn singularity(&self, numbers: &[f64; N], within: f64) -> Option<Singularity>;

    /// The forces in its equations.
    fn forces(&self) -> &Forces;

    /// The forces in its equations.
    fn forces_mut(&mut self) -> &mut Forces;
}

/// The heat load, J/m², of an entry from orbit: a smaller one is as exact as if it were this.
const HEAT_LOAD: f64 = 1e8;

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
pub(crate) struct Flow<S: nalgebra::Scalar> {
    /// Of the position, and of the velocity relative to the air.
    directions: Directions<S>,
    /// By what tables and schedules are looked up.
    arguments: Arguments<S>,
    /// The mass at the start of the phase over the mass, where a thrust acts and the mass is integrated.
    mass_ratio: Option<S>,
    /// Where the axis of the vehicle points, where the air asks for it.
    axis: Option<Vector3<S>>,
}

/// By what tables and schedules are looked up, beside the time.
struct Arguments<S> {
    /// Along the radius vector, m.
    altitude: S,
    /// Relative to the planet, m/s.
    ground_speed: S,
    /// Over that of the parameters, kg/m³, where it comes with something else of the air.
    density: Option<S>,
    /// Where something depends on it.
    mach: Option<S>,
    /// Pa, where engines depend on it.
    pressure: Option<S>,
    /// Relative to the planet, J/kg, where something depends on it.
    energy: Option<S>,
}

/// What is known of a place beside its altitude, where something asks for it.
#[derive(Clone, Copy)]
struct Local<S> {
    /// Over that of the parameters; of an atmosphere that depends on more than the altitude, and where engines depend on the pressure.
    air: Option<AtmosphereSample<S>>,
    /// Of gravity and of the centrifugal force, J/kg, where something depends on the energy.
    potential: Option<S>,
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
        let by_energy = models.is_by(Against::Energy);
        let of_thesis = models.are_of_thesis();
        let by_axis = models.steering.is_attitude() && matches!(models.aerodynamics, Aerodynamics::AlphaMachTable(_));
        let (burn, canopies, held) = (None, None, false);
        let (mode, switches, cache) = (ModelMode::default(), SwitchSet::default(), LookupCache::default());
        let mut forces = Self {
            models,
            parameters,
            area_over_mass,
            mass: parameters.mass,
            sin_cos_bank,
            burn,
            canopies,
            held,
            lags: [P::zero(); 4],
            mode,
            switches,
            of_thesis,
            by_mach,
            by_axis,
            by_energy,
            cache,
        };
        forces.switches = SwitchSet::of(|switch| forces.boundaries(switch).is_some());
        forces
    }

    /// The same forces on a vehicle of a mass, kg, of which the parameters need not have the number: a ballistic one has ratios.
    #[must_use]
    pub fn of_mass(self, mass: P) -> Self {
        Self { mass, ..self }
    }

    /// The same forces with a thrust, if there is one.
    #[must_use]
    pub fn burning(self, burn: Option<Burn<P>>) -> Self {
        let mut burning = Self { of_thesis: self.of_thesis && burn.is_none(), burn, ..self };
        if burning.boundaries(Switch::LoadLimit).is_some() {
            burning.switches = burning.switches.with(Switch::LoadLimit);
        }
        burning
    }

    /// The same forces with the drag of parachutes, if there are any open.
    #[must_use]
    pub fn under(self, canopies: Option<Canopies<P>>) -> Self {
        Self { of_thesis: self.of_thesis && canopies.is_none(), canopies, ..self }
    }

    /// The same forces on a vehicle that is held on the ground, or not.
    #[must_use]
    pub fn held(self, held: bool) -> Self {
        Self { of_thesis: self.of_thesis && !held, held, ..self }
    }

    /// The same forces where the times from which the angles run begin later, s.
    #[must_use]
    pub(crate) fn lagging(self, lags: [P; 4]) -> Self {
        Self { lags, ..self }
    }

    /// The acceleration relative to the rotating planet, m/s².
    ///
    /// ```text
    /// dv/dt = g(r) + (D + L + T)/m - 2 ω×v - ω×(ω×r)
    /// ```
    ///
    /// # Reference
    /// Jameson 2006, equations 17 and 21 to 23, without the step to the vehicle-pointing axes.
    #[inline(always)]
    pub fn acceleration<S: Over<P>>(&self, time: S, state: &State<S>) -> Vector3<S> {
        if self.of_thesis {
            self.acceleration_by::<true, S>(time, state)
        } else {
            // The models that the thesis does not have would be in the way of those that it has.
            apart(|| self.acceleration_by::<false, S>(time, state))
        }
    }

    #[inline(always)]
    fn acceleration_by<const THESIS: bool, S: Over<P>>(&self, time: S, state: &State<S>) -> Vector3<S> {
        self.acceleration_in::<THESIS, _>(time, state, &self.flow::<THESIS, _>(time, state))
    }

    #[inline(always)]
    fn acceleration_in<const THESIS: bool, S: Over<P>>(&self, time: S, state: &State<S>, flow: &Flow<S>) -> Vector3<S> {
        if !THESIS && self.held {
            return Vector3::from_element(S::zero());
        }
        let fall = self.fall::<THESIS, _>(state, flow);
        let aerodynamic = self.aerodynamic::<THESIS, _>(time, flow);
        match if THESIS { None } else { self.push(time, state, flow, &aerodynamic) } {
            Some(push) => aerodynamic + push.acceleration + fall,
            None => aerodynamic + fall,
        }
    }

    /// The acceleration by gravity and by the turning of the planet, m/s².
    #[inline(always)]
    fn fall<const THESIS: bool, S: Over<P>>(&self, state: &State<S>, flow: &Flow<S>) -> Vector3<S> {
        let State { position, velocity, .. } = state;
        let rotation = self.models.planet.rotation_rate;
        let centrifugal = rotation * rotation;
        let Directions { over_radius, up, .. } = &flow.directions;
        let planet = &self.models.planet;
        let mut fall =
            if THESIS { planet.gravity_of_point(*over_radius, up) } else { planet.gravity(*over_radius, up) };
        fall.x += velocity.y * (2.0 * rotation) + position.x * centrifugal;
        fall.y += velocity.x * (-2.0 * rotation) + position.y * centrifugal;
        fall
    }

    /// The acceleration that a vehicle at rest, which nothing holds, has along the outward normal of the planet's shape, m/s²: by thrust,
    /// gravity and the turning of the planet.
    fn upward_acceleration<S: Over<P>>(&self, time: S, state: &State<S>) -> S {
        let flow = self.flow::<false, _>(time, state);
        let still = Vector3::from_element(S::zero());
        let push = self.push(time, state, &flow, &still).map_or(still, |push| push.acceleration);
        let normal = self.models.planet.shape.normal(&state.position);
        (push + self.fall::<false, _>(state, &flow)).dot(&normal)
    }

    /// The sizes below which numbers of a state are as exact as if they had them. Errors of the mass do not count, which grows and falls
    /// evenly, and none of a heat load for which nobody asked.
    fn magnitudes<const N: usize>(&self, coordinates: [f64; 6]) -> [f64; N] {
        let heat_load = Some(if self.models.heating.is_some() { HEAT_LOAD } else { f64::INFINITY });
        State { mass: Some(f64::INFINITY), heat_load, ..State::from(PlanetFixed::from([0.0; 6])) }.numbers(coordinates)
    }

    /// The acceleration, the rate of the mass, kg/s, and the heat flux into the stagnation point, W/m², of the air that meets the vehicle.
    #[inline(always)]
    fn acceleration_and_rates<S: Over<P>>(&self, time: S, state: &State<S>) -> (Vector3<S>, S, S) {
        let mut flow = self.flow::<false, _>(time, state);
        // Both the forces and the heat flux take it.
        flow.arguments.density = Some(self.density_of_model(&flow.arguments));
        let aerodynamic = self.aerodynamic::<false, _>(time, &flow);
        let push = self.push(time, state, &flow, &aerodynamic);
        let throttle = push.as_ref().map_or_else(S::zero, |push| push.throttle);
        let (mass_rate, heat_flux) = (self.mass_rate(time, throttle), self.heat_flux_of(&flow));
        if self.held {
            return (Vector3::from_element(S::zero()), mass_rate, heat_flux);
        }
        let fall = self.fall::<false, _>(state, &flow);
        let acceleration = match push {
            Some(Push { acceleration, .. }) => aerodynamic + acceleration + fall,
            None => aerodynamic + fall,
        };
        (acceleration, mass_rate, heat_flux)
    }

    /// Into the stagnation point in a state, W/m²; none where no heating is asked for.
    #[inline(always)]
    fn heat_flux_in<S: Over<P>>(&self, time: S, state: &State<S>) -> S {
        if self.models.heating.is_none() {
            return S::zero();
        }
        self.heat_flux_of(&self.flow::<false, _>(time, state))
    }

    /// The same, of the air that meets the vehicle.
    #[inline(always)]
    fn heat_flux_of<S: Over<P>>(&self, flow: &Flow<S>) -> S {
        if self.models.heating.is_none() {
            return S::zero();
        }
        let heat_flux = self.heat_flux(self.density(flow), flow.directions.speed);
        heat_flux.map_or(S::zero(), |flux| flux.total())
    }

    /// Into the stagnation point, in air of a density, kg/m³, at a speed relative to it, m/s.
    #[inline(always)]
    fn heat_flux<S: Over<P>>(&self, density: S, air_speed: S) -> Option<HeatFlux<S>> {
        let heating = self.models.heating.as_ref()?;
        Some(heating.heat_flux(self.mode.of(Switch::Radiation), density, air_speed))
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
        if let Some(axis) = flow.axis.filter(|_| !THESIS) {
            // In the plane of the axis and the velocity, whose angle of attack has the sine of the length of what the axis has across.
            let across = axis - ahead * axis.dot(ahead);
            let lift = across * (air.lift * reciprocal_or_one(length(&across)));
            return (lift - ahead * air.drag) * self.density(flow);
        }
        let lift = air.lift * lift_fade_over_cosine(*cos_gamma);
        let (sin_bank, cos_bank) = self.sin_cos_bank::<THESIS, _>(time, &flow.arguments);
        let (lift_left, lift_up) = (lift * sin_bank, lift * cos_bank);
        let against = air.drag + lift_up * up.dot(ahead);
        // The density, an exponential, is what all else would wait for.
        let density = self.density(flow);
        Vector3::new(
            (up.x * lift_up + left.x * lift_left - ahead.x * against) * density,
            (up.y * lift_up + left.y * lift_left - ahead.y * against) * density,
            (up.z * lift_up + left.z * lift_left - ahead.z * against) * density,
        )
    }

    /// The air that meets a vehicle in a state.
    #[inline(always)]
    fn flow<const THESIS: bool, S: Over<P>>(&self, time: S, state: &State<S>) -> Flow<S> {
        let altitude = self.models.planet.shape.altitude(&state.position);
        let local = self.local::<THESIS, _>(time, altitude, || state.position);
        self.flow_in::<THESIS, _>(time, altitude, local, state)
    }

    /// The air that meets a vehicle in a state at an altitude, m, with what else is known of its place.
    #[inline(always)]
    fn flow_in<const THESIS: bool, S: Over<P>>(
        &self,
        time: S,
        altitude: S,
        local: Local<S>,
        state: &State<S>,
    ) -> Flow<S> {
        let (directions, ground_speed) = self.motion_in_air::<THESIS, _>(altitude, state);
        let arguments = self.arguments::<THESIS, _>(altitude, local, ground_speed, directions.speed);
        // Made at once, with its axis: it is long, and would be copied.
        let axis = (!THESIS && self.by_axis).then(|| self.axis(time, state, &arguments));
        let mass_ratio = if THESIS { None } else { self.mass_ratio(state.mass) };
        Flow { directions, arguments, mass_ratio, axis }
    }

    /// The same by the altitude, m, the directions and the speed relative to the planet, m/s, of a vehicle of a mass, kg, whose axis does not matter.
    #[inline(always)]
    fn flow_of<const THESIS: bool, S: Over<P>>(
        &self,
        altitude: S,
        local: Local<S>,
        directions: Directions<S>,
        ground_speed: S,
        mass: Option<S>,
    ) -> Flow<S> {
        let arguments = self.arguments::<THESIS, _>(altitude, local, ground_speed, directions.speed);
        let mass_ratio = if THESIS { None } else { self.mass_ratio(mass) };
        Flow { directions, arguments, mass_ratio, axis: None }
    }

    /// The directions of position and velocity relative to the air at an altitude, m, and the speed relative to the planet, m/s.
    #[inline(always)]
    fn motion_in_air<const THESIS: bool, S: Over<P>>(&self, altitude: S, state: &State<S>) -> (Directions<S>, S) {
        let State { position, velocity, .. } = state;
        let (air_velocity, ground_speed) = match self.wind::<THESIS, _>(altitude) {
            None => (*velocity, None),
            Some(wind) => (relative_to_air(velocity, wind, position), Some(length(velocity))),
        };
        let directions = Directions::of(position, &air_velocity);
        let ground_speed = ground_speed.unwrap_or(directions.speed);
        (directions, ground_speed)
    }

    /// What is known of a planet-fixed position, m, beside its altitude, m, at a time, s.
    #[inline(always)]
    fn local<const THESIS: bool, S: Over<P>>(
        &self,
        time: S,
        altitude: S,
        position: impl Fn() -> Vector3<S>,
    ) -> Local<S> {
        if THESIS {
            return Local { air: None, potential: None };
        }
        let air = match &self.models.atmosphere {
            Atmosphere::Nrlmsise00(model) => {
                Some(model.sample(self.models.planet.shape.semi_axes(), time, &position()))
            }
            by_altitude if self.takes_pressure() => {
                let segment = self.mode.of(Switch::Atmosphere);
                let (density, pressure) = by_altitude.density_and_pressure(segment, altitude, &self.cache.atmosphere);
                Some(AtmosphereSample { density, temperature: None, pressure, speed_of_sound: None })
            }
            _ => None,
        };
        Local { air, potential: self.potential_where_asked(position) }
    }

    /// The potential of gravity and of the centrifugal force at a planet-fixed position, m, in J/kg, where something depends on the energy.
    #[inline(always)]
    fn potential_where_asked<S: Over<P>>(&self, position: impl FnOnce() -> Vector3<S>) -> Option<S> {
        self.by_energy.then(|| self.models.planet.potential_at_rest(&position()))
    }

    /// By what tables and schedules are looked up at an altitude, m, with what else is known of the place, at a speed relative to the planet and
    /// another relative to the air, m/s.
    #[inline(always)]
    fn arguments<const THESIS: bool, S: Over<P>>(
        &self,
        altitude: S,
        Local { air, potential }: Local<S>,
        ground_speed: S,
        air_speed: S,
    ) -> Arguments<S> {
        let energy = potential.map(|potential| ground_speed * ground_speed * 0.5 + potential);
        let mut arguments = Arguments { altitude, ground_speed, density: None, mach: None, pressure: None, energy };
        if THESIS {
            return arguments;
        }
        if let Some(AtmosphereSample { density, pressure, speed_of_sound, .. }) = air {
            arguments.density = Some(density);
            arguments.pressure = pressure.map(|pressure| pressure * self.parameters.density);
            arguments.mach = speed_of_sound.map(|sound| air_speed * sound.recip());
        }
        if self.by_mach && arguments.mach.is_none() {
            self.add_mach(&mut arguments, air_speed);
        }
        arguments
    }

    /// Adds the density and the Mach number at a speed relative to the air, m/s, where the atmosphere depends on the altitude alone.
    #[inline(always)]
    fn add_mach<S: Over<P>>(&self, arguments: &mut Arguments<S>, air_speed: S) {
        let segment = self.mode.of(Switch::Atmosphere);
        let (density, sound) =
            self.models.atmosphere.density_and_sound(segment, arguments.altitude, &self.cache.atmosphere);
        arguments.density = Some(density);
        arguments.mach = Some(air_speed * sound.recip());
    }

    /// The wind at an altitude, m, to the east and to the north, m/s.
    #[inline(always)]
    fn wind<const THESIS: bool, S: Over<P>>(&self, altitude: S) -> Option<[S; 2]> {
        match &self.models.wind {
            _ if THESIS => None,
            Wind::Still => None,
            Wind::Constant { east, north } => Some([S::from(*east), S::from(*north)]),
            Wind::Table(table) => Some(table.velocity(self.mode.of(Switch::Wind), altitude, &self.cache.wind)),
        }
    }

    /// ρ, kg/m³.
    #[inline(always)]
    fn density<S: Over<P>>(&self, flow: &Flow<S>) -> S {
        self.density_of_model(&flow.arguments) * self.parameters.density
    }

    /// ρ over that of the parameters, kg/m³.
    #[inline(always)]
    fn density_of_model<S: Over<P>>(&self, arguments: &Arguments<S>) -> S {
        let Arguments { altitude, density, .. } = *arguments;
        // Not a closure, which in lanes would leave their instructions.
        match density {
            Some(density) => density,
            None => self.models.atmosphere.density(self.mode.of(Switch::Atmosphere), altitude, &self.cache.atmosphere),
        }
    }

    /// What the air does to the vehicle.
    #[inline(always)]
    fn air<const THESIS: bool, S: Over<P>>(&self, time: S, flow: &Flow<S>) -> Air<S> {
        let speed = flow.directions.speed;
        let pressure = speed * speed * 0.5;
        let over_mass = |force_over_mass: S| match flow.mass_ratio {
            Some(mass_ratio) if !THESIS => force_over_mass * mass_ratio,
            _ => force_over_mass,
        };
        let acceleration = over_mass(pressure * self.area_over_mass);
        let Parameters { lift_coefficient, drag_coefficient, .. } = self.parameters;
        let mut air = match self.coefficients::<THESIS, _>(time, flow) {
            None => Air { drag: acceleration * drag_coefficient, lift: acceleration * lift_coefficient },
            Some(Coefficients { lift, drag }) => {
                Air { drag: acceleration * (drag + drag_coefficient), lift: acceleration * (lift + lift_coefficient) }
            }
        };
        if let Some(canopies) = &self.canopies
            && !THESIS
        {
            air.drag += over_mass(pressure * canopies.area_over_mass(time));
        }
        air
    }

    /// The coefficients of the model, if they are not all in the parameters.
    #[inline(always)]
    fn coefficients<const THESIS: bool, S: Over<P>>(&self, time: S, flow: &Flow<S>) -> Option<Coefficients<S>> {
        let cache = &self.cache.angle_of_attack_and_mach;
        let [alpha, mach] = [Switch::TableAngleOfAttack, Switch::Mach].map(|switch| self.mode.of(switch));
        match &self.models.aerodynamics {
            _ if THESIS => None,
            Aerodynamics::Constant { .. } | Aerodynamics::Ballistic { .. } => None,
            Aerodynamics::MachTable(table) => Some(table.coefficients(mach, flow.arguments.mach(), &cache[1])),
            Aerodynamics::AlphaMachTable(table) => {
                Some(table.coefficients([alpha, mach], self.angle_of_attack(time, flow), flow.arguments.mach(), cache))
            }
        }
    }

    /// Sine and cosine of σ.
    #[inline(always)]
    fn sin_cos_bank<const THESIS: bool, S: Over<P>>(&self, time: S, arguments: &Arguments<S>) -> (S, S) {
        match &self.models.control.bank_angle {
            Command::Schedule(_) if !THESIS => self.bank_angle(time, arguments).sin_cos(),
            _ => {
                let (sin_bank, cos_bank) = self.sin_cos_bank;
                (S::zero() + sin_bank, S::zero() + cos_bank)
            }
        }
    }

    /// σ, rad.
    #[inline(always)]
    fn bank_angle<S: Over<P>>(&self, time: S, arguments: &Arguments<S>) -> S {
        let clock = self.clock(Switch::BankAngle, time);
        arguments.angle(&self.models.control.bank_angle, self.mode.of(Switch::BankAngle), clock)
            + self.parameters.bank_angle
    }

    /// α, rad: as it is commanded, or the angle between the axis and the velocity relative to the air.
    #[inline(always)]
    fn angle_of_attack<S: Over<P>>(&self, time: S, flow: &Flow<S>) -> S {
        match &flow.axis {
            None => self.commanded_angle_of_attack(time, &flow.arguments),
            Some(axis) => {
                let Directions { ahead, speed, .. } = &flow.directions;
                // None at rest.
                let at_rest = speed.less_than(f64::MIN_POSITIVE);
                length(&axis.cross(ahead)).atan2(S::select(at_rest, S::one(), axis.dot(ahead)))
            }
        }
    }

    /// α, rad, as it is commanded.
    #[inline(always)]
    fn commanded_angle_of_attack<S: Over<P>>(&self, time: S, arguments: &Arguments<S>) -> S {
        let clock = self.clock(Switch::AngleOfAttack, time);
        arguments.angle(&self.models.control.angle_of_attack, self.mode.of(Switch::AngleOfAttack), clock)
    }

    /// The time by which something switches, s: that by which angles run begins with an event, where their schedules say so.
    #[inline(always)]
    fn clock<S: Over<P>>(&self, switch: Switch, time: S) -> S {
        match switch {
            Switch::BankAngle => time + -self.lags[0],
            Switch::AngleOfAttack => time + -self.lags[1],
            Switch::Pitch => time + -self.lags[2],
            Switch::Yaw => time + -self.lags[3],
            _ => time,
        }
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
                steering: _,
                heating: None,
            }
        )
    }

    /// Whether coefficients or angles depend on the Mach number.
    fn depend_on_mach(&self) -> bool {
        self.aerodynamics.is_by_mach() || self.is_by(Against::Mach)
    }

    /// Whether an angle runs along a quantity.
    fn is_by(&self, against: Against) -> bool {
        self.control.is_by(against) || self.steering.is_by(against)
    }
}

impl<S: Scalar> Arguments<S> {
    /// The Mach number, where something depends on it.
    #[inline(always)]
    fn mach(&self) -> S {
        self.mach.unwrap_or_else(S::zero)
    }

    /// An angle, rad, by the formula of a segment of its schedule.
    #[inline(always)]
    fn angle(&self, command: &Command, segment: usize, time: S) -> S {
        match command {
            Command::Constant(angle) => S::from(*angle),
            Command::Schedule(schedule) => schedule.angle(segment, self.quantity(schedule.against(), time)),
        }
    }

    /// The value of the independent variable of a schedule.
    #[inline(always)]
    fn quantity(&self, against: Against, time: S) -> S {
        match against {
            Against::Time => time,
            Against::Altitude => self.altitude,
            Against::Speed => self.ground_speed,
            Against::Mach => self.mach(),
            Against::Energy => self.energy.unwrap_or_else(S::zero),
            // Before the event the value of the first entry holds, whatever the time.
            Against::Since(_) => S::zero(),
        }
    }
}

impl Forces {
    /// Where it flies.
    pub fn planet(&self) -> &Planet {
        &self.models.planet
    }

    /// The units of length, m, and speed, m/s, in which the equations are of order one: r₀ and √(g₀r₀).
    pub(crate) fn units(&self) -> [f64; 2] {
        let length = self.models.planet.equatorial_radius();
        [length, (self.models.planet.gravitational_parameter / length).sqrt()]
    }

    /// The longest explicit step that may start in a state, s.
    fn longest_step(&self, time: f64, state: &State<f64>) -> f64 {
        self.longest_unbraked_step(time, state).min(self.longest_braking(time, state))
    }

    /// The longest implicit step that may start in a state, s.
    fn longest_implicit_step(&self, time: f64, state: &State<f64>) -> f64 {
        let flow = self.flow::<false, _>(time, state);
        self.longest_fall::<false, _>(time, state, &flow).min(self.longest_braking(time, state))
    }

    /// What the air takes from the vehicle and what thrust gives it, over its mass, W/kg.
    pub(crate) fn power(&self, time: f64, state: &State<f64>) -> Power {
        let flow = self.flow::<false, _>(time, state);
        let aerodynamic = self.aerodynamic::<false, _>(time, &flow);
        let push = self.push(time, state, &flow, &aerodynamic);
        let thrust = push.map_or(0.0, |push| push.acceleration.dot(&state.velocity));
        Power { drag: -aerodynamic.dot(&state.velocity), thrust }
    }

    /// D/m, m/s², of constant coefficients under a dynamic pressure, Pa.
    pub(crate) fn drag_under(&self, dynamic_pressure: f64) -> f64 {
        dynamic_pressure * self.area_over_mass * self.parameters.drag_coefficient
    }
}

impl<S: Scalar> Flow<S> {
    /// cos²γ of the velocity relative to the air, the squared sine of its angle to the radius; 0 at rest.
    #[inline(always)]
    pub(crate) fn cos_squared_gamma(&self) -> S {
        self.directions.left.dot(&self.directions.left)
    }
}

impl<P: Scalar> Forces<P> {
    /// The longest explicit step that may start in a state, s, where no thrust brakes.
    ///
    /// In the air it ends within a few times of drag, V/(D/m): where the motion is stiff, an explicit method is stable no longer,
    /// and at loose tolerances its dense output leaves all bounds before the ends of its steps do. The same holds near the vertical, to which lift
    /// that fades there turns the flight within V/(L/m) over the slope of the fade.
    #[inline(always)]
    fn longest_unbraked_step<S: Over<P> + Real>(&self, time: S, state: &State<S>) -> S {
        if self.of_thesis {
            self.longest_unbraked_step_by::<true, S>(time, state)
        } else {
            apart(|| self.longest_unbraked_step_by::<false, S>(time, state))
        }
    }

    #[inline(always)]
    fn longest_unbraked_step_by<const THESIS: bool, S: Over<P> + Real>(&self, time: S, state: &State<S>) -> S {
        let flow = self.flow::<THESIS, _>(time, state);
        let longest = self.longest_fall::<THESIS, _>(time, state, &flow);
        let air = self.air::<THESIS, _>(time, &flow);
        let (speed, density) = (flow.directions.speed, self.density(&flow));
        // Where there is no air, or no motion, these are no numbers, or without end.
        let drag_time = speed / (air.drag.max(air.lift.abs()) * density);
        let fade_rate = lift_fade_slope(flow.directions.cos_gamma) * air.lift.abs() * density / speed;
        longest.min(drag_time * DRAG_TIMES_A_STEP).min(S::from(FADE_TIMES_A_STEP) / fade_rate)
    }

    /// The longest step that does not jump over air, s.
    ///
    /// From space an integrator sees no air, and a long step would jump over the whole atmosphere.
    /// A step ends at the latest when the vehicle, at its present vertical speed and acceleration, has fallen half the way
    /// to the sensible atmosphere and some scale heights more.
    #[inline(always)]
    fn longest_fall<const THESIS: bool, S: Over<P> + Real>(&self, time: S, state: &State<S>, flow: &Flow<S>) -> S {
        let State { position, velocity, .. } = state;
        let over_radius = flow.directions.over_radius;
        let to_air = (flow.arguments.altitude - self.models.atmosphere.sensible_altitude()).max(S::zero());
        let depth = to_air * 0.5 + SCALE_HEIGHTS_A_STEP * self.models.atmosphere.scale_height();
        let rise = position.dot(velocity) * over_radius;
        let inertial = inertial_velocity(&self.models.planet, state);
        let level_squared = inertial.dot(&inertial) - rise * rise;
        let thrust = if THESIS { None } else { self.push_on(time, state, flow) };
        let thrust = thrust.map_or_else(S::zero, |thrust| length(&thrust));
        let fall =
            (self.models.planet.point_gravity(over_radius) - level_squared * over_radius + thrust).max(S::zero());
        // The positive root of rise t - fall t²/2 = -depth.
        let root = (rise * rise + fall * depth * 2.0).sqrt();
        S::select((-rise).less_than(0.0), (rise + root) / fall, depth * 2.0 / (root - rise))
    }

    /// The thrust over the mass, m/s², if there is one.
    #[inline(always)]
    fn push_on<S: Over<P>>(&self, time: S, state: &State<S>, flow: &Flow<S>) -> Option<Vector3<S>> {
        self.burn.as_ref()?;
        let aerodynamic = self.aerodynamic::<false, _>(time, flow);
        Some(self.push(time, state, flow, &aerodynamic)?.acceleration)
    }
}

/// A state that moves along its rate of change: the derivative part of what is computed from it is a rate per second.
pub fn moving<const N: usize>(state: &[f64; N], derivative: &[f64; N]) -> [Dual64; N] {
    std::array::from_fn(|i| Dual64::new(state[i], derivative[i]))
}
