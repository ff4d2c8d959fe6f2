//! The reference: every page has its form, every example does what stands below it, and the pages of what is built in
//! are those that the catalog gives (`UPDATE_REFERENCE=1` writes them).
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "a test")]

use arl_lang::catalog::{self, Base, Family, reference};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// The folders with pages about the language.
const AREAS: [&str; 4] = ["statements", "types", "operators", "rules"];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../transpiler/docs/reference")
}

/// The pages about the language: AREA/NAME and text.
fn pages() -> Vec<(String, String)> {
    let mut pages = Vec::new();
    for area in AREAS {
        let mut files: Vec<PathBuf> =
            std::fs::read_dir(folder().join(area)).unwrap().map(|entry| entry.unwrap().path()).collect();
        files.sort();
        for file in files {
            let name = file.file_stem().unwrap().to_string_lossy().into_owned();
            pages.push((format!("{area}/{name}"), std::fs::read_to_string(file).unwrap()));
        }
    }
    pages
}

/// The words between backticks in the line of a page that begins so.
fn listed<'a>(text: &'a str, begin: &str) -> Vec<&'a str> {
    let line = text.lines().find_map(|line| line.strip_prefix(begin)).unwrap_or_default();
    line.split('`').skip(1).step_by(2).collect()
}

fn doc(arguments: &[&str]) -> (bool, String) {
    let output = Command::new(env!("CARGO_BIN_EXE_arl2rs")).arg("doc").args(arguments).output().unwrap();
    (output.status.success(), String::from_utf8_lossy(&output.stdout).into_owned())
}

#[test]
fn every_page_has_its_form() {
    let (_, list) = doc(&[]);
    let mut faults = Vec::new();
    for (page, text) in pages() {
        let mut fault = |what: String| faults.push(format!("{page}: {what}"));
        let name = page.rsplit('/').next().unwrap();
        if !list.lines().any(|line| line.split_whitespace().next() == Some(name)) {
            fault("is not in the list of `arl2rs doc`: transpiler/src/reference/topics.rs".into());
        }
        let parts: Vec<&str> = text.splitn(3, "\n\n").collect();
        if !parts[0].starts_with("# ") || parts.len() < 3 {
            fault("begins with a title and a paragraph".into());
        }
        let paragraph = parts[1].replace('\n', " ");
        let summary = paragraph.split_once(". ").map_or(paragraph.as_str(), |(first, _)| first);
        if summary.chars().count() > 90 {
            fault(format!("its first sentence is too long for a list: {summary}"));
        }
        let end: Vec<&str> = text.lines().rev().take(3).collect();
        if !end.iter().any(|line| line.starts_with("Words: ")) || !end.iter().any(|line| line.starts_with("See: ")) {
            fault("ends with the lines `Words:`, `See:` and, where there is a section, `Manual:`".into());
        }
        let mut in_block = false;
        for line in text.lines() {
            in_block ^= line.starts_with("```");
            if line.chars().count() > 110 && !line.starts_with('|') && !line.starts_with("Words:") && !in_block {
                fault(format!("a line of more than 110 characters: {line}"));
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

#[test]
fn what_pages_refer_to_exists() {
    let words: BTreeSet<String> = pages()
        .iter()
        .flat_map(|(page, text)| {
            let own = page.rsplit('/').next().unwrap().to_lowercase();
            let words: Vec<String> = listed(text, "Words: ").iter().map(|word| word.to_lowercase()).collect();
            words.into_iter().chain([own])
        })
        .collect();
    let mut faults = Vec::new();
    for (page, text) in pages() {
        for name in listed(&text, "See: ") {
            if !words.contains(&name.to_lowercase()) && reference::page(name).is_none() {
                faults.push(format!("{page}: `{name}`"));
            }
        }
    }
    assert!(faults.is_empty(), "no page has these names\n{}", faults.join("\n"));
}

/// A program of a page.
#[derive(Default)]
struct Example {
    program: String,
    marks: Vec<String>,
    /// Further files.
    files: Vec<(String, String)>,
    /// What it prints.
    prints: Option<String>,
}

/// The programs of a page, in order.
fn examples(text: &str) -> Vec<Example> {
    let mut examples: Vec<Example> = Vec::new();
    let mut waiting = Example::default();
    let mut blocks = text.split("\n```").skip(1);
    let mut behind_program = false;
    while let (Some(block), after) = (blocks.next(), blocks.next()) {
        let (info, body) = block.split_once('\n').expect("a block has lines");
        let body = format!("{body}\n");
        let mut words = info.split_whitespace();
        let language = words.next().unwrap_or_default();
        let marks: Vec<String> = words.map(String::from).collect();
        let file = marks.iter().find_map(|mark| mark.strip_prefix("file=")).map(String::from);
        match (language, file) {
            ("arl", Some(name)) => waiting.files.push((name, body)),
            ("arl", None) => examples.push(Example { program: body, marks, ..std::mem::take(&mut waiting) }),
            ("toml", _) => waiting.files.push((format!("{}.toml", marks.first().map_or("none", String::as_str)), body)),
            ("text", _) if behind_program => examples.last_mut().expect("a program").prints = Some(body),
            _ => {}
        }
        // Only blank lines stand between a program and what it prints.
        behind_program = language == "arl" && after.is_some_and(|after| after.trim().is_empty());
    }
    examples
}

#[test]
fn every_example_does_what_stands_below_it() {
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("reference");
    let _ = std::fs::remove_dir_all(&root);
    let mut count = 0;
    for (page, text) in pages() {
        for (number, example) in examples(&text).into_iter().enumerate() {
            write_case(&root.join(page.replace('/', "-")).join((number + 1).to_string()), &example);
            count += 1;
        }
    }
    assert!(count > 60, "the pages have examples: {count}");
    let output = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
        .arg("test")
        .arg(&root)
        .env("ARL2RS_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"))
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success(), "{printed}");
    assert!(printed.contains(&format!("{count} passed, 0 failed")), "{printed}");
}

/// Writes an example as a case of `arl2rs test`.
fn write_case(folder: &Path, example: &Example) {
    std::fs::create_dir_all(folder).unwrap();
    let write = |name: &str, text: &str| std::fs::write(folder.join(name), text).unwrap();
    let is = |mark: &str| example.marks.iter().any(|other| other == mark);
    let mut options = String::new();
    if is("scara") {
        options += "robot = \"hsr065\"\n";
    }
    for (name, text) in &example.files {
        match name.as_str() {
            "scenario.toml" => write("main.io.toml", text),
            "cell.toml" => {
                options += "cell = \"cell.toml\"\n";
                write("cell.toml", text);
            }
            name => write(name, text),
        }
    }
    if !options.is_empty() {
        write("main.toml", &options);
    }
    write("main.arl", &example.program);
    let prints = example.prints.as_deref().unwrap_or_default();
    if is("wrong") {
        // Which lines are wrong is for the reader to see; the command says it.
        let output = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
            .args(["check", "--format", "json"])
            .arg(folder.join("main.arl"))
            .output()
            .unwrap();
        let lines: Vec<String> = String::from_utf8_lossy(&output.stdout)
            .lines()
            .filter(|line| line.contains("\"error\""))
            .filter_map(|line| Some(line.split_once("\"line\":")?.1.split([',', '}']).next()?.to_owned()))
            .collect();
        assert!(!lines.is_empty(), "{} is not wrong", folder.display());
        write("main.err", &(lines.join("\n") + "\n"));
    } else if is("alarm") {
        let (out, alarm) = prints.trim_end().rsplit_once('\n').unwrap_or(("", prints.trim_end()));
        let parts = alarm.strip_prefix("alarm ").and_then(|alarm| alarm.strip_suffix(')')?.split_once(" (main.arl:"));
        let (number, line) = parts.expect("the last line is `alarm NUMBER (main.arl:LINE)`");
        let output = if out.is_empty() { String::new() } else { format!("{out}\n") };
        write("main.out", &output);
        write("main.alarm", &format!("{number} {line}\n"));
    } else {
        write("main.out", prints);
    }
}

#[test]
fn examples_of_what_is_built_in_run() {
    let root = Path::new(env!("CARGO_TARGET_TMPDIR")).join("reference_built_in");
    let _ = std::fs::remove_dir_all(&root);
    let mut count = 0;
    let mut add = |name: &str, example: &str, family: Option<Family>| {
        let folder = root.join(format!("{count:03}-{}", name.trim_start_matches('$')));
        std::fs::create_dir_all(&folder).unwrap();
        let robot = if family == Some(Family::Scara) { "robot = \"hsr065\"\n" } else { "" };
        std::fs::write(folder.join("main.arl"), format!("func void main()\n{example}\nendfunc\n")).unwrap();
        std::fs::write(folder.join("main.toml"), format!("max_time = 5\n{robot}")).unwrap();
        count += 1;
    };
    for entry in catalog::all_entries() {
        add(entry.name, entry.example, entry.family);
    }
    for variable in catalog::system_variables() {
        add(variable.name, variable.example, None);
    }
    // What comes is taken as it is: an end, an alarm, or the end of the time. Nothing else passes.
    let output = Command::new(env!("CARGO_BIN_EXE_arl2rs"))
        .args(["test", "--bless"])
        .arg(&root)
        .env("ARL2RS_CACHE", Path::new(env!("CARGO_TARGET_TMPDIR")).join("cache"))
        .env("NO_COLOR", "1")
        .output()
        .unwrap();
    let printed = String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
    assert!(output.status.success() && printed.contains(&format!("{count} passed, 0 failed")), "{printed}");
    let mut alarms = Vec::new();
    for folder in std::fs::read_dir(&root).unwrap() {
        let folder = folder.unwrap().path();
        if let Ok(alarm) = std::fs::read_to_string(folder.join("main.alarm")) {
            let name = folder.file_name().unwrap().to_string_lossy().into_owned();
            alarms.push(format!("{} {}", name.split_once('-').unwrap().1, alarm.split(' ').next().unwrap()));
        }
    }
    alarms.sort();
    assert_eq!(alarms, ENDING_WITH_ALARMS);
}

/// The examples that end with an alarm here: nothing is connected, and they run in the foreground.
const ENDING_WITH_ALARMS: &[&str] = &[
    "read 20050",
    "read 20050",
    "read 20050",
    "read 20050",
    "read 20050",
    "setcycle 20050",
    "switcharl 20004",
    "write 20050",
    "write 20050",
    "write 20050",
    "write 20050",
];

/// The pages of what is built in: file name and text.
fn built_in() -> Vec<(String, String)> {
    let mut files = Vec::new();
    let mut index = String::from("# What is built in\n\n");
    index += "These pages are written from the catalog of the language. `arl2rs doc NAME` shows each entry.\n\n";
    let mut add = |title: &str, parts: Vec<String>| {
        let name: String = title.to_lowercase().chars().map(|c| if c.is_alphanumeric() { c } else { '-' }).collect();
        let name = name.split('-').filter(|part| !part.is_empty()).collect::<Vec<_>>().join("-");
        let text = parts.join("\n").replace("\n### ", "\n## ");
        let text = text.strip_prefix("### ").map_or(text.clone(), |rest| format!("## {rest}"));
        files.push((format!("{name}.md"), format!("# {title}\n\n{text}")));
        writeln!(index, "- [{title}]({name}.md)").unwrap();
    };
    for chapter in catalog::CHAPTERS {
        let groups = chapter.entries.chunk_by(|a, b| a.kind == b.kind && a.name == b.name);
        add(chapter.title, groups.filter_map(reference::entries).collect());
    }
    for title in ["Structures", "Enumerations", "Handles"] {
        let page = |base| match (base, title) {
            (Base::Struct(id), "Structures") => Some(reference::structure(id)),
            (Base::Enum(id), "Enumerations") => Some(reference::enumeration(id)),
            (Base::Handle(id), "Handles") => Some(reference::handle(id)),
            _ => None,
        };
        let mut parts: Vec<String> = catalog::type_names().filter_map(|(_, base)| page(base)).collect();
        parts.dedup();
        add(title, parts);
    }
    add("System variables", catalog::system_variables().map(reference::system_variable).collect());
    add("Constants", catalog::constants().iter().map(reference::constant).collect());
    files.push(("README.md".into(), index));
    files
}

/// The list of all pages, in the order of `arl2rs doc`.
fn index() -> String {
    let mut text = String::from("# Reference\n\n");
    text += "`arl2rs doc NAME` shows these pages; `arl2rs doc --search WORDS` searches all of them.\n";
    let (_, list) = doc(&[]);
    let language = list.split("\nBuilt in: ").next().unwrap_or_default();
    for line in language.lines().skip(2).filter(|line| !line.is_empty()) {
        match line.strip_prefix("  ").and_then(|line| line.split_once(' ')) {
            Some((name, summary)) => {
                let area = AREAS.iter().find(|area| folder().join(area).join(format!("{name}.md")).is_file()).unwrap();
                writeln!(text, "- [{name}]({area}/{name}.md): {}", summary.trim()).unwrap();
            }
            None => writeln!(text, "\n## {line}\n").unwrap(),
        }
    }
    text + "\n[What is built in](built-in/README.md): instructions, functions, structures, system variables.\n"
}

#[test]
fn the_list_of_pages_is_complete() {
    let file = folder().join("README.md");
    let text = index();
    if std::env::var_os("UPDATE_REFERENCE").is_some() {
        std::fs::write(&file, &text).unwrap();
    }
    let there = std::fs::read_to_string(&file).unwrap_or_default();
    assert!(there == text, "docs/reference/README.md: UPDATE_REFERENCE=1 renews it");
}

#[test]
fn pages_of_what_is_built_in_are_those_of_the_catalog() {
    let folder = folder().join("built-in");
    let renew = std::env::var_os("UPDATE_REFERENCE").is_some();
    if renew {
        let _ = std::fs::remove_dir_all(&folder);
        std::fs::create_dir_all(&folder).unwrap();
    }
    let mut wanted: BTreeSet<String> = BTreeSet::new();
    for (name, text) in built_in() {
        if renew {
            std::fs::write(folder.join(&name), &text).unwrap();
        }
        let there = std::fs::read_to_string(folder.join(&name)).unwrap_or_default();
        assert!(there == text, "docs/reference/built-in/{name}: UPDATE_REFERENCE=1 renews it");
        wanted.insert(name);
    }
    let found: BTreeSet<String> =
        std::fs::read_dir(&folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(found, wanted);
}

#[test]
fn doc_finds_lists_and_searches() {
    let (good, text) = doc(&["string"]);
    assert!(good && text.starts_with("# string\n"), "{text}");
    let (good, text) = doc(&["--search", "interrupt", "priority"]);
    assert!(good && text.lines().next().unwrap().contains("interrupt"), "{text}");
    for wrong in [&["whille"][..], &["--search", "xyzzyx"]] {
        let (good, text) = doc(wrong);
        assert!(!good && text.is_empty(), "{wrong:?}: {text}");
    }
}
