//! The thread of a connection opens a stream and transfers bytes both ways until the connection ends.

use std::io::{self, ErrorKind, Read, Write};
use std::time::{Duration, Instant};

use mio::{Events, Poll};

use super::line;
use super::opening::{self, Opening};
use super::shared::{LinkState, SharedConnection};
use super::slave;
use super::stream::{PolledStream, attempt, wait};

/// The stack of the thread. Resolving names needs most of it.
pub(super) const STACK_BYTES: usize = 512 << 10;

/// How many bytes are received at once.
const RECEIVED_BYTES: usize = 16 << 10;

/// How long a connection that is being closed waits for the other side to take what was sent.
const SEND_TIMEOUT: Duration = Duration::from_secs(1);

/// How long it then waits for the other side to close, too.
const CLOSE_TIMEOUT: Duration = Duration::from_millis(200);

/// Opens a connection and serves it until it ends.
pub(super) fn serve(shared: &SharedConnection, mut poll: Poll, opening: &Opening) {
    shared.end_after(|| match opening {
        Opening::Connect { host, port } => {
            run(shared, &mut poll, opening, |poll| opening::connect(shared, poll, host, *port))
        }
        Opening::Accept { host, port } => {
            run(shared, &mut poll, opening, |poll| opening::accept(shared, poll, host, *port))
        }
        Opening::Line(settings) => run(shared, &mut poll, opening, |poll| line::open(poll, settings)),
        Opening::Slave(settings) => slave::serve(shared, &mut poll, settings),
    });
}

/// Opens a stream and transfers bytes both ways; returns its final state. The stream is then closed.
fn run<S: PolledStream>(
    shared: &SharedConnection,
    poll: &mut Poll,
    opening: &Opening,
    open: impl FnOnce(&mut Poll) -> io::Result<Option<S>>,
) -> LinkState {
    const CLOSED: &str = "closed by the program";
    let mut stream = match open(poll) {
        Ok(Some(stream)) => stream,
        Ok(None) => return LinkState::Failed(CLOSED.into()),
        Err(error) => return LinkState::Failed(error.to_string()),
    };
    shared.opened(matches!(opening, Opening::Line(_)));
    LinkState::Lost(match exchange(shared, poll, &mut stream) {
        Ok(()) => CLOSED.into(),
        Err(error) => error.to_string(),
    })
}

/// The state of one direction.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Flow {
    /// Bytes were transferred; there may be more.
    Moving,
    /// There is nothing to send, or no room to receive.
    Nothing,
    /// The stream is not ready.
    Blocked,
}

/// Transfers bytes both ways until the cycle closes the connection.
fn exchange<S: PolledStream>(shared: &SharedConnection, poll: &mut Poll, stream: &mut S) -> io::Result<()> {
    let mut events = Events::with_capacity(4);
    let mut piece = vec![0; RECEIVED_BYTES];
    let mut flight = Flight::default();
    let mut deadline = None;
    loop {
        let closing = shared.is_closing();
        // Received bytes are taken before any are sent: a stream that is broken for sending may still hold some.
        let received = if closing { Flow::Nothing } else { receive(shared, stream, &mut piece)? };
        let sent = send(shared, stream, &mut flight)?;
        if closing {
            let until = *deadline.get_or_insert_with(|| Instant::now() + SEND_TIMEOUT);
            if sent == Flow::Nothing || Instant::now() >= until {
                return part(poll, &mut events, stream, &mut piece);
            }
        }
        // Readiness is reported once, when it begins: so both directions go on until the stream is not ready.
        if received != Flow::Moving && sent != Flow::Moving {
            wait(poll, &mut events, deadline)?;
        }
    }
}

/// Takes the received bytes, as far as there is room.
fn receive(shared: &SharedConnection, stream: &mut impl Read, piece: &mut [u8]) -> io::Result<Flow> {
    let room = shared.lock().inbox.room().min(piece.len());
    let Some(part) = piece.get_mut(..room).filter(|part| !part.is_empty()) else { return Ok(Flow::Nothing) };
    Ok(match attempt(|| stream.read(part))? {
        None => Flow::Blocked,
        Some(0) => return Err(io::Error::new(ErrorKind::UnexpectedEof, "the other side has closed it")),
        Some(count) => {
            shared.lock().inbox.push(part.get(..count).unwrap_or_default());
            Flow::Moving
        }
    })
}

/// Bytes on their way to the other side.
#[derive(Default)]
struct Flight {
    bytes: Vec<u8>,
    gone: usize,
}

/// Sends the next waiting bytes.
fn send(shared: &SharedConnection, stream: &mut impl Write, flight: &mut Flight) -> io::Result<Flow> {
    if flight.gone >= flight.bytes.len() {
        *flight = Flight { bytes: std::mem::take(&mut shared.lock().outbox), gone: 0 };
    }
    let Some(rest) = flight.bytes.get(flight.gone..).filter(|rest| !rest.is_empty()) else { return Ok(Flow::Nothing) };
    Ok(match attempt(|| stream.write(rest))? {
        None => Flow::Blocked,
        Some(count) => {
            flight.gone += count;
            Flow::Moving
        }
    })
}

/// Ends sending, and discards received bytes until the other side ends sending, too: a socket that is closed with
/// unread bytes makes the other side lose what was sent last.
fn part<S: PolledStream>(poll: &mut Poll, events: &mut Events, stream: &mut S, piece: &mut [u8]) -> io::Result<()> {
    let deadline = Instant::now() + CLOSE_TIMEOUT;
    if !stream.finish() {
        return Ok(());
    }
    while Instant::now() < deadline {
        match attempt(|| stream.read(piece)) {
            Ok(Some(1..)) => {}
            Ok(None) => wait(poll, events, Some(deadline))?,
            Ok(Some(0)) | Err(_) => return Ok(()),
        }
    }
    Ok(())
}
