//! What the controller stores beside its cycles: system variables, points of programs, where the programs stand.

use super::Controller;
use super::channel::Channel;
use super::pointer_store::PointerStore;
use crate::context::system;
use crate::storage::state::StateError;

/// How often changes of system variables are stored all of whose changes are kept, in s: what a kill of the process may
/// lose.
const STORE_INTERVAL_S: f64 = 1.0;

impl Controller {
    /// Begins the files of traces, so that no cycle has to open one.
    pub(crate) fn begin_traces(&mut self) {
        self.channels.each(Channel::flush_trace);
    }

    /// Takes in what was stored beside the cycles. Where cycles do not take real time, what programs wait for is stored
    /// before the next cycle, so that a run does not depend on the disk.
    pub(super) fn finish_disk_work(&mut self) {
        let shared = &self.shared;
        if shared.disk.is_waited_for() && !self.clock.is_real() {
            shared.disk.settle();
        }
        if shared.state.borrow().is_saving() {
            self.collect_saved();
        }
    }

    fn collect_saved(&self) {
        let problems = self.shared.state.borrow_mut().collect();
        problems.into_iter().for_each(|problem| self.warn_of_unstored(&problem));
    }

    fn warn_of_unstored(&self, problem: &StateError) {
        self.shared.warn(format!("system variables cannot be saved: {problem}"));
    }

    /// Begins to store the changes of those system variables all of whose changes are kept: once a second at most, and
    /// when the programs have ended.
    pub(super) fn store_changed_variables(&mut self) {
        let now = self.shared.now.get();
        let due = || now >= self.stores_from || self.channels.outcome().is_some();
        if self.system().has_changed() && due() && !self.shared.state.borrow().is_saving() {
            self.stores_from = now + self.shared.rate.cycles(STORE_INTERVAL_S);
            self.begin_to_store();
        }
    }

    fn begin_to_store(&self) {
        let kept = system::store_changed(self.system(), &mut self.shared.state.borrow_mut(), &self.shared.disk);
        if let Err(problem) = kept {
            self.warn_of_unstored(&problem);
        }
    }

    /// Passes on to the storing thread where the programs stand.
    pub(super) fn note_pointers(&mut self) {
        let Some(pointer_store) = &mut self.pointer_store else { return };
        let pointers = self.channels.foreground().map(Channel::pointers);
        if let Some(problem) = pointer_store.note(pointers, self.channels.outcome().is_some()) {
            self.shared.warn(problem);
        }
    }

    /// Waits until everything is stored that is stored beside the cycles: system variables, points of programs, and
    /// where the programs stand. What goes wrong is a warning. [`run`](Controller::run) does so at its end; dropping
    /// the controller does, too, but its warnings are then lost.
    pub fn settle_state(&mut self) {
        self.shared.disk.settle();
        self.collect_saved();
        if self.system().has_changed() {
            self.begin_to_store();
            self.shared.disk.settle();
            self.collect_saved();
        }
        if let Some(problem) = self.pointer_store.as_mut().and_then(PointerStore::settle) {
            self.shared.warn(problem);
        }
    }
}
