//! Conditions and actions as the emitted code passes them: async closures that take the context.

use std::pin::{Pin, pin};
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use crate::context::cx::Cx;
use crate::context::events::{Act, Code};
use crate::fault::Done;

/// The function that creates the future of an action, and the memory for one such future.
struct Room<M, F> {
    make: M,
    running: Pin<Box<Option<F>>>,
}

impl<M, F> Act for Room<M, F>
where
    M: Fn(Rc<Cx>) -> F,
    F: Future<Output = Done<()>>,
{
    fn begin(&mut self, cx: Rc<Cx>) {
        self.running.set(Some((self.make)(cx)));
    }

    fn poll(&mut self, context: &mut Context<'_>) -> Poll<Done<()>> {
        let Some(running) = self.running.as_mut().as_pin_mut() else { return Poll::Ready(Ok(())) };
        let polled = running.poll(context);
        if polled.is_ready() {
            self.running.set(None);
        }
        polled
    }
}

/// A condition and an action.
pub(super) struct WatchedCode<C, A> {
    pub(super) when: C,
    pub(super) action: A,
}

impl<C, A> Code for WatchedCode<C, A>
where
    C: AsyncFn(&Cx) -> Done<bool> + 'static,
    A: AsyncFn(&Cx) -> Done<()> + 'static,
{
    fn holds(&self, cx: &Cx) -> Poll<Done<bool>> {
        // On the stack: the evaluation of a condition allocates nothing.
        pin!((self.when)(cx)).poll(&mut Context::from_waker(Waker::noop()))
    }

    fn room(self: Rc<Self>) -> Box<dyn Act> {
        let make = move |cx: Rc<Cx>| {
            let code = Rc::clone(&self);
            async move { (code.action)(&cx).await }
        };
        Box::new(Room { make, running: Box::pin(None) })
    }
}
