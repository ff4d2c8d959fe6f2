//! The border to the robot: set-points out, feedback in, once a cycle.

use crate::motion::Joints;

/// The time constant of the simulated robot's following error, in s.
const LAG: f64 = 0.004;

/// How near feedback must be to its set-point to count as settled, in deg (mm).
pub const SETTLED: f64 = 0.001;

/// Moves a robot. Calls must return at once.
pub trait RobotDriver {
    /// Where the robot is when the controller starts, in deg (mm). `home` is what the robot file says.
    fn start(&mut self, home: &Joints) -> Joints;

    /// Takes the set-point of a cycle of `period` seconds, in deg (mm); says where the robot is.
    fn exchange(&mut self, setpoint: &Joints, period: f64) -> Joints;
}

/// A robot that follows its set-point with a small lag of first order, and stands still exactly on it.
#[derive(Clone, Debug, Default)]
pub struct SimulatedRobot {
    position: Option<Joints>,
}

impl SimulatedRobot {
    /// A robot that stands at home.
    pub fn new() -> Self {
        Self::default()
    }
}

impl RobotDriver for SimulatedRobot {
    fn start(&mut self, home: &Joints) -> Joints {
        *self.position.get_or_insert(*home)
    }

    fn exchange(&mut self, setpoint: &Joints, period: f64) -> Joints {
        let share = 1.0 - (-period / LAG).exp();
        let position = self.position.get_or_insert(*setpoint);
        let axes = position.axes.iter_mut().zip(&setpoint.axes);
        let external = position.external.iter_mut().zip(&setpoint.external);
        for (position, setpoint) in axes.chain(external) {
            let error = setpoint - *position;
            // Within the tolerance it is there: an encoder does not tell the difference.
            *position = if error.abs() <= SETTLED { *setpoint } else { *position + error * share };
        }
        *position
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
    use crate::robot::Robot;

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
        assert!((10..60).contains(&cycles), "{cycles}");
    }
}
