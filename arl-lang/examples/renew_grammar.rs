//! Writes `src/grammar.rs` anew from `src/grammar.lalrpop`: `cargo run -p arl-lang --example renew_grammar`.

use std::path::Path;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let parser = generated(&source)?;
    std::fs::write(source.join("grammar.rs"), parser)?;
    Ok(())
}

include!("../tests/support/generated.rs");
