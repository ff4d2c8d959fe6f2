//! Splits long functions into parts: the time that rustc needs for an `async fn` grows with the square of its
//! `.await`s.
//!
//! [`mod@apart`] determines which functions are compiled separately anyway. [`weight`] counts the `.await`s, [`plan`]
//! decides which statements of a block become a part, and [`part`] emits it: an `async` block, which rustc compiles as
//! a separate body, polled through a pointer so that it is not merged again. Invariants:
//! - a part is a run of whole statements of one block; the block's last statement is in no part if control does not
//!   continue after it;
//! - a local that is declared in a part and mentioned outside it lives before all parts of the block, with its default
//!   value; its declaration becomes an assignment;
//! - an exit from a part (`return`, `break`, `continue`, a jump) ends it with a [`Leave`](leave), and the code after
//!   the part carries it out.
//!
//! The names of locals are distinct in functions with parts, as the locals before the parts share a scope.

mod apart;
mod leave;
mod part;
mod plan;
mod weight;

pub(super) use apart::{apart, is_large};
pub(super) use leave::{Frame, Leave};
pub(super) use weight::Weights;
