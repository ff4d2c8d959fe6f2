//! The committed parser is the one that lalrpop makes of the grammar, and the lexer the one that logos makes of the
//! lexemes.

include!("support/generated.rs");

type Made = Result<String, Box<dyn std::error::Error>>;

/// Whether a file of `src/` is what is made of its source now. A difference has thousands of lines: it is not shown.
fn is_fresh(name: &str, made: impl Fn(&Path) -> Made) -> Result<bool, Box<dyn std::error::Error>> {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    Ok(std::fs::read_to_string(source.join(name))? == made(&source)?)
}

const HOW: &str = "it is stale: cargo run -p arl-lang --example renew_grammar";

#[test]
fn grammar_rs_is_made_of_grammar_lalrpop() {
    assert!(is_fresh("grammar.rs", grammar).expect("lalrpop makes it"), "{HOW}");
}

#[test]
fn lexeme_rs_is_made_of_lexeme_logos() {
    assert!(is_fresh("lexeme.rs", lexemes).expect("logos makes it"), "{HOW}");
}
