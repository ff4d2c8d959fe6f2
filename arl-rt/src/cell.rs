//! The cell file: what stands around the robot. Everything has a sensible value where the file says nothing.
//!
//! ```toml
//! [controller]
//! cycle = 1.0                  # ms, 0.1 to 100
//!
//! [io]                         # numbers of channels
//! di = 64
//! do = 64
//! ai = 8                       # all in V, or a list: ["V", "mA"]
//! ao = ["V", "V", "mA"]
//! internal = 32
//!
//! [home]                       # axis positions in deg (mm where linear); home 1 is `home` of the robot file
//! tolerance = 0.1              # how near is at home, deg (mm)
//! home2 = [0, -90, 90, 0, 0, 0]
//! ```

use std::path::Path;

use toml::de::DeValue;

use crate::io::{AnalogType, Channels};
use crate::rate::Rate;
use crate::settings::{Section, SettingsError, Source, number};

const TOP: &[&str] = &["controller", "io", "home"];
const CONTROLLER: &[&str] = &["cycle"];
const IO: &[&str] = &["di", "do", "ai", "ao", "internal"];
const HOME: &[&str] = &["tolerance", "home2", "home3", "home4", "home5"];
const HOMES: [&str; 4] = ["home2", "home3", "home4", "home5"];

/// Far more channels than any cell has.
const MOST_CHANNELS: u32 = 10_000;

/// What stands around the robot.
#[derive(Clone, PartialEq, Debug)]
pub struct Cell {
    /// The length of the control cycle.
    pub rate: Rate,
    /// The channels of io.
    pub channels: Channels,
    /// Home points 2 to 5: axis positions in deg (mm where linear).
    pub homes: [Option<Vec<f64>>; 4],
    /// How near to a home point is at home, in deg (mm).
    pub home_tolerance: f64,
}

impl Default for Cell {
    fn default() -> Self {
        Self {
            rate: Rate::default(),
            channels: Channels::default(),
            homes: [None, None, None, None],
            home_tolerance: 0.1,
        }
    }
}

impl Cell {
    /// Reads a cell file.
    ///
    /// # Errors
    /// The file cannot be read, or what it says is not a cell.
    pub fn load(path: &Path) -> Result<Cell, SettingsError> {
        let name = path.display().to_string();
        let text = std::fs::read_to_string(path)
            .map_err(|error| SettingsError::of_file(&name, format!("cannot read the cell file: {error}")))?;
        Cell::parse(&name, &text)
    }

    /// The cell that `text` describes; `file` names the text in errors.
    ///
    /// # Errors
    /// The text is not TOML, or not a cell: with line, column and what was expected.
    pub fn parse(file: &str, text: &str) -> Result<Cell, SettingsError> {
        let source = Source { file, text };
        let root = source.parse()?;
        let top = Section::new(source, "the cell file", root.get_ref(), TOP)?;
        let mut cell = Cell::default();
        if let Some(controller) = top.table("controller", "[controller]", CONTROLLER)? {
            let (low, high) = (f64::from(Rate::SHORTEST) / 1e3, f64::from(Rate::LONGEST) / 1e3);
            if let Some(cycle) = controller.number("cycle", "the control cycle in ms", low, high)? {
                cell.rate = Rate::from_micros((cycle * 1e3).round() as u32);
            }
        }
        if let Some(io) = top.table("io", "[io]", IO)? {
            channels(&io, &mut cell.channels)?;
        }
        if let Some(home) = top.table("home", "[home]", HOME)? {
            if let Some(tolerance) = home.number("tolerance", "a distance in deg", 0.0, 90.0)? {
                cell.home_tolerance = tolerance;
            }
            for (place, key) in cell.homes.iter_mut().zip(HOMES) {
                *place = positions(&home, key)?;
            }
        }
        Ok(cell)
    }
}

fn channels(io: &Section<'_>, channels: &mut Channels) -> Result<(), SettingsError> {
    let digital = [("di", &mut channels.di), ("do", &mut channels.dout), ("internal", &mut channels.internal)];
    for (key, count) in digital {
        if let Some(found) = io.count(key, "a number of channels", MOST_CHANNELS)? {
            *count = found;
        }
    }
    for (key, types) in [("ai", &mut channels.ai), ("ao", &mut channels.ao)] {
        if let Some(found) = analog(io, key)? {
            *types = found;
        }
    }
    Ok(())
}

/// A number of channels, all in V, or a list of their types.
fn analog(io: &Section<'_>, key: &str) -> Result<Option<Vec<AnalogType>>, SettingsError> {
    let Some(value) = io.find(key) else { return Ok(None) };
    let Some(list) = value.get_ref().as_array() else {
        let what = "a list of \"V\" and \"mA\", or a number of channels";
        let count = io.count(key, what, MOST_CHANNELS)?.unwrap_or(0);
        return Ok(Some(vec![AnalogType::Volt; count as usize]));
    };
    let types = list.iter().map(|item| match item.get_ref() {
        DeValue::String(word) if word.eq_ignore_ascii_case("V") => Ok(AnalogType::Volt),
        DeValue::String(word) if word.eq_ignore_ascii_case("mA") => Ok(AnalogType::Milliampere),
        _ => Err(io.wrong(key, item, "\"V\" or \"mA\"")),
    });
    types.collect::<Result<_, _>>().map(Some)
}

fn positions(home: &Section<'_>, key: &str) -> Result<Option<Vec<f64>>, SettingsError> {
    const WHAT: &str = "axis positions in deg, like [0, -90, 90, 0, 0, 0]";
    let Some(value) = home.find(key) else { return Ok(None) };
    let array = value.get_ref().as_array().ok_or_else(|| home.wrong(key, value, WHAT))?;
    let items = array.iter().map(|item| number(item.get_ref()).ok_or_else(|| home.wrong(key, item, WHAT)));
    items.collect::<Result<_, _>>().map(Some)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_file_is_the_default_cell() {
        let cell = Cell::parse("cell.toml", "").unwrap();
        assert_eq!(cell, Cell::default());
        let channels = &cell.channels;
        assert_eq!((channels.di, channels.dout, channels.internal), (64, 64, 32));
        assert_eq!(channels.ai, [AnalogType::Volt; 8]);
        assert_eq!(cell.rate.period(), 0.001);
    }

    #[test]
    fn everything_is_read() {
        let text = "[controller]\ncycle = 4\n[io]\ndi = 16\ndo = 8\nai = [\"V\", \"ma\"]\nao = 2\ninternal = 0\n\
                    [home]\ntolerance = 0.5\nhome3 = [0, 1.5, 2, 3, 4, 5]\n";
        let cell = Cell::parse("cell.toml", text).unwrap();
        assert_eq!(cell.rate.micros(), 4000);
        assert_eq!((cell.channels.di, cell.channels.dout, cell.channels.internal), (16, 8, 0));
        assert_eq!(cell.channels.ai, [AnalogType::Volt, AnalogType::Milliampere]);
        assert_eq!(cell.channels.ao, [AnalogType::Volt; 2]);
        assert_eq!(cell.homes[1].as_deref(), Some(&[0.0, 1.5, 2.0, 3.0, 4.0, 5.0][..]));
        assert_eq!((cell.homes[0].as_ref(), cell.home_tolerance), (None, 0.5));
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("[io]\ndi = 64\ndoo = 3", 3, "did you mean `do`?"),
            ("\n[inout]\n", 2, "known are: controller, io, home"),
            ("[io]\ndi = -1", 2, "expected a number of channels from 0 to 10000, found the number -1"),
            ("[io]\ndi = \"many\"", 2, "found the text \"many\""),
            ("[io]\nai = [\"V\",\n \"A\"]", 3, "expected \"V\" or \"mA\""),
            ("[controller]\ncycle = 0", 2, "the control cycle in ms from 0.1 to 100"),
            ("[home]\nhome2 = 3", 2, "expected axis positions"),
            ("[home]\nhome2 = [0,", 2, "this is not TOML"),
            ("io = 3", 1, "expected the table [io], found the number 3"),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert_eq!(error.line, line, "{error}");
            assert!(error.message.contains(words), "{error}");
        }
    }
}
