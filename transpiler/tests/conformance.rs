//! The conformance cases through the command, and the example that a PLC works.
#![cfg(feature = "cli")]
#![allow(clippy::disallowed_methods, clippy::expect_used, reason = "tests start processes, and may fail")]

use std::path::Path;
use std::process::Command;

#[test]
fn all_cases_pass() {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let output = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
        .args(["test", "tests/conformance", "examples/plc_cell"])
        .current_dir(workspace)
        .env("ARL2RS_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"))
        .output()
        .expect("the command starts");
    let out = String::from_utf8_lossy(&output.stdout);
    let summary = out.lines().last().unwrap_or_default();
    println!("{summary}");
    assert!(output.status.success(), "{out}{}", String::from_utf8_lossy(&output.stderr));
    let passed = summary.split(' ').next().and_then(|count| count.parse::<u32>().ok());
    assert!(passed.is_some_and(|passed| passed > 500), "{summary}");
}
