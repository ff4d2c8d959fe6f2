//! How a tool ends.

/// An exit code. The standard one cannot be asked for its number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Exit(pub u8);

impl Exit {
    /// Done.
    pub const SUCCESS: Self = Self(0);
    /// Programs have mistakes, or something around them went wrong.
    pub const FAILURE: Self = Self(1);
    /// The command line asks for something that cannot be.
    pub const USAGE: Self = Self(2);
    /// An alarm ended a run.
    pub const ALARM: Self = Self(3);
    /// The time of a run was over, or nothing could change any more.
    pub const OUT_OF_TIME: Self = Self(4);
    /// Ctrl-C.
    pub const INTERRUPTED: Self = Self(130);
}

impl From<u8> for Exit {
    fn from(code: u8) -> Self {
        Self(code)
    }
}
