//! The result of a run, as one JSON object.

use std::fmt::Write;

use crate::command::ending::Ending;
use crate::command::json::{number, push_array, quoted};
use crate::command::report;
use crate::controller::{Controller, Outcome};
use crate::fault::Alarm;
use crate::motion::MotionRecord;

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
