//! Whether programs wait for what can never happen.

use std::cell::Cell;
use std::fmt;

use crate::cycle::channel_id::ChannelId;
use crate::fault::File;

/// What a program waits for that does not come by itself.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum WaitsFor {
    /// The condition of a `waituntil`.
    Condition,
    /// The start button.
    StartButton,
    /// Motion that was stopped, to be started again.
    Motion,
    /// Motion while the override is 0.
    Override,
}

impl fmt::Display for WaitsFor {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            WaitsFor::Condition => "its condition, which does not hold",
            WaitsFor::StartButton => "the start button",
            WaitsFor::Motion => "motion that is stopped (`stopmove`)",
            WaitsFor::Override => "motion, and the override is 0",
        })
    }
}

/// A program that waits in vain: nothing that it depends on can change any more.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct Standstill {
    /// The channel that it runs in.
    pub channel: ChannelId,
    /// The file of the statement that waits.
    pub file: File,
    /// The line of the statement.
    pub line: u32,
    /// What it waits for.
    pub waits_for: WaitsFor,
}

impl fmt::Display for Standstill {
    /// `pick.arl:12 waits for the start button`
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{} waits for {}", self.file.name(), self.line, self.waits_for)
    }
}

/// Records from which follows whether a program only waits: in every cycle it notes that it does, and for what. When it
/// begins to wait, or does anything else, it notes that, too.
#[derive(Default, Debug)]
pub(crate) struct Waiting {
    /// The last cycle in which it waited.
    waited: Cell<Option<(u64, WaitsFor)>>,
    /// The last cycle in which it did something else than wait.
    acted: Cell<u64>,
    /// The last cycle in which it waited for a time, and the cycle until which it waits.
    timed: Cell<Option<(u64, u64)>>,
}

impl Waiting {
    /// The program waits in this cycle.
    #[inline]
    pub(crate) fn note(&self, cycle: u64, waits_for: WaitsFor) {
        self.waited.set(Some((cycle, waits_for)));
    }

    /// The program waits in this cycle until the cycle `until`.
    #[inline]
    pub(crate) fn note_time(&self, cycle: u64, until: u64) {
        self.timed.set(Some((cycle, until)));
    }

    /// The program does something in this cycle, begins to wait, or evaluates something that changes by itself, like
    /// time.
    #[inline]
    pub(crate) fn note_action(&self, cycle: u64) {
        self.acted.set(cycle);
    }

    /// The last cycle in which it did something else than wait.
    pub(crate) fn acted(&self) -> u64 {
        self.acted.get()
    }

    /// The cycle until which the program has waited in `cycle`, without doing anything else.
    pub(crate) fn until(&self, cycle: u64) -> Option<u64> {
        let (waited, until) = self.timed.get()?;
        (waited == cycle && self.acted.get() < cycle).then_some(until)
    }

    /// What the program has waited for in `cycle`, without doing anything else.
    pub(crate) fn in_cycle(&self, cycle: u64) -> Option<WaitsFor> {
        let (waited, waits_for) = self.waited.get()?;
        (waited == cycle && self.acted.get() < cycle).then_some(waits_for)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_does_nothing_but_wait_waits() {
        let waiting = Waiting::default();
        waiting.note_action(5);
        waiting.note(5, WaitsFor::Condition);
        assert_eq!(waiting.in_cycle(5), None, "it has just begun");
        waiting.note(6, WaitsFor::Condition);
        assert_eq!(waiting.in_cycle(6), Some(WaitsFor::Condition));
        assert_eq!(waiting.in_cycle(7), None, "it went on");
        waiting.note(7, WaitsFor::Condition);
        waiting.note_action(7);
        assert_eq!(waiting.in_cycle(7), None, "its condition looked at a clock");
        waiting.note_time(8, 20);
        assert_eq!((waiting.until(8), waiting.until(9), waiting.in_cycle(8)), (Some(20), None, None));
        waiting.note_action(8);
        assert_eq!(waiting.until(8), None, "a handler did something");
    }
}
