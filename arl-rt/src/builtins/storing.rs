//! Waiting for jobs that store data outside the cycle.

use crate::context::cx::Cx;
use crate::storage::disk::{Stage, Work};
use crate::storage::state::{Saved, StateError};

/// Waits for the end of a job, at least one cycle, while the robots continue. On the virtual clock this is one cycle,
/// however long the job takes. `None` if the job has panicked.
pub(super) async fn done<T>(work: Work<T>, cx: &Cx) -> Option<T> {
    loop {
        cx.shared().disk.wait_for();
        cx.next_cycle().await;
        match work.stage() {
            Stage::InProgress => {}
            Stage::Done(value) => return Some(value),
            Stage::Lost => return None,
        }
    }
}

/// Waits until a value is stored, at least one cycle.
///
/// # Errors
/// The value cannot be stored; the old one is still there.
pub(super) async fn saved(saved: Saved, cx: &Cx) -> Result<(), StateError> {
    loop {
        cx.shared().disk.wait_for();
        cx.next_cycle().await;
        if let Some(result) = saved.take() {
            return result;
        }
    }
}
