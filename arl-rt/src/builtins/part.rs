//! Parts of long functions: rustc compiles several short bodies much faster than a long one.

use std::pin::Pin;

/// How a part of a function ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Leave<T> {
    /// The function continues after the part.
    On,
    /// The function returns this.
    Return(T),
    /// The loop around the part ends.
    Break,
    /// The loop around the part continues with its next iteration.
    Continue,
    /// The function continues at the target that it has set.
    Jump,
}

/// A part of a function, to be awaited. It is accessed through a pointer, so that it is compiled separately.
pub fn part<'a, T>(lines: Pin<&'a mut (dyn Future<Output = T> + 'a)>) -> Pin<&'a mut (dyn Future<Output = T> + 'a)> {
    lines
}
