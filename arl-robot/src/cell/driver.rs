//! What moves a robot: `[driver]` of a cell file, or of one of its channels. It counts only where a run is told to drive
//! robots; otherwise they are simulated.

use crate::settings::{Section, SettingsError};

const KEYS: &[&str] = &["protocol", "address", "listen", "time"];

const PROTOCOL: &str = "\"udp\" or \"rsi\"";
const TIME: &str = "\"world\" or \"robot\"";

/// How a robot is reached.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct DriverSettings {
    /// Where its table begins in the cell file: the line, from 1.
    pub line: u32,
    /// What is spoken.
    pub protocol: Protocol,
    /// Whose time counts.
    pub time: DriverTime,
}

/// What is spoken with a robot.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Protocol {
    /// Packets of set-points over UDP, `docs/udp-and-rsi.md`.
    Udp {
        /// Where the arm listens: host and port.
        address: String,
    },
    /// XML over UDP, as KUKA's RobotSensorInterface sends it.
    Rsi {
        /// The address and port of this computer that the robot's controller sends to.
        listen: String,
    },
}

/// Whose time counts while a robot is driven.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum DriverTime {
    /// That of the world.
    #[default]
    World,
    /// That of the robot, which is simulated: each cycle waits for it, and none waits for anything else.
    Robot,
}

impl DriverSettings {
    /// `[driver]` of a cell file or of a channel, if it is there.
    pub(super) fn read(above: &Section<'_>, name: &str) -> Result<Option<Self>, SettingsError> {
        let (Some(section), Some(value)) = (above.table("driver", name, KEYS)?, above.find("driver")) else {
            return Ok(None);
        };
        let lacks = |key: &str, what: &str| section.source.error(value.span(), format!("{name} lacks `{key}`: {what}"));
        let protocol = section.text("protocol", PROTOCOL)?.ok_or_else(|| lacks("protocol", PROTOCOL))?;
        let (own, other) = match protocol {
            "udp" => (ADDRESS, LISTEN),
            "rsi" => (LISTEN, ADDRESS),
            _ => return Err(wrong(&section, "protocol", PROTOCOL)),
        };
        if let Some(found) = section.find(other.0) {
            let text = format!("{name} has `{}`, which a driver over {protocol} has not; it has `{}`", other.0, own.0);
            return Err(section.source.error(found.span(), text));
        }
        let place = section.text(own.0, own.1)?.ok_or_else(|| lacks(own.0, own.1))?;
        if !is_place(place) {
            return Err(wrong(&section, own.0, own.1));
        }
        let place = place.to_owned();
        let protocol =
            if protocol == "udp" { Protocol::Udp { address: place } } else { Protocol::Rsi { listen: place } };
        let time = match section.text("time", TIME)? {
            None | Some("world") => DriverTime::World,
            Some("robot") => DriverTime::Robot,
            Some(_) => return Err(wrong(&section, "time", TIME)),
        };
        Ok(Some(Self { line: section.source.line(value.span().start), protocol, time }))
    }
}

/// Where something listens: the key, and what stands there.
const ADDRESS: (&str, &str) = ("address", "where the arm listens, like \"192.168.0.30:7447\"");
const LISTEN: (&str, &str) = ("listen", "what the robot sends to, like \"0.0.0.0:49152\"");

/// Whether it is a host with a port.
fn is_place(text: &str) -> bool {
    text.rsplit_once(':').is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok())
}

fn wrong(section: &Section<'_>, key: &str, expected: &str) -> SettingsError {
    let place = section.find(key).map_or(0..0, |value| value.span());
    section.find(key).map_or_else(
        || section.source.error(place, format!("`{key}`: expected {expected}")),
        |value| section.wrong(key, value, expected),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::Cell;

    #[test]
    fn drivers_are_read() {
        let text = "[driver]\nprotocol = \"udp\"\naddress = \"arm.local:7447\"\n\
                    [[channel]]\nprogram = \"a.arl\"\n\
                    driver = { protocol = \"rsi\", listen = \"0.0.0.0:49152\", time = \"robot\" }\n";
        let cell = Cell::parse("cell.toml", text).unwrap();
        let udp = Protocol::Udp { address: "arm.local:7447".into() };
        assert_eq!(cell.driver, Some(DriverSettings { line: 1, protocol: udp, time: DriverTime::World }));
        let rsi = Protocol::Rsi { listen: "0.0.0.0:49152".into() };
        let second = cell.programs.channels[0].driver.as_ref();
        assert_eq!(second, Some(&DriverSettings { line: 6, protocol: rsi, time: DriverTime::Robot }));
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("driver = 3", 1, "expected the table [driver]"),
            ("[driver]\naddress = \"a:1\"", 1, "[driver] lacks `protocol`: \"udp\" or \"rsi\""),
            ("[driver]\nprotocol = \"tcp\"", 2, "expected \"udp\" or \"rsi\", found the text \"tcp\""),
            ("[driver]\nprotocol = \"udp\"", 1, "[driver] lacks `address`: where the arm listens"),
            ("[driver]\nprotocol = \"udp\"\naddress = \"10.0.0.1\"", 3, "like \"192.168.0.30:7447\""),
            ("[driver]\nprotocol = \"rsi\"\naddress = \"10.0.0.1:1\"", 3, "it has `listen`"),
            ("[driver]\nprotocol = \"rsi\"\nlisten = \"0.0.0.0:1\"\ntime = \"fast\"", 4, "\"world\" or \"robot\""),
            ("[driver]\nprotocol = \"udp\"\nadress = \"10.0.0.1:1\"", 3, "did you mean `address`?"),
            ("[[channel]]\nprogram = \"a\"\nbackground = true\ndriver = {}", 4, "both `background` and `driver`"),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert!(error.line == line && error.message.contains(words), "{error}");
        }
    }
}
