//! Solar flux and geomagnetic activity by date, from the file that the program is started with.

use std::collections::BTreeMap;
use std::sync::OnceLock;

use reentry::atmosphere::nrlmsise00::{Ap, SpaceWeather};

use super::epoch::{Epoch, day_of};

/// The file that the program is started with; none where it is started without.
static FILE: OnceLock<Records> = OnceLock::new();

/// The records of a file, by day.
#[derive(Clone, Debug)]
pub struct Records(BTreeMap<i64, Record>);

/// What a file says of a day.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Record {
    /// F10.7 as observed, at the Earth's distance from the Sun.
    f107: Option<f64>,
    /// The mean of ap.
    daily_ap: Option<f64>,
    /// ap of every three hours.
    ap: Option<[f64; 8]>,
}

/// Days of a mean of F10.7 on either side of its day.
const HALF_MEAN: i64 = 40;
/// Days of the history of ap before the day itself.
const HISTORY: i64 = 3;

/// Uses the records for all cases that ask for those of a file.
///
/// # Errors
/// With the records, where some are in use already.
pub fn install(records: Records) -> Result<(), Records> {
    FILE.set(records)
}

/// The indices of an instant, by the file of the program.
///
/// # Errors
/// With what is missing.
pub fn at(epoch: Epoch) -> Result<SpaceWeather, String> {
    let records = FILE.get().ok_or("is not available: the program was started without --space-weather FILE")?;
    records.at(epoch).ok_or_else(|| {
        let [first, last] = records.dates();
        format!("requires an epoch for which the space-weather file has its indices: it has days from {first} to {last}, and the mean flux takes 40 days on either side")
    })
}

impl Records {
    /// Reads a file: `SW-All.csv` or `SW-All.txt` of CelesTrak, or `Kp_ap_Ap_SN_F107_since_1932.txt` of the GFZ, or parts of them.
    ///
    /// # Errors
    /// With what is wrong.
    pub fn parse(text: &str) -> Result<Self, String> {
        let is_csv = text.trim_start().starts_with("DATE,");
        let is_fixed = text.contains("BEGIN OBSERVED");
        let mut records = BTreeMap::new();
        let mut is_data = !is_fixed;
        for (index, line) in text.lines().enumerate() {
            if is_fixed && (line.starts_with("BEGIN") || line.starts_with("END")) {
                // Monthly predictions are of no day.
                is_data = line.starts_with("BEGIN OBSERVED") || line.starts_with("BEGIN DAILY_PREDICTED");
                continue;
            }
            if !is_data || line.trim().is_empty() || line.starts_with('#') || line.starts_with("DATE,") {
                continue;
            }
            let record = if is_csv {
                of_csv(line)
            } else if is_fixed {
                of_fixed_columns(line)
            } else {
                of_gfz(line)
            };
            let (day, record) = record.ok_or_else(|| format!("line {} is not a record of space weather", index + 1))?;
            records.insert(day, record);
        }
        if records.is_empty() {
            return Err("there is no record of space weather; SW-All.csv and SW-All.txt of CelesTrak and \
                        Kp_ap_Ap_SN_F107_since_1932.txt of the GFZ can be read"
                .to_owned());
        }
        Ok(Self(records))
    }

    /// The first and the last day.
    fn dates(&self) -> [String; 2] {
        [self.0.keys().next(), self.0.keys().next_back()]
            .map(|day| day.and_then(|day| Epoch::of_day(*day)).unwrap_or_default())
    }

    /// The indices of an instant: F10.7 of the day before; its mean over 81 days; and the history of ap, or the mean of the day where the
    /// file has no more. None where it does not have them all.
    pub fn at(&self, epoch: Epoch) -> Option<SpaceWeather> {
        let (day, second) = epoch.day_and_second_of_day();
        let flux = |day: i64| self.0.get(&day)?.f107;
        let fluxes: Option<Vec<f64>> = (day - HALF_MEAN..=day + HALF_MEAN).map(flux).collect();
        let fluxes = fluxes?;
        #[expect(clippy::cast_precision_loss, reason = "81")]
        let f107_average = fluxes.iter().sum::<f64>() / fluxes.len() as f64;
        let daily = self.0.get(&day)?.daily_ap?;
        let ap = self.history(day, second).map_or(Ap::Daily(daily), |[now, rest @ ..]| {
            let [three, six, nine, to_33, to_57] = rest;
            Ap::History([daily, now, three, six, nine, to_33, to_57])
        });
        Some(SpaceWeather { f107: flux(day - 1)?, f107_average, ap })
    }

    /// ap of the three hours, and 3, 6 and 9 hours before; its means from 12 to 33 and from 36 to 57 hours before.
    fn history(&self, day: i64, second: i64) -> Option<[f64; 6]> {
        let mut intervals = Vec::new();
        for day in day - HISTORY..=day {
            intervals.extend(self.0.get(&day)?.ap?);
        }
        let now = usize::try_from(HISTORY * 8 + (second / 10_800).min(7)).ok()?;
        let before = |intervals_before: usize| intervals[now - intervals_before];
        let mean = |first: usize| (first..first + 8).map(before).sum::<f64>() / 8.0;
        Some([before(0), before(1), before(2), before(3), mean(4), mean(12)])
    }
}

/// A number that is not a mark for none.
fn number(text: &str) -> Option<f64> {
    text.trim().parse().ok().filter(|number: &f64| *number >= 0.0)
}

/// A solar flux that is not a mark for none.
fn flux(text: &str) -> Option<f64> {
    number(text).filter(|flux| *flux > 0.0)
}

/// All of some numbers.
fn all<const N: usize>(texts: &[&str]) -> Option<[f64; N]> {
    let numbers: Option<Vec<f64>> = texts.iter().map(|text| number(text)).collect();
    numbers?.try_into().ok()
}

/// A line of CelesTrak's CSV: `DATE,BSRN,ND,KP1..KP8,KP_SUM,AP1..AP8,AP_AVG,CP,C9,ISN,F10.7_OBS,...`.
fn of_csv(line: &str) -> Option<(i64, Record)> {
    let fields: Vec<&str> = line.split(',').collect();
    let [year, month, date] = fields.first()?.split('-').collect::<Vec<_>>().try_into().ok()?;
    let record =
        Record { ap: all(fields.get(12..20)?), daily_ap: number(fields.get(20)?), f107: flux(fields.get(24)?) };
    Some((day_of(year, month, date)?, record))
}

/// A line of CelesTrak's text, in fixed columns.
fn of_fixed_columns(line: &str) -> Option<(i64, Record)> {
    let column = |first: usize, last: usize| line.get(first - 1..last.min(line.len()));
    let ap: Option<Vec<&str>> = (0..8).map(|interval| column(47 + 4 * interval, 50 + 4 * interval)).collect();
    let record = Record { ap: all(&ap?), daily_ap: number(column(79, 82)?), f107: flux(column(113, 118)?) };
    Some((day_of(column(1, 4)?, column(6, 7)?, column(9, 10)?)?, record))
}

/// A line of the GFZ's file, in columns by spaces.
fn of_gfz(line: &str) -> Option<(i64, Record)> {
    let fields: Vec<&str> = line.split_whitespace().collect();
    let [year, month, date] = fields.get(..3)? else { return None };
    let record =
        Record { ap: all(fields.get(15..23)?), daily_ap: number(fields.get(23)?), f107: flux(fields.get(25)?) };
    Some((day_of(year, month, date)?, record))
}
