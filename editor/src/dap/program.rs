//! The programs that are debugged, as the checker knows them: files, functions, the lines at which a program can be
//! halted.

use arl_lang::span::LineIndex;
use arl_lang::written;
use arl_project::cell_programs;
use arl_project::options::RunOptions;
use arl_project::program::check_options;
use arl_terminal::failure::Failure;
use arl2rs::compile::{Compiled, check_program};
use arl2rs::effects::flow;
use arl2rs::hir::{Func, Module, Program, Stmt, StmtKind, Value};
use arl2rs::sources::FileSystem;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// All programs of a run, that of the command line first.
pub struct Programs(Vec<One>);

/// A function of a program, and the lines of its statements.
pub struct Lines {
    pub file: FileKey,
    /// Where the file is.
    pub path: PathBuf,
    pub function: String,
    /// The line that the function begins at.
    pub begin: u32,
    pub lines: BTreeSet<u32>,
}

/// What identifies a running program: the folder of its files, relative to the script directory, and its main file.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Default, Debug)]
pub struct Key {
    /// The folder of its files.
    pub folder: String,
    /// Its main file.
    pub main: String,
}

/// A file of a program, as the program names it.
#[derive(Clone, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub struct FileKey {
    /// The program.
    pub program: Key,
    /// The file, by its name.
    pub file: String,
}

impl Key {
    /// The program that a message on a channel, a stack or a motion names.
    pub(super) fn of(message: &serde_json::Value) -> Self {
        let text = |key: &str| message.get(key).and_then(serde_json::Value::as_str).unwrap_or_default().to_owned();
        Self { folder: text("folder"), main: text("program") }
    }
}

/// A program, as it is checked.
struct One {
    key: Key,
    compiled: Compiled,
}

impl One {
    fn program(&self) -> Option<&Program> {
        self.compiled.checked.program.as_ref()
    }

    fn path(&self, file: &str) -> PathBuf {
        let path = self.compiled.folder.join(file);
        std::path::absolute(&path).unwrap_or(path)
    }

    fn key_of(&self, file: &str) -> FileKey {
        FileKey { program: self.key.clone(), file: file.to_owned() }
    }

    /// The modules that are this file.
    fn modules(&self, path: &Path) -> impl Iterator<Item = (usize, &Module)> {
        let modules = self.program().into_iter().flat_map(|program| program.modules.iter().enumerate());
        modules.filter(move |(_, module)| same_file(&self.compiled.folder.join(&module.file), path))
    }
}

impl Programs {
    /// Checks the programs; `report` gets the texts to be shown.
    ///
    /// # Errors
    /// A program has errors, or cannot be checked.
    pub fn check(main: &Path, options: &RunOptions, report: &dyn Fn(&str)) -> Result<Self, String> {
        let message_of = |failure: Failure| match failure {
            Failure::Usage(text) | Failure::Other(text) => text,
            Failure::Shown => String::new(),
        };
        let checking = options.checking();
        let mut all = vec![(main.to_path_buf(), checking.clone(), String::new())];
        for other in cell_programs::named(options.cell.as_deref(), checking.robot.as_deref()).map_err(message_of)? {
            all.push((other.path.clone(), other.checking(&checking), other.folder(main).map_err(message_of)?));
        }
        let mut programs = Vec::new();
        for (path, checking, folder) in all {
            let options = check_options(&checking).map_err(message_of)?;
            let compiled = check_program(&path, &FileSystem, &options).map_err(|bug| bug.to_string())?;
            let files = compiled.shown_files();
            for diagnostic in &compiled.checked.diagnostics {
                report(&(arl2rs::render::human(diagnostic, &files, false) + "\n"));
            }
            let errors = compiled.errors().count();
            if errors > 0 || compiled.checked.program.is_none() {
                let many = if errors == 1 { "one error" } else { "errors" };
                return Err(format!("{} has {many}: see the debug console", path.display()));
            }
            let first = compiled.checked.program.as_ref().and_then(|program| program.modules.first());
            let main = first.map(|module| module.file.clone()).unwrap_or_default();
            programs.push(One { key: Key { folder, main }, compiled });
        }
        Ok(Self(programs))
    }

    fn of(&self, key: &Key) -> Option<&One> {
        self.0.iter().find(|one| one.key == *key)
    }

    /// A checked program.
    pub(super) fn program(&self, key: &Key) -> Option<&Program> {
        self.of(key)?.program()
    }

    /// Where a file of a program is; `None` if the program is not known.
    pub(super) fn path(&self, key: &Key, file: &str) -> Option<PathBuf> {
        self.of(key).map(|one| one.path(file))
    }

    /// The names that running programs have for the file of an editor.
    pub(super) fn files(&self, path: &Path) -> Vec<FileKey> {
        let of_one = |one: &One| one.modules(path).map(|(_, module)| one.key_of(&module.file)).collect::<Vec<_>>();
        self.0.iter().flat_map(of_one).collect()
    }

    /// The lines of a file at which programs can be halted, function by function.
    pub(super) fn functions(&self, path: &Path) -> Vec<BTreeSet<u32>> {
        let mut found = Vec::new();
        for one in &self.0 {
            for (at, module) in one.modules(path) {
                let index = LineIndex::new(&module.source);
                let funcs = one.program().into_iter().flat_map(|program| &program.funcs);
                let own = funcs.filter(|func| func.module.0 as usize == at);
                found.extend(own.map(|func| reached_lines(&func.body, &index)));
            }
        }
        found
    }

    /// The lines at which a function can be halted.
    pub(super) fn lines_of(&self, key: &Key, file: &str, name: &str) -> BTreeSet<u32> {
        let module = |func: &Func| self.program(key)?.modules.get(func.module.0 as usize);
        let found = self.function(key, file, name).and_then(|func| Some((func, module(func)?)));
        found.map(|(func, module)| reached_lines(&func.body, &LineIndex::new(&module.source))).unwrap_or_default()
    }

    /// All functions of all files, with the lines of their statements.
    pub fn all_lines(&self) -> Vec<Lines> {
        let mut found = Vec::new();
        for one in &self.0 {
            for func in one.program().into_iter().flat_map(|program| &program.funcs) {
                let Some(module) = one.program().and_then(|program| program.modules.get(func.module.0 as usize)) else {
                    continue;
                };
                let index = LineIndex::new(&module.source);
                found.push(Lines {
                    file: one.key_of(&module.file),
                    path: one.path(&module.file),
                    function: func.name.clone(),
                    begin: index.line(func.span.start),
                    lines: lines(&func.body, &index),
                });
            }
        }
        found
    }

    /// Where the functions of this name begin.
    pub(super) fn entries(&self, name: &str) -> Vec<(FileKey, u32)> {
        let mut found = Vec::new();
        for one in &self.0 {
            let Some(program) = one.program() else { continue };
            for func in program.funcs.iter().filter(|func| func.name.eq_ignore_ascii_case(name)) {
                let Some(module) = program.modules.get(func.module.0 as usize) else { continue };
                let lines = reached_lines(&func.body, &LineIndex::new(&module.source));
                found.extend(lines.first().map(|line| (one.key_of(&module.file), *line)));
            }
        }
        found
    }

    /// The function of a frame.
    pub(super) fn function(&self, key: &Key, file: &str, name: &str) -> Option<&Func> {
        let program = self.program(key)?;
        let module = program.modules.iter().position(|module| module.file == file)?;
        program.funcs.iter().find(|func| func.name == name && func.module.0 as usize == module)
    }
}

/// The constants of a function that are known when it is compiled: names, types and literals.
pub(super) fn constants(func: &Func) -> Vec<(String, String, String)> {
    let known = |local: &arl2rs::hir::Local| {
        let value = local.value.as_ref().filter(|_| local.constant)?;
        Some((local.name.clone(), local.ty.base.name().to_owned(), text(value)))
    };
    func.locals.iter().filter_map(known).collect()
}

/// The constants of a file that are known when it is compiled.
pub(super) fn global_constants(program: &Program, file: &str) -> Vec<(String, String, String)> {
    let module = program.modules.iter().position(|module| module.file == file);
    let own = program.globals.iter().filter(|global| Some(global.module.0 as usize) == module);
    own.filter_map(|global| Some((global.name.clone(), global.ty.base.name().to_owned(), text(global.value.as_ref()?))))
        .collect()
}

/// A constant as a literal.
fn text(value: &Value) -> String {
    let mut text = String::new();
    match value {
        Value::Int(value) => text = value.to_string(),
        Value::Uint(value) => text = value.to_string(),
        Value::Byte(value) => text = value.to_string(),
        Value::Double(value) => written::double(*value, &mut text),
        Value::Bool(value) => text = value.to_string(),
        Value::String(value) => written::string(value, &mut text),
        Value::Enum(id, at) => {
            text = id.def().constants.get(usize::from(*at)).map_or_else(String::new, |it| it.name.to_owned());
        }
    }
    text
}

/// The lines of statements, including nested ones.
fn lines(block: &[Stmt], index: &LineIndex) -> BTreeSet<u32> {
    lines_of(&block.iter().collect::<Vec<_>>(), index, &lines)
}

/// The lines that can be reached.
fn reached_lines(block: &[Stmt], index: &LineIndex) -> BTreeSet<u32> {
    lines_of(&flow::reachable(block), index, &reached_lines)
}

fn lines_of(
    block: &[&Stmt],
    index: &LineIndex,
    inside: &dyn Fn(&[Stmt], &LineIndex) -> BTreeSet<u32>,
) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for stmt in block {
        if !matches!(stmt.kind, StmtKind::Label(_) | StmtKind::Let(_, None)) {
            found.insert(index.line(stmt.span.start));
        }
        match &stmt.kind {
            StmtKind::If(arms, _) => found.extend(arms.iter().map(|(condition, _)| index.line(condition.span.start))),
            StmtKind::Repeat(body, until, _) if flow::goes_round(body) => {
                found.insert(index.line(until.span.start));
            }
            _ => {}
        }
        for inner in flow::blocks(stmt) {
            found.extend(inside(inner, index));
        }
    }
    found
}

pub(super) fn same_file(one: &Path, other: &Path) -> bool {
    match (std::fs::canonicalize(one), std::fs::canonicalize(other)) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use arl_code::Op;
    use arl2rs::CheckOptions;
    use arl2rs::lower::lower_watched;

    /// The programs below a folder.
    fn programs_below(folder: &Path) -> Vec<PathBuf> {
        let mut found = Vec::new();
        for entry in std::fs::read_dir(folder).expect("the folder").flatten() {
            let path = entry.path();
            if path.is_dir() {
                found.extend(programs_below(&path));
            } else if path.extension().is_some_and(|ending| ending == "arl") {
                found.push(path);
            }
        }
        found.sort();
        found
    }

    /// A breakpoint on a line at which nothing halts would never be met.
    #[test]
    fn functions_halt_at_each_line_that_is_offered() {
        let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("../tests/conformance");
        let mut looked_at = 0;
        for path in programs_below(&corpus) {
            let mut compiled = check_program(&path, &FileSystem, &CheckOptions::default()).expect("no bug");
            let Some(program) = &mut compiled.checked.program else { continue };
            let code = lower_watched(program).expect("it is small");
            let starts: BTreeSet<u32> = code.functions.iter().map(|function| function.start).collect();
            for (func, function) in program.funcs.iter().zip(&code.functions) {
                let end = starts.range(function.start + 1..).next().map_or(code.ops.len(), |end| *end as usize);
                let ops = code.ops.get(function.start as usize..end).unwrap_or_default();
                // Functions that nothing calls have no code of their own.
                if !matches!(ops.first(), Some(Op::Open { .. })) {
                    continue;
                }
                let halts: BTreeSet<u32> =
                    ops.iter().filter_map(|op| if let Op::Halt { line } = op { Some(*line) } else { None }).collect();
                let Some(module) = program.modules.get(func.module.0 as usize) else { continue };
                for line in reached_lines(&func.body, &LineIndex::new(&module.source)) {
                    assert!(halts.contains(&line), "{}:{line}: {halts:?}", path.display());
                    looked_at += 1;
                }
            }
        }
        assert!(looked_at > 5_000, "{looked_at}");
    }
}
