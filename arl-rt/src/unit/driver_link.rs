//! The link to the driver of a robot, until the robot is released.

use crate::motion::Joints;
use crate::unit::robot_driver::{Drives, Feedback, Power, RobotDriver, Setpoint};

/// A driver that is not called any more once it is closed.
pub(super) struct DriverLink {
    driver: Box<dyn RobotDriver>,
    closed: bool,
}

impl DriverLink {
    /// A link to a driver that has been started.
    pub(super) fn new(driver: Box<dyn RobotDriver>) -> Self {
        Self { driver, closed: false }
    }

    /// Sends the set-point to the driver, and returns its feedback.
    pub(super) fn exchange(&mut self, setpoint: &Setpoint) -> Feedback {
        if self.closed { Feedback::none() } else { self.driver.exchange(setpoint) }
    }

    /// Whether the driver wants torques with its set-points.
    pub(super) fn wants_torque(&self) -> bool {
        !self.closed && self.driver.wants_torque()
    }

    /// Reports that the robot was moved while its motors did not hold it.
    pub(super) fn moved_by_hand(&mut self, here: &Joints) {
        if !self.closed {
            self.driver.moved_by_hand(here);
        }
    }

    /// Switches the motors; returns the state of the drives.
    pub(super) fn switch(&mut self, power: Power) -> Drives {
        if self.closed { Drives::Off } else { self.driver.switch(power) }
    }

    /// A warning of the driver for the user, once.
    pub(super) fn take_warning(&mut self) -> Option<String> {
        if self.closed { None } else { self.driver.take_warning() }
    }

    /// Releases the robot, once, after its motors were switched as given. The driver is not called any more.
    pub(super) fn close(&mut self, power: Option<Power>) {
        if std::mem::replace(&mut self.closed, true) {
            return;
        }
        if let Some(power) = power {
            self.driver.switch(power);
        }
        self.driver.close();
    }
}
