//! Threads that receive the events of a controller.

use std::cell::RefCell;
use std::sync::mpsc::Sender;

use crate::context::run_state::State;
use crate::cycle::channel_id::ChannelId;
use crate::fault::Alarm;

/// An event of a controller, for other threads: see [`Handle::events`](crate::Handle::events).
#[derive(Clone, PartialEq, Debug)]
#[non_exhaustive]
pub enum Event {
    /// A program printed something.
    #[non_exhaustive]
    Message {
        /// Controller time in s.
        time: f64,
        /// The channel whose program printed it.
        channel: ChannelId,
        /// The text; bytes that are not UTF-8 are replaced.
        text: String,
    },
    /// Something that is not an alarm but worth reporting.
    Warning(String),
    /// An alarm was raised.
    Alarm(Alarm),
    /// The state of the controller has changed.
    State(State),
}

/// The subscribers to all events.
#[derive(Default)]
pub(crate) struct Subscribers(RefCell<Vec<Sender<Event>>>);

impl Subscribers {
    pub(crate) fn new(subscribers: Vec<Sender<Event>>) -> Self {
        Self(RefCell::new(subscribers))
    }

    /// Adds a subscriber, which receives the events from now on.
    pub(crate) fn add(&self, subscriber: Sender<Event>) {
        self.0.borrow_mut().push(subscriber);
    }

    /// Whether there are no subscribers.
    #[inline]
    pub(crate) fn is_empty(&self) -> bool {
        self.0.borrow().is_empty()
    }

    /// Sends an event to all subscribers; those that no longer exist are removed.
    #[inline]
    pub(crate) fn tell(&self, event: impl Fn() -> Event) {
        self.0.borrow_mut().retain(|subscriber| subscriber.send(event()).is_ok());
    }
}
