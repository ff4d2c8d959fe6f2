//! Whether a robot can follow a straight line of the TCP, told without planning it.

use nalgebra::{UnitQuaternion, Vector3};

use super::Carried;
use crate::kinematics::{Axes, Frame, SINGULAR_SCALE};
use crate::robot::Robot;

/// Farther from singular points than this (see [`crate::kinematics::Kinematics::clearance`]) a way is not looked at closely.
const CLEAR: f64 = 0.15;
/// At so many places, and its start.
const GLANCES: u32 = 16;
/// Close to a singular point the steps are this part of what the axes' motion changes over, so that none is stepped over.
const STEP_OF_SCALE: f64 = 0.04;
const LONGEST_STEP: f64 = 1.0 / 16.0;
/// Nearer to a singular point than this rounding spoils the derivatives.
const SPOILT: f64 = 1e-5;
/// This part of the least scale at which motions are planned leaves no doubt.
const SURE: f64 = 0.5;
/// An axis that is so far (deg) from where it was a step before has not turned but jumped.
const JUMP: f64 = 90.0;
/// Halvings of a step, to find where in it an axis jumps.
const HALVINGS: u32 = 30;

/// A straight way of the TCP, along which the tool turns evenly about one line.
#[derive(Clone, Copy, Debug)]
pub struct StraightWay {
    carried: Carried,
    start: Frame,
    travel: Vector3<f64>,
    turning: Vector3<f64>,
}

impl StraightWay {
    /// The way from `start` to `end`, both seen from where ways of the TCP are (see [`Carried`]), translations in mm.
    pub fn new(carried: Carried, start: Frame, end: &Frame) -> Self {
        let travel = end.translation.vector - start.translation.vector;
        let turning = (end.rotation * start.rotation.inverse()).scaled_axis();
        Self { carried, start, travel, turning }
    }

    /// Where the way passes a singular point, as part of it, and the axes there: surely, so that no robot goes along it but
    /// with another orientation. `start` are the axes where it begins, in configuration `cfg`. `None` says little: only ways
    /// that come near a singular point are looked at closely.
    pub fn singular_point(&self, robot: &Robot, cfg: u8, start: &Axes) -> Option<(f64, Axes)> {
        let mut near = *start;
        let mut clear = |at: f64| {
            near = robot.kinematics.inverse(&self.flange(at), cfg, &near)?;
            Some(robot.kinematics.clearance(&near) > CLEAR)
        };
        if (0..=GLANCES).all(|glance| clear(f64::from(glance) / f64::from(GLANCES)) == Some(true)) {
            return None;
        }
        let (mut at, mut near, mut before) = (0.0, *start, 0.0);
        while at < 1.0 {
            let here = robot.kinematics.inverse(&self.flange(at), cfg, &near)?;
            if jumps(&near, &here) {
                return Some((self.jump(robot, cfg, &near, before, at), near));
            }
            (near, before) = (here, at);
            let step = match self.scale(robot, &near, at) {
                Some(scale) if scale < SURE * SINGULAR_SCALE => return Some((at, near)),
                Some(scale) => (STEP_OF_SCALE * scale).min(LONGEST_STEP),
                None => SINGULAR_SCALE,
            };
            at += step;
        }
        None
    }

    /// Where between two places of the way an axis jumps from where it is at the first: in the very singular point, which the way
    /// meets as straight as that the axes stand still in it, and then must turn at once to stay in their configuration.
    fn jump(&self, robot: &Robot, cfg: u8, axes: &Axes, mut before: f64, mut behind: f64) -> f64 {
        for _ in 0..HALVINGS {
            let middle = f64::midpoint(before, behind);
            match robot.kinematics.inverse(&self.flange(middle), cfg, axes) {
                Some(found) if !jumps(axes, &found) => before = middle,
                _ => behind = middle,
            }
        }
        behind
    }

    /// The TCP at a part of the way.
    fn way(&self, at: f64) -> Frame {
        let turned = UnitQuaternion::from_scaled_axis(self.turning * at) * self.start.rotation;
        Frame::from_parts((self.start.translation.vector + self.travel * at).into(), turned)
    }

    fn flange(&self, at: f64) -> Frame {
        self.carried.flange_at(&self.way(at))
    }

    /// Over which part of the way the motion of the axes changes substantially (see [`crate::kinematics::Rates::scale`]).
    /// `None` at a singular point itself.
    fn scale(&self, robot: &Robot, axes: &Axes, at: f64) -> Option<f64> {
        if robot.kinematics.clearance(axes) < SPOILT {
            return None;
        }
        let rest = Vector3::zeros();
        let twist = self.carried.twist(&self.way(at), &[self.travel, rest, rest], &[self.turning, rest, rest]);
        Some(robot.kinematics.rates(axes, &twist)?.scale(&robot.axes))
    }
}

/// Whether an axis has jumped, whole turns aside.
fn jumps(from: &Axes, to: &Axes) -> bool {
    let turned = |from: &f64, to: &f64| ((to - from + 180.0).rem_euclid(360.0) - 180.0).abs();
    from.iter().zip(to).any(|(from, to)| turned(from, to) > JUMP)
}
