//! What the cycle and the thread of a connection share: buffers, the state of the connection, and how it ended.

use std::sync::atomic::{AtomicBool, Ordering, fence};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use mio::Waker;

use super::inbox::{CAPACITY, Inbox};
use crate::cycle::catch_panic::catch_panic;
use crate::cycle::try_lock::try_lock;

/// The state of a connection.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum LinkState {
    /// It is not open yet.
    Opening,
    /// Bytes can be transferred both ways.
    Open,
    /// It could not be opened, for this reason.
    Failed(String),
    /// It was open; the other side has closed it, or it broke, as the text says. Bytes received before can still be
    /// read.
    Lost(String),
}

/// The error of a connection whose thread has panicked.
pub(super) const PANICKED: &str = "its thread has panicked";

/// What the cycle and the thread of a connection share. The bytes are behind a lock that both hold for copying only,
/// and that the cycle does not wait for; the state of the connection is read without it.
#[derive(Debug)]
pub(super) struct SharedConnection {
    bytes: Mutex<Bytes>,
    /// Wakes the thread, once it exists.
    waker: OnceLock<Waker>,
    /// Whether the cycle wants the connection closed; the bytes in the outbox are sent first.
    closing: AtomicBool,
    /// Whether it holds a resource that others may need: a port to listen on, or a device.
    is_exclusive: AtomicBool,
    /// Whether bytes can be transferred both ways, or could be.
    open: AtomicBool,
    /// How it ended: the thread does not use it any more.
    end: OnceLock<LinkState>,
}

/// The bytes of a connection.
#[derive(Default, Debug)]
pub(super) struct Bytes {
    pub(super) inbox: Inbox,
    /// Bytes that the thread has not taken yet.
    pub(super) outbox: Vec<u8>,
}

impl SharedConnection {
    pub(super) fn new(is_exclusive: bool) -> Self {
        Self {
            bytes: Mutex::default(),
            waker: OnceLock::new(),
            closing: AtomicBool::new(false),
            is_exclusive: AtomicBool::new(is_exclusive),
            open: AtomicBool::new(false),
            end: OnceLock::new(),
        }
    }

    /// The bytes, for the thread.
    pub(super) fn lock(&self) -> MutexGuard<'_, Bytes> {
        self.bytes.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The bytes, for the cycle: `None` where it would have to wait.
    pub(super) fn try_lock(&self) -> Option<MutexGuard<'_, Bytes>> {
        try_lock(&self.bytes)
    }

    /// The state of the connection. When its end is seen, all bytes received before are in the inbox.
    pub(super) fn state(&self) -> LinkState {
        match self.end.get() {
            Some(end) => end.clone(),
            None if self.open.load(Ordering::Acquire) => LinkState::Open,
            None => LinkState::Opening,
        }
    }

    /// Notes that the connection is open; `is_exclusive`: it still holds a resource that others may need.
    pub(super) fn opened(&self, is_exclusive: bool) {
        self.is_exclusive.store(is_exclusive, Ordering::Release);
        self.open.store(true, Ordering::Release);
    }

    /// Notes how it ended. Once: done by the thread, or by the caller that could not start one.
    pub(super) fn end(&self, state: LinkState) {
        self.end.get_or_init(|| state);
    }

    /// Serves the connection until it ends, and notes how. Where the thread panics, the connection is over as well: it
    /// is not waited for.
    pub(super) fn end_after(&self, serve: impl FnOnce() -> LinkState) {
        let panicked = || match self.open.load(Ordering::Acquire) {
            true => LinkState::Lost(PANICKED.into()),
            false => LinkState::Failed(PANICKED.into()),
        };
        self.end(catch_panic(serve).unwrap_or_else(panicked));
    }

    /// Whether the thread does not use the connection any more.
    pub(super) fn is_over(&self) -> bool {
        self.end.get().is_some()
    }

    /// Whether the cycle wants it closed.
    pub(super) fn is_closing(&self) -> bool {
        // Either the thread sees this flag, or the closing thread sees the waker.
        fence(Ordering::SeqCst);
        self.closing.load(Ordering::Acquire)
    }

    /// Closes the connection once all bytes have been sent.
    pub(super) fn close(&self) {
        self.closing.store(true, Ordering::Release);
        fence(Ordering::SeqCst);
        self.wake();
    }

    /// Sets the waker of its thread, which is about to start.
    pub(super) fn wakes_by(&self, waker: Waker) {
        let _ = self.waker.set(waker);
    }

    /// Wakes the thread. One that has not started yet checks by itself.
    pub(super) fn wake(&self) {
        // This fails only where the thread has ended, which then needs no waking.
        let _ = self.waker.get().map(Waker::wake);
    }

    /// False while the connection is closing and still holds its port or device.
    pub(super) fn is_free(&self) -> bool {
        self.is_over() || !self.is_exclusive.load(Ordering::Acquire) || !self.closing.load(Ordering::Acquire)
    }

    /// Whether the connection need not be waited for: all bytes were sent, and the resource that it held is free. A
    /// name that is still being resolved holds nothing.
    pub(super) fn is_done(&self) -> bool {
        self.is_over() || !(self.open.load(Ordering::Acquire) || self.is_exclusive.load(Ordering::Acquire))
    }
}

impl Bytes {
    /// Puts all bytes into the outbox, or none.
    pub(super) fn put(&mut self, bytes: &[u8]) -> bool {
        let fits = self.outbox.len().saturating_add(bytes.len()) <= CAPACITY;
        if fits {
            self.outbox.extend_from_slice(bytes);
        }
        fits
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cycle_does_not_wait_for_the_thread() {
        let shared = SharedConnection::new(true);
        let held = shared.lock();
        assert!(shared.try_lock().is_none());
        assert_eq!(shared.state(), LinkState::Opening);
        shared.opened(false);
        assert!(shared.state() == LinkState::Open && shared.is_free() && !shared.is_done());
        shared.close();
        assert!(shared.is_closing() && !shared.is_over());
        shared.end(LinkState::Lost("gone".into()));
        assert!(shared.is_over() && shared.is_done());
        drop(held);
        assert!(shared.try_lock().is_some_and(|mut bytes| bytes.put(b"x") && !bytes.put(&[0; CAPACITY])));
    }
    #[test]
    fn a_connection_whose_thread_panics_is_over() {
        let panics = || std::panic::panic_any("meant to be");
        let shared = SharedConnection::new(true);
        shared.end_after(panics);
        assert!(shared.state() == LinkState::Failed(PANICKED.into()) && shared.is_done());
        let shared = SharedConnection::new(true);
        shared.opened(true);
        shared.end_after(panics);
        assert!(shared.state() == LinkState::Lost(PANICKED.into()) && shared.is_done() && shared.is_free());
    }
}
