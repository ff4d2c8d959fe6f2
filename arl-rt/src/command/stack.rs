//! How much stack programs get.

/// How much of the stack the program's functions may use, by measure enough for all calls that may be nested, and how
/// much the thread has on top of that for everything else.
pub(super) const PROGRAM_STACK_BYTES: usize = 64 << 20;
const CONTROLLER_STACK_BYTES: usize = 1 << 20;

/// The stack that a run gets.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Stack {
    /// A part of what threads of another program have as a rule, which is 2 MiB: enough for functions that do not call
    /// each other in a circle.
    OfHost,
    /// That of a thread that was made for the run, with [`Stack::WHOLE_BYTES`].
    Whole,
}

impl Stack {
    /// How many bytes a thread needs for all calls that may be nested, and for the controller.
    pub const WHOLE_BYTES: usize = PROGRAM_STACK_BYTES + CONTROLLER_STACK_BYTES;
    const HOST_BYTES: usize = 1 << 20;

    /// How many bytes the functions of the program may use.
    pub(super) fn program_bytes(self) -> usize {
        match self {
            Self::OfHost => Self::HOST_BYTES,
            Self::Whole => PROGRAM_STACK_BYTES,
        }
    }
}
