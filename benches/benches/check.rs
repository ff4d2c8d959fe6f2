//! How fast programs are read and checked, and in how much memory. Each program is measured in a process of its own.
//!
//! `cargo bench -p arl-benches --bench check [-- KIND LINES]`

use std::path::Path;
use std::process::Command;
use std::time::Duration;

use arl_benches::programs::Kind;
use arl_benches::statistics::{Times, processor_time};
use arl_lang::symbol::Interner;
use arl_lang::{ParseOptions, parse};
use arl2rs::{CheckOptions, SourceError, Sources, check};

/// What is measured without further words.
const ALL: [(&str, &[usize]); 5] = [
    ("typical", &[1_000, 10_000, 100_000, 1_000_000]),
    ("small-functions", &[1_000, 10_000, 100_000]),
    ("huge-function", &[1_000, 10_000, 100_000]),
    ("globals", &[1_000, 10_000, 100_000]),
    ("points", &[1_000, 10_000, 100_000]),
];

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    if let [kind, lines] = words.as_slice() {
        return one(kind, lines.parse().map_err(|error| format!("{lines}: {error}"))?);
    }
    println!(
        "lines of 1000 that are read and checked in a second of processor time, peak memory by the size of the source"
    );
    println!("program             lines    parse    check  check by parse  memory");
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    for (kind, sizes) in ALL {
        for lines in sizes {
            let status = Command::new(&program).args([kind, &lines.to_string()]).status();
            match status {
                Ok(status) if status.success() => {}
                Ok(status) => return Err(format!("{kind} of {lines} lines: {status}")),
                Err(error) => return Err(error.to_string()),
            }
        }
    }
    Ok(())
}

/// Measures one program and prints its row.
fn one(word: &str, lines: usize) -> Result<(), String> {
    let kind = Kind::ALL.into_iter().find(|(_, name)| *name == word).ok_or(format!("no kind of program: {word}"))?.0;
    let source = Memory(kind.program(lines).into_bytes());
    let text = std::str::from_utf8(&source.0).map_err(|error| error.to_string())?;
    let lines = text.lines().count() as f64;
    let before = memory("VmRSS");
    let [mut parses, mut checks] = [Times::default(), Times::default()];
    let mut peak = 0;
    let mut measured = Duration::ZERO;
    while measured < Duration::from_millis(500) || peak == 0 {
        let start = processor_time();
        let checked = check(Path::new("bench.arl"), &source, &CheckOptions::default());
        let time = processor_time() - start;
        checks.push(time);
        if peak == 0 {
            peak = memory("VmHWM").saturating_sub(before).max(1);
        }
        if let Some(error) = checked.diagnostics.iter().find(|_| checked.has_errors()) {
            return Err(format!("{}: {}", checked.files.line(error.primary.at), error.message));
        }
        measured += time;
        drop(checked);
        let start = processor_time();
        let mut names = Interner::new();
        let parsed = parse(text, &mut names, ParseOptions::default());
        parses.push(processor_time() - start);
        drop(parsed);
    }
    let speed = |times: &Times| lines / times.least() / 1e3;
    println!(
        "{word:<16} {lines:>8} {:>8.0} {:>8.0} {:>15.2} {:>7.1}",
        speed(&parses),
        speed(&checks),
        checks.least() / parses.least(),
        peak as f64 * 1024.0 / text.len() as f64,
    );
    Ok(())
}

/// A program in memory.
struct Memory(Vec<u8>);

impl Sources for Memory {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        if path.ends_with("bench.arl") { Ok(self.0.clone()) } else { Err(SourceError::Missing) }
    }
}

/// Memory of this process in KiB, as Linux counts it; 0 elsewhere.
fn memory(what: &str) -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(what)?.strip_prefix(':'));
    line.and_then(|line| line.split_whitespace().next()?.parse().ok()).unwrap_or(0)
}
