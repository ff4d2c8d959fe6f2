//! What building programs of any size costs, as a multiple of what an empty one costs in the same run.
//!
//! `cargo bench -p arl-benches --bench size [-- MOTIONS|POINTS|FUNCTION|FUNCTIONS]`. Builds the command first. Counted
//! is the processor time of the command and all that it starts, and the most memory that any of them had.

use std::path::PathBuf;
use std::process::Stdio;

use arl_benches::command;
use arl_benches::cost::{Cost, cost, measures};
use arl_benches::sizes::Sized;
use arl_benches::statistics::median;

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

fn main() -> Result<(), String> {
    if measures()? {
        return Ok(());
    }
    let wanted: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
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
    let Cost { seconds, megabytes, .. } = cost;
    println!("{what:<40} {seconds:>6.2} {:>12.1} {most:>8.1} {megabytes:>10.0}", seconds / empty);
}

/// The command, with a folder and a cache of its own.
struct Bench {
    command: PathBuf,
    folder: PathBuf,
}

impl Bench {
    fn new() -> Result<Self, String> {
        let command = command::build()?;
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
        let (program, out) = (self.folder.join("program"), file.as_os_str());
        let words = ["build".as_ref(), out, "-o".as_ref(), program.as_os_str()];
        let cost = cost(&self.command, &words, &self.folder.join("cache"), Stdio::inherit())?;
        if cost.code == 0 { Ok(cost) } else { Err(format!("{} does not build", file.display())) }
    }
}
