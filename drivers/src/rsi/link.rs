//! The socket to which the robot's controller sends.

use std::io::ErrorKind;
use std::net::{SocketAddr, UdpSocket};
use std::time::{Duration, Instant};

use arl_rt::motion::Joints;

use super::message::{Answer, LONGEST, Message};
use super::sender::Sender;
use crate::patience::Patience;
use crate::readable;

/// After this silence RSI may have restarted: with another time, from another port.
const ANEW: Duration = Duration::from_millis(500);
/// The most packets examined in a cycle, so that a sender of more cannot keep it from ending.
const MOST: usize = 64;

/// The state shared by the driver and the clock.
#[derive(Debug)]
pub(super) struct Link {
    listen: String,
    socket: Option<UdpSocket>,
    sender: Sender,
    newest: Option<Newest>,
    /// The message of this cycle, until it is taken.
    message: Option<Message>,
    /// RSI has restarted, or cycles continued without its messages: earlier commands no longer apply.
    interrupted: bool,
    /// The time of the message that was answered last, in ms.
    answered: Option<u64>,
    /// A robot without an answer for longer than this, in ms of its time, has given up.
    pub(super) given_up_ms: u64,
    /// Whether a packet has arrived that is not a message.
    odd: bool,
    /// How long to wait for the robot, if the run uses the robot's time.
    pub(super) patience: Option<Patience>,
}

/// The newest message that has arrived.
#[derive(Clone, Copy, Debug)]
struct Newest {
    from: SocketAddr,
    at: Instant,
    ipoc: u64,
    ready: bool,
}

/// The messages received in the wait of a cycle.
#[derive(Clone, Copy, Debug)]
pub(super) struct Received {
    /// Whether a message has arrived.
    pub(super) any: bool,
    /// The advance of the robot's time since the previous message, in ms.
    pub(super) step: u64,
    /// The number of messages that have arrived.
    pub(super) count: u64,
    /// Whether the message had arrived before the wait.
    pub(super) was_there: bool,
}

impl Link {
    /// A link that receives on `listen` from the robot at an address, or from the first sender.
    pub(super) fn new(listen: String, address: Option<String>) -> Self {
        Self {
            listen,
            socket: None,
            sender: Sender::new(address),
            newest: None,
            message: None,
            interrupted: false,
            answered: None,
            given_up_ms: u64::MAX,
            odd: false,
            patience: None,
        }
    }

    pub(super) fn open(&mut self) -> Result<(), String> {
        self.sender.resolve()?;
        let failed = |error: std::io::Error| format!("{}: {error}", self.listen);
        let socket = UdpSocket::bind(&self.listen).map_err(failed)?;
        socket.set_nonblocking(true).map_err(failed)?;
        self.socket = Some(socket);
        Ok(())
    }

    /// Waits for a message, before or after all cycles.
    pub(super) fn wait(&mut self, limit: Duration) -> Result<Message, String> {
        self.message = None;
        self.receive(Instant::now() + limit);
        self.message.ok_or_else(|| match self.odd {
            true => format!("what {} receives is not an RSI message, or it lacks AIPos or IPOC", self.listen),
            false => self.sender.missing(&self.listen, limit.as_secs()),
        })
    }

    /// Waits for the message of the next cycle. Of several messages the newest counts.
    pub(super) fn receive(&mut self, until: Instant) -> Received {
        let mut received = Received { any: self.message.is_some(), was_there: true, step: 0, count: 0 };
        for packet in 0.. {
            match self.take_packet() {
                Some(step) => {
                    received.any |= step > 0;
                    received.step = received.step.saturating_add(step);
                    received.count += u64::from(step > 0);
                    // A sender of packets that do not count gets no more time than the robot.
                    if packet >= MOST && (received.any || Instant::now() >= until) {
                        break;
                    }
                }
                None if received.any => break,
                None => {
                    received.was_there = false;
                    let Some(socket) = &self.socket else { break };
                    if !readable::wait_until(socket, until) {
                        break;
                    }
                }
            }
        }
        received
    }

    /// Takes a packet; returns the advance of the robot's time, 0 if the packet does not count; `None` if there is
    /// none.
    fn take_packet(&mut self) -> Option<u64> {
        let mut bytes = [0; LONGEST];
        let (length, from) = match self.socket.as_ref()?.recv_from(&mut bytes) {
            Ok(found) => found,
            Err(error) if matches!(error.kind(), ErrorKind::Interrupted | ErrorKind::ConnectionRefused) => {
                return Some(0);
            }
            Err(_) => return None,
        };
        if !self.sender.is_robot(from) {
            self.sender.note_other(from);
            return Some(0);
        }
        let Some(message) = bytes.get(..length).and_then(Message::parse) else {
            self.odd = true;
            return Some(0);
        };
        let at = Instant::now();
        let step = match self.newest {
            None => 1,
            Some(before) => {
                let is_same = from == before.from;
                let goes_on = is_same && message.ipoc > before.ipoc;
                let is_silent = at.saturating_duration_since(before.at) > ANEW && self.patience.is_none();
                if !goes_on && !is_silent {
                    if !is_same {
                        self.sender.note_other(from);
                    }
                    return Some(0);
                }
                let step = message.ipoc.saturating_sub(before.ipoc).max(1);
                let unanswered = self.answered.map_or(0, |answered| message.ipoc.saturating_sub(answered));
                self.interrupted |= is_silent || unanswered > self.given_up_ms;
                step
            }
        };
        self.sender.follow(from);
        self.newest = Some(Newest { from, at, ipoc: message.ipoc, ready: message.ready != Some(false) });
        self.message = Some(message);
        Some(step)
    }

    /// Puts a message back for the next cycle.
    pub(super) fn give_back(&mut self, message: Message) {
        self.message = Some(message);
    }

    /// The message of this cycle.
    pub(super) fn take(&mut self) -> Option<Message> {
        self.message.take()
    }

    /// Records that a cycle continued without a message.
    pub(super) fn note_silence(&mut self) {
        self.interrupted = true;
    }

    /// Returns a message for the user about the senders, once.
    pub(super) fn take_warning(&mut self) -> Option<String> {
        self.sender.take_warning(&self.listen)
    }

    /// Whether messages were interrupted since the last call.
    pub(super) fn take_interruption(&mut self) -> bool {
        std::mem::take(&mut self.interrupted)
    }

    /// Whether the robot has last reported its drives as on, or does not report their state.
    pub(super) fn is_ready(&self) -> bool {
        self.newest.is_some_and(|newest| newest.ready)
    }

    /// Answers the newest message.
    pub(super) fn answer(&mut self, correction: &Joints, external: usize, stop: bool) {
        let (Some(socket), Some(Newest { from, ipoc, .. })) = (&self.socket, self.newest) else { return };
        self.answered = Some(ipoc);
        let answer = Answer { ipoc, correction: *correction, external, stop }.to_bytes();
        // An answer that cannot be sent is late for the robot, which counts late answers.
        let _ = socket.send_to(answer.as_bytes(), from);
    }
}
