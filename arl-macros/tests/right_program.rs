//! What the build script emits for a right program compiles without a word, also where everything is forbidden.
//! `ui.rs` holds that it is what the build script emits now.

#![deny(warnings)]
#![allow(dead_code, unreachable_pub, reason = "the program is not run, and nobody uses this crate")]

mod robot {
    include!("emitted/right.rs");
}

#[test]
fn the_program_is_there() {
    assert_eq!(arl_rt::Program::file(&robot::Globals::new()).name(), "right.arl");
}
