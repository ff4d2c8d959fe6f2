//! What moves a robot: `[driver]` of a cell file, or of one of its channels. It counts only where a run is told to drive
//! robots; otherwise they are simulated.

use crate::settings::{Section, SettingsError};

const KEYS: &[&str] = &["protocol", "address", "listen", "time"];

/// How a robot is reached.
#[derive(Clone, PartialEq, Eq, Debug)]
#[non_exhaustive]
pub struct DriverSettings {
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
        let spoken = section.word("protocol", SPOKEN)?.ok_or_else(|| lacks("protocol", "\"udp\" or \"rsi\""))?;
        if let Some(found) = section.find(spoken.other) {
            let Spoken { key, other, .. } = spoken;
            let text = format!("{name} has `{other}`, which goes with another protocol: this one has `{key}`");
            return Err(section.source.error(found.span(), text));
        }
        let place = section.text(spoken.key, spoken.place)?.ok_or_else(|| lacks(spoken.key, spoken.place))?;
        if let (false, Some(found)) = (is_place(place), section.find(spoken.key)) {
            return Err(section.wrong(spoken.key, found, spoken.place));
        }
        let times = [("world", DriverTime::World), ("robot", DriverTime::Robot)];
        let time = section.word("time", &times)?.unwrap_or_default();
        Ok(Some(Self { protocol: (spoken.protocol)(place.to_owned()), time }))
    }
}

/// A protocol in a cell file: the key of the place where somebody listens, what stands there, and the key that others have.
#[derive(Clone, Copy)]
struct Spoken {
    key: &'static str,
    place: &'static str,
    other: &'static str,
    protocol: fn(String) -> Protocol,
}

const SPOKEN: &[(&str, Spoken)] = &[
    (
        "udp",
        Spoken {
            key: "address",
            place: "where the arm listens, like \"192.168.0.30:7447\"",
            other: "listen",
            protocol: |address| Protocol::Udp { address },
        },
    ),
    (
        "rsi",
        Spoken {
            key: "listen",
            place: "what the robot sends to, like \"0.0.0.0:49152\"",
            other: "address",
            protocol: |listen| Protocol::Rsi { listen },
        },
    ),
];

/// Whether it is a host with a port.
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
        let rsi = Protocol::Rsi { listen: "0.0.0.0:49152".into() };
        let second = cell.programs.channels[0].driver.as_ref();
        assert_eq!(second, Some(&DriverSettings { protocol: rsi, time: DriverTime::Robot }));
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("driver = 3", 1, "expected the table [driver]"),
            ("[driver]\naddress = \"a:1\"", 1, "[driver] lacks `protocol`: \"udp\" or \"rsi\""),
            ("[driver]\nprotocol = \"tcp\"", 2, "expected \"udp\" or \"rsi\", found the text \"tcp\""),
            ("[driver]\nprotocol = \"udp\"", 1, "[driver] lacks `address`: where the arm listens"),
            ("[driver]\nprotocol = \"udp\"\naddress = \"10.0.0.1\"", 3, "like \"192.168.0.30:7447\""),
            ("[driver]\nprotocol = \"rsi\"\naddress = \"10.0.0.1:1\"", 3, "this one has `listen`"),
            ("[driver]\nprotocol = \"rsi\"\nlisten = \"0.0.0.0:1\"\ntime = \"fast\"", 4, "\"world\" or \"robot\""),
            ("[driver]\nprotocol = \"udp\"\nadress = \"10.0.0.1:1\"", 3, "did you mean `address`?"),
            ("[[channel]]\nprogram = \"a\"\nbackground = true\ndriver = {}", 4, "both `background` and `driver`"),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert!(error.line == line && error.message.contains(words), "{error}");
        }
    }
}
