//! Compares the results of a case that ran with the expected ones.

use super::case::Case;
use super::execute::Outcome;
use super::{Done, Verdict, bless, diff, expect};

/// Judges a case that ran; the results become the expected ones if that is requested.
pub(super) fn judged(case: &Case, outcome: &Outcome, bless: bool) -> Done {
    let verdict = match judge(case, outcome) {
        Err(problem) if bless => bless::run(case, outcome).map_err(|why| format!("{problem}\n{why}")),
        verdict => verdict,
    };
    Done { verdict, seconds: outcome.seconds, cycle_time: outcome.cycle_time }
}

/// Compares the results with the expected ones.
fn judge(case: &Case, outcome: &Outcome) -> Verdict {
    let mut problems = Vec::new();
    if case.is_new {
        problems.push("it has no expected results yet".to_string());
    }
    if outcome.late {
        let stderr = outcome.stderr.trim();
        let separator = if stderr.is_empty() { "" } else { ": " };
        problems.push(format!("it ran too long and was ended{separator}{stderr}"));
    }
    if let Some(expected) = &case.out
        && *expected != outcome.out
    {
        let difference = diff::diff(expected, &outcome.out);
        problems.push(format!("the output differs (- expected, + actual):\n{difference}"));
    }
    let stderr_suffix =
        || if outcome.stderr.trim().is_empty() { String::new() } else { format!("\n{}", outcome.stderr.trim_end()) };
    match (&case.alarm, outcome.code) {
        _ if outcome.late => {}
        (Some(expected), Some(3)) => match expect::find_alarm(&outcome.stderr) {
            Some((number, line)) => {
                if expected.number.is_some_and(|expected| expected != number) || expected.line != line {
                    let wanted = expected.number.map_or("*".to_string(), |number| number.to_string());
                    problems.push(format!(
                        "expected alarm {wanted} in line {}, found {number} in line {line}{}",
                        expected.line,
                        stderr_suffix()
                    ));
                }
            }
            None => problems.push(format!("an alarm was expected, but none was reported{}", stderr_suffix())),
        },
        (Some(_), _) => problems.push(format!("an alarm was expected, but it {}{}", ending(outcome), stderr_suffix())),
        (None, Some(0)) => {}
        (None, Some(4)) if case.options.max_time.is_some() => {}
        (None, _) => problems.push(format!("it {}{}", ending(outcome), stderr_suffix())),
    }
    if problems.is_empty() { Ok(()) } else { Err(problems.join("\n")) }
}

/// What a program reports that waits in vain.
const STANDSTILL: &str = "nothing can change any more";

fn ending(outcome: &Outcome) -> String {
    match outcome.code {
        Some(0) => "ended".into(),
        Some(3) => "ended with an alarm".into(),
        Some(4) if outcome.stderr.contains(STANDSTILL) => "waits for something that never happens".into(),
        Some(4) => "ran out of controller time".into(),
        Some(101) => "ended by a bug in arl2rs".into(),
        Some(code) => format!("ended with exit code {code}"),
        None => "was ended by a signal".into(),
    }
}

#[cfg(test)]
mod tests {
    use super::super::case::CaseOptions;
    use super::super::expect::ExpectedAlarm;
    use super::*;
    use std::path::Path;

    fn case() -> Case {
        Case {
            source: Path::new("/x/a.arl").into(),
            out: Some(b"1\n".to_vec()),
            errors: None,
            alarm: None,
            scenario: None,
            is_new: false,
            robot: None,
            cell: None,
            script_dir: None,
            engine: None,
            options: CaseOptions::default(),
        }
    }

    fn outcome(code: i32) -> Outcome {
        Outcome { out: b"1\n".to_vec(), code: Some(code), ..Outcome::default() }
    }

    #[test]
    fn output_and_exit_code_decide() {
        assert_eq!(judge(&case(), &outcome(0)), Ok(()));
        assert!(judge(&case(), &outcome(3)).unwrap_err().contains("ended with an alarm"));
        assert!(judge(&case(), &outcome(4)).unwrap_err().contains("out of controller time"));
        let other = Outcome { out: b"2\n".to_vec(), ..outcome(0) };
        assert!(judge(&case(), &other).unwrap_err().ends_with("-1\n+2\n"));
        let late = Outcome { code: None, late: true, ..outcome(0) };
        assert_eq!(judge(&case(), &late), Err("it ran too long and was ended".into()));
        let with_stderr = Outcome { stderr: "the program has been at a.arl:2\n".into(), ..late };
        let wanted = "it ran too long and was ended: the program has been at a.arl:2";
        assert_eq!(judge(&case(), &with_stderr), Err(wanted.into()));
    }

    #[test]
    fn a_case_with_a_limit_may_reach_it() {
        let mut case = case();
        case.options.max_time = Some(1.0);
        assert_eq!(judge(&case, &outcome(4)), Ok(()));
    }

    #[test]
    fn alarms_need_their_number_and_line() {
        let alarm = |number| Case { alarm: Some(ExpectedAlarm { number, line: 5 }), ..case() };
        let alarmed = |text: &str| Outcome { stderr: text.into(), ..outcome(3) };
        assert_eq!(judge(&alarm(Some(7)), &alarmed("alarm 7: x (a.arl:5)\n")), Ok(()));
        assert_eq!(judge(&alarm(None), &alarmed("alarm 8: x (a.arl:5)\n")), Ok(()));
        assert!(judge(&alarm(Some(7)), &alarmed("alarm 8: x (a.arl:5)\n")).is_err());
        assert!(judge(&alarm(None), &alarmed("alarm 8: x (a.arl:6)\n")).is_err());
        assert!(judge(&alarm(None), &outcome(0)).unwrap_err().contains("but it ended"));
    }
}
