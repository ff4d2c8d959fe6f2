//! Names of signals: `[names]` of a cell file.

use crate::channels::Channels;
use crate::settings::{Section, SettingsError};
use std::fmt;

/// A kind of signal.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub enum SignalKind {
    /// A digital input: `di`.
    DigitalInput,
    /// A digital output: `do`.
    DigitalOutput,
    /// An analog input: `ai`.
    AnalogInput,
    /// An analog output: `ao`.
    AnalogOutput,
    /// An internal input, read by `getintdi`: `internal`.
    InternalInput,
    /// An internal output, read by `getintdo`: `internal_do`.
    InternalOutput,
}

/// The names of the kinds in files.
const KINDS: [(&str, SignalKind); 6] = [
    ("di", SignalKind::DigitalInput),
    ("do", SignalKind::DigitalOutput),
    ("ai", SignalKind::AnalogInput),
    ("ao", SignalKind::AnalogOutput),
    ("internal", SignalKind::InternalInput),
    ("internal_do", SignalKind::InternalOutput),
];

impl SignalKind {
    /// All kinds, in the order of files.
    pub fn all() -> impl Iterator<Item = Self> {
        KINDS.into_iter().map(|(_, kind)| kind)
    }

    /// The name of the kind in files: `di`.
    pub fn text(self) -> &'static str {
        KINDS.iter().find(|(_, kind)| *kind == self).map_or("", |(text, _)| text)
    }

    /// The number of such signals in a cell.
    pub fn count(self, channels: &Channels) -> u32 {
        match self {
            Self::DigitalInput => channels.di,
            Self::DigitalOutput => channels.dout,
            Self::AnalogInput => channels.ai.len() as u32,
            Self::AnalogOutput => channels.ao.len() as u32,
            Self::InternalInput | Self::InternalOutput => channels.internal,
        }
    }
}

/// A signal: `di.5`.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Debug)]
pub struct Signal {
    /// Its kind.
    pub kind: SignalKind,
    /// Its channel, from 1.
    pub channel: u32,
}

impl Signal {
    /// Parses the notation of a signal in files.
    ///
    /// ```
    /// use arl_robot::cell::{Signal, SignalKind};
    /// let signal = Signal { kind: SignalKind::DigitalOutput, channel: 3 };
    /// assert_eq!(Signal::parse("do.3"), Some(signal));
    /// assert_eq!(signal.to_string(), "do.3");
    /// assert_eq!(Signal::parse("do.0"), None);
    /// ```
    pub fn parse(text: &str) -> Option<Self> {
        let (kind, channel) = text.split_once('.')?;
        let (_, kind) = KINDS.iter().find(|(known, _)| *known == kind)?;
        let number: u32 = channel.parse().ok().filter(|number| *number > 0)?;
        // `di.02` would be a second name for `di.2`.
        (number.to_string() == channel).then_some(Self { kind: *kind, channel: number })
    }
}

impl fmt::Display for Signal {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}.{}", self.kind.text(), self.channel)
    }
}

/// The names of a cell's signals.
#[derive(Clone, PartialEq, Eq, Default, Debug)]
pub struct Names(Vec<(Signal, String)>);

/// Names that no signal can have: keywords of scenarios.
const TAKEN: [&str; 20] = [
    "after",
    "ai",
    "ao",
    "at",
    "channel",
    "di",
    "do",
    "event",
    "follow",
    "force",
    "hand",
    "internal",
    "internal_do",
    "jog",
    "of",
    "override",
    "pendant",
    "signal",
    "torque",
    "when",
];

/// The form of the name of a signal, for messages.
const FORM: &str = "a name of letters, digits and `_` that does not begin with a digit, like \"part_present\"";

impl Names {
    /// Reads `[names]` of a cell file.
    ///
    /// # Errors
    /// A signal does not exist in the cell, or a name is invalid or occurs twice.
    pub fn read(top: &Section<'_>, channels: &Channels) -> Result<Self, SettingsError> {
        let Some(table) = top.free_table("names", "[names]")? else { return Ok(Self::default()) };
        let source = top.source;
        let mut names = Self::default();
        for (key, span, value) in table.entries() {
            let Some(signal) = Signal::parse(key) else {
                let text = format!("expected a signal, like \"di.1\" or \"do.3\", found `{key}`");
                return Err(source.error(span, text));
            };
            let count = signal.kind.count(channels);
            if signal.channel > count {
                let kind = signal.kind.text();
                return Err(
                    source.error(span, format!("there is no {signal}: the cell has {kind}.1 to {kind}.{count}"))
                );
            }
            let name = table.text(key, FORM)?.unwrap_or_default();
            let mut letters = name.chars();
            let begins = letters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '_');
            if !begins || !letters.all(|letter| letter.is_ascii_alphanumeric() || letter == '_') {
                return Err(table.wrong(key, value, FORM));
            }
            if TAKEN.contains(&name) {
                return Err(
                    source.error(value.span(), format!("`{name}` is a keyword of scenarios: choose another name"))
                );
            }
            if let Some(other) = names.signal(name) {
                return Err(source.error(value.span(), format!("`{name}` is already the name of {other}")));
            }
            names.0.push((signal, name.to_owned()));
        }
        Ok(names)
    }

    /// The name of a signal.
    pub fn of(&self, signal: Signal) -> Option<&str> {
        self.0.iter().find(|(known, _)| *known == signal).map(|(_, name)| name.as_str())
    }

    /// The signal of a name.
    pub fn signal(&self, name: &str) -> Option<Signal> {
        self.0.iter().find(|(_, known)| known == name).map(|(signal, _)| *signal)
    }

    /// All names, in the order of the file.
    pub fn iter(&self) -> impl Iterator<Item = (Signal, &str)> {
        self.0.iter().map(|(signal, name)| (*signal, name.as_str()))
    }
}

#[cfg(test)]
mod tests {
    use super::super::Cell;
    use super::*;

    fn names(text: &str) -> Result<Names, SettingsError> {
        Cell::parse("cell.toml", &format!("[names]\n{text}")).map(|cell| cell.names)
    }

    #[test]
    fn signals_have_names() {
        let names =
            names("\"di.1\" = \"part_present\"\n\"do.2\" = \"gripper\"\n\"internal_do.1\" = \"lamp\"\n").unwrap();
        let gripper = Signal { kind: SignalKind::DigitalOutput, channel: 2 };
        assert_eq!((names.of(gripper), names.signal("gripper")), (Some("gripper"), Some(gripper)));
        assert_eq!((names.of(Signal { channel: 3, ..gripper }), names.signal("di.1")), (None, None));
        let all: Vec<String> = names.iter().map(|(signal, name)| format!("{signal} {name}")).collect();
        assert_eq!(all, ["di.1 part_present", "do.2 gripper", "internal_do.1 lamp"]);
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, words) in [
            ("di1 = \"a\"", "expected a signal, like \"di.1\" or \"do.3\", found `di1`"),
            ("di.1 = \"a\"", "found `di`"),
            ("\"di.99\" = \"a\"", "there is no di.99: the cell has di.1 to di.64"),
            ("\"di.1\" = 3", "expected a name of letters"),
            ("\"di.1\" = \"part present\"", "expected a name of letters"),
            ("\"di.1\" = \"1st\"", "expected a name of letters"),
            ("\"di.1\" = \"pendant\"", "is a keyword of scenarios"),
            ("\"do.1\" = \"b\"\n\"di.1\" = \"b\"", "`b` is already the name of do.1"),
        ] {
            let error = names(text).unwrap_err();
            assert!(error.line >= 2 && error.message.contains(words), "{error}");
        }
    }
}
