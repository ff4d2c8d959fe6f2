//! Properties of motion, from the sampled trace alone.

mod blends;
mod carried;
mod chained_overlays;
mod chained_paths;
mod chains;
mod compensations;
mod dense_chains;
mod gates;
mod optimal;
mod plans;
mod prepared;
mod previews;
mod real_time;
mod records;
mod refusals;
mod short_stops;
mod singular;
mod steps;
mod stops;
mod suspensions;
mod traces;
mod unblended;
mod weaves;
mod wrist;

use std::sync::Arc;

use crate::*;
use arl_robot::frames::{Carried, Rig};
use arl_robot::kinematics::random::Random;
use arl_robot::kinematics::{Frame, Wanted, frame, frame_components};
use arl_robot::robot::{ROBOT_AXES, Robot, VelocityProfile};

const CYCLE: f64 = 0.001;

/// An override in percent.
fn at(percent: f64) -> Override {
    Override::from_percent(percent).unwrap()
}

fn robot(name: &str) -> Arc<Robot> {
    Arc::new(Robot::builtin(name).unwrap())
}

/// Whether a motion came too late, since this was asked last, to be blended with the one before it.
fn was_late(queue: &mut Queue) -> bool {
    queue.take_unblended().iter().any(|target| target.why == NoBlend::Late)
}

/// The robot with a turning and a linear external axis.
fn with_external_axes(name: &str) -> Arc<Robot> {
    let axis = |name: &str, linear: bool, max: f64| {
        let range = format!("name = \"{name}\"\nlinear = {linear}\nmin = -{max}\nmax = {max}\n");
        format!("[[axis]]\n{range}vel = 900\nacc = 3000\njerk = 30000\n")
    };
    let text = Robot::text(name).unwrap().to_owned() + &axis("ej1", false, 720.0) + &axis("ej2", true, 1500.0);
    Arc::new(Robot::parse("with external axes", &text).unwrap())
}

pub(crate) fn axes(axes: [f64; 6]) -> Joints {
    Joints { axes, external: [UNSET; 6] }
}

fn fast() -> Speed {
    Speed { percent: 100.0, tcp: 1e4, ori: 1e4, exj: 1e4, exl: 1e4 }
}

pub(crate) fn command(target: Target) -> Command {
    Command { target, rig: Rig::bare(), speed: fast(), duration: None, zone: Zone::NONE, line: 7 }
}

fn movej(to: [f64; 6]) -> Command {
    command(Target::Joints(axes(to)))
}

fn lin(pose: [f64; 6]) -> Command {
    command(Target::Line { pose, wobj: Frame::identity(), external: [UNSET; 6] })
}

fn ptp(pose: [f64; 6], cfg: u8) -> Command {
    let wanted = Wanted { cfg: Some(cfg), turn: -1 };
    command(Target::Pose { pose, wobj: Frame::identity(), wanted, external: [UNSET; 6] })
}

/// All values of a joint vector that the robot has, in the order of its axes.
fn values(robot: &Robot, joints: &Joints) -> Vec<f64> {
    let own = robot.own_axes().len();
    joints.axes.iter().take(own).chain(joints.external.iter().take(robot.external_axes().len())).copied().collect()
}

/// The row of a robot that rests before its first motion.
fn resting(queue: &Queue) -> Step {
    Step::resting(*queue.joints(), queue.tcp())
}

/// Runs until the queue is idle; the first row is where it starts.
fn run(queue: &mut Queue, percent: f64) -> Vec<Step> {
    let mut rows = vec![resting(queue)];
    while !queue.idle() {
        rows.push(queue.step(Cycle::MS, at(percent)));
        assert!(rows.len() < 2_000_000, "it does not end");
    }
    rows
}

/// The most that the trace uses of each axis's speed, acceleration and jerk, as shares of the limits.
fn usage(robot: &Robot, rows: &[Step]) -> [f64; 3] {
    let still = 4;
    let mut table: Vec<Vec<f64>> = Vec::new();
    for row in rows.iter().take(1).cycle().take(still).chain(rows).chain(rows.iter().rev().take(1).cycle().take(still))
    {
        table.push(values(robot, &row.joints));
    }
    let mut used = [0.0_f64; 3];
    for (index, axis) in robot.axes.iter().enumerate() {
        let mut series: Vec<f64> = table.iter().map(|row| row[index]).collect();
        for (used, most) in used.iter_mut().zip([axis.vel, axis.acc, axis.jerk]) {
            series = series.windows(2).map(|pair| (pair[1] - pair[0]) / CYCLE).collect();
            let highest = series.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
            *used = used.max(highest / most);
        }
    }
    used
}

/// The rows from where the robot sets off up to the last one.
fn after_start(rows: &[Step]) -> &[Step] {
    let start = rows.iter().position(|row| !row.rests).unwrap();
    assert!(start < 8, "it sets off after {start} cycles");
    &rows[start..rows.len() - 1]
}

fn assert_within_limits(robot: &Robot, rows: &[Step], what: &str) {
    assert_within_limits_of(robot, rows, VelocityProfile::S, what);
}

/// The same in any profile: T has no limit of jerk.
fn assert_within_limits_of(robot: &Robot, rows: &[Step], profile: VelocityProfile, what: &str) {
    let used = usage(robot, rows);
    let counts = if profile == VelocityProfile::T { 2 } else { 3 };
    let keeps = used.iter().take(counts).all(|used| *used <= 1.01);
    assert!(keeps, "{what}: speed, acceleration, jerk used {used:?}");
    for row in rows {
        for (value, axis) in values(robot, &row.joints).iter().zip(&robot.axes) {
            assert!(*value >= axis.min - 1e-5 && *value <= axis.max + 1e-5, "{what}: {} at {value}", axis.name);
        }
    }
}

/// Distance in mm of a point from the line through two others, and the angle in rad that the rotation at the same share
/// of the way would have to be off.
fn off_line(start: &Frame, end: &Frame, at: &Frame) -> (f64, f64) {
    let travel = end.translation.vector - start.translation.vector;
    let here = at.translation.vector - start.translation.vector;
    let length = travel.norm_squared();
    let share = if length > 1e-12 { (here.dot(&travel) / length).clamp(0.0, 1.0) } else { 0.0 };
    let rotation = start.rotation.slerp(&end.rotation, share);
    ((here - travel * share).norm(), if length > 1.0 { rotation.angle_to(&at.rotation) } else { 0.0 })
}

/// A random joint vector inside the middle part of all ranges.
fn random_joints(robot: &Robot, random: &mut Random, part: f64) -> Joints {
    let mut joints = Joints::home(robot);
    let own = robot.own_axes().len();
    for (index, axis) in robot.axes.iter().enumerate() {
        let (middle, half) = ((axis.min + axis.max) / 2.0, (axis.max - axis.min) / 2.0 * part);
        let value = random.between(middle - half, middle + half);
        if index < own { joints.axes[index] = value } else { joints.external[index - own] = value }
    }
    joints
}

/// A queue of ten motions of all kinds with all kinds of zones.
fn random_chain(robot: &Arc<Robot>, random: &mut Random, settings: &Settings) -> Queue {
    let mut queue = Queue::repeatable(robot.clone(), random_joints(robot, random, 0.5));
    let (mut added, mut tried) = (0_u32, 0);
    while added < 10 && tried < 400 {
        tried += 1;
        let end = *queue.end();
        let goal = random_joints(robot, random, 0.5);
        let mut pose = frame_components(&robot.kinematics.forward(&end.axes));
        for (index, value) in pose.iter_mut().enumerate() {
            *value += if index < 3 { random.between(-150.0, 150.0) } else { random.between(-20.0, 20.0) };
        }
        let external = goal.external;
        let wobj = Frame::identity();
        let target = match (random.between(0.0, 4.0)) as u32 {
            0 => Target::Joints(goal),
            1 => Target::Pose { pose, wobj, wanted: Wanted { cfg: None, turn: -1 }, external },
            2 => Target::Line { pose, wobj, external },
            _ => {
                let here = robot.kinematics.forward(&end.axes).translation.vector;
                let via = [0, 1, 2].map(|i| (here[i] + pose[i]) / 2.0 + random.between(-60.0, 60.0));
                Target::Arc { via, pose, wobj, angle: None, follow: false, external }
            }
        };
        let size = random.between(1.0, 60.0);
        let zone = match random.between(0.0, 5.0) as u32 {
            0 => Zone::NONE,
            1 => Zone { percent: size, ..Zone::NONE },
            2 => Zone { tcp: size, ..Zone::NONE },
            3 => Zone { tcp: UNSET, ori: size / 3.0, joint: size / 3.0, ..Zone::NONE },
            _ => Zone { tcp: size, joint: size / 3.0, ori: size, turning: 5.0, linear: 20.0, ..Zone::NONE },
        };
        let speed = Speed {
            percent: random.between(5.0, 100.0),
            tcp: random.between(20.0, 1500.0),
            ori: random.between(20.0, 400.0),
            exj: random.between(20.0, 500.0),
            exl: random.between(20.0, 500.0),
        };
        let command = Command { target, zone, speed, line: added + 1, ..movej([0.0; 6]) };
        if queue.add(&command, settings).is_ok() {
            added += 1;
        }
    }
    assert!(added == 10, "{added} of {tried}");
    queue
}
