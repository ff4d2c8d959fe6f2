//! From rest to rest with limits of jerk: how long planning a motion of the axes takes and how long the motion, beside
//! rsruckig.

use std::error::Error;
use std::hint::black_box;
use std::sync::Arc;

use arl_benches::random::Random;
use arl_benches::statistics::taking_turns;
use arl_rt::kinematics::Axes;
use arl_rt::motion::{Command, Cycle, Joints, Override, Queue, Settings, Zone, plan};
use arl_rt::robot::{Robot, RobotError, VelocityProfile};
use rsruckig::prelude::*;

use crate::Rows;
use crate::executed::{CYCLE, joints, movej};
use crate::kinematics::{ROBOTS, random_axes};
use crate::table::{Goal, Row};

const RUCKIG: &str = "rsruckig 3.0";
/// Motions of each robot that are timed, that are compared, and that are executed.
const TIMED: usize = 1000;
const COMPARED: usize = 5000;
const EXECUTED: usize = 100;
const ROUNDS: usize = 30;

pub(crate) fn rows() -> Rows {
    let (mut ours, mut theirs) = (0.0, 0.0);
    let (mut apart, mut straight_apart) = (0.0_f64, 0.0_f64);
    let (mut excess, mut count) = (0.0, 0.0);
    let mut cycles = [(0.0, 0.0_f64); 3];
    for (seed, name) in ROBOTS.into_iter().enumerate() {
        let robot = Arc::new(Robot::builtin(name)?);
        let mut random = Random::new(100 + seed as u64);
        let moves: Vec<[Axes; 2]> = (0..COMPARED).map(|_| random_move(&robot, &mut random)).collect();
        for [from, to] in &moves {
            let planned = planned(&robot, from, to)?;
            apart = apart.max((planned / ruckig(&robot, from, to)? - 1.0).abs());
        }
        // Limits that are not in proportion to each other: the straight way in the axes is then bound by different axes
        // at different times, and takes longer than axes that only arrive together.
        let uneven = uneven(&robot, &mut random)?;
        for [from, to] in &moves {
            let planned = planned(&uneven, from, to)?;
            straight_apart = straight_apart.max((planned / straight(&uneven, from, to)? - 1.0).abs());
            excess += planned / ruckig(&uneven, from, to)?;
            count += 1.0;
        }
        for (profile, (sum, most)) in
            [VelocityProfile::T, VelocityProfile::S, VelocityProfile::O].into_iter().zip(&mut cycles)
        {
            for [from, to] in moves.iter().take(EXECUTED) {
                let shortest = match profile {
                    VelocityProfile::T => calculate(&without_jerk(input(&robot, from, to)))?,
                    _ => ruckig(&robot, from, to)?,
                };
                let late = executed(&robot, from, to, profile)? - shortest;
                *sum += late / (EXECUTED * ROBOTS.len()) as f64;
                *most = most.max(late);
            }
        }
        let times = measure(&robot, &moves[..TIMED]);
        ours += times.0 * 1e6 / (TIMED * ROBOTS.len()) as f64;
        theirs += times.1 * 1e6 / (TIMED * ROBOTS.len()) as f64;
    }
    println!();
    println!(
        "changes: movej of {} robots between random positions, {COMPARED} each; ours is all of planning",
        ROBOTS.len()
    );
    println!(
        "limits that are not in proportion to each other: {:.3} of the duration of rsruckig, whose axes leave the straight \
         way between the positions, in the mean",
        excess / count
    );
    for (name, (mean, most)) in ["T", "S", "O"].into_iter().zip(cycles) {
        println!(
            "profile {name}: executed {:.2} ms longer than the shortest in the mean, {:.2} at most",
            mean * 1e3,
            most * 1e3
        );
    }
    let same = |job, apart| Row { reference: RUCKIG, ..Row::alone(job, apart, "", Goal::AtMost(1e-9)) };
    Ok(vec![
        Row::beside("rest to rest, 6 axes: planning", RUCKIG, (theirs, ours), "us", 0.25),
        same("rest to rest: difference of durations", apart),
        same("the same on the straight way, uneven limits", straight_apart),
    ])
}

fn measure(robot: &Robot, moves: &[[Axes; 2]]) -> (f64, f64) {
    let commands: Vec<(Joints, Command)> =
        moves.iter().map(|[from, to]| (joints(from), movej(to, Zone::NONE, 100.0))).collect();
    let settings = Settings::default();
    let inputs: Vec<_> = moves.iter().map(|[from, to]| input(robot, from, to)).collect();
    let mut solver = Ruckig::<6, ThrowErrorHandler>::new(None, CYCLE);
    let mut trajectory = Trajectory::new(None);
    let ours = || {
        for (from, command) in &commands {
            let _ = black_box(plan(robot, black_box(from), command, &settings).map(|motion| motion.duration()));
        }
    };
    let theirs = || {
        for input in &inputs {
            let _ = black_box(solver.calculate(black_box(input), &mut trajectory));
        }
    };
    taking_turns(ROUNDS, ours, theirs)
}

fn planned(robot: &Robot, from: &Axes, to: &Axes) -> Result<f64, Box<dyn Error>> {
    Ok(plan(robot, &joints(from), &movej(to, Zone::NONE, 100.0), &Settings::default())?.duration())
}

fn executed(robot: &Arc<Robot>, from: &Axes, to: &Axes, profile: VelocityProfile) -> Result<f64, Box<dyn Error>> {
    let mut queue = Queue::repeatable(robot.clone(), joints(from));
    queue.add(&movej(to, Zone::NONE, 100.0), &Settings { profile, ..Settings::default() })?;
    let mut cycles = 0.0;
    while !queue.idle() {
        queue.step(Cycle::MS, Override::FULL);
        cycles += 1.0;
    }
    Ok(cycles * CYCLE)
}

/// The shortest time in which all axes arrive together.
fn ruckig(robot: &Robot, from: &Axes, to: &Axes) -> Result<f64, Box<dyn Error>> {
    calculate(&input(robot, from, to))
}

/// The shortest time on the straight way: one degree of freedom with the lowest limits.
fn straight(robot: &Robot, from: &Axes, to: &Axes) -> Result<f64, Box<dyn Error>> {
    let mut input = InputParameter::<1>::new(None);
    input.target_position[0] = 1.0;
    let mut limits = [f64::INFINITY; 3];
    for ((axis, from), to) in robot.own_axes().iter().zip(from).zip(to) {
        for (lowest, limit) in limits.iter_mut().zip([axis.vel, axis.acc, axis.jerk]) {
            *lowest = lowest.min(limit / (to - from).abs());
        }
    }
    (input.max_velocity[0], input.max_acceleration[0], input.max_jerk[0]) = (limits[0], limits[1], limits[2]);
    calculate(&input)
}

fn calculate<const N: usize>(input: &InputParameter<N>) -> Result<f64, Box<dyn Error>> {
    let mut trajectory = Trajectory::new(None);
    let mut solver = Ruckig::<N, ThrowErrorHandler>::new(None, CYCLE);
    solver.calculate(input, &mut trajectory).map_err(|error| format!("{error:?}"))?;
    Ok(trajectory.get_duration())
}

/// rsruckig's problem for a robot, in rad; from rest to rest.
pub(crate) fn input(robot: &Robot, from: &Axes, to: &Axes) -> InputParameter<6> {
    let mut input = InputParameter::new(None);
    for (index, axis) in robot.own_axes().iter().enumerate() {
        input.current_position[index] = from[index].to_radians();
        input.target_position[index] = to[index].to_radians();
        input.max_velocity[index] = axis.vel.to_radians();
        input.max_acceleration[index] = axis.acc.to_radians();
        input.max_jerk[index] = axis.jerk.to_radians();
    }
    input
}

/// Two positions of the axes, anywhere from far apart to close together.
fn random_move(robot: &Robot, random: &mut Random) -> [Axes; 2] {
    let (from, to) = (random_axes(robot, random), random_axes(robot, random));
    let share = 10.0_f64.powf(random.between(-3.0, 0.0));
    let mut near = from;
    near.iter_mut().zip(to).for_each(|(axis, to)| *axis += (to - *axis) * share);
    [from, near]
}

/// The robot with acceleration from 2 to 10 times the speed, and jerk from 20 to 200 times.
fn uneven(robot: &Robot, random: &mut Random) -> Result<Robot, RobotError> {
    let mut uneven = robot.clone().into_description();
    for axis in &mut uneven.axes {
        axis.acc = axis.vel * random.between(2.0, 10.0);
        axis.jerk = axis.vel * random.between(20.0, 200.0);
    }
    Robot::new(uneven)
}

fn without_jerk(mut input: InputParameter<6>) -> InputParameter<6> {
    input.max_jerk.iter_mut().for_each(|jerk| *jerk = f64::INFINITY);
    input
}
