//! The connections that a program has opened, and the thread that opens them.

use std::cell::RefCell;
use std::io;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};
use std::thread::Builder;

use arl_motion::beside;

use mio::{Poll, Waker};

use super::opening::Opening;
use super::shared::{LinkState, PANICKED, SharedConnection};
use super::stream::WAKE;
use super::worker;
use crate::cycle::catch_panic::catch_panic;

/// How many connections may be closing at a time.
const MAX_CLOSING: usize = 32;

/// The connections that a program has opened: those of global variables and of local ones.
#[derive(Default, Debug)]
pub(crate) struct Connections(RefCell<Vec<Arc<SharedConnection>>>);

/// The thread that opens the connections of all programs. Requesting a thread and descriptors from the system, and
/// returning them, takes longer than a cycle should. The thread ends with the sender of its orders.
#[derive(Default, Debug)]
pub(crate) struct Opener(RefCell<Option<Sender<Order>>>);

/// An order for that thread.
#[derive(Debug)]
struct Order {
    shared: Arc<SharedConnection>,
    opening: Opening,
    /// Connections that are over, to be dropped there.
    over: Vec<Arc<SharedConnection>>,
}

impl Opener {
    /// Starts the thread, unless it already runs.
    ///
    /// # Errors
    /// The system has no threads left.
    pub(crate) fn start(&self) -> io::Result<()> {
        let mut opener = self.0.borrow_mut();
        if opener.is_none() {
            let (sender, orders) = channel();
            let thread = Builder::new().name("connections".into()).stack_size(worker::STACK_BYTES);
            beside::spawn(thread, move || carry_out(&orders))?;
            *opener = Some(sender);
        }
        Ok(())
    }

    fn send(&self, order: Order) -> io::Result<()> {
        self.start()?;
        let sent = self.0.borrow().as_ref().is_some_and(|sender| sender.send(order).is_ok());
        sent.then_some(()).ok_or_else(|| io::Error::other("the thread that opens connections is gone"))
    }
}

impl Connections {
    /// Has a connection opened, and removes those that are over.
    ///
    /// # Errors
    /// The system has no threads left.
    pub(super) fn open(&self, opener: &Opener, shared: Arc<SharedConnection>, opening: Opening) -> io::Result<()> {
        let mut list = self.0.borrow_mut();
        let over = list.extract_if(.., |shared| shared.is_over()).collect();
        opener.send(Order { shared: Arc::clone(&shared), opening, over })?;
        list.push(shared);
        Ok(())
    }

    /// Whether so many connections are closing that new ones have to wait: a program that opens and closes connections
    /// in a loop does not pile up threads.
    pub(crate) fn are_too_many(&self) -> bool {
        let closing = |shared: &&Arc<SharedConnection>| shared.is_closing() && !shared.is_over();
        self.0.borrow().iter().filter(closing).count() >= MAX_CLOSING
    }

    /// Closes all connections: the program has ended.
    pub(crate) fn close(&self) {
        self.0.borrow().iter().for_each(|shared| shared.close());
    }

    /// Whether no connection that is closing still holds a port to listen on, or a device.
    pub(crate) fn are_free(&self) -> bool {
        self.0.borrow().iter().all(|shared| shared.is_free())
    }

    /// Whether no connection that is closing is still open: all their bytes have been sent.
    pub(crate) fn are_settled(&self) -> bool {
        self.0.borrow().iter().all(|shared| shared.is_done() || !shared.is_closing())
    }
}

fn carry_out(orders: &Receiver<Order>) {
    for Order { shared, opening, over } in orders {
        let started = catch_panic(|| {
            drop(over);
            start(&shared, opening)
        });
        match started {
            Some(Ok(())) => {}
            Some(Err(error)) => shared.end(LinkState::Failed(error.to_string())),
            None => shared.end(LinkState::Failed(PANICKED.into())),
        }
    }
}

/// Starts the thread of a connection.
fn start(shared: &Arc<SharedConnection>, opening: Opening) -> io::Result<()> {
    let poll = Poll::new()?;
    shared.wakes_by(Waker::new(poll.registry(), WAKE)?);
    let served = Arc::clone(shared);
    let thread = Builder::new().name("connection".into()).stack_size(worker::STACK_BYTES);
    beside::spawn(thread, move || worker::serve(&served, poll, &opening))?;
    Ok(())
}
