//! The robot: its axes, limits and geometry, read from a robot file or built in.

mod builtin;
mod error;
mod limbs;
mod read;
mod section;
#[cfg(test)]
mod tests;

pub use arl_lang::catalog::Family;
pub use error::RobotError;
pub use limbs::{LIMB_NAMES, Limb};

use crate::changes::{Changes, Part};
use crate::kinematics::Kinematics;
use crate::regular_file;
use std::borrow::Cow;
use std::path::Path;

/// How many axes a joint vector holds at most: six of the robot.
pub const ROBOT_AXES: usize = 6;
/// How many external axes there are at most.
pub const EXTERNAL_AXES: usize = 6;

/// The number of axes of a robot of this family, the external ones left out.
pub const fn own_axes(family: Family) -> usize {
    match family {
        Family::SixAxis => 6,
        Family::Scara => 4,
    }
}

/// How the speed of a motion rises and falls.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum VelocityProfile {
    /// Trapezoidal: acceleration limited.
    T,
    /// Jerk limited: as fast at each place as every axis allows.
    S,
    /// The same as `S`.
    O,
}

/// The limits of one axis, in deg, deg/s, deg/s2, deg/s3; mm instead of deg where the axis is linear.
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
    /// The position nearest to the range among those that differ from `value` by whole turns only, and how far beyond the
    /// range it is; 0 within. A linear axis has no other position.
    pub fn nearest_to_range(&self, value: f64) -> (f64, f64) {
        let beyond = |value: f64| (self.min - value).max(value - self.max).max(0.0);
        if self.linear {
            return (value, beyond(value));
        }
        let middle = 0.5 * (self.min + self.max);
        let nearest = middle + crate::kinematics::wrap_degrees(value - middle);
        // Of two positions at the same distance the given one is what a reader knows.
        if beyond(value) <= beyond(nearest) { (value, beyond(value)) } else { (nearest, beyond(nearest)) }
    }
}

/// What the drives of a robot are held against while it moves.
#[derive(Clone, PartialEq, Debug)]
pub struct DriveLimits {
    /// How far each axis, the external ones behind the robot's own, may be from its set-point, in deg (mm).
    pub following: Vec<f64>,
    /// For how long no position may come from the robot, in s.
    pub feedback: f64,
    /// How long it may take to come to rest on its set-point once that stands, in s.
    pub settling: f64,
    /// How near to its set-point an axis must be to count as settled, in deg (mm).
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

/// A robot as its file describes it.
#[derive(Clone, PartialEq, Debug)]
pub struct Robot {
    /// The robot's name.
    pub name: String,
    /// Its build.
    pub family: Family,
    /// The velocity profile that motion has by default.
    pub profile: VelocityProfile,
    /// Its geometry, ready to compute with.
    pub kinematics: Kinematics,
    /// The limits of the tool centre point.
    pub tcp: TcpLimits,
    /// The robot's own axes (six, or four), then the external ones (up to six).
    pub axes: Vec<Axis>,
    /// What its drives are held against.
    pub drives: DriveLimits,
    /// The links, where the file has them: as many as the robot has own axes, or none.
    pub links: Vec<Link>,
    /// Where the simulated robot starts: one position for each of `axes`, in deg (mm).
    pub home: Vec<f64>,
}

impl Robot {
    /// The names of the robots that are built in; the first is the default.
    pub fn builtin_names() -> impl Iterator<Item = &'static str> {
        builtin::ROBOTS.iter().map(|(name, _)| *name)
    }

    /// The built-in robot of this name, whatever its case.
    ///
    /// # Errors
    /// There is no robot of this name built in.
    pub fn builtin(name: &str) -> Result<Robot, RobotError> {
        let text = Robot::text(name).ok_or_else(|| builtin::unknown(name))?;
        Robot::parse(name, text)
    }

    /// The robot file of a built-in robot, whatever the case of its name.
    pub fn text(name: &str) -> Option<&'static str> {
        builtin::ROBOTS.iter().find(|(known, _)| known.eq_ignore_ascii_case(name)).map(|(_, text)| *text)
    }

    /// The built-in robot of this name, or else the robot file at this path.
    ///
    /// # Errors
    /// Nothing of this name is built in and no such file can be read, or the file is wrong: then with line and column.
    pub fn load(name_or_path: &str) -> Result<Robot, RobotError> {
        Robot::load_with(name_or_path, &Changes::default())
    }

    /// The same with other values at some places.
    ///
    /// # Errors
    /// As for [`load`](Self::load), or the file has no such place.
    pub fn load_with(name_or_path: &str, changes: &Changes) -> Result<Robot, RobotError> {
        let text = changes.apply(Part::Robot, name_or_path, Robot::source(name_or_path)?.into_owned())?;
        Robot::parse(name_or_path, &text)
    }

    /// The robot file of a robot that is built in, or that at this path.
    fn source(name_or_path: &str) -> Result<Cow<'static, str>, RobotError> {
        if let Some(text) = Robot::text(name_or_path) {
            return Ok(Cow::Borrowed(text));
        }
        let looks_like_path = name_or_path.ends_with(".toml") || name_or_path.contains(['/', '\\']);
        match regular_file::read_text(Path::new(name_or_path)) {
            Ok(text) => Ok(Cow::Owned(text)),
            Err(_) if !looks_like_path => Err(builtin::unknown(name_or_path)),
            Err(error) => Err(RobotError::of_file(name_or_path, format!("cannot read the robot file: {error}"))),
        }
    }

    /// The robot that `text` describes; `file` names the text in errors.
    ///
    /// # Errors
    /// The text is no TOML, or no robot: with line, column and what was expected.
    pub fn parse(file: &str, text: &str) -> Result<Robot, RobotError> {
        read::robot(file, text)
    }

    /// The robot's own axes: six, or four.
    pub fn own_axes(&self) -> &[Axis] {
        self.axes.get(..own_axes(self.family)).unwrap_or(&self.axes)
    }

    /// The external axes: `ej1`...
    pub fn external_axes(&self) -> &[Axis] {
        self.axes.get(own_axes(self.family)..).unwrap_or(&[])
    }
}
