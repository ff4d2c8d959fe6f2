//! The images that the thread of an island and the cycle share.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};

use super::plan::Signals;

/// The images of an island's signals between its thread and the cycle. The lock is held only for copying them; the
/// cycle does not wait for it, but tries again in the next cycle.
pub(super) struct SharedImages {
    state: Mutex<IslandState>,
    changed: Condvar,
    stop: AtomicBool,
}

/// The images, and the state of the island.
pub(super) struct IslandState {
    /// The inputs read last.
    pub(super) inputs: Signals,
    /// The outputs to write.
    pub(super) outputs: Signals,
    /// The cycle that set the outputs; `None` before the first.
    pub(super) given: Option<u64>,
    /// The last cycle whose outputs the island has taken.
    pub(super) written: Option<u64>,
    /// How often the island was found or lost.
    pub(super) turns: u64,
    /// The reason why the island is lost, if it is.
    pub(super) lost: Option<Arc<str>>,
}

impl SharedImages {
    /// Images with these signals, of an island that has not been contacted yet.
    pub(super) fn new(inputs: Signals, outputs: Signals) -> Self {
        let state = IslandState { inputs, outputs, given: None, written: None, turns: 0, lost: None };
        Self { state: Mutex::new(state), changed: Condvar::new(), stop: AtomicBool::new(false) }
    }

    /// The images, for threads that may wait.
    pub(super) fn wait(&self) -> MutexGuard<'_, IslandState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The images, unless they are being copied just now: for the cycle.
    pub(super) fn try_lock(&self) -> Option<MutexGuard<'_, IslandState>> {
        match self.state.try_lock() {
            Ok(state) => Some(state),
            Err(TryLockError::Poisoned(state)) => Some(state.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Waits until the island was found or lost for the first time; returns the reason if it was lost.
    pub(super) fn first_turn(&self) -> Option<Arc<str>> {
        let state = self.changed.wait_while(self.wait(), |state| state.turns == 0);
        state.unwrap_or_else(PoisonError::into_inner).lost.clone()
    }

    /// Copies the outputs; returns their cycle, if one has set any.
    pub(super) fn take_outputs(&self, into: &mut Signals) -> Option<u64> {
        let state = self.wait();
        into.copy_from(&state.outputs);
        state.given
    }

    /// Records that the island has accepted the outputs of this cycle.
    pub(super) fn wrote(&self, cycle: u64) {
        self.wait().written = Some(cycle);
    }

    /// Stores the inputs that were read.
    pub(super) fn bring_inputs(&self, inputs: &Signals) {
        let mut state = self.wait();
        state.inputs.copy_from(inputs);
        if state.turns == 0 || state.lost.is_some() {
            state.turns += 1;
            state.lost = None;
            self.changed.notify_all();
        }
    }

    /// Records that the island is lost, and sets the inputs unless they keep their values.
    pub(super) fn lose(&self, why: String, inputs: Option<&Signals>) {
        let mut state = self.wait();
        if let Some(inputs) = inputs {
            state.inputs.copy_from(inputs);
        }
        if state.lost.is_none() {
            state.turns += 1;
            state.lost = Some(why.into());
            self.changed.notify_all();
        }
    }

    /// Requests the thread to end.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Release);
    }

    /// Whether the thread is to end.
    pub(super) fn stops(&self) -> bool {
        self.stop.load(Ordering::Acquire)
    }
}
