//! How the command ends: 0 done, 1 compile errors, 2 usage, 3 alarm, 4 out of time, 130 interrupted.

/// An exit code. The standard one cannot be asked for its number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub struct Exit(pub u8);

impl Exit {
    /// Done.
    pub const SUCCESS: Self = Self(0);
    /// Programs have mistakes, or something around them went wrong.
    pub const FAILURE: Self = Self(1);
}

impl From<u8> for Exit {
    fn from(code: u8) -> Self {
        Self(code)
    }
}
