//! How long a cycle waits for a robot that is simulated.

use std::time::Duration;

/// A simulator may have to load what it shows, or stand in a debugger's halt for a while.
const FULL: Duration = Duration::from_secs(2);
/// One that did not answer is gone, or answers soon.
const LOST: Duration = Duration::from_millis(5);

/// Long where the robot has answered, short where it has not: a run whose robot is gone ends soon.
#[derive(Default, Debug)]
pub(crate) struct Patience {
    lost: bool,
}

impl Patience {
    /// How long to wait now.
    pub(crate) fn limit(&self) -> Duration {
        if self.lost { LOST } else { FULL }
    }

    /// Whether the robot has answered.
    pub(crate) fn answered(&mut self, answered: bool) {
        self.lost = !answered;
    }
}
