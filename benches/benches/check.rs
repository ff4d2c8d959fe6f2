//! How fast programs are read and checked, and in how much memory. Each program is measured in a process of its own.
//!
//! `cargo bench -p arl-benches --bench check [-- KIND LINES]`

use std::path::Path;
use std::process::Command;

use arl_benches::programs::Kind;
use arl_benches::statistics::processor_time;
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

/// How many processes measure the same.
const PROCESSES: usize = 5;

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    match words.iter().map(String::as_str).collect::<Vec<_>>().as_slice() {
        [what @ ("parse" | "check"), kind, lines] => return one(what, find(kind)?, number(lines)?),
        [kind, lines] => return row(find(kind)?, kind, number(lines)?),
        _ => {}
    }
    println!(
        "lines of 1000 that are read and checked in a second of processor time, peak memory by the size of the source"
    );
    println!("(best of {PROCESSES} processes each)");
    println!("program             lines    parse    check  check by parse  memory");
    for (kind, sizes) in ALL {
        for lines in sizes {
            row(find(kind)?, kind, *lines)?;
        }
    }
    Ok(())
}

fn find(word: &str) -> Result<Kind, String> {
    let found = Kind::ALL.into_iter().find(|(_, name)| *name == word);
    found.map(|(kind, _)| kind).ok_or(format!("no kind of program: {word}"))
}

fn number(word: &str) -> Result<usize, String> {
    word.parse().map_err(|error| format!("{word}: {error}"))
}

/// Measures one program and prints its figures.
fn row(kind: Kind, word: &str, wanted: usize) -> Result<(), String> {
    let text = kind.program(wanted);
    let lines = text.lines().count() as f64;
    let (parse, _) = best("parse", word, wanted)?;
    let (check, peak) = best("check", word, wanted)?;
    println!(
        "{word:<16} {lines:>8} {:>8.0} {:>8.0} {:>15.2} {:>7.1}",
        lines / parse / 1e3,
        lines / check / 1e3,
        check / parse,
        peak / text.len() as f64,
    );
    Ok(())
}

/// The least time in s and memory in bytes of some processes.
fn best(what: &str, kind: &str, lines: usize) -> Result<(f64, f64), String> {
    let program = std::env::current_exe().map_err(|error| error.to_string())?;
    let (mut time, mut peak) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..PROCESSES {
        let out = Command::new(&program).args([what, kind, &lines.to_string()]).output();
        let out = out.map_err(|error| error.to_string())?;
        let text = String::from_utf8_lossy(&out.stdout);
        let figures: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
        let [seconds, bytes] = figures.as_slice() else {
            return Err(format!("{what} {kind} {lines}: {text}{}", String::from_utf8_lossy(&out.stderr)));
        };
        (time, peak) = (time.min(*seconds), peak.min(*bytes));
    }
    Ok((time, peak))
}

/// Measures one program once, with memory as fresh as in a command: prints the time in s and the memory in bytes.
fn one(what: &str, kind: Kind, lines: usize) -> Result<(), String> {
    let source = Memory(kind.program(lines).into_bytes());
    let text = std::str::from_utf8(&source.0).map_err(|error| error.to_string())?;
    let before = memory("VmRSS");
    let start = processor_time();
    if what == "parse" {
        let mut names = Interner::new();
        let parsed = parse(text, &mut names, ParseOptions::default());
        report(start, before);
        if let Some(error) = parsed.errors.first() {
            return Err(format!("{error:?}"));
        }
        // The command does not wait for this memory either.
        std::mem::forget((names, parsed));
    } else {
        let checked = check(Path::new("bench.arl"), &source, &CheckOptions::default());
        report(start, before);
        if let Some(error) = checked.diagnostics.iter().find(|_| checked.has_errors()) {
            return Err(format!("line {}: {}", checked.files.line(error.primary.at), error.message));
        }
        std::mem::forget(checked);
    }
    Ok(())
}

fn report(start: std::time::Duration, before: u64) {
    let time = processor_time() - start;
    println!("{} {}", time.as_secs_f64(), memory("VmHWM").saturating_sub(before) * 1024);
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
