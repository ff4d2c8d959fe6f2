//! What a plot shows of a robot.

use arl_robot::robot;

/// The number of axes in a trace: six of the robot, six external ones.
pub(super) const AXES: usize = 12;

/// An axis in a trace.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct TraceAxis {
    pub(super) name: String,
    /// deg/s, or mm/s for linear ones.
    pub(super) vel: f64,
    pub(super) linear: bool,
    /// Its column in the trace.
    pub(super) column: usize,
}

/// What a plot shows of a robot.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) axes: Vec<TraceAxis>,
    /// The highest speed of the TCP on lines, mm/s.
    pub(super) tcp: f64,
}

impl Robot {
    /// Takes these from a robot.
    pub(super) fn of(robot: robot::Robot) -> Self {
        let own = robot.own_axes().len();
        let columns = (0..own).chain(robot::ROBOT_AXES..AXES);
        let axis = |(axis, column): (&robot::Axis, usize)| TraceAxis {
            name: axis.name.clone(),
            vel: axis.vel,
            linear: axis.linear,
            column,
        };
        let axes = robot.axes.iter().zip(columns).map(axis).collect();
        Self { axes, tcp: robot.tcp.vel, name: robot.into_description().name }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_robots_have_limits() {
        let robot = Robot::of(robot::Robot::load("hsr065").unwrap());
        assert_eq!((robot.name.as_str(), robot.axes.len(), robot.tcp), ("hsr065", 4, 2500.0));
        assert!(robot.axes[2].linear && !robot.axes[3].linear && robot.axes[3].column == 3);
        assert_eq!(Robot::of(robot::Robot::load("six-10").unwrap()).axes.len(), 6);
    }
}
