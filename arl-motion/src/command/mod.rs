//! What is requested of the robot: motions with their settings, and the errors with which they may be rejected.

pub(crate) mod check;
mod compensation;
mod cycle;
pub(crate) mod error;
mod gate;
pub(crate) mod joints;
mod speed_override;
mod weave;

pub use compensation::{Compensation, Reference};
pub use cycle::{Cycle, CycleError};
pub use error::PlanError;
pub use gate::{Gate, GatePart, Lift};
pub use joints::{Joints, UNSET, is_unset};
pub use speed_override::{Override, OverrideError};
pub use weave::{Weave, WeaveShape};

use arl_robot::frames::Rig;
use arl_robot::kinematics::{Frame, Wanted};
use arl_robot::robot::{EXTERNAL_AXES, ROBOT_AXES, VelocityProfile};

/// The largest blending zone, as a share of a motion.
pub(crate) const LARGEST_ZONE: f64 = 0.5;

/// One motion instruction with everything that applies to it.
#[derive(Clone, PartialEq, Debug)]
pub struct Command {
    /// Where to move, and how.
    pub target: Target,
    /// The tool or the workpiece that the robot carries, and where the base of the robot is in the world.
    pub rig: Rig,
    /// The programmed speed.
    pub speed: Speed,
    /// The duration of the motion, in s; it replaces the programmed speed.
    pub duration: Option<f64>,
    /// The zone before the target in which the motion may be left for the next one.
    pub zone: Zone,
    /// A mark of the caller, such as the program line, which set-points and errors contain.
    pub line: u32,
}

impl Command {
    /// A motion to an exact stop at the robot's full speed, with a bare flange, in the robot's base.
    pub fn new(target: Target) -> Self {
        Self { target, rig: Rig::bare(), speed: Speed::FULL, duration: None, zone: Zone::NONE, line: 0 }
    }
}

/// The target of a motion. Components that are [`crate::command::UNSET`] keep their values at the start of the motion.
#[derive(Clone, PartialEq, Debug)]
pub enum Target {
    /// All axes to their positions, arriving together.
    Joints(Joints),
    /// The TCP to a pose, all axes arriving together.
    Pose {
        /// x, y, z in mm, a, b, c in deg, in the workpiece frame.
        pose: [f64; 6],
        /// The workpiece frame, relative to what the TCP's path is relative to ([`arl_robot::frames::Carried`]),
        /// translation in mm.
        wobj: Frame,
        /// The requested solution.
        wanted: Wanted,
        /// External axes in deg (mm).
        external: [f64; EXTERNAL_AXES],
    },
    /// The TCP along a straight line, with even rotation of the tool; the configuration at the start is kept.
    Line {
        /// x, y, z in mm, a, b, c in deg, in the workpiece frame.
        pose: [f64; 6],
        /// The workpiece frame, relative to what the TCP's path is relative to ([`arl_robot::frames::Carried`]),
        /// translation in mm.
        wobj: Frame,
        /// External axes in deg (mm).
        external: [f64; EXTERNAL_AXES],
    },
    /// The TCP along a circle through a via point, with even rotation of the tool; the configuration at the start is
    /// kept.
    Arc {
        /// x, y, z in mm of the via point, in the workpiece frame.
        via: [f64; 3],
        /// x, y, z in mm, a, b, c in deg, in the workpiece frame.
        pose: [f64; 6],
        /// The workpiece frame, relative to what the TCP's path is relative to ([`arl_robot::frames::Carried`]),
        /// translation in mm.
        wobj: Frame,
        /// Angle to move along the circle, in deg, instead of moving to `pose`; a negative angle reverses the
        /// direction.
        angle: Option<f64>,
        /// Whether the tool turns with the path, instead of turning to the orientation of `pose`.
        follow: bool,
        /// External axes in deg (mm).
        external: [f64; EXTERNAL_AXES],
    },
    /// The TCP up, across and down to a pose, for robots whose third axis lifts.
    Gate {
        /// x, y, z in mm, a, b, c in deg, in the workpiece frame.
        pose: [f64; 6],
        /// The workpiece frame in the robot's base, translation in mm.
        wobj: Frame,
        /// The requested solution.
        wanted: Wanted,
        /// External axes in deg (mm).
        external: [f64; EXTERNAL_AXES],
        /// Form of the gate.
        gate: Gate,
    },
    /// The TCP along the circle through the start, the target and the target of the next motion of this kind or, for
    /// the last one, through the start of the one before it. At least two such motions in a row are needed.
    Circle {
        /// x, y, z in mm, a, b, c in deg, in the workpiece frame.
        pose: [f64; 6],
        /// The workpiece frame in the robot's base, translation in mm.
        wobj: Frame,
        /// Whether the tool turns with the path, instead of turning to the orientation of `pose`.
        follow: bool,
        /// External axes in deg (mm).
        external: [f64; EXTERNAL_AXES],
    },
    /// The TCP, the tool's rotation and the external axes smoothly through the targets of all motions of this kind in
    /// a row, without a stop.
    Spline {
        /// x, y, z in mm, a, b, c in deg, in the workpiece frame.
        pose: [f64; 6],
        /// The workpiece frame in the robot's base, translation in mm.
        wobj: Frame,
        /// External axes in deg (mm).
        external: [f64; EXTERNAL_AXES],
    },
}

/// The kinds of targets, without data.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
#[non_exhaustive]
pub enum MotionKind {
    /// [`Target::Joints`]
    Joints,
    /// [`Target::Pose`]
    Pose,
    /// [`Target::Gate`]
    Gate,
    /// [`Target::Line`]
    Line,
    /// [`Target::Arc`]
    Arc,
    /// [`Target::Circle`]
    Circle,
    /// [`Target::Spline`]
    Spline,
}

impl MotionKind {
    /// Whether the motion leads the TCP along a path, at a speed in mm/s; else it moves the axes, at a share of their
    /// speeds.
    pub fn leads_tcp(self) -> bool {
        match self {
            Self::Line | Self::Arc | Self::Circle | Self::Spline => true,
            Self::Joints | Self::Pose | Self::Gate => false,
        }
    }
}

impl Target {
    /// The kind of this target.
    pub fn kind(&self) -> MotionKind {
        match self {
            Self::Joints(_) => MotionKind::Joints,
            Self::Pose { .. } => MotionKind::Pose,
            Self::Gate { .. } => MotionKind::Gate,
            Self::Line { .. } => MotionKind::Line,
            Self::Arc { .. } => MotionKind::Arc,
            Self::Circle { .. } => MotionKind::Circle,
            Self::Spline { .. } => MotionKind::Spline,
        }
    }

    /// All axes to these positions, in deg (mm); external axes do not move.
    pub fn axes(axes: [f64; ROBOT_AXES]) -> Self {
        Self::Joints(Joints { axes, external: [UNSET; EXTERNAL_AXES] })
    }

    /// The TCP along a straight line to a pose in the robot's base: x, y, z in mm, a, b, c in deg. External axes do not
    /// move.
    pub fn line(pose: [f64; 6]) -> Self {
        Self::Line { pose, wobj: Frame::identity(), external: [UNSET; EXTERNAL_AXES] }
    }
}

/// How far from the target of a motion the next one may take over (slip). Values that are not above 0, or are
/// [`crate::command::UNSET`], request nothing.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Zone {
    /// Percent of the largest zone, which is half of the motion; 0 or more overrides all others.
    pub percent: f64,
    /// Distance of the TCP along its path, in mm.
    pub tcp: f64,
    /// Angle by which the tool still has to turn, in deg.
    pub ori: f64,
    /// Axis motions: angle of the axis that has the farthest to move, in deg (mm).
    pub joint: f64,
    /// Rotary external axes, in deg.
    pub turning: f64,
    /// Linear external axes, in mm.
    pub linear: f64,
}

impl Zone {
    /// No zone: the target is reached exactly.
    pub const NONE: Zone = Zone { percent: -1.0, tcp: -1.0, ori: -1.0, joint: -1.0, turning: -1.0, linear: -1.0 };

    /// A zone in which the TCP is within `tcp` mm of the target.
    pub fn within(tcp: f64) -> Zone {
        Zone { tcp, ..Zone::NONE }
    }
}

/// The programmed speed. A motion uses the components that fit it; in addition, the robot's own limits hold.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Speed {
    /// Axis motions: percent of every axis's speed, above 0; more than 100 counts as 100.
    pub percent: f64,
    /// Lines: speed of the TCP in mm/s, above 0.
    pub tcp: f64,
    /// Lines: speed of the tool's rotation in deg/s, above 0.
    pub ori: f64,
    /// Rotary external axes: deg/s, above 0.
    pub exj: f64,
    /// Linear external axes: mm/s, above 0.
    pub exl: f64,
}

impl Speed {
    /// As fast as the robot's own limits allow.
    pub const FULL: Speed = Speed { percent: 100.0, tcp: 1e6, ori: 1e6, exj: 1e6, exl: 1e6 };
}

/// Settings that apply to all motions until they are changed.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Settings {
    /// The override: percent of all programmed speeds, above 0 to 100.
    pub speed_percent: f64,
    /// The highest speed of the TCP on lines, in mm/s; infinite for no limit.
    pub max_tcp: f64,
    /// Percent of all accelerations. Below 20 counts as 20, above 100 as 100.
    pub acc_percent: f64,
    /// Percent of all jerks. Below 20 counts as 20, above 100 as 100.
    pub jerk_percent: f64,
    /// How the speed rises and falls: with T, jerk is not limited.
    pub profile: VelocityProfile,
    /// Manual low-speed mode: the TCP moves at 250 mm/s at most, on every kind of motion; with a stationary tool, this
    /// applies to the flange, too.
    pub manual: bool,
    /// Whether lines and circles pass the wrist singularity by letting the orientation deviate.
    pub wrist: bool,
    /// The weave that is laid over paths of the TCP.
    pub weave: Option<Weave>,
    /// The compensation that shifts and turns paths of the TCP.
    pub compensation: Option<Compensation>,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            speed_percent: 100.0,
            max_tcp: f64::INFINITY,
            acc_percent: 100.0,
            jerk_percent: 100.0,
            profile: VelocityProfile::S,
            manual: false,
            wrist: false,
            weave: None,
            compensation: None,
        }
    }
}
