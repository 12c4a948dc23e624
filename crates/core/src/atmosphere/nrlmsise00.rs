//! NRLMSISE-00: the air by place, time, solar flux and geomagnetic activity.
//!
//! The model is that of the crate `nrlmsise00`, evaluated directly, at dual numbers too. Around it: the place from planet-fixed coordinates,
//! pressure and speed of sound from the number densities, a day that does not jump at midnight, and the air below the model.
//!
//! # Reference
//! J. M. Picone, A. E. Hedin, D. P. Drob and A. C. Aikin, NRLMSISE-00 empirical model of the atmosphere: Statistical comparisons and scientific
//! issues, J. Geophys. Res. 107 (2002) 1468.

use std::f64::consts::PI;

use nalgebra::Vector3;
use nrlmsise00::{Input, MagneticActivity, Model, Output};

use super::AtmosphereSample;
use super::table::MOLAR_GAS_CONSTANT;
use crate::scalar::{LookUp, Plain, Scalar, length};

/// Where the model begins, m: below, its polynomials grow without bound.
const BOTTOM: f64 = -5e3;
/// Where the model ends, m.
const TOP: f64 = 1000e3;
/// From here on the air stays as it is, m.
const HIGHEST: f64 = 1e8;
/// Above it the density is less than 1e-15 of that at the ground, also when the Sun is active, m.
pub(super) const SENSIBLE_ALTITUDE: f64 = 1500e3;
/// The height, m, over which the density falls by e at the mesopause, where it is coldest.
pub(super) const LEAST_SCALE_HEIGHT: f64 = 3500.0;
/// Standard gravity, m/s², by which the air below the model grows.
const GRAVITY: f64 = 9.806_65;
/// Of molecules and atoms in a mole (SI).
const AVOGADRO: f64 = 6.022_140_76e23;
/// A day, s.
const DAY: f64 = 86_400.0;

/// The altitudes, m, at which the model begins and ends. Between them its density jumps by up to 1.5e-3, at 72.5 and at 123.435 km; to meet
/// these boundaries makes flights no more exact, and takes as many evaluations.
pub(super) const BOUNDARIES: [f64; 2] = [BOTTOM, TOP];

/// What the Sun does to the upper air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SpaceWeather {
    /// F10.7 of the day before, in solar flux units, 1e-22 W/(m² Hz).
    pub f107: f64,
    /// Its mean over 81 days around the day.
    pub f107_average: f64,
    /// The geomagnetic activity.
    pub ap: Ap,
}

/// The index of the geomagnetic activity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Ap {
    /// The mean of the day.
    Daily(f64),
    /// Seven numbers: the mean of the day; those of the three hours of the instant, and 3, 6 and 9 hours before; the means from 12 to 33 and
    /// from 36 to 57 hours before.
    History([f64; 7]),
}

impl SpaceWeather {
    /// A Sun of medium activity and a quiet day, which the authors advise for altitudes below 80 km.
    pub const MEDIUM: Self = Self { f107: 150.0, f107_average: 150.0, ap: Ap::Daily(4.0) };
}

/// The model at an epoch, in given space weather.
#[derive(Clone, Debug)]
pub struct Nrlmsise00 {
    model: Model,
    day_of_year: i32,
    second: f64,
    space_weather: SpaceWeather,
}

/// The model is the same in all.
impl PartialEq for Nrlmsise00 {
    fn eq(&self, other: &Self) -> bool {
        (self.day_of_year, self.second, self.space_weather) == (other.day_of_year, other.second, other.space_weather)
    }
}

impl Nrlmsise00 {
    /// The model with t = 0 on a day of the year, from 1, at a second of it in UT, which may be beyond its end.
    pub fn new(day_of_year: u16, second: f64, space_weather: SpaceWeather) -> Self {
        Self { model: Model::new(), day_of_year: i32::from(day_of_year), second, space_weather }
    }

    /// The air at a time, s, and a planet-fixed position, m, above the ellipsoid with these semi-axes in the equatorial plane and along the pole,
    /// m.
    pub fn sample<S: Scalar>(&self, semi_axes: (f64, f64), time: S, position: &Vector3<S>) -> AtmosphereSample<S> {
        let at = [time, position.x, position.y, position.z];
        let [density, temperature, pressure, sound] = S::look_up(at, &Above { model: self, semi_axes });
        AtmosphereSample {
            density,
            temperature: Some(temperature),
            pressure: Some(pressure),
            speed_of_sound: Some(sound),
        }
    }

    /// The air at t = 0 at an altitude, m, above latitude 0 and longitude 0: for those who know no place.
    pub(super) fn above_origin<S: Scalar>(&self, altitude: S) -> AtmosphereSample<S> {
        let radius = 6_378_137.0;
        self.sample((radius, radius), S::zero(), &Vector3::new(altitude + radius, S::zero(), S::zero()))
    }

    /// Density, temperature, pressure and speed of sound at a time, s, and a geodetic place, m and rad.
    fn at_place<S: Plain>(&self, time: S, altitude: S, latitude: S, longitude: S) -> [S; 4] {
        let below = altitude.less_than(BOTTOM);
        let above = !altitude.less_than(HIGHEST);
        let inside = S::select(below, S::from(BOTTOM), S::select(above, S::from(HIGHEST), altitude));
        let at_day = |day| self.gas(day, time, inside, latitude, longitude);
        // The first day stays that of the epoch; the second catches up with the calendar.
        let days = time.value() / DAY;
        let [lead, rate] = match days {
            _ if days <= 1.0 => [0.0, 0.0],
            _ if days < 2.0 => [2.0 * (days - 1.0), 2.0 / DAY],
            _ => [days, 1.0 / DAY],
        };
        let whole = lead.floor();
        #[expect(clippy::cast_possible_truncation, reason = "days of a flight; the cast saturates")]
        let day = self.day_of_year.saturating_add(whole as i32);
        let [density, temperature, pressure, heat] = if rate > 0.0 {
            let part = (time - time.value()) * rate + (lead - whole);
            let [one, other] = [at_day(day), at_day(day.saturating_add(1))];
            std::array::from_fn(|k| one[k] + (other[k] - one[k]) * part)
        } else {
            at_day(day)
        };
        let thin = density.less_than(f64::MIN_POSITIVE);
        let over_density = Scalar::recip(S::select(thin, S::one(), density));
        let sound = S::select(thin, S::one(), Scalar::sqrt(heat * over_density));
        // Below, at the temperature of the bottom: ρ ~ e^(-h/H), H = p/(ρ g).
        let depth = S::select(below, -(altitude - BOTTOM), S::zero());
        let depths = depth * (density * Scalar::recip(S::select(thin, S::one(), pressure)) * GRAVITY);
        let depths = S::select(depths.less_than(700.0), depths, S::from(700.0));
        let factor = Scalar::exp(depths);
        [density * factor, temperature, pressure * factor, sound]
    }

    /// Density, temperature, pressure, and pressure times γ, of the gases on a day.
    fn gas<S: Plain>(&self, day_of_year: i32, time: S, altitude: S, latitude: S, longitude: S) -> [S; 4] {
        let SpaceWeather { f107, f107_average, ap } = self.space_weather;
        let magnetic = match ap {
            Ap::Daily(ap) => MagneticActivity::Daily { ap: S::from(ap) },
            Ap::History(ap) => MagneticActivity::History { ap: ap.map(S::from) },
        };
        let output = self.model.gtd7d(&Input::consistent(
            day_of_year,
            time + self.second,
            altitude * 1e-3,
            latitude * (180.0 / PI),
            longitude * (180.0 / PI),
            S::from(f107_average),
            S::from(f107),
            magnetic,
        ));
        let Output { molecular_nitrogen, molecular_oxygen, temperature, total_mass, .. } = output;
        let of_two_atoms = molecular_nitrogen + molecular_oxygen;
        let of_one = output.helium + output.atomic_oxygen + output.argon + output.hydrogen + output.atomic_nitrogen;
        let energy = temperature * (MOLAR_GAS_CONSTANT / AVOGADRO);
        let pressure = (of_two_atoms + of_one) * energy;
        // γ = c_p/c_v of gases of one and of two atoms, which turn and do not vibrate.
        let [heat, work] = [(3.5, 2.5), (2.5, 1.5)].map(|(two, one)| of_two_atoms * two + of_one * one);
        let none = work.less_than(f64::MIN_POSITIVE);
        let ratio = heat * Scalar::recip(S::select(none, S::one(), work));
        [total_mass, temperature, pressure, pressure * ratio]
    }
}

/// The air above an ellipsoid, by time and position.
struct Above<'a> {
    model: &'a Nrlmsise00,
    semi_axes: (f64, f64),
}

impl LookUp<4, 4> for Above<'_> {
    fn at<S: Plain>(&self, [time, x, y, z]: [S; 4]) -> [S; 4] {
        let [latitude, altitude] = geodetic(&Vector3::new(x, y, z), self.semi_axes);
        // On the axis every longitude is as good, and none has a slope.
        let on_axis = (x * x + y * y).less_than(1e-6);
        let longitude = Scalar::atan2(S::select(on_axis, S::zero(), y), S::select(on_axis, S::one(), x));
        self.model.at_place(time, altitude, latitude, longitude)
    }
}

/// Geodetic latitude, rad, and altitude, m, above the ellipsoid with these semi-axes in the equatorial plane and along the pole, m, in closed form: off by less than 1e-9 rad and 1e-6 m within 1000 km of the Earth's surface.
///
/// # Reference
/// B. R. Bowring, The accuracy of geodetic latitude and height equations, Survey Review 28 (1985) 202-206.
pub fn geodetic<S: Scalar>(position: &Vector3<S>, (a, b): (f64, f64)) -> [S; 2] {
    let z = position.z;
    let across = (position.x * position.x + position.y * position.y).sqrt();
    let radius = length(position);
    let eccentricity_squared = 1.0 - (b / a) * (b / a);
    let second = (a / b) * (a / b) - 1.0;
    // The reduced latitude, whose tangent is (b z/a p)(1 + e'² b/r).
    let nearly_none = radius.less_than(f64::MIN_POSITIVE);
    let over_radius = S::select(nearly_none, S::one(), radius).recip();
    let [sine, cosine] = unit([z * ((over_radius * (second * b) + 1.0) * b), across * a]);
    let north = z + sine * sine * sine * (second * b);
    let outward = across - cosine * cosine * cosine * (eccentricity_squared * a);
    let [sine, cosine] = unit([north, outward]);
    let normal = (-(sine * sine * eccentricity_squared) + 1.0).sqrt();
    [sine.atan2(cosine), across * cosine + z * sine - normal * a]
}

/// Both parts over the length of the two.
fn unit<S: Scalar>([north, outward]: [S; 2]) -> [S; 2] {
    let length = (north * north + outward * outward).sqrt();
    let none = length.less_than(f64::MIN_POSITIVE);
    let over_length = S::select(none, S::one(), length).recip();
    [north * over_length, outward * over_length]
}
