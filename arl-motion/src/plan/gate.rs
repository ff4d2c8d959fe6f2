//! Gates: straight up, across, and straight down to the target, with rounded corners.
//!
//! A gate is three axis motions in a row under one number. It rises by `rise` before anything else moves, and by as
//! much again while it already moves across; on the other side the same applies to `sink`. Where the highest permitted
//! position leaves no room for the second half, the corner is a right angle, in which the robot stops.
//!
//! The share of the motion across that a corner takes depends on what is programmed for both, not on the override.

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
/// Distances up to this, in mm, do not count as motion.
const NO_DISTANCE_MM: f64 = 1e-6;
/// The largest share of the motion across that a corner may take.
const LARGEST_CORNER_SHARE: f64 = 0.5;
/// An acceleration that forms a corner takes at least this many s to rise, even without a jerk limit.
const LEAST_RISE_S: f64 = 0.004;
/// The share of the motion down that a corner leaves for stopping, whatever is requested.
const STOPPING_SHARE: f64 = 0.02;
/// The zone of a gate that continues without a stop, in percent of the largest zone.
const SMOOTH_ZONE_PERCENT: f64 = 25.0;

/// Plans the motions of a gate in order; all but the last one are parts of it.
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
    if [gate.rise, gate.sink].iter().any(|distance| !distance.is_finite() || *distance < 0.0 || is_unset(*distance)) {
        return Err(PlanError::NotANumber);
    }
    let planner = Planner { robot, start, command, settings };
    let end = planner.choose(pose, wobj, *wanted, external)?;
    let (from, to) = (height(start), height(&end));
    let top = top(&planner, gate, from, to, lift.max)?;
    let stays = at(start, top).all().iter().zip(at(&end, top).all()).all(|(a, b)| (a - b).abs() < NO_DISTANCE_MM);
    let gate_planner = GatePlanner { robot, command, settings };
    if stays {
        // There is nothing to move across when the target is at the same place.
        let (end, lift_motion) = if gate.stays() { (at(&end, top), &gate.rising) } else { (end, &gate.falling) };
        return Ok(vec![Motion {
            zone: zone(gate),
            ..gate_planner.part(start, end, &gate_planner.lifting(lift_motion))?
        }]);
    }
    let (up, over) = (at(start, top), at(&end, top));
    let mut motions = Vec::with_capacity(3);
    let mut push = |motion: Motion, corner: Option<GivenCorner>| {
        motions.push(Motion { corner, ends: false, zone: Zone::NONE, ..motion });
    };
    // The share of a lift motion that is left after it has gone straight for `straight` mm.
    let rest = |length: f64, straight: f64| 1.0 - (straight / length).min(1.0);
    let across = Instruction { command: command.clone(), settings: *settings };
    let form_over = gate_planner.form(&up, over, &across)?;
    if top - from > NO_DISTANCE_MM {
        let rising = gate_planner.lifting(&gate.rising);
        let corner = corner(gate_planner.form(start, up, &rising)?, rest(top - from, gate.rise), form_over);
        push(
            gate_planner.part(start, up, &rising)?,
            corner.map(|[lift, over]| GivenCorner { leaving: lift.reversed(), joining: over }),
        );
    }
    let going_over = gate_planner.part(&up, over, &across)?;
    if top - to > NO_DISTANCE_MM && !gate.stays() {
        let sinking = gate_planner.lifting(&gate.falling);
        // Where the gate continues smoothly, the corner leaves the next blend its part.
        let most = 1.0 - if gate.smooth { SMOOTH_ZONE_PERCENT / 100.0 * LARGEST_ZONE } else { STOPPING_SHARE };
        let corner = corner(gate_planner.form(&over, end, &sinking)?, rest(top - to, gate.sink).min(most), form_over);
        push(going_over, corner.map(|[lift, over]| GivenCorner { leaving: over.reversed(), joining: lift }));
        push(gate_planner.part(&over, end, &sinking)?, None);
    } else {
        push(going_over, None);
    }
    if let Some(last) = motions.last_mut() {
        (last.ends, last.zone) = (true, zone(gate));
    }
    share_out(&mut motions);
    Ok(motions)
}

/// The position of the lift, in mm.
fn height(joints: &Joints) -> f64 {
    joints.axes.get(LIFT_AXIS).copied().unwrap_or_default()
}

/// The same positions with the lift at `height`.
fn at(joints: &Joints, height: f64) -> Joints {
    let mut joints = *joints;
    if let Some(value) = joints.axes.get_mut(LIFT_AXIS) {
        *value = height;
    }
    joints
}

/// The height of the lift while moving across between two heights; `most` is the end of its range.
fn top(planner: &Planner<'_>, gate: &Gate, from: f64, to: f64, most: f64) -> Result<f64, PlanError> {
    // The TCP is the same distance above the lift everywhere.
    let above = planner.start_frame().translation.vector.z - from;
    let highest = gate.highest.map_or(most, |highest| most.min(highest - above));
    let highest_end = from.max(to);
    if highest_end > highest + NO_DISTANCE_MM {
        return Err(PlanError::AboveLimit { height: highest_end + above, highest: highest + above });
    }
    Ok((from + 2.0 * gate.rise).max(to + 2.0 * gate.sink).min(highest).max(highest_end))
}

/// What one motion of a gate is planned with.
struct Instruction {
    command: Command,
    settings: Settings,
}

/// Plans the three motions of a gate.
struct GatePlanner<'a> {
    robot: &'a Robot,
    command: &'a Command,
    settings: &'a Settings,
}

impl GatePlanner<'_> {
    /// What a motion of the lift is planned with.
    fn lifting(&self, lift: &Lift) -> Instruction {
        let (command, settings) = (self.command, self.settings);
        let speed = Speed { percent: lift.vel.unwrap_or(command.speed.percent), ..command.speed };
        let acc_percent = lift.acc.unwrap_or(settings.acc_percent);
        let command = Command { speed, ..command.clone() };
        Instruction { command, settings: Settings { acc_percent, ..*settings } }
    }

    fn part(&self, from: &Joints, to: Joints, asked: &Instruction) -> Result<Motion, PlanError> {
        let Instruction { command, settings } = asked;
        Planner { robot: self.robot, start: from, command, settings }.axes(to)
    }

    /// The limits that the form of a corner follows from; it is the same at every override, and in manual operation.
    fn form(&self, from: &Joints, to: Joints, asked: &Instruction) -> Result<Option<Limits>, PlanError> {
        let settings = Settings { speed_percent: 100.0, manual: false, ..asked.settings };
        let command = asked.command.clone();
        self.part(from, to, &Instruction { command, settings }).map(|motion| motion.limits)
    }
}

/// The corner that takes `share` of a motion of the lift: while the lift moves from there to where it rests, the motion
/// across begins. Returns how the corner meets both, each seen from where the other one is at rest. So a corner takes
/// about as long as each of them would by itself, and neither waits for the other one.
fn corner(lift: Option<Limits>, share: f64, over: Option<Limits>) -> Option<[CornerEnd; 2]> {
    let [lift, over] = [lift?, over?].map(|limits| limits.rising_in(LEAST_RISE_S));
    if share <= 0.0 {
        return None;
    }
    let time = lift.time_to(share);
    // A short motion across has the same form in less time.
    let over_time = time.min(over.time_to(LARGEST_CORNER_SHARE));
    let end = |part: f64, state: State, time: f64| {
        // A lift that has hardly started is met at its average speed.
        CornerEnd { part, speed: (state.vel * time).max(part), acc: state.acc * time * time }
    };
    let gone_over = over.state_after(over_time);
    // Rounding must not make it more than half, since the other corner needs its half.
    let over_share = gone_over.at.min(LARGEST_CORNER_SHARE);
    Some([end(share, lift.state_after(time), time), end(over_share, gone_over, over_time)])
}

/// Assigns each part the share of the gate that it takes of the time.
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
