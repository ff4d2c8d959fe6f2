//! Threads that hear what happens on a controller.

use std::cell::RefCell;
use std::sync::mpsc::Sender;

use crate::context::run_state::State;
use crate::cycle::channel_id::ChannelId;
use crate::fault::Alarm;

/// What happened on a controller, for other threads: see [`Handle::events`](crate::Handle::events).
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum Event {
    /// A program printed something.
    #[non_exhaustive]
    Message {
        /// Controller time in s.
        time: f64,
        /// The channel whose program says it.
        channel: ChannelId,
        /// The text; what is not UTF-8 is replaced.
        text: String,
    },
    /// Something is not an alarm but worth a word.
    Warning(String),
    /// A program came to an alarm.
    Alarm(Alarm),
    /// The controller does something else than before.
    State(State),
}

/// Those who hear of everything.
#[derive(Default)]
pub(crate) struct Hearers(RefCell<Vec<Sender<Event>>>);

impl Hearers {
    pub(crate) fn new(subscribers: Vec<Sender<Event>>) -> Self {
        Self(RefCell::new(subscribers))
    }

    /// Lets one more hear of what happens from now on.
    pub(crate) fn add(&self, hearer: Sender<Event>) {
        self.0.borrow_mut().push(hearer);
    }

    /// Whether there is nobody.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.borrow().is_empty()
    }

    /// Tells all of them; whoever is gone is forgotten.
    #[inline]
    pub(crate) fn tell(&self, event: impl Fn() -> Event) {
        self.0.borrow_mut().retain(|hearer| hearer.send(event()).is_ok());
    }
}
