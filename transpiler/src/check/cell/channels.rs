//! I/O channels and program channels that the cell does not have, as far as their numbers are constant.

use super::{addressed, constant, constant_int, related};
use crate::diagnostics::channels::ChannelProblem;
use crate::hir::Builtin;
use arl_lang::catalog::{Relation, Space};
use arl_lang::span::Span;
use arl_robot::channels::Channels;

/// The maximum number of channels that one call may name.
const MOST_AT_ONCE: i64 = 32;

/// The name of the channels of a space in messages, and how many of them a cell has; `None` for anything but I/O
/// channels.
fn io(space: Space, cell: &Channels) -> Option<(&'static str, usize)> {
    match space {
        Space::DigitalInput => Some(("DI", cell.di as usize)),
        Space::DigitalOutput => Some(("DO", cell.dout as usize)),
        Space::AnalogInput => Some(("AI", cell.ai.len())),
        Space::AnalogOutput => Some(("AO", cell.ao.len())),
        Space::InternalSignal => Some(("internal signal", cell.internal as usize)),
        Space::ForegroundChannel
        | Space::ModbusRegister
        | Space::ModbusCoil
        | Space::SlaveByte
        | Space::MelsecRegister
        | Space::DeviceNetByte
        | Space::SerialLine => None,
    }
}

/// A foreground channel in a call that does not exist in a cell with `count` of them, and its position.
pub(super) fn no_foreground(builtin: &Builtin, count: u32) -> Option<(Span, ChannelProblem)> {
    let (_, expr) = addressed(builtin).find(|(space, _)| *space == Space::ForegroundChannel)?;
    let (channel, span) = constant_int(expr)?;
    let exists = (1..=i64::from(count)).contains(&i64::from(channel));
    (!exists).then_some((span, ChannelProblem::NoForeground { channel, count }))
}

/// The problem with the I/O channels of a call, and its position.
pub(super) fn problem(builtin: &Builtin, cell: &Channels) -> Option<(Span, ChannelProblem)> {
    let space = builtin.entry.space()?;
    let (kind, count) = io(space, cell)?;
    let count = count as u32;
    let channels: Vec<(i32, Span)> = addressed(builtin).filter_map(|(_, expr)| constant_int(expr)).collect();
    let missing = channels.iter().find(|(channel, _)| !(1..=i64::from(count)).contains(&i64::from(*channel)));
    if let Some((channel, span)) = missing {
        return Some((*span, ChannelProblem::Missing { kind, channel: *channel, count }));
    }
    if let [(from, _), (to, span)] = *channels.as_slice() {
        return match i64::from(to) - i64::from(from) {
            ..0 => Some((span, ChannelProblem::Reversed { kind, from, to })),
            MOST_AT_ONCE.. => Some((span, ChannelProblem::TooMany { kind, from, to })),
            _ => None,
        };
    }
    let (channel, _) = *channels.first().filter(|_| space == Space::AnalogOutput)?;
    let ty = *cell.ao.get(usize::try_from(channel).ok()?.checked_sub(1)?)?;
    let (_, content) = related(builtin, |relation| relation == Relation::Content)?;
    let (value, span) = constant(content)?;
    let (low, high) = ty.range();
    (!(low..=high).contains(&value)).then_some((span, ChannelProblem::Value { channel, value, ty }))
}
