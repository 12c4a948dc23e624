//! Dates and the clock face of sidereal time.

mod calendar;

use std::cmp::Ordering;
use std::fmt;
use std::ops::Range;
use std::time::{SystemTime, UNIX_EPOCH};

use reentry::coordinates::earth_rotation_angle;
use reentry::scenario::Bound;
use serde::{Serialize, Serializer};
use serde_json::{Value, json};

use super::schema;
use super::shown::shown;
use calendar::{Date, days_since_2000};

/// The seconds since the inertial and the planet-fixed frame were aligned; requests may write them as `"HH:MM:SS.s"`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SiderealTime(pub f64);

/// The schema of what [`SiderealTime::read`] reads.
pub fn sidereal_time_schema() -> Value {
    let mut seconds = schema::number(Bound::SIDEREAL_TIME);
    seconds["description"] = json!("Time in seconds; responses use this form.");
    let clock = json!({
        "type": "string",
        "description": "`HH:MM:SS.s`, with two or more digits of hours, up to 1e9 s.",
        "pattern": CLOCK_PATTERN,
    });
    let doc = "Time since the inertial and the planet-fixed frame were aligned.";
    json!({"oneOf": [seconds, clock], "description": doc})
}

/// The schema of what [`Epoch::read`] reads.
pub fn epoch_schema() -> Value {
    json!({"type": "string", "format": "date-time", "pattern": RFC3339_PATTERN})
}

/// What [`SiderealTime::read`] takes for a clock.
const CLOCK_PATTERN: &str = r"^[0-9]{2,}:[0-5][0-9]:[0-5][0-9](\.[0-9]+)?$";
/// What [`Epoch::read`] takes for the form of a time; the calendar is checked beyond it.
const RFC3339_PATTERN: &str =
    r"^[0-9]{4}-[0-9]{2}-[0-9]{2}[Tt][0-2][0-9]:[0-5][0-9]:[0-6][0-9](\.[0-9]+)?([Zz]|[+-][0-2][0-9]:[0-5][0-9])$";

impl SiderealTime {
    /// Reads either form.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn read(value: &Value) -> Result<Self, String> {
        let fault = || format!("must be a number of seconds or \"HH:MM:SS.s\", got {}", shown(value));
        let seconds = match value {
            Value::Number(number) => number.as_f64().ok_or_else(fault),
            Value::String(clock) => clock_seconds(clock).ok_or_else(fault),
            _ => Err(fault()),
        }?;
        let bound = Bound::SIDEREAL_TIME;
        let is_sound = bound.admits(seconds);
        is_sound.then_some(Self(seconds)).ok_or_else(|| format!("must be {bound} s, got {}", shown(value)))
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

/// The day since 2000 January 1 of a year, month and day in digits; none where the calendar has no such day.
pub fn day_of(year: &str, month: &str, day: &str) -> Option<i64> {
    let number = |text: &str| text.trim().parse().ok();
    Date { year: number(year)?, month: number(month)?, day: number(day)? }.since_2000()
}

/// The instant t = 0.
///
/// It is kept to the nanosecond, in which the Earth turns by less than 1e-13 rad; further digits are dropped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Epoch {
    /// Days since 2000 January 1, of UTC.
    day: i64,
    /// Seconds of the day; 86 400 in a leap second.
    second: i64,
    nanosecond: u32,
}

/// The days of UTC, since 2000 January 1, that ended with a leap second, 23:59:60.
///
/// # Reference
/// International Earth Rotation and Reference Systems Service, Bulletin C.
const LEAP_SECONDS: [i64; 27] = [
    days_since_2000(1972, 6, 30),
    days_since_2000(1972, 12, 31),
    days_since_2000(1973, 12, 31),
    days_since_2000(1974, 12, 31),
    days_since_2000(1975, 12, 31),
    days_since_2000(1976, 12, 31),
    days_since_2000(1977, 12, 31),
    days_since_2000(1978, 12, 31),
    days_since_2000(1979, 12, 31),
    days_since_2000(1981, 6, 30),
    days_since_2000(1982, 6, 30),
    days_since_2000(1983, 6, 30),
    days_since_2000(1985, 6, 30),
    days_since_2000(1987, 12, 31),
    days_since_2000(1989, 12, 31),
    days_since_2000(1990, 12, 31),
    days_since_2000(1992, 6, 30),
    days_since_2000(1993, 6, 30),
    days_since_2000(1994, 6, 30),
    days_since_2000(1995, 12, 31),
    days_since_2000(1997, 6, 30),
    days_since_2000(1998, 12, 31),
    days_since_2000(2005, 12, 31),
    days_since_2000(2008, 12, 31),
    days_since_2000(2012, 6, 30),
    days_since_2000(2015, 6, 30),
    days_since_2000(2016, 12, 31),
];

/// A day without a leap second, s.
const DAY: i64 = 86_400;

impl Epoch {
    /// Reads an RFC 3339 date and time.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn read(value: &Value) -> Result<Self, String> {
        let fault = |which: &str| format!("must be an RFC 3339 time {which}, got {}", shown(value));
        let text = value.as_str().and_then(Rfc3339::read);
        let text = text.ok_or_else(|| fault("such as \"2026-11-22T12:00:00Z\""))?;
        let instant = text
            .instant()
            .ok_or_else(|| fault("whose second is 60 only in a leap second, such as \"2016-12-31T23:59:60Z\""))?;
        let has_four_digits = Date::after_2000(instant.day).is_some();
        has_four_digits.then_some(instant).ok_or_else(|| fault("whose year in UTC is from 0000 to 9999"))
    }

    /// 2000 January 1, 12 h UTC.
    pub fn noon_2000() -> Self {
        Self { day: 0, second: DAY / 2, nanosecond: 0 }
    }

    /// The time so many seconds later, leap seconds counted; none after the year 9999, where RFC 3339 ends.
    pub fn utc(self, seconds: f64) -> Option<Utc> {
        let whole = seconds.floor();
        let microseconds = ((seconds - whole) * 1e6 + f64::from(self.nanosecond) / 1e3).round();
        #[expect(clippy::cast_possible_truncation, reason = "whole numbers; the cast saturates")]
        let [whole, microseconds] = [whole as i64, microseconds as i64];
        let elapsed = self.elapsed().checked_add(whole)? + microseconds / 1_000_000;
        let (day, second) = day_and_second(elapsed);
        let date = Date::after_2000(day)?;
        Some(Utc { date, second, microsecond: microseconds % 1_000_000 })
    }

    /// By how much [`Self::utc`] rounds the time so many seconds later, s: what it gives is half a microsecond off at most.
    pub fn rounding(self, seconds: f64) -> f64 {
        let microseconds = (seconds - seconds.floor()) * 1e6 + f64::from(self.nanosecond) / 1e3;
        (microseconds.round() - microseconds) * 1e-6
    }

    /// The angle by which the Earth is turned from the equator and origin of date. UT1 is taken as UTC, from which it differs by less
    /// than 0.9 s.
    pub fn earth_rotation_angle(self) -> f64 {
        earth_rotation_angle(self.days())
    }

    /// The day of UTC since 2000 January 1, and its second.
    pub fn day_and_second_of_day(self) -> (i64, i64) {
        (self.day, self.second)
    }

    /// The day of its year in UTC, from 1, and the seconds of that day.
    pub fn day_of_year(self) -> (u16, f64) {
        let first = Date { year: self.year(), month: 1, day: 1 }.since_2000().unwrap_or(self.day);
        let day = u16::try_from(self.day - first + 1).unwrap_or(1);
        #[expect(clippy::cast_precision_loss, reason = "less than 86 401")]
        let second = self.second as f64;
        (day, second + f64::from(self.nanosecond) * 1e-9)
    }

    /// The date of a day since 2000 January 1, as text.
    pub fn of_day(day: i64) -> Option<String> {
        Date::after_2000(day).map(|Date { year, month, day }| format!("{year:04}-{month:02}-{day:02}"))
    }

    /// The year in UTC.
    pub fn year(self) -> i64 {
        Date::after_2000(self.day).map_or(0, |date| date.year)
    }

    /// Days (of 86 400 s) of UTC since 2000 January 1, 12 h.
    pub fn days(self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "less than four million days")]
        let [day, second] = [self.day as f64, (self.second - DAY / 2) as f64];
        day + (second + f64::from(self.nanosecond) * 1e-9) / 86_400.0
    }

    /// Days (of 86 400 s) of barycentric dynamical time since J2000, 2000 January 1, 12 h. It is taken as terrestrial time, from which it differs by 2 ms: 32.184 s
    /// ahead of TAI, which was 10 s ahead of UTC before its first leap second.
    pub fn barycentric_days(self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "less than four million days")]
        let seconds = (self.elapsed() - DAY / 2 + 10) as f64;
        (seconds + 32.184 + f64::from(self.nanosecond) * 1e-9) / 86_400.0
    }

    /// Seconds since 2000 January 1, 0 h, and one more for every leap second before the instant.
    fn elapsed(self) -> i64 {
        let leap_seconds: i64 = LEAP_SECONDS.iter().map(|leap| i64::from(*leap < self.day)).sum();
        DAY * self.day + self.second + leap_seconds
    }
}

/// The day since 2000 January 1, and its second, of a number of [elapsed](Epoch::elapsed) seconds.
fn day_and_second(elapsed: i64) -> (i64, i64) {
    let mut seconds = elapsed;
    for leap in LEAP_SECONDS {
        let start = DAY * (leap + 1);
        match seconds.cmp(&start) {
            Ordering::Less => break,
            Ordering::Equal => return (leap, DAY),
            Ordering::Greater => seconds -= 1,
        }
    }
    (seconds.div_euclid(DAY), seconds.rem_euclid(DAY))
}

/// A time of day in UTC, to the microsecond.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
pub struct Utc {
    date: Date,
    /// Of the day; 86 400 in a leap second.
    second: i64,
    microsecond: i64,
}

impl Utc {
    /// The time by the clock of the system, which counts no leap seconds; clocks before 1970 or after 9999 are taken to be there.
    pub fn of_clock(time: SystemTime) -> Self {
        let since_1970 = time.duration_since(UNIX_EPOCH).unwrap_or_default();
        let seconds = i64::try_from(since_1970.as_secs()).unwrap_or(i64::MAX);
        let date = Date::after_2000(seconds / DAY + days_since_2000(1970, 1, 1)).unwrap_or(Date::LAST);
        Self { date, second: seconds % DAY, microsecond: since_1970.subsec_micros().into() }
    }

    /// The year.
    pub fn year(self) -> i64 {
        self.date.year
    }

    /// The same, where what stands beside it says that it is in UTC.
    pub fn without_zone(self) -> String {
        self.to_string().trim_end_matches('Z').to_owned()
    }
}

impl fmt::Display for Utc {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { date: Date { year, month, day }, second, microsecond } = self;
        let minutes = second.min(&(DAY - 1)) / 60;
        let (hour, minute, second) = (minutes / 60, minutes % 60, second - 60 * minutes);
        write!(f, "{year:04}-{month:02}-{day:02}T{hour:02}:{minute:02}:{second:02}.{microsecond:06}Z")
    }
}

impl Serialize for Utc {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

/// The numbers of an RFC 3339 time.
struct Rfc3339 {
    /// Of the date, since 2000 January 1, at the offset from UTC.
    day: i64,
    hour: i64,
    minute: i64,
    second: i64,
    nanosecond: u32,
    /// By how much the clock is ahead of UTC, in minutes.
    offset: i64,
}

impl Rfc3339 {
    /// Reads `date-time` of RFC 3339, section 5.6, with the restrictions of section 5.7 but that of the second 60; none of another form.
    fn read(text: &str) -> Option<Self> {
        let (date_and_time, rest) = text.split_at_checked(19)?;
        let (fraction, zone) = rest.split_at(rest.find(['Z', 'z', '+', '-'])?);
        let digits = if fraction.is_empty() { "0" } else { fraction.strip_prefix('.')? };
        let is_fraction = !digits.is_empty() && digits.bytes().all(|byte| byte.is_ascii_digit());
        if !is_fraction || !has_form(&date_and_time.to_ascii_uppercase(), "0000-00-00T00:00:00") {
            return None;
        }
        let at = |place: Range<usize>| number(date_and_time, place);
        let date = Date { year: at(0..4)?, month: at(5..7)?, day: at(8..10)? };
        let time = Self {
            day: date.since_2000()?,
            hour: at(11..13)?,
            minute: at(14..16)?,
            second: at(17..19)?,
            nanosecond: format!("{digits:0<9}").get(..9)?.parse().ok()?,
            offset: offset(zone)?,
        };
        (time.hour < 24 && time.minute < 60 && time.second <= 60).then_some(time)
    }

    /// The instant; none of a second 60 that is no leap second.
    fn instant(&self) -> Option<Epoch> {
        let is_leap_second = self.second == 60;
        let minutes = 60 * self.hour + self.minute - self.offset;
        let day = self.day + minutes.div_euclid(24 * 60);
        let second = 60 * minutes.rem_euclid(24 * 60) + self.second;
        let exists = !is_leap_second || second == DAY && LEAP_SECONDS.contains(&day);
        exists.then_some(Epoch { day, second, nanosecond: self.nanosecond })
    }
}

/// The minutes by which a clock is ahead of UTC: `Z`, or `±hh:mm` within a day.
fn offset(zone: &str) -> Option<i64> {
    if zone.eq_ignore_ascii_case("Z") {
        return Some(0);
    }
    let sign = if zone.starts_with('-') { -1 } else { 1 };
    let has_form = has_form(zone, "+00:00") || has_form(zone, "-00:00");
    let (hours, minutes) = (number(zone, 1..3)?, number(zone, 4..6)?);
    (has_form && hours < 24 && minutes < 60).then_some(sign * (60 * hours + minutes))
}

/// The whole number of the digits at the place.
fn number(text: &str, place: Range<usize>) -> Option<i64> {
    text.get(place)?.parse().ok()
}

/// Whether the text is like the pattern, in which 0 stands for any digit.
fn has_form(text: &str, pattern: &str) -> bool {
    let like = |(byte, pattern): (u8, u8)| if pattern == b'0' { byte.is_ascii_digit() } else { byte == pattern };
    text.len() == pattern.len() && text.bytes().zip(pattern.bytes()).all(like)
}
