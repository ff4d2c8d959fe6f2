//! The functions that run, with their variables, as a debugger sees them. Only programs that were emitted for a debugger have
//! frames.

use std::cell::RefCell;
use std::fmt;
use std::pin::Pin;
use std::rc::{Rc, Weak};
use std::task::{Context, Poll};

use crate::context::cx::Cx;
use crate::context::watcher::Go;
use crate::fault::File;
use crate::values::Teach;

/// A function that runs, or the action of an event.
#[derive(Clone)]
pub(crate) struct Record {
    /// What no other frame of the program has.
    pub(crate) id: u64,
    /// The function's name, or what the event is.
    pub(crate) name: Rc<str>,
    pub(crate) file: File,
    /// The line of the statement that runs, or runs next.
    pub(crate) line: u32,
    /// Whether it is the action of an event.
    pub(crate) is_action: bool,
    /// Whether one of its statements ran.
    begun: bool,
    /// Its variables, in the order of declaration, with those that are gone already.
    variables: Vec<Variable<Weak<dyn Teach>>>,
}

/// A variable of a function.
#[derive(Clone)]
pub(crate) struct Variable<T> {
    pub(crate) name: &'static str,
    /// The sizes of an array of several dimensions, outermost first; else empty.
    pub(crate) sizes: &'static [usize],
    pub(crate) slot: T,
}

impl Record {
    /// The variables that there are, in the order of declaration. Of two of one name only the inner one.
    pub(crate) fn variables(&self) -> Vec<Variable<Rc<dyn Teach>>> {
        let mut seen: Vec<Variable<Rc<dyn Teach>>> = Vec::new();
        for Variable { name, sizes, slot } in &self.variables {
            if let Some(slot) = slot.upgrade() {
                seen.retain(|known| known.name != *name);
                seen.push(Variable { name, sizes, slot });
            }
        }
        seen
    }
}

/// The functions of a program that run, those that were entered last at the end.
#[derive(Default)]
pub(crate) struct Frames {
    records: RefCell<Vec<Record>>,
    entered: std::cell::Cell<u64>,
}

impl Frames {
    fn enter(&self, name: Rc<str>, file: File, line: u32, is_action: bool) -> u64 {
        let id = self.entered.get() + 1;
        self.entered.set(id);
        self.records.borrow_mut().push(Record { id, name, file, line, is_action, begun: false, variables: Vec::new() });
        id
    }

    /// All of them, those that were entered last at the end.
    pub(crate) fn all(&self) -> Vec<Record> {
        self.records.borrow().clone()
    }

    /// Where a frame stands, and whether it is the action of an event.
    pub(crate) fn place(&self, id: u64) -> Option<(File, u32, bool)> {
        self.with(id, |record| (record.file, record.line, record.is_action))
    }

    /// What a frame is called, where this is asked for the first time: at its first statement.
    pub(crate) fn begins(&self, id: u64) -> Option<Rc<str>> {
        self.with(id, |record| (!std::mem::replace(&mut record.begun, true)).then(|| Rc::clone(&record.name))).flatten()
    }

    /// How many there are up to this one.
    pub(crate) fn depth(&self, id: u64) -> usize {
        self.records.borrow().iter().position(|record| record.id == id).map_or(0, |at| at + 1)
    }

    /// Does something to the frame with this number: it is one of the last as a rule.
    fn with<R>(&self, id: u64, act: impl FnOnce(&mut Record) -> R) -> Option<R> {
        self.records.borrow_mut().iter_mut().rev().find(|record| record.id == id).map(act)
    }
}

/// A function that runs. It is left when this is dropped.
///
/// Emitted code opens one at the start of each function: `let frame = cx.frame("grip", FILE, 17);`.
#[must_use = "the function is left when this is dropped"]
pub struct Frame<'a> {
    cx: &'a Cx,
    id: u64,
}

impl fmt::Debug for Frame<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Frame").field(&self.id).finish()
    }
}

impl Cx {
    /// Enters a function, for a debugger.
    pub fn frame(&self, name: &'static str, file: File, line: u32) -> Frame<'_> {
        Frame { cx: self, id: self.frames().enter(name.into(), file, line, false) }
    }

    /// Enters the action of the event that was declared at this place.
    pub fn action(&self, file: File, line: u32) -> Frame<'_> {
        let name = self.events().borrow().describe((file, line)).unwrap_or_else(|| format!("the event of line {line}"));
        Frame { cx: self, id: self.frames().enter(name.into(), file, line, true) }
    }
}

impl<'a> Frame<'a> {
    /// Shows a variable of the function.
    pub fn variable<T: Teach + 'static>(&self, name: &'static str, variable: &Rc<T>) {
        self.table(name, &[], variable);
    }

    /// Shows an array of several dimensions with its sizes, outermost first.
    pub fn table<T: Teach + 'static>(&self, name: &'static str, sizes: &'static [usize], variable: &Rc<T>) {
        let variable: Rc<dyn Teach> = Rc::<T>::clone(variable);
        self.cx.frames().with(self.id, |record| {
            // A loop declares the same ones again and again.
            record.variables.retain(|known| known.slot.strong_count() > 0);
            record.variables.push(Variable { name, sizes, slot: Rc::downgrade(&variable) });
        });
    }

    /// Halts before the statement of a line where a debugger wants that.
    pub fn halt(&self, line: u32) -> Halt<'a> {
        Halt { cx: self.cx, id: self.id, line, asked: false }
    }
}

impl Drop for Frame<'_> {
    fn drop(&mut self) {
        self.cx.frames().records.borrow_mut().retain(|record| record.id != self.id);
    }
}

/// Waits as long as a debugger halts the program.
#[must_use = "nothing halts unless it is awaited"]
#[derive(Debug)]
pub struct Halt<'a> {
    cx: &'a Cx,
    id: u64,
    line: u32,
    /// Whether the debugger was asked before.
    asked: bool,
}

impl Future for Halt<'_> {
    type Output = ();

    fn poll(mut self: Pin<&mut Self>, _: &mut Context<'_>) -> Poll<()> {
        let (id, line) = (self.id, self.line);
        if !self.asked {
            self.cx.frames().with(id, |record| record.line = line);
        }
        let Some(watcher) = self.cx.shared().watcher() else { return Poll::Ready(()) };
        let go = if self.asked { watcher.goes_on() } else { watcher.statement(self.cx, id) };
        self.asked = true;
        match go {
            Go::On => Poll::Ready(()),
            Go::NotYet => Poll::Pending,
        }
    }
}
