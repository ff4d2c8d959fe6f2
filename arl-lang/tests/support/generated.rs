use std::path::Path;

/// The parser that lalrpop makes of the grammar in `source`, with a first line that says how to renew it.
fn grammar(source: &Path) -> Result<String, Box<dyn std::error::Error>> {
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
    Ok(first_line("grammar.lalrpop") + &parser)
}

/// The lexer that logos makes of the lexemes in `source`.
fn lexemes(source: &Path) -> Result<String, Box<dyn std::error::Error>> {
    let mut file = syn::parse_file(&std::fs::read_to_string(source.join("lexeme.logos"))?)?;
    let mut items = Vec::new();
    for item in file.items {
        let syn::Item::Enum(lexeme) = &item else {
            items.push(item);
            continue;
        };
        let tokens = quote::ToTokens::to_token_stream(lexeme);
        items.push(syn::parse2(logos_codegen::strip_attributes(tokens.clone()))?);
        items.extend(syn::parse2::<syn::File>(logos_codegen::generate(tokens))?.items);
    }
    file.items = items;
    Ok(first_line("lexeme.logos") + &prettyplease::unparse(&file))
}

fn first_line(source: &str) -> String {
    format!("// Made of {source}; renew it with: cargo run -p arl-lang --example renew_grammar\n")
}
