//! A running function as a debugger sees it: only in programs that were made for one.

use std::cell::Cell;
use std::fmt;
use std::pin::Pin;
use std::rc::Rc;
use std::task::{Context, Poll};

use super::frames::{Variable, note};
use crate::context::cx::Cx;
use crate::context::shown::Shown;
use crate::context::watcher::Go;
use crate::fault::File;
use crate::values::Teach;

/// A running function. Dropping this leaves the function.
#[must_use = "the function is left when this is dropped"]
pub struct FunctionFrame<'a> {
    cx: &'a Cx,
    id: u64,
    /// The line that the program pointer was set to, until it is reached; 0: none.
    target: Cell<u32>,
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
        FunctionFrame { cx: self, id, target: Cell::new(0) }
    }
}

impl<'a> FunctionFrame<'a> {
    /// Shows a variable of the function, with the number of its declaration and its name. An array of several
    /// dimensions has its sizes, outermost first; for others they are empty.
    pub fn variable<T: Teach + 'static>(
        &self,
        number: usize,
        name: &'static str,
        sizes: &'static [usize],
        variable: &Rc<T>,
    ) {
        let variable: Rc<dyn Teach> = Rc::<T>::clone(variable);
        let slot = Rc::downgrade(&variable);
        self.cx.frames().with(self.id, |record| note(&mut record.variables, Variable { number, name, sizes, slot }));
    }

    /// Shows a clock or a connection, or an array of them, as [`FunctionFrame::variable`] does.
    pub fn handle<T: Shown + 'static>(
        &self,
        number: usize,
        name: &'static str,
        sizes: &'static [usize],
        handle: &Rc<T>,
    ) {
        let handle: Rc<dyn Shown> = Rc::<T>::clone(handle);
        let slot = Rc::downgrade(&handle);
        self.cx.frames().with(self.id, |record| note(&mut record.handles, Variable { number, name, sizes, slot }));
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
        let frames = self.cx.frames();
        frames.moved.set(0);
        let line = frames.with(self.id, |record| record.line).unwrap_or_default();
        self.target.set(line);
        Some(line)
    }

    /// Waits where a debugger halts the program before the statement of a line.
    pub fn runs(&self, line: u32) -> Runs<'a> {
        // Who has set the program pointer here has been asked.
        Runs { cx: self.cx, id: self.id, line, is_asked: self.target.replace(0) == line }
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

/// A statement that runs; pending as long as a debugger halts the program.
#[must_use = "nothing halts unless it is awaited"]
#[derive(Debug)]
pub struct Runs<'a> {
    cx: &'a Cx,
    id: u64,
    line: u32,
    /// Whether the debugger was asked.
    is_asked: bool,
}

impl Future for Runs<'_> {
    type Output = ();

    fn poll(mut self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<()> {
        let (id, line) = (self.id, self.line);
        let is_asked = std::mem::replace(&mut self.is_asked, true);
        if !is_asked {
            self.cx.frames().with(id, |record| record.line = line);
        }
        let Some(watcher) = self.cx.shared().watcher() else { return Poll::Ready(()) };
        let go = if is_asked { watcher.goes_on() } else { watcher.statement(self.cx, id) };
        match go {
            // The function, or one that has called it, begins again.
            Go::On if self.cx.frames().is_abandoned(id) => Poll::Pending,
            Go::On => Poll::Ready(()),
            Go::NotYet => Poll::Pending,
        }
    }
}
