//! What a meaning is, in Markdown: the declaration, the comment above it, the reference of built-ins.

use super::frame::frames;
use super::programs::Program;
use arl_lang::catalog::{Family, reference};
use arl_lang::lexer::{Lexeme, lexemes};
use arl_lang::span::Span;
use arl2rs::check::base_name;
use arl2rs::diagnostics::Location;
use arl2rs::hir::{Type, Value};
use arl2rs::index::Meaning;
use arl2rs::reference::page;

/// The page of a meaning.
pub(super) fn describe(program: &Program, meaning: Meaning, family: Family) -> Option<String> {
    let index = program.index();
    match meaning {
        Meaning::Local(at) => {
            let info = index.local(at)?;
            let name = program.at(at);
            let kind = if is_parameter(program, at) { "parameter" } else { "local variable" };
            let text = variable(program, at, &head(info.constant, info.ty, name, family), info.value.as_ref(), kind);
            Some(joined([text, frames(program, meaning)]))
        }
        Meaning::Global(id) => {
            let global = index.global(id)?;
            let head = head(global.constant, global.ty, &global.name, family);
            let text = match (&global.value, initialiser(program, global.at)) {
                (None, Some(value)) if !global.constant => format!("{head} = {value}"),
                _ => head,
            };
            let module = index.module(global.module)?;
            let kind = format!("global variable of `{}`", module.name);
            let text = variable(program, global.at, &text, global.value.as_ref(), &kind);
            Some(joined([text, frames(program, meaning)]))
        }
        Meaning::Function(id) => {
            let function = index.function(id)?;
            let header = Location { file: function.at.file, span: function.header };
            Some(joined([code(program.at(header).trim()), comment_above(program, function.at)]))
        }
        Meaning::Module(id) => {
            let module = index.module(id)?;
            let start = Location { file: module.file, span: Span::default() };
            let path = program.path(module.file).map(|path| path.display().to_string()).unwrap_or_default();
            Some(joined([format!("module `{}`: {path}", module.name), comment_at_start(program, start)]))
        }
        Meaning::Label(at) => Some(code(&format!("{}:", program.at(at)))),
        Meaning::Builtin(entry) => Some(reference::entry(entry)),
        Meaning::Parameter(entry, at) => Some(reference::parameter(entry, entry.params.get(at)?)),
        Meaning::System(variable) => Some(reference::system_variable(variable)),
        Meaning::Constant(constant) => Some(reference::constant(constant)),
        Meaning::EnumConstant(id, number) => {
            let constant = id.def().constants.get(number as usize)?;
            let head = code(&format!("{}::{} = {number}", id.def().name, constant.name));
            Some(joined([head, constant.doc.to_string()]))
        }
        Meaning::Component(id, at) => {
            let def = id.def(family);
            let component = def.components.get(at)?;
            let head = code(&format!("{} {}.{}", component.ty.name(), def.name, component.name));
            Some(joined([head, component.doc.to_string()]))
        }
        Meaning::Type(base) => page(base.name()),
        Meaning::Number(number) => Some(code(&format!("{} = {number:x}h", number as i32))),
    }
}

fn is_parameter(program: &Program, at: Location) -> bool {
    program.index().local(at).is_some_and(|info| info.parameter)
}

/// `const int ROWS`
fn head(constant: bool, ty: Option<Type>, name: &str, family: Family) -> String {
    let constant = if constant { "const " } else { "" };
    match ty {
        Some(ty) => {
            let sizes: String = ty.dims().iter().map(|size| format!("[{size}]")).collect();
            format!("{constant}{} {name}{sizes}", base_name(ty.base, family))
        }
        None => format!("{constant}{name}"),
    }
}

fn variable(program: &Program, at: Location, head: &str, value: Option<&Value>, kind: &str) -> String {
    let text = match value {
        Some(value) => format!("{head} = {}", value_text(value)),
        None => head.to_string(),
    };
    let comment = match comment_behind(program, at) {
        _ if is_parameter(program, at) => String::new(),
        Some(comment) => comment,
        None => comment_above(program, at),
    };
    joined([code(&text), kind.to_string(), comment])
}

/// A constant's value as ARL writes it.
pub(super) fn value_text(value: &Value) -> String {
    match value {
        Value::Int(number) => number.to_string(),
        Value::Uint(number) => number.to_string(),
        Value::Byte(number) => number.to_string(),
        Value::Double(number) => number.to_string(),
        Value::Bool(value) => value.to_string(),
        Value::String(text) => format!("\"{}\"", text.escape_debug()),
        Value::Enum(id, index) => {
            id.def().constants.get(*index as usize).map_or_else(|| index.to_string(), |constant| constant.name.into())
        }
    }
}

/// The text after the name of a declaration on its line: code, and a comment.
fn behind(program: &Program, at: Location) -> Option<(&str, &str)> {
    let file = program.checked.files.get(at.file)?;
    let line = file.lines.line_span(&file.text, file.lines.line(at.span.start))?;
    let text = Span::new(at.span.end, line.end).text(&file.text).trim_end();
    let code = lexemes(text).filter(|(lexeme, _)| *lexeme != Ok(Lexeme::Newline)).last();
    text.split_at_checked(code.map_or(0, |(_, span)| span.end as usize))
}

/// The value after the `=` of a declaration, if it is on one line.
fn initialiser(program: &Program, at: Location) -> Option<String> {
    let (code, _) = behind(program, at)?;
    let value = code.trim_start().strip_prefix('=')?.trim();
    (!value.is_empty() && value.len() <= 200).then(|| value.to_string())
}

/// The comment after a declaration on its line.
fn comment_behind(program: &Program, at: Location) -> Option<String> {
    let (_, comment) = behind(program, at)?;
    let comment = comment.trim_start().strip_prefix("//")?.trim();
    (!comment.is_empty()).then(|| comment.to_string())
}

/// The `//` lines directly above a declaration.
pub(super) fn comment_above(program: &Program, at: Location) -> String {
    let Some(file) = program.checked.files.get(at.file) else { return String::new() };
    let line_text = |line: u32| file.lines.line_span(&file.text, line).map(|span| span.text(&file.text).trim());
    let mut lines = Vec::new();
    let mut line = file.lines.line(at.span.start);
    while let Some(comment) = line.checked_sub(1).and_then(line_text).and_then(|text| text.strip_prefix("//")) {
        lines.push(comment.strip_prefix(' ').unwrap_or(comment));
        line -= 1;
    }
    lines.reverse();
    lines.join("\n").trim().to_string()
}

/// The `//` lines that a file begins with.
fn comment_at_start(program: &Program, at: Location) -> String {
    let Some(file) = program.checked.files.get(at.file) else { return String::new() };
    let lines = file.text.lines().map_while(|line| line.trim().strip_prefix("//"));
    lines.map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n").trim().to_string()
}

fn code(text: &str) -> String {
    format!("```arl\n{text}\n```")
}

/// The parts that are not empty, as paragraphs.
fn joined<const N: usize>(parts: [String; N]) -> String {
    let there: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    there.join("\n\n")
}
