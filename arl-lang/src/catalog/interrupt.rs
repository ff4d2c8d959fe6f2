//! 6 and 7: interrupts, timers, triggers.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Form;
use crate::ast::Unit;

entries! { pub(super) INTERRUPT =
    /// Declares an interrupt: whenever the condition becomes true, the action runs.
    instr interrupt(
        name: string [optional] "a unique name, for enabling, disabling and deleting it",
        priority: int [otherwise("0"), range(0.0, 255.0)] "0 (first) to 255; 0 without it",
        when: bool [condition] "the event: false before, true now; it may not wait or move",
        do: any [action, rust("action")] "what is done, usually a call",
    )
        { "6.1", event::interrupt, acts, fails, form(Form::Event); "interrupt 1,when:getdi(6),do:setdo(1,true)\nwaittime 1" }
    /// Disables interrupts: they keep watching their conditions, but lose the events. Without arguments all of them.
    /// One that does not exist: alarm.
    instr disableint(
        name: string [optional] "the one with this name",
        priority: int [optional, range(0.0, 255.0)] "those of this priority",
    )
        { "6.5", event::disableint, acts, fails; "disableint" }
    /// Enables interrupts again. Without arguments all of them. One that does not exist: alarm.
    instr enableint(
        name: string [optional] "the one with this name",
        priority: int [optional, range(0.0, 255.0)] "those of this priority",
    )
        { "6.5", event::enableint, acts, fails; "enableint" }
    /// Deletes interrupts. Without arguments all of them. One that does not exist: alarm.
    instr delint(
        name: string [optional] "the one with this name",
        priority: int [optional, range(0.0, 255.0)] "those of this priority",
    )
        { "6.5", event::delint, acts, fails; "delint" }
    /// Declares an interrupt that time raises, once or again and again.
    instr timer(
        name: string [optional] "a unique name, for enabling, disabling and deleting it",
        priority: int [otherwise("0"), range(0.0, 255.0)] "0 (first) to 255; 0 without it",
        interval: double [units(&[Unit::Second]), at_least(0.0)] "the time, s; less than a cycle counts as a cycle; less than 0.001 with repetition: alarm",
        rmode: bool [otherwise("false")] "true: again and again; false: once",
        do: any [action, rust("action")] "what is done, usually a call",
    )
        { "6.7", event::timer, acts, fails, form(Form::Event);
          "timer name:\"t1\",priority:1,interval:1,rmode:true,do:setdo(1,true)\nwaittime 2" }
    /// Declares an event of the next motion: when the condition becomes true while it runs, the action is done.
    instr trigger(
        priority: int [otherwise("10"), range(0.0, 255.0)] "0 (first) to 255; 10 without it",
        when: bool [condition] "the event, usually T, S, StoEnd or P",
        do: any [action, rust("action")] "what is done",
    )
        { "7.1", event::trigger, acts, fails, foreground, form(Form::Event);
          "joint j = {0,-90,90,0,45,0}\ntrigger 1,when:T(0.5),do:setdo(2,true)\nmovej j,vp:20%" }
}
