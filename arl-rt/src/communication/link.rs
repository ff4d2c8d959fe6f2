//! A connection as the cycle sees it: reading and sending never wait.

use std::io;
use std::sync::Arc;

use super::connections::{Connections, Opener};
use super::inbox::Inbox;
use super::opening::Opening;
use super::shared::{LinkState, Shared};

/// A connection: a stream of bytes that a thread of its own serves. Nothing here waits. It closes when it is dropped,
/// after what was sent has gone (or one second later).
#[derive(Debug)]
pub(crate) struct Link(Arc<Shared>);

impl Link {
    /// Begins to open a connection.
    ///
    /// # Errors
    /// The system has no threads left.
    pub(crate) fn open(connections: &Connections, opener: &Opener, opening: Opening) -> io::Result<Self> {
        let shared = Arc::new(Shared::new(opening.holds()));
        connections.open(opener, Arc::clone(&shared), opening)?;
        Ok(Self(shared))
    }

    /// How far it has come.
    pub(crate) fn state(&self) -> LinkState {
        self.0.state()
    }

    /// Whether the program has ended since, and the connection with it.
    pub(crate) fn is_closing(&self) -> bool {
        self.0.is_closing()
    }

    /// Reads from what has come; nothing where the thread has the bytes just now.
    pub(crate) fn read<R>(&self, read: impl FnOnce(&mut Inbox) -> R) -> Option<R> {
        let (result, more) = {
            let mut bytes = self.0.try_lock()?;
            let full = bytes.inbox.room() == 0;
            let result = read(&mut bytes.inbox);
            (result, full && bytes.inbox.room() > 0)
        };
        if more {
            self.0.wake();
        }
        Some(result)
    }

    /// Sends bytes behind those sent before. False, and nothing is sent, where they have no room yet, or the thread has the
    /// bytes just now.
    pub(crate) fn send(&self, bytes: &[u8]) -> bool {
        let sent = self.0.try_lock().is_some_and(|mut common| common.put(bytes));
        if sent {
            self.0.wake();
        }
        sent
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.0.close();
    }
}
