//! Instructions that a piece of work takes, counted by valgrind: a figure that does not hang on the machine's caches,
//! clock and alignment.

use std::process::{Command, Stdio};

/// Whether valgrind is there.
pub fn can_be_counted() -> bool {
    let answer = Command::new("valgrind").arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    answer.is_ok_and(|status| status.success())
}

/// The instructions of one round of `work`: this program is run again with these words and a number of rounds behind
/// them, with one round and with two. What start and end take is the same in both.
///
/// # Errors
/// The program cannot be run, does not end well, or valgrind does not say how many there were.
pub fn of_one_round(work: &[&str]) -> Result<u64, String> {
    let (one, two) = (count(work, 1)?, count(work, 2)?);
    two.checked_sub(one).ok_or_else(|| format!("{work:?}: two rounds take fewer instructions than one"))
}

fn count(work: &[&str], rounds: usize) -> Result<u64, String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let answer = Command::new("valgrind")
        .args(["--tool=callgrind", "--callgrind-out-file=/dev/null"])
        .arg(program)
        .args(work)
        .arg(rounds.to_string())
        .stdout(Stdio::null())
        .output()
        .map_err(|error| format!("valgrind: {error}"))?;
    let report = String::from_utf8_lossy(&answer.stderr);
    let counted = report.lines().filter_map(|line| line.split_once("Collected :")).next_back();
    let count = counted.and_then(|(_, count)| count.trim().parse().ok());
    count.filter(|_| answer.status.success()).ok_or_else(|| format!("{work:?}: {report}"))
}
