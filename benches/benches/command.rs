//! How long it takes from an edited line to the running program, and what compiling emitted code costs.
//!
//! `cargo bench -p arl-benches --bench command [-- ROUNDS]`. Builds the command first. Times are by the clock on the
//! wall, as what is waited for: quiet machines only.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use arl_benches::command::Place;
use arl_benches::programs::Kind;
use arl_benches::statistics::Times;

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let rounds = words.first().and_then(|word| word.parse().ok()).unwrap_or(7);
    let bench = Bench::new()?;
    bench.edit_and_run(rounds)?;
    bench.tables()?;
    packages()
}

/// The command and a cache of its own.
struct Bench(Place);

impl Bench {
    fn new() -> Result<Self, String> {
        Ok(Self(Place::new("command")?))
    }

    fn arl2rs(&self, words: &[&str], file: &Path) -> Command {
        let mut command = self.0.arl2rs(words);
        command.arg(file);
        command
    }

    /// One edited line of 500, run; against `cargo build` of what was emitted for such an edit.
    fn edit_and_run(&self, rounds: usize) -> Result<(), String> {
        let file = self.0.folder.join("edited.arl");
        let program = |number: usize| {
            let text = Kind::Typical.program(500);
            text.replacen("double total = limit * 2.5", &format!("double total = limit * {number}.5"), 1)
        };
        let lines = program(0).lines().count();
        write(&file, &program(0))?;
        let first = timed(&mut self.arl2rs(&["run"], &file))?;
        println!(
            "a program of {lines} lines for the first time (the runtime is compiled, too): {:.1} s",
            first.as_secs_f64()
        );
        let project = self.project()?;
        let [mut whole, mut cargo_alone, mut unchanged] = [Times::default(), Times::default(), Times::default()];
        for round in 1..=rounds {
            write(&file, &program(2 * round))?;
            whole.push(timed(&mut self.arl2rs(&["run"], &file))?);
            unchanged.push(timed(&mut self.arl2rs(&["run"], &file))?);
            write(&file, &program(2 * round + 1))?;
            run(self.arl2rs(&["emit", "-o", "emitted"], &file).stdout(Stdio::null()))?;
            let emitted = std::fs::read(self.0.folder.join("emitted/edited.rs")).map_err(|error| error.to_string())?;
            std::fs::write(project.join("src/program.rs"), emitted).map_err(|error| error.to_string())?;
            let mut build = cargo();
            build
                .args(["build", "--quiet", "--target-dir"])
                .arg(self.0.folder.join("cache/target"))
                .current_dir(&project);
            cargo_alone.push(timed(&mut build)?);
        }
        println!("one line edited, of {rounds} rounds                       least    median");
        println!(
            "cargo build of the emitted module alone          {:>6.0} ms {:>6.0} ms",
            ms(cargo_alone.least()),
            ms(cargo_alone.median())
        );
        println!(
            "arl2rs run                                       {:>6.0} ms {:>6.0} ms",
            ms(whole.least()),
            ms(whole.median())
        );
        println!(
            "ratio                                            {:>9.2} {:>9.2}",
            whole.least() / cargo_alone.least(),
            whole.median() / cargo_alone.median()
        );
        println!(
            "arl2rs run, nothing edited                       {:>6.0} ms {:>6.0} ms",
            ms(unchanged.least()),
            ms(unchanged.median())
        );
        Ok(())
    }

    /// The cargo project that the command made.
    fn project(&self) -> Result<PathBuf, String> {
        let programs = std::fs::read_dir(self.0.folder.join("cache/programs")).map_err(|error| error.to_string())?;
        let mut found = programs.filter_map(Result::ok).map(|entry| entry.path());
        found.find(|path| path.to_string_lossy().contains("arl-edited-")).ok_or("no project in the cache".into())
    }

    /// What compiling tables of points costs.
    fn tables(&self) -> Result<(), String> {
        println!("compiling a table of points              arl2rs build  for 1000 points");
        for points in [1_000, 2_000, 5_000, 10_000] {
            let file = self.0.folder.join(format!("points{points}.arl"));
            let mut least = Duration::MAX;
            for round in 0..3 {
                let text = Kind::Points.program(points).replace("x 0.138", &format!("x {round}.138"));
                write(&file, &text.replace("const pose", "pose"))?;
                least = least.min(timed(&mut self.arl2rs(&["run"], &file))?);
            }
            let seconds = least.as_secs_f64();
            println!(
                "{points:>7} points                           {seconds:>6.2} s {:>12.2} s",
                seconds * 1e3 / points as f64
            );
        }
        Ok(())
    }
}

/// How many packages a build script compiles for the build door.
fn packages() -> Result<(), String> {
    let mut tree = cargo();
    tree.args([
        "tree",
        "--package",
        "arl2rs",
        "--no-default-features",
        "--edges",
        "normal,build",
        "--prefix",
        "none",
        "--no-dedupe",
    ]);
    let out = tree.stderr(Stdio::null()).output().map_err(|error| error.to_string())?;
    let text = String::from_utf8_lossy(&out.stdout);
    let words = |line: &str| line.split_whitespace().take(2).map(str::to_string).collect::<Vec<_>>();
    let names: std::collections::BTreeSet<Vec<String>> =
        text.lines().map(words).filter(|words| !words.is_empty()).collect();
    println!("packages that the build door compiles: {}", names.len());
    Ok(())
}

fn cargo() -> Command {
    let mut command = Command::new(std::env::var_os("CARGO").unwrap_or_else(|| "cargo".into()));
    command.current_dir(env!("CARGO_MANIFEST_DIR"));
    command
}

fn run(command: &mut Command) -> Result<(), String> {
    match command.status() {
        Ok(status) if status.success() => Ok(()),
        Ok(status) => Err(format!("{command:?}: {status}")),
        Err(error) => Err(format!("{command:?}: {error}")),
    }
}

fn timed(command: &mut Command) -> Result<Duration, String> {
    let start = Instant::now();
    run(command.stdout(Stdio::null()).stderr(Stdio::null()))?;
    Ok(start.elapsed())
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

fn ms(seconds: f64) -> f64 {
    seconds * 1e3
}
