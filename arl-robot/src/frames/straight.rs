//! Checks whether a robot can follow a straight line of the TCP, without planning it.

use nalgebra::{UnitQuaternion, Vector3};

use super::Carried;
use crate::kinematics::{Axes, CLEAR_OF_SINGULAR, Frame, Rates, SHORTEST_STEP_S, lowest_pace, outruns, wrap_degrees};
use crate::robot::Robot;

/// A path that is far from singular points at this many places, and at its start, is not examined closely.
const GLANCES: u32 = 16;
/// Close to a singular point the steps are this part of the distance over which the axes' motion changes, so that no
/// singular point is stepped over.
const STEP_OF_SCALE: f64 = 0.04;
const LONGEST_STEP: f64 = 1.0 / 16.0;
/// Nearer to a singular point than this, rounding spoils the derivatives.
const SPOILT: f64 = 1e-5;
/// The step where the derivatives of the axes are not known.
const BLIND_STEP: f64 = 1e-3;
/// A place with a speed margin below this (see [`Rates::speed_margin`]) is certainly singular: the planner examines
/// other places, but they differ by less.
const SURE: f64 = 0.99;
/// An axis that is farther than this (deg) from its position a step before has not turned but jumped.
const JUMP: f64 = 90.0;

/// A straight path of the TCP, along which the tool turns uniformly about one line.
#[derive(Clone, Copy, Debug)]
pub struct StraightPath {
    carried: Carried,
    start: Frame,
    travel: Vector3<f64>,
    turning: Vector3<f64>,
}

impl StraightPath {
    /// The path from `start` to `end`, both in the frame of paths of the TCP (see [`Carried`]), translations in mm.
    pub fn new(carried: Carried, start: Frame, end: &Frame) -> Self {
        let travel = end.translation.vector - start.translation.vector;
        let turning = (end.rotation * start.rotation.inverse()).scaled_axis();
        Self { carried, start, travel, turning }
    }

    /// Where the path certainly passes a singular point, as part of the path, and the axes there: the robot cannot
    /// follow it except with another orientation. `start` are the axes at its start, in configuration `cfg`. `None` is
    /// not a guarantee: only paths that come near a singular point are examined closely.
    pub fn singular_point(&self, robot: &Robot, cfg: u8, start: &Axes) -> Option<(f64, Axes)> {
        let mut near = *start;
        let mut clear = |at: f64| {
            near = robot.kinematics.inverse(&self.flange(at), cfg, &near)?;
            Some(robot.kinematics.clearance(&near) > CLEAR_OF_SINGULAR)
        };
        if (0..=GLANCES).all(|glance| clear(f64::from(glance) / f64::from(GLANCES)) == Some(true)) {
            return None;
        }
        let (mut at, mut near) = (0.0, *start);
        loop {
            let step = match self.rates(robot, &near, at) {
                Some(rates) if rates.speed_margin(robot.own_axes(), self.pace()).0 < SURE => return Some((at, near)),
                Some(rates) => (STEP_OF_SCALE * rates.scale(&robot.axes)).min(LONGEST_STEP),
                None => BLIND_STEP,
            };
            if at >= 1.0 {
                return None;
            }
            (at, near) = match self.step(robot, cfg, at, &near, (at + step).min(1.0))? {
                Ok(place) => place,
                Err(jump) => return Some((jump, near)),
            };
        }
    }

    /// Continues to `next`, or less far if an axis jumps before it; or returns where the axis would have to turn at
    /// once: exactly in the singular point, which the path meets so straight that the axes are at rest in it.
    fn step(&self, robot: &Robot, cfg: u8, at: f64, near: &Axes, mut next: f64) -> Option<Result<(f64, Axes), f64>> {
        loop {
            let found = self.axes(robot, cfg, next, near)?;
            if !jumps(near, &found) {
                return Some(Ok((next, found)));
            }
            let time = self.pace() * (next - at);
            if time < SHORTEST_STEP_S || outruns(robot.own_axes(), near, &found, time) {
                return Some(Err(next));
            }
            next = f64::midpoint(at, next);
        }
    }

    /// The axes at a part of the path, no farther than half a turn from `near`.
    fn axes(&self, robot: &Robot, cfg: u8, at: f64, near: &Axes) -> Option<Axes> {
        let mut axes = robot.kinematics.inverse(&self.flange(at), cfg, near)?;
        for (value, near) in axes.iter_mut().zip(near) {
            *value = near + wrap_degrees(*value - near);
        }
        Some(axes)
    }

    /// The TCP at a part of the path.
    fn tcp(&self, at: f64) -> Frame {
        let turned = UnitQuaternion::from_scaled_axis(self.turning * at) * self.start.rotation;
        Frame::from_parts((self.start.translation.vector + self.travel * at).into(), turned)
    }

    fn flange(&self, at: f64) -> Frame {
        self.carried.flange_at(&self.tcp(at))
    }

    /// The derivatives of the axes; `None` at a singular point itself.
    fn rates(&self, robot: &Robot, axes: &Axes, at: f64) -> Option<Rates> {
        if robot.kinematics.clearance(axes) < SPOILT {
            return None;
        }
        let rest = Vector3::zeros();
        let twist = self.carried.twist(&self.tcp(at), &[self.travel, rest, rest], &[self.turning, rest, rest]);
        robot.kinematics.rates(axes, &twist)
    }

    /// The time of the whole path at the lowest sensible speed, in s.
    fn pace(&self) -> f64 {
        lowest_pace(&self.travel, &self.turning)
    }
}

/// Whether an axis has jumped.
fn jumps(from: &Axes, to: &Axes) -> bool {
    from.iter().zip(to).any(|(from, to)| (to - from).abs() > JUMP)
}
