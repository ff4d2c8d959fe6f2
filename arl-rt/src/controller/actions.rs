//! The actions of events that run: each on top of what it interrupts.

use std::rc::Rc;
use std::task::{Context, Poll};

use crate::cx::{Cx, Level, Pointer};
use crate::event::Due;
use crate::fault::Done;
use crate::program::Running;

/// An action that has begun.
struct Action {
    priority: u8,
    running: Running,
    /// What it interrupted.
    level: Level,
    /// The program pointer of what it interrupted.
    pointer: Pointer,
}

/// The actions that run, the one on top last.
#[derive(Default)]
pub(super) struct Actions {
    stack: Vec<Action>,
}

impl Actions {
    /// Drops them all where they are.
    pub(super) fn clear(&mut self) {
        self.stack.clear();
    }

    /// Begins the action of the event that comes next, if it may interrupt what runs.
    pub(super) fn begin(&mut self, cx: &Rc<Cx>) {
        let running = self.stack.last().map(|action| action.priority);
        let Some(Due { priority, code }) = cx.events().borrow_mut().take_due(running) else { return };
        let level = cx.enter_level(Level::action(self.stack.len() as u32 + 1));
        self.stack.push(Action { priority, running: code.act(Rc::clone(cx)), level, pointer: cx.pointer() });
    }

    /// Lets the action on top run until it waits; one that has ended makes room for what it interrupted. `None`: no action
    /// runs.
    pub(super) fn poll(&mut self, cx: &Cx, context: &mut Context<'_>) -> Option<Poll<Done<()>>> {
        let top = self.stack.last_mut()?;
        let polled = top.running.as_mut().poll(context);
        if let Poll::Ready(Ok(())) = polled {
            let ended = cx.level();
            cx.events().borrow_mut().unbind(ended.number);
            cx.leave_level(top.level);
            cx.point_to(top.pointer);
            self.stack.pop();
        }
        Some(polled)
    }
}
