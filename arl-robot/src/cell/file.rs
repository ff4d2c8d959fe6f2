//! The cell file: the surroundings of the robot. All settings have sensible defaults.
//!
//! ```toml
//! urdf = "arm.urdf"            # how the robot looks: without it as capsules along its links
//! base = [0, 0, 500]           # where it stands in the world, mm, with a, b, c in deg if it is turned: `$BASE[0]` at
//!                              # the start
//!
//! [controller]
//! cycle = 1.0                  # ms, 0.1 to 100
//! late = "grid"                # where cycles are late, their points of time stay a grid; "skip": it begins anew there
//! late_limit = 20              # so many cycles may be lost within a second, before robots stop
//!
//! [driver]                     # what moves the robot where a run drives it; of a channel: [channel.driver]
//! protocol = "udp"             # or "rsi", with `listen` in place of `address`
//! address = "192.168.0.30:7447"  # where the arm listens
//! time = "world"               # "robot": that of a simulated one
//!
//! [io]                         # numbers of channels
//! di = 64
//! do = 64
//! ai = 8                       # all in V, or a list: ["V", "mA"]
//! ao = ["V", "V", "mA"]
//! internal = 32
//!
//! [names]                      # what signals are called: in scenarios, on the pendant, in editors
//! "di.1" = "part_present"
//!
//! [network]
//! listen = "program"           # where accept listens: without it on this computer only ("loopback"); or an address
//!
//! [serial]                     # devices behind the names that programs use
//! "/dev/ttyS0" = "/dev/ttyUSB0"
//!
//! [home]                       # axis positions in deg (mm where linear); home 1 is `home` of the robot file
//! tolerance = 0.1              # how near is at home, deg (mm)
//! home2 = [0, -90, 90, 0, 0, 0]
//!
//! [external]                   # how a PLC is wired: the system variables of external auto control, in small letters
//! start_prog_di = 4
//!
//! [[collision]]                # conditions of startdetect
//! cid = 1                      # 0 to 16
//! percent = 20                 # how much an axis may differ, of what it needs at most; or for each axis, in Nm (N):
//! # torque = [60, 60, 40, 15, 15, 10]
//!
//! [modbus_tcp]                 # the controller's Modbus TCP server
//! address = "127.0.0.1"        # "0.0.0.0": reachable from everywhere
//! port = 502
//! connections = 8              # at once, 1 to 64
//!
//! [devicenet]
//! size = 512                   # bytes that the bus exchanges
//!
//! [[island]]                   # inputs and outputs behind Modbus TCP
//! address = "192.168.0.20"
//! di = [{ channel = 1, count = 8, discrete_input = 0 }]
//!
//! [[carrier]]                  # what an external axis of a robot moves: a turntable, a slide
//! axis = "ej1"                 # it turns about z, slides along z where the axis is linear; `channel`: whose axis,
//!                              # without it 1
//! at = [1200, 0, 400]          # where it is while the axis is at 0; `on = "ej2"`: on the carrier of that axis
//!
//! [[body]]                     # what the robots can run into, or carry
//! name = "table"
//! box = [800, 600, 40]         # edges in mm; or cylinder = [radius, length], sphere = radius, mesh = "FILE.stl",
//!                              # urdf = "FILE.urdf"
//! at = [900, 0, -20]           # its middle in the world, mm, with a, b, c in deg behind if it is turned
//!
//! [[body]]
//! name = "part"
//! cylinder = [20, 50]
//! at = [0, 0, 120]             # in the flange
//! on = "flange"                # of channel = 1
//! when = "do.1"                # only while this is on; or, in the world at first: gripped_by = "do.1"
//!
//! [[channel]]                  # what runs beside the program of the command line: channel 2, 3, ..
//! program = "feeder.arl"       # files count from the folder of the cell file
//! robot = "hsr065"             # a built-in name or a robot file
//! base = [900, 0, 0, 180, 0, 0]  # `urdf`, too
//! home2 = [0, 45, 0, 0]        # [[channel.collision]] below it: conditions of startdetect
//!
//! [[channel]]
//! program = "watch.arl"
//! background = true            # it has no robot
//! ```

use super::{
    Body, BusSettings, Carrier, DriverSettings, Homes, LateCycles, Names, NetworkSettings, Programs, Rate, Sensitivity,
    Stands, Wiring, collisions,
};
use crate::changes::{Changes, Part};
use crate::channels::Channels;
use crate::islands::Island;
use crate::regular_file;
use crate::settings::{Section, SettingsError, Source};
use std::path::Path;

const TOP: &[&str] = &[
    "controller",
    "io",
    "names",
    "network",
    "serial",
    "home",
    "external",
    "collision",
    "modbus_tcp",
    "island",
    "devicenet",
    "body",
    "carrier",
    "channel",
    "load",
    "urdf",
    "base",
    "driver",
];
const CONTROLLER: &[&str] = &["cycle", "late", "late_limit"];

/// The surroundings of the robot.
#[derive(Clone, PartialEq, Default, Debug)]
pub struct Cell {
    /// The length of the control cycle.
    pub rate: Rate,
    /// The handling of late cycles.
    pub late: LateCycles,
    /// The I/O channels.
    pub channels: Channels,
    /// The names of signals.
    pub names: Names,
    /// The addresses on which programs listen.
    pub network: NetworkSettings,
    /// The home points of the first channel's robot.
    pub homes: Homes,
    /// How a PLC is wired to the controller.
    pub external: Wiring,
    /// The conditions of `startdetect` of the first channel's robot, by number; missing ones have 20 %.
    pub collisions: Vec<(u8, Sensitivity)>,
    /// The field buses.
    pub buses: BusSettings,
    /// The Modbus TCP servers with inputs and outputs of the cell.
    pub islands: Vec<Island>,
    /// The shape of the first channel's robot, and its base in the world.
    pub stands: Stands,
    /// The driver of the first channel's robot; `None` if it is simulated.
    pub driver: Option<DriverSettings>,
    /// The objects moved by external axes of its robots.
    pub carriers: Vec<Carrier>,
    /// The objects in the cell, or carried by robots.
    pub bodies: Vec<Body>,
    /// The channels besides the first one, which the command for a program runs, too.
    pub programs: Programs,
}

impl Cell {
    /// How many channels of the cell have a robot, beside the first channel, which is that of the program itself.
    pub fn further_foreground_channels(&self) -> usize {
        self.programs.channels.iter().filter(|channel| !channel.background).count()
    }

    /// Reads a cell file.
    ///
    /// # Errors
    /// The file cannot be read, or its content is not a cell.
    pub fn load(path: &Path) -> Result<Cell, SettingsError> {
        Cell::load_with(path, &Changes::default())
    }

    /// Like `load`, with changed values at some places.
    ///
    /// # Errors
    /// As for [`load`](Self::load); or the file does not have one of the places.
    pub fn load_with(path: &Path, changes: &Changes) -> Result<Cell, SettingsError> {
        let name = path.display().to_string();
        let text = regular_file::read_text(path)
            .map_err(|error| SettingsError::of_file(&name, format!("cannot read the cell file: {error}")))?;
        Cell::parse(&name, &changes.apply(Part::Cell, &name, text)?)
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
            cell.late = LateCycles::read(&controller)?;
        }
        cell.channels = Channels::read(&top)?;
        cell.names = Names::read(&top, &cell.channels)?;
        cell.network = NetworkSettings::read(&top)?;
        cell.buses = BusSettings::read(&top)?;
        cell.islands = Island::read_all(source, top.find("island"), &cell.channels)?;
        let folder = Path::new(file).parent().unwrap_or(Path::new(""));
        cell.programs = Programs::read(&top, folder)?;
        cell.stands = Stands::read(&top, folder)?;
        cell.driver = DriverSettings::read(&top, "[driver]")?;
        let others = cell.further_foreground_channels();
        let foreground = 1 + others as u32;
        cell.carriers = Carrier::read_all(&top, foreground)?;
        cell.bodies = Body::read_all(&top, &cell.channels, &cell.names, foreground, &cell.carriers, folder)?;
        cell.external = Wiring::read(&top, &cell.channels)?;
        cell.homes = Homes::of_cell(&top)?;
        cell.collisions = collisions(&top)?;
        Ok(cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cell::{Late, Listen};
    use crate::channels::AnalogType;

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
        let text = "[controller]\ncycle = 4\nlate = \"skip\"\nlate_limit = 5\n[io]\ndi = 16\ndo = 8\nai = [\"V\", \"ma\"]\nao = 2\ninternal = 0\n\
                    [home]\ntolerance = 0.5\nhome3 = [0, 1.5, 2, 3, 4, 5]\n\
                    [[collision]]\ncid = 2\npercent = 10\n[[collision]]\ncid = 3\ntorque = [1, 2.5]\n";
        let cell = Cell::parse("cell.toml", text).unwrap();
        assert_eq!(cell.rate.micros(), 4000);
        assert_eq!(cell.late, LateCycles { late: Some(Late::Skip), limit: Some(5) });
        assert_eq!((cell.channels.di, cell.channels.dout, cell.channels.internal), (16, 8, 0));
        assert_eq!(cell.channels.ai, [AnalogType::Volt, AnalogType::Milliampere]);
        assert_eq!(cell.channels.ao, [AnalogType::Volt; 2]);
        assert_eq!(cell.homes.points[1].as_deref(), Some(&[0.0, 1.5, 2.0, 3.0, 4.0, 5.0][..]));
        assert_eq!((cell.homes.points[0].as_ref(), cell.homes.tolerance), (None, Some(0.5)));
        let torques = Sensitivity::Torques(vec![1.0, 2.5]);
        assert_eq!(cell.collisions, [(2, Sensitivity::Percent(10.0)), (3, torques)]);
    }

    #[test]
    fn network_lines_buses_and_islands_are_read() {
        for (word, listen) in [
            ("loopback", Listen::Loopback),
            ("program", Listen::Program),
            ("192.168.0.40", Listen::Address("192.168.0.40".into())),
            ("::", Listen::Address("::".into())),
        ] {
            let cell = Cell::parse("cell.toml", &format!("[network]\nlisten = \"{word}\"\n")).unwrap();
            assert_eq!(cell.network.listen, listen);
        }
        let text = "[serial]\n\"/dev/ttyS0\" = \"/dev/ttyUSB0\"\nrtserMB0 = \"/dev/ttyUSB1\"\n[devicenet]\nsize = 16\n\
                    [modbus_tcp]\naddress = \"0.0.0.0\"\nport = 1502\nconnections = 2\n\
                    [[island]]\naddress = \"10.0.0.7\"\ndo = [{ channel = 1, coil = 0 }]\n";
        let cell = Cell::parse("cell.toml", text).unwrap();
        let devices: Vec<(&str, &str)> = cell.network.devices.iter().map(|(name, path)| (&**name, &**path)).collect();
        assert_eq!(devices, [("/dev/ttyS0", "/dev/ttyUSB0"), ("rtserMB0", "/dev/ttyUSB1")]);
        assert_eq!((cell.buses.devicenet, cell.islands.len()), (16, 1));
        let server = cell.buses.modbus_tcp.unwrap();
        assert_eq!((server.address.to_string(), server.connections), ("0.0.0.0:1502".into(), 2));
    }

    #[test]
    fn mistakes_name_line_and_what_was_expected() {
        for (text, line, words) in [
            ("[network]\nlisten = \"everywhere\"", 2, "\"loopback\", \"program\", or an address"),
            ("[network]\nlisten = 3", 2, "found the number 3"),
            ("[network]\nlistens = \"program\"", 2, "did you mean `listen`?"),
            ("network = \"program\"", 1, "expected the table [network]"),
            ("serial = \"/dev/ttyS0\"", 1, "expected the table [serial]"),
            ("[serial]\ncom1 = 1", 2, "the path of a device, like \"/dev/ttyUSB0\", found the number 1"),
            ("[devicenet]\nsize = 70000", 2, "how many bytes the bus exchanges from 0 to 65536"),
            ("[modbus_tcp]\nport = 65536", 2, "a TCP port"),
            ("[modbus_tcp]\naddress = \"plc\"", 2, "an IP address of this computer"),
            ("[modbus_tcp]\nconnections = 0", 2, "a whole number from 1 to 64"),
            ("[[island]]\naddress = \"10.0.0.7\"\ndo = [{ channel = 65, coil = 0 }]", 3, "the cell has DO 1 to 64"),
            ("[io]\ndi = 64\ndoo = 3", 3, "did you mean `do`?"),
            (
                "\n[inout]\n",
                2,
                "expected one of: controller, io, names, network, serial, home, external, collision, modbus_tcp",
            ),
            ("[io]\ndi = -1", 2, "expected a number of channels from 0 to 10000, found the number -1"),
            ("[io]\ndi = \"many\"", 2, "found the text \"many\""),
            ("[io]\nai = [\"V\",\n \"A\"]", 3, "expected \"V\" or \"mA\""),
            ("[controller]\nlate = \"never\"", 2, "expected \"grid\" or \"skip\", found the text \"never\""),
            ("[controller]\nlate_limit = 2.5", 2, "a whole number: how many cycles may be lost within a second"),
            ("[controller]\nlate_limit = -1", 2, "how many cycles may be lost within a second from 0"),
            ("[controller]\ncycle = 0", 2, "the control cycle in ms from 0.1 to 100"),
            ("[home]\nhome2 = 3", 2, "expected axis positions"),
            ("[home]\nhome2 = [0,", 2, "this is not TOML"),
            ("[[collision]]\npercent = 20", 1, "lacks `cid`"),
            ("[[collision]]\ncid = 1", 1, "neither `percent` nor `torque`"),
            ("[[collision]]\ncid = 17\npercent = 20", 2, "the number of a condition from 0 to 16"),
            ("[[collision]]\ncid = 1\ntorque = [1, 0]", 1, "a torque above 0 in Nm for each axis"),
            ("io = 3", 1, "expected the table [io], found the number 3"),
        ] {
            let error = Cell::parse("cell.toml", text).unwrap_err();
            assert_eq!(error.line, line, "{error}");
            assert!(error.message.contains(words), "{error}");
        }
    }
}
