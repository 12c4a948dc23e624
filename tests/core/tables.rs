//! Interpolation in tables, and the models that are made of them: against their entries, against lines and exponentials, and against
//! themselves in other numbers.

use std::f64::consts::LN_2;
use std::sync::Arc;

use num_dual::{Dual2_64, Dual64};
use proptest::prelude::*;
use reentry::Atmosphere;
use reentry::atmosphere::{Gas, Layer, Layers, Table, us76};
use reentry::elementary::exp;
use reentry::interpolation::{Cubics, Hint, Surfaces, TableError};
use reentry::scalar::{Lanes, Scalar};
use reentry::vehicle::{Aerodynamics, AlphaMachTable, MachTable, Vehicle};
use reentry::wind::WindTable;

use crate::check::{near, relative};
use crate::core::flights::config;

/// Rounding, in parts of the greatest entry.
const ROUNDING: f64 = 1e-13;

fn cubic<S: Scalar>(cubics: &Cubics<1>, segment: usize, x: S) -> S {
    let [value] = cubics.at(segment, x, &Hint::default());
    value
}

fn surface<S: Scalar>(surfaces: &Surfaces, x: S, y: S) -> [S; 2] {
    surfaces.at([1, 1], [x, y], &<[Hint; 2]>::default())
}

fn greatest<'a>(numbers: impl IntoIterator<Item = &'a f64>) -> f64 {
    numbers.into_iter().fold(0.0, |greatest: f64, number| greatest.max(number.abs()))
}

/// Ascending numbers, some of them near each other.
fn abscissae(entries: impl Into<prop::collection::SizeRange>) -> impl Strategy<Value = Vec<f64>> {
    let interval = prop_oneof![0.5..2.0, 0.001..0.1, 1.0..100.0];
    (-10.0..10.0, prop::collection::vec(interval, entries)).prop_map(|(first, intervals)| {
        let next = |at: &mut f64, interval: f64| {
            *at += interval;
            Some(*at)
        };
        intervals.into_iter().scan(first, next).collect()
    })
}

/// Numbers of which some are equal, and some far from the others.
fn values(entries: usize) -> impl Strategy<Value = Vec<f64>> {
    let value = prop_oneof![4 => 0.0..1.0, 1 => Just(0.0), 1 => Just(1.0), 1 => 0.0..1000.0];
    prop::collection::vec(value, entries)
}

fn column() -> impl Strategy<Value = (Vec<f64>, Vec<f64>)> {
    abscissae(1..9).prop_flat_map(|at| (values(at.len()), Just(at))).prop_map(|(values, at)| (at, values))
}

/// A place in a list, with a share of the way to the next one.
fn place(at: &[f64], share: f64) -> (usize, f64) {
    let cells = at.len().saturating_sub(1);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, clippy::cast_precision_loss, reason = "a few")]
    let cell = ((share * cells as f64) as usize).min(cells.saturating_sub(1));
    #[expect(clippy::cast_precision_loss, reason = "a few")]
    let into = share * cells as f64 - cell as f64;
    (cell, if cells == 0 { at[0] } else { at[cell] + into * (at[cell + 1] - at[cell]) })
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn cubics_pass_through_their_entries_and_stay_at_the_ends((at, values) in column()) {
        let cubics = Cubics::new(&at, [&values]).unwrap();
        let tolerance = ROUNDING * greatest(&values);
        for (x, value) in at.iter().zip(&values) {
            near("entry", cubic(&cubics, 1, *x), *value, tolerance);
        }
        for beyond in [-1e300, -1.0, 0.0, 1e300_f64] {
            prop_assert_eq!(cubic(&cubics, 0, beyond).to_bits(), values[0].to_bits());
            prop_assert_eq!(cubic(&cubics, 2, beyond).to_bits(), values[values.len() - 1].to_bits());
        }
    }

    #[test]
    fn cubics_run_between_neighbours_in_their_direction((at, values) in column(), share in 0.0..1.0) {
        let cubics = Cubics::new(&at, [&values]).unwrap();
        let (cell, x) = place(&at, share);
        let next = (cell + 1).min(at.len() - 1);
        let air = cubic(&cubics, 1, Dual64::new(x, 1.0));
        let tolerance = ROUNDING * greatest(&values);
        let (low, high) = (values[cell].min(values[next]), values[cell].max(values[next]));
        prop_assert!(low - tolerance <= air.re && air.re <= high + tolerance, "{} not in {low} to {high}", air.re);
        let rise = values[next] - values[cell];
        let length = (at[next] - at[cell]).max(1e-3);
        prop_assert!(air.eps * rise.signum() >= -tolerance / length * 10.0, "slope {} of a rise by {rise}", air.eps);
    }

    #[test]
    fn cubics_have_one_slope_at_every_entry((at, values) in column()) {
        let cubics = Cubics::new(&at, [&values]).unwrap();
        for x in &at {
            let [below, above] = [x.next_down(), *x].map(|x| cubic(&cubics, 1, Dual64::new(x, 1.0)));
            // The shortest cell is a thousandth, in which a unit of the last digit of 100 is 1e-11; slopes have its square.
            near("value", below.re, above.re, 1e-10 * greatest(&values));
            near("slope", below.eps, above.eps, 1e-7 * greatest(&values));
        }
    }

    #[test]
    fn straight_lines_come_back_and_go_on(at in abscissae(2..9), slope in -10.0..10.0, x in -1.0..2.0_f64) {
        let line = |x: f64| 3.0 + slope * x;
        let values: Vec<f64> = at.iter().copied().map(line).collect();
        let cubics = Cubics::new(&at, [&values]).unwrap();
        let [first, last] = *cubics.range();
        // As far as the cells at the ends are wide.
        let [below, above] = [first - (at[1] - at[0]), last + (last - at[at.len() - 2])];
        let x = f64::clamp(first + x * (last - first), below, above);
        let tolerance = 1e3 * ROUNDING * greatest(&values);
        near("inside", cubic(&cubics, 1, x), line(x), tolerance);
        near("slope", cubic(&cubics, 1, Dual64::new(0.5 * (first + last), 1.0)).eps, slope, 1e4 * tolerance);
        let hint = Hint::default();
        near("below", cubics.extrapolated(0, first - 100.0, &hint)[0], line(first - 100.0), 1e6 * tolerance);
        near("above", cubics.extrapolated(2, last + 100.0, &hint)[0], line(last + 100.0), 1e6 * tolerance);
    }

    #[test]
    fn lanes_and_dual_numbers_have_the_digits_of_f64_whatever_the_hint(
        (at, values) in column(), places in prop::array::uniform8(-50.0..150.0),
    ) {
        let doubled: Vec<f64> = values.iter().map(|value| 2.0 * value).collect();
        let cubics = Cubics::new(&at, [&values, &doubled]).unwrap();
        let larger = Cubics::new(&[-1.0, 0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 1e9], [&[0.0; 13]]).unwrap();
        let stale = Hint::default();
        for segment in 0..3 {
            let lanes = cubics.at(segment, Lanes(places), &stale);
            for (lane, x) in places.into_iter().enumerate() {
                let alone = cubics.at(segment, x, &Hint::default());
                let _ = larger.at(1, 1e8, &stale);
                let dual = cubics.at(segment, Dual64::new(x, 1.0), &stale);
                prop_assert_eq!(lanes.map(|value| value.0[lane].to_bits()), alone.map(f64::to_bits));
                prop_assert_eq!(dual.map(|value| value.re.to_bits()), alone.map(f64::to_bits));
                prop_assert!(alone.iter().chain(&dual.map(|value| value.eps)).all(|number| number.is_finite()));
            }
        }
    }
}

#[test]
fn one_entry_is_a_constant_and_two_are_a_line() {
    let one = Cubics::new(&[2.0], [&[5.0]]).unwrap();
    for segment in 0..3 {
        for x in [f64::MIN, -1.0, 2.0, 7.0, f64::MAX] {
            let value = cubic(&one, segment, Dual64::new(x, 1.0));
            assert_eq!((value.re, value.eps), (5.0, 0.0));
        }
    }
    let two = Cubics::new(&[2.0, 4.0], [&[5.0, 9.0]]).unwrap();
    for (x, value) in [(2.0, 5.0), (2.5, 6.0), (4.0, 9.0), (5.0, 11.0), (6.0, 13.0), (7.0, 13.0), (-1.0, 1.0)] {
        near(&format!("at {x}"), cubic(&two, 1, x), value, 0.0);
    }
}

/// Of a smooth function that has no bend at the ends the slopes are right to the second order: half the interval, a quarter of the error,
/// and between the entries less still.
#[test]
fn smooth_functions_are_met_to_the_third_order() {
    let error = |cells: u32| {
        let at: Vec<f64> = (0..=cells).map(|i| f64::from(i) * std::f64::consts::FRAC_PI_4 / f64::from(cells)).collect();
        let values: Vec<f64> = at.iter().map(|x| x.sin()).collect();
        let cubics = Cubics::new(&at, [&values]).unwrap();
        // Away from the upper end, where the sine bends.
        (0..500).map(|i| f64::from(i) * 1e-3).map(|x| (cubic(&cubics, 1, x) - x.sin()).abs()).fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(20), error(40));
    assert!(fine < 0.14 * coarse && coarse < 1e-5, "{coarse:e}, {fine:e}");
}

/// Of the parabola (x + 10)², whose secants are 21 and 24, over 1 and 2: the slope of the parabola, and no bend at the ends.
#[test]
fn slopes_are_those_of_parabolas_and_bends_vanish_at_the_ends() {
    let cubics = Cubics::new(&[0.0, 1.0, 3.0], [&[100.0, 121.0, 169.0]]).unwrap();
    // By the factor: δ = 1/15, and 3 δ⁴ = 6e-5.
    near("slope", cubic(&cubics, 1, Dual64::new(1.0, 1.0)).eps, 22.0, 2e-3);
    for x in [0.0, 3.0] {
        let bend = cubic(&cubics, 1, Dual2_64::from(x).derivative()).v2;
        near(&format!("bend at {x}"), bend, 0.0, 1e-12);
    }
}

#[test]
fn what_is_no_table_is_refused() {
    let refused = |at: &[f64], values: &[f64]| Cubics::new(at, [values]).unwrap_err();
    assert_eq!(refused(&[], &[]), TableError::TooShort { entries: 0, least: 1 });
    assert_eq!(refused(&[0.0, 1.0], &[0.0]), TableError::LengthsDiffer { entries: 1, expected: 2 });
    assert_eq!(refused(&[0.0, 1.0, 1.0], &[0.0; 3]), TableError::NotAscending { index: 2 });
    assert_eq!(refused(&[0.0, 1.0], &[0.0, f64::NAN]), TableError::OutOfBounds { index: 1 });
    assert_eq!(refused(&[0.0, 1.0, 1.0 + 1e-15], &[0.0, 0.0, 1e300]), TableError::TooSteep { index: 1 });
    let rows = |rows: &[&[f64]]| -> Vec<Vec<f64>> { rows.iter().map(|row| row.to_vec()).collect() };
    let refused = |lift: &[&[f64]], drag: &[&[f64]]| {
        AlphaMachTable::new(&[0.0, 0.1], &[1.0, 2.0], &rows(lift), &rows(drag)).unwrap_err()
    };
    let sound: &[&[f64]] = &[&[0.0, 0.1], &[0.2, 0.3]];
    assert_eq!(refused(&sound[..1], sound), TableError::LengthsDiffer { entries: 1, expected: 2 });
    assert_eq!(refused(sound, &[&[0.0, 0.1], &[0.2]]), TableError::LengthsDiffer { entries: 1, expected: 2 });
    assert_eq!(refused(sound, &[&[0.0, 0.1], &[0.2, -0.3]]), TableError::OutOfBounds { index: 3 });
    assert_eq!(refused(sound, &[&[0.0, 0.1], &[f64::NAN, 0.3]]), TableError::OutOfBounds { index: 2 });
    assert_eq!(refused(sound, &[&[1e308, 0.1], &[0.0, 0.3]]), TableError::TooSteep { index: 0 });
    assert_eq!(MachTable::new(&[1.0, 2.0], &[0.0; 2], &[1.0, -1.0]).unwrap_err(), TableError::OutOfBounds { index: 1 });
    let refused = |density: &[f64]| Table::new(&[0.0, 1e3][..density.len()], density, None, None).unwrap_err();
    assert_eq!(refused(&[1.0]), TableError::TooShort { entries: 1, least: 2 });
    assert_eq!(refused(&[1.0, 0.0]), TableError::OutOfBounds { index: 1 });
}

/// Two matrices over two axes.
#[derive(Clone, Debug)]
struct Grid {
    first: Vec<f64>,
    second: Vec<f64>,
    matrices: [Vec<Vec<f64>>; 2],
}

impl Grid {
    fn surfaces(&self) -> Surfaces {
        let [a, b] = &self.matrices;
        Surfaces::new(&self.first, &self.second, [a, b]).unwrap()
    }

    fn greatest(&self) -> f64 {
        greatest(self.matrices.iter().flatten().flatten())
    }

    /// The matrices of two functions.
    fn of(first: Vec<f64>, second: Vec<f64>, functions: [fn(f64, f64) -> f64; 2]) -> Self {
        let row = |function: fn(f64, f64) -> f64, x: f64| second.iter().map(|y| function(x, *y)).collect();
        let matrices = functions.map(|function| first.iter().map(|x| row(function, *x)).collect());
        Self { first, second, matrices }
    }
}

fn grid() -> impl Strategy<Value = Grid> {
    (abscissae(1..6), abscissae(1..6)).prop_flat_map(|(first, second)| {
        let matrix = || prop::collection::vec(values(second.len()), first.len());
        ([matrix(), matrix()], Just((first, second))).prop_map(|(matrices, (first, second))| Grid {
            first,
            second,
            matrices,
        })
    })
}

/// Without spikes, and no two entries the same.
fn gentle_grid() -> impl Strategy<Value = Grid> {
    let matrix = || prop::collection::vec(prop::collection::vec(0.0..1.0, 4), 4);
    (prop::array::uniform4(0.0..0.5), prop::array::uniform4(0.0..0.5), [matrix(), matrix()]).prop_map(
        |(first, second, matrices)| {
            let spread = |offsets: [f64; 4]| (0..).zip(offsets).map(|(i, offset)| f64::from(i) + offset).collect();
            Grid { first: spread(first), second: spread(second), matrices }
        },
    )
}

proptest! {
    #![proptest_config(config(1000))]

    #[test]
    fn surfaces_are_cubics_along_the_grid(grid in grid(), shares in [0.0..1.0, 0.0..1.0]) {
        let surfaces = grid.surfaces();
        let tolerance = ROUNDING * grid.greatest();
        let (_, x) = place(&grid.first, shares[0]);
        let (_, y) = place(&grid.second, shares[1]);
        for (k, matrix) in grid.matrices.iter().enumerate() {
            for (row, first) in matrix.iter().zip(&grid.first) {
                let along = Cubics::new(&grid.second, [row]).unwrap();
                near("along a row", surface(&surfaces, *first, y)[k], cubic(&along, 1, y), tolerance);
            }
            for (number, second) in grid.second.iter().enumerate() {
                let column: Vec<f64> = matrix.iter().map(|row| row[number]).collect();
                let across = Cubics::new(&grid.first, [&column]).unwrap();
                near("along a column", surface(&surfaces, x, *second)[k], cubic(&across, 1, x), tolerance);
            }
        }
    }

    #[test]
    fn surfaces_stay_between_the_corners_of_each_cell(grid in grid(), shares in [0.0..1.0, 0.0..1.0]) {
        let surfaces = grid.surfaces();
        let (row, x) = place(&grid.first, shares[0]);
        let (column, y) = place(&grid.second, shares[1]);
        let tolerance = ROUNDING * grid.greatest();
        let values = surface(&surfaces, x, y);
        for (k, matrix) in grid.matrices.iter().enumerate() {
            let corners = matrix[row..].iter().take(2).flat_map(|row| row[column..].iter().take(2));
            let (low, high) = corners.fold((f64::MAX, f64::MIN), |(low, high), corner| (low.min(*corner), high.max(*corner)));
            prop_assert!(low - tolerance <= values[k] && values[k] <= high + tolerance, "{} not in {low} to {high}", values[k]);
        }
    }

    #[test]
    fn surfaces_have_continuous_slopes(grid in gentle_grid(), shares in [0.0..1.0, 0.0..1.0]) {
        let surfaces = grid.surfaces();
        let slopes = |x: f64, y: f64| {
            let [along_x, along_y] = [[1.0, 0.0], [0.0, 1.0]]
                .map(|[dx, dy]| surface(&surfaces, Dual64::new(x, dx), Dual64::new(y, dy)));
            [along_x[0].eps, along_x[1].eps, along_y[0].eps, along_y[1].eps]
        };
        let (_, x) = place(&grid.first, shares[0]);
        let (_, y) = place(&grid.second, shares[1]);
        let on_rows = grid.first.iter().map(|knot| [knot - 1e-9, knot + 1e-9].map(|x| slopes(x, y)));
        let on_columns = grid.second.iter().map(|knot| [knot - 1e-9, knot + 1e-9].map(|y| slopes(x, y)));
        for [below, above] in on_rows.chain(on_columns) {
            for (below, above) in below.into_iter().zip(above) {
                // Second derivatives are less than 100, but where a secant between rows turns round.
                near("slope", below, above, 1e-5);
            }
        }
    }

    #[test]
    fn lanes_and_dual_numbers_of_surfaces_have_the_digits_of_f64(
        grid in grid(), first in prop::array::uniform4(-50.0..150.0), second in prop::array::uniform4(-50.0..150.0),
    ) {
        let surfaces = grid.surfaces();
        let hints = <[Hint; 2]>::default();
        for segments in [[0, 0], [0, 1], [1, 0], [1, 1], [1, 2], [2, 1], [2, 2]] {
            let lanes = surfaces.at(segments, [Lanes(first), Lanes(second)], &hints);
            for lane in 0..4 {
                let alone = surfaces.at(segments, [first[lane], second[lane]], &<[Hint; 2]>::default());
                let dual = surfaces.at(segments, [Dual64::new(first[lane], 1.0), Dual64::new(second[lane], 1.0)], &hints);
                prop_assert_eq!(lanes.map(|value| value.0[lane].to_bits()), alone.map(f64::to_bits));
                prop_assert_eq!(dual.map(|value| value.re.to_bits()), alone.map(f64::to_bits));
                prop_assert!(alone.iter().chain(&dual.map(|value| value.eps)).all(|number| number.is_finite()));
            }
        }
    }

    #[test]
    fn what_is_linear_in_each_argument_comes_back(first in abscissae(1..6), second in abscissae(1..6), shares in [0.0..1.0, 0.0..1.0]) {
        let grid = Grid::of(first, second, [|x, y| 1.0 + 2.0 * x - 3.0 * y + 0.5 * x * y, |x, y| x - y]);
        let (_, x) = place(&grid.first, shares[0]);
        let (_, y) = place(&grid.second, shares[1]);
        let [twisted, plane] = surface(&grid.surfaces(), x, y);
        // The slope in a long cell is also that of its neighbour, a hundred thousandth as long, whose rounding it carries along.
        let tolerance = 1e-10 * (1.0 + grid.greatest());
        near("twisted", twisted, 1.0 + 2.0 * x - 3.0 * y + 0.5 * x * y, tolerance);
        near("plane", plane, x - y, tolerance);
    }

    #[test]
    fn slopes_of_surfaces_are_central_differences(shares in [0.01..0.99, 0.01..0.99]) {
        let grid = Grid::of(
            vec![0.0, 0.1, 0.25, 0.4, 0.7],
            vec![0.5, 0.9, 1.1, 2.0, 5.0, 10.0],
            [|x, y| (3.0 * x).sin() * (1.0 + 1.0 / y), |x, y| 0.1 + x * x * (1.0 + (y / 3.0).cos())],
        );
        let surfaces = grid.surfaces();
        let (_, x) = place(&grid.first, shares[0]);
        let (_, y) = place(&grid.second, shares[1]);
        let step = 1e-5;
        for [dx, dy] in [[1.0, 0.0], [0.0, 1.0]] {
            let dual = surface(&surfaces, Dual64::new(x, dx), Dual64::new(y, dy));
            let [above, below] = [step, -step].map(|step| surface(&surfaces, x + step * dx, y + step * dy));
            for k in 0..2 {
                // The second derivative, less than 100, jumps at knots.
                near("slope", dual[k].eps, (above[k] - below[k]) / (2.0 * step), 100.0 * step);
            }
        }
    }
}

#[test]
fn coefficients_beyond_a_table_are_those_of_its_edge() {
    let at = vec![0.0, 0.2, 0.5];
    let mach = vec![1.0, 3.0, 8.0];
    let grid = Grid::of(at, mach, [|x, y| x * y, |x, y| 1.0 + x * x / y]);
    let [lift, drag] = &grid.matrices;
    let table = AlphaMachTable::new(&grid.first, &grid.second, lift, drag).unwrap();
    assert_eq!((table.angle_of_attack_range(), table.mach_range()), (&[0.0, 0.5], &[1.0, 8.0]));
    let hints = <[Hint; 2]>::default();
    for (segments, [alpha, mach], [row, column]) in [
        ([0, 0], [-1.0, 0.1], [0, 0]),
        ([2, 0], [0.6, 0.1], [2, 0]),
        ([0, 2], [-0.1, 30.0], [0, 2]),
        ([2, 2], [1.0, 30.0], [2, 2]),
        ([1, 2], [0.2, 30.0], [1, 2]),
        ([2, 1], [1.0, 3.0], [2, 1]),
    ] {
        let found = table.coefficients(segments, Dual64::new(alpha, 1.0), Dual64::new(mach, 0.0), &hints);
        near("lift", found.lift.re, lift[row][column], 1e-14);
        near("drag", found.drag.re, drag[row][column], 1e-14);
        if segments[0] != 1 {
            assert_eq!((found.lift.eps, found.drag.eps), (0.0, 0.0));
        }
    }
    let of_mach = MachTable::new(&grid.second, &lift[2], &drag[2]).unwrap();
    for mach in [0.1, 1.0, 2.0, 5.0, 8.0, 20.0] {
        let segment = usize::from(mach >= 1.0) + usize::from(mach >= 8.0);
        let one = of_mach.coefficients(segment, mach, &hints[0]);
        let two = table.coefficients([2, segment], 0.5, mach, &hints);
        near("lift", two.lift, one.lift, 1e-14);
        near("drag", two.drag, one.drag, 1e-14);
    }
}

#[test]
fn a_vehicle_has_lift_where_its_model_has_some() {
    let with = |aerodynamics| Vehicle { mass: 1.0, reference_area: 1.0, aerodynamics, nose_radius: None }.has_lift();
    let table =
        |lift: [f64; 2]| Aerodynamics::MachTable(Arc::new(MachTable::new(&[1.0, 2.0], &lift, &[1.0; 2]).unwrap()));
    assert!(with(table([0.0, 0.1])) && !with(table([0.0, 0.0])));
    let alpha = |lift: f64| {
        let [lift, drag] = [vec![vec![lift]], vec![vec![1.0]]];
        Aerodynamics::AlphaMachTable(Arc::new(AlphaMachTable::new(&[0.0], &[1.0], &lift, &drag).unwrap()))
    };
    assert!(with(alpha(0.1)) && !with(alpha(0.0)));
    let ballistic = |lift_to_drag| Aerodynamics::Ballistic { ballistic_coefficient: 1.0, lift_to_drag };
    assert!(with(ballistic(-0.1)) && !with(ballistic(0.0)));
}

#[test]
fn the_wind_of_a_table() {
    let table = WindTable::new(&[0.0, 10e3, 20e3], &[0.0, 30.0, 10.0], &[5.0, 5.0, 5.0]).unwrap();
    let hint = Hint::default();
    let [low, high] = *table.range();
    assert_eq!((low, high), (0.0, 20e3));
    for (segment, altitude, east) in [(0, -1e3, 0.0), (1, 0.0, 0.0), (1, 10e3, 30.0), (2, 20e3, 10.0), (2, 1e6, 10.0)] {
        let [found, north] = table.velocity(segment, altitude, &hint);
        near("east", found, east, 1e-12);
        near("north", north, 5.0, 1e-12);
    }
}

/// A model, and how many segments it has.
fn models() -> Vec<(Atmosphere, usize)> {
    let altitude = [-1e3, 0.0, 12e3, 50e3, 90e3];
    let density = [1.3, 1.2, 0.3, 1e-3, 3e-6];
    // So cold at the end that its cubic goes on below absolute zero.
    let temperature: &[f64] = &[290.0, 288.15, 217.0, 270.0, 20.0];
    let pressure: &[f64] = &[1.1e5, 1e5, 1.9e4, 80.0, 0.2];
    let table = |density: &[f64]| Arc::new(Table::new(&altitude, density, Some(temperature), Some(pressure)).unwrap());
    let plain = || Table::new(&altitude, &density, Some(temperature), Some(pressure)).unwrap();
    let [molar_mass, heat_capacity_ratio]: [&[f64]; 2] =
        [&[0.029, 0.03, 0.044, 0.02, 0.002], &[1.4, 1.3, 1.28, 1.4, 1.66]];
    let gas = plain().with_gas(&altitude, Gas::ByAltitude { molar_mass, heat_capacity_ratio }).unwrap();
    let sound = plain().with_speed_of_sound(&altitude, &[340.0, 341.0, 295.0, 330.0, 20.0]).unwrap();
    let layers = vec![
        Layer { base_altitude: 0.0, density: 1.2, scale_height: 8e3 },
        Layer { base_altitude: 30e3, density: 0.02, scale_height: 6e3 },
        Layer { base_altitude: 90e3, density: 0.0, scale_height: 1e-300 },
    ];
    vec![
        (Atmosphere::Vacuum, 1),
        (Atmosphere::EARTH_JAMESON, 1),
        (Atmosphere::Us76, 18),
        (Atmosphere::Layers(Arc::new(Layers::new(layers).unwrap())), 3),
        (Atmosphere::Layers(Arc::new(Layers::earth_seven_layer())), 7),
        (Atmosphere::Table(table(&density)), 3),
        (Atmosphere::Table(Arc::new(gas)), 3),
        (Atmosphere::Table(Arc::new(sound)), 3),
        // Thicker and thicker air; cliffs.
        (Atmosphere::Table(table(&[1e-300, 1e-200, 1.0, 1e200, 1e300])), 3),
        (Atmosphere::Table(table(&[1e300, 1e300, 1.0, 1.0, 1e-300])), 3),
    ]
}

fn segment_of(boundaries: &[f64], altitude: f64) -> usize {
    boundaries.iter().filter(|boundary| altitude >= **boundary).count()
}

#[test]
fn every_formula_is_finite_at_every_altitude() {
    let hint = Hint::default();
    for (model, segments) in models() {
        assert_eq!(model.boundaries().len() + 1, segments);
        for magnitude in [0.0, 1.0, 1e3, 1e4, 5e4, 9e4, 2e5, 1e6, 6.4e6, 1e7, 1e8, 1e9, 1e12, 1e100, f64::MAX] {
            for altitude in [magnitude, -magnitude] {
                for segment in 0..segments {
                    let altitude = Dual64::new(altitude, 1.0);
                    let air = model.sample(segment, altitude, &hint);
                    let positive = |number: Dual64| number.re > 0.0 && number.re.is_finite() && number.eps.is_finite();
                    let what = || format!("{model:?} at {altitude} by {segment}: {air:?}");
                    assert!(
                        air.density.re >= 0.0 && air.density.re.is_finite() && air.density.eps.is_finite(),
                        "{}",
                        what()
                    );
                    assert!(air.speed_of_sound.is_none_or(positive), "{}", what());
                    // A formula is used far off its segment by trial stages alone, which take no temperature nor pressure.
                    let finite = |number: Dual64| number.re.is_finite() && number.eps.is_finite();
                    assert!(air.temperature.is_none_or(finite) && air.pressure.is_none_or(finite), "{}", what());
                    assert_eq!(air.temperature.is_some(), model.has_temperature());
                    assert_eq!(air.speed_of_sound.is_some(), model.has_speed_of_sound());
                    assert_eq!(air.pressure.is_some(), model.has_pressure());
                    let (density, sound) = model.density_and_sound(segment, altitude, &hint);
                    let bits = |number: Dual64| [number.re, number.eps].map(f64::to_bits);
                    assert_eq!(bits(density), bits(air.density));
                    assert_eq!(bits(model.density(segment, altitude, &hint)), bits(air.density));
                    assert_eq!(bits(sound), bits(air.speed_of_sound.unwrap_or(Dual64::from(1.0))));
                }
            }
        }
    }
}

proptest! {
    #![proptest_config(config(500))]

    #[test]
    fn every_model_has_the_digits_of_f64_in_lanes_and_its_slope_in_dual_numbers(altitudes in prop::array::uniform8(-2e3..150e3)) {
        for (model, segments) in models().into_iter().take(8) {
            for segment in 0..segments {
                let hint = Hint::default();
                let (density, sound) = model.density_and_sound(segment, Lanes(altitudes), &hint);
                for (lane, altitude) in altitudes.into_iter().enumerate() {
                    let alone = model.density_and_sound(segment, altitude, &hint);
                    prop_assert_eq!([density, sound].map(|number| number.0[lane].to_bits()), [alone.0, alone.1].map(f64::to_bits));
                    let only: f64 = model.density(segment, altitude, &hint);
                    prop_assert_eq!(only.to_bits(), alone.0.to_bits());
                }
            }
            let altitude = altitudes[0];
            prop_assume!(model.boundaries().iter().all(|boundary| f64::abs(altitude - boundary) > 2.0));
            let segment = segment_of(model.boundaries(), altitude);
            let hint = Hint::default();
            let (density, sound) = model.density_and_sound(segment, Dual64::new(altitude, 1.0), &hint);
            let [above, below] = [1.0, -1.0].map(|step| model.density_and_sound(segment, altitude + step, &hint));
            // Rounding, the square of a step over a kilometre, and the jump of the second derivative at an entry.
            near("density", density.eps, (above.0 - below.0) / 2.0, 1e-13 * density.re + 1e-3 * density.eps.abs());
            near("sound", sound.eps, (above.1 - below.1) / 2.0, 1e-13 * sound.re + 1e-4);
        }
    }
}

/// A trial stage that looks over an end sees the formula of its own segment, which joins that of the next.
#[test]
fn formulas_join_at_their_boundaries() {
    let hint = Hint::default();
    for (model, tolerance) in [
        (Atmosphere::Us76, 1e-8),
        (Atmosphere::Layers(Arc::new(Layers::earth_seven_layer())), 1e-13),
        (models()[5].0.clone(), 1e-13),
    ] {
        for (below, boundary) in model.boundaries().iter().enumerate() {
            // Hydrogen begins at 150 km, but is in the formula for all segments above 86 km.
            let [left, right] = [below, below + 1].map(|segment| model.density(segment, *boundary, &hint));
            relative(&format!("at {boundary} m"), left, right, tolerance);
        }
    }
}

/// The exponential atmosphere is what it was when it was the only one.
#[test]
fn the_exponential_atmosphere_to_the_last_digit() {
    for kilometres in -100..1000 {
        let altitude = 1e3 * f64::from(kilometres) + 0.123;
        let found: f64 = Atmosphere::EARTH_JAMESON.density(0, altitude, &Hint::default());
        assert_eq!(found.to_bits(), (exp(-(altitude * 6935.0_f64.recip())) * 1.547_93).to_bits());
    }
}

#[test]
fn a_table_of_an_exponential_atmosphere_is_that_atmosphere() {
    let (surface_density, scale_height) = (1.2, 7e3);
    let altitude = [0.0, 1e3, 5e3, 30e3, 31e3, 80e3];
    let density = altitude.map(|h| surface_density * f64::exp(-h / scale_height));
    let pressure = density.map(|density| 9.8 * scale_height * density);
    let temperature = altitude.map(|h| 300.0 - 1e-3 * h);
    let table =
        Atmosphere::Table(Arc::new(Table::new(&altitude, &density, Some(&temperature), Some(&pressure)).unwrap()));
    let hint = Hint::default();
    for step in -50..300 {
        let h = 500.0 * f64::from(step);
        let expected = surface_density * f64::exp(-h / scale_height);
        let air = table.sample(segment_of(table.boundaries(), h), h, &hint);
        relative(&format!("density at {h}"), air.density, expected, 1e-13);
        relative(&format!("pressure at {h}"), air.pressure.unwrap(), 9.8 * scale_height * expected, 1e-13);
        // Beyond its ends the temperature stays.
        let temperature = 300.0 - 1e-3 * h.clamp(0.0, 80e3);
        relative(&format!("temperature at {h}"), air.temperature.unwrap(), temperature, 1e-13);
        let sound = (1.4 * 8314.32 / 28.9644 * temperature).sqrt();
        relative(&format!("speed of sound at {h}"), air.speed_of_sound.unwrap(), sound, 1e-13);
    }
    relative("scale height", table.scale_height(), scale_height, 1e-12);
    relative("sensible", table.sensible_altitude(), 37.0 * scale_height, 1e-12);
}

/// The standard's speed of sound at sea level, 340.294 m/s (its Table I).
#[test]
fn a_table_has_the_standard_speed_of_sound() {
    let table = Table::new(&[0.0, 1e3], &[1.2, 1.1], Some(&[288.15, 288.15]), None).unwrap();
    near("speed of sound", table.sample(1, 500.0, &Hint::default()).speed_of_sound.unwrap(), 340.294, 5e-4);
}

#[test]
fn a_fine_table_of_the_standard_is_near_it() {
    let altitude: Vec<f64> = (0..=60).map(|i| 2e3 * f64::from(i)).collect();
    let density: Vec<f64> = altitude.iter().map(|h| us76::density(*h)).collect();
    let table = Table::new(&altitude, &density, None, None).unwrap();
    let hint = Hint::default();
    for step in 0..1200 {
        let h = 100.0 * f64::from(step);
        // The scale height jumps at the standard's boundaries, most at 11 km, between two entries.
        relative(&format!("at {h}"), table.density(1, h, &hint), us76::density(h), 1.5e-2);
    }
}

/// How thin and how steep the air gets, of tables that do not behave.
#[test]
fn scale_heights_and_sensible_altitudes_of_odd_tables() {
    let model = |altitude: &[f64], density: &[f64]| Table::new(altitude, density, None, None).unwrap();
    let flat = model(&[0.0, 50e3], &[1.0, 1.0]);
    assert_eq!((flat.scale_height(), flat.sensible_altitude()), (50e3, f64::MAX));
    let rising = model(&[0.0, 50e3], &[1.0, 2.0]);
    assert_eq!((rising.scale_height(), rising.sensible_altitude()), (50e3, f64::MAX));
    // A cliff of a metre into air of which nobody takes notice.
    let cliff = model(&[0.0, 30e3, 30_001.0, 100e3], &[1.0, 0.5, 1e-30, 1e-31]);
    assert_eq!((cliff.scale_height(), cliff.sensible_altitude()), (100.0, 30_001.0));
    let high = model(&[100e3, 200e3], &[1.0, 0.5]);
    near("scale height", high.scale_height(), 100e3, 0.0);
    // e⁻³⁷ of that at altitude 0, which is twice that of 100 km.
    relative("sensible altitude", high.sensible_altitude(), 37.0 * 100e3 / LN_2, 1e-13);
}

#[test]
fn layers_are_exponentials_from_their_bases() {
    let layers = vec![
        Layer { base_altitude: 0.0, density: 1.0, scale_height: 8e3 },
        Layer { base_altitude: 40e3, density: 0.01, scale_height: 5e3 },
        Layer { base_altitude: 60e3, density: 0.0, scale_height: 5e3 },
    ];
    let layers = Layers::new(layers).unwrap();
    assert_eq!(layers.boundaries(), [40e3, 60e3]);
    relative("below the first base", layers.density(0, -8e3), 1.0_f64.exp(), 1e-15);
    relative("in the first", layers.density(0, 16e3), (-2.0_f64).exp(), 1e-15);
    assert_eq!((layers.density(1, 40e3), layers.density(2, 60e3)), (0.01, 0.0));
    relative("in the second, over its end", layers.density(1, 65e3), 0.01 * (-5.0_f64).exp(), 1e-15);
    assert_eq!((layers.scale_height(), layers.sensible_altitude()), (5e3, 60e3));
    let none = Layers::new(vec![Layer { base_altitude: 0.0, density: 0.0, scale_height: 5e3 }]).unwrap();
    near("no air", none.sensible_altitude(), 0.0, 0.0);
    let above = Layers::new(vec![Layer { base_altitude: 10e3, density: 1.0, scale_height: 5e3 }]).unwrap();
    relative("from the surface", above.sensible_altitude(), 37.0 * 5e3, 1e-15);
}

/// The numbers in the description of the preset.
#[test]
fn seven_layers_are_as_near_the_standard_as_documented() {
    let earth = Layers::earth_seven_layer();
    let bases: Vec<f64> = earth.layers().iter().map(|layer| layer.base_altitude).collect();
    assert_eq!(bases, [0.0, 10e3, 43e3, 68e3, 82e3, 112e3, 120e3]);
    for layer in earth.layers() {
        near("density at a base", layer.density, us76::density(layer.base_altitude), 0.0);
    }
    let error = |h: f64| earth.density(segment_of(earth.boundaries(), h), h) / us76::density(h) - 1.0;
    near("at 130 km", error(130e3), 0.0, 1e-13);
    let worst = |steps: std::ops::Range<u32>| steps.map(|step| error(10.0 * f64::from(step)).abs()).fold(0.0, f64::max);
    near("from 0 to 10 km", worst(0..1000), 0.034, 5e-4);
    near("from 10 to 130 km", worst(1000..13_000), 0.05, 5e-4);
    near("at 136 km", error(136e3), -0.12, 5e-3);
    near("at 150 km", error(150e3), -0.47, 5e-3);
    near("at 200 km", error(200e3), -0.97, 5e-3);
}

/// The scale height that limits the steps is the least, and above the sensible altitude the air is thinner than 3e-15 of that below.
#[test]
fn the_standard_is_nowhere_steeper_than_its_least_scale_height() {
    let steepest = (0..100_000).map(|step| {
        let density = us76::density(Dual64::new(10.0 * f64::from(step), 1.0));
        -density.re / density.eps
    });
    relative("scale height", steepest.fold(f64::MAX, f64::min), Atmosphere::Us76.scale_height(), 1e-4);
    assert!(us76::density(Atmosphere::Us76.sensible_altitude()) < 3e-15 * us76::density(0.0));
}
