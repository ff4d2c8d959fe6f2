//! Runs of similar statements as tables: each statement adds only a row to what rustc compiles, not its code.
//!
//! Statements are similar if they differ only in constants ([`shape`]). Consecutive ones become one loop over a table
//! ([`runs`]): the differing constants are its columns, and each shape is emitted once, with the columns in place of
//! the constants ([`table`]). Invariants:
//! - the statements run in the same order, with the same values and at the same lines as without the table;
//! - no statement of a table writes a local, declares one, or leaves the table other than by an alarm.

mod runs;
mod shape;
mod table;

pub(super) use runs::Group;
pub(super) use shape::{Filling, Hole, Shape, of_call, of_value};
pub(super) use table::{Columns, Entry, Lead, column_type, same};
