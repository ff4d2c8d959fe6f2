//! The Rust that the examples become, one file each, as `arl2rs emit` writes it.
//!
//! A test in the compiler compares these files with what it emits now. To renew them:
//! `UPDATE_GENERATED=1 cargo test -p arl2rs --test generated`.
#![allow(
    missing_docs,
    clippy::module_inception,
    clippy::too_many_lines,
    reason = "files and functions have the names that they have in ARL"
)]

#[rustfmt::skip]
pub mod drain;
#[rustfmt::skip]
pub mod fill;
#[rustfmt::skip]
pub mod greet;
#[rustfmt::skip]
pub mod light_curtain;
#[rustfmt::skip]
pub mod pick_and_place;
#[rustfmt::skip]
pub mod plc_cell;
