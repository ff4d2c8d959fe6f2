//! The work common to all front ends: checks one program and, if it is correct, turns it into Rust.

use crate::diagnostics::{Diagnostic, FileId, Files, Severity};
use crate::effects::facts::{self, FactScope};
use crate::effects::{captures, ranges::Ranges};
use crate::emit::{EmitOptions, emit};
use crate::hir::{Expr, ExprKind, Program, Type};
use crate::visit::exprs_in_stmt;
use crate::{CheckOptions, Checked, SourceError, Sources, check};
use std::cell::RefCell;
use std::panic::AssertUnwindSafe;
use std::path::{Path, PathBuf};

/// A program between text and Rust.
#[derive(Debug)]
pub struct Compiled {
    /// The folder of the main file, to which the names in `files` are relative.
    pub folder: PathBuf,
    /// The result of the check.
    pub checked: Checked,
    /// The Rust code, if there was no error.
    pub rust: Option<String>,
}

impl Compiled {
    /// The errors.
    pub fn errors(&self) -> impl Iterator<Item = &Diagnostic> {
        self.checked.diagnostics.iter().filter(|diagnostic| diagnostic.severity == Severity::Error)
    }

    /// The files that were read or looked for, as paths relative to the working directory.
    pub fn read(&self) -> impl Iterator<Item = PathBuf> + '_ {
        self.checked.read.iter().map(|path| self.folder.join(path))
    }

    /// The files with names relative to the working directory, as messages show them.
    pub fn shown_files(&self) -> Files {
        shown_files(&self.checked.files, &self.folder)
    }
}

fn shown_files(files: &Files, folder: &Path) -> Files {
    let mut shown = Files::default();
    for (_, file) in files.iter() {
        shown.add(folder.join(&file.name).display().to_string(), file.text.clone());
    }
    shown
}

/// Sources whose relative paths start at a folder.
struct Below<'a> {
    folder: &'a Path,
    sources: &'a dyn Sources,
}

impl Sources for Below<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        self.sources.read(&self.folder.join(path))
    }
}

/// Checks the program whose main file is `main`. The emitted code does not depend on the folder of that file.
///
/// # Errors
/// The position and text of a panic inside the compiler.
pub fn check_program(main: &Path, sources: &dyn Sources, options: &CheckOptions) -> Result<Compiled, Bug> {
    let folder = main.parent().map(Path::to_path_buf).unwrap_or_default();
    let name = main.file_name().map_or_else(|| main.to_path_buf(), PathBuf::from);
    let checked = guard(|| check(&name, &Below { folder: &folder, sources }, options))?;
    Ok(Compiled { folder, checked, rust: None })
}

/// Checks a program and emits it if it is correct.
///
/// # Errors
/// The position and text of a panic inside the compiler.
pub fn compile_program(
    main: &Path,
    sources: &dyn Sources,
    options: &CheckOptions,
    emit_options: &EmitOptions,
) -> Result<Compiled, Bug> {
    let mut compiled = check_program(main, sources, options)?;
    if let Some(program) = &compiled.checked.program {
        compiled.rust = Some(guard(|| emit(program, emit_options))?);
    }
    Ok(compiled)
}

/// The types of the Rust values spliced into statements (see [`crate::check_statements`]), by their numbers; `None` for
/// a value that is not used.
pub fn spliced_types(program: &Program, count: usize) -> Vec<Option<Type>> {
    let mut types = vec![None; count];
    let mut see = |expr: &Expr| {
        if let ExprKind::Splice(number) = expr.kind
            && let Some(ty) = types.get_mut(number as usize)
        {
            *ty = Some(expr.ty);
        }
    };
    for stmt in program.funcs.iter().flat_map(|func| &func.body) {
        exprs_in_stmt(stmt, &mut see);
    }
    types
}

/// Whether the Rust code has global variables, too: constants with a known value are written out where they are used. A
/// program with global variables and without `main` has `Globals::init`.
pub fn has_variables(program: &Program) -> bool {
    program.globals.iter().any(|global| global.value.is_none())
}

/// Whether global variables are used in the condition or action of an interrupt, timer or trigger that is declared by
/// the function of this name, by the initial value of a variable, or by a function that they call.
pub fn events_use_globals(program: &Program, function: &str) -> bool {
    let ranges = Ranges::default();
    let outside = FactScope { program, func: None, ranges: &ranges };
    let inits = program.globals.iter().filter_map(|global| global.init.as_ref());
    let called = inits.flat_map(|init| facts::of_expr(outside, init).calls).map(|callee| callee.0 as usize);
    let start = program.funcs.iter().position(|func| func.name == function);
    let (mut open, mut seen): (Vec<usize>, _) = (called.chain(start).collect(), vec![false; program.funcs.len()]);
    while let Some(at) = open.pop() {
        let (Some(func), Some(seen)) = (program.funcs.get(at), seen.get_mut(at)) else { continue };
        if std::mem::replace(seen, true) {
            continue;
        }
        let scope = FactScope { func: Some(func), ..outside };
        let mut found = false;
        let mut see = |expr: &Expr| {
            if let ExprKind::Builtin(builtin) = &expr.kind {
                found |= captures::later(builtin).any(|later| facts::of_expr(scope, later).globals);
            }
        };
        func.body.iter().for_each(|stmt| exprs_in_stmt(stmt, &mut see));
        if found {
            return true;
        }
        let facts = facts::of_function(program, func);
        open.extend(facts.calls.iter().chain(&facts.later_calls).map(|callee| callee.0 as usize));
    }
    false
}

/// A panic inside the compiler.
#[derive(Clone, PartialEq, Eq, Debug)]
pub struct Bug {
    /// The panic message.
    pub message: String,
    /// `file:line` in the compiler's source, if known.
    pub place: Option<String>,
}

impl std::fmt::Display for Bug {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "bug in arl2rs {}: {}", env!("CARGO_PKG_VERSION"), self.message)?;
        if let Some(place) = &self.place {
            write!(f, " (at {place})")?;
        }
        write!(f, "; please report it together with the program")
    }
}

impl std::error::Error for Bug {}

thread_local! {
    static LAST_PANIC: RefCell<Option<String>> = const { RefCell::new(None) };
}

/// Silences panics and remembers where they happened, so that a [`Bug`] can report it. Only for our own programs: it
/// changes the panic hook of the whole process.
pub fn remember_panics() {
    std::panic::set_hook(Box::new(|info| {
        let place = info.location().map(|at| format!("{}:{}", at.file(), at.line()));
        LAST_PANIC.with(|last| last.replace(place));
    }));
}

/// Runs a part of the compiler; a panic in it becomes a [`Bug`].
///
/// # Errors
/// The position and text of the panic.
pub fn guard<T>(work: impl FnOnce() -> T) -> Result<T, Bug> {
    LAST_PANIC.with(|last| last.take());
    std::panic::catch_unwind(AssertUnwindSafe(work)).map_err(|payload| {
        let text = payload.downcast_ref::<&str>().map(ToString::to_string);
        let message = text.or_else(|| payload.downcast_ref::<String>().cloned()).unwrap_or_else(|| "panic".into());
        Bug { message, place: LAST_PANIC.with(|last| last.take()) }
    })
}

/// Stack size for the compiler, in bytes: enough for the deepest nesting that ARL allows, also without optimisation and
/// on systems that give programs a small stack.
const STACK: usize = 64 << 20;

/// Runs a part of the compiler on a stack that is large enough for the deepest nesting that ARL allows.
pub fn on_large_stack<T: Send>(work: impl FnOnce() -> T + Send) -> T {
    let work = std::sync::Mutex::new(Some(work));
    let run = || work.lock().ok().and_then(|mut work| work.take()).map(|work| work());
    let done = std::thread::scope(|scope| {
        let thread = std::thread::Builder::new().stack_size(STACK).spawn_scoped(scope, run);
        thread.ok().map(|thread| thread.join())
    });
    match done {
        Some(Ok(Some(done))) => done,
        Some(Err(panic)) => std::panic::resume_unwind(panic),
        // The thread could not be started, so the work has not been taken yet and runs on this thread.
        _ => run().unwrap_or_else(|| std::process::abort()),
    }
}

/// The name of a file as messages show it.
pub fn shown_name(files: &Files, file: FileId) -> &str {
    files.get(file).map_or("?", |file| file.name.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panics_become_bugs_with_their_text() {
        let bug = guard(|| panic!("no {}", 5)).map(|(): ()| ()).unwrap_err();
        assert_eq!(bug.message, "no 5");
        assert!(bug.to_string().contains("please report"));
        assert_eq!(guard(|| 3), Ok(3));
    }

    #[test]
    fn shown_names_count_from_the_working_directory() {
        let mut files = Files::default();
        files.add("pick.arl".into(), String::new());
        let shown = shown_files(&files, Path::new("robot"));
        assert_eq!(shown_name(&shown, FileId(0)), Path::new("robot").join("pick.arl").display().to_string());
    }
}
