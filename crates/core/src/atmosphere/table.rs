//! An atmosphere by a table.

use super::{AtmosphereSample, SENSIBLE_SCALE_HEIGHTS, us76};
use crate::elementary::ln;
use crate::interpolation::{Cubics, Hint, TableError, check};
use crate::scalar::Scalar;

/// R, the molar gas constant, J/(mol K). CODATA 2018.
pub const MOLAR_GAS_CONSTANT: f64 = 8.314_462_618;

/// Density by altitude and, where they are given, temperature, pressure and speed of sound.
///
/// Between the altitudes the logarithms of density and pressure are interpolated by the cubics of [`interpolation`](crate::interpolation);
/// temperature, speed of sound and γR/M of the gas are interpolated themselves. Outside, the logarithms go on in straight lines, and the
/// others stay as they are at the end.
#[derive(Clone, Debug, PartialEq)]
pub struct Table {
    log_density: Cubics<1>,
    temperature: Option<Column>,
    log_pressure: Option<Cubics<1>>,
    sound: Sound,
    sensible_altitude: f64,
    scale_height: f64,
}

/// The gas of a [`Table`], by its entries: from it and the temperature follows the speed of sound √(γRT/M).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Gas<'a> {
    /// The Earth's air, with the numbers of [`us76`].
    Air,
    /// The same gas at all altitudes.
    Uniform {
        /// M, kg/mol.
        molar_mass: f64,
        /// γ.
        heat_capacity_ratio: f64,
    },
    /// A gas for every altitude.
    ByAltitude {
        /// M, kg/mol.
        molar_mass: &'a [f64],
        /// γ.
        heat_capacity_ratio: &'a [f64],
    },
}

/// From what the speed of sound of a table follows.
#[derive(Clone, Debug, PartialEq)]
enum Sound {
    /// There is none.
    Unknown,
    /// It is tabulated, m/s.
    Tabulated(Column),
    /// c² = T times this number, m²/(s² K).
    OfTemperature(f64),
    /// c² = T times γR/M, m²/(s² K), which depends on the altitude.
    OfTemperatureAndGas(Column),
}

/// A quantity that is greater than 0.
#[derive(Clone, Debug, PartialEq)]
struct Column {
    cubics: Cubics<1>,
    /// Half the least entry, under which no trial stage gets that looks over an end of the table.
    least: f64,
}

impl Column {
    fn new(altitude: &[f64], numbers: &[f64]) -> Result<Self, TableError> {
        let least = 0.5 * numbers.iter().copied().fold(f64::MAX, f64::min);
        Ok(Self { cubics: column(altitude, numbers, |number| number)?, least })
    }

    #[inline(always)]
    fn at<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> S {
        let [value] = self.cubics.at(segment, altitude, hint);
        S::select(value.less_than(self.least), S::from(self.least), value)
    }
}

/// Functions of numbers that are greater than 0.
fn column(altitude: &[f64], numbers: &[f64], function: fn(f64) -> f64) -> Result<Cubics<1>, TableError> {
    if let Some(index) = numbers.iter().position(|number| !number.is_finite() || *number <= 0.0) {
        return Err(TableError::OutOfBounds { index });
    }
    let numbers: Vec<f64> = numbers.iter().copied().map(function).collect();
    Cubics::new(altitude, [&numbers])
}

impl Table {
    /// The table of altitudes, m, ascending, densities, kg/m³, temperatures, K, and pressures, Pa, all of them greater than 0.
    /// With temperatures, its gas is [`Gas::Air`].
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
        let log_density = column(altitude, density, ln)?;
        let temperature = temperature.map(|numbers| Column::new(altitude, numbers)).transpose()?;
        let log_pressure = pressure.map(|numbers| column(altitude, numbers, ln)).transpose()?;
        let sound = if temperature.is_some() { Sound::OfTemperature(us76::SOUND_OF_KELVIN) } else { Sound::Unknown };
        let logarithms: Vec<f64> = density.iter().copied().map(ln).collect();
        let sensible_altitude = sensible_altitude(altitude, &logarithms, &log_density);
        let scale_height = least_scale_height(altitude, &logarithms);
        Ok(Self { log_density, temperature, log_pressure, sound, sensible_altitude, scale_height })
    }

    /// The same table with speeds of sound, m/s, all greater than 0, at the altitudes with which it was made.
    ///
    /// # Errors
    /// When these are not as many as the altitudes, or not greater than 0.
    pub fn with_speed_of_sound(self, altitude: &[f64], speed_of_sound: &[f64]) -> Result<Self, TableError> {
        Ok(Self { sound: Sound::Tabulated(Column::new(altitude, speed_of_sound)?), ..self })
    }

    /// The same table of another gas, at the altitudes with which it was made. Without a temperature it makes no difference.
    ///
    /// # Errors
    /// When lists are not as long as the altitudes, or a molar mass or a ratio is not greater than 0.
    pub fn with_gas(self, altitude: &[f64], gas: Gas) -> Result<Self, TableError> {
        let of = |molar_mass: f64, heat_capacity_ratio: f64| heat_capacity_ratio * MOLAR_GAS_CONSTANT / molar_mass;
        let sound = match gas {
            _ if self.temperature.is_none() => self.sound,
            Gas::Air => Sound::OfTemperature(us76::SOUND_OF_KELVIN),
            Gas::Uniform { molar_mass, heat_capacity_ratio } => {
                let quotient = of(molar_mass, heat_capacity_ratio);
                let sound = quotient.is_finite() && quotient > 0.0;
                if !sound {
                    return Err(TableError::OutOfBounds { index: 0 });
                }
                Sound::OfTemperature(quotient)
            }
            Gas::ByAltitude { molar_mass, heat_capacity_ratio } => {
                check(altitude, &[molar_mass, heat_capacity_ratio])?;
                let quotients: Vec<_> =
                    molar_mass.iter().zip(heat_capacity_ratio).map(|(mass, ratio)| of(*mass, *ratio)).collect();
                Sound::OfTemperatureAndGas(Column::new(altitude, &quotients)?)
            }
        };
        Ok(Self { sound, ..self })
    }

    /// Its lowest and highest altitude, m.
    pub fn range(&self) -> &[f64; 2] {
        self.log_density.range()
    }

    /// The altitudes between them, m.
    pub fn inner(&self) -> &[f64] {
        self.log_density.inner()
    }

    /// Whether it knows the temperature.
    pub fn has_temperature(&self) -> bool {
        self.temperature.is_some()
    }

    /// Whether it knows the speed of sound.
    pub fn has_speed_of_sound(&self) -> bool {
        self.sound != Sound::Unknown
    }

    /// Whether it knows the pressure.
    pub fn has_pressure(&self) -> bool {
        self.log_pressure.is_some()
    }

    /// Density, kg/m³, at an altitude, m, by the formula of a segment: 0 below the table, 1 inside, 2 above.
    #[inline(always)]
    pub fn density<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> S {
        exponential(&self.log_density, segment, altitude, hint)
    }

    /// The temperature, K, at an altitude, m, if it is known.
    #[inline(always)]
    pub fn temperature<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> Option<S> {
        self.temperature.as_ref().map(|temperature| temperature.at(segment, altitude, hint))
    }

    /// The speed of sound, m/s, at an altitude, m, if it is known: as tabulated, or √(γRT/M).
    #[inline(always)]
    pub fn speed_of_sound<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> Option<S> {
        let temperature = || self.temperature(segment, altitude, hint);
        match &self.sound {
            Sound::Unknown => None,
            Sound::Tabulated(speed) => Some(speed.at(segment, altitude, hint)),
            Sound::OfTemperature(square) => temperature().map(|kelvin| (kelvin * *square).sqrt()),
            Sound::OfTemperatureAndGas(square) => {
                temperature().map(|kelvin| (kelvin * square.at(segment, altitude, hint)).sqrt())
            }
        }
    }

    /// Pa, at an altitude, m, by the formulas of a segment, if the table has it.
    #[inline(always)]
    pub fn pressure<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> Option<S> {
        self.log_pressure.as_ref().map(|pressure| exponential(pressure, segment, altitude, hint))
    }

    /// The air at an altitude, m, by the formulas of a segment.
    #[inline(always)]
    pub fn sample<S: Scalar>(&self, segment: usize, altitude: S, hint: &Hint) -> AtmosphereSample<S> {
        AtmosphereSample {
            density: self.density(segment, altitude, hint),
            temperature: self.temperature(segment, altitude, hint),
            pressure: self.pressure(segment, altitude, hint),
            speed_of_sound: self.speed_of_sound(segment, altitude, hint),
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
fn exponential<S: Scalar>(logarithm: &Cubics<1>, segment: usize, altitude: S, hint: &Hint) -> S {
    // Air that grows denser at the top of its table goes on as dense as there.
    let [_, [slope_at_top]] = logarithm.end_slopes();
    let [logarithm] = if segment > 1 && slope_at_top > 0.0 {
        logarithm.at(segment, altitude, hint)
    } else {
        logarithm.extrapolated(segment, altitude, hint)
    };
    let logarithm = S::select(logarithm.less_than(-700.0), S::from(-700.0), logarithm);
    S::select(logarithm.less_than(700.0), logarithm, S::from(700.0)).exp()
}

/// The altitude, m, above which the density is less than a share of the greatest from altitude 0 on.
fn sensible_altitude(altitude: &[f64], log_density: &[f64], interpolated: &Cubics<1>) -> f64 {
    let [first, last] = *interpolated.range();
    let segment = usize::from(first <= 0.0) + usize::from(last <= 0.0);
    let [at_0] = interpolated.extrapolated(segment, 0.0, &Hint::default());
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
