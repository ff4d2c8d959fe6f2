//! The committed parser is the one that lalrpop makes of the grammar.

include!("support/generated.rs");

#[test]
fn grammar_rs_is_made_of_grammar_lalrpop() {
    let source = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let committed = std::fs::read_to_string(source.join("grammar.rs")).unwrap();
    let fresh = generated(&source).unwrap();
    // Compared without printing: a difference has thousands of lines.
    assert!(committed == fresh, "grammar.rs is stale: cargo run -p arl-lang --example renew_grammar");
}
