//! Observers that act between the cycles of a run.

use crate::controller::Controller;

/// What the run should do in the next cycle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum CycleOrder {
    /// It goes on.
    Runs,
    /// It waits for a command from outside, which may let it go on: this is not a standstill.
    Stands,
    /// The run is to end: the robot stops on its path.
    Ends,
}

/// An observer that acts between the cycles of a run.
pub(crate) trait Between {
    /// A cycle is about to begin.
    fn cycle_begins(&mut self, controller: &mut Controller) -> CycleOrder;

    /// Nothing can change any more: the programs wait for what `_waiting` says. Returns whether something was changed,
    /// so that the run goes on.
    fn nothing_can_change(&mut self, _controller: &mut Controller, _waiting: &str) -> bool {
        false
    }

    /// The run has ended.
    fn run_ended(&mut self, controller: &mut Controller);
}
