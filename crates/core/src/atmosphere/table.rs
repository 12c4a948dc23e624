//! An atmosphere by a table.

use super::{AtmosphereSample, SENSIBLE_SCALE_HEIGHTS, us76};
use crate::interpolation::{Cubics, Hint, TableError};
use crate::scalar::Scalar;

/// Density by altitude and, where they are given, temperature and pressure.
///
/// Between the altitudes the logarithms of density and pressure are interpolated, and the temperature itself. Outside, the logarithms go on
/// in straight lines, and the temperature stays as it is.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    log_density: Cubics<1>,
    temperature: Option<Cubics<1>>,
    log_pressure: Option<Cubics<1>>,
    sensible_altitude: f64,
    scale_height: f64,
    /// Half the least temperature, under which no trial stage gets that looks over an end of the table, K.
    coldest: f64,
}

impl Table {
    /// The table of altitudes, m, ascending, densities, kg/m³, temperatures, K, and pressures, Pa, all of them greater than 0.
    ///
    /// # Errors
    /// When these are not a table of at least two altitudes.
    pub fn new(
        altitude: &[f64],
        density: &[f64],
        temperature: Option<&[f64]>,
        pressure: Option<&[f64]>,
    ) -> Result<Self, TableError> {
        if altitude.len() < 2 {
            return Err(TableError::TooShort { entries: altitude.len(), least: 2 });
        }
        let column = |numbers: &[f64], function: fn(f64) -> f64| {
            if let Some(index) = numbers.iter().position(|number| !number.is_finite() || *number <= 0.0) {
                return Err(TableError::OutOfBounds { index });
            }
            let numbers: Vec<f64> = numbers.iter().copied().map(function).collect();
            Cubics::new(altitude, [&numbers])
        };
        let log_density = column(density, f64::ln)?;
        let coldest = 0.5 * temperature.unwrap_or_default().iter().copied().fold(f64::MAX, f64::min);
        let temperature = temperature.map(|numbers| column(numbers, |number| number)).transpose()?;
        let log_pressure = pressure.map(|numbers| column(numbers, f64::ln)).transpose()?;
        let logarithms: Vec<f64> = density.iter().copied().map(f64::ln).collect();
        let sensible_altitude = sensible_altitude(altitude, &logarithms, &log_density);
        let scale_height = least_scale_height(altitude, &logarithms);
        Ok(Self { log_density, temperature, log_pressure, sensible_altitude, scale_height, coldest })
    }

    /// Its lowest and highest altitude, m.
    pub fn range(&self) -> &[f64; 2] {
        self.log_density.range()
    }

    /// Whether it knows the temperature.
    pub fn has_temperature(&self) -> bool {
        self.temperature.is_some()
    }

    /// Whether it knows the pressure.
    pub fn has_pressure(&self) -> bool {
        self.log_pressure.is_some()
    }

    /// Density, kg/m³, at an altitude, m, by the formula of a stretch: 0 below the table, 1 inside, 2 above.
    #[inline(always)]
    pub fn density<S: Scalar>(&self, stretch: usize, altitude: S, hint: &Hint) -> S {
        exponential(&self.log_density, stretch, altitude, hint)
    }

    /// The temperature, K, at an altitude, m, if it is known.
    #[inline(always)]
    pub fn temperature<S: Scalar>(&self, stretch: usize, altitude: S, hint: &Hint) -> Option<S> {
        self.temperature.as_ref().map(|temperature| {
            let [temperature] = temperature.at(stretch, altitude, hint);
            S::select(temperature.less_than(self.coldest), S::from(self.coldest), temperature)
        })
    }

    /// The air at an altitude, m, by the formulas of a stretch.
    ///
    /// The speed of sound is √(γ R* T/M₀), with the numbers of [`us76`].
    #[inline(always)]
    pub fn sample<S: Scalar>(&self, stretch: usize, altitude: S, hint: &Hint) -> AtmosphereSample<S> {
        let temperature = self.temperature(stretch, altitude, hint);
        AtmosphereSample {
            density: self.density(stretch, altitude, hint),
            temperature,
            pressure: self.log_pressure.as_ref().map(|pressure| exponential(pressure, stretch, altitude, hint)),
            speed_of_sound: temperature.map(us76::speed_of_sound),
        }
    }

    /// The altitude, m, above which no air is sensible; the greatest number where the density does not fall above the table.
    pub fn sensible_altitude(&self) -> f64 {
        self.sensible_altitude
    }

    /// The least height, m, over which the density falls by e, measured from entry to entry; at least a thousandth of the table's, at most all of it.
    pub fn scale_height(&self) -> f64 {
        self.scale_height
    }
}

/// e to the power of an interpolated logarithm; from e^±700 on it stays, so that it is a finite positive number everywhere.
#[inline(always)]
fn exponential<S: Scalar>(logarithm: &Cubics<1>, stretch: usize, altitude: S, hint: &Hint) -> S {
    // Air that grows denser at the top of its table goes on as dense as there.
    let [_, [slope_at_top]] = logarithm.end_slopes();
    let [logarithm] = if stretch > 1 && slope_at_top > 0.0 {
        logarithm.at(stretch, altitude, hint)
    } else {
        logarithm.extrapolated(stretch, altitude, hint)
    };
    let logarithm = S::select(logarithm.less_than(-700.0), S::from(-700.0), logarithm);
    S::select(logarithm.less_than(700.0), logarithm, S::from(700.0)).exp()
}

/// The altitude, m, above which the density is less than a share of the greatest from altitude 0 on.
fn sensible_altitude(altitude: &[f64], log_density: &[f64], interpolated: &Cubics<1>) -> f64 {
    let [first, last] = *interpolated.range();
    let stretch = usize::from(first <= 0.0) + usize::from(last <= 0.0);
    let [at_0] = interpolated.extrapolated(stretch, 0.0, &Hint::default());
    let above_0 = altitude.iter().zip(log_density).filter(|(altitude, _)| **altitude > 0.0);
    let threshold =
        above_0.fold(at_0, |greatest: f64, (_, logarithm)| greatest.max(*logarithm)) - SENSIBLE_SCALE_HEIGHTS;
    let [_, [slope]] = interpolated.end_slopes();
    let top = log_density[log_density.len() - 1];
    if slope >= 0.0 {
        f64::MAX
    } else if top > threshold {
        (last + (threshold - top) / slope).min(f64::MAX)
    } else {
        let thick = log_density.iter().rposition(|logarithm| *logarithm > threshold);
        altitude[thick.map_or(0, |thick| thick + 1)]
    }
}

/// The least height, m, over which the density falls by e, from entry to entry.
///
/// Steps of the integration have to do with it, which a cliff between two entries must not make tiny: it is at least a
/// thousandth of the height of the table. It is at most that height, even where the density falls nowhere.
fn least_scale_height(altitude: &[f64], log_density: &[f64]) -> f64 {
    let height = altitude[altitude.len() - 1] - altitude[0];
    let cells = altitude.windows(2).zip(log_density.windows(2));
    let falling = cells.filter(|(_, logarithm)| logarithm[0] > logarithm[1]);
    let scale_heights =
        falling.map(|(altitude, logarithm)| (altitude[1] - altitude[0]) / (logarithm[0] - logarithm[1]));
    scale_heights.fold(height, f64::min).max(1e-3 * height)
}
