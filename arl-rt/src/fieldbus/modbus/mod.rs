//! Modbus: registers and coils that other devices read and write.

pub(crate) mod client;
pub(crate) mod mbap;
pub(crate) mod pdu;
pub(crate) mod rtu;
pub(crate) mod server;
mod tables;

use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use crate::cycle::try_lock::try_lock;
pub(crate) use tables::{SIZE, Tables};

impl PartialEq for SharedTables {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.0, &other.0)
    }
}

impl Eq for SharedTables {}

impl std::fmt::Debug for SharedTables {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("SharedTables").finish_non_exhaustive()
    }
}

/// Tables that a program and its clients share.
#[derive(Clone, Default)]
pub(crate) struct SharedTables(Arc<Mutex<Tables>>);

impl SharedTables {
    /// Waits for the lock on the tables: for threads outside the cycle.
    pub(crate) fn wait(&self) -> MutexGuard<'_, Tables> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The tables, unless another thread holds them for longer than it takes to copy the data of one request because it
    /// was interrupted just then. The cycle does not wait for that.
    pub(crate) fn try_lock(&self) -> Option<MutexGuard<'_, Tables>> {
        try_lock(&self.0)
    }
}
