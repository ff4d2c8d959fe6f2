//! What the checker says, beyond what the conformance corpus holds it to: codes, marked places, other places that
//! explain, help, and that one mistake is one diagnostic.
//!
//! The cases are in `checker/*.txt`. `# title` begins one, `[strict]`, `[scara]` and `[robot NAME]` in it are options;
//! the program follows, `--- name.arl` begins a further file of it. Then comes a line for each diagnostic, in order:
//!
//! ```text
//! => ARL0205 3 `Count` ;; declared twice ;; also 2 `count` first declared here ;; help another name
//! => nothing
//! ```
//!
//! The number behind the code is the line (`other.arl:3` in another file), the marked text follows in backticks; parts
//! behind it are fragments of the message, of another label, of the help. A part may be left out.

#![allow(clippy::unwrap_used, clippy::panic, reason = "a test")]

use arl2rs::diagnostics::{Diagnostic, Label, info};
use arl2rs::{CheckOptions, Checked, SourceError, Sources, check_text};
use std::collections::BTreeMap;
use std::fmt::Write;
use std::path::{Path, PathBuf};

#[derive(Default)]
struct Memory(BTreeMap<PathBuf, String>);

impl Sources for Memory {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        self.0.get(path).map(|text| text.clone().into_bytes()).ok_or(SourceError::Missing)
    }
}

#[derive(Default)]
struct Case {
    title: String,
    main: String,
    others: Memory,
    wanted: Vec<String>,
}

impl Case {
    fn check(&self) -> Checked {
        let mut options = CheckOptions { strict: self.title.contains("[strict]"), ..CheckOptions::default() };
        if self.title.contains("[scara]") {
            options.family = arl_lang::catalog::Family::Scara;
        }
        #[cfg(feature = "tools")]
        if let Some((name, _)) = self.title.split_once("[robot ").and_then(|(_, rest)| rest.split_once(']')) {
            let robot = arl_robot::Robot::builtin(name).unwrap();
            options.family = robot.family;
            options.robot = Some(robot);
        }
        check_text(Path::new("main.arl"), &self.main, &self.others, &options)
    }
}

fn read(text: &str) -> Vec<Case> {
    let mut cases: Vec<Case> = Vec::new();
    let mut file: Option<PathBuf> = None;
    for line in text.lines() {
        if let Some(title) = line.strip_prefix("# ") {
            cases.push(Case { title: title.to_string(), ..Case::default() });
            file = None;
            continue;
        }
        let Some(case) = cases.last_mut() else { continue };
        if let Some(name) = line.strip_prefix("--- ") {
            file = Some(PathBuf::from(name));
            case.others.0.insert(PathBuf::from(name), String::new());
        } else if let Some(wanted) = line.strip_prefix("=> ") {
            case.wanted.push(wanted.to_string());
        } else if case.wanted.is_empty() {
            let text = match &file {
                None => &mut case.main,
                Some(name) => case.others.0.get_mut(name).unwrap(),
            };
            text.push_str(line);
            text.push('\n');
        }
    }
    cases
}

/// Line and marked text, as the cases write them.
fn place(checked: &Checked, label: &Label) -> String {
    let file = checked.files.get(label.at.file).unwrap();
    let line = file.lines.line(label.at.span.start);
    let name = if file.name == "main.arl" { String::new() } else { format!("{}:", file.name) };
    format!("{name}{line} `{}`", label.at.span.text(&file.text).replace('\n', "\\n"))
}

/// A diagnostic as the cases write it, in full.
fn written(checked: &Checked, diagnostic: &Diagnostic) -> String {
    let mut text = format!("{} {} ;; {}", diagnostic.code, place(checked, &diagnostic.primary), diagnostic.message);
    for label in &diagnostic.labels {
        write!(text, " ;; also {} {}", place(checked, label), label.text).unwrap();
    }
    if let Some(help) = &diagnostic.help {
        write!(text, " ;; help {help}").unwrap();
    }
    text
}

fn fits(checked: &Checked, diagnostic: &Diagnostic, wanted: &str) -> bool {
    let mut parts = wanted.split(" ;; ");
    let head = parts.next().unwrap_or_default();
    let found = format!("{} {}", diagnostic.code, place(checked, &diagnostic.primary));
    let marked = head.contains('`');
    let head_fits = if marked { found == head } else { found.split(" `").next() == Some(head) };
    head_fits
        && parts.all(|part| {
            if let Some(also) = part.strip_prefix("also ") {
                let label = |label: &Label| format!("{} {}", place(checked, label), label.text).starts_with(also);
                return diagnostic.labels.iter().any(label);
            }
            match part.strip_prefix("help ") {
                Some("none") => diagnostic.help.is_none(),
                Some(help) => diagnostic.help.as_ref().is_some_and(|found| found.contains(help)),
                None => diagnostic.message.contains(part),
            }
        })
}

/// What holds for the diagnostics of every program.
fn oddity(checked: &Checked) -> Option<String> {
    for diagnostic in &checked.diagnostics {
        let code = diagnostic.code;
        match info(code) {
            None => return Some(format!("{code} is not registered")),
            Some(info) if info.severity != diagnostic.severity => {
                return Some(format!("{code} has another severity than registered"));
            }
            Some(_) => {}
        }
        for label in diagnostic.labels.iter().chain([&diagnostic.primary]) {
            let file = checked.files.get(label.at.file).unwrap();
            let (start, end) = (label.at.span.start as usize, label.at.span.end as usize);
            if file.text.get(start..end).is_none() {
                return Some(format!("{code} marks {start}..{end}, which is not in its file"));
            }
        }
    }
    let place = |diagnostic: &Diagnostic| (diagnostic.primary.at, diagnostic.code);
    if !checked.diagnostics.windows(2).all(|pair| place(&pair[0]) <= place(&pair[1])) {
        return Some("the diagnostics are not in the order of their places".into());
    }
    if checked.diagnostics.windows(2).any(|pair| pair[0] == pair[1]) {
        return Some("a diagnostic is there twice".into());
    }
    if checked.program.is_some() == checked.has_errors() {
        return Some("there is a program if and only if there is no error".into());
    }
    None
}

/// Words that nobody would write.
fn odd_words(checked: &Checked) -> Option<String> {
    let words = checked.diagnostics.iter().flat_map(|diagnostic| [Some(&diagnostic.message), diagnostic.help.as_ref()]);
    let odd = |words: &&String| {
        words.is_empty()
            || words.contains("  ")
            || words.contains("``")
            || words.contains('\n')
            || words.starts_with(' ')
    };
    words.flatten().find(odd).map(|words| format!("odd words: {words}"))
}

fn run(text: &str) {
    let mut failures = String::new();
    let mut cases = read(text);
    // Only the command knows robots.
    cases.retain(|case| cfg!(feature = "tools") || !case.title.contains("[robot "));
    assert!(cases.len() > 3, "the cases are read");
    for case in &cases {
        let checked = case.check();
        let clean = case.wanted == ["nothing"];
        let same = if clean {
            checked.diagnostics.is_empty()
        } else {
            checked.diagnostics.len() == case.wanted.len()
                && checked.diagnostics.iter().zip(&case.wanted).all(|(found, wanted)| fits(&checked, found, wanted))
        };
        let again = case.check();
        let odd = oddity(&checked).or_else(|| odd_words(&checked)).or_else(|| {
            (again.diagnostics != checked.diagnostics).then(|| "a second check finds something else".to_string())
        });
        if same && !case.wanted.is_empty() && odd.is_none() {
            continue;
        }
        writeln!(failures, "\n# {}", case.title).unwrap();
        for diagnostic in &checked.diagnostics {
            writeln!(failures, "=> {}", written(&checked, diagnostic)).unwrap();
        }
        if checked.diagnostics.is_empty() {
            writeln!(failures, "=> nothing").unwrap();
        }
        for wanted in &case.wanted {
            writeln!(failures, "   wanted {wanted}").unwrap();
        }
        if let Some(odd) = odd {
            writeln!(failures, "   {odd}").unwrap();
        }
    }
    assert!(failures.is_empty(), "{failures}");
}

/// Numbers that look random and are the same each time.
struct Random(u64);

impl Random {
    fn below(&mut self, end: usize) -> usize {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 % end.max(1) as u64) as usize
    }
}

/// The words, numbers, signs and blanks of a text.
fn pieces(text: &str) -> Vec<&str> {
    let kind = |c: char| if c.is_alphanumeric() || c == '_' || c == '$' { 1 } else { 2 + usize::from(c == '\n') };
    let mut pieces = Vec::new();
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        let same = |(_, c): &(usize, char)| kind(first) != 1 || kind(*c) != 1;
        let end = rest.char_indices().skip(1).find(same).map_or(rest.len(), |(at, _)| at);
        let (piece, behind) = rest.split_at(end);
        pieces.push(piece);
        rest = behind;
    }
    pieces
}

#[test]
fn damaged_programs_are_checked_in_peace() {
    let files = [
        include_str!("checker/names.txt"),
        include_str!("checker/types.txt"),
        include_str!("checker/constants.txt"),
        include_str!("checker/arguments.txt"),
        include_str!("checker/statements.txt"),
        include_str!("checker/modules.txt"),
        include_str!("checker/warnings.txt"),
        include_str!("checker/strict.txt"),
    ];
    let mut random = Random(0x2545_f491_4f6c_dd1d);
    let mut refused = 0;
    let mut all = 0;
    for mut case in files.iter().flat_map(|text| read(text)) {
        let whole = case.main.clone();
        let words = pieces(&whole);
        for _ in 0..12 {
            let mut damaged = words.clone();
            for _ in 0..=random.below(3) {
                if damaged.is_empty() {
                    break;
                }
                let (from, to) = (random.below(damaged.len()), random.below(damaged.len()));
                match random.below(3) {
                    0 => drop(damaged.remove(from)),
                    1 => damaged.insert(to, damaged[from]),
                    _ => damaged.swap(from, to),
                }
            }
            case.main = damaged.concat();
            let checked = case.check();
            if let Some(odd) = oddity(&checked) {
                panic!("{odd}\n{}", case.main);
            }
            all += 1;
            refused += usize::from(checked.has_errors());
        }
    }
    assert!(all > 1000 && refused > all / 2, "{refused} of {all} are refused");
}

#[test]
fn names() {
    run(include_str!("checker/names.txt"));
}

#[test]
fn types() {
    run(include_str!("checker/types.txt"));
}

#[test]
fn constants() {
    run(include_str!("checker/constants.txt"));
}

#[test]
fn arguments() {
    run(include_str!("checker/arguments.txt"));
}

#[test]
fn statements() {
    run(include_str!("checker/statements.txt"));
}

#[test]
fn modules() {
    run(include_str!("checker/modules.txt"));
}

#[test]
fn several_mistakes() {
    run(include_str!("checker/several.txt"));
}

#[test]
fn warnings() {
    run(include_str!("checker/warnings.txt"));
}

#[test]
fn words_of_other_languages() {
    run(include_str!("checker/elsewhere.txt"));
}

#[test]
fn doubts() {
    run(include_str!("checker/doubts.txt"));
}

/// What robot programmers wrote and got no help with: each message says what to write.
#[test]
fn messages() {
    run(include_str!("checker/messages.txt"));
}

/// Files as they are on disk.
struct Bytes(Vec<u8>);

impl Sources for Bytes {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        if path.ends_with("main.arl") { Ok(self.0.clone()) } else { Err(SourceError::Missing) }
    }
}

#[test]
fn lines_in_two_encodings() {
    let gbk = b"// \xbc\xd0\xd7\xa6\nfunc void main()\n".as_slice();
    let even = [gbk, "  print \"夹爪\"\nendfunc\n".as_bytes()].concat();
    let odd = [gbk, "  print \"夹爪打\"\nendfunc\n".as_bytes()].concat();
    let first = |bytes: &[u8]| {
        let checked = arl2rs::check(Path::new("main.arl"), &Bytes(bytes.to_vec()), &CheckOptions::default());
        let found: Vec<String> = checked.diagnostics.iter().map(|found| written(&checked, found)).collect();
        found.join("\n")
    };
    let (warned, refused) = (first(&even), first(&odd));
    let words = "line 3 is UTF-8, but line 1 is GBK (GB18030)";
    assert!(
        warned.starts_with("ARL0923 3 ") && warned.contains(words) && warned.contains("UTF-8, and save"),
        "{warned}"
    );
    let words = "is in two encodings: line 3 is UTF-8, line 1 is GBK";
    assert!(refused.starts_with("ARL0603 ") && refused.contains(words), "{refused}");
    assert_eq!(first(&[gbk, b"endfunc\n"].concat()), "");
}

#[test]
fn strict() {
    run(include_str!("checker/strict.txt"));
}
