//! Prints the mistakes in the form of a file, and with `--tree` its syntax tree:
//! `cargo run -p arl-lang --example show_tree -- FILE [--tree]`.

use arl_lang::span::LineIndex;
use arl_lang::symbol::Interner;
use arl_lang::{ParseOptions, parse, text};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let file = std::env::args().nth(1).ok_or("which file?")?;
    let bytes = std::fs::read(&file)?;
    let source = text::decode(&bytes)?;
    let mut interner = Interner::new();
    let parsed = parse(&source, &mut interner, ParseOptions::default());
    if std::env::args().any(|arg| arg == "--tree") {
        println!("{:#?}", parsed.file);
    }
    let lines = LineIndex::new(&source);
    for error in &parsed.errors {
        let (line, column) = lines.line_column(&source, error.span.start);
        println!("{file}:{line}:{column}: ARL{:04}: {}", error.kind.number(), error.kind.message());
        println!("    `{}`: {}", error.span.text(&source), error.kind.label());
        for (span, words) in &error.related {
            println!("    line {}: `{}`: {words}", lines.line(span.start), span.text(&source));
        }
        if let Some(help) = error.kind.help() {
            println!("    {help}");
        }
    }
    Ok(())
}
