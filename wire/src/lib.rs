//! What a program says of its run, an object of JSON a line: to a screen that drives it, or to a recorder. `arl-rt`
//! writes the lines by hand, as a cycle has no time for more; a test of the command holds that both have the same keys,
//! but for what is inside a program.
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

/// A line of the program; the last three are not the program's, but of who listens to it. `arl-rt` documents them in
/// its module `live`.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
#[serde(rename_all = "snake_case")]
pub enum Line {
    /// The first line: what runs on which robots.
    Hello(Hello),
    /// How everything stands, again and again.
    State(State),
    /// Where the robots are, in each cycle, where that is asked for.
    Cycle(Cycle),
    /// What is inside the program of a channel, while that is asked for.
    Inside(Inside),
    /// What the program printed.
    Message(Message),
    /// What is not an alarm but worth a word.
    Warning(String),
    /// What stopped a program.
    Alarm(Alarm),
    /// An order that could not be carried out, and why.
    Refused(Refused),
    /// What a motion did, or a channel: an object of the report.
    Report(Report),
    /// Nothing more comes; so often something was left out.
    Ended(u64),
    /// A body that a robot takes along came, was taken or put down: said by who watches them.
    #[serde(skip)]
    Placing(Placing),
    /// What came too near to each other: not the program says it, but who watches where robots are.
    #[serde(skip)]
    Contact(Contact),
    /// What came on the standard error.
    #[serde(skip)]
    Other(String),
}

/// What runs on which robots.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
#[serde(default)]
pub struct Hello {
    /// The channels, in their order.
    pub channels: Vec<Runs>,
    /// What signals are called, by how files write them: `di.1`.
    pub names: BTreeMap<String, String>,
}

/// What one channel runs.
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
    /// The flange in the last link.
    #[serde(default)]
    pub flange: Placed,
    /// Its shape.
    #[serde(default)]
    pub limbs: Vec<Limb>,
}

impl Runs {
    /// Which of its axes an external one is, and what is known of it.
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

/// A capsule that belongs to a link, from 1, or to the base, 0: its ends in the frame of that, and its radius, in mm.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Limb {
    /// What people call it.
    pub name: String,
    /// The link, from 1; 0: the base.
    pub link: usize,
    /// The ends of its axis, in mm, in the frame of the link.
    pub ends: [[f64; 3]; 2],
    /// mm
    pub radius: f64,
}

/// What people call a link of so many, 0 is the base: as the capsule in its place.
pub fn name_of_link(link: usize, of: usize, limbs: &[Limb]) -> &str {
    let found = if link + 1 >= of { limbs.last() } else { limbs.iter().rfind(|limb| limb.link <= link) };
    found.map_or("the robot", |limb| &limb.name)
}

/// Where the robots are.
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

/// Whether an input or output, of those that are told in a row, has a level.
fn has([di, dout]: [&str; 2], (signal, wanted): (Signal, bool)) -> bool {
    let levels = if signal.kind == SignalKind::DigitalInput { di } else { dout };
    (levels.as_bytes().get(signal.channel as usize - 1) == Some(&b'1')) == wanted
}

/// Where the robot of a channel is.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Moves {
    /// The file of the motion that is executed, or was last.
    pub file: String,
    /// From 1; 0: nothing has moved yet.
    pub line: u32,
    /// x, y, z in mm, a, b, c in deg, in the world, once something has moved.
    pub base: Vec<f64>,
    /// deg, mm
    pub axes: Vec<f64>,
}

/// x, y, z in mm, and a quaternion x, y, z, w.
pub type Placed = [f64; 7];

/// A joint that moves a link against the one before, or against the base.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct LinkJoint {
    /// The link's frame in the one before while the axis is at 0.
    pub origin: Placed,
    /// What it turns about, or moves along, in the link's frame.
    pub axis: [f64; 3],
    /// Whether it moves along its axis.
    pub linear: bool,
}

impl LinkJoint {
    /// The joint of the robot's kinematics.
    pub fn joint(&self) -> kinematics::LinkJoint {
        let axis = Unit::new_normalize(Vector3::from(self.axis));
        kinematics::LinkJoint { origin: placed(&self.origin), axis, linear: self.linear }
    }
}

/// The frame that is written so.
pub fn placed([x, y, z, i, j, k, w]: &Placed) -> Frame {
    let turned = UnitQuaternion::from_quaternion(Quaternion::new(*w, *i, *j, *k));
    Frame::from_parts(Translation3::new(*x, *y, *z), turned)
}

/// How a frame is written.
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

/// How everything stands.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct State {
    /// Controller time in s.
    pub time: f64,
    /// `AUTO`, `MANUAL`, `MANUFAST`
    pub mode: String,
    /// %
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

/// How one channel stands.
#[derive(Clone, PartialEq, Default, Serialize, Deserialize, Debug)]
pub struct Channel {
    /// `running`, `paused`, `ended`, `alarm` and so on.
    pub state: String,
    /// The file that the program is in.
    pub file: String,
    /// The line that the program is in.
    pub line: usize,
    /// The file of the motion that is executed, or was last.
    pub motion_file: String,
    /// 0: nothing has moved yet.
    pub motion_line: usize,
    /// The running number of the motion executed in the last cycle; 0: none.
    #[serde(default)]
    pub motion: u64,
    /// deg, mm
    pub axes: Vec<f64>,
    /// x, y, z in mm, a, b, c in deg, in the world.
    pub tcp: Vec<f64>,
    /// The robot's base, as the TCP.
    #[serde(default)]
    pub base: Vec<f64>,
    /// The workpiece, as the TCP.
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
    /// In how many lines its variables are shown: one for each, and one for each file.
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
    /// The file that it is in.
    pub file: String,
    /// The line that it is in.
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

/// A line of the report (docs/seeing-a-run.md): times in s, ways in mm.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
#[serde(untagged)]
pub enum Report {
    /// What a motion did.
    Motion(Box<MotionReport>),
    /// What a channel did in all.
    Channel(ChannelReport),
    /// How late cycles began, in real time.
    Clock {
        /// The figures.
        clock: ClockReport,
    },
}

/// What a motion did.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct MotionReport {
    /// From 1.
    pub channel: u32,
    /// Its running number.
    pub motion: u64,
    /// The file that it is of.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// The instruction: `lin`.
    pub kind: String,
    /// Of `programmed` and `reached`: `mm/s`, `deg/s` or `%`.
    pub unit: String,
    /// The speed that was asked for, in its unit.
    pub programmed: f64,
    /// The highest speed along the path, in its unit.
    pub reached: f64,
    /// When it began, in s.
    pub start: f64,
    /// How long it was executed, in s.
    pub duration: f64,
    /// How far the TCP went, in mm.
    pub way: f64,
    /// The zone at its end, where one was asked for.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub blend: Option<BlendReport>,
    /// Where it slowed down beside a singular point.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slowed: Option<SlowedReport>,
    /// The limits that it came nearest to.
    pub closest: ClosestReport,
}

/// A zone: what was asked for and what was used, in its unit.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct BlendReport {
    /// `mm`, `deg` or `%`.
    pub unit: String,
    /// What the program asks for.
    pub asked: f64,
    /// What was used.
    pub used: f64,
    /// Why that is less.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub why: Option<String>,
}

/// Where an axis lets a motion go slowly only, beside a singular point.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct SlowedReport {
    /// The axis.
    pub axis: String,
    /// How far along the motion, 0 to 1.
    pub along: f64,
    /// The speed that it lets it have.
    pub speed: f64,
    /// The unit of the speed.
    pub unit: String,
}

/// The limits of each kind that a motion came nearest to.
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
    /// Whose it is: `j1`, `tcp`.
    pub of: String,
    /// %
    pub percent: f64,
}

/// What a channel did in all.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct ChannelReport {
    /// From 1.
    pub channel: u32,
    /// Until its program had ended, in s.
    pub cycle_time: f64,
    /// How long its robot moved, in s.
    pub moving: f64,
    /// How long it stood, in s.
    pub standing: f64,
    /// How many motions began.
    pub motions: u64,
}

/// How late cycles began.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct ClockReport {
    /// How many there were.
    pub cycles: u64,
    /// How many of them began late.
    pub late: u64,
    /// How many were lost.
    pub lost: u64,
    /// How many messages of robots were missing.
    pub missing: u64,
    /// The longest delay, in s.
    pub longest: f64,
    /// So many s, and how many cycles began within them.
    pub histogram: Vec<(f64, u64)>,
}

/// What the program printed.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Message {
    /// Controller time in s.
    pub time: f64,
    /// `channel 1`, as a sentence calls it.
    #[serde(default)]
    pub channel: String,
    /// Whether it goes to the pendant.
    #[serde(default)]
    pub hmi: bool,
    /// Whether it goes to the console.
    #[serde(default)]
    pub console: bool,
    /// What was printed.
    pub text: String,
}

/// What stopped a program.
#[derive(Clone, PartialEq, Serialize, Deserialize, Debug)]
pub struct Alarm {
    /// Its number.
    #[serde(default)]
    pub number: u32,
    /// The file of the line that it is of.
    #[serde(default)]
    pub file: String,
    /// From 1; 0: no line is to blame.
    #[serde(default)]
    pub line: u32,
    /// What it says, with its number and its place.
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

/// Where a body of the cell is from now on.
#[derive(Clone, PartialEq, Debug)]
pub struct Placing {
    /// Which body of the cell.
    pub body: usize,
    /// `None`: it is not there.
    pub place: Option<Place>,
}

/// Where a body is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Place {
    /// The channel, from 0, whose robot holds it; `None`: it stands in the world.
    pub held_by: Option<usize>,
    /// Its frame in the flange or in the world, in mm.
    pub at: Frame,
}

/// Two bodies that touch for the first time, or come nearer to each other than asked for.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Contact {
    /// Controller time in s.
    pub time: f64,
    /// The place of the motion that brought them together.
    pub file: String,
    /// From 1.
    pub line: u32,
    /// One of them.
    pub one: String,
    /// The other one.
    pub other: String,
    /// mm; 0: they touch.
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
        write!(f, " after {time:.3} s ({file}:{line})")
    }
}

/// The examples of the README run.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
