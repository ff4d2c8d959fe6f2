//! Edges and pulses of an input, found by reading it once a cycle.

use crate::context::system::System;
use crate::io::Image;
use arl_robot::cell::Rate;

/// The state that is evaluated in a cycle.
pub(in crate::controller) struct InputSnapshot<'a> {
    /// The inputs.
    pub(in crate::controller) io: &'a Image,
    /// The system variables that assign functions to inputs.
    pub(in crate::controller) system: &'a System,
    /// The running number of the cycle.
    pub(in crate::controller) cycle: u64,
    /// The length of the cycles.
    pub(in crate::controller) rate: Rate,
    /// Whether the programs are paused.
    pub(in crate::controller) paused: bool,
}

/// The state of an input in this cycle.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub(super) struct InputState {
    /// Whether it is on.
    pub(super) on: bool,
    /// Whether it has just gone on.
    pub(super) rises: bool,
    /// For how many cycles it has been on, this one included; 0 where its rising edge was not seen.
    pub(super) cycles: u64,
}

/// Follows the input that a system variable names.
#[derive(Clone, Copy, Default, Debug)]
pub(super) struct EdgeDetector {
    /// The input that was read last; 0 before the first reading.
    channel: i32,
    level: bool,
    /// The cycle in which it went on, if it is still on.
    since: Option<u64>,
}

impl EdgeDetector {
    /// Reads the input. Edges count while `active` only, and only after a reading of the same input: one that is on
    /// when it begins to count must go off first.
    pub(super) fn look(&mut self, io: &Image, channel: i32, cycle: u64, active: bool) -> InputState {
        let Some(on) = io.input(channel) else {
            *self = Self::default();
            return InputState::default();
        };
        let rises = active && on && !self.level && self.channel == channel;
        if rises {
            self.since = Some(cycle);
        }
        if !on || !active || self.channel != channel {
            self.since = None;
        }
        (self.channel, self.level) = (channel, on);
        InputState { on: on && active, rises, cycles: self.since.map_or(0, |since| cycle - since + 1) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::{Channels, Digital};

    /// What the detector reports for successive levels, each with its channel and whether edges count.
    fn rises(levels: &[(i32, bool, bool)]) -> Vec<(bool, u64)> {
        let (mut io, mut watch) = (Image::new(&Channels::default()), EdgeDetector::default());
        let mut cycle = 0;
        let look = |(channel, level, active): &(i32, bool, bool)| {
            io.set_digital(Digital::Di, *channel, *level).unwrap();
            let seen = watch.look(&io, *channel, cycle, *active);
            cycle += 1;
            (seen.rises, seen.cycles)
        };
        levels.iter().map(look).collect()
    }

    #[test]
    fn an_edge_is_off_and_then_on() {
        let seen = rises(&[(1, false, true), (1, true, true), (1, true, true), (1, false, true), (1, true, true)]);
        assert_eq!(seen, [(false, 0), (true, 1), (false, 2), (false, 0), (true, 1)]);
    }

    #[test]
    fn what_is_on_at_first_does_not_count() {
        assert_eq!(rises(&[(1, true, true), (1, true, true), (1, false, true), (1, true, true)])[..2], [(false, 0); 2]);
        let other = rises(&[(1, false, true), (2, true, true), (2, true, true)]);
        assert_eq!(other, [(false, 0); 3], "another input is wired");
    }

    #[test]
    fn what_happens_while_nobody_listens_is_lost() {
        let seen = rises(&[(1, false, false), (1, true, false), (1, true, true), (1, false, true), (1, true, true)]);
        assert_eq!(seen, [(false, 0), (false, 0), (false, 0), (false, 0), (true, 1)]);
        let consumed = rises(&[(1, false, true), (1, true, true), (1, true, false), (1, true, true)]);
        assert_eq!(consumed, [(false, 0), (true, 1), (false, 0), (false, 0)], "a pulse does not outlast it");
    }

    #[test]
    fn an_input_that_is_not_there_is_off() {
        let io = Image::new(&Channels::default());
        for channel in [0, -1, 65, i32::MIN, i32::MAX] {
            assert_eq!(EdgeDetector::default().look(&io, channel, 0, true), InputState::default());
        }
    }
}
