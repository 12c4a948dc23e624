//! ln ρ and the molecular-scale temperature by altitude, in layers and cells.

use std::array::from_fn;
use std::sync::LazyLock;

use super::gases::{self, Integrals};
use super::{GAS_CONSTANT, GRAVITY, MIXED_TOP, MOLECULAR_WEIGHT, TOP, geopotential};
use crate::elementary::{ln, ln_1p};
use crate::scalar::Scalar;

/// H, m, and `dT_M/dH`, K/m, from there on (Table 4); the first layer is the second, continued below -5 km.
const LAYERS: [(f64, f64); 8] = [
    (0.0, -0.0065),
    (0.0, -0.0065),
    (11e3, 0.0),
    (20e3, 0.001),
    (32e3, 0.0028),
    (47e3, 0.0),
    (51e3, -0.0028),
    (71e3, -0.002),
];
/// T₀, K, and P₀, Pa (Table 2).
const SEA_LEVEL: [f64; 2] = [288.15, 101_325.0];
/// `T_M/T_b` under which no layer goes, where a trial stage looks far over its end.
const COLDEST: f64 = 0.1;

/// From the first altitude on so many cells of this length, m: every boundary of the gases is a knot.
const CELLS: [(f64, usize, f64); 2] = [(MIXED_TOP, 256, 250.0), (150e3, 170, 5000.0)];
const KNOTS: usize = CELLS[0].1 + CELLS[1].1;

/// Steps of the method of Runge and Kutta in half a cell: four times as many change the density by 2e-11.
const STEPS: usize = 5;
/// The slopes at the ends of a cell are taken so far inside, m, since some jump there.
const INSIDE: f64 = 1e-6;

/// The table; its integrals are taken when it is first used.
pub(super) static TABLE: LazyLock<Table> = LazyLock::new(Table::new);

/// The layers of mixed air, and the cells above 86 km.
pub(super) struct Table {
    pub(super) layers: [Layer; LAYERS.len()],
    /// Below 86 km, as far as a trial stage brings the gases there; in the cells; above 1000 km.
    cells: Vec<Cell>,
}

/// A layer of mixed air; the logarithm of its density is `ln ρ_b + power ln(T_M/T_b) + decay (H - H_b)`.
pub(super) struct Layer {
    /// `H_b`, m.
    base: f64,
    /// `T_b`, K.
    temperature: f64,
    /// `dT_M/dH` over `T_b`, 1/m.
    growth: f64,
    power: f64,
    /// `ln ρ_b`.
    log_density: f64,
    /// 1/m.
    decay: f64,
}

/// Where in a layer something is.
pub(super) struct Place<S> {
    /// H - `H_b`, m.
    height: S,
    /// `T_M/T_b`.
    warmth: S,
}

/// x₀, m, and the coefficients in x - x₀ of two polynomials.
struct Cell {
    log_density: [f64; 7],
    /// The molecular-scale temperature, K.
    temperature: [f64; 7],
}

impl Layer {
    /// The place of a geometric altitude, m, as if the layer had no end.
    #[inline(always)]
    pub(super) fn place<S: Scalar>(&self, altitude: S) -> Place<S> {
        let height = geopotential(altitude) - self.base;
        let warmth = height * self.growth + 1.0;
        Place { height, warmth: S::select(warmth.less_than(COLDEST), S::from(COLDEST), warmth) }
    }

    #[inline(always)]
    pub(super) fn density<S: Scalar>(&self, place: &Place<S>) -> S {
        let line = place.height * self.decay + self.log_density;
        if self.power == 0.0 { line.exp() } else { (place.warmth.ln() * self.power + line).exp() }
    }

    /// `T_M`, K.
    #[inline(always)]
    pub(super) fn molecular_scale_temperature<S: Scalar>(&self, place: &Place<S>) -> S {
        place.warmth * self.temperature
    }
}

impl Cell {
    fn new(base: f64, log_density: [f64; 6], temperature: [f64; 6]) -> Self {
        let [c0, c1, c2, c3, c4, c5] = log_density;
        let [t0, t1, t2, t3, t4, t5] = temperature;
        Self { log_density: [base, c0, c1, c2, c3, c4, c5], temperature: [base, t0, t1, t2, t3, t4, t5] }
    }
}

impl Table {
    /// The density above 86 km, kg/m³.
    #[inline(always)]
    pub(super) fn density_of_gases<S: Scalar>(&self, altitude: S) -> S {
        let [base, c0, c1, c2, c3, c4, c5] = altitude.pick(|altitude| self.cell(altitude).log_density);
        polynomial(altitude - base, [c0, c1, c2, c3, c4, c5]).exp()
    }

    /// `T_M` above 86 km, K.
    #[inline(always)]
    pub(super) fn molecular_scale_temperature_of_gases<S: Scalar>(&self, altitude: S) -> S {
        let [base, c0, c1, c2, c3, c4, c5] = altitude.pick(|altitude| self.cell(altitude).temperature);
        polynomial(altitude - base, [c0, c1, c2, c3, c4, c5])
    }

    #[inline(always)]
    fn cell(&self, altitude: f64) -> &Cell {
        let [(lower, lower_cells, lower_length), (upper, _, upper_length)] = CELLS;
        let number = if altitude < lower {
            0
        } else if altitude < upper {
            1 + cell(altitude, lower, lower_length)
        } else {
            1 + lower_cells + cell(altitude, upper, upper_length)
        };
        &self.cells[number.min(KNOTS + 1)]
    }

    fn new() -> Self {
        let (layers, log_density) = layers();
        Self { layers, cells: cells(log_density) }
    }
}

/// c₀ + c₁x + … + c₅x⁵, in pairs, which do not wait for each other.
#[inline(always)]
fn polynomial<S: Scalar>(x: S, [c0, c1, c2, c3, c4, c5]: [S; 6]) -> S {
    let square = x * x;
    (c5 * x + c4) * (square * square) + ((c3 * x + c2) * square + (c1 * x + c0))
}

/// The mixed air, and ln ρ at 86 km.
///
/// ```text
/// T_M = T_b + L (H - H_b)                                     (23)
/// P = P_b (T_b/T_M)^(g₀M₀/(R*L)),  L ≠ 0                      (33a)
/// P = P_b exp(-g₀M₀ (H - H_b)/(R*T_b)),  L = 0                (33b)
/// ρ = P M₀/(R* T_M)                                           (42)
/// ```
fn layers() -> ([Layer; LAYERS.len()], f64) {
    let [mut temperature, pressure] = SEA_LEVEL;
    let mut log_density = ln(pressure * MOLECULAR_WEIGHT / (GAS_CONSTANT * temperature));
    let layers = from_fn(|number| {
        let (base, lapse) = LAYERS[number];
        let top = LAYERS.get(number + 1).map_or(geopotential(MIXED_TOP), |(base, _)| *base);
        let column = -GRAVITY * MOLECULAR_WEIGHT / GAS_CONSTANT;
        let [power, decay] = if lapse == 0.0 { [0.0, column / temperature] } else { [column / lapse - 1.0, 0.0] };
        let growth = lapse / temperature;
        let layer = Layer { base, temperature, growth, power, log_density, decay };
        log_density += power * ln_1p(growth * (top - base)) + decay * (top - base);
        temperature += lapse * (top - base);
        layer
    });
    (layers, log_density)
}

/// The gases.
///
/// At 86 km their number densities give 8e-6 more density than the closed forms below. All are made smaller by that.
fn cells(log_density_at_86_km: f64) -> Vec<Cell> {
    let mut cells = Vec::with_capacity(KNOTS + 2);
    let integrals = integrals();
    let at_500_km = integrals[2 * (CELLS[0].1 + cell(500e3, CELLS[1].0, CELLS[1].2))];
    let at_86_km = gases::point(MIXED_TOP, &integrals[0], &at_500_km);
    let join = log_density_at_86_km - at_86_km.log_density[0];
    for knot in 0..KNOTS {
        let (left, length) = cell_at(knot);
        let points = [(INSIDE, 0), (0.5 * length, 1), (length - INSIDE, 2)].map(|(x, half)| {
            let mut point = gases::point(left + x, &integrals[2 * knot + half], &at_500_km);
            point.log_density[0] += join;
            point
        });
        let log_density = hermite(length, points.each_ref().map(|point| point.log_density));
        let temperature = hermite(length, points.each_ref().map(|point| point.molecular_scale_temperature));
        if knot == 0 {
            let tangent = [log_density[0], log_density[1], 0.0, 0.0, 0.0, 0.0];
            cells.push(Cell::new(left, tangent, [temperature[0], 0.0, 0.0, 0.0, 0.0, 0.0]));
        }
        cells.push(Cell::new(left, log_density, temperature));
    }
    let top = gases::point(TOP, &integrals[2 * KNOTS], &at_500_km);
    let [log_density, slope] = top.log_density;
    let [temperature, _] = top.molecular_scale_temperature;
    cells.push(Cell::new(TOP, [log_density + join, slope, 0.0, 0.0, 0.0, 0.0], [temperature, 0.0, 0.0, 0.0, 0.0, 0.0]));
    cells
}

/// The number of the cell in which an abscissa lies, of cells of equal length; 0 below the first.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "what is out of range saturates")]
pub(super) fn cell(abscissa: f64, first: f64, length: f64) -> usize {
    ((abscissa - first) / length) as usize
}

/// So many lengths.
#[inline(always)]
#[expect(clippy::cast_precision_loss, reason = "a few hundred")]
pub(super) fn offset(cells: usize, length: f64) -> f64 {
    cells as f64 * length
}

/// The left end of a cell and its length, m.
fn cell_at(knot: usize) -> (f64, f64) {
    let [(lower, lower_cells, lower_length), (upper, _, upper_length)] = CELLS;
    if knot < lower_cells {
        (lower + offset(knot, lower_length), lower_length)
    } else {
        (upper + offset(knot - lower_cells, upper_length), upper_length)
    }
}

/// The integrals at the knots and half-way.
fn integrals() -> Vec<Integrals> {
    let mut all = vec![[0.0; 7]; 2 * KNOTS + 1];
    for half in 0..2 * KNOTS {
        let (left, length) = cell_at(half / 2);
        let start = left + offset(half % 2, 0.5 * length);
        all[half + 1] = runge_kutta(start, 0.5 * length, STEPS, all[half]);
    }
    all
}

/// The integrals so far up from `start`, by the classical method of Runge and Kutta.
fn runge_kutta(start: f64, length: f64, steps: usize, mut integrals: Integrals) -> Integrals {
    let step = length / offset(steps, 1.0);
    let slopes = |x: f64, y: &Integrals| gases::integrands(start + x.clamp(INSIDE, length - INSIDE), y);
    for number in 0..steps {
        let x = offset(number, step);
        let after = |slopes: &Integrals, step: f64| -> Integrals { from_fn(|i| integrals[i] + step * slopes[i]) };
        let k1 = slopes(x, &integrals);
        let k2 = slopes(x + 0.5 * step, &after(&k1, 0.5 * step));
        let k3 = slopes(x + 0.5 * step, &after(&k2, 0.5 * step));
        let k4 = slopes(x + step, &after(&k3, step));
        integrals = after(&from_fn(|i| (k1[i] + 2.0 * (k2[i] + k3[i]) + k4[i]) / 6.0), step);
    }
    integrals
}

/// The polynomial of degree 5 on [0, length] with these values and slopes at the ends and half-way.
fn hermite(length: f64, [[f0, d0], [f1, d1], [f2, d2]]: [[f64; 2]; 3]) -> [f64; 6] {
    let [a, b] = [f1 - f0, f2 - f0];
    let [d0, d1, d2] = [d0, d1, d2].map(|slope| slope * length);
    let mut coefficients = [
        f0,
        d0,
        16.0 * a + 7.0 * b - 6.0 * d0 - 8.0 * d1 - d2,
        -32.0 * a - 34.0 * b + 13.0 * d0 + 32.0 * d1 + 5.0 * d2,
        16.0 * a + 52.0 * b - 12.0 * d0 - 40.0 * d1 - 8.0 * d2,
        -24.0 * b + 4.0 * d0 + 16.0 * d1 + 4.0 * d2,
    ];
    let mut unit = 1.0;
    for coefficient in &mut coefficients {
        *coefficient /= unit;
        unit *= length;
    }
    coefficients
}

#[cfg(test)]
mod tests {
    use super::{Integrals, KNOTS, cell_at, gases, integrals, runge_kutta};
    use crate::atmosphere::us76::density;

    /// A quarter into a cell the polynomials are at their worst, and worst of all below 110 km, where the temperature bends most.
    #[test]
    fn polynomials_give_back_the_integrals() {
        let all = integrals();
        let at_500_km = all[2 * (256 + 70)];
        let log_density =
            |altitude: f64, integrals: &Integrals| gases::point(altitude, integrals, &at_500_km).log_density[0];
        // The density is made continuous at 86 km by a factor.
        let join = f64::ln(density(86e3)) - log_density(86e3, &all[0]);
        assert!(join.abs() < 1e-5, "{join:e}");
        for knot in 0..KNOTS {
            let (left, length) = cell_at(knot);
            let there = runge_kutta(left, 0.25 * length, 25, all[2 * knot]);
            let altitude = left + 0.25 * length;
            let error = f64::ln(density(altitude)) - join - log_density(altitude, &there);
            assert!(error.abs() < 2e-9, "{error:e} at {altitude} m");
        }
    }
}
