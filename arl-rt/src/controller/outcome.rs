//! How a program ended.

use std::fmt;

use crate::fault::Alarm;

/// How a program ended.
#[derive(Clone, PartialEq, Debug)]
pub enum Outcome {
    /// It came to its end, or to `exit`.
    Ended,
    /// An alarm stopped it.
    Alarm(Alarm),
    /// [`Controller::stop`](super::Controller::stop) stopped it.
    Stopped,
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::Ended => write!(f, "the program ended"),
            Outcome::Alarm(alarm) => write!(f, "{alarm}"),
            Outcome::Stopped => write!(f, "the program was stopped"),
        }
    }
}

/// What the controller does at the moment.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum State {
    /// The program runs, or its last motion does.
    Running,
    /// The program waits for the start button.
    Paused,
    /// The program has ended; [`Controller::outcome`](super::Controller::outcome) says how.
    Ended,
}
