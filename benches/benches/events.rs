//! What a cycle takes with interrupts to watch, while the program waits, and when all of them happen.
//!
//! `cargo bench -p arl-benches --bench events`

use std::error::Error;

use arl_benches::statistics::processor_time;
use arl_rt::Controller;
use arl_rt::emit::*;

const FILE: File = File::new("events.arl");
/// How many cycles a run has, and how many runs there are.
const CYCLES: u32 = 20_000;
const RUNS: u32 = 20;

/// A program that declares interrupts and waits.
#[derive(Default)]
struct Watching {
    interrupts: i32,
    flag: Cell<bool>,
}

impl Program for Watching {
    fn file(&self) -> File {
        FILE
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            for number in 0..self.interrupts {
                let channel = number % 60 + 1;
                event::interrupt(
                    async move |cx: &Cx| {
                        let g: &Watching = cx.globals().at(FILE, 1)?;
                        Ok(g.flag.get() && io::getdi(cx, 61).await.at(FILE, 1)?
                            || io::getdi(cx, channel).await.at(FILE, 1)?)
                    },
                    async |_: &Cx| Ok(()),
                )
                .priority(number)
                .run(cx)
                .at(FILE, 1)?;
            }
            flow::waittime(1e9).run(cx).await.at(FILE, 2)
        })
    }
}

/// ns of processor time a cycle: the least of some runs.
fn cycle(interrupts: i32) -> Result<f64, Box<dyn Error>> {
    let mut controller = Controller::builder().build(Box::new(Watching { interrupts, ..Watching::default() }))?;
    controller.step();
    let mut least = f64::INFINITY;
    for _ in 0..RUNS {
        let start = processor_time();
        for _ in 0..CYCLES {
            controller.step();
        }
        least = least.min((processor_time() - start).as_nanos() as f64 / f64::from(CYCLES));
    }
    Ok(least)
}

/// us of processor time of the cycle in which all conditions become true, and the actions run: the least of some.
fn all_at_once(interrupts: i32) -> Result<f64, Box<dyn Error>> {
    let mut controller = Controller::builder().build(Box::new(Watching { interrupts, ..Watching::default() }))?;
    let mut least = f64::INFINITY;
    for _ in 0..1000 {
        for level in [false, true] {
            (1..=60).try_for_each(|channel| controller.set_digital_input(channel, level))?;
            let start = processor_time();
            controller.step();
            if level {
                least = least.min((processor_time() - start).as_secs_f64() * 1e6);
            }
        }
    }
    Ok(least)
}

fn main() -> Result<(), Box<dyn Error>> {
    let none = cycle(0)?;
    println!("without interrupts: {none:.0} ns a cycle");
    for count in [1, 16, 64, 255] {
        let with = cycle(count)?;
        println!("{count} interrupts: {with:.0} ns a cycle, {:.1} ns for each", (with - none) / f64::from(count));
    }
    for count in [1, 16, 64, 255] {
        println!("{count} interrupts that all happen in one cycle: {:.1} us", all_at_once(count)?);
    }
    Ok(())
}
