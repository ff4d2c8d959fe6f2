//! Where `print` sends messages: the trait of outputs, a stream, and a buffer for tests.

use std::cell::RefCell;
use std::fmt;
use std::io::{self, BufWriter, Write};
use std::rc::Rc;

use crate::context::standard_error::tell;
use crate::cycle::channel_id::ChannelId;
use crate::values::Printto;

/// A message of a program.
#[derive(Clone, Copy, PartialEq, Debug)]
pub struct Message<'a> {
    /// Controller time in s.
    pub time: f64,
    /// The channel whose program printed it.
    pub channel: ChannelId,
    /// Whether it goes to the operator panel.
    pub hmi: bool,
    /// Whether it goes to the terminal.
    pub console: bool,
    /// The text as it was printed: as a rule UTF-8, without a newline that the program did not print.
    pub text: &'a [u8],
}

/// Takes the messages of a program. Any closure that takes a [`Message`] is one.
pub trait Output {
    /// Takes a message. One that goes to the operator panel and the terminal comes once.
    fn message(&mut self, message: &Message<'_>);

    /// Called at the end of a cycle with messages.
    fn flush(&mut self) {}
}

impl<F: FnMut(&Message<'_>)> Output for F {
    fn message(&mut self, message: &Message<'_>) {
        self(message);
    }
}

/// Writes messages to a stream, each ended by a newline.
pub struct Stream<W: Write> {
    stream: BufWriter<W>,
    /// The name under which a write error is reported; taken once it has been.
    name: Option<&'static str>,
}

impl<W: Write> Stream<W> {
    /// Writes to the stream through a buffer, which is emptied at the end of each cycle with messages.
    pub fn new(stream: W) -> Self {
        Self { stream: BufWriter::new(stream), name: None }
    }

    /// Reports a write error once. The other end may have been closed, or the disk be full: a robot does not stop for
    /// that.
    fn note(&mut self, written: io::Result<()>) {
        if let Err(error) = written
            && let Some(name) = self.name.take()
        {
            tell(format_args!("warning: {name} cannot be written: {error}; what the program prints is lost"));
        }
    }
}

impl Stream<std::io::Stdout> {
    /// The standard output. Where it cannot be written, standard error reports that once.
    pub fn standard() -> Self {
        Self { name: Some("standard output"), ..Self::new(io::stdout()) }
    }
}

impl<W: Write> fmt::Debug for Stream<W> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Stream")
    }
}

impl<W: Write> Output for Stream<W> {
    fn message(&mut self, message: &Message<'_>) {
        let end: &[u8] = if message.text.ends_with(b"\n") { b"" } else { b"\n" };
        let written = self.stream.write_all(message.text).and_then(|()| self.stream.write_all(end));
        self.note(written);
    }

    fn flush(&mut self) {
        let written = self.stream.flush();
        self.note(written);
    }
}

/// Keeps messages as text, each ended by a newline. Clones share the text, so that one can be passed to the controller
/// and the other be read.
#[derive(Clone, Default, Debug)]
pub struct Captured(Rc<RefCell<Vec<u8>>>);

impl Captured {
    /// An empty buffer.
    pub fn new() -> Self {
        Self::default()
    }

    /// All messages so far.
    pub fn text(&self) -> String {
        String::from_utf8_lossy(&self.0.borrow()).into_owned()
    }

    /// All messages since the last call.
    pub fn take(&self) -> String {
        String::from_utf8_lossy(&std::mem::take(&mut *self.0.borrow_mut())).into_owned()
    }
}

impl Output for Captured {
    fn message(&mut self, message: &Message<'_>) {
        let mut kept = self.0.borrow_mut();
        kept.extend_from_slice(message.text);
        if !message.text.ends_with(b"\n") {
            kept.push(b'\n');
        }
    }
}

/// Where `print` sends messages.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(crate) struct Targets {
    pub(crate) hmi: bool,
    pub(crate) file: bool,
    pub(crate) console: bool,
}

impl Targets {
    pub(crate) const NONE: Targets = Targets { hmi: false, file: false, console: false };

    /// These targets and one more; `off` cancels them.
    pub(crate) fn with(mut self, target: Printto) -> Self {
        match target {
            Printto::Off => return Self::NONE,
            Printto::Hmi => self.hmi = true,
            Printto::File => self.file = true,
            Printto::Console => self.console = true,
        }
        self
    }
}

impl Default for Targets {
    /// The operator panel.
    fn default() -> Self {
        Self { hmi: true, ..Self::NONE }
    }
}
