//! The grammar, held against its corpus, against all programs of the project, and against the words of the language;
//! and the queries of the editors, held against the grammar.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use tree_sitter::{Language, Node, Parser, Query, Tree};

/// Files that have no `.err` beside them, and are not ARL nonetheless, and why.
const REFUSED: [(&str, &str); 4] = [
    ("editors/vscode/tests/grammar/comments_and_strings.arl", "has a wrong escape, for its colour"),
    ("editors/vscode/tests/grammar/numbers_and_units.arl", "has wrong numbers, for their colour"),
    ("editors/vscode/tests/grammar/operators.arl", "leaves parentheses open, for their colours"),
    ("editors/vscode/tests/grammar/words.arl", "leaves blocks open"),
];

/// The folder of this crate.
fn here() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

/// The folder of the project.
fn project() -> PathBuf {
    here().join("../..").canonicalize().unwrap()
}

fn language() -> Language {
    tree_sitter_arl::LANGUAGE.into()
}

fn parse(text: &[u8]) -> Tree {
    let mut parser = Parser::new();
    parser.set_language(&language()).unwrap();
    parser.parse(text, None).unwrap()
}

/// The files below `folder` whose names end in `ending`, in order, without what is built or fetched.
fn files(folder: &Path, ending: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut open = vec![folder.to_path_buf()];
    while let Some(folder) = open.pop() {
        for entry in fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_name().unwrap().to_string_lossy();
            if path.is_dir() {
                if name != "target" && name != "node_modules" && !name.starts_with('.') {
                    open.push(path);
                }
            } else if name.ends_with(ending) {
                found.push(path);
            }
        }
    }
    found.sort();
    found
}

/// The first node of an error below `node`.
fn first_error(node: Node<'_>) -> Option<Node<'_>> {
    if node.is_error() || node.is_missing() {
        return Some(node);
    }
    let mut cursor = node.walk();
    node.children(&mut cursor).filter(|child| child.has_error()).find_map(first_error)
}

/// A case of the corpus.
struct Case<'a> {
    name: &'a str,
    /// Whether it must have an error, and its tree is not looked at.
    error: bool,
    text: &'a str,
    tree: &'a str,
}

fn is_row_of(line: &str, sign: char) -> bool {
    line.len() >= 3 && line.chars().all(|other| other == sign)
}

/// The cases of a file of the corpus: a name between two rows of `=`, the text, a row of `-`, the tree.
fn cases(corpus: &str) -> Vec<Case<'_>> {
    let mut places = Vec::new();
    let mut at = 0;
    for line in corpus.split_inclusive('\n') {
        places.push((at, line.trim_end()));
        at += line.len();
    }
    let end_of = |index: usize| places.get(index + 1).map_or(corpus.len(), |place| place.0);
    let rows: Vec<usize> = (0..places.len()).filter(|index| is_row_of(places[*index].1, '=')).collect();
    assert!(rows.len().is_multiple_of(2), "a row of `=` lacks its partner");
    let mut cases = Vec::new();
    for (number, pair) in rows.chunks(2).enumerate() {
        let (first, second) = (pair[0], pair[1]);
        let next = rows.get(2 * number + 2).copied().unwrap_or(places.len());
        let middle = (second..next).rev().find(|index| is_row_of(places[*index].1, '-')).expect("a row of `-`");
        let text = &corpus[end_of(second)..places[middle].0];
        cases.push(Case {
            name: places[first + 1].1,
            error: places[first + 1..second].iter().any(|place| place.1 == ":error"),
            // The empty lines above and below the text are not its own.
            text: text.strip_prefix('\n').unwrap_or(text).strip_suffix('\n').unwrap_or(text),
            tree: &corpus[end_of(middle)..end_of(next - 1)],
        });
    }
    cases
}

/// The tree in one line.
fn flat(tree: &str) -> String {
    tree.split_whitespace().collect::<Vec<_>>().join(" ").replace(" )", ")")
}

#[test]
fn corpus() {
    let mut count = 0;
    let mut wrong = String::new();
    for file in files(&here().join("test/corpus"), ".txt") {
        let corpus = fs::read_to_string(&file).unwrap();
        for case in cases(&corpus) {
            count += 1;
            let tree = parse(case.text.as_bytes());
            let found = tree.root_node().to_sexp();
            let right = if case.error { tree.root_node().has_error() } else { found == flat(case.tree) };
            if !right {
                let wanted = if case.error { "an error".to_owned() } else { flat(case.tree) };
                writeln!(wrong, "{}: {}\n  wanted {wanted}\n  found  {found}", file.display(), case.name).unwrap();
            }
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    assert!(count > 50, "{count} cases only");
    println!("{count} cases");
}

#[test]
fn all_programs_of_the_project() {
    let project = project();
    let mut count = 0;
    let mut wrong = String::new();
    for file in files(&project, ".arl") {
        if file.with_extension("err").exists() {
            continue;
        }
        let text = fs::read(&file).unwrap();
        let tree = parse(&text);
        let name = file.strip_prefix(&project).unwrap().to_string_lossy().replace('\\', "/");
        let error = first_error(tree.root_node());
        match (error, REFUSED.iter().find(|(refused, _)| *refused == name)) {
            (None, None) => count += 1,
            (Some(_), Some(_)) => {}
            (Some(node), None) => {
                let place = node.start_position();
                writeln!(wrong, "{name}:{}:{}: {node:?}", place.row + 1, place.column + 1).unwrap();
            }
            (None, Some(_)) => writeln!(wrong, "{name} has no error, and is a file of `REFUSED`").unwrap(),
        }
    }
    assert!(wrong.is_empty(), "\n{wrong}");
    assert!(count > 1000, "{count} files only");
    println!("{count} files");
}

/// Text that is cut off anywhere has a tree, too.
#[test]
fn pieces_of_programs() {
    let text = fs::read(project().join("arl-lang/tests/support/program.arl")).unwrap();
    for end in 0..text.len() {
        assert!(parse(&text[..end]).root_node().end_byte() <= end);
    }
}

#[test]
fn queries_fit_the_grammar() {
    let mut queries = files(&here().join("queries"), ".scm");
    queries.extend(files(&here().join("../zed"), ".scm"));
    assert!(queries.len() > 10);
    for file in queries {
        let text = fs::read_to_string(&file).unwrap();
        if let Err(error) = Query::new(&language(), &text) {
            panic!("{}: {error}", file.display());
        }
    }
}

/// Zed finds objects of text by the same names, in a folder of its own.
#[test]
fn text_objects_are_the_same_everywhere() {
    let read = |path: &str| fs::read_to_string(here().join(path)).unwrap();
    assert_eq!(read("queries/textobjects.scm"), read("../zed/languages/arl/textobjects.scm"));
}

/// The strings of a JSON list.
fn strings(list: &serde_json::Value) -> Vec<String> {
    list.as_array().unwrap().iter().map(|word| word.as_str().unwrap().to_owned()).collect()
}

/// The words that the token `rule` is a choice of, sorted.
fn token_words(grammar: &serde_json::Value, rule: &str) -> Vec<String> {
    let members = grammar["rules"][rule]["content"]["members"].as_array().unwrap();
    let mut words: Vec<String> = members.iter().map(|member| member["value"].as_str().unwrap().to_owned()).collect();
    words.sort();
    words
}

/// The words that a table of the compiler's `words.rs` has, sorted.
fn compiler_words(source: &str, table: &str) -> Vec<String> {
    let (_, rest) = source.split_once(&format!("const {table}: &str =")).unwrap();
    let text = rest.split('"').nth(1).unwrap().replace('\\', " ");
    let mut words: Vec<String> = text.split_whitespace().map(str::to_owned).collect();
    words.sort();
    words
}

#[test]
fn words_are_those_of_the_compiler() {
    let grammar = fs::read_to_string(here().join("src/grammar.json")).unwrap();
    let grammar: serde_json::Value = serde_json::from_str(&grammar).unwrap();
    let source = fs::read_to_string(project().join("arl-lang/src/words.rs")).unwrap();
    for (rule, table) in [
        ("primitive_type", "TYPES"),
        ("_reserved_instruction", "INSTRUCTIONS"),
        ("_open_instruction", "OPEN_INSTRUCTIONS"),
    ] {
        assert_eq!(token_words(&grammar, rule), compiler_words(&source, table), "{rule}");
    }
    let mut fixed: Vec<&str> = source
        .lines()
        .filter_map(|line| line.trim().strip_prefix("(\"")?.split_once("\", Token::"))
        .map(|(word, _)| word)
        .collect();
    fixed.sort_unstable();
    let reserved = grammar["reserved"]["global"].as_array().unwrap();
    let mut keywords: Vec<&str> = reserved.iter().filter_map(|word| word["value"].as_str()).collect();
    keywords.sort_unstable();
    assert_eq!(keywords, fixed);
}

#[test]
fn colours_of_built_ins_are_complete() {
    let words = fs::read_to_string(here().join("../vscode/words.json")).unwrap();
    let words: serde_json::Value = serde_json::from_str(&words).unwrap();
    let functions = strings(&words["functions"]).join("|");
    // `endl` is a word of the grammar.
    let constants: Vec<String> = strings(&words["constants"]).into_iter().filter(|word| word != "endl").collect();
    let constants = constants.join("|");
    let mut queries = files(&here().join("queries"), "highlights.scm");
    queries.extend(files(&here().join("../zed"), "highlights.scm"));
    for file in queries {
        let text = fs::read_to_string(&file).unwrap();
        let count = |list: &str| text.matches(&format!("({list})")).count();
        assert_eq!((count(&functions), count(&constants)), (2, 1), "{}", file.display());
    }
}
