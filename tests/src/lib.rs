//! What the tests of the whole workspace share: a second, independent account of ARL.
//!
//! [`tree`] is the language as a tree with types, [`grow`] makes random trees that are right by construction,
//! [`mod@write`] turns them into ARL, and [`machine`] executes them. None of it uses the compiler or the runtime: it is
//! written from the language's rules alone, so that both sides must be wrong in the same way for a test to pass by
//! mistake. [`project`] compiles what the compiler emits and runs it, [`mod@engine`] runs its code.

#![allow(clippy::disallowed_methods)]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests stop where something is wrong")]

pub mod builtins;
pub mod engine;
pub mod grow;
pub mod machine;
pub mod operators;
pub mod project;
pub mod random;
pub mod tree;
pub mod value;
pub mod write;
