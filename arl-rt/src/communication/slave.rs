//! The thread of a Modbus RTU slave: it answers by itself, so that the master need not wait for the cycle.

use std::fmt;
use std::io::{Error, ErrorKind};
use std::time::{Duration, Instant};

use mio::{Events, Poll};

use super::line::{self, LineSettings};
use super::shared::{LinkState, SharedConnection};
use super::stream::{PolledStream, attempt, wait};
use crate::fieldbus::modbus::SharedTables;
use crate::fieldbus::modbus::pdu::{self, Answer};
use crate::fieldbus::modbus::rtu::{self, LONGEST_FRAME, ReceiveBuffer, Request};
use crate::values::{Parity, Stopbits};

/// How long the rest of a request may take. Adapters pass on what they received in pieces, so that 3.5 characters
/// between two pieces do not mean that a request is complete.
const REQUEST_TIMEOUT: Duration = Duration::from_millis(50);

/// How long the line may take for an answer: twice the time at the lowest speed.
const ANSWER_TIMEOUT: Duration = Duration::from_secs(2);

/// The settings of a slave.
#[derive(Clone, PartialEq, Eq)]
pub(crate) struct SlaveSettings {
    pub(crate) line: LineSettings,
    /// Its station number.
    pub(crate) unit: u8,
    pub(crate) tables: SharedTables,
}

impl fmt::Debug for SlaveSettings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SlaveSettings").field("line", &self.line).field("unit", &self.unit).finish_non_exhaustive()
    }
}

impl SlaveSettings {
    /// The silence that ends a request: 3.5 characters, 1.75 ms at least.
    fn silence(&self) -> Duration {
        let line = &self.line;
        let extra = u8::from(line.parity != Parity::None) + if line.stop == Stopbits::Two { 2 } else { 1 };
        let bits = f64::from(1 + line.bits + extra);
        Duration::from_secs_f64(3.5 * bits / f64::from(line.baud)).max(Duration::from_micros(1750))
    }
}

/// Opens the line and serves it; returns its final state.
pub(super) fn serve(shared: &SharedConnection, poll: &mut Poll, settings: &SlaveSettings) -> LinkState {
    let mut stream = match line::open(poll, &settings.line) {
        Ok(Some(stream)) => stream,
        Ok(None) => return LinkState::Failed("closed by the program".into()),
        Err(error) => return LinkState::Failed(error.to_string()),
    };
    shared.opened(true);
    LinkState::Lost(match exchange(shared, poll, &mut stream, settings) {
        Ok(()) => "closed by the program".into(),
        Err(error) => error.to_string(),
    })
}

fn exchange(
    shared: &SharedConnection,
    poll: &mut Poll,
    stream: &mut impl PolledStream,
    settings: &SlaveSettings,
) -> std::io::Result<()> {
    let mut events = Events::with_capacity(4);
    let mut buffer = ReceiveBuffer::default();
    let mut last = Instant::now();
    let mut piece = [0; LONGEST_FRAME];
    while !shared.is_closing() {
        match attempt(|| stream.read(&mut piece))? {
            Some(0) => return Err(Error::new(ErrorKind::UnexpectedEof, "the line is gone")),
            Some(count) => {
                buffer.push(piece.get(..count).unwrap_or_default(), last.elapsed() >= settings.silence());
                last = Instant::now();
                continue;
            }
            None => {}
        }
        let silent = last.elapsed();
        if !buffer.is_empty() && silent >= settings.silence() {
            while let Some(request) = buffer.take() {
                answer(shared, poll, stream, settings, &request)?;
            }
            if silent >= REQUEST_TIMEOUT {
                buffer.clear();
            }
        }
        let patience = if last.elapsed() < settings.silence() { settings.silence() } else { REQUEST_TIMEOUT };
        let deadline = (!buffer.is_empty()).then(|| last + patience);
        wait(poll, &mut events, deadline)?;
    }
    Ok(())
}

/// Carries out a request, and answers it; ignores one for another slave.
fn answer(
    shared: &SharedConnection,
    poll: &mut Poll,
    stream: &mut impl PolledStream,
    settings: &SlaveSettings,
    request: &Request,
) -> std::io::Result<()> {
    if request.unit != settings.unit && request.unit != BROADCAST {
        return Ok(());
    }
    let mut answer = Answer::new();
    pdu::serve(&request.pdu, &mut settings.tables.wait(), &mut answer);
    match request.unit {
        BROADCAST => Ok(()),
        unit => send(shared, poll, stream, &rtu::frame(unit, answer.bytes())),
    }
}

/// The station number for every slave; no slave answers.
const BROADCAST: u8 = 0;

/// Sends an answer; it is lost where the line does not take it.
fn send(
    shared: &SharedConnection,
    poll: &mut Poll,
    stream: &mut impl PolledStream,
    bytes: &[u8],
) -> std::io::Result<()> {
    let mut events = Events::with_capacity(4);
    let deadline = Instant::now() + ANSWER_TIMEOUT;
    let mut sent = 0;
    while sent < bytes.len() && Instant::now() < deadline && !shared.is_closing() {
        match attempt(|| stream.write(bytes.get(sent..).unwrap_or_default()))? {
            Some(count) => sent += count,
            None => wait(poll, &mut events, Some(deadline))?,
        }
    }
    Ok(())
}
