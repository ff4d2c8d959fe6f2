//! What a program says of its run, an object of JSON a line: to a screen that drives it, or to a recorder.

use std::collections::BTreeMap;
use std::fmt;

use arl_robot::cell::{Signal, SignalKind};
use arl_robot::kinematics::{self, Frame};
use nalgebra::{Quaternion, Translation3, Unit, UnitQuaternion, Vector3};
use serde::Deserialize;

/// A line of the program. `arl-rt` documents them in its module `live`.
#[derive(Clone, PartialEq, Deserialize, Debug)]
#[serde(rename_all = "snake_case")]
pub(super) enum Line {
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
    /// What is no alarm but worth a word.
    Warning(String),
    /// What stopped a program.
    Alarm(Alarm),
    /// An order that could not be carried out, and why.
    Refused(Refused),
    /// What a motion did, or a channel: an object of the report.
    Report(serde_json::Value),
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
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(default)]
pub(super) struct Hello {
    pub(super) channels: Vec<Runs>,
    /// What signals are called, by how files write them: `di.1`.
    pub(super) names: BTreeMap<String, String>,
}

/// What one channel runs.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Runs {
    pub(super) program: String,
    /// Absent in a background channel.
    pub(super) robot: Option<String>,
    pub(super) axes: Vec<Axis>,
    /// The joints of its own axes, from the base on.
    #[serde(default)]
    pub(super) links: Vec<LinkJoint>,
    /// The flange in the last link.
    #[serde(default)]
    pub(super) flange: Placed,
    /// Its shape.
    #[serde(default)]
    pub(super) limbs: Vec<Limb>,
}

impl Runs {
    /// Which of its axes an external one is, and what is known of it.
    pub(super) fn external(&self, number: usize) -> Option<(usize, &Axis)> {
        let at = self.links.len() + number;
        self.axes.get(at).map(|axis| (at, axis))
    }

    /// The flange in the world.
    pub(super) fn flange_in_world(&self, channel: &Channel) -> Frame {
        let base = <[f64; 6]>::try_from(&channel.base[..]).map(kinematics::frame).unwrap_or_default();
        base * self.flange_at(&channel.axes)
    }

    /// The flange in the base, in mm, while the axes have these values in deg and mm.
    pub(super) fn flange_at(&self, axes: &[f64]) -> Frame {
        let links = self.links.iter().zip(axes);
        links.fold(Frame::identity(), |before, (link, axis)| before * link.joint().at(*axis)) * placed(&self.flange)
    }
}

/// A capsule that belongs to a link, from 1, or to the base, 0: its ends in the frame of that, and its radius, in mm.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Limb {
    pub(super) name: String,
    pub(super) link: usize,
    pub(super) ends: [[f64; 3]; 2],
    pub(super) radius: f64,
}

/// What people call a link of so many, 0 is the base: as the capsule in its place.
pub(super) fn name_of_link(link: usize, of: usize, limbs: &[Limb]) -> &str {
    let found = if link + 1 >= of { limbs.last() } else { limbs.iter().rfind(|limb| limb.link <= link) };
    found.map_or("the robot", |limb| &limb.name)
}

/// Where the robots are.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Cycle {
    /// Controller time in s.
    pub(super) time: f64,
    pub(super) channels: Vec<Moves>,
    /// Levels in a row, from channel 1.
    pub(super) di: String,
    #[serde(rename = "do")]
    pub(super) dout: String,
}

impl Cycle {
    /// Whether an input or output has a level.
    pub(super) fn has(&self, level: (Signal, bool)) -> bool {
        has([&self.di, &self.dout], level)
    }
}

impl State {
    /// Whether an input or output has a level.
    pub(super) fn has(&self, level: (Signal, bool)) -> bool {
        has([&self.di, &self.dout], level)
    }
}

/// Whether an input or output, of those that are told in a row, has a level.
fn has([di, dout]: [&str; 2], (signal, wanted): (Signal, bool)) -> bool {
    let levels = if signal.kind == SignalKind::DigitalInput { di } else { dout };
    (levels.as_bytes().get(signal.channel as usize - 1) == Some(&b'1')) == wanted
}

/// Where the robot of a channel is.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Moves {
    /// The place of the motion that is executed, or was last; line 0: none yet.
    pub(super) file: String,
    pub(super) line: u32,
    /// x, y, z in mm, a, b, c in deg, in the world, once something has moved.
    pub(super) base: Vec<f64>,
    /// deg, mm
    pub(super) axes: Vec<f64>,
}

/// x, y, z in mm, and a quaternion x, y, z, w.
pub(super) type Placed = [f64; 7];

/// A joint that moves a link against the one before, or against the base.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct LinkJoint {
    /// The link's frame in the one before while the axis is at 0.
    pub(super) origin: Placed,
    /// What it turns about, or moves along, in the link's frame.
    pub(super) axis: [f64; 3],
    pub(super) linear: bool,
}

impl LinkJoint {
    /// The joint of the robot's kinematics.
    pub(super) fn joint(&self) -> kinematics::LinkJoint {
        let axis = Unit::new_normalize(Vector3::from(self.axis));
        kinematics::LinkJoint { origin: placed(&self.origin), axis, linear: self.linear }
    }
}

/// The frame that is written so.
pub(super) fn placed([x, y, z, i, j, k, w]: &Placed) -> Frame {
    let turned = UnitQuaternion::from_quaternion(Quaternion::new(*w, *i, *j, *k));
    Frame::from_parts(Translation3::new(*x, *y, *z), turned)
}

/// How a frame is written.
pub(super) fn written(frame: &Frame) -> Placed {
    let ([x, y, z], [i, j, k, w]): ([f64; 3], [f64; 4]) =
        (frame.translation.vector.into(), frame.rotation.coords.into());
    [x, y, z, i, j, k, w]
}

/// An axis and its range, in its unit.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Axis {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) min: f64,
    pub(super) max: f64,
}

impl Axis {
    pub(super) fn is_linear(&self) -> bool {
        self.unit == "mm"
    }
}

/// How everything stands.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct State {
    /// Controller time in s.
    pub(super) time: f64,
    pub(super) mode: String,
    /// %
    #[serde(rename = "override")]
    pub(super) speed_override: f64,
    pub(super) channels: Vec<Channel>,
    /// Levels in a row, from channel 1.
    pub(super) di: String,
    #[serde(rename = "do")]
    pub(super) dout: String,
    pub(super) ai: Vec<f64>,
    pub(super) ao: Vec<f64>,
}

/// How one channel stands.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Channel {
    pub(super) state: String,
    pub(super) file: String,
    pub(super) line: usize,
    pub(super) motion_file: String,
    /// 0: nothing has moved yet.
    pub(super) motion_line: usize,
    /// The running number of the motion executed in the last cycle; 0: none.
    #[serde(default)]
    pub(super) motion: u64,
    /// deg, mm
    pub(super) axes: Vec<f64>,
    /// x, y, z in mm, a, b, c in deg, in the world.
    pub(super) tcp: Vec<f64>,
    /// The robot's base, as the TCP.
    #[serde(default)]
    pub(super) base: Vec<f64>,
    /// The workpiece, as the TCP.
    #[serde(default)]
    pub(super) workpiece: Vec<f64>,
}

/// The functions and variables of a channel.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(default)]
pub(super) struct Inside {
    /// From 1.
    pub(super) channel: usize,
    /// The functions that run, the innermost first.
    pub(super) frames: Vec<Function>,
    /// Variables of the innermost function, clocks and connections.
    pub(super) variables: Vec<Variable>,
    pub(super) handles: Vec<Variable>,
    /// Files with global variables.
    pub(super) files: Vec<Globals>,
}

impl Inside {
    /// In how many lines its variables are shown: one for each, and one for each file.
    pub(super) fn variable_lines(&self) -> usize {
        let of_files = self.files.iter().map(|file| 1 + file.variables.len() + file.handles.len());
        self.variables.len() + self.handles.len() + of_files.sum::<usize>()
    }
}

/// A function that runs, or the action of an event.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Function {
    pub(super) name: String,
    pub(super) file: String,
    pub(super) line: usize,
}

/// A variable and its value as a literal.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) value: String,
}

/// The global variables of a file.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(default)]
pub(super) struct Globals {
    pub(super) file: String,
    pub(super) variables: Vec<Variable>,
    pub(super) handles: Vec<Variable>,
}

/// What the program printed.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Message {
    pub(super) time: f64,
    /// `channel 1`, as a sentence calls it.
    #[serde(default)]
    pub(super) channel: String,
    pub(super) text: String,
}

/// What stopped a program.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Alarm {
    #[serde(default)]
    pub(super) number: u32,
    #[serde(default)]
    pub(super) file: String,
    #[serde(default)]
    pub(super) line: u32,
    pub(super) text: String,
}

/// An order that could not be carried out, and why.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Refused {
    pub(super) order: String,
    pub(super) why: String,
}

/// Where a body of the cell is from now on.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Placing {
    /// Which body of the cell.
    pub(super) body: usize,
    /// `None`: it is not there.
    pub(super) place: Option<Place>,
}

/// Where a body is.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(super) struct Place {
    /// The channel, from 0, whose robot holds it; `None`: it stands in the world.
    pub(super) held_by: Option<usize>,
    /// Its frame in the flange or in the world, in mm.
    pub(super) at: Frame,
}

/// Two bodies that touch for the first time, or come nearer to each other than asked for.
#[derive(Clone, PartialEq, Default, Debug)]
pub(super) struct Contact {
    /// Controller time in s.
    pub(super) time: f64,
    /// The place of the motion that brought them together.
    pub(super) file: String,
    pub(super) line: u32,
    pub(super) one: String,
    pub(super) other: String,
    /// mm; 0: they touch.
    pub(super) distance: f64,
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
