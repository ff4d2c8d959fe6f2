//! What tests of drivers share.

#![allow(dead_code, clippy::unwrap_used, reason = "each test file takes some of it")]

use arl_rt::emit::*;
use arl_rt::motion::Joints as Positions;
use arl_rt::robot_driver::{RobotDriver, Start};
use arl_rt::{Program, Robot};

/// A program that turns axis 1 by 10 deg.
struct Turn;

impl Program for Turn {
    fn file(&self) -> File {
        File::new("turn.arl")
    }

    fn family(&self) -> Family {
        Family::SixAxis
    }

    fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
        Box::pin(async move {
            let target = Joint { j1: 10.0, j2: 0.0, j3: 0.0, j4: 0.0, j5: 0.0, j6: 0.0, ..Joint::default() };
            motion::movej(target).vp(100.0).run(cx).await.at(self.file(), 2)?;
            flow::waittime(0.0).run(cx).await.at(self.file(), 3)
        })
    }
}

pub(crate) fn program() -> Box<dyn Program> {
    Box::new(Turn)
}

/// Axis 1 there, in deg.
pub(crate) fn joints(axis: f64) -> Positions {
    Positions { axes: [axis, 0.0, 0.0, 0.0, 0.0, 0.0], external: [0.0; 6] }
}

/// Starts a driver as a controller does.
pub(crate) fn start(driver: &mut impl RobotDriver) -> Result<Positions, String> {
    let robot = Robot::builtin("kr10-r1420").unwrap();
    driver.start(&Start::new(&joints(0.0), &robot, 0.004)).map_err(|error| error.to_string())
}
