//! Laying out changes nothing but the layout: of every program of the repository, and of programs that were damaged.
//!
//! `ARL_FORMAT_ROUNDS=N` damages N programs instead of 2000; `ARL_FORMAT_SEED=N` damages others.
#![allow(clippy::disallowed_methods, clippy::expect_used, reason = "tests read files, and may fail")]

use arl_lang::lexer::{Lexeme, lexemes};
use arl_lang::text::decode;
use arl2rs::compile::{compile_program, on_large_stack};
use arl2rs::emit::EmitOptions;
use arl2rs::format::format;
use arl2rs::sources::FileSystem;
use arl2rs::{CheckOptions, SourceError, Sources};
use std::path::{Path, PathBuf};

/// The programs of the repository with their paths, in the order of these.
fn corpus() -> Vec<(PathBuf, String)> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the workspace");
    let mut folders: Vec<PathBuf> = ["arl-lang", "arl-macros", "arl-rt", "benches", "command", "examples", "tests"]
        .map(|name| workspace.join(name))
        .into();
    let mut programs = Vec::new();
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).expect("a folder") {
            let path = entry.expect("an entry").path();
            if path.is_dir() && !path.ends_with("target") {
                folders.push(path);
            } else if path.extension().is_some_and(|ending| ending == "arl")
                && let Ok(text) = decode(&std::fs::read(&path).expect("a file"))
            {
                programs.push((path, text.into_owned()));
            }
        }
    }
    programs.sort();
    assert!(programs.len() > 1000, "only {} programs", programs.len());
    programs
}

/// The ARL of the documentation: what stands between fences.
fn documented() -> Vec<String> {
    let folders = ["../docs", "docs/diagnostics"].map(|name| Path::new(env!("CARGO_MANIFEST_DIR")).join(name));
    let pages = folders.map(|folder| std::fs::read_dir(folder).expect("a folder"));
    let mut blocks = Vec::new();
    for page in pages.into_iter().flatten() {
        let path = page.expect("an entry").path();
        if path.extension().is_some_and(|ending| ending == "md") {
            let text = std::fs::read_to_string(path).expect("a page");
            let fenced = text.split("\n```").skip(1).step_by(2).filter_map(|block| block.strip_prefix("arl\n"));
            blocks.extend(fenced.map(String::from));
        }
    }
    blocks
}

/// All that has to stay: lexemes, words folded; comments, but for blanks in them; where lines end. This counts on
/// nothing that the formatter itself uses but the lexer.
fn kept(text: &str) -> String {
    let mut kept = String::new();
    let mut end = 0;
    let between = |kept: &mut String, from: usize, to: usize| {
        kept.extend(text[from..to].chars().filter(|c| !c.is_ascii_whitespace() && *c != '\u{b}'));
    };
    for (lexeme, span) in lexemes(text) {
        let span = span.start as usize..span.end as usize;
        between(&mut kept, end, span.start);
        end = span.end;
        let written = &text[span];
        match lexeme {
            Ok(Lexeme::Newline) if kept.ends_with('\n') => {}
            Ok(Lexeme::Newline) => kept.push('\n'),
            Ok(Lexeme::Word | Lexeme::System) => kept.push_str(&written.to_ascii_lowercase()),
            // A comment that never ends reaches to the end of the text, with its line ends.
            Err(_) => kept.push_str(written.replace("\r\n", "\n").replace('\r', "\n").trim_end_matches('\n')),
            Ok(_) => kept.push_str(written),
        }
    }
    between(&mut kept, end, text.len());
    kept.trim_matches('\n').to_string()
}

#[track_caller]
fn assert_stable(text: &str) -> String {
    let laid_out = format(text);
    assert_eq!(format(&laid_out), laid_out, "once more, from:\n{text:?}");
    assert_eq!(kept(&laid_out), kept(text), "from:\n{text:?}\nto:\n{laid_out:?}");
    laid_out
}

/// The lines of `text` with the blank lines of `laid_out`, so that each has the number that it has there.
fn with_blank_lines_of(laid_out: &str, text: &str) -> String {
    let mut lines = text.lines().filter(|line| !line.trim().is_empty());
    let mut moved = String::new();
    for line in laid_out.lines() {
        if !line.trim().is_empty() {
            moved.push_str(lines.next().unwrap_or_default());
        }
        moved.push('\n');
    }
    assert_eq!(lines.next(), None, "a line is left");
    moved
}

/// The files of a program: laid out, or with the same line numbers as if they were.
struct Moved {
    laid_out: bool,
}

impl Sources for Moved {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        let bytes = FileSystem.read(path)?;
        let Ok(text) = decode(&bytes) else { return Ok(bytes) };
        let laid_out = format(&text);
        let read = if self.laid_out { laid_out } else { with_blank_lines_of(&laid_out, &text) };
        Ok(read.into_bytes())
    }
}

/// The Rust of a program without its comments, which quote the ARL; `None` where it has errors.
fn emitted(main: &Path, laid_out: bool) -> Option<String> {
    let compiled =
        compile_program(main, &Moved { laid_out }, &CheckOptions::default(), &EmitOptions::default()).expect("no bug");
    // The parser drops comments.
    Some(compiled.rust?.parse::<proc_macro2::TokenStream>().expect("Rust").to_string())
}

#[test]
fn programs_stay_the_same() {
    on_large_stack(|| {
        let mut compiled = 0;
        for (path, text) in corpus() {
            if assert_stable(&text) == text {
                continue;
            }
            let before = emitted(&path, false);
            compiled += usize::from(before.is_some());
            assert_eq!(before, emitted(&path, true), "{}", path.display());
        }
        assert!(compiled > 500, "only {compiled} programs were compiled");
        let documented = documented();
        assert!(documented.len() > 100, "only {} blocks", documented.len());
        for text in documented {
            assert_stable(&text);
        }
    });
}

#[test]
fn the_page_shows_what_the_command_does() {
    let page =
        std::fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/formatting.md")).expect("the page");
    let block =
        |language: &str| page.split(&format!("```{language}\n")).nth(1).and_then(|rest| rest.split("```").next());
    assert_eq!(block("text").map(format).as_deref(), block("arl"));
}

/// A small generator of pseudo-random numbers (xorshift), so that a failure can be repeated.
struct Random(u64);

impl Random {
    fn next(&mut self) -> u64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        self.0.wrapping_mul(0x2545_f491_4f6c_dd1d)
    }

    fn below(&mut self, limit: usize) -> usize {
        ((self.next() >> 33) as usize).checked_rem(limit).unwrap_or(0)
    }
}

/// What is put into programs: what begins and ends something, mostly.
const TOKENS: &str = "if( ) if(a) endif else elseif(b) while(c) endwhile { } [ ] , ; : :: . = == + - -- ++ % 5 5mm .5 12b 3eh \
                      x $A # #a \" 's' \"s\" // /* */ \\ func endfunc func_void_f() end wend pose speed lin spl case default: \
                      switch(x) endswitch goto repeat until(a) loop endloop for(;;) endfor then ， （ “ 变 ! ~ && true mm/s deg s";

/// Deletes, doubles, swaps or inserts bytes, tokens or lines.
fn damage(text: &str, random: &mut Random) -> String {
    let mut parts: Vec<&str> = match random.below(3) {
        0 => text.split_inclusive('\n').collect(),
        1 => text.split_inclusive(|c: char| !c.is_ascii_alphanumeric()).collect(),
        _ => text.char_indices().map(|(at, c)| &text[at..at + c.len_utf8()]).collect(),
    };
    let tokens: Vec<&str> =
        TOKENS.split(' ').chain(["\n", "\r", "\r\n", "\n\n", " ", "\t", "\\\n", "// c\n"]).collect();
    for _ in 0..=random.below(4) {
        let (at, other) = (random.below(parts.len()), random.below(parts.len()));
        match random.below(5) {
            0 if !parts.is_empty() => {
                parts.remove(at);
            }
            1 if !parts.is_empty() => parts.insert(other, parts[at]),
            2 if !parts.is_empty() => parts.swap(at, other),
            _ => parts.insert(at, tokens[random.below(tokens.len())]),
        }
    }
    parts.concat()
}

#[test]
fn damaged_programs_keep_what_they_have() {
    let number = |name: &str| std::env::var(name).ok().and_then(|number| number.parse::<u64>().ok());
    let seed = number("ARL_FORMAT_SEED").unwrap_or(1);
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1);
    on_large_stack(|| {
        let programs: Vec<String> =
            corpus().into_iter().map(|(_, text)| text).filter(|text| text.len() < 4000).collect();
        for _ in 0..number("ARL_FORMAT_ROUNDS").unwrap_or(2000) {
            let program = &programs[random.below(programs.len())];
            let damaged = damage(program, &mut random);
            assert_stable(&damaged);
        }
    });
}
