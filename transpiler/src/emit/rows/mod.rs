//! Runs of like statements as tables: what rustc is given grows by a row for each statement, not by its code.
//!
//! Statements are alike when they differ in constants only ([`shape`]). Those that follow one another become one loop
//! over a table ([`runs`]): the constants that differ are its columns, and each shape is emitted once, with the columns
//! in place of them ([`table`]). Invariants:
//! - what runs, in which order, with which values and at which line is the same as without the table;
//! - no statement of a table writes a local, declares one, or leaves the table but by an alarm.

mod runs;
mod shape;
mod table;

pub(super) use runs::Group;
pub(super) use shape::{Filling, Hole, Shape, of_call, of_value};
pub(super) use table::{Columns, Entry, Lead, column_type, same};
