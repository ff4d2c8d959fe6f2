//! The cell file: used by the command for compiling and by the runtime for running.

mod bodies;
mod buses;
mod carriers;
mod driver;
mod external;
mod file;
mod fit;
mod late;
mod names;
mod network;

pub use bodies::{Body, Form, Grip, Holder, LARGEST_MM, Solid};
pub use buses::{BusSettings, ModbusTcpSettings};
pub use carriers::Carrier;
pub use driver::{DriverSettings, DriverTime, Protocol};
pub use external::Wiring;
pub use file::Cell;
pub use fit::fit;
pub use late::{Late, LateCycles};
pub use names::{Names, Signal, SignalKind};
pub use network::{Listen, NetworkSettings};

pub use crate::rate::Rate;
pub use crate::settings::SettingsError;

use std::path::{Path, PathBuf};

use toml::de::DeValue;

use crate::settings::{Section, Source, Value, number, table};

const CHANNEL: &[&str] = &[
    "program",
    "robot",
    "urdf",
    "base",
    "background",
    "load",
    "tolerance",
    "home2",
    "home3",
    "home4",
    "home5",
    "collision",
    "driver",
];
const HOME: &[&str] = &["tolerance", "home2", "home3", "home4", "home5"];
const COLLISION: &[&str] = &["cid", "percent", "torque"];
const HOMES: [&str; 4] = ["home2", "home3", "home4", "home5"];

const POSITIONS: &str = "axis positions in deg, like [0, -90, 90, 0, 0, 0]";
const TORQUES: &str = "a torque above 0 in Nm for each axis, like [60, 60, 40, 15, 15, 10]";

/// The most programs with a robot that run in parallel.
pub const MOST_FOREGROUND: usize = 6;

/// The programs besides the one of the command line.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Programs {
    /// The channels besides the first one.
    pub channels: Vec<CellChannel>,
    /// The programs that `switcharl` can load into the first channel.
    pub load: Vec<String>,
}

/// A channel besides the first one.
#[derive(Clone, PartialEq, Debug)]
pub struct CellChannel {
    /// The line, from 1, at which its table begins in the cell file.
    pub line: u32,
    /// The program's file, as the cell file names it.
    pub program: String,
    /// The robot's name or file; `None` for the default one.
    pub robot: Option<String>,
    /// The shape of its robot, and its base in the world.
    pub stands: Stands,
    /// The driver of its robot; `None` if it is simulated.
    pub driver: Option<DriverSettings>,
    /// Whether it has no robot.
    pub background: bool,
    /// The programs that `switcharl` can load here, as the cell file names them.
    pub load: Vec<String>,
    /// The home points of its robot.
    pub homes: Homes,
    /// The conditions of `startdetect` of its robot.
    pub collisions: Vec<(u8, Sensitivity)>,
}

/// The shape of a robot, and its base in the world.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Stands {
    /// The URDF file with its shape.
    pub urdf: Option<PathBuf>,
    /// Its base in the world, x, y, z in mm, a, b, c in deg: the start value of `$BASE[0]`.
    pub base: Option<[f64; 6]>,
}

impl Stands {
    /// `urdf` and `base` of a cell file in `folder`, or of a channel.
    ///
    /// # Errors
    /// The values are not a file or not a position.
    fn read(section: &Section<'_>, folder: &Path) -> Result<Self, SettingsError> {
        let urdf = section.text("urdf", "a URDF file, like \"arm.urdf\"")?;
        Ok(Self { urdf: urdf.map(|file| folder.join(file)), base: bodies::place(section, "base")? })
    }
}

/// The home points of a robot besides the one in its own file.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Homes {
    /// Home points 2 to 5: axis positions in deg (mm where linear).
    pub points: [Option<Vec<f64>>; 4],
    /// The distance from a home point that counts as at home, in deg (mm); `None`: as for the first robot, and for that
    /// 0.1.
    pub tolerance: Option<f64>,
}

/// The deviation of the axes' torques from the model above which it counts as a collision.
#[derive(Clone, PartialEq, Debug)]
pub enum Sensitivity {
    /// Percent of the largest torque that each axis of the robot needs without load.
    Percent(f64),
    /// Nm (N of linear axes), for each of the robot's own axes.
    Torques(Vec<f64>),
}

impl Programs {
    /// The programs of a cell file. Robots are files in `folder` if these exist, otherwise names.
    ///
    /// # Errors
    /// The values are not channels.
    pub fn read(top: &Section<'_>, folder: &Path) -> Result<Self, SettingsError> {
        let tables = tables(top, "channel", "tables that begin with [[channel]]")?;
        let mut channels = Vec::new();
        for value in tables {
            let channel = channel(top.source, value, folder)?;
            let others = channels.iter().filter(|other: &&CellChannel| !other.background).count();
            if !channel.background && others + 2 > MOST_FOREGROUND {
                let text = format!(
                    "one foreground channel too many: at most {MOST_FOREGROUND} are possible, the first one included"
                );
                return Err(top.source.error(value.span(), text));
            }
            channels.push(channel);
        }
        Ok(Self { channels, load: load(top)? })
    }
}

impl Homes {
    /// Reads `[home]` of a cell file.
    ///
    /// # Errors
    /// The values are not home points.
    pub fn of_cell(top: &Section<'_>) -> Result<Self, SettingsError> {
        top.table("home", "[home]", HOME)?.map_or(Ok(Self::default()), |home| Self::read(&home))
    }

    fn read(section: &Section<'_>) -> Result<Self, SettingsError> {
        let tolerance = section.number("tolerance", "a distance in deg", 0.0, 90.0)?;
        let mut points = [const { None }; 4];
        for (place, key) in points.iter_mut().zip(HOMES) {
            *place = numbers(section, key, POSITIONS)?;
        }
        Ok(Self { points, tolerance })
    }
}

/// Reads `[[collision]]` of a cell file, or of a channel.
///
/// # Errors
/// The values are not conditions.
pub fn collisions(section: &Section<'_>) -> Result<Vec<(u8, Sensitivity)>, SettingsError> {
    let tables = tables(section, "collision", "tables that begin with [[collision]]")?;
    tables.iter().map(|value| collision(section.source, value)).collect()
}

/// The items of a list of tables; empty if it is missing.
fn tables<'a>(section: &Section<'a>, key: &str, what: &str) -> Result<&'a [Value<'a>], SettingsError> {
    let Some(found) = section.find(key) else { return Ok(&[]) };
    found.get_ref().as_array().map(|array| &array[..]).ok_or_else(|| section.wrong(key, found, what))
}

fn channel(source: Source<'_>, value: &Value<'_>, folder: &Path) -> Result<CellChannel, SettingsError> {
    let section = table(source, value, "[[channel]]", CHANNEL)?;
    let program = section.text("program", "the file of a program")?;
    let program = program.ok_or_else(|| source.error(value.span(), "[[channel]] lacks `program`: the file to run"))?;
    let background = match section.find("background") {
        None => false,
        Some(found) => match found.get_ref() {
            DeValue::Boolean(background) => *background,
            _ => return Err(section.wrong("background", found, "true or false")),
        },
    };
    if background {
        let of_robots = CHANNEL.iter().filter(|key| !["program", "background"].contains(key));
        for key in of_robots {
            if let Some(found) = section.find(key) {
                let text =
                    format!("[[channel]] has both `background` and `{key}`, but a background channel has no robot");
                return Err(source.error(found.span(), text));
            }
        }
    }
    let robot = section.text("robot", "the name or the file of a robot")?;
    Ok(CellChannel {
        line: source.line(value.span().start),
        program: program.to_owned(),
        robot: robot.map(|robot| beside(folder, robot)),
        stands: Stands::read(&section, folder)?,
        driver: DriverSettings::read(&section, "[channel.driver]")?,
        background,
        load: load(&section)?,
        homes: Homes::read(&section)?,
        collisions: collisions(&section)?,
    })
}

/// `load`: programs that `switcharl` can load.
fn load(section: &Section<'_>) -> Result<Vec<String>, SettingsError> {
    const WHAT: &str = "a list of programs, like [\"recipe1.arl\", \"recipe2.arl\"]";
    let Some(value) = section.find("load") else { return Ok(Vec::new()) };
    let array = value.get_ref().as_array().ok_or_else(|| section.wrong("load", value, WHAT))?;
    let files = array.iter().map(|item| match item.get_ref() {
        DeValue::String(file) => Ok(file.to_string()),
        _ => Err(section.wrong("load", item, WHAT)),
    });
    files.collect()
}

/// A robot file beside the cell file, or the name of a built-in robot.
fn beside(folder: &Path, robot: &str) -> String {
    let file: PathBuf = folder.join(robot);
    if file.is_file() { file.display().to_string() } else { robot.to_owned() }
}

fn numbers(section: &Section<'_>, key: &str, what: &str) -> Result<Option<Vec<f64>>, SettingsError> {
    let Some(value) = section.find(key) else { return Ok(None) };
    let array = value.get_ref().as_array().ok_or_else(|| section.wrong(key, value, what))?;
    let items = array.iter().map(|item| number(item.get_ref()).ok_or_else(|| section.wrong(key, item, what)));
    items.collect::<Result<_, _>>().map(Some)
}

fn collision(source: Source<'_>, value: &Value<'_>) -> Result<(u8, Sensitivity), SettingsError> {
    let section = table(source, value, "[[collision]]", COLLISION)?;
    let cid = section.count("cid", "the number of a condition", 16)?;
    let cid = cid.ok_or_else(|| source.error(value.span(), "[[collision]] lacks `cid`: a number from 0 to 16"))?;
    let percent = section.number("percent", "percent", 0.1, 1000.0)?;
    let sensitivity = match (percent, numbers(&section, "torque", TORQUES)?) {
        (Some(percent), None) => Sensitivity::Percent(percent),
        (None, Some(torques)) if torques.iter().all(|torque| *torque > 0.0) => Sensitivity::Torques(torques),
        (None, Some(_)) => return Err(source.error(value.span(), format!("`torque`: expected {TORQUES}"))),
        (percent, _) => {
            let found =
                if percent.is_some() { "both `percent` and `torque`" } else { "neither `percent` nor `torque`" };
            return Err(source.error(value.span(), format!("[[collision]] has {found}: expected one of them")));
        }
    };
    Ok((cid as u8, sensitivity))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn programs(text: &str) -> Result<Programs, SettingsError> {
        Cell::parse("cells/cell.toml", text).map(|cell| cell.programs)
    }

    #[test]
    fn channels_have_programs_robots_and_what_belongs_to_these() {
        let text = "load = [\"r.arl\"]\n[io]\ndi = 3\n[[channel]]\nprogram = \"a.arl\"\nrobot = \"hsr065\"\n\
                    load = [\"s.arl\"]\nhome3 = [1, 2, 3, 4]\ntolerance = 0.5\n[[channel.collision]]\ncid = 2\npercent = 5\n\
                    [[channel]]\nprogram = \"w.arl\"\nbackground = true\n";
        let Programs { channels, load } = programs(text).unwrap();
        assert_eq!(load, ["r.arl"]);
        let [first, second] = channels.as_slice() else { panic!("two channels") };
        assert_eq!(
            (first.program.as_str(), first.robot.as_deref(), first.background),
            ("a.arl", Some("hsr065"), false)
        );
        assert_eq!(
            (first.homes.points[1].as_deref(), first.homes.tolerance),
            (Some(&[1.0, 2.0, 3.0, 4.0][..]), Some(0.5))
        );
        assert_eq!(first.collisions, [(2, Sensitivity::Percent(5.0))]);
        assert_eq!((second.program.as_str(), second.robot.as_deref(), second.background), ("w.arl", None, true));
        assert_eq!(programs(""), Ok(Programs::default()));
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("[[channel]]\nrobot = \"hsr065\"", 1, "lacks `program`"),
            ("[[channel]]\nprogram = 3", 2, "the file of a program"),
            ("[[channel]]\nprogram = \"a\"\nbackground = 1", 3, "true or false"),
            ("[[channel]]\nprogram = \"a\"\nbackground = true\nrobot = \"hsr065\"", 4, "both `background` and `robot`"),
            ("[[channel]]\nprogram = \"a\"\nbackground = true\nhome2 = []", 4, "both `background` and `home2`"),
            ("[[channel]]\nprogramm = \"a\"", 2, "did you mean `program`?"),
            (&"[[channel]]\nprogram = \"a\"\n".repeat(6), 11, "at most 6 are possible, the first one included"),
            ("channel = 3", 1, "tables that begin with [[channel]]"),
            ("load = \"a.arl\"", 1, "a list of programs"),
            ("[[channel]]\nprogram = \"a\"\n[[channel.collision]]\ncid = 17\npercent = 20", 4, "from 0 to 16"),
        ] {
            let error = programs(text).unwrap_err();
            assert!(error.line == line && error.message.contains(words), "{error}");
        }
    }
}
