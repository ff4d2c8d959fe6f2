//! `[external]` of the cell file: how a PLC is wired to the controller (manual, chapter 9).

use crate::channels::Channels;
use crate::settings::{Section, SettingsError, Value, number};

/// The meaning of a key.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Kind {
    /// A digital input, or a row of as many as the program number has.
    Input { row: bool },
    /// The input of the parity: negative for odd.
    Parity,
    /// A digital output, and the length of the row that it begins.
    Output { row: Row },
    /// A number in this range.
    Number(i32, i32),
}

/// The number of outputs in a row.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Row {
    One,
    Two,
    /// As many as the program number has inputs.
    Number,
}

/// A key of `[external]`: the name of a system variable in lower case.
struct Key {
    name: &'static str,
    kind: Kind,
}

macro_rules! keys {
    ($($name:ident: $kind:expr),* $(,)?) => {
        &[$(Key { name: stringify!($name), kind: $kind }),*]
    };
}

const INPUT: Kind = Kind::Input { row: false };
const OUTPUT: Kind = Kind::Output { row: Row::One };

const KEYS: &[Key] = keys! {
    ext_ctl_act_di: INPUT,
    servo_on_di: INPUT,
    servo_off_di: INPUT,
    start_prog_di: INPUT,
    pause_prog_di: INPUT,
    reset_prog_di: INPUT,
    clear_alarm_di: INPUT,
    pgno_type: Kind::Number(0, 2),
    pgno_length: Kind::Number(1, 16),
    pgno_fbit_di: Kind::Input { row: true },
    pgno_parity_di: Kind::Parity,
    pgno_valid_di: INPUT,
    ext_ctl_act_conf_do: OUTPUT,
    servo_on_do: OUTPUT,
    pgno_req_do: OUTPUT,
    at_t1_do: OUTPUT,
    at_t2_do: OUTPUT,
    at_aut_do: OUTPUT,
    pgno_ack_fbit_do: Kind::Output { row: Row::Number },
    chan_state_do: Kind::Output { row: Row::Two },
    at_home_do: OUTPUT,
};

/// The one key that has five values.
const AT_HOME: &str = "at_home_do";

/// How a PLC is wired to the controller.
#[derive(Clone, PartialEq, Debug)]
pub struct Wiring {
    /// Whether external control is enabled at all.
    pub enabled: bool,
    /// Keys and their values.
    given: Vec<(&'static str, Vec<i32>)>,
}

impl Default for Wiring {
    fn default() -> Self {
        Self { enabled: true, given: Vec::new() }
    }
}

impl Wiring {
    /// Reads `[external]` of a cell with these channels.
    ///
    /// # Errors
    /// The values are not a wiring, or a channel does not exist in the cell.
    pub fn read(top: &Section<'_>, channels: &Channels) -> Result<Wiring, SettingsError> {
        let known: Vec<&str> = std::iter::once("enabled").chain(KEYS.iter().map(|key| key.name)).collect();
        let Some(section) = top.table("external", "[external]", &known)? else { return Ok(Wiring::default()) };
        let mut wiring = Wiring::default();
        if let Some(value) = section.find("enabled") {
            let enabled = value.get_ref().as_bool();
            wiring.enabled = enabled.ok_or_else(|| section.wrong("enabled", value, "true or false"))?;
        }
        for key in KEYS.iter() {
            if let Some(value) = section.find(key.name) {
                wiring.given.push((key.name, values(&section, key, value)?));
            }
        }
        wiring.check(&section, channels)?;
        Ok(wiring)
    }

    /// The system variables that are set, by their names in lower case, each with its value; `at_home_do` has up to
    /// five.
    pub fn given(&self) -> impl Iterator<Item = (&'static str, &[i32])> {
        self.given.iter().map(|(name, values)| (*name, values.as_slice()))
    }

    fn value(&self, name: &str) -> Option<i32> {
        self.given.iter().find(|(known, _)| *known == name).and_then(|(_, values)| values.first().copied())
    }

    /// Checks that all channels exist, and that no output is driven twice.
    fn check(&self, section: &Section<'_>, channels: &Channels) -> Result<(), SettingsError> {
        let length = self.value("pgno_length").unwrap_or(8);
        let mut driven: Vec<(i64, &str)> = Vec::new();
        for (name, values) in &self.given {
            let Some(kind) = KEYS.iter().find(|key| key.name == *name).map(|key| key.kind) else { continue };
            let (what, count, row) = match kind {
                Kind::Number(..) => continue,
                Kind::Parity | Kind::Input { row: false } => ("DI", channels.di, 1),
                Kind::Input { row: true } => ("DI", channels.di, length),
                Kind::Output { row: Row::One } => ("DO", channels.dout, 1),
                Kind::Output { row: Row::Two } => ("DO", channels.dout, 2),
                Kind::Output { row: Row::Number } => ("DO", channels.dout, length),
            };
            for first in values.iter().filter(|value| **value != 0).map(|value| i64::from(value.abs())) {
                let wrong = |message| {
                    let span = section.find(name).map_or(0..0, |value| value.span());
                    Err(section.source.error(span, message))
                };
                let last = first + i64::from(row) - 1;
                if last > i64::from(count) {
                    return wrong(format!("`{name}` is wired to {what} {last}, but the cell has {what} 1 to {count}"));
                }
                if what == "DO" {
                    for channel in first..=last {
                        if let Some((_, other)) = driven.iter().find(|(known, _)| *known == channel) {
                            return wrong(format!("`{name}` and `{other}` are both wired to DO {channel}"));
                        }
                        driven.push((channel, name));
                    }
                }
            }
        }
        if self.value("pgno_type") == Some(1) && length % 4 != 0 {
            let span =
                section.find("pgno_length").or_else(|| section.find("pgno_type")).map_or(0..0, |value| value.span());
            let message = format!("`pgno_length` is {length}, but a program number in BCD has 4, 8, 12 or 16 inputs");
            return Err(section.source.error(span, message));
        }
        Ok(())
    }
}

/// The values of a key.
fn values(section: &Section<'_>, key: &Key, value: &Value<'_>) -> Result<Vec<i32>, SettingsError> {
    let ((low, high), what) = match key.kind {
        Kind::Number(low, high) => ((low, high), format!("a number from {low} to {high}")),
        Kind::Parity => (
            (-MAX_CHANNELS, MAX_CHANNELS),
            "the number of a digital input, negative for odd parity, or 0 for none".to_owned(),
        ),
        Kind::Input { .. } => ((0, MAX_CHANNELS), "the number of a digital input, or 0 for none".to_owned()),
        Kind::Output { .. } => ((0, MAX_CHANNELS), "the number of a digital output, or 0 for none".to_owned()),
    };
    let whole = |found: Option<f64>| {
        let whole = found.filter(|found| found.fract() == 0.0 && (f64::from(low)..=f64::from(high)).contains(found));
        whole.map(|found| found as i32)
    };
    if key.name != AT_HOME {
        return match whole(number(value.get_ref())) {
            Some(found) => Ok(vec![found]),
            None => Err(section.wrong(key.name, value, &what)),
        };
    }
    let wrong =
        || section.wrong(key.name, value, "a list of up to five digital outputs, one for each home point, 0 for none");
    let list = value.get_ref().as_array().filter(|list| list.len() <= 5).ok_or_else(wrong)?;
    list.iter().map(|item| whole(number(item.get_ref())).ok_or_else(wrong)).collect()
}

/// The highest channel number, more than any cell has.
const MAX_CHANNELS: i32 = 10_000;

#[cfg(test)]
mod tests {
    use crate::cell::Cell;

    #[test]
    fn all_settings_of_the_catalog_have_a_key() {
        let names: Vec<String> = arl_lang::catalog::system_variables()
            .filter(|variable| variable.section.starts_with("9.1"))
            .map(|variable| variable.name.to_ascii_lowercase())
            .collect();
        assert_eq!(names.len(), 21);
        for name in &names {
            assert!(super::KEYS.iter().any(|key| key.name == name), "{name}");
        }
        assert_eq!(super::KEYS.len(), names.len());
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("[external]\nstart_prog = 4", 2, "did you mean `start_prog_di`?"),
            ("[external]\nstart_prog_di = 65", 2, "`start_prog_di` is wired to DI 65, but the cell has DI 1 to 64"),
            ("[external]\nstart_prog_di = -1", 2, "the number of a digital input, or 0 for none"),
            ("[external]\npgno_fbit_di = 60", 2, "wired to DI 67"),
            ("[io]\ndi = 100\n[external]\npgno_fbit_di = 90\npgno_length = 12", 4, "wired to DI 101"),
            ("[external]\npgno_parity_di = -65", 2, "wired to DI 65"),
            ("[external]\npgno_type = 3", 2, "a number from 0 to 2"),
            ("[external]\npgno_length = 17", 2, "a number from 1 to 16"),
            ("[external]\npgno_type = 1\npgno_length = 6", 3, "a program number in BCD has 4, 8, 12 or 16 inputs"),
            ("[external]\nchan_state_do = 64", 2, "wired to DO 65"),
            (
                "[external]\nat_aut_do = 5\nchan_state_do = 4",
                3,
                "`chan_state_do` and `at_aut_do` are both wired to DO 5",
            ),
            ("[external]\nat_home_do = 5", 2, "a list of up to five digital outputs"),
            ("[external]\nat_home_do = [1, 2, 3, 4, 5, 6]", 2, "a list of up to five digital outputs"),
            ("[external]\nat_home_do = [1, 1]", 2, "both wired to DO 1"),
            ("[external]\nenabled = 1", 2, "expected true or false"),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert_eq!(error.line, line, "{error}");
            assert!(error.message.contains(words), "{error}");
        }
    }
}
