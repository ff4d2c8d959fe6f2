//! How a program ended.

use std::fmt;

use crate::context::standstill::Standstill;
use crate::fault::Alarm;

/// How a program ended.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum Outcome {
    /// It came to its end, or to `exit`.
    Ended,
    /// An alarm stopped it.
    Alarm(Alarm),
    /// [`Controller::stop`](super::Controller::stop) stopped it.
    Stopped,
    /// It waits, and nothing can change any more: [`Controller::standstill`](super::Controller::standstill). It has not
    /// ended: changing an input or pressing a button can let it run on.
    Standstill(Vec<Standstill>),
}

impl fmt::Display for Outcome {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Outcome::Ended => write!(f, "the program ended"),
            Outcome::Alarm(alarm) => write!(f, "{alarm}"),
            Outcome::Stopped => write!(f, "the program was stopped"),
            Outcome::Standstill(waiting) => {
                write!(f, "nothing can change any more")?;
                waiting.iter().try_for_each(|standstill| write!(f, "; {standstill}"))
            }
        }
    }
}
