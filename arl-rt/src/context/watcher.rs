//! A watcher that is called at each statement of a program that was made for a debugger.

use crate::context::cx::Cx;
use crate::fault::Alarm;

/// Whether a program goes on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Go {
    /// The statement runs.
    On,
    /// The watcher is asked again in the next cycle.
    NotYet,
}

/// Is called at each statement, and may halt the program there.
///
/// Where the controller's time is not real time, a call may return late: everything stands still in the meantime, and
/// the run is the same.
pub(crate) trait Watcher {
    /// A statement is about to run, in the frame with this number.
    fn statement(&self, cx: &Cx, frame: u64) -> Go;

    /// Whether a halted program goes on.
    fn goes_on(&self) -> Go;

    /// A fault was raised; the frames still exist.
    fn alarm(&self, alarm: &Alarm);
}
