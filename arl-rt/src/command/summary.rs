//! What came of a run, as one JSON object.

use std::fmt::Write;

use crate::command::json::{number, push_array, quoted};
use crate::command::report;
use crate::controller::Controller;
use crate::fault::Alarm;
use crate::motion::MotionRecord;

/// How a run ended, or that it has not.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Ending {
    /// It goes on.
    Runs,
    /// The program ended.
    Ended,
    /// An alarm ended it.
    Alarm,
    /// Its time was over.
    TimeOver,
    /// Nothing could change any more.
    Stuck,
    /// Somebody stopped it.
    Stopped,
}

impl Ending {
    fn word(self) -> &'static str {
        match self {
            Ending::Runs => "runs",
            Ending::Ended => "ended",
            Ending::Alarm => "alarm",
            Ending::TimeOver => "time_over",
            Ending::Stuck => "stuck",
            Ending::Stopped => "stopped",
        }
    }
}

/// A JSON object without newline: the ending, the exit code, the time in s, what the first robot's motions were together, and the alarms.
/// The figures of motions are there where the controller records them.
pub(crate) fn summary(controller: &Controller, (ending, code): (Ending, Option<u8>), alarms: &[Alarm]) -> String {
    let mut text = String::new();
    let code = code.map_or("null".to_owned(), |code| code.to_string());
    let time = controller.time();
    let _ = write!(text, "{{\"outcome\":\"{}\",\"code\":{code},\"cycle_time\":{}", ending.word(), number(time));
    let _ = write!(text, ",\"real_time\":{}", controller.is_real());
    let mut of_first = None;
    controller.each_record(|_, records, _| {
        of_first.get_or_insert_with(|| figures(records, time));
    });
    text.push_str(&of_first.unwrap_or_default());
    text.push_str(",\"alarms\":");
    push_array(&mut text, alarms, push_alarm);
    text.push('}');
    text
}

fn figures(records: &[MotionRecord], time: f64) -> String {
    let executed = || report::executed(records);
    let moving: f64 = executed().map(|record| record.duration).sum();
    let way: f64 = executed().map(|record| record.way).sum();
    format!(
        ",\"moving\":{},\"standing\":{},\"motions\":{},\"way\":{}",
        number(moving),
        number((time - moving).max(0.0)),
        executed().count(),
        number(way)
    )
}

fn push_alarm(text: &mut String, alarm: &Alarm) {
    let (channel, said, file) = (alarm.channel, quoted(&alarm.to_string()), quoted(alarm.file.name()));
    let (number, line) = (alarm.fault.number(), alarm.line);
    let _ = write!(
        text,
        "{{\"number\":{number},\"text\":{said},\"file\":{file},\"line\":{line},\"channel\":\"{channel}\"}}"
    );
}
