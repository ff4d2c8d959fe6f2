//! The settings of a foreground channel beyond the first.

use std::fmt;
use std::io::Write;

use crate::context::program::Program;
use crate::unit::robot_driver::{RobotDriver, SimulatedRobot};
use crate::values;
use arl_robot::cell::{DriverSettings, Homes, Sensitivity};
use arl_robot::robot::Robot;

/// A foreground channel: a program and its own robot. By default that is the default robot of the program's family,
/// simulated.
pub struct Foreground {
    pub(super) program: Box<dyn Program>,
    pub(super) body: Body,
}

/// A robot and what belongs to it.
pub(super) struct Body {
    pub(super) robot: Option<Robot>,
    pub(super) driver: Box<dyn RobotDriver>,
    /// Whether the driver is not ours.
    pub(super) has_driver: bool,
    /// The cell's settings for the driver, which count where robots are driven and no driver was given.
    pub(super) settings: Option<DriverSettings>,
    pub(super) trace: Option<Box<dyn Write>>,
    pub(super) homes: Homes,
    pub(super) collisions: Vec<(u8, Sensitivity)>,
    /// The robot's base in the world, where the cell gives it.
    pub(super) base: Option<values::Frame>,
}

impl Default for Body {
    fn default() -> Self {
        Self {
            robot: None,
            driver: Box::new(SimulatedRobot::new()),
            has_driver: false,
            settings: None,
            trace: None,
            homes: Homes::default(),
            collisions: Vec::new(),
            base: None,
        }
    }
}

impl Body {
    /// Moves the robot with this driver.
    pub(super) fn drive(&mut self, driver: impl RobotDriver + 'static) {
        (self.driver, self.has_driver) = (Box::new(driver), true);
    }
}

impl Foreground {
    /// A channel that runs this program.
    pub fn new(program: impl Program) -> Self {
        Self { program: Box::new(program), body: Body::default() }
    }

    /// The robot; by default the default robot of the program's family.
    pub fn robot(mut self, robot: Robot) -> Self {
        self.body.robot = Some(robot);
        self
    }

    /// The driver of the robot.
    pub fn robot_driver(mut self, driver: impl RobotDriver + 'static) -> Self {
        self.body.drive(driver);
        self
    }

    /// The settings of the robot's driver, which [`Builder::drivers`](super::Builder::drivers) makes from them.
    pub fn driver_settings(mut self, settings: DriverSettings) -> Self {
        self.body.settings = Some(settings);
        self
    }

    /// The writer for the trace of this robot, as CSV.
    pub fn trace(mut self, writer: impl Write + 'static) -> Self {
        self.body.trace = Some(Box::new(writer));
        self
    }

    /// The home points of this robot.
    pub fn homes(mut self, homes: Homes) -> Self {
        self.body.homes = homes;
        self
    }

    /// The conditions of `startdetect` for this robot by their numbers; for those that are missing, 20 %.
    pub fn collisions(mut self, conditions: Vec<(u8, Sensitivity)>) -> Self {
        self.body.collisions = conditions;
        self
    }

    /// The robot's base in the world, in mm and deg: `$BASE[0]` from the start on, whatever was saved. By default that
    /// is what was saved, or the world's origin.
    pub fn base(mut self, base: values::Frame) -> Self {
        self.body.base = Some(base);
        self
    }
}

impl fmt::Debug for Foreground {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Foreground").field("program", &self.program.file().name()).finish_non_exhaustive()
    }
}
