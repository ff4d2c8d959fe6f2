//! What sidecars expect, and whether it was found.

/// A line of NAME.err.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct ExpectedError {
    pub(super) line: u32,
    /// Looked for in message and help, without regard to case.
    pub(super) fragment: String,
}

impl ExpectedError {
    /// Whether an error is the expected one.
    pub(super) fn fits(&self, error: &FoundError) -> bool {
        error.line == self.line && error.text.to_lowercase().contains(&self.fragment.to_lowercase())
    }
}

/// An error that was found.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) struct FoundError {
    pub(super) line: u32,
    /// Message and help.
    pub(super) text: String,
}

/// NAME.alarm
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct ExpectedAlarm {
    /// `None`: any number.
    pub(super) number: Option<u32>,
    pub(super) line: u32,
}

/// Reads `LINE text-fragment` lines.
pub(super) fn parse_errors(text: &str) -> Result<Vec<ExpectedError>, String> {
    let mut expected = Vec::new();
    for (at, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let (number, fragment) = line.trim().split_once(char::is_whitespace).unwrap_or((line.trim(), ""));
        let line = number
            .parse()
            .map_err(|_| format!("{}: expected a line number and a part of the message, found `{number}`", at + 1))?;
        expected.push(ExpectedError { line, fragment: fragment.trim().to_string() });
    }
    if expected.is_empty() {
        return Err("1: expected at least one error: a line number and a part of the message".into());
    }
    Ok(expected)
}

/// Reads `NUMBER LINE`.
pub(super) fn parse_alarm(text: &str) -> Result<ExpectedAlarm, String> {
    let words: Vec<&str> = text.split_whitespace().collect();
    let expected = match words.as_slice() {
        ["*", line] => line.parse().ok().map(|line| ExpectedAlarm { number: None, line }),
        [number, line] => match (number.parse(), line.parse()) {
            (Ok(number), Ok(line)) => Some(ExpectedAlarm { number: Some(number), line }),
            _ => None,
        },
        _ => None,
    };
    expected.ok_or_else(|| format!("1: expected NUMBER LINE, where NUMBER may be *, found `{}`", text.trim()))
}

/// The difference between the errors that were expected and those that were found; `None` if there is none.
pub(super) fn compare_errors(expected: &[ExpectedError], found: &[FoundError]) -> Option<String> {
    let mut unmatched: Vec<&FoundError> = found.iter().collect();
    let mut missing = Vec::new();
    // The pickiest first, so that a short fragment does not take what only a long one fits.
    let mut order: Vec<&ExpectedError> = expected.iter().collect();
    order.sort_by_key(|error| std::cmp::Reverse(error.fragment.len()));
    for want in order {
        match unmatched.iter().position(|error| want.fits(error)) {
            Some(at) => {
                unmatched.remove(at);
            }
            None => missing.push(want),
        }
    }
    if unmatched.is_empty() && missing.is_empty() {
        return None;
    }
    missing.sort_by_key(|error| error.line);
    let missing = missing.iter().map(|error| format!("-{} {}", error.line, error.fragment).trim_end().to_string());
    let surplus = unmatched.iter().map(|error| format!("+{} {}", error.line, error.text));
    Some(missing.chain(surplus).collect::<Vec<_>>().join("\n"))
}

/// Number and line of the alarm in what a program wrote to standard error: `alarm 10064: text (file.arl:12)`.
pub(super) fn find_alarm(stderr: &str) -> Option<(u32, u32)> {
    stderr.lines().find_map(|line| {
        let (number, rest) = line.strip_prefix("alarm ")?.split_once(':')?;
        let (_, place) = rest.rsplit_once(" (")?;
        let (_, line) = place.strip_suffix(')')?.rsplit_once(':')?;
        // The channel follows the line if there are several.
        let line = line.split(',').next()?;
        Some((number.parse().ok()?, line.parse().ok()?))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(line: u32, text: &str) -> FoundError {
        FoundError { line, text: text.into() }
    }

    #[test]
    fn errors_match_by_line_and_fragment() {
        let expected = parse_errors("3 unknown NAME\n3\n\n7\n").expect("good");
        let all = [found(3, "other"), found(3, "an Unknown name `x`"), found(7, "x")];
        assert_eq!(compare_errors(&expected, &all), None);
        let fewer = compare_errors(&expected, &all[..2]).expect("one is missing");
        assert_eq!(fewer, "-7");
        let wrong = compare_errors(&expected, &[found(3, "a"), found(3, "b"), found(8, "c")]).expect("wrong");
        assert_eq!(wrong, "-3 unknown NAME\n-7\n+3 b\n+8 c");
    }

    #[test]
    fn sidecars_that_say_nothing_are_refused() {
        assert!(parse_errors("").is_err());
        assert!(parse_errors("line 3").unwrap_err().starts_with("1: "));
        assert!(parse_alarm("20001").is_err());
        assert!(parse_alarm("20001 *").is_err());
    }

    #[test]
    fn alarms_are_found_in_stderr() {
        assert_eq!(parse_alarm("* 12\n"), Ok(ExpectedAlarm { number: None, line: 12 }));
        assert_eq!(parse_alarm("10064 12"), Ok(ExpectedAlarm { number: Some(10064), line: 12 }));
        let stderr = "warning: x\nalarm 10064: the file \"a (b)\": no (dir/file.arl:12)\n";
        assert_eq!(find_alarm(stderr), Some((10064, 12)));
        assert_eq!(find_alarm("alarm: none"), None);
    }
}
