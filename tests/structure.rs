//! The structure of the crates that have folders by layer: a folder imports from those below it only. And what else
//! STYLE.md has that neither rustfmt nor clippy looks at.
//!
//! An import that has to run back up says why in a comment `// up: …` on its line or the line before.

#![allow(clippy::unwrap_used, reason = "tests may fail")]

use arl_lang::catalog;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// The folders of arl-motion, from the ground up.
const MOTION: &[&str] = &[
    "beside",
    "command",
    "geometry",
    "limits",
    "overlay",
    "plan",
    "blend",
    "follow",
    "time_optimal",
    "junction",
    "queue",
];

/// The folders of arl-rt, from the ground up.
const RUNTIME: &[&str] = &[
    "cycle",
    "fault",
    "values",
    "storage",
    "io",
    "fieldbus",
    "communication",
    "unit",
    "context",
    "builtins",
    "controller",
    "command",
    "emit",
    "fuzzing",
];

/// The files and folders of a compiled program's command line, from the ground up.
const PROGRAM_COMMAND: &[&str] = &[
    "ending",
    "json",
    "between",
    "connection",
    "asked",
    "stack",
    "interrupts",
    "observation",
    "polling",
    "report",
    "words",
    "live",
    "debug",
    "coverage",
    "options",
    "say",
    "results",
    "channel_traces",
    "set_up",
    "summary",
    "in_process",
    "serve",
    "program_main",
];

/// The files and folders of the compiler, from the ground up.
const COMPILER: &[&str] = &[
    "alarms",
    "near",
    "format",
    "sources",
    "diagnostics",
    "hir",
    "operators",
    "index",
    "visit",
    "effects",
    "check",
    "emit",
    "lower",
    "render",
    "compile",
    "build_door",
    "reference",
];

/// The files and folders of arl-terminal, from the ground up.
const TERMINAL: &[&str] = &["exit", "show", "failure", "answer", "private_folder", "interrupt", "port", "progress"];

/// The files and folders of arl-editor, from the ground up.
const EDITOR: &[&str] = &["framing", "lsp", "dap"];

/// The files and folders of arl-runs, from the ground up.
const RUNS: &[&str] = &[
    "texts", "link", "listen", "urdf", "scenery", "plot", "collide", "record", "playback", "signals", "report",
    "pendant", "view", "fuzzing",
];

/// The files and folders of arl-project, from the ground up.
const PROJECT: &[&str] = &[
    "expectations",
    "listing",
    "program_path",
    "robots",
    "options",
    "arl_toml",
    "build_failure",
    "cache",
    "runtime",
    "package",
    "cargo",
    "cell_programs",
    "code_files",
    "stamp",
    "program",
];

/// The files and folders of the command, from the ground up.
const COMMAND: &[&str] = &[
    "args",
    "parameters",
    "variables",
    "engine",
    "run",
    "collisions",
    "check",
    "clean",
    "emit",
    "explain",
    "fmt",
    "new",
    "view",
    "test",
    "sweep",
    "host",
    "main",
];

#[test]
fn folders_of_the_compiler_import_from_below_only() {
    assert_layers("transpiler/src", COMPILER);
}

#[test]
fn folders_of_the_tools_import_from_below_only() {
    assert_layers("terminal/src", TERMINAL);
    assert_layers("runs/src", RUNS);
    assert_layers("editor/src", EDITOR);
    assert_layers("project/src", PROJECT);
    assert_layers("command/src", COMMAND);
}

#[test]
fn folders_of_arl_rt_import_from_below_only() {
    assert_layers("arl-rt/src", RUNTIME);
    assert_layers_within("arl-rt/src/command", "crate::command::", PROGRAM_COMMAND);
}

#[test]
fn folders_of_arl_motion_import_from_below_only() {
    assert_layers("arl-motion/src", MOTION);
}

/// Where the compiler looks at what built-ins mean; all that it knows of one stands in its catalog entry.
const STAGES: &[&str] = &["transpiler/src/check", "transpiler/src/effects", "transpiler/src/emit"];

/// Names of built-ins that are names of something else there: of Rust functions, of a kind of name.
const OTHER_THINGS: &[&str] = &["init", "label"];

#[test]
fn the_compiler_knows_no_builtin_by_its_name() {
    let entries = catalog::all_entries().iter().flat_map(|entry| [entry.name, entry.path]);
    let known: HashSet<&str> = entries.chain(catalog::system_variables().map(|variable| variable.name)).collect();
    assert!(known.contains("waituntil") && known.contains("socket::connect") && known.contains("DFTOOL"));
    let mut faults = Vec::new();
    for folder in STAGES {
        let files = rust_files(&Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(folder));
        assert!(!files.is_empty(), "{folder} has files");
        // The words of Rust are listed in one file.
        for file in files.iter().filter(|file| !file.ends_with("emit/names.rs")) {
            let text = std::fs::read_to_string(file).unwrap();
            for (line, words) in (1..).zip(text.lines()) {
                let code = words.split("//").next().unwrap_or_default();
                let literals = code.split('"').skip(1).step_by(2);
                for name in literals.filter(|literal| known.contains(literal) && !OTHER_THINGS.contains(literal)) {
                    faults.push(format!("{}:{line}: \"{name}\" belongs into its catalog entry", file.display()));
                }
            }
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// How many columns a comment has at most: as many as rustfmt gives to code.
const MOST_COLUMNS: usize = 120;

#[test]
fn comments_are_no_wider_than_code() {
    /// Written by the compiler itself, or held to lines by what rustc says to them.
    const OTHERS: &[&str] = &["generated", "emitted", "ui", "grammar.rs"];
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut files = rust_files(&root);
    files.retain(|file| {
        let inside = file.strip_prefix(&root).unwrap();
        !inside.components().any(|part| OTHERS.iter().any(|name| part.as_os_str() == *name))
    });
    assert!(files.len() > 500, "{} files", files.len());
    let mut faults = Vec::new();
    for file in files {
        let text = std::fs::read_to_string(&file).unwrap();
        let comments = (1..).zip(text.lines()).filter(|(_, line)| line.trim_start().starts_with("//"));
        for (number, _) in comments.filter(|(_, line)| line.chars().count() > MOST_COLUMNS) {
            faults.push(format!("{}:{number}: wider than {MOST_COLUMNS} columns", file.display()));
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Crates whose types have names of their own.
const CRATES: &[&str] = &[
    "arl-lang",
    "arl-motion",
    "arl-robot",
    "arl-rt",
    "command",
    "drivers",
    "editor",
    "project",
    "runs",
    "terminal",
    "transpiler",
    "wire",
];

/// Names of two types in one crate, and why.
const TWICE: &[(&str, &str)] = &[
    // `clock` of the language, under `arl_rt::emit`; what cycles wait for.
    ("arl-rt", "Clock"),
    // What emitted programs have, and what stands for it while a program has errors.
    ("transpiler", "Globals"),
];

/// The name of the type that a line declares, where others than its own module may use it. Those of macros have none.
fn type_of_others(line: &str) -> Option<&str> {
    let line = line.trim_start().strip_prefix("pub")?;
    // Behind `pub`, or `pub(super)`.
    let rest = if line.starts_with('(') { line.split_once(')')?.1 } else { line };
    let mut words = rest.split_whitespace();
    words.next().filter(|kind| ["struct", "enum", "trait", "type", "union"].contains(kind))?;
    let name = words.next()?.split(|c: char| !c.is_alphanumeric()).next()?;
    Some(name).filter(|name| !name.is_empty())
}

#[test]
fn a_type_name_has_one_meaning_in_a_crate() {
    let mut faults = Vec::new();
    for name in CRATES {
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(name).join("src");
        let mut seen: HashMap<String, String> = HashMap::new();
        for file in rust_files(&source) {
            let inside = file.strip_prefix(&source).unwrap().to_string_lossy().into_owned();
            if inside.contains("tests") {
                continue;
            }
            let text = std::fs::read_to_string(&file).unwrap();
            let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
            for ty in text.lines().filter_map(type_of_others) {
                let other = seen.insert(ty.to_owned(), inside.clone());
                if let Some(other) = other.filter(|_| !TWICE.contains(&(*name, ty))) {
                    faults.push(format!("{name}: `{ty}` is in {other} and in {inside}"));
                }
            }
        }
        assert!(!seen.is_empty(), "{name} has types");
    }
    assert!(faults.is_empty(), "give one of the two a name that says what it is:\n{}", faults.join("\n"));
}

/// What a line names in a module, in a file that is so many levels below it: `crate::name` where `root` is `crate::`,
/// also of several in braces, and `super::name` where that leads as far.
fn imported<'a>(code: &'a str, root: &str, levels: usize) -> impl Iterator<Item = &'a str> {
    fn first_word(path: &str) -> &str {
        path.trim_start().split(|c: char| !(c.is_alphanumeric() || c == '_')).next().unwrap_or_default()
    }
    fn of_path(path: &str) -> Vec<&str> {
        match path.strip_prefix('{') {
            Some(several) => several.split(',').map(first_word).collect(),
            None => vec![first_word(path)],
        }
    }
    let by_crate = code.split(root).skip(1).flat_map(of_path);
    let up = "super::".repeat(levels);
    let chains = code.match_indices(&*up).filter(|(at, _)| !code[..*at].ends_with("super::"));
    let chains: Vec<&str> =
        chains.map(|(at, _)| &code[at + up.len()..]).filter(|rest| !rest.starts_with("super::")).collect();
    by_crate.chain(chains.into_iter().flat_map(of_path))
}

/// The imports of every file below `source` go to folders below its own; `layers` names all folders, from the ground
/// up.
fn assert_layers(source: &str, layers: &[&str]) {
    assert_layers_within(source, "crate::", layers);
}

/// As [`assert_layers`], for the folder of a module: `root` is how others name what is in it.
fn assert_layers_within(source: &str, root: &str, layers: &[&str]) {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("..").join(source);
    let files = rust_files(&source);
    assert!(files.len() >= layers.len(), "{} has files", source.display());
    let mut faults = Vec::new();
    for file in files {
        let inside = file.strip_prefix(&source).unwrap().to_string_lossy().into_owned();
        let folder = inside.split(['/', '.']).next().unwrap_or_default().to_owned();
        if ["lib", "mod", "tests"].contains(&folder.as_str()) || inside.contains("/tests") {
            continue;
        }
        let Some(own) = layers.iter().position(|layer| *layer == folder) else {
            faults.push(format!("{inside}: the folder `{folder}` is not in the list of layers"));
            continue;
        };
        // So many `super::` lead out of all folders.
        let levels = inside.matches('/').count() + usize::from(!inside.ends_with("/mod.rs"));
        let text = std::fs::read_to_string(&file).unwrap();
        // Tests at the end of a file may use whatever they need.
        let text = text.split("#[cfg(test)]\nmod tests").next().unwrap_or_default();
        let mut before = "";
        for (line, words) in (1..).zip(text.lines()) {
            let code = words.split("//").next().unwrap_or_default();
            let excused = words.contains("// up: ") || before.trim_start().starts_with("// up: ");
            for other in imported(code, root, levels).filter(|_| !excused) {
                if layers.iter().position(|layer| *layer == other).is_some_and(|other| other > own) {
                    faults.push(format!("{inside}:{line}: `{folder}` is below `{other}` and must not import from it"));
                }
            }
            before = words;
        }
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

fn rust_files(folder: &Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        // What is compiled is large, and changes while this looks.
        if path.is_dir() && !["target", "node_modules"].iter().any(|name| path.ends_with(name)) {
            files.extend(rust_files(&path));
        } else if path.extension().is_some_and(|ending| ending == "rs") {
            files.push(path);
        }
    }
    files.sort();
    files
}
