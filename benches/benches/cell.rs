//! What a cycle of the whole controller takes with six robots that move, and interrupts spread over their channels.
//!
//! `cargo bench -p arl-benches --bench cell [-- CYCLES]`

use std::error::Error;

use arl_benches::cell::Robot;
use arl_benches::statistics::processor_time;
use arl_rt::{Controller, Foreground, State};

const ROBOTS: i32 = 6;
/// How often everything is run.
const REPEATS: usize = 5;
/// The cycles before what is measured: declarations, the first plans, the first motions.
const FIRST: usize = 500;
/// So often, in cycles, an input changes, and with it the conditions that look at it.
const CHANGES: usize = 10;

/// What the robots do.
#[derive(Clone, Copy)]
struct Work {
    name: &'static str,
    /// Each of four motions, one a second or so.
    rounds: i32,
}

const WORKS: [Work; 2] =
    [Work { name: "planned before", rounds: 8 }, Work { name: "planned in between", rounds: 1_000_000 }];

fn main() -> Result<(), Box<dyn Error>> {
    let cycles = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(20_000);
    println!("{ROBOTS} robots, {cycles} cycles: us of processor time a cycle, the least of {REPEATS} runs");
    println!("motions             interrupts    p50     p99   p99.9    most");
    for work in WORKS {
        for interrupts in [0, 64, 128, 255] {
            let mut taken = least(work, interrupts, cycles)?;
            taken.sort_by(f64::total_cmp);
            let at = |share: f64| taken.get((taken.len() as f64 * share) as usize).copied().unwrap_or(f64::NAN);
            println!(
                "{:<19} {interrupts:>10} {:>6.1} {:>7.1} {:>7.1} {:>7.1}",
                work.name,
                at(0.5),
                at(0.99),
                at(0.999),
                taken.last().copied().unwrap_or(f64::NAN),
            );
        }
    }
    Ok(())
}

/// A controller whose robots share so many interrupts.
fn controller(work: Work, interrupts: i32) -> Result<Controller, Box<dyn Error>> {
    let robot = |channel: i32| {
        let first = interrupts * channel / ROBOTS;
        let count = interrupts * (channel + 1) / ROBOTS - first;
        // Not all at one speed, so that they do not plan in the same cycles.
        Box::new(Robot::new(first, count, work.rounds, 25.0 + 2.0 * f64::from(channel)))
    };
    let others = (1..ROBOTS).map(|channel| Foreground::new(robot(channel)));
    Ok(others.fold(Controller::builder(), |builder, other| builder.foreground(other)).build(robot(0))?)
}

/// The least of several runs. Every run does the same, so the least that a cycle took in any of them is what it costs.
fn least(work: Work, interrupts: i32, cycles: usize) -> Result<Vec<f64>, Box<dyn Error>> {
    let (mut least, end) = once(work, interrupts, cycles)?;
    for _ in 1..REPEATS {
        let (next, its_end) = once(work, interrupts, cycles)?;
        if its_end != end {
            return Err("two runs of the same programs differ".into());
        }
        least.iter_mut().zip(next).for_each(|(cycle, next)| *cycle = cycle.min(next));
    }
    Ok(least)
}

/// What each cycle took, in us, and where the first robot is in the end.
fn once(work: Work, interrupts: i32, cycles: usize) -> Result<(Vec<f64>, [f64; 6]), Box<dyn Error>> {
    let mut controller = controller(work, interrupts)?;
    let mut taken = Vec::with_capacity(cycles);
    for cycle in 0..FIRST + cycles {
        if cycle % CHANGES == 0 {
            let (change, input) = (cycle / CHANGES, (cycle / CHANGES % 60 + 1) as i32);
            controller.set_digital_input(input, change / 60 % 2 == 0)?;
        }
        let begin = processor_time();
        let state = controller.step();
        let took = processor_time() - begin;
        if state != State::Running {
            return Err(
                format!("the robots do not move any more in cycle {cycle}: {:?}", controller.take_alarms()).into()
            );
        }
        if cycle >= FIRST {
            taken.push(took.as_secs_f64() * 1e6);
        }
    }
    Ok((taken, controller.joints().axes))
}
