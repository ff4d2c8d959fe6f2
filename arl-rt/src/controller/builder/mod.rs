//! The builder of a controller: what it can be given before it starts.

mod assembly;
mod setup_error;

use std::fmt;
use std::io::Write;
use std::path::PathBuf;
use std::sync::mpsc::Sender;

use super::channel::PROGRAM_STACK_BYTES;
use super::foreground::{Body, Foreground};
use crate::builtins::time;
use crate::communication::NetworkDriver;
use crate::context::named::Named;
use crate::context::output::Output;
use crate::context::program::Program;
use crate::context::programs::{Initialised, Loadable};
use crate::context::random;
use crate::context::shared_state::Listeners;
use crate::context::subscribers::Event;
use crate::controller::trace::More;
use crate::cycle::clock_source::{Clock, VirtualClock};
use crate::fault::Alarm;
use crate::fieldbus::devicenet::DeviceNet;
use crate::io::{IoDriver, Scenario, SimulatedIo};
use crate::storage::state::{Memory, Storage};
use crate::unit::robot_driver::{Connect, RobotDriver};
use crate::values::Controlmode;
use arl_motion::Override;
use arl_robot::cell::Cell;
use arl_robot::robot::Robot;

pub use setup_error::SetupError;

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
    subscribers: Vec<Sender<Event>>,
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
            subscribers: Vec::new(),
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
    /// be quick. [`Controller::take_alarms`](crate::Controller::take_alarms) gives them as well.
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
        self.subscribers.push(tell);
        self
    }

    /// What is told every warning when it comes up: what is not an alarm but worth a word, such as a button that cannot
    /// act now. [`Controller::take_warnings`](crate::Controller::take_warnings) gives them as well.
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

    /// Keeps a record of every motion, for [`Controller::motions`](crate::Controller::motions).
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
    /// [`Controller::spawn`](crate::Controller::spawn) has room for 1 MiB, which is what holds without this.
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
}

impl fmt::Debug for Builder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Builder").field("cell", &self.cell).finish_non_exhaustive()
    }
}
