//! One case, run as a process of its own.

use super::batch::{CASE, Compiled};
use super::case::Case;
use arl_lang::files::is_data;
use arl_project::program::{WHILE_INPUT, command_of_code};
use std::ffi::OsString;
use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

/// Seconds of real time that a case may take.
const LONGEST: u64 = 60;
/// Controller seconds after which a case without a limit of its own is stopped.
const CONTROLLER_SECONDS: f64 = 3600.0;
/// Bytes of output that are kept.
const MOST_OUTPUT: u64 = 32 << 20;

/// The outcome of a case.
#[derive(Default, Debug)]
pub(super) struct Outcome {
    pub(super) out: Vec<u8>,
    /// Standard error.
    pub(super) stderr: String,
    /// The exit code; `None` where a signal or the time limit ended it.
    pub(super) code: Option<i32>,
    /// Whether it had to be ended.
    pub(super) late: bool,
    /// How long it took, s.
    pub(super) seconds: f64,
    /// Controller seconds, if it came to an end.
    pub(super) cycle_time: Option<f64>,
    /// How often its statements ran, if they were counted.
    pub(super) counted: String,
}

/// The folder below the script directory that stands for the USB store.
const USB: &str = "USB";

/// What is wanted of the runs besides their outcome.
#[derive(Clone, Copy, Default)]
pub(super) struct Extras<'a> {
    /// How often the statements ran.
    pub(super) counts: bool,
    /// All that a run leaves, its trace included, in this folder: for a comparison of engines.
    pub(super) keep: Option<&'a Path>,
}

/// Controller seconds up to which the trace of a case is kept.
const LONGEST_TRACE: f64 = 10.0;

/// Runs a case in a folder of its own, so that its files do not meet those of other cases.
pub(super) fn execute(
    case: &Case,
    compiled: &Compiled,
    scratch: &Path,
    extras: Extras<'_>,
) -> std::io::Result<Outcome> {
    let folder = scratch.join(&compiled.name);
    let outcome = run_in(&folder, case, compiled, extras.counts, None);
    if let (Some(keep), Ok(outcome)) = (extras.keep, &outcome)
        && outcome.cycle_time.is_some_and(|time| time <= LONGEST_TRACE)
    {
        std::fs::remove_dir_all(&folder)?;
        let trace = keep.join(format!("{}.csv", compiled.name));
        let outcome = run_in(&folder, case, compiled, false, Some(&trace))?;
        keep_all(keep, &compiled.name, &outcome, &folder)?;
    }
    // Files left in a scratch folder do no harm.
    let _ = std::fs::remove_dir_all(&folder);
    outcome
}

/// Keeps what a run printed, its exit code, its length, and the variables that it stored.
fn keep_all(keep: &Path, name: &str, outcome: &Outcome, folder: &Path) -> std::io::Result<()> {
    let of = |ending: &str| keep.join(format!("{name}.{ending}"));
    std::fs::write(of("out"), &outcome.out)?;
    // The folder is another one in each run.
    std::fs::write(of("stderr"), outcome.stderr.replace(&*folder.to_string_lossy(), "FOLDER"))?;
    std::fs::write(of("code"), format!("{:?} {:?}", outcome.code, outcome.cycle_time))?;
    let Ok(entries) = std::fs::read_dir(folder.join("state")) else { return Ok(()) };
    for entry in entries.filter_map(Result::ok).filter(|entry| entry.path().is_file()) {
        std::fs::copy(entry.path(), of(&entry.file_name().to_string_lossy()))?;
    }
    Ok(())
}

/// Runs a case in this folder.
fn run_in(
    folder: &Path,
    case: &Case,
    compiled: &Compiled,
    counts: bool,
    trace: Option<&Path>,
) -> std::io::Result<Outcome> {
    let script = folder.join("script");
    std::fs::create_dir_all(&script)?;
    if let Some(beside) = case.source.parent() {
        copy_files(beside, &script)?;
        // The folder that stands for the USB store (`gettextstr`).
        if beside.join(USB).is_dir() {
            std::fs::create_dir_all(script.join(USB))?;
            copy_files(&beside.join(USB), &script.join(USB))?;
        }
    }
    let mut command = match &compiled.code {
        Some(code) => command_of_code(code).map_err(|failure| std::io::Error::other(failure.to_string()))?,
        None => Command::new(&compiled.program),
    };
    command.env(CASE, &compiled.name).args(arguments(case));
    command.arg("--script-dir").arg(&script).arg("--state-dir").arg(folder.join("state"));
    // The input is held open as long as the case may run: it ends where this command is killed.
    command.env(WHILE_INPUT, "1").stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
    let (time, counted) = (folder.join("cycle_time"), folder.join("coverage"));
    command.arg("--cycle-time").arg(&time);
    if let Some(trace) = trace {
        command.arg("--trace").arg(trace);
    }
    if counts {
        command.arg("--coverage").arg(&counted);
    }
    let read = |path: &Path| std::fs::read_to_string(path).unwrap_or_default();
    watch(command.spawn()?).map(|outcome| Outcome {
        cycle_time: read(&time).trim().parse().ok(),
        counted: read(&counted),
        ..outcome
    })
}

/// The options of a run, from the case's sidecars.
fn arguments(case: &Case) -> Vec<OsString> {
    let options = &case.options;
    let mut arguments: Vec<OsString> = Vec::new();
    let mut add = |name: &str, value: OsString| arguments.extend([name.into(), value]);
    if let Some(robot) = &case.robot {
        add("--robot", robot.into());
    }
    if let Some(cell) = &case.cell {
        add("--cell", cell.into());
    }
    if let Some(scenario) = &case.scenario {
        add("--io", scenario.into());
    }
    if let Some(mode) = &options.mode {
        add("--mode", mode.into());
    }
    if let Some(percent) = options.override_percent {
        add("--override", percent.to_string().into());
    }
    if options.repeats {
        arguments.push("--loop".into());
    }
    let mut add = |name: &str, value: OsString| arguments.extend([name.into(), value]);
    add("--max-time", options.max_time.unwrap_or(CONTROLLER_SECONDS).to_string().into());
    arguments
}

/// Copies what programs may read: data files, and all files except programs and sidecars.
fn copy_files(from: &Path, to: &Path) -> std::io::Result<()> {
    const OURS: [&str; 5] = ["arl", "out", "err", "alarm", "toml"];
    let files = std::fs::read_dir(from)?.filter_map(|entry| Some(entry.ok()?.path())).filter(|path: &PathBuf| {
        let ending = path.extension().map(|ending| ending.to_string_lossy().into_owned()).unwrap_or_default();
        path.is_file() && (is_data(path) || !OURS.contains(&ending.as_str()))
    });
    for file in files {
        if let Some(name) = file.file_name() {
            std::fs::copy(&file, to.join(name))?;
        }
    }
    Ok(())
}

fn watch(mut child: Child) -> std::io::Result<Outcome> {
    let out = collect(child.stdout.take());
    let stderr = collect(child.stderr.take());
    let start = Instant::now();
    let mut pause = Duration::from_micros(500);
    let (code, late) = loop {
        if let Some(status) = child.try_wait()? {
            break (status.code(), false);
        }
        if start.elapsed() > Duration::from_secs(LONGEST) {
            child.kill()?;
            child.wait()?;
            break (None, true);
        }
        std::thread::sleep(pause);
        pause = (pause * 2).min(Duration::from_millis(20));
    };
    let bytes = |reader: std::thread::JoinHandle<Vec<u8>>| reader.join().unwrap_or_default();
    let seconds = start.elapsed().as_secs_f64();
    let stderr = String::from_utf8_lossy(&bytes(stderr)).into_owned();
    Ok(Outcome { out: bytes(out), stderr, code, late, seconds, ..Outcome::default() })
}

fn collect<R: Read + Send + 'static>(stream: Option<R>) -> std::thread::JoinHandle<Vec<u8>> {
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        if let Some(stream) = stream {
            // Bytes read before an error are still worth showing.
            let _ = stream.take(MOST_OUTPUT).read_to_end(&mut bytes);
        }
        bytes
    })
}
