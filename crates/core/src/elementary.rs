//! Elementary functions of numbers, whose digits depend neither on the processor nor on the system's library.
//!
//! Exponential, logarithm, sine and cosine are at most one unit in the last place off, and are computed without tables, and but for huge angles
//! without branches, so that compilers compute several of them at once. The others are those of the crate `libm`.
//!
//! The polynomials are the best of their degrees (found by E. Remez's exchange algorithm), their coefficients rounded to double precision.

pub use libm::{acos, asin, atan, atan2, atanh, cbrt, exp2, hypot, log1p as ln_1p, log2, log10, pow};

/// 1.5 × 2⁵²: what is added to it is rounded to an integer, which the last bits of the sum are.
const TO_INTEGER: f64 = 6_755_399_441_055_744.0;
/// The bits of 1.
const ONE: u64 = 0x3ff0_0000_0000_0000;
/// ln 2: its first 41 bits, so that products with exponents are exact, and the rest.
const LN_2: [f64; 2] = [0.693_147_180_559_663, 2.823_529_056_303_157_7e-13];
/// π/2: twice 43 bits, so that products with the numbers of quadrants are exact, and the rest.
const QUADRANT: [f64; 3] = [1.570_796_326_794_834_4, 6.223_372_171_896_261e-14, 3.521_559_865_183_2e-27];
/// Exponents up to this one, either way, have exponentials that lose no digits.
const MOST_EXPONENT: f64 = 708.0;
/// Angles up to this one, rad, have numbers of quadrants of ten bits.
const MOST_QUADRANTS: f64 = 1600.0;

/// eˣ.
///
/// # Examples
/// ```
/// use reentry::elementary::exp;
///
/// assert_eq!([exp(0.0), exp(f64::INFINITY), exp(f64::NEG_INFINITY)], [1.0, f64::INFINITY, 0.0]);
/// ```
#[inline(always)]
pub fn exp(x: f64) -> f64 {
    if has_normal_exponential(x) { normal_exponential(x) } else { exponential_out_of_range(x) }
}

/// Whether [`normal_exponential`] is exact.
#[inline(always)]
pub(crate) fn has_normal_exponential(x: f64) -> bool {
    x.abs() <= MOST_EXPONENT
}

/// eˣ where that is tiny or huge, or x not a number.
#[cold]
#[inline(never)]
pub(crate) fn exponential_out_of_range(x: f64) -> f64 {
    // Beyond, it is 0 or infinite; what is not a number stays so.
    let x = if x < -746.0 { -746.0 } else { x };
    let x = if x > 710.0 { 710.0 } else { x };
    // In two parts, as 2ᵏ alone may be out of range.
    let [e, k] = exponential(x);
    let half = rounded(k * 0.5);
    e * power_of_two(half) * power_of_two(k - half)
}

/// eˣ of a number that [has a normal one](has_normal_exponential).
#[inline(always)]
pub(crate) fn normal_exponential(x: f64) -> f64 {
    let [e, k] = exponential(x);
    e * power_of_two(k)
}

/// e and k, of which eˣ is e 2ᵏ.
#[inline(always)]
fn exponential(x: f64) -> [f64; 2] {
    const Q: [f64; 11] = [
        0.5,
        0.166_666_666_666_666_82,
        0.041_666_666_666_666_095,
        0.008_333_333_333_316_983,
        0.001_388_888_888_911_634_4,
        0.000_198_412_698_965_149_37,
        2.480_158_692_574_501e-5,
        2.755_723_472_794_911_4e-6,
        2.755_758_226_164_718e-7,
        2.511_208_447_545_167e-8,
        2.082_658_841_576_385e-9,
    ];
    // x = k ln 2 + r, with what r has lost by rounding
    let k = rounded(x * std::f64::consts::LOG2_E);
    let (high, low) = (x - k * LN_2[0], k * LN_2[1]);
    let r = high - low;
    let lost = (high - r) - low;
    // eʳ = 1 + r + r² q(r). What waits for the least comes last, and of the sums those parts first that are known first.
    let r2 = r * r;
    let r4 = r2 * r2;
    let r6 = r4 * r2;
    let pair = |i: usize| Q[i] + r * Q[i + 1];
    let [first, second, third] = [pair(0) + r2 * pair(2), pair(4) + r2 * pair(6), pair(8) + r2 * Q[10]];
    let sum = 1.0 + r;
    let rest = ((1.0 - sum) + r) + lost;
    [sum + ((rest + r2 * first) + (r6 * second + (r6 * r4) * third)), k]
}

/// ln x; not a number where x is negative.
///
/// # Examples
/// ```
/// use reentry::elementary::ln;
///
/// assert_eq!([ln(1.0), ln(0.0), ln(f64::INFINITY)], [0.0, f64::NEG_INFINITY, f64::INFINITY]);
/// ```
#[inline(always)]
pub fn ln(x: f64) -> f64 {
    if is_normal(x) { logarithm(x) } else { logarithm_out_of_range(x) }
}

/// Whether a number is positive, and not so small that it has lost digits, or infinite.
#[inline(always)]
pub(crate) fn is_normal(x: f64) -> bool {
    (f64::MIN_POSITIVE..=f64::MAX).contains(&x)
}

/// The logarithm of what is not [normal](is_normal).
#[cold]
#[inline(never)]
pub(crate) fn logarithm_out_of_range(x: f64) -> f64 {
    if x > 0.0 && x < f64::INFINITY {
        let logarithm = logarithm(x * 18_014_398_509_481_984.0);
        logarithm - 54.0 * LN_2[0] - 54.0 * LN_2[1]
    } else if x == 0.0 {
        f64::NEG_INFINITY
    } else if x < 0.0 {
        f64::NAN
    } else {
        x
    }
}

/// The logarithm of a [normal](is_normal) number.
#[inline(always)]
pub(crate) fn logarithm(x: f64) -> f64 {
    const R: [f64; 8] = [
        0.666_666_666_666_666_6,
        0.400_000_000_000_062_64,
        0.285_714_285_690_809_76,
        0.222_222_226_475_596_34,
        0.181_817_756_030_451_7,
        0.153_870_935_379_949_7,
        0.132_500_545_146_162_33,
        0.132_519_148_489_012_64,
    ];
    /// The bits of √½.
    const SQRT_HALF: u64 = 0x3fe6_a09e_667f_3bcd;
    const MANTISSA: u64 = 0x000f_ffff_ffff_ffff;
    /// The bits of 2⁵², whose last bits are those of an integer that is added to it.
    const SHIFT: u64 = 0x4330_0000_0000_0000;
    // x = 2ᵏ (1 + f), √½ ≤ 1 + f < √2
    let bits = x.to_bits().wrapping_add(ONE - SQRT_HALF);
    let k = f64::from_bits((bits >> 52) | SHIFT) - (4_503_599_627_370_496.0 + 1023.0);
    let f = f64::from_bits((bits & MANTISSA) + SQRT_HALF) - 1.0;
    // ln (1 + f) = f - f²/2 + s (f²/2 + s² R(s²)), s = f/(2 + f)
    let s = f / (2.0 + f);
    let z = s * s;
    let z2 = z * z;
    let s3 = s * z;
    let pair = |i: usize| R[i] + z * R[i + 1];
    let [first, second] = [pair(0) + z2 * pair(2), pair(4) + z2 * pair(6)];
    let half = 0.5 * f * f;
    // The larger parts, with what their sum has lost by rounding
    let [sum, lost] = difference(k * LN_2[0], -f);
    sum + (((lost + (k * LN_2[1] - half)) + s * half) + (s3 * first + (s3 * (z2 * z2)) * second))
}

/// Sine and cosine of an angle, rad.
///
/// # Examples
/// ```
/// use reentry::elementary::sin_cos;
///
/// assert_eq!(sin_cos(0.0), (0.0, 1.0));
/// assert!(sin_cos(f64::INFINITY).0.is_nan());
/// ```
#[inline(always)]
pub fn sin_cos(x: f64) -> (f64, f64) {
    if has_few_quadrants(x) { sin_cos_of_few_quadrants(x) } else { sin_cos_of_many_quadrants(x) }
}

/// The sine of an angle, rad.
pub fn sin(x: f64) -> f64 {
    sin_cos(x).0
}

/// The cosine of an angle, rad.
pub fn cos(x: f64) -> f64 {
    sin_cos(x).1
}

/// Whether [`sin_cos_of_few_quadrants`] is exact.
#[inline(always)]
pub(crate) fn has_few_quadrants(x: f64) -> bool {
    x.abs() <= MOST_QUADRANTS
}

/// Sine and cosine of a huge angle, rad, or of what is not a number.
#[cold]
#[inline(never)]
pub(crate) fn sin_cos_of_many_quadrants(x: f64) -> (f64, f64) {
    libm::sincos(x)
}

/// Sine and cosine of an angle, rad, that [has few quadrants](has_few_quadrants).
#[inline(always)]
pub(crate) fn sin_cos_of_few_quadrants(x: f64) -> (f64, f64) {
    const S: [f64; 7] = [
        -0.166_666_666_666_666_66,
        0.008_333_333_333_333_323,
        -0.000_198_412_698_412_550_64,
        2.755_731_921_418_811_4e-6,
        -2.505_210_491_096_806e-8,
        1.605_836_654_642_896_7e-10,
        -7.578_693_749_195_923e-13,
    ];
    const C: [f64; 6] = [
        0.041_666_666_666_666_6,
        -0.001_388_888_888_887_406_6,
        2.480_158_728_944_41e-5,
        -2.755_731_434_081_676_5e-7,
        2.087_572_164_297_018_6e-9,
        -1.135_956_024_005_823_4e-11,
    ];
    // x = k π/2 + r, with what r has lost by rounding
    let shifted = x * std::f64::consts::FRAC_2_PI + TO_INTEGER;
    let (k, quadrant) = (shifted - TO_INTEGER, shifted.to_bits());
    let exact = x - k * QUADRANT[0];
    let [near, rest] = difference(exact, k * QUADRANT[1]);
    let [r, lost] = difference(near, k * QUADRANT[2] - rest);
    let z = r * r;
    let z2 = z * z;
    let pair = |c: &[f64], i: usize| c[i] + z * c[i + 1];
    let s = pair(&S, 0) + z2 * (pair(&S, 2) + z2 * (pair(&S, 4) + z2 * S[6]));
    let c = pair(&C, 0) + z2 * (pair(&C, 2) + z2 * pair(&C, 4));
    // sin (r + δ) = r + r³ s + δ (1 - r²/2)
    let half = 0.5 * z;
    let sine = r + (r * z * s + (lost - half * lost));
    // cos (r + δ) = 1 - r²/2 + r⁴ c - r δ
    let near_cosine = 1.0 - half;
    let cosine = near_cosine + (((1.0 - near_cosine) - half) + (z2 * c - r * lost));
    let swaps = quadrant & 1 != 0;
    let [of_sine, of_cosine] = if swaps { [cosine, sine] } else { [sine, cosine] };
    let sign = |quadrant: u64| (quadrant & 2) << 62;
    let signed = |number: f64, sign: u64| f64::from_bits(number.to_bits() ^ sign);
    (signed(of_sine, sign(quadrant)), signed(of_cosine, sign(quadrant.wrapping_add(1))))
}

/// The nearest integer of a number of less than 2⁵¹.
#[inline(always)]
fn rounded(x: f64) -> f64 {
    (x + TO_INTEGER) - TO_INTEGER
}

/// 2ᵏ of an integer from -1022 to 1023.
#[inline(always)]
fn power_of_two(k: f64) -> f64 {
    f64::from_bits(((k + TO_INTEGER).to_bits() << 52).wrapping_add(ONE))
}

/// a - b, and what it has lost by rounding.
///
/// # Reference
/// D. E. Knuth, The Art of Computer Programming, vol. 2, 3rd ed. 1998, section 4.2.2, theorem B.
#[inline(always)]
fn difference(a: f64, b: f64) -> [f64; 2] {
    let difference = a - b;
    let of_a = difference + b;
    let of_b = of_a - difference;
    [difference, (a - of_a) + (of_b - b)]
}
