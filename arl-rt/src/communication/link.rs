//! A connection as the cycle sees it.

use std::io;
use std::sync::Arc;

use mio::{Poll, Waker};

use super::inbox::Inbox;
use super::opening::Opening;
use super::shared::Shared;
use super::worker;

/// How far a connection has come.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum LinkState {
    /// It is not open yet.
    Opening,
    /// Bytes can go both ways.
    Open,
    /// It could not be opened, for this reason.
    Failed(String),
    /// It was open; the other side has closed it, or it broke, as the text says. What came before can still be read.
    Lost(String),
}

/// A connection: a stream of bytes that a thread of its own serves. Nothing here waits. It closes when it is dropped,
/// after what was sent has gone (or one second later).
#[derive(Debug)]
pub(crate) struct Link {
    shared: Arc<Shared>,
    waker: Arc<Waker>,
}

impl Link {
    /// Begins to open a connection.
    ///
    /// # Errors
    /// The system has no threads or descriptors left.
    pub(crate) fn open(opening: Opening) -> io::Result<Self> {
        let poll = Poll::new()?;
        let waker = Arc::new(Waker::new(poll.registry(), worker::WAKE)?);
        let shared = Arc::new(Shared::new(opening.holds()));
        let served = Arc::clone(&shared);
        let thread = std::thread::Builder::new().name("connection".into()).stack_size(worker::STACK);
        thread.spawn(move || worker::serve(&served, poll, &opening))?;
        Ok(Self { shared, waker })
    }

    /// How far it has come.
    pub(crate) fn state(&self) -> LinkState {
        self.shared.lock().state.clone()
    }

    /// Whether the program has ended since, and the connection with it.
    pub(crate) fn is_closing(&self) -> bool {
        self.shared.lock().closing
    }

    /// Reads from what has come.
    pub(crate) fn read<R>(&self, read: impl FnOnce(&mut Inbox) -> R) -> R {
        let (result, more) = {
            let mut common = self.shared.lock();
            let full = common.inbox.room() == 0;
            let result = read(&mut common.inbox);
            (result, full && common.inbox.room() > 0)
        };
        if more {
            self.wake();
        }
        result
    }

    /// Sends bytes behind those sent before. False, and nothing is sent, where they have no room yet.
    pub(crate) fn send(&self, bytes: &[u8]) -> bool {
        let sent = self.shared.lock().put(bytes);
        if sent {
            self.wake();
        }
        sent
    }

    /// Closes the connection once everything sent has gone.
    pub(crate) fn close(&self) {
        self.shared.lock().closing = true;
        self.wake();
    }

    /// The connection for whoever closes it in the end.
    pub(super) fn shared(&self) -> (Arc<Shared>, Arc<Waker>) {
        (Arc::clone(&self.shared), Arc::clone(&self.waker))
    }

    fn wake(&self) {
        // It fails only where the thread is gone, which then needs no waking.
        let _ = self.waker.wake();
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.close();
    }
}
