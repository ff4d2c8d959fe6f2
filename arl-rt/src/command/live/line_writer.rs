//! Sends states, messages, warnings and alarms on a stream, one JSON object per line.

use std::cell::Cell;
use std::fmt::Write as _;
use std::io::{BufWriter, Write, stdout};
use std::rc::Rc;
use std::sync::mpsc::{SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;

use arl_motion::beside;

use crate::command::json::{array, number, push_array, push_number, quoted};
use crate::context::output::{Message, Output};
use crate::controller::{ChannelStatus, Controller, Outcome, RobotStatus, State};
use crate::fault::Alarm;
use arl_robot::kinematics::{Frame, Kinematics, LinkJoint};
use arl_robot::robot::{Axis, Limb};

/// How many lines may wait to be written. Beyond that states are left out, and everything else waits.
const MAX_WAITING_LINES: usize = 1024;

/// A stream, written by a thread of its own, so that no cycle waits for it as long as it is read.
pub(crate) struct LineWriter {
    lines: Lines,
    writer: Option<JoinHandle<()>>,
}

/// Lines that wait to be written.
#[derive(Clone)]
struct Lines {
    /// `None`, sent last, is the end.
    waiting: SyncSender<Option<String>>,
    if_full: Rc<Cell<IfFull>>,
    /// How often something was left out, where that is counted.
    lost: Rc<Cell<u64>>,
    /// Whether the reader is gone.
    gone: Rc<Cell<bool>>,
}

/// What happens to a line where the reader is too slow.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum IfFull {
    /// A state is left out; everything else waits.
    StatesAreLost,
    /// It waits.
    Waits,
    /// It is left out, whatever it is, and counted.
    IsLost,
}

impl Lines {
    /// Sends a line that is not repeated.
    fn say(&self, line: String) {
        self.send(line, self.if_full.get() == IfFull::IsLost);
    }

    /// Sends a state, which is repeated again and again.
    fn state(&self, line: String) {
        self.send(line, self.if_full.get() != IfFull::Waits);
    }

    fn send(&self, line: String, may_be_lost: bool) {
        let sent = if may_be_lost {
            self.waiting.try_send(Some(line))
        } else {
            self.waiting.send(Some(line)).map_err(|unsent| TrySendError::Disconnected(unsent.0))
        };
        match sent {
            Ok(()) => {}
            Err(TrySendError::Full(_)) if self.if_full.get() == IfFull::IsLost => self.lost.set(self.lost.get() + 1),
            Err(TrySendError::Full(_)) => {}
            Err(TrySendError::Disconnected(_)) => self.gone.set(true),
        }
    }
}

impl LineWriter {
    /// A writer to the standard output.
    pub(crate) fn standard() -> Self {
        Self::to(stdout(), IfFull::StatesAreLost)
    }

    /// A writer to a stream.
    pub(crate) fn to(stream: impl Write + Send + 'static, if_full: IfFull) -> Self {
        let (lines, waiting) = sync_channel::<Option<String>>(MAX_WAITING_LINES);
        let thread = std::thread::Builder::new().name("said".into());
        let writer = beside::spawn(thread, move || {
            let mut out = BufWriter::new(stream);
            while let Ok(Some(line)) = waiting.recv() {
                let mut next = Ok(Some(line));
                let mut written = Ok(());
                while let (Ok(Some(line)), Ok(())) = (&next, &written) {
                    written = out.write_all(line.as_bytes());
                    next = waiting.try_recv();
                }
                // The reader may be gone: then the orders end, too.
                if written.and_then(|()| out.flush()).is_err() || next == Ok(None) {
                    return;
                }
            }
        });
        let if_full = Rc::new(Cell::new(if_full));
        Self { lines: Lines { waiting: lines, if_full, lost: Rc::default(), gone: Rc::default() }, writer: writer.ok() }
    }

    /// Sets what happens from now on to lines where the reader is too slow.
    pub(super) fn if_full(&self, if_full: IfFull) {
        self.lines.if_full.set(if_full);
    }

    /// How often something was left out as no cycle was to wait.
    pub(super) fn lost(&self) -> u64 {
        self.lines.lost.get()
    }

    /// Whether the reader is gone.
    pub(super) fn is_gone(&self) -> bool {
        self.lines.gone.get()
    }

    /// An output that sends the messages of a program.
    pub(crate) fn messages(&self) -> Messages {
        Messages(self.lines.clone())
    }

    /// Sends the programs and robots.
    pub(super) fn hello(&self, controller: &Controller) {
        let channels = array(&controller.status().channels, runs);
        let name = |(signal, name): (_, &str)| format!("\"{signal}\":{}", quoted(name));
        let names: Vec<String> = controller.names().iter().map(name).collect();
        let names = names.join(",");
        self.lines.say(format!("{{\"hello\":{{\"channels\":{channels},\"names\":{{{names}}}}}}}\n"));
    }

    /// Sends the positions of the robots.
    pub(super) fn cycle(&self, controller: &Controller) {
        let mut line = String::new();
        push_cycle(&mut line, controller);
        self.lines.state(line);
    }

    /// Sends the state of the controller.
    pub(super) fn state(&self, controller: &Controller) {
        let mut line = String::with_capacity(1024);
        push_state(&mut line, controller, controller.last_time());
        self.lines.state(line);
    }

    /// Sends lines with states, and with positions of the robots.
    pub(super) fn states(&self, lines: String) {
        self.lines.state(lines);
    }

    /// Sends the inside of the program of a channel. It is left out where the reader is too slow.
    pub(super) fn inside(&self, channel: usize, fields: &str) {
        self.lines.state(format!("{{\"inside\":{{\"channel\":{channel},{fields}}}}}\n"));
    }

    /// Sends the warnings and alarms since the last call.
    pub(super) fn news(&self, controller: &mut Controller) {
        for text in controller.take_warnings() {
            self.warning(&text);
        }
        for alarm in controller.take_alarms() {
            // The alarm belongs to this state.
            self.state(controller);
            self.alarm(&alarm);
        }
    }

    /// Sends a warning.
    pub(crate) fn warning(&self, text: &str) {
        self.lines.say(warning_line(text));
    }

    /// Sends an alarm.
    pub(crate) fn alarm(&self, alarm: &Alarm) {
        self.lines.say(alarm_line(alarm));
    }

    /// Sends an object of the report, about a motion or a channel.
    pub(super) fn report(&self, object: &str) {
        self.lines.say(format!("{{\"report\":{object}}}\n"));
    }

    /// Sends the end, with how often something was left out.
    pub(super) fn ended(&self) {
        self.lines.say(format!("{{\"ended\":{}}}\n", self.lost()));
    }

    /// Reports an order that could not be carried out.
    pub(super) fn refused(&self, order: &str, why: &str) {
        self.lines.say(format!("{{\"refused\":{{\"order\":{},\"why\":{}}}}}\n", quoted(order), quoted(why)));
    }
}

impl Drop for LineWriter {
    fn drop(&mut self) {
        let _ = self.lines.waiting.send(None);
        if let Some(writer) = self.writer.take() {
            let _ = writer.join();
        }
    }
}

fn axis(axis: &Axis) -> String {
    let Axis { name, linear, min, max, .. } = axis;
    let unit = if *linear { "mm" } else { "deg" };
    format!("{{\"name\":{},\"unit\":\"{unit}\",\"min\":{},\"max\":{}}}", quoted(name), number(*min), number(*max))
}

/// The program and the robot of a channel; a background channel has no robot.
fn runs(status: &ChannelStatus) -> String {
    let program = quoted(status.program.name());
    let robot = status.robot.as_ref().map(|status| &*status.robot);
    let name = quoted(robot.map_or("", |robot| &robot.name));
    let axes = array(robot.map_or(&[][..], |robot| &robot.axes), axis);
    let links = robot.map_or_else(String::new, |robot| links(&robot.kinematics));
    let limbs = array(robot.map(|robot| robot.limbs()).unwrap_or_default(), |limb| shape(&limb));
    format!("{{\"program\":{program},\"robot\":{name},\"axes\":{axes}{links},\"limbs\":{limbs}}}")
}

/// A capsule of the robot: the link that it belongs to, its ends in that link's frame and its radius, in mm.
fn shape(limb: &Limb) -> String {
    let ends = array(limb.ends, |end| array(end, number));
    let name = quoted(limb.name);
    format!("{{\"name\":{name},\"link\":{},\"ends\":{ends},\"radius\":{}}}", limb.link, number(limb.radius))
}

/// The chain of the robot's links: the frame of each in that of the link before while its axis is at 0, and the
/// direction that it turns about or moves along; and the flange in the last link. A frame is x, y, z in mm and a
/// quaternion x, y, z, w.
fn links(kinematics: &Kinematics) -> String {
    let (joints, flange) = kinematics.links();
    let frame = |frame: &Frame| {
        let (at, turned) = (frame.translation.vector, frame.rotation.coords);
        array(at.iter().chain(&turned), |value| number(*value))
    };
    let joint = |joint: &LinkJoint| {
        let (origin, axis) = (frame(&joint.origin), array(joint.axis.iter(), |value| number(*value)));
        format!("{{\"origin\":{origin},\"axis\":{axis},\"linear\":{}}}", joint.linear)
    };
    format!(",\"links\":{},\"flange\":{}", array(&joints, joint), frame(&flange))
}

/// The positions of the axes of the robot, in deg (mm).
fn axes(status: &RobotStatus) -> Vec<f64> {
    let RobotStatus { robot, joints, .. } = status;
    let own = joints.axes.iter().take(robot.own_axes().len());
    own.chain(joints.external.iter().take(robot.external_axes().len())).copied().collect()
}

/// A line with a message.
pub(crate) fn message_line(message: &Message<'_>) -> String {
    let Message { time, hmi, console, text, channel } = *message;
    let text = quoted(&String::from_utf8_lossy(text));
    format!(
        "{{\"message\":{{\"time\":{},\"channel\":\"{channel}\",\"hmi\":{hmi},\"console\":{console},\"text\":{text}}}}}\n",
        number(time)
    )
}

/// A line with a warning.
pub(crate) fn warning_line(text: &str) -> String {
    format!("{{\"warning\":{}}}\n", quoted(text))
}

/// A line with an alarm.
pub(crate) fn alarm_line(alarm: &Alarm) -> String {
    let Alarm { fault, file, line, .. } = alarm;
    let (number, text, file) = (fault.number(), quoted(&alarm.to_string()), quoted(file.name()));
    format!("{{\"alarm\":{{\"number\":{number},\"text\":{text},\"file\":{file},\"line\":{line}}}}}\n")
}

/// Adds a line with the state of the controller at a time.
pub(crate) fn push_state(out: &mut String, controller: &Controller, time: f64) {
    let status = controller.status();
    out.push_str("{\"state\":{\"time\":");
    push_number(out, time);
    let _ = write!(out, ",\"mode\":\"{}\",\"override\":", status.mode.name());
    push_number(out, status.speed_override);
    out.push_str(",\"channels\":");
    push_array(out, &status.channels, push_channel);
    out.push_str(",\"di\":\"");
    push_levels(out, &status.di);
    out.push_str("\",\"do\":\"");
    push_levels(out, &status.dout);
    out.push_str("\",\"ai\":");
    push_array(out, status.ai.iter().copied(), push_number);
    out.push_str(",\"ao\":");
    push_array(out, status.ao.iter().copied(), push_number);
    out.push_str("}}\n");
}

/// Adds a line with the positions of the robots: of each channel the place of its motion, the base and the axes; with
/// the inputs and outputs, as these determine which bodies exist.
pub(super) fn push_cycle(out: &mut String, controller: &Controller) {
    out.push_str("{\"cycle\":{\"time\":");
    push_number(out, controller.last_time());
    out.push_str(",\"channels\":[");
    let mut first = true;
    controller.each_robot(|motion, base, own, external| {
        let (file, line) = motion.map_or(("", 0), |(file, line)| (file.name(), line));
        let comma = if first { "" } else { "," };
        let _ = write!(out, "{comma}{{\"file\":{},\"line\":{line},\"base\":", quoted(file));
        push_array(out, base.iter().copied(), push_number);
        out.push_str(",\"axes\":");
        push_array(out, own.iter().chain(external).copied(), push_number);
        out.push('}');
        first = false;
    });
    out.push_str("],\"di\":\"");
    controller.with_signals(|io| {
        push_levels(out, io.inputs().levels());
        out.push_str("\",\"do\":\"");
        push_levels(out, io.outputs().levels());
    });
    out.push_str("\"}}\n");
}

/// Adds levels as a row of digits.
fn push_levels(out: &mut String, levels: &[bool]) {
    out.extend(levels.iter().map(|on| if *on { '1' } else { '0' }));
}

fn push_channel(out: &mut String, status: &ChannelStatus) {
    let (robot, (file, line)) = (status.robot.as_ref(), status.place);
    let (motion_file, motion_line) = robot.and_then(|robot| robot.motion).unwrap_or((file, 0));
    let frame = |of: fn(&RobotStatus) -> &[f64; 6]| robot.map_or(&[][..], |robot| of(robot));
    let motion = robot.map_or(0, |robot| robot.motion_number);
    let (file, motion_file) = (quoted(file.name()), quoted(motion_file.name()));
    let _ = write!(
        out,
        "{{\"state\":\"{}\",\"file\":{file},\"line\":{line},\"motion_file\":{motion_file},\"motion_line\":{motion_line},\
         \"motion\":{motion},\"axes\":",
        word(status),
    );
    push_array(out, robot.map(axes).unwrap_or_default(), push_number);
    out.push_str(",\"tcp\":");
    push_array(out, frame(|robot| &robot.tcp).iter().copied(), push_number);
    out.push_str(",\"base\":");
    push_array(out, frame(|robot| &robot.base).iter().copied(), push_number);
    out.push_str(",\"workpiece\":");
    push_array(out, frame(|robot| &robot.workpiece).iter().copied(), push_number);
    out.push('}');
}

/// One word for the state of a channel.
fn word(status: &ChannelStatus) -> &'static str {
    match (status.state, &status.outcome) {
        (_, Some(Outcome::Ended)) => "ended",
        (_, Some(Outcome::Alarm(_))) => "alarm",
        (_, Some(Outcome::Stopped)) => "stopped",
        (_, Some(Outcome::Standstill(_))) => "standstill",
        (State::Paused, None) => "paused",
        (_, None) => "running",
    }
}

/// An output that sends the messages of a program.
pub(crate) struct Messages(Lines);

impl Output for Messages {
    fn message(&mut self, message: &Message<'_>) {
        self.0.say(message_line(message));
    }
}
