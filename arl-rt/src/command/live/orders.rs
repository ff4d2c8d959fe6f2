//! Reads orders from the standard input, one per line, on a thread of its own.

use std::io::{BufRead, Read, stdin};
use std::sync::mpsc::{Receiver, TryRecvError, sync_channel};

use arl_motion::beside;

/// How many orders may wait for their cycle; a sender of more has to wait.
const MAX_WAITING_ORDERS: usize = 256;
/// The longest line in bytes; a longer one is split into several.
const MAX_ORDER_BYTES: u64 = 1 << 16;

/// The next order, if any.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(super) enum Next {
    /// An order.
    Order(String),
    /// Nothing yet.
    None,
    /// Nothing more will come.
    End,
}

/// The orders, as they arrive.
pub(super) struct Orders(Receiver<String>);

impl Orders {
    /// Reads the standard input on a thread of its own, so that no cycle waits for it.
    pub(super) fn from_standard_input() -> Self {
        let (sender, orders) = sync_channel(MAX_WAITING_ORDERS);
        let thread = std::thread::Builder::new().name("orders".into());
        // Without a thread there are no orders, as after their end.
        let _ = beside::spawn(thread, move || {
            let mut input = stdin().lock();
            let mut line = Vec::new();
            while matches!(input.by_ref().take(MAX_ORDER_BYTES).read_until(b'\n', &mut line), Ok(1..)) {
                let order = String::from_utf8_lossy(&line).trim().to_owned();
                line.clear();
                if !order.is_empty() && sender.send(order).is_err() {
                    return;
                }
            }
        });
        Self(orders)
    }

    pub(super) fn next(&self) -> Next {
        match self.0.try_recv() {
            Ok(order) => Next::Order(order),
            Err(TryRecvError::Empty) => Next::None,
            Err(TryRecvError::Disconnected) => Next::End,
        }
    }
}
