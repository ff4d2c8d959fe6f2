//! Renames something that the program declares.
//!
//! The new text is checked before anything is changed: every name of every program has to keep its meaning.

use super::navigation::uses_of;
use super::places::{Declared, FilePlace};
use super::programs::Program;
use super::server::{Refusal, Server};
use arl_lang::lexer::{Lexeme, lexemes};
use arl_lang::span::Span;
use arl2rs::check::clean;
use arl2rs::diagnostics::Location;
use arl2rs::index::{Meaning, Mention};
use arl2rs::{SourceError, Sources};
use gen_lsp_types::*;
use std::collections::{BTreeMap, HashMap};
use std::path::{Path, PathBuf};
use std::rc::Rc;

pub(super) fn prepare(server: &Server, params: PrepareRenameParams) -> Result<Option<PrepareRenameResult>, Refusal> {
    let Some(place) = server.place(&params.text_document_position_params) else { return Ok(None) };
    let Some(mention) = place.mention() else { return Ok(None) };
    renamable(&place.file.program, mention)?;
    let Some(text) = place.file.text(server) else { return Ok(None) };
    let placeholder = place.file.program.at(mention.at).to_string();
    let range = text.range(mention.at.span);
    Ok(Some(PrepareRenameResult::PrepareRenamePlaceholder(PrepareRenamePlaceholder { range, placeholder })))
}

/// Whether a name is the program's own.
fn renamable(program: &Program, mention: &Mention) -> Result<(), Refusal> {
    let name = program.at(mention.at);
    match mention.meaning {
        Meaning::Module(_) => Err(Refusal::new("a module has the name of its file: rename the file")),
        Meaning::Function(id) if is_main(program, id) => {
            Err(Refusal::new("a program begins with `main`: it cannot have another name"))
        }
        meaning if meaning.is_own() => Ok(()),
        _ => Err(Refusal::new(format!("`{name}` is part of the language"))),
    }
}

fn is_main(program: &Program, id: arl2rs::hir::FuncId) -> bool {
    program.index().function(id).is_some_and(|function| function.name.eq_ignore_ascii_case("main"))
}

pub(super) fn rename(server: &Server, params: RenameParams) -> Result<Option<WorkspaceEdit>, Refusal> {
    let at = &params.text_document_position_params;
    let Some(place) = server.place(at) else { return Ok(None) };
    let Some(mention) = place.mention() else {
        return Err(Refusal::new("there is no name here that can be renamed"));
    };
    renamable(&place.file.program, mention)?;
    let name = params.new_name.trim();
    may_be_a_name(name)?;
    let uses = uses_of(server, &at.text_document.uri, at.position);
    for program in programs(&uses) {
        is_known_everywhere(&place, &program)?;
    }
    let edited = Edited::new(server, &uses, name);
    for program in programs(&uses) {
        edited.means_the_same(server, &program, name)?;
    }
    Ok(Some(edits(server, &uses, name)))
}

/// Refuses if the old name occurs where the checker did not get to, after a mistake: whether it means the same there is
/// not known.
fn is_known_everywhere(place: &FilePlace, program: &Program) -> Result<(), Refusal> {
    let Some(mention) = place.mention() else { return Ok(()) };
    let (old, own) = (place.file.program.at(mention.at), place.file.index());
    if !program.checked.has_errors() {
        return Ok(());
    }
    // A local name is known in its function only; a parameter is a label of calls, too.
    let is_parameter = |at| own.local(at).is_some_and(|info| info.parameter);
    let local = match mention.meaning {
        Meaning::Local(at) | Meaning::Label(at) if !is_parameter(at) => {
            own.function_at(at.file, at.span.start).and_then(|id| own.function(id))
        }
        _ => None,
    };
    let home = local.and_then(|function| place.file.program.path(function.at.file).map(|path| (path, function.span())));
    for ((id, file), path) in program.checked.files.iter().filter_map(|one| Some((one, program.path(one.0)?))) {
        let inside =
            |at: Span| home.is_none_or(|(home, span)| home == path && span.start <= at.start && at.end <= span.end);
        let named = lexemes(&file.text).filter(|(lexeme, at)| {
            *lexeme == Ok(Lexeme::Word) && at.text(&file.text).eq_ignore_ascii_case(old) && inside(*at)
        });
        for (_, at) in named {
            if program.index().at(id, at.start).is_none_or(|mention| mention.at.span != at) {
                let line = file.lines.line(at.start);
                let text = format!("{}, line {line} has a mistake: what `{old}` means there is not known", file.name);
                return Err(Refusal::new(text));
            }
        }
    }
    Ok(())
}

/// Whether the language accepts a word as a name.
fn may_be_a_name(name: &str) -> Result<(), Refusal> {
    let mut characters = name.chars();
    let begins_well = characters.next().is_some_and(|first| first.is_ascii_alphabetic() || first == '_');
    if !begins_well || !characters.all(|one| one.is_ascii_alphanumeric() || one == '_') {
        let text =
            format!("`{name}` is not a name: a name has letters, digits and `_`, and does not begin with a digit");
        return Err(Refusal::new(text));
    }
    if arl_lang::is_reserved(name) {
        return Err(Refusal::new(format!("`{name}` is a word of the language")));
    }
    Ok(())
}

/// Each program once.
fn programs(uses: &[(Rc<Program>, Mention)]) -> Vec<Rc<Program>> {
    let mut all: Vec<Rc<Program>> = Vec::new();
    for (program, _) in uses {
        if !all.iter().any(|known| Rc::ptr_eq(known, program)) {
            all.push(program.clone());
        }
    }
    all
}

fn edits(server: &Server, uses: &[(Rc<Program>, Mention)], name: &str) -> WorkspaceEdit {
    let mut changes: HashMap<Uri, Vec<TextEdit>> = HashMap::new();
    for (program, mention) in uses {
        let Some(location) = server.location(program, mention.at) else { continue };
        let edit = TextEdit { range: location.range, new_text: name.to_string() };
        changes.entry(location.uri).or_default().push(edit);
    }
    WorkspaceEdit { changes: Some(changes), ..WorkspaceEdit::default() }
}

/// The sources as they will be after the change.
struct Edited<'a> {
    server: &'a Server,
    texts: BTreeMap<PathBuf, String>,
}

impl<'a> Edited<'a> {
    fn new(server: &'a Server, uses: &[(Rc<Program>, Mention)], name: &str) -> Self {
        let mut spans: BTreeMap<PathBuf, (String, Vec<Span>)> = BTreeMap::new();
        for (program, mention) in uses {
            let Some(path) = program.path(mention.at.file) else { continue };
            let Some(file) = program.checked.files.get(mention.at.file) else { continue };
            let entry = spans.entry(path.to_path_buf()).or_insert_with(|| (file.text.clone(), Vec::new()));
            entry.1.push(mention.at.span);
        }
        let texts = spans.into_iter().map(|(path, (mut text, mut spans))| {
            spans.sort();
            spans.iter().rev().for_each(|span| text.replace_range(span.start as usize..span.end as usize, name));
            (path, text)
        });
        Self { server, texts: texts.collect() }
    }

    /// Refuses the name if any name of a program would change its meaning, or an error would result.
    fn means_the_same(&self, server: &Server, program: &Program, name: &str) -> Result<(), Refusal> {
        let Some(root) = program.path(arl2rs::diagnostics::FileId(0)) else { return Ok(()) };
        let Ok(after) = Program::check(root, self, &server.options_of(root)) else {
            return Err(Refusal::new("the program with the new name could not be checked"));
        };
        let clash = |path: &Path, line: u32| {
            let place = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let text = format!("`{name}` already has a meaning: {place}, line {line} would change its meaning");
            Err(Refusal::new(text))
        };
        for ((file, source), number) in program.checked.files.iter().zip(0..) {
            let (old, new) = (program.index().of_file(file), after.index().of_file(file));
            let differs = |(old, new): (&Mention, &Mention)| Target::of(program, old) != Target::of(&after, new);
            let first = old.iter().zip(new).position(differs);
            let first = first.or((old.len() != new.len()).then(|| old.len().min(new.len())));
            if let (Some(first), Some(path)) = (first, program.path(arl2rs::diagnostics::FileId(number))) {
                let place = old.get(first).or(old.last()).map_or(0, |mention| mention.at.span.start);
                return clash(path, source.lines.line(place));
            }
        }
        let errors = |program: &Program| {
            let all = program.checked.diagnostics.iter();
            all.filter(|one| one.severity == arl2rs::diagnostics::Severity::Error).count()
        };
        if errors(&after) > errors(program) {
            let known = |at: Location| after.checked.files.line(at);
            let new = after.checked.diagnostics.iter().find(|one| one.message.contains(&format!("`{name}`")));
            let detail =
                new.map_or_else(String::new, |one| format!(" (line {}: {})", known(one.primary.at), one.message));
            return Err(Refusal::new(format!("`{name}` would cause an error{detail}")));
        }
        Ok(())
    }
}

impl Sources for Edited<'_> {
    fn read(&self, path: &Path) -> Result<Vec<u8>, SourceError> {
        match self.texts.get(&clean(path)) {
            Some(text) => Ok(text.clone().into_bytes()),
            None => self.server.documents.read(path),
        }
    }
}

/// The meaning of a name in a form that can be compared after texts moved: by the number of the declaring name in its
/// file.
#[derive(PartialEq)]
enum Target {
    Own(PathBuf, usize),
    BuiltIn(Meaning),
}

impl Target {
    fn of(program: &Program, mention: &Mention) -> Option<Self> {
        let Some(at) = program.index().declaration(mention.meaning) else {
            return Some(Self::BuiltIn(mention.meaning));
        };
        let declared = Declared::new(program, at)?;
        let all = program.index().of_file(at.file);
        Some(Self::Own(declared.path, all.partition_point(|mention| mention.at.span.start < at.span.start)))
    }
}
