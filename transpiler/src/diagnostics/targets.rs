//! Targets that a robot cannot reach.

use super::declare::problems;
use super::{Code, Coded, Problem};
use arl_robot::kinematics::{CONFIGURATIONS, Singularity};
use arl_robot::robot::{Axis, Robot};

/// What is wrong with a target.
#[derive(Clone, PartialEq, Debug)]
pub(crate) struct TargetProblem {
    robot: String,
    kind: Kind,
    /// Whether the motion gives no workpiece frame, and the one in effect is not `$WORLD`.
    frame_above: bool,
    /// Whether the motion gives no tool, and the one in effect is not `$FLANGE`.
    tool_above: bool,
}

problems! {
    /// The kind of problem.
    enum Kind {
        warning 907 "A target beyond the range of an axis" => {
            /// A joint target out of the range of an axis, deg (mm).
            Joint { axis: Axis, value: f64, by: f64 },
            /// A pose that needs an axis position out of range; `others` are the configurations that do not.
            Pose { axis: Axis, value: f64, by: f64, cfg: u8, others: Vec<u8> },
        }
        warning 908 "A pose that the robot cannot reach" => {
            /// A pose that is farther away than the arm can reach, mm.
            OutOfReach { by: f64 },
            /// A pose for which a SCARA would have to tilt its flange, deg.
            Tilted { by: f64 },
        }
        warning 909 "A configuration that does not reach its pose" => {
            /// A configuration that the robot does not have.
            NoSuchCfg { cfg: i32 },
            /// A pose that other configurations reach.
            Configuration { cfg: u8, others: Vec<u8> },
        }
        warning 910 "A line that passes a singularity" => {
            /// A line that passes a singularity `along` it, 0 to 1.
            Singular { along: f64, at: Singularity },
        }
    }
}

impl TargetProblem {
    pub(crate) fn joint(robot: &Robot, axis: &Axis, value: f64, by: f64) -> Self {
        Self::new(robot, Kind::Joint { axis: axis.clone(), value, by })
    }

    pub(crate) fn pose(robot: &Robot, axis: &Axis, value: f64, by: f64, cfg: u8, others: Vec<u8>) -> Self {
        Self::new(robot, Kind::Pose { axis: axis.clone(), value, by, cfg, others })
    }

    pub(crate) fn out_of_reach(robot: &Robot, by: f64) -> Self {
        Self::new(robot, Kind::OutOfReach { by })
    }

    pub(crate) fn tilted(robot: &Robot, by: f64) -> Self {
        Self::new(robot, Kind::Tilted { by })
    }

    pub(crate) fn no_such_cfg(robot: &Robot, cfg: i32) -> Self {
        Self::new(robot, Kind::NoSuchCfg { cfg })
    }

    pub(crate) fn configuration(robot: &Robot, cfg: u8, others: Vec<u8>) -> Self {
        Self::new(robot, Kind::Configuration { cfg, others })
    }

    pub(crate) fn singular(robot: &Robot, along: f64, at: Singularity) -> Self {
        Self::new(robot, Kind::Singular { along, at })
    }

    fn new(robot: &Robot, kind: Kind) -> Self {
        Self { robot: robot.name.clone(), kind, frame_above: false, tool_above: false }
    }

    /// The same problem, if the workpiece frame or the tool in effect was set earlier.
    pub(crate) fn with_inherited(self, frame_above: bool, tool_above: bool) -> Self {
        Self { frame_above, tool_above, ..self }
    }
}

/// The consequence of a motion with such a target.
const ALARM: &str = "the motion would end in an alarm";

impl Coded for TargetProblem {
    fn code(&self) -> Code {
        self.kind.code()
    }
}

impl Problem for TargetProblem {
    fn message(&self) -> String {
        let robot = &self.robot;
        match &self.kind {
            Kind::Joint { axis, value, by } => {
                let (name, unit) = (&axis.name, unit(axis));
                format!("this target has {name} at {value} {unit}, {} {unit} beyond its range on {robot}", short(*by))
            }
            Kind::Pose { axis, value, by, cfg, .. } => {
                let (name, unit) = (&axis.name, unit(axis));
                let (value, by) = (short(*value), short(*by));
                format!("this pose has {name} at {value} {unit} in cfg {cfg}, {by} {unit} beyond its range on {robot}")
            }
            Kind::OutOfReach { by } => format!("this pose is {by:.3} mm beyond the reach of {robot}"),
            Kind::Tilted { by } => {
                format!(
                    "for this pose {robot} would have to tilt its flange by {} deg, which a SCARA cannot do",
                    short(*by)
                )
            }
            Kind::NoSuchCfg { cfg } => format!("{robot} has no configuration cfg {cfg}"),
            Kind::Configuration { cfg, .. } => format!("{robot} cannot reach this pose in cfg {cfg}"),
            Kind::Singular { along, at } => {
                let place = match at {
                    Singularity::Wrist => "axes 4 and 6 turn about nearly the same line",
                    Singularity::Elbow => "the arm is stretched, or folded upon itself",
                    Singularity::Shoulder => "the centre of the wrist is on axis 1",
                };
                format!("this line passes a singularity of {robot}: {:.1} % along it, {place}", along * 100.0)
            }
        }
    }

    fn label(&self) -> String {
        String::new()
    }

    fn help(&self) -> Option<String> {
        let words = match &self.kind {
            Kind::Joint { axis, .. } => format!("its range is {}; {ALARM}", range(axis)),
            Kind::Pose { axis, others, .. } => format!("its range is {}; {}{ALARM}", range(axis), reaching(others)),
            Kind::OutOfReach { .. } => {
                format!("that holds for every configuration, with the tool and the workpiece of this motion; {ALARM}")
            }
            Kind::Tilted { .. } => {
                format!("with tool and workpiece, a, b and c must leave the flange upright; {ALARM}")
            }
            Kind::NoSuchCfg { .. } => format!("{CONFIGURATIONS}; {ALARM}"),
            Kind::Configuration { others, .. } => format!("{}{ALARM}", reaching(others)),
            Kind::Singular { at: Singularity::Wrist, .. } => format!(
                "an axis would have to turn infinitely fast, and {ALARM}; tilt the tool by a few degrees, go there with ptp or movej, or \
                 let $WRIST guide the wrist through"
            ),
            Kind::Singular { .. } => format!(
                "an axis would have to turn infinitely fast, and {ALARM}; keep the line away from it, or go there with ptp or movej"
            ),
        };
        let (labels, above) = match (self.frame_above, self.tool_above) {
            (false, false) => return Some(words),
            (true, false) => ("`w:`", "the workpiece frame set above still applies"),
            (false, true) => ("`t:`", "the tool set above still applies"),
            (true, true) => ("`w:` and `t:`", "the workpiece frame and tool set above still apply"),
        };
        Some(format!("{words}; this motion gives no {labels}: {above}. Give {labels} here"))
    }
}

fn unit(axis: &Axis) -> &'static str {
    if axis.linear { "mm" } else { "deg" }
}

fn range(axis: &Axis) -> String {
    format!("{} to {} {}", axis.min, axis.max, unit(axis))
}

/// The configurations that reach a pose.
fn reaching(others: &[u8]) -> String {
    let names: Vec<String> = others.iter().map(u8::to_string).collect();
    match names.as_slice() {
        [] => String::new(),
        [one] => format!("cfg {one} reaches it; "),
        [first @ .., last] => format!("cfg {} and {last} reach it; ", first.join(", ")),
    }
}

/// A number with at most three decimals.
fn short(value: f64) -> String {
    let rounded = (value * 1e3).round() / 1e3;
    if rounded == 0.0 { format!("{value:.1e}") } else { format!("{rounded}") }
}
