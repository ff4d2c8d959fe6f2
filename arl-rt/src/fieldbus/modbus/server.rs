//! A Modbus TCP server: a thread that accepts clients, and one for each of them.
//!
//! Who waits for one connection only needs one system call to hear of a request and one to answer it, and the system
//! wakes it sooner than one that waits for any of several.

mod connection;

use std::io::ErrorKind;
use std::net::SocketAddr;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Weak};
use std::thread::{Builder, JoinHandle};
use std::time::Duration;

use arl_motion::beside;

use mio::net::{TcpListener, TcpStream};
use mio::{Events, Interest, Poll, Token, Waker};

use super::SharedTables;
use crate::cycle::catch_panic::catch_panic;
use connection::Connection;

/// A connection that has been silent for so long makes room for a new one.
const IDLE_TIMEOUT: Duration = Duration::from_secs(60);

/// One that has never asked for anything does so earlier.
const FIRST_REQUEST: Duration = Duration::from_secs(5);

/// How long nobody is accepted after the system refused to.
const ACCEPT_PAUSE: Duration = Duration::from_millis(100);

/// The stack of a connection's thread.
const STACK_BYTES: usize = 64 << 10;

const LISTENER: Token = Token(0);
const WAKER: Token = Token(1);

/// The name of the threads.
const NAME: &str = "modbus-tcp";

/// A server that runs until it is dropped.
pub(crate) struct Server {
    address: SocketAddr,
    stop: Arc<AtomicBool>,
    waker: Waker,
    thread: Option<JoinHandle<()>>,
}

impl Server {
    /// Listens at an address and serves the tables, on at most so many connections at once.
    ///
    /// # Errors
    /// The system has no such address or port, or it is taken or not allowed; no thread can be started.
    pub(crate) fn start(address: SocketAddr, connections: usize, tables: SharedTables) -> std::io::Result<Self> {
        Self::with_patience(IDLE_TIMEOUT, address, connections, tables)
    }

    /// A server where a connection that has been silent for so long makes room.
    fn with_patience(
        patience: Duration,
        address: SocketAddr,
        connections: usize,
        tables: SharedTables,
    ) -> std::io::Result<Self> {
        let mut listener = TcpListener::bind(address)?;
        let address = listener.local_addr()?;
        let poll = Poll::new()?;
        poll.registry().register(&mut listener, LISTENER, Interest::READABLE)?;
        let waker = Waker::new(poll.registry(), WAKER)?;
        let stop = Arc::new(AtomicBool::new(false));
        let door = Door {
            poll,
            listener,
            refused: false,
            most: connections,
            patience,
            clients: Vec::with_capacity(connections),
            tables,
            stop: Arc::clone(&stop),
        };
        let thread = beside::spawn(Builder::new().name(NAME.into()), move || door.run())?;
        Ok(Self { address, stop, waker, thread: Some(thread) })
    }

    /// Where it listens.
    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Release);
        // A thread that could not be woken is left to itself: better than to wait for it for ever.
        if self.waker.wake().is_ok()
            && let Some(thread) = self.thread.take()
        {
            let _ = thread.join();
        }
    }
}

/// What the thread that accepts clients works with.
struct Door {
    poll: Poll,
    listener: TcpListener,
    /// The system has refused to accept somebody who waits.
    refused: bool,
    /// How many clients are served at once.
    most: usize,
    patience: Duration,
    clients: Vec<Client>,
    tables: SharedTables,
    stop: Arc<AtomicBool>,
}

/// A client that is served.
struct Client {
    /// The thread has it, and closes it at its end.
    connection: Weak<Connection>,
    thread: JoinHandle<()>,
}

impl Door {
    fn run(mut self) {
        let mut events = Events::with_capacity(4);
        while !self.stop.load(Ordering::Acquire) {
            match self.poll.poll(&mut events, self.refused.then_some(ACCEPT_PAUSE)) {
                // Whoever it was about is sent away; the others can still come.
                Ok(()) => drop(catch_panic(|| self.accept())),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => break,
            }
        }
        self.clients.iter().for_each(Client::end);
        for client in self.clients {
            let _ = client.thread.join();
        }
    }

    /// Accepts all who wait.
    fn accept(&mut self) {
        self.refused = false;
        loop {
            match self.listener.accept() {
                Ok((stream, _)) => self.admit(stream),
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                Err(error) if matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::ConnectionAborted) => {}
                // No descriptors are left, for example: whoever waits is asked again later.
                Err(_) => {
                    self.refused = true;
                    return;
                }
            }
        }
    }

    /// Serves a client, if there is room; otherwise, and where the system has no thread for it, it is sent away.
    fn admit(&mut self, stream: TcpStream) {
        self.clients.retain(|client| !client.thread.is_finished());
        if !self.has_room() {
            return;
        }
        let Ok(connection) = Connection::new(stream) else { return };
        let (connection, tables) = (Arc::new(connection), self.tables.clone());
        let known = Arc::downgrade(&connection);
        let thread = Builder::new().name(NAME.into()).stack_size(STACK_BYTES);
        let thread = beside::spawn(thread, move || connection.serve(&tables));
        self.clients.extend(thread.map(|thread| Client { connection: known, thread }));
    }

    /// Whether one more can be served, maybe in the place of one that has been silent for long.
    fn has_room(&mut self) -> bool {
        if self.clients.len() < self.most {
            return true;
        }
        let silences = self.clients.iter().enumerate();
        let too_silent = silences.filter_map(|(at, client)| Some((at, client.too_silent(self.patience)?)));
        let Some((at, _)) = too_silent.max_by_key(|(_, silence)| *silence) else { return false };
        self.clients.swap_remove(at).end();
        true
    }
}

impl Client {
    /// How long no request has come from it, where that is too long; one that is about to be over says nothing any
    /// more.
    fn too_silent(&self, patience: Duration) -> Option<Duration> {
        let Some(connection) = self.connection.upgrade() else { return Some(Duration::MAX) };
        let patience = if connection.has_asked() { patience } else { patience.min(FIRST_REQUEST) };
        Some(connection.silence()).filter(|silence| *silence >= patience)
    }

    fn end(&self) {
        if let Some(connection) = self.connection.upgrade() {
            connection.end();
        }
    }
}

#[cfg(test)]
mod tests;
