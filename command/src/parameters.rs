//! A parameter of a run: a place that has another value in that run, as the words of a command line.

use serde::{Deserialize, Serialize, Serializer, de};
use serde_json::Value;
use std::fmt;

/// What a parameter may be besides a place of `--set`: an option of a run.
const OPTIONS: [&str; 7] = ["robot", "io", "max-time", "mode", "override", "seed", "start-time"];
/// How the place of a global variable begins.
pub(crate) const GLOBAL: &str = "global.";
/// How places of `--set` begin.
const PLACES: [&str; 4] = [GLOBAL, "robot.", "cell.", "io."];

/// The parameters of one run, in their order.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Parameters(pub Vec<(String, Value)>);

impl Parameters {
    /// Sets a value, in place of one with the same name.
    pub(crate) fn set(&mut self, name: &str, value: Value) {
        match self.0.iter_mut().find(|(known, _)| known == name) {
            Some((_, old)) => *old = value,
            None => self.0.push((name.to_owned(), value)),
        }
    }

    /// The value of an option.
    pub(crate) fn option(&self, name: &str) -> Option<&Value> {
        self.0.iter().find(|(known, _)| known == name).map(|(_, value)| value)
    }

    /// The names of global variables among them.
    pub fn globals(&self) -> impl Iterator<Item = &str> {
        self.0.iter().filter_map(|(place, _)| place.strip_prefix(GLOBAL))
    }

    /// The command-line words of the parameters, except for those that name files.
    ///
    /// # Errors
    /// A parameter is unknown, or its value is not valid.
    pub fn words(&self) -> Result<Vec<String>, String> {
        let mut words = Vec::new();
        for (name, value) in &self.0 {
            match (name.as_str(), value) {
                ("robot" | "io", Value::String(_)) => {}
                ("robot" | "io", _) => {
                    return Err(format!(
                        "parameter `{name}`: expected the name of a file, found {value}; a place in it must be in quotes: \
                         \"io.event.1.at\" = 2.5"
                    ));
                }
                _ => words.extend(word(name, value)?),
            }
        }
        Ok(words)
    }
}

fn word(name: &str, value: &Value) -> Result<[String; 2], String> {
    if PLACES.iter().any(|place| name.starts_with(place)) {
        let value = if name.starts_with(GLOBAL) { as_arl(value) } else { as_toml(value) };
        let value = value.ok_or_else(|| format!("parameter `{name}`: expected a value, not null, nan or inf"))?;
        return Ok(["--set".into(), format!("{name}={value}")]);
    }
    if !OPTIONS.contains(&name) {
        return Err(format!(
            "there is no parameter `{name}`: expected a place like global.pitch, robot.axis.1.vel, cell.controller.cycle or \
             io.event.2.at, or one of {}",
            OPTIONS.join(", ")
        ));
    }
    match value {
        Value::String(text) => Ok([format!("--{name}"), text.clone()]),
        Value::Number(number) => Ok([format!("--{name}"), number.to_string()]),
        _ => Err(format!("parameter `{name}`: expected a number or a string, found {value}")),
    }
}

/// The key under which a time of TOML arrives.
const TIME: &str = "$__toml_private_datetime";

/// The key of a table that has a literal of ARL as it is: `{ arl = "controlmode::auto" }`.
const AS_IT_STANDS: &str = "arl";

/// A value as a literal of ARL: lists and tables are braces.
pub fn as_arl(value: &Value) -> Option<String> {
    Some(match value {
        Value::Null => return None,
        Value::String(text) => quoted(text),
        Value::Object(values) if values.len() == 1 && values.contains_key(AS_IT_STANDS) => {
            values.get(AS_IT_STANDS)?.as_str()?.to_owned()
        }
        Value::Array(values) => {
            let values: Option<Vec<String>> = values.iter().map(as_arl).collect();
            format!("{{{}}}", values?.join(", "))
        }
        Value::Object(values) => {
            let values: Option<Vec<String>> =
                values.iter().map(|(key, value)| Some(format!("{key} {}", as_arl(value)?))).collect();
            format!("{{{}}}", values?.join(", "))
        }
        other => other.to_string(),
    })
}

fn quoted(text: &str) -> String {
    let mut quoted = String::new();
    arl_lang::written::string(text, &mut quoted);
    quoted
}

/// A value in TOML.
fn as_toml(value: &Value) -> Option<String> {
    Some(match value {
        Value::Null => return None,
        Value::Array(values) => {
            let values: Option<Vec<String>> = values.iter().map(as_toml).collect();
            format!("[{}]", values?.join(", "))
        }
        Value::Object(values) => {
            let key = |key: &String| Value::from(key.as_str()).to_string();
            let values: Option<Vec<String>> =
                values.iter().map(|(name, value)| Some(format!("{} = {}", key(name), as_toml(value)?))).collect();
            format!("{{ {} }}", values?.join(", "))
        }
        other => other.to_string(),
    })
}

impl Serialize for Parameters {
    fn serialize<S: Serializer>(&self, to: S) -> Result<S::Ok, S::Error> {
        to.collect_map(self.0.iter().map(|(name, value)| (name, value)))
    }
}

impl<'de> Deserialize<'de> for Parameters {
    fn deserialize<D: de::Deserializer<'de>>(from: D) -> Result<Self, D::Error> {
        from.deserialize_map(InOrder)
    }
}

struct InOrder;

impl<'de> de::Visitor<'de> for InOrder {
    type Value = Parameters;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a table of parameters")
    }

    fn visit_map<A: de::MapAccess<'de>>(self, mut map: A) -> Result<Parameters, A::Error> {
        let mut all = Parameters::default();
        while let Some((name, value)) = map.next_entry::<String, Value>()? {
            // A time of TOML is kept as its text.
            let time = value.as_object().and_then(|table| table.get(TIME)).cloned();
            all.set(&name, time.unwrap_or(value));
        }
        Ok(all)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn parameters_are_words_of_a_command_line() {
        let words = |name: &str, value: Value| Parameters(vec![(name.into(), value)]).words();
        for (name, value, expected) in [
            ("global.pitch", json!(80), ["--set", "global.pitch=80"]),
            ("global.name", json!("a"), ["--set", "global.name=\"a\""]),
            ("global.mode", json!({"arl": "mode::fast"}), ["--set", "global.mode=mode::fast"]),
            ("global.feeder", json!({"z": 120.5}), ["--set", "global.feeder={z 120.5}"]),
            ("global.row", json!([[1, 2], true]), ["--set", "global.row={{1, 2}, true}"]),
            ("robot.axis.1.range", json!([-1, "a"]), ["--set", "robot.axis.1.range=[-1, \"a\"]"]),
            ("io.event.1.when", json!("do.1"), ["--set", "io.event.1.when=\"do.1\""]),
            ("cell.x", json!({"a": 1}), ["--set", "cell.x={ \"a\" = 1 }"]),
            ("override", json!(50.5), ["--override", "50.5"]),
            ("mode", json!("manual"), ["--mode", "manual"]),
        ] {
            assert_eq!(words(name, value).unwrap(), expected);
        }
        assert_eq!(words("io", json!("a.toml")).unwrap(), Vec::<String>::new());
        assert!(words("robot", json!({"axis": 1})).unwrap_err().contains("must be in quotes"));
        assert!(words("pitch", json!(1)).unwrap_err().contains("there is no parameter `pitch`"));
        assert!(words("global.pitch", Value::Null).unwrap_err().contains("null"));
        assert!(words("override", json!([1])).unwrap_err().contains("expected a number or a string"));
    }

    #[test]
    fn times_of_toml_are_texts() {
        let read: Parameters = toml::from_str("start-time = 2026-11-28T12:00:00\n").unwrap();
        assert_eq!(read.words().unwrap(), ["--start-time", "2026-11-28T12:00:00"]);
    }

    #[test]
    fn their_order_stays() {
        let text = r#"{"global.z":1,"global.a":2}"#;
        let read: Parameters = serde_json::from_str(text).unwrap();
        assert_eq!(serde_json::to_string(&read).unwrap(), text);
    }
}
