//! Whether a robot can follow a straight line of the TCP, told without planning it.

use nalgebra::{UnitQuaternion, Vector3};

use super::Carried;
use crate::kinematics::{Axes, CLEAR_OF_SINGULAR, Frame, Rates, SHORTEST_STEP_S, lowest_pace, outruns, wrap_degrees};
use crate::robot::Robot;

/// Where a way is far from singular points at so many places, and at its start, it is not looked at closely.
const GLANCES: u32 = 16;
/// Close to a singular point the steps are this part of what the axes' motion changes over, so that none is stepped
/// over.
const STEP_OF_SCALE: f64 = 0.04;
const LONGEST_STEP: f64 = 1.0 / 16.0;
/// Nearer to a singular point than this rounding spoils the derivatives.
const SPOILT: f64 = 1e-5;
/// A step where the derivatives of the axes are not known.
const BLIND_STEP: f64 = 1e-3;
/// A place with less than this margin of speed (see [`Rates::speed_margin`]) is singular without doubt: the planner's
/// walk looks at other places, which differ by less.
const SURE: f64 = 0.99;
/// An axis that is so far (deg) from where it was a step before has not turned but jumped.
const JUMP: f64 = 90.0;

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

    /// Where the way passes a singular point, as part of it, and the axes there: surely, so that no robot goes along it
    /// but with another orientation. `start` are the axes where it begins, in configuration `cfg`. `None` says little:
    /// only ways that come near a singular point are looked at closely.
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
            (at, near) = match self.step(robot, cfg, (at, &near), (at + step).min(1.0))? {
                Ok(place) => place,
                Err(jump) => return Some((jump, near)),
            };
        }
    }

    /// Goes on to `next`, or less far where an axis jumps on the way there; or says where the axis has to turn at once:
    /// in the very singular point, which the way meets as straight as that the axes stand still in it.
    fn step(
        &self,
        robot: &Robot,
        cfg: u8,
        (at, near): (f64, &Axes),
        mut next: f64,
    ) -> Option<Result<(f64, Axes), f64>> {
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

    /// The axes at a part of the way, no farther than half a turn from `near`.
    fn axes(&self, robot: &Robot, cfg: u8, at: f64, near: &Axes) -> Option<Axes> {
        let mut axes = robot.kinematics.inverse(&self.flange(at), cfg, near)?;
        for (value, near) in axes.iter_mut().zip(near) {
            *value = near + wrap_degrees(*value - near);
        }
        Some(axes)
    }

    /// The TCP at a part of the way.
    fn way(&self, at: f64) -> Frame {
        let turned = UnitQuaternion::from_scaled_axis(self.turning * at) * self.start.rotation;
        Frame::from_parts((self.start.translation.vector + self.travel * at).into(), turned)
    }

    fn flange(&self, at: f64) -> Frame {
        self.carried.flange_at(&self.way(at))
    }

    /// The derivatives of the axes; `None` at a singular point itself.
    fn rates(&self, robot: &Robot, axes: &Axes, at: f64) -> Option<Rates> {
        if robot.kinematics.clearance(axes) < SPOILT {
            return None;
        }
        let rest = Vector3::zeros();
        let twist = self.carried.twist(&self.way(at), &[self.travel, rest, rest], &[self.turning, rest, rest]);
        robot.kinematics.rates(axes, &twist)
    }

    /// s for all of it at the lowest speed that makes sense.
    fn pace(&self) -> f64 {
        lowest_pace(&self.travel, &self.turning)
    }
}

/// Whether an axis has jumped.
fn jumps(from: &Axes, to: &Axes) -> bool {
    from.iter().zip(to).any(|(from, to)| (to - from).abs() > JUMP)
}
