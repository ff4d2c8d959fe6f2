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

/// What a controller can be given before it starts. By default it has the default robot, simulated, the default cell,
/// and the virtual clock; messages go to the standard output, system variables are kept in memory only.
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
    /// Whether code outside may change something: drivers that are not ours, apart from those of robots.
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
    /// Adds the next foreground channel, 2 to 6, with its own program and robot. The first channel runs the program
    /// that is passed to [`Builder::build`].
    pub fn foreground(mut self, channel: Foreground) -> Self {
        self.foreground.push(channel);
        self
    }

    /// Adds the next background channel: a program without a robot.
    pub fn background(mut self, program: impl Program) -> Self {
        self.background.push(Box::new(program));
        self
    }

    /// Adds a program that `switcharl` can load into a foreground channel, by the name of its file.
    pub fn loadable(mut self, name: impl Into<String>, make: impl Fn() -> Box<dyn Program> + 'static) -> Self {
        self.programs.add(name.into(), Box::new(make));
        self
    }

    /// A function that sets global variables. It is called each time that a program with globals of this type has given
    /// them their first values and those of its data files, at its start and after a reset, before `main` runs. It runs
    /// within a cycle and must be quick.
    ///
    /// `docs/embedding.md` has an example.
    pub fn on_init<G: 'static>(mut self, set: impl Fn(&G) + 'static) -> Self {
        self.initialised.push(Box::new(move |program| program.globals().downcast_ref().map_or((), &set)));
        self
    }

    /// Gives a global variable another first value, by its name in any case and as a literal of ARL: `("pitch",
    /// "80.5")`, `("feeder", "{z 120}")`. Components that the literal leaves out keep their values. The value is set
    /// when the function of [`Builder::on_init`] is called, and only in programs that were compiled with the names of
    /// their variables. A name that several files have is written `FILE::NAME`.
    pub fn global(mut self, name: impl Into<String>, literal: impl Into<String>) -> Self {
        self.named.push(Named::new(name.into(), literal.into()));
        self
    }

    /// The robot of the first channel; by default the default robot of the program's family.
    pub fn robot(mut self, robot: Robot) -> Self {
        self.body.robot = Some(robot);
        self
    }

    /// The cell: what stands around the robot.
    pub fn cell(mut self, cell: Cell) -> Self {
        self.cell = cell;
        self
    }

    /// The clock, which gives the time of the cycles.
    pub fn clock(mut self, clock: impl Clock + 'static) -> Self {
        self.clock = Box::new(clock);
        self
    }

    /// The driver of the first channel's robot.
    pub fn robot_driver(mut self, driver: impl RobotDriver + 'static) -> Self {
        self.body.drive(driver);
        self
    }

    /// Drives the robots that have a `[driver]` in the cell, with the drivers that `connect` makes from their settings:
    /// `arl_drivers::connect`. By default the cell's drivers are ignored, and its robots are simulated. A
    /// [driver](Builder::robot_driver) that was given takes precedence over that of the cell.
    pub fn drivers(mut self, connect: Connect) -> Self {
        self.connect = Some(connect);
        self
    }

    /// The driver of inputs and outputs, in addition to the islands of the cell.
    pub fn io_driver(mut self, driver: impl IoDriver + 'static) -> Self {
        self.io = Box::new(driver);
        self.has_outside = true;
        self
    }

    /// The DeviceNet bus; by default a simulated one, of the size that the cell gives.
    pub fn devicenet(mut self, bus: impl DeviceNet + 'static) -> Self {
        self.devicenet = Some(Box::new(bus));
        self.has_outside = true;
        self
    }

    /// The driver that sets up the network ports of the host (`setip`); by default nothing sets them up.
    pub fn network_driver(mut self, driver: impl NetworkDriver + 'static) -> Self {
        self.network = Some(Box::new(driver));
        self
    }

    /// The scenario, which plays the outside world.
    pub fn scenario(mut self, scenario: Scenario) -> Self {
        self.scenario = scenario;
        self
    }

    /// The output for the messages of `print`.
    pub fn output(mut self, output: impl Output + 'static) -> Self {
        self.output = Some(Box::new(output));
        self
    }

    /// A listener that is called with every alarm, of all channels, in the cycle in which it is raised. It runs within
    /// that cycle and must be quick. [`Controller::take_alarms`](crate::Controller::take_alarms) returns them as well.
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
    /// let received: std::rc::Rc<std::cell::RefCell<Vec<(ChannelId, u32)>>> = std::rc::Rc::clone(&alarms);
    /// let mut controller = Controller::builder()
    ///     .output(messages.clone())
    ///     .on_alarm(move |alarm| received.borrow_mut().push((alarm.channel, alarm.line)))
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

    /// A channel that receives all events, for other threads, from the very start: messages, warnings, alarms, and each
    /// change of the state. They wait in the channel until they are received.
    pub fn events(mut self, tell: Sender<Event>) -> Self {
        self.subscribers.push(tell);
        self
    }

    /// A listener that is called with every warning when it is raised: what is not an alarm but worth reporting, such
    /// as a button that cannot act now. [`Controller::take_warnings`](crate::Controller::take_warnings) returns them as
    /// well.
    pub fn on_warning(mut self, listener: impl FnMut(&str) + 'static) -> Self {
        self.listeners.warning = Some(Box::new(listener));
        self
    }

    /// The storage for system variables.
    pub fn storage(mut self, storage: impl Storage + 'static) -> Self {
        self.storage = Box::new(storage);
        self
    }

    /// The directory of the program's files; by default the current one.
    pub fn script_dir(mut self, path: impl Into<PathBuf>) -> Self {
        self.script_dir = path.into();
        self
    }

    /// The writer for the trace of the first channel's robot, as CSV.
    pub fn trace(mut self, writer: impl Write + 'static) -> Self {
        self.body.trace = Some(Box::new(writer));
        self
    }

    /// Appends a column `file` to the traces of all robots: the file that the motion's line belongs to, empty where no
    /// motion is executed.
    pub fn trace_files(mut self) -> Self {
        self.trace_more.file = true;
        self
    }

    /// Keeps a record of every motion, for [`Controller::motions`](crate::Controller::motions).
    pub fn record_motions(mut self) -> Self {
        self.record = true;
        self
    }

    /// The operating mode; by default automatic.
    pub fn mode(mut self, mode: Controlmode) -> Self {
        self.mode = mode;
        self
    }

    /// The speed override at the start; by default 100 %.
    pub fn speed_override(mut self, speed: Override) -> Self {
        self.speed_override = speed;
        self
    }

    /// The seed of `rand`.
    pub fn seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }

    /// The date at which the controller starts, in s since 1970-01-01 00:00:00; by default 2000-01-01.
    pub fn start_date(mut self, seconds: i64) -> Self {
        self.start_date = seconds;
        self
    }

    /// How many bytes of stack the program's functions may use; by default 1 MiB. The thread must have some 256 KiB
    /// more: that of [`Controller::spawn`](crate::Controller::spawn) has enough for the default.
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
