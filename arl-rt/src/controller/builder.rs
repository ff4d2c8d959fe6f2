//! What a controller can be given before it starts.

use std::fmt;
use std::io::Write;
use std::path::PathBuf;
use std::rc::Rc;

use super::Controller;
use super::channel::{Channel, STACK};
use crate::cell::{Cell, Sensitivity};
use crate::clock_source::{Clock, VirtualClock};
use crate::cx::Cx;
use crate::fieldbus::Buses;
use crate::fieldbus::devicenet::{DeviceNet, SimulatedDeviceNet};
use crate::files::ScriptDir;
use crate::io::{Image, IoDriver, Playing, Scenario, SimulatedIo};
use crate::kinematics::frame;
use crate::output::{Output, Stream};
use crate::program::Program;
use crate::random::{self, Random};
use crate::robot::{Family, Robot, RobotError};
use crate::robot_driver::{RobotDriver, SimulatedRobot};
use crate::state::{Memory, State, StateError, Storage};
use crate::system::{self, System};
use crate::time;
use crate::trace::Trace;
use crate::unit::Unit;
use crate::values::Controlmode;
use crate::world::{Parts, World};

/// What a controller can be given before it starts. Without anything it has the default robot, simulated, the default
/// cell, and the virtual clock; messages go to the standard output, system variables are kept in memory only.
pub struct Builder {
    robot: Option<Robot>,
    cell: Cell,
    clock: Box<dyn Clock>,
    driver: Box<dyn RobotDriver>,
    io: Box<dyn IoDriver>,
    devicenet: Box<dyn DeviceNet>,
    scenario: Scenario,
    output: Option<Box<dyn Output>>,
    storage: Box<dyn Storage>,
    script_dir: PathBuf,
    trace: Option<Box<dyn Write>>,
    record: bool,
    mode: Controlmode,
    speed_override: f64,
    seed: u64,
    start_date: i64,
    stack: usize,
}

impl Default for Builder {
    fn default() -> Self {
        Self {
            robot: None,
            cell: Cell::default(),
            clock: Box::new(VirtualClock::new()),
            driver: Box::new(SimulatedRobot::new()),
            io: Box::new(SimulatedIo),
            devicenet: Box::new(SimulatedDeviceNet::default()),
            scenario: Scenario::default(),
            output: None,
            storage: Box::new(Memory::default()),
            script_dir: PathBuf::from("."),
            trace: None,
            record: false,
            mode: Controlmode::Auto,
            speed_override: 100.0,
            seed: random::SEED,
            start_date: time::YEAR_2000,
            stack: STACK,
        }
    }
}

impl Builder {
    /// The robot; without it the default robot of the program's family.
    pub fn robot(mut self, robot: Robot) -> Self {
        self.robot = Some(robot);
        self
    }

    /// What stands around the robot.
    pub fn cell(mut self, cell: Cell) -> Self {
        self.cell = cell;
        self
    }

    /// Where the time comes from.
    pub fn clock(mut self, clock: impl Clock + 'static) -> Self {
        self.clock = Box::new(clock);
        self
    }

    /// What moves the robot.
    pub fn robot_driver(mut self, driver: impl RobotDriver + 'static) -> Self {
        self.driver = Box::new(driver);
        self
    }

    /// What exchanges inputs and outputs.
    pub fn io_driver(mut self, driver: impl IoDriver + 'static) -> Self {
        self.io = Box::new(driver);
        self
    }

    /// The DeviceNet bus.
    pub fn devicenet(mut self, bus: impl DeviceNet + 'static) -> Self {
        self.devicenet = Box::new(bus);
        self
    }

    /// What plays the outside.
    pub fn scenario(mut self, scenario: Scenario) -> Self {
        self.scenario = scenario;
        self
    }

    /// What takes the messages of `print`.
    pub fn output(mut self, output: impl Output + 'static) -> Self {
        self.output = Some(Box::new(output));
        self
    }

    /// Where system variables are kept.
    pub fn storage(mut self, storage: impl Storage + 'static) -> Self {
        self.storage = Box::new(storage);
        self
    }

    /// The directory of the program's files; without it the current one.
    pub fn script_dir(mut self, path: impl Into<PathBuf>) -> Self {
        self.script_dir = path.into();
        self
    }

    /// Where the trace goes, as CSV.
    pub fn trace(mut self, writer: impl Write + 'static) -> Self {
        self.trace = Some(Box::new(writer));
        self
    }

    /// Keeps a record of every motion, for [`Controller::motions`].
    pub fn record_motions(mut self) -> Self {
        self.record = true;
        self
    }

    /// The operating mode; without it automatic.
    pub fn mode(mut self, mode: Controlmode) -> Self {
        self.mode = mode;
        self
    }

    /// The speed override in %, 0 to 100.
    pub fn speed_override(mut self, percent: f64) -> Self {
        self.speed_override = percent;
        self
    }

    /// What `rand` starts from.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// The date at which the controller starts, in s since 1970-01-01 00:00:00; without it 2000-01-01.
    pub fn start_date(mut self, seconds: i64) -> Self {
        self.start_date = seconds;
        self
    }

    /// How many bytes of stack the program's functions may fill. The thread must have some 256 KiB more. Without it
    /// 1 MiB.
    pub fn stack(mut self, bytes: usize) -> Self {
        self.stack = bytes;
        self
    }

    /// The controller, with its program at the start of the first cycle.
    ///
    /// # Errors
    /// The parts do not fit each other, or what was kept is damaged.
    pub fn build(mut self, program: Box<dyn Program>) -> Result<Controller, SetupError> {
        let robot = match self.robot.take() {
            Some(robot) => robot,
            None => default_robot(program.family())?,
        };
        self.check(&robot, program.family())?;
        let system = System::new();
        let mut state = State::new(self.storage);
        system::load(&system, &mut state)?;
        system.ctl_mode.set(self.mode);
        let rate = self.cell.rate;
        let trace = self.trace.map(|writer| Trace::new(writer, robot.family)).transpose();
        let trace = trace.map_err(|error| SetupError::Trace(error.to_string()))?;
        let mut unit = Unit::new(robot, self.driver);
        unit.settings.manual = self.mode == Controlmode::Manual;
        if self.record {
            unit.record();
        }
        let base = system.base.with(|base| base.first().map_or_else(Default::default, |base| base.w_frame));
        unit.set_base(frame(base.components()));
        let image = Image::new(&self.cell.channels);
        let scenario = Playing::new(self.scenario, &image, rate);
        let buses = Buses::new(self.cell.buses, self.devicenet);
        buses.start().map_err(SetupError::Outside)?;
        let (outside, real_time) = (buses.is_outside(), self.clock.is_real());
        let world = Rc::new(World::new(Parts {
            rate,
            system,
            io: image,
            unit,
            scripts: ScriptDir::new(self.script_dir),
            random: Random::new(self.seed),
            start_date: self.start_date,
            output: self.output.unwrap_or_else(|| Box::new(Stream::standard())),
            state,
            network: self.cell.network,
            homes: self.cell.homes,
            home_tolerance: self.cell.home_tolerance,
            collisions: self.cell.collisions,
            buses,
            real_time,
        }));
        if outside {
            world.meet_outside();
        }
        world.reset_system();
        world.set_override(self.speed_override);
        let program: Rc<dyn Program> = Rc::from(program);
        let cx = Rc::new(Cx::new(Rc::clone(&world), Rc::clone(&program)));
        let channel = Channel::new(program, cx, self.stack);
        Ok(Controller { world, channel, clock: self.clock, io: self.io, scenario, trace })
    }

    /// Whether the parts fit the robot and a program for this family.
    fn check(&self, robot: &Robot, program: Family) -> Result<(), SetupError> {
        if robot.family != program {
            return Err(SetupError::Family { program, robot: robot.name.clone(), family: robot.family });
        }
        for home in self.cell.homes.iter().flatten() {
            if home.len() != robot.axes.len() {
                let (found, name, axes) = (home.len(), &robot.name, robot.axes.len());
                let text = format!("a home point of the cell has {found} positions; robot {name} has {axes} axes");
                return Err(SetupError::Cell(text));
            }
        }
        for (cid, sensitivity) in &self.cell.collisions {
            let (own, name) = (robot.own_axes().len(), &robot.name);
            if let Sensitivity::Torques(torques) = sensitivity
                && torques.len() != own
            {
                let found = torques.len();
                let text =
                    format!("collision condition {cid} of the cell has {found} torques; robot {name} has {own} axes");
                return Err(SetupError::Cell(text));
            }
        }
        self.scenario.check(&self.cell.channels, robot).map_err(SetupError::Cell)
    }
}

/// The first built-in robot of the family.
fn default_robot(family: Family) -> Result<Robot, RobotError> {
    let mut robots = Robot::builtin_names().filter_map(|name| Robot::builtin(name).ok());
    match robots.find(|robot| robot.family == family) {
        Some(robot) => Ok(robot),
        None => Robot::load(word(family)),
    }
}

/// The family as robot files spell it.
fn word(family: Family) -> &'static str {
    match family {
        Family::SixAxis => "six-axis",
        Family::Scara => "scara",
    }
}

impl fmt::Debug for Builder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Builder").field("cell", &self.cell).finish_non_exhaustive()
    }
}

/// Why a controller cannot be set up.
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum SetupError {
    /// The robot is wrong.
    Robot(RobotError),
    /// The program was checked for another build of robot.
    Family {
        /// The build that the program was checked for.
        program: Family,
        /// The robot's name.
        robot: String,
        /// The robot's build.
        family: Family,
    },
    /// The cell or the scenario does not fit.
    Cell(String),
    /// What the cell has of the outside cannot be had.
    Outside(String),
    /// What was kept is damaged.
    State(StateError),
    /// The trace cannot be written.
    Trace(String),
}

impl fmt::Display for SetupError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            SetupError::Robot(error) => write!(f, "{error}"),
            SetupError::Family { program, robot, family } => write!(
                f,
                "the program was checked for a {} robot, but robot {robot} is a {} one",
                word(*program),
                word(*family)
            ),
            SetupError::Cell(text) | SetupError::Outside(text) => write!(f, "{text}"),
            SetupError::State(error) => write!(f, "{error}"),
            SetupError::Trace(text) => write!(f, "the trace cannot be written: {text}"),
        }
    }
}

impl std::error::Error for SetupError {}

impl From<RobotError> for SetupError {
    fn from(error: RobotError) -> Self {
        SetupError::Robot(error)
    }
}

impl From<StateError> for SetupError {
    fn from(error: StateError) -> Self {
        SetupError::State(error)
    }
}
