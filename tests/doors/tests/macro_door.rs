//! Every conformance case that runs, expanded by the macro: inline where Rust can read the text, else from its file.
#![allow(dead_code, deprecated, unreachable_pub, unused_assignments, missing_docs, reason = "emitted")]

// Half a minute for clippy, which has nothing to say here.
#[cfg(not(clippy))]
include!(concat!(env!("OUT_DIR"), "/expanded.rs"));

#[cfg(not(clippy))]
#[test]
fn cases_do_in_macros_what_the_command_does() {
    let inline = CASES.iter().filter(|(_, _, lines, _)| *lines > 0).count();
    assert!(inline * 2 > CASES.len(), "most texts can stand in Rust: {inline} of {}", CASES.len());
    let failures = door_tests::run_all(CASES);
    assert!(failures.is_empty(), "{} of {} failed:\n{}", failures.len(), CASES.len(), failures.join("\n"));
}
