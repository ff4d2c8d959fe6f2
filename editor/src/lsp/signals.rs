//! The cell's names of the signals that a program refers to by their numbers.

use super::places::File;
use arl_lang::catalog::Space;
use arl_robot::cell::{Signal, SignalKind};
use arl2rs::index::{Argument, Callee};

/// The signal that an argument refers to, if it is a plain number, and its name in the cell.
pub(super) fn named<'a>(file: &'a File, argument: &Argument) -> Option<(Signal, &'a str)> {
    let Callee::Builtin(entry) = argument.callee else { return None };
    let kind = match entry.params.get(argument.parameter)?.addresses? {
        Space::DigitalInput => SignalKind::DigitalInput,
        Space::DigitalOutput => SignalKind::DigitalOutput,
        Space::AnalogInput => SignalKind::AnalogInput,
        Space::AnalogOutput => SignalKind::AnalogOutput,
        _ => return None,
    };
    let signal = Signal { kind, channel: file.program.at(argument.at).trim().parse().ok()? };
    Some((signal, file.program.names.of(signal)?))
}

/// The argument at an offset, the innermost of nested ones.
pub(super) fn argument_at(file: &File, offset: u32) -> Option<&Argument> {
    let contains_offset = |one: &&Argument| (one.at.span.start..=one.at.span.end).contains(&offset);
    file.index().arguments(file.id).filter(contains_offset).min_by_key(|one| one.at.span.end - one.at.span.start)
}
