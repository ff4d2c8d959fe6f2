//! Positions of all axes of a robot, its own and external ones.

use nalgebra::SVector;

use arl_robot::robot::{EXTERNAL_AXES, ROBOT_AXES, Robot};

/// The value of a component that was not set: a motion keeps such a component unchanged.
pub const UNSET: f64 = 9e9;

/// Whether a component was not set.
pub fn is_unset(value: f64) -> bool {
    (UNSET..f64::INFINITY).contains(&value)
}

/// Number of values in [`Joints`].
pub(crate) const ALL: usize = ROBOT_AXES + EXTERNAL_AXES;

/// The time in s that each axis takes for 1 deg (mm) at its highest speed, in the order of [`Joints::all`]; 0 for axes
/// that a robot does not have.
pub(crate) fn slowness(robot: &Robot) -> SVector<f64, ALL> {
    let mut joints = Joints { axes: [0.0; ROBOT_AXES], external: [0.0; EXTERNAL_AXES] };
    let own = joints.axes.iter_mut().zip(robot.own_axes());
    for (slowness, axis) in own.chain(joints.external.iter_mut().zip(robot.external_axes())) {
        *slowness = 1.0 / axis.vel;
    }
    joints.all().into()
}

/// Positions of all axes, in deg (mm for linear axes). Axes that a robot does not have are 0 (its own) or [`UNSET`]
/// (external ones).
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Joints {
    /// The robot's own axes.
    pub axes: [f64; ROBOT_AXES],
    /// The external axes.
    pub external: [f64; EXTERNAL_AXES],
}

impl Joints {
    /// All at 0.
    pub(crate) const ZERO: Joints = Joints { axes: [0.0; ROBOT_AXES], external: [0.0; EXTERNAL_AXES] };

    /// The start position of the robot's file.
    pub fn home(robot: &Robot) -> Self {
        let mut joints = Self { axes: [0.0; ROBOT_AXES], external: [UNSET; EXTERNAL_AXES] };
        let own = robot.own_axes().len();
        for (value, home) in joints.axes.iter_mut().zip(robot.home.iter().take(own)) {
            *value = *home;
        }
        for (value, home) in joints.external.iter_mut().zip(robot.home.iter().skip(own)) {
            *value = *home;
        }
        joints
    }

    /// Whether all values are finite.
    pub(crate) fn is_finite(&self) -> bool {
        self.axes.iter().chain(&self.external).all(|value| value.is_finite())
    }

    /// Whether every axis is within `tolerance` deg (mm) of another position.
    pub fn is_at(&self, other: &Self, tolerance: f64) -> bool {
        let near = |(a, b): (&f64, &f64)| (a - b).abs() <= tolerance;
        self.axes.iter().zip(&other.axes).all(near) && self.external.iter().zip(&other.external).all(near)
    }

    /// These positions, with unset values and axes that the robot does not have taken from `start`.
    pub(crate) fn completed(&self, start: &Joints, robot: &Robot) -> Self {
        let mut joints = *start;
        fill(&mut joints.axes, &self.axes, robot.own_axes().len());
        fill(&mut joints.external, &self.external, robot.external_axes().len());
        joints
    }
}

fn fill(into: &mut [f64], from: &[f64], count: usize) {
    for (value, new) in into.iter_mut().zip(from).take(count) {
        if !is_unset(*new) {
            *value = *new;
        }
    }
}

impl Joints {
    /// Own axes, then external ones.
    pub(crate) fn all(&self) -> [f64; ALL] {
        let mut all = [0.0; ALL];
        for (value, joint) in all.iter_mut().zip(self.axes.iter().chain(&self.external)) {
            *value = *joint;
        }
        all
    }

    /// The opposite of [`Joints::all`].
    pub(crate) fn of(all: &[f64; ALL]) -> Self {
        let mut joints = Self { axes: [0.0; ROBOT_AXES], external: [0.0; EXTERNAL_AXES] };
        for (joint, value) in joints.axes.iter_mut().chain(&mut joints.external).zip(all) {
            *joint = *value;
        }
        joints
    }
}
