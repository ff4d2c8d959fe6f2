//! Streams of bytes that say when they are ready, and waiting for that.

use std::io::{self, ErrorKind, Read, Write};
use std::net::Shutdown;
use std::time::Instant;

use mio::net::TcpStream;
use mio::{Events, Poll, Token};

/// What wakes the thread: the cycle, or the stream.
pub(super) const WAKE: Token = Token(0);
pub(super) const STREAM: Token = Token(1);

/// A stream that says when it is ready instead of waiting.
pub(super) trait Stream: Read + Write {
    /// Says that nothing more will be sent; whether the other side can say the same.
    fn finish(&mut self) -> bool;
}

impl Stream for TcpStream {
    fn finish(&mut self) -> bool {
        self.shutdown(Shutdown::Write).is_ok()
    }
}

/// The result of a call that does not wait; nothing where the stream is not ready.
pub(super) fn attempt(mut call: impl FnMut() -> io::Result<usize>) -> io::Result<Option<usize>> {
    loop {
        match call() {
            Ok(count) => return Ok(Some(count)),
            Err(error) if matches!(error.kind(), ErrorKind::WouldBlock | ErrorKind::TimedOut) => return Ok(None),
            Err(error) if error.kind() == ErrorKind::Interrupted => {}
            Err(error) => return Err(error),
        }
    }
}

/// Waits until the stream is ready, the cycle wakes the thread, or the deadline has come.
pub(super) fn wait(poll: &mut Poll, events: &mut Events, deadline: Option<Instant>) -> io::Result<()> {
    let timeout = deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
    match poll.poll(events, timeout) {
        Err(error) if error.kind() != ErrorKind::Interrupted => Err(error),
        _ => Ok(()),
    }
}
