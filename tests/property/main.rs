//! Properties of the compiler that hold for random programs.
//!
//! `ARL_PROPERTY_COUNT` multiplies the number of cases, `ARL_PROPERTY_SEED` moves on to others.

#![allow(clippy::disallowed_methods)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests stop where something is wrong")]

mod corpus;
mod expressions;
mod interrupts;
mod motions;
mod programs;
mod targets;

use arl_tests::engine;
use arl_tests::machine::{Machine, Stop};
use arl_tests::project::{Project, Run, compile};
use arl_tests::random::Random;
use arl_tests::tree::Program;
use arl_tests::write::write;
use arl2rs::CheckOptions;
use arl2rs::emit::Sizes;
use std::panic::catch_unwind;

/// Programs take turns: as they come, and in all forms that large programs have.
const FORMS: [Sizes; 2] = [Sizes::DEFAULT, Sizes::LEAST];

/// The command that runs code.
const BY_ENGINE: &str = env!("CARGO_BIN_EXE_by_engine");

fn number(name: &str, usual: u64) -> u64 {
    std::env::var(name).ok().and_then(|text| text.parse().ok()).unwrap_or(usual)
}

/// How many times the usual number of cases to try.
fn times() -> u64 {
    number("ARL_PROPERTY_COUNT", 1)
}

/// Where seeds begin.
fn first_seed() -> u64 {
    number("ARL_PROPERTY_SEED", 0) * 1_000_003
}

/// A program as ARL, and what it must do.
struct Case {
    seed: u64,
    files: Vec<(String, String)>,
    expected: Run,
}

impl Case {
    /// Writes a program and executes it; nothing where that takes too long.
    fn new(seed: u64, mut program: Program) -> Option<Case> {
        let files = write(&mut program, &mut Random::new(seed));
        let (out, end) = match Machine::new(&program, 3_000_000) {
            Ok(mut machine) => {
                let end = machine.main();
                (machine.out, end)
            }
            Err(stop) => (Vec::new(), Err(stop)),
        };
        let end = match end {
            Ok(()) | Err(Stop::Exit) => "ended".into(),
            Err(Stop::Alarm { number, module, line }) => format!("alarm {number} {} {line}", files[module].0),
            Err(Stop::Tired) => return None,
        };
        Some(Case { seed, files, expected: Run { out, end } })
    }

    fn text(&self) -> String {
        self.files.iter().map(|(name, text)| format!("==== {name}\n{text}")).collect()
    }
}

/// Runs all cases by the engine, compiles them together, and compares what they do.
fn compare(name: &str, cases: &[Case]) {
    let project = Project::new(env!("CARGO_TARGET_TMPDIR"), name);
    compare_by_engine(&project, cases);
    // The engine runs more of them in the time that rustc takes.
    let most = number("ARL_PROPERTY_COMPILED", u64::MAX);
    let cases = cases.get(..most as usize).unwrap_or(cases);
    let mut programs = Vec::new();
    let mut failures = Vec::new();
    for (case, sizes) in cases.iter().zip(FORMS.into_iter().cycle()) {
        match compile(&case.files, sizes) {
            Ok(rust) => programs.push(rust),
            Err(errors) => failures.push(format!("seed {}: refused\n{errors}{}", case.seed, case.text())),
        }
    }
    report(&project, failures);
    let command = match project.build(&programs) {
        Ok(command) => command,
        Err(errors) => {
            for (at, case) in cases.iter().enumerate() {
                if errors.contains(&format!("programs/p{at}.rs")) {
                    let path = project.folder().join(format!("p{at}.txt"));
                    std::fs::write(path, case.text()).unwrap();
                }
            }
            let errors: String = errors.lines().take(60).map(|line| format!("{line}\n")).collect();
            panic!("rustc refuses what was emitted, see {} and pN.txt there\n{errors}", project.folder().display());
        }
    };
    let runs = project.run(&command, cases.len());
    let failures = cases.iter().zip(runs).enumerate().filter(|(_, (case, run))| case.expected != *run);
    let failures = failures.map(|(at, (case, run))| {
        format!("seed {}, p{at}\n{}\n{}", case.seed, difference(&case.expected, &run), case.text())
    });
    report(&project, failures.collect());
}

/// Runs cases by the engine and compares what they do.
fn compare_by_engine(project: &Project, cases: &[Case]) {
    let failures = cases.iter().filter_map(|case| {
        let ran = catch_unwind(|| engine::lowered(&case.files, &CheckOptions::default()).map(engine::run));
        let problem = match ran {
            Ok(Ok(run)) if run == case.expected => return None,
            Ok(Ok(run)) => difference(&case.expected, &run),
            Ok(Err(errors)) => format!("refused\n{errors}"),
            Err(_) => "a panic".into(),
        };
        Some(format!("seed {}, by the engine\n{problem}\n{}", case.seed, case.text()))
    });
    report(project, failures.collect());
}

/// Fails with the first of the failures; all of them are in a file.
fn report(project: &Project, failures: Vec<String>) {
    let Some(first) = failures.first() else { return };
    let path = project.folder().join("failures.txt");
    std::fs::create_dir_all(project.folder()).unwrap();
    std::fs::write(&path, failures.join("\n\n########\n")).unwrap();
    let first: String = first.chars().take(1500).collect();
    panic!("{} failures, all in {}; the first:\n{first}", failures.len(), path.display());
}

/// Where two runs differ first.
fn difference(expected: &Run, found: &Run) -> String {
    let lines = |run: &Run| -> Vec<String> {
        run.out.split(|byte| *byte == b'\n').map(|line| String::from_utf8_lossy(line).into_owned()).collect()
    };
    let (a, b) = (lines(expected), lines(found));
    let at = a.iter().zip(&b).take_while(|(a, b)| a == b).count();
    let shown = |lines: &[String]| lines.get(at).cloned().unwrap_or_default();
    format!(
        "line {} of the output: expected {:?}, found {:?}; expected end: {}, found end: {}",
        at + 1,
        shown(&a),
        shown(&b),
        expected.end,
        found.end
    )
}
