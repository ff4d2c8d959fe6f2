//! The state that all channels of a controller share: time, io, files, messages, alarms.

use std::cell::{Cell, RefCell};
use std::fmt;
use std::rc::Rc;
use std::sync::mpsc::Sender;

use crate::communication::{NetworkDriver, NetworkSettings, Opener};
use crate::context::output::{Message, Output};
use crate::context::random::Random;
use crate::context::subscribers::{Event, Subscribers};
use crate::context::watcher::Watcher;
use crate::cycle::catch_panic::catch_panic;
use crate::cycle::channel_id::ChannelId;
use crate::fault::Alarm;
use crate::fieldbus::Buses;
use crate::io::Image;
use crate::storage::disk::Disk;
use crate::storage::script_dir::ScriptDir;
use crate::storage::state::KeptState;
use arl_robot::cell::Rate;
use arl_robot::cell::Wiring;

/// The state that all channels of a controller share: time, io, files, messages, alarms. Borrows of the cells end
/// within the call that makes them.
pub(crate) struct SharedState {
    /// The running number of the cycle.
    pub(crate) now: Cell<u64>,
    pub(crate) rate: Rate,
    pub(crate) io: RefCell<Image>,
    pub(crate) scripts: ScriptDir,
    pub(crate) random: Random,
    /// The date at cycle 0, in s since 1970-01-01 00:00:00.
    pub(crate) start_date: i64,
    output: RefCell<Box<dyn Output>>,
    /// Whether messages were printed in this cycle.
    spoken: Cell<bool>,
    /// Alarms that have not been taken yet.
    alarms: RefCell<Vec<Alarm>>,
    /// Warnings that have not been taken yet: what is not an alarm but worth reporting.
    warnings: RefCell<Vec<String>>,
    /// The listeners for alarms and warnings.
    listeners: RefCell<Listeners>,
    /// The listeners and outputs that have panicked.
    panicked: RefCell<Vec<&'static str>>,
    /// Other threads that receive all events.
    pub(crate) subscribers: Subscribers,
    pub(crate) state: RefCell<KeptState>,
    /// Writes files, beside the cycle.
    pub(crate) disk: Disk,
    /// The cell's settings for the network.
    pub(crate) network: NetworkSettings,
    /// How the cell wires a PLC.
    pub(crate) wiring: Wiring,
    /// The driver that sets up the network ports of the host, if any.
    pub(crate) network_driver: RefCell<Option<Box<dyn NetworkDriver>>>,
    /// Whether a program communicates with the outside world, so that cycles have to run in real time.
    needs_real_time: Cell<bool>,
    pub(crate) buses: Buses,
    /// Opens the connections of programs.
    pub(crate) opener: Opener,
    /// The debugger's watcher, which may halt programs at their statements.
    watcher: RefCell<Option<Rc<dyn Watcher>>>,
}

/// Is called with each alarm or warning.
type Listener<T> = Box<dyn FnMut(&T)>;

/// The listeners for alarms and warnings, called as soon as these are raised.
#[derive(Default)]
pub(crate) struct Listeners {
    pub(crate) alarm: Option<Listener<Alarm>>,
    pub(crate) warning: Option<Listener<str>>,
}

/// The parts from which a shared state is made.
pub(crate) struct Parts {
    pub(crate) rate: Rate,
    pub(crate) io: Image,
    pub(crate) scripts: ScriptDir,
    pub(crate) random: Random,
    pub(crate) start_date: i64,
    pub(crate) output: Box<dyn Output>,
    pub(crate) listeners: Listeners,
    pub(crate) subscribers: Vec<Sender<Event>>,
    pub(crate) state: KeptState,
    pub(crate) network: NetworkSettings,
    pub(crate) wiring: Wiring,
    pub(crate) buses: Buses,
    pub(crate) network_driver: Option<Box<dyn NetworkDriver>>,
}

impl SharedState {
    pub(crate) fn new(parts: Parts) -> Self {
        Self {
            buses: parts.buses,
            opener: Opener::default(),
            watcher: RefCell::default(),
            network: parts.network,
            wiring: parts.wiring,
            network_driver: RefCell::new(parts.network_driver),
            needs_real_time: Cell::new(false),
            now: Cell::new(0),
            rate: parts.rate,
            io: RefCell::new(parts.io),
            scripts: parts.scripts,
            random: parts.random,
            start_date: parts.start_date,
            output: RefCell::new(parts.output),
            spoken: Cell::new(false),
            alarms: RefCell::default(),
            listeners: RefCell::new(parts.listeners),
            panicked: RefCell::default(),
            warnings: RefCell::default(),
            subscribers: Subscribers::new(parts.subscribers),
            state: RefCell::new(parts.state),
            disk: Disk::default(),
        }
    }

    /// Passes on a message of a channel.
    pub(crate) fn message(&self, channel: ChannelId, hmi: bool, console: bool, text: &[u8]) {
        let time = self.rate.time(self.now.get());
        let message = Message { time, channel, hmi, console, text };
        self.let_hear("the output", || self.output.borrow_mut().message(&message));
        self.spoken.set(true);
        self.subscribers.tell(|| Event::Message { time, channel, text: String::from_utf8_lossy(text).into_owned() });
    }

    /// Calls a listener or an output. Where it panics, only what was reported to it is lost, and the cycle goes on; the
    /// first panic gives a warning.
    fn let_hear(&self, who: &'static str, tell: impl FnOnce()) {
        let lost = catch_panic(tell).is_none();
        if lost && !self.panicked.borrow().contains(&who) {
            self.panicked.borrow_mut().push(who);
            self.warn(format!("{who} has panicked: what was reported to it is lost"));
        }
    }

    /// Flushes the messages at the end of a cycle.
    pub(crate) fn flush(&self) {
        if self.spoken.replace(false) {
            self.let_hear("the output", || self.output.borrow_mut().flush());
        }
    }

    /// Notes that the program communicates with the outside world: from now on cycles have to run in real time.
    pub(crate) fn need_real_time(&self) {
        self.needs_real_time.set(true);
    }

    /// Whether real time was requested since the last call.
    #[inline]
    pub(crate) fn take_real_time_need(&self) -> bool {
        self.needs_real_time.replace(false)
    }

    /// Adds an alarm; the one that ends a program is put before the others.
    pub(crate) fn alarm(&self, alarm: Alarm, ends: bool) {
        self.let_hear("the function given to `on_alarm`", || {
            if let Some(listener) = &mut self.listeners.borrow_mut().alarm {
                listener(&alarm);
            }
        });
        self.subscribers.tell(|| Event::Alarm(alarm.clone()));
        let mut alarms = self.alarms.borrow_mut();
        let place = if ends { 0 } else { alarms.len() };
        alarms.insert(place, alarm);
    }

    /// Sets the watcher, which may halt programs at their statements.
    pub(crate) fn watch(&self, watcher: Rc<dyn Watcher>) {
        *self.watcher.borrow_mut() = Some(watcher);
    }

    /// The watcher, which may halt programs at their statements.
    pub(crate) fn watcher(&self) -> Option<Rc<dyn Watcher>> {
        self.watcher.borrow().clone()
    }

    /// The alarms since the last call.
    pub(crate) fn take_alarms(&self) -> Vec<Alarm> {
        std::mem::take(&mut self.alarms.borrow_mut())
    }

    /// Adds a warning: what is not an alarm but worth reporting.
    pub(crate) fn warn(&self, text: String) {
        self.let_hear("the function given to `on_warning`", || {
            if let Some(listener) = &mut self.listeners.borrow_mut().warning {
                listener(&text);
            }
        });
        self.subscribers.tell(|| Event::Warning(text.clone()));
        self.warnings.borrow_mut().push(text);
    }

    /// The warnings since the last call.
    #[inline]
    pub(crate) fn take_warnings(&self) -> Vec<String> {
        std::mem::take(&mut self.warnings.borrow_mut())
    }
}

impl fmt::Debug for SharedState {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("SharedState").field("now", &self.now.get()).finish_non_exhaustive()
    }
}
