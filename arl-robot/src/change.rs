//! Changes one value of a settings file, so that one file serves for many variants.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::settings::{SettingsError, Source, Value, hint, quoted};

/// The text of a settings file in which the value at `path` is `value`. The path consists of keys separated by points;
/// entries of lists count from 1: `axis.1.vel`. The last key may be a new one. A value that is not TOML becomes a
/// string.
///
/// ```
/// let text = "[[event]]\nat = 1.0\ndi.1 = true\n";
/// let later = arl_robot::change::set("s.toml", text, "event.1.at", "2.5")?;
/// assert_eq!(later, "[[event]]\nat = 2.5\ndi.1 = true\n");
/// # Ok::<(), arl_robot::settings::SettingsError>(())
/// ```
///
/// # Errors
/// The text is not TOML, or does not have this path.
pub fn set(file: &str, text: &str, path: &str, value: &str) -> Result<String, SettingsError> {
    let source = Source { file, text };
    let root = source.parse()?;
    let value = as_toml(value);
    let keys: Vec<&str> = path.split('.').collect();
    let (last, before) = keys.split_last().unwrap_or((&"", &[]));
    let mut place = Place { source, whole: path, walked: 0 };
    let mut at = Inner::Table(root.get_ref());
    for key in before {
        at = place.step(at, key)?;
    }
    match at {
        Inner::Table(table) => match table.get(*last) {
            Some(old) => place.replace(old, &value),
            None => place.insert(table, last, &value),
        },
        Inner::List(list) => {
            let at = place.number(last, list.len())?;
            list.get(at).map_or_else(|| Err(place.missing("")), |old| place.replace(old, &value))
        }
    }
}

/// A value with entries.
enum Inner<'a> {
    Table(&'a DeTable<'a>),
    List(&'a [Value<'a>]),
}

/// The progress in following a path.
struct Place<'a> {
    source: Source<'a>,
    whole: &'a str,
    walked: usize,
}

impl<'a> Place<'a> {
    fn step<'b>(&mut self, at: Inner<'b>, key: &str) -> Result<Inner<'b>, SettingsError> {
        let value = match at {
            Inner::Table(table) => table.get(key).ok_or_else(|| self.no_key(table, key))?,
            Inner::List(list) => {
                let at = self.number(key, list.len())?;
                list.get(at).ok_or_else(|| self.missing(""))?
            }
        };
        self.walked += 1;
        match value.get_ref() {
            DeValue::Table(table) => Ok(Inner::Table(table)),
            DeValue::Array(list) => Ok(Inner::List(list)),
            _ => Err(self.missing("this is neither a table nor a list")),
        }
    }

    /// The index of the entry with a number, from 0.
    fn number(&self, key: &str, count: usize) -> Result<usize, SettingsError> {
        let number = key.parse::<usize>().ok().filter(|number| (1..=count).contains(number));
        number
            .map(|number| number - 1)
            .ok_or_else(|| self.missing(&format!("`{key}` is not an entry: there are {count}, counted from 1")))
    }

    fn no_key(&self, table: &DeTable<'_>, key: &str) -> SettingsError {
        let known: Vec<&str> = table.keys().map(|known| known.get_ref().as_ref()).collect();
        self.missing(&format!("there is no `{key}`; {}", hint(key, &known)))
    }

    fn missing(&self, why: &str) -> SettingsError {
        let walked: Vec<&str> = self.whole.split('.').take(self.walked).collect();
        let at = if walked.is_empty() { String::new() } else { format!(" at `{}`", walked.join(".")) };
        SettingsError::of_file(self.source.file, format!("`{}` does not exist:{at} {why}", self.whole))
    }

    fn replace(&self, old: &Value<'_>, value: &str) -> Result<String, SettingsError> {
        let span = old.span();
        let is_written_out = match old.get_ref() {
            DeValue::Table(_) => self.source.text.get(span.start..).is_some_and(|text| text.starts_with('{')),
            DeValue::Array(list) => !list.iter().any(|entry| entry.get_ref().is_table()),
            _ => true,
        };
        if !is_written_out {
            return Err(self.missing("this has keys: name one of them"));
        }
        Ok(self.with(span, value))
    }

    /// Inserts a new key before the first one, in the same style.
    fn insert(&self, table: &DeTable<'_>, key: &str, value: &str) -> Result<String, SettingsError> {
        let is_key = |c: char| c.is_ascii_alphanumeric() || c == '_' || c == '-';
        if key.is_empty() || !key.chars().all(is_key) {
            return Err(self.missing(&format!("`{key}` is not a key")));
        }
        let text = self.source.text;
        let line_of = |at: usize| text.get(..at).and_then(|before| before.rfind('\n')).map_or(0, |end| end + 1);
        // The header of a table of its own is not a place for a key.
        let is_header = |at: &usize| {
            let before = text.get(line_of(*at)..*at).unwrap_or_default();
            before.trim_start().starts_with('[') && !before.contains('=')
        };
        let own = table.keys().map(|key| key.span().start).filter(|at| !is_header(at)).min();
        let first = match own {
            Some(first) => first,
            // The first lines of a file belong to the root table.
            None if self.walked == 0 => 0,
            None => return Err(self.missing("there is no key there beside which a new one could be put")),
        };
        let line = line_of(first);
        let before = text.get(line..first).unwrap_or_default();
        Ok(match before.contains(['{', '=', '[']) {
            true => self.with(first..first, &format!("{key} = {value}, ")),
            false => self.with(line..line, &format!("{before}{key} = {value}\n")),
        })
    }

    fn with(&self, span: Range<usize>, value: &str) -> String {
        let text = self.source.text;
        let (before, after) = (text.get(..span.start).unwrap_or_default(), text.get(span.end..).unwrap_or_default());
        format!("{before}{value}{after}")
    }
}

/// A value in TOML syntax.
fn as_toml(value: &str) -> String {
    let text = format!("v = {value}\n");
    let alone = !value.contains('\n') && DeTable::parse(&text).is_ok_and(|table| table.get_ref().len() == 1);
    if alone { value.to_owned() } else { quoted(value) }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "\
# A scenario.
[[event]]
at = 1.0 # s
di.1 = true

[[event]]
when = \"do.1\"
after = 0.15

[tcp]
limits = { velocity = 100, other = [1, 2] }
";

    fn lines(path: &str, value: &str) -> Vec<String> {
        let changed = set("s.toml", TEXT, path, value).unwrap();
        let old: Vec<&str> = TEXT.lines().collect();
        changed.lines().filter(|line| !old.contains(line)).map(str::to_owned).collect()
    }

    #[test]
    fn one_value_changes_and_the_rest_stays() {
        assert_eq!(lines("event.1.at", "2"), ["at = 2 # s"]);
        assert_eq!(lines("event.1.di.1", "false"), ["di.1 = false"]);
        assert_eq!(lines("event.2.when", "do.2"), ["when = \"do.2\""]);
        assert_eq!(lines("event.2.when", "say \"\\\u{1}"), ["when = \"say \\\"\\\\\\u0001\""]);
        assert_eq!(lines("tcp.limits.velocity", "5"), ["limits = { velocity = 5, other = [1, 2] }"]);
        assert_eq!(lines("tcp.limits.other.2", "5"), ["limits = { velocity = 100, other = [1, 5] }"]);
        assert_eq!(lines("tcp.limits", "{}"), ["limits = {}"]);
    }

    #[test]
    fn a_last_key_may_be_new() {
        assert_eq!(lines("event.2.at", "3"), ["at = 3"]);
        assert_eq!(lines("event.1.di.7", "true"), ["di.7 = true"]);
        assert_eq!(lines("loop", "true"), ["loop = true"]);
        assert!(set("s.toml", "[a.b]\nc = 1\n", "a.d", "1").is_err());
        assert_eq!(lines("tcp.limits.new", "1"), ["limits = { new = 1, velocity = 100, other = [1, 2] }"]);
    }

    #[test]
    fn what_is_not_there_is_reported() {
        for (path, words) in [
            ("event.3.at", "`3` is not an entry: there are 2, counted from 1"),
            ("event.0.at", "counted from 1"),
            ("event.at", "at `event` `at` is not an entry"),
            ("events.1.at", "there is no `events`; did you mean `event`?"),
            ("event.1.at.x", "at `event.1.at` this is neither a table nor a list"),
            ("tcp", "name one of them"),
            ("event", "name one of them"),
            ("event.2", "name one of them"),
            ("event.2.a b", "`a b` is not a key"),
            ("", "`` is not a key"),
        ] {
            let error = set("s.toml", TEXT, path, "1").unwrap_err().to_string();
            assert!(error.contains(words), "{path}: {error}");
        }
        assert!(set("s.toml", "a b", "a", "1").unwrap_err().to_string().contains("not TOML"));
    }
}
