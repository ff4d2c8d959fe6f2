//! The part of a cell file that describes the robot's surroundings, against which a program can be checked before it
//! runs.

use std::collections::BTreeMap;

use crate::cell::{Cell, Names};
use crate::channels::Channels;
use crate::islands::Island;
use crate::settings::{Section, SettingsError};

/// The resources of a cell for programs.
#[derive(Clone, PartialEq, Debug)]
pub struct Outline {
    /// The I/O channels.
    pub channels: Channels,
    /// The Modbus TCP servers with some of these channels.
    pub islands: Vec<Island>,
    /// The names of serial lines in programs, and their devices.
    pub lines: BTreeMap<String, String>,
    /// The names of signals.
    pub names: Names,
    /// The number of bytes that the DeviceNet bus exchanges.
    pub devicenet: u32,
    /// Whether the controller serves registers and coils over Modbus TCP.
    pub modbus_tcp: bool,
    /// Whether other programs run besides the first one.
    pub others: bool,
    /// Whether the cell has the position of a robot in the world.
    pub based: bool,
    /// The number of programs with a robot that run in parallel: foreground channels, at least 1.
    pub foreground: u32,
}

/// The default number of bytes that a DeviceNet bus exchanges.
pub const DEVICENET: u32 = 512;

/// The most bytes that can be configured.
const MOST_DEVICENET: u32 = 65536;

impl Outline {
    /// The outline of a cell.
    pub fn of(cell: &Cell) -> Outline {
        Outline {
            channels: cell.channels.clone(),
            islands: cell.islands.clone(),
            lines: cell.network.devices.clone(),
            names: cell.names.clone(),
            devicenet: cell.buses.devicenet as u32,
            modbus_tcp: cell.buses.modbus_tcp.is_some(),
            others: !cell.programs.channels.is_empty(),
            based: {
                let others = cell.programs.channels.iter().map(|channel| &channel.stands);
                others.chain([&cell.stands]).any(|stands| stands.base.is_some())
            },
            foreground: 1 + cell.programs.channels.iter().filter(|channel| !channel.background).count() as u32,
        }
    }

    /// The outline of the cell file with this text; `file` names it in errors.
    ///
    /// # Errors
    /// The text is not TOML, or not a cell: with line, column and what was expected.
    pub fn of_cell(file: &str, text: &str) -> Result<Outline, SettingsError> {
        Cell::parse(file, text).map(|cell| Outline::of(&cell))
    }
}

/// The serial lines of a cell file: its table `[serial]`, if it exists.
///
/// # Errors
/// The values are not devices.
pub(crate) fn lines(top: &Section<'_>) -> Result<BTreeMap<String, String>, SettingsError> {
    const WHAT: &str = "the path of a device, like \"/dev/ttyUSB0\"";
    let Some(value) = top.find("serial") else { return Ok(BTreeMap::new()) };
    let table = value.get_ref().as_table().ok_or_else(|| top.wrong("serial", value, "the table [serial]"))?;
    let pairs = table.iter().map(|(name, device)| {
        let name: &str = name.get_ref().as_ref();
        let path = device.get_ref().as_str().filter(|path| !path.is_empty());
        Ok((name.to_owned(), path.ok_or_else(|| top.wrong(name, device, WHAT))?.to_owned()))
    });
    pairs.collect()
}

/// The number of bytes that the DeviceNet bus of a cell file exchanges: `size` of `[devicenet]`.
///
/// # Errors
/// The value is not a size.
pub(crate) fn devicenet(top: &Section<'_>) -> Result<u32, SettingsError> {
    let Some(section) = top.table("devicenet", "[devicenet]", &["size"])? else { return Ok(DEVICENET) };
    Ok(section.count("size", "how many bytes the bus exchanges", MOST_DEVICENET)?.unwrap_or(DEVICENET))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::channels::AnalogType;

    #[test]
    fn what_programs_see_of_a_cell() {
        let text = "[controller]\ncycle = 2\n[io]\ndi = 16\nao = [\"mA\"]\n[serial]\n\"/dev/ttyS0\" = \"/dev/ttyUSB0\"\n\
                    [devicenet]\nsize = 16\n[modbus_tcp]\n";
        let outline = Outline::of_cell("cell.toml", text).unwrap();
        let channels = &outline.channels;
        assert_eq!((channels.di, channels.dout, channels.ao.as_slice()), (16, 64, &[AnalogType::Milliampere][..]));
        assert_eq!(outline.lines.get("/dev/ttyS0").map(String::as_str), Some("/dev/ttyUSB0"));
        assert_eq!((outline.devicenet, outline.modbus_tcp), (16, true));
        let empty = Outline::of_cell("cell.toml", "").unwrap();
        assert_eq!((empty.channels, empty.devicenet, empty.modbus_tcp), (Channels::default(), 512, false));
        assert!(empty.lines.is_empty() && empty.islands.is_empty());
    }

    #[test]
    fn foreground_channels_are_the_first_and_those_with_robots() {
        let channel = |more: &str| format!("[[channel]]\nprogram = \"a.arl\"\n{more}");
        for (text, count) in [
            (String::new(), 1),
            (channel(""), 2),
            (channel("background = true\n"), 1),
            (channel("background = true\n") + &channel("robot = \"hsr065\"\n") + &channel(""), 3),
        ] {
            assert_eq!(Outline::of_cell("cell.toml", &text).unwrap().foreground, count, "{text}");
        }
    }

    #[test]
    fn mistakes_name_their_line() {
        for (text, line, words) in [
            ("[io]\ndoo = 3", 2, "did you mean `do`?"),
            ("io = 3", 1, "the table [io]"),
            ("serial = 3", 1, "expected the table [serial], found the number 3"),
            (
                "[serial]\n\"/dev/ttyS0\" = 1",
                2,
                "expected the path of a device, like \"/dev/ttyUSB0\", found the number 1",
            ),
            ("[serial]\ncom1 = \"\"", 2, "`com1` of the cell file: expected the path of a device"),
            ("devicenet = 8", 1, "expected the table [devicenet]"),
            ("[devicenet]\nsize = -1", 2, "how many bytes the bus exchanges from 0 to 65536"),
            ("[devicenet]\nsizes = 1", 2, "did you mean `size`?"),
        ] {
            let error = Outline::of_cell("cell.toml", text).unwrap_err();
            assert!(error.line == line && error.message.contains(words), "{error}");
        }
    }
}
