//! What the command knows of a robot from its file.

use super::failure::Failure;
use super::robots;
use crate::{Arm, AxisRange, RobotLimits};

/// How many axes a trace holds: six of the robot, six external ones.
pub(super) const AXES: usize = 12;

/// An axis and its limits.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Axis {
    pub(super) name: String,
    /// deg/s, or mm/s for linear ones.
    pub(super) vel: f64,
    /// Lowest and highest position, deg or mm.
    pub(super) range: [f64; 2],
    pub(super) linear: bool,
    /// Its column in the trace.
    pub(super) column: usize,
}

/// The robot's name and limits.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Robot {
    pub(super) name: String,
    pub(super) axes: Vec<Axis>,
    /// The highest speed of the TCP on lines, mm/s.
    pub(super) tcp: Option<f64>,
    pub(super) arm: Option<Arm>,
}

impl Robot {
    /// The robot that `--robot` names. What is wrong with its file is said when a program starts.
    pub(super) fn load(robot: Option<&str>) -> Result<Self, Failure> {
        let (name, text) = robots::text(robot)?;
        let table: toml::Table = toml::from_str(&text)
            .map_err(|error| Failure::Usage(format!("{name}: this is not TOML: {}", error.message())))?;
        let scara = table.get("family").and_then(|family| family.as_str()) == Some("scara");
        let own = if scara { 4 } else { 6 };
        let axes = table.get("axis").and_then(|axes| axes.as_array()).map(Vec::as_slice).unwrap_or_default();
        let axes = axes.iter().enumerate().filter_map(|(at, axis)| {
            let external = at >= own;
            let name = axis.get("name").and_then(|name| name.as_str()).map_or_else(
                || if external { format!("ej{}", at - own + 1) } else { format!("j{}", at + 1) },
                str::to_owned,
            );
            let linear = axis.get("linear").and_then(toml::Value::as_bool).unwrap_or(scara && at == 2);
            let column = if external { at - own + 6 } else { at };
            let figure = |key: &str| number(axis.get(key)?);
            let range = [figure("min")?, figure("max")?];
            Some(Axis { name, vel: figure("vel")?, range, linear, column }).filter(|axis| axis.column < AXES)
        });
        let axes = axes.collect();
        let tcp = table.get("tcp").and_then(|tcp| tcp.get("vel")).and_then(number);
        let named = table.get("name").and_then(|name| name.as_str()).unwrap_or(&name).to_owned();
        let arm = table.get("geometry").and_then(|geometry| arm(geometry, scara));
        Ok(Self { name: named, axes, tcp, arm })
    }

    /// What the checker is told of the robot.
    pub(super) fn limits(&self) -> RobotLimits {
        let axis = |axis: &Axis| {
            let [min, max] = axis.range;
            AxisRange { name: axis.name.clone(), min, max, linear: axis.linear }
        };
        RobotLimits { name: self.name.clone(), axes: self.axes.iter().map(axis).collect(), arm: self.arm }
    }
}

fn arm(geometry: &toml::Value, scara: bool) -> Option<Arm> {
    let length = |key: &str| geometry.get(key).and_then(number);
    if scara {
        return Some(Arm::Scara { l1: length("l1")?, l2: length("l2")? });
    }
    let [a1, a2, b] = ["a1", "a2", "b"].map(length);
    let (c1, c2, c3, c4) = (length("c1")?, length("c2")?, length("c3")?, length("c4")?);
    Some(Arm::SixAxis { a1: a1?, a2: a2?, b: b?, c1, c2, c3, c4 })
}

fn number(value: &toml::Value) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|number| number as f64))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn built_in_robots_have_limits() {
        let robot = Robot::load(Some("hsr065")).unwrap();
        assert_eq!((robot.name.as_str(), robot.axes.len(), robot.tcp), ("hsr065", 4, Some(2500.0)));
        assert!(robot.axes[2].linear && !robot.axes[3].linear && robot.axes[3].column == 3);
        assert_eq!(Robot::load(None).unwrap().axes.len(), 6);
    }
}
