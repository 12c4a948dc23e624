//! The spherical formulation of the thesis. It is singular at the poles, in vertical flight and at rest.

use nalgebra::Vector3;
use num_dual::DualSVec64;

use super::directions::{Directions, lift_fade_over_cosine, turned, wind_fade};
use super::state::coordinates;
use super::{Forces, Formulation, Singularity, State, StateRate, ThrustDirection};
use crate::coordinates::FlightPath;
use crate::elementary::cos;
use crate::integrate::{StepBounds, System, jacobian};
use crate::planet::Pull;
use crate::propulsion::ThrustAxis;
use crate::scalar::{Over, Scalar};

/// The state (r, θ, φ, V, γ, ψ) of [`FlightPath`], in m, m/s and rad, and maybe heat load and mass.
#[derive(Clone, Debug)]
pub struct Spherical<P = f64>(pub Forces<P>);

impl<P: Scalar, S: Over<P>> System<S, 6> for Spherical<P> {
    #[inline(always)]
    fn derivative(&self, time: S, coordinates: &[S; 6]) -> [S; 6] {
        if self.0.of_thesis {
            self.rates::<true, S>(time, coordinates, None)
        } else {
            self.rates_by_any(time, coordinates, None)
        }
    }
}

/// With the heat load, J/m², and the mass, kg.
impl<P: Scalar, S: Over<P>> System<S, 8> for Spherical<P> {
    #[inline(always)]
    fn derivative(&self, time: S, numbers: &[S; 8]) -> [S; 8] {
        self.rates_of_more(time, numbers)
    }
}

impl<P: Scalar> Spherical<P> {
    /// The rates of states that hold more than place and motion.
    #[inline(always)]
    fn rates_of_more<S: Over<P>, const N: usize>(&self, time: S, numbers: &[S; N]) -> [S; N] {
        let coordinates = coordinates(numbers);
        let state = State::of(FlightPath::from(coordinates).to_planet_fixed(), numbers);
        let rates = self.rates_by_any(time, &coordinates, state.mass);
        let [mass, heat_load] = [self.0.mass_rate(time, S::one()), self.0.heat_flux_in(time, &state)].map(Some);
        State { mass, heat_load, ..state }.numbers(rates)
    }
}

impl<P: Scalar> Spherical<P> {
    /// Not inlined, for the sake of the models of the thesis.
    #[inline(never)]
    fn rates_by_any<S: Over<P>>(&self, time: S, coordinates: &[S; 6], mass: Option<S>) -> [S; 6] {
        self.rates::<false, S>(time, coordinates, mass)
    }

    /// Jameson 2006, equations 9 to 11 and 29 to 31, as printed in the text, with forces of any direction.
    #[inline(always)]
    fn rates<const THESIS: bool, S: Over<P>>(&self, time: S, coordinates: &[S; 6], mass: Option<S>) -> [S; 6] {
        let planet = self.0.models.planet;
        let FlightPath { radius: r, longitude, geocentric_latitude, speed: v, flight_path_angle, heading } =
            FlightPath::from(*coordinates);
        let (sin_phi, cos_phi) = geocentric_latitude.sin_cos();
        let (sin_gamma, cos_gamma) = flight_path_angle.sin_cos();
        let (sin_psi, cos_psi) = heading.sin_cos();
        let (omega, over_r) = (planet.rotation_rate, r.recip());

        let altitude = r - planet.shape.surface_radius(sin_phi, cos_phi);
        let velocity = Velocity { speed: v, sin_gamma, cos_gamma, sin_psi, cos_psi };
        let place = Place { longitude, sin_phi, cos_phi, altitude, radius: r, mass };
        let [ahead, up, left_over_cos_gamma] = self.aerodynamic::<THESIS, _>(time, &place, &velocity);
        let [ahead, up, left_over_cos_gamma] = match if THESIS { None } else { self.thrust(time, &place, &velocity) } {
            Some(thrust) => [ahead + thrust[0], up + thrust[1], left_over_cos_gamma + thrust[2]],
            None => [ahead, up, left_over_cos_gamma],
        };
        let Pull { inward, axial } = if THESIS {
            Pull { inward: planet.point_gravity(over_r), axial: S::zero() }
        } else {
            planet.pull(over_r, sin_phi)
        };
        // Gravity towards the centre, and to the north.
        let (g, g_north) = (inward + axial * sin_phi, -axial * cos_phi);
        // rω² cos φ
        let centrifugal = r * cos_phi * (omega * omega);

        // ṙ = V sin γ   (9)
        let r_rate = v * sin_gamma;
        // θ̇ = V cos γ cos ψ / (r cos φ)   (10)
        let longitude_rate = v * cos_gamma * cos_psi * (r * cos_phi).recip();
        // φ̇ = V cos γ sin ψ / r   (11)
        let latitude_rate = v * cos_gamma * sin_psi * over_r;
        // V̇ = -D/m - g sin γ + g_N cos γ sin ψ + rω² cos φ (cos φ sin γ - sin φ sin ψ cos γ)   (29)
        let v_rate = ahead - g * sin_gamma
            + g_north * cos_gamma * sin_psi
            + centrifugal * (cos_phi * sin_gamma - sin_phi * sin_psi * cos_gamma);
        // Vγ̇ = (L/m) cos σ - g cos γ - g_N sin γ sin ψ + (V²/r) cos γ + 2Vω cos φ cos ψ + rω² cos φ (cos φ cos γ + sin φ sin ψ sin γ)   (30)
        let gamma_rate = (up - g * cos_gamma - g_north * sin_gamma * sin_psi
            + v * v * over_r * cos_gamma
            + v * cos_phi * cos_psi * (2.0 * omega)
            + centrifugal * (cos_phi * cos_gamma + sin_phi * sin_psi * sin_gamma))
            * v.recip();
        // Vψ̇ = L sin σ/(m cos γ) + g_N cos ψ/cos γ - (V²/r) cos γ cos ψ tan φ + 2Vω (sin ψ cos φ tan γ - sin φ) - (rω²/cos γ) sin φ cos φ cos ψ   (31)
        let psi_rate = (left_over_cos_gamma + g_north * cos_psi * cos_gamma.recip()
            - v * v * over_r * cos_gamma * cos_psi * sin_phi * cos_phi.recip()
            + v * (sin_psi * cos_phi * sin_gamma * cos_gamma.recip() - sin_phi) * (2.0 * omega)
            - centrifugal * sin_phi * cos_psi * cos_gamma.recip())
            * v.recip();
        [r_rate, longitude_rate, latitude_rate, v_rate, gamma_rate, psi_rate]
    }
}

/// The place of a vehicle, and its mass where that is integrated.
struct Place<S> {
    longitude: S,
    sin_phi: S,
    cos_phi: S,
    /// Above the planet's shape, along the radius vector, m.
    altitude: S,
    /// m.
    radius: S,
    /// kg.
    mass: Option<S>,
}

impl<S: Scalar> Place<S> {
    /// Planet-fixed, m.
    fn position(&self) -> Vector3<S> {
        let (sin_theta, cos_theta) = self.longitude.sin_cos();
        Vector3::new(self.cos_phi * cos_theta, self.cos_phi * sin_theta, self.sin_phi) * self.radius
    }
}

/// A velocity relative to the planet, by its magnitude and its angles.
struct Velocity<S> {
    speed: S,
    sin_gamma: S,
    cos_gamma: S,
    sin_psi: S,
    cos_psi: S,
}

impl<S: Scalar> Velocity<S> {
    /// What a vector along up, east and north has along the velocity, across it upward, and across it to the left over cos γ.
    #[inline(always)]
    fn seen_along(&self, [up, east, north]: [S; 3]) -> [S; 3] {
        let Self { sin_gamma, cos_gamma, sin_psi, cos_psi, .. } = *self;
        let level = east * cos_psi + north * sin_psi;
        [
            up * sin_gamma + level * cos_gamma,
            up * cos_gamma - level * sin_gamma,
            (north * cos_psi - east * sin_psi) * cos_gamma.recip(),
        ]
    }
}

impl<P: Scalar> Spherical<P> {
    /// Lift and drag over the mass, m/s²: along the velocity, across it upward, and across it to the left over cos γ.
    #[inline(always)]
    fn aerodynamic<const THESIS: bool, S: Over<P>>(&self, time: S, place: &Place<S>, velocity: &Velocity<S>) -> [S; 3] {
        let Place { altitude, radius, cos_phi, mass, .. } = *place;
        let Velocity { speed, sin_gamma, cos_gamma, sin_psi, cos_psi } = *velocity;
        // Up, east and north are axes like any others.
        let unit = [sin_gamma, cos_gamma * cos_psi, cos_gamma * sin_psi];
        let [up, east, north] = unit.map(|part| part * speed);
        let position = Vector3::new(radius, S::zero(), S::zero());
        let forces = &self.0;
        let local = forces.local::<THESIS, _>(time, altitude, || place.position());
        match forces.wind::<THESIS, _>(altitude) {
            None => {
                let still = Directions { speed, ..Directions::of(&position, &Vector3::new(up, east, north)) };
                let flow = forces.flow_of::<THESIS, _>(altitude, local, still, speed, mass);
                let (air, density) = (forces.air::<THESIS, _>(time, &flow), forces.density(&flow));
                let lift_over_cos_gamma = air.lift * density * lift_fade_over_cosine((cos_gamma * cos_gamma).sqrt());
                let (sin_sigma, cos_sigma) = forces.sin_cos_bank::<THESIS, _>(time, &flow.arguments);
                [-(air.drag * density), lift_over_cos_gamma * cos_gamma * cos_sigma, lift_over_cos_gamma * sin_sigma]
            }
            Some(wind) => {
                let fade = wind_fade((cos_phi * cos_phi).sqrt());
                let [to_east, to_north] = wind.map(|part| part * fade);
                let relative = Vector3::new(up, east - to_east, north - to_north);
                let flow =
                    forces.flow_of::<THESIS, _>(altitude, local, Directions::of(&position, &relative), speed, mass);
                let force = forces.aerodynamic::<THESIS, _>(time, &flow);
                velocity.seen_along(force.into())
            }
        }
    }
}

impl<P: Scalar> Spherical<P> {
    /// The thrust over the mass, m/s²: along the velocity, across it upward, and across it to the left over cos γ.
    #[inline(always)]
    fn thrust<S: Over<P>>(&self, time: S, place: &Place<S>, velocity: &Velocity<S>) -> Option<[S; 3]> {
        let burn = self.0.burn.as_ref()?;
        let acceleration = self.0.mass_ratio(place.mass).unwrap_or_else(S::one) * burn.acceleration;
        let Velocity { sin_gamma, cos_gamma, .. } = *velocity;
        let faded_over_cos_gamma = || acceleration * lift_fade_over_cosine((cos_gamma * cos_gamma).sqrt());
        let ThrustDirection::Axis(along) = burn.direction else {
            // Parts are flown by the Cartesian equations alone.
            return None;
        };
        Some(match along {
            ThrustAxis::Velocity => [acceleration, S::zero(), S::zero()],
            ThrustAxis::Radial => [acceleration * sin_gamma, acceleration * cos_gamma, S::zero()],
            ThrustAxis::Normal => [S::zero(), S::zero(), faded_over_cos_gamma()],
            ThrustAxis::Horizontal => {
                let level = faded_over_cos_gamma() * cos_gamma;
                [level * cos_gamma, -(level * sin_gamma), S::zero()]
            }
            ThrustAxis::Inertial(direction) => {
                // Outward from the axis, east, and along it.
                let angle = time * self.0.models.planet.rotation_rate + place.longitude;
                let [outward, east, axial]: [S; 3] = turned(&direction, angle).into();
                let up = outward * place.cos_phi + axial * place.sin_phi;
                let north = axial * place.cos_phi - outward * place.sin_phi;
                velocity.seen_along([up, east, north].map(|part| part * acceleration))
            }
        })
    }
}

impl<const N: usize> StepBounds<N> for Spherical
where
    Self: System<f64, N> + System<DualSVec64<6>, N>,
{
    fn magnitudes(&self) -> [f64; N] {
        let [length, speed] = self.0.units();
        self.0.magnitudes([length, 1.0, 1.0, speed, 1.0, 1.0])
    }

    fn longest_step(&self, time: f64, numbers: &[f64; N]) -> f64 {
        self.0.longest_step(time, &Self::state(numbers))
    }

    fn longest_implicit_step(&self, time: f64, numbers: &[f64; N]) -> f64 {
        self.0.longest_implicit_step(time, &Self::state(numbers))
    }

    fn time_to_corner(&self, time: f64, numbers: &[f64; N], derivative: &[f64; N], least: f64) -> f64 {
        self.0.time_to_corner(&StateRate::of::<Self, N>(time, numbers, derivative), least)
    }

    fn jacobian(&self, time: f64, numbers: &[f64; N]) -> [[f64; N]; N] {
        // Nothing changes fast by heat load and mass.
        jacobian::<_, N, 6>(self, time, numbers)
    }
}

impl<const N: usize> Formulation<N> for Spherical
where
    Self: System<f64, N> + System<DualSVec64<6>, N>,
{
    fn numbers<S: Scalar>(state: &State<S>) -> [S; N] {
        state.numbers(FlightPath::from_planet_fixed(&state.planet_fixed()).into())
    }

    fn state<S: Scalar>(numbers: &[S; N]) -> State<S> {
        State::of(FlightPath::from(coordinates(numbers)).to_planet_fixed(), numbers)
    }

    fn singularity(&self, numbers: &[f64; N], within: f64) -> Option<Singularity> {
        let state = FlightPath::from(coordinates(numbers));
        let [_, circular_speed] = self.0.units();
        if state.speed <= within * circular_speed {
            Some(Singularity::Rest)
        } else if cos(state.geocentric_latitude) <= within {
            Some(Singularity::Pole)
        } else if cos(state.flight_path_angle) <= within {
            Some(Singularity::VerticalFlight)
        } else {
            None
        }
    }

    fn forces(&self) -> &Forces {
        &self.0
    }

    fn forces_mut(&mut self) -> &mut Forces {
        &mut self.0
    }
}
