//! The spherical formulation of the thesis. It is singular at the poles, in vertical flight and at rest.

use super::{Forces, Formulation, Models, Singularity, lift_fade_over_cosine};
use crate::coordinates::{FlightPath, PlanetFixed};
use crate::integrate::{Pace, System};
use crate::scalar::{Over, Scalar};

/// The state (r, θ, φ, V, γ, ψ) of [`FlightPath`], in m, m/s and rad.
#[derive(Clone, Debug)]
pub struct Spherical<P = f64>(pub Forces<P>);

impl<P: Scalar, S: Over<P>> System<S, 6> for Spherical<P> {
    /// Jameson 2006, equations 9 to 11 and 29 to 31, as printed in the text.
    #[inline(always)]
    fn derivative(&self, coordinates: &[S; 6]) -> [S; 6] {
        let Forces { models: Models { planet, .. }, sin_cos_bank: (sin_sigma, cos_sigma), .. } = &self.0;
        let (sin_sigma, cos_sigma) = (*sin_sigma, *cos_sigma);
        let FlightPath { radius: r, geocentric_latitude, speed: v, flight_path_angle, heading, .. } =
            FlightPath::from(*coordinates);
        let (sin_phi, cos_phi) = geocentric_latitude.sin_cos();
        let (sin_gamma, cos_gamma) = flight_path_angle.sin_cos();
        let (sin_psi, cos_psi) = heading.sin_cos();
        let omega = planet.rotation_rate;

        let density = self.0.density(r - planet.shape.surface_radius(sin_phi, cos_phi));
        let air = self.0.air(v);
        let drag = air.drag * density;
        let lift_over_cos_gamma = air.lift * density * lift_fade_over_cosine((cos_gamma * cos_gamma).sqrt());
        let g = planet.gravity(r);
        // rω² cos φ
        let centrifugal = r * cos_phi * (omega * omega);

        // ṙ = V sin γ   (9)
        let r_rate = v * sin_gamma;
        // θ̇ = V cos γ cos ψ / (r cos φ)   (10)
        let longitude_rate = v * cos_gamma * cos_psi * (r * cos_phi).recip();
        // φ̇ = V cos γ sin ψ / r   (11)
        let latitude_rate = v * cos_gamma * sin_psi * r.recip();
        // V̇ = -D/m - g sin γ + rω² cos φ (cos φ sin γ - sin φ sin ψ cos γ)   (29)
        let v_rate = -drag - g * sin_gamma + centrifugal * (cos_phi * sin_gamma - sin_phi * sin_psi * cos_gamma);
        // Vγ̇ = (L/m) cos σ - g cos γ + (V²/r) cos γ + 2Vω cos φ cos ψ + rω² cos φ (cos φ cos γ + sin φ sin ψ sin γ)   (30)
        let gamma_rate = (lift_over_cos_gamma * cos_gamma * cos_sigma - g * cos_gamma
            + v * v * r.recip() * cos_gamma
            + v * cos_phi * cos_psi * (2.0 * omega)
            + centrifugal * (cos_phi * cos_gamma + sin_phi * sin_psi * sin_gamma))
            * v.recip();
        // Vψ̇ = L sin σ/(m cos γ) - (V²/r) cos γ cos ψ tan φ + 2Vω (sin ψ cos φ tan γ - sin φ) - (rω²/cos γ) sin φ cos φ cos ψ   (31)
        let psi_rate = (lift_over_cos_gamma * sin_sigma
            - v * v * r.recip() * cos_gamma * cos_psi * sin_phi * cos_phi.recip()
            + v * (sin_psi * cos_phi * sin_gamma * cos_gamma.recip() - sin_phi) * (2.0 * omega)
            - centrifugal * sin_phi * cos_psi * cos_gamma.recip())
            * v.recip();
        [r_rate, longitude_rate, latitude_rate, v_rate, gamma_rate, psi_rate]
    }
}

impl Pace<6> for Spherical {
    fn magnitudes(&self) -> [f64; 6] {
        let [length, speed] = self.0.units();
        [length, 1.0, 1.0, speed, 1.0, 1.0]
    }

    fn longest_step(&self, coordinates: &[f64; 6], _: &[f64; 6]) -> f64 {
        self.0.longest_step(&Self::planet_fixed(coordinates))
    }
}

impl Formulation for Spherical {
    fn coordinates<S: Scalar>(state: &PlanetFixed<S>) -> [S; 6] {
        FlightPath::from_planet_fixed(state).into()
    }

    fn planet_fixed<S: Scalar>(coordinates: &[S; 6]) -> PlanetFixed<S> {
        FlightPath::from(*coordinates).to_planet_fixed()
    }

    fn singularity(&self, coordinates: &[f64; 6], within: f64) -> Option<Singularity> {
        let state = FlightPath::from(*coordinates);
        let [_, circular_speed] = self.0.units();
        if state.speed <= within * circular_speed {
            Some(Singularity::Rest)
        } else if state.geocentric_latitude.cos() <= within {
            Some(Singularity::Pole)
        } else if state.flight_path_angle.cos() <= within {
            Some(Singularity::VerticalFlight)
        } else {
            None
        }
    }

    fn forces(&self) -> &Forces {
        &self.0
    }
}
