//! How a run ends, and the exit codes of its process.

use crate::controller::Outcome;

/// The usage is wrong, or a file.
pub(super) const EXIT_USAGE: u8 = 2;
/// The run could not go on.
pub(super) const EXIT_ALARM: u8 = 3;
/// The process was interrupted.
pub(super) const EXIT_INTERRUPTED: u8 = 130;
/// A bug of the runtime: the code of Rust programs that panic.
pub(super) const EXIT_PANICKED: u8 = 101;

/// How a run ended.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Ending {
    /// The program ended.
    Ended,
    /// An alarm ended it.
    Alarm,
    /// Its time limit was reached.
    TimeOver,
    /// Nothing could change any more.
    Stuck,
    /// It was stopped from outside.
    Stopped,
}

impl Ending {
    /// How a run ended whose programs ended like this, where `cut` ended it before they did.
    ///
    /// An alarm comes before a time limit and before programs that wait in vain: they may wait for the one that it
    /// ended. Who stops a run from outside knows that it was stopped.
    pub(crate) fn of(cut: Option<Self>, outcome: Option<&Outcome>) -> Self {
        match (cut, outcome) {
            (Some(Self::Stopped), _) => Self::Stopped,
            (_, Some(Outcome::Alarm(_))) => Self::Alarm,
            (Some(cut), _) => cut,
            (None, _) => Self::Ended,
        }
    }

    /// Its word in a summary.
    pub(crate) fn word(self) -> &'static str {
        match self {
            Self::Ended => "ended",
            Self::Alarm => "alarm",
            Self::TimeOver => "time_over",
            Self::Stuck => "stuck",
            Self::Stopped => "stopped",
        }
    }

    /// The exit code of a command whose run ended like this.
    pub(crate) fn code(self) -> u8 {
        match self {
            Self::Ended => 0,
            Self::Alarm => EXIT_ALARM,
            Self::TimeOver | Self::Stuck => 4,
            Self::Stopped => EXIT_INTERRUPTED,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fault::{Alarm, Fault, File};

    #[test]
    fn an_alarm_comes_before_a_limit_and_an_interrupt_before_all() {
        let alarm = Outcome::Alarm(Alarm::new(Fault::DivideByZero, File::new("a.arl"), 1));
        for cut in [None, Some(Ending::TimeOver), Some(Ending::Stuck)] {
            assert_eq!(Ending::of(cut, Some(&alarm)), Ending::Alarm, "{cut:?}");
            let otherwise = cut.unwrap_or(Ending::Ended);
            assert_eq!(Ending::of(cut, Some(&Outcome::Ended)), otherwise);
            assert_eq!(Ending::of(cut, Some(&Outcome::Stopped)), otherwise);
        }
        assert_eq!(Ending::of(Some(Ending::Stopped), Some(&alarm)), Ending::Stopped);
    }
}
