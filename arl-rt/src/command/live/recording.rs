//! A run that another program records: what `--live` says goes out to an address, in virtual time, too, and nothing comes in.
//!
//! A state goes out every 4 ms of controller time; where the robots are, in each cycle, if that is asked for. On the virtual clock the run waits where the recorder is slower, so that nothing is lost;
//! in real time no cycle waits, and what the recorder does not take in time is left out.

use std::cell::RefCell;
use std::io;
use std::net::TcpStream;

use super::line_writer::{IfFull, LineWriter, Messages, push_cycle, push_state};
use crate::command::report;
use crate::context::output::{Message, Output, Stream};
use crate::controller::Controller;
use crate::fault::Alarm;

/// How often a state goes out, in s.
const STATE_INTERVAL_S: f64 = 0.004;
/// So many bytes go out at once on the virtual clock.
const WAITING_BYTES: usize = 1 << 15;

/// The connection to a recorder.
pub(crate) struct Recording {
    voice: LineWriter,
    /// Whether it goes out in each cycle where the robots are.
    each_cycle: bool,
    /// What has not gone out yet, and how long it may get: a thread is woken less often then.
    waiting: RefCell<String>,
    most: usize,
}

impl Recording {
    /// Connects to the recorder that listens at an address.
    pub(crate) fn connect(address: &str, each_cycle: bool, in_real_time: bool) -> io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        let if_full = if in_real_time { IfFull::IsLost } else { IfFull::Waits };
        let most = if in_real_time { 0 } else { WAITING_BYTES };
        Ok(Self { voice: LineWriter::to(stream, if_full), each_cycle, waiting: RefCell::default(), most })
    }

    /// The standard output, and the recording beside it.
    pub(crate) fn output(&self) -> impl Output + use<> {
        Both { standard: Stream::standard(), recorded: self.voice.messages() }
    }

    /// A warning.
    pub(crate) fn warning(&self, text: &str) {
        self.empty();
        self.voice.warning(text);
    }

    /// An alarm.
    pub(crate) fn alarm(&self, alarm: &Alarm) {
        self.empty();
        self.voice.alarm(alarm);
    }

    /// What waits goes out.
    fn empty(&self) {
        let waiting = self.waiting.take();
        if !waiting.is_empty() {
            self.voice.states(waiting);
        }
    }

    /// What runs on which robots, before the first cycle.
    pub(crate) fn begin(&self, controller: &Controller) {
        self.voice.hello(controller);
        self.voice.state(controller);
    }

    /// A cycle has ended.
    pub(crate) fn cycle_ended(&self, controller: &Controller) {
        let every = controller.cycles(STATE_INTERVAL_S).max(1);
        let mut waiting = self.waiting.borrow_mut();
        if controller.cycle().is_multiple_of(every) {
            push_state(&mut waiting, controller);
        }
        if self.each_cycle {
            push_cycle(&mut waiting, controller);
        }
        if waiting.len() > self.most {
            let full = std::mem::replace(&mut *waiting, String::with_capacity(self.most + WAITING_BYTES / 8));
            self.voice.states(full);
        }
    }

    /// The run has ended: how everything stands, and what the motions did.
    pub(crate) fn run_ended(&self, controller: &Controller) {
        self.empty();
        self.voice.state(controller);
        let report = report::all_json(&controller.all_motions(), controller.time());
        report.lines().for_each(|object| self.voice.report(object));
    }
}

/// Two takers of messages.
struct Both {
    standard: Stream<io::Stdout>,
    recorded: Messages,
}

impl Output for Both {
    fn message(&mut self, message: &Message<'_>) {
        self.standard.message(message);
        self.recorded.message(message);
    }

    fn flush(&mut self) {
        self.standard.flush();
    }
}
