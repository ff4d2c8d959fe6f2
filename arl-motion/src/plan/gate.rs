//! Gates: straight up, over, and straight down to the target, with rounded corners.
//!
//! A gate is three axis motions in a row under one number. It rises by `rise` before anything else moves, and by as
//! much again while it goes over already; on the other side the same with `sink`. Where the highest place that is
//! allowed leaves no room for the second half, the corner is a right angle, in which the robot stops.
//!
//! How much of the way over a corner takes depends on what is programmed for both, not on the override.

use crate::command::error::PlanError;
use crate::command::joints::{Joints, is_unset};
use crate::command::{Command, Gate, LARGEST_ZONE, Lift, Settings, Speed, Target, Zone};
use crate::limits::profile::{Limits, State};
use crate::plan::motion::{CornerEnd, GivenCorner, Motion};
use crate::plan::planner::Planner;
use arl_robot::kinematics::Kinematics;
use arl_robot::robot::Robot;

/// The axis that lifts.
const LIFT_AXIS: usize = 2;
/// Ways up to this, in mm, are none.
const NO_DISTANCE_MM: f64 = 1e-6;
/// How much of the way over a corner may take.
const LARGEST_CORNER_SHARE: f64 = 0.5;
/// An acceleration of the form of a corner takes so many s to rise at least, also without a limit of the jerk.
const LEAST_RISE_S: f64 = 0.004;
/// The part of the way down that a corner leaves to stop in, whatever is asked for.
const STOPPING_SHARE: f64 = 0.02;
/// The zone of a gate that goes on without a stop, in percent of the largest.
const SMOOTH_ZONE_PERCENT: f64 = 25.0;

/// Plans the motions of a gate, one behind the other; all but the last one are parts of it.
pub(crate) fn plan(
    robot: &Robot,
    start: &Joints,
    command: &Command,
    settings: &Settings,
) -> Result<Vec<Motion>, PlanError> {
    let Target::Gate { pose, wobj, wanted, external, gate } = &command.target else {
        return Err(PlanError::NotForThisRobot);
    };
    let (Kinematics::Scara(_), Some(lift)) = (&robot.kinematics, robot.axes.get(LIFT_AXIS)) else {
        return Err(PlanError::NotForThisRobot);
    };
    if [gate.rise, gate.sink].iter().any(|way| !way.is_finite() || *way < 0.0 || is_unset(*way)) {
        return Err(PlanError::NotANumber);
    }
    let planner = Planner { robot, start, command, settings };
    let end = planner.choose(pose, wobj, *wanted, external)?;
    let (from, to) = (height(start), height(&end));
    let top = top(&planner, gate, from, to, lift.max)?;
    let stays = at(start, top).all().iter().zip(at(&end, top).all()).all(|(a, b)| (a - b).abs() < NO_DISTANCE_MM);
    let ways = Ways { robot, command, settings };
    if stays {
        // Over the same place there is nothing to go over.
        let (end, way) = if gate.stays() { (at(&end, top), &gate.rising) } else { (end, &gate.falling) };
        return Ok(vec![Motion { zone: zone(gate), ..ways.part(start, end, &ways.lifting(way))? }]);
    }
    let (up, over) = (at(start, top), at(&end, top));
    let mut motions = Vec::with_capacity(3);
    let mut push = |motion: Motion, corner: Option<GivenCorner>| {
        motions.push(Motion { corner, ends: false, zone: Zone::NONE, ..motion });
    };
    // The share of a way of the lift that is left when it has gone straight for so long.
    let rest = |way: f64, straight: f64| 1.0 - (straight / way).min(1.0);
    let way_over = Instruction { command: command.clone(), settings: *settings };
    let form_over = ways.form(&up, over, &way_over)?;
    if top - from > NO_DISTANCE_MM {
        let rising = ways.lifting(&gate.rising);
        let corner = corner(ways.form(start, up, &rising)?, rest(top - from, gate.rise), form_over);
        push(
            ways.part(start, up, &rising)?,
            corner.map(|[lift, over]| GivenCorner { leaving: lift.reversed(), joining: over }),
        );
    }
    let going_over = ways.part(&up, over, &way_over)?;
    if top - to > NO_DISTANCE_MM && !gate.stays() {
        let sinking = ways.lifting(&gate.falling);
        // Where it goes on smoothly, the corner leaves the next blend its part.
        let most = 1.0 - if gate.smooth { SMOOTH_ZONE_PERCENT / 100.0 * LARGEST_ZONE } else { STOPPING_SHARE };
        let corner = corner(ways.form(&over, end, &sinking)?, rest(top - to, gate.sink).min(most), form_over);
        push(going_over, corner.map(|[lift, over]| GivenCorner { leaving: over.reversed(), joining: lift }));
        push(ways.part(&over, end, &sinking)?, None);
    } else {
        push(going_over, None);
    }
    if let Some(last) = motions.last_mut() {
        (last.ends, last.zone) = (true, zone(gate));
    }
    share_out(&mut motions);
    Ok(motions)
}

/// Where the lift is, in mm.
fn height(joints: &Joints) -> f64 {
    joints.axes.get(LIFT_AXIS).copied().unwrap_or_default()
}

/// The same with the lift elsewhere.
fn at(joints: &Joints, height: f64) -> Joints {
    let mut joints = *joints;
    if let Some(value) = joints.axes.get_mut(LIFT_AXIS) {
        *value = height;
    }
    joints
}

/// How high the lift goes over between two heights; `most` is the end of its range.
fn top(planner: &Planner<'_>, gate: &Gate, from: f64, to: f64, most: f64) -> Result<f64, PlanError> {
    // The TCP is everywhere as far above the lift.
    let above = planner.start_frame().translation.vector.z - from;
    let highest = gate.highest.map_or(most, |highest| most.min(highest - above));
    let highest_end = from.max(to);
    if highest_end > highest + NO_DISTANCE_MM {
        return Err(PlanError::AboveLimit { height: highest_end + above, highest: highest + above });
    }
    Ok((from + 2.0 * gate.rise).max(to + 2.0 * gate.sink).min(highest).max(highest_end))
}

/// What one way of a gate is planned with.
struct Instruction {
    command: Command,
    settings: Settings,
}

/// Plans the three ways of a gate.
struct Ways<'a> {
    robot: &'a Robot,
    command: &'a Command,
    settings: &'a Settings,
}

impl Ways<'_> {
    /// What a way of the lift is planned with.
    fn lifting(&self, way: &Lift) -> Instruction {
        let (command, settings) = (self.command, self.settings);
        let speed = Speed { percent: way.vel.unwrap_or(command.speed.percent), ..command.speed };
        let acc_percent = way.acc.unwrap_or(settings.acc_percent);
        let command = Command { speed, ..command.clone() };
        Instruction { command, settings: Settings { acc_percent, ..*settings } }
    }

    fn part(&self, from: &Joints, to: Joints, asked: &Instruction) -> Result<Motion, PlanError> {
        let Instruction { command, settings } = asked;
        Planner { robot: self.robot, start: from, command, settings }.axes(to)
    }

    /// What the form of a corner follows from; it is the same at every override, and in manual operation.
    fn form(&self, from: &Joints, to: Joints, asked: &Instruction) -> Result<Option<Limits>, PlanError> {
        let settings = Settings { speed_percent: 100.0, manual: false, ..asked.settings };
        let command = asked.command.clone();
        self.part(from, to, &Instruction { command, settings }).map(|motion| motion.limits)
    }
}

/// The corner that takes `share` of a way of the lift: while the lift goes from there to where it rests, the way over
/// begins. Returns how it meets both, each seen from where the other one rests. So a corner takes about as long as both
/// of them would by themselves, and neither waits for the other one.
fn corner(lift: Option<Limits>, share: f64, over: Option<Limits>) -> Option<[CornerEnd; 2]> {
    let [lift, over] = [lift?, over?].map(|limits| limits.rising_in(LEAST_RISE_S));
    if share <= 0.0 {
        return None;
    }
    let time = lift.time_to(share);
    // A way over that is short has the same form in less time.
    let over_time = time.min(over.time_to(LARGEST_CORNER_SHARE));
    let end = |part: f64, state: State, time: f64| {
        // A lift that has hardly set off is met as fast as it is on average.
        CornerEnd { part, speed: (state.vel * time).max(part), acc: state.acc * time * time }
    };
    let gone_over = over.state_after(over_time);
    // Not by rounding more than its half, which the other corner needs.
    let over_share = gone_over.at.min(LARGEST_CORNER_SHARE);
    Some([end(share, lift.state_after(time), time), end(over_share, gone_over, over_time)])
}

/// Lets each part be as much of the gate as it takes of the time.
fn share_out(parts: &mut [Motion]) {
    let all: f64 = parts.iter().map(Motion::duration).sum();
    let mut done = 0.0;
    for part in parts.iter_mut().filter(|_| all > 0.0) {
        let from = done / all;
        done += part.duration();
        part.stretch = [from, done / all];
    }
}

fn zone(gate: &Gate) -> Zone {
    if gate.smooth && !gate.stays() { Zone { percent: SMOOTH_ZONE_PERCENT, ..Zone::NONE } } else { Zone::NONE }
}
