//! The conformance cases through the command: a test for each folder of `tests/conformance`, and for the example that a
//! PLC works.
//!
//! The first test that runs lets the command compile and run the cases of all folders together, as that is much sooner
//! done than one folder after the other. `cargo run -p arl2rs-cli -- test tests/conformance/FOLDER` does it for one
//! folder alone.
#![allow(clippy::expect_used, reason = "tests start processes, and may fail")]

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::LazyLock;

const CORPUS: &str = "tests/conformance";
const EXAMPLE: &str = "examples/plc_cell";

macro_rules! folders {
    ($($folder:ident)*) => {
        /// The folders of the corpus.
        const FOLDERS: &[&str] = &[$(stringify!($folder)),*];
        $(
            #[test]
            fn $folder() {
                assert_passed(&format!("{CORPUS}/{}", stringify!($folder)));
            }
        )*
    };
}

folders! {
    arguments arrays bits buses calibration channels clocks compensation constants control conversions convert
    enums external functions interrupts io load math modules motion operators other pendant points pose print
    progress scan scara scopes serial sockets standstill stops strings structures system text timers triggers types
    waits weave
}

#[test]
fn plc_cell() {
    assert_passed(EXAMPLE);
}

#[test]
fn every_folder_has_a_test() {
    let corpus = workspace().join(CORPUS);
    let entries: Vec<PathBuf> =
        std::fs::read_dir(corpus).expect("the corpus").map(|entry| entry.expect("an entry").path()).collect();
    let name = |path: &PathBuf| path.file_name().map(|name| name.to_string_lossy().into_owned());
    let folders: BTreeSet<String> = entries.iter().filter(|path| path.is_dir()).filter_map(name).collect();
    assert_eq!(folders, FOLDERS.iter().map(ToString::to_string).collect(), "the list of folders in this file");
    let stray: Vec<String> = entries.iter().filter(|path| is_case(path)).filter_map(name).collect();
    assert!(stray.is_empty(), "cases lie in folders: {stray:?}");
}

#[test]
fn every_case_was_looked_at() {
    let cases = count_cases(&workspace().join(CORPUS)) + count_cases(&workspace().join(EXAMPLE));
    assert!(cases > 500, "the corpus is there: {cases} cases");
    assert_eq!(RUN.looked_at, Some(cases), "{}", RUN.output_text);
}

#[test]
fn all_cases_in_the_forms_of_large_programs() {
    // Not at the same time: some cases use ports of their own.
    let usual = LazyLock::force(&RUN);
    let all_forms = run(&["--all-forms"]);
    assert_eq!(all_forms.looked_at, usual.looked_at, "{}", all_forms.output_text);
    let failures: Vec<String> = all_forms.failures.iter().map(|(path, why)| format!("{path}\n{why}\n")).collect();
    assert!(failures.is_empty(), "{} of the cases failed\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn the_engine_does_the_same() {
    let usual = LazyLock::force(&RUN);
    let engine = run_keeping(&["--engine", "engine"], "engine");
    assert_eq!(engine.looked_at, usual.looked_at, "{}", engine.output_text);
    // A case that only calculates for a minute may not come to its end where the engine is not optimised.
    let different = engine.failures.iter().filter(|(_, why)| !why.contains("it ran too long"));
    let failures: Vec<String> = different.map(|(path, why)| format!("{path}\n{why}\n")).collect();
    assert!(failures.is_empty(), "{} of the cases failed\n{}", failures.len(), failures.join("\n"));
    let outside: Vec<String> =
        OUTSIDE.iter().flat_map(|folder| stems(&workspace().join(CORPUS).join(folder))).collect();
    // What came to no end in time left nothing.
    let late: Vec<&str> =
        engine.failures.iter().filter_map(|(path, _)| Path::new(path).file_stem()?.to_str()).collect();
    let is_compared = |name: &str| {
        let is_of = |stem: &str| name.strip_prefix("case_").is_some_and(|name| name.starts_with(&format!("{stem}_")));
        !outside.iter().any(|stem| is_of(stem)) && !late.iter().any(|stem| is_of(stem))
    };
    // Output, alarms, traces, lengths, stored variables: to the last byte.
    let (native, engine) = (kept("native"), kept("engine"));
    let names = |folder: &Path| -> BTreeSet<String> {
        let entries = std::fs::read_dir(folder).expect("what was kept").map(|entry| entry.expect("an entry"));
        let names = entries.map(|entry| entry.file_name().to_string_lossy().into_owned());
        names.filter(|name| is_compared(name)).collect()
    };
    let all = names(&native);
    assert!(all.len() > 5000, "much was kept: {} files", all.len());
    let others = names(&engine);
    let missing: Vec<_> = all.symmetric_difference(&others).collect();
    assert!(missing.is_empty(), "only one engine left {missing:?}");
    let differences: Vec<String> = all.iter().filter_map(|name| difference(name, &native, &engine)).collect();
    assert!(differences.is_empty(), "{} files differ\n{}", differences.len(), differences.join("\n"));
}

/// The folders whose cases talk to the outside, which takes time as it likes.
const OUTSIDE: [&str; 3] = ["buses", "serial", "sockets"];

/// The names of the cases in a folder, as far as all names of kept files have them.
fn stems(folder: &Path) -> Vec<String> {
    let entries =
        std::fs::read_dir(folder).expect("a folder of the corpus").map(|entry| entry.expect("an entry").path());
    let stem = |path: PathBuf| path.file_stem().map(|stem| stem.to_string_lossy().to_ascii_lowercase());
    entries.filter(|path| is_case(path)).filter_map(stem).collect()
}

/// Where a file of one folder differs from that of another.
fn difference(name: &str, one: &Path, other: &Path) -> Option<String> {
    let read = |folder: &Path| std::fs::read(folder.join(name)).expect("what was kept");
    let (one, other) = (read(one), read(other));
    if one == other {
        return None;
    }
    let at = one.iter().zip(&other).take_while(|(one, other)| one == other).count();
    let line = |bytes: &[u8]| {
        let start = bytes.iter().take(at).rposition(|byte| *byte == b'\n').map_or(0, |feed| feed + 1);
        let line = bytes.get(start..).unwrap_or_default().split(|byte| *byte == b'\n').next().unwrap_or_default();
        String::from_utf8_lossy(line).into_owned()
    };
    Some(format!("{name}, byte {at}\n  native: {}\n  engine: {}", line(&one), line(&other)))
}

/// The folder for what the runs of an engine leave.
fn kept(engine: &str) -> PathBuf {
    Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("conformance-{engine}"))
}

/// Runs all cases, and keeps what they leave.
fn run_keeping(options: &[&str], engine: &str) -> Run {
    let folder = kept(engine);
    // What another run left must not count.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).expect("a folder");
    let folder = folder.to_string_lossy();
    run(&[options, &["--keep", &folder]].concat())
}

/// The folders whose cases are run as for a debugger, too: those in which functions, loops and events meet.
const FOR_A_DEBUGGER: [&str; 8] =
    ["arrays", "clocks", "control", "enums", "functions", "interrupts", "scopes", "triggers"];

#[test]
fn programs_for_a_debugger_do_the_same() {
    LazyLock::force(&RUN);
    let folders = FOR_A_DEBUGGER.map(|folder| format!("{CORPUS}/{folder}"));
    let cases: usize = folders.iter().map(|folder| count_cases(&workspace().join(folder))).sum();
    let run = run_folders(&folders.each_ref().map(String::as_str), &["--debug"]);
    assert_eq!(run.looked_at, Some(cases), "{}", run.output_text);
    let failures: Vec<String> = run.failures.iter().map(|(path, why)| format!("{path}\n{why}\n")).collect();
    assert!(failures.is_empty(), "{} of the cases failed\n{}", failures.len(), failures.join("\n"));
}

/// What the command said of all cases.
struct Run {
    /// How many cases it tells of; nothing where it came to no end.
    looked_at: Option<usize>,
    /// The cases that failed: their paths, and why.
    failures: Vec<(String, String)>,
    /// All that it said.
    output_text: String,
}

static RUN: LazyLock<Run> = LazyLock::new(|| run_keeping(&["--engine", "native"], "native"));

/// Runs all cases, with these options.
fn run(options: &[&str]) -> Run {
    run_folders(&[CORPUS, EXAMPLE], options)
}

/// Runs the cases of these folders.
fn run_folders(folders: &[&str], options: &[&str]) -> Run {
    let output = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
        .arg("test")
        .args(folders)
        .args(options)
        .current_dir(workspace())
        .env("ARL2RS_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"))
        .env("NO_COLOR", "1")
        .output()
        .expect("the command starts");
    let out = String::from_utf8_lossy(&output.stdout);
    let output_text = format!("{out}{}", String::from_utf8_lossy(&output.stderr));
    // All that is said of a case stands indented below its line.
    let failures = format!("\n{out}");
    let failures = failures.split("\nFAILED ").skip(1).filter_map(|failure| failure.split_once('\n'));
    let failures: Vec<_> = failures.map(|(path, why)| (path.to_string(), why.trim_end().to_string())).collect();
    let looked_at = looked_at(out.lines().last().unwrap_or_default(), failures.len());
    // The exit code agrees with what is told.
    let looked_at = looked_at.filter(|_| output.status.success() == failures.is_empty());
    Run { looked_at, failures, output_text }
}

/// How many cases there were, from the last line: `N passed, N failed`.
fn looked_at(summary: &str, failures: usize) -> Option<usize> {
    let (passed, failed) = summary.strip_suffix(" failed")?.split_once(" passed, ")?;
    let (passed, failed) = (passed.parse::<usize>().ok()?, failed.parse::<usize>().ok()?);
    (failed == failures).then_some(passed + failed)
}

/// Fails where a case of a folder did.
#[track_caller]
fn assert_passed(folder: &str) {
    assert!(RUN.looked_at.is_some(), "the command came to no end:\n{}", RUN.output_text);
    let failures = RUN.failures.iter().filter(|(path, _)| Path::new(path).starts_with(folder));
    let failures: Vec<String> = failures.map(|(path, why)| format!("{path}\n{why}\n")).collect();
    assert!(failures.is_empty(), "{} of the cases failed\n{}", failures.len(), failures.join("\n"));
}

fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace")
}

/// A program beside which stands what is expected of it.
fn is_case(path: &Path) -> bool {
    let expected = |ending: &&str| path.with_extension(ending).is_file();
    path.extension().is_some_and(|ending| ending == "arl") && ["out", "err", "alarm"].iter().any(expected)
}

/// The cases below a folder.
fn count_cases(folder: &Path) -> usize {
    let entries = std::fs::read_dir(folder).expect("a folder of the corpus");
    let count = |path: PathBuf| if path.is_dir() { count_cases(&path) } else { usize::from(is_case(&path)) };
    entries.map(|entry| count(entry.expect("an entry").path())).sum()
}
