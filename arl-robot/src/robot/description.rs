//! The description of a robot, and the check that it is valid.

use super::{
    Axis, DriveLimits, EXTERNAL_AXES, Family, Link, Robot, RobotError, TcpLimits, VelocityProfile, axis_name, own_axes,
};
use crate::kinematics::{Kinematics, Opw, Scara};

/// The parameters of a robot: plain data, checked by [`Robot::new`]. To get a robot with other values, take the
/// description of one, change it, and create another robot from it:
///
/// ```
/// # #[cfg(feature = "files")] {
/// use arl_robot::Robot;
///
/// let mut slower = Robot::builtin("kr10-r1420")?.into_description();
/// for axis in &mut slower.axes {
///     axis.vel *= 0.5;
/// }
/// let slower = Robot::new(slower)?;
/// assert_eq!(slower.axes[0].vel, 110.0);
///
/// let mut lame = slower.into_description();
/// lame.axes[0].vel = 0.0;
/// assert!(Robot::new(lame).unwrap_err().to_string().starts_with("kr10-r1420: `vel` of j1 is 0"));
/// # }
/// # Ok::<(), arl_robot::robot::RobotError>(())
/// ```
#[derive(Clone, PartialEq, Debug)]
pub struct Description {
    /// The robot's name.
    pub name: String,
    /// The kind of robot.
    pub family: Family,
    /// The default velocity profile of motions.
    pub profile: VelocityProfile,
    /// Its geometry, ready to compute with.
    pub kinematics: Kinematics,
    /// The limits of the tool centre point.
    pub tcp: TcpLimits,
    /// The robot's own axes (six, or four), then the external ones (up to six).
    pub axes: Vec<Axis>,
    /// The limits for monitoring its drives.
    pub drives: DriveLimits,
    /// The links, if the file has them: one for each of the robot's own axes, or none.
    pub links: Vec<Link>,
    /// The start position of the simulated robot: one value for each of `axes`, in deg (mm).
    pub home: Vec<f64>,
}

/// The largest length, angle or position of a robot, in mm or deg.
pub(super) const LARGEST: f64 = 1e6;
/// The largest speed, acceleration, jerk, mass or inertia, in the unit of its key.
pub(super) const LARGEST_LIMIT: f64 = 1e12;
/// The smallest limit or mass: at a lower speed a motion would never end.
pub(super) const SMALLEST: f64 = 1e-6;

impl Description {
    /// Checks that the description is a valid robot; the error is a sentence.
    pub(super) fn check(&self) -> Result<(), RobotError> {
        let checked = self
            .check_geometry()
            .and_then(|()| self.check_tcp())
            .and_then(|()| self.check_axes())
            .and_then(|()| self.check_drives())
            .and_then(|()| self.check_links());
        checked.map_err(|message| RobotError::of_file(&self.name, message))
    }

    fn check_geometry(&self) -> Result<(), String> {
        match (&self.kinematics, self.family) {
            (Kinematics::SixAxis(opw), Family::SixAxis) => six_axes(opw),
            (Kinematics::Scara(scara), Family::Scara) => four_axes(scara),
            _ => Err("`kinematics` belongs to another family of robots than `family`".to_owned()),
        }
    }

    fn check_tcp(&self) -> Result<(), String> {
        let TcpLimits { vel, acc, jerk, ori_vel, ori_acc, ori_jerk } = self.tcp;
        let limits = [
            ("vel", vel, "a speed"),
            ("acc", acc, "an acceleration"),
            ("jerk", jerk, "a jerk"),
            ("ori_vel", ori_vel, "a speed"),
            ("ori_acc", ori_acc, "an acceleration"),
            ("ori_jerk", ori_jerk, "a jerk"),
        ];
        all_positive("the TCP", &limits, LARGEST_LIMIT)
    }

    fn check_axes(&self) -> Result<(), String> {
        let (own, found) = (own_axes(self.family), self.axes.len());
        let most = own + EXTERNAL_AXES;
        if !(own..=most).contains(&found) {
            return Err(format!("there are {found} axes: expected {own} to {most}"));
        }
        for (at, axis) in self.axes.iter().enumerate() {
            self.check_axis(at, axis)?;
        }
        if self.home.len() != found {
            return Err(format!("`home` has {} positions: expected {found}, one for each axis", self.home.len()));
        }
        let outside = |(home, axis): &(&f64, &Axis)| !(axis.min..=axis.max).contains(*home);
        match self.home.iter().zip(&self.axes).find(outside) {
            Some((home, axis)) => {
                Err(format!("`home` of {} is {home}: expected {} to {}", axis.name, axis.min, axis.max))
            }
            None => Ok(()),
        }
    }

    fn check_axis(&self, at: usize, axis: &Axis) -> Result<(), String> {
        let Axis { name, linear, min, max, vel, acc, jerk } = axis;
        let expected = axis_name(self.family, at);
        if *name != expected {
            return Err(format!(
                "axis {} is named \"{name}\": expected \"{expected}\"; the axes must be in order",
                at + 1
            ));
        }
        if at < own_axes(self.family) && *linear != lifts(self.family, at) {
            return Err(format!("`linear` of {name} is {linear}: expected {}", !linear));
        }
        all_within(name, &[("min", *min), ("max", *max)], LARGEST)?;
        if min >= max {
            return Err(format!("`min` of {name} is {min}: expected less than its `max`, {max}"));
        }
        let limits = [("vel", *vel, "a speed"), ("acc", *acc, "an acceleration"), ("jerk", *jerk, "a jerk")];
        all_positive(name, &limits, LARGEST_LIMIT)
    }

    fn check_drives(&self) -> Result<(), String> {
        let DriveLimits { following, feedback, settling, settled } = &self.drives;
        if following.len() != self.axes.len() {
            let (found, expected) = (following.len(), self.axes.len());
            return Err(format!("`following` has {found} distances: expected {expected}, one for each axis"));
        }
        for (axis, following) in self.axes.iter().zip(following) {
            all_positive(&axis.name, &[("following", *following, "a distance")], LARGEST_LIMIT)?;
        }
        let limits =
            [("feedback", *feedback, "a time"), ("settling", *settling, "a time"), ("settled", *settled, "a distance")];
        all_positive("the drives", &limits, LARGEST_LIMIT)
    }

    fn check_links(&self) -> Result<(), String> {
        let (own, found) = (own_axes(self.family), self.links.len());
        if found != 0 && found != own {
            return Err(format!("there are {found} links: expected {own}, one for each axis of the robot, or none"));
        }
        for (number, link) in (1..).zip(&self.links) {
            let Link { mass, com, inertia, gear, torque_constant } = link;
            let name = format!("link {number}");
            let motor = [
                ("mass", *mass, "a mass"),
                ("gear", *gear, "turns of the motor"),
                ("torque_constant", *torque_constant, "a torque for one ampere"),
            ];
            all_positive(&name, &motor, LARGEST_LIMIT)?;
            all_within(&name, &com.map(|value| ("com", value)), LARGEST)?;
            all_within(&name, &inertia.map(|value| ("inertia", value)), LARGEST_LIMIT)?;
        }
        Ok(())
    }
}

/// Whether an axis, from 0, is the lift axis.
pub(super) fn lifts(family: Family, at: usize) -> bool {
    family == Family::Scara && at == 2
}

fn six_axes(opw: &Opw) -> Result<(), String> {
    let p = opw.parameters();
    let lengths = [("a1", p.a1), ("a2", p.a2), ("b", p.b), ("c1", p.c1), ("c4", p.c4)];
    all_within("the geometry", &lengths, LARGEST)?;
    all_within("the geometry", &p.offsets.map(|offset| ("offsets", offset)), LARGEST)?;
    if let Some(sign) = p.signs.iter().find(|sign| sign.abs() != 1.0) {
        return Err(format!("`signs` of the geometry has {sign}: expected six signs, 1 or -1"));
    }
    all_positive("the geometry", &[("c2", p.c2, "a length"), ("c3", p.c3, "a length")], LARGEST)
}

fn four_axes(scara: &Scara) -> Result<(), String> {
    all_within("the geometry", &[("z0", scara.z0)], LARGEST)?;
    all_positive("the geometry", &[("l1", scara.l1, "a length"), ("l2", scara.l2, "a length")], LARGEST)
}

fn all_within(of: &str, values: &[(&str, f64)], most: f64) -> Result<(), String> {
    match values.iter().find(|(_, value)| value.is_nan() || value.abs() > most) {
        Some((key, value)) => {
            Err(format!("`{key}` of {of} is {value:?}: expected a number from -{most:?} to {most:?}"))
        }
        None => Ok(()),
    }
}

fn all_positive(of: &str, values: &[(&str, f64, &str)], most: f64) -> Result<(), String> {
    match values.iter().find(|(_, value, _)| !(SMALLEST..=most).contains(value)) {
        Some((key, value, what)) => {
            Err(format!("`{key}` of {of} is {value:?}: expected {what} from {SMALLEST:?} to {most:?}"))
        }
        None => Ok(()),
    }
}

impl Robot {
    /// The robot with this description.
    ///
    /// # Errors
    /// The description is not a valid robot: a length or an angle is beyond 1e6 mm (deg), a limit, a mass or the length
    /// of an arm is not above 1e-6 or too large, a range is empty, or there are too few or too many of something.
    pub fn new(description: Description) -> Result<Robot, RobotError> {
        description.check()?;
        Ok(Robot(description))
    }

    /// The description of the robot, to be changed.
    pub fn into_description(self) -> Description {
        self.0
    }
}
