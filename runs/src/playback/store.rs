//! The messages of a run, in columns.

use std::collections::{BTreeMap, HashMap};
use std::fmt;

use arl_robot::kinematics::frame;
use mcap::McapResult;
use nalgebra::Vector3;
use twox_hash::XxHash3_128;

use super::bounds::Bounded;
use crate::record::messages::{Cell, Channel, Contact, Controller, Io, Link, Log, Motion, SceneUpdate};
use crate::record::{RunMessage, Sink};
use crate::texts::Text;
use arl_wire::{LinkJoint, placed as placed_frame, written};

/// Between messages that are farther apart than this, in s, the robot was at rest: a moving robot reports more often.
const GAP_S: f64 = 0.06;
/// A motion up to this many before the last one may be reported again.
pub(crate) const REPORTED_AGAIN: usize = 64;
/// The interval of messages while a robot moves, in s.
const STEP_S: f64 = 0.004;
/// A TCP whose place on the flange differs by more than this, in mm, is that of another tool.
const OTHER_TOOL_MM: f64 = 0.01;
/// Where the flange is not known, a TCP that accelerates by more than this, in mm/s2, when a motion begins is that of
/// another tool.
const OTHER_TOOL_ACC: f64 = 5e5;

/// A run as far as it is known.
#[derive(Default)]
pub(crate) struct Store {
    pub(crate) cell: Cell,
    pub(crate) sources: Vec<Text>,
    pub(crate) scene: Vec<(f64, SceneUpdate)>,
    /// The meshes of the scene, each once, and for each model of the scene, in order, the index of its mesh.
    pub(crate) meshes: Vec<Vec<u8>>,
    pub(crate) models: Vec<usize>,
    /// The indices of meshes, by their hash.
    pub(crate) known_meshes: HashMap<u128, usize>,
    /// The cell's names of signals.
    pub(crate) names: HashMap<String, String>,
    pub(crate) tracks: Vec<Track>,
    /// Each signal's changes, by its name in files: `di.1`.
    pub(crate) signals: BTreeMap<Signal, Vec<(f64, f64)>>,
    /// The same changes in the order in which they came.
    pub(crate) changes: Vec<(Signal, f64, f64)>,
    pub(crate) controller: Vec<Controller>,
    pub(crate) log: Vec<(f64, Log)>,
    pub(crate) contacts: Vec<Contact>,
    pub(crate) motions: Vec<Motion>,
    /// The time of the last message in s.
    pub(crate) end: f64,
    /// Whether a running program adds to it.
    pub(crate) goes_on: bool,
    /// What of the recording could not be read, and the reason.
    pub(crate) problem: Option<String>,
    /// Counts the messages that were added.
    pub(crate) version: u64,
    /// The present inputs and outputs.
    pub(crate) io: Io,
}

/// A signal: its kind and its number from 1 on; files write it as `di.1`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(crate) struct Signal {
    pub(crate) kind: &'static str,
    pub(crate) number: usize,
}

/// What a channel did, in columns.
#[derive(Default)]
pub(crate) struct Track {
    pub(crate) times: Vec<f64>,
    /// The number of axes in a row.
    pub(crate) width: usize,
    pub(crate) axes: Vec<f32>,
    /// x, y, z in mm, and a quaternion x, y, z, w.
    pub(crate) tcp: Vec<[f32; 7]>,
    /// The speed of the TCP in mm/s.
    pub(crate) speed: Vec<f32>,
    /// Whether the TCP is that of another tool than in the row before: it has not moved from there to here.
    pub(crate) jumps: Vec<bool>,
    /// The last report of where the robot is.
    last: Option<Channel>,
    pub(crate) pointers: Vec<Pointers>,
    /// For each motion that was seen, the number of the file it is in.
    pub(crate) motion_files: BTreeMap<u32, u16>,
    /// The file names to which pointers and states refer by number.
    pub(crate) files: Vec<String>,
    numbers: HashMap<String, u16>,
    pub(crate) states: Vec<(f64, String)>,
    /// The time that each line took, by the number of its file.
    pub(crate) lines: BTreeMap<(u16, u32), Took>,
    /// The places of the base, from each change on.
    pub(crate) bases: Vec<(f64, [f32; 7])>,
}

/// How long the robot moved for a line, and was at rest in it, in s.
#[derive(Clone, Copy, Default, PartialEq, Debug)]
pub(crate) struct Took {
    pub(crate) moving: f64,
    pub(crate) standing: f64,
}

/// Where program and robot are: lines, numbers of files, and the number of the motion that is executed; 0: none.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(crate) struct Pointers {
    pub(crate) file: u16,
    pub(crate) line: u32,
    pub(crate) motion_file: u16,
    pub(crate) motion_line: u32,
    pub(crate) motion: u32,
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.kind, self.number)
    }
}

impl Store {
    /// The cell's name of a signal, if it has one.
    pub(crate) fn name_of(&self, signal: Signal) -> Option<&str> {
        self.names.get(&signal.to_string()).map(String::as_str)
    }

    /// Adds a message of a recording, at a time in ns; messages of other origin are skipped.
    ///
    /// # Errors
    /// The reason why the message is not of the topic's kind, or has values that no run can have.
    pub(crate) fn take(&mut self, topic: &str, time: u64, message: &[u8]) -> Result<(), String> {
        match RunMessage::decoded(topic, message).map_err(|error| error.to_string())? {
            Some(message) => self.add(time, message),
            None => Ok(()),
        }
    }

    /// Adds a message, at a time in ns.
    fn add(&mut self, time: u64, message: RunMessage) -> Result<(), String> {
        message.check()?;
        let time = time as f64 / 1e9;
        match message {
            RunMessage::Cell(cell) => self.cell(cell),
            RunMessage::Scene(update) => self.scene(time, update),
            RunMessage::Controller(controller) => self.controller.push(controller),
            RunMessage::Io(io) => self.io(io),
            RunMessage::Motion(motion) => self.motion(motion),
            RunMessage::Contact(contact) => self.contacts.push(contact),
            RunMessage::Log(log) => self.log.push((time, log)),
            RunMessage::Channel(number, channel) => self.channel(number.saturating_sub(1), channel)?,
            // These follow from other messages.
            RunMessage::Frames(_) | RunMessage::Joints(_) => return Ok(()),
        }
        self.end = self.end.max(time);
        self.version += 1;
        Ok(())
    }

    fn cell(&mut self, cell: Cell) {
        // Of two names of a signal the first one counts.
        self.names = cell.names.iter().rev().map(|name| (name.signal.clone(), name.name.clone())).collect();
        self.cell = cell;
    }

    /// Adds an update; a mesh that comes again is kept once.
    fn scene(&mut self, time: f64, mut update: SceneUpdate) {
        for model in update.entities.iter_mut().flat_map(|entity| &mut entity.models) {
            let data = std::mem::take(&mut model.data);
            let place = *self.known_meshes.entry(XxHash3_128::oneshot(&data)).or_insert(self.meshes.len());
            let is_known = self.meshes.get(place) == Some(&data);
            self.models.push(if is_known { place } else { self.meshes.len() });
            if !is_known {
                self.meshes.push(data);
            }
        }
        self.scene.push((time, update));
    }

    fn io(&mut self, io: Io) {
        let flags = |flags: &[bool]| flags.iter().map(|flag| f64::from(*flag)).collect::<Vec<_>>();
        let kinds = [
            ("di", flags(&self.io.di), flags(&io.di)),
            ("do", flags(&self.io.r#do), flags(&io.r#do)),
            ("ai", self.io.ai.clone(), io.ai.clone()),
            ("ao", self.io.ao.clone(), io.ao.clone()),
        ];
        for (kind, before, now) in kinds {
            for (at, value) in now.into_iter().enumerate() {
                // All signals begin at 0: a signal that never leaves it has no changes.
                if before.get(at).copied().unwrap_or_default() != value {
                    let signal = Signal { kind, number: at + 1 };
                    self.signals.entry(signal).or_default().push((io.time, value));
                    self.changes.push((signal, io.time, value));
                }
            }
        }
        self.io = io;
    }

    /// A motion that is reported again has continued since.
    fn motion(&mut self, motion: Motion) {
        let mut late = self.motions.iter_mut().rev().take(REPORTED_AGAIN);
        let again = late.find(|late| (late.channel, late.motion) == (motion.channel, motion.motion));
        match again {
            Some(last) => *last = motion,
            None => self.motions.push(motion),
        }
    }

    fn channel(&mut self, at: usize, message: Channel) -> Result<(), String> {
        if self.tracks.len() <= at {
            self.tracks.resize_with(at + 1, Track::default);
        }
        let links = self.cell.channels.get(at).map(|runs| &runs.links[..]).unwrap_or_default();
        self.tracks.get_mut(at).map_or(Ok(()), |track| track.take(message, links))
    }
}

impl Track {
    fn take(&mut self, message: Channel, links: &[Link]) -> Result<(), String> {
        let (file, motion_file) = (self.file(&message.file)?, self.file(&message.motion_file)?);
        if self.times.is_empty() {
            self.width = message.axes.len();
        }
        if self.states.last().is_none_or(|(_, last)| *last != message.state) {
            self.states.push((message.time, message.state.clone()));
        }
        let base = placed(&message.base);
        if !message.base.is_empty() && self.bases.last().is_none_or(|(_, last)| *last != base) {
            self.bases.push((message.time, base));
        }
        let tcp = placed(&message.tcp);
        let (speed, before) = (self.speed_to(message.time, &tcp), self.speed.last().copied().unwrap_or_default());
        let jumps = self.last.as_ref().is_some_and(|last| {
            // The kinematics are computed last: a motion seldom begins.
            let may_jump = last.motion != message.motion && distance(&last.tcp, &message.tcp) > OTHER_TOOL_MM;
            may_jump
                && flange_tool(last, links).zip(flange_tool(&message, links)).map_or_else(
                    || f64::from(speed - before) > OTHER_TOOL_ACC * STEP_S,
                    |(one, other)| (one - other).norm() > OTHER_TOOL_MM,
                )
        });
        self.jumps.push(jumps);
        self.speed.push(if jumps { before } else { speed });
        self.axes.extend((0..self.width).map(|axis| message.axes.get(axis).copied().unwrap_or_default() as f32));
        self.tcp.push(tcp);
        let pointers = Pointers {
            file,
            line: message.line,
            motion_file,
            motion_line: message.motion_line,
            motion: u32::try_from(message.motion).unwrap_or(u32::MAX),
        };
        self.count(message.time, pointers);
        if pointers.motion != 0 && self.pointers.last().is_none_or(|last| last.motion != pointers.motion) {
            self.motion_files.insert(pointers.motion, pointers.motion_file);
        }
        self.times.push(message.time);
        self.pointers.push(pointers);
        self.last = Some(message);
        Ok(())
    }

    /// Adds the time since the last message to the lines: to that of the motion while one was executed, and to that of
    /// the program while the robot was at rest.
    fn count(&mut self, time: f64, now: Pointers) {
        let (Some(since), Some(before)) = (self.times.last(), self.pointers.last()) else { return };
        let apart = time - since;
        let moving = match now.motion {
            0 => 0.0,
            _ if apart > GAP_S => STEP_S,
            _ => apart,
        };
        if moving > 0.0 {
            self.lines.entry((now.motion_file, now.motion_line)).or_default().moving += moving;
        }
        if apart > moving {
            self.lines.entry((before.file, before.line)).or_default().standing += apart - moving;
        }
    }

    /// The speed at which the TCP came from its last place, in mm/s.
    fn speed_to(&self, time: f64, tcp: &[f32; 7]) -> f32 {
        let (Some(before), Some(last)) = (self.times.last(), self.tcp.last()) else { return 0.0 };
        let distance = distance(&last.map(f64::from), &tcp.map(f64::from));
        let apart = time - before;
        // A robot at rest does not report until its first step.
        (distance / if apart > GAP_S { STEP_S } else { apart.max(1e-6) }) as f32
    }

    /// The number of a file.
    fn file(&mut self, name: &str) -> Result<u16, String> {
        if let Some(number) = self.numbers.get(name) {
            return Ok(*number);
        }
        let number = u16::try_from(self.files.len());
        let number = number.map_err(|_| format!("the program has more than {} files", u32::from(u16::MAX) + 1))?;
        self.files.push(name.to_owned());
        self.numbers.insert(name.to_owned(), number);
        Ok(number)
    }
}

/// The distance between two places, in mm.
fn distance(from: &[f64], to: &[f64]) -> f64 {
    from.iter().zip(to).take(3).map(|(from, to)| (to - from) * (to - from)).sum::<f64>().sqrt()
}

/// Where the TCP is on the flange, in mm, if the recording has the robot's links.
fn flange_tool(message: &Channel, links: &[Link]) -> Option<Vector3<f64>> {
    let (base, tcp) = (<[f64; 6]>::try_from(&message.base[..]).ok()?, <[f64; 6]>::try_from(&message.tcp[..]).ok()?);
    let mut flange = frame(base);
    for (at, link) in links.iter().enumerate() {
        let origin = <[f64; 7]>::try_from(&link.origin[..]).ok()?;
        flange *= match <[f64; 3]>::try_from(&link.axis[..]) {
            Ok(axis) => LinkJoint { origin, axis, linear: link.linear }.joint().at(*message.axes.get(at)?),
            Err(_) => placed_frame(&origin),
        };
    }
    (!links.is_empty()).then(|| (flange.inverse() * frame(tcp)).translation.vector)
}

/// A frame from x, y, z in mm, a, b, c in deg.
fn placed(values: &[f64]) -> [f32; 7] {
    let Ok(values) = <[f64; 6]>::try_from(values) else { return [0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0] };
    written(&frame(values)).map(|value| value as f32)
}

impl Sink for Store {
    fn message(&mut self, time: u64, message: RunMessage) -> McapResult<()> {
        self.add(time, message).map_err(|error| std::io::Error::other(error).into())
    }

    fn source(&mut self, name: &str, text: &str) -> McapResult<()> {
        self.sources.push(Text { name: name.to_owned(), text: text.to_owned() });
        Ok(())
    }

    fn finish(&mut self) -> McapResult<()> {
        Ok(())
    }
}
