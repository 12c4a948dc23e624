//! The solutions: each a page of the book, at a density η.
//!
//! The thesis prints some of the equations with slips; they are mended here, and each function says how.

use super::exponential_integral::scaled_ei;
use super::{End, Prediction, SMALL_ANGLE, Theory};
use crate::elementary::{acos, asin, cos, exp, ln, sin};

impl Theory {
    /// Shallow, gliding entry, where lift and centrifugal relief carry the weight.
    ///
    /// # Reference
    /// Jameson 2006, equations 77 to 79, "Shallow, Gliding Entry".
    pub(super) fn shallow_glide(&self, eta: f64) -> Result<Prediction, End> {
        let Self { k, beta, g0, r0, .. } = *self;
        let denominator = beta * r0 * eta * k + 1.0;
        if denominator <= 0.0 {
            return Err(End::Pole(77));
        }
        // (77) V² = g₀r₀ / (βr₀ηk + 1)
        let speed_squared = g0 * r0 / denominator;
        // (78) γ = -2g₀ / (kβV²)
        let gamma = -2.0 * g0 / (k * beta * speed_squared);
        if gamma.abs() > SMALL_ANGLE {
            return Err(End::LargeAngle);
        }
        // (79) -dV/dt = βηV²
        Ok(Prediction::of(speed_squared, gamma, beta * eta * speed_squared))
    }

    /// Loh's unified theory, second order: the angle of a descent, with the simulated speed.
    ///
    /// # Reference
    /// Jameson 2006, equation 80, "Shallow, Gliding Entry".
    pub(super) fn loh(&self, eta: f64, speed: f64) -> Result<Prediction, End> {
        let Self { k, beta, g0, r0, gamma_e, eta_e, .. } = *self;
        let denominator = 1.0 + 1.0 / (beta * r0) * (g0 * r0 / (speed * speed) - 1.0) * (1.0 - eta_e / eta);
        if denominator <= 0.0 {
            return Err(End::Pole(80));
        }
        // (80) cos γ = [cos γ_e + k(η - η_e)] / [1 + (1/(βr₀))(g₀r₀/V² - 1)(1 - η_e/η)]
        let cos_gamma = (cos(gamma_e) + k * (eta - eta_e)) / denominator;
        let gamma = descending(cos_gamma, 80)?;
        Ok(Prediction { flight_path_angle: Some(gamma), ..Prediction::default() })
    }

    /// Steep, gliding entry, on which lift and drag outweigh gravity and centrifugal relief.
    ///
    /// Equation 81 is printed with `γ_e` for `cos γ_e`, equation 82 with the exponent `(2γ_e - γ)/k`, and equation 83 with V for `V_e`
    /// and the exponent `2(γ - γ_e)/k`.
    ///
    /// # Reference
    /// Jameson 2006, equations 81 to 83, "Steep, Gliding Entry".
    pub(super) fn steep_glide(&self, eta: f64) -> Result<Prediction, End> {
        let Self { k, beta, speed_e, gamma_e, eta_e, .. } = *self;
        // (81) cos γ = cos γ_e + k(η - η_e)
        let gamma = descending(cos(gamma_e) + k * (eta - eta_e), 81)?;
        // cos γ - cos γ_e = 2 sin[(γ_e + γ)/2] sin[(γ_e - γ)/2], which keeps the digits of γ_e - γ where k is small
        let turn = 2.0 * asin(k * (eta - eta_e) / (2.0 * sin(0.5 * (gamma_e + gamma))));
        // (82) V² = V_e² exp[2(γ_e - γ)/k]
        let speed_squared = speed_e * speed_e * exp(2.0 * turn / k);
        // (83) -dV/dt = β V_e² [(cos γ - cos γ_e)/k + η_e] exp[2(γ_e - γ)/k], whose bracket is η by (81)
        Ok(Prediction::of(speed_squared, gamma, beta * eta * speed_squared))
    }

    /// Steep, ballistic entry: a straight line.
    ///
    /// With A of equation 86 put into equation 87, the exponentials stand in ratios that do not overflow.
    ///
    /// # Reference
    /// Jameson 2006, equations 84 to 87, "Steep, Ballistic Entry"; the deceleration is that of equation 79.
    pub(super) fn steep_ballistic(&self, eta: f64) -> Prediction {
        let Self { beta, g0, speed_e, gamma_e, eta_e, .. } = *self;
        // (84) γ = γ_e
        let gamma = gamma_e;
        // (85) α = -2η / sin γ_e
        let [alpha, alpha_e] = [eta, eta_e].map(|eta| -2.0 * eta / sin(gamma_e));
        // (86) A = V_e² β e^(α_e) / (2g₀) - Ei(α_e)
        // (87) V² = (2g₀/β) e^(-α) [A + Ei(α)]
        let decay = exp(alpha_e - alpha);
        let speed_squared =
            decay * speed_e * speed_e + 2.0 * g0 / beta * (scaled_ei(alpha) - decay * scaled_ei(alpha_e));
        Prediction::of(speed_squared, gamma, beta * eta * speed_squared)
    }

    /// Medium, gliding entry from more than circular speed, by Wang and Ting.
    ///
    /// Equation 88 is printed with ln(η/η) for `ln(η/η_e)`. As printed, its bracket reaches zero at 21.30 km on the case of Table 7,
    /// the altitude that the thesis reports; as it must be, at 21.47 km.
    ///
    /// # Reference
    /// Jameson 2006, equations 88 to 90, "Medium, Gliding Entry at Supercircular Velocity".
    pub(super) fn medium_glide(&self, eta: f64) -> Result<Prediction, End> {
        let Self { k, beta, g0, r0, speed_e, gamma_e, eta_e, .. } = *self;
        // (1/(βr₀))(1 - g₀r₀/V_e²)
        let excess = 1.0 / (beta * r0) * (1.0 - g0 * r0 / (speed_e * speed_e));
        let bracket = gamma_e * gamma_e - 2.0 * k * (eta - eta_e) - 2.0 * excess * ln(eta / eta_e);
        if bracket < 0.0 {
            return Err(End::Bracket);
        }
        // (88) γ = -[γ_e² - 2k(η - η_e) - (2/(βr₀))(1 - g₀r₀/V_e²) ln(η/η_e)]^½
        let gamma = -bracket.sqrt();
        let denominator = k + excess / eta;
        if denominator * (k + excess / eta_e) <= 0.0 {
            return Err(End::Pole(89));
        }
        // (89) V² = V_e² exp{2(γ_e - γ) / [k + (1/(βr₀η))(1 - g₀r₀/V_e²)]}
        let speed_squared = speed_e * speed_e * exp(2.0 * (gamma_e - gamma) / denominator);
        // (90) -dV/dt = βηV²
        Ok(Prediction::of(speed_squared, gamma, beta * eta * speed_squared))
    }
}

impl Prediction {
    fn of(speed_squared: f64, flight_path_angle: f64, drag_deceleration: f64) -> Self {
        Self {
            speed: Some(speed_squared.sqrt()),
            flight_path_angle: Some(flight_path_angle),
            drag_deceleration: Some(drag_deceleration),
        }
    }
}

/// The flight-path angle of a descent, in [-π/2, 0], with the cosine that an equation gives.
fn descending(cos_gamma: f64, equation: u8) -> Result<f64, End> {
    match cos_gamma {
        cos_gamma if cos_gamma > 1.0 => Err(End::Level(equation)),
        cos_gamma if cos_gamma < 0.0 => Err(End::Vertical(equation)),
        _ => Ok(-acos(cos_gamma)),
    }
}
