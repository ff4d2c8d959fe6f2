//! What the name under the cursor is.

use super::describe::describe;
use super::places::FilePlace;
use super::server::{Refusal, Server};
use super::signals;
use arl_lang::lexer::{Lexeme, lexemes};
use arl_lang::span::Span;
use arl2rs::reference::Topic;
use gen_lsp_types::*;

pub(super) fn hover(server: &Server, params: HoverParams) -> Result<Option<Hover>, Refusal> {
    Ok(find(server, &params.text_document_position_params))
}

fn find(server: &Server, at: &TextDocumentPositionParams) -> Option<Hover> {
    let place = server.place(at)?;
    let text = place.file.text(server)?;
    let (value, span) = match place.mention() {
        Some(mention) => (describe(&place.file.program, mention.meaning, place.file.program.family)?, mention.at.span),
        None => keyword(text.text, place.offset).or_else(|| signal(&place))?,
    };
    let range = text.range(span);
    let contents = Contents::MarkupContent(server.formats.hover.content(value));
    Some(Hover { contents, range: Some(range) })
}

/// The page of the word of a control structure at an offset, and where the word is.
fn keyword(text: &str, offset: u32) -> Option<(String, Span)> {
    let (lexeme, span) = lexemes(text).find(|(_, span)| span.end >= offset)?;
    let word = span.text(text);
    let topic = Topic::of_keyword(&word.to_ascii_lowercase()).filter(|_| lexeme == Ok(Lexeme::Word))?;
    Some((topic.shown(), span))
}

/// The name of the signal whose number is at a place.
fn signal(place: &FilePlace) -> Option<(String, Span)> {
    let argument = signals::argument_at(&place.file, place.offset)?;
    let (signal, name) = signals::named(&place.file, argument)?;
    Some((format!("`{signal}` is `{name}`"), argument.at.span))
}
