//! The target of a connection, and how sockets connect and accept.

use std::fmt;
use std::io;
use std::net::{IpAddr, SocketAddr, ToSocketAddrs};
use std::time::{Duration, Instant};

use mio::net::{TcpListener, TcpStream};
use mio::{Events, Interest, Poll};

use super::line::LineSettings;
use super::shared::SharedConnection;
use super::slave::SlaveSettings;
use super::stream::{STREAM, wait};

/// How long one attempt to reach an address may take. A host that was switched off during an attempt is found sooner by
/// a new attempt than by the repetitions of the old one.
const CONNECT_TIMEOUT: Duration = Duration::from_secs(3);

/// The kind of a connection and its target.
#[derive(Clone, PartialEq, Eq, Debug)]
pub(crate) enum Opening {
    /// To a server.
    Connect {
        /// Its address or name.
        host: String,
        /// Its port.
        port: u16,
    },
    /// From the first client that connects to this port of ours.
    Accept {
        /// The address or name to listen on.
        host: String,
        /// The port.
        port: u16,
    },
    /// A serial line.
    Line(LineSettings),
    /// A serial line on which we are a Modbus slave.
    Slave(SlaveSettings),
}

impl Opening {
    /// Whether a port or a device of ours is held while the connection is being opened.
    pub(crate) fn is_exclusive(&self) -> bool {
        !matches!(self, Opening::Connect { .. })
    }

    /// Whether a lost connection may be opened again without having been closed: true for a client (manual 5.6.1.5).
    pub(crate) fn is_free_of_closing(&self) -> bool {
        matches!(self, Opening::Connect { .. })
    }
}

impl fmt::Display for Opening {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Opening::Connect { host, port } => write!(f, "to {host}:{port}"),
            Opening::Accept { host, port } => write!(f, "on {host}:{port}"),
            Opening::Line(settings) => write!(f, "{settings}"),
            Opening::Slave(settings) => write!(f, "{}", settings.line),
        }
    }
}

/// Connects to the first address of a host that answers; `None` where the program closes the connection meanwhile.
pub(super) fn connect(
    shared: &SharedConnection,
    poll: &mut Poll,
    host: &str,
    port: u16,
) -> io::Result<Option<TcpStream>> {
    let mut last = io::Error::new(io::ErrorKind::NotFound, "the name has no address");
    for address in resolve(host, port)? {
        match reach(shared, poll, address) {
            Ok(stream) => return Ok(stream),
            Err(error) => last = error,
        }
    }
    Err(last)
}

fn reach(shared: &SharedConnection, poll: &mut Poll, address: SocketAddr) -> io::Result<Option<TcpStream>> {
    let mut stream = TcpStream::connect(address)?;
    poll.registry().register(&mut stream, STREAM, Interest::READABLE | Interest::WRITABLE)?;
    let deadline = Instant::now() + CONNECT_TIMEOUT;
    let mut events = Events::with_capacity(4);
    loop {
        if shared.is_closing() {
            return Ok(None);
        }
        if let Some(error) = stream.take_error()? {
            return Err(error);
        }
        if stream.peer_addr().is_ok() {
            return ready(stream).map(Some);
        }
        if Instant::now() >= deadline {
            return Err(io::Error::new(io::ErrorKind::TimedOut, "no answer"));
        }
        wait(poll, &mut events, Some(deadline))?;
    }
}

/// Waits for the first client; `None` where the program closes the connection meanwhile.
pub(super) fn accept(
    shared: &SharedConnection,
    poll: &mut Poll,
    host: &str,
    port: u16,
) -> io::Result<Option<TcpStream>> {
    let address = resolve(host, port)?.into_iter().next();
    let address = address.ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "the name has no address"))?;
    let mut listener = TcpListener::bind(address)?;
    poll.registry().register(&mut listener, STREAM, Interest::READABLE)?;
    let mut events = Events::with_capacity(4);
    loop {
        if shared.is_closing() {
            return Ok(None);
        }
        match listener.accept() {
            Ok((mut stream, _)) => {
                poll.registry().deregister(&mut listener)?;
                poll.registry().register(&mut stream, STREAM, Interest::READABLE | Interest::WRITABLE)?;
                return ready(stream).map(Some);
            }
            Err(error) if error.kind() == io::ErrorKind::WouldBlock => wait(poll, &mut events, None)?,
            // The client disconnected before it was accepted.
            Err(error) if matches!(error.kind(), io::ErrorKind::ConnectionAborted | io::ErrorKind::Interrupted) => {}
            Err(error) => return Err(error),
        }
    }
}

/// Has messages sent at once: they are short, and the other side waits for the answer.
fn ready(stream: TcpStream) -> io::Result<TcpStream> {
    stream.set_nodelay(true)?;
    Ok(stream)
}

/// The addresses of a host, IPv4 first. Resolving names may take a while.
fn resolve(host: &str, port: u16) -> io::Result<Vec<SocketAddr>> {
    if let Ok(address) = host.parse::<IpAddr>() {
        return Ok(vec![SocketAddr::new(address, port)]);
    }
    let mut addresses: Vec<SocketAddr> = (host, port).to_socket_addrs()?.collect();
    addresses.sort_by_key(SocketAddr::is_ipv6);
    Ok(addresses)
}
