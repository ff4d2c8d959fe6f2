//! The messages of a recording, in protocol buffers: those of Foxglove's schemas that viewers know (m, rad), and our own (mm, deg, as ARL has
//! them). `schemas.rs` describes the same fields to readers; a test holds both together.

use prost::Message;

/// `google.protobuf.Timestamp`
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Timestamp {
    #[prost(int64, tag = "1")]
    pub(super) seconds: i64,
    #[prost(int32, tag = "2")]
    pub(super) nanos: i32,
}

/// `foxglove.Vector3`
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Vector3 {
    #[prost(double, tag = "1")]
    pub(super) x: f64,
    #[prost(double, tag = "2")]
    pub(super) y: f64,
    #[prost(double, tag = "3")]
    pub(super) z: f64,
}

/// `foxglove.Quaternion`
#[derive(Clone, Copy, PartialEq, Message)]
pub(super) struct Quaternion {
    #[prost(double, tag = "1")]
    pub(super) x: f64,
    #[prost(double, tag = "2")]
    pub(super) y: f64,
    #[prost(double, tag = "3")]
    pub(super) z: f64,
    #[prost(double, tag = "4")]
    pub(super) w: f64,
}

/// `foxglove.FrameTransform`
#[derive(Clone, PartialEq, Message)]
pub(super) struct FrameTransform {
    #[prost(message, optional, tag = "1")]
    pub(super) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(super) parent_frame_id: String,
    #[prost(string, tag = "3")]
    pub(super) child_frame_id: String,
    #[prost(message, optional, tag = "4")]
    pub(super) translation: Option<Vector3>,
    #[prost(message, optional, tag = "5")]
    pub(super) rotation: Option<Quaternion>,
}

/// `foxglove.FrameTransforms`
#[derive(Clone, PartialEq, Message)]
pub(super) struct FrameTransforms {
    #[prost(message, repeated, tag = "1")]
    pub(super) transforms: Vec<FrameTransform>,
}

/// `foxglove.JointState`
#[derive(Clone, PartialEq, Message)]
pub(super) struct JointState {
    #[prost(string, tag = "1")]
    pub(super) name: String,
    #[prost(double, optional, tag = "2")]
    pub(super) position: Option<f64>,
}

/// `foxglove.JointStates`
#[derive(Clone, PartialEq, Message)]
pub(super) struct JointStates {
    #[prost(message, optional, tag = "1")]
    pub(super) timestamp: Option<Timestamp>,
    #[prost(message, repeated, tag = "2")]
    pub(super) joints: Vec<JointState>,
}

/// `foxglove.Log`
#[derive(Clone, PartialEq, Message)]
pub(super) struct Log {
    #[prost(message, optional, tag = "1")]
    pub(super) timestamp: Option<Timestamp>,
    #[prost(enumeration = "Level", tag = "2")]
    pub(super) level: i32,
    #[prost(string, tag = "3")]
    pub(super) message: String,
    #[prost(string, tag = "4")]
    pub(super) name: String,
    #[prost(string, tag = "5")]
    pub(super) file: String,
    #[prost(fixed32, tag = "6")]
    pub(super) line: u32,
}

/// `foxglove.Log.Level`
#[derive(Clone, Copy, PartialEq, Eq, Debug, prost::Enumeration)]
#[repr(i32)]
pub(super) enum Level {
    Unknown = 0,
    Debug = 1,
    Info = 2,
    Warning = 3,
    Error = 4,
    Fatal = 5,
}

/// `arl2rs.v1.Cell`: what runs on which robots, and the names of signals; the first message.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Cell {
    #[prost(message, repeated, tag = "1")]
    pub(super) channels: Vec<Runs>,
    #[prost(message, repeated, tag = "2")]
    pub(super) names: Vec<Name>,
}

/// `arl2rs.v1.Runs`: what a channel runs, and the axes of its robot; a background channel has none.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Runs {
    #[prost(string, tag = "1")]
    pub(super) program: String,
    #[prost(string, tag = "2")]
    pub(super) robot: String,
    #[prost(message, repeated, tag = "3")]
    pub(super) axes: Vec<Axis>,
}

/// `arl2rs.v1.Axis`: its range, and its unit: `deg` or `mm`.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Axis {
    #[prost(string, tag = "1")]
    pub(super) name: String,
    #[prost(string, tag = "2")]
    pub(super) unit: String,
    #[prost(double, tag = "3")]
    pub(super) min: f64,
    #[prost(double, tag = "4")]
    pub(super) max: f64,
}

/// `arl2rs.v1.Name`: what the cell file calls a signal, `di.1`.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Name {
    #[prost(string, tag = "1")]
    pub(super) signal: String,
    #[prost(string, tag = "2")]
    pub(super) name: String,
}

/// `arl2rs.v1.Channel`: how a channel stands.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Channel {
    /// Controller time in s.
    #[prost(double, tag = "1")]
    pub(super) time: f64,
    /// `running`, `paused`, `ended`, `alarm`, `stopped`, `standstill`.
    #[prost(string, tag = "2")]
    pub(super) state: String,
    /// The statement that runs: the program pointer.
    #[prost(string, tag = "3")]
    pub(super) file: String,
    #[prost(uint32, tag = "4")]
    pub(super) line: u32,
    /// The motion that is executed, or was last: the motion pointer. Line 0: none yet.
    #[prost(string, tag = "5")]
    pub(super) motion_file: String,
    #[prost(uint32, tag = "6")]
    pub(super) motion_line: u32,
    /// Its running number in the cycle before; 0: the robot stood.
    #[prost(uint64, tag = "7")]
    pub(super) motion: u64,
    /// Commanded, in deg (mm), in the order of [`Runs::axes`].
    #[prost(double, repeated, tag = "8")]
    pub(super) axes: Vec<f64>,
    /// The TCP in the world: x, y, z in mm, a, b, c in deg.
    #[prost(double, repeated, tag = "9")]
    pub(super) tcp: Vec<f64>,
}

/// `arl2rs.v1.Controller`: the operating mode and the override; whenever one of them changes.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Controller {
    #[prost(double, tag = "1")]
    pub(super) time: f64,
    #[prost(string, tag = "2")]
    pub(super) mode: String,
    /// %
    #[prost(double, tag = "3")]
    pub(super) speed_override: f64,
}

/// `arl2rs.v1.Io`: all inputs and outputs, from channel 1 on; whenever one of them changes.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Io {
    #[prost(double, tag = "1")]
    pub(super) time: f64,
    #[prost(bool, repeated, tag = "2")]
    pub(super) di: Vec<bool>,
    #[prost(bool, repeated, tag = "3")]
    pub(super) r#do: Vec<bool>,
    #[prost(double, repeated, tag = "4")]
    pub(super) ai: Vec<f64>,
    #[prost(double, repeated, tag = "5")]
    pub(super) ao: Vec<f64>,
}

/// `arl2rs.v1.Motion`: what a motion did, at the time at which it began.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Motion {
    /// From 1.
    #[prost(uint32, tag = "1")]
    pub(super) channel: u32,
    /// Its running number.
    #[prost(uint64, tag = "2")]
    pub(super) motion: u64,
    #[prost(uint32, tag = "3")]
    pub(super) line: u32,
    /// `lin`
    #[prost(string, tag = "4")]
    pub(super) kind: String,
    /// When it began and how long it was executed, in s.
    #[prost(double, tag = "5")]
    pub(super) start: f64,
    #[prost(double, tag = "6")]
    pub(super) duration: f64,
    /// The way of the TCP in mm.
    #[prost(double, tag = "7")]
    pub(super) way: f64,
    /// The programmed and the highest speed, and their unit.
    #[prost(double, tag = "8")]
    pub(super) programmed: f64,
    #[prost(double, tag = "9")]
    pub(super) reached: f64,
    #[prost(string, tag = "10")]
    pub(super) unit: String,
    /// The zone at its end, where one was asked for.
    #[prost(message, optional, tag = "11")]
    pub(super) blend: Option<Blend>,
    /// The limits of speed, acceleration and jerk that it came nearest to.
    #[prost(message, optional, tag = "12")]
    pub(super) closest_vel: Option<Closest>,
    #[prost(message, optional, tag = "13")]
    pub(super) closest_acc: Option<Closest>,
    #[prost(message, optional, tag = "14")]
    pub(super) closest_jerk: Option<Closest>,
}

/// `arl2rs.v1.Blend`: how much of a zone was asked for and used, in its unit, and why the robot stopped, where it did.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Blend {
    #[prost(double, tag = "1")]
    pub(super) asked: f64,
    #[prost(double, tag = "2")]
    pub(super) used: f64,
    #[prost(string, tag = "3")]
    pub(super) unit: String,
    #[prost(string, tag = "4")]
    pub(super) why: String,
}

/// `arl2rs.v1.Closest`: whose limit it is, and how much of it was used, in %.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Closest {
    #[prost(string, tag = "1")]
    pub(super) of: String,
    #[prost(double, tag = "2")]
    pub(super) percent: f64,
}

/// `arl2rs.v1.Contact`: the first time that two bodies touch, or the nearest that they come to each other where that is
/// nearer than asked for.
#[derive(Clone, PartialEq, Message)]
pub(super) struct Contact {
    #[prost(double, tag = "1")]
    pub(super) time: f64,
    /// Where the motion stands that brought them together.
    #[prost(string, tag = "2")]
    pub(super) file: String,
    #[prost(uint32, tag = "3")]
    pub(super) line: u32,
    #[prost(string, tag = "4")]
    pub(super) one: String,
    #[prost(string, tag = "5")]
    pub(super) other: String,
    /// mm; 0: they touch.
    #[prost(double, tag = "6")]
    pub(super) distance: f64,
}
