//! A run that is listened to: the program connects, and says a line at a time what happens, to all who want to know.
//!
//! The program connects to the listener, not the other way round: so its own streams stay its own.

use std::error::Error;
use std::io::{BufRead, BufReader};
use std::net::TcpStream;
use std::process::{Child, Command, ExitStatus};

use arl_terminal::failure::Failure;
use arl_terminal::port::{Port, Secret};
use arl_terminal::show;
use arl_wire::Line;

/// How often a program says how everything stands to those who keep it, in s: as in every recording.
pub const STATE_INTERVAL: &str = "0.004";
/// The option of a program that tells where it is listened to.
pub const OPTION: &str = "--listener";

/// Who wants to know what happens in a run.
pub trait Hears {
    /// Whether it wants to hear in each cycle where the robots are.
    fn wants_each_cycle(&self) -> bool {
        false
    }

    /// Whether it wants to hear at the end what each motion did.
    fn wants_each_motion(&self) -> bool {
        false
    }

    /// Takes in a line; gives what those behind it are to hear besides.
    fn hear(&mut self, line: &Line) -> Result<Vec<Line>, Box<dyn Error>>;

    /// Nothing more will come.
    fn end(self: Box<Self>) -> Result<(), Box<dyn Error>> {
        Ok(())
    }

    /// The program did not even begin, and has said why.
    fn nothing_began(self: Box<Self>) {}

    /// What is told where it cannot go on: `the recording a.mcap is incomplete`.
    fn broken(&self) -> String;
}

/// A port for a program, and who hears it.
pub struct Listener {
    port: Port,
    hearers: Vec<Box<dyn Hears>>,
}

/// How much of a run was heard.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Heard {
    /// All of it.
    All,
    /// All but what the run could not wait to say: it was in real time.
    WithGaps,
    /// Not its begin, or not its end; or something was not understood.
    Broken,
}

impl Listener {
    /// For those who want to hear, in this order; `None` where nobody does.
    ///
    /// # Errors
    /// No port can be opened, or the system gives no random bytes.
    pub fn of(hearers: Vec<Box<dyn Hears>>) -> Result<Option<Self>, Failure> {
        if hearers.is_empty() {
            return Ok(None);
        }
        Ok(Some(Self { port: Port::open(Secret::new()?)?, hearers }))
    }

    /// Has the program say what happens.
    pub fn ask(&self, command: &mut Command) {
        self.port.ask(command, OPTION);
        command.args(wishes(&self.hearers));
    }

    /// Hears the program until it has ended, whatever comes between.
    ///
    /// # Errors
    /// The program cannot be waited for, or its port is of no use.
    pub fn hear(self, program: &mut Child) -> std::io::Result<(ExitStatus, Heard)> {
        let Self { port, hearers } = self;
        match port.accept(|| program.try_wait())? {
            Err(ended) => {
                hearers.into_iter().for_each(Hears::nothing_began);
                Ok((ended, Heard::Broken))
            }
            Ok(stream) => {
                let heard = hear(stream, hearers);
                Ok((program.wait()?, heard))
            }
        }
    }
}

/// Passes on what comes until nothing comes any more. Who cannot go on is told of once; the program and the others go
/// on.
pub fn hear(stream: TcpStream, mut hearers: Vec<Box<dyn Hears>>) -> Heard {
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
                pass_on(line, &mut hearers);
            }
            Err(error) => {
                if std::mem::replace(&mut understood, false) {
                    show::warning(&format!("cannot read a message of the program: {error}"));
                }
            }
        }
        bytes.clear();
    }
    end(hearers, begun);
    match left_out {
        Some(0) if begun && understood => Heard::All,
        Some(_) if begun && understood => Heard::WithGaps,
        _ => Heard::Broken,
    }
}

/// The words of an error, and of the causes that they do not name.
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

/// What a program is to say for those who hear it.
pub fn wishes(hearers: &[Box<dyn Hears>]) -> impl Iterator<Item = &'static str> {
    let each_cycle = hearers.iter().any(|hearer| hearer.wants_each_cycle()).then_some("--each-cycle");
    let each_motion = hearers.iter().any(|hearer| hearer.wants_each_motion()).then_some("--each-motion");
    each_cycle.into_iter().chain(each_motion)
}

/// Nothing more will come. Who cannot end well is told of.
pub fn end(mut hearers: Vec<Box<dyn Hears>>, begun: bool) {
    if !begun {
        return hearers.into_iter().for_each(Hears::nothing_began);
    }
    // The program may have ended without a word.
    pass_on(Line::Ended(0), &mut hearers);
    for hearer in hearers {
        let broken = hearer.broken();
        if let Err(error) = hearer.end() {
            show::warning(&format!("{broken}: {}", with_causes(&*error)));
        }
    }
}

/// Has all hear a line. Who cannot go on is told of, and hears no more.
pub fn pass_on(line: Line, hearers: &mut Vec<Box<dyn Hears>>) {
    let mut lines = vec![line];
    hearers.retain_mut(|hearer| {
        let mut more = Vec::new();
        let heard = lines.iter().try_for_each(|line| {
            more.extend(hearer.hear(line)?);
            Ok::<(), Box<dyn Error>>(())
        });
        lines.extend(more);
        if let Err(error) = &heard {
            show::warning(&format!("{}: {}", hearer.broken(), with_causes(&**error)));
        }
        heard.is_ok()
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
