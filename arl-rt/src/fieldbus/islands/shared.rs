//! The images that the thread of an island and the cycle hand each other.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};

use super::plan::Signals;

/// The images of an island's signals between its thread and the cycle. The lock is held for copying them only; the
/// cycle does not wait for it, it tries again in the next cycle.
pub(super) struct SharedImages {
    state: Mutex<IslandState>,
    changed: Condvar,
    stop: AtomicBool,
}

/// The images, and how the island fares.
pub(super) struct IslandState {
    /// What was read last.
    pub(super) inputs: Signals,
    /// What is to be written.
    pub(super) outputs: Signals,
    /// The cycle that gave them, if one has.
    pub(super) given: Option<u64>,
    /// The last cycle whose outputs the island has taken.
    pub(super) written: Option<u64>,
    /// How often the island was found or lost.
    pub(super) turns: u64,
    /// Why the island is lost, if it is.
    pub(super) lost: Option<Arc<str>>,
}

impl SharedImages {
    /// Images with these signals, of an island that nobody has met.
    pub(super) fn new(inputs: Signals, outputs: Signals) -> Self {
        let state = IslandState { inputs, outputs, given: None, written: None, turns: 0, lost: None };
        Self { state: Mutex::new(state), changed: Condvar::new(), stop: AtomicBool::new(false) }
    }

    /// The images, for threads that may wait.
    pub(super) fn wait(&self) -> MutexGuard<'_, IslandState> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The images, unless somebody copies them just now: for the cycle.
    pub(super) fn try_lock(&self) -> Option<MutexGuard<'_, IslandState>> {
        match self.state.try_lock() {
            Ok(state) => Some(state),
            Err(TryLockError::Poisoned(state)) => Some(state.into_inner()),
            Err(TryLockError::WouldBlock) => None,
        }
    }

    /// Waits until the island was met or missed for the first time; why it was missed.
    pub(super) fn first_turn(&self) -> Option<Arc<str>> {
        let state = self.changed.wait_while(self.wait(), |state| state.turns == 0);
        state.unwrap_or_else(PoisonError::into_inner).lost.clone()
    }

    /// Takes the outputs; of which cycle they are, if one has given any.
    pub(super) fn take_outputs(&self, into: &mut Signals) -> Option<u64> {
        let state = self.wait();
        into.copy_from(&state.outputs);
        state.given
    }

    /// Tells that the island has taken the outputs of this cycle.
    pub(super) fn wrote(&self, cycle: u64) {
        self.wait().written = Some(cycle);
    }

    /// Brings what was read.
    pub(super) fn bring_inputs(&self, inputs: &Signals) {
        let mut state = self.wait();
        state.inputs.copy_from(inputs);
        if state.turns == 0 || state.lost.is_some() {
            state.turns += 1;
            state.lost = None;
            self.changed.notify_all();
        }
    }

    /// Tells that the island is lost, and sets the inputs where they do not stay as they were.
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

    /// Tells the thread to come to its end.
    pub(super) fn stop(&self) {
        self.stop.store(true, Ordering::Release);
    }

    /// Whether the thread shall come to its end.
    pub(super) fn stops(&self) -> bool {
        self.stop.load(Ordering::Acquire)
    }
}
