//! Writes what a program reports into a recording.

use mcap::McapResult;

use super::links::RecordedArm;
use super::message::RunMessage;
use super::messages::{
    Axis, Blend, Cell, Channel, Closest, Contact, Controller, FrameTransforms, Io, JointState, JointStates, Level, Log,
    Motion, Name, Runs, Timestamp,
};
use super::parts::RecordedParts;
use super::scene::Scene;
use super::sink::Sink;
use crate::scenery::Scenery;
use arl_wire::{BlendReport, Hello, Line, MotionReport, Placing, Report, State};

/// How often frames and joints are written for viewers, in s; our own messages have every state.
const FRAMES_INTERVAL_S: f64 = 0.02;

/// Turns lines into messages.
pub(crate) struct Recorder<S> {
    sink: S,
    /// The arm of each channel, where it has one.
    arms: Vec<Option<RecordedArm>>,
    /// What is in the cell, or is carried.
    scene: Scene,
    /// The frames of the parts that robots take along.
    parts: RecordedParts,
    /// What was last written to each topic: what stays the same is not written again.
    last: Last,
    /// The time of the last state, in s.
    time: f64,
    /// When frames are written next, in s.
    frames_due: f64,
    /// The last state, if its frames were not written.
    left_out: Option<State>,
}

/// What was last written.
#[derive(Default)]
struct Last {
    channels: Vec<Channel>,
    controller: Controller,
    io: Option<Io>,
    /// For each channel axes, TCP, base and workpiece.
    places: Vec<Vec<f64>>,
}

impl<S: Sink> Recorder<S> {
    /// A recorder for a scenery.
    pub(crate) fn new(sink: S, scenery: &Scenery) -> Self {
        Self {
            sink,
            arms: Vec::new(),
            scene: Scene::new(scenery),
            parts: RecordedParts::of(scenery),
            last: Last::default(),
            time: 0.0,
            frames_due: 0.0,
            left_out: None,
        }
    }

    /// Adds a text of the program.
    pub(crate) fn source(&mut self, name: &str, text: &str) -> McapResult<()> {
        self.sink.source(name, text)
    }

    /// Takes a line of the program.
    pub(crate) fn receive(&mut self, line: &Line) -> McapResult<()> {
        let log = |level: Level, text: &str| Log { level: level.into(), message: text.into(), ..Log::default() };
        match line {
            Line::Hello(hello) => self.begin(hello),
            Line::State(state) => self.state(state),
            Line::Message(arl_wire::Message { time, channel, text, .. }) => {
                let entry = log(Level::Info, text.trim_end_matches('\n'));
                self.log(*time, Log { name: channel.clone(), ..entry })
            }
            Line::Warning(text) => self.log(self.time, log(Level::Warning, text)),
            Line::Alarm(arl_wire::Alarm { text, file, line, .. }) => {
                self.log(self.time, Log { file: file.clone(), line: *line, ..log(Level::Error, text) })
            }
            Line::Report(report) => self.motion(report),
            Line::Contact(contact) => self.contact(contact),
            Line::Placing(placing) => self.placing(placing),
            Line::Cycle(_) | Line::Ended(_) | Line::Inside(_) | Line::Refused(_) | Line::Other(_) => Ok(()),
        }
    }

    /// Writes the summary that readers use to find their way.
    pub(crate) fn finish(&mut self) -> McapResult<()> {
        if let Some(state) = self.left_out.take() {
            self.frames(&state)?;
        }
        self.sink.finish()
    }

    /// Finishes, and returns the sink.
    pub(crate) fn ended(mut self) -> McapResult<S> {
        self.finish()?;
        Ok(self.sink)
    }

    /// The robots' arms by channels, once the program has reported them.
    pub(super) fn arms(&self) -> &[Option<RecordedArm>] {
        &self.arms
    }

    /// The scenery around them.
    pub(super) fn scenery(&self) -> &Scenery {
        self.scene.scenery()
    }

    fn begin(&mut self, hello: &Hello) -> McapResult<()> {
        let robots = hello.channels.iter().filter(|runs| !runs.links.is_empty()).count();
        let arm = |(at, runs): (usize, &arl_wire::Runs)| {
            let prefix = if robots > 1 { format!("channel_{}/", at + 1) } else { String::new() };
            (!runs.links.is_empty()).then(|| RecordedArm::new(prefix, runs, at, &self.scene.scenery().carriers))
        };
        self.arms = hello.channels.iter().enumerate().map(arm).collect();
        let axis = |axis: &arl_wire::Axis| Axis {
            name: axis.name.clone(),
            unit: axis.unit.clone(),
            min: axis.min,
            max: axis.max,
        };
        let runs = |(runs, arm): (&arl_wire::Runs, &Option<RecordedArm>)| Runs {
            program: runs.program.clone(),
            robot: runs.robot.clone().unwrap_or_default(),
            axes: runs.axes.iter().map(axis).collect(),
            links: arm.iter().flat_map(RecordedArm::chain).collect(),
            tcp: arm.as_ref().map(RecordedArm::tcp_frame).unwrap_or_default(),
            carriers: arm.iter().flat_map(RecordedArm::carried).collect(),
        };
        let name = |(signal, name): (&String, &String)| Name { signal: signal.clone(), name: name.clone() };
        let channels = hello.channels.iter().zip(&self.arms).map(runs).collect();
        let cell = Cell { channels, names: hello.names.iter().map(name).collect() };
        self.last.channels = vec![Channel::default(); hello.channels.len()];
        self.parts.begin(&hello.channels);
        self.write(0.0, RunMessage::Cell(cell))?;
        let robots = self.scene.robots(&self.arms);
        self.write(0.0, RunMessage::Scene(robots))
    }

    fn state(&mut self, state: &State) -> McapResult<()> {
        let time = state.time;
        self.time = time;
        self.sink.reach(nanoseconds(time))?;
        let controller = Controller { time, mode: state.mode.clone(), speed_override: state.speed_override };
        if (Controller { time: self.last.controller.time, ..controller.clone() }) != self.last.controller {
            self.write(time, RunMessage::Controller(controller.clone()))?;
            self.last.controller = controller;
        }
        let levels = |levels: &str| levels.bytes().map(|level| level == b'1').collect();
        let (di, r#do) = (levels(&state.di), levels(&state.dout));
        let io = Io { time, di, r#do, ai: state.ai.clone(), ao: state.ao.clone() };
        if self.last.io.as_ref().is_none_or(|last| (Io { time: last.time, ..io.clone() }) != *last) {
            self.write(time, RunMessage::Io(io.clone()))?;
            if let Some(update) = self.scene.bodies(state, &self.arms, timestamp(time)) {
                self.write(time, RunMessage::Scene(update))?;
            }
            self.last.io = Some(io);
        }
        for (at, reported) in state.channels.iter().enumerate() {
            self.channel(at, reported, time)?;
        }
        self.parts.robots_are(&state.channels);
        if time < self.frames_due {
            self.left_out = Some(state.clone());
            return Ok(());
        }
        self.frames_due = time + FRAMES_INTERVAL_S - 1e-6;
        self.left_out = None;
        self.frames(state)
    }

    fn channel(&mut self, at: usize, reported: &arl_wire::Channel, time: f64) -> McapResult<()> {
        let line = |line: usize| u32::try_from(line).unwrap_or_default();
        let channel = Channel {
            time,
            state: reported.state.clone(),
            file: reported.file.clone(),
            line: line(reported.line),
            motion_file: reported.motion_file.clone(),
            motion_line: line(reported.motion_line),
            motion: reported.motion,
            axes: reported.axes.clone(),
            tcp: reported.tcp.clone(),
            base: reported.base.clone(),
        };
        let Some(last) = self.last.channels.get_mut(at) else { return Ok(()) };
        if (Channel { time: last.time, ..channel.clone() }) == *last {
            return Ok(());
        }
        last.clone_from(&channel);
        self.write(time, RunMessage::Channel(at + 1, channel))
    }

    /// Writes frames and joints of all robots, if one has moved.
    fn frames(&mut self, state: &State) -> McapResult<()> {
        let time = state.time;
        let places = state.channels.iter();
        let places = places
            .map(|reported| [&reported.axes[..], &reported.tcp, &reported.base, &reported.workpiece].concat())
            .collect();
        if self.last.places == places {
            return Ok(());
        }
        self.last.places = places;
        let (mut transforms, mut joints) = (Vec::new(), Vec::new());
        for (arm, reported) in self.arms.iter_mut().zip(&state.channels) {
            let Some(arm) = arm else { continue };
            arm.stands_on(&reported.base);
            transforms.extend(arm.transforms(reported, timestamp(time)));
            joints.extend(
                arm.joints(&reported.axes).map(|(name, position)| JointState { name, position: Some(position) }),
            );
        }
        transforms.extend(self.parts.held(timestamp(time)));
        if transforms.is_empty() {
            return Ok(());
        }
        self.write(time, RunMessage::Frames(FrameTransforms { transforms }))?;
        let joints = JointStates { timestamp: Some(timestamp(time)), joints };
        self.write(time, RunMessage::Joints(joints))
    }

    fn log(&mut self, time: f64, log: Log) -> McapResult<()> {
        self.write(time, RunMessage::Log(Log { timestamp: Some(timestamp(time)), ..log }))
    }

    /// Writes a motion of the report; what the report has about whole channels follows from the motions.
    fn motion(&mut self, report: &Report) -> McapResult<()> {
        let Report::Motion(motion) = report else { return Ok(()) };
        let MotionReport { channel, line, start, duration, way, programmed, reached, .. } = **motion;
        let blend = |blend: &BlendReport| Blend {
            asked: blend.asked,
            used: blend.used,
            unit: blend.unit.clone(),
            why: blend.why.clone().unwrap_or_default(),
        };
        let closest = |closest: &Option<arl_wire::Closest>| {
            closest.as_ref().map(|closest| Closest { of: closest.of.clone(), percent: closest.percent })
        };
        let motion = Motion {
            channel,
            motion: motion.motion,
            line,
            kind: motion.kind.clone(),
            start,
            duration,
            way,
            programmed,
            reached,
            unit: motion.unit.clone(),
            blend: motion.blend.as_ref().map(blend),
            closest_vel: closest(&motion.closest.vel),
            closest_acc: closest(&motion.closest.acc),
            closest_jerk: closest(&motion.closest.jerk),
            file: motion.file.clone(),
        };
        self.write(motion.start, RunMessage::Motion(motion))
    }

    /// Writes that two things came nearer to each other than they should.
    fn contact(&mut self, contact: &arl_wire::Contact) -> McapResult<()> {
        let arl_wire::Contact { time, file, line, one, other, distance } = contact.clone();
        let level = Level::Warning.into();
        let log = Log { level, message: contact.to_string(), file: file.clone(), line, ..Log::default() };
        self.log(time, log)?;
        self.write(time, RunMessage::Contact(Contact { time, file, line, one, other, distance }))
    }

    /// Writes that a body that robots take along is elsewhere.
    fn placing(&mut self, placing: &Placing) -> McapResult<()> {
        let body = self.scene.scenery().bodies.get(placing.body);
        let frame = body.map(|(body, _)| format!("part/{}", body.name)).unwrap_or_default();
        if let Some(transform) = self.parts.place(placing, frame, timestamp(self.time)) {
            let transforms = FrameTransforms { transforms: vec![transform] };
            self.write(self.time, RunMessage::Frames(transforms))?;
        }
        match self.scene.place(placing, &self.arms, timestamp(self.time)) {
            Some(update) => self.write(self.time, RunMessage::Scene(update)),
            None => Ok(()),
        }
    }

    fn write(&mut self, time: f64, message: RunMessage) -> McapResult<()> {
        self.sink.message(nanoseconds(time), message)
    }
}

fn nanoseconds(time: f64) -> u64 {
    (time * 1e9).round() as u64
}

fn timestamp(time: f64) -> Timestamp {
    let all = nanoseconds(time);
    Timestamp { seconds: (all / 1_000_000_000) as i64, nanos: (all % 1_000_000_000) as i32 }
}
