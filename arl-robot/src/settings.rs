//! Reads TOML files of users key by key: errors have the line, the problem and the expected value.

use std::fmt::{self, Write};
use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// An error in a settings file, with its position.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct SettingsError {
    /// The file.
    pub file: String,
    /// Line from 1; 0 for the whole file.
    pub line: u32,
    /// Column from 1, in characters; 0 for the whole file.
    pub column: u32,
    /// The problem, and what would be right.
    pub message: String,
}

impl SettingsError {
    /// An error that concerns the whole file.
    pub fn of_file(file: &str, message: String) -> Self {
        Self { file: file.to_owned(), line: 0, column: 0, message }
    }
}

impl fmt::Display for SettingsError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(f, "{}: {}", self.file, self.message)
        } else {
            write!(f, "{}:{}:{}: {}", self.file, self.line, self.column, self.message)
        }
    }
}

impl std::error::Error for SettingsError {}

/// A value with its position.
pub type Value<'a> = Spanned<DeValue<'a>>;

/// The text that spans refer to.
#[derive(Clone, Copy, Debug)]
pub struct Source<'a> {
    /// The file's name in messages.
    pub file: &'a str,
    /// Its contents.
    pub text: &'a str,
}

impl<'a> Source<'a> {
    /// The whole text as a table.
    ///
    /// # Errors
    /// The text is not TOML.
    pub fn parse(self) -> Result<Spanned<DeTable<'a>>, SettingsError> {
        DeTable::parse(self.text).map_err(|error| {
            self.error(error.span().unwrap_or(0..0), format!("this is not TOML: {}", error.message().trim_end()))
        })
    }

    /// The line, from 1, that a byte of the text is on.
    pub fn line(self, offset: usize) -> u32 {
        let before = self.text.get(..offset).unwrap_or(self.text);
        before.bytes().filter(|byte| *byte == b'\n').count() as u32 + 1
    }

    /// An error at a span of the text.
    pub fn error(self, span: Range<usize>, message: impl Into<String>) -> SettingsError {
        let before = self.text.get(..span.start).unwrap_or(self.text);
        let column = before.rsplit('\n').next().map_or(0, |start| start.chars().count()) + 1;
        SettingsError {
            file: self.file.to_owned(),
            line: self.line(span.start),
            column: column as u32,
            message: message.into(),
        }
    }
}

/// A table with its name in messages.
#[derive(Clone, Copy, Debug)]
pub struct Section<'a> {
    /// The text that contains the table.
    pub source: Source<'a>,
    name: &'a str,
    table: &'a DeTable<'a>,
}

impl<'a> Section<'a> {
    /// A table; each key must be one of `known`.
    ///
    /// # Errors
    /// Another key.
    pub fn new(
        source: Source<'a>,
        name: &'a str,
        table: &'a DeTable<'a>,
        known: &[&str],
    ) -> Result<Self, SettingsError> {
        for key in table.keys() {
            let word: &str = key.get_ref().as_ref();
            if !known.contains(&word) {
                let message = format!("{name} has no key `{word}`; {}", hint(word, known));
                return Err(source.error(key.span(), message));
            }
        }
        Ok(Self { source, name, table })
    }

    /// The value of a key, if it exists.
    pub fn find(&self, key: &str) -> Option<&'a Value<'a>> {
        self.table.get(key)
    }

    /// Every key with its value, in the order of the file.
    pub fn entries(&self) -> Vec<(&'a str, Range<usize>, &'a Value<'a>)> {
        let mut entries: Vec<_> =
            self.table.iter().map(|(key, value)| (key.get_ref().as_ref(), key.span(), value)).collect();
        entries.sort_by_key(|(_, span, _)| span.start);
        entries
    }

    /// The table under `key`, if it exists.
    ///
    /// # Errors
    /// The value is not a table, or has a key that is not `known`.
    pub fn table(&self, key: &str, name: &'a str, known: &[&str]) -> Result<Option<Section<'a>>, SettingsError> {
        self.find(key).map(|value| table(self.source, value, name, known)).transpose()
    }

    /// The table under `key`, if it exists, with any keys.
    ///
    /// # Errors
    /// The value is not a table.
    pub fn free_table(&self, key: &str, name: &'a str) -> Result<Option<Section<'a>>, SettingsError> {
        let section = |table| Self { source: self.source, name, table };
        self.find(key).map(|value| items(self.source, value, name).map(section)).transpose()
    }

    /// A number within a range, if it exists.
    ///
    /// # Errors
    /// The value is not such a number.
    pub fn number(&self, key: &str, what: &str, low: f64, high: f64) -> Result<Option<f64>, SettingsError> {
        let Some(value) = self.find(key) else { return Ok(None) };
        let expected = format!("{what} from {low} to {high}");
        let number = number(value.get_ref()).ok_or_else(|| self.wrong(key, value, &expected))?;
        if (low..=high).contains(&number) { Ok(Some(number)) } else { Err(self.wrong(key, value, &expected)) }
    }

    /// A whole number from 0 to `high`, if it exists.
    ///
    /// # Errors
    /// The value is not such a number.
    pub fn count(&self, key: &str, what: &str, high: u32) -> Result<Option<u32>, SettingsError> {
        let Some(value) = self.find(key) else { return Ok(None) };
        let expected = format!("{what} from 0 to {high}");
        match number(value.get_ref()) {
            Some(number) if number.fract() == 0.0 && (0.0..=f64::from(high)).contains(&number) => {
                Ok(Some(number as u32))
            }
            _ => Err(self.wrong(key, value, &expected)),
        }
    }

    /// A text, if it exists.
    ///
    /// # Errors
    /// The value is not a text.
    pub fn text(&self, key: &str, what: &str) -> Result<Option<&'a str>, SettingsError> {
        let Some(value) = self.find(key) else { return Ok(None) };
        value.get_ref().as_str().map(Some).ok_or_else(|| self.wrong(key, value, what))
    }

    /// The meaning of one of a few words, if the key exists.
    ///
    /// # Errors
    /// The value is not one of them.
    pub fn word<T: Copy>(&self, key: &str, words: &[(&str, T)]) -> Result<Option<T>, SettingsError> {
        let Some(value) = self.find(key) else { return Ok(None) };
        let found = value.get_ref().as_str().and_then(|text| words.iter().find(|(word, _)| *word == text));
        found.map(|(_, meaning)| Some(*meaning)).ok_or_else(|| {
            let known: Vec<String> = words.iter().map(|(word, _)| format!("\"{word}\"")).collect();
            self.wrong(key, value, &known.join(" or "))
        })
    }

    /// The error for a value that is not what it should be.
    pub fn wrong(&self, key: &str, value: &Value<'_>, expected: &str) -> SettingsError {
        let found = kind(value.get_ref());
        self.source.error(value.span(), format!("`{key}` of {}: expected {expected}, found {found}", self.name))
    }
}

/// The table that a value must be; each key must be one of `known`.
///
/// # Errors
/// The value is not a table, or has another key.
pub fn table<'a>(
    source: Source<'a>,
    value: &'a Value<'a>,
    name: &'a str,
    known: &[&str],
) -> Result<Section<'a>, SettingsError> {
    Section::new(source, name, items(source, value, name)?, known)
}

/// The entries of a table.
fn items<'a>(source: Source<'_>, value: &'a Value<'a>, name: &str) -> Result<&'a DeTable<'a>, SettingsError> {
    match value.get_ref() {
        DeValue::Table(table) => Ok(table),
        other => Err(source.error(value.span(), format!("expected the table {name}, found {}", kind(other)))),
    }
}

/// A finite number, whole or not.
pub fn number(value: &DeValue<'_>) -> Option<f64> {
    let number = match value {
        DeValue::Float(float) => float.as_str().parse().ok()?,
        DeValue::Integer(integer) => i64::from_str_radix(integer.as_str(), integer.radix()).ok()? as f64,
        _ => return None,
    };
    f64::is_finite(number).then_some(number)
}

/// A description of a value for the reader.
pub fn kind(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text \"{text}\""),
        DeValue::Integer(number) => format!("the number {}", number.as_str()),
        DeValue::Float(number) => format!("the number {}", number.as_str()),
        DeValue::Boolean(flag) => format!("{flag}"),
        DeValue::Datetime(_) => "a date".to_owned(),
        DeValue::Array(_) => "an array".to_owned(),
        DeValue::Table(_) => "a table".to_owned(),
    }
}

/// A text in quotes, in the syntax of TOML and JSON.
pub fn quoted(text: &str) -> String {
    let mut out = String::from("\"");
    for c in text.chars() {
        match c {
            '"' | '\\' => out.extend(['\\', c]),
            c if c.is_control() => {
                let _ = write!(out, "\\u{:04x}", u32::from(c));
            }
            c => out.push(c),
        }
    }
    out.push('"');
    out
}

/// `did you mean ...?`, or a list of what exists.
pub fn hint(word: &str, known: &[&str]) -> String {
    match nearest(word, known) {
        Some(near) => format!("did you mean `{near}`?"),
        None => format!("expected one of: {}", known.join(", ")),
    }
}

/// The number of names listed if none is similar to the one searched for.
const LISTED: usize = 8;

/// `did you mean ...?`, or the number of names and some of them: for possibly many names.
pub fn hint_of_many(word: &str, known: &[&str]) -> String {
    match (nearest(word, known), known.get(..LISTED)) {
        (Some(near), _) => format!("did you mean `{near}`?"),
        (None, Some(first)) => format!("there are {}, like {}", known.len(), first.join(", ")),
        (None, None) if known.is_empty() => "there are none".to_owned(),
        (None, None) => format!("there are {}", known.join(", ")),
    }
}

/// The known name that `word` may mean.
pub fn nearest<'a>(word: &str, known: &[&'a str]) -> Option<&'a str> {
    let word = word.to_ascii_lowercase();
    let allowed = 1 + word.len() / 4;
    known
        .iter()
        .map(|candidate| (distance(word.as_bytes(), candidate.to_ascii_lowercase().as_bytes()), *candidate))
        .filter(|(distance, _)| *distance <= allowed)
        .min_by_key(|(distance, _)| *distance)
        .map(|(_, candidate)| candidate)
}

/// The number of letters to insert, delete or replace to turn one word into the other.
fn distance(from: &[u8], to: &[u8]) -> usize {
    let mut row: Vec<usize> = (0..=to.len()).collect();
    for (i, a) in from.iter().enumerate() {
        let mut diagonal = i;
        let mut left = i + 1;
        for (b, cell) in to.iter().zip(row.iter_mut().skip(1)) {
            let replaced = diagonal + usize::from(a != b);
            diagonal = *cell;
            left = replaced.min(left + 1).min(*cell + 1);
            *cell = left;
        }
        if let Some(first) = row.first_mut() {
            *first = i + 1;
        }
    }
    row.last().copied().unwrap_or(0)
}
