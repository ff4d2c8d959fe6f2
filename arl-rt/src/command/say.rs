//! Reports the events of a run on the standard error: warnings, and alarms with the lines of the program that they are
//! about.

use std::path::Path;
use std::sync::OnceLock;
use std::time::SystemTime;

use crate::command::asked;
use crate::command::live::Recording;
use crate::context::standard_error::tell;
use crate::context::standstill::Standstill;
use crate::controller::Controller;
use crate::fault::File;
use arl_robot::cell::{Signal, SignalKind};

/// Source lines are not shown from files larger than this, in bytes.
const LARGEST_FILE: u64 = 16 << 20;

/// Reports something that does not stop a run.
pub(super) fn warn(text: &str) {
    tell(format_args!("warning: {text}"));
}

/// Reports the new warnings and alarms on the standard error, and to the recorder; `sources` is the folder that
/// programs were compiled from.
pub(super) fn say(controller: &mut Controller, sources: &Path, recorder: Option<&Recording>) {
    for text in controller.take_warnings() {
        tell(format_args!("warning: {text}"));
        if let Some(recorder) = recorder {
            recorder.warning(controller, &text);
        }
    }
    for alarm in controller.take_alarms() {
        if let Some(recorder) = recorder {
            recorder.alarm(controller, &alarm);
        }
        let contexts = controller.contexts();
        let of_alarm = contexts.iter().find(|cx| cx.channel_state().id == alarm.channel);
        let folder = of_alarm.map(|cx| sources.join(cx.program_itself().folder())).unwrap_or_default();
        let tell_line = |file: File, line| {
            // In real time other robots may still move: then no cycle waits for a file.
            if !controller.is_real()
                && let Some(line) = source_line(&folder.join(file.name()), line)
            {
                tell(format_args!("{line}"));
            }
        };
        tell(format_args!("{alarm}"));
        tell_line(alarm.file, alarm.line);
        for &(file, line) in &alarm.calls.places {
            tell(format_args!("called in {}:{line}", file.name()));
            tell_line(file, line);
        }
        if alarm.calls.more > 0 {
            tell(format_args!("and {} more calls", alarm.calls.more));
        }
    }
}

/// The line that waits in vain, and the values of the signals that it reads.
pub(super) fn say_condition(controller: &Controller, sources: &Path, waiting: &Standstill) -> Vec<String> {
    let contexts = controller.contexts();
    let Some(cx) = contexts.iter().find(|cx| cx.channel_state().id == waiting.channel) else { return Vec::new() };
    let file = sources.join(cx.program_itself().folder()).join(waiting.file.name());
    let Some((text, line)) = source(&file).zip(source_line(&file, waiting.line)) else { return Vec::new() };
    let code = line.split_once('|').map_or(line.as_str(), |(_, code)| code);
    let io = cx.shared().io.borrow();
    let level = |on: Option<bool>| on.map(|on| String::from(if on { "on" } else { "off" }));
    let value = |signal: Signal| {
        let at = usize::try_from(signal.channel.checked_sub(1)?).ok()?;
        match signal.kind {
            SignalKind::DigitalInput => level(io.inputs().levels().get(at).copied()),
            SignalKind::DigitalOutput => level(io.outputs().levels().get(at).copied()),
            SignalKind::AnalogInput => io.analogs(false).get(at).map(f64::to_string),
            SignalKind::AnalogOutput => io.analogs(true).get(at).map(f64::to_string),
            SignalKind::InternalInput | SignalKind::InternalOutput => None,
        }
    };
    let signals = asked::signals(code, &text);
    let lines = signals
        .into_iter()
        .map(|signal| format!("  {}", asked::signal_text(signal, controller.names(), value(signal))));
    std::iter::once(line.clone()).chain(lines).collect()
}

/// When the program was made, if it is not the executable of this process.
static MADE: OnceLock<SystemTime> = OnceLock::new();

/// Sets when the program was made: lines of files that are newer are not shown.
pub(super) fn made_at(time: SystemTime) {
    let _ = MADE.set(time);
}

/// The text of a file, unless it was changed since the program was compiled.
fn source(file: &Path) -> Option<String> {
    let about = file.metadata().ok().filter(|about| about.is_file() && about.len() <= LARGEST_FILE)?;
    let compiled = match MADE.get() {
        Some(made) => *made,
        None => std::env::current_exe().ok()?.metadata().ok()?.modified().ok()?,
    };
    if about.modified().ok()? > compiled {
        return None;
    }
    let bytes = std::fs::read(file).ok()?;
    arl_lang::text::decode(&bytes).ok().map(std::borrow::Cow::into_owned)
}

/// The line of a file, as it is shown below an alarm: its number and its text. `None` where the file does not exist any
/// more, or was changed after the program was compiled.
fn source_line(file: &Path, line: u32) -> Option<String> {
    let text = source(file)?;
    let found = text.lines().nth((line as usize).checked_sub(1)?)?.trim();
    (!found.is_empty()).then(|| format!("  {line} | {found}"))
}
