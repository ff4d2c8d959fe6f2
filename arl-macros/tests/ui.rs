//! What rustc says: to mistakes in `arl!`, and to what build scripts emit for wrong programs.
//!
//! `TRYBUILD=overwrite` renews the expected messages, `UPDATE_GENERATED=1` the emitted files.

use std::path::Path;

/// rustc words its messages anew in every version; the expected texts are those of this one.
const RUSTC: &str = "rustc 1.95.";

#[test]
fn rustc_says_what_is_wrong_and_where() -> std::io::Result<()> {
    emit()?;
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = std::process::Command::new(rustc).arg("--version").output()?;
    let cases = trybuild::TestCases::new();
    // None that passes: then all need only be checked, and nothing is optimised for it. `right_program.rs` passes.
    if String::from_utf8_lossy(&version.stdout).starts_with(RUSTC) {
        cases.compile_fail("tests/ui/*.rs");
        cases.compile_fail("tests/emitted/errors_in_code.rs");
    }
    Ok(())
}

/// The emitted files that the cases include are those that a build script makes now.
fn emit() -> std::io::Result<()> {
    let out = Path::new(env!("CARGO_TARGET_TMPDIR")).join("emitted");
    std::fs::create_dir_all(&out)?;
    for name in ["right", "wrong"] {
        // Without what an earlier run left: the last good program would go into the file.
        let _ = std::fs::remove_file(out.join(format!("{name}.last.rs")));
        let program = format!("tests/emitted/{name}.arl");
        let lines = arl2rs::Build::new().program(program).errors_in_code(true).compile_into(&out);
        assert!(!lines.iter().any(|line| line.starts_with("cargo::error=")), "{lines:?}");
        let emitted = std::fs::read_to_string(out.join(format!("{name}.rs")))?;
        let committed = Path::new("tests/emitted").join(format!("{name}.rs"));
        if std::env::var_os("UPDATE_GENERATED").is_some() {
            std::fs::write(&committed, &emitted)?;
        }
        assert_eq!(std::fs::read_to_string(committed)?, emitted, "{name}.rs is stale");
    }
    Ok(())
}
