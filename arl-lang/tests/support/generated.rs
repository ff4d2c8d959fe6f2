/// The parser that lalrpop makes of the grammar in `source`, with a first line that says how to renew it.
fn generated(source: &std::path::Path) -> Result<String, Box<dyn std::error::Error>> {
    let place = std::env::temp_dir().join(format!("arl-grammar-{}", std::process::id()));
    std::fs::create_dir_all(&place)?;
    std::fs::copy(source.join("grammar.lalrpop"), place.join("grammar.lalrpop"))?;
    lalrpop::Configuration::new()
        .set_in_dir(&place)
        .set_out_dir(&place)
        .emit_rerun_directives(false)
        .force_build(true)
        .log_quiet()
        .process()
        .map_err(|error| error.to_string())?;
    let parser = std::fs::read_to_string(place.join("grammar.rs"))?;
    std::fs::remove_dir_all(&place)?;
    let first = "// Made of grammar.lalrpop; renew it with: cargo run -p arl-lang --example renew_grammar\n";
    Ok(format!("{first}{parser}"))
}
