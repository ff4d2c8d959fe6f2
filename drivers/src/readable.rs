//! Waits for a packet with microsecond resolution. The timeout of sockets counts in ticks of the kernel: 4 ms or more.

use std::net::UdpSocket;
use std::time::Instant;

/// Waits until there is something to receive or the time is over; returns whether there is. A socket with an error also
/// counts as readable.
#[cfg(unix)]
pub(crate) fn wait_until(socket: &UdpSocket, until: Instant) -> bool {
    use rustix::event::{PollFd, PollFlags, Timespec, poll};
    use rustix::io::Errno;
    loop {
        let remaining = until.saturating_duration_since(Instant::now());
        let Ok(remaining) = Timespec::try_from(remaining) else { return false };
        match poll(&mut [PollFd::new(socket, PollFlags::IN)], Some(&remaining)) {
            Ok(count) => return count > 0,
            Err(Errno::INTR) => {}
            Err(_) => return false,
        }
    }
}

/// Like the version above, with the timeout of sockets.
#[cfg(not(unix))]
pub(crate) fn wait_until(socket: &UdpSocket, until: Instant) -> bool {
    let remaining = until.saturating_duration_since(Instant::now());
    let limit = remaining.max(std::time::Duration::from_micros(1));
    let is_there = socket.set_nonblocking(false).is_ok()
        && socket.set_read_timeout(Some(limit)).is_ok()
        // A packet larger than the buffer is an error there, but it has arrived.
        && !matches!(socket.peek(&mut [0; 1]), Err(error) if error.kind() == std::io::ErrorKind::TimedOut);
    socket.set_nonblocking(true).is_ok() && is_there
}
