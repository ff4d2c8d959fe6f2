//! The running actions of events, each on top of what it interrupts.

use std::rc::Rc;
use std::task::{Context, Poll};

use crate::context::cx::{Cx, Level, Pointer};
use crate::context::events::Due;
use crate::fault::Done;

/// An action that has begun.
struct Action {
    event: Due,
    /// The level that it interrupted.
    level: Level,
    /// The program pointer of what it interrupted.
    pointer: Pointer,
}

/// The most actions that can run at once, as each can be interrupted only by one of higher priority.
const MAX_ACTIONS: usize = 256;

/// The running actions, the topmost one last.
pub(super) struct Actions {
    stack: Vec<Action>,
}

impl Default for Actions {
    fn default() -> Self {
        Self { stack: Vec::with_capacity(MAX_ACTIONS) }
    }
}

impl Actions {
    /// Whether no action runs.
    pub(super) fn is_empty(&self) -> bool {
        self.stack.is_empty()
    }

    /// Drops all actions where they are.
    pub(super) fn clear(&mut self) {
        self.stack.clear();
    }

    /// Begins the action of the next event that is due, if it may interrupt what runs.
    pub(super) fn begin(&mut self, cx: &Rc<Cx>) {
        let running = self.stack.last().map(|action| action.event.priority);
        let Some(mut event) = cx.events().borrow_mut().take_due(running) else { return };
        cx.goes_on();
        let level = cx.enter_level(Level::action(self.stack.len() as u32 + 1));
        event.action.begin(Rc::clone(cx));
        self.stack.push(Action { event, level, pointer: cx.pointer() });
    }

    /// Lets the topmost action run until it waits; one that has ended makes room for what it interrupted. `None`: no
    /// action runs.
    pub(super) fn poll(&mut self, cx: &Cx, context: &mut Context<'_>) -> Option<Poll<Done<()>>> {
        let top = self.stack.last_mut()?;
        let polled = top.event.action.poll(context);
        if let Poll::Ready(Ok(())) = polled
            && let Some(top) = self.stack.pop()
        {
            cx.goes_on();
            let ended = cx.level();
            let mut events = cx.events().borrow_mut();
            events.unbind(ended.number);
            events.give_back(top.event);
            drop(events);
            cx.leave_level(top.level);
            cx.point_to(top.pointer);
        }
        Some(polled)
    }
}
