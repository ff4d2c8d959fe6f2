//! The robot: its axes, limits and geometry, from a description, built in, or read from a robot file.

#[cfg(feature = "files")]
mod builtin;
mod description;
mod error;
#[cfg(not(feature = "files"))]
mod family;
mod limbs;
#[cfg(feature = "files")]
mod load;
#[cfg(feature = "files")]
mod read;
#[cfg(feature = "files")]
mod section;
#[cfg(test)]
#[cfg(feature = "files")]
mod tests;

#[cfg(feature = "files")]
pub use arl_lang::catalog::Family;
pub use description::Description;
pub use error::RobotError;
#[cfg(not(feature = "files"))]
pub use family::Family;
pub use limbs::{LIMB_NAMES, Limb};

use std::ops::Deref;

/// The most axes in a joint vector: the robot's own six.
pub const ROBOT_AXES: usize = 6;
/// The most external axes.
pub const EXTERNAL_AXES: usize = 6;

/// The number of axes of a robot of this family, without external ones.
pub const fn own_axes(family: Family) -> usize {
    match family {
        Family::SixAxis => 6,
        Family::Scara => 4,
    }
}

/// The name of an axis, counted from 0: `j1`.. of the robot, then `ej1`...
fn axis_name(family: Family, at: usize) -> String {
    let own = own_axes(family);
    if at < own { format!("j{}", at + 1) } else { format!("ej{}", at + 1 - own) }
}

/// The velocity profile of a motion.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum VelocityProfile {
    /// Trapezoidal: acceleration limited.
    T,
    /// Jerk limited: as fast at each place as every axis allows.
    S,
    /// The same as `S`.
    O,
}

/// The limits of one axis, in deg, deg/s, deg/s2, deg/s3; mm instead of deg for a linear axis.
#[derive(Clone, PartialEq, Debug)]
pub struct Axis {
    /// `j1`.. or `ej1`...
    pub name: String,
    /// Whether the axis moves along a line (mm) instead of turning (deg).
    pub linear: bool,
    /// Lowest position.
    pub min: f64,
    /// Highest position.
    pub max: f64,
    /// Highest speed.
    pub vel: f64,
    /// Highest acceleration.
    pub acc: f64,
    /// Highest jerk.
    pub jerk: f64,
}

impl Axis {
    /// The position nearest to the range among those that differ from `value` by whole turns, and its distance from the
    /// range; 0 within it. A linear axis has no other position.
    pub fn nearest_to_range(&self, value: f64) -> (f64, f64) {
        let beyond = |value: f64| (self.min - value).max(value - self.max).max(0.0);
        if self.linear {
            return (value, beyond(value));
        }
        let middle = 0.5 * (self.min + self.max);
        let nearest = middle + crate::kinematics::wrap_degrees(value - middle);
        // Of two positions at the same distance the given one is preferred, as the reader knows it.
        if beyond(value) <= beyond(nearest) { (value, beyond(value)) } else { (nearest, beyond(nearest)) }
    }
}

/// The limits for monitoring the drives of a robot while it moves.
#[derive(Clone, PartialEq, Debug)]
pub struct DriveLimits {
    /// The largest distance of each axis from its set-point, in deg (mm); the external axes follow the robot's own.
    pub following: Vec<f64>,
    /// The longest time without a position from the robot, in s.
    pub feedback: f64,
    /// The longest time to come to rest at the set-point once that is at rest, in s.
    pub settling: f64,
    /// The distance from its set-point at which an axis counts as settled, in deg (mm).
    pub settled: f64,
}

/// The limits of the tool centre point along a path.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct TcpLimits {
    /// Speed in mm/s.
    pub vel: f64,
    /// Acceleration in mm/s2.
    pub acc: f64,
    /// Jerk in mm/s3.
    pub jerk: f64,
    /// Turning speed in deg/s.
    pub ori_vel: f64,
    /// Turning acceleration in deg/s2.
    pub ori_acc: f64,
    /// Turning jerk in deg/s3.
    pub ori_jerk: f64,
}

/// The mass of a link and the motor that drives it, for dynamics.
#[derive(Clone, PartialEq, Debug)]
pub struct Link {
    /// Mass in kg.
    pub mass: f64,
    /// Centre of mass in the link's frame (see the runtime's dynamics), in mm.
    pub com: [f64; 3],
    /// Inertia about the centre of mass in the link's frame, in kg mm2: xx, xy, xz, yy, yz, zz.
    pub inertia: [f64; 6],
    /// Turns of the motor for one turn of the axis; rad of the motor for one m of a linear one.
    pub gear: f64,
    /// Torque of the motor for one ampere, in Nm/A.
    pub torque_constant: f64,
}

/// A checked robot: all values of its [`Description`] are suitable for computing, and every axis can move. Its fields
/// are those of the description (`robot.axes`), and cannot be changed.
#[derive(Clone, PartialEq, Debug)]
pub struct Robot(Description);

impl Deref for Robot {
    type Target = Description;

    fn deref(&self) -> &Description {
        &self.0
    }
}

impl Robot {
    /// The robot's own axes: six, or four.
    pub fn own_axes(&self) -> &[Axis] {
        self.axes.get(..own_axes(self.family)).unwrap_or(&self.axes)
    }

    /// The external axes: `ej1`...
    pub fn external_axes(&self) -> &[Axis] {
        self.axes.get(own_axes(self.family)..).unwrap_or(&[])
    }
}
