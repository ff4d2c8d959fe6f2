//! The programs of a controller: those that run in its foreground channels, and those that `switcharl` can load there.

use std::cell::RefCell;
use std::ops::BitOr;
use std::rc::{Rc, Weak};

use crate::context::cx::Cx;
use crate::context::program::{Beside, Program};

/// Makes a program.
type Make = Box<dyn Fn() -> Box<dyn Program>>;

/// Sets global variables of a program once they have their first values, where they are of its type.
pub(crate) type Initialised = Box<dyn Fn(&dyn Program)>;

/// The programs that a controller can load while it runs, by the names of their files.
#[derive(Default)]
pub(crate) struct Loadable(Vec<(String, Make)>);

impl Loadable {
    pub(crate) fn add(&mut self, name: String, make: Make) {
        self.0.push((name, make));
    }

    /// The services beside the cycle that any of them uses.
    pub(crate) fn beside(&self) -> Beside {
        self.0.iter().map(|(_, make)| make().beside()).fold(Beside::default(), Beside::bitor)
    }

    /// A program by the name of its file, in any case.
    pub(crate) fn load(&self, name: &str) -> Option<Rc<dyn Program>> {
        let found = self.0.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
        found.map(|(_, make)| Rc::from(make()))
    }
}

/// The programs of a controller, as each of them sees the others.
pub(crate) struct Programs {
    /// The programs that `switcharl` can load.
    pub(crate) loadable: Loadable,
    initialised: Vec<Initialised>,
    /// The foreground channels, in order, for functions that access channels by number.
    foreground: RefCell<Vec<Weak<Cx>>>,
}

impl Programs {
    pub(crate) fn new(loadable: Loadable, initialised: Vec<Initialised>) -> Self {
        Self { loadable, initialised, foreground: RefCell::default() }
    }

    /// Called when a program's global variables have their first values.
    pub(crate) fn were_initialised(&self, program: &dyn Program) {
        self.initialised.iter().for_each(|set| set(program));
    }

    /// Adds the next foreground channel.
    pub(crate) fn add(&self, cx: &Rc<Cx>) {
        self.foreground.borrow_mut().push(Rc::downgrade(cx));
    }

    /// Another program runs in the foreground channel at this index.
    pub(crate) fn exchange(&self, at: usize, cx: &Rc<Cx>) {
        if let Some(place) = self.foreground.borrow_mut().get_mut(at) {
            *place = Rc::downgrade(cx);
        }
    }

    /// The foreground channel with this number, from 1.
    pub(crate) fn foreground(&self, number: i32) -> Option<Rc<Cx>> {
        let at = usize::try_from(number).ok()?.checked_sub(1)?;
        self.foreground.borrow().get(at)?.upgrade()
    }

    /// How many foreground channels there are.
    pub(crate) fn foreground_count(&self) -> usize {
        self.foreground.borrow().len()
    }
}
