//! The messages of a program about its run, one JSON object per line: to a screen that drives it, or to a recorder.
//! `arl-rt` writes the lines by hand, as a cycle has no time for more; a test of the command checks that both have the
//! same keys, except for those of `Inside`.
//!
//! ```
//! let line: arl_wire::Line = serde_json::from_str(r#"{"warning":"the battery is low"}"#)?;
//! assert_eq!(line, arl_wire::Line::Warning("the battery is low".into()));
//! # Ok::<(), serde_json::Error>(())
//! ```

use std::collections::BTreeMap;
use std::fmt;

use arl_robot::cell::{Signal, SignalKind};
use arl_robot::kinematics::{self, Frame};
use nalgebra::{Quaternion, Translation3, Unit, UnitQuaternion, Vector3};
use serde::{Deserialize, Serialize};

/// A line of the program; the last three do not come from the program, but from the listener. `arl-rt` documents the
/// lines in its module `live`.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
#[serde(rename_all = "snake_case")]
pub enum Line {
    /// The first line: the programs and their robots.
    Hello(Hello),
    /// The current state, sent repeatedly.
    State(State),
    /// The positions of the robots, in each cycle, if requested.
    Cycle(Cycle),
    /// The functions and variables of a channel's program, while requested.
    Inside(Inside),
    /// A message that the program printed.
    Message(Message),
    /// A warning: not an alarm, but worth reporting.
    Warning(String),
    /// An alarm, which stopped a program.
    Alarm(Alarm),
    /// An order that could not be carried out, and why.
    Refused(Refused),
    /// The report of a motion or a channel.
    Report(Report),
    /// The last line, with how often something was left out.
    Ended(u64),
    /// A body that a robot can take appeared, was taken or put down: reported by the listener that monitors bodies.
    #[serde(skip)]
    Placing(Placing),
    /// Objects that came too near to each other: reported not by the program, but by the listener that monitors the
    /// robots' positions.
    #[serde(skip)]
    Contact(Contact),
    /// Output of the program on standard error.
    #[serde(skip)]
    Other(String),
}

/// The programs and their robots.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
#[serde(default)]
pub struct Hello {
    /// The channels, in their order.
    pub channels: Vec<Runs>,
    /// The names of signals, by their notation in files: `di.1`.
    pub names: BTreeMap<String, String>,
}

/// The program and the robot of one channel.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Runs {
    /// The main file of its program.
    pub program: String,
    /// Its robot; empty, or absent, in a background channel.
    pub robot: Option<String>,
    /// The robot's own axes, then the external ones.
    pub axes: Vec<Axis>,
    /// The joints of its own axes, from the base on.
    #[serde(default)]
    pub links: Vec<LinkJoint>,
    /// The flange in the frame of the last link.
    #[serde(default)]
    pub flange: Placed,
    /// Its shape.
    #[serde(default)]
    pub limbs: Vec<Limb>,
}

impl Runs {
    /// The index of an external axis among all axes, and its data.
    pub fn external(&self, number: usize) -> Option<(usize, &Axis)> {
        let at = self.links.len() + number;
        self.axes.get(at).map(|axis| (at, axis))
    }

    /// The flange in the world.
    pub fn flange_in_world(&self, channel: &Channel) -> Frame {
        let base = <[f64; 6]>::try_from(&channel.base[..]).map(kinematics::frame).unwrap_or_default();
        base * self.flange_at(&channel.axes)
    }

    /// The flange in the base, in mm, while the axes have these values in deg and mm.
    fn flange_at(&self, axes: &[f64]) -> Frame {
        let links = self.links.iter().zip(axes);
        links.fold(Frame::identity(), |before, (link, axis)| before * link.joint().at(*axis)) * placed(&self.flange)
    }
}

/// A capsule that belongs to a link, from 1, or to the base, 0: its ends in that frame, and its radius, in mm.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Limb {
    /// The name.
    pub name: String,
    /// The link, from 1; 0 is the base.
    pub link: usize,
    /// The ends of its axis, in mm, in the frame of the link.
    pub ends: [[f64; 3]; 2],
    /// The radius, in mm.
    pub radius: f64,
}

/// The name of a link among `of` links, 0 is the base: that of its capsule.
pub fn name_of_link(link: usize, of: usize, limbs: &[Limb]) -> &str {
    let found = if link + 1 >= of { limbs.last() } else { limbs.iter().rfind(|limb| limb.link <= link) };
    found.map_or("the robot", |limb| &limb.name)
}

/// The positions of the robots.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Cycle {
    /// Controller time in s.
    pub time: f64,
    /// The channels, in their order.
    pub channels: Vec<Moves>,
    /// Levels in a row, from channel 1.
    pub di: String,
    /// Levels in a row, from channel 1.
    #[serde(rename = "do")]
    pub dout: String,
}

impl Cycle {
    /// Whether an input or output has a level.
    pub fn has(&self, level: (Signal, bool)) -> bool {
        has([&self.di, &self.dout], level)
    }
}

impl State {
    /// Whether an input or output has a level.
    pub fn has(&self, level: (Signal, bool)) -> bool {
        has([&self.di, &self.dout], level)
    }
}

/// Whether an input or output of these rows has a level.
fn has([di, dout]: [&str; 2], (signal, wanted): (Signal, bool)) -> bool {
    let levels = if signal.kind == SignalKind::DigitalInput { di } else { dout };
    (levels.as_bytes().get(signal.channel as usize - 1) == Some(&b'1')) == wanted
}

/// The position of the robot of a channel.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Moves {
    /// The file of the current or last motion.
    pub file: String,
    /// The line of the current or last motion, from 1; 0 if nothing has moved yet.
    pub line: u32,
    /// The robot's base in the world: x, y, z in mm, a, b, c in deg; set once something has moved.
    pub base: Vec<f64>,
    /// deg, mm
    pub axes: Vec<f64>,
}

/// x, y, z in mm, and a quaternion x, y, z, w.
pub type Placed = [f64; 7];

/// A joint that moves a link relative to the previous one, or to the base.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct LinkJoint {
    /// The link's frame in the previous one while the axis is at 0.
    pub origin: Placed,
    /// The axis about which it turns, or along which it moves, in the link's frame.
    pub axis: [f64; 3],
    /// Whether the joint moves along its axis.
    pub linear: bool,
}

impl LinkJoint {
    /// The joint of the robot's kinematics.
    pub fn joint(&self) -> kinematics::LinkJoint {
        let axis = Unit::new_normalize(Vector3::from(self.axis));
        kinematics::LinkJoint { origin: placed(&self.origin), axis, linear: self.linear }
    }
}

/// The frame with this notation.
pub fn placed([x, y, z, i, j, k, w]: &Placed) -> Frame {
    let turned = UnitQuaternion::from_quaternion(Quaternion::new(*w, *i, *j, *k));
    Frame::from_parts(Translation3::new(*x, *y, *z), turned)
}

/// The notation of a frame.
pub fn written(frame: &Frame) -> Placed {
    let ([x, y, z], [i, j, k, w]): ([f64; 3], [f64; 4]) =
        (frame.translation.vector.into(), frame.rotation.coords.into());
    [x, y, z, i, j, k, w]
}

/// An axis and its range, in its unit.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Axis {
    /// `j1`.., of external axes `ej1`..
    pub name: String,
    /// `deg` or `mm`
    pub unit: String,
    /// The lowest position.
    pub min: f64,
    /// The highest position.
    pub max: f64,
}

impl Axis {
    /// Whether its positions are in mm, not in deg.
    pub fn is_linear(&self) -> bool {
        self.unit == "mm"
    }
}

/// The current state.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct State {
    /// Controller time in s.
    pub time: f64,
    /// `AUTO`, `MANUAL`, `MANUFAST`
    pub mode: String,
    /// The speed override, in %.
    #[serde(rename = "override")]
    pub speed_override: f64,
    /// The channels, in their order.
    pub channels: Vec<Channel>,
    /// Levels in a row, from channel 1.
    pub di: String,
    /// Levels in a row, from channel 1.
    #[serde(rename = "do")]
    pub dout: String,
    /// Values in V or mA, from channel 1.
    pub ai: Vec<f64>,
    /// Values in V or mA, from channel 1.
    pub ao: Vec<f64>,
}

/// The state of one channel.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Channel {
    /// `running`, `paused`, `ended`, `alarm` and so on.
    pub state: String,
    /// The file in which the program is.
    pub file: String,
    /// The line on which the program is.
    pub line: usize,
    /// The file of the current or last motion.
    pub motion_file: String,
    /// The line of the current or last motion; 0 if nothing has moved yet.
    pub motion_line: usize,
    /// The running number of the motion executed in the last cycle; 0 if none.
    #[serde(default)]
    pub motion: u64,
    /// deg, mm
    pub axes: Vec<f64>,
    /// x, y, z in mm, a, b, c in deg, in the world.
    pub tcp: Vec<f64>,
    /// The robot's base, given like the TCP.
    #[serde(default)]
    pub base: Vec<f64>,
    /// The workpiece, given like the TCP.
    #[serde(default)]
    pub workpiece: Vec<f64>,
}

/// The functions and variables of a channel.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
#[serde(default)]
pub struct Inside {
    /// From 1.
    pub channel: usize,
    /// The functions that run, the innermost first.
    pub frames: Vec<Function>,
    /// Variables of the innermost function.
    pub variables: Vec<Variable>,
    /// Clocks and connections of the innermost function.
    pub handles: Vec<Variable>,
    /// Files with global variables.
    pub files: Vec<Globals>,
}

impl Inside {
    /// The number of lines that show its variables: one for each, and one for each file.
    pub fn variable_lines(&self) -> usize {
        let of_files = self.files.iter().map(|file| 1 + file.variables.len() + file.handles.len());
        self.variables.len() + self.handles.len() + of_files.sum::<usize>()
    }
}

/// A function that runs, or the action of an event.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Function {
    /// Its name.
    pub name: String,
    /// The file in which it is.
    pub file: String,
    /// The line on which it is.
    pub line: usize,
}

/// A variable and its value as a literal.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Variable {
    /// Its name.
    pub name: String,
    /// Its value, a literal of ARL.
    pub value: String,
}

/// The global variables of a file.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
#[serde(default)]
pub struct Globals {
    /// The file.
    pub file: String,
    /// Its variables.
    pub variables: Vec<Variable>,
    /// Its clocks and connections.
    pub handles: Vec<Variable>,
}

/// A line of the report (docs/seeing-a-run.md): times in s, distances in mm.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
#[serde(untagged)]
pub enum Report {
    /// The report of a motion.
    Motion(Box<MotionReport>),
    /// The overall report of a channel.
    Channel(ChannelReport),
    /// The delays of cycles, in real time.
    Clock {
        /// The figures.
        clock: ClockReport,
    },
}

/// The report of a motion.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct MotionReport {
    /// From 1.
    pub channel: u32,
    /// Its running number.
    pub motion: u64,
    /// The file of the motion.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// The instruction: `lin`.
    pub kind: String,
    /// The unit of `programmed` and `reached`: `mm/s`, `deg/s` or `%`.
    pub unit: String,
    /// The programmed speed, in its unit.
    pub programmed: f64,
    /// The highest speed along the path, in its unit.
    pub reached: f64,
    /// The start time, in s.
    pub start: f64,
    /// The time of execution, in s.
    pub duration: f64,
    /// The distance travelled by the TCP, in mm.
    pub way: f64,
    /// The zone at its end, if one was programmed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend: Option<BlendReport>,
    /// Where it slowed down near a singular point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slowed: Option<SlowedReport>,
    /// The limits to which it came nearest.
    pub closest: ClosestReport,
}

/// A zone: the programmed and the used size, in its unit.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct BlendReport {
    /// `mm`, `deg` or `%`.
    pub unit: String,
    /// The programmed size.
    pub asked: f64,
    /// The used size.
    pub used: f64,
    /// The reason why the used size is smaller.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// Where an axis limits a motion to a low speed, near a singular point.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct SlowedReport {
    /// The axis.
    pub axis: String,
    /// How far along the motion that is, 0 to 1.
    pub along: f64,
    /// The speed to which the axis limits the motion.
    pub speed: f64,
    /// The unit of the speed.
    pub unit: String,
}

/// The limit of each kind to which a motion came nearest.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
#[serde(default)]
pub struct ClosestReport {
    /// Of speed.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub vel: Option<Closest>,
    /// Of acceleration.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub acc: Option<Closest>,
    /// Of jerk.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub jerk: Option<Closest>,
}

/// A limit, and how much of it was used.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Closest {
    /// The owner of the limit: `j1`, `tcp`.
    pub of: String,
    /// The used part of the limit, in %.
    pub percent: f64,
}

/// The overall report of a channel.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct ChannelReport {
    /// From 1.
    pub channel: u32,
    /// The time until its program had ended, in s.
    pub cycle_time: f64,
    /// The time during which its robot moved, in s.
    pub moving: f64,
    /// The time during which it was at rest, in s.
    pub standing: f64,
    /// The number of motions that began.
    pub motions: u64,
}

/// The delays of cycles.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct ClockReport {
    /// The number of cycles.
    pub cycles: u64,
    /// The number of cycles that began late.
    pub late: u64,
    /// The number of cycles that were lost.
    pub lost: u64,
    /// The number of missing messages of robots.
    pub missing: u64,
    /// The longest delay, in s.
    pub longest: f64,
    /// The delay in s, and the number of cycles that began within it.
    pub histogram: Vec<(f64, u64)>,
}

/// A message that the program printed.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Message {
    /// Controller time in s.
    pub time: f64,
    /// The name of the channel in a sentence: `channel 1`.
    #[serde(default)]
    pub channel: String,
    /// Whether it goes to the pendant.
    #[serde(default)]
    pub hmi: bool,
    /// Whether it goes to the console.
    #[serde(default)]
    pub console: bool,
    /// The printed text.
    pub text: String,
}

/// An alarm, which stopped a program.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Alarm {
    /// Its number.
    #[serde(default)]
    pub number: u32,
    /// The file of its line.
    #[serde(default)]
    pub file: String,
    /// The line, from 1; 0 if it does not concern a line.
    #[serde(default)]
    pub line: u32,
    /// The message, with its number and its place.
    pub text: String,
}

/// An order that could not be carried out, and why.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Refused {
    /// The order.
    pub order: String,
    /// The reason.
    pub why: String,
}

/// The new position of a body of the cell.
#[derive(Clone, PartialEq, Debug)]
pub struct Placing {
    /// The index of the body in the cell.
    pub body: usize,
    /// The position; `None` if the body is not there.
    pub place: Option<Place>,
}

/// The position of a body.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Place {
    /// The channel, from 0, of the robot that holds it; `None` if it is in the world.
    pub held_by: Option<usize>,
    /// Its frame in the flange or in the world, in mm.
    pub at: Frame,
}

/// Two bodies that touch for the first time, or come nearer to each other than requested.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Contact {
    /// Controller time in s.
    pub time: f64,
    /// The place of the motion that brought them together; empty if no motion of a program did.
    pub file: String,
    /// From 1; 0 if no motion of a program brought them together.
    pub line: u32,
    /// One of them.
    pub one: String,
    /// The other one.
    pub other: String,
    /// Their distance in mm; 0 if they touch.
    pub distance: f64,
}

impl fmt::Display for Contact {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { time, file, line, one, other, distance } = self;
        if *distance > 0.0 {
            write!(f, "{one} comes within {distance:.1} mm of {other}")?;
        } else {
            write!(f, "{one} touches {other}")?;
        }
        write!(f, " after {time:.3} s")?;
        if *line > 0 { write!(f, " ({file}:{line})") } else { Ok(()) }
    }
}

/// Runs the examples of the README.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
