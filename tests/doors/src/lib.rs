//! Runs conformance cases inside the process, as Rust programs that embed ARL do.

use arl_rt::io::{Override, Scenario};
use arl_rt::program::{Make, Other};
use arl_rt::values::Controlmode;
use arl_rt::{Captured, Controller, Outcome, Robot};
use std::num::NonZero;
use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

/// How to make a program, its ARL file, the lines above its text in the file that rustc read, and the programs that its
/// cell names.
pub type Entry = (Make, &'static str, u32, &'static [Other]);

/// Controller seconds after which a case without a limit of its own is given up.
const LONGEST: f64 = 3600.0;
/// Bytes of stack for the program's functions, as compiled programs have them.
const STACK: usize = 64 << 20;

/// Runs all cases, on all processors; the failures, as text.
pub fn run_all(cases: &'static [Entry]) -> Vec<String> {
    let next = Arc::new(AtomicUsize::new(0));
    let workers = std::thread::available_parallelism().map_or(1, NonZero::get);
    let spawn = |worker: usize| {
        let next = next.clone();
        let cases = std::iter::from_fn(move || cases.get(next.fetch_add(1, Ordering::Relaxed)));
        let failures = move || {
            let scratch = std::env::temp_dir().join(format!("door-tests-{}-{worker}", std::process::id()));
            let failure = |case: &Entry| Some(format!("{}: {}", case.1, run(case, &scratch).err()?));
            cases.filter_map(failure).collect()
        };
        std::thread::Builder::new().stack_size(STACK + (8 << 20)).spawn(failures)
    };
    let workers: Vec<_> = (0..workers).map(spawn).collect();
    let failures = workers.into_iter().map(|worker| match worker.map(std::thread::JoinHandle::join) {
        Ok(Ok(failures)) => failures,
        _ => vec!["a thread of the cases ended early".into()],
    });
    failures.flatten().collect()
}

fn run((make, source, lines_above, others): &Entry, scratch: &Path) -> Result<(), String> {
    let source = Path::new(source);
    let text = |error: &dyn std::fmt::Display| error.to_string();
    let options = std::fs::read_to_string(source.with_extension("toml")).unwrap_or_default();
    let options: toml::Table = toml::from_str(&options).map_err(|error| text(&error))?;
    let word = |key: &str| options.get(key).and_then(toml::Value::as_str);
    let number =
        |key: &str| options.get(key).and_then(|value| value.as_float().or(value.as_integer().map(|n| n as f64)));

    prepare(source, scratch).map_err(|error| text(&error))?;
    let messages = Captured::new();
    let mut builder = Controller::builder().output(messages.clone()).script_dir(scratch).stack(STACK);
    if let Some(robot) = word("robot") {
        let file = source.with_file_name(robot);
        let robot = if file.is_file() { file.display().to_string() } else { robot.to_string() };
        builder = builder.robot(Robot::load(&robot).map_err(|error| text(&error))?);
    }
    if let Some(cell) = word("cell") {
        let cell = arl_rt::cell::Cell::load(&source.with_file_name(cell)).map_err(|error| text(&error))?;
        builder = builder.cell_with(cell, others).map_err(|error| text(&error))?;
    }
    let scenario = source.with_extension("io.toml");
    if scenario.is_file() {
        builder = builder.scenario(Scenario::load(&scenario).map_err(|error| text(&error))?);
    }
    builder = match word("mode") {
        Some("manual") => builder.mode(Controlmode::Manual),
        Some("manufast") => builder.mode(Controlmode::Manufast),
        _ => builder,
    };
    if let Some(percent) = number("override") {
        builder = builder.speed_override(Override::from_percent(percent).map_err(|error| text(&error))?);
    }
    let mut controller = builder.build(make()).map_err(|error| text(&error))?;
    controller.set_loop(options.get("loop").and_then(toml::Value::as_bool).unwrap_or_default());
    controller.run_for(number("max_time").unwrap_or(LONGEST));
    let outcome = controller.outcome().cloned();
    let cleaned = std::fs::remove_dir_all(scratch);

    if let Ok(expected) = std::fs::read_to_string(source.with_extension("out"))
        && expected != messages.text()
    {
        return Err(format!("printed {:?} instead of {expected:?}", messages.text()));
    }
    match (std::fs::read_to_string(source.with_extension("alarm")).ok(), outcome) {
        (Some(expected), Some(Outcome::Alarm(alarm))) => {
            let (wanted, line) = expected.trim().split_once(' ').unwrap_or_default();
            let came = (alarm.fault.number().to_string(), (alarm.line - lines_above).to_string());
            let same = (wanted == "*" || wanted == came.0) && line == came.1;
            if same { Ok(()) } else { Err(format!("alarm {} {} instead of {}", came.0, came.1, expected.trim())) }
        }
        (None, Some(Outcome::Ended)) => Ok(()),
        (None, None) if number("max_time").is_some() => Ok(()),
        (_, outcome) => Err(format!("ended with {outcome:?}")),
    }
    .and_then(|()| cleaned.map_err(|error| text(&error)))
}

/// A script directory with the files that lie beside the case, without programs and sidecars.
fn prepare(source: &Path, scratch: &Path) -> std::io::Result<()> {
    std::fs::create_dir_all(scratch)?;
    let Some(folder) = source.parent() else { return Ok(()) };
    copy(folder, scratch)?;
    // What stands for the USB store (`gettextstr`).
    if folder.join("USB").is_dir() {
        std::fs::create_dir_all(scratch.join("USB"))?;
        copy(&folder.join("USB"), &scratch.join("USB"))?;
    }
    Ok(())
}

fn copy(folder: &Path, scratch: &Path) -> std::io::Result<()> {
    for entry in std::fs::read_dir(folder)? {
        let path = entry?.path();
        let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
        // Programs write points into their data files.
        let data = path.file_stem().is_some_and(|stem| stem.to_string_lossy().ends_with("_data"));
        if path.is_file() && (data || !["arl", "out", "err", "alarm", "toml"].contains(&ending.as_str())) {
            std::fs::copy(&path, scratch.join(path.file_name().unwrap_or_default()))?;
        }
    }
    Ok(())
}
