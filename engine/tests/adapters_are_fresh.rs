//! The generated files are those that the catalog gives today.

#[path = "../generate/mod.rs"]
mod generate;

use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Stdio};

/// The text as rustfmt lays it out.
fn formatted(text: &str) -> io::Result<Vec<u8>> {
    let config = concat!(env!("CARGO_MANIFEST_DIR"), "/..");
    let mut rustfmt = Command::new("rustfmt");
    rustfmt.args(["--edition", "2024", "--config-path", config]).stdin(Stdio::piped()).stdout(Stdio::piped());
    let mut child = rustfmt.spawn()?;
    child.stdin.take().into_iter().try_for_each(|mut input| input.write_all(text.as_bytes()))?;
    Ok(child.wait_with_output()?.stdout)
}

#[test]
fn adapters_are_those_of_the_catalog() -> io::Result<()> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    for (file, text) in [("adapters.rs", generate::adapters()), ("system.rs", generate::system())] {
        let kept = std::fs::read(folder.join(file))?;
        let renew = "run `cargo run -p arl-engine --example renew_adapters && cargo fmt --all`";
        assert!(formatted(&text)? == kept, "{file} is old: {renew}");
    }
    Ok(())
}
