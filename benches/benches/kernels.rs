//! Emitted code against the same algorithm in Rust by hand, and against Lua 5.4. Prints ratios of times.
//!
//! `cargo bench -p arl-benches --bench kernels [-- ROUNDS [KERNEL...]]`

use std::hint::black_box;

use arl_benches::kernels::{self, Kernel};
use arl_benches::lua;
use arl_benches::statistics::{Times, geometric_mean, median, processor_time};

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
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
    println!("kernel       by hand/ms  emitted: least  median  cycles  Lua: least  median");
    let mut all = Vec::new();
    for kernel in kernels::ALL.iter().filter(wanted) {
        let row = measure(kernel, rounds, with_lua)?;
        println!(
            "{:<12} {:>10.2} {:>14.2} {:>7.2} {:>7} {:>11.1} {:>7.1}",
            kernel.name,
            row.by_hand * 1e3,
            row.least,
            row.median,
            row.cycles,
            row.lua_least,
            row.lua_median
        );
        all.push(row);
    }
    let mean = |of: fn(&Row) -> f64| geometric_mean(&all.iter().map(of).collect::<Vec<_>>());
    let (least, middle) = (mean(|row| row.least), mean(|row| row.median));
    let (lua_least, lua_median) = (mean(|row| row.lua_least), mean(|row| row.lua_median));
    println!("{:<23} {least:>14.2} {middle:>7.2} {:>7} {lua_least:>11.1} {lua_median:>7.1}", "geometric mean", "");
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
    cycles: u64,
    lua_least: f64,
    lua_median: f64,
}

fn measure(kernel: &Kernel, rounds: usize, with_lua: bool) -> Result<Row, String> {
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
    Ok(Row { by_hand: by_hand.least(), least, median, cycles, lua_least, lua_median })
}
