//! Puts a builder's parts together: stored data, robots, buses, channels, the controller.

use std::cell::RefCell;
use std::mem;
use std::ops::BitOr;
use std::rc::Rc;

use super::{Body, Builder, Foreground, SetupError, setup_error::word};
use crate::context::channel_state::{ChannelState, Station};
use crate::context::output::Stream;
use crate::context::program::{Beside, Program};
use crate::context::programs::Programs;
use crate::context::random::Random;
use crate::context::shared_state::{Parts, SharedState};
use crate::context::system::{self, Common, System};
use crate::context::wiring;
use crate::controller::channel::Channel;
use crate::controller::channels::Channels;
use crate::controller::drive::drive;
use crate::controller::external::External;
use crate::controller::handle::HandleCalls;
use crate::controller::late_limit::LateLimit;
use crate::controller::pointer_store::PointerStore;
use crate::controller::trace::{More, Trace};
use crate::controller::{Controller, State as RunState};
use crate::cycle::channel_id::{ChannelId, MOST_FOREGROUND};
use crate::fieldbus::Buses;
use crate::fieldbus::devicenet::{DeviceNet, SimulatedDeviceNet};
use crate::fieldbus::islands::Islands;
use crate::io::{Image, Playing};
use crate::storage::pointers::{self, PointerTable};
use crate::storage::script_dir::ScriptDir;
use crate::storage::state::{KeptState, Memory, Storage};
use crate::unit::Unit;
use crate::values::{self, Controlmode};
use arl_motion::Override;
use arl_robot::atomic_file;
use arl_robot::cell::fit;
use arl_robot::kinematics::frame;
use arl_robot::robot::{Family, Robot, RobotError};

/// How many cycles may be lost within a second by default where robots are driven.
const LATE_LIMIT: u32 = 20;

impl Builder {
    /// Builds the controller, with its programs before their first cycle; `program` runs in the first channel.
    ///
    /// # Errors
    /// The parts do not fit each other, or stored data is damaged.
    pub fn build(self, program: impl Program) -> Result<Controller, SetupError> {
        self.build_boxed(Box::new(program))
    }

    fn build_boxed(mut self, program: Box<dyn Program>) -> Result<Controller, SetupError> {
        let needs_the_world = self.connect_robots()?;
        let uses = self.check_programs(&*program)?;
        let Kept { common, state, pointers, beside } = self.load_kept()?;
        let (robot, others) = self.robots(&*program)?;
        let (rate, program_count) = (self.cell.rate, 1 + self.foreground.len() + self.background.len());
        let image = Image::new(&self.cell.channels).for_programs(program_count);
        let scenario = Playing::new(mem::take(&mut self.scenario), &image, rate);
        let Outside { buses, islands, note } = self.outside(uses)?;
        let has_drives = self.body.has_driver || self.foreground.iter().any(|it| it.body.has_driver);
        let late_limit = self.cell.late.limit.or(has_drives.then_some(LATE_LIMIT));
        let external = External::new(self.cell.external.enabled);

        let needs_real_time = needs_the_world || buses.is_outside() || !islands.is_empty();
        let shared = Rc::new(self.shared_state(image, state, buses));
        if needs_real_time {
            shared.need_real_time();
        }
        if let Some(note) = note {
            shared.warn(note);
        }
        start_threads(&shared, uses.connections, beside.is_some());

        let site = Site {
            shared: Rc::clone(&shared),
            common,
            home_tolerance: self.cell.homes.tolerance.unwrap_or(HOME_TOLERANCE),
            speed_override: self.speed_override,
            record: self.record,
            trace_more: self.trace_more,
            stack: self.stack,
            pointers: pointers.clone(),
            programs: Rc::new(Programs::new(self.programs, self.initialised)),
        };
        let (first, unit) = site.foreground(1, program, robot, self.body)?;
        let channels = site.others(others.into_iter().zip(self.foreground), self.background)?;
        let effects = Vec::with_capacity(scenario.max_effects());
        let pointer_store = beside.map(|storage| start_pointer_store(storage, pointers)).transpose()?;
        if let Some(late) = self.cell.late.late {
            self.clock.set_late(late);
        }
        self.io.start().map_err(SetupError::Io)?;
        Ok(Controller {
            shared,
            channels: Channels::new(first, channels),
            unit,
            clock: self.clock,
            late_limit: LateLimit::new(late_limit, rate.cycles(1.0)),
            // The first cycle begins when the controller is stepped.
            had_ended: true,
            islands,
            io: self.io,
            scenario,
            names: self.cell.names,
            effects,
            external,
            has_outside: self.has_outside || has_drives,
            calls: HandleCalls::default(),
            notified_state: RunState::Running,
            pointer_store,
            stores_from: 0,
            awake_until: 0,
        })
    }

    /// Gives drivers to the robots that are driven. Returns whether one of them needs real time.
    fn connect_robots(&mut self) -> Result<bool, SetupError> {
        self.body.settings = self.cell.driver.take();
        let Some(connect) = self.connect else { return Ok(false) };
        let bodies = std::iter::once(&mut self.body).chain(self.foreground.iter_mut().map(|it| &mut it.body));
        drive(bodies, connect, &mut self.clock)
    }

    /// Checks that there is room for the programs, and that they have the global variables that are to be set. Returns
    /// what they use beside the cycle.
    fn check_programs(&mut self, program: &dyn Program) -> Result<Beside, SetupError> {
        check_channels(1 + self.foreground.len(), self.background.len())?;
        let others = self.foreground.iter().map(|it| &it.program).chain(&self.background);
        let all: Vec<&dyn Program> = std::iter::once(program).chain(others.map(|program| &**program)).collect();
        all.iter().for_each(|program| atomic_file::remove_leftovers(&self.script_dir.join(program.folder())));
        // Errors are reported now; the values are set again when the variables have their first values.
        let named = mem::take(&mut self.named);
        named.iter().try_for_each(|named| named.put(&all)).map_err(SetupError::Global)?;
        self.initialised.push(Box::new(move |program| {
            named.iter().for_each(|named| drop(named.put(&[program])));
        }));
        Ok(all.iter().map(|program| program.beside()).fold(self.programs.beside(), Beside::bitor))
    }

    /// Loads what was stored when the controller was last on.
    fn load_kept(&mut self) -> Result<Kept, SetupError> {
        let common = Rc::new(Common::new());
        let mut state = KeptState::new(mem::replace(&mut self.storage, Box::new(Memory::default())));
        system::load(&common.kept_own(), &mut state)?;
        let pointers = load_pointers(&mut state)?;
        let beside = state.another();
        // The wiring of the cell holds, whatever a program has saved.
        wiring::apply(&self.cell.external, &common);
        common.ctl_mode.set(self.mode);
        Ok(Kept { common, state, pointers, beside })
    }

    /// The robots of the first channel and of the others, checked to fit programs, cell and scenario.
    fn robots(&mut self, program: &dyn Program) -> Result<(Robot, Vec<Robot>), SetupError> {
        let cell = &self.cell;
        self.body.homes = cell.homes.clone();
        self.body.collisions = cell.collisions.clone();
        self.body.base = cell.stands.base.map(values::Frame::of_components);
        let first = robot_of(&self.body, program)?;
        let others = self.foreground.iter().map(|it| robot_of(&it.body, &*it.program));
        let others: Vec<Robot> = others.collect::<Result<_, SetupError>>()?;
        let all: Vec<&Robot> = std::iter::once(&first).chain(&others).collect();
        self.scenario.check(&cell.channels, &all).map_err(SetupError::Cell)?;
        Ok((first, others))
    }

    /// Starts the buses and islands.
    fn outside(&mut self, uses: Beside) -> Result<Outside, SetupError> {
        let settings = mem::take(&mut self.cell.buses);
        let simulated = || Box::new(SimulatedDeviceNet::new(settings.devicenet)) as Box<dyn DeviceNet>;
        let devicenet = self.devicenet.take().unwrap_or_else(simulated);
        let buses = Buses::new(settings, devicenet);
        let note = buses.start(uses.modbus_tcp && self.clock.is_real()).map_err(SetupError::Outside)?;
        let islands = Islands::start(&self.cell.islands).map_err(SetupError::Outside)?;
        Ok(Outside { buses, islands, note })
    }

    /// What all channels share.
    fn shared_state(&mut self, io: Image, state: KeptState, buses: Buses) -> SharedState {
        SharedState::new(Parts {
            rate: self.cell.rate,
            io,
            scripts: ScriptDir::new(mem::take(&mut self.script_dir)),
            random: Random::new(self.seed),
            start_date: self.start_date,
            output: self.output.take().unwrap_or_else(|| Box::new(Stream::standard())),
            listeners: mem::take(&mut self.listeners),
            subscribers: mem::take(&mut self.subscribers),
            state,
            network: mem::take(&mut self.cell.network),
            wiring: mem::take(&mut self.cell.external),
            buses,
            network_driver: self.network.take(),
        })
    }
}

/// What was stored when the controller was last on.
struct Kept {
    common: Rc<Common>,
    state: KeptState,
    pointers: PointerTable,
    /// The same storage, for a thread that writes beside the cycle; `None`: the storage is in memory.
    beside: Option<Box<dyn Storage + Send>>,
}

/// What exchanges signals with the outside world.
struct Outside {
    buses: Buses,
    islands: Islands,
    /// A note for the user on how they started.
    note: Option<String>,
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
fn load_pointers(state: &mut KeptState) -> Result<PointerTable, SetupError> {
    match state.load(pointers::STORED)? {
        Some(text) => Ok(pointers::read(&text).ok_or_else(|| state.damaged(pointers::STORED))?),
        None => Ok(PointerTable::default()),
    }
}

/// Starts the threads that open connections and write files, before a cycle needs them. Where the system has no thread
/// for it now, the first connection to be opened, or the first file to be written, tries again.
fn start_threads(shared: &SharedState, opens_connections: bool, writes_files: bool) {
    if opens_connections {
        let _ = shared.opener.start();
    }
    if writes_files {
        let _ = shared.disk.start();
    }
}

/// Starts the thread that stores where the programs stand.
fn start_pointer_store(storage: Box<dyn Storage + Send>, pointers: PointerTable) -> Result<PointerStore, SetupError> {
    PointerStore::start(storage, pointers).map_err(|error| {
        SetupError::Outside(format!("the thread that saves the program pointers cannot be started: {error}"))
    })
}

/// How near to a home point counts as at home by default, in deg (mm).
const HOME_TOLERANCE: f64 = 0.1;

/// What channels are set up from.
struct Site {
    shared: Rc<SharedState>,
    common: Rc<Common>,
    home_tolerance: f64,
    speed_override: Override,
    record: bool,
    trace_more: More,
    stack: usize,
    pointers: PointerTable,
    /// The programs of the controller, as each program sees the others.
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
        let trace = body.trace.map(|writer| Trace::new(writer, self.trace_more));
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

    /// The channels beyond the first: foreground channels from number 2, then background channels from 1.
    fn others(
        &self,
        foreground: impl Iterator<Item = (Robot, Foreground)>,
        background: Vec<Box<dyn Program>>,
    ) -> Result<Vec<Channel>, SetupError> {
        let foreground = (2..).zip(foreground).map(|(number, (robot, Foreground { program, body }))| {
            self.foreground(number, program, robot, body).map(|(channel, _)| channel)
        });
        let mut channels: Vec<Channel> = foreground.collect::<Result<_, _>>()?;
        for (number, program) in (1..).zip(background) {
            channels.push(self.background(number, 1 + channels.len(), program));
        }
        Ok(channels)
    }

    /// A background channel with this number, at this place among all channels.
    fn background(&self, number: u8, index: usize, program: Box<dyn Program>) -> Channel {
        let id = ChannelId::Background(number);
        let system = System::beside(Rc::clone(&self.common), id);
        self.channel(ChannelState::background(Rc::clone(&self.shared), id, index, system), program, None)
    }

    fn channel(&self, channel_state: ChannelState, program: Box<dyn Program>, trace: Option<Trace>) -> Channel {
        channel_state.reset_system();
        // The system variables about the robot hold from the first statement on.
        if let Some(unit) = channel_state.robot() {
            channel_state.update_system(&unit);
        }
        Channel::new(Rc::new(channel_state), Rc::from(program), Rc::clone(&self.programs), self.stack, trace)
    }
}

/// The robot for a program, checked to fit the program and the robot's own settings.
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
