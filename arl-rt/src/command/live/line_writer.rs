//! States, messages, warnings and alarms go out on the standard output, a JSON object a line.

use std::io::{Write, stdout};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::thread::JoinHandle;

use crate::command::json::{array, number, quoted};
use crate::context::output::{Message, Output};
use crate::controller::{ChannelStatus, Controller, Outcome, RobotStatus, State};
use crate::fault::Alarm;
use arl_robot::robot::Axis;

/// How many lines may wait to be written. Then states are left out, and everything else waits.
const MAX_WAITING_LINES: usize = 1024;

/// The standard output, written by a thread of its own, so that no cycle waits for it as long as somebody reads.
pub(crate) struct LineWriter {
    /// The last thing sent is nothing: the end.
    lines: SyncSender<Option<String>>,
    writer: Option<JoinHandle<()>>,
}

impl LineWriter {
    /// The standard output.
    pub(crate) fn standard() -> Self {
        let (lines, waiting) = sync_channel::<Option<String>>(MAX_WAITING_LINES);
        let writer = std::thread::spawn(move || {
            let mut out = stdout().lock();
            while let Ok(Some(line)) = waiting.recv() {
                // Nobody may read the other end any more: then the orders end, too.
                if out.write_all(line.as_bytes()).and_then(|()| out.flush()).is_err() {
                    return;
                }
            }
        });
        Self { lines, writer: Some(writer) }
    }

    /// Takes the messages of a program.
    pub(crate) fn messages(&self) -> Messages {
        Messages(self.lines.clone())
    }

    /// What runs on which robots.
    pub(super) fn hello(&self, controller: &Controller) {
        let channels = array(&controller.status().channels, runs);
        let name = |(signal, name): (_, &str)| format!("\"{signal}\":{}", quoted(name));
        let names: Vec<String> = controller.names().iter().map(name).collect();
        let names = names.join(",");
        self.say(format!("{{\"hello\":{{\"channels\":{channels},\"names\":{{{names}}}}}}}\n"));
    }

    /// How everything stands. It is left out where nobody reads as fast.
    pub(super) fn state(&self, controller: &Controller) {
        let status = controller.status();
        let levels = |levels: &[bool]| levels.iter().map(|on| if *on { '1' } else { '0' }).collect::<String>();
        let line = format!(
            "{{\"state\":{{\"time\":{},\"mode\":\"{}\",\"override\":{},\"channels\":{},\"di\":\"{}\",\"do\":\"{}\",\"ai\":{},\
             \"ao\":{}}}}}\n",
            number(status.time),
            status.mode.name(),
            number(status.speed_override),
            array(&status.channels, channel),
            levels(&status.di),
            levels(&status.dout),
            array(&status.ai, |value| number(*value)),
            array(&status.ao, |value| number(*value)),
        );
        let _ = self.lines.try_send(Some(line));
    }

    /// What is inside the program of a channel. It is left out where nobody reads as fast.
    pub(super) fn inside(&self, channel: usize, fields: &str) {
        let _ = self.lines.try_send(Some(format!("{{\"inside\":{{\"channel\":{channel},{fields}}}}}\n")));
    }

    /// Warnings and alarms since the last call.
    pub(super) fn news(&self, controller: &mut Controller) {
        for text in controller.take_warnings() {
            self.say(format!("{{\"warning\":{}}}\n", quoted(&text)));
        }
        for alarm in controller.take_alarms() {
            let Alarm { fault, file, line, .. } = &alarm;
            let (number, text, file) = (fault.number(), quoted(&alarm.to_string()), quoted(file.name()));
            self.say(format!(
                "{{\"alarm\":{{\"number\":{number},\"text\":{text},\"file\":{file},\"line\":{line}}}}}\n"
            ));
        }
    }

    /// An order that could not be carried out.
    pub(super) fn refused(&self, order: &str, why: &str) {
        self.say(format!("{{\"refused\":{{\"order\":{},\"why\":{}}}}}\n", quoted(order), quoted(why)));
    }

    fn say(&self, line: String) {
        let _ = self.lines.send(Some(line));
    }
}

impl Drop for LineWriter {
    fn drop(&mut self) {
        let _ = self.lines.send(None);
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

/// What a channel runs on which robot; in the background there is none.
fn runs(status: &ChannelStatus) -> String {
    let program = quoted(status.program.name());
    let robot = status.robot.as_ref().map(|status| &*status.robot);
    let name = quoted(robot.map_or("", |robot| &robot.name));
    let axes = array(robot.map_or(&[][..], |robot| &robot.axes), axis);
    format!("{{\"program\":{program},\"robot\":{name},\"axes\":{axes}}}")
}

/// The axes that there are, in deg (mm).
fn axes(status: &RobotStatus) -> Vec<f64> {
    let RobotStatus { robot, joints, .. } = status;
    let own = joints.axes.iter().take(robot.own_axes().len());
    own.chain(joints.external.iter().take(robot.external_axes().len())).copied().collect()
}

fn channel(status: &ChannelStatus) -> String {
    let (robot, (file, line)) = (status.robot.as_ref(), status.place);
    let (motion_file, motion_line) = robot.and_then(|robot| robot.motion).unwrap_or((file, 0));
    let tcp = robot.map_or(&[][..], |robot| &robot.tcp);
    format!(
        "{{\"state\":\"{}\",\"file\":{},\"line\":{line},\"motion_file\":{},\"motion_line\":{motion_line},\"axes\":{},\"tcp\":{}}}",
        word(status),
        quoted(file.name()),
        quoted(motion_file.name()),
        array(&robot.map(axes).unwrap_or_default(), |axis| number(*axis)),
        array(tcp, |component| number(*component)),
    )
}

/// One word for what a channel does.
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

/// Takes the messages of a program.
pub(crate) struct Messages(SyncSender<Option<String>>);

impl Output for Messages {
    fn message(&mut self, message: &Message<'_>) {
        let Message { time, hmi, console, text, channel: _ } = *message;
        let text = quoted(&String::from_utf8_lossy(text));
        let line = format!(
            "{{\"message\":{{\"time\":{},\"hmi\":{hmi},\"console\":{console},\"text\":{text}}}}}\n",
            number(time)
        );
        let _ = self.0.send(Some(line));
    }
}
