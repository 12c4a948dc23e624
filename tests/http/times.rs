//! Times against a calendar that is counted day by day, and leap seconds against those of ERFA.

use std::ops::RangeInclusive;

use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use reentry_service::wire::epoch::Epoch;
use serde_json::json;

use crate::check::near;

/// A day, from which the calendar goes on by one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Date {
    year: i32,
    month: usize,
    day: i32,
}

const fn day(year: i32, month: usize, day: i32) -> Date {
    Date { year, month, day }
}

impl Date {
    /// The last day of its month: "Thirty days hath September".
    fn last(self) -> i32 {
        match self.month {
            4 | 6 | 9 | 11 => 30,
            2 if self.year % 400 == 0 => 29,
            2 if self.year % 100 == 0 => 28,
            2 if self.year % 4 == 0 => 29,
            2 => 28,
            _ => 31,
        }
    }

    fn next(self) -> Self {
        match self {
            Self { year, month, day: today } if today < self.last() => day(year, month, today + 1),
            Self { year, month: 12, .. } => day(year + 1, 1, 1),
            Self { year, month, .. } => day(year, month + 1, 1),
        }
    }

    fn before(self) -> Self {
        match self {
            Self { year, month: 1, day: 1 } => day(year - 1, 12, 31),
            Self { year, month, day: 1 } => day(year, month - 1, day(year, month - 1, 1).last()),
            Self { year, month, day: today } => day(year, month, today - 1),
        }
    }

    /// The date and time at a minute of the day, which may lie in the day before or after it.
    fn at(self, minute: i32) -> String {
        let (date, minute) = match minute {
            ..0 => (self.before(), minute + 1440),
            0..1440 => (self, minute),
            1440.. => (self.next(), minute - 1440),
        };
        let Self { year, month, day } = date;
        format!("{year:04}-{month:02}-{day:02}T{:02}:{:02}", minute / 60, minute % 60)
    }
}

/// Every offset that RFC 3339 has, in minutes.
const OFFSETS: RangeInclusive<i32> = -1439..=1439;

fn offset(minutes: i32) -> String {
    let sign = if minutes < 0 { '-' } else { '+' };
    format!("{sign}{:02}:{:02}", minutes.abs() / 60, minutes.abs() % 60)
}

fn read(text: &str) -> Result<Epoch, String> {
    Epoch::read(&json!(text))
}

/// The instant, as it is written back.
fn utc(text: &str) -> String {
    let instant = read(text).unwrap_or_else(|fault| panic!("{fault}"));
    instant.utc(0.0).unwrap_or_else(|| panic!("{text} cannot be written")).to_string()
}

/// The days at whose end there is a leap second: those before the steps of TAI - UTC in ERFA 2.0.1 (`dat.c`; IERS Bulletin C).
const LEAPS: [Date; 27] = [
    day(1972, 6, 30),
    day(1972, 12, 31),
    day(1973, 12, 31),
    day(1974, 12, 31),
    day(1975, 12, 31),
    day(1976, 12, 31),
    day(1977, 12, 31),
    day(1978, 12, 31),
    day(1979, 12, 31),
    day(1981, 6, 30),
    day(1982, 6, 30),
    day(1983, 6, 30),
    day(1985, 6, 30),
    day(1987, 12, 31),
    day(1989, 12, 31),
    day(1990, 12, 31),
    day(1992, 6, 30),
    day(1993, 6, 30),
    day(1994, 6, 30),
    day(1995, 12, 31),
    day(1997, 6, 30),
    day(1998, 12, 31),
    day(2005, 12, 31),
    day(2008, 12, 31),
    day(2012, 6, 30),
    day(2015, 6, 30),
    day(2016, 12, 31),
];

#[test]
fn every_offset_is_subtracted() {
    let mut count = 0;
    for date in [day(2026, 11, 22), day(2024, 2, 29), day(2023, 3, 1), day(1900, 2, 28), day(1999, 12, 31)] {
        for minute in [0, 1, 719, 1320, 1439] {
            for ahead in OFFSETS {
                let text = format!("{}:07{}", date.at(minute + ahead), offset(ahead));
                assert_eq!(utc(&text), format!("{}:07.000000Z", date.at(minute)), "{text}");
                count += 1;
            }
        }
    }
    assert_eq!(count, 25 * 2879);
    // Letters may be small, and -00:00 is UTC (RFC 3339, sections 4.3 and 5.6).
    for text in ["2026-11-22t12:00:07z", "2026-11-22T12:00:07-00:00", "2026-11-22T22:00:07+10:00"] {
        assert_eq!(utc(text), "2026-11-22T12:00:07.000000Z", "{text}");
    }
}

/// Every day of some centuries, and of the others, which are like them, the first and the last of every month.
#[test]
fn every_day_of_the_calendar_is_read_and_written() {
    let mut date = day(0, 1, 1);
    // 2000 years of 365 days, and 485 leap days.
    let mut since_2000 = -730_485.0;
    while date.year < 10_000 {
        let is_looked_at = [date.day == 1, date.day == date.last(), date.year < 400, (1900..2100).contains(&date.year)];
        if is_looked_at.contains(&true) {
            let noon = date.at(720);
            let instant = read(&format!("{noon}:00Z")).unwrap();
            assert!(instant.days().total_cmp(&since_2000).is_eq(), "{noon}: {}", instant.days());
            assert_eq!(instant.utc(0.0).unwrap().to_string(), format!("{noon}:00.000000Z"));
        }
        date = date.next();
        since_2000 += 1.0;
    }
    near("400 years have 146 097 days", since_2000, 20.0 * 146_097.0, 0.0);
}

#[test]
fn no_month_has_another_day() {
    for year in [0, 1600, 1900, 1972, 2000, 2023, 2024, 2100, 9999] {
        for month in 1..=12 {
            let last = day(year, month, 1).last();
            for today in 0..=99 {
                let text = format!("{year:04}-{month:02}-{today:02}T00:00:00Z");
                assert_eq!(read(&text).is_ok(), (1..=last).contains(&today), "{text}");
            }
        }
        for month in (0..=99).filter(|month| !(1..=12).contains(month)) {
            assert!(read(&format!("{year:04}-{month:02}-01T00:00:00Z")).is_err(), "month {month}");
        }
    }
}

#[test]
fn no_clock_shows_more() {
    for number in 0..=99 {
        let accepted = |text: String| read(&text).is_ok();
        assert_eq!(accepted(format!("2026-01-01T{number:02}:00:00Z")), number < 24, "hour {number}");
        assert_eq!(accepted(format!("2026-01-01T00:{number:02}:00Z")), number < 60, "minute {number}");
        assert_eq!(accepted(format!("2026-01-01T00:00:{number:02}Z")), number < 60, "second {number}");
        for sign in ['+', '-'] {
            assert_eq!(accepted(format!("2026-01-01T00:00:00{sign}{number:02}:00")), number < 24, "offset {number} h");
            assert_eq!(
                accepted(format!("2026-01-01T00:00:00{sign}00:{number:02}")),
                number < 60,
                "offset {number} min"
            );
        }
    }
}

#[test]
fn fractions_of_any_number_of_digits_are_read() {
    // Written back they are rounded to the microsecond.
    for (fraction, microseconds) in [
        (".5", "00.500000"),
        (".25", "00.250000"),
        (".0000004", "00.000000"),
        (".0000006", "00.000001"),
        (".123456789012345678901234567890", "00.123457"),
        (".9999994", "00.999999"),
        (".9999999999999999999999999", "01.000000"),
        (".000000000000000000000000000001", "00.000000"),
    ] {
        let text = format!("2026-11-22T12:00:00{fraction}+05:30");
        assert_eq!(utc(&text), format!("2026-11-22T06:30:{microseconds}Z"), "{text}");
    }
    let long = format!("2026-11-22T12:00:00.{}Z", "25".repeat(10_000));
    assert_eq!(utc(&long), "2026-11-22T12:00:00.252525Z");
}

#[test]
fn leap_seconds_are_read_at_every_offset_and_nowhere_else() {
    for leap in LEAPS {
        for ahead in OFFSETS {
            let text = format!("{}:60.25{}", leap.at(1439 + ahead), offset(ahead));
            let last = leap.at(1439);
            assert_eq!(utc(&text), format!("{last}:60.250000Z"), "{text}");
        }
    }
    assert_eq!(utc("2017-01-01T08:59:60+09:00"), utc("2016-12-31T23:59:60Z"));
    // The end of any other day, and any other minute of this one, has no second 60.
    let mut date = day(1971, 1, 1);
    while date.year < 2060 {
        for ahead in [0, 540, -1439, 1439] {
            let text = format!("{}:60{}", date.at(1439 + ahead), offset(ahead));
            assert_eq!(read(&text).is_ok(), LEAPS.contains(&date), "{text}");
        }
        date = date.next();
    }
    for minute in 0..1439 {
        assert!(read(&format!("{}:60Z", day(2016, 12, 31).at(minute))).is_err(), "minute {minute}");
    }
    let fault = read("2026-06-30T23:59:60Z").unwrap_err();
    let expected = "must be an RFC 3339 time whose second is 60 only in a leap second, such as \
                    \"2016-12-31T23:59:60Z\", got \"2026-06-30T23:59:60Z\"";
    assert_eq!(fault, expected);
}

#[test]
fn an_offset_may_lead_out_of_the_years_that_can_be_written() {
    for (text, instant) in [
        ("0000-01-01T00:00:00Z", Some("0000-01-01T00:00:00.000000Z")),
        ("0000-01-01T00:00:00-00:01", Some("0000-01-01T00:01:00.000000Z")),
        ("0000-01-01T23:59:00+23:59", Some("0000-01-01T00:00:00.000000Z")),
        ("0000-01-01T00:00:59+00:01", None),
        ("0000-01-01T23:58:59.999+23:59", None),
        ("9999-12-31T23:59:59Z", Some("9999-12-31T23:59:59.000000Z")),
        ("9999-12-31T23:59:59+00:01", Some("9999-12-31T23:58:59.000000Z")),
        ("9999-12-31T00:00:00-23:59", Some("9999-12-31T23:59:00.000000Z")),
        ("9999-12-31T23:59:00-00:01", None),
        ("9999-12-31T00:01:00-23:59", None),
    ] {
        match (read(text), instant) {
            (Ok(found), Some(instant)) => assert_eq!(found.utc(0.0).unwrap().to_string(), instant, "{text}"),
            (Err(fault), None) => assert!(fault.contains("whose year in UTC is from 0000 to 9999"), "{fault}"),
            (found, _) => panic!("{text}: {found:?}"),
        }
    }
}

#[test]
fn seconds_later_are_written_to_the_microsecond_leap_seconds_included() {
    for (start, seconds, expected) in [
        ("2026-11-22T12:00:00Z", 0.0, Some("2026-11-22T12:00:00.000000Z")),
        ("2026-11-22T12:00:00Z", 0.000_000_499, Some("2026-11-22T12:00:00.000000Z")),
        ("2026-11-22T12:00:00Z", 0.000_000_501, Some("2026-11-22T12:00:00.000001Z")),
        ("2026-11-22T12:00:00+01:00", 86_400.25, Some("2026-11-23T11:00:00.250000Z")),
        ("2024-02-28T23:59:59.5Z", 0.5, Some("2024-02-29T00:00:00.000000Z")),
        ("2016-12-31T23:59:59Z", 0.999_999_9, Some("2016-12-31T23:59:60.000000Z")),
        ("2016-12-31T23:59:59Z", 1.5, Some("2016-12-31T23:59:60.500000Z")),
        ("2016-12-31T23:59:59Z", 2.0, Some("2017-01-01T00:00:00.000000Z")),
        ("2016-12-31T23:59:60Z", 0.0, Some("2016-12-31T23:59:60.000000Z")),
        ("2016-12-31T23:59:60.5Z", 0.5, Some("2017-01-01T00:00:00.000000Z")),
        ("2016-12-31T23:59:60Z", 2.0, Some("2017-01-01T00:00:01.000000Z")),
        ("0000-01-01T00:00:00Z", 1.0, Some("0000-01-01T00:00:01.000000Z")),
        ("9999-12-31T23:59:59Z", 0.999, Some("9999-12-31T23:59:59.999000Z")),
        ("9999-12-31T23:59:59Z", 0.999_999_9, None),
        ("9999-12-31T23:59:59Z", 1.0, None),
        ("9999-12-31T23:59:59Z", 1e9, None),
        ("2026-11-22T12:00:00Z", 1e300, None),
    ] {
        let utc = read(start).unwrap().utc(seconds).map(|utc| utc.to_string());
        assert_eq!(utc.as_deref(), expected, "{start} and {seconds} s");
    }
}

/// From before all leap seconds to after them, a second at a time where there is one, and a day at a time elsewhere.
#[test]
fn a_long_flight_counts_every_leap_second() {
    let start = read("1971-12-31T12:00:00Z").unwrap();
    let (mut date, mut elapsed) = (day(1971, 12, 31), 0.0);
    while date.year < 2018 {
        let written = |seconds: f64| start.utc(elapsed + seconds).unwrap().to_string();
        assert_eq!(written(0.0), format!("{}:00.000000Z", date.at(720)));
        assert_eq!(written(43_199.0), format!("{}:59.000000Z", date.at(1439)));
        let midnight = format!("{}:00.000000Z", date.next().at(0));
        if LEAPS.contains(&date) {
            assert_eq!(written(43_200.0), format!("{}:60.000000Z", date.at(1439)));
            assert_eq!(written(43_201.0), midnight);
            elapsed += 1.0;
        } else {
            assert_eq!(written(43_200.0), midnight);
        }
        elapsed += 86_400.0;
        date = date.next();
    }
}

/// Days from 1 January 2000, by adding up years and months.
fn days_since_2000(date: Date) -> i32 {
    let of_year = |year: i32| (1..=12).map(|month| day(year, month, 1).last()).sum::<i32>();
    let years: i32 = if date.year < 2000 {
        -(date.year..2000).map(of_year).sum::<i32>()
    } else {
        (2000..date.year).map(of_year).sum()
    };
    years + (1..date.month).map(|month| day(date.year, month, 1).last()).sum::<i32>() + date.day - 1
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 2000, failure_persistence: None, rng_seed: RngSeed::Fixed(1), ..ProptestConfig::default()
    })]

    #[test]
    fn any_time_is_the_instant_that_an_independent_calendar_has(
        (year, month, today) in (1..9999, 1_usize..=12, 1..=31),
        (minute, second, ahead) in (0..1440, 0..60, OFFSETS),
        fraction in "(\\.[0-9]{1,40})?",
        small in any::<[bool; 2]>(),
    ) {
        let date = day(year, month, today);
        let text = format!("{}:{second:02}{fraction}{}", date.at(minute), offset(ahead));
        let text = if small[0] { text.replace('T', "t") } else { text };
        if today > date.last() {
            prop_assert!(read(&text).is_err(), "{text}");
        } else {
            let instant = read(&text).unwrap();
            let part = format!("0{fraction}").parse::<f64>().unwrap();
            let seconds = f64::from(60 * (minute - ahead) + second) + part;
            let days = f64::from(days_since_2000(date)) - 0.5 + seconds / 86_400.0;
            // Two roundings of three million days at most, and the digits after the ninth.
            near(&text, instant.days(), days, 1e-14 + 4.0 * f64::EPSILON * days.abs());
            // What is written back is the same instant, to half a microsecond.
            let again = read(&instant.utc(0.0).unwrap().to_string()).unwrap();
            near(&text, again.days(), days, 0.51e-6 / 86_400.0 + 4.0 * f64::EPSILON * days.abs());
        }
    }

    /// After all leap seconds, days have 86 400 s.
    #[test]
    fn a_time_later_is_written_as_an_independent_calendar_has_it(
        (minute, second, millisecond) in (0..1440, 0..60, 0..1000),
        (days, later) in (0..3000, 0..86_400_000),
    ) {
        let start = day(2017, 1, 1);
        let text = format!("{}:{second:02}.{millisecond:03}Z", start.at(minute));
        let elapsed = f64::from(days) * 86_400.0 + f64::from(later) / 1e3;
        let found = read(&text).unwrap().utc(elapsed).unwrap().to_string();
        let total = (60 * minute + second) * 1000 + millisecond + later;
        let (carried, rest) = (total / 86_400_000, total % 86_400_000);
        let date = (0..days + carried).fold(start, |date, _| date.next());
        let expected = format!("{}:{:02}.{:03}000Z", date.at(rest / 60_000), rest / 1000 % 60, rest % 1000);
        prop_assert_eq!(found, expected);
    }

    /// A time with a letter or two changed is none, or one that can be written.
    #[test]
    fn what_is_nearly_a_time_is_none_or_a_sound_one(
        changes in prop::collection::vec((0_usize..32, "[-+0-9tTzZ:. é٣]"), 1..3),
        fraction in "(\\.[0-9]{1,5})?",
    ) {
        let mut text: Vec<String> = format!("2016-12-31T23:59:60{fraction}+00:00").chars().map(String::from).collect();
        for (place, letter) in changes {
            let place = place % text.len();
            text[place] = letter;
        }
        let text = text.concat();
        if let Ok(instant) = read(&text) {
            prop_assert!(text.is_ascii());
            let written = instant.utc(0.0).unwrap().to_string();
            prop_assert_eq!(utc(&written), written);
        }
    }
}
