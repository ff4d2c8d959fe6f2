//! Listening to a run: the program connects and reports what happens, a line at a time, to all subscribers.
//!
//! The program connects to the listener, not the other way round, so the program's own streams stay its own.

use std::error::Error;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::process::{Child, Command, ExitStatus};

use arl_terminal::failure::Failure;
use arl_terminal::port::{Port, Secret};
use arl_terminal::show;
use arl_wire::Line;

/// The interval at which a program reports its state to subscribers that keep it, in s: the same as in every recording.
pub const STATE_INTERVAL: &str = "0.004";
/// The option of a program that gives the address of its listener.
pub const OPTION: &str = "--listener";

/// A receiver of the lines of a run.
pub trait Subscriber {
    /// Whether it wants the positions of the robots in each cycle.
    fn wants_each_cycle(&self) -> bool {
        false
    }

    /// Whether it wants to know at the end what each motion did.
    fn wants_each_motion(&self) -> bool {
        false
    }

    /// Takes a line; returns further lines for the subscribers after this one.
    fn receive(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>>;

    /// Called once no more lines will come.
    fn end(self: Box<Self>) -> Result<(), Box<dyn Error>> {
        Ok(())
    }

    /// The message for when it cannot continue: `the recording a.mcap is incomplete`.
    fn broken(&self) -> String;
}

/// A port for a program, and its subscribers.
pub struct Listener {
    port: Port,
    subscribers: Vec<Box<dyn Subscriber>>,
}

/// How much of a run was received.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Received {
    /// All of it.
    All,
    /// All but the lines that a run in real time could not wait to send.
    WithGaps,
    /// Its end is missing, or a line was not understood.
    Broken,
    /// Nothing: the program did not even begin, and has reported the reason.
    Nothing,
}

impl Listener {
    /// A listener for these subscribers, in this order; `None` if there are none.
    ///
    /// # Errors
    /// No port can be opened, or the system gives no random bytes.
    pub fn of(subscribers: Vec<Box<dyn Subscriber>>) -> Result<Option<Self>, Failure> {
        if subscribers.is_empty() {
            return Ok(None);
        }
        Ok(Some(Self { port: Port::open(Secret::new()?)?, subscribers }))
    }

    /// Adds the options that make the program report to this listener.
    pub fn ask(&self, command: &mut Command) {
        self.port.ask(command, OPTION);
        command.args(wishes(&self.subscribers));
    }

    /// Listens to the program until it has ended, whatever happens in between.
    ///
    /// # Errors
    /// The program cannot be waited for, or its port cannot be used.
    pub fn receive(self, program: &mut Child) -> std::io::Result<(ExitStatus, Received)> {
        let Self { port, subscribers } = self;
        match port.accept(|| program.try_wait())? {
            Err(ended) => Ok((ended, Received::Nothing)),
            Ok(stream) => {
                let received = receive(stream, subscribers);
                Ok((program.wait()?, received))
            }
        }
    }
}

/// Passes lines on until no more come. A subscriber that cannot continue is reported once; the program and the other
/// subscribers continue.
pub fn receive(stream: TcpStream, mut subscribers: Vec<Box<dyn Subscriber>>) -> Received {
    let mut stream = BufReader::new(stream);
    let mut bytes = Vec::new();
    let (mut begun, mut left_out, mut understood) = (false, None, true);
    while matches!(stream.read_until(b'\n', &mut bytes), Ok(1..)) {
        match serde_json::from_slice(&bytes) {
            Ok(line) => {
                begun |= matches!(line, Line::Hello(_));
                if let Line::Ended(count) = line {
                    left_out = Some(count);
                }
                pass_on(line, &mut subscribers);
            }
            // The program was ended in the middle of a line: that the end is missing is all there is to it.
            Err(_) if !bytes.ends_with(b"\n") => {}
            Err(error) => {
                if std::mem::replace(&mut understood, false) {
                    show::warning(&format!("cannot read a message of the program: {error}"));
                }
            }
        }
        bytes.clear();
    }
    end(subscribers, begun);
    match left_out {
        Some(0) if begun && understood => Received::All,
        Some(_) if begun && understood => Received::WithGaps,
        _ if begun => Received::Broken,
        _ => Received::Nothing,
    }
}

/// The text of an error, and of the causes that it does not name.
pub fn with_causes(error: &dyn Error) -> String {
    let mut words = error.to_string();
    let mut cause = error.source();
    while let Some(error) = cause {
        let more = error.to_string();
        if !words.contains(&more) {
            words = format!("{words}: {more}");
        }
        cause = error.source();
    }
    words
}

/// The options for what a program has to report to its subscribers.
pub fn wishes(subscribers: &[Box<dyn Subscriber>]) -> impl Iterator<Item = &'static str> {
    let each_cycle = subscribers.iter().any(|subscriber| subscriber.wants_each_cycle()).then_some("--each-cycle");
    let each_motion = subscribers.iter().any(|subscriber| subscriber.wants_each_motion()).then_some("--each-motion");
    each_cycle.into_iter().chain(each_motion)
}

/// Ends the subscribers once no more lines will come. A subscriber that cannot end well is reported.
pub fn end(mut subscribers: Vec<Box<dyn Subscriber>>, begun: bool) {
    if !begun {
        return;
    }
    // The program may have ended without a word.
    pass_on(Line::Ended(0), &mut subscribers);
    for subscriber in subscribers {
        let broken = subscriber.broken();
        if let Err(error) = subscriber.end() {
            show::warning(&format!("{broken}: {}", with_causes(&*error)));
        }
    }
}

/// Passes a line to all subscribers. A subscriber that cannot continue is reported, and gets no more lines.
pub fn pass_on(line: Line, subscribers: &mut Vec<Box<dyn Subscriber>>) {
    let mut lines = vec![line];
    subscribers.retain_mut(|subscriber| {
        let mut more = Vec::new();
        let received = lines.iter().try_for_each(|line| {
            more.extend(subscriber.receive(line)?);
            Ok::<(), Box<dyn Error>>(())
        });
        lines.extend(more);
        if let Err(error) = &received {
            show::warning(&format!("{}: {}", subscriber.broken(), with_causes(&**error)));
        }
        received.is_ok()
    });
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cause_of_what_cannot_be_recorded_is_named() {
        let full = std::io::Error::from(std::io::ErrorKind::StorageFull);
        let words = full.to_string();
        let error = mcap::McapError::Io(full);
        assert!(!error.to_string().contains(&words), "it says so itself now");
        assert!(with_causes(&error).ends_with(&format!(": {words}")), "{}", with_causes(&error));
        assert_eq!(with_causes(&std::io::Error::from(std::io::ErrorKind::StorageFull)), words);
    }
}
