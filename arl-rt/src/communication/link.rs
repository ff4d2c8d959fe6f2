//! A connection as the cycle uses it: reading and sending never wait.

use std::io;
use std::sync::Arc;

use super::connections::{Connections, Opener};
use super::inbox::Inbox;
use super::opening::Opening;
use super::shared::{LinkState, SharedConnection};

/// A connection: a stream of bytes that a thread of its own serves. Nothing here waits. It closes when it is dropped,
/// after all bytes have been sent (or one second later).
#[derive(Debug)]
pub(crate) struct Link(Arc<SharedConnection>);

impl Link {
    /// Begins to open a connection.
    ///
    /// # Errors
    /// The system has no threads left.
    pub(crate) fn open(connections: &Connections, opener: &Opener, opening: Opening) -> io::Result<Self> {
        let shared = Arc::new(SharedConnection::new(opening.is_exclusive()));
        connections.open(opener, Arc::clone(&shared), opening)?;
        Ok(Self(shared))
    }

    /// The state of the connection.
    pub(crate) fn state(&self) -> LinkState {
        self.0.state()
    }

    /// Whether the program has ended since, and the connection is being closed.
    pub(crate) fn is_closing(&self) -> bool {
        self.0.is_closing()
    }

    /// Reads from the received bytes; `None` where the thread holds the buffers just now.
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

    /// Sends bytes after those sent before. `Some(false)`, and nothing is sent, where there is no room for them yet;
    /// `None` where the thread holds the buffers just now.
    pub(crate) fn send(&self, bytes: &[u8]) -> Option<bool> {
        let sent = self.0.try_lock()?.put(bytes);
        if sent {
            self.0.wake();
        }
        Some(sent)
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.0.close();
    }
}

#[cfg(test)]
mod tests {
    use super::super::inbox::CAPACITY;
    use super::*;

    #[test]
    fn that_the_thread_has_the_bytes_is_not_that_there_is_no_room() {
        let link = Link(Arc::new(SharedConnection::new(false)));
        let held = link.0.lock();
        assert_eq!(link.send(b"hello"), None);
        drop(held);
        assert_eq!(link.send(b"hello"), Some(true));
        assert_eq!(link.send(&[0; CAPACITY]), Some(false));
    }
}
