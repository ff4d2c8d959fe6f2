//! The words that the extension for VS Code colours are those of the language.

use arl_lang::catalog::{self, Enum, Kind};
use std::collections::BTreeSet;

const WORDS: &str = include_str!("../../editors/vscode/words.json");

/// A name and its other spellings, folded.
fn spellings(name: &str, aliases: &[&str]) -> Vec<String> {
    std::iter::once(&name).chain(aliases).map(|name| name.to_ascii_lowercase()).collect()
}

fn entries(kind: Kind) -> BTreeSet<String> {
    let all = catalog::all_entries().iter().filter(|entry| entry.kind == kind);
    all.flat_map(|entry| spellings(entry.name, entry.aliases)).collect()
}

#[test]
fn the_lists_are_those_of_the_catalog() {
    let words: serde_json::Value = serde_json::from_str(WORDS).expect("the lists are JSON");
    let enums = Enum::ALL.into_iter().flat_map(|id| id.def().constants);
    let constants = catalog::constants().iter().flat_map(|constant| spellings(constant.name, &[]));
    let constants = constants.chain(enums.flat_map(|constant| spellings(constant.name, constant.aliases)));
    let types = catalog::type_names().filter(|(_, base)| !base.is_system()).map(|(name, _)| name.to_ascii_lowercase());
    let elements = catalog::system_variables().flat_map(catalog::SystemVariable::element_names);
    let system = catalog::system_variables().flat_map(|variable| spellings(variable.name, variable.aliases));
    let system = system.chain(elements);
    let expected = [
        ("types", types.collect()),
        ("instructions", entries(Kind::Instruction)),
        ("functions", entries(Kind::Function)),
        ("constants", constants.collect()),
        ("system", system.collect()),
        ("keywords", arl_lang::control_words().map(String::from).collect()),
    ];
    for (list, expected) in expected {
        let expected: BTreeSet<String> = expected;
        let written: Vec<String> = serde_json::from_value(words[list].clone()).expect("a list of words");
        let set: BTreeSet<String> = written.iter().cloned().collect();
        let missing: Vec<_> = expected.difference(&set).collect();
        let spare: Vec<_> = set.difference(&expected).collect();
        assert!(missing.is_empty() && spare.is_empty(), "{list}: missing {missing:?}, spare {spare:?}");
        assert!(written.is_sorted(), "{list} is not sorted");
    }
}
