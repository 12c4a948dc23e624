//! Dates and the clock face of sidereal time.

use hifitime::{Epoch, Unit};
use reentry::coordinates::earth_rotation_angle;
use reentry::planet::Planet;
use serde::Serialize;
use serde_json::Value;
use utoipa::ToSchema;

/// The seconds since the inertial and the planet-fixed frame were aligned, as a number or as `"HH:MM:SS.s"`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, ToSchema)]
#[serde(untagged)]
#[schema(example = json!("00:03:20.6"))]
pub enum SiderealTime {
    /// Seconds, any finite number.
    Seconds(f64),
    /// `"HH:MM:SS.s"`; answers give seconds.
    #[serde(skip)]
    #[schema(value_type = String, pattern = r"^\d{2,}:[0-5]\d:[0-5]\d(\.\d+)?$")]
    Clock(f64),
}

impl SiderealTime {
    /// Reads either form.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn read(value: &Value) -> Result<Self, String> {
        let fault = || format!("must be a number of seconds or \"HH:MM:SS.s\", got {value}");
        match value {
            Value::Number(number) => number.as_f64().map(Self::Seconds).ok_or_else(fault),
            Value::String(clock) => clock_seconds(clock).map(Self::Clock).ok_or_else(fault),
            _ => Err(fault()),
        }
    }

    /// In seconds.
    pub fn seconds(self) -> f64 {
        let (Self::Seconds(seconds) | Self::Clock(seconds)) = self;
        seconds
    }
}

/// The seconds of `"HH:MM:SS.s"`; hours have two digits or more.
fn clock_seconds(clock: &str) -> Option<f64> {
    let [hours, minutes, seconds] = clock.split(':').collect::<Vec<_>>().try_into().ok()?;
    let (whole, fraction) = seconds.split_once('.').unwrap_or((seconds, "0"));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let two_digits = |text: &str| text.len() == 2 && digits(text) && text < "60";
    let sound = hours.len() >= 2 && digits(hours) && two_digits(minutes) && two_digits(whole) && digits(fraction);
    let number = |text: &str| text.parse::<f64>().ok().filter(|number| number.is_finite());
    sound.then_some(number(hours)? * 3600.0 + number(minutes)? * 60.0 + number(seconds)?)
}

/// The instant t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    /// Days (of 86 400 s) since 2000 January 1, 12 h UTC.
    days: f64,
}

impl Instant {
    /// Reads an RFC 3339 date and time.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn read(value: &Value) -> Result<Self, String> {
        let fault = || format!("must be an RFC 3339 time such as \"2026-11-22T12:00:00Z\", got {value}");
        let text = value.as_str().filter(|text| is_rfc3339(text)).ok_or_else(fault)?;
        let epoch = Epoch::from_gregorian_str(text).map_err(|_| fault())?;
        let noon_2000 = Epoch::from_gregorian_utc(2000, 1, 1, 12, 0, 0, 0);
        let elapsed = epoch.to_utc_duration() - noon_2000.to_utc_duration();
        Ok(Self { days: elapsed.to_unit(Unit::Day) })
    }

    /// The seconds since the frames were aligned; none if the planet does not rotate.
    ///
    /// The inertial frame is then the equator and origin of date, and UT1 is taken as UTC (they differ by less than 0.9 s).
    pub fn sidereal_time(self, planet: &Planet) -> Option<f64> {
        let seconds = earth_rotation_angle(self.days) / planet.rotation_rate;
        seconds.is_finite().then_some(seconds)
    }
}

/// Whether the text has the form of RFC 3339: `YYYY-MM-DDThh:mm:ss[.s](Z|±hh:mm)`.
fn is_rfc3339(text: &str) -> bool {
    let bytes = text.as_bytes();
    let matches = |pattern: &[u8], bytes: &[u8]| {
        pattern.len() == bytes.len()
            && pattern.iter().zip(bytes).all(|(p, b)| if *p == b'0' { b.is_ascii_digit() } else { p == b })
    };
    let Some((date, rest)) = bytes.split_at_checked(19) else { return false };
    let zone_at = rest.iter().position(|byte| !byte.is_ascii_digit() && *byte != b'.').unwrap_or(rest.len());
    let (fraction, zone) = rest.split_at(zone_at);
    let sound_fraction = match fraction {
        [] => true,
        [b'.', digits @ ..] => !digits.is_empty() && digits.iter().all(u8::is_ascii_digit),
        _ => false,
    };
    matches(b"0000-00-00T00:00:00", date)
        && sound_fraction
        && (zone == b"Z" || matches(b"+00:00", zone) || matches(b"-00:00", zone))
}
