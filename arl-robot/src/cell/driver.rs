//! The driver of a robot: `[driver]` of a cell file, or of one of its channels. It applies only to runs that are to
//! drive robots; otherwise robots are simulated.

use std::net::IpAddr;

use crate::settings::{Section, SettingsError};

const KEYS: &[&str] = &["protocol", "address", "listen", "time"];

/// The connection to a robot.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct DriverSettings {
    /// The protocol of the robot.
    pub protocol: Protocol,
    /// The clock of the run.
    pub time: DriverTime,
}

/// The protocol of a robot.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub enum Protocol {
    /// Packets of set-points over UDP, `docs/udp-and-rsi.md`.
    Udp {
        /// The address on which the arm listens: host and port.
        address: String,
    },
    /// XML over UDP, as KUKA's RobotSensorInterface sends it.
    Rsi {
        /// The address and port of this computer to which the robot's controller sends.
        listen: String,
        /// The robot's controller: a host, with the port from which it sends if that is fixed. `None`: the first
        /// sender.
        address: Option<String>,
    },
}

/// The clock while a robot is driven.
#[derive(Clone, Copy, PartialEq, Eq, Default, Debug)]
pub enum DriverTime {
    /// Real time.
    #[default]
    World,
    /// The time of a simulated robot: each cycle waits for the robot, and for nothing else.
    Robot,
}

impl DriverSettings {
    /// Reads `[driver]` of a cell file or of a channel, if it exists.
    pub(super) fn read(above: &Section<'_>, name: &str) -> Result<Option<Self>, SettingsError> {
        let (Some(section), Some(value)) = (above.table("driver", name, KEYS)?, above.find("driver")) else {
            return Ok(None);
        };
        let lacks = |key: &str, what: &str| section.source.error(value.span(), format!("{name} lacks `{key}`: {what}"));
        let words = [("udp", Spoken::Udp), ("rsi", Spoken::Rsi)];
        let spoken = section.word("protocol", &words)?.ok_or_else(|| lacks("protocol", "\"udp\" or \"rsi\""))?;
        let needed = |key, what, is_right| text(&section, key, what, is_right)?.ok_or_else(|| lacks(key, what));
        let protocol = match spoken {
            Spoken::Udp => {
                if let Some(found) = section.find("listen") {
                    let text = format!("{name} has `listen`, which is for \"rsi\": this one needs `address`");
                    return Err(section.source.error(found.span(), text));
                }
                Protocol::Udp {
                    address: needed(
                        "address",
                        "the address on which the arm listens, like \"192.168.0.30:7447\"",
                        is_place,
                    )?,
                }
            }
            Spoken::Rsi => Protocol::Rsi {
                listen: needed("listen", "the address that the robot sends to, like \"0.0.0.0:49152\"", is_place)?,
                address: text(
                    &section,
                    "address",
                    "the address of the robot's controller, like \"192.168.0.30\"",
                    is_host,
                )?,
            },
        };
        let times = [("world", DriverTime::World), ("robot", DriverTime::Robot)];
        let time = section.word("time", &times)?.unwrap_or_default();
        Ok(Some(Self { protocol, time }))
    }
}

#[derive(Clone, Copy)]
enum Spoken {
    Udp,
    Rsi,
}

/// A text that has to be valid, if given.
fn text(
    section: &Section<'_>,
    key: &str,
    what: &str,
    is_right: fn(&str) -> bool,
) -> Result<Option<String>, SettingsError> {
    let text = section.text(key, what)?;
    match (text, section.find(key)) {
        (Some(text), Some(found)) if !is_right(text) => Err(section.wrong(key, found, what)),
        _ => Ok(text.map(str::to_owned)),
    }
}

/// Whether the text is a host, with or without a port.
fn is_host(text: &str) -> bool {
    let is_name = |host: &str| !host.is_empty() && !host.contains([':', ' ', '/']);
    text.parse::<IpAddr>().is_ok() || is_name(text) || is_place(text)
}

/// Whether the text is a host with a port.
fn is_place(text: &str) -> bool {
    text.rsplit_once(':').is_some_and(|(host, port)| !host.is_empty() && port.parse::<u16>().is_ok())
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
        assert_eq!(cell.driver, Some(DriverSettings { protocol: udp, time: DriverTime::World }));
        let rsi = Protocol::Rsi { listen: "0.0.0.0:49152".into(), address: None };
        let second = cell.programs.channels[0].driver.as_ref();
        assert_eq!(second, Some(&DriverSettings { protocol: rsi, time: DriverTime::Robot }));
    }

    #[test]
    fn a_robot_that_speaks_rsi_can_be_named() {
        for robot in ["192.168.0.30", "192.168.0.30:49153", "kuka.local", "fe80::1", "[fe80::1]:49153"] {
            let text = format!("[driver]\nprotocol = \"rsi\"\nlisten = \"0.0.0.0:1\"\naddress = \"{robot}\"\n");
            let found = Cell::parse("cell.toml", &text).unwrap().driver.unwrap().protocol;
            assert_eq!(found, Protocol::Rsi { listen: "0.0.0.0:1".into(), address: Some(robot.into()) });
        }
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("driver = 3", 1, "expected the table [driver]"),
            ("[driver]\naddress = \"a:1\"", 1, "[driver] lacks `protocol`: \"udp\" or \"rsi\""),
            ("[driver]\nprotocol = \"tcp\"", 2, "expected \"udp\" or \"rsi\", found the text \"tcp\""),
            ("[driver]\nprotocol = \"udp\"", 1, "[driver] lacks `address`: the address on which the arm listens"),
            ("[driver]\nprotocol = \"udp\"\naddress = \"10.0.0.1\"", 3, "like \"192.168.0.30:7447\""),
            (
                "[driver]\nprotocol = \"rsi\"\naddress = \"10.0.0.1:1\"",
                1,
                "[driver] lacks `listen`: the address that the robot",
            ),
            ("[driver]\nprotocol = \"udp\"\naddress = \"a:1\"\nlisten = \"b:1\"", 4, "this one needs `address`"),
            (
                "[driver]\nprotocol = \"rsi\"\nlisten = \"0.0.0.0:1\"\naddress = \"10.0.0.1:x\"",
                4,
                "like \"192.168.0.30\"",
            ),
            ("[driver]\nprotocol = \"rsi\"\nlisten = \"0.0.0.0:1\"\naddress = \"\"", 4, "like \"192.168.0.30\""),
            ("[driver]\nprotocol = \"rsi\"\nlisten = \"0.0.0.0:1\"\ntime = \"fast\"", 4, "\"world\" or \"robot\""),
            ("[driver]\nprotocol = \"udp\"\nadress = \"10.0.0.1:1\"", 3, "did you mean `address`?"),
            ("[[channel]]\nprogram = \"a\"\nbackground = true\ndriver = {}", 4, "both `background` and `driver`"),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert!(error.line == line && error.message.contains(words), "{error}");
        }
    }
}
