//! Waiting for what is stored beside the cycle.

use crate::context::cx::Cx;
use crate::storage::disk::{Stage, Work};
use crate::storage::state::{Saved, StateError};

/// Waits for the end of a piece of work, one cycle at least, while the robots go on. On the virtual clock it is one
/// cycle, however long the work takes. `None`: it has panicked.
pub(super) async fn done<T>(work: Work<T>, cx: &Cx) -> Option<T> {
    loop {
        cx.shared().disk.wait_for();
        cx.next_cycle().await;
        match work.stage() {
            Stage::UnderWay => {}
            Stage::Done(value) => return Some(value),
            Stage::Lost => return None,
        }
    }
}

/// Waits until a value is stored: one cycle at least.
///
/// # Errors
/// It cannot be stored; the old one is still there.
pub(super) async fn saved(saved: Saved, cx: &Cx) -> Result<(), StateError> {
    loop {
        cx.shared().disk.wait_for();
        cx.next_cycle().await;
        if let Some(result) = saved.take() {
            return result;
        }
    }
}
