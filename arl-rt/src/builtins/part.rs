//! Parts of long functions: rustc compiles several short bodies much sooner than a long one.

use std::pin::Pin;

/// How a part of a function ends.
#[derive(Clone, Copy, PartialEq, Eq, Debug)]
pub enum Leave<T> {
    /// The function goes on behind the part.
    On,
    /// The function returns this.
    Return(T),
    /// The loop around the part ends.
    Break,
    /// The loop around the part has its next round.
    Continue,
    /// The function goes on where it has said.
    Jump,
}

/// A part of a function, to be waited for. It is reached through a pointer, so that it is compiled by itself.
pub fn part<'a, T>(lines: Pin<&'a mut (dyn Future<Output = T> + 'a)>) -> Pin<&'a mut (dyn Future<Output = T> + 'a)> {
    lines
}
