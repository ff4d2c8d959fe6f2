//! The layout loses nothing: on all programs of the repository, and on mutilated ones.
#![cfg(feature = "cli")]
#![allow(clippy::disallowed_methods, clippy::expect_used, clippy::unwrap_used, clippy::panic, reason = "a test")]

use arl_lang::lexer::{Lexeme, lexemes};
use arl2rs::compile::compile_program;
use arl2rs::emit::EmitOptions;
use arl2rs::format::format;
use arl2rs::{CheckOptions, SourceError, Sources};
use std::path::{Path, PathBuf};

fn programs() -> Vec<PathBuf> {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for folder in ["tests", "examples", "benches/benches", "transpiler/tests"] {
        collect(&root.join(folder), &mut found);
    }
    found.sort();
    found
}

fn collect(folder: &Path, found: &mut Vec<PathBuf>) {
    for path in std::fs::read_dir(folder).unwrap().flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            collect(&path, found);
        } else if path.extension().is_some_and(|ending| ending == "arl") {
            found.push(path);
        }
    }
}

fn text(path: &Path) -> Option<String> {
    arl_lang::text::decode(&std::fs::read(path).unwrap()).ok().map(|text| text.into_owned())
}

/// The lexemes that are no line ends, folded, and all comments' words: a second account of what has to stay.
fn content(text: &str) -> (Vec<String>, Vec<String>) {
    // Line ends become those of the first line.
    let text = &text.replace("\r\n", "\n").replace('\r', "\n");
    let mut words = Vec::new();
    let mut comments = Vec::new();
    let mut end = 0;
    let mut between = |gap: &str| {
        let gap = gap.replace('\\', " ");
        comments.extend(gap.split_whitespace().map(ToString::to_string));
    };
    for (lexeme, span) in lexemes(text) {
        between(text.get(end..span.start as usize).unwrap_or_default());
        end = span.end as usize;
        let word = span.text(text);
        match lexeme {
            Ok(Lexeme::Newline) => {}
            Ok(Lexeme::Text) | Err(_) => words.push(word.trim_end().to_string()),
            // A unit may be part of its number.
            Ok(_) => words.push(word.split_whitespace().collect::<String>().to_ascii_lowercase()),
        }
    }
    between(text.get(end..).unwrap_or_default());
    (words.concat().chars().map(String::from).collect(), comments)
}

fn holds(source: &str, of: &str) -> String {
    let formatted = format(source);
    assert_eq!(content(source), content(&formatted), "{of}:\n{formatted}");
    assert_eq!(format(&formatted), formatted, "twice: {of}:\n{source}");
    formatted
}

/// The sources with one text in the place of another.
struct With<'a>(&'a Path, &'a str);

impl Sources for With<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        if path == self.0 {
            return Ok(self.1.as_bytes().to_vec());
        }
        std::fs::read(path).map_err(|_| SourceError::Missing)
    }
}

/// What a program becomes, without comments. Numbers are left out: lines have others.
fn emitted(path: &Path, text: &str) -> Option<String> {
    let options = CheckOptions::default();
    let compiled = compile_program(path, &With(path, text), &options, &EmitOptions::default()).unwrap();
    let rust = syn::parse_file(&compiled.rust?).unwrap();
    let tokens = quote::quote!(#rust).to_string();
    Some(tokens.chars().filter(|one| !one.is_ascii_digit()).collect())
}

#[test]
fn all_programs_of_the_repository_keep_their_words_and_their_meaning() {
    let (mut right, mut all) = (0, 0);
    for path in programs() {
        let Some(source) = text(&path) else { continue };
        let formatted = holds(&source, &path.display().to_string());
        all += 1;
        // What is emitted is the same but for the names of things whose case was another.
        if let Some(before) = emitted(&path, &source) {
            right += 1;
            let after = emitted(&path, &formatted);
            assert_eq!(Some(before), after, "{}", path.display());
        }
    }
    assert!(all > 500 && right > 300, "{all} programs, {right} of them right");
}

/// Small and the same everywhere.
struct Random(u64);

impl Random {
    fn below(&mut self, most: usize) -> usize {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        ((self.0 >> 33) as usize) % most.max(1)
    }
}

fn mutilated(text: &str, random: &mut Random) -> String {
    const PARTS: [&str; 14] =
        ["(", ")", "{", "}", "\"", "/*", "*/", "//", "\\\n", "endif\n", "if(", ",", "\u{1f916}", "\r\n"];
    let mut text: Vec<char> = text.chars().collect();
    for _ in 0..=random.below(4) {
        let at = random.below(text.len() + 1);
        match random.below(4) {
            0 => drop(text.drain(at..(at + 1 + random.below(12)).min(text.len()))),
            1 => {
                let part: Vec<char> = text[at..(at + random.below(30)).min(text.len())].to_vec();
                let to = random.below(text.len() + 1);
                text.splice(to..to, part);
            }
            _ => drop(text.splice(at..at, PARTS[random.below(PARTS.len())].chars())),
        }
    }
    text.into_iter().collect()
}

#[test]
fn mutilated_programs_keep_their_words() {
    let rounds: usize = std::env::var("ARL_FORMAT_ROUNDS").ok().and_then(|text| text.parse().ok()).unwrap_or(1500);
    let sources: Vec<String> =
        programs().iter().filter_map(|path| text(path)).filter(|text| text.len() < 4000).collect();
    let mut random = Random(3);
    for round in 0..rounds {
        let source = mutilated(&sources[random.below(sources.len())], &mut random);
        holds(&source, &format!("round {round}"));
    }
}
