//! The running functions, with their variables, as a debugger sees them. Only programs that were made for a debugger
//! have frames.

use std::cell::{Cell, RefCell};
use std::rc::{Rc, Weak};

use crate::context::shown::Shown;
use crate::fault::File;
use crate::values::Teach;

/// A running function, or the running action of an event.
#[derive(Clone)]
pub(crate) struct Record {
    /// The unique number of the frame in the program.
    pub(crate) id: u64,
    /// The function's name, or a description of the event.
    pub(crate) name: Rc<str>,
    pub(crate) file: File,
    /// The line of the statement that runs, or runs next.
    pub(crate) line: u32,
    /// Whether it is the action of an event.
    pub(crate) is_action: bool,
    /// Whether one of its statements ran.
    begun: bool,
    /// Its variables, in the order of declaration, including those that do not exist any more.
    pub(super) variables: Vec<Variable<Weak<dyn Teach>>>,
    /// Its clocks and connections, likewise.
    pub(super) handles: Vec<Variable<Weak<dyn Shown>>>,
}

/// A variable of a function.
#[derive(Clone)]
pub(crate) struct Variable<T> {
    /// The number of its declaration among those of the function.
    pub(super) number: usize,
    pub(crate) name: &'static str,
    /// The sizes of an array of several dimensions, outermost first; otherwise empty.
    pub(crate) sizes: &'static [usize],
    pub(crate) slot: T,
}

impl Record {
    /// The existing variables, in the order of declaration. Of two with the same name only the inner one.
    pub(crate) fn variables(&self) -> Vec<Variable<Rc<dyn Teach>>> {
        there(&self.variables)
    }

    /// The clocks and connections, likewise.
    pub(crate) fn handles(&self) -> Vec<Variable<Rc<dyn Shown>>> {
        there(&self.handles)
    }
}

fn there<T: ?Sized>(variables: &[Variable<Weak<T>>]) -> Vec<Variable<Rc<T>>> {
    let mut seen: Vec<Variable<Rc<T>>> = Vec::new();
    for Variable { number, name, sizes, slot } in variables {
        if let Some(slot) = slot.upgrade() {
            seen.retain(|known| known.name != *name);
            seen.push(Variable { number: *number, name, sizes, slot });
        }
    }
    seen
}

/// Adds a variable. A loop declares the same ones again and again.
pub(super) fn note<T: ?Sized>(variables: &mut Vec<Variable<Weak<T>>>, new: Variable<Weak<T>>) {
    variables.retain(|known| known.slot.strong_count() > 0 && known.number != new.number);
    variables.push(new);
}

/// The running functions of a program, the one entered last at the end.
#[derive(Default)]
pub(crate) struct Frames {
    pub(super) records: RefCell<Vec<Record>>,
    entered: Cell<u64>,
    /// The function whose program pointer was set to its `line`: it begins again, and goes on there. 0: none.
    pub(super) moved: Cell<u64>,
}

impl Frames {
    pub(super) fn enter(&self, name: Rc<str>, file: File, line: u32, is_action: bool) -> u64 {
        let id = self.entered.get() + 1;
        self.entered.set(id);
        let (begun, variables, handles) = (false, Vec::new(), Vec::new());
        self.records.borrow_mut().push(Record { id, name, file, line, is_action, begun, variables, handles });
        id
    }

    /// Sets the program pointer to a line of a function. The functions that it has called are left.
    ///
    /// # Errors
    /// The function does not run, or it is the action of an event, or such an action runs on top of it.
    pub(crate) fn set_pointer(&self, id: u64, line: u32) -> Result<(), &'static str> {
        let mut records = self.records.borrow_mut();
        let at = records.iter().position(|record| record.id == id).ok_or("the function has ended")?;
        if records.iter().skip(at).any(|record| record.is_action) {
            return Err("the action of an event is running");
        }
        records.truncate(at + 1);
        if let Some(record) = records.last_mut() {
            record.line = line;
        }
        self.moved.set(id);
        Ok(())
    }

    /// Whether the program pointer was set in a function, which then begins again.
    pub(super) fn is_moved(&self, id: u64) -> bool {
        self.moved.get() == id
    }

    /// Whether the program pointer was set in any function that has not begun again yet.
    pub(crate) fn is_any_moved(&self) -> bool {
        self.moved.get() != 0
    }

    /// Whether a function does not go on any more, as it, or one that has called it, begins again. The action of an
    /// event or its condition that runs on top meanwhile goes on.
    pub(super) fn is_abandoned(&self, id: u64) -> bool {
        let moved = self.moved.get();
        self.is_any_moved() && (moved == id || !self.records.borrow().iter().any(|record| record.id == id))
    }

    /// All frames, the one entered last at the end.
    pub(crate) fn all(&self) -> Vec<Record> {
        self.records.borrow().clone()
    }

    /// The innermost frames, `most` at most, the one entered last at the end.
    pub(crate) fn innermost(&self, most: usize) -> Vec<Record> {
        let records = self.records.borrow();
        records.iter().skip(records.len().saturating_sub(most)).cloned().collect()
    }

    /// The place of a frame, and whether it is the action of an event.
    pub(crate) fn place(&self, id: u64) -> Option<(File, u32, bool)> {
        self.with(id, |record| (record.file, record.line, record.is_action))
    }

    /// The name of a frame, at the first call for it: at its first statement.
    pub(crate) fn begins(&self, id: u64) -> Option<Rc<str>> {
        self.with(id, |record| (!std::mem::replace(&mut record.begun, true)).then(|| Rc::clone(&record.name))).flatten()
    }

    /// How many frames there are up to this one.
    pub(crate) fn depth(&self, id: u64) -> usize {
        self.records.borrow().iter().position(|record| record.id == id).map_or(0, |at| at + 1)
    }

    /// Calls `act` with the frame with this number: as a rule it is one of the last.
    pub(super) fn with<R>(&self, id: u64, act: impl FnOnce(&mut Record) -> R) -> Option<R> {
        self.records.borrow_mut().iter_mut().rev().find(|record| record.id == id).map(act)
    }
}
