//! How the command ends: 0 done, 1 compile errors, 2 usage, 3 alarm, 4 out of time, 130 interrupted.

/// An exit code. The standard one cannot be asked for its number.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub(super) struct Exit(pub(super) u8);

impl Exit {
    pub(super) const SUCCESS: Self = Self(0);
    pub(super) const FAILURE: Self = Self(1);
}

impl From<u8> for Exit {
    fn from(code: u8) -> Self {
        Self(code)
    }
}
