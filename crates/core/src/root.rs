//! The zero of a function between two points where it has opposite signs.

/// Finds a zero of `function` between `a` and `b`, where it takes the values `fa` and `fb` of opposite sign (or zero).
///
/// The straight line between the ends first, which most functions here nearly are; then inverse quadratic interpolation where it can be
/// trusted, bisection elsewhere. Ends where the zero is known to `resolution` or to that of `f64`, and after at most 200 evaluations.
/// Returns the point with the smallest value that was seen.
///
/// # Reference
/// T. R. Chandrupatla, A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without
/// using derivatives, Advances in Engineering Software 28 (1997) 145-149.
pub fn bracketed(mut function: impl FnMut(f64) -> f64, a: (f64, f64), b: (f64, f64), resolution: f64) -> f64 {
    let [(mut x1, mut f1), (mut x2, mut f2)] = [b, a];
    if f1 == 0.0 || f2 == 0.0 {
        return if f1 == 0.0 { x1 } else { x2 };
    }
    let straight = f1 / (f1 - f2);
    let mut part = if straight > 0.0 && straight < 1.0 { straight } else { 0.5 };
    for _ in 0..200 {
        let x = x1 + part * (x2 - x1);
        let f = function(x);
        let (x3, f3);
        if (f < 0.0) == (f1 < 0.0) {
            (x3, f3) = (x1, f1);
        } else {
            (x3, f3) = (x2, f2);
            (x2, f2) = (x1, f1);
        }
        (x1, f1) = (x, f);

        let (best, least) = if f2.abs() < f1.abs() { (x2, f2) } else { (x1, f1) };
        let finest = 2.0 * f64::EPSILON * best.abs() + f64::MIN_POSITIVE;
        let limit = finest.max(0.5 * resolution) / (x2 - x1).abs();
        if limit > 0.5 || least == 0.0 {
            return best;
        }
        let xi = (x1 - x2) / (x3 - x2);
        let phi = (f1 - f2) / (f3 - f2);
        let quadratic = phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi;
        part = if quadratic {
            (f1 / (f2 - f1)) * (f3 / (f2 - f3)) + (x3 - x1) / (x2 - x1) * (f1 / (f3 - f1)) * (f2 / (f3 - f2))
        } else {
            0.5
        };
        part = part.clamp(limit, 1.0 - limit);
    }
    if f2.abs() < f1.abs() { x2 } else { x1 }
}

#[cfg(test)]
mod tests {
    use super::bracketed;

    #[test]
    fn finds_the_zero_of_steep_flat_and_kinked_functions() {
        let check = |function: fn(f64) -> f64, a: f64, b: f64, zero: f64| {
            let found = bracketed(function, (a, function(a)), (b, function(b)), 0.0);
            assert!((found - zero).abs() <= 4.0 * f64::EPSILON * zero.abs().max(1.0), "{found} is not {zero}");
        };
        check(|x| x * x - 2.0, 0.0, 2.0, 2.0_f64.sqrt());
        check(|x| x.exp() - 1e10, 0.0, 100.0, 1e10_f64.ln());
        check(|x| (x - 0.3).signum() * (x - 0.3).abs().sqrt(), -1.0, 1.0, 0.3);
        check(|x| x, 0.0, 1.0, 0.0);
        check(|x| 1.0 - x, 0.0, 1.0, 1.0);
    }
}
