//! Chains of short motions: how near the robot comes to the shortest time on the curve that the points lie on, what a
//! motion takes to plan, and what a cycle takes.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;

use arl_benches::chains::{CHAINS, Chain};
use arl_benches::statistics::{processor_time, time};
use arl_rt::kinematics::Axes;
use arl_rt::motion::{Command, Cycle, Override, Settings, Zone};
use arl_rt::robot::{Robot, VelocityProfile};
use nalgebra::Vector3;

use crate::Rows;
use crate::executed::{CYCLE, START, Track, duration, execute, lines, movej, queue};
use crate::path::Path;
use crate::table::{Goal, Row};

/// Runs of a chain, which all do the same: what a cycle took at least is what it takes.
const RUNS: usize = 3;
/// Places of a chain's curve, and samples of it for each motion.
const PLACES: usize = 1000;
const SAMPLES: usize = 2;
/// The path that is followed is sampled every so many mm; each motion has so many places.
const SAMPLING: f64 = 0.01;
const PLACES_A_MOTION: usize = 16;

pub(crate) fn rows() -> Rows {
    let robot = Arc::new(Robot::builtin("kr10-r1420")?);
    println!();
    println!(
        "dense: chains of short motions of kr10-r1420, zones of 100 %; s of its time; planning: us a motion in profile S,"
    );
    println!(
        "cycles: us in profile S; TOPP2, TOPP3: copp on the smooth curve that the points lie on, solver: ours; path: our"
    );
    println!("solver on the path that is followed, which shows what its geometry costs");
    println!(
        "chain    motions  mm/s, %   TOPP2       T    TOPP3  solver    path       S       O  planning    p50    p99  p99.9   most"
    );
    let (mut slowest_planning, mut slowest_cycle) = (0.0_f64, 0.0_f64);
    for chain in &CHAINS {
        let [second, third, solver] = match curve(&robot, chain)? {
            Some(curve) => {
                let path = path(&robot, chain, &curve, PLACES);
                let settled = path.topp3().map(|[_, settled]| settled);
                [path.topp2()?.duration, settled.map_or(f64::NAN, |timed| timed.duration), path.ours(true)?.duration]
            }
            None => [f64::NAN; 3],
        };
        let followed =
            Track::followed(&robot, commands(&robot, chain), &Settings::default(), (SAMPLING, chain.speed.max(300.0)))?;
        let same = path(&robot, chain, &followed, PLACES_A_MOTION * chain.enough).ours(true)?.duration;
        let taken = |profile| duration(&robot, commands(&robot, chain), &Settings { profile, ..Settings::default() });
        let [t, s, o] = [taken(VelocityProfile::T)?, taken(VelocityProfile::S)?, taken(VelocityProfile::O)?];
        let load = Load::least(&robot, chain)?;
        println!(
            "{:<8} {:>7} {:>8} {second:>7.3} {t:>7.3} {third:>8.3} {solver:>7.3} {same:>7.3} {s:>7.3} {o:>7.3} {:>9.2} \
             {:>6.2} {:>6.2} {:>6.2} {:>6.1}",
            chain.name,
            chain.enough,
            chain.speed,
            load.planning,
            load.share(0.5),
            load.share(0.99),
            load.share(0.999),
            load.share(1.0),
        );
        if chain.smooth && !chain.axes {
            slowest_planning = slowest_planning.max(load.planning);
        }
        slowest_cycle = slowest_cycle.max(load.share(0.999));
    }
    let mut rows = Vec::new();
    for (name, profile) in [("T", VelocityProfile::T), ("S", VelocityProfile::S), ("O", VelocityProfile::O)] {
        let share = share_of_speed(&robot, profile)?;
        let job = format!("0.1 mm segments at 1 m/s, profile {name}: share of the speed");
        rows.push(Row::alone(job, share, "", Goal::AtLeast(0.99)));
    }
    rows.extend([
        Row::alone("0.1 mm segments planned, slowest chain", 1e6 / slowest_planning, "/s", Goal::AtLeast(2e5)),
        Row::alone("interpolation cycle, 99.9 %, slowest chain of all", slowest_cycle, "us", Goal::AtMost(10.0)),
    ]);
    Ok(rows)
}

/// What solvers are asked about a way of a chain.
fn path(robot: &Robot, chain: &Chain, track: &Track, count: usize) -> Path {
    let places: Vec<f64> = (0..count).map(|index| track.length() * index as f64 / (count - 1) as f64).collect();
    if chain.axes { track.axes_path(robot, &places, chain.speed) } else { track.path(robot, &places, chain.speed) }
}

fn commands(robot: &Robot, chain: &Chain) -> Vec<Command> {
    some_commands(robot, chain, chain.enough)
}

fn some_commands(robot: &Robot, chain: &Chain, count: usize) -> Vec<Command> {
    let zone = Zone { percent: 100.0, ..Zone::NONE };
    let points = (1..=count).map(|index| (chain.point)(index as f64));
    if chain.axes {
        return points.map(|point| movej(&beside(point), zone, chain.speed)).collect();
    }
    lines(robot, points, zone, chain.speed).collect()
}

/// The axes so many deg from the start.
fn beside([j1, j2, j3]: [f64; 3]) -> Axes {
    let [a, b, c, rest @ ..] = START;
    let [d, e, f] = rest;
    [a + j1, b + j2, c + j3, d, e, f]
}

/// The smooth curve that the points of a chain lie on, where there is one.
fn curve(robot: &Robot, chain: &Chain) -> Result<Option<Track>, Box<dyn Error>> {
    if !chain.smooth {
        return Ok(None);
    }
    let mut track = Track::new(SAMPLING);
    let start = robot.kinematics.forward(&START);
    let mut axes = START;
    for sample in 0..=chain.enough * SAMPLES {
        let point = (chain.point)(sample as f64 / SAMPLES as f64);
        if chain.axes {
            axes = beside(point);
            track.push(&axes, &robot.kinematics.forward(&axes).translation.vector);
        } else {
            let mut frame = start;
            frame.translation.vector += Vector3::from(point);
            axes = robot.kinematics.inverse(&frame, robot.kinematics.cfg(&START), &axes).ok_or("out of reach")?;
            track.push(&axes, &frame.translation.vector);
        }
    }
    Ok(Some(track))
}

/// How much of the programmed speed a line of short motions has, in the mean, between where one long motion is done
/// speeding up and where it begins to slow down.
fn share_of_speed(robot: &Arc<Robot>, profile: VelocityProfile) -> Result<f64, Box<dyn Error>> {
    let [chain, ..] = &CHAINS;
    let settings = Settings { profile, ..Settings::default() };
    let distances = |commands: Vec<Command>| -> Result<Vec<f64>, Box<dyn Error>> {
        let mut distances = Vec::new();
        let mut first = None;
        execute(robot, commands, &settings, Override::FULL, |_, tcp| {
            let start = *first.get_or_insert(*tcp);
            distances.push((tcp - start).norm());
        })?;
        Ok(distances)
    };
    let most = chain.most;
    let end = [(chain.point)(most as f64)];
    let single = distances(lines(robot, end, Zone::NONE, chain.speed).collect())?;
    let full = |pair: &[f64]| (pair[1] - pair[0]) / CYCLE >= 0.999 * chain.speed;
    let from = single.windows(2).find(|pair| full(pair)).ok_or("too short for its speed")?[0];
    let to = single.windows(2).rfind(|pair| full(pair)).ok_or("too short for its speed")?[1];
    let short = distances(some_commands(robot, chain, most))?;
    let when = |distance: f64| short.partition_point(|gone| *gone < distance);
    let (first, last) = (when(from), when(to));
    Ok((short[last] - short[first]) / ((last - first) as f64 * CYCLE) / chain.speed)
}

/// What a chain takes of the processor, in us: planning a motion, and each cycle.
struct Load {
    planning: f64,
    cycles: Vec<f64>,
}

impl Load {
    fn least(robot: &Arc<Robot>, chain: &Chain) -> Result<Self, Box<dyn Error>> {
        let mut least = Self::of_one_run(robot, chain)?;
        for _ in 1..RUNS {
            let next = Self::of_one_run(robot, chain)?;
            least.planning = least.planning.min(next.planning);
            least.cycles.iter_mut().zip(next.cycles).for_each(|(least, next)| *least = least.min(next));
        }
        least.cycles.sort_by(f64::total_cmp);
        Ok(least)
    }

    fn of_one_run(robot: &Arc<Robot>, chain: &Chain) -> Result<Self, Box<dyn Error>> {
        let commands = commands(robot, chain);
        let mut queue = queue(robot);
        let (mut next, mut planning) = (0, 0.0);
        let mut cycles = Vec::new();
        while next < commands.len() || !queue.idle() {
            let begin = processor_time();
            while next < commands.len() && queue.has_room() {
                queue.add(&commands[next], &Settings::default())?;
                next += 1;
            }
            planning += (processor_time() - begin).as_secs_f64() * 1e6;
            cycles.push(
                time(|| {
                    black_box(queue.step(Cycle::MS, Override::FULL));
                }) * 1e6,
            );
        }
        Ok(Self { planning: planning / commands.len() as f64, cycles })
    }

    /// What so many of the cycles do not go beyond.
    fn share(&self, share: f64) -> f64 {
        let last = self.cycles.len().saturating_sub(1);
        self.cycles.get(((self.cycles.len() as f64 * share) as usize).min(last)).copied().unwrap_or(f64::NAN)
    }
}
