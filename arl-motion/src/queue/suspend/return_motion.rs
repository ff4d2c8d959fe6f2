//! The return motion to suspended motion, and which motions of that are left.

use crate::command::joints::Joints;
use crate::command::{Command, Settings, Speed, Target, Zone};
use crate::queue::suspend::{Asked, SuspendedMotion};
use arl_robot::frames::Rig;
use arl_robot::robot::Robot;

/// Speed of the axes in % where no motion specifies one.
const UNPROGRAMMED_SPEED_PERCENT: f64 = 5.0;

/// Which motions are skipped.
pub(crate) enum Skipped<'a> {
    None,
    /// Up to this one.
    To(&'a Asked),
    /// More motions than there are.
    Beyond,
}

/// A slow motion of the axes, for a stop before any motion was executed.
fn slowly_to(joints: Joints, rig: Rig) -> Command {
    let speed = Speed { percent: UNPROGRAMMED_SPEED_PERCENT, tcp: 1.0, ori: 1.0, exj: 1.0, exl: 1.0 };
    Command { target: Target::Joints(joints), rig, speed, duration: None, zone: Zone::NONE, line: 0 }
}

/// A motion to where the suspended motion continues.
pub(crate) struct ReturnMotion {
    pub(crate) asked: Settings,
    pub(crate) command: Command,
    /// Where it has to end.
    pub(crate) end: Option<Joints>,
}

impl SuspendedMotion {
    /// The motions that have not ended, the stopped one first.
    pub(crate) fn remaining(&self) -> impl Iterator<Item = &Asked> {
        let executed = self.layer.path.current().map_or(0, |(segment, _)| segment.number);
        let first = executed.max(self.layer.finished + 1);
        self.layer.requests.asked.iter().chain(&self.layer.requests.anew).filter(move |asked| asked.number >= first)
    }

    /// Whether none of its own motions is left, and something below it is to be continued.
    pub(crate) fn leads_on(&self) -> bool {
        self.layer.requests.going || (!self.layer.requests.starts.is_empty() && self.remaining().next().is_none())
    }

    pub(crate) fn skipped(&self, skip: u32) -> Skipped<'_> {
        let Some(last) = skip.checked_sub(1) else { return Skipped::None };
        match self.remaining().nth(last as usize) {
            Some(last) => Skipped::To(last),
            // Where no motion was left, there is nothing to drop.
            None if self.remaining().next().is_none() => Skipped::None,
            None => Skipped::Beyond,
        }
    }

    /// The return motion to the place of the stop; `None` where the robot is there.
    pub(crate) fn return_motion(&self, robot: &Robot, here: &Joints) -> Option<ReturnMotion> {
        if *here == self.joints {
            return None;
        }
        // Where no motion was left, the return motion is like the last one.
        let asked = self.remaining().next().or_else(|| self.layer.requests.asked.back());
        Some(match asked {
            Some(asked) => asked.return_motion_to(robot, &self.joints),
            None => ReturnMotion {
                asked: Settings::default(),
                command: slowly_to(self.joints, self.layer.execution.rig),
                end: Some(self.joints),
            },
        })
    }
}

impl Asked {
    /// The return motion to a place on this motion: straight for a motion of the TCP.
    pub(crate) fn return_motion_to(&self, robot: &Robot, place: &Joints) -> ReturnMotion {
        let target = if self.goes_straight() {
            let tcp = self.command.rig.carried.path_frame_at(&robot.kinematics.forward(&place.axes));
            Target::Line { pose: [0.0; 6], wobj: tcp, external: place.external }
        } else {
            Target::Joints(*place)
        };
        ReturnMotion { asked: self.settings, command: Command { target, ..self.command.clone() }, end: Some(*place) }
    }

    /// The motion to its target.
    pub(crate) fn motion_to_target(&self, robot: &Robot) -> ReturnMotion {
        match self.command.target {
            Target::Gate { .. } => ReturnMotion { asked: self.settings, command: self.command.clone(), end: None },
            _ => self.return_motion_to(robot, &self.end),
        }
    }

    /// Whether it is a motion of the TCP.
    pub(crate) fn goes_straight(&self) -> bool {
        !matches!(self.command.target, Target::Joints(_) | Target::Pose { .. } | Target::Gate { .. })
    }
}
