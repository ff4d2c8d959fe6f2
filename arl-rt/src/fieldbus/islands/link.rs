//! A connection to an island: one request, one answer.

use std::io::{ErrorKind, Read, Write};
use std::net::{SocketAddr, TcpStream};
use std::time::{Duration, Instant};

use crate::fieldbus::modbus::mbap::{self, HEAD, LONGEST_FRAME, ModbusFrame, Received};

const NO_ANSWER: &str = "what it sends is not a Modbus TCP response";

/// A connection to a Modbus TCP server, for a thread that may wait.
pub(super) struct IslandLink {
    stream: TcpStream,
    unit: u8,
    timeout: Duration,
    transaction: u16,
    frame: Vec<u8>,
    buffer: [u8; LONGEST_FRAME],
}

impl IslandLink {
    /// Connects to an island.
    ///
    /// # Errors
    /// The reason why that is not possible, as a part of a message.
    pub(super) fn open(address: SocketAddr, unit: u8, timeout: Duration) -> Result<Self, String> {
        let open = || {
            let stream = TcpStream::connect_timeout(&address, timeout)?;
            stream.set_nodelay(true)?;
            stream.set_write_timeout(Some(timeout))?;
            Ok(stream)
        };
        let stream = open().map_err(|error: std::io::Error| format!("cannot connect to it: {error}"))?;
        let frame = Vec::with_capacity(LONGEST_FRAME);
        Ok(Self { stream, unit, timeout, transaction: 0, frame, buffer: [0; LONGEST_FRAME] })
    }

    /// Sends a request and waits for the answer.
    ///
    /// # Errors
    /// The reason why there is no answer, as a part of a message; the connection is no longer usable.
    pub(super) fn ask(&mut self, request: &[u8]) -> Result<&[u8], String> {
        self.transaction = self.transaction.wrapping_add(1);
        self.frame.clear();
        mbap::append(&mut self.frame, &ModbusFrame { transaction: self.transaction, unit: self.unit, pdu: request });
        let start = Instant::now();
        self.stream.write_all(&self.frame).map_err(|error| self.problem(&error))?;
        let mut filled = 0;
        loop {
            match mbap::first(self.buffer.get(..filled).unwrap_or_default()) {
                Received::Part => {}
                // An unrequested frame, or the answer to another request, is not an answer to this one.
                Received::Frame(frame, len)
                    if len == filled && frame.transaction == self.transaction && frame.unit == self.unit =>
                {
                    break;
                }
                Received::Frame(frame, _) => {
                    return Err(format!("{NO_ANSWER} to this request: {}", self.difference(frame)));
                }
                Received::Garbage => return Err(NO_ANSWER.into()),
            }
            let remaining = self.timeout.saturating_sub(start.elapsed());
            if remaining.is_zero() {
                return Err(self.silence());
            }
            self.stream.set_read_timeout(Some(remaining)).map_err(|error| error.to_string())?;
            match self.stream.read(self.buffer.get_mut(filled..).unwrap_or_default()) {
                Ok(0) => return Err("it has closed the connection".into()),
                Ok(count) => filled += count,
                Err(error) if error.kind() == ErrorKind::Interrupted => {}
                Err(error) => return Err(self.problem(&error)),
            }
        }
        Ok(self.buffer.get(HEAD..filled).unwrap_or_default())
    }

    /// The reason why a frame is not the answer to the last request.
    fn difference(&self, frame: ModbusFrame<'_>) -> String {
        match frame {
            ModbusFrame { unit, .. } if unit != self.unit => {
                format!("unit {unit} answers instead of unit {}", self.unit)
            }
            ModbusFrame { transaction, .. } if transaction != self.transaction => {
                format!("it answers request number {transaction} instead of {}", self.transaction)
            }
            _ => "more data follows the response".into(),
        }
    }

    fn problem(&self, error: &std::io::Error) -> String {
        match error.kind() {
            ErrorKind::WouldBlock | ErrorKind::TimedOut => self.silence(),
            _ => format!("the connection is broken: {error}"),
        }
    }

    fn silence(&self) -> String {
        format!("it has not answered for {} ms", self.timeout.as_millis())
    }
}
