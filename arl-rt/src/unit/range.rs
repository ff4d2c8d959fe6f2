//! Whether the positions that a robot reports are within the ranges of its axes.

use std::fmt;

use crate::motion::Joints;
use arl_robot::robot::{Axis, Robot};

/// An axis at a position outside its range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct OutOfRange<'a> {
    axis: &'a Axis,
    at: f64,
}

/// The axes of a robot, each with its position in deg (mm).
pub(super) fn axes_at<'a>(position: &'a Joints, robot: &'a Robot) -> impl Iterator<Item = (&'a Axis, f64)> {
    let own = position.axes.iter().take(robot.own_axes().len());
    let all = own.chain(position.external.iter().take(robot.external_axes().len()));
    robot.axes.iter().zip(all.copied())
}

/// The first axis whose position is not a number, or farther outside its range than what counts as settled.
pub(crate) fn first_outside<'a>(position: &'a Joints, robot: &'a Robot) -> Option<OutOfRange<'a>> {
    let near = robot.drives.settled;
    let is_inside = |axis: &Axis, at: f64| at >= axis.min - near && at <= axis.max + near;
    axes_at(position, robot).find(|(axis, at)| !is_inside(axis, *at)).map(|(axis, at)| OutOfRange { axis, at })
}

/// The unit of an axis.
pub(super) fn unit(axis: &Axis) -> &'static str {
    if axis.linear { "mm" } else { "deg" }
}

impl fmt::Display for OutOfRange<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Axis { name, min, max, .. } = self.axis;
        if !self.at.is_finite() {
            return write!(f, "the position that the robot reports for {name} is not a number");
        }
        let unit = unit(self.axis);
        write!(f, "the robot reports {name} at {:.3} {unit}, outside of its range of {min} to {max} {unit}", self.at)
    }
}
