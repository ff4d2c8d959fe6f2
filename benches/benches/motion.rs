//! Chains of blended motions: how near they come to the programmed speed, what planning a motion takes and what a
//! cycle.
//!
//! `cargo bench -p arl-benches --bench motion [-- MOTIONS [CHAIN...]]`

use std::error::Error;
use std::sync::Arc;
use std::time::{Duration, Instant};

use arl_benches::chains::{CHAINS, Chain};
use arl_benches::statistics::processor_time;
use arl_rt::kinematics::{Frame, frame_components};
use arl_rt::motion::frames::Rig;
use arl_rt::motion::{Command, Cycle, Joints, Override, Queue, Settings, Speed, Target, UNSET, Zone};
use arl_rt::robot::Robot;

const CYCLE: f64 = 0.001;
/// How often everything is run.
const REPEATS: usize = 5;
/// Where the paths begin.
const START: [f64; 6] = [0.0, -90.0, 90.0, 0.0, 45.0, 0.0];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let count = words.iter().find_map(|word| word.parse::<usize>().ok()).unwrap_or(20_000);
    let names: Vec<&String> = words.iter().filter(|word| word.parse::<usize>().is_err()).collect();
    let robot = Arc::new(Robot::builtin("kr10-r1420")?);
    println!(
        "{count} motions each (line, corners and axes fewer), percent zones of 100 %; planning: us a motion; cycles: us of processor time, the least of {REPEATS} runs"
    );
    println!("chain      programmed  in the middle  above 99 %   planning    p50    p99  p99.9    most");
    for chain in CHAINS {
        if names.is_empty() || names.iter().any(|name| *name == chain.name) {
            run(&robot, &chain, count.min(chain.most))?;
        }
    }
    Ok(())
}

fn command(origin: &[f64; 6], [x, y, z]: [f64; 3], axes: bool, zone: Zone, tcp: f64) -> Command {
    let external = [UNSET; 6];
    let [x0, y0, z0, a, b, c] = *origin;
    let target = if axes {
        let [j1, j2, j3, rest @ ..] = START;
        let [j4, j5, j6] = rest;
        Target::Joints(Joints { axes: [j1 + x, j2 + y, j3 + z, j4, j5, j6], external })
    } else {
        Target::Line { pose: [x0 + x, y0 + y, z0 + z, a, b, c], wobj: Frame::identity(), external }
    };
    let speed = Speed { percent: tcp.min(100.0), tcp, ori: 1e4, exj: 1e4, exl: 1e4 };
    Command { target, rig: Rig::bare(), speed, duration: None, zone, line: 1 }
}

fn start(robot: &Arc<Robot>) -> (Queue, [f64; 6]) {
    let start = Joints { axes: START, external: [UNSET; 6] };
    (Queue::repeatable(robot.clone(), start), frame_components(&robot.kinematics.forward(&START)))
}

/// What a chain took once.
struct Run {
    /// us of processor time for all of the planning, and for each cycle.
    planning: f64,
    cycles: Vec<f64>,
    /// mm/s in each cycle.
    speeds: Vec<f64>,
}

/// The least of several runs: what a motion or a cycle costs but for what else the machine does. Every run does the
/// same, so the least that a cycle took in any of them is what it costs.
fn least(robot: &Arc<Robot>, chain: &Chain, count: usize) -> Result<Run, Box<dyn Error>> {
    let mut least = once(robot, chain, count)?;
    for _ in 1..REPEATS {
        let next = once(robot, chain, count)?;
        if next.speeds != least.speeds {
            return Err("two runs of the same motions differ".into());
        }
        least.planning = least.planning.min(next.planning);
        least.cycles.iter_mut().zip(next.cycles).for_each(|(cycle, next)| *cycle = cycle.min(next));
    }
    Ok(least)
}

fn once(robot: &Arc<Robot>, chain: &Chain, count: usize) -> Result<Run, Box<dyn Error>> {
    let (mut queue, origin) = start(robot);
    let zone = Zone { percent: 100.0, ..Zone::NONE };
    let (mut next, mut planning) = (0, 0.0);
    let (mut cycles, mut speeds): (Vec<f64>, Vec<f64>) = (Vec::new(), Vec::new());
    let mut before = queue.tcp().translation.vector;
    while next < count || !queue.idle() {
        // The threads beside the cycle have the time that they have on a robot.
        let end = Instant::now() + Duration::from_secs_f64(CYCLE);
        let begin = processor_time();
        while next < count && queue.takes(0) {
            next += 1;
            let command = command(&origin, (chain.point)(next as f64), chain.axes, zone, chain.speed);
            queue.add(&command, &Settings::default())?;
        }
        let middle = processor_time();
        let step = queue.step(Cycle::MS, Override::FULL);
        cycles.push((processor_time() - middle).as_secs_f64() * 1e6);
        planning += (middle - begin).as_secs_f64() * 1e6;
        let at = step.tcp.translation.vector;
        speeds.push((at - before).norm() / CYCLE);
        before = at;
        std::thread::sleep(end.saturating_duration_since(Instant::now()));
    }
    Ok(Run { planning, cycles, speeds })
}

fn run(robot: &Arc<Robot>, chain: &Chain, count: usize) -> Result<(), Box<dyn Error>> {
    let Run { planning, mut cycles, mut speeds } = least(robot, chain, count)?;
    let quick = speeds.iter().filter(|speed| **speed >= 0.99 * chain.speed).count();
    cycles.sort_by(f64::total_cmp);
    speeds.sort_by(f64::total_cmp);
    let at =
        |sorted: &[f64], share: f64| sorted.get((sorted.len() as f64 * share) as usize).copied().unwrap_or(f64::NAN);
    println!(
        "{:<10} {:>10} {:>14.1} {:>9.1} % {:>10.2} {:>6.2} {:>6.2} {:>6.2} {:>7.1}",
        chain.name,
        chain.speed,
        at(&speeds, 0.5),
        100.0 * quick as f64 / speeds.len() as f64,
        planning / count as f64,
        at(&cycles, 0.5),
        at(&cycles, 0.99),
        at(&cycles, 0.999),
        cycles.last().copied().unwrap_or(f64::NAN),
    );
    Ok(())
}
