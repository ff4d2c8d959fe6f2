//! What a sweep costs beside the cycles of its runs.
//!
//! `cargo bench -p arl-benches --bench sweep [-- RUNS]`. Builds the command first. A hundredth, a tenth and all of so
//! many runs (10 000) of some ten seconds of the robot's time: by the command, and by the program itself with nothing
//! around it but a pipe, on all cores. What a run costs that has no cycles is not counted among theirs.

use std::io::{BufRead, BufReader, Write};
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

use arl_benches::command::Place;

const PROGRAM: &str = "\
double angle = 1
func void main()
  int part = 0
  movej j:{angle, -90, 90, 0, 90, 0}
  while(part < 2)
    part++
    ptp p:{x 900, y -500, z 550, a 0, b 180, c 0}, vp:80%, sp:30%
    lin p:{x 900, y -500, z 400, a 0, b 180, c 0}, vl:250mm/s
    setdo(1, true)
    waittime 0.3
    lin p:{x 900, y -500, z 550, a 0, b 180, c 0}, vl:500mm/s, sl:20mm
    ptp p:{x 800, y 300, z 500, a angle, b 180, c 0}, vp:80%
    lin p:{x 800, y 300, z 350, a angle, b 180, c 0}, vl:250mm/s
    setdo(1, false)
    waittime 0.3
    lin p:{x 800, y 300, z 500, a angle, b 180, c 0}, vl:500mm/s
  endwhile
endfunc
";
/// What robots may run into, where it is looked for.
const CELL: &str = "[[body]]\nname = \"table\"\nbox = [2000, 2000, 40]\nat = [900, 0, 150]\n[[body]]\nname = \"gripper\"\ncylinder = [40, 120]\nat = [0, 0, 60]\non = \"flange\"\n";
/// The words that all runs of the sweep have.
const WORDS: &str = "--report\t--max-time\t3600\t--set\tglobal.angle=";
const RUNS: usize = 10_000;

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let runs: usize = words.first().and_then(|word| word.parse().ok()).unwrap_or(RUNS);
    let bench = Bench::new()?;
    println!("runs     s of the robot   sweep   robot's s a s   bare programs   ratio   share of the cores for cycles");
    for runs in [runs / 100, runs / 10, runs] {
        bench.measure(runs.max(2))?;
    }
    let (plain, with_collisions, known) = bench.variants((runs / 10).max(2))?;
    println!("with collisions: {:.2} times as long", with_collisions / plain);
    println!("known results: {:.3} ms a run, with the start of the command", known * 1e3);
    Ok(())
}

struct Bench {
    place: Place,
    /// The compiled program.
    program: PathBuf,
    cores: usize,
}

impl Bench {
    fn new() -> Result<Self, String> {
        let place = Place::new("sweep")?;
        let write = |name: &str, text: &str| {
            std::fs::write(place.folder.join(name), text).map_err(|error| format!("cannot write {name}: {error}"))
        };
        write("ten.arl", PROGRAM)?;
        write("cell.toml", CELL)?;
        // What was compiled before may be of another version.
        let _ = std::fs::remove_dir_all(place.folder.join("cache/programs"));
        let cores = std::thread::available_parallelism().map_or(1, usize::from);
        let bench = Self { program: PathBuf::new(), place, cores };
        bench.sweep(2, "", &["--no-cache"])?;
        let program = program(&bench.place.folder.join("cache/programs")).ok_or("the program was not compiled")?;
        Ok(Self { program, ..bench })
    }

    fn measure(&self, runs: usize) -> Result<(), String> {
        let (sweep, robot) = self.sweep(runs, "", &["--no-cache"])?;
        let bare = self.bare(runs, "")?;
        let without_cycles = self.bare(runs, "\t--max-time\t0")?;
        println!(
            "{runs:>6} {robot:>16.0} {sweep:>7.2} {:>15.0} {bare:>15.2} {:>7.2} {:>31.2}",
            robot / sweep,
            sweep / bare,
            (bare - without_cycles) / sweep
        );
        Ok(())
    }

    /// s of a sweep, of one that looks for collisions, and of a run that is known.
    fn variants(&self, runs: usize) -> Result<(f64, f64, f64), String> {
        let plain = self.sweep(runs, "cell = \"cell.toml\"", &["--no-cache"])?.0;
        let with_collisions = self.sweep(runs, "cell = \"cell.toml\"\ncollisions = true", &["--no-cache"])?.0;
        self.sweep(runs, "", &[])?;
        let known = self.sweep(runs, "", &[])?.0 / runs as f64;
        Ok((plain, with_collisions, known))
    }

    /// s on the clock of a sweep by the command, and s of the robot's time.
    fn sweep(&self, runs: usize, settings: &str, options: &[&str]) -> Result<(f64, f64), String> {
        let table = format!(
            "program = \"ten.arl\"\n{settings}\n[grid]\n\"global.angle\" = {{ from = 0.5, to = 1.5, count = {runs} }}\n"
        );
        std::fs::write(self.place.folder.join("s.toml"), table).map_err(|error| error.to_string())?;
        let begin = Instant::now();
        let mut command = self.place.arl2rs(&["sweep", "s.toml"]);
        let output = command.args(options).output().map_err(|error| error.to_string())?;
        let taken = begin.elapsed().as_secs_f64();
        let text = String::from_utf8_lossy(&output.stdout);
        let times: Vec<f64> = text.lines().filter_map(cycle_time).collect();
        if times.len() != runs || !output.status.success() {
            return Err(format!("the sweep failed: {}", String::from_utf8_lossy(&output.stderr)));
        }
        Ok((taken, times.iter().sum()))
    }

    /// s on the clock of the same runs by a process for each core, which is asked and answers.
    fn bare(&self, runs: usize, more: &str) -> Result<f64, String> {
        let begin = Instant::now();
        std::thread::scope(|scope| {
            let ask = |core| move || ask(&self.program, &self.place.folder, (core, self.cores, runs), more);
            let all: Vec<_> = (0..self.cores).map(|core| scope.spawn(ask(core))).collect();
            all.into_iter().try_for_each(|one| one.join().unwrap_or_else(|_| Err("a thread panicked".into())))
        })?;
        Ok(begin.elapsed().as_secs_f64())
    }
}

/// Every so many-th of the runs, one behind the other.
fn ask(program: &Path, folder: &Path, (core, cores, runs): (usize, usize, usize), more: &str) -> Result<(), String> {
    let fail = |error: std::io::Error| error.to_string();
    let mut command = Command::new(program);
    command.arg("--serve").current_dir(folder).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = command.spawn().map_err(fail)?;
    let (mut questions, answers) = (child.stdin.take().ok_or("no input")?, child.stdout.take().ok_or("no output")?);
    let mut answers = BufReader::new(answers);
    let mut answer = String::new();
    for run in (core..runs).step_by(cores) {
        let angle = 0.5 + run as f64 / (runs - 1).max(1) as f64;
        writeln!(questions, "{WORDS}{angle}{more}").map_err(fail)?;
        answer.clear();
        answers.read_line(&mut answer).map_err(fail)?;
        if !answer.contains("\"summary\"") {
            return Err(format!("the program answers {answer}"));
        }
    }
    drop(questions);
    child.wait().map(drop).map_err(fail)
}

/// The only program that is there.
fn program(programs: &Path) -> Option<PathBuf> {
    let folders = std::fs::read_dir(programs).ok()?.filter_map(Result::ok);
    let files = folders.filter_map(|folder| std::fs::read_dir(folder.path()).ok()).flatten().filter_map(Result::ok);
    files.map(|file| file.path()).find(|path| {
        let name = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        name.starts_with("ten-") && path.extension().is_none()
    })
}

/// The cycle time of a row.
fn cycle_time(row: &str) -> Option<f64> {
    let after = row.split("\"cycle_time\":").nth(1)?;
    after.split([',', '}']).next()?.parse().ok()
}
