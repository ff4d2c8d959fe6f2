//! What building programs of any size costs, as a multiple of what an empty one costs in the same run.
//!
//! `cargo bench -p arl-benches --bench size [-- MOTIONS|POINTS|FUNCTION|FUNCTIONS]`. Builds the command first. Counted is the
//! processor time of the command and all that it starts, and the most memory that any of them had.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use arl_benches::sizes::Sized;
use arl_benches::statistics::median;
use nix::sys::resource::{UsageWho, getrusage};
use nix::sys::time::TimeVal;

/// A row of the table: the programs, and how many times an empty one they may cost.
type Row = (Sized, &'static str, &'static [(usize, f64)]);

const ROWS: [Row; 4] = [
    (Sized::Motions, "lines of lin in main", &[(2_000, 3.0), (20_000, 8.0), (100_000, 20.0)]),
    (Sized::Points, "points in global variables", &[(2_000, 4.0), (10_000, 6.0), (50_000, 15.0)]),
    (Sized::Function, "ordinary lines in one function", &[(1_000, 8.0), (4_000, 25.0)]),
    (Sized::Functions, "lines in functions of 30", &[(3_000, 8.0), (10_000, 24.0)]),
];

/// How many rows or points the program has of which one is edited, and how many times an empty one that may cost.
const EDITED: (usize, f64) = (10_000, 2.0);

/// The word that makes this program measure a command: what it is called with by itself.
const MEASURE: &str = "--measure";

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    if let Some(at) = words.iter().position(|word| word == MEASURE) {
        return measured(words.get(at + 1..).unwrap_or_default());
    }
    let wanted: Vec<String> = words.into_iter().filter(|word| !word.starts_with('-')).collect();
    let is_wanted =
        |kind: Sized| wanted.is_empty() || wanted.iter().any(|word| format!("{kind:?}").eq_ignore_ascii_case(word));
    let bench = Bench::new()?;
    let empty = bench.empty()?;
    println!("an empty program: {empty:.2} s of processor time\n");
    println!("program                                      s  times empty  at most  memory MB");
    for (kind, what, sizes) in ROWS.iter().filter(|(kind, ..)| is_wanted(*kind)) {
        for (size, most) in *sizes {
            let name = format!("{kind:?}_{size}").to_lowercase();
            let cost = bench.build(&name, &kind.program(*size))?;
            show(&format!("{size} {what}"), cost, empty, *most);
        }
    }
    let (size, most) = EDITED;
    for kind in [Sized::Motions, Sized::Points].into_iter().filter(|kind| is_wanted(*kind)) {
        let name = format!("edited_{kind:?}").to_lowercase();
        let text = kind.program(size);
        bench.build(&name, &text)?;
        let cost = bench.build(&name, &text.replacen(",900,0,150,0}", ",901,0,150,0}", 1))?;
        show(&format!("one edited of {size} {kind:?}").to_lowercase(), cost, empty, most);
    }
    Ok(())
}

fn show(what: &str, cost: Cost, empty: f64, most: f64) {
    let Cost { seconds, megabytes } = cost;
    println!("{what:<40} {seconds:>6.2} {:>12.1} {most:>8.1} {megabytes:>10.0}", seconds / empty);
}

/// What a command cost.
#[derive(Clone, Copy)]
struct Cost {
    seconds: f64,
    /// The most that the command, or one of those that it started, had at once.
    megabytes: f64,
}

/// The command, with a folder and a cache of its own.
struct Bench {
    command: PathBuf,
    folder: PathBuf,
}

impl Bench {
    fn new() -> Result<Self, String> {
        let cargo = std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into());
        let built = Command::new(cargo).args(["build", "--quiet", "--release", "-p", "arl2rs"]).status();
        if !built.map_err(|error| error.to_string())?.success() {
            return Err("the command does not build".into());
        }
        // This program lies in target/release/deps.
        let own = std::env::current_exe().map_err(|error| error.to_string())?;
        let command = own.ancestors().nth(2).map(|folder| folder.join("arl2rs")).filter(|path| path.is_file());
        let command = command.ok_or("cargo made no arl2rs next to this bench")?;
        let folder = std::env::temp_dir().join("arl-benches-size");
        // What an earlier run has left would be found up to date.
        let _ = std::fs::remove_dir_all(folder.join("cache/programs"));
        std::fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
        Ok(Self { command, folder })
    }

    /// The processor time that an empty program costs, once the runtime is compiled.
    fn empty(&self) -> Result<f64, String> {
        let text = "func void main()\nendfunc\n";
        self.build("first", text)?;
        let costs = (1..=5).map(|round| self.build(&format!("empty_{round}"), text).map(|cost| cost.seconds));
        Ok(median(costs.collect::<Result<Vec<f64>, String>>()?))
    }

    /// Builds a program.
    fn build(&self, name: &str, text: &str) -> Result<Cost, String> {
        let file = self.folder.join(name).with_extension("arl");
        std::fs::write(&file, text).map_err(|error| error.to_string())?;
        let own = std::env::current_exe().map_err(|error| error.to_string())?;
        let mut command = Command::new(own);
        command.arg(MEASURE).arg(&self.command).arg("build").arg(&file).arg("-o").arg(self.folder.join("program"));
        let output = command.env("ARL2RS_CACHE", self.folder.join("cache")).stderr(Stdio::inherit()).output();
        let output = output.map_err(|error| error.to_string())?;
        let said = String::from_utf8_lossy(&output.stdout);
        let mut numbers = said.split_whitespace().filter_map(|word| word.parse::<f64>().ok());
        match (output.status.success(), numbers.next(), numbers.next()) {
            (true, Some(seconds), Some(megabytes)) => Ok(Cost { seconds, megabytes }),
            _ => Err(format!("{} does not build", file.display())),
        }
    }
}

/// Runs a command and prints the seconds of processor time that it and all that it started took, and the most memory in MB.
fn measured(words: &[String]) -> Result<(), String> {
    let (program, rest) = words.split_first().ok_or("what to measure?")?;
    let status = Command::new(Path::new(program)).args(rest).stdout(Stdio::null()).status();
    if !status.map_err(|error| error.to_string())?.success() {
        return Err(format!("{program} failed"));
    }
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).map_err(|error| error.to_string())?;
    let seconds = |time: TimeVal| time.tv_sec() as f64 + time.tv_usec() as f64 * 1e-6;
    let total = seconds(usage.user_time()) + seconds(usage.system_time());
    println!("{total} {}", usage.max_rss() as f64 / 1024.0);
    Ok(())
}
