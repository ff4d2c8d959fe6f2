//! Emitted code against the same algorithm in Rust by hand, and against Lua 5.4. Prints ratios of times, and of
//! instructions where valgrind is there.
//!
//! `cargo bench -p arl-benches --bench kernels [-- ROUNDS [KERNEL...]]`

use std::hint::black_box;

use arl_benches::instructions;
use arl_benches::kernels::{self, Kernel};
use arl_benches::lua;
use arl_benches::statistics::{Times, geometric_mean, median, processor_time};

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    if let [ONE_SIDE, kernel, side, rounds] = words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        return one_side(kernel, side, rounds);
    }
    let counts = instructions::can_be_counted();
    if !counts {
        println!("valgrind is not there: no instructions are counted");
    }
    let rounds = words.first().and_then(|word| word.parse().ok()).unwrap_or(40);
    let wanted = |kernel: &&Kernel| words.len() < 2 || words.iter().any(|word| word == kernel.name);
    let with_lua = lua::is_there();
    if !with_lua {
        println!("lua5.4 is not there: no comparison with it");
    }
    println!(
        "processor time of {rounds} rounds in turns: emitted code (with what the controller does between its cycles)"
    );
    println!("against Rust by hand, and Lua 5.4 against emitted code");
    println!("kernel       by hand/ms  emitted: least  median  instructions  cycles  Lua: least  median");
    let mut all = Vec::new();
    for kernel in kernels::ALL.iter().filter(wanted) {
        let row = measure(kernel, rounds, with_lua, counts)?;
        println!(
            "{:<12} {:>10.2} {:>14.2} {:>7.2} {:>13.2} {:>7} {:>11.1} {:>7.1}",
            kernel.name,
            row.by_hand * 1e3,
            row.least,
            row.median,
            row.instructions,
            row.cycles,
            row.lua_least,
            row.lua_median
        );
        all.push(row);
    }
    let mean = |of: fn(&Row) -> f64| geometric_mean(&all.iter().map(of).collect::<Vec<_>>());
    let (least, middle) = (mean(|row| row.least), mean(|row| row.median));
    let (lua_least, lua_median) = (mean(|row| row.lua_least), mean(|row| row.lua_median));
    let counted = mean(|row| row.instructions);
    println!(
        "{:<23} {least:>14.2} {middle:>7.2} {counted:>13.2} {:>7} {lua_least:>11.1} {lua_median:>7.1}",
        "geometric mean", ""
    );
    Ok(())
}

/// The figures of a kernel.
struct Row {
    /// The least time of the rival in s.
    by_hand: f64,
    /// Least by least.
    least: f64,
    /// The middle of the ratios of all rounds.
    median: f64,
    /// Those of emitted code by those of the rival.
    instructions: f64,
    cycles: u64,
    lua_least: f64,
    lua_median: f64,
}

fn measure(kernel: &Kernel, rounds: usize, with_lua: bool, counts: bool) -> Result<Row, String> {
    let [mut by_hand, mut emitted] = [Times::default(), Times::default()];
    let mut ratios = Vec::new();
    let mut cycles = 0;
    for _ in 0..rounds {
        let start = processor_time();
        let expected = black_box((kernel.rival)(black_box(kernel.large)));
        let time = processor_time() - start;
        let run = (kernel.emitted)(black_box(kernel.large))?;
        if run.checksum != expected {
            return Err(format!("{}: {expected} by hand, {} emitted", kernel.name, run.checksum));
        }
        by_hand.push(time);
        emitted.push(run.time);
        ratios.push(run.time.as_secs_f64() / time.as_secs_f64());
        cycles = run.cycles;
    }
    let (mut lua_least, mut lua_median) = (f64::NAN, f64::NAN);
    if with_lua {
        let lua = lua::run(kernel.name, kernel.large, 5)?;
        (lua_least, lua_median) = (lua.least / emitted.least(), lua.median / emitted.median());
    }
    let (least, median) = (emitted.least() / by_hand.least(), median(ratios));
    let instructions = if counts { counted(kernel)? } else { f64::NAN };
    Ok(Row { by_hand: by_hand.least(), least, median, instructions, cycles, lua_least, lua_median })
}

/// The words of this program when it is one that is counted.
const ONE_SIDE: &str = "one-side";
const BY_HAND: &str = "by-hand";
const EMITTED: &str = "emitted";

/// Instructions of emitted code by those of Rust by hand.
fn counted(kernel: &Kernel) -> Result<f64, String> {
    let of = |side| instructions::of_one_round(&[ONE_SIDE, kernel.name, side]);
    Ok(of(EMITTED)? as f64 / of(BY_HAND)? as f64)
}

/// Runs one side of a kernel, to be counted.
fn one_side(kernel: &str, side: &str, rounds: &str) -> Result<(), String> {
    let found = kernels::ALL.iter().find(|known| known.name == kernel);
    let kernel = found.ok_or_else(|| format!("no kernel is named {kernel}"))?;
    for _ in 0..rounds.parse().map_err(|_| format!("{rounds} is not a number of rounds"))? {
        match side {
            BY_HAND => drop(black_box((kernel.rival)(black_box(kernel.large)))),
            _ => drop(black_box((kernel.emitted)(black_box(kernel.large))?)),
        }
    }
    Ok(())
}
