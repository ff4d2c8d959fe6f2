//! The example with an io island: a robot and the stand-in for a PLC, in one process, over Modbus TCP.
#![allow(clippy::expect_used, reason = "tests start processes, and may fail")]

use std::path::Path;
use std::process::Command;

#[test]
fn the_press_is_loaded_over_modbus() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/modbus_cell");
    let output = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
        .args(["run", "modbus_cell.arl", "--cell", "cell.toml", "--max-time", "60", "--state-dir"])
        .arg(Path::new(env!("CARGO_TARGET_TMPDIR")).join("modbus_cell_state"))
        .current_dir(folder)
        .env("ARL2RS_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"))
        .output()
        .expect("the command starts");
    let (out, stderr) = (String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr));
    assert_eq!(out, "part 1: 6.75 mm\npart 2: 5.5 mm\npart 3: 4.25 mm\n", "{stderr}");
    assert!(output.status.success(), "{stderr}");
}
