//! `print`: composes a message of values and sends it to the operator panel, the terminal, a file or a string.

use crate::context::cx::Cx;
use crate::context::output::Targets;
use crate::fault::Fault;
use crate::values::{NumBase, Printto, Str};

pub use crate::values::text::{Nested, Print, Style, Typed, nested, scan};

/// `print`: composes one message of values and sends it to the targets of `to`, or writes it to a string.
pub fn print<'a>() -> PrintMessage<'a> {
    PrintMessage { to: None, tostr: None, filepath: None, style: Style::START, text: Str::new(), problem: None }
}

/// A message under construction. Values use the style set before them.
#[derive(Debug)]
#[must_use = "an instruction does nothing until it is run"]
pub struct PrintMessage<'a> {
    to: Option<Targets>,
    tostr: Option<&'a mut Str>,
    filepath: Option<Str>,
    style: Style,
    text: Str,
    problem: Option<Fault>,
}

impl<'a> PrintMessage<'a> {
    /// Sends this message and those after it to this target, besides the targets of other `to` of this message; `off`
    /// cancels the ones before it.
    pub fn to(mut self, target: Printto) -> Self {
        self.to = Some(self.to.unwrap_or(Targets::NONE).with(target));
        self
    }

    /// Writes the message to this variable, and nowhere else.
    pub fn tostr(mut self, variable: &'a mut Str) -> Self {
        self.tostr = Some(variable);
        self
    }

    /// The file in the script directory for `to:file`; it applies to the messages after this one, too.
    pub fn filepath(mut self, path: &Str) -> Self {
        self.filepath = Some(path.clone());
        self
    }

    /// The significant digits of the doubles that follow; 0 counts as 1.
    pub fn precision(mut self, digits: i32) -> Self {
        match u32::try_from(digits) {
            Ok(digits) => self.style.precision = digits,
            Err(_) => {
                let problem = format!("precision is {digits}, but must be 0 or more").into();
                self.problem = Some(Fault::Domain { function: "print", problem });
            }
        }
        self
    }

    /// The base of the integers that follow.
    pub fn numbase(mut self, base: NumBase) -> Self {
        self.style.base = Some(base);
        self
    }

    /// Appends a value.
    pub fn argtoprint(mut self, value: &dyn Print) -> Self {
        value.print(&mut self.text, &self.style);
        self
    }

    /// Sends the message.
    ///
    /// # Errors
    /// The file has no name or cannot be written, or the precision is negative.
    pub fn run(self, cx: &Cx) -> Result<(), Fault> {
        if let Some(problem) = self.problem {
            return Err(problem);
        }
        let (modal_to, modal_path) = cx.print_to();
        if let Some(to) = self.to {
            modal_to.set(to);
        }
        if let Some(path) = self.filepath {
            modal_path.replace(path);
        }
        if let Some(variable) = self.tostr {
            *variable = self.text;
            return Ok(());
        }
        let to = modal_to.get();
        if to.file {
            if modal_path.borrow().is_empty() {
                let problem = "to:file needs a file name: filepath:\"...\"".into();
                return Err(Fault::Domain { function: "print", problem });
            }
            let mut text = self.text.as_bytes().to_vec();
            if !text.ends_with(b"\n") {
                text.push(b'\n');
            }
            cx.shared().scripts.append(&modal_path.borrow(), &text)?;
        }
        if to.hmi || to.console {
            cx.shared().message(cx.channel_state().id, to.hmi, to.console, self.text.as_bytes());
        }
        Ok(())
    }
}
