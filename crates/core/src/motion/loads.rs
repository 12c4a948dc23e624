//! What acts on the vehicle at an instant, and what an event may wait for.

use std::cell::OnceCell;

use nalgebra::Vector3;

use super::directions::{Directions, lift_fade_over_cosine};
use super::{Flow, Forces, Parameters, State, Switch};
use crate::atmosphere::{Atmosphere, AtmosphereSample};
use crate::control::Command;
use crate::event::Quantity;
use crate::heating::{HeatFlux, Stagnation};
use crate::planet::Pull;
use crate::propulsion::STANDARD_GRAVITY;
use crate::scalar::{Over, Scalar, apart, length};
use crate::vehicle::Coefficients;
use crate::wind::Wind;

/// What the air does to the vehicle at an instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Loads<S> {
    /// Along the radius vector, above the surface, m.
    pub altitude: S,
    /// kg/m³.
    pub density: S,
    /// Relative to the rotating planet, m/s.
    pub speed: S,
    /// Relative to the air, m/s.
    pub air_speed: S,
    /// The speed relative to the air over that of sound; none where the atmosphere has no speed of sound.
    pub mach: Option<S>,
    /// ½ρV² of the speed relative to the air, Pa.
    pub dynamic_pressure: S,
    /// -dV/dt of the relative speed, m/s²; at rest minus the magnitude of the acceleration.
    pub deceleration: S,
    /// The force that is not gravity, lift, drag and thrust together, over the weight at standard gravity: what is felt on board.
    pub load_factor: S,
    /// Into the stagnation point, where heating is asked for.
    pub heat_flux: Option<HeatFlux<S>>,
}

impl<S: Scalar> Loads<S> {
    /// What an event may wait for, as far as it is one of the loads on a vehicle with this nose.
    pub(crate) fn quantity(&self, quantity: Quantity, nose: Option<&Stagnation>) -> Option<S> {
        let heat_flux = || self.heat_flux.map(|flux| flux.total());
        match quantity {
            Quantity::Altitude => Some(self.altitude),
            Quantity::Speed => Some(self.speed),
            Quantity::Mach => self.mach,
            Quantity::DynamicPressure => Some(self.dynamic_pressure),
            Quantity::LoadFactor => Some(self.load_factor),
            Quantity::AirSpeed => Some(self.air_speed),
            Quantity::Deceleration => Some(self.deceleration),
            Quantity::Density => Some(self.density),
            Quantity::HeatFlux => heat_flux(),
            Quantity::WallTemperature => Some(nose?.wall_temperature(heat_flux()?)),
            _ => None,
        }
    }
}

impl<P: Scalar> Forces<P> {
    /// The loads in a state.
    pub fn loads<S: Over<P>>(&self, time: S, state: &State<S>) -> Loads<S> {
        self.loads_in(time, state, &self.flow_with_mach(time, state))
    }

    /// The same in the air that meets the vehicle, with its Mach number.
    pub(crate) fn loads_in<S: Over<P>>(&self, time: S, state: &State<S>, flow: &Flow<S>) -> Loads<S> {
        let State { position, velocity, .. } = state;
        let Directions { over_radius, speed, up, ahead, .. } = &flow.directions;
        let density = self.density(flow);
        let dynamic_pressure = density * *speed * *speed * 0.5;
        let specific_force = OnceCell::new();
        let specific_force = || *specific_force.get_or_init(|| apart(|| self.specific_force(time, state, flow)));
        let acceleration = || {
            if self.held {
                return Vector3::from_element(S::zero());
            }
            specific_force() + self.fall::<false, _>(state, flow)
        };
        let of_moving = if matches!(self.models.wind, Wind::Still) && self.burn.is_none() {
            // -V̇ = D/m + g sin γ - ω² (x v̂_x + y v̂_y): lift and the Coriolis force are across the velocity   (29)
            let air = self.air::<false, _>(time, flow);
            let outward = position.x * ahead.x + position.y * ahead.y;
            let Pull { inward, axial } = self.models.planet.pull(*over_radius, up.z);
            air.drag * density + (inward * up.dot(ahead) + axial * ahead.z)
                - outward * self.models.planet.rotation_rate.powi(2)
        } else {
            -acceleration().dot(velocity) * flow.arguments.ground_speed.recip()
        };
        let at_rest = flow.arguments.ground_speed.less_than(f64::MIN_POSITIVE);
        let deceleration =
            if S::any(at_rest) { S::select(at_rest, -length(&acceleration()), of_moving) } else { of_moving };
        let load_factor = if self.held {
            // What holds it carries it.
            length(&self.fall::<false, _>(state, flow)) * STANDARD_GRAVITY.recip()
        } else if self.burn.is_some() {
            length(&specific_force()) * STANDARD_GRAVITY.recip()
        } else {
            self.aerodynamic_load_factor(time, flow, dynamic_pressure)
        };
        Loads {
            altitude: flow.arguments.altitude,
            density,
            speed: flow.arguments.ground_speed,
            air_speed: *speed,
            mach: flow.arguments.mach,
            dynamic_pressure,
            deceleration,
            load_factor,
            heat_flux: self.heat_flux(density, *speed),
        }
    }

    /// The air that meets the vehicle in a state, with its Mach number where the atmosphere has a speed of sound.
    pub(crate) fn flow_with_mach<S: Over<P>>(&self, time: S, state: &State<S>) -> Flow<S> {
        let mut flow = self.flow::<false, _>(time, state);
        if flow.arguments.mach.is_none() && self.models.atmosphere.has_speed_of_sound() {
            self.add_mach(&mut flow.arguments, flow.directions.speed);
        }
        flow
    }

    /// Lift, drag and thrust over the mass, m/s².
    fn specific_force<S: Over<P>>(&self, time: S, state: &State<S>, flow: &Flow<S>) -> Vector3<S> {
        let aerodynamic = self.aerodynamic::<false, _>(time, flow);
        let push = self.push(time, state, flow, &aerodynamic);
        push.map_or(aerodynamic, |push| aerodynamic + push.acceleration)
    }

    /// The load factor of a vehicle without thrust.
    fn aerodynamic_load_factor<S: Over<P>>(&self, time: S, flow: &Flow<S>, dynamic_pressure: S) -> S {
        // Accelerations by a unit of dynamic pressure: the squares of those of tiny forces would vanish.
        let (lift_coefficient, drag_coefficient) = self.lift_and_drag_coefficient(time, flow);
        let cos_gamma = flow.directions.cos_gamma;
        let lift_coefficient = lift_coefficient * (lift_fade_over_cosine(cos_gamma) * cos_gamma);
        if let Some(canopies) = &self.canopies {
            let lift = lift_coefficient * self.area_over_mass;
            let drag = drag_coefficient * self.area_over_mass + canopies.area_over_mass(time);
            return dynamic_pressure * (lift * lift + drag * drag).sqrt() * STANDARD_GRAVITY.recip();
        }
        let coefficient = (lift_coefficient * lift_coefficient + drag_coefficient * drag_coefficient).sqrt();
        dynamic_pressure * coefficient * (self.area_over_mass / STANDARD_GRAVITY)
    }

    fn lift_and_drag_coefficient<S: Over<P>>(&self, time: S, flow: &Flow<S>) -> (S, S) {
        let Parameters { lift_coefficient, drag_coefficient, .. } = self.parameters;
        let Coefficients { lift, drag } =
            self.coefficients::<false, _>(time, flow).unwrap_or(Coefficients { lift: S::zero(), drag: S::zero() });
        (lift + lift_coefficient, drag + drag_coefficient)
    }

    /// cos²γ of the velocity relative to the air, the squared sine of its angle to the radius; 0 at rest.
    pub fn cos_squared_angle_to_air<S: Over<P>>(&self, state: &State<S>) -> S {
        let altitude = self.models.planet.shape.altitude(&state.position);
        // As it is in the flow.
        let (Directions { left, .. }, _) = self.motion_in_air::<false, _>(altitude, state);
        left.dot(&left)
    }
}

impl<P: Scalar> Forces<P> {
    /// The air at a place of an altitude, m, as far as the atmosphere knows it.
    #[inline(always)]
    pub(super) fn air_of<S: Over<P>>(&self, time: S, position: &Vector3<S>, altitude: S) -> AtmosphereSample<S> {
        let sample = match &self.models.atmosphere {
            Atmosphere::Nrlmsise00(model) => model.sample(self.models.planet.shape.semi_axes(), time, position),
            by_altitude => by_altitude.sample(self.mode.of(Switch::Atmosphere), altitude, &self.cache.atmosphere),
        };
        // By the law of gases, denser air of the same temperature presses harder.
        let factor = self.parameters.density;
        let pressure = sample.pressure.map(|pressure| pressure * factor);
        AtmosphereSample { density: sample.density * factor, pressure, ..sample }
    }
}

impl Forces {
    /// The heating of the nose, where it is asked for.
    pub(crate) fn heating(&self) -> Option<&Stagnation> {
        self.models.heating.as_ref()
    }

    /// The angles at which the vehicle flies in a state: σ and α, rad.
    pub fn angles(&self, time: f64, state: &State<f64>) -> [f64; 2] {
        if let ([Command::Constant(bank_angle), Command::Constant(angle_of_attack)], false) =
            (self.models.control.commands(), self.by_axis)
        {
            return [bank_angle + self.parameters.bank_angle, *angle_of_attack];
        }
        let flow = self.flow_where_mach_matters(time, state);
        [self.bank_angle(time, &flow.arguments), self.angle_of_attack(time, &flow)]
    }

    /// The air in a state, as far as the atmosphere knows it.
    pub fn air_at(&self, time: f64, state: &State<f64>) -> AtmosphereSample<f64> {
        self.air_of(time, &state.position, self.models.planet.shape.altitude(&state.position))
    }
}
