//! Channels that a certain cell does not have, of io and those of programs, as far as they are constant.

use super::{argument, constant, constant_int};
use crate::diagnostics::channels::ChannelProblem;
use crate::hir::Builtin;
use arl_lang::span::Span;
use arl_robot::channels::Channels;

/// The most channels that one call may name.
const MOST_AT_ONCE: i64 = 32;

/// Which channels a built-in means, and how many a cell has.
type Kind = (&'static str, fn(&Channels) -> usize);

const DI: Kind = ("DI", |cell| cell.di as usize);
const DO: Kind = ("DO", |cell| cell.dout as usize);
const AI: Kind = ("AI", |cell| cell.ai.len());
const AO: Kind = ("AO", |cell| cell.ao.len());
const INTERNAL: Kind = ("internal signal", |cell| cell.internal as usize);

/// The built-ins that name channels in their first parameter, or in their first two.
const NAMES: [(&str, Kind); 13] = [
    ("setdo", DO),
    ("setdoimv", DO),
    ("syncdo", DO),
    ("pulsedo", DO),
    ("getdo", DO),
    ("getdi", DI),
    ("getnostopdi", DI),
    ("getai", AI),
    ("setao", AO),
    ("syncao", AO),
    ("getao", AO),
    ("getintdi", INTERNAL),
    ("getintdo", INTERNAL),
];

/// The built-ins that ask the foreground channel in their first parameter.
const ASKING: [&str; 13] = [
    "cjttq",
    "cjtci",
    "channeltojoint",
    "channeltopose",
    "channeljoint",
    "channelpose",
    "channeljointvel",
    "channeltcpvel",
    "ctcpforce",
    "curmpfile",
    "curmpline",
    "curppfile",
    "curppline",
];

/// A foreground channel of a call that a cell with so many does not have, and where.
pub(super) fn no_foreground(builtin: &Builtin, count: u32) -> Option<(Span, ChannelProblem)> {
    if !ASKING.contains(&builtin.entry.name) {
        return None;
    }
    let (channel, span) = constant_int(argument(builtin, 0)?)?;
    let exists = (1..=i64::from(count)).contains(&i64::from(channel));
    (!exists).then_some((span, ChannelProblem::NoForeground { channel, count }))
}

/// What is wrong with the channels of io of a call, and where.
pub(super) fn problem(builtin: &Builtin, cell: &Channels) -> Option<(Span, ChannelProblem)> {
    let (_, (kind, count)) = NAMES.iter().find(|(name, _)| *name == builtin.entry.name)?;
    let (kind, count) = (*kind, count(cell) as u32);
    let named = |at: usize| builtin.entry.params.get(at).is_some_and(|param| param.name.contains("chan"));
    let channels: Vec<(i32, Span)> =
        [0, 1].into_iter().filter(|at| named(*at)).filter_map(|at| constant_int(argument(builtin, at)?)).collect();
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
    let (channel, _) = *channels.first().filter(|_| matches!(builtin.entry.name, "setao" | "syncao"))?;
    let ty = *cell.ao.get(usize::try_from(channel).ok()?.checked_sub(1)?)?;
    let (value, span) = constant(argument(builtin, 1)?)?;
    let (low, high) = ty.range();
    (!(low..=high).contains(&value)).then_some((span, ChannelProblem::Value { channel, value, ty }))
}
