//! What a debugger shows of clocks and connections, which have no value that could be written as a literal.

use crate::context::cx::Cx;
use crate::values::{Array, Store};

/// A clock or a connection that a debugger can show.
pub trait Shown {
    /// The name of its type in ARL.
    fn type_name(&self) -> String;

    /// Its state, in words. The call changes nothing.
    fn shown(&self, cx: &Cx) -> String;
}

impl<T: Shown, const N: usize, S: Store<T, N>> Shown for Array<T, N, S> {
    fn type_name(&self) -> String {
        format!("{}[{N}]", self.first().map(Shown::type_name).unwrap_or_default())
    }

    fn shown(&self, cx: &Cx) -> String {
        let elements: Vec<String> = self.iter().map(|one| one.shown(cx)).collect();
        format!("{{{}}}", elements.join("; "))
    }
}

/// A global variable that is a clock or a connection.
pub struct ShownHandle<'a> {
    /// The file that declares it.
    pub file: &'static str,
    /// Its name as it was declared.
    pub name: &'static str,
    /// The sizes of an array of several dimensions, outermost first; otherwise empty.
    pub sizes: &'static [usize],
    /// The variable.
    pub slot: &'a dyn Shown,
}
