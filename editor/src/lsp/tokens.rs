//! What kind of thing each name is, for colours. Words, numbers, texts and comments are left to the editor's grammar.

use super::places::File;
use super::server::{Refusal, Server};
use arl_lang::catalog::{Access, Kind};
use arl_lang::span::Span;
use arl2rs::index::{Meaning, Mention, Role};
use gen_lsp_types::*;

/// The kinds, in the order of their numbers.
const KINDS: [&str; 9] =
    ["variable", "parameter", "function", "namespace", "type", "enumMember", "property", "label", "keyword"];

/// Further properties, in the order of the bits.
const MODIFIERS: [&str; 4] = ["declaration", "readonly", "defaultLibrary", "modification"];
const DECLARATION: u32 = 1;
const READONLY: u32 = 2;
const BUILT_IN: u32 = 4;
const MODIFICATION: u32 = 8;

pub(super) fn offered() -> SemanticTokensOptions {
    let names = |names: &[&str]| names.iter().map(ToString::to_string).collect();
    SemanticTokensOptions {
        legend: SemanticTokensLegend { token_types: names(&KINDS), token_modifiers: names(&MODIFIERS) },
        range: Some(SemanticTokensOptionsRange::Bool(true)),
        full: Some(Full::Bool(true)),
        ..SemanticTokensOptions::default()
    }
}

pub(super) fn full(server: &Server, params: SemanticTokensParams) -> Result<Option<SemanticTokens>, Refusal> {
    Ok(server.document(&params.text_document).and_then(|file| tokens(server, &file, None)))
}

pub(super) fn range(server: &Server, params: SemanticTokensRangeParams) -> Result<Option<SemanticTokens>, Refusal> {
    let find = || {
        let file = server.document(&params.text_document)?;
        let span = file.text(server)?.span(params.range);
        tokens(server, &file, Some(span))
    };
    Ok(find())
}

/// The names of a file, or of a part of it, each relative to the one before.
fn tokens(server: &Server, file: &File, part: Option<Span>) -> Option<SemanticTokens> {
    let text = file.text(server)?;
    let mut data = Vec::new();
    let mut last = Position { line: 0, character: 0 };
    for mention in file.index().of_file(file.id) {
        let span = mention.at.span;
        if part.is_some_and(|part| span.end < part.start || part.end < span.start) {
            continue;
        }
        let Some((kind, modifiers)) = kind(file, mention) else { continue };
        let start = text.position(span.start);
        let same_line = start.line == last.line;
        data.push(SemanticToken {
            delta_line: start.line - last.line,
            delta_start: if same_line { start.character - last.character } else { start.character },
            length: server.encoding.length(span.text(text.text)),
            token_type: kind,
            token_modifiers_bitset: modifiers,
        });
        last = start;
    }
    Some(SemanticTokens { result_id: None, data })
}

/// The number of the kind, and the modifiers. `None` for what a grammar colours as well.
fn kind(file: &File, mention: &Mention) -> Option<(u32, u32)> {
    let index = file.index();
    let readonly = |constant: bool| if constant { READONLY } else { 0 };
    let (kind, mut modifiers) = match mention.meaning {
        Meaning::Local(at) => {
            let info = index.local(at);
            let constant = info.is_some_and(|info| info.constant);
            (if info.is_some_and(|info| info.parameter) { "parameter" } else { "variable" }, readonly(constant))
        }
        Meaning::Global(id) => ("variable", readonly(index.global(id).is_some_and(|global| global.constant))),
        Meaning::Function(_) => ("function", 0),
        Meaning::Module(_) if file.program.at(mention.at).starts_with('"') => return None,
        Meaning::Module(_) => ("namespace", 0),
        Meaning::Label(_) => ("label", 0),
        Meaning::Builtin(entry) if entry.kind == Kind::Instruction => ("keyword", BUILT_IN),
        Meaning::Builtin(_) => ("function", BUILT_IN),
        Meaning::Parameter(..) => ("property", BUILT_IN),
        Meaning::System(variable) => ("variable", BUILT_IN | readonly(variable.access == Access::ReadOnly)),
        Meaning::Constant(_) => ("variable", BUILT_IN | READONLY),
        Meaning::EnumConstant(..) => ("enumMember", BUILT_IN | READONLY),
        Meaning::Component(..) => ("property", 0),
        Meaning::Type(_) => ("type", BUILT_IN),
        Meaning::Number(_) => return None,
    };
    modifiers |= match mention.role {
        Role::Declares => DECLARATION,
        Role::Writes => MODIFICATION,
        Role::Uses => 0,
    };
    let number = KINDS.iter().position(|known| *known == kind)?;
    Some((number as u32, modifiers))
}
