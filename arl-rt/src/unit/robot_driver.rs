//! The border to the robot: set-points out, feedback in, once a cycle.

use crate::motion::Joints;
use arl_robot::robot::ROBOT_AXES;

/// How long the simulated robot's set-points take to be followed, in s.
const LAG: f64 = 0.008;
/// The same in cycles, at least and at most: there is always some lag.
const CYCLES: (f64, f64) = (2.0, KEPT as f64);
/// How many set-points the simulated robot keeps.
const KEPT: usize = 8;

/// How near feedback must be to its set-point to count as settled, in deg (mm).
pub const SETTLED: f64 = 0.001;

/// Moves a robot. Calls must return at once.
pub trait RobotDriver {
    /// Where the robot is when the controller starts, in deg (mm). `home` is what the robot file says.
    fn start(&mut self, home: &Joints) -> Joints;

    /// Takes the set-point of a cycle of `period` seconds, in deg (mm); says where the robot is.
    fn exchange(&mut self, setpoint: &Joints, period: f64) -> Joints;

    /// Switches the motors on or off. While they are off, the set-point is where the robot reports to be.
    fn switch(&mut self, on: bool) {
        let _ = on;
    }

    /// Says that somebody has moved the robot here while its motors are off: for simulated robots.
    fn moved_by_hand(&mut self, to: &Joints) {
        let _ = to;
    }

    /// The torques (Nm; N of linear axes) that the motors of the robot's own axes gave at the axes in the last
    /// [`exchange`](RobotDriver::exchange). `None`: the robot does not measure them; then the controller takes what its
    /// model asks for the motion that the robot reports, and what a scenario does to the robot.
    fn torques(&self) -> Option<[f64; ROBOT_AXES]> {
        None
    }
}

/// A robot that follows its set-point with a lag: it is where the mean of its last set-points is, those of 8 ms and at
/// least two. So it moves no more jerkily than it is told to, half of that time late, and stands exactly on its set-point
/// when that has rested for as long.
#[derive(Clone, Debug, Default)]
pub struct SimulatedRobot {
    last: Option<[Joints; KEPT]>,
    /// Which of `last` is the oldest.
    oldest: usize,
}

impl SimulatedRobot {
    /// A robot that stands at home.
    pub fn new() -> Self {
        Self::default()
    }
}

impl RobotDriver for SimulatedRobot {
    fn start(&mut self, home: &Joints) -> Joints {
        let [position, ..] = self.last.get_or_insert([*home; KEPT]);
        *position
    }

    fn moved_by_hand(&mut self, to: &Joints) {
        self.last = Some([*to; KEPT]);
    }

    fn exchange(&mut self, setpoint: &Joints, period: f64) -> Joints {
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
        // Seen from the set-point, so that no rounding is left when all are the same.
        let mut position = *setpoint;
        for old in last.iter().take(count as usize) {
            let axes = position.axes.iter_mut().zip(&old.axes).zip(&setpoint.axes);
            let external = position.external.iter_mut().zip(&old.external).zip(&setpoint.external);
            for ((position, old), setpoint) in axes.chain(external) {
                *position += (old - setpoint) / count;
            }
        }
        position
    }
}

/// Whether feedback is where it shall be.
pub(crate) fn settled(setpoint: &Joints, feedback: &Joints) -> bool {
    let near = |(a, b): (&f64, &f64)| (a - b).abs() <= SETTLED;
    setpoint.axes.iter().zip(&feedback.axes).all(near) && setpoint.external.iter().zip(&feedback.external).all(near)
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_robot::robot::Robot;

    #[test]
    fn the_simulated_robot_follows_and_settles_on_its_set_point() {
        let home = Joints::home(&Robot::builtin("kr10-r1420").unwrap());
        let mut robot = SimulatedRobot::new();
        assert_eq!(robot.start(&home), home);
        let mut target = home;
        target.axes[0] += 1.0;
        let first = robot.exchange(&target, 0.001);
        assert!(first.axes[0] > home.axes[0] && first.axes[0] < home.axes[0] + 0.5, "it lags: {first:?}");
        assert!(!settled(&target, &first));
        let cycles = (0..100).position(|_| robot.exchange(&target, 0.001) == target).unwrap();
        assert_eq!(cycles + 2, 8);
    }

    #[test]
    fn an_even_motion_is_followed_evenly_and_some_cycles_late() {
        let home = Joints::home(&Robot::builtin("kr10-r1420").unwrap());
        for (period, late) in [(0.001, 3.5), (0.004, 0.5), (0.02, 0.5)] {
            let mut robot = SimulatedRobot::new();
            robot.start(&home);
            for cycle in 1..50 {
                let mut target = home;
                target.axes[1] += 0.25 * f64::from(cycle);
                let found = robot.exchange(&target, period);
                if cycle > 8 {
                    assert!((found.axes[1] - (target.axes[1] - 0.25 * late)).abs() < 1e-9, "{period} {found:?}");
                }
            }
        }
    }
}
