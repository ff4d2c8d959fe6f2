//! A connection of the server to a client, and the work of its thread.

use std::io::{ErrorKind, Read, Result, Write};
use std::net::{Shutdown, TcpStream};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::{Duration, Instant};

use crate::fieldbus::modbus::SharedTables;
use crate::fieldbus::modbus::mbap::{self, LONGEST_FRAME, Received};
use crate::fieldbus::modbus::pdu::{self, Answer};

/// The most received bytes that are kept; further ones wait in the system's buffers. Complete frames are answered at
/// once, so that there is always room for the rest of a frame.
const BUFFER_BYTES: usize = 4 * LONGEST_FRAME;

/// A connection to a client.
pub(super) struct Connection {
    stream: TcpStream,
    since: Instant,
    /// The time of the last request after `since`, in ms.
    last_request_ms: AtomicU64,
    /// Whether any request has arrived.
    has_asked: AtomicBool,
}

impl Connection {
    /// A connection that a client has opened.
    ///
    /// # Errors
    /// The client has disconnected again.
    pub(super) fn new(stream: mio::net::TcpStream) -> Result<Self> {
        let stream = TcpStream::from(stream);
        stream.set_nonblocking(false)?;
        stream.set_nodelay(true)?;
        Ok(Self {
            stream,
            since: Instant::now(),
            last_request_ms: AtomicU64::new(0),
            has_asked: AtomicBool::new(false),
        })
    }

    /// The time since the last request; bytes that are not a request do not count.
    pub(super) fn silence(&self) -> Duration {
        self.since.elapsed().saturating_sub(Duration::from_millis(self.last_request_ms.load(Ordering::Relaxed)))
    }

    /// Whether any request has arrived.
    pub(super) fn has_asked(&self) -> bool {
        self.has_asked.load(Ordering::Relaxed)
    }

    /// Ends the connection, whatever its thread waits for.
    pub(super) fn end(&self) {
        // This fails if the connection has already ended.
        let _ = self.stream.shutdown(Shutdown::Both);
    }

    /// Answers requests until the client disconnects, sends bytes that are not Modbus, or the connection is ended.
    /// While a client does not accept its answers, nothing more is read from it.
    pub(super) fn serve(&self, tables: &SharedTables) {
        let (mut input, mut filled) = ([0; BUFFER_BYTES], 0);
        let mut answers = Vec::with_capacity(BUFFER_BYTES + LONGEST_FRAME);
        while let Some(count @ 1..) = self.receive(input.get_mut(filled..).unwrap_or_default()) {
            filled += count;
            let (done, sound) = answer(input.get(..filled).unwrap_or_default(), tables, &mut answers);
            if done > 0 {
                self.last_request_ms.store(self.since.elapsed().as_millis() as u64, Ordering::Relaxed);
                self.has_asked.store(true, Ordering::Relaxed);
            }
            if (&self.stream).write_all(&answers).is_err() || !sound {
                return;
            }
            answers.clear();
            input.copy_within(done..filled, 0);
            filled -= done;
        }
    }

    /// Waits for bytes and returns their number, 0 at the end; `None` if the connection is broken.
    fn receive(&self, room: &mut [u8]) -> Option<usize> {
        loop {
            match (&self.stream).read(room) {
                Ok(count) => return Some(count),
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(_) => return None,
            }
        }
    }
}

/// Answers all complete requests; returns their size in bytes, and whether the following bytes can be Modbus.
fn answer(bytes: &[u8], tables: &SharedTables, answers: &mut Vec<u8>) -> (usize, bool) {
    let mut done = 0;
    let mut answer = Answer::new();
    loop {
        match mbap::first(bytes.get(done..).unwrap_or_default()) {
            Received::Frame(frame, len) => {
                pdu::serve(frame.pdu, &mut tables.wait(), &mut answer);
                mbap::append(answers, &mbap::ModbusFrame { pdu: answer.bytes(), ..frame });
                done += len;
            }
            Received::Part => return (done, true),
            Received::Garbage => return (done, false),
        }
    }
}
