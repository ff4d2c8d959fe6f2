//! Answers to a debugger: running functions, variables, signals, robots.

use std::rc::Rc;

use super::functions;
use super::link::DebugRequest;
use crate::command::json::{array, number, quoted};
use crate::context::cx::{Cx, Level};
use crate::context::frames::Record;
use crate::context::shown::Shown;
use crate::fault::{Fault, File};
use crate::io::Digital;
use crate::values::{Onto, Teach, teach_text};

/// The fields of the answer to a request.
///
/// # Errors
/// The request cannot be carried out; the reason.
pub(super) fn answer(request: &DebugRequest, contexts: &[Rc<Cx>]) -> Result<String, String> {
    let first = || contexts.first().ok_or("there is no channel");
    let cx = || {
        let at = request.whole(0) as usize;
        contexts.get(at).ok_or_else(|| format!("there is no channel {at}"))
    };
    match request.word.as_str() {
        "stack" => cx().map(|cx| stack(cx, &cx.frames().all())),
        "variables" => cx().and_then(|cx| Ok(of_record(cx, &record(cx, request.whole(1))?, Detail::Whole))),
        "globals" => Ok(globals(cx()?, Detail::Whole)),
        "system" => Ok(system(cx()?)),
        "signals" => Ok(signals(first()?)),
        "robot" => Ok(robot(cx()?)),
        "call" => {
            let (ty, value) = functions::call(cx()?, request.value(1), request.values.get(2..).unwrap_or_default())?;
            Ok(format!("\"type\":{},\"value\":{}", quoted(&ty), quoted(&value)))
        }
        "pointer" => set_pointer(cx()?, request.whole(1), request.whole(2)),
        "set" => set(cx()?, request.whole(1), request.value(2), request.value(3)),
        "set-global" => set_global(cx()?, request.value(1), request.value(2), request.value(3)),
        "set-system" => set_system(cx()?, request.value(1), request.value(2)),
        "set-signal" => set_signal(first()?, request.value(0), request.value(1), request.value(2)),
        other => Err(format!("there is no request `{other}`")),
    }
}

/// Whether a request changes something in the run.
pub(super) fn changes(request: &DebugRequest) -> bool {
    matches!(request.word.as_str(), "pointer" | "set" | "set-global" | "set-system" | "set-signal")
}

/// The channels, each with its name and its program.
pub(super) fn channels(contexts: &[Rc<Cx>]) -> String {
    array(contexts, |cx| {
        let name = cx.channel_state().id.to_string();
        format!("{{\"name\":{},{}}}", quoted(&name), program(cx))
    })
}

/// The running number of the motion that is executed; 0 for none.
pub(super) fn motion(cx: &Cx) -> u64 {
    cx.channel_state().robot().map_or(0, |unit| unit.executing().1)
}

/// The motion that is being executed, and the fields that report it.
pub(super) fn motion_pointer(cx: &Cx) -> (u64, String) {
    let place = cx.channel_state().robot().and_then(|unit| unit.motion_pointer());
    let number = motion(cx);
    let (file, line) = place.filter(|_| number > 0).unwrap_or((File::new(""), 0));
    (number, format!("\"motion\":{number},{},\"file\":{},\"line\":{line}", program(cx), quoted(file.name())))
}

/// The running functions, the one entered last at the front.
fn stack(cx: &Cx, frames: &[Record]) -> String {
    let shown = array(frames.iter().rev(), |frame| {
        format!(
            "{{\"id\":{},\"name\":{},\"file\":{},\"line\":{},\"event\":{}}}",
            frame.id,
            quoted(&frame.name),
            quoted(frame.file.name()),
            frame.line,
            frame.is_action,
        )
    });
    let program = program(cx);
    format!("{program},\"frames\":{shown}")
}

/// Functions, locals of the innermost one, and global variables of a channel, for a client that only observes.
pub(super) fn inside(cx: &Cx) -> String {
    let frames = cx.frames().innermost(BRIEF_LISTED);
    let top = frames.iter().rev().find(|frame| !frame.is_action);
    let locals = top.map_or_else(|| "\"variables\":[]".into(), |frame| of_record(cx, frame, Detail::Brief));
    format!("{},{locals},{}", stack(cx, &frames), globals(cx, Detail::Brief))
}

/// The fields with the program of a channel: its main file, and the folder of its files, relative to the script
/// directory.
fn program(cx: &Cx) -> String {
    let folder = cx.program_itself().folder().display().to_string();
    format!("\"program\":{},\"folder\":{}", quoted(cx.program().name()), quoted(&folder))
}

/// How much of a value is reported.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Detail {
    Whole,
    /// Long arrays and the ends of long lists are left out: no cycle should wait for them.
    Brief,
}

impl Detail {
    /// How many elements of a list are reported.
    fn most(self) -> usize {
        match self {
            Self::Whole => usize::MAX,
            Self::Brief => BRIEF_LISTED,
        }
    }
}

/// The most functions, variables and files that are reported in brief.
const BRIEF_LISTED: usize = 100;

/// The most elements of an array that is reported in brief.
const BRIEF_ELEMENTS: usize = 64;

fn shown(name: &str, sizes: &[usize], variable: &dyn Teach, detail: Detail) -> String {
    variable_json(name, type_name(sizes, variable.type_name()), detail, || variable.written())
}

fn shown_handle(cx: &Cx, name: &str, sizes: &[usize], handle: &dyn Shown, detail: Detail) -> String {
    variable_json(name, type_name(sizes, handle.type_name()), detail, || handle.shown(cx))
}

/// A variable as an object.
fn variable_json(name: &str, ty: String, detail: Detail, value: impl FnOnce() -> String) -> String {
    let value = if is_omitted(&ty, detail) { "..".into() } else { value() };
    format!("{{\"name\":{},\"type\":{},\"value\":{}}}", quoted(name), quoted(&ty), quoted(&value))
}

/// Whether a value of this type is too long.
fn is_omitted(ty: &str, detail: Detail) -> bool {
    let sizes = ty.split('[').skip(1).filter_map(|size| size.trim_end_matches(']').parse::<usize>().ok());
    detail == Detail::Brief && sizes.product::<usize>() > BRIEF_ELEMENTS
}

/// The type with all dimensions, like `int[2][3]`: a variable knows its elements as one row only.
fn type_name(sizes: &[usize], flat: String) -> String {
    match flat.split_once('[') {
        Some((base, _)) if !sizes.is_empty() => {
            base.to_owned() + &sizes.iter().map(|size| format!("[{size}]")).collect::<String>()
        }
        _ => flat,
    }
}

/// A running function.
fn record(cx: &Cx, frame: u64) -> Result<Record, String> {
    cx.frames().all().into_iter().find(|record| record.id == frame).ok_or_else(|| "the function has ended".into())
}

/// The variables of a function.
fn of_record(cx: &Cx, record: &Record, detail: Detail) -> String {
    let (variables, handles) = (record.variables(), record.handles());
    let variables = array(variables.iter().take(detail.most()), |it| shown(it.name, it.sizes, &*it.slot, detail));
    let handles = handles.iter().take(detail.most());
    let handles = array(handles, |it| shown_handle(cx, it.name, it.sizes, &*it.slot, detail));
    format!("\"variables\":{variables},\"handles\":{handles}")
}

fn globals(cx: &Cx, detail: Detail) -> String {
    let program = cx.program_itself();
    let handles = program.handles();
    let files = array(program.variables().into_iter().take(detail.most()), |file| {
        let all = file.vars.iter().take(detail.most());
        let all = array(all, |variable| shown(variable.name, variable.sizes, variable.slot, detail));
        let own = handles.iter().filter(|handle| handle.file == file.file).take(detail.most());
        let handles = array(own, |handle| shown_handle(cx, handle.name, handle.sizes, handle.slot, detail));
        format!("{{\"file\":{},\"variables\":{all},\"handles\":{handles}}}", quoted(file.file))
    });
    format!("\"files\":{files}")
}

fn system(cx: &Cx) -> String {
    let all = array(cx.system().shown(), |(name, variable)| shown(&format!("${name}"), &[], variable, Detail::Whole));
    format!("\"variables\":{all}")
}

fn signals(cx: &Cx) -> String {
    let io = cx.shared().io.borrow();
    let levels = |levels: &[bool]| levels.iter().map(|on| if *on { '1' } else { '0' }).collect::<String>();
    format!(
        "\"di\":\"{}\",\"do\":\"{}\",\"ai\":{},\"ao\":{}",
        levels(io.inputs().levels()),
        levels(io.outputs().levels()),
        array(io.analogs(false), |value| number(*value)),
        array(io.analogs(true), |value| number(*value)),
    )
}

/// Axes in deg (mm), the TCP in mm and deg, the motion that is executed; empty for a background channel.
fn robot(cx: &Cx) -> String {
    let (_, pointer) = motion_pointer(cx);
    let Some(unit) = cx.channel_state().robot() else { return format!("\"axes\":[],\"tcp\":[],{pointer}") };
    let (robot, at) = (unit.robot(), unit.setpoint());
    let own = robot.own_axes().iter().zip(&at.axes);
    let axes: Vec<_> = own.chain(robot.external_axes().iter().zip(&at.external)).collect();
    let axes = array(axes, |(axis, value)| {
        let unit = if axis.linear { "mm" } else { "deg" };
        format!("{{\"name\":{},\"unit\":\"{unit}\",\"value\":{}}}", quoted(&axis.name), number(*value))
    });
    format!("\"axes\":{axes},\"tcp\":{},{pointer}", array(unit.commanded_tcp(), number))
}

/// Gives a variable a value.
fn teach(variable: &dyn Teach, sizes: &[usize], literal: &str) -> Result<String, String> {
    teach_text(variable, Onto::Start, sizes, literal)?;
    Ok(format!("\"value\":{}", quoted(&variable.written())))
}

/// Sets the program pointer to a line of a running function: it goes on there.
fn set_pointer(cx: &Cx, frame: u64, line: u64) -> Result<String, String> {
    if cx.level().number == Level::CONDITION.number {
        return Err("the condition of an event is being checked: step out of it first".into());
    }
    let line = u32::try_from(line).ok().filter(|line| *line > 0).ok_or("there is no such line")?;
    cx.frames().set_pointer(frame, line)?;
    Ok("\"done\":true".into())
}

fn set(cx: &Cx, frame: u64, name: &str, literal: &str) -> Result<String, String> {
    let all = record(cx, frame)?.variables();
    let variable = all.iter().find(|known| known.name == name).ok_or_else(|| missing(name))?;
    teach(&*variable.slot, variable.sizes, literal)
}

fn set_global(cx: &Cx, file: &str, name: &str, literal: &str) -> Result<String, String> {
    let files = cx.program_itself().variables();
    let found = files.iter().filter(|known| known.file == file).flat_map(|file| &file.vars);
    let variable = found.into_iter().find(|known| known.name.eq_ignore_ascii_case(name));
    let variable = variable.ok_or_else(|| missing(name))?;
    teach(variable.slot, variable.sizes, literal)
}

fn set_system(cx: &Cx, name: &str, literal: &str) -> Result<String, String> {
    let all = cx.system().shown();
    let found = all.into_iter().find(|(known, _)| known.eq_ignore_ascii_case(name.trim_start_matches('$')));
    let (_, variable) = found.ok_or_else(|| missing(name))?;
    teach(variable, &[], literal)
}

fn missing(name: &str) -> String {
    format!("there is no variable `{name}` that can be set")
}

fn set_signal(cx: &Cx, kind: &str, channel: &str, value: &str) -> Result<String, String> {
    let channel: i32 =
        channel.parse().map_err(|_| format!("`{channel}` is not a signal number: signals count from 1"))?;
    let level = || match value {
        "true" | "1" => Ok(true),
        "false" | "0" => Ok(false),
        _ => Err(format!("`{value}` is not a level: expected true or false")),
    };
    let amount =
        || value.parse::<f64>().map_err(|_| format!("`{value}` is not a signal value: expected a number, in V or mA"));
    let mut io = cx.shared().io.borrow_mut();
    let set: Result<(), Fault> = match kind {
        "di" => io.set_digital(Digital::Di, channel, level()?),
        "do" => io.set_digital(Digital::Do, channel, level()?),
        "ai" => io.set_analog_input(channel, amount()?),
        "ao" => io.set_analog_output(channel, amount()?),
        _ => return Err(format!("there are no signals `{kind}`: expected di, do, ai or ao")),
    };
    set.map_err(|fault| fault.to_string())?;
    Ok(format!("\"value\":{}", quoted(value)))
}
