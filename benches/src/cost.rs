//! What a command costs: processor time and memory of it and of all that it starts.

use std::ffi::OsStr;
use std::path::Path;
use std::process::{Command, Stdio};

use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeVal;

/// The word that makes a bench measure a command: what it is called with by itself, since the system adds up what all
/// that a process has started took.
const MEASURE: &str = "--measure";

/// What a command cost.
#[derive(Clone, Copy, Debug)]
pub struct Cost {
    /// Processor time, in s.
    pub seconds: f64,
    /// The most memory that the command, or one of those that it started, had at once, in MB.
    pub megabytes: f64,
    /// The code that it ended with.
    pub code: i32,
}

/// To be called first by a bench that uses [`cost`]: measures, where it was called for that, and says whether it was.
///
/// # Errors
/// The command cannot be started.
pub fn measures() -> Result<bool, String> {
    let words: Vec<String> = std::env::args().collect();
    let Some(at) = words.iter().position(|word| word == MEASURE) else { return Ok(false) };
    let (program, rest) = words.get(at + 1..).and_then(<[String]>::split_first).ok_or("what to measure?")?;
    let status = Command::new(program).args(rest).stdout(Stdio::null()).status();
    let code = status.map_err(|error| error.to_string())?.code().unwrap_or(-1);
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).map_err(|error| error.to_string())?;
    let seconds = |time: TimeVal| time.tv_sec() as f64 + time.tv_usec() as f64 * 1e-6;
    let total = seconds(usage.user_time()) + seconds(usage.system_time());
    println!("{total} {} {code}", usage.max_rss() as f64 / 1024.0);
    Ok(true)
}

/// Runs a command, with a build cache of its own, and says what it cost. Its standard output goes nowhere, its standard
/// error to `errors`.
///
/// # Errors
/// It cannot be started.
pub fn cost<S: AsRef<OsStr>>(command: &Path, words: &[S], cache: &Path, errors: Stdio) -> Result<Cost, String> {
    let own = std::env::current_exe().map_err(|error| error.to_string())?;
    let mut measuring = Command::new(own);
    measuring.arg(MEASURE).arg(command).args(words).env("ARL2RS_CACHE", cache).stderr(errors);
    let output = measuring.output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&output.stdout);
    let mut numbers = text.split_whitespace().filter_map(|word| word.parse::<f64>().ok());
    match (numbers.next(), numbers.next(), numbers.next()) {
        (Some(seconds), Some(megabytes), Some(code)) => Ok(Cost { seconds, megabytes, code: code as i32 }),
        _ => Err(format!("{} cannot be measured", command.display())),
    }
}
