//! The connections that a program has opened.

use std::cell::RefCell;
use std::sync::Arc;

use mio::Waker;

use super::link::Link;
use super::shared::Shared;

/// How many connections may be on their way to being closed.
const MOST_CLOSING: usize = 32;

/// The connections that a program has opened: those of global variables and of local ones, too.
#[derive(Default, Debug)]
pub(crate) struct Connections(RefCell<Vec<(Arc<Shared>, Arc<Waker>)>>);

impl Connections {
    /// Notes a connection, and forgets those that are over.
    pub(crate) fn add(&self, link: &Link) {
        let mut list = self.0.borrow_mut();
        list.retain(|(shared, _)| !shared.lock().over);
        list.push(link.shared());
    }

    /// Whether so many are on their way to being closed that new ones have to wait: a program that opens and closes in a
    /// loop does not pile up threads.
    pub(crate) fn are_too_many(&self) -> bool {
        let closing = |(shared, _): &&(Arc<Shared>, Arc<Waker>)| {
            let common = shared.lock();
            common.closing && !common.over
        };
        self.0.borrow().iter().filter(closing).count() >= MOST_CLOSING
    }

    /// Closes all of them: the program has ended.
    pub(crate) fn close(&self) {
        for (shared, waker) in self.0.borrow().iter() {
            shared.lock().closing = true;
            // It fails only where the thread is gone, which then needs no waking.
            let _ = waker.wake();
        }
    }

    /// Whether nothing that is to be closed still holds a port to listen on, or a device.
    pub(crate) fn are_free(&self) -> bool {
        self.0.borrow().iter().all(|(shared, _)| shared.is_free())
    }

    /// Whether nothing that is to be closed is still open: what was sent has gone.
    pub(crate) fn are_settled(&self) -> bool {
        self.0.borrow().iter().all(|(shared, _)| shared.is_done() || !shared.lock().closing)
    }
}
