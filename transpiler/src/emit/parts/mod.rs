//! Long functions in parts: rustc's time for an `async fn` grows with the square of its `.await`s.
//!
//! [`mod@apart`] says which functions are compiled by themselves anyway. [`weight`] counts them, [`plan`] says which
//! statements of a block become a part, and [`part`] emits it: an `async` block, which rustc takes for a body of its
//! own, polled through a pointer so that it is not put together again. Invariants:
//! - a part is a run of whole statements of one block, and the block's last statement is in none where it does not go
//!   on;
//! - a local that is declared in a part and mentioned outside it lives in front of all parts of the block, with its
//!   start value; its declaration becomes an assignment;
//! - what leaves a part (`return`, `break`, `continue`, a jump) ends it with a [`Leave`](leave), and the code behind
//!   the part does what is asked.
//!
//! The names of locals are distinct in functions that have parts, as those in front of the parts share a scope.

mod apart;
mod leave;
mod part;
mod plan;
mod weight;

pub(super) use apart::{apart, is_large};
pub(super) use leave::{Frame, Leave};
pub(super) use weight::Weights;
