//! The programs that are debugged, as the checker knows them: files, functions, the lines that a program can be halted at.

use crate::cli::args::RunOptions;
use crate::cli::failure::Failure;
use crate::cli::program::check_options;
use crate::cli::several;
use crate::compile::{Compiled, check_program};
use crate::effects::flow;
use crate::hir::{Func, Program, Stmt, StmtKind, Value};
use crate::sources::FileSystem;
use arl_lang::span::LineIndex;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// All programs of a run, that of the command line first.
pub(super) struct Programs(Vec<Compiled>);

impl Programs {
    /// Checks them; `report` is shown what there is to say.
    ///
    /// # Errors
    /// A program has errors, or cannot be checked.
    pub(super) fn check(main: &Path, options: &RunOptions, report: &dyn Fn(&str)) -> Result<Self, String> {
        let said = |failure: Failure| match failure {
            Failure::Usage(text) | Failure::Other(text) => text,
            Failure::Shown => String::new(),
        };
        let checking = options.checking();
        let mut all = vec![(main.to_path_buf(), checking.clone())];
        for other in several::named(options.cell.as_deref(), checking.robot.as_deref()).map_err(said)? {
            all.push((other.path.clone(), other.checking(&checking)));
        }
        let mut programs = Vec::new();
        for (path, checking) in all {
            let options = check_options(&checking).map_err(said)?;
            let compiled = check_program(&path, &FileSystem, &options).map_err(|bug| bug.to_string())?;
            let files = compiled.shown_files();
            for diagnostic in &compiled.checked.diagnostics {
                report(&(crate::render::human(diagnostic, &files, false) + "\n"));
            }
            let errors = compiled.errors().count();
            if errors > 0 || compiled.checked.program.is_none() {
                let many = if errors == 1 { "one error" } else { "errors" };
                return Err(format!("{} has {many}: see the debug console", path.display()));
            }
            programs.push(compiled);
        }
        Ok(Self(programs))
    }

    /// The program whose main file has this name, as the running program says it.
    fn of(&self, name: &str) -> Option<&Compiled> {
        let main = |compiled: &&Compiled| {
            let first = compiled.checked.program.as_ref().and_then(|program| program.modules.first());
            first.is_some_and(|module| module.file == name)
        };
        self.0.iter().find(main)
    }

    /// The checked program of a channel.
    pub(super) fn program(&self, name: &str) -> Option<&Program> {
        self.of(name)?.checked.program.as_ref()
    }

    /// Where a file of a channel's program lies.
    pub(super) fn path(&self, program: &str, file: &str) -> PathBuf {
        let folder = self.of(program).map(|compiled| compiled.folder.clone()).unwrap_or_default();
        std::path::absolute(folder.join(file)).unwrap_or_else(|_| folder.join(file))
    }

    /// The names that running programs have for the file of an editor.
    pub(super) fn names(&self, path: &Path) -> Vec<String> {
        let mut names = Vec::new();
        for compiled in &self.0 {
            let modules = compiled.checked.program.iter().flat_map(|program| &program.modules);
            for module in modules {
                if same_file(&compiled.folder.join(&module.file), path) && !names.contains(&module.file) {
                    names.push(module.file.clone());
                }
            }
        }
        names
    }

    /// The lines of a file that programs can be halted at, function by function.
    pub(super) fn functions(&self, path: &Path) -> Vec<BTreeSet<u32>> {
        let mut found = Vec::new();
        for compiled in &self.0 {
            let Some(program) = &compiled.checked.program else { continue };
            for func in &program.funcs {
                let Some(module) = program.modules.get(func.module.0 as usize) else { continue };
                if same_file(&compiled.folder.join(&module.file), path) {
                    found.push(lines(&func.body, &LineIndex::new(&module.source)));
                }
            }
        }
        found
    }

    /// Where the function of this name begins: files and lines.
    pub(super) fn entries(&self, name: &str) -> Vec<(String, u32)> {
        let mut found = Vec::new();
        for program in self.0.iter().filter_map(|compiled| compiled.checked.program.as_ref()) {
            for func in program.funcs.iter().filter(|func| func.name.eq_ignore_ascii_case(name)) {
                let Some(module) = program.modules.get(func.module.0 as usize) else { continue };
                let lines = lines(&func.body, &LineIndex::new(&module.source));
                found.extend(lines.first().map(|line| (module.file.clone(), *line)));
            }
        }
        found
    }

    /// The function of a frame.
    pub(super) fn function(&self, program: &str, file: &str, name: &str) -> Option<&Func> {
        let program = self.program(program)?;
        let module = program.modules.iter().position(|module| module.file == file)?;
        program.funcs.iter().find(|func| func.name == name && func.module.0 as usize == module)
    }
}

/// The constants of a function that are known when it is compiled: names, types and literals.
pub(super) fn constants(func: &Func) -> Vec<(String, String, String)> {
    let known = |local: &crate::hir::Local| {
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
    match value {
        Value::Int(value) => value.to_string(),
        Value::Uint(value) => value.to_string(),
        Value::Byte(value) => value.to_string(),
        Value::Double(value) => value.to_string(),
        Value::Bool(value) => value.to_string(),
        Value::String(value) => format!("{value:?}"),
        Value::Enum(id, at) => {
            id.def().constants.get(usize::from(*at)).map_or_else(String::new, |it| it.name.to_owned())
        }
    }
}

/// The lines of statements, with those inside.
fn lines(block: &[Stmt], index: &LineIndex) -> BTreeSet<u32> {
    let mut found = BTreeSet::new();
    for stmt in block {
        if !matches!(stmt.kind, StmtKind::Label(_) | StmtKind::Let(_, None)) {
            found.insert(index.line(stmt.span.start));
        }
        match &stmt.kind {
            StmtKind::If(arms, _) => found.extend(arms.iter().map(|(condition, _)| index.line(condition.span.start))),
            StmtKind::Repeat(_, until, _) => _ = found.insert(index.line(until.span.start)),
            _ => {}
        }
        for inner in flow::blocks(stmt) {
            found.extend(lines(inner, index));
        }
    }
    found
}

fn same_file(one: &Path, other: &Path) -> bool {
    match (std::fs::canonicalize(one), std::fs::canonicalize(other)) {
        (Ok(one), Ok(other)) => one == other,
        _ => one == other,
    }
}
