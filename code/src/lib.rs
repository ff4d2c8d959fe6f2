//! The code of a checked ARL program that the engine runs without rustc.
//!
//! The compiler (`arl2rs::lower`) makes it from the checked program, `arl-engine` runs it. It is plain data: a row of
//! operations of 12 bytes, and the tables that they refer to. [`Code`] has the whole, [`Op`] the operations.
//!
//! A function works on a frame: 256 registers of 8 bytes for numbers, a memory of words in which structures and arrays
//! lie flat, a row of strings, a row of handles (clocks, connections), and a row of boxes for the variables that events
//! see. Types are known, so words have no tags: an int is its 32 bits, a double its 64, a bool 0 or 1, an enumeration
//! the number of its constant.

mod bundle;
mod code;
mod format;
mod layout;
mod numbers;
mod op;
mod place;
mod verify;

pub use bundle::*;
pub use code::*;
pub use layout::*;
pub use op::*;
pub use place::*;
