//! 3.4: the course of the program.

use super::declare::{base, entries, folded, kind, param_type};
use super::facts::Form;
use crate::ast::Unit;

entries! { pub(super) CONTROL =
    /// Waits until the robot stands still, then for a time. A negative time: alarm.
    instr waittime(time: double [units(&[Unit::Second]), at_least(0.0), delays()] "how long, s")
        { "3.4.1", flow::waittime, waits, fails; "waittime 0.5" }
    /// Waits until the robot stands still, then until a condition holds or a time has passed.
    instr waituntil(
        cond: bool [condition] "what is waited for, evaluated in every cycle",
        maxtime: double [optional, units(&[Unit::Second]), at_least(0.0), limits()] "longest wait, s; forever without it",
        timeoutflag: bool [optional, out] "gets true if the time ran out first, false if the condition held",
    )
        { "3.4.2", flow::waituntil, waits, fails, form(Form::WaitUntil); "bool late\nwaituntil getdi(6),maxtime:0.5,timeoutflag:late\nprint late" }
    /// Pauses the program when all motion so far has run; the pendant or the external control continues it.
    instr pause()
        { "3.4.3", flow::pause, waits, fails; "pause" }
    /// Ends the program, from any function, when all motion so far has run.
    instr exit()
        { "3.4.4", flow::exit, ends, form(Form::Exit); "if(getdi(6))\nexit\nendif" }
    /// Starts main again when all motion so far has run. Global and system variables keep their values.
    instr restart()
        { "3.4.5", flow::restart, ends, form(Form::Restart); "$I[0]++\nif($I[0] < 3) restart\nprint $I[0]" }
    /// Stops the motion on its path; as a rule in an interrupt's function, with startmove.
    instr stopmove(type: stoptype [otherwise("general"), rust("stop")] "how it brakes; general without it")
        { "3.4.6", event::stopmove, acts, fails, foreground, halts; "stopmove fast\nstartmove" }
    /// Continues the motion that stopmove stopped: back to where it stopped and on, or to a later target.
    instr startmove(skip: {int, bool} [optional] "how many motions are dropped, from the stopped one on; 0 without it")
        { "3.4.7", event::startmove, acts, fails, foreground; "stopmove\nstartmove 1" }
}
