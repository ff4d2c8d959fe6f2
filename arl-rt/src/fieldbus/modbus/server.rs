//! A Modbus TCP server: one thread, which looks after all connections.

use std::io::{ErrorKind, Read, Write};
use std::net::SocketAddr;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

use mio::event::Event;
use mio::net::{TcpListener, TcpStream};
use mio::{Events, Interest, Poll, Registry, Token, Waker};

use super::SharedTables;
use super::mbap::{self, LONGEST_FRAME, Start};
use super::pdu::{self, Answer};

/// What is kept of a connection's bytes before the rest has to wait in the system's buffers.
const BUFFER: usize = 4 * LONGEST_FRAME;

/// How many reads a connection gets before it is the turn of the others.
const READS_IN_A_TURN: usize = 8;

/// A connection that has been silent for so long makes room for a new one.
const SILENCE: Duration = Duration::from_secs(60);

/// How long nobody is accepted after the system refused to.
const PAUSE: Duration = Duration::from_millis(100);

const LISTENER: Token = Token(usize::MAX);
const WAKER: Token = Token(usize::MAX - 1);

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
        let mut listener = TcpListener::bind(address)?;
        let address = listener.local_addr()?;
        let poll = Poll::new()?;
        poll.registry().register(&mut listener, LISTENER, Interest::READABLE)?;
        let waker = Waker::new(poll.registry(), WAKER)?;
        let stop = Arc::new(AtomicBool::new(false));
        let service = Service {
            poll,
            listener,
            refused: None,
            connections: (0..connections).map(|_| None).collect(),
            tables,
            stop: Arc::clone(&stop),
        };
        let thread = std::thread::Builder::new().name("modbus-tcp".into()).spawn(move || service.run())?;
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

/// What the thread works with.
struct Service {
    poll: Poll,
    listener: TcpListener,
    /// When the system last refused to accept a connection that waits.
    refused: Option<Instant>,
    connections: Vec<Option<Connection>>,
    tables: SharedTables,
    stop: Arc<AtomicBool>,
}

impl Service {
    fn run(mut self) {
        let mut events = Events::with_capacity(64);
        while !self.stop.load(Ordering::Acquire) {
            let busy = self.connections.iter().flatten().any(|connection| connection.has_work());
            let timeout = if busy { Some(Duration::ZERO) } else { self.refused.map(|_| PAUSE) };
            match self.poll.poll(&mut events, timeout) {
                Ok(()) => {}
                Err(error) if error.kind() == ErrorKind::Interrupted => continue,
                Err(_) => return,
            }
            let mut calls = self.refused.is_some_and(|since| since.elapsed() >= PAUSE);
            for event in &events {
                match event.token() {
                    LISTENER => calls = true,
                    WAKER => {}
                    Token(at) => {
                        if let Some(Some(connection)) = self.connections.get_mut(at) {
                            connection.note(event);
                        }
                    }
                }
            }
            for place in &mut self.connections {
                if place.as_mut().is_some_and(|connection| !connection.turn(&self.tables)) {
                    *place = None;
                }
            }
            if calls {
                self.accept();
            }
        }
    }

    fn accept(&mut self) {
        self.refused = None;
        loop {
            match self.listener.accept() {
                Ok((stream, _)) => {
                    if let Some(at) = self.place() {
                        let connection = Connection::new(stream, Token(at), self.poll.registry());
                        if let (Some(place), Ok(connection)) = (self.connections.get_mut(at), connection) {
                            *place = Some(connection);
                        }
                    }
                }
                Err(error) if error.kind() == ErrorKind::WouldBlock => return,
                Err(error) if matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::ConnectionAborted) => {}
                // No descriptors are left, for example: whoever waits is asked again later.
                Err(_) => {
                    self.refused = Some(Instant::now());
                    return;
                }
            }
        }
    }

    /// Where a new connection has room: a free place, or that of one which has been silent for long.
    fn place(&self) -> Option<usize> {
        let silent = |connection: &Connection| connection.heard.elapsed();
        if let Some(free) = self.connections.iter().position(Option::is_none) {
            return Some(free);
        }
        let taken = self.connections.iter().enumerate().filter_map(|(at, place)| Some((at, silent(place.as_ref()?))));
        taken.max_by_key(|(_, silence)| *silence).filter(|(_, silence)| *silence >= SILENCE).map(|(at, _)| at)
    }
}

/// A connection to a client.
struct Connection {
    stream: TcpStream,
    /// What has come and is not answered.
    input: Box<[u8; BUFFER]>,
    filled: usize,
    /// What has not been sent.
    output: Vec<u8>,
    sent: usize,
    readable: bool,
    writable: bool,
    /// The client sends no more. It is told once, maybe together with the last bytes.
    ended: bool,
    heard: Instant,
}

impl Connection {
    fn new(mut stream: TcpStream, token: Token, registry: &Registry) -> std::io::Result<Self> {
        stream.set_nodelay(true)?;
        registry.register(&mut stream, token, Interest::READABLE | Interest::WRITABLE)?;
        Ok(Self {
            stream,
            input: Box::new([0; BUFFER]),
            filled: 0,
            output: Vec::with_capacity(BUFFER + LONGEST_FRAME),
            sent: 0,
            readable: false,
            writable: true,
            ended: false,
            heard: Instant::now(),
        })
    }

    fn note(&mut self, event: &Event) {
        // A connection that is closed or broken says so to whoever reads or writes.
        self.ended |= event.is_read_closed() || event.is_error();
        self.readable |= event.is_readable() || self.ended;
        self.writable |= event.is_writable() || event.is_write_closed() || event.is_error();
    }

    /// Whether something can be done without the system saying so again.
    fn has_work(&self) -> bool {
        let pending = self.sent < self.output.len();
        if pending { self.writable } else { self.readable }
    }

    /// Reads, serves and sends for a while; false: the connection is over.
    fn turn(&mut self, tables: &SharedTables) -> bool {
        for _ in 0..READS_IN_A_TURN {
            if !self.send() {
                return false;
            }
            // Nothing is read while the client does not take its answers.
            if self.sent < self.output.len() || !self.readable {
                return true;
            }
            if !self.receive() || !self.serve(tables) {
                return false;
            }
        }
        self.send()
    }

    fn receive(&mut self) -> bool {
        let room = self.input.get_mut(self.filled..).unwrap_or_default();
        let asked = room.len();
        match self.stream.read(room) {
            Ok(0) => false,
            Ok(count) => {
                self.filled += count;
                // A read that comes back short has emptied the system's buffer: it will tell when more comes, but the end.
                self.readable = count == asked || self.ended;
                self.heard = Instant::now();
                true
            }
            Err(error) => match error.kind() {
                ErrorKind::WouldBlock => {
                    self.readable = false;
                    true
                }
                ErrorKind::Interrupted => true,
                _ => false,
            },
        }
    }

    /// Answers all requests that are whole; false: this is no Modbus.
    fn serve(&mut self, tables: &SharedTables) -> bool {
        let mut done = 0;
        let mut answer = Answer::new();
        let sound = loop {
            let rest = self.input.get(done..self.filled).unwrap_or_default();
            match mbap::first(rest) {
                Start::Frame(frame, len) => {
                    pdu::serve(frame.pdu, &mut tables.wait(), &mut answer);
                    mbap::append(&mut self.output, &mbap::Frame { pdu: answer.bytes(), ..frame });
                    done += len;
                }
                Start::Part => break true,
                Start::Garbage => break false,
            }
        };
        self.input.copy_within(done..self.filled, 0);
        self.filled -= done;
        sound
    }

    fn send(&mut self) -> bool {
        while self.writable && self.sent < self.output.len() {
            match self.stream.write(self.output.get(self.sent..).unwrap_or_default()) {
                Ok(0) => return false,
                Ok(count) => self.sent += count,
                Err(error) => match error.kind() {
                    ErrorKind::WouldBlock => self.writable = false,
                    ErrorKind::Interrupted => {}
                    _ => return false,
                },
            }
        }
        if self.sent == self.output.len() {
            self.output.clear();
            self.sent = 0;
        }
        true
    }
}

#[cfg(test)]
mod tests;
