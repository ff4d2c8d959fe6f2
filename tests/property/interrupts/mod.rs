//! Random programs of interrupts and timers do what a small model of the rules says: every note in the same order and
//! cycle.

mod model;
mod plan;

use crate::{BY_ENGINE, FORMS, Run, difference, first_seed, report, times};
use arl_tests::engine;
use arl_tests::project::{Project, compile};
use arl_tests::random::Random;
use arl2rs::CheckOptions;
use model::{End, Model};
use plan::Plan;
use std::path::Path;
use std::process::Command;

/// So many cycles a program may take.
const MOST: u64 = 5_000;

struct Case {
    seed: u64,
    text: String,
    scenario: String,
    expected: Run,
}

impl Case {
    /// A program that comes to its end.
    fn new(seed: u64) -> Option<Case> {
        let plan = Plan::grow(&mut Random::new(seed));
        let (text, lines) = plan.text();
        let mut model = Model::new(&plan);
        let end = match model.run(MOST)? {
            End::Ended => "ended".to_string(),
            End::Alarm { script, step } => format!("alarm 20004 main.arl:{}", lines[script][step]),
        };
        Some(Case { seed, text, scenario: plan.scenario(), expected: Run { out: model.out.into_bytes(), end } })
    }

    /// The command that runs the program by the engine.
    fn by_engine(&self, project: &Project) -> Command {
        let file = project.folder().join(format!("{}.code", self.seed));
        let files = [("main.arl".into(), self.text.clone())];
        engine::write(engine::lowered(&files, &CheckOptions::default()).unwrap(), &file);
        engine::command(Path::new(BY_ENGINE), &file, project.folder())
    }

    /// Runs the program by a command that was made for it, with what happens meanwhile.
    fn run(&self, project: &Project, mut run: Command) -> Run {
        let file = |ending: &str| project.folder().join(format!("{}.{ending}", self.seed));
        std::fs::write(file("io.toml"), &self.scenario).unwrap();
        std::fs::write(file("arl"), &self.text).unwrap();
        let output = run.arg("--io").arg(file("io.toml")).args(["--max-time", "60"]).output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        let end = match output.status.code() {
            Some(0) => "ended".to_string(),
            Some(3) => {
                // Below the alarm stand the calls that led there.
                let alarm = stderr.lines().find(|line| line.starts_with("alarm ")).unwrap_or_default();
                let (number, rest) = alarm.split_once(": ").unwrap_or((alarm, ""));
                let place = rest.rsplit_once('(').map_or("", |(_, place)| place.trim_end().trim_end_matches(')'));
                format!("{number} {place}")
            }
            other => format!("{other:?} {stderr}"),
        };
        Run { out: output.stdout, end }
    }
}

#[test]
fn interrupts_do_what_the_rules_say() {
    let mut cases = Vec::new();
    let mut seed = first_seed();
    while cases.len() < 60 * times() as usize {
        seed += 1;
        cases.extend(Case::new(seed));
    }
    assert_variety(&cases);
    let project = Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-property-interrupts");
    let mut programs = Vec::new();
    let mut failures = Vec::new();
    for (case, sizes) in cases.iter().zip(FORMS.into_iter().cycle()) {
        match compile(&[("main.arl".into(), case.text.clone())], sizes) {
            Ok(rust) => programs.push(rust),
            Err(errors) => failures.push(format!("seed {}: refused\n{errors}{}", case.seed, case.text)),
        }
    }
    report(&project, failures);
    let command = project.build_choosing(&programs).unwrap_or_else(|errors| panic!("{errors}"));
    let mut failures = Vec::new();
    for (at, case) in cases.iter().enumerate() {
        for (what, run) in [("compiled", project.choose(&command, at)), ("by the engine", case.by_engine(&project))] {
            let run = case.run(&project, run);
            if run != case.expected {
                let difference = difference(&case.expected, &run);
                failures.push(format!("seed {}, {what}\n{difference}\n{}", case.seed, case.text));
            }
        }
    }
    report(&project, failures);
}

/// The programs do something: most handle events, some end in alarms.
fn assert_variety(cases: &[Case]) {
    let notes = |case: &Case| case.expected.out.iter().filter(|byte| **byte == b'\n').count();
    let busy = cases.iter().filter(|case| notes(case) > 20).count();
    let alarms = cases.iter().filter(|case| case.expected.end != "ended").count();
    assert!(busy * 5 > cases.len() && alarms > 0 && alarms * 3 < cases.len(), "{busy} busy ones, {alarms} alarms");
}
