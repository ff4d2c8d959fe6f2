//! Where mistakes in ARL show in Rust. Renew the expected texts with `TRYBUILD=overwrite`, and read what changed.

/// rustc words its messages anew in every version; the expected texts are those of this one.
const RUSTC: &str = "rustc 1.95.";

#[test]
fn mistakes_show_on_their_tokens() {
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let version = std::process::Command::new(rustc).arg("--version").output().map(|output| output.stdout);
    if version.is_ok_and(|version| String::from_utf8_lossy(&version).starts_with(RUSTC)) {
        trybuild::TestCases::new().compile_fail("tests/ui/*.rs");
    }
}
