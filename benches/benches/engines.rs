//! The engine beside compiled programs and Lua 5.4: from the command's start to the first cycle, programs that
//! calculate, programs that wait, a whole program.
//!
//! `cargo bench -p arl-benches --bench engines [-- start|kernels|waits|program...]`. Builds the command first.

use std::path::Path;
use std::process::Stdio;

use arl_benches::command::Place;
use arl_benches::cost::{Cost, cost, measures};
use arl_benches::engine::{program, run_function};
use arl_benches::kernels::{self, Kernel};
use arl_benches::sizes::Sized;
use arl_benches::statistics::{Times, geometric_mean, median};
use arl_benches::{lua, waits};

/// How many lines of `lin` the programs have that are started, and how often.
const STARTS: [(usize, usize); 4] = [(10, 15), (1_000, 15), (10_000, 9), (100_000, 5)];

/// How many times a kernel runs on each side.
const ROUNDS: usize = 7;

/// How many cycles a program waits.
const CYCLES: i32 = 100_000;

/// A part of the bench.
type Part = fn() -> Result<(), String>;

fn main() -> Result<(), String> {
    if measures()? {
        return Ok(());
    }
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let parts: [(&str, Part); 4] =
        [("start", starts), ("kernels", kernels_of_all), ("waits", waits_of_both), ("program", whole_program)];
    let wanted = |name: &str| words.is_empty() || words.iter().any(|word| word == name);
    parts.iter().filter(|(name, _)| wanted(name)).try_for_each(|(_, part)| part())
}

/// What a command costs, in the middle of so many times.
fn middle(times: usize, run: impl Fn() -> Result<Cost, String>) -> Result<(f64, f64), String> {
    let costs = (0..times).map(|_| run()).collect::<Result<Vec<_>, _>>()?;
    let of = |what: fn(&Cost) -> f64| median(costs.iter().map(what).collect());
    Ok((of(|cost| cost.seconds), of(|cost| cost.megabytes)))
}

/// From the command's start to the first cycle, beside the check alone and a program that is compiled already.
fn starts() -> Result<(), String> {
    let place = Place::new("engines")?;
    let cache = place.folder.join("cache");
    let run = |words: &[&str], file: &Path, ends: i32| {
        let words: Vec<_> = words.iter().map(|word| word.as_ref()).chain([file.as_os_str()]).collect();
        let cost = cost(&place.command, &words, &cache, Stdio::null())?;
        if cost.code == ends { Ok(cost) } else { Err(format!("{}: code {}", file.display(), cost.code)) }
    };
    println!("processor time from the start of the command to the first cycle, and the most memory");
    println!("lin        check ms     MB    engine ms     MB    compiled before ms");
    for (lines, times) in STARTS {
        let file = place.folder.join(format!("lin_{lines}.arl"));
        std::fs::write(&file, Sized::Motions.program(lines)).map_err(|error| error.to_string())?;
        let first_cycle = ["run", "--max-time", "0", "--engine"];
        let (check, check_mb) = middle(times, || run(&["check"], &file, 0))?;
        let (engine, engine_mb) = middle(times, || run(&[&first_cycle[..], &["engine"]].concat(), &file, 4))?;
        // rustc takes minutes for the largest one.
        let native = if lines <= 1_000 {
            let native = [&first_cycle[..], &["native"]].concat();
            run(&native, &file, 4)?;
            middle(times, || run(&native, &file, 4))?.0
        } else {
            f64::NAN
        };
        println!(
            "{lines:>7} {:>11.1} {check_mb:>6.0} {:>12.1} {engine_mb:>6.0} {:>21.1}",
            check * 1e3,
            engine * 1e3,
            native * 1e3
        );
    }
    println!();
    Ok(())
}

/// Programs that calculate.
fn kernels_of_all() -> Result<(), String> {
    if !lua::is_there() {
        println!("lua5.4 is not there: no comparison with it");
    }
    println!("processor time of {ROUNDS} rounds in turns");
    println!("kernel       compiled ms  engine ms   by compiled  by Lua: least  median");
    let mut all = Vec::new();
    for kernel in kernels::ALL {
        all.push(of_kernel(kernel)?);
    }
    let mean = |of: fn(&(f64, f64, f64)) -> f64| geometric_mean(&all.iter().map(of).collect::<Vec<_>>());
    let (compiled, least, middle) = (mean(|row| row.0), mean(|row| row.1), mean(|row| row.2));
    println!("{:<35} {compiled:>13.1} {least:>14.2} {middle:>7.2}\n", "geometric mean");
    Ok(())
}

fn of_kernel(kernel: &Kernel) -> Result<(f64, f64, f64), String> {
    let Kernel { name, large, .. } = *kernel;
    let text = program(&format!("kernels/{name}.arl"))?;
    let call = format!("print {name}({large})");
    let [mut compiled, mut engine] = [Times::default(), Times::default()];
    for _ in 0..ROUNDS {
        let (native, run) = ((kernel.emitted)(large)?, run_function(&text, &call)?);
        // What is printed has six digits.
        if (native.checksum - run.checksum).abs() > 1e-5 * native.checksum.abs() {
            return Err(format!("{name}: {} compiled, {} by the engine", native.checksum, run.checksum));
        }
        if native.cycles != run.cycles {
            return Err(format!("{name}: {} cycles compiled, {} by the engine", native.cycles, run.cycles));
        }
        compiled.push(native.time);
        engine.push(run.time);
    }
    let (mut least, mut middle) = (f64::NAN, f64::NAN);
    if lua::is_there() {
        let lua = lua::run(name, large, ROUNDS)?;
        (least, middle) = (engine.least() / lua.least, engine.median() / lua.median);
    }
    let by_compiled = engine.least() / compiled.least();
    println!(
        "{name:<12} {:>11.2} {:>10.1} {by_compiled:>13.1} {least:>14.2} {middle:>7.2}",
        compiled.least() * 1e3,
        engine.least() * 1e3
    );
    Ok((by_compiled, least, middle))
}

/// Programs that wait: what a cycle costs, with what the controller does in it.
fn waits_of_both() -> Result<(), String> {
    let text = program("cells/waits.arl")?;
    println!("a cycle of a program that waits, in us, least of {ROUNDS} rounds of {CYCLES} cycles in turns");
    println!("how               compiled   engine    more");
    for waits in waits::ALL {
        let [mut compiled, mut engine] = [f64::INFINITY; 2];
        for _ in 0..ROUNDS {
            let (native, run) = ((waits.emitted)(CYCLES)?, run_function(&text, &format!("{}({CYCLES})", waits.name))?);
            if native.cycles != run.cycles {
                return Err(format!("{}: {} cycles and {}", waits.name, native.cycles, run.cycles));
            }
            let of_cycle = |time: std::time::Duration| time.as_secs_f64() * 1e6 / native.cycles.max(1) as f64;
            compiled = compiled.min(of_cycle(native.time));
            engine = engine.min(of_cycle(run.time));
        }
        println!("{:<16} {compiled:>9.3} {engine:>8.3} {:>7.3}", waits.name, engine - compiled);
    }
    println!();
    Ok(())
}

/// The example pick and place, as commands.
fn whole_program() -> Result<(), String> {
    let place = Place::new("engines")?;
    let cache = place.folder.join("cache");
    let example = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/pick_and_place");
    let (file, scenario) = (example.join("pick_and_place.arl"), example.join("scenario.toml"));
    let state = place.folder.join("state");
    let run = |engine: &str| {
        let words = ["run".as_ref(), file.as_os_str(), "--io".as_ref(), scenario.as_os_str()];
        let more = ["--state-dir".as_ref(), state.as_os_str(), "--engine".as_ref(), engine.as_ref()];
        let cost = cost(&place.command, &[&words[..], &more].concat(), &cache, Stdio::null())?;
        if cost.code == 0 { Ok(cost) } else { Err(format!("pick and place ended with {}", cost.code)) }
    };
    run("native")?;
    let [mut ratios, mut native, mut engine] = [const { Vec::new() }; 3];
    for _ in 0..9 {
        let (compiled, by_engine) = (run("native")?.seconds, run("engine")?.seconds);
        ratios.push(compiled / by_engine);
        native.push(compiled);
        engine.push(by_engine);
    }
    println!("the example pick and place, from the command's start to its end, processor time in the middle of 9");
    println!(
        "compiled before {:.0} ms, engine {:.0} ms: {:.2} of the robot's seconds a second\n",
        median(native) * 1e3,
        median(engine) * 1e3,
        median(ratios)
    );
    Ok(())
}
