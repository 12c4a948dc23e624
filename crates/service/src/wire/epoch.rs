//! Dates and the clock face of sidereal time.

use std::fmt;

use hifitime::{Epoch, Unit};
use reentry::coordinates::earth_rotation_angle;
use reentry::planet::Planet;
use serde::{Serialize, Serializer};
use serde_json::Value;
use utoipa::openapi::schema::{ObjectBuilder, OneOfBuilder, Type};
use utoipa::openapi::{RefOr, Schema};
use utoipa::{PartialSchema, ToSchema};

use super::json::shown;

/// The seconds since the inertial and the planet-fixed frame were aligned; requests may write them as `"HH:MM:SS.s"`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SiderealTime(pub f64);

impl PartialSchema for SiderealTime {
    fn schema() -> RefOr<Schema> {
        let seconds = ObjectBuilder::new().schema_type(Type::Number).description(Some("Seconds; answers give these."));
        let clock = ObjectBuilder::new()
            .schema_type(Type::String)
            .description(Some("`HH:MM:SS.s`, the hours with two digits or more."))
            .pattern(Some(CLOCK_PATTERN));
        OneOfBuilder::new()
            .item(seconds)
            .item(clock)
            .description(Some("The time since the inertial and the planet-fixed frame were aligned."))
            .into()
    }
}

impl ToSchema for SiderealTime {}

/// What [`SiderealTime::read`] takes for a clock.
const CLOCK_PATTERN: &str = r"^[0-9]{2,}:[0-5][0-9]:[0-5][0-9](\.[0-9]+)?$";
/// What [`Instant::read`] takes for the form of a time; the calendar is checked beyond it.
pub const RFC3339_PATTERN: &str =
    r"^[0-9]{4}-[0-9]{2}-[0-9]{2}[Tt][0-2][0-9]:[0-5][0-9]:[0-6][0-9](\.[0-9]+)?([Zz]|[+-][0-2][0-9]:[0-5][0-9])$";

impl SiderealTime {
    /// Reads either form.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn read(value: &Value) -> Result<Self, String> {
        let fault = || format!("must be a number of seconds or \"HH:MM:SS.s\", got {}", shown(value));
        match value {
            Value::Number(number) => number.as_f64().map(Self).ok_or_else(fault),
            Value::String(clock) => clock_seconds(clock).map(Self).ok_or_else(fault),
            _ => Err(fault()),
        }
    }
}

/// The seconds of `"HH:MM:SS.s"`; hours have two digits or more.
fn clock_seconds(clock: &str) -> Option<f64> {
    let [hours, minutes, seconds] = clock.split(':').collect::<Vec<_>>().try_into().ok()?;
    let (whole, fraction) = seconds.split_once('.').unwrap_or((seconds, "0"));
    let digits = |text: &str| !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    let two_digits = |text: &str| text.len() == 2 && digits(text) && text < "60";
    let sound = hours.len() >= 2 && digits(hours) && two_digits(minutes) && two_digits(whole) && digits(fraction);
    let number = |text: &str| text.parse::<f64>().ok();
    let sum = number(hours)? * 3600.0 + number(minutes)? * 60.0 + number(seconds)?;
    (sound && sum.is_finite()).then_some(sum)
}

/// The instant t = 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Instant {
    epoch: Epoch,
    /// Days (of 86 400 s) since 2000 January 1, 12 h UTC.
    days: f64,
}

impl Instant {
    /// Reads an RFC 3339 date and time.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn read(value: &Value) -> Result<Self, String> {
        let fault = || format!("must be an RFC 3339 time such as \"2026-11-22T12:00:00Z\", got {}", shown(value));
        let text = value.as_str().and_then(plain_rfc3339).ok_or_else(fault)?;
        let epoch = Epoch::from_gregorian_str(&text).map_err(|_| fault())?;
        let elapsed = epoch.to_utc_duration() - Self::noon_2000().epoch.to_utc_duration();
        Ok(Self { epoch, days: elapsed.to_unit(Unit::Day) })
    }

    /// 2000 January 1, 12 h UTC.
    pub fn noon_2000() -> Self {
        Self { epoch: Epoch::from_gregorian_utc(2000, 1, 1, 12, 0, 0, 0), days: 0.0 }
    }

    /// The time so many seconds later; none after the year 9999, where RFC 3339 ends.
    ///
    /// Days have 86 400 s: a leap second during the flight is not counted.
    pub fn utc(self, seconds: f64) -> Option<Utc> {
        let rounding = Unit::Nanosecond * 500;
        let (year, month, day, hours, minutes, seconds, nanoseconds) =
            (self.epoch + Unit::Second * seconds + rounding).to_gregorian_utc();
        let time = Utc { date: (year, month, day), time: (hours, minutes, seconds), microseconds: nanoseconds / 1000 };
        (0..=9999).contains(&year).then_some(time)
    }

    /// The seconds since the frames were aligned; none if the planet does not rotate.
    ///
    /// The inertial frame is then the equator and origin of date, and UT1 is taken as UTC (they differ by less than 0.9 s).
    pub fn sidereal_time(self, planet: &Planet) -> Option<f64> {
        let seconds = earth_rotation_angle(self.days) / planet.rotation_rate;
        seconds.is_finite().then_some(seconds)
    }
}

/// A time of day in UTC, to the microsecond.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Utc {
    date: (i32, u8, u8),
    time: (u8, u8, u8),
    microseconds: u32,
}

impl fmt::Display for Utc {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { date: (year, month, day), time: (hours, minutes, seconds), microseconds } = self;
        write!(f, "{year:04}-{month:02}-{day:02}T{hours:02}:{minutes:02}:{seconds:02}.{microseconds:06}Z")
    }
}

impl Serialize for Utc {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// An RFC 3339 time in the form that `hifitime` reads: capital letters, and at most nine digits of a second,
/// since a nanosecond turns the Earth by no more than 1e-13 rad. None if it does not have the form of RFC 3339.
fn plain_rfc3339(text: &str) -> Option<String> {
    let text = text.to_ascii_uppercase();
    let (date_and_time, rest) = text.split_at_checked(19)?;
    let zone_at = rest.find(|c: char| !c.is_ascii_digit() && c != '.')?;
    let (fraction, zone) = rest.split_at(zone_at);
    let digits = fraction.strip_prefix('.').unwrap_or("0");
    let sound = has_form(date_and_time, "0000-00-00T00:00:00")
        && !digits.is_empty()
        && digits.bytes().all(|byte| byte.is_ascii_digit())
        && (zone == "Z" || is_offset(zone));
    let fraction = &fraction[..fraction.len().min(10)];
    sound.then(|| format!("{date_and_time}{fraction}{zone}"))
}

/// `±hh:mm`, within a day.
fn is_offset(zone: &str) -> bool {
    let number = |at: std::ops::Range<usize>| zone.get(at).and_then(|text| text.parse::<u8>().ok());
    let form = has_form(zone, "+00:00") || has_form(zone, "-00:00");
    form && number(1..3).is_some_and(|hours| hours < 24) && number(4..6).is_some_and(|minutes| minutes < 60)
}

/// Whether the text is like the pattern, in which 0 stands for any digit.
fn has_form(text: &str, pattern: &str) -> bool {
    let like = |(byte, pattern): (u8, u8)| if pattern == b'0' { byte.is_ascii_digit() } else { byte == pattern };
    text.len() == pattern.len() && text.bytes().zip(pattern.bytes()).all(like)
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::Instant;

    #[test]
    fn seconds_later_are_told_to_the_microsecond_on_days_of_86400_seconds() {
        for (start, seconds, expected) in [
            ("2026-11-22T12:00:00Z", 0.0, Some("2026-11-22T12:00:00.000000Z")),
            ("2026-11-22T12:00:00Z", 0.000_000_499, Some("2026-11-22T12:00:00.000000Z")),
            ("2026-11-22T12:00:00Z", 0.000_000_501, Some("2026-11-22T12:00:00.000001Z")),
            ("2026-11-22T12:00:00+01:00", 86_400.25, Some("2026-11-23T11:00:00.250000Z")),
            ("2024-02-28T23:59:59.5Z", 0.5, Some("2024-02-29T00:00:00.000000Z")),
            ("2016-12-31T23:59:59Z", 1.0, Some("2017-01-01T00:00:00.000000Z")),
            ("2016-12-31T23:59:60Z", 2.0, Some("2017-01-01T00:00:01.000000Z")),
            ("0000-01-01T00:00:00Z", 1.0, Some("0000-01-01T00:00:01.000000Z")),
            ("9999-12-31T23:59:59Z", 0.999, Some("9999-12-31T23:59:59.999000Z")),
            ("9999-12-31T23:59:59Z", 1.0, None),
            ("9999-12-31T23:59:59Z", 1e9, None),
        ] {
            let utc = Instant::read(&json!(start)).unwrap().utc(seconds).map(|utc| utc.to_string());
            assert_eq!(utc.as_deref(), expected, "{start} and {seconds} s");
        }
    }
}
