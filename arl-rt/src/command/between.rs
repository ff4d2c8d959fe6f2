//! What may look after a run between its cycles.

use crate::controller::Controller;

/// What the run is to do in the next cycle.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) enum CycleOrder {
    /// It goes on.
    Runs,
    /// It waits for somebody outside, who may let it go on: it is at no standstill.
    Stands,
    /// Nobody wants it any more: the robot stops on its path.
    Ends,
}

/// Who looks after a run between its cycles.
pub(crate) trait Between {
    /// A cycle is about to begin.
    fn cycle_begins(&mut self, controller: &mut Controller) -> CycleOrder;

    /// Nothing can change any more: the programs wait for what these words say. Whether somebody changed something, so
    /// that the run goes on.
    fn nothing_can_change(&mut self, _controller: &mut Controller, _waiting: &str) -> bool {
        false
    }

    /// The run has ended.
    fn run_ended(&mut self, controller: &mut Controller);
}
