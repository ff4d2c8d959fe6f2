//! The reference: pages about the language, written by hand in `transpiler/docs/reference/`, and pages of all
//! built-ins, generated from the catalog.
//!
//! A page of the language is `transpiler/docs/reference/AREA/NAME.md`: its title, a paragraph whose first sentence is
//! used in lists, rules, examples, and at its end the lines `Words:` (the names by which it is found), `See:` and
//! `Manual:`. `cargo test -p arl2rs-cli --test reference` runs the examples.

mod find;
mod list;
mod search;
mod topics;

pub use find::{page, suggestion};
pub use list::list;
pub use search::search;
pub use topics::Topic;
