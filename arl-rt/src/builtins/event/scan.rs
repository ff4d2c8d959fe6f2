//! Evaluates the conditions of events once a cycle, before the program runs.

use std::rc::Rc;
use std::task::Poll;

use crate::context::cx::{Cx, Level};
use crate::context::events::{Code, DeclaredEvent, EventTable, Source};
use crate::fault::{Alarm, Fault, Reason, Stop};
use crate::motion::Progress;

/// The reason why it is unknown whether a condition holds.
pub(super) enum Unknown {
    /// An alarm in the condition.
    Alarm(Alarm),
    /// The condition takes longer than a cycle, or ends the program.
    Unfit(&'static str),
}

impl From<Stop> for Unknown {
    fn from(stop: Stop) -> Self {
        match stop.reason() {
            Reason::Alarm(alarm) => Unknown::Alarm(alarm),
            Reason::Exit | Reason::Restart => Unknown::Unfit("ends the program"),
        }
    }
}

impl Unknown {
    /// The fault of the condition of `event`.
    pub(super) fn fault(self, event: &str) -> Fault {
        match self {
            Unknown::Alarm(alarm) => Fault::Condition { event: event.into(), fault: Box::new(alarm.fault) },
            Unknown::Unfit(problem) => Fault::Event(format!("the condition of {event} {problem}").into()),
        }
    }

    fn alarm(self, event: &DeclaredEvent) -> Alarm {
        let (file, line) = match &self {
            Unknown::Alarm(alarm) => (alarm.file, alarm.line),
            Unknown::Unfit(_) => event.place,
        };
        Alarm::new(self.fault(&event.describe()), file, line)
    }
}

/// Evaluates whether a condition holds. It has the loop budget of a whole cycle for itself, waits for no motion, and
/// leaves the program pointer unchanged.
pub(super) fn evaluate(cx: &Cx, code: &dyn Code) -> Result<bool, Unknown> {
    let (pointer, level) = (cx.pointer(), cx.enter_level(Level::CONDITION));
    let budget = cx.renew_budget();
    let held = code.holds(cx);
    cx.restore_budget(budget);
    cx.leave_level(level);
    cx.point_to(pointer);
    match held {
        Poll::Ready(held) => Ok(held?),
        Poll::Pending => Err(Unknown::Unfit("takes longer than a cycle")),
    }
}

/// Checks all conditions and timers; records the events of this cycle.
///
/// # Errors
/// The alarm of a condition.
pub(crate) fn scan(cx: &Cx) -> Result<(), Alarm> {
    scan_interrupts(cx)?;
    scan_triggers(cx)
}

fn scan_interrupts(cx: &Cx) -> Result<(), Alarm> {
    let (now, rate) = (cx.cycle(), cx.shared().rate);
    for at in 0.. {
        let mut table = cx.events().borrow_mut();
        let Some(event) = table.interrupts.get_mut(at) else { break };
        let happens = match &mut event.source {
            Source::Time(ticking) => ticking.is_over(now, rate),
            Source::Motion { .. } => false,
            Source::Condition { held } => {
                let (number, held, code) = (event.number, *held, Rc::clone(&event.code));
                // A condition may call a function that declares or deletes interrupts.
                drop(table);
                let holds = evaluate(cx, &*code);
                table = cx.events().borrow_mut();
                let found = table.interrupts.get_mut(at).filter(|event| event.number == number);
                let Some(event) = found else { continue };
                let holds = holds.map_err(|unknown| unknown.alarm(event))?;
                event.source = Source::Condition { held: holds };
                holds && !held
            }
        };
        let EventTable { interrupts, due, .. } = &mut *table;
        if let Some(event) = interrupts.get_mut(at).filter(|event| happens && event.enabled) {
            event.happen(now, due);
        }
    }
    Ok(())
}

/// The stage of a trigger's motion.
enum Stage {
    /// The motion has not begun.
    Ahead,
    /// The motion may have begun, and others come in between.
    Aside,
    /// The motion is being executed.
    Executed,
    /// The motion is over, with its last progress; `None` if it was dropped, or if that progress has been checked.
    Over(Option<Progress>),
}

fn scan_triggers(cx: &Cx) -> Result<(), Alarm> {
    let now = cx.cycle();
    drop_done(&mut cx.events().borrow_mut());
    for at in 0.. {
        let table = cx.events().borrow();
        let Some(event) = table.triggers.get(at) else { break };
        let Source::Motion { number, held, over } = event.source else { continue };
        let stage = if over { Stage::Over(None) } else { stage(cx, number) };
        let (code, ordinal) = (Rc::clone(&event.code), event.number);
        drop(table);
        let holds = match stage {
            // The following triggers belong to later motions.
            Stage::Ahead => break,
            Stage::Aside => continue,
            Stage::Executed => evaluate(cx, &*code),
            Stage::Over(Some(end)) => cx.look_back(end, || evaluate(cx, &*code)),
            Stage::Over(None) => Ok(held),
        };
        let EventTable { triggers, due, .. } = &mut *cx.events().borrow_mut();
        let Some(event) = triggers.get_mut(at).filter(|event| event.number == ordinal) else { continue };
        let holds = holds.map_err(|unknown| unknown.alarm(event))?;
        event.source = Source::Motion { number, held: holds, over: matches!(stage, Stage::Over(_)) };
        if holds && !held {
            event.happen(now, due);
        }
    }
    drop_done(&mut cx.events().borrow_mut());
    Ok(())
}

fn stage(cx: &Cx, motion: u64) -> Stage {
    let Some(unit) = cx.channel_state().robot() else { return Stage::Over(None) };
    match unit.progress() {
        _ if unit.is_over(motion) => Stage::Over(unit.left(motion)),
        // The following triggers may belong to motions that come in between.
        _ if unit.is_aside() && unit.progress().is_none_or(|progress| progress.motion != motion) => Stage::Aside,
        Some(progress) if progress.motion == motion => Stage::Executed,
        _ => Stage::Ahead,
    }
}

/// Drops the triggers whose motion is over, unless their action is still to run.
fn drop_done(table: &mut EventTable) {
    let is_done =
        |event: &DeclaredEvent| event.arrived.is_none() && matches!(event.source, Source::Motion { over: true, .. });
    while table.triggers.front().is_some_and(is_done) {
        table.triggers.pop_front();
    }
}
