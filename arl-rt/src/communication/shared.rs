//! What the cycle and the thread of a connection share.

use std::sync::{Mutex, MutexGuard, PoisonError};

use super::inbox::{CAPACITY, Inbox};
use super::link::LinkState;

/// What the cycle and the thread of a connection share. Both hold the lock for the copying of bytes only.
#[derive(Debug)]
pub(super) struct Shared(Mutex<Common>);

/// The state of a connection and its buffers.
#[derive(Debug)]
pub(super) struct Common {
    pub(super) state: LinkState,
    pub(super) inbox: Inbox,
    /// What the thread has not taken yet.
    pub(super) outbox: Vec<u8>,
    /// The cycle wants the connection closed; what waits in `outbox` goes first.
    pub(super) closing: bool,
    /// The thread has nothing to do with the connection any more.
    pub(super) over: bool,
    /// It holds what others may want: a port to listen on, or a device.
    holds: bool,
}

impl Shared {
    pub(super) fn new(holds: bool) -> Self {
        Self(Mutex::new(Common {
            state: LinkState::Opening,
            inbox: Inbox::default(),
            outbox: Vec::new(),
            closing: false,
            over: false,
            holds,
        }))
    }

    /// The common state. What a thread that panicked has left behind is whole: nothing between two changes can panic.
    pub(super) fn lock(&self) -> MutexGuard<'_, Common> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether somebody else may have the port or the device.
    pub(super) fn is_free(&self) -> bool {
        let common = self.lock();
        common.over || !common.holds || !common.closing
    }

    /// Whether the connection need not be waited for: what was sent has gone, and what it held is free. A name that is
    /// still being looked up holds nothing.
    pub(super) fn is_done(&self) -> bool {
        let common = self.lock();
        common.over || (common.state == LinkState::Opening && !common.holds)
    }
}

impl Common {
    /// Notes that the connection is open; whether it still holds what others may want.
    pub(super) fn opened(&mut self, holds: bool) {
        self.state = LinkState::Open;
        self.holds = holds;
    }

    /// Takes all of it into the buffer, or nothing.
    pub(super) fn put(&mut self, bytes: &[u8]) -> bool {
        let fits = self.outbox.len().saturating_add(bytes.len()) <= CAPACITY;
        if fits {
            self.outbox.extend_from_slice(bytes);
        }
        fits
    }
}
