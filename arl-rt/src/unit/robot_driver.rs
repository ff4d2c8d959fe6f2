//! The interface to the robot: set-points out, feedback in, once a cycle.
//!
//! `docs/drivers.md` describes how the controller interprets the reports of a driver, and when it switches the motors
//! on and off.

use std::time::Instant;

pub use crate::io::DriverError;
use crate::motion::Joints;
use arl_robot::cell::DriverSettings;
use arl_robot::robot::{ROBOT_AXES, Robot};

use super::range;
use crate::cycle::clock_source::Clock;

/// The time in which the simulated robot reaches its set-point, in s.
const LAG: f64 = 0.008;
/// The lag in cycles, minimum and maximum: there is always some lag.
const CYCLES: (f64, f64) = (2.0, KEPT as f64);
/// How many set-points the simulated robot keeps.
const KEPT: usize = 8;

/// What a driver is given before anything moves.
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Start<'a> {
    /// The initial position in the robot file, in deg (mm).
    pub home: &'a Joints,
    /// The robot: the ranges of its axes, their speeds, accelerations and jerks.
    pub robot: &'a Robot,
    /// The length of a cycle in s.
    pub period: f64,
}

impl<'a> Start<'a> {
    /// For trying a driver without a controller: deg (mm), s.
    pub fn new(home: &'a Joints, robot: &'a Robot, period: f64) -> Self {
        Self { home, robot, period }
    }

    /// Checks the position (deg, mm) that a robot reports before its motors are switched on: it has to be possible by
    /// the robot file.
    ///
    /// # Errors
    /// The position of an axis is not a number, or outside of its range by more than what counts as settled; which
    /// axis.
    pub fn begin_at(&self, position: Joints) -> Result<Joints, String> {
        match range::first_outside(&position, self.robot) {
            None => Ok(position),
            Some(outside) => Err(format!("{outside}: does the robot file match this robot?")),
        }
    }
}

/// The set-point of a robot in a cycle.
#[derive(Clone, Copy, PartialEq, Debug)]
#[non_exhaustive]
pub struct Setpoint {
    /// The axis positions at the end of the cycle, in deg (mm).
    pub position: Joints,
    /// The speeds of the axes, in deg/s (mm/s): the change of the position since the cycle before, per s.
    pub velocity: Joints,
    /// The accelerations of the robot's own axes, in deg/s2 (mm/s2), likewise.
    pub acceleration: [f64; ROBOT_AXES],
    /// The torques (Nm; N of linear axes) that the motion needs by the masses of the robot file and the load: for
    /// feed-forward. `None`: the file has no masses, or the driver does not [want](RobotDriver::wants_torque) them.
    pub torque: Option<[f64; ROBOT_AXES]>,
    /// The length of the cycle in s.
    pub period: f64,
    /// When the cycle ends, by which the drives should have the set-point; `None`: the cycles do not take real time.
    pub deadline: Option<Instant>,
}

/// The feedback of a robot in a cycle.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub struct Feedback {
    /// The axis positions, in deg (mm); `None`: nothing new has arrived since the last cycle.
    pub position: Option<Joints>,
    /// The speeds of the axes, in deg/s (mm/s); `None`: the robot does not measure them. They are then computed from
    /// the positions.
    pub velocity: Option<Joints>,
    /// The torques (Nm; N of linear axes) that the motors of the robot's own axes give at the axes; `None`: the robot
    /// does not measure them. The controller then takes the torques of its model for the reported motion, and the
    /// external forces of a scenario.
    pub torque: Option<[f64; ROBOT_AXES]>,
    /// The state of the drives; `None`: nothing new has arrived.
    pub drives: Option<Drives>,
}

/// The state of the drives of a robot.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Drives {
    /// They hold the robot, and follow set-points.
    On,
    /// They are off: brakes hold the robot.
    Off,
    /// They have this fault, which a person has to clear.
    Fault(Box<str>),
}

impl Setpoint {
    /// To stay at a position (deg, mm), for a cycle of `period` s: what a driver uses before it gets the first
    /// set-point.
    pub fn resting(position: Joints, period: f64) -> Self {
        let velocity = Joints { axes: [0.0; 6], external: [0.0; 6] };
        Self { position, velocity, acceleration: [0.0; ROBOT_AXES], torque: None, period, deadline: None }
    }
}

impl Feedback {
    /// A robot at this position (deg, mm), with its drives on.
    pub fn at(position: Joints) -> Self {
        Self { position: Some(position), velocity: None, torque: None, drives: Some(Drives::On) }
    }

    /// Nothing new has arrived.
    pub fn none() -> Self {
        Self { position: None, velocity: None, torque: None, drives: None }
    }

    /// The same feedback with measured speeds, in deg/s (mm/s).
    pub fn with_velocity(self, velocity: Joints) -> Self {
        Self { velocity: Some(velocity), ..self }
    }

    /// The same feedback with measured torques, in Nm (N).
    pub fn with_torque(self, torque: [f64; ROBOT_AXES]) -> Self {
        Self { torque: Some(torque), ..self }
    }

    /// The same feedback with another state of the drives.
    pub fn with_drives(self, drives: Drives) -> Self {
        Self { drives: Some(drives), ..self }
    }
}

/// A command to the motors.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Power {
    /// To be on and to hold the robot where it is.
    On,
    /// To be off: the robot is at rest, brakes hold it from now on.
    Off,
    /// To be off now, whatever the robot does: an emergency. It brakes by itself.
    Cut,
}

/// Moves a robot. All calls but [`start`](RobotDriver::start) and [`close`](RobotDriver::close) must return at once.
///
/// ```
/// use arl_rt::robot_driver::{DriverError, Drives, Feedback, Power, RobotDriver, Setpoint, Start};
/// use arl_rt::motion::Joints;
///
/// /// A robot that is where it shall be.
/// struct Perfect;
///
/// impl RobotDriver for Perfect {
///     fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
///         Ok(*start.home)
///     }
///
///     fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
///         Feedback::at(setpoint.position)
///     }
///
///     fn switch(&mut self, power: Power) -> Drives {
///         if power == Power::On { Drives::On } else { Drives::Off }
///     }
/// }
///
/// let builder = arl_rt::Controller::builder().robot_driver(Perfect);
/// # let _ = builder;
/// ```
pub trait RobotDriver {
    /// Connects to the robot and switches its motors on, once, before the first cycle. It may take its time. Returns
    /// the position of the robot, in deg (mm); [`Start::begin_at`] checks it, before motors are switched on.
    ///
    /// # Errors
    /// Why the robot cannot be driven: the controller is not built.
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError>;

    /// Takes the set-point of a cycle; returns the latest feedback of the robot.
    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback;

    /// Switches the motors; returns the state of the drives. While they are off, set-points are the positions that the
    /// robot reports. Drives that are not [on](Drives::On) at once are waited for after [`Power::On`], five seconds at
    /// most.
    fn switch(&mut self, power: Power) -> Drives;

    /// Whether set-points should contain torques: these take some time to compute.
    fn wants_torque(&self) -> bool {
        false
    }

    /// Reports that the robot was moved here by hand while its motors are off: for simulated robots.
    fn moved_by_hand(&mut self, to: &Joints) {
        let _ = to;
    }

    /// A warning for the user, once; called in each cycle until there is none left.
    fn take_warning(&mut self) -> Option<String> {
        None
    }

    /// The controller ends; no method is called any more. It may take its time. A controller that ends while the robot
    /// moves has cut the power before. It is not called after a start that failed.
    fn close(&mut self) {}
}

/// A robot with the driver that a cell file describes.
pub struct Driven {
    /// The driver, which moves the robot.
    pub driver: Box<dyn RobotDriver>,
    /// Whose time counts.
    pub time: DrivenTime,
}

/// Whose time counts while a robot is driven.
#[non_exhaustive]
pub enum DrivenTime {
    /// Real time: cycles take the time that they stand for.
    World,
    /// The time of the robot, which is simulated: an exchange waits for it.
    Robot,
    /// The robot sets the control cycle: a cycle begins whenever this clock says so.
    Clock(Box<dyn Clock>),
}

/// Makes the driver that the settings of a cell file describe; it is not started yet. The error is the reason why there
/// is none.
pub type Connect = fn(&DriverSettings) -> Result<Driven, DriverError>;

/// A robot that follows its set-point with a lag: its position is the mean of its last set-points, those of 8 ms and at
/// least two. So it moves no more jerkily than commanded, half of that time late, and stands exactly on its set-point
/// once that has been at rest for as long.
#[derive(Clone, Debug, Default)]
pub struct SimulatedRobot {
    last: Option<[Joints; KEPT]>,
    /// The index of the oldest in `last`.
    oldest: usize,
    /// Its position when it was switched off, while it is off.
    off: Option<Joints>,
    /// Its position.
    position: Option<Joints>,
}

impl SimulatedRobot {
    /// A robot that stands at home.
    pub fn new() -> Self {
        Self::default()
    }
}

impl RobotDriver for SimulatedRobot {
    fn start(&mut self, start: &Start<'_>) -> Result<Joints, DriverError> {
        let [position, ..] = *self.last.get_or_insert([*start.home; KEPT]);
        self.position = Some(position);
        Ok(position)
    }

    fn switch(&mut self, power: Power) -> Drives {
        self.off = if power == Power::On { None } else { self.position };
        if let Some(position) = self.position {
            self.last = Some([position; KEPT]);
        }
        if power == Power::On { Drives::On } else { Drives::Off }
    }

    fn moved_by_hand(&mut self, to: &Joints) {
        (self.last, self.position) = (Some([*to; KEPT]), Some(*to));
        self.off = self.off.map(|_| *to);
    }

    fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        if let Some(position) = self.off {
            self.position = Some(position);
            return Feedback::at(position);
        }
        let Setpoint { position: setpoint, period, .. } = setpoint;
        let (least, most) = CYCLES;
        let count = (LAG / period).round().clamp(least, most);
        let last = self.last.get_or_insert([*setpoint; KEPT]);
        if self.oldest >= count as usize {
            self.oldest = 0;
        }
        if let Some(oldest) = last.get_mut(self.oldest) {
            *oldest = *setpoint;
        }
        self.oldest += 1;
        // Relative to the set-point, so that no rounding error is left when all are the same; in the order of their
        // age, so that a motion is the same to the last bit in whichever cycle it begins.
        let mut position = *setpoint;
        let (newer, older) = last.split_at(self.oldest);
        let older = older.iter().take((count as usize).saturating_sub(self.oldest));
        for old in older.chain(newer) {
            let axes = position.axes.iter_mut().zip(&old.axes).zip(&setpoint.axes);
            let external = position.external.iter_mut().zip(&old.external).zip(&setpoint.external);
            for ((position, old), setpoint) in axes.chain(external) {
                *position += (old - setpoint) / count;
            }
        }
        self.position = Some(position);
        Feedback::at(position)
    }
}

/// Whether the feedback is within this distance of the set-point, in deg (mm).
pub(crate) fn settled(setpoint: &Joints, feedback: &Joints, within: f64) -> bool {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= within;
    setpoint.axes.iter().zip(&feedback.axes).all(near) && setpoint.external.iter().zip(&feedback.external).all(near)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Sends a set-point at rest; returns the position of the robot.
    fn exchange(robot: &mut SimulatedRobot, position: &Joints, period: f64) -> Joints {
        robot.exchange(&Setpoint::resting(*position, period)).position.unwrap()
    }

    fn start(robot: &mut SimulatedRobot, home: &Joints, period: f64) -> Joints {
        let of = Robot::builtin("kr10-r1420").unwrap();
        robot.start(&Start { home, robot: &of, period }).unwrap()
    }

    #[test]
    fn the_simulated_robot_follows_and_settles_on_its_set_point() {
        let home = Joints::home(&Robot::builtin("kr10-r1420").unwrap());
        let mut robot = SimulatedRobot::new();
        assert_eq!(start(&mut robot, &home, 0.001), home);
        let mut target = home;
        target.axes[0] += 1.0;
        let first = exchange(&mut robot, &target, 0.001);
        assert!(first.axes[0] > home.axes[0] && first.axes[0] < home.axes[0] + 0.5, "it lags: {first:?}");
        assert!(!settled(&target, &first, 0.001));
        let cycles = (0..100).position(|_| exchange(&mut robot, &target, 0.001) == target).unwrap();
        assert_eq!(cycles + 2, 8);
    }

    #[test]
    fn an_even_motion_is_followed_evenly_and_some_cycles_late() {
        let home = Joints::home(&Robot::builtin("kr10-r1420").unwrap());
        for (period, late) in [(0.001, 3.5), (0.004, 0.5), (0.02, 0.5)] {
            let mut robot = SimulatedRobot::new();
            start(&mut robot, &home, period);
            for cycle in 1..50 {
                let mut target = home;
                target.axes[1] += 0.25 * f64::from(cycle);
                let found = exchange(&mut robot, &target, period);
                if cycle > 8 {
                    assert!((found.axes[1] - (target.axes[1] - 0.25 * late)).abs() < 1e-9, "{period} {found:?}");
                }
            }
        }
    }
}
