//! The Gregorian calendar of the years 0000 to 9999, before its introduction too, as RFC 3339 has it.

/// A day of the calendar.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd)]
pub(super) struct Date {
    pub(super) year: i64,
    /// From 1 on.
    pub(super) month: i64,
    /// From 1 on.
    pub(super) day: i64,
}

/// The days of a common year before each month, and all of them.
const BEFORE_MONTH: [i64; 13] = [0, 31, 59, 90, 120, 151, 181, 212, 243, 273, 304, 334, 365];

/// Days from 0000 January 1 to 2000 January 1.
const TO_2000: i64 = before_year(2000);

impl Date {
    pub(super) const LAST: Self = Self { year: 9999, month: 12, day: 31 };

    /// Days from 2000 January 1 to this one; none where the calendar has no such day.
    pub(super) fn since_2000(self) -> Option<i64> {
        let Self { year, month, day } = self;
        let exists =
            (0..=9999).contains(&year) && (1..=12).contains(&month) && (1..=days_of(year, month)).contains(&day);
        exists.then(|| days_since_2000(year, month, day))
    }

    /// The day so many days after 2000 January 1; none outside the years 0000 to 9999.
    pub(super) fn after_2000(days: i64) -> Option<Self> {
        let days = days.checked_add(TO_2000).filter(|days| (0..before_year(10_000)).contains(days))?;
        // 400 years have 146 097 days, and leap days lie so evenly that the year is this one or one beside it.
        let near = days * 400 / 146_097;
        let year = (near - 1..=near + 1).take_while(|year| before_year(*year) <= days).last()?;
        let of_year = days - before_year(year);
        let month = (1..=12).take_while(|month| before_month(year, *month) <= of_year).last()?;
        Some(Self { year, month, day: of_year - before_month(year, month) + 1 })
    }
}

/// Days from 2000 January 1 to a day that the calendar has.
pub(super) const fn days_since_2000(year: i64, month: i64, day: i64) -> i64 {
    before_year(year) + before_month(year, month) + day - 1 - TO_2000
}

/// Days from 0000 January 1 to that of the year, with a leap day in every year before it that has one.
const fn before_year(year: i64) -> i64 {
    365 * year + (year + 3) / 4 - (year + 99) / 100 + (year + 399) / 400
}

/// Days from January 1 to the first of a month; the 13th is after the year.
const fn before_month(year: i64, month: i64) -> i64 {
    let has_leap_day = year % 4 == 0 && (year % 100 != 0 || year % 400 == 0);
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 1 to 13")]
    let common = BEFORE_MONTH[(month - 1) as usize];
    common + (has_leap_day && month > 2) as i64
}

fn days_of(year: i64, month: i64) -> i64 {
    before_month(year, month + 1) - before_month(year, month)
}
