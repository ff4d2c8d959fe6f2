//! What the name under the cursor is.

use super::describe::describe;
use super::server::{Refusal, Server};
use gen_lsp_types::*;

pub(super) fn hover(server: &Server, params: HoverParams) -> Result<Option<Hover>, Refusal> {
    Ok(find(server, &params.text_document_position_params))
}

fn find(server: &Server, at: &TextDocumentPositionParams) -> Option<Hover> {
    let place = server.place(at)?;
    let mention = place.mention()?;
    let value = describe(&place.file.program, mention.meaning, server.options.family)?;
    let range = place.file.text(server)?.range(mention.at.span);
    let contents = Contents::MarkupContent(MarkupContent { kind: MarkupKind::Markdown, value });
    Some(Hover { contents, range: Some(range) })
}
