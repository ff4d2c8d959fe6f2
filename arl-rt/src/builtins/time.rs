//! Date and time of day, from the controller's clock.

use crate::context::cx::Cx;
use crate::values::Str;

const SECONDS_PER_DAY: i64 = 86_400;

/// 2000-01-01 00:00:00, in s since 1970: the date at which a run begins by default.
pub(crate) const YEAR_2000: i64 = 946_684_800;

/// The time of day as `hh:mm:ss`.
pub fn ctime(cx: &Cx) -> Str {
    let seconds = now(cx).rem_euclid(SECONDS_PER_DAY);
    format!("{:02}:{:02}:{:02}", seconds / 3600, seconds / 60 % 60, seconds % 60).into()
}

/// The date as `YYYY-MM-DD`.
pub fn cdate(cx: &Cx) -> Str {
    let (year, month, day) = date(now(cx).div_euclid(SECONDS_PER_DAY));
    format!("{year:04}-{month:02}-{day:02}").into()
}

fn now(cx: &Cx) -> i64 {
    cx.goes_on();
    cx.shared().start_date.saturating_add(cx.time() as i64)
}

/// The real time, in s since 1970 (UTC).
pub(crate) fn of_the_world() -> i64 {
    let since = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    since.map_or(YEAR_2000, |since| since.as_secs() as i64)
}

/// Seconds since 1970 for `now`, `YYYY-MM-DD`, or `YYYY-MM-DD hh:mm:ss` (a `T` between them is fine).
pub(crate) fn parse(text: &str) -> Option<i64> {
    if text == "now" {
        return Some(of_the_world());
    }
    let (day, time) = text.split_once([' ', 'T']).unwrap_or((text, "00:00:00"));
    let [year, month, day] = numbers(day, '-')?;
    let [hour, minute, second] = numbers(time, ':')?;
    let days = days(year, month, day);
    if !(1..=9999).contains(&year) || date(days) != (year, month, day) || hour > 23 || minute > 59 || second > 59 {
        return None;
    }
    Some(days * SECONDS_PER_DAY + hour * 3600 + minute * 60 + second)
}

fn numbers(text: &str, between: char) -> Option<[i64; 3]> {
    let parts: Vec<i64> =
        text.split(between).map(|part| part.parse::<u32>().ok().map(i64::from)).collect::<Option<_>>()?;
    parts.try_into().ok()
}

/// Days since 1970-01-01. Years begin in March here, so that the leap day comes last.
fn days(year: i64, month: i64, day: i64) -> i64 {
    let year = if month <= 2 { year - 1 } else { year };
    let (era, of_era) = (year.div_euclid(400), year.rem_euclid(400));
    let day_of_year = (153 * ((month + 9) % 12) + 2) / 5 + day - 1;
    era * 146_097 + of_era * 365 + of_era / 4 - of_era / 100 + day_of_year - 719_468
}

/// Year, month and day of a number of days since 1970-01-01.
fn date(days: i64) -> (i64, i64, i64) {
    let shifted = days + 719_468;
    let (era, of_era) = (shifted.div_euclid(146_097), shifted.rem_euclid(146_097));
    let year_of_era = (of_era - of_era / 1460 + of_era / 36_524 - of_era / 146_096) / 365;
    let day_of_year = of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
    let shifted_month = (5 * day_of_year + 2) / 153;
    let month = (shifted_month + 2) % 12 + 1;
    let year = era * 400 + year_of_era + i64::from(month <= 2);
    (year, month, day_of_year - (153 * shifted_month + 2) / 5 + 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dates_go_there_and_back() {
        assert_eq!(days(1970, 1, 1), 0);
        assert_eq!(date(0), (1970, 1, 1));
        assert_eq!(days(2000, 1, 1) * SECONDS_PER_DAY, YEAR_2000);
        assert_eq!(date(days(2024, 2, 29)), (2024, 2, 29));
        for day in -800_000..800_000 {
            let (year, month, of_month) = date(day);
            assert_eq!(days(year, month, of_month), day);
        }
    }

    #[test]
    fn start_times_are_read() {
        assert_eq!(parse("2000-01-01"), Some(YEAR_2000));
        assert_eq!(parse("2000-01-02 01:02:03"), Some(YEAR_2000 + SECONDS_PER_DAY + 3723));
        assert_eq!(
            parse("2026-11-21T23:59:59").map(|seconds| seconds.rem_euclid(SECONDS_PER_DAY)),
            Some(SECONDS_PER_DAY - 1)
        );
        for wrong in ["", "2000", "2023-02-29", "2000-13-01", "2000-01-01 24:00:00", "2000-01-01 1:2", "then"] {
            assert_eq!(parse(wrong), None, "{wrong}");
        }
    }
}
