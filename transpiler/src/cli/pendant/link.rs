//! The program behind the screen: what it says, line by line, and what it is told.

use std::collections::BTreeMap;
use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, Sender, channel};

use serde::Deserialize;

/// A line of the program. `arl-rt` documents them in its module `live`.
#[derive(Clone, PartialEq, Deserialize, Debug)]
#[serde(rename_all = "snake_case")]
pub(super) enum Line {
    /// The first line: what runs on which robots.
    Hello(Hello),
    /// How everything stands, 20 times a second.
    State(State),
    /// What is inside the program of a channel, while that is asked for.
    Inside(Inside),
    /// What the program printed.
    Message(Message),
    /// What is no alarm but worth a word.
    Warning(String),
    /// What stopped a program.
    Alarm(Alarm),
    /// An order that could not be carried out, and why.
    Refused(Refused),
    /// What came on the standard error.
    #[serde(skip)]
    Other(String),
}

/// What runs on which robots.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(default)]
pub(super) struct Hello {
    pub(super) channels: Vec<Runs>,
    /// What signals are called, by how files write them: `di.1`.
    pub(super) names: BTreeMap<String, String>,
}

/// What one channel runs.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Runs {
    pub(super) program: String,
    /// Absent in a background channel.
    pub(super) robot: Option<String>,
    pub(super) axes: Vec<Axis>,
}

/// An axis and its range, in its unit.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Axis {
    pub(super) name: String,
    pub(super) unit: String,
    pub(super) min: f64,
    pub(super) max: f64,
}

/// How everything stands.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct State {
    /// Controller time in s.
    pub(super) time: f64,
    pub(super) mode: String,
    /// %
    #[serde(rename = "override")]
    pub(super) speed_override: f64,
    pub(super) channels: Vec<Channel>,
    /// Levels in a row, from channel 1.
    pub(super) di: String,
    #[serde(rename = "do")]
    pub(super) dout: String,
    pub(super) ai: Vec<f64>,
    pub(super) ao: Vec<f64>,
}

/// How one channel stands.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Channel {
    pub(super) state: String,
    pub(super) file: String,
    pub(super) line: usize,
    pub(super) motion_file: String,
    /// 0: nothing has moved yet.
    pub(super) motion_line: usize,
    /// deg, mm
    pub(super) axes: Vec<f64>,
    /// x, y, z in mm, a, b, c in deg, in the world.
    pub(super) tcp: Vec<f64>,
}

/// The functions and variables of a channel.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(default)]
pub(super) struct Inside {
    /// From 1.
    pub(super) channel: usize,
    /// The functions that run, the innermost first.
    pub(super) frames: Vec<Function>,
    /// Variables of the innermost function, clocks and connections.
    pub(super) variables: Vec<Variable>,
    pub(super) handles: Vec<Variable>,
    /// Files with global variables.
    pub(super) files: Vec<Globals>,
}

impl Inside {
    /// In how many lines its variables are shown: one for each, and one for each file.
    pub(super) fn variable_lines(&self) -> usize {
        let of_files = self.files.iter().map(|file| 1 + file.variables.len() + file.handles.len());
        self.variables.len() + self.handles.len() + of_files.sum::<usize>()
    }
}

/// A function that runs, or the action of an event.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Function {
    pub(super) name: String,
    pub(super) file: String,
    pub(super) line: usize,
}

/// A variable and its value as a literal.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
pub(super) struct Variable {
    pub(super) name: String,
    pub(super) value: String,
}

/// The global variables of a file.
#[derive(Clone, PartialEq, Default, Deserialize, Debug)]
#[serde(default)]
pub(super) struct Globals {
    pub(super) file: String,
    pub(super) variables: Vec<Variable>,
    pub(super) handles: Vec<Variable>,
}

/// What the program printed.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Message {
    pub(super) time: f64,
    pub(super) text: String,
}

/// What stopped a program.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Alarm {
    pub(super) text: String,
}

/// An order that could not be carried out, and why.
#[derive(Clone, PartialEq, Deserialize, Debug)]
pub(super) struct Refused {
    pub(super) order: String,
    pub(super) why: String,
}

/// A program that runs, and is told what to do by lines.
pub(super) struct Link {
    child: Child,
    /// Gone once the program was told to leave.
    orders: Option<ChildStdin>,
    lines: Receiver<Line>,
}

impl Link {
    /// Starts the program.
    pub(super) fn start(mut command: Command) -> std::io::Result<Self> {
        command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped());
        let mut child = command.spawn()?;
        let (sender, lines) = channel();
        let (orders, out, err) = (child.stdin.take(), child.stdout.take(), child.stderr.take());
        read(out, sender.clone(), |line| serde_json::from_str(&line).unwrap_or(Line::Other(line)));
        read(err, sender, Line::Other);
        Ok(Self { child, orders, lines })
    }

    /// The next line that has come.
    pub(super) fn line(&self) -> Option<Line> {
        self.lines.try_recv().ok()
    }

    /// Tells the program something. One that has ended does not hear it, which shows by itself.
    pub(super) fn order(&mut self, order: &str) {
        if let Some(orders) = &mut self.orders {
            let _ = writeln!(orders, "{order}").and_then(|()| orders.flush());
        }
    }

    /// Lets the program stop the robot and end.
    pub(super) fn leave(&mut self) {
        self.orders = None;
    }

    /// The exit code, once the program has ended.
    pub(super) fn ended(&mut self) -> Option<u8> {
        let status = self.child.try_wait().ok().flatten()?;
        Some(u8::try_from(status.code().unwrap_or(1)).unwrap_or(1))
    }
}

impl Drop for Link {
    fn drop(&mut self) {
        self.orders = None;
        // As a rule it has ended. A robot never goes on without its pendant.
        if self.ended().is_none() {
            let _ = self.child.kill();
            let _ = self.child.wait();
        }
    }
}

/// Passes a stream's lines on until it ends.
fn read(stream: Option<impl Read + Send + 'static>, sender: Sender<Line>, line: fn(String) -> Line) {
    let Some(stream) = stream else { return };
    std::thread::spawn(move || {
        let mut bytes = Vec::new();
        let mut stream = BufReader::new(stream);
        while matches!(stream.read_until(b'\n', &mut bytes), Ok(1..)) {
            let text = String::from_utf8_lossy(&bytes).trim_end_matches(['\n', '\r']).to_owned();
            if sender.send(line(text)).is_err() {
                return;
            }
            bytes.clear();
        }
    });
}
