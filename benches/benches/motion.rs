//! Chains of blended motions: how near they come to the programmed speed, what planning a motion takes and what a cycle.
//!
//! `cargo bench -p arl-benches --bench motion [-- MOTIONS [CHAIN...]]`

use std::error::Error;
use std::f64::consts::TAU;
use std::sync::Arc;

use arl_benches::statistics::processor_time;
use arl_rt::frames::Rig;
use arl_rt::kinematics::{Frame, frame_components};
use arl_rt::motion::{Command, Joints, Queue, Settings, Speed, Target, UNSET, Zone};
use arl_rt::robot::Robot;

const CYCLE: f64 = 0.001;
/// How often everything is run.
const REPEATS: usize = 5;
/// Where the paths begin.
const START: [f64; 6] = [0.0, -90.0, 90.0, 0.0, 45.0, 0.0];

/// A path of points, and how it is moved along.
struct Chain {
    name: &'static str,
    /// The point of each index, in mm from the start, or in deg of the axes.
    point: fn(usize) -> [f64; 3],
    axes: bool,
    /// The programmed speed in mm/s.
    speed: f64,
    /// The robot reaches no more points than these.
    most: usize,
}

/// Points on a circle of 100 mm radius, 0.1 mm apart.
fn circle(index: usize) -> [f64; 3] {
    let (sine, cosine) = (index as f64 * 0.001).sin_cos();
    [0.0, 100.0 * sine, 100.0 - 100.0 * cosine]
}

/// A line, 0.1 mm a point.
fn line(index: usize) -> [f64; 3] {
    [0.0, index as f64 * 0.1, 0.0]
}

/// A spiral from 20 to 150 mm radius.
fn spiral(index: usize) -> [f64; 3] {
    // The way goes with the square of the angle.
    let turns = (index as f64 * 0.1 / (TAU * 2.0) + 100.0).sqrt();
    let (sine, cosine) = (turns * TAU).sin_cos();
    let radius = 2.0 * turns;
    [0.0, radius * cosine - 20.0, radius * sine]
}

/// Waves of changing curvature, like a path out of a computer-aided design.
fn waves(index: usize) -> [f64; 3] {
    let at = index as f64 * 0.1 / 60.0;
    [20.0 * at.sin(), 120.0 * (at * 0.31).sin(), 40.0 * (at * 0.47).sin()]
}

/// Corners of 90 deg, 20 mm apart.
fn corners(index: usize) -> [f64; 3] {
    let steps = |index: usize| (index % 32) as f64 * 10.0;
    let across = if index % 4 == 1 || index % 4 == 2 { 20.0 } else { 0.0 };
    [0.0, steps(index / 2 * 2), across]
}

/// Three axes, each in its own rhythm.
fn axes(index: usize) -> [f64; 3] {
    let at = index as f64 * 0.01;
    [30.0 * at.sin(), 10.0 * (at * 0.7).sin(), 20.0 * (1.3 * at).sin()]
}

const CHAINS: [Chain; 6] = [
    Chain { name: "line", point: line, axes: false, speed: 1000.0, most: 6000 },
    Chain { name: "circle", point: circle, axes: false, speed: 1000.0, most: usize::MAX },
    Chain { name: "spiral", point: spiral, axes: false, speed: 300.0, most: usize::MAX },
    Chain { name: "waves", point: waves, axes: false, speed: 500.0, most: usize::MAX },
    Chain { name: "corners", point: corners, axes: false, speed: 500.0, most: usize::MAX },
    Chain { name: "axes", point: axes, axes: true, speed: 30.0, most: usize::MAX },
];

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).filter(|word| !word.starts_with('-')).collect();
    let count = words.iter().find_map(|word| word.parse::<usize>().ok()).unwrap_or(20_000);
    let names: Vec<&String> = words.iter().filter(|word| word.parse::<usize>().is_err()).collect();
    let robot = Arc::new(Robot::builtin("kr10-r1420")?);
    println!(
        "{count} motions each (the line at most 6000), percent zones of 100 %; planning: us a motion; cycles: us of processor time, the least of {REPEATS} runs"
    );
    println!("chain      programmed  in the middle  above 99 %   planning    p50    p99  p99.9    most");
    for chain in CHAINS {
        if names.is_empty() || names.iter().any(|name| *name == chain.name) {
            run(&robot, &chain, count.min(chain.most))?;
        }
    }
    println!();
    println!("two lines of 300 mm at 1000 mm/s: s with a stop, and with zones of so many mm");
    print!("angle   stop");
    for zone in ZONES {
        print!("{zone:>8}");
    }
    println!();
    for angle in [10.0, 30.0, 60.0, 90.0, 120.0, 150.0, 175.0] {
        print!("{angle:>5}");
        for zone in [-1.0].into_iter().chain(ZONES) {
            print!("  {:.3} ", corner(&robot, angle, zone)?);
        }
        println!();
    }
    Ok(())
}

const ZONES: [f64; 8] = [0.5, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 150.0];

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
    (Queue::new(robot.clone(), start), frame_components(&robot.kinematics.forward(&START)))
}

/// What a chain took once.
struct Run {
    /// us of processor time for all of the planning, and for each cycle.
    planning: f64,
    cycles: Vec<f64>,
    /// mm/s in each cycle.
    speeds: Vec<f64>,
}

/// The least of several runs: what a motion or a cycle costs but for what else the machine does. Every run does the same, so the
/// least that a cycle took in any of them is what it costs.
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
        let begin = processor_time();
        while next < count && queue.has_room() {
            next += 1;
            let command = command(&origin, (chain.point)(next), chain.axes, zone, chain.speed);
            queue.add(&command, &Settings::default())?;
        }
        let middle = processor_time();
        let step = queue.step(CYCLE, 100.0);
        cycles.push((processor_time() - middle).as_secs_f64() * 1e6);
        planning += (middle - begin).as_secs_f64() * 1e6;
        let at = step.tcp.translation.vector;
        speeds.push((at - before).norm() / CYCLE);
        before = at;
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

/// How long two lines take with a corner between them.
fn corner(robot: &Arc<Robot>, angle: f64, zone: f64) -> Result<f64, Box<dyn Error>> {
    let (mut queue, origin) = start(robot);
    let (sine, cosine) = f64::to_radians(angle).sin_cos();
    let points = [[0.0, 300.0, 0.0], [0.0, 300.0 + 300.0 * cosine, -300.0 * sine]];
    for point in points {
        let zone = Zone { tcp: zone, ..Zone::NONE };
        queue.add(&command(&origin, point, false, zone, 1000.0), &Settings::default())?;
    }
    let mut cycles = 0;
    while !queue.idle() {
        queue.step(CYCLE, 100.0);
        cycles += 1;
    }
    Ok(f64::from(cycles) * CYCLE)
}
