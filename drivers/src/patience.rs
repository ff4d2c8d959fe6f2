//! How long a cycle waits for a simulated robot.

use std::time::Duration;

/// The wait for a robot that has answered: a simulator may have to load its scene, or be halted in a debugger for a
/// while.
const FULL: Duration = Duration::from_secs(2);
/// The wait for a robot that has not answered: it is gone, or answers soon.
const LOST: Duration = Duration::from_millis(5);

/// The wait: long if the robot has answered, short if it has not, so that a run whose robot is gone ends soon.
#[derive(Default, Debug)]
pub(crate) struct Patience {
    lost: bool,
}

impl Patience {
    /// The time to wait now.
    pub(crate) fn limit(&self) -> Duration {
        if self.lost { LOST } else { FULL }
    }

    /// Records whether the robot has answered.
    pub(crate) fn answered(&mut self, answered: bool) {
        self.lost = !answered;
    }
}
