//! A run that another program records: what `--live` says goes out to an address, in virtual time, too, and nothing comes in.
//!
//! A state goes out every 4 ms of controller time. On the virtual clock the run waits where the recorder is slower, so that nothing is lost;
//! in real time no cycle waits, and what the recorder does not take in time is left out.

use std::io;
use std::net::TcpStream;

use super::line_writer::{IfFull, LineWriter, Messages};
use crate::command::report;
use crate::context::output::{Message, Output, Stream};
use crate::controller::Controller;

/// How often a state goes out, in s.
const STATE_INTERVAL_S: f64 = 0.004;

/// The connection to a recorder.
pub(crate) struct Recording {
    voice: LineWriter,
}

impl Recording {
    /// Connects to the recorder that listens at an address.
    pub(crate) fn connect(address: &str, in_real_time: bool) -> io::Result<Self> {
        let stream = TcpStream::connect(address)?;
        let if_full = if in_real_time { IfFull::IsLost } else { IfFull::Waits };
        Ok(Self { voice: LineWriter::to(stream, if_full) })
    }

    /// The standard output, and the recording beside it.
    pub(crate) fn output(&self) -> impl Output + use<> {
        Both { standard: Stream::standard(), recorded: self.voice.messages() }
    }

    /// The one to tell of warnings and alarms.
    pub(crate) fn voice(&self) -> &LineWriter {
        &self.voice
    }

    /// What runs on which robots, before the first cycle.
    pub(crate) fn begin(&self, controller: &Controller) {
        self.voice.hello(controller);
        self.voice.state(controller);
    }

    /// A cycle has ended.
    pub(crate) fn cycle_ended(&self, controller: &Controller) {
        let every = controller.cycles(STATE_INTERVAL_S).max(1);
        if controller.cycle().is_multiple_of(every) {
            self.voice.state(controller);
        }
    }

    /// The run has ended: how everything stands, and what the motions did.
    pub(crate) fn run_ended(&self, controller: &Controller) {
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
