//! A run with a listener: the lines of `--live` are sent to an address, in virtual time, too, and nothing is received.
//!
//! A state is sent every 4 ms of controller time. On request the positions of the robots are sent in each cycle, and at
//! the end what the motions did. On the virtual clock the run waits where the listener is slower, so that nothing is
//! lost; in real time no cycle waits, and lines that are not taken in time are left out and counted. When the listener
//! is gone, the robot stops on its path.

use std::cell::RefCell;
use std::io;

use super::line_writer::{IfFull, LineWriter, Messages, push_cycle, push_state};
use crate::command::{connection, report};
use crate::context::output::{Message, Output};
use crate::controller::Controller;
use crate::fault::Alarm;

/// How often a state is sent, in s.
const STATE_INTERVAL_S: f64 = 0.004;
/// How many bytes are sent at once on the virtual clock: so a thread is woken less often.
const WAITING_BYTES: usize = 1 << 15;

/// What a listener wants to receive besides messages, warnings and alarms.
#[derive(Clone, Copy, PartialEq, Debug)]
pub(crate) struct Wishes {
    /// The interval of states, in s, where orders are taken.
    pub(crate) state_interval: f64,
    /// The positions of the robots in each cycle.
    pub(crate) each_cycle: bool,
    /// What each motion did: at the end, or as they end where orders are taken.
    pub(crate) each_motion: bool,
}

impl Default for Wishes {
    fn default() -> Self {
        Self { state_interval: super::STATE_INTERVAL_S, each_cycle: false, each_motion: false }
    }
}

/// The connection to a listener.
pub(crate) struct Recording {
    writer: LineWriter,
    wishes: Wishes,
    /// Lines that have not been sent yet.
    waiting: RefCell<String>,
}

impl Recording {
    /// Connects to the listener at an address.
    pub(crate) fn connect(address: &str, wishes: Wishes) -> io::Result<Self> {
        let stream = connection::connect(address)?;
        Ok(Self { writer: LineWriter::to(stream, IfFull::Waits), wishes, waiting: RefCell::default() })
    }

    /// An output that passes on its messages to the recording as well.
    pub(crate) fn beside<O: Output>(&self, output: O) -> impl Output + use<O> {
        Both { output, recorded: self.writer.messages() }
    }

    /// Whether the listener is gone.
    pub(crate) fn is_gone(&self) -> bool {
        self.writer.is_gone()
    }

    /// Sends a warning.
    pub(crate) fn warning(&self, controller: &Controller, text: &str) {
        self.catch_up(controller);
        self.writer.warning(text);
    }

    /// Sends an alarm.
    pub(crate) fn alarm(&self, controller: &Controller, alarm: &Alarm) {
        self.catch_up(controller);
        self.writer.alarm(alarm);
    }

    /// Sends the current state: the following line belongs to this moment.
    fn catch_up(&self, controller: &Controller) {
        self.flush();
        if controller.cycle() > 0 {
            self.writer.state(controller);
        }
    }

    /// Sends the waiting lines.
    fn flush(&self) {
        let waiting = self.waiting.take();
        if !waiting.is_empty() {
            self.writer.states(waiting);
        }
    }

    /// Sends the programs and robots, before the first cycle.
    pub(crate) fn begin(&self, controller: &Controller) {
        self.writer.hello(controller);
    }

    /// To be called after each cycle.
    pub(crate) fn cycle_ended(&self, controller: &Controller) {
        let every = controller.cycles(STATE_INTERVAL_S);
        let mut waiting = self.waiting.borrow_mut();
        if controller.is_turn(every) {
            push_state(&mut waiting, controller, controller.last_time());
        }
        if self.wishes.each_cycle {
            push_cycle(&mut waiting, controller);
        }
        // A connection opened by a program makes virtual time real.
        let in_real_time = controller.is_real();
        self.writer.if_full(if in_real_time { IfFull::IsLost } else { IfFull::Waits });
        if waiting.len() > if in_real_time { 0 } else { WAITING_BYTES } {
            let full = std::mem::replace(&mut *waiting, String::with_capacity(WAITING_BYTES + WAITING_BYTES / 8));
            self.writer.states(full);
        }
    }

    /// Sends the final state, and what the motions did, at the end of the run. Returns how often something was left
    /// out.
    pub(crate) fn run_ended(&self, controller: &Controller) -> u64 {
        // No further cycle could be late.
        self.writer.if_full(IfFull::Waits);
        self.flush();
        self.writer.state(controller);
        if self.wishes.each_motion {
            let report = report::all_json(&controller.recorded_motions());
            report.lines().for_each(|object| self.writer.report(object));
        }
        self.writer.ended();
        self.writer.lost()
    }
}

impl Drop for Recording {
    /// A run that is dropped before its end has sent what happened until then.
    fn drop(&mut self) {
        self.flush();
    }
}

/// An output and the recording.
struct Both<O> {
    output: O,
    recorded: Messages,
}

impl<O: Output> Output for Both<O> {
    fn message(&mut self, message: &Message<'_>) {
        self.output.message(message);
        self.recorded.message(message);
    }

    fn flush(&mut self) {
        self.output.flush();
    }
}

#[cfg(test)]
mod tests {
    use std::io::{BufRead, BufReader};
    use std::net::TcpListener;

    use super::*;
    use crate::emit::*;

    struct Turn;

    impl crate::Program for Turn {
        fn file(&self) -> File {
            File::new("turn.arl")
        }
        fn family(&self) -> Family {
            Family::SixAxis
        }
        fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
            let target = Joint { j1: 10.0, j2: -90.0, j3: 90.0, j4: 0.0, j5: 45.0, j6: 0.0, ..Joint::default() };
            Box::pin(async move { motion::movej(target).run(cx).await.at(self.file(), 2) })
        }
    }

    /// The first number behind a word in a line, and the first list behind another.
    fn values_behind(line: &str, word: &str, list: &str) -> (String, String) {
        let behind = |word: &str| line.split_once(word).map_or("", |(_, rest)| rest);
        let until = |text: &str, end: char| text.split(end).next().unwrap_or_default().to_owned();
        (until(behind(word), ','), until(behind(list), ']'))
    }

    #[test]
    fn states_and_cycles_have_the_times_of_the_trace() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let address = listener.local_addr().unwrap().to_string();
        let recording = Recording::connect(&address, Wishes { each_cycle: true, ..Wishes::default() }).unwrap();
        let (stream, _) = listener.accept().unwrap();
        let mut controller = Controller::builder().build(Box::new(Turn)).unwrap();
        recording.begin(&controller);
        let mut rows = Vec::new();
        for _ in 0..101 {
            controller.step();
            rows.push(controller.trace_row());
            recording.cycle_ended(&controller);
        }
        drop(recording);
        let (mut cycles, mut states) = (0, 0);
        for line in BufReader::new(stream).lines().map(Result::unwrap) {
            let (time, axes) = values_behind(&line, "\"time\":", "\"axes\":[");
            let count = match &line {
                line if line.starts_with("{\"cycle\"") => &mut cycles,
                line if line.starts_with("{\"state\"") => &mut states,
                _ => continue,
            };
            *count += 1;
            let time: f64 = time.parse().unwrap();
            let row = rows.iter().find(|row| row[0] == time).unwrap_or_else(|| panic!("no row of {time} s"));
            let axes: Vec<f64> = axes.split(',').map(|axis| axis.parse().unwrap()).collect();
            // Numbers have six decimals.
            assert!(axes.iter().zip(&row[3..9]).all(|(sent, axis)| (sent - axis).abs() < 1e-6), "{row:?}: {line}");
        }
        assert_eq!((cycles, states), (101, 26), "each cycle, and every fourth one from the first one on");
        assert!(rows[100][3] - rows[99][3] > 1e-3, "it moves, faster than what is compared");
    }
}
