//! Conditions and actions as the emitted code hands them over: async closures that are told the context.

use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use crate::cx::Cx;
use crate::fault::Done;
use crate::program::Running;

/// The condition and the action of an event, whatever they are in Rust.
pub(crate) trait Code {
    /// Whether the condition holds now. `Pending`: it has not come to a result within the turns of loops of a cycle.
    fn holds(&self, cx: &Cx) -> Poll<Done<bool>>;

    /// The action from its beginning.
    fn act(self: Rc<Self>, cx: Rc<Cx>) -> Running;
}

/// A condition and an action.
pub(super) struct Watched<C, A> {
    pub(super) when: C,
    pub(super) action: A,
}

impl<C, A> Code for Watched<C, A>
where
    C: AsyncFn(&Cx) -> Done<bool> + 'static,
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    fn holds(&self, cx: &Cx) -> Poll<Done<bool>> {
        // On the stack: looking at a condition takes no memory.
        pin!((self.when)(cx)).poll(&mut Context::from_waker(Waker::noop()))
    }

    fn act(self: Rc<Self>, cx: Rc<Cx>) -> Running {
        Box::pin(async move { (self.action)(&cx).await })
    }
}
