//! What a debugger needs from a controller.

use std::rc::Rc;

use super::Controller;
use crate::context::cx::Cx;
use crate::context::watcher::Watcher;

impl Controller {
    /// Sets a watcher, which can halt programs at their statements.
    pub(crate) fn watch(&self, watcher: Rc<dyn Watcher>) {
        self.shared.watch(watcher);
    }

    /// The contexts of the programs of all channels, in the order of the channels.
    pub(crate) fn contexts(&self) -> Vec<Rc<Cx>> {
        self.channels.iter().map(|channel| Rc::clone(channel.cx())).collect()
    }

    /// Whether the clock runs in real time.
    pub(crate) fn is_real(&self) -> bool {
        self.clock.is_real()
    }
}
