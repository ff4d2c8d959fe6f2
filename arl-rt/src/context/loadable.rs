//! The programs that `switcharl` can load.

use std::ops::BitOr;
use std::rc::Rc;

use crate::context::program::{Beside, Program};

/// What makes a program.
type Make = Box<dyn Fn() -> Box<dyn Program>>;

/// The programs that a controller can load while it runs, by the names of their files.
#[derive(Default)]
pub(crate) struct Loadable(Vec<(String, Make)>);

impl Loadable {
    pub(crate) fn add(&mut self, name: String, make: Make) {
        self.0.push((name, make));
    }

    /// What any of them uses of what runs beside the cycle.
    pub(crate) fn beside(&self) -> Beside {
        self.0.iter().map(|(_, make)| make().beside()).fold(Beside::default(), Beside::bitor)
    }

    /// A program by the name of its file, in any case.
    pub(crate) fn load(&self, name: &str) -> Option<Rc<dyn Program>> {
        let found = self.0.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
        found.map(|(_, make)| Rc::from(make()))
    }
}
