//! What a debugger needs of a controller.

use std::rc::Rc;

use super::Controller;
use crate::context::cx::Cx;
use crate::context::watcher::Watcher;

impl Controller {
    /// Lets somebody halt programs at their statements.
    pub(crate) fn watch(&self, watcher: Rc<dyn Watcher>) {
        self.shared.watch(watcher);
    }

    /// What the programs of all channels see, in the order of the channels.
    pub(crate) fn contexts(&self) -> Vec<Rc<Cx>> {
        self.channels.iter().map(|channel| Rc::clone(channel.cx())).collect()
    }

    /// Whether time is the world's.
    pub(crate) fn is_real(&self) -> bool {
        self.clock.is_real()
    }
}
