//! Emitted code against the same algorithm in Rust by hand, and against Lua 5.4. Prints ratios of times.
//!
//! `cargo bench -p arl-benches --bench kernels [-- ROUNDS [KERNEL...]]`

use std::hint::black_box;
use std::time::Instant;

use arl_benches::kernels::{self, Kernel};
use arl_benches::lua;
use arl_benches::statistics::{Times, geometric_mean, median};

fn main() -> Result<(), String> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let rounds = words.first().and_then(|word| word.parse().ok()).unwrap_or(40);
    let wanted = |kernel: &&Kernel| words.len() < 2 || words.iter().any(|word| word == kernel.name);
    let with_lua = lua::is_there();
    if !with_lua {
        println!("lua5.4 is not there: no comparison with it");
    }
    println!("times of the emitted program against Rust by hand (least and median of {rounds} rounds, in turns)");
    println!("kernel         by hand/ms  emitted  median  with the controller's cycles     cycles  Lua");
    let (mut least, mut middle, mut whole, mut against_lua) = (vec![], vec![], vec![], vec![]);
    for kernel in kernels::ALL.iter().filter(wanted) {
        let [mut by_hand, mut program, mut all] = [Times::default(), Times::default(), Times::default()];
        let mut ratios = Vec::new();
        let mut cycles = 0;
        for _ in 0..rounds {
            let start = Instant::now();
            let expected = black_box((kernel.rival)(black_box(kernel.large)));
            let time = start.elapsed();
            let run = (kernel.emitted)(black_box(kernel.large))?;
            if run.checksum != expected {
                return Err(format!("{}: {} by hand, {} emitted", kernel.name, expected, run.checksum));
            }
            by_hand.push(time);
            program.push(run.program);
            all.push(run.whole);
            ratios.push(run.program.as_secs_f64() / time.as_secs_f64());
            cycles = run.cycles;
        }
        let base = by_hand.least();
        let lua = if with_lua { lua::run(kernel.name, kernel.large, 5)?.least / program.least() } else { f64::NAN };
        println!(
            "{:<12} {:>12.2} {:>8.2} {:>7.2} {:>29.2} {:>10} {:>4.0}",
            kernel.name,
            base * 1e3,
            program.least() / base,
            median(ratios.clone()),
            all.least() / base,
            cycles,
            lua,
        );
        least.push(program.least() / base);
        middle.push(median(ratios));
        whole.push(all.least() / base);
        against_lua.push(lua);
    }
    println!(
        "{:<12} {:>12} {:>8.2} {:>7.2} {:>29.2} {:>10} {:>4.0}",
        "mean",
        "",
        geometric_mean(&least),
        geometric_mean(&middle),
        geometric_mean(&whole),
        "",
        geometric_mean(&against_lua),
    );
    Ok(())
}
