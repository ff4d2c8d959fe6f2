//! The pages of the diagnostics: each code has one, and what it shows is true.
//!
//! A page is `docs/diagnostics/ARLnnnn.md`: a heading with code and title, sentences, `## Wrong` with a program that
//! raises this code and nothing else, `## Right` with a program that raises nothing. Lines above a program steer the
//! check: `Options: --strict --robot hsr065 macro` (macro: the text is statements inside of `arl!`), and
//! `` `name.arl`: `` in front of further files. `Not executed: reason` stands in place of what no text can show.

#![allow(clippy::unwrap_used, clippy::panic, clippy::disallowed_methods, reason = "a test, which reads the pages")]

use arl_robot::Robot;
use arl_robot::outline::Outline;
use arl2rs::diagnostics::{CodeInfo, Diagnostic, registry};
use arl2rs::{CheckOptions, Checked, SourceError, Sources, check_statements, check_text};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// What stands under the heading of a page.
const PARTS: &str = "
What is wrong, why, and what to do: 20 words or more.

## Wrong

```arl
a program that raises this code and nothing else
```

## Right

```arl
a program that raises nothing
```";

/// As many pages may go without execution, on one side or both.
const NOT_EXECUTED: usize = 7;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/diagnostics")
}

/// Files in memory, and nothing else.
#[derive(Default, Debug)]
struct Memory(BTreeMap<PathBuf, String>);

impl Sources for Memory {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        self.0.get(path).map(|text| text.clone().into_bytes()).ok_or(SourceError::Missing)
    }
}

/// One side of a page.
#[derive(Default, Debug)]
struct Side {
    /// The main file.
    main: Option<String>,
    others: Memory,
    options: Vec<String>,
    /// Why it is not executed.
    excuse: Option<String>,
}

/// A page, taken apart.
#[derive(Debug)]
struct Page {
    heading: String,
    prose: String,
    wrong: Side,
    right: Side,
}

impl Page {
    fn read(text: &str) -> Result<Page, String> {
        let (head, rest) = text.split_once("\n## Wrong\n").ok_or("no section `## Wrong`")?;
        let (wrong, right) = rest.split_once("\n## Right\n").ok_or("no section `## Right`")?;
        let (heading, prose) = head.split_once('\n').ok_or("no text under the heading")?;
        Ok(Page {
            heading: heading.to_string(),
            prose: prose.trim().to_string(),
            wrong: Side::read(wrong)?,
            right: Side::read(right)?,
        })
    }
}

impl Side {
    fn read(text: &str) -> Result<Side, String> {
        let mut side = Side::default();
        let mut file: Option<PathBuf> = None;
        let mut block: Option<String> = None;
        for line in text.lines() {
            if let Some(program) = &mut block {
                if line == "```" {
                    let program = block.take().unwrap_or_default();
                    match file.take() {
                        Some(name) => drop(side.others.0.insert(name, program)),
                        None if side.main.is_some() => return Err("two programs without a file name".into()),
                        None => side.main = Some(program),
                    }
                } else {
                    program.push_str(line);
                    program.push('\n');
                }
            } else if line == "```arl" || line == "```toml" {
                block = Some(String::new());
            } else if line.starts_with("```") {
                return Err(format!("a block that is neither `arl` nor `toml`: {line}"));
            } else if let Some(options) = line.strip_prefix("Options: ") {
                side.options = options.split_whitespace().map(String::from).collect();
            } else if let Some(reason) = line.strip_prefix("Not executed: ") {
                side.excuse = Some(reason.to_string());
            } else if let Some(name) = line.strip_prefix('`').and_then(|rest| rest.strip_suffix("`:")) {
                file = Some(PathBuf::from(name));
            }
        }
        match (&block, &side.main, &side.excuse) {
            (Some(_), ..) => Err("a program without its end".into()),
            (None, None, None) => Err("no program and no reason why".into()),
            _ => Ok(side),
        }
    }

    /// Checks the program; `None` where the page says that it cannot be.
    fn check(&self) -> Result<Option<Checked>, String> {
        if self.excuse.is_some() {
            return Ok(None);
        }
        let Some(main) = &self.main else { return Err("no program".into()) };
        let mut options = CheckOptions::default();
        let mut statements = false;
        let mut words = self.options.iter().map(String::as_str);
        while let Some(word) = words.next() {
            match (word, if matches!(word, "--robot" | "--cell") { words.next() } else { None }) {
                ("--strict", None) => options.strict = true,
                ("--background", None) => options.background = true,
                ("macro", None) => statements = true,
                ("--robot", Some(name)) => {
                    let robot = Robot::builtin(name).map_err(|error| error.to_string())?;
                    options.family = robot.family;
                    options.robot = Some(robot);
                }
                ("--cell", Some(name)) => {
                    let text = self.others.0.get(Path::new(name)).ok_or("no such cell file")?;
                    let cell = Outline::of_cell(name, text);
                    options.cell = Some(cell.map_err(|error| error.to_string())?);
                }
                (word, value) => return Err(format!("unknown option {word} {}", value.unwrap_or_default())),
            }
        }
        let path = Path::new("main.arl");
        Ok(Some(match statements {
            true => check_statements(path, main, &self.others, &options).0,
            false => check_text(path, main, &self.others, &options),
        }))
    }
}

fn show(checked: &Checked) -> String {
    let line = |diagnostic: &Diagnostic| {
        let Diagnostic { code, severity, message, primary, .. } = diagnostic;
        format!("\n    {severity:?} {code} in line {}: {message}", checked.files.line(primary.at))
    };
    checked.diagnostics.iter().map(line).collect()
}

/// What is wrong with the page of a code.
fn problem(info: &CodeInfo, text: &str) -> Result<usize, String> {
    let heading = format!("# {}: {}", info.code, info.title);
    let page = Page::read(text).map_err(|error| format!("{error}; a page has these parts:\n{heading}\n{PARTS}"))?;
    if page.heading != heading {
        return Err(format!("the heading is `{}`, it must be `{heading}`", page.heading));
    }
    if page.prose.split_whitespace().count() < 20 {
        return Err("it explains too little".into());
    }
    if let Some(checked) = page.wrong.check()? {
        let found = checked.diagnostics.as_slice();
        let is_it = |found: &Diagnostic| (found.code, found.severity) == (info.code, info.severity);
        if found.is_empty() || !found.iter().all(is_it) {
            return Err(format!("the wrong program must raise this code and nothing else, not{}", show(&checked)));
        }
        if found.iter().any(|found| found.message.is_empty()) {
            return Err("the message is empty".into());
        }
    }
    if let Some(checked) = page.right.check()?
        && !checked.diagnostics.is_empty()
    {
        return Err(format!("the right program raises{}", show(&checked)));
    }
    Ok(usize::from(page.wrong.excuse.is_some() || page.right.excuse.is_some()))
}

#[test]
fn every_code_has_a_page_and_every_page_is_true() {
    let mut problems = Vec::new();
    let mut excused = 0;
    for info in registry() {
        match problem(info, info.page) {
            Ok(count) => excused += count,
            Err(problem) => problems.push(format!("docs/diagnostics/{}.md: {problem}", info.code)),
        }
    }
    assert!(problems.is_empty(), "{} pages are wrong\n{}", problems.len(), problems.join("\n"));
    assert!(excused <= NOT_EXECUTED, "{excused} pages are not executed, {NOT_EXECUTED} may be");
}

#[test]
fn every_page_has_a_code() {
    let codes: Vec<String> = registry().iter().map(|info| format!("{}.md", info.code)).collect();
    let pages = std::fs::read_dir(folder()).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
    let strangers: Vec<String> = pages.filter(|page| !codes.contains(page)).collect();
    assert!(strangers.is_empty(), "no `problems!` declares the codes of these pages: {strangers:?}");
}

#[test]
fn no_code_is_declared_twice() {
    let twice: Vec<_> = registry().windows(2).filter(|pair| pair[0].code == pair[1].code).collect();
    assert!(twice.is_empty(), "declared twice: {twice:?}");
}

#[test]
fn pages_that_lie_are_found() {
    let info = registry().iter().find(|info| info.code.0 == 128).unwrap();
    let text = info.page;
    assert!(problem(info, text).is_ok());
    assert!(problem(info, &text.replace("int a = 3;", "int a = 3")).is_err());
    assert!(problem(info, &text.replace("int a = 3\n", "int a = 3;\n")).is_err());
    assert!(problem(info, &text.replace(info.title, "Something else")).is_err());
    assert!(problem(info, &text.replace("## Right", "## Wright")).is_err());
}
