//! A Modbus TCP server: a thread that accepts clients, and one for each of them.
//!
//! A thread that waits for only one connection needs one system call to receive a request and one to answer it, and the
//! system wakes it sooner than a thread that waits for several connections.

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

/// The silence after which a connection makes room for a new one.
const IDLE_TIMEOUT: Duration = Duration::from_secs(60);

/// The same for a connection that has never sent a request.
const FIRST_REQUEST: Duration = Duration::from_secs(5);

/// The pause without accepting clients after the system has refused to.
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
    /// Listens at an address and serves the tables, on at most `connections` connections at once.
    ///
    /// # Errors
    /// The address or port does not exist, is in use or is not allowed; or no thread can be started.
    pub(crate) fn start(address: SocketAddr, connections: usize, tables: SharedTables) -> std::io::Result<Self> {
        Self::with_patience(IDLE_TIMEOUT, address, connections, tables)
    }

    /// A server in which a connection that has been silent for `patience` makes room.
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

    /// The address on which the server listens.
    pub(crate) fn address(&self) -> SocketAddr {
        self.address
    }
}

impl Drop for Server {
    fn drop(&mut self) {
        self.stop.store(true, Ordering::Release);
        // A thread that could not be woken is not joined, as that could wait for ever.
        if self.waker.wake().is_ok()
            && let Some(thread) = self.thread.take()
        {
            let _ = thread.join();
        }
    }
}

/// The data of the thread that accepts clients.
struct Door {
    poll: Poll,
    listener: TcpListener,
    /// The system has refused to accept a waiting client.
    refused: bool,
    /// The most clients that are served at once.
    most: usize,
    patience: Duration,
    clients: Vec<Client>,
    tables: SharedTables,
    stop: Arc<AtomicBool>,
}

/// A client being served.
struct Client {
    /// The thread owns the connection, and closes it at its end.
    connection: Weak<Connection>,
    thread: JoinHandle<()>,
}

impl Door {
    fn run(mut self) {
        let mut events = Events::with_capacity(4);
        while !self.stop.load(Ordering::Acquire) {
            match self.poll.poll(&mut events, self.refused.then_some(ACCEPT_PAUSE)) {
                // After a panic, the client concerned is rejected; others can still connect.
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

    /// Accepts all waiting clients.
    fn accept(&mut self) {
        self.refused = false;
        loop {
            match self.listener.accept() {
                Ok((stream, _)) => self.admit(stream),
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                Err(error) if matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::ConnectionAborted) => {}
                // No descriptors are left, for example: waiting clients are accepted later.
                Err(_) => {
                    self.refused = true;
                    return;
                }
            }
        }
    }

    /// Serves a client if there is room; otherwise, or if the system has no thread for it, rejects it.
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

    /// Whether one more client can be served, possibly in place of one that has been silent for long.
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
    /// How long the client has sent no request, if that is too long; `Duration::MAX` if its connection is about to end.
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
