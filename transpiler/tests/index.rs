//! The index of names: what an editor is told about a place.
#![allow(clippy::disallowed_methods, clippy::unwrap_used, reason = "a test reads files, and may fail")]

use arl_lang::lexer::{Lexeme, lexemes};
use arl2rs::diagnostics::FileId;
use arl2rs::sources::FileSystem;
use arl2rs::{CheckOptions, Checked, check};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Words that are not names: of control structures, and units.
const NO_NAMES: &str = "break case const continue default else elseif endfor endfunc endif endloop endswitch endwhile \
    false for func goto if import loop repeat return switch true until while mm s deg";

fn options() -> CheckOptions {
    CheckOptions { index: true, library: true, ..CheckOptions::default() }
}

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("..")
}

fn programs(folder: &Path, out: &mut Vec<PathBuf>) {
    let mut entries: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    entries.sort();
    for path in entries {
        if path.is_dir() {
            programs(&path, out);
        } else if path.extension().is_some_and(|ending| ending == "arl") {
            out.push(path);
        }
    }
}

/// The names of the main file that the index does not know, with their lines.
fn unknown(checked: &Checked) -> Vec<String> {
    let index = checked.index.as_ref().unwrap();
    let file = checked.files.get(FileId(0)).unwrap();
    let no_names: BTreeSet<&str> = NO_NAMES.split_whitespace().collect();
    let mut unknown = Vec::new();
    for (lexeme, span) in lexemes(&file.text) {
        let text = span.text(&file.text);
        let is_name = matches!(lexeme, Ok(Lexeme::Word | Lexeme::System));
        if !is_name || no_names.contains(text.to_ascii_lowercase().as_str()) {
            continue;
        }
        if index.at(FileId(0), span.start).is_none_or(|mention| mention.at.span != span) {
            unknown.push(format!("{}:{}: {text}", file.name, file.lines.line(span.start)));
        }
    }
    unknown
}

#[test]
fn every_name_of_a_right_program_is_known() {
    let mut paths = Vec::new();
    programs(&folder().join("tests/conformance"), &mut paths);
    programs(&folder().join("examples"), &mut paths);
    let mut missing = Vec::new();
    let mut looked = 0;
    for path in &paths {
        for family in [arl_lang::catalog::Family::SixAxis, arl_lang::catalog::Family::Scara] {
            let checked = check(path, &FileSystem, &CheckOptions { family, ..options() });
            if !checked.has_errors() {
                looked += 1;
                missing.extend(unknown(&checked));
            }
        }
    }
    missing.dedup();
    assert!(looked > 300, "only {looked} programs were right");
    assert!(missing.is_empty(), "{} names:\n{}", missing.len(), missing.join("\n"));
}
