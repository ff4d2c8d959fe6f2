//! What a reader would have to look up: the parameter that a bare value goes to, the unit of a number without one,
//! the name of a signal.

use super::places::File;
use super::server::{Refusal, Server};
use super::signals;
use arl_lang::catalog::Presence;
use arl_lang::lexer::{Lexeme, lexemes};
use arl2rs::index::{Argument, Callee};
use gen_lsp_types::*;

pub(super) fn hints(server: &Server, params: InlayHintParams) -> Result<Option<Vec<InlayHint>>, Refusal> {
    let find = || {
        let file = server.document(&params.text_document)?;
        let text = file.text(server)?;
        let part = text.span(params.range);
        let inside = |argument: &&Argument| part.start <= argument.at.span.end && argument.at.span.start <= part.end;
        let arguments = file.index().arguments(file.id).filter(inside);
        let mut found = Vec::new();
        for argument in arguments {
            let hint = |offset: u32, label: String, before: bool| InlayHint {
                position: text.position(offset),
                label: Label::String(label),
                kind: Some(InlayHintKind::Parameter),
                text_edits: None,
                tooltip: None,
                padding_left: None,
                padding_right: Some(before),
                data: None,
            };
            let span = argument.at.span;
            found.extend(label(&file, argument).map(|label| hint(span.start, format!("{label}:"), true)));
            if let Some((_, name)) = signals::named(&file, argument) {
                let padded = InlayHint { padding_left: Some(true), ..hint(span.end, name.to_owned(), false) };
                found.push(padded);
            }
            found.extend(unit(&file, argument).map(|unit| hint(span.end, unit.to_string(), false)));
        }
        Some(found)
    };
    Ok(find())
}

/// The name of the parameter, if the value does not name it: a literal is not a name.
fn label(file: &File, argument: &Argument) -> Option<String> {
    if argument.labelled || !is_literal(file.program.at(argument.at)) {
        return None;
    }
    match argument.callee {
        Callee::Function(id) => {
            let function = file.index().function(id)?;
            let (name, _, _) = function.params.get(argument.parameter)?;
            Some(name.clone())
        }
        // The name of a function of one parameter tells what the parameter is.
        Callee::Builtin(entry) if entry.params.len() < 2 => None,
        Callee::Builtin(entry) => {
            let param = entry.params.get(argument.parameter)?;
            let repeats = matches!(param.presence, Presence::Repeat { .. });
            (!repeats).then(|| param.name.to_string())
        }
    }
}

/// The unit of a number that is written without one.
fn unit(file: &File, argument: &Argument) -> Option<&'static str> {
    let Callee::Builtin(entry) = argument.callee else { return None };
    let unit = entry.params.get(argument.parameter)?.units.first()?;
    let bare = !argument.unit && is_number(file.program.at(argument.at));
    bare.then(|| unit.text())
}

fn is_literal(text: &str) -> bool {
    text.starts_with(['"', '{'])
        || is_number(text)
        || ["true", "false"].iter().any(|word| word.eq_ignore_ascii_case(text))
}

fn is_number(text: &str) -> bool {
    let mut all = lexemes(text.trim_start_matches('-'));
    matches!((all.next(), all.next()), (Some((Ok(Lexeme::Number(_)), _)), None))
}
