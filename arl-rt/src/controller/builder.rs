//! The builder of a controller: what it can be given before it starts.

use std::cell::RefCell;
use std::fmt;
use std::io::Write;
use std::ops::BitOr;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::mpsc::Sender;

use super::Controller;
use super::channel::{Channel, PROGRAM_STACK_BYTES};
use super::channels::Channels;
use super::drive::drive;
use super::external::External;
use super::foreground::{Body, Foreground};
use super::handle::Calls;
use super::late_limit::LateLimit;
use super::pointer_store::PointerStore;
use crate::builtins::time;
use crate::communication::NetworkDriver;
use crate::context::channel_state::{ChannelState, Station};
use crate::context::hearers::Event;
use crate::context::named::{GlobalError, Named};
use crate::context::output::{Output, Stream};
use crate::context::program::{Beside, Program};
use crate::context::programs::{Initialised, Loadable, Programs};
use crate::context::random::{self, Random};
use crate::context::shared_state::{Listeners, Parts, SharedState};
use crate::context::system::{self, Common, System};
use crate::context::wiring;
use crate::controller::trace::{More, Trace};
use crate::cycle::channel_id::{ChannelId, MOST_FOREGROUND};
use crate::cycle::clock_source::{Clock, VirtualClock};
use crate::fault::Alarm;
use crate::fieldbus::Buses;
use crate::fieldbus::devicenet::{DeviceNet, SimulatedDeviceNet};
use crate::fieldbus::islands::Islands;
use crate::io::{DriverError, Image, IoDriver, Playing, Scenario, SimulatedIo};
use crate::storage::pointers::{self, Table};
use crate::storage::script_dir::ScriptDir;
use crate::storage::state::{Memory, State, StateError, Storage};
use crate::unit::Unit;
use crate::unit::robot_driver::{Connect, RobotDriver};
use crate::values::{self, Controlmode};
use arl_motion::Override;
use arl_robot::atomic_file;
use arl_robot::cell::{Cell, SettingsError, fit};
use arl_robot::kinematics::frame;
use arl_robot::robot::{Family, Robot, RobotError};

/// So many cycles may be lost within a second where robots are driven, and nobody says otherwise.
const LATE_LIMIT: u32 = 20;

/// What a controller can be given before it starts. Without anything it has the default robot, simulated, the default
/// cell, and the virtual clock; messages go to the standard output, system variables are kept in memory only.
pub struct Builder {
    /// The first channel's robot.
    body: Body,
    /// The other foreground channels.
    foreground: Vec<Foreground>,
    background: Vec<Box<dyn Program>>,
    programs: Loadable,
    initialised: Vec<Initialised>,
    named: Vec<Named>,
    cell: Cell,
    clock: Box<dyn Clock>,
    connect: Option<Connect>,
    io: Box<dyn IoDriver>,
    devicenet: Option<Box<dyn DeviceNet>>,
    network: Option<Box<dyn NetworkDriver>>,
    scenario: Scenario,
    output: Option<Box<dyn Output>>,
    listeners: Listeners,
    hearers: Vec<Sender<Event>>,
    storage: Box<dyn Storage>,
    script_dir: PathBuf,
    record: bool,
    trace_more: More,
    mode: Controlmode,
    speed_override: Override,
    seed: u64,
    start_date: i64,
    stack: usize,
    /// Whether somebody outside may change something: drivers that are not ours, beside those of robots.
    has_outside: bool,
}

impl Default for Builder {
    fn default() -> Self {
        Self {
            body: Body::default(),
            foreground: Vec::new(),
            background: Vec::new(),
            programs: Loadable::default(),
            initialised: Vec::new(),
            named: Vec::new(),
            cell: Cell::default(),
            clock: Box::new(VirtualClock::new()),
            connect: None,
            io: Box::new(SimulatedIo),
            devicenet: None,
            network: None,
            scenario: Scenario::default(),
            output: None,
            listeners: Listeners::default(),
            hearers: Vec::new(),
            storage: Box::new(Memory::default()),
            script_dir: PathBuf::from("."),
            record: false,
            trace_more: More::default(),
            mode: Controlmode::Auto,
            speed_override: Override::FULL,
            seed: random::SEED,
            start_date: time::YEAR_2000,
            stack: PROGRAM_STACK_BYTES,
            has_outside: false,
        }
    }
}

impl Builder {
    /// Adds the next foreground channel, 2 to 6, with its own program and robot. The first one is the program that
    /// [`Builder::build`] gets.
    pub fn foreground(mut self, channel: Foreground) -> Self {
        self.foreground.push(channel);
        self
    }

    /// Adds the next background channel: a program without a robot.
    pub fn background(mut self, program: impl Program) -> Self {
        self.background.push(Box::new(program));
        self
    }

    /// A program that `switcharl` can load into a foreground channel, by the name of its file.
    pub fn loadable(mut self, name: impl Into<String>, make: impl Fn() -> Box<dyn Program> + 'static) -> Self {
        self.programs.add(name.into(), Box::new(make));
        self
    }

    /// What sets global variables: it is called each time that a program with globals of this type has given them their
    /// first values and those of its data files, at its start and after a reset, before `main` runs. It runs within a
    /// cycle and must be quick.
    ///
    /// `docs/embedding.md` has an example.
    pub fn on_init<G: 'static>(mut self, set: impl Fn(&G) + 'static) -> Self {
        self.initialised.push(Box::new(move |program| program.globals().downcast_ref().map_or((), &set)));
        self
    }

    /// Gives a global variable another first value, by its name in any case and as a literal of ARL: `("pitch",
    /// "80.5")`, `("feeder", "{z 120}")`. Components that the literal leaves out keep theirs. It comes when
    /// [`Builder::on_init`] does, and only to programs that were compiled with the names of their variables. A name
    /// that several files have is written `FILE::NAME`.
    pub fn global(mut self, name: impl Into<String>, literal: impl Into<String>) -> Self {
        self.named.push(Named::new(name.into(), literal.into()));
        self
    }

    /// The robot of the first channel; without it the default robot of the program's family.
    pub fn robot(mut self, robot: Robot) -> Self {
        self.body.robot = Some(robot);
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

    /// What moves the robot of the first channel.
    pub fn robot_driver(mut self, driver: impl RobotDriver + 'static) -> Self {
        self.body.drive(driver);
        self
    }

    /// Drives the robots that the cell has a `[driver]` for, with what this makes of it: `arl_drivers::connect`.
    /// Without it the cell's drivers do not count, and its robots are simulated. A [driver](Builder::robot_driver) of
    /// one's own goes before that of the cell.
    pub fn drivers(mut self, connect: Connect) -> Self {
        self.connect = Some(connect);
        self
    }

    /// What exchanges inputs and outputs, beside the islands of the cell.
    pub fn io_driver(mut self, driver: impl IoDriver + 'static) -> Self {
        self.io = Box::new(driver);
        self.has_outside = true;
        self
    }

    /// The DeviceNet bus; without it a simulated one, of the size that the cell gives.
    pub fn devicenet(mut self, bus: impl DeviceNet + 'static) -> Self {
        self.devicenet = Some(Box::new(bus));
        self.has_outside = true;
        self
    }

    /// What sets up the network ports of the host (`setip`); without it nothing does.
    pub fn network_driver(mut self, driver: impl NetworkDriver + 'static) -> Self {
        self.network = Some(Box::new(driver));
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

    /// What is told every alarm, of all channels, in the cycle in which it comes up. It runs within that cycle and must
    /// be quick. [`Controller::take_alarms`] gives them as well.
    ///
    /// ```
    /// use arl_rt::emit::*;
    /// use arl_rt::{Captured, Controller, Foreground, Outcome};
    /// use arl_rt::status::ChannelId;
    ///
    /// /// Divides by a number, by hand what the compiler emits.
    /// struct Divide(i32);
    ///
    /// impl arl_rt::Program for Divide {
    ///     fn file(&self) -> File {
    ///         File::new("divide.arl")
    ///     }
    ///     fn family(&self) -> Family {
    ///         Family::SixAxis
    ///     }
    ///     fn main<'a>(&'a self, cx: &'a Cx) -> BoxFuture<'a> {
    ///         Box::pin(async move {
    ///             flow::waittime(0.5).run(cx).await.at(self.file(), 2)?;
    ///             let parts = arl_rt::emit::div(12, self.0).at(self.file(), 3)?;
    ///             text::print().argtoprint(&parts).run(cx).at(self.file(), 4)
    ///         })
    ///     }
    /// }
    ///
    /// let (alarms, messages) = (std::rc::Rc::default(), Captured::new());
    /// let heard: std::rc::Rc<std::cell::RefCell<Vec<(ChannelId, u32)>>> = std::rc::Rc::clone(&alarms);
    /// let mut controller = Controller::builder()
    ///     .output(messages.clone())
    ///     .on_alarm(move |alarm| heard.borrow_mut().push((alarm.channel, alarm.line)))
    ///     .foreground(Foreground::new(Box::new(Divide(0))))
    ///     .build(Box::new(Divide(3)))?;
    /// controller.run_for(0.4);
    /// controller.press(arl_rt::io::Pendant::Pause);
    /// controller.run_for(1.0);
    /// assert_eq!(controller.state(), arl_rt::State::Paused);
    /// controller.resume();
    /// assert!(matches!(controller.run(), Outcome::Alarm(_)));
    /// assert_eq!(*alarms.borrow(), [(ChannelId::Foreground(2), 3)]);
    /// assert_eq!(messages.text(), "4\n");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn on_alarm(mut self, listener: impl FnMut(&Alarm) + 'static) -> Self {
        self.listeners.alarm = Some(Box::new(listener));
        self
    }

    /// Where all that happens goes, for other threads, from the very start: messages, warnings, alarms, and each change
    /// of the state. They wait in the channel until somebody takes them.
    pub fn events(mut self, tell: Sender<Event>) -> Self {
        self.hearers.push(tell);
        self
    }

    /// What is told every warning when it comes up: what is no alarm but worth a word, such as a button that cannot act
    /// now. [`Controller::take_warnings`] gives them as well.
    pub fn on_warning(mut self, listener: impl FnMut(&str) + 'static) -> Self {
        self.listeners.warning = Some(Box::new(listener));
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

    /// Where the trace of the first channel's robot goes, as CSV.
    pub fn trace(mut self, writer: impl Write + 'static) -> Self {
        self.body.trace = Some(Box::new(writer));
        self
    }

    /// The traces of all robots have a column `file` behind the others: the file that the line of the motion is of,
    /// empty where none is executed.
    pub fn trace_files(mut self) -> Self {
        self.trace_more.file = true;
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

    /// The speed override at the start; without it 100 %.
    pub fn speed_override(mut self, speed: Override) -> Self {
        self.speed_override = speed;
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

    /// How many bytes of stack the program's functions may fill. The thread must have some 256 KiB more: that of
    /// [`Controller::spawn`] has room for 1 MiB, which is what holds without this.
    pub fn stack(mut self, bytes: usize) -> Self {
        self.stack = bytes;
        self
    }

    /// The foreground channels beyond the first.
    pub(super) fn others_mut(&mut self) -> &mut [Foreground] {
        &mut self.foreground
    }

    /// How many foreground channels there are, with the first one.
    pub(crate) fn foreground_count(&self) -> u8 {
        u8::try_from(self.foreground.len()).unwrap_or(u8::MAX).saturating_add(1)
    }

    /// The controller, with its programs at the start of the first cycle; this one runs in the first channel.
    ///
    /// # Errors
    /// The parts do not fit each other, or what was kept is damaged.
    pub fn build(self, program: impl Program) -> Result<Controller, SetupError> {
        self.build_boxed(Box::new(program))
    }

    fn build_boxed(mut self, program: Box<dyn Program>) -> Result<Controller, SetupError> {
        self.body.settings = self.cell.driver.take();
        let bodies = std::iter::once(&mut self.body).chain(self.foreground.iter_mut().map(|it| &mut it.body));
        let needs_the_world = self.connect.map_or(Ok(false), |connect| drive(bodies, connect, &mut self.clock))?;
        let Builder { cell, background, .. } = self;
        let count = 1 + self.foreground.len();
        check_channels(count, background.len())?;
        let all = std::iter::once(&program).chain(self.foreground.iter().map(|it| &it.program)).chain(&background);
        let all: Vec<&dyn Program> = all.map(|program| &**program).collect();
        all.iter().for_each(|program| atomic_file::remove_leftovers(&self.script_dir.join(program.folder())));
        // What does not fit is told now; what is put in comes once more when the variables have their first values.
        self.named.iter().try_for_each(|named| named.put(&all)).map_err(SetupError::Global)?;
        let named = self.named;
        self.initialised.push(Box::new(move |program| {
            named.iter().for_each(|named| drop(named.put(&[program])));
        }));
        let common = Rc::new(Common::new());
        let mut state = State::new(self.storage);
        system::load(&common.kept_own(), &mut state)?;
        let pointers = load_pointers(&mut state)?;
        let beside = state.another();
        // What the cell wires is so, whatever a program has saved.
        wiring::apply(&cell.external, &common);
        common.ctl_mode.set(self.mode);
        let io = Image::new(&cell.channels).for_programs(count + background.len());
        let rate = cell.rate;
        let (homes, collisions) = (cell.homes.clone(), cell.collisions.clone());
        let has_driver = self.body.has_driver;
        let body = Body { homes, collisions, base: cell.stands.base.map(values::Frame::of_components), ..self.body };
        let robot = robot_of(&body, &*program)?;
        let others = self.foreground.into_iter().map(|it| Ok((robot_of(&it.body, &*it.program)?, it)));
        let others: Vec<(Robot, Foreground)> = others.collect::<Result<_, SetupError>>()?;
        let robots: Vec<&Robot> = std::iter::once(&robot).chain(others.iter().map(|(robot, _)| robot)).collect();
        self.scenario.check(&cell.channels, &robots).map_err(SetupError::Cell)?;
        let scenario = Playing::new(self.scenario, &io, rate);
        let simulated = || Box::new(SimulatedDeviceNet::new(cell.buses.devicenet)) as Box<dyn DeviceNet>;
        let devicenet = self.devicenet.unwrap_or_else(simulated);
        let programs = std::iter::once(&program).chain(others.iter().map(|(_, it)| &it.program)).chain(&background);
        let uses = programs.map(|program| program.beside()).fold(self.programs.beside(), Beside::bitor);
        let buses = Buses::new(cell.buses, devicenet);
        let note = buses.start(uses.modbus_tcp && self.clock.is_real()).map_err(SetupError::Outside)?;
        let islands = Islands::start(&cell.islands).map_err(SetupError::Outside)?;
        let outside = buses.is_outside() || !islands.is_empty();
        let drives = has_driver || others.iter().any(|(_, it)| it.body.has_driver);
        let has_outside = self.has_outside || drives;
        let late_limit = LateLimit::new(cell.late.limit.or(drives.then_some(LATE_LIMIT)), rate.cycles(1.0));
        let external = External::new(cell.external.enabled);
        let shared = Rc::new(SharedState::new(Parts {
            rate,
            io,
            scripts: ScriptDir::new(self.script_dir),
            random: Random::new(self.seed),
            start_date: self.start_date,
            output: self.output.unwrap_or_else(|| Box::new(Stream::standard())),
            listeners: self.listeners,
            hearers: self.hearers,
            state,
            network: cell.network,
            wiring: cell.external,
            buses,
            network_driver: self.network,
        }));
        if outside || needs_the_world {
            shared.need_real_time();
        }
        if let Some(note) = note {
            shared.warn(note);
        }
        start_threads(&shared, uses.connections, beside.is_some());
        let site = Site {
            shared: Rc::clone(&shared),
            common,
            home_tolerance: cell.homes.tolerance.unwrap_or(HOME_TOLERANCE),
            speed_override: self.speed_override,
            record: self.record,
            trace_more: self.trace_more,
            stack: self.stack,
            pointers: pointers.clone(),
            programs: Rc::new(Programs::new(self.programs, self.initialised)),
        };
        let (first, unit) = site.foreground(1, program, robot, body)?;
        let mut channels = Vec::new();
        for (number, (robot, Foreground { program, body })) in (2..).zip(others) {
            channels.push(site.foreground(number, program, robot, body)?.0);
        }
        for (number, program) in (1..).zip(background) {
            let index = 1 + channels.len();
            channels.push(site.background(number, index, program));
        }
        let channels = Channels::new(first, channels);
        let effects = Vec::with_capacity(scenario.max_effects());
        let pointer_store = beside.map(|storage| start_pointer_store(storage, pointers)).transpose()?;
        let (mut clock, mut io) = (self.clock, self.io);
        if let Some(late) = cell.late.late {
            clock.set_late(late);
        }
        io.start().map_err(SetupError::Io)?;
        Ok(Controller {
            shared,
            channels,
            unit,
            clock,
            late_limit,
            // The first cycle begins when somebody steps.
            had_ended: true,
            islands,
            io,
            scenario,
            names: cell.names,
            effects,
            external,
            has_outside,
            calls: Calls::default(),
            told: super::State::Running,
            pointer_store,
            stores_from: 0,
            awake_until: 0,
        })
    }
}

/// Refuses more channels than a controller has.
fn check_channels(foreground: usize, background: usize) -> Result<(), SetupError> {
    if foreground > MOST_FOREGROUND {
        let text = format!("{foreground} foreground channels: a controller has at most {MOST_FOREGROUND}");
        return Err(SetupError::Channels(text));
    }
    if background > usize::from(u8::MAX) {
        return Err(SetupError::Channels(format!("{background} background channels: at most 255 are possible")));
    }
    Ok(())
}

/// Where the programs stood when the controller was switched off.
fn load_pointers(state: &mut State) -> Result<Table, SetupError> {
    match state.load(pointers::STORED)? {
        Some(text) => Ok(pointers::read(&text).ok_or_else(|| state.damaged(pointers::STORED))?),
        None => Ok(Table::default()),
    }
}

/// Starts the threads that open connections and write files, before a cycle needs them. Where the system has no thread
/// for it now, whoever opens the first connection, or writes the first file, tries again.
fn start_threads(shared: &SharedState, opens_connections: bool, writes_files: bool) {
    if opens_connections {
        let _ = shared.opener.start();
    }
    if writes_files {
        let _ = shared.disk.start();
    }
}

/// Starts the thread that keeps where the programs stand.
fn start_pointer_store(storage: Box<dyn Storage + Send>, pointers: Table) -> Result<PointerStore, SetupError> {
    PointerStore::start(storage, pointers).map_err(|error| {
        SetupError::Outside(format!("the thread that keeps where the programs stand cannot be started: {error}"))
    })
}

/// How near to a home point is at home where nobody says it, in deg (mm).
const HOME_TOLERANCE: f64 = 0.1;

/// What channels are set up with.
struct Site {
    shared: Rc<SharedState>,
    common: Rc<Common>,
    home_tolerance: f64,
    speed_override: Override,
    record: bool,
    trace_more: More,
    stack: usize,
    pointers: Table,
    /// The programs of the controller, as each of them sees the others.
    programs: Rc<Programs>,
}

impl Site {
    /// A foreground channel with this number, and its robot.
    fn foreground(
        &self,
        number: u8,
        program: Box<dyn Program>,
        robot: Robot,
        body: Body,
    ) -> Result<(Channel, Rc<RefCell<Unit>>), SetupError> {
        let id = ChannelId::Foreground(number);
        let system = System::beside(Rc::clone(&self.common), id);
        system::load(&system.kept_by_channel(), &mut self.shared.state.borrow_mut())?;
        let trace = body.trace.map(|writer| Trace::new(writer, self.trace_more)).transpose();
        let trace = trace.map_err(|error| SetupError::Trace(error.to_string()))?;
        let driver = |problem| SetupError::Driver { channel: number, problem };
        let mut unit = Unit::new(robot, body.driver, self.shared.rate.period()).map_err(driver)?;
        unit.settings.manual = self.common.ctl_mode.get() == Controlmode::Manual;
        if self.record {
            unit.record();
        }
        if let Some(base) = body.base {
            system.stand_on(base);
        }
        let base = system.base.with(|base| base.first().map_or_else(Default::default, |base| base.w_frame));
        unit.set_base(frame(base.components()));
        unit.set_override(self.speed_override);
        let unit = Rc::new(RefCell::new(unit));
        let index = usize::from(number).saturating_sub(1);
        let station = Station {
            unit: Rc::clone(&unit),
            homes: body.homes.points,
            home_tolerance: body.homes.tolerance.unwrap_or(self.home_tolerance),
            collisions: body.collisions,
            base: body.base,
            kept: self.pointers.get(index).cloned().unwrap_or_default(),
        };
        let channel =
            self.channel(ChannelState::foreground(Rc::clone(&self.shared), id, index, system, station), program, trace);
        self.programs.add(channel.cx());
        Ok((channel, unit))
    }

    /// A background channel with this number, at this place among all channels.
    fn background(&self, number: u8, index: usize, program: Box<dyn Program>) -> Channel {
        let id = ChannelId::Background(number);
        let system = System::beside(Rc::clone(&self.common), id);
        self.channel(ChannelState::background(Rc::clone(&self.shared), id, index, system), program, None)
    }

    fn channel(&self, channel_state: ChannelState, program: Box<dyn Program>, trace: Option<Trace>) -> Channel {
        channel_state.reset_system();
        // What it tells of the robot holds from the first statement on.
        if let Some(unit) = channel_state.robot() {
            channel_state.update_system(&unit);
        }
        Channel::new(Rc::new(channel_state), Rc::from(program), Rc::clone(&self.programs), self.stack, trace)
    }
}

/// The robot of a program, which fits it and what belongs to it.
fn robot_of(body: &Body, program: &dyn Program) -> Result<Robot, SetupError> {
    let family = program.family();
    let robot = match &body.robot {
        Some(robot) => robot.clone(),
        None => default_robot(family)?,
    };
    if robot.family != family {
        return Err(SetupError::Family { program: family, robot: robot.name.clone(), family: robot.family });
    }
    fit(&body.homes, &body.collisions, &robot).map_err(SetupError::Cell)?;
    Ok(robot)
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
    /// There are too many channels, or programs for them are not there.
    Channels(String),
    /// The cell or the scenario does not fit.
    Cell(String),
    /// What the cell has of the outside cannot be had.
    Outside(String),
    /// What was kept is damaged.
    State(StateError),
    /// The trace cannot be written.
    Trace(String),
    /// The robot of a channel cannot be had.
    Driver {
        /// The number of the channel, from 1.
        channel: u8,
        /// What its driver says.
        problem: DriverError,
    },
    /// The inputs and outputs of an io driver cannot be had; what it says.
    Io(DriverError),
    /// A global variable is not there, or does not take its value.
    Global(GlobalError),
    /// Whoever sets it up says why not.
    Other(String),
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
            SetupError::Channels(text)
            | SetupError::Cell(text)
            | SetupError::Outside(text)
            | SetupError::Other(text) => {
                write!(f, "{text}")
            }
            SetupError::Global(error) => write!(f, "{error}"),
            SetupError::State(error) => write!(f, "{error}"),
            SetupError::Trace(text) => write!(f, "the trace cannot be written: {text}"),
            SetupError::Driver { channel, problem } => {
                write!(f, "the robot of channel {channel} cannot be started: {problem}")
            }
            SetupError::Io(problem) => write!(f, "the io driver cannot be started: {problem}"),
        }
    }
}

impl std::error::Error for SetupError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            SetupError::Robot(error) => Some(error),
            SetupError::State(error) => Some(error),
            SetupError::Driver { problem, .. } | SetupError::Io(problem) => Some(problem),
            SetupError::Global(error) => Some(error),
            _ => None,
        }
    }
}

impl From<RobotError> for SetupError {
    fn from(error: RobotError) -> Self {
        SetupError::Robot(error)
    }
}

impl From<SettingsError> for SetupError {
    fn from(error: SettingsError) -> Self {
        SetupError::Cell(error.to_string())
    }
}

impl From<String> for SetupError {
    fn from(why: String) -> Self {
        SetupError::Other(why)
    }
}

impl From<StateError> for SetupError {
    fn from(error: StateError) -> Self {
        SetupError::State(error)
    }
}
