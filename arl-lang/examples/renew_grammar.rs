//! Writes `src/grammar.rs` anew from `src/grammar.lalrpop`, and `src/lexeme.rs` from `src/lexeme.logos`:
//! `cargo run -p arl-lang --example renew_grammar`.

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    std::fs::write(source.join("grammar.rs"), grammar(&source)?)?;
    std::fs::write(source.join("lexeme.rs"), lexemes(&source)?)?;
    Ok(())
}

include!("../tests/support/generated.rs");
