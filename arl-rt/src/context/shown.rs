//! What a debugger shows of clocks and connections, which have no value that could be written down.

use crate::context::cx::Cx;

/// A clock or a connection that a debugger looks at.
pub trait Shown {
    /// Its type, as ARL calls it.
    fn type_name(&self) -> &'static str;

    /// How it is, in words. Nothing changes by looking.
    fn shown(&self, cx: &Cx) -> String;
}

/// A global variable that is a clock or a connection.
pub struct ShownHandle<'a> {
    /// The file that declares it.
    pub file: &'static str,
    /// Its name as it was declared.
    pub name: &'static str,
    /// The variable.
    pub slot: &'a dyn Shown,
}
