//! What ARL becomes in Rust: every kind of statement and expression, compared as text.
//!
//! The cases lie in `tests/emitter/*.txt`: a heading, ARL, `----`, the Rust of the module (without the lines that are
//! the same everywhere). `UPDATE_EMITTED=1 cargo test -p arl2rs --test emitter` renews the Rust; look at the difference
//! before you commit it.
#![allow(clippy::disallowed_methods, clippy::expect_used, clippy::panic, reason = "tests read files, and may fail")]

use arl2rs::diagnostics::Severity;
use arl2rs::emit::{EmitOptions, Sizes, emit, emit_tokens};
use arl2rs::{CheckOptions, SourceError, Sources, check};
use std::collections::HashMap;
use std::path::{Path, PathBuf};

/// Parts as soon as a block waits four times.
const SHORT_PARTS: Sizes = Sizes {
    table: 100,
    rows_of_a_kind: 4,
    awaits: 3,
    awaits_of_a_part: 2,
    least_awaits: 1,
    awaits_of_a_program: 20,
    uses_of_a_template: 100,
    variables: 3,
};

/// Functions for calls that are found twice.
const FEW_USES: Sizes =
    Sizes { table: 100, awaits: 100, awaits_of_a_program: 0, uses_of_a_template: 2, least_awaits: 100, ..Sizes::LEAST };

/// Files of a case: `main.arl`, and what stands behind `//// name` lines.
struct Files(HashMap<PathBuf, String>);

impl Files {
    fn new(text: &str) -> Self {
        let mut files = HashMap::new();
        let mut name = PathBuf::from("t.arl");
        let mut content = String::new();
        for line in text.lines() {
            match line.strip_prefix("//// ") {
                Some(next) => {
                    files.insert(std::mem::replace(&mut name, next.into()), std::mem::take(&mut content));
                }
                None => {
                    content.push_str(line);
                    content.push('\n');
                }
            }
        }
        files.insert(name, content);
        Self(files)
    }
}

impl Sources for Files {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        self.0.get(path).map(|text| text.clone().into_bytes()).ok_or(SourceError::Missing)
    }
}

/// The whole file that a program becomes.
fn emitted(arl: &str, sizes: Sizes) -> String {
    let checked = check(Path::new("t.arl"), &Files::new(arl), &CheckOptions::default());
    let errors: Vec<String> = checked
        .diagnostics
        .iter()
        .filter(|diagnostic| diagnostic.severity == Severity::Error)
        .map(|diagnostic| diagnostic.message.to_string())
        .collect();
    let Some(program) = &checked.program else { panic!("refused: {errors:?}\n{arl}") };
    let options = EmitOptions { sizes, ..EmitOptions::default() };
    let text = emit(program, &options);
    assert_eq!(text, emit(program, &options), "the same program gives the same text");
    syn::parse_file(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
    let tokens = emit_tokens(program).to_string();
    assert!(!tokens.contains("ARL_") && !text.contains("ARL_"), "a marker is left:\n{text}");
    text
}

/// The functions and variables of the module, without what every file has.
fn module_only(text: &str) -> String {
    let mut out = String::new();
    let mut inside = false;
    for line in text.lines() {
        match line {
            "pub mod t {" => inside = true,
            "}" => inside = false,
            "    use super::Globals;" | "    use arl_rt::emit::*;" => {}
            "    const FILE: File = File::new(\"t.arl\");" => {}
            _ if inside => {
                out.push_str(line.strip_prefix("    ").unwrap_or(line));
                out.push('\n');
            }
            _ => {}
        }
    }
    format!("{}\n", out.trim())
}

struct Case {
    name: String,
    arl: String,
    rust: String,
}

fn cases(text: &str) -> Vec<Case> {
    let parts = text.split("\n==== ").filter(|part| !part.trim().is_empty());
    parts
        .map(|part| {
            let (name, rest) = part.strip_prefix("==== ").unwrap_or(part).split_once('\n').expect("a heading");
            let (arl, rust) = rest.split_once("----\n").unwrap_or((rest, ""));
            Case { name: name.to_string(), arl: arl.to_string(), rust: rust.to_string() }
        })
        .collect()
}

fn compare(file: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/emitter").join(file);
    let text = std::fs::read_to_string(&path).expect("the cases");
    let whole = file == "files.txt";
    let sizes = match file {
        "parts.txt" => SHORT_PARTS,
        "templates.txt" => FEW_USES,
        _ => Sizes::default(),
    };
    let mut renewed = String::new();
    let mut wrong = Vec::new();
    for case in cases(&text) {
        let emitted = emitted(&case.arl, sizes);
        let now = if whole { emitted } else { module_only(&emitted) };
        renewed.push_str(&format!("==== {}\n{}----\n{now}\n", case.name, case.arl));
        if now.trim_end() != case.rust.trim_end() {
            wrong.push(format!("{}: expected\n{}\nemitted\n{now}", case.name, case.rust));
        }
    }
    if std::env::var_os("UPDATE_EMITTED").is_some() {
        std::fs::write(&path, renewed).expect("written");
        return;
    }
    assert!(wrong.is_empty(), "{file}, {} cases differ:\n{}", wrong.len(), wrong.join("\n"));
}

macro_rules! files {
    ($($test:ident $file:literal)*) => { $(
        #[test]
        fn $test() {
            compare($file);
        }
    )* };
}

files! {
    expressions "expressions.txt"
    places "places.txt"
    assignments "assignments.txt"
    control "control.txt"
    functions "functions.txt"
    gotos "goto.txt"
    rows "rows.txt"
    templates "templates.txt"
    parts "parts.txt"
    builtins "builtins.txt"
    names "names.txt"
    whole_files "files.txt"
}
