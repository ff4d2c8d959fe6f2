//! Whether a robot does what it is asked for.

use crate::fault::Fault;
use crate::motion::Joints;
use crate::unit::range::{self, unit};
use crate::unit::robot_driver::{Drives, Feedback};
use arl_robot::robot::{Axis, ROBOT_AXES, Robot};

/// This many cycles without a position are not a fault yet, however long they are.
const FEWEST_CYCLES: u32 = 4;
/// By how many cycles set-points and feedback are delayed.
const LATE_CYCLES: f64 = 3.0;
/// How long drives may take to come on, in s.
const COMING_ON_S: f64 = 5.0;

/// The state of the controller in this cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Now<'a> {
    pub(super) robot: &'a Robot,
    pub(super) asked: &'a Joints,
    /// The length of the cycle in s.
    pub(super) period: f64,
    /// For how many cycles no position has arrived.
    pub(super) silent: u32,
    /// The motors were switched on, and have not reported that they are on.
    pub(super) coming_on: bool,
    /// The set-point is at rest.
    pub(super) rests: bool,
    /// The robot has settled on it.
    pub(super) settled: bool,
}

/// The state of the supervision. It reports one fault, until it [begins again](Supervision::begin).
#[derive(Default, Debug)]
pub(super) struct Supervision {
    /// How long the robot has not settled, and how long its motors have been coming on, in s.
    unsettled: f64,
    coming_on: f64,
    found: bool,
}

impl Supervision {
    /// The motors are switched on.
    pub(super) fn begin(&mut self) {
        *self = Self::default();
    }

    /// Whether a fault was found.
    pub(super) fn has_found(&self) -> bool {
        self.found
    }

    /// Checks the feedback of a robot whose motors are on, or should be; returns the fault. That is reported once,
    /// except for a fault of the drives, which must not be commanded any more.
    pub(super) fn look(&mut self, feedback: &Feedback, now: Now<'_>) -> Option<Fault> {
        let fault = self.find_fault(feedback, now)?;
        let counts = !self.found || matches!(fault, Fault::Drives(_));
        self.found = true;
        counts.then_some(fault)
    }

    fn find_fault(&mut self, feedback: &Feedback, now: Now<'_>) -> Option<Fault> {
        let of_drives = self.drives(feedback.drives.as_ref(), now);
        let of_position = position(feedback.position.as_ref(), now).or_else(|| torque(feedback));
        of_drives.or(of_position).or_else(|| self.settling(feedback.position.as_ref(), now))
    }

    fn drives(&mut self, drives: Option<&Drives>, now: Now<'_>) -> Option<Fault> {
        self.coming_on = if now.coming_on { self.coming_on + now.period } else { 0.0 };
        let text = match drives {
            Some(Drives::Fault(why)) => format!("the drives of the robot have a fault: {why}"),
            Some(Drives::Off) if !now.coming_on => {
                "the drives of the robot are off, though nobody switched them off".to_owned()
            }
            _ if self.coming_on > COMING_ON_S => {
                format!("the drives of the robot have not come on within {COMING_ON_S} s")
            }
            _ => return None,
        };
        Some(Fault::Drives(text.into()))
    }

    fn settling(&mut self, position: Option<&Joints>, now: Now<'_>) -> Option<Fault> {
        let waits = now.rests && !now.settled && !now.coming_on;
        self.unsettled = if waits { self.unsettled + now.period } else { 0.0 };
        let limit = now.robot.drives.settling;
        if self.unsettled <= limit {
            return None;
        }
        let near = now.robot.drives.settled;
        let farthest =
            position.and_then(|position| axes_off(position, now).max_by(|(one, _), (other, _)| one.total_cmp(other)));
        let text = match farthest {
            Some((off, axis)) => {
                let (name, unit) = (&axis.name, unit(axis));
                format!(
                    "the robot has not settled at its set-point within {limit} s: {name} is {off:.4} {unit} away; up to {near} {unit} counts as settled"
                )
            }
            None => format!("the robot has not settled at its set-point within {limit} s"),
        };
        Some(Fault::NotSettling(text.into()))
    }
}

/// A wrong position, or a missing one.
fn position(position: Option<&Joints>, now: Now<'_>) -> Option<Fault> {
    let Some(position) = position else {
        let lasts = f64::from(now.silent) * now.period;
        let is_lost = now.silent > FEWEST_CYCLES && lasts > now.robot.drives.feedback + 0.5 * now.period;
        let text = || format!("no position feedback for {:.0} ms", lasts * 1e3);
        return is_lost.then(|| Fault::NoFeedback(text().into()));
    };
    let outside = || range::first_outside(position, now.robot);
    if now.silent > 0
        && let Some(outside) = outside()
    {
        return Some(Fault::NoFeedback(outside.to_string().into()));
    }
    if now.coming_on {
        // Its set-point is the position that it reports, which has to be within its ranges.
        return outside().map(|outside| Fault::NotFollowing(outside.to_string().into()));
    }
    let off = axes_off(position, now).zip(&now.robot.drives.following).map(|((off, axis), limit)| {
        // The feedback is some cycles old.
        (off, axis, limit.max(axis.vel * LATE_CYCLES * now.period))
    });
    let (off, axis, limit) =
        off.filter(|(off, _, limit)| off > limit).max_by(|(one, ..), (other, ..)| one.total_cmp(other))?;
    let (name, unit) = (&axis.name, unit(axis));
    let text = format!(
        "the robot does not follow: {name} is {off:.2} {unit} from its set-point, {limit:.2} {unit} are allowed"
    );
    Some(Fault::NotFollowing(text.into()))
}

/// An error in the measured torques: collisions could not be detected with them.
fn torque(feedback: &Feedback) -> Option<Fault> {
    let torque = feedback.torque.as_ref()?;
    let text = "a motor torque that the robot reports is not a number";
    (!is_all_finite(torque)).then(|| Fault::NoFeedback(text.into()))
}

/// Whether all values are finite.
pub(super) fn is_all_finite(values: &[f64; ROBOT_AXES]) -> bool {
    values.iter().all(|value| value.is_finite())
}

/// How far each axis is from its set-point, in deg (mm).
fn axes_off<'a>(position: &'a Joints, now: Now<'a>) -> impl Iterator<Item = (f64, &'a Axis)> {
    let own = now.robot.own_axes().len();
    let pairs = now.asked.axes.iter().zip(&position.axes).take(own);
    let pairs = pairs.chain(now.asked.external.iter().zip(&position.external));
    pairs.zip(&now.robot.axes).map(|((asked, is), axis)| ((asked - is).abs(), axis))
}

/// Whether the positions of all axes of a robot are finite.
pub(super) fn is_finite(position: &Joints, robot: &Robot) -> bool {
    range::axes_at(position, robot).all(|(_, at)| at.is_finite())
}
