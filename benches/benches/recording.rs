//! What it costs to record a run, to look for collisions in it, and to open what was recorded.
//!
//! `cargo bench -p arl-benches --bench recording [-- ROUNDS]`. Builds the command first. Runs take turns: without
//! anything, recorded, with bodies to run into. Then recordings of growing length are opened: until the page has all
//! but the places of the robot, and until it has those of five minutes.

use std::io::{BufRead, BufReader, Read, Write};
use std::net::TcpStream;
use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use arl_benches::command::Place;
use arl_benches::statistics::Times;

/// Motions of a run, rounded off, between inputs and outputs; and how many of them the shortest run has.
const ROUND: &str = "\
    setdo(1, true)
    ptp p:{x 900, y -500, z 550, a 0, b 180, c 0}, vp:80%, sp:30%
    lin p:{x 900, y -500, z 400, a 0, b 180, c 0}, vl:500mm/s
    setdo(1, false)
    lin p:{x 900, y -500, z 550, a 0, b 180, c 0}, vl:500mm/s, sl:20mm
    ptp p:{x 800, y 300, z 500, a 0, b 180, c 0}, vp:80%
";
const MOTIONS_A_ROUND: usize = 4;
const SHORTEST_ROUNDS: usize = 25;
/// A robot's surroundings.
const CELL: &str = "\
[[body]]
name = \"table\"
box = [2000, 2000, 40]
at = [900, 0, 150]
[[body]]
name = \"post\"
cylinder = [60, 1500]
at = [-700, 700, 750]
[[body]]
name = \"gripper\"
cylinder = [40, 120]
at = [0, 0, 60]
on = \"flange\"
";

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let rounds = words.first().and_then(|word| word.parse().ok()).unwrap_or(5);
    let bench = Bench::new()?;
    println!("motions   plain (least)   recorded   ratio   with collisions   ratio   recording");
    for times in [1, 10, 100] {
        bench.runs(times, rounds)?;
    }
    println!("recording   the page knows   it has five minutes   memory");
    [1, 10, 100].into_iter().try_for_each(|times| bench.open(times))
}

struct Bench(Place);

impl Bench {
    fn new() -> Result<Self, String> {
        let place = Place::new("recording")?;
        write(&place.folder.join("cell.toml"), CELL)?;
        Ok(Self(place))
    }

    fn arl2rs(&self, words: &[&str]) -> Command {
        let mut command = self.0.arl2rs(words);
        command.stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
        command
    }

    /// The three kinds of runs of so many times the shortest, in turns.
    fn runs(&self, times: usize, rounds: usize) -> Result<(), String> {
        let name = format!("run{times}.arl");
        let count = SHORTEST_ROUNDS * times;
        let text = format!(
            "func void main()\n  int i = 0\n  movej j:{{0, -90, 90, 0, 90, 0}}\n  while(i < {count})\n    i++\n{ROUND}  endwhile\nendfunc\n"
        );
        write(&self.0.folder.join(&name), &text)?;
        let recording = format!("run{times}.mcap");
        let kinds: [&[&str]; 3] =
            [&["run", &name], &["run", &name, "--record", &recording], &["run", &name, "--cell", "cell.toml"]];
        // The first one compiles.
        timed(&mut self.arl2rs(kinds[0]))?;
        let mut taken = [Times::default(), Times::default(), Times::default()];
        for _ in 0..rounds {
            for (kind, taken) in kinds.iter().zip(&mut taken) {
                taken.push(timed(&mut self.arl2rs(kind))?);
            }
        }
        let [plain, recorded, collisions] = taken.map(|times| times.least());
        println!(
            "{:>7} {plain:>12.3} s {recorded:>9.3} s {:>7.2} {collisions:>13.3} s {:>9.2} {:>8.1} MB",
            count * MOTIONS_A_ROUND + 1,
            recorded / plain,
            collisions / plain,
            size(&self.0.folder.join(&recording))?
        );
        Ok(())
    }

    /// Opens a recording as the page does.
    fn open(&self, times: usize) -> Result<(), String> {
        let recording = format!("run{times}.mcap");
        let begin = Instant::now();
        let mut server = self.arl2rs(&["view", &recording, "--no-open"]);
        let mut server = Serving(server.stdout(Stdio::piped()).spawn().map_err(|error| error.to_string())?);
        let mut line = String::new();
        let out = server.0.stdout.take().ok_or("no output")?;
        BufReader::new(out).read_line(&mut line).map_err(|error| error.to_string())?;
        let address = line.trim().trim_start_matches("http://").trim_end_matches('/').to_owned();
        get(&address, "/api/run/0")?;
        let knows = begin.elapsed();
        get(&address, "/api/run/0/samples?channel=1&from=0&to=300&most=400000")?;
        let has = begin.elapsed();
        let memory = std::fs::read_to_string(format!("/proc/{}/status", server.0.id())).unwrap_or_default();
        let memory = memory.lines().find_map(|line| line.strip_prefix("VmHWM:")).map_or("", str::trim);
        println!(
            "{:>6.1} MB {:>14.3} s {:>19.3} s   {memory}",
            size(&self.0.folder.join(&recording))?,
            knows.as_secs_f64(),
            has.as_secs_f64()
        );
        Ok(())
    }
}

/// A server, ended with what is measured.
struct Serving(Child);

impl Drop for Serving {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

fn get(address: &str, path: &str) -> Result<usize, String> {
    let fail = |error: std::io::Error| error.to_string();
    let mut stream = TcpStream::connect(address).map_err(fail)?;
    write!(stream, "GET {path} HTTP/1.1\r\nHost: {address}\r\nConnection: close\r\n\r\n").map_err(fail)?;
    let mut answer = Vec::new();
    stream.read_to_end(&mut answer).map_err(fail)?;
    if answer.starts_with(b"HTTP/1.1 200") { Ok(answer.len()) } else { Err(format!("{path} is refused")) }
}

fn timed(command: &mut Command) -> Result<Duration, String> {
    let begin = Instant::now();
    let status = command.status().map_err(|error| error.to_string())?;
    if status.success() { Ok(begin.elapsed()) } else { Err(format!("{command:?} fails")) }
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    std::fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
}

fn size(path: &Path) -> Result<f64, String> {
    let length = std::fs::metadata(path).map_err(|error| error.to_string())?.len();
    Ok(length as f64 / 1e6)
}
