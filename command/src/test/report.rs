//! Reports how the cases went.

use super::case::Found;
use super::{Done, Verdict};
use crate::args::TestFormat;
use arl_terminal::answer;
use arl_terminal::exit::Exit;
use arl_terminal::failure::Failure;
use arl_terminal::show;
use serde_json::json;
use std::fmt::Write;
use std::path::Path;

/// A case that was looked at, or could not be.
struct CaseReport<'a> {
    /// Its path, as short as possible from here.
    path: &'a Path,
    verdict: &'a Verdict,
    seconds: f64,
    cycle_time: Option<f64>,
}

/// Reports how the cases went; fails if one failed.
pub(super) fn report(found: &[Found], done: &[Done], format: TestFormat) -> Result<Exit, Failure> {
    let reports: Vec<CaseReport<'_>> = found
        .iter()
        .zip(done)
        .map(|(found, done)| CaseReport {
            path: show::path(&found.source),
            verdict: &done.verdict,
            seconds: done.seconds,
            cycle_time: done.cycle_time,
        })
        .collect();
    let failed = reports.iter().filter(|case| case.verdict.is_err()).count();
    match format {
        TestFormat::Human => human(&reports, failed)?,
        TestFormat::Jsonl => reports.iter().try_for_each(|case| answer::write(&format!("{}\n", object(case))))?,
        TestFormat::Junit => answer::write(&junit(&reports, failed))?,
    }
    Ok(if failed == 0 { Exit::SUCCESS } else { Exit::FAILURE })
}

/// The failures, then the counts.
fn human(reports: &[CaseReport<'_>], failed: usize) -> Result<(), Failure> {
    for CaseReport { path, verdict, .. } in reports {
        if let Err(problem) = verdict {
            answer::write_coloured(&format!("FAILED {}\n{}\n\n", path.display(), indented(problem)))?;
        }
    }
    answer::write_coloured(&format!("{} passed, {failed} failed\n", reports.len() - failed))
}

fn indented(text: &str) -> String {
    text.lines().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}

fn object(case: &CaseReport<'_>) -> serde_json::Value {
    json!({
        "name": case.path.display().to_string(),
        "outcome": if case.verdict.is_ok() { "passed" } else { "failed" },
        "seconds": case.seconds,
        "cycle_time": case.cycle_time,
        "detail": case.verdict.as_ref().err(),
    })
}

/// The XML of JUnit, which test tools read: a suite, a case for each program.
fn junit(reports: &[CaseReport<'_>], failed: usize) -> String {
    let time = reports.iter().map(|case| case.seconds).fold(0.0, |sum, seconds| sum + seconds);
    let mut text = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let _ = writeln!(
        text,
        "<testsuite name=\"arl2rs\" tests=\"{}\" failures=\"{failed}\" errors=\"0\" time=\"{time:.3}\">",
        reports.len()
    );
    for CaseReport { path, verdict, seconds, .. } in reports {
        let folder = escaped(&path.parent().unwrap_or(Path::new("")).display().to_string());
        let name = escaped(&path.file_stem().unwrap_or_default().to_string_lossy());
        let _ = write!(text, "  <testcase classname=\"{folder}\" name=\"{name}\" time=\"{seconds:.3}\"");
        match verdict {
            Ok(()) => text.push_str("/>\n"),
            Err(problem) => {
                let first = escaped(problem.lines().next().unwrap_or_default());
                let _ = writeln!(text, ">\n    <failure message=\"{first}\">{}</failure>", escaped(problem));
                text.push_str("  </testcase>\n");
            }
        }
    }
    text + "</testsuite>\n"
}

/// A text in the form of XML; characters that XML cannot hold are left out.
fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\n' | '\t' => out.push(letter),
            letter if letter.is_control() || matches!(letter, '\u{fffe}' | '\u{ffff}') => {}
            letter => out.push(letter),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn xml_contains_what_came() {
        let wrong = Err("other <output>:\n-\"a\"\n+\u{1b}b & c".to_owned());
        let report_of =
            |verdict| CaseReport { path: Path::new("tests/a b.arl"), verdict, seconds: 0.5, cycle_time: None };
        let text = junit(&[report_of(&Ok(())), report_of(&wrong)], 1);
        assert!(text.contains("tests=\"2\" failures=\"1\" errors=\"0\" time=\"1.000\""), "{text}");
        assert!(text.contains("<testcase classname=\"tests\" name=\"a b\" time=\"0.500\"/>"), "{text}");
        let failure =
            "<failure message=\"other &lt;output&gt;:\">other &lt;output&gt;:\n-&quot;a&quot;\n+b &amp; c</failure>";
        assert!(text.contains(failure), "{text}");
    }
}
