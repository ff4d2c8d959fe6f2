//! The conformance corpus: compiled again it gives the same bytes, what is emitted gives no warning, and programs that
//! were damaged are dealt with in peace.

use crate::{report, times};
use arl_lang::catalog::{all_entries, constants, system_variables, type_names};
use arl_tests::project::Project;
use arl_tests::random::Random;
use arl2rs::compile::{compile_program, on_large_stack};
use arl2rs::emit::EmitOptions;
use arl2rs::{CheckOptions, SourceError, Sources};
use std::collections::HashSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Tells the second process where to write what it emits.
const CHILD: &str = "ARL_PROPERTY_EMIT_TO";

/// A program of the corpus: its path below the corpus, and whether its robot is a SCARA.
struct Entry {
    path: PathBuf,
    scara: bool,
}

impl Entry {
    fn options(&self) -> CheckOptions {
        let mut options = CheckOptions::default();
        if self.scara {
            options.family = arl_lang::catalog::Family::Scara;
        }
        options
    }
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("conformance")
}

/// All files of the corpus, in order.
fn entries() -> Vec<Entry> {
    let mut found = Vec::new();
    let mut open = vec![PathBuf::new()];
    while let Some(folder) = open.pop() {
        for file in std::fs::read_dir(corpus().join(&folder)).expect("the corpus") {
            let file = file.expect("a file of the corpus");
            let path = folder.join(file.file_name());
            if file.path().is_dir() {
                open.push(path);
            } else if path.extension().is_some_and(|ending| ending == "arl") {
                let options = std::fs::read_to_string(file.path().with_extension("toml")).unwrap_or_default();
                found.push(Entry { path, scara: options.contains("hsr065") });
            }
        }
    }
    found.sort_by(|a, b| a.path.cmp(&b.path));
    found
}

/// Files on disk, one of them with another text.
struct Disk<'a> {
    changed: Option<(&'a Path, &'a [u8])>,
}

impl Sources for Disk<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        match self.changed {
            Some((changed, text)) if changed == path => Ok(text.to_vec()),
            _ => std::fs::read(path).map_err(|_| SourceError::Missing),
        }
    }
}

/// The Rust of a program below a folder, where it is accepted; an error is a panic inside the compiler.
fn rust(folder: &Path, entry: &Entry, changed: Option<&[u8]>) -> Result<Option<String>, String> {
    let main = folder.join(&entry.path);
    let disk = Disk { changed: changed.map(|text| (main.as_path(), text)) };
    let (options, emitting) = (entry.options(), EmitOptions::default());
    match on_large_stack(|| compile_program(&main, &disk, &options, &emitting).map(|compiled| compiled.rust)) {
        Ok(rust) => Ok(rust),
        Err(bug) => Err(bug.to_string()),
    }
}

/// What the whole corpus below a folder gives, as one text.
fn all_rust(folder: &Path) -> String {
    let mut all = String::new();
    for entry in entries() {
        match rust(folder, &entry, None).unwrap() {
            Some(rust) => writeln!(all, "// {}\n{rust}", entry.path.display()).unwrap(),
            None => writeln!(all, "// {} is refused", entry.path.display()).unwrap(),
        }
    }
    all
}

/// Copies the files of a folder.
fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for file in std::fs::read_dir(from).unwrap() {
        let file = file.unwrap();
        let target = to.join(file.file_name());
        if file.path().is_dir() {
            copy(&file.path(), &target);
        } else {
            std::fs::copy(file.path(), target).unwrap();
        }
    }
}

#[test]
fn compiled_again_a_program_gives_the_same_bytes() {
    if let Some(to) = std::env::var_os(CHILD) {
        // The second process: from the folder that it was started in.
        std::fs::write(to, all_rust(Path::new(""))).unwrap();
        return;
    }
    let here = all_rust(&corpus());
    assert!(here == all_rust(&corpus()), "the same process emits something else the second time");
    let elsewhere = Path::new(env!("CARGO_TARGET_TMPDIR")).join("arl-property-elsewhere");
    let _ = std::fs::remove_dir_all(&elsewhere);
    copy(&corpus(), &elsewhere);
    let result = elsewhere.join("emitted.txt");
    let name = "corpus::compiled_again_a_program_gives_the_same_bytes";
    let mut command = Command::new(std::env::current_exe().unwrap());
    command.args(["--exact", name]).env(CHILD, &result).current_dir(&elsewhere);
    assert!(command.output().unwrap().status.success());
    let there = std::fs::read_to_string(result).unwrap();
    let differing = here.lines().zip(there.lines()).find(|(here, there)| here != there);
    assert!(here == there, "another process, in another folder, emits something else: {differing:?}");
}

#[test]
fn what_is_emitted_for_the_corpus_gives_no_warning() {
    let mut programs = Vec::new();
    let mut names = Vec::new();
    for entry in entries() {
        if let Some(rust) = rust(&corpus(), &entry, None).unwrap() {
            programs.push(rust);
            names.push(entry.path);
        }
    }
    let project = Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-property-corpus");
    if let Err(errors) = project.check(&programs) {
        let named = names.iter().enumerate();
        let named = named.filter(|(at, _)| errors.contains(&format!("programs/p{at}.rs")));
        let named: Vec<String> = named.map(|(at, path)| format!("p{at}: {}", path.display())).collect();
        let errors: String = errors.lines().take(60).map(|line| format!("{line}\n")).collect();
        panic!("rustc has something to say in {}\n{errors}\n{}", project.folder().display(), named.join("\n"));
    }
}

/// The words of the corpus's programs, in lower case, those of system variables with their `$`.
fn words_of_the_corpus() -> HashSet<String> {
    let mut found = HashSet::new();
    for entry in entries() {
        let text = std::fs::read(corpus().join(&entry.path)).unwrap();
        for line in String::from_utf8_lossy(&text).lines() {
            // What is not in texts, up to a comment.
            let code: String = line.split('"').step_by(2).collect::<Vec<_>>().join(" ");
            let code = code.split("//").next().unwrap_or_default().to_ascii_lowercase();
            let parts = code.split(|letter: char| !letter.is_ascii_alphanumeric() && letter != '_' && letter != '$');
            found.extend(parts.map(str::to_owned));
        }
    }
    found
}

#[test]
fn all_that_is_built_in_has_a_case() {
    let words = words_of_the_corpus();
    let callees = all_entries().iter().map(|entry| entry.name.to_owned());
    let variables = system_variables().map(|variable| format!("${}", variable.name));
    let types = type_names().map(|(_, base)| base.name().to_owned());
    let constants = constants().iter().map(|constant| constant.name.to_owned());
    let all = callees.chain(variables).chain(types).chain(constants);
    let missing: Vec<String> = all.filter(|name| !words.contains(&name.to_ascii_lowercase())).collect();
    assert!(missing.is_empty(), "no case of the corpus uses {missing:?}");
}

#[test]
fn damaged_programs_are_dealt_with_in_peace() {
    let mut random = Random::new(crate::first_seed() + 7);
    let mut failures = Vec::new();
    let mut accepted = 0;
    for entry in entries() {
        let Ok(text) = std::fs::read(corpus().join(&entry.path)) else { continue };
        for _ in 0..4 * times() {
            let damaged = damage(&text, &mut random);
            match rust(&corpus(), &entry, Some(&damaged)) {
                Ok(None) => {}
                Ok(Some(first)) => {
                    accepted += 1;
                    let problem = match (syn::parse_file(&first), rust(&corpus(), &entry, Some(&damaged))) {
                        (Err(error), _) => format!("no Rust: {error}\n{first}"),
                        (_, Ok(Some(second))) if second == first => continue,
                        _ => "compiled again it gives something else".into(),
                    };
                    failures.push(failure(&entry, &problem, &damaged));
                }
                Err(bug) => failures.push(failure(&entry, &bug, &damaged)),
            }
        }
    }
    report(&Project::new(env!("CARGO_TARGET_TMPDIR"), "arl-property-damage"), failures);
    assert!(accepted > 100, "hardly a damaged program is accepted: {accepted}");
}

fn failure(entry: &Entry, problem: &str, damaged: &[u8]) -> String {
    format!("{}\n{problem}\n====\n{}", entry.path.display(), String::from_utf8_lossy(damaged))
}

/// A text with one or two mistakes: words dropped, doubled, exchanged, replaced by others of the text, lines moved.
fn damage(text: &[u8], random: &mut Random) -> Vec<u8> {
    let mut parts = words(text);
    for _ in 0..1 + random.below(2) {
        if parts.len() < 3 {
            break;
        }
        let (at, other) = (random.below(parts.len()), random.below(parts.len()));
        let next = (at + 2).min(parts.len() - 1);
        match random.below(7) {
            0 => {
                parts.remove(at);
            }
            1 => parts.insert(at, parts[at].clone()),
            2 => parts.swap(at, other),
            3 => parts[at] = parts[other].clone(),
            4 => parts.swap(at, next),
            5 => {
                let mut lines = lines(&parts);
                let (from, to) = (random.below(lines.len()), random.below(lines.len()));
                let line = lines.remove(from);
                lines.insert(to.min(lines.len()), line);
                parts = lines.concat();
            }
            _ => {
                let mut lines = lines(&parts);
                let from = random.below(lines.len());
                lines.insert(random.below(lines.len()), lines[from].clone());
                parts = lines.concat();
            }
        }
    }
    parts.concat()
}

/// A text as words, blanks and single signs.
fn words(text: &[u8]) -> Vec<Vec<u8>> {
    let kind = |byte: u8| match byte {
        b' ' | b'\t' => 1,
        byte if byte.is_ascii_alphanumeric() || byte == b'_' || byte >= 0x80 => 2,
        _ => 0,
    };
    let mut parts: Vec<Vec<u8>> = Vec::new();
    for byte in text {
        match parts.last_mut() {
            Some(last) if kind(*byte) > 0 && kind(last[0]) == kind(*byte) => last.push(*byte),
            _ => parts.push(vec![*byte]),
        }
    }
    parts
}

/// The parts line by line.
fn lines(parts: &[Vec<u8>]) -> Vec<Vec<Vec<u8>>> {
    parts.split_inclusive(|part| part == b"\n").map(<[Vec<u8>]>::to_vec).collect()
}
