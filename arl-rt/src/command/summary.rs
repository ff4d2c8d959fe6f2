//! The result of a run, as one JSON object.

use std::fmt::Write;

use crate::command::json::{number, push_array, quoted};
use crate::command::program_main::{EXIT_ALARM, EXIT_ENDED, EXIT_INTERRUPTED, EXIT_MAX_TIME};
use crate::command::report;
use crate::controller::{Controller, Outcome};
use crate::fault::Alarm;
use crate::motion::MotionRecord;

/// How a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Ending {
    /// The program ended.
    Ended,
    /// An alarm ended it.
    Alarm,
    /// Its time limit was reached.
    TimeOver,
    /// Nothing could change any more.
    Stuck,
    /// It was stopped from outside.
    Stopped,
}

impl Ending {
    fn word(self) -> &'static str {
        match self {
            Ending::Ended => "ended",
            Ending::Alarm => "alarm",
            Ending::TimeOver => "time_over",
            Ending::Stuck => "stuck",
            Ending::Stopped => "stopped",
        }
    }

    /// The exit code of a command whose run ended like this.
    pub(crate) fn code(self) -> u8 {
        match self {
            Ending::Ended => EXIT_ENDED,
            Ending::Alarm => EXIT_ALARM,
            Ending::TimeOver | Ending::Stuck => EXIT_MAX_TIME,
            Ending::Stopped => EXIT_INTERRUPTED,
        }
    }
}

/// A JSON object without newline: the ending, the exit code, the time in s, the totals of the first robot's motions,
/// the alarms, and the alarm that ended the run, or null. The totals are 0 where the controller does not record
/// motions.
pub(crate) fn summary(controller: &Controller, ending: Option<Ending>, alarms: &[Alarm]) -> String {
    let mut text = String::new();
    let outcome = ending.map_or("runs", Ending::word);
    let code = ending.map_or("null".to_owned(), |ending| ending.code().to_string());
    let time = controller.time();
    let _ = write!(text, "{{\"outcome\":\"{outcome}\",\"code\":{code},\"cycle_time\":{}", number(time));
    let _ = write!(text, ",\"real_time\":{}", controller.is_real());
    let mut of_first = None;
    controller.each_unit(|unit| {
        of_first.get_or_insert_with(|| figures(unit.records(), time));
    });
    text.push_str(&of_first.unwrap_or_default());
    text.push_str(",\"alarms\":");
    push_array(&mut text, alarms, push_alarm);
    text.push_str(",\"ended_by\":");
    match controller.outcome().filter(|_| ending == Some(Ending::Alarm)) {
        Some(Outcome::Alarm(alarm)) => push_alarm(&mut text, alarm),
        _ => text.push_str("null"),
    }
    text.push('}');
    text
}

fn figures(records: &[MotionRecord], time: f64) -> String {
    let moving = report::sum(records, |record| record.duration);
    let distance = report::sum(records, |record| record.path_length);
    format!(
        ",\"moving\":{},\"standing\":{},\"motions\":{},\"way\":{}",
        number(moving),
        number((time - moving).max(0.0)),
        report::executed(records).count(),
        number(distance)
    )
}

fn push_alarm(text: &mut String, alarm: &Alarm) {
    let (channel, message, file) = (alarm.channel, quoted(&alarm.to_string()), quoted(alarm.file.name()));
    let (number, line) = (alarm.fault.number(), alarm.line);
    let _ = write!(
        text,
        "{{\"number\":{number},\"text\":{message},\"file\":{file},\"line\":{line},\"channel\":\"{channel}\"}}"
    );
}
