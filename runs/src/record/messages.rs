//! The messages of a recording, in protocol buffers: those of Foxglove's schemas that viewers know (m, rad), and our
//! own (mm, deg, as ARL has them). `schemas.rs` describes the same fields to readers; a test holds both together.

use prost::Message;

/// `google.protobuf.Timestamp`
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Timestamp {
    #[prost(int64, tag = "1")]
    pub(crate) seconds: i64,
    #[prost(int32, tag = "2")]
    pub(crate) nanos: i32,
}

/// `foxglove.Vector3`
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Vector3 {
    #[prost(double, tag = "1")]
    pub(crate) x: f64,
    #[prost(double, tag = "2")]
    pub(crate) y: f64,
    #[prost(double, tag = "3")]
    pub(crate) z: f64,
}

/// `foxglove.Quaternion`
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Quaternion {
    #[prost(double, tag = "1")]
    pub(crate) x: f64,
    #[prost(double, tag = "2")]
    pub(crate) y: f64,
    #[prost(double, tag = "3")]
    pub(crate) z: f64,
    #[prost(double, tag = "4")]
    pub(crate) w: f64,
}

/// `foxglove.FrameTransform`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct FrameTransform {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(crate) parent_frame_id: String,
    #[prost(string, tag = "3")]
    pub(crate) child_frame_id: String,
    #[prost(message, optional, tag = "4")]
    pub(crate) translation: Option<Vector3>,
    #[prost(message, optional, tag = "5")]
    pub(crate) rotation: Option<Quaternion>,
}

/// `foxglove.FrameTransforms`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct FrameTransforms {
    #[prost(message, repeated, tag = "1")]
    pub(crate) transforms: Vec<FrameTransform>,
}

/// `foxglove.JointState`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct JointState {
    #[prost(string, tag = "1")]
    pub(crate) name: String,
    #[prost(double, optional, tag = "2")]
    pub(crate) position: Option<f64>,
}

/// `foxglove.JointStates`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct JointStates {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(message, repeated, tag = "2")]
    pub(crate) joints: Vec<JointState>,
}

/// `foxglove.Log`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Log {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(enumeration = "Level", tag = "2")]
    pub(crate) level: i32,
    #[prost(string, tag = "3")]
    pub(crate) message: String,
    #[prost(string, tag = "4")]
    pub(crate) name: String,
    #[prost(string, tag = "5")]
    pub(crate) file: String,
    #[prost(fixed32, tag = "6")]
    pub(crate) line: u32,
}

/// `foxglove.Log.Level`
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug, prost::Enumeration)]
#[repr(i32)]
pub(crate) enum Level {
    Unknown = 0,
    Debug = 1,
    Info = 2,
    Warning = 3,
    Error = 4,
    Fatal = 5,
}

/// `arl2rs.v1.Cell`: what runs on which robots, and the names of signals; the first message.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Cell {
    #[prost(message, repeated, tag = "1")]
    pub(crate) channels: Vec<Runs>,
    #[prost(message, repeated, tag = "2")]
    pub(crate) names: Vec<Name>,
}

/// `arl2rs.v1.Runs`: what a channel runs, and the axes of its robot; a background channel has none.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Runs {
    #[prost(string, tag = "1")]
    pub(crate) program: String,
    #[prost(string, tag = "2")]
    pub(crate) robot: String,
    #[prost(message, repeated, tag = "3")]
    pub(crate) axes: Vec<Axis>,
    /// From the base on, with the flange last.
    #[prost(message, repeated, tag = "4")]
    pub(crate) links: Vec<Link>,
    /// The frame of its TCP.
    #[prost(string, tag = "5")]
    pub(crate) tcp: String,
    /// What its external axes move.
    #[prost(message, repeated, tag = "6")]
    pub(crate) carriers: Vec<Link>,
}

/// `arl2rs.v1.Link`: a frame of a robot, relative to the frame that it is fixed to or moves against.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Link {
    #[prost(string, tag = "1")]
    pub(crate) frame: String,
    #[prost(string, tag = "2")]
    pub(crate) parent: String,
    /// Where it is in its parent while its axis is at 0: x, y, z in mm, and a quaternion x, y, z, w.
    #[prost(double, repeated, tag = "3")]
    pub(crate) origin: Vec<f64>,
    /// The axis that it turns about, or moves along, in its own frame; empty: it does not move.
    #[prost(double, repeated, tag = "4")]
    pub(crate) axis: Vec<f64>,
    #[prost(bool, tag = "5")]
    pub(crate) linear: bool,
    /// The name of the axis that moves it; empty: none.
    #[prost(string, tag = "6")]
    pub(crate) moved_by: String,
}

/// `arl2rs.v1.Axis`: its range, and its unit: `deg` or `mm`.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Axis {
    #[prost(string, tag = "1")]
    pub(crate) name: String,
    #[prost(string, tag = "2")]
    pub(crate) unit: String,
    #[prost(double, tag = "3")]
    pub(crate) min: f64,
    #[prost(double, tag = "4")]
    pub(crate) max: f64,
}

/// `arl2rs.v1.Name`: the cell file's name of a signal, `di.1`.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Name {
    #[prost(string, tag = "1")]
    pub(crate) signal: String,
    #[prost(string, tag = "2")]
    pub(crate) name: String,
}

/// `arl2rs.v1.Channel`: the state of a channel.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Channel {
    /// Controller time in s.
    #[prost(double, tag = "1")]
    pub(crate) time: f64,
    /// `running`, `paused`, `ended`, `alarm`, `stopped`, `standstill`.
    #[prost(string, tag = "2")]
    pub(crate) state: String,
    /// The statement that runs: the program pointer.
    #[prost(string, tag = "3")]
    pub(crate) file: String,
    #[prost(uint32, tag = "4")]
    pub(crate) line: u32,
    /// The motion that is executed, or was last: the motion pointer. Line 0: none yet.
    #[prost(string, tag = "5")]
    pub(crate) motion_file: String,
    #[prost(uint32, tag = "6")]
    pub(crate) motion_line: u32,
    /// Its running number in the cycle before; 0: the robot was at rest.
    #[prost(uint64, tag = "7")]
    pub(crate) motion: u64,
    /// Commanded, in deg (mm), in the order of [`Runs::axes`].
    #[prost(double, repeated, tag = "8")]
    pub(crate) axes: Vec<f64>,
    /// The TCP in the world: x, y, z in mm, a, b, c in deg.
    #[prost(double, repeated, tag = "9")]
    pub(crate) tcp: Vec<f64>,
    /// The base of the robot in the world, in the same form; empty: not known before the first motion.
    #[prost(double, repeated, tag = "10")]
    pub(crate) base: Vec<f64>,
}

/// `arl2rs.v1.Controller`: the operating mode and the override; whenever one of them changes.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Controller {
    #[prost(double, tag = "1")]
    pub(crate) time: f64,
    #[prost(string, tag = "2")]
    pub(crate) mode: String,
    /// %
    #[prost(double, tag = "3")]
    pub(crate) speed_override: f64,
}

/// `arl2rs.v1.Io`: all inputs and outputs, from channel 1 on; whenever one of them changes.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Io {
    #[prost(double, tag = "1")]
    pub(crate) time: f64,
    #[prost(bool, repeated, tag = "2")]
    pub(crate) di: Vec<bool>,
    #[prost(bool, repeated, tag = "3")]
    pub(crate) r#do: Vec<bool>,
    #[prost(double, repeated, tag = "4")]
    pub(crate) ai: Vec<f64>,
    #[prost(double, repeated, tag = "5")]
    pub(crate) ao: Vec<f64>,
}

/// `arl2rs.v1.Motion`: what a motion did, at the time at which it began.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Motion {
    /// From 1.
    #[prost(uint32, tag = "1")]
    pub(crate) channel: u32,
    /// Its running number.
    #[prost(uint64, tag = "2")]
    pub(crate) motion: u64,
    #[prost(uint32, tag = "3")]
    pub(crate) line: u32,
    /// `lin`
    #[prost(string, tag = "4")]
    pub(crate) kind: String,
    /// When it began and how long it was executed, in s.
    #[prost(double, tag = "5")]
    pub(crate) start: f64,
    #[prost(double, tag = "6")]
    pub(crate) duration: f64,
    /// The length of the TCP's path in mm.
    #[prost(double, tag = "7")]
    pub(crate) way: f64,
    /// The programmed and the highest speed, and their unit.
    #[prost(double, tag = "8")]
    pub(crate) programmed: f64,
    #[prost(double, tag = "9")]
    pub(crate) reached: f64,
    #[prost(string, tag = "10")]
    pub(crate) unit: String,
    /// The zone at its end, if one was requested.
    #[prost(message, optional, tag = "11")]
    pub(crate) blend: Option<Blend>,
    /// The limits of speed, acceleration and jerk that it came nearest to.
    #[prost(message, optional, tag = "12")]
    pub(crate) closest_vel: Option<Closest>,
    #[prost(message, optional, tag = "13")]
    pub(crate) closest_acc: Option<Closest>,
    #[prost(message, optional, tag = "14")]
    pub(crate) closest_jerk: Option<Closest>,
    /// The file that `line` is in; empty in recordings made before this field existed.
    #[prost(string, tag = "15")]
    pub(crate) file: String,
}

/// `arl2rs.v1.Blend`: how much of a zone was requested and used, in its unit, and the reason for stopping, if the robot
/// stopped.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Blend {
    #[prost(double, tag = "1")]
    pub(crate) asked: f64,
    #[prost(double, tag = "2")]
    pub(crate) used: f64,
    #[prost(string, tag = "3")]
    pub(crate) unit: String,
    #[prost(string, tag = "4")]
    pub(crate) why: String,
}

/// `arl2rs.v1.Closest`: whose limit it is, and how much of it was used, in %.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Closest {
    #[prost(string, tag = "1")]
    pub(crate) of: String,
    #[prost(double, tag = "2")]
    pub(crate) percent: f64,
}

/// `arl2rs.v1.Contact`: two bodies begin to touch, or their closest approach where that is below the requested
/// clearance.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Contact {
    #[prost(double, tag = "1")]
    pub(crate) time: f64,
    /// The place of the motion that brought them together.
    #[prost(string, tag = "2")]
    pub(crate) file: String,
    #[prost(uint32, tag = "3")]
    pub(crate) line: u32,
    #[prost(string, tag = "4")]
    pub(crate) one: String,
    #[prost(string, tag = "5")]
    pub(crate) other: String,
    /// mm; 0: they touch.
    #[prost(double, tag = "6")]
    pub(crate) distance: f64,
}

/// `foxglove.Pose`
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Pose {
    #[prost(message, optional, tag = "1")]
    pub(crate) position: Option<Vector3>,
    #[prost(message, optional, tag = "2")]
    pub(crate) orientation: Option<Quaternion>,
}

/// `foxglove.Color`: parts of 1.
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Color {
    #[prost(double, tag = "1")]
    pub(crate) r: f64,
    #[prost(double, tag = "2")]
    pub(crate) g: f64,
    #[prost(double, tag = "3")]
    pub(crate) b: f64,
    #[prost(double, tag = "4")]
    pub(crate) a: f64,
}

/// `foxglove.CubePrimitive`, and `foxglove.SpherePrimitive` with the same fields.
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Solid {
    /// Where its middle is in the frame of its entity.
    #[prost(message, optional, tag = "1")]
    pub(crate) pose: Option<Pose>,
    /// Its lengths along x, y and z in m.
    #[prost(message, optional, tag = "2")]
    pub(crate) size: Option<Vector3>,
    #[prost(message, optional, tag = "3")]
    pub(crate) color: Option<Color>,
}

/// `foxglove.CylinderPrimitive`, along z.
#[derive(Clone, Copy, PartialEq, Message)]
pub(crate) struct Cylinder {
    #[prost(message, optional, tag = "1")]
    pub(crate) pose: Option<Pose>,
    #[prost(message, optional, tag = "2")]
    pub(crate) size: Option<Vector3>,
    #[prost(double, tag = "3")]
    pub(crate) bottom_scale: f64,
    #[prost(double, tag = "4")]
    pub(crate) top_scale: f64,
    #[prost(message, optional, tag = "5")]
    pub(crate) color: Option<Color>,
}

/// `foxglove.ModelPrimitive`: a file.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct Model {
    #[prost(message, optional, tag = "1")]
    pub(crate) pose: Option<Pose>,
    /// The factor that turns the lengths in the file into m.
    #[prost(message, optional, tag = "2")]
    pub(crate) scale: Option<Vector3>,
    #[prost(message, optional, tag = "3")]
    pub(crate) color: Option<Color>,
    #[prost(bool, tag = "4")]
    pub(crate) override_color: bool,
    /// `model/stl`
    #[prost(string, tag = "6")]
    pub(crate) media_type: String,
    #[prost(bytes = "vec", tag = "7")]
    pub(crate) data: Vec<u8>,
}

/// `foxglove.SceneEntity`: a body, or a limb of a robot.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct SceneEntity {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "2")]
    pub(crate) frame_id: String,
    #[prost(string, tag = "3")]
    pub(crate) id: String,
    /// Whether it moves with its frame.
    #[prost(bool, tag = "5")]
    pub(crate) frame_locked: bool,
    #[prost(message, repeated, tag = "8")]
    pub(crate) cubes: Vec<Solid>,
    #[prost(message, repeated, tag = "9")]
    pub(crate) spheres: Vec<Solid>,
    #[prost(message, repeated, tag = "10")]
    pub(crate) cylinders: Vec<Cylinder>,
    #[prost(message, repeated, tag = "14")]
    pub(crate) models: Vec<Model>,
}

/// `foxglove.SceneEntityDeletion` of the entity with this name.
#[derive(Clone, PartialEq, Message)]
pub(crate) struct SceneEntityDeletion {
    #[prost(message, optional, tag = "1")]
    pub(crate) timestamp: Option<Timestamp>,
    #[prost(string, tag = "3")]
    pub(crate) id: String,
}

/// `foxglove.SceneUpdate`
#[derive(Clone, PartialEq, Message)]
pub(crate) struct SceneUpdate {
    #[prost(message, repeated, tag = "1")]
    pub(crate) deletions: Vec<SceneEntityDeletion>,
    #[prost(message, repeated, tag = "2")]
    pub(crate) entities: Vec<SceneEntity>,
}
