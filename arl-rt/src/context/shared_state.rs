//! The state that all channels of a controller share: time, io, files, messages, alarms.

use std::cell::{Cell, RefCell};
use std::fmt;
use std::rc::Rc;
use std::sync::mpsc::Sender;

use crate::communication::{NetworkDriver, NetworkSettings, Opener};
use crate::context::output::{Message, Output};
use crate::context::random::Random;
use crate::context::subscribers::{Event, Hearers};
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

/// What all channels of a controller share: time, io, files, messages, alarms. Borrows of the cells end within the call
/// that makes them.
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
    /// Whether messages came in this cycle.
    spoken: Cell<bool>,
    /// Alarms that nobody has asked for yet.
    alarms: RefCell<Vec<Alarm>>,
    /// What happened that is not an alarm but worth a word.
    warnings: RefCell<Vec<String>>,
    /// Who wants to hear of alarms and warnings at once.
    listeners: RefCell<Listeners>,
    /// Which of those who hear something have panicked.
    panicked: RefCell<Vec<&'static str>>,
    /// Threads that hear of everything.
    pub(crate) subscribers: Hearers,
    pub(crate) state: RefCell<KeptState>,
    /// What writes files, beside the cycle.
    pub(crate) disk: Disk,
    /// What the cell says of the network.
    pub(crate) network: NetworkSettings,
    /// How the cell wires a PLC.
    pub(crate) wiring: Wiring,
    /// What sets up the network ports of the host, if anything does.
    pub(crate) network_driver: RefCell<Option<Box<dyn NetworkDriver>>>,
    /// Whether a program talks to the world, so that the world's time counts.
    needs_real_time: Cell<bool>,
    pub(crate) buses: Buses,
    /// What opens the connections of programs.
    pub(crate) opener: Opener,
    /// Who may halt programs at their statements.
    watcher: RefCell<Option<Rc<dyn Watcher>>>,
}

/// Somebody who wants to hear of something.
type Listener<T> = Box<dyn FnMut(&T)>;

/// Who wants to hear of alarms and warnings as they come up.
#[derive(Default)]
pub(crate) struct Listeners {
    pub(crate) alarm: Option<Listener<Alarm>>,
    pub(crate) warning: Option<Listener<str>>,
}

/// What a world is made of.
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
            subscribers: Hearers::new(parts.subscribers),
            state: RefCell::new(parts.state),
            disk: Disk::default(),
        }
    }

    /// Passes a message of a channel on.
    pub(crate) fn message(&self, channel: ChannelId, hmi: bool, console: bool, text: &[u8]) {
        let time = self.rate.time(self.now.get());
        let message = Message { time, channel, hmi, console, text };
        self.let_hear("the output", || self.output.borrow_mut().message(&message));
        self.spoken.set(true);
        self.subscribers.tell(|| Event::Message { time, channel, text: String::from_utf8_lossy(text).into_owned() });
    }

    /// Lets somebody outside hear of something. Where that panics, it is what they did not hear that is lost, and the
    /// cycle goes on; the first time is a warning.
    fn let_hear(&self, who: &'static str, tell: impl FnOnce()) {
        let lost = catch_panic(tell).is_none();
        if lost && !self.panicked.borrow().contains(&who) {
            self.panicked.borrow_mut().push(who);
            self.warn(format!("{who} has panicked: what was reported to it is lost"));
        }
    }

    /// Ends a cycle's messages.
    pub(crate) fn flush(&self) {
        if self.spoken.replace(false) {
            self.let_hear("the output", || self.output.borrow_mut().flush());
        }
    }

    /// Says that the program talks to the world: from now on the world's time counts.
    pub(crate) fn need_real_time(&self) {
        self.needs_real_time.set(true);
    }

    /// Whether somebody has said so since the last call.
    #[inline]
    pub(crate) fn take_real_time_need(&self) -> bool {
        self.needs_real_time.replace(false)
    }

    /// Notes an alarm; the one that ends a program stands before others of it.
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

    /// Lets somebody halt programs at their statements.
    pub(crate) fn watch(&self, watcher: Rc<dyn Watcher>) {
        *self.watcher.borrow_mut() = Some(watcher);
    }

    /// Who may halt programs at their statements.
    pub(crate) fn watcher(&self) -> Option<Rc<dyn Watcher>> {
        self.watcher.borrow().clone()
    }

    /// The alarms since the last call.
    pub(crate) fn take_alarms(&self) -> Vec<Alarm> {
        std::mem::take(&mut self.alarms.borrow_mut())
    }

    /// Notes what is not an alarm but worth a word.
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
