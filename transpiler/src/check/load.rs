//! Reads the files of a program: the main file, the modules that it imports or names with `::`, and data files.

use crate::diagnostics::modules::ModuleProblem;
use crate::diagnostics::{Code, Diagnostic, FileId, Files, Fix, Label, Location, Problem, Severity};
use crate::hir::ModuleId;
use crate::{CheckOptions, SourceError, Sources};
use arl_lang::ast;
use arl_lang::catalog;
use arl_lang::files::is_data;
use arl_lang::span::Span;
use arl_lang::symbol::{Interner, Symbol};
use arl_lang::{ParseOptions, Splice, parse, parse_statements};
use std::collections::{HashMap, HashSet};
use std::path::{Component, Path, PathBuf};

/// The folder on the controller that contains the programs.
const SCRIPT_DIR: &str = "/home/ae/script/";

/// One parsed file.
pub(crate) struct LoadedModule {
    /// The module's name: the file's name without `.arl`.
    pub(crate) name: Symbol,
    pub(crate) file: FileId,
    pub(crate) path: PathBuf,
    pub(crate) ast: ast::File,
    /// Whether it is a `_data.arl` file.
    pub(crate) data: bool,
    /// Modules named by `import` lines or by `::`.
    pub(crate) imports: HashMap<Symbol, ModuleId>,
    /// Modules whose files could not be loaded; this has been reported.
    pub(crate) missing: HashSet<Symbol>,
    /// The `import` lines: their positions and the modules that they load.
    pub(crate) import_lines: Vec<(Span, ModuleId)>,
    /// The data file that belongs to the module.
    pub(crate) data_module: Option<ModuleId>,
}

/// Where a program begins.
#[derive(Clone, Copy)]
pub(crate) enum Start<'a> {
    /// In the file at the path.
    File,
    /// In this text, which replaces the file at the path.
    Text(&'a str),
    /// In these statements, which become the body of a function `fragment`.
    Statements(&'a str),
}

/// Everything that was read.
#[derive(Default)]
pub(crate) struct Loaded {
    pub(crate) modules: Vec<LoadedModule>,
    pub(crate) names: Interner,
    pub(crate) files: Files,
    pub(crate) read: Vec<PathBuf>,
    pub(crate) diagnostics: Vec<Diagnostic>,
    /// The Rust values spliced into statements.
    pub(crate) splices: Vec<Splice>,
    by_path: HashMap<PathBuf, ModuleId>,
    /// The contents of `read`.
    looked_for: HashSet<PathBuf>,
    /// The files that could not be decoded.
    broken: HashSet<PathBuf>,
}

/// Reads the program whose main file is `main`.
pub(crate) fn load(main: &Path, start: Start<'_>, sources: &dyn Sources, options: &CheckOptions) -> Loaded {
    let mut loaded = Loaded::default();
    let main = clean(main);
    let shown = main.display().to_string();
    match start {
        Start::Statements(text) => loaded.add_statements(&main, shown, text),
        Start::Text(text) => {
            loaded.add(&main, shown, text.as_bytes(), None);
        }
        Start::File => {
            loaded.looks_for(&main);
            match sources.read(&main) {
                Ok(bytes) => {
                    loaded.add(&main, shown, &bytes, None);
                }
                Err(error) => {
                    let file = loaded.files.add(shown.clone(), String::new());
                    let problem = source_problem(shown, error);
                    loaded.diagnostics.push(problem.at(Location { file, span: Span::default() }));
                }
            }
        }
    }
    let mut next = 0;
    while next < loaded.modules.len() {
        Follow { loaded: &mut loaded, sources, options, root: main.parent().unwrap_or(Path::new("")) }.module(next);
        next += 1;
    }
    loaded
}

impl Loaded {
    /// Records a file that is looked for; returns whether it is the first time.
    fn looks_for(&mut self, path: &Path) -> bool {
        let first = self.looked_for.insert(path.to_path_buf());
        if first {
            self.read.push(path.to_path_buf());
        }
        first
    }

    /// Decodes and parses a file; `None` if it cannot be decoded.
    fn add(&mut self, path: &Path, shown: String, bytes: &[u8], from: Option<Location>) -> Option<ModuleId> {
        let mixed = arl_lang::text::mixed(bytes);
        let text = match arl_lang::text::decode(bytes) {
            Ok(text) => text.into_owned(),
            Err(error) => {
                let (offset, utf16) = (error.offset, error.utf16);
                let path_shown = shown.clone();
                let problem = match mixed.filter(|_| !utf16) {
                    Some(mixed) => ModuleProblem::UnreadableMixture { path: path_shown, mixed },
                    None => ModuleProblem::Encoding { path: path_shown, offset, utf16 },
                };
                let file = self.files.add(shown, String::new());
                let at = from.unwrap_or(Location { file, span: Span::default() });
                self.diagnostics.push(problem.at(at));
                self.broken.insert(path.to_path_buf());
                return None;
            }
        };
        let parsed = parse(&text, &mut self.names, ParseOptions::default());
        let mixture = mixed.map(|mixed| (mixed, line_span(&text, mixed.utf8)));
        let file = self.files.add(shown, text);
        if let Some((mixed, span)) = mixture {
            self.diagnostics.push(ModuleProblem::Mixture { mixed }.at(Location { file, span }));
        }
        for error in &parsed.errors {
            self.diagnostics.push(syntax_diagnostic(error, file));
        }
        Some(self.push(path, file, parsed.file))
    }

    /// Adds statements as the body of a function.
    fn add_statements(&mut self, path: &Path, shown: String, text: &str) {
        let parsed = parse_statements(text, &mut self.names, ParseOptions { splices: true });
        let file = self.files.add(shown, text.to_string());
        for error in &parsed.errors {
            self.diagnostics.push(syntax_diagnostic(error, file));
        }
        self.splices = parsed.splices;
        let end = Span::new(text.len() as u32, text.len() as u32);
        let start = Span::default();
        let func = ast::Func {
            result: ast::TypeRef { name: self.names.intern("void"), system: false, span: start },
            name: ast::Ident { symbol: self.names.intern("fragment"), span: start },
            params: Vec::new(),
            body: parsed.block,
            span: start,
            end,
        };
        self.push(path, file, ast::File { items: vec![ast::Item::Func(func)] });
    }

    fn push(&mut self, path: &Path, file: FileId, ast: ast::File) -> ModuleId {
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        let id = ModuleId(self.modules.len() as u32);
        self.modules.push(LoadedModule {
            name: self.names.intern(&stem),
            file,
            path: path.to_path_buf(),
            ast,
            data: is_data(path),
            imports: HashMap::new(),
            missing: HashSet::new(),
            import_lines: Vec::new(),
            data_module: None,
        });
        self.by_path.insert(path.to_path_buf(), id);
        id
    }
}

/// The diagnostic of a syntax error.
pub(crate) fn syntax_diagnostic(error: &arl_lang::syntax_error::SyntaxError, file: FileId) -> Diagnostic {
    let place = |span| Location { file, span };
    Diagnostic {
        code: Code(error.kind.number()),
        severity: Severity::Error,
        message: error.kind.message(),
        primary: Label { at: place(error.span), text: error.kind.label() },
        labels: error.related.iter().map(|(span, text)| Label { at: place(*span), text: text.clone() }).collect(),
        help: error.kind.help(),
        fix: error.kind.fix().map(|text| Fix { at: place(error.span), text: text.into() }),
    }
}

/// The path that an `import` leads to: relative to the folder of the importing file, or to the script folder, which is
/// the main file's folder if no other is given.
pub fn imported(written: &str, folder: &Path, root: &Path, script_dir: Option<&Path>) -> PathBuf {
    match written.strip_prefix(SCRIPT_DIR) {
        Some(rest) => script_dir.unwrap_or(root).join(rest),
        None => folder.join(written),
    }
}

fn source_problem(path: String, error: SourceError) -> ModuleProblem {
    match error {
        SourceError::Missing => ModuleProblem::Missing { path },
        SourceError::Unreadable(reason) => ModuleProblem::Unreadable { path, reason },
    }
}

/// Loads the modules that one module refers to.
struct Follow<'a> {
    loaded: &'a mut Loaded,
    sources: &'a dyn Sources,
    options: &'a CheckOptions,
    /// The main file's folder; files below it are shown relative to it.
    root: &'a Path,
}

impl Follow<'_> {
    fn module(&mut self, at: usize) {
        let Some(module) = self.loaded.modules.get(at) else { return };
        let folder = module.path.parent().unwrap_or(Path::new("")).to_path_buf();
        let file = module.file;
        let (path, is_data) = (module.path.clone(), module.data);
        let imports: Vec<(String, Span, Span)> = module
            .ast
            .items
            .iter()
            .filter_map(|item| match item {
                ast::Item::Import(import) => Some((import.path.to_string(), import.span, import.path_span)),
                _ => None,
            })
            .collect();
        let scopes = match self.loaded.files.get(file) {
            Some(source) if source.text.contains("::") => super::uses::scopes(&module.ast),
            _ => Vec::new(),
        };
        if !is_data {
            let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
            let data = self.open(&folder.join(format!("{stem}_data.arl")), None);
            if let Some(module) = self.loaded.modules.get_mut(at) {
                module.data_module = data;
            }
        }
        for (written, line, span) in imports {
            self.import(at, &folder, &written, line, Location { file, span });
        }
        for scope in scopes {
            self.neighbour(at, &folder, file, scope);
        }
    }

    fn import(&mut self, at: usize, folder: &Path, written: &str, line: Span, from: Location) {
        let path = self.import_path(folder, written);
        let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
        if !is_name(&stem) {
            self.loaded.diagnostics.push(ModuleProblem::ModuleName { path: written.into() }.at(from));
            return;
        }
        let name = self.loaded.names.intern(&stem);
        let Some(id) = self.open(&path, Some((written, from))) else {
            self.set_missing(at, name);
            return;
        };
        let earlier = self.loaded.modules.get(at).and_then(|module| module.imports.get(&name)).copied();
        if let Some(earlier) = earlier.filter(|earlier| *earlier != id) {
            let first = self.loaded.modules.get(earlier.0 as usize).map(|module| module.path.display().to_string());
            let problem = ModuleProblem::SameName { name: stem, first: first.unwrap_or_default() };
            self.loaded.diagnostics.push(problem.at(from));
            return;
        }
        if let Some(module) = self.loaded.modules.get_mut(at) {
            module.imports.insert(name, id);
            module.import_lines.push((line, id));
        }
    }

    /// Loads a module named with `::` that no import has loaded: a file in the same folder.
    fn neighbour(&mut self, at: usize, folder: &Path, file: FileId, scope: ast::Ident) {
        let known =
            self.loaded.modules.get(at).is_some_and(|module| {
                module.imports.contains_key(&scope.symbol) || module.missing.contains(&scope.symbol)
            });
        if known || catalog::base_type(self.loaded.names.name(scope.symbol)).is_some() {
            return;
        }
        let source = self.loaded.files.get(file);
        let spelled = source.map(|source| scope.span.text(&source.text).to_string()).unwrap_or_default();
        let folded = self.loaded.names.name(scope.symbol).to_string();
        let shown = self.loaded.diagnostics.len();
        let path = folder.join(format!("{spelled}.arl"));
        let mut found = self.open(&path, None);
        if found.is_none() && spelled != folded {
            found = self.open(&folder.join(format!("{folded}.arl")), None);
        }
        match found {
            Some(id) => {
                if let Some(module) = self.loaded.modules.get_mut(at) {
                    module.imports.insert(scope.symbol, id);
                }
            }
            None if self.loaded.diagnostics.len() > shown || self.loaded.broken.contains(&clean(&path)) => {
                self.set_missing(at, scope.symbol)
            }
            None => {}
        }
    }

    /// Marks a module as missing, so that its other uses in this module's file are not reported again.
    fn set_missing(&mut self, at: usize, name: Symbol) {
        if let Some(module) = self.loaded.modules.get_mut(at) {
            module.missing.insert(name);
        }
    }

    fn import_path(&self, folder: &Path, written: &str) -> PathBuf {
        let mut path = imported(written, folder, self.root, self.options.script_dir.as_deref());
        if path.extension().is_none() {
            path.set_extension("arl");
        }
        clean(&path)
    }

    /// The module at `path`, read if it is new. A missing file is an error only if an `import` asks for it.
    fn open(&mut self, path: &Path, asked: Option<(&str, Location)>) -> Option<ModuleId> {
        let path = clean(path);
        if let Some(id) = self.loaded.by_path.get(&path) {
            return Some(*id);
        }
        if self.loaded.broken.contains(&path) {
            return None;
        }
        let first_look = self.loaded.looks_for(&path);
        let shown = path.strip_prefix(self.root).unwrap_or(&path).display().to_string();
        match self.sources.read(&path) {
            Ok(bytes) => self.loaded.add(&path, shown, &bytes, asked.map(|(_, at)| at)),
            Err(error) => {
                let silent = asked.is_none() && error == SourceError::Missing;
                if !silent {
                    let (written, at) = match asked {
                        Some((written, at)) => (written.to_string(), at),
                        None if !first_look => return None,
                        None => {
                            let file = self.loaded.files.add(shown.clone(), String::new());
                            (shown, Location { file, span: Span::default() })
                        }
                    };
                    self.loaded.diagnostics.push(source_problem(written, error).at(at));
                }
                None
            }
        }
    }
}

/// Whether a file name can be used before `::`.
fn is_name(stem: &str) -> bool {
    let mut chars = stem.chars();
    let first = chars.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '_');
    first && chars.all(|other| other.is_ascii_alphanumeric() || other == '_')
}

/// The path without `.` and inner `..`, so that each file has only one path.
pub fn clean(path: &Path) -> PathBuf {
    let mut out = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if matches!(out.components().next_back(), Some(Component::Normal(_))) => {
                out.pop();
            }
            other => out.push(other),
        }
    }
    out
}

/// The span of a line of a text; lines count from 1.
fn line_span(text: &str, number: usize) -> Span {
    let line = text.split('\n').nth(number.saturating_sub(1)).unwrap_or_default();
    let start = line.as_ptr() as usize - text.as_ptr() as usize;
    let end = start + line.trim_end().len();
    Span::new(start as u32, end as u32)
}
