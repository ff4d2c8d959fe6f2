//! Every conformance case that runs, compiled by the build script.
#![allow(dead_code, unreachable_pub, unused_assignments, missing_docs, reason = "emitted")]

// Half a minute for clippy, which has nothing to say here.
#[cfg(not(clippy))]
include!(concat!(env!("OUT_DIR"), "/built.rs"));

#[cfg(not(clippy))]
#[test]
fn cases_do_in_rust_what_the_command_does() {
    assert!(CASES.len() > 100, "the corpus is there");
    let failures = door_tests::run_all(CASES);
    assert!(failures.is_empty(), "{} of {} failed:\n{}", failures.len(), CASES.len(), failures.join("\n"));
}
