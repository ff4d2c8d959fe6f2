//! The exit codes of tools.

/// An exit code. That of the standard library does not reveal its number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Exit(pub u8);

impl Exit {
    /// Done.
    pub const SUCCESS: Self = Self(0);
    /// Programs have errors, or something else failed.
    pub const FAILURE: Self = Self(1);
    /// The command line requests something impossible.
    pub const USAGE: Self = Self(2);
    /// An alarm ended a run.
    pub const ALARM: Self = Self(3);
    /// The time of a run was over, or nothing could change any more in the run.
    pub const OUT_OF_TIME: Self = Self(4);
    /// Ctrl-C.
    pub const INTERRUPTED: Self = Self(130);
}

impl From<u8> for Exit {
    fn from(code: u8) -> Self {
        Self(code)
    }
}
