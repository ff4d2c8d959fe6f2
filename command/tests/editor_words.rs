//! The words that editors colour are those of the language. `UPDATE_WORDS=1` writes them anew: `words.json` of the
//! extension for VS Code, from which its grammar is made, and the lists in the queries of the grammar for tree-sitter.

#![allow(clippy::expect_used, reason = "tests read and write files, and may fail")]

use arl_lang::catalog::{self, Enum, Kind};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The lists that the extension has, and its words.
type Lists = Vec<(&'static str, BTreeSet<String>)>;

/// The queries that have the functions and the constants as alternatives of a pattern.
const QUERIES: &[&str] = &[
    "tree-sitter-arl/queries/highlights.scm",
    "tree-sitter-arl/queries/helix/highlights.scm",
    "tree-sitter-arl/queries/nvim/highlights.scm",
    "zed/languages/arl/highlights.scm",
];

fn editors(file: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../editors").join(file)
}

fn read(file: &str) -> String {
    std::fs::read_to_string(editors(file)).expect("a file of the editors")
}

/// A name and its other spellings, folded.
fn spellings(name: &str, aliases: &[&str]) -> Vec<String> {
    std::iter::once(&name).chain(aliases).map(|name| name.to_ascii_lowercase()).collect()
}

fn entries(kind: Kind) -> BTreeSet<String> {
    let all = catalog::all_entries().iter().filter(|entry| entry.kind == kind);
    all.flat_map(|entry| spellings(entry.name, entry.aliases)).collect()
}

fn lists() -> Lists {
    let enums = Enum::ALL.into_iter().flat_map(|id| id.def().constants);
    let constants = catalog::constants().iter().flat_map(|constant| spellings(constant.name, &[]));
    let constants = constants.chain(enums.flat_map(|constant| spellings(constant.name, constant.aliases)));
    let types = catalog::type_names().filter(|(_, base)| !base.is_system()).map(|(name, _)| name.to_ascii_lowercase());
    let elements = catalog::system_variables().flat_map(catalog::SystemVariable::element_names);
    let system = catalog::system_variables().flat_map(|variable| spellings(variable.name, variable.aliases));
    vec![
        ("keywords", arl_lang::control_words().map(String::from).collect()),
        ("types", types.collect()),
        ("instructions", entries(Kind::Instruction)),
        ("functions", entries(Kind::Function)),
        ("constants", constants.collect()),
        ("system", system.chain(elements).collect()),
    ]
}

fn as_json(lists: &Lists) -> String {
    let list = |(name, words): &(&str, BTreeSet<String>)| {
        let words: Vec<String> = words.iter().map(|word| format!("    \"{word}\"")).collect();
        format!("  \"{name}\": [\n{}\n  ]", words.join(",\n"))
    };
    format!("{{\n{}\n}}\n", lists.iter().map(list).collect::<Vec<_>>().join(",\n"))
}

/// A list as queries have it. `endl` is a word of the grammar.
fn alternatives<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    format!("^({})$", words.into_iter().filter(|word| *word != "endl").collect::<Vec<_>>().join("|"))
}

#[test]
fn the_lists_are_those_of_the_catalog() {
    let lists = lists();
    let (there, wanted) = (read("vscode/words.json"), as_json(&lists));
    if std::env::var_os("UPDATE_WORDS").is_some() {
        renew(&there, &lists);
    } else {
        assert!(there == wanted, "words.json: UPDATE_WORDS=1 renews it");
        for query in QUERIES {
            let text = read(query);
            let has =
                |(_, words): &(&str, BTreeSet<String>)| text.contains(&alternatives(words.iter().map(String::as_str)));
            let mut used = lists.iter().filter(|(name, _)| ["functions", "constants"].contains(name));
            assert!(used.all(has), "{query}: UPDATE_WORDS=1 renews it");
        }
    }
}

/// Writes the lists, and puts the new ones in place of the old ones in the queries.
fn renew(there: &str, lists: &Lists) {
    let old: serde_json::Value = serde_json::from_str(there).expect("the lists are JSON");
    for query in QUERIES {
        let mut text = read(query);
        for (name, words) in lists.iter().filter(|(name, _)| ["functions", "constants"].contains(name)) {
            let old = old[name].as_array().expect("a list").iter().filter_map(|word| word.as_str());
            let old = alternatives(old);
            assert!(text.contains(&old), "{query}: the {name} are not those of words.json");
            text = text.replace(&old, &alternatives(words.iter().map(String::as_str)));
        }
        std::fs::write(editors(query), text).expect("the query is written");
    }
    std::fs::write(editors("vscode/words.json"), as_json(lists)).expect("the lists are written");
}
