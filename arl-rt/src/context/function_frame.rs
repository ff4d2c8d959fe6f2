//! A running function, as represented in emitted code: only in programs that were emitted for a debugger.
//!
//! Invariants:
//! - While the program pointer is being moved to a line (`target`), no statement runs before that line.
//! - A function begins again only where nothing of it runs: the future of its statements is dropped first.

use std::any::Any;
use std::cell::{Cell, RefCell};
use std::fmt;
use std::future::poll_fn;
use std::pin::{Pin, pin};
use std::rc::{Rc, Weak};
use std::task::{Context, Poll};

use super::frames::{Variable, note};
use crate::context::cx::Cx;
use crate::context::shown::Shown;
use crate::context::watcher::Go;
use crate::fault::File;
use crate::values::Teach;

/// A running function. Dropping this leaves the function.
///
/// Emitted code opens one at the start of each function: `let frame = cx.frame("grip", FILE, 17);`.
#[must_use = "the function is left when this is dropped"]
pub struct FunctionFrame<'a> {
    cx: &'a Cx,
    id: u64,
    /// The line that the program pointer was set to, until it is reached: nothing runs before it. 0: none.
    target: Cell<u32>,
    /// The variables that the function has declared, by the numbers of their declarations.
    declared: RefCell<Vec<(usize, Weak<dyn Any>)>>,
    /// The variables that are kept when the function begins again, until the line is reached.
    kept: RefCell<Vec<(usize, Rc<dyn Any>)>>,
}

impl fmt::Debug for FunctionFrame<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("FunctionFrame").field(&self.id).finish()
    }
}

impl Cx {
    /// Enters a function, for a debugger.
    pub fn frame(&self, name: &'static str, file: File, line: u32) -> FunctionFrame<'_> {
        self.framed(self.frames().enter(name.into(), file, line, false))
    }

    /// Enters the action of the event that was declared at this place.
    pub fn action(&self, file: File, line: u32) -> FunctionFrame<'_> {
        let name = self.events().borrow().describe((file, line)).unwrap_or_else(|| format!("the event of line {line}"));
        self.framed(self.frames().enter(name.into(), file, line, true))
    }

    fn framed(&self, id: u64) -> FunctionFrame<'_> {
        FunctionFrame { cx: self, id, target: Cell::new(0), declared: RefCell::default(), kept: RefCell::default() }
    }
}

impl<'a> FunctionFrame<'a> {
    /// Shows a variable of the function, with the number of its declaration, and its name.
    pub fn variable<T: Teach + 'static>(&self, number: usize, name: &'static str, variable: &Rc<T>) {
        self.table(number, name, &[], variable);
    }

    /// Shows an array of several dimensions with its sizes, outermost first.
    pub fn table<T: Teach + 'static>(
        &self,
        number: usize,
        name: &'static str,
        sizes: &'static [usize],
        variable: &Rc<T>,
    ) {
        self.declare(number, variable);
        let variable: Rc<dyn Teach> = Rc::<T>::clone(variable);
        let slot = Rc::downgrade(&variable);
        self.cx.frames().with(self.id, |record| note(&mut record.variables, Variable { number, name, sizes, slot }));
    }

    /// Shows a clock or a connection.
    pub fn handle<T: Shown + 'static>(&self, number: usize, name: &'static str, handle: &Rc<T>) {
        self.handles(number, name, &[], handle);
    }

    /// Shows an array of several dimensions of clocks or connections with its sizes, outermost first.
    pub fn handles<T: Shown + 'static>(
        &self,
        number: usize,
        name: &'static str,
        sizes: &'static [usize],
        handle: &Rc<T>,
    ) {
        self.declare(number, handle);
        let handle: Rc<dyn Shown> = Rc::<T>::clone(handle);
        let slot = Rc::downgrade(&handle);
        self.cx.frames().with(self.id, |record| note(&mut record.handles, Variable { number, name, sizes, slot }));
    }

    /// Notes a variable, which is kept when the function begins again.
    fn declare<T: 'static>(&self, number: usize, variable: &Rc<T>) {
        let variable: Rc<dyn Any> = Rc::<T>::clone(variable);
        let mut declared = self.declared.borrow_mut();
        declared.retain(|(known, _)| *known != number);
        declared.push((number, Rc::downgrade(&variable)));
    }

    /// Runs the statements of the function; each time the program pointer is set, it begins again, and goes on at that
    /// line.
    pub async fn run<T>(&self, mut statements: impl AsyncFnMut() -> T) -> T {
        loop {
            let run = {
                let mut run = pin!(statements());
                poll_fn(|context| {
                    let frames = self.cx.frames();
                    if !frames.is_moved(self.id) {
                        match run.as_mut().poll(context) {
                            Poll::Pending if frames.is_moved(self.id) => {}
                            other => return other.map(Some),
                        }
                    }
                    self.keep();
                    Poll::Ready(None)
                })
                .await
            };
            match run {
                Some(value) => return value,
                None => self.begin_anew(),
            }
        }
    }

    /// Keeps the variables that exist.
    fn keep(&self) {
        let declared = self.declared.borrow();
        let there = declared.iter().filter_map(|(number, variable)| Some((*number, variable.upgrade()?)));
        // Until the line is reached, variables kept for an earlier line stay kept.
        let mut kept = self.kept.borrow_mut();
        for (number, variable) in there {
            kept.retain(|(known, _)| *known != number);
            kept.push((number, variable));
        }
    }

    fn begin_anew(&self) {
        let frames = self.cx.frames();
        frames.moved.set(0);
        let line = frames.with(self.id, |record| record.line);
        self.target.set(line.unwrap_or_default());
    }

    /// Whether the program pointer was set in the function, which has not gone on there yet.
    pub fn is_moved(&self) -> bool {
        self.cx.frames().is_moved(self.id)
    }

    /// The line that the program pointer was set to, if it was set in this function: the function goes on there.
    pub fn moved_to(&self) -> Option<u32> {
        if !self.is_moved() {
            return None;
        }
        self.begin_anew();
        Some(self.target.get())
    }

    /// Whether the statement of a line runs; before it does, it halts where a debugger requests that. The statement
    /// does not run where the program pointer was set to another line.
    pub fn runs(&self, line: u32) -> Runs<'a> {
        let state = match self.target.get() {
            0 => Asking::NotYet,
            target if target == line => {
                self.target.set(0);
                self.kept.borrow_mut().clear();
                Asking::Asked
            }
            _ => Asking::Skipped,
        };
        Runs { cx: self.cx, id: self.id, line, state }
    }

    /// Whether the program pointer was set to one of these lines.
    pub fn leads_to(&self, first: u32, last: u32) -> bool {
        let target = self.target.get();
        target != 0 && (first..=last).contains(&target)
    }

    /// Whether a statement of these lines, or one inside of it, runs.
    pub fn enters(&self, first: u32, last: u32) -> bool {
        self.target.get() == 0 || self.leads_to(first, last)
    }

    /// The arm of a `switch` that the program pointer was set into, by the lines of each arm.
    pub fn way_to(&self, arms: &[(u32, u32)]) -> Option<usize> {
        arms.iter().position(|(first, last)| self.leads_to(*first, *last))
    }

    /// The initial state of a function with `goto`: that of the line that the program pointer was set to, or the first.
    pub fn begins_in<S, const N: usize>(&self, first: S, states: [(u32, u32, S); N]) -> S {
        let entered = states.into_iter().find(|(first, last, _)| self.leads_to(*first, *last));
        entered.map_or(first, |(_, _, state)| state)
    }

    /// A variable whose declaration is jumped over: the existing one, or one with its start value.
    pub fn kept<T: 'static>(&self, number: usize, start: impl FnOnce() -> Rc<T>) -> Rc<T> {
        let kept = self.kept.borrow();
        let found = kept.iter().find(|(known, _)| self.target.get() != 0 && *known == number);
        found.and_then(|(_, variable)| Rc::clone(variable).downcast().ok()).unwrap_or_else(start)
    }
}

impl Drop for FunctionFrame<'_> {
    fn drop(&mut self) {
        let frames = self.cx.frames();
        frames.records.borrow_mut().retain(|record| record.id != self.id);
        if frames.is_moved(self.id) {
            frames.moved.set(0);
        }
    }
}

/// Whether a statement runs; pending as long as a debugger halts the program.
#[must_use = "nothing halts unless it is awaited"]
#[derive(Debug)]
pub struct Runs<'a> {
    cx: &'a Cx,
    id: u64,
    line: u32,
    state: Asking,
}

/// Whether the debugger was asked.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
enum Asking {
    NotYet,
    /// It was asked, or has set the program pointer here.
    Asked,
    /// The statement does not run.
    Skipped,
}

impl Future for Runs<'_> {
    type Output = bool;

    fn poll(mut self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<bool> {
        let (id, line) = (self.id, self.line);
        if self.state == Asking::Skipped {
            return Poll::Ready(false);
        }
        let asked = std::mem::replace(&mut self.state, Asking::Asked) == Asking::Asked;
        if !asked {
            self.cx.frames().with(id, |record| record.line = line);
        }
        let Some(watcher) = self.cx.shared().watcher() else { return Poll::Ready(true) };
        let go = if asked { watcher.goes_on() } else { watcher.statement(self.cx, id) };
        match go {
            // The function, or one that has called it, begins again.
            Go::On if self.cx.frames().is_abandoned(id) => Poll::Pending,
            Go::On => Poll::Ready(true),
            Go::NotYet => Poll::Pending,
        }
    }
}
