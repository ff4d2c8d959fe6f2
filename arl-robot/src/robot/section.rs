//! One table of a TOML file, read key by key, with errors that name line and column.

use std::ops::Range;

use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::RobotError;
use super::description::{LARGEST, LARGEST_LIMIT, SMALLEST};
use crate::settings::{hint, kind, number};

/// The text that spans refer to.
#[derive(Clone, Copy)]
pub(super) struct RobotSource<'a> {
    pub(super) file: &'a str,
    pub(super) text: &'a str,
}

impl RobotSource<'_> {
    pub(super) fn error(&self, span: Range<usize>, message: impl Into<String>) -> RobotError {
        RobotError::at(self.file, self.text, span, message.into())
    }
}

/// A table with its position and its name in messages.
#[derive(Clone, Copy)]
pub(super) struct RobotSection<'a> {
    pub(super) source: RobotSource<'a>,
    pub(super) name: &'a str,
    span_start: usize,
    table: &'a DeTable<'a>,
}

type Value<'a> = Spanned<DeValue<'a>>;

/// A number and its position.
type Placed = (f64, Range<usize>);

impl<'a> RobotSection<'a> {
    /// Takes the table under `span`; every key must be one of `known`.
    pub(super) fn new(
        source: RobotSource<'a>,
        name: &'a str,
        span: Range<usize>,
        table: &'a DeTable<'a>,
        known: &[&str],
    ) -> Result<Self, RobotError> {
        for key in table.keys() {
            let word: &str = key.get_ref().as_ref();
            if !known.contains(&word) {
                return Err(source.error(key.span(), format!("{name} has no key `{word}`; {}", hint(word, known))));
            }
        }
        Ok(Self { source, name, span_start: span.start, table })
    }

    /// The position of the section itself: its first character.
    pub(super) fn place(&self) -> Range<usize> {
        self.span_start..self.span_start
    }

    pub(super) fn find(&self, key: &str) -> Option<&'a Value<'a>> {
        self.table.get(key)
    }

    pub(super) fn span_of(&self, key: &str) -> Range<usize> {
        self.find(key).map_or(self.place(), Spanned::span)
    }

    fn need(&self, key: &str, what: &str) -> Result<&'a Value<'a>, RobotError> {
        self.find(key)
            .ok_or_else(|| self.source.error(self.place(), format!("{} lacks `{key}`: expected {what}", self.name)))
    }

    fn wrong(&self, key: &str, value: &Value<'_>, what: &str) -> RobotError {
        let found = kind(value.get_ref());
        self.source.error(value.span(), format!("`{key}` of {}: expected {what}, found {found}", self.name))
    }

    pub(super) fn text(&self, key: &str, what: &str) -> Result<&'a str, RobotError> {
        let value = self.need(key, what)?;
        value.get_ref().as_str().ok_or_else(|| self.wrong(key, value, what))
    }

    pub(super) fn flag(&self, key: &str) -> Result<Option<bool>, RobotError> {
        let Some(value) = self.find(key) else { return Ok(None) };
        value.get_ref().as_bool().map(Some).ok_or_else(|| self.wrong(key, value, "true or false"))
    }

    /// A length in mm, an angle in deg, or the like: no robot has a larger one than [`LARGEST`].
    pub(super) fn number(&self, key: &str, what: &str) -> Result<f64, RobotError> {
        let value = self.need(key, what)?;
        let number = number(value.get_ref()).ok_or_else(|| self.wrong(key, value, what))?;
        self.within(key, what, number, LARGEST)
    }

    /// A number above zero: a limit or a mass.
    pub(super) fn positive(&self, key: &str, what: &str) -> Result<f64, RobotError> {
        self.positive_to(key, what, LARGEST_LIMIT)
    }

    /// The length of a part, in mm, above zero.
    pub(super) fn positive_length(&self, key: &str, what: &str) -> Result<f64, RobotError> {
        self.positive_to(key, what, LARGEST)
    }

    fn positive_to(&self, key: &str, what: &str, most: f64) -> Result<f64, RobotError> {
        let value = self.need(key, what)?;
        let number = number(value.get_ref()).ok_or_else(|| self.wrong(key, value, what))?;
        if (SMALLEST..=most).contains(&number) {
            return Ok(number);
        }
        let message = format!("`{key}` of {} is {number:?}: expected {what}, from {SMALLEST:?} to {most:?}", self.name);
        Err(self.source.error(value.span(), message))
    }

    fn within(&self, key: &str, what: &str, number: f64, most: f64) -> Result<f64, RobotError> {
        if number.abs() <= most {
            return Ok(number);
        }
        let message = format!("`{key}` of {} is {number:?}: expected {what}, from -{most:?} to {most:?}", self.name);
        Err(self.source.error(self.span_of(key), message))
    }

    /// All numbers of an array, each with its position; `None` if the key is missing.
    pub(super) fn numbers(&self, key: &str, what: &str) -> Result<Option<Vec<Placed>>, RobotError> {
        let Some(value) = self.find(key) else { return Ok(None) };
        let array = value.get_ref().as_array().ok_or_else(|| self.wrong(key, value, what))?;
        let item = |item: &Value<'_>| number(item.get_ref()).map(|n| (n, item.span()));
        array
            .iter()
            .map(|value| item(value).ok_or_else(|| self.wrong(key, value, what)))
            .collect::<Result<_, _>>()
            .map(Some)
    }

    /// An array of exactly `N` numbers, none larger than `most`.
    pub(super) fn fixed<const N: usize>(&self, key: &str, what: &str, most: f64) -> Result<[f64; N], RobotError> {
        let value = self.need(key, what)?;
        let numbers: Vec<f64> = self.numbers(key, what)?.unwrap_or_default().iter().map(|(n, _)| *n).collect();
        numbers.iter().try_for_each(|number| self.within(key, what, *number, most).map(drop))?;
        let count = numbers.len();
        numbers.try_into().map_err(|_| {
            let message = format!("`{key}` of {}: expected {what}, found {count} of them", self.name);
            self.source.error(value.span(), message)
        })
    }
}
