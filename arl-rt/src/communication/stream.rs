//! Streams of bytes that report when they are ready, and waiting for that.

use std::io::{self, ErrorKind, Read, Write};
use std::net::Shutdown;
use std::time::Instant;

use mio::net::TcpStream;
use mio::{Events, Poll, Token};

/// The sources that wake the thread: the cycle, and the stream.
pub(super) const WAKE: Token = Token(0);
pub(super) const STREAM: Token = Token(1);

/// A stream that reports when it is ready instead of waiting.
pub(super) trait PolledStream: Read + Write {
    /// Ends sending; returns whether the other side can do so, too.
    fn finish(&mut self) -> bool;
}

impl PolledStream for TcpStream {
    fn finish(&mut self) -> bool {
        self.shutdown(Shutdown::Write).is_ok()
    }
}

/// The result of a call that does not wait; `None` where the stream is not ready.
pub(super) fn attempt(mut call: impl FnMut() -> io::Result<usize>) -> io::Result<Option<usize>> {
    loop {
        match call() {
            Ok(count) => return Ok(Some(count)),
            Err(error) if error.kind() == ErrorKind::WouldBlock => return Ok(None),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_peer_that_is_given_up_by_the_system_is_lost_and_not_waited_for() {
        assert_eq!(attempt(|| Err(ErrorKind::WouldBlock.into())).ok(), Some(None));
        // The system repeats for minutes what is sent to a computer that was switched off; then it reports this error,
        // once.
        let given_up = attempt(|| Err(io::Error::from(ErrorKind::TimedOut)));
        assert_eq!(given_up.map_err(|error| error.kind()), Err(ErrorKind::TimedOut));
        let mut interrupted = true;
        let found = attempt(|| match std::mem::take(&mut interrupted) {
            true => Err(ErrorKind::Interrupted.into()),
            false => Ok(3),
        });
        assert_eq!(found.ok(), Some(Some(3)));
    }
}
