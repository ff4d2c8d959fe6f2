//! Errors of planning.

use std::fmt;

use arl_robot::kinematics::CONFIGURATIONS;

/// The reason why a motion cannot be planned.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum PlanError {
    /// An axis would leave its range.
    AxisLimit {
        /// Name of the axis.
        axis: String,
        /// The farthest position it would take, in deg (mm).
        value: f64,
        /// The lower end of its range.
        min: f64,
        /// The upper end of its range.
        max: f64,
        /// Where on the path the axis leaves its range, 0 to 1; 1 is the target.
        along: f64,
    },
    /// The arm does not reach the pose.
    Unreachable {
        /// Distance beyond the reach, in mm; 0 where the configuration is the reason, not the distance.
        beyond: f64,
        /// Where on the path, 0 to 1; 1 is the target.
        along: f64,
    },
    /// The pose tilts the flange, which a SCARA robot cannot do.
    Tilted {
        /// Tilt, in deg.
        by: f64,
        /// Where on the path the tilt begins, 0 to 1; 1 is the target.
        along: f64,
    },
    /// The line passes a singular point, where axes would have to turn infinitely fast.
    Singular {
        /// The axis that would have to turn most.
        axis: String,
        /// Where on the path, 0 to 1.
        along: f64,
    },
    /// The line passes the wrist singularity, which `$WRIST` would let it pass.
    Wrist {
        /// The axis that would have to turn most.
        axis: String,
        /// Where on the path, 0 to 1.
        along: f64,
    },
    /// The weave or the compensation changes too much over too short a distance to be followed.
    TooDense {
        /// Where on the path, 0 to 1.
        along: f64,
    },
    /// The path turns back over too short a distance for the robot to follow it without a stop.
    TooSharp {
        /// Where on the path, 0 to 1.
        along: f64,
    },
    /// Start, via point and target do not define a circle: two of them are the same, or all are on a line.
    NoCircle,
    /// The angle of a circle is too large.
    Circles {
        /// The angle in deg.
        angle: f64,
        /// The largest possible angle, in deg.
        most: f64,
    },
    /// A gate begins or ends above its highest permitted position.
    AboveLimit {
        /// The height of the higher end, in mm.
        height: f64,
        /// The highest permitted position, in mm.
        highest: f64,
    },
    /// A circle through the targets of its neighbours has no neighbour of its kind.
    LoneCircle,
    /// An earlier motion turned out to be impossible once the one behind it was known, or none followed.
    Earlier {
        /// Program line of the earlier motion.
        line: u32,
        /// The reason.
        error: Box<PlanError>,
    },
    /// The robot has no such configuration.
    NoSuchCfg {
        /// The requested configuration.
        cfg: u8,
    },
    /// The robot cannot move so fast.
    Duration {
        /// The requested duration, in s.
        wanted: f64,
        /// The shortest duration that its limits allow, in s.
        least: f64,
    },
    /// The override of programmed speeds is not above zero, or not a number.
    NoOverride {
        /// The override in percent.
        percent: f64,
    },
    /// The highest speed of the TCP is not above zero, or not a number.
    NoHighestSpeed {
        /// The speed in mm/s.
        value: f64,
    },
    /// A speed or a duration is not above zero, or not a number; or a duration is far too long.
    NoSpeed {
        /// The quantity, with its unit.
        what: &'static str,
        /// Its value.
        value: f64,
    },
    /// A component of the target, of a frame, or of the robot's position is not a number.
    NotANumber,
    /// A value of the command or of the settings is not a number, or is outside its range.
    OutOfRange {
        /// The quantity, with its unit.
        what: &'static str,
        /// Its value.
        value: f64,
        /// The permitted values, in words.
        expected: &'static str,
    },
    /// The tool points along the path, so that there is no direction to its side.
    ToolAlongPath,
    /// The robot holds the workpiece, so that the world turns relative to it.
    WorldTurns,
    /// The motion ahead takes more cycles than are examined.
    TooLong {
        /// The limit of cycles.
        most: usize,
    },
    /// This robot does not support this kind of motion.
    NotForThisRobot,
    /// The robot is in another configuration, or another turn of an axis, than where it was stopped.
    NoReturnMotion,
    /// The look-ahead is full: check [`crate::queue::Queue::has_room`] first.
    Full,
    /// The robot is stopping to drop its motions; the start of the next one is not known yet.
    Stopping,
}

#[expect(clippy::too_many_lines, reason = "a table of messages")]
impl fmt::Display for PlanError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            PlanError::AxisLimit { axis, value, min, max, along } => {
                write!(f, "{axis} would have to go to {value:.3}, but its range is {min} to {max}; ")?;
                place(f, *along)
            }
            PlanError::Unreachable { beyond, along } if *beyond > 0.0 => {
                write!(f, "the pose is {beyond:.3} mm out of reach; ")?;
                place(f, *along)
            }
            PlanError::Unreachable { along, .. } => {
                write!(f, "the pose cannot be reached in this configuration; ")?;
                place(f, *along)
            }
            PlanError::Tilted { by, along } => {
                write!(f, "the pose tilts the flange by {by:.3} deg, which a SCARA robot cannot do; ")?;
                place(f, *along)
            }
            PlanError::Singular { axis, along } => {
                write!(f, "the line passes a singular point, where {axis} would have to turn infinitely fast; ")?;
                place(f, *along)
            }
            PlanError::Wrist { axis, along } => {
                write!(f, "the line passes the wrist singularity, where {axis} would have to turn infinitely fast; ")?;
                place(f, *along)?;
                write!(f, "; with $WRIST it passes, and the orientation deviates a little there")
            }
            PlanError::TooDense { along } => {
                write!(f, "the weave or the compensation changes too much over so short a distance; ")?;
                place(f, *along)?;
                write!(f, ": take a lower frequency, less amplitude or shift, or a longer motion")
            }
            PlanError::TooSharp { along } => {
                write!(f, "the path turns too sharply to be followed without a stop; ")?;
                place(f, *along)?;
                write!(f, ": stop there, or give it more room to turn")
            }
            PlanError::NoCircle => write!(
                f,
                "the three points of the arc make no circle: they must be different and must not lie on a line"
            ),
            PlanError::Circles { angle, most } => {
                write!(f, "the circle's angle is {angle} deg: a single motion covers at most {most} deg")
            }
            PlanError::NoSuchCfg { cfg } => write!(f, "the robot has no configuration cfg {cfg}: {CONFIGURATIONS}"),
            PlanError::AboveLimit { height, highest } => {
                write!(f, "the gate starts or ends at the height {height:.3}, above its limit of {highest:.3}")
            }
            PlanError::LoneCircle => {
                write!(f, "a circle through the targets of neighbouring motions needs two motions of its kind in a row")
            }
            PlanError::Earlier { line, error } => write!(f, "line {line}: {error}"),
            PlanError::Duration { wanted, least } => {
                write!(f, "the motion cannot be done in {wanted} s: it takes at least {least:.3} s")
            }
            PlanError::NoOverride { percent } => {
                write!(f, "the override of speeds is {percent} %: it must be a number above 0")
            }
            PlanError::NoHighestSpeed { value } => {
                write!(f, "the highest speed of the TCP is {value} mm/s: it must be a number above 0")
            }
            PlanError::NoSpeed { what, value } if value.is_finite() && *value > 0.0 => {
                write!(f, "{what} is {value:e}, which is too much")
            }
            PlanError::NoSpeed { what, value } => write!(f, "{what} is {value}: it must be a number above 0"),
            PlanError::OutOfRange { what, value, expected } => write!(f, "{what} is {value}: expected {expected}"),
            PlanError::NotANumber => write!(f, "the target holds a value that is not a number"),
            PlanError::ToolAlongPath => write!(
                f,
                "the tool's z axis points along the path, so weave and compensation have no direction to the side: tilt the tool"
            ),
            PlanError::WorldTurns => write!(
                f,
                "a compensation along the axes of the world has no direction on a workpiece that the robot holds: use WOBJ"
            ),
            PlanError::TooLong { most } => {
                write!(f, "the motion ahead takes more than {most} cycles: use a higher override or longer cycles")
            }
            PlanError::NotForThisRobot => write!(f, "this robot does not support this motion"),
            PlanError::NoReturnMotion => write!(
                f,
                "the robot cannot go straight back to its path: it is in another configuration, or in another turn of an axis, than when it was stopped; move its axes near that position first"
            ),
            PlanError::Full => write!(f, "the look-ahead is full"),
            PlanError::Stopping => write!(f, "the robot is still stopping"),
        }
    }
}

impl std::error::Error for PlanError {}

fn place(f: &mut fmt::Formatter<'_>, along: f64) -> fmt::Result {
    if along >= 1.0 { write!(f, "at the target") } else { write!(f, "{:.1} % along the path", along * 100.0) }
}
