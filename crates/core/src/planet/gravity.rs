//! Gravity: of a point, or of a body that is flattened at its poles.

use crate::scalar::Scalar;

/// How gravity falls off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gravity {
    /// That of a point at the planet's centre.
    InverseSquare,
    /// With zonal harmonics, which do not change around the axis.
    Zonal(Zonal),
}

/// Zonal harmonics: the potential is
///
/// ```text
/// U = -GM/r [1 - Σ Jₙ (a/r)ⁿ Pₙ(sin φ)],   n = 2, 3, 4
/// ```
///
/// with the planet's equatorial radius a and Legendre's polynomials Pₙ.
///
/// # Reference
/// D. A. Vallado, Fundamentals of Astrodynamics and Applications, 4th ed. 2013, section 8.6.1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Zonal {
    /// J₂, J₃ and J₄; zero where the degree of the model is less.
    pub coefficients: [f64; 3],
}

/// An acceleration of gravity: `-inward r̂ - axial ẑ`, m/s².
pub(crate) struct Pull<S> {
    pub(crate) inward: S,
    pub(crate) axial: S,
}

impl Zonal {
    /// The Earth's.
    ///
    /// J₂ is that of WGS 84, whose C̄₂₀ is -0.484166774985e-3; J₃ and J₄ are those of EGM96, with C̄₃₀ = 0.957254173792e-6 and
    /// C̄₄₀ = 0.539873863789e-6: Jₙ = -√(2n + 1) C̄ₙ₀.
    ///
    /// # Reference
    /// NIMA TR8350.2, 3rd edition, amendment 1 (2000), tables 3.2 and 5.1.
    pub const EARTH: Self = Self { coefficients: [1.082_629_821_3e-3, -2.532_656_485_3e-6, -1.619_621_591_4e-6] };

    /// The same without the harmonics above a degree of 2, 3 or 4.
    #[must_use]
    pub fn up_to(self, degree: usize) -> Self {
        let [j2, j3, j4] = self.coefficients;
        Self { coefficients: [j2, if degree >= 3 { j3 } else { 0.0 }, if degree >= 4 { j4 } else { 0.0 }] }
    }

    /// The acceleration over that of a point, GM/r², at the sine of the latitude, with a/r.
    ///
    /// With s = sin φ, since `(n + 1) Pₙ + s Pₙ' = Pₙ₊₁'`:
    ///
    /// ```text
    /// g = -(GM/r²) [(1 - Σ Jₙ (a/r)ⁿ Pₙ₊₁'(s)) r̂ + Σ Jₙ (a/r)ⁿ Pₙ'(s) ẑ]
    /// ```
    #[inline(always)]
    pub(super) fn pull<S: Scalar>(&self, sin_latitude: S, a_over_r: S) -> Pull<S> {
        let [j2, j3, j4] = self.coefficients;
        let [s, square] = [sin_latitude, sin_latitude * sin_latitude];
        let second = a_over_r * a_over_r;
        let [j2, j3, j4] = [second * j2, second * a_over_r * j3, second * second * j4];
        // P₂', P₃', P₄' and P₅'
        let p2 = s * 3.0;
        let p3 = square * 7.5 - 1.5;
        let p4 = s * (square * 17.5 - 7.5);
        let p5 = square * (square * 39.375 - 26.25) + 1.875;
        Pull { inward: -(j2 * p3 + j3 * p4 + j4 * p5) + 1.0, axial: j2 * p2 + j3 * p3 + j4 * p4 }
    }

    /// The potential over that of a point, -GM/r: 1 - Σ Jₙ (a/r)ⁿ Pₙ(sin φ).
    pub(super) fn potential<S: Scalar>(&self, sin_latitude: S, a_over_r: S) -> S {
        let [j2, j3, j4] = self.coefficients;
        let square = sin_latitude * sin_latitude;
        let p2 = square * 1.5 - 0.5;
        let p3 = sin_latitude * (square * 2.5 - 1.5);
        let p4 = square * (square * 4.375 - 3.75) + 0.375;
        let second = a_over_r * a_over_r;
        -(second * (p2 * j2 + a_over_r * p3 * j3 + second * p4 * j4)) + 1.0
    }
}
