//! Who is told of each statement of a program that was emitted for a debugger.

use crate::context::cx::Cx;
use crate::fault::Alarm;

/// Whether a program goes on.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum Go {
    /// The statement runs.
    On,
    /// It is asked again in the next cycle.
    NotYet,
}

/// Who is told of each statement, and may halt the program there.
///
/// Where time is the controller's own, it may come back late: all stands still in the meantime, and the run is the
/// same.
pub(crate) trait Watcher {
    /// A statement is about to run, in the frame with this number.
    fn statement(&self, cx: &Cx, frame: u64) -> Go;

    /// Whether what was halted goes on.
    fn goes_on(&self) -> Go;

    /// Something went wrong; the frames are still there.
    fn alarm(&self, alarm: &Alarm);
}
